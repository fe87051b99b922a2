/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structures that ice meets: cylinders, walls of any number of triangles, plates and shells. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "law/manual.h"
#include "sim/energy_balance.h"
#include "support/small_world.h"
#include "support/sweeps.h"
#include "support/verify.h"
#include "world/access.h"

static const fl_vec3 ZERO = {0, 0, 0};

static void sphere_and_cylinder(void)
{
    const struct {
        const char *what;
        fl_vec3 x;
        double overlap;
        fl_vec3 n;
    } at[] = {
        {"beside: the side", {0.55, 0, 1}, 0.05, {1, 0, 0}},
        {"above: the end", {0.2, 0, 2.05}, 0.05, {0, 0, 1}},
        {"aside and above: the rim", {0.55, 0, 2.05}, 0.1 - 0.05 * sqrt(2.0), {sqrt(0.5), 0, sqrt(0.5)}},
        {"too far: none", {0.7, 0, 2.1}, 0.0, {0, 0, 0}},
        {"below: the other end", {0.2, 0, -0.05}, 0.05, {0, 0, -1}},
        {"below the rim", {0, 0.55, -0.05}, 0.1 - 0.05 * sqrt(2.0), {0, sqrt(0.5), -sqrt(0.5)}},
        {"above, exactly over the rim", {0.5, 0, 2.05}, 0.05, {0, 0, 1}},
        {"beside, exactly level with the end", {0.55, 0, 2.0}, 0.05, {1, 0, 0}},
        {"inside, out by the side", {0.45, 0, 1}, 0.15, {1, 0, 0}},
        {"inside, out by the end", {0.2, 0, 1.9}, 0.2, {0, 0, 1}},
        {"on the axis, nearest exit by the side", {0, 0, 1}, 0.6, {NAN, NAN, 0}},
        {"on the axis, nearest exit by the end", {0, 0, 0.25}, 0.35, {0, 0, -1}},
        {"over the axis", {0, 0, 2.05}, 0.05, {0, 0, 1}},
    };
    lab l;
    lab_start(&l);
    lab_sphere(&l, v3(5, 0, 0), 0.1, ZERO, ZERO);
    lab_cone(&l, (fl_cone){ZERO, v3(0, 0, 2), 0.5, 0.5});
    lab_make(&l, 1e-9);
    verify_note("overlap of a sphere of 0.1 m and the cylinder of 0.5 m between z = 0 and 2 [m]");
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        lab_pose(&l.w, 0, at[k].x, q_one());
        const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
        verify_row("V30", at[k].what, p.overlap, at[k].overlap, 1e-14, VERIFY_ABS);
        if (at[k].overlap == 0.0) continue;
        const fl_vec3 n = v3_scale(1.0 / v3_norm(p.force), p.force);
        if (isnan(at[k].n.x))
            verify_row("V30", "  direction: any across the axis", hypot(n.x, n.y), 1.0, 1e-14, VERIFY_ABS);
        else verify_row("V30", "  direction", v3_norm(v3_sub(n, at[k].n)), 0.0, 1e-14, VERIFY_ABS);
    }
    lab_free(&l);
}

static void crossed_cylinders(void)
{
    const double degrees[4] = {90, 60, 30, 15}, R[4] = {0.1, 0.1154700538379252, 0.2, 0.3863703305156273};
    for (int k = 0; k < 4; k++) {
        const fl_manual_contact c = {.kind = FL_MANUAL_EE,
                                     .sine = sin(degrees[k] * PI / 180),
                                     .r_low = 0.1,
                                     .r_high = 0.1,
                                     .edge = 1e6};
        double n;
        char what[64];
        const double stiff = fl_manual_stiffness(&c, 1e9, 1e-4, 0, 0, &n);
        snprintf(what, sizeof what, "equivalent radius of cylinders at %g degrees [m]", degrees[k]);
        verify_row("V31", what, pow(stiff / (4.0 / 3.0 * 1e9), 2), R[k], 1e-12, VERIFY_REL);
    }
}

