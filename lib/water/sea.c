/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/mem.h"
#include "water/sea.h"

int fl_sea_alloc(fl_sea *s, int32_t n, fl_err *err)
{
    s->n = n;
    s->outer = fl_alloc(n, sizeof *s->outer, err);
    s->hull = fl_alloc(n, sizeof *s->hull, err);
    s->reach = fl_alloc(n, sizeof *s->reach, err);
    s->wetted = fl_alloc(n, sizeof *s->wetted, err);
    s->energy = fl_alloc(n, sizeof *s->energy, err);
    s->lift = fl_alloc(n, sizeof *s->lift, err);
    s->centre = fl_alloc(n, sizeof *s->centre, err);
    s->flow = fl_alloc(n, sizeof *s->flow, err);
    s->drained = fl_alloc(n, sizeof *s->drained, err);
    s->blown = fl_alloc(n, sizeof *s->blown, err);
    return s->outer && s->hull && s->reach && s->wetted && s->energy && s->lift && s->centre && s->flow &&
                   s->drained && s->blown
               ? 0
               : -1;
}

void fl_sea_free(fl_sea *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        if (s->hull) fl_hull_free(&s->hull[i]);
        if (s->outer) fl_poly_free(&s->outer[i]);
    }
    free(s->outer), free(s->hull), free(s->reach), free(s->wetted), free(s->lift), free(s->energy);
    free(s->centre), free(s->flow), free(s->drained), free(s->blown);
    fl_current_free(&s->current);
    *s = (fl_sea){0};
}

/* The water as it meets body i: force and moment about its centre, world axes. */
static void look(fl_sea *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    const fl_vec3 up = v3(b->R[i].m[2][0], b->R[i].m[2][1], b->R[i].m[2][2]); /* transpose(R) e_z */
    const double level = s->level - b->x[i].z;
    fl_wet wet;
    fl_vec3 turn;
    fl_buoyancy(&s->hull[i], up, level, &wet);
    s->wetted[i] = wet.wetted;
    s->centre[i] = v3_dot(up, wet.centre) - level;
    s->energy[i] = fl_buoyancy_force(&wet, up, level, s->weight, f, &turn);
    s->lift[i] = s->weight * wet.volume;
    s->flow[i] = fl_current_at(&s->current, s->centre[i]);
    if (b->added) b->flow[i] = s->flow[i];
    *f = v3(0, 0, s->lift[i]); /* R up is e_z */
    *t = m3_mul(b->R[i], turn);
}

void fl_sea_force(fl_sea *s, fl_bodies *b, int32_t i)
{
    fl_vec3 f, t;
    look(s, b, i, &f, &t);
    b->f[i] = v3_add(b->f[i], f);
    b->t[i] = v3_add(b->t[i], t);
}

void fl_sea_renew(fl_sea *s, fl_bodies *b, int32_t i)
{
    fl_vec3 f, t;
    if (s->water) look(s, b, i, &f, &t);
}

/* Decay of body i in a fluid that goes by with velocity c; returns the work done on the body. */
static double decay(fl_bodies *b, int32_t i, const fl_fluid *fluid, double area, double reach, fl_vec3 c,
                    double h)
{
    const double before = fl_body_kinetic(b, i) - b->held[i];
    const fl_vec3 u = v3_sub(b->v[i], c), v0 = b->v[i], w0 = b->w[i];
    const double speed = v3_norm(u), spin2 = v3_norm2(b->w[i]);
    const double kappa = fl_drag_kappa_force(fluid, area, b->m[i]);
    if (b->added) {
        /* each axis with its own mass: the step that is implicit in u and frozen in |u|, which is the exact
         * decay along an axis, and slows the others down whatever the step */
        const fl_vec3 a = b->added[i], p = m3_tmul(b->R[i], u);
        const double m = b->m[i], s = kappa * m * speed * h;
        b->v[i] = v3_add(c, m3_mul(b->R[i], v3(p.x / (1.0 + s / (m + a.x)), p.y / (1.0 + s / (m + a.y)),
                                               p.z / (1.0 + s / (m + a.z)))));
    } else {
        b->v[i] = v3_madd(c, fl_drag_factor(kappa, speed, h), u);
    }
    if (spin2 > 0.0 && fluid->moment > 0.0) {
        /* about the axis of the motion, whose moment of inertia is w.L/w^2: exact for a principal axis */
        const double inertia = v3_dot(b->w[i], b->L[i]) / spin2;
        const double turn = fl_drag_factor(fl_drag_kappa_moment(fluid, area, reach, inertia), sqrt(spin2), h);
        b->L[i] = v3_scale(turn, b->L[i]);
        b->w[i] = v3_scale(turn, b->w[i]);
    }
    if (b->hold[i]) fl_hold(b, i, v0, w0);
    return fl_body_kinetic(b, i) - b->held[i] - before;
}

static void drag_of_water(fl_sea *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->water || s->wetted[i] <= 0.0) return;
    s->drained[i] -= decay(b, i, &s->sea, s->wetted[i], s->reach[i], s->flow[i], h);
}

static void drag_of_wind(fl_sea *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->wind) return;
    const double dry = s->hull[i].surface - (s->water ? s->wetted[i] : 0.0);
    const fl_vec3 c = s->breeze;
    if (dry > 0.0) s->blown[i] += decay(b, i, &s->air, dry, s->reach[i], c, h);
}

void fl_sea_drag(fl_sea *s, fl_bodies *b, int32_t i, double h, int back)
{
    if (back) drag_of_wind(s, b, i, h);
    drag_of_water(s, b, i, h);
    if (!back) drag_of_wind(s, b, i, h);
}
