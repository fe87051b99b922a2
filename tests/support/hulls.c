/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/hulls.h"
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"

/* --- structures ----------------------------------------------------------------------------------- */

static void must(int rc)
{
    if (rc == 0) return;
    printf("hulls: no memory\n");
    exit(1);
}

static int32_t vertex(fl_part *p, double x, double y, double z)
{
    fl_err err = {0};
    must(fl_surface_vertex(p, v3(x, y, z), &err));
    return p->nv - 1;
}

static void triangle(fl_part *p, int32_t a, int32_t b, int32_t c)
{
    fl_err err = {0};
    must(fl_surface_triangle(p, a, b, c, &err));
}

/* a b c d counter-clockwise from outside, cut along either diagonal. */
static void quad(fl_part *p, fl_rng *g, int32_t a, int32_t b, int32_t c, int32_t d)
{
    if (fl_rng_unit(g) < 0.5) triangle(p, a, b, c), triangle(p, a, c, d);
    else triangle(p, a, b, d), triangle(p, b, c, d);
}

/* A strip between two rings of n vertices; outside is to the right of the way round seen from ring a to b. */
static void strip(fl_part *p, fl_rng *g, int n, int32_t a, int32_t b)
{
    for (int k = 0; k < n; k++) quad(p, g, a + k, a + (k + 1) % n, b + (k + 1) % n, b + k);
}

/* A fan over a ring from a point of its own, facing as the strip to the next ring would if it shrank. */
static void fan(fl_part *p, int n, int32_t ring, int last)
{
    fl_vec3 mid = v3(0, 0, 0);
    for (int k = 0; k < n; k++) mid = v3_madd(mid, 1.0 / n, p->v[ring + k]);
    const int32_t c = vertex(p, mid.x, mid.y, mid.z);
    for (int k = 0; k < n; k++)
        if (last) triangle(p, ring + k, ring + (k + 1) % n, c);
        else triangle(p, ring + (k + 1) % n, ring + k, c);
}

/* The ten points of a barge with a sharp raked bow; the sides of the bow are bent quadrilaterals. */
static void raked_bow(fl_part *p, fl_rng *g, double entrance, double rake, double flare, double beam)
{
    const double x[2][3] = {{-20, 8, 8 + entrance}, {-20 - flare, 8, 8 + entrance + rake}},
                 z[2] = {-4.5, 2.5};
    for (int k = 0; k < 2; k++) {
        const double b = beam + (k ? 0.3 * flare : 0.0);
        vertex(p, x[k][0], -b, z[k]), vertex(p, x[k][1], -b, z[k]), vertex(p, x[k][2], 0, z[k]);
        vertex(p, x[k][1], b, z[k]), vertex(p, x[k][0], b, z[k]);
    }
    triangle(p, 0, 4, 3), triangle(p, 0, 3, 2), triangle(p, 0, 2, 1);
    triangle(p, 5, 6, 7), triangle(p, 5, 7, 8), triangle(p, 5, 8, 9);
    /* one diagonal of the bow bends outward and the other inward: a bow has at least one of these */
    triangle(p, 1, 2, 7), triangle(p, 1, 7, 6);
    triangle(p, 2, 3, 8), triangle(p, 2, 8, 7);
    quad(p, g, 0, 1, 6, 5), quad(p, g, 3, 4, 9, 8), quad(p, g, 4, 0, 5, 9);
}

