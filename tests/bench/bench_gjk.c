/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_gjk.c -- cost and error of a distance query, and libccd on the same pairs in the same run.  Floes:
 * prisms of 4 to 8 corners, 3.5 m wide, 0.5 m thick, dilated by 0.05 m, in pairs
 *     near      0.15 mm to 0.6 m apart, as the gaps of a field of 80 %
 *     flush     standing on one plane, side face to side face
 *     touching  the dilated shapes overlap by 5 % of the radii
 *     large     two ellipsoids of growing vertex counts, rotating past each other by 1e-4 rad per frame:
 *               warm along their edges, cold, and warm over all vertices
 * Errors of `large`: distance less the gap between the planes normal to the direction found, in long
 * double, which is no less than the true error.  Other errors: largest error of distance (or depth of the
 * dilated shapes) against brute force in long double [m], and of the direction [rad].  Times are thread
 * time of this machine; compare rows of one run only. */
#include <ccd/ccd.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "base/pi.h"
#include "base/rng.h"
#include "geom/quat.h"
#include "narrow/contact.h"
#include "support/oracle.h"
#include "support/convex_pairs.h"

#define RADIUS 0.05

enum { PAIRS = 400, FRAMES = 8, ROUNDS = 20 };

enum scene { NEAR, FLUSH, TOUCHING, SCENES };

/* The same pair in frames a tenth of a millimetre apart, for warm starts. */
typedef struct {
    pair_case q[FRAMES];
    fl_gjk_cache cache;
    fl_mode mode;
} motion;

static double thread_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int floe(fl_poly *p, fl_rng *g)
{
    fl_vec3 xy[8];
    fl_err err = {0};
    const int32_t n = 4 + (int32_t)(5.0 * fl_rng_unit(g));
    for (int32_t i = 0; i < n; i++) {
        const double t = 2.0 * PI * (i + 0.6 * fl_rng_unit(g)) / n;
        xy[i] = v3(1.75 * cos(t), 1.75 * sin(t), 0.0);
    }
    return fl_poly_prism(p, n, xy, -0.2, 0.2, &err);
}

static int make_motion(motion *m, enum scene scene, int k)
{
    fl_rng g = fl_rng_of(7, SCENES * k + (int)scene, FL_RNG_TEST);
    fl_poly a = {0}, b = {0};
    if (floe(&a, &g) || floe(&b, &g)) return -1;
    const double gap = scene == TOUCHING ? 1.9 * RADIUS : 2.0 * RADIUS + pow(10.0, fl_rng_in(&g, -3.8, -0.2));
    /* A side face of a looks down x at one of b, which is rotated to face it; flush means exactly. */
    const fl_vec3 na = a.n[2 + (int)(fl_rng_unit(&g) * (a.nf - 2))],
                  nb = b.n[2 + (int)(fl_rng_unit(&g) * (b.nf - 2))];
    const double ta = atan2(na.y, na.x), tb = atan2(nb.y, nb.x) + PI;
    const double off = scene == FLUSH ? 0.0 : 0.2;
    const fl_vec3 tilt = v3(0.012 * fl_rng_normal(&g), 0.012 * fl_rng_normal(&g), off * fl_rng_normal(&g)),
                  slide = v3(0, fl_rng_in(&g, -1, 1), scene == FLUSH ? 0.0 : fl_rng_in(&g, -0.1, 0.1));
    for (int f = 0; f < FRAMES; f++) {
        pair_case *q = &m->q[f];
        fl_poly pa = {0}, pb = {0};
        fl_err err = {0};
        if (fl_poly_copy(&pa, &a, &err) || fl_poly_copy(&pb, &b, &err) || pair_take(q, pa, pb)) return -1;
        const fl_vec3 small = v3_scale(1e-4 * f, v3(0.3, 1.0, scene == FLUSH ? 0.0 : 0.1));
        pair_place(q, 0, v3(0, 0, 0), q_matrix(q_about_axis(2, -ta)));
        const fl_vec3 w = scene == FLUSH ? v3(0, 0, 0) : v3_add(tilt, v3_scale(0.1, small));
        pair_place(q, 1, v3_add(slide, small), q_matrix(q_mul(q_of_vector(w), q_about_axis(2, -tb))));
        double ha = -INFINITY, lb = INFINITY;
        for (int32_t i = 0; i < a.nv; i++) ha = fmax(ha, q->v[0][i].x);
        for (int32_t i = 0; i < b.nv; i++) lb = fmin(lb, q->v[1][i].x);
        for (int32_t i = 0; i < b.nv; i++) q->v[1][i].x += ha + gap - lb;
        q->a.r = q->b.r = RADIUS;
    }
    m->cache = (fl_gjk_cache){0};
    m->mode = FL_MODE_NONE;
    fl_poly_free(&a);
    fl_poly_free(&b);
    return 0;
}

