/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_chain.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"

/* s of the masses. */
static const double MASS_SHARE = 2.0;
/* Balls below which more than one thread costs more than it saves. */
enum { THREADED = 4000 };
enum { SUMS = 4 };
/* Fours of contacts that are evaluated together. */
enum { BEAM_SETS = 32 };

/* --- making it --------------------------------------------------------------------------------- */

static int allocate(fl_member_chain *c, const fl_member_model *m, fl_err *err)
{
    int64_t balls = m->node_name.n, contacts = 0;
    for (int32_t k = 0; k < m->member_name.n; k++) {
        balls += m->member[k].pieces - 1;
        contacts += m->member[k].pieces;
    }
    if (balls > INT32_MAX / 4 || contacts > INT32_MAX / 4)
        return fl_fail(err, FL_INPUT, "%s: %lld pieces, expected %d at most", m->file, (long long)contacts,
                       INT32_MAX / 4);
    c->balls = (int32_t)balls;
    c->contacts = (int32_t)contacts;
    c->nodes = m->node_name.n;
    c->ball = fl_alloc(balls, sizeof *c->ball, err);
    c->contact = fl_alloc(contacts, sizeof *c->contact, err);
    c->force = fl_alloc(contacts + 1, sizeof *c->force, err); /* loads of four doubles */
    c->resist = fl_alloc(balls, sizeof *c->resist, err);
    c->last = fl_alloc(balls, sizeof *c->last, err);
    c->first = fl_alloc(balls + 1, sizeof *c->first, err);
    c->around = fl_alloc(2 * contacts, sizeof *c->around, err);
    c->load = fl_alloc(c->nodes, sizeof *c->load, err);
    c->move = fl_alloc(c->nodes, sizeof *c->move, err);
    c->part = fl_alloc(SUMS * (balls / FL_MEMBER_GROUP + 1), sizeof *c->part, err);
    return err->code ? -1 : 0;
}

static void make_node_balls(fl_member_chain *c, const fl_member_model *m)
{
    for (int32_t k = 0; k < c->nodes; k++) {
        const fl_member_node *n = &m->node[k];
        c->ball[k] =
            (fl_member_ball){.x0 = v3_add(n->x, n->offset), .q = q_one(), .fixed = n->fixed, .load = -1};
        if (v3_nonzero(n->force) || v3_nonzero(n->moment)) {
            c->ball[k].load = c->loads;
            c->load[c->loads++] = (fl_member_load){.ball = k, .force = n->force, .moment = n->moment};
        }
        if (n->imposed) c->move[c->moves++] = (fl_member_move){k, n->imposed, n->move, n->turn};
    }
}

static void make_contact(fl_member_contact *c, const fl_member_section *s, const fl_vec3 e[3], fl_vec3 d)
{
    /* A piece of a bowed member lies a little across the member: its frame is turned along. */
    const fl_vec3 e1 = v3_unit(d), e2 = v3_unit(v3_cross(e[2], e1)), e3 = v3_cross(e1, e2);
    const double l = v3_norm(d);
    c->length = l;
    c->e0 = q_of_matrix((fl_mat3){{{e1.x, e2.x, e3.x}, {e1.y, e2.y, e3.y}, {e1.z, e2.z, e3.z}}});
    c->axial = s->ea / l;
    if (c->kind == FL_MEMBER_BEAM) {
        c->shear[0] = 12.0 * s->eiz / (l * l * l);
        c->shear[1] = 12.0 * s->eiy / (l * l * l);
        c->turn[0] = s->gj / l;
        c->turn[1] = s->eiy / l;
        c->turn[2] = s->eiz / l;
    } else {
        c->shear[0] = 3.0 * s->eiz / l;
        c->shear[1] = 3.0 * s->eiy / l;
    }
}