/* --- flat walls --------------------------------------------------------------------------------------- */

enum face { WALL, OPEN, PLATE };
static const char *const FACE[3] = {"block", "block without a side", "plate"};

/* A floe or a sphere on a face of 2 n^2 triangles, in the order of the file or reversed. */
static void on_face(lab *l, enum face kind, int n, int backward, int sphere)
{
    lab_start(l);
    if (sphere) lab_sphere(l, v3(0.123, 0.2, 0.09), 0.1, ZERO, ZERO);
    else
        lab_box(l, v3(0.123, 0.2, 0.29), v3(0.7, 0.5, 0.3), 0.1, q_of_vector(v3(0.01, 0.005, 0.4)), ZERO,
                ZERO);
    lab_wall(l, v3(-3, -3, -2), v3(3, 3, 0), n);
    fl_part *p = &l->surface.part[0];
    const int32_t face = 2 * n * n; /* triangles of one side; the top comes last, a side first */
    if (kind == OPEN) {
        memmove(p->t, p->t + face, (size_t)(p->nt - face) * sizeof *p->t);
        p->nt -= face;
    }
    if (kind == PLATE) {
        memmove(p->t, p->t + 5 * face, (size_t)face * sizeof *p->t);
        p->nt = face;
    }
    for (int32_t k = 0; backward && k < p->nt / 2; k++) {
        const fl_tri t = p->t[k];
        p->t[k] = p->t[p->nt - 1 - k];
        p->t[p->nt - 1 - k] = t;
    }
    lab_make(l, 1e-9);
}

static fl_vec3 start_of_slide;
static fl_vec3 force_at(lab *l, double s)
{
    l->w.b.x[0] = v3_add(start_of_slide, v3(s, 0.37 * s, 0));
    return lab_evaluate_pair(&l->w, 0, 1).force;
}

static double force_change(void *what, double s, double t)
{
    const fl_vec3 a = force_at(what, s), b = force_at(what, t);
    return v3_norm(v3_sub(b, a)) / fmax(v3_norm(a), v3_norm(b));
}

static void wall_by_triangles(void)
{
    const int most = verify_quick() ? 30 : 100;
    const int ns[3] = {1, 10, most};
    for (int sphere = 0; sphere < 2; sphere++) {
        for (int kind = 0; kind < 3; kind++) {
            fl_vec3 f0 = ZERO, t0 = ZERO;
            double off = 0.0, bump = 0.0;
            char what[96];
            for (int k = 0; k < 6; k++) {
                lab l;
                on_face(&l, (enum face)kind, ns[k / 2], k % 2, sphere);
                const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
                if (k == 0) f0 = p.force, t0 = p.torque_i;
                off = fmax(off,
                           fmax(v3_norm(v3_sub(p.force, f0)), v3_norm(v3_sub(p.torque_i, t0))) / v3_norm(f0));
                start_of_slide = l.w.b.x[0];
                if (k % 2 == 0) /* over some ten seams of the finest */
                    bump = fmax(bump, sweep_largest(force_change, &l, 0.0, 0.3, 1e-3));
                lab_free(&l);
            }
            snprintf(what, sizeof what, "%s on a %s: 2, 200, %d triangles, two orders",
                     sphere ? "sphere" : "floe", FACE[kind], 2 * most * most);
            verify_below("H29", what, off, 1e-10);
            verify_below("H29", "  sliding over the seams: largest change of the force", bump, 1e-10);
        }
    }
}

