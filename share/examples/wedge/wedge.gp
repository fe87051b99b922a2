# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -e "dir='out'" wedge.gp: speed of the wedge at 20 degrees of friction, and the closed form.
set terminal svg noenhanced size 620,400 dynamic font 'sans-serif,14' background '#ffffff'
set output dir.'/wedge.svg'
set border 3 lc rgb '#444444'
set tics nomirror out scale 0.6
set xlabel 'time  [s]'
set ylabel 'speed of the wedge  [m/s]'
set key top left reverse Left
plot dir.'/speed.txt' using 1:2 with linespoints pt 7 ps 0.6 lc rgb '#2171b5' title 'dem-solve', \
     0.049294 * 9.81 * x with lines lc rgb '#d94801' title '0.0493 g t'
set output
