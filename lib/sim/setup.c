/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/relaxed_run.h"
#include "sim/setup.h"
#include <omp.h>
#include <stdio.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "contact/bond_list.h"
#include "contact/crushing.h"
#include "contact/disc_setup.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/panel_load.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "ice/slab_fill.h"
#include "sim/device_step.h"
#include "sim/energy_ledger.h"
#include "sim/drive_track.h"
#include "sim/floe_cut.h"
#include "sim/floe_setup.h"
#include "sim/ice_push.h"
#include "sim/inflow.h"
#include "sim/inflow_bonds.h"
#include "sim/moving_structure.h"
#include "sim/sleep.h"
#include "sim/strip_setup.h"
#include "sim/zone_setup.h"
#include "sphere/contact_list.h"
#include "structure/mesh_contact.h"
#include "structure/region.h"
#include "water/added_mass.h"
#include "water/force_table.h"
#include "world/access.h"

/* Smallest number of bodies per thread: with fewer the work of a thread is shorter than the wait for the
 * others. */
enum { BODIES_PER_THREAD = 32 };

/* --- surroundings ------------------------------------------------------------------------------ */

/* Radii that differ by less than this fraction are equal. */
#define EQUAL_RADII 1e-6

static int make_elastic_walls(fl_world *w, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    int elastic = 0;
    for (int32_t k = w->pieces; k < w->structure.n; k++) elastic |= w->structure.piece[k].elastic;
    if (!elastic) return 0;
    w->elastic_walls.stiffness = s->foundation;
    w->elastic_walls.damping = s->damping;
    w->elastic_walls.outer = fl_alloc(w->n, sizeof *w->elastic_walls.outer, err);
    w->elastic_walls.hull = fl_alloc(w->n, sizeof *w->elastic_walls.hull, err);
    return w->elastic_walls.outer && w->elastic_walls.hull ? 0 : -1;
}

/* --- walls and pieces -------------------------------------------------------------------------- */

static int add_wall(fl_structure *s, int elastic, fl_vec3 x, fl_vec3 normal, fl_err *err)
{
    const fl_vec3 ex = v3_normal_to(normal), ey = v3_cross(normal, ex);
    if (fl_grow(&s->piece, &s->cap, (int64_t)s->n + 1, sizeof *s->piece, err)) return -1;
    s->piece[s->n++] =
        (fl_piece){.kind = FL_PIECE_PLANE,
                   .part = -1,
                   .cone = -1,
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
    const int32_t distance = st->n;
    if (!s->head.present) return 0;
    for (int c = 0; c < 3; c++) {
        const fl_vec3 e = v3(c == 0, c == 1, c == 2);
        const int elastic = s->type[c] == FL_BOUNDARY_ELASTIC;
        if (!elastic && s->type[c] != FL_BOUNDARY_RIGID) continue;
        if (isfinite(lo[c]) && add_wall(st, elastic, v3_scale(lo[c], e), e, err)) return -1;
        if (isfinite(hi[c]) && add_wall(st, elastic, v3_scale(hi[c], e), v3_neg(e), err)) return -1;
    }
    w->walls = st->n - distance;
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
        if (s->type[c] != FL_BOUNDARY_PERIODIC || !isfinite(a) || !isfinite(b)) continue;
        *low = a;
        *length = b - a;
        w->cell.periodic = 1;
    }
}

/* File of the structure, for messages. */
static const char *structure_name(const fl_world *w)
{
    const fl_scene_structure *s = &w->scene->structure;
    return s->members[0] ? s->members : s->file;
}

/* The pieces of the structure; those that touch and do not move apart are one.  Cylinders that members carry
 * move apart. */
