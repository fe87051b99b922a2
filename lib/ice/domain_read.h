/* SPDX-License-Identifier: GPL-3.0-or-later */
/* domain_read.h -- an outline from a file: a basin, a channel, a coast. */
#ifndef FL_ICE_DOMAIN_READ_H
#define FL_ICE_DOMAIN_READ_H
#include "ice/domain.h"

/* Read rings of corners, rows "x y" [m], with a blank line or a row ">" between two rings.  A first row
 * "x[m] y[m]" may name the columns, and the last corner of a ring may repeat the first.  The first ring is
 * the outline, the others are holes. "-" is standard input, gzip is unpacked.
 *    d  zeroed; fl_domain_build() has to follow
 * Returns 0, or -1 with FL_INPUT (file and line: a word that is no number, a ring with fewer than three
 * corners or that crosses itself, no ring at all) or FL_SYSTEM; d is zeroed then. */
int fl_domain_read(fl_domain *d, const char *path, fl_err *err);

#endif
