# SPDX-License-Identifier: GPL-3.0-or-later
# ladder.gp -- the plots of the ladder, from curves.dat; -e "out='FOLDER'; scenes='NAME ...'".
n = words(scenes)
across = n > 4 ? 4 : n
down = (n + across - 1) / across
set datafile missing "NaN"
set key font ",9" samplen 1
set grid back lt 1 lc rgb "#d8d8d8"
set tics font ",9"

set terminal pngcairo size 380 * across, 330 * down + 40 noenhanced
set output out . "/error-cost.png"
set multiplot layout down, across \
    title "error of the impulse [%] against cost over that of a tenth of the critical step"
set logscale xy
set xrange [0.05:200]
set yrange [1e-5:200]
set format y "%g"
do for [i = 1:n] {
    s = word(scenes, i)
    set title s offset 0, -0.7
    if (i > 1) { unset key } else { set key top right }
    plot "curves.dat" index "front." . s . ";" using 1:2 with lines lw 5 lc rgb "#f2c9a0" title "front", \
         "" index "step." . s . ";" using 1:2 with linespoints pt 7 ps 0.8 lc rgb "#1f5fa8" title "patch", \
         "" index "core." . s . ";" using 1:2 with linespoints pt 5 ps 0.7 lc rgb "#7a7a7a" title "core", \
         "" index "manual-si." . s . ";" using 1:2 with linespoints pt 9 ps 0.8 lc rgb "#b07cc6" title "manual-si", \
         "" index "error." . s . ";" using 1:2 with points pt 3 ps 1.3 lw 2 lc rgb "#c0392b" title "run.error"
}
unset multiplot
unset title

if (strstrt(scenes, "field") == 0 && strstrt(scenes, "pack") == 0) { exit }

set terminal pngcairo size 640, 440 noenhanced
set output out . "/cost-bodies.png"
set key top left
set xlabel "bodies"
set ylabel "processor time of a body-step [ns]"
set autoscale
set xrange [10:200000]
unset logscale y
set yrange [0:*<20000]
plot "curves.dat" index "bodies;" using 1:2 with linespoints pt 7 lc rgb "#1f5fa8" \
         title "floes in a current, 80 %", \
     "" index "spheres;" using 1:2 with linespoints pt 6 ps 1.4 lc rgb "#c0392b" \
         title "spheres in close packing"

set output out . "/cost-threads.png"
unset logscale x
set xlabel "threads"
set ylabel "speedup over one thread"
cores = system("getconf _NPROCESSORS_ONLN") + 0
set xrange [0.9:cores + 0.1]
set yrange [0:cores + 0.1]
set xtics 1
plot x with lines dt 2 lc rgb "#999999" title "ideal", \
     for [s in scenes] "curves.dat" index "threads." . s . ";" using 1:2 with linespoints pt 7 \
         title (s[1:5] eq "field" || s[1:4] eq "pack") ? s : ""
