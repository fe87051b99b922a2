/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equilibrium paths of trusses, domes and frames by chains of balls (T1 to T12, V70 to V75). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "support/member_curve.h"
#include "support/verify.h"

static curve one, two; /* too large for the stack */

/* Richardson's value for an error of the second order, from n and 2 n pieces. */
static double extrapolated(double n, double n2) { return n2 + (n2 - n) / 3.0; }

static double fine(double quick, double full) { return verify_quick() ? quick : full; }

/* --- T1, T2: the two-bar truss ----------------------------------------------------------------- */

static const double RISE6 = 10.452846326765347, SPAN6 = 99.452189536827333;

static void two_bars(void)
{
    model_begin();
    model_line("node a %.17g 0 0 hinge\nnode b %.17g 0 0 hinge\nnode c 0 0 %.17g hinge\n", -SPAN6, SPAN6,
               RISE6);
    model_line(
        "section s 2e6 1.6667e7 1.6667e7 1.28e7\nmember 1 a c s 6\nmember 2 b c s 6\nfix a pinned\nfix b "
        "pinned\nfix c y\n");
}

static double two_bar_load(double v)
{
    const double x = v / 100.0, sine = RISE6 / 100.0;
    return 4e6 * (sine - x) * (1.0 / sqrt(1.0 - 2.0 * x * sine + x * x) - 1.0);
}

static void verify_two_bar(enum fl_relaxation_kind damping, const char *name)
{
    static const double at[] = {1, 2, 3, 6, 8, 13, 19, 21, 23, 24};
    char what[100];
    double worst = 0.0;
    two_bars();
    model_line("load c 0 0 -2500\n");
    const fl_path_options o = curve_options(damping, 0.02, 0.004);
    curve_follow(&one, &o, 24.2, 0.0, NULL);
    snprintf(what, sizeof what, "two bars, %s damping: limit [N]", name);
    verify_row("T1/V71", what, 2500.0 * one.limit[0], 884.0250, 2e-3, VERIFY_REL);
    snprintf(what, sizeof what, "  least load after it [N], %d points, %lld steps", one.n - 1,
             (long long)one.steps);
    verify_row("T1/V71", what, 2500.0 * one.limit[1], -884.0250, 2e-3, VERIFY_REL);
    for (int k = 0; k < (int)(sizeof at / sizeof *at); k++)
        worst = fmax(
            worst, fabs(2500.0 * curve_value(&one, one.lambda, one.along, at[k], 0.0) - two_bar_load(at[k])));
    verify_below("T1/V71", "  farthest from the closed form [N], at ten deflections", worst, 2e-3 * 884.025);
    verify_below("T1", "  energy against work of the load, over the larger one", one.largest, 5e-3);
    verify_row("T1", "  energy against work at the end", one.balance[one.n - 1], 0.0, 1e-3, VERIFY_ABS);
}

static void verify_two_bar_upward(void)
{
    two_bars();
    model_line("load c 0 0 2500\n");
    const fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.02, 0.004);
    curve_follow(&one, &o, 2.5, 0.0, NULL);
    verify_row("T10", "two bars pulled up by 2.34713: load [N]",
               -2500.0 * curve_value(&one, one.lambda, one.along, 2.34713, 0.0), -1391.49, 2e-3, VERIFY_REL);
}

static void verify_spring(enum fl_relaxation_kind damping, const char *name)
{
    static const double v[] = {2, 3, 4.428946, 8, 10.452846, 13, 19, 24},
                        p[] = {641.046, 803.931, 884.025, 510.447, 0, -527.633, -620.639, 2000.977},
                        u[] = {8.41046, 11.03931, 13.26920, 13.10447, 10.45285, 7.72367, 12.79361, 44.00977};
    const watched watch[WATCH] = {{"c", 2}};
    char what[100];
    double worst_p = 0.0, worst_u = 0.0, up[20];
    int turns = 0;
    two_bars();
    model_line(
        "node d 0 0 %.17g hinge\nsection k 1e5 1e6 1e6 1e6\nmember 3 d c k 1\nfix d x y\nload d 0 0 -2500\n",
        RISE6 - 1000.0);
    const fl_path_options o = curve_options(damping, 0.02, fine(0.01, 0.004));
    curve_follow(&one, &o, 0.0, -24.3, watch);
    for (int k = 0; k < 8; k++) {
        worst_p =
            fmax(worst_p, fabs(2500.0 * curve_value(&one, one.lambda, one.watch[0], -v[k], 0.0) - p[k]));
        worst_u = fmax(worst_u, fabs(curve_value(&one, one.along, one.watch[0], -v[k], 0.0) - u[k]));
    }
    for (int k = 1; k + 1 < one.n && turns < 20; k++)
        if ((one.along[k] - one.along[k - 1]) * (one.along[k + 1] - one.along[k]) < 0.0) {
            double at;
            up[turns++] = fl_arc_parabola(&one.s[k - 1], &one.along[k - 1], &at);
        }
    snprintf(what, sizeof what, "two bars behind a spring, %s damping: load, farthest off [N]", name);
    verify_below("T2", what, worst_p, 3e-3 * 884.025);
    snprintf(what, sizeof what, "  displacement of the load, farthest off, %d points, %lld steps", one.n - 1,
             (long long)one.steps);
    verify_below("T2", what, worst_u, 3e-3 * 14.0);
    verify_row("T2", "  displacement where it turns back", turns > 0 ? up[0] : NAN, 14.018565, 3e-3,
               VERIFY_REL);
    verify_row("T2", "  and where it turns forward", turns > 1 ? up[1] : NAN, 6.887127, 3e-3, VERIFY_REL);
}

