/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/simd.h"
#include "patch/no_tension.h"
#include "patch/patch_result.h"
#include "patch/surrogate.h"

#define FIRST_REACH 0.3 /* reach of a new contact over the root of the tolerance */
/* smallest factor by which one exact evaluation changes the reach; MAX_STEP_FACTOR: largest */
#define MIN_STEP_FACTOR 0.2
#define MAX_STEP_FACTOR 3.0
#define TARGET_SHARE 0.15 /* part of the tolerance that is aimed at */
#define MAX_RETURN 0.5    /* largest part of the tolerance that the returned energy may use */
#define MIN_PATH 0.3      /* of the reach: shorter paths do not predict the next jump of W */
/* errors above this many tolerances mean another contact: what was learnt is dropped */
#define NEW_CONTACT 10.0
/* of the overlap: slopes of evaluations nearer to each other differ by rounding */
#define MIN_RECORD_PATH 1e-5
#define MAX_ENERGY_RATIO 50.0 /* largest ratio of the energies of two evaluations that are compared */
#define STRAIGHT_COSINE 0.9   /* cosine between two paths that count as one line */
#define MIN_LENGTH_RATIO 0.1  /* smallest ratio of their lengths */
#define LENGTH_STEP 2.0       /* factor by which the length l grows with the contact */
#define FREE_TURN_SHARE 0.03  /* of the radii: so much nearer may a corner without pressure come */
#define MIN_CORRECTION 1e-9   /* of the pressures: a smaller correction is rounding */
#define MIN_NET_FORCE 0.5     /* least force over the sum of pressures: below it they oppose each other */

static const fl_vec3 ZERO = {0, 0, 0};

static fl_vec3 force_part(const fl_vec6 a) { return v3(a[0], a[1], a[2]); }
static fl_vec3 moment_part(const fl_vec6 a) { return v3(a[3], a[4], a[5]); }

static void set_vec6(fl_vec6 a, fl_vec3 l, fl_vec3 h)
{
    a[0] = l.x, a[1] = l.y, a[2] = l.z;
    a[3] = h.x, a[4] = h.y, a[5] = h.z;
    a[6] = a[7] = 0.0;
}

static double dot6(const fl_vec6 a, const fl_vec6 b)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += a[k] * b[k];
    return sum;
}

/* out = more + A x, A symmetric. */
FL_SIMD_INLINE void multiply_add(fl_vec6 out, const fl_vec6 *A, const fl_vec6 x, const fl_vec6 more)
{
    fl_simd a = FL_SIMD_LOAD(more), b = FL_SIMD_LOAD(more + 4);
    FL_SIMD_UNROLL
    for (int k = 0; k < 6; k++) {
        a += x[k] * FL_SIMD_LOAD(&A[k][0]);
        b += x[k] * FL_SIMD_LOAD(&A[k][4]);
    }
    FL_SIMD_STORE(out) = a;
    FL_SIMD_STORE(out + 4) = b;
}

/* A += s (x y^T + y x^T) */
FL_SIMD4_VERSIONS static void add_symmetric(fl_vec6 *A, double s, const fl_vec6 x, const fl_vec6 y)
{
    const fl_simd x0 = FL_SIMD_LOAD(x), x4 = FL_SIMD_LOAD(x + 4), y0 = FL_SIMD_LOAD(y),
                  y4 = FL_SIMD_LOAD(y + 4);
    FL_SIMD_UNROLL
    for (int r = 0; r < 6; r++) {
        FL_SIMD_STORE(&A[r][0]) += s * (x[r] * y0 + y[r] * x0);
        FL_SIMD_STORE(&A[r][4]) += s * (x[r] * y4 + y[r] * x4);
    }
}

/* z^(p - 2); p is a multiple of 1/4. */
static inline double power_root(double z, double power)
{
    const double root = sqrt(z);
    return power == 2.0 ? 1.0 : power == 2.25 ? sqrt(root) : root;
}

fl_surrogate_count fl_surrogate_count_sum(const fl_surrogate_count *count, int32_t threads)
{
    fl_surrogate_count all = {0};
    for (int32_t k = 0; k < threads; k++) {
        all.hits += count[k].hits, all.checks += count[k].checks, all.misses += count[k].misses;
        all.worst_error = count[k].worst_error > all.worst_error ? count[k].worst_error : all.worst_error;
    }
    return all;
}

