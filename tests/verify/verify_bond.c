/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bonds of faces that are frozen together: beams of blocks, strengths, fracture energies (V61 to V66), a
 * floating beam (V69). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "base/rng.h"
#include "body/integrate.h"
#include "sim/energy_balance.h"
#include "contact/bond_list.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* --- a row of blocks along x -------------------------------------------------------------------------- */

/* n bonded blocks of a bar that starts at x = 0.  Scene keys are set before. */
static void make_bar(lab *l, int32_t n, double length, double width, double height, double radius)
{
    const double d = length / n;
    fl_err err = {0};
    for (int32_t k = 0; k < n; k++)
        lab_box(l, v3((k + 0.5) * d, 0, 0), v3(0.5 * d, 0.5 * width, 0.5 * height), radius, q_one(), ZERO,
                ZERO);
    for (int32_t k = 0; k + 1 < n; k++)
        if (fl_ice_field_add_bond(&l->field, k, k + 1, width * height, width, v3((k + 1) * d, 0, 0), &err))
            exit(1);
}

static void start_world(lab *l)
{
    lab_start(l);
    lab_set(l, "material.ice.young=1 GPa");
    lab_set(l, "material.ice.poisson=0.3");
    lab_set(l, "material.ice.density=900");
    lab_set(l, "bond.on=true");
}

/* Impulse of a force on body i at a point of the world, for half a step.  It is applied before and after
 * the step, so that a body at rest stays at rest. */
static void apply_half_impulse(lab *l, int32_t i, fl_vec3 force, fl_vec3 at)
{
    fl_bodies *b = &l->w.b;
    b->v[i] = v3_madd(b->v[i], 0.5 * l->w.dt * b->invm[i], force);
    b->L[i] = v3_madd(b->L[i], 0.5 * l->w.dt, v3_cross(v3_sub(at, b->x[i]), force));
    fl_body_update_spin(b, i);
}

/* Reduces all velocities at the rate [1/s] during the next step. */
static void damp_velocities(lab *l, double rate)
{
    fl_bodies *b = &l->w.b;
    for (int32_t i = 0; i < l->w.n; i++) {
        b->v[i] = v3_scale(1.0 - rate * l->w.dt, b->v[i]);
        b->L[i] = v3_scale(1.0 - rate * l->w.dt, b->L[i]);
        fl_body_update_spin(b, i);
    }
}

static void run_one_step(lab *l)
{
    if (lab_run(l, 1)) exit(1);
}

/* The cantilever of V61 and V62: n blocks behind a fixed one.  The face of the fixed block is half a block
 * from the first centre, so that its springs are those of half the length. */
static void cantilever(lab *l, int32_t n)
{
    start_world(l);
    lab_set(l, "bond.normal_strength=none");
    lab_set(l, "bond.shear_strength=none");
    make_bar(l, n + 1, 1.0 + 1.0 / n, 0.1, 0.1, 0.0);
    lab_make(l, 0);
    l->w.b.fixed_dof[0] = 63;
    l->w.bonds.bond[0].kn *= 2.0, l->w.bonds.bond[0].ks *= 2.0;
    fl_step_set_size(&l->w, 2.5 * l->w.dt, 0.0);
}

static double tip_deflection(int32_t n)
{
    lab l;
    cantilever(&l, n);
    const double omega = 2 * PI * 17.0, P = 10.0, d = 1.0 / n;
    const int64_t steps = (int64_t)(22.0 / omega / l.w.dt);
    fl_vec3 tip = v3(1.0 + d, 0, 0);
    const fl_vec3 arm = v3_sub(tip, l.w.b.x[n]);
    for (int64_t k = 0; k < steps; k++) {
        apply_half_impulse(&l, n, v3(0, 0, -P), tip);
        run_one_step(&l);
        tip = v3_add(l.w.b.x[n], m3_mul(fl_body_axes(&l.w.b, n), m3_tmul(q_matrix(l.w.q0[n]), arm)));
        apply_half_impulse(&l, n, v3(0, 0, -P), tip);
        damp_velocities(&l, 2.0 * omega);
    }
    tip = v3_add(l.w.b.x[n], m3_mul(fl_body_axes(&l.w.b, n), m3_tmul(q_matrix(l.w.q0[n]), arm)));
    lab_free(&l);
    return -tip.z;
}

