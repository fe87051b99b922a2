/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The disc between two spheres, and beams of them: strengths (V63), a chain in tension and in bending (V65,
 * V64), a cycle of softening (V66); sheets bent and pulled beside a static lattice, more layers, ten samples
 * (BS9 to BS11). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "bond/disc.h"
#include "contact/bond_list.h"
#include "ice/sheet_strength.h"
#include "ice/sphere_packing.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"
#include "support/verify.h"

static const fl_vec3 ZERO = {0, 0, 0};

#define R 0.05
#define D (2.0 * R)
#define AREA (PI * R * R)
#define INERTIA (0.25 * PI * R * R * R * R)

/* --- one disc ----------------------------------------------------------------------------------------- */

#define STIFF 1e12 /* so that it fails at small displacements */
#define RATIO 0.4
#define TENSION 1e6
#define COHESION 0.6e6

static const fl_disc_class STIFF_DISC = {D, STIFF *AREA / D, RATIO, R, 0.5, 0.0, 1.0, 1.5};

/* Moves the spheres of a disc apart by u and turns them by -a/2 and a/2 in n steps; the last forces. */
static fl_disc_wrench move(const fl_disc_law *law, const fl_disc_class *c, fl_disc_memory *m, fl_vec3 *d,
                           fl_vec3 u, fl_vec3 a, int n)
{
    const double dt = 1e-5, rate = 1.0 / (n * dt);
    const fl_vec3 from = *d;
    fl_disc_wrench f = {ZERO, ZERO, ZERO};
    for (int k = 1; k <= n; k++) {
        *d = v3_madd(from, (double)k / n, u);
        const fl_disc_pose at = {*d, ZERO, v3_scale(rate, u), v3_scale(-0.5 * rate, a),
                                 v3_scale(0.5 * rate, a)};
        f = fl_disc_force(law, c, 1.0, &at, dt, m);
    }
    return f;
}

typedef struct {
    double N, S, bending, torsion; /* over area or section modulus [Pa] */
} stresses;

/* The stresses at lambda = 1 as u and a grow together from a pressure. */
static stresses at_failure(double internal_friction, double pressure, fl_vec3 u, fl_vec3 a)
{
    const fl_disc_law law = {TENSION, COHESION, internal_friction, 0.3, 1.0};
    const double press = pressure * D / STIFF;
    double lo = 0.0, hi = 1.0;
    stresses s = {0, 0, 0, 0};
    for (int k = 0; k < 60; k++) {
        const double mid = 0.5 * (lo + hi);
        fl_disc_memory m = {0};
        fl_vec3 d = v3(D - press, 0, 0);
        move(&law, &STIFF_DISC, &m, &d, v3_scale(mid, u), v3_scale(mid, a), 50);
        if (m.lambda > 1.0) {
            hi = mid;
            continue;
        }
        lo = mid;
        s = (stresses){STIFF_DISC.kn * (v3_norm(d) - D) / AREA, v3_norm(m.S) / AREA,
                       hypot(m.M.y, m.M.z) * R / INERTIA, fabs(m.M.x) * R / (2.0 * INERTIA)};
    }
    return s;
}

