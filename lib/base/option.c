/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/option.h"
#include "base/number_text.h"

int fl_option_unknown(const char *program, const struct option *known, int c, int letter, const char *word,
                      fl_err *err)
{
    if (c == ':') return fl_fail(err, FL_USAGE, "%.60s needs a value, see %s --help", word, program);
    if (!letter) return fl_fail(err, FL_USAGE, "%.60s is no option, see %s --help", word, program);
    for (; known->name; known++)
        if (known->val == letter)
            return fl_fail(err, FL_USAGE, "%.60s: that option takes no value, see %s --help", word, program);
    return fl_fail(err, FL_USAGE, "-%c is no option, see %s --help", letter, program);
}

int fl_option_whole(const char *option, const char *text, int32_t lo, int32_t hi, int32_t *x, fl_err *err)
{
    if (fl_number_i32(text, lo, hi, x) == 0) return 0;
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", a whole number from %d to %d is expected", option, text,
                   lo, hi);
}
