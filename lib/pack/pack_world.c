/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/pack_world.h"
#include <math.h>
#include <omp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "geom/facet.h"
#include "scene/scene_check.h"
#include "scene/scene_read.h"
#include "sim/critical_step.h"
#include "sim/setup.h"
#include "sim/step.h"
#include "world/access.h"

enum { FACETS = 180, CHECK = 100, QUIET = 10, STAGE_STEPS = 25 };

/* See pack_world.h. */
static const double RATE = 2e-4, STAGE = 5e-3, DAMPING = 0.02, JAM = 1e-3;

typedef struct {
    fl_packing *p;
    const fl_pack_region *region;
    const fl_pack_motion *m;
    fl_scene scene;
    fl_ice_field field;
    fl_surface surface;
    fl_world w;
    int made;
    fl_quat *q0; /* [n] attitude in the world at the start */
} motion;

/* --- the region as a surface -------------------------------------------------------------------- */

/* An upright prism over a polygon; inward: its normals point inside, with the corners counter-clockwise. */
static int add_prism(fl_surface *s, int32_t n, const fl_vec2 *v, double z0, double z1, int inward,
                     fl_err *err)
{
    const int32_t k = fl_surface_add(s, "region", 6, err);
    int32_t *low = fl_alloc(n, sizeof *low, err), *high = fl_alloc(n, sizeof *high, err);
    int rc = k < 0 || !low || !high ? -1 : 0;
    fl_part *p = rc ? NULL : &s->part[k];
    for (int32_t a = 0; rc == 0 && a < 2 * n; a++)
        rc = fl_surface_vertex(p, v3(v[a % n].x, v[a % n].y, a < n ? z0 : z1), err);
    for (int32_t a = 0; rc == 0 && a < n; a++) {
        const int32_t b = (a + 1) % n, out[4] = {a, b, n + b, n + a}, in[4] = {a, n + a, n + b, b};
        low[a] = inward ? a : n - 1 - a;
        high[a] = n + (inward ? n - 1 - a : a);
        rc = fl_facet_polygon(p, 4, inward ? in : out, err);
    }
    if (rc == 0) rc = fl_facet_polygon(p, n, low, err) || fl_facet_polygon(p, n, high, err) ? -1 : 0;
    free(low), free(high);
    return rc;
}

static int add_outline(const fl_pack_region *r, double thickness, fl_surface *out, fl_err *err)
{
    const fl_domain *d = &r->domain;
    for (int32_t k = 0; k < d->rings; k++) {
        const int32_t first = d->first[k], n = d->first[k + 1] - first;
        if (k == 0) {
            if (add_prism(out, n, d->v + first, -thickness, thickness, 1, err)) return -1;
            continue;
        }
        fl_vec2 *turned = fl_alloc(n, sizeof *turned, err); /* holes are clockwise */
        if (!turned) return -1;
        for (int32_t c = 0; c < n; c++) turned[c] = d->v[first + n - 1 - c];
        const int rc = add_prism(out, n, turned, -thickness, thickness, 0, err);
        free(turned);
        if (rc) return -1;
    }
    return 0;
}

static int add_cylinder(const fl_pack_region *r, double thickness, fl_surface *out, fl_err *err)
{
    fl_vec2 v[FACETS];
    for (int k = 0; k < FACETS; k++) {
        const double a = 2.0 * PI * k / FACETS;
        v[k] = (fl_vec2){r->centre.x + r->radius * cos(a), r->centre.y + r->radius * sin(a)};
    }
    const int flat = r->dim == 2;
    return add_prism(out, FACETS, v, flat ? -thickness : r->lo.z, flat ? thickness : r->hi.z, 1, err);
}

/* Faces of the region as one part. */
static int add_faces(const fl_pack_region *r, fl_surface *out, fl_err *err)
{
    const int32_t k = fl_surface_add(out, "region", 6, err);
    if (k < 0) return -1;
    fl_part *p = &out->part[k];
    for (int32_t f = 0; f < r->features; f++) {
        const fl_region_feature *e = &r->feature[f];
        if (e->corners < 3) continue;
        const fl_vec3 n = v3_cross(v3_sub(e->p[1], e->p[0]), v3_sub(e->p[2], e->p[0]));
        const int turn = v3_dot(n, e->n) < 0.0;
        for (int c = 0; c < 3; c++)
            if (fl_surface_vertex(p, e->p[turn ? 2 - c : c], err)) return -1;
        if (fl_surface_triangle(p, p->nv - 3, p->nv - 2, p->nv - 1, err)) return -1;
    }
    return 0;
}

