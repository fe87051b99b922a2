/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_path.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

enum {
    NEGATIVE_MOST = 10, /* successive steps without a root */
    SLOW_FACTOR = 10,   /* kinetic damping is given up at that many times the steps of the last point */
    SLOW_LEAST = 500,
    STEPS_LEAST = 200, /* wanted for a point at least */
    STEPS_FAIL = 200   /* times the wanted steps: the point is given up */
};
/* Smallest dl, over that which a point began with. */
static const double DL_LEAST = 1e-4;
/* The same over the length of all displacements. */
static const double DL_LOST = 1e-9;
/* Of the lever of axial forces, so that a piece may be bent further while a point is found. */
static const double MASS_MARGIN = 2.0;
static const double JUMP = 5.0;
static const double GROW_MOST = 1.5, SHRINK_MOST = 0.25, STRAIGHT = 0.9, KINK = 0.5;

fl_path_options fl_path_defaults(void)
{
    return (fl_path_options){.first = 0.02,
                             .constraint = FL_ARC_TOTAL,
                             .predictor = FL_PATH_CHORD,
                             .load_step = 1e-3,
                             .load_steps = 10,
                             .damping = FL_RELAXATION_KINETIC,
                             .c = 0.02,
                             .chi = 1e-4,
                             .resolution = 0.01};
}

/* --- states ------------------------------------------------------------------------------------ */

static int allocate_state(fl_path_state *s, const fl_member_chain *c, fl_err *err)
{
    s->d = fl_alloc(c->balls, sizeof *s->d, err);
    s->q = fl_alloc(c->balls, sizeof *s->q, err);
    s->turned = fl_alloc(c->loads, sizeof *s->turned, err);
    return err->code ? -1 : 0;
}

static void free_state(fl_path_state *s)
{
    free(s->d);
    free(s->q);
    free(s->turned);
}

static void save_state(fl_path_state *s, const fl_member_chain *c)
{
    for (int32_t b = 0; b < c->balls; b++) {
        s->d[b] = c->ball[b].d;
        s->q[b] = c->ball[b].q;
    }
    for (int32_t k = 0; k < c->loads; k++) s->turned[k] = c->load[k].turned;
}

static void restore_state(fl_member_chain *c, const fl_path_state *s)
{
    for (int32_t b = 0; b < c->balls; b++) {
        c->ball[b].d = s->d[b];
        c->ball[b].q = s->q[b];
    }
    for (int32_t k = 0; k < c->loads; k++) c->load[k].turned = s->turned[k];
    fl_member_chain_rest(c);
}

/* Rotation vector of a unit quaternion, up to a right angle each way. */
static fl_vec3 rotation_vector(fl_quat q)
{
    const double sign = q.w < 0.0 ? -1.0 : 1.0;
    const fl_vec3 v = v3(sign * q.x, sign * q.y, sign * q.z);
    const double s2 = fmin(v3_norm2(v), 1.0);
    return v3_scale(2.0 * (1.0 + fl_member_arcsine(s2) * s2), v);
}

/* From the last point on by `share` of the chord from the one before. */
static void move_along_chord(fl_path *p, double share)
{
    fl_member_chain *c = p->chain;
    for (int32_t b = 0; b < c->balls; b++) {
        fl_member_ball *a = &c->ball[b];
        a->d = v3_madd(p->last.d[b], share, v3_sub(p->last.d[b], p->before.d[b]));
        if (a->over_i > 0.0) {
            const fl_vec3 r = rotation_vector(q_mul(p->last.q[b], q_conj(p->before.q[b])));
            a->q = q_unit(q_mul(q_of_vector(v3_scale(share, r)), p->last.q[b]));
        }
    }
    for (int32_t k = 0; k < c->loads; k++)
        c->load[k].turned = v3_madd(p->last.turned[k], share, v3_sub(p->last.turned[k], p->before.turned[k]));
}

int fl_path_start(fl_path *p, fl_member_chain *chain, const fl_path_options *options, fl_err *err)
{
    *p = (fl_path){.chain = chain, .options = *options, .damping = options->damping, .known = 1};
    if (allocate_state(&p->last, chain, err) || allocate_state(&p->before, chain, err)) {
        fl_path_free(p);
        return -1;
    }
    save_state(&p->last, chain);
    save_state(&p->before, chain);
    return 0;
}

