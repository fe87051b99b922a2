/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <string.h>
#include <unistd.h>
#include "base/tool.h"

void fl_history_line_start(fl_history_line *by, const char *program)
{
    by->len = snprintf(by->text, sizeof by->text, "#by %s %s", program, FL_VERSION);
}

void fl_history_line_add(fl_history_line *by, const char *fmt, ...)
{
    va_list ap;
    int k;
    if (by->len + 2 >= FL_HISTORY_LINE_MAX) return;
    by->text[by->len++] = ' ';
    va_start(ap, fmt);
    k = vsnprintf(by->text + by->len, (size_t)(FL_HISTORY_LINE_MAX - by->len), fmt, ap);
    va_end(ap);
    by->len += k < FL_HISTORY_LINE_MAX - by->len ? k : FL_HISTORY_LINE_MAX - by->len - 1;
    for (char *p = by->text; *p; p++) /* the line stays one line, whatever a file name contains */
        if ((unsigned char)*p < ' ') *p = ' ';
}

void fl_history_line_word(fl_history_line *by, const char *option, const char *word)
{
    const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./,:=+-@%^";
    const int whole = word[0] && !word[strspn(word, plain)];
    fl_history_line_add(by, whole ? "%s%s" : "%s'%s'", option, word);
}

void fl_write_file_header(FILE *f, const char *kind, int version, const char *history,
                          const fl_history_line *by)
{
    fprintf(f, "#%s %d\n%s%s\n", kind, version, history ? history : "", by->text);
}

#if defined __clang__
#define COMPILER "clang " __clang_version__
#elif defined __GNUC__
#define COMPILER "gcc " __VERSION__
#else
#define COMPILER "an unknown compiler"
#endif

void fl_tool_version(const char *program)
{
    printf("%s %s\n%s, by %s\nGPL-3.0-or-later, without warranty\n", program, FL_VERSION, fl_tool_source,
           COMPILER);
}

void fl_tool_begin(void)
{
    signal(SIGXFSZ, SIG_IGN);
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++) {
        if (fcntl(fd, F_GETFD) >= 0 || errno != EBADF) continue;
        /* opened with the opposite access: reads and writes fail with EBADF, as on a closed descriptor */
        const int filled = open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
        if (filled >= 0 && filled != fd) close(filled); /* a lower descriptor could not be filled */
    }
}

int fl_tool_end(const char *program, int rc, fl_err *err)
{
    errno = 0;
    if (fflush(stdout) != 0 || ferror(stdout))
        rc = fl_fail(err, FL_SYSTEM, "<stdout>: %s", errno ? strerror(errno) : "could not write all of it");
    if (rc == 0) return FL_DONE;
    if (err->text[0]) fprintf(stderr, "%s: %s\n", program, err->text);
    return err->code ? err->code : FL_SYSTEM;
}
