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

int fl_sea_alloc_pieces(fl_sea *s, fl_err *err)
{
    const int wet = s->water && s->sea_law == FL_DRAG_FACET, dry = s->wind && s->air_law == FL_DRAG_FACET;
    if (!wet && !dry) return 0;
    s->first = fl_alloc((int64_t)s->n + 1, sizeof *s->first, err);
    if (!s->first) return -1;
    for (int32_t i = 0; i < s->n; i++) s->first[i + 1] = s->first[i] + fl_skin_most(&s->hull[i]);
    if (wet) {
        s->wet = fl_alloc(s->first[s->n], sizeof *s->wet, err);
        s->wets = fl_alloc(s->n, sizeof *s->wets, err);
        if (!s->wet || !s->wets) return -1;
    }
    if (dry) {
        s->dry = fl_alloc(s->first[s->n], sizeof *s->dry, err);
        s->dries = fl_alloc(s->n, sizeof *s->dries, err);
        if (!s->dry || !s->dries) return -1;
        /* where there is no water to tell otherwise, all is dry */
        for (int32_t i = 0; i < s->n; i++)
            s->dries[i] = fl_skin_pieces(&s->hull[i], v3(0, 0, 1), -INFINITY, 1, s->dry + s->first[i]);
    }
    return 0;
}

void fl_sea_free(fl_sea *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        if (s->hull) fl_hull_free(&s->hull[i]);
        if (s->outer) fl_poly_free(&s->outer[i]);
    }
    free(s->outer), free(s->hull), free(s->reach), free(s->wetted), free(s->lift), free(s->energy);
    free(s->centre), free(s->flow), free(s->drained), free(s->blown);
    free(s->first), free(s->wet), free(s->dry), free(s->wets), free(s->dries);
    fl_current_free(&s->current);
    *s = (fl_sea){0};
}

/* Where the surface of body i is wet and dry, and how the water goes by there. */
static void look_at_pieces(fl_sea *s, const fl_bodies *b, int32_t i, fl_vec3 up, double level)
{
    const fl_hull *h = &s->hull[i];
    if (s->dry) s->dries[i] = fl_skin_pieces(h, up, level, 1, s->dry + s->first[i]);
    if (!s->wet) return;
    fl_skin_piece *wet = s->wet + s->first[i];
    s->wets[i] = fl_skin_pieces(h, up, level, 0, wet);
    if (s->current.kind == FL_PROFILE_UNIFORM) return;
    for (int32_t k = 0; k < s->wets[i]; k++) {
        const fl_vec3 u = fl_current_at(&s->current, v3_dot(up, wet[k].r) - level);
        wet[k].flow = m3_tmul(b->R[i], v3_sub(u, s->flow[i]));
    }
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
    if (s->first) look_at_pieces(s, b, i, up, level);
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

/* The same by the pieces of its surface. */
static double decay_of_pieces(fl_bodies *b, int32_t i, const fl_skin_piece *piece, int32_t n, double skin,
                              double form, fl_vec3 c, double h)
{
    const double before = fl_body_kinetic(b, i) - b->held[i], m = b->m[i];
    const fl_vec3 v0 = b->v[i], w0 = b->w[i], I = b->I[i], a = b->added ? b->added[i] : v3(0, 0, 0);
    fl_vec3 v = m3_tmul(b->R[i], v3_sub(v0, c)), w = m3_tmul(b->R[i], w0);
    fl_facet_drag(n, piece, skin, form, v3(m + a.x, m + a.y, m + a.z), I, h, &v, &w);
    b->v[i] = v3_add(c, m3_mul(b->R[i], v));
    b->w[i] = m3_mul(b->R[i], w);
    b->L[i] = m3_mul(b->R[i], v3_mul(I, w));
    if (b->hold[i]) fl_hold(b, i, v0, w0);
    return fl_body_kinetic(b, i) - b->held[i] - before;
}

static void drag_of_water(fl_sea *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->water || s->wetted[i] <= 0.0) return;
    if (s->wet && s->hull[i].p->nf)
        s->drained[i] -=
            decay_of_pieces(b, i, s->wet + s->first[i], s->wets[i], 0.5 * s->sea.density * s->sea_skin,
                            0.5 * s->sea.density * s->sea_form, s->flow[i], h);
    else s->drained[i] -= decay(b, i, &s->sea, s->wetted[i], s->reach[i], s->flow[i], h);
}

static void drag_of_wind(fl_sea *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->wind) return;
    const double dry = s->hull[i].surface - (s->water ? s->wetted[i] : 0.0);
    if (!(dry > 0.0)) return;
    if (s->dry && s->hull[i].p->nf)
        s->blown[i] +=
            decay_of_pieces(b, i, s->dry + s->first[i], s->dries[i], 0.5 * s->air.density * s->air.force,
                            0.5 * s->air.density * s->air_form, s->breeze, h);
    else s->blown[i] += decay(b, i, &s->air, dry, s->reach[i], s->breeze, h);
}

void fl_sea_drag(fl_sea *s, fl_bodies *b, int32_t i, double h, int back)
{
    if (back) drag_of_wind(s, b, i, h);
    drag_of_water(s, b, i, h);
    if (!back) drag_of_wind(s, b, i, h);
}
