# SPDX-License-Identifier: GPL-3.0-or-later
# show.awk -- stats.tsv, response.tsv (of the moving cylinder, then of the one at rest) and frequency.tsv as a summary.
BEGIN { FS = "\t" }
FNR == 1 { file++ }
/^#/ { next }
$1 == "part" {
    for (k = 1; k <= NF; k++) { name = $k; sub(/\[.*/, "", name); at[name] = k }
    next
}
function size(a, b) { return a > -b ? a : -b }
file == 1 { most[$at["signal"]] = size($at["max"], $at["min"]) }
file == 2 { r++; static[r] = $at["static"]; x[r] = $at["x_max"] }
file == 3 { f[$at["signal"]] = $at["f"]; share[$at["signal"]] = $at["share"] }
END {
    printf "cylinder on springs         along x     along y\n"
    printf "largest load             %7.1f kN  %7.1f kN\n", most["fx"] / 1e3, most["fy"] / 1e3
    printf "  at rest                %7.1f kN  %7.1f kN\n", static[3] / 1e3, static[4] / 1e3
    printf "largest displacement     %7.1f mm  %7.1f mm\n", 1e3 * most["ux"], 1e3 * most["uy"]
    printf "  by loadstats           %7.1f mm  %7.1f mm    from the load of this run\n", 1e3 * x[1], 1e3 * x[2]
    printf "  by loadstats           %7.1f mm  %7.1f mm    from the load on the cylinder at rest\n", 1e3 * x[3], 1e3 * x[4]
    printf "largest acceleration     %7.2f m/s2%6.2f m/s2\n", most["ax"], most["ay"]
    printf "dominant frequency       %7.2f Hz  %7.2f Hz    of the displacement\n", f["ux"], f["uy"]
}
