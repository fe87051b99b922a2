/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphere_sheet.h"
#include <math.h>
#include <string.h>
#include "base/pi.h"
#include "base/stream.h"
#include "ice/sphere_packing.h"
#include "scene/ice_field.h"
#include "certificate_table.h"

/* In the order of enum fl_packing_kind. */
static const char *const KINDS[] = {"hcp", "hex", "square"};
enum { N_KIND = 3 };

/* Index of the name, N_KIND if there is none. */
static int find_kind(const char *name)
{
    int k = 0;
    while (k < N_KIND && strcmp(name, KINDS[k]) != 0) k++;
    return k;
}

int sphere_sheet_check(const char *kind, fl_err *err)
{
    if (find_kind(kind) < N_KIND) return 0;
    return fl_fail(err, FL_USAGE, "--lattice is \"%.60s\", hcp, hex or square is expected", kind);
}

void sphere_sheet_history(const struct recipe *o, fl_history_line *by)
{
    fl_history_line_add(by, "--lattice %s --layers %d", o->generator_argument, o->layers);
    recipe_history_numbers(by, "--diameter ", ',', 1, &o->diameter);
}

static fl_vec3 centre_of(const fl_sphere_packing *a, int32_t i, double draft)
{
    return v3(a->x[i].x, a->x[i].y, a->x[i].z - draft);
}

static int add_spheres(const struct recipe *o, const fl_sphere_packing *a, double draft, fl_ice_field *out,
                       fl_err *err)
{
    const double r = 0.5 * o->diameter;
    for (int32_t i = 0; i < a->n; i++) {
        const fl_vec3 x = centre_of(a, i, draft);
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
        const fl_vec3 x = v3_lerp(centre_of(a, i, draft), centre_of(a, j, draft), 0.5);
        if (fl_ice_field_add_bond(out, i, j, PI * r * r, 2.0 * r, x, err)) return -1;
    }
    return 0;
}

/* Largest extent of a sphere beyond the field, and largest overlap of two touching spheres. */
static void measure(const struct recipe *o, const fl_sphere_packing *a, double *outside, double *max_overlap)
{
    const double r = 0.5 * o->diameter;
    const fl_vec2 lo = o->origin, hi = {lo.x + o->size.x, lo.y + o->size.y};
    *outside = *max_overlap = 0.0;
    for (int32_t i = 0; i < a->n; i++) {
        *outside = fmax(*outside, fmax(lo.x - (a->x[i].x - r), a->x[i].x + r - hi.x));
        *outside = fmax(*outside, fmax(lo.y - (a->x[i].y - r), a->x[i].y + r - hi.y));
    }
    for (int32_t k = 0; k < a->pairs; k++)
        *max_overlap =
            fmax(*max_overlap, 2.0 * r - v3_norm(v3_sub(a->x[a->pair[k][0]], a->x[a->pair[k][1]])));
}

static void add_certificate_rows(const struct recipe *o, const fl_sphere_packing *a, double draft,
                                 struct certificate_table *t)
{
    const double thickness = a->layer_spacing * (a->layers - 1) + a->diameter, r = 0.5 * a->diameter;
    const double ice = a->n * fl_spherical_cap_volume(r, 2.0 * r), slab = o->size.x * o->size.y * thickness;
    double outside, max_overlap;
    measure(o, a, &outside, &max_overlap);
    certificate_add(t, "spheres", NOT_REQUESTED, a->n, NO_DISTANCE, 10, "%d x %d x %d", a->columns, a->rows,
                    a->layers);
    certificate_add(t, "thickness [m]", NOT_REQUESTED, thickness, NO_DISTANCE, 6, NULL);
    certificate_add(t, "solid part of the slab", NOT_REQUESTED, ice / slab, NO_DISTANCE, 6, NULL);
    certificate_add(t, "overlap, deepest [m]", 0, max_overlap, max_overlap, 4, NULL);
    certificate_add(t, "draft [m]", NOT_REQUESTED, draft, NO_DISTANCE, 6, NULL);
    certificate_add(t, "stands out of the field [m]", NOT_REQUESTED, outside, NO_DISTANCE, 4, NULL);
    certificate_add(t, "pairs that touch", NOT_REQUESTED, a->pairs, NO_DISTANCE, 10, NULL);
    if (o->bonded)
        certificate_add(t, "bonded area [m2]", NOT_REQUESTED, a->pairs * PI * r * r, NO_DISTANCE, 6, NULL);
}

int sphere_sheet_make(struct recipe *o, fl_err *err)
{
    const fl_vec2 hi = {o->origin.x + o->size.x, o->origin.y + o->size.y};
    struct certificate_table table = {0};
    fl_sphere_packing a = {0};
    fl_ice_field out = {0};
    fl_out file = {0};
    fl_history_line by;
    double draft;
    int rc = -1;
    if (fl_sphere_packing_make(&a, (enum fl_packing_kind)find_kind(o->generator_argument), o->diameter,
                               o->layers, o->origin, hi, err))
        return -1;
    draft = fl_sphere_packing_draft(&a, o->ice_density / o->water_density);
    if (add_spheres(o, &a, draft, &out, err)) goto done;
    recipe_set_id(o, &out);
    recipe_history(o, &by);
    if (fl_out_open(&file, o->out, o->gzip, err)) goto done;
    fl_ice_field_write(file.f, &out, &by);
    if (fl_out_close(&file, err)) goto done;
    add_certificate_rows(o, &a, draft, &table);
    if (o->certificate && certificate_write(&table, o->certificate, &by, err)) goto done;
    if (!o->quiet) certificate_print(&table);
    rc = 0;
done:
    fl_ice_field_free(&out);
    fl_sphere_packing_free(&a);
    return rc;
}
