/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_lanes.h"
#include <math.h>
#include <stddef.h>
#include "geom/simd3.h"

_Static_assert(sizeof(fl_vec3) == 3 * sizeof(double) && sizeof(fl_quat) == 4 * sizeof(double),
               "loads of four doubles");
_Static_assert(offsetof(fl_member_ball, fixed) == 18 * sizeof(double) &&
                   sizeof(fl_member_ball) == 19 * sizeof(double),
               "x0, and four loads of four doubles");
_Static_assert(sizeof(fl_member_force) == 9 * sizeof(double), "two stores of four doubles and one");

void fl_member_beams_set(fl_member_beams *b, int lane, const fl_member_contact *e, int32_t k)
{
    b->e0[0][lane] = e->e0.w, b->e0[1][lane] = e->e0.x, b->e0[2][lane] = e->e0.y, b->e0[3][lane] = e->e0.z;
    b->length[lane] = e->length;
    b->axial[lane] = e->axial;
    for (int n = 0; n < 2; n++) b->shear[n][lane] = e->shear[n];
    for (int n = 0; n < 3; n++) b->turn[n][lane] = e->turn[n];
    b->i[lane] = e->i, b->j[lane] = e->j, b->contact[lane] = k;
}

/* --- numbers in lanes, in the order of their scalar twins ---------------------------------------- */

typedef struct {
    fl_simd w, x, y, z;
} quat4;

#define ADD(a, b) ((fl_simd3){(a).x + (b).x, (a).y + (b).y, (a).z + (b).z})
#define CROSS(a, b)                                                                                          \
    ((fl_simd3){(a).y * (b).z - (a).z * (b).y, (a).z * (b).x - (a).x * (b).z, (a).x * (b).y - (a).y * (b).x})
#define Q_MUL(a, b)                                                                                          \
    ((quat4){(a).w * (b).w - (a).x * (b).x - (a).y * (b).y - (a).z * (b).z,                                  \
             (a).w * (b).x + (a).x * (b).w + (a).y * (b).z - (a).z * (b).y,                                  \
             (a).w * (b).y - (a).x * (b).z + (a).y * (b).w + (a).z * (b).x,                                  \
             (a).w * (b).z + (a).x * (b).y - (a).y * (b).x + (a).z * (b).w})

FL_SIMD_INLINE void square_roots(fl_simd *x)
{
    double a[FL_SIMD_WIDTH];
    FL_SIMD_STORE(a) = *x;
#pragma omp simd
    for (int l = 0; l < FL_SIMD_WIDTH; l++) a[l] = sqrt(a[l]);
    *x = FL_SIMD_LOAD(a);
}

/* fl_member_arcsine() */
FL_SIMD_INLINE void arcsines(const fl_simd *s2, fl_simd *k)
{
    const fl_simd x = *s2;
    const fl_simd_mask large = x > 0.0125;
    *k = 1.0 / 6 +
         x * (3.0 / 40 +
              x * (5.0 / 112 + x * (35.0 / 1152 +
                                    x * (63.0 / 2816 + x * (231.0 / 13312 +
                                                            x * (143.0 / 10240 + x * (6435.0 / 557056)))))));
    for (int l = 0; l < FL_SIMD_WIDTH && fl_simd_any(&large); l++) (*k)[l] = fl_member_arcsine(x[l]);
}

/* --- contacts ------------------------------------------------------------------------------------ */

/* Vectors from balls i to balls j, and their rotations. */
FL_SIMD_INLINE void load_ends(const fl_member_beams *b, const fl_member_ball *ball, fl_simd3 *dx, quat4 *qi,
                              quat4 *qj)
{
    fl_simd d[FL_SIMD_WIDTH], p[FL_SIMD_WIDTH], q[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) {
        const fl_member_ball *i = &ball[b->i[l]], *j = &ball[b->j[l]];
        d[l] = (FL_SIMD_LOAD(&j->x0) + FL_SIMD_LOAD(&j->d)) - (FL_SIMD_LOAD(&i->x0) + FL_SIMD_LOAD(&i->d));
        p[l] = FL_SIMD_LOAD(&i->q), q[l] = FL_SIMD_LOAD(&j->q);
    }
    fl_simd_transpose(d);
    fl_simd_transpose(p);
    fl_simd_transpose(q);
    *dx = (fl_simd3){d[0], d[1], d[2]};
    *qi = (quat4){p[0], p[1], p[2], p[3]};
    *qj = (quat4){q[0], q[1], q[2], q[3]};
}

