/* SPDX-License-Identifier: GPL-3.0-or-later */
/* page.h -- the report: one HTML page that needs no other file. */
#ifndef LOADSTATS_PAGE_H
#define LOADSTATS_PAGE_H
#include "statrows.h"

/* Write o->report: the table stats, the laws that fit the peaks, return levels where --return asks for them,
 * the table of --table where it is another, the pictures of plot() as inline SVG, and the "#by" lines from
 * which all of it can be made again.  Numbers are rounded to six digits.  The pictures are drawn in a folder
 * of TMPDIR that is removed again. 0, or -1 with the errors of plot() or FL_SYSTEM in err. */
int page_write(const struct result *r, const struct options *o, fl_err *err);

#endif
