#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# sample.sh TEST LATTICE LAYERS ROWS SEED SCATTER [OUT] -- one virtual sample: bend, a beam of a sheet of 0.23 m; pull, a
# strip of it between two grips that hold the last rows; or press, a block of that many layers, as thick as wide for 12.
# Prints: test lattice layers rows seed first/c peak/c E/E_b, with bonds of c = 1 MPa and E_b = 1 GPa.  first: the load at
# which the first bond softens.
set -e
test=$1 lattice=$2 layers=$3 rows=$4 seed=$5 scatter=$6 out=${7:-out}/$1-$2-$3-$4-$5-$6
h=0.23
mkdir -p "$out"
test "$test" != press || h=0.92 # of 12 layers
D=$(awk -v h=$h -v n="$layers" -v l="$lattice" 'BEGIN { printf "%.9g", n == 1 || l != "hcp" ? h/n : h/n/sqrt(2/3) }')
case $test in
bend) L=$(awk -v h=$h 'BEGIN { print 12.5*h }') W=$(awk -v D="$D" 'BEGIN { print 6.01*D }') dt=$(awk -v D="$D" "BEGIN { print 1.8e-4*D }") time=0.4 ;;
pull) L=$(awk -v D="$D" 'BEGIN { print 24.01*D }') W=$(awk -v D="$D" 'BEGIN { print 6.01*D }') dt=$(awk -v D="$D" "BEGIN { print 1.8e-4*D }") time=0.3 ;;
*) L=$(awk -v D="$D" 'BEGIN { print 10.01*D }') W=$(awk -v D="$D" 'BEGIN { print 10.01*D }') dt=$(awk -v D="$D" "BEGIN { print 1.8e-4*D }") time=0.3 ;;
esac
voronoi-ice --gaps even --lattice "$lattice" --layers "$layers" --thickness $h --size "${L}x$W" --rows "$rows" --bonded -q -o "$out/ice.dat"

# Rollers under and over the beam, plates at the ends of the block at its outermost spheres, or grips.
if test "$test" = pull; then
    awk -v D="$D" '
        NR == FNR { if ($1 == "v") { if (!n || $2 < a) a = $2; if (!n || $2 > b) b = $2; n++ } next }
        $1 == "poly" { head = $0; next }
        $1 == "v" && head != "" {
            if ($2 < a + 0.9*D) head = head " group=left"; else if ($2 > b - 0.9*D) head = head " group=right"
            print head; head = "" }
        { print }' "$out/ice.dat" "$out/ice.dat" >"$out/held.dat"
    mv "$out/held.dat" "$out/ice.dat"
fi
awk -v D="$D" -v test="$test" -v h=$h -v out="$out" -v rows="$rows" '
    $1 == "v" { n++; x[n] = $2; y[n] = $3; z[n] = $4
        if (n == 1 || $2 < x0) x0 = $2; if (n == 1 || $2 > x1) x1 = $2
        if (n == 1 || $3 < y0) y0 = $3; if (n == 1 || $3 > y1) y1 = $3
        if (n == 1 || $4 < z0) z0 = $4; if (n == 1 || $4 > z1) z1 = $4 }
    END {
        R = D/2; extra = rows == "across" ? R : R*sqrt(3); print "#g_struct 1"
        if (test == "bend") {
            # a roller bears on a line of spheres: the one nearest to its place
            half = 10.6*h/2; near = a = b = c = 1e9
            for (i = 1; i <= n; i++) {
                if (z[i] > z0 + R/4) continue
                d = (x[i] + half)*(x[i] + half); e = (x[i] - half)*(x[i] - half)
                if (d < a) { a = d; left = x[i] }
                if (e < b) { b = e; right = x[i] }
            }
            mid = (left + right)/2
            for (i = 1; i <= n; i++) {
                d = (x[i] - mid)*(x[i] - mid)
                if (z[i] > z1 - R/4 && d < c) { c = d; top = x[i] }
            }
            lo = y0 - D; hi = y1 + D
            printf "part 0 left\ncone %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", left, lo, z0 - D, R, left, hi, z0 - D, R
            printf "part 1 right\ncone %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", right, lo, z0 - D, R, right, hi, z0 - D, R
            printf "part 2 top\ncone %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", top, lo, z1 + D, R, top, hi, z1 + D, R
            a = top - left; b = right - top
            printf "%.9g %.9g %.9g\n", a, b, y1 - y0 + extra > (out "/size")
        } else {
            lo = y0 - D; hi = y1 + D; b = z0 - D; t = z1 + D; k = 0
            for (s = -1; s <= 1; s += 2) {
                f = s < 0 ? x0 - R : x1 + R; g = f + s*D; u = s < 0 ? g : f; v = s < 0 ? f : g
                printf "part %d %s\n", k++, s < 0 ? "back" : "front"
                for (i = 0; i < 8; i++) printf "v %.9g %.9g %.9g\n", (i % 2 ? v : u), (int(i/2) % 2 ? hi : lo), (i > 3 ? t : b)
                printf "t 0 2 1\nt 1 2 3\nt 4 5 6\nt 5 7 6\nt 0 1 4\nt 1 5 4\nt 2 6 3\nt 3 6 7\nt 0 4 2\nt 2 4 6\nt 1 3 5\nt 3 7 5\n"
            }
            printf "%.9g %.9g %.9g\n", x1 - x0 - (test == "pull" ? D : 0), 0, y1 - y0 + extra > (out "/size")
        }
    }' "$out/ice.dat" >"$out/struct.dat"

