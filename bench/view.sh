#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# view.sh [BUILD [OUT]] -- frames and ice-view: sizes, seconds of processor, memory, with the programs of BUILD/bin.
#   OUT/view.tsv   a row for each figure, with what is asked of it; its head names the machine.  OUT is bench/results
# bench/README.md explains the rows.  Seconds are those of the processor, all threads, so that they do not depend on how
# busy the machine is; pictures by Mesa's software renderer.
#   FLOE_QUICK=1        fewer spheres, shorter runs
set -u
LC_ALL=C LIBGL_ALWAYS_SOFTWARE=1
export LC_ALL LIBGL_ALWAYS_SOFTWARE
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
fail() { echo "view.sh: $*" >&2; exit 4; }
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" "$build/view" || exit 4
out=$(cd "$out" && pwd)
PATH=$build/bin:$PATH
if [ "${FLOE_QUICK:-0}" = 0 ]; then spheres=332000 frames=12 minute=60 many=1000; else spheres=20000 frames=6 minute=6 many=50; fi
here=$build/view/$$
mkdir -p "$here" && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP

# seconds COMMAND: its processor time, user and system.
seconds()
{
    sh -c '"$@" >stdout 2>stderr </dev/null || exit; times' sh "$@" >spent || fail "$*, $(cat stderr)"
    awk 'NR == 2 { for (k = 1; k <= 2; k++) { split($k, t, "m"); s += 60 * t[1] + t[2] } print s }' spent
}
bytes() { wc -c <"$1" | tr -d ' '; }
# Without the text of shapes and parts.
frame_bytes() { echo $(($(bytes "$1") - $(grep -abo '^packed' "$1" | head -n 1 | cut -d : -f 1))); }
per() { awk -v a="$1" -v b="$2" -v f="${3:-%.3g}" 'BEGIN { printf f, a / b }'; }
row() { printf '%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "$4" | tee -a rows; } # WHAT VALUE UNIT ASKED

# The demo, frames every 0.1 s.
struct-import --name leg --cylinder 1.5,-5,5,27,0 --facets 64 -q -o leg.dat
voronoi-ice --size 50x50 --floes 200 --concentration 0.8 --thickness 0.5 --radius 0.05 --seed 1 --velocity 0.5,0 -q -o ice.dat
scene=$bench/../share/examples/cylinder/cylinder.scene
dem-solve -q --ice ice.dat --structure leg.dat --set run.duration=$minute --set output.frames_every=0.1 --set output.energy=none \
    --set output.state=none --set output.frames=demo.dat -o demo.tsv "$scene" || fail "the demo"
n=$((10 * minute + 1))
row 'demo: text, a body and frame' "$(per "$(bytes demo.dat)" $((200 * n)))" bytes -
t=$(seconds ice-view --packed demo.packed demo.dat)
row 'demo: packed, a body and frame' "$(per "$(frame_bytes demo.packed)" $((200 * n)))" bytes 12
ice-view --html demo.html --loads demo.tsv demo.dat || fail page
row 'demo: page of all frames' "$(per "$(bytes demo.html)" 1e6)" MB 5
row 'demo: text to packed' "$(per "$t" $((200 * n)) '%.2g')" 's a body and frame' -

# The cost of frames in a run of 10 000 floes, ten a second: from 500 a second, so that it stands out of the noise.
voronoi-ice --size 350x350 --floes 10000 --concentration 0.7 --thickness 0.5 --radius 0.05 --seed 1 --velocity 0.5,0 -q -o many.dat
printf '[run]\nduration = 1 s\n[contact]\nstiffness_factor = 0.025\n[water]\ncurrent = 0.5 m/s\n[output]\nframes_every = 2 ms\n' >many.scene
none=$(seconds dem-solve -q -j 2 --ice many.dat -o many.tsv many.scene)
t=$(seconds dem-solve -q -j 2 --ice many.dat --set output.frames=many.frames --set output.frames_form=packed -o many.tsv many.scene)
row '10 000 floes, 10 packed frames a second' "$(awk -v a="$t" -v b="$none" 'BEGIN { printf "%.2g", 100 * (a - b) / 50 / b }')" '% of the run' 3
row '10 000 floes: packed, a body and frame' "$(per "$(frame_bytes many.frames)" 5010000)" bytes 12

# Spheres: a sheet that waves and drifts.
awk -v n=$spheres -v frames=$frames 'BEGIN { print "#animation 1"; side = int(sqrt(n / 4)) + 1
    for (i = 0; i < n; i++) printf "shape %d 0.125 1 0\nv 0 0 0\n", i
    for (k = 0; k < frames; k++) { print "frame", 0.1 * k
        for (i = 0; i < n; i++) { x = 0.25 * (int(i / 4) % side); printf "body %d %.9g %.9g %.9g 1 0 0 0\n", i, x + 0.02 * k + 1e-4 * rand(), 0.2165 * int(i / 4 / side), 0.2 * (i % 4) + 0.1 * sin(0.3 * x - 0.12 * k) } } }' >balls.dat