static int make_pieces(fl_world *w, const fl_surface *surface, int carried, fl_err *err)
{
    fl_err why = {0};
    int32_t *mover = fl_alloc(surface->n, sizeof *mover, err);
    int rc = -1;
    if (mover) {
        fl_mover_of_parts(w->scene, surface, mover);
        rc = fl_structure_build(&w->structure, surface, &why) ||
                     (!carried && fl_regions_join(&w->structure, surface, mover, w->cell.length, &why))
                 ? -1
                 : 0;
        if (why.code == FL_INPUT) fl_fail(err, FL_INPUT, "%s: %s", structure_name(w), why.text);
        else if (rc) *err = why;
    }
    free(mover);
    return rc;
}

static fl_vec3 normal_of(const fl_piece *wall) { return q_rotate(wall->q, v3(0, 0, 1)); }

static int check_behind_walls(const fl_world *w, int32_t i, fl_err *err)
{
    char name[64];
    if (fl_body_fixed_translations(&w->b, i) == (FL_DOF_X | FL_DOF_Y | FL_DOF_Z)) return 0;
    for (int32_t k = 0; k < w->walls && w->b.invm[i] > 0.0; k++) {
        const fl_piece *wall = &w->structure.piece[w->pieces + k];
        const double distance = v3_dot(normal_of(wall), v3_sub(w->b.x[i], wall->x));
        if (!wall->elastic && distance < 0.0)
            return fl_fail(err, FL_INPUT,
                           "%s: body %d is behind %s, its centre by %.4g m: a position between boundary.min "
                           "and boundary.max expected",
                           w->scene->ice.file, w->id[i], fl_wall_name(w, k, name), -distance);
    }
    return 0;
}

int fl_world_check_walls(const fl_world *w, fl_err *err)
{
    for (int32_t i = 0; i < w->n; i++)
        if (!fl_body_absent(w, i) && check_behind_walls(w, i, err)) return -1;
    return 0;
}

/* A body could touch a piece longer than the cell in two images at once. */
static int check_piece_length(const fl_world *w, int32_t k, const fl_surface *surface, fl_err *err)
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
                "%s: a piece of part %s is %.4g m long, and the periodic %c repeats every %.4g m: bodies "
                "would touch more than one image of it",
                structure_name(w), surface->part[p->part].name, size[c], 'x' + c, length[c]);
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
        if (w->cell.periodic && check_piece_length(w, k, surface, err)) return -1;
        if (piece->kind ==
            FL_PIECE_MESH) { /* its core has the corners of its box, for the neighbour search */
            fl_vec3 corner[8];
            const fl_aabb box = aabb_grow(piece->mesh.tree.node[0].box, piece->facet_error);
            for (int c = 0; c < 8; c++)
                corner[c] =
                    v3(c & 1 ? box.hi.x : box.lo.x, c & 2 ? box.hi.y : box.lo.y, c & 4 ? box.hi.z : box.lo.z);
            fl_poly *p = &w->b.core[j];
            p->v = fl_alloc(8, sizeof *p->v, err);
            if (!p->v) return -1;
            memcpy(p->v, corner, sizeof corner);
            p->nv = 8;
            w->max_face_area[j] = piece->largest_region_area;
        } else {
            if (fl_poly_copy(&w->b.core[j], &piece->core, err)) return -1;
            w->max_face_area[j] = fl_poly_largest_face_area(&piece->core);
        }
        for (int32_t v = 0; v < w->b.core[j].nv; v++)
            w->b.bounding_radius[j] = fmax(w->b.bounding_radius[j], v3_norm(w->b.core[j].v[v]));
    }
    return 0;
}

/* --- the world --------------------------------------------------------------------------------- */

