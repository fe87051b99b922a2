/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/mem.h"
#include "base/wide.h"
#include "narrow/areas.h"
#include "narrow/overlap.h"
#include "narrow/rules.h"

#define SAME 1e-13 /* of the size: how far below the other's plane still counts as on it */

/* Gauss' three points on [0, 1] */
static const double GAUSS[3] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
static const double GAUSS_WEIGHT[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

/* A corner of the cut polygon: plane coordinates and overlap; the side that starts here is part of F's own
 * rim or not. */
typedef struct {
    double x, y, s, own;
} corner;

/* Keep of poly[n] what has g >= 0, g[k] at corner k; sides along the cut are not F's own. */
static int32_t cut(const corner *p, const double *g, int32_t n, corner *out)
{
    int32_t m = 0;
    for (int32_t k = 0; k < n; k++) {
        const int32_t next = k + 1 < n ? k + 1 : 0;
        const int in = g[k] >= 0.0, then = g[next] >= 0.0;
        if (in) out[m++] = p[k];
        if (in != then) {
            const double t = g[k] / (g[k] - g[next]);
            const corner a = p[k], b = p[next];
            out[m] = (corner){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.s + t * (b.s - a.s), a.own};
            if (in) out[m].own = 0.0;
            m++;
        }
    }
    return m;
}

/* Triangles until there are enough to fill a register: corners, overlaps and fades there, areas. */
typedef struct {
    fl_wide x[3], y[3], s[3], fade[3], area;
    int n;
} batch;

/* Sums over nodes of u, its derivatives, du s, the largest s; of du x, ..., about the first corner of the
 * first polygon: what is far away keeps its digits. */
typedef struct {
    fl_wide u, du, ddu, s, most, x, y, xx, xy, yy;
} sums;

/* Where the plane of f is, and F over it. */
typedef struct {
    fl_places *w;
    const fl_side *own;
    fl_across at; /* origin and axes in the plane of f */
    fl_vec3 nf, nF;
    double slope, half, R; /* c = -n_F.n_f; 1/2, or 1 for a plane */
    double m, dm;          /* half of m(c), and its derivative */
    double c0, cx, cy;     /* fade, c0 + cx x + cy y */
    int begun;
    double x0, y0;      /* the first corner */
    fl_vec3 pull, turn; /* of the rims, in the axes at.x, at.y, nf: force, and moment about the first corner
                         * on the plane of f */
    batch b;
    sums sum;
} footprint;

static fl_vec3 lift(const footprint *q, double x, double y, double s)
{
    const fl_vec3 o = v3_madd(q->at.o, q->R - s, q->nf);
    return v3_madd(v3_madd(o, x, q->at.x), y, q->at.y);
}

/* The triangles of b, and b is empty. */
FL_WIDE_VERSIONS static void take(batch *b, sums *q)
{
    for (int k = b->n; k < FL_LANES; k++) b->area[k] = 0.0;
    for (int k = 0; k < FL_TRIANGLE_NODES; k++) {
        const double b0 = FL_TRIANGLE_NODE[k][0], b1 = FL_TRIANGLE_NODE[k][1], b2 = FL_TRIANGLE_NODE[k][2];
        const fl_wide x = b0 * b->x[0] + b1 * b->x[1] + b2 * b->x[2];
        const fl_wide y = b0 * b->y[0] + b1 * b->y[1] + b2 * b->y[2];
        const fl_wide to = b0 * b->s[0] + b1 * b->s[1] + b2 * b->s[2], s = FL_WIDE_WHERE(to > 0.0, to);
        const fl_wide f = b0 * b->fade[0] + b1 * b->fade[1] + b2 * b->fade[2];
        const fl_wide area = FL_TRIANGLE_WEIGHT[k] * b->area * FL_WIDE_WHERE(f > 0.0, f), s2 = s * s,
                      part = area * s2;
        const fl_wide du = 4.0 * part * s;
        const fl_wide here = FL_WIDE_WHERE(area > 0.0, s);
        q->u += part * s2;
        q->du += du;
        q->ddu += 12.0 * part;
        q->s += du * s;
        q->x += du * x;
        q->y += du * y;
        q->xx += du * x * x;
        q->xy += du * x * y;
        q->yy += du * y * y;
        q->most = FL_WIDE_CHOOSE(here > q->most, here, q->most);
    }
    b->n = 0;
}

static double fade(const footprint *q, double x, double y) { return q->c0 + q->cx * x + q->cy * y; }

static void triangle(footprint *q, corner a, corner b, corner c, double area)
{
    const corner t[3] = {a, b, c};
    const int n = q->b.n++;
    for (int k = 0; k < 3; k++) {
        q->b.x[k][n] = t[k].x - q->x0;
        q->b.y[k][n] = t[k].y - q->y0;
        q->b.s[k][n] = t[k].s;
        q->b.fade[k][n] = fade(q, t[k].x, t[k].y);
    }
    q->b.area[n] = area;
    if (n + 1 == FL_LANES) take(&q->b, &q->sum);
}

/* Moving F outward over its own rim a b makes the area larger: the gradient of that. */
static void rim(footprint *q, corner a, corner b, double turn)
{
    const double ex = b.x - a.x, ey = b.y - a.y, nx = turn * ey,
                 ny = -turn * ex; /* outward, as long as a b */
    for (int k = 0; k < 3; k++) {
        const double t = GAUSS[k], s = a.s + t * (b.s - a.s), s2 = s * s;
        const double x = a.x + t * ex, y = a.y + t * ey, part = fade(q, x, y);
        if (s <= 0.0 || part <= 0.0) continue;
        const double c = GAUSS_WEIGHT[k] * part * s2 * s2;
        const fl_vec3 f = v3(c * nx, c * ny, 0.0);
        q->pull = v3_add(q->pull, f);
        q->turn = v3_add(q->turn, v3_cross(v3(x - q->x0, y - q->y0, q->R - s), f));
    }
}

/* The polygon of F over the plane of f, before any cut, in the first of four buffers that have room for
 * `more` cuts; g gets room for the values of a cutting function. */
static int32_t lay(footprint *q, int32_t F, int64_t more, corner *buffer[4], double **g)
{
    const fl_poly *p = q->own->p;
    const int32_t *loop = p->loop + p->first[F], n = p->first[F + 1] - p->first[F];
    const int64_t room = n + more;
    fl_err lost = {0};
    if (fl_grow(&q->w->cut, &q->w->cut_cap, 6 * room, sizeof *q->w->cut, &lost)) return -1;
    for (int k = 0; k < 4; k++) buffer[k] = (corner *)(void *)q->w->cut + k * room;
    *g = (double *)(void *)(buffer[3] + room);
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 r = v3_sub(q->own->v[loop[k]], q->at.o);
        buffer[0][k] = (corner){v3_dot(q->at.x, r), v3_dot(q->at.y, r), q->R - v3_dot(q->nf, r), 1.0};
    }
    return n;
}

