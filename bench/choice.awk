# SPDX-License-Identifier: GPL-3.0-or-later
# choice.awk -- the longest step of ladder.tsv for each error.  A fraction qualifies only if it and all
# finer ones kept the error, so that none is chosen by chance.
function within(x, goal) { return x != "-" && x <= goal }
BEGIN { FS = "\t" }
/^#/ { next }
!col["scene"] { for (k = 1; k <= NF; k++) col[$k] = k; next }
{ s = $1 }
!(s in seen) { seen[s] = 1; name[++scenes] = s }
$2 == "step" {
    k = ++m[s]; f[s, k] = $3; J[s, k] = $14; P[s, k] = $15; r[s, k] = $20
}
$2 == "error" { eJ[s, $3 + 0] = $14; eP[s, $3 + 0] = $15; eR[s, $3 + 0] = $20 }
END {
    split("5 1 0.1", goal, " ")
    print "The largest fraction of the critical step that kept an error, and its cost over that of a tenth; beside"
    print "it what run.error gave for that goal: errors of the impulse and the peak, and its cost."
    for (g = 1; g <= 3; g++) {
        printf "\n%s %%\n%-14s %9s %7s   %9s %7s   %10s %10s %7s\n", goal[g], "scene", "impulse", "cost",
            "peak", "cost", "run.error", "its peak", "cost"
        for (i = 1; i <= scenes; i++) {
            s = name[i]
            a = b = 0
            for (k = m[s]; k > 0 && within(J[s, k], goal[g] / 100); k--) a = k
            for (k = m[s]; k > 0 && within(P[s, k], goal[g] / 100); k--) b = k
            printf "%-14s %9s %7s   %9s %7s", s, a ? f[s, a] : "finer", a ? r[s, a] : "",
                b ? f[s, b] : "finer", b ? r[s, b] : ""
            h = goal[g] + 0
            if ((s, h) in eJ && eJ[s, h] != "-")
                printf "   %8.3g %% %8.3g %% %7s", 100 * eJ[s, h], 100 * eP[s, h], eR[s, h]
            printf "\n"
        }
    }
}
