/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "narrow/frustum.h"
#include <math.h>
#include "base/mem.h"
#include "narrow/areas.h"
#include "narrow/nearest.h"
#include "narrow/rules.h"
#include "narrow/slant.h"
#include "narrow/strips.h"

/* Halvings in search of where s ends: the length of a double. */
enum { HALVINGS = 45, SEARCHES = 60, GOLDEN_STEPS = 40, BREAKS = 192, STRETCHES = 12, LOOKS = 2, PANELS = 4 };

/* A face or an edge that is not that much of its size long, across the axis, has no direction there. */
#define SMALL 1e-12
/* An edge that reaches farther than this from the point nearest to the axis, in distances from there, goes in
 * pieces that grow with the way from it: the distance has a branch point so far beside it. */
#define CLOSE 0.25
/* And a row that crosses the middle and reaches farther than this on both sides, in two halves. */
#define WIDE 0.3
/* An end with less of the overlap than this part of the largest is one where it is nothing. */
#define NEARLY 0.3

double fl_frustum_reach(const fl_frustum *c, fl_vec3 n)
{
    const double across = sqrt(n.x * n.x + n.y * n.y);
    return fmax(across * c->r0, n.z * c->h + across * c->r1);
}

/* The frustum in its half-plane (rho, z): normal and length of the slant side. */
typedef struct {
    double r0, r1, h, R;
    double nr, nz, length;
} shape;

static shape shape_of(const fl_frustum *c, double R)
{
    const double length = sqrt(c->h * c->h + (c->r1 - c->r0) * (c->r1 - c->r0));
    return (shape){c->r0, c->r1, c->h, R, c->h / length, (c->r0 - c->r1) / length, length};
}

/* Distance from it, its gradient (mr, mz), and 1/d where a rim is nearest, else 0. */
typedef struct {
    double d, mr, mz, rim;
    int zone; /* what is nearest */
} field;

enum { SIDE, LOW_END, HIGH_END, LOW_RIM, HIGH_RIM };

static field rim_at(double rho, double z, int zone)
{
    const double d = sqrt(rho * rho + z * z), over = d > 0.0 ? 1.0 / d : 0.0;
    return (field){d, d > 0.0 ? rho * over : 1.0, z * over, over, zone};
}

static field field_at(const shape *c, double rho, double z)
{
    const double out = c->nr * (rho - c->r0) + c->nz * z, along = c->nr * z - c->nz * (rho - c->r0);
    if (out <= 0.0 && z >= 0.0 && z <= c->h) { /* inside: out by the nearest side */
        if (out >= -z && out >= z - c->h) return (field){out, c->nr, c->nz, 0.0, SIDE};
        return -z > z - c->h ? (field){-z, 0.0, -1.0, 0.0, LOW_END}
                             : (field){z - c->h, 0.0, 1.0, 0.0, HIGH_END};
    }
    if (out > 0.0 && along >= 0.0 && along <= c->length) return (field){out, c->nr, c->nz, 0.0, SIDE};
    if (z < 0.0 && rho <= c->r0) return (field){-z, 0.0, -1.0, 0.0, LOW_END};
    if (z > c->h && rho <= c->r1) return (field){z - c->h, 0.0, 1.0, 0.0, HIGH_END};
    return 2.0 * along < c->length ? rim_at(rho - c->r0, z, LOW_RIM)
                                   : rim_at(rho - c->r1, z - c->h, HIGH_RIM);
}

/* Radius of the dilated frustum at height z; negative where there is none. */
static double profile(const shape *c, double z)
{
    const double on = z - c->R * c->nz;
    if (on >= 0.0 && on <= c->h) return c->r0 + on / c->h * (c->r1 - c->r0) + c->R * c->nr;
    const double up = on < 0.0 ? z : z - c->h, left = c->R * c->R - up * up;
    return left > 0.0 ? (on < 0.0 ? c->r0 : c->r1) + sqrt(left) : -1.0;
}

/* A line at z0 + t dz whose squared distance from the axis is a + 2 b t + g t^2. */
typedef struct {
    double z0, dz, a, b, g;
} line;

static line line_of(fl_vec3 a, fl_vec3 u)
{
    return (line){a.z, u.z, a.x * a.x + a.y * a.y, a.x * u.x + a.y * u.y, u.x * u.x + u.y * u.y};
}

/* > 0 inside the dilated frustum; concave in t. */
static double depth(const shape *c, const line *l, double t)
{
    const double p = profile(c, l->z0 + t * l->dz), rho2 = l->a + t * (2.0 * l->b + t * l->g);
    return p < 0.0 ? p - fabs(l->z0 + t * l->dz - 0.5 * c->h) : p - sqrt(rho2 > 0.0 ? rho2 : 0.0);
}

/* Where depth ends between a point with and one without: false position that halves the value of an end which
 * stays (Illinois), and its last point inside. */