structure='[structure]
file = struct.dat
friction = 0'
case $test in
pull) structure='' part='[group left]
fixed = x rx ry rz
velocity = -0.01 0 0
[group right]
fixed = x rx ry rz
velocity = 0.01 0 0' ;;
bend) part='[part top]
velocity = 0 0 -0.02' ;;
press) part='[part back]
velocity = 0.02 0 0
[part front]
velocity = -0.02 0 0' ;;
esac
cat >"$out/sample.scene" <<SCENE
[ice]
file = ice.dat
slab = $h m
$structure
[run]
gravity = 0
duration = $time s
dt = $dt
[bond]
on = true
young = 1 GPa
poisson = 0.3
normal_strength = 1 MPa
shear_strength = 1 MPa
softening = stretch
damping = 0.1
scatter = $scatter
seed = $seed
[contact]
round_law = linear
tangential_ratio = 0.385
friction = 0.3
$part
[output]
loads_every = 1 ms
energy_every = 1 ms
SCENE
dem-solve -q -j 1 --set output.energy="$out/energy.tsv" --report "$out/report.txt" -o "$out/loads.tsv" "$out/sample.scene" || test $? -eq 5

# The strain energy stops growing when the sample breaks; the largest load has passed then.
awk -v test="$test" -v lattice="$lattice" -v layers="$layers" -v rows="$rows" -v seed="$seed" -v h=$h '
    FILENAME ~ /size$/ { a = $1; b = $2; w = $3; next }
    !/^[0-9]/ { next }
    FILENAME ~ /energy/ && test == "pull" {
        if (m++) { n++; t[n] = $1; P[n] = ($10 - was)/(0.02*($1 - before)) }
        was = $10; before = $1
    }
    FILENAME ~ /energy/ { if ($14 > 1e-9 && !cracked) cracked = $1; next }
    test == "bend" && $2 == "top" { n++; t[n] = $1; P[n] = $5 }
    test == "press" && $2 == "front" { n++; t[n] = $1; P[n] = $3 }
    END {
        for (i = 1; i <= n; i++) {
            if (P[i] > peak) peak = P[i]
            if (cracked && !first && t[i] >= cracked) first = P[i]
        }
        for (i = 1; i <= n && P[i] < peak*0.6; i++) {
            if (P[i] < peak*0.2) continue
            k++; d = (test == "press" ? 0.04 : 0.02)*t[i]; sd += d; sp += P[i]; sdd += d*d; sdp += d*P[i]
        }
        slope = (k*sdp - sd*sp)/(k*sdd - sd*sd)
        if (test == "bend") { unit = 6*a*b/((a + b)*w*h*h); E = slope*a*a*b*b/(3*(a + b)*w*h*h*h/12) }
        else { unit = 1/(w*h); E = slope*a/(w*h) }
        printf "%s\t%s\t%d\t%s\t%d\t%.3f\t%.3f\t%.3f\n", test, lattice, layers, rows, seed, first*unit/1e6, peak*unit/1e6, E/1e9
    }' "$out/size" "$out/energy.tsv" "$out/loads.tsv"
