/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spheres in the solver: the tests of Chung & Ooi, Granular Matter 13 (2011) 643, damping, rolling, spheres
 * between walls.
 *
 * The tangential model verified here is the incremental spring of law/tangent.h: dF = -k_t dv, k_t = 2 (1 -
 * nu)/(2 - nu) of the tangent normal stiffness (Mindlin without partial slip), reduced with it on unloading
 * after Thornton. */
#include <math.h>
#include <stdio.h>
#include "base/pi.h"
#include "law/damping.h"
#include "law/manual.h"
#include "law/material.h"
#include "law/normal.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "support/small_world.h"
#include "support/verify.h"

#define HALF_DIGIT 5.01e-6 /* tolerance of a table printed to five decimals */

typedef struct {
    const char *name;
    double young, poisson, density;
} material;

static const material GLASS = {"glass", 48e9, 0.20, 2800}, LIMESTONE = {"limestone", 20e9, 0.25, 2500},
                      ALUMINIUM = {"aluminium", 70e9, 0.30, 2699},
                      MAGNESIUM = {"magnesium", 40e9, 0.35, 1800},
                      OXIDE = {"aluminium oxide", 380e9, 0.23, 4000}, IRON = {"cast iron", 100e9, 0.25, 7000},
                      ALLOY = {"aluminium alloy", 70e9, 0.33, 2700}, NYLON = {"nylon", 2.5e9, 0.40, 1000};

static void set_material(lab *l, const material *m)
{
    lab_setf(l, "material.ice.young=%.17g", m->young);
    lab_setf(l, "material.ice.poisson=%.17g", m->poisson);
    lab_setf(l, "material.ice.density=%.17g", m->density);
}

/* "what of": valid until the next call. */
static const char *label(const char *what, const char *of)
{
    static char line[160];
    snprintf(line, sizeof line, "%.70s %.70s", of, what);
    return line;
}

/* --- one impact --------------------------------------------------------------------------------------- */

typedef struct {
    double force, depth, time; /* largest normal force [N] and overlap [m]; duration [s] */
} impact;

/* Peak of the parabola through three values at equal distances, y[1] the largest. */
static double parabola_peak(const double *y)
{
    const double bend = y[0] - 2.0 * y[1] + y[2], slope = 0.5 * (y[2] - y[0]);
    return bend < 0.0 ? y[1] - 0.5 * slope * slope / bend : y[1];
}

/* Steps until pair 0 has touched and is apart again; at most `most` steps.  The surfaces touch at t = 0. */
static impact collide(lab *l, int64_t most)
{
    impact r = {0};
    double s[3] = {0}, f[3] = {0};
    fl_pair p = lab_pair(l, 0);
    for (int64_t k = 0; k < most; k++) {
        if (lab_run(l, 1)) break;
        p = lab_pair(l, 0);
        s[0] = s[1], s[1] = s[2], s[2] = p.touching ? p.overlap : 0.0;
        f[0] = f[1], f[1] = f[2], f[2] = p.touching ? v3_norm(p.force) : 0.0;
        if (s[1] >= s[0] && s[1] >= s[2]) r.depth = fmax(r.depth, parabola_peak(s));
        if (f[1] >= f[0] && f[1] >= f[2]) r.force = fmax(r.force, parabola_peak(f));
        if (p.touching == 0 && r.depth > 0.0) break;
    }
    /* Contact ends inside the last step: subtract the gap over the speed of separation. */
    const fl_bodies *b = &l->w.b;
    const fl_vec3 n = p.j < l->w.n ? v3_unit(v3_sub(b->x[p.i], b->x[p.j])) : v3(0, 0, 1);
    const double R = b->radius[p.i] + b->radius[p.j], gap = v3_dot(n, v3_sub(b->x[p.i], b->x[p.j])) - R,
                 apart = v3_dot(n, v3_sub(b->v[p.i], b->v[p.j]));
    r.time = (double)l->w.step * l->w.dt - (apart > 0.0 ? gap / apart : 0.0);
    return r;
}

