/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include "base/mem.h"
#include "base/pi.h"
#include "water/sea.h"

/* Places that a wave is looked at in for one body, at most. */
#define MOST_CELLS 1000000

/* Where a plane is fitted to the wave, to a column of cells, which is no wider than 1.6 of the shortest wave:
 * one bend after another evens out. */
enum { PLACES = 8 };

static const fl_sea_held unseen = {.q = {1, 0, 0, 0}, .when = INFINITY};

int fl_sea_alloc(fl_sea *s, int32_t n, int threads, fl_err *err)
{
    s->n = n;
    s->threads = threads;
    s->hull = fl_alloc(n, sizeof *s->hull, err);
    s->reach = fl_alloc(n, sizeof *s->reach, err);
    s->wetted = fl_alloc(n, sizeof *s->wetted, err);
    s->lift = fl_alloc(n, sizeof *s->lift, err);
    s->drained = fl_alloc(n, sizeof *s->drained, err);
    if (!s->hull || !s->reach || !s->wetted || !s->lift || !s->drained) return -1;
    if (s->waves || s->current.kind != FL_PROFILE_UNIFORM) {
        s->flow = fl_alloc(n, sizeof *s->flow, err);
        if (!s->flow) return -1;
    }
    if (s->wind) {
        s->blown = fl_alloc(n, sizeof *s->blown, err);
        if (!s->blown) return -1;
    }
    if ((s->water && s->sea_law == FL_DRAG_FACET) || (s->wind && s->air_law == FL_DRAG_FACET)) {
        s->skin = fl_alloc(n, sizeof *s->skin, err);
        if (!s->skin) return -1;
    }
    if (!s->waves) return 0; /* a look at still water costs no more than its drag */
    if (s->every > 1) {
        s->held = fl_alloc(n, sizeof *s->held, err);
        if (!s->held) return -1;
        for (int32_t i = 0; i < n; i++) s->held[i] = unseen;
        s->looks = 1;
    }
    s->tiles = fl_alloc(n, sizeof *s->tiles, err);
    s->push = fl_alloc(n, sizeof *s->push, err);
    s->turn = fl_alloc(n, sizeof *s->turn, err);
    s->waved = fl_alloc(n, sizeof *s->waved, err);
    return s->tiles && s->push && s->turn && s->waved ? 0 : -1;
}

static void bare_skin(fl_sea_skin *skin)
{
    fl_facets_free(&skin->facets);
    fl_patches_free(&skin->wet), fl_patches_free(&skin->dry);
}

static int fit_skin(fl_sea *s, int32_t i, fl_err *err)
{
    const fl_hull *h = &s->hull[i];
    fl_sea_skin *skin = &s->skin[i];
    bare_skin(skin);
    if (h->p->nf == 0) return 0;
    if (fl_facets_make(&skin->facets, h, err)) return -1;
    if (s->water && s->sea_law == FL_DRAG_FACET && fl_patches_make(&skin->wet, h, 0, s->flow != NULL, err))
        return -1;
    if (s->wind && s->air_law == FL_DRAG_FACET) {
        if (fl_patches_make(&skin->dry, h, 1, 0, err)) return -1;
        /* where there is no water to tell otherwise, all is dry */
        fl_patches_look(&skin->dry, &skin->facets, h, v3(0, 0, 1), -INFINITY);
    }
    return 0;
}

int fl_sea_fit(fl_sea *s, int32_t i, fl_err *err)
{
    if (s->held) s->held[i] = unseen;
    if (s->skin && fit_skin(s, i, err)) return -1;
    if (!s->waves) return 0;
    const int32_t want = fl_wave_cells(&s->wave, s->reach[i] + s->wave.swing);
    if (want > MOST_CELLS)
        return fl_fail(err, FL_INPUT,
                       "water.height, water.period: waves down to %.3g m long that rise by up to %.3g m "
                       "would be seen by "
                       "a floe that reaches %.3g m in more than %d places",
                       2.0 * PI / s->wave.top, s->wave.swing, s->reach[i], MOST_CELLS);
    if (want > s->cells_each) {
        fl_wave_near *cells = fl_alloc((int64_t)s->threads * want, sizeof *cells, err);
        if (!cells) return -1;
        free(s->cells);
        s->cells = cells;
        s->cells_each = want;
    }
    return fl_tiles_make(&s->tiles[i], &s->hull[i], &s->wave, err);
}