static void cantilever_deflection(void)
{
    const double E = 1e9, G = E / 2.6, A = 0.01, I = 0.1 * 0.1 * 0.1 * 0.1 / 12, P = 10.0,
                 beam = P / (3 * E * I);
    const int most = verify_quick() ? 2 : 4;
    double h[4], off[4];
    for (int k = 0; k < most; k++) {
        const int32_t n = 5 << k;
        const double w = tip_deflection(n), shear = P / (G * A) * (1.0 - 0.5 / n), bent = w - shear;
        char what[80];
        snprintf(what, sizeof what, "cantilever of %d blocks: bending over the beam's", n);
        verify_row("V61", what, bent / beam, 1.0 + 0.5 / n / n, 2e-5, VERIFY_REL);
        h[k] = 1.0 / n;
        off[k] = fabs(bent / beam - 1.0);
    }
    verify_row("V61", "of the beam, Euler and Bernoulli [m]", beam, 4e-4, 1e-12, VERIFY_REL);
    verify_order("V61", "error of the chain", h, off, most, 2.0, 0.05);
}

static void bending_frequency(void)
{
    lab l;
    const int32_t n = 20;
    cantilever(&l, n);
    for (int32_t k = 1; k <= n; k++) { /* deflected at its tip, nearly the first mode; its slope as well */
        const double x = (k - 0.5) / n, s = 0.5 * x * x * (3 - x), turn = 1.5 * x * (2 - x);
        l.w.b.v[k].z = 1e-3 * s;
        fl_body_set_spin(&l.w.b, k, v3(0, -1e-3 * turn, 0));
    }
    double last = 0.0, first = -1.0, t = 0.0;
    int crossings = 0;
    while (crossings < (verify_quick() ? 5 : 11)) {
        const double before = l.w.b.x[n].z;
        run_one_step(&l);
        const double now = l.w.b.x[n].z;
        if (l.w.step > 1 && before * now < 0.0) {
            t = fl_world_time(&l.w) - l.w.dt * now / (now - before);
            if (first < 0.0) first = t;
            last = t;
            crossings++;
        }
    }
    verify_row("V62", "first bending frequency [Hz]", 0.5 * (crossings - 1) / (last - first), 17.0277, 1e-2,
               VERIFY_REL);
    lab_free(&l);
}

/* --- one face ----------------------------------------------------------------------------------------- */

/* Two blocks of 0.4 m with a face of 0.3 by 0.2 m.  For a displacement u and a rotation v of the second
 * block about the centre of the face: force, moment about that centre, and whether the bond is intact. */
typedef struct {
    fl_vec3 f, m;
    int whole;
    fl_bond c;
} response;

static response bond_response(const lab *l, const fl_bond *c, fl_vec3 u, fl_vec3 v)
{
    fl_bodies *b = (fl_bodies *)&l->w.b;
    const double a = v3_norm(v);
    const fl_vec3 x0[2] = {b->x[0], b->x[1]}, face = v3(0.4, 0, 0);
    const fl_quat q0[2] = {b->q[0], b->q[1]};
    response out = {.c = *c};
    for (int k = 0; k < 2; k++) {
        const double s = k ? 1.0 : -1.0;
        const fl_quat q = a > 0.0 ? (fl_quat){cos(0.25 * a), s * sin(0.25 * a) / a * v.x,
                                              s * sin(0.25 * a) / a * v.y, s * sin(0.25 * a) / a * v.z}
                                  : q_one();
        b->x[k] = v3_add(v3_madd(face, 0.5 * s, u), q_rotate(q, v3_sub(x0[k], face)));
        b->q[k] = q_mul(q, q0[k]);
        fl_body_update_spin(b, k);
    }
    fl_bond_force(&out.c, b, ZERO);
    out.f = out.c.force;
    out.m = v3_sub(out.c.torque_i, v3_cross(v3_sub(v3_madd(face, -0.5, u), b->x[0]), out.f));
    out.whole = out.c.state == FL_BOND_INTACT;
    for (int k = 0; k < 2; k++) {
        b->x[k] = x0[k], b->q[k] = q0[k];
        fl_body_update_spin(b, k);
    }
    return out;
}

/* The last response before the bond breaks, as the motion grows. */
static response response_before_break(const lab *l, fl_vec3 u, fl_vec3 v)
{
    double lo = 0.0, hi = 1.0;
    const fl_bond c = l->w.bonds.bond[0];
    for (int k = 0; k < 60; k++) {
        const double mid = 0.5 * (lo + hi);
        if (bond_response(l, &c, v3_scale(mid, u), v3_scale(mid, v)).whole) lo = mid;
        else hi = mid;
    }
    return bond_response(l, &c, v3_scale(lo, u), v3_scale(lo, v));
}

static void pair_of_blocks(lab *l)
{
    make_bar(l, 2, 0.8, 0.3, 0.2, 0.01);
    lab_make(l, 0);
}