FL_SIMD_INLINE void store_forces(const int32_t *contact, fl_member_force *force, const fl_simd3 *f,
                                 const fl_simd3 *mi, const fl_simd3 *mj)
{
    fl_simd a[FL_SIMD_WIDTH] = {f->x, f->y, f->z, mi->x}, b[FL_SIMD_WIDTH] = {mi->y, mi->z, mj->x, mj->y};
    const fl_simd last = mj->z;
    fl_simd_transpose(a);
    fl_simd_transpose(b);
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) {
        fl_member_force *to = &force[contact[l]];
        FL_SIMD_STORE(&to->f) = a[l];
        FL_SIMD_STORE(&to->mi.y) = b[l];
        to->mj.z = last[l];
    }
}

#define TURNED(e, a)                                                                                         \
    ((fl_simd3){(e)[0].x * (a).x + (e)[0].y * (a).y + (e)[0].z * (a).z,                                      \
                (e)[1].x * (a).x + (e)[1].y * (a).y + (e)[1].z * (a).z,                                      \
                (e)[2].x * (a).x + (e)[2].y * (a).y + (e)[2].z * (a).z})

FL_SIMD_INLINE void beams(const fl_member_beams *b, const fl_member_ball *ball, fl_member_force *force,
                          fl_simd *most)
{
    fl_simd3 dx;
    quat4 qi, qj;
    load_ends(b, ball, &dx, &qi, &qj);
    const quat4 e0 = {FL_SIMD_LOAD(b->e0[0]), FL_SIMD_LOAD(b->e0[1]), FL_SIMD_LOAD(b->e0[2]),
                      FL_SIMD_LOAD(b->e0[3])};
    const quat4 ai = Q_MUL(qi, e0), back = {ai.w, -ai.x, -ai.y, -ai.z};
    quat4 aj = Q_MUL(qj, e0), p = Q_MUL(back, aj);
    const fl_simd_mask sign = (p.w < 0.0) & INT64_MIN;
#define FLIP(a) ((fl_simd)((fl_simd_mask)(a) ^ sign))
    aj = (quat4){FLIP(aj.w), FLIP(aj.x), FLIP(aj.y), FLIP(aj.z)};
    p = (quat4){FLIP(p.w), FLIP(p.x), FLIP(p.y), FLIP(p.z)};
    quat4 h = {ai.w + aj.w, ai.x + aj.x, ai.y + aj.y, ai.z + aj.z};
    fl_simd norm = h.w * h.w + h.x * h.x + h.y * h.y + h.z * h.z;
    square_roots(&norm);
    norm = 1.0 / norm;
    h = (quat4){norm * h.w, norm * h.x, norm * h.y, norm * h.z};
    const fl_simd xx = h.x * h.x, yy = h.y * h.y, zz = h.z * h.z, xy = h.x * h.y, xz = h.x * h.z,
                  yz = h.y * h.z, wx = h.w * h.x, wy = h.w * h.y, wz = h.w * h.z;
    const fl_simd3 e[3] = {{1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)},
                           {2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)},
                           {2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)}};
    const fl_simd3 v = {p.x, p.y, p.z};
    const fl_simd s2 = FL_SIMD3_DOT(v, v), w = p.w, over = 1.0 / (1.0 + w), length = FL_SIMD_LOAD(b->length),
                  half = 0.5 * length;
    fl_simd k;
    arcsines(&s2, &k);
    const fl_simd g = 1.0 + k * s2;
    const fl_simd3 mid = {w + v.x * v.x * over, v.y * v.x * over, v.z * v.x * over};
    const fl_simd3 across = {e[0].x * dx.x + e[1].x * dx.y + e[2].x * dx.z,
                             e[0].y * dx.x + e[1].y * dx.y + e[2].y * dx.z,
                             e[0].z * dx.x + e[1].z * dx.y + e[2].z * dx.z};
    const fl_simd3 d = FL_SIMD3_MADD(across, -length, mid);
    const fl_simd3 f = {FL_SIMD_LOAD(b->axial) * d.x, FL_SIMD_LOAD(b->shear[0]) * d.y,
                        FL_SIMD_LOAD(b->shear[1]) * d.z};
    const fl_simd3 big = {2.0 * g * FL_SIMD_LOAD(b->turn[0]) * v.x, 2.0 * g * FL_SIMD_LOAD(b->turn[1]) * v.y,
                          2.0 * g * FL_SIMD_LOAD(b->turn[2]) * v.z};
    const fl_simd rest = -k * FL_SIMD3_DOT(v, big);
    const fl_simd3 m = {g * big.x + rest * v.x, g * big.y + rest * v.y, g * big.z + rest * v.z};
    const fl_simd3 df = CROSS(d, f), couple = FL_SIMD3_SCALE(0.5, df), turn = CROSS(v, couple),
                   twist = FL_SIMD3_SCALE(over, turn);
    /* mid less and with v x e1 = (0, v.z, -v.y) */
    const fl_simd3 less = {mid.x, mid.y - v.z, mid.z + v.y}, more = {mid.x, mid.y + v.z, mid.z - v.y};
    const fl_simd3 ci = CROSS(less, f), cj = CROSS(more, f), hi = FL_SIMD3_SCALE(half, ci),
                   hj = FL_SIMD3_SCALE(half, cj);
    const fl_simd3 si = {hi.x + m.x + couple.x - twist.x, hi.y + m.y + couple.y - twist.y,
                         hi.z + m.z + couple.z - twist.z};
    const fl_simd3 sj = {hj.x - m.x + couple.x + twist.x, hj.y - m.y + couple.y + twist.y,
                         hj.z - m.z + couple.z + twist.z};
    const fl_simd3 out = TURNED(e, f), mi = TURNED(e, si), mj = TURNED(e, sj);
    store_forces(b->contact, force, &out, &mi, &mj);
    const fl_simd r2 = 4.0 * g * g * s2;
    *most = FL_SIMD_SELECT(r2 > *most, r2, *most);
}

