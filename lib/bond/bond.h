/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond.h -- a face in which two bodies are frozen together, and how it breaks.
 *
 * The face is a patch of area A fixed to both bodies, seen through 3 x 3 points of Gauss and Lobatto: centre,
 * middles of the sides and corners of a rectangle that has the second moments of the face, with weights 1/6
 * 4/6 1/6 each way.  A, A h^2/12 and the outer fibre are exact where the face is a rectangle.
 *
 * Separation.  Point k lies at X_i on one body and X_j on the other; s = X_j - X_i.  With the normals n_i,
 * n_j of the face on either body m = (n_i + n_j)/|n_i + n_j|, opening s_n = m.s, shear s_t = s - s_n m.  The
 * energy is a sum over the points of functions of s_n and |s_t|,
 *     W = sum w A [ (1 - d)/2 (k_n <s_n>^2 + k_s s_t^2) + k_n/2 <-s_n>^2 ],     k_n = E/l,  k_s = G/l,
 * and force and torques are its exact gradient, the turn of m with the bodies included: no force under a
 * rigid motion of the pair, action is reaction, and their moments about any point cancel.  Pressing is never
 * damaged.
 *
 * Damage d of a point begins where (<sigma>/sigma_t)^2 + (tau/tau_s)^2 = 1, tau_s = c + mu <-sigma>.  With
 *     lambda^2 = k_n <s_n>^2 + k_s s_t^2,     B = k_s s_t^2/lambda^2,     G = G_I + (G_II - G_I) B^eta
 * at that moment it goes on to lambda_f = 2 G/lambda_c as
 *     d = lambda_f (lambda - lambda_c)/(lambda (lambda_f - lambda_c)),
 * so that stress falls along a line, G is what the point takes per area (in mode I the separation at the end
 * is 2 G_I/sigma_t), unloading goes along the secant, and d never falls.  Where lambda_f <= lambda_c, or
 * without a G, it breaks at once. Sources: initiation, Mohr and Coulomb with a tension cap as Camanho &
 * Davila, NASA TM-2002-211737; G of mixed modes, Benzeggagh & Kenane, Compos. Sci. Technol. 56 (1996) 439.
 *
 * Friction.  The damaged part d of a point rubs where it is pressed: traction d k_s (s_t - g), |k_s (s_t -
 * g)| <= mu k_n <-s_n>, and g slips so that it stays so; g is 0 until damage begins.  So shear comes down to
 * friction and not below, and a face that has failed all over is a closed crack with friction: nothing is
 * lost or gained at that moment by what presses.  Source: Alfano & Sacco, Int. J. Numer. Meth. Engng 68
 * (2006) 542.
 *
 * Crack.  A face that has failed all over goes on as a crack until it is open at all points or has slid off
 * its partner; then it is ended, and carries no force at that moment.  Its pressing part wears off,
 *     c = 1 - h/h_0,     h = (1 - |s_1|/a)(1 - |s_2|/b) u,
 * a, b the sides, s_1, s_2 the slip of the centre, u falling from 1 to 0 as the normals turn apart from 60 to
 * 90 degrees, and h_0 what h was when the face failed; c never falls.  Turned by more than 90 degrees any
 * face is ended.
 *
 * Books.  A step of kick, drift, kick takes the work (F0 + F1).(s1 - s0)/2, so what a growing d takes out of
 * a point is w A (d1 - d0)/2 (k_n <s_n0><s_n1> + k_s s_t0.s_t1), exactly what is missing from the energy
 * afterwards, for a point that breaks at once as well.
 *
 * Size.  Where l >= 2 E G_I/sigma_t^2 lambda_f < lambda_c: the bond stores more than it may dissipate and
 * takes sigma_t^2 l/(2 E) instead of G_I (fl_bond_fracture_energy()).  The choice is the caller's: leave it so, which
 * keeps strength and says what the energy is (the automatic one: for ice of 10 J/m2 the limit is 4 cm, and a
 * load comes from strength); stretch, a least lambda_f/lambda_c, which makes it softer still, 1.5 in studies
 * of bonded spheres; or lower strengths by sqrt(limit/l), which keeps the energy (fl_bond_max_length()). */
#ifndef FL_BOND_BOND_H
#define FL_BOND_BOND_H
#include "body/body.h"

enum { FL_BOND_POINTS = 9, FL_BOND_FACE_NUMBERS = 32, FL_BOND_OUTPUT_NUMBERS = 28 };

enum fl_bond_state {
    FL_BOND_INTACT,  /* no point is damaged                    */
    FL_BOND_DAMAGED, /* some point is                          */
    FL_BOND_BROKEN,  /* all have failed: a crack that presses  */
    FL_BOND_ENDED    /* no force any more                      */
};

