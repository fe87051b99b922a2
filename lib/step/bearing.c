/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
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

FL_WIDE_VERSIONS static void first(const fl_place *place, int32_t n, fl_vec3 v, fl_vec3 turn, lane *t,
                                   fl_bearing *q)
{
    const fl_vec3 at = place[0].p;
    const fl_wide zero = {0};
    fl_wide u = zero, ddu = zero, most = zero, pressed = zero, met = zero, elastic = zero;
    fl_wide f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero};
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
        fl_wide closing;
        inward(&closing, across, arm, v, turn);
        const fl_wide e = du * (nx * across[0] + ny * across[1] + nz * across[2]);
        t->closing = closing, t->e = e, t->du = du, t->curve = bent;
        u += ux;
        ddu += bent;
        pressed += du;
        met += du * FL_WIDE_WHERE(closing > 0.0, closing);
        elastic += e;
        most = FL_WIDE_CHOOSE(overlap > most, overlap, most);
    }
    q->u = fl_wide_sum(&u), q->ddu = fl_wide_sum(&ddu);
    q->pressed = fl_wide_sum(&pressed), q->met = fl_wide_sum(&met), q->elastic = fl_wide_sum(&elastic);
    q->gradient = (fl_wrench){sum3(f), sum3(m)};
    q->overlap = 0.0;
    for (int l = 0; l < FL_LANES; l++) q->overlap = most[l] > q->overlap ? most[l] : q->overlap;
}

FL_WIDE_VERSIONS static void second(const lane *t, int32_t lanes, double chi, fl_bearing *q)
{
    const fl_wide zero = {0};
    fl_wide normal = zero, spread = zero, way[3] = {zero, zero, zero}, at[3] = {zero, zero, zero};
    fl_wide f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero};
    for (int32_t k = 0; k < lanes; k++, t++) {
        const fl_wide e = t->e, to = e * (1.0 + chi * t->closing), p = FL_WIDE_WHERE(to > 0.0, to);
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

/* Numbers of the upper triangle of six rows, n and arm x n. */
enum { SPRINGS = 21 };

FL_WIDE_VERSIONS static void third(const lane *t, int32_t n, double sum[SPRINGS])
{
    fl_wide all[SPRINGS];
    for (int m = 0; m < SPRINGS; m++) all[m] = (fl_wide){0};
    for (int32_t k = 0; k < n; k += FL_LANES, t++) {
        fl_wide g[6] = {t->across[0], t->across[1], t->across[2]};
        CROSS((g + 3), t->arm, t->across);
        int m = 0;
        FL_WIDE_UNROLL
        for (int r = 0; r < 6; r++) {
            const fl_wide kg = t->curve * g[r];
            FL_WIDE_UNROLL
            for (int c = r; c < 6; c++, m++) all[m] += kg * g[c];
        }
    }
    for (int m = 0; m < SPRINGS; m++) sum[m] = fl_wide_sum(&all[m]);
}

int fl_bearing_sum(fl_places *s, fl_vec3 v, fl_vec3 turn, fl_bearing *q)
{
    *q = (fl_bearing){0};
    if (s->n == 0) return 0;
    if (fl_room(&s->lane, &s->lane_cap, s->n / FL_LANES + 1, sizeof(lane))) return -1;
    first(s->place, s->n, v, turn, s->lane, q);
    return 0;
}

void fl_bearing_damp(const fl_places *s, double chi, fl_bearing *q)
{
    if (s->n > 0) second(s->lane, (s->n + FL_LANES - 1) / FL_LANES, chi, q);
}

void fl_bearing_springs(const fl_places *s, fl_springs *q)
{
    double sum[SPRINGS];
    *q = (fl_springs){0};
    third(s->lane, s->n, sum);
    for (int r = 0, m = 0; r < 6; r++)
        for (int c = r; c < 6; c++, m++) {
            if (c < 3) q->across[r][c] = q->across[c][r] = sum[m];
            else if (r < 3) q->mixed[c - 3][r] = sum[m];
            else q->turning[r - 3][c - 3] = q->turning[c - 3][r - 3] = sum[m];
        }
}

/* --- what is kept of a look ------------------------------------------------------------------- */

/* Of four places; rate: a quarter of ddu/du, for pressures that grow as s^3 to s^4. */
typedef struct {
    fl_wide e, du, rate, across[3], arm[3];
} pad;

/* The sums over the lanes of four numbers. */
FL_WIDE_PART void fold(double out[4], const fl_wide *a, const fl_wide *b, const fl_wide *c, const fl_wide *d)
{
    fl_wide r[4] = {*a, *b, *c, *d};
    fl_wide_transpose(r);
    FL_FOUR_INTO(out) = (r[0] + r[1]) + (r[2] + r[3]);
}

FL_WIDE_VERSIONS static void recall(const pad *p, int32_t n, fl_vec3 way, fl_vec3 turned, fl_vec3 v,
                                    fl_vec3 turn, double chi, fl_bearing *q, fl_vec3 *at)
{
    const fl_wide zero = {0};
    fl_wide pressed = zero, met = zero, elastic = zero, normal = zero, spread = zero;
    fl_wide all[3] = {zero, zero, zero}, moment[3] = {zero, zero, zero}, still[3] = {zero, zero, zero};
    fl_wide f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero};
    for (int32_t k = 0; k < n; k++, p++) {
        const fl_wide ax = p->across[0], ay = p->across[1], az = p->across[2];
        const fl_wide x = p->arm[0], y = p->arm[1], z = p->arm[2];
        const fl_wide tx = y * az - z * ay, ty = z * ax - x * az, tz = x * ay - y * ax; /* arm x across */
        const fl_wide in =
            (ax * way.x + ay * way.y + az * way.z) + (tx * turned.x + ty * turned.y + tz * turned.z);
        const fl_wide closing =
            -((ax * v.x + ay * v.y + az * v.z) + (tx * turn.x + ty * turn.y + tz * turn.z));
        const fl_wide more = 1.0 - p->rate * in, rest = FL_WIDE_WHERE(more > 0.0, more), two = rest * rest;
        const fl_wide grown = two * two, du = grown * p->du, e = grown * p->e;
        const fl_wide to = e * (1.0 + chi * closing), press = FL_WIDE_WHERE(to > 0.0, to), add = press - e;
        pressed += du;
        met += du * FL_WIDE_WHERE(closing > 0.0, closing);
        elastic += e;
        normal += press;
        spread += press * (x * x + y * y + z * z);
        all[0] += press * ax, all[1] += press * ay, all[2] += press * az;
        moment[0] += press * x, moment[1] += press * y, moment[2] += press * z;
        still[0] += e * x, still[1] += e * y, still[2] += e * z;
        f[0] += add * ax, f[1] += add * ay, f[2] += add * az;
        m[0] += add * tx, m[1] += add * ty, m[2] += add * tz;
    }
    double s[5][4];
    fold(s[0], &pressed, &met, &elastic, &normal);
    fold(s[1], &all[0], &all[1], &all[2], &spread);
    fold(s[2], &moment[0], &moment[1], &moment[2], &zero);
    fold(s[3], &f[0], &f[1], &f[2], &m[0]);
    fold(s[4], &still[0], &still[1], &still[2], &m[1]);
    double last[4];
    fold(last, &m[2], &zero, &zero, &zero);
    *q = (fl_bearing){.pressed = s[0][0],
                      .met = s[0][1],
                      .elastic = s[0][2],
                      .normal = s[0][3],
                      .direction = v3(s[1][0], s[1][1], s[1][2]),
                      .spread = s[1][3],
                      .moment = v3(s[2][0], s[2][1], s[2][2]),
                      .damping = {v3(s[3][0], s[3][1], s[3][2]), v3(s[3][3], s[4][3], last[0])}};
    *at = v3(s[4][0], s[4][1], s[4][2]);
}

