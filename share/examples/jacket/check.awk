# SPDX-License-Identifier: GPL-3.0-or-later
# Energy balances, and the jacket is left where it stood: what the ice did is in the columns of the ledger.
function claim(what, ok) { printf "%s: %s\n", ok ? "ok  " : "FAIL", what; if (!ok) bad = 1 }
FNR == 1 { file++ }
file == 1 && /^energy residual/ { residual = $3 }
file == 2 && /^t\[s\]/ { for (k = 1; k <= NF; k++) column[$k] = k; next }
file == 2 && /^[0-9]/ { damper = $column["damper[J]"]; spring = $column["spring[J]"] }
file == 3 && $2 == "legs" { if ($11 > most) most = $11; if (-$11 > most) most = -$11 }
END {
    claim(sprintf("energy balances to %s of the throughput, 1e-4 at most", residual), residual + 0 < 1e-4)
    claim(sprintf("damping took %.3g J out of the jacket, %.3g J are in its bending", damper, spring), damper > 0)
    claim(sprintf("the deck moved by %.2f mm at most", 1e3 * most), most > 0 && most < 0.1)
    exit bad
}
