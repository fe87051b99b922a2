/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond.h -- a bonded face between two bodies: elasticity, damage, fracture and friction.
 *
 * The face is a patch of area A fixed to both bodies, integrated by 3 x 3 Gauss-Lobatto points: centre,
 * mid-sides and corners of a rectangle that has the second moments of the face, with weights 1/6 4/6 1/6 each
 * way. A, A h^2/12 and the outer fibre are exact for a rectangular face.
 *
 * Separation. Point k lies at X_i on one body and X_j on the other; s = X_j - X_i. With the normals n_i, n_j
 * of the face on either body m = (n_i + n_j)/|n_i + n_j|, opening s_n = m.s, shear s_t = s - s_n m. The
 * energy is a sum over the points of functions of s_n and |s_t|,
 *     W = sum w A [ (1 - d)/2 (k_n <s_n>^2 + k_s s_t^2) + k_n/2 <-s_n>^2 ],     k_n = E/l,  k_s = G/l,
 * and force and torques are its exact gradient, including the rotation of m with the bodies. So there is no
 * force under a rigid motion of the pair, action equals reaction, and the moments about any point cancel.
 * Compression is never damaged.
 *
 * Damage d of a point begins where (<sigma>/sigma_t)^2 + (tau/tau_s)^2 = 1, tau_s = c + mu_i <-sigma>. With
 *     lambda^2 = k_n <s_n>^2 + k_s s_t^2,     B = k_s s_t^2/lambda^2,     G = G_I + (G_II - G_I) B^eta
 * at that moment it grows up to lambda_f = 2 G/lambda_c as
 *     d = lambda_f (lambda - lambda_c)/(lambda (lambda_f - lambda_c)).
 * So the stress falls linearly, G is the energy per area that the point takes (in mode I the separation at
 * the end is 2 G_I/sigma_t), unloading follows the secant, and d never decreases. Where lambda_f <= lambda_c,
 * or without a G, the point breaks at once. Sources: initiation, Mohr and Coulomb with a tension cap as
 * Camanho & Davila, NASA TM-2002-211737; mixed-mode G, Benzeggagh & Kenane, Compos. Sci. Technol. 56 (1996)
 * 439.
 *
 * Friction. The damaged part d of a point slides with friction where it is compressed: traction d k_s (s_t -
 * g), |k_s (s_t - g)| <= mu k_n <-s_n>. The slip g follows so that this holds; it is 0 until damage begins.
 * So shear falls to friction and not below. Source: Alfano & Sacco, Int. J. Numer. Meth. Engng 68 (2006) 542.
 * A face that has failed at all points is a closed crack, whose friction is that of the face as a whole,
 * crack_friction.h; compression neither loses nor gains energy at that moment.
 *
 * Crack. A face that has failed at all points remains as a crack until it is open at all points or has slid
 * off its partner. Then it ends, with no force at that moment. Its stiffness in compression wears off,
 *     c = 1 - h/h_0,     h = (1 - |s_1|/a)(1 - |s_2|/b) u,
 * a, b the sides, s_1, s_2 the slip of the centre. u falls from 1 to 0 as the angle between the normals grows
 * from 60 to 90 degrees. h_0 is h at the moment of failure; c never decreases. A rotation beyond 90 degrees
 * ends any face.
 *
 * Energy balance. A step of kick, drift, kick does the work (F0 + F1).(s1 - s0)/2. So a growing d removes w A
 * (d1 - d0)/2 (k_n <s_n0><s_n1> + k_s s_t0.s_t1) from a point, exactly the loss of stored energy, also for a
 * point that breaks at once.
 *
 * Size effect. Where l >= 2 E G_I/sigma_t^2, lambda_f < lambda_c: the bond stores more than it may dissipate,
 * and takes sigma_t^2 l/(2 E) instead of G_I (fl_bond_fracture_energy()). The caller has three choices. Leave
 * it so, which keeps the strength and reports the energy: the automatic choice, since loads depend on
 * strength, and for ice of 10 J/m2 the limit is 4 cm. Set min_ductility, a least lambda_f/lambda_c, which
 * makes the bond softer still; it is 1.5 in studies of bonded spheres. Lower the strengths by sqrt(limit/l),
 * which keeps the energy (fl_bond_max_length()). */
#ifndef FL_BOND_BOND_H
#define FL_BOND_BOND_H
#include "body/body.h"

enum { FL_BOND_POINTS = 9, FL_BOND_FACE_NUMBERS = 32, FL_BOND_OUTPUT_NUMBERS = 28 };