FL_WIDE_VERSIONS static void keep(const lane *t, int32_t lanes, pad *out)
{
    const fl_wide zero = {0}, one = 1.0 + zero;
    for (int32_t k = 0; k < lanes; k++, t++, out++) {
        const fl_wide_mask presses = t->du > 0.0;
        out->e = t->e, out->du = t->du;
        out->rate = FL_WIDE_WHERE(presses, 0.25 * t->curve / FL_WIDE_CHOOSE(presses, t->du, one));
        for (int c = 0; c < 3; c++) out->across[c] = t->across[c], out->arm[c] = t->arm[c];
    }
}

int fl_bearing_keep(const fl_places *s, fl_pads *pads)
{
    pads->n = (s->n + FL_LANES - 1) / FL_LANES;
    if (fl_room(&pads->pad, &pads->cap, pads->n, sizeof(pad))) return -1;
    keep(s->lane, pads->n, pads->pad);
    return 0;
}

void fl_bearing_recall(const fl_pads *pads, fl_vec3 way, fl_vec3 turned, fl_vec3 v, fl_vec3 turn, double chi,
                       fl_bearing *q, fl_vec3 *at)
{
    recall(pads->pad, pads->n, way, turned, v, turn, chi, q, at);
}

double fl_pads_bytes(const fl_pads *pads) { return (double)pads->cap * (double)sizeof(pad); }

double fl_bearing_closing(const fl_places *s, int32_t k)
{
    const lane *t = s->lane;
    return t[k / FL_LANES].closing[k % FL_LANES];
}
