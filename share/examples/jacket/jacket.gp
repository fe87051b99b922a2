# SPDX-License-Identifier: GPL-3.0-or-later
# Load on the legs, motion of the deck, and the bending moment of a leg at the waterline, against time.
set terminal svg size 900,760 font "sans,12" background rgb "white"
set output "response.svg"
set multiplot layout 4,1 margins 0.1,0.98,0.07,0.98 spacing 0.03
set grid
set format x ""
set ylabel "load x [kN]"
plot "legs.dat" using 1:($2/1e3) with lines lc rgb "#1f4e79" notitle
set ylabel "deck x [mm]"
plot "legs.dat" using 1:($3*1e3) with lines lc rgb "#1f4e79" notitle
set ylabel "deck a [m/s^2]"
plot "legs.dat" using 1:4 with lines lc rgb "#1f4e79" notitle
set ylabel "leg12 M [kN m]"
set format x "%g"
set xlabel "t [s]"
plot "leg12.dat" using 1:($3/1e3) with lines lc rgb "#1f4e79" title "about y", \
     "leg12.dat" using 1:($4/1e3) with lines lc rgb "#c55a11" title "about z"
