/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <math.h>
#include <stddef.h>
#include "base/simd.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/surrogate_batch.h"
#include "contact/velocity_predictor.h"
#include "law/damping.h"
#include "patch/no_tension.h"

/* Numbers of rows: force to torque_j_friction of fl_pair and one more; fl_friction_springs and one more. */
enum { PREVIOUS = 28, SPRINGS = 12 };

/* State and results of the contacts of a batch.  World axes unless a comment says "frame of B". */
typedef struct {
    fl_surrogate_lanes s;
    _Alignas(64) fl_lane qi[4], qj[4], R[9]; /* attitudes; axes of B, row by row */
    fl_lane off[3], u[3];                    /* from A's centre to B's; v_A - v_B with the lag */
    fl_lane wi[3], wj[3];                    /* angular velocities */
    fl_lane lag_dt;                          /* dt of fl_pair_rotation_lag(), 0 for spheres */
    fl_lane du[3], dwi[3], dwj[3], count;    /* fl_predicted_change_of_pair */
    fl_lane previous[PREVIOUS];              /* results of the last step, from force on */
    fl_lane mass, reduced, max_approach;     /* of the pair */
    fl_lane slow_factor, impact_damping, friction, tangential; /* of its law */
    fl_lane turn[3]; /* rotation of the force since the exact evaluation, frame of B */
    /* damping; fd and md in the frame of B, for a force ratio of 1 */
    fl_lane chi, weight_y, growth, shift[3], fd[3], md[3];
    fl_lane sustained, sustained_spin[3], core_a, core_b; /* memory of fl_pair; radii */
    fl_lane springs[SPRINGS];                             /* fl_friction_springs; the last one is unused */
    fl_lane compliance[6];
    /* input of friction */
    fl_lane n[3], v[3], v_end[3], aj[3], elongation[3], k, g, limit, spin_mean, spin, spin_end;
    fl_lane results[FL_PAIR_RESULTS]; /* of fl_pair, from force on */
    int remembers;                    /* some contact has a sustained load */
} batch;

#define OF(member) (b->s.s + FL_SURROGATE_ROW(member))
#define TO(member) (b->results + (offsetof(fl_pair, member) - offsetof(fl_pair, force)) / sizeof(double))

FL_SIMD4_VERSIONS static void load_rows(fl_lane *row, const double *const *of, int rows)
{
    fl_lanes_load(row, of, rows);
}

FL_SIMD_INLINE fl_friction_springs springs_of(const batch *b, int k)
{
    const fl_lane *s = b->springs;
    return (fl_friction_springs){fl_lane3(s, k), s[3].a[k],          s[4].a[k], s[5].a[k],
                                 s[6].a[k],      fl_lane3(s + 7, k), s[10].a[k]};
}

/* fl_previous_force_of() */
FL_SIMD_INLINE fl_previous_force previous_of(const batch *b, int k)
{
    const fl_lane *h = b->previous;
    return fl_previous_force_from(
        fl_wrench_about_middle(fl_lane3(h, k), fl_lane3(h + 3, k), fl_lane3(h + 6, k)),
        fl_wrench_about_middle(fl_lane3(h + 9, k), fl_lane3(h + 12, k), fl_lane3(h + 15, k)),
        fl_wrench_about_middle(fl_lane3(h + 18, k), fl_lane3(h + 21, k), fl_lane3(h + 24, k)),
        springs_of(b, k));
}

FL_SIMD_INLINE fl_sym3 compliance_of(const fl_lane *a, int k)
{
    return (fl_sym3){a[0].a[k], a[1].a[k], a[2].a[k], a[3].a[k], a[4].a[k], a[5].a[k]};
}

FL_SIMD_INLINE void set_compliance(fl_lane *a, int k, fl_sym3 K)
{
    a[0].a[k] = K.xx, a[1].a[k] = K.xy, a[2].a[k] = K.xz;
    a[3].a[k] = K.yy, a[4].a[k] = K.yz, a[5].a[k] = K.zz;
}

