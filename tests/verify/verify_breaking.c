/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Floes that bend and split: sections, beams, wedges and cracks against closed forms and plates. */
#include <math.h>
#include <stdio.h>
#include "base/pi.h"
#include "failure/bending.h"
#include "failure/splitting.h"
#include "sim/critical_step.h"
#include "sim/energy_balance.h"
#include "sim/floe_cut.h"
#include "support/scenes.h"
#include "support/small_world.h"
#include "support/verify.h"
#include "world/access.h"

/* A convex plan from its corners. */
static fl_plan plan_of_corners(int n, const fl_vec2 *p, double h)
{
    fl_plan q = {.n = n, .thickness = h, .bottom = -0.5 * h};
    for (int k = 0; k < n; k++) q.p[k] = p[k];
    return q;
}

static fl_plan rectangle(double x0, double x1, double b, double h)
{
    const fl_vec2 p[4] = {{x0, -0.5 * b}, {x1, -0.5 * b}, {x1, 0.5 * b}, {x0, 0.5 * b}};
    return plan_of_corners(4, p, h);
}

/* FF12: rigid squares. */
static void rigid_squares(void)
{
    const double L = 7.0, h = 0.5, P = 1000.0;
    const fl_bending_law law = {.strength = 1.0, .young = 1e9, .wedges = 3};
    fl_plan q = rectangle(-0.5 * L, 0.5 * L, L, h);
    fl_plan_load at = {.x = {-0.5 * L, 0, 0}, .force = {0, 0, P}, .width = 100.0};
    fl_bending r = fl_bending_of(&q, &law, &at, 1, 0);
    verify_row("FF12", "load at mid side: M/(P L)", r.moment / (P * L), 4.0 / 27.0, 1e-10, VERIFY_REL);
    verify_row("FF12", "its place over L", r.distance / L, 1.0 / 3.0, 1e-5, VERIFY_REL);
    const double s = L / sqrt(2.0);
    const fl_vec2 corner[4] = {{-s, 0}, {0, -s}, {s, 0}, {0, s}};
    q = plan_of_corners(4, corner, h);
    at = (fl_plan_load){.x = {-s, 0, 0}, .force = {0, 0, P}, .width = 1e-3};
    r = fl_bending_of(&q, &law, &at, 1, 0);
    verify_row("FF12", "load at a corner: 6 M/b over P", r.ratio * h * h / P, 3.0, 0.01, VERIFY_REL);
}

/* FF11: beams of three lengths, until they break. */
static void beams(void)
{
    static const double L[3] = {5, 15, 60}, P[3] = {28.14, 9.728, 6.773}, X[3] = {1.666, 4.883, 7.494},
                        W[3] = {2.24, 0.272, 0.141};
    const fl_bending_law law = {.strength = 0.5e6, .young = 2e9, .foundation = 1025 * 9.81, .wedges = 3};
    verify_row("FF11", "l_b [m]", fl_bending_length(&law, 0.5), 9.5413, 1e-4, VERIFY_REL);
    for (int k = 0; k < 3; k++) {
        char what[80];
        const fl_plan q = rectangle(0, L[k], 1.0, 0.5);
        const fl_plan_load at = {.x = {0, 0, 0}, .force = {0, 0, 1000.0}, .width = 1.0};
        const fl_bending r = fl_bending_of(&q, &law, &at, 1, 0);
        double width[FL_BEAM_NODES], M[FL_BEAM_NODES], end;
        for (int n = 0; n < FL_BEAM_NODES; n++) width[n] = 1.0;
        snprintf(what, sizeof what, "beam of %g m: load that breaks it [kN/m]", L[k]);
        verify_row("FF11", what, 1.0 / r.ratio, P[k], 0.01, VERIFY_REL);
        snprintf(what, sizeof what, "beam of %g m: place [m]", L[k]);
        verify_row("FF11", what, r.distance, X[k], 0.03, VERIFY_REL);
        fl_bending_beam(&law, 0.5, L[k], width, 1000.0 / r.ratio, 0.0, M, &end);
        snprintf(what, sizeof what, "beam of %g m: deflection of its end [m]", L[k]);
        verify_row("FF11", what, end, W[k], k ? 0.01 : 0.03, VERIFY_REL);
    }
}

