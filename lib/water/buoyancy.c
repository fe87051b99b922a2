/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/fast_math.h"
#include "base/pi.h"
#include "geom/dilate.h"
#include "water/buoyancy.h"

void fl_hull_fill(fl_hull *h, double fill)
{
    h->fill = fill;
    h->volume *= fill;
    h->surface_area *= fill;
}

int fl_hull_make(fl_hull *h, const fl_poly *p, double radius, fl_err *err)
{
    const int round = p->nv <= 2;
    fl_hull out = {.shape = p, .radius = round ? radius : 0.0, .fill = 1.0};
    fl_mass m;
    if (fl_mass_of(&m, p, out.radius, err)) return -1;
    out.volume = m.volume;
    out.centre = m.centre;
    out.surface_area = fl_dilate_area(p, out.radius);
    if (!round) {
        out.face_area = fl_alloc(4 * (int64_t)p->nf, sizeof *out.face_area, err);
        if (!out.face_area) return -1;
    }
    for (int32_t f = 0; !round && f < p->nf; f++) {
        const fl_vec3 a = p->v[p->loop[p->first[f]]];
        fl_vec3 b = v3_sub(p->v[p->loop[p->first[f] + 1]], a), g = {0};
        for (int32_t k = p->first[f] + 2; k < p->first[f + 1]; k++) {
            const fl_vec3 c = v3_sub(p->v[p->loop[k]], a);
            const double tri = 0.5 * v3_dot(p->n[f], v3_cross(b, c));
            out.face_area[f] += tri;
            g = v3_madd(g, tri / 3.0, v3_add(b, c));
            b = c;
        }
        fl_hull_face_centroids(&out)[f] = v3_madd(a, 1.0 / out.face_area[f], g);
    }
    if (!round) fl_prism_of(&out.prism, p);
    *h = out;
    return 0;
}

/* Vertices up to which heights are stored. */
enum { MAX_KEPT = 64 };

/* The right prism whose faces lie r outside those of a core with long edges along e. */
struct offset_prism {
    fl_poly p;
    fl_vec3 v[MAX_KEPT];
    double c[MAX_KEPT];
};

static const fl_poly *offset_faces(struct offset_prism *to, const fl_poly *core, fl_vec3 e, double r)
{
    fl_vec3 *v = to->v;
    const int32_t *first = core->first, *loop = core->loop;
    to->p = *core;
    to->p.v = v;
    to->p.c = to->c;
    for (int32_t k = 0; k < core->nv; k++) v[k] = v3(0, 0, 0);
    for (int32_t f = 0; f < core->nf; f++) {
        const fl_vec3 n = core->n[f];
        for (int32_t k = first[f]; k < first[f + 1] && fabs(v3_dot(e, n)) < 0.5; k++)
            v[loop[k]] = v3_add(v[loop[k]], n);
    }
    for (int32_t f = 0; f < core->nf; f++) {
        const fl_vec3 n = core->n[f];
        if (fabs(v3_dot(e, n)) < 0.5) continue;
        for (int32_t k = first[f]; k < first[f + 1]; k++) { /* |n_1 + n_2|^2 = 2 (1 + n_1.n_2) */
            const fl_vec3 sides = v[loop[k]];
            v[loop[k]] = v3_madd(v3_madd(core->v[loop[k]], r, n), 2.0 * r / v3_norm2(sides), sides);
        }
    }
    for (int32_t f = 0; f < core->nf; f++) to->c[f] = v3_dot(core->n[f], v[loop[first[f]]]);
    return &to->p;
}

/* The polyhedron that floats. */
static const fl_poly *floating_shape(const fl_hull *h, struct offset_prism *scratch)
{
    return h->face_area || h->shape->nf == 0 ? h->shape
                                             : offset_faces(scratch, h->shape, h->prism.e, h->radius);
}

/* of the size: the rounding of the formula and of the corners read; below it the two shapes are the same */
#define CORE_TOL 1e-12

