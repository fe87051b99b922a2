# Heat map of the mean of the largest base shear over the seeds: angle across, speed and thickness up.
set terminal pngcairo size 900,560 font "Sans,11"
set output out
set title "Largest base shear, mean over the seeds [kN]"
set xlabel "direction of drift in the axes of the platform [deg]"
set palette defined (0 "#f7fbff", 0.5 "#6baed6", 1 "#08306b")
set datafile separator "\t"
set offsets 0, 0, 0, 0
unset key
set cbrange [0:*]
rows = "< awk -F'\\t' '$4 == \"all\" { a[$1]; y[$2 \" m/s, \" $3 \" m\"] = 1; v[$1, $2 \" m/s, \" $3 \" m\"] = $7; \
    if (!($1 in i)) i[$1] = na++; k = $2 \" m/s, \" $3 \" m\"; if (!(k in j)) { j[k] = nb++ } \
    print i[$1] \"\\t\" j[k] \"\\t\" $7 \"\\t\" $1 \"\\t\" k }' ".table
set tics out nomirror
set style fill solid noborder
set autoscale fix
# Boxes, as an image of one row or column is not drawn.
plot rows using 1:2:($1 - 0.5):($1 + 0.5):($2 - 0.5):($2 + 0.5):3:xtic(4):ytic(5) with boxxyerror fillcolor palette, \
     rows using 1:2:(sprintf("%.3g", $3)) with labels font "Sans Bold,11" textcolor rgb "#d94801"
