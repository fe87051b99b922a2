/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/decimal.h"
#include "base/num.h"

static int reads_as(const char *text, double x)
{
    double y;
    return fl_decimal(text, &y) && y == x;
}

char *fl_num_text(double x, char buf[FL_NUM_LEN])
{
    if (x == 0.0) return memcpy(buf, "0", 2);
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(buf, FL_NUM_LEN, "%.*g", digits, x);
        if (digits == 17 || reads_as(buf, x)) break;
    }
    return buf;
}

int fl_num_f64(const char *s, double *x)
{
    double v;
    const char *end = fl_decimal(s, &v);
    if (!end || *end || !isfinite(v)) return -1;
    *x = v;
    return 0;
}

int fl_num_i32(const char *s, int32_t lo, int32_t hi, int32_t *x)
{
    char *end;
    long v;
    if (s[strspn(s, "+-0123456789")] != '\0') return -1;
    errno = 0;
    v = strtol(s, &end, 10);
    if (end == s || *end || errno || v < lo || v > hi) return -1;
    *x = (int32_t)v;
    return 0;
}

int fl_num_u64(const char *s, uint64_t *x)
{
    char *end;
    unsigned long long v;
    if (s[0] == '\0' || s[strspn(s, "0123456789")] != '\0') return -1;
    errno = 0;
    v = strtoull(s, &end, 10);
    if (*end || errno) return -1;
    *x = v;
    return 0;
}
