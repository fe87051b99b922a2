/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/member_motion.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

/* --- cylinders --------------------------------------------------------------------------------- */

/* Number of the first contact of member k. */
static int32_t first_contact(const fl_member_model *m, int32_t k)
{
    int32_t first = 0;
    for (int32_t b = 0; b < k; b++) first += m->member[b].pieces;
    return first;
}

static int32_t cylinders_of(const fl_member_model *m, int32_t k)
{
    const fl_member *b = &m->member[k];
    if (!(m->section[b->section].radius > 0.0)) return 0;
    return b->cylinders < 1 ? 1 : b->cylinders < b->pieces ? b->cylinders : b->pieces;
}

/* Of the pieces [from, to) of a straight member the one nearest to height z, or at the middle of the range.
 * */
static int32_t carrying_piece(fl_vec3 a, fl_vec3 b, int32_t pieces, int32_t from, int32_t to, double z)
{
    const int32_t middle = (from + to - 1) / 2;
    if (a.z == b.z) return middle;
    const double at = (z - a.z) / (b.z - a.z) * pieces;
    return at >= from && at <= to ? (int32_t)fmin(floor(at), to - 1) : middle;
}

/* Appends the cylinders of member k; out may be NULL, to count. */
static int32_t add_cylinders(const fl_member_model *m, int32_t k, double z, fl_member_cylinder *out)
{
    const fl_member *b = &m->member[k];
    const fl_vec3 x0 = fl_member_end(m, k, 0), x1 = fl_member_end(m, k, 1);
    const int32_t n = cylinders_of(m, k), first = out ? first_contact(m, k) : 0;
    for (int32_t c = 0; c < n && out; c++) {
        const int32_t from = (int32_t)((int64_t)c * b->pieces / n),
                      to = (int32_t)((int64_t)(c + 1) * b->pieces / n);
        out[c] = (fl_member_cylinder){.member = k,
                                      .contact = first + carrying_piece(x0, x1, b->pieces, from, to, z),
                                      .p0 = v3_lerp(x0, x1, (double)from / b->pieces),
                                      .p1 = v3_lerp(x0, x1, (double)to / b->pieces),
                                      .radius = m->section[b->section].radius};
    }
    return n;
}

static int list_cylinders(const fl_member_model *m, double z, fl_member_cylinder **list, int32_t *n,
                          fl_err *err)
{
    *n = 0;
    for (int32_t k = 0; k < m->member_name.n; k++) *n += add_cylinders(m, k, z, NULL);
    if (*n == 0)
        return fl_fail(
            err, FL_INPUT,
            "%s: no section has a radius, so that ice cannot touch its members; expected pipe, rect "
            "or bar, or a general section with its radius",
            m->file);
    *list = fl_alloc(*n, sizeof **list, err);
    if (!*list) return -1;
    for (int32_t k = 0, at = 0; k < m->member_name.n; k++) at += add_cylinders(m, k, z, *list + at);
    return 0;
}

int fl_member_motion_surface(fl_surface *s, const fl_member_model *m, double waterline, fl_err *err)
{
    fl_member_cylinder *list = NULL;
    int32_t n;
    int rc = list_cylinders(m, waterline, &list, &n, err);
    for (int32_t p = 0; p < m->part_name.n && rc == 0; p++) {
        const char *name = m->part_name.name[p];
        if (fl_surface_add(s, name, strlen(name), err) < 0) rc = -1;
    }
    for (int32_t k = 0; k < n && rc == 0; k++)
        rc = fl_surface_cone(&s->part[m->member[list[k].member].part],
                             (fl_cone){list[k].p0, list[k].p1, list[k].radius, list[k].radius}, err);
    free(list);
    return rc;
}

/* --- making it --------------------------------------------------------------------------------- */

