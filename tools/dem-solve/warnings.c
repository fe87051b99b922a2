/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "warnings.h"
#include <inttypes.h>
#include <string.h>
#include "base/pi.h"
#include "contact/crushing.h"
#include "ice_scene.h"
#include "scene/scene.h"
#include "sim/energy_balance.h"
#include "sim/moving_structure.h"
#include "sim/sudden_contact.h"
#include "sphere/contact_list.h"
#include "structure/mesh_contact.h"

/* A hull is at rest if mass and centre differ by less than this from its displacement, relative to
 * displacement and size. */
#define AT_REST 1e-3

enum { START_FAULT = 400 };

const char *name_of_id(const struct run *r, int32_t id, char name[NAME_OF_ID])
{
    const int32_t part = -1 - id, wall = part - r->w->parts;
    if (id < 0 && wall >= 0 && wall < r->w->walls) fl_wall_name(r->w, wall, name);
    else if (id < 0 && r->surface && part < r->surface->n)
        snprintf(name, NAME_OF_ID, "part %.60s", r->surface->part[part].name);
    else snprintf(name, NAME_OF_ID, "%d", id);
    return name;
}

/* Bodies that overlap at the start are pushed apart, with loads that belong to no case.  A run may take
 * hours, so this is said before it.  Rounded edges cannot overlap by more than the sum of the radii.  The
 * number of pairs, of those with the structure, and a sentence about them. */
static int32_t find_overlaps(const struct run *r, int32_t *with_structure, char text[START_FAULT])
{
    const fl_world *w = r->w;
    int32_t found = 0, i = -1, j = -1;
    *with_structure = 0;
    char other[NAME_OF_ID];
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        if (!p->touching ||
            !(p->overlap > FL_DEEP_OVERLAP * p->radius_factor * (w->b.radius[p->i] + w->b.radius[p->j])))
            continue;
        if (!found++) i = p->i, j = p->j;
        *with_structure += p->j >= w->n && p->j < w->n + w->pieces;
    }
    if (!found) return 0;
    snprintf(text, START_FAULT, "%d %s at the start, first body %d and %s; they will be pushed apart", found,
             found == 1 ? "pair overlaps by more than half its radii"
                        : "pairs overlap by more than half their radii",
             w->id[i], name_of_id(r, fl_world_id(w, j), other));
    return found;
}

/* A sheet of bonded spheres that starts inside the structure by more than this share of a radius loses
 * spheres at once, and at speeds that belong to no case. */
#define SHEET_INSIDE 0.01

/* Buoyancy over weight of a sheet at the start; beyond these it jumps up or sinks. */
#define LEAST_LIFT 0.9
#define MOST_LIFT 1.1

/* Breaking lengths that the shorter side of a sheet should have. */
#define LENGTHS_OF_SHEET 4.0

static void warn_sheet_inside(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    double most = 0.0;
    int32_t found = 0, part = 0;
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        if (!p->touching || p->j < w->n || p->j >= w->n + w->pieces ||
            !(p->overlap > SHEET_INSIDE * w->b.radius[p->i]))
            continue;
        found++;
        if (p->overlap > most) most = p->overlap, part = p->j - w->n;
    }
    if (found)
        fprintf(
            f,
            "dem-solve: warning: %d bonded spheres start inside the structure, up to %.3g m in part %s, and "
            "will be thrown off: a sheet farther away is expected\n",
            found, most, r->surface->part[w->structure.piece[part].part].name);
}

/* Bonds that break need time to soften: the two sides part at the speed sigma_t/sqrt(E rho) of a crack that
 * opens, so the separation grows by (f - 1) sigma_t l/E in (f - 1) l sqrt(rho/E). */
static void warn_sudden_bonds(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const fl_disc_list *s = &w->discs;
    double least = INFINITY;
    for (int32_t k = 0; k < s->n; k++) {
        const fl_disc_class *c = &s->classes[s->at.which[k]];
        const double E = c->kn * c->length / (PI * c->radius * c->radius),
                     rho = w->scene->material[w->material[s->at.i[k]]].density;
        if (c->ductility > 1.0) least = fmin(least, (c->ductility - 1.0) * c->length * sqrt(rho / E));
    }
    if (least < w->dt)
        fprintf(
            f,
            "dem-solve: warning: bonds soften within %.2g of a step, as if they had no fracture energy: a "
            "run.dt of %.2g s follows it, or a larger bond.stretch or bond.energy is expected\n",
            least / w->dt, least);
}