void fl_path_return(fl_path *p) { restore_state(p->chain, &p->last); }

void fl_path_free(fl_path *p)
{
    free_state(&p->last);
    free_state(&p->before);
    *p = (fl_path){0};
}

/* --- one point --------------------------------------------------------------------------------- */

/* What a relaxation holds, and what it leads to. */
typedef struct {
    enum fl_arc_constraint constraint;
    double target;       /* of the constraint */
    const fl_vec3 *from; /* displacements that lengths are counted from; NULL: 0 */
    double lambda, residual;
    double predicted; /* length of the step along the chord */
    int64_t steps, negative;
} relaxation_run;

/* Steps that a point may take before dl becomes smaller: the first point tells how slow the structure is. */
static double wanted_steps(const fl_path *p)
{
    return fmax(STEPS_LEAST, fmax(8.0 * p->chain->balls, 2.0 * (double)p->first_steps));
}

/* Force that the balance is held against: the largest load so far, or the largest force at imposed
 * displacements. */
static double load_scale(const fl_path *p, double lambda)
{
    const fl_member_chain *c = p->chain;
    return c->load_norm > 0.0 ? c->load_norm * fmax(p->lambda_most, fabs(lambda))
                              : fmax(p->reaction_most, fl_member_chain_reaction(c));
}

/* Load factor that leads the controlled freedom to its target; its ball has not moved yet in this step. */
static double control_lambda(const fl_path *p, const relaxation_run *r, double c2)
{
    const fl_member_chain *c = p->chain;
    const fl_member_ball *a = &c->ball[p->options.control_ball];
    const int axis = p->options.control_axis;
    const double moved = v3_at(a->d, axis) + c->dt * v3_at(a->v, axis);
    return (r->target - moved) / (c2 * c->dt * c->dt * a->over_m * v3_at(c->load[a->load].force, axis));
}

static double step_lambda(const fl_path *p, relaxation_run *r, const fl_member_half *h, double c2,
                          double balanced, int *root)
{
    double lambda = r->lambda;
    *root = 1;
    switch (r->constraint) {
    case FL_ARC_LOAD: break;
    case FL_ARC_DISPLACEMENT:
        lambda = p->options.control ? control_lambda(p, r, c2)
                                    : (r->target * p->chain->load_norm - h->work_a) / h->work_b;
        break;
    case FL_ARC_TOTAL:
    case FL_ARC_INCREMENT:
        /* From the last point the load may turn back while the sphere goes on: the nearer root. */
        if (fl_arc_root(h->bb, h->ab, h->aa - r->target * r->target,
                        r->constraint == FL_ARC_TOTAL ? h->db : 0.0, r->lambda, &lambda)) {
            *root = 0;
            lambda = balanced;
        }
        break;
    }
    return lambda;
}

/* Relaxes the chain from its present state.  0, or 1 where that fails. */
static int relax_chain(fl_path *p, relaxation_run *r)
{
    fl_member_chain *c = p->chain;
    const double norm2 = c->load_norm * c->load_norm;
    const int64_t most =
        p->options.max_steps ? p->options.max_steps : (int64_t)(STEPS_FAIL * wanted_steps(p));
    const int64_t slow = SLOW_FACTOR * (p->last_steps > SLOW_LEAST ? p->last_steps : SLOW_LEAST);
    fl_relaxation damping = fl_relaxation_start(p->damping, p->options.c);
    int successive = 0;
    fl_member_chain_rest(c);
    for (r->steps = 0; r->steps < most; r->steps++) {
        fl_member_chain_forces(c);
        const fl_member_state s = fl_member_chain_state(c, r->lambda);
        const int free_lambda = r->constraint != FL_ARC_LOAD && norm2 > 0.0;
        const double balanced = free_lambda ? r->lambda - s.along / norm2 : r->lambda;
        const double r2 = free_lambda ? s.residual2 - s.along * s.along / norm2 : s.residual2;
        if (!isfinite(r2)) return 1;
        r->residual = sqrt(fmax(r2, 0.0)) / load_scale(p, balanced);
        if (r->residual <= p->options.chi) {
            r->lambda = balanced;
            return 0;
        }
        if (r->steps > 0) fl_relaxation_adapt(&damping, s.work, s.inertia, c->dt);
        if (damping.kind == FL_RELAXATION_KINETIC &&
            r->steps == slow) { /* it does not settle: damp it from here on */
            p->damping = FL_RELAXATION_ADAPTIVE;
            damping = fl_relaxation_start(p->damping, 0.0);
            fl_member_chain_rest(c);
        }
        const double c1 = fl_relaxation_c1(&damping), c2 = fl_relaxation_c2(&damping);
        const fl_member_half h = fl_member_chain_free_step(c, c1, c2, r->from);
        int root;
        r->lambda = step_lambda(p, r, &h, c2, balanced, &root);
        successive = root ? 0 : successive + 1;
        r->negative += !root;
        const double kinetic = h.kinetic + fl_member_chain_loaded_step(c, c2, r->lambda);
        if (fl_relaxation_peak(&damping, kinetic)) fl_member_chain_rest(c);
        if (successive > NEGATIVE_MOST && p->options.predictor == FL_PATH_CHORD) return 1;
    }
    return 1;
}

