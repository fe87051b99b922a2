# SPDX-License-Identifier: GPL-3.0-or-later
function verdict(what, ok) { print what ": " (ok ? "ok" : "FAILED"); bad += !ok }
FNR == 1 { files++ }
/^#/ { next }
/^t/ || /^x/ { for (k = 1; k <= NF; k++) { name = $k; sub(/\[.*/, "", name); at[files, name] = k } next }
files <= 2 && /^energy residual/ { residual[files] = $3 }
files <= 2 && /^largest overlap/ { overlap[files] = $3 }
files > 2 { n[files]++; heave[files, n[files]] = $at[files, "heave"]; Hs[files, n[files]] = $at[files, "Hs"] }
END {
    for (f = 1; f <= 2; f++) {
        what = f == 1 ? " with decay" : " without"
        verdict("energy balance" what, residual[f] != "" && residual[f] < 1e-4)
        verdict("overlaps below 0.3 of the radii" what, overlap[f] != "" && overlap[f] < 0.3)
    }
    verdict("at the edge floes heave with the sea", heave[4, 1] > 0.7 * Hs[4, 1] && heave[4, 1] < 1.2 * Hs[4, 1])
    less = heave[3, n[3]] / heave[4, n[4]] - Hs[3, n[3]] / Hs[4, n[4]]
    verdict("deep in the ice they heave less, as the law of the decay says", less * less < 0.01)
    exit bad > 0
}
