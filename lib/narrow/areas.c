/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/mem.h"
#include "narrow/areas.h"
#include "narrow/overlap.h"

/* Faces nearer to a right angle than this have no area over each other. */
#define LEVEL 1e-6
#define SAME 1e-13 /* of the size: how far below the other's plane still counts as on it */

/* Symmetric rule of degree 4: points (1 - 2a, a, a) and turns of it; weights of a triangle of area 1. */
static const double A4[2] = {0.44594849091596488632, 0.09157621350977074346};
static const double W4[2] = {0.22338158967801146570, 0.10995174365532186764};
/* The same of degree 5, and the middle with a weight of 9/40: for the rim, where the fade is linear. */
static const double A5[2] = {0.47014206410511508977, 0.10128650732345633880};
static const double W5[2] = {0.13239415278850618074, 0.12593918054482715260};
#define MIDDLE 0.225
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

/* Where the plane of f is, and F over it; and the sums over all nodes, relative to the corner `at` of the
 * first polygon: what is far away keeps its digits. */
typedef struct {
    fl_places *w;
    const fl_side *own;
    fl_across at; /* origin and axes in the plane of f */
    fl_vec3 nf, nF;
    double slope, half, R; /* -n_F.n_f; 1/2, or 1 for a plane */
    double c0, cx, cy;     /* fade, c0 + cx x + cy y */
    int begun;
    double x0, y0;              /* the first corner */
    double u, du, ddu, s, most; /* sums of u, its derivatives, du s; largest s */
    double x, y, xx, xy, yy;    /* sums of du x ... */
    fl_vec3 pull, turn;         /* of the rims: force, and moment about the first corner on the plane of f */
} footprint;

static fl_vec3 lift(const footprint *q, double x, double y, double s)
{
    const fl_vec3 o = v3_madd(q->at.o, q->R - s, q->nf);
    return v3_madd(v3_madd(o, x, q->at.x), y, q->at.y);
}

static void node(footprint *q, double x, double y, double s, double area)
{
    const double fade = q->c0 + q->cx * x + q->cy * y, k = area * fade, s2 = s * s;
    if (s <= 0.0 || fade <= 0.0) return;
    const double du = 4.0 * k * s2 * s;
    x -= q->x0, y -= q->y0;
    q->u += k * s2 * s2;
    q->du += du;
    q->ddu += 12.0 * k * s2;
    q->s += du * s;
    q->x += du * x;
    q->y += du * y;
    q->xx += du * x * x;
    q->xy += du * x * y;
    q->yy += du * y * y;
    if (s > q->most) q->most = s;
}

