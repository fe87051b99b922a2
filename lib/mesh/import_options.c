/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
#include "mesh/import_options.h"

static int same_char(char p, char c)
{
    if (p >= 'A' && p <= 'Z') p = (char)(p - 'A' + 'a');
    if (c >= 'A' && c <= 'Z') c = (char)(c - 'A' + 'a');
    return p == c || p == '?' || (p == '_' && (c == ' ' || c == '\t'));
}

/* Backtracking to the last star is enough: an earlier star can stay as short as it is.  The time is at most
 * the product of the two lengths. */
int fl_pattern_matches(const char *pattern, const char *name)
{
    const char *last_star = NULL, *from = NULL;
    while (*name) {
        if (*pattern == '*') {
            last_star = ++pattern;
            from = name;
        } else if (*pattern && same_char(*pattern, *name)) {
            pattern++;
            name++;
        } else if (last_star) {
            pattern = last_star;
            name = ++from;
        } else {
            return 0;
        }
    }
    while (*pattern == '*') pattern++;
    return *pattern == '\0';
}

int fl_import_selects(fl_import_options *opt, const char *name, fl_err *err)
{
    int like = 0;
    if (!opt) return 1;
    if (opt->available && fl_string_table_add(opt->available, name, err) < 0) return -1;
    for (int32_t k = 0; k < opt->patterns; k++)
        if (fl_pattern_matches(opt->pattern[k], name)) {
            if (opt->matched) opt->matched[k] = 1;
            like = 1;
        }
    return like || opt->patterns == 0;
}
