/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/gjk_dd.h"
#include <math.h>
#include <stddef.h>
#include "geom/dd.h"

/* |v| below this fraction of the size is a touch.  Two edges of a rotated lattice body are parallel to 2^-53
 * only.  The normal of the sliver that they span is good to 2^-106 / 2^-53, so v to 2^-53 of the size. */
#define TOUCH_TOL (4.0 * 2.220446049250313e-16)

/* Bounds that no query has reached; they make termination certain. */
enum { MAX_STEPS = 4096, MAX_IDLE = 16 };

/* Squared distances this near to each other are equal: the rounding on a sliver 1e-20 of its length wide. */
#define TIE_TOL 1e-12

typedef struct {
    int32_t n, a[4], b[4];
    fl_ddv w[4];
} dd_simplex;

typedef struct {
    fl_dd d2;
    fl_ddv v;
    double beyond; /* how far the other points of the simplex lie below the plane through v */
    int32_t n, k[4];
    double share[4]; /* v = sum of share[i] w[k[i]]; shares sum to 1 */
} dd_closest;

/* A simplex without length, area or volume is left to its sub-simplices.  A triangle this thin (squared) has
 * the direction of its height to 1e-6; omitting it turns the normal by its height over the distance. */
#define THIN_TRIANGLE 1e-52
/* A tetrahedron (squared): 1e-29, the rounding of a product of double-doubles with a margin. */
#define FLAT_TETRAHEDRON 1e-58

static int project_segment(const dd_simplex *s, dd_closest *c)
{
    const fl_ddv p = s->w[c->k[0]], e = ddv_sub(s->w[c->k[1]], p);
    const fl_dd ee = ddv_dot(e, e), t = dd_neg(ddv_dot(p, e));
    if (!(ee.h > 0.0) || !(t.h > 0.0) || !(dd_cmp(t, ee) < 0.0)) return 0;
    const fl_dd x = dd_div(t, ee);
    c->v = ddv_madd(p, x, e);
    c->share[0] = 1.0 - x.h;
    c->share[1] = x.h;
    return 1;
}

/* Projects onto the line of the longest side, which leaves u, then along the height h over it.  The error is
 * 2^-104 of the points in u, and of u over the slenderness in what follows.  With the product of two sides it
 * would be that of the points over the slenderness: 1e-13 of a distance of 1e-11 on sides that are parallel
 * to 1e-9. */
static int project_triangle(const dd_simplex *s, dd_closest *c)
{
    double longest = -1.0;
    int i = 0, j = 1, k = 2;
    for (int side = 0; side < 3; side++) {
        const double l = v3_norm2(v3_sub(ddv_round(s->w[c->k[(side + 1) % 3]]), ddv_round(s->w[c->k[side]])));
        if (l > longest) {
            longest = l;
            i = side;
        }
    }
    j = (i + 1) % 3;
    k = (i + 2) % 3;
    const fl_ddv p = s->w[c->k[i]], e = ddv_sub(s->w[c->k[j]], p), g = ddv_sub(s->w[c->k[k]], p);
    const fl_dd ee = ddv_dot(e, e);
    if (!(ee.h > 0.0)) return 0;
    const fl_dd foot = dd_div(ddv_dot(g, e), ee), t = dd_neg(dd_div(ddv_dot(p, e), ee));
    const fl_ddv h = ddv_madd(g, dd_neg(foot), e), u = ddv_madd(p, t, e);
    const fl_dd hh = ddv_dot(h, h);
    if (!(hh.h > THIN_TRIANGLE * ee.h)) return 0;
    const fl_dd y = dd_neg(dd_div(ddv_dot(u, h), hh)), x = dd_sub(t, dd_mul(y, foot)),
                z = dd_sub(dd_sub(dd_of(1.0), x), y);
    if (!(x.h > 0.0 && y.h > 0.0 && z.h > 0.0)) return 0;
    c->v = ddv_madd(u, y, h);
    c->share[i] = z.h;
    c->share[j] = x.h;
    c->share[k] = y.h;
    return 1;
}

