/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include <string.h>
#include "base/mem.h"
#include "base/pi.h"
#include "bound/shell.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "step/press.h"
#include "step/ride.h"
#include "step/sleep.h"
#include "step/traffic.h"
#include "step/works.h"
#include "sim/setup.h"
#include "water/added.h"
#include "world/access.h"

/* Fewer bodies than this are not worth a thread: its share of a step would be shorter than the wait at its
 * end. */
enum { BODIES_A_THREAD = 32 };

#define PI 3.14159265358979323846

/* --- bodies ------------------------------------------------------------------------------------ */

/* What the scene says of the body's group: directions it holds, and the velocity it holds them at.  A turn
 * that is held is held at no spin. */
static void hold_body(fl_world *w, int32_t i, const char *group, fl_vec3 spin)
{
    fl_bodies *b = &w->b;
    const int32_t g = fl_scene_find_group(w->scene, group);
    if (g < 0) return;
    const unsigned fixed = w->scene->group[g].fixed;
    const fl_vec3 given = w->scene->group[g].velocity;
    b->hold[i] = (uint8_t)fixed;
    if (fixed & FL_HOLD_X) b->v[i].x = given.x;
    if (fixed & FL_HOLD_Y) b->v[i].y = given.y;
    if (fixed & FL_HOLD_Z) b->v[i].z = given.z;
    fl_body_spin(b, i,
                 v3(fixed & FL_HOLD_RX ? 0.0 : spin.x, fixed & FL_HOLD_RY ? 0.0 : spin.y,
                    fixed & FL_HOLD_RZ ? 0.0 : spin.z));
}

/* Something is wrong with the k-th body of the field: its file, the line of its record, its id. */
static int fail_body(const fl_world *w, const fl_field *field, int32_t k, fl_err *err, const char *what)
{
    char line[16] = "";
    if (field->line[k] > 0) snprintf(line, sizeof line, ":%d", field->line[k]);
    return fl_fail(err, FL_INPUT, "%s%s: body %d: %s", w->scene->ice.file, line, field->id[k], what);
}

/* An edge without a radius has no stiffness: what is sharp is dilated by so much of its size. */
#define SHARP 1e-6

/* Body i from the k-th of the field: outer shape, mass, frame, start. */
static int make_body(fl_world *w, int32_t i, const fl_field *field, int32_t k, fl_poly *outer, fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_bodies *b = &w->b;
    const fl_poly *core = &field->core[k];
    const double r = field->radius[k];
    const int sharp = s->ice.shape == FL_SHAPE_SHARP && core->nf > 0;
    const char *material =
        field->material[k] >= 0 ? field->materials.name[field->material[k]] : s->ice.material;
    fl_mass mass;
    fl_err why = {0};
    w->id[i] = field->id[k];
    w->material[i] = fl_scene_find_material(s, material);
    if (w->material[i] < 0) {
        char what[400];
        snprintf(what, sizeof what, "material %.350s is not in the scene", material);
        return fail_body(w, field, k, err, what);
    }
    if (sharp && (r > 0.0 ? fl_poly_offset(outer, core, r, &why) : fl_poly_copy(outer, core, &why))) goto bad;
    if (fl_mass_of(&mass, sharp ? outer : core, sharp ? 0.0 : r, &why)) goto bad;

    const double rho = s->material[w->material[i]].density;
    b->m[i] = rho * mass.volume;
    b->invm[i] = 1.0 / b->m[i];
    fl_body_inertia(b, i, v3_scale(rho, mass.inertia));
    b->x[i] = mass.centre;
    b->q[i] = q_of_matrix(mass.axes);
    b->v[i] = field->vel[k];
    const fl_mat3 axes = q_matrix(b->q[i]);
    if (fl_poly_copy(&b->core[i], core, err)) return -1;
    fl_poly_to_frame(&b->core[i], b->x[i], axes);
    if (sharp) fl_poly_to_frame(outer, b->x[i], axes);
    for (int32_t v = 0; v < core->nv; v++) b->bound[i] = fmax(b->bound[i], v3_norm(b->core[i].v[v]));
    b->radius[i] = r > 0.0 ? r : SHARP * b->bound[i];
    w->face[i] = fl_poly_largest(&b->core[i]);
    w->q0[i] = b->q[i];
    fl_body_derive(b, i);
    fl_body_spin(b, i, field->spin[k]);
    if (field->group[k] >= 0) hold_body(w, i, field->groups.name[field->group[k]], field->spin[k]);
    return fl_topologies_share(&w->alike, &b->core[i],
                               w->points ? FL_KEEP_ANGLES | FL_KEEP_OFFSETS : FL_KEEP_ANGLES, err);
bad:
    if (why.code == FL_SYSTEM) {
        *err = why;
        return -1;
    }
    return fail_body(w, field, k, err, why.text);
}

