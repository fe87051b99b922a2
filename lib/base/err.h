/* SPDX-License-Identifier: GPL-3.0-or-later */
/* err.h -- error record: a code, which is also the exit status, and a one-line message. */
#ifndef FL_BASE_ERR_H
#define FL_BASE_ERR_H

enum { FL_DONE = 0, FL_NO = 1, FL_USAGE = 2, FL_INPUT = 3, FL_SYSTEM = 4, FL_NUMERIC = 5 };

typedef struct {
    int code; /* 0: no failure so far */
    char text[600];
} fl_err;

/* Records a failure.  Only the first failure is kept.
 *   code  FL_NO .. FL_NUMERIC
 *   fmt   one sentence without a full stop; fl_tool_end() puts the program's name before it.  Control
 *         characters in quoted text become "?", so that the message stays one line
 * Returns -1, so that "return fl_fail(...)" ends a function. */
int fl_fail(fl_err *err, int code, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

#endif
