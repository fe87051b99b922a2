# SPDX-License-Identifier: GPL-3.0-or-later
# A row for each way to make the sheet, from its statistics (peaks.awk) and its report.
BEGIN { printf "%-10s %7s %7s %7s %7s %7s %7s %7s %7s %9s\n", "", "first", "largest", "50 ms", "mean", "up", "peaks", "period", "broken", "s a second" }
$1 == "way" { way = $2 }
/^largest load, with/ { first = $(NF - 1) }
/^largest load, means of 10/ { most = $(NF - 1) }
/^largest load, means of 50/ { most5 = $(NF - 1) }
/^mean/ { mean = $(NF - 1) }
/^upward/ { up = $NF }
/^peaks/ { peaks = $NF }
/^their period/ { period = $(NF - 1) }
/^speed .*simulated/ { time = $2 }
/^processor/ { cost = $2 }
/^bonds/ { broken = $6; of = $9; sub(/:.*/, "", of) }
/^state hash/ { printf "%-10s %7.1f %7.1f %7.1f %7.2f %7.2f %7d %7s %6.0f%% %9.1f\n", way, first, most, most5, mean, up, peaks, (peaks > 1 ? period : "-"), 100*broken/of, cost/time }
