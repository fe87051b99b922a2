/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/joint_list.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "contact/bond_image.h"
#include "geom/clip.h"
#include "world/access.h"

int32_t fl_joint_list_count(const fl_world *w, const fl_ice_field *field)
{
    return w->scene->n_joint || w->zones.set.blocks ? field->joints : 0;
}

/* --- laws --------------------------------------------------------------------------------------- */

static int fail_joint(const fl_scene_joint *s, const char *what, fl_err *err)
{
    return fl_fail(err, FL_INPUT, "[joint %s] %s", s->name, what);
}

static int check_yielding(const fl_scene_joint *s, fl_err *err)
{
    if (!(s->roughness > 0.0)) return fail_joint(s, "has no roughness, law = yielding needs it", err);
    if (!(s->initial_angle > 0.0)) return fail_joint(s, "has no initial_angle, law = yielding needs it", err);
    if (s->friction_angle < 0.0) return fail_joint(s, "has no friction_angle, law = yielding needs it", err);
    if (s->normal_exponent > 0.0 && isinf(s->largest_normal_stiffness))
        return fail_joint(
            s, "has a normal_exponent and no largest_normal_stiffness, from which the step follows", err);
    if (s->shear_exponent > 0.0 && isinf(s->largest_shear_stiffness))
        return fail_joint(
            s, "has a shear_exponent and no largest_shear_stiffness, from which the step follows", err);
    if (s->initial_angle < s->friction_angle)
        return fail_joint(s, "has an initial_angle below its friction_angle, to which it falls", err);
    return 0;
}

/* Keys of the other law would have no effect. */
static int check_keys(const fl_scene_joint *s, fl_err *err)
{
    const struct {
        int law, is_given;
        const char *key;
    } key[] = {{FL_JOINT_COULOMB, s->cohesion != 0.0, "cohesion"},
               {FL_JOINT_COULOMB, s->tension != 0.0, "tension"},
               {FL_JOINT_COULOMB, s->dilation != 0.0, "dilation"},
               {FL_JOINT_COULOMB, s->residual_friction >= 0.0, "residual_friction"},
               {FL_JOINT_COULOMB, s->residual_cohesion != 0.0, "residual_cohesion"},
               {FL_JOINT_YIELDING, s->roughness > 0.0, "roughness"},
               {FL_JOINT_YIELDING, s->initial_angle > 0.0, "initial_angle"},
               {FL_JOINT_YIELDING, s->normal_exponent != 0.0, "normal_exponent"},
               {FL_JOINT_YIELDING, s->shear_exponent != 0.0, "shear_exponent"}};
    for (int k = 0; k < (int)(sizeof key / sizeof *key); k++)
        if (key[k].is_given && key[k].law != s->law)
            return fl_fail(err, FL_INPUT, "[joint %s] has %s, which law = %s does not use", s->name,
                           key[k].key, fl_joint_laws[s->law].name);
    return 0;
}

static int make_law(const fl_scene_joint *s, fl_joint_material *m, fl_err *err)
{
    const double turn = PI / 180.0;
    if (!(s->normal_stiffness > 0.0)) return fail_joint(s, "has no normal_stiffness", err);
    if (!(s->shear_stiffness > 0.0)) return fail_joint(s, "has no shear_stiffness", err);
    if (s->friction > 0.0 && s->friction_angle >= 0.0)
        return fail_joint(s, "has friction and friction_angle, one of them is expected", err);
    if (check_keys(s, err) || (s->law == FL_JOINT_YIELDING && check_yielding(s, err))) return -1;
    const double friction = s->friction_angle >= 0.0 ? tan(s->friction_angle * turn) : s->friction;
    *m = (fl_joint_material){.law = s->law,
                             .kn = s->normal_stiffness,
                             .ks = s->shear_stiffness,
                             .friction = friction,
                             .residual_friction =
                                 s->residual_friction >= 0.0 ? s->residual_friction : friction,
                             .cohesion = s->cohesion,
                             .tension = s->tension,
                             .residual_cohesion = s->residual_cohesion,
                             .dilation = tan(s->dilation * turn),
                             .dilation_slip = s->dilation_slip,
                             .water_pressure = s->water_pressure,
                             .normal_exponent = s->normal_exponent,
                             .shear_exponent = s->shear_exponent,
                             .kn_most = s->largest_normal_stiffness,
                             .ks_most = s->largest_shear_stiffness,
                             .angle = fmax(0.0, s->friction_angle) * turn,
                             .initial_angle = s->initial_angle * turn,
                             .roughness = s->roughness};
    if (m->dilation > fmin(m->friction, m->residual_friction))
        return fail_joint(s, "has a dilation above its friction: slip would do work", err);
    return 0;
}

