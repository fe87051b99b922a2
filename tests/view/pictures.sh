#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# pictures.sh BUILD [update] -- pictures and films of ice-view without a display, by Mesa's software renderer.
# A picture is compared with expect/NAME.bmp.gz: at most 1 byte in 1000 may be off by more than 5 of 255, which is what
# processors without AVX were seen to need.  `update` writes what is expected.  Prints "N passed, N failed"; where there is
# no OpenGL, or no ffmpeg, what needs it is skipped with a line.
set -u
LC_ALL=C LIBGL_ALWAYS_SOFTWARE=1
export LC_ALL LIBGL_ALWAYS_SOFTWARE
here=$(cd "$(dirname "$0")" && pwd)
PATH=$(cd "${1:?usage: pictures.sh BUILD [update]}" && pwd)/bin:$PATH
export PATH
update=${2-}
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-pictures.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
trap 'exit 130' INT TERM HUP
cd "$scratch" || exit 4
passed=0 failed=0
verdict() # WHAT STATUS
{
    if [ "$2" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "pictures: $1"; fi
}
finish() { echo "$passed passed, $failed failed"; [ $failed -eq 0 ]; exit; }

# Twenty floes that drift against a cylinder for 4 s, as a run wrote them, with loads and contacts: pictures do not change
# with the physics.  The waves of a scene, a layer of spheres, a structure.
cp "$here"/input/* .
struct-import --name leg --cylinder 1,-3,3,4,0 --facets 32 -q -o leg.dat
printf '[ice]\nfile = ice.dat\n[water]\nwave = airy\nheight = 0.5 m\nperiod = 3 s\n' >a.scene
voronoi-ice --gaps even --size 12x10 --origin -9,-5 --floes 20 --concentration 0.8 --thickness 0.4 --radius 0.1 --seed 4 --velocity 1,0 -q -o ice.dat
awk 'BEGIN { print "#g-polys 1"; for (i = 0; i < 400; i++) printf "poly %d 0.25 1 0\nv %g %g %g\n", i, 0.5 * (i % 20), 0.5 * int(i / 20), 0.1 * (i % 3) }' >balls.dat

ice-view -q --size 64x64 -o probe.bmp ice.dat 2>log
status=$?
if [ $status -eq 4 ]; then
    echo "pictures: skipped, $(cat log)"
    passed=1
    finish
fi
verdict "a first picture: status $status, $(cat log)" $status

one() # NAME OPTIONS: the picture NAME against what is expected
{
    name=$1
    shift
    ice-view -q --size 320x200 -o "$name.bmp" "$@" 2>log || { verdict "$name: $(cat log)" 1; return; }
    if [ "$update" = update ]; then
        mkdir -p "$here/expect" && gzip -9nc "$name.bmp" >"$here/expect/$name.bmp.gz"
        return
    fi
    gzip -dc "$here/expect/$name.bmp.gz" >expected.bmp
    [ "$(wc -c <"$name.bmp")" -eq "$(wc -c <expected.bmp)" ]
    verdict "$name has another size" $?
    cmp -l "$name.bmp" expected.bmp | awk -v all="$(wc -c <expected.bmp)" '
        function octal(s,    n, k) { for (k = 1; k <= length(s); k++) n = 8 * n + substr(s, k, 1); return n }
        { d = octal($2) - octal($3); if (d > 5 || d < -5) far++ }
        END { if (far > all / 1000) { print far " of " all " bytes are off by more than 5"; exit 1 } }'
    verdict "$name is not as expected" $?
}

one ice frames.dat --at 3
one speed frames.dat --at 3 --by speed --loads loads.tsv
one chains frames.dat --at 3 --view plan --by diameter --set ice.opacity=0.5 --contacts contacts.tsv --set colour.map=cividis
one cut frames.dat --at 3 --view drift --by one --set cut.axis=y --set cut.at=0 --set structure.opacity=0.5
one waves frames.dat --at 3 --view side --set view.projection=perspective --set view.elevation=8 --scene a.scene
one spheres balls.dat --by height --set view.azimuth=-60
one structure leg.dat --set water.shown=no --set background.kind=plain

# A level face in the sun has the colour of the bar: the middle of a plate from above, 100 150 200.
printf '#g-polys 1\npoly 1 0.1 8 6\nv -5 -5 0\nv 5 -5 0\nv 5 5 0\nv -5 5 0\nv -5 -5 1\nv 5 -5 1\nv 5 5 1\nv -5 5 1\nf 4 0 3 2 1\nf 4 4 5 6 7\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7\n' >plate.dat
ice-view -q --size 64x64 --view plan --by one --set ice.colour=6496c8 --set light.occlusion=0 -o plate.bmp plate.dat
# 54 bytes of head, rows of 192, blue first
od -An -tu1 -j $((54 + 192 * 32 + 3 * 32)) -N 3 plate.bmp | awk '{ bad = 0; split("200 150 100", want); for (k = 1; k <= 3; k++) if ($k - want[k] > 1 || want[k] - $k > 1) bad = 1; exit bad }'
verdict "a level face in the sun has another colour: $(od -An -tu1 -j $((54 + 192 * 32 + 96)) -N 3 plate.bmp)" $?

# The same bytes: again, with one thread, from a saved look, from packed frames within their bound (compared above).
ice-view -q --size 320x200 --at 3 --by speed --save-look my.look -o first.png frames.dat
ice-view -q -j 1 --at 3 --look my.look -o second.png frames.dat
cmp -s first.png second.png
verdict "a picture from its look, with one thread, is another" $?

refused() # STATUS SENTENCE OPTIONS
{
    want=$1 sentence=$2
    shift 2
    ice-view -q "$@" 2>log
    status=$?
    if [ $status -eq "$want" ] && grep -q "$sentence" log; then verdict "" 0; else verdict "$*: status $status, $(cat log)" 1; fi
}
refused 2 'a picture ends in .png, .bmp or .jpg' -o a.gif frames.dat
refused 2 'the frames are from 0 s to 4 s' -o a.png --at 9 frames.dat
refused 4 'there is no folder' -o no/such/a.png frames.dat
refused 3 'has one picture, and no film' --movie a.mp4 leg.dat
refused 2 'a film ends in' --movie a.gif frames.dat
refused 2 'the size of a film is even' --movie a.mp4 --size 101x100 frames.dat
refused 2 'the frames are from 0 s to 4 s' --movie a.mp4 --from 5 frames.dat
unset DISPLAY WAYLAND_DISPLAY
refused 4 'no window' frames.dat

mkdir empty && PATH_BEFORE=$PATH && ln -s "$(command -v ice-view)" empty/ice-view
# shellcheck disable=SC2123 # the search path is meant
PATH=$scratch/empty
export PATH
ice-view -q --movie a.mp4 frames.dat 2>log
status=$?
PATH=$PATH_BEFORE
export PATH
[ $status -eq 4 ] && grep -q 'package ffmpeg' log
verdict "without ffmpeg: status $status, $(cat log)" $?

if command -v ffmpeg >/dev/null && command -v ffprobe >/dev/null; then
    for film in a.mp4 a.avi; do
        ice-view -q --movie $film --size 160x100 --fps 10 --times 2 frames.dat 2>log
        verdict "$film: $(cat log)" $?
        found=$(ffprobe -v error -count_frames -select_streams v -show_entries stream=width,height,nb_read_frames -of csv=p=0 $film)
        [ "$found" = 160,100,21 ]
        verdict "$film has $found, 160,100,21 is expected" $?
    done
    ice-view -q --size 64x64 -o a.jpg ice.dat && [ "$(ffprobe -v error -show_entries stream=codec_name -of csv=p=0 a.jpg)" = mjpeg ]
    verdict "a.jpg" $?
else
    echo "pictures: films skipped, no ffmpeg"
fi
finish