/* Coordinates in single precision, as in STL. */
static void rounded_coordinates(void)
{
    fl_vec3 f[2];
    for (int k = 0; k < 2; k++) {
        lab l;
        const fl_quat q = q_of_vector(v3(0.3, 0.5, -0.2));
        lab_start(&l);
        lab_sphere(&l, q_rotate(q, v3(0.3, 0.2, 1.09)), 0.1, ZERO, ZERO);
        lab_wall(&l, v3(-1, -1, -1), v3(1, 1, 1), 8);
        fl_part *p = &l.surface.part[0];
        for (int32_t v = 0; v < p->nv; v++) {
            const fl_vec3 x = q_rotate(q, p->v[v]);
            p->v[v] = k ? v3((double)(float)x.x, (double)(float)x.y, (double)(float)x.z) : x;
        }
        lab_make(&l, 1e-9);
        if (k) {
            const fl_piece *piece = &l.w.structure.piece[0];
            verify_true("H29", "768 triangles rounded to 32 bits make a solid",
                        piece->kind == FL_PIECE_SOLID);
            verify_row("H29", "  faces", piece->core.nf, 6, 0, VERIFY_ABS);
            verify_row("H29", "  vertices", piece->core.nv, 8, 0, VERIFY_ABS);
        }
        f[k] = lab_evaluate_pair(&l.w, 0, 1).force;
        lab_free(&l);
    }
    /* a plane through rounded corners has an error of 1e-7 m, against an overlap of 0.01 m */
    verify_row("H29", "  force of a sphere over that of the exact box", v3_norm(f[1]) / v3_norm(f[0]), 1.0,
               3e-5, VERIFY_ABS);
}

/* --- shells */

/* An upright L of three squares of 1 m: the inner corner at the origin, the outer ones at (1, 0), (0, 1),
 * ... */
static void make_ell(lab *l)
{
    const fl_vec3 xy[6] = {v3(-1, -1, 0), v3(1, -1, 0), v3(1, 0, 0), v3(0, 0, 0), v3(0, 1, 0), v3(-1, 1, 0)};
    lab_prism(l, 6, xy, -1, 1);
}

static const double GAP = 0.09; /* distance of the leading vertex from the shell; R = 0.1 */

/* Along the wall y = 0 to the outer corner (1, 0), round it, and along the side x = 1. */
static fl_vec3 round_outer(double s)
{
    const double arc = 0.5 * PI * GAP;
    if (s < 0.5) return v3(0.5 + s, GAP, 0.1);
    s -= 0.5;
    if (s < arc) return v3(1 + GAP * sin(s / GAP), GAP * cos(s / GAP), 0.1);
    return v3(1 + GAP, -(s - arc), 0.1);
}

/* Along the wall y = 0 into the inner corner and up the wall x = 0. */
static fl_vec3 round_inner(double s)
{
    return s < 0.5 ? v3(GAP + 0.5 - s, GAP, 0.1) : v3(GAP, GAP + s - 0.5, 0.1);
}

typedef struct {
    lab *l;
    fl_vec3 (*path)(double);
    fl_vec3 tip; /* from the centre of the floe to its leading vertex */
    int energy;
} walk;

static double walk_change(void *what, double s, double t)
{
    const walk *w = what;
    w->l->w.b.x[0] = v3_sub(w->path(s), w->tip);
    const fl_pair a = lab_evaluate_pair(&w->l->w, 0, 1);
    w->l->w.b.x[0] = v3_sub(w->path(t), w->tip);
    const fl_pair b = lab_evaluate_pair(&w->l->w, 0, 1);
    if (w->energy) return fabs(b.energy - a.energy) / fmax(a.energy, b.energy);
    return v3_norm(v3_sub(b.force, a.force)) / fmax(v3_norm(a.force), v3_norm(b.force));
}