/* Further input of find_damping_over_faces(). */
static void load_memory(batch *b, const fl_world *w, fl_pair *const *p, int n)
{
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_pair *c = p[k < n ? k : 0];
        b->sustained.a[k] = c->sustained_load;
        fl_lane3_set(b->sustained_spin, k, c->sustained_spin);
        b->core_a.a[k] = w->b.radius[c->i], b->core_b.a[k] = w->b.radius[c->j];
    }
}

static void load_batch(batch *b, const fl_world *w, fl_pair *const *p, int n, double dt)
{
    b->remembers = 0;
    const fl_surrogate *s[FL_SURROGATE_BATCH];
    const double *qi[FL_SURROGATE_BATCH], *qj[FL_SURROGATE_BATCH], *had[FL_SURROGATE_BATCH],
        *slip[FL_SURROGATE_BATCH];
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_pair *c = p[k < n ? k : 0];
        const fl_bodies *o = &w->b;
        const int32_t i = c->i, j = c->j;
        s[k] = c->surrogate;
        qi[k] = fl_lane_column(fl_body_attitude(o, i)), qj[k] = fl_lane_column(fl_body_attitude(o, j));
        had[k] = fl_lane_column(&c->force);
        slip[k] = fl_lane_column(&c->springs);
        fl_lane3_set(b->off, k, fl_separation(w, i, j, c->image));
        b->lag_dt.a[k] = o->is_isotropic[i] || o->is_isotropic[j] ? 0.0 : dt;
        fl_lane3_set(b->u, k, v3_sub(o->v[i], o->v[j]));
        fl_lane3_set(b->wi, k, o->w[i]);
        fl_lane3_set(b->wj, k, o->w[j]);
        const fl_predicted_change_of_pair change = fl_predict_change_of_pair(w, c, v3(0, 0, 0));
        fl_lane3_set(b->du, k, change.v);
        fl_lane3_set(b->dwi, k, change.wi);
        fl_lane3_set(b->dwj, k, change.wj);
        b->count.a[k] = change.contact_count;
        b->mass.a[k] = b->reduced.a[k] = c->mass, b->max_approach.a[k] = c->max_approach_speed;
        b->slow_factor.a[k] = c->law->slow_damping_factor, b->impact_damping.a[k] = c->law->impact_damping;
        b->friction.a[k] = c->law->friction, b->tangential.a[k] = c->law->tangential_ratio;
        b->remembers |= c->sustained_load > 0.0;
    }
    fl_surrogate_pack(&b->s, s, FL_SURROGATE_BATCH);
    load_rows(b->qi, qi, 4);
    load_rows(b->qj, qj, 4);
    load_rows(b->previous, had, PREVIOUS);
    load_rows(b->springs, slip, SPRINGS);
}

/* --- lane by lane ------------------------------------------------------------------------------- */

FL_SIMD_INLINE fl_rows3 rows_of(const fl_lane *R, int k)
{
    return (fl_rows3){fl_lane3(R, k), fl_lane3(R + 3, k), fl_lane3(R + 6, k)};
}

/* Mean velocity of A against B in the step at aj from B's centre. */
FL_SIMD_INLINE fl_vec3 mean_velocity(const batch *b, int k, fl_vec3 aj)
{
    const fl_vec3 ai = v3_add(aj, fl_lane3(b->off, k));
    return v3_add(fl_lane3(b->u, k),
                  v3_sub(v3_cross(fl_lane3(b->wi, k), ai), v3_cross(fl_lane3(b->wj, k), aj)));
}

/* Predicted change of that velocity until the end of the step. */
FL_SIMD_INLINE fl_vec3 predicted_change(const batch *b, int k, fl_vec3 aj)
{
    const fl_predicted_change_of_pair change = {
        .v = fl_lane3(b->du, k), .wi = fl_lane3(b->dwi, k), .wj = fl_lane3(b->dwj, k)};
    return fl_predicted_change_at(&change, v3_add(aj, fl_lane3(b->off, k)), aj);
}

