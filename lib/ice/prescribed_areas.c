/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/pi.h"
#include "base/rng.h"
#include "ice/prescribed_areas.h"

/* MANY: with fewer rows of the matrix a parallel loop costs more than it saves. */
enum { TRIES = 300, STEPS = 60, HALVES = 30, ROUNDS = 24, IDLE = 3, MANY = 8192, FEW = 2000, GROUPS = 500 };

/* Relative tolerances: while sites still move; for the fit of the floes, below its resolution; mean error
 * at which the fit ends; for cells alone. */
#define ROUGH 0.02
#define NEAR 2e-6
#define FITTED 1e-5
#define EXACT 1e-9
/* Initial estimate of the area of a cell over its squared inscribed radius: 3.46 for a regular hexagon,
 * somewhat more for cells of random sites. */
#define SHAPE 3.7
/* Largest factor on the size of a cell from round to round. */
#define LEAP 4.0

/* --- places --------------------------------------------------------------------------------------------- */

/* Discs sorted by the grid squares that their boxes touch.  A square has the size of the mean cell, so
 * that n discs touch of the order of n squares for any sizes. */
struct disc_grid {
    double h;
    fl_vec2 lo;
    int32_t nx, ny, used, cap;
    int32_t *head; /* [nx ny] last entry, -1 for none */
    struct entry {
        int32_t disc, next;
    } * entry;
};

static int32_t clamp_index(double x, int32_t n) { return x < 0.0 ? 0 : x < n ? (int32_t)x : n - 1; }

static void squares_of(const struct disc_grid *g, fl_vec2 p, double r, int32_t *at)
{
    at[0] = clamp_index((p.x - r - g->lo.x) / g->h, g->nx);
    at[1] = clamp_index((p.x + r - g->lo.x) / g->h, g->nx);
    at[2] = clamp_index((p.y - r - g->lo.y) / g->h, g->ny);
    at[3] = clamp_index((p.y + r - g->lo.y) / g->h, g->ny);
}

static int is_place_free(const struct disc_grid *g, const fl_vec2 *site, const double *weight, fl_vec2 p,
                         double r)
{
    int32_t at[4];
    squares_of(g, p, r, at);
    for (int32_t y = at[2]; y <= at[3]; y++)
        for (int32_t x = at[0]; x <= at[1]; x++)
            for (int32_t e = g->head[y * g->nx + x]; e >= 0; e = g->entry[e].next) {
                const int32_t j = g->entry[e].disc;
                if (hypot(site[j].x - p.x, site[j].y - p.y) <= r + sqrt(weight[j])) return 0;
            }
    return 1;
}

static int add_disc(struct disc_grid *g, int32_t i, fl_vec2 p, double r, fl_err *err)
{
    int32_t at[4];
    squares_of(g, p, r, at);
    for (int32_t y = at[2]; y <= at[3]; y++)
        for (int32_t x = at[0]; x <= at[1]; x++) {
            int32_t *head = &g->head[y * g->nx + x];
            if (fl_grow(&g->entry, &g->cap, (int64_t)g->used + 1, sizeof *g->entry, err)) return -1;
            g->entry[g->used] = (struct entry){i, *head};
            *head = g->used++;
        }
    return 0;
}

struct ranked {
    double area;
    int32_t i;
};

static int largest_first(const void *a, const void *b)
{
    const struct ranked *p = a, *q = b;
    return p->area != q->area ? (p->area < q->area) - (p->area > q->area) : (p->i > q->i) - (p->i < q->i);
}

