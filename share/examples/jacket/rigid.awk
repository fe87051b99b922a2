# SPDX-License-Identifier: GPL-3.0-or-later
# The same cylinders as a structure that stands still: members(5) to g_struct(5).
BEGIN { print "#g_struct 1" }
$1 == "node" { at[$2] = $3 " " $4 " " $5 }
$1 == "section" { radius[$2] = $4 / 2 }
$1 == "part" { print "part", parts++, $2 }
$1 == "member" { print "cone", at[$3], radius[$5], at[$4], radius[$5] }
