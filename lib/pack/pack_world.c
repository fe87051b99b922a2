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

enum { FACETS = 180, CHECK = 100, QUIET = 10, STAGE_STEPS = 25, PAUSE = 1000 };

/* See pack_world.h. */
static const double RATE = 1e-4, STAGE = 5e-3, DAMPING = 0.01, JAM = 5e-3, HELD = 0.5, PLATE = 0.2,
                    DRAG = 5.0;

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

/* A plate behind the face v[n] of the boundary, whose unit normal into the region is `inward`: a prism of the
 * given thickness.  Corners counter-clockwise or clockwise. */
static int add_plate(fl_surface *s, int32_t n, const fl_vec3 *v, fl_vec3 inward, double thickness,
                     fl_err *err)
{
    enum { CORNERS = 4 };
    const int32_t k = fl_surface_add(s, "wall", 4, err);
    int32_t front[CORNERS], back[CORNERS];
    if (k < 0) return -1;
    fl_part *p = &s->part[k];
    const fl_vec3 normal = v3_cross(v3_sub(v[1], v[0]), v3_sub(v[2], v[0]));
    const int turned = v3_dot(normal, inward) < 0.0;
    for (int32_t a = 0; a < 2 * n; a++) {
        const fl_vec3 at = v[turned ? n - 1 - a % n : a % n];
        if (fl_surface_vertex(p, a < n ? at : v3_madd(at, -thickness, inward), err)) return -1;
    }
    for (int32_t a = 0; a < n; a++) {
        const int32_t b = (a + 1) % n, side[4] = {a, n + a, n + b, b};
        front[a] = a;
        back[a] = 2 * n - 1 - a;
        if (fl_facet_polygon(p, 4, side, err)) return -1;
    }
    return fl_facet_polygon(p, n, front, err) || fl_facet_polygon(p, n, back, err) ? -1 : 0;
}

/* An upright plate on the side from a to b. */
static int add_upright(fl_surface *s, fl_vec3 a, fl_vec3 b, fl_vec3 inward, double z0, double z1,
                       double thickness, fl_err *err)
{
    const fl_vec3 v[4] = {v3(a.x, a.y, z0), v3(b.x, b.y, z0), v3(b.x, b.y, z1), v3(a.x, a.y, z1)};
    return add_plate(s, 4, v, inward, thickness, err);
}

static int add_cylinder(const fl_pack_region *r, double height, double thickness, fl_surface *out,
                        fl_err *err)
{
    const double z0 = r->dim == 2 ? -height : r->lo.z, z1 = r->dim == 2 ? height : r->hi.z;
    for (int k = 0; k < FACETS; k++) {
        const double a = 2.0 * PI * k / FACETS, b = 2.0 * PI * (k + 1) / FACETS, c = 0.5 * (a + b);
        const fl_vec3 p = v3_madd(r->centre, r->radius, v3(cos(a), sin(a), 0)),
                      q = v3_madd(r->centre, r->radius, v3(cos(b), sin(b), 0));
        if (add_upright(out, p, q, v3(-cos(c), -sin(c), 0), z0, z1, thickness, err)) return -1;
    }
    return 0;
}