/* A ship: rings along x, each from the keel up one side, over the deck and down the other. */
static void ship(fl_part *p, fl_rng *g, double flare, double bulb, int open)
{
    enum { STATIONS = 9, SIDE = 5, RING = 2 * SIDE + 1 };
    for (int s = 0; s < STATIONS; s++) {
        const double u = (double)s / (STATIONS - 1), full = 1.0 - u * u * u;
        for (int k = 0; k < RING; k++) {
            const int port = k <= SIDE, level = port ? k : RING - k; /* 0 keel, SIDE deck */
            const double h = (double)level / SIDE, z = -5.0 + 7.5 * h,
                         wide = 4.0 * full * (0.25 + 0.75 * sqrt(h)) + flare * u * h * h * (1.0 - 0.8 * u) +
                                bulb * exp(-30.0 * (u - 0.9) * (u - 0.9)) * h * (1 - h) * (h < 0.5) + 0.03;
            vertex(p, -15.0 + 30.0 * u + 5.0 * flare * u * u * h + bulb * u * u * (h < 0.5) * h,
                   level == 0 ? 0.0
                   : port     ? wide
                              : -wide,
                   z);
        }
    }
    for (int s = 0; s + 1 < STATIONS; s++)
        for (int k = 0; k < RING; k++) {
            const int32_t a = s * RING + k, b = s * RING + (k + 1) % RING;
            if (open && k == SIDE) continue;
            quad(p, g, a, b, b + RING, a + RING);
        }
    if (open) return;
    fan(p, RING, 0, 0);
    fan(p, RING, (STATIONS - 1) * RING, 1);
}

/* An upright prism over a simple polygon with a hole of as many corners. */
static void ring_prism(fl_part *p, fl_rng *g, int n, const fl_vec3 *outer, const fl_vec3 *inner, double low,
                       double high)
{
    const int32_t from = p->nv;
    for (int top = 0; top < 2; top++)
        for (int in = 0; in < 2; in++)
            for (int k = 0; k < n; k++) {
                const fl_vec3 v = in ? inner[k] : outer[k];
                vertex(p, v.x, v.y, top ? high : low);
            }
    const int32_t lo = from, li = from + n, ho = from + 2 * n, hi = from + 3 * n;
    for (int k = 0; k < n; k++) {
        const int m = (k + 1) % n;
        quad(p, g, lo + k, lo + m, ho + m, ho + k);
        quad(p, g, li + m, li + k, hi + k, hi + m);
        quad(p, g, ho + k, ho + m, hi + m, hi + k);
        quad(p, g, lo + m, lo + k, li + k, li + m);
    }
}

static void moonpool(fl_part *p, fl_rng *g, double skew, double pool)
{
    const fl_vec3 outer[4] = {{-12, -5, 0}, {12, -5 + skew, 0}, {12 + skew, 5, 0}, {-12, 5, 0}},
                  inner[4] = {{-pool, -pool, 0}, {pool, -pool, 0}, {pool, pool, 0}, {-pool, pool, 0}};
    ring_prism(p, g, 4, outer, inner, -3, 2);
}

/* An open channel, an angle or a zigzag of thin plate: a simple polygon of 2 n corners from two lines. */
static void folded_plate(fl_part *p, fl_rng *g, int n, const fl_vec3 *line, double thick, double lean)
{
    const double low = -3, high = 2;
    const int32_t from = p->nv;
    for (int top = 0; top < 2; top++) /* per level: n of one side, then n of the other */
        for (int side = 0; side < 2; side++)
            for (int k = 0; k < n; k++) {
                const fl_vec3 a = v3_unit(v3_sub(line[k > 0 ? k : 1], line[k > 0 ? k - 1 : 0])),
                              b = v3_unit(v3_sub(line[k + 1 < n ? k + 1 : k], line[k + 1 < n ? k : k - 1])),
                              along = v3_unit(v3_add(a, b)), off = v3(-along.y, along.x, 0);
                const double half = (side ? 0.5 : -0.5) * thick / v3_dot(a, along);
                vertex(p, line[k].x + half * off.x + (top ? lean : 0), line[k].y + half * off.y,
                       top ? high : low);
            }
    const int32_t l0 = from, l1 = from + n, h0 = from + 2 * n, h1 = from + 3 * n;
    for (int k = 0; k + 1 < n; k++) {
        quad(p, g, l0 + k, l0 + k + 1, h0 + k + 1, h0 + k);
        quad(p, g, l1 + k + 1, l1 + k, h1 + k, h1 + k + 1);
        quad(p, g, h0 + k, h0 + k + 1, h1 + k + 1, h1 + k);
        quad(p, g, l0 + k + 1, l0 + k, l1 + k, l1 + k + 1);
    }
    quad(p, g, l1, l0, h0, h1);
    quad(p, g, l0 + n - 1, l1 + n - 1, h1 + n - 1, h0 + n - 1);
}