/* Relative poses, velocities with the lag, and compliances in world axes. */
FL_SIMD_VERSIONS static void find_poses(batch *restrict b)
{
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_rows3 A = fl_lane_axes(b->qi, k), B = fl_lane_axes(b->qj, k);
        const fl_vec3 lag =
            fl_rotation_lag(fl_lane3(b->wi, k), fl_lane3(b->wj, k), fl_lane3(b->off, k), b->lag_dt.a[k]);
        fl_lane3_set(b->u, k, v3_add(fl_lane3(b->u, k), lag));
        fl_lane3_set(b->du, k, v3_sub(fl_lane3(b->du, k), lag));
        const fl_vec3 x = v3(A.x.x, A.y.x, A.z.x), y = v3(A.x.y, A.y.y, A.z.y), z = v3(A.x.z, A.y.z, A.z.z);
        const fl_vec3 Mx = r3_tmul(B, x), My = r3_tmul(B, y), Mz = r3_tmul(B, z); /* columns of M */
        fl_lane3_set(b->R, k, B.x);
        fl_lane3_set(b->R + 3, k, B.y);
        fl_lane3_set(b->R + 6, k, B.z);
        fl_lane3_set(b->s.o, k, v3_neg(r3_tmul(B, fl_lane3(b->off, k))));
        fl_lane3_set(b->s.M, k, v3(Mx.x, My.x, Mz.x));
        fl_lane3_set(b->s.M + 3, k, v3(Mx.y, My.y, Mz.y));
        fl_lane3_set(b->s.M + 6, k, v3(Mx.z, My.z, Mz.z));
        set_compliance(b->compliance, k,
                       s3_rotated(compliance_of((b->s.s + FL_SURROGATE_ROW(compliance.xx)), k),
                                  v3(B.x.x, B.y.x, B.z.x), v3(B.x.y, B.y.y, B.z.y), v3(B.x.z, B.y.z, B.z.z)));
    }
}

/* Effective mass and compliance, for pairs in which they depend on the force. */
static void find_masses(batch *b, const fl_world *w, fl_pair *const *p, int n)
{
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_pair *c = p[k < n ? k : 0];
        const fl_rows3 R = rows_of(b->R, k);
        if (fl_pair_is_free(w, c)) continue;
        const fl_vec3 at = r3_mul(R, fl_lane3(b->s.point, k)), f = r3_mul(R, fl_lane3(b->s.f, k)),
                      m = r3_mul(R, fl_lane3(b->s.m, k));
        const fl_vec3 ti = v3_add(v3_cross(v3_add(at, fl_lane3(b->off, k)), f), m),
                      tj = v3_add(v3_cross(at, f), m);
        const fl_pair_mobility ease = fl_pair_mobility_of(w, c);
        b->mass.a[k] = fl_pair_mass(w, c, &ease, f, ti, tj);
        OF(inv_mass)->a[k] = fl_pair_compliance(&ease, f, ti, tj, b->s.force_ratio.a[k] * OF(pressure)->a[k]);
        set_compliance(b->compliance, k,
                       fl_pair_compliance_matrix(&ease, v3_add(at, fl_lane3(b->off, k)), at));
        OF(turn_compliance)->a[k] = fl_pair_turn_compliance(&ease, v3_unit(f));
    }
}

/* Mean of max(0, x) for x distributed evenly on [c - wide, c + wide]. */
FL_SIMD_INLINE double mean_approach(double c, double wide)
{
    const double over = c + wide, part = 0.25 * over * over / (wide > 0.0 ? wide : 1.0);
    return c >= wide ? c : over > 0.0 ? part : 0.0;
}

