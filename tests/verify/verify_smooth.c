/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One energy in difficult geometry: surfaces that are not convex, thin poles, slim corners. */
#include <math.h>
#include <stdlib.h>
#include "base/pi.h"
#include "base/rng.h"
#include "narrow/gjk.h"
#include "support/small_world.h"
#include "support/shapes.h"
#include "support/verify.h"

#define RADIUS 0.05

static const fl_vec3 ZERO = {0, 0, 0};

/* --- triangles ---------------------------------------------------------------------------------------- */

static void triangles(lab *l, int32_t nv, const fl_vec3 *v, int32_t nt, const int32_t (*t)[3], fl_quat q)
{
    fl_err err = {0};
    const int32_t k = fl_surface_add(&l->surface, "part", 4, &err);
    if (k < 0) exit(1);
    fl_part *p = &l->surface.part[k];
    for (int32_t i = 0; i < nv; i++)
        if (fl_surface_vertex(p, q_rotate(q, v[i]), &err)) exit(1);
    for (int32_t i = 0; i < nt; i++)
        if (fl_surface_triangle(p, t[i][0], t[i][1], t[i][2], &err)) exit(1);
}

static fl_pair evaluate_at(lab *l, fl_vec3 x, fl_quat q)
{
    lab_pose(&l->w, 0, x, q);
    return lab_evaluate_pair(&l->w, 0, 1);
}

/* Deviation of force and moment from the gradient of the energy, over the force: the best of several
 * difference steps. */
static double off_gradient(lab *l, fl_vec3 x, fl_quat q, double step)
{
    const fl_pair now = evaluate_at(l, x, q);
    const double arm = l->w.b.bounding_radius[0], size = v3_norm(now.force) + v3_norm(now.torque_i) / arm;
    double best = INFINITY;
    for (int k = 0; k < 4; k++, step /= 3.0) {
        double worst = 0.0;
        for (int d = 0; d < 6; d++) {
            const fl_vec3 e = v3(d % 3 == 0, d % 3 == 1, d % 3 == 2);
            double w[2];
            for (int s = 0; s < 2; s++) {
                const double h = s ? -step : step;
                w[s] = d < 3 ? evaluate_at(l, v3_madd(x, h, e), q).energy
                             : evaluate_at(l, x, q_mul(q_of_vector(v3_scale(h / arm, e)), q)).energy;
            }
            const double derivative = d < 3 ? v3_dot(now.force, e) : v3_dot(now.torque_i, e) / arm;
            worst = fmax(worst, fabs((w[0] - w[1]) / (2.0 * step) + derivative) / size);
        }
        best = fmin(best, worst);
    }
    return best;
}

/* --- inclined walls of an L, with a floe near them that does not touch -------------------------------- */

/* An L of 2 m with legs of 1 m, 4 m high, and the two blocks of which it consists. */
static void make_ell(lab *l, fl_quat q, fl_poly block[2])
{
    static const int32_t SIDE[6][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 0}};
    static const double XY[6][2] = {{-1, -1}, {1, -1}, {1, 0}, {0, 0}, {0, 1}, {-1, 1}};
    static const int32_t CAP[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    fl_vec3 v[12];
    int32_t t[20][3], n = 0;
    fl_err err = {0};
    for (int k = 0; k < 12; k++) v[k] = v3(XY[k % 6][0], XY[k % 6][1], k < 6 ? -2 : 2);
    for (int k = 0; k < 6; k++) {
        const int32_t a = SIDE[k][0], b = SIDE[k][1];
        t[n][0] = a, t[n][1] = b, t[n++][2] = b + 6;
        t[n][0] = a, t[n][1] = b + 6, t[n++][2] = a + 6;
    }
    for (int k = 0; k < 4; k++) {
        for (int c = 0; c < 3; c++) t[n][c] = CAP[k][2 - c], t[n + 1][c] = CAP[k][c] + 6;
        n += 2;
    }
    triangles(l, 12, v, n, (const int32_t(*)[3])t, q);
    const fl_vec3 middle[2] = {v3(0, -0.5, 0), v3(-0.5, 0, 0)}, half[2] = {v3(1, 0.5, 2), v3(0.5, 1, 2)};
    for (int k = 0; k < 2; k++) {
        if (fl_poly_box(&block[k], half[k], &err)) exit(1);
        fl_poly_to_frame(&block[k], v3_neg(middle[k]), q_matrix(q_conj(q)));
    }
}

