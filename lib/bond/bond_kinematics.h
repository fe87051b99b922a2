/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_kinematics.h -- kinematics of a bonded face, and the forces of an intact one.
 *
 * The functions work by value, so that one bond and loops over lanes get the same bits. The equations are
 * those of bond.h. */
#ifndef FL_BOND_BOND_KINEMATICS_H
#define FL_BOND_BOND_KINEMATICS_H
#include "base/simd.h"
#include "geom/rows3.h"

/* cos 60 degrees: between 60 and 90 degrees of rotation a crack loses its stiffness in compression. */
#define FL_BOND_TURN_COSINE 0.5

/* Sides i and j in world axes: offsets from the bodies' centres to the face, half sides, normals; the vector
 * between the sides; the frame m, ta, tb, and in it the separation of the centre and its change along the
 * half sides. */
typedef struct {
    fl_vec3 ri, rj, ui, uj, vi, vj, ni, nj;
    fl_vec3 centre, m, ta, tb;
    fl_vec3 s, su, sv;
    /* direction of ta, with the length of both first half sides together; 0 if they cancel */
    fl_vec3 tangent;
    double length, cosine; /* |n_i + n_j|, n_i.n_j; the frame exists if that is above 0 */
} fl_bond_kinematics;

/* Kinematics of a face given in the frames of its bodies; off: from the centre of i to that of j. Leaves ta,
 * tb and the components in the frame at 0. */
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

/* Least tangent^2 over half side^2. At 1e-12 the sum of the half sides is 1e-6 of either, and its direction
 * still right to 1e-10. */
#define FL_BOND_MIN_TANGENT2 1e-12

/* True if the half sides define ta: they cancel if the sides are turned by 180 degrees about m. */
FL_SIMD_INLINE int fl_bond_frame_defined(fl_bond_kinematics q)
{
    return v3_norm2(q.tangent) > FL_BOND_MIN_TANGENT2 * v3_norm2(q.ui);
}

/* Components in the frame, and back. */
FL_SIMD_INLINE fl_vec3 fl_bond_to_frame(fl_bond_kinematics q, fl_vec3 x)
{
    return v3(v3_dot(q.m, x), v3_dot(q.ta, x), v3_dot(q.tb, x));
}

FL_SIMD_INLINE fl_vec3 fl_bond_to_world(fl_bond_kinematics q, fl_vec3 x)
{
    return v3_madd(v3_madd(v3_scale(x.x, q.m), x.y, q.ta), x.z, q.tb);
}

/* Completes the kinematics with the direction ta. */
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

/* A face that has used less of its strength stays intact. The bound is computed in some 30 operations, so
 * that it is right to 30 * 2^-53 = 3e-15; 1e-9 covers that. */
#define FL_BOND_INTACT_LIMIT (1.0 - 1e-9)

/* Upper bound of the used share of strength, 1 at failure, over the points of an intact face: the largest
 * opening and shear of any point, without the help of compression. */
FL_SIMD_INLINE double fl_bond_strength_used(fl_bond_kinematics q, double kn, double ks, double tension,
                                            double cohesion)
{
    const double open = fl_bond_positive_part(q.s.x + fabs(q.su.x) + fabs(q.sv.x)),
                 x = fabs(q.s.y) + fabs(q.su.y) + fabs(q.sv.y), y = fabs(q.s.z) + fabs(q.su.z) + fabs(q.sv.z);
    const double sigma = kn * open, tau2 = ks * ks * (x * x + y * y), T = tension * tension,
                 C = cohesion * cohesion;
    return sigma * sigma / T + tau2 / C;
}

/* Sums over the points of a traction, and of it times either coordinate; in the frame. */
typedef struct {
    fl_vec3 f, fu, fv;
} fl_traction;

/* Force on i, torques on i and j, world axes. */
typedef struct {
    fl_vec3 f, ti, tj;
} fl_bond_wrench;