/* --- T3: the star dome ------------------------------------------------------------------------- */

/* p ring pieces and apex members, q those to the supports. */
static void star_dome(int hinged, int p, int q, double eiy, double eiz, double gj)
{
    const char *const hinge = hinged ? "hinge" : "";
    model_begin();
    model_line("section s 960510 %g %g %g\nnode apex 0 0 82.16 %s\n", eiy, eiz, gj, hinge);
    for (int k = 0; k < 6; k++) {
        const double a = k * PI / 3.0, b = a + PI / 6.0;
        model_line("node r%d %.15g %.15g 62.16 %s\nnode s%d %.15g %.15g 0 %s\nfix s%d pinned\n", k,
                   250 * cos(a), 250 * sin(a), hinge, k, 500 * cos(b), 500 * sin(b), hinge, k);
    }
    for (int k = 0; k < 6; k++) {
        const int next = (k + 1) % 6;
        model_line("member a%d apex r%d s %d\nmember r%d r%d r%d s %d\n", k, k, p, k, k, next, p);
        model_line("member s%d r%d s%d s %d\nmember t%d r%d s%d s %d\n", k, k, k, q, k, next, k, q);
    }
    model_line("load apex 0 0 -900\n");
}

static void verify_star_truss(void)
{
    static const double w[] = {1, 2, 4, 6, 10, 14, 20, 25, 35, 40, 50},
                        p[] = {79.861,  146.177,  241.101,  291.042, 283.410, 179.341,
                               -43.416, -199.165, -204.632, 0,       850.890},
                        ring[] = {.0480,  .1025,  .2273, .3672, .6621,  .9320,
                                  1.1951, 1.2221, .6344, NAN,   -1.9524};
    const watched watch[WATCH] = {{"r0", 2}};
    double worst = 0.0, worst_ring = 0.0;
    star_dome(1, 5, 6, 2.5e7, 2.5e7, 1.7e7);
    const fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.02, 0.01);
    curve_follow(&one, &o, 50.5, 0.0, watch);
    for (int k = 0; k < 11; k++) {
        worst = fmax(worst, fabs(900.0 * curve_value(&one, one.lambda, one.along, w[k], 0.0) - p[k]));
        if (isfinite(ring[k]))
            worst_ring =
                fmax(worst_ring, fabs(curve_value(&one, one.watch[0], one.along, w[k], 0.0) - ring[k]));
    }
    verify_row("T3/V72", "star dome, hinged: limit [N]", 900.0 * one.limit[0], 303.189, 3e-3, VERIFY_REL);
    verify_row("T3/V72", "  apex down there [mm]", curve_at_arc(&one, one.along, one.limit_s[0]), 7.6844,
               5e-3, VERIFY_REL);
    verify_row("T3/V72", "  least load after it [N]", 900.0 * one.limit[1], -265.101, 3e-3, VERIFY_REL);
    verify_row("T3/V72", "  apex down there [mm]", curve_at_arc(&one, one.along, one.limit_s[1]), 30.2777,
               5e-3, VERIFY_REL);
    verify_below("T3", "  farthest from the reference [N], at eleven deflections", worst, 3e-3 * 303.189);
    verify_below("T3", "  ring up, farthest off [mm]", worst_ring, 0.01);
    verify_note("%d points, %lld steps of 132 contacts", one.n - 1, (long long)one.steps);
}

