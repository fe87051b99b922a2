/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plan_probe.h"
#include <inttypes.h>
#include "clocks.h"
#include "contact/pair_law.h"
#include "out/tables.h"
#include "sim/memory_use.h"
#include "sim/moving_structure.h"
#include "sim/neighbour_list.h"
#include "sim/step.h"
#include "sphere/contact_list.h"
#include "table_rows.h"
#include "warnings.h"

int print_probe(struct run *r, FILE *f, fl_err *err)
{
    r->w->skin = r->o->probe;
    if (fl_neighbour_list_update(r->w, err)) return -1;
    fl_table_write_header(f, &fl_contacts_table, 0, r->history, r->by, 0.0);
    write_near_pairs(r, f, r->o->probe);
    return 0;
}

static void print_stage(FILE *f, const char *name, int on, const char *what)
{
    fprintf(f, "  %-12s %-4s %s\n", name, on ? "yes" : "no", what);
}

/* Details of buoyancy, waves and current.  Bodies wholly above or under the water are not clipped. */
static void describe_water(const fl_world *w, char buoyancy[160], char waves[160], char current[160])
{
    static const char *const PROFILE[] = {"at all depths", "by a power of the depth", "linear in the depth",
                                          "by a table"};
    const fl_scene_water *s = &w->scene->water;
    int32_t dry = 0, under = 0;
    if (!w->sea.water) return;
    for (int32_t i = 0; i < w->n; i++) {
        const double whole = w->sea.specific_weight * w->sea.hull[i].volume;
        dry += w->sea.buoyancy[i] <= 0.0;
        under += whole > 0.0 && w->sea.buoyancy[i] >= whole * (1.0 - 1e-12);
    }
    snprintf(buoyancy, 160, "%d %s at the surface, %d wholly under it, %d dry", w->n - dry - under,
             w->sea.waves ? "integrated" : "clipped", under, dry);
    if (fl_current_max_speed(&w->sea.current) > 0.0)
        snprintf(current, 160, "%.3g m/s at most, %s", fl_current_max_speed(&w->sea.current),
                 PROFILE[s->profile]);
    if (!w->sea.waves) return;
    double breaking;
    const double steep = fl_wave_steepness(s->height, s->period, s->depth, w->sea.wave.gravity, &breaking);
    snprintf(waves, 160, "%s of %.3g m and %.3g s, %d train%s, %.3g m long, steepness %.3g%s",
             s->wave == FL_WAVE_AIRY ? "airy" : "jonswap", s->height, s->period, w->sea.wave.n,
             w->sea.wave.n == 1 ? "" : "s", s->height / steep, steep,
             steep > breaking ? ": they would break" : "");
}

/* Bodies at the start. */
struct bodies {
    int32_t present, spheres, capsules, fixed;
};

static struct bodies count_bodies(const fl_world *w)
{
    struct bodies n = {0};
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_body_absent(w, i)) continue;
        n.present++;
        n.spheres += w->b.core[i].nv == 1;
        n.capsules += w->b.core[i].nv == 2;
        n.fixed += w->b.fixed_dof[i] != 0;
    }
    return n;
}

static void print_bodies(const fl_world *w, FILE *f, const struct bodies *n)
{
    int32_t kind[4] = {0};
    for (int32_t k = 0; k < w->structure.n; k++) kind[w->structure.piece[k].kind]++;
    fprintf(f, "bodies         %d: %d polyhedra, %d spheres, %d capsules\n", n->present,
            n->present - n->spheres - n->capsules, n->spheres, n->capsules);
    fprintf(f, "structure      %d parts: %d solids and plates, %d cones, %d shells; %d walls\n", w->parts,
            kind[FL_PIECE_SOLID], kind[FL_PIECE_CONE], kind[FL_PIECE_MESH], w->walls);
    if (w->inflow.feed) fprintf(f, "capacity       %d more floes\n", w->n - n->present);
    fprintf(f, "near pairs     %d, next search after %.3g m\n", w->n_pair + fl_contact_list_size(w), w->skin);
    fprintf(f, "law            %s between like bodies\n", w->n ? fl_pair_law_of(w, 0, 0)->law->name : "none");
}

