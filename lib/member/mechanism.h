/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mechanism.h -- whether a structure of members resists all loads from the start, by its linear stiffness.
 *
 * K is that of Euler-Bernoulli members between nodes, hinged ends condensed, over the free freedoms of the
 * nodes, factored as L D L^T within its profile.  A pivot below 1e-9 of its diagonal element marks a motion
 * that meets no resistance; where it moves a node the structure is a mechanism, where it only spins members
 * about their axis it is harmless.
 * Structures of which the profile would take more than FL_MECHANISM_MOST numbers are not tested. */
#ifndef FL_MEMBER_MECHANISM_H
#define FL_MEMBER_MECHANISM_H
#include "member/member_model.h"

enum { FL_MECHANISM_MOST = 40000000 };

/* -1 with FL_INPUT, a sentence that names a node and its direction, for a mechanism. */
int fl_member_check_mechanism(const fl_member_model *m, fl_err *err);

#endif