static void head_on_spheres(lab *l, const material *m, const char *law, double R, double v)
{
    lab_start(l);
    set_material(l, m);
    lab_setf(l, "contact.law=%s", law);
    lab_sphere(l, v3(-R, 0, 0), R, v3(v, 0, 0), v3(0, 0, 0));
    lab_sphere(l, v3(R, 0, 0), R, v3(-v, 0, 0), v3(0, 0, 0));
}

/* A sphere that touches the rigid plane z = 0. */
static void sphere_on_plane(lab *l, const material *m, double R, fl_vec3 v, fl_vec3 spin)
{
    lab_start(l);
    set_material(l, m);
    lab_set(l, "boundary.min=none none 0");
    lab_sphere(l, v3(0, 0, R), R, v, spin);
}

static void spheres_of_glass(void)
{
    const struct {
        const material *m;
        double force, depth, time;
    } row[] = {{&GLASS, 10.697e3, 274.11e-6, 40.339e-6}, {&LIMESTONE, 7.1082e3, 368.30e-6, 54.201e-6}};
    const char *const law[] = {"patch", "core"};
    const double R = 0.01, v = 10.0;
    for (int k = 0; k < 2; k++) {
        for (int c = 0; c < 2; c++) {
            lab l;
            head_on_spheres(&l, row[k].m, law[c], R, v);
            lab_make(&l, row[k].time / 2000);
            const impact r = collide(&l, 4000);
            char of[40];
            snprintf(of, sizeof of, "%s, %s:", row[k].m->name, law[c]);
            verify_row("V01", label("largest force [N]", of), r.force, row[k].force, 1e-3, VERIFY_REL);
            verify_row("V01", label("largest overlap [m]", of), r.depth, row[k].depth, 1e-3, VERIFY_REL);
            verify_row("V01", label("duration [s]", of), r.time, row[k].time, 1e-3, VERIFY_REL);
            verify_row("V01", label("rebound over impact speed", of), -l.w.b.v[0].x / v, 1.0, 1e-6,
                       VERIFY_REL);
            lab_free(&l);
        }
    }
    /* against the closed form: d = (5 M v^2/4 k)^(2/5), v the approach speed */
    enum { N = 4 };
    double h[N], error[N];
    for (int k = 0; k < N; k++) {
        lab l;
        head_on_spheres(&l, &GLASS, "patch", R, v);
        lab_make(&l, h[k] = row[0].time / (50 << k));
        const fl_pair p = lab_pair(&l, 0);
        const double kappa = p.k, M = p.mass, depth = pow(1.25 * M * 4.0 * v * v / kappa, 0.4),
                     force = kappa * depth * sqrt(depth);
        error[k] = fabs(collide(&l, 200 << k).force / force - 1.0);
        lab_free(&l);
    }
    verify_order("V01", "glass: largest force against the step [s]", h, error, N, 2.0, 0.3);
}

static void impact_on_plane(void)
{
    const struct {
        const material *m;
        double force, depth, time;
    } row[] = {{&ALUMINIUM, 11.370e3, 49.717e-6, 731.66e-6}, {&MAGNESIUM, 7.2327e3, 52.123e-6, 767.07e-6}};
    const double R = 0.1, v = 0.2;
    for (int k = 0; k < 2; k++) {
        lab l;
        sphere_on_plane(&l, row[k].m, R, v3(0, 0, -v), v3(0, 0, 0));
        lab_make(&l, row[k].time / 2000);
        const impact r = collide(&l, 4000);
        verify_row("V02", label("on a plane: largest force [N]", row[k].m->name), r.force, row[k].force, 1e-3,
                   VERIFY_REL);
        verify_row("V02", label("largest overlap [m]", row[k].m->name), r.depth, row[k].depth, 1e-3,
                   VERIFY_REL);
        verify_row("V02", label("duration [s]", row[k].m->name), r.time, row[k].time, 1e-3, VERIFY_REL);
        verify_row("V02", label("rebound over impact speed", row[k].m->name), l.w.b.v[0].z / v, 1.0, 1e-6,
                   VERIFY_REL);
        lab_free(&l);
    }
    lab l; /* the same on a structure of triangles, a thousand times as stiff as the sphere */
    lab_start(&l);
    set_material(&l, &ALUMINIUM);
    lab_set(&l, "material.steel.young=7e13");
    lab_sphere(&l, v3(0.013, 0.021, R), R, v3(0, 0, -v), v3(0, 0, 0));
    lab_wall(&l, v3(-1, -1, -1), v3(1, 1, 0), 4);
    lab_make(&l, row[0].time / 2000);
    const impact r = collide(&l, 4000);
    verify_row("V02", "aluminium on a stiff structure: force [N]", r.force, 11.365e3, 1e-3, VERIFY_REL);
    lab_free(&l);
}

