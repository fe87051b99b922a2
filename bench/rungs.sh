#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# rungs.sh -- functions that ladder.sh, surrogate.sh, sleep.sh and threads.sh share: make a scene, choose its step, run it.
# The scripts source it.  They set bench (the folder of this file), here (the folder of the runs), quick (0 or not) and
# fail.
# shellcheck disable=SC2154 # these variables

# run SCENE NAME PROGRAM OPTION...: one run; writes NAME.loads .state .report .status in the folder of the scene.
run()
{
    s=$1 n=$2 p=$3
    shift 3
    "$p" -q --ice "$s/ice.dat" --structure "$s/structure.dat" \
        --set run.duration="$(cat "$s/seconds")" --set output.state="$s/$n.state" --set output.state_every="$(cat "$s/seconds")" \
        --report "$s/$n.report" -o "$s/$n.loads" "$@" "$s/scene" 2>"$s/$n.err"
    echo $? >"$s/$n.status"
}

# best SCENE NAME COMMAND...: runs the command, which runs NAME of SCENE, and keeps the report with the least processor
# time so far.
best()
{
    kept=$1/$2
    shift 2
    [ -f "$kept.report" ] && mv "$kept.report" "$kept.best"
    "$@"
    [ -f "$kept.best" ] &&
        awk -v a="$(number "$kept.best" processor)" -v b="$(number "$kept.report" processor)" 'BEGIN { exit !(a < b) }' &&
        mv "$kept.best" "$kept.report"
    return 0
}

# matches NAME PATTERNS: true if the name matches one of the patterns
matches()
{
    set -f # no expansion to file names
    for p in $2; do
        # shellcheck disable=SC2254 # a pattern
        case $1 in
        $p) set +f && return 0 ;;
        esac
    done
    set +f
    return 1
}

# A field of N floes with a cylinder for every 200 of them.
field() # N
{
    awk -v n="$1" 'BEGIN {
        side = 50 * sqrt(n / 200); m = int(sqrt(n / 200) + 0.5); m = m > 0 ? m : 1
        for (i = 0; i < m; i++) for (k = 0; k < m; k++)
            printf " --name leg%d --cylinder 1,-5,5,%.6g,%.6g", ++c,
                (i + 0.5) * side / m - side / 2, (k + 0.5) * side / m - side / 2
    }' >legs
    # shellcheck disable=SC2046 # options
    struct-import -q $(cat legs) -o structure.dat || exit 4
    side=$(awk -v n="$1" 'BEGIN { printf "%.6g", 50 * sqrt(n / 200) }')
    voronoi-ice -q --size "${side}x$side" --floes "$1" --thickness 0.5 --radius 0.05 --velocity 0.5,0 \
        --keep-out structure.dat | awk -f "$bench/stir.awk" >ice.dat
}
pack() # LAYERS
{
    voronoi-ice -q --lattice hcp --layers "$1" --diameter 0.25 --size 18x16 -o ice.dat || exit 4
    low=$(awk '/^v / { z = $4 < z ? $4 : z } END { printf "%.17g", z - 0.125 }' ice.dat)
    struct-import -q --name plate --box "-10,-9,-6,10,9,$low" -o structure.dat
}

# Writes ice, structure and scene to a folder of that name.
make_scene() # NAME
{
    mkdir "$1" && cd "$1" || exit 4
    case $1 in
    field-*) field "${1#field-}" ;;
    pack-100000) pack 19 ;;
    pack-*) pack 1 ;;
    pair) struct-import -q --name post --cylinder 1,-2,2,2.05,0.1 -o structure.dat ;;
    stack) struct-import -q --name plate --box -2,-2,-1,2,2,0 -o structure.dat ;;
    hard-pebble) struct-import -q --name post --cylinder 0.5,-1,1,0.5,0 -o structure.dat ;;
    hard-thin) struct-import -q --name block --box -1,-1,-1,0.5,1,0 -o structure.dat ;;
    hard-pinched)
        struct-import -q --name left --cylinder 0.8,-2,2,2,1.5 --name right --cylinder 0.8,-2,2,2,-1.5 \
            -o structure.dat
        ;;
    hard-cradle) struct-import -q --name block --box 0.55,-1,-1,1.5,1,1 -o structure.dat ;;
    hard-hook)
        struct-import -q --name one --box -1,-1,-1,0,3,1 --name two --box 0,-1,-1,3,0,1 -o structure.dat
        ;;
    cylinder)
        voronoi-ice -q --size 50x50 --floes 200 --thickness 0.5 --radius 0.05 --velocity 0.5,0 -o ice.dat &&
            struct-import -q --name leg --cylinder 1.5,-5,5,27,0 -o structure.dat
        ;;
    hard-fast) struct-import -q --name block --box 0,-3,-3,1,3,3 -o structure.dat ;;
    esac || fail "$1: could not be made"
    from=$bench/scenes/${1%-[0-9]*}.scene
    [ -f "$bench/scenes/$1.floes" ] && awk -f "$bench/floes.awk" "$bench/scenes/$1.floes" >ice.dat
    [ "$1" = cylinder ] && from=$bench/../share/examples/cylinder/cylinder.scene
    grep -Ev '^(state|energy|frames)(_every)? ' "$from" >scene # only the table of loads is used
    cd "$here" && seconds "$1" >"$1/seconds" || exit 4
}

# Duration of a scene [s].
seconds() # NAME
{
    case $1:$quick in
    field-200:0) echo 0.8 ;;
    field-2000:0) echo 0.6 ;;
    field-2000:*) echo 0.3 ;;
    field-*) echo 0.4 ;;
    cylinder:0) echo 4 ;;
    cylinder:*) echo 2 ;;
    *) awk '$1 == "duration" { print $3 * ($4 == "ms" ? 1e-3 : 1) }' "$bench/scenes/${1%-[0-9]*}.scene" ;;
    esac
}

# critical SCENE LAW: critical step of the stiffest contact that any body can make.
critical()
{
    dem-solve -j 1 --plan --ice "$1/ice.dat" --structure "$1/structure.dat" --set contact.law="$2" \
        "$1/scene" |
        awk '{ for (k = 1; k < NF; k++) if ($k == "critical") print $(k + 1) }'
}

# step SCENE LAW FRACTION: that fraction of the critical step, reduced so that it divides the interval of the loads.
step()
{
    [ -f "$1/critical.$2" ] || critical "$1" "$2" >"$1/critical.$2"
    awk -v f="$3" 'NR == FNR { c = $1 } $1 == "loads_every" { every = 1e-3 * $3 } END {
        m = every / (f * c); m = m > int(m) ? int(m) + 1 : int(m)
        printf "%.17g\n", every / m }' "$1/critical.$2" "$1/scene"
}
number() { awk -v key="$2" 'index($0, key) { sub(".*" key " *", ""); print $1 + 0; exit }' "$1"; }

say() { printf '%-14s %-9s %s\n' "$1" "$2" "$3" >&2; }
