/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ridge.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/stream.h"
#include "block_field.h"

enum { BLOCKS_MOST = 1000000 };

/* --- regions -------------------------------------------------------------------------------------------- */

/* Extrude a cross-section along the line from x[0..1] to x[2..3].  The section has corners (s, z) with s
 * to the left of the line, counter-clockwise as seen against its direction. */
static int extrude(fl_poly *p, const double *x, int32_t n, const fl_vec2 *section, fl_err *err)
{
    const double l = hypot(x[2] - x[0], x[3] - x[1]), ux = (x[2] - x[0]) / l, uy = (x[3] - x[1]) / l;
    fl_vec3 v[8];
    int32_t first[7] = {0, n, 2 * n}, loop[24];
    for (int32_t k = 0; k < n; k++) {
        v[k] = v3(x[0] - section[k].x * uy, x[1] + section[k].x * ux, section[k].y);
        v[n + k] = v3(x[2] - section[k].x * uy, x[3] + section[k].x * ux, section[k].y);
        loop[k] = n - 1 - k;
        loop[n + k] = n + k;
    }
    for (int32_t k = 0; k < n; k++) {
        const int32_t at = 2 * n + 4 * k, next = (k + 1) % n;
        loop[at] = k;
        loop[at + 1] = next;
        loop[at + 2] = n + next;
        loop[at + 3] = n + k;
        first[3 + k] = at + 4;
    }
    return fl_poly_make(p, 2 * n, v, n + 2, first, loop, err);
}

/* Number of blocks of that size in the region, or -1 with FL_INPUT if it is too large. */
static int32_t count_blocks(const fl_poly *region, double block, fl_err *err)
{
    const double n = fmax(1.0, floor(fl_blocks_volume(region) / (block * block * block) + 0.5));
    if (n <= BLOCKS_MOST) return (int32_t)n;
    return fl_fail(err, FL_INPUT, "%.4g blocks of %g m are too many, %d at most are expected", n, block,
                   BLOCKS_MOST);
}

static int make_part(struct ridges *p, const struct recipe *o, const double *x, int32_t n,
                     const fl_vec2 *section, const char *what, fl_err *err)
{
    fl_blocks *b = &p->part[p->n];
    fl_poly region = {0};
    fl_err why = {0};
    int64_t pairs;
    int rc = -1;
    if (extrude(&region, x, n, section, &why)) goto done;
    const int32_t many = count_blocks(&region, o->block, &why);
    if (many < 0 ||
        fl_blocks_cells(b, &region, many, o->seed, (p->n + 1) * BLOCK_FIELD_FIRST_SITE, o->smooth, &why))
        goto done;
    p->n++;
    if (fl_blocks_shrink(b, 1.0 - o->porosity, o->radius, &why) ||
        fl_blocks_overlaps(b, o->radius, &pairs, &why))
        goto done;
    p->overlaps += pairs;
    rc = 0;
done:
    if (rc) fl_fail(err, why.code, "the %s of the ridge: %s", what, why.text);
    fl_poly_free(&region);
    return rc;
}

static void strip_of(const double *x, fl_vec2 *v)
{
    const double l = hypot(x[2] - x[0], x[3] - x[1]), half = 0.5 * fmax(x[5], x[7]);
    const double nx = -half * (x[3] - x[1]) / l, ny = half * (x[2] - x[0]) / l;
    v[0] = (fl_vec2){x[0] - nx, x[1] - ny};
    v[1] = (fl_vec2){x[2] - nx, x[3] - ny};
    v[2] = (fl_vec2){x[2] + nx, x[3] + ny};
    v[3] = (fl_vec2){x[0] + nx, x[1] + ny};
}

/* Check that the strips of all ridges are apart; their blocks are apart then. */
static int check_apart(const struct recipe *o, fl_err *err)
{
    fl_vec2 a[4], b[4];
    for (int i = 0; i < o->ridges; i++)
        for (int j = 0; j < i; j++) {
            strip_of(o->ridge[i], a);
            strip_of(o->ridge[j], b);
            if (!fl_polygon_is_apart(4, a, 4, b))
                return fl_fail(err, FL_INPUT, "ridges %d and %d meet, ridges that are apart are expected",
                               j + 1, i + 1);
        }
    return 0;
}

int ridges_make(struct ridges *p, const struct recipe *o, fl_err *err)
{
    if (check_apart(o, err)) return -1;
    for (int k = 0; k < o->ridges; k++) {
        const double *x = o->ridge[k], hs = x[4], ws = 0.5 * x[5], hk = x[6], wk = 0.5 * x[7],
                     wb = 0.5 * x[8];
        const fl_vec2 sail[3] = {{-ws, 0.0}, {ws, 0.0}, {0.0, hs}};
        const fl_vec2 sharp[3] = {{-wk, 0.0}, {0.0, -hk}, {wk, 0.0}};
        const fl_vec2 blunt[4] = {{-wk, 0.0}, {-wb, -hk}, {wb, -hk}, {wk, 0.0}};
        if (make_part(p, o, x, 3, sail, "sail", err) ||
            make_part(p, o, x, wb > 0.0 ? 4 : 3, wb > 0.0 ? blunt : sharp, "keel", err))
            return -1;
    }
    if (p->overlaps == 0) return 0;
    return fl_fail(err, FL_NUMERIC, "%lld pairs of blocks overlap: nothing is written",
                   (long long)p->overlaps);
}

/* --- the field ------------------------------------------------------------------------------------------ */

int ridges_add(const struct ridges *p, const struct recipe *o, fl_ice_field *out, fl_err *err)
{
    int64_t id = 0;
    for (int32_t i = 0; i < out->n; i++)
        if (out->id[i] >= id) id = (int64_t)out->id[i] + 1;
    for (int k = 0; k < p->n; k++)
        if (block_field_add(&p->part[k], o, &id, v3(0, 0, 0), out, err)) return -1;
    return 0;
}

/* --- the certificate ------------------------------------------------------------------------------------ */

void ridges_certify(const struct ridges *p, const struct recipe *o, struct certificate_table *t)
{
    double region = 0.0, solid = 0.0, keel = 0.0;
    int32_t blocks = 0, lost = 0;
    if (!p->n) return;
    for (int k = 0; k < p->n; k++) {
        region += p->part[k].region_volume;
        solid += p->part[k].solid_volume;
        if (k % 2) keel += p->part[k].solid_volume;
        blocks += p->part[k].n - p->part[k].blockless;
        lost += p->part[k].blockless;
    }
    certificate_add(t, "ridges, blocks", NOT_REQUESTED, blocks, NO_DISTANCE, 10, NULL);
    if (lost) certificate_add(t, "ridges, cells without a block", NOT_REQUESTED, lost, NO_DISTANCE, 10, NULL);
    certificate_add(t, "ridges, porosity", o->porosity, 1.0 - solid / region,
                    fabs(1.0 - solid / region - o->porosity), 8, NULL);
    certificate_add(t, "ridges, overlaps", 0, (double)p->overlaps, (double)p->overlaps, 10, NULL);
    certificate_add(t, "ridges, ice [m3]", NOT_REQUESTED, solid, NO_DISTANCE, 6, NULL);
    certificate_add(t, "ridges, weight over buoyancy", 1, o->ice_density * solid / (o->water_density * keel),
                    fabs(o->ice_density * solid / (o->water_density * keel) - 1.0), 6, NULL);
}

void ridges_free(struct ridges *p)
{
    for (int k = 0; k < p->n; k++) fl_blocks_free(&p->part[k]);
    *p = (struct ridges){0};
}