/* Share of the chord after which the constraint holds with the increment dl, and what it holds. */
static double chord_share(fl_path *p, double dl, relaxation_run *r)
{
    const fl_member_chain *c = p->chain;
    double aa = 0.0, ab = 0.0, bb = 0.0, x = 1.0;
    for (int32_t b = 0; b < c->balls; b++) {
        if (c->ball[b].over_m == 0.0) continue;
        const fl_vec3 d = p->last.d[b], chord = v3_sub(d, p->before.d[b]);
        aa += v3_norm2(d);
        ab += v3_dot(d, chord);
        bb += v3_norm2(chord);
    }
    const int n = p->known - 1;
    *r = (relaxation_run){.constraint = p->options.constraint, .target = dl};
    switch (p->options.constraint) {
    case FL_ARC_TOTAL:
        r->target = sqrt(aa) + dl;
        if (fl_arc_root(bb, ab, aa - r->target * r->target, 1.0, 0.0, &x)) x = 1.0;
        break;
    case FL_ARC_INCREMENT:
        r->from = p->last.d;
        x = dl / sqrt(bb);
        break;
    case FL_ARC_DISPLACEMENT:
        if (p->options.control) {
            const int32_t b = p->options.control_ball;
            const double at = v3_at(p->last.d[b], p->options.control_axis),
                         step = at - v3_at(p->before.d[b], p->options.control_axis);
            dl = copysign(dl, step);
            r->target = at + dl;
            x = dl / step;
            break;
        }
        r->target = p->w[n] / c->load_norm + dl;
        x = dl / ((p->w[n] - p->w[n - 1]) / c->load_norm);
        break;
    case FL_ARC_LOAD:
        dl = copysign(dl, p->options.first);
        if ((p->options.last - p->lambda[n]) * (p->options.last - p->lambda[n] - dl) < 0.0)
            dl = p->options.last - p->lambda[n];
        x = dl / (p->lambda[n] - p->lambda[n - 1]);
        break;
    }
    r->lambda = p->lambda[n] + x * (p->lambda[n] - p->lambda[n - 1]);
    r->predicted = fabs(x) * sqrt(bb);
    return x;
}

/* The predictor of Ye & Xu: load steps of given size, without waiting for rest, fix the next length. */
static void predict_by_load_steps(fl_path *p, relaxation_run *r)
{
    fl_member_chain *c = p->chain;
    fl_relaxation damping = fl_relaxation_start(p->damping, p->options.c);
    const double l = sqrt(fl_member_chain_length2(c, NULL));
    const int n = p->known - 1;
    const double sign = n > 0 && p->lambda[n] < p->lambda[n - 1] ? -1.0 : 1.0;
    *r = (relaxation_run){.constraint = FL_ARC_TOTAL, .lambda = p->lambda[n]};
    fl_member_chain_rest(c);
    for (int64_t k = 0; k < p->options.load_steps; k++) {
        fl_member_chain_forces(c);
        r->lambda += sign * p->options.load_step;
        const double c1 = fl_relaxation_c1(&damping), c2 = fl_relaxation_c2(&damping);
        const fl_member_half h = fl_member_chain_free_step(c, c1, c2, NULL);
        if (fl_relaxation_peak(&damping, h.kinetic + fl_member_chain_loaded_step(c, c2, r->lambda)))
            fl_member_chain_rest(c);
    }
    r->target = sqrt(fl_member_chain_length2(c, NULL));
    if (!(r->target > l)) r->target = l * (1.0 + 1e-6);
}

