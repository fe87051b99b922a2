/* SPDX-License-Identifier: GPL-3.0-or-later */
/* crushing.h -- contacts in which ice yields.
 *
 * Below y = p(|S|) S.n (failure/pressure_area.h) a contact is elastic.  n is the direction of its force, and
 * S, failure/area_vector.h, of what faces the motion of A: a way dD crushes dV = S.dD, and a pile that is
 * deep in a floe has its width.  (Where A moves across the force, by more than 78 degrees, of what faces n;
 * between floes S.n is of what faces n.)  At y it yields: the floe A is worn by the vector D, by which it
 * stands away from its partner for the contact law,
 *     W = W_law(x_A + R_A D),      F = -dW/dx,  |F| <= y,
 * so W has the same derivatives as before: forces and torques act at the true place, action and reaction
 * balance, and D at rest costs no energy.  While it yields, the force is p S: that of the law, y n, has n of
 * the unworn outline, and p (S - (S.n) n) is added to it, so that its power is p dV/dt.
 *
 * Below y the worn floe lies on the same surface: the force keeps the direction of the last yield of the
 * contact, F (n + t), t = S/(S.n) - n, and motion dx along t presses as much as along n:
 *     D += (t.dx) n,      dW = -F (n + t).dx
 * so nothing is gained by going back.  |t| <= 1, and F (n + t) is at most p |S| of the present S.
 *
 * Return mapping, after each evaluation of the law, with F, W and m = 1/(1 - W F'/F^2), the local exponent of
 * W = c s^m:
 *     if F > y:   s = m W/F,  W1 = min(W (y/F)^(m/(m-1)), y^2/(2 K_A)),  s1 = m W1/y,
 *                 D += (s - s1) n,   the wrench by y/F,   W by W1/W
 * and from F > y/10 on, while F grows, the same at F itself (y replaced by F): what touches first is an edge,
 * which is crushed flat before the contact as a whole yields.
 *
 * Else D shrinks only where the contact has turned round (D.n < 0), which takes energy out.
 *
 * With A = S.n, K_A = 2 c sqrt(A) is the stiffness of the law on a flat face of area A: what is crushed is
 * flat, and a sharp edge of the same force would store several times its energy. So W is multiplied by
 * g >= 1, which grows with A, until y^2/(2 K_A) is what an edge stores; it falls where the contact is
 * half as stiff again as K_A, as an edge that has turned to a face. The rebound of an impact of speed
 * v is then
 *     v_r = y/sqrt(K_A M).
 *
 * Work.  Crushing takes, in a step, the work of the elastic force by the trapezoid over the step less the
 * change of W:
 *     Q = -dt/2 (F0 + F1).(v_A - v_B) - (W1 - W0)          (and the same of torques)
 * whose sum is int p dV.  Damping is off while a contact yields, and with the elastic force at most y after.
 *
 * Memory. A pair keeps D in fl_crush, made at its first yield. When the contact ends, D goes to the floe as
 * a dent at that place; a contact that begins within its half width, from the same side, takes it up again.
 * A floe keeps FL_DENTS dents; the shallowest is dropped first.
 *
 * Limits.  D is one vector of a pair of bodies: a floe that is crushed at two places of one piece of the
 * structure wears as a whole. A partner that slides along a face finds it worn by D everywhere: a dent
 * resists sliding by t alone. The outline of the floe, and its mass, stay. */
#ifndef FL_CONTACT_CRUSHING_H
#define FL_CONTACT_CRUSHING_H
#include "contact/pair_geometry.h"
#include "contact/pair_surrogate.h"
#include "world/world.h"

/* True if the ice of pair p may crush: a polyhedron under the laws `patch` and `quick` against the
 * structure, or, with crushing = all, against another. */
static inline int fl_pair_crushes(const fl_world *w, const fl_pair *p)
{
    return w->crushing.of != FL_CRUSHING_NONE && p->points == FL_POINTS_PATCH && w->b.core[p->i].nf > 0 &&
           (p->j >= w->n ? p->j < w->n + w->pieces
                         : w->crushing.of == FL_CRUSHING_ALL && w->b.core[p->j].nf > 0);
}

/* The pose with A moved by D. */
fl_relative_pose fl_crushing_pose(const fl_pair *p, const fl_relative_pose *r);

/* If floe A has dents: gives p its record, with the dent that the contact lies in.  1 if there is one, -1
 * when memory runs out.
 *   centre     of pressure, in the frame of B [m]
 *   gradient   along the force on A, in that frame */
int fl_crushing_adopt(fl_world *w, fl_pair *p, fl_vec3 centre, fl_vec3 gradient, const fl_relative_pose *r);

/* Applies the return mapping to energy, scale and slope of an evaluation.
 *   gradient, centre   as above; the force is the gradient by exact->scale
 *   limit              out: y, INFINITY where there is none [N]
 *   aside              out: p (S - A n) of a contact that yields, else F t, in the frame of B [N]
 * 1 if the contact yields, 0 if not, -1 when memory runs out. */
int fl_crushing_yield(fl_world *w, fl_pair *p, const fl_relative_pose *r, fl_vec3 gradient, fl_vec3 centre,
                      fl_exact_contact *exact, double *limit, fl_vec3 *aside);

/* Before an evaluation: D of a record follows what moved along t in the step of dt. */
void fl_crushing_slide(const fl_world *w, fl_pair *p, const fl_relative_pose *r, double dt);

/* Elastic wrench and energy of a pair. */
typedef struct {
    fl_vec3 force, torque_i, torque_j;
    double energy;
} fl_elastic_wrench;
fl_elastic_wrench fl_elastic_wrench_of(const fl_pair *p);

/* Stores Q of a step of dt in the record, after the evaluation.  before: at the begin of the step. */
void fl_crushing_store_work(const fl_world *w, fl_pair *p, const fl_elastic_wrench *before, double dt);

/* Releases the record of p, which does not touch, with its stiffness back to that of the law. */
void fl_crushing_release(const fl_world *w, fl_pair *p);

/* After the contacts of a step, by one thread: books Q of all pairs, in their order, and moves D of contacts
 * that have ended into their floes.  -1 with FL_SYSTEM. */
int fl_crushing_book(fl_world *w, fl_err *err);

/* The piece of the structure that goes through floe i, -1 for none: no side of it would load the floe. */
int32_t fl_crushing_pierced_by(const fl_world *w, int32_t i);

/* Removes the dents of floe i. */
void fl_crushing_forget(fl_world *w, int32_t i);

/* Builds w->crushing from the scene; -1 with FL_SYSTEM. */
int fl_crushing_make(fl_world *w, fl_err *err);
void fl_crushing_free(fl_world *w);

#endif
