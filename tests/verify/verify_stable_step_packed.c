/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest stable step, and the automatic one, of bodies with contacts on all sides or with bonds;
 * verify_step has bodies with one or two contacts. */
#include <math.h>
#include <stdlib.h>
#include "base/pi.h"
#include "base/rng.h"
#include "sim/critical_step.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

/* Equal bodies, a number of them in each direction of a periodic cell, each overlapping the next by a
 * millimetre.  In a direction with one body nothing touches. */
typedef struct {
    const char *name;
    fl_vec3 half; /* half size of a box; 0: spheres of 0.1 m, each layer in the gaps of the layer before */
    int count[3];
    int lines;             /* number of lines along which contacts are replaced by bonds */
    double young, damping; /* E of the bonds [Pa], and of their damping */
} packing;

static const packing PACK = {"spheres with twelve neighbours", {0, 0, 0}, {5, 6, 3}, 0, 0.0, 0.0},
                     SHEET = {"spheres with six neighbours", {0, 0, 0}, {5, 6, 1}, 0, 0.0, 0.0},
                     CUBES = {"cubes", {0.2, 0.2, 0.2}, {4, 4, 4}, 0, 0.0, 0.0},
                     FLOES = {"square floes", {0.2, 0.2, 0.1}, {4, 4, 1}, 0, 0.0, 0.0},
                     SLABS = {"slabs in a stack", {0.5, 0.4, 0.2}, {1, 1, 7}, 0, 0.0, 0.0},
                     PILLARS = {"pillars in a row", {0.25, 0.25, 1.0}, {9, 1, 1}, 0, 0.0, 0.0};

enum { APART = 5 }; /* [m] cell where nothing repeats */

/* In close packing all pairs lie along six lines, three in a layer and three to the next one; pairs of
 * boxes along three.  Returns the line of a pair. */
static int line_of(const packing *h, fl_vec3 off, double d)
{
    if (h->half.x > 0.0) return fabs(off.x) > 0.5 * d ? 0 : fabs(off.y) > 0.5 * d ? 1 : 2;
    const int up = fabs(off.z) > 0.1 * d;
    const fl_vec3 one = v3_scale((up                ? off.z
                                  : off.y > 0.1 * d ? 1.0
                                                    : off.y + 0.1 * d) < 0.0
                                     ? -1.0
                                     : 1.0,
                                 off);
    const double turn = atan2(one.y, one.x) / PI;
    return up ? 3 + (int)(1.5 * (turn < 0.0 ? turn + 2.0 : turn)) : (int)lround(3.0 * fabs(turn)) % 3;
}

/* Bonds for the pairs along some of the lines, also across the border of the cell; the other pairs touch as
 * before. */
static void add_bonds(lab *l, const packing *h, double d)
{
    const fl_vec3 L = v3_sub(l->scene.boundary.max, l->scene.boundary.min);
    fl_err err = {0};
    lab_set(l, "run.safety=1");
    lab_set(l, "bond.on=true");
    lab_set(l, "bond.normal_strength=none");
    lab_set(l, "bond.shear_strength=none");
    lab_setf(l, "bond.young=%g", h->young);
    lab_setf(l, "bond.damping=%g", h->damping);
    for (int32_t i = 0; i < l->field.n; i++)
        for (int32_t j = i + 1; j < l->field.n; j++) {
            const fl_vec3 at = l->field.core[i].v[0];
            fl_vec3 off = v3_sub(l->field.core[j].v[0], at);
            off = v3(off.x - L.x * round(off.x / L.x), off.y - L.y * round(off.y / L.y),
                     off.z - L.z * round(off.z / L.z));
            if (v3_norm(off) > 1.001 * d || line_of(h, off, d) >= h->lines) continue;
            if (fl_ice_field_add_bond(&l->field, i, j, 0.25 * PI * d * d, d, v3_madd(at, 0.5, off), &err))
                exit(1);
        }
}