int fl_member_motion_frames_surface(fl_surface *s, const fl_member_model *m, double thin, fl_err *err)
{
    fl_member_chain c = {0};
    int rc = fl_member_chain_make(&c, m, 1.0, err);
    for (int32_t k = 0, piece = 0; k < c.contacts && rc == 0; k++) {
        const fl_member_contact *e = &c.contact[k];
        const double own = m->section[m->member[e->member].section].radius, radius = own > 0.0 ? own : thin;
        char name[300];
        piece = k > 0 && e->member == e[-1].member ? piece + 1 : 1;
        snprintf(name, sizeof name, "%.250s.%d", m->member_name.name[e->member], (int)piece);
        const int32_t p = fl_surface_add(s, name, strlen(name), err);
        if (p < 0) rc = -1;
        else if (radius > 0.0)
            rc = fl_surface_cone(&s->part[p],
                                 (fl_cone){fl_member_contact_start(&c, e, 0),
                                           fl_member_contact_start(&c, e, 1), radius, radius},
                                 err);
    }
    fl_member_chain_free(&c);
    return rc;
}

/* Rotation of the axes of a piece at the start to where they are now. */
typedef struct {
    fl_vec3 c, e;
    fl_quat q;
    double length;
} piece_frame;

static piece_frame frame_of(const fl_member_chain *c, int32_t contact)
{
    const fl_member_contact *k = &c->contact[contact];
    const fl_member_ball *i = &c->ball[k->i], *j = &c->ball[k->j];
    const fl_vec3 xi = fl_member_contact_end(c, k, 0), xj = fl_member_contact_end(c, k, 1),
                  dx = v3_sub(xj, xi);
    piece_frame f = {.c = v3_scale(0.5, v3_add(xi, xj)), .length = v3_norm(dx)};
    f.e = v3_scale(1.0 / f.length, dx);
    fl_quat q = k->kind == FL_MEMBER_HINGE_I ? j->q : k->kind == FL_MEMBER_BAR ? q_one() : i->q;
    if (k->kind == FL_MEMBER_BEAM) {
        const double s = q.w * j->q.w + q.x * j->q.x + q.y * j->q.y + q.z * j->q.z < 0.0 ? -1.0 : 1.0;
        q = q_unit((fl_quat){q.w + s * j->q.w, q.x + s * j->q.x, q.y + s * j->q.y, q.z + s * j->q.z});
    }
    /* The least rotation from the first axis to e. */
    const fl_vec3 a = q_rotate(q_mul(q, k->e0), v3(1, 0, 0)), axis = v3_cross(a, f.e);
    f.q = q_mul(q_unit((fl_quat){1.0 + v3_dot(a, f.e), axis.x, axis.y, axis.z}), q);
    return f;
}

static fl_vec3 middle_at_start(const fl_member_chain *c, const fl_member_contact *e)
{
    return v3_scale(0.5, v3_add(fl_member_contact_start(c, e, 0), fl_member_contact_start(c, e, 1)));
}

static void place_cylinder(fl_member_motion *v, fl_member_cylinder *k)
{
    const fl_member_chain *c = &v->dynamics.chain;
    const fl_member_contact *e = &c->contact[k->contact];
    const fl_vec3 middle = middle_at_start(c, e);
    const fl_vec3 z = v3_unit(v3_sub(k->p1, k->p0)), x = v3_normal_to(z), y = v3_cross(z, x);
    k->arm = v3_sub(k->p0, middle);
    k->turn = q_of_matrix((fl_mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}});
}

/* The highest node of each part that moves, the first of several. */
static int watch_parts(fl_member_motion *v, fl_err *err)
{
    const fl_member_model *m = v->model;
    v->watched = fl_alloc(m->part_name.n, sizeof *v->watched, err);
    if (!v->watched) return -1;
    for (int32_t p = 0; p < m->part_name.n; p++) v->watched[p] = -1;
    for (int32_t k = 0; k < m->member_name.n; k++)
        for (int s = 0; s < 2; s++) {
            const int32_t b = m->member[k].end[s];
            int32_t *at = &v->watched[m->member[k].part];
            if (v->dynamics.chain.ball[b].over_m == 0.0) continue;
            if (*at < 0 || m->node[b].x.z > m->node[*at].x.z) *at = b;
        }
    return 0;
}