static int make_arrays(fl_world *w, fl_err *err)
{
    const int64_t total = w->b.total;
    w->id = fl_alloc(w->n, sizeof *w->id, err);
    w->q0 = fl_alloc(w->n, sizeof *w->q0, err);
    w->material = fl_alloc(total, sizeof *w->material, err);
    w->max_face_area = fl_alloc(total, sizeof *w->max_face_area, err);
    w->blocks = fl_alloc(w->n / FL_BODY_BLOCK + 1, sizeof *w->blocks, err);
    w->odometer_at_search = fl_alloc(total, sizeof *w->odometer_at_search, err);
    w->body_touches = fl_alloc(total, sizeof *w->body_touches, err);
    w->part_impulse = fl_alloc(w->parts, sizeof *w->part_impulse, err);
    w->part_moment = fl_alloc(w->parts, sizeof *w->part_moment, err);
    w->part_force = fl_alloc(w->parts, sizeof *w->part_force, err);
    w->part_torque = fl_alloc(w->parts, sizeof *w->part_torque, err);
    w->part_reference = fl_alloc(w->parts, sizeof *w->part_reference, err);
    w->part_peak = fl_alloc(w->parts, sizeof *w->part_peak, err);
    w->scratch = fl_alloc(w->threads, sizeof *w->scratch, err);
    w->pair_share = fl_alloc(w->threads, sizeof *w->pair_share, err);
    w->block_share = fl_alloc(w->threads, sizeof *w->block_share, err);
    w->mesh_near = fl_alloc(w->threads, sizeof *w->mesh_near, err);
    if (fl_pair_law_any_quick(w->scene)) {
        w->quick_shape = fl_alloc(total, sizeof *w->quick_shape, err);
        w->quick_scratch = fl_alloc(w->threads, sizeof *w->quick_scratch, err);
    }
    return err->code ? -1 : 0;
}

/* A group of the scene without a record in the fields is a mistyped name: its bodies would be free. */
static int check_groups(const fl_world *w, const fl_ice_field *field, const fl_ice_field *feed, fl_err *err)
{
    for (int32_t g = 0; g < w->scene->n_group; g++) {
        const char *name = w->scene->group[g].name;
        char key[2 * FL_SCENE_NAME];
        snprintf(key, sizeof key, "group %s.fixed", name);
        if (fl_string_table_find(&field->groups, name) < 0 && fl_string_table_find(&feed->groups, name) < 0)
            return fl_scene_fail(w->scene, key, err, "no body of %s is of the group %s", w->scene->ice.file,
                                 name);
    }
    return 0;
}

/* Mark the floes of the ice that are driven. */
static int make_driven_floes(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    const double v = fabs(s->drive.x) >= fabs(s->drive.y) ? s->drive.x : s->drive.y;
    const int auto_axis = fabs(s->drive.x) < fabs(s->drive.y);
    /* the edge is at the smallest `sign` times coordinate */
    const fl_inflow_state edge = {.axis = s->drive_edge ? (s->drive_edge - 1) / 2 : auto_axis,
                                  .sign = s->drive_edge ? (s->drive_edge % 2 ? 1.0 : -1.0)
                                                        : (v > 0.0 ? 1.0 : -1.0)};
    double back = INFINITY;
    int some = 0;
    if (!s->head.present || (s->drive_width <= 0.0 && !s->drive_group[0])) return 0;
    w->driven_floes.is_driven = fl_alloc(field->n, sizeof *w->driven_floes.is_driven, err);
    w->driven_floes.k = fl_alloc(w->n, sizeof *w->driven_floes.k, err);
    w->driven_floes.rest_height = fl_alloc(w->n, sizeof *w->driven_floes.rest_height, err);
    if (!w->driven_floes.is_driven || !w->driven_floes.k || !w->driven_floes.rest_height) return -1;
    w->driven_floes.n = field->n;
    if (s->drive_track[0] && fl_drive_track_read(w, err)) return -1;
    for (int32_t k = 0; k < field->n; k++) back = fmin(back, fl_inflow_extent(&edge, field, k, -1.0));
    for (int32_t k = 0; k < field->n; k++) {
        const double middle =
            0.5 * (fl_inflow_extent(&edge, field, k, -1.0) + fl_inflow_extent(&edge, field, k, 1.0));
        const char *group = field->group[k] < 0 ? "" : field->groups.name[field->group[k]];
        w->driven_floes.is_driven[k] =
            s->drive_group[0] ? strcmp(group, s->drive_group) == 0 : middle - back <= s->drive_width;
        some |= w->driven_floes.is_driven[k];
        const int32_t g = w->driven_floes.is_driven[k] ? fl_scene_find_group(w->scene, group) : -1;
        if (g >= 0 && w->scene->group[g].fixed & s->drive_fixed & (FL_DOF_X | FL_DOF_Y | FL_DOF_Z)) {
            char what[2 * FL_SCENE_NAME];
            snprintf(what, sizeof what, "both [group %s] and boundary.drive prescribe its motion", group);
            return fl_fail_floe(w, field, k, err, what);
        }
    }
    if (some) return 0;
    if (s->drive_group[0])
        return fl_fail(err, FL_INPUT, "%s: no body is of the group %s, which boundary.drive_group names",
                       w->scene->ice.file, s->drive_group);
    return fl_fail(err, FL_INPUT, "%s: no body is within %g m of the edge, boundary.drive_width",
                   w->scene->ice.file, s->drive_width);
}

