/* SPDX-License-Identifier: GPL-3.0-or-later */
/* page_text.h -- the page of page.h behind its data: style, controls, and a script that unpacks, plays and
 * draws by WebGL 2.  It needs nothing from elsewhere. */
#ifndef FL_VIEW_PAGE_TEXT_H
#define FL_VIEW_PAGE_TEXT_H

extern const char *const fl_page_text[]; /* lines, ends with NULL */

#endif
