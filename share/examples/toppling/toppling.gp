# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -e "dir='out'" toppling.gp: the slope at the start and after two seconds at 35 degrees; forces where it holds.
set terminal svg noenhanced size 1000,430 dynamic font 'sans-serif,14' background '#ffffff'
set encoding utf8
set output dir.'/toppling.svg'
set border 3 lc rgb '#444444'
set tics nomirror out scale 0.6
set multiplot
set size 0.58,1
set origin 0,0
set size ratio -1
set xlabel 'x  [m]'
set ylabel 'z  [m]'
set xrange [-12:40]
set yrange [-8:30]
set title 'friction of 35 degrees: at the start (lines) and after 2 s'
plot dir.'/outlines.txt' index 0 using 1:2 with filledcurves closed fs solid border lc rgb '#5c5448' fc rgb '#a89f8e' notitle, \
     '' index 2 using 1:2 with filledcurves closed fs solid border lc rgb '#1c4966' fc rgb '#9ecae1' notitle, \
     '' index 1 using 1:2 with lines lc rgb '#d94801' lw 1.2 notitle
set origin 0.6,0.08
set size 0.4,0.88
set size noratio
set autoscale
set xrange [0.5:9.5]
set yrange [0:*]
set xtics 1
set xlabel 'from block i + 1 on block i'
set ylabel 'force between blocks  [kN/m]'
set title 'toe just holds: 38.94 degrees'
set key top right reverse Left
plot dir.'/forces.txt' using 1:2 with linespoints pt 6 ps 1 lc rgb '#d94801' title 'Goodman and Bray', \
     '' using 1:3 with points pt 7 ps 0.9 lc rgb '#2171b5' title 'dem-solve', \
     '' using 1:4 with points pt 1 ps 1 lc rgb '#555555' title 'stiff toe'
unset multiplot
set output