int fl_hull_borrow_core(fl_hull *h, const fl_poly *core, double r)
{
    const fl_poly *p = h->shape;
    struct offset_prism scratch;
    if (!(h->prism.area > 0.0) || p->nv > MAX_KEPT || core->nv != p->nv || core->nf != p->nf) return 0;
    const int32_t loops = p->first[p->nf];
    if (memcmp(core->first, p->first, ((size_t)p->nf + 1) * sizeof *p->first) != 0 ||
        memcmp(core->loop, p->loop, (size_t)loops * sizeof *p->loop) != 0)
        return 0;
    const fl_poly *q = offset_faces(&scratch, core, h->prism.e, r);
    for (int32_t v = 0; v < p->nv; v++) /* written so that a NaN fails */
        if (!(v3_norm(v3_sub(p->v[v], q->v[v])) <= CORE_TOL * p->size)) return 0;
    free(h->face_area);
    h->face_area = NULL;
    h->shape = core;
    h->radius = r;
    return 1;
}

void fl_hull_free(fl_hull *h)
{
    free(h->face_area);
    *h = (fl_hull){0};
}

/* The water plane, and the heights of the vertices above it if there are few enough to store: every face of a
 * vertex needs its height. */
struct plane_heights {
    fl_vec3 up;
    double level, s[MAX_KEPT];
    int kept;
};

static double height_over(const fl_poly *p, int32_t v, const struct plane_heights *w)
{
    return w->kept ? w->s[v] : v3_dot(w->up, p->v[v]) - w->level;
}

/* Wetted part of a face: area, int (x - apex) dA, and the points where the water line leaves and enters the
 * loop. */
struct wet_face {
    double area;
    fl_vec3 moment, leave, enter;
    int cut;
};

/* A fan of triangles over the first corner, built corner by corner. */
struct face_fan {
    fl_vec3 n, apex, hub, rim;
    int have;
};

static inline void fan_add(struct face_fan *fan, struct wet_face *out, fl_vec3 corner)
{
    const fl_vec3 x = v3_sub(corner, fan->apex);
    if (fan->have >= 2) {
        const double tri = 0.5 * v3_dot(fan->n, v3_cross(v3_sub(fan->rim, fan->hub), v3_sub(x, fan->hub)));
        out->area += tri;
        out->moment = v3_madd(out->moment, tri / 3.0, v3_add(v3_add(fan->hub, fan->rim), x));
    }
    if (fan->have == 0) fan->hub = x;
    fan->rim = x;
    fan->have++;
}

/* Walks round face f and keeps the wet part, as a fan over its first wet corner, so that no list of corners
 * is needed. A crossing is always computed from its wet end, so that both faces of an edge find the same
 * point. */
static struct wet_face clip_face(const fl_poly *p, int32_t f, const struct plane_heights *w, fl_vec3 apex)
{
    const int32_t *at = p->loop + p->first[f], m = p->first[f + 1] - p->first[f];
    struct wet_face out = {0};
    struct face_fan fan = {.n = p->n[f], .apex = apex};
    fl_vec3 from = p->v[at[m - 1]];
    double s0 = height_over(p, at[m - 1], w);
    for (int32_t k = 0; k < m; k++) {
        const fl_vec3 to = p->v[at[k]];
        const double s1 = height_over(p, at[k], w);
        const int wet0 = s0 <= 0.0, wet1 = s1 <= 0.0;
        if (wet0 && !wet1) {
            out.leave = v3_lerp(from, to, s0 / (s0 - s1));
            out.cut = 1;
            fan_add(&fan, &out, out.leave);
        } else if (!wet0 && wet1) {
            out.enter = v3_lerp(to, from, s1 / (s1 - s0));
            fan_add(&fan, &out, out.enter);
        }
        if (wet1) fan_add(&fan, &out, to);
        from = to;
        s0 = s1;
    }
    return out;
}