enum fl_bond_state {
    FL_BOND_INTACT,  /* no point is damaged */
    FL_BOND_DAMAGED, /* some point is damaged */
    FL_BOND_BROKEN,  /* all points have failed: a crack that bears compression */
    FL_BOND_ENDED    /* no force any more */
};

typedef struct {
    double d;                  /* damage, 0 to 1 */
    double lambda_c, lambda_f; /* once damage has begun [sqrt(J)/m] */
    double slip[2]; /* g along the two directions of the face [m]; of a crack: bond.c has its springs
                                * here */
} fl_bond_point;

typedef struct {
    int32_t i, j;                /* bodies, i < j */
    int32_t state;               /* enum fl_bond_state */
    int32_t mixed_mode_exponent; /* eta >= 1 */
    double wear;                 /* c */
    double damping;              /* dashpot over spring of the undamaged part [s] */
    /* results of the last evaluation, FL_BOND_OUTPUT_NUMBERS consecutive numbers; world axes, torques about
     * the two centres */
    fl_vec3 force, torque_i, torque_j; /* on i (force on j is opposite) [N], [N m] */
    double elastic_energy;             /* W [J] */
    /* separation of the centre, and its change along a and b; opening, then shear along two directions [m] */
    double s[3], su[3], sv[3];
    fl_vec3 force_damping, torque_i_damping, torque_j_damping; /* the damping part */
    /* the face and its springs, FL_BOND_FACE_NUMBERS consecutive numbers */
    fl_vec3 pi, pj;          /* centre of the face, frames of i and j [m] */
    fl_vec3 ni, nj;          /* unit normal from i to j, frames of i and j */
    fl_vec3 ai, aj;          /* first half side, frames of i and j [m] */
    fl_vec3 bi, bj;          /* second half side, likewise [m] */
    double area;             /* [m2] */
    double kn, ks;           /* E/l, G/l [Pa/m] */
    double tensile_strength; /* sigma_t, INFINITY: unlimited [Pa] */
    double cohesion;         /* c, INFINITY: unlimited [Pa] */
    double length;           /* l [m] */
    double friction;         /* mu */
    double min_ductility;    /* least lambda_f over lambda_c; 0: none */
    fl_vec3 force_friction, torque_i_friction, torque_j_friction; /* the friction part */
    double friction_spring_energy;                                /* stored in the springs of friction [J] */
    /* fracture and its history */
    double fracture_energy[2]; /* G_I, G_II; 0: breaks at once [J/m2] */
    double internal_friction;  /* mu of the strength */
    double h0;                 /* h_0, 0 before failure */
    double dissipated;         /* removed by damage and wear so far [J] */
    double given_to_friction;  /* passed to the springs of friction so far [J] */
    fl_bond_point point[FL_BOND_POINTS];
} fl_bond;

/* Sets the face of c between bodies c->i and c->j at their present poses: centre x, unit normal n from i to
 * j, half sides a and h, all in the world beside i. way: offset that brings positions of j beside i [m]. Sets
 * pi to bj. */
void fl_bond_set_face(fl_bond *c, const fl_bodies *b, fl_vec3 way, fl_vec3 x, fl_vec3 n, fl_vec3 a,
                      fl_vec3 h);

/* Updates separations, damage, slip and forces at the present poses and velocities, one step after the last
 * evaluation; way as above. Returns 1 if this ends the face, else 0. */
int fl_bond_force(fl_bond *c, const fl_bodies *b, fl_vec3 way);

/* Updates the separations alone, as the last evaluation left them: for a state read from a file. */
void fl_bond_update_separation(fl_bond *c, const fl_bodies *b, fl_vec3 way);

/* Ends the face: no force any more. */
void fl_bond_end(fl_bond *c);

/* Load across the face at the last evaluation: tension (below 0: compression), magnitudes of shear and of the
 * moment about its centre; the centre x, midway between the two sides [N], [N m], [m]. */
typedef struct {
    double tension, shear, moment;
    fl_vec3 x;
} fl_bond_load;
fl_bond_load fl_bond_section_load(const fl_bond *c, const fl_bodies *b, fl_vec3 way);

/* Area mean of the damage. */
double fl_bond_mean_damage(const fl_bond *c);

/* Quadrature point k: returns its weight, the share of the area; sets its position in half sides, -1, 0 or 1.
 */
double fl_bond_quadrature_point(int k, double *along_a, double *along_b);

/* Largest l without snap-back, 2 E G/strength^2 [m]. */
double fl_bond_max_length(double modulus, double energy, double strength);

/* Fracture energy of a bond in mode I: the larger of G_I and sigma_t^2/(2 k_n), or more by min_ductility
 * [J/m2]. */
double fl_bond_fracture_energy(const fl_bond *c);

#endif
