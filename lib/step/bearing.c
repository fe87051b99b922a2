/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include <string.h>
#include "base/mem.h"
#include "base/wide.h"
#include "step/bearing.h"

/* What later sums need of four places. */
typedef struct {
    fl_wide closing, e, du, curve, across[3], arm[3];
} lane;

/* Four numbers in a row of four places: rows to columns, in registers, since a wide load would wait for
 * narrow stores.
 */
#define COLUMNS(p, member, a, b, c, d)                                                                       \
    do {                                                                                                     \
        const fl_wide r0 = *(const fl_wide *)&(p)[0].member, r1 = *(const fl_wide *)&(p)[1].member;          \
        const fl_wide r2 = *(const fl_wide *)&(p)[2].member, r3 = *(const fl_wide *)&(p)[3].member;          \
        const fl_wide lo = __builtin_shufflevector(r0, r1, 0, 4, 2, 6);                                      \
        const fl_wide hi = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);                                      \
        const fl_wide lo2 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);                                     \
        const fl_wide hi2 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);                                     \
        a = __builtin_shufflevector(lo, lo2, 0, 1, 4, 5);                                                    \
        b = __builtin_shufflevector(hi, hi2, 0, 1, 4, 5);                                                    \
        c = __builtin_shufflevector(lo, lo2, 2, 3, 6, 7);                                                    \
        d = __builtin_shufflevector(hi, hi2, 2, 3, 6, 7);                                                    \
    } while (0)

_Static_assert(offsetof(fl_place, ddu) == offsetof(fl_place, overlap) + 24 &&
                   offsetof(fl_place, across) == offsetof(fl_place, n) + 24 &&
                   offsetof(fl_place, p) == offsetof(fl_place, across) + 24,
               "COLUMNS reads four numbers in a row");

#define CROSS(out, a, b)                                                                                     \
    do {                                                                                                     \
        out[0] = a[1] * b[2] - a[2] * b[1];                                                                  \
        out[1] = a[2] * b[0] - a[0] * b[2];                                                                  \
        out[2] = a[0] * b[1] - a[1] * b[0];                                                                  \
    } while (0)

/* How fast, or how far, places of A move into B. */
FL_WIDE_PART void inward(fl_wide *out, const fl_wide across[3], const fl_wide arm[3], fl_vec3 v, fl_vec3 turn)
{
    const fl_wide vx = v.x + (turn.y * arm[2] - turn.z * arm[1]);
    const fl_wide vy = v.y + (turn.z * arm[0] - turn.x * arm[2]);
    const fl_wide vz = v.z + (turn.x * arm[1] - turn.y * arm[0]);
    *out = -(across[0] * vx + across[1] * vy + across[2] * vz);
}

static fl_vec3 sum3(const fl_wide a[3])
{
    return v3(fl_wide_sum(&a[0]), fl_wide_sum(&a[1]), fl_wide_sum(&a[2]));
}

static double largest(const fl_wide *a)
{
    double most = 0.0;
    for (int l = 0; l < FL_LANES; l++) most = (*a)[l] > most ? (*a)[l] : most;
    return most;
}