/* A needle of 1 m whose tip points towards -x - y: it fits into the inner corner. */
static void make_needle(lab *l)
{
    static const fl_vec3 v[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const int32_t loop[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    int32_t first[9];
    fl_vec3 x[6];
    fl_poly p = {0};
    fl_err err = {0};
    const fl_quat q = q_of_vector(v3(0, 0, 0.25 * PI + 0.1));
    for (int k = 0; k < 9; k++) first[k] = 3 * k;
    for (int k = 0; k < 6; k++)
        x[k] = v3_add(v3(3, 3, 0), q_rotate(q, v3(0.5 * v[k].x, 0.2 * v[k].y, 0.15 * v[k].z)));
    if (fl_poly_make(&p, 6, x, 8, first, loop, &err)) printf("%s\n", err.text), exit(1);
    lab_poly(l, &p, 0.1, ZERO, ZERO);
}

static void walk_round_corners(void)
{
    static const char *const NAME[] = {"sphere", "floe", "needle"};
    for (int what = 0; what < 3; what++) {
        lab l;
        char text[80];
        const char *name = NAME[what];
        lab_start(&l);
        if (what == 0) lab_sphere(&l, v3(3, 3, 0), 0.1, ZERO, ZERO);
        if (what == 1)
            lab_box(&l, v3(3, 3, 0), v3(0.5, 0.4, 0.3), 0.1, q_of_vector(v3(0.3, -0.4, 0.85)), ZERO, ZERO);
        if (what == 2) make_needle(&l);
        make_ell(&l);
        lab_make(&l, 1e-9);
        walk w = {&l, round_outer, ZERO, 0};
        if (what > 0) { /* its vertex that is farthest towards -x - y */
            double low = INFINITY;
            for (int32_t v = 0; v < l.w.b.core[0].nv; v++) {
                const fl_vec3 x = m3_mul(fl_body_axes(&l.w.b, 0), l.w.b.core[0].v[v]);
                if (x.x + x.y < low) low = x.x + x.y, w.tip = x;
            }
        }
        /* at a fixed overlap of 10 mm a displacement of 1e-9 m turns the direction by 1e-9 / 0.09 and
         * changes the overlap at other points by up to 1e-9 / 0.01 of the force */
        const double slope = 1e-9 / (what ? 0.01 : GAP) + 1e-9;
        snprintf(text, sizeof text, "%s round the outer corner: force, change over 1e-9 m", name);
        /* before 0.46 an edge of the floe behind its vertex would still touch in the corner */
        verify_below("H29", text, sweep_largest(walk_change, &w, what ? 0.46 : 0.0, 1.0, 1e-9), slope);
        if (what == 1) {
            lab_free(&l);
            continue; /* into the inner corner a box does not fit */
        }
        w.path = round_inner;
        w.energy = 1;
        snprintf(text, sizeof text, "%s round the inner corner: energy, change over 1e-9 m", name);
        verify_below("H29", text, sweep_largest(walk_change, &w, 0.0, 1.0, 1e-9), 2.0 * 1e-9 / 0.01);
        w.energy = 0;
        snprintf(text, sizeof text, "%s round the inner corner: force, change over 1e-9 m", name);
        verify_below(
            "H29", text, sweep_largest(walk_change, &w, 0.0, 1.0, 1e-9),
            2.0 * (what ? slope : 1e-9 / 0.01)); /* a sphere that moves along one wall into the other */
        lab_free(&l);
    }
}

/* Throws a floe at the L: 0 a face, 1 the outer corner, 2 the inner corner.  Returns energy after over
 * before; *books: impulse of the part against the momentum of the floe. */
static double throw_at_shell(int where, double fraction, double *books)
{
    const fl_vec3 aim[3] = {v3(0.5, 0, 0), v3(1, 0, 0), v3(0, 0, 0)};
    const fl_vec3 from[3] = {v3(0.03, 1, 0.02), v3(0.8, 0.9, 0.05), v3(1, 0.83, 0.04)};
    lab l;
    lab_start(&l);
    const fl_vec3 dir = v3_unit(from[where]);
    lab_box(&l, v3_add(aim[where], v3_scale(0.95, dir)), v3(0.5, 0.4, 0.3), 0.1,
            q_of_vector(v3(0.3, -0.4, 0.85)), v3_scale(-1.0, dir), v3(0.1, 0.2, -0.3));
    make_ell(&l);
    lab_make(&l, 0.0);
    l.w.dt *= fraction;
    const double before = lab_energy(&l), m = l.w.b.m[0];
    const fl_vec3 v0 = l.w.b.v[0], L0 = v3_add(l.w.b.L[0], v3_scale(m, v3_cross(l.w.b.x[0], v0)));
    lab_run(&l, (int64_t)(1.2 / l.w.dt));
    const double after = lab_energy(&l);
    const fl_vec3 dp = v3_scale(m, v3_sub(l.w.b.v[0], v0));
    const fl_vec3 dL = v3_sub(v3_add(l.w.b.L[0], v3_scale(m, v3_cross(l.w.b.x[0], l.w.b.v[0]))), L0);
    const double size = v3_norm(dp);
    /* over the rounding: in free flight each step adds the same dt v to x, with the same rounding */
    *books = fmax(v3_norm(v3_add(dp, l.w.part_impulse[0])), v3_norm(v3_add(dL, l.w.part_moment[0]))) / size /
             (0x1p-52 * (double)l.w.step);
    if (!(size > 0.1 * m) || l.w.n_pair < 0) *books = NAN; /* it missed */
    lab_free(&l);
    return after / before;
}

static void impacts_on_shell(void)
{
    static const char *const WHERE[3] = {"a face", "the outer corner", "the inner corner"};
    for (int where = 0; where < 3; where++) {
        char what[96];
        const int runs = verify_quick() ? 2 : 3;
        double books, h[3], off[3];
        for (int k = 0; k < runs; k++) {
            h[k] = 0.4 / (1 << (2 * k));
            off[k] = fabs(throw_at_shell(where, h[k], &books) - 1.0);
        }
        snprintf(what, sizeof what, "floe thrown at %s of a shell: |energy ratio - 1|", WHERE[where]);
        verify_below("H29", what, off[runs - 1], 1e-4);
        for (int k = 0; k < runs; k++) verify_note("with %g of the automatic step %.2e", h[k], off[k]);
        snprintf(what, sizeof what, "  impulse and moment on part + floe, over steps times rounding");
        verify_below("H29", what, books, 1.0);
    }
}

/* --- spheres in concave edges (structure/persistence_contact.h) */

/* An L of one part, or of two boxes side by side. */
static void make_corner(lab *l, int parts)
{
    if (parts == 1) {
        make_ell(l);
        return;
    }
    lab_wall(l, v3(-1, -1, -1), v3(1, 0, 1), 1);
    lab_wall(l, v3(-1, -1, -1), v3(0, 1, 1), 1);
}

/* A sphere in the inner corner, which its weight presses onto both walls: F = m g / sqrt(2) on each. */
static void sphere_at_rest_in_groove(void)
{
    double depth[2], want = 0.0;
    for (int parts = 1; parts <= 2; parts++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "run.gravity=-6.9367175234400319 -6.9367175234400319 0");
        lab_set(&l, "contact.restitution=0.1");
        lab_sphere(&l, v3(0.0999, 0.0998, 0), 0.1, ZERO, ZERO);
        make_corner(&l, parts);
        lab_make(&l, 0.0);
        lab_run(&l, (int64_t)(1.0 / l.w.dt));
        const fl_pair p = lab_pair(&l, 0);
        depth[parts - 1] = 0.1 - fmin(l.w.b.x[0].x, l.w.b.x[0].y);
        want = pow(l.w.b.m[0] * 6.9367175234400319 / p.k, 2.0 / 3.0);
        lab_free(&l);
    }
    verify_row("SH12", "sphere at rest in a concave edge: overlap for m g/sqrt(2) on each wall [m]", depth[0],
               want, 1e-6, VERIFY_REL);
    verify_row("SH12", "  the same between two parts [m]", depth[1], want, 1e-6, VERIFY_REL);
}

/* A concave edge along y, whose walls rise by `bend`, and a sphere over it. */
static void make_groove(lab *l, double bend, fl_vec3 x, fl_vec3 v, fl_vec3 spin)
{
    fl_err err = {0};
    lab_sphere(l, x, 0.1, v, spin);
    if (fl_surface_add(&l->surface, "groove", 6, &err) < 0) exit(1);
    fl_part *p = &l->surface.part[0];
    for (int k = 0; k < 6; k++) {
        const double side = k % 3 - 1.0, y = k < 3 ? -1.0 : 1.0;
        if (fl_surface_vertex(p, v3(side, y, fabs(side) * tan(bend)), &err)) exit(1);
    }
    for (int k = 0; k < 2; k++)
        if (fl_surface_triangle(p, k, k + 1, k + 4, &err) || fl_surface_triangle(p, k, k + 4, k + 3, &err))
            exit(1);
}

/* A sphere thrown into it: energy after over before. */
static double throw_into_groove(double bend, double fraction)
{
    lab l;
    lab_start(&l);
    make_groove(&l, bend, v3(0.02, 0, 0.25), v3(-0.1, 0.3, -1), v3(3, 1, 2));
    lab_make(&l, 0.0);
    l.w.dt *= fraction;
    const double before = lab_energy(&l);
    lab_run(&l, (int64_t)(0.35 / l.w.dt));
    const double after = lab_energy(&l);
    if (!(l.w.b.v[0].z > 0.1)) exit(1); /* it missed */
    lab_free(&l);
    return after / before;
}

/* A sphere that falls straight into the edge leaves with the restitution.  One that slides along it has the
 * friction of both walls, each loaded with half of m g/cos. */
static void groove_losses(void)
{
    static const double BEND[] = {0.2, 0.8, 1.3};
    for (size_t k = 0; k < sizeof BEND / sizeof *BEND; k++) {
        char what[96];
        lab l;
        const double deep = 0.1 / cos(BEND[k]);
        lab_start(&l);
        lab_set(&l, "contact.restitution=0.5");
        make_groove(&l, BEND[k], v3(0, 0, deep + 0.005), v3(0, 0, -1), ZERO);
        lab_make(&l, 0.0);
        l.w.dt *= 0.1;
        for (double t = 0.0; t < 0.5 && !(l.w.b.v[0].z > 0.0 && l.w.b.x[0].z > deep); t += l.w.dt)
            lab_run(&l, 1);
        snprintf(what, sizeof what, "sphere straight into a concave edge of %g rad: restitution",
                 2.0 * BEND[k]);
        verify_row("SH12", what, l.w.b.v[0].z, 0.5, 1e-3, VERIFY_ABS);
        lab_free(&l);

        lab_start(&l);
        lab_set(&l, "run.gravity=9.81");
        lab_set(&l, "contact.friction=0.1");
        lab_set(&l, "contact.restitution=0.1");
        make_groove(&l, BEND[k], v3(0, -0.5, deep), v3(0, 4, 0), ZERO);
        lab_make(&l, 0.0);
        lab_run(&l, (int64_t)(0.1 / l.w.dt));
        const double v0 = l.w.b.v[0].y, t0 = fl_world_time(&l.w);
        lab_run(&l, (int64_t)(0.05 / l.w.dt));
        const double slow = (v0 - l.w.b.v[0].y) / (fl_world_time(&l.w) - t0);
        snprintf(what, sizeof what, "  along it: deceleration over mu g/cos");
        verify_row("SH12", what, slow / (0.1 * 9.81 / cos(BEND[k])), 1.0, 0.02, VERIFY_ABS);
        lab_free(&l);
    }
}

static void spheres_in_grooves(void)
{
    static const double BEND[] = {0.01, 0.1, 0.5, 1.0};
    for (size_t k = 0; k < sizeof BEND / sizeof *BEND; k++) {
        char what[96];
        double off[3];
        const int runs = verify_quick() ? 2 : 3;
        for (int r = 0; r < runs; r++) off[r] = fabs(throw_into_groove(BEND[k], 0.4 / (1 << (2 * r))) - 1.0);
        snprintf(what, sizeof what, "sphere thrown into a concave edge of %g rad: |energy ratio - 1|",
                 2.0 * BEND[k]);
        verify_below("SH12", what, off[runs - 1], 1e-4);
        for (int r = 0; r < runs; r++)
            verify_note("with %g of the automatic step %.2e", 0.4 / (1 << (2 * r)), off[r]);
    }
}

/* A box or a capsule tumbles in a concave edge of two walls, leaning on one as it meets the other: largest
 * residual over the throughput, with `surrogate`.  worst: largest error of a surrogate force found by an
 * evaluation. */
static double tumble_in_groove(int32_t run, double surrogate, double *worst)
{
    static const fl_vec3 V[6] = {{-3, -3, 2}, {0, -3, 0}, {0, 3, 0}, {-3, 3, 2}, {3, -3, 2}, {3, 3, 2}};
    static const int32_t T[4][3] = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    fl_rng g = fl_rng_of(1, run, FL_RNG_TEST);
    fl_err err = {0};
    double most = 0.0;
    lab l;
    lab_start(&l);
    lab_set(&l, "run.gravity=0 0 -9.81");
    lab_set(&l, "contact.stiffness_factor=0.1");
    lab_set(&l, "contact.friction=0.4");
    lab_set(&l, "contact.restitution=0.3");
    lab_setf(&l, "contact.surrogate=%.17g", surrogate);
    const fl_vec3 v = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), -1.0),
                  spin = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1));
    if (run % 2) lab_box(&l, v3(0, 0, 1.5), v3(0.4, 0.3, 0.25), 0.05, q_of_vector(spin), v, spin);
    else {
        fl_poly core = {0};
        if (fl_poly_make(&core, 2, (const fl_vec3[2]){{0.01, 0, 3.2}, {-0.01, 0, 2.2}}, 0, NULL, NULL, &err))
            exit(1);
        lab_poly(&l, &core, 0.3, v, spin);
    }
    if (fl_surface_add(&l.surface, "groove", 6, &err) < 0) exit(1);
    for (int k = 0; k < 6; k++)
        if (fl_surface_vertex(&l.surface.part[0], V[k], &err)) exit(1);
    for (int k = 0; k < 4; k++)
        if (fl_surface_triangle(&l.surface.part[0], T[k][0], T[k][1], T[k][2], &err)) exit(1);
    lab_make(&l, 2e-5);
    for (int k = 0; k < 100; k++) {
        if (lab_run(&l, 600)) exit(1);
        fl_energy_update(&l.w);
        most = fmax(most, fabs(l.w.ledger.residual));
    }
    if (surrogate > 0.0) *worst = fmax(*worst, fl_surrogate_count_sum(l.w.surrogate_counts, 1).worst_error);
    most /= l.w.ledger.throughput;
    lab_free(&l);
    return most;
}

