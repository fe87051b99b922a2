/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_modes.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/pi.h"
#include "base/rng.h"

/* Change of omega2 from one iteration to the next, over itself. */
static const double STILL = 1e-11;
enum { ITERATIONS = 300, EXTRA = 8, SWEEPS = 60 };

int fl_member_masses(const fl_member_chain *c, const fl_member_model *m, double *mass, double *inertia,
                     fl_err *err)
{
    for (int32_t b = 0; b < c->balls; b++) {
        mass[b] = b < c->nodes ? m->node[b].mass : 0.0;
        inertia[b] = 0.0;
    }
    for (int32_t k = 0; k < c->contacts; k++) {
        const fl_member_contact *e = &c->contact[k];
        const fl_member *b = &m->member[e->member];
        const fl_member_section *s = &m->section[b->section];
        const double half = 0.5 * s->mass * e->length, l2 = e->length * e->length / 12.0,
                     r2 = 0.5 * (s->eiy + s->eiz) / s->ea;
        if (!(s->mass > 0.0))
            return fl_fail(
                err, FL_INPUT,
                "%s:%lld: member %s has no mass: its section %s needs a density, or a mass per length",
                m->file, (long long)b->line, m->member_name.name[e->member],
                m->section_name.name[b->section]);
        mass[e->i] += half;
        mass[e->j] += half;
        inertia[e->i] += half * (l2 + r2 + v3_norm2(e->arm[0]));
        inertia[e->j] += half * (l2 + r2 + v3_norm2(e->arm[1]));
    }
    return 0;
}

/* --- eigenvectors of two small matrices -------------------------------------------------------- */

/* a = V diag(d) V^T by rotations of Jacobi; a[n][n] is destroyed. */
static void eigen_symmetric(int n, double *a, double *v, double *d)
{
    for (int r = 0; r < n; r++)
        for (int c = 0; c < n; c++) v[r * n + c] = r == c;
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double off = 0.0, on = 0.0;
        for (int r = 0; r < n; r++)
            for (int c = 0; c < n; c++) *(r == c ? &on : &off) += a[r * n + c] * a[r * n + c];
        if (!(off > 1e-30 * on)) break;
        for (int p = 0; p < n; p++)
            for (int q = p + 1; q < n; q++) {
                if (a[p * n + q] == 0.0) continue;
                const double half = 0.5 * (a[q * n + q] - a[p * n + p]) / a[p * n + q];
                const double t = (half < 0.0 ? -1.0 : 1.0) / (fabs(half) + sqrt(half * half + 1.0));
                const double co = 1.0 / sqrt(t * t + 1.0), si = t * co;
                for (int k = 0; k < n; k++) {
                    const double x = a[k * n + p], y = a[k * n + q];
                    a[k * n + p] = co * x - si * y;
                    a[k * n + q] = si * x + co * y;
                }
                for (int k = 0; k < n; k++) {
                    const double x = a[p * n + k], y = a[q * n + k];
                    a[p * n + k] = co * x - si * y;
                    a[q * n + k] = si * x + co * y;
                }
                for (int k = 0; k < n; k++) {
                    const double x = v[k * n + p], y = v[k * n + q];
                    v[k * n + p] = co * x - si * y;
                    v[k * n + q] = si * x + co * y;
                }
            }
    }
    for (int k = 0; k < n; k++) d[k] = a[k * n + k];
}

/* --- the iteration ----------------------------------------------------------------------------- */

typedef struct {
    const fl_member_stiffness *s;
    int32_t n;      /* unknowns */
    int p;          /* vectors */
    double *m;      /* [n] masses of the unknowns */
    double *x, *y;  /* [p][n] */
    double *k2, *v; /* [p][p] */
    double *d, *omega2;
    int *order;
} subspace;

static void free_subspace(subspace *u)
{
    free(u->m), free(u->x), free(u->y), free(u->k2), free(u->v), free(u->d), free(u->omega2), free(u->order);
}