/* The water that body i, of shape p, moves along. */
static void add_water(fl_world *w, int32_t i, const fl_poly *p)
{
    const fl_scene_water *s = &w->scene->water;
    fl_bodies *b = &w->b;
    const fl_vec3 spin = b->w[i], up = m3_tmul(fl_body_axes(b, i), v3(0, 0, 1));
    if (b->added)
        b->added[i] = fl_added_mass(p, up, fmin(b->m[i], s->density * w->sea.hull[i].volume), s->density,
                                    s->added_mass);
    fl_body_inertia(b, i, v3_add(b->I[i], fl_added_inertia(p, up, b->I[i], s->density, s->added_inertia)));
    fl_body_spin(b, i, spin);
}

/* The sea's view of body i: what floats, and how far out it drags. */
static int make_hull(fl_world *w, int32_t i, fl_poly *outer, fl_err *err)
{
    const fl_poly *core = &w->b.core[i];
    const int round = core->nv <= 2;
    if (!round && outer->nv == 0)
        return fl_fail(err, FL_INPUT,
                       "%s: body %d: ice.shape = round has no hydrostatics of a polyhedron; use sharp with "
                       "[water] or [wind]",
                       w->scene->ice.file, w->id[i]);
    if (!round && fl_topologies_share(&w->alike, outer, FL_KEEP_OFFSETS, err)) return -1;
    if (fl_sea_dress(&w->sea, i, round ? NULL : outer, core, w->b.radius[i], err)) return -1;
    if (w->b.added || v3_some(w->scene->water.added_inertia))
        add_water(w, i, round ? core : fl_sea_outer(&w->sea, i) ? fl_sea_outer(&w->sea, i) : outer);
    return fl_sea_fit(&w->sea, i, err);
}

/* The elastic walls' view of body i: what presses.  Its corners stand out farther than the dilated core, and
 * move farther as it turns. */
static int make_bed(fl_world *w, int32_t i, const fl_poly *outer, fl_err *err)
{
    const fl_poly *core = &w->b.core[i];
    const int round = core->nv <= 2;
    fl_poly *p = &w->bed.outer[i];
    if (!round && outer->nv == 0)
        return fl_fail(err, FL_INPUT,
                       "%s: body %d: ice.shape = round has no volume behind an elastic wall; use sharp",
                       w->scene->ice.file, w->id[i]);
    if (!round && fl_poly_copy(p, outer, err)) return -1;
    for (int32_t v = 0; v < p->nv; v++) w->b.bound[i] = fmax(w->b.bound[i], v3_norm(p->v[v]));
    return fl_hull_make(&w->bed.hull[i], round ? core : p, round ? w->b.radius[i] : 0.0, err);
}

static int make_beds(fl_world *w, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    int elastic = 0;
    for (int32_t k = w->pieces; k < w->structure.n; k++) elastic |= w->structure.piece[k].elastic;
    if (!elastic) return 0;
    w->bed.stiffness = s->foundation;
    w->bed.damping = s->damping;
    w->bed.outer = fl_alloc(w->n, sizeof *w->bed.outer, err);
    w->bed.hull = fl_alloc(w->n, sizeof *w->bed.hull, err);
    return w->bed.outer && w->bed.hull ? 0 : -1;
}