void fl_sea_bare(fl_sea *s, int32_t i)
{
    fl_poly *const outer = fl_sea_outer(s, i);
    fl_hull_free(&s->hull[i]);
    if (outer) fl_poly_free(outer);
    free(outer);
}

int fl_sea_dress(fl_sea *s, int32_t i, fl_poly *outer, const fl_poly *core, double r, fl_err *err)
{
    if (!outer) {
        s->reach[i] = fl_drag_radius(core, r);
        return fl_hull_make(&s->hull[i], core, r, err);
    }
    s->reach[i] = fl_drag_radius(outer, 0.0);
    if (fl_hull_make(&s->hull[i], outer, 0.0, err)) return -1;
    if (!s->waves && !s->skin && fl_hull_by_core(&s->hull[i], core, r)) return 0;
    fl_poly *const own = fl_alloc(1, sizeof *own, err);
    if (!own) {
        fl_hull_free(&s->hull[i]);
        return -1;
    }
    *own = *outer;
    *outer = (fl_poly){0};
    s->hull[i].p = own;
    return 0;
}

void fl_sea_free(fl_sea *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        if (s->hull) fl_sea_bare(s, i);
        if (s->tiles) fl_tiles_free(&s->tiles[i]);
        if (s->skin) bare_skin(&s->skin[i]);
    }
    free(s->hull), free(s->reach), free(s->wetted), free(s->lift);
    free(s->flow), free(s->drained), free(s->blown);
    free(s->cells), free(s->push), free(s->turn), free(s->waved);
    free(s->tiles), free(s->skin), free(s->held);
    fl_waves_free(&s->wave);
    fl_current_free(&s->current);
    *s = (fl_sea){0};
}

/* Velocity of the waves at r from the origin of a body, and the acceleration; world axes. */
static fl_vec3 orbital(const fl_sea *s, const fl_afloat *at, const fl_wave_around *around, fl_vec3 r,
                       fl_vec3 *acceleration)
{
    const double x = at->s + v3_dot(at->along, r), z = at->z + v3_dot(at->up, r),
                 zeta = fl_wave_stretch(&s->wave, z, fl_wave_over(around, x, NULL));
    double u[2], a[2];
    fl_wave_motion(&s->wave, fl_wave_at(around, x, zeta), x, zeta, u, a);
    *acceleration = v3_madd(v3(0, 0, a[1]), a[0], s->wave.along);
    return v3_madd(v3(0, 0, u[1]), u[0], s->wave.along);
}

/* How the water goes by at all pieces that are wet. */
static void look_at_flow(fl_sea *s, const fl_bodies *b, int32_t i, const fl_afloat *at,
                         const fl_wave_around *around)
{
    const fl_mat3 R = fl_body_axes(b, i);
    fl_patches *wet = &s->skin[i].wet;
    int32_t k = 0;
    for (const fl_patches_four *f = wet->four; f < wet->four + wet->fours; f++)
        for (const int32_t end = k + f->rows; k < end; k++)
            for (int l = 0; l < FL_LANES; l++) {
                const fl_vec3 r = fl_patches_place(f, &wet->row[k], l);
                fl_vec3 u = v3(0, 0, 0), none;
                if (wet->row[k].area[l] > 0.0) {
                    u = fl_current_at(&s->current, at->z + v3_dot(at->up, r));
                    if (around) u = v3_add(u, orbital(s, at, around, r, &none));
                    u = fl_patches_in(f, l, m3_tmul(R, v3_sub(u, fl_sea_flow(s, i))));
                }
                wet->flow[k].u[0][l] = u.x, wet->flow[k].u[1][l] = u.y, wet->flow[k].u[2][l] = u.z;
            }
}