/* Row r of a symmetric matrix times (v, w). */
FL_SIMD_INLINE double row_times(const fl_lane *A, int k, int r, fl_vec3 v, fl_vec3 w)
{
    const uint8_t *at = FL_UPPER[r];
    return (A[at[0]].a[k] * v.x + A[at[1]].a[k] * v.y + A[at[2]].a[k] * v.z) +
           (A[at[3]].a[k] * w.x + A[at[4]].a[k] * w.y + A[at[5]].a[k] * w.z);
}

/* a after a small rotation. */
FL_SIMD_INLINE fl_vec3 rotated(fl_vec3 turn, fl_vec3 a) { return v3_add(a, v3_cross(turn, a)); }

/* lambda of law/damping.h, as sustained_share_of_patch() of patch_force.c.  v: of A against B at the centre
 * of the pressures; w: relative spin; force: on A; all in world axes or all in the frame of B. */
FL_SIMD_INLINE double sustained_share(const batch *b, int k, fl_vec3 v, fl_vec3 w, fl_vec3 core_turn,
                                      fl_vec3 before, fl_vec3 force, double sigma2)
{
    const double size2 = v3_norm2(force), each2 = size2 > 0.0 ? 1.0 / size2 : 0.0, each = sqrt(each2);
    const fl_vec3 core = v3_madd(v, each, v3_cross(core_turn, force)),
                  u = v3_madd(core, -each2 * v3_dot(core, force), force),
                  turns = v3_madd(w, -each2 * v3_dot(w, force), force);
    const double load = b->s.force_ratio.a[k] * OF(pressure)->a[k], u2 = v3_norm2(u),
                 all = u2 + sigma2 * (1.0 / (FL_SUSTAINED_SLOPE * FL_SUSTAINED_SLOPE)),
                 now2 = v3_norm2(turns), before2 = v3_norm2(before), product = v3_dot(turns, before),
                 most = now2 > before2 ? now2 : before2;
    const double sustained = b->sustained.a[k] < load ? b->sustained.a[k] / load : 1.0,
                 passing = all > 0.0 ? u2 / all : 0.0, steady = product > 0.0 ? product / most : 0.0;
    return sustained * passing * (most > 0.0 ? steady : 1.0);
}

/* Motion of A against B, and damping for a force ratio of 1: -chi times the sums over e (n, t) (n, t)^T.  The
 * pressures are rotated as the force has been since the last exact evaluation.  remembers: 0 leaves out
 * lambda, which is then 0. */