int fl_member_motion_make(fl_member_motion *v, const fl_member_model *m, double waterline, double ratio,
                          fl_err *err)
{
    *v = (fl_member_motion){.model = m};
    if (list_cylinders(m, waterline, &v->cylinder, &v->cylinders, err) ||
        fl_member_dynamics_make(&v->dynamics, m, ratio, err) || watch_parts(v, err) ||
        !(v->contact_stiffness = fl_alloc(v->dynamics.chain.balls, sizeof *v->contact_stiffness, err))) {
        fl_member_motion_free(v);
        return -1;
    }
    for (int32_t k = 0; k < v->cylinders; k++) place_cylinder(v, &v->cylinder[k]);
    return 0;
}

void fl_member_motion_free(fl_member_motion *v)
{
    fl_member_dynamics_free(&v->dynamics);
    free(v->cylinder), free(v->watched), free(v->contact_stiffness);
    *v = (fl_member_motion){0};
}

/* --- motion ------------------------------------------------------------------------------------ */

void fl_member_motion_pose(const fl_member_motion *v, int32_t k, fl_vec3 *x, fl_quat *q)
{
    const fl_member_cylinder *k0 = &v->cylinder[k];
    const piece_frame f = frame_of(&v->dynamics.chain, k0->contact);
    *x = v3_add(f.c, q_rotate(f.q, k0->arm));
    *q = q_mul(f.q, k0->turn);
}

void fl_member_motion_piece_pose(const fl_member_motion *v, int32_t contact, fl_vec3 *x, fl_quat *q)
{
    fl_member_motion_chain_pose(&v->dynamics.chain, contact, x, q);
}

void fl_member_motion_chain_pose(const fl_member_chain *c, int32_t contact, fl_vec3 *x, fl_quat *q)
{
    const fl_member_contact *e = &c->contact[contact];
    const piece_frame f = frame_of(c, contact);
    const fl_vec3 middle = middle_at_start(c, e);
    *q = f.q;
    *x = v3_sub(f.c, q_rotate(f.q, middle));
}

static int transmits(const fl_member_contact *e, int at_j)
{
    return e->kind == FL_MEMBER_BEAM || e->kind == (at_j ? FL_MEMBER_HINGE_I : FL_MEMBER_HINGE_J);
}

/* The arm of an end as it is now. */
static fl_vec3 arm_now(const fl_member_chain *c, const fl_member_contact *e, int end)
{
    return e->arms ? q_rotate(c->ball[end ? e->j : e->i].q, e->arm[end]) : v3(0, 0, 0);
}

/* Velocities of the piece from any vectors of its ends. */
static void combine(const piece_frame *f, const fl_member_contact *e, fl_vec3 vi, fl_vec3 vj, fl_vec3 wi,
                    fl_vec3 wj, fl_vec3 x, fl_vec3 *speed, fl_vec3 *spin)
{
    const int i = transmits(e, 0), j = transmits(e, 1);
    const double twist =
        i + j ? ((i ? v3_dot(f->e, wi) : 0.0) + (j ? v3_dot(f->e, wj) : 0.0)) / (i + j) : 0.0;
    *spin = v3_madd(v3_scale(1.0 / f->length, v3_cross(f->e, v3_sub(vj, vi))), twist, f->e);
    *speed = v3_add(v3_scale(0.5, v3_add(vi, vj)), v3_cross(*spin, v3_sub(x, f->c)));
}

void fl_member_motion_velocity(const fl_member_motion *v, int32_t k, fl_vec3 x, fl_vec3 *speed, fl_vec3 *spin)
{
    const fl_member_chain *c = &v->dynamics.chain;
    const fl_member_contact *e = &c->contact[v->cylinder[k].contact];
    const fl_member_ball *i = &c->ball[e->i], *j = &c->ball[e->j];
    const piece_frame f = frame_of(c, v->cylinder[k].contact);
    fl_vec3 vi = i->v, vj = j->v;
    if (e->arms) {
        vi = v3_add(vi, v3_cross(i->w, arm_now(c, e, 0)));
        vj = v3_add(vj, v3_cross(j->w, arm_now(c, e, 1)));
    }
    combine(&f, e, vi, vj, i->w, j->w, x, speed, spin);
}

