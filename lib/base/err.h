/* SPDX-License-Identifier: GPL-3.0-or-later */
/* err.h -- what went wrong: a code, which is also the exit status, and one sentence. */
#ifndef FL_BASE_ERR_H
#define FL_BASE_ERR_H

enum { FL_DONE = 0, FL_NO = 1, FL_USAGE = 2, FL_INPUT = 3, FL_SYSTEM = 4, FL_NUMERIC = 5 };

typedef struct {
    int code; /* 0 while nothing has failed */
    char text[600];
} fl_err;

/* Record a failure, unless one is recorded already: the first failure is the one told.
 *   code  FL_NO .. FL_NUMERIC
 *   fmt   one sentence without a full stop; the program's name is put before it by fl_tool_end().  Control
 *         characters in what it quotes become "?": the sentence stays one line
 * Returns -1, so that "return fl_fail(...)" ends a function. */
int fl_fail(fl_err *err, int code, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

#endif