/* Where the surface of body i is wet and dry, and how the water goes by there; around: NULL without waves. */
static void look_at_skin(fl_sea *s, const fl_bodies *b, int32_t i, fl_vec3 up, double level,
                         const fl_afloat *at, const fl_wave_around *around)
{
    const fl_hull *h = &s->hull[i];
    fl_sea_skin *skin = &s->skin[i];
    if (skin->dry.four) fl_patches_look(&skin->dry, &skin->facets, h, up, level);
    if (!skin->wet.four) return;
    fl_patches_look(&skin->wet, &skin->facets, h, up, level);
    if (skin->wet.flow) look_at_flow(s, b, i, at, around);
}

void fl_sea_look_at_skin(fl_sea *s, const fl_bodies *b, int32_t i, fl_vec3 up, double level)
{
    const fl_afloat at = {.up = up, .z = -level};
    look_at_skin(s, b, i, up, level, &at, NULL);
}

/* e_z of the world in the frame of a body with these axes. */
static fl_vec3 upward(fl_mat3 R) { return v3(R.m[2][0], R.m[2][1], R.m[2][2]); }

/* What is below still water; one that is wholly dry or wet by far is told by its reach alone.  up is
 * transpose(R) e_z. */
static fl_wet wet_of(const fl_sea *s, int32_t i, fl_vec3 up, double level)
{
    const fl_hull *h = &s->hull[i];
    fl_wet wet = {0};
    if (level >= s->reach[i]) wet = (fl_wet){.volume = h->volume, .centre = h->centre, .wetted = h->surface};
    else if (level > -s->reach[i]) fl_buoyancy(h, up, level, &wet);
    return wet;
}

double fl_sea_energy(const fl_sea *s, const fl_bodies *b, int32_t i)
{
    const fl_vec3 up = upward(fl_body_axes(b, i));
    const double level = s->level - b->x[i].z;
    const fl_wet wet = wet_of(s, i, up, level);
    fl_vec3 f, turn;
    return fl_buoyancy_force(&wet, up, level, s->weight, &f, &turn);
}

/* Still water as it meets body i: force and moment about its centre, world axes. */
static void look_still(fl_sea *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 up = upward(R);
    const double level = s->level - b->x[i].z;
    const fl_wet wet = wet_of(s, i, up, level);
    fl_vec3 turn;
    s->wetted[i] = wet.wetted;
    fl_buoyancy_force(&wet, up, level, s->weight, f, &turn);
    s->lift[i] = s->weight * wet.volume;
    if (s->flow) s->flow[i] = fl_current_at(&s->current, v3_dot(up, wet.centre) - level);
    if (b->added) b->flow[i] = fl_sea_flow(s, i);
    if (s->skin) fl_sea_look_at_skin(s, b, i, up, level);
    *f = v3(0, 0, s->lift[i]); /* R up is e_z */
    *t = m3_mul(R, turn);
}

double fl_sea_omega2(const fl_sea *s, const fl_bodies *b, int32_t i, int *turns)
{
    const fl_hull *h = &s->hull[i];
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 up = upward(R), none = v3(0, 0, 0);
    const fl_yielding yields = fl_body_yielding(b, i);
    fl_wet wet;
    fl_buoyancy(h, up, 0.0, &wet);
    double most = s->weight * wet.waterplane * fl_ease_along(&yields, v3(0, 0, 1), none);
    *turns = 0;
    if (h->p->nf == 0) return most; /* what is round hardly rights itself */
    fl_waterplane plane;
    fl_buoyancy_plane(h, up, 0.0, &plane);
    const fl_vec3 e = m3_tmul(R, v3(1, 0, 0)), g = m3_tmul(R, v3(0, 1, 0)), Te = m3_mul(plane.second, e);
    const double xx = v3_dot(e, Te), xy = v3_dot(g, Te), yy = v3_dot(g, m3_mul(plane.second, g)),
                 angle = 0.5 * atan2(2.0 * xy, xx - yy); /* of its main axes */
    for (int k = 0; k < 2; k++) {
        const double a = angle + 0.5 * k * PI, c = cos(a), d = sin(a),
                     J = c * c * xx + 2.0 * c * d * xy + d * d * yy;
        const double omega2 = s->weight * J * fl_ease_along(&yields, none, v3(-d, c, 0));
        if (omega2 > most) most = omega2, *turns = 1;
    }
    return most;
}