static void integrate(footprint *q, const corner *p, int32_t n)
{
    double twice = 0.0;
    if (!q->begun) q->x0 = p[0].x, q->y0 = p[0].y, q->begun = 1;
    for (int32_t k = 1; k + 1 < n; k++) {
        const corner a = p[0], b = p[k], c = p[k + 1];
        const double part = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        twice += part;
        if (part != 0.0) triangle(q, a, b, c, 0.5 * fabs(part));
    }
    const double turn = twice > 0.0 ? 1.0 : -1.0;
    for (int32_t k = 0; k < n; k++)
        if (p[k].own > 0.0) rim(q, p[k], p[k + 1 < n ? k + 1 : 0], turn);
}

/* Keep of *now what lies left of the line from (ax, ay) to (bx, by). */
static int32_t left_of(corner **now, corner **spare, double *g, int32_t n, double ax, double ay, double bx,
                       double by)
{
    const double ex = bx - ax, ey = by - ay;
    int out = 0;
    for (int32_t k = 0; k < n; k++) {
        g[k] = ex * ((*now)[k].y - ay) - ey * ((*now)[k].x - ax);
        out |= g[k] < 0.0;
    }
    if (!out) return n;
    n = cut(*now, g, n, *spare);
    corner *swap = *now;
    *now = *spare, *spare = swap;
    return n;
}

static void swap_corners(corner **a, corner **b)
{
    corner *const c = *a;
    *a = *b, *b = c;
}

/* The corners of face f in its plane. */
static void lay_side(const footprint *q, const fl_side *other, int32_t f, corner *rim)
{
    const fl_poly *p = other->p;
    const int32_t *loop = p->loop + p->first[f], sides = p->first[f + 1] - p->first[f];
    for (int32_t c = 0; c < sides; c++) {
        const fl_vec3 r = v3_sub(other->v[loop[c]], q->at.o);
        rim[c] = (corner){.x = v3_dot(q->at.x, r), .y = v3_dot(q->at.y, r)};
    }
}

/* `inner`: those corners moved inward by the width of the rim, which is at most `width` and leaves every side
 * half its length.  Returns that width. */