/* Sets c->v to the point of the affine hull of the points c->k[0 .. c->n) closest to the origin; 0 if it lies
 * outside them. */
static int project_origin(const dd_simplex *s, dd_closest *c)
{
    const fl_ddv p = s->w[c->k[0]];
    c->share[0] = 1.0;
    c->v = p;
    if (c->n == 1) return 1;
    if (c->n == 2) return project_segment(s, c);
    if (c->n == 3) return project_triangle(s, c);
    const fl_ddv q = s->w[c->k[1]], r = s->w[c->k[2]], e = ddv_sub(q, p), g = ddv_sub(r, p),
                 m = ddv_cross(e, g);
    const double ee = ddv_dot(e, e).h, gg = ddv_dot(g, g).h;
    const fl_ddv t = s->w[c->k[3]], h = ddv_sub(t, p);
    const double det = ddv_dot(m, h).h;
    if (!(det * det > FLAT_TETRAHEDRON * ee * gg * ddv_dot(h, h).h)) return 0;
    /* Volumes of the tetrahedra of the origin with the four faces, over that of the whole. */
    const double x[4] = {ddv_dot(q, ddv_cross(r, t)).h / det, -ddv_dot(p, ddv_cross(r, t)).h / det,
                         ddv_dot(p, ddv_cross(q, t)).h / det, -ddv_dot(p, ddv_cross(q, r)).h / det};
    for (int32_t k = 0; k < 4; k++) {
        if (x[k] < 0.0) return 0;
        c->share[k] = x[k];
    }
    c->v = (fl_ddv){dd_of(0.0), dd_of(0.0), dd_of(0.0)};
    return 1;
}

/* Depth of the lowest point of the simplex below the plane across c->v through it, 0 for none. */
static double depth_below_plane(const dd_simplex *s, const dd_closest *c)
{
    double most = 0.0;
    for (int32_t k = 0; k < s->n; k++) {
        const double t = ddv_dot(c->v, ddv_sub(s->w[c->k[0]], s->w[k])).h;
        most = t > most ? t : most;
    }
    return most / sqrt(c->d2.h);
}

/* Tries every sub-simplex, so the sign of a rounded number cannot lose the closest one.  The right one has
 * the plane that leaves the least of the simplex below it: none but for rounding, and linear in the error of
 * its direction.  The distance is quadratic in it: for cores of size 1 that are 1e-11 apart, rounding hides
 * angles up to 1e-11 rad.  A sub-simplex nearer than `touch` ends the search.  held >= 0: a point that the
 * right one is known to contain.  best->n is 0 when none is found. */
static void reduce_simplex(dd_simplex *s, int32_t held, double touch, dd_closest *best)
{
    *best = (dd_closest){.d2 = {INFINITY, 0.0}, .beyond = INFINITY};
    for (int32_t set = 1; set < 1 << s->n; set++) {
        if (held >= 0 && !(set >> held & 1)) continue;
        dd_closest c = {.n = 0};
        for (int32_t k = 0; k < s->n; k++)
            if (set >> k & 1) c.k[c.n++] = k;
        if (!project_origin(s, &c)) continue;
        c.d2 = ddv_dot(c.v, c.v);
        if (!(c.d2.h > touch * touch)) {
            *best = c;
            break;
        }
        c.beyond = depth_below_plane(s, &c);
        if (c.beyond < best->beyond) *best = c;
    }
    dd_simplex t = {.n = best->n};
    for (int32_t k = 0; k < t.n; k++) {
        t.a[k] = s->a[best->k[k]];
        t.b[k] = s->b[best->k[k]];
        t.w[k] = s->w[best->k[k]];
    }
    *s = t;
}

