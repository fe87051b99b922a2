/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "patch/quick_faces.h"
#include "base/array.h"
#include "geom/quadrature_rules.h"

/* Of the sizes of the cores: how far below the plane of the other face a point still counts as on it. */
#define ON_PLANE_TOL 1e-12

/* A corner of the polygon P in the plane of the other face: plane coordinates, overlap, and the side of the
 * other face that begins here, or one of: */
enum { OWN_SIDE = -1, CUT = -2 };
typedef struct {
    double x, y, s;
    int32_t side;
} corner;

/* A face of the own core over the plane of one of the other. */
typedef struct {
    const fl_quick_way *d;
    const fl_quick_face *f; /* of the other core */
    const fl_quick_side *side;
    fl_vec3 n;         /* normal of the own face, in the frame of other */
    double C, m, dm;   /* C = -n.n_f, m and dm/dC */
    double s0, sx, sy; /* s = s0 + sx x + sy y */
    corner *p, *spare;
    int32_t corners;
} face_pair;

/* Keeps the part of the polygon with g >= 0, given at its corners. */
static void clip_polygon(face_pair *q, const double *g, int32_t side)
{
    corner *const to = q->spare;
    int32_t m = 0;
    for (int32_t k = 0; k < q->corners; k++) {
        const int32_t next = k + 1 < q->corners ? k + 1 : 0;
        const corner a = q->p[k], b = q->p[next];
        const int in = g[k] >= 0.0, then = g[next] >= 0.0;
        if (in) to[m++] = a;
        if (in == then) continue;
        const double t = g[k] / (g[k] - g[next]);
        to[m++] =
            (corner){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.s + t * (b.s - a.s), in ? side : a.side};
    }
    q->spare = q->p, q->p = to, q->corners = m;
}

/* Clips to c - qx x - qy y >= 0.  Returns 0 when nothing is left. */
static int clip_side(face_pair *q, double c, double qx, double qy, int32_t side, double *g)
{
    int32_t out = 0;
    for (int32_t k = 0; k < q->corners; k++) {
        g[k] = c - qx * q->p[k].x - qy * q->p[k].y;
        out += g[k] < 0.0;
    }
    if (out == q->corners) return 0;
    if (out > 0) clip_polygon(q, g, side);
    return q->corners >= 3;
}

/* Point of the own face over (x, y). */
static fl_vec3 point_at(const face_pair *q, double x, double y, double s)
{
    const fl_quick_face *f = q->f;
    return v3_madd(v3_madd(v3_scale(f->height + q->d->reach - s, f->n), x, f->t1), y, f->t2);
}

static fl_wrench force_at(fl_vec3 f, fl_vec3 x) { return (fl_wrench){f, v3_cross(x, f)}; }

/* How near the own face comes, D = int z^4/int z^3 over the polygon with z = s + R > 0, and its gradient:
 * with z growing by -n_f.u and the border moving,
 *     dD int z^3 = -int (4 z^3 - 3 D z^2) n_f.u dP - sum over sides int (z^4 - D z^3) q.u dl.
 * D is at least 2R/3 where the faces touch. */
static double find_nearness(const face_pair *q, fl_wrench *rise)
{
    const double R = q->d->R;
    const corner *p = q->p;
    double area3 = 0.0, area4 = 0.0;
    double D = 0.0;
    *rise = (fl_wrench){.f = {0}};
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t k = 1; k + 1 < q->corners; k++) {
            const corner a = p[0], b = p[k], c = p[k + 1];
            const double T = 0.5 * ((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y));
            for (int i = 0; i < FL_TRIANGLE_NODES; i++) {
                const double *at = FL_TRIANGLE_NODE[i], w = T * FL_TRIANGLE_WEIGHT[i];
                const double x = at[0] * a.x + at[1] * b.x + at[2] * c.x,
                             y = at[0] * a.y + at[1] * b.y + at[2] * c.y,
                             s = at[0] * a.s + at[1] * b.s + at[2] * c.s, z = s + R, z2 = z * z;
                if (pass == 0) area3 += w * z2 * z, area4 += w * z2 * z2;
                else
                    *rise = fl_wrench_madd(*rise, -w * (4.0 * z - 3.0 * D) * z2,
                                           force_at(q->f->n, point_at(q, x, y, s)));
            }
        }
        if (pass > 0) break;
        if (!(area3 > 0.0)) return 0.0;
        D = area4 / area3;
    }
    for (int32_t k = 0; k < q->corners; k++) {
        const corner a = p[k], b = p[k + 1 < q->corners ? k + 1 : 0];
        const double l = sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        if (a.side < 0) continue;
        for (int i = 0; i < FL_LINE4_NODES; i++) {
            const double t = FL_LINE4_NODE[i], x = a.x + t * (b.x - a.x), y = a.y + t * (b.y - a.y),
                         s = a.s + t * (b.s - a.s), z = s + R;
            *rise = fl_wrench_madd(*rise, -l * FL_LINE4_WEIGHT[i] * (z - D) * z * z * z,
                                   force_at(q->side[a.side].q, point_at(q, x, y, s)));
        }
    }
    *rise = fl_wrench_madd((fl_wrench){.f = {0}}, 1.0 / area3, *rise);
    return D;
}

