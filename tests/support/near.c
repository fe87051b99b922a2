/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/number_text.h"
#include "support/near.h"

void near_check(double value, double expected, double tol, double scale, const char *what, const char *file,
                int line)
{
    const double miss = fabs(value - expected), room = tol * (scale < 0.0 ? fabs(expected) : scale);
    if (isfinite(value) && isfinite(expected) && miss <= room) return;
    print_error("%s is %.17g, %.17g is expected: off by %.3g, %.3g is allowed\n", what, value, expected, miss,
                room);
    _fail(file, line);
}

uint64_t test_seed(void)
{
    const char *s = getenv("FLOE_SEED");
    uint64_t seed = 1;
    if (s && fl_number_u64(s, &seed)) {
        fprintf(stderr, "FLOE_SEED is \"%s\", a whole number is expected\n", s);
        exit(2);
    }
    return seed;
}

long test_times(long n)
{
    const char *s = getenv("FLOE_TIMES");
    double times = 1.0;
    if (s && (fl_number_f64(s, &times) || times <= 0.0 || times * (double)n > 1e15)) {
        fprintf(stderr, "FLOE_TIMES is \"%s\", a positive number is expected\n", s);
        exit(2);
    }
    n = lround(times * (double)n);
    return n < 1 ? 1 : n;
}

const char *test_path(const char *name)
{
    static char path[4][600];
    static int turn;
    const char *folder = getenv("TMPDIR");
    char *p = path[turn++ % 4];
    snprintf(p, sizeof path[0], "%s/floe-%ld-%s", folder && *folder ? folder : "/tmp", (long)getpid(), name);
    return p;
}

const char *test_file(const char *name, const void *data, size_t n)
{
    const char *path = test_path(name);
    FILE *f = fopen(path, "wb");
    if (!f || (n && fwrite(data, 1, n, f) != n) || fclose(f) != 0) {
        print_error("%s: %s\n", path, strerror(errno));
        _fail(__FILE__, __LINE__);
    }
    return path;
}
