# gnuplot history-total.gp draws history-total.svg from history-total.tsv
if (!exists("out")) out = 'history-total.svg'
set terminal svg noenhanced size 1000,1014 dynamic font 'sans-serif,14' background '#ffffff'
set encoding utf8
set output out
data = 'history-total.tsv'
set style line 1 lc rgb '#85bcdb' lw 1.0 pt 6 ps 0.6
set style line 2 lc rgb '#08519c' lw 2.0 pt 7 ps 0.5
set style line 3 lc rgb '#2171b5' lw 1.2 pt 7 ps 0.5
set style line 9 lc rgb '#dddddd' lw 0.8
set border 3 lc rgb '#444444' lw 1
set tics nomirror out scale 0.6 textcolor rgb '#222222'
set grid back ls 9
set multiplot
set label 1 'Load history, total' at screen 0.5, screen 0.9763 center font ',18' textcolor rgb '#111111'
set key at screen 0.975, screen 0.9606 right top horizontal Left reverse samplen 2
set lmargin at screen 0.0950
set rmargin at screen 0.9700
set tmargin at screen 0.9349
set bmargin at screen 0.7377
set xrange [0:12.5]
set yrange [-3.475429722:68.40189307]
set ytics 20
set label 2 'Force in x  [kN]' at screen 0.0220, graph 0.5 center rotate
set format x ''
plot data index 0 using 4:($5*0.001) with lines ls 1 title 'raw', \
     data index 1 using 4:($5*0.001) with lines ls 2 title 'filtered, 1 Hz'
unset key
unset label 1
set lmargin at screen 0.0950
set rmargin at screen 0.9700
set tmargin at screen 0.7120
set bmargin at screen 0.5148
set xrange [0:12.5]
set yrange [-19.6362964:27.2372264]
set ytics 10
set label 2 'Force in y  [kN]' at screen 0.0220, graph 0.5 center rotate
set format x ''
plot data index 2 using 4:($5*0.001) with lines ls 1 title 'raw', \
     data index 3 using 4:($5*0.001) with lines ls 2 title 'filtered, 1 Hz'
unset key
unset label 1
set lmargin at screen 0.0950
set rmargin at screen 0.9700
set tmargin at screen 0.4892
set bmargin at screen 0.2919
set xrange [0:12.5]
set yrange [-6.840181962:0.3475410071]
set ytics 2
set label 2 'Force in z  [kN]' at screen 0.0220, graph 0.5 center rotate
set format x ''
plot data index 4 using 4:($5*0.001) with lines ls 1 title 'raw', \
     data index 5 using 4:($5*0.001) with lines ls 2 title 'filtered, 1 Hz'
unset key
unset label 1
set lmargin at screen 0.0950
set rmargin at screen 0.9700
set tmargin at screen 0.2663
set bmargin at screen 0.0690
set xrange [0:12.5]
set yrange [-3.676856939:71.56416776]
set ytics 20
set label 2 'Horizontal force  [kN]' at screen 0.0220, graph 0.5 center rotate
set xlabel 'Time  [s]'
set format x '%g'
plot data index 6 using 4:($5*0.001) with lines ls 1 title 'raw', \
     data index 7 using 4:($5*0.001) with lines ls 2 title 'filtered, 1 Hz'
unset key
unset label 1
unset multiplot
set output