/* How far body i reaches along a direction of its own axes. */
static void extent(const fl_sea *s, int32_t i, fl_vec3 d, double *lo, double *hi)
{
    const fl_poly *p = s->hull[i].p;
    const double r = s->hull[i].radius;
    double least = INFINITY, most = -INFINITY;
    for (int32_t v = 0; v < p->nv; v++) {
        const double x = v3_dot(d, p->v[v]);
        least = x < least ? x : least;
        most = x > most ? x : most;
    }
    *lo = least - r;
    *hi = most + r;
}

/* The plane that lies nearest to the wave along a body whose origin is at s. */
static void fit_plane(const fl_wave_around *a, double s, double *z, double *slope)
{
    const int n = PLACES * a->columns;
    const double all = n, step = a->width / PLACES, spread = all * (all * all - 1.0) / 12.0 * step * step,
                 middle = a->s0 + 0.5 * all * step; /* spread: the sum of off^2 */
    double sum = 0.0, tilt = 0.0;
    for (int k = 0; k < n; k++) {
        const double off = (k + 0.5 - 0.5 * all) * step, eta = fl_wave_over(a, middle + off, NULL);
        sum += eta;
        tilt += off * eta;
    }
    *slope = tilt / spread;
    *z = sum / all + (s - middle) * *slope;
}

/* Buoyancy of body i where the water is a plane, z over still water at the body's origin; world axes. */
static void float_on(const fl_sea *s, const fl_bodies *b, int32_t i, double z, double slope, fl_vec3 *f,
                     fl_vec3 *t)
{
    const fl_mat3 R = fl_body_axes(b, i);
    const double c = 1.0 / sqrt(1.0 + slope * slope), level = c * (z + s->level - b->x[i].z);
    const fl_vec3 up = v3_scale(c, v3_madd(upward(R), -slope, m3_tmul(R, s->wave.along)));
    const fl_wet wet = wet_of(s, i, up, level);
    fl_vec3 force, turn;
    fl_buoyancy_force(&wet, up, level, s->weight / c, &force, &turn); /* the pressure grows downwards */
    *f = m3_mul(R, force);
    *t = m3_mul(R, turn);
}

/* The plane about body i, at s, as it is now, and how it went on from the look before. */
static void hold_plane(fl_sea *s, int32_t i, const fl_wave_around *around, double at)
{
    fl_sea_held *h = &s->held[i];
    const double past = s->time - h->when, z = h->z, slope = h->slope;
    fit_plane(around, at, &h->z, &h->slope);
    if (!(past > 0.0)) return;
    h->dz = (h->z - z) / past;
    h->dslope = (h->slope - slope) / past;
}

/* A sea with waves as it meets body i. */
static void look_wavy(fl_sea *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    const fl_waves *w = &s->wave;
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_afloat at = {.up = upward(R),
                          .along = m3_tmul(R, w->along),
                          .s = v3_dot(w->along, b->x[i]),
                          .z = b->x[i].z - s->level};
    const fl_hull *h = &s->hull[i];
    fl_push p = {0};
    fl_wave_around around;
    const int meets = at.z - s->reach[i] < w->crest;
    *f = *t = v3(0, 0, 0);
    if (meets || s->held) {
        double s_lo, s_hi, z_lo, z_hi;
        extent(s, i, at.along, &s_lo, &s_hi);
        extent(s, i, at.up, &z_lo, &z_hi);
        fl_wave_surround(w, at.s + s_lo, at.s + s_hi, at.z + z_lo - w->swing, at.z + z_hi + w->swing, s->time,
                         s->cells + (int64_t)omp_get_thread_num() * s->cells_each, &around);
        if (s->held) hold_plane(s, i, &around, at.s);
        if (meets && h->p->nf) fl_froude_solid(&s->tiles[i], h, w, &around, &at, s->weight, &p);
        else if (meets) fl_froude_round(h, w, &around, &at, s->weight, &p);
    }
    s->wetted[i] = p.wetted;
    s->lift[i] = s->weight * p.volume;
    s->flow[i] = fl_current_at(&s->current, at.z + v3_dot(at.up, p.centre));
    if (p.volume > 0.0) {
        fl_vec3 a, up;
        double level;
        s->flow[i] = v3_add(s->flow[i], orbital(s, &at, &around, p.centre, &a));
        *f = m3_mul(R, p.force);
        *t = m3_mul(R, p.moment);
        if (b->added) *f = v3_add(*f, m3_mul(R, v3_mul(b->added[i], m3_tmul(R, a))));
        if (s->skin) {
            fl_wave_plane(&around, &at, &up, &level);
            look_at_skin(s, b, i, up, level, &at, &around);
        }
    } else if (s->skin) {
        look_at_skin(s, b, i, at.up, -INFINITY, &at, NULL);
    }
    if (b->added) b->flow[i] = s->flow[i];
    s->push[i] = *f;
    s->turn[i] = *t;
}

