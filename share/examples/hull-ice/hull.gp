# SPDX-License-Identifier: GPL-3.0-or-later
# hull.gp -- resistance against speed, a record, and the ice at its end, by gnuplot.  thick: thicknesses; speed: of the record;
# L, B: length and breadth of the hull, bow: length of its bow at the waterline.
set terminal pngcairo size 1100, 800 font 'sans,11'
set output 'hull.png'
set border lc rgb '#505050'
set tics out nomirror
set grid lc rgb '#e0e0e0'
set multiplot layout 2, 2
set title 'resistance in level ice'
set xlabel 'speed [m/s]'; set ylabel 'R [kN]'
set xrange [0:3]; set yrange [0:*]
set key outside right top
colour(k) = word("#2a6f97 #c8642d #5b8c3a #7a4fa3", k)
plot for [k = 1:words(thick)] 'table.dat' using ($1 == word(thick, k) ? $2 : NaN):3 with points pt 7 ps 1.4 lc rgb colour(k) \
         title 'spheres, '.word(thick, k).' m', \
     for [k = 1:words(thick)] 'table.dat' using ($1 == word(thick, k) ? $2 : NaN):11 with points pt 4 ps 1.4 lc rgb colour(k) \
         title 'Lindqvist, '.word(thick, k).' m', \
     for [k = 1:words(thick)] 'table.dat' using ($1 == word(thick, k) ? $2 : NaN):12 with points pt 6 ps 1.4 lc rgb colour(k) \
         title 'Riska, '.word(thick, k).' m', \
     for [k = 1:words(thick)] 'table.dat' using ($1 == word(thick, k) ? $2 : NaN):10 with points pt 2 ps 1.2 lc rgb colour(k) \
         title 'Rs alone, '.word(thick, k).' m'
set title word(thick, 1).' m at '.speed.' m/s: means of 20 ms'
set xlabel 't [s]'; set ylabel 'force [kN]'
set autoscale
unset key
plot 'loads.dat' using 1:($3/1e3) with lines lw 1 lc rgb '#2a6f97'
set title 'its ice at the end, from above: height z [m]'
set xlabel 'x [m]'; set ylabel 'y [m]'; set ytics 10
set size ratio -1
set palette defined (-7 '#16324f', -1 '#8fb8d8', 0 '#f4f4f4', 1 '#c8642d')
set cbrange [-7:1]
set object 1 polygon from 0,0 to bow,B/2 to L,B/2 to L,-B/2 to bow,-B/2 to 0,0 fs empty border lc rgb '#505050' lw 2 front
plot 'ice-end.dat' using 1:2:3 with points pt 7 ps 0.5 palette
unset object 1
set title 'and from the side, within 2 m of the axis'
set xlabel 'x [m]'; set ylabel 'z [m]'; set ytics 4
unset colorbox
set yrange [-9:2]
plot 'ice-end.dat' using 1:(abs($2) < 2 ? $3 : 1/0):3 with points pt 7 ps 0.6 palette
unset multiplot
