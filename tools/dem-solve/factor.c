/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "factor.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/pi.h"
#include "base/stream.h"
#include "contact/joint_list.h"
#include "sim/relaxed_run.h"
#include "sim/setup.h"
#include "sim/stage.h"
#include "sim/step.h"
#include "step_choice.h"
#include "world/access.h"

/* The first trial of either side, the range, and the width of the interval at the end. */
static const double FIRST = 1.25, LARGEST = 100.0, WIDTH = 1.002;
/* A body that moves by this part of its size has failed. */
static const double MOVED = 0.02;

enum { WHAT_FRICTION = 1, WHAT_COHESION = 2, WHAT_TENSION = 4 };

struct factor_search {
    struct run *r;
    factor_make_world *make;
    void *with;
    int what;
    int32_t joint; /* -1: all */
    fl_out out;
    int32_t trials;
};

static int read_key(struct factor_search *s, const char *key, fl_err *err)
{
    static const char *const WORD[] = {"friction", "cohesion", "tension"};
    const char *dot = strrchr(key, '.');
    const fl_scene *scene = s->r->scene;
    s->joint = -1;
    if (strcmp(key, "friction") == 0) s->what = WHAT_FRICTION;
    if (strcmp(key, "strength") == 0) s->what = WHAT_FRICTION | WHAT_COHESION | WHAT_TENSION;
    if (dot && strncmp(key, "joint.", 6) == 0)
        for (int k = 0; k < 3; k++)
            if (strcmp(dot + 1, WORD[k]) == 0) s->what = 1 << k;
    for (int32_t k = 0; dot && k < scene->n_joint; k++)
        if (dot - key == 6 + (long)strlen(scene->joint[k].name) &&
            strncmp(key + 6, scene->joint[k].name, strlen(scene->joint[k].name)) == 0)
            s->joint = k;
    if (!s->what || (dot && s->joint < 0))
        return fl_fail(err, FL_USAGE,
                       "--factor is \"%.60s\", expected friction, strength or joint.NAME.friction, "
                       ".cohesion or .tension",
                       key);
    if (!scene->n_joint && !scene->zones.head.present)
        return fl_fail(err, FL_USAGE, "--factor: the scene has no [joint NAME]");
    if (!scene->run.relax) return fl_fail(err, FL_USAGE, "--factor: run.relax is none, local is expected");
    return 0;
}

/* Strengths over F; F = 0: without limit. */
static void set_strengths(const struct factor_search *s, fl_world *w, const fl_joint_material *was, double F)
{
    for (int32_t k = 0; k < w->scene->n_joint && w->bonds.joint; k++) {
        fl_joint_material *m = &w->bonds.joint_material[k];
        *m = was[k];
        if (F == 0.0) {
            m->law = FL_JOINT_COULOMB;
            m->cohesion = m->tension = INFINITY;
        } else if (s->joint < 0 || s->joint == k) {
            if (s->what & WHAT_FRICTION) {
                m->friction /= F, m->residual_friction /= F;
                m->angle = atan(tan(m->angle) / F), m->initial_angle = atan(tan(m->initial_angle) / F);
            }
            if (s->what & WHAT_COHESION) m->cohesion /= F, m->residual_cohesion /= F;
            if (s->what & WHAT_TENSION) m->tension /= F;
        }
    }
}

/* The same for zones of law mohr-coulomb. */
static void set_zone_strengths(const struct factor_search *s, fl_world *w, double F)
{
    for (int32_t k = 0; k < w->zones.set.materials && w->zones.set.plastic; k++) {
        const fl_scene_material *q = &w->scene->material[k];
        const double turn = PI / 180.0, tangent = tan(q->friction_angle * turn),
                     phi = s->what & WHAT_FRICTION ? atan(tangent / F) / turn : q->friction_angle,
                     c = s->what & WHAT_COHESION ? q->cohesion / F : q->cohesion,
                     T = s->what & WHAT_TENSION ? q->tension / F : q->tension;
        if (q->cohesion < 0.0 || s->joint >= 0) continue;
        if (F == 0.0) fl_zone_material_set_strength(&w->zones.set.material[k], INFINITY, 0.0, INFINITY, 0.0);
        else fl_zone_material_set_strength(&w->zones.set.material[k], c, phi, T, fmin(q->dilation, phi));
    }
}

static double largest_displacement(const fl_world *w, const fl_vec3 *x)
{
    double most = 0.0;
    for (int32_t k = 0; k < w->n; k++)
        if (!fl_body_absent(w, k))
            most = fmax(most, v3_norm(v3_sub(w->b.x[k], x[k])) / w->b.bounding_radius[k]);
    return most;
}