static int make_waves(fl_world *w, fl_err *err)
{
    const fl_scene_water *s = &w->scene->water;
    const double g = v3_norm(w->scene->run.gravity);
    if (!s->head.present || s->wave == FL_WAVE_NONE) return 0;
    if (s->wave == FL_WAVE_AIRY
            ? fl_waves_airy(&w->sea.wave, s->height, s->period, s->direction, s->depth, g, err)
            : fl_waves_jonswap(&w->sea.wave, s->height, s->period, s->gamma, s->components, (uint64_t)s->seed,
                               s->direction, s->depth, g, err))
        return -1;
    w->sea.waves = 1;
    return 0;
}

static int make_sea(fl_world *w, fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_sea *sea = &w->sea;
    if (!s->water.head.present && !s->wind.head.present) return 0;
    sea->water = s->water.head.present;
    sea->every = s->water.every;
    sea->wind = s->wind.head.present;
    sea->level = s->water.level;
    sea->weight = s->water.density * v3_norm(s->run.gravity);
    sea->sea = (fl_fluid){s->water.density, s->water.drag_force_coef, s->water.drag_moment_coef};
    sea->air = (fl_fluid){s->wind.density, s->wind.drag_coef, 0.0};
    sea->current =
        (fl_current){.velocity = s->water.current,
                     .kind = s->water.profile,
                     .depth = s->water.profile_depth > 0.0 ? s->water.profile_depth : s->water.depth,
                     .exponent = s->water.profile_exponent};
    if (s->water.profile == FL_PROFILE_TABLE && fl_current_read(&sea->current, s->water.profile_file, err))
        return -1;
    sea->sea_law = s->water.drag;
    sea->sea_skin = s->water.skin_coef;
    sea->sea_form = s->water.form_coef;
    sea->air_law = s->wind.drag;
    sea->air_form = s->wind.form_coef;
    sea->breeze = s->wind.velocity;
    if (s->wind.beaufort >= 0.0) { /* Beaufort's scale, as words of the manual have it */
        const double U = 0.836 * s->wind.beaufort * sqrt(s->wind.beaufort), a = fl_radians(s->wind.direction);
        sea->breeze = v3(U * cos(a), U * sin(a), 0);
    }
    if (sea->water && v3_some(s->water.added_mass) && fl_bodies_add_mass(&w->b, err)) return -1;
    return make_waves(w, err) || fl_sea_alloc(sea, w->n, w->threads, err) ? -1 : 0;
}

/* --- what is held ------------------------------------------------------------------------------ */

static int add_wall(fl_structure *s, int elastic, fl_vec3 x, fl_vec3 normal, fl_err *err)
{
    const fl_vec3 ex = v3_normal_to(normal), ey = v3_cross(normal, ex);
    if (fl_grow(&s->piece, &s->cap, (int64_t)s->n + 1, sizeof *s->piece, err)) return -1;
    s->piece[s->n++] =
        (fl_piece){.kind = FL_PIECE_PLANE,
                   .part = -1,
                   .elastic = elastic,
                   .x = x,
                   .q = q_of_matrix(
                       (fl_mat3){{{ex.x, ey.x, normal.x}, {ex.y, ey.y, normal.y}, {ex.z, ey.z, normal.z}}})};
    return 0;
}

static int make_walls(fl_world *w, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_structure *st = &w->structure;
    const double lo[3] = {s->min.x, s->min.y, s->min.z}, hi[3] = {s->max.x, s->max.y, s->max.z};
    const int32_t before = st->n;
    if (!s->head.present) return 0;
    for (int c = 0; c < 3; c++) {
        const fl_vec3 e = v3(c == 0, c == 1, c == 2);
        const int elastic = s->type[c] == FL_BOUND_ELASTIC;
        if (!elastic && s->type[c] != FL_BOUND_RIGID) continue;
        if (isfinite(lo[c]) && add_wall(st, elastic, v3_scale(lo[c], e), e, err)) return -1;
        if (isfinite(hi[c]) && add_wall(st, elastic, v3_scale(hi[c], e), v3_neg(e), err)) return -1;
    }
    w->walls = st->n - before;
    return 0;
}