static int make_member(fl_member_chain *c, const fl_member_model *m, int32_t k, int32_t *ball,
                       int32_t *contact, fl_err *err)
{
    const fl_member *b = &m->member[k];
    const fl_member_section *s = &m->section[b->section];
    fl_vec3 e[3];
    double length;
    if (fl_member_frame(m, k, e, &length, err)) return -1;
    const fl_vec3 x = fl_member_end(m, k, 0);
    int32_t last = b->end[0];
    const int hinge_i = b->released[0] || m->node[b->end[0]].hinge,
              hinge_j = b->released[1] || m->node[b->end[1]].hinge;
    for (int32_t p = 1; p <= b->pieces; p++) {
        int32_t next = b->end[1];
        if (p < b->pieces) {
            const double t = (double)p / b->pieces;
            next = (*ball)++;
            fl_vec3 at = v3_madd(x, t * length, e[0]);
            if (b->bow != 0.0) at = v3_madd(at, b->bow * sin(PI * t), e[b->bow_axis]);
            c->ball[next] = (fl_member_ball){.x0 = at, .q = q_one(), .load = -1};
        }
        const int at_i = p == 1 && hinge_i, at_j = p == b->pieces && hinge_j;
        fl_member_contact *out = &c->contact[(*contact)++];
        *out = (fl_member_contact){.i = last, .j = next, .member = k};
        out->kind = at_i && at_j ? FL_MEMBER_BAR
                    : at_i       ? FL_MEMBER_HINGE_I
                    : at_j       ? FL_MEMBER_HINGE_J
                                 : FL_MEMBER_BEAM;
        if (p == 1) out->arm[0] = b->arm[0];
        if (p == b->pieces) out->arm[1] = b->arm[1];
        out->arms = v3_nonzero(out->arm[0]) || v3_nonzero(out->arm[1]);
        const fl_vec3 d = v3_sub(fl_member_contact_start(c, out, 1), fl_member_contact_start(c, out, 0));
        if (!(v3_norm(d) > 0.0))
            return fl_fail(err, FL_INPUT, "%s:%lld: a piece of member %s has no length", m->file,
                           (long long)b->line, m->member_name.name[k]);
        make_contact(out, s, e, d);
        last = next;
    }
    return 0;
}

/* Contacts of each ball, ascending. */
static void link_contacts(fl_member_chain *c)
{
    for (int32_t k = 0; k < c->contacts; k++) {
        c->first[c->contact[k].i + 1]++;
        c->first[c->contact[k].j + 1]++;
    }
    for (int32_t b = 0; b < c->balls; b++) c->first[b + 1] += c->first[b];
    for (int32_t k = 0; k < c->contacts; k++) {
        c->around[c->first[c->contact[k].i]++] = 2 * k;
        c->around[c->first[c->contact[k].j]++] = 2 * k + 1;
    }
    for (int32_t b = c->balls; b > 0; b--) c->first[b] = c->first[b - 1];
    c->first[0] = 0;
}

static inline double evaluate(const fl_member_chain *c, int32_t k, fl_member_force *out, double *energy);

void fl_member_chain_masses(fl_member_chain *c, double margin)
{
    const double s = MASS_SHARE * c->dt * c->dt;
    for (int32_t b = 0; b < c->balls; b++) c->ball[b].over_m = c->ball[b].over_i = 0.0;
    for (int32_t k = 0; k < c->contacts; k++) {
        const fl_member_contact *e = &c->contact[k];
        const int beam = e->kind == FL_MEMBER_BEAM;
        const double l2 = e->length * e->length, bend = fmax(e->shear[0], e->shear[1]);
        const double m = s * fmax(e->axial, beam ? bend : bend / l2);
        double inertia[2] = {0, 0};
        if (beam) {
            fl_member_force f;
            const double sine2 = 0.25 * evaluate(c, k, &f, NULL);
            const double twist = fmax(e->turn[0], fmax(e->turn[1], e->turn[2]));
            inertia[0] = inertia[1] = s * (twist + 0.25 * l2 * (bend + margin * sine2 * e->axial));
        } else if (e->kind != FL_MEMBER_BAR) {
            inertia[e->kind == FL_MEMBER_HINGE_I] = s * bend;
        }
        const double whole = e->arms ? 2.0 * m : m;
        for (int end = 0; end < 2 && e->arms; end++) inertia[end] += whole * v3_norm2(e->arm[end]);
        c->ball[e->i].over_m += whole;
        c->ball[e->j].over_m += whole;
        c->ball[e->i].over_i += inertia[0];
        c->ball[e->j].over_i += inertia[1];
    }
    for (int32_t b = 0; b < c->balls; b++) {
        fl_member_ball *a = &c->ball[b];
        const int held = (a->fixed & FL_MEMBER_TRANSLATIONS) == FL_MEMBER_TRANSLATIONS;
        a->over_m = held ? 0.0 : 1.0 / a->over_m;
        a->over_i = a->over_i > 0.0 && (a->fixed >> 3) != FL_MEMBER_TRANSLATIONS ? 1.0 / a->over_i : 0.0;
    }
}

