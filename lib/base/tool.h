/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tool.h -- common parts of all programs: start, version, history line, end. */
#ifndef FL_BASE_TOOL_H
#define FL_BASE_TOOL_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"

#define FL_VERSION "0.1.0"

enum { FL_HISTORY_LINE_MAX = 2000 };

/* The history line of a run, "#by PROGRAM VERSION OPTIONS\n".  Add all options that affect the result. */
typedef struct {
    char text[FL_HISTORY_LINE_MAX];
    int len;
} fl_history_line;
void fl_history_line_start(fl_history_line *by, const char *program);
/* Appends a blank and the text. */
void fl_history_line_add(fl_history_line *by, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
/* Appends an option, "--ice " or "", and a user's word, quoted where a shell would split it. */
void fl_history_line_word(fl_history_line *by, const char *option, const char *word);

/* Writes the head of a file: "#KIND VERSION", the history that it continues (NULL for none), the own line. */
void fl_write_file_header(FILE *f, const char *kind, int version, const char *history,
                          const fl_history_line *by);

/* Where the sources come from: "commit 0123456789ab".  The build links its own into the programs; the
 * library's is "unknown commit". */
extern const char fl_tool_source[];

/* Prints the version, the source, the compiler and the licence to standard output, for --version. */
void fl_tool_version(const char *program);

/* Start of main, before any file is opened.  A closed standard input, output or error is replaced by a
 * descriptor that fails in the same way, so that no file gets its number.  A file beyond its size limit
 * (ulimit -f) becomes a failed write instead of the end of the program. */
void fl_tool_begin(void);

/* End of main: flushes standard output, prints "program: message" to stderr if anything failed, and returns
 * the exit status: 0, or the code in err.  A run that could not write its output ends with FL_SYSTEM. */
int fl_tool_end(const char *program, int rc, fl_err *err);

#endif
