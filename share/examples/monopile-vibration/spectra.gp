# SPDX-License-Identifier: GPL-3.0-or-later
# spectra.gp -- spectra of load and displacement in lock-in and in continuous crushing:  gnuplot -e "out='spectra.svg'" spectra.gp
if (!exists("out")) out = 'spectra.svg'
if (strstrt(out, '.png') > 0) {
    set terminal pngcairo size 900, 900 font 'sans,11'
} else {
    set terminal svg size 900, 900 dynamic font 'sans,13' background '#ffffff'
}
set output out
set datafile commentschars '#'
set logscale xy
set format y '10^{%T}'
set grid lc rgb '#dddddd'
set key outside top center horizontal samplen 2
set xrange [0.05:25]
set lmargin 11
set multiplot layout 2, 1
set ylabel 'load [N^2/Hz]'
set yrange [1e8:1e14]
plot 'locked-ramp-fx.tsv' using 8:9 skip 1 with lines lw 1.5 lc rgb '#cb181d' title 'lock-in, 0.10 m/s', \
     'locked-one-fx.tsv' using 8:9 skip 1 with lines lw 1.2 lc rgb '#fc9272' title 'lowest mode alone, 0.10 m/s', \
     'free-ramp-fx.tsv' using 8:9 skip 1 with lines lw 1.5 lc rgb '#08519c' title 'continuous, 0.19 m/s', \
     'free-even-fx.tsv' using 8:9 skip 1 with lines lw 1.2 lc rgb '#6baed6' title 'continuous, no scatter'
unset key
set xlabel 'frequency [Hz]'
set ylabel 'displacement at the waterline [m^2/Hz]'
set yrange [1e-14:1e-2]
plot 'locked-ramp-ux.tsv' using 8:9 skip 1 with lines lw 1.5 lc rgb '#cb181d', \
     'locked-one-ux.tsv' using 8:9 skip 1 with lines lw 1.2 lc rgb '#fc9272', \
     'free-ramp-ux.tsv' using 8:9 skip 1 with lines lw 1.5 lc rgb '#08519c', \
     'free-even-ux.tsv' using 8:9 skip 1 with lines lw 1.2 lc rgb '#6baed6'
unset multiplot
