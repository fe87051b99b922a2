/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Distance, direction and penetration depth of pairs of convex cores against brute force in long double, by
 * distance; and libccd on the same pairs, whose own failures are counted. */
#include <ccd/ccd.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "narrow/gjk_double.h"
#include "narrow/gjk.h"
#include "support/convex_pairs.h"
#include "support/oracle.h"
#include "support/verify.h"

enum { DECADES = 13, SUPPORTS_MAX = 4000 };

/* Beyond this part of the size the sign of the distance is certain, and a wrong answer about meeting is an
 * error. */
#define CLEAR 1e-12
/* A depth counts as wrong beyond this relative error. */
#define WRONG 0.05

typedef struct {
    long n, meet, astray;
    double d, normal;                    /* worst errors, of the size (or distance) and in rad */
    double of_d[DECADES], of_n[DECADES]; /* the same, by distance over size: 1e-9 .. 1e4 */
    double depth;                        /* worst, of the size */
    long ccd_meet, mpr_none, mpr_wrong, epa_none, epa_wrong, capped;
} tally;

/* --- libccd ------------------------------------------------------------------------------------------- */

typedef struct {
    fl_core c;
    fl_vec3 o; /* the working origin */
    double scale;
    int *left; /* support calls that are still allowed */
} ccd_body;

static void ccd_support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const ccd_body *s = obj;
    double low;
    if (--*s->left <
        0) { /* its loops have no bound of their own; a support at the origin ends each of them */
        ccdVec3Set(out, 0, 0, 0);
        return;
    }
    const int32_t i = fl_core_support(s->c, v3(-dir->v[0], -dir->v[1], -dir->v[2]), &low);
    const fl_vec3 p = v3_scale(s->scale, v3_sub(s->c.v[i], s->o));
    ccdVec3Set(out, p.x, p.y, p.z);
}

static void ccd_centre(const void *obj, ccd_vec3_t *out)
{
    const ccd_body *s = obj;
    fl_vec3 p = v3(0, 0, 0);
    for (int32_t i = 0; i < s->c.n; i++) p = v3_madd(p, s->scale / s->c.n, v3_sub(s->c.v[i], s->o));
    ccdVec3Set(out, p.x, p.y, p.z);
}

/* Used at its best: about a nearby origin, at unit size. */
static void compare_libccd(const pair_case *q, const oracle_gap *o, tally *t)
{
    int left = SUPPORTS_MAX;
    const fl_core a = fl_solid_core(&q->a), b = fl_solid_core(&q->b);
    const ccd_body x = {a, a.v[0], 1.0 / q->size, &left}, y = {b, a.v[0], 1.0 / q->size, &left};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.center1 = ccd.center2 = ccd_centre;
    ccd.max_iterations = 200;
    ccd.mpr_tolerance = ccd.epa_tolerance = (ccd_real_t)1e-8;
    t->ccd_meet += ccdGJKIntersect(&x, &y, &ccd) != (o->d < 0.0L);
    t->capped += left < 0;
    if (!(o->d < 0.0L)) return;
    for (int epa = 0; epa < 2; epa++) {
        ccd_real_t depth = 0;
        ccd_vec3_t dir, at;
        left = SUPPORTS_MAX;
        ccdVec3Set(&dir, 0, 0, 0);
        const int rc = epa ? ccdGJKPenetration(&x, &y, &ccd, &depth, &dir, &at)
                           : ccdMPRPenetration(&x, &y, &ccd, &depth, &dir, &at);
        const double angle_to_oracle = fabs((double)depth * q->size + (double)o->d);
        t->capped += left < 0;
        *(epa ? &t->epa_none : &t->mpr_none) += rc != 0;
        *(epa ? &t->epa_wrong : &t->mpr_wrong) += rc == 0 && !(angle_to_oracle <= WRONG * (double)-o->d);
    }
}

/* --- lib/narrow --------------------------------------------------------------------------------------- */

