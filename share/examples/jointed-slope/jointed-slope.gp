# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -e "dir='out'" jointed-slope.gp: rigid blocks as they slide, and the stress in blocks that deform.
set terminal svg noenhanced size 1200,480 dynamic font 'sans-serif,14' background '#ffffff'
set encoding utf8
set output dir.'/jointed-slope.svg'
set border 3 lc rgb '#444444'
set tics nomirror out scale 0.6
set multiplot
set size 0.46,1
set origin 0,0
set size ratio -1
set xlabel 'x  [m]'
set ylabel 'z  [m]'
set xrange [-4:26]
set yrange [-5:12]
set title 'rigid, friction of 34 degrees: at the start (lines) and after 4 s'
plot dir.'/outlines.txt' index 1 using 1:2 with filledcurves closed fs solid border lc rgb '#1c4966' fc rgb '#9ecae1' notitle, \
     '' index 0 using 1:2 with lines lc rgb '#d94801' lw 1.2 notitle
set size 0.52,1
set origin 0.47,0
set size ratio -1
set title 'deformable, at rest at 40 degrees: largest principal stress'
set palette defined (0 '#f7fbff', 0.25 '#9ecae1', 0.5 '#4292c6', 0.75 '#08519c', 1 '#08306b')
set cblabel 'MPa'
set cbrange [0:*]
plot dir.'/last.txt' using 4:6:($14 / 1e6) with points pt 7 ps 0.9 palette notitle, \
     dir.'/outlines.txt' index 0 using 1:2 with lines lc rgb '#d94801' lw 1.2 notitle
unset multiplot
set output