/* Area of the polygon on the own face, and its gradient: -int q.u dl over the sides of f, over C. */
static double find_area(const face_pair *q, fl_wrench *rise)
{
    const corner *p = q->p;
    double area = 0.0;
    *rise = (fl_wrench){.f = {0}};
    for (int32_t k = 0; k < q->corners; k++) {
        const corner a = p[k], b = p[k + 1 < q->corners ? k + 1 : 0];
        area += (a.x - p[0].x) * (b.y - p[0].y) - (b.x - p[0].x) * (a.y - p[0].y);
        if (a.side < 0) continue;
        const double l = sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        *rise = fl_wrench_madd(*rise, -l / q->C,
                               force_at(q->side[a.side].q, point_at(q, 0.5 * (a.x + b.x), 0.5 * (a.y + b.y),
                                                                    0.5 * (a.s + b.s))));
    }
    return 0.5 * area / q->C;
}

/* Share of the edges of the own face that the pair bears.  The polygon is not yet cut at s = 0; where it does
 * not touch it is cut at z = 0 here.  least: the least s.  g: scratch. */
static int find_borne(face_pair *q, double a0, int touching, double least, int32_t own, double *g,
                      fl_quick_borne *to)
{
    const double far = FL_QUICK_NEARNESS * q->d->R;
    fl_wrench of_area, of_nearness = {.f = {0}};
    double da, dn = 0.0, by_nearness = 1.0;
    const double by_area = fl_quick_step(find_area(q, &of_area) / a0, &da);
    if (!(by_area > 0.0)) return 0;
    if (!touching && least < -q->d->R && !clip_side(q, q->s0 + q->d->R, -q->sx, -q->sy, CUT, g)) return 0;
    if (!touching) by_nearness = fl_quick_step(find_nearness(q, &of_nearness) / far, &dn);
    const double by_angle = q->m < FL_QUICK_FLAT ? q->m / FL_QUICK_FLAT : 1.0;
    *to = (fl_quick_borne){.share = by_angle * by_area * by_nearness, .face = own};
    to->reach = by_angle * by_area * dn / far;
    if (da > 0.0) to->rise = fl_wrench_madd(to->rise, by_angle * da / a0 * by_nearness, of_area);
    if (dn > 0.0) to->rise = fl_wrench_madd(to->rise, to->reach, of_nearness);
    if (q->m < FL_QUICK_FLAT)
        to->rise.m =
            v3_madd(to->rise.m, -q->dm / FL_QUICK_FLAT * by_area * by_nearness, v3_cross(q->n, q->f->n));
    return to->share > 0.0;
}

/* Integrals over P of s^n times 1, x, y and, for s^3, their products. */
typedef struct {
    double i2, i3, i4, x, y, xx, xy, yy;
} area_sums;

/* Over a fan of triangles T, by complete homogeneous symmetric polynomials h_n of the three s:
 *     int s^n = 2T n!/(n+2)! h_n,  int s^n x = 2T n!/(n+3)! sum x_i h_n(s, s_i),
 *     int s^n x y = 2T n!/(n+4)! sum x_i y_j (1 + [i = j]) h_n(s, s_i, s_j). */
static area_sums integrate_area(const corner *p, int32_t n)
{
    area_sums q = {0};
    for (int32_t k = 1; k + 1 < n; k++) {
        const double a = p[0].s, b = p[k].s, c = p[k + 1].s, x0 = p[0].x, y0 = p[0].y;
        const double x1 = p[k].x - x0, y1 = p[k].y - y0, x2 = p[k + 1].x - x0, y2 = p[k + 1].y - y0;
        const double T = 0.5 * (x1 * y2 - x2 * y1);
        const double ab1 = a + b, ab2 = a * a + b * ab1, ab3 = a * a * a + b * ab2,
                     ab4 = a * a * a * a + b * ab3;
        const double h1 = ab1 + c, h2 = ab2 + c * h1, h3 = ab3 + c * h2, h4 = ab4 + c * h3;
        /* with b once more, with c once more, and pairs of them */
        const double b1 = h1 + b, b2 = h2 + b * b1, b3 = h3 + b * b2;
        const double c1 = h1 + c, c2 = h2 + c * c1, c3 = h3 + c * c2;
        const double bb3 = b3 + b * (b2 + b * (b1 + b)), cc3 = c3 + c * (c2 + c * (c1 + c)),
                     bc3 = b3 + c * (b2 + c * (b1 + c));
        const double i3 = T * h3 / 10.0, mx = T / 60.0 * (x1 * b3 + x2 * c3),
                     my = T / 60.0 * (y1 * b3 + y2 * c3);
        const double t = T / 420.0;
        q.i2 += T * h2 / 6.0, q.i3 += i3, q.i4 += T * h4 / 15.0;
        /* about the first corner, then about the origin */
        q.x += mx + i3 * x0, q.y += my + i3 * y0;
        q.xx += t * (2.0 * (x1 * x1 * bb3 + x2 * x2 * cc3) + 2.0 * x1 * x2 * bc3) + x0 * (2.0 * mx + i3 * x0);
        q.yy += t * (2.0 * (y1 * y1 * bb3 + y2 * y2 * cc3) + 2.0 * y1 * y2 * bc3) + y0 * (2.0 * my + i3 * y0);
        q.xy += t * (2.0 * (x1 * y1 * bb3 + x2 * y2 * cc3) + (x1 * y2 + x2 * y1) * bc3) + x0 * my + y0 * mx +
                i3 * x0 * y0;
    }
    return q;
}

