/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/cone_face.h"
#include <math.h>
#include "base/array.h"
#include "patch/face_integral.h"
#include "patch/cone_sum.h"
#include "geom/quadrature_rules.h"
#include "patch/cone_side.h"

/* Panels of Gauss' rule where the side alone is not nearest. */
enum { PANELS = 4 };

/* A face at right angles to the axis within this angle has no row direction of its own, and panels shorter
 * than this part of the face are skipped: both are rounding. */
#define FLAT_TOL 1e-12
/* A row that crosses its middle and extends farther than this on both sides, over the distance from the axis,
 * is integrated in two halves: the distance has a branch point that far from the real axis. */
#define WIDE_ROW 0.3

/* The sum over F: x = level n + x ex + y ey, ey at right angles to the axis. */
typedef struct {
    const fl_cone_profile *c;
    const fl_patch_core *A;
    int32_t F;
    fl_vec3 n, ex, ey;
    double level;
    const fl_vec3 *corner; /* x and y */
    int32_t corners;
    fl_cone_profile_line axis; /* of y = 0, over x */
    fl_cone_sums sum;
} face_sum;

/* Adds one node of F with its area. */
static void add_point(face_sum *q, double x, double y, double area)
{
    const fl_cone_profile *c = q->c;
    const fl_vec3 at = v3_madd(v3_madd(v3_scale(q->level, q->n), x, q->ex), y, q->ey);
    const double rho = sqrt(at.x * at.x + at.y * at.y);
    const fl_cone_profile_field d = fl_cone_profile_distance(c, rho, at.z);
    const double s = c->R - d.d;
    const fl_vec3 er = fl_cone_radial_direction(at, rho), n = v3(d.mr * er.x, d.mr * er.y, d.mz);
    const double cosine = -v3_dot(q->n, n), root = 4.0 * cosine * cosine - 3.0;
    if (!(s > 0.0) || !(cosine > 0.0) || !(root > 0.0)) return;
    const double s2 = s * s, m = area * root * root, bend = area * 16.0 * cosine * root * s2 * s2;
    fl_cone_sum_add(&q->sum, at, n, s, m * s2 * s2, 4.0 * m * s2 * s, 12.0 * m * s2);
    const fl_vec3 e = v3(-er.y, er.x, 0);
    const double round = v3_dot(e, q->n);
    fl_vec3 pull = v3_scale(rho > 0.0 ? bend * d.mr / rho * round : 0.0, e);
    if (d.rim > 0.0) pull = v3_madd(pull, bend * d.rim, v3_madd(v3_madd(q->n, cosine, n), -round, e));
    q->sum.f = v3_add(q->sum.f, pull);
    q->sum.m = v3_add(q->sum.m, v3_cross(v3_sub(at, q->sum.o), pull));
    q->sum.couple = v3_madd(q->sum.couple, bend, v3_cross(q->n, n));
}

/* The part of the row at x inside F. */
static void clip_row(const face_sum *q, double x, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (int32_t k = 0; k < q->corners; k++) {
        const fl_vec3 a = q->corner[k], b = q->corner[k + 1 < q->corners ? k + 1 : 0];
        if ((a.x <= x) == (b.x <= x)) continue;
        const double y = a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y);
        *lo = y < *lo ? y : *lo;
        *hi = y > *hi ? y : *hi;
    }
}

typedef struct {
    const face_sum *q;
    double x;
} row_line;

/* Zone of the point at y plus 1; 0 where the face term is 0. */
static int zone_on_row(const void *what, double y)
{
    const row_line *r = what;
    const face_sum *q = r->q;
    const fl_vec3 at = v3_madd(v3_madd(v3_scale(q->level, q->n), r->x, q->ex), y, q->ey);
    const double rho = sqrt(at.x * at.x + at.y * at.y);
    const fl_cone_profile_field d = fl_cone_profile_distance(q->c, rho, at.z);
    const fl_vec3 er = fl_cone_radial_direction(at, rho);
    const double cosine = -(d.mr * (q->n.x * er.x + q->n.y * er.y) + d.mz * q->n.z);
    return cosine > FL_FACE_PAIR_COSINE ? 1 + d.zone : 0;
}

/* Rows beside the slant side.
 *
 * With b the point of the row nearest to the axis, K = b.n_F, L = b.ex, T = ez.ex,
 *     n = (nr K q + nz nFz) n_F + (nr L q + nz T) ex + nr q y ey,     c = -n.n_F,
 *     e = ez x er = T y q n_F - nFz y q ex + (nFz L - T K) q ey,
 * so the sums of add_point() follow from the sums of cone_side.h. */