/* Weight and buoyancy of a sheet, and its smaller side against the breaking length of a floating beam,
 * pi/4 (E h^3/(3 rho g))^(1/4); of a sheet without end its width. */
static void warn_bonded_sheet(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const double h = w->scene->ice.slab, E = w->discs.n ? w->law[0].round_young : 0.0;
    double weight = 0.0, lift = 0.0;
    fl_aabb box = aabb_empty();
    if (!w->discs.n) return;
    warn_sheet_inside(r, f);
    warn_sudden_bonds(r, f);
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_body_absent(w, i)) continue;
        weight += w->b.m[i] * v3_norm(w->gravity);
        if (w->sea.water) lift += w->sea.buoyancy[i];
        box = aabb_add(box, w->b.x[i]);
    }
    if (!w->sea.water || !(weight > 0.0)) return;
    if (!(lift >= LEAST_LIFT * weight && lift <= MOST_LIFT * weight))
        fprintf(f,
                "dem-solve: warning: the water bears %.3g of the weight of the spheres at the start: the "
                "sheet %s; the "
                "densities it was made with, or ice.slab, are expected\n",
                lift / weight, lift < weight ? "sinks" : "jumps up");
    const double x = box.hi.x - box.lo.x, y = box.hi.y - box.lo.y, across = w->inflow.axis ? x : y,
                 side = w->inflow.feed ? across : fmin(x, y),
                 length = 0.25 * PI * pow(E * h * h * h / (3.0 * w->sea.specific_weight), 0.25);
    if (h > 0.0 && side < LENGTHS_OF_SHEET * length)
        fprintf(f,
                "dem-solve: warning: the sheet is %.3g m wide, less than four breaking lengths of a floating "
                "beam, "
                "%.3g m each: cracks may run to its edges\n",
                side, length);
}

/* 1 if body i is inside piece k, a mesh, without touching it. */
static int is_inside(const fl_world *w, int32_t i, int32_t k)
{
    const fl_piece *piece = &w->structure.piece[k];
    const int32_t j = w->n + k;
    if (piece->kind != FL_PIECE_MESH || fl_body_absent(w, i)) return 0;
    if (!fl_mesh_contact_contains(piece, m3_tmul(fl_body_axes(&w->b, j), v3_sub(w->b.x[i], w->b.x[j]))))
        return 0;
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;)
        if (p->touching && p->i == i && p->j == j) return 0;
    return 1;
}

/* Bodies inside the structure stay there, and the loads do not show it.  Their number, and a sentence. */
static int32_t find_inside(const struct run *r, char text[START_FAULT])
{
    const fl_world *w = r->w;
    int32_t found = 0, body = -1, part = -1;
    for (int32_t k = 0; k < w->structure.n; k++)
        for (int32_t i = 0; i < w->n; i++) {
            if (!is_inside(w, i, k) || found++) continue;
            body = i;
            part = w->structure.piece[k].part;
        }
    if (!found) return 0;
    snprintf(text, START_FAULT,
             "%d %s inside the structure, first body %d in part %s; it feels the structure only where it "
             "reaches the surface",
             found, found == 1 ? "body is" : "bodies are", w->id[body], r->surface->part[part].name);
    return found;
}

/* Floes that a part of the structure goes through: no side of them bears a load.  Their number, and a
 * sentence. */
static int32_t find_around(const struct run *r, char text[START_FAULT])
{
    const fl_world *w = r->w;
    int32_t found = 0, body = -1, piece = -1;
    for (int32_t i = 0; i < w->n; i++) {
        const int32_t k = fl_body_absent(w, i) ? -1 : fl_crushing_pierced_by(w, i);
        if (k < 0 || found++) continue;
        body = i, piece = k;
    }
    if (!found) return 0;
    snprintf(text, START_FAULT,
             "part %s of the structure goes through %d %s, first body %d; no side of %s would bear a load",
             r->surface->part[w->structure.piece[piece].part].name, found, found == 1 ? "floe" : "floes",
             w->id[body], found == 1 ? "it" : "them");
    return found;
}