static double end_of(const shape *c, const line *l, double in, double out)
{
    double fi = depth(c, l, in), fo = depth(c, l, out);
    const double same = 4e-16 * (fabs(in) + fabs(out));
    for (int k = 0, side = 0; k < SEARCHES && fabs(in - out) > same; k++) {
        double t = in - fi * (out - in) / (fo - fi);
        if (k % 4 == 3 || (in < out ? !(t > in && t < out) : !(t < in && t > out))) t = 0.5 * (in + out);
        const double f = depth(c, l, t);
        if (f == 0.0) return t;
        if (f > 0.0) {
            in = t, fi = f;
            if (side > 0) fo *= 0.5;
            side = 1;
        } else {
            out = t, fo = f;
            if (side < 0) fi *= 0.5;
            side = -1;
        }
    }
    return in;
}

/* The same where the side alone is in reach of [lo, hi], so that p(t)^2 - rho(t)^2 is A t^2 + 2 B t + C: what
 * is inside lies between its zeros.  -1 where it may not. */
static int inside_side(const shape *c, const line *l, double *lo, double *hi, int zero[2])
{
    const double up = c->R * c->nz, z0 = l->z0 + *lo * l->dz - up, z1 = l->z0 + *hi * l->dz - up;
    if (!(fmin(z0, z1) >= 0.0 && fmax(z0, z1) <= c->h)) return -1;
    const double grow = (c->r1 - c->r0) / c->h, p0 = c->r0 + (l->z0 - up) * grow + c->R * c->nr,
                 p1 = grow * l->dz;
    const double A = p1 * p1 - l->g, B = p0 * p1 - l->b, C = p0 * p0 - l->a, left = B * B - A * C;
    if (!(A < 0.0)) return -1;
    if (!(left > 0.0)) return 0;
    const double q = -B - copysign(sqrt(left), B), t0 = q / A, t1 = C / q;
    const double from = t0 < t1 ? t0 : t1, to = t0 < t1 ? t1 : t0;
    zero[0] = from > *lo, zero[1] = to < *hi;
    if (zero[0]) *lo = from;
    if (zero[1]) *hi = to;
    return *lo < *hi;
}

/* Keep of [lo, hi] what is inside; zero[] tells which ends are where s ends.  0 when nothing is left. */
static int inside(const shape *c, const line *l, double *lo, double *hi, int zero[2])
{
    const double ratio = 0.61803398874989485, z0 = l->z0 + *lo * l->dz, z1 = l->z0 + *hi * l->dz;
    const double wide = fmax(c->r0, c->r1) + c->R;
    double a = *lo, b = *hi, in = l->g > 0.0 ? -l->b / l->g : a; /* nearest to the axis */
    in = in < a ? a : in > b ? b : in;
    if (fmin(z0, z1) >= c->h + c->R || fmax(z0, z1) <= -c->R) return 0;
    if (l->a + in * (2.0 * l->b + in * l->g) >= wide * wide) return 0;
    const int known = inside_side(c, l, lo, hi, zero);
    if (known >= 0) return known;
    const int lo_in = depth(c, l, a) > 0.0, hi_in = depth(c, l, b) > 0.0;
    zero[0] = !lo_in, zero[1] = !hi_in;
    if (lo_in && hi_in) return 1;
    if (lo_in) in = a;
    else if (hi_in) in = b;
    else if (!(depth(c, l, in) > 0.0)) {
        if (c->nz == 0.0 && fmin(z0, z1) >= 0.0 && fmax(z0, z1) <= c->h) return 0; /* it is the deepest */
        double x = b - ratio * (b - a), y = a + ratio * (b - a), fx = depth(c, l, x), fy = depth(c, l, y);
        for (int k = 0; k < GOLDEN_STEPS && fx <= 0.0 && fy <= 0.0; k++) {
            if (fx > fy) b = y, y = x, fy = fx, x = b - ratio * (b - a), fx = depth(c, l, x);
            else a = x, x = y, fx = fy, y = a + ratio * (b - a), fy = depth(c, l, y);
        }
        if (fx <= 0.0 && fy <= 0.0) return 0;
        in = fx > 0.0 ? x : y;
    }
    if (!lo_in) *lo = end_of(c, l, in, *lo);
    if (!hi_in) *hi = end_of(c, l, in, *hi);
    return *lo < *hi;
}

/* --- what changes along a line ----------------------------------------------------------------------------
 */

typedef struct {
    double from, to;
    int zone;
} stretch;

typedef struct {
    stretch s[STRETCHES];
    int n;
} stretches;

