# SPDX-License-Identifier: GPL-3.0-or-later
# motion.gp -- motion of a hull, from its table of loads:  gnuplot -e "from='free.tsv'; out='motion.svg'" motion.gp
set terminal svg size 900, 560 dynamic font 'sans,13' background '#ffffff'
set output out
set datafile separator '\t'
set border lc rgb '#505050'
set tics out nomirror textcolor rgb '#303030'
set grid lc rgb '#e0e0e0'
set key top right horizontal
set xzeroaxis lc rgb '#909090'
set lmargin 11
set multiplot layout 2, 1
set ylabel 'way [m]'
plot from using 't[s]':'ux[m]' with lines lc rgb '#1f6f9f' title 'surge', \
     from using 't[s]':'uy[m]' with lines lc rgb '#c8642d' title 'sway', \
     from using 't[s]':'uz[m]' with lines lc rgb '#2f8f4f' title 'heave'
set xlabel 't [s]'
set ylabel 'turn [deg]'
plot from using 't[s]':'rx[deg]' with lines lc rgb '#1f6f9f' title 'roll', \
     from using 't[s]':'ry[deg]' with lines lc rgb '#c8642d' title 'pitch', \
     from using 't[s]':'rz[deg]' with lines lc rgb '#2f8f4f' title 'yaw'
unset multiplot
set output