int check_start(const struct run *r, fl_err *err)
{
    static const char WAY_OUT[] = "--force runs it as it is";
    char text[START_FAULT];
    int32_t swallowed, inside = 0;
    if (r->o->force || !r->w->sea.water || strncmp(r->scene->ice.material, "ice", 3) != 0) return 0;
    const int32_t overlaps = find_overlaps(r, &swallowed, text);
    if (!overlaps) inside = find_inside(r, text);
    if (swallowed + inside > r->w->n / 2)
        return fl_fail(err, FL_INPUT,
                       "%s: is the structure in mm? Metres are expected (struct-import --unit mm); %s", text,
                       WAY_OUT);
    const int32_t around = overlaps || inside ? 0 : find_around(r, text);
    if (overlaps || inside || around)
        return fl_fail(err, FL_INPUT,
                       "%s: a field with gaps there is expected (voronoi-ice --keep-out, --probe 0); %s",
                       text, WAY_OUT);
    return 0;
}

static void warn_faults(const struct run *r, FILE *f)
{
    char text[START_FAULT];
    int32_t with_structure;
    if (find_overlaps(r, &with_structure, text)) fprintf(f, "dem-solve: warning: %s\n", text);
    if (find_inside(r, text)) fprintf(f, "dem-solve: warning: %s\n", text);
    if (find_around(r, text)) fprintf(f, "dem-solve: warning: %s\n", text);
}

/* A flat sheet with an outline that is not convex is a surface with an inside, like a hull. */
static void warn_sheets(const struct run *r, FILE *f)
{
    const fl_structure *s = &r->w->structure;
    for (int32_t k = 0; k < s->n; k++)
        if (s->piece[k].one_sided)
            fprintf(f,
                    "dem-solve: warning: part %s is a flat sheet whose outline is not convex: bodies feel it "
                    "only on the side of its normals\n",
                    r->surface->part[s->piece[k].part].name);
}

/* Parts that touch and yet are contacts of their own bear twice where they meet. */
static void warn_unjoined(const struct run *r, FILE *f)
{
    const fl_structure *s = &r->w->structure;
    if (s->unjoined)
        fprintf(f,
                "dem-solve: warning: %d group%s of pieces that touch not joined to one surface, the last "
                "that of part %s: where they meet, bodies feel each of them\n",
                s->unjoined, s->unjoined == 1 ? "" : "s", r->surface->part[s->unjoined_part].name);
}

/* A hull that does not float in its pose: its motion is one about that pose. */
static void warn_hulls(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    for (int32_t k = 0; k < w->moving.movers.n; k++) {
        const fl_hydrostatics *h = &w->moving.hydrostatics[k];
        const fl_rigid_motion *m = &w->moving.movers.motion[k];
        const double water = w->scene->water.density * h->volume, size = cbrt(h->volume);
        const char *name = fl_mover_name(w, k);
        if (h->volume == 0.0) continue;
        if (m->mass > 0.0 && fabs(m->mass - water) > AT_REST * water)
            fprintf(f,
                    "dem-solve: warning: %s has %.6g kg and displaces %.6g kg of water: at rest it would lie "
                    "%.3g m %s\n",
                    name, m->mass, water, fabs(m->mass - water) / (w->scene->water.density * h->area),
                    m->mass < water ? "higher" : "deeper");
        if (hypot(h->buoyancy_centre.x, h->buoyancy_centre.y) > AT_REST * size)
            fprintf(
                f,
                "dem-solve: warning: the buoyancy of %s acts %.3g m in x and %.3g m in y from its reference "
                "point: at rest it would lean\n",
                name, fabs(h->buoyancy_centre.x) > 1e-9 * size ? h->buoyancy_centre.x : 0.0,
                fabs(h->buoyancy_centre.y) > 1e-9 * size ? h->buoyancy_centre.y : 0.0);
        const double C44 = m->K[3][3] + m->water_K[3][3], C55 = m->K[4][4] + m->water_K[4][4];
        if ((m->free_dof & FL_DOF_RX && C44 <= 0.0) || (m->free_dof & FL_DOF_RY && C55 <= 0.0))
            fprintf(f, "dem-solve: warning: %s capsizes: C44 is %.3g N.m and C55 %.3g N.m\n", name, C44, C55);
    }
}

