/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A floating hull: hydrostatic stiffness from its shape, and its heave, roll and pitch on that stiffness. */
#include <math.h>
#include <stdio.h>
#include "base/pi.h"
#include "sim/energy_balance.h"
#include "sim/moving_structure.h"
#include "support/small_world.h"
#include "support/verify.h"

static const fl_vec3 ZERO = {0, 0, 0};

static void start_world(lab *l)
{
    lab_start(l);
    lab_sphere(l, v3(1e3, 0, 0), 0.1, ZERO, ZERO); /* a world needs ice */
    lab_cone(l, (fl_cone){v3(0, 0, -1), v3(0, 0, 1), 0.5, 0.5});
}

/* Heave, roll and pitch of a closed box, afloat without ice, against 2 pi sqrt(m/C33) and the like. */
static void box_modes(void)
{
    const double L = 20, B = 8, T = 2, D = 5, rho = 1025, g = 9.81, kg = 0.3, m = rho * L * B * T;
    const fl_vec3 G = v3(3, -2, kg);
    const double w = rho * g, zB = -0.5 * T - kg, V = L * B * T;
    const double C[3] = {w * L * B, w * (L * B * B * B / 12 + V * zB), w * (B * L * L * L / 12 + V * zB)};
    const double I[3] = {m, m * 9.0, m * 40.0};
    static const char *const WHAT[3] = {"heave", "roll", "pitch"};
    lab l;
    start_world(&l);
    fl_part *none = &l.surface.part[0];
    none->nc = 0;
    lab_wall(&l, v3(3 - L / 2, -2 - B / 2, -T), v3(3 + L / 2, -2 + B / 2, D - T), 3);
    lab_set(&l, "water.density=1025");
    lab_set(&l, "run.gravity=9.81");
    lab_setf(&l, "structure.reference=%g %g %g", G.x, G.y, G.z);
    lab_set(&l, "structure.free=z rx ry");
    lab_setf(&l, "structure.mass=%.17g", m);
    lab_setf(&l, "structure.inertia=%.17g %.17g 0", I[1], I[2]);
    lab_set(&l, "structure.hydrostatic=mesh");
    lab_make(&l, 2e-3);
    const fl_hydrostatics *f = &l.w.moving.hydrostatics[0];
    verify_row("hull", "displaced volume of a box [m3]", f->volume, V, 1e-13, VERIFY_REL);
    verify_row("hull", "its centre of buoyancy over the keel [m]", f->buoyancy_centre.z + kg + T, 0.5 * T,
               1e-13, VERIFY_REL);
    for (int k = 0; k < 3; k++) {
        char what[64];
        snprintf(what, sizeof what, "C%d%d of the box", 3 + k, 3 + k);
        verify_row("hull", what, l.w.moving.movers.motion[0].K[2 + k][2 + k], C[k], 1e-12, VERIFY_REL);
    }
    for (int k = 0; k < 3; k++) { /* a small impulse, then the second zero crossing */
        fl_bodies *b = &l.w.moving.movers.b;
        char what[64];
        double before = 1.0, last = 0.0, first = 0.0;
        int found = 0;
        b->x[0] = G;
        b->q[0] = q_one();
        b->v[0] = v3(0, 0, k == 0 ? 0.01 : 0);
        fl_body_update_spin(b, 0);
        fl_body_set_spin(b, 0, v3(k == 1 ? 0.01 : 0, k == 2 ? 0.01 : 0, 0));
        b->f[0] = b->t[0] = ZERO;
        for (int64_t s = 1; found < 3 && s < 20000; s++) {
            lab_run(&l, 1);
            const double y = k == 0 ? b->x[0].z - kg : k == 1 ? b->q[0].x : b->q[0].y;
            if (s > 1 && (y < 0.0) != (before < 0.0)) {
                last = 2e-3 * ((double)s - y / (y - before));
                if (found++ == 0) first = last;
            }
            before = y;
        }
        snprintf(what, sizeof what, "period of %s [s]", WHAT[k]);
        verify_row("hull", what, last - first, 2.0 * PI * sqrt(I[k] / C[k]), 1e-5, VERIFY_REL);
    }
    lab_free(&l);
}

/* Wigley's hull, y = B/2 (1 - (2x/L)^2) (1 - (z/T)^2) below the water, wall-sided above it up to the deck,
 * as a mesh of n by n quadrangles per side.  V = 4/9 L B T, KB = 5/8 T, BM = 3 B^2/(35 T), int x^2 dA = L^3
 * B/30. */
static double wigley_y(double u, double v) { return (1 - u * u) * (v < 0 ? 1 - v * v : 1); }

