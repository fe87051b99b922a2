# SPDX-License-Identifier: GPL-3.0-or-later
# show.awk -- speeds of lock-in by the formula beside those of the runs: plan.txt, then tables regime-shares.
FILENAME != last { last = FILENAME; n = split(FILENAME, path, "/"); name = path[n]; sub("-shares.tsv", "", name); files++ }
files == 1 { if ($1 == "mode") { sub("of", ""); f[++modes] = $4; for (k = 5; k < NF; k++) if ($k == "about") limit[modes] = $(k + 1) } next }
/^#/ || $1 == "part" { next }
{
    what = $2
    if ($2 == "lock-in") {
        what = "lock-in, " sprintf("%.3f Hz", $3)
        if (name == "ramp") { seen[sprintf("%.2f", $3)] = $7 }
    }
    share[name, what] = $5; range[name, what] = $4 ? sprintf("%.3f-%.3f", $6, $7) : "-"
    if ($4 && ($10 > most[name])) most[name] = $10
    if (!((what) in known)) { known[what] = 1; order[++kinds] = what }
    if (!(name in run)) { run[name] = 1; runs[++nruns] = name }
}
END {
    print "share of the time, and speeds of the ice [m/s], by regime\n"
    printf "%-22s", ""
    for (r = 1; r <= nruns; r++) printf "%20s", runs[r]
    print ""
    for (k = 1; k <= kinds; k++) {
        printf "%-22s", order[k]
        for (r = 1; r <= nruns; r++)
            printf "%20s", (share[runs[r], order[k]] ? sprintf("%3.0f %%  %s", 100 * share[runs[r], order[k]], range[runs[r], order[k]]) : "-")
        print ""
    }
    printf "%-22s", "largest load [MN]"
    for (r = 1; r <= nruns; r++) printf "%20.2f", most[runs[r]] / 1e6
    print "\n\nlock-in ends by the formula v_L, and at most in the run `ramp` [m/s]"
    for (m = 1; m <= modes; m++) printf "%8.3f Hz  %s  %s\n", f[m], limit[m], ((sprintf("%.2f", f[m]) in seen) ? sprintf("%.3f", seen[sprintf("%.2f", f[m])]) : "-")
}
