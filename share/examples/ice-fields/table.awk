# SPDX-License-Identifier: GPL-3.0-or-later
# One line for each certificate: the field and its difference from the request.
function flush()
{
    if (name == "") return
    printf "%-10s %6d %12.6g %10s %10s %9d\n", name, floes, cover, off, sizes, overlaps
}
BEGIN {
    FS = "\t"
    printf "%-10s %6s %12s %10s %10s %9s\n", "field", "floes", "concentr.", "off by", "sizes off", "overlaps"
}
FNR == 1 {
    flush()
    name = FILENAME
    sub(/.*\//, "", name)
    sub(/\.tsv$/, "", name)
    sizes = "-"
}
$1 == "floes" { floes = $4 }
$1 == "concentration" { cover = $4; off = $5 < 1e-12 ? "<1e-12" : sprintf("%.1e", $5) }
$1 == "sizes-distribution" { sizes = sprintf("%.4f", $5) }
$1 == "overlaps" { overlaps = $4 }
END { flush() }