/* Distance of the floe from the nearer block. */
static double distance_to_blocks(const fl_world *w, const fl_poly block[2])
{
    const fl_poly *p = &w->b.core[0];
    fl_vec3 v[8];
    double least = INFINITY;
    for (int k = 0; k < p->nv; k++) v[k] = v3_add(w->b.x[0], m3_mul(fl_body_axes(&w->b, 0), p->v[k]));
    for (int k = 0; k < 2; k++) {
        fl_gap gap;
        fl_gjk((fl_core){v, p->nv, NULL}, (fl_core){block[k].v, block[k].nv, NULL}, NULL, &gap);
        least = fmin(least, gap.d);
    }
    return least;
}

/* Rounds coordinates as files with six digits or floats do: corners are off the planes of their faces. */
static void round_coordinates(lab *l, double grid)
{
    const fl_part *p = &l->surface.part[0];
    for (int32_t k = 0; k < p->nv; k++)
        p->v[k] =
            v3_scale(grid, v3(round(p->v[k].x / grid), round(p->v[k].y / grid), round(p->v[k].z / grid)));
}

static void no_energy_apart(double grid)
{
    const int many = verify_quick() ? 2000 : 40000;
    const fl_quat q = q_of_vector(v3(0.4, 0.6, 0.3));
    int apart = 0, touch = 0, wrong = 0;
    double most = 0.0;
    fl_poly block[2] = {0};
    lab l;
    lab_start(&l);
    lab_box(&l, v3(50, 0, 0), v3(2.05, 0.35, 0.35), RADIUS, q_one(), ZERO, ZERO);
    make_ell(&l, q, block);
    if (grid > 0.0) round_coordinates(&l, grid);
    lab_make(&l, 1e-9);
    verify_note("a long floe around an inclined L, with the distance to its two blocks");
    if (grid > 0.0) verify_note("corners of the L rounded to %g m", grid);
    verify_row("SH1", "energy where nothing touches [J]",
               evaluate_at(&l, v3(-3.5, -1.4, -2.25), q_one()).energy, 0.0, 0.0, VERIFY_ABS);
    for (int k = 0; k < many; k++) {
        fl_rng g = fl_rng_of(11, k, FL_RNG_TEST);
        const fl_vec3 x = v3(fl_rng_in(&g, -4, 4), fl_rng_in(&g, -4, 4), fl_rng_in(&g, -4, 4));
        const fl_quat turn =
            q_of_vector(v3(fl_rng_in(&g, -2, 2), fl_rng_in(&g, -2, 2), fl_rng_in(&g, -2, 2)));
        const double W = evaluate_at(&l, x, turn).energy, d = distance_to_blocks(&l.w, block);
        const int clear = d > RADIUS + grid;
        apart += clear;
        touch += d > 0.0 && d < RADIUS;
        most = clear ? fmax(most, W) : most;
        wrong += d > 0.0 && d < RADIUS * (1.0 - 1e-6) - grid && !(W > 0.0);
    }
    verify_note("%d poses apart, %d in contact", apart, touch);
    verify_true("SH1", "both came", apart > many / 10 && touch > many / 1000);
    verify_row("SH1", "largest energy of those apart [J]", most, 0.0, 0.0, VERIFY_ABS);
    verify_row("SH1", "in contact and without energy", wrong, 0.0, 0.0, VERIFY_ABS);
    for (int k = 0; k < 2; k++) fl_poly_free(&block[k]);
    lab_free(&l);
}

