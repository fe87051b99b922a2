/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "base/pi.h"
#include "step/ride.h"
#include "step/works.h"

static int moves(const fl_scene_motion *m)
{
    return v3_some(m->velocity) || v3_some(m->spin) || m->track[0] || m->free;
}

/* Springs of a scene's motion. */
static void hang(fl_motion *out, const fl_scene_motion *m)
{
    const double T[] = {m->period.x, m->period.y, m->period.z},
                 k[] = {m->stiffness.x, m->stiffness.y, m->stiffness.z},
                 kt[] = {m->turn_stiffness.x, m->turn_stiffness.y, m->turn_stiffness.z};
    for (int i = 0; i < 3; i++) {
        const double w = T[i] > 0.0 ? 2.0 * PI / T[i] : 0.0;
        out->K[i][i] = k[i] + m->mass * w * w;
        out->K[3 + i][3 + i] = kt[i];
    }
    out->K[2][3] = out->K[3][2] = m->coupling.x;
    out->K[2][4] = out->K[4][2] = m->coupling.y;
    out->K[3][4] = out->K[4][3] = m->coupling.z;
}

/* Dashpots beside all springs there are, those of the sea with them: c = 2 D sqrt(k m) along x y z. */
static void damp(fl_motion *out, const fl_scene_motion *m)
{
    const double D[] = {m->damping_ratio.x, m->damping_ratio.y, m->damping_ratio.z};
    double c[3] = {m->damping.x, m->damping.y, m->damping.z};
    for (int i = 0; i < 3; i++)
        if (D[i] > 0.0) c[i] = 2.0 * D[i] * sqrt(out->K[i][i] * m->mass);
    out->c = v3(c[0], c[1], c[2]);
    out->ct = m->turn_damping;
}

/* The sea's stiffness for the parts of mover k. */
static int float_it(fl_world *w, int32_t k, fl_motion *out, const fl_surface *surface, const char *of,
                    fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_flotation *f = &w->ride.afloat[k];
    fl_err why = {0};
    char key[3 * FL_SCENE_NAME];
    int bad = 0;
    for (int32_t p = 0; p < surface->n && !bad; p++)
        if (w->ride.part[p] == k)
            bad = fl_flotation_add(f, &surface->part[p], s->water.level, out->reference, &why);
    if (bad || fl_flotation_end(f, s->water.level, out->reference, &why)) {
        if (why.code == FL_SYSTEM) {
            *err = why;
            return -1;
        }
        snprintf(key, sizeof key, "%s.hydrostatic", of);
        return fl_scene_fail(s, key, err, "%s: %s", key, why.text);
    }
    fl_flotation_stiffness(f, s->water.density * v3_norm(s->run.gravity), out->K);
    return 0;
}

/* A mover of scene motion m, called `of` in the scene, whose parts are marked with its number already. */
static int add_mover(fl_world *w, const fl_scene_motion *m, const char *of, const fl_surface *surface,
                     fl_err *err)
{
    fl_motion out = {.reference = m->reference,
                     .velocity = m->velocity,
                     .spin = m->spin,
                     .free = m->free,
                     .mass = m->mass,
                     .inertia = m->inertia};
    hang(&out, m);
    char key[3 * FL_SCENE_NAME];
    if (m->hydrostatic && float_it(w, w->ride.m.n, &out, surface, of, err)) return -1;
    damp(&out, m);
    if ((m->track[0] && fl_track_read(&out.track, m->track, m->between == FL_BETWEEN_CUBIC, err)) ||
        fl_movers_add(&w->ride.m, &out, err) < 0) {
        fl_track_free(&out.track);
        return -1;
    }
    const fl_track *tr = &w->ride.m.motion[w->ride.m.n - 1].track;
    snprintf(key, sizeof key, "%s.track", of);
    for (int32_t i = 0; m->free && i < tr->n; i++)
        if (v3_some(tr->at[i].r))
            return fl_scene_fail(w->scene, key, err,
                                 "%s: the track turns at %g s, and a structure with free directions turns by "
                                 "itself or not at all",
                                 key, tr->t[i]);
    return 0;
}