static void strengths(void)
{
    const double e = 4.0 * TENSION * D / STIFF;
    stresses s = at_failure(0.0, 0.0, v3(e, 0, 0), ZERO);
    verify_row("V63", "disc in tension: N/A over sigma_t", s.N / TENSION, 1.0, 1e-6, VERIFY_REL);
    s = at_failure(0.0, 0.0, v3(0, e, 0), ZERO);
    verify_row("V63", "disc in shear: S/A over c", s.S / COHESION, 1.0, 1e-6, VERIFY_REL);
    s = at_failure(0.0, 0.0, ZERO, v3(0, e / R, 0));
    verify_row("V63", "disc in bending: M R/I over sigma_t", s.bending / TENSION, 1.0, 1e-6, VERIFY_REL);
    s = at_failure(0.0, 0.0, ZERO, v3(e / R, 0, 0));
    verify_row("V63", "disc in torsion: M R/J over c", s.torsion / COHESION, 1.0, 1e-6, VERIFY_REL);
    s = at_failure(0.0, 0.0, v3(0.5 * e, 0, 0), v3(0, 0, e / R));
    verify_row("V63", "tension and bending: (N/A + M R/I) over sigma_t", (s.N + s.bending) / TENSION, 1.0,
               1e-6, VERIFY_REL);
    s = at_failure(0.0, 0.0, v3(0, 0, e), v3(e / R, 0, 0));
    verify_row("V63", "shear and torsion: (S/A + M R/J) over c", (s.S + s.torsion) / COHESION, 1.0, 1e-6,
               VERIFY_REL);
    s = at_failure(0.0, 0.0, v3(e, e, 0), ZERO);
    verify_row("V63", "tension and shear: (N/A sigma_t)^2 + (S/A c)^2",
               pow(s.N / TENSION, 2) + pow(s.S / COHESION, 2), 1.0, 1e-6, VERIFY_REL);
    s = at_failure(0.0, 2e6, v3(0, e, 0), ZERO);
    verify_row("V63", "shear under 2 MPa, no internal friction: S/A over c", s.S / COHESION, 1.0, 1e-6,
               VERIFY_REL);
    s = at_failure(0.3, 2e6, v3(0, e, 0), ZERO);
    verify_row("V63", "shear under 2 MPa, 0.3: S/A over c + 0.3 p", s.S / (COHESION - 0.3 * s.N), 1.0, 1e-6,
               VERIFY_REL);
}

/* Opens a disc from one separation to another; the work done, *force: N at the end. */
static double open_to(fl_disc_memory *m, double from, double to, int steps, double *force)
{
    const fl_disc_law law = {TENSION, COHESION, 0.0, 0.3, 1.0};
    double work = 0.0;
    for (int k = 1; k <= steps; k++) {
        const double du = (to - from) / steps;
        fl_vec3 d = v3(D + from + (k - 1) * du, 0, 0);
        const double F = move(&law, &STIFF_DISC, m, &d, v3(du, 0, 0), ZERO, 1).force.x;
        work += 0.5 * (*force + F) * du;
        *force = F;
    }
    return work;
}

static void softening_cycle(void)
{
    const double peak = TENSION * D / STIFF, f = STIFF_DISC.ductility, top = TENSION * AREA, um = 1.2 * peak;
    fl_disc_memory m = {0};
    double F = 0.0, work = open_to(&m, 0, peak, 50, &F);
    verify_row("V66", "disc: largest force over strength x area", F / top, 1.0, 1e-8, VERIFY_REL);
    work += open_to(&m, peak, um, 50, &F);
    const double before = F;
    verify_row("V66", "on the line: F over Fmax (uf - u)/(uf - uc)", F / (top * (f - 1.2) / (f - 1.0)), 1.0,
               1e-8, VERIFY_REL);
    work += open_to(&m, um, 0.5 * um, 50, &F);
    verify_row("V66", "half unloaded: F over that of the secant", F / (0.5 * before), 1.0, 1e-8, VERIFY_REL);
    work += open_to(&m, 0.5 * um, 0.0, 50, &F) + open_to(&m, 0.0, -peak, 50, &F);
    verify_row("V66", "pressed: F over E A u/l", -F / top, 1.0, 1e-8, VERIFY_REL);
    work += open_to(&m, -peak, 0.0, 50, &F) + open_to(&m, 0.0, um, 50, &F);
    verify_row("V66", "reloaded: F over that before unloading", F / before, 1.0, 1e-8, VERIFY_REL);
    work += open_to(&m, um, f * peak, 50, &F);
    verify_row("V66", "work of the whole curve over Fmax uf/2", work / (0.5 * top * f * peak), 1.0, 1e-8,
               VERIFY_REL);
    verify_row("V66", "energy of fracture over Fmax uf/2", m.dissipated / (0.5 * top * f * peak), 1.0, 1e-8,
               VERIFY_REL);
}

