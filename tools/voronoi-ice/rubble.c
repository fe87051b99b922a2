/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rubble.h"
#include <math.h>
#include "base/stream.h"
#include "block_field.h"
#include "certificate_table.h"
#include "floe_thickness.h"

void rubble_history(const struct recipe *o, fl_history_line *by)
{
    recipe_history_floes(o, by);
    fl_history_line_add(by, "--rubble");
}

static void add_certificate_rows(const struct recipe *o, const fl_blocks *b, double draft,
                                 struct certificate_table *t)
{
    certificate_add(t, "blocks", o->floes, b->n - b->blockless, b->blockless, 10, NULL);
    certificate_add(t, "solid part", o->concentration, b->solid_volume / b->region_volume,
                    fabs(b->solid_volume / b->region_volume - o->concentration), 8, NULL);
    certificate_add(t, "overlaps", 0, 0, 0, 10, NULL);
    certificate_add(t, "draft [m]", NOT_REQUESTED, draft, NO_DISTANCE, 6, NULL);
    certificate_add(t, "block, mean volume [m3]", NOT_REQUESTED, b->solid_volume / (b->n - b->blockless),
                    NO_DISTANCE, 6, NULL);
    certificate_add(t, "inset of the cells [m]", NOT_REQUESTED, b->inset, NO_DISTANCE, 6, NULL);
}

static int read_constant_thickness(struct recipe *o, fl_err *err)
{
    struct floe_thickness thickness = {0};
    int rc = floe_thickness_read(&thickness, o, err);
    if (rc == 0 && thickness.law.kind != FL_THICKNESS_CONSTANT)
        rc = fl_fail(err, FL_USAGE, "--rubble needs one thickness, not a law");
    floe_thickness_free(&thickness);
    return rc;
}

static int make_blocks(struct recipe *o, fl_err *err)
{
    const double draft = o->thickness * (o->ice_density / o->water_density);
    const fl_vec3 middle = {o->origin.x + 0.5 * o->size.x, o->origin.y + 0.5 * o->size.y,
                            0.5 * o->thickness - draft};
    struct certificate_table table = {0};
    fl_poly region = {0};
    fl_blocks b = {0};
    fl_ice_field out = {0};
    fl_out file = {0};
    fl_history_line by;
    int64_t pairs, id = 0;
    int rc = -1;
    if (fl_poly_box(&region, (fl_vec3){0.5 * o->size.x, 0.5 * o->size.y, 0.5 * o->thickness}, err) ||
        fl_blocks_cells(&b, &region, o->floes, o->seed, BLOCK_FIELD_FIRST_SITE, o->smooth, err) ||
        fl_blocks_shrink(&b, o->concentration, o->radius, err) ||
        fl_blocks_overlaps(&b, o->radius, &pairs, err))
        goto done;
    if (pairs) {
        fl_fail(err, FL_NUMERIC, "%lld pairs of blocks overlap: nothing is written", (long long)pairs);
        goto done;
    }
    if (block_field_add(&b, o, &id, middle, &out, err)) goto done;
    recipe_set_id(o, &out);
    recipe_history(o, &by);
    if (fl_out_open(&file, o->out, o->gzip, err)) goto done;
    fl_ice_field_write(file.f, &out, &by);
    if (fl_out_close(&file, err)) goto done;
    add_certificate_rows(o, &b, draft, &table);
    if (o->certificate && certificate_write(&table, o->certificate, &by, err)) goto done;
    if (!o->quiet) certificate_print(&table);
    rc = 0;
done:
    fl_poly_free(&region);
    fl_blocks_free(&b);
    fl_ice_field_free(&out);
    return rc;
}

int rubble_make(struct recipe *o, fl_err *err)
{
    return read_constant_thickness(o, err) || make_blocks(o, err) ? -1 : 0;
}
