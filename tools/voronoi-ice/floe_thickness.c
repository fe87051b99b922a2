/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/parallel.h"
#include "floe_thickness.h"

int depth_make(struct depth *d, struct options *o, fl_err *err)
{
    fl_err why = {0};
    int32_t again;
    d->ratio = o->ice_density / o->water_density;
    if (fl_thickness_parse(&d->law, o->thickness_law, &why)) {
        if (why.code == FL_INPUT && options_there("thickness", o->thickness_law, "metres, a law", err))
            return -1;
        return why.code == FL_USAGE ? fl_fail(err, FL_USAGE, "--thickness: %s", why.text)
                                    : fl_fail(err, why.code, "%s", why.text);
    }
    if (d->law.kind == FL_THICKNESS_CONSTANT) {
        o->thickness = d->most = d->law.a;
        if (o->thickness > 2.0 * o->radius) return 0;
        return fl_fail(err, FL_USAGE, "--thickness %g is not more than twice --radius %g: no core is left",
                       o->thickness, o->radius);
    }
    d->least = 2.0 * (1.0 + FL_THICKNESS_MIN_CORE) * o->radius;
    if (fl_thickness_cdf(&d->law, d->least, INFINITY) < 0.5 ||
        fl_thickness_draw(&d->law, o->seed, 0, d->least, &again) == 0.0)
        return fl_fail(
            err, FL_INPUT,
            "--thickness %.60s has less than half of its floes above %g m, which a dilation radius "
            "of %g m needs",
            o->thickness_law, d->least, o->radius);
    for (int32_t id = 0; id < 2 * (int64_t)o->floes && id < FLOES_MOST; id++)
        d->most = fmax(d->most, depth_of(d, o, id));
    return 0;
}

double depth_of(const struct depth *d, const struct options *o, int32_t id)
{
    int32_t again;
    return d->law.kind == FL_THICKNESS_CONSTANT ? d->law.a
                                                : fl_thickness_draw(&d->law, o->seed, id, d->least, &again);
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int depth_measure(struct depth *d, const struct options *o, int32_t n, const int32_t *id, const double *area,
                  fl_err *err)
{
    double *h = fl_alloc(n, sizeof *h, err), *volume = fl_alloc(n, sizeof *volume, err);
    if (h && volume) {
        d->again = 0;
        for (int32_t i = 0; i < n; i++) {
            int32_t again = 0;
            h[i] = d->law.kind == FL_THICKNESS_CONSTANT
                       ? d->law.a
                       : fl_thickness_draw(&d->law, o->seed, id[i], d->least, &again);
            d->again += again;
            volume[i] = h[i] * area[i];
        }
        d->n = n;
        d->volume = fl_parallel_sum(volume, n);
        d->mean = fl_parallel_sum(h, n) / n;
        qsort(h, (size_t)n, sizeof *h, ascending);
        d->thin = h[0];
        d->thick = h[n - 1];
        d->distance = fl_thickness_ks_distance(&d->law, d->least, n, h);
    }
    free(h);
    free(volume);
    return h && volume ? 0 : -1;
}

void depth_certify(const struct depth *d, const struct options *o, struct certify *t)
{
    if (d->law.kind == FL_THICKNESS_CONSTANT) {
        certify_add(t, "draft [m]", NOT_ASKED, o->thickness * d->ratio, NO_DISTANCE, 6, NULL);
        return;
    }
    certify_add_word(t, "thickness", o->thickness_law, NULL);
    certify_add(t, "thickness, distribution", NOT_ASKED, NOT_ASKED, d->distance, 6, "Kolmogorov-Smirnov");
    certify_add(t, "thickness, mean [m]", NOT_ASKED, d->mean, NO_DISTANCE, 6, NULL);
    certify_add(t, "thickness, smallest [m]", NOT_ASKED, d->thin, NO_DISTANCE, 6, NULL);
    certify_add(t, "thickness, largest [m]", NOT_ASKED, d->thick, NO_DISTANCE, 6, NULL);
    if (d->again)
        certify_add(t, "numbers drawn again: too thin", NOT_ASKED, (double)d->again, NO_DISTANCE, 10, NULL);
    certify_add(t, "draft, largest [m]", NOT_ASKED, d->thick * d->ratio, NO_DISTANCE, 6, NULL);
    certify_add(t, "volume of ice [m3]", NOT_ASKED, d->volume, NO_DISTANCE, 6, NULL);
}

void depth_free(struct depth *d)
{
    fl_thickness_free(&d->law);
    *d = (struct depth){0};
}
