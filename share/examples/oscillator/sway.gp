# SPDX-License-Identifier: GPL-3.0-or-later
# sway.gp -- load and displacement against time, by gnuplot:  gnuplot -e "out='sway.svg'" sway.gp   (or sway.png)
if (!exists("out")) out = 'sway.svg'
if (strstrt(out, '.png') > 0) {
    set terminal pngcairo size 900, 620 font 'sans,11'
} else {
    set terminal svg size 900, 620 dynamic font 'sans,13' background '#ffffff'
}
set output out
set multiplot layout 2,1
set lmargin 10
set rmargin 3
set grid lc rgb '#dddddd'
set key above right samplen 2 maxrows 1
set autoscale xfix
set ytics autofreq
set ylabel 'load along x [kN]'
plot 'sway.dat' using 1:($2/1e3) with lines lc rgb '#3465a4' title 'on the moving cylinder'
set xlabel 'time [s]'
set ylabel 'displacement [mm]'
set ytics 10
plot 'fixed.dat' using 1:(1e3*$2) with lines lc rgb '#bbbbbb' title 'x by the load at rest', \
     'sway.dat' using 1:(1e3*$3) with lines lc rgb '#cc0000' title 'x', \
     'sway.dat' using 1:(1e3*$4) with lines lc rgb '#3465a4' title 'y'
unset multiplot
