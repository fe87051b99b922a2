/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/cone_profile.h"
#include <math.h>

/* Two parameters of a line that differ by less, over their size, are equal: two units of 2^-52. */
#define ROUNDING 4e-16

/* Steps of the search for the end of s, and for its maximum. */
enum { ROOT_STEPS = 60, GOLDEN_STEPS = 40 };

fl_cone_profile fl_cone_profile_of(const fl_truncated_cone *c, double R)
{
    const double length = sqrt(c->h * c->h + (c->r1 - c->r0) * (c->r1 - c->r0));
    return (fl_cone_profile){c->r0, c->r1, c->h, R, c->h / length, (c->r0 - c->r1) / length, length};
}

static fl_cone_profile_field distance_from_rim(double rho, double z, int zone)
{
    const double d = sqrt(rho * rho + z * z), over = d > 0.0 ? 1.0 / d : 0.0;
    return (fl_cone_profile_field){d, d > 0.0 ? rho * over : 1.0, z * over, over, zone};
}

fl_cone_profile_field fl_cone_profile_distance(const fl_cone_profile *c, double rho, double z)
{
    const double out = c->nr * (rho - c->r0) + c->nz * z, along = c->nr * z - c->nz * (rho - c->r0);
    if (out <= 0.0 && z >= 0.0 && z <= c->h) { /* inside: distance from the nearest side */
        if (out >= -z && out >= z - c->h)
            return (fl_cone_profile_field){out, c->nr, c->nz, 0.0, FL_CONE_SIDE};
        return -z > z - c->h ? (fl_cone_profile_field){-z, 0.0, -1.0, 0.0, FL_CONE_LOW_END}
                             : (fl_cone_profile_field){z - c->h, 0.0, 1.0, 0.0, FL_CONE_HIGH_END};
    }
    if (out > 0.0 && along >= 0.0 && along <= c->length)
        return (fl_cone_profile_field){out, c->nr, c->nz, 0.0, FL_CONE_SIDE};
    if (z < 0.0 && rho <= c->r0) return (fl_cone_profile_field){-z, 0.0, -1.0, 0.0, FL_CONE_LOW_END};
    if (z > c->h && rho <= c->r1) return (fl_cone_profile_field){z - c->h, 0.0, 1.0, 0.0, FL_CONE_HIGH_END};
    return 2.0 * along < c->length ? distance_from_rim(rho - c->r0, z, FL_CONE_LOW_RIM)
                                   : distance_from_rim(rho - c->r1, z - c->h, FL_CONE_HIGH_RIM);
}

double fl_cone_profile_radius(const fl_cone_profile *c, double z)
{
    const double on = z - c->R * c->nz;
    if (on >= 0.0 && on <= c->h) return c->r0 + on / c->h * (c->r1 - c->r0) + c->R * c->nr;
    const double up = on < 0.0 ? z : z - c->h, left = c->R * c->R - up * up;
    return left > 0.0 ? (on < 0.0 ? c->r0 : c->r1) + sqrt(left) : -1.0;
}

/* > 0 inside the dilated cone; concave in t. */
static double depth_inside(const fl_cone_profile *c, const fl_cone_profile_line *l, double t)
{
    const double p = fl_cone_profile_radius(c, l->z0 + t * l->dz), rho2 = l->a + t * (2.0 * l->b + t * l->g);
    return p < 0.0 ? p - fabs(l->z0 + t * l->dz - 0.5 * c->h) : p - sqrt(rho2 > 0.0 ? rho2 : 0.0);
}

/* Root of depth_inside() between a point inside and one outside: false position that halves the value of an
 * end that stays (Illinois).  Returns the last point inside. */
static double find_surface(const fl_cone_profile *c, const fl_cone_profile_line *l, double in, double out)
{
    double fi = depth_inside(c, l, in), fo = depth_inside(c, l, out);
    const double same = ROUNDING * (fabs(in) + fabs(out));
    for (int k = 0, side = 0; k < ROOT_STEPS && fabs(in - out) > same; k++) {
        double t = in - fi * (out - in) / (fo - fi);
        if (k % 4 == 3 || (in < out ? !(t > in && t < out) : !(t < in && t > out))) t = 0.5 * (in + out);
        const double f = depth_inside(c, l, t);
        if (f == 0.0) return t;
        if (f > 0.0) {
            in = t, fi = f;
            if (side > 0) fo *= 0.5;
            side = 1;
        } else {
            out = t, fo = f;
            if (side < 0) fi *= 0.5;
            side = -1;
        }
    }
    return in;
}

