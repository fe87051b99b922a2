/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/cone_area.h"
#include <math.h>
#include "base/fast_math.h"
#include "base/pi.h"

/* A plane is along a generator below this sine. */
#define PARALLEL 1e-9
/* Vertices of the section count to this share of the radius outside the body. */
#define OUTSIDE 1e-9
/* Narrower parts are joined to the next one [rad]. */
#define NARROW 1e-13
/* The radius at a plane may vary by this factor from the middle of a part to its ends. */
#define VARIES 1.6

enum { BREAKS = 256, HALVINGS = 10, GAUSS = 8 };

/* A plane nx x + ny y + nz z = c.  With u = nx cos + ny sin, the generator crosses it at the share
 * t = (c - r0 u)/(dr u + h nz) of its length, where its radius is k/(dr u + h nz). */
typedef struct {
    double nx, ny, nz, c, k;
} cut_plane;

typedef struct {
    double c, s, p; /* cosine, sine and a measure that grows with the angle, -2 to 2 */
} direction;

typedef struct {
    double r0, dr, h;  /* of the cone */
    double outside;    /* [m] */
    double ex, ey;     /* axis of the angles, in the frame of the cone */
    double least_cos;  /* sector: cos >= this */
    int end_counts[2]; /* whether some of the ends, t = 0 and 1, may be inside */
    int n, breaks;
    cut_plane plane[FL_HALF_SPACES];
    direction at[BREAKS];
    double S[3], area; /* sums, about the axis */
} section;

/* The bounds of a generator: range of t, and the planes that give them, -1: an end of the range. */
typedef struct {
    double from, to;
    int lower, upper;
} bounds;

/* Keeps the planes that cut the cone.  0 if one has all of it outside. */
static int keep_planes(section *q, const fl_half_spaces *a)
{
    q->end_counts[0] = q->end_counts[1] = 1;
    for (int k = 0; k < a->n; k++) {
        const fl_vec3 n = a->normal[k];
        const double across = sqrt(n.x * n.x + n.y * n.y), c = a->c[k], lo = across * q->r0,
                     hi = across * (q->r0 + q->dr), up = n.z * q->h;
        const int low_outside = -lo >= c, high_outside = up - hi >= c;
        if (low_outside) q->end_counts[0] = 0;
        if (high_outside) q->end_counts[1] = 0;
        if (low_outside && high_outside) return 0;
        if (lo <= c && up + hi <= c) continue;
        q->plane[q->n++] = (cut_plane){n.x * q->ex + n.y * q->ey, n.y * q->ex - n.x * q->ey, n.z, c,
                                       c * q->dr + q->r0 * q->h * n.z};
    }
    return 1;
}

static void add_break(section *q, double c, double s)
{
    const double side = fabs(s) / (fabs(c) + fabs(s)), p = c >= 0.0 ? side : 2.0 - side;
    if (q->breaks < BREAKS) q->at[q->breaks++] = (direction){c, s, s < 0.0 ? -p : p};
}

/* True if the point at t of a generator is in the sector and not outside a plane other than i and j. */
static int is_vertex(const section *q, double c, double s, double t, int i, int j)
{
    const double r = q->r0 + t * q->dr, z = t * q->h, reach = q->outside;
    if (c < q->least_cos || t * q->h < -reach || (t - 1.0) * q->h > reach) return 0;
    for (int k = 0; k < q->n; k++) {
        const cut_plane *e = &q->plane[k];
        if (k != i && k != j && r * (e->nx * c + e->ny * s) + e->nz * z > e->c + reach) return 0;
    }
    return 1;
}

/* Both solutions of A cos + B sin = C; 0 if there are none. */
static int solve(double A, double B, double C, direction x[2])
{
    const double size = A * A + B * B, rest = size - C * C;
    if (!(rest > 0.0)) return 0;
    const double w = sqrt(rest), each = 1.0 / size;
    x[0].c = (A * C - B * w) * each, x[0].s = (B * C + A * w) * each;
    x[1].c = (A * C + B * w) * each, x[1].s = (B * C - A * w) * each;
    return 1;
}

/* Adds the directions where the line of planes i and j meets the cone on the body. */
static void add_vertices_of_planes(section *q, int i, int j)
{
    const cut_plane *a = &q->plane[i], *b = &q->plane[j];
    direction x[2];
    if (!solve(a->k * b->nx - b->k * a->nx, a->k * b->ny - b->k * a->ny, q->h * (b->c * a->nz - a->c * b->nz),
               x))
        return;
    for (int m = 0; m < 2; m++) {
        const double ua = a->nx * x[m].c + a->ny * x[m].s, ub = b->nx * x[m].c + b->ny * x[m].s,
                     ga = q->dr * ua + q->h * a->nz, gb = q->dr * ub + q->h * b->nz;
        const int first = fabs(ga) > fabs(gb);
        const double g = first ? ga : gb, h = first ? a->c - q->r0 * ua : b->c - q->r0 * ub;
        if (fabs(g) > PARALLEL * q->h && is_vertex(q, x[m].c, x[m].s, h / g, i, j))
            add_break(q, x[m].c, x[m].s);
    }
}