static void make_cell(fl_world *w)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    const fl_vec3 lo = s->min, hi = s->max;
    if (!s->head.present) return;
    for (int c = 0; c < 3; c++) {
        double *low = c == 0 ? &w->cell.lo.x : c == 1 ? &w->cell.lo.y : &w->cell.lo.z;
        double *length = c == 0 ? &w->cell.length.x : c == 1 ? &w->cell.length.y : &w->cell.length.z;
        const double a = c == 0 ? lo.x : c == 1 ? lo.y : lo.z, b = c == 0 ? hi.x : c == 1 ? hi.y : hi.z;
        if (s->type[c] != FL_BOUND_PERIODIC || !isfinite(a) || !isfinite(b)) continue;
        *low = a;
        *length = b - a;
        w->cell.wraps = 1;
    }
}

#define MOST_CELLS 1e6 /* a body may have gone through so many */

static fl_vec3 normal_of(const fl_piece *wall) { return q_rotate(wall->q, v3(0, 0, 1)); }

static int before_walls(const fl_world *w, int32_t i, fl_err *err)
{
    char name[64];
    if (fl_body_stands(&w->b, i) == (FL_HOLD_X | FL_HOLD_Y | FL_HOLD_Z)) return 0;
    for (int32_t k = 0; k < w->walls && w->b.invm[i] > 0.0; k++) {
        const fl_piece *wall = &w->structure.piece[w->pieces + k];
        const double before = v3_dot(normal_of(wall), v3_sub(w->b.x[i], wall->x));
        if (!wall->elastic && before < 0.0)
            return fl_fail(err, FL_INPUT,
                           "%s: body %d stands behind %s, its centre by %.4g m: a place between boundary.min "
                           "and boundary.max was wanted",
                           w->scene->ice.file, w->id[i], fl_world_wall(w, k, name), -before);
    }
    return 0;
}

int fl_world_before_walls(const fl_world *w, fl_err *err)
{
    for (int32_t i = 0; i < w->n; i++)
        if (!fl_world_away(w, i) && before_walls(w, i, err)) return -1;
    return 0;
}

/* A body that spans half the cell could meet two images of another at once, or its own. */
static int fits_cell(const fl_world *w, int32_t i, fl_err *err)
{
    const double length[3] = {w->cell.length.x, w->cell.length.y, w->cell.length.z};
    const fl_poly *p = &w->b.core[i];
    double across = 0.0;
    for (int32_t a = 0; a < p->nv; a++)
        for (int32_t b = 0; b < a; b++) across = fmax(across, v3_norm2(v3_sub(p->v[a], p->v[b])));
    across = sqrt(across) + 2.0 * w->b.radius[i];
    const fl_vec3 at = w->b.x[i];
    const double x[3] = {at.x, at.y, at.z};
    for (int c = 0; c < 3; c++)
        if (length[c] > 0.0 && !(fabs(x[c]) < MOST_CELLS * length[c] && isfinite(length[c])))
            return fl_fail(
                err, FL_INPUT,
                "%s: body %d at %c = %.4g m, and the periodic %c repeats every %.4g m: within %.3g of "
                "those was wanted",
                w->scene->ice.file, w->id[i], 'x' + c, x[c], 'x' + c, length[c], MOST_CELLS);
    for (int c = 0; c < 3; c++)
        if (length[c] > 0.0 && across > 0.5 * length[c])
            return fl_fail(err, FL_INPUT,
                           "%s: body %d is %.4g m across, more than half of the %.4g m of the periodic %c; a "
                           "wider cell was wanted",
                           w->scene->ice.file, w->id[i], across, length[c], 'x' + c);
    return 0;
}

