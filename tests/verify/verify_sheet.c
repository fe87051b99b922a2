/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bonds between spheres and sheets of them: beams as V61 to V66 have them for faces, a strip that is lifted
 * at speed, a floating slab, the books of a sheet that breaks on a cone, a floating beam, a block (BS1 to
 * BS8; V68, V69; V67 is reported). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "body/integrate.h"
#include "contact/bond_list.h"
#include "ice/sphere_packing.h"
#include "sim/energy_balance.h"
#include "support/scenes.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

static const fl_vec3 ZERO = {0, 0, 0};

#define E 1e9
#define NU 0.3
#define RHO 900.0
#define R 0.05 /* radius of the spheres and discs of a chain */
#define D (2.0 * R)
#define AREA (PI * R * R)
#define INERTIA (0.25 * PI * R * R * R * R)
#define MASS (RHO * 4.0 / 3.0 * PI * R * R * R)

/* n spheres in a row along x, bonded: a beam of discs. */
static void make_chain(lab *l, int32_t n)
{
    fl_err err = {0};
    for (int32_t k = 0; k < n; k++) lab_sphere(l, v3(k * D, 0, 0), R, ZERO, ZERO);
    for (int32_t k = 0; k + 1 < n; k++)
        if (fl_ice_field_add_bond(&l->field, k, k + 1, AREA, D, v3((k + 0.5) * D, 0, 0), &err)) exit(1);
}

static void start_world(lab *l)
{
    lab_start(l);
    lab_set(l, "material.ice.young=1 GPa");
    lab_set(l, "material.ice.poisson=0.3");
    lab_set(l, "material.ice.density=900");
    lab_set(l, "bond.on=true");
}

static void hold(lab *l, int32_t i, unsigned fixed, fl_vec3 v)
{
    l->w.b.fixed_dof[i] = (uint8_t)fixed;
    l->w.b.v[i] = v;
}

enum { ALL = FL_DOF_X | FL_DOF_Y | FL_DOF_Z | FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ };

static void must_run(lab *l, int64_t steps)
{
    if (lab_run(l, steps)) exit(1);
}

static void unlimited(lab *l)
{
    lab_set(l, "bond.normal_strength=none");
    lab_set(l, "bond.shear_strength=none");
}

/* A chain clamped at one end whose other end moves slowly: force over deflection.  n - 1 discs of the length
 * D are rotation springs in their middles:
 *     w/P = sum (x_k)^2 l/(E I) + (n - 1) l/(G A),   x_k: distance of disc k from the end. */
static void cantilever(void)
{
    const int32_t n = 9;
    const double G = 0.5 * E / (1.0 + NU), w = 1e-4;
    double expected = 0.0;
    lab l;
    start_world(&l);
    unlimited(&l);
    lab_set(&l, "bond.damping=0.3");
    make_chain(&l, n);
    lab_make(&l, 0);
    fl_step_set_size(&l.w, 2.0 * l.w.dt, 0.0);
    hold(&l, 0, ALL, ZERO);
    const double time = 0.2;
    const int64_t steps = (int64_t)(time / l.w.dt);
    hold(&l, n - 1, FL_DOF_Z, v3(0, 0, w / ((double)steps * l.w.dt)));
    must_run(&l, steps);
    hold(&l, n - 1, FL_DOF_Z, ZERO);
    for (int k = 0; k < 400; k++) { /* the rest of the oscillation */
        must_run(&l, steps / 400);
        for (int32_t i = 1; i < n; i++)
            l.w.b.v[i] = v3_scale(0.8, l.w.b.v[i]), l.w.b.L[i] = v3_scale(0.8, l.w.b.L[i]);
    }
    for (int32_t k = 0; k + 1 < n; k++)
        expected += pow((n - 1.5 - k) * D, 2) * D / (E * INERTIA) + D / (G * AREA);
    verify_row("BS1", "cantilever of 8 discs, deflection over load [m/N]",
               l.w.b.x[n - 1].z / -l.w.b.f[n - 1].z, expected, 1e-3, VERIFY_REL);
    lab_free(&l);
}

/* First bending frequency of a chain that is free at both ends, (4.730)^2/(2 pi) sqrt(E I/(m l^4)), m =
 * MASS/D. Shear and rotary inertia lower it by (4.73)^2 (r/l)^2 (1 + E/G)/2 or so: below 0.6 % for 40
 * spheres. */