/* Ice that may excite vibrations, and a structure that does not show them. */
static void warn_vibration(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const int32_t n = w->moving.movers.n ? fl_structure_modes(w) : 0;
    const double every = r->scene->output.loads_every;
    double highest = 0.0;
    if (w->strips.wall && !fl_structure_moves_freely(w))
        fprintf(f, "dem-solve: warning: the structure is fixed: with crushing_law = rate nothing vibrates; "
                   "[mode NAME] or structure.modes lets it\n");
    for (int32_t k = 0; k < n; k++) {
        const fl_modal_dof *m = fl_structure_mode(w, k, NULL);
        highest = fmax(highest, m->omega / (2.0 * PI));
        if (m->ratio == 0.0)
            fprintf(f, "dem-solve: warning: mode %s has no damping: it goes on vibrating\n", m->name);
    }
    if (every * highest > 0.1 * (1.0 + 1e-9))
        fprintf(f,
                "dem-solve: warning: output.loads_every is %g s, longer than a tenth of the period of the "
                "mode of "
                "%.4g Hz: its motion is not resolved\n",
                every, highest);
}

/* A wave that would break is not linear. */
static void warn_waves(const struct run *r, FILE *f)
{
    const fl_scene_water *s = &r->scene->water;
    double breaking;
    if (!r->w->sea.waves) return;
    const double steep = fl_wave_steepness(s->height, s->period, s->depth, r->w->sea.wave.gravity, &breaking);
    if (steep > breaking)
        fprintf(
            f,
            "dem-solve: warning: waves of height over length %.3g, but waves break above %.3g: no such sea "
            "exists\n",
            steep, breaking);
    if (!r->w->sea.by_blocks) return;
    const double shortest = 2.0 * PI / r->w->sea.wave.max_k;
    double least = INFINITY;
    for (int32_t i = 0; i < r->w->n; i++) least = fmin(least, r->w->b.radius[i]);
    if (shortest < 2.0 * least)
        fprintf(
            f,
            "dem-solve: warning: the shortest waves are %.3g m, less than twice the dilation radius of the "
            "smallest floe, %.3g m: its corners are rounder than they are\n",
            shortest, least);
}

/* A material of the scene file itself that nothing uses is likely misspelt.  Included files may have more
 * materials than needed, and floes that come in later may use any. */
static void warn_materials(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const fl_scene *s = r->scene;
    for (int32_t k = 0; k < s->n_material && !w->inflow.feed; k++) {
        const fl_scene_material *m = &s->material[k];
        const fl_scene_mark *at = &m->head.heading;
        int used = strcmp(m->name, "ice") == 0 || strcmp(m->name, "steel") == 0 || at->file > 0 ||
                   (s->structure.head.present && strcmp(m->name, s->structure.material) == 0);
        for (int32_t i = 0; i < w->n && !used; i++) used = w->material[i] == k;
        if (used) continue;
        fprintf(f, "dem-solve: warning: ");
        if (at->file >= 0 && at->line) fprintf(f, "%s:%d: ", s->file[at->file], at->line);
        fprintf(f, "no body and no structure is of [material %s]\n", m->name);
    }
}

void warn_at_start(const struct run *r, FILE *f)
{
    fl_scene_warn_implausible(r->scene, &r->floes, "dem-solve: warning: ", f);
    warn_materials(r, f);
    warn_faults(r, f);
    warn_bonded_sheet(r, f);
    warn_waves(r, f);
    warn_hulls(r, f);
    warn_vibration(r, f);
    warn_sheets(r, f);
    warn_unjoined(r, f);
}