/* Movers of [structure] and of each [part NAME], and which part rides on which. */
static int make_movers(fl_world *w, const fl_surface *surface, fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_ride *r = &w->ride;
    int32_t next = moves(&s->structure.motion) ? 1 : 0;
    for (int32_t p = 0; p < surface->n; p++) r->part[p] = next - 1;
    for (int32_t i = 0; i < s->n_part; i++) {
        const char *name = s->part[i].name;
        const int32_t p = fl_surface_find(surface, name, strlen(name));
        char of[FL_SCENE_NAME + 8];
        snprintf(of, sizeof of, "part %s", name);
        if (p < 0) return fl_scene_fail(s, of, err, "there is no part %s in %s", name, s->structure.file);
        r->part[p] = moves(&s->part[i].motion) ? next++ : -1;
        w->part_about[p] = s->part[i].motion.reference;
    }
    if (moves(&s->structure.motion) && add_mover(w, &s->structure.motion, "structure", surface, err))
        return -1;
    for (int32_t i = 0; i < s->n_part; i++) {
        char of[FL_SCENE_NAME + 8];
        snprintf(of, sizeof of, "part %s", s->part[i].name);
        if (moves(&s->part[i].motion) && add_mover(w, &s->part[i].motion, of, surface, err)) return -1;
    }
    return 0;
}

/* How fast a told motion gets at most, by its rows [m/s]. */
static double fastest(const fl_motion *m, double arm)
{
    double most = v3_norm(m->velocity) + arm * v3_norm(m->spin);
    for (int32_t i = 0; i < m->track.n; i++) {
        fl_pose6 x, rate, second;
        fl_track_look(&m->track, m->track.t[i], &x, &rate, &second);
        most = fmax(most, v3_norm(rate.x) + arm * v3_norm(rate.r));
    }
    return most;
}

/* Piece k where its mover has it, at the mean velocity of the last dt. */
static void place(fl_world *w, int32_t k, double dt)
{
    fl_ride *r = &w->ride;
    const int32_t m = r->of[k], j = w->n + k;
    const fl_bodies *mb = &r->m.b;
    fl_bodies *b = &w->b;
    const fl_vec3 arm = m3_mul(fl_body_axes(mb, m), r->arm[k]);
    b->x[j] = v3_add(mb->x[m], arm);
    b->q[j] = q_mul(mb->q[m], r->turn[k]);
    b->v[j] = v3_add(mb->v[m], v3_cross(mb->w[m], v3_madd(arm, -0.5 * dt, v3_cross(mb->w[m], arm))));
    b->w[j] = mb->w[m];
}

static void speed(fl_world *w, int32_t k)
{
    const fl_bodies *mb = &w->ride.m.b;
    const int32_t m = w->ride.of[k], j = w->n + k;
    w->b.v[j] = v3_add(mb->v[m], v3_cross(mb->w[m], v3_sub(w->b.x[j], mb->x[m])));
    w->b.w[j] = mb->w[m];
}

int fl_ride_make(fl_world *w, const fl_surface *surface, fl_err *err)
{
    fl_ride *r = &w->ride;
    const int32_t pieces = w->structure.n; /* walls have none, and an entry */
    for (int32_t p = 0; p < w->parts; p++) w->part_about[p] = w->scene->structure.motion.reference;
    if (!surface || (!moves(&w->scene->structure.motion) && w->scene->n_part == 0)) return 0;
    r->part = fl_alloc(w->parts, sizeof *r->part, err);
    r->of = fl_alloc(pieces, sizeof *r->of, err);
    r->arm = fl_alloc(pieces, sizeof *r->arm, err);
    r->turn = fl_alloc(pieces, sizeof *r->turn, err);
    r->slope = fl_alloc(w->scene->n_part + 1, sizeof *r->slope, err);
    r->afloat = fl_alloc(w->scene->n_part + 1, sizeof *r->afloat, err);
    if (err->code || make_movers(w, surface, err) || fl_movers_start(&r->m, 0.0, err)) return -1;
    for (int32_t k = 0; k < pieces; k++) {
        const int32_t p = w->structure.piece[k].part, m = p < 0 ? -1 : r->part[p], j = w->n + k;
        r->of[k] = m;
        if (m < 0) continue;
        const fl_motion *motion = &r->m.motion[m];
        r->arm[k] = v3_sub(w->b.x[j], motion->reference);
        r->turn[k] = w->b.q[j];
        if (motion->free) { /* compliance of a place but for turns, see the survey; 1 where none is free */
            w->b.m[j] = motion->free & 7u ? r->m.b.m[m] : 0.0;
            w->b.invm[j] = r->m.b.invm[m];
            fl_body_inertia(&w->b, j, v3(INFINITY, INFINITY, INFINITY));
        }
        r->fastest = fmax(r->fastest, fastest(motion, v3_norm(r->arm[k]) + w->b.bound[j]));
        place(w, k, 0.0);
    }
    return 0;
}