static int only_points(const fl_ice_field *f)
{
    for (int32_t k = 0; k < f->n; k++)
        if (f->core[k].nv != 1) return 0;
    return 1;
}

static int has_points(const fl_ice_field *f)
{
    for (int32_t k = 0; k < f->n; k++)
        if (f->core[k].nv == 1) return 1;
    return 0;
}

/* Set how much more than its own volume a sphere stands for. */
static int set_slab(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    const double h = w->scene->ice.slab;
    double phi, radius = 0.0;
    int32_t n = 0;
    w->slab_fill = 1.0;
    if (h == 0.0) return 0;
    fl_vec3 *x = fl_alloc(field->n, sizeof *x, err);
    if (!x) return -1;
    int equal = 1;
    for (int32_t k = 0; k < field->n; k++) {
        if (field->core[k].nv != 1) continue;
        if (n == 0) radius = field->radius[k];
        equal &= fabs(field->radius[k] - radius) <= EQUAL_RADII * radius;
        x[n++] = field->core[k].v[0];
    }
    int rc =
        equal ? 0
              : fl_scene_fail(w->scene, "ice.slab", err,
                              "the spheres of %s are not equal: no slab is made of them", w->scene->ice.file);
    fl_err why = {0};
    if (rc == 0 && fl_slab_fill(n, x, radius, h, &phi, &why))
        rc = why.code == FL_INPUT ? fl_fail(err, FL_INPUT, "%s: %s", w->scene->ice.file, why.text)
                                  : (*err = why, -1);
    if (rc == 0) w->slab_fill = 1.0 / phi;
    free(x);
    return rc;
}

/* Winding number of a surface about x: 1 inside a surface with outward normals, 0 in its cavities. */
static double winding_number(const fl_part *p, fl_vec3 x)
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

/* A closed part with inward normals is solid outside: a tank holds its floes, but of a post that is
 * inside out the floes around it would be in the solid.  Floes in the solid between a surface and its
 * cavities are not checked here. */
static int check_inward(const fl_world *w, const fl_surface *surface, fl_err *err)
{
    for (int32_t k = 0; k < w->structure.n; k++) {
        const fl_piece *piece = &w->structure.piece[k];
        for (int32_t i = 0; i < w->n && piece->inward_triangle; i++) {
            if (fl_body_absent(w, i)) continue;
            const fl_vec3 x = q_rotate(q_conj(piece->q), v3_sub(w->b.x[i], piece->x));
            const fl_part *p = &surface->part[piece->part];
            if (!fl_mesh_contact_contains(piece, x) || winding_number(p, w->b.x[i]) > 0.5) continue;
            const int rows = p->line > 0 && p->last_line - p->line == p->nt - 1; /* one triangle a line */
            return fl_fail(
                err, FL_INPUT,
                "%s: part %s: its triangles, from line %d on, have inward normals, so all outside is "
                "solid, and body %d is there: struct-import turns them",
                structure_name(w), p->name, p->line + (rows ? piece->inward_triangle - 1 : 0), w->id[i]);
        }
    }
    return 0;
}

