/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "contact/pair_law.h"
#include "law/damping.h"
#include "law/material.h"
#include "world/access.h"

/* The one place of `core` is this much softer than a face: what a corner of one would be. */
#define FACE_OF_CORE 6.0

static fl_elastic_constants elastic_of(const fl_scene *s, int32_t material)
{
    if (material == FL_SCENE_BOUNDARY) return (fl_elastic_constants){INFINITY, 0.0};
    if (material == FL_SCENE_STRUCTURE) material = fl_scene_find_material(s, s->structure.material);
    return (fl_elastic_constants){s->material[material].young, s->material[material].poisson};
}

/* Column of the law table for the partner's material. */
static int32_t column(const fl_world *w, int32_t material)
{
    return material >= 0 ? material : material == FL_SCENE_STRUCTURE ? w->materials : w->materials + 1;
}

int fl_pair_law_make_table(fl_world *w, fl_err *err)
{
    const fl_scene *s = w->scene;
    int asked = 0;
    w->materials = s->n_material;
    w->law = fl_alloc((int64_t)w->materials * (w->materials + 2), sizeof *w->law, err);
    if (!w->law) return -1;
    for (int32_t a = 0; a < w->materials; a++) {
        for (int32_t c = 0; c < w->materials + 2; c++) {
            const int32_t b = c < w->materials    ? c
                              : c == w->materials ? FL_SCENE_STRUCTURE
                                                  : FL_SCENE_BOUNDARY;
            const fl_scene_contact t = fl_scene_pair(s, a, b);
            const double given = t.damping;
            const double D = given >= 0.0 ? given : fl_damping_hunt_crossley(t.restitution);
            const double zeta = given >= 0.0 ? given : fl_damping_linear(t.restitution);
            const double alpha = given >= 0.0 ? given : fl_damping_tsuji(t.restitution);
            const int manual = t.law == FL_LAW_MANUAL || t.law == FL_LAW_MANUAL_SI;
            w->law[a * (w->materials + 2) + c] = (fl_pair_law){
                .kind = t.law,
                .exponent = t.exponent,
                .modulus = fl_material_modulus(elastic_of(s, a), elastic_of(s, b)),
                .stiffness = t.stiffness,
                .stiffness_factor = t.stiffness_factor,
                .friction = t.friction,
                .tangential_ratio = t.tangential_ratio,
                .rolling = manual ? 0.0 : t.rolling,
                .impact_damping = D,
                .slow_damping_factor = fl_damping_slow_factor(D),
                .zeta = zeta,
                .alpha = alpha,
                .surrogate_tolerance = t.law == FL_LAW_PATCH ? t.surrogate : 0.0,
                /* Tsuji's ratio is C/(2 sqrt(K M)) = alpha/(2 sqrt(3/2)) */
                .stable_share = manual ? fl_damping_stable_share(fmax(zeta, alpha / sqrt(6.0)))
                                       : fl_hunt_crossley_stable_share(D, 1.0),
                .literal2 = t.manual_eq2,
                .literal18 = t.manual_eq18,
            };
            w->has_rolling |= w->law[a * (w->materials + 2) + c].rolling > 0.0;
            asked |= w->law[a * (w->materials + 2) + c].surrogate_tolerance > 0.0;
        }
    }
    if (asked) w->surrogate_counts = fl_alloc(w->threads, sizeof *w->surrogate_counts, err);
    return asked && !w->surrogate_counts ? -1 : 0;
}

const fl_pair_law *fl_pair_law_of(const fl_world *w, int32_t i, int32_t j)
{
    return &w->law[w->material[i] * (w->materials + 2) + column(w, w->material[j])];
}

/* c of `patch` from the kappa that was given: that of the modulus which makes kappa the stiffness of a whole
 * face, or of what is round: of a capsule's end; of `core`, which it stands in for, of its one place. */
static double given_patch(const fl_world *w, int32_t i, int32_t j, double area)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = fl_pair_law_of(w, i, j);
    const double kappa = law->stiffness;
    const int core = law->kind == FL_LAW_CORE, faces = b->core[i].nv > 2 && (j >= w->n || b->core[j].nv > 2);
    if (faces && !(core && law->exponent != 1.0))
        return 0.5 * (core ? FACE_OF_CORE : 1.0) * kappa / sqrt(area);
    const double modulus = kappa / fl_material_hertz(1.0, fl_material_radius(b->radius[i], b->radius[j]));
    return 0.5 * fl_material_punch(modulus, 1.0);
}

double fl_pair_stiffness(const fl_world *w, int32_t i, int32_t j, double *exponent)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = fl_pair_law_of(w, i, j);
    const fl_piece *piece = fl_world_piece(w, j);
    const int core = law->kind == FL_LAW_CORE && !(piece && piece->kind == FL_PIECE_MESH);
    const int32_t line = core ? 2 : 1; /* to `core` a line is round, too */
    const int round = b->core[i].nv <= line || (j < w->n && b->core[j].nv <= line);
    const double area = w->max_face_area[j] > 0.0 && w->max_face_area[j] < w->max_face_area[i]
                            ? w->max_face_area[j]
                            : w->max_face_area[i];
    *exponent = round ? 1.5 : core ? law->exponent : 0.0;
    if (law->stiffness > 0.0) return *exponent > 0.0 ? law->stiffness : given_patch(w, i, j, area);
    if (*exponent == 0.0) return 0.5 * law->stiffness_factor * fl_material_punch(law->modulus, 1.0);
    if (*exponent == 1.0) return law->stiffness_factor * fl_material_punch(law->modulus, area) / FACE_OF_CORE;
    return law->stiffness_factor *
           fl_material_hertz(law->modulus, fl_material_radius(b->radius[i], b->radius[j]));
}