int fl_prescribed_areas_sites(int32_t n, uint64_t seed, const double *area, const fl_outline *in,
                              fl_vec2 *site, double *weight, fl_err *err)
{
    const double wx = in->hi.x - in->lo.x, wy = in->hi.y - in->lo.y;
    struct disc_grid g = {.h = sqrt(wx * wy / n), .lo = in->lo};
    struct ranked *order = fl_alloc(n, sizeof *order, err);
    int rc = -1;
    if (!order) goto done;
    /* a field of one row or column of squares needs at most n of them */
    g.nx = (int32_t)(fmin(wx / g.h, n) + 1.0);
    g.ny = (int32_t)(fmin(wy / g.h, n) + 1.0);
    g.head = fl_alloc((int64_t)g.nx * g.ny, sizeof *g.head, err);
    if (!g.head) goto done;
    for (int64_t k = 0; k < (int64_t)g.nx * g.ny; k++) g.head[k] = -1;
    for (int32_t i = 0; i < n; i++) order[i] = (struct ranked){area[i], i};
    qsort(order, (size_t)n, sizeof *order, largest_first);
    for (int32_t k = 0; k < n; k++) {
        const int32_t i = order[k].i;
        double r = sqrt(FL_SITE_DISC_COVER * area[i] / PI);
        fl_rng rng = fl_rng_of(seed, i, FL_RNG_SITE);
        fl_vec2 p;
        for (int tries = 1;; tries++) {
            p.x = fl_rng_in(&rng, in->lo.x, in->hi.x);
            p.y = fl_rng_in(&rng, in->lo.y, in->hi.y);
            if (fl_outline_contains(in, p, r) && is_place_free(&g, site, weight, p, r)) break;
            if (tries % TRIES == 0) r *= 0.9;
        }
        site[i] = p;
        weight[i] = r * r;
        if (add_disc(&g, i, p, r, err)) goto done;
    }
    rc = 0;
done:
    free(order);
    free(g.head);
    free(g.entry);
    return rc;
}

/* --- Newton's method ------------------------------------------------------------------------------------ */

struct newton {
    int32_t n;
    const fl_vec2 *site;
    const double *area;
    double *achieved, *residual, *step,
        *min_area; /* [n] areas [m2], area - achieved [m2], step of the weights, lower bound of achieved */
    double *diagonal, *r, *z, *p, *q; /* [n] of the conjugate gradients */
    double *trial;                    /* [n] weights */
    int32_t groups;                   /* coarse unknowns, 0: none */
    int32_t *group;                   /* [n] of site i */
    double *coarse, *column, *y;      /* [groups^2] Cholesky factor, lower; [groups] scratch */
    double *slope;                    /* [sides] l / (2 |x_i - x_j|), 0 at a wall */
    int32_t slopes;
    void *mem;
};

static int newton_alloc(struct newton *s, fl_err *err)
{
    const size_t n = (size_t)s->n;
    double *m = fl_alloc(10 * (int64_t)s->n, sizeof *m, err);
    if (!m) return -1;
    s->mem = m;
    s->achieved = m;
    s->residual = m + n;
    s->step = m + 2 * n;
    s->min_area = m + 3 * n;
    s->diagonal = m + 4 * n;
    s->r = m + 5 * n;
    s->z = m + 6 * n;
    s->p = m + 7 * n;
    s->q = m + 8 * n;
    s->trial = m + 9 * n;
    return 0;
}

static double dot_product(struct newton *s, const double *a, const double *b, double *scratch)
{
#pragma omp parallel for schedule(static) if (s->n >= MANY)
    for (int32_t i = 0; i < s->n; i++) scratch[i] = a[i] * b[i];
    return fl_parallel_sum(scratch, s->n);
}

static int compute_slopes(struct newton *s, const fl_power_cells *c, fl_err *err)
{
    if (fl_grow(&s->slope, &s->slopes, c->first[s->n], sizeof *s->slope, err)) return -1;
#pragma omp parallel for schedule(static) if (s->n >= MANY)
    for (int32_t i = 0; i < s->n; i++) {
        s->diagonal[i] = 0.0;
        for (int32_t k = c->first[i]; k < c->first[i + 1]; k++) {
            const int32_t j = c->side[k].tag;
            const fl_vec2 a = c->v[k], b = c->v[k + 1 < c->first[i + 1] ? k + 1 : c->first[i]];
            s->slope[k] = 0.0;
            if (j < 0) continue;
            s->slope[k] = 0.5 * hypot(b.x - a.x, b.y - a.y) /
                          hypot(s->site[i].x - s->site[j].x, s->site[i].y - s->site[j].y);
            s->diagonal[i] += s->slope[k];
        }
    }
    return 0;
}