/* The same of a face that is wholly wet. */
static struct wet_face whole_face_of(const fl_poly *p, int32_t f, fl_vec3 apex)
{
    const int32_t *at = p->loop + p->first[f], m = p->first[f + 1] - p->first[f];
    const fl_vec3 hub = p->v[at[0]], n = p->n[f], by = v3_sub(hub, apex);
    fl_vec3 rim = v3_sub(p->v[at[1]], hub);
    struct wet_face out = {0};
    for (int32_t k = 2; k < m; k++) {
        const fl_vec3 x = v3_sub(p->v[at[k]], hub);
        const double tri = 0.5 * v3_dot(n, v3_cross(rim, x));
        out.area += tri;
        out.moment = v3_madd(out.moment, tri / 3.0, v3_add(rim, x));
        rim = x;
    }
    out.moment = v3_madd(out.moment, out.area, by);
    return out;
}

/* Returns -1 dry, +1 wet, 0 cut. For a cut body the apex is where the line from the deepest to the highest
 * vertex meets the water plane, a point inside. */
static int find_apex(const fl_poly *p, fl_vec3 up, double level, struct plane_heights *w, fl_vec3 *apex)
{
    double low = INFINITY, high = -INFINITY;
    int32_t l = 0, h = 0;
    w->up = up;
    w->level = level;
    w->kept = p->nv <= MAX_KEPT;
    for (int32_t v = 0; v < p->nv; v++) {
        const double s = v3_dot(up, p->v[v]) - level;
        if (w->kept) w->s[v] = s;
        if (s < low) {
            low = s;
            l = v;
        }
        if (s > high) {
            high = s;
            h = v;
        }
    }
    if (low >= 0.0) return -1;
    if (high <= 0.0) return 1;
    *apex = v3_lerp(p->v[l], p->v[h], low / (low - high));
    return 0;
}

static void submerge_solid(const fl_hull *h, fl_vec3 up, double level, fl_submerged *wet)
{
    struct offset_prism scratch;
    const fl_poly *p = floating_shape(h, &scratch);
    fl_vec3 apex, sum = {0};
    double v3fold = 0.0, wetted = 0.0, plane = 0.0;
    struct plane_heights water;
    const int state = find_apex(p, up, level, &water, &apex);
    if (state) {
        *wet = state < 0
                   ? (fl_submerged){0}
                   : (fl_submerged){.volume = h->volume, .centre = h->centre, .wetted_area = h->surface_area};
        return;
    }
    for (int32_t f = 0; f < p->nf; f++) {
        int32_t below = 0;
        const int32_t m = p->first[f + 1] - p->first[f];
        double area;
        fl_vec3 moment;
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++)
            below += height_over(p, p->loop[k], &water) <= 0.0;
        if (below == 0) continue;
        if (below == m && h->face_area) {
            area = h->face_area[f];
            moment = v3_scale(area, v3_sub(fl_hull_face_centroids(h)[f], apex));
        } else {
            const struct wet_face part =
                below == m ? whole_face_of(p, f, apex) : clip_face(p, f, &water, apex);
            area = part.area;
            moment = part.moment;
        }
        const double height = p->c[f] - v3_dot(p->n[f], apex);
        v3fold += area * height;
        sum = v3_madd(sum, height, moment);
        wetted += area;
        plane -= area * v3_dot(p->n[f], up);
    }
    wet->volume = v3fold / 3.0;
    wet->centre = v3fold > 0.0 ? v3_madd(apex, 0.75 / v3fold, sum) : apex;
    wet->wetted_area = wetted;
    wet->waterplane_area = plane > 0.0 ? plane : 0.0;
}

/* Spherical cap of height t = level + r above the lowest point:
 *     V = pi t^2 (3r - t) / 3,  its centroid 3 (2r - t)^2 / (4 (3r - t)) below the centre. */
static void submerge_sphere(const fl_hull *h, fl_vec3 up, double water, fl_submerged *wet)
{
    const fl_vec3 o = h->shape->v[0];
    const double r = h->radius, level = water - v3_dot(up, o), t = level + r;
    *wet = (fl_submerged){0};
    if (t <= 0.0) return;
    if (t >= 2.0 * r) {
        *wet = (fl_submerged){.volume = h->volume, .centre = h->centre, .wetted_area = h->surface_area};
        return;
    }
    wet->volume = h->fill * (PI * t * t * (3.0 * r - t) / 3.0);
    wet->centre = v3_madd(o, -0.75 * (2.0 * r - t) * (2.0 * r - t) / (3.0 * r - t), up);
    wet->wetted_area = h->fill * (2.0 * PI * r * t);
    wet->waterplane_area = h->fill * (PI * t * (2.0 * r - t));
}