/* Cut [lo, hi] where the zone changes, also where several zones follow closely. */
static void cut_zones(stretches *out, int (*zone)(const void *, double), const void *what, double lo,
                      double hi)
{
    double t = lo, in = lo;
    int at = zone(what, lo);
    out->n = 0;
    for (int k = 1; k <= LOOKS; k++) {
        const double to = lo + (hi - lo) * k / LOOKS;
        const int then = zone(what, to);
        while (then != at && out->n + 2 < STRETCHES) {
            double beyond = to;
            for (int m = 0; m < HALVINGS; m++) {
                const double mid = 0.5 * (in + beyond);
                if (zone(what, mid) == at) in = mid;
                else beyond = mid;
            }
            if (beyond > t) out->s[out->n++] = (stretch){t, beyond, at};
            t = in = beyond;
            at = zone(what, beyond);
        }
        in = to;
    }
    if (hi > t) out->s[out->n++] = (stretch){t, hi, at};
}

/* Where a rule has its nodes: u of [0, 1], bunched towards an end where s is 0 so that its power has no root
 * there.  Returns dt/du. */
static double bunch(double u, const int zero[2], double *t)
{
    if (zero[0] && zero[1]) {
        *t = u * u * (3.0 - 2.0 * u);
        return 6.0 * u * (1.0 - u);
    }
    if (zero[0]) {
        *t = u * u;
        return 2.0 * u;
    }
    if (zero[1]) {
        *t = u * (2.0 - u);
        return 2.0 * (1.0 - u);
    }
    *t = u;
    return 1.0;
}

/* What is summed over a face or an edge: u and its derivatives; the force, its moment about o, and the
 * couple; places weighed by du, along x and y. */
typedef struct {
    fl_vec3 o, x, y;
    double u, du, ddu, most, ds, sx, sy, sxx, sxy, syy;
    fl_vec3 f, m, couple;
} sums;

static void add(sums *q, fl_vec3 at, fl_vec3 n, double s, double u, double du, double ddu)
{
    const fl_vec3 r = v3_sub(at, q->o), f = v3_scale(du, n);
    const double x = v3_dot(q->x, r), y = v3_dot(q->y, r);
    q->u += u, q->du += du, q->ddu += ddu;
    q->most = s > q->most ? s : q->most;
    q->ds += du * s;
    q->sx += du * x, q->sy += du * y;
    q->sxx += du * x * x, q->sxy += du * x * y, q->syy += du * y * y;
    q->f = v3_add(q->f, f);
    q->m = v3_add(q->m, v3_cross(r, f));
}

/* n places with the force of all; what they lack of its moment goes to the couple.  n = 3: spread as a
 * pressure on a face, 2: as one along x. */
static int put(fl_places *w, const sums *q, int n, double ra)
{
    static const double COS[3] = {1.0, -0.5, -0.5}, SIN[3] = {0.0, 0.86602540378443865, -0.86602540378443865};
    const double size = v3_norm(q->f);
    if (!(q->du > 0.0) || !(size > 0.0)) return 0;
    const double x = q->sx / q->du, y = q->sy / q->du, s = q->ds / q->du;
    const double xx = q->sxx / q->du - x * x, xy = q->sxy / q->du - x * y, yy = q->syy / q->du - y * y;
    const double a = xx > 0.0 ? sqrt((n == 3 ? 2.0 : 1.0) * xx) : 0.0,
                 b = a > 0.0 && n == 3 ? 2.0 * xy / a : 0.0;
    const double c2 = n == 3 ? 2.0 * yy - b * b : 0.0, c = c2 > 0.0 ? sqrt(c2) : 0.0;
    const fl_vec3 across = v3_scale(1.0 / size, q->f);
    const fl_vec3 middle = v3_add(q->o, v3_add(v3_scale(x, q->x), v3_scale(y, q->y)));
    const fl_vec3 at = v3_madd(middle, 0.5 * s - ra, across); /* on the line of the force */
    for (int k = 0; k < n; k++) {
        const double dx = n == 3 ? a * COS[k] : k ? -a : a, dy = n == 3 ? b * COS[k] + c * SIN[k] : 0.0;
        if (fl_places_add(w, (fl_place){.stands = n,
                                        .overlap = q->most,
                                        .u = q->u / n,
                                        .du = q->du / n,
                                        .ddu = q->ddu / n,
                                        .n = v3_scale(1.0 / q->du, q->f),
                                        .across = across,
                                        .p = v3_add(at, v3_add(v3_scale(dx, q->x), v3_scale(dy, q->y)))}))
            return -1;
    }
    w->couple = v3_add(w->couple, v3_add(q->couple, v3_sub(q->m, v3_cross(v3_sub(middle, q->o), q->f))));
    return 0;
}

static fl_vec3 unit_across(fl_vec3 x, double rho)
{
    return rho > 0.0 ? v3(x.x / rho, x.y / rho, 0) : v3(1, 0, 0);
}

/* --- faces -----------------------------------------------------------------------------------------------
 */

/* F in work: x = level n + x ex + y ey, ey at right angles to the axis. */
typedef struct {
    const shape *c;
    const fl_side *A;
    int32_t F;
    fl_vec3 n, ex, ey;
    double level;
    const fl_vec3 *corner; /* x and y */
    int32_t corners;
    line axis; /* of y = 0, after x */
    sums sum;
} face;