/* A point beyond the edge of an open surface is not behind the surface. */
static void beside_free_edges(void)
{
    const double s = tan(PI / 6.0);
    const fl_vec3 side[6] = {v3(s, -4, -1), v3(s, 4, -1),       v3(0, -4, 0),
                             v3(0, 4, 0),   v3(-0.15, -4, 0.3), v3(-0.15, 4, 0.3)};
    const int32_t t[4][3] = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}}; /* outward is -x */
    const fl_vec3 sheet[6] = {v3(-2, -3, 0), v3(-2, 3, 0),   v3(0, -3, 0),
                              v3(0, 3, 0),   v3(2, -3, -.3), v3(2, 3, -.3)};
    const int32_t u[4][3] = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}};
    lab l;
    lab_start(&l);
    lab_box(&l, v3(50, 0, 0), v3(1.05, 1.05, 0.55), RADIUS, q_one(), ZERO, ZERO);
    triangles(&l, 6, side, 4, t, q_one());
    lab_make(&l, 1e-9);
    verify_row("SH2", "a floe above the end of a flared side, 4 cm off [J]",
               evaluate_at(&l, v3(-1.24, 0, 0), q_one()).energy, 0.0, 0.0, VERIFY_ABS);
    lab_free(&l);
    lab_start(&l);
    lab_box(&l, v3(50, 0, 0), v3(0.55, 0.55, 0.35), RADIUS, q_one(), ZERO, ZERO);
    triangles(&l, 6, sheet, 4, u, q_one());
    lab_make(&l, 1e-9);
    verify_row("SH2", "a floe beside the end of a bent sheet, 7 cm off [J]",
               evaluate_at(&l, v3(-2.62, 0.1, -0.1), q_one()).energy, 0.0, 0.0, VERIFY_ABS);
    lab_free(&l);
}

/* --- seams -------------------------------------------------------------------------------------------- */

/* Two panels that meet in x = 0 and rise (or fall) by the slope on both sides. */
static void two_panels(lab *l, double slope)
{
    const fl_vec3 v[6] = {v3(-3, -3, 3 * slope), v3(-3, 3, 3 * slope), v3(0, -3, 0),
                          v3(0, 3, 0),           v3(3, -3, 3 * slope), v3(3, 3, 3 * slope)};
    const int32_t t[4][3] = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}};
    triangles(l, 6, v, 4, t, q_one());
}

/* Change of the energy beyond the work of the force, largest over the steps from -way to way along x. */
static double energy_jump(lab *l, fl_vec3 x, fl_quat q, double way, int steps)
{
    double worst = 0.0;
    fl_pair was = evaluate_at(l, v3(x.x - way, x.y, x.z), q);
    for (int k = 1; k <= steps; k++) {
        const double h = 2.0 * way / steps;
        const fl_pair now = evaluate_at(l, v3(x.x - way + k * h, x.y, x.z), q);
        const double work = 0.5 * h * (was.force.x + now.force.x);
        worst = fmax(worst, fabs(now.energy - was.energy + work) / now.energy);
        was = now;
    }
    return worst;
}

static void seams_of_panels(void)
{
    const double slope[4] = {1e-3, 1e-2, 0.1, 0.4};
    verify_note("a corner and an edge go over the seam of two panels that rise on both sides, in steps of 2 "
                "um: change of the energy beyond the work, over the energy");
    for (int k = 0; k < 4; k++) {
        const fl_quat upon_edge = q_about_axis(1, PI / 4.0), upon_corner = q_of_vector(v3(0.7, 0.6, 0.3));
        char what[96];
        lab l;
        lab_start(&l);
        lab_box(&l, v3(50, 0, 0), v3(0.55, 0.45, 0.35), RADIUS, q_one(), ZERO, ZERO);
        two_panels(&l, slope[k]);
        lab_make(&l, 1e-9);
        for (int corner = 0; corner < 2; corner++) {
            const fl_quat q = corner ? upon_corner : upon_edge;
            fl_vec3 low = v3(0, 0, 1);
            for (int c = 0; c < 8; c++) {
                const fl_vec3 r = q_rotate(q, v3(c & 1 ? 0.5 : -0.5, c & 2 ? 0.4 : -0.4, c & 4 ? 0.3 : -0.3));
                if (r.z < low.z) low = r;
            }
            const fl_vec3 x = v3(-low.x, 0.013, RADIUS - 0.005 - low.z);
            const double way = fmin(3.0 * RADIUS * slope[k], 0.04) + 1e-5;
            snprintf(what, sizeof what, "%s, slope %g", corner ? "corner" : "edge along the seam", slope[k]);
            verify_below("SH3", what, energy_jump(&l, x, q, way, (int)(2.0 * way / 2e-6)), 1e-3);
        }
        lab_free(&l);
    }
}

