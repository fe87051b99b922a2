# SPDX-License-Identifier: GPL-3.0-or-later
# ensemble.gp -- mean and largest load with their 95 % intervals against the number of runs, and the width of these:
#     gnuplot -e "table='out/ensemble.tsv'; out='ensemble.svg'" ensemble.gp        (or ensemble.png)
if (!exists("table")) table = 'out/ensemble.tsv'
if (!exists("out")) out = 'ensemble.svg'
if (strstrt(out, '.png') > 0) {
    set terminal pngcairo size 900,1000 font 'sans,11'
} else {
    set terminal svg size 900,1000 dynamic font 'sans,13' background '#ffffff'
}
set output out
set datafile separator "\t"
set datafile missing '-'
rows(s) = "< awk -F '\\t' '$2 == \"" . s . "\" && $4 + 0 > 1' " . table
runs = system("awk -F '\\t' '$4 + 0 > n { n = $4 + 0 } END { print n }' " . table) + 0

set border 3 lc rgb '#444444'
set tics nomirror out scale 0.6 textcolor rgb '#222222'
set lmargin at screen 0.11
set rmargin at screen 0.97
set multiplot

set xrange [1:runs]
set key top right samplen 2

set tmargin at screen 0.96
set bmargin at screen 0.70
set yrange [0:*]
set ylabel 'Mean load  [kN]'
set title 'Mean of the means of the runs, and its 95 % interval' offset 0, -0.5
plot rows('fh') using 4:($6/1000):($7/1000) with filledcurves lc rgb '#c6dbef' title 'horizontal, 95 %', \
     '' using 4:($5/1000) with lines lw 2 lc rgb '#08519c' title 'horizontal', \
     rows('fx') using 4:($5/1000) with lines lw 1.5 dt 2 lc rgb '#c8642d' title 'along the drift'

set tmargin at screen 0.63
set bmargin at screen 0.37
set ylabel 'Largest load of a run  [kN]'
set title 'Mean of the largest loads of the runs, its 95 % interval, and the largest of all' offset 0, -0.5
set key at graph 0.98, 0.82 right top
plot rows('fh') using 4:($10/1000):($11/1000) with filledcurves lc rgb '#c6dbef' title 'horizontal, 95 %', \
     '' using 4:($9/1000) with lines lw 2 lc rgb '#08519c' title 'mean of the largest', \
     '' using 4:($13/1000) with steps lw 1.5 lc rgb '#c8642d' title 'largest of all'

set tmargin at screen 0.30
set bmargin at screen 0.06
set logscale xy
set xrange [runs > 8 ? 3 : 2:runs]
set yrange [*:*]
set xlabel 'Runs  n'
set ylabel 'Half of the interval over the estimate'
set title 'How wide the intervals are' offset 0, -0.5
set key top right
stats rows('fh') using (($7-$6)/2/$5*sqrt($4)) every ::runs/2 nooutput name 'M'
plot rows('fh') using 4:(($7-$6)/2/$5) with linespoints pt 7 ps 0.4 lc rgb '#08519c' title 'mean load', \
     '' using 4:(($11-$10)/2/$9) with linespoints pt 7 ps 0.4 lc rgb '#c8642d' title 'largest load of a run', \
     M_mean/sqrt(x) with lines dt 2 lc rgb '#666666' title '1/sqrt(n)'
unset multiplot
set output