static void frequency(void)
{
    const int32_t n = 40;
    const double length = n * D, expected = 4.730041 * 4.730041 / (2.0 * PI) *
                                            sqrt(E * INERTIA * D / (MASS * pow(length, 4)));
    double last = 0.0, first = 0.0;
    int crossings = 0;
    lab l;
    start_world(&l);
    unlimited(&l);
    make_chain(&l, n);
    lab_make(&l, 0);
    fl_step_set_size(&l.w, 2.0 * l.w.dt, 0.0);
    for (int32_t k = 0; k < n; k++) { /* the first mode */
        const double x = (k + 0.5) / n, b = 4.730041, s = (cosh(b) - cos(b)) / (sinh(b) - sin(b));
        l.w.b.v[k].z = 0.01 * (cosh(b * x) + cos(b * x) - s * (sinh(b * x) + sin(b * x)));
    }
    for (double was = 0.0; crossings < 5;) {
        must_run(&l, 1);
        const double now = l.w.b.x[0].z - l.w.b.x[n / 2].z, t = fl_world_time(&l.w);
        if (was * now < 0.0) {
            last = t - l.w.dt * now / (now - was);
            if (!crossings++) first = last;
        }
        was = now;
    }
    verify_row("BS2", "free chain of 40, first bending frequency [Hz]", 2.0 / (last - first), expected,
               1.5e-2, VERIFY_REL);
    lab_free(&l);
}

/* A chain bent to a circle by its ends breaks at M = sigma_t I/R; pulled, at N = sigma_t A. */
static void strengths(void)
{
    for (int bent = 0; bent < 2; bent++) {
        const int32_t n = 6;
        double most = 0.0;
        lab l;
        start_world(&l);
        lab_set(&l, "bond.normal_strength=0.7 MPa");
        lab_set(&l, "bond.shear_strength=0.7 MPa");
        lab_set(&l, "bond.damping=0.3");
        make_chain(&l, n);
        lab_make(&l, 0);
        fl_step_set_size(&l.w, 2.0 * l.w.dt, 0.0);
        hold(&l, 0, bent ? FL_DOF_RY : FL_DOF_X, bent ? ZERO : v3(-1e-3, 0, 0));
        hold(&l, n - 1, bent ? FL_DOF_RY : FL_DOF_X, bent ? ZERO : v3(1e-3, 0, 0));
        if (bent)
            fl_body_set_spin(&l.w.b, 0, v3(0, 0.03, 0)), fl_body_set_spin(&l.w.b, n - 1, v3(0, -0.03, 0));
        while (fl_bond_list_counts(&l.w).state[FL_BOND_ENDED] == 0 && fl_world_time(&l.w) < 2.0) {
            must_run(&l, 1);
            for (int32_t k = 0; k + 1 < n; k++) {
                const fl_disc_load q = fl_disc_list_load(&l.w, k);
                most = fmax(most, bent ? q.moment : q.tension);
            }
        }
        verify_row("BS3",
                   bent ? "chain in bending, largest moment [N m]" : "chain in tension, largest force [N]",
                   most, 0.7e6 * (bent ? INERTIA / R : AREA), 2e-3, VERIFY_REL);
        lab_free(&l);
    }
}

/* The end of a long strip is lifted at the speed w.  Of an Euler beam the largest curvature stays
 *     0.4876 w sqrt(m/E I)   at   x = 1.772 (E I/m)^(1/4) sqrt(t);
 * a chain has that to 4 %, its shear and its length D being felt near the end at first. */
