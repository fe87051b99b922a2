/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include "stat/signal_view.h"
#include "settings.h"

const char *sample_name(enum sample s)
{
    static const char *const name[] = {"peaks", "pot", "blocks", "runs"};
    return name[s];
}

int settings_many_runs(const struct options *o) { return o->merge || o->stream; }

void settings_filter_text(const struct options *o, char *text, size_t size)
{
    if (o->filter_kind == FL_FILTER_LOW) snprintf(text, size, "%g Hz", o->filter);
    else if (o->filter_kind == FL_FILTER_HIGH) snprintf(text, size, "above %g Hz", o->filter);
    else if (o->filter_kind == FL_FILTER_BAND) snprintf(text, size, "%g to %g Hz", o->filter, o->upper);
    else snprintf(text, size, "mean of %g s", o->filter);
}

double settings_from(const struct options *o)
{
    if (!o->skips || isnan(o->skip[2])) return o->from;
    return fmax(o->from, (o->skip[2] + o->skip[0] * o->skip[1]) / o->speed);
}

double settings_after_first_load(const struct options *o)
{
    return o->skips && isnan(o->skip[2]) ? o->skip[0] * o->skip[1] / o->speed : 0.0;
}