static void ccd_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const fl_solid *s = obj;
    int32_t at = 0;
    double best = -INFINITY;
    const fl_vec3 d = v3(dir->v[0], dir->v[1], dir->v[2]);
    for (int32_t i = 0; i < s->p->nv; i++) {
        const double t = v3_dot(d, s->v[i]);
        if (t > best) {
            best = t;
            at = i;
        }
    }
    const fl_vec3 p = v3_madd(s->v[at], s->r / v3_norm(d), d);
    ccdVec3Set(out, p.x, p.y, p.z);
}

static void ccd_centre(const void *obj, ccd_vec3_t *out)
{
    const fl_solid *s = obj;
    fl_vec3 c = {0, 0, 0};
    for (int32_t i = 0; i < s->p->nv; i++) c = v3_add(c, s->v[i]);
    c = v3_scale(1.0 / s->p->nv, c);
    ccdVec3Set(out, c.x, c.y, c.z);
}

/* A query: signed distance of the dilated shapes and its direction; 0 if it has none. */
typedef int query(motion *m, const pair_case *q, double *gap, fl_vec3 *n);

static int of_gap(const fl_gap *g, double *gap, fl_vec3 *n)
{
    *gap = g->d - 2.0 * RADIUS;
    *n = g->n;
    return 1;
}

static int cold(motion *m, const pair_case *q, double *gap, fl_vec3 *n)
{
    fl_gap g;
    (void)m;
    fl_gjk(fl_solid_core(&q->a), fl_solid_core(&q->b), NULL, &g);
    return of_gap(&g, gap, n);
}

static int warm(motion *m, const pair_case *q, double *gap, fl_vec3 *n)
{
    fl_gap g;
    fl_gjk(fl_solid_core(&q->a), fl_solid_core(&q->b), &m->cache, &g);
    return of_gap(&g, gap, n);
}

static int contact(motion *m, const pair_case *q, double *gap, fl_vec3 *n)
{
    fl_contact c;
    fl_contact_find(&q->a, &q->b, m->mode, &m->cache, NULL, &c);
    m->mode = c.mode;
    *gap = c.gap;
    *n = c.n;
    return 1;
}

static int ccd_with(const pair_case *q, int mpr, double *gap, fl_vec3 *n)
{
    ccd_t ccd;
    ccd_real_t depth = 0;
    ccd_vec3_t dir, at;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.center1 = ccd.center2 = ccd_centre;
    ccd.max_iterations = 100;
    ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)1e-6;
    const int rc = mpr ? ccdMPRPenetration(&q->a, &q->b, &ccd, &depth, &dir, &at)
                       : ccdGJKPenetration(&q->a, &q->b, &ccd, &depth, &dir, &at);
    if (rc) return 0;
    *gap = -depth;
    *n = v3(-dir.v[0], -dir.v[1], -dir.v[2]);
    return 1;
}

static int ccd_mpr(motion *m, const pair_case *q, double *gap, fl_vec3 *n)
{
    (void)m;
    return ccd_with(q, 1, gap, n);
}

static int ccd_epa(motion *m, const pair_case *q, double *gap, fl_vec3 *n)
{
    (void)m;
    return ccd_with(q, 0, gap, n);
}

static int print_row(const char *name, query *ask, motion *m, int measures)
{
    const double begun = thread_time();
    double gap = 0.0, worst = 0.0, worst_n = 0.0, sum = 0.0;
    fl_vec3 n = {0, 0, 0};
    long none = 0;
    for (int r = 0; r < ROUNDS; r++)
        for (int k = 0; k < PAIRS; k++) /* the frames forwards and backwards */
            for (int f = 0; f < FRAMES; f++)
                sum += ask(&m[k], &m[k].q[r % 2 ? FRAMES - 1 - f : f], &gap, &n) ? gap : 0.0;
    const double spent = thread_time() - begun;
    for (int k = 0; k < PAIRS && measures; k++) {
        oracle_gap o;
        if (!ask(&m[k], &m[k].q[0], &gap, &n)) {
            none++;
            continue;
        }
        oracle_distance(&m[k].q[0].a, &m[k].q[0].b, &o);
        const fl_vec3 on = v3((double)o.n[0], (double)o.n[1], (double)o.n[2]);
        worst = fmax(worst, fabs((double)(o.d - 2.0L * (real)RADIUS - (real)gap)));
        worst_n = fmax(worst_n, atan2(v3_norm(v3_cross(on, n)), v3_dot(on, n)));
    }
    printf("  %-34s %8.0f", name, 1e9 * spent / (ROUNDS * PAIRS * FRAMES));
    if (measures) printf(" %12.1e %12.1e %6ld", worst, worst_n, none);
    printf("\n");
    return isfinite(sum);
}

