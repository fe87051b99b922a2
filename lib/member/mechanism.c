/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/mechanism.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "member/profile_matrix.h"

/* Pivot of a motion without stiffness, over its diagonal element; size of a displacement of its mode, over
 * the largest one. */
static const double PIVOT = 1e-9, MOVED = 1e-4;

typedef struct {
    fl_profile k;
    int32_t n;       /* unknowns */
    int32_t *number; /* [6 nodes], -1 where held or without stiffness */
    int32_t *dof;    /* [n] 6 node + freedom */
    double *mode;
} profile;

static void free_profile(profile *p)
{
    fl_profile_free(&p->k);
    free(p->number);
    free(p->dof);
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
            if (!is_released(m, &m->member[k], s) || v3_nonzero(m->member[k].arm[s]))
                turns[m->member[k].end[s]] = 1;
    for (int32_t d = 0; d < 6 * nodes && !err->code; d++) {
        const int held = m->node[d / 6].fixed >> d % 6 & 1;
        p->number[d] = held || (d % 6 > 2 && !turns[d / 6]) ? -1 : p->n;
        if (p->number[d] >= 0) p->dof[p->n++] = d;
    }
    free(turns);
    return err->code ? -1 : 0;
}

static void unknowns_of(const profile *p, const fl_member *b, int32_t which[12])
{
    for (int d = 0; d < 12; d++) which[d] = p->number[6 * b->end[d / 6] + d % 6];
}

/* 1 where the profile is too large to be tested. */
static int make_profile(profile *p, const fl_member_model *m, fl_err *err)
{
    if (fl_profile_begin(&p->k, p->n, err)) return -1;
    for (int32_t k = 0; k < m->member_name.n; k++) {
        int32_t which[12];
        unknowns_of(p, &m->member[k], which);
        fl_profile_join(&p->k, 12, which);
    }
    p->mode = fl_alloc(p->n, sizeof *p->mode, err);
    return p->mode ? fl_profile_allocate(&p->k, FL_MECHANISM_MOST, err) : -1;
}

static void put_vector(double *g, double s, fl_vec3 a)
{
    g[0] += s * a.x;
    g[1] += s * a.y;
    g[2] += s * a.z;
}

/* Adds stiff (g.u)2/2 for a linear form g over the 12 freedoms of the ends of a member. */
static void add_form(profile *p, const fl_member *b, const double g[12], double stiff)
{
    int32_t which[12];
    double of_nodes[12];
    memcpy(of_nodes, g, sizeof of_nodes);
    for (int s = 0; s < 2; s++) /* an end moves by u + r x arm, g.(r x arm) = r.(arm x g) */
        put_vector(of_nodes + 6 * s + 3, 1.0, v3_cross(b->arm[s], v3(g[6 * s], g[6 * s + 1], g[6 * s + 2])));
    unknowns_of(p, b, which);
    fl_profile_add_form(&p->k, 12, which, of_nodes, stiff);
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

/* Motion that pivot i leaves without resistance: L11^T x = -row i of L, x_i = 1.  The freedom that moves a
 * node most, -1 where it only turns nodes. */
static int32_t find_motion(profile *p, int32_t i)
{
    const double *at = fl_profile_row(&p->k, i);
    double most = 0.0, moved = 0.0;
    int32_t which = -1;
    for (int32_t j = 0; j < i; j++) p->mode[j] = j >= p->k.low[i] ? -at[j] : 0.0;
    for (int32_t j = i - 1; j >= 0; j--) {
        const double *l = fl_profile_row(&p->k, j);
        for (int32_t c = p->k.low[j]; c < j; c++) p->mode[c] -= l[c] * p->mode[j];
    }
    p->mode[i] = 1.0;
    if (p->k.diagonal[i] == 0.0) return p->dof[i] % 6 < 3 ? p->dof[i] : -1;
    for (int32_t j = 0; j <= i; j++) {
        /* Times the root of the diagonal element, so that lengths and angles compare. */
        const double size = fabs(p->mode[j]) * sqrt(p->k.diagonal[j]);
        if (size > most) most = size;
        if (p->dof[j] % 6 < 3 && size > moved) {
            moved = size;
            which = p->dof[j];
        }
    }
    return moved > MOVED * most ? which : -1;
}

static int factor_rows(profile *p, const fl_member_model *m, fl_err *err)
{
    static const char *const axis[] = {"x", "y", "z"};
    for (int32_t i = 0; i < p->n; i++) {
        if (fl_profile_factor_row(&p->k, i, PIVOT)) continue;
        const int32_t d = find_motion(p, i);
        if (d >= 0)
            return fl_fail(err, FL_INPUT,
                           "%s:%lld: the structure is a mechanism: node %s moves along %s without resistance",
                           m->file, (long long)m->node[d / 6].line, m->node_name.name[d / 6], axis[d % 6]);
        fl_profile_hold(&p->k, i); /* a spin */
    }
    return 0;
}

int fl_member_check_mechanism(const fl_member_model *m, fl_err *err)
{
    profile p = {0};
    int rc = number_freedoms(&p, m, err);
    if (rc == 0) rc = make_profile(&p, m, err);
    if (rc == 0) rc = add_members(&p, m, err) ? -1 : factor_rows(&p, m, err);
    free_profile(&p);
    return rc < 0 ? -1 : 0;
}
