/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/number_text.h"
#include "cell.h"

const char *view_name(int w) { return w ? "filtered" : "raw"; }

const fl_signal_view *find_view(const struct record_views *r, int32_t part, int32_t signal, int w)
{
    const fl_signal_view *v = &r->views[((int64_t)part * r->series->signals + signal) * r->view_count + w];
    return v->n ? v : NULL;
}

static int digits = LEAST_DIGITS;

void write_digits(int n) { digits = n; }

void write_number(FILE *f, double x)
{
    char buf[FL_NUMBER_LEN];
    double again = NAN;
    if (!isfinite(x)) {
        putc('-', f);
        return;
    }
    snprintf(buf, sizeof buf, "%.*g", SHORT_DIGITS, x + 0.0);
    if (fl_number_f64(buf, &again) || again != x) {
        snprintf(buf, sizeof buf, "%.*g", digits, x);
        /* 1.23457e+06 as 1234570 */
        if (digits <= SHORT_DIGITS && fl_number_f64(buf, &again) == 0)
            snprintf(buf, sizeof buf, "%.*g", SHORT_DIGITS, again);
    }
    fputs(digits == ALL_DIGITS ? fl_number_text(x, buf) : buf, f);
}

void write_cell(FILE *f, double x)
{
    putc('\t', f);
    write_number(f, x);
}

void write_labels(FILE *f, const struct record_views *r, int32_t part, int32_t signal, int w)
{
    const char *unit = r->series->unit[signal];
    fprintf(f, "%s\t%s\t%s\t%s", r->series->part[part], r->series->signal[signal], unit[0] ? unit : "-",
            view_name(w));
}