/* --- chains ------------------------------------------------------------------------------------------- */

#define E 1e9
#define NU 0.3
#define RHO 900.0

static void start_world(lab *l, double c, double scatter, int seed)
{
    lab_start(l);
    lab_set(l, "material.ice.young=1 GPa"), lab_set(l, "material.ice.poisson=0.3");
    lab_set(l, "material.ice.density=900");
    lab_set(l, "contact.round_law=linear"), lab_set(l, "contact.friction=0.3");
    lab_set(l, "bond.on=true"), lab_set(l, "bond.damping=0.1"), lab_set(l, "bond.softening=stretch");
    lab_setf(l, "bond.normal_strength=%g", c), lab_setf(l, "bond.shear_strength=%g", c);
    lab_setf(l, "bond.scatter=%g", scatter), lab_setf(l, "bond.seed=%d", seed);
}

static void make_chain(lab *l, int32_t n)
{
    fl_err err = {0};
    for (int32_t k = 0; k < n; k++) lab_sphere(l, v3(k * D, 0, 0), R, ZERO, ZERO);
    for (int32_t k = 0; k + 1 < n; k++)
        if (fl_ice_field_add_bond(&l->field, k, k + 1, AREA, D, v3((k + 0.5) * D, 0, 0), &err)) exit(1);
}

/* A quarter of sqrt(m/k_n). */
static double good_step(void) { return 0.25 * sqrt(RHO * 4.0 / 3.0 * PI * R * R * R / (E * AREA / D)); }

static void must_run(lab *l, int64_t steps)
{
    if (lab_run(l, steps)) exit(1);
}

/* V65: a chain pulled apart; its middle disc is 2 % weaker, so that no other softens. */
static void pull_chain_apart(void)
{
    const int32_t n = 10;
    const double c = 1e6, v = 2e-3, weak = 0.98;
    double peak = 0.0, store = 0.0;
    lab l;
    start_world(&l, c, 1e-9, 1); /* so that each disc has a factor of its own */
    make_chain(&l, n);
    lab_make(&l, 0.25 * good_step());
    fl_world *w = &l.w;
    w->discs.at.scatter[n / 2 - 1] *= weak;
    for (int32_t k = 0; k < n; k++) w->b.v[k].x = v * (2.0 * k / (n - 1) - 1.0);
    for (int e = 0; e < 2; e++) w->b.fixed_dof[e ? n - 1 : 0] = 63;
    while (fl_bond_list_counts(w).state[FL_BOND_ENDED] == 0 && (double)w->step * w->dt < 1.0) {
        must_run(&l, 1);
        fl_energy_update(w);
        const double F = fl_disc_list_load(w, 0).tension;
        peak = fmax(peak, F);
        if (w->discs.at.is_whole[n / 2 - 1]) store = w->ledger.bond;
    }
    verify_row("V65", "tension of a chain: largest force over sigma_t A", peak / (weak * c * AREA), 1.0, 1e-2,
               VERIFY_REL);
    verify_row("V65", "elastic energy before softening over sigma^2 V/2E",
               store / (0.5 * weak * weak * c * c / E * AREA * (n - 1) * D), 1.0, 1e-2, VERIFY_REL);
    verify_row("V65", "fracture over f sigma^2 l A/2E",
               w->ledger.fracture / (1.5 * 0.5 * weak * weak * c * c / E * AREA * D), 1.0, 1e-2, VERIFY_REL);
    verify_below("V65", "residual over that energy", fabs(w->ledger.residual) / store, 1e-3);
    lab_free(&l);
}

/* --- three-point bending ------------------------------------------------------------------------------ */

/* Spheres that are held (two lines below) and pushed down (one above), as positions along the beam. */
typedef struct {
    double left, right, top;
    double bottom, roof; /* their heights */
    int axis;            /* 0: along x, 1: along y */
} rollers;

static double along(const rollers *p, fl_vec3 x) { return p->axis ? x.y : x.x; }

