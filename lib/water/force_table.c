/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/force_table.h"
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/pi.h"

/* --- buoyancy of still water ------------------------------------------------------------------- */

static int set_up_buoyancy(fl_environment *s, fl_bodies *b, const fl_scene *scene, fl_err *err)
{
    (void)b, (void)err;
    s->level = scene->water.level;
    s->gravity = v3_norm(scene->run.gravity);
    s->specific_weight = scene->water.density * s->gravity;
    return 0;
}

static int has_water(const fl_environment *s, const fl_bodies *b)
{
    (void)b;
    return s->water;
}

/* Part of the volume that may be dry by rounding in a body that is wholly under water. */
#define ROUNDING 1e-12

static void describe_buoyancy(const fl_environment *s, char text[FL_FORCE_TEXT])
{
    int32_t dry = 0, under = 0;
    for (int32_t i = 0; i < s->n; i++) {
        const double whole = s->specific_weight * s->hull[i].volume;
        dry += s->buoyancy[i] <= 0.0;
        under += whole > 0.0 && s->buoyancy[i] >= whole * (1.0 - ROUNDING);
    }
    snprintf(text, FL_FORCE_TEXT, "%d %s at the surface, %d wholly under it, %d dry", s->n - dry - under,
             s->waves ? "integrated" : "clipped", under, dry);
}

/* In waves the work of buoyancy is in that of the waves. */
static double buoyancy_energy(const fl_environment *s, const fl_bodies *b, int32_t i)
{
    return s->waves ? 0.0 : fl_environment_energy(s, b, i);
}

/* --- waves ------------------------------------------------------------------------------------- */

/* Trains of components = auto: those at the peak are one cycle of the run apart. */
enum { LEAST_TRAINS = 100, MOST_TRAINS = 2000 };

static int32_t train_count(const fl_scene *scene)
{
    const fl_scene_water *w = &scene->water;
    if (w->components > 0) return w->components;
    const double peak = fl_jonswap_spectrum(1.0 / w->period, w->height, w->period, w->gamma),
                 n = scene->run.duration * w->height * w->height / (16.0 * peak);
    return n < LEAST_TRAINS ? LEAST_TRAINS : n > MOST_TRAINS ? MOST_TRAINS : (int32_t)ceil(n);
}

/* C, m, n of the decay in ice. */
static void decay_law(const fl_scene_water *w, double law[3])
{
    static const double LAW[FL_ICE_DECAY_OWN][3] = {{0, 0, 0}, {2.9, 1.25, 4.5}, {0.059, 1.0, 3.0}};
    const fl_vec3 own = w->ice_decay_law;
    law[0] = own.x, law[1] = own.y, law[2] = own.z;
    if (w->ice_decay != FL_ICE_DECAY_OWN) memcpy(law, LAW[w->ice_decay], sizeof LAW[0]);
}

/* Waves by error; the scratch is for `threads`. */
static int set_up_grid(fl_environment *s, const fl_scene *scene, fl_err *err)
{
    const fl_scene_water *w = &scene->water;
    fl_wave_grid_form f = {.error = w->wave_error,
                           .spread = w->spread,
                           .seed = (uint64_t)w->seed,
                           .edge = w->ice_edge,
                           .thickness = w->ice_thickness};
    decay_law(w, f.decay);
    if (fl_wave_grid_make(&s->grid, &s->wave, &f, s->threads, err)) return -1;
    s->by_blocks = 1;
    s->sea = (fl_wave_water){.grid = &s->grid,
                             .current = &s->current,
                             .level = s->level,
                             .weight = s->specific_weight,
                             .max_crest = s->wave.max_crest,
                             .deviation = 0.25 * s->wave.four_sigma,
                             .k95 = s->wave.k95};
    return 0;
}

static int set_up_waves(fl_environment *s, fl_bodies *b, const fl_scene *scene, fl_err *err)
{
    const fl_scene_water *w = &scene->water;
    const double g = v3_norm(scene->run.gravity);
    (void)b;
    s->sample_every = w->every;
    if (!s->water || w->wave == FL_WAVE_NONE) return 0;
    if (w->wave == FL_WAVE_AIRY
            ? fl_waves_airy(&s->wave, w->height, w->period, w->direction, w->depth, g, err)
            : fl_waves_jonswap(&s->wave, w->height, w->period, w->gamma, train_count(scene),
                               (uint64_t)w->seed, w->direction, w->depth, g, err))
        return -1;
    s->waves = 1;
    return w->wave_error > 0.0 ? set_up_grid(s, scene, err) : 0;
}

