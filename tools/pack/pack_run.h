/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_run.h -- the run of pack: region, bodies, throwing, growth, rest, certificate, files. */
#ifndef PACK_PACK_RUN_H
#define PACK_PACK_RUN_H
#include "options.h"

/* -1 with an error; FL_NO where the bodies jam before the porosity that was asked: all files are written
 * then. */
int pack_run(const struct options *o, fl_err *err);

#endif
