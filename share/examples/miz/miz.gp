set terminal svg size 900,620 background "white" font "sans,13"
set output out.'/miz.svg'
set multiplot layout 2,1
set grid
set lmargin 9
set key bottom left
set xlabel "distance from the edge of the ice [m]"
set ylabel "height, heave [m]"
set yrange [0:*]
plot out.'/decay.bands' using 1:3 every ::1 with lines lw 2 lc 1 title "waves, Rogers et al. 2021", \
     out.'/decay.bands' using 1:4 every ::1 with points pt 7 lc 1 title "heave of floes", \
     out.'/open.bands' using 1:3 every ::1 with lines lw 2 lc 2 title "waves without decay", \
     out.'/open.bands' using 1:4 every ::1 with points pt 5 lc 2 title "heave of floes"
set ylabel "collisions of a floe [1/min]"
plot out.'/decay.bands' using 1:6 every ::1 with linespoints pt 7 lw 2 lc 1 title "with decay", \
     out.'/open.bands' using 1:6 every ::1 with linespoints pt 5 lw 2 lc 2 title "without"
