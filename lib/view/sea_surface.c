/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "view/sea_surface.h"

/* Half of the square's side, over which waves are whole; from there to the rim they fade. */
#define WHOLE 0.70f
/* Trains of shorter waves than this many points are not drawn. */
#define LEAST_POINTS 3.0

int fl_sea_of_scene(fl_waves *w, const fl_scene *scene, int *has, fl_err *err)
{
    const fl_scene_water *s = &scene->water;
    const double g = -scene->run.gravity.z;
    *has = s->wave != FL_WAVE_NONE && s->height > 0.0 && s->period > 0.0;
    if (!*has) return 0;
    if (s->wave == FL_WAVE_AIRY)
        return fl_waves_airy(w, s->height, s->period, s->direction, s->depth, g, err);
    return fl_waves_jonswap(w, s->height, s->period, s->gamma, s->components, (uint64_t)s->seed, s->direction,
                            s->depth, g, err);
}

static double elevation_at(const fl_waves *w, double s, double t, double most_k)
{
    double eta = 0.0;
    for (int32_t k = 0; k < w->n && w->train[k].k < most_k; k++)
        eta += w->train[k].a * cos(w->train[k].k * s - w->train[k].omega * t + w->train[k].phase);
    return eta;
}

void fl_sea_heights(const fl_waves *w, double t, const fl_sea_surface *where, float *height)
{
    const double step = where->side / FL_SEA_SIDE, most_k = 6.2832 / (LEAST_POINTS * step);
    for (int j = 0; j < FL_SEA_SIDE; j++)
        for (int i = 0; i < FL_SEA_SIDE; i++) {
            const double x = where->x0 + (i + 0.5) * step, y = where->y0 + (j + 0.5) * step;
            const float u = fabsf(2.0f * ((float)i + 0.5f) / FL_SEA_SIDE - 1.0f),
                        v = fabsf(2.0f * ((float)j + 0.5f) / FL_SEA_SIDE - 1.0f);
            const float fade = fmaxf(0.0f, fminf(1.0f, (0.98f - fmaxf(u, v)) / (0.98f - WHOLE)));
            height[FL_SEA_SIDE * j + i] =
                fade > 0.0f
                    ? fade * (float)elevation_at(w, w->direction.x * x + w->direction.y * y, t, most_k)
                    : 0.0f;
        }
}