/* --- evaluation ----------------------------------------------------------------------------------------- */

_Static_assert(FL_SURROGATE_ROWS % FL_SIMD_WIDTH == 0 && FL_SURROGATE_BATCH % FL_SIMD_WIDTH == 0,
               "groups of four");

_Static_assert(offsetof(fl_surrogate, learnt) % sizeof(double) ==
                       offsetof(fl_surrogate, g) % sizeof(double) &&
                   sizeof(fl_surrogate) >= offsetof(fl_surrogate, g) + FL_SURROGATE_ROWS * sizeof(double),
               "doubles only in between, and as many");

FL_SIMD4_VERSIONS void fl_surrogate_pack(fl_surrogate_lanes *b, const fl_surrogate *const *s, int n)
{
    const double *of[FL_SURROGATE_BATCH];
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) of[k] = fl_lane_column(&s[k < n ? k : 0]->g);
    fl_lanes_load(b->s, of, FL_SURROGATE_ROWS);
}

#define OF(member) (b->s + FL_SURROGATE_ROW(member))

/* Displacement q of A since the exact evaluation, and J^T. */
FL_SIMD_VERSIONS static void compute_displacement(fl_surrogate_lanes *restrict b, fl_lane *restrict J)
{
    const fl_lane *M = OF(M);
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_vec3 x = fl_lane3(b->M, k), y = fl_lane3(b->M + 3, k), z = fl_lane3(b->M + 6, k);
        const fl_vec3 X = fl_lane3(M, k), Y = fl_lane3(M + 3, k), Z = fl_lane3(M + 6, k);
        const double xx = v3_dot(x, X), xy = v3_dot(x, Y), xz = v3_dot(x, Z);
        const double yx = v3_dot(y, X), yy = v3_dot(y, Y), yz = v3_dot(y, Z);
        const double zx = v3_dot(z, X), zy = v3_dot(z, Y), zz = v3_dot(z, Z);
        const double arm = OF(length)->a[k], half = 0.5 * (xx + yy + zz);
        const fl_vec3 own = fl_lane3(OF(point_a), k),
                      w = v3(0.5 * (zy - yz), 0.5 * (xz - zx), 0.5 * (yx - xy));
        const fl_vec3 at = v3_add(fl_lane3(b->o, k), v3(v3_dot(x, own), v3_dot(y, own), v3_dot(z, own)));
        const fl_vec3 by = v3_sub(at, fl_lane3(OF(point), k));
        const double slides = OF(counts_along_plane)->a[k];
        const fl_vec3 u = v3(slides * by.x, slides * by.y, by.z);
        fl_lane3_set(b->point, k, at);
        fl_lane3_set(b->w, k, w);
        fl_lane3_set(b->q, k, u);
        fl_lane3_set(b->q + 3, k, v3_scale(arm, w));
        b->turn.a[k] = arm * v3_norm(w);
        b->path.a[k] = v3_norm(u) + FL_SURROGATE_TURN_WEIGHT * b->turn.a[k];
        fl_lane3_set(J, k, v3(half - 0.5 * xx, -0.5 * yx, -0.5 * zx));
        fl_lane3_set(J + 3, k, v3(-0.5 * xy, half - 0.5 * yy, -0.5 * zy));
        fl_lane3_set(J + 6, k, v3(-0.5 * xz, -0.5 * yz, half - 0.5 * zz));
    }
}

FL_SIMD_VERSIONS static void compute_slope(fl_surrogate_lanes *restrict b)
{
    for (int r = 0; r < 6; r++) {
        const fl_lane *g = OF(g) + r, *H[6];
        for (int c = 0; c < 6; c++) H[c] = OF(H) + FL_UPPER[r][c];
#pragma omp simd
        for (int k = 0; k < FL_SURROGATE_BATCH; k++)
            b->slope_z[r].a[k] =
                g->a[k] +
                ((H[0]->a[k] * b->q[0].a[k] + H[1]->a[k] * b->q[1].a[k] + H[2]->a[k] * b->q[2].a[k]) +
                 (H[3]->a[k] * b->q[3].a[k] + H[4]->a[k] * b->q[4].a[k] + H[5]->a[k] * b->q[5].a[k]));
    }
}