FL_SIMD_INLINE void find_damping_of(batch *restrict b, fl_predictor_step of, int remembers)
{
    const fl_lane *A = OF(damping);
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_rows3 R = rows_of(b->R, k);
        const fl_vec3 first = fl_lane3(OF(first_point), k), force = fl_lane3(b->s.f, k),
                      D = fl_lane3(OF(direction), k), T = fl_lane3(OF(torque), k);
        /* the pressures shift to where the force and the moment act */
        const fl_vec3 arm = v3_sub(fl_lane3(b->s.point, k), first);
        const fl_vec3 centre =
            fl_surrogate_force_centre(force, v3_add(fl_lane3(b->s.m, k), v3_cross(arm, force)));
        const fl_vec3 by = v3_sub(centre, fl_lane3(OF(centre), k));
        const fl_vec3 was = fl_lane3(OF(g), k); /* opposite to the force */
        const double size2 = v3_norm2(force) * v3_norm2(was), each2 = size2 > 0.0 ? 1.0 / sqrt(size2) : 0.0;
        const fl_vec3 turn = v3_scale(each2, v3_cross(force, was)), back = v3_neg(turn);
        const fl_vec3 aj = r3_mul(R, v3_add(first, by)),
                      turns = v3_sub(fl_lane3(b->wi, k), fl_lane3(b->wj, k)),
                      more = v3_sub(fl_lane3(b->dwi, k), fl_lane3(b->dwj, k));
        const fl_vec3 v =
            rotated(back, r3_tmul(R, v3_add(mean_velocity(b, k, aj), predicted_change(b, k, aj))));
        const fl_vec3 w = rotated(back, r3_tmul(R, v3_add(turns, more)));
        fl_vec3 f = v3(row_times(A, k, 0, v, w), row_times(A, k, 1, v, w), row_times(A, k, 2, v, w)),
                m = v3(row_times(A, k, 3, v, w), row_times(A, k, 4, v, w), row_times(A, k, 5, v, w));
        const double each = 1.0 / OF(pressure)->a[k], closing = -each * (v3_dot(D, v) + v3_dot(T, w));
        /* approach speed for damping: the mean over the approaching points, with evenly distributed speeds */
        const double c2 = each * (v3_dot(f, v) + v3_dot(m, w));
        double variance = c2 - closing * closing;
        const double wide = sqrt(3.0 * (variance > 0.0 ? variance : 0.0)),
                     mean = mean_approach(closing, wide),
                     touch = mean > b->max_approach.a[k] ? mean : b->max_approach.a[k];
        const double chi = fl_damping_chi(b->impact_damping.a[k], b->slow_factor.a[k], touch,
                                          b->s.energy.a[k], b->mass.a[k]);
        if (remembers) {
            const fl_vec3 core_turn =
                v3_add(v3_scale(b->core_a.a[k], v3_add(fl_lane3(b->wi, k), fl_lane3(b->dwi, k))),
                       v3_scale(b->core_b.a[k], v3_add(fl_lane3(b->wj, k), fl_lane3(b->dwj, k))));
            const double d2 = v3_norm2(D), eachd2 = d2 > 0.0 ? 1.0 / d2 : 0.0;
            const fl_vec3 middle =
                r3_mul(R, v3_madd(v3_add(v3_add(first, by), fl_lane3(OF(centre_offset), k)), eachd2,
                                  v3_cross(D, T)));
            const double sustained =
                sustained_share(b, k, v3_add(mean_velocity(b, k, middle), predicted_change(b, k, middle)),
                                v3_add(turns, more), core_turn, fl_lane3(b->sustained_spin, k),
                                r3_mul(R, force), variance > 0.0 ? variance : 0.0);
            const fl_vec3 acts = r3_mul(R, fl_lane3(b->s.point, k)),
                          at = v3_add(mean_velocity(b, k, acts), predicted_change(b, k, acts));
            const double rate = -(v3_dot(r3_mul(R, force), at) +
                                  v3_dot(r3_mul(R, fl_lane3(b->s.m, k)), v3_add(turns, more))) /
                                (b->s.force_ratio.a[k] * OF(pressure)->a[k]),
                         same = closing * rate > 0.0 ? rate : 0.0,
                         whole = same * same < closing * closing ? same : closing;
            f = v3_madd(v3_scale(1.0 - sustained, f), -sustained * whole, D);
            m = v3_madd(v3_scale(1.0 - sustained, m), -sustained * whole, T);
            variance *= (1.0 - sustained) * (1.0 - sustained);
        }
        /* the change by the contact itself */
        const fl_previous_force before = previous_of(b, k);
        const double size = v3_norm(force), pressure = b->s.force_ratio.a[k] * OF(pressure)->a[k],
                     corrected = fl_predict_approach(closing, size, chi * size, OF(inv_mass)->a[k],
                                                     b->count.a[k], of, before),
                     correction = fl_predictor_share(size, pressure) * (corrected - closing),
                     end_speed = closing + correction;
        const double growth = 1.0 + chi * end_speed, var = chi * chi * variance;
        const fl_no_tension stable = fl_no_tension_of(
            growth, var, OF(half_width)->a[k] * sqrt(var > 0.0 ? var : 0.0), OF(skewness)->a[k]);
        const double factor = -chi * (1.0 + stable.q), unmoved = stable.p + stable.q * (1.0 - growth);
        b->max_approach.a[k] = touch;
        b->chi.a[k] = chi;
        b->weight_y.a[k] = 2.0 * of.half_step * chi * pressure / b->reduced.a[k];
        b->growth.a[k] = growth + stable.p;
        fl_lane3_set(b->shift, k, by);
        fl_lane3_set(b->turn, k, turn);
        fl_lane3_set(b->fd, k,
                     rotated(turn, v3_madd(v3_scale(unmoved, D), factor, v3_madd(f, -correction, D))));
        fl_lane3_set(b->md, k,
                     rotated(turn, v3_madd(v3_scale(unmoved, T), factor, v3_madd(m, -correction, T))));
    }
}