/* 1, 2, 3: of the line on the left, right, top; 0: of none. */
static int line_of(const rollers *p, fl_vec3 x)
{
    const double s = along(p, x);
    if (fabs(x.z - p->roof) < 0.1 * D && fabs(s - p->top) < 0.1 * D) return 3;
    if (fabs(x.z - p->bottom) > 0.1 * D) return 0;
    return fabs(s - p->left) < 0.1 * D ? 1 : fabs(s - p->right) < 0.1 * D ? 2 : 0;
}

typedef struct {
    double first, peak; /* stress at the first disc that softens, and the largest [c] */
    double young;       /* [E] */
} bent;

/* Bends a beam between its rollers: width w, nominal thickness h.  The load is that of the top line, whose
 * speed grows over the first 20 ms. */
static bent bend(lab *l, const rollers *p, double w, double h, double c)
{
    fl_world *const world = &l->w;
    const double v = 0.02, a = p->top - p->left, b = p->right - p->top,
                 unit = 6.0 * a * b / ((a + b) * w * h * h);
    double depth = 0.0, most = 0.0, sd = 0, sp = 0, sdd = 0, sdp = 0, k = 0;
    bent out = {0, 0, 0};
    for (int32_t i = 0; i < world->n; i++)
        if (line_of(p, world->b.x[i])) world->b.fixed_dof[i] = FL_DOF_Z;
    uint8_t *line = world->n > 0 ? calloc((size_t)world->n, 1) : NULL;
    if (!line) exit(1);
    for (int32_t i = 0; i < world->n; i++) line[i] = (uint8_t)line_of(p, world->b.x[i]);
    for (double load = 0.0; load > 0.7 * most || depth < 1e-4;) {
        const double t = (double)world->step * world->dt, now = v * fmin(1.0, t / 0.02);
        for (int32_t i = 0; i < world->n; i++)
            if (line[i] == 3) world->b.v[i] = v3(world->b.v[i].x, world->b.v[i].y, -now);
        must_run(l, 20);
        depth += 20.0 * world->dt * now;
        load = 0.0;
        for (int32_t i = 0; i < world->n; i++)
            if (line[i] == 3) load += world->b.f[i].z;
        most = fmax(most, load);
        for (int32_t d = 0; d < world->discs.n && out.first == 0.0; d++) {
            if (world->discs.at.is_whole[d]) continue;
            const double s = along(p, fl_disc_list_load(world, d).x);
            if (fmin(fabs(s - p->left), fabs(s - p->right)) > 1.5 * D) out.first = load * unit / c;
        }
        if (out.first > 0.0 || t < 0.04) continue;
        k++, sd += depth, sp += load, sdd += depth * depth, sdp += depth * load;
    }
    free(line);
    out.peak = most * unit / c;
    out.young = (k * sdp - sd * sp) / (k * sdd - sd * sd) * a * a * b * b /
                (3.0 * (a + b) * w * h * h * h / 12.0) / E;
    return out;
}

/* V64: a chain on two supports, c alone: M = P/2 (L/2 - D/2) at the discs beside the middle. */
static void bend_a_chain(void)
{
    const int32_t n = 11;
    const double c = 1e6, L = (n - 1) * D;
    const rollers p = {0.0, L, 0.5 * L, 0.0, 0.0, 0};
    lab l;
    start_world(&l, c, 0.0, 1);
    lab_set(&l, "bond.shear_strength=none");
    make_chain(&l, n);
    lab_make(&l, good_step());
    /* w h^2/6 = I/R: stress of the middle, where that of the nearest disc is (L - D)/L times as large */
    const bent r = bend(&l, &p, 6.0 * INERTIA / R / (D * D), D, c);
    verify_row("V64", "three-point bending of a chain: first crack over 4 sigma_t I/R/(L - D)",
               r.first * (L - D) / L, 1.0, 2e-2, VERIFY_REL);
    lab_free(&l);
}