/* FF13: wedges against plates. */
static void wedges(void)
{
    static const double OPENING[2] = {60, 90}, P[2] = {0.2415, 0.4067},
                        X[2] = {0.51, 0.51}; /* place: Nevel */
    const double h = 1.0, nu = 0.3;
    const fl_bending_law law = {
        .strength = 0.5e6, .young = 2e9 / (1 - nu * nu), .foundation = 1025 * 9.81, .wedges = 3};
    const double l = sqrt(sqrt(2e9 / (1 - nu * nu) * h * h * h / 12.0 / law.foundation));
    for (int k = 0; k < 2; k++) {
        char what[80];
        const double R = 8 * l, t = tan(0.5 * OPENING[k] * PI / 180.0);
        const fl_vec2 p[3] = {{0, 0}, {R, -R * t}, {R, R * t}};
        const fl_plan q = plan_of_corners(3, p, h);
        /* a pressure on a sector of radius a acts at its centre, 2/3 a from the tip in a narrow one */
        const double at = 0.1 * l * 2.0 / 3.0;
        const fl_plan_load load = {.x = {at, 0, 0}, .force = {0, 0, 1e5}, .width = 2 * at * t};
        const fl_bending r = fl_bending_of(&q, &law, &load, 1, 0);
        snprintf(what, sizeof what, "wedge of %g deg: P/(s_f h2)", OPENING[k]);
        verify_row("FF13", what, 1e5 / r.ratio / (law.strength * h * h), P[k], 0.04, VERIFY_REL);
        snprintf(what, sizeof what, "wedge of %g deg: place over l", OPENING[k]);
        verify_row("FF13", what, (r.distance + at) / l, X[k], 0.1, VERIFY_REL);
    }
}

/* FF14: a floe that is carried at both ends in air. */
static void carried(void)
{
    const double h = 0.5, rho = 900, g = 9.81, b = 1.0;
    const fl_bending_law law = {.strength = 0.5e6, .young = 2e9, .wedges = 3};
    double from = 4.0, to = 9.0;
    for (int k = 0; k < 40; k++) {
        const double L = 0.5 * (from + to), P = 0.5 * rho * g * h * b * L;
        const fl_plan q = rectangle(-0.5 * L, 0.5 * L, b, h);
        const fl_plan_load both[2] = {{.x = {-0.5 * L, 0, 0}, .force = {0, 0, P}, .width = b},
                                      {.x = {0.5 * L, 0, 0}, .force = {0, 0, P}, .width = b}};
        if (fl_bending_of(&q, &law, both, 2, 0).ratio > 1.0) to = L;
        else from = L;
    }
    verify_row("FF14", "length that breaks by its weight, carried at its ends [m]", from, 6.14, 0.01,
               VERIFY_REL);
}

/* FF15, FF16: cracks. */
static void cracks(void)
{
    static const double L[3] = {10, 40, 160}, Q[3] = {88.6, 177.3, 354.6};
    for (int k = 0; k < 3; k++) {
        char what[80];
        const fl_split_line s = {.Q = 1e3, .length = L[k], .breadth = L[k], .thickness = 1.0, .width = 0.01};
        snprintf(what, sizeof what, "pair that splits a square of %g m [kN]", L[k]);
        verify_row("FF15", what, 150e3 / fl_split_intensity(&s), Q[k], 0.05, VERIFY_REL);
    }
    static const double MU[3] = {0, 0.15, 0.3}, F[3] = {697, 1575, INFINITY};
    for (int k = 0; k < 3; k++) {
        char what[80];
        const double t = 1.0, part = (t - MU[k]) / (2.0 * (1.0 + MU[k] * t));
        const fl_split_line s = {
            .Q = 1e3 * part, .F = 1e3, .length = 40, .breadth = 40, .thickness = 1.0, .width = 2};
        const double force = 150e3 / fl_split_intensity(&s);
        snprintf(what, sizeof what, "pile that splits a square of 40 m, friction %g [kN]", MU[k]);
        if (k < 2) verify_row("FF16", what, force, F[k], 0.05, VERIFY_REL);
        else verify_true("FF16", "pile with friction 0.3 closes every crack", !(force > 0.0));
    }
}