static void wigley(int n, double L, double B, double T, fl_hydrostatics *f)
{
    fl_surface surface = {0};
    fl_err err = {0};
    const int32_t k = fl_surface_add(&surface, "hull", 4, &err);
    fl_part *p = &surface.part[k];
    const int rows = n + 1;
    for (int side = 0; side < 2; side++)
        for (int i = 0; i <= n; i++)
            for (int j = 0; j <= rows; j++) {
                const double u = 2.0 * i / n - 1.0, v = j <= n ? (double)j / n - 1.0 : 0.3;
                const double y = 0.5 * B * wigley_y(u, v);
                fl_surface_vertex(p, v3(0.5 * L * u, side ? y : -y, T * v), &err);
            }
    const int32_t all = (n + 1) * (rows + 1);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < rows; j++) {
            const int32_t a = i * (rows + 1) + j, b = a + rows + 1;
            fl_surface_triangle(p, a, b, b + 1, &err), fl_surface_triangle(p, a, b + 1, a + 1, &err);
            fl_surface_triangle(p, all + a, all + b + 1, all + b, &err);
            fl_surface_triangle(p, all + a, all + a + 1, all + b + 1, &err);
        }
    for (int i = 0; i < n; i++) { /* keel and deck; stem and stern, where both sides share points */
        const int32_t a = i * (rows + 1), b = a + rows + 1;
        fl_surface_triangle(p, a, all + a, all + b, &err), fl_surface_triangle(p, a, all + b, b, &err);
        fl_surface_triangle(p, a + rows, b + rows, all + b + rows, &err);
        fl_surface_triangle(p, a + rows, all + b + rows, all + a + rows, &err);
    }
    for (int end = 0; end < 2; end++)
        for (int j = 0; j < rows; j++) {
            const int32_t a = end * n * (rows + 1) + j, b = all + a;
            fl_surface_triangle(p, a, end ? b : a + 1, b + 1, &err);
            fl_surface_triangle(p, a, b + 1, end ? a + 1 : b, &err);
        }
    *f = (fl_hydrostatics){0};
    if (fl_hydrostatics_add(f, p, 0.0, ZERO, &err) || fl_hydrostatics_finish(f, 0.0, ZERO, &err))
        printf("wigley: %s\n", err.text);
    fl_surface_free(&surface);
}

static void wigley_meshes(void)
{
    const double L = 30, B = 6, T = 2.5, V = 4.0 / 9 * L * B * T;
    const double exact[4] = {V, -3.0 / 8 * T, 3 * B * B / (35 * T), L * L * L * B / 30};
    static const char *const WHAT[4] = {"displaced volume [m3]", "centre of buoyancy under water [m]",
                                        "BM [m]", "int x2 dA [m4]"};
    double h[3], e[4][3], got[4];
    for (int k = 0; k < 3; k++) {
        fl_hydrostatics f;
        wigley(20 << k, L, B, T, &f);
        h[k] = 1.0 / (20 << k);
        got[0] = f.volume, got[1] = f.buoyancy_centre.z, got[2] = f.yy / f.volume, got[3] = f.xx;
        for (int c = 0; c < 4; c++) e[c][k] = fabs(got[c] / exact[c] - 1.0);
    }
    verify_note(
        "Wigley's hull of 30 m, meshes of 20, 40 and 80 quadrangles per side and direction: their exact "
        "hydrostatics");
    for (int c = 0; c < 4; c++) {
        char what[64];
        verify_row("hull", WHAT[c], got[c], exact[c], 1e-3, VERIFY_REL);
        snprintf(what, sizeof what, "  against the mesh: %s", WHAT[c]);
        verify_order("hull", what, h, e[c], 3, 2.0, 0.1);
    }
}