/* From then to now. */
static fl_vec3 change(fl_vec3 now, fl_vec3 then, double past)
{
    return v3_scale(1.0 / past, v3_sub(now, then));
}

/* What of it the plane does not tell. */
static void hold(fl_sea *s, const fl_bodies *b, int32_t i, fl_vec3 f, fl_vec3 t)
{
    fl_sea_held *h = &s->held[i];
    const double past = s->time - h->when;
    fl_vec3 force, turn;
    float_on(s, b, i, h->z, h->slope, &force, &turn);
    f = v3_sub(f, force), t = v3_sub(t, turn);
    if (past > 0.0) {
        h->df = change(f, h->f, past);
        h->dt = change(t, h->t, past);
        h->dflow = change(s->flow[i], h->flow, past);
    }
    h->f = f, h->t = t, h->flow = s->flow[i];
    h->x = b->x[i], h->q = b->q[i], h->when = s->time;
}

static void look(fl_sea *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    if (s->waves) look_wavy(s, b, i, f, t);
    else look_still(s, b, i, f, t);
    if (s->held) hold(s, b, i, *f, *t);
}

/* What there would be to see by now. */
static void go_on(fl_sea *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    const fl_sea_held *h = &s->held[i];
    const double past = s->time - h->when;
    float_on(s, b, i, h->z + past * h->dz, h->slope + past * h->dslope, f, t);
    *f = v3_add(*f, v3_madd(h->f, past, h->df));
    *t = v3_add(*t, v3_madd(h->t, past, h->dt));
    s->flow[i] = v3_madd(h->flow, past, h->dflow);
    if (b->added) b->flow[i] = s->flow[i];
    s->push[i] = *f, s->turn[i] = *t;
}

void fl_sea_force(fl_sea *s, fl_bodies *b, int32_t i)
{
    fl_vec3 f, t;
    if (s->held && !s->looks) go_on(s, b, i, &f, &t);
    else look(s, b, i, &f, &t);
    b->f[i] = v3_add(b->f[i], f);
    b->t[i] = v3_add(b->t[i], t);
}

void fl_sea_renew(fl_sea *s, fl_bodies *b, int32_t i)
{
    fl_vec3 f, t;
    if (!s->water) return;
    if (!s->held) {
        look(s, b, i, &f, &t);
        return;
    }
    const fl_vec3 x = b->x[i];
    const fl_quat q = b->q[i];
    const double now = s->time;
    b->x[i] = s->held[i].x, b->q[i] = s->held[i].q, s->time = s->held[i].when;
    look(s, b, i, &f, &t);
    b->x[i] = x, b->q[i] = q, s->time = now;
    if (now > s->held[i].when) go_on(s, b, i, &f, &t); /* else it was a look, which nothing is added to */
}

void fl_sea_book(fl_sea *s, const fl_bodies *b, int32_t i, double h, fl_vec3 v0, fl_vec3 w0)
{
    s->waved[i] +=
        0.5 * h * (v3_dot(s->push[i], v3_add(v0, b->v[i])) + v3_dot(s->turn[i], v3_add(w0, b->w[i])));
}

