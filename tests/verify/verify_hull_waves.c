/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves on a floating structure: a box barge against closed forms of Froude and Krylov, and the load from
 * tables (water.wave_error) against the integral in each step. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "base/pi.h"
#include "sim/energy_balance.h"
#include "sim/moving_structure.h"
#include "sim/snapshot.h"
#include "support/small_world.h"
#include "support/verify.h"

#define G 9.81
#define RHO 1025.0
#define DRAFT (900.0 / 1025.0)

static const fl_vec3 ZERO = {0, 0, 0};

/* A box of length L along x, breadth B, draft T, height D, n by n panels a side; reference on its axis. */
typedef struct {
    double L, B, T, D, kg; /* kg: z of the reference */
    int n;
} barge;

static double mass_of(const barge *b) { return RHO * b->L * b->B * b->T; }

/* Moment of inertia about y of a box full of matter. */
static double pitch_inertia(const barge *b) { return mass_of(b) * (b->L * b->L + b->D * b->D) / 12; }

/* times: of the true mass and inertia */
static void start_barge(lab *l, const barge *b, const char *error, double times)
{
    const double m = times * mass_of(b), I = times * pitch_inertia(b);
    lab_start(l);
    lab_sphere(l, v3(b->L, 0, 0), 0.1, ZERO, ZERO); /* a world needs ice */
    lab_wall(l, v3(-b->L / 2, -b->B / 2, -b->T), v3(b->L / 2, b->B / 2, b->D - b->T), b->n);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.density=1025");
    lab_setf(l, "structure.reference=0 0 %g", b->kg);
    lab_set(l, "structure.free=x y z rx ry rz");
    lab_setf(l, "structure.mass=%.17g", m);
    lab_setf(l, "structure.inertia=%.17g %.17g %.17g", m * b->B * b->B / 8, I, I);
    lab_set(l, "structure.waves=mesh");
    lab_setf(l, "water.wave_error=%s", error);
}

static void set_airy(lab *l, double height, double length)
{
    lab_set(l, "water.wave=airy");
    lab_setf(l, "water.height=%.17g", height);
    lab_setf(l, "water.period=%.17g", 2 * PI / sqrt(2 * PI / length * G));
    lab_set(l, "water.drag_force_coef=0");
    lab_set(l, "water.drag_moment_coef=0");
}

/* Amplitudes of the load of a wave of amplitude 1 on the box at rest: surge, heave, pitch about the
 * reference. Bottom and ends under rho g e^kz cos(kx - omega t). */
static void froude_krylov(const barge *b, double k, double out[3])
{
    const double w = RHO * G * b->B, half = 0.5 * k * b->L, deep = exp(-k * b->T),
                 I0 = (1 - deep) / k,                             /* int e^kz dz */
        I1 = (-1 + deep * (k * b->T + 1)) / (k * k) - b->kg * I0; /* int (z - kg) e^kz dz */
    out[0] = 2 * w * sin(half) * I0;
    out[1] = w * deep * 2 / k * sin(half);
    out[2] = w * (deep * (2 / (k * k) * sin(half) - b->L / k * cos(half)) + 2 * sin(half) * I1);
}

/* First harmonic of y[n] over one period: factors of cos and sin. */
static void harmonic(int n, const double *y, double out[2])
{
    out[0] = out[1] = 0;
    for (int s = 0; s < n; s++) {
        out[0] += 2.0 / n * y[s] * cos(2 * PI * (s + 1) / n);
        out[1] += 2.0 / n * y[s] * sin(2 * PI * (s + 1) / n);
    }
}

