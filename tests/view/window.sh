#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# window.sh BUILD -- the window of ice-view under Xvfb, driven by xdotool: play, turn, colour, click, picture, settings,
# video.  Screens are compared with each other, taken by import.  Prints "N passed, N failed"; skipped with a line where
# Xvfb, xdotool, import or the window are not there.
set -u
LC_ALL=C LIBGL_ALWAYS_SOFTWARE=1
export LC_ALL LIBGL_ALWAYS_SOFTWARE
PATH=$(cd "${1:?usage: window.sh BUILD}" && pwd)/bin:$PATH
export PATH
skip() { echo "window: skipped, $1"; echo "1 passed, 0 failed"; exit 0; }
for program in Xvfb xdotool import; do command -v $program >/dev/null || skip "no $program"; done
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-window.XXXXXX") || exit 4
server='' viewer=''
# shellcheck disable=SC2317 # called by the trap
stop() { [ -n "$viewer" ] && kill "$viewer" 2>/dev/null; [ -n "$server" ] && kill "$server" 2>/dev/null; rm -rf "$scratch"; }
trap stop EXIT
trap 'exit 130' INT TERM HUP
cd "$scratch" || exit 4
passed=0 failed=0
verdict() # WHAT STATUS
{
    if [ "$2" -eq 0 ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "window: $1"; fi
}
finish() { echo "$passed passed, $failed failed"; [ $failed -eq 0 ]; exit; }

# Two floes and a sphere that move along x for 4 s.
{
    printf '#animation 1\nshape 1 0.1 8 6\nv -2 -2 -0.2\nv 2 -2 -0.2\nv 2 2 -0.2\nv -2 2 -0.2\nv -2 -2 0.2\nv 2 -2 0.2\nv 2 2 0.2\nv -2 2 0.2\n'
    printf 'f 4 0 3 2 1\nf 4 4 5 6 7\nf 4 0 1 5 4\nf 4 1 2 6 5\nf 4 2 3 7 6\nf 4 3 0 4 7\nshape 2 0.8 1 0\nv 0 0 0\n'
    for t in 0 1 2 3 4; do printf 'frame %d\nbody 1 %d 0 0 1 0 0 0\nbody 2 %d 4 0 1 0 0 0\n' $t $t $((2 * t)); done
} >frames.dat

# A display that is free: the server writes its number.
Xvfb -displayfd 3 -screen 0 660x420x24 -nolisten tcp 3>display 2>/dev/null &
server=$!
for _ in $(seq 50); do [ -s display ] && break; sleep 0.1; done
[ -s display ] || skip "Xvfb does not start"
DISPLAY=:$(cat display)
export DISPLAY
: >log
ice-view -v --size 640x400 --by speed --set colour.from=0 --set colour.to=2.5 frames.dat 2>log &
viewer=$!
for _ in $(seq 200); do
    grep -q 'window of' log && break
    kill -0 "$viewer" 2>/dev/null || break
    sleep 0.1
done
kill -0 "$viewer" 2>/dev/null || { wait "$viewer"; grep -q 'built without' log && skip "$(cat log)"; verdict "no window: $(cat log)" 1; finish; }

# A picture of the screen once two in a row are the same.
screen() # NAME
{
    import -window root "$1.ppm"
    for _ in $(seq 60); do
        sleep 0.25
        import -window root next.ppm
        cmp -s "$1.ppm" next.ppm && return
        mv next.ppm "$1.ppm"
    done
}
last=first
differs() # NAME WHAT: the screen is another than before
{
    for _ in $(seq 60); do # a slow machine takes a while to draw
        import -window root next.ppm
        cmp -s next.ppm "$last.ppm" || break
        sleep 0.25
    done
    screen "$1"
    ! cmp -s "$1.ppm" "$last.ppm"
    verdict "$2: the screen stays the same" $?
    last=$1
}
said() # SENTENCE
{
    for _ in $(seq 100); do grep -q "$1" log && break; sleep 0.1; done
    grep -q "$1" log
    verdict "\"$1\" is not said: $(tail -n 3 log)" $?
}
xdotool mousemove 2 2
screen first
xdotool key Right
said 'key Right, t = 1$'
differs step "a frame forward"
xdotool key Left Left
said 'key Left, t = 0$'
screen back
xdotool key space
sleep 1.5
xdotool key space
said 'key Space, t = [0-9]*\.[0-9]'
xdotool key c m
differs colour "another colour"
xdotool key 2
differs plan "from above"
xdotool key w
differs water "without water"
xdotool key x
differs cut "a cut"
xdotool key x x x 1
differs again "back"
xdotool mousemove 320 150 mousedown 1
for x in 340 360 380; do xdotool mousemove $x 160; sleep 0.1; done
xdotool mouseup 1
differs turned "a drag"
xdotool click 4
differs nearer "the wheel"
xdotool key 2 Home
screen above
xdotool mousemove 320 190 click 1
said 'click'
# the bar of time: from its left end to the right
xdotool mousemove 560 383 mousedown 1
sleep 0.3
xdotool mouseup 1
differs bar "a click on the bar of time"
xdotool mousemove 2 2 key p
for _ in $(seq 100); do [ -s ice-view-1.png ] && break; sleep 0.1; done
[ -s ice-view-1.png ]
verdict "p leaves no picture" $?
xdotool key k
for _ in $(seq 100); do [ -s ice-view.look ] && break; sleep 0.1; done
grep -q 'by = spin' ice-view.look
verdict "k keeps no settings" $?
if command -v ffmpeg >/dev/null; then
    xdotool key v space
    sleep 1
    xdotool key v
    for _ in $(seq 100); do [ -s ice-view-1.mp4 ] && break; sleep 0.1; done
    [ -s ice-view-1.mp4 ]
    verdict "v leaves no video" $?
fi
xdotool key q
for _ in $(seq 100); do kill -0 "$viewer" 2>/dev/null || break; sleep 0.1; done
wait "$viewer"
verdict "the window ends with status $?" $?
viewer=''
finish
