/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/mechanism.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

/* Pivot of a motion without stiffness, over its diagonal element; size of a displacement of its mode, over
 * the largest one. */
static const double PIVOT = 1e-9, MOVED = 1e-4;

typedef struct {
    int32_t n;       /* unknowns */
    int32_t *number; /* [6 nodes], -1 where held or without stiffness */
    int32_t *dof;    /* [n] 6 node + freedom */
    int64_t *start;  /* [n + 1] of row i in k */
    int32_t *low;    /* [n] first column of row i */
    double *k, *diagonal, *mode;
} profile;

static void free_profile(profile *p)
{
    free(p->number);
    free(p->dof);
    free(p->start);
    free(p->low);
    free(p->k);
    free(p->diagonal);
    free(p->mode);
}

static int is_released(const fl_member_model *m, const fl_member *b, int end)
{
    return b->released[end] || m->node[b->end[end]].hinge;
}

static int number_freedoms(profile *p, const fl_member_model *m, fl_err *err)
{
    const int32_t nodes = m->node_name.n;
    p->number = fl_alloc(6 * (int64_t)nodes, sizeof *p->number, err);
    p->dof = fl_alloc(6 * (int64_t)nodes, sizeof *p->dof, err);
    char *turns = fl_alloc(nodes, 1, err);
    for (int32_t k = 0; k < m->member_name.n && !err->code; k++)
        for (int s = 0; s < 2; s++)
            if (!is_released(m, &m->member[k], s)) turns[m->member[k].end[s]] = 1;
    for (int32_t d = 0; d < 6 * nodes && !err->code; d++) {
        const int held = m->node[d / 6].fixed >> d % 6 & 1;
        p->number[d] = held || (d % 6 > 2 && !turns[d / 6]) ? -1 : p->n;
        if (p->number[d] >= 0) p->dof[p->n++] = d;
    }
    free(turns);
    return err->code ? -1 : 0;
}

/* 1 where the profile is too large to be tested. */
static int make_profile(profile *p, const fl_member_model *m, fl_err *err)
{
    p->low = fl_alloc(p->n, sizeof *p->low, err);
    p->start = fl_alloc((int64_t)p->n + 1, sizeof *p->start, err);
    if (err->code) return -1;
    for (int32_t i = 0; i < p->n; i++) p->low[i] = i;
    for (int32_t k = 0; k < m->member_name.n; k++) {
        int32_t least = p->n;
        for (int d = 0; d < 12; d++) {
            const int32_t i = p->number[6 * m->member[k].end[d / 6] + d % 6];
            if (i >= 0 && i < least) least = i;
        }
        for (int d = 0; d < 12; d++) {
            const int32_t i = p->number[6 * m->member[k].end[d / 6] + d % 6];
            if (i >= 0 && least < p->low[i]) p->low[i] = least;
        }
    }
    for (int32_t i = 0; i < p->n; i++) p->start[i + 1] = p->start[i] + i - p->low[i] + 1;
    if (p->start[p->n] > FL_MECHANISM_MOST) return 1;
    p->k = fl_alloc(p->start[p->n], sizeof *p->k, err);
    p->diagonal = fl_alloc(p->n, sizeof *p->diagonal, err);
    p->mode = fl_alloc(p->n, sizeof *p->mode, err);
    return err->code ? -1 : 0;
}

/* Adds stiff (g.u)2/2 for a linear form g over the 12 freedoms of a member. */
static void add_form(profile *p, const fl_member *b, const double g[12], double stiff)
{
    for (int r = 0; r < 12; r++)
        for (int c = 0; c < 12; c++) {
            const int32_t i = p->number[6 * b->end[r / 6] + r % 6], j = p->number[6 * b->end[c / 6] + c % 6];
            if (i >= 0 && j >= 0 && j <= i) p->k[p->start[i] + j - p->low[i]] += stiff * g[r] * g[c];
        }
}

static void put_vector(double *g, double s, fl_vec3 a)
{
    g[0] += s * a.x;
    g[1] += s * a.y;
    g[2] += s * a.z;
}

/* Bending in one plane: `across` the direction of deflection, `about` the axis of rotation, sign of the
 * slope.
 * With the rotations t1, t2 from the chord, energy = EI/2L (4 t1^2 + 4 t1 t2 + 4 t2^2)
 *     = EI/2L [(t1 - t2)^2 + 3 (t1 + t2)^2], and 3 EI/2L t^2 for one hinged end. */
