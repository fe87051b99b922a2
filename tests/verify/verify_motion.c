/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moving structures: prescribed motion, motion on springs, and free motion among ice; hulls are in
 * verify_hull. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/pi.h"
#include "sim/energy_balance.h"
#include "sim/moving_structure.h"
#include "support/small_world.h"
#include "support/verify.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* A prescribed track as a file, and the scene key for it. */
static void set_track(lab *l, int n, const double *t, const double *x, const double *rz)
{
    const char *tmp = getenv("TMPDIR");
    char path[200];
    snprintf(path, sizeof path, "%.150s/floe-track-XXXXXX", tmp && tmp[0] ? tmp : "/tmp");
    const int fd = mkstemp(path);
    FILE *f = fd < 0 ? NULL : fdopen(fd, "w");
    if (!f) exit(1);
    fprintf(f, "#track 1\nt[s]\tx[m]\trz[deg]\n");
    for (int k = 0; k < n; k++) fprintf(f, "%.17g\t%.17g\t%.17g\n", t[k], x[k], rz ? rz[k] : 0.0);
    fclose(f);
    lab_setf(l, "structure.track=%s", path);
}

/* Makes the world, with its prescribed track read. */
static void make_world(lab *l, double dt)
{
    char path[FL_SCENE_PATH];
    memcpy(path, l->scene.structure.motion.track, sizeof path);
    lab_make(l, dt);
    if (path[0]) unlink(path);
}

static void start_world(lab *l)
{
    lab_start(l);
    lab_sphere(l, v3(1e3, 0, 0), 0.1, ZERO, ZERO); /* a world needs ice */
    lab_cone(l, (fl_cone){v3(0, 0, -1), v3(0, 0, 1), 0.5, 0.5});
}

/* --- prescribed motion -------------------------------------------------------------------------------- */

/* Largest error of a track of n intervals against sin(2 t) and 0.5 sin(3 t): displacement, velocity,
 * position of a piece. */
static void track_error(int n, const char *between, double *way, double *speed)
{
    enum { MOST = 161 };
    double t[MOST], x[MOST], rz[MOST];
    lab l;
    start_world(&l);
    for (int k = 0; k <= n; k++) {
        t[k] = 2.0 * k / n;
        x[k] = sin(2.0 * t[k]);
        rz[k] = 0.5 * sin(3.0 * t[k]) * 180.0 / PI;
    }
    set_track(&l, n + 1, t, x, rz);
    lab_setf(&l, "structure.interpolation=%s", between);
    make_world(&l, 2e-3);
    *way = *speed = 0.0;
    for (int k = 1; k <= 1000; k++) {
        lab_run(&l, 1);
        const double now = 2e-3 * k;
        if (now < 0.25 || now > 1.75) continue; /* the ends are of order 3 */
        *way = fmax(*way, fabs(l.w.moving.movers.b.x[0].x - sin(2.0 * now)));
        *speed = fmax(*speed, fabs(l.w.moving.movers.b.v[0].x - 2.0 * cos(2.0 * now)));
        *speed = fmax(*speed, fabs(l.w.moving.movers.b.w[0].z - 1.5 * cos(3.0 * now)));
    }
    lab_free(&l);
}

static void prescribed_track(void)
{
    static const int N[3] = {40, 80, 160};
    double h[3], way[3], speed[3], straight[3], none;
    for (int k = 0; k < 3; k++) {
        h[k] = 2.0 / N[k];
        track_error(N[k], "cubic", &way[k], &speed[k]);
        track_error(N[k], "linear", &straight[k], &none);
    }
    verify_note("a track of sin(2 t) and a turn of 0.5 sin(3 t), rows h apart; largest error inside");
    verify_order("track", "cubic: way", h, way, 3, 4.0, 0.3);
    verify_order("track", "cubic: velocity and spin", h, speed, 3, 3.0, 0.3);
    verify_order("track", "linear: way", h, straight, 3, 2.0, 0.2);

    lab l;
    start_world(&l);
    lab_set(&l, "structure.velocity=0.3 -0.1 0");
    lab_set(&l, "structure.spin=0 0 2 rad/s");
    lab_set(&l, "structure.reference=1 0 0");
    lab_make(&l, 1e-3);
    lab_run(&l, 3000);
    const fl_vec3 at = v3(1 + 0.9 - cos(6.0), -0.3 - sin(6.0), -1);
    verify_row("spin", "position of a piece after 6 rad about a point 1 m off [m]",
               v3_norm(v3_sub(l.w.b.x[1], at)), 0.0, 1e-13, VERIFY_ABS);
    const fl_vec3 speed_then = v3(0.3 + 2.0 * sin(6.0), -0.1 - 2.0 * cos(6.0), 0);
    verify_row("spin", "its velocity [m/s]", v3_norm(v3_sub(l.w.b.v[1], speed_then)), 0.0, 1e-13, VERIFY_ABS);
    lab_free(&l);
}