FL_SIMD_VERSIONS static void find_damping(batch *restrict b, fl_predictor_step of)
{
    find_damping_of(b, of, 0);
}

FL_SIMD_VERSIONS static void find_damping_over_faces(batch *restrict b, fl_predictor_step of)
{
    find_damping_of(b, of, 1);
}

/* The force of W with damping, and the input of friction. */
FL_SIMD_VERSIONS static void find_normal_forces(batch *restrict b)
{
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_rows3 R = rows_of(b->R, k);
        const fl_vec3 first = fl_lane3(OF(first_point), k), point = fl_lane3(b->s.point, k),
                      f = fl_lane3(b->s.f, k), m = fl_lane3(b->s.m, k), off = fl_lane3(b->off, k);
        const double share = b->s.force_ratio.a[k], growth = b->growth.a[k];
        const fl_vec3 by = fl_lane3(b->shift, k), turn = fl_lane3(b->turn, k);
        fl_vec3 fd = fl_lane3(b->fd, k), md = fl_lane3(b->md, k);
        const fl_vec3 unmoved = rotated(turn, fl_lane3(OF(direction), k)), direction = v3_add(unmoved, fd),
                      turning = v3_add(rotated(turn, fl_lane3(OF(torque), k)), md);
        /* the force that is not pressure scales with damping as well */
        const fl_vec3 rest =
            v3_sub(v3_sub(v3_scale(1.0 / share, f), rotated(turn, fl_lane3(OF(other_force), k))), unmoved);
        const fl_vec3 less = v3_madd(fd, growth - 1.0, rest);
        fd = v3(growth < 1.0 ? less.x : fd.x, growth < 1.0 ? less.y : fd.y, growth < 1.0 ? less.z : fd.z);
        md = v3_add(md, v3_cross(by, fd));
        /* to world axes */
        const fl_vec3 at = r3_mul(R, point), aj = r3_mul(R, first), F = r3_mul(R, f), FM = r3_mul(R, m);
        const fl_vec3 D1 = v3_scale(share, r3_mul(R, fd)), DM = v3_scale(share, r3_mul(R, md));
        const fl_vec3 middle = v3_scale(0.5, off);
        const fl_wrench elastic = {F, v3_add(v3_cross(v3_add(at, middle), F), FM)},
                        damping = {D1, v3_add(v3_cross(v3_add(aj, middle), D1), DM)};
        const fl_previous_force was = previous_of(b, k);
        const fl_wrench stable = fl_stabilised_damping(elastic, damping, share * OF(pressure)->a[k],
                                                       b->weight_y.a[k], b->count.a[k], was, 0.0);
        const fl_vec3 D = stable.f, half = v3_cross(middle, D), di = v3_add(half, stable.m),
                      dj = v3_sub(half, stable.m);
        fl_lane3_set(TO(force_damping), k, D);
        fl_lane3_set(TO(torque_i_damping), k, di);
        fl_lane3_set(TO(torque_j_damping), k, dj);
        fl_lane3_set(TO(force), k, v3_add(F, D));
        fl_lane3_set(TO(torque_i), k, v3_add(v3_add(v3_cross(v3_add(at, off), F), FM), di));
        fl_lane3_set(TO(torque_j), k, v3_sub(dj, v3_add(v3_cross(at, F), FM)));
        /* friction centre at the centre of the pressures, in size and height */
        const double size = v3_norm(direction), least = 1e-12 * OF(pressure)->a[k],
                     each = size > least ? 1.0 / size : 0.0, mu = size > least ? b->friction.a[k] : 0.0,
                     springs = mu > 0.0 ? b->tangential.a[k] : 0.0;
        const fl_vec3 n = r3_mul(R, v3_scale(each, direction));
        const fl_vec3 centre = v3_add(v3_add(by, rotated(turn, fl_lane3(OF(centre_offset), k))),
                                      v3_scale(each * each, v3_cross(direction, turning)));
        const fl_vec3 at_centre = v3_add(aj, r3_mul(R, centre));
        const double wi = v3_dot(fl_lane3(b->wi, k), n), wj = v3_dot(fl_lane3(b->wj, k), n),
                     more = v3_dot(fl_lane3(b->dwi, k), n) - v3_dot(fl_lane3(b->dwj, k), n);
        const fl_vec3 v = mean_velocity(b, k, at_centre);
        fl_lane3_set(b->n, k, n);
        fl_lane3_set(b->aj, k, at_centre);
        fl_lane3_set(b->v, k, v);
        fl_lane3_set(b->v_end, k, v3_add(v, predicted_change(b, k, at_centre)));
        b->k.a[k] = springs * b->s.slope.a[k];
        b->g.a[k] = springs * b->chi.a[k] * (share * OF(pressure)->a[k]);
        b->limit.a[k] = mu * (share * size);
        fl_lane3_set(b->elongation, k, r3_mul(R, rotated(turn, fl_lane3(OF(elongation), k))));
        b->spin.a[k] = wi - wj;
        b->spin_end.a[k] = wi - wj + more;
        b->spin_mean.a[k] = 0.5 * (wi + wj);
    }
}

