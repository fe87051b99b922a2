# SPDX-License-Identifier: GPL-3.0-or-later
# contact.gp -- the plots of contact.md, from the output of
#     bench_contact curves DIR    and    bench_step > DIR/gas.txt
# by:   gnuplot -e 'from="DIR"; to="share/doc"' share/doc/contact.gp
set terminal pngcairo size 900,560 font "sans,11"
set style line 1 lc rgb "#0b4f8a" lw 2
set style line 2 lc rgb "#c0392b" lw 2
set style line 3 lc rgb "#7f8c8d" lw 2
set style line 4 lc rgb "#e0a030" lw 2 dt 2
set grid lc rgb "#dddddd"
set key outside right

set output to."/contact-drift.png"
set logscale xy
set xlabel "step over the critical step"
set ylabel "|energy drift| in 4 s"
set xrange [0.04:0.5]
set yrange [1e-9:1]
set format y "10^{%T}"
law(k) = sprintf("< awk '$1 == \"%s\" { d = $7 < 0 ? -$7 : $7; print $2, d }' %s/gas.txt", k, from)
plot law("patch") with linespoints ls 1 pt 7 title "patch", \
     law("core") with linespoints ls 2 pt 7 title "core", \
     law("manual-si") with linespoints ls 3 pt 7 title "manual-si", \
     law("manual") with linespoints ls 4 pt 7 title "manual", \
     4e-6 * (x / 0.4)**2 with lines lc rgb "#999999" dt 3 title "order 2"

unset logscale
set yrange [*:*]
set format y "%g"
set key inside top right
set output to."/contact-tilt.png"
set xrange [-0.002:0.002]
set xlabel "tilt [rad]"
set ylabel "torque on the upper box [kN m]"
plot from."/tilt.tsv" using 1:($2/1e3) with lines ls 1 title "patch", \
     "" using 1:($3/1e3) with lines ls 2 title "core", \
     "" using 1:($4/1e3) with lines ls 3 title "manual-si", \
     "" using 1:($5/1e3) with lines ls 4 title "manual"

set output to."/contact-slide.png"
set xrange [0.8:3.0]
set xlabel "way of the upper box over the lower [m]; it leaves the edge from 1 to 3"
set ylabel "force across the faces [kN]"
plot from."/slide.tsv" using 1:($2/1e3) with lines ls 1 title "patch", \
     "" using 1:($3/1e3) with lines ls 2 title "core", \
     "" using 1:($4/1e3) with lines ls 3 title "manual-si", \
     "" using 1:($5/1e3) with lines ls 4 title "manual"

set output to."/contact-friction.png"
set terminal pngcairo size 900,860 font "sans,11"
set xrange [0:1.05]
set yrange [0:1.05]
unset key
array FACE[4] = ["disc", "square", "line, moved along", "line, moved across"]
set multiplot layout 2,2
set xlabel "force over mu N"
set ylabel "moment over mu N rho"
set key bottom left reverse Left
do for [k = 0:3] {
    set title FACE[k + 1]
    plot from."/friction.tsv" index k using 5:6 with lines ls 2 title "ellipse of before", \
         "" index k using 1:2 with lines lc rgb "#000000" lw 4 title "Coulomb, even pressure", \
         "" index k using 3:4 with lines ls 4 lw 3 title "law of now"
    unset key
}
unset multiplot
