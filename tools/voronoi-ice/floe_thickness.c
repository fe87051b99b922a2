/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/parallel.h"
#include "floe_thickness.h"

int floe_thickness_read(struct floe_thickness *d, struct recipe *o, fl_err *err)
{
    fl_err why = {0};
    int32_t redraws;
    d->draft_ratio = o->ice_density / o->water_density;
    if (fl_thickness_parse(&d->law, o->thickness_law, &why)) {
        if (why.code == FL_INPUT && recipe_check_file("thickness", o->thickness_law, "metres, a law", err))
            return -1;
        return why.code == FL_USAGE ? fl_fail(err, FL_USAGE, "--thickness: %s", why.text)
                                    : fl_fail(err, why.code, "%s", why.text);
    }
    if (d->law.kind == FL_THICKNESS_CONSTANT) {
        o->thickness = d->max = d->law.a;
        if (o->thickness > 2.0 * o->radius) return 0;
        return fl_fail(err, FL_USAGE, "--thickness %g is not more than twice --radius %g: no core is left",
                       o->thickness, o->radius);
    }
    d->min = 2.0 * (1.0 + FL_THICKNESS_MIN_CORE) * o->radius;
    if (fl_thickness_cdf(&d->law, d->min, INFINITY) < 0.5 ||
        fl_thickness_draw(&d->law, o->seed, 0, d->min, &redraws) == 0.0)
        return fl_fail(
            err, FL_INPUT,
            "--thickness %.60s has less than half of its floes above %g m, which a dilation radius "
            "of %g m needs",
            o->thickness_law, d->min, o->radius);
    for (int32_t id = 0; id < 2 * (int64_t)o->floes && id < FLOES_MAX; id++)
        d->max = fmax(d->max, floe_thickness_at(d, o, id));
    return 0;
}

double floe_thickness_at(const struct floe_thickness *d, const struct recipe *o, int32_t id)
{
    int32_t redraws;
    return d->law.kind == FL_THICKNESS_CONSTANT ? d->law.a
                                                : fl_thickness_draw(&d->law, o->seed, id, d->min, &redraws);
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int floe_thickness_measure(struct floe_thickness *d, const struct recipe *o, int32_t n, const int32_t *id,
                           const double *area, fl_err *err)
{
    double *h = fl_alloc(n, sizeof *h, err), *volume = fl_alloc(n, sizeof *volume, err);
    if (h && volume) {
        d->redraws = 0;
        for (int32_t i = 0; i < n; i++) {
            int32_t redraws = 0;
            h[i] = d->law.kind == FL_THICKNESS_CONSTANT
                       ? d->law.a
                       : fl_thickness_draw(&d->law, o->seed, id[i], d->min, &redraws);
            d->redraws += redraws;
            volume[i] = h[i] * area[i];
        }
        d->n = n;
        d->volume = fl_parallel_sum(volume, n);
        d->mean = fl_parallel_sum(h, n) / n;
        qsort(h, (size_t)n, sizeof *h, by_value);
        d->smallest = h[0];
        d->largest = h[n - 1];
        d->ks_distance = fl_thickness_ks_distance(&d->law, d->min, n, h);
    }
    free(h);
    free(volume);
    return h && volume ? 0 : -1;
}

void floe_thickness_certify(const struct floe_thickness *d, const struct recipe *o,
                            struct certificate_table *t)
{
    if (d->law.kind == FL_THICKNESS_CONSTANT) {
        certificate_add(t, "draft [m]", NOT_REQUESTED, o->thickness * d->draft_ratio, NO_DISTANCE, 6, NULL);
        return;
    }
    certificate_add_text(t, "thickness", o->thickness_law, NULL);
    certificate_add(t, "thickness, distribution", NOT_REQUESTED, NOT_REQUESTED, d->ks_distance, 6,
                    "Kolmogorov-Smirnov");
    certificate_add(t, "thickness, mean [m]", NOT_REQUESTED, d->mean, NO_DISTANCE, 6, NULL);
    certificate_add(t, "thickness, smallest [m]", NOT_REQUESTED, d->smallest, NO_DISTANCE, 6, NULL);
    certificate_add(t, "thickness, largest [m]", NOT_REQUESTED, d->largest, NO_DISTANCE, 6, NULL);
    if (d->redraws)
        certificate_add(t, "numbers drawn again: too thin", NOT_REQUESTED, (double)d->redraws, NO_DISTANCE,
                        10, NULL);
    certificate_add(t, "draft, largest [m]", NOT_REQUESTED, d->largest * d->draft_ratio, NO_DISTANCE, 6,
                    NULL);
    certificate_add(t, "volume of ice [m3]", NOT_REQUESTED, d->volume, NO_DISTANCE, 6, NULL);
}

void floe_thickness_free(struct floe_thickness *d)
{
    fl_thickness_free(&d->law);
    *d = (struct floe_thickness){0};
}
