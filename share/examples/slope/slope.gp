# gnuplot -e "dir='out/low'; out='out/low.svg'" slope.gp: the discs at three times, coloured by their height at the start.
set terminal svg size 900,1150 dynamic font 'sans-serif,14' background '#ffffff'
set output out
set palette defined (0 '#440154', 1 '#443983', 2 '#31688e', 3 '#21918c', 4 '#35b779', 5 '#90d743', 6 '#fde725')
set multiplot layout 3,1
set size ratio -1
set xrange [-1:61]
set yrange [-1:27]
set cbrange [0:25]
set cblabel 'height at the start  [m]'
set xlabel ' '
set ylabel 'y  [m]'
set style fill solid border lc rgb '#222222'
do for [k = 0:2] {
    if (k == 2) { set xlabel 'x  [m]' }
    set title word(times, k + 1).' s'
    plot dir.'-'.k.'.txt' using 1:2:3:4 with circles lc palette notitle
}
unset multiplot
set output
