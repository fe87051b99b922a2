/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "law/contact_law.h"
#include "law/damping.h"

const char fl_contact_law_choices[] = "patch|manual|manual-si|core|quick";
const char fl_contact_law_meaning[] =
    "patch: a root of the sum over the faces, edges and vertices that touch, with one potential; "
    "core: the nearest pair of features alone; manual: the "
    "DilatedDEM manual's table of modes with its lengths as numbers; manual-si: the same with "
    "consistent units; quick: the potential of patch from fewer terms, at a fraction of its cost, for floes "
    "on floes; for parts that are not convex patch stands in for all";

const fl_contact_law fl_contact_laws[] = {
    {.name = "patch",
     .keys = {"rolling", "surrogate"},
     .points = FL_POINTS_PATCH,
     .round_vertices = 1,
     .face_ratio = 1.0,
     .damping = FL_DAMPING_IMPACT,
     .end_speed = 1,
     .spheres = 1},
    {.name = "manual",
     .keys = {"manual_eq2", "manual_eq18"},
     .points = FL_POINTS_FEATURES,
     .round_vertices = 1,
     .face_ratio = 1.0,
     .damping = FL_DAMPING_RATIO},
    {.name = "manual-si",
     .keys = {"manual_eq2", "manual_eq18"},
     .points = FL_POINTS_FEATURES,
     .round_vertices = 1,
     .face_ratio = 1.0,
     .damping = FL_DAMPING_RATIO,
     .si = 1},
    /* The one point of `core` is 1/6 as stiff as a face: what a corner of one would be. */
    {.name = "core",
     .keys = {"rolling", "exponent"},
     .points = FL_POINTS_NEAREST,
     .round_vertices = 2,
     .face_ratio = 6.0,
     .damping = FL_DAMPING_IMPACT,
     .spheres = 1},
    {.name = "quick",
     .keys = {"rolling", "surrogate"},
     .points = FL_POINTS_PATCH,
     .round_vertices = 1,
     .face_ratio = 1.0,
     .damping = FL_DAMPING_IMPACT,
     .end_speed = 1,
     .quick = 1,
     .spheres = 1},
};

const int32_t fl_contact_law_count = sizeof fl_contact_laws / sizeof *fl_contact_laws;

int fl_contact_law_uses(const fl_contact_law *law, const char *key)
{
    for (int k = 0; k < FL_CONTACT_LAW_KEYS && law->keys[k]; k++)
        if (strcmp(law->keys[k], key) == 0) return 1;
    return 0;
}

double fl_contact_law_stable_share(const fl_contact_law *law, double D, double zeta, double alpha)
{
    if (law->damping == FL_DAMPING_IMPACT) return fl_hunt_crossley_stable_share(D, 1.0);
    /* Tsuji's ratio is C/(2 sqrt(K M)) = alpha/(2 sqrt(3/2)) */
    return fl_damping_stable_share(fmax(zeta, alpha / sqrt(6.0)));
}

double fl_contact_law_scaled_share(const fl_contact_law *law, double D, double share, double times)
{
    if (times == 1.0) return share;
    if (law->damping == FL_DAMPING_IMPACT) return fl_hunt_crossley_stable_share(D, times);
    return fl_damping_stable_share(0.5 * (1.0 / share - share) * sqrt(times));
}
