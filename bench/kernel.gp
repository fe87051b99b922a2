# SPDX-License-Identifier: GPL-3.0-or-later
# kernel.gp -- error against time of the stages of the contact kernel, from kernel.tsv; -e "out='FOLDER'".
# Errors below the lower border are drawn on it.
set datafile separator "\t"
set datafile missing "-"
set grid back lt 1 lc rgb "#d8d8d8"
set logscale xy
set xrange [100:20000]
set format y "10^{%T}"
set xlabel "time of one [ns]"
set key below maxcols 2 font ",9" samplen 1
at_least(x, low) = x > low ? x : low
rows(test) = sprintf("< awk -F'\t' '!/^#/ && (%s)' kernel.tsv", test)

set terminal pngcairo size 1300, 620
set output out . "/kernel.png"
set multiplot layout 1, 2
set title "distance of two cores"
set ylabel "error [m]"
set yrange [1e-18:1]
plot rows("$2 ~ /^distance, cold/") using 4:(at_least($5, 1e-17)) with points pt 6 ps 1.3 lw 2 lc rgb "#1f5fa8" title "cold", \
     rows("$2 ~ /^distance, warm/ && $1 !~ /vert/") using 4:(at_least($5, 1e-17)) with points pt 7 ps 1.3 lc rgb "#1f5fa8" title "warm", \
     rows("$1 ~ /vert/") using 4:(at_least($5, 1e-17)):1 with labels left offset 0.6, 0 point pt 13 ps 1.4 lc rgb "#2e8b57" font ",8" title "warm, of many vertices", \
     rows("$2 ~ /^contact/") using 4:(at_least($5, 1e-17)) with points pt 5 ps 1.1 lc rgb "#7a7a7a" title "with features and area", \
     rows("$2 ~ /dilated/ && $5 != \"-\"") using 4:5 with points pt 3 ps 1.5 lw 2 lc rgb "#c0392b" title "libccd, against the known depth"
set title "one contact"
set ylabel "relative error of the force or of the depth"
set yrange [1e-12:1]
plot rows("$2 == \"force, patch\"") using 4:(at_least($5, 1e-12)):1 with labels left offset 0.6, 0 point pt 7 ps 1.1 lc rgb "#1f5fa8" font ",8" title "patch: force and torque, friction, damping", \
     rows("$2 == \"force, surrogate\"") using 4:(at_least($5, 1e-12)) with points pt 13 ps 1.4 lc rgb "#2e8b57" title "patch with surrogates of 1e-3, evaluations included: difference from patch", \
     rows("$2 == \"force, core\"") using 4:(at_least($5, 1e-12)) with points pt 5 ps 1.1 lc rgb "#7a7a7a" title "core: one point", \
     rows("$2 == \"force, manual-si\"") using 4:(at_least($5, 1e-12)) with points pt 9 ps 1.3 lc rgb "#b07cc6" title "manual-si: contact types", \
     rows("$2 == \"depth, MPR\"") using 4:(at_least($5, 1e-12)) with points pt 4 ps 1.3 lw 2 lc rgb "#c0392b" title "libccd MPR: depth alone", \
     rows("$2 == \"depth, EPA\"") using 4:(at_least($5, 1e-12)) with points pt 6 ps 1.3 lw 2 lc rgb "#e08e0b" title "libccd GJK and EPA: depth alone"
unset multiplot