FL_SIMD4_VERSIONS double fl_member_beams_force(const fl_member_beams *b, int32_t n,
                                               const fl_member_ball *ball, fl_member_force *force)
{
    fl_simd most = FL_SIMD_SPLAT(0.0);
    for (int32_t k = 0; k < n; k++) beams(&b[k], ball, force, &most);
    double largest = 0.0;
    for (int l = 0; l < FL_SIMD_WIDTH; l++)
        if (most[l] > largest) largest = most[l];
    return largest;
}

/* --- balls --------------------------------------------------------------------------------------- */

FL_SIMD4_VERSIONS void fl_member_balls_resist(int32_t begin, int32_t end, const int32_t *first,
                                              const int32_t *around, const fl_member_force *force,
                                              fl_member_resist *resist)
{
    for (int32_t b = begin; b < end; b++) {
        /* The force of a contact pulls i towards j: what resists at i is its negative.  The fourth lane is of
         * other numbers and is not used. */
        fl_simd f = FL_SIMD_SPLAT(0.0), m = f;
        for (int32_t a = first[b]; a < first[b + 1]; a++) {
            const fl_member_force *e = &force[around[a] >> 1];
            if (around[a] & 1) {
                f = f + FL_SIMD_LOAD(&e->f);
                m = m - FL_SIMD_LOAD(&e->mj);
            } else {
                f = f - FL_SIMD_LOAD(&e->f);
                m = m - FL_SIMD_LOAD(&e->mi);
            }
        }
        double *const to = &resist[b].f.x;
        FL_SIMD_STORE(to) = __builtin_shufflevector(f, m, 0, 1, 2, 4);
        to[4] = m[1], to[5] = m[2];
    }
}

/* d, v, w, q and the rest of four balls, which are in the lanes of 16 rows, and back. */
FL_SIMD_INLINE void load_balls(fl_simd r[16], const fl_member_ball *b, int from)
{
    FL_SIMD_UNROLL
    for (int k = from; k < 16; k += FL_SIMD_WIDTH) {
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) r[k + l] = FL_SIMD_LOAD(&b[l].d.x + k);
        fl_simd_transpose(&r[k]);
    }
}

FL_SIMD_INLINE void store_balls(fl_member_ball *b, fl_simd r[16])
{
    FL_SIMD_UNROLL
    for (int k = 0; k < 16; k += FL_SIMD_WIDTH) {
        fl_simd_transpose(&r[k]);
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(&b[l].d.x + k) = r[k + l];
    }
}

FL_SIMD_INLINE void load_resist(const fl_member_resist *from, fl_simd3 *f, fl_simd3 *m)
{
    fl_simd a[FL_SIMD_WIDTH], b[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++)
        a[l] = FL_SIMD_LOAD(&from[l].f.x), b[l] = FL_SIMD_LOAD(&from[l].f.z);
    fl_simd_transpose(a);
    fl_simd_transpose(b);
    *f = (fl_simd3){a[0], a[1], a[2]};
    *m = (fl_simd3){b[1], b[2], b[3]};
}

/* Balls without supports and loads that may move and turn; rows as above. */
FL_SIMD_INLINE int all_free(const fl_simd r[16])
{
    const fl_simd_mask none = {-(INT64_C(1) << 32), -(INT64_C(1) << 32), -(INT64_C(1) << 32),
                               -(INT64_C(1) << 32)}; /* fixed = 0, load = -1 */
    const fl_simd_mask other = ~((r[13] > 0.0) & (r[14] > 0.0) & ((fl_simd_mask)r[15] == none));
    return !fl_simd_any(&other);
}