/* Width of a sheet: rows x spacing. */
static double width_of(const fl_sphere_packing *a, int across)
{
    return across ? a->columns * D : a->rows * sqrt(0.75) * D;
}

static double thickness_of(int32_t layers) { return layers > 1 ? layers * sqrt(2.0 / 3.0) * D : D; }

/* A sheet of that many layers, 6 D wide, along x or, with rows across it, along y. */
static fl_sphere_packing add_sheet(lab *l, int32_t layers, int across, double length)
{
    const double half = 0.5 * length, side = 3.005 * D;
    fl_sphere_packing a;
    fl_err err = {0};
    const fl_vec2 hi = {across ? side : half, across ? half : side};
    if (fl_sphere_packing_make(&a, FL_PACKING_HCP, D, layers, (fl_vec2){-hi.x, -hi.y}, hi, &err)) exit(1);
    for (int32_t i = 0; i < a.n; i++) lab_sphere(l, a.x[i], R, ZERO, ZERO);
    for (int32_t k = 0; k < a.pairs; k++) {
        const int32_t i = a.pair[k][0], j = a.pair[k][1];
        if (fl_ice_field_add_bond(&l->field, i, j, AREA, D, v3_lerp(a.x[i], a.x[j], 0.5), &err)) exit(1);
    }
    return a;
}

/* A beam of a sheet with a span of 10.6 h; rollers bear on the lines of spheres nearest to their places. */
static bent bend_a_sheet(int32_t layers, int across, double scatter, int seed)
{
    const double c = 1e6, h = thickness_of(layers);
    lab l;
    start_world(&l, c, scatter, seed);
    fl_sphere_packing a = add_sheet(&l, layers, across, 12.5 * h);
    rollers p = {1e9, 1e9, 1e9, a.x[0].z, a.x[a.n - 1].z, across};
    const int32_t layer = a.n / layers;
    for (int32_t i = 0; i < layer; i++) {
        const double s = along(&p, a.x[i]);
        if (fabs(s + 5.3 * h) < fabs(p.left + 5.3 * h)) p.left = s;
        if (fabs(s - 5.3 * h) < fabs(p.right - 5.3 * h)) p.right = s;
    }
    for (int32_t i = a.n - layer; i < a.n; i++) {
        const double s = along(&p, a.x[i]), mid = 0.5 * (p.left + p.right);
        if (fabs(s - mid) < fabs(p.top - mid)) p.top = s;
    }
    const double w = width_of(&a, across);
    fl_sphere_packing_free(&a);
    lab_make(&l, good_step());
    const bent r = bend(&l, &p, w, h, c);
    lab_free(&l);
    return r;
}

/* BS11: a strip of three layers, 24 D long, whose end lines are moved apart and do not spin. */
static void pull_sheets(void)
{
    static const double FIRST[2] = {1.25, 1.53}, YOUNG[2] = {1.593, 1.563};
    const double c = 1e6, v = 0.01, h = thickness_of(3);
    for (int across = 0; across < 2; across++) {
        double half = 0.0, load = 0.0;
        char what[80];
        int softens = 0;
        lab l;
        start_world(&l, c, 0.0, 1);
        fl_sphere_packing a = add_sheet(&l, 3, across, 24.01 * D);
        const double area = width_of(&a, across) * h;
        fl_sphere_packing_free(&a);
        lab_make(&l, good_step());
        fl_world *w = &l.w;
        const rollers p = {.axis = across};
        for (int32_t i = 0; i < w->n; i++) half = fmax(half, along(&p, w->b.x[i]));
        const double grip = half - 0.9 * D;
        for (int32_t i = 0; i < w->n; i++) {
            const double s = along(&p, w->b.x[i]), u = v * fmax(-1.0, fmin(1.0, s / grip));
            w->b.v[i] = across ? v3(0, u, 0) : v3(u, 0, 0);
            if (fabs(s) > grip)
                w->b.fixed_dof[i] =
                    (uint8_t)(FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ | (across ? FL_DOF_Y : FL_DOF_X));
        }
        while (!softens && (double)w->step * w->dt < 1.0) {
            must_run(&l, 10);
            load = 0.0;
            for (int32_t i = 0; i < w->n; i++)
                if (along(&p, w->b.x[i]) > grip) load -= along(&p, w->b.f[i]);
            for (int32_t d = 0; d < w->discs.n && !softens; d++) softens = !w->discs.at.is_whole[d];
        }
        const double strain = v * (double)w->step * w->dt / half;
        snprintf(what, sizeof what, "strip pulled %s rows: first crack [c]", across ? "across" : "along");
        verify_row("BS11", what, load / area / c, FIRST[across], 0.05, VERIFY_REL);
        snprintf(what, sizeof what, "strip pulled %s rows: modulus between the ends [E]",
                 across ? "across" : "along");
        verify_row("BS11", what, load / area / strain / E, YOUNG[across], 0.1, VERIFY_REL);
        lab_free(&l);
    }
}

