# SPDX-License-Identifier: GPL-3.0-or-later
# Joints that cut the bolt are steel.
$1 == "poly" { bolt[$2] = /group=bolt/ }
$1 == "joint" && bolt[$2] && bolt[$3] { $6 = "steel" }
{ print }
