/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include "base/array.h"
#include "out/tables.h"
#include "run.h"
#include "sphere/contact_list.h"
#include "sim/memory_use.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "sim/moving_structure.h"
#include "sim/neighbour_list.h"
#include "contact/pair_geometry.h"
#include "sim/step.h"

int look_probe(struct run *r, FILE *f, fl_err *err)
{
    fl_world *w = r->w;
    w->skin = r->o->probe;
    if (fl_neighbour_list_update(w, err)) return -1;
    fl_contacts_header(f, r->history, r->by);
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        fl_contact k;
        if (!fl_pair_probe(w, p, r->o->probe, &k)) continue;
        fl_contacts_row(f, 0.0, w->id[p->i], fl_world_id(w, p->j), &k, 0.0, v3(0, 0, 0));
    }
    return 0;
}

static void stage(FILE *f, const char *name, int on, const char *what)
{
    fprintf(f, "  %-12s %-4s %s\n", name, on ? "yes" : "no", what);
}

/* How the bodies stand in the water at the start: what is wholly out of it or under is not clipped. */
static void sea_stages(const fl_world *w, char what[3][160])
{
    static const char *const PROFILE[] = {"at all depths", "by a power of the depth", "linear in the depth",
                                          "by a table"};
    const fl_scene_water *s = &w->scene->water;
    int32_t dry = 0, under = 0;
    what[0][0] = what[1][0] = what[2][0] = '\0';
    if (!w->sea.water) return;
    for (int32_t i = 0; i < w->n; i++) {
        const double whole = w->sea.specific_weight * w->sea.hull[i].volume;
        dry += w->sea.buoyancy[i] <= 0.0;
        under += whole > 0.0 && w->sea.buoyancy[i] >= whole * (1.0 - 1e-12);
    }
    snprintf(what[0], sizeof what[0], "%d %s at the surface, %d wholly under it, %d dry", w->n - dry - under,
             w->sea.waves ? "integrated" : "clipped", under, dry);
    if (fl_current_max_speed(&w->sea.current) > 0.0)
        snprintf(what[2], sizeof what[2], "%.3g m/s at most, %s", fl_current_max_speed(&w->sea.current),
                 PROFILE[s->profile]);
    if (!w->sea.waves) return;
    double breaking;
    const double steep = fl_wave_steepness(s->height, s->period, s->depth, w->sea.wave.gravity, &breaking);
    snprintf(what[1], sizeof what[1], "%s of %.3g m and %.3g s, %d train%s, %.3g m long, steepness %.3g%s",
             s->wave == FL_WAVE_AIRY ? "airy" : "jonswap", s->height, s->period, w->sea.wave.n,
             w->sea.wave.n == 1 ? "" : "s", s->height / steep, steep,
             steep > breaking ? ": they would break" : "");
}

int look_plan(struct run *r, FILE *f, fl_err *err)
{
    fl_world *w = r->w;
    int32_t there = 0, spheres = 0, capsules = 0, held = 0, kind[4] = {0};
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_body_absent(w, i)) continue;
        there++;
        spheres += w->b.core[i].nv == 1;
        capsules += w->b.core[i].nv == 2;
        held += w->b.fixed_dof[i] != 0;
    }
    for (int32_t k = 0; k < w->structure.n; k++) kind[w->structure.piece[k].kind]++;
    /* Steps of this very scene tell the time better than any table. */
    const double begun = run_clock();
    double spent = 0.0;
    char what[4][160] = {{0}};
    if (w->bonds.n)
        snprintf(what[3], sizeof what[3], "%d faces frozen together, %d bonds a body", w->bonds.n,
                 (2 * w->bonds.n + there / 2) / there);
    const int bad = fl_step_start(w, err);
    if (!bad || err->code == FL_NUMERIC) warn_at_start(r); /* as before the run itself */
    if (bad) return -1;
    sea_stages(w, what);
    while (w->step < r->steps && (spent = run_clock() - begun) < 0.5)
        if (fl_step(w, err)) return -1;
    fprintf(f, "bodies         %d: %d polyhedra, %d spheres, %d capsules\n", there,
            there - spheres - capsules, spheres, capsules);
    fprintf(f, "structure      %d parts: %d solids and plates, %d cones, %d shells; %d walls\n", w->parts,
            kind[FL_PIECE_SOLID], kind[FL_PIECE_CONE], kind[FL_PIECE_MESH], w->walls);
    if (w->inflow.feed) fprintf(f, "room           for %d more\n", w->n - there);
    fprintf(f, "near pairs     %d, search again after %.3g m\n", w->n_pair + fl_contact_list_size(w),
            w->skin);
    fprintf(f, "law            %s between like bodies\n", w->n ? fl_pair_law_of(w, 0, 0)->law->name : "none");
    fprintf(f, "stages\n");
    stage(f, "weight", v3_norm(w->gravity) > 0.0, "");
    stage(f, "contacts", 1, "");
    stage(f, "structure", w->pieces > 0, "");
    stage(f, "moves", w->moving.movers.n > 0,
          fl_structure_moves_freely(w) ? "by itself, in its free directions" : "");
    stage(f, "panels", w->panel_load.panels > 0, "");
    stage(f, "walls", w->walls > 0, "");
    stage(f, "cell", w->cell.periodic, "space repeats itself");
    stage(f, "outflow", w->inflow.absent != NULL, "floes beyond a free bound are taken out");
    stage(f, "inflow", w->inflow.feed != NULL, "");
    stage(f, "buoyancy", w->sea.water, what[0]);
    stage(f, "waves", w->sea.waves, what[1]);
    stage(f, "current", w->sea.water && fl_current_max_speed(&w->sea.current) > 0.0, what[2]);
    stage(f, "added mass", w->b.added_mass != NULL, "");
    stage(f, "water drag", w->sea.water,
          !w->sea.water                            ? ""
          : w->sea.water_drag_law == FL_DRAG_FACET ? "by facets"
                                                   : "of the whole");
    stage(f, "wind", w->sea.wind,
          !w->sea.wind                            ? ""
          : w->sea.wind_drag_law == FL_DRAG_FACET ? "by facets"
                                                  : "of the whole");
    stage(f, "bonds", w->bonds.n > 0, what[3]);
    stage(f, "holds", held > 0, "");
    stage(f, "sleep", w->sleep.state != NULL, "floes to which nothing happens take many steps at once");
    fprintf(f, "step           %.4g s, %" PRId64 " steps; critical %.4g s by estimate", w->dt, r->steps,
            r->limit);
    fprintf(f, "\nset by         %s", r->step_by);
    if (r->budget)
        fprintf(f,
                "\nerror budget   %g of the load: the step is the largest there may be, and is chosen as the "
                "run goes",
                r->scene->run.error);
    const fl_memory_use bytes = fl_memory_use_of(w);
    fprintf(f, "\nmemory         %.1f MiB, and %.1f more while neighbours are searched\n",
            fl_memory_use_sum(&bytes) / 1048576.0, bytes.search_peak / 1048576.0);
    if (w->step)
        fprintf(f, "time           about %.0f s on %.3g threads, from %" PRId64 " steps of it\n",
                spent / (double)w->step * (double)r->steps, fl_thread_count_mean(&w->team), w->step);
    return 0;
}