static int make_subspace(subspace *u, int32_t modes, const double *mass, const double *inertia, fl_err *err)
{
    int64_t moving = 0;
    u->n = u->s->n;
    u->m = fl_alloc(u->n, sizeof *u->m, err);
    for (int32_t i = 0; i < u->n && u->m; i++) {
        const int32_t b = u->s->dof[i] / 6;
        u->m[i] = u->s->dof[i] % 6 < 3 ? mass[b] : inertia[b];
        moving += u->m[i] > 0.0;
    }
    u->p = 2 * modes < modes + EXTRA ? 2 * modes : modes + EXTRA;
    if (u->p > moving) u->p = (int)moving;
    const int64_t pp = (int64_t)u->p * u->p;
    u->x = fl_alloc((int64_t)u->p * u->n, sizeof *u->x, err);
    u->y = fl_alloc((int64_t)u->p * u->n, sizeof *u->y, err);
    u->k2 = fl_alloc(pp, sizeof *u->k2, err);
    u->v = fl_alloc(pp, sizeof *u->v, err);
    u->d = fl_alloc(u->p, sizeof *u->d, err);
    u->omega2 = fl_alloc(u->p, sizeof *u->omega2, err);
    u->order = fl_alloc(u->p, sizeof *u->order, err);
    if (err->code) return -1;
    for (int a = 0; a < u->p; a++) {
        fl_rng g = fl_rng_of(1, a, FL_RNG_OFFSET);
        for (int32_t i = 0; i < u->n; i++)
            u->x[(int64_t)a * u->n + i] = u->m[i] > 0.0 ? fl_rng_in(&g, -1.0, 1.0) / sqrt(u->m[i]) : 0.0;
    }
    return 0;
}

/* y becomes M-orthonormal, vector by vector and twice, since the first are nearly the same; x, which is K
 * y, follows. Vectors that depend on those before come from elsewhere. */
static void orthonormalise(subspace *u)
{
    for (int c = 0; c < u->p; c++) {
        double *y = u->y + (int64_t)c * u->n, *z = u->x + (int64_t)c * u->n;
        for (int pass = 0; pass < 2; pass++) {
            for (int r = 0; r < c; r++) {
                const double *q = u->y + (int64_t)r * u->n, *kq = u->x + (int64_t)r * u->n;
                double part = 0.0;
                for (int32_t i = 0; i < u->n; i++) part += q[i] * u->m[i] * y[i];
                for (int32_t i = 0; i < u->n; i++) {
                    y[i] -= part * q[i];
                    z[i] -= part * kq[i];
                }
            }
            double norm2 = 0.0;
            for (int32_t i = 0; i < u->n; i++) norm2 += u->m[i] * y[i] * y[i];
            const double over = norm2 > 0.0 ? 1.0 / sqrt(norm2) : 0.0;
            for (int32_t i = 0; i < u->n; i++) {
                y[i] *= over;
                z[i] *= over;
            }
        }
    }
}

/* Rayleigh and Ritz: with y = K^-1 M x made orthonormal, y.K y = V omega2 V^T, and the next x are y V. */
static void turn_to_modes(subspace *u)
{
    const int p = u->p;
    orthonormalise(u);
    for (int r = 0; r < p; r++)
        for (int c = 0; c <= r; c++) {
            const double *yr = u->y + (int64_t)r * u->n, *yc = u->y + (int64_t)c * u->n,
                         *zr = u->x + (int64_t)r * u->n, *zc = u->x + (int64_t)c * u->n;
            double k = 0.0; /* symmetric but for rounding */
            for (int32_t i = 0; i < u->n; i++) k += 0.5 * (yr[i] * zc[i] + yc[i] * zr[i]);
            u->k2[r * p + c] = u->k2[c * p + r] = k;
        }
    eigen_symmetric(p, u->k2, u->v, u->d);
    for (int k = 0; k < p; k++) { /* ascending, by insertion */
        int at = k;
        for (; at > 0 && u->d[u->order[at - 1]] > u->d[k]; at--) u->order[at] = u->order[at - 1];
        u->order[at] = k;
    }
    for (int c = 0; c < p; c++) {
        double *x = u->x + (int64_t)c * u->n;
        memset(x, 0, (size_t)u->n * sizeof *x);
        for (int k = 0; k < p; k++) {
            const double *y = u->y + (int64_t)k * u->n, f = u->v[k * p + u->order[c]];
            for (int32_t i = 0; i < u->n; i++) x[i] += f * y[i];
        }
    }
}

