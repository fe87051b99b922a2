/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include <string.h>
#include "base/array.h"
#include "base/simd.h"
#include "patch/force_sum.h"

/* What later sums need of four places. */
typedef struct {
    fl_simd closing, e, du, curve, across[3], arm[3];
} lane;

/* Four numbers in a row of four places: rows to columns, in registers, since a wide load would wait for
 * narrow stores.
 */
#define COLUMNS(p, member, a, b, c, d)                                                                       \
    do {                                                                                                     \
        const fl_simd r0 = *(const fl_simd *)&(p)[0].member, r1 = *(const fl_simd *)&(p)[1].member;          \
        const fl_simd r2 = *(const fl_simd *)&(p)[2].member, r3 = *(const fl_simd *)&(p)[3].member;          \
        const fl_simd lo = __builtin_shufflevector(r0, r1, 0, 4, 2, 6);                                      \
        const fl_simd hi = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);                                      \
        const fl_simd lo2 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);                                     \
        const fl_simd hi2 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);                                     \
        a = __builtin_shufflevector(lo, lo2, 0, 1, 4, 5);                                                    \
        b = __builtin_shufflevector(hi, hi2, 0, 1, 4, 5);                                                    \
        c = __builtin_shufflevector(lo, lo2, 2, 3, 6, 7);                                                    \
        d = __builtin_shufflevector(hi, hi2, 2, 3, 6, 7);                                                    \
    } while (0)

_Static_assert(offsetof(fl_patch_point, ddu) == offsetof(fl_patch_point, overlap) + 24 &&
                   offsetof(fl_patch_point, unit_normal) == offsetof(fl_patch_point, n) + 24 &&
                   offsetof(fl_patch_point, p) == offsetof(fl_patch_point, unit_normal) + 24,
               "COLUMNS reads four numbers in a row");

#define CROSS(out, a, b)                                                                                     \
    do {                                                                                                     \
        out[0] = a[1] * b[2] - a[2] * b[1];                                                                  \
        out[1] = a[2] * b[0] - a[0] * b[2];                                                                  \
        out[2] = a[0] * b[1] - a[1] * b[0];                                                                  \
    } while (0)

/* How fast, or how far, places of A move into B. */
FL_SIMD_INLINE void inward(fl_simd *out, const fl_simd across[3], const fl_simd arm[3], fl_vec3 v,
                           fl_vec3 turn)
{
    const fl_simd vx = v.x + (turn.y * arm[2] - turn.z * arm[1]);
    const fl_simd vy = v.y + (turn.z * arm[0] - turn.x * arm[2]);
    const fl_simd vz = v.z + (turn.x * arm[1] - turn.y * arm[0]);
    *out = -(across[0] * vx + across[1] * vy + across[2] * vz);
}

static fl_vec3 sum3(const fl_simd a[3])
{
    return v3(fl_simd_sum(&a[0]), fl_simd_sum(&a[1]), fl_simd_sum(&a[2]));
}

static double largest(const fl_simd *a)
{
    double most = 0.0;
    for (int l = 0; l < FL_SIMD_WIDTH; l++) most = (*a)[l] > most ? (*a)[l] : most;
    return most;
}

FL_SIMD_VERSIONS static void first(const fl_patch_point *place, int32_t n, lane *t, fl_force_sum *q)
{
    const fl_vec3 at = place[0].p;
    const fl_simd zero = {0};
    fl_simd u = zero, ddu = zero, most = zero, pressed = zero, elastic = zero;
    fl_simd f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero}, mid[3] = {zero, zero, zero};
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH, t++) {
        const fl_patch_point *p = place + k;
        fl_patch_point last[FL_SIMD_WIDTH];
        if (n - k < FL_SIMD_WIDTH) { /* and places without any pull */
            for (int l = 0; l < FL_SIMD_WIDTH; l++) last[l] = k + l < n ? p[l] : (fl_patch_point){0};
            p = last;
        }
        fl_simd overlap, ux, all, curve, nx, ny, nz, *arm = t->arm, *across = t->across;
        COLUMNS(p, overlap, overlap, ux, all, curve);
        COLUMNS(p, n, nx, ny, nz, across[0]);
        COLUMNS(p, unit_normal.y, across[1], across[2], arm[0], arm[1]);
        arm[0] -= at.x, arm[1] -= at.y;
        arm[2] = (fl_simd){p[0].p.z, p[1].p.z, p[2].p.z, p[3].p.z} - at.z;
        const fl_simd pull[3] = {all * nx, all * ny, all * nz};
        const fl_simd_mask presses = ux != 0.0;
        const fl_simd du = FL_SIMD_MASKED(presses, all), bent = FL_SIMD_MASKED(presses, curve);
        fl_simd moment[3];
        CROSS(moment, arm, pull);
        for (int c = 0; c < 3; c++) f[c] += pull[c], m[c] += moment[c];
        const fl_simd e = du * (nx * across[0] + ny * across[1] + nz * across[2]);
        t->e = e, t->du = du, t->curve = bent;
        for (int c = 0; c < 3; c++) mid[c] += e * arm[c];
        u += ux;
        ddu += bent;
        pressed += du;
        elastic += e;
        most = FL_SIMD_SELECT(overlap > most, overlap, most);
    }
    q->u = fl_simd_sum(&u), q->ddu = fl_simd_sum(&ddu);
    q->du = fl_simd_sum(&pressed), q->pressure = fl_simd_sum(&elastic);
    q->gradient = (fl_wrench){sum3(f), sum3(m)};
    q->pressure_moment = sum3(mid);
    q->overlap = largest(&most);
}

