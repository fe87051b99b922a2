/* SPDX-License-Identifier: GPL-3.0-or-later */
/* members_import.h -- --members: beams, trusses and pipes of a deck as a model of members. */
#ifndef STRUCT_IMPORT_MEMBERS_IMPORT_H
#define STRUCT_IMPORT_MEMBERS_IMPORT_H
#include "options.h"

/* Reads the only file of o, tells what is not carried over on standard error, and writes the model.  -1 with
 * FL_INPUT or FL_SYSTEM; FL_NO with --strict, if something was not carried over. */
int import_members(const struct options *o, fl_err *err);

#endif