/* sum + the lanes of a, with those of b between them */
FL_SIMD_INLINE double add_lanes(double sum, const fl_simd *a, const fl_simd *b)
{
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) {
        sum += (*a)[l];
        sum += (*b)[l];
    }
    return sum;
}

FL_SIMD4_VERSIONS int fl_member_balls_state(const fl_member_ball *ball, const fl_member_resist *resist,
                                            const fl_member_resist *last, double over_l2, double sum[3])
{
    fl_simd r[16];
    fl_simd3 f, m, f0, m0;
    load_balls(r, ball, 0);
    if (!all_free(r)) return 0;
    load_resist(resist, &f, &m);
    load_resist(last, &f0, &m0);
    const fl_simd3 v = {r[3], r[4], r[5]}, w = {r[6], r[7], r[8]};
    const fl_simd r2 = FL_SIMD3_DOT(f, f) + over_l2 * FL_SIMD3_DOT(m, m);
    const fl_simd straight = FL_SIMD3_DOT(v, v) / r[13], round = FL_SIMD3_DOT(w, w) / r[14];
    f0 = FL_SIMD3_SUB(f, f0), m0 = FL_SIMD3_SUB(m, m0);
    const fl_simd of_f = FL_SIMD3_DOT(v, f0), of_m = FL_SIMD3_DOT(w, m0);
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) sum[0] += r2[l];
    sum[1] = add_lanes(sum[1], &straight, &round);
    sum[2] = add_lanes(sum[2], &of_f, &of_m);
    return 1;
}

/* Rotations by vectors r, q_of_vector(); 0 if one is too large for the short series. */
FL_SIMD_INLINE int turns(const fl_simd3 *r, quat4 *q)
{
    const fl_simd x = 0.25 * FL_SIMD3_DOT(*r, *r);
    const fl_simd_mask large = ~(x <= Q_HALF_ANGLE2_SMALL);
    if (fl_simd_any(&large)) return 0;
    const fl_simd c = 1.0 - x * (1.0 / 2 - x * (1.0 / 24 - x * (1.0 / 720)));
    const fl_simd s = (1.0 - x * (1.0 / 6 - x * (1.0 / 120 - x * (1.0 / 5040)))) * 0.5;
    *q = (quat4){c, s * r->x, s * r->y, s * r->z};
    return 1;
}

FL_SIMD4_VERSIONS int fl_member_balls_step(fl_member_ball *ball, const fl_member_resist *resist,
                                           const fl_vec3 *from, double c1, double c2, double dt,
                                           double sum[2])
{
    fl_simd r[16];
    fl_simd3 f, m;
    quat4 turn;
    load_balls(r, ball, 0);
    if (!all_free(r)) return 0;
    load_resist(resist, &f, &m);
    const fl_simd3 v0 = {r[3], r[4], r[5]}, w0 = {r[6], r[7], r[8]}, d0 = {r[0], r[1], r[2]};
    const fl_simd of_f = -c2 * dt * r[13], of_m = -c2 * dt * r[14];
    const fl_simd3 v1 = FL_SIMD3_SCALE(c1, v0), v = FL_SIMD3_MADD(v1, of_f, f), w1 = FL_SIMD3_SCALE(c1, w0),
                   w = FL_SIMD3_MADD(w1, of_m, m), angle = FL_SIMD3_SCALE(dt, w);
    if (!turns(&angle, &turn)) return 0;
    const quat4 q0 = {r[9], r[10], r[11], r[12]}, q = Q_MUL(turn, q0);
    const fl_simd unit = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    const fl_simd3 d = FL_SIMD3_MADD(d0, dt, v);
    fl_simd3 arc = d;
    if (from) {
        fl_simd e[3];
        fl_simd_from_triples(e, from);
        const fl_simd3 e3 = {e[0], e[1], e[2]}, beyond = FL_SIMD3_SUB(d0, e3);
        arc = FL_SIMD3_MADD(beyond, dt, v);
    }
    const fl_simd aa = FL_SIMD3_DOT(arc, arc), straight = FL_SIMD3_DOT(v, v) / r[13],
                  round = FL_SIMD3_DOT(w, w) / r[14];
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) sum[0] += aa[l];
    sum[1] = add_lanes(sum[1], &straight, &round);
    r[0] = d.x, r[1] = d.y, r[2] = d.z, r[3] = v.x, r[4] = v.y, r[5] = v.z, r[6] = w.x, r[7] = w.y,
    r[8] = w.z;
    r[9] = unit * q.w, r[10] = unit * q.x, r[11] = unit * q.y, r[12] = unit * q.z;
    store_balls(ball, r);
    return 1;
}
