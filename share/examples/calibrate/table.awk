# SPDX-License-Identifier: GPL-3.0-or-later
# Means over the samples of a kind, and the standard deviation of the peak over its mean.
function flush() {
    if (!n) return
    m = peak/n; v = n > 1 ? (peak2 - n*m*m)/(n - 1) : 0
    printf "%s\t%d\t%.3f\t%.3f\t%.3f\t%.3f\n", key, n, first/n, m, (v > 0 ? sqrt(v)/m : 0), young/n
    n = first = peak = peak2 = young = 0
}
BEGIN { print "test\tlattice\tlayers\trows\tsamples\tfirst/c\tpeak/c\tspread\tE/E_b" }
{ k = $1 "\t" $2 "\t" $3 "\t" $4; if (k != key) flush(); key = k; n++; first += $6; peak += $7; peak2 += $7*$7; young += $8 }
END { flush() }