static void sum_scales(fl_member_chain *c)
{
    double length = 0.0, load2 = 0.0;
    for (int32_t k = 0; k < c->contacts; k++) length += c->contact[k].length;
    c->length = length / c->contacts;
    for (int32_t k = 0; k < c->loads; k++) {
        fl_member_load *p = &c->load[k];
        p->force = fl_member_free_part(p->force, c->ball[p->ball].fixed & FL_MEMBER_TRANSLATIONS);
        p->moment = fl_member_free_part(p->moment, c->ball[p->ball].fixed >> 3);
        load2 += v3_norm2(p->force) + v3_norm2(p->moment) / (c->length * c->length);
    }
    c->load_norm = sqrt(load2);
}

/* Fibres of the pieces whose section yields. */
static int make_fibres(fl_member_chain *c, const fl_member_model *m, fl_err *err)
{
    int64_t numbers = 0;
    for (int32_t k = 0; k < c->contacts; k++) {
        const fl_member_contact *e = &c->contact[k];
        c->yielding += (e->kind == FL_MEMBER_BEAM || e->kind == FL_MEMBER_BAR) &&
                       m->section[m->member[e->member].section].yield > 0.0;
    }
    if (c->yielding == 0) return 0;
    c->sections = m->section_name.n;
    c->fibre_section = fl_alloc(c->sections, sizeof *c->fibre_section, err);
    c->fibres = fl_alloc(c->yielding, sizeof *c->fibres, err);
    if (err->code) return -1;
    for (int32_t s = 0; s < c->sections; s++)
        if (m->section[s].yield > 0.0 &&
            fl_member_fibre_section_make(&c->fibre_section[s], &m->section[s], err))
            return -1;
    c->yielding = 0;
    for (int32_t k = 0; k < c->contacts; k++) {
        fl_member_contact *e = &c->contact[k];
        const fl_member_fibre_section *s = &c->fibre_section[m->member[e->member].section];
        if (s->n == 0 || (e->kind != FL_MEMBER_BEAM && e->kind != FL_MEMBER_BAR)) continue;
        c->fibres[c->yielding] = (fl_member_fibres){.section = s, .contact = k};
        e->fibres = &c->fibres[c->yielding++];
        numbers += 2 * s->n;
    }
    double *at = c->fibre_strains = fl_alloc(numbers, sizeof *c->fibre_strains, err);
    if (!at) return -1;
    for (int32_t k = 0; k < c->yielding; k++) {
        c->fibres[k].plastic = at;
        c->fibres[k].trial = at + c->fibres[k].section->n;
        at += 2 * c->fibres[k].section->n;
    }
    return 0;
}

