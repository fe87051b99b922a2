/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_stiffness.h"
#include <stdlib.h>
#include "base/array.h"

/* Pivot below which a freedom is a spin of a member about its axis, over the diagonal element. That of a
 * cantilever of n pieces is of order n^-4, so that 500 pieces in line are told from one. */
static const double SPIN = 1e-11;

static int turns_ball(const fl_member_contact *e, int at_j)
{
    return v3_nonzero(e->arm[at_j]) || e->kind == FL_MEMBER_BEAM ||
           e->kind == (at_j ? FL_MEMBER_HINGE_I : FL_MEMBER_HINGE_J);
}

static int number_freedoms(fl_member_stiffness *s, const fl_member_chain *c, fl_err *err)
{
    s->number = fl_alloc(6 * (int64_t)c->balls, sizeof *s->number, err);
    s->dof = fl_alloc(6 * (int64_t)c->balls, sizeof *s->dof, err);
    char *turns = fl_alloc(c->balls, 1, err);
    for (int32_t k = 0; k < c->contacts && !err->code; k++) {
        if (turns_ball(&c->contact[k], 0)) turns[c->contact[k].i] = 1;
        if (turns_ball(&c->contact[k], 1)) turns[c->contact[k].j] = 1;
    }
    for (int32_t at = 0; at < c->balls && !err->code; at++) {
        /* Those between the nodes first: no row of theirs is long. */
        const int32_t b = at < c->balls - c->nodes ? at + c->nodes : at - (c->balls - c->nodes);
        for (int d = 0; d < 6; d++) {
            const int held = c->ball[b].fixed >> d & 1;
            s->number[6 * b + d] = held || (d > 2 && !turns[b]) ? -1 : s->n;
            if (s->number[6 * b + d] >= 0) s->dof[s->n++] = 6 * b + d;
        }
    }
    free(turns);
    return err->code ? -1 : 0;
}

static void unknowns_of(const fl_member_stiffness *s, const fl_member_contact *e, int32_t which[12])
{
    for (int d = 0; d < 12; d++) which[d] = s->number[6 * (d < 6 ? e->i : e->j) + d % 6];
}

static void put_vector(double *g, double s, fl_vec3 a)
{
    g[0] += s * a.x;
    g[1] += s * a.y;
    g[2] += s * a.z;
}

/* Stretch, or deflection across, times over; turned: what each end turns adds, about an axis. */
static void add_form(fl_member_stiffness *s, const fl_member_contact *e, fl_vec3 across, double over,
                     fl_vec3 about, double turn_i, double turn_j, double stiff)
{
    int32_t which[12];
    double g[12] = {0};
    unknowns_of(s, e, which);
    put_vector(g, -over, across);
    put_vector(g + 6, over, across);
    put_vector(g + 3, turn_i, about);
    put_vector(g + 9, turn_j, about);
    for (int end = 0; end < 2 && e->arms; end++) /* (r x a).across = r.(a x across) */
        put_vector(g + 3 + 6 * end, end ? over : -over, v3_cross(e->arm[end], across));
    fl_profile_add_form(&s->k, 12, which, g, stiff);
}

static void add_contact(fl_member_stiffness *s, const fl_member_contact *e)
{
    fl_vec3 a[3];
    const fl_vec3 none = v3(0, 0, 0);
    fl_member_axes(e->e0, a);
    add_form(s, e, a[0], 1.0, none, 0.0, 0.0, e->axial);
    if (e->kind == FL_MEMBER_BEAM) {
        const double half = 0.5 * e->length;
        add_form(s, e, a[1], 1.0, a[2], -half, -half, e->shear[0]);
        add_form(s, e, a[2], 1.0, a[1], half, half, e->shear[1]);
        for (int d = 0; d < 3; d++) add_form(s, e, none, 0.0, a[d], -1.0, 1.0, e->turn[d]);
    } else if (e->kind != FL_MEMBER_BAR) {
        const double i = e->kind == FL_MEMBER_HINGE_J, j = 1.0 - i;
        add_form(s, e, a[1], 1.0 / e->length, a[2], -i, -j, e->shear[0]);
        add_form(s, e, a[2], 1.0 / e->length, a[1], i, j, e->shear[1]);
    }
}

int fl_member_stiffness_make(fl_member_stiffness *s, const fl_member_chain *c, const char *file, fl_err *err)
{
    *s = (fl_member_stiffness){0};
    int rc = number_freedoms(s, c, err) || fl_profile_begin(&s->k, s->n, err) ? -1 : 0;
    for (int32_t k = 0; k < c->contacts && rc == 0; k++) {
        int32_t which[12];
        unknowns_of(s, &c->contact[k], which);
        fl_profile_join(&s->k, 12, which);
    }
    if (rc == 0) rc = fl_profile_allocate(&s->k, FL_MEMBER_STIFFNESS_MOST, err);
    if (rc > 0)
        rc = fl_fail(err, FL_INPUT, "%s: the stiffness of %d balls and %d nodes takes more than %d numbers",
                     file, (int)c->balls, (int)c->nodes, FL_MEMBER_STIFFNESS_MOST);
    for (int32_t k = 0; k < c->contacts && rc == 0; k++) add_contact(s, &c->contact[k]);
    for (int32_t i = 0; i < s->n && rc == 0; i++)
        if (!fl_profile_factor_row(&s->k, i, SPIN)) fl_profile_hold(&s->k, i);
    if (rc) fl_member_stiffness_free(s);
    return rc;
}

void fl_member_stiffness_free(fl_member_stiffness *s)
{
    fl_profile_free(&s->k);
    free(s->number);
    free(s->dof);
    *s = (fl_member_stiffness){0};
}