/* Sums over the parts of a capsule: first moments about its middle, along the axis and along w, the direction
 * normal to the axis that points out of the water. plane is the area of the water plane, minus the sum of A
 * (n.up) over the wetted surface. */
struct capsule_sums {
    double volume, along, across, wetted, plane;
};

/* The capsule |s| <= half + r on its axis, directed so that sine >= 0. */
struct capsule {
    double r, half, level; /* level: height of the water above the middle */
    double sine, cosine;   /* up = sine axis + cosine w, cosine > 0 */
};

static double clamp(double x, double lo, double hi) { return fmin(fmax(x, lo), hi); }

/* theta/2 - sin cos/2 - sin^3 cos/3: rho^2 A - int |x|^2 dA of a circular segment of radius rho and half
 * angle theta, in units of rho^4. */
static double segment4(double theta, double s, double c)
{
    return 0.5 * (theta - s * c) - s * s * s * c / 3.0;
}

/* The half ball beyond an end of the axis, side = +1 or -1: |x| <= r, p.x >= 0 with p = side axis, up.x <= d.
 * Its surface is a patch A0 of the sphere, a segment A1 of the water plane (circle of radius rho, half angle
 * t1) and a segment A2 of the end of the cylinder (radius r, half angle t2). With S = segment4(), sp = up.p,
 *     V        = (r A0 + d A1) / 3                                            (divergence theorem)
 *     int x dV = 1/2 int |x|^2 n dA = 1/2 (p r^4 S(t2) - up rho^4 S(t1))     (the same)
 *     A0       = r^2 (2 atan2(q, sp r) + 2 (d/r) t1)                          (Gauss and Bonnet)
 * where q is half the common chord of A1 and A2, times the cosine. All three angles are atan2 of q. Where the
 * circles do not meet q = 0, and the angles come out as 0 or pi, correctly. */
static void add_cap(struct capsule_sums *t, const struct capsule *c, int side)
{
    const double r = c->r, g = c->cosine, sp = side * c->sine, at = c->level - sp * c->half;
    const double d = clamp(at, -r, r), qq = (g * r - d) * (g * r + d), q = qq > 0.0 ? sqrt(qq) : 0.0;
    const double rho2 = (r - d) * (r + d), t1 = fl_atan2(q, -d * sp), t2 = fl_atan2(q, -d);
    const double rho = sqrt(rho2), s1 = rho > 0.0 ? q / (g * rho) : 0.0,
                 c1 = rho > 0.0 ? -d * sp / (g * rho) : 0.0;
    const double s2 = q / (g * r),
                 c2 = -d / (g * r); /* sine and cosine hold for q > 0 only; else they multiply 0 */
    const double a0 = r * r * (2.0 * fl_atan2(q, sp * r) + 2.0 * (d / r) * t1);
    const double a1 = rho2 * (q > 0.0 ? t1 - s1 * c1 : t1), a2 = r * r * (q > 0.0 ? t2 - s2 * c2 : t2);
    const double m1 = -0.5 * rho2 * rho2 * (q > 0.0 ? segment4(t1, s1, c1) : 0.5 * t1);
    const double m2 = 0.5 * r * r * r * r * (q > 0.0 ? segment4(t2, s2, c2) : 0.5 * t2);
    const double v = (r * a0 + d * a1) / 3.0;
    t->volume += v;
    t->along += side * (c->half * v + m1 * sp + m2);
    t->across += m1 * g;
    t->wetted += a0;
    t->plane += a1 - sp * a2;
}