/* Plain beam contacts into lanes; the last of them fills what is left of the last four. */
static int sort_contacts(fl_member_chain *c, fl_err *err)
{
    int32_t plain = 0;
    for (int32_t k = 0; k < c->contacts; k++) plain += fl_member_is_plain_beam(&c->contact[k]);
    c->beam_sets = (plain + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH;
    c->beams = fl_alloc(c->beam_sets, sizeof *c->beams, err);
    c->other = fl_alloc(c->contacts - plain, sizeof *c->other, err);
    if (err->code) return -1;
    plain = 0;
    for (int32_t k = 0; k < c->contacts; k++) {
        if (!fl_member_is_plain_beam(&c->contact[k])) {
            c->other[c->others++] = k;
            continue;
        }
        fl_member_beams *b = &c->beams[plain / FL_SIMD_WIDTH];
        for (int lane = plain++ % FL_SIMD_WIDTH; lane < FL_SIMD_WIDTH; lane++)
            fl_member_beams_set(b, lane, &c->contact[k], k);
    }
    return 0;
}

int fl_member_chain_make(fl_member_chain *c, const fl_member_model *m, double dt, fl_err *err)
{
    int32_t ball = m->node_name.n, contact = 0;
    *c = (fl_member_chain){.dt = dt, .threads = 1};
    if (allocate(c, m, err)) goto failed;
    make_node_balls(c, m);
    for (int32_t k = 0; k < m->member_name.n; k++)
        if (make_member(c, m, k, &ball, &contact, err)) goto failed;
    link_contacts(c);
    if (make_fibres(c, m, err) || sort_contacts(c, err)) goto failed;
    fl_member_chain_masses(c, 0.0);
    sum_scales(c);
    return 0;
failed:
    fl_member_chain_free(c);
    return -1;
}

double fl_member_chain_reaction(const fl_member_chain *c)
{
    double sum = 0.0;
    for (int32_t k = 0; k < c->moves; k++) {
        const fl_member_resist *r = &c->resist[c->move[k].ball];
        sum += v3_norm2(r->f) + v3_norm2(r->m) / (c->length * c->length);
    }
    return sqrt(sum);
}

int fl_member_chain_has_force(const fl_member_chain *c)
{
    for (int32_t k = 0; k < c->loads; k++)
        if (v3_nonzero(c->load[k].force)) return 1;
    return 0;
}

void fl_member_chain_free(fl_member_chain *c)
{
    free(c->ball);
    free(c->contact);
    free(c->beams);
    free(c->other);
    free(c->force);
    free(c->resist);
    free(c->last);
    free(c->first);
    free(c->around);
    free(c->load);
    free(c->move);
    free(c->part);
    for (int32_t s = 0; s < c->sections && c->fibre_section; s++)
        fl_member_fibre_section_free(&c->fibre_section[s]);
    free(c->fibre_section);
    free(c->fibres);
    free(c->fibre_strains);
    *c = (fl_member_chain){0};
}

/* --- forces ------------------------------------------------------------------------------------ */

static inline fl_vec3 ball_place(const fl_member_ball *b) { return v3_add(b->x0, b->d); }

static inline double evaluate(const fl_member_chain *c, int32_t k, fl_member_force *out, double *energy)
{
    const fl_member_contact *e = &c->contact[k];
    const fl_member_ball *i = &c->ball[e->i], *j = &c->ball[e->j];
    double rotation2;
    *out = fl_member_contact_force(e, v3_sub(ball_place(j), ball_place(i)), i->q, j->q, energy, &rotation2);
    return rotation2;
}

static inline int threads_of(const fl_member_chain *c) { return c->balls >= THREADED ? c->threads : 1; }

static void evaluate_contacts(fl_member_chain *c)
{
    double largest = 0.0;
    const int threads = threads_of(c);
#pragma omp parallel num_threads(threads) if (threads > 1) reduction(max : largest)
    {
#pragma omp for schedule(static) nowait
        for (int32_t k = 0; k < c->beam_sets; k += BEAM_SETS) {
            const int32_t n = c->beam_sets - k < BEAM_SETS ? c->beam_sets - k : BEAM_SETS;
            const double r2 = fl_member_beams_force(&c->beams[k], n, c->ball, c->force);
            if (r2 > largest) largest = r2;
        }
#pragma omp for schedule(static)
        for (int32_t k = 0; k < c->others; k++) {
            const double r2 = evaluate(c, c->other[k], &c->force[c->other[k]], NULL);
            if (r2 > largest) largest = r2;
        }
    }
    c->largest_rotation2 = largest;
}

void fl_member_chain_forces(fl_member_chain *c)
{
    fl_member_resist *const before = c->last;
    const int threads = threads_of(c);
    c->last = c->resist;
    c->resist = before;
    evaluate_contacts(c);
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int32_t b = 0; b < c->balls; b += FL_MEMBER_GROUP)
        fl_member_balls_resist(b, c->balls - b < FL_MEMBER_GROUP ? c->balls : b + FL_MEMBER_GROUP, c->first,
                               c->around, c->force, c->resist);
}