/* Excitation of a box that is too heavy to move. */
static void excitation(void)
{
    enum { N = 256 };
    const barge b = {60, 15, 4, 8, 1.0, 6};
    static const double LENGTH[3] = {600, 100, 45};
    static const char *const ERROR[2] = {"none", "0.003"};
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 3; c++) {
            static double y[3][N];
            static const char *const WHAT[3] = {"surge force", "heave force", "pitch moment"};
            const double k = 2 * PI / LENGTH[c], period = 2 * PI / sqrt(G * k), a = LENGTH[c] / 40000;
            double want[3];
            lab l;
            if (verify_quick() && c == 1) continue;
            start_barge(&l, &b, ERROR[e], 1e9);
            set_airy(&l, 2 * a, LENGTH[c]);
            lab_make(&l, period / N);
            for (int s = 0; s < N; s++) {
                if (lab_run(&l, 1)) exit(1);
                const fl_floating_hull *h = &l.w.moving.movers.hulls.hull[0];
                y[0][s] = h->force.x / a, y[1][s] = h->force.z / a, y[2][s] = h->moment.y / a;
            }
            froude_krylov(&b, k, want);
            for (int m = 0; m < 3; m++) {
                double f[2];
                char what[96];
                harmonic(N, y[m], f);
                snprintf(what, sizeof what, "box of 60 m, %g m long waves, error %s: %s", LENGTH[c], ERROR[e],
                         WHAT[m]);
                verify_row("WV11", what, f[m != 1], m == 1 ? want[m] : -want[m], e ? 4e-3 : 1e-3, VERIFY_REL);
            }
            if (e)
                verify_note("%d points on %d triangles", l.w.moving.movers.hulls.hull[0].nodes.n,
                            l.w.moving.movers.hulls.hull[0].mesh.n);
            lab_free(&l);
        }
}

/* In a sea. */
static void set_sea(lab *l)
{
    lab_set(l, "water.wave=jonswap");
    lab_set(l, "water.height=2");
    lab_set(l, "water.period=8");
    lab_set(l, "water.components=100");
    lab_set(l, "structure.stiffness=2e5 2e5 0");
    lab_set(l, "structure.turn_stiffness=0 0 2e8");
    lab_setf(l, "structure.added_mass=%g %g %g", 2e5, 1e6, 3e6);
}

/* The panels of the evaluation in each step, `times` shorter. Its own are 0.03 off in the moment on a tilted
 * box, and 0.002 in the pitch of WV13, undamped, whose natural period is that of waves of 25 m. */
static void refine_panels(lab *l, double times)
{
    fl_err err = {0};
    fl_floating_hull *h = &l->w.moving.movers.hulls.hull[0];
    fl_waves shorter = l->w.sea.wave;
    shorter.k95 *= times;
    if (fl_hull_panels_make(&h->panels, &h->hull, &shorter, &err)) exit(1);
}

/* Load of a sea on a tilted box, too heavy to move, whose bottom and deck cross the water. */
static void tilted_box(void)
{
    enum { N = 100 };
    const barge b = {60, 15, 4, 8, 0.5, 6};
    static const char *const ERROR[3] = {"none", "0.003", "0.001"}, *const WHAT[3] = {"surge", "heave",
                                                                                      "pitch"};
    static double y[3][3][N];
    const double angle = 0.3;
    for (int e = 0; e < 3; e++) {
        lab l;
        if (verify_quick() && e == 2) continue;
        start_barge(&l, &b, ERROR[e], 1e9);
        set_sea(&l);
        lab_make(&l, 0.2);
        if (e == 0) refine_panels(&l, 3);
        fl_bodies *const mb = &l.w.moving.movers.b;
        mb->q[0] = (fl_quat){cos(0.5 * angle), 0, sin(0.5 * angle), 0};
        l.w.moving.movers.hulls.hull[0].block.level = FL_WAVE_NO_BLOCK;
        fl_moving_structure_second_half(&l.w, 0.0, 0.0);
        for (int s = 0; s < N; s++) {
            if (lab_run(&l, 1)) exit(1);
            const fl_floating_hull *h = &l.w.moving.movers.hulls.hull[0];
            y[e][0][s] = h->force.x, y[e][1][s] = h->force.z, y[e][2][s] = h->moment.y;
        }
        lab_free(&l);
        for (int m = 0; m < 3 && e; m++) {
            double mean = 0, off = 0, all = 0;
            char what[96];
            for (int s = 0; s < N; s++) mean += y[0][m][s] / N;
            for (int s = 0; s < N; s++)
                off += pow(y[e][m][s] - y[0][m][s], 2), all += pow(y[0][m][s] - mean, 2);
            snprintf(what, sizeof what, "tilted box, error %s: %s off that of each step", ERROR[e], WHAT[m]);
            verify_below("WV15", what, sqrt(off / all), e == 1 ? 0.012 : 0.004);
        }
    }
}

