/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "measure.h"
#include <stdio.h>
#include <string.h>
#include "base/option.h"

/* The numbers of a text without its unit, which consists of letters, '/', '^' and digits behind them; and the
 * unit, "" for none.  What is no unit of the kind stays with the numbers, as the e3 of 1e3. */
static int split_unit(const char *text, enum fl_unit_kind kind, char *numbers, size_t size, const char **unit)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
    size_t at = strlen(text), end = at;
    double one = 1.0;
    for (size_t k = at; k > 0 && (strchr(letters, text[k - 1]) || strchr("/^23", text[k - 1])); k--)
        if (strchr(letters, text[k - 1])) at = k - 1;
    if (text[at] && fl_unit_convert(kind, text + at, &one)) at = end;
    for (end = at; end > 0 && text[end - 1] == ' '; end--) {}
    if (end >= size) return -1;
    memcpy(numbers, text, end);
    numbers[end] = '\0';
    *unit = text + at;
    return 0;
}

int measure_read(const char *option, const char *text, char divide, int n, enum fl_unit_kind kind, double lo,
                 double hi, const char *expected, double *x, fl_err *err)
{
    char numbers[320], units[200];
    const char *unit;
    fl_err why = {0};
    int count,
        bad = split_unit(text, kind, numbers, sizeof numbers, &unit) ||
              fl_option_numbers(option, numbers, divide, n, n, -1e300, 1e300, expected, x, &count, &why);
    for (int k = 0; k < n && !bad; k++)
        bad = (*unit && fl_unit_convert(kind, unit, &x[k])) || !(x[k] >= lo && x[k] <= hi);
    if (!bad) return 0;
    return fl_fail(err, FL_USAGE, "--%s is \"%.60s\", expected %s, or with one of %s", option, text, expected,
                   fl_unit_list(kind, units, sizeof units));
}

int measure_law(const char *text, char law[MEASURE_LAW_LEN])
{
    static const char *const words[] = {"uniform:", "lognormal:", ""};
    char numbers[64], first[FL_NUMBER_LEN], second[FL_NUMBER_LEN];
    const char *unit;
    int kind = 0, n;
    double x[2];
    fl_err none = {0};
    while (strncmp(text, words[kind], strlen(words[kind])) != 0) kind++;
    if (split_unit(text + strlen(words[kind]), FL_UNIT_LENGTH, numbers, sizeof numbers, &unit) || !*unit)
        return -1;
    if (fl_option_numbers("", numbers, ',', kind < 2 ? 2 : 1, kind < 2 ? 2 : 1, -1e300, 1e300, "", x, &n,
                          &none) ||
        fl_unit_convert(FL_UNIT_LENGTH, unit, &x[0]) ||
        (kind == 0 && fl_unit_convert(FL_UNIT_LENGTH, unit, &x[1])))
        return -1;
    snprintf(law, MEASURE_LAW_LEN, "%s%s%s%s", words[kind], fl_number_text(x[0], first), kind < 2 ? "," : "",
             kind < 2 ? fl_number_text(x[1], second) : "");
    return 0;
}
