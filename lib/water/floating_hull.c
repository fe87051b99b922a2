/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/floating_hull.h"
#include "base/array.h"
#include "base/pi.h"

/* Most cells of the field around one body. */
#define MAX_CELLS 1000000

int fl_floating_hulls_alloc(fl_floating_hulls *s, int32_t n, fl_environment *sea, fl_err *err)
{
    s->hull = fl_alloc(n, sizeof *s->hull, err);
    s->guest = fl_alloc(n, sizeof *s->guest, err);
    if (!s->hull || !s->guest) return -1;
    s->n = n;
    s->sea = sea;
    return 0;
}

void fl_floating_hulls_free(fl_floating_hulls *s)
{
    for (int32_t k = 0; k < s->n; k++) {
        fl_floating_hull *h = &s->hull[k];
        fl_wet_mesh_free(&h->mesh);
        fl_hull_panels_free(&h->panels);
        fl_wave_nodes_free(&h->nodes);
        free(h->shape.n), free(h->shape.first), free(h->shape.loop);
    }
    free(s->hull), free(s->guest), free(s->cells), free(s->scratch);
    *s = (fl_floating_hulls){0};
}

/* The triangles as faces, and panels of them. */
static int make_panels(fl_floating_hulls *s, fl_floating_hull *h, fl_err *err)
{
    const fl_waves *w = &s->sea->wave;
    const int32_t n = h->mesh.n, cells = fl_wave_field_cells(w, h->mesh.reach + w->four_sigma);
    fl_poly *p = &h->shape;
    if (cells > MAX_CELLS)
        return fl_fail(err, FL_INPUT,
                       "water.height, water.period: waves down to %.3g m long that rise by up to %.3g m "
                       "would need, for a structure of radius %.3g m, more than %d cells",
                       2.0 * PI / w->max_k, w->four_sigma, h->mesh.reach, MAX_CELLS);
    *p = (fl_poly){.nv = 3 * n, .nf = n, .v = h->mesh.v, .size = h->size};
    p->n = fl_alloc(n, sizeof *p->n, err);
    p->first = fl_alloc((int64_t)n + 1, sizeof *p->first, err);
    p->loop = fl_alloc(3 * (int64_t)n, sizeof *p->loop, err);
    if (!p->n || !p->first || !p->loop) return -1;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 *x = p->v + 3 * (int64_t)k;
        const fl_vec3 A = v3_cross(v3_sub(x[1], x[0]), v3_sub(x[2], x[0]));
        p->n[k] = v3_scale(1.0 / v3_norm(A), A);
        p->first[k + 1] = 3 * (k + 1);
    }
    for (int32_t k = 0; k < 3 * n; k++) p->loop[k] = k;
    h->hull = (fl_hull){.shape = p};
    if (cells > s->cell_count) {
        free(s->cells);
        s->cell_count = 0;
        s->cells = fl_alloc(cells, sizeof *s->cells, err);
        if (!s->cells) return -1;
        s->cell_count = cells;
    }
    return fl_hull_panels_make(&h->panels, &h->hull, w, err);
}

static int make_nodes(fl_floating_hulls *s, fl_floating_hull *h, fl_err *err)
{
    const fl_environment *sea = s->sea;
    h->block.level = FL_WAVE_NO_BLOCK;
    if (fl_wave_nodes_make_mesh(&h->nodes, h->mesh.v, h->mesh.n, h->size, &sea->wave, sea->grid.error, err))
        return -1;
    if (h->nodes.n <= s->scratch_count) return 0;
    free(s->scratch);
    s->scratch_count = 0;
    s->scratch = fl_alloc(h->nodes.n, sizeof *s->scratch, err);
    if (!s->scratch) return -1;
    s->scratch_count = h->nodes.n;
    return 0;
}

int fl_floating_hulls_set(fl_floating_hulls *s, int32_t k, fl_vec3 *v, int32_t n, double volume,
                          fl_vec3 centre, fl_err *err)
{
    fl_floating_hull *h = &s->hull[k];
    if (fl_wet_mesh_make(&h->mesh, v, n, err)) return -1;
    const fl_vec3 half = h->mesh.box[0].half;
    h->size = 2.0 * fmax(half.x, fmax(half.y, half.z));
    h->centre = centre;
    h->rest_force = v3(0, 0, s->sea->specific_weight * volume);
    h->rest_moment = v3_cross(centre, h->rest_force);
    return s->sea->by_blocks ? make_nodes(s, h, err) : make_panels(s, h, err);
}

void fl_floating_hulls_attach(fl_floating_hulls *s, const fl_bodies *b)
{
    int32_t n = 0;
    for (int32_t k = 0; k < s->n; k++)
        if (s->hull[k].mesh.n)
            s->guest[n++] = (fl_wave_guest){&b->x[k], s->hull[k].mesh.reach, &s->hull[k].block};
    s->sea->guest = s->guest;
    s->sea->guests = n;
}

/* Extent of the mesh along d, axes of the body. */
static void extent_along(const fl_wet_mesh *m, fl_vec3 d, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (int64_t k = 0; k < 3 * (int64_t)m->n; k++) {
        const double x = v3_dot(d, m->v[k]);
        *lo = x < *lo ? x : *lo;
        *hi = x > *hi ? x : *hi;
    }
}