/* --- what a point leads to --------------------------------------------------------------------- */

static void push_history(fl_path *p, double s, double lambda, double w)
{
    if (p->known == 4) {
        memmove(p->s, p->s + 1, 3 * sizeof *p->s);
        memmove(p->lambda, p->lambda + 1, 3 * sizeof *p->lambda);
        memmove(p->w, p->w + 1, 3 * sizeof *p->w);
        p->known = 3;
    }
    p->s[p->known] = s;
    p->lambda[p->known] = lambda;
    p->w[p->known] = w;
    p->known++;
}

static void find_limit(fl_path *p)
{
    fl_path_point *t = &p->point;
    const int n = p->known;
    if (n < 3) return;
    const double a = p->lambda[n - 2] - p->lambda[n - 3], b = p->lambda[n - 1] - p->lambda[n - 2];
    if (!(a * b < 0.0)) return;
    t->hint |= a > 0.0 ? FL_PATH_HINT_MAXIMUM : FL_PATH_HINT_MINIMUM;
    t->limit = fl_arc_parabola(&p->s[n - 3], &p->lambda[n - 3], &t->limit_arc);
    t->limit_error = fabs(t->limit - p->lambda[n - 2]);
    if (n == 4) {
        double at;
        const double cubic = fl_arc_cubic(p->s, p->lambda, &at);
        t->limit_error = fabs(t->limit - cubic);
        if (at > p->s[1] && at < p->s[3]) {
            t->limit = cubic;
            t->limit_arc = at;
        }
    }
}

/* Cosine between the last two chords. */
static double chord_cosine(const fl_path *p)
{
    const fl_member_chain *c = p->chain;
    double aa = 0.0, ab = 0.0, bb = 0.0;
    for (int32_t k = 0; k < c->balls; k++) {
        const fl_vec3 a = v3_sub(p->last.d[k], p->before.d[k]), b = v3_sub(c->ball[k].d, p->last.d[k]);
        aa += v3_norm2(a);
        ab += v3_dot(a, b);
        bb += v3_norm2(b);
    }
    return aa > 0.0 && bb > 0.0 ? ab / sqrt(aa * bb) : 1.0;
}

static void choose_increment(fl_path *p, const relaxation_run *r, double guess, double cosine)
{
    double factor = GROW_MOST;
    if (p->options.dl > 0.0) { /* given: it only comes back after it was halved */
        p->dl = fmin(p->options.dl, GROW_MOST * p->dl);
        return;
    }
    const double off = fabs(r->lambda - guess) / p->lambda_most;
    factor = fmin(factor, sqrt(wanted_steps(p) / (double)(r->steps + 1)));
    if (off > 0.0) factor = fmin(factor, sqrt(p->options.resolution / off));
    if (cosine < STRAIGHT) factor = fmin(factor, 0.7);
    p->dl *= fmax(factor, SHRINK_MOST);
    if (p->options.dl_most > 0.0 && p->dl > p->options.dl_most) p->dl = p->options.dl_most;
}