/* FF17: a cut keeps mass, momentum, spin and kinetic energy. */
static void halves(void)
{
    lab l;
    int32_t child;
    fl_err err = {0};
    lab_start(&l);
    lab_set(&l, "material.ice.density=900");
    lab_set(&l, "failure.flexural_strength=0.5 MPa");
    lab_box(&l, v3(0, 0, 0), v3(5, 3, 0.5), 0.05, q_one(), v3(0.4, -0.1, 0.05), v3(0.02, -0.03, 0.1));
    lab_make(&l, 1e-3);
    fl_world *const w = &l.w;
    const fl_bodies *b = &w->b;
    const fl_vec3 p0 = v3_scale(b->m[0], b->v[0]), L0 = v3_add(b->L[0], v3_cross(b->x[0], p0));
    const double m0 = b->m[0], T0 = fl_body_kinetic_energy(b, 0), c = PI / 6.0;
    /* the plane is given in the pose of the file */
    const fl_vec3 n = v3(cos(c), sin(c), 0), body_n = q_rotate(q_conj(b->q[0]), n);
    verify_true("FF17", "the box is cut",
                fl_floe_cut(w, 0, body_n, v3_dot(n, v3_sub(v3(1.2, 0.5, 0), b->x[0])), &child, &err) == 1);
    static const fl_vec3 V[2] = {{0.426693, -0.267861, -0.005697}, {0.350672, 0.210194, 0.152924}};
    static const double VOLUME[2] = {38.932051, 21.067949};
    const int32_t half[2] = {0, child};
    fl_vec3 p = v3(0, 0, 0), L = v3(0, 0, 0);
    double m = 0.0, T = 0.0;
    for (int k = 0; k < 2; k++) {
        const int32_t i = half[k];
        const fl_vec3 pi = v3_scale(b->m[i], b->v[i]);
        p = v3_add(p, pi), L = v3_add(L, v3_add(b->L[i], v3_cross(b->x[i], pi)));
        m += b->m[i], T += fl_body_kinetic_energy(b, i);
        verify_row("FF17", k ? "volume of the smaller half [m3]" : "volume of the larger half [m3]",
                   b->m[i] / 900, VOLUME[k], 5e-7, VERIFY_ABS);
        verify_row("FF17", k ? "its velocity, error [m/s]" : "its velocity, error [m/s]",
                   v3_norm(v3_sub(b->v[i], V[k])), 0.0, 2e-6, VERIFY_ABS);
    }
    verify_row("FF17", "mass", m / m0, 1.0, 1e-12, VERIFY_REL);
    verify_row("FF17", "kinetic energy", T / T0, 1.0, 1e-12, VERIFY_REL);
    verify_row("FF17", "momentum, error over |p|", v3_norm(v3_sub(p, p0)) / v3_norm(p0), 0.0, 1e-12,
               VERIFY_ABS);
    verify_row("FF17", "spin about the origin, error over |L|", v3_norm(v3_sub(L, L0)) / v3_norm(L0), 0.0,
               1e-12, VERIFY_ABS);
    fl_energy_update(w);
    verify_below("FF17", "residual of the ledger over the kinetic energy", fabs(w->ledger.residual) / T0,
                 1e-12);
    lab_free(&l);
}