/* --- set-up ------------------------------------------------------------------------------------- */

static fl_vec3 joint_image_offset(const fl_world *w, int32_t k)
{
    const int32_t *image = &w->bonds.image[3 * k];
    return w->cell.periodic ? fl_periodic_cell_offset(&w->cell, v3(image[0], image[1], image[2]))
                            : v3(0, 0, 0);
}

static int make_outer_shape(const fl_world *w, const fl_ice_field *field, int32_t k, fl_poly *out,
                            fl_err *err)
{
    fl_err why = {0};
    if (out->nv) return 0;
    if (field->radius[k] > 0.0 ? fl_poly_offset(out, &field->core[k], field->radius[k], &why)
                               : fl_poly_copy(out, &field->core[k], &why))
        return fl_fail(err, why.code, "%s: body %d: %s", w->scene->ice.file, field->id[k], why.text);
    if (out->nf == field->core[k].nf) return 0;
    return fl_fail(err, FL_INPUT,
                   "%s: body %d: the outer shape has other faces than the core, its joints have none",
                   w->scene->ice.file, field->id[k]);
}

/* Appends the corners of a face in the frame of body b, whose world beside the first body is moved by way. */
static int add_corners(fl_world *w, int32_t *cap, int32_t b, const fl_poly *p, int32_t f, fl_err *err)
{
    fl_bond_list *s = &w->bonds;
    const int32_t n = p->first[f + 1] - p->first[f];
    const fl_mat3 R = fl_body_axes(&w->b, b);
    if (n > FL_JOINT_CORNERS)
        return fl_fail(err, FL_INPUT, "%s: face %d of body %d has %d corners, at most %d may have a joint",
                       w->scene->ice.file, f, w->id[b], n, FL_JOINT_CORNERS);
    if (fl_grow(&s->corner, cap, (int64_t)s->corners + n, sizeof *s->corner, err)) return -1;
    for (int32_t k = 0; k < n; k++)
        s->corner[s->corners++] = m3_tmul(R, v3_sub(p->v[p->loop[p->first[f] + k]], w->b.x[b]));
    return 0;
}

/* A bonded face without limit in place of a joint: E/l, G/l of the materials. */
static void make_intact(const fl_world *w, fl_bond *c, fl_vec3 way)
{
    const fl_scene_material *A = &w->scene->material[w->material[c->i]],
                            *B = &w->scene->material[w->material[c->j]];
    const fl_vec3 off = v3_add(v3_sub(w->b.x[c->j], w->b.x[c->i]), way),
                  n = m3_mul(fl_body_axes(&w->b, c->i), c->ni);
    const double l = fmax(fabs(v3_dot(off, n)), 0.1 * v3_norm(off)),
                 E = 2.0 / (1.0 / A->young + 1.0 / B->young), nu = 0.5 * (A->poisson + B->poisson);
    c->length = l;
    c->kn = E / l, c->ks = 0.5 * E / (1.0 + nu) / l;
    c->tensile_strength = c->cohesion = INFINITY;
    c->h0 = 0.0;
}

/* True if the two faces lie in one plane, to a millionth of the distance of their first corners, and face
 * each other. */
static int is_one_plane(const fl_bodies *b, const fl_bond *c, const fl_joint *q, const fl_vec3 *corner,
                        fl_vec3 way)
{
    const fl_mat3 Ri = fl_body_axes(b, c->i), Rj = fl_body_axes(b, c->j);
    const fl_vec3 xi = v3_add(b->x[c->i], m3_mul(Ri, corner[q->first])),
                  xj = v3_add(v3_add(b->x[c->j], way), m3_mul(Rj, corner[q->first + q->ni])),
                  n = m3_mul(Ri, c->ni), apart = v3_sub(xj, xi);
    const double size = v3_norm(v3_sub(corner[q->first + 1], corner[q->first])) + v3_norm(apart);
    return v3_dot(n, m3_mul(Rj, c->nj)) > 0.999 && fabs(v3_dot(n, apart)) < 1e-6 * size;
}