FL_WIDE_VERSIONS static void first(const fl_place *place, int32_t n, lane *t, fl_bearing *q)
{
    const fl_vec3 at = place[0].p;
    const fl_wide zero = {0};
    fl_wide u = zero, ddu = zero, most = zero, pressed = zero, elastic = zero;
    fl_wide f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero}, mid[3] = {zero, zero, zero};
    for (int32_t k = 0; k < n; k += FL_LANES, t++) {
        const fl_place *p = place + k;
        fl_place last[FL_LANES];
        if (n - k < FL_LANES) { /* and places without any pull */
            for (int l = 0; l < FL_LANES; l++) last[l] = k + l < n ? p[l] : (fl_place){0};
            p = last;
        }
        fl_wide overlap, ux, all, curve, nx, ny, nz, *arm = t->arm, *across = t->across;
        COLUMNS(p, overlap, overlap, ux, all, curve);
        COLUMNS(p, n, nx, ny, nz, across[0]);
        COLUMNS(p, across.y, across[1], across[2], arm[0], arm[1]);
        arm[0] -= at.x, arm[1] -= at.y;
        arm[2] = (fl_wide){p[0].p.z, p[1].p.z, p[2].p.z, p[3].p.z} - at.z;
        const fl_wide pull[3] = {all * nx, all * ny, all * nz};
        const fl_wide_mask presses = ux != 0.0;
        const fl_wide du = FL_WIDE_WHERE(presses, all), bent = FL_WIDE_WHERE(presses, curve);
        fl_wide moment[3];
        CROSS(moment, arm, pull);
        for (int c = 0; c < 3; c++) f[c] += pull[c], m[c] += moment[c];
        const fl_wide e = du * (nx * across[0] + ny * across[1] + nz * across[2]);
        t->e = e, t->du = du, t->curve = bent;
        for (int c = 0; c < 3; c++) mid[c] += e * arm[c];
        u += ux;
        ddu += bent;
        pressed += du;
        elastic += e;
        most = FL_WIDE_CHOOSE(overlap > most, overlap, most);
    }
    q->u = fl_wide_sum(&u), q->ddu = fl_wide_sum(&ddu);
    q->pressed = fl_wide_sum(&pressed), q->elastic = fl_wide_sum(&elastic);
    q->gradient = (fl_wrench){sum3(f), sum3(m)};
    q->middle = sum3(mid);
    q->overlap = largest(&most);
}

FL_WIDE_VERSIONS static void move(lane *t, int32_t lanes, fl_vec3 v, fl_vec3 turn, fl_bearing *q)
{
    fl_wide met = {0}, rate = {0};
    for (int32_t k = 0; k < lanes; k++, t++) {
        fl_wide closing;
        inward(&closing, t->across, t->arm, v, turn);
        t->closing = closing;
        met += t->du * FL_WIDE_WHERE(closing > 0.0, closing);
        rate += t->e * closing;
    }
    q->met = fl_wide_sum(&met), q->rate = fl_wide_sum(&rate);
}

FL_WIDE_VERSIONS static void second(const lane *t, int32_t lanes, double chi, double still, fl_bearing *q)
{
    const fl_wide zero = {0};
    fl_wide normal = zero, spread = zero, way[3] = {zero, zero, zero}, at[3] = {zero, zero, zero};
    fl_wide f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero};
    for (int32_t k = 0; k < lanes; k++, t++) {
        const fl_wide e = t->e, to = e * (still + chi * t->closing), p = FL_WIDE_WHERE(to > 0.0, to);
        const fl_wide more = p - e, *arm = t->arm, *across = t->across;
        const fl_wide pull[3] = {more * across[0], more * across[1], more * across[2]};
        fl_wide moment[3];
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
    q->normal = fl_wide_sum(&normal), q->spread = fl_wide_sum(&spread);
    q->direction = sum3(way), q->moment = sum3(at);
    q->damping = (fl_wrench){sum3(f), sum3(m)};
}

/* The upper triangle of weight g g^T, g of n and arm x n, added. */
FL_WIDE_PART void square(fl_wide all[FL_PRESSING], const fl_wide *weight, const fl_wide g[6])
{
    int m = 0;
    FL_WIDE_UNROLL
    for (int r = 0; r < 6; r++) {
        const fl_wide by = *weight * g[r];
        FL_WIDE_UNROLL
        for (int c = r; c < 6; c++, m++) all[m] += by * g[c];
    }
}

FL_WIDE_VERSIONS static void third(const lane *t, int32_t n, double sum[FL_PRESSING])
{
    fl_wide all[FL_PRESSING];
    for (int m = 0; m < FL_PRESSING; m++) all[m] = (fl_wide){0};
    for (int32_t k = 0; k < n; k += FL_LANES, t++) {
        fl_wide g[6] = {t->across[0], t->across[1], t->across[2]};
        CROSS((g + 3), t->arm, t->across);
        square(all, &t->curve, g);
    }
    for (int m = 0; m < FL_PRESSING; m++) sum[m] = fl_wide_sum(&all[m]);
}