/* The place of a driven floe that has left is not that of a fragment, which would be driven. */
static void place_of_a_driven_floe(void)
{
    lab l;
    int32_t child = -1;
    fl_err err = {0};
    lab_start(&l);
    lab_set(&l, "material.ice.density=900");
    lab_set(&l, "failure.flexural_strength=0.5 MPa");
    lab_set(&l, "boundary.drive=0.1 0 0");
    lab_set(&l, "boundary.drive_width=4");
    lab_set(&l, "boundary.type=free");
    lab_box(&l, v3(0, 0, 0), v3(5, 3, 0.5), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_box(&l, v3(-30, 0, 0), v3(2, 2, 0.5), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-3);
    verify_true("place", "the floe at the edge is driven", fl_floe_is_driven(&l.w, 1));
    l.w.inflow.absent[1] = 1;
    verify_true("place", "the box is cut", fl_floe_cut(&l.w, 0, v3(1, 0, 0), 1.0, &child, &err) == 1);
    verify_true("place", "its fragment is not driven", child > 1 && !fl_floe_is_driven(&l.w, child));
    lab_free(&l);
}

/* The critical step of a square plate that two whole faces hold, or one along its rim; *least: the area that
 * fl_least_fragment_area() gives for a step of dt. */
static double critical_of_plate(double side, double h, int rim, double dt, double *least)
{
    const double r = 0.01 * h, deep = 1.6 * r, half = 0.5 * side;
    lab l;
    lab_start(&l);
    lab_set(&l, "failure.flexural_strength=0.5 MPa");
    lab_box(&l, v3(0, 0, 0), v3(half, half, 0.5 * h), r, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_wall(&l, v3(-9, -9, -0.5 * h - 5), v3(rim ? -0.8 * half : 9, 9, -0.5 * h + deep), 1);
    if (!rim) lab_wall(&l, v3(-9, -9, 0.5 * h - deep), v3(9, 9, 0.5 * h + 5), 1);
    lab_make(&l, dt);
    *least = fl_least_fragment_area(&l.w, 0, h);
    const double critical = l.w.dt_critical;
    lab_free(&l);
    return critical;
}

/* The step bears the smallest fragment. */
static void least_fragment(void)
{
    static const double H[2] = {0.2, 2.0}, DT[2] = {1e-4, 4e-4};
    for (int k = 0; k < 4; k++) {
        const double h = H[k / 2], dt = DT[k / 2];
        double least, same;
        char what[100];
        critical_of_plate(1.0, h, 0, dt, &least);
        const double critical = critical_of_plate(sqrt(least), h, k % 2, dt, &same);
        snprintf(what, sizeof what, "%.3g m2, %g m thick, held %s: step over critical", least, h,
                 k % 2 ? "at a rim" : "on two faces");
        verify_below("least", what, dt / critical, FL_DAMPED_SHARE_MIN);
    }
}

/* Many floes that break: their mass stays, fragments do not move apart by themselves, the ledger closes. */
static void many(void)
{
    lab l;
    scene_of_failing_floes(&l, 3, "patch");
    lab_make(&l, 0);
    fl_world *const w = &l.w;
    double before = 0.0, after = 0.0;
    for (int32_t i = 0; i < w->n; i++) before += w->inflow.absent[i] ? 0.0 : w->b.m[i];
    lab_run(&l, verify_quick() ? 300 : 1000);
    for (int32_t i = 0; i < w->n; i++) after += w->inflow.absent[i] ? 0.0 : w->b.m[i];
    fl_energy_update(w);
    verify_note("%lld bent, %lld split, %.3g m3 crushed in %lld steps", (long long)w->breaking.bent,
                (long long)w->breaking.split, w->crushing.volume, (long long)w->step);
    verify_true("many", "more than 10 breaks", w->breaking.bent + w->breaking.split > 10);
    verify_row("many", "mass of all floes", after / before, 1.0, 1e-9, VERIFY_REL);
    verify_below("many", "residual of the ledger over the throughput",
                 fabs(w->ledger.residual) / w->ledger.throughput, 1e-4);
    lab_free(&l);
}

int main(void)
{
    verify_begin("bending and splitting of floes");
    rigid_squares();
    beams();
    wedges();
    carried();
    cracks();
    halves();
    place_of_a_driven_floe();
    least_fragment();
    many();
    return verify_end();
}