/* A capsule that lies on one panel of a roof slides off its end. */
static void ends_of_roof(void)
{
    lab l;
    double worst = 0.0;
    lab_start(&l);
    lab_capsule(&l, v3(50, 0, 0), v3(0.3, 0, 0), RADIUS);
    two_panels(&l, -0.1);
    lab_make(&l, 1e-9);
    for (int k = 0; k <= 81; k++) {
        const double end = k % 2 ? 3.0 : -3.0;
        const fl_vec3 x = v3(0.5, end + 0.0015 * (k - 40) + 1e-4, RADIUS - 0.004 - 0.05);
        const fl_quat q = q_of_vector(v3(0, atan(0.1), 0.02));
        if (evaluate_at(&l, x, q).energy > 1e-6) worst = fmax(worst, off_gradient(&l, x, q, 1e-5));
    }
    verify_below("SH4", "a capsule slides off the ends of a roof: |F + grad W| / F", worst, 1e-6);
    lab_free(&l);
}

/* Over a re-entrant corner of a deck, or of the edge of a sheet, a point at equal distance from both edges
 * counts over one of them. */
static void inner_corners(void)
{
    const double bends[3] = {90, 30, 2};
    const fl_quat q = q_mul(q_about_axis(1, 0.6154797),
                            q_about_axis(0, PI / 4.0)); /* a corner of the box lies below all others */
    fl_vec3 low = v3(0, 0, 1);
    for (int k = 0; k < 8; k++) {
        const fl_vec3 r = q_rotate(q, v3(k & 1 ? 0.3 : -0.3, k & 2 ? 0.3 : -0.3, k & 4 ? 0.3 : -0.3));
        if (r.z < low.z) low = r;
    }
    for (int sheet = 0; sheet < 2; sheet++) {
        double worst = 0.0, off = 0.0;
        for (int k = 0; k < 3; k++) {
            const double a = PI * (1.0 - bends[k] / 180.0);
            const fl_vec3 d = v3(cos(a), sin(a), 0);
            const fl_vec3 xy[6] = {v3(-1.5, -1, 0), v3(1, -1, 0), v3(1, 0, 0), v3(0, 0, 0), d,
                                   v3(-1.5, d.y, 0)};
            const int32_t fan[4][3] = {{3, 4, 5}, {3, 5, 0}, {3, 0, 1}, {3, 1, 2}};
            lab l;
            lab_start(&l);
            lab_box(&l, v3(0, 0, 50), v3(0.35, 0.35, 0.35), 0.05, q_one(), ZERO, ZERO);
            if (sheet) triangles(&l, 6, xy, 4, fan, q_one());
            else lab_prism(&l, 6, xy, -1, 0);
            lab_make(&l, 1e-12);
            for (double s = 0.001; s < 0.03; s *= 3.0) {
                const fl_vec3 tip = v3(0, 0.1 * s, 0.05 - s);
                const double w = evaluate_at(&l, v3_sub(v3(-1e-10, tip.y, tip.z), low), q).energy,
                             more = evaluate_at(&l, v3_sub(v3(1e-10, tip.y, tip.z), low), q).energy;
                worst = fmax(worst, fabs(more - w) / w);
                off = fmax(off, off_gradient(&l, v3_sub(v3(0.05 * s, tip.y, tip.z), low), q, 1e-2 * s));
            }
            lab_free(&l);
        }
        verify_below("SH10",
                     sheet ? "over a re-entrant corner of the edge of a sheet: change of W over 0.2 nm"
                           : "over a re-entrant corner of a deck: change of W over 0.2 nm",
                     worst, 1e-5);
        verify_below("SH10", "beside it: |F + grad W| / F", off, 3e-7);
    }
}