/* Positive halves of the nodes of the 16-point Gauss-Legendre rule on [-1, 1], and their weights. */
static const double GAUSS[8][2] = {
    {0.98940093499164994, 0.027152459411754096}, {0.9445750230732326, 0.062253523938647894},
    {0.86563120238783176, 0.095158511682492786}, {0.755404408355003, 0.12462897125553388},
    {0.61787624440264377, 0.14959598881657674},  {0.45801677765722737, 0.16915651939500254},
    {0.28160355077925892, 0.18260341504492358},  {0.095012509837637441, 0.1894506104550685}};

/* Half angle of the wet segment of the disc at station s. */
static double wet_angle(const struct capsule *c, double s)
{
    const double x = (c->level - c->sine * s) / (c->cosine * c->r), u = x > 1.0 ? 1.0 : x < -1.0 ? -1.0 : x;
    return fl_atan2(sqrt((1.0 - u) * (1.0 + u)), -u);
}

/* Up to here x / sin x, 1 + x^2/6, is 1 to rounding [rad]. */
#define SMALL_ANGLE 1e-8
/* Stations beyond come of a division by a sine near 0: the axis is level. */
#define FAR_STATION 1e300
/* Least cosine of the axis: its square is still a normal number. */
#define MIN_COSINE 1e-140

static double sine_of(double x)
{
    double c, s;
    fl_cos_sin(x, &c, &s);
    return s;
}

/* The cylinder: whole discs up to station a, segments up to b, nothing beyond. The half angle theta of a
 * segment has cos theta linear in s. Over theta instead of s all integrands are entire functions: sixteen
 * nodes leave 1e-16 even for a range of pi. Differences of cosines, written as products of sines, stay
 * accurate when the axis lies along the water and all angles are nearly equal. */
static void add_cylinder(struct capsule_sums *t, const struct capsule *c)
{
    const double r = c->r, h = c->half, in = (c->level - c->cosine * r) / c->sine,
                 out = (c->level + c->cosine * r) / c->sine;
    const int level_axis = !(c->sine > 0.0) || !(fabs(in) < FAR_STATION);
    const double x = c->level / (c->cosine * r); /* of all discs, when the axis is level */
    const double a = level_axis ? (x >= 1.0 ? h : -h) : in > h ? h : in < -h ? -h : in;
    const double b = level_axis ? (x <= -1.0 ? -h : h) : out > h ? h : out < -h ? -h : out;
    const double disc = PI * r * r * (a + h);
    t->volume += disc;
    t->along += disc * 0.5 * (a - h);
    t->wetted += 2.0 * PI * r * (a + h);
    if (!(b > a)) return;
    const double ta = wet_angle(c, a), tb = wet_angle(c, b), mid = 0.5 * (ta + tb), part = 0.5 * (ta - tb);
    if (!(mid > 0.0)) return;
    const double sine_part = sine_of(part), sine_mid = sine_of(mid);
    for (int g = 0; g < 16; g++) {
        const double y = g < 8 ? -GAUSS[g][0] : GAUSS[g - 8][0], weight = GAUSS[g % 8][1];
        const double theta = mid + y * part, rest = 0.5 * (1.0 - y) * part; /* rest = (ta - theta) / 2 */
        double sine, cosine;
        fl_cos_sin(theta, &cosine, &sine);
        const double narrow = part > SMALL_ANGLE ? part / sine_part : 1.0;
        const double done = (part > SMALL_ANGLE ? sine_of(rest) / sine_part : 0.5 * (1.0 - y)) *
                            sine_of(0.5 * (ta + theta)) / sine_mid;
        const double s = a + (b - a) * done, ds = 0.5 * (b - a) * weight * narrow * sine / sine_mid;
        const double area = r * r * (theta - sine * cosine);
        t->volume += ds * area;
        t->along += ds * area * s;
        t->across -= ds * (2.0 / 3.0) * r * r * r * sine * sine * sine;
        t->wetted += ds * 2.0 * r * theta;
        t->plane += ds * 2.0 * c->cosine * r * sine;
    }
}