/* Clips where the side alone is within reach of [lo, hi]: p(t)^2 - rho(t)^2 is A t^2 + 2 B t + C, positive
 * between its zeros.  -1 where the side may not be alone. */
static int clip_beside_side(const fl_cone_profile *c, const fl_cone_profile_line *l, double *lo, double *hi,
                            int zero[2])
{
    const double up = c->R * c->nz, z0 = l->z0 + *lo * l->dz - up, z1 = l->z0 + *hi * l->dz - up;
    if (!(fmin(z0, z1) >= 0.0 && fmax(z0, z1) <= c->h)) return -1;
    const double grow = (c->r1 - c->r0) / c->h, p0 = c->r0 + (l->z0 - up) * grow + c->R * c->nr,
                 p1 = grow * l->dz;
    const double A = p1 * p1 - l->g, B = p0 * p1 - l->b, C = p0 * p0 - l->a, left = B * B - A * C;
    if (!(A < 0.0)) return -1;
    if (!(left > 0.0)) return 0;
    const double q = -B - copysign(sqrt(left), B), t0 = q / A, t1 = C / q;
    const double from = t0 < t1 ? t0 : t1, to = t0 < t1 ? t1 : t0;
    zero[0] = from > *lo, zero[1] = to < *hi;
    if (zero[0]) *lo = from;
    if (zero[1]) *hi = to;
    return *lo < *hi;
}

int fl_cone_profile_clip(const fl_cone_profile *c, const fl_cone_profile_line *l, double *lo, double *hi,
                         int zero[2])
{
    const double ratio = 0.61803398874989485, z0 = l->z0 + *lo * l->dz, z1 = l->z0 + *hi * l->dz;
    const double wide = fmax(c->r0, c->r1) + c->R;
    double a = *lo, b = *hi, in = l->g > 0.0 ? -l->b / l->g : a; /* nearest to the axis */
    in = in < a ? a : in > b ? b : in;
    if (fmin(z0, z1) >= c->h + c->R || fmax(z0, z1) <= -c->R) return 0;
    if (l->a + in * (2.0 * l->b + in * l->g) >= wide * wide) return 0;
    const int known = clip_beside_side(c, l, lo, hi, zero);
    if (known >= 0) return known;
    const int lo_in = depth_inside(c, l, a) > 0.0, hi_in = depth_inside(c, l, b) > 0.0;
    zero[0] = !lo_in, zero[1] = !hi_in;
    if (lo_in && hi_in) return 1;
    if (lo_in) in = a;
    else if (hi_in) in = b;
    else if (!(depth_inside(c, l, in) > 0.0)) {
        /* this is the deepest point */
        if (c->nz == 0.0 && fmin(z0, z1) >= 0.0 && fmax(z0, z1) <= c->h) return 0;
        double x = b - ratio * (b - a), y = a + ratio * (b - a), fx = depth_inside(c, l, x),
               fy = depth_inside(c, l, y);
        for (int k = 0; k < GOLDEN_STEPS && fx <= 0.0 && fy <= 0.0; k++) {
            if (fx > fy) b = y, y = x, fy = fx, x = b - ratio * (b - a), fx = depth_inside(c, l, x);
            else a = x, x = y, fx = fy, y = a + ratio * (b - a), fy = depth_inside(c, l, y);
        }
        if (fx <= 0.0 && fy <= 0.0) return 0;
        in = fx > 0.0 ? x : y;
    }
    if (!lo_in) *lo = find_surface(c, l, in, *lo);
    if (!hi_in) *hi = find_surface(c, l, in, *hi);
    return *lo < *hi;
}

int32_t fl_cone_profile_breaks(const fl_cone_profile *c, const fl_cone_profile_line *l, double lo, double hi,
                               double *out)
{
    const double z[4] = {0.0, c->h, c->R * c->nz, c->h + c->R * c->nz};
    int32_t n = 0;
    for (int k = 0; k < 4; k++) {
        const double t = (z[k] - l->z0) / l->dz;
        if (k > 1 && c->nz == 0.0) break;
        if (t > lo && t < hi) out[n++] = t;
    }
    return n;
}
