/* SPDX-License-Identifier: GPL-3.0-or-later */
/* joint_list.h -- the joints of a world: set-up from the records of the ice file and the [joint NAME]
 * sections.
 *
 * Joints stand in the list of bonded faces (bond_list.h) behind those of [bond], with a record more each.  A
 * joint named `intact` without a section of that name is a bonded face without limit, of the materials'
 * stiffness E/l and G/l.  Without any [joint] section the records have no effect on
 * rigid blocks; glued faces of deformable ones always have. */
#ifndef FL_CONTACT_JOINT_LIST_H
#define FL_CONTACT_JOINT_LIST_H
#include "scene/ice_field.h"
#include "world/world.h"

/* Number of joints that the field gives the world. */
int32_t fl_joint_list_count(const fl_world *w, const fl_ice_field *field);

/* Makes the joints, at bonds.bond[faces ...] of w, whose arrays are there; shape[]: the sharp shapes of the
 * field. -1 with FL_SYSTEM, or FL_INPUT: a name without a section, a law without its stiffness, faces that do
 * not touch. */
int fl_joint_list_make(fl_world *w, const fl_ice_field *field, fl_err *err);
void fl_joint_list_free(fl_bond_list *s);

/* The joint of bond k, NULL if that is a bonded face. */
static inline fl_joint *fl_joint_of_bond(const fl_bond_list *s, int32_t k)
{
    return k >= s->faces && s->joint && s->joint[k - s->faces].material >= 0 ? &s->joint[k - s->faces] : NULL;
}

/* As fl_bond_force(), for bond k, which is a joint. */
int fl_joint_list_force(fl_world *w, int32_t k, fl_vec3 way);

/* Largest area that bond k may get: of the smaller face of a joint [m2]. */
double fl_joint_list_most_area(const fl_world *w, int32_t k);

/* omega^2 that the joints of body i give it while they are whole [1/s2]; *stiffest: the bond that gives most
 * of it, -1 without joints. */
double fl_joint_list_omega2(const fl_world *w, int32_t i, int32_t *stiffest);

/* Friction loss of all joints [J]. */
double fl_joint_list_friction_loss(const fl_world *w);

typedef struct {
    int32_t elastic, slip, open, ended; /* joints of each state */
} fl_joint_counts;
fl_joint_counts fl_joint_list_counts(const fl_world *w);

#endif
