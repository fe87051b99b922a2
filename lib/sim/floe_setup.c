/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/floe_setup.h"
#include "sim/drive_track.h"
#include <math.h>
#include <stdio.h>
#include "base/pi.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "water/added_mass.h"
#include "world/access.h"

/* Fix the degrees of freedom of the body's group, translations at its velocity, rotations at 0. */
static void fix_body(fl_world *w, int32_t i, const char *group, fl_vec3 spin)
{
    fl_bodies *b = &w->b;
    const int32_t g = fl_scene_find_group(w->scene, group);
    if (g < 0) return;
    const unsigned fixed = w->scene->group[g].fixed;
    const fl_vec3 velocity = w->scene->group[g].velocity;
    b->fixed_dof[i] = (uint8_t)fixed;
    if (fixed & FL_DOF_X) b->v[i].x = velocity.x;
    if (fixed & FL_DOF_Y) b->v[i].y = velocity.y;
    if (fixed & FL_DOF_Z) b->v[i].z = velocity.z;
    fl_body_set_spin(b, i,
                     v3(fixed & FL_DOF_RX ? 0.0 : spin.x, fixed & FL_DOF_RY ? 0.0 : spin.y,
                        fixed & FL_DOF_RZ ? 0.0 : spin.z));
}

int fl_fail_floe(const fl_world *w, const fl_ice_field *field, int32_t k, fl_err *err, const char *what)
{
    char line[16] = "";
    if (field->record_line[k] > 0) snprintf(line, sizeof line, ":%d", field->record_line[k]);
    return fl_fail(err, FL_INPUT, "%s%s: body %d: %s", w->scene->ice.file, line, field->id[k], what);
}

/* Dilation of a core of radius 0, over its size: an edge without a radius has no stiffness. */
#define SHARP 1e-6

/* Build body i, of material w->material[i], from its core in the pose of the ice file: outer shape, mass,
 * frame. The outer shape is needed for the hull. */
static int make_shape(fl_world *w, int32_t i, const fl_poly *core, double r, fl_poly *outer, fl_err *why)
{
    const fl_scene *s = w->scene;
    fl_bodies *b = &w->b;
    const int sharp = s->ice.shape == FL_SHAPE_SHARP && core->nf > 0;
    fl_mass mass;
    if (sharp && (r > 0.0 ? fl_poly_offset(outer, core, r, why) : fl_poly_copy(outer, core, why))) return -1;
    if (fl_mass_of(&mass, sharp ? outer : core, sharp ? 0.0 : r, why)) return -1;

    const double rho = s->material[w->material[i]].density;
    const double solid = core->nv == 1 ? w->slab_fill * rho : rho;
    b->m[i] = solid * mass.volume;
    b->invm[i] = 1.0 / b->m[i];
    fl_body_set_inertia(b, i, v3_scale(solid, mass.inertia));
    b->x[i] = mass.centre;
    b->q[i] = q_of_matrix(mass.axes);
    const fl_mat3 axes = q_matrix(b->q[i]);
    if (fl_poly_copy(&b->core[i], core, why)) return -1;
    fl_poly_to_frame(&b->core[i], b->x[i], axes);
    if (sharp) fl_poly_to_frame(outer, b->x[i], axes);
    for (int32_t v = 0; v < core->nv; v++)
        b->bounding_radius[i] = fmax(b->bounding_radius[i], v3_norm(b->core[i].v[v]));
    b->radius[i] = r > 0.0 ? r : SHARP * b->bounding_radius[i];
    w->max_face_area[i] = fl_poly_largest_face_area(&b->core[i]);
    if (w->quick_shape && b->core[i].nf > 0 &&
        fl_quick_shape_make(&w->quick_shape[i], &b->core[i], b->radius[i], why))
        return -1;
    w->q0[i] = b->q[i];
    fl_body_update_spin(b, i);
    return 0;
}

static int share_topology(fl_world *w, int32_t i, fl_err *err)
{
    return fl_topologies_share(&w->topologies, &w->b.core[i],
                               w->has_points ? FL_KEEP_ANGLES | FL_KEEP_OFFSETS : FL_KEEP_ANGLES, err);
}