/* A body could meet a piece longer than the cell in two images at once. */
static int piece_fits(const fl_world *w, int32_t k, const fl_surface *surface, fl_err *err)
{
    const double length[3] = {w->cell.length.x, w->cell.length.y, w->cell.length.z};
    const fl_piece *p = &w->structure.piece[k];
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < p->core.nv; v++) box = aabb_add(box, q_rotate(p->q, p->core.v[v]));
    const double size[3] = {box.hi.x - box.lo.x, box.hi.y - box.lo.y, box.hi.z - box.lo.z};
    for (int c = 0; c < 3; c++)
        if (length[c] > 0.0 && size[c] > length[c] * (1.0 + 1e-9))
            return fl_fail(
                err, FL_INPUT,
                "%s: a piece of part %s is %.4g m long, and the periodic %c repeats every %.4g m: it would "
                "be met more than once",
                w->scene->structure.file, surface->part[p->part].name, size[c], 'x' + c, length[c]);
    return 0;
}

static int place_pieces(fl_world *w, const fl_surface *surface, fl_err *err)
{
    for (int32_t k = 0; k < w->structure.n; k++) {
        const fl_piece *piece = &w->structure.piece[k];
        const int32_t j = w->n + k;
        w->b.x[j] = piece->x;
        w->b.q[j] = piece->q;
        w->material[j] = piece->kind == FL_PIECE_PLANE ? FL_SCENE_BOUNDARY : FL_SCENE_STRUCTURE;
        if (piece->kind == FL_PIECE_PLANE) continue;
        if (w->cell.wraps && piece_fits(w, k, surface, err)) return -1;
        if (piece->kind == FL_PIECE_SHELL) { /* only its box is looked at, through the corners */
            fl_vec3 corner[8];
            const fl_aabb box = piece->shell.tree.node[0].box;
            for (int c = 0; c < 8; c++)
                corner[c] =
                    v3(c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y, c & 4 ? box.hi.z : box.lo.z);
            fl_poly *p = &w->b.core[j];
            p->v = fl_alloc(8, sizeof *p->v, err);
            if (!p->v) return -1;
            memcpy(p->v, corner, sizeof corner);
            p->nv = 8;
            w->face[j] = piece->face;
        } else {
            if (fl_poly_copy(&w->b.core[j], &piece->core, err)) return -1;
            w->face[j] = fl_poly_largest(&piece->core);
        }
        for (int32_t v = 0; v < w->b.core[j].nv; v++)
            w->b.bound[j] = fmax(w->b.bound[j], v3_norm(w->b.core[j].v[v]));
    }
    return 0;
}

/* --- all of it --------------------------------------------------------------------------------- */

static int make_arrays(fl_world *w, fl_err *err)
{
    const int64_t total = w->b.total;
    w->id = fl_alloc(w->n, sizeof *w->id, err);
    w->q0 = fl_alloc(w->n, sizeof *w->q0, err);
    w->material = fl_alloc(total, sizeof *w->material, err);
    w->face = fl_alloc(total, sizeof *w->face, err);
    w->group = fl_alloc(w->n / FL_BALLS_GROUP + 1, sizeof *w->group, err);
    w->odometer_found = fl_alloc(total, sizeof *w->odometer_found, err);
    w->met = fl_alloc(total, sizeof *w->met, err);
    w->part_impulse = fl_alloc(w->parts, sizeof *w->part_impulse, err);
    w->part_moment = fl_alloc(w->parts, sizeof *w->part_moment, err);
    w->part_force = fl_alloc(w->parts, sizeof *w->part_force, err);
    w->part_torque = fl_alloc(w->parts, sizeof *w->part_torque, err);
    w->part_about = fl_alloc(w->parts, sizeof *w->part_about, err);
    w->part_peak = fl_alloc(w->parts, sizeof *w->part_peak, err);
    w->scratch = fl_alloc(w->threads, sizeof *w->scratch, err);
    w->share = fl_alloc(w->threads, sizeof *w->share, err);
    w->turn = fl_alloc(w->threads, sizeof *w->turn, err);
    w->near_shell = fl_alloc(w->threads, sizeof *w->near_shell, err);
    return err->code ? -1 : 0;
}

