# SPDX-License-Identifier: GPL-3.0-or-later
# floors.awk -- rules that can be checked on the text of a file: floors, circles, names, guards, licence, width.  The
# arguments are paths from the root of the tree.  Prints "file:line: complaint"; status 1 when there was one.
BEGIN {
    n = split("base geom shim mesh broad ice block stat law scene body narrow patch water bond zone member structure failure out view world contact sphere gpu sim pack", floor)
    for (k = 1; k <= n; k++) rank[floor[k]] = k
    # Written in pieces, so that this file does not contain them.
    marks = "(^|[^A-Za-z_])(TO" "DO|FIX" "ME|XX" "X)([^A-Za-z_]|$)"
    paths = "/(ho" "me|wo" "rk|ro" "ot|Us" "ers)/"
    WIDTH = 110
    FEW = 5 # letters of a function's name that is a single word
}

function complain(what)
{
    printf "%s:%d: %s\n", FILENAME, FNR, what
    bad = 1
}

FNR == 1 {
    parts = split(FILENAME, part, "/")
    file = part[parts]
    stem = file
    sub(/\.[^.]*$/, "", stem)
    base = stem
    is_c = file ~ /\.(c|h|cpp)$/
    house = part[1]
    mine = house == "lib" ? part[2] : ""
    folder = FILENAME
    sub(/\/[^\/]*$/, "", folder)
    licensed = 0
    guard = ""
    if (is_c) {
        if ($0 != "/* SPDX-License-Identifier: GPL-3.0-or-later */") complain("the licence line is wanted here")
        licensed = 1
        if (house == "lib" && (parts != 3 || !(mine in rank))) complain("lib/" mine " is not a floor")
        if (file ~ /\.cpp$/ && folder != "lib/shim") complain("C++ is for lib/shim")
        # Every program has a main and options; all other base names are unique.
        if (house == "tools" && (stem == "main" || stem == "options")) stem = folder "/" stem
        if (stem in home && home[stem] != folder) complain("the name " stem " is taken by " home[stem])
        home[stem] = folder
    }
}

# Scripts and manual pages have a line before it: the licence is expected in the first three lines.
!is_c && FNR <= 3 && /SPDX-License-Identifier: GPL-3\.0-or-later/ { licensed = 1 }
!is_c && FNR == 4 && !licensed {
    complain("no licence line in the first three lines")
    licensed = 1
}

$0 ~ marks { complain("a mark of unfinished work") }
$0 ~ paths { complain("a path of one machine") }

is_c {
    line = $0
    gsub(/[\200-\277]/, "", line) # what follows the first byte of a UTF-8 character
    if (length(line) > WIDTH) complain("line of " length(line) " columns, " WIDTH " are the most")
    if (/[ \t]$/) complain("a blank at the end of the line")
}

is_c && file ~ /\.h$/ && guard == "" && /^#ifndef/ {
    guard = $2
    want = toupper("FL_" (house == "lib" ? mine : part[2]) "_" stem "_H")
    if (house == "tools") want = toupper(part[2] "_" part[parts])
    if (house == "tests") want = toupper("FL_TESTS_" stem "_H")
    gsub(/[^A-Z0-9_]/, "_", want)
    if (guard != want && !(house == "tools" && guard == "FL_" want)) complain("the guard is " guard ", " want " is expected")
}

is_c && /^[ \t]*#[ \t]*include[ \t]*"/ {
    split($0, quoted, "\"")
    target = quoted[2]
    steps = split(target, step, "/")
    if (house == "lib") {
        if (steps != 2 || !(step[1] in rank)) complain("\"" target "\": the include path shows the floor, \"geom/poly.h\"")
        else if (rank[step[1]] > rank[mine]) complain(mine " is beneath " step[1] " and may not include " target)
    } else if (steps == 2 && step[1] in rank) {
        ok = 1
    } else if (house == "tests") {
        if (target !~ /^support\//) complain("\"" target "\": tests include the library and support/")
    } else if (steps != 1) {
        complain("\"" target "\": a program includes the library and its own folder")
    }
    # A module is name.c with name.h.  Modules must not include each other in a circle.
    if (house != "tests") {
        other = steps == 2 ? "lib/" target : folder "/" target
        sub(/\.[^.]*$/, "", other)
        me = folder "/" base
        if (other != me && !((me, other) in uses)) {
            uses[me, other] = 1
            module[me] = module[other] = 1
        }
    }
}

# The name of an exported type is unique in the tree.
house == "lib" && file ~ /\.h$/ && /^} fl_[a-z0-9_]+;/ {
    type = $2
    sub(/;.*/, "", type)
    if (type in owner) complain("the type " type " is " owner[type] "'s")
    else owner[type] = FILENAME
}

# The name of a function must say what it does, also in a backtrace.
(house == "lib" || house == "tools") && file ~ /\.c$/ && mine != "geom" && /^[a-zA-Z].*[ *][a-z]+\([^)]/ && !/;$/ {
    name = $0
    sub(/\(.*/, "", name)
    sub(/.*[ *]/, "", name)
    if (length(name) < FEW && name != "main" && name != "run") complain("the function " name " has no name that tells what it does")
}

# True if module k reaches itself through the modules that it includes.
function in_a_circle(k,    stack, n, seen, m, pair, part2)
{
    n = 1
    stack[1] = k
    while (n > 0) {
        m = stack[n--]
        for (pair in uses) {
            split(pair, part2, SUBSEP)
            if (part2[1] != m || !(part2[2] in module)) continue
            if (part2[2] == k) return 1
            if (part2[2] in seen) continue
            seen[part2[2]] = 1
            stack[++n] = part2[2]
        }
    }
    return 0
}

# Removes modules that include none of the rest, or that none of the rest includes: they are in no circle.
function leave_out_ends(    pair, part2, gone, k, has, had)
{
    do {
        split("", has)
        split("", had)
        for (pair in uses) {
            split(pair, part2, SUBSEP)
            if (!(part2[1] in module) || !(part2[2] in module)) {
                delete uses[pair]
                continue
            }
            has[part2[1]] = 1
            had[part2[2]] = 1
        }
        gone = 0
        for (k in module)
            if (!(k in has) || !(k in had)) {
                delete module[k]
                gone++
            }
    } while (gone)
}

END {
    leave_out_ends()
    for (k in module)
        if (in_a_circle(k)) {
            print k ": it is in a circle of modules that include each other"
            bad = 1
        }
    exit bad
}
