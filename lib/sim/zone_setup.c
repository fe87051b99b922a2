/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/zone_setup.h"
#include <string.h>
#include "base/array.h"
#include "contact/joint_list.h"
#include "geom/clip.h"
#include "world/access.h"

/* A node is in the plane of a side within this share of the size of the model. */
static const double IN_PLANE = 1e-7;
/* Stiffness of a glued face: so many times (lambda + 2 mu)/size.  More would set the time step. */
static const double GLUE = 4.0;

/* --- blocks ------------------------------------------------------------------------------------- */

static fl_zone_material material_of(const fl_scene *s, const fl_scene_material *m)
{
    const fl_scene_zones *z = &s->zones;
    fl_zone_material out = fl_zone_material_of(m->density, m->young, m->poisson);
    if (z->law == FL_ZONE_MOHR_COULOMB)
        fl_zone_material_set_strength(&out, m->cohesion, m->friction_angle, m->tension, m->dilation);
    /* compression is positive in a scene */
    out.initial_stress = (fl_sym3){.xx = -z->initial_stress.x,
                                   .yy = -z->initial_stress.y,
                                   .zz = -z->initial_stress.z,
                                   .xy = -z->initial_shear.x,
                                   .yz = -z->initial_shear.y,
                                   .xz = -z->initial_shear.z};
    return out;
}

static int add_materials(fl_world *w, fl_err *err)
{
    for (int32_t k = 0; k < w->scene->n_material; k++) {
        const fl_zone_material m = material_of(w->scene, &w->scene->material[k]);
        if (fl_zone_set_add_material(&w->zones.set, &m, err)) return -1;
    }
    return 0;
}

static int outer_shape(fl_poly *out, const fl_world *w, const fl_ice_field *field, int32_t k, fl_err *err)
{
    fl_err why = {0};
    if (field->core[k].nf == 0)
        return fl_fail(err, FL_INPUT, "%s: body %d is no polyhedron and cannot have zones",
                       w->scene->ice.file, field->id[k]);
    if (field->radius[k] > 0.0 ? fl_poly_offset(out, &field->core[k], field->radius[k], &why)
                               : fl_poly_copy(out, &field->core[k], &why))
        return fl_fail(err, why.code, "%s: body %d: %s", w->scene->ice.file, field->id[k], why.text);
    return 0;
}

static int add_block(fl_world *w, const fl_ice_field *field, int32_t k, fl_err *err)
{
    const double size = w->scene->zones.size;
    fl_err why = {0};
    fl_poly p = {0};
    fl_zone_mesh m = {0};
    if (outer_shape(&p, w, field, k, err)) return -1;
    const double thick = fl_zone_mesh_thickness(&p);
    int rc = 0;
    if (!(thick > 2.0 * size * (1.0 - 1e-6)))
        rc = fl_fail(err, FL_INPUT, "body %d is %g m thick, less than two zones of zones.size = %g m",
                     w->id[k], thick, size);
    const fl_scene_material *q = &w->scene->material[w->material[k]];
    if (rc == 0 && w->scene->zones.law == FL_ZONE_MOHR_COULOMB && q->cohesion < 0.0)
        rc = fl_fail(err, FL_INPUT,
                     "%s: body %d: [material %s] has no cohesion and friction_angle, zones.law needs them",
                     w->scene->ice.file, field->id[k], q->name);
    if (rc == 0 && fl_zone_mesh_make(&m, &p, size, &why))
        rc = fl_fail(err, why.code, "%s: body %d: %s", w->scene->ice.file, field->id[k], why.text);
    w->zones.block_of[k] = w->zones.set.blocks;
    if (rc == 0) rc = fl_zone_set_add(&w->zones.set, &m, w->material[k], k, err);
    fl_zone_mesh_free(&m), fl_poly_free(&p);
    return rc;
}

/* Bodies of a fixed group without a name in zones.group stay rigid: nothing deforms a bed that does not
 * move. */
static int wants_zones(const fl_world *w, const fl_ice_field *field, int32_t k)
{
    const char *group = field->group[k] < 0 ? "" : field->groups.name[field->group[k]];
    if (w->scene->zones.group[0]) return strcmp(group, w->scene->zones.group) == 0;
    return w->b.fixed_dof[k] == 0;
}

/* --- sides -------------------------------------------------------------------------------------- */