/* Friction and the remaining results. */
FL_SIMD_VERSIONS static void find_friction(batch *restrict b, fl_predictor_step of, int survey)
{
    const double surveyed = survey ? 1.0 : 0.0;
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_friction_contact c = {
            .n = fl_lane3(b->n, k),
            .k = b->k.a[k],
            .g = b->g.a[k],
            .limit = b->limit.a[k],
            .arm = OF(arm)->a[k],
            .elongation = fl_lane3(b->elongation, k),
            .compliance = compliance_of(b->compliance, k),
            .turn_compliance = OF(turn_compliance)->a[k],
            .contact_count = b->count.a[k],
        };
        const fl_vec3 aj = fl_lane3(b->aj, k), ai = v3_add(aj, fl_lane3(b->off, k));
        const fl_friction_springs was = springs_of(b, k);
        const fl_friction_motion by = {fl_lane3(b->v, k),  fl_lane3(b->v_end, k), b->spin.a[k],
                                       b->spin_end.a[k],   b->spin_mean.a[k],     was.damping,
                                       was.damping_moment, of.half_step,          of.at_start};
        const fl_friction_result to = fl_tangent_step(was, c, by, of.dt);
        const fl_vec3 t = to.force, si = v3_madd(v3_cross(ai, t), to.moment, c.n),
                      sj = v3_neg(v3_madd(v3_cross(aj, t), to.moment, c.n));
        const double spring = to.springs.energy, slope = surveyed * b->s.slope.a[k];
        fl_lane3_set(b->springs, k, to.springs.force);
        b->springs[3].a[k] = to.springs.k, b->springs[4].a[k] = to.springs.moment,
        b->springs[5].a[k] = to.springs.k_turn, b->springs[6].a[k] = spring;
        fl_lane3_set(b->springs + 7, k, to.springs.damping);
        b->springs[10].a[k] = to.springs.damping_moment;
        fl_lane3_set(TO(force_friction), k, t);
        fl_lane3_set(TO(torque_i_friction), k, si);
        fl_lane3_set(TO(torque_j_friction), k, sj);
        fl_lane3_set(TO(force), k, v3_add(fl_lane3(TO(force), k), t));
        fl_lane3_set(TO(torque_i), k, v3_add(fl_lane3(TO(torque_i), k), si));
        fl_lane3_set(TO(torque_j), k, v3_add(fl_lane3(TO(torque_j), k), sj));
        TO(spring_energy)->a[k] = spring;
        TO(energy)->a[k] = b->s.energy.a[k] + spring;
        TO(overlap)->a[k] = OF(overlap)->a[k] * b->s.z.a[k];
        TO(omega2_i)->a[k] = slope * OF(stiffness_i)->a[k];
        TO(omega2_j)->a[k] = slope * OF(stiffness_j)->a[k];
    }
}