FL_SIMD_INLINE double dot_lanes(const fl_lane *a, const fl_lane *b, int k)
{
    return v3_dot(fl_lane3(a, k), fl_lane3(b, k)) + v3_dot(fl_lane3(a + 3, k), fl_lane3(b + 3, k));
}

/* Factor of F^2/W that gives dF/ds. */
FL_SIMD_INLINE double trend_factor(double c, double s)
{
    const double by = 1.0 + c * s;
    return by > 0.5 ? by : 0.5;
}

FL_SIMD_VERSIONS static void compute_force(fl_surrogate_lanes *restrict b, const fl_lane *restrict J)
{
    const fl_lane *e = OF(path_direction), *t = OF(third_order);
#pragma omp simd
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        const fl_vec3 u = fl_lane3(b->q, k), w = fl_lane3(b->q + 3, k);
        fl_vec3 by = fl_lane3(b->slope_z, k), turn = fl_lane3(b->slope_z + 3, k);
        const double straight =
            1.0 + 0.5 * ((v3_dot(fl_lane3(OF(g), k), u) + v3_dot(fl_lane3(OF(g) + 3, k), w)) +
                         (v3_dot(by, u) + v3_dot(turn, w)));
        /* the third order: s^2/2 (t.q) - s^3/3 (e.t), s = e.q */
        const double s = dot_lanes(e, b->q, k), et = dot_lanes(e, t, k), tq = dot_lanes(t, b->q, k),
                     half = 0.5 * s * s, es = s * (tq - et * s),
                     z = straight + half * tq - (2.0 / 3.0) * half * s * et;
        by = v3_madd(v3_madd(by, es, fl_lane3(e, k)), half, fl_lane3(t, k));
        turn = v3_madd(v3_madd(turn, es, fl_lane3(e + 3, k)), half, fl_lane3(t + 3, k));
        fl_lane3_set(b->slope_z, k, by);
        fl_lane3_set(b->slope_z + 3, k, turn);
        const double p = OF(power)->a[k], W = OF(energy)->a[k], root = power_root(z, p),
                     each = -p * W * z * root;
        const double energy = W * z * z * root;
        const fl_vec3 f = v3_scale(each, by), g = v3_scale(each * OF(length)->a[k], turn);
        const double share = v3_norm(f) / OF(force)->a[k];
        b->z.a[k] = z;
        b->energy.a[k] = energy;
        b->force_ratio.a[k] = share;
        b->slope.a[k] = OF(slope)->a[k] * trend_factor(OF(slope_trend)->a[k], s) * share * share * W / energy;
        fl_lane3_set(b->f, k, f);
        fl_lane3_set(
            b->m, k,
            v3(v3_dot(fl_lane3(J, k), g), v3_dot(fl_lane3(J + 3, k), g), v3_dot(fl_lane3(J + 6, k), g)));
    }
}

void fl_surrogate_evaluate(fl_surrogate_lanes *b)
{
    _Alignas(64) fl_lane J[9]; /* the moment is -J^T times the slope over w, row by row */
    compute_displacement(b, J);
    compute_slope(b);
    compute_force(b, J);
}

fl_surrogate_value fl_surrogate_unpack(const fl_surrogate_lanes *b, int k)
{
    fl_surrogate_value t = {.path = b->path.a[k],
                            .turn = b->turn.a[k],
                            .z = b->z.a[k],
                            .point = fl_lane3(b->point, k),
                            .w = fl_lane3(b->w, k),
                            .gradient = {fl_lane3(b->f, k), fl_lane3(b->m, k)},
                            .energy = b->energy.a[k],
                            .force_ratio = b->force_ratio.a[k],
                            .slope = b->slope.a[k]};
    for (int r = 0; r < 6; r++) t.q[r] = b->q[r].a[k], t.slope_z[r] = b->slope_z[r].a[k];
    return t;
}

static fl_wrench move_wrench(const fl_wrench *a, fl_vec3 from)
{
    return (fl_wrench){a->f, v3_add(a->m, v3_cross(from, a->f))};
}

/* --- exact evaluations ---------------------------------------------------------------------------------- */