/* Adds -int s^4 q.u over the sides of f on the border. */
static void add_sides(const face_pair *q, double factor, fl_quick_total *to)
{
    for (int32_t k = 0; k < q->corners; k++) {
        const corner a = q->p[k], b = q->p[k + 1 < q->corners ? k + 1 : 0];
        if (a.side < 0) continue;
        const double s = a.s, t = b.s, l = sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
        const double e1 = s + t, e2 = s * s + t * e1, e3 = s * s * s + t * e2, e4 = s * s * s * s + t * e3;
        const double r1 = e1 + s, r2 = e2 + s * r1, r3 = e3 + s * r2, r4 = e4 + s * r3; /* with s twice */
        const double u1 = e1 + t, u2 = e2 + t * u1, u3 = e3 + t * u2, u4 = e4 + t * u3;
        const fl_vec3 n = q->side[a.side].q, xa = point_at(q, a.x, a.y, s), xb = point_at(q, b.x, b.y, t);
        fl_quick_add_wrench(to, factor * l / 30.0 * r4, force_at(n, xa));
        fl_quick_add_wrench(to, factor * l / 30.0 * u4, force_at(n, xb));
    }
}

/* Adds the term of the pair from its integrals. */
static void add_area(const face_pair *q, fl_quick_total *to)
{
    const fl_quick_face *f = q->f;
    const area_sums i = integrate_area(q->p, q->corners);
    const double factor = 0.5 * q->m / q->C, e = 4.0 * factor * i.i3;
    if (!(e > 0.0)) return;
    const double cx = i.x / i.i3, cy = i.y / i.i3, s = q->s0 + q->sx * cx + q->sy * cy;
    const fl_vec3 x = point_at(q, cx, cy, s), force = v3_scale(e, f->n);
    double *const a = to->a;
    a[FL_QUICK_U] += factor * i.i4, a[FL_QUICK_REACH] += e, a[FL_QUICK_DDU] += 12.0 * factor * i.i2;
    a[FL_QUICK_E] += e;
    fl_quick_add_wrench(to, 1.0, force_at(force, x));
    to->a[FL_QUICK_WAY] += force.x, to->a[FL_QUICK_WAY + 1] += force.y, to->a[FL_QUICK_WAY + 2] += force.z;
    const fl_vec3 turn = v3_scale(0.5 * (q->dm / q->C) * i.i4, v3_cross(q->n, f->n));
    fl_quick_add_wrench(to, 1.0, (fl_wrench){{0}, turn});
    add_sides(q, factor, to);
    /* the middle of the overlap, and second moments in the plane of f about it */
    const fl_vec3 p = v3_madd(x, 0.5 * s - q->d->r, f->n);
    const double w = e / i.i3, xx = w * (i.xx - i.x * cx), xy = w * (i.xy - i.x * cy),
                 yy = w * (i.yy - i.y * cy);
    const fl_vec3 g = f->t1, h = f->t2;
    a[FL_QUICK_EX] += e * p.x, a[FL_QUICK_EY] += e * p.y, a[FL_QUICK_EZ] += e * p.z;
    a[FL_QUICK_XX] += e * p.x * p.x + xx * g.x * g.x + 2.0 * xy * g.x * h.x + yy * h.x * h.x;
    a[FL_QUICK_XY] += e * p.x * p.y + xx * g.x * g.y + xy * (g.x * h.y + h.x * g.y) + yy * h.x * h.y;
    a[FL_QUICK_XZ] += e * p.x * p.z + xx * g.x * g.z + xy * (g.x * h.z + h.x * g.z) + yy * h.x * h.z;
    a[FL_QUICK_YY] += e * p.y * p.y + xx * g.y * g.y + 2.0 * xy * g.y * h.y + yy * h.y * h.y;
    a[FL_QUICK_YZ] += e * p.y * p.z + xx * g.y * g.z + xy * (g.y * h.z + h.y * g.z) + yy * h.y * h.z;
    a[FL_QUICK_ZZ] += e * p.z * p.z + xx * g.z * g.z + 2.0 * xy * g.z * h.z + yy * h.z * h.z;
}