static void damped_impact(void)
{
    const struct {
        const material *m;
        double force, depth, time;
    } row[] = {{&OXIDE, 615.35, 8.0888e-6, 6.1045e-6}, {&IRON, 506.76, 17.189e-6, 12.972e-6}};
    const double R = 0.0025, v = 3.9;
    for (int k = 0; k < 2; k++) {
        for (int e = 2; e <= 10; e++) {
            lab l;
            sphere_on_plane(&l, row[k].m, R, v3(0, 0, -v), v3(0, 0, 0));
            lab_setf(&l, "contact.restitution=%.1f", 0.1 * e);
            lab_make(&l, row[k].time / 2000);
            const impact r = collide(&l, 20000);
            verify_row("V03", label("rebound over impact speed", row[k].m->name), l.w.b.v[0].z / v, 0.1 * e,
                       0.002, VERIFY_ABS);
            if (e == 10) {
                verify_row("V03", label("e = 1: largest force [N]", row[k].m->name), r.force, row[k].force,
                           1e-3, VERIFY_REL);
                verify_row("V03", label("e = 1: largest overlap [m]", row[k].m->name), r.depth, row[k].depth,
                           1e-3, VERIFY_REL);
                verify_row("V03", label("e = 1: duration [s]", row[k].m->name), r.time, row[k].time, 1e-3,
                           VERIFY_REL);
            }
            lab_free(&l);
        }
    }
}

/* --- oblique impacts ---------------------------------------------------------------------------------- */

static double tangential_ratio(const material *m) { return 2.0 * (1.0 - m->poisson) / (2.0 - m->poisson); }

/* The oblique impact on a rigid plane from the equations alone, in one plane and with the lever arm R:
 * Hertz, the damping factor 1 + chi s', and the tangential model of the heading, whose damping is k_t/k_n
 * chi F_elastic.  Returns e_t. */
static double oblique_impact(const material *m, double R, double v, double angle, double e, double mu)
{
    const double mass = m->density * 4.0 / 3.0 * PI * R * R * R, inertia = 0.4 * mass * R * R,
                 k = 4.0 / 3.0 * m->young / (1.0 - m->poisson * m->poisson) * sqrt(R),
                 ratio = tangential_ratio(m), chi = fl_damping_hunt_crossley(e) / (v * cos(angle)),
                 dt = 3.0 * pow(mass * mass / (k * k * v), 0.2) / 100000;
    double s = 0.0, u = v * cos(angle), vt = v * sin(angle), w = 0.0, spring = 0.0, fn = 0.0, ft = 0.0,
           kt = 0.0;
    do {
        u -= 0.5 * dt * fn / mass, vt += 0.5 * dt * ft / mass, w -= 0.5 * dt * ft * R / inertia;
        s += dt * u;
        const double elastic = k * s * sqrt(fmax(s, 0.0)), now = ratio * 1.5 * k * sqrt(fmax(s, 0.0)),
                     slip = vt - R * w;
        fn = fmax(elastic * (1.0 + chi * u), 0.0);
        if (now < kt) spring *= now / kt;
        kt = now;
        spring -= kt * slip * dt;
        if (fabs(spring) > mu * fn) {
            ft = spring = copysign(mu * fn, spring);
        } else {
            ft = spring - ratio * chi * elastic * slip;
            if (fabs(ft) > mu * fn) ft = copysign(mu * fn, ft);
        }
        u -= 0.5 * dt * fn / mass, vt += 0.5 * dt * ft / mass, w -= 0.5 * dt * ft * R / inertia;
    } while (s > 0.0);
    return vt / (v * sin(angle));
}