/* The surrogate of a contact does not include a wall that is yet to touch. */
static void surrogate_in_grooves(void)
{
    double most[2] = {0}, worst = 0.0;
    for (int32_t run = 0; run < (verify_quick() ? 4 : 12); run++)
        for (int way = 0; way < 2; way++)
            most[way] = fmax(most[way], tumble_in_groove(run, way ? 1e-3 : 0.0, &worst));
    verify_below("SH14", "floes in a concave edge, restitution 0.3, friction 0.4: residual, exact", most[0],
                 1e-5);
    verify_below("SH14", "  by surrogates of 1e-3: the same", most[1], 1e-3);
    verify_below("SH14", "  largest error of a surrogate force", worst, 0.1);
}

/* --- a hull */

/* A sheet with normal z and curvatures 1/8 and 1/5 of 1/m, of 2 n^2 triangles on 3 m by 3 m. */
static void make_sheet(lab *l, int n)
{
    fl_err err = {0};
    if (fl_surface_add(&l->surface, "hull", 4, &err) < 0) exit(1);
    fl_part *p = &l->surface.part[0];
    for (int j = 0; j <= n; j++) {
        for (int i = 0; i <= n; i++) {
            const double x = 3.0 * i / n - 1.5 + 0.01 * j / n, y = 3.0 * j / n - 1.5;
            if (fl_surface_vertex(p, v3(x, y, -x * x / 16.0 - y * y / 10.0), &err)) exit(1);
        }
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) {
            const int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            if (fl_surface_triangle(p, a, b, c, &err) || fl_surface_triangle(p, a, c, d, &err)) exit(1);
        }
    }
}

