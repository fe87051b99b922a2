/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/mem.h"
#include "geom/dilate.h"
#include "water/buoyancy.h"

static const double PI = 3.141592653589793;

int fl_hull_make(fl_hull *h, const fl_poly *p, double radius, fl_err *err)
{
    const int round = p->nv <= 2;
    fl_hull out = {.p = p, .radius = round ? radius : 0.0};
    fl_mass m;
    if (fl_mass_of(&m, p, out.radius, err)) return -1;
    out.volume = m.volume;
    out.centre = m.centre;
    out.surface = fl_dilate_area(p, out.radius);
    if (!round) {
        out.middle = fl_alloc(p->nf, sizeof *out.middle, err);
        out.area = fl_alloc(p->nf, sizeof *out.area, err);
        if (!out.middle || !out.area) {
            fl_hull_free(&out);
            return -1;
        }
    }
    for (int32_t f = 0; !round && f < p->nf; f++) {
        const fl_vec3 a = p->v[p->loop[p->first[f]]];
        fl_vec3 b = v3_sub(p->v[p->loop[p->first[f] + 1]], a), g = {0};
        for (int32_t k = p->first[f] + 2; k < p->first[f + 1]; k++) {
            const fl_vec3 c = v3_sub(p->v[p->loop[k]], a);
            const double tri = 0.5 * v3_dot(p->n[f], v3_cross(b, c));
            out.area[f] += tri;
            g = v3_madd(g, tri / 3.0, v3_add(b, c));
            b = c;
        }
        out.middle[f] = v3_madd(a, 1.0 / out.area[f], g);
    }
    *h = out;
    return 0;
}

void fl_hull_free(fl_hull *h)
{
    free(h->middle);
    free(h->area);
    *h = (fl_hull){0};
}

/* The wetted part of a face: area, int (x - apex) dA, and the two points where the water leaves and enters
 * the loop. */
struct part {
    double area;
    fl_vec3 moment, leave, enter;
    int cut;
};

/* Walk round face f and keep what is wet, as a fan over its first wet corner: no list of corners is needed.
 * A crossing is always computed from its wet end, so that the two faces of an edge find the same point. */
static struct part clip_face(const fl_poly *p, int32_t f, fl_vec3 up, double level, fl_vec3 apex)
{
    const int32_t *at = p->loop + p->first[f], m = p->first[f + 1] - p->first[f];
    struct part out = {0};
    fl_vec3 hub = {0}, rim = {0}, from = p->v[at[m - 1]];
    double s0 = v3_dot(up, from) - level;
    int have = 0;
    for (int32_t k = 0; k < m; k++) {
        const fl_vec3 to = p->v[at[k]];
        const double s1 = v3_dot(up, to) - level;
        const int wet0 = s0 <= 0.0, wet1 = s1 <= 0.0;
        fl_vec3 corner[2];
        int n = 0;
        if (wet0 && !wet1) {
            out.leave = corner[n++] = v3_lerp(from, to, s0 / (s0 - s1));
            out.cut = 1;
        } else if (!wet0 && wet1) {
            out.enter = corner[n++] = v3_lerp(to, from, s1 / (s1 - s0));
        }
        if (wet1) corner[n++] = to;
        for (int i = 0; i < n; i++) {
            const fl_vec3 x = v3_sub(corner[i], apex);
            if (have >= 2) {
                const double tri = 0.5 * v3_dot(p->n[f], v3_cross(v3_sub(rim, hub), v3_sub(x, hub)));
                out.area += tri;
                out.moment = v3_madd(out.moment, tri / 3.0, v3_add(v3_add(hub, rim), x));
            }
            if (have == 0) hub = x;
            rim = x;
            have++;
        }
        from = to;
        s0 = s1;
    }
    return out;
}

/* -1 dry, +1 wet, 0 cut: then the apex is where the line from the deepest to the highest vertex meets the
 * water, a point inside. */