static void oblique_impacts(void)
{
    const struct {
        int angle;
        double et, spin, rebound;
    } slide[] = {{30, 0.6845, 615.3, -3.52}, {40, 0.7829, 544.2, 11.62}, {50, 0.8471, 456.7, 29.49},
                 {60, 0.8948, 355.2, 48.16}, {70, 0.9337, 243.0, 65.09}, {80, 0.9679, 123.4, 78.98}};
    const int stick[] = {5, 10, 20};
    verify_note("without unloading and damping an incremental spring gives e_t = 0.890, 0.713, 0.610");
    const double R = 0.0025, v = 3.9, time = 6.1045e-6;
    for (int k = 0; k < 9; k++) {
        const int angle = k < 3 ? stick[k] : slide[k - 3].angle;
        const double a = angle * PI / 180.0;
        lab l;
        sphere_on_plane(&l, &OXIDE, R, v3(v * sin(a), 0, -v * cos(a)), v3(0, 0, 0));
        lab_set(&l, "contact.restitution=0.98");
        lab_set(&l, "contact.friction=0.092");
        lab_setf(&l, "contact.tangential_ratio=%.17g", tangential_ratio(&OXIDE));
        lab_make(&l, time / 4000);
        collide(&l, 8000);
        const double vt = l.w.b.v[0].x, vn = l.w.b.v[0].z, spin = l.w.b.w[0].y;
        char of[40];
        snprintf(of, sizeof of, "%d degrees:", angle);
        if (k < 3) {
            verify_row("V04", label("sticks: e_t, Thornton's unloading", of), vt / (v * sin(a)),
                       oblique_impact(&OXIDE, R, v, a, 0.98, 0.092), 0.02, VERIFY_ABS);
        } else {
            const int j = k - 3;
            verify_row("V04", label("slides: e_t", of), vt / (v * sin(a)), slide[j].et, 0.002, VERIFY_REL);
            verify_row("V04", label("spin [rad/s]", of), spin, slide[j].spin, 0.002, VERIFY_REL);
            /* 0.2 % of the tangential impact velocity, as an angle */
            verify_row("V04", label("rebound of the contact [degrees]", of),
                       atan2(vt - R * spin, vn) * 180.0 / PI, slide[j].rebound, 0.2, VERIFY_ABS);
        }
        lab_free(&l);
    }
}

static void spinning_impacts(void)
{
    const double spin[] = {4.5, 7.0, 14.0, 21.0}, R = 0.1, v = 0.2;
    const material *const m[] = {&ALLOY, &NYLON};
    for (int c = 0; c < 2; c++) {
        for (int k = 0; k < 8; k++) {
            const double sign = k < 4 ? 1.0 : -1.0, w0 = sign * spin[k % 4];
            lab l;
            sphere_on_plane(&l, m[c], R, v3(0, 0, -v), v3(0, w0, 0));
            lab_set(&l, "contact.restitution=0.5");
            lab_set(&l, "contact.friction=0.4");
            lab_setf(&l, "contact.tangential_ratio=%.17g", tangential_ratio(m[c]));
            lab_make(&l, 0);
            l.w.dt *= 0.02;
            collide(&l, 1000000);
            char of[60];
            snprintf(of, sizeof of, "%s, %g rad/s:", m[c]->name, w0);
            verify_row("V06", label("speed along [m/s]", of), l.w.b.v[0].x, sign * 0.12, 3e-3, VERIFY_REL);
            verify_row("V06", label("loss of spin [rad/s]", of), w0 - l.w.b.w[0].y, sign * 3.0, 3e-3,
                       VERIFY_REL);
            lab_free(&l);
        }
    }
}

