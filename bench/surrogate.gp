# SPDX-License-Identifier: GPL-3.0-or-later
# surrogate.gp -- error against time of contact.surrogate, from surrogate.tsv; -e "out='FOLDER'; scenes='NAME...'".
# A colour for each step, a symbol for each tolerance, and a line from the finest to the coarsest.
set datafile separator "\t"
set datafile missing "-"
set grid back lt 1 lc rgb "#d8d8d8"
set key top right opaque box lc rgb "#d8d8d8" font ",9" samplen 1.5
rows(test) = sprintf("< awk -F'\t' -v OFS='\t' '%s { print $16, $10, $11 }' surrogate.tsv", test)
of(scene, step) = rows(sprintf("$1 == \"%s\" && $2 == \"%s\"", scene, step))
point(scene, tolerance) = rows(sprintf("$1 == \"%s\" && $3 == \"%s\"", scene, tolerance))

set terminal pngcairo size 340 * words(scenes), 720
set output out . "/surrogate.png"
set multiplot layout 2, words(scenes)
do for [row = 2 : 3] {
    do for [scene in scenes] {
        unset logscale
        set xrange [*:*]
        set yrange [*:*]
        stats rows("$1 == \"" . scene . "\"") using 1:row name "S" nooutput
        set logscale xy
        set xrange [S_min_x / 1.5 : S_max_x * 1.5]
        set yrange [S_min_y / 3 : S_max_y * 8]
        set format y "10^{%T}"
        set title row == 2 ? scene : ""
        set xlabel row == 3 ? "processor time per simulated second" : ""
        set ylabel row == 2 ? "error of the impulse" : "error of the peak"
        if (scene eq word(scenes, 1)) { set key } else { unset key }
        plot of(scene, "0.1") using 1:row with lines lw 1.8 lc rgb "#1f5fa8" title row == 2 ? "step 0.1" : "", \
             of(scene, "0.02") using 1:row with lines lw 1.8 lc rgb "#c0392b" title row == 2 ? "step 0.02" : "", \
             point(scene, "0") using 1:row with points pt 7 ps 1.2 lc rgb "#303030" title row == 3 ? "0, no surrogate" : "", \
             point(scene, "1e-4") using 1:row with points pt 4 ps 1.2 lw 1.5 lc rgb "#303030" title row == 3 ? "1e-4" : "", \
             point(scene, "1e-3") using 1:row with points pt 8 ps 1.3 lw 1.5 lc rgb "#303030" title row == 3 ? "1e-3" : "", \
             point(scene, "1e-2") using 1:row with points pt 2 ps 1.2 lw 1.5 lc rgb "#303030" title row == 3 ? "1e-2" : ""
    }
}
unset multiplot