static double place_along(fl_vec3 x, int axis) { return v3_at(x, axis); }

/* Holds the nodes of the triangles in a plane, or marks the triangles. */
static int set_side(fl_zone_set *s, int axis, double at, double sign, int kind, double near, fl_err *err)
{
    uint8_t *in = fl_alloc(s->triangles, 1, err);
    if (!in) return -1;
    for (int32_t k = 0; k < s->triangles; k++) {
        int all = 1;
        for (int e = 0; e < 3; e++) all &= fabs(place_along(s->x[s->triangle[k][e]], axis) - at) < near;
        in[k] = (uint8_t)all;
        for (int e = 0; e < 3 && all; e++) {
            uint8_t *fixed = &s->fixed[s->triangle[k][e]];
            if (kind == FL_ZONE_SIDE_ROLLER) *fixed |= (uint8_t)(FL_DOF_X << axis);
            if (kind == FL_ZONE_SIDE_FIXED) *fixed = FL_DOF_X | FL_DOF_Y | FL_DOF_Z;
        }
    }
    int rc = 0;
    if (kind == FL_ZONE_SIDE_QUIET)
        rc = fl_zone_set_add_quiet(
            s, in, v3(axis == 0 ? sign : 0.0, axis == 1 ? sign : 0.0, axis == 2 ? sign : 0.0), err);
    free(in);
    return rc;
}

static int set_sides(fl_world *w, fl_err *err)
{
    fl_zone_set *s = &w->zones.set;
    const fl_scene_zones *z = &w->scene->zones;
    double size = 0.0, lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        lo[a] = INFINITY, hi[a] = -INFINITY;
        for (int32_t n = 0; n < s->nodes; n++) {
            const double x = place_along(s->x[n], a);
            lo[a] = fmin(lo[a], x), hi[a] = fmax(hi[a], x);
        }
        size = fmax(size, hi[a] - lo[a]);
    }
    for (int a = 0; a < 3; a++)
        if (set_side(s, a, lo[a], -1.0, z->min_side[a], IN_PLANE * size, err) ||
            set_side(s, a, hi[a], 1.0, z->max_side[a], IN_PLANE * size, err))
            return -1;
    return 0;
}

/* Nodes of a body with fixed directions have them fixed, at its velocity; the body follows its nodes. */
static void take_over(fl_world *w, int32_t k)
{
    fl_zone_set *s = &w->zones.set;
    fl_bodies *b = &w->b;
    const fl_zone_block *q = &s->block[k];
    const int32_t i = q->body;
    const unsigned fixed = b->fixed_dof[i] & (FL_DOF_X | FL_DOF_Y | FL_DOF_Z);
    const fl_mat3 R = fl_body_axes(b, i);
    for (int32_t n = q->node; n < q->node_end; n++) {
        const fl_vec3 r = v3_sub(s->x[n], b->x[i]);
        s->rest[n] = m3_tmul(R, r);
        s->v[n] = v3_add(b->v[i], v3_cross(b->w[i], r));
        s->fixed[n] |= (uint8_t)fixed;
    }
    b->fixed_dof[i] = FL_DOF_X | FL_DOF_Y | FL_DOF_Z | FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
    b->is_isotropic[i] = 0;
}

int fl_zones_make(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    fl_zone_state *z = &w->zones;
    const fl_scene_zones *scene = &w->scene->zones;
    if (!scene->head.present) return 0;
    if (!(z->block_of = fl_alloc(w->n, sizeof *z->block_of, err)) || add_materials(w, err)) return -1;
    for (int32_t k = 0; k < w->n; k++) {
        z->block_of[k] = -1;
        if (k < field->n && wants_zones(w, field, k) && add_block(w, field, k, err)) return -1;
    }
    if (z->set.blocks == 0)
        return fl_fail(err, FL_INPUT,
                       scene->group[0] ? "%s: no body is of the group %s, which zones.group names"
                                       : "%s: no body is free to deform%s",
                       w->scene->ice.file, scene->group);
    if (fl_zone_set_finish(&z->set, 1.0 - scene->averaging, err) || set_sides(w, err)) return -1;
    for (int32_t k = 0; k < z->set.blocks; k++) take_over(w, k);
    if ((z->set.dashpots || w->scene->run.relax) && !(z->drag = fl_alloc(z->set.nodes, sizeof *z->drag, err)))
        return -1;
    if (v3_nonzero(scene->wave_stress) && !(z->push = fl_alloc(z->set.nodes, sizeof *z->push, err)))
        return -1;
    return 0;
}