static void lifted_strip(void)
{
    const int32_t n = verify_quick() ? 90 : 160;
    const double w = 0.2, per = MASS / D, EI = E * INERTIA;
    lab l;
    start_world(&l);
    unlimited(&l);
    lab_set(&l, "bond.damping=0.5"); /* of what the sudden start excites in the discs near the end */
    make_chain(&l, n);
    lab_make(&l, 0);
    fl_step_set_size(&l.w, 2.0 * l.w.dt, 0.0);
    hold(&l, 0, FL_DOF_Z, v3(0, 0, w));
    for (int k = 0; k < 3; k++) {
        const double t = (verify_quick() ? 5e-3 : 1e-2) * (1 << k);
        double most = 0.0, where = 0.0;
        char what[80];
        while (fl_world_time(&l.w) < t) must_run(&l, 1);
        for (int32_t i = 0; i + 1 < n; i++) {
            const fl_disc_load q = fl_disc_list_load(&l.w, i);
            if (q.moment > most) most = q.moment, where = q.x.x;
        }
        snprintf(what, sizeof what, "lifted strip at %.0f ms, curvature [1/m]", 1e3 * t);
        verify_row("BS4", what, most / EI, 0.4876 * w * sqrt(per / EI), 4e-2, VERIFY_REL);
        snprintf(what, sizeof what, "lifted strip at %.0f ms, its place [m]", 1e3 * t);
        verify_row("BS4", what, where, 1.772 * pow(EI / per, 0.25) * sqrt(t), 0.05 + 0.5 * D / where,
                   VERIFY_REL);
    }
    lab_free(&l);
}

static double mean_height(const fl_world *w)
{
    double sum = 0.0;
    for (int32_t i = 0; i < w->n; i++) sum += w->b.x[i].z / w->n;
    return sum;
}

/* A raft of spheres in two layers that stands for a slab of 0.33 m: weight per area, level at rest, and heave
 * with three times the displaced mass, m (1 + 3) z'' = -rho g A z with the water plane A of the caps. */
static void floating_slab(void)
{
    const double h = 0.33, g = 9.81, rho = 1025, r = 0.1;
    lab l;
    scene_of_sheet(&l, 3, NULL);
    lab_set(&l, "bond.normal_strength=none");
    lab_set(&l, "bond.shear_strength=none");
    lab_set(&l, "water.current=0 0 0");
    lab_set(&l, "water.drag_force_coef=0");
    lab_make(&l, 0);
    const int32_t n = l.w.n;
    l.w.driven_floes.n = 0; /* all free */
    double mass = 0.0, buoyancy = 0.0, plane = 0.0, added = 0.0;
    for (int32_t i = 0; i < n; i++) {
        l.w.b.v[i] = l.w.b.L[i] = l.w.b.w[i] = ZERO;
        l.w.b.fixed_dof[i] = ALL & ~FL_DOF_Z; /* the layers lie beside each other: it would also roll */
        l.w.b.x[i].x -= 2.0;                  /* away from the cone */
        fl_submerged wet;
        fl_hull_submerged(&l.w.sea.hull[i], v3(0, 0, 1), -l.w.b.x[i].z, &wet);
        mass += l.w.b.m[i], buoyancy += rho * g * wet.volume, plane += wet.waterplane_area;
    }
    verify_row("BS5", "slab of two layers, mass per area [kg/m2]",
               mass / (0.5 * n * sqrt(0.75) * 4.0 * r * r), RHO * h, 1e-12, VERIFY_REL);
    verify_row("BS5", "buoyancy over weight where voronoi-ice puts it", buoyancy / (mass * g), 1.0, 1e-9,
               VERIFY_REL);
    const double expected = 2.0 * PI * sqrt(4.0 * mass / (rho * g * plane)), step = l.w.dt;
    for (int32_t i = 0; i < n; i++) l.w.b.v[i].z = 2e-3;
    l.w.last_search_step = -1;
    fl_err err = {0};
    if (fl_step_start(&l.w, &err)) exit(1);
    double first = 0.0, last = 0.0, was = 0.0;
    const double z0 = mean_height(&l.w);
    for (int crossings = 0; crossings < 3 && fl_world_time(&l.w) < 3.0 * expected;) {
        must_run(&l, 1);
        const double now = mean_height(&l.w) - z0, t = fl_world_time(&l.w);
        if (was * now < 0.0) {
            last = t - step * now / (now - was);
            if (!crossings++) first = last;
        }
        was = now;
    }
    for (int32_t i = 0; i < n; i++) added += l.w.b.heave_mass[i];
    verify_row("BS5", "added mass over mass", added / mass, 3.0, 1e-3, VERIFY_REL);
    verify_row("BS5", "heave, period [s]", last - first, expected, 1e-3, VERIFY_REL);
    lab_free(&l);
}