static double lay_rim(int32_t sides, double width, corner *rim, corner *inner)
{
    for (int32_t c = 0; c < sides;
         c++) { /* s: length of the side that starts here; inner: its inward normal */
        const corner a = rim[c], b = rim[c + 1 < sides ? c + 1 : 0];
        const double ex = b.x - a.x, ey = b.y - a.y;
        rim[c].s = sqrt(ex * ex + ey * ey);
        inner[c].x = -ey / rim[c].s, inner[c].y = ex / rim[c].s;
    }
    for (int32_t c = 0; c < sides; c++) { /* own: tan of half the turn */
        const corner in = inner[c > 0 ? c - 1 : sides - 1], out = inner[c];
        rim[c].own = fabs(in.x * out.y - in.y * out.x) / (1.0 + in.x * out.x + in.y * out.y);
    }
    for (int32_t c = 0; c < sides; c++)
        width = fmin(width, 0.5 * rim[c].s / (rim[c].own + rim[c + 1 < sides ? c + 1 : 0].own));
    corner before = inner[sides - 1];
    for (int32_t c = 0; c < sides; c++) {
        const corner n = inner[c];
        const double k = width / (1.0 + before.x * n.x + before.y * n.y);
        inner[c].x = rim[c].x + k * (before.x + n.x), inner[c].y = rim[c].y + k * (before.y + n.y);
        before = n;
    }
    return width;
}

/* The places of all nodes: all push along n_F, so that three with their sum, mean and second moments have the
 * same force, torque and spread.  They get the factor m, whose
 * change has a couple.  Then the pull of the rims. */
static int put(footprint *q)
{
    static const double COS[3] = {1.0, -0.5, -0.5}, SIN[3] = {0.0, 0.86602540378443865, -0.86602540378443865};
    const double m = q->m, side = q->own->side;
    if (!q->begun) return 0;
    if (q->b.n) take(&q->b, &q->sum);
    const double u = fl_wide_sum(&q->sum.u), du = fl_wide_sum(&q->sum.du), ddu = fl_wide_sum(&q->sum.ddu);
    if (!(du > 0.0)) return 0;
    const double x = fl_wide_sum(&q->sum.x) / du, y = fl_wide_sum(&q->sum.y) / du;
    const double s = fl_wide_sum(&q->sum.s) / du, xx = fl_wide_sum(&q->sum.xx) / du - x * x;
    const double xy = fl_wide_sum(&q->sum.xy) / du - x * y, yy = fl_wide_sum(&q->sum.yy) / du - y * y;
    const double a = xx > 0.0 ? sqrt(2.0 * xx) : 0.0, b = a > 0.0 ? 2.0 * xy / a : 0.0, c2 = 2.0 * yy - b * b,
                 c = c2 > 0.0 ? sqrt(c2) : 0.0;
    double most = 0.0;
    for (int k = 0; k < FL_LANES; k++) most = q->sum.most[k] > most ? q->sum.most[k] : most;
    /* s over F */
    const double sx = -v3_dot(q->nF, q->at.x) / q->slope, sy = -v3_dot(q->nF, q->at.y) / q->slope;
    for (int k = 0; k < 3; k++) {
        const double dx = a * COS[k], dy = b * COS[k] + c * SIN[k], sk = s + sx * dx + sy * dy;
        const fl_vec3 on = lift(q, q->x0 + x + dx, q->y0 + y + dy, sk);
        if (fl_places_add(q->w, (fl_place){.stands = 3,
                                           .overlap = most,
                                           .u = m * u / 3.0,
                                           .du = m * du / 3.0,
                                           .ddu = m * ddu / 3.0,
                                           .n = v3_scale(-side / q->slope, q->nF),
                                           .across = v3_scale(side, q->nf),
                                           .p = v3_madd(on, q->own->r - 0.5 * sk, q->nF)}))
            return -1;
    }
    q->w->couple = v3_madd(q->w->couple, side * q->dm * u, v3_cross(q->nF, q->nf));
    if (q->pull.x == 0.0 && q->pull.y == 0.0) return 0;
    const fl_vec3 pull = v3_madd(v3_scale(q->pull.x, q->at.x), q->pull.y, q->at.y);
    const fl_vec3 turn = v3_madd(v3_madd(v3_scale(q->turn.x, q->at.x), q->turn.y, q->at.y), q->turn.z, q->nf);
    q->w->couple = v3_madd(q->w->couple, -side * m, turn);
    const double size = v3_norm(pull);
    const fl_vec3 first = v3_madd(v3_madd(q->at.o, q->x0, q->at.x), q->y0, q->at.y);
    return fl_places_add(q->w, (fl_place){.du = m * size, .n = v3_scale(-side / size, pull), .p = first});
}

