/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_end.h"
#include <stdio.h>
#include <string.h>

const char *run_end_text(enum fl_run_end end, const char *why, char text[RUN_END_NOTE])
{
    if (end == FL_RUN_STOPPED) snprintf(text, RUN_END_NOTE, "its run stopped early, with status %s", why);
    else
        snprintf(text, RUN_END_NOTE,
                 "the table has no closing report: its run was killed, or it still goes on");
    return text;
}

int run_end_check(const char *path, enum fl_run_end end, const char *why, const struct options *o,
                  fl_err *err)
{
    char text[RUN_END_NOTE];
    if (end == FL_RUN_ENDED) return 0;
    run_end_text(end, why, text);
    if (!o->force && (o->files > 1 || o->merge))
        return fl_fail(err, FL_INPUT,
                       "%s: %s; a record cut short is no sample of its case: leave it out, or count it with "
                       "--force",
                       path, text);
    fprintf(stderr, "loadstats: warning: %s: %s\n", path, text);
    return 0;
}

int run_end_check_history(const char *path, const char *history, const struct options *o, fl_err *err)
{
    static const char STOPPED[] = "#stopped ";
    char why[FL_RUN_END_TEXT];
    for (const char *p = history; p && *p; p = strchr(p, '\n') + 1) {
        if (strncmp(p, STOPPED, strlen(STOPPED)) != 0) continue;
        p += strlen(STOPPED);
        snprintf(why, sizeof why, "%.*s", (int)strcspn(p, "\n"), p);
        return run_end_check(path, FL_RUN_STOPPED, why, o, err);
    }
    return 0;
}