static int accept_point(fl_path *p, const relaxation_run *r, fl_err *err)
{
    fl_member_chain *c = p->chain;
    fl_path_point *t = &p->point;
    const double chord = sqrt(fl_member_chain_length2(c, p->last.d)), cosine = chord_cosine(p);
    const int64_t number = t->number + 1;
    const double arc = t->arc + chord, work = t->work, w = fl_member_chain_work(c);
    *t = (fl_path_point){.number = number,
                         .steps = r->steps,
                         .negative = r->negative,
                         .lambda = r->lambda,
                         .arc = arc,
                         .length = sqrt(fl_member_chain_length2(c, NULL)),
                         .along = c->load_norm > 0.0 ? w / c->load_norm : 0.0,
                         .residual = r->residual,
                         .energy = fl_member_chain_energy(c)};
    t->energy += fl_member_chain_plastic(c);
    fl_member_chain_commit(c);
    push_history(p, arc, r->lambda, w);
    const int n = p->known;
    t->work = work + (n < 3 ? 0.5 * (p->lambda[n - 1] + p->lambda[n - 2]) * (p->w[n - 1] - p->w[n - 2])
                            : fl_arc_work(&p->s[n - 3], &p->lambda[n - 3], &p->w[n - 3]));
    p->energy_most = fmax(p->energy_most, fmax(fabs(t->energy), fabs(t->work)));
    t->balance = p->energy_most > 0.0 ? (t->work - t->energy) / p->energy_most : 0.0;
    find_limit(p);
    if (number > 1 && cosine < KINK) t->hint |= FL_PATH_HINT_KINK;
    if (number > 1 && p->options.constraint == FL_ARC_LOAD && chord > JUMP * r->predicted)
        t->hint |= FL_PATH_HINT_JUMP;
    p->lambda_most = fmax(p->lambda_most, fabs(r->lambda));
    p->reaction_most = fmax(p->reaction_most, fl_member_chain_reaction(c));
    p->last_steps = r->steps;
    const fl_path_state old = p->before;
    p->before = p->last;
    p->last = old;
    save_state(&p->last, c);
    fl_member_chain_rest(c);
    if (c->largest_rotation2 > FL_MEMBER_ROTATION_MAX * FL_MEMBER_ROTATION_MAX)
        return fl_fail(err, FL_INPUT,
                       "a piece is bent or twisted by more than %g rad at point %lld, more pieces are needed",
                       FL_MEMBER_ROTATION_MAX, (long long)number);
    return 0;
}

static int first_point(fl_path *p, fl_err *err)
{
    relaxation_run r = {.constraint = FL_ARC_LOAD, .lambda = p->options.first};
    fl_member_chain_impose(p->chain, r.lambda);
    const int failed = relax_chain(p, &r);
    p->total_steps += r.steps;
    if (failed) {
        restore_state(p->chain, &p->last);
        return fl_fail(
            err, FL_NO,
            "the first point does not come to rest in %lld steps: the structure is a mechanism, or a load "
            "factor of %g is above its limit; try a smaller --first",
            (long long)r.steps, r.lambda);
    }
    if (accept_point(p, &r, err)) return -1;
    const double l = p->point.length;
    p->first_steps = r.steps;
    p->dl = p->options.dl > 0.0                    ? p->options.dl
            : p->options.dl_first > 0.0            ? p->options.dl_first
            : p->options.constraint == FL_ARC_LOAD ? p->options.first
            : p->options.control
                ? fabs(v3_at(p->chain->ball[p->options.control_ball].d, p->options.control_axis))
            : p->options.constraint == FL_ARC_DISPLACEMENT ? fabs(p->point.along)
                                                           : l;
    if (p->options.dl_most > 0.0 && p->dl > p->options.dl_most) p->dl = p->options.dl_most;
    return 0;
}

/* An increment of length that is lost beside the length of all displacements. */
static int is_lost(const fl_path *p)
{
    const int length = p->options.constraint == FL_ARC_TOTAL || p->options.constraint == FL_ARC_INCREMENT;
    return length && p->options.predictor == FL_PATH_CHORD && p->dl < DL_LOST * p->point.length;
}

int fl_path_next(fl_path *p, fl_err *err)
{
    relaxation_run r;
    if (p->point.number == 0) return first_point(p, err);
    const double least = DL_LEAST * p->dl;
    for (double margin = MASS_MARGIN; !is_lost(p); margin *= 2.0) {
        double share = 0.0;
        if (p->options.predictor == FL_PATH_LOAD_STEPS) {
            predict_by_load_steps(p, &r);
            p->total_steps += p->options.load_steps;
        } else {
            share = chord_share(p, p->dl, &r);
            move_along_chord(p, share);
            fl_member_chain_impose(p->chain, r.lambda);
        }
        const double guess = r.lambda;
        fl_member_chain_masses(p->chain, margin);
        const int failed = relax_chain(p, &r);
        p->total_steps += r.steps;
        if (!failed) {
            const double cosine = chord_cosine(p);
            if (accept_point(p, &r, err)) return -1;
            choose_increment(p, &r, guess, cosine);
            return 0;
        }
        restore_state(p->chain, &p->last);
        p->dl *= 0.5;
        if (p->dl < least || p->options.predictor == FL_PATH_LOAD_STEPS) break;
    }
    return fl_fail(err, FL_NO,
                   "the arc cannot advance beyond point %lld, load factor %g: try another --constraint, "
                   "--damping adaptive "
                   "or a smaller --dl",
                   (long long)p->point.number, p->point.lambda);
}