/* Sums of springs about another point, `a` away, rotations times `arm`: t = r x n + a x n = r x n + A n. */
static void springs_about(fl_vec6 *out, const fl_spring_sums *s, double scale, fl_vec3 a, double arm)
{
    const double A[3][3] = {{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}};
    double X[3][3]; /* sum of k t n^T */
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            X[r][c] = s->coupling[r][c];
            for (int k = 0; k < 3; k++) X[r][c] += A[r][k] * s->linear[k][c];
        }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            double t = s->angular[r][c];
            for (int k = 0; k < 3; k++) t += A[r][k] * s->coupling[c][k] + X[r][k] * A[c][k];
            out[r][c] = scale * s->linear[r][c];
            out[3 + r][c] = out[c][3 + r] = scale / arm * X[r][c];
            out[3 + r][3 + c] = scale / (arm * arm) * t;
        }
    for (int r = 0; r < 6; r++) out[r][6] = out[r][7] = 0.0;
}

/* Solves z^p = want by Newton's method; 0 where z is too far from 1. */
static double overlap_of_energy(double p, double want)
{
    double z = want < 1.0 ? 0.5 * (1.0 + want) : want < 4.0 ? 1.0 + 0.4 * (want - 1.0) : sqrt(want);
    if (!(want > 1.0 / MAX_ENERGY_RATIO && want < MAX_ENERGY_RATIO)) return 0.0;
    for (int k = 0; k < 6; k++) {
        const double slope = z * power_root(z, p);
        z -= (z * slope - want) / (p * slope);
    }
    return z;
}

/* Slope over the coordinates of another pose, in which A is rotated by w: J^-T to first order. */
static void rotate_slope(fl_vec6 out, const fl_vec6 slope, fl_vec3 w)
{
    set_vec6(out, force_part(slope), v3_madd(moment_part(slope), -0.5, v3_cross(w, moment_part(slope))));
}

/* True if the third order along the path is known. */
static int has_third_order(const fl_surrogate *s)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += s->path_direction[k] * s->path_direction[k];
    return sum > 0.0;
}

/* Factor of the path for an error of `part` of the largest one.  The error grows as the third power of the
 * path where the third order is known, as the second where not.  part^(3/8), from square roots, stands for
 * the third root. */
static double path_factor(const fl_surrogate *s, double part)
{
    const double root = sqrt(part);
    return has_third_order(s) ? sqrt(root * sqrt(root)) : root;
}

/* s = e.q */
static double path_along(const fl_surrogate *s, const fl_surrogate_value *value)
{
    double sum = 0.0;
    for (int k = 0; k < 6; k++) sum += s->path_direction[k] * value->q[k];
    return sum;
}

/* Error of s relative to the exact slope, about the same point, and the new reach. */
static double update_reach(fl_surrogate *s, const fl_surrogate_value *value, fl_surrogate_record *last,
                           const fl_vec6 slope, double force, double toward, double tolerance)
{
    const double most = toward * (force > s->force ? force : s->force),
                 pull = s->power * value->energy / value->z;
    const double back = 2.0 * s->defect_return * path_along(s, value); /* intended, not an error */
    fl_vec6 far;
    rotate_slope(far, slope, value->w);
    for (int k = 0; k < 6; k++) far[k] -= pull * (value->slope_z[k] - back * s->path_direction[k]);
    const double off = value->z > 0.0 ? sqrt(dot6(far, far)) / most : 1.0,
                 past = value->path / (s->reach * s->overlap);
    double longer = off > 0.0 ? path_factor(s, TARGET_SHARE * tolerance / off) * past : MAX_STEP_FACTOR;
    if (off > NEW_CONTACT * tolerance) {
        memset(s->learnt, 0, sizeof s->learnt);
        /* the earlier evaluations are of another contact, unless the path was far beyond its range */
        if (off > NEW_CONTACT * tolerance * (past > 1.0 ? past * past : 1.0))
            last->energy = s->previous.energy = 0.0;
    }
    longer = longer > MAX_STEP_FACTOR ? MAX_STEP_FACTOR : longer < MIN_STEP_FACTOR ? MIN_STEP_FACTOR : longer;
    s->reach = longer * s->reach < FL_SURROGATE_MAX_REACH ? longer * s->reach : FL_SURROGATE_MAX_REACH;
    return off;
}