/* A free box in a regular wave, begun on its steady motion. */
static void free_motion(void)
{
    enum { N = 256, PERIODS = 4 };
    const barge b = {60, 15, 4, 8, 0.5, 6};
    static const double LENGTH[2] = {6000, 120}, ADDED[2] = {0, 0.8};
    static const char *const ERROR[2] = {"none", "0.003"};
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < 2; c++) {
            static double y[2][N];
            const double k = 2 * PI / LENGTH[c], omega = sqrt(G * k), a = LENGTH[c] / 40000, m = mass_of(&b),
                         added = ADDED[c] * m, w = RHO * G;
            const double C33 = w * b.L * b.B,
                         C55 = w * (b.B * b.L * b.L * b.L / 12 + b.L * b.B * b.T * (-0.5 * b.T - b.kg));
            double f[3], z[2], turn[2];
            char what[96];
            lab l;
            froude_krylov(&b, k, f);
            const double lift = f[1] - added * omega * omega * exp(-0.5 * k * b.T),
                         heave = lift / (C33 - (m + added) * omega * omega),
                         pitch = f[2] / (C55 - pitch_inertia(&b) * omega * omega),
                         surge = f[0] / (m * omega * omega);
            start_barge(&l, &b, ERROR[e], 1);
            set_airy(&l, 2 * a, LENGTH[c]);
            lab_setf(&l, "structure.added_mass=0 0 %.17g", added);
            lab_make(&l, 2 * PI / omega / N);
            fl_bodies *const mb = &l.w.moving.movers.b; /* the steady motion at t = 0 */
            mb->x[0].z = b.kg + heave * a;
            mb->v[0] = v3(surge * omega * a, 0, 0);
            fl_body_set_spin(mb, 0, v3(0, -pitch * omega * a, 0));
            l.w.moving.movers.hulls.hull[0].block.level = FL_WAVE_NO_BLOCK;
            fl_moving_structure_second_half(&l.w, 0.0, 0.0);
            for (int s = 0; s < N * PERIODS; s++) {
                if (lab_run(&l, 1)) exit(1);
                y[0][s % N] = (mb->x[0].z - b.kg) / a, y[1][s % N] = 2 * mb->q[0].y / a;
            }
            harmonic(N, y[0], z), harmonic(N, y[1], turn);
            snprintf(what, sizeof what, "free box, %g m long waves, error %s: heave over amplitude",
                     LENGTH[c], ERROR[e]);
            verify_row("WV12", what, z[0], heave, 2e-3, VERIFY_REL);
            snprintf(what, sizeof what, "  pitch over the slope of the wave");
            verify_row("WV12", what, -turn[1] / k, pitch / k, 4e-3, VERIFY_REL);
            if (c == 0)
                verify_row("WV12", "  it moves with the surface: heave over amplitude", z[0], 1, 2e-3,
                           VERIFY_ABS);
            lab_free(&l);
        }
}

static int hull_run(lab *l, double seconds, double dt, int stride, double (*y)[3])
{
    const int64_t steps = (int64_t)(seconds / dt + 0.5);
    int n = 0;
    for (int64_t s = 0; s < steps; s += stride) {
        if (lab_run(l, stride)) exit(1);
        const fl_bodies *b = &l->w.moving.movers.b;
        y[n][0] = b->x[0].x, y[n][1] = b->x[0].z, y[n++][2] = 2 * b->q[0].y;
    }
    return n;
}

static void sea_motion(void)
{
    enum { MOST = 1000 };
    static const char *const ERROR[4] = {"none", "0.01", "0.003", "0.001"};
    static const char *const WHAT[3] = {"surge", "heave", "pitch"};
    static const double SURGE[4] = {0, 0.012, 0.005, 0.003}; /* its springs are soft */
    static double y[4][MOST][3];
    const barge b = {60, 15, 4, 8, 0.5, 6};
    const double seconds = verify_quick() ? 10 : 100, dt = 0.02;
    int n = 0;
    for (int e = 0; e < 4; e++) {
        lab l;
        if (verify_quick() && (e == 1 || e == 3)) continue;
        start_barge(&l, &b, ERROR[e], 1);
        set_sea(&l);
        lab_make(&l, dt);
        if (e == 0) refine_panels(&l, verify_quick() ? 1 : 3);
        n = hull_run(&l, seconds, dt, 10, y[e]);
        fl_energy_update(&l.w);
        const double ledger = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
        const fl_floating_hull *h = &l.w.moving.movers.hulls.hull[0];
        char what[96];
        if (h->nodes.n) verify_note("error %s: %d points", ERROR[e], h->nodes.n);
        snprintf(what, sizeof what, "error %s: residual of the ledger over its throughput", ERROR[e]);
        verify_below("WV13", what, ledger, 1e-4);
        for (int m = 0; m < 3 && e; m++) {
            double off = 0, all = 0;
            for (int s = 0; s < n; s++) {
                off += (y[e][s][m] - y[0][s][m]) * (y[e][s][m] - y[0][s][m]);
                const double own = y[0][s][m] - (m == 1 ? b.kg : 0);
                all += own * own;
            }
            snprintf(what, sizeof what, "error %s: %s off that of an evaluation in each step", ERROR[e],
                     WHAT[m]);
            verify_below("WV13", what, sqrt(off / all), m == 0 ? SURGE[e] : 5e-3);
        }
        lab_free(&l);
    }
}