/* A tube of n sides from a to b. */
static void tube(fl_part *p, fl_rng *g, fl_vec3 a, fl_vec3 b, double r, int n)
{
    const fl_vec3 z = v3_unit(v3_sub(b, a)), x = v3_normal_to(z), y = v3_cross(z, x);
    const int32_t from = p->nv;
    for (int end = 0; end < 2; end++)
        for (int k = 0; k < n; k++) {
            const double t = 2 * PI * k / n;
            const fl_vec3 q = v3_add(end ? b : a, v3_add(v3_scale(r * cos(t), x), v3_scale(r * sin(t), y)));
            vertex(p, q.x, q.y, q.z);
        }
    strip(p, g, n, from, from + n);
    fan(p, n, from, 0);
    fan(p, n, from + n, 1);
}

/* Four leaning legs and braces that end short of them. */
static void jacket(fl_part *p, fl_rng *g, double r, int n, double gap)
{
    fl_vec3 foot[4], head[4];
    for (int k = 0; k < 4; k++) {
        const double t = PI / 4 + PI / 2 * k;
        foot[k] = v3(9 * cos(t), 9 * sin(t), -8);
        head[k] = v3(6 * cos(t), 6 * sin(t), 5);
        tube(p, g, foot[k], head[k], r, n);
    }
    for (int k = 0; k < 4; k++)
        for (int way = 0; way < 2; way++) {
            const int m = (k + 1) % 4;
            const fl_vec3 a = v3_madd(foot[k], way ? 0.15 : 0.9, v3_sub(head[k], foot[k])),
                          b = v3_madd(foot[m], way ? 0.35 : 0.75, v3_sub(head[m], foot[m]));
            const fl_vec3 u = v3_unit(v3_sub(b, a));
            tube(p, g, v3_madd(a, 1.3 * r + gap, u), v3_madd(b, -1.3 * r - gap, u), 0.5 * r, n);
        }
}

/* A ball with bumps, its normals outward or inward. */
static void bumpy_ball(fl_part *p, fl_rng *g, double radius, double rough, int inward)
{
    enum { ROUND = 12, LEVELS = 7 };
    const int32_t from = p->nv, t0 = p->nt;
    const double turn = fl_rng_unit(g);
    for (int l = 0; l < LEVELS; l++)
        for (int k = 0; k < ROUND; k++) {
            const double t = 2 * PI * (k + turn) / ROUND, h = PI * (l + 1) / (LEVELS + 1),
                         r = radius * (1.0 + rough * fl_rng_in(g, -1, 1));
            vertex(p, r * sin(h) * cos(t), r * sin(h) * sin(t), -r * cos(h));
        }
    for (int l = 0; l + 1 < LEVELS; l++) strip(p, g, ROUND, from + l * ROUND, from + (l + 1) * ROUND);
    fan(p, ROUND, from, 0);
    fan(p, ROUND, from + (LEVELS - 1) * ROUND, 1);
    for (int32_t t = t0; inward && t < p->nt; t++) {
        const int32_t a = p->t[t].v[0];
        p->t[t].v[0] = p->t[t].v[1], p->t[t].v[1] = a;
    }
}

/* Half a pipe, or a dented sheet, without thickness. */
static void open_sheet(fl_part *p, fl_rng *g, double bend, double rough)
{
    enum { N = 9 };
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            const double u = 2.0 * i / (N - 1) - 1.0, v = 2.0 * j / (N - 1) - 1.0,
                         r = 1.0 + rough * fl_rng_in(g, -1, 1);
            if (bend > 0.0) vertex(p, 6 * r * sin(bend * u), 6 * v, 6 * r * cos(bend * u));
            else vertex(p, 6 * u, 6 * v, 6 * (r - 1.0));
        }
    for (int j = 0; j + 1 < N; j++)
        for (int i = 0; i + 1 < N; i++)
            quad(p, g, j * N + i, j * N + i + 1, (j + 1) * N + i + 1, (j + 1) * N + i);
}