static int make_joint(fl_world *w, int32_t k, const fl_ice_field_joint *d, const char *name, int32_t law,
                      const fl_poly *shape, int32_t *cap, fl_err *err)
{
    static const fl_joint_material FREE = {.kn = 1.0, .ks = 1.0};
    fl_bond_list *s = &w->bonds;
    const fl_bodies *b = &w->b;
    fl_bond *c = &s->bond[k];
    fl_joint *q = &s->joint[k - s->faces];
    const fl_scene_joint *scene = law >= 0 ? &w->scene->joint[law] : NULL;
    const fl_poly *p = &shape[d->i], *r = &shape[d->j];
    const fl_vec3 x = p->v[p->loop[p->first[d->fi]]];
    const fl_vec3 ci = fl_bond_cells_between(w, d->i, x),
                  cells = v3_sub(fl_bond_cells_between(w, d->j, x), ci);
    s->image[3 * k] = (int32_t)cells.x, s->image[3 * k + 1] = (int32_t)cells.y,
                 s->image[3 * k + 2] = (int32_t)cells.z;
    const fl_vec3 way = joint_image_offset(w, k);
    *c = (fl_bond){.i = d->i, .j = d->j, .mixed_mode_exponent = 1};
    *q = (fl_joint){.material = 0,
                    .first = s->corners,
                    .ni = p->first[d->fi + 1] - p->first[d->fi],
                    .nj = r->first[d->fj + 1] - r->first[d->fj]};
    if (add_corners(w, cap, d->i, p, d->fi, err) || add_corners(w, cap, d->j, r, d->fj, err)) return -1;
    c->ni = m3_tmul(fl_body_axes(b, d->i), p->n[d->fi]);
    c->nj = m3_tmul(fl_body_axes(b, d->j), v3_neg(r->n[d->fj]));
    const fl_joint_pool pool = {s->corner, scene ? &s->joint_material[law] : &FREE};
    const double S[6] = {scene ? scene->initial_stress.x : 0.0, scene ? scene->initial_stress.y : 0.0,
                         scene ? scene->initial_stress.z : 0.0, scene ? scene->initial_shear.x : 0.0,
                         scene ? scene->initial_shear.y : 0.0,  scene ? scene->initial_shear.z : 0.0};
    if (!is_one_plane(b, c, q, s->corner, way))
        return fl_fail(err, FL_INPUT,
                       "%s: face %d of body %d and face %d of body %d of joint %s do not touch",
                       w->scene->ice.file, d->fi, w->id[d->i], d->fj, w->id[d->j], name);
    if (!fl_joint_start(c, q, pool, b, way, S)) {
        /* a common part without width, as of slivers, bears nothing */
        c->kn = c->ks = 1.0;
        c->area = 0.0;
        fl_bond_end(c);
    }
    q->material = law;
    if (c->state == FL_BOND_ENDED) return 0;
    if (!scene) {
        make_intact(w, c, way);
        return 0;
    }
    c->kn = fl_joint_most_kn(&s->joint_material[law]), c->ks = fl_joint_most_ks(&s->joint_material[law]);
    c->tensile_strength = s->joint_material[law].tension, c->cohesion = s->joint_material[law].cohesion;
    const double m = b->m[c->i] * b->m[c->j] / (b->m[c->i] + b->m[c->j]);
    c->damping = 2.0 * scene->damping / sqrt(c->kn * c->area / m);
    return 0;
}

/* The section of each name of the field. */
static int find_sections(const fl_world *w, const fl_ice_field *field, int32_t *section, fl_err *err)
{
    const fl_scene *s = w->scene;
    for (int32_t k = 0; k < field->joint_names.n; k++) {
        const char *name = field->joint_names.name[k];
        section[k] = -1;
        for (int32_t at = 0; at < s->n_joint; at++)
            if (strcmp(s->joint[at].name, name) == 0) section[k] = at;
        if (section[k] < 0 && strcmp(name, "intact") != 0)
            return fl_fail(err, FL_INPUT, "%s has joints named %s, [joint %s] is expected", s->ice.file, name,
                           name);
    }
    return 0;
}

