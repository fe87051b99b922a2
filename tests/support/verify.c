/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/verify.h"

static int passed, failed;

static const char *count(int ok)
{
    if (ok) passed++;
    else failed++;
    return ok ? "ok" : "FAIL";
}

void verify_begin(const char *topic)
{
    printf("%s%s\n%-5s %-46s %17s %17s %9s %9s\n", topic, verify_quick() ? " (quick)" : "", "", "", "value",
           "expected", "error", "tolerance");
}

int verify_quick(void)
{
    const char *s = getenv("FLOE_QUICK");
    return s && *s && strcmp(s, "0") != 0;
}

void verify_row(const char *id, const char *what, double value, double expected, double tol,
                enum verify_kind kind)
{
    double error = fabs(value - expected);
    if (kind == VERIFY_REL && error > 0.0) error /= fabs(expected);
    const int ok = isfinite(value) && isfinite(expected) && error <= tol;
    printf("%-5s %-46s %17.10g %17.10g %9.2e %9.2e %s %s\n", id, what, value, expected, error, tol,
           kind == VERIFY_REL ? "rel" : "abs", count(ok));
    fflush(stdout);
}

void verify_below(const char *id, const char *what, double value, double bound)
{
    const int ok = isfinite(value) && value <= bound;
    printf("%-5s %-46s %17.10g %17s %9s %9.2e max %s\n", id, what, value, "", "", bound, count(ok));
    fflush(stdout);
}

void verify_order(const char *id, const char *what, const double *h, const double *err, int n,
                  double expected, double tol)
{
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    int usable = n >= 2;
    printf("%-5s %-46s %17s %17s %9s\n", id, what, "step", "error", "order");
    for (int k = 0; k < n; k++) {
        const double x = log(h[k]), y = log(err[k]);
        if (!isfinite(x) || !isfinite(y)) usable = 0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
        printf("%-5s %-46s %17.10g %17.6e", "", "", h[k], err[k]);
        if (k) printf(" %9.3f", (y - log(err[k - 1])) / (x - log(h[k - 1])));
        putchar('\n');
    }
    const double p = usable ? (n * sxy - sx * sy) / (n * sxx - sx * sx) : (double)NAN;
    verify_row(id, "  order of convergence", p, expected, tol, VERIFY_ABS);
}

void verify_true(const char *id, const char *what, int ok)
{
    printf("%-5s %-106s %s\n", id, what, count(ok));
    fflush(stdout);
}

void verify_note(const char *fmt, ...)
{
    va_list ap;
    printf("      ");
    va_start(ap, fmt);
    vprintf(fmt, ap);
    va_end(ap);
    putchar('\n');
}

int verify_end(void)
{
    printf("%d passed, %d failed\n", passed, failed);
    return failed || !passed;
}
