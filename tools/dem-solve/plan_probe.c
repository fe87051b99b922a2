/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plan_probe.h"
#include <inttypes.h>
#include "base/pi.h"
#include "clocks.h"
#include "contact/joint_list.h"
#include "contact/pair_law.h"
#include "ice_scene.h"
#include "out/tables.h"
#include "sim/breaking.h"
#include "sim/memory_use.h"
#include "sim/moving_structure.h"
#include "sim/neighbour_list.h"
#include "sim/step.h"
#include "sim/strip_setup.h"
#include "sphere/contact_list.h"
#include "step_choice.h"
#include "table_rows.h"
#include "warnings.h"
#include "water/force_table.h"

int print_probe(struct run *r, FILE *f, fl_err *err)
{
    r->w->skin = r->o->probe;
    if (fl_neighbour_list_update(r->w, err)) return -1;
    fl_table_write_header(f, &fl_contacts_table, 0, r->history, r->by, NULL, 0.0);
    write_near_pairs(r, f, r->o->probe);
    return 0;
}

static void print_stage(FILE *f, const char *name, int on, const char *what)
{
    fprintf(f, "  %-12s %-4s %s\n", name, on ? "yes" : "no", what);
}

/* Describes the forces of water and wind, with the bodies at their start. */
static void describe_forces(const fl_world *w, char text[][FL_FORCE_TEXT])
{
    for (int32_t k = 0; k < fl_water_force_count; k++) {
        const fl_water_force *f = &fl_water_forces[k];
        text[k][0] = '\0';
        if (f->describe && f->present(&w->sea, &w->b)) f->describe(&w->sea, text[k]);
    }
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
    fprintf(f, "law            %s between like bodies%s\n",
            w->n ? fl_pair_law_of(w, 0, 0)->law->name : "none",
            w->quick_shape ? "; patch stands in for quick on structures and walls, for capsules and spheres"
                           : "");
}

/* Room for floes that break, and how small they may be. */
static int print_fragments(const fl_world *w, FILE *f, fl_err *err)
{
    double given, borne;
    if (!w->breaking.on) return 0;
    if (fl_breaking_least_area(w, &given, &borne, err)) return -1;
    fprintf(
        f,
        "fragments      room for %d, of floes that break; down to %.3g m2, as %s; the step bears %.3g m2\n",
        w->breaking.room, given, given > borne ? "failure.fragment_min" : "the step bears no smaller ones",
        borne);
    return 0;
}

static void print_stages(const fl_world *w, FILE *f, const struct bodies *n, char water[][FL_FORCE_TEXT])
{
    char bonds[160] = "";
    if (fl_world_bonds(w))
        snprintf(bonds, sizeof bonds, "%d %s, %d bonds per body", fl_world_bonds(w),
                 w->discs.n ? "bonds" : "bonded faces",
                 (2 * fl_world_bonds(w) + n->present / 2) / n->present);
    fprintf(f, "stages\n");
    print_stage(f, "weight", v3_norm(w->gravity) > 0.0, "");
    print_stage(f, "contacts", 1, "");
    print_stage(f, "structure", w->pieces > 0, "");
    print_stage(f, "motion", fl_structure_moves(w),
                w->moving.movers.hulls.n       ? "of the structure, with free directions, by waves"
                : fl_structure_moves_freely(w) ? "of the structure, with free directions"
                                               : "");
    print_stage(f, "panels", w->panel_load.panels > 0, "");
    print_stage(f, "walls", w->walls > 0, "");
    print_stage(f, "cell", w->cell.periodic, "periodic");
    print_stage(f, "crushing", w->crushing.of != FL_CRUSHING_NONE,
                w->crushing.of == FL_CRUSHING_ALL ? "all contacts of ice" : "contacts with the structure");
    print_stage(f, "breaking", w->breaking.on, "");
    print_stage(f, "outflow", w->inflow.absent != NULL && w->inflow.leaves,
                "floes beyond a free bound are removed");
    print_stage(f, "inflow", w->inflow.feed != NULL, "");
    for (int32_t k = 0; k < fl_water_force_count; k++)
        print_stage(f, fl_water_forces[k].name, fl_water_forces[k].present(&w->sea, &w->b), water[k]);
    print_stage(f, "bonds", fl_world_bonds(w) > 0, bonds);
    print_stage(f, "fixed", n->fixed > 0, "");
    print_stage(f, "sleep", w->sleep.state != NULL, "steps of inactive floes are skipped");
}

