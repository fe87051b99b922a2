# SPDX-License-Identifier: GPL-3.0-or-later
# jz.gp -- load history, spectrum, and the ice at the end, by gnuplot, in the folder of the results.
set terminal pngcairo size 1100, 900 font 'sans,11'
set output 'jz.png'
set border lc rgb '#505050'
set tics out nomirror
set grid lc rgb '#e0e0e0'
set multiplot layout 2, 2
set title 'load on the cone'
set xlabel 't [s]'; set ylabel 'force [kN]'
set key inside bottom left horizontal maxrows 1
set yrange [*<-80:130<*]
plot 'loads.dat' using 1:($3/1e3) with lines lw 1 lc rgb '#2a6f97' title 'along the drift', \
     'loads.dat' using 1:($5/1e3) with lines lw 1 lc rgb '#c8642d' title 'upwards', \
     117 with lines dt 2 lc rgb '#505050' title 'measured, largest'
set title 'spectrum of the load along the drift'
set yrange [*:*]
set xlabel 'f [Hz]'; set ylabel 'S [N^2/Hz]'
set logscale xy; set format y '10^{%L}'
unset key
plot 'spectrum.dat' using 8:9 with lines lw 1 lc rgb '#2a6f97'
unset logscale; set format y '%g'
set title 'the ice at the end, from above: height z [m]'
set xlabel 'x [m]'; set ylabel 'y [m]'
set size ratio -1
set xrange [-5:4]; set yrange [-4:4]
set palette defined (-0.4 '#16324f', -0.05 '#8fb8d8', 0.1 '#f4f4f4', 0.8 '#c8642d')
set cbrange [-0.4:0.8]
plot 'ice-end.dat' using 1:2:3 with points pt 7 ps 0.7 palette
set title 'and from the side, within 0.6 m of the axis'
set xlabel 'x [m]'; set ylabel 'z [m]'
set xrange [-4:3]; set yrange [-1.5:2]
unset colorbox
set object 1 polygon from -1.771,-0.6 to -0.6,1.429 to -0.6,2 to 0.6,2 to 0.6,1.429 to 1.771,-0.6 to -1.771,-0.6 fc rgb '#d8d8d8' fs solid behind
plot 'ice-end.dat' using 1:(abs($2) < 0.6 ? $3 : 1/0):3 with points pt 7 ps 1 palette
unset multiplot