static int has_waves(const fl_environment *s, const fl_bodies *b)
{
    (void)b;
    return s->waves;
}

static void describe_waves(const fl_environment *s, char text[FL_FORCE_TEXT])
{
    const fl_scene_water *w = &s->scene->water;
    double breaking;
    const double steep = fl_wave_steepness(w->height, w->period, w->depth, s->wave.gravity, &breaking);
    snprintf(text, FL_FORCE_TEXT, "%s of %.3g m and %.3g s, %d train%s, %.3g m long, steepness %.3g%s",
             w->wave == FL_WAVE_AIRY ? "airy" : "jonswap", w->height, w->period, s->wave.n,
             s->wave.n == 1 ? "" : "s", w->height / steep, steep,
             steep > breaking ? ": they would break" : "");
    if (!s->by_blocks) return;
    int64_t points = 0;
    for (int32_t i = 0; i < s->n; i++) points += s->nodes[i].n;
    const size_t used = strlen(text);
    snprintf(text + used, FL_FORCE_TEXT - used, "; to %g %%: %.3g points a floe each %.3g s",
             100.0 * s->grid.error, (double)points / (s->n > 0 ? s->n : 1), 2.0 * s->grid.step);
}

static double wave_work(const fl_environment *s, const fl_bodies *b, int32_t i)
{
    (void)b;
    return s->water_work[i];
}

/* --- current ----------------------------------------------------------------------------------- */

static int set_up_current(fl_environment *s, fl_bodies *b, const fl_scene *scene, fl_err *err)
{
    const fl_scene_water *w = &scene->water;
    (void)b;
    s->current = (fl_current){.velocity = w->current,
                              .kind = w->profile,
                              .depth = w->profile_depth > 0.0 ? w->profile_depth : w->depth,
                              .exponent = w->profile_exponent};
    return w->profile == FL_PROFILE_TABLE ? fl_current_read(&s->current, w->profile_file, err) : 0;
}

static int has_current(const fl_environment *s, const fl_bodies *b)
{
    (void)b;
    return s->water && fl_current_max_speed(&s->current) > 0.0;
}

static void describe_current(const fl_environment *s, char text[FL_FORCE_TEXT])
{
    static const char *const PROFILE[] = {"at all depths", "by a power of the depth", "linear in the depth",
                                          "by a table"};
    snprintf(text, FL_FORCE_TEXT, "%.3g m/s at most, %s", fl_current_max_speed(&s->current),
             PROFILE[s->scene->water.profile]);
}

/* --- added mass -------------------------------------------------------------------------------- */

static int set_up_added_mass(fl_environment *s, fl_bodies *b, const fl_scene *scene, fl_err *err)
{
    const fl_vec3 a = scene->water.added_mass;
    if (!s->water || !v3_nonzero(a)) return 0;
    if (!s->only_spheres || s->waves || a.x != 0.0 || a.y != 0.0 || !(a.z > 0.0) || !(s->gravity > 0.0))
        return fl_bodies_alloc_added_mass(b, err);
    s->heave_factor = a.z; /* of a sheet: along the vertical, whichever way its spheres have turned */
    return fl_bodies_alloc_heave(b, err);
}

static int has_added_mass(const fl_environment *s, const fl_bodies *b)
{
    (void)s;
    return b->added_mass || b->heave_mass;
}

/* Work that the flow has taken out of a body with added mass. */
static double flow_loss(const fl_environment *s, const fl_bodies *b, int32_t i)
{
    (void)s;
    return b->heave_mass ? -b->heave_work[i] : -b->flow_work[i];
}

/* --- drag of water and wind -------------------------------------------------------------------- */

