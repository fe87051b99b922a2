/* SPDX-License-Identifier: GPL-3.0-or-later */
/* joint_law.h -- laws of a point of a rock joint: stress from opening and slip; a file a law.
 *
 * sigma is positive in compression, s_n the opening, u = o - s_n the closure with the offset o of the point
 * (initial stress and dilation).  Stresses are per area of the joint.
 *
 * coulomb.  sigma = k_n u, d tau = k_s d s_t.  Tension: sigma < -T: the point fails and is open.  Shear:
 * |tau| > c + sigma tan phi: it fails, and tau is at once c_r + sigma tan phi_r along the trial stress.  A
 * point that has failed has T = 0 and those residual values.  Slip g opens it by dilation, d o = tan psi |d
 * g|, until its slip reaches a limit; a joint that is held closed gains pressure.  The return to the limit is
 * implicit,
 *     |d g| = (|tau_trial| - c_r - sigma tan phi_r)/(k_s + k_n tan psi tan phi_r).
 *
 * yielding (continuously).  k_n = a_n sigma^e_n, integrated exactly, so that sigma is a function of u alone;
 * k_s = a_s sigma^e_s; both at most a given largest value.  tau_m = sigma tan phi_m along the direction of
 * slip,
 *     F = (1 - tau/tau_m)/(1 - r) <= 1,   d tau = F k_s d u,   d phi_m = -(phi_m - phi)(1 - F)|d u|/R.
 * F is negative beyond the peak: that is the softening.  r is 0 at first, and tau/tau_m in the new direction
 * at a reversal, at most 0.75.  Steps of at most 0.02 tau_m/k_s by the mid-point rule: 4e-5 of the peak.  The
 * part of tau across the direction of slip stays.
 *
 * Energy: sigma^2/(2 k_n) (yielding: the integral of sigma) + tau^2/(2 k_s) per area is stored.  The caller
 * has the work; the difference is lost.  Sources: Coulomb slip and continuously yielding joints as in 3DEC
 * (Itasca); Cundall & Hart, ASCE Eng. Mech. (1984); Cundall & Lemos, Proc. Rockbursts (1990). */
#ifndef FL_BOND_JOINT_LAW_H
#define FL_BOND_JOINT_LAW_H
#include <stdint.h>

enum fl_joint_law_kind { FL_JOINT_COULOMB, FL_JOINT_YIELDING, FL_JOINT_LAWS };

typedef struct {
    int32_t law;                            /* enum fl_joint_law_kind */
    double kn, ks;                          /* k_n, k_s [Pa/m]; yielding: a_n, a_s [Pa^(1-e)/m] */
    double friction, residual_friction;     /* tan phi, tan phi_r */
    double cohesion, tension;               /* c, T; INFINITY: never [Pa] */
    double residual_cohesion;               /* c_r [Pa] */
    double dilation, dilation_slip;         /* tan psi; slip at which it ends [m] */
    double water_pressure;                  /* in the joint, on all of its area [Pa] */
    double normal_exponent, shear_exponent; /* e_n, e_s, 0 to 1 */
    double kn_most, ks_most;                /* [Pa/m] */
    double angle, initial_angle;            /* phi, phi_m at first [rad] */
    double roughness;                       /* R [m] */
} fl_joint_material;

typedef struct {
    double sigma, tau[2]; /* stress, tau along the two directions of the joint [Pa] */
    double offset;        /* o [m] */
    double slip;          /* length of the slip [m] */
    double angle, ratio;  /* phi_m [rad], r */
    double way[2];        /* unit direction of the last slip; 0 at first */
    int32_t failed, open; /* 1: strength lost; 1: no stress */
} fl_joint_point;

/* What a step of a point gives: energy stored per area, what slip has lost of it [J/m2]; 1 if it slips. */
typedef struct {
    double stored, friction;
    int slips;
} fl_joint_point_result;

/* A point under no stress but sigma; -1 for a law that has no closure with that stress. */
void fl_joint_point_start(const fl_joint_material *m, fl_joint_point *p, double sigma, const double tau[2]);

/* The stress after a step that ends with opening s_n and moves the sides by ds along the joint [m]. */
typedef fl_joint_point_result fl_joint_point_step(const fl_joint_material *m, fl_joint_point *p, double s_n,
                                                  const double ds[2]);
fl_joint_point_step fl_joint_coulomb_step, fl_joint_yielding_step;

/* A row for each law. */
typedef struct {
    const char *name;
    fl_joint_point_step *step;
} fl_joint_law_row;
extern const fl_joint_law_row fl_joint_laws[FL_JOINT_LAWS];

/* Largest stiffnesses of the law, for the critical step [Pa/m]. */
double fl_joint_most_kn(const fl_joint_material *m);
double fl_joint_most_ks(const fl_joint_material *m);

/* Closure at a stress sigma >= 0 of the yielding law, and the stress and stored energy at a closure. */
double fl_joint_closure(const fl_joint_material *m, double sigma);
double fl_joint_closing_stress(const fl_joint_material *m, double u, double *stored);

#endif
