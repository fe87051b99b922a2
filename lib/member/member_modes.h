/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_modes.h -- masses of a chain of balls, and its lowest modes about the unstrained state.
 *
 * Mass. Half a piece of length L and mass per length mu is at each of its ends:
 *     m += mu L/2,    I += mu L/2 [L2/12 + (EIy + EIz)/2EA]
 * where L2/12 is that of a rod of length L/2 about its end, and the rest the mean of the section about its
 * two axes. I is taken for all axes: torsional modes of a single member are too high by up to the root of
 * 2. A mass of a node is added to m alone.
 *
 * Modes solve K s = omega2 M s (member_stiffness.h), s.M s = 1, by subspace iteration: of p vectors X the
 * next are K^-1 M X, turned to the eigenvectors of K and M within their space, until the frequencies stand
 * still. Frequencies of n pieces a member are below those of the beam, by O(1/n2).
 * Source: Bathe, Finite Element Procedures (1996), ch. 11.6. */
#ifndef FL_MEMBER_MEMBER_MODES_H
#define FL_MEMBER_MEMBER_MODES_H
#include "base/tool.h"
#include "member/member_stiffness.h"

enum { FL_MEMBER_MODES_MOST = 200 };

/* mass, inertia: [balls], out.  -1 with FL_INPUT: a ball without mass. */
int fl_member_masses(const fl_member_chain *c, const fl_member_model *m, double *mass, double *inertia,
                     fl_err *err);

typedef struct {
    int32_t n, balls;
    double *omega; /* [n] ascending, 1/time */
    double
        *shape; /* [n][6 balls] displacement and rotation of each ball; its largest displacement is above 0 */
} fl_member_modes;

/* The n lowest modes, fewer where there are not so many.  -1 with FL_SYSTEM, or FL_NUMERIC where the
 * iteration does not converge. */
int fl_member_modes_find(fl_member_modes *out, const fl_member_stiffness *s, int32_t balls,
                         const double *mass, const double *inertia, int32_t n, fl_err *err);
void fl_member_modes_free(fl_member_modes *m); /* accepts a zeroed struct, leaves one */

/* Mass that moves with mode k where the largest displacement is 1. */
double fl_member_modes_mass(const fl_member_modes *m, int32_t k);

/* Writes the table of kind `modes`: mode, f, mass, ratio, and the displacements of the nodes where the
 * largest displacement is 1. */
void fl_member_modes_write(FILE *f, const fl_member_modes *m, const fl_member_model *model, double ratio,
                           const fl_history_line *by);

#endif
