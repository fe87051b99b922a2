# SPDX-License-Identifier: GPL-3.0-or-later
# check.awk -- the ledger of the ramp closes, the third mode locks in at speeds around its v_L, and nothing does where
# pressure does not depend on speed.
FNR == NR { if (!/^#/ && $1 != "t[s]") { r = $12 < 0 ? -$12 : $12; if (r > most) most = r; crushed = $16 } next }
FNR == 1 { file++ }
file == 2 && $2 == "lock-in" && $4 > 0 { plain = $5 }
file == 1 && $2 == "lock-in" && $3 > 2 && $3 < 2.5 { fast = $7; share = $5 }
function row(what, value, ok) { printf "%-60s %12.6g  %s\n", what, value, ok ? "ok" : "FAILED"; bad += !ok }
END {
    row("largest residual over the work of crushing", most / crushed, most < 1e-6 * crushed)
    row("share of lock-in to the third mode", share, share > 0.2)
    row("fastest ice with lock-in to it, v_L 0.097 [m/s]", fast, fast > 0.097 && fast < 2 * 0.097)
    row("share of lock-in under the plain law", plain, plain == 0)
    exit bad > 0
}
