/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/text.h"
#include "ice/concentration_gradient.h"

/* Largest coordinate [m]. */
#define FAR 1e9

double fl_concentration_at(const fl_concentration_gradient *g, fl_vec2 p)
{
    const double s = p.x * cos(g->angle) + p.y * sin(g->angle);
    int32_t lo = 0, hi = g->n - 1;
    if (s <= g->s[0]) return g->c[0];
    if (s >= g->s[hi]) return g->c[hi];
    while (hi - lo > 1) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (g->s[mid] <= s) lo = mid;
        else hi = mid;
    }
    return g->c[lo] + (s - g->s[lo]) / (g->s[hi] - g->s[lo]) * (g->c[hi] - g->c[lo]);
}

int fl_concentration_linear(fl_concentration_gradient *out, double angle, double c0, double c1, fl_vec2 lo,
                            fl_vec2 hi, fl_err *err)
{
    const double u = cos(angle), w = sin(angle);
    fl_concentration_gradient g = {.angle = angle, .n = 2};
    g.s = fl_alloc(2, sizeof *g.s, err);
    g.c = fl_alloc(2, sizeof *g.c, err);
    if (!g.s || !g.c) {
        fl_concentration_free(&g);
        return -1;
    }
    g.s[0] = fmin(u * lo.x, u * hi.x) + fmin(w * lo.y, w * hi.y);
    g.s[1] = fmax(u * lo.x, u * hi.x) + fmax(w * lo.y, w * hi.y);
    g.c[0] = c0;
    g.c[1] = c1;
    *out = g;
    return 0;
}

static int read_row(fl_concentration_gradient *g, int32_t *s_cap, int32_t *c_cap, fl_text *in, fl_err *err)
{
    double s = 0.0, c = 0.0;
    if (fl_text_f64(in, "s", &s, err) || fl_text_f64(in, "c", &c, err) || fl_text_no_more(in, err)) return -1;
    if (!(fabs(s) <= FAR)) return fl_text_fail(in, err, "place %g found, one up to %g is expected", s, FAR);
    if (!(c > 0.0 && c < 1.0))
        return fl_text_fail(in, err, "concentration %g found, one between 0 and 1 is expected", c);
    if (g->n && !(s > g->s[g->n - 1]))
        return fl_text_fail(in, err, "place %g does not follow %g", s, g->s[g->n - 1]);
    if (fl_grow(&g->s, s_cap, (int64_t)g->n + 1, sizeof *g->s, err) ||
        fl_grow(&g->c, c_cap, (int64_t)g->n + 1, sizeof *g->c, err))
        return -1;
    g->s[g->n] = s;
    g->c[g->n++] = c;
    return 0;
}

int fl_concentration_read(fl_concentration_gradient *out, double angle, const char *path, fl_err *err)
{
    fl_concentration_gradient g = {.angle = angle};
    fl_text in = {0};
    int32_t s_cap = 0, c_cap = 0, rows = 0;
    int rc = -1, more;
    if (fl_text_open(&in, path, err)) goto done;
    while ((more = fl_text_row(&in, err)) > 0) {
        if (rows++ == 0 && in.n == 2 && strcmp(in.field[0], "s[m]") == 0 && strcmp(in.field[1], "c") == 0)
            continue;
        if (read_row(&g, &s_cap, &c_cap, &in, err)) goto done;
    }
    if (more < 0) goto done;
    if (g.n == 0) {
        fl_text_fail(&in, err, "the file ends without a row, a place and a concentration are expected");
        goto done;
    }
    *out = g;
    g = (fl_concentration_gradient){0};
    rc = 0;
done:
    fl_concentration_free(&g);
    fl_text_close(&in);
    return rc;
}

void fl_concentration_free(fl_concentration_gradient *g)
{
    free(g->s);
    free(g->c);
    *g = (fl_concentration_gradient){0};
}
