/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/energy_balance.h"
#include "sim/sudden_contact.h"
#include <math.h>
#include "base/parallel.h"
#include "body/integrate.h"
#include "contact/bond_list.h"
#include "sim/energy_ledger.h"
#include "sim/moving_structure.h"
#include "sphere/contact_list.h"
#include "water/force_table.h"
#include "world/access.h"

/* A residual up to this share of the stored energy may be rounding: sums over thousands of floes and steps,
 * each off by 1e-16. */
#define ROUNDING 1e-12

enum { MOVING = 1, WAVES = 2, BONDS = 4, YIELDING = 8, CRUSHING = 16, FRACTURE = 32, ZONES = 64, PUSH = 128 };

static const fl_column COLUMNS[] = {
    {"kinetic", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, kinetic)},
    {"gravity", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, gravity)},
    {"elastic", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, elastic)},
    {"hydrostatic", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, hydrostatic)},
    {"friction", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, friction_now)},
    {"damping", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, damping_now)},
    {"drag", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, drag)},
    {"wind", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, wind)},
    {"drive", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, drive_now)},
    {"carried", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, carried)},
    {"residual", "J", FL_COLUMN_REAL, 0, offsetof(fl_ledger, residual)},
    {"structure", "J", FL_COLUMN_REAL, MOVING, offsetof(fl_ledger, structure)},
    {"spring", "J", FL_COLUMN_REAL, MOVING, offsetof(fl_ledger, spring)},
    {"damper", "J", FL_COLUMN_REAL, MOVING, offsetof(fl_ledger, damper)},
    {"waves", "J", FL_COLUMN_REAL, WAVES, offsetof(fl_ledger, waves)},
    {"bond", "J", FL_COLUMN_REAL, BONDS, offsetof(fl_ledger, bond)},
    {"fracture", "J", FL_COLUMN_REAL, FRACTURE, offsetof(fl_ledger, fracture)},
    {"zones", "J", FL_COLUMN_REAL, ZONES, offsetof(fl_ledger, zones)},
    {"plastic", "J", FL_COLUMN_REAL, YIELDING, offsetof(fl_ledger, plastic)},
    {"crushing", "J", FL_COLUMN_REAL, CRUSHING, offsetof(fl_ledger, crushing)},
    {"push", "J", FL_COLUMN_REAL, PUSH, offsetof(fl_ledger, push)},
    {"push_impulse", "N.s", FL_COLUMN_REAL, PUSH, offsetof(fl_ledger, push_impulse)},
    {"push_way", "m", FL_COLUMN_REAL, PUSH, offsetof(fl_ledger, push_way)},
};
const fl_table_format fl_energy_table = {"energy", FL_TABLE_COLUMNS(COLUMNS)};

unsigned fl_energy_table_options(const fl_world *w)
{
    return (fl_structure_moves_freely(w) ? MOVING : 0u) | (w->sea.waves ? WAVES : 0u) |
           (fl_world_bonds(w) ? BONDS | FRACTURE : 0u) | (w->breaking.on ? FRACTURE : 0u) |
           (w->moving.members.dynamics.chain.yielding || w->zones.set.plastic ? YIELDING : 0u) |
           (w->zones.set.blocks ? ZONES : 0u) |
           (w->crushing.of != FL_CRUSHING_NONE || w->strips.wall ? CRUSHING : 0u) | (w->push.of ? PUSH : 0u);
}

double fl_energy_stored(const fl_world *w)
{
    const fl_ledger *g = &w->ledger;
    return fabs(g->kinetic) + fabs(g->gravity) + fabs(g->elastic) + fabs(g->hydrostatic) +
           fabs(g->structure) + fabs(g->spring) + fabs(g->bond) + fabs(g->zones);
}

double fl_energy_error(const fl_world *w)
{
    const double residual = fabs(w->ledger.residual), share = residual / w->ledger.throughput;
    return !(share <= FL_ENERGY_ERROR_USABLE) && residual <= ROUNDING * fl_energy_stored(w) ? 0.0 : share;
}

int fl_energy_unbalanced(const fl_world *w)
{
    const fl_ledger *g = &w->ledger;
    const double scale = g->throughput + fabs(g->elastic);
    return fl_energy_error(w) > FL_ENERGY_ERROR_USABLE && fabs(g->residual) > FL_ENERGY_ERROR_USABLE * scale;
}

/* No law is meant for overlaps above half of the radii.  The run continues as long as the energy balances:
 * bodies that overlap at the start separate in this way. */
int fl_energy_check(fl_world *w, fl_err *err)
{
    const fl_ledger *g = &w->ledger;
    fl_energy_update(w);
    const double scale = g->throughput + fabs(g->elastic);
    if (!isfinite(g->residual))
        return fl_fail(err, FL_NUMERIC, "the energy is not a finite number in step %lld (t = %g s)",
                       (long long)w->step, fl_world_time(w));
    if (!w->deep_overlap_steps || !(g->residual > FL_ENERGY_ERROR_USABLE * scale)) return 0;
    if (w->sudden.n) {
        char text[FL_SUDDEN_TEXT];
        return fl_fail(err, FL_NUMERIC, "%s; it created energy, %.3g J of %.3g J until step %lld (t = %g s)",
                       fl_sudden_contact_text(w, text), g->residual, scale, (long long)w->step,
                       fl_world_time(w));
    }
    return fl_fail(
        err, FL_NUMERIC,
        "body %d and %d: they overlapped by more than half of their radii at t = %g s, and the contacts "
        "create energy, %.3g J of %.3g J, in step %lld (t = %g s); set a smaller run.dt or stiffer contacts",
        w->deep_overlap_i, w->deep_overlap_j, w->deep_overlap_time, g->residual, scale, (long long)w->step,
        fl_world_time(w));
}