/* A square section of 317 mm2: I = A2/12, J = 0.14058 A2; E 3030, G 1262 MPa. */
static void verify_star_frame(void)
{
    static const double w[] = {2, 5, 10, 20, 30, 50}, p[] = {288.0, 625.2, 981.4, 1265.9, 1487.8, 2623.5};
    const fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.02, 0.02);
    star_dome(0, 5, 6, 3030.0 * 8374.083, 3030.0 * 8374.083, 1262.0 * 14126.0);
    curve_follow(&one, &o, 50.5, 0.0, NULL);
    star_dome(0, 10, 12, 3030.0 * 8374.083, 3030.0 * 8374.083, 1262.0 * 14126.0);
    curve_follow(&two, &o, 50.5, 0.0, NULL);
    for (int k = 0; k < 6; k++) {
        char what[100];
        const double a = 900.0 * curve_value(&one, one.lambda, one.along, w[k], 0.0),
                     b = 900.0 * curve_value(&two, two.lambda, two.along, w[k], 0.0);
        snprintf(what, sizeof what, "star dome, rigid joints, apex down %g mm [N]: %.1f, %.1f to", w[k], a,
                 b);
        verify_row("T3/V73", what, extrapolated(a, b), p[k], 5e-3, VERIFY_REL);
    }
}

/* --- T4: the dome K6-4 ------------------------------------------------------------------------- */

static const char *ring_node(char *buf, size_t size, int ring, int sector, int i)
{
    if (i == ring) i = 0, sector++;
    if (ring == 0) return "apex";
    snprintf(buf, size, "r%d.%d", ring, sector % 6 * ring + i);
    return buf;
}

static void k6_member(int *n, int pieces, int ra, int sa, int ia, int rb, int sb, int ib)
{
    char a[30], b[30];
    model_line("member %d %s %s pipe %d\n", ++*n, ring_node(a, sizeof a, ra, sa, ia),
               ring_node(b, sizeof b, rb, sb, ib), pieces);
}

/* Kiewitt dome with 4 rings at equal arc, span 30, rise 2 m, pipes 180 x 5 mm; kN. */
static void k6_dome(int pieces)
{
    enum { RINGS = 4 };
    const double radius = (15.0 * 15.0 + 4.0) / 4.0, rim = asin(15.0 / radius);
    char a[30];
    int n = 0;
    model_begin();
    model_line("section pipe pipe 0.18 0.005 210e6 85e6\nnode apex 0 0 2\n");
    for (int k = 1; k <= RINGS; k++)
        for (int s = 0; s < 6; s++)
            for (int i = 0; i < k; i++) {
                const double phi = rim * k / RINGS, t = (s + (double)i / k) * PI / 3.0;
                model_line("node %s %.15g %.15g %.15g\n", ring_node(a, sizeof a, k, s, i),
                           radius * sin(phi) * cos(t), radius * sin(phi) * sin(t),
                           radius * (cos(phi) - 1.0) + 2.0);
            }
    for (int k = 1; k <= RINGS; k++)
        for (int s = 0; s < 6; s++)
            for (int i = 0; i < k; i++) {
                k6_member(&n, pieces, k, s, i, k - 1, s, i);
                if (i > 0) k6_member(&n, pieces, k, s, i, k - 1, s, i - 1);
                k6_member(&n, pieces, k, s, i, k, s, i + 1);
                if (k == RINGS) model_line("fix %s pinned\n", ring_node(a, sizeof a, k, s, i));
            }
    model_line("load apex 0 0 -100\n");
}

static void verify_k6(void)
{
    static const double w[] = {.0106, .0622, .1140, .2143, .3061, .3886, .4632, .5317, .5955, .6557, .7132},
                        p[] = {20.0, 100.7, 159.0, 234.8, 286.8, 326.9, 355.4, 372.6, 380.2, 381.3, 379.0};
    const watched watch[WATCH] = {{"r1.0", 2}};
    double worst = 0.0;
    /* The quick run has half the pieces, of which only the limit is held against that of 6. */
    const int pieces = verify_quick() ? 3 : 6;
    k6_dome(pieces);
    const fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.1, fine(0.04, 0.01));
    curve_follow(&one, &o, verify_quick() ? 0.70 : 0.95, 0.0, watch);
    if (verify_quick()) {
        verify_row("T4/V74", "dome K6-4, 3 pieces: limit [kN], against that of 6", 100.0 * one.limit[0],
                   381.43, 0.05, VERIFY_REL);
        return;
    }
    verify_row("T4/V74", "dome K6-4, 6 pieces: limit [kN]", 100.0 * one.limit[0], 381.43, 1e-2, VERIFY_REL);
    verify_row("T4/V74", "  apex down there [m]", curve_at_arc(&one, one.along, one.limit_s[0]), 0.6384, 1e-2,
               VERIFY_REL);
    verify_row("T4/V74", "  least load after it [kN]", 100.0 * one.limit[1], 375.5, 1e-2, VERIFY_REL);
    verify_row("T4/V74", "  apex down there [m]", curve_at_arc(&one, one.along, one.limit_s[1]), 0.812, 3e-2,
               VERIFY_REL);
    for (int k = 0; k < 11; k++)
        worst = fmax(worst, fabs(100.0 * curve_value(&one, one.lambda, one.along, w[k], 0.0) / p[k] - 1.0));
    verify_below("T4", "  largest relative distance from the reference, at eleven deflections", worst, 1e-2);
    verify_note("%d points, %lld steps of 936 contacts", one.n - 1, (long long)one.steps);
    const double six = 100.0 * one.limit[0];
    k6_dome(12);
    const fl_path_options o2 = curve_options(FL_RELAXATION_ADAPTIVE, 0.1, 0.02);
    curve_follow(&two, &o2, 0.70, 0.0, watch);
    verify_note("12 pieces: limit %.2f kN", 100.0 * two.limit[0]);
    verify_row("T4/V74", "  limit of 6 and 12 pieces, extrapolated [kN]",
               extrapolated(six, 100.0 * two.limit[0]), 384.9, 1e-2, VERIFY_REL);
}