/* q = A p, A: matrix of the slopes. */
static void multiply_matrix(struct newton *s, const fl_power_cells *c)
{
#pragma omp parallel for schedule(static) if (s->n >= MANY)
    for (int32_t i = 0; i < s->n; i++) {
        double sum = s->diagonal[i] * s->p[i];
        for (int32_t k = c->first[i]; k < c->first[i + 1]; k++)
            if (c->side[k].tag >= 0) sum -= s->slope[k] * s->p[c->side[k].tag];
        s->q[i] = sum;
    }
}

/* --- the coarse part of the preconditioner -------------------------------------------------------------- */

/* Group the sites by squares of a grid; the number of squares limits the cost of the factorisation to less
 * than that of the saved iterations. */
static int make_groups(struct newton *s, const fl_outline *in, fl_err *err)
{
    const double wx = in->hi.x - in->lo.x, wy = in->hi.y - in->lo.y;
    const double h = sqrt(wx * wy / fmin(GROUPS, s->n / 8.0));
    const int32_t nx = (int32_t)fmin(wx / h, GROUPS) + 1, ny = (int32_t)fmin(wy / h, GROUPS) + 1;
    int32_t *number = NULL;
    if (s->n < FEW) return 0;
    if (!(s->group = fl_alloc(s->n, sizeof *s->group, err)) ||
        !(number = fl_alloc((int64_t)nx * ny, sizeof *number, err)))
        return -1;
    for (int32_t i = 0; i < s->n; i++) {
        const int32_t x = clamp_index((s->site[i].x - in->lo.x) / h, nx);
        int32_t *k = &number[clamp_index((s->site[i].y - in->lo.y) / h, ny) * nx + x];
        if (*k == 0) *k = ++s->groups;
        s->group[i] = *k - 1;
    }
    free(number);
    s->coarse = fl_alloc((int64_t)s->groups * s->groups, sizeof *s->coarse, err);
    s->column = fl_alloc(s->groups, sizeof *s->column, err);
    s->y = fl_alloc(s->groups, sizeof *s->y, err);
    return s->coarse && s->column && s->y ? 0 : -1;
}

/* Matrix of the slopes for steps that are constant in each group, and its Cholesky factor.  Its kernel
 * contains constants; a multiple of the matrix of ones makes it definite and has no effect on vectors
 * whose sum is zero.  Returns 0, or 1 if rounding made it indefinite. */
static int factor_coarse(struct newton *s, const fl_power_cells *c)
{
    const int32_t n = s->groups;
    double *a = s->coarse, *l = s->column, trace = 0.0;
    memset(a, 0, (size_t)n * (size_t)n * sizeof *a);
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t k = c->first[i]; k < c->first[i + 1]; k++) {
            const int32_t j = c->side[k].tag;
            if (j < 0 || s->group[i] == s->group[j]) continue;
            a[(int64_t)s->group[i] * n + s->group[i]] += s->slope[k];
            a[(int64_t)s->group[i] * n + s->group[j]] -= s->slope[k];
        }
    for (int32_t k = 0; k < n; k++) trace += a[(int64_t)k * n + k];
    for (int64_t k = 0; k < (int64_t)n * n; k++) a[k] += trace / ((double)n * n);
    for (int32_t k = 0; k < n; k++) {
        const double pivot = a[(int64_t)k * n + k];
        if (!(pivot > 1e-12 * trace / n)) return 1;
        for (int32_t i = k; i < n; i++) l[i] = a[(int64_t)i * n + k] /= sqrt(pivot);
#pragma omp parallel for schedule(static) if (n >= 256)
        for (int32_t i = k + 1; i < n; i++) {
            double *row = a + (int64_t)i * n;
            for (int32_t j = k + 1; j <= i; j++) row[j] -= l[i] * l[j];
        }
    }
    return 0;
}

/* z += C r, C: coarse inverse. */
static void apply_coarse(struct newton *s)
{
    const int32_t n = s->groups;
    const double *a = s->coarse;
    double *y = s->y;
    memset(y, 0, (size_t)n * sizeof *y);
    for (int32_t i = 0; i < s->n; i++) y[s->group[i]] += s->r[i];
    for (int32_t k = 0; k < n; k++) {
        for (int32_t j = 0; j < k; j++) y[k] -= a[(int64_t)k * n + j] * y[j];
        y[k] /= a[(int64_t)k * n + k];
    }
    for (int32_t k = n - 1; k >= 0; k--) {
        y[k] /= a[(int64_t)k * n + k];
        for (int32_t j = 0; j < k; j++) y[j] -= a[(int64_t)k * n + j] * y[k];
    }
    for (int32_t i = 0; i < s->n; i++) s->z[i] += y[s->group[i]];
}