/* Two bodies that move by less than their thickness in a step cannot pass each other. */
void warn_at_row(struct run *r, double t)
{
    const fl_world *w = r->w;
    for (int32_t i = 0; i < w->n && !r->warned_fast; i++) {
        const double distance = w->dt * v3_norm(w->b.v[i]);
        if (!(distance > 2.0 * w->b.radius[i]) || fl_body_absent(w, i)) continue;
        const double thickness = body_thickness(&w->b.core[i], w->b.radius[i]);
        if (!(distance > thickness) || isinf(distance)) continue;
        r->warned_fast = 1;
        fprintf(
            stderr,
            "dem-solve: warning: body %d moves by %.3g m in a step at t = %.6g s and is %.3g m thick: it may "
            "pass through thin bodies; use a shorter run.dt\n",
            w->id[i], distance, t, thickness);
    }
}

static void warn_sudden(const fl_world *w, FILE *f)
{
    char text[FL_SUDDEN_TEXT];
    if (!w->sudden.n) return;
    fprintf(f, "dem-solve: warning: %" PRId64 " %s deeper than the bodies moved, first: %s\n", w->sudden.n,
            w->sudden.n == 1 ? "contact begins" : "contacts begin", fl_sudden_contact_text(w, text));
}

/* Overlap of an impact of given energy against the factor s of the stiffness: with W = s c d^p, d goes with
 * s^(-1/p).  1/p = 0.446 for a floe that meets a leg, from runs with s from 0.02 to 1. */
#define OVERLAP_POWER 0.446

/* The deepest overlap that the radii allow without a warning, and one to aim at. */
#define OVERLAP_TO_AIM_AT 0.4

/* What made the first deep overlap. */
enum overlap_cause { OF_START, OF_SUDDEN_CONTACT, OF_SOFT_CONTACT };

static enum overlap_cause cause_of_overlap(const fl_world *w)
{
    const fl_sudden_contacts *s = &w->sudden;
    if (w->deep_overlap_time <= 1.5 * w->dt) return OF_START;
    if (s->n && fl_world_id(w, s->i) == w->deep_overlap_i && fl_world_id(w, s->j) == w->deep_overlap_j &&
        fabs(s->time - w->deep_overlap_time) <= 1.5 * w->dt)
        return OF_SUDDEN_CONTACT;
    return OF_SOFT_CONTACT;
}

/* What to change where contacts are too soft. */
static void advise_stiffness(const fl_world *w, FILE *f)
{
    const int32_t ice = fl_scene_find_material(w->scene, w->scene->ice.material);
    const int32_t other = w->deep_overlap_j < 0 ? FL_SCENE_STRUCTURE : ice;
    const fl_scene_contact c =
        fl_scene_pair(w->scene, ice < 0 ? 0 : ice, other < 0 ? FL_SCENE_STRUCTURE : other);
    const double more = pow(w->max_overlap / OVERLAP_TO_AIM_AT, 1.0 / OVERLAP_POWER);
    if (c.stiffness > 0.0)
        fprintf(f,
                "contacts are too soft for these speeds: contact.stiffness %.3g times as large is expected",
                more);
    else if (more * c.stiffness_factor <= 1.0)
        fprintf(
            f,
            "contacts are too soft for these speeds: contact.stiffness_factor of %.2g instead of %.3g is "
            "expected, or a larger dilation radius; impulses and means of open drift do not depend on it, "
            "peaks do",
            more * c.stiffness_factor, c.stiffness_factor);
    else
        fputs(
            "contacts are too soft for these speeds, with any contact.stiffness_factor up to 1: stiffer ice "
            "(material.ice.young), a larger dilation radius (voronoi-ice --radius) or slower ice is expected",
            f);
}

static void warn_overlapped(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    char other[NAME_OF_ID];
    if (!w->deep_overlap_steps) return;
    fprintf(f,
            "dem-solve: warning: overlaps past half the radii in %" PRId64
            " step%s, up to %.3g of them, first of body %d and %s at t = %.6g s: ",
            w->deep_overlap_steps, w->deep_overlap_steps == 1 ? "" : "s", w->max_overlap, w->deep_overlap_i,
            name_of_id(r, w->deep_overlap_j, other), w->deep_overlap_time);
    switch (cause_of_overlap(w)) {
    case OF_START: fputs("they overlapped at the start; move them apart, see --probe 0", f); break;
    case OF_SUDDEN_CONTACT:
        fputs("the contact began that deep, which no stiffness changes: see the warning before this one", f);
        break;
    case OF_SOFT_CONTACT: advise_stiffness(w, f); break;
    }
    fprintf(f, "%s\n", w->max_overlap >= 1.0 ? "; bodies may have gone through each other" : "");
}

