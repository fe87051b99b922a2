# SPDX-License-Identifier: GPL-3.0-or-later
# spectra.gp -- spectra of the load in lock-in and in continuous crushing:  gnuplot -e "out='spectra.svg'" spectra.gp
if (!exists("out")) out = 'spectra.svg'
if (strstrt(out, '.png') > 0) {
    set terminal pngcairo size 900, 620 font 'sans,11'
} else {
    set terminal svg size 900, 620 dynamic font 'sans,13' background '#ffffff'
}
set output out
set datafile commentschars '#'
set logscale xy
set format y '10^{%T}'
set grid lc rgb '#dddddd'
set key outside top center horizontal samplen 2
set xlabel 'frequency [Hz]'
set ylabel 'spectrum of the load [N^2/Hz]'
set xrange [0.05:25]
set yrange [1e8:1e14]
f(k) = 0
plot 'locked-ramp.tsv' using 8:9 skip 1 with lines lw 1.5 lc rgb '#cb181d' title 'lock-in, 0.10 m/s', \
     'free-ramp.tsv' using 8:9 skip 1 with lines lw 1.5 lc rgb '#08519c' title 'continuous, 0.19 m/s', \
     'free-even.tsv' using 8:9 skip 1 with lines lw 1.2 lc rgb '#6baed6' title 'continuous, no scatter'