/* --- T5: Lee's frame --------------------------------------------------------------------------- */

static void lee_frame(int pieces)
{
    model_begin();
    model_line(
        "section s 4320 1440 1440 1e3\nnode foot 0 0 0\nnode knee 0 0 120\nnode at 24 0 120\nnode end 120 0 "
        "120\n");
    model_line("member column foot knee s %d\nmember left knee at s %d\nmember right at end s %d\n", pieces,
               pieces / 5, pieces / 5 * 4);
    model_line(
        "fix foot pinned rx rz\nfix end pinned rx rz\nfix knee y rx rz\nfix at y rx rz\nload at 0 0 -1\n");
}

static void verify_lee(void)
{
    static const double v[] = {9.848, 19.325, 36.747, 50.368, 58.753, 60.596, 56.634, 51.442, 67.284, 77.294},
                        u[] = {1.667, 4.971, 14.907, 29.154, 47.140, 66.971, 76.042, 83.103, 93.987, 93.594},
                        p[] = {.9554, 1.3259, 1.7282, 1.8518, 1.6049, .9869, .4232, -.6641, -.8009, -.4737};
    const watched watch[WATCH] = {{"at", 2}, {"at", 0}};
    const int n = 10;
    const fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.05, 0.02);
    lee_frame(n);
    curve_follow(&one, &o, 95.0, 0.0, watch);
    if (verify_quick()) {
        verify_row("T5", "Lee's frame, 10 pieces a member: limit", one.limit[0], 1.8557, 1.5e-2, VERIFY_REL);
        verify_row("T5", "  least load behind the snap-back", one.limits > 1 ? one.limit[1] : NAN, -0.9414,
                   5e-2, VERIFY_REL);
        return;
    }
    lee_frame(2 * n);
    curve_follow(&two, &o, 95.0, 0.0, watch);
    verify_row("T5", "Lee's frame, 10 pieces a member: limit", one.limit[0], 1.8557, 1.5e-2, VERIFY_REL);
    verify_row("T5", "  least load behind the snap-back", one.limit[1], -0.9414, 5e-2, VERIFY_REL);
    verify_row("T5", "  20 pieces: limit", two.limit[0], 1.8557, 5e-3, VERIFY_REL);
    verify_row("T5", "  least load behind the snap-back", two.limit[1], -0.9414, 1.5e-2, VERIFY_REL);
    verify_row("T5", "  both, extrapolated: limit", extrapolated(one.limit[0], two.limit[0]), 1.8557, 1e-3,
               VERIFY_REL);
    verify_row("T5", "  least load", extrapolated(one.limit[1], two.limit[1]), -0.9414, 5e-3, VERIFY_REL);
    double worst_v = 0.0, worst_p = 0.0;
    for (int k = 0; k < 10; k++) { /* u rises along the path up to its turn: points of the curve by it */
        const double from = k < 9 ? 0.0 : one.limit_s[1], from2 = k < 9 ? 0.0 : two.limit_s[1];
        const double a = k < 8 ? curve_value(&one, one.along, one.watch[1], u[k], from)
                               : curve_value(&one, one.watch[1], one.along, v[k], one.limit_s[1]);
        const double b = k < 8 ? curve_value(&two, two.along, two.watch[1], u[k], from2)
                               : curve_value(&two, two.watch[1], two.along, v[k], two.limit_s[1]);
        worst_v = fmax(worst_v, fabs(extrapolated(a, b) - (k < 8 ? v[k] : u[k])));
        if (k < 8)
            worst_p =
                fmax(worst_p, fabs(extrapolated(curve_value(&one, one.lambda, one.watch[1], u[k], 0.0),
                                                curve_value(&two, two.lambda, two.watch[1], u[k], 0.0)) -
                                   p[k]));
    }
    verify_below("T5", "  displacement, farthest from the elastica at ten points", worst_v, 0.2);
    verify_below("T5", "  load, farthest from it at eight of them", worst_p, 0.02);
    verify_note("%d and %d points, %lld and %lld steps", one.n - 1, two.n - 1, (long long)one.steps,
                (long long)two.steps);
}