/* BS9: without scatter, beside a static lattice at lambda = 1.  Rows along bear on one line of their zigzag;
 * the lattice has the stress over a span that is D/2 longer. */
static void bend_sheets(void)
{
    static const double FIRST[2][3] = {{1.04, 1.32, 1.42}, {1.18, 1.60, 1.73}},
                        YOUNG[2][3] = {{0.91, 1.45, 1.43}, {0.87, 1.36, 1.35}};
    const int most = verify_quick() ? 1 : 3;
    for (int across = 0; across < 2; across++) {
        double r[3] = {0, 0, 0};
        const char *const rows = across ? "across" : "along";
        char what[80];
        for (int k = 0; k < most; k++) {
            const bent b = bend_a_sheet(k + 1, across, 0.0, 1);
            const double span = 10.6 * thickness_of(k + 1);
            r[k] = b.first * (across ? 1.0 : span / (span - 0.5 * D));
            snprintf(what, sizeof what, "beam of %d layers, rows %s: first crack [c]", k + 1, rows);
            verify_row("BS9", what, r[k], FIRST[across][k], 0.05, VERIFY_REL);
            snprintf(what, sizeof what, "beam of %d layers, rows %s: modulus [E]", k + 1, rows);
            verify_row("BS9", what, b.young, YOUNG[across][k], 0.1, VERIFY_REL);
        }
        if (most < 3) continue;
        snprintf(what, sizeof what, "rows %s: first crack of three layers over two, change", rows);
        verify_below("BS9", what, fabs(r[2] / r[1] - 1.0), 0.1);
    }
}

/* BS10: ten samples with a scatter of 15 %, beside what voronoi-ice uses. */
static void ten_samples(void)
{
    for (int32_t layers = 1; layers <= (verify_quick() ? 1 : 2); layers++) {
        double sum = 0, sum2 = 0, least = 1e9, most = 0;
        const fl_sheet_strength used = fl_sheet_strength_of(FL_PACKING_HCP, layers, 1);
        char what[80];
        const int n = verify_quick() ? 3 : 10;
        for (int s = 1; s <= n; s++) {
            const double peak = bend_a_sheet(layers, 1, FL_SHEET_SCATTER, s).peak;
            sum += peak, sum2 += peak * peak, least = fmin(least, peak), most = fmax(most, peak);
        }
        const double mean = sum / n, spread = sqrt((sum2 - n * mean * mean) / (n - 1)) / mean;
        verify_note("%d samples of %d layers in bending: mean %.3f c, deviation %.3f of it, %.3f to %.3f c",
                    n, layers, mean, spread, least, most);
        snprintf(what, sizeof what, "mean of %d samples, %d layers, over that of the table", n, layers);
        verify_row("BS10", what, mean / used.flexural, 1.0, 0.15, VERIFY_REL);
    }
}

int main(void)
{
    verify_begin("discs between spheres, chains and beams of them");
    strengths();
    softening_cycle();
    pull_chain_apart();
    bend_a_chain();
    bend_sheets();
    if (!verify_quick()) pull_sheets();
    ten_samples();
    return verify_end();
}
