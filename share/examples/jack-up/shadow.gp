# SPDX-License-Identifier: GPL-3.0-or-later
# shadow.gp -- load of a leg against its bearing, by gnuplot; from: rows of shadow.awk, to: the picture.
set terminal pngcairo size 800, 700 font 'sans,11'
set output to
set border lc rgb '#505050'
set tics out nomirror
set grid lc rgb '#e0e0e0'
set xrange [-5:185]; set xtics 30
set yrange [0:*]
set lmargin 11
set multiplot layout 2, 1
set title 'load along the drift after the sheet has reached the leg'
set ylabel 'mean [kN]'
set key top right
plot from using 1:5 with points pt 7 ps 1.3 lc rgb '#2a6f97' title 'mean'
unset title
set xlabel 'bearing from the middle of the rig: 0 in front, 180 behind [degrees]'
set ylabel 'largest [kN]'
plot from using 1:4 with points pt 7 ps 1.3 lc rgb '#c8642d' title 'largest, means of 10 ms'
unset multiplot
