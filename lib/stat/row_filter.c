/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "stat/row_filter.h"

int fl_row_filter_make(fl_row_filter *w, const fl_table *t, const char *const *text, int32_t n, fl_err *err)
{
    *w = (fl_row_filter){0};
    if (n > FL_ROW_FILTER_MAX)
        return fl_fail(err, FL_USAGE, "expected at most %d conditions", FL_ROW_FILTER_MAX);
    for (int32_t k = 0; k < n; k++) {
        const char *equal = strchr(text[k], '=');
        char name[80];
        const size_t len = equal ? (size_t)(equal - text[k]) : sizeof name;
        if (len == 0 || len >= sizeof name || equal[1] == '\0')
            return fl_fail(err, FL_USAGE, "\"%.60s\" is not a condition, expected COLUMN=WORD", text[k]);
        memcpy(name, text[k], len);
        name[len] = '\0';
        if (fl_table_require(t, name, &w->col[k], err)) return -1;
        w->word[k] = equal + 1;
    }
    w->n = n;
    return 0;
}

int fl_row_filter_matches(const fl_row_filter *w, const fl_table *t)
{
    for (int32_t k = 0; k < w->n; k++)
        if (strcmp(fl_table_word(t, w->col[k]), w->word[k]) != 0) return 0;
    return 1;
}