static const fl_vec3 ANGLE[3] = {{-6, 0, 0}, {0, 0, 0}, {4, 7, 0}},
                     CHANNEL[4] = {{-5, 6, 0}, {-5, -2, 0}, {5, -2, 0}, {5, 6, 0}},
                     ZIGZAG[7] = {{-9, 0, 0}, {-6, 2, 0}, {-3, -1, 0}, {0, 2, 0},
                                  {3, -1, 0}, {6, 2, 0},  {9, 0, 0}};

const char *hull_name(int k)
{
    static const char *const NAME[] = {"raked bow", "ship",       "barge with a moonpool", "folded plate",
                                       "jacket",    "bumpy ball", "hollow ball",           "tank",
                                       "open ship", "open sheet"};
    static const int FIRST[] = {0, 8, 13, 16, 22, 25, 30, 31, 32, 33};
    int m = 9;
    while (k < FIRST[m]) m--;
    return NAME[m];
}

int hull_make(fl_surface *s, int k)
{
    fl_err err = {0};
    fl_rng rng = fl_rng_of(77, k, FL_RNG_TEST), *g = &rng;
    must(fl_surface_add(s, "hull", 4, &err) < 0);
    fl_part *p = &s->part[s->n - 1];
    if (k == 0) raked_bow(p, g, 9, 6, 0, 6);
    else if (k < 8) raked_bow(p, g, fl_rng_in(g, 5, 15), fl_rng_in(g, -4, 10), k % 3, fl_rng_in(g, 3, 9));
    else if (k < 13) ship(p, g, fl_rng_in(g, 0, 3), k % 2 ? fl_rng_in(g, 1, 4) : 0.0, 0);
    else if (k < 16) moonpool(p, g, k - 13, 4.0 - (k - 13));
    else if (k < 18) folded_plate(p, g, 3, ANGLE, k == 16 ? 0.4 : 0.02, 1.0);
    else if (k < 20) folded_plate(p, g, 4, CHANNEL, k == 18 ? 0.3 : 0.01, -1.0);
    else if (k < 22) folded_plate(p, g, 7, ZIGZAG, k == 20 ? 0.6 : 0.05, 2.0);
    else if (k < 25) jacket(p, g, 0.6, k == 24 ? 6 : 12, k == 22 ? 0.3 : 0.02);
    else if (k < 30) bumpy_ball(p, g, 6, 0.05 * (k - 24), 0);
    else if (k == 30) bumpy_ball(p, g, 8, 0.1, 0), bumpy_ball(p, g, 4, 0.2, 1);
    else if (k == 31) bumpy_ball(p, g, 8, 0.15, 1);
    else if (k == 32) ship(p, g, 2, 2, 1);
    else open_sheet(p, g, k == 33 ? 1.5 : k == 34 ? 0.6 : 0.0, k == 33 ? 0.0 : 0.1);
    return k < 32;
}

/* --- brute force ---------------------------------------------------------------------------------- */

double hull_winding(const fl_part *p, fl_vec3 x)
{
    double angle = 0.0, volume = 0.0;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        const fl_vec3 a = v3_sub(p->v[v[0]], x), b = v3_sub(p->v[v[1]], x), c = v3_sub(p->v[v[2]], x);
        const double A = v3_norm(a), B = v3_norm(b), C = v3_norm(c), six = v3_dot(a, v3_cross(b, c));
        volume += six;
        angle += atan2(six, A * B * C + v3_dot(a, b) * C + v3_dot(b, c) * A + v3_dot(c, a) * B);
    }
    return angle / (2.0 * PI) + (volume < 0.0);
}

static double point_to_segment(fl_vec3 x, fl_vec3 a, fl_vec3 b)
{
    const fl_vec3 u = v3_sub(b, a), r = v3_sub(x, a);
    const double t = fmin(1.0, fmax(0.0, v3_dot(r, u) / v3_norm2(u)));
    return v3_norm(v3_madd(r, -t, u));
}

static double point_to_triangle(fl_vec3 x, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    const fl_vec3 n = v3_unit(v3_cross(v3_sub(b, a), v3_sub(c, a)));
    const double in_a = v3_dot(n, v3_cross(v3_sub(b, a), v3_sub(x, a))),
                 in_b = v3_dot(n, v3_cross(v3_sub(c, b), v3_sub(x, b))),
                 in_c = v3_dot(n, v3_cross(v3_sub(a, c), v3_sub(x, c)));
    if (in_a >= 0.0 && in_b >= 0.0 && in_c >= 0.0) return fabs(v3_dot(n, v3_sub(x, a)));
    return fmin(point_to_segment(x, a, b), fmin(point_to_segment(x, b, c), point_to_segment(x, c, a)));
}