/* Projects own face j; returns 0 where no corner is nearer than R + R. */
static int project_face(face_pair *q, const fl_quick_face *j)
{
    const fl_quick_way *d = q->d;
    const fl_quick_face *f = q->f;
    const double per = 1.0 / q->C;
    const int32_t *loop = d->own->loop + j->first;
    double most = -INFINITY;
    for (int32_t k = 0; k < j->sides; k++) { /* reversed: it goes round as f does */
        const fl_vec3 x = v3_add(m3_mul(d->M, d->own->vertex[loop[j->sides - 1 - k]]), d->o);
        const double s = d->reach + f->height - v3_dot(f->n, x);
        q->p[k] = (corner){v3_dot(f->t1, x), v3_dot(f->t2, x), s, OWN_SIDE};
        most = fmax(most, s);
    }
    q->corners = j->sides;
    q->sx = -per * v3_dot(q->n, f->t1), q->sy = -per * v3_dot(q->n, f->t2);
    q->s0 = q->p[0].s - q->sx * q->p[0].x - q->sy * q->p[0].y;
    return most > -d->R;
}

/* Adds a pair of faces; returns 1 if it bears edges of its own face. */
static int add_pair(face_pair *q, int32_t own, int32_t other, double *g, fl_quick_total *to,
                    fl_quick_borne *borne, double *overlap)
{
    const fl_quick_way *d = q->d;
    const fl_quick_face *j = &d->own->face[own];
    q->f = &d->other->face[other], q->side = d->other->side + q->f->first;
    q->n = m3_mul(d->M, j->n);
    const double C = q->C = -v3_dot(q->n, q->f->n), root = 4.0 * C * C - 3.0;
    if (!(C > 0.0 && root > 0.0) || !project_face(q, j)) return 0;
    q->m = root * root, q->dm = 16.0 * C * root;
    for (int32_t c = 0; c < q->f->sides; c++)
        if (!clip_side(q, q->side[c].inset_c, q->side[c].qx, q->side[c].qy, c, g)) return 0;
    const double most = d->reach + ON_PLANE_TOL * (d->own->bound + d->other->bound);
    double low = INFINITY, high = -INFINITY;
    for (int32_t k = 0; k < q->corners; k++) low = fmin(low, q->p[k].s), high = fmax(high, q->p[k].s);
    if (high > most && !clip_side(q, most - q->s0, q->sx, q->sy, CUT, g)) return 0;
    const double least = fmin(j->area, q->f->area), a0 = fmin(d->R * sqrt(least), 0.5 * least);
    const int bears = find_borne(q, a0, high > 0.0, low, own, g, borne);
    if (!(high > 0.0)) return bears;
    if (low < 0.0) {
        if (!clip_side(q, q->s0, -q->sx, -q->sy, CUT, g)) return bears;
        for (int32_t k = 0; k < q->corners; k++) q->p[k].s = fmax(q->p[k].s, 0.0);
    }
    add_area(q, to);
    for (int32_t k = 0; k < q->corners; k++) *overlap = fmax(*overlap, q->p[k].s);
    return bears;
}

int fl_quick_add_faces(fl_quick_scratch *w, const fl_quick_way *d, fl_quick_total *to,
                       const fl_quick_borne **borne, int32_t *n, double *overlap)
{
    int32_t pairs, most = 0;
    const int32_t *at = fl_quick_section_of(d->l, d->section + FL_QUICK_PAIR, &pairs);
    *n = 0;
    for (int32_t k = 0; k < pairs; k += 2) {
        const int32_t corners = d->own->face[at[k]].sides + d->other->face[at[k + 1]].sides + 3;
        most = corners > most ? corners : most;
    }
    if (fl_reserve(&w->polygon, &w->polygon_cap, 2 * most, sizeof(corner)) ||
        fl_reserve(&w->weight, &w->weight_cap, most, sizeof *w->weight) ||
        fl_reserve(&w->borne, &w->borne_cap, pairs / 2, sizeof(fl_quick_borne)))
        return -1;
    fl_quick_borne *const out = w->borne;
    *borne = out;
    face_pair q = {.d = d, .p = w->polygon, .spare = (corner *)w->polygon + most};
    for (int32_t k = 0; k < pairs; k += 2)
        *n += add_pair(&q, at[k], at[k + 1], w->weight, to, &out[*n], overlap);
    return 0;
}
