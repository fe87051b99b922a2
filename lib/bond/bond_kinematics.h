/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_kinematics.h -- how the two sides of a bond stand to one another, and what a whole one does: by value, for
 * one and for loops over lanes alike, so that both have the same bits.  The equations are those of bond.h. */
#ifndef FL_BOND_BOND_KINEMATICS_H
#define FL_BOND_BOND_KINEMATICS_H
#include "bond/bond.h"
#include "geom/rows3.h"

/* Cosines between which the pressing part of a crack wears off as it turns: 60 and 90 degrees. */
#define FL_BOND_TURN_COSINE 0.5

/* Of the sides i and j, world axes: from the bodies' centres to the face, its half sides, its normals; from
 * the one side to the other; the frame m, ta, tb and in it the separation of the centre and its change along
 * half sides. */
typedef struct {
    fl_vec3 ri, rj, ui, uj, vi, vj, ni, nj;
    fl_vec3 centre, m, ta, tb;
    fl_vec3 s, su, sv;
    fl_vec3 tangent;       /* along ta, as long as both half sides together; or nothing, where they cancel */
    double length, cosine; /* |n_i + n_j|, n_i.n_j; a frame there is where that is above 0 */
} fl_bond_kinematics;

/* The face in the frames of its bodies, and as they stand; off: from the centre of i to that of j.  Leaves
 * ta, tb and what is told in the frame. */
FL_SIMD_INLINE fl_bond_kinematics fl_bond_kinematics_of(fl_vec3 pi, fl_vec3 pj, fl_vec3 ni, fl_vec3 nj,
                                                        fl_vec3 ai, fl_vec3 aj, fl_vec3 bi, fl_vec3 bj,
                                                        fl_rows3 Ri, fl_rows3 Rj, fl_vec3 off)
{
    fl_bond_kinematics q;
    q.ri = r3_mul(Ri, pi), q.ui = r3_mul(Ri, ai), q.vi = r3_mul(Ri, bi), q.ni = r3_mul(Ri, ni);
    q.rj = r3_mul(Rj, pj), q.uj = r3_mul(Rj, aj), q.vj = r3_mul(Rj, bj), q.nj = r3_mul(Rj, nj);
    const fl_vec3 sum = v3_add(q.ni, q.nj), side = v3_add(q.ui, q.uj);
    q.cosine = v3_dot(q.ni, q.nj);
    q.length = v3_norm(sum);
    q.m = v3_scale(1.0 / q.length, sum);
    q.tangent = v3_madd(side, -v3_dot(side, q.m), q.m);
    q.centre = v3_add(off, v3_sub(q.rj, q.ri));
    q.ta = q.tb = q.s = q.su = q.sv = v3(0, 0, 0);
    return q;
}

/* Sides that are turned by half a turn about m cancel; then ta is not theirs. */
FL_SIMD_INLINE int fl_bond_frame_defined(fl_bond_kinematics q)
{
    return v3_norm2(q.tangent) > 1e-12 * v3_norm2(q.ui);
}

/* A vector in the frame, and back. */
FL_SIMD_INLINE fl_vec3 fl_bond_to_frame(fl_bond_kinematics q, fl_vec3 x)
{
    return v3(v3_dot(q.m, x), v3_dot(q.ta, x), v3_dot(q.tb, x));
}

FL_SIMD_INLINE fl_vec3 fl_bond_to_world(fl_bond_kinematics q, fl_vec3 x)
{
    return v3_madd(v3_madd(v3_scale(x.x, q.m), x.y, q.ta), x.z, q.tb);
}

/* The rest of it. */
FL_SIMD_INLINE fl_bond_kinematics fl_bond_set_frame(fl_bond_kinematics q, fl_vec3 ta)
{
    q.ta = ta;
    q.tb = v3_cross(q.m, ta);
    q.s = fl_bond_to_frame(q, q.centre);
    q.su = fl_bond_to_frame(q, v3_sub(q.uj, q.ui));
    q.sv = fl_bond_to_frame(q, v3_sub(q.vj, q.vi));
    return q;
}

FL_SIMD_INLINE double fl_bond_positive_part(double x) { return x > 0.0 ? x : 0.0; }

/* A whole face that has used up less holds as it is. */
#define FL_BOND_INTACT_LIMIT (1.0 - 1e-9)

/* What of its strength the most loaded point of a whole face can have used up at most, 1 at all: the largest
 * opening and shear that any may have, and no help of pressure. */
FL_SIMD_INLINE double fl_bond_strength_used(fl_bond_kinematics q, double kn, double ks, double tension,
                                            double cohesion)
{
    const double open = fl_bond_positive_part(q.s.x + fabs(q.su.x) + fabs(q.sv.x)),
                 x = fabs(q.s.y) + fabs(q.su.y) + fabs(q.sv.y), y = fabs(q.s.z) + fabs(q.su.z) + fabs(q.sv.z);
    const double sigma = kn * open, tau2 = ks * ks * (x * x + y * y), T = tension * tension,
                 C = cohesion * cohesion;
    return sigma * sigma / T + tau2 / C;
}

/* Sums over the points of a traction, of it times either coordinate; in the frame. */
typedef struct {
    fl_vec3 f, fu, fv;
} fl_traction;

/* Force on i, torques on i and j, world axes. */
typedef struct {
    fl_vec3 f, ti, tj;
} fl_bond_wrench;