/* One point of F that stands for the area. */
static void add_point(face *q, double x, double y, double area)
{
    const shape *c = q->c;
    const fl_vec3 at = v3_madd(v3_madd(v3_scale(q->level, q->n), x, q->ex), y, q->ey);
    const double rho = sqrt(at.x * at.x + at.y * at.y);
    const field d = field_at(c, rho, at.z);
    const double s = c->R - d.d;
    const fl_vec3 er = unit_across(at, rho), n = v3(d.mr * er.x, d.mr * er.y, d.mz);
    const double cosine = -v3_dot(q->n, n), root = 4.0 * cosine * cosine - 3.0;
    if (!(s > 0.0) || !(cosine > 0.0) || !(root > 0.0)) return;
    const double s2 = s * s, m = area * root * root, bend = area * 16.0 * cosine * root * s2 * s2;
    add(&q->sum, at, n, s, m * s2 * s2, 4.0 * m * s2 * s, 12.0 * m * s2);
    const fl_vec3 e = v3(-er.y, er.x, 0);
    const double round = v3_dot(e, q->n);
    fl_vec3 pull = v3_scale(rho > 0.0 ? bend * d.mr / rho * round : 0.0, e);
    if (d.rim > 0.0) pull = v3_madd(pull, bend * d.rim, v3_madd(v3_madd(q->n, cosine, n), -round, e));
    q->sum.f = v3_add(q->sum.f, pull);
    q->sum.m = v3_add(q->sum.m, v3_cross(v3_sub(at, q->sum.o), pull));
    q->sum.couple = v3_madd(q->sum.couple, bend, v3_cross(q->n, n));
}

/* Ends of F on the line at x. */
static void cut_face(const face *q, double x, double *lo, double *hi)
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
    const face *q;
    double x;
} row;

/* What is nearest to the point at y, and whether it counts: 0 where it does not. */
static int zone_in_row(const void *what, double y)
{
    const row *r = what;
    const face *q = r->q;
    const fl_vec3 at = v3_madd(v3_madd(v3_scale(q->level, q->n), r->x, q->ex), y, q->ey);
    const double rho = sqrt(at.x * at.x + at.y * at.y);
    const field d = field_at(q->c, rho, at.z);
    const fl_vec3 er = unit_across(at, rho);
    const double cosine = -(d.mr * (q->n.x * er.x + q->n.y * er.y) + d.mz * q->n.z);
    return cosine > FL_AREAS_COS ? 1 + d.zone : 0;
}

/* --- rows beside the slant side --------------------------------------------------------------------------
 *
 * With b the point of the row that is nearest to the axis, K = b.n_F, L = b.ex, T = ez.ex,
 *     n = (nr K q + nz nFz) n_F + (nr L q + nz T) ex + nr q y ey,     c = -n.n_F,
 *     e = ez x er = T y q n_F - nFz y q ex + (nFz L - T K) q ey,
 * so that what add_point() sums up is made of the sums of slant.h. */

/* The row at x from y = lo to hi, K and L as above, added to what is summed over the face. */
static void add_row_sums(face *q, double x, const fl_slant_row *p, double K, double L)
{
    const double nr = q->c->nr, nz = q->c->nz, T = q->ex.z, nFz = q->n.z;
    const double X = v3_dot(q->ex, v3_madd(v3_sub(v3_scale(q->level, q->n), q->sum.o), x, q->ex));
    sums *t = &q->sum;
    fl_slant_row_sums r;
    fl_slant_row_sum(p, &r);
    t->u += r.u, t->du += r.du, t->ddu += r.ddu, t->ds += r.ds;
    t->most = r.most > t->most ? r.most : t->most;
    t->sx += X * r.du, t->sxx += X * X * r.du;
    t->sy += r.dy, t->sxy += X * r.dy, t->syy += r.dyy;
    /* the force along n_F, ex and ey, and that times y */
    const double fn = nr * (K * r.dq + T * T * r.kyy) + nz * nFz * r.du;
    const double fx = nr * (L * r.dq - T * nFz * r.kyy) + nz * T * r.du;
    const double fy = nr * (r.dqy + T * (nFz * L - T * K) * r.ky);
    const double fny = nr * (K * r.dqy + T * T * r.kyyy) + nz * nFz * r.dy;
    const double fxy = nr * (L * r.dqy - T * nFz * r.kyyy) + nz * T * r.dy;
    t->f = v3_madd(v3_madd(v3_madd(t->f, fn, q->n), fx, q->ex), fy, q->ey);
    t->m = v3_madd(v3_madd(v3_madd(t->m, X * fy - fxy, q->n), fny, q->ex), -X * fn, q->ey);
    t->couple = v3_madd(v3_madd(t->couple, nr * L * r.kq + nz * T * r.k, q->ey), -nr * r.kqy, q->ex);
}

/* The part of a row where the side is nearest and faces F: c falls or rises with |y|.  0 where that is not
 * known. */
