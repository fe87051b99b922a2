#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ice_scenes.sh BUILD -- rows IS3 to IS12 of ice-scenes(7): the ship and the jacket of share/examples/ice-scenes, and a
# wide cone, beside closed forms and published curves, for make verify. Some thirty runs, half an hour of a processor.
# ROWS="IS3 IS8" limits it. Prints a line for each claim, as the verification programs do, and the count; rows without
# ok or FAIL stand beside data and are no targets. KULLUK=200 shortens the runs of IS11 and IS12 to that many seconds.
set -u
build=$(cd "${1:?usage: ice_scenes.sh BUILD}" && pwd) || exit 2
here=$(cd "$(dirname "$0")/../share/examples/ice-scenes" && pwd) || exit 4
PATH=$build/bin:$PATH
dir=$(mktemp -d "${TMPDIR:-/tmp}/ice-scenes.XXXXXX") || exit 4
trap 'rm -rf "$dir"' EXIT
rows=${ROWS:-IS3 IS4 IS5 IS6 IS7 IS8 IS9 IS10 IS11 IS12}
good=0 bad=0

wants() # ID...
{
    for id; do case " $rows " in *" $id "*) return 0 ;; esac; done
    return 1
}
row() # ID WHAT VALUE EXPECTED TOLERANCE: absolute
{
    if awk -v x="$3" -v e="$4" -v t="$5" 'BEGIN { d = x - e; exit !(x != "" && d * d <= t * t) }'; then
        good=$((good + 1)) said=ok
    else bad=$((bad + 1)) said=FAIL; fi
    awk -v id="$1" -v what="$2" -v x="$3" -v e="$4" -v t="$5" -v said=$said \
        'BEGIN { printf "%-5s %-62s %10.4g %10.4g +- %-8.3g %s\n", id, what, x, e, t, said }'
}
beside() # ID WHAT TEXT: printed beside, no target
{
    printf '%-5s %-62s %s\n' "$1" "$2" "$3"
}
calc() { awk "BEGIN { print ($1) }"; } # in brackets, as > would be a file
power() { calc "log($2 / $1) / log($4 / $3)"; } # FROM TO AT TO: power of a quantity with another

# mean_of TABLE FROM [TO]: mean of the horizontal force along the drift [kN]; peak_of: its largest value
mean_of() { loadstats -q --from "$2" --to "${3:-1e9}" -t stats -c fx -p total "$1" | value_of mean; }
peak_of() { loadstats -q --from "$2" -t stats -c fx -p total "$1" | value_of largest; }
value_of()
{
    awk -F '\t' -v name="$1" '/^#/ { next } !c { for (k = 1; k <= NF; k++) if ($k == name) c = k; next }
        { x = $c / 1e3; print x < 0 ? -x : x }'
}

# ship C V SEED FACTOR WIDTH: leaves its table, and prints its name; widths in m, or free
ship()
{
    name=$dir/ship-$1-$2-$3-$4-$5.tsv
    if [ ! -f "$name" ]; then
        width=$5 bounds=
        [ "$5" = free ] && width=344
        n=$(calc "int(358 * $width / 344 + 0.5)") half=$(calc "$width / 2")
        voronoi-ice -q --gaps even --size "260x$width" --origin "26,-$half" --floes "$n" --concentration "$1" --thickness 1 \
            --radius 0.1 --seed "$3" -o "$dir/floes.dat" || return 1
        case $5 in
        free) bounds="--set boundary.type=free" ;;
        esac
        time=$(calc "$2 < 1.5 ? 120 : $2 > 3 ? 45 : 80")
        # shellcheck disable=SC2086 # options
        dem-solve -q --ice "$dir/floes.dat" --structure "$dir/hull.dat" --set "structure.velocity=$2 0 0 m/s" \
            --set "contact.stiffness_factor=$4" --set "boundary.min=none -$half none m" \
            --set "boundary.max=none $half none m" --set "run.duration=$time" $bounds -o "$name" "$here/ship.scene" \
            2>/dev/null || return 1
    fi
    echo "$name"
}
resistance() # C V SEED FACTOR WIDTH: from 20 m of ice on [kN]
{
    table=$(ship "$@") && mean_of "$table" "$(calc "20 / $2")"
}
struct-import -q -n hull -o "$dir/hull.dat" "$here/hull.off" || exit 1

