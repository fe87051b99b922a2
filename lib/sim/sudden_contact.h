/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sudden_contact.h -- says which contact began deeper than its bodies moved, and why that may be. */
#ifndef FL_SIM_SUDDEN_CONTACT_H
#define FL_SIM_SUDDEN_CONTACT_H
#include "world/world.h"

enum { FL_SUDDEN_TEXT = 512 };

/* One sentence on the first sudden contact of w, w->sudden.n > 0, and on what to check: the surface of a
 * mesh, or the bodies. Returns text. */
const char *fl_sudden_contact_text(const fl_world *w, char text[FL_SUDDEN_TEXT]);

#endif