/* A box clamped between two plates that rotate continuously about a line that is none of its axes, and move
 * along it.  Nothing slips; friction springs that creep would stretch with each turn. */
static void clamp_in_rotation(void)
{
    double pull[2][2], normal[2], h[2];
    for (int k = 0; k < 2; k++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "contact.friction=1");
        lab_set(&l, "contact.restitution=0.3");
        lab_set(&l, "material.ice.young=20 MPa");
        lab_set(&l, "structure.spin=1 2 0.7 rad/s");
        lab_box(&l, v3(0, 0.1, 0), v3(0.45, 0.35, 0.2), 0.05, q_one(), v3(-0.07, 0, 0.1), v3(1, 2, 0.7));
        lab_wall(&l, v3(-1, -1, 0.198), v3(1, 1, 0.698), 1);
        lab_wall(&l, v3(-1, -1, -0.698), v3(1, 1, -0.198), 1);
        h[k] = k ? 2e-4 : 4e-4;
        lab_make(&l, h[k]);
        for (int late = 0; late < 2; late++) {
            lab_run(&l, (int64_t)((late ? 15.0 : 5.0) / h[k] + 0.5));
            const fl_vec3 n = m3_col(fl_body_axes(&l.w.b, 0), 2), f = lab_pair(&l, 0).force;
            normal[k] = fabs(v3_dot(n, f));
            pull[k][late] = v3_norm(v3_madd(f, -v3_dot(n, f), n));
        }
        lab_free(&l);
    }
    verify_note(
        "a box clamped between plates that rotate at (1, 2, 0.7) rad/s, friction 1, 0.1 m off their centre");
    verify_below("clamped", "creep of friction from 5 to 20 s, over the clamping force",
                 fabs(pull[1][1] - pull[1][0]) / normal[1], 1e-4);
    verify_below("clamped", "  over the same at twice the step",
                 fabs(pull[1][1] - pull[1][0]) / fabs(pull[0][1] - pull[0][0]), 0.3);
    verify_below("clamped", "clamping force: relative change by the step", fabs(normal[0] / normal[1] - 1.0),
                 3e-7); /* the velocities at its end are predicted to order 2 */
}

/* --- on springs --------------------------------------------------------------------------------------- */

/* Displacement of a mass at time s after the other end of its spring and dashpot has stepped by 1:
 *     x = 1 - exp(-D w s) (cos wd s - D w/wd sin wd s),  wd = w sqrt(1 - D^2);
 * the dashpot gives the mass the velocity 2 D w at once. */
static double step_response(double D, double s)
{
    const double w = 2.0 * PI, wd = w * sqrt(1.0 - D * D);
    return 1.0 - exp(-D * w * s) * (cos(wd * s) - D * w / wd * sin(wd * s));
}

/* Largest value of step_response(). */
static double overshoot(double D)
{
    double top = 0.0;
    for (int k = 0; k < 100000; k++) top = fmax(top, step_response(D, 1e-5 * k));
    return top;
}

/* A step of the spring's other end by 1 m, in one time step; D = 0 is the response to a sudden load.
 * Largest error of the displacement; its extremes and zero crossings. */
