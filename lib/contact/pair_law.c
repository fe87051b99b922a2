/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/pi.h"
#include "contact/pair_law.h"
#include "law/damping.h"
#include "law/material.h"
#include "world/access.h"

static fl_elastic_constants elastic_of(const fl_scene *s, int32_t material)
{
    if (material == FL_SCENE_BOUNDARY) return (fl_elastic_constants){INFINITY, 0.0};
    if (material == FL_SCENE_STRUCTURE) material = fl_scene_find_material(s, s->structure.material);
    return (fl_elastic_constants){s->material[material].young, s->material[material].poisson};
}

/* Column of the table for the partner's material. */
static int32_t column_of(const fl_world *w, int32_t material)
{
    return material >= 0 ? material : material == FL_SCENE_STRUCTURE ? w->materials : w->materials + 1;
}

/* E of a linear contact of materials a and b: that of the bonds, or of the materials. */
static double round_young(const fl_world *w, int32_t a, int32_t b)
{
    const fl_scene *s = w->scene;
    const double own = s->material[a].young, other = b >= 0 ? s->material[b].young : own;
    return s->bond.head.present && s->bond.on && s->bond.young > 0.0 ? s->bond.young
                                                                     : 2.0 / (1.0 / own + 1.0 / other);
}

int fl_pair_law_make_table(fl_world *w, fl_err *err)
{
    const fl_scene *s = w->scene;
    int any_surrogate = 0;
    w->materials = s->n_material;
    w->law = fl_alloc((int64_t)w->materials * (w->materials + 2), sizeof *w->law, err);
    if (!w->law) return -1;
    for (int32_t a = 0; a < w->materials; a++) {
        for (int32_t c = 0; c < w->materials + 2; c++) {
            const int32_t b = c < w->materials    ? c
                              : c == w->materials ? FL_SCENE_STRUCTURE
                                                  : FL_SCENE_BOUNDARY;
            const fl_scene_contact t = fl_scene_pair(s, a, b);
            if (t.round_law != fl_scene_pair(s, 0, 0).round_law)
                return fl_scene_fail(s, "contact.round_law", err,
                                     "one law of round contacts for all pairs is expected");
            const double given = t.damping;
            const double D = given >= 0.0 ? given : fl_damping_hunt_crossley(t.restitution);
            const double zeta = given >= 0.0 ? given : fl_damping_linear(t.restitution);
            const double alpha = given >= 0.0 ? given : fl_damping_tsuji(t.restitution);
            const fl_contact_law *row = &fl_contact_laws[t.law];
            w->law[a * (w->materials + 2) + c] = (fl_pair_law){
                .law = row,
                .exponent = t.exponent,
                .round_exponent = t.round_law == FL_ROUND_LINEAR ? 1.0 : 1.5,
                .round_young = round_young(w, a, b),
                .modulus = fl_material_modulus(elastic_of(s, a), elastic_of(s, b)),
                .stiffness = t.stiffness,
                .stiffness_factor = t.stiffness_factor,
                .friction = t.friction,
                .tangential_ratio = t.tangential_ratio,
                .rolling = fl_contact_law_uses(row, "rolling") ? t.rolling : 0.0,
                .impact_damping = D,
                .slow_damping_factor = fl_damping_slow_factor(D),
                .zeta = zeta,
                .alpha = alpha,
                .surrogate_tolerance =
                    fl_contact_law_uses(row, "surrogate") && !w->breaking.on ? t.surrogate : 0.0,
                .stable_share = fl_contact_law_stable_share(row, D, zeta, alpha),
                .literal2 = t.manual_eq2,
                .literal18 = t.manual_eq18,
            };
            w->has_rolling |= w->law[a * (w->materials + 2) + c].rolling > 0.0;
            any_surrogate |= w->law[a * (w->materials + 2) + c].surrogate_tolerance > 0.0;
        }
    }
    if (any_surrogate) w->surrogate_counts = fl_alloc(w->threads, sizeof *w->surrogate_counts, err);
    return any_surrogate && !w->surrogate_counts ? -1 : 0;
}