void fl_energy_update(fl_world *w)
{
    const fl_bodies *b = &w->b;
    fl_ledger *g = &w->ledger;
    double kinetic = 0.0, gravity = 0.0, elastic = 0.0, spring = 0.0, constraint = 0.0,
           water[FL_FORCE_LEDGERS] = {0.0};
    const fl_work ahead = fl_work_ahead(w);
    for (int32_t i = 0; i < w->n; i++) {
        const int present = !fl_body_absent(w, i);
        const int is_rigid = !w->zones.block_of || w->zones.block_of[i] < 0;
        if (present && is_rigid) kinetic += fl_body_kinetic_energy(b, i);
        if (present) gravity -= b->m[i] * v3_dot(w->gravity, b->x[i]);
        if (is_rigid) constraint += b->work_of_constraints[i];
        if (w->driven_floes.n && present) {
            double extension = 0.0;
            const double k = fl_driven_floe_spring(w, i, &extension);
            elastic += 0.5 * k * extension * extension;
        }
        if (w->sea.n) fl_environment_add_energy(&w->sea, b, i, present, water);
    }
    const double hydro = water[FL_FORCE_HYDROSTATIC], wind = water[FL_FORCE_WIND];
    double drag = water[FL_FORCE_DRAG], waves = water[FL_FORCE_WAVES];
    for (int32_t c = 0; c < w->n_touching; c++) {
        const fl_pair *p = w->pair[w->touching_pairs[c]].contact;
        elastic += p->energy;
        spring += p->spring_energy;
    }
    if (w->spheres.bodies) fl_contact_list_energy(w, &elastic, &spring);
    const fl_bond_energies bonds = fl_bond_list_energies(w);
    g->bond = bonds.store;
    g->fracture = bonds.dissipated + w->breaking.lost;
    spring += bonds.spring - bonds.transferred;
    double zone_damping = 0.0;
    if (w->zones.set.blocks) {
        const fl_zone_energies zones = fl_zone_set_energies(&w->zones.set);
        kinetic += zones.kinetic, g->zones = zones.stored, g->plastic = zones.plastic;
        constraint += w->zones.drive;
        zone_damping = w->zones.damping;
        for (int32_t k = 0; k < w->zones.joints.n; k++) zone_damping += w->zones.joints.joint[k].damped;
    }
    g->kinetic = kinetic;
    g->gravity = gravity;
    g->elastic = elastic;
    g->hydrostatic = hydro;
    g->damping_now = g->damping - ahead.damping + bonds.damped + zone_damping;
    g->friction_now = g->friction - ahead.friction - spring +
                      bonds.friction_loss; /* the friction springs can give it back */
    g->wind = wind;
    if (!w->zones.set.blocks) g->plastic = 0.0;
    if (fl_structure_moves(w)) {
        const fl_moving_energy r = fl_moving_structure_energy(w);
        g->structure = r.kinetic;
        g->spring = r.spring;
        g->damper = r.damper_work;
        g->plastic += r.plastic_work;
        constraint += r.drive_work;
        if (w->moving.movers.hulls.n) drag += r.drag, waves += r.waves;
    }
    g->drag = drag;
    g->waves = waves;
    const double drive = g->drive - ahead.drive + constraint;
    g->drive_now = drive;
    g->push = w->push.work, g->push_impulse = w->push.impulse, g->push_way = w->push.way;
    g->residual = kinetic + gravity + elastic + hydro + g->structure + g->spring + g->bond + g->zones +
                  g->fracture - g->start + g->damping_now + g->friction_now + drag + g->damper + g->plastic +
                  g->crushing - wind - waves - drive - g->carried;
    const double throughput = fabs(g->damping_now) + fabs(g->friction_now) + fabs(drag) + fabs(wind) +
                              fabs(waves) + fabs(drive) + kinetic + g->damper + g->plastic + g->crushing +
                              g->structure + fabs(g->fracture);
    if (throughput > g->throughput) g->throughput = throughput;
}

uint64_t fl_state_hash(const fl_world *w)
{
    const fl_bodies *b = &w->b;
    uint64_t h = FL_HASH_START;
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_body_absent(w, i)) continue;
        h = fl_hash(h, &b->x[i], sizeof b->x[i]);
        h = fl_hash(h, &b->q[i], sizeof b->q[i]);
        h = fl_hash(h, &b->v[i], sizeof b->v[i]);
        h = fl_hash(h, &b->L[i], sizeof b->L[i]);
    }
    for (int32_t k = 0; k < w->moving.movers.n; k++) {
        const fl_bodies *m = &w->moving.movers.b;
        if (!w->moving.movers.motion[k].free_dof) continue;
        h = fl_hash(h, &m->x[k], sizeof m->x[k]);
        h = fl_hash(h, &m->q[k], sizeof m->q[k]);
        h = fl_hash(h, &m->v[k], sizeof m->v[k]);
        h = fl_hash(h, &m->L[k], sizeof m->L[k]);
    }
    for (int32_t n = 0; n < w->zones.set.nodes; n++) {
        h = fl_hash(h, &w->zones.set.x[n], sizeof w->zones.set.x[n]);
        h = fl_hash(h, &w->zones.set.v[n], sizeof w->zones.set.v[n]);
    }
    const fl_member_chain *c = &w->moving.members.dynamics.chain;
    for (int32_t k = 0; k < c->balls; k++) {
        const fl_member_ball *a = &c->ball[k];
        h = fl_hash(h, &a->d, sizeof a->d);
        h = fl_hash(h, &a->q, sizeof a->q);
        h = fl_hash(h, &a->v, sizeof a->v);
        h = fl_hash(h, &a->w, sizeof a->w);
    }
    return h;
}