t=$(seconds ice-view --info balls.dat)
row "$spheres spheres: index and box of $frames frames of text" "$t" s -
row "$spheres spheres: the same" "$(awk -v b="$(bytes balls.dat)" -v t="$t" 'BEGIN { printf "%.3g", b / t / 1e6 }')" MB/s -
ice-view --packed balls.packed balls.dat || fail packed
row "$spheres spheres: packed, a body and frame" "$(per "$(frame_bytes balls.packed)" $((spheres * frames)))" bytes 12
row "$spheres spheres: index and box of packed frames" "$(seconds ice-view --info balls.packed)" s -
if [ -x /usr/bin/time ]; then
    for f in balls.dat balls.packed; do
        /usr/bin/time -f %M ice-view --info $f 2>memory >/dev/null
        row "$spheres spheres: memory of ice-view, index and a frame of $f" "$(per "$(tail -n 1 memory)" 1e3)" MB -
    done
fi

# Real size: spheres and blocks of ice through a long run, packed, written a frame at a time.
blocks=20000 big="$spheres spheres, 20000 blocks, $many frames"
can_draw=0
ice-view -q --size 64x64 -o probe.png ice.dat 2>/dev/null && can_draw=1
if [ -x "$build/tests/bench/bench_frames" ]; then
    ns=$("$build/tests/bench/bench_frames" $spheres $blocks $many big.packed) || fail 'the frames of a long run'
    row "$big: packed, a body and frame" "$(per "$(frame_bytes big.packed)" $(((spheres + blocks) * many)))" bytes 12
    row "$big: time of the writer, a body and frame" "$ns" ns -
    row "$big: file" "$(per "$(bytes big.packed)" 1e6)" MB -
    measured() # WHAT OPTIONS: processor time and memory of ice-view
    {
        what=$1 most=$2
        shift 2
        if [ -x /usr/bin/time ]; then
            /usr/bin/time -f '%U %S %M' -o memory ice-view "$@" >stdout 2>stderr || fail "$*, $(cat stderr)"
            row "$big: $what" "$(awk '{ print $1 + $2 }' memory)" s "$most"
            row "$big: $what, memory" "$(awk '{ printf "%.0f", $3 / 1e3 }' memory)" MB -
        else row "$big: $what" "$(seconds ice-view "$@")" s "$most"; fi
    }
    measured 'index and box' - --info big.packed
    if [ $can_draw -eq 1 ]; then
        measured 'picture of 1280x720, a frame amid' 20 -q --by height --at "$(awk -v n="$many" 'BEGIN { print 0.05 * n + 0.7 }')" -o big.png big.packed
        cp big.png "$out/view-big.png"
    fi
    rm -f big.packed
else echo 'view.sh: no tests/bench/bench_frames (make tests): no frames of a long run' >&2; fi

# Pictures and films.
if [ $can_draw -eq 1 ]; then
    row 'demo: picture of 1280x720' "$(seconds ice-view -q --at $((minute / 2)) --by speed --loads demo.tsv -o demo.png demo.dat)" s -
    row "$spheres spheres: picture of 1280x720" "$(seconds ice-view -q --by height -o balls.png balls.packed)" s 20
    if command -v ffmpeg >/dev/null; then
        t=$(seconds ice-view -q --movie demo.mp4 --by speed demo.dat)
        row "demo: film of $minute s, 1280x720, 25 a second" "$t" s 120
        row 'demo: the same, a picture' "$(per "$t" $((25 * minute + 1)))" s 0.08
        row 'demo: its size' "$(per "$(bytes demo.mp4)" 1e6)" MB -
        row 'demo: film of make demo, x 8, 640x360' "$(seconds ice-view -q --movie d.mp4 --times 8 --size 640x360 --set light.occlusion=0 --by speed --loads demo.tsv demo.dat)" s 10
    fi
else
    echo 'view.sh: pictures skipped, no OpenGL' >&2
fi
{
    echo '#view 1'
    printf '#by %s\n' "$(ice-view --version | head -n 1)"
    printf '#processor %s, %s\n' "$(awk -F ': ' '/^model name/ { print $2; exit }' /proc/cpuinfo 2>/dev/null)" "$(uname -m)"
    printf '#load %s over 1, 5 and 15 minutes\n' "$(cut -d ' ' -f 1-3 /proc/loadavg 2>/dev/null | tr ' ' ',')"
    printf 'what\tvalue\tunit\tat_most\n'
    cat rows
} >"$out/view.tsv"