/* Decay of body i in a fluid that goes by with velocity c; returns the work done on the body. */
static double decay(fl_bodies *b, int32_t i, const fl_fluid *fluid, double area, double reach, fl_vec3 c,
                    double h)
{
    const double before = fl_body_kinetic(b, i) - b->held[i];
    const fl_vec3 u = v3_sub(b->v[i], c), v0 = b->v[i], w0 = b->w[i];
    const double speed = v3_norm(u), spin2 = v3_norm2(b->w[i]);
    const double c_force = fl_drag_of_force(fluid, area), m = b->m[i];
    if (b->added) {
        /* each axis with its own mass: the step that is implicit in u and frozen in |u|, which is the exact
         * decay along an axis, and slows the others down whatever the step */
        const fl_mat3 R = fl_body_axes(b, i);
        const fl_vec3 a = b->added[i], p = m3_tmul(R, u);
        const double s = c_force * speed * h;
        b->v[i] = v3_add(c, m3_mul(R, v3(p.x / (1.0 + s / (m + a.x)), p.y / (1.0 + s / (m + a.y)),
                                         p.z / (1.0 + s / (m + a.z)))));
    } else {
        b->v[i] = v3_madd(c, fl_drag_factor(m, c_force, speed, h), u);
    }
    const double turning = v3_dot(b->w[i], b->L[i]);
    if (turning > 0.0 && fluid->moment > 0.0) {
        /* about the axis of the motion, whose moment of inertia is w.L/w^2: exact for a principal axis; both
         * sides of the factor times w^2 */
        const double turn =
            fl_drag_factor(turning, fl_drag_of_moment(fluid, area, reach) * spin2, sqrt(spin2), h);
        b->L[i] = v3_scale(turn, b->L[i]);
        b->w[i] = v3_scale(turn, b->w[i]);
    }
    if (b->hold[i]) fl_hold(b, i, v0, w0);
    return fl_body_kinetic(b, i) - b->held[i] - before;
}

/* The same facet by facet. */
static double decay_of_facets(fl_bodies *b, int32_t i, const fl_patches *of, fl_facet_law law, fl_vec3 c,
                              double h)
{
    const double before = fl_body_kinetic(b, i) - b->held[i], m = b->m[i];
    const fl_vec3 v0 = b->v[i], w0 = b->w[i], I = b->I[i], a = b->added ? b->added[i] : v3(0, 0, 0);
    const fl_mat3 R = fl_body_axes(b, i);
    fl_vec3 v = m3_tmul(R, v3_sub(v0, c)), w = m3_tmul(R, w0);
    fl_facet_drag(of, law, v3(m + a.x, m + a.y, m + a.z), I, h, &v, &w);
    b->v[i] = v3_add(c, m3_mul(R, v));
    b->w[i] = m3_mul(R, w);
    b->L[i] = m3_mul(R, v3_mul(I, w));
    if (b->hold[i]) fl_hold(b, i, v0, w0);
    return fl_body_kinetic(b, i) - b->held[i] - before;
}

static void drag_of_water(fl_sea *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->water || s->wetted[i] <= 0.0) return;
    if (s->skin && s->skin[i].wet.four)
        s->drained[i] -= decay_of_facets(b, i, &s->skin[i].wet, fl_sea_law_of_water(s), fl_sea_flow(s, i), h);
    else s->drained[i] -= decay(b, i, &s->sea, s->wetted[i], s->reach[i], fl_sea_flow(s, i), h);
}

static void drag_of_wind(fl_sea *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->wind) return;
    const double dry = s->hull[i].surface - (s->water ? s->wetted[i] : 0.0);
    if (!(dry > 0.0)) return;
    if (s->skin && s->skin[i].dry.four)
        s->blown[i] += decay_of_facets(b, i, &s->skin[i].dry, fl_sea_law_of_air(s), s->breeze, h);
    else s->blown[i] += decay(b, i, &s->air, dry, s->reach[i], s->breeze, h);
}

void fl_sea_drag(fl_sea *s, fl_bodies *b, int32_t i, double h, int back)
{
    if (back) drag_of_wind(s, b, i, h);
    drag_of_water(s, b, i, h);
    if (!back) drag_of_wind(s, b, i, h);
}