/* --- many vertices ------------------------------------------------------------------------------------ */

typedef struct {
    pair_case q[FRAMES];
    fl_gjk_cache cache;
} ellipsoids;

static int make_ellipsoids(ellipsoids *m, int32_t rings, int32_t around)
{
    *m = (ellipsoids){0};
    for (int f = 0; f < FRAMES; f++) {
        fl_poly p[2] = {{0}, {0}};
        if (pair_ellipsoid(&p[0], rings, around, v3(1.0, 0.8, 0.6)) ||
            pair_ellipsoid(&p[1], rings, around, v3(0.7, 1.0, 0.9)) || pair_take(&m->q[f], p[0], p[1])) {
            fl_poly_free(&p[0]);
            fl_poly_free(&p[1]);
            return -1;
        }
        pair_place(&m->q[f], 0, v3(0, 0, 0), q_matrix(q_of_vector(v3(0.3 + 1e-4 * f, 0.2, 0.1))));
        pair_place(&m->q[f], 1, v3(1.6, 1.1, 0.3), q_matrix(q_of_vector(v3(0.1, 0.7 - 1e-4 * f, 0.4))));
    }
    return 0;
}

static void query_ellipsoids(ellipsoids *m, int f, int all, int keep, fl_gap *g)
{
    fl_core a = fl_solid_core(&m->q[f].a), b = fl_solid_core(&m->q[f].b);
    if (all) a.p = b.p = NULL;
    fl_gjk(a, b, keep ? &m->cache : NULL, g);
}

static double time_ellipsoids(ellipsoids *m, int times, int all, int keep)
{
    fl_gap g;
    const double begun = thread_time();
    for (int r = 0; r < times; r++)
        for (int f = 0; f < FRAMES; f++) query_ellipsoids(m, r % 2 ? FRAMES - 1 - f : f, all, keep, &g);
    return 1e9 * (thread_time() - begun) / (times * FRAMES);
}

static int print_ellipsoids(int32_t rings, int32_t around)
{
    ellipsoids m;
    if (make_ellipsoids(&m, rings, around)) return 0;
    const int32_t n = rings * around + 2;
    double worst = 0.0;
    const double along = time_ellipsoids(&m, 400, 0, 1), cold_ = time_ellipsoids(&m, 100, 0, 0),
                 all = time_ellipsoids(&m, 400000 / n / 10 + 2, 1, 1);
    for (int f = 0; f < FRAMES; f++) {
        fl_gap g;
        query_ellipsoids(&m, f, 0, 1, &g);
        worst = fmax(worst, fabs((double)(oracle_room(&m.q[f].a, &m.q[f].b, g.n) - (real)g.d)));
        pair_free(&m.q[f]);
    }
    printf("  %8d %10.0f %10.0f %10.0f %14.1e\n", n, along, cold_, all, worst);
    return worst < 1e-13;
}

int main(void)
{
    static const char *const title[] = {"near", "flush", "touching"};
    motion *m = calloc(PAIRS, sizeof *m);
    int ok = m != NULL;
    printf("%-36s %8s %12s %12s %6s\n", "query", "ns", "error [m]", "[rad]", "none");
    for (int s = 0; s < SCENES && ok; s++) {
        printf("%s\n", title[s]);
        for (int k = 0; k < PAIRS && ok; k++) ok = make_motion(&m[k], (enum scene)s, k) == 0;
        if (!ok) break;
        ok &= print_row("distance, cold", cold, m, 1);
        ok &= print_row("distance, warm", warm, m, 1);
        ok &= print_row("contact with mode and area, warm", contact, m, 1);
        /* libccd has no distance: for separated shapes its only answer is that they are apart. */
        ok &= print_row("libccd MPR, dilated", ccd_mpr, m, s == TOUCHING);
        ok &= print_row("libccd GJK and EPA, dilated", ccd_epa, m, s == TOUCHING);
        for (int k = 0; k < PAIRS; k++)
            for (int f = 0; f < FRAMES; f++) pair_free(&m[k].q[f]);
    }
    free(m);
    printf("large\n  %8s %10s %10s %10s %14s\n", "vertices", "warm ns", "cold ns", "all ns", "error [m]");
    ok &= print_ellipsoids(4, 4) && print_ellipsoids(10, 10) && print_ellipsoids(31, 32) &&
          print_ellipsoids(100, 100);
    printf("%d passed, %d failed\n", ok, !ok);
    return !ok;
}