static void spinning_spheres(void)
{
    const double spin[] = {0.175, 5.0, 21.0}, R = 0.1, v = 0.2;
    const material *const m[] = {&ALLOY, &NYLON};
    for (int c = 0; c < 2; c++) {
        for (int k = 0; k < 3; k++) {
            lab l;
            lab_start(&l);
            set_material(&l, m[c]);
            lab_set(&l, "contact.restitution=0.5");
            lab_set(&l, "contact.friction=0.4");
            lab_sphere(&l, v3(-R, 0, 0), R, v3(v, 0, 0), v3(0, spin[k], 0));
            lab_sphere(&l, v3(R, 0, 0), R, v3(-v, 0, 0), v3(0, -spin[k], 0));
            lab_make(&l, 0);
            collide(&l, 1000000);
            char of[60];
            snprintf(of, sizeof of, "%s, %g rad/s:", m[c]->name, spin[k]);
            verify_row("V07", label("spin after [rad/s]", of), l.w.b.w[0].y, spin[k], 1e-9, VERIFY_REL);
            verify_row("V07", label("speed along after [m/s]", of), hypot(l.w.b.v[0].y, l.w.b.v[0].z), 0.0,
                       1e-9 * v, VERIFY_ABS);
            verify_row("V07", label("rebound over impact speed", of), -l.w.b.v[0].x / v, 0.5, 0.002,
                       VERIFY_ABS);
            lab_free(&l);
        }
    }
}

/* --- damping ------------------------------------------------------------------------------------------ */

/* M s'' = -F(s, s') from s = 0, s' = v, by the classical Runge-Kutta method; returns -s'(end)/v.  The contact
 * ends when s is 0 again (attract), or when F falls to 0.  The last step is shortened onto the end by
 * secants. */
typedef struct {
    int tsuji;
    double k, M, c; /* c: zeta, or alpha */
} dashpot;

static double contact_force(const dashpot *d, double s, double u)
{
    const double n = d->tsuji ? 1.5 : 1.0, x = s > 0.0 ? s : 0.0;
    return d->k * fl_normal_power(x, n) + fl_manual_damping(d->k, n, x, d->M, d->c, d->c, u);
}