/* Ice that crushes around a part of the structure would never load it. */
static int check_pierced(const fl_world *w, const fl_ice_field *field, const fl_surface *surface, fl_err *err)
{
    for (int32_t i = 0; i < field->n && w->crushing.of != FL_CRUSHING_NONE; i++) {
        char what[2 * FL_SCENE_NAME + 128];
        const int32_t k = fl_crushing_pierced_by(w, i);
        if (k < 0) continue;
        snprintf(what, sizeof what,
                 "part %.*s of the structure goes through it, and with failure.crushing no side of it would "
                 "bear a load: a floe beside it expected",
                 FL_SCENE_NAME, surface->part[w->structure.piece[k].part].name);
        return fl_fail_floe(w, field, i, err, what);
    }
    return 0;
}

int fl_world_make(fl_world *w, const fl_scene *scene, const fl_ice_field *field, const fl_surface *surface,
                  fl_err *err)
{
    return fl_world_make_with_inflow(w, scene, field, field, surface, NULL, err);
}

int fl_world_make_with_inflow(fl_world *w, const fl_scene *scene, const fl_ice_field *field,
                              const fl_ice_field *feed, const fl_surface *surface,
                              const fl_member_model *members, fl_err *err)
{
    double bound = 0.0;
    *w = (fl_world){.scene = scene, .n = field->n, .last_search_step = -1, .gravity = scene->run.gravity};
    fl_barrier_make(&w->barrier);
    w->threads = scene->run.threads > 0 ? scene->run.threads : omp_get_max_threads();
    if (w->threads > 1 + field->n / BODIES_PER_THREAD) w->threads = 1 + field->n / BODIES_PER_THREAD;
    omp_set_num_threads(w->threads);
    fl_thread_count_make(&w->team, w->threads, scene->run.threads == 0);
    w->dt_critical = w->dt_critical_contacts = INFINITY;
    w->max_overlap_i = w->max_overlap_j = w->critical_body = -1;
    w->parts = surface ? surface->n : 0;
    make_cell(w);
    if ((surface && make_pieces(w, surface, members != NULL, err)) || make_walls(w, err)) goto fail;
    if (check_groups(w, field, feed, err) || fl_inflow_make(w, field, feed, err) ||
        make_driven_floes(w, field, err))
        goto fail;
    w->pieces = w->structure.n - w->walls;
    w->sea.only_spheres = only_points(field) && only_points(feed);
    if (fl_bodies_alloc(&w->b, w->n, w->n + w->structure.n, err) || make_arrays(w, err) ||
        fl_contact_sums_make(w, err) || make_elastic_walls(w, err) ||
        fl_environment_set_up(&w->sea, &w->b, w->scene, w->n, w->threads, err))
        goto fail;
    w->has_points = has_points(field) || has_points(feed);
    if (set_slab(w, field, err)) goto fail;
    if (w->has_points && fl_structure_prepare_spheres(&w->structure, err)) goto fail;
    if (w->has_points && w->sea.n && !(w->drag_change = fl_alloc(w->n, sizeof *w->drag_change, err)))
        goto fail;
    for (int32_t i = 0; i < field->n; i++) {
        if (fl_world_place_floe(w, i, field, i, err)) goto fail;
        bound += w->b.bounding_radius[i] + w->b.radius[i];
    }
    w->inflow.places = w->inflow.floes = field->n;
    /* Places for floes to come are filled with such floes, so that the step is chosen for them, too. */
    for (int32_t i = field->n; i < w->n; i++) {
        w->inflow.source_floe[i] = (i - field->n) % feed->n;
        w->inflow.absent[i] = 1;
        if (fl_world_place_floe(w, i, feed, w->inflow.source_floe[i], err)) goto fail;
        if (!w->inflow.feed) w->inflow.source_floe[i] = -1;
    }
    if (fl_breaking_make(w, err) || place_pieces(w, surface, err) ||
        fl_moving_structure_make(w, surface, members, err) || fl_panels_make(w, surface, err) ||
        fl_strips_make(w, err) || fl_sleep_make(w, err) || fl_pair_law_make_table(w, err) ||
        fl_zones_make(w, field, err) || fl_bond_list_make(w, field, err) || fl_zones_join(w, field, err) ||
        fl_inflow_bonds_make(w, err) || fl_relaxed_run_make(w, err) || fl_crushing_make(w, err) ||
        fl_ice_push_make(w, field, feed, err))
        goto fail;
    if (check_inward(w, surface, err) || check_pierced(w, field, surface, err)) goto fail;
    /* A tenth of a mean floe: large enough to search seldom, small enough to list few pairs that never
     * touch. */
    w->skin = field->n ? 0.1 * bound / field->n : 0.0;
    w->candidates.absent = w->inflow.absent;
    return 0;
fail:
    fl_world_free(w);
    return -1;
}