int fl_pack_region_surface(const fl_pack_region *r, double thickness, fl_surface *out, fl_err *err)
{
    if (r->kind == FL_REGION_CYLINDER) return add_cylinder(r, thickness, out, err);
    if (r->kind == FL_REGION_FEATURES)
        return r->dim == 2 ? add_outline(r, thickness, out, err) : add_faces(r, out, err);
    return fl_fail(err, FL_INPUT, "a box or a sphere has no surface of triangles");
}

/* --- the world ---------------------------------------------------------------------------------- */

static int set_key(fl_scene *s, fl_err *err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));
static int set_key(fl_scene *s, fl_err *err, const char *fmt, ...)
{
    char line[300];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(line, sizeof line, fmt, ap);
    va_end(ap);
    return fl_scene_set(s, line, err);
}

static const char *wall_kind(const fl_pack_region *r, int axis)
{
    return axis >= r->dim ? "free" : r->periodic[axis] ? "periodic" : "rigid";
}

static int set_box(motion *q, fl_err *err)
{
    const fl_pack_region *r = q->region;
    const double far = 1e6 * v3_norm(v3_sub(r->hi, r->lo));
    const double lo = r->dim == 2 ? -far : r->lo.z, hi = r->dim == 2 ? far : r->hi.z;
    fl_scene *s = &q->scene;
    return set_key(s, err, "boundary.type=%s %s %s", wall_kind(r, 0), wall_kind(r, 1), wall_kind(r, 2)) ||
           set_key(s, err, "boundary.min=%.17g %.17g %.17g", r->lo.x, r->lo.y, lo) ||
           set_key(s, err, "boundary.max=%.17g %.17g %.17g", r->hi.x, r->hi.y, hi);
}

static int make_scene(motion *q, fl_err *err)
{
    const fl_pack_motion *m = q->m;
    fl_scene *s = &q->scene;
    const int flat = q->p->dim == 2;
    fl_scene_init(s);
    if (set_key(s, err, "%s", "ice.file=-") || set_key(s, err, "%s", "run.duration=1") ||
        set_key(s, err, "run.threads=%d", omp_get_max_threads()) ||
        set_key(s, err, "run.gravity=0 %.17g %.17g", flat ? -m->gravity : 0.0, flat ? 0.0 : -m->gravity) ||
        set_key(s, err, "material.ice.young=%.17g", m->young) ||
        set_key(s, err, "material.ice.density=%.17g", m->density) ||
        set_key(s, err, "contact.friction=%.17g", m->friction) ||
        set_key(s, err, "contact.restitution=%.17g", m->restitution))
        return -1;
    if (flat && set_key(s, err, "group.plane.fixed=z rx ry")) return -1;
    if (q->region->kind == FL_REGION_BOX) return set_box(q, err);
    return fl_pack_region_surface(q->region, 4.0 * fl_packing_most(q->p), &q->surface, err) ||
           set_key(s, err, "structure.file=region");
}

static void free_motion(motion *q)
{
    if (q->made) fl_world_free(&q->w);
    fl_ice_field_free(&q->field);
    fl_surface_free(&q->surface);
    fl_scene_free(&q->scene);
    free(q->q0);
    q->made = 0;
    q->q0 = NULL;
}

static int make_motion(motion *q, fl_packing *p, const fl_pack_region *r, const fl_pack_motion *m,
                       fl_err *err)
{
    int32_t body;
    *q = (motion){.p = p, .region = r, .m = m};
    if (make_scene(q, err) || fl_packing_field(p, NULL, p->dim == 2 ? "plane" : NULL, &q->field, err) ||
        fl_scene_check(&q->scene, err))
        goto bad;
    if (fl_world_make(&q->w, &q->scene, &q->field, q->surface.n ? &q->surface : NULL, err)) goto bad;
    q->made = 1;
    if (!(q->q0 = fl_alloc(p->n, sizeof *q->q0, err))) goto bad;
    for (int32_t i = 0; i < p->n; i++) q->q0[i] = q->w.b.q[i];
    q->w.dt = fl_automatic_step(&q->w, &body);
    q->w.automatic_dt = 1;
    if (fl_step_start(&q->w, err) == 0) return 0;
bad:
    free_motion(q);
    return -1;
}

/* Poses of the world into the packing. */
static void read_poses(motion *q)
{
    fl_packing *p = q->p;
    for (int32_t i = 0; i < p->n; i++) {
        p->x[i] = fl_region_into_cell(q->region, q->w.b.x[i]);
        if (p->dim == 2) p->x[i].z = 0.0;
        if (!p->q) continue;
        const fl_quat turn = q_mul(q->w.b.q[i], q_conj(q->q0[i]));
        p->q[i] = q_unit(q_mul(turn, p->q[i]));
        q->q0[i] = q->w.b.q[i];
    }
}

static double mean_size(const fl_packing *p)
{
    double sum = 0.0;
    for (int32_t i = 0; i < p->n; i++) sum += 2.0 * p->bound[i];
    return sum / p->n;
}