/* Modes, and the speed of the ice below which each locks in. */
static void print_modes(const fl_world *w, FILE *f)
{
    const int32_t n = w->moving.movers.n ? fl_structure_modes(w) : 0;
    for (int32_t k = 0; k < n; k++) {
        int32_t mover;
        const fl_modal_dof *m = fl_structure_mode(w, k, &mover);
        const double speed = w->strips.wall ? fl_strips_lock_in_speed(w, k) : 0.0;
        fprintf(f, "mode           %s of %s: %.5g Hz, %.6g kg and %.4g N/m at the waterline, damping %.3g",
                m->name, fl_mover_name(w, mover), m->omega / (2.0 * PI), m->mass,
                m->mass * m->omega * m->omega, m->ratio);
        if (speed > 0.0 && isfinite(speed)) fprintf(f, "; locks in below about %.3g m/s", speed);
        putc('\n', f);
    }
}

/* Where joints are most of what gives the critical step: which, and their part of its omega^2. */
static void print_joints(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const int32_t i = r->step_body;
    int32_t k;
    char name[64];
    if (!fl_world_joints(w) || r->scene->run.dt > 0.0 || i < 0 || i >= w->n) return;
    const double part = 0.25 * r->critical * r->critical * fl_joint_list_omega2(w, i, &k);
    if (k < 0 || part < 0.5) return;
    fprintf(f, "joints         set the step: %.2g of the stiffness of %s, most of it by [joint %s]\n", part,
            body_name(w, i, name), r->scene->joint[fl_joint_of_bond(&w->bonds, k)->material].name);
}

/* Deformable blocks: number, the node that sets their step, and whether joints do. */
static void print_zones(const fl_world *w, FILE *f)
{
    const fl_zone_set *s = &w->zones.set;
    const int32_t n = w->zones.stiffest;
    if (!s->blocks) return;
    const double joints = 1.0 - fl_zone_own_stiffness(s, n) / s->stiffness[n];
    int32_t k = 0;
    while (k + 1 < s->blocks && n >= s->block[k].node_end) k++;
    fprintf(f, "zones          %d with %d nodes in %d blocks; critical %.4g s by a node of body %d", s->zones,
            s->nodes, s->blocks, w->zones.dt_critical, w->id[s->block[k].body]);
    if (joints > 0.5) fprintf(f, ", joints set it: %.2g of the stiffness there", joints);
    putc('\n', f);
}

int print_plan(struct run *r, FILE *f, fl_err *err)
{
    fl_world *w = r->w;
    const struct bodies n = count_bodies(w);
    /* Some steps of this scene predict the time better than any table. */
    const double begun = wall_clock();
    double spent = 0.0;
    char water[FL_WATER_FORCES_MAX][FL_FORCE_TEXT];
    const double chosen = w->dt;
    const int bad = fl_step_start(w, err);
    if (!bad && check_start(r, err)) return -1;
    if (!bad || err->code == FL_NUMERIC) { /* as before the run itself */
        struct ice_scene scene;
        if (ice_scene_make(&scene, r, err)) return -1;
        if (!r->o->quiet) ice_scene_report(&scene, r, stderr);
        ice_scene_warn_width(&scene, stderr);
        warn_at_start(r, stderr);
    }
    if (bad || update_chosen_step(r, chosen, err)) return -1;
    describe_forces(w, water);
    while (w->step < r->steps && (spent = wall_clock() - begun) < 0.5)
        if (fl_step(w, err)) return -1;
    print_bodies(w, f, &n);
    if (print_fragments(w, f, err)) return -1;
    fprintf(f, "device         %s\n", r->device);
    print_stages(w, f, &n, water);
    print_modes(w, f);
    fprintf(f, "step           %.4g s, %" PRId64 " steps; critical %.4g s by estimate\n", w->dt, r->steps,
            r->critical);
    fprintf(f, "set by         %s\n", r->step_by);
    print_joints(r, f);
    print_zones(w, f);
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