/* Slope of z at an earlier evaluation in the present coordinates; w: rotation since then.  0 where W differs
 * too much. */
static int slope_of_z(const fl_surrogate *s, const fl_surrogate_record *b, fl_vec3 w, fl_vec6 out)
{
    const double z = overlap_of_energy(s->power, b->energy / s->energy), each = z / (s->power * b->energy);
    fl_vec6 slope;
    rotate_slope(slope, b->slope, w);
    for (int k = 0; k < 8; k++) out[k] = each * slope[k];
    return z > 0.0;
}

/* Change of the slope of z between two evaluations beyond H, per length of the path from one to the other.
 *     e, r   out: direction of the path, that change;  returns the length of the path */
FL_SIMD4_VERSIONS static double curvature_defect(fl_vec6 *H, const fl_vec6 from, const fl_vec6 to,
                                                 const fl_vec6 way, fl_vec6 e, fl_vec6 r)
{
    const double h = sqrt(dot6(way, way)), each = h > 0.0 ? 1.0 / h : 0.0;
    fl_vec6 by;
    for (int k = 0; k < 8; k++) e[k] = each * way[k];
    multiply_add(by, (const fl_vec6 *)H, e, (fl_vec6){0});
    for (int k = 0; k < 8; k++) r[k] = each * (to[k] - from[k]) - by[k];
    return h;
}

/* A += the smallest symmetric matrix that maps the unit vector e to r, times each. */
static void learn_matrix(fl_vec6 *A, double each, const fl_vec6 r, const fl_vec6 e)
{
    add_symmetric(A, each, r, e);
    add_symmetric(A, -0.5 * each * dot6(r, e), e, e);
}

/* A += each B */
static void add_matrix(fl_vec6 *A, double each, const fl_vec6 *B)
{
    for (int r = 0; r < 6; r++)
        for (int k = 0; k < 8; k++) A[r][k] += each * B[r][k];
}

/* Learns from the last two evaluations what H (springs plus learnt part) lacks, and the third order. */
static void learn_curvature(fl_surrogate *s, fl_vec6 *springs, const fl_vec6 g,
                            const fl_surrogate_record *last, double much)
{
    const fl_surrogate_record *first = &s->previous;
    const fl_vec3 w = v3_scale(-1.0 / s->length, moment_part(last->path)),
                  ww = v3_madd(w, -1.0 / s->length, moment_part(first->path));
    fl_vec6 H[6], g1, g0, e, d, r, rd;
    if (!slope_of_z(s, last, w, g1)) return;
    memcpy(H, springs, sizeof H);
    add_matrix(H, much, (const fl_vec6 *)s->learnt);
    const double h = curvature_defect(H, g1, g, last->path, e, r);
    if (!(h > MIN_RECORD_PATH * s->overlap)) return;
    if (first->energy > 0.0 && slope_of_z(s, first, ww, g0)) {
        const double hd = curvature_defect(H, g0, g1, first->path, d, rd);
        if (dot6(e, d) > STRAIGHT_COSINE && hd > MIN_LENGTH_RATIO * h && h > MIN_LENGTH_RATIO * hd) {
            const double each = 2.0 / (h + hd);
            for (int k = 0; k < 6; k++) {
                s->third_order[k] = each * (r[k] - rd[k]), s->path_direction[k] = e[k];
                r[k] += 0.5 * h * s->third_order[k];
            }
        }
    }
    learn_matrix(s->learnt, 1.0 / much, r, e);
}

/* Starts a contact: the point is the centre of the pressures and stays fixed to A.  The pressures exist even
 * where bodies separate so fast that damping cancels all of them. */
static void start_surrogate(fl_surrogate *s, const fl_exact_contact *seen, double tolerance)
{
    const fl_pressure_moments *q = seen->pressing;
    const fl_vec3 centre = v3_add(seen->first, q->centre);
    *s = (fl_surrogate){.reach = FIRST_REACH * sqrt(tolerance)};
    s->max_change = fl_surrogate_max_change(tolerance);
    s->length = q->radius > seen->radii ? q->radius : seen->radii;
    s->point_a = m3_tmul(*seen->M, v3_sub(centre, seen->o));
}