void fl_ride_free(fl_ride *r)
{
    fl_movers_free(&r->m);
    free(r->of), free(r->part), free(r->arm), free(r->turn), free(r->slope), free(r->afloat);
    *r = (fl_ride){0};
}

static void tell_points(fl_world *w)
{
    const fl_ride *r = &w->ride;
    for (int32_t p = 0; p < w->parts; p++)
        if (r->part[p] >= 0) w->part_about[p] = r->m.b.x[r->part[p]];
}

void fl_ride_ready(fl_world *w)
{
    fl_movers_ready(&w->ride.m, w->dt);
    tell_points(w);
}

void fl_ride_out(fl_world *w, double t)
{
    fl_ride *r = &w->ride;
    for (int32_t m = 0; m < r->m.n; m++) fl_mover_out(&r->m, m, t, w->dt);
    for (int32_t k = 0; k < w->structure.n; k++) {
        if (r->of[k] < 0) continue;
        const int32_t j = w->n + k;
        const fl_vec3 x = w->b.x[j];
        const fl_quat q = w->b.q[j];
        const fl_gain before = {w->b.v[j], w->b.w[j]};
        place(w, k, w->dt);
        fl_works_set_lead(w, j, v3_sub(w->b.v[j], before.v), v3_sub(w->b.w[j], before.w));
        const fl_quat d = q_mul(w->b.q[j], q_conj(q)); /* its chord, as in integrate.c */
        w->b.odometer[j] +=
            v3_norm(v3_sub(w->b.x[j], x)) + 2.0 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z) * w->b.bound[j];
    }
    tell_points(w);
}

void fl_ride_back(fl_world *w, double t, double h)
{
    fl_ride *r = &w->ride;
    fl_bodies *mb = &r->m.b;
    for (int32_t m = 0; m < r->m.n; m++) mb->f[m] = mb->t[m] = v3(0, 0, 0);
    for (int32_t k = 0; k < w->structure.n; k++) {
        const int32_t m = r->of[k], j = w->n + k;
        if (m < 0) continue;
        mb->f[m] = v3_add(mb->f[m], w->b.f[j]);
        mb->t[m] = v3_add(mb->t[m], v3_add(w->b.t[j], v3_cross(v3_sub(w->b.x[j], mb->x[m]), w->b.f[j])));
    }
    for (int32_t m = 0; m < r->m.n; m++) {
        fl_mover_pull(&r->m, m);
        if (h > 0.0) {
            fl_mover_back(&r->m, m, t, h);
            fl_mover_damp(&r->m, m);
        }
    }
    for (int32_t k = 0; k < w->structure.n; k++)
        if (r->of[k] >= 0) speed(w, k);
}

/* What a step must bear: springs, and places of this much stiffness over its mass, on pieces so far out. */
static double arm_of(const fl_world *w, int32_t k) { return v3_norm(w->ride.arm[k]) + w->b.bound[w->n + k]; }