/* --- contact by contact ------------------------------------------------------------------------- */

static_assert(offsetof(fl_friction_springs, damping_moment) == 10 * sizeof(double), "eleven in a row");

/* Stores the results in the pairs that are done. */
FL_SIMD4_VERSIONS static void store_results(const batch *restrict b, fl_pair *const *p, const uint8_t *done,
                                            int n)
{
    for (int k = 0; k < n; k += FL_SIMD_WIDTH) {
        double nowhere[FL_PAIR_RESULTS], last[FL_SIMD_WIDTH][FL_SIMD_WIDTH], *to[FL_SIMD_WIDTH],
            *end[FL_SIMD_WIDTH], *slip[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL
        for (int l = 0; l < FL_SIMD_WIDTH; l++) {
            fl_pair *const c = k + l < n && done[k + l] ? p[k + l] : NULL;
            to[l] = c ? (double *)(void *)((char *)c + offsetof(fl_pair, force)) : nowhere;
            slip[l] = c ? (double *)(void *)&c->springs : nowhere;
            end[l] = last[l];
        }
        for (int row = 0; row < SPRINGS - FL_SIMD_WIDTH; row += FL_SIMD_WIDTH) {
            double *const at[FL_SIMD_WIDTH] = {slip[0] + row, slip[1] + row, slip[2] + row, slip[3] + row};
            fl_lanes_store(at, b->springs + row, k);
        }
        fl_lanes_store(end, b->springs + SPRINGS - FL_SIMD_WIDTH, k);
        for (int row = 0; row < FL_PAIR_RESULTS; row += FL_SIMD_WIDTH) {
            double *const at[FL_SIMD_WIDTH] = {to[0] + row, to[1] + row, to[2] + row, to[3] + row};
            fl_lanes_store(at, b->results + row, k);
        }
        for (int l = 0; l < FL_SIMD_WIDTH && k + l < n; l++) {
            fl_pair *const c = p[k + l];
            if (!done[k + l]) continue;
            c->springs.damping.y = last[l][0], c->springs.damping.z = last[l][1],
            c->springs.damping_moment = last[l][2];
            c->surrogate->used = 1;
            c->max_approach_speed = b->max_approach.a[k + l];
        }
    }
}

void fl_surrogate_batch_evaluate(const fl_world *w, fl_pair *const *p, int n, double dt, int survey,
                                 uint8_t *done, fl_surrogate_value *t)
{
    const fl_predictor_step of = fl_predictor_step_of(w, dt);
    batch b;
    int any = 0;
    load_batch(&b, w, p, n, dt);
    find_poses(&b);
    fl_surrogate_evaluate(&b.s);
    find_masses(&b, w, p, n);
    if (b.remembers) {
        load_memory(&b, w, p, n);
        find_damping_over_faces(&b, of);
    } else {
        find_damping(&b, of);
    }
    for (int k = 0; k < n; k++) {
        done[k] = fl_surrogate_in_range(p[k]->surrogate, b.s.path.a[k], b.s.turn.a[k], b.s.z.a[k], 1.0) &&
                  b.s.force_ratio.a[k] > 0.0;
        any |= done[k];
    }
    if (any) {
        find_normal_forces(&b);
        find_friction(&b, of, survey);
        store_results(&b, p, done, n);
    }
    for (int k = 0; k < n; k++)
        if (!done[k]) t[k] = fl_surrogate_unpack(&b.s, k);
}