double fl_member_chain_energy(fl_member_chain *c)
{
    double sum = 0.0, largest = 0.0;
    for (int32_t k = 0; k < c->contacts; k++) {
        fl_member_force f;
        double energy;
        const double r2 = evaluate(c, k, &f, &energy);
        sum += energy;
        if (r2 > largest) largest = r2;
    }
    c->largest_rotation2 = largest;
    return sum;
}

int32_t fl_member_chain_commit(fl_member_chain *c)
{
    int32_t ruptured = 0;
    for (int32_t k = 0; k < c->yielding; k++) {
        fl_member_fibres *f = &c->fibres[k];
        double energy = 0.0;
        fl_member_force force;
        if (f->strain > f->section->limit && !f->ruptured) evaluate(c, f->contact, &force, &energy);
        ruptured += fl_member_fibres_commit(f, energy);
    }
    return ruptured;
}

double fl_member_chain_plastic(const fl_member_chain *c)
{
    double sum = 0.0;
    for (int32_t k = 0; k < c->yielding; k++)
        sum += c->fibres[k].dissipated + (c->fibres[k].ruptured ? 0.0 : c->fibres[k].flow);
    return sum;
}

void fl_member_chain_impose(fl_member_chain *c, double lambda)
{
    for (int32_t k = 0; k < c->moves; k++) {
        const fl_member_move *m = &c->move[k];
        fl_member_ball *b = &c->ball[m->ball];
        if (m->bits & 1) b->d.x = lambda * m->move.x;
        if (m->bits & 2) b->d.y = lambda * m->move.y;
        if (m->bits & 4) b->d.z = lambda * m->move.z;
        if (m->bits >> 3) b->q = q_of_vector(v3_scale(lambda, m->turn));
    }
}

/* --- sums -------------------------------------------------------------------------------------- */

/* Adds `sums` numbers of every group of balls in the order of the groups. */
static void add_groups(const fl_member_chain *c, int sums, double *out)
{
    const int32_t groups = (c->balls + FL_MEMBER_GROUP - 1) / FL_MEMBER_GROUP;
    for (int s = 0; s < sums; s++) out[s] = 0.0;
    for (int32_t g = 0; g < groups; g++)
        for (int s = 0; s < sums; s++) out[s] += c->part[SUMS * g + s];
}

/* lambda P - F of a ball at its free freedoms. */
static inline fl_member_resist unbalanced(const fl_member_chain *c, int32_t b, double lambda)
{
    const fl_member_ball *a = &c->ball[b];
    fl_vec3 f = v3_neg(c->resist[b].f), m = v3_neg(c->resist[b].m);
    if (a->load >= 0) {
        f = v3_madd(f, lambda, c->load[a->load].force);
        m = v3_madd(m, lambda, c->load[a->load].moment);
    }
    if (a->fixed) {
        f = fl_member_free_part(f, a->fixed & FL_MEMBER_TRANSLATIONS);
        m = fl_member_free_part(m, a->fixed >> 3);
    }
    if (a->over_m == 0.0) f = v3(0, 0, 0);
    if (a->over_i == 0.0) m = v3(0, 0, 0);
    return (fl_member_resist){f, m};
}

static void add_state(const fl_member_chain *c, int32_t b, double lambda, double over_l2, double sum[3])
{
    const fl_member_ball *a = &c->ball[b];
    const fl_member_resist r = unbalanced(c, b, lambda);
    sum[0] += v3_norm2(r.f) + over_l2 * v3_norm2(r.m);
    if (a->over_m > 0.0) {
        sum[1] += v3_norm2(a->v) / a->over_m;
        sum[2] += v3_dot(a->v, v3_sub(c->resist[b].f, c->last[b].f));
    }
    if (a->over_i > 0.0) {
        sum[1] += v3_norm2(a->w) / a->over_i;
        sum[2] += v3_dot(a->w, v3_sub(c->resist[b].m, c->last[b].m));
    }
}