/* Lets the length l grow: a contact that began at a corner may be one of faces now. */
static void grow_length(fl_surrogate *s, fl_surrogate_record *last, double spread)
{
    const double part = s->length / spread;
    if (!(spread > LENGTH_STEP * s->length)) return;
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++) s->learnt[r][c] *= (r < 3 ? 1.0 : part) * (c < 3 ? 1.0 : part);
    for (int k = 3; k < 6; k++) {
        s->previous.slope[k] *= part, s->previous.path[k] /= part;
        last->slope[k] *= part, last->path[k] /= part;
    }
    s->length = spread;
}

/* H and p from the springs, the learnt part and the slope of W.  last: evaluation to learn from, or NULL. */
FL_SIMD4_VERSIONS static void compute_curvature(fl_surrogate *s, const fl_exact_contact *seen,
                                                const fl_vec6 slope, fl_vec3 from,
                                                const fl_surrogate_record *last)
{
    const double W = seen->energy, force = s->force;
    fl_vec6 H[6], g = {0};
    springs_about(H, seen->springs, seen->scale, from, s->length);
    add_symmetric(H, -0.5 / W, slope, slope); /* W = c sqrt(U): second derivative of the root */
    fl_vec6 push, stiff;
    set_vec6(push, v3_scale(1.0 / force, force_part(slope)), ZERO);
    multiply_add(stiff, (const fl_vec6 *)H, push, (fl_vec6){0});
    const double curve = W * dot6(push, stiff) / (force * force);
    s->power = curve < 1.0 - 1.0 / 2.125 ? 2.0 : curve < 1.0 - 1.0 / 2.375 ? 2.25 : 2.5;
    const double p = s->power, each = 1.0 / (p * W);
    for (int r = 0; r < 6; r++) {
        s->g[r] = g[r] = each * slope[r];
        for (int l = 0; l < 6; l++) H[r][l] *= each;
    }
    add_symmetric(H, -0.5 * (p - 1.0), g, g);
    if (last) {
        memset(s->path_direction, 0, sizeof s->path_direction),
            memset(s->third_order, 0, sizeof s->third_order);
        if (last->energy > 0.0) learn_curvature(s, H, g, last, each * force);
        if (!has_third_order(s)) s->slope_trend = 0.0;
        s->previous = *last;
    }
    add_matrix(H, each * force, (const fl_vec6 *)s->learnt);
    for (int r = 0; r < 6; r++)
        for (int c = r; c < 6; c++) s->H[FL_UPPER[r][c]] = H[r][c];
}

/* Slope of W over (u, l w) about the point; returns the size of the force. */
static double slope_of_energy(const fl_surrogate *s, const fl_exact_contact *seen, fl_vec6 slope)
{
    const fl_vec3 at = v3_add(seen->o, m3_mul(*seen->M, s->point_a));
    const fl_force_sum *q = seen->sums;
    const fl_wrench first = {v3_scale(seen->scale, q->gradient.f), v3_scale(seen->scale, q->gradient.m)};
    const fl_wrench wrench = move_wrench(&first, v3_sub(seen->first, at));
    set_vec6(slope, v3_neg(wrench.f), v3_scale(-1.0 / s->length, wrench.m));
    return v3_norm(wrench.f);
}

/* Pressure sums times dW/dU. */
static void set_pressures(fl_surrogate *s, const fl_pressure_moments *q, const fl_force_sum *sums,
                          double scale)
{
    const fl_vec3 acts = fl_surrogate_force_centre(q->direction, q->torque);
    s->pressure = scale * q->pressure;
    s->direction = v3_scale(scale, q->direction), s->torque = v3_scale(scale, q->torque);
    s->centre_offset = v3_sub(q->centre, acts);
    for (int k = 0; k < FL_PRESSURE_MATRIX; k++) s->damping[k] = scale * q->damping[k];
    const fl_pressure_shape shape =
        fl_pressure_shape_about(sums->pressure, sums->pressure_moment, sums->second, v3_unit(q->direction));
    s->arm = shape.arm, s->elongation = shape.elongation;
}