static int set_up_water_drag(fl_environment *s, fl_bodies *b, const fl_scene *scene, fl_err *err)
{
    const fl_scene_water *w = &scene->water;
    (void)b, (void)err;
    s->seawater = (fl_fluid){w->density, w->drag_force_coef, w->drag_moment_coef};
    s->water_drag_law = w->drag;
    s->water_skin = w->skin_coef;
    s->water_form = w->form_coef;
    return 0;
}

static int set_up_wind(fl_environment *s, fl_bodies *b, const fl_scene *scene, fl_err *err)
{
    const fl_scene_wind *w = &scene->wind;
    (void)b, (void)err;
    s->air = (fl_fluid){w->density, w->drag_coef, 0.0};
    s->wind_drag_law = w->drag;
    s->wind_form = w->form_coef;
    s->wind_velocity = w->velocity;
    if (w->beaufort >= 0.0) { /* the Beaufort scale of the manual */
        const double U = 0.836 * w->beaufort * sqrt(w->beaufort), a = fl_radians(w->direction);
        s->wind_velocity = v3(U * cos(a), U * sin(a), 0);
    }
    return 0;
}

static int has_wind(const fl_environment *s, const fl_bodies *b)
{
    (void)b;
    return s->wind;
}

static void describe_law(int law, char text[FL_FORCE_TEXT])
{
    snprintf(text, FL_FORCE_TEXT, "%s", law == FL_DRAG_FACET ? "by facets" : "of the whole");
}

static void describe_water_drag(const fl_environment *s, char text[FL_FORCE_TEXT])
{
    describe_law(s->water_drag_law, text);
}

static void describe_wind(const fl_environment *s, char text[FL_FORCE_TEXT])
{
    describe_law(s->wind_drag_law, text);
}

static double water_drag_loss(const fl_environment *s, const fl_bodies *b, int32_t i)
{
    (void)b;
    return s->drag_loss[i];
}

static double wind_work(const fl_environment *s, const fl_bodies *b, int32_t i)
{
    (void)b;
    return s->wind_work[i];
}

/* --- the table --------------------------------------------------------------------------------- */

const fl_water_force fl_water_forces[] = {
    {"buoyancy", set_up_buoyancy, has_water, describe_buoyancy, FL_FORCE_HYDROSTATIC, buoyancy_energy, NULL},
    {"waves", set_up_waves, has_waves, describe_waves, FL_FORCE_WAVES, wave_work, NULL},
    {"current", set_up_current, has_current, describe_current, FL_FORCE_NO_LEDGER, NULL, NULL},
    {"added mass", set_up_added_mass, has_added_mass, NULL, FL_FORCE_DRAG, flow_loss, NULL},
    {"water drag", set_up_water_drag, has_water, describe_water_drag, FL_FORCE_DRAG, water_drag_loss, NULL},
    {"wind", set_up_wind, has_wind, describe_wind, FL_FORCE_WIND, wind_work, NULL},
};
const int32_t fl_water_force_count = sizeof fl_water_forces / sizeof *fl_water_forces;
static_assert(sizeof fl_water_forces / sizeof *fl_water_forces <= FL_WATER_FORCES_MAX,
              "room in fl_environment");

int fl_environment_set_up(fl_environment *s, fl_bodies *b, const fl_scene *scene, int32_t n, int threads,
                          fl_err *err)
{
    if (!scene->water.head.present && !scene->wind.head.present) return 0;
    s->scene = scene;
    s->water = scene->water.head.present;
    s->wind = scene->wind.head.present;
    s->threads = threads;
    for (const fl_water_force *f = fl_water_forces; f < fl_water_forces + fl_water_force_count; f++) {
        if (f->set_up && f->set_up(s, b, scene, err)) return -1;
        if (f->impulse && f->present(s, b)) s->impulse[s->impulses++] = f;
    }
    return fl_environment_alloc(s, n, threads, err);
}

void fl_environment_add_energy(const fl_environment *s, const fl_bodies *b, int32_t i, int inside,
                               double column[FL_FORCE_LEDGERS])
{
    for (const fl_water_force *f = fl_water_forces; f < fl_water_forces + fl_water_force_count; f++)
        if (f->energy && f->present(s, b) && (inside || f->ledger != FL_FORCE_HYDROSTATIC))
            column[f->ledger] += f->energy(s, b, i);
}