/* A sheet that breaks on a cone: energy and momentum. */
static void breaking_sheet(void)
{
    lab l;
    scene_of_sheet(&l, 3, NULL);
    lab_make(&l, 0);
    must_run(&l, verify_quick() ? 1500 : 6000);
    const fl_bond_counts c = fl_bond_list_counts(&l.w);
    fl_energy_update(&l.w);
    verify_note("%d bonds of %d broken, %d damaged", c.state[FL_BOND_ENDED], l.w.discs.n,
                c.state[FL_BOND_DAMAGED]);
    verify_below("BS6", "breaking sheet, energy residual over throughput",
                 fabs(l.w.ledger.residual) / l.w.ledger.throughput, 1e-3);
    verify_below("BS6", "breaking sheet, momentum over contact impulses",
                 v3_norm(l.w.imbalance) / l.w.impulse_sum, 1e-12);
    lab_free(&l);
}

/* V69.  A semi-infinite beam afloat, pushed down by P at the distance a from its end, has the moment
 *     M = P/l e^(-s) (sin s - a l (cos s + sin s)),   s = l x,     l = (k/(4 E I))^(1/4),
 * k being the buoyancy per length and depth.  It is largest where tan s = 1/(1 - 2 a l): at pi/4 of the
 * characteristic length for a = 0.  P is what the water bears.  Spheres that float at their centres have a
 * constant water plane; each stands for its D of the beam, the first one, too: a = D/2. */
static void floating_beam(void)
{
    const int32_t n = 64;
    const double young = 2e7, water = 1000.0, g = 9.81, strength = 4e3, k = water * g * AREA / D,
                 root = pow(k / (4.0 * young * INERTIA), 0.25), off = 0.5 * D * root,
                 s = atan(1.0 / (1.0 - 2.0 * off)), shape = exp(-s) * (sin(s) - off * (cos(s) + sin(s)));
    lab l;
    start_world(&l);
    lab_setf(&l, "material.ice.young=%g", young), lab_setf(&l, "material.ice.density=%g", 0.5 * water);
    lab_setf(&l, "water.density=%g", water), lab_setf(&l, "run.gravity=%g", g);
    lab_set(&l, "water.drag_force_coef=0"), lab_set(&l, "bond.damping=0.1");
    lab_setf(&l, "bond.normal_strength=%g", strength), lab_set(&l, "bond.shear_strength=none");
    lab_set(&l, "bond.softening=stretch");
    make_chain(&l, n);
    lab_make(&l, 0);
    hold(&l, 0, FL_DOF_X | FL_DOF_Y | FL_DOF_Z | FL_DOF_RX | FL_DOF_RZ, v3(0, 0, -1.5e-3));
    int32_t first = -1;
    while (first < 0 && fl_world_time(&l.w) < 10.0) {
        must_run(&l, 20);
        for (int32_t b = 0; b < l.w.discs.n && first < 0; b++)
            if (!l.w.discs.at.is_whole[b]) first = b;
    }
    double load = 0.0;
    for (int32_t i = 0; i < n; i++) load -= k * D * l.w.b.x[i].z;
    verify_note("V69: characteristic length %.3g m, disc %d of %d breaks after %.2f s", 1.0 / root, first, n,
                fl_world_time(&l.w));
    verify_row("BS7", "V69 floating beam, load at the first crack [N]", load,
               strength * INERTIA / R * root / shape, 0.03, VERIFY_REL);
    verify_row("BS7", "V69 its place from the end [m]", (first + 1) * D, s / root, 0.5 * D, VERIFY_ABS);
    lab_free(&l);
}

/* Spheres of a hexagonal close packing over lo .. hi, bonded with c = 1 MPa and a scatter of 15 %. */
static void start_pack(lab *l, int32_t layers, fl_vec2 lo, fl_vec2 hi, double disc)
{
    fl_sphere_packing a;
    fl_err err = {0};
    start_world(l);
    lab_set(l, "contact.round_law=linear"), lab_set(l, "contact.friction=0.3");
    lab_set(l, "bond.normal_strength=1 MPa"), lab_set(l, "bond.shear_strength=1 MPa");
    lab_set(l, "bond.softening=stretch"), lab_set(l, "bond.damping=0.1"), lab_set(l, "bond.scatter=0.15");
    if (fl_sphere_packing_make(&a, FL_PACKING_HCP, D, layers, lo, hi, &err)) exit(1);
    int32_t *at = calloc((size_t)a.n, sizeof *at), n = 0;
    if (!at) exit(1);
    for (int32_t k = 0; k < a.n; k++) {
        at[k] = disc > 0.0 && hypot(a.x[k].x, a.x[k].y) > disc ? -1 : n++;
        if (at[k] >= 0) lab_sphere(l, a.x[k], R, ZERO, ZERO);
    }
    for (int32_t k = 0; k < a.pairs; k++) {
        const int32_t i = at[a.pair[k][0]], j = at[a.pair[k][1]];
        if (i >= 0 && j >= 0 &&
            fl_ice_field_add_bond(&l->field, i, j, AREA, D,
                                  v3_lerp(l->field.core[i].v[0], l->field.core[j].v[0], 0.5), &err))
            exit(1);
    }
    free(at);
    fl_sphere_packing_free(&a);
    lab_make(l, 0);
}

