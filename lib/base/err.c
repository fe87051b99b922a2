/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include "base/err.h"

int fl_fail(fl_err *err, int code, const char *fmt, ...)
{
    if (err->code == 0) {
        va_list ap;
        va_start(ap, fmt);
        err->code = code;
        vsnprintf(err->text, sizeof err->text, fmt, ap);
        va_end(ap);
        for (char *p = err->text; *p; p++) /* the text may quote a file, and a file may hold any byte */
            if ((unsigned char)*p < ' ' || *p == 127) *p = '?';
    }
    return -1;
}