/* --- degenerate triangles ----------------------------------------------------------------------------- */

static void flat_triangles(void)
{
    const fl_vec3 v[7] = {v3(0, -2, 0),  v3(0, 2, 0),  v3(-2, -2, -1), v3(-2, 2, -1),
                          v3(2, -2, -1), v3(2, 2, -1), v3(0, 0.3, 0)};
    const int32_t plain[4][3] = {{2, 0, 1}, {2, 1, 3}, {0, 4, 5}, {0, 5, 1}},
                  last[6][3] = {{2, 0, 1}, {2, 1, 3}, {0, 4, 6}, {6, 4, 5}, {6, 5, 1}, {0, 6, 1}},
                  first[6][3] = {{0, 6, 1}, {2, 0, 1}, {2, 1, 3}, {0, 4, 6}, {6, 4, 5}, {6, 5, 1}};
    double W[3];
    for (int k = 0; k < 3; k++) {
        lab l;
        lab_start(&l);
        lab_box(&l, v3(50, 0, 0), v3(0.55, 0.45, 0.35), RADIUS, q_one(), ZERO, ZERO);
        triangles(&l, k ? 7 : 6, v, k ? 6 : 4, k == 0 ? plain : k == 1 ? last : first, q_one());
        lab_make(&l, 1e-9);
        W[k] = evaluate_at(&l, v3(0.1, 0.1, 0.345), q_of_vector(v3(0.01, 0.02, 0.3))).energy;
        lab_free(&l);
    }
    verify_note(
        "a box on the ridge of a roof, one side of which has one vertex more and a triangle without area");
    verify_row("SH5", "the triangle is the last: energy [J]", W[1], W[0], 1e-12, VERIFY_REL);
    verify_row("SH5", "it is the first", W[2], W[0], 1e-12, VERIFY_REL);
}

/* A stiffener behind a plate has no effect in front of it. */
static void fin_behind_plate(void)
{
    const fl_vec3 v[10] = {v3(-2, -3, 0), v3(-2, 3, 0),  v3(0, -3, 0), v3(0, 3, 0),     v3(2, -3, 0),
                           v3(2, 3, 0),   v3(0, -3, -1), v3(0, 3, -1), v3(2.5, -3, -1), v3(2.5, 3, -1)};
    const int32_t t[8][3] = {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3},
                             {4, 8, 9}, {4, 9, 5}, {2, 6, 7}, {2, 7, 3}};
    double W[2][2], off = 0.0;
    for (int fin = 0; fin < 2; fin++) {
        lab l;
        lab_start(&l);
        lab_box(&l, v3(50, 0, 0), v3(0.55, 0.45, 0.35), RADIUS, q_one(), ZERO, ZERO);
        triangles(&l, 10, v, fin ? 8 : 6, t, q_one());
        lab_make(&l, 1e-9);
        const fl_quat lean = q_about_axis(1, 0.3);
        const fl_vec3 upon = v3(0.4, 0.1, 0.5 * sin(0.3) + 0.3 * cos(0.3) + RADIUS - 0.004);
        W[fin][0] = evaluate_at(&l, upon, lean).energy;
        W[fin][1] = evaluate_at(&l, v3(0.1, 0.1, 0.346), q_one()).energy;
        if (fin) off = off_gradient(&l, upon, lean, 1e-6);
        lab_free(&l);
    }
    verify_row("SH6", "an edge on a plate with a fin behind it: energy [J]", W[1][0], W[0][0], 1e-12,
               VERIFY_REL);
    verify_row("SH6", "a face there", W[1][1], W[0][1], 1e-12, VERIFY_REL);
    verify_below("SH6", "|F + grad W| / F", off, 1e-6);
}

/* --- thin poles --------------------------------------------------------------------------------------- */