/* Product of a symmetric matrix, given by its upper triangle, with x. */
static void multiply_upper(fl_vec6 out, const double *A, const fl_vec6 x)
{
    for (int r = 0; r < 6; r++) {
        out[r] = 0.0;
        for (int c = 0; c < 6; c++) out[r] += A[FL_UPPER[r][c]] * x[c];
    }
}

/* Width and skewness of the pressure distribution that reproduce the no-tension correction of the exact
 * evaluation. */
static void fit_no_tension(fl_surrogate *s, const fl_exact_contact *seen)
{
    const fl_pressure_moments *of = seen->pressing;
    const fl_force_sum *q = seen->sums;
    const double E = of->pressure, chi = seen->impact_damping;
    fl_vec6 V, still, moving, damped;
    s->half_width = FL_UNIFORM_HALF_WIDTH, s->skewness = 1.0;
    set_vec6(V, seen->v, seen->spin);
    set_vec6(still, of->direction, of->torque);
    set_vec6(damped, q->damping.f, q->damping.m);
    multiply_upper(moving, of->damping, V);
    const double closing = -dot6(still, V) / E, mean = 1.0 + chi * (closing + seen->speed_offset),
                 var = chi * chi * (dot6(moving, V) / E - closing * closing),
                 p = q->damped_pressure / E - mean;
    for (int k = 0; k < 6; k++) moving[k] -= seen->speed_offset * still[k];
    if (!(var > MIN_CORRECTION)) return;
    /* nothing or everything is corrected: uniform, but not wider than that */
    if (!(p > MIN_CORRECTION && mean + p > MIN_CORRECTION)) {
        const double most = fabs(mean) / sqrt(var);
        if (s->half_width > most) s->half_width = most;
        return;
    }
    s->half_width = fl_no_tension_half_width(mean, p) / sqrt(var);
    const fl_no_tension even = fl_no_tension_of(mean, var, s->half_width * sqrt(var), 1.0);
    double more = 0.0, size2 = 0.0;
    for (int k = 0; k < 6; k++) {
        const double x = -chi * moving[k] - (mean - 1.0) * still[k],
                     g = damped[k] + chi * moving[k] - p * still[k],
                     by = k < 3 ? 1.0 : 1.0 / (s->length * s->length);
        more += by * x * g, size2 += by * x * x;
    }
    if (even.q < 0.0 && size2 > 0.0) s->skewness = more / size2 / even.q;
    if (!(s->skewness > 0.0)) s->skewness = 0.0;
}

/* Path and rotation of A for which no point of it moves by more than seen->free_path, and a corner without
 * pressure comes nearer by a part of the radii at most.  As convex bodies slide no point is deeper than
 * predicted linearly; where walls overhang each other one may be, at once. */
static void set_free_travel(fl_surrogate *s, const fl_exact_contact *seen)
{
    const double farthest = v3_norm(v3_sub(s->point, s->o)) + seen->radius_a,
                 part = farthest > s->length ? s->length / farthest : 1.0;
    s->free_path = part * seen->free_path;
    s->free_turn = part * FREE_TURN_SHARE * seen->radii;
}

static void set_from_evaluation(fl_surrogate *s, const fl_exact_contact *seen,
                                const fl_surrogate_record *last)
{
    const fl_pressure_moments *pressing = seen->pressing;
    const fl_force_sum *q = seen->sums;
    fl_vec6 slope;
    s->valid = s->used = 0;
    s->force = slope_of_energy(s, seen, slope);
    if (!(s->force > 0.0 && seen->slope > 0.0 && pressing->pressure > 0.0)) return;
    s->M = *seen->M, s->o = seen->o, s->point = v3_add(s->o, m3_mul(s->M, s->point_a));
    s->first_point = seen->first;
    s->counts_along_plane = seen->b_is_plane ? 0.0 : 1.0;
    s->overlap = q->overlap, s->energy = seen->energy, s->slope = seen->slope, s->inv_mass = seen->inv_mass,
    s->compliance = seen->compliance, s->turn_compliance = seen->turn_compliance;
    set_free_travel(s, seen);
    compute_curvature(s, seen, slope, v3_sub(s->first_point, s->point), last);
    set_pressures(s, pressing, seen->sums, seen->scale);
    s->other_force = v3_sub(v3_scale(seen->scale, q->gradient.f), s->direction);
    s->centre = fl_surrogate_force_centre(q->gradient.f, q->gradient.m);
    s->valid = s->force > MIN_NET_FORCE * s->pressure && v3_norm2(s->direction) > 0.0;
}