static int32_t lanes_of(const fl_places *s) { return (s->n + FL_LANES - 1) / FL_LANES; }

/* --- areas ------------------------------------------------------------------------------------- */

enum { CORNERS = 3 }; /* places that stand for an area */

/* How an area approaches: at `mean` in its middle, by off[] more at its places, by `more` faster and slower
 * at the places of lay_along().
 */
typedef struct {
    uint32_t k; /* the first of these */
    double mean, more, off[CORNERS];
} tilt;

static double closing_of(const lane *t, uint32_t k) { return t[k / FL_LANES].closing[k % FL_LANES]; }

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
static int find_areas(fl_places *s)
{
    const fl_place *p = s->place, *const end = p + s->n;
    s->tilts = 0;
    while (p < end) {
        if (p->stands == CORNERS && p->u != 0.0) {
            if (fl_room(&s->tilt, &s->tilt_cap, (int64_t)s->tilts + 1, sizeof(tilt))) return -1;
            tilt *all = s->tilt;
            all[s->tilts++] = tilt_of(s->lane, (uint32_t)(p - s->place));
        }
        p += p->stands > 1 ? p->stands : 1;
    }
    return 0;
}

static double above(double c) { return c > 0.0 ? c : 0.0; }

/* What the areas that approach in part add to `met`, beyond what their three places do. */
static double met_aside(const fl_places *s)
{
    double all = 0.0;
    const tilt *a = s->tilt;
    for (int32_t k = 0; k < s->tilts; k++, a++) {
        if (fabs(a->mean) >= a->more) continue;
        double met = 0.25 * (above(a->mean + a->more) + above(a->mean - a->more)) + 0.5 * above(a->mean);
        for (int c = 0; c < CORNERS; c++) met -= above(a->mean + a->off[c]) / CORNERS;
        all += CORNERS * s->place[a->k].du * met;
    }
    return all;
}

static fl_vec3 arm_of(const lane *t, uint32_t k)
{
    const fl_wide *arm = t[k / FL_LANES].arm;
    return v3(arm[0][k % FL_LANES], arm[1][k % FL_LANES], arm[2][k % FL_LANES]);
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
    const lane *own = &t[a->k / FL_LANES];
    const uint32_t l = a->k % FL_LANES;
    const fl_wide none = {0};
    lane four = {.closing = {a->mean + a->more, a->mean - a->more, a->mean, a->mean}};
    four.e = none + CORNERS * 0.25 * own->e[l];
    for (int c = 0; c < 3; c++) four.across[c] = none + own->across[c][l];
    four.arm[0] = (fl_wide){mid.x + w.x, mid.x - w.x, mid.x + x.x, mid.x - x.x};
    four.arm[1] = (fl_wide){mid.y + w.y, mid.y - w.y, mid.y + x.y, mid.y - x.y};
    four.arm[2] = (fl_wide){mid.z + w.z, mid.z - w.z, mid.z + x.z, mid.z - x.z};
    return four;
}

/* s->lane, or behind it a copy in which areas that would be pulled in part have their four places, those with
 * still + chi c < 0; how many, and sum of e off |arm - the middle|^2 of the others.
 */
static const lane *held_back(const fl_places *s, double chi, double still, int32_t *lanes, double *skew)
{
    lane *const own = s->lane, *copy = NULL;
    const int32_t n = *lanes = lanes_of(s);
    *skew = 0.0;
    const tilt *a = s->tilt;
    for (int32_t k = 0; k < s->tilts; k++, a++) {
        const uint32_t at = a->k;
        if (still + chi * (a->mean - a->more) >= 0.0)
            *skew += own[at / FL_LANES].e[at % FL_LANES] * skew_of(own, a);
        else if (still + chi * (a->mean + a->more) > 0.0) {
            if (!copy) copy = memcpy(own + n, own, (size_t)n * sizeof *own);
            for (uint32_t c = at; c < at + CORNERS; c++) copy[c / FL_LANES].e[c % FL_LANES] = 0.0;
            copy[(*lanes)++] = lay_along(own, a);
        }
    }
    return copy ? copy : own;
}

