/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/fast_math.h"
#include "base/array.h"
#include "base/text.h"
#include "water/current.h"

/* Bounds of a plausible current: no sea is deeper than 12 km, and none is faster [m], [m/s]. */
#define MAX_HEIGHT 12000.0
#define MAX_SPEED 100.0

static fl_vec3 velocity_in_table(const fl_current *c, double z)
{
    int32_t lo = 0, hi = c->n - 1;
    if (z <= c->z[0]) return c->u[0];
    if (z >= c->z[hi]) return c->u[hi];
    while (hi - lo > 1) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (c->z[mid] <= z) lo = mid;
        else hi = mid;
    }
    return v3_lerp(c->u[lo], c->u[hi], (z - c->z[lo]) / (c->z[hi] - c->z[lo]));
}

fl_vec3 fl_current_at(const fl_current *c, double z)
{
    if (c->kind == FL_PROFILE_UNIFORM) return c->velocity;
    if (c->kind == FL_PROFILE_TABLE) return velocity_in_table(c, z);
    const double part = z < 0.0 ? 1.0 + z / c->depth : 1.0;
    if (!(part > 0.0)) return v3(0, 0, 0);
    return v3_scale(c->kind == FL_PROFILE_POWER ? fl_pow(part, c->exponent) : part, c->velocity);
}

double fl_current_max_speed(const fl_current *c)
{
    double most = c->kind == FL_PROFILE_TABLE ? 0.0 : v3_norm(c->velocity);
    for (int32_t k = 0; k < c->n; k++) most = fmax(most, v3_norm(c->u[k]));
    return most;
}

/* Reads one row. Heights continue in the direction of the first two rows. */
static int read_row(fl_current *c, int32_t *z_cap, int32_t *u_cap, fl_text *in, fl_err *err)
{
    double z = 0.0;
    fl_vec3 u = {0};
    if (fl_text_f64(in, "z", &z, err) || fl_text_f64(in, "u", &u.x, err) || fl_text_f64(in, "v", &u.y, err) ||
        fl_text_no_more(in, err))
        return -1;
    if (!(fabs(z) <= MAX_HEIGHT))
        return fl_text_fail(in, err, "height %g m found, expected one within %g m", z, MAX_HEIGHT);
    if (!(v3_norm(u) <= MAX_SPEED))
        return fl_text_fail(in, err, "speed %g m/s found, expected one up to %g m/s", v3_norm(u), MAX_SPEED);
    if (c->n) {
        const double last = c->z[c->n - 1];
        if (z == last || (c->n > 1 && (z > last) != (last > c->z[0])))
            return fl_text_fail(in, err,
                                "height %g m does not follow %g m: expected heights all rising or all "
                                "falling",
                                z, last);
    }
    if (fl_grow(&c->z, z_cap, (int64_t)c->n + 1, sizeof *c->z, err) ||
        fl_grow(&c->u, u_cap, (int64_t)c->n + 1, sizeof *c->u, err))
        return -1;
    c->z[c->n] = z;
    c->u[c->n++] = u;
    return 0;
}

static void reverse_rows(fl_current *c)
{
    for (int32_t lo = 0, hi = c->n - 1; lo < hi; lo++, hi--) {
        const double z = c->z[lo];
        const fl_vec3 u = c->u[lo];
        c->z[lo] = c->z[hi];
        c->u[lo] = c->u[hi];
        c->z[hi] = z;
        c->u[hi] = u;
    }
}

int fl_current_read(fl_current *c, const char *path, fl_err *err)
{
    fl_text in = {0};
    fl_current t = {0};
    int32_t z_cap = 0, u_cap = 0;
    int rc = -1, more;
    if (fl_text_open(&in, path, err) || fl_text_magic(&in, "current", 1, err)) goto done;
    while ((more = fl_text_row(&in, err)) > 0)
        if (read_row(&t, &z_cap, &u_cap, &in, err)) goto done;
    if (more < 0) goto done;
    if (t.n == 0) {
        fl_text_fail(&in, err, "no row found, expected rows of height and velocity");
        goto done;
    }
    if (t.n > 1 && t.z[0] > t.z[1]) reverse_rows(&t);
    fl_current_free(c);
    c->kind = FL_PROFILE_TABLE;
    c->n = t.n;
    c->z = t.z;
    c->u = t.u;
    t = (fl_current){0};
    rc = 0;
done:
    fl_current_free(&t);
    fl_text_close(&in);
    return rc;
}

void fl_current_free(fl_current *c)
{
    free(c->z), free(c->u);
    *c = (fl_current){0};
}