void fl_world_free(fl_world *w)
{
    for (int32_t k = 0; k < w->threads; k++) {
        if (w->scratch) fl_patch_points_free(&w->scratch[k]);
        if (w->mesh_near) fl_mesh_contact_work_free(&w->mesh_near[k]);
        if (w->quick_scratch) fl_quick_scratch_free(&w->quick_scratch[k]);
    }
    for (int32_t i = 0; i < w->n; i++) {
        if (w->elastic_walls.hull) fl_hull_free(&w->elastic_walls.hull[i]);
        if (w->elastic_walls.outer) fl_poly_free(&w->elastic_walls.outer[i]);
    }
    for (int32_t i = 0; w->quick_shape && i < w->b.total; i++) fl_quick_shape_free(&w->quick_shape[i]);
    free(w->quick_shape), free(w->quick_scratch);
    free(w->elastic_walls.hull), free(w->elastic_walls.outer);
    fl_track_free(&w->driven_floes.track);
    free(w->driven_floes.is_driven), free(w->driven_floes.k), free(w->driven_floes.rest_height);
    fl_device_free(w);
    fl_inflow_free(&w->inflow);
    fl_crushing_free(w);
    fl_breaking_free(w);
    fl_neighbour_pairs_free(w);
    free(w->first_pair_of_body), free(w->pairs_of_body), free(w->scratch), free(w->mesh_near),
        free(w->surrogate_counts);
    free(w->pair_touches), free(w->next_check), free(w->touching_pairs), free(w->body_touches),
        free(w->pair_share), free(w->block_share);
    fl_contact_list_free(&w->spheres);
    free(w->id), free(w->q0), free(w->material), free(w->max_face_area), free(w->law), free(w->box),
        free(w->cell_of_body);
    free(w->blocks), free(w->drag_change);
    free(w->odometer_at_search), free(w->part_impulse), free(w->part_moment), free(w->part_force),
        free(w->part_torque);
    free(w->part_peak), free(w->part_reference);
    fl_contact_sums_free(w);
    fl_moving_structure_free(&w->moving);
    fl_sleep_free(&w->sleep);
    fl_bond_list_free(&w->bonds);
    fl_relaxed_run_free(&w->relax);
    fl_disc_list_free(&w->discs);
    fl_zones_free(&w->zones);
    fl_panels_free(&w->panel_load);
    fl_strips_free(&w->strips);
    fl_pairs_free(&w->candidates);
    fl_environment_free(&w->sea);
    fl_bodies_free(&w->b);
    fl_topologies_free(&w->topologies);
    fl_structure_free(&w->structure);
    fl_barrier_free(&w->barrier);
    *w = (fl_world){0};
}