/* Coupled heave and pitch: the two modes of K x = w^2 M x; a motion that starts in a mode stays in it. */
static void coupled_modes(void)
{
    const double m = 1000, I = 3000, C33 = 4e4, C55 = 1.5e5, C35 = -3e4;
    const double a = C33 / m, b = C55 / I, c2 = C35 * C35 / (m * I);
    for (int mode = 0; mode < 2; mode++) {
        const double w2 = 0.5 * (a + b) + (mode ? 0.5 : -0.5) * sqrt((a - b) * (a - b) + 4 * c2);
        const double shape = (w2 * m - C33) / C35; /* pitch over heave */
        const double w = sqrt(w2), small = 1e-4;
        double worst = 0.0;
        char what[64];
        lab l;
        start_world(&l);
        lab_set(&l, "structure.free=z ry");
        lab_setf(&l, "structure.mass=%g", m);
        lab_setf(&l, "structure.inertia=0 %g 0", I);
        lab_setf(&l, "structure.stiffness=0 0 %g", C33);
        lab_setf(&l, "structure.turn_stiffness=0 %g 0", C55);
        lab_setf(&l, "structure.coupling=0 %g 0", C35);
        lab_make(&l, 1e-3);
        fl_bodies *s = &l.w.moving.movers.b;
        s->v[0].z = small * w;
        fl_body_set_spin(s, 0, v3(0, small * w * shape, 0));
        for (int64_t k = 1; k <= 4000; k++) {
            lab_run(&l, 1);
            const double x = small * sin(w * 1e-3 * (double)k);
            worst = fmax(worst, fabs(s->x[0].z - x) / small);
            worst = fmax(worst, fabs(2.0 * s->q[0].y - shape * x) / (small * fmax(1.0, fabs(shape))));
        }
        snprintf(what, sizeof what, "heave and pitch coupled, mode of %.4g rad/s: error", w);
        verify_below("hull", what, worst, 1e-3);
        lab_free(&l);
    }
}

/* Roll with a dashpot: logarithmic decrement 2 pi D/sqrt(1 - D^2). */
static void roll_decrement(void)
{
    const double I = 2000, k = 8e4, D = 0.05, dt = 1e-3;
    double top[2] = {0}, before = 0.0, before2 = 0.0;
    int found = 0;
    lab l;
    start_world(&l);
    lab_set(&l, "structure.free=rx");
    lab_setf(&l, "structure.inertia=%g 0 0", I);
    lab_setf(&l, "structure.turn_stiffness=%g 0 0", k);
    lab_setf(&l, "structure.turn_damping=%.17g 0 0", 2 * D * sqrt(k * I));
    lab_make(&l, dt);
    fl_body_set_spin(&l.w.moving.movers.b, 0, v3(1e-3, 0, 0));
    for (int64_t n = 0; found < 2 && n < 10000; n++) {
        lab_run(&l, 1);
        const double x = 2.0 * l.w.moving.movers.b.q[0].x;
        if (before > 0.0 && before > before2 && before >= x) top[found++] = before;
        before2 = before;
        before = x;
    }
    verify_row("hull", "roll with D = 0.05: logarithmic decrement", log(top[0] / top[1]),
               2 * PI * D / sqrt(1 - D * D), 1e-3, VERIFY_REL);
    lab_free(&l);
}

/* Rotations of a radian and more on its own springs, all directions free: the energy. */
static double energy_change(double dt, double *turn)
{
    lab l;
    start_world(&l);
    lab_set(&l, "structure.free=x y z rx ry rz");
    lab_set(&l, "structure.mass=1000");
    lab_set(&l, "structure.inertia=900 2000 1500");
    lab_set(&l, "structure.stiffness=2e4 1e4 4e4");
    lab_set(&l, "structure.turn_stiffness=2e4 1e4 3e4");
    lab_set(&l, "structure.coupling=2000 -3000 4000");
    lab_make(&l, dt);
    fl_body_set_spin(&l.w.moving.movers.b, 0, v3(3, 2, -2));
    l.w.moving.movers.b.v[0] = v3(1, 2, -1);
    fl_energy_update(&l.w);
    const double e0 = l.w.ledger.structure + l.w.ledger.spring;
    double worst = 0.0;
    *turn = 0.0;
    for (int64_t k = 0; k < (int64_t)(10.0 / dt); k++) {
        lab_run(&l, 1);
        fl_energy_update(&l.w);
        worst = fmax(worst, fabs((l.w.ledger.structure + l.w.ledger.spring) / e0 - 1.0));
        const fl_quat q = l.w.moving.movers.b.q[0];
        *turn = fmax(*turn, 2.0 * asin(sqrt(q.x * q.x + q.y * q.y + q.z * q.z)));
    }
    lab_free(&l);
    return worst;
}

static void large_rotations(void)
{
    double h[3], e[3], turn;
    for (int k = 0; k < 3; k++) {
        h[k] = 0.02 / (1 << k);
        e[k] = energy_change(h[k], &turn);
    }
    verify_note("six degrees of freedom on coupled springs, turns of up to %.2g rad, 10 s", turn);
    verify_order("hull", "largest change of its energy", h, e, 3, 2.0, 0.3);
}

int main(void)
{
    verify_begin("hulls");
    box_modes();
    wigley_meshes();
    coupled_modes();
    roll_decrement();
    large_rotations();
    return verify_end();
}