echo "ice scenes: the ship and the jacket beside closed forms"
momentum() { calc "1.3 * 900 * 1 * $1 * (17.2 + 14) * $2 ^ 2 / 1e3"; }
colbourne() { calc "0.5 * $3 * ($2 / sqrt(9.81 * $1)) ^ ($4) * 900 * 17.2 * $2 ^ 2 * $1 ^ $5 / 1e3"; } # C V K B N
beside_colbourne() # ID C V
{
    beside "$1" "  Colbourne at C $2, $3 m/s: slender, blunt bow [kN]" \
        "$(calc "int($(colbourne "$2" "$3" 4.4 -0.8267 2) + 0.5)"), $(calc "int($(colbourne "$2" "$3" 16.1 -1.7937 3) + 0.5)")"
}
if wants IS3; then
    sum=0
    for seed in 1 2 3 4 5; do sum=$(calc "$sum + $(resistance 0.6 2 $seed 0.1 344)"); done
    row IS3 "hull at 2 m/s, C 0.6, mean of five seeds; momentum [kN]" "$(calc "$sum / 5")" "$(momentum 0.6 2)" \
        "$(calc "0.25 * $(momentum 0.6 2)")"
    slow=$(resistance 0.6 1 1 0.1 344) fast=$(resistance 0.6 4 1 0.1 344)
    row IS3 "power of the resistance with the speed, 1 to 4 m/s" "$(power "$slow" "$fast" 1 4)" 2.2 0.3
    beside_colbourne IS3 0.6 2
fi
if wants IS4; then
    six=$(resistance 0.6 2 1 0.1 344)
    for c in 0.7 0.8 0.9; do beside IS4 "hull at 2 m/s, C $c [kN]" "$(resistance $c 2 1 0.1 344)" && beside_colbourne IS4 $c 2; done
    row IS4 "power of the resistance with C, 0.6 to 0.8" "$(power "$six" "$(resistance 0.8 2 1 0.1 344)" 0.6 0.8)" 2.41 0.5
fi
if wants IS5; then
    one=$(resistance 0.8 1 1 0.1 344) two=$(resistance 0.8 2 1 0.1 344) four=$(resistance 0.8 4 1 0.1 344)
    row IS5 "C 0.8: power with the speed, 1 to 2 m/s" "$(power "$one" "$two" 1 2)" 1 0.4
    row IS5 "C 0.8: power with the speed, 2 to 4 m/s" "$(power "$two" "$four" 2 4)" 1.75 0.4
fi
if wants IS6; then
    wide=$(resistance 0.8 2 1 0.1 344)
    row IS6 "C 0.8: free sides over walls 20 B apart" "$(calc "$(resistance 0.8 2 1 0.1 free) / $wide")" 1 0.25
    row IS6 "C 0.8: walls 5 B apart over 20 B: they are reached" "$(calc "$(resistance 0.8 2 1 0.1 86) / $wide")" 1.5 0.4
fi
if wants IS7; then
    soft=$(ship 0.6 2 1 0.02 344) firm=$(ship 0.6 2 1 0.1 344) hard=$(ship 0.6 2 1 1 344)
    row IS7 "stiffness factor 0.02 over 0.1: mean" "$(calc "$(mean_of "$soft" 10) / $(mean_of "$firm" 10)")" 1 0.25
    row IS7 "stiffness factor 1 over 0.1: mean" "$(calc "$(mean_of "$hard" 10) / $(mean_of "$firm" 10)")" 1 0.25
    beside IS7 "  largest at 0.02, 0.1, 1 [kN]" "$(peak_of "$soft" 10), $(peak_of "$firm" 10), $(peak_of "$hard" 10)"
fi
# jacket C SEED [SECONDS]: leaves legs.tsv, and what both programs warn of in `said`
jacket()
{
    voronoi-ice -q --gaps even --size 160x80 --origin -120,-40 --floes 356 --periodic xy --concentration "$1" --thickness 0.4 \
        --velocity 0.7,0 --keep-out circle:-10,10,2 --keep-out circle:-10,-10,2 --keep-out circle:10,10,2 \
        --keep-out circle:10,-10,2 --seed "$2" -o "$dir/ice.dat"
    dem-solve -q --ice "$dir/ice.dat" --structure "$dir/legs.dat" -o "$dir/legs.tsv" \
        --set "run.duration=${3-120} s" "$here/jacket.scene" 2>"$dir/said"
    loadstats --from 30 -t stats -c fx -p total -o "$dir/stats.tsv" "$dir/legs.tsv" 2>>"$dir/said"
}
says() { grep -c "$1" "$dir/said"; }
struct-import -q -n nw --cylinder 0.75,-5,5,-10,10 -n sw --cylinder 0.75,-5,5,-10,-10 -n ne --cylinder 0.75,-5,5,10,10 \
    -n se --cylinder 0.75,-5,5,10,-10 -o "$dir/legs.dat"
if wants IS8; then
    first=0 second=0
    for seed in 1 2 3 4; do
        jacket 0.5 $seed
        first=$(calc "$first + $(mean_of "$dir/legs.tsv" 30 75) / 4")
        second=$(calc "$second + $(mean_of "$dir/legs.tsv" 75 120) / 4")
        row IS8 "C 0.5, seed $seed: warnings that it jams" "$(says 'too narrow\|a jam has met')" 0 0
        row IS8 "C 0.5, seed $seed: warnings that the mean does not stay" "$(says 'not stationary')" 0 0
    done
    row IS8 "jacket, C 0.5, mean of four seeds, 30 to 75 s [kN]" "$first" 2.4 1.3
    row IS8 "jacket, C 0.5, mean of four seeds, 75 to 120 s [kN]" "$second" 2.4 1.3
    beside IS8 "  momentum of what passes two front legs [kN]" "$(calc "2 * 1.3 * 900 * 0.4 * 0.5 * 0.7 ^ 2 * (1.5 + 6) / 1e3")"
