# SPDX-License-Identifier: GPL-3.0-or-later
# One page: for each certificate the command that made the field, its pictures, requested and achieved values.
function plain(s)
{
    gsub(/&/, "\\&amp;", s)
    gsub(/</, "\\&lt;", s)
    return s
}
function short(s)
{
    return s == "-" ? "" : s ~ /^-?[0-9.]+(e[-+]?[0-9]+)?$/ ? sprintf("%.6g", s) : plain(s)
}
BEGIN {
    FS = "\t"
    print "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Fields of ice</title><style>"
    print "body{font:15px sans-serif;max-width:960px;margin:2em auto;color:#222}code{background:#eef2f5;padding:.1em .3em;font-size:13px}"
    print "img{width:49%;vertical-align:middle}table{border-collapse:collapse;margin:1em 0;font-size:13px}"
    print "td,th{padding:.1em .8em;text-align:left;border-bottom:1px solid #ddd}</style></head><body><h1>Fields of ice</h1>"
}
FNR == 1 {
    if (NR > 1) print "</table>"
    name = FILENAME
    sub(/.*\//, "", name)
    sub(/\.tsv$/, "", name)
    printf "<h2>%s</h2>\n", name
}
/^#by voronoi-ice/ {
    by = $0
    sub(/^#by voronoi-ice [^ ]* /, "", by)
    printf "<p><code>voronoi-ice %s</code></p>\n", plain(by)
    printf "<p><img src=\"%s/plan.svg\" alt=\"the floes from above\">\n", name
    printf "<img src=\"%s/sizes.svg\" alt=\"their sizes\"></p>\n<table>\n", name
}
/^#/ || ($3 == "-" && $5 == "-") { next }
{
    cell = $1 == "quantity" ? "th" : "td"
    printf "<tr>"
    for (k = 1; k <= 5; k++) printf "<%s>%s</%s>", cell, short($k), cell
    print "</tr>"
}
END { print "</table></body></html>" }
