/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <stddef.h>
#include "bond/bond_batch.h"
#include "bond/bond_kinematics.h"

/* Positions of the members of fl_bond, in numbers from pi and from force on. */
enum { PI, PJ = 3, NI = 6, NJ = 9, AI = 12, AJ = 15, BI = 18, BJ = 21, AREA = 24, KN, KS, TENSION, COHESION };
enum { F, TI = 3, TJ = 6, STORE = 9, S = 10, SU = 13, SV = 16, FD = 19, DI = 22, DJ = 25 };

#define POSITION(member, first) ((offsetof(fl_bond, member) - offsetof(fl_bond, first)) / sizeof(double))
static_assert(POSITION(nj, pi) == NJ && POSITION(bj, pi) == BJ && POSITION(area, pi) == AREA &&
                  POSITION(cohesion, pi) == COHESION && POSITION(force_friction, pi) == FL_BOND_FACE_NUMBERS,
              "the order of the face");
static_assert(POSITION(torque_j, force) == TJ && POSITION(elastic_energy, force) == STORE &&
                  POSITION(sv, force) == SV && POSITION(force_damping, force) == FD &&
                  POSITION(torque_j_damping, force) == DJ && POSITION(pi, force) == FL_BOND_OUTPUT_NUMBERS,
              "the order of the results");

typedef struct {
    _Alignas(64) fl_lane face[FL_BOND_FACE_NUMBERS];
    fl_lane damping, qi[4], qj[4], off[3], vi[3], wi[3], vj[3], wj[3];
    fl_lane out[FL_BOND_OUTPUT_NUMBERS], intact;
} bond_lanes;

FL_SIMD4_VERSIONS static void load_lanes(bond_lanes *restrict a, const double *const *face,
                                         const double *const *qi, const double *const *qj)
{
    fl_lanes_load(a->face, face, FL_BOND_FACE_NUMBERS);
    fl_lanes_load(a->qi, qi, 4);
    fl_lanes_load(a->qj, qj, 4);
}

/* Returns 1 if some of them have dashpots. */
static int load_batch(bond_lanes *a, fl_bond *const *c, const fl_vec3 *way, int n, const fl_bodies *b)
{
    const double *face[FL_LANE_COUNT], *qi[FL_LANE_COUNT], *qj[FL_LANE_COUNT];
    double damping = 0.0;
    for (int k = 0; k < FL_LANE_COUNT; k++) {
        const fl_bond *p = c[k < n ? k : 0];
        const int32_t i = p->i, j = p->j;
        face[k] = fl_lane_column(&p->pi);
        qi[k] = fl_lane_column(fl_body_attitude(b, i)), qj[k] = fl_lane_column(fl_body_attitude(b, j));
        fl_lane3_set(a->off, k, v3_add(v3_sub(b->x[j], b->x[i]), way[k < n ? k : 0]));
        a->damping.a[k] = p->damping;
        damping += p->damping;
    }
    load_lanes(a, face, qi, qj);
    if (!(damping > 0.0)) return 0;
    for (int k = 0; k < FL_LANE_COUNT; k++) {
        const int32_t i = c[k < n ? k : 0]->i, j = c[k < n ? k : 0]->j;
        fl_lane3_set(a->vi, k, b->v[i]), fl_lane3_set(a->wi, k, b->w[i]);
        fl_lane3_set(a->vj, k, b->v[j]), fl_lane3_set(a->wj, k, b->w[j]);
    }
    return 1;
}