void fl_ride_survey(fl_world *w)
{
    fl_ride *r = &w->ride;
    for (int32_t m = 0; m < r->m.n; m++) r->slope[m] = 0.0;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t m = r->of[k], j = w->n + k;
        if (m < 0 || !r->m.motion[m].free) continue;
        double sum = 0.0; /* of slope times invm */
        for (int64_t c = w->inc_first[j]; c < w->inc_first[j + 1]; c++) {
            const fl_near *p = &w->pair[w->inc[c]];
            if (p->n) sum += p->full->stiff_j;
        }
        r->slope[m] += sum / w->b.invm[j] * fl_motion_soft(&r->m.motion[m], arm_of(w, k));
    }
    for (int32_t m = 0; m < r->m.n; m++) {
        const double sum = 2.0 * r->slope[m] + fl_motion_stiff(&r->m.motion[m]);
        if (!(sum > 0.0)) continue;
        const double limit = 2.0 / sqrt(sum);
        w->dt_touching = fmin(w->dt_touching, limit);
        if (limit < w->dt_critical) {
            w->dt_critical = limit;
            w->critical_body = w->b.total + m;
        }
    }
}

double fl_ride_omega2(const fl_world *w, int32_t k, double stiffest)
{
    const fl_motion *m = &w->ride.m.motion[k];
    double arm = 0.0;
    if (!m->free) return 0.0;
    for (int32_t c = 0; c < w->pieces; c++)
        if (w->ride.of[c] == k) arm = fmax(arm, arm_of(w, c));
    return 2.0 * stiffest * fl_motion_soft(m, arm) + fl_motion_stiff(m);
}

fl_ride_books fl_ride_ledger(const fl_world *w)
{
    const fl_movers *v = &w->ride.m;
    fl_ride_books all = {0};
    for (int32_t m = 0; m < v->n; m++) {
        all.kinetic += fl_mover_kinetic(v, m);
        all.stored += v->stored[m];
        all.damped += v->damped[m];
        all.given += v->given[m] + v->b.held[m];
    }
    return all;
}

enum fl_loads_moving fl_ride_columns(const fl_world *w)
{
    enum fl_loads_moving most = w->ride.m.n ? FL_LOADS_MOVES : FL_LOADS_STILL;
    for (int32_t m = 0; m < w->ride.m.n; m++) {
        const fl_motion *motion = &w->ride.m.motion[m];
        if (motion->free >> 3 || v3_some(motion->spin)) most = FL_LOADS_TURNS;
        for (int32_t i = 0; i < motion->track.n; i++)
            if (v3_some(motion->track.at[i].r)) most = FL_LOADS_TURNS;
    }
    return most;
}

fl_vec3 fl_ride_place(const fl_world *w, int32_t part, fl_vec3 x)
{
    const fl_movers *v = &w->ride.m;
    const int32_t m = w->ride.part[part];
    return v3_add(v->b.x[m], m3_mul(fl_body_axes(&v->b, m), v3_sub(x, v->motion[m].reference)));
}

int fl_ride_free_ones(const fl_world *w)
{
    for (int32_t m = 0; m < w->ride.m.n; m++)
        if (w->ride.m.motion[m].free) return 1;
    return 0;
}

/* Of q, by an angle of at most pi. */
static fl_vec3 rotation_vector(fl_quat q)
{
    const double s = sqrt(q.x * q.x + q.y * q.y + q.z * q.z), sign = q.w < 0.0 ? -1.0 : 1.0;
    if (s == 0.0) return v3(0, 0, 0);
    return v3_scale(2.0 * sign * atan2(s, sign * q.w) / s, v3(q.x, q.y, q.z));
}

void fl_ride_tell(const fl_world *w, int32_t part, double t, fl_loads_motion *out)
{
    const fl_movers *v = &w->ride.m;
    const int32_t m = w->ride.part[part];
    *out = (fl_loads_motion){0};
    if (m < 0) return;
    out->u = v3_sub(v->b.x[m], v->motion[m].reference);
    out->v = v->b.v[m];
    out->r = rotation_vector(v->b.q[m]);
    out->w = v->b.w[m];
    fl_mover_acceleration(v, m, t, &out->a, &out->e);
}

const char *fl_ride_name(const fl_world *w, int32_t k)
{
    const fl_scene *s = w->scene;
    int32_t next = moves(&s->structure.motion) ? 1 : 0;
    if (k < next) return "structure";
    for (int32_t i = 0; i < s->n_part; i++)
        if (moves(&s->part[i].motion) && next++ == k) return s->part[i].name;
    return "structure";
}
