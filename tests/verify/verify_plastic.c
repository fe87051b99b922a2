/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elastic-plastic sections by fibres, and collapse loads of frames (T11). */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "support/member_curve.h"
#include "support/verify.h"

static curve path; /* too large for the stack */

/* --- sections ---------------------------------------------------------------------------------- */

/* Moment about y of a section that is bent far beyond yielding under the axial force n of N_p. */
static double moment_at(const fl_member_section *s, double n)
{
    fl_member_fibre_section f = {0};
    fl_err err = {0};
    if (fl_member_fibre_section_make(&f, s, &err)) curve_fatal(&err);
    double *p = calloc(2 * (size_t)f.n, sizeof *p);
    fl_member_fibres piece = {.section = &f, .plastic = p, .trial = p + f.n};
    const double bend = 500.0 * f.yield / f.e / f.reach, wanted = n * f.yield * f.area;
    double lo = -bend * f.reach, hi = bend * f.reach, moment = 0.0;
    for (int k = 0; k < 100; k++) { /* stretch with that axial force */
        const double e0 = 0.5 * (lo + hi);
        fl_member_fibres_update(&piece, 1.0, e0, bend, 0.0);
        const double force = f.e * f.area * (e0 - piece.deform[0]);
        moment = f.e * f.iy * (bend - piece.deform[1]);
        if (force < wanted) lo = e0;
        else hi = e0;
    }
    free(p);
    fl_member_fibre_section_free(&f);
    return moment;
}

static void verify_sections(void)
{
    static const double n[] = {0.0, 0.25, 0.5, 0.75}, of_pipe[] = {1.0, 0.92391, 0.70725, 0.38313};
    fl_member_section pipe = fl_member_section_pipe(1.2, 0.04, 2.1e11, 8e10, 7850),
                      rectangle = fl_member_section_rectangle(0.2, 0.3, 2.1e11, 8e10, 7850),
                      rod = fl_member_section_pipe(0.2, 0.1, 2.1e11, 8e10, 7850);
    pipe.yield = 355e6;
    rectangle.yield = rod.yield = 250e6;
    for (int k = 0; k < 4; k++) {
        char what[100];
        snprintf(what, sizeof what, "pipe 1.2 x 0.04 m: plastic moment at N/N_p = %g [MN m]", n[k]);
        verify_row("T11", what, 1e-6 * moment_at(&pipe, n[k]), 19.1151 * of_pipe[k], 5e-3, VERIFY_REL);
        snprintf(what, sizeof what, "rectangle 0.2 x 0.3 m: the same [MN m]");
        verify_row("T11", what, 1e-6 * moment_at(&rectangle, n[k]), 1.125 * (1.0 - n[k] * n[k]), 5e-3,
                   VERIFY_REL);
    }
    verify_row("T11", "rod of 0.2 m: plastic moment s d3/6 [kN m]", 1e-3 * moment_at(&rod, 0.0),
               250e3 * 0.008 / 6.0, 1e-2, VERIFY_REL);
}

/* --- frames ------------------------------------------------------------------------------------ */

/* Largest load factor until the displacement along the load is `until`. */
static double collapse_load(double first, double until)
{
    fl_path_options o = curve_options(FL_RELAXATION_ADAPTIVE, first, 0.02);
    o.constraint = FL_ARC_DISPLACEMENT;
    const watched none[WATCH] = {{NULL, 0}};
    curve_follow(&path, &o, until, 0.0, none);
    double most = 0.0;
    for (int k = 0; k < path.n; k++) most = fmax(most, path.lambda[k]);
    return most;
}

/* The error is half a piece over the distance from hinge to hinge, of first order. */
static double extrapolated(double n, double n2) { return 2.0 * n2 - n; }