/* z = M r, M: preconditioner.  The diagonal accounts for small cells with small slopes.  The coarse part
 * transports area over the whole field, which would otherwise move cell by cell. */
static void precondition(struct newton *s)
{
#pragma omp parallel for schedule(static) if (s->n >= MANY)
    for (int32_t i = 0; i < s->n; i++) s->z[i] = s->r[i] / s->diagonal[i];
    if (s->groups) apply_coarse(s);
}

/* Conjugate gradients on the matrix of the slopes, a graph Laplacian.  Its kernel contains constants, and
 * the sum of the residual is zero, so the iteration stays where the matrix is definite.  A residual of a
 * thousandth is enough for a step.  Source of the two levels: Smith, Bjorstad & Gropp, Domain
 * Decomposition (1996), ch.  2. */
static void find_step(struct newton *s, const fl_power_cells *c)
{
    const int32_t n = s->n, most = 200 + (int32_t)(20.0 * sqrt(n));
    double rz, start;
    if (s->groups && factor_coarse(s, c)) s->groups = 0;
    memset(s->step, 0, (size_t)n * sizeof *s->step);
    memcpy(s->r, s->residual, (size_t)n * sizeof *s->r);
    precondition(s);
    memcpy(s->p, s->z, (size_t)n * sizeof *s->p);
    rz = start = dot_product(s, s->r, s->z, s->q);
    for (int32_t k = 0; k < most && rz > 1e-6 * start; k++) {
        double alpha, before = rz;
        multiply_matrix(s, c);
        alpha = rz / dot_product(s, s->p, s->q, s->trial);
        if (!isfinite(alpha)) return;
#pragma omp parallel for schedule(static) if (n >= MANY)
        for (int32_t i = 0; i < n; i++) {
            s->step[i] += alpha * s->p[i];
            s->r[i] -= alpha * s->q[i];
        }
        precondition(s);
        rz = dot_product(s, s->r, s->z, s->q);
#pragma omp parallel for schedule(static) if (n >= MANY)
        for (int32_t i = 0; i < n; i++) s->p[i] = s->z[i] + rz / before * s->p[i];
    }
}

/* Relative errors of the areas: sum of squares, and the largest. */
static double compute_errors(struct newton *s, double *largest)
{
    *largest = 0.0;
    for (int32_t i = 0; i < s->n; i++) {
        const double e = (s->area[i] - s->achieved[i]) / s->area[i];
        s->residual[i] = s->area[i] - s->achieved[i];
        s->q[i] = e * e;
        if (fabs(e) > *largest) *largest = fabs(e);
    }
    return fl_parallel_sum(s->q, s->n);
}

/* Build the cells for the weights, with the areas in achieved. */
static int build_cells(struct newton *s, fl_power_cells *c, const double *weight, const fl_outline *in,
                       fl_err *err)
{
    fl_power_cells_free(c);
    if (fl_power_cells_build_in(c, s->n, s->site, weight, in, err)) return -1;
    fl_power_cells_areas(c, s->achieved);
    return 0;
}

static int all_cells_large(const struct newton *s)
{
    for (int32_t i = 0; i < s->n; i++)
        if (!(s->achieved[i] > s->min_area[i])) return 0;
    return 1;
}

/* Take one step, halved until no cell is too small and the error decreases sufficiently.  Returns 1 if
 * none does. */
static int take_step(struct newton *s, fl_power_cells *c, double *weight, const fl_outline *in, double *sum,
                     double *largest, fl_err *err)
{
    double part = 1.0;
    for (int half = 0; half < HALVES; half++, part *= 0.5) {
        double now, most;
        for (int32_t i = 0; i < s->n; i++) s->trial[i] = weight[i] + part * s->step[i];
        if (build_cells(s, c, s->trial, in, err)) return -1;
        if (!all_cells_large(s)) continue;
        now = compute_errors(s, &most);
        if (sqrt(now) > (1.0 - 0.5 * part) * sqrt(*sum)) continue;
        memcpy(weight, s->trial, (size_t)s->n * sizeof *weight);
        *sum = now;
        *largest = most;
        return 0;
    }
    return 1;
}

