#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# python.sh BUILD -- what share/python/floe.py, and the lines for R and Octave of floe(7), read of the files of a short
# run, against awk.  Prints "N passed, N failed"; an interpreter that is not there is skipped with a line.
set -u
LC_ALL=C
export LC_ALL
root=$(cd "$(dirname "$0")/.." && pwd)
PATH=$(cd "${1:?BUILD}" && pwd)/bin:$PATH
export PATH
scratch=$(mktemp -d "${TMPDIR:-/tmp}/floe-python.XXXXXX") || exit 4
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 4
passed=0 failed=0
# same NAME EXPECTED FOUND
same()
{
    if [ "$2" = "$3" ]; then passed=$((passed + 1))
    else failed=$((failed + 1)); printf '%s: %s expected, %s found\n' "$1" "$2" "$3"; fi
}

voronoi-ice --gaps even -q --seed 3 --bonded --size 5x4 --origin -6.25,-2 --floes 12 --thickness 0.3 --radius 0.02 --velocity 1,0 -o ice.dat
printf '#g_struct 1\npart 0 leg\ncone 0 0 -1.5 1.25 0 0 1.5 1.25\n' >leg.dat
cat >case.scene <<'SCENE'
[ice]
file = ice.dat
[structure]
file = leg.dat
[water]
current = 1 0 0
[run]
duration = 0.4 s
[output]
loads_every = 10 ms
frames = frames.dat
frames_every = 0.05 s
SCENE
dem-solve -q -o loads.tsv case.scene 2>log || { cat log; exit 1; }
ice-view --packed packed.dat frames.dat
gzip -k loads.tsv
frames=$(grep -c '^frame ' frames.dat) shapes=$(grep -c '^shape ' frames.dat)
# rows, largest fx, last time, to six digits
want=$(awk -F '\t' '!/^[#t]/ { n++; if ($3 > m) m = $3; t = $1 } END { printf "%d %.6g %.6g", n, m, t }' loads.tsv)

for python in python3 /usr/bin/python3; do # one without numpy perhaps, one with
    command -v $python >/dev/null || { echo "python: skipped, no $python"; continue; }
    cat >try.py <<'PY'
import sys
sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True
import floe
a = floe.read_table("loads.tsv")
b = floe.read_table("loads.tsv.gz").where(part="leg")
print("%d %.6g %.6g" % (len(a), max(a["fx"]), a["t"][-1]))
print("%d %.6g %.6g" % (len(b), max(b["fx"]), b["t"][-1]))
print(a.kind, a.units["fx"], a.history[-1].split()[0], a.settings["run.duration"], a.report["state hash"], a.stopped)
ice = floe.read_ice("ice.dat")
print(len(ice.bodies), len(ice.bonds), sum(len(x.vertices) for x in ice.bodies))
text, packed, far = list(floe.read_frames("frames.dat")), list(floe.read_frames("packed.dat")), 0.0
for x, y in zip(text, packed):
    assert x.bodies.keys() == y.bodies.keys() and x.t == y.t
    for k, p in x.bodies.items():
        q = y.bodies[k]
        sign = 1 if sum(u * v for u, v in zip(p[3:], q[3:])) > 0 else -1
        far = max([far] + [abs(u - v) for u, v in zip(p[:3], q[:3])] + [abs(u - sign * v) for u, v in zip(p[3:], q[3:])])
print(len(text), len(packed), far <= 1e-5, len(floe.read_shapes("packed.dat")))
print("%d" % len(floe.solve("case.scene", run__duration="0.1 s", output__frames="short.dat")))
for name in "missing", "ice.dat", "cut.tsv":
    try:
        floe.read_table(name)
        print("read")
    except floe.Error as error:
        print(error)
PY
    printf '#loads 1\n#by x 0\nt[s]\tpart\tfx[N]\n0.1\tleg\n' >cut.tsv
    $python try.py "$root/share/python" >out 2>&1
    same "$python: rows" "$want" "$(sed -n 1p out)"
    same "$python: rows of the leg" "$want" "$(sed -n 2p out)"
    same "$python: head" "loads N dem-solve 0.4 s $(sed -n 's/^#report state hash *//p' loads.tsv) None" "$(sed -n 3p out)"
    same "$python: ice" "$(awk '$1 == "poly" { n++ } $1 == "bond" { b++ } $1 == "v" { v++ } END { print n, b, v }' ice.dat)" \
        "$(sed -n 4p out)"
    same "$python: frames" "$frames $frames True $shapes" "$(sed -n 5p out)"
    same "$python: a run" 10 "$(sed -n 6p out)"
    same "$python: no file" "missing: No such file or directory" "$(sed -n 7p out)"
    same "$python: another kind" 'ice.dat: g-polys is no table' "$(sed -n 8p out)"
    same "$python: a short row" "cut.tsv:4: 2 columns, the head has 3" "$(sed -n 9p out)"
done

# The lines of floe(7), as they stand there.
lines() { sed -n "/^\\.\\\\\" $1 begins/,/^\\.\\\\\" $1 ends/p" "$root/share/man7/floe.7" | sed -n '/^\.Bd/,/^\.Ed/p' | grep -v '^\.' | sed 's/\\e/\\/g; s/\\&//g'; }
for pair in Rscript:R octave-cli:Octave; do
    program=${pair%%:*} name=${pair#*:}
    lines "$name" >try
    same "$name: lines in floe(7)" yes "$([ -s try ] && echo yes)"
    command -v "$program" >/dev/null || { echo "$name: skipped, no $program"; continue; }
    "$program" try >out 2>log
    same "$name: largest fx" "$(echo "$want" | cut -d ' ' -f 2)" "$(awk 'NF { printf "%.6g", $NF }' out)"
done
echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