fi
if wants IS9; then # 75 s of one field show that it is flagged; a jam takes four times as long as ice that passes
    jacket 0.7 1 75
    beside IS9 "jacket, C 0.7, 30 to 52, 52 to 75 s, largest [kN]" \
        "$(mean_of "$dir/legs.tsv" 30 52), $(mean_of "$dir/legs.tsv" 52 75), $(peak_of "$dir/legs.tsv" 30)"
    row IS9 "C 0.7: dem-solve warns that the field is too narrow" "$(says 'dem-solve: warning: the field is too narrow')" 1 0
    row IS9 "  loadstats says so of the record" "$(says 'loadstats: warning: the run says: the field is too narrow')" 1 0
    beside IS9 "  warned that the mean does not stay" "$(says 'loadstats: warning: .* is not stationary')"
fi
if wants IS10; then
    voronoi-ice -q --gaps even --size 240x80 --origin -235,-40 --floes 534 --concentration 0.7 --thickness 0.4 --velocity 0.7,0 \
        --keep-out "$dir/legs.dat" --margin 0.3 -o "$dir/ice.dat"
    sed '/^type\|^inflow/d; s/^min = .*/min = none -40 none m/; s/^max = .*/max = none 40 none m/' "$here/jacket.scene" \
        >"$dir/once.scene"
    printf '[contact ice boundary]\nfriction = 0\n' >>"$dir/once.scene"
    dem-solve -q --ice "$dir/ice.dat" --structure "$dir/legs.dat" -o "$dir/once.tsv" "$dir/once.scene" 2>/dev/null
    bound=$(calc "0.5 * 1025 * 0.005 * 0.7 ^ 2 * 0.7 * 240 * 80 / 1e3")
    beside IS10 "field once, C 0.7: mean to 100 s, from 100 to 120 s [kN]" \
        "$(mean_of "$dir/once.tsv" 30 100), $(mean_of "$dir/once.tsv" 100 120); drag on all of the ice $bound"
    # The ice can give its drag, and once the momentum with which it came.
    row IS10 "  impulse in 120 s over drag and momentum of all ice: below 1" \
        "$(calc "120 * $(mean_of "$dir/once.tsv" 0 120) / (120 * $bound + 900 * 0.4 * 0.7 * 240 * 80 * 0.7 / 1e3)")" 0.5 0.5
fi
# kulluk C SECONDS: leaves wide.tsv of a cone of 69 m at the water line, in drift without end
kulluk()
{
    voronoi-ice -q --gaps even --size 500x500 --floes 800 --origin -400,-250 --periodic xy --concentration "$1" --thickness 1 \
        --radius 0.1 --velocity 0.3,0 --keep-out circle:0,0,40 -o "$dir/ice.dat"
    sed 's/^min = .*/min = -400 -250 none m/; s/^max = .*/max = 150 250 none m/; s/^inflow_pitch = .*/inflow_pitch = 500 m/
        s/^current = .*/current = 0.3 m\/s/; s/^duration = .*/duration = '"$2"' s/' "$here/jacket.scene" >"$dir/wide.scene"
    dem-solve -q --ice "$dir/ice.dat" --structure "$dir/kulluk.dat" --set 'output.loads_every=0.1 s' -o "$dir/wide.tsv" \
        "$dir/wide.scene" 2>"$dir/said"
}
blunt() { calc "int(0.5 * 16.1 * (0.3 / sqrt(9.81 * $1)) ^ (-1.7937) * 900 * 70 * 0.3 ^ 2 * $1 ^ 3 / 1e3 + 0.5)"; } # C
struct-import -q -n kulluk --cone 21.9,-8,40.5,3.36 -o "$dir/kulluk.dat"
if wants IS11; then
    long=${KULLUK:-400}
    for c in 0.7 0.8; do
        kulluk $c "$long"
        beside IS11 "cone of 70 m, 0.3 m/s, C $c, 25 to $long s: mean [kN]" \
            "$(mean_of "$dir/wide.tsv" 25); momentum $(calc "1.3 * 900 * $c * 0.3 ^ 2 * (70 + 15) / 1e3"), Colbourne blunt $(blunt $c)"
    done
fi
if wants IS12; then
    long=${KULLUK:-300}
    to=$(calc "$long < 200 ? $long : 200")
    kulluk 0.9 "$long"
    beside IS12 "the same, C 0.9, 50 to $to s: mean [kN]" "$(mean_of "$dir/wide.tsv" 50 "$to"); Colbourne blunt $(blunt 0.9)"
    [ "$long" -le 200 ] || beside IS12 "  200 to $long s: mean [kN]" "$(mean_of "$dir/wide.tsv" 200)"
    row IS12 "  warned that it jams" "$(says 'warning: the field is too narrow')" 1 0
fi
echo "$good passed, $bad failed"
[ $bad -eq 0 ]