int fl_prescribed_areas_solve(fl_power_cells *out, int32_t n, const fl_vec2 *site, double *weight,
                              const double *area, const fl_outline *in, double tol, fl_err *err)
{
    struct newton s = {.n = n, .site = site, .area = area};
    fl_power_cells c = {0};
    double sum, largest;
    int rc = -1;
    if (newton_alloc(&s, err) || make_groups(&s, in, err) || build_cells(&s, &c, weight, in, err)) goto done;
    if (!all_cells_large(&s)) {
        rc = 1;
        goto done;
    }
    for (int32_t i = 0; i < n; i++) s.min_area[i] = 0.5 * fmin(s.achieved[i], area[i]);
    sum = compute_errors(&s, &largest);
    for (int step = 0; largest > tol; step++) {
        int stuck;
        if (compute_slopes(&s, &c, err)) goto done;
        find_step(&s, &c);
        stuck = step == STEPS ? 1 : take_step(&s, &c, weight, in, &sum, &largest, err);
        if (stuck < 0) goto done;
        if (stuck) {
            fl_fail(err, FL_NUMERIC,
                    "the areas of %d cells do not converge: after %d steps the largest relative error is "
                    "%.2g",
                    n, step, largest);
            goto done;
        }
    }
    *out = c;
    c = (fl_power_cells){0};
    rc = 0;
done:
    free(s.mem);
    free(s.group);
    free(s.coarse);
    free(s.column);
    free(s.y);
    free(s.slope);
    fl_power_cells_free(&c);
    return rc;
}

/* --- floes ---------------------------------------------------------------------------------------------- */

/* Model of a cell of area A, perimeter P and inscribed radius R: an inset of d leaves A - P d + c d^2. c
 * is the sum of the tangents of half the turning angles, while no side vanishes; here it is fitted to the
 * last round. */
struct model {
    double area, outline, c, r; /* [m2, m, 1, m] */
};

struct fit {
    int32_t n;
    const fl_outline *in;
    const double *area;
    double radius, total;
    fl_vec2 *site, *to;
    double *weight, *cell, *achieved; /* [n] */
    struct model *model;              /* [n] */
};

/* Larger root of a x^2 + b x + c, NaN if there is none. */
static double larger_root(double a, double b, double c)
{
    const double disc = b * b - 4.0 * a * c, q = sqrt(disc);
    if (b > 0.0) return -2.0 * c / (b + q);
    return (q - b) / (2.0 * a);
}

/* Factor on the length of a cell that leaves the requested area at inset d.  The inset is at most (1 -
 * FL_FLOES_MIN_CORE) of the radius beyond the dilation radius. */
static double growth_factor(const struct model *m, double requested, double d, double radius)
{
    const double most = 1.0 - FL_FLOES_MIN_CORE;
    double s = larger_root(m->area, -m->outline * d, m->c * d * d - requested);
    if (!(s * m->r - radius > d / most)) { /* limited: its inset is most (s R - radius) */
        const double x = larger_root(m->area - most * m->outline * m->r + most * most * m->c * m->r * m->r,
                                     most * radius * (m->outline - 2.0 * most * m->c * m->r),
                                     most * most * m->c * radius * radius - requested);
        if (x > 0.0) s = x;
    }
    /* the shape of a cell is not preserved when its size changes by more in a round */
    return s < LEAP ? s > 1.0 / LEAP ? s : 1.0 / LEAP : LEAP;
}

static double sum_model_cells(struct fit *s, double d)
{
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < s->n; i++) {
        const double x = growth_factor(&s->model[i], s->area[i], d, s->radius);
        s->cell[i] = s->model[i].area * x * x;
    }
    return fl_parallel_sum(s->cell, s->n);
}

/* Areas of the cells that give the requested floes by the models; d is the inset for which the cells fill
 * the outline. */