/* A group of the scene that no record has is a name mistyped: its bodies would be free. */
static int check_groups(const fl_world *w, const fl_field *field, const fl_field *feed, fl_err *err)
{
    for (int32_t g = 0; g < w->scene->n_group; g++) {
        const char *name = w->scene->group[g].name;
        char key[2 * FL_SCENE_NAME];
        snprintf(key, sizeof key, "group %s.fixed", name);
        if (fl_names_find(&field->groups, name) < 0 && fl_names_find(&feed->groups, name) < 0)
            return fl_scene_fail(w->scene, key, err, "no body of %s is of the group %s", w->scene->ice.file,
                                 name);
    }
    return 0;
}

/* Which floes of the ice are driven. */
static int make_row(fl_world *w, const fl_field *field, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    const double v = fabs(s->drive.x) >= fabs(s->drive.y) ? s->drive.x : s->drive.y;
    const int auto_axis = fabs(s->drive.x) < fabs(s->drive.y);
    /* the edge is where `sign` times the coordinate is least */
    const fl_traffic edge = {.axis = s->drive_edge ? (s->drive_edge - 1) / 2 : auto_axis,
                             .sign =
                                 s->drive_edge ? (s->drive_edge % 2 ? 1.0 : -1.0) : (v > 0.0 ? 1.0 : -1.0)};
    double back = INFINITY;
    int some = 0;
    if (!s->head.present || (s->drive_width <= 0.0 && !s->drive_group[0])) return 0;
    w->row.in = fl_alloc(field->n, sizeof *w->row.in, err);
    w->row.k = fl_alloc(field->n, sizeof *w->row.k, err);
    w->row.rest = fl_alloc(field->n, sizeof *w->row.rest, err);
    if (!w->row.in || !w->row.k || !w->row.rest) return -1;
    w->row.n = field->n;
    for (int32_t k = 0; k < field->n; k++) back = fmin(back, fl_traffic_extent(&edge, field, k, -1.0));
    for (int32_t k = 0; k < field->n; k++) {
        const double middle =
            0.5 * (fl_traffic_extent(&edge, field, k, -1.0) + fl_traffic_extent(&edge, field, k, 1.0));
        const char *group = field->group[k] < 0 ? "" : field->groups.name[field->group[k]];
        w->row.in[k] =
            s->drive_group[0] ? strcmp(group, s->drive_group) == 0 : middle - back <= s->drive_width;
        some |= w->row.in[k];
        const int32_t g = w->row.in[k] ? fl_scene_find_group(w->scene, group) : -1;
        if (g >= 0 && w->scene->group[g].fixed & s->drive_fixed & (FL_HOLD_X | FL_HOLD_Y | FL_HOLD_Z)) {
            char what[2 * FL_SCENE_NAME];
            snprintf(what, sizeof what, "[group %s] and boundary.drive both say how it moves", group);
            return fail_body(w, field, k, err, what);
        }
    }
    if (some) return 0;
    if (s->drive_group[0])
        return fl_fail(err, FL_INPUT, "%s: no body is of the group %s, which boundary.drive_group names",
                       w->scene->ice.file, s->drive_group);
    return fl_fail(err, FL_INPUT, "%s: no body is within %g m of the edge, boundary.drive_width",
                   w->scene->ice.file, s->drive_width);
}

/* Drive the floe in place i; what its group holds besides stays held. */
static void drive_body(fl_world *w, int32_t i)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_bodies *b = &w->b;
    const fl_vec3 spin = b->w[i];
    const unsigned told = s->drive_fixed, fixed = told | b->hold[i];
    b->hold[i] = (uint8_t)fixed;
    if (told & FL_HOLD_X) b->v[i].x = s->drive.x;
    if (told & FL_HOLD_Y) b->v[i].y = s->drive.y;
    if (told & FL_HOLD_Z) b->v[i].z = s->drive.z;
    fl_body_spin(b, i,
                 v3(fixed & FL_HOLD_RX ? 0.0 : spin.x, fixed & FL_HOLD_RY ? 0.0 : spin.y,
                    fixed & FL_HOLD_RZ ? 0.0 : spin.z));
    w->row.k[i] = fixed & FL_HOLD_Z ? 0.0 : s->drive_spring + s->drive_foundation * w->face[i];
    w->row.rest[i] = b->x[i].z;
}