fl_member_state fl_member_chain_state(const fl_member_chain *c, double lambda)
{
    const int32_t groups = (c->balls + FL_MEMBER_GROUP - 1) / FL_MEMBER_GROUP;
    const int threads = threads_of(c);
    const double over_l2 = 1.0 / (c->length * c->length), dt = c->dt;
    double sum[3];
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int32_t g = 0; g < groups; g++) {
        const int32_t end = (g + 1) * FL_MEMBER_GROUP < c->balls ? (g + 1) * FL_MEMBER_GROUP : c->balls;
        double *const part = &c->part[SUMS * g];
        part[0] = part[1] = part[2] = 0.0;
        for (int32_t b = g * FL_MEMBER_GROUP; b < end; b += FL_SIMD_WIDTH)
            if (b + FL_SIMD_WIDTH > end ||
                !fl_member_balls_state(&c->ball[b], &c->resist[b], &c->last[b], over_l2, part))
                for (int32_t k = b; k < end && k < b + FL_SIMD_WIDTH; k++)
                    add_state(c, k, lambda, over_l2, part);
    }
    add_groups(c, 3, sum);
    fl_member_state s = {.residual2 = sum[0], .inertia = dt * dt * sum[1], .work = dt * sum[2]};
    for (int32_t k = 0; k < c->loads; k++) {
        const fl_member_resist r = unbalanced(c, c->load[k].ball, lambda);
        s.along += v3_dot(r.f, c->load[k].force) + over_l2 * v3_dot(r.m, c->load[k].moment);
    }
    return s;
}

/* --- a step ------------------------------------------------------------------------------------ */

/* Free translations are those of balls with over_m > 0 along freedoms that are not held. */
static inline fl_vec3 counted(const fl_member_chain *c, int32_t b, const fl_vec3 *from)
{
    const fl_member_ball *a = &c->ball[b];
    if (a->over_m == 0.0) return v3(0, 0, 0);
    const fl_vec3 d = from ? v3_sub(a->d, from[b]) : a->d;
    return a->fixed ? fl_member_free_part(d, a->fixed & FL_MEMBER_TRANSLATIONS) : d;
}

static void step_ball(fl_member_chain *c, int32_t b, double c1, double c2, const fl_vec3 *from, double sum[2])
{
    const double dt = c->dt;
    fl_member_ball *a = &c->ball[b];
    if (a->over_m > 0.0) {
        fl_vec3 f = c->resist[b].f;
        if (a->fixed) f = fl_member_free_part(f, a->fixed & FL_MEMBER_TRANSLATIONS);
        a->v = v3_madd(v3_scale(c1, a->v), -c2 * dt * a->over_m, f);
        sum[0] += v3_norm2(v3_madd(counted(c, b, from), dt, a->v));
        if (a->load < 0) {
            a->d = v3_madd(a->d, dt, a->v);
            sum[1] += v3_norm2(a->v) / a->over_m;
        }
    }
    if (a->over_i > 0.0) {
        fl_vec3 m = c->resist[b].m;
        if (a->fixed) m = fl_member_free_part(m, a->fixed >> 3);
        a->w = v3_madd(v3_scale(c1, a->w), -c2 * dt * a->over_i, m);
        if (a->load < 0) {
            fl_member_ball_turn(a, dt);
            sum[1] += v3_norm2(a->w) / a->over_i;
        }
    }
}

static void step_group(fl_member_chain *c, int32_t begin, int32_t end, double c1, double c2,
                       const fl_vec3 *from, double sum[2])
{
    sum[0] = sum[1] = 0.0;
    for (int32_t b = begin; b < end; b += FL_SIMD_WIDTH)
        if (b + FL_SIMD_WIDTH > end ||
            !fl_member_balls_step(&c->ball[b], &c->resist[b], from ? &from[b] : NULL, c1, c2, c->dt, sum))
            for (int32_t k = b; k < end && k < b + FL_SIMD_WIDTH; k++) step_ball(c, k, c1, c2, from, sum);
    sum[1] *= 0.5;
}

