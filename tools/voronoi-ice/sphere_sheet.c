/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphere_sheet.h"
#include <math.h>
#include <string.h>
#include "base/number_text.h"
#include "base/pi.h"
#include "base/stream.h"
#include "ice/sphere_packing.h"
#include "scene/ice_field.h"
#include "certificate_table.h"
#include "sheet_scene.h"

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
    if (o->has_thickness) fl_history_line_word(by, "--thickness ", o->thickness_law);
    recipe_history_numbers(by, "--diameter ", ',', 1, &o->diameter);
    if (o->rows_across) fl_history_line_add(by, "--rows across");
    if (o->edges) fl_history_line_add(by, "--edges %d", o->edges);
    if (o->endless) fl_history_line_add(by, "--endless");
}

/* Thickness of a layer over the diameter; one alone is as thick as its spheres. */
static double layer_ratio(const struct recipe *o, enum fl_packing_kind kind)
{
    return kind == FL_PACKING_HCP && o->layers > 1 ? sqrt(2.0 / 3.0) : 1.0;
}

/* Sets the diameter where it follows from the thickness; *slab: thickness of the sheet [m]. */
static int set_thickness(struct recipe *o, enum fl_packing_kind kind, double *slab, fl_err *err)
{
    *slab = o->layers * layer_ratio(o, kind) * o->diameter;
    if (!o->has_thickness) return 0;
    if (fl_number_f64(o->thickness_law, slab) || !(*slab > 0.0))
        return fl_fail(err, FL_USAGE, "--thickness is \"%.60s\", a length is expected beside --lattice",
                       o->thickness_law);
    if (o->diameter == 0.0) o->diameter = *slab / (o->layers * layer_ratio(o, kind));
    return 0;
}

/* True if the field drifts along y. */
static int drifts_along_y(const struct recipe *o) { return fabs(o->velocity.y) > fabs(o->velocity.x); }

/* True if it drifts towards smaller coordinates; at rest it moves along +x. */
static int drifts_back(const struct recipe *o)
{
    return drifts_along_y(o) ? o->velocity.y < 0.0 : o->velocity.x < 0.0;
}

/* Spacing of rows where the drift crosses them, of columns where it follows them [m].  Every second row is
 * offset, but in a cubic lattice. */
static double spacing_along(const struct recipe *o, enum fl_packing_kind kind, int *each)
{
    const int over_rows = drifts_along_y(o) != o->rows_across;
    *each = over_rows && kind != FL_PACKING_SQUARE ? 2 : 1;
    return *each == 2 ? sqrt(0.75) * o->diameter : o->diameter;
}

/* The packing over lo .. hi; with rows across x the one along it with x and y exchanged. */
static int make_packing_over(const struct recipe *o, enum fl_packing_kind kind, fl_vec2 lo, fl_vec2 hi,
                             fl_sphere_packing *a, fl_err *err)
{
    if (!o->rows_across) return fl_sphere_packing_make(a, kind, o->diameter, o->layers, lo, hi, err);
    if (fl_sphere_packing_make(a, kind, o->diameter, o->layers, (fl_vec2){lo.y, lo.x}, (fl_vec2){hi.y, hi.x},
                               err))
        return -1;
    for (int32_t i = 0; i < a->n; i++) a->x[i] = v3(a->x[i].y, a->x[i].x, a->x[i].z);
    return 0;
}

/* Rows or columns along the drift. */
static int32_t count_along(const struct recipe *o, const fl_sphere_packing *a)
{
    return drifts_along_y(o) != o->rows_across ? a->rows : a->columns;
}

/* The packing over the field; of an endless sheet without the row that would break its period. */
static int make_packing(const struct recipe *o, enum fl_packing_kind kind, fl_sphere_packing *a, fl_err *err)
{
    fl_vec2 lo = o->origin, hi = {lo.x + o->size.x, lo.y + o->size.y};
    int each;
    const double step = spacing_along(o, kind, &each);
    if (make_packing_over(o, kind, lo, hi, a, err)) return -1;
    const int32_t n = count_along(o, a);
    if (!o->endless || n % each == 0) return 0;
    fl_sphere_packing_free(a);
    if (n < each)
        return fl_fail(err, FL_INPUT,
                       "--endless needs two rows along the drift, and one fits: a longer --size is "
                       "expected");
    if (drifts_along_y(o)) drifts_back(o) ? (lo.y += step) : (hi.y -= step);
    else drifts_back(o) ? (lo.x += step) : (hi.x -= step);
    return make_packing_over(o, kind, lo, hi, a, err);
}

/* The box of the centres. */
typedef struct {
    fl_vec3 lo, hi;
} extent;

static extent extent_of(const fl_sphere_packing *a)
{
    extent e = {a->x[0], a->x[0]};
    for (int32_t i = 1; i < a->n; i++) {
        const fl_vec3 x = a->x[i];
        e.lo = v3(fmin(e.lo.x, x.x), fmin(e.lo.y, x.y), fmin(e.lo.z, x.z));
        e.hi = v3(fmax(e.hi.x, x.x), fmax(e.hi.y, x.y), fmax(e.hi.z, x.z));
    }
    return e;
}

/* Rows at an edge that are offset lie up to D/2 inside it. */
#define ROW_OFFSET 0.6

/* True if the sphere is in the rows at the sides or behind; ahead is where the field moves, +x at rest. */
static int is_at_edge(const struct recipe *o, const extent *e, fl_vec3 x)
{
    const double near = (o->edges - 1 + ROW_OFFSET) * o->diameter;
    const int along_y = drifts_along_y(o), backwards = drifts_back(o);
    const double left = x.x - e->lo.x, right = e->hi.x - x.x, front = x.y - e->lo.y, back = e->hi.y - x.y;
    const int beyond[4] = {left <= near, right <= near, front <= near, back <= near};
    const int ahead = along_y ? (backwards ? 2 : 3) : (backwards ? 0 : 1),
              behind = o->endless ? ahead ^ 1 : -1; /* the sheet goes on there */
    int at = 0;
    for (int k = 0; k < 4; k++) at |= k != ahead && k != behind && beyond[k];
    return o->edges > 0 && at;
}