/* --- T6, T7: toggle and arch ------------------------------------------------------------------- */

static void toggle(int pieces)
{
    const double e = 10.3e6, b = 0.753, h = 0.243, area = b * h, i = b * h * h * h / 12.0;
    model_begin();
    model_line("section s %.12g %.12g %.12g %.12g\n", e * area, e * i, e * i, e * i);
    model_line(
        "node a -12.94288 0 0\nnode b 12.94288 0 0\nnode c 0 0 0.386\nmember 1 a c s %d\nmember 2 c b s %d\n",
        pieces, pieces);
    model_line("fix a clamped\nfix b clamped\nfix c y rx rz\nload c 0 0 -40\n");
}

static void verify_toggle(void)
{
    static const double w[] = {.05, .1, .15, .2, .25, .3, .35, .4, .45, .5, .55, .6, .65},
                        p[] = {15.18, 25.20, 30.98, 33.50, 33.78, 32.85, 31.71,
                               31.30, 32.50, 36.10, 42.81, 53.31, 68.24};
    const int n = verify_quick() ? 4 : 8;
    const fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.02, 0.005);
    double worst = 0.0;
    toggle(n);
    curve_follow(&one, &o, 0.67, 0.0, NULL);
    toggle(2 * n);
    curve_follow(&two, &o, 0.67, 0.0, NULL);
    verify_note("Williams' toggle: %d and %d pieces a bar: limit %.2f and %.2f lb", n, 2 * n,
                40.0 * one.limit[0], 40.0 * two.limit[0]);
    /* With 4 and 8 pieces terms of the fourth order are left: 0.5 % is for 8 and 16. */
    const double tol = fine(1e-2, 5e-3);
    verify_row("T6", "Williams' toggle: limit, extrapolated [lb]",
               extrapolated(40.0 * one.limit[0], 40.0 * two.limit[0]), 33.8713, tol, VERIFY_REL);
    verify_row("T6", "  least load after it [lb]", extrapolated(40.0 * one.limit[1], 40.0 * two.limit[1]),
               31.2826, tol, VERIFY_REL);
    for (int k = 0; k < 13; k++)
        worst = fmax(worst, fabs(extrapolated(40.0 * curve_value(&one, one.lambda, one.along, w[k], 0.0),
                                              40.0 * curve_value(&two, two.lambda, two.along, w[k], 0.0)) /
                                     p[k] -
                                 1.0));
    verify_below("T6", "  largest relative distance from the elastica, at 13 deflections", worst, tol);
}

static void arch(int pieces, double side)
{
    model_begin();
    model_line("section s 1e4 1e3 1e3 1e3\n");
    for (int k = 0; k <= pieces; k++) {
        const double a = 0.2 * (2.0 * k / pieces - 1.0);
        model_line("node %d %.15g 0 %.15g\nfix %d y rx rz\n", k, 100.0 * sin(a), 100.0 * (cos(a) - cos(0.2)),
                   k);
        if (k > 0) model_line("member %d %d %d s 1\n", k, k - 1, k);
    }
    model_line("fix 0 pinned\nfix %d pinned\nload %d %.12g 0 -1\n", pieces, pieces / 2, side);
}

static void verify_arch(void)
{
    const int n = verify_quick() ? 16 : 32;
    fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.2, 0.01);
    double limit[2], side[2];
    for (int k = 0; k < 2; k++) {
        arch(n << k, 0.0);
        curve_follow(&one, &o, 1.3, 0.0, NULL);
        limit[k] = one.limits ? one.limit[0] : NAN;
    }
    verify_note("shallow arch, %d and %d pieces: %.4f and %.4f", n, 2 * n, limit[0], limit[1]);
    verify_row("T7", "shallow hinged arch, perfect: limit, extrapolated", extrapolated(limit[0], limit[1]),
               4.9957, 5e-3, VERIFY_REL);
    if (verify_quick()) return;
    for (int k = 0; k < 2; k++) {
        const watched watch[WATCH] = {{k ? "32" : "16", 2}};
        o.dl_most = 0.08; /* the peak is sharp, */
        o.chi = 1e-6;     /* and a looser balance hides what a side load of 1e-3 does */
        arch(n << k, 1e-3);
        curve_follow(k ? &two : &one, &o, 0.0, -1.3, watch);
        const curve *c = k ? &two : &one;
        side[k] = c->limits ? c->limit[0] : NAN;
    }
    verify_note("with a side load of 1e-3: %.4f and %.4f", side[0], side[1]);
    verify_row("T7", "  with a side load of 1e-3, it bifurcates: limit, extrapolated",
               extrapolated(side[0], side[1]), 4.828, 5e-3, VERIFY_REL);
}

