/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/strip_setup.h"
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "contact/strip_dent.h"
#include "scene/scene_key.h"
#include "sim/moving_structure.h"

/* Sectors on an outline for element_width = auto, at least; share of break_deflection that a step may close.
 * */
enum { AUTO_RING = 16 };
#define STEP_SHARE 0.2

/* Closing speed over that of the ice, at most, where the structure is free to swing: in slow cycles its peaks
 * are twice the speed of the ice on the mean (IV5 of verify_vibration). */
#define SWING 4.0

/* Pressure of the law `rate` where none is given, times peak_ratio [Pa]. */
#define PEAK_PRESSURE 2e6

static int key_given(const fl_scene_failure *s, const char *key)
{
    return s->head.key[fl_key_find(FL_SEC_FAILURE, key) - fl_key_first(FL_SEC_FAILURE)].line != 0;
}

/* Mean height of the floes, and the largest thickness [m]. */
static void ice_at_start(const fl_world *w, double *z, double *thickest)
{
    double sum = 0.0;
    int32_t n = 0;
    *thickest = 0.0;
    for (int32_t i = 0; i < w->n; i++) {
        const fl_poly *p = &w->b.core[i];
        const fl_mat3 R = fl_body_axes(&w->b, i);
        double low = INFINITY, high = -INFINITY;
        if (fl_body_absent(w, i)) continue;
        for (int32_t v = 0; v < p->nv; v++) {
            const double h = m3_mul(R, p->v[v]).z;
            low = fmin(low, h), high = fmax(high, h);
        }
        *thickest = fmax(*thickest, high - low + 2.0 * w->b.radius[i]);
        sum += w->b.x[i].z;
        n++;
    }
    *z = n ? sum / n : 0.0;
}

static int make_walls(fl_world *w, fl_err *err)
{
    const fl_scene_failure *s = &w->scene->failure;
    double z, thickest;
    int32_t walls = 0;
    ice_at_start(w, &z, &thickest);
    const int is_auto = s->element_width == 0.0;
    const double width = is_auto ? 2.0 * thickest : s->element_width;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k;
        const fl_mat3 R = fl_body_axes(&w->b, j);
        const fl_vec3 up = m3_tmul(R, v3(0, 0, 1)), at = v3_scale(z - w->b.x[j].z, up);
        if (fl_wall_make(&w->strips.wall[k], &w->structure.piece[k], up, at, width, is_auto ? AUTO_RING : 0,
                         err))
            return -1;
        walls += w->strips.wall[k].n > 0;
    }
    if (walls) return 0;
    return fl_scene_fail(
        w->scene, "failure.crushing_law", err,
        "the structure has no wall within 15 degrees of the vertical at z = %.4g m, where the ice "
        "is: crushing_law = plain is expected",
        z);
}

int fl_strips_make(fl_world *w, fl_err *err)
{
    const fl_scene_failure *s = &w->scene->failure;
    fl_strips *q = &w->strips;
    if (!s->head.present || s->crushing == FL_CRUSHING_NONE || s->crushing_law != FL_CRUSHING_RATE) return 0;
    for (int32_t i = 0; i < w->n; i++)
        if (w->b.core[i].nf == 0)
            return fl_scene_fail(
                w->scene, "failure.crushing_law", err,
                "body %d is a sphere or a capsule: crushing_law = rate is for floes with faces", w->id[i]);
    q->law = (fl_strip_law){s->peak_ratio,        s->break_deflection, s->transition_speed, s->creep_exponent,
                            s->delayed_stiffness, s->delayed_time,     (uint64_t)s->seed};
    q->pressure = fl_pressure_area_of(s);
    if (!key_given(s, "pressure") && s->pressure_law == FL_PRESSURE_USER)
        q->pressure.p0 = PEAK_PRESSURE / s->peak_ratio;
    q->scatter = s->scatter;
    q->scatter_length = s->scatter_length;
    q->pieces = w->pieces;
    q->wall = fl_alloc(w->pieces, sizeof *q->wall, err);
    q->part_closing = fl_alloc(w->parts, sizeof *q->part_closing, err);
    q->part_seconds = fl_alloc(w->parts, sizeof *q->part_seconds, err);
    q->part_breaks = fl_alloc(w->parts, sizeof *q->part_breaks, err);
    w->crushing.dents = fl_alloc(w->n, sizeof *w->crushing.dents, err);
    return err->code || make_walls(w, err) ? -1 : 0;
}

void fl_strips_free(fl_strips *s)
{
    for (int32_t k = 0; s->wall && k < s->pieces; k++) fl_wall_free(&s->wall[k]);
    free(s->wall), free(s->part_closing), free(s->part_seconds), free(s->part_breaks);
    *s = (fl_strips){0};
}

