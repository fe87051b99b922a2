# SPDX-License-Identifier: GPL-3.0-or-later
set terminal pngcairo size 900,560 font ",12"
set output out
set xlabel "direction of the ice [deg]"
set ylabel "load [kN]"
set xrange [-3:93]
set xtics 15
set yrange [0:*]
set grid ytics lc rgb "#dddddd"
set key at graph 0.97,0.42 right
plot table using 1:2 with linespoints lw 2 pt 7 lc rgb "#1f77b4" title "largest on a leg, ice fails", \
     table using 1:5 with linespoints lw 2 pt 5 lc rgb "#d62728" title "largest on a leg, rigid floes", \
     table using 1:4 with linespoints lw 2 dt 2 pt 7 lc rgb "#1f77b4" title "mean on all, ice fails", \
     table using 1:7 with linespoints lw 2 dt 2 pt 5 lc rgb "#d62728" title "mean on all, rigid floes"