/* Adds the term b s^2 to H. */
static void add_defect_return(fl_surrogate *s)
{
    for (int r = 0; r < 6; r++)
        for (int c = r; c < 6; c++)
            s->H[FL_UPPER[r][c]] += 2.0 * s->defect_return * s->path_direction[r] * s->path_direction[c];
}

void fl_surrogate_set(fl_surrogate *s, const fl_exact_contact *seen)
{
    set_from_evaluation(s, seen, NULL);
    add_defect_return(s);
}

/* Relative error of dF/ds. */
static double slope_error(const fl_surrogate *s, const fl_surrogate_value *value, double slope)
{
    const double more = trend_factor(s->slope_trend, path_along(s, value)) * slope / value->slope - 1.0;
    return fabs(more) < 0.5 ? more : 0.0;
}

/* Slope trend c, from that error over the path, in the present length l. */
static void set_slope_trend(fl_surrogate *s, const fl_surrogate_record *last, double more)
{
    const double way = sqrt(dot6(last->path, last->path));
    s->slope_trend = way > MIN_RECORD_PATH * s->overlap ? more / way : 0.0;
}

/* Record of the evaluation that was the last until now, and the path since then. */
static fl_surrogate_record record_of(const fl_surrogate *s, const fl_surrogate_value *value)
{
    fl_surrogate_record b = {.energy = s->energy};
    for (int k = 0; k < 6; k++) b.slope[k] = s->power * s->energy * s->g[k], b.path[k] = value->q[k];
    return b;
}

/* Error of z at the end of a path, without the returned part, over the fourth power of the path in overlaps:
 * the omitted terms are of that order.  0 for short paths, which something else has ended. */
static double jump_coefficient(const fl_surrogate *s, const fl_surrogate_value *value, double energy)
{
    const double g = path_along(s, value), way = value->path / s->overlap, w2 = way * way,
                 pull = s->power * value->energy / value->z;
    return has_third_order(s) && way > MIN_PATH * s->reach && way > MIN_RECORD_PATH && value->z > 0.0
               ? ((energy - value->energy) / pull + s->defect_return * g * g) / (w2 * w2)
               : 0.0;
}

/* Return coefficient b: the energy defect, and the jump expected at the end of the next path.  part: of the
 * force, at the end of the path at most. */
static void set_defect_return(fl_surrogate *s, double runs, double part)
{
    const double pull = s->power * s->energy, way = s->reach * s->overlap, r2 = s->reach * s->reach,
                 b = (s->energy_defect / pull + runs * r2 * r2) / (way * way),
                 most = 0.5 * part * s->force / (pull * way);
    s->defect_return = !s->valid || !has_third_order(s) ? 0.0 : b > most ? most : b < -most ? -most : b;
}

double fl_surrogate_update(fl_surrogate *s, const fl_surrogate_value *value, const fl_exact_contact *seen,
                           double tolerance)
{
    fl_vec6 slope;
    fl_surrogate_record last = {0};
    double off = 0.0, runs = 0.0;
    if (value) {
        const double force = slope_of_energy(s, seen, slope);
        last = record_of(s, value);
        if (s->used && value->z > 0.0) s->energy_defect += seen->energy - value->energy;
        runs = jump_coefficient(s, value, seen->energy);
        if (force > 0.0) off = update_reach(s, value, &last, slope, force, seen->motion_force, tolerance);
        const double more = slope_error(s, value, seen->slope);
        grow_length(s, &last, seen->pressing->radius);
        set_slope_trend(s, &last, more);
    } else {
        start_surrogate(s, seen, tolerance);
    }
    set_from_evaluation(s, seen, &last);
    if (s->valid) fit_no_tension(s, seen);
    set_defect_return(s, runs, MAX_RETURN * tolerance);
    add_defect_return(s);
    if (s->valid && (seen->stiffness_i > 0.0 || seen->stiffness_j > 0.0))
        s->stiffness_i = seen->stiffness_i / s->slope, s->stiffness_j = seen->stiffness_j / s->slope;
    return off;
}
