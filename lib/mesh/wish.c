/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
#include "mesh/wish.h"

static int same(char p, char c)
{
    if (p >= 'A' && p <= 'Z') p = (char)(p - 'A' + 'a');
    if (c >= 'A' && c <= 'Z') c = (char)(c - 'A' + 'a');
    return p == c || p == '?' || (p == '_' && (c == ' ' || c == '\t'));
}

/* Only the last star is ever taken up again: what an earlier one stands for can stay as short as it is.  So
 * the time is the product of the lengths at most. */
int fl_wish_like(const char *pattern, const char *name)
{
    const char *star = NULL, *from = NULL;
    while (*name) {
        if (*pattern == '*') {
            star = ++pattern;
            from = name;
        } else if (*pattern && same(*pattern, *name)) {
            pattern++;
            name++;
        } else if (star) {
            pattern = star;
            name = ++from;
        } else {
            return 0;
        }
    }
    while (*pattern == '*') pattern++;
    return *pattern == '\0';
}

int fl_wish_takes(fl_wish *w, const char *name, fl_err *err)
{
    int like = 0;
    if (!w) return 1;
    if (w->seen && fl_names_add(w->seen, name, err) < 0) return -1;
    for (int32_t k = 0; k < w->patterns; k++)
        if (fl_wish_like(w->pattern[k], name)) {
            if (w->hit) w->hit[k] = 1;
            like = 1;
        }
    return like || w->patterns == 0;
}
