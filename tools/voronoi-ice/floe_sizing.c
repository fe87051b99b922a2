/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "ice/sizes_read.h"
#include "floe_sizing.h"

static double diameter_of(double area) { return sqrt(4.0 / PI * area); }

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct ranked {
    uint64_t number;
    int32_t i;
};

static int by_number(const void *a, const void *b)
{
    const struct ranked *p = a, *q = b;
    if (p->number != q->number) return (p->number > q->number) - (p->number < q->number);
    return (p->i > q->i) - (p->i < q->i);
}

static double concentration_of(const struct recipe *o) { return o->bonded ? 1.0 : o->concentration; }

/* Set number and concentration where the command line leaves them to the sizes. */
static int set_open_values(const struct floe_sizing *s, struct recipe *o, double area, fl_err *err)
{
    const double each = fl_sizes_mean(&s->law);
    const int list = s->law.kind == FL_SIZES_LIST;
    double n = o->floes;
    if (list && !o->has_floes && !o->has_concentration && !o->bonded) {
        const double cover = s->law.cumulative_area[s->law.n] / area;
        if (!(cover > 0.0 && cover < 1.0))
            return fl_fail(err, FL_INPUT,
                           "the sizes of %s cover %.4g of the field as they are, a part between 0 and 1 is "
                           "expected: --concentration scales them, --size gives them room",
                           o->sizes, cover);
        o->concentration = cover;
    }
    if (list && !o->has_floes) n = s->law.cumulative_count[s->law.n];
    if (s->law.kind == FL_SIZES_POWER && !o->has_floes) n = concentration_of(o) * area / each;
    if (!(n >= 0.5 && n <= FLOES_MAX))
        return fl_fail(
            err, FL_INPUT,
            "%.3g floes of these sizes would give this concentration, 1 to %d are expected: --floes "
            "scales the sizes",
            n, FLOES_MAX);
    o->floes = (int32_t)(n + 0.5);
    return 0;
}

int floe_sizing_assign(struct floe_sizing *s, struct recipe *o, double area, fl_err *err)
{
    struct ranked *rank = NULL;
    double *size = NULL;
    int rc = -1;
    s->law = o->law;
    if (o->sizes_file &&
        (recipe_check_file("sizes", o->sizes, "a law", err) || fl_sizes_read(&s->law, o->sizes, err)))
        return -1;
    if (set_open_values(s, o, area, err)) return -1;
    s->mean = concentration_of(o) * area / o->floes;
    s->factor = s->law.kind == FL_SIZES_POWER || s->law.kind == FL_SIZES_LIST
                    ? sqrt(s->mean / fl_sizes_mean(&s->law))
                    : NAN;
    s->area = fl_alloc(o->floes, sizeof *s->area, err);
    rank = fl_alloc(o->floes, sizeof *rank, err);
    size = fl_alloc(o->floes, sizeof *size, err);
    if (!s->area || !rank || !size) goto done;
    fl_sizes_areas(&s->law, o->floes, s->mean, size);
    for (int32_t i = 0; i < o->floes; i++) {
        fl_rng g = fl_rng_of(o->seed, i, FL_RNG_SIZE);
        rank[i] = (struct ranked){fl_rng_u64(&g), i};
    }
    s->min_diameter = diameter_of(size[0]);
    s->max_diameter = diameter_of(size[o->floes - 1]);
    qsort(rank, (size_t)o->floes, sizeof *rank, by_number);
    for (int32_t k = 0; k < o->floes; k++) s->area[rank[k].i] = size[k];
    rc = 0;
done:
    free(rank);
    free(size);
    return rc;
}

int floe_sizing_measure(struct floe_sizing *s, const fl_floes *floes, fl_err *err)
{
    s->achieved = fl_alloc(floes->n, sizeof *s->achieved, err);
    if (!s->achieved) return -1;
    for (int32_t i = 0; i < floes->n; i++) {
        const int32_t first = floes->first[i];
        double off;
        s->achieved[i] = fl_polygon_area(floes->first[i + 1] - first, floes->outer + first);
        off = fabs(s->achieved[i] - s->area[i]) / s->area[i];
        if (off > s->max_error) s->max_error = off;
        if (off <= FLOE_SIZING_MISSED) continue;
        s->n_missed++;
        if (s->area[i] > s->largest_missed) s->largest_missed = s->area[i];
    }
    qsort(s->achieved, (size_t)floes->n, sizeof *s->achieved, by_value);
    return 0;
}

void floe_sizing_certify(const struct floe_sizing *s, const struct recipe *o, double inset,
                         struct certificate_table *t)
{
    const double ks = fl_sizes_ks_distance(&s->law, s->mean, o->floes, s->achieved);
    const double least = diameter_of(s->achieved[0]), most = diameter_of(s->achieved[o->floes - 1]);
    certificate_add_text(t, "sizes", o->sizes, NULL);
    certificate_add(t, "sizes, distribution", NOT_REQUESTED, NOT_REQUESTED, ks, 6, "Kolmogorov-Smirnov");
    if (!isnan(s->factor))
        certificate_add(t, "sizes, factor on lengths", 1.0, s->factor, fabs(s->factor - 1.0), 6,
                        "%d floes at this concentration", o->floes);
    certificate_add(t, "sizes, worst floe, part of area", 0.0, s->max_error, s->max_error, 2, NULL);
    if (s->n_missed)
        certificate_add(t, "sizes, floes off by 1 percent", 0.0, s->n_missed, s->n_missed, 10,
                        "requested up to %.4g m, with gaps of %.4g m", diameter_of(s->largest_missed),
                        2.0 * inset);
    certificate_add(t, "diameter, smallest [m]", s->min_diameter, least, fabs(least - s->min_diameter), 6,
                    NULL);
    certificate_add(t, "diameter, largest [m]", s->max_diameter, most, fabs(most - s->max_diameter), 6, NULL);
}

void floe_sizing_free(struct floe_sizing *s)
{
    fl_sizes_free(&s->law);
    free(s->area);
    free(s->achieved);
    *s = (struct floe_sizing){0};
}