static void thin_poles(void)
{
    const int many = verify_quick() ? 6 : 40;
    double worst[2] = {0.0, 0.0};
    for (double r = 1.0; r > 0.01; r *= 0.5) {
        for (int k = 0; k < many; k++) {
            lab l;
            lab_start(&l);
            lab_box(&l, v3(50, 0, 0), v3(0.6, 0.5, 0.4), 0.1, q_one(), ZERO, ZERO);
            lab_cone(&l, (fl_cone){v3(0, 0, -5), v3(0, 0, 5), r, r});
            lab_make(&l, 1e-9);
            fl_rng g = fl_rng_of(1, k, FL_RNG_TEST);
            const double s = 0.1 * fl_rng_in(&g, 0.1, 0.9), lean = fl_rng_in(&g, 0.6, 0.9),
                         yaw = fl_rng_in(&g, -0.3, 0.3), up = fl_rng_in(&g, 0, 3);
            const fl_quat q[2] = {q_mul(q_about_axis(2, yaw), q_about_axis(1, lean)),
                                  q_mul(q_about_axis(0, up), q_of_vector(v3(0, 0.2 * yaw, 0.1 * yaw)))};
            const fl_vec3 on[2] = {
                q_rotate(q[0], v3(-0.5, fl_rng_in(&g, -0.2, 0.2), -0.3)),
                q_rotate(q[1], v3(-0.5, fl_rng_in(&g, -0.38, 0.38), fl_rng_in(&g, -0.28, 0.28)))};
            for (int face = 0; face < 2; face++) {
                const fl_vec3 x = v3(r + 0.1 - s - on[face].x, -on[face].y, -on[face].z);
                const fl_pair p = evaluate_at(&l, x, q[face]);
                if (p.touching && !p.cores_overlap)
                    worst[face] = fmax(worst[face], off_gradient(&l, x, q[face], 1e-5));
            }
            lab_free(&l);
        }
    }
    verify_note("a box of 1 m and a radius of 0.1 m across poles of 1 m down to 16 mm");
    verify_below("SH7", "an edge: |F + grad W| / F", worst[0], 3e-7);
    verify_below("SH7", "a face", worst[1], 3e-7);
    lab l;
    lab_start(&l);
    lab_box(&l, v3(50, 0, 0), v3(0.6, 0.5, 0.4), 0.1, q_one(), ZERO, ZERO);
    lab_cone(&l, (fl_cone){v3(0, 0, -5), v3(0, 0, 5), 1, 1});
    lab_make(&l, 1e-9);
    const fl_quat q = q_about_axis(1, PI / 4.0);
    const fl_vec3 e = q_rotate(q, v3(-0.5, 0.4, -0.3));
    const double x0 = 1.05, y0 = sqrt(1.1 * 1.1 - x0 * x0);
    const fl_pair a = evaluate_at(&l, v3(x0 - e.x, y0 - e.y - 1e-12, 0), q),
                  b = evaluate_at(&l, v3(x0 - e.x, y0 - e.y + 1e-12, 0), q);
    verify_below("SH7", "where the end of an edge passes s = 0: change of the force over 2 pm",
                 v3_norm(v3_sub(a.force, b.force)) / v3_norm(a.force), 1e-10);
    lab_free(&l);
}

/* An octagon has no preferred axes in its plane.  Beside the end of a pole, where cone and polygon share
 * the energy, the choice of axes must not matter. */