static double run_step_response(double D, double dt, double *period, double *decrement, double *peak)
{
    const double t[4] = {-1, dt, 2 * dt, 1e3}, x[4] = {0, 0, 1, 1};
    double worst = 0.0, before = 0.0, cross[2] = {0}, top = 0.0, bottom = 2.0;
    int crossed = 0;
    lab l;
    start_world(&l);
    set_track(&l, 4, t, x, NULL);
    lab_set(&l, "structure.interpolation=linear");
    lab_set(&l, "structure.free=x");
    lab_set(&l, "structure.mass=1000");
    lab_set(&l, "structure.period=1 0 0 s");
    lab_setf(&l, "structure.damping_ratio=%.17g 0 0", D);
    make_world(&l, dt);
    const int64_t steps = (int64_t)lround(3.0 / dt);
    for (int64_t k = 1; k <= steps; k++) {
        lab_run(&l, 1);
        const double now = l.w.moving.movers.b.x[0].x, time = (double)k * dt;
        const double exact = step_response(D, time - 1.5 * dt);
        if (k > 2) worst = fmax(worst, fabs(now - exact));
        if (before < 1.0 && now >= 1.0 && crossed < 2)
            cross[crossed++] = time - dt * (now - 1.0) / (now - before);
        if (now > top && crossed == 1) top = now;
        if (crossed == 1 && now < bottom) bottom = now;
        before = now;
    }
    *period = cross[1] - cross[0];
    *peak = top;
    *decrement = log((top - 1.0) / (1.0 - bottom)) * 2.0;
    lab_free(&l);
    return worst;
}

static void step_responses(void)
{
    double h[4], free_error[4], damped_error[4], period, decrement, peak;
    verify_note("1000 kg on a spring of 1 s, damping ratio D; its other end steps by 1");
    for (int k = 0; k < 4; k++) {
        h[k] = 0.02 / (1 << k);
        free_error[k] = run_step_response(0.0, h[k], &period, &decrement, &peak);
        if (k == 3) {
            verify_row("step", "dynamic factor, D = 0", peak, 2.0, 1e-4, VERIFY_REL);
            verify_row("step", "period, D = 0 [s]", period, 1.0, 1e-4, VERIFY_REL);
        }
        damped_error[k] = run_step_response(0.05, h[k], &period, &decrement, &peak);
    }
    const double d = 0.05, root = sqrt(1.0 - d * d);
    verify_row("step", "dynamic factor, D = 0.05", peak, overshoot(d), 1e-4, VERIFY_REL);
    verify_row("step", "period, D = 0.05 [s]", period, 1.0 / root, 1e-4, VERIFY_REL);
    verify_row("step", "logarithmic decrement, D = 0.05", decrement, 2.0 * PI * d / root, 2e-3, VERIFY_REL);
    verify_order("step", "largest error of the displacement, D = 0", h, free_error, 4, 2.0, 0.2);
    verify_order("step", "largest error of the displacement, D = 0.05", h, damped_error, 4, 2.0, 0.2);
    run_step_response(0.9, 0.1, &period, &decrement, &peak);
    verify_row("step", "D = 0.9, a tenth of a period per step: largest displacement", peak, overshoot(0.9),
               5e-2, VERIFY_REL);
}

/* The other end oscillates with 1 m at the frequency ratio r: amplitude of the mass, after the transient
 * has decayed. */
static double run_transmissibility(double r, double D, double dt)
{
    enum { ROWS = 4001 };
    static double t[ROWS], x[ROWS];
    double top = 0.0, low = 0.0;
    lab l;
    start_world(&l);
    for (int k = 0; k < ROWS; k++) {
        t[k] = 0.01 * k;
        x[k] = sin(2.0 * PI * r * t[k]);
    }
    set_track(&l, ROWS, t, x, NULL);
    lab_set(&l, "structure.free=x");
    lab_set(&l, "structure.mass=1000");
    lab_set(&l, "structure.period=1 0 0 s");
    lab_setf(&l, "structure.damping_ratio=%.17g 0 0", D);
    make_world(&l, dt);
    lab_run(&l, (int64_t)(30.0 / dt));
    for (int64_t k = 0; k < (int64_t)(2.0 / r / dt); k++) {
        lab_run(&l, 1);
        top = fmax(top, l.w.moving.movers.b.x[0].x);
        low = fmin(low, l.w.moving.movers.b.x[0].x);
    }
    lab_free(&l);
    return 0.5 * (top - low);
}