/* Adds the row at x from y = lo to hi; K and L as above. */
static void add_row_sums(face_sum *q, double x, const fl_cone_side_row *p, double K, double L)
{
    const double nr = q->c->nr, nz = q->c->nz, T = q->ex.z, nFz = q->n.z;
    const double X = v3_dot(q->ex, v3_madd(v3_sub(v3_scale(q->level, q->n), q->sum.o), x, q->ex));
    fl_cone_sums *t = &q->sum;
    fl_cone_side_row_sums r;
    fl_cone_side_sum_row(p, &r);
    t->u += r.u, t->du += r.du, t->ddu += r.ddu, t->ds += r.ds;
    t->most = r.most > t->most ? r.most : t->most;
    t->sx += X * r.du, t->sxx += X * X * r.du;
    t->sy += r.dy, t->sxy += X * r.dy, t->syy += r.dyy;
    /* force along n_F, ex and ey, and its moments in y */
    const double fn = nr * (K * r.dq + T * T * r.kyy) + nz * nFz * r.du;
    const double fx = nr * (L * r.dq - T * nFz * r.kyy) + nz * T * r.du;
    const double fy = nr * (r.dqy + T * (nFz * L - T * K) * r.ky);
    const double fny = nr * (K * r.dqy + T * T * r.kyyy) + nz * nFz * r.dy;
    const double fxy = nr * (L * r.dqy - T * nFz * r.kyyy) + nz * T * r.dy;
    t->f = v3_madd(v3_madd(v3_madd(t->f, fn, q->n), fx, q->ex), fy, q->ey);
    t->m = v3_madd(v3_madd(v3_madd(t->m, X * fy - fxy, q->n), fny, q->ex), -X * fn, q->ey);
    t->couple = v3_madd(v3_madd(t->couple, nr * L * r.kq + nz * T * r.k, q->ey), -nr * r.kqy, q->ex);
}

/* Adds the part of a row where the side is nearest and faces F: c is monotonic in |y|.  0 where that is not
 * certain. */
static int add_side_row(face_sum *q, double x, double z, double h2, double lo, double hi, double width)
{
    const fl_cone_profile *c = q->c;
    const double h = sqrt(h2), out = c->nr * (h - c->r0) + c->nz * z;
    if (!(out > -z && out > z - c->h)) return 0; /* inside the cone an end may be nearer */
    const fl_vec3 b = v3_madd(v3_scale(q->level, q->n), x, q->ex);
    const double K = b.x * q->n.x + b.y * q->n.y, L = b.x * q->ex.x + b.y * q->ex.y;
    fl_cone_side_row p = {.h2 = h2,
                          .s0 = c->R - c->nz * z + c->nr * c->r0,
                          .nr = c->nr,
                          .c0 = -c->nz * q->n.z,
                          .ck = c->nr * K,
                          .lo = lo,
                          .hi = hi,
                          .area = width};
    const double need = FL_FACE_PAIR_COSINE - p.c0, far = lo < 0.0 ? fmax(-lo, hi) : hi,
                 near = lo > 0.0   ? lo
                        : hi < 0.0 ? -hi
                                   : 0.0;
    const int at_near = -p.ck > need * sqrt(h2 + near * near), at_far = -p.ck > need * sqrt(h2 + far * far);
    if (!at_near && !at_far) return 1;
    if (at_near && at_far && !(lo < 0.0 && hi > 0.0 && far * far > WIDE_ROW * WIDE_ROW * h2)) {
        add_row_sums(q, x, &p, K, L);
        return 1;
    }
    /* rho is singular h from the middle of a row: integrate each half */
    const double rho = -p.ck / need, y = at_near && at_far ? far : sqrt(fmax(rho * rho - h2, 0.0));
    for (int half = 0; half < 2; half++) {
        const double from = at_near ? (half ? 0.0 : -y)
                            : half  ? y
                                    : -INFINITY,
                     to = at_near ? (half ? y : 0.0)
                          : half  ? INFINITY
                                  : -y;
        p.lo = from > lo ? from : lo, p.hi = to < hi ? to : hi;
        if (p.lo < p.hi) add_row_sums(q, x, &p, K, L);
    }
    return 1;
}