/* Moves spheres beyond +-y at v away from or towards each other until the load has fallen to half; the
 * largest load [N].  first: height |y| of the middle of the first disc that softens [m]. */
static double largest_load(lab *l, double y, double v, fl_vec3 *first)
{
    fl_world *w = &l->w;
    double most = 0.0;
    int found = 0;
    for (int32_t i = 0; i < w->n; i++)
        if (fabs(w->b.x[i].y) > y)
            hold(l, i, FL_DOF_Y | FL_DOF_RX | FL_DOF_RZ, v3(0, w->b.x[i].y > 0 ? v : -v, 0));
    for (double load = 0.0; load > 0.5 * most || fl_world_time(w) < 2e-3;) {
        must_run(l, 20);
        load = 0.0;
        for (int32_t i = 0; i < w->n; i++)
            if (w->b.x[i].y > y) load += (v > 0.0 ? -1.0 : 1.0) * w->b.f[i].y;
        most = fmax(most, load);
        for (int32_t b = 0; b < w->discs.n && !found; b++) {
            if (w->discs.at.is_whole[b]) continue;
            *first = fl_disc_list_load(w, b).x;
            found = 1;
        }
    }
    return most;
}

/* V68: a block in compression and in tension.  V67: a disc between plates, 2 P/(pi D t), against a strip. */
static void packs(void)
{
    const double c = 1e6, side = 0.45, v = 0.02;
    double load[2], area = 0.0;
    fl_vec3 where = ZERO;
    for (int pull = 0; pull < 2; pull++) {
        lab l;
        start_pack(&l, 5, (fl_vec2){-0.5 * side, -0.4}, (fl_vec2){0.5 * side, 0.4}, 0.0);
        double half = 0.0;
        for (int32_t i = 0; i < l.w.n; i++) half = fmax(half, fabs(l.w.b.x[i].y));
        load[pull] = largest_load(&l, half - 0.5 * D, pull ? v : -v, &where);
        area = 4.5 * D * 5.0 * sqrt(2.0 / 3.0) * D;
        lab_free(&l);
    }
    verify_note("V68: compression %.2f c, tension %.2f c across rows", load[0] / (area * c),
                load[1] / (area * c));
    verify_row("BS8", "V68 compression over tension of a block", load[0] / load[1], 4.0, 3.0, VERIFY_ABS);
    const double radius = 8.0 * D, thick = D;
    double strip;
    lab l;
    start_pack(&l, 1, (fl_vec2){-3.0 * D, -8.0 * D}, (fl_vec2){3.0 * D, 8.0 * D}, 0.0);
    strip = largest_load(&l, 6.5 * D, v, &where) / (5.5 * D * thick);
    lab_free(&l);
    start_pack(&l, 1, (fl_vec2){-radius, -radius}, (fl_vec2){radius, radius}, radius - R);
    const double P = largest_load(&l, radius - 1.4 * D, -v, &where),
                 splits = 2.0 * P / (PI * 2.0 * radius * thick);
    lab_free(&l);
    verify_note("V67: disc between grips %.2f c, strip in tension %.2f c; first crack at (%.2f, %.2f) radii",
                splits / c, strip / c, where.x / radius, where.y / radius);
}

int main(void)
{
    verify_begin("sheets of bonded spheres");
    cantilever();
    frequency();
    strengths();
    lifted_strip();
    floating_slab();
    breaking_sheet();
    floating_beam();
    if (!verify_quick()) packs();
    return verify_end();
}
