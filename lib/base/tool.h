/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tool.h -- what every program does the same way: begin, version, history line, end. */
#ifndef FL_BASE_TOOL_H
#define FL_BASE_TOOL_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"

#define FL_VERSION "0.1.0"

enum { FL_HISTORY_LINE_MAX = 2000 };

/* The history line of this run, "#by PROGRAM VERSION OPTIONS\n".  Start it, add what bears on the result. */
typedef struct {
    char text[FL_HISTORY_LINE_MAX];
    int len;
} fl_history_line;
void fl_history_line_start(fl_history_line *by, const char *program);
/* Adds a blank first. */
void fl_history_line_add(fl_history_line *by, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
/* The option, "--ice " or "", and a word of the user's, in quotes where a shell would cut it. */
void fl_history_line_word(fl_history_line *by, const char *option, const char *word);

/* Open a file of ours: "#KIND VERSION", the history it continues (NULL for none), its own line. */
void fl_write_file_header(FILE *f, const char *kind, int version, const char *history,
                          const fl_history_line *by);

/* Print "program 0.1.0" to standard output, for --version. */
void fl_tool_version(const char *program);

/* Begin of main, before any file is opened: where standard input, output or error is closed, its number is
 * given to something that fails alike, so that no file gets it and is written to in its place; and a file
 * that grows beyond its limit (ulimit -f) is a write that fails, not the end of the program. */
void fl_tool_begin(void);

/* End of main: flush standard output, say "program: sentence" on stderr if anything failed, and return the
 * exit status: 0, or the code in err.  A run that succeeded but could not write its output ends in
 * FL_SYSTEM. */
int fl_tool_end(const char *program, int rc, fl_err *err);

#endif