int fl_pack_region_surface(const fl_pack_region *r, double height, double thickness, fl_surface *out,
                           fl_err *err)
{
    if (r->kind == FL_REGION_CYLINDER) return add_cylinder(r, height, thickness, out, err);
    if (r->kind != FL_REGION_FEATURES)
        return fl_fail(err, FL_INPUT, "a box or a sphere has no surface of triangles");
    for (int32_t k = 0; k < r->features; k++) {
        const fl_region_feature *f = &r->feature[k];
        if (f->corners != r->dim) continue;
        if (r->dim == 2 ? add_upright(out, f->p[0], f->p[1], f->n, -height, height, thickness, err)
                        : add_plate(out, 3, f->p, f->n, thickness, err))
            return -1;
    }
    return 0;
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

static int make_scene(motion *q, int grows, fl_err *err)
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
    if (grows && set_key(s, err, "contact.round_law=linear")) return -1;
    if (flat && set_key(s, err, "group.plane.fixed=z rx ry")) return -1;
    if (q->region->kind == FL_REGION_BOX) return set_box(q, err);
    if (q->region->kind == FL_REGION_CYLINDER && !flat &&
        (set_key(s, err, "boundary.type=free free rigid") ||
         set_key(s, err, "boundary.min=none none %.17g", q->region->lo.z) ||
         set_key(s, err, "boundary.max=none none %.17g", q->region->hi.z)))
        return -1;
    return fl_pack_region_surface(q->region, 4.0 * fl_packing_most(q->p), PLATE * fl_packing_least(q->p),
                                  &q->surface, err) ||
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

/* Step of growth, where nothing but growth moves the bodies: SAFETY of 2/omega of the smallest body between
 * NEIGHBOURS others, linear contacts of the stiffness pi E r/2. */
static double growth_step(const motion *q)
{
    const double SAFETY = 0.2, NEIGHBOURS = 12.0;
    double dt = INFINITY;
    for (int32_t i = 0; i < q->p->n; i++) {
        const double stiffness = 0.5 * PI * q->m->young * q->p->bound[i];
        dt = fmin(dt, SAFETY * 2.0 / sqrt(NEIGHBOURS * stiffness * q->w.b.invm[i]));
    }
    return dt;
}

/* Spheres at scale s; the way of their surface counts for the neighbour list. */
static void set_scale(motion *q, double s)
{
    for (int32_t i = 0; i < q->w.n; i++) {
        const double r = s * q->p->radius[i];
        q->w.b.odometer[i] += fabs(r - q->w.b.radius[i]);
        q->w.b.radius[i] = r;
    }
    q->p->s = s;
}

/* grows: radii are those of p->s, masses those of the final size. */
static int make_motion(motion *q, fl_packing *p, const fl_pack_region *r, const fl_pack_motion *m, int grows,
                       fl_err *err)
{
    const double s = p->s;
    int32_t body;
    *q = (motion){.p = p, .region = r, .m = m};
    if (grows && !p->q) p->s = 1.0;
    if (make_scene(q, grows, err) ||
        fl_packing_field(p, NULL, p->dim == 2 ? "plane" : NULL, &q->field, err) ||
        fl_scene_check(&q->scene, err))
        goto bad;
    if (fl_world_make(&q->w, &q->scene, &q->field, q->surface.n ? &q->surface : NULL, err)) goto bad;
    q->made = 1;
    if (!(q->q0 = fl_alloc(p->n, sizeof *q->q0, err))) goto bad;
    for (int32_t i = 0; i < p->n; i++) q->q0[i] = q->w.b.q[i];
    q->w.dt = grows ? growth_step(q) : fl_automatic_step(&q->w, &body);
    q->w.automatic_dt = !grows;
    if (grows && !p->q) set_scale(q, s);
    p->s = s;
    if (fl_step_start(&q->w, err) == 0) return 0;
bad:
    p->s = s;
    free_motion(q);
    return -1;
}

/* Poses of the world into the packing. */
static void read_poses(motion *q)
{
    fl_packing *p = q->p;
    for (int32_t i = 0; i < p->n; i++) {
        p->x[i] = fl_region_wrap_point(q->region, q->w.b.x[i]);
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

/* c: velocity lost in a step. */
static void damp_velocities(motion *q, double c)
{
    const fl_relaxation viscous = fl_relaxation_start(FL_RELAXATION_VISCOUS, c);
    const double keep = fl_relaxation_c1(&viscous);
    for (int32_t i = 0; i < q->w.n; i++) {
        q->w.b.v[i] = v3_scale(keep, q->w.b.v[i]);
        fl_body_set_spin(&q->w.b, i, v3_scale(keep, q->w.b.w[i]));
    }
}

/* --- growth ------------------------------------------------------------------------------------- */

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
    return *strain > JAM && (double)o->now.contacts > HELD * (q->p->dim + 1) * q->p->n;
}

/* Steps of one stage: of spheres, growing; of others, at one scale. */
static int run_stage(motion *q, int64_t steps, int grows, fl_pack_moved *out, fl_err *err)
{
    for (int64_t k = 0; k < steps; k++) {
        if (grows && q->p->s < 1.0) set_scale(q, fmin(1.0, q->p->s * (1.0 + RATE)));
        if (fl_step(&q->w, err)) return -1;
        damp_velocities(q, DAMPING);
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
    if (!p->q && make_motion(&q, p, r, &still, 1, err)) return -1;
    while (rc == 0 && !jammed && p->s < 1.0) {
        if (p->q) {
            p->s = fmin(1.0, p->s * (1.0 + STAGE));
            if (make_motion(&q, p, r, &still, 1, err)) return -1;
        }
        rc = run_stage(&q, p->q ? STAGE_STEPS : CHECK, !p->q, out, err);
        if (rc == 0) jammed = is_jammed(&q, o, &strain, err);
        /* bodies that only collide part again while growth pauses */
        if (rc == 0 && jammed > 0) rc = run_stage(&q, PAUSE, 0, out, err);
        if (rc == 0 && jammed > 0) jammed = is_jammed(&q, o, &strain, err);
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
    if (make_motion(&q, p, r, m, 0, err)) return -1;
    while (rc == 0 && quiet < QUIET && out->time < longest) {
        for (int k = 0; rc == 0 && k < CHECK; k++) {
            rc = fl_step(&q.w, err);
            damp_velocities(&q, DRAG * sqrt(m->gravity / d) * q.w.dt);
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
