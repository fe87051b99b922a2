# SPDX-License-Identifier: GPL-3.0-or-later
# floating.gp -- four pictures in one, by gnuplot, in the folder of the results (out='floating.png' for a bitmap).
if (!exists("out")) out = 'floating.svg'
if (strstrt(out, '.png') > 0) { set terminal pngcairo size 1000, 760 font 'sans,11' } else { set terminal svg size 1000, 760 dynamic font 'sans,13' background '#ffffff' }
set output out
set datafile separator "\t"
set border lc rgb '#505050'
set tics out nomirror
set grid lc rgb '#e0e0e0'
g = 9.81; d = 900.0 / 1025; U = 0.5
kappa = 0.5 * 0.005 * 1025 * (100 + 40 * d) / 90000
k(L) = 2 * pi / L
rao(L) = abs(sin(5 * k(L)) / (5 * k(L)) * exp(-k(L) * d) / (1 - k(L) * d))
flat(L) = abs(sin(5 * k(L)) / (5 * k(L)) / (1 - k(L) * d))
set multiplot layout 2, 2

set title 'heave after a release 5 cm too high'
set xlabel 't [s]'; set ylabel 'height of the centre [m]'
set xrange [0:8]; set yrange [-0.47:-0.32]; set key bottom right
plot 'heave.dat' using 1:5 with lines lw 2 lc rgb '#2a6f97' title 'the floe alone', \
     'heavier.dat' using 1:5 with lines lw 2 lc rgb '#c8642d' title 'with added mass 0.5'

set title 'righting arm of a floe of 4 m x 1 m'
set xlabel 'heel [deg]'; set ylabel 'GZ [m]'
set xrange [0:50]; set yrange [0:0.2]
GM = 16.0 / (12 * d) - (1 - d) / 2
plot 'righting.tsv' using 1:2 with points pt 7 ps 0.8 lc rgb '#2a6f97' title 'measured', \
     sin(x * pi / 180) * (GM + 0.5 * 16.0 / (12 * d) * tan(x * pi / 180)**2) with lines dt 2 lc rgb '#909090' title 'wall-sided formula'

set title 'a square prism let go at a heel of 2 degrees'
set xlabel 't [s]'; set ylabel 'heel [deg]'
set xrange [0:200]; set yrange [0:90]
heel(x, w) = abs(2 + 2 * atan2(x, w) * 180 / pi)
plot 'prism-0.5.dat' using 1:(heel($7, $6)) with lines lc rgb '#2a6f97' title 'density 0.5: 45', \
     'prism-0.25.dat' using 1:(heel($7, $6)) with lines lc rgb '#c8642d' title '0.25: 26.6', \
     45 dt 2 lc rgb '#909090' notitle, atan(0.5) * 180 / pi dt 2 lc rgb '#909090' notitle

set title 'heave of a floe of 10 m over the amplitude of the wave'
set xlabel 'length of the wave [m]'; set ylabel ''
set xrange [15:450]; set yrange [0:1.2]; set logscale x; set xtics (20, 50, 100, 200, 400)
set key bottom right
plot 'waves.tsv' using 1:2 with points pt 7 ps 0.8 lc rgb '#2a6f97' title 'measured', \
     rao(x) with lines lc rgb '#c8642d' title 'linear theory', flat(x) with lines dt 2 lc rgb '#909090' title 'without the decay of pressure'
unset multiplot
set output