typedef struct {
    double d;                  /* damage, 0 to 1                                                  */
    double lambda_c, lambda_f; /* lambda_c and lambda_f, once damage has begun      [sqrt(J)/m]   */
    double slip[2];            /* g along the two directions of the face            [m]           */
} fl_bond_point;

typedef struct {
    int32_t i, j;                /* bodies, i < j                                                     */
    int32_t state;               /* enum fl_bond_state                                                */
    int32_t mixed_mode_exponent; /* eta >= 1                                                          */
    double wear;                 /* c                                                                 */
    double damping;              /* dashpot over spring, of what is not damaged       [s]            */
    /* of the last look: FL_BOND_OUTPUT_NUMBERS numbers in a row; world axes, torques about the two centres */
    fl_vec3 force, torque_i, torque_j; /* force on i (on j its opposite), torques           [N], [N m] */
    double elastic_energy;             /* W                                                 [J]   */
    double s[3], su[3], sv[3]; /* separation of the centre, and its change along a and b; opening, then
                                * shear along two directions [m] */
    fl_vec3 force_damping, torque_i_damping,
        torque_j_damping; /* the part of damping                                     */
    /* the face and its springs: FL_BOND_FACE_NUMBERS numbers in a row */
    fl_vec3 pi, pj;          /* its centre, frames of i and j                     [m]            */
    fl_vec3 ni, nj;          /* unit normal from i to j, frames of i and j                       */
    fl_vec3 ai, aj;          /* half a side, frames of i and j                    [m]            */
    fl_vec3 bi, bj;          /* half the other                                    [m]            */
    double area;             /* [m2]                                                             */
    double kn, ks;           /* E/l, G/l                                          [Pa/m]         */
    double tensile_strength; /* sigma_t, INFINITY: never                          [Pa]           */
    double cohesion;         /* c, INFINITY: never                                [Pa]           */
    double length;           /* l                                                 [m]            */
    double friction;         /* mu                                                               */
    double min_ductility;    /* lambda_f is at least this times lambda_c; 0: none                */
    fl_vec3 force_friction, torque_i_friction,
        torque_j_friction;         /* the part of friction                                    */
    double friction_spring_energy; /* in the springs of friction                        [J]   */
    /* how it breaks, and its past */
    double fracture_energy[2]; /* G_I, G_II; 0: at once                              [J/m2]        */
    double h0;                 /* h_0, 0 before it has failed */
    double dissipated;         /* taken out by damage and wear so far                [J]           */
    double given_to_friction;  /* and given to the springs of friction               [J]           */
    fl_bond_point point[FL_BOND_POINTS];
} fl_bond;

/* The face of c between bodies c->i and c->j as they stand: its centre x, the unit normal n from i to j, half
 * sides a and b across it, all in the world beside i; way: what is added to positions of j to be beside i
 * [m].  Sets pi to bj. */
void fl_bond_set_face(fl_bond *c, const fl_bodies *b, fl_vec3 way, fl_vec3 x, fl_vec3 n, fl_vec3 a,
                      fl_vec3 h);

/* Separations, damage, slip and forces at the poses and velocities of now, a step after the last look; way as
 * above.  1 when the face is ended by that, 0 otherwise. */
int fl_bond_force(fl_bond *c, const fl_bodies *b, fl_vec3 way);

/* The separations alone, as the last look left them: for a state that is read. */
void fl_bond_update_separation(fl_bond *c, const fl_bodies *b, fl_vec3 way);

/* End it: no force any more. */
void fl_bond_end(fl_bond *c);

/* What acts across the face at the last look: tension (below 0: pressure), shear, and moment about its
 * centre, as sizes but for the first; and the centre x, in the middle between the two sides [N], [N m], [m].
 */
typedef struct {
    double tension, shear, moment;
    fl_vec3 x;
} fl_bond_load;
fl_bond_load fl_bond_section_load(const fl_bond *c, const fl_bodies *b, fl_vec3 way);

/* Mean damage over the area. */
double fl_bond_mean_damage(const fl_bond *c);

/* Point k: its weight, the share of the area, and where it is in units of half the sides, -1, 0 or 1. */
double fl_bond_quadrature_point(int k, double *along_a, double *along_b);

/* The largest l without snap-back, 2 E G/strength^2 [m]. */
double fl_bond_max_length(double modulus, double energy, double strength);

/* What a bond takes per area in mode I: the larger of G_I and sigma_t^2/(2 k_n), or what stretch makes of it
 * [J/m2]. */
double fl_bond_fracture_energy(const fl_bond *c);

#endif