static const char *drag_law(int on, int law)
{
    return !on ? "" : law == FL_DRAG_FACET ? "by facets" : "of the whole";
}

static void print_stages(const fl_world *w, FILE *f, const struct bodies *n, const char *buoyancy,
                         const char *waves, const char *current)
{
    char bonds[160] = "";
    if (w->bonds.n)
        snprintf(bonds, sizeof bonds, "%d bonded faces, %d bonds per body", w->bonds.n,
                 (2 * w->bonds.n + n->present / 2) / n->present);
    fprintf(f, "stages\n");
    print_stage(f, "weight", v3_norm(w->gravity) > 0.0, "");
    print_stage(f, "contacts", 1, "");
    print_stage(f, "structure", w->pieces > 0, "");
    print_stage(f, "motion", w->moving.movers.n > 0,
                fl_structure_moves_freely(w) ? "of the structure, with free directions" : "");
    print_stage(f, "panels", w->panel_load.panels > 0, "");
    print_stage(f, "walls", w->walls > 0, "");
    print_stage(f, "cell", w->cell.periodic, "periodic");
    print_stage(f, "outflow", w->inflow.absent != NULL, "floes beyond a free bound are removed");
    print_stage(f, "inflow", w->inflow.feed != NULL, "");
    print_stage(f, "buoyancy", w->sea.water, buoyancy);
    print_stage(f, "waves", w->sea.waves, waves);
    print_stage(f, "current", w->sea.water && fl_current_max_speed(&w->sea.current) > 0.0, current);
    print_stage(f, "added mass", w->b.added_mass != NULL, "");
    print_stage(f, "water drag", w->sea.water, drag_law(w->sea.water, w->sea.water_drag_law));
    print_stage(f, "wind", w->sea.wind, drag_law(w->sea.wind, w->sea.wind_drag_law));
    print_stage(f, "bonds", w->bonds.n > 0, bonds);
    print_stage(f, "fixed", n->fixed > 0, "");
    print_stage(f, "sleep", w->sleep.state != NULL, "steps of inactive floes are skipped");
}

int print_plan(struct run *r, FILE *f, fl_err *err)
{
    fl_world *w = r->w;
    const struct bodies n = count_bodies(w);
    /* Some steps of this scene predict the time better than any table. */
    const double begun = wall_clock();
    double spent = 0.0;
    char buoyancy[160] = "", waves[160] = "", current[160] = "";
    const int bad = fl_step_start(w, err);
    if (!bad || err->code == FL_NUMERIC) warn_at_start(r); /* as before the run itself */
    if (bad) return -1;
    describe_water(w, buoyancy, waves, current);
    while (w->step < r->steps && (spent = wall_clock() - begun) < 0.5)
        if (fl_step(w, err)) return -1;
    print_bodies(w, f, &n);
    print_stages(w, f, &n, buoyancy, waves, current);
    fprintf(f, "step           %.4g s, %" PRId64 " steps; critical %.4g s by estimate\n", w->dt, r->steps,
            r->critical);
    fprintf(f, "set by         %s\n", r->step_by);
    if (r->budget)
        fprintf(f,
                "error budget   %g of the load: the step above is the largest allowed, and is adapted during "
                "the run\n",
                r->scene->run.error);
    const fl_memory_use bytes = fl_memory_use_of(w);
    fprintf(f, "memory         %.1f MiB, and %.1f more during a neighbour search\n",
            fl_memory_use_sum(&bytes) / 1048576.0, bytes.search_peak / 1048576.0);
    if (w->step)
        fprintf(f, "time           about %.0f s on %.3g threads, from its first %" PRId64 " steps\n",
                spent / (double)w->step * (double)r->steps, fl_thread_count_mean(&w->team), w->step);
    return 0;
}