static double mean_speed(const motion *q)
{
    double sum = 0.0;
    for (int32_t i = 0; i < q->w.n; i++) sum += v3_norm2(q->w.b.v[i]);
    return sqrt(sum / q->w.n);
}

static void damp_velocities(motion *q)
{
    const fl_relaxation viscous = fl_relaxation_start(FL_RELAXATION_VISCOUS, DAMPING);
    const double keep = fl_relaxation_c1(&viscous);
    for (int32_t i = 0; i < q->w.n; i++) {
        q->w.b.v[i] = v3_scale(keep, q->w.b.v[i]);
        fl_body_set_spin(&q->w.b, i, v3_scale(keep, q->w.b.w[i]));
    }
}

/* --- growth ------------------------------------------------------------------------------------- */

/* Spheres at scale s; the way of their surface counts for the neighbour list. */
static void set_scale(motion *q, double s)
{
    for (int32_t i = 0; i < q->w.n; i++) {
        const double r = s * q->p->radius[i];
        q->w.b.odometer[i] += r - q->w.b.radius[i];
        q->w.b.radius[i] = r;
    }
    q->p->s = s;
}

static double strain_of(const fl_overlaps *o)
{
    const fl_overlap_totals *t = &o->now;
    return t->contacts && t->pressure > 0.0
               ? t->overlap_sum * t->overlap_sum / ((double)t->contacts * t->pressure)
               : 0.0;
}

/* True where the bodies press against each other everywhere. */
static int is_jammed(motion *q, fl_overlaps *o, double *strain, fl_err *err)
{
    read_poses(q);
    o->stale = 1;
    if (fl_overlaps_evaluate(o, err)) return -1;
    *strain = strain_of(o);
    return *strain > JAM && o->now.contacts > q->p->n;
}

/* Steps of one stage: of spheres, growing; of others, at one scale. */
static int run_stage(motion *q, int64_t steps, fl_pack_moved *out, fl_err *err)
{
    for (int64_t k = 0; k < steps; k++) {
        if (!q->p->q && q->p->s < 1.0) set_scale(q, fmin(1.0, q->p->s * (1.0 + RATE)));
        if (fl_step(&q->w, err)) return -1;
        damp_velocities(q);
        out->steps++;
        out->time += q->w.dt;
    }
    return 0;
}

int fl_pack_grow_moving(fl_packing *p, const fl_pack_region *r, const fl_pack_motion *m, fl_overlaps *o,
                        fl_pack_motion_call *call, void *with, fl_pack_moved *out, fl_err *err)
{
    fl_pack_motion still = *m;
    motion q = {0};
    double strain = 0.0;
    int jammed = 0, rc = 0;
    still.gravity = 0.0;
    *out = (fl_pack_moved){0};
    if (!p->q && make_motion(&q, p, r, &still, err)) return -1;
    while (rc == 0 && !jammed && p->s < 1.0) {
        if (p->q) {
            p->s = fmin(1.0, p->s * (1.0 + STAGE));
            if (make_motion(&q, p, r, &still, err)) return -1;
        }
        rc = run_stage(&q, p->q ? STAGE_STEPS : CHECK, out, err);
        if (rc == 0) jammed = is_jammed(&q, o, &strain, err);
        if (jammed < 0) rc = -1;
        if (p->q) free_motion(&q);
        if (rc == 0 && call && call(with, p, out)) break;
    }
    if (rc == 0 && jammed) {
        out->jammed = 1;
        p->s *= 1.0 - strain;
        out->jam_scale = p->s;
        o->stale = 1;
        rc = fl_overlaps_evaluate(o, err);
    }
    free_motion(&q);
    return rc;
}

/* --- rest --------------------------------------------------------------------------------------- */

int fl_pack_settle(fl_packing *p, const fl_pack_region *r, const fl_pack_motion *m, fl_pack_motion_call *call,
                   void *with, fl_pack_moved *out, fl_err *err)
{
    motion q;
    const double d = mean_size(p), unit = sqrt(m->gravity * d),
                 longest = m->longest > 0.0 ? m->longest : 1000.0 * sqrt(d / m->gravity);
    int quiet = 0, rc = 0;
    *out = (fl_pack_moved){0};
    if (make_motion(&q, p, r, m, err)) return -1;
    while (rc == 0 && quiet < QUIET && out->time < longest) {
        for (int k = 0; rc == 0 && k < CHECK; k++) {
            rc = fl_step(&q.w, err);
            out->steps++;
            out->time += q.w.dt;
        }
        out->speed = mean_speed(&q) / unit;
        quiet = out->speed < m->rest ? quiet + 1 : 0;
        if (rc == 0 && call && call(with, p, out)) break;
    }
    out->settled = quiet == QUIET;
    if (rc == 0) read_poses(&q);
    free_motion(&q);
    return rc;
}