/* Steps until rest: 1; 0 if it does not come to rest within the duration, or moves too far from x; -1. */
static int come_to_rest(struct run *r, fl_world *w, const fl_vec3 *x, fl_err *err)
{
    const int64_t end = w->step + r->steps;
    w->stage_step = w->step;
    while (w->step < end) {
        if (fl_step(w, err)) return -1;
        if ((w->step - w->stage_step) % FL_RELAX_EVERY) continue;
        const int rest =
            fl_stage_update(w, r->group, (const char *const *)r->groups->name, r->groups->n, err);
        if (rest) return rest;
        if (x && largest_displacement(w, x) > MOVED) return 0;
    }
    return 0;
}

/* One trial: 1 if the model stands at the factor F. */
static int try_factor(struct factor_search *s, double F, fl_err *err)
{
    fl_world w = {0};
    struct run r = *s->r;
    fl_joint_material *was = NULL;
    fl_vec3 *x = NULL;
    int stands = -1;
    if (s->make(s->with, &w, err)) return -1;
    r.w = &w;
    choose_step(&r);
    was = fl_alloc(r.scene->n_joint, sizeof *was, err);
    x = fl_alloc(w.n, sizeof *x, err);
    if (!was || !x) goto done;
    if (w.bonds.joint) memcpy(was, w.bonds.joint_material, (size_t)r.scene->n_joint * sizeof *was);
    set_strengths(s, &w, was, 0.0);
    set_zone_strengths(s, &w, 0.0);
    if (fl_step_start(&w, err)) goto done;
    const int rest = come_to_rest(&r, &w, NULL, err);
    if (rest < 0) goto done;
    if (rest == 0) {
        fl_fail(err, FL_NO, "the model does not come to rest within %g s even with joints that cannot fail",
                r.scene->run.duration);
        goto done;
    }
    for (int32_t k = 0; k < w.n; k++) x[k] = w.b.x[k];
    set_strengths(s, &w, was, F);
    set_zone_strengths(s, &w, F);
    for (int32_t k = 0; k < w.bonds.n - w.bonds.faces; k++)
        for (int e = 0; e < FL_BOND_POINTS; e++) {
            fl_joint_point *p = &w.bonds.joint[k].point[e];
            if (w.bonds.joint[k].material < 0) continue;
            p->angle = w.bonds.joint_material[w.bonds.joint[k].material].initial_angle;
        }
    const double begun = fl_world_time(&w);
    stands = come_to_rest(&r, &w, x, err);
    if (stands >= 0) {
        char a[FL_NUMBER_LEN], b[FL_NUMBER_LEN], c[FL_NUMBER_LEN], d[FL_NUMBER_LEN];
        fprintf(s->out.f, "%s\t%s\t%s\t%s\t%s\n", fl_number_text(F, a), stands ? "stands" : "fails",
                fl_number_text(fl_relaxed_run_ratio(&w), b), fl_number_text(largest_displacement(&w, x), c),
                fl_number_text(fl_world_time(&w) - begun, d));
        if (fl_out_flush(&s->out, err)) stands = -1;
        s->trials++;
    }
done:
    free(was), free(x);
    fl_world_free(&w);
    return stands;
}

/* The interval [lo, hi]: stands at lo, fails at hi. */
static int find_interval(struct factor_search *s, double *lo, double *hi, fl_err *err)
{
    int stands = try_factor(s, 1.0, err);
    double step = FIRST;
    if (stands < 0) return -1;
    const int up = stands;
    *lo = *hi = 1.0;
    while (stands == up) {
        const double F = up ? *lo * step : *hi / step;
        if (F > LARGEST || F < 1.0 / LARGEST)
            return fl_fail(err, FL_NO, "the model %s at every factor down to %g", up ? "stands" : "fails",
                           up ? *lo : *hi);
        stands = try_factor(s, F, err);
        if (stands < 0) return -1;
        if (stands) *lo = F;
        else *hi = F;
        step *= FIRST;
    }
    while (*hi > *lo * WIDTH) {
        const double F = sqrt(*lo * *hi);
        stands = try_factor(s, F, err);
        if (stands < 0) return -1;
        if (stands) *lo = F;
        else *hi = F;
    }
    return 0;
}

int factor_search(struct run *r, const char *key, factor_make_world *make, void *with, fl_err *err)
{
    struct factor_search s = {.r = r, .make = make, .with = with};
    char a[FL_NUMBER_LEN], b[FL_NUMBER_LEN];
    double lo, hi;
    if (read_key(&s, key, err) || fl_out_open(&s.out, r->loads_path, r->gzip, err)) return -1;
    fl_write_file_header(s.out.f, "factor", 1, r->history, r->by);
    fputs("factor\tstate\tratio\tmoved\ttime[s]\n", s.out.f);
    if (find_interval(&s, &lo, &hi, err)) {
        fl_out_abort(&s.out);
        return -1;
    }
    fprintf(s.out.f, "#factor %s %s %s\n", key, fl_number_text(lo, a), fl_number_text(hi, b));
    if (!r->o->quiet)
        fprintf(stderr, "dem-solve: factor of %s between %.5g and %.5g, %d trials\n", key, lo, hi, s.trials);
    return fl_out_close(&s.out, err);
}