fl_member_half fl_member_chain_free_step(fl_member_chain *c, double c1, double c2, const fl_vec3 *from)
{
    const int32_t groups = (c->balls + FL_MEMBER_GROUP - 1) / FL_MEMBER_GROUP;
    const int threads = threads_of(c);
    const double dt = c->dt, weight = c2 * dt * dt;
    double sum[2];
    fl_member_half h = {0};
    for (int32_t k = 0; k < c->loads; k++) {
        const fl_member_load *p = &c->load[k];
        h.db += weight * c->ball[p->ball].over_m * v3_dot(counted(c, p->ball, from), p->force);
    }
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int32_t g = 0; g < groups; g++) {
        const int32_t end = (g + 1) * FL_MEMBER_GROUP < c->balls ? (g + 1) * FL_MEMBER_GROUP : c->balls;
        step_group(c, g * FL_MEMBER_GROUP, end, c1, c2, from, &c->part[SUMS * g]);
    }
    add_groups(c, 2, sum);
    h.aa = sum[0];
    h.kinetic = sum[1];
    for (int32_t k = 0; k < c->loads; k++) {
        const fl_member_load *p = &c->load[k];
        const fl_member_ball *a = &c->ball[p->ball];
        const double b = weight * a->over_m;
        h.ab += b * v3_dot(v3_madd(counted(c, p->ball, from), dt, a->v), p->force);
        h.bb += b * b * v3_norm2(p->force);
        h.work_a +=
            v3_dot(v3_madd(a->d, dt, a->v), p->force) + v3_dot(v3_madd(p->turned, dt, a->w), p->moment);
        h.work_b += b * v3_norm2(p->force) + weight * a->over_i * v3_norm2(p->moment);
    }
    return h;
}

double fl_member_chain_loaded_step(fl_member_chain *c, double c2, double lambda)
{
    const double dt = c->dt;
    double kinetic = 0.0;
    for (int32_t k = 0; k < c->loads; k++) {
        fl_member_load *p = &c->load[k];
        fl_member_ball *a = &c->ball[p->ball];
        if (a->over_m > 0.0) {
            a->v = v3_madd(a->v, c2 * dt * a->over_m * lambda, p->force);
            a->d = v3_madd(a->d, dt, a->v);
            kinetic += v3_norm2(a->v) / a->over_m;
        }
        if (a->over_i > 0.0) {
            a->w = v3_madd(a->w, c2 * dt * a->over_i * lambda, p->moment);
            p->turned = v3_madd(p->turned, dt, a->w);
            fl_member_ball_turn(a, dt);
            kinetic += v3_norm2(a->w) / a->over_i;
        }
    }
    return 0.5 * kinetic;
}

void fl_member_chain_rest(fl_member_chain *c)
{
    for (int32_t b = 0; b < c->balls; b++) c->ball[b].v = c->ball[b].w = v3(0, 0, 0);
}

double fl_member_chain_length2(const fl_member_chain *c, const fl_vec3 *from)
{
    const int32_t groups = (c->balls + FL_MEMBER_GROUP - 1) / FL_MEMBER_GROUP;
    double sum = 0.0;
    for (int32_t g = 0; g < groups; g++) {
        const int32_t end = (g + 1) * FL_MEMBER_GROUP < c->balls ? (g + 1) * FL_MEMBER_GROUP : c->balls;
        double part = 0.0;
        for (int32_t b = g * FL_MEMBER_GROUP; b < end; b++) part += v3_norm2(counted(c, b, from));
        sum += part;
    }
    return sum;
}

double fl_member_chain_work(const fl_member_chain *c)
{
    double sum = 0.0;
    for (int32_t k = 0; k < c->loads; k++)
        sum += v3_dot(c->ball[c->load[k].ball].d, c->load[k].force) +
               v3_dot(c->load[k].turned, c->load[k].moment);
    return sum;
}