static void octagon_axes(void)
{
    const fl_quat turns[2] = {q_of_vector(v3(0.3, 0.5, 0.2)), q_of_vector(v3(0, 0, 0.7))};
    double worst = 0.0;
    for (int k = 0; k < 2; k++) {
        fl_vec3 xy[8];
        double W[2][60];
        for (int c = 0; c < 8; c++) xy[c] = v3(cos(PI * c / 4.0), sin(PI * c / 4.0), 0);
        for (int turned = 0; turned < 2; turned++) { /* built in this orientation, or rotated into it */
            fl_poly straight = {0}, built = {0};
            fl_err err = {0};
            lab l;
            lab_start(&l);
            if (fl_poly_prism(&straight, 8, xy, -0.3, 0.3, &err)) exit(1);
            shape_copy_moved(&built, &straight, 1, turned ? q_one() : turns[k], ZERO);
            lab_poly(&l, &built, 0.05, ZERO, ZERO);
            lab_cone(&l, (fl_cone){v3(0, 0, 0), v3(0, 0, 20), 2, 2});
            lab_make(&l, 1e-14);
            const fl_quat own = l.w.b.q[0], q = turned ? q_mul(turns[k], own) : own;
            double far = 0.0;
            for (int32_t v = 0; v < l.w.b.core[0].nv; v++)
                far = fmax(far, -q_rotate(q, l.w.b.core[0].v[v]).x);
            for (int c = 0; c < 60; c++)
                W[turned][c] = evaluate_at(&l, v3(2.04 + far, 0, 1.0 + 0.05 * c), q).energy;
            fl_poly_free(&straight);
            lab_free(&l);
        }
        for (int c = 0; c < 60; c++) worst = fmax(worst, fabs(W[0][c] / W[1][c] - 1.0));
    }
    verify_below("SH11", "an octagon beside the end of a pole, built turned or turned: W", worst, 1e-10);
}

/* All corners of a disc count, for any number of them. */
static void many_corners(void)
{
    enum { CORNERS = 240 };
    double worst = 0.0;
    fl_vec3 xy[CORNERS];
    fl_poly disc = {0};
    fl_err err = {0};
    lab l;
    for (int k = 0; k < CORNERS; k++) xy[k] = v3(cos(2 * PI * k / CORNERS), sin(2 * PI * k / CORNERS), 0);
    lab_start(&l);
    if (fl_poly_prism(&disc, CORNERS, xy, -0.2, 0.2, &err)) exit(1);
    lab_poly(&l, &disc, 0.1, ZERO, ZERO);
    lab_cone(&l, (fl_cone){v3(0, 0, -5), v3(0, 0, 5), 1, 1});
    lab_make(&l, 1e-9);
    fl_rng g = fl_rng_of(2, 0, FL_RNG_TEST);
    for (int k = 0; k < (verify_quick() ? 6 : 40); k++) {
        const fl_quat lies =
            q_mul(q_of_vector(v3(0, 0.02 * fl_rng_in(&g, -1, 1), 0.02 * fl_rng_in(&g, -1, 1))),
                  q_about_axis(1, PI / 2.0));
        const double s = 0.1 * fl_rng_in(&g, 0.3, 0.9);
        const fl_vec3 x = v3(1.3 - s, fl_rng_in(&g, -0.5, 0.5), fl_rng_in(&g, -0.5, 0.5));
        const fl_pair p = evaluate_at(&l, x, lies);
        if (p.touching && !p.cores_overlap) worst = fmax(worst, off_gradient(&l, x, lies, 1e-5));
    }
    lab_free(&l);
    verify_below("SH9", "a disc of 240 corners: |F + grad W| / F", worst, 3e-7);
}

/* --- slim corners ------------------------------------------------------------------------------------- */

static void slim_wedges(void)
{
    const double degrees[4] = {5, 1, 0.5, 0.2};
    double off = 0.0, noise = 0.0;
    for (int k = 0; k < 4; k++) {
        const double half = tan(0.5 * degrees[k] * PI / 180.0), tilt = 0.3;
        const fl_vec3 xy[3] = {v3(0, 0, 0), v3(2, -2 * half, 0), v3(2, 2 * half, 0)};
        const fl_quat q = q_about_axis(1, tilt);
        const fl_vec3 low = q_rotate(q, v3(0.45, 0, -0.2));
        fl_poly wedge = {0};
        fl_err err = {0};
        lab l;
        lab_start(&l);
        lab_box(&l, v3(0, 0, 5), v3(0.5, 0.5, 0.25), RADIUS, q_one(), ZERO, ZERO);
        if (fl_poly_prism(&wedge, 3, xy, -0.5, 0, &err)) exit(1);
        lab_poly(&l, &wedge, RADIUS, ZERO, ZERO);
        lab_make(&l, 1e-9);
        for (int i = 0; i < 40; i++) {
            const double s = i % 2 ? 1e-3 : 1e-2;
            const fl_vec3 x = v3(0.6 + 0.015 * i, 0.0123, 2.0 * RADIUS - s - low.z);
            const double W = evaluate_at(&l, x, q).energy;
            off = fmax(off, off_gradient(&l, x, q, 1e-2 * s));
            for (int j = 1; j < 4; j++)
                noise =
                    fmax(noise, fabs(evaluate_at(&l, v3(x.x, x.y, x.z + j * 1e-13 * s), q).energy - W) / W);
        }
        lab_free(&l);
    }
    verify_note("a tilted box on wedges of 5 down to 0.2 degrees");
    verify_below("SH8", "|F + grad W| / F", off, 3e-7);
    verify_below("SH8", "energies within 1e-13 of the overlap", noise, 1e-9);
}