static void add_any_row(face_sum *q, double x, double width, int side)
{
    const fl_cone_profile_line *l = &q->axis;
    const double z = l->z0 + x * l->dz, p = fl_cone_profile_radius(q->c, z),
                 h2 = l->a + x * (2.0 * l->b + x * l->g);
    double lo, hi;
    fl_cone_intervals parts;
    if (!(p > 0.0) || !(p * p > h2)) return;
    const double far = sqrt(p * p - h2);
    clip_row(q, x, &lo, &hi);
    lo = lo > -far ? lo : -far;
    hi = hi < far ? hi : far;
    if (!(lo < hi)) return;
    if (side && add_side_row(q, x, z, h2 > 0.0 ? h2 : 0.0, lo, hi, width)) return;
    const row_line r = {q, x};
    fl_cone_split_interval(&parts, zone_on_row, &r, 0.0, far); /* zones depend on |y| alone */
    if (parts.n == 1) {
        for (int k = 0; k < FL_LINE10_NODES && parts.s[0].zone; k++)
            add_point(q, x, lo + FL_LINE10_NODE[k] * (hi - lo), width * FL_LINE10_WEIGHT[k] * (hi - lo));
        return;
    }
    for (int half = 0; half < 2; half++) {
        for (int s = 0; s < parts.n; s++) {
            double from = half ? parts.s[s].from : -parts.s[s].to,
                   to = half ? parts.s[s].to : -parts.s[s].from;
            from = from > lo ? from : lo;
            to = to < hi ? to : hi;
            for (int k = 0; k < FL_LINE_NODES && parts.s[s].zone && from < to; k++)
                add_point(q, x, from + FL_LINE_NODE[k] * (to - from),
                          width * FL_LINE_WEIGHT[k] * (to - from));
        }
    }
}

/* True if the side is nearest to all points outside the cone, for x from lo to hi. */
static int side_is_nearest(const face_sum *q, double lo, double hi)
{
    const fl_cone_profile *c = q->c;
    const double za = q->axis.z0 + lo * q->axis.dz, zb = q->axis.z0 + hi * q->axis.dz;
    const double far = c->R * fabs(c->nz);
    return fmin(za, zb) >= far && fmax(za, zb) <= c->h - far;
}

/* True if no part of F within reach faces the side and the ends are out of reach. */
static int no_part_faces(const face_sum *q, double lo, double hi)
{
    const fl_cone_profile *c = q->c;
    if (!side_is_nearest(q, lo, hi)) return 0;
    const double most = c->nr * sqrt(fmax(1.0 - q->n.z * q->n.z, 0.0)) - c->nz * q->n.z;
    return most <= FL_FACE_PAIR_COSINE;
}

/* The same from the plane of F alone:
 *     c rho = -nr n_F.b - nz nFz rho,   n_F.b = level - nFz z. */
static int plane_faces_away(const fl_cone_profile *c, fl_vec3 n, double level, double low, double high)
{
    const double far = c->R * fabs(c->nz), K0 = level - n.z * low, K1 = level - n.z * high;
    return low >= far && high <= c->h - far && -c->nz * n.z <= FL_FACE_PAIR_COSINE && K0 >= 0.0 && K1 >= 0.0;
}

/* Where a line in F begins or ends to face the side, in (0, 1): the zeros of
 *     c = c0 - nr (level - nFz z)/rho = FL_FACE_PAIR_COSINE,
 * squared.  Returns how many. */
static int facing_limits(const face_sum *q, const fl_cone_profile_line *l, double t[2])
{
    const fl_cone_profile *c = q->c;
    const double need = FL_FACE_PAIR_COSINE + c->nz * q->n.z, k0 = c->nr * (q->n.z * l->z0 - q->level),
                 k1 = c->nr * q->n.z * l->dz, A = k1 * k1 - need * need * l->g,
                 B = k0 * k1 - need * need * l->b, C = k0 * k0 - need * need * l->a, left = B * B - A * C;
    int n = 0;
    if (!(left > 0.0)) return 0;
    const double e = -B - copysign(sqrt(left), B), at[2] = {e / A, C / e};
    for (int k = 0; k < 2; k++)
        if (at[k] > 0.0 && at[k] < 1.0) t[n++] = at[k];
    return n;
}