static void face_strength(void)
{
    const double b = 0.3, h = 0.2, A = b * h, I = b * h * h * h / 12, s = 0.7e6, c = 0.5e6;
    lab l;
    start_world(&l);
    lab_set(&l, "bond.young=10 GPa"); /* stiff, so that failure comes before large rotations */
    lab_set(&l, "bond.normal_strength=0.7 MPa");
    lab_set(&l, "bond.shear_strength=0.5 MPa");
    lab_set(&l, "bond.friction=0.4");
    pair_of_blocks(&l);
    response a = response_before_break(&l, v3(0.01, 0, 0), ZERO);
    verify_row("V63", "tension: N/A over the strength", a.f.x / A / s, 1.0, 1e-6, VERIFY_REL);
    a = response_before_break(&l, v3(0, 0, 0.01), ZERO);
    verify_row("V63", "shear: Q/A over the strength", a.f.z / A / c, 1.0, 1e-6, VERIFY_REL);
    a = response_before_break(&l, v3(-1e-3, 0.01, 0), ZERO); /* tau = c + mu p, both growing */
    verify_row("V63", "shear under pressure: Q/A over c + mu N/A", a.f.y / A / (c - 0.4 * a.f.x / A), 1.0,
               1e-6, VERIFY_REL);
    a = response_before_break(&l, ZERO, v3(0, 0.01, 0));
    verify_row("V63", "moment: M h/2I over the strength", fabs(a.m.y) * h / (2 * I) / s, 1.0, 1e-6,
               VERIFY_REL);
    a = response_before_break(&l, v3(2e-4, 0, 0), v3(0, 0.01, 0));
    verify_row("V63", "tension and moment: (N/A + M h/2I) over the strength",
               (a.f.x / A + fabs(a.m.y) * h / (2 * I)) / s, 1.0, 1e-6, VERIFY_REL);
    lab_free(&l);
}

/* The face is opened in `steps` steps to u metres.  Returns the work done; *force is F(u) at the end. */
static double open_to(const lab *l, fl_bond *c, double from, double to, int steps, double *force)
{
    double work = 0.0;
    for (int k = 1; k <= steps; k++) {
        const double u = from + (to - from) * k / steps;
        const response a = bond_response(l, c, v3(u, 0, 0), ZERO);
        *c = a.c;
        work += 0.5 * (*force + a.f.x) * (to - from) / steps;
        *force = a.f.x;
    }
    return work;
}

static void softening_cycle(void)
{
    const double A = 0.06, s = 0.7e6, E = 1e9, length = 0.4, G = 150.0;
    const double uc = s * length / E, uf = 2 * G / s, um = uc + 0.4 * (uf - uc);
    lab l;
    start_world(&l);
    lab_set(&l, "bond.energy=150 J/m2");
    pair_of_blocks(&l);
    fl_bond c = l.w.bonds.bond[0];
    double F = 0.0, work = open_to(&l, &c, 0, uc, 100, &F);
    verify_row("V66", "softening: largest force over strength x area", F / (s * A), 1.0, 1e-8, VERIFY_REL);
    work += open_to(&l, &c, uc, um, 400, &F);
    const double top = F;
    verify_row("V66", "on the line: F over Fmax (uf - u)/(uf - uc)", top / (s * A * 0.6), 1.0, 1e-8,
               VERIFY_REL);
    work += open_to(&l, &c, um, 0.5 * um, 50, &F);
    verify_row("V66", "half unloaded: F over that of the secant", F / (0.5 * top), 1.0, 1e-8, VERIFY_REL);
    work += open_to(&l, &c, 0.5 * um, 0.0, 50, &F);
    verify_row("V66", "closed: F over Fmax", F / (s * A), 0.0, 1e-8, VERIFY_ABS);
    const double closed = open_to(&l, &c, 0.0, -uc, 20, &F);
    verify_row("V66", "pressed: F over k_n A u", F / (-E / length * A * uc), 1.0, 1e-8, VERIFY_REL);
    work += closed + open_to(&l, &c, -uc, 0.0, 20, &F) + open_to(&l, &c, 0.0, um, 100, &F);
    verify_row("V66", "reloaded: F over that before unloading", F / top, 1.0, 1e-8, VERIFY_REL);
    work += open_to(&l, &c, um, uf, 600, &F);
    verify_row("V66", "work of the whole curve over Fmax uf/2", work / (0.5 * s * A * uf), 1.0, 1e-8,
               VERIFY_REL);
    verify_row("V66", "fracture energy in the ledger over G A", c.dissipated / (G * A), 1.0, 1e-8,
               VERIFY_REL);
    verify_true("V66", "failed and open: ended", c.state == FL_BOND_ENDED);
    lab_free(&l);
}