static void transmissibility(void)
{
    const double D = 0.1, R[4] = {0.5, 1.0, sqrt(2.0), 2.5};
    verify_note(
        "transmissibility of a spring and a dashpot, D = 0.1: sqrt((1 + 4 D2 r2)/((1 - r2)2 + 4 D2 r2))");
    for (int k = 0; k < 4; k++) {
        const double r2 = R[k] * R[k], drag = 4.0 * D * D * r2;
        char what[64];
        snprintf(what, sizeof what, "frequency ratio %.4g", R[k]);
        verify_row("shaken", what, run_transmissibility(R[k], D, 2e-3),
                   sqrt((1 + drag) / ((1 - r2) * (1 - r2) + drag)), 1e-3, VERIFY_REL);
    }
}

/* A dashpot alone, c h/m up to 1e6: v = v0 exp(-c t/m), never beyond zero. */
static void dashpot(void)
{
    static const double C[3] = {1.0, 1e3, 1e6};
    for (int k = 0; k < 3; k++) {
        char what[96];
        lab l;
        start_world(&l);
        lab_set(&l, "structure.free=x");
        lab_set(&l, "structure.mass=1");
        lab_setf(&l, "structure.damping=%g 0 0", C[k]);
        lab_make(&l, 1.0);
        l.w.moving.movers.b.v[0].x = 1.0;
        lab_run(&l, 2);
        snprintf(what, sizeof what, "a dashpot of c t/m = %g: rest of a speed of 1 m/s", 2.0 * C[k]);
        verify_row("damper", what, l.w.moving.movers.b.v[0].x, exp(-2.0 * C[k]), 1e-15, VERIFY_ABS);
        fl_energy_update(&l.w);
        verify_row("damper", "  energy that it dissipated [J]", l.w.ledger.damper,
                   0.5 - 0.5 * exp(-4.0 * C[k]), 1e-15, VERIFY_ABS);
        lab_free(&l);
    }
}

/* --- among the ice ------------------------------------------------------------------------------------ */

static fl_vec3 total_momentum(const lab *l, fl_vec3 *turn)
{
    const fl_bodies *b = &l->w.b, *s = &l->w.moving.movers.b;
    fl_vec3 p = ZERO;
    *turn = ZERO;
    for (int32_t i = 0; i < l->w.n + l->w.moving.movers.n; i++) {
        const fl_bodies *a = i < l->w.n ? b : s;
        const int32_t k = i < l->w.n ? i : i - l->w.n;
        p = v3_madd(p, a->m[k], a->v[k]);
        *turn = v3_add(*turn, v3_madd(a->L[k], a->m[k], v3_cross(a->x[k], a->v[k])));
    }
    return p;
}

/* Floes run into a box from all sides. */
static void add_fleet(lab *l, double friction, double restitution)
{
    lab_start(l);
    lab_setf(l, "contact.friction=%g", friction);
    lab_setf(l, "contact.restitution=%g", restitution);
    lab_set(l, "material.ice.young=1 MPa");
    for (int k = 0; k < 8; k++) {
        const double a = 2.0 * PI * k / 8 + 0.2, r = 3.0 + 0.1 * k;
        lab_box(l, v3(r * cos(a), r * sin(a), 0.03 * k), v3(0.5, 0.4, 0.3), 0.05,
                q_of_vector(v3(0.1, 0.05 * k, a)), v3(-cos(a + 0.1), -sin(a + 0.1), 0.02 * k),
                v3(0.1, 0, 0.2));
    }
    lab_wall(l, v3(-1, -1, -1), v3(1, 1, 1), 2);
}

/* A sphere hits a block that is free along x: velocities afterwards, for a restitution e. */
static void sphere_on_free_block(void)
{
    const double e = 0.4, m = 4.0 / 3.0 * PI * 0.125 * 900;
    for (int k = 0; k < 3; k++) {
        const double M = k == 0 ? 0.1 * m : k == 1 ? m : 100 * m;
        char what[96];
        lab l;
        lab_start(&l);
        lab_set(&l, "contact.restitution=0.4");
        lab_set(&l, "material.ice.young=10 MPa");
        lab_set(&l, "run.safety=0.02");
        lab_sphere(&l, v3(-1.52, 0, 0), 0.5, v3(1, 0, 0), ZERO);
        lab_wall(&l, v3(-1, -1, -1), v3(1, 1, 1), 1);
        lab_set(&l, "structure.free=x");
        lab_setf(&l, "structure.mass=%.17g", M);
        lab_make(&l, 0);
        for (int64_t n = 0; n < 1000000 && (n < 10 || l.w.pair[0].touching || l.w.contact_steps == 0); n++)
            if (lab_run(&l, 1)) break;
        snprintf(what, sizeof what, "a sphere on a free block of %g of its mass: its speed after", M / m);
        verify_row("free", what, l.w.b.v[0].x, (m - e * M) / (m + M), 1e-4, VERIFY_ABS);
        verify_row("free", "  that of the block", l.w.moving.movers.b.v[0].x, m * (1 + e) / (m + M), 4e-3,
                   VERIFY_ABS);
        lab_free(&l);
    }
}