/* Build body i from record k of the field, with its start. */
static int make_body(fl_world *w, int32_t i, const fl_ice_field *field, int32_t k, fl_poly *outer,
                     fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_bodies *b = &w->b;
    const char *material =
        field->material[k] >= 0 ? field->materials.name[field->material[k]] : s->ice.material;
    fl_err why = {0};
    w->id[i] = field->id[k];
    w->material[i] = fl_scene_find_material(s, material);
    if (w->material[i] < 0) {
        char what[400];
        snprintf(what, sizeof what, "material %.350s is not in the scene", material);
        return fl_fail_floe(w, field, k, err, what);
    }
    if (make_shape(w, i, &field->core[k], field->radius[k], outer, &why)) {
        if (why.code != FL_SYSTEM) return fl_fail_floe(w, field, k, err, why.text);
        *err = why;
        return -1;
    }
    b->v[i] = field->velocity[k];
    fl_body_set_spin(b, i, field->spin[k]);
    if (field->group[k] >= 0) fix_body(w, i, field->groups.name[field->group[k]], field->spin[k]);
    return share_topology(w, i, err);
}

/* Set added mass and inertia of body i, of shape p. */
static void set_added_mass(fl_world *w, int32_t i, const fl_poly *p)
{
    const fl_scene_water *s = &w->scene->water;
    fl_bodies *b = &w->b;
    const fl_vec3 spin = b->w[i], up = m3_tmul(fl_body_axes(b, i), v3(0, 0, 1));
    if (b->added_mass)
        b->added_mass[i] = fl_added_mass(p, up, fmin(b->m[i], s->density * w->sea.hull[i].volume), s->density,
                                         s->added_mass);
    fl_body_set_inertia(b, i,
                        v3_add(b->I[i], fl_added_inertia(p, up, b->I[i], s->density, s->added_inertia)));
    fl_body_set_spin(b, i, spin);
}

/* Set up body i for water and wind: hull and drag. */
static int make_hull(fl_world *w, int32_t i, fl_poly *outer, fl_err *err)
{
    const fl_poly *core = &w->b.core[i];
    const int round = core->nv <= 2;
    if (!round && outer->nv == 0)
        return fl_fail(err, FL_INPUT,
                       "%s: body %d: ice.shape = round has no hydrostatics of a polyhedron; use sharp with "
                       "[water] or [wind]",
                       w->scene->ice.file, w->id[i]);
    if (!round && fl_topologies_share(&w->topologies, outer, FL_KEEP_OFFSETS, err)) return -1;
    if (fl_environment_set_hull(&w->sea, i, round ? NULL : outer, core, w->b.radius[i], err)) return -1;
    if (core->nv == 1) fl_hull_fill(&w->sea.hull[i], w->slab_fill);
    if (w->b.added_mass || v3_nonzero(w->scene->water.added_inertia))
        set_added_mass(w, i,
                       round                              ? core
                       : fl_environment_outer(&w->sea, i) ? fl_environment_outer(&w->sea, i)
                                                          : outer);
    if (fl_environment_fit_hull(&w->sea, i, err)) return -1;
    if (w->b.heave_mass) fl_environment_refresh(&w->sea, &w->b, i);
    return 0;
}

/* Set up body i for elastic walls.  Its sharp corners are outside the dilated core, which enlarges the
 * bounding radius. */
static int make_wall_hull(fl_world *w, int32_t i, const fl_poly *outer, fl_err *err)
{
    const fl_poly *core = &w->b.core[i];
    const int round = core->nv <= 2;
    fl_poly *p = &w->elastic_walls.outer[i];
    if (!round && outer->nv == 0)
        return fl_fail(err, FL_INPUT,
                       "%s: body %d: ice.shape = round has no volume behind an elastic wall; use sharp",
                       w->scene->ice.file, w->id[i]);
    if (!round && fl_poly_copy(p, outer, err)) return -1;
    for (int32_t v = 0; v < p->nv; v++)
        w->b.bounding_radius[i] = fmax(w->b.bounding_radius[i], v3_norm(p->v[v]));
    return fl_hull_make(&w->elastic_walls.hull[i], round ? core : p, round ? w->b.radius[i] : 0.0, err);
}

#define MAX_CELLS 1e6 /* largest distance of a body from the origin, in cells */