/* --- T8, T9: pyramid, hexagonal frame ---------------------------------------------------------- */

static void verify_pyramid(void)
{
    static const double w[] = {2, 5, 10, 15, 25, 45},
                        p[] = {333.477, 640.653, 733.270, 458.706, -458.706, 1366.297};
    double worst = 0.0;
    model_begin();
    model_line("section s bar 1 960510\nnode apex 0 0 20\nload apex 0 0 -1000\n");
    for (int k = 0; k < 8; k++)
        model_line("node %d %.15g %.15g 0\nfix %d pinned\nmember %d %d apex s 1\n", k, 250 * cos(k * PI / 4),
                   250 * sin(k * PI / 4), k, k, k);
    const fl_path_options o = curve_options(FL_RELAXATION_KINETIC, 0.02, 0.004);
    curve_follow(&one, &o, 45.2, 0.0, NULL);
    verify_row("T8", "pyramid of eight bars: limit [N]", 1000.0 * one.limit[0], 752.330, 2e-3, VERIFY_REL);
    verify_row("T8", "  apex down there", curve_at_arc(&one, one.along, one.limit_s[0]), 8.46527, 2e-3,
               VERIFY_REL);
    for (int k = 0; k < 6; k++)
        worst = fmax(worst, fabs(1000.0 * curve_value(&one, one.lambda, one.along, w[k], 0.0) - p[k]));
    verify_below("T8", "  farthest from the closed form [N], at six deflections", worst, 2e-3 * 752.33);
}

static void hexagon(int pieces, int rollers)
{
    model_begin();
    model_line("section s general %.12g %.12g %.12g %.12g\nnode apex 0 0 1.75\nload apex 0 0 -100\n",
               439800 * .494, 439800 * .02, 439800 * .02, 159000 * .0331);
    if (rollers) model_line("fix apex x y rz\n");
    for (int k = 0; k < 6; k++)
        model_line("node %d %.15g %.15g 0\nfix %d %s\n", k, 24 * cos(k * PI / 3), 24 * sin(k * PI / 3), k,
                   rollers ? "z" : "pinned");
    for (int k = 0; k < 6; k++)
        model_line("member a%d apex %d s %d\nmember r%d %d %d s %d\n", k, k, pieces, k, k, (k + 1) % 6,
                   pieces);
}

static void verify_hexagon(void)
{
    const fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.02, 0.02);
    const int n = verify_quick() ? 4 : 8;
    double limit[2], roller[2];
    for (int k = 0; k < 2; k++) {
        hexagon(n << k, 0);
        curve_follow(&one, &o, 0.7, 0.0, NULL);
        limit[k] = 100.0 * one.limit[0];
    }
    verify_note("hexagonal frame, pinned, %d and %d pieces: %.2f and %.2f lb", n, 2 * n, limit[0], limit[1]);
    verify_row("T9", "hexagonal frame, ring joints pinned: limit, extrapolated [lb]",
               extrapolated(limit[0], limit[1]), 78.55, 1e-2, VERIFY_REL);
    if (verify_quick()) return;
    for (int k = 0; k < 2; k++) {
        hexagon(4 << k, 1);
        curve_follow(&one, &o, 1.0, 0.0, NULL);
        roller[k] = 100.0 * one.limit[0];
    }
    verify_note("on rollers, 4 and 8 pieces: %.2f and %.2f lb", roller[0], roller[1]);
    verify_row("T9", "  ring joints on rollers: limit, extrapolated [lb]", extrapolated(roller[0], roller[1]),
               56.95, 1e-2, VERIFY_REL);
}

/* --- T10: column, bend, roll-up ---------------------------------------------------------------- */