FL_SIMD_VERSIONS static void move(lane *t, int32_t lanes, fl_vec3 v, fl_vec3 turn, fl_force_sum *q)
{
    fl_simd met = {0}, rate = {0};
    for (int32_t k = 0; k < lanes; k++, t++) {
        fl_simd closing;
        inward(&closing, t->across, t->arm, v, turn);
        t->closing = closing;
        met += t->du * FL_SIMD_MASKED(closing > 0.0, closing);
        rate += t->e * closing;
    }
    q->du_approach = fl_simd_sum(&met), q->pressure_rate = fl_simd_sum(&rate);
}

FL_SIMD_VERSIONS static void second(const lane *t, int32_t lanes, double chi, double still, fl_force_sum *q)
{
    const fl_simd zero = {0};
    fl_simd normal = zero, spread = zero, way[3] = {zero, zero, zero}, at[3] = {zero, zero, zero};
    fl_simd f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero};
    for (int32_t k = 0; k < lanes; k++, t++) {
        const fl_simd e = t->e, to = e * (still + chi * t->closing), p = FL_SIMD_MASKED(to > 0.0, to);
        const fl_simd more = p - e, *arm = t->arm, *across = t->across;
        const fl_simd pull[3] = {more * across[0], more * across[1], more * across[2]};
        fl_simd moment[3];
        CROSS(moment, arm, pull);
        normal += p;
        for (int c = 0; c < 3; c++) {
            way[c] += p * across[c];
            at[c] += p * arm[c];
            f[c] += pull[c];
            m[c] += moment[c];
        }
        spread += p * (arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]);
    }
    q->damped_pressure = fl_simd_sum(&normal), q->damped_spread = fl_simd_sum(&spread);
    q->direction = sum3(way), q->damped_moment = sum3(at);
    q->damping = (fl_wrench){sum3(f), sum3(m)};
}

/* The upper triangle of weight g g^T, g of n and arm x n, added. */
FL_SIMD_INLINE void square(fl_simd all[FL_PRESSURE_MATRIX], const fl_simd *weight, const fl_simd g[6])
{
    int m = 0;
    FL_SIMD_UNROLL
    for (int r = 0; r < 6; r++) {
        const fl_simd by = *weight * g[r];
        FL_SIMD_UNROLL
        for (int c = r; c < 6; c++, m++) all[m] += by * g[c];
    }
}

FL_SIMD_VERSIONS static void third(const lane *t, int32_t n, double sum[FL_PRESSURE_MATRIX])
{
    fl_simd all[FL_PRESSURE_MATRIX];
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) all[m] = (fl_simd){0};
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH, t++) {
        fl_simd g[6] = {t->across[0], t->across[1], t->across[2]};
        CROSS((g + 3), t->arm, t->across);
        square(all, &t->curve, g);
    }
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) sum[m] = fl_simd_sum(&all[m]);
}