static fl_vec3 centre_of(const fl_sphere_packing *a, int32_t i, double draft)
{
    return v3(a->x[i].x, a->x[i].y, a->x[i].z - draft);
}

static int add_spheres(const struct recipe *o, const fl_sphere_packing *a, double draft, fl_ice_field *out,
                       fl_err *err)
{
    const double r = 0.5 * o->diameter;
    const extent all = extent_of(a);
    for (int32_t i = 0; i < a->n; i++) {
        const fl_vec3 x = centre_of(a, i, draft);
        const char *group = is_at_edge(o, &all, a->x[i]) ? "edge" : NULL;
        fl_poly core = {0};
        if (fl_poly_make(&core, 1, &x, 0, NULL, NULL, err)) return -1;
        if (fl_ice_field_add(out, i, r, &core, o->material, group, v3(o->velocity.x, o->velocity.y, 0.0),
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

/* The inflow that continues the sheet. */
static struct sheet_inflow inflow_of(const struct recipe *o, enum fl_packing_kind kind,
                                     const fl_sphere_packing *a)
{
    const extent e = extent_of(a);
    const double r = 0.5 * o->diameter, speed = drifts_along_y(o) ? o->velocity.y : o->velocity.x;
    int each;
    struct sheet_inflow out = {.pitch = count_along(o, a) * spacing_along(o, kind, &each),
                               .along_y = drifts_along_y(o),
                               .backwards = drifts_back(o),
                               .speed = fabs(speed)};
    const double lo = out.along_y ? e.lo.y : e.lo.x, hi = out.along_y ? e.hi.y : e.hi.x;
    out.bound = out.backwards ? lo - r + out.pitch : hi + r - out.pitch;
    return out;
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

/* What the spheres stand for, and the bonds that were chosen. */
static void add_sheet_rows(const struct recipe *o, enum fl_packing_kind kind, double slab,
                           const struct sheet_bonds *b, struct certificate_table *t)
{
    const double D = o->diameter, cell = kind == FL_PACKING_SQUARE ? D * D : sqrt(0.75) * D * D,
                 phi = o->layers * fl_spherical_cap_volume(0.5 * D, D) / (cell * slab), none = NOT_REQUESTED;
    if (o->has_thickness || o->scene) {
        certificate_add(t, "slab the spheres stand for [m]", o->has_thickness ? slab : none, slab,
                        NO_DISTANCE, 6, NULL);
        certificate_add(t, "solid part of that slab", none, phi, NO_DISTANCE, 6, NULL);
    }
    if (b->strength > 0.0) {
        const double c = b->strength;
        certificate_add(t, "strength of the bonds [Pa]", none, c, NO_DISTANCE, 6, NULL);
        certificate_add(t, "flexural strength [Pa]", o->flexural > 0.0 ? o->flexural : none,
                        c * b->ratio.flexural, NO_DISTANCE, 6, "+- %.0f %%, along y %.3g",
                        100.0 * b->ratio.flexural_spread, c * b->turned.flexural);
        if (b->ratio.compressive > 0.0)
            certificate_add(t, "compressive strength [Pa]", o->compressive > 0.0 ? o->compressive : none,
                            c * b->ratio.compressive, NO_DISTANCE, 6, "+- %.0f %%, along y %.3g",
                            100.0 * b->ratio.compressive_spread, c * b->turned.compressive);
    }
    if (b->young > 0.0) {
        certificate_add(t, "modulus of the bonds [Pa]", none, b->young, NO_DISTANCE, 6, NULL);
        certificate_add(t, "modulus in bending [Pa]", o->young, b->young * b->ratio.young, NO_DISTANCE, 6,
                        "along y %.3g", b->young * b->turned.young);
    }
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
    const enum fl_packing_kind kind = (enum fl_packing_kind)find_kind(o->generator_argument);
    struct certificate_table table = {0};
    struct sheet_bonds bonds;
    fl_sphere_packing a = {0};
    fl_ice_field out = {0};
    fl_out file = {0};
    fl_history_line by;
    double draft, slab;
    int rc = -1;
    if (o->endless && !o->scene)
        return fl_fail(err, FL_USAGE, "--endless writes the inflow to --scene FILE, which is expected");
    if (set_thickness(o, kind, &slab, err) || sheet_bonds_choose(&bonds, o, kind, err) ||
        make_packing(o, kind, &a, err))
        return -1;
    draft = fl_sphere_packing_draft(&a, o->ice_density / o->water_density);
    if (add_spheres(o, &a, draft, &out, err)) goto done;
    recipe_set_id(o, &out);
    recipe_history(o, &by);
    if (fl_out_open(&file, o->out, o->gzip, err)) goto done;
    fl_ice_field_write(file.f, &out, &by);
    if (fl_out_close(&file, err)) goto done;
    const struct sheet_inflow inflow = inflow_of(o, kind, &a);
    if (o->scene && sheet_scene_write(o, &bonds, slab, o->endless ? &inflow : NULL, &by, err)) goto done;
    add_certificate_rows(o, &a, draft, &table);
    add_sheet_rows(o, kind, slab, &bonds, &table);
    if (o->certificate && certificate_write(&table, o->certificate, &by, err)) goto done;
    if (!o->quiet) certificate_print(&table);
    rc = 0;
done:
    fl_ice_field_free(&out);
    fl_sphere_packing_free(&a);
    return rc;
}
