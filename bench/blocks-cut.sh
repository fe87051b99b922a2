#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# blocks-cut.sh [BUILD [OUT]] -- cost of jointed rock on one thread: block-cut of three oblique sets into up to 1e5 blocks,
# from the model to the file, the joints of rigid blocks by bench_joints, and zones by bench_zones.
#   OUT/blocks-cut.tsv   three tables; the head names the machine.  OUT is bench/results
#   FLOE_QUICK=1         the smallest cuts and grid alone
set -u
LC_ALL=C OMP_NUM_THREADS=1
export LC_ALL OMP_NUM_THREADS
bench=$(cd "$(dirname "$0")" && pwd) || exit 4
build=$(cd "${1:-$bench/../build}" && pwd) || exit 4
out=${2:-$bench/results}
mkdir -p "$out" && out=$(cd "$out" && pwd) || exit 4
# shellcheck source=/dev/null # in the same folder
. "$bench/beside.sh"
here=$(mktemp -d "${TMPDIR:-/tmp}/floe-blocks-cut.XXXXXX") && cd "$here" || exit 4
trap 'rm -rf "$here"' EXIT
trap 'exit 130' INT TERM HUP
sides='10 22 46' grid=
if [ "${FLOE_QUICK:-0}" != 0 ]; then sides='10 22' grid=5; fi

# cut SIDE: a row of a box of SIDE m.  volume-error is the sum of volumes over that of the box, less 1; count-error the
# number of blocks less that of the count without cutting.
cut()
{
    /usr/bin/time -f '%U %M' -o clock "$build/bin/block-cut" -q -j 1 --in "box:0,0,0,$1,$1,$1" \
        --joint 'name=a dip=10 dd=180 spacing=1 origin=.5,.5,.5' --joint 'name=b dip=80 dd=75 spacing=1 origin=.3,.1,.2' \
        --joint 'name=c dip=85 dd=340 spacing=1 origin=.4,.7,.2' --certificate certificate -o blocks || exit 4
    tail -n 1 clock | cat - certificate | awk -v side="$1" '
        NR == 1 { seconds = $1; memory = $2; next }
        { asked[$1] = $3; got[$1] = $4 }
        END {
            n = got["blocks-cut"]
            printf "%d\t%d\t%.2f\t%.1f\t%.0f\t%.2f\t%d\t%.1e\n", n, got["joints-written"], seconds, 1e6 * seconds / n,
                memory / 1024, memory / n, n - asked["blocks-cut"], got["volume"] / side ^ 3 - 1
        }'
}

table=blocks-cut # of heading
export table
{
    heading "one thread; bodies of 1 m"
    printf 'blocks\tjoints\tcpu[s]\tblock[us]\tmemory[MiB]\tmemory[KiB/block]\tcount-error\tvolume-error\n'
    for side in $sides; do cut "$side"; done
    printf '#joints of rigid blocks in steps\n'
    printf 'joint\tblocks\tjoints\tslip\topen\tpoint[ns]\tpoint-step[ns]\tjoint-step[ns]\tbody-step[ns]\tmemory[KiB/block]\tenergy-error\n'
    # shellcheck disable=SC2086 # no argument where it is empty
    "$build/tests/bench/bench_joints" $grid | awk '/^(held|slip)/ { $1 = $1; gsub(" ", "\t"); print }'
    printf '#deformable blocks in steps\n'
    printf 'zones\tnumber\tnodes\tset-up[s]\tzone-step[ns]\tmemory[B/zone]\tenergy-error\n'
    # shellcheck disable=SC2086 # no argument where it is empty
    "$build/tests/bench/bench_zones" $grid | awk '/^(elastic|plain|mohr)/ { $1 = $1; gsub(" ", "\t"); print }'
} >table || exit 4
cp table "$out/blocks-cut.tsv" && cat table