static void runge_kutta(const dashpot *d, double h, double *s, double *u)
{
    const double a1 = -contact_force(d, *s, *u) / d->M, u1 = *u;
    const double u2 = *u + 0.5 * h * a1, a2 = -contact_force(d, *s + 0.5 * h * u1, u2) / d->M;
    const double u3 = *u + 0.5 * h * a2, a3 = -contact_force(d, *s + 0.5 * h * u2, u3) / d->M;
    const double u4 = *u + h * a3, a4 = -contact_force(d, *s + h * u3, u4) / d->M;
    *s += h / 6.0 * (u1 + 2.0 * u2 + 2.0 * u3 + u4);
    *u += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

static double integrate_rebound(const dashpot *d, double v, double h, int attract)
{
    double s = 0.0, u = v;
    for (int64_t k = 0; k < 100000000; k++) {
        double s1 = s, u1 = u;
        runge_kutta(d, h, &s1, &u1);
        if (u1 < 0.0 && (attract ? s1 : contact_force(d, s1, u1)) <= 0.0) {
            double lo = 0.0, hi = h;
            for (int j = 0; j < 60; j++) {
                const double mid = 0.5 * (lo + hi);
                s1 = s, u1 = u;
                runge_kutta(d, mid, &s1, &u1);
                if (u1 < 0.0 && (attract ? s1 : contact_force(d, s1, u1)) <= 0.0) hi = mid;
                else lo = mid;
            }
            return -u1 / v;
        }
        s = s1, u = u1;
    }
    return NAN;
}

static void damping_equations(void)
{
    const struct {
        double e, attract, clip, alpha_attract, alpha_clip;
    } row[] = {{0.9, 0.03352, 0.03427, 0.07495, 0.07662}, {0.8, 0.07085, 0.07436, 0.15843, 0.16626},
               {0.7, 0.11281, 0.12221, 0.25225, 0.27328}, {0.6, 0.16049, 0.18086, 0.35887, 0.40441},
               {0.5, 0.21545, 0.25528, 0.48177, 0.57081}, {0.4, 0.28000, 0.35451, 0.62609, 0.79270},
               {0.3, 0.35786, 0.49724, 0.80019, 1.11186}, {0.2, 0.45595, 0.73125, 1.01953, 1.63512},
               {0.1, 0.59116, 1.24319, 1.32186, 2.77985}};
    for (int k = 0; k < 9; k++) {
        const double e = row[k].e, le = log(e), pull_zeta = -le / sqrt(PI * PI + le * le);
        char of[20];
        snprintf(of, sizeof of, "e = %.1f:", e);
        verify_row("V09", label("zeta that never pulls", of), fl_damping_linear(e), row[k].clip, HALF_DIGIT,
                   VERIFY_ABS);
        verify_row("V09", label("zeta that pulls", of), pull_zeta, row[k].attract, HALF_DIGIT, VERIFY_ABS);
        const dashpot clip = {0, 1e6, 2.0, fl_damping_linear(e)}, both = {0, 1e6, 2.0, pull_zeta};
        verify_row("V09", label("restitution, without attraction, by integration", of),
                   integrate_rebound(&clip, 0.3, 2e-6, 0), e, 1e-4, VERIFY_REL);
        verify_row("V09", label("restitution, with attraction, by integration", of),
                   integrate_rebound(&both, 0.3, 2e-6, 1), e, 1e-4, VERIFY_REL);
        const dashpot tsuji = {1, 1e8, 2.0, fl_damping_tsuji(e)};
        verify_row("V09", label("Tsuji's alpha, fitted", of), fl_damping_tsuji(e), row[k].alpha_clip, 2e-3,
                   VERIFY_REL);
        verify_row("V09", label("restitution by Tsuji, by integration", of),
                   integrate_rebound(&tsuji, 0.3, 2e-6, 0), e, 2e-3, VERIFY_REL);
    }
}

/* Two equal boxes face to face along x, through the solver; returns rebound over impact speed. */
static double restitution_of_boxes(const char *law, const char *exponent, double e, int fine)
{
    lab l;
    lab_start(&l);
    lab_setf(&l, "contact.law=%s", law);
    lab_setf(&l, "contact.exponent=%s", exponent);
    lab_setf(&l, "contact.restitution=%.17g", e);
    lab_set(&l, "material.ice.young=1e8");
    lab_box(&l, v3(-0.5, 0, 0), v3(0.5, 0.5, 0.5), 0.1, q_one(), v3(0.1, 0, 0), v3(0, 0, 0));
    lab_box(&l, v3(0.5, 0, 0), v3(0.5, 0.5, 0.5), 0.1, q_one(), v3(-0.1, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0);
    l.w.dt /= fine;
    collide(&l, INT64_C(2000) * (fine + 1));
    const double got = -l.w.b.v[0].x / 0.1;
    lab_free(&l);
    return got;
}

/* Head on, two spheres of law `law`. */
static double restitution_of_spheres(const char *law, double e, int fine)
{
    lab l;
    head_on_spheres(&l, &NYLON, law, 0.1, 0.1);
    lab_setf(&l, "contact.restitution=%.17g", e);
    lab_make(&l, 0);
    l.w.dt /= fine;
    collide(&l, INT64_C(2000) * (fine + 1));
    const double got = -l.w.b.v[0].x / 0.1;
    lab_free(&l);
    return got;
}

static void damping_in_solver(void)
{
    for (int k = 1; k <= 9; k += verify_quick() ? 4 : 1) {
        char of[30];
        snprintf(of, sizeof of, "e = %.1f, solver:", 0.1 * k);
        verify_row("V09", label("boxes by manual-si", of),
                   restitution_of_boxes("manual-si", "1", 0.1 * k, 500), 0.1 * k, 1e-4, VERIFY_ABS);
        verify_row("V09", label("spheres by manual (Tsuji)", of),
                   restitution_of_spheres("manual", 0.1 * k, 100), 0.1 * k, 2e-3, VERIFY_REL);
    }
}

/* Impact on a sphere that is held in some directions (FL_DOF_X | ...), at any mass, or has added mass
 * `water` times the mass of the other one; or of a box, along x alone. */
static double restitution_on_held(const char *law, double radius, int box, unsigned hold, double water,
                                  double e)
{
    const fl_vec3 none = v3(0, 0, 0), x = v3(1.5 + radius, 0, 0);
    lab l;
    lab_start(&l);
    lab_setf(&l, "contact.law=%s", law);
    lab_setf(&l, "contact.restitution=%.17g", e);
    lab_sphere(&l, none, 1.0, v3(1, 0, 0), none);
    if (box) lab_box(&l, x, v3(radius, radius, radius), 0.05, q_one(), none, none);
    else lab_sphere(&l, x, radius, none, none);
    lab_make(&l, 0);
    const int32_t flies = l.w.b.v[0].x > 0.0 ? 0 : 1;
    l.w.b.fixed_dof[1 - flies] = (uint8_t)hold;
    if (water > 0.0) {
        fl_err err = {0};
        if (fl_bodies_alloc_added_mass(&l.w.b, &err)) exit(1);
        const double m = water * l.w.b.m[flies];
        l.w.b.added_mass[1 - flies] = box ? v3(m, 0, 0) : v3(m, m, m);
    }
    l.w.dt /= 20.0;
    while (l.w.b.v[flies].x > 0.0 || l.w.b.x[flies].x > 0.1)
        if (lab_run(&l, 100)) break;
    const double got = l.w.b.v[1 - flies].x - l.w.b.v[flies].x;
    lab_free(&l);
    return got;
}

static void hunt_crossley(void)
{
    const int fine = verify_quick() ? 100 : 1000;
    verify_row("V10", "D of Hunt-Crossley for e = 0.5", fl_damping_hunt_crossley(0.5), 1.432751, 1e-6,
               VERIFY_REL);
    verify_row("V10", "boxes by patch: e", restitution_of_boxes("patch", "1", 0.5, fine), 0.5, 1e-5,
               VERIFY_ABS);
    verify_row("V10", "boxes by core, n = 1: e", restitution_of_boxes("core", "1", 0.5, fine), 0.5, 1e-5,
               VERIFY_ABS);
    verify_row("V10", "boxes by core, n = 3/2: e", restitution_of_boxes("core", "1.5", 0.5, fine), 0.5, 1e-5,
               VERIFY_ABS);
    verify_row("V10", "spheres by patch, n = 3/2: e", restitution_of_spheres("patch", 0.5, fine), 0.5, 1e-5,
               VERIFY_ABS);
    for (int k = 0; k < 3; k++) {
        const double r = 0.9 / (1 << 2 * k);
        char who[64];
        snprintf(who, sizeof who, "a sphere of 1 m on one of %g m that is held:", r);
        verify_row("V10", label(who, "patch, e"), restitution_on_held("patch", r, 0, 63, 0, 0.3), 0.3, 2e-3,
                   VERIFY_ABS);
        verify_row("V10", label(who, "manual-si"), restitution_on_held("manual-si", r, 0, 63, 0, 0.3), 0.3,
                   0.02, VERIFY_ABS);
        snprintf(who, sizeof who, "on a box of %g m:", 2.0 * r);
        verify_row("V10", label(who, "patch, e"), restitution_on_held("patch", r, 1, 63, 0, 0.3), 0.3, 2e-3,
                   VERIFY_ABS);
        for (int box = 0; box < 2; box++) {
            snprintf(who, sizeof who, "on a %s of %g m", box ? "box" : "sphere", (box ? 2.0 : 1.0) * r);
            verify_row("V10", label("held along x alone:", who),
                       restitution_on_held("patch", r, box, FL_DOF_X, 0, 0.3), 0.3, 2e-3, VERIFY_ABS);
            verify_row("V10", label("with water:", who), restitution_on_held("patch", r, box, 0, 8, 0.3), 0.3,
                       2e-3, VERIFY_ABS);
        }
        verify_row("V10", "the same by manual-si", restitution_on_held("manual-si", r, 1, FL_DOF_X, 0, 0.3),
                   0.3, 0.02, VERIFY_ABS);
    }
    double h[4], error[4];
    for (int k = 0; k < 4; k++) {
        h[k] = 1.0 / (4 << k);
        error[k] = fabs(restitution_of_boxes("patch", "1", 0.5, 4 << k) - 0.5);
    }
    verify_order("V10", "boxes by patch: e against the step", h, error, 4, 2.0, 0.3);
}

/* --- longer motions ----------------------------------------------------------------------------------- */

/* A sphere lies on a plane and rolls from rest: no rolling friction, mu > 2/7 tan(slope). */
static void roll_from_rest(void)
{
    const int slope[] = {5, 20, 40};
    const double R = 0.1, g = 9.81;
    for (int k = 0; k < 3; k++) {
        const double a = slope[k] * PI / 180.0;
        lab l;
        lab_start(&l);
        set_material(&l, &NYLON);
        lab_set(&l, "boundary.min=none none 0");
        lab_setf(&l, "run.gravity=%.17g 0 %.17g", g * sin(a), -g * cos(a));
        lab_set(&l, "contact.restitution=0.3");
        lab_setf(&l, "contact.friction=%.17g", 2.0 * 2.0 / 7.0 * tan(a));
        const double kappa = fl_material_hertz(
                         fl_material_modulus((fl_elastic_constants){NYLON.young, NYLON.poisson},
                                             (fl_elastic_constants){INFINITY, 0.0}),
                         R),
                     weight = NYLON.density * 4.0 / 3.0 * PI * R * R * R * g * cos(a);
        lab_sphere(&l, v3(0, 0, R - pow(weight / kappa, 2.0 / 3.0)), R, v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, 1e-5);
        const double end = verify_quick() ? 0.5 : 2.0;
        lab_run(&l, (int64_t)lround(end / l.w.dt));
        char of[30];
        snprintf(of, sizeof of, "%d degrees:", slope[k]);
        verify_row("V13", label("acceleration from the path [m/s2]", of), 2.0 * l.w.b.x[0].x / (end * end),
                   5.0 / 7.0 * g * sin(a), 1e-3, VERIFY_REL);
        verify_row("V13", label("speed over spin times R", of), l.w.b.v[0].x / (R * l.w.b.w[0].y), 1.0, 1e-3,
                   VERIFY_REL);
        lab_free(&l);
    }
}

/* Two spheres squeezed between walls, under gravity, swinging against one another. */
static void spheres_between_walls(void)
{
    const double R = 0.25;
    const int windows = verify_quick() ? 2 : 20;
    lab l;
    lab_start(&l);
    lab_set(&l, "material.ice.young=1e7");
    lab_set(&l, "material.ice.density=1000");
    lab_set(&l, "run.gravity=9.81");
    lab_setf(&l, "boundary.min=none none 0");
    lab_setf(&l, "boundary.max=none none %.17g", 3.6 * R);
    lab_sphere(&l, v3(0, 0, 0.87 * R), R, v3(0, 0, 0.5), v3(0, 0, 0));
    lab_sphere(&l, v3(0, 0, 2.72 * R), R, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0);
    l.w.dt *= 0.02;
    const double start = lab_energy(&l), swing = l.w.ledger.kinetic;
    double worst = 0.0, mean[2] = {0};
    enum { SAMPLES = 1000, EVERY = 100 }; /* 1e5 steps a window */
    for (int c = 0; c < windows; c++) {
        double sum = 0.0;
        for (int k = 0; k < SAMPLES; k++) {
            if (lab_run(&l, EVERY)) return;
            const double e = lab_energy(&l) / start - 1.0;
            worst = fmax(worst, fabs(e));
            sum += e / SAMPLES;
        }
        if (c == 0) mean[0] = sum;
        if (c == windows - 1) mean[1] = sum;
    }
    verify_true("V14", "all three contacts held at every step", l.w.contact_steps == 3 * l.w.step);
    verify_note("%d steps; kinetic energy at the start %g of the whole", windows * SAMPLES * EVERY,
                swing / start);
    verify_below("V14", "largest |dE|/E", worst, 1e-6);
    verify_below("V14", "drift of E, relative, per 1e5 steps", fabs(mean[1] - mean[0]) / (windows - 1), 1e-6);
    lab_free(&l);
}

int main(void)
{
    verify_begin("spheres");
    spheres_of_glass();
    impact_on_plane();
    damped_impact();
    oblique_impacts();
    spinning_impacts();
    spinning_spheres();
    damping_equations();
    damping_in_solver();
    hunt_crossley();
    roll_from_rest();
    spheres_between_walls();
    return verify_end();
}