static int iterate(subspace *u, int32_t modes, fl_err *err)
{
    for (int pass = 0; pass < ITERATIONS; pass++) {
        for (int a = 0; a < u->p; a++) {
            double *y = u->y + (int64_t)a * u->n, *x = u->x + (int64_t)a * u->n;
            for (int32_t i = 0; i < u->n; i++) y[i] = x[i] *= u->m[i];
            fl_member_stiffness_solve(u->s, y);
        }
        turn_to_modes(u);
        int still = pass > 0;
        for (int a = 0; a < u->p; a++) {
            const double now = u->d[u->order[a]];
            if (a < modes && !(fabs(now - u->omega2[a]) <= STILL * now)) still = 0;
            u->omega2[a] = now;
        }
        if (still) return 0;
    }
    return fl_fail(err, FL_NUMERIC, "modes: %d of them did not converge in %d iterations", (int)modes,
                   ITERATIONS);
}

int fl_member_modes_find(fl_member_modes *out, const fl_member_stiffness *s, int32_t balls,
                         const double *mass, const double *inertia, int32_t n, fl_err *err)
{
    subspace u = {.s = s};
    *out = (fl_member_modes){.balls = balls};
    int rc = make_subspace(&u, n, mass, inertia, err);
    if (rc == 0 && n > u.p) n = u.p;
    if (rc == 0) rc = iterate(&u, n, err);
    out->omega = fl_alloc(n, sizeof *out->omega, err);
    out->shape = fl_alloc(6 * (int64_t)balls * n, sizeof *out->shape, err);
    if (rc == 0 && err->code) rc = -1;
    for (int32_t k = 0; k < n && rc == 0; k++) {
        const double *x = u.x + (int64_t)k * u.n;
        double *shape = out->shape + 6 * (int64_t)balls * k, norm2 = 0.0, most = 0.0;
        for (int32_t i = 0; i < u.n; i++) {
            norm2 += u.m[i] * x[i] * x[i];
            if (s->dof[i] % 6 < 3 && fabs(x[i]) > fabs(most) * (1.0 + 1e-6)) most = x[i];
        }
        const double scale = (most < 0.0 ? -1.0 : 1.0) / sqrt(norm2);
        for (int32_t i = 0; i < u.n; i++) shape[s->dof[i]] = scale * x[i];
        out->omega[k] = sqrt(u.omega2[k]);
        out->n++;
    }
    free_subspace(&u);
    if (rc) fl_member_modes_free(out);
    return rc;
}

void fl_member_modes_free(fl_member_modes *m)
{
    free(m->omega);
    free(m->shape);
    *m = (fl_member_modes){0};
}

/* Largest displacement of a ball. */
static double largest_of(const fl_member_modes *m, int32_t k)
{
    double most2 = 0.0;
    for (int32_t b = 0; b < m->balls; b++) {
        const double *u = m->shape + 6 * ((int64_t)m->balls * k + b);
        most2 = fmax(most2, u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    }
    return sqrt(most2);
}

double fl_member_modes_mass(const fl_member_modes *m, int32_t k)
{
    const double most = largest_of(m, k);
    return 1.0 / (most * most);
}

static void put_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    putc('\t', f);
    fputs(fl_number_text(x, text), f);
}

void fl_member_modes_write(FILE *f, const fl_member_modes *m, const fl_member_model *model, double ratio,
                           const fl_history_line *by)
{
    const int32_t nodes = model->node_name.n;
    fl_write_file_header(f, "modes", 1, model->history, by);
    fputs("mode\tf\tmass\tratio", f);
    for (int32_t b = 0; b < nodes; b++)
        for (int d = 0; d < 3; d++) fprintf(f, "\t%s.%c", model->node_name.name[b], 'x' + d);
    putc('\n', f);
    for (int32_t k = 0; k < m->n; k++) {
        const double most = largest_of(m, k);
        fprintf(f, "%d", (int)k + 1);
        put_number(f, m->omega[k] / (2.0 * PI));
        put_number(f, fl_member_modes_mass(m, k));
        put_number(f, ratio);
        for (int32_t b = 0; b < nodes; b++)
            for (int d = 0; d < 3; d++) put_number(f, m->shape[6 * ((int64_t)m->balls * k + b) + d] / most);
        putc('\n', f);
    }
}