static int has_points(const fl_field *f)
{
    for (int32_t k = 0; k < f->n; k++)
        if (f->core[k].nv == 1) return 1;
    return 0;
}

int fl_world_put(fl_world *w, int32_t i, const fl_field *field, int32_t k, fl_err *err)
{
    fl_poly outer = {0};
    fl_poly_free(&w->b.core[i]);
    w->b.bound[i] = 0.0;
    w->b.hold[i] = 0;
    w->b.ball[i] = 0;
    if (w->bed.hull) fl_hull_free(&w->bed.hull[i]), fl_poly_free(&w->bed.outer[i]);
    if (w->sea.n) fl_sea_bare(&w->sea, i);
    const int bad = make_body(w, i, field, k, &outer, err) || (w->cell.wraps && fits_cell(w, i, err)) ||
                    (w->bed.hull && make_bed(w, i, &outer, err)) ||
                    (w->sea.n && make_hull(w, i, &outer, err));
    fl_poly_free(&outer);
    if (bad) return -1;
    w->b.ball[i] = (uint8_t)fl_body_is_ball(&w->b, i);
    if (i < w->row.n && w->row.in[i] && !(w->traffic.away && w->traffic.floe[i] >= 0)) drive_body(w, i);
    return 0;
}

/* How often a surface goes round x: once where x lies within what looks outward, and not in its cavities. */
static double turns_about(const fl_part *p, fl_vec3 x)
{
    double angle = 0.0;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        const fl_vec3 a = v3_sub(p->v[v[0]], x), b = v3_sub(p->v[v[1]], x), c = v3_sub(p->v[v[2]], x);
        const double A = v3_norm(a), B = v3_norm(b), C = v3_norm(c);
        angle += atan2(v3_dot(a, v3_cross(b, c)),
                       A * B * C + v3_dot(a, b) * C + v3_dot(b, c) * A + v3_dot(c, a) * B);
    }
    return angle / (2.0 * PI);
}

/* Of a closed part that looks inward what is outside is solid: a tank holds its floes, and of a post that is
 * inside out the floes about it would be in its ice.  Who stands in what is solid between an outside and its
 * cavities is another matter. */
static int check_inward(const fl_world *w, const fl_surface *surface, fl_err *err)
{
    for (int32_t k = 0; k < w->structure.n; k++) {
        const fl_piece *piece = &w->structure.piece[k];
        for (int32_t i = 0; i < w->n && piece->inward; i++) {
            if (fl_world_away(w, i)) continue;
            const fl_vec3 x = q_rotate(q_conj(piece->q), v3_sub(w->b.x[i], piece->x));
            const fl_part *p = &surface->part[piece->part];
            if (!fl_shell_holds(piece, x) || turns_about(p, w->b.x[i]) > 0.5) continue;
            const int rows = p->line > 0 && p->last_line - p->line == p->nt - 1; /* one behind the other */
            return fl_fail(err, FL_INPUT,
                           "%s: part %s: its triangles, from line %d on, look inward, and body %d stands "
                           "outside, where all is solid then: struct-import turns them",
                           w->scene->structure.file, p->name, p->line + (rows ? piece->inward - 1 : 0),
                           w->id[i]);
        }
    }
    return 0;
}

int fl_world_make(fl_world *w, const fl_scene *scene, const fl_field *field, const fl_surface *surface,
                  fl_err *err)
{
    return fl_world_make_fed(w, scene, field, field, surface, err);
}