static void submerge_capsule(const fl_hull *h, fl_vec3 up, double water, fl_submerged *wet)
{
    const fl_vec3 ends = v3_sub(h->shape->v[1], h->shape->v[0]),
                  mid = v3_lerp(h->shape->v[0], h->shape->v[1], 0.5);
    const double len = v3_norm(ends), r = h->radius, half = 0.5 * len;
    const fl_vec3 axis = v3_scale((v3_dot(up, ends) < 0.0 ? -1.0 : 1.0) / len, ends);
    const fl_vec3 cross = v3_madd(up, -v3_dot(up, axis), axis);
    /* Without a least cosine one station would divide 0 by 0; MIN_COSINE gives the limit. */
    const struct capsule c = {.r = r,
                              .half = half,
                              .level = water - v3_dot(up, mid),
                              .sine = v3_dot(up, axis),
                              .cosine = fmax(v3_norm(cross), MIN_COSINE)};
    const double reach = half * c.sine + r;
    struct capsule_sums t = {0};

    *wet = (fl_submerged){0};
    if (c.level <= -reach) return;
    if (c.level >= reach) {
        *wet = (fl_submerged){.volume = h->volume, .centre = h->centre, .wetted_area = h->surface_area};
        return;
    }
    add_cap(&t, &c, -1);
    add_cap(&t, &c, 1);
    add_cylinder(&t, &c);
    /* The last rounding of a body just dipping in must neither remain nor displace its centroid. */
    if (!(t.volume > 0.0)) return;
    wet->volume = t.volume;
    wet->centre = v3_madd(v3_madd(mid, clamp(t.along / t.volume, -half - r, half + r), axis),
                          clamp(t.across / t.volume, -r, 0.0) / c.cosine, cross);
    wet->wetted_area = fmax(t.wetted, 0.0);
    wet->waterplane_area = fmax(t.plane, 0.0);
}

void fl_hull_submerged(const fl_hull *h, fl_vec3 up, double level, fl_submerged *wet)
{
    if (h->shape->nv == 1) submerge_sphere(h, up, level, wet);
    else if (h->shape->nv == 2) submerge_capsule(h, up, level, wet);
    else if (!(h->prism.area > 0.0) || !fl_prism_submerged(&h->prism, up, level, wet))
        submerge_solid(h, up, level, wet);
}

void fl_hull_waterplane(const fl_hull *h, fl_vec3 up, double level, fl_waterplane *w)
{
    struct offset_prism scratch;
    const fl_poly *p = floating_shape(h, &scratch);
    double xx[3][3] = {{0}};
    fl_vec3 apex, sum = {0};
    struct plane_heights water;
    *w = (fl_waterplane){0};
    if (p->nf == 0 || find_apex(p, up, level, &water, &apex)) return;
    /* Each cut face gives one side of the water plane: the section runs from enter to leave. */
    for (int32_t f = 0; f < p->nf; f++) {
        const struct wet_face part = clip_face(p, f, &water, apex);
        if (!part.cut) continue;
        const fl_vec3 a = v3_sub(part.enter, apex), b = v3_sub(part.leave, apex), s = v3_add(a, b);
        const double tri = 0.5 * v3_dot(up, v3_cross(a, b));
        const double x[3][3] = {{a.x, a.y, a.z}, {b.x, b.y, b.z}, {s.x, s.y, s.z}};
        w->area += tri;
        sum = v3_madd(sum, tri / 3.0, s);
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) xx[i][j] += tri / 12.0 * x[k][i] * x[k][j];
    }
    if (!(w->area > 0.0)) return;
    const fl_vec3 g = v3_scale(1.0 / w->area, sum);
    const double d[3] = {g.x, g.y, g.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) w->second.m[i][j] = xx[i][j] - w->area * d[i] * d[j];
    w->centre = v3_add(apex, g);
}

double fl_buoyancy_force(const fl_submerged *wet, fl_vec3 up, double level, double weight, fl_vec3 *force,
                         fl_vec3 *moment)
{
    *force = v3_scale(weight * wet->volume, up);
    *moment = v3_cross(wet->centre, *force);
    return -weight * wet->volume * (v3_dot(up, wet->centre) - level);
}