/* --- the balance of energy ---------------------------------------------------------------------------- */

/* A plate of 4 x 4 boxes whose boxes fly apart at 0.3 m/s each: faces soften, break, close, slide and are
 * removed; or they break at once. */
static double thrown_apart(int brittle, double dt, int *ended)
{
    lab l;
    fl_err err = {0};
    start_world(&l);
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "bond.normal_strength=10 kPa");
    lab_set(&l, "bond.shear_strength=12 kPa");
    if (!brittle) lab_set(&l, "bond.energy=8");
    for (int k = 0; k < 16; k++) {
        fl_rng g = fl_rng_of(3, k, FL_RNG_TEST);
        const fl_vec3 v = v3(fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 0.3)),
                      w = v3(fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 0.3));
        lab_box(&l, v3(k % 4, k / 4, 0), v3(0.5, 0.5, 0.3), 0.05, q_one(), v, w);
    }
    for (int k = 0; k < 16; k++) {
        const double x = k % 4, y = (double)(k / 4);
        if (k % 4 < 3 && fl_ice_field_add_bond(&l.field, k, k + 1, 0.6, 1.0, v3(x + 0.5, y, 0), &err))
            exit(1);
        if (k < 12 && fl_ice_field_add_bond(&l.field, k, k + 4, 0.6, 1.0, v3(x, y + 0.5, 0), &err)) exit(1);
    }
    lab_make(&l, dt);
    if (lab_run(&l, (int64_t)(0.06 / dt + 0.5))) exit(1);
    fl_energy_update(&l.w);
    *ended = fl_bond_list_counts(&l.w).state[FL_BOND_ENDED];
    const double off = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    lab_free(&l);
    return off;
}

static void energy_balance(void)
{
    for (int brittle = 0; brittle < 2; brittle++) {
        double h[4], off[4];
        int ended = 0;
        for (int k = 0; k < 4; k++) off[k] = thrown_apart(brittle, h[k] = 4e-4 / (1 << k), &ended);
        verify_true("V65", "a plate flies apart: some faces have opened", ended > 2);
        verify_order("V65",
                     brittle ? "residual over throughput, brittle" : "residual over throughput, softening", h,
                     off, 4, 2.0, 0.5);
        verify_below("V65", "the same at the smallest step", off[3], 1e-5);
    }
}

/* --- bars and beams that break ------------------------------------------------------------------------ */

/* The bar is pulled at both ends, slowly against its elastic waves.  The middle face is a thousandth
 * weaker, for the place where a uniform bar breaks depends on rounding. */
static void pull_bar_apart(void)
{
    const int32_t n = 10;
    const double A = 0.01, E = 1e9, s = 0.7e6, G = 60.0, speed = 2e-3;
    double peak = 0.0, store = 0.0;
    lab l;
    start_world(&l);
    lab_set(&l, "bond.energy=60 J/m2");
    lab_set(&l, "bond.damping=0.05");
    make_bar(&l, n, 1.0, 0.1, 0.1, 0.01);
    lab_make(&l, 0);
    fl_step_set_size(&l.w, 2.0 * l.w.dt, 0.0);
    fl_bond *middle = &l.w.bonds.bond[n / 2 - 1];
    middle->tensile_strength *= 0.999;
    for (int e = 0; e < 2; e++) {
        l.w.b.fixed_dof[e ? n - 1 : 0] = 63;
        l.w.b.v[e ? n - 1 : 0].x = e ? speed : -speed;
    }
    /* a uniform start, without a wave */
    for (int32_t k = 0; k < n; k++) l.w.b.v[k].x = speed * (2.0 * k / (n - 1) - 1.0);
    while (middle->state < FL_BOND_BROKEN && middle->state != FL_BOND_ENDED && fl_world_time(&l.w) < 1.0) {
        run_one_step(&l);
        fl_energy_update(&l.w);
        if (l.w.bonds.bond[0].force.x > peak) peak = l.w.bonds.bond[0].force.x, store = l.w.ledger.bond;
    }
    /* the springs of n blocks are those of n - 1 lengths */
    verify_row("V65", "tension of a bar: strength over that of its ice", peak / A / s, 1.0, 1e-2, VERIFY_REL);
    verify_row("V65", "elastic energy at the peak over sigma^2 V/2E",
               store / (0.5 * s * s / E * A * (n - 1.0) / n), 1.0, 1e-2, VERIFY_REL);
    fl_energy_update(&l.w);
    verify_row("V65", "fracture over G A", l.w.ledger.fracture / (G * A), 1.0, 1e-2, VERIFY_REL);
    verify_below("V65", "residual over the energy at the peak", fabs(l.w.ledger.residual) / store, 1e-3);
    lab_free(&l);
}