static void make_packing(lab *l, const packing *h, double friction, double e)
{
    const double s = 1e-3, r = 0.1, d = 2.0 * r - s;
    const int boxes = h->half.x > 0.0, *n = h->count;
    const fl_vec3 by =
        boxes ? v3_sub(v3_scale(2.0, h->half), v3(s, s, s)) : v3(d, d * sqrt(0.75), d * sqrt(2.0 / 3.0));
    lab_start(l);
    lab_setf(l, "contact.restitution=%g", e);
    lab_setf(l, "contact.friction=%g", friction);
    if (boxes) lab_set(l, "contact.stiffness=5e6");
    lab_set(l, "boundary.type=periodic");
    lab_set(l, "boundary.min=0 0 0");
    lab_setf(l, "boundary.max=%.17g %.17g %.17g", n[0] > 1 ? n[0] * by.x : APART,
             n[1] > 1 ? n[1] * by.y : APART, n[2] > 1 ? n[2] * by.z : APART);
    for (int k = 0; k < n[0] * n[1] * n[2]; k++) {
        const int x = k % n[0], y = k / n[0] % n[1], z = k / (n[0] * n[1]);
        const fl_vec3 at = v3((x + 0.25) * by.x, (y + 0.25) * by.y, (z + 0.25) * by.z);
        const double aside = 0.5 * (y % 2) + 0.5 * (z % 3), along = (z % 3) / 3.0;
        if (boxes) lab_box(l, at, h->half, 0.03, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        else lab_sphere(l, v3_add(at, v3(aside * d, along * by.y, 0)), r, v3(0, 0, 0), v3(0, 0, 0));
    }
    if (h->lines > 0) add_bonds(l, h, boxes ? by.x : d);
    lab_make(l, 1e-12);
}

/* The step that runs choose; for spheres it is predicted as if they had reached these overlaps. */
static double automatic_step(lab *l, const packing *h, int measured)
{
    fl_world *w = &l->w;
    int32_t body;
    if (h->half.x == 0.0) w->b.v[0].x = sqrt(0.8 * lab_evaluate_pair(w, 0, 1).k * pow(1e-3, 2.5) / w->b.m[0]);
    lab_set(l, measured ? "run.error=0.01" : "run.error=none");
    const double dt = fl_automatic_step(w, &body), share = dt / fl_critical_step(w) * fl_lateral_share(w);
    const fl_predicted_limit foreseen = fl_predict_step_limit(w);
    w->b.v[0].x = 0.0;
    if (!measured) return dt;
    return w->bonds.n ? fmin(dt, fl_longest_step(&foreseen, w->dt_critical)) : share * w->dt_critical;
}

/* True if perturbations of all bodies in all directions decay from the static state, without an approach
 * before. */
static int all_modes_decay(const packing *h, double friction, double e, double dt)
{
    const double push = 1e-9;
    double most = 0.0;
    lab l;
    make_packing(&l, h, friction, e);
    fl_world *w = &l.w;
    for (int32_t i = 0; i < w->n; i++) {
        fl_rng g = fl_rng_of(7, i, FL_RNG_TEST);
        w->b.v[i] = v3(push * fl_rng_normal(&g), push * fl_rng_normal(&g), push * fl_rng_normal(&g));
    }
    fl_step_set_size(w, dt, fl_world_time(w));
    for (int k = 0; k < 60 && most < 1e3 * push; k++) {
        if (lab_run(&l, 10)) exit(1);
        for (int32_t i = 0; i < w->n; i++) most = fmax(most, v3_norm(w->b.v[i]));
    }
    lab_free(&l);
    return most < 1e3 * push;
}

static void verify_packing(const char *id, const packing *h, double friction, double e)
{
    lab l;
    make_packing(&l, h, friction, e);
    const double taken = automatic_step(&l, h, 0), most = automatic_step(&l, h, 1);
    double lo = 0.2 * taken, hi = l.w.dt_critical;
    lab_free(&l);
    if (verify_quick()) { /* one step is tried where the full run looks for the largest */
        const double dt = fmax(taken, most);
        verify_true(id, "all modes decay at the automatic step", all_modes_decay(h, friction, e, dt));
        return;
    }
    while (hi > 1.02 * lo) {
        const double mid = sqrt(lo * hi);
        if (all_modes_decay(h, friction, e, mid)) lo = mid;
        else hi = mid;
    }
    verify_note("%s in contact, friction %g, e = %g: stable up to %.3g of the automatic step, "
                "%.3g of that with run.error",
                h->name, friction, e, lo / taken, lo / most);
    if (h->lines > 0)
        verify_note("  along %d lines bonded instead, by %g Pa with damping %g", h->lines, h->young,
                    h->damping);
    verify_below(id, "the automatic step over the largest that is stable", taken / lo, 1.0);
    verify_below(id, "that with run.error over the largest that is stable", most / lo, 1.0);
}

/* A part of the pairs of a packing of spheres, and of cubes, is bonded, from a sixth to five sixths.  The
 * bonds are softer than the contacts, as stiff, and stiffer. */
static void partly_bonded(const char *id, double e)
{
    static const int LINES[] = {1, 3, 5}, CUBIC[] = {1, 2, 2};
    static const double YOUNG[] = {1e6, 2e7, 1e9}, DAMPING[] = {0.0, 0.3};
    for (int s = 0; s < 3; s++)
        for (int y = 0; y < 3; y++)
            for (int d = 0; d < 2; d++) {
                if ((s + y + d) % 3) continue;
                packing pack = PACK, cubes = CUBES;
                pack.lines = LINES[s], cubes.lines = CUBIC[s];
                pack.young = cubes.young = YOUNG[y], pack.damping = cubes.damping = DAMPING[d];
                verify_packing(id, &pack, 0.5, e);
                verify_packing(id, &cubes, 0.5, e);
            }
}

/* A fully bonded packing takes the step of its bonds, independent of the damping of contacts that may form;
 * and never a step that the unbonded packing could not take. */
static void fully_bonded(const char *id, double e)
{
    static const double YOUNG[] = {1e4, 1e6, 1e8, 1e10};
    double rubble = 0.0, share = 0.0;
    for (int y = -1; y < 4; y++) {
        packing h = PACK;
        lab l;
        if (y >= 0) h.lines = 6, h.young = YOUNG[y];
        make_packing(&l, &h, 0.5, e);
        lab_set(&l, "run.safety=0.2");
        const double dt = automatic_step(&l, &h, 0);
        share = dt / fl_critical_step(&l.w);
        lab_free(&l);
        if (y < 0) {
            rubble = dt;
            continue;
        }
        verify_note("bonds of %g Pa, e = %g: the automatic step is %.3g of that of the never bonded "
                    "together",
                    h.young, e, dt / rubble);
        verify_below(id, "the step over that of the unbonded packing", dt / rubble, 1.0);
        if (y == 0) verify_below(id, "for soft bonds: not much shorter", rubble / dt, 1.01);
    }
    verify_below(id, "run.safety over the share that stiff bonds take", 0.2 / share, 1.01);
}

int main(void)
{
    verify_begin("the largest stable step of packings");
    static const double MANY[] = {0.0, 0.2, 0.3, 0.5};
    for (size_t k = 0; k < sizeof MANY / sizeof *MANY; k++) {
        if (verify_quick() && k % 2) continue;
        verify_packing("S20", &PACK, 0.5, MANY[k]);
        verify_packing("S20", &PACK, 0.0, MANY[k]);
        verify_packing("S21", &SHEET, 0.5, MANY[k]);
        verify_packing("S22", &CUBES, 0.5, MANY[k]);
        verify_packing("S23", &FLOES, 0.5, MANY[k]);
        verify_packing("S24", &SLABS, 0.5, MANY[k]);
        verify_packing("S24", &PILLARS, 0.5, MANY[k]);
    }
    static const double FROZEN[] = {0.0, 0.3, 1.0};
    for (size_t k = 0; k < sizeof FROZEN / sizeof *FROZEN; k++) {
        fully_bonded("S35", FROZEN[k]);
        if (!verify_quick() || k < 2) partly_bonded("S34", FROZEN[k]);
    }
    return verify_end();
}
