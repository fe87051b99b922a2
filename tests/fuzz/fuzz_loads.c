/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/view.h"
#include "support/fuzz.h"

/* What was read must be describable: raw, and through a filter where the record carries one. */
static int views(const fl_series *s, fl_err *err)
{
    const double p[] = {0.0, 0.5, 1.0};
    for (int32_t k = 0; k < s->parts * s->signals; k++) {
        fl_view_ask ask = {.order = 2, .ratio = 0.5, .quantiles = 3, .p = p};
        fl_view v = {0};
        if (!s->x[k]) continue;
        if (fl_view_make(&v, s, k / s->signals, k % s->signals, &ask, err)) return -1;
        const int sound = isfinite(v.d.mean) && isfinite(v.d.std) && v.q[0] == v.d.min && v.q[2] == v.d.max;
        fl_view_free(&v);
        if (!sound) return FUZZ_BROKEN;
        ask.filter = 0.4 * s->n / (s->edge[s->n] - s->edge[0]);
        fl_err own = {0};
        if (fl_view_make(&v, s, k / s->signals, k % s->signals, &ask, &own) && own.code == FL_SYSTEM) {
            *err = own;
            return -1;
        }
        fl_view_free(&v);
    }
    return 0;
}

static int fuzz_one(const unsigned char *data, size_t n)
{
    const fl_series_ask ask = {.from = -INFINITY, .to = INFINITY};
    fl_err err = {0};
    fl_series s = {0};
    int rc = fl_series_read(&s, fuzz_file(data, n), &ask, &err);
    if (rc == 0) rc = views(&s, &err);
    fl_series_free(&s);
    return rc == FUZZ_BROKEN ? FUZZ_BROKEN : fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "loads", fuzz_one); }