int fl_cone_face_evaluate(fl_patch_points *w, const fl_patch_core *A, int32_t F, const fl_cone_profile *c)
{
    const fl_poly *p = A->p;
    const int32_t *loop = p->loop + p->first[F], n = p->first[F + 1] - p->first[F];
    face_sum q = {.c = c, .A = A, .F = F, .n = A->n[F]};
    const fl_vec3 tilt = v3_madd(v3(0, 0, 1), -q.n.z, q.n);
    double lo = INFINITY, hi = -INFINITY, low = INFINITY, high = -INFINITY;
    int zero[2];
    for (int32_t k = 0; k < n; k++) {
        const double z = A->v[loop[k]].z;
        low = z < low ? z : low;
        high = z > high ? z : high;
    }
    q.level = v3_dot(q.n, A->v[loop[0]]);
    if (low >= c->h + c->R || high <= -c->R || plane_faces_away(c, q.n, q.level, low, high)) return 0;
    /* corners, and limits of rows: five a side of F, four breaks, two ends */
    if (fl_reserve(&w->polygon, &w->polygon_cap, n + (5 * n + 6) / 3 + 1, sizeof *w->polygon)) return -1;
    double *at = (double *)(w->polygon + n);
    low = INFINITY, high = -INFINITY;
    q.ex = v3_norm(tilt) > FLAT_TOL ? v3_unit(tilt) : v3_normal_to(q.n);
    q.ey = v3_cross(q.n, q.ex);
    for (int32_t k = 0; k < n; k++) {
        const double x = v3_dot(q.ex, A->v[loop[k]]), y = v3_dot(q.ey, A->v[loop[k]]);
        w->polygon[k] = v3(x, y, 0);
        lo = x < lo ? x : lo;
        hi = x > hi ? x : hi;
        low = y < low ? y : low;
        high = y > high ? y : high;
    }
    q.corner = w->polygon;
    q.corners = n;
    const fl_vec3 from = v3_scale(q.level, q.n); /* of the line y = 0 */
    q.axis = (fl_cone_profile_line){from.z, q.ex.z, from.x * from.x + from.y * from.y,
                                    from.x * q.ex.x + from.y * q.ex.y, q.ex.x * q.ex.x + q.ex.y * q.ex.y};
    const double wide = fmax(c->r0, c->r1) + c->R, near = fmax(low, -high);
    if (near > 0.0 && near * near >= wide * wide) return 0;
    if (no_part_faces(&q, lo, hi) || !fl_cone_profile_clip(c, &q.axis, &lo, &hi, zero)) return 0;
    if (near > 0.0 && near * near + fl_cone_line_min_radius2(&q.axis, lo, hi) >= wide * wide) return 0;
    q.sum.o = v3_madd(from, 0.5 * (lo + hi), q.ex);
    q.sum.x = q.ex, q.sum.y = q.ey;
    int32_t breaks = fl_cone_profile_breaks(c, &q.axis, lo, hi, at);
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 a = q.corner[k], b = q.corner[k + 1 < n ? k + 1 : 0];
        if (a.x > lo && a.x < hi) at[breaks++] = a.x;
        /* where the border of F enters and leaves the dilated cone */
        const fl_vec3 v = A->v[loop[k]], u = v3_sub(A->v[loop[k + 1 < n ? k + 1 : 0]], v);
        const fl_cone_profile_line l = fl_cone_profile_line_of(v, u);
        double t[2];
        for (int e = facing_limits(&q, &l, t); e-- > 0;) {
            const double x = a.x + t[e] * (b.x - a.x);
            if (x > lo && x < hi) at[breaks++] = x;
        }
        t[0] = 0.0, t[1] = 1.0;
        int is_end[2];
        if (!fl_cone_profile_clip(c, &l, &t[0], &t[1], is_end)) continue;
        for (int e = 0; e < 2; e++) {
            const double x = a.x + t[e] * (b.x - a.x);
            if (is_end[e] && x > lo && x < hi) at[breaks++] = x;
        }
    }
    at[breaks++] = lo, at[breaks++] = hi;
    fl_cone_sort_ascending(at, breaks);
    if (side_is_nearest(&q, lo, hi)) {
        double room[3];
        for (int k = 0; k < 3; k++) {
            const double x = lo + 0.5 * k * (hi - lo),
                         rim = fl_cone_profile_radius(c, q.axis.z0 + x * q.axis.dz);
            room[k] = rim - sqrt(fmax(q.axis.a + x * (2.0 * q.axis.b + x * q.axis.g), 0.0));
        }
        fl_cone_mark_zero_ends(room, zero);
    }
    for (int32_t b = 0; b + 1 < breaks; b++) {
        const int ends[2] = {zero[0] && b == 0, zero[1] && b + 2 == breaks};
        const double x0 = at[b], width = at[b + 1] - x0;
        const int side = side_is_nearest(&q, x0, at[b + 1]), panels = side ? 1 : PANELS;
        if (!(width > FLAT_TOL * (hi - lo))) continue;
        for (int k = 0; k < panels * FL_LINE10_NODES; k++) {
            double t;
            const double u = (k / FL_LINE10_NODES + FL_LINE10_NODE[k % FL_LINE10_NODES]) / panels,
                         dt = fl_cone_cluster_node(u, ends, &t);
            add_any_row(&q, x0 + t * width, FL_LINE10_WEIGHT[k % FL_LINE10_NODES] / panels * dt * width,
                        side);
        }
    }
    return fl_cone_sum_to_points(w, &q.sum, 3, A->r);
}