static void triangle(footprint *q, corner a, corner b, corner c)
{
    const double area = 0.5 * fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    const corner t[3] = {a, b, c};
    if (area == 0.0) return;
    const int flat = q->cx == 0.0 && q->cy == 0.0;
    const double *at = flat ? A4 : A5, *weight = flat ? W4 : W5;
    for (int k = 0; k < 3; k++) {
        const corner p = t[k], r = t[(k + 1) % 3], l = t[(k + 2) % 3];
        for (int rule = 0; rule < 2; rule++) {
            const double m = at[rule], o = 1.0 - 2.0 * m;
            node(q, o * p.x + m * (r.x + l.x), o * p.y + m * (r.y + l.y), o * p.s + m * (r.s + l.s),
                 weight[rule] * area);
        }
    }
    if (!flat)
        node(q, (a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0, (a.s + b.s + c.s) / 3.0, MIDDLE * area);
}

/* Moving F outward over its own rim a b makes the area larger: the gradient of that. */
static void rim(footprint *q, corner a, corner b, double turn)
{
    const double ex = b.x - a.x, ey = b.y - a.y, length = sqrt(ex * ex + ey * ey);
    if (length == 0.0) return;
    const fl_vec3 out = v3_scale(turn / length, v3_sub(v3_scale(ey, q->at.x), v3_scale(ex, q->at.y)));
    for (int k = 0; k < 3; k++) {
        const double t = GAUSS[k], s = a.s + t * (b.s - a.s), s2 = s * s;
        const double x = a.x + t * ex, y = a.y + t * ey, fade = q->c0 + q->cx * x + q->cy * y;
        if (s <= 0.0 || fade <= 0.0) continue;
        const fl_vec3 f = v3_scale(GAUSS_WEIGHT[k] * length * fade * s2 * s2, out);
        fl_vec3 arm = v3_scale(q->R - s, q->nf);
        arm = v3_madd(v3_madd(arm, x - q->x0, q->at.x), y - q->y0, q->at.y);
        q->pull = v3_add(q->pull, f);
        q->turn = v3_add(q->turn, v3_cross(arm, f));
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
        twice += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        triangle(q, a, b, c);
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

/* The corners of face f in its plane, rim[sides], and `inner`, those moved inward by the width of the rim,
 * which is at most `width` and leaves every side half its length.  Returns that width. */
static double lay_rim(const footprint *q, const fl_side *other, int32_t f, double width, corner *rim,
                      corner *inner)
{
    const fl_poly *p = other->p;
    const int32_t *loop = p->loop + p->first[f], sides = p->first[f + 1] - p->first[f];
    for (int32_t c = 0; c < sides; c++) {
        const fl_vec3 r = v3_sub(other->v[loop[c]], q->at.o);
        rim[c] = (corner){.x = v3_dot(q->at.x, r), .y = v3_dot(q->at.y, r)};
    }
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
 * same force, torque and spread.  They get the factor m = slope^2, by which a face fades out that is seen
 * ever more from the side; dm has a couple.  Then the pull of the rims. */
static int put(const footprint *q)
{
    static const double COS[3] = {1.0, -0.5, -0.5}, SIN[3] = {0.0, 0.86602540378443865, -0.86602540378443865};
    const double m = q->half * q->slope * q->slope, side = q->own->side;
    if (!(q->du > 0.0)) return 0;
    const double x = q->x / q->du, y = q->y / q->du, s = q->s / q->du;
    const double xx = q->xx / q->du - x * x, xy = q->xy / q->du - x * y, yy = q->yy / q->du - y * y;
    const double a = xx > 0.0 ? sqrt(2.0 * xx) : 0.0, b = a > 0.0 ? 2.0 * xy / a : 0.0, c2 = 2.0 * yy - b * b,
                 c = c2 > 0.0 ? sqrt(c2) : 0.0;
    /* s over F */
    const double sx = -v3_dot(q->nF, q->at.x) / q->slope, sy = -v3_dot(q->nF, q->at.y) / q->slope;
    for (int k = 0; k < 3; k++) {
        const double dx = a * COS[k], dy = b * COS[k] + c * SIN[k], sk = s + sx * dx + sy * dy;
        const fl_vec3 on = lift(q, q->x0 + x + dx, q->y0 + y + dy, sk);
        if (fl_places_add(q->w, (fl_place){.overlap = q->most,
                                           .u = m * q->u / 3.0,
                                           .du = m * q->du / 3.0,
                                           .ddu = m * q->ddu / 3.0,
                                           .n = v3_scale(-side / q->slope, q->nF),
                                           .across = v3_scale(side, q->nf),
                                           .p = v3_madd(on, q->own->r - 0.5 * sk, q->nF)}))
            return -1;
    }
    q->w->couple = v3_madd(q->w->couple, 2.0 * side * q->half * q->slope * q->u, v3_cross(q->nF, q->nf));
    const double pull = v3_norm(q->pull);
    if (pull == 0.0) return 0;
    q->w->couple = v3_madd(q->w->couple, -side * m, q->turn);
    const fl_vec3 first = v3_madd(v3_madd(q->at.o, q->x0, q->at.x), q->y0, q->at.y);
    return fl_places_add(q->w, (fl_place){.du = m * pull, .n = v3_scale(-side / pull, q->pull), .p = first});
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
    const double width = lay_rim(q, other, f, rim_width, rim, inner);
    for (int32_t c = 0; c < sides && n > 2; c++) {
        const corner a = rim[c], b = rim[c + 1 < sides ? c + 1 : 0];
        n = left_of(&buffer[0], &buffer[1], g, n, a.x, a.y, b.x, b.y);
    }
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

int fl_areas_face(fl_places *w, const fl_side *own, int32_t F, const fl_side *other, int32_t f, double R,
                  double behind, double rim)
{
    footprint q = {.w = w, .own = own, .nf = other->n[f], .nF = own->n[F], .half = 0.5, .R = R, .c0 = 1.0};
    q.slope = -v3_dot(q.nf, q.nF);
    return q.slope < LEVEL || !over_face(&q, F, other, f, behind, rim) ? put(&q) : -1;
}

int fl_areas_plane(fl_places *w, const fl_side *own, int32_t F, double R)
{
    footprint q = {.w = w, .own = own, .nf = v3(0, 0, 1), .nF = own->n[F], .half = 1.0, .R = R, .c0 = 1.0};
    corner *buffer[4];
    double *g;
    q.slope = -q.nF.z;
    if (q.slope < LEVEL) return 0;
    q.at = (fl_across){v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0)};
    int32_t n = lay(&q, F, 1, buffer, &g);
    if (n < 0) return -1;
    for (int32_t k = 0; k < n; k++) g[k] = buffer[0][k].s;
    n = cut(buffer[0], g, n, buffer[1]);
    if (n > 2) integrate(&q, buffer[1], n);
    return put(&q);
}