/* Wrench of tractions that act on i at the points of i and on j at those of j. */
FL_SIMD_INLINE fl_bond_wrench fl_traction_at_points(fl_bond_kinematics q, fl_traction t)
{
    const fl_vec3 F = fl_bond_to_world(q, t.f), U = fl_bond_to_world(q, t.fu), V = fl_bond_to_world(q, t.fv);
    return (fl_bond_wrench){F, v3_add(v3_cross(q.ri, F), v3_add(v3_cross(q.ui, U), v3_cross(q.vi, V))),
                            v3_neg(v3_add(v3_cross(q.rj, F), v3_add(v3_cross(q.uj, U), v3_cross(q.vj, V))))};
}

/* Wrench of tractions that act midway between the points; half: sum over points of s x traction, over 2. */
FL_SIMD_INLINE fl_bond_wrench fl_traction_at_middle(fl_bond_kinematics q, fl_traction t, fl_vec3 half)
{
    const fl_vec3 h = fl_bond_to_world(q, half);
    const fl_bond_wrench p = fl_traction_at_points(q, t);
    return (fl_bond_wrench){p.f, v3_add(p.ti, h), v3_add(p.tj, h)};
}

/* Contribution of a point at separation s to `half`. */
FL_SIMD_INLINE fl_vec3 fl_traction_moment(fl_vec3 s, fl_vec3 x) { return v3_scale(0.5, v3_cross(s, x)); }

/* Velocity of j relative to i midway between the points: at the centre, and its change along half sides. */
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

/* Sums over the points of an intact face of stiffness K: the weights have the sum 1, and 1/3 with the square
 * of a coordinate. */
FL_SIMD_INLINE fl_traction fl_traction_intact(fl_vec3 K, fl_vec3 s, fl_vec3 su, fl_vec3 sv)
{
    const fl_vec3 third = v3(K.x / 3.0, K.y / 3.0, K.z / 3.0);
    return (fl_traction){v3_mul(K, s), v3_mul(third, su), v3_mul(third, sv)};
}

/* fl_traction_at_points() with the rotation of m, whose moments about ta and tb come from y and z. */
FL_SIMD_INLINE fl_bond_wrench fl_traction_with_rotation(fl_bond_kinematics q, fl_traction t, double y,
                                                        double z)
{
    const fl_bond_wrench p = fl_traction_at_points(q, t);
    const fl_vec3 across = fl_bond_to_world(q, v3(0.0, y / q.length, z / q.length));
    return (fl_bond_wrench){p.f, v3_sub(p.ti, v3_cross(q.ni, across)), v3_sub(p.tj, v3_cross(q.nj, across))};
}

/* Wrench of the elastic tractions of an intact face. */
FL_SIMD_INLINE fl_bond_wrench fl_bond_elastic_wrench(fl_bond_kinematics q, double area, double kn, double ks)
{
    const fl_vec3 s = q.s, su = q.su, sv = q.sv;
    const fl_traction t = fl_traction_intact(v3(area * kn, area * ks, area * ks), s, su, sv);
    const double K = area * (kn - ks), y = K * (s.x * s.y + (su.x * su.y + sv.x * sv.y) / 3.0),
                 z = K * (s.x * s.z + (su.x * su.z + sv.x * sv.z) / 3.0);
    return fl_traction_with_rotation(q, t, y, z);
}

/* Elastic energy of an intact face [J]. */
FL_SIMD_INLINE double fl_bond_elastic_energy(fl_bond_kinematics q, double area, double kn, double ks)
{
    const fl_vec3 s = q.s, su = q.su, sv = q.sv;
    const double x = s.x * s.x + (su.x * su.x + sv.x * sv.x) / 3.0,
                 y = s.y * s.y + (su.y * su.y + sv.y * sv.y) / 3.0,
                 z = s.z * s.z + (su.z * su.z + sv.z * sv.z) / 3.0;
    return 0.5 * area * (kn * x + ks * (y + z));
}

/* Wrench of the dashpots of an intact face, c times its springs. */
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