/* ----------------------------------------------------------------------------------------------- */

int fl_bearing_sum(fl_places *s, fl_bearing *q)
{
    *q = (fl_bearing){0};
    if (s->n == 0) return 0;
    if (fl_room(&s->lane, &s->lane_cap, 2 * lanes_of(s) + s->n / CORNERS, sizeof(lane))) return -1;
    first(s->place, s->n, s->lane, q);
    return 0;
}

int fl_bearing_move(fl_places *s, fl_vec3 v, fl_vec3 turn, fl_bearing *q)
{
    if (s->n == 0) return 0;
    move(s->lane, lanes_of(s), v, turn, q);
    if (find_areas(s)) return -1;
    q->met += met_aside(s);
    return 0;
}

void fl_bearing_damp(const fl_places *s, double chi, double more, fl_bearing *q)
{
    if (s->n == 0) return;
    int32_t lanes;
    double skew;
    const double still = 1.0 + chi * more;
    const lane *t = held_back(s, chi, still, &lanes, &skew);
    second(t, lanes, chi, still, q);
    q->spread -= chi * skew;
}

void fl_bearing_springs(const fl_places *s, fl_springs *q)
{
    double sum[FL_PRESSING];
    *q = (fl_springs){0};
    third(s->lane, s->n, sum);
    for (int r = 0, m = 0; r < 6; r++)
        for (int c = r; c < 6; c++, m++) {
            if (c < 3) q->across[r][c] = q->across[c][r] = sum[m];
            else if (r < 3) q->mixed[c - 3][r] = sum[m];
            else q->turning[r - 3][c - 3] = q->turning[c - 3][r - 3] = sum[m];
        }
}

/* --- what presses ------------------------------------------------------------------------------ */

FL_WIDE_VERSIONS static void press(const lane *t, int32_t lanes, fl_pressing *q)
{
    const fl_wide zero = {0};
    fl_wide all[FL_PRESSING], e = zero, wide = zero, way[3] = {zero, zero, zero},
                              turns[3] = {zero, zero, zero}, at[3] = {zero, zero, zero};
    for (int m = 0; m < FL_PRESSING; m++) all[m] = zero;
    for (int32_t k = 0; k < lanes; k++) {
        fl_wide g[6] = {t[k].across[0], t[k].across[1], t[k].across[2]};
        CROSS((g + 3), t[k].arm, t[k].across);
        const fl_wide *arm = t[k].arm;
        e += t[k].e;
        wide += t[k].e * (arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]);
        for (int c = 0; c < 3; c++) {
            way[c] += t[k].e * g[c];
            turns[c] += t[k].e * g[3 + c];
            at[c] += t[k].e * arm[c];
        }
        square(all, &t[k].e, g);
    }
    for (int m = 0; m < FL_PRESSING; m++) q->damping[m] = fl_wide_sum(&all[m]);
    q->elastic = fl_wide_sum(&e), q->wide = fl_wide_sum(&wide);
    q->direction = sum3(way), q->turning = sum3(turns), q->mean = sum3(at);
}

void fl_bearing_pressing(const fl_places *s, fl_pressing *q)
{
    *q = (fl_pressing){0};
    press(s->lane, lanes_of(s), q);
    if (!(q->elastic > 0.0)) return;
    const double each = 1.0 / q->elastic;
    q->mean = v3_scale(each, q->mean);
    const double wide2 = each * q->wide - v3_norm2(q->mean);
    q->wide = wide2 > 0.0 ? sqrt(wide2) : 0.0;
}

double fl_bearing_closing(const fl_places *s, int32_t k) { return closing_of(s->lane, (uint32_t)k); }