/* Force and moment of the water, without F_0 and T_0, and its acceleration. */
static void evaluate_each(fl_floating_hulls *s, const fl_bodies *b, int32_t k, fl_vec3 *f, fl_vec3 *t,
                          fl_vec3 *a)
{
    const fl_environment *sea = s->sea;
    const fl_waves *w = &sea->wave;
    fl_floating_hull *h = &s->hull[k];
    const fl_mat3 R = fl_body_axes(b, k);
    const fl_hull_pose at = {.up = v3(R.m[2][0], R.m[2][1], R.m[2][2]),
                             .along = m3_tmul(R, w->direction),
                             .s = v3_dot(w->direction, b->x[k]),
                             .z = b->x[k].z - sea->level};
    double s_lo, s_hi, z_lo, z_hi, u[2], acceleration[2];
    fl_wave_field around;
    fl_water_load p;
    extent_along(&h->mesh, at.along, &s_lo, &s_hi);
    extent_along(&h->mesh, at.up, &z_lo, &z_hi);
    fl_wave_field_fill(w, at.s + s_lo, at.s + s_hi, at.z + z_lo - w->four_sigma, at.z + z_hi + w->four_sigma,
                       sea->time, s->cells, &around);
    fl_froude_krylov_solid(&h->panels, &h->hull, w, &around, &at, sea->specific_weight, &p);
    *f = m3_mul(R, p.force), *t = m3_mul(R, p.moment);
    const double x = at.s + v3_dot(at.along, h->centre), z = at.z + v3_dot(at.up, h->centre),
                 zeta = fl_wave_stretch(w, z, fl_wave_field_elevation(&around, x, NULL));
    fl_wave_kinematics(w, fl_wave_field_cell(&around, x, zeta), x, zeta, u, acceleration);
    h->wetted = p.wetted;
    h->flow = v3_add(v3_madd(v3(0, 0, u[1]), u[0], w->direction), fl_current_at(&sea->current, z));
    *a = v3_madd(v3(0, 0, acceleration[1]), acceleration[0], w->direction);
}

static fl_wave_body wave_body(const fl_floating_hulls *s, const fl_bodies *b, int32_t k)
{
    const fl_floating_hull *h = &s->hull[k];
    return (fl_wave_body){.nodes = &h->nodes,
                          .reach = h->mesh.reach,
                          .scratch = s->scratch,
                          .mesh = &h->mesh,
                          .wet_centre = h->centre,
                          .other = v3_sub(b->f[k], h->rest_force),
                          .other_moment = v3_sub(b->t[k], h->rest_moment)};
}

static void evaluate_block(fl_floating_hulls *s, const fl_bodies *b, int32_t k, fl_vec3 *f, fl_vec3 *t,
                           fl_vec3 *a)
{
    const fl_environment *sea = s->sea;
    fl_floating_hull *h = &s->hull[k];
    const fl_wave_body body = wave_body(s, b, k);
    const fl_quat q = *fl_body_attitude(b, k);
    fl_wave_values v;
    fl_submerged wet;
    if (fl_wave_block_due(&h->block, &sea->sea, body.reach, sea->time, b->x[k], q))
        fl_wave_block_begin(&h->block, &sea->sea, &body, b, k, sea->time);
    fl_wave_block_load(&h->block, &sea->sea, &body, sea->time, b->x[k], q, &v, &wet, f, t);
    h->wetted = v.wetted;
    h->flow = v.flow;
    *a = v.acceleration;
}

static void evaluate(fl_floating_hulls *s, fl_bodies *b, int32_t k)
{
    fl_floating_hull *h = &s->hull[k];
    fl_vec3 f, t, a;
    if (s->sea->by_blocks) evaluate_block(s, b, k, &f, &t, &a);
    else evaluate_each(s, b, k, &f, &t, &a);
    if (b->added_mass) {
        const fl_mat3 R = fl_body_axes(b, k);
        if (h->wetted > 0.0) f = v3_add(f, m3_mul(R, v3_mul(b->added_mass[k], m3_tmul(R, a))));
        b->flow_velocity[k] = h->flow;
    }
    h->force = v3_sub(f, h->rest_force);
    h->moment = v3_sub(t, h->rest_moment);
}

void fl_floating_hull_force(fl_floating_hulls *s, fl_bodies *b, int32_t k)
{
    evaluate(s, b, k);
    b->f[k] = v3_add(b->f[k], s->hull[k].force);
    b->t[k] = v3_add(b->t[k], s->hull[k].moment);
}

void fl_floating_hull_refresh(fl_floating_hulls *s, fl_bodies *b, int32_t k)
{
    fl_floating_hull *h = &s->hull[k];
    if (s->sea->by_blocks && h->block.level != FL_WAVE_NO_BLOCK) {
        const fl_wave_body body = wave_body(s, b, k);
        fl_wave_block_fill(&h->block, &s->sea->sea, &body);
    }
    evaluate(s, b, k);
}

void fl_floating_hull_add_work(fl_floating_hulls *s, const fl_bodies *b, int32_t k, double h, fl_vec3 v0,
                               fl_vec3 w0)
{
    fl_floating_hull *o = &s->hull[k];
    o->work += 0.5 * h * (v3_dot(o->force, v3_add(v0, b->v[k])) + v3_dot(o->moment, v3_add(w0, b->w[k])));
}

void fl_floating_hull_drag(fl_floating_hulls *s, fl_bodies *b, int32_t k, double h)
{
    const fl_environment *sea = s->sea;
    fl_floating_hull *o = &s->hull[k];
    if (!(o->wetted > 0.0) || sea->water_drag_law != FL_DRAG_MANUAL) return;
    o->drag_loss -= fl_environment_decay_velocity(b, k, &sea->seawater, o->wetted, o->mesh.reach, o->flow, h);
}