/* 1 m, 50 x 50 mm, 210 GPa; kN. */
static void verify_column(void)
{
    static const double sag[] = {.01, .02, .05, .1, .2}, p[] = {.9020, .9525, .9851, 1.0048, 1.0533};
    const double euler = PI * PI * 210e6 * 0.05 * 0.05 * 0.05 * 0.05 / 12.0;
    const int n = verify_quick() ? 4 : 8;
    double load[2][5];
    verify_row("V70", "Euler's load of the column [kN]", euler, 1079.49, 1e-4, VERIFY_REL);
    for (int k = 0; k < 2; k++) {
        const int half = n << k;
        model_begin();
        model_line("section s rect 0.05 0.05 210e6 80e6\n");
        for (int i = 0; i <= 2 * half; i++) {
            const double t = (double)i / (2 * half);
            model_line("node %d %.15g 0 %.15g\nfix %d y rx rz\n", i, t, 1e-3 * sin(PI * t), i);
            if (i > 0) model_line("member %d %d %d s 1\n", i, i - 1, i);
        }
        model_line("fix 0 pinned\nfix %d z\nload %d -1079.49 0 0\n", 2 * half, 2 * half);
        char mid[10];
        snprintf(mid, sizeof mid, "%d", half);
        const watched watch[WATCH] = {{mid, 2}};
        fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 0.3, 0.02);
        o.constraint = FL_ARC_TOTAL;
        curve_follow(&one, &o, 0.0, 0.201, watch);
        for (int i = 0; i < 5; i++)
            load[k][i] = curve_value(&one, one.lambda, one.watch[0], sag[i] - 1e-3, 0.0) * 1079.49 / euler;
    }
    for (int i = 0; i < 5; i++) {
        char what[100];
        snprintf(what, sizeof what, "column bowed by L/1000, sag %g L: P/P_E %.4f, %.4f to", sag[i],
                 load[0][i], load[1][i]);
        verify_row("T10/V70", what, extrapolated(load[0][i], load[1][i]), p[i], 5e-3, VERIFY_REL);
    }
}

/* Displacements at a load factor, by load control in equal steps. */
static void load_to(double first, int steps, const char *node, fl_vec3 *d, fl_vec3 *x0, double chi)
{
    fl_member_model m = {0};
    fl_member_chain c = {0};
    fl_path p = {0};
    fl_err err = {0};
    fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, first, 1.0);
    o.constraint = FL_ARC_LOAD;
    o.dl = (1.0 - first) / (steps > 1 ? steps - 1 : 1);
    o.chi = chi;
    curve_chain(&m, &c, 1.0);
    if (fl_path_start(&p, &c, &o, &err)) curve_fatal(&err);
    p.options.last = 1.0;
    while (p.point.lambda < 1.0)
        if (fl_path_next(&p, &err)) curve_fatal(&err);
    const int32_t b = curve_node(&m, node);
    *d = c.ball[b].d;
    *x0 = c.ball[b].x0;
    fl_path_free(&p);
    fl_member_chain_free(&c);
    fl_member_model_free(&m);
}

static void verify_bend(void)
{
    fl_vec3 d, x0, at[2];
    for (int k = 0; k < 2; k++) {
        const int n = 8 << k;
        model_begin();
        model_line("section s 1e7 %.15g %.15g %.15g\n", 1e7 / 12.0, 1e7 / 12.0, 5e6 * 0.140577);
        for (int i = 0; i <= n; i++) {
            const double a = 0.25 * PI * i / n;
            model_line("node %d %.15g %.15g 0\n", i, 100.0 * (1.0 - cos(a)), 100.0 * sin(a));
            if (i > 0) model_line("member %d %d %d s 1\n", i, i - 1, i);
        }
        model_line("fix 0 clamped\nload %d 0 0 600\n", n);
        load_to(0.05, 20, k ? "16" : "8", &d, &x0, 1e-5);
        at[k] = v3_add(x0, d);
    }
    /* Bathe's arm lies in the plane: x towards its centre, y along its start, z with the load. */
    verify_row("V75", "bent cantilever, 45 degrees, 600: tip along its start, 8 pieces", at[0].y, 46.93, 2e-2,
               VERIFY_REL);
    verify_row("V75", "  towards the centre", at[0].x, 15.59, 2e-2, VERIFY_REL);
    verify_row("V75", "  along the load", at[0].z, 53.65, 2e-2, VERIFY_REL);
    verify_note("16 pieces: %.3f %.3f %.3f", at[1].y, at[1].x, at[1].z);
}

static void verify_roll_up(void)
{
    fl_vec3 d, x0;
    model_begin();
    model_line(
        "section s 1e4 1 1 1\nnode a 0 0 0\nnode b 1 0 0\nmember 1 a b s 10\nfix a clamped\nfix b y rx "
        "rz\nload b 0 0 0 0 %.17g 0\n",
        -2.0 * PI);
    load_to(0.05, 20, "b", &d, &x0, 1e-10);
    verify_below("T10", "cantilever rolled to a circle by 2 pi EI/L: distance of tip and clamp",
                 v3_norm(v3_add(x0, d)), 1e-9);
}

