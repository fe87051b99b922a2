# SPDX-License-Identifier: GPL-3.0-or-later
# plan.gp -- the ice from above at the end of the three runs, by gnuplot, from the output of plan.awk.
wall = 12          # side walls at y = -wall and wall, as in wigley.scene
x0 = -45; x1 = 45
wide = 900.0; left = 60.0; right = 15.0; above = 36.0; below = 50.0
high = (wide - left - right) * 2 * (wall + 1) / (x1 - x0)
tall = 3 * (high + above) + below
set terminal svg size wide, tall dynamic font 'sans,13' background '#ffffff'
set output 'plan.svg'
set border lc rgb '#505050'
set tics out nomirror scale 0.5 textcolor rgb '#303030'
set xrange [x0:x1]
set yrange [-wall - 1:wall + 1]
set ytics 10
set lmargin at screen left / wide
set rmargin at screen 1 - right / wide
set ylabel 'y [m]' offset 1
set object 1 rectangle from graph 0, 0 to graph 1, 1 behind fillcolor rgb '#3f6f8f' linewidth 0
do for [s in "-1 1"] { set arrow from x0, s * wall to x1, s * wall nohead lc rgb '#202020' lw 3 front }
set multiplot
array name[3] = ['fixed', 'towed', 'free']
do for [k = 1:3] {
    set tmargin at screen 1 - (above + (k - 1) * (high + above)) / tall
    set bmargin at screen 1 - k * (high + above) / tall
    t = system("sed -n 's/^# t = //p' " . name[k] . '.plan')
    set title name[k] . ', t = ' . t . ' s' offset 0, -0.6
    if (k == 3) { set xlabel 'x [m]'; set format x '%g' } else { unset xlabel; set format x '' }
    plot name[k] . '.plan' index 0 using 1:2 with filledcurves closed fc rgb '#eef4f7' notitle, \
         name[k] . '.plan' index 0 using 1:2 with lines lc rgb '#7f98a6' lw 0.8 notitle, \
         name[k] . '.plan' index 1 using 1:2 with filledcurves closed fc rgb '#c8642d' notitle
}
unset multiplot
set output