int fl_joint_list_make(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    fl_bond_list *s = &w->bonds;
    const int32_t n = fl_joint_list_count(w, field);
    fl_poly *shape = fl_alloc(field->n, sizeof *shape, err);
    int32_t *section = fl_alloc(field->joint_names.n, sizeof *section, err), cap = 0;
    int rc = shape && section ? find_sections(w, field, section, err) : -1;
    s->joint = fl_alloc(n, sizeof *s->joint, err);
    s->joint_material = fl_alloc((int64_t)w->scene->n_joint + (w->zones.set.blocks > 0),
                                 sizeof *s->joint_material, err); /* the last: glued zones */
    if (!s->joint || !s->joint_material) rc = -1;
    for (int32_t k = 0; k < w->scene->n_joint && rc == 0; k++)
        rc = make_law(&w->scene->joint[k], &s->joint_material[k], err);
    for (int32_t k = 0; k < n && rc == 0; k++) {
        const fl_ice_field_joint *d = &field->joint[k];
        rc = make_outer_shape(w, field, d->i, &shape[d->i], err) ||
                     make_outer_shape(w, field, d->j, &shape[d->j], err)
                 ? -1
                 : make_joint(w, s->faces + k, d, field->joint_names.name[d->name], section[d->name], shape,
                              &cap, err);
    }
    for (int32_t k = 0; shape && k < field->n; k++) fl_poly_free(&shape[k]);
    free(shape), free(section);
    return rc;
}

void fl_joint_list_free(fl_bond_list *s)
{
    free(s->joint), free(s->corner), free(s->joint_material);
    s->joint = NULL, s->corner = NULL, s->joint_material = NULL;
}

/* --- in a step ---------------------------------------------------------------------------------- */

int fl_joint_list_force(fl_world *w, int32_t k, fl_vec3 way)
{
    fl_bond_list *s = &w->bonds;
    fl_joint *q = &s->joint[k - s->faces];
    if (w->zones.joint_of && w->zones.joint_of[k - s->faces] >= 0)
        return fl_zone_joint_force(&w->zones.joints, w->zones.joint_of[k - s->faces], &w->zones.set,
                                   &s->bond[k], q, (fl_joint_pool){s->corner, s->joint_material}, &w->b,
                                   w->zones.dt);
    return fl_joint_force(&s->bond[k], q, (fl_joint_pool){s->corner, s->joint_material}, &w->b, way);
}

static double polygon_area(const fl_vec3 *v, int32_t n)
{
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = 1; k + 1 < n; k++)
        sum = v3_add(sum, v3_cross(v3_sub(v[k], v[0]), v3_sub(v[k + 1], v[0])));
    return 0.5 * v3_norm(sum);
}

double fl_joint_list_most_area(const fl_world *w, int32_t k)
{
    const fl_bond_list *s = &w->bonds;
    const fl_joint *q = fl_joint_of_bond(s, k);
    if (!q) return s->bond[k].area;
    return fmin(polygon_area(s->corner + q->first, q->ni), polygon_area(s->corner + q->first + q->ni, q->nj));
}

double fl_joint_list_omega2(const fl_world *w, int32_t i, int32_t *stiffest)
{
    const fl_bond_list *s = &w->bonds;
    double sum = 0.0, most = 0.0;
    *stiffest = -1;
    for (int64_t at = s->n ? s->first[i] : 0; s->n && at < s->first[i + 1]; at++) {
        const int32_t k = s->of[at];
        const double part = s->omega2[2 * k + (s->bond[k].i != i)];
        if (!fl_joint_of_bond(s, k)) continue;
        sum += part;
        if (part > most) most = part, *stiffest = k;
    }
    return s->n ? fmin(sum, s->max_omega2[i]) : 0.0;
}

double fl_joint_list_friction_loss(const fl_world *w)
{
    double sum = 0.0;
    for (int32_t k = w->bonds.faces; k < w->bonds.n; k++)
        if (fl_joint_of_bond(&w->bonds, k)) sum += w->bonds.joint[k - w->bonds.faces].friction_loss;
    return sum;
}

fl_joint_counts fl_joint_list_counts(const fl_world *w)
{
    fl_joint_counts n = {0};
    for (int32_t k = w->bonds.faces; k < w->bonds.n; k++) {
        const fl_joint *q = &w->bonds.joint[k - w->bonds.faces];
        if (w->bonds.bond[k].state == FL_BOND_ENDED) n.ended++;
        else if (q->opens == FL_BOND_POINTS) n.open++;
        else if (q->slips || q->opens) n.slip++;
        else n.elastic++;
    }
    return n;
}