FL_SIMD_INLINE void evaluate_lanes(bond_lanes *restrict a, int damped)
{
    const fl_lane *f = a->face;
#pragma omp simd
    for (int k = 0; k < FL_LANE_COUNT; k++) {
        const double area = f[AREA].a[k], kn = f[KN].a[k], ks = f[KS].a[k], damping = a->damping.a[k];
        const fl_bond_kinematics out = fl_bond_kinematics_of(
            fl_lane3(f + PI, k), fl_lane3(f + PJ, k), fl_lane3(f + NI, k), fl_lane3(f + NJ, k),
            fl_lane3(f + AI, k), fl_lane3(f + AJ, k), fl_lane3(f + BI, k), fl_lane3(f + BJ, k),
            fl_lane_axes(a->qi, k), fl_lane_axes(a->qj, k), fl_lane3(a->off, k));
        const fl_bond_kinematics q =
            fl_bond_set_frame(out, v3_scale(1.0 / v3_norm(out.tangent), out.tangent));
        const double used = fl_bond_strength_used(q, kn, ks, f[TENSION].a[k], f[COHESION].a[k]);
        a->intact.a[k] = q.cosine >= FL_BOND_TURN_COSINE && fl_bond_frame_defined(q) &&
                                 used < FL_BOND_INTACT_LIMIT && (damped == (damping > 0.0))
                             ? 1.0
                             : 0.0;
        fl_bond_wrench p = fl_bond_elastic_wrench(q, area, kn, ks);
        if (damped) {
            const fl_bond_wrench d =
                fl_bond_damping_wrench(q, damping, area, kn, ks,
                                       fl_bond_separation_rate(q, fl_lane3(a->vi, k), fl_lane3(a->wi, k),
                                                               fl_lane3(a->vj, k), fl_lane3(a->wj, k)));
            const fl_vec3 none = v3(0, 0, 0); /* no friction */
            fl_lane3_set(a->out + FD, k, d.f);
            fl_lane3_set(a->out + DI, k, d.ti);
            fl_lane3_set(a->out + DJ, k, d.tj);
            p.f = v3_add(p.f, v3_add(none, d.f));
            p.ti = v3_add(p.ti, v3_add(none, d.ti));
            p.tj = v3_add(p.tj, v3_add(none, d.tj));
        } else {
            fl_lane3_set(a->out + FD, k, v3(0, 0, 0));
        }
        fl_lane3_set(a->out + S, k, q.s);
        fl_lane3_set(a->out + SU, k, q.su);
        fl_lane3_set(a->out + SV, k, q.sv);
        fl_lane3_set(a->out + F, k, p.f);
        fl_lane3_set(a->out + TI, k, p.ti);
        fl_lane3_set(a->out + TJ, k, p.tj);
        a->out[STORE].a[k] = fl_bond_elastic_energy(q, area, kn, ks);
    }
}

FL_SIMD_VERSIONS static void evaluate_elastic(bond_lanes *restrict a) { evaluate_lanes(a, 0); }
FL_SIMD_VERSIONS static void evaluate_damped(bond_lanes *restrict a) { evaluate_lanes(a, 1); }

/* Stores the results of bonds that stay intact. */
FL_SIMD4_VERSIONS static void store_intact(const bond_lanes *restrict a, fl_bond *const *c, int n, int rows)
{
    for (int k = 0; k < n; k += FL_SIMD_WIDTH) {
        double nowhere[FL_BOND_OUTPUT_NUMBERS], *out[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++)
            out[l] = k + l < n && a->intact.a[k + l] > 0.0
                         ? (double *)(void *)((char *)c[k + l] + offsetof(fl_bond, force))
                         : nowhere;
        for (int row = 0; row < rows; row += FL_SIMD_WIDTH) {
            double *const at[FL_SIMD_WIDTH] = {out[0] + row, out[1] + row, out[2] + row, out[3] + row};
            fl_lanes_store(at, a->out + row, k);
        }
    }
}

void fl_bond_batch_force(fl_bond *const *c, const fl_vec3 *way, int n, const fl_bodies *b, uint8_t *done)
{
    bond_lanes a;
    const int damped = load_batch(&a, c, way, n, b);
    if (damped) evaluate_damped(&a);
    else evaluate_elastic(&a);
    store_intact(&a, c, n, damped ? FL_BOND_OUTPUT_NUMBERS : FD + 1);
    for (int k = 0; k < n; k++) done[k] = a.intact.a[k] > 0.0;
}