static int add_row(face *q, double x, double z, double h2, double lo, double hi, double width)
{
    const shape *c = q->c;
    const double h = sqrt(h2), out = c->nr * (h - c->r0) + c->nz * z;
    if (!(out > -z && out > z - c->h)) return 0; /* inside, an end may be nearer */
    const fl_vec3 b = v3_madd(v3_scale(q->level, q->n), x, q->ex);
    const double K = b.x * q->n.x + b.y * q->n.y, L = b.x * q->ex.x + b.y * q->ex.y;
    fl_slant_row p = {.h2 = h2,
                      .s0 = c->R - c->nz * z + c->nr * c->r0,
                      .nr = c->nr,
                      .c0 = -c->nz * q->n.z,
                      .ck = c->nr * K,
                      .lo = lo,
                      .hi = hi,
                      .area = width};
    const double need = FL_AREAS_COS - p.c0, far = lo < 0.0 ? fmax(-lo, hi) : hi,
                 near = lo > 0.0   ? lo
                        : hi < 0.0 ? -hi
                                   : 0.0;
    const int at_near = -p.ck > need * sqrt(h2 + near * near), at_far = -p.ck > need * sqrt(h2 + far * far);
    if (!at_near && !at_far) return 1;
    if (at_near && at_far && !(lo < 0.0 && hi > 0.0 && far * far > WIDE * WIDE * h2)) {
        add_row_sums(q, x, &p, K, L);
        return 1;
    }
    /* rho is singular h beside the middle of a row: each half by itself */
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

static void add_line(face *q, double x, double width, int side)
{
    const line *l = &q->axis;
    const double z = l->z0 + x * l->dz, p = profile(q->c, z), h2 = l->a + x * (2.0 * l->b + x * l->g);
    double lo, hi;
    stretches parts;
    if (!(p > 0.0) || !(p * p > h2)) return;
    const double far = sqrt(p * p - h2);
    cut_face(q, x, &lo, &hi);
    lo = lo > -far ? lo : -far;
    hi = hi < far ? hi : far;
    if (!(lo < hi)) return;
    if (side && add_row(q, x, z, h2 > 0.0 ? h2 : 0.0, lo, hi, width)) return;
    const row r = {q, x};
    cut_zones(&parts, zone_in_row, &r, 0.0, far); /* they depend on |y| alone */
    if (parts.n == 1) {
        for (int k = 0; k < FL_LONG_NODES && parts.s[0].zone; k++)
            add_point(q, x, lo + FL_LONG_NODE[k] * (hi - lo), width * FL_LONG_WEIGHT[k] * (hi - lo));
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

static int rising(double *x, int32_t n)
{
    for (int32_t k = 1; k < n; k++)
        for (int32_t j = k; j > 0 && x[j] < x[j - 1]; j--) {
            const double swap = x[j];
            x[j] = x[j - 1], x[j - 1] = swap;
        }
    return n;
}

/* Heights where the formula of d changes: on the axis' side of the rim, and beyond it. */
static int32_t changes(const shape *c, const line *l, double lo, double hi, double *out)
{
    const double z[4] = {0.0, c->h, c->R * c->nz, c->h + c->R * c->nz};
    int32_t n = 0;
    for (int k = 0; k < 4; k++) {
        const double t = (z[k] - l->z0) / l->dz;
        if (k > 1 && c->nz == 0.0) break;
        if (t > lo && t < hi) out[n++] = t;
    }
    return n;
}

/* The side is nearest to all that lies outside, for x from lo to hi. */
static int on_side(const face *q, double lo, double hi)
{
    const shape *c = q->c;
    const double za = q->axis.z0 + lo * q->axis.dz, zb = q->axis.z0 + hi * q->axis.dz;
    const double far = c->R * fabs(c->nz);
    return fmin(za, zb) >= far && fmax(za, zb) <= c->h - far;
}

/* No part of F that is near enough faces the side, and the ends are out of reach. */
static int turned_away(const face *q, double lo, double hi)
{
    const shape *c = q->c;
    if (!on_side(q, lo, hi)) return 0;
    const double most = c->nr * sqrt(fmax(1.0 - q->n.z * q->n.z, 0.0)) - c->nz * q->n.z;
    return most <= FL_AREAS_COS;
}

/* Seen from its plane alone, no part of F faces the side, and the ends are out of reach:
 *     c rho = -nr n_F.b - nz nFz rho,   n_F.b = level - nFz z. */
static int faces_away(const shape *c, fl_vec3 n, double level, double low, double high)
{
    const double far = c->R * fabs(c->nz), K0 = level - n.z * low, K1 = level - n.z * high;
    return low >= far && high <= c->h - far && -c->nz * n.z <= FL_AREAS_COS && K0 >= 0.0 && K1 >= 0.0;
}

/* Where on the side the line, which lies in F, begins or ends to face it, in (0, 1):
 *     c = c0 - nr (level - nFz z)/rho = FL_AREAS_COS,
 * squared.  How many. */
static int facing(const face *q, const line *l, double t[2])
{
    const shape *c = q->c;
    const double need = FL_AREAS_COS + c->nz * q->n.z, k0 = c->nr * (q->n.z * l->z0 - q->level),
                 k1 = c->nr * q->n.z * l->dz, A = k1 * k1 - need * need * l->g,
                 B = k0 * k1 - need * need * l->b, C = k0 * k0 - need * need * l->a, left = B * B - A * C;
    int n = 0;
    if (!(left > 0.0)) return 0;
    const double e = -B - copysign(sqrt(left), B), at[2] = {e / A, C / e};
    for (int k = 0; k < 2; k++)
        if (at[k] > 0.0 && at[k] < 1.0) t[n++] = at[k];
    return n;
}

/* An end that is nearly nothing is one that is: s at both ends and in the middle. */
static void vanishing(const double s[3], int zero[2])
{
    const double most = fmax(s[1], fmax(s[0], s[2]));
    zero[0] |= s[0] < NEARLY * most;
    zero[1] |= s[2] < NEARLY * most;
}

/* Least squared distance of the line from the axis. */
static double nearest2(const line *l, double lo, double hi)
{
    double t = l->g > 0.0 ? -l->b / l->g : lo;
    t = t < lo ? lo : t > hi ? hi : t;
    return l->a + t * (2.0 * l->b + t * l->g);
}

static int over_face(fl_places *w, const fl_side *A, int32_t F, const shape *c)
{
    const fl_poly *p = A->p;
    const int32_t *loop = p->loop + p->first[F], n = p->first[F + 1] - p->first[F];
    face q = {.c = c, .A = A, .F = F, .n = A->n[F]};
    const fl_vec3 tilt = v3_madd(v3(0, 0, 1), -q.n.z, q.n);
    double lo = INFINITY, hi = -INFINITY, low = INFINITY, high = -INFINITY, at[BREAKS];
    int zero[2];
    for (int32_t k = 0; k < n; k++) {
        const double z = A->v[loop[k]].z;
        low = z < low ? z : low;
        high = z > high ? z : high;
    }
    q.level = v3_dot(q.n, A->v[loop[0]]);
    if (low >= c->h + c->R || high <= -c->R || faces_away(c, q.n, q.level, low, high)) return 0;
    if (fl_room(&w->cut, &w->cut_cap, n, sizeof *w->cut)) return -1;
    low = INFINITY, high = -INFINITY;
    q.ex = v3_norm(tilt) > SMALL ? v3_unit(tilt) : v3_normal_to(q.n);
    q.ey = v3_cross(q.n, q.ex);
    for (int32_t k = 0; k < n; k++) {
        const double x = v3_dot(q.ex, A->v[loop[k]]), y = v3_dot(q.ey, A->v[loop[k]]);
        w->cut[k] = v3(x, y, 0);
        lo = x < lo ? x : lo;
        hi = x > hi ? x : hi;
        low = y < low ? y : low;
        high = y > high ? y : high;
    }
    q.corner = w->cut;
    q.corners = n;
    const fl_vec3 from = v3_scale(q.level, q.n); /* of the line y = 0 */
    q.axis = (line){from.z, q.ex.z, from.x * from.x + from.y * from.y, from.x * q.ex.x + from.y * q.ex.y,
                    q.ex.x * q.ex.x + q.ex.y * q.ex.y};
    const double wide = fmax(c->r0, c->r1) + c->R, near = fmax(low, -high);
    if (near > 0.0 && near * near >= wide * wide) return 0;
    if (turned_away(&q, lo, hi) || !inside(c, &q.axis, &lo, &hi, zero)) return 0;
    if (near > 0.0 && near * near + nearest2(&q.axis, lo, hi) >= wide * wide) return 0;
    q.sum.o = v3_madd(from, 0.5 * (lo + hi), q.ex);
    q.sum.x = q.ex, q.sum.y = q.ey;
    int32_t breaks = changes(c, &q.axis, lo, hi, at);
    for (int32_t k = 0; k < n && breaks < BREAKS - 7; k++) {
        const fl_vec3 a = q.corner[k], b = q.corner[k + 1 < n ? k + 1 : 0];
        if (a.x > lo && a.x < hi) at[breaks++] = a.x;
        /* where the border of F comes within R and where it leaves */
        const fl_vec3 v = A->v[loop[k]], u = v3_sub(A->v[loop[k + 1 < n ? k + 1 : 0]], v);
        const line l = line_of(v, u);
        double t[2];
        for (int e = facing(&q, &l, t); e-- > 0;) {
            const double x = a.x + t[e] * (b.x - a.x);
            if (x > lo && x < hi) at[breaks++] = x;
        }
        t[0] = 0.0, t[1] = 1.0;
        int is_end[2];
        if (!inside(c, &l, &t[0], &t[1], is_end)) continue;
        for (int e = 0; e < 2; e++) {
            const double x = a.x + t[e] * (b.x - a.x);
            if (is_end[e] && x > lo && x < hi) at[breaks++] = x;
        }
    }
    at[breaks++] = lo, at[breaks++] = hi;
    rising(at, breaks);
    if (on_side(&q, lo, hi)) {
        double room[3];
        for (int k = 0; k < 3; k++) {
            const double x = lo + 0.5 * k * (hi - lo), rim = profile(c, q.axis.z0 + x * q.axis.dz);
            room[k] = rim - sqrt(fmax(q.axis.a + x * (2.0 * q.axis.b + x * q.axis.g), 0.0));
        }
        vanishing(room, zero);
    }
    for (int32_t b = 0; b + 1 < breaks; b++) {
        const int ends[2] = {zero[0] && b == 0, zero[1] && b + 2 == breaks};
        const double x0 = at[b], width = at[b + 1] - x0;
        const int side = on_side(&q, x0, at[b + 1]), panels = side ? 1 : PANELS;
        if (!(width > SMALL * (hi - lo))) continue;
        for (int k = 0; k < panels * FL_LONG_NODES; k++) {
            double t;
            const double u = (k / FL_LONG_NODES + FL_LONG_NODE[k % FL_LONG_NODES]) / panels,
                         dt = bunch(u, ends, &t);
            add_line(&q, x0 + t * width, FL_LONG_WEIGHT[k % FL_LONG_NODES] / panels * dt * width, side);
        }
    }
    return put(w, &q.sum, 3, A->r);
}

/* --- edges -----------------------------------------------------------------------------------------------
 */

/* Added to what is summed over the edge, whose middle is q->o. */
static void add_walk(sums *q, const shape *c, fl_vec3 u, const fl_slant_edge *p)
{
    fl_slant_edge_sums r;
    fl_slant_edge_sum(p, &r);
    const double length = v3_dot(q->x, u);
    q->u += r.u, q->du += r.du, q->ddu += r.ddu, q->ds += r.ds;
    q->most = r.most > q->most ? r.most : q->most;
    q->sx += length * r.dt, q->sxx += length * length * r.dtt;
    /* of d n and of d n times t; where the middle lies from the axis, and u across it */
    const fl_vec3 o = v3(q->o.x, q->o.y, 0), a = v3(u.x, u.y, 0), nz = v3(0, 0, c->nz);
    const fl_vec3 f = v3_madd(v3_scale(c->nr, v3_madd(v3_scale(r.dq, o), r.dqt, a)), r.du, nz);
    const fl_vec3 ft = v3_madd(v3_scale(c->nr, v3_madd(v3_scale(r.dqt, o), r.dqtt, a)), r.dt, nz);
    q->f = v3_add(q->f, f);
    q->m = v3_add(q->m, v3_cross(u, ft));
}

static void add_piece(sums *q, const shape *c, fl_vec3 a, fl_vec3 u, double factor, double from, double width,
                      const int zero[2])
{
    for (int k = 0; k < FL_LONG_NODES; k++) {
        double t;
        const double dt = bunch(FL_LONG_NODE[k], zero, &t);
        const fl_vec3 at = v3_madd(a, from + t * width, u);
        const double rho = sqrt(at.x * at.x + at.y * at.y);
        const field d = field_at(c, rho, at.z);
        const double s = c->R - d.d;
        if (!(s > 0.0)) continue;
        const fl_vec3 er = unit_across(at, rho), n = v3(d.mr * er.x, d.mr * er.y, d.mz);
        const double g = factor * FL_LONG_WEIGHT[k] * dt * width * sqrt(s) * s * s;
        add(q, at, n, s, g * s * s, 4.5 * g * s, 15.75 * g);
    }
}

typedef struct {
    const shape *c;
    fl_vec3 a, u;
} walk;

static int zone_in_walk(const void *what, double t)
{
    const walk *r = what;
    const fl_vec3 at = v3_madd(r->a, t, r->u);
    return field_at(r->c, sqrt(at.x * at.x + at.y * at.y), at.z).zone;
}

/* From t = lo to hi the side is nearest, also to what lies inside. */
static int along_side(const shape *c, const line *l, double lo, double hi)
{
    const double z0 = l->z0 + lo * l->dz, z1 = l->z0 + hi * l->dz, far = c->R * fabs(c->nz);
    const double low = fmin(z0, z1), high = fmax(z0, z1), rho = sqrt(fmax(nearest2(l, lo, hi), 0.0));
    const double out = c->nr * (rho - c->r0) + fmin(c->nz * z0, c->nz * z1);
    return low >= far && high <= c->h - far && out > -low && out > high - c->h;
}

static double slant_overlap(const fl_slant_edge *p, double t)
{
    return p->s0 + t * p->s1 - p->nr * sqrt(fmax(p->a + t * (2.0 * p->b + t * p->g), 0.0));
}

/* Where an edge from lo to hi along the side is cut, so that Gauss' rule has each piece: at the point nearest
 * to the axis and at ways from it that grow threefold, where it reaches far; else in the middle, where it
 * ends in nothing at both ends. */
static int32_t side_pieces(const line *l, double lo, double hi, int both, double at[BREAKS])
{
    int32_t n = 0;
    at[n++] = lo, at[n++] = hi;
    if (l->g > 0.0) {
        const double nearest = -l->b / l->g, apart = sqrt(fmax(l->a + nearest * l->b, 0.0) / l->g);
        const double longest = fmax(hi - nearest, nearest - lo);
        if (longest > CLOSE * apart && nearest > lo && nearest < hi) at[n++] = nearest;
        for (double d = fmax(apart, 1e-9 * longest); d < longest && longest > CLOSE * apart; d *= 3.0) {
            if (nearest + d < hi - 0.2 * d && nearest + d > lo + 0.2 * d) at[n++] = nearest + d;
            if (nearest - d > lo + 0.2 * d && nearest - d < hi - 0.2 * d) at[n++] = nearest - d;
        }
    }
    if (n == 2 && both) at[n++] = 0.5 * (lo + hi);
    rising(at, n);
    return n;
}

static int over_edge(fl_places *w, const fl_side *A, int32_t e, const shape *c)
{
    static const double BUNCH[2][2][3] = {{{1, 0, 0}, {2, -1, 0}}, {{0, 1, 0}, {0, 3, -2}}}; /* as bunch() */
    const fl_edge g = A->p->edge[e];
    const fl_vec3 a = A->v[g.a], u = v3_sub(A->v[g.b], a);
    const line l = line_of(a, u);
    double lo = 0.0, hi = 1.0, at[BREAKS];
    int zero[2];
    if (!inside(c, &l, &lo, &hi, zero)) return 0;
    const double factor = fl_strips_factor(A, e, 0.0);
    if (!(factor > 0.0)) return 0;
    const double middle = 0.5 * (lo + hi);
    sums q = {.o = v3_madd(a, middle, u), .x = v3_unit(u)};
    if (along_side(c, &l, lo, hi)) {
        fl_slant_edge p = {.a = l.a,
                           .b = l.b,
                           .g = l.g,
                           .s0 = c->R + c->nr * c->r0 - c->nz * l.z0,
                           .s1 = -c->nz * l.dz,
                           .nr = c->nr};
        p.middle = middle, p.factor = factor;
        const double s[3] = {slant_overlap(&p, lo), slant_overlap(&p, middle), slant_overlap(&p, hi)};
        vanishing(s, zero);
        const int32_t n = side_pieces(&l, lo, hi, zero[0] && zero[1], at);
        for (int32_t k = 0; k + 1 < n; k++) {
            const double *bunched = BUNCH[zero[0] && k == 0][zero[1] && k + 2 == n];
            p.from = at[k], p.width = at[k + 1] - at[k];
            p.c[0] = bunched[0], p.c[1] = bunched[1], p.c[2] = bunched[2];
            add_walk(&q, c, u, &p);
        }
        return put(w, &q, 2, A->r);
    }
    int32_t n = changes(c, &l, lo, hi, at);
    at[n++] = lo, at[n++] = hi;
    if (zero[0] && zero[1]) at[n++] = middle;
    rising(at, n);
    const walk r = {c, a, u};
    for (int32_t k = 0; k + 1 < n; k++) {
        stretches parts;
        cut_zones(&parts, zone_in_walk, &r, at[k], at[k + 1]);
        for (int s = 0; s < parts.n; s++) {
            const int ends[2] = {zero[0] && k == 0 && s == 0, zero[1] && k + 2 == n && s + 1 == parts.n};
            add_piece(&q, c, a, u, factor, parts.s[s].from, parts.s[s].to - parts.s[s].from, ends);
        }
    }
    return put(w, &q, 2, A->r);
}

int fl_frustum_places(fl_places *w, const fl_poly *a, const fl_frustum *solid, double ra)
{
    const fl_side A = {a, w->va, w->na, ra, 1.0};
    const shape c = shape_of(solid, ra);
    for (int32_t v = 0; v < a->nv; v++) {
        const double rho = sqrt(w->va[v].x * w->va[v].x + w->va[v].y * w->va[v].y);
        const field d = field_at(&c, rho, w->va[v].z);
        const fl_vec3 er = unit_across(w->va[v], rho);
        if (d.d < ra && fl_places_vertex(w, &A, 0.0, v, v3(d.mr * er.x, d.mr * er.y, d.mz), ra - d.d))
            return -1;
    }
    for (int32_t e = 0; e < a->ne; e++)
        if (over_edge(w, &A, e, &c)) return -1;
    for (int32_t F = 0; F < a->nf; F++)
        if (over_face(w, &A, F, &c)) return -1;
    return 0;
}