static void three_loads(lab *l, int32_t n, double load)
{
    const fl_vec3 up = v3(0, 0, 0.5 * load), middle = v3(0.5, 0, l->w.b.x[n / 2].z);
    apply_half_impulse(l, 0, up, v3(0, 0, 0));
    apply_half_impulse(l, n - 1, up, v3(1, 0, 0));
    apply_half_impulse(l, n / 2 - 1, v3_neg(up), middle);
    apply_half_impulse(l, n / 2, v3_neg(up), middle);
}

/* Three-point bending by loads in equilibrium: P in the middle, P/2 at each end, growing slowly. */
static void three_point_bending(void)
{
    const int32_t n = verify_quick() ? 10 : 40;
    const double s = 0.7e6, h = 0.1, P = 2 * s * 0.1 * h * h / 3.0, omega = 2 * PI * 48.0;
    double load = 0.0;
    lab l;
    start_world(&l);
    make_bar(&l, n, 1.0, 0.1, 0.1, 0.005);
    lab_make(&l, 0);
    fl_step_set_size(&l.w, 2.5 * l.w.dt, 0.0);
    const double rate = 0.02 * P * omega;
    while (l.w.bonds.bond[n / 2 - 1].state == FL_BOND_INTACT && load < 2 * P) {
        load = rate * fl_world_time(&l.w);
        three_loads(&l, n, load);
        run_one_step(&l);
        three_loads(&l, n, load);
        damp_velocities(&l, 1.5 * omega);
    }
    verify_row("V64", "three-point bending: P over 2 sigma_t b h^2/3L", load / P, 1.0, 2e-2, VERIFY_REL);
    lab_free(&l);
}

/* A long floating beam of unit width, lifted at its end: l = (4 E I/rho g)^1/4.  The largest moment is pi
 * l/4 from the end, where the beam breaks at P = 0.68 sigma (rho g h^5/E)^1/4.  The ice has 0.1 GPa and 50
 * kPa, so that the end stays in the water. */
static void floating_beam(void)
{
    const double h = 0.23, E = 1e8, s = 5e4, rho = 1035, g = 9.81;
    const double l0 = pow(4 * E * h * h * h / 12 / (rho * g), 0.25), at = 0.25 * PI * l0,
                 heave = sqrt(rho * g / 900 / h);
    const double P = 0.68 * s * pow(rho * g * pow(h, 5) / E, 0.25);
    const int32_t cells = verify_quick() ? 6 : 10, n = (int32_t)(cells * 4.2 / (0.25 * PI));
    const double d = at / cells;
    double load = 0.0, where = 0.0;
    lab l;
    start_world(&l);
    lab_set(&l, "material.ice.young=0.1 GPa");
    lab_set(&l, "bond.normal_strength=50 kPa");
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "water.density=1035");
    lab_set(&l, "water.drag_force_coef=0");
    lab_setf(&l, "water.level=%.17g", h * 900 / rho - 0.5 * h);
    make_bar(&l, n, n * d, 1.0, h, 0.01);
    lab_make(&l, 0);
    fl_step_set_size(&l.w, 2.5 * l.w.dt, 0.0);
    while (where == 0.0 && load < 2 * P) {
        load = P * fl_world_time(&l.w) / 6.0;
        apply_half_impulse(&l, 0, v3(0, 0, load), v3(0, 0, 0));
        run_one_step(&l);
        apply_half_impulse(&l, 0, v3(0, 0, load), v3(0, 0, 0));
        damp_velocities(&l, 0.4 * heave);
        for (int32_t k = 0; k + 1 < n; k++)
            if (l.w.bonds.bond[k].state != FL_BOND_INTACT) where = (k + 1) * d;
    }
    verify_row("V69", "floating beam: place of the crack over pi l/4", where / at, 1.0, 1.0 / cells + 1e-9,
               VERIFY_REL);
    verify_row("V69", "floating beam: load at the end over 0.68 sigma (rho g h^5/E)^1/4", load / P, 1.0, 3e-2,
               VERIFY_REL);
    lab_free(&l);
}

int main(void)
{
    verify_begin("bonds");
    cantilever_deflection();
    bending_frequency();
    face_strength();
    three_point_bending();
    pull_bar_apart();
    softening_cycle();
    energy_balance();
    floating_beam();
    return verify_end();
}