/* Adds the directions where plane i meets the end of the cone at t. */
static void add_vertices_of_end(section *q, int i, double t)
{
    const cut_plane *a = &q->plane[i];
    const double r = q->r0 + t * q->dr;
    direction x[2];
    if (!solve(r * a->nx, r * a->ny, a->c - a->nz * t * q->h, x)) return;
    for (int m = 0; m < 2; m++)
        if (is_vertex(q, x[m].c, x[m].s, t, i, i)) add_break(q, x[m].c, x[m].s);
}

/* The directions between which the same planes bound the generators, in order. */
static void find_breaks(section *q)
{
    const double c = q->least_cos, s = sqrt(1.0 - c * c);
    const double p = c >= 0.0 ? s / (c + s) : 2.0 - s / (s - c);
    q->at[q->breaks++] = (direction){c, -s, -p};
    q->at[q->breaks++] = (direction){c, s, p};
    if (c < 0.0) add_break(q, 1.0, 0.0);
    for (int i = 0; i < q->n; i++) {
        if (q->end_counts[0]) add_vertices_of_end(q, i, 0.0);
        if (q->end_counts[1]) add_vertices_of_end(q, i, 1.0);
        for (int j = 0; j < i; j++) add_vertices_of_planes(q, i, j);
    }
    for (int k = 1; k < q->breaks; k++) {
        const direction x = q->at[k];
        int m = k;
        for (; m > 0 && q->at[m - 1].p > x.p; m--) q->at[m] = q->at[m - 1];
        q->at[m] = x;
    }
}

/* The part of a generator inside; 0 if there is none. */
static int bounds_at(const section *q, double c, double s, bounds *b)
{
    *b = (bounds){0.0, 1.0, -1, -1};
    for (int k = 0; k < q->n; k++) {
        const cut_plane *e = &q->plane[k];
        const double u = e->nx * c + e->ny * s, h = e->c - q->r0 * u, g = q->dr * u + q->h * e->nz;
        if (g > PARALLEL * q->h) {
            if (h < g * b->to) b->to = h / g, b->upper = k;
        } else if (g < -PARALLEL * q->h) {
            if (h < g * b->from) b->from = h / g, b->lower = k;
        } else if (h <= 0.0) {
            return 0;
        }
    }
    return b->to > b->from;
}

/* A part of the section between two directions: its middle, half of its angle, sine and cosine of that. */
typedef struct {
    double c, s, half, sin_half, cos_half;
} sector;

/* 0 if it is too narrow. */
static int sector_between(const direction *x, const direction *y, sector *m)
{
    const double dot = x->c * y->c + x->s * y->s, cross = x->c * y->s - x->s * y->c;
    if (dot > 0.0 && !(cross > NARROW)) return 0;
    const double c = dot > 0.0 ? x->c + y->c : y->s - x->s, s = dot > 0.0 ? x->s + y->s : x->c - y->c,
                 each = 1.0 / sqrt(c * c + s * s);
    m->c = each * c, m->s = each * s;
    m->half = 0.5 * fl_atan2(fmax(cross, 0.0), dot);
    if (dot > 0.0) {
        m->cos_half = sqrt(0.5 * (1.0 + dot)), m->sin_half = 0.5 * cross / m->cos_half;
    } else {
        m->sin_half = sqrt(0.5 * (1.0 - dot)), m->cos_half = 0.5 * fmax(cross, 0.0) / m->sin_half;
    }
    return 1;
}

/* Cylinder: with d the angle from the middle, the length inside is there + e (cos d - 1) + g sin d. */
static void add_cylinder(section *q, const sector *m, const bounds *b)
{
    const double there = (b->to - b->from) * q->h, w = m->half, w2 = m->sin_half * m->cos_half;
    double e = 0.0, g = 0.0;
    for (int side = 0; side < 2; side++) {
        const int k = side ? b->upper : b->lower;
        if (k < 0) continue;
        const cut_plane *f = &q->plane[k];
        const double each = (side ? -q->r0 : q->r0) / f->nz;
        e += each * (f->nx * m->c + f->ny * m->s), g += each * (f->ny * m->c - f->nx * m->s);
    }
    const double along = q->r0 * (2.0 * m->sin_half * there - e * (2.0 * m->sin_half - w - w2)),
                 aside = q->r0 * g * (w - w2);
    q->S[0] += along * m->c - aside * m->s;
    q->S[1] += along * m->s + aside * m->c;
    q->area += q->r0 * (2.0 * w * there - 2.0 * e * (w - m->sin_half));
}