static void add_bending(profile *p, const fl_member *b, fl_vec3 across, fl_vec3 about, double sign, double ei,
                        double l, const int hinge[2])
{
    double t[2][12] = {{0}};
    for (int s = 0; s < 2; s++) {
        put_vector(&t[s][3 + 6 * s], 1.0, about);
        put_vector(&t[s][0], sign / l, across);
        put_vector(&t[s][6], -sign / l, across);
    }
    if (hinge[0] && hinge[1]) return;
    if (hinge[0] || hinge[1]) {
        add_form(p, b, t[hinge[0] ? 1 : 0], 3.0 * ei / l);
        return;
    }
    double sum[12], difference[12];
    for (int k = 0; k < 12; k++) {
        sum[k] = t[0][k] + t[1][k];
        difference[k] = t[0][k] - t[1][k];
    }
    add_form(p, b, sum, 3.0 * ei / l);
    add_form(p, b, difference, ei / l);
}

static int add_members(profile *p, const fl_member_model *m, fl_err *err)
{
    for (int32_t k = 0; k < m->member_name.n; k++) {
        const fl_member *b = &m->member[k];
        const fl_member_section *s = &m->section[b->section];
        const int hinge[2] = {is_released(m, b, 0), is_released(m, b, 1)};
        double axial[12] = {0}, twist[12] = {0}, l;
        fl_vec3 e[3];
        if (fl_member_frame(m, k, e, &l, err)) return -1;
        put_vector(&axial[0], -1.0, e[0]);
        put_vector(&axial[6], 1.0, e[0]);
        add_form(p, b, axial, s->ea / l);
        if (!hinge[0] && !hinge[1]) {
            put_vector(&twist[3], -1.0, e[0]);
            put_vector(&twist[9], 1.0, e[0]);
            add_form(p, b, twist, s->gj / l);
        }
        add_bending(p, b, e[1], e[2], 1.0, s->eiz, l, hinge);
        add_bending(p, b, e[2], e[1], -1.0, s->eiy, l, hinge);
    }
    return 0;
}

static double *row_of(const profile *p, int32_t i) { return p->k + p->start[i] - p->low[i]; }

/* Motion that pivot i leaves without resistance: L11^T x = -row i of L, x_i = 1.  The freedom that moves a
 * node most, -1 where it only turns nodes. */
static int32_t find_motion(profile *p, int32_t i)
{
    const double *at = row_of(p, i);
    double most = 0.0, moved = 0.0;
    int32_t which = -1;
    for (int32_t j = 0; j < i; j++) p->mode[j] = j >= p->low[i] ? -at[j] : 0.0;
    for (int32_t j = i - 1; j >= 0; j--) {
        const double *l = row_of(p, j);
        for (int32_t c = p->low[j]; c < j; c++) p->mode[c] -= l[c] * p->mode[j];
    }
    p->mode[i] = 1.0;
    if (p->diagonal[i] == 0.0) return p->dof[i] % 6 < 3 ? p->dof[i] : -1;
    for (int32_t j = 0; j <= i; j++) {
        /* Times the root of the diagonal element, so that lengths and angles compare. */
        const double size = fabs(p->mode[j]) * sqrt(p->diagonal[j]);
        if (size > most) most = size;
        if (p->dof[j] % 6 < 3 && size > moved) {
            moved = size;
            which = p->dof[j];
        }
    }
    return moved > MOVED * most ? which : -1;
}

/* L D L^T in place, row by row: below the diagonal L, on it D. */
static int factor(profile *p, const fl_member_model *m, fl_err *err)
{
    static const char *const axis[] = {"x", "y", "z"};
    for (int32_t i = 0; i < p->n; i++) {
        double *a = row_of(p, i);
        p->diagonal[i] = a[i];
        for (int32_t j = p->low[i]; j < i; j++) { /* a[j] becomes L_ij D_j */
            const double *l = row_of(p, j);
            double sum = a[j];
            for (int32_t c = p->low[i] > p->low[j] ? p->low[i] : p->low[j]; c < j; c++) sum -= a[c] * l[c];
            a[j] = sum;
        }
        double pivot = a[i];
        for (int32_t j = p->low[i]; j < i; j++) {
            const double scaled = a[j] / row_of(p, j)[j];
            pivot -= a[j] * scaled;
            a[j] = scaled;
        }
        a[i] = pivot;
        if (pivot > PIVOT * p->diagonal[i]) continue;
        const int32_t d = find_motion(p, i);
        if (d >= 0)
            return fl_fail(err, FL_INPUT,
                           "%s:%lld: the structure is a mechanism: node %s moves along %s without resistance",
                           m->file, (long long)m->node[d / 6].line, m->node_name.name[d / 6], axis[d % 6]);
        a[i] = p->diagonal[i] > 0.0 ? p->diagonal[i] : 1.0; /* a spin: held */
    }
    return 0;
}

int fl_member_check_mechanism(const fl_member_model *m, fl_err *err)
{
    profile p = {0};
    int rc = number_freedoms(&p, m, err);
    if (rc == 0) rc = make_profile(&p, m, err);
    if (rc == 0) rc = add_members(&p, m, err) ? -1 : factor(&p, m, err);
    free_profile(&p);
    return rc < 0 ? -1 : 0;
}
