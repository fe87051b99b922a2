/* SPDX-License-Identifier: GPL-3.0-or-later */
/* modal_motion.h -- a part of the structure that moves in several modes.
 *
 * The reference point, at the waterline, has the displacement u = sum_j q_j e_j, e_j the unit direction of
 * mode j, and the part follows it without rotation. Each mode obeys
 *     m_j q_j'' + 2 zeta_j omega_j m_j q_j' + m_j omega_j^2 q_j = e_j . F,     omega_j = 2 pi f_j,
 * F the sum of all forces of the ice, m_j the modal mass for a shape that is 1 at the reference: a mass M of
 * a shape phi is m = M/phi^2. Modes are coupled through the ice alone. Modes of a frame that are left out
 * make the waterline too stiff.
 *
 * A step is that of rigid_motion.h: dampers h, kick h, drift dt, kick h, dampers h, h = dt/2, with
 *     v <- v exp(-2 zeta omega h)
 * exact, and springs as kicks: order 2, stable for omega dt < 2. One mode gives the motion of `free` with
 * that mass, period and damping ratio, to rounding.
 *
 * Source: Clough & Penzien, Dynamics of Structures (1993), ch. 12. */
#ifndef FL_STRUCTURE_MODAL_MOTION_H
#define FL_STRUCTURE_MODAL_MOTION_H
#include <stdint.h>
#include "base/err.h"
#include "geom/vec3.h"

enum {
    FL_MODAL_NAME = 64,
    FL_MODES_MOST = 16 /* of a part; two for each of 8 that act along x and y */
};

typedef struct {
    char name[FL_MODAL_NAME];
    fl_vec3 e;                    /* direction of the waterline, length 1 */
    double mass;                  /* [kg] for |displacement of the reference| = q */
    double omega, ratio;          /* [rad/s]; damping over critical */
    double q, v;                  /* [m], [m/s] */
    double load;                  /* e . F of the last evaluation [N] */
    double force;                 /* the same with the spring [N] */
    double spring_energy, damped; /* [J] now; removed by the damper so far */
    double decay;                 /* factor of v by the damper of half a step */
} fl_modal_dof;

/* Sets `decay` for steps of dt. */
void fl_modes_set_step(fl_modal_dof *m, int32_t n, double dt);

/* Dampers over half a step; kick by h; drift by dt. */
void fl_modes_damp(fl_modal_dof *m, int32_t n);
void fl_modes_kick(fl_modal_dof *m, int32_t n, double h);
void fl_modes_drift(fl_modal_dof *m, int32_t n, double dt);

/* Load F at the reference [N] and springs at the present q. */
void fl_modes_load(fl_modal_dof *m, int32_t n, fl_vec3 F);

/* Displacement, velocity and acceleration of the reference: the first two as sums, the third with the dampers
 * if `damped`. */
fl_vec3 fl_modes_displacement(const fl_modal_dof *m, int32_t n);
fl_vec3 fl_modes_velocity(const fl_modal_dof *m, int32_t n);
fl_vec3 fl_modes_acceleration(const fl_modal_dof *m, int32_t n, int damped);

/* Kinetic energy of one mode, and with its spring [J]. */
double fl_mode_kinetic_energy(const fl_modal_dof *m);
double fl_mode_energy(const fl_modal_dof *m);

/* Compliance of the reference, the largest over directions: at most sum 1/m_j [1/kg]. Largest omega^2. */
double fl_modes_compliance(const fl_modal_dof *m, int32_t n);
double fl_modes_max_omega2(const fl_modal_dof *m, int32_t n);

/* Reads the modes of a table of kind `modes`, modes(5): columns f, mass, ratio, and either `direction` (x, y)
 * with an optional `shape`, or the displacements NODE.x NODE.y NODE.z of a node, which `node` names. Modes in
 * which that node stays at rest are left out. m: [FL_MODES_MOST].
 * Returns their number, or -1 with FL_INPUT (no such column or node, a number below 0, none or too many
 * modes) or FL_SYSTEM. */
int32_t fl_modes_read(fl_modal_dof *m, const char *path, const char *node, fl_err *err);

#endif