static void choose_cell_areas(struct fit *s)
{
    double lo = 0.0, hi = sqrt(s->total), sum;
    for (int k = 0; k < 50; k++) {
        const double d = 0.5 * (lo + hi);
        if (sum_model_cells(s, d) > s->total) hi = d;
        else lo = d;
    }
    sum = sum_model_cells(s, 0.5 * (lo + hi));
    for (int32_t i = 0; i < s->n; i++) s->cell[i] *= s->total / sum;
}

static struct model model_of(const fl_power_cells *c, int32_t i, double inset, double radius, double achieved,
                             fl_vec2 *v, fl_polygon_side *side)
{
    const int32_t first = c->first[i], n = c->first[i + 1] - first;
    struct model m = {.area = fl_polygon_area(n, c->v + first),
                      .outline = fl_polygon_perimeter(n, c->v + first)};
    double d = inset;
    memcpy(v, c->v + first, (size_t)n * sizeof *v);
    memcpy(side, c->side + first, (size_t)n * sizeof *side);
    fl_polygon_inset(n, v, side, INFINITY, &m.r);
    if (d > (1.0 - FL_FLOES_MIN_CORE) * (m.r - radius)) d = (1.0 - FL_FLOES_MIN_CORE) * (m.r - radius);
    m.c = (achieved - m.area + m.outline * d) / (d * d);
    /* sides have vanished: model of a cell that touches its inscribed circle everywhere */
    if (!(4.0 * m.area * m.c < m.outline * m.outline)) {
        const double root_k = (sqrt(m.area) - sqrt(achieved)) / d;
        m.outline = 2.0 * sqrt(m.area) * root_k;
        m.c = root_k * root_k;
    }
    return m;
}

static int fit_models(struct fit *s, const fl_power_cells *c, const fl_floes *a, fl_err *err)
{
    fl_vec2 *v = fl_alloc(c->first[c->n], sizeof *v, err);
    fl_polygon_side *side = fl_alloc(c->first[c->n], sizeof *side, err);
    if (v && side) {
#pragma omp parallel for schedule(static)
        for (int32_t i = 0; i < s->n; i++)
            s->model[i] =
                model_of(c, i, a->inset, s->radius, s->achieved[i], v + c->first[i], side + c->first[i]);
    }
    free(v);
    free(side);
    return v && side ? 0 : -1;
}

/* Mean relative error of the floes, each counted as 1 at most, since a few unreachable floes must not
 * dominate; and the largest. */
static double measure_floes(struct fit *s, const fl_floes *a, double *most)
{
    double sum = 0.0;
    *most = 0.0;
    for (int32_t i = 0; i < s->n; i++) {
        double e;
        s->achieved[i] = fl_polygon_area(a->first[i + 1] - a->first[i], a->outer + a->first[i]);
        e = fabs(s->achieved[i] - s->area[i]) / s->area[i];
        sum += fmin(e, 1.0);
        *most = fmax(*most, e);
    }
    return sum / s->n;
}

/* Move every site to the centroid of its cell, or part of the way if a cell would become empty. */
static int smooth_once(struct fit *s, fl_power_cells *c, fl_err *err)
{
    fl_vec2 *from = s->site, *to = s->to;
    int rc = 1;
    fl_power_cells next = {0};
    fl_power_cells_centroids(c, to);
    for (int half = 0; rc == 1 && half < HALVES; half++) {
        s->site = to;
        rc = fl_prescribed_areas_solve(&next, s->n, to, s->weight, s->cell, s->in, ROUGH, err);
        if (rc == 1)
            for (int32_t i = 0; i < s->n; i++) {
                to[i].x = 0.5 * (to[i].x + from[i].x);
                to[i].y = 0.5 * (to[i].y + from[i].y);
            }
    }
    if (rc == 0) {
        s->to = from;
        fl_power_cells_free(c);
        *c = next;
        return 0;
    }
    s->site = from;
    return rc < 0 ? -1 : 0;
}