/* t where plane k bounds the generator, on the cone; k = -1: an end of the range. */
static double bound_at(const section *q, int k, double end, double c, double s)
{
    if (k < 0) return end;
    const cut_plane *e = &q->plane[k];
    const double u = e->nx * c + e->ny * s;
    const double g = q->dr * u + q->h * e->nz, h = e->c - q->r0 * u;
    return fabs(g) > PARALLEL * q->h ? fmin(fmax(h / g, 0.0), 1.0) : end;
}

/* Adds a part of the side of a cone by Gauss points. */
static void add_points(section *q, const sector *m, const bounds *b)
{
    static const double X[GAUSS / 2] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                        0.9602898564975363},
                                  W[GAUSS / 2] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                                  0.1012285362903763};
    const double slope = q->dr / q->h, slant = sqrt(1.0 + slope * slope);
    for (int k = 0; k < GAUSS / 2; k++) {
        double turn_c, turn_s;
        fl_cos_sin(X[k] * m->half, &turn_c, &turn_s);
        for (int side = -1; side <= 1; side += 2) {
            const double c = m->c * turn_c - side * m->s * turn_s, s = m->s * turn_c + side * m->c * turn_s,
                         from = bound_at(q, b->lower, 0.0, c, s), to = bound_at(q, b->upper, 1.0, c, s),
                         r = q->r0 + 0.5 * (from + to) * q->dr,
                         dA = m->half * W[k] * r * fmax(to - from, 0.0) * q->h;
            q->S[0] += dA * c, q->S[1] += dA * s, q->S[2] -= dA * slope;
            q->area += dA * slant;
        }
    }
}

/* Change of the radius at plane k over a part: the larger of both factors from its middle to its ends. */
static double change_at(const section *q, int k, const direction *x, const sector *m, const direction *y)
{
    if (k < 0) return 1.0;
    const cut_plane *e = &q->plane[k];
    const double mid = q->dr * (e->nx * m->c + e->ny * m->s) + q->h * e->nz,
                 a = fabs((q->dr * (e->nx * x->c + e->ny * x->s) + q->h * e->nz) / mid),
                 b = fabs((q->dr * (e->nx * y->c + e->ny * y->s) + q->h * e->nz) / mid), most = fmax(a, b),
                 least = fmin(a, b);
    return most * least > 1.0 ? most : 1.0 / least;
}

static void add_cone(section *q, const direction *x, const direction *y, const bounds *b, int halvings)
{
    sector m;
    if (!sector_between(x, y, &m)) return;
    if (halvings > 0 && (m.half > 0.25 * PI + 1e-9 || change_at(q, b->lower, x, &m, y) > VARIES ||
                         change_at(q, b->upper, x, &m, y) > VARIES)) {
        const direction mid = {m.c, m.s, 0.0};
        add_cone(q, x, &mid, b, halvings - 1);
        add_cone(q, &mid, y, b, halvings - 1);
    } else {
        add_points(q, &m, b);
    }
}

/* Sets axis and range of angles of the cone that face f; 0 if none does. */
static int find_sector(section *q, fl_vec3 f)
{
    const double across = sqrt(f.x * f.x + f.y * f.y), least = q->dr / q->h * f.z;
    q->ex = 1.0, q->ey = 0.0, q->least_cos = -1.0;
    if (across > 0.0) q->ex = f.x / across, q->ey = f.y / across;
    if (!(v3_norm2(f) > 0.0)) return 1;
    if (least >= across) return 0;
    if (least > -across) q->least_cos = least / across;
    return 1;
}

fl_vec3 fl_cone_area_vector(const fl_half_spaces *a, const fl_piece *cone, fl_vec3 facing, double *area)
{
    section q;
    q.r0 = cone->r0, q.dr = cone->r1 - cone->r0, q.h = cone->h;
    q.outside = OUTSIDE * fmax(cone->r0, cone->r1);
    q.n = q.breaks = 0;
    q.S[0] = q.S[1] = q.S[2] = q.area = 0.0;
    if (area) *area = 0.0;
    if (!find_sector(&q, facing) || !keep_planes(&q, a)) return v3(0, 0, 0);
    find_breaks(&q);
    const direction *from = &q.at[0];
    for (int k = 1; k < q.breaks; k++) {
        sector m;
        bounds b;
        if (!sector_between(from, &q.at[k], &m)) continue;
        if (bounds_at(&q, m.c, m.s, &b)) {
            if (q.dr != 0.0) add_cone(&q, from, &q.at[k], &b, HALVINGS);
            else add_cylinder(&q, &m, &b);
        }
        from = &q.at[k];
    }
    if (area) *area = q.area;
    return v3(q.S[0] * q.ex - q.S[1] * q.ey, q.S[0] * q.ey + q.S[1] * q.ex, q.S[2]);
}