void fl_member_motion_acceleration(const fl_member_motion *v, int32_t k, fl_vec3 x, fl_vec3 *a, fl_vec3 *turn)
{
    const fl_member_dynamics *d = &v->dynamics;
    const fl_member_contact *e = &d->chain.contact[v->cylinder[k].contact];
    const piece_frame f = frame_of(&d->chain, v->cylinder[k].contact);
    fl_vec3 by[2], turns[2];
    for (int s = 0; s < 2; s++) {
        const int32_t b = s ? e->j : e->i;
        const fl_member_ball *ball = &d->chain.ball[b];
        by[s] =
            v3_scale(ball->over_m, fl_member_free_part(d->force[b], ball->fixed & FL_MEMBER_TRANSLATIONS));
        turns[s] = v3_scale(ball->over_i, fl_member_free_part(d->moment[b], ball->fixed >> 3));
        if (e->arms) by[s] = v3_add(by[s], v3_cross(turns[s], arm_now(&d->chain, e, s)));
    }
    combine(&f, e, by[0], by[1], turns[0], turns[1], x, a, turn);
}

void fl_member_motion_clear(fl_member_motion *v)
{
    const size_t bytes = (size_t)v->dynamics.chain.balls * sizeof *v->dynamics.force;
    memset(v->dynamics.force, 0, bytes);
    memset(v->dynamics.moment, 0, bytes);
}

void fl_member_motion_load(fl_member_motion *v, int32_t k, fl_vec3 x, fl_vec3 f, fl_vec3 t)
{
    fl_member_dynamics *d = &v->dynamics;
    const fl_member_contact *e = &d->chain.contact[v->cylinder[k].contact];
    if (!v3_nonzero(f) && !v3_nonzero(t)) return;
    const piece_frame at = frame_of(&d->chain, v->cylinder[k].contact);
    const fl_vec3 torque = v3_add(t, v3_cross(v3_sub(x, at.c), f)),
                  pair = v3_scale(1.0 / at.length, v3_cross(at.e, torque)), half = v3_scale(0.5, f);
    d->force[e->i] = v3_add(d->force[e->i], v3_add(half, pair));
    d->force[e->j] = v3_add(d->force[e->j], v3_sub(half, pair));
    for (int s = 0; s < 2 && e->arms; s++) {
        fl_vec3 *const moment = &d->moment[s ? e->j : e->i];
        const fl_vec3 end = s ? v3_sub(half, pair) : v3_add(half, pair);
        *moment = v3_add(*moment, v3_cross(arm_now(&d->chain, e, s), end));
    }
    const int i = transmits(e, 0), j = transmits(e, 1);
    if (!i && !j) return;
    const fl_vec3 twist = v3_scale(v3_dot(at.e, torque) / (i + j), at.e);
    if (i) d->moment[e->i] = v3_add(d->moment[e->i], twist);
    if (j) d->moment[e->j] = v3_add(d->moment[e->j], twist);
}

fl_vec3 fl_member_motion_middle(const fl_member_motion *v, int32_t k)
{
    return frame_of(&v->dynamics.chain, v->cylinder[k].contact).c;
}

double fl_member_motion_compliance(const fl_member_motion *v, int32_t k, double arm)
{
    const fl_member_chain *c = &v->dynamics.chain;
    const fl_member_contact *e = &c->contact[v->cylinder[k].contact];
    double i = c->ball[e->i].over_m, j = c->ball[e->j].over_m;
    const double lever = arm / e->length;
    if (e->arms) { /* of the ends */
        i += v3_norm2(e->arm[0]) * c->ball[e->i].over_i;
        j += v3_norm2(e->arm[1]) * c->ball[e->j].over_i;
    }
    return (0.5 + lever) * (0.5 + lever) * fmax(i, j) + (0.5 - lever) * (0.5 - lever) * fmin(i, j);
}