/* At 0.4 m the pipe is fully plastic but for some per mille. */
static void verify_three_point(void)
{
    const int n = verify_quick() ? 6 : 16;
    double load[2];
    for (int k = 0; k < 2; k++) {
        const int pieces = n << k;
        model_begin();
        model_line("node a 0 0 0\nnode m 10 0 0\nnode b 20 0 0\nsection s pipe 1.2 .04 2.1e11 8e10\nyield s "
                   "355e6\n");
        model_line("member 1 a m s %d\nmember 2 m b s %d\nfix a x y z rx\nfix b y z\nload m 0 0 -1\n", pieces,
                   pieces);
        load[k] = 1e-6 * collapse_load(5e5, 0.4);
        verify_note("three-point bend of a pipe, %d pieces: %.4f MN; M_p at the middle of a piece gives %.4f",
                    2 * pieces, load[k], 3.82302 / (1.0 - 0.5 / pieces));
    }
    verify_row("T11", "three-point bend of a pipe over 20 m, extrapolated: load 4 M_p/L [MN]",
               extrapolated(load[0], load[1]), 3.82302, 1e-2, VERIFY_REL);
}

/* A stiff material, so that the frame collapses before it sways. */
static void verify_portal(void)
{
    const int n = verify_quick() ? 6 : 8;
    double load[2];
    for (int k = 0; k < 2; k++) {
        const int pieces = n << k;
        model_begin();
        model_line("node a 0 0 0\nnode b 0 0 4\nnode m 3 0 4\nnode c 6 0 4\nnode d 6 0 0\n");
        model_line("section s rect .3 .2 4.2e12 1.6e12\nyield s 250e6\n");
        model_line("member 1 a b s %d ref 0 1 0\nmember 2 b m s %d ref 0 1 0\n", pieces, pieces);
        model_line("member 3 m c s %d ref 0 1 0\nmember 4 c d s %d ref 0 1 0\n", pieces, pieces);
        model_line("fix a clamped\nfix d clamped\nfix b y\nfix c y\nfix m y\nload b 1 0 0\nload m 0 0 -1\n");
        load[k] = 1e-3 * collapse_load(1e5, 0.02);
        verify_note("portal, %d pieces a member: %.2f kN", pieces, load[k]);
    }
    verify_row("T11", "collapse load of a portal frame, extrapolated: 6 M_p/(h + L/2) [kN]",
               extrapolated(load[0], load[1]), 964.286, 2e-2, VERIFY_REL);
}

/* A bar that is pulled yields at its yield stress, hardens at its modulus, is unloaded along E, and parts
 * at its limit of strain; nothing of the energy is lost. */
static void verify_bar(void)
{
    fl_member_section s = fl_member_section_bar(0.01, 2e11, 7850);
    fl_member_fibre_section f = {0};
    fl_err err = {0};
    s.yield = 250e6, s.hardening = 2e9, s.limit = 0.02;
    if (fl_member_fibre_section_make(&f, &s, &err)) curve_fatal(&err);
    double p[2] = {0}, work = 0.0, force = 0.0;
    fl_member_fibres piece = {.section = &f, .plastic = p, .trial = p + 1};
    const int steps = 2000;
    for (int k = 1; k <= steps; k++) {
        const double strain = 0.015 * k / steps, before = force;
        fl_member_fibres_update(&piece, 2.0, 2.0 * strain, 0.0, 0.0);
        force = f.e * f.area * (strain - piece.deform[0]);
        work += 0.5 * (force + before) * 2.0 * 0.015 / steps;
        fl_member_fibres_commit(&piece, piece.stored);
    }
    verify_row("T11", "bar at a strain of 0.015: force [MN]", 1e-6 * force,
               2.5 + 0.01 * 2e3 * (0.015 - 0.00125), 1e-9, VERIFY_REL);
    verify_row("T11", "work over energy stored and dissipated", work / (piece.stored + piece.dissipated), 1.0,
               1e-6, VERIFY_REL);
    fl_member_fibres_update(&piece, 2.0, 2.0 * 0.0145, 0.0, 0.0);
    verify_row("T11", "force when the strain goes back by 0.0005 [MN]",
               1e-6 * f.e * f.area * (0.0145 - piece.deform[0]), 1e-6 * force - 1.0, 1e-9, VERIFY_REL);
    fl_member_fibres_update(&piece, 2.0, 2.0 * 0.0201, 0.0, 0.0);
    verify_true("T11", "beyond the limit of strain the piece parts",
                fl_member_fibres_commit(&piece, piece.stored) == 1);
    fl_member_fibre_section_free(&f);
}

int main(void)
{
    verify_begin("members that yield");
    verify_sections();
    verify_bar();
    verify_three_point();
    verify_portal();
    return verify_end();
}
