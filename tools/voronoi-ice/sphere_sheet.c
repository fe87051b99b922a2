/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "base/stream.h"
#include "ice/sphere_packing.h"
#include "scene/ice_field.h"
#include "certificate_table.h"
#include "sphere_sheet.h"

static fl_vec3 place(const fl_sphere_packing *a, int32_t i, double draft)
{
    return v3(a->x[i].x, a->x[i].y, a->x[i].z - draft);
}

static int fill(const struct options *o, const fl_sphere_packing *a, double draft, fl_ice_field *out,
                fl_err *err)
{
    const double r = 0.5 * o->diameter;
    for (int32_t i = 0; i < a->n; i++) {
        const fl_vec3 x = place(a, i, draft);
        fl_poly core = {0};
        if (fl_poly_make(&core, 1, &x, 0, NULL, NULL, err)) return -1;
        if (fl_ice_field_add(out, i, r, &core, o->material, NULL, v3(o->velocity.x, o->velocity.y, 0.0),
                             v3(0, 0, 0), err)) {
            fl_poly_free(&core);
            return -1;
        }
    }
    for (int32_t k = 0; k < a->pairs && o->bonded; k++) {
        const int32_t i = a->pair[k][0], j = a->pair[k][1];
        const fl_vec3 x = v3_lerp(place(a, i, draft), place(a, j, draft), 0.5);
        if (fl_ice_field_add_bond(out, i, j, PI * r * r, 2.0 * r, x, err)) return -1;
    }
    return 0;
}

/* Farthest that a sphere stands out of the field, and the deepest overlap of two that touch. */
static void measure(const struct options *o, const fl_sphere_packing *a, double *outside, double *deep)
{
    const double r = 0.5 * o->diameter;
    const fl_vec2 lo = o->origin, hi = {lo.x + o->size.x, lo.y + o->size.y};
    *outside = *deep = 0.0;
    for (int32_t i = 0; i < a->n; i++) {
        *outside = fmax(*outside, fmax(lo.x - (a->x[i].x - r), a->x[i].x + r - hi.x));
        *outside = fmax(*outside, fmax(lo.y - (a->x[i].y - r), a->x[i].y + r - hi.y));
    }
    for (int32_t k = 0; k < a->pairs; k++)
        *deep = fmax(*deep, 2.0 * r - v3_norm(v3_sub(a->x[a->pair[k][0]], a->x[a->pair[k][1]])));
}

static void certify(const struct options *o, const fl_sphere_packing *a, double draft, struct certify *t)
{
    const double thickness = a->layer_spacing * (a->layers - 1) + a->diameter, r = 0.5 * a->diameter;
    const double ice = a->n * fl_spherical_cap_volume(r, 2.0 * r), slab = o->size.x * o->size.y * thickness;
    double outside, deep;
    measure(o, a, &outside, &deep);
    certify_add(t, "spheres", NOT_ASKED, a->n, NO_DISTANCE, 10, "%d x %d x %d", a->columns, a->rows,
                a->layers);
    certify_add(t, "thickness [m]", NOT_ASKED, thickness, NO_DISTANCE, 6, NULL);
    certify_add(t, "solid part of the slab", NOT_ASKED, ice / slab, NO_DISTANCE, 6, NULL);
    certify_add(t, "overlap, deepest [m]", 0, deep, deep, 4, NULL);
    certify_add(t, "draft [m]", NOT_ASKED, draft, NO_DISTANCE, 6, NULL);
    certify_add(t, "stands out of the field [m]", NOT_ASKED, outside, NO_DISTANCE, 4, NULL);
    certify_add(t, "pairs that touch", NOT_ASKED, a->pairs, NO_DISTANCE, 10, NULL);
    if (o->bonded) certify_add(t, "bonded area [m2]", NOT_ASKED, a->pairs * PI * r * r, NO_DISTANCE, 6, NULL);
}

int sheet_run(struct options *o, fl_err *err)
{
    const fl_vec2 hi = {o->origin.x + o->size.x, o->origin.y + o->size.y};
    struct certify table = {0};
    fl_sphere_packing a = {0};
    fl_ice_field out = {0};
    fl_out file = {0};
    fl_history_line by;
    double draft;
    int rc = -1;
    if (fl_sphere_packing_make(&a, (enum fl_packing_kind)o->lattice, o->diameter, o->layers, o->origin, hi,
                               err))
        return -1;
    draft = fl_sphere_packing_draft(&a, o->ice_density / o->water_density);
    if (fill(o, &a, draft, &out, err)) goto done;
    options_id(o, &out);
    options_by(o, &by);
    if (fl_out_open(&file, o->out, o->gzip, err)) goto done;
    fl_ice_field_write(file.f, &out, &by);
    if (fl_out_close(&file, err)) goto done;
    certify(o, &a, draft, &table);
    if (o->certificate && certify_write(&table, o->certificate, &by, err)) goto done;
    if (!o->quiet) certify_print(&table);
    rc = 0;
done:
    fl_ice_field_free(&out);
    fl_sphere_packing_free(&a);
    return rc;
}