/* --- joints ------------------------------------------------------------------------------------- */

/* Law of the faces that are glued. */
static fl_joint_material glue_of(const fl_zone_set *s, double size)
{
    double most = 0.0;
    for (int32_t k = 0; k < s->blocks; k++) {
        const fl_zone_material *m = &s->material[s->block[k].material];
        most = fmax(most, m->lambda + 2.0 * m->mu);
    }
    const double k = GLUE * most / size;
    return (fl_joint_material){
        .law = FL_JOINT_COULOMB, .kn = k, .ks = k, .cohesion = INFINITY, .tension = INFINITY};
}

static double face_area(const fl_vec3 *v, int32_t n)
{
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = 1; k + 1 < n; k++)
        sum = v3_add(sum, v3_cross(v3_sub(v[k], v[0]), v3_sub(v[k + 1], v[0])));
    return 0.5 * v3_norm(sum);
}

static int join_blocks(fl_world *w, int32_t k, const fl_ice_field_joint *d, fl_err *err)
{
    fl_bond_list *s = &w->bonds;
    fl_bond *c = &s->bond[k];
    fl_joint *q = &s->joint[k - s->faces];
    const int32_t *block = w->zones.block_of;
    const fl_zone_side side[2] = {
        {block[c->i], c->i, d->fi, q->first, q->ni, face_area(s->corner + q->first, q->ni)},
        {block[c->j], c->j, d->fj, q->first + q->ni, q->nj, face_area(s->corner + q->first + q->ni, q->nj)}};
    const fl_scene_joint *scene = q->material >= 0 ? &w->scene->joint[q->material] : NULL;
    static const fl_vec3 NONE = {0, 0, 0};
    const fl_vec3 a = scene ? scene->initial_stress : NONE, b = scene ? scene->initial_shear : NONE;
    if (c->state == FL_BOND_ENDED || (side[0].block < 0 && side[1].block < 0)) return 0;
    if (w->cell.periodic && (s->image[3 * k] || s->image[3 * k + 1] || s->image[3 * k + 2]))
        return fl_fail(err, FL_INPUT, "%s: a deformable block has a joint across a periodic boundary",
                       w->scene->ice.file);
    if (!scene) {
        q->material = w->scene->n_joint;
        c->kn = c->ks = s->joint_material[q->material].kn;
        c->mixed_mode_exponent = 1, c->h0 = c->area;
    }
    w->zones.joint_of[k - s->faces] = w->zones.joints.n;
    const fl_joint_pool pool = {s->corner, s->joint_material};
    return fl_zone_joint_make(&w->zones.joints, &w->zones.set, c, q, pool, &w->b, k, side,
                              (double[6]){a.x, a.y, a.z, b.x, b.y, b.z}, scene ? scene->damping : 0.0, err);
}

int fl_zones_join(fl_world *w, const fl_ice_field *field, fl_err *err)
{
    fl_zone_state *z = &w->zones;
    const int32_t n = fl_world_joints(w);
    if (!z->set.blocks) return 0;
    if (n && !(z->joint_of = fl_alloc(n, sizeof *z->joint_of, err))) return -1;
    for (int32_t k = 0; k < n; k++) z->joint_of[k] = -1;
    if (n) w->bonds.joint_material[w->scene->n_joint] = glue_of(&z->set, w->scene->zones.size);
    for (int32_t k = 0; k < n; k++)
        if (join_blocks(w, w->bonds.faces + k, &field->joint[k], err)) return -1;
    if (fl_zone_joint_list_finish(&z->joints, &z->set, err)) return -1;
    if (w->scene->run.relax && fl_zone_set_scale_inertia(&z->set, err)) return -1;
    z->dt_critical = 2.0 / sqrt(fl_zone_omega2(&z->set, &z->stiffest));
    return 0;
}

void fl_zones_free(fl_zone_state *z)
{
    fl_zone_set_free(&z->set);
    fl_zone_joint_list_free(&z->joints);
    free(z->block_of), free(z->joint_of), free(z->drag), free(z->push);
    *z = (fl_zone_state){0};
}