static void warn_energy(const fl_world *w, FILE *f)
{
    if (!fl_energy_unbalanced(w)) return;
    fprintf(f,
            "dem-solve: warning: the energy residual is %.2g of the throughput (%.3g J of %.3g J); above %g "
            "the loads should not be used: use a shorter step or another contact.law\n",
            fl_energy_error(w), w->ledger.residual, w->ledger.throughput, FL_ENERGY_ERROR_USABLE);
}

/* The goal of run.error is not reached; a shorter step need not help. */
static void warn_budget(const struct run *r, FILE *f)
{
    double difference;
    const fl_error_budget *g = r->budget;
    const double error = fl_error_budget_run_error(g, &difference),
                 windows = fl_error_budget_estimate(g, r->w->dt);
    if (!isfinite(windows))
        fprintf(
            f,
            "dem-solve: warning: run.error: windows fail with every step that was tried, and the error of "
            "the "
            "loads is unknown: use another contact.law, stiffer contacts, or bodies that do not overlap at "
            "the start\n");
    else if (windows > FL_COMPANION_TOLERANCE * g->goal)
        fprintf(f,
                "dem-solve: warning: run.error: the goal is %.2g, and the error of windows is about %.2g "
                "with every "
                "step that was tried: states diverge within a window; shorter rows (output.loads_every) make "
                "shorter windows\n",
                g->goal, windows);
    if (g->companion.exceeded_since < 0.0) return;
    fprintf(
        f,
        "dem-solve: warning: run.error: the goal is %.2g, and the error of the whole load is about %.2g from "
        "t = %.4g s on: impacts amplify the error of any step, so the goal holds between two impacts only; "
        "use the mean load of several runs\n",
        g->goal, error, g->companion.exceeded_since);
}

/* 1 if gravity g has accelerated body i over its own size, away from everything. */
static int is_falling(const fl_world *w, int32_t i, double g)
{
    const fl_bodies *b = &w->b;
    const fl_vec3 down = v3_scale(1.0 / g, w->gravity);
    const double speed = v3_dot(b->v[i], down);
    if (fl_body_absent(w, i) || !(speed > sqrt(2.0 * g * (b->bounding_radius[i] + b->radius[i])))) return 0;
    for (int32_t k = w->n; k < w->n + w->pieces; k++)
        if (v3_dot(v3_sub(b->x[i], b->x[k]), down) <=
            b->bounding_radius[i] + b->bounding_radius[k] + b->radius[i])
            return 0;
    for (int32_t k = w->pieces; k < w->structure.n; k++) /* a wall below it */
        if (v3_dot(q_rotate(w->structure.piece[k].q, v3(0, 0, 1)), down) < -0.1) return 0;
    return 1;
}

/* Without water floes fall for the whole run, and the loads are worthless. */
static void warn_fallen(const fl_world *w, FILE *f)
{
    const double g = v3_norm(w->gravity);
    int32_t n_falling = 0, first = 0;
    if (w->sea.water || w->cell.periodic || !(g > 0.0)) return;
    for (int32_t i = w->n - 1; i >= 0; i--)
        if (is_falling(w, i, g)) n_falling++, first = w->id[i];
    if (n_falling)
        fprintf(f,
                "dem-solve: warning: %d of %d bodies fall at the end with nothing below them, first body %d: "
                "is a "
                "section [water], a wall of [boundary] or gravity = 0 missing?\n",
                n_falling, w->n, first);
}

void warn_at_end(const struct run *r, int failed, FILE *f)
{
    if (!failed) warn_fallen(r->w, f);
    ice_scene_warn_inflow(r, f);
    warn_sudden(r->w, f);
    warn_overlapped(r, f);
    if (!failed && r->budget) warn_budget(r, f);
    if (!failed) warn_energy(r->w, f); /* else the failure is reported */
}