/* A body larger than half the cell could touch two images of another body at once, or its own. */
static int check_size(const fl_world *w, int32_t i, fl_err *err)
{
    const double length[3] = {w->cell.length.x, w->cell.length.y, w->cell.length.z};
    const fl_poly *p = &w->b.core[i];
    double size = 0.0;
    for (int32_t a = 0; a < p->nv; a++)
        for (int32_t b = 0; b < a; b++) size = fmax(size, v3_norm2(v3_sub(p->v[a], p->v[b])));
    size = sqrt(size) + 2.0 * w->b.radius[i];
    const fl_vec3 at = w->b.x[i];
    const double x[3] = {at.x, at.y, at.z};
    for (int c = 0; c < 3; c++)
        if (length[c] > 0.0 && !(fabs(x[c]) < MAX_CELLS * length[c] && isfinite(length[c])))
            return fl_fail(
                err, FL_INPUT,
                "%s: body %d at %c = %.4g m, and the periodic %c repeats every %.4g m: within %.3g of "
                "these expected",
                w->scene->ice.file, w->id[i], 'x' + c, x[c], 'x' + c, length[c], MAX_CELLS);
    for (int c = 0; c < 3; c++)
        if (length[c] > 0.0 && size > 0.5 * length[c])
            return fl_fail(err, FL_INPUT,
                           "%s: body %d is %.4g m across, more than half of the %.4g m of the periodic %c; a "
                           "wider cell expected",
                           w->scene->ice.file, w->id[i], size, length[c], 'x' + c);
    return 0;
}

/* Drive the floe in place i; degrees of freedom fixed by its group stay fixed. */
static void drive_body(fl_world *w, int32_t i)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_bodies *b = &w->b;
    const fl_vec3 spin = b->w[i];
    const unsigned driven = s->drive_fixed, fixed = driven | b->fixed_dof[i];
    const double area = b->core[i].nv == 1 ? PI * b->radius[i] * b->radius[i] : w->max_face_area[i];
    const fl_vec3 v = w->driven_floes.track.n ? fl_drive_track_velocity(w, 0.0) : s->drive;
    b->fixed_dof[i] = (uint8_t)fixed;
    if (driven & FL_DOF_X) b->v[i].x = v.x;
    if (driven & FL_DOF_Y) b->v[i].y = v.y;
    if (driven & FL_DOF_Z) b->v[i].z = v.z;
    fl_body_set_spin(b, i,
                     v3(fixed & FL_DOF_RX ? 0.0 : spin.x, fixed & FL_DOF_RY ? 0.0 : spin.y,
                        fixed & FL_DOF_RZ ? 0.0 : spin.z));
    w->driven_floes.k[i] = fixed & FL_DOF_Z ? 0.0 : s->drive_spring + s->drive_foundation * area;
    w->driven_floes.rest_height[i] = b->x[i].z;
}

/* Free the shape in place i. */
static void clear_place(fl_world *w, int32_t i)
{
    fl_poly_free(&w->b.core[i]);
    if (w->quick_shape) fl_quick_shape_free(&w->quick_shape[i]);
    w->b.bounding_radius[i] = 0.0;
    w->b.is_isotropic[i] = 0;
    if (w->elastic_walls.hull)
        fl_hull_free(&w->elastic_walls.hull[i]), fl_poly_free(&w->elastic_walls.outer[i]);
    if (w->sea.n) fl_environment_clear_hull(&w->sea, i);
}

/* What walls, water and wind need of body i. */
static int make_hulls(fl_world *w, int32_t i, fl_poly *outer, fl_err *err)
{
    if ((w->cell.periodic && check_size(w, i, err)) ||
        (w->elastic_walls.hull && make_wall_hull(w, i, outer, err)) ||
        (w->sea.n && make_hull(w, i, outer, err)))
        return -1;
    w->b.is_isotropic[i] = (uint8_t)fl_body_is_isotropic(&w->b, i);
    return 0;
}

int fl_world_place_floe(fl_world *w, int32_t i, const fl_ice_field *field, int32_t k, fl_err *err)
{
    fl_poly outer = {0};
    clear_place(w, i);
    w->b.fixed_dof[i] = 0;
    const int bad = make_body(w, i, field, k, &outer, err) || make_hulls(w, i, &outer, err);
    fl_poly_free(&outer);
    if (bad) return -1;
    if (fl_floe_is_driven(w, i)) drive_body(w, i);
    return 0;
}

int fl_world_place_shape(fl_world *w, int32_t i, const fl_poly *core, double r, fl_err *err)
{
    fl_poly outer = {0};
    clear_place(w, i);
    const int bad =
        make_shape(w, i, core, r, &outer, err) || share_topology(w, i, err) || make_hulls(w, i, &outer, err);
    fl_poly_free(&outer);
    return bad ? -1 : 0;
}
