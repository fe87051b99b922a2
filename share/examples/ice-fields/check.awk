# SPDX-License-Identifier: GPL-3.0-or-later
# Checks that every field is as requested.  Status 1 if one is not.
function claim(ok, what)
{
    if (!ok) bad++
    printf "%-4s %s: %s\n", ok ? "ok" : "NO", FILENAME, what
}
BEGIN { FS = "\t" }
FNR == 1 { files++ }
$1 == "overlaps" { claim($4 == 0, "no two floes overlap"); seen++ }
$1 == "floes-not-convex" { claim($4 == 0, "all floes are convex, their faces outward"); seen++ }
$1 == "concentration" { claim($5 < 1e-12, "concentration to 1e-12"); seen++ }
$1 == "sizes-distribution" { claim($5 < 0.03, "distance of the distribution of sizes below 0.03") }
END { exit bad || seen < 3 * files || !files }