/* --- bodies without a dilation radius ----------------------------------------------------------------- */

/* A cube of 1 m moves down at 1 m/s with a corner (0), an edge (1) or a face (2) first, onto an obstacle at
 * z = 0: a block, a sheet, a wall of the boundary, a lying cylinder, another cube. */
static void make_sharp(lab *l, int ahead, int onto)
{
    const fl_quat turn[3] = {q_of_vector(v3_scale(atan(sqrt(2.0)), v3_unit(v3(1, -1, 0)))),
                             q_about_axis(0, PI / 4.0), q_one()};
    const double low[3] = {0.5 * sqrt(3.0), 0.5 * sqrt(2.0), 0.5};
    const fl_vec3 v[4] = {v3(-3, -3, 0), v3(3, -3, 0), v3(3, 3, 0), v3(-3, 3, 0)}, half = v3(0.5, 0.5, 0.5);
    static const int32_t two[2][3] = {{0, 1, 2}, {0, 2, 3}};
    lab_start(l);
    lab_box(l, v3(0, 0, low[ahead] + 0.05), half, 0.0, turn[ahead], v3(0, 0, -1), ZERO);
    if (onto == 0) lab_wall(l, v3(-3, -3, -3), v3(3, 3, 0), 2);
    if (onto == 1) triangles(l, 4, v, 2, two, q_one());
    if (onto == 2) lab_set(l, "boundary.min=none none 0");
    if (onto == 3) lab_cone(l, (fl_cone){v3(-5, 0, -1), v3(5, 0, -1), 1, 1});
    if (onto == 4) lab_box(l, v3(0, 0, -0.5), half, 0.0, q_about_axis(2, 0.3), ZERO, ZERO);
    lab_make(l, 0);
}

/* An edge of radius 0 has no stiffness, and none of these bodies is affected by it. */
static void zero_radius(void)
{
    double off = 0.0, energy = 0.0;
    for (int ahead = 0; ahead < 3; ahead++) {
        for (int onto = 0; onto < 5; onto++) {
            lab l;
            make_sharp(&l, ahead, onto);
            const double before = lab_energy(&l);
            for (int k = 0; k < 40 && l.w.b.v[0].z < 0.0; k++)
                if (lab_run(&l, (int64_t)ceil(0.01 / l.w.dt))) exit(1);
            if (lab_run(&l, (int64_t)ceil(0.2 / l.w.dt))) exit(1);
            energy = fmax(energy, fabs(lab_energy(&l) - before) / before);
            /* of two cubes the other one moves on, and this one stops */
            off = fmax(off, fabs(l.w.b.v[0].z - (onto == 4 ? 0.0 : 1.0)));
            lab_free(&l);
        }
    }
    verify_below("SH13", "cubes without a radius: speed error after impact [m/s]", off, 1e-3);
    verify_below("SH13", "  energy", energy, 1e-3);
}

int main(void)
{
    verify_begin("one energy in difficult geometry");
    no_energy_apart(0.0);
    no_energy_apart(4e-6);
    beside_free_edges();
    seams_of_panels();
    ends_of_roof();
    inner_corners();
    flat_triangles();
    fin_behind_plate();
    thin_poles();
    many_corners();
    octagon_axes();
    slim_wedges();
    zero_radius();
    return verify_end();
}