/* A sphere hits a gate that rotates about an axis: the effective mass of the gate is I/a^2. */
static void sphere_on_gate(void)
{
    const double e = 0.4, m = 4.0 / 3.0 * PI * 0.125 * 900, a = 1.5, I = 0.7 * m * a * a, M = I / (a * a);
    lab l;
    lab_start(&l);
    lab_set(&l, "contact.restitution=0.4");
    lab_set(&l, "material.ice.young=10 MPa");
    lab_set(&l, "run.safety=0.02");
    lab_sphere(&l, v3(-0.62, a, 0), 0.5, v3(1, 0, 0), ZERO);
    lab_wall(&l, v3(-0.1, 0, -1), v3(0.1, 2, 1), 1);
    lab_set(&l, "structure.free=rz");
    lab_setf(&l, "structure.inertia=0 0 %.17g", I);
    lab_make(&l, 0);
    for (int64_t n = 0; n < 1000000 && (n < 10 || l.w.pair[0].touching || l.w.contact_steps == 0); n++)
        if (lab_run(&l, 1)) break;
    verify_row("free", "a sphere on a gate of 0.7 of its mass: its speed after", l.w.b.v[0].x,
               (m - e * M) / (m + M), 3e-3, VERIFY_ABS);
    verify_row("free", "  angular velocity of the gate [rad/s]", l.w.moving.movers.b.w[0].z,
               -m * (1 + e) / (m + M) / a, 3e-3, VERIFY_ABS);
    lab_free(&l);
}

/* A structure that moves towards the ice is loaded like one that the ice moves towards. */
static void galilean_invariance(void)
{
    fl_vec3 impulse[2];
    for (int k = 0; k < 2; k++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "contact.restitution=0.4");
        lab_set(&l, "contact.friction=0.3");
        lab_set(&l, "material.ice.young=10 MPa");
        lab_box(&l, v3(-1.62, 0.2, 0.1), v3(0.5, 0.4, 0.3), 0.05, q_of_vector(v3(0.1, 0.2, 0.3)),
                k ? ZERO : v3(1, 0.3, 0), ZERO);
        lab_wall(&l, v3(-1, -1, -1), v3(1, 1, 1), 1);
        if (k) lab_set(&l, "structure.velocity=-1 -0.3 0");
        lab_make(&l, 1e-4);
        lab_run(&l, 5000);
        impulse[k] = l.w.part_impulse[0];
        lab_free(&l);
    }
    verify_row("frame", "relative change of the impulse by the frame",
               v3_norm(v3_sub(impulse[1], impulse[0])) / v3_norm(impulse[0]), 0.0, 1e-9, VERIFY_ABS);
}

static void fleet_on_free_box(void)
{
    fl_vec3 turn0, turn;
    lab l;
    add_fleet(&l, 0.3, 0.4);
    lab_set(&l, "structure.free=x y z rx ry rz");
    lab_set(&l, "structure.mass=3000");
    lab_set(&l, "structure.inertia=2500 2000 1500");
    lab_make(&l, 0);
    const fl_vec3 before = total_momentum(&l, &turn0);
    const double size = 8.0 * l.w.b.m[0], arm = 3.0 * size;
    lab_run(&l, (int64_t)(4.0 / l.w.dt));
    const fl_vec3 after = total_momentum(&l, &turn);
    verify_note("eight floes run into a box that is free; friction and restitution");
    verify_true("free", "they have touched", l.w.contact_steps > 100);
    verify_row("free", "linear momentum gained, over m v of the floes", v3_norm(v3_sub(after, before)) / size,
               0.0, 1e-13, VERIFY_ABS);
    verify_row("free", "angular momentum gained", v3_norm(v3_sub(turn, turn0)) / arm, 0.0, 1e-13, VERIFY_ABS);
    verify_below("free", "0.01 m/s over the final speed of the box", 0.01 / v3_norm(l.w.moving.movers.b.v[0]),
                 1.0);
    lab_free(&l);
}