static int find_apex(const fl_poly *p, fl_vec3 up, double level, fl_vec3 *apex)
{
    double low = INFINITY, high = -INFINITY;
    int32_t l = 0, h = 0;
    for (int32_t v = 0; v < p->nv; v++) {
        const double s = v3_dot(up, p->v[v]) - level;
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

static void solid(const fl_hull *h, fl_vec3 up, double level, fl_wet *wet)
{
    const fl_poly *p = h->p;
    fl_vec3 apex, sum = {0};
    double v3fold = 0.0, wetted = 0.0, plane = 0.0;
    const int state = find_apex(p, up, level, &apex);
    if (state) {
        *wet = state < 0 ? (fl_wet){0}
                         : (fl_wet){.volume = h->volume, .centre = h->centre, .wetted = h->surface};
        return;
    }
    for (int32_t f = 0; f < p->nf; f++) {
        int32_t below = 0;
        const int32_t m = p->first[f + 1] - p->first[f];
        double area = h->area[f];
        fl_vec3 moment;
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++)
            below += v3_dot(up, p->v[p->loop[k]]) - level <= 0.0;
        if (below == 0) continue;
        if (below == m) {
            moment = v3_scale(area, v3_sub(h->middle[f], apex));
        } else {
            const struct part w = clip_face(p, f, up, level, apex);
            area = w.area;
            moment = w.moment;
        }
        const double height = p->c[f] - v3_dot(p->n[f], apex);
        v3fold += area * height;
        sum = v3_madd(sum, height, moment);
        wetted += area;
        plane -= area * v3_dot(p->n[f], up);
    }
    wet->volume = v3fold / 3.0;
    wet->centre = v3fold > 0.0 ? v3_madd(apex, 0.75 / v3fold, sum) : apex;
    wet->wetted = wetted;
    wet->waterplane = plane > 0.0 ? plane : 0.0;
}

/* Spherical cap of height t = level + r over the lowest point:
 *     V = pi t^2 (3r - t) / 3,  its centroid 3 (2r - t)^2 / (4 (3r - t)) below the centre. */
static void sphere(const fl_hull *h, fl_vec3 up, double over, fl_wet *wet)
{
    const fl_vec3 o = h->p->v[0];
    const double r = h->radius, level = over - v3_dot(up, o), t = level + r;
    *wet = (fl_wet){0};
    if (t <= 0.0) return;
    if (t >= 2.0 * r) {
        *wet = (fl_wet){.volume = h->volume, .centre = h->centre, .wetted = h->surface};
        return;
    }
    wet->volume = PI * t * t * (3.0 * r - t) / 3.0;
    wet->centre = v3_madd(o, -0.75 * (2.0 * r - t) * (2.0 * r - t) / (3.0 * r - t), up);
    wet->wetted = 2.0 * PI * r * t;
    wet->waterplane = PI * t * (2.0 * r - t);
}

/* What the stations of a capsule add up to, along the axis s and along w, the wet direction across it. */
struct slices {
    double volume, along, across, wetted, plane;
};

/* Capsule |s| <= half + r on an axis; off is how far a station lies out in a cap. */
struct capsule {
    double r, half, level; /* level: height of the water over the middle */
    double sine, cosine;   /* up = sine axis + cosine w */
};

/* Positive halves of the nodes of the 20-point Gauss-Legendre rule on [-1, 1], and their weights. */
static const double GAUSS[10][2] = {
    {0.99312859918509488, 0.017614007139152118}, {0.96397192727791381, 0.040601429800386939},
    {0.91223442825132595, 0.062672048334109068}, {0.83911697182221878, 0.083276741576704755},
    {0.7463319064601508, 0.10193011981724044},   {0.63605368072651502, 0.11819453196151841},
    {0.51086700195082713, 0.13168863844917664},  {0.37370608871541955, 0.14209610931838204},
    {0.22778585114164507, 0.14917298647260374},  {0.076526521133497338, 0.15275338713072584}};

static double off_of(const struct capsule *c, double s)
{
    return s > c->half ? s - c->half : s < -c->half ? s + c->half : 0.0;
}

/* The station at s: a disc of radius R of which y <= k is wet, a circular segment of half angle psi. */
static void add_station(struct slices *t, const struct capsule *c, double s, double weight)
{
    const double off = off_of(c, s), rr = (c->r - off) * (c->r + off),
                 k = (c->level - c->sine * s) / c->cosine;
    const double cc = rr - k * k, chord = cc > 0.0 ? sqrt(cc) : 0.0; /* half the chord */
    const double psi = atan2(chord, -k), area = rr * psi + k * chord;
    t->volume += weight * area;
    t->along += weight * area * s;
    t->across -= weight * (2.0 / 3.0) * chord * chord * chord;
    t->wetted += weight * 2.0 * psi * c->r;
    t->plane += weight * 2.0 * (c->cosine * chord - c->sine * off * psi);
}

/* Whole discs from s = a to b, both on the cylinder or both in one cap: polynomials. */
static void add_discs(struct slices *t, const struct capsule *c, double a, double b)
{
    const double p = off_of(c, a), q = off_of(c, b), r2 = c->r * c->r,
                 base = a - p; /* s = base + off in a cap */
    const int cap = p < 0.0 || q > 0.0;
    const double v = PI * (r2 * (b - a) - (cap ? (q * q * q - p * p * p) / 3.0 : 0.0));
    t->volume += v;
    t->along += cap ? base * v + PI * (r2 * (q * q - p * p) / 2.0 - (q * q * q * q - p * p * p * p) / 4.0)
                    : v * 0.5 * (a + b);
    t->wetted += 2.0 * PI * c->r * (b - a);
    t->plane -= PI * c->sine * (q * q - p * p);
}

static void capsule(const fl_hull *h, fl_vec3 up, double over, fl_wet *wet)
{
    const fl_vec3 ends = v3_sub(h->p->v[1], h->p->v[0]), mid = v3_lerp(h->p->v[0], h->p->v[1], 0.5);
    const double len = v3_norm(ends), r = h->radius, half = 0.5 * len, end = half + r;
    const fl_vec3 axis = v3_scale(1.0 / len, ends), cross = v3_madd(up, -v3_dot(up, axis), axis);
    /* A cosine of zero would only divide 0 by 0 at one station: any tiny one gives the limit. */
    const struct capsule c = {.r = r,
                              .half = half,
                              .level = over - v3_dot(up, mid),
                              .sine = v3_dot(up, axis),
                              .cosine = fmax(v3_norm(cross), 1e-150)};
    const fl_vec3 w = v3_scale(1.0 / c.cosine, cross);
    const double reach = half * fabs(c.sine) + r;
    double at[10] = {-end, -half, half, end};
    struct slices t = {0};
    int n = 4;

    *wet = (fl_wet){0};
    if (c.level <= -reach) return;
    if (c.level >= reach) {
        *wet = (fl_wet){.volume = h->volume, .centre = h->centre, .wetted = h->surface};
        return;
    }
    /* Where the water meets the profile: on the two lines of the cylinder, and on the circles of the caps. */
    for (int k = -1; k <= 1; k += 2) {
        const double s = (c.level + k * c.cosine * r) / c.sine;
        const double d = c.level - c.sine * k * half, cc = (r - d) * (r + d);
        if (fabs(s) < half) at[n++] = s;
        for (int l = -1; l <= 1 && cc > 0.0; l += 2) {
            const double off = d * c.sine + l * sqrt(cc) * c.cosine;
            if (k * off > 0.0 && fabs(off) < r) at[n++] = k * half + off;
        }
    }
    for (int i = 1; i < n; i++)
        for (int j = i; j > 0 && at[j] < at[j - 1]; j--) {
            const double swap = at[j];
            at[j] = at[j - 1];
            at[j - 1] = swap;
        }
    for (int i = 0; i + 1 < n; i++) {
        const double a = at[i], b = at[i + 1], m = 0.5 * (a + b), off = off_of(&c, m);
        const double k = (c.level - c.sine * m) / c.cosine, rr = (r - off) * (r + off);
        if (!(b > a) || (k <= 0.0 && k * k >= rr)) continue;
        if (k > 0.0 && k * k >= rr) {
            add_discs(&t, &c, a, b);
            continue;
        }
        /* Areas grow from an end like (s - a)^(3/2): with s = m - (b - a)/2 cos phi they are smooth. */
        for (int g = 0; g < 20; g++) {
            const double *node = GAUSS[g % 10], phi = 0.5 * PI * (1.0 + (g < 10 ? -node[0] : node[0]));
            add_station(&t, &c, m - 0.5 * (b - a) * cos(phi), 0.25 * PI * (b - a) * sin(phi) * node[1]);
        }
    }
    wet->volume = t.volume;
    if (t.volume > 0.0) wet->centre = v3_madd(v3_madd(mid, t.along / t.volume, axis), t.across / t.volume, w);
    wet->wetted = t.wetted;
    wet->waterplane = t.plane > 0.0 ? t.plane : 0.0;
}

void fl_buoyancy(const fl_hull *h, fl_vec3 up, double level, fl_wet *wet)
{
    if (h->p->nv == 1) sphere(h, up, level, wet);
    else if (h->p->nv == 2) capsule(h, up, level, wet);
    else solid(h, up, level, wet);
}

void fl_buoyancy_plane(const fl_hull *h, fl_vec3 up, double level, fl_waterplane *w)
{
    const fl_poly *p = h->p;
    double xx[3][3] = {{0}};
    fl_vec3 apex, sum = {0};
    *w = (fl_waterplane){0};
    if (p->nf == 0 || find_apex(p, up, level, &apex)) return;
    /* Each cut face gives one side of the water plane, which the wet part's cap runs from enter to leave. */
    for (int32_t f = 0; f < p->nf; f++) {
        const struct part part = clip_face(p, f, up, level, apex);
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

double fl_buoyancy_force(const fl_wet *wet, fl_vec3 up, double level, double weight, fl_vec3 *force,
                         fl_vec3 *moment)
{
    *force = v3_scale(weight * wet->volume, up);
    *moment = v3_cross(wet->centre, *force);
    return -weight * wet->volume * (v3_dot(up, wet->centre) - level);
}