/* A hull among floes that it meets, on `threads`; stopped after `stop` steps and read again, 0: not. */
static uint64_t voyage(const char *error, int threads, int64_t stop, int64_t steps)
{
    const barge b = {20, 8, 2, 4, 0.5, 4};
    fl_err err = {0};
    lab l, next, *at = &l;
    for (int turn = 0; turn < 2; turn++) {
        lab *const o = turn ? &next : &l;
        if (turn && !stop) break;
        start_barge(o, &b, error, 1);
        set_sea(o);
        lab_set(o, "material.ice.young=2e6");
        lab_setf(o, "run.threads=%d", threads);
        for (int k = 0; k < (verify_quick() ? 40 : 100); k++)
            lab_box(o, v3(11.51 + 3.1 * (k / 20), -31.0 + 3.1 * (k % 20), 0.2 - 0.4 * DRAFT),
                    v3(1.5, 1.5, 0.2), 0.1, q_one(), ZERO, ZERO);
        lab_make(o, 5e-3);
    }
    if (stop) {
        char *text = NULL;
        size_t n = 0;
        fl_text in = {0};
        if (lab_run(&l, stop)) exit(1);
        FILE *f = open_memstream(&text, &n);
        fl_snapshot_write(f, &l.w);
        if (fclose(f) || fl_text_open_bytes(&in, "snapshot", text, (int64_t)n, &err) ||
            fl_snapshot_read(&next.w, &in, &err)) {
            fprintf(stderr, "%s\n", err.text);
            exit(1);
        }
        fl_text_close(&in);
        free(text);
        lab_free(&l);
        at = &next;
    }
    if (lab_run(at, steps - stop)) exit(1);
    fl_energy_update(&at->w);
    if (steps > 100 && at->w.contact_steps == 0) fprintf(stderr, "the hull has met no floe\n"), exit(1);
    const fl_floating_hull *h = &at->w.moving.movers.hulls.hull[0];
    uint64_t bits = fl_state_hash(&at->w);
    bits = fl_hash(bits, &h->work, sizeof h->work);
    bits = fl_hash(bits, &h->drag_loss, sizeof h->drag_loss);
    bits = fl_hash(bits, &at->w.ledger.residual, sizeof at->w.ledger.residual);
    lab_free(at);
    return bits;
}

static void same_bits(void)
{
    static const char *const ERROR[2] = {"none", "0.003"};
    const int64_t steps = verify_quick() ? 30 : 120;
    for (int e = verify_quick(); e < 2; e++) {
        const uint64_t bits = voyage(ERROR[e], 1, 0, steps);
        char what[96];
        int stops = 1;
        for (int64_t k = 1; k < steps; k += verify_quick() ? 29 : 17)
            stops &= voyage(ERROR[e], 1, k, steps) == bits;
        snprintf(what, sizeof what, "error %s: the same bytes on 1, 2 and 4 threads", ERROR[e]);
        verify_true("WV14", what,
                    voyage(ERROR[e], 2, 0, steps) == bits && voyage(ERROR[e], 4, 0, steps) == bits);
        snprintf(what, sizeof what, "error %s: and after a stop at any of many steps", ERROR[e]);
        verify_true("WV14", what, stops && voyage(ERROR[e], 2, steps / 2, steps) == bits);
    }
}

int main(void)
{
    verify_begin("waves on a floating structure");
    excitation();
    tilted_box();
    free_motion();
    sea_motion();
    same_bits();
    return verify_end();
}
