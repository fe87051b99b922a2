# SPDX-License-Identifier: GPL-3.0-or-later
# level.gp -- four pictures in one, by gnuplot, in the folder of the results (out='level.png' for a bitmap).
if (!exists("out")) out = 'level.svg'
if (strstrt(out, '.png') > 0) { set terminal pngcairo size 1000, 760 font 'sans,11' } else { set terminal svg size 1000, 760 dynamic font 'sans,13' background '#ffffff' }
set output out
set datafile separator whitespace
set border lc rgb '#505050'
set tics out nomirror
set grid lc rgb '#e0e0e0'
set multiplot layout 2, 2
set xlabel 't [s]'
set title 'load on the cone'
set ylabel 'force [kN]'
set key top right
plot 'loads.dat' using 1:($3/1e3) with lines lw 1 lc rgb '#2a6f97' title 'along the drift', \
     'loads.dat' using 1:($5/1e3) with lines lw 1 lc rgb '#c8642d' title 'upwards'
set title 'what the frozen faces store, and have taken'
set ylabel 'energy [J]'
set key top left
plot 'energy.dat' using 1:13 with lines lw 1 lc rgb '#2a6f97' title 'stored', \
     'energy.dat' using 1:14 with lines lw 2 lc rgb '#c8642d' title 'fracture'
set title 'cracks'
set ylabel 'damage x area [m^2]'
unset key
plot 'cracks.dat' using 1:2 with linespoints pt 7 ps 0.6 lw 2 lc rgb '#c8642d'
set title 'faces of the sheet from above, at the end'
set xlabel 'x [m]'; set ylabel 'y [m]'
set size ratio -1
set xrange [-8.5:2.5]; set yrange [-3.4:3.4]
set palette defined (0 '#2a6f97', 0.5 '#e0b040', 1 '#b02020')
set cbrange [0:1]; set cblabel 'damage'
set object 1 circle at 0, 0 size 1.25 fc rgb '#d0d0d0' fs solid border lc rgb '#505050' behind
plot 'faces.dat' using 1:2:3 with points pt 7 ps 0.8 palette
unset multiplot
set output