/* A jacket of pipes on four legs, clamped: levels 0, 15, 30 m, a diagonal a face and storey. */
static void jacket(int pieces, double fx, double fy)
{
    static const double x[] = {10, 8, 6}, y[] = {8, 6.5, 5}, sx[] = {1, -1, -1, 1}, sy[] = {1, 1, -1, -1};
    model_begin();
    model_line("section leg pipe 1.2 0.04 206e9 79.2e9\nsection brace pipe 0.6 0.02 206e9 79.2e9\n");
    for (int l = 0; l < 3; l++)
        for (int k = 0; k < 4; k++)
            model_line("node n%d.%d %g %g %d\n", l, k, sx[k] * x[l], sy[k] * y[l], 15 * l);
    for (int l = 0; l < 2; l++)
        for (int k = 0; k < 4; k++) {
            const int next = (k + 1) % 4;
            model_line("member leg%d.%d n%d.%d n%d.%d leg %d\n", l, k, l, k, l + 1, k, pieces);
            model_line("member d%d.%d n%d.%d n%d.%d brace %d\n", l, k, l, k, l + 1, next, pieces);
            model_line("member h%d.%d n%d.%d n%d.%d brace %d\n", l, k, l + 1, k, l + 1, next, pieces);
        }
    for (int k = 0; k < 4; k++) model_line("fix n0.%d clamped\nload n2.%d %g %g 0\n", k, k, fx, fy);
}

/* At a thousandth of the load: the second order is below 1e-5 of it. */
static void verify_jacket(void)
{
    static const double in_x[] = {5.3548, 4.9592, 5.3548, 4.9592}, in_y[] = {6.0390, 6.3660, 6.0390, 6.3660};
    for (int way = 0; way < 2; way++) {
        fl_member_model m = {0};
        fl_member_chain c = {0};
        fl_path p = {0};
        fl_err err = {0};
        fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, 1e-3, 0.01);
        o.constraint = FL_ARC_LOAD;
        o.chi = 1e-6;
        jacket(verify_quick() ? 1 : 4, way ? 0.0 : 250e3, way ? 250e3 : 0.0);
        curve_chain(&m, &c, 1.0);
        if (fl_path_start(&p, &c, &o, &err) || fl_path_next(&p, &err)) curve_fatal(&err);
        for (int k = 0; k < 4; k++) {
            char name[20], what[100];
            snprintf(name, sizeof name, "n2.%d", k);
            snprintf(what, sizeof what, "jacket, 250 kN a corner along %s: corner %d [mm]", way ? "y" : "x",
                     k + 1);
            verify_row("T12", what, 1e6 * v3_at(c.ball[curve_node(&m, name)].d, way), way ? in_y[k] : in_x[k],
                       2e-5, VERIFY_REL);
        }
        fl_path_free(&p);
        fl_member_chain_free(&c);
        fl_member_model_free(&m);
    }
}

/* The same path in steps of dt = 2^-10: masses go with dt2, so bits stay but for powers of two. */
static void verify_step(void)
{
    double lambda[2], along[2];
    fl_path_options o = curve_options(FL_RELAXATION_KINETIC, 0.02, 0.01);
    two_bars();
    model_line("load c 0 0 -2500\n");
    for (int k = 0; k < 2; k++) {
        fl_member_model m = {0};
        fl_member_chain c = {0};
        fl_path p = {0};
        fl_err err = {0};
        curve_chain(&m, &c, k ? 1.0 / 1024 : 1.0);
        if (fl_path_start(&p, &c, &o, &err)) curve_fatal(&err);
        for (int n = 0; n < 20; n++)
            if (fl_path_next(&p, &err)) curve_fatal(&err);
        lambda[k] = p.point.lambda;
        along[k] = p.point.along;
        fl_path_free(&p);
        fl_member_chain_free(&c);
        fl_member_model_free(&m);
    }
    verify_true("T10", "the 20th point of two bars has the same bits with dt = 1 and 1/1024",
                lambda[0] == lambda[1] && along[0] == along[1]);
}

int main(void)
{
    verify_begin("paths of bars and beams");
    verify_two_bar(FL_RELAXATION_KINETIC, "kinetic");
    verify_two_bar(FL_RELAXATION_ADAPTIVE, "adaptive");
    verify_two_bar_upward();
    verify_spring(FL_RELAXATION_KINETIC, "kinetic");
    verify_spring(FL_RELAXATION_ADAPTIVE, "adaptive");
    verify_star_truss();
    if (!verify_quick()) verify_star_frame();
    verify_k6();
    verify_lee();
    verify_toggle();
    verify_arch();
    verify_pyramid();
    verify_hexagon();
    verify_column();
    verify_bend();
    verify_roll_up();
    verify_jacket();
    verify_step();
    return verify_end();
}