static double angle_to_oracle(const oracle_gap *o, fl_vec3 n)
{
    const real m[3] = {o->n[1] * (real)n.z - o->n[2] * (real)n.y, o->n[2] * (real)n.x - o->n[0] * (real)n.z,
                       o->n[0] * (real)n.y - o->n[1] * (real)n.x};
    return (double)sqrtl(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
}

static void compare_pair(const pair_case *q, tally *t)
{
    oracle_gap o;
    fl_gap g;
    const double far = 8.0 * 2.220446049250313e-16 * v3_norm(q->a.v[0]); /* the grid of the coordinates */
    oracle_distance(&q->a, &q->b, &o);
    fl_gjk(fl_solid_core(&q->a), fl_solid_core(&q->b), NULL, &g);
    t->n++;
    if (fabsl(o.d) > (real)CLEAR * (real)q->size) {
        t->astray += g.overlap != (o.d < 0.0L);
        t->meet += o.d < 0.0L;
        compare_libccd(q, &o, t);
    }
    if (g.overlap) {
        fl_penetration deep;
        fl_penetration_find(&q->a, &q->b, NULL, &deep);
        t->depth = fmax(t->depth, ((double)fabsl(o.d + (real)deep.depth) - far) / q->size);
        return;
    }
    const double scale = fmax(q->size, g.d), d = (double)fabsl(o.d - (real)g.d) / scale;
    t->d = fmax(t->d, d);
    int k = (int)floor(log10(g.d / q->size)) + 9;
    if (k < 0) return;
    if (k >= DECADES) k = DECADES - 1;
    double n = angle_to_oracle(&o, g.n);
    /* For distances that long doubles cannot tell apart, the features are the oracle's own choice. */
    if (n > 1e-14) n = fmin(n, (double)oracle_off(&q->a, &q->b, &o, g.n));
    t->of_d[k] = fmax(t->of_d[k], d);
    t->of_n[k] = fmax(t->of_n[k], n);
    t->normal = fmax(t->normal, n);
}

static void table(const char *name, enum pair_kind kind, long n)
{
    tally t = {0};
    char what[80];
    for (long k = 0; k < n; k++) {
        pair_case q;
        if (pair_make(&q, 2026, k, kind)) {
            verify_true("G1", "a pair can be made", 0);
            return;
        }
        compare_pair(&q, &t);
        pair_free(&q);
    }
    snprintf(what, sizeof what, "%s: pairs wrong about meeting", name);
    verify_row("G1", what, (double)t.astray, 0.0, 0.0, VERIFY_ABS);
    snprintf(what, sizeof what, "%s: error of d, of the size", name);
    verify_below("G2", what, t.d, 1e-13);
    snprintf(what, sizeof what, "%s: error of n [rad]", name);
    verify_below("G3", what, t.normal, 1e-12);
    snprintf(what, sizeof what, "%s: error of the depth, of the size", name);
    verify_below("G4", what, t.depth, 1e-13);
    verify_note(
        "  %s: %ld pairs, %ld meet; libccd on the same: wrong about meeting %ld; depths none and wrong "
        "by 5 %%: MPR %ld and %ld, EPA %ld and %ld; stopped at %d supports %ld",
        name, t.n, t.meet, t.ccd_meet, t.mpr_none, t.mpr_wrong, t.epa_none, t.epa_wrong, SUPPORTS_MAX,
        t.capped);
    for (int k = 0; k < DECADES && kind != PAIR_DEEP; k++)
        if (t.of_d[k] > 0.0 || t.of_n[k] > 0.0)
            verify_note("    gap 1e%+03d to 1e%+03d sizes: d to %.1e, n to %.1e rad", k - 9, k - 8, t.of_d[k],
                        t.of_n[k]);
}

int main(void)
{
    const long n = verify_quick() ? 2000 : 20000;
    verify_begin("pairs of cores: distance, direction, depth; libccd for comparison");
    table("ordinary", PAIR_ORDINARY, n);
    table("hostile", PAIR_HOSTILE, n);
    table("deep", PAIR_DEEP, n / 2);
    return verify_end();
}