int fl_strips_book(fl_world *w, double dt, fl_err *err)
{
    fl_strips *s = &w->strips;
    for (int32_t c = 0; c < w->n_touching; c++) {
        const fl_pair *p = w->pair[w->touching_pairs[c]].contact;
        if (!p->strip) continue;
        w->ledger.crushing += p->strip->work;
        if (p->strip->apart && fl_strip_has_left(p->strip) &&
            fl_strip_keep_dent(w, p->i, p->strip, &s->wall[p->j - w->n], err))
            return -1;
        if (p->load_part < 0) continue;
        s->part_closing[p->load_part] += dt * p->strip->closing;
        s->part_seconds[p->load_part] += dt;
        s->part_breaks[p->load_part] += p->strip->breaks;
    }
    return 0;
}

int fl_strips_check(const fl_world *w, fl_err *err)
{
    const double most = STEP_SHARE * w->strips.law.delta;
    if (!(w->strips.too_fast > 0.0)) return 0;
    return fl_fail(err, FL_NUMERIC,
                   "ice closes on a wall by %.3g m in a step at t = %g s, more than a fifth of "
                   "failure.break_deflection: a run.dt of at most %.3g s is expected",
                   w->strips.too_fast, fl_world_time(w), w->dt * most / w->strips.too_fast);
}

/* Largest speed of floes at the start, and of the drive [m/s]. */
static double fastest_ice(const fl_world *w)
{
    const fl_track *tr = &w->driven_floes.track;
    double fastest = 0.0;
    for (int32_t i = 0; i < w->n; i++) fastest = fmax(fastest, v3_norm(w->b.v[i]));
    for (int32_t k = 0; k < tr->n; k++) {
        fl_pose6 x, rate, second;
        fl_track_evaluate(tr, tr->t[k], &x, &rate, &second);
        fastest = fmax(fastest, v3_norm(rate.x));
    }
    return fastest;
}

int fl_strips_check_start(const fl_world *w, fl_err *err)
{
    const double speed = fastest_ice(w), most = STEP_SHARE * w->strips.law.delta;
    if (w->automatic_dt || speed * w->dt <= most) return 0;
    return fl_scene_fail(w->scene, "run.dt", err,
                         "ice of %.3g m/s closes on a wall by %.3g m in a step, more than a fifth of "
                         "failure.break_deflection: at most %.3g s is expected",
                         speed, speed * w->dt, most / speed);
}

double fl_strips_max_step(const fl_world *w)
{
    if (!w->strips.wall) return INFINITY;
    double fastest = v3_norm(w->scene->water.head.present ? w->scene->water.current : v3(0, 0, 0));
    fastest = fmax(fastest, fastest_ice(w));
    fastest = fmax(fl_structure_moves_freely(w) ? SWING * fastest : fastest, w->moving.max_speed);
    return fastest > 0.0 ? STEP_SHARE * w->strips.law.delta / fastest : INFINITY;
}

/* Width of a wall seen along e, world axes [m]. */
static double width_along(const fl_world *w, int32_t piece, fl_vec3 e)
{
    const fl_wall *wall = &w->strips.wall[piece];
    const fl_vec3 d = m3_tmul(fl_body_axes(&w->b, w->n + piece), e);
    double sum = 0.0;
    for (int32_t k = 0; k < wall->n; k++)
        sum += wall->sector[k].width * fmax(0.0, v3_dot(wall->sector[k].n, d));
    return sum;
}

/* Largest value of y of fl_strip_strength_at(), sqrt(3) times that of a sum of four uniforms. */
#define MOST_STRENGTH 3.4641016151377544

/* sum k |S_i| over all sectors; the pressure is that of half of their area, which is more than of all. */
double fl_strips_stiffness(const fl_world *w, int32_t piece)
{
    const fl_strips *s = &w->strips;
    double z, thickest, width = 0.0;
    ice_at_start(w, &z, &thickest);
    for (int32_t k = 0; k < s->wall[piece].n; k++) width += s->wall[piece].sector[k].width;
    const double A = thickest * width;
    return (1.0 + MOST_STRENGTH * s->scatter) * s->law.peak_ratio * A *
           fl_crushing_pressure(&s->pressure, 0.5 * A) / s->law.delta;
}

double fl_strips_lock_in_speed(const fl_world *w, int32_t k)
{
    int32_t mover;
    const fl_modal_dof *m = fl_structure_mode(w, k, &mover);
    const fl_strips *s = &w->strips;
    double z, thickest, F = 0.0, b = fl_strip_negative_damping(&s->law);
    int is_round = 0;
    if (!s->wall) return 0.0;
    ice_at_start(w, &z, &thickest);
    for (int32_t c = 0; c < w->pieces; c++) {
        const double A = thickest * width_along(w, c, m->e);
        if (w->moving.mover_of_piece[c] != mover || A == 0.0) continue;
        F += A * fl_crushing_pressure(&s->pressure, A);
        is_round |= s->wall[c].is_round;
    }
    return F > 0.0 ? fl_strip_lock_in_speed(F, is_round ? 0.5 * PI * b : b, m->ratio, m->omega, m->mass)
                   : 0.0;
}
