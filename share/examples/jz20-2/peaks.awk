# SPDX-License-Identifier: GPL-3.0-or-later
# Statistics of the load along the drift, rows of 10 ms; the first 1.5 s, with the whole flat front at once, left
# out of all but the first line.

# Seconds for each of the maxima above half of the largest that none within `apart` seconds exceeds.
function spacing(apart,    i, j, c, top) {
    for (i = from + 1; i <= n; i++) {
        if (f[i] < 0.5*max) continue
        top = 1
        for (j = i - 1; j > from && t[i] - t[j] < apart && top; j--) top = f[j] < f[i]
        for (j = i + 1; j <= n && t[j] - t[i] < apart && top; j++) top = f[j] <= f[i]
        c += top
    }
    return c ? (t[n] - t[from + 1])/c : 0
}
# The same for loads above half of the largest that follow on 0.1 s or more below a tenth of it.
function break_time(    i, c, low) {
    for (i = from + 1; i <= n; i++) {
        if (f[i] < 0.1*max) low++
        else if (f[i] > 0.5*max) { c += low >= 10; low = 0 }
    }
    return c ? (t[n] - t[from + 1])/c : 0
}
/^[0-9]/ { n++; t[n] = $1; f[n] = $3; z[n] = $5 }
END {
    for (i = 1; i <= n; i++) {
        if (f[i] > all) all = f[i]
        if (t[i] < 1.5) { from = i; continue }
        k++; sum += f[i]; sumz += z[i]
        if (f[i] > max) max = f[i]
        run += f[i]; if (k > 5) run -= f[i - 5]
        if (k >= 5 && run/5 > max5) max5 = run/5
    }
    if (!k) { printf "largest load, with the first contact   %7.1f kN\nno row after 1.5 s\n", all/1e3; exit }
    # peaks above half of the maximum, 0.4 s apart
    for (i = from + 1; i <= n; i++) {
        if (f[i] < 0.5*max) continue
        if (!big || t[i] - at > 0.4) { big++; at = t[i]; if (big == 1) first = at; last = at; total += 0; peak[big] = 0 }
        if (f[i] > peak[big]) peak[big] = f[i]
    }
    for (j = 1; j <= big; j++) total += peak[j]
    period = big > 1 ? (last - first)/(big - 1) : 0
    printf "largest load, with the first contact   %7.1f kN\n", all/1e3
    printf "largest load, means of 10 ms           %7.1f kN\n", max/1e3
    printf "largest load, means of 50 ms           %7.1f kN\n", max5/1e3
    printf "mean                                   %7.2f kN\n", sum/k/1e3
    printf "upward over along, of the means        %7.2f\n", sum ? sumz/sum : 0
    printf "peaks above half of the largest        %7d\n", big
    printf "their mean                             %7.1f kN\n", (big ? total/big : 0)/1e3
    printf "their period                           %7.2f s\n", period
    printf "speed times period                     %7.2f m\n", v*period
    printf "one in, peaks 0.2, 0.4, 0.6, 0.8 s apart %5.2f, %.2f, %.2f, %.2f s\n", spacing(0.2), spacing(0.4), spacing(0.6), spacing(0.8)
    printf "one in, after 0.1 s below a tenth      %7.2f s\n", break_time()
}
