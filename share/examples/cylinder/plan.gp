# SPDX-License-Identifier: GPL-3.0-or-later
# plan.gp -- the floes from above at the start and at the end, by gnuplot, from the output of plan.awk:
#     gnuplot -e "out='plan.svg'" plan.gp            (or plan.png; wide=600 makes it smaller)
if (!exists("out")) out = 'plan.svg'
if (!exists("wall")) wall = 30    # side walls at y = -wall and wall, as in cylinder.scene
first = 'plan-start.dat'
last = 'plan-end.dat'

stats [*:*] [*:*] first using 1:2 nooutput name 'A'
stats [*:*] [*:*] last using 1:2 nooutput name 'B'
min(a, b) = a < b ? a : b
max(a, b) = a > b ? a : b
x0 = floor(min(A_min_x, B_min_x)) - 1
x1 = ceil(max(A_max_x, B_max_x)) + 1
y0 = min(-wall, floor(min(A_min_y, B_min_y))) - 1.5
y1 = max(wall, ceil(max(A_max_y, B_max_y))) + 1.5

# Two frames above each other to one scale; the height follows from the width.
if (!exists("wide")) wide = 900.0
left = 70.0; right = 20.0; above = 34.0; below = 62.0
high = (wide - left - right) * (y1 - y0) / (x1 - x0)
tall = 2 * (high + above) + below
if (strstrt(out, '.png') > 0) {
    set terminal pngcairo size wide, tall font 'sans,11'
} else {
    set terminal svg size wide, tall dynamic font 'sans,13' background '#ffffff'
}
set output out

set border lc rgb '#505050'
set tics out nomirror textcolor rgb '#303030'
set xrange [x0:x1]
set yrange [y0:y1]
set xtics 10
set ytics 10
set lmargin at screen left / wide
set rmargin at screen 1 - right / wide
set ylabel 'y [m]' offset 1
set object 1 rectangle from graph 0, 0 to graph 1, 1 behind fillcolor rgb '#3f6f8f' linewidth 0
do for [s in "-1 1"] {
    set arrow from x0, s * wall to x1, s * wall nohead lc rgb '#202020' lw 3 front
}
set multiplot

do for [k = 0:1] {
    name = k ? last : first
    set tmargin at screen 1 - (above + k * (high + above)) / tall
    set bmargin at screen 1 - (1 + k) * (high + above) / tall
    t = system("sed -n 's/^# t = //p' " . name)
    set title 't = ' . t . ' s' . (k ? '' : ', the current runs from left to right') offset 0, -0.6
    if (k) { set xlabel 'x [m]'; set format x '%g' } else { unset xlabel; set format x '' }
    plot name index 0 using 1:2 with filledcurves closed fc rgb '#eef4f7' notitle, \
         name index 0 using 1:2 with lines lc rgb '#7f98a6' lw 0.8 notitle, \
         name index 1 using 1:2 with filledcurves closed fc rgb '#c8642d' notitle
}
unset multiplot
set output