/* Tractions that act on i at the points of i and on j at those of j. */
FL_SIMD_INLINE fl_bond_wrench fl_traction_at_points(fl_bond_kinematics q, fl_traction t)
{
    const fl_vec3 F = fl_bond_to_world(q, t.f), U = fl_bond_to_world(q, t.fu), V = fl_bond_to_world(q, t.fv);
    return (fl_bond_wrench){F, v3_add(v3_cross(q.ri, F), v3_add(v3_cross(q.ui, U), v3_cross(q.vi, V))),
                            v3_neg(v3_add(v3_cross(q.rj, F), v3_add(v3_cross(q.uj, U), v3_cross(q.vj, V))))};
}

/* Tractions that act in the middle between the two; half: sum over points of s x traction, over 2. */
FL_SIMD_INLINE fl_bond_wrench fl_traction_at_middle(fl_bond_kinematics q, fl_traction t, fl_vec3 half)
{
    const fl_vec3 h = fl_bond_to_world(q, half);
    const fl_bond_wrench p = fl_traction_at_points(q, t);
    return (fl_bond_wrench){p.f, v3_add(p.ti, h), v3_add(p.tj, h)};
}

/* Of a point at s. */
FL_SIMD_INLINE fl_vec3 fl_traction_moment(fl_vec3 s, fl_vec3 x) { return v3_scale(0.5, v3_cross(s, x)); }

/* Velocity of j against i in the middle of the points: at the centre, and its change along half sides. */
FL_SIMD_INLINE fl_traction fl_bond_separation_rate(fl_bond_kinematics q, fl_vec3 vi, fl_vec3 wi, fl_vec3 vj,
                                                   fl_vec3 wj)
{
    const fl_vec3 half = v3_scale(0.5, q.centre), su = v3_scale(0.5, v3_sub(q.uj, q.ui)),
                  sv = v3_scale(0.5, v3_sub(q.vj, q.vi));
    const fl_vec3 uj = v3_add(vj, v3_cross(wj, v3_sub(q.rj, half))),
                  ui = v3_add(vi, v3_cross(wi, v3_add(q.ri, half)));
    return (fl_traction){
        fl_bond_to_frame(q, v3_sub(uj, ui)),
        fl_bond_to_frame(q, v3_sub(v3_cross(wj, v3_sub(q.uj, su)), v3_cross(wi, v3_add(q.ui, su)))),
        fl_bond_to_frame(q, v3_sub(v3_cross(wj, v3_sub(q.vj, sv)), v3_cross(wi, v3_add(q.vi, sv))))};
}

/* The sums over the points of a whole face whose stiffness is K over all of it: the weights have sum 1, and
 * 1/3 with the square of a coordinate. */
FL_SIMD_INLINE fl_traction fl_traction_intact(fl_vec3 K, fl_vec3 s, fl_vec3 su, fl_vec3 sv)
{
    const fl_vec3 third = v3(K.x / 3.0, K.y / 3.0, K.z / 3.0);
    return (fl_traction){v3_mul(K, s), v3_mul(third, su), v3_mul(third, sv)};
}

/* The same with the turn of m, which takes y and z along ta and tb. */
FL_SIMD_INLINE fl_bond_wrench fl_traction_with_rotation(fl_bond_kinematics q, fl_traction t, double y,
                                                        double z)
{
    const fl_bond_wrench p = fl_traction_at_points(q, t);
    const fl_vec3 across = fl_bond_to_world(q, v3(0.0, y / q.length, z / q.length));
    return (fl_bond_wrench){p.f, v3_sub(p.ti, v3_cross(q.ni, across)), v3_sub(p.tj, v3_cross(q.nj, across))};
}

/* Of elastic tractions of a whole face. */
FL_SIMD_INLINE fl_bond_wrench fl_bond_elastic_wrench(fl_bond_kinematics q, double area, double kn, double ks)
{
    const fl_vec3 s = q.s, su = q.su, sv = q.sv;
    const fl_traction t = fl_traction_intact(v3(area * kn, area * ks, area * ks), s, su, sv);
    const double K = area * (kn - ks), y = K * (s.x * s.y + (su.x * su.y + sv.x * sv.y) / 3.0),
                 z = K * (s.x * s.z + (su.x * su.z + sv.x * sv.z) / 3.0);
    return fl_traction_with_rotation(q, t, y, z);
}

/* And what they store [J]. */
FL_SIMD_INLINE double fl_bond_elastic_energy(fl_bond_kinematics q, double area, double kn, double ks)
{
    const fl_vec3 s = q.s, su = q.su, sv = q.sv;
    const double x = s.x * s.x + (su.x * su.x + sv.x * sv.x) / 3.0,
                 y = s.y * s.y + (su.y * su.y + sv.y * sv.y) / 3.0,
                 z = s.z * s.z + (su.z * su.z + sv.z * sv.z) / 3.0;
    return 0.5 * area * (kn * x + ks * (y + z));
}

/* Of the dashpots of a whole face, c over its springs. */
FL_SIMD_INLINE fl_bond_wrench fl_bond_damping_wrench(fl_bond_kinematics q, double c, double area, double kn,
                                                     double ks, fl_traction rate)
{
    const double scale = area * c;
    const fl_traction t =
        fl_traction_intact(v3(scale * kn, scale * ks, scale * ks), rate.f, rate.fu, rate.fv);
    const fl_vec3 half = v3_add(fl_traction_moment(q.s, t.f),
                                v3_add(fl_traction_moment(q.su, t.fu), fl_traction_moment(q.sv, t.fv)));
    return fl_traction_at_middle(q, t, half);
}

#endif