/* The ledger of a box on springs, with rotations; also with a moving anchor and damping.  The residual may
 * have either sign, and neighbouring scenes have different ones: the root mean square over NEIGHBOURS of
 * them has an order. */
enum { NEIGHBOURS = 8 };

static double residual_of(double safety, int damped, double restitution)
{
    lab l;
    add_fleet(&l, 0.0, restitution);
    lab_set(&l, "structure.mass=3000");
    if (damped) {
        lab_set(&l, "structure.velocity=0.2 0.1 0");
        lab_set(&l, "structure.free=x z rx rz");
        lab_set(&l, "structure.inertia=2500 0 1500");
        lab_set(&l, "structure.stiffness=2e5 0 1e5");
        lab_set(&l, "structure.turn_stiffness=1e5 0 1e5");
        lab_set(&l, "structure.damping=1e4 0 1e4");
        lab_set(&l, "structure.turn_damping=1e4 0 1e4");
    } else {
        lab_set(&l, "structure.free=x y z rx ry rz");
        lab_set(&l, "structure.inertia=2500 2000 1500");
        lab_set(&l, "structure.stiffness=2e5 1e5 1e5");
        lab_set(&l, "structure.turn_stiffness=1e5 1e5 1e5 N.m");
    }
    lab_setf(&l, "run.safety=%g", safety);
    lab_make(&l, 0);
    lab_run(&l, (int64_t)(4.0 / l.w.dt));
    fl_energy_update(&l.w);
    const double r = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    lab_free(&l);
    return r;
}

static double rms_residual(double safety, int damped)
{
    double sum = 0.0;
    for (int k = 0; k < NEIGHBOURS; k++) {
        const double r = residual_of(safety, damped, 0.4 + 0.002 * k);
        sum += r * r;
    }
    return sqrt(sum / NEIGHBOURS);
}

/* A prescribed motion through the ice: the work of the drive. */
static double drive_through_ice(double safety, int spin)
{
    lab l;
    add_fleet(&l, 0.0, 0.4);
    lab_set(&l, "structure.velocity=0.4 0.1 0");
    if (spin) lab_set(&l, "structure.spin=0 0.3 0.5");
    lab_setf(&l, "run.safety=%g", safety);
    lab_make(&l, 0);
    lab_run(&l, (int64_t)(4.0 / l.w.dt));
    fl_energy_update(&l.w);
    const double r = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
    lab_free(&l);
    return r;
}

static void ledger_of_moving_structure(void)
{
    double h[3], sprung[3], damped[3], prescribed[3];
    const double closed = 5e-6; /* of the throughput, at the automatic step */
    verify_note("eight floes with restitution 0.4 and the box: residual of the ledger over the throughput");
    for (int k = 0; k < 3; k++) {
        h[k] = 0.2 / (1 << k);
        sprung[k] = rms_residual(h[k], 0);
        damped[k] = rms_residual(h[k], 1);
        prescribed[k] = drive_through_ice(h[k], 0);
    }
    verify_below("ledger", "on springs, 6 degrees of freedom, automatic step", sprung[1], closed);
    verify_order("ledger", "on springs", h, sprung, 3, 2.0, 0.5);
    verify_below("ledger", "damped, its anchor moving, automatic step", damped[1], closed);
    verify_order("ledger", "damped, its anchor moving", h, damped, 3, 2.0, 0.5);
    /* of either sign, for no loss has one sign here */
    verify_below("ledger", "prescribed motion, automatic step", prescribed[1], closed);
    verify_below("ledger", "prescribed motion, half of it", prescribed[2], 0.5 * closed);
    /* here cores overlap for a while, where the energy has a kink */
    verify_below("ledger", "prescribed motion and rotation, automatic step", drive_through_ice(0.1, 1), 1e-4);
}

int main(void)
{
    verify_begin("structures in motion");
    prescribed_track();
    clamp_in_rotation();
    step_responses();
    transmissibility();
    dashpot();
    sphere_on_free_block();
    sphere_on_gate();
    galilean_invariance();
    fleet_on_free_box();
    ledger_of_moving_structure();
    return verify_end();
}
