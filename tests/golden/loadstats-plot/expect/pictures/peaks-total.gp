# gnuplot peaks-total.gp draws peaks-total.svg from peaks-total.tsv
if (!exists("out")) out = 'peaks-total.svg'
set terminal svg noenhanced size 1000,1176 dynamic font 'sans-serif,14' background '#ffffff'
set encoding utf8
set output out
data = 'peaks-total.tsv'
set style line 1 lc rgb '#85bcdb' lw 1.0 pt 6 ps 0.6
set style line 2 lc rgb '#08519c' lw 2.0 pt 7 ps 0.5
set style line 3 lc rgb '#2171b5' lw 1.2 pt 7 ps 0.5
set style line 9 lc rgb '#dddddd' lw 0.8
set border 3 lc rgb '#444444' lw 1
set tics nomirror out scale 0.6 textcolor rgb '#222222'
set grid back ls 9
set multiplot
set label 1 'Load peaks, total' at screen 0.5, screen 0.9796 center font ',18' textcolor rgb '#111111'
set key at screen 0.975, screen 0.9660 right top horizontal Left reverse samplen 2
set lmargin at screen 0.1000
set rmargin at screen 0.4750
set tmargin at screen 0.9439
set bmargin at screen 0.7738
set xlabel 'Force in x  [kN]'
set xtics 20
set label 2 'Peaks in class' at screen 0.0180, graph 0.5 center rotate
unset logscale y
set yrange [0:4.32]
set ytics 1
plot data index 0 using ($4*0.001):5:($6*0.00092) with boxes fill solid 1.0 noborder lc rgb '#9ecae1' title 'raw', \
     data index 1 using ($4*0.001):5:($6*0.00045) with boxes fill solid 1.0 noborder lc rgb '#08519c' title 'filtered'
unset key
unset label 1
set lmargin at screen 0.5800
set rmargin at screen 0.9700
set tmargin at screen 0.9439
set bmargin at screen 0.7738
set label 2 'Probability of exceedance' at screen 0.5080, graph 0.5 center rotate
set xtics 20
set logscale y
set yrange [*:1]
set ytics autofreq
set format y '%g'
plot data index 2 using ($4*0.001):5 with points ls 1 title 'raw', \
     data index 3 using ($4*0.001):5 with points ls 2 title 'filtered'
unset key
unset label 1
set lmargin at screen 0.1000
set rmargin at screen 0.4750
set tmargin at screen 0.7058
set bmargin at screen 0.5357
set xlabel 'Force in y  [kN]'
set xtics 5
set label 2 'Peaks in class' at screen 0.0180, graph 0.5 center rotate
unset logscale y
set yrange [0:3.24]
set ytics 1
plot data index 4 using ($4*0.001):5:($6*0.00092) with boxes fill solid 1.0 noborder lc rgb '#9ecae1' title 'raw', \
     data index 5 using ($4*0.001):5:($6*0.00045) with boxes fill solid 1.0 noborder lc rgb '#08519c' title 'filtered'
unset key
unset label 1
set lmargin at screen 0.5800
set rmargin at screen 0.9700
set tmargin at screen 0.7058
set bmargin at screen 0.5357
set label 2 'Probability of exceedance' at screen 0.5080, graph 0.5 center rotate
set xtics 5
set logscale y
set yrange [*:1]
set ytics autofreq
set format y '%g'
plot data index 6 using ($4*0.001):5 with points ls 1 title 'raw', \
     data index 7 using ($4*0.001):5 with points ls 2 title 'filtered'
unset key
unset label 1
set lmargin at screen 0.1000
set rmargin at screen 0.4750
set tmargin at screen 0.4677
set bmargin at screen 0.2976
set xlabel 'Force in z  [kN]'
set xtics 0.005
set label 2 'Peaks in class' at screen 0.0180, graph 0.5 center rotate
unset logscale y
set yrange [0:1.08]
set ytics 1
plot data index 8 using ($4*0.001):5:($6*0.00092) with boxes fill solid 1.0 noborder lc rgb '#9ecae1' title 'raw', \
     data index 9 using ($4*0.001):5:($6*0.00045) with boxes fill solid 1.0 noborder lc rgb '#08519c' title 'filtered'
unset key
unset label 1
set lmargin at screen 0.5800
set rmargin at screen 0.9700
set tmargin at screen 0.4677
set bmargin at screen 0.2976
set label 2 'Probability of exceedance' at screen 0.5080, graph 0.5 center rotate
set xtics 0.005
set logscale y
set yrange [*:1]
set ytics autofreq
set format y '%g'
plot data index 10 using ($4*0.001):5 with points ls 2 title 'filtered'
unset key
unset label 1
set lmargin at screen 0.1000
set rmargin at screen 0.4750
set tmargin at screen 0.2296
set bmargin at screen 0.0595
set xlabel 'Horizontal force  [kN]'
set xtics 20
set label 2 'Peaks in class' at screen 0.0180, graph 0.5 center rotate
unset logscale y
set yrange [0:4.32]
set ytics 1
plot data index 11 using ($4*0.001):5:($6*0.00092) with boxes fill solid 1.0 noborder lc rgb '#9ecae1' title 'raw', \
     data index 12 using ($4*0.001):5:($6*0.00045) with boxes fill solid 1.0 noborder lc rgb '#08519c' title 'filtered'
unset key
unset label 1
set lmargin at screen 0.5800
set rmargin at screen 0.9700
set tmargin at screen 0.2296
set bmargin at screen 0.0595
set label 2 'Probability of exceedance' at screen 0.5080, graph 0.5 center rotate
set xtics 20
set logscale y
set yrange [*:1]
set ytics autofreq
set format y '%g'
plot data index 13 using ($4*0.001):5 with points ls 1 title 'raw', \
     data index 14 using ($4*0.001):5 with points ls 2 title 'filtered'
unset key
unset label 1
unset multiplot
set output