static int over_face(footprint *q, int32_t F, const fl_side *other, int32_t f, double behind,
                     double rim_width)
{
    const fl_poly *p = other->p;
    const int32_t sides = p->first[f + 1] - p->first[f];
    const double floor = q->R + behind + SAME * p->size;
    corner *buffer[4];
    double *g;
    /* axes that turn with f: which three places stand for the nodes hangs on them */
    const fl_vec3 o = other->v[p->loop[p->first[f]]],
                  x = v3_unit(v3_sub(other->v[p->loop[p->first[f] + 1]], o));
    q->at = (fl_across){o, x, v3_cross(q->nf, x)};
    int32_t n = lay(q, F, 2 * (int64_t)sides + 6, buffer, &g);
    if (n < 0) return -1;
    double most = -INFINITY, least = INFINITY;
    for (int32_t k = 0; k < n; k++) {
        most = buffer[0][k].s > most ? buffer[0][k].s : most;
        least = buffer[0][k].s < least ? buffer[0][k].s : least;
    }
    if (most <= 0.0 || least > floor) return 0;
    if (least < 0.0) {
        for (int32_t k = 0; k < n; k++) g[k] = buffer[0][k].s;
        n = cut(buffer[0], g, n, buffer[1]);
        swap_corners(&buffer[0], &buffer[1]);
    }
    if (most > floor) {
        for (int32_t k = 0; k < n; k++) g[k] = floor - buffer[0][k].s;
        n = cut(buffer[0], g, n, buffer[1]);
        swap_corners(&buffer[0], &buffer[1]);
    }
    corner *rim = buffer[3], *inner = rim + sides;
    lay_side(q, other, f, rim);
    for (int32_t c = 0; c < sides && n > 2; c++) {
        const corner a = rim[c], b = rim[c + 1 < sides ? c + 1 : 0];
        n = left_of(&buffer[0], &buffer[1], g, n, a.x, a.y, b.x, b.y);
    }
    if (n < 3) return 0;
    const double width = rim_width > 0.0 ? lay_rim(sides, rim_width, rim, inner) : 0.0;
    for (int32_t c = 0; c < sides && n > 2 && width > 0.0; c++) { /* what lies in the rim of side c */
        const int32_t d = c + 1 < sides ? c + 1 : 0;
        const corner a = rim[c], b = rim[d], ai = inner[c], bi = inner[d];
        int32_t m = n, reached = 0;
        for (int32_t k = 0; k < n; k++) /* by a corner nearer to the side than its rim is wide */
            reached |=
                (b.x - a.x) * (buffer[0][k].y - a.y) - (b.y - a.y) * (buffer[0][k].x - a.x) < width * a.s;
        if (!reached) continue;
        for (int32_t k = 0; k < n; k++) buffer[2][k] = buffer[0][k];
        m = left_of(&buffer[2], &buffer[1], g, m, bi.x, bi.y, ai.x, ai.y);
        if (m > 2) m = left_of(&buffer[2], &buffer[1], g, m, b.x, b.y, bi.x, bi.y);
        if (m > 2) m = left_of(&buffer[2], &buffer[1], g, m, ai.x, ai.y, a.x, a.y);
        const double k = 1.0 / (a.s * width);
        q->cx = -(b.y - a.y) * k, q->cy = (b.x - a.x) * k;
        q->c0 = -(q->cx * a.x + q->cy * a.y);
        if (m > 2) integrate(q, buffer[2], m);
    }
    q->c0 = 1.0, q->cx = q->cy = 0.0;
    for (int32_t c = 0; c < sides && n > 2 && width > 0.0; c++) {
        const corner a = inner[c], b = inner[c + 1 < sides ? c + 1 : 0];
        n = left_of(&buffer[0], &buffer[1], g, n, a.x, a.y, b.x, b.y);
    }
    if (n > 2) integrate(q, buffer[0], n);
    return 0;
}

/* m = (1 - 4 sin^2)^2 of the angle between the faces, and 0 beyond 30 degrees.  0 where there is nothing. */
static int turned(footprint *q)
{
    const double c = q->slope = -v3_dot(q->nf, q->nF), root = 4.0 * c * c - 3.0;
    q->m = q->half * root * root;
    q->dm = q->half * 16.0 * c * root;
    return c > 0.0 && root > 0.0;
}

int fl_areas_face(fl_places *w, const fl_side *own, int32_t F, const fl_side *other, int32_t f, double R,
                  double behind, double rim)
{
    footprint q = {.w = w, .own = own, .nf = other->n[f], .nF = own->n[F], .half = 0.5, .R = R, .c0 = 1.0};
    if (!turned(&q)) return 0;
    return over_face(&q, F, other, f, behind, rim) ? -1 : put(&q);
}

int fl_areas_plane(fl_places *w, const fl_side *own, int32_t F, double R)
{
    footprint q = {.w = w, .own = own, .nf = v3(0, 0, 1), .nF = own->n[F], .half = 1.0, .R = R, .c0 = 1.0};
    corner *buffer[4];
    double *g;
    if (!turned(&q)) return 0;
    q.at = (fl_across){v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0)};
    int32_t n = lay(&q, F, 1, buffer, &g);
    if (n < 0) return -1;
    for (int32_t k = 0; k < n; k++) g[k] = buffer[0][k].s;
    n = cut(buffer[0], g, n, buffer[1]);
    if (n > 2) integrate(&q, buffer[1], n);
    return put(&q);
}