int fl_world_make_fed(fl_world *w, const fl_scene *scene, const fl_field *field, const fl_field *feed,
                      const fl_surface *surface, fl_err *err)
{
    double bound = 0.0;
    fl_err why = {0};
    *w = (fl_world){.scene = scene, .n = field->n, .found_at = -1, .gravity = scene->run.gravity};
    fl_gate_make(&w->gate);
    w->threads = scene->run.threads > 0 ? scene->run.threads : omp_get_max_threads();
    if (w->threads > 1 + field->n / BODIES_A_THREAD) w->threads = 1 + field->n / BODIES_A_THREAD;
    omp_set_num_threads(w->threads);
    fl_team_make(&w->team, w->threads, scene->run.threads == 0);
    w->dt_critical = w->dt_touching = INFINITY;
    w->worst_i = w->worst_j = w->critical_body = -1;
    w->parts = surface ? surface->n : 0;
    if (surface && fl_structure_build(&w->structure, surface, &why)) {
        if (why.code == FL_INPUT) fl_fail(err, FL_INPUT, "%s: %s", scene->structure.file, why.text);
        else *err = why;
        goto fail;
    }
    if (make_walls(w, err)) goto fail;
    make_cell(w);
    if (check_groups(w, field, feed, err) || fl_traffic_make(w, field, feed, err) || make_row(w, field, err))
        goto fail;
    w->pieces = w->structure.n - w->walls;
    if (fl_bodies_alloc(&w->b, w->n, w->n + w->structure.n, err) || make_arrays(w, err) ||
        fl_works_make(w, err) || make_beds(w, err) || make_sea(w, err))
        goto fail;
    w->points = has_points(field) || has_points(feed);
    if (w->points && fl_structure_balls(&w->structure, err)) goto fail;
    if (w->points && w->sea.n && !(w->drag = fl_alloc(w->n, sizeof *w->drag, err))) goto fail;
    for (int32_t i = 0; i < field->n; i++) {
        if (fl_world_put(w, i, field, i, err)) goto fail;
        bound += w->b.bound[i] + w->b.radius[i];
    }
    /* The places to come hold what can come, so that the step is chosen for that as well. */
    for (int32_t i = field->n; i < w->n; i++) {
        w->traffic.floe[i] = (i - field->n) % feed->n;
        w->traffic.away[i] = 1;
        if (fl_world_put(w, i, feed, w->traffic.floe[i], err)) goto fail;
    }
    if (place_pieces(w, surface, err) || fl_ride_make(w, surface, err) || fl_press_make(w, surface, err) ||
        fl_sleep_make(w, err) || fl_pairing_laws(w, err) || fl_frozen_make(w, field, err))
        goto fail;
    if (check_inward(w, surface, err)) goto fail;
    /* A tenth of a mean floe: large enough to search seldom, small enough to list few pairs in vain. */
    w->skin = field->n ? 0.1 * bound / field->n : 0.0;
    w->near.absent = w->traffic.away;
    return 0;
fail:
    fl_world_free(w);
    return -1;
}

void fl_world_free(fl_world *w)
{
    for (int32_t k = 0; k < w->threads; k++) {
        if (w->scratch) fl_places_free(&w->scratch[k]);
        if (w->near_shell) fl_shell_near_free(&w->near_shell[k]);
    }
    for (int32_t i = 0; i < w->n; i++) {
        if (w->bed.hull) fl_hull_free(&w->bed.hull[i]);
        if (w->bed.outer) fl_poly_free(&w->bed.outer[i]);
    }
    free(w->bed.hull), free(w->bed.outer);
    free(w->row.in), free(w->row.k), free(w->row.rest);
    fl_traffic_free(&w->traffic);
    fl_near_free(w);
    free(w->inc_first), free(w->inc), free(w->scratch), free(w->near_shell), free(w->told);
    free(w->hit), free(w->watch), free(w->live), free(w->met), free(w->share), free(w->turn);
    fl_balls_free(&w->balls);
    free(w->id), free(w->q0), free(w->material), free(w->face), free(w->law), free(w->box), free(w->home);
    free(w->group), free(w->drag);
    free(w->odometer_found), free(w->part_impulse), free(w->part_moment), free(w->part_force),
        free(w->part_torque);
    free(w->part_peak), free(w->part_about);
    fl_works_free(w);
    fl_ride_free(&w->ride);
    fl_sleep_free(&w->sleep);
    fl_frozen_free(&w->frozen);
    fl_press_free(&w->press);
    fl_pairs_free(&w->near);
    fl_sea_free(&w->sea);
    fl_bodies_free(&w->b);
    fl_topologies_free(&w->alike);
    fl_structure_free(&w->structure);
    fl_gate_free(&w->gate);
    *w = (fl_world){0};
}