static int start_fit(struct fit *s, uint64_t seed, fl_err *err)
{
    const int64_t n = s->n;
    for (int32_t i = 0; i < s->n; i++)
        if (s->area[i] < PI * s->radius * s->radius)
            return fl_fail(
                err, FL_INPUT,
                "a floe of %.4g m2 is requested, which has no room for a dilation radius of %.4g m: "
                "a smaller radius or larger sizes are needed",
                s->area[i], s->radius);
    s->total = fl_outline_area(s->in);
    if (!(s->site = fl_alloc(n, sizeof *s->site, err)) || !(s->to = fl_alloc(n, sizeof *s->to, err)) ||
        !(s->weight = fl_alloc(n, sizeof *s->weight, err)) ||
        !(s->cell = fl_alloc(n, sizeof *s->cell, err)) || !(s->model = fl_alloc(n, sizeof *s->model, err)) ||
        !(s->achieved = fl_alloc(n, sizeof *s->achieved, err)))
        return -1;
    for (int32_t i = 0; i < s->n; i++) {
        const double r = sqrt(s->area[i] / SHAPE);
        s->model[i] = (struct model){s->area[i], 2.0 * SHAPE * r, SHAPE, r};
    }
    choose_cell_areas(s);
    return fl_prescribed_areas_sites(s->n, seed, s->cell, s->in, s->site, s->weight, err);
}

static void free_fit(struct fit *s)
{
    free(s->site);
    free(s->to);
    free(s->weight);
    free(s->cell);
    free(s->model);
    free(s->achieved);
}

int fl_prescribed_areas_cells(fl_power_cells *cells, int32_t n, uint64_t seed, const double *area,
                              const fl_outline *in, int32_t smooth, fl_err *err)
{
    struct fit s = {.n = n, .in = in, .area = area};
    fl_power_cells c = {0}, last = {0};
    int rc = -1;
    if (start_fit(&s, seed, err) ||
        fl_prescribed_areas_solve(&c, n, s.site, s.weight, s.cell, in, ROUGH, err))
        goto done;
    for (int32_t k = 0; k < smooth; k++)
        if (smooth_once(&s, &c, err)) goto done;
    if (fl_prescribed_areas_solve(&last, n, s.site, s.weight, s.cell, in, EXACT, err)) goto done;
    *cells = last;
    rc = 0;
done:
    free_fit(&s);
    fl_power_cells_free(&c);
    return rc;
}

int fl_prescribed_areas_floes(fl_power_cells *cells, fl_floes *floes, int32_t n, uint64_t seed,
                              const double *area, const fl_outline *in, int32_t smooth, double concentration,
                              double radius, fl_vec2 shift, double *off, fl_err *err)
{
    struct fit s = {.n = n, .in = in, .area = area, .radius = radius};
    fl_power_cells c = {0}, best_cells = {0};
    fl_floes a = {0}, best = {0};
    double least = INFINITY, most = INFINITY;
    int rc = -1, idle = 0;
    if (start_fit(&s, seed, err) ||
        fl_prescribed_areas_solve(&c, n, s.site, s.weight, s.cell, in, smooth ? ROUGH : NEAR, err))
        goto done;
    for (int32_t k = 0; k < smooth; k++)
        if (smooth_once(&s, &c, err)) goto done;
    for (int round = 0; round < ROUNDS && idle < IDLE && least > FITTED; round++) {
        double mean;
        fl_power_cells_free(&c);
        fl_floes_free(&a);
        if (fl_prescribed_areas_solve(&c, n, s.site, s.weight, s.cell, in, NEAR, err) ||
            fl_floes_make(&a, &c, concentration, radius, shift, err))
            goto done;
        mean = measure_floes(&s, &a, &most);
        if (fit_models(&s, &c, &a, err)) goto done;
        choose_cell_areas(&s);
        idle = mean < 0.8 * least ? 0 : idle + 1;
        if (mean >= least) continue;
        least = mean;
        *off = most;
        fl_power_cells_free(&best_cells);
        fl_floes_free(&best);
        best_cells = c;
        best = a;
        c = (fl_power_cells){0};
        a = (fl_floes){0};
    }
    *cells = best_cells;
    *floes = best;
    best_cells = (fl_power_cells){0};
    best = (fl_floes){0};
    rc = 0;
done:
    free_fit(&s);
    fl_power_cells_free(&c);
    fl_power_cells_free(&best_cells);
    fl_floes_free(&a);
    fl_floes_free(&best);
    return rc;
}
