/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_stiffness.h -- linear stiffness of a chain of balls about its unstrained state.
 *
 * K is the second derivative of the energy of the contacts (member_contact.h) by displacements u and
 * rotations r of the balls. With e1 e2 e3 the axes of a contact, D = u_j - u_i and S = r_i + r_j its forms
 * are
 *     beam    D.e1,   D.e2 - L/2 S.e3,   D.e3 + L/2 S.e2   and   (r_j - r_i).e1, e2, e3
 *     hinged  D.e1,   D.e2/L - r_b.e3,   D.e3/L + r_b.e2
 *     bar     D.e1
 * each with the stiffness of the same name in the contact; an end on an arm a moves by u + r x a. K is kept
 * as L D L^T (profile_matrix.h), balls between nodes first. */
#ifndef FL_MEMBER_MEMBER_STIFFNESS_H
#define FL_MEMBER_MEMBER_STIFFNESS_H
#include "member/member_chain.h"
#include "member/profile_matrix.h"

enum { FL_MEMBER_STIFFNESS_MOST = 100000000 }; /* numbers of the profile */

typedef struct {
    fl_profile k;
    int32_t n;       /* unknowns */
    int32_t *number; /* [6 balls] of freedom 6 ball + d; -1: held, or no contact resists it */
    int32_t *dof;    /* [n] 6 ball + d */
} fl_member_stiffness;

/* Makes and factors K; file names the model in messages. -1 with FL_INPUT (more than
 * FL_MEMBER_STIFFNESS_MOST numbers) or FL_SYSTEM. A mechanism is refused before, mechanism.h. */
int fl_member_stiffness_make(fl_member_stiffness *s, const fl_member_chain *c, const char *file, fl_err *err);
void fl_member_stiffness_free(fl_member_stiffness *s); /* accepts a zeroed struct, leaves one */

/* x[n] <- K^-1 x. */
static inline void fl_member_stiffness_solve(const fl_member_stiffness *s, double *x)
{
    fl_profile_solve(&s->k, x);
}

#endif