/* As fl_core_support(), with ties of doubles decided in double-doubles. */
static int32_t support_dd(fl_core c, fl_ddv n, int32_t from, double size)
{
    int32_t near[FL_CORE_SMALL];
    double above[FL_CORE_SMALL], clear;
    const fl_vec3 dir = ddv_round(n);
    const int32_t k =
        fl_core_support_band(c, dir, NULL, from, FL_SUPPORT_ROUNDING * size, near, above, &clear);
    const int all = k > FL_CORE_SMALL;
    double low = 0.0;
    int32_t at = all ? fl_core_support(c, dir, &low) : near[0];
    fl_dd best = ddv_dot(n, ddv_diff(c.v[at], c.v[0]));
    for (int32_t i = 0; i < (all ? c.n : k); i++) {
        const int32_t v = all ? i : near[i];
        if (v == at || (all && v3_dot(dir, v3_sub(c.v[v], c.v[0])) > low + FL_SUPPORT_ROUNDING * size))
            continue;
        const fl_dd s = ddv_dot(n, ddv_diff(c.v[v], c.v[0]));
        if (dd_cmp(s, best) < 0.0) {
            best = s;
            at = v;
        }
    }
    return at;
}

int fl_gjk_dd(fl_core a, fl_core b, double size, fl_simplex *s, fl_gap *out)
{
    dd_simplex walk = {.n = s->n}, f;
    dd_closest next, now;
    const double touch = TOUCH_TOL * (size > 0.0 ? size : v3_norm(v3_sub(a.v[0], b.v[0])));
    for (int32_t k = 0; k < s->n; k++) {
        walk.a[k] = s->a[k];
        walk.b[k] = s->b[k];
        walk.w[k] = ddv_diff(a.v[walk.a[k]], b.v[walk.b[k]]);
    }
    int idle = 0;
    int32_t i = s->a[0], j = s->b[0];
    double least = INFINITY; /* depth below the plane of `now` */
    reduce_simplex(&walk, -1, touch, &next);
    f = walk;
    now = next;
    for (int step = 0; step < MAX_STEPS; step++) {
        const double len = sqrt(next.d2.h > 0.0 ? next.d2.h : 0.0);
        if (!(len > touch)) {
            f = walk;
            now = next;
            out->overlap = 1;
            break;
        }
        const fl_ddv dir = ddv_scale(dd_div(dd_of(1.0), dd_of(len)), next.v);
        i = support_dd(a, dir, i, size);
        j = support_dd(b, (fl_ddv){dd_neg(dir.x), dd_neg(dir.y), dd_neg(dir.z)}, j, size);
        const fl_ddv w = ddv_diff(a.v[i], b.v[j]);
        const double beyond = ddv_dot(dir, ddv_sub(walk.w[0], w)).h;
        out->iterations++;
        /* Where distances are equal to the last bit, a few more steps are made and the best is kept. */
        if (next.d2.h < now.d2.h * (1.0 - TIE_TOL) || beyond < least) {
            f = walk;
            now = next;
            least = beyond;
        } else if (idle++ == MAX_IDLE) break;
        if (!(beyond > 0.0) || fl_simplex_has(walk.n, walk.a, walk.b, i, j)) break;
        walk.a[walk.n] = i;
        walk.b[walk.n] = j;
        walk.w[walk.n++] = w;
        /* w lies below the plane through v, so the closest sub-simplex contains w. */
        reduce_simplex(&walk, walk.n - 1, touch, &next);
        if (next.n == 0 || next.d2.h > now.d2.h * (1.0 + TIE_TOL)) break;
    }
    out->d = out->overlap ? 0.0 : sqrt(now.d2.h);
    out->n = out->overlap ? v3(0, 0, 0) : v3_unit(v3_scale(1.0 / out->d, ddv_round(now.v)));
    out->pa = a.v[f.a[0]];
    out->pb = b.v[f.b[0]];
    for (int32_t k = 1; k < f.n; k++) {
        out->pa = v3_madd(out->pa, now.share[k], v3_sub(a.v[f.a[k]], a.v[f.a[0]]));
        out->pb = v3_madd(out->pb, now.share[k], v3_sub(b.v[f.b[k]], b.v[f.b[0]]));
    }
    s->n = f.n;
    for (int32_t k = 0; k < f.n; k++) {
        s->a[k] = f.a[k];
        s->b[k] = f.b[k];
        s->w[k] = ddv_round(f.w[k]);
    }
    return out->overlap;
}