double hull_point_distance(const fl_part *p, fl_vec3 x)
{
    double d = INFINITY;
    for (int32_t t = 0; t < p->nt; t++)
        d = fmin(d, point_to_triangle(x, p->v[p->t[t].v[0]], p->v[p->t[t].v[1]], p->v[p->t[t].v[2]]));
    return d;
}

static double segment_to_segment(fl_vec3 a, fl_vec3 b, fl_vec3 c, fl_vec3 d)
{
    const fl_vec3 u = v3_sub(b, a), v = v3_sub(d, c), r = v3_sub(a, c), n = v3_cross(u, v);
    const double n2 = v3_norm2(n);
    if (n2 > 1e-24 * v3_norm2(u) * v3_norm2(v)) {
        const double s = -v3_dot(v3_cross(r, v), n) / n2, t = -v3_dot(v3_cross(r, u), n) / n2;
        if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)
            return v3_norm(v3_sub(v3_madd(a, s, u), v3_madd(c, t, v)));
    }
    return fmin(fmin(point_to_segment(a, c, d), point_to_segment(b, c, d)),
                fmin(point_to_segment(c, a, b), point_to_segment(d, a, b)));
}

/* True if the segment a b passes through the triangle. */
static int pierces(fl_vec3 a, fl_vec3 b, fl_vec3 p, fl_vec3 q, fl_vec3 r)
{
    const fl_vec3 n = v3_cross(v3_sub(q, p), v3_sub(r, p));
    const double ha = v3_dot(n, v3_sub(a, p)), hb = v3_dot(n, v3_sub(b, p));
    if ((ha > 0.0) == (hb > 0.0)) return 0;
    const fl_vec3 x = v3_madd(a, ha / (ha - hb), v3_sub(b, a));
    return v3_dot(n, v3_cross(v3_sub(q, p), v3_sub(x, p))) >= 0.0 &&
           v3_dot(n, v3_cross(v3_sub(r, q), v3_sub(x, q))) >= 0.0 &&
           v3_dot(n, v3_cross(v3_sub(p, r), v3_sub(x, r))) >= 0.0;
}

double hull_distance(const fl_part *p, const fl_poly *core)
{
    double d = INFINITY;
    for (int32_t t = 0; t < p->nt && d > 0.0; t++) {
        const fl_vec3 T[3] = {p->v[p->t[t].v[0]], p->v[p->t[t].v[1]], p->v[p->t[t].v[2]]};
        for (int32_t v = 0; v < core->nv; v++) d = fmin(d, point_to_triangle(core->v[v], T[0], T[1], T[2]));
        for (int32_t e = 0; e < core->ne; e++) {
            const fl_vec3 a = core->v[core->edge[e].a], b = core->v[core->edge[e].b];
            if (pierces(a, b, T[0], T[1], T[2])) return 0.0;
            for (int k = 0; k < 3; k++) d = fmin(d, segment_to_segment(a, b, T[k], T[(k + 1) % 3]));
        }
        for (int32_t f = 0; f < core->nf; f++) {
            const int32_t *loop = core->loop + core->first[f], n = core->first[f + 1] - core->first[f];
            for (int32_t m = 1; m + 1 < n; m++) {
                const fl_vec3 a = core->v[loop[0]], b = core->v[loop[m]], c = core->v[loop[m + 1]];
                for (int k = 0; k < 3; k++) {
                    if (pierces(T[k], T[(k + 1) % 3], a, b, c)) return 0.0;
                    d = fmin(d, point_to_triangle(T[k], a, b, c));
                }
            }
        }
        double deepest = -INFINITY;
        for (int32_t f = 0; f < core->nf; f++) deepest = fmax(deepest, v3_dot(core->n[f], T[0]) - core->c[f]);
        if (deepest <= 0.0) return 0.0;
    }
    return d;
}