/* Half the change of the energy when the floe moves by +- d and rotates by +- turn. */
static double energy_difference(lab *l, fl_vec3 x, fl_quat q, fl_vec3 d, fl_vec3 turn)
{
    double e[2];
    for (int k = 0; k < 2; k++) {
        const double way = k ? -1.0 : 1.0;
        lab_pose(&l->w, 0, v3_madd(x, way, d), q_mul(q_of_vector(v3_scale(way, turn)), q));
        e[k] = lab_evaluate_pair(&l->w, 0, 1).energy;
    }
    lab_pose(&l->w, 0, x, q);
    return 0.5 * (e[0] - e[1]);
}

/* Force and moment against the gradient of the energy: on a side of the floe, an edge, a corner. */
static void gradient_on_hull(void)
{
    static const struct {
        const char *what;
        fl_vec3 turn;
        int middle;
    } POSE[4] = {{"a side", {0.004, -0.003, 0.3}, 1},
                 {"a side, aslant,", {0.06, 0.02, 0.1}, 1},
                 {"an edge", {0.5, 0.005, 0.0}, 0},
                 {"a corner", {0.5, 0.45, 0.2}, 0}};
    static const double h = 1e-7; /* the strips of such narrow triangles at edges carry 1e-6 of the force */
    for (int k = 0; k < 4; k++) {
        lab l;
        char what[96];
        const fl_quat q = q_of_vector(POSE[k].turn);
        const fl_mat3 M = q_matrix(q);
        /* of a side that touches with its middle, or of the lowest corner */
        const double low =
            POSE[k].middle ? 0.35 : 0.35 * (fabs(M.m[2][0]) + fabs(M.m[2][1]) + fabs(M.m[2][2]));
        double df = 0.0, dm = 0.0;
        lab_start(&l);
        lab_box(&l, v3(0, 0, 5), v3(0.4, 0.4, 0.4), 0.05, q_one(), ZERO, ZERO);
        make_sheet(&l, 120);
        lab_make(&l, 1e-9);
        const fl_vec3 x = v3(0.013, 0.007, low + 0.044), axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        lab_pose(&l.w, 0, x, q);
        const fl_pair now = lab_evaluate_pair(&l.w, 0, 1);
        for (int c = 0; c < 3; c++) {
            const fl_vec3 d = v3_scale(h, axis[c]);
            df = fmax(df, fabs(v3_dot(now.force, axis[c]) + energy_difference(&l, x, q, d, ZERO) / h));
            dm = fmax(dm, fabs(v3_dot(now.torque_i, axis[c]) + energy_difference(&l, x, q, ZERO, d) / h));
        }
        const double size = v3_norm(now.force);
        if (!(size > 1e3)) df = NAN; /* it does not touch */
        snprintf(what, sizeof what, "%s of a floe on 28 800 triangles: F + grad W, over F", POSE[k].what);
        verify_below("H29", what, df / size, 1e-5);
        verify_below("H29", "  moment + dW/d turn, over F 1 m", dm / size, 1e-5);
        lab_free(&l);
    }
}

int main(void)
{
    verify_begin("structures");
    sphere_and_cylinder();
    crossed_cylinders();
    wall_by_triangles();
    rounded_coordinates();
    walk_round_corners();
    impacts_on_shell();
    sphere_at_rest_in_groove();
    spheres_in_grooves();
    surrogate_in_grooves();
    groove_losses();
    gradient_on_hull();
    return verify_end();
}