int fl_pair_law_any_quick(const fl_scene *s)
{
    for (int32_t a = 0; a < s->n_material; a++)
        for (int32_t b = 0; b < s->n_material + 2; b++) {
            const int32_t c = b < s->n_material    ? b
                              : b == s->n_material ? FL_SCENE_STRUCTURE
                                                   : FL_SCENE_BOUNDARY;
            if (fl_contact_laws[fl_scene_pair(s, a, c).law].quick) return 1;
        }
    return 0;
}

const fl_pair_law *fl_pair_law_of(const fl_world *w, int32_t i, int32_t j)
{
    return &w->law[w->material[i] * (w->materials + 2) + column_of(w, w->material[j])];
}

/* c of a patch from the given kappa: that of the modulus for which kappa is the stiffness of a whole face,
 * or of the end of a capsule; where the patch stands in for `core`, of its one point. */
static double patch_stiffness_of(const fl_world *w, int32_t i, int32_t j, double area)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = fl_pair_law_of(w, i, j);
    const double kappa = law->stiffness;
    const int nearest = law->law->points == FL_POINTS_NEAREST,
              faces = b->core[i].nv > 2 && (j >= w->n || b->core[j].nv > 2);
    if (faces && !(nearest && law->exponent != 1.0)) return 0.5 * law->law->face_ratio * kappa / sqrt(area);
    const double modulus = kappa / fl_material_hertz(1.0, fl_material_radius(b->radius[i], b->radius[j]));
    return 0.5 * fl_material_punch(modulus, 1.0);
}

/* Stiffness of a linear contact of a round core: that of a bond of the same two; the whole half bond on a
 * thing that is not round. */
static double round_stiffness(const fl_world *w, int32_t i, int32_t j)
{
    const double E = fl_pair_law_of(w, i, j)->round_young, ri = w->b.radius[i], rj = w->b.radius[j];
    if (w->b.core[i].nv > 2) return E * PI * rj;
    if (j >= w->n || w->b.core[j].nv > 2) return E * PI * ri;
    const double r = ri < rj ? ri : rj;
    return E * PI * r * r / (ri + rj);
}

fl_pair_spring fl_pair_stiffness(const fl_world *w, int32_t i, int32_t j)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = fl_pair_law_of(w, i, j);
    const fl_piece *piece = fl_world_piece(w, j);
    const int nearest = law->law->points == FL_POINTS_NEAREST && !(piece && piece->kind == FL_PIECE_MESH);
    const int32_t line = nearest ? law->law->round_vertices : 1;
    const int round = b->core[i].nv <= line || (j < w->n && b->core[j].nv <= line);
    const double area = w->max_face_area[j] > 0.0 && w->max_face_area[j] < w->max_face_area[i]
                            ? w->max_face_area[j]
                            : w->max_face_area[i];
    fl_pair_spring s = {.points = round || nearest ? FL_POINTS_NEAREST : FL_POINTS_PATCH,
                        .exponent = round     ? law->round_exponent
                                    : nearest ? law->exponent
                                              : 0.0};
    const int patch = s.points == FL_POINTS_PATCH;
    if (law->stiffness > 0.0) s.k = patch ? patch_stiffness_of(w, i, j, area) : law->stiffness;
    else if (patch) s.k = 0.5 * law->stiffness_factor * fl_material_punch(law->modulus, 1.0);
    else if (s.exponent == 1.0 && round) s.k = law->stiffness_factor * round_stiffness(w, i, j);
    else if (s.exponent == 1.0)
        s.k = law->stiffness_factor * fl_material_punch(law->modulus, area) / law->law->face_ratio;
    else
        s.k = law->stiffness_factor *
              fl_material_hertz(law->modulus, fl_material_radius(b->radius[i], b->radius[j]));
    return s;
}

enum fl_contact_points fl_pair_points(const fl_world *w, int32_t i, int32_t j, fl_pair_spring s)
{
    const fl_piece *piece = fl_world_piece(w, j);
    const int features = fl_pair_law_of(w, i, j)->law->points == FL_POINTS_FEATURES &&
                         (!piece || piece->kind == FL_PIECE_SOLID || piece->kind == FL_PIECE_CONE);
    return features ? FL_POINTS_FEATURES : s.points;
}