static int32_t lanes_of(const fl_patch_points *s) { return (s->n + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH; }

/* --- areas ------------------------------------------------------------------------------------- */

enum { CORNERS = 3 }; /* places that stand for an area */

/* How an area approaches: at `mean` in its middle, by off[] more at its places, by `more` faster and slower
 * at the places of lay_along().
 */
typedef struct {
    uint32_t k; /* the first of these */
    double mean, more, off[CORNERS];
} tilt;

static double closing_of(const lane *t, uint32_t k)
{
    return t[k / FL_SIMD_WIDTH].closing[k % FL_SIMD_WIDTH];
}

static tilt tilt_of(const lane *t, uint32_t k)
{
    tilt a = {.k = k};
    double sum2 = 0.0;
    for (uint32_t c = 0; c < CORNERS; c++) a.mean += (a.off[c] = closing_of(t, k + c));
    a.mean *= 1.0 / CORNERS;
    for (int c = 0; c < CORNERS; c++) a.off[c] -= a.mean, sum2 += a.off[c] * a.off[c];
    a.more = sqrt(2.0 / CORNERS * sum2);
    return a;
}

/* The areas, to s->tilt. */
static int find_areas(fl_patch_points *s)
{
    const fl_patch_point *p = s->point, *const end = p + s->n;
    s->areas = 0;
    while (p < end) {
        if (p->group_size == CORNERS && p->u != 0.0) {
            if (fl_reserve(&s->area_motion, &s->area_cap, (int64_t)s->areas + 1, sizeof(tilt))) return -1;
            tilt *all = s->area_motion;
            all[s->areas++] = tilt_of(s->point_lanes, (uint32_t)(p - s->point));
        }
        p += p->group_size > 1 ? p->group_size : 1;
    }
    return 0;
}

static double above(double c) { return c > 0.0 ? c : 0.0; }

/* What the areas that approach in part add to `met`, beyond what their three places do. */
static double met_aside(const fl_patch_points *s)
{
    double all = 0.0;
    const tilt *a = s->area_motion;
    for (int32_t k = 0; k < s->areas; k++, a++) {
        if (fabs(a->mean) >= a->more) continue;
        double met = 0.25 * (above(a->mean + a->more) + above(a->mean - a->more)) + 0.5 * above(a->mean);
        for (int c = 0; c < CORNERS; c++) met -= above(a->mean + a->off[c]) / CORNERS;
        all += CORNERS * s->point[a->k].du * met;
    }
    return all;
}

static fl_vec3 arm_of(const lane *t, uint32_t k)
{
    const fl_simd *arm = t[k / FL_SIMD_WIDTH].arm;
    return v3(arm[0][k % FL_SIMD_WIDTH], arm[1][k % FL_SIMD_WIDTH], arm[2][k % FL_SIMD_WIDTH]);
}

/* Sum of off |arm - the middle|^2 of the three: of the four it is nothing. */
static double skew_of(const lane *t, const tilt *a)
{
    const fl_vec3 p0 = arm_of(t, a->k), p1 = v3_sub(arm_of(t, a->k + 1), p0),
                  p2 = v3_sub(arm_of(t, a->k + 2), p0), mid = v3_scale(1.0 / CORNERS, v3_add(p1, p2));
    return a->off[0] * v3_norm2(mid) + a->off[1] * v3_norm2(v3_sub(p1, mid)) +
           a->off[2] * v3_norm2(v3_sub(p2, mid));
}

/* Four places with the sum, mean and second moments of the three: the middle and, from there, forth and back
 * the way on which the area approaches the faster, and one on which it does so as in the middle.  They are
 * those of the area, whichever three stand for it.
 */
static lane lay_along(const lane *t, const tilt *a)
{
    const fl_vec3 p0 = arm_of(t, a->k), p1 = v3_sub(arm_of(t, a->k + 1), p0),
                  p2 = v3_sub(arm_of(t, a->k + 2), p0);
    const fl_vec3 mid = v3_madd(p0, 1.0 / CORNERS, v3_add(p1, p2));
    const double along = 2.0 / CORNERS / a->more, aside = along / sqrt(3.0), *off = a->off;
    const fl_vec3 w = v3_madd(v3_scale(along * off[1], p1), along * off[2], p2);
    const fl_vec3 x = v3_madd(v3_scale(aside * (off[2] - off[0]), p1), aside * (off[0] - off[1]), p2);
    const lane *own = &t[a->k / FL_SIMD_WIDTH];
    const uint32_t l = a->k % FL_SIMD_WIDTH;
    const fl_simd none = {0};
    lane four = {.closing = {a->mean + a->more, a->mean - a->more, a->mean, a->mean}};
    four.e = none + CORNERS * 0.25 * own->e[l];
    for (int c = 0; c < 3; c++) four.across[c] = none + own->across[c][l];
    four.arm[0] = (fl_simd){mid.x + w.x, mid.x - w.x, mid.x + x.x, mid.x - x.x};
    four.arm[1] = (fl_simd){mid.y + w.y, mid.y - w.y, mid.y + x.y, mid.y - x.y};
    four.arm[2] = (fl_simd){mid.z + w.z, mid.z - w.z, mid.z + x.z, mid.z - x.z};
    return four;
}

/* s->lane, or behind it a copy in which areas that would be pulled in part have their four places, those with
 * still + chi c < 0; how many, and sum of e off |arm - the middle|^2 of the others.
 */
static const lane *held_back(const fl_patch_points *s, double chi, double still, int32_t *lanes, double *skew)
{
    lane *const own = s->point_lanes, *copy = NULL;
    const int32_t n = *lanes = lanes_of(s);
    *skew = 0.0;
    const tilt *a = s->area_motion;
    for (int32_t k = 0; k < s->areas; k++, a++) {
        const uint32_t at = a->k;
        if (still + chi * (a->mean - a->more) >= 0.0)
            *skew += own[at / FL_SIMD_WIDTH].e[at % FL_SIMD_WIDTH] * skew_of(own, a);
        else if (still + chi * (a->mean + a->more) > 0.0) {
            if (!copy) copy = memcpy(own + n, own, (size_t)n * sizeof *own);
            for (uint32_t c = at; c < at + CORNERS; c++) copy[c / FL_SIMD_WIDTH].e[c % FL_SIMD_WIDTH] = 0.0;
            copy[(*lanes)++] = lay_along(own, a);
        }
    }
    return copy ? copy : own;
}

/* ----------------------------------------------------------------------------------------------- */

int fl_force_sum_elastic(fl_patch_points *s, fl_force_sum *q)
{
    *q = (fl_force_sum){0};
    if (s->n == 0) return 0;
    if (fl_reserve(&s->point_lanes, &s->point_lane_cap, 2 * lanes_of(s) + s->n / CORNERS, sizeof(lane)))
        return -1;
    first(s->point, s->n, s->point_lanes, q);
    return 0;
}

int fl_force_sum_motion(fl_patch_points *s, fl_vec3 v, fl_vec3 turn, fl_force_sum *q)
{
    if (s->n == 0) return 0;
    move(s->point_lanes, lanes_of(s), v, turn, q);
    if (find_areas(s)) return -1;
    q->du_approach += met_aside(s);
    return 0;
}

void fl_force_sum_damping(const fl_patch_points *s, double chi, double more, fl_force_sum *q)
{
    if (s->n == 0) return;
    int32_t lanes;
    double skew;
    const double still = 1.0 + chi * more;
    const lane *t = held_back(s, chi, still, &lanes, &skew);
    second(t, lanes, chi, still, q);
    q->damped_spread -= chi * skew;
}

void fl_force_sum_springs(const fl_patch_points *s, fl_spring_sums *q)
{
    double sum[FL_PRESSURE_MATRIX];
    *q = (fl_spring_sums){0};
    third(s->point_lanes, s->n, sum);
    for (int r = 0, m = 0; r < 6; r++)
        for (int c = r; c < 6; c++, m++) {
            if (c < 3) q->linear[r][c] = q->linear[c][r] = sum[m];
            else if (r < 3) q->coupling[c - 3][r] = sum[m];
            else q->angular[r - 3][c - 3] = q->angular[c - 3][r - 3] = sum[m];
        }
}

/* --- what presses ------------------------------------------------------------------------------ */

FL_SIMD_VERSIONS static void press(const lane *t, int32_t lanes, fl_pressure_moments *q)
{
    const fl_simd zero = {0};
    fl_simd all[FL_PRESSURE_MATRIX], e = zero, wide = zero, way[3] = {zero, zero, zero},
                                     turns[3] = {zero, zero, zero}, at[3] = {zero, zero, zero};
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) all[m] = zero;
    for (int32_t k = 0; k < lanes; k++) {
        fl_simd g[6] = {t[k].across[0], t[k].across[1], t[k].across[2]};
        CROSS((g + 3), t[k].arm, t[k].across);
        const fl_simd *arm = t[k].arm;
        e += t[k].e;
        wide += t[k].e * (arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]);
        for (int c = 0; c < 3; c++) {
            way[c] += t[k].e * g[c];
            turns[c] += t[k].e * g[3 + c];
            at[c] += t[k].e * arm[c];
        }
        square(all, &t[k].e, g);
    }
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) q->damping[m] = fl_simd_sum(&all[m]);
    q->pressure = fl_simd_sum(&e), q->radius = fl_simd_sum(&wide);
    q->direction = sum3(way), q->torque = sum3(turns), q->centre = sum3(at);
}

void fl_force_sum_pressure(const fl_patch_points *s, fl_pressure_moments *q)
{
    *q = (fl_pressure_moments){0};
    press(s->point_lanes, lanes_of(s), q);
    if (!(q->pressure > 0.0)) return;
    const double each = 1.0 / q->pressure;
    q->centre = v3_scale(each, q->centre);
    const double wide2 = each * q->radius - v3_norm2(q->centre);
    q->radius = wide2 > 0.0 ? sqrt(wide2) : 0.0;
}

double fl_force_sum_approach_speed(const fl_patch_points *s, int32_t k)
{
    return closing_of(s->point_lanes, (uint32_t)k);
}
