#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# page.sh BUILD [chromium | firefox] -- the page of ice-view --html in headless Chromium, and in Firefox under Xvfb: it opens
# without a line on the console, plays, turns, colours.  Prints "N passed, N failed"; a browser that is not there is skipped
# with a line.  Firefox, some 30 s, is left to make verify (FLOE_QUICK unset) and to `page.sh BUILD firefox`.
set -u
here=$(cd "$(dirname "$0")" && pwd)
PATH=$(cd "${1:?usage: page.sh BUILD}" && pwd)/bin:$PATH
export PATH
which=${2-}
skip() { echo "page: skipped, $1"; passed=$((passed + 1)); }
passed=0 failed=0 server=''
finish() { echo "$passed passed, $failed failed"; [ $failed -eq 0 ]; exit; }
command -v python3 >/dev/null || { skip "no python3"; finish; }
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-page.XXXXXX") || exit 4
# shellcheck disable=SC2317 # called by the trap
stop() { [ -n "$server" ] && kill "$server" 2>/dev/null; rm -rf "$scratch"; }
trap stop EXIT
trap 'exit 130' INT TERM HUP
cd "$scratch" || exit 4
voronoi-ice --gaps even --size 20x20 --origin -18,-10 --floes 40 --concentration 0.8 --thickness 0.5 --radius 0.05 --seed 3 --velocity 1,0 -q -o ice.dat
struct-import --name leg --cylinder 1.5,-5,5,5,0 -q -o leg.dat
printf '[structure]\nfile = leg.dat\n[water]\ncurrent = 1 m/s\n[contact]\nstiffness_factor = 0.02\n' >a.scene
dem-solve -q --set run.duration=6 --set output.frames=frames.dat --set output.frames_every=0.1 --ice ice.dat -o loads.tsv a.scene
ice-view --html page.html --loads loads.tsv frames.dat || exit 1
echo "page: $(wc -c <page.html) bytes for 60 frames of 40 floes"
count() # adds "N passed, N failed", the last line of the file `said`
{
    sed '$d' said
    last=$(tail -n 1 said)
    case $last in
    *' passed, '*' failed') passed=$((passed + ${last%% *})) last=${last#*, } failed=$((failed + ${last%% *})) ;;
    *) failed=$((failed + 1)); echo "page: $last" ;;
    esac
}
if [ "$which" != firefox ]; then
    if command -v chromium >/dev/null; then python3 "$here/page_drive.py" page.html . >said 2>&1; count; else skip "no chromium"; fi
fi
[ "$which" = chromium ] && finish
[ "${FLOE_QUICK:-0}" != 0 ] && [ -z "$which" ] && finish
command -v firefox-esr >/dev/null || command -v firefox >/dev/null || { skip "no firefox"; finish; }
command -v Xvfb >/dev/null || { skip "no Xvfb for Firefox"; finish; }
Xvfb -displayfd 3 -screen 0 1100x800x24 -nolisten tcp 3>display 2>/dev/null &
server=$!
for _ in $(seq 50); do [ -s display ] && break; sleep 0.1; done
[ -s display ] || { skip "Xvfb does not start"; finish; }
DISPLAY=:$(cat display) python3 "$here/page_firefox.py" page.html . >said 2>&1
count
finish
