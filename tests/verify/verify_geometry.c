/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Volumes, moments and floating bodies against closed forms: cases V33 to V37, V48, V51, V52, H23, H24, and
 * the hydrostatic parts of V50, V54 and V56. */
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "geom/clip.h"
#include "geom/dilate.h"
#include "geom/mass.h"
#include "support/shapes.h"
#include "support/verify.h"
#include "water/buoyancy.h"
#include "water/drag.h"

static const double DEGREE = PI / 180;

static void check_result(int rc, const char *what)
{
    if (rc == 0) return;
    verify_true("", what, 0);
    exit(verify_end());
}

static void box(fl_poly *p, double x, double y, double z)
{
    fl_err err = {0};
    check_result(fl_poly_box(p, v3(x / 2, y / 2, z / 2), &err), "a box can be made");
}

static void cut_cube(void)
{
    fl_err err = {0};
    fl_poly p;
    fl_mass m;
    const double s3 = 1 / sqrt(3.0), s14 = 1 / sqrt(14.0);
    box(&p, 1, 1, 1);
    check_result(fl_poly_cut(&p, v3(s3, s3, s3), 0.0, &err) || fl_mass_of(&m, &p, 0.0, &err),
                 "a cube can be cut");
    verify_row("V33", "half a cube, cut across (1,1,1): V [m3]", m.volume, 0.5, 1e-13, VERIFY_ABS);
    verify_row("V33", "its section, a hexagon [m2]", v3_norm(fl_poly_face_area_vector(&p, p.nf - 1)),
               0.75 * sqrt(3.0), 1e-13, VERIFY_ABS);
    verify_row("V33", "its centroid, x [m]", m.centre.x, -13.0 / 96, 1e-13, VERIFY_ABS);
    verify_row("V33", "its centroid, z [m]", m.centre.z, -13.0 / 96, 1e-13, VERIFY_ABS);
    fl_poly_free(&p);
    /* Closed form of the cut of a cube with n > 0: sum over the corners below the plane of +-(c - n.x)^3 /
     * (6 n1 n2 n3). */
    const double off[4] = {-0.5, -0.2, 0.1, 0.4}, n[3] = {s14, 2 * s14, 3 * s14};
    for (int k = 0; k < 4; k++) {
        double want = 0.0;
        for (int c = 0; c < 8; c++) {
            double s = off[k];
            int odd = 0;
            for (int i = 0; i < 3; i++) {
                s -= (c >> i & 1 ? 0.5 : -0.5) * n[i];
                odd ^= c >> i & 1;
            }
            if (s > 0) want += (odd ? -1 : 1) * s * s * s / (6 * n[0] * n[1] * n[2]);
        }
        box(&p, 1, 1, 1);
        check_result(fl_poly_cut(&p, v3(n[0], n[1], n[2]), off[k], &err) || fl_mass_of(&m, &p, 0.0, &err),
                     "a cube can be cut");
        verify_row("V34", "cube cut across (1,2,3): V [m3]", m.volume, want, 1e-12, VERIFY_ABS);
        fl_poly_free(&p);
    }
}

static void right_tetrahedron(void)
{
    const fl_vec3 v[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int32_t first[5] = {0, 3, 6, 9, 12}, loop[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    fl_err err = {0};
    fl_poly p;
    fl_mass m;
    check_result(fl_poly_make(&p, 4, v, 4, first, loop, &err) || fl_mass_of(&m, &p, 0.0, &err),
                 "a tetrahedron can be made");
    verify_row("V35", "right tetrahedron: V [m3]", m.volume, 1.0 / 6, 1e-14, VERIFY_ABS);
    verify_row("V35", "centroid [m]", m.centre.x, 0.25, 1e-14, VERIFY_ABS);
    verify_row("V35", "int x^2 dV [m5]", m.second.m[0][0] + m.volume * m.centre.x * m.centre.x, 1.0 / 60,
               1e-14, VERIFY_ABS);
    verify_row("V35", "int x y dV [m5]", m.second.m[0][1] + m.volume * m.centre.x * m.centre.y, 1.0 / 120,
               1e-14, VERIFY_ABS);
    fl_poly_free(&p);
}

static void dilated_bodies(void)
{
    fl_err err = {0};
    fl_poly p, q;
    fl_mass m;
    box(&p, 1, 1, 1);
    check_result(fl_mass_of(&m, &p, 0.1, &err), "a rounded cube has a mass");
    verify_row("V36", "unit cube swept by 0.1: V [m3]", m.volume, 1.0 + 0.6 + 0.03 * PI + 0.004 / 3 * PI,
               1e-14, VERIFY_REL);
    verify_row("V36", "its moment of inertia over density [m5]", m.inertia.x, 0.3993914, 1e-7, VERIFY_ABS);
    verify_row("V36", "Steiner's formula [m3]", fl_dilate_volume(&p, 0.1), m.volume, 1e-14, VERIFY_REL);
    check_result(fl_poly_offset(&q, &p, 0.1, &err) || fl_mass_of(&m, &q, 0.0, &err),
                 "faces of a cube can be moved");
    verify_row("V36", "its outer sharp shape [m3]", m.volume, 1.728, 1e-14, VERIFY_REL);
    fl_poly_free(&p);
    fl_poly_free(&q);
    box(&p, 10, 10, 0.4);
    check_result(fl_mass_of(&m, &p, 0.05, &err), "a rounded floe has a mass");
    verify_row("V37", "floe 10 x 10 x 0.4 swept by 0.05 [m3]", m.volume, 50.960745, 1e-8, VERIFY_REL);
    check_result(fl_poly_offset(&q, &p, 0.05, &err) || fl_mass_of(&m, &q, 0.0, &err),
                 "faces of a floe can be moved");
    verify_row("V37", "its outer sharp shape [m3]", m.volume, 51.005, 1e-14, VERIFY_REL);
    fl_poly_free(&p);
    fl_poly_free(&q);
}

/* Water level over the origin of the body at which the body displaces the volume v. */
static double float_level(const fl_hull *h, fl_vec3 up, double v)
{
    double lo = -2 * h->shape->size, hi = 2 * h->shape->size;
    fl_submerged w;
    for (int k = 0; k < 200; k++) {
        const double mid = 0.5 * (lo + hi);
        fl_hull_submerged(h, up, mid, &w);
        if (w.volume < v) lo = mid;
        else hi = mid;
    }
    return 0.5 * (lo + hi);
}

/* Righting arm at a heel of a radians about the x axis: the shift of the centre of buoyancy to the low
 * side.  `across` points away from that side. */
static double righting_arm(const fl_hull *h, double a, double v)
{
    const fl_vec3 up = v3(0, sin(a), cos(a)), across = v3(0, cos(a), -sin(a));
    fl_submerged w;
    fl_hull_submerged(h, up, float_level(h, up, v), &w);
    return -v3_dot(w.centre, across);
}

static void floating_box(void)
{
    const double ratio = 900.0 / 1025.0;
    fl_poly p;
    fl_hull h;
    fl_err err = {0};
    fl_submerged w;
    fl_waterplane plane;
    box(&p, 10, 10, 1);
    check_result(fl_hull_make(&h, &p, 0.0, &err), "a box floats");
    const double level = float_level(&h, v3(0, 0, 1), ratio * h.volume);
    verify_row("V48", "draft of a 10 x 10 x 1 box, 900/1025 [m]", level + 0.5, 0.8780488, 5e-8, VERIFY_ABS);
    verify_row("V48", "draft over density ratio", (level + 0.5) / ratio, 1.0, 1e-13, VERIFY_ABS);
    verify_row("V48", "freeboard [m]", 0.5 - level, 1 - ratio, 1e-13, VERIFY_ABS);
    fl_hull_submerged(&h, v3(0, 0, 1), level, &w);
    fl_hull_waterplane(&h, v3(0, 0, 1), level, &plane);
    verify_row("V50", "metacentric height GM = I/V - BG [m]", plane.second.m[0][0] / w.volume + w.centre.z,
               9.429765, 5e-7, VERIFY_ABS);
    verify_row("V54", "wetted surface [m2]", w.wetted_area, 135.122, 5e-4, VERIFY_ABS);
    const fl_fluid sea = {.density = 1025, .force_coefficient = 0.005, .moment_coefficient = 0.005};
    verify_row("V54", "decay coefficient of skin drag [1/m]",
               fl_drag_force_constant(&sea, w.wetted_area) / (900 * h.volume), 3.847222e-3, 1e-6, VERIFY_REL);
    verify_row("V56", "effective radius of spin [m]", fl_drag_radius(&p, 0.0), 7.088723, 5e-7, VERIFY_ABS);
    const double c = fl_drag_moment_constant(&sea, w.wetted_area, fl_drag_radius(&p, 0.0)),
                 inertia = 900 * 1 * 100.0 * (100 + 100) / 12;
    verify_row("V56", "spin after 100 s, from 0.1 [rad/s]",
               0.1 * fl_drag_decay_factor(inertia, c, 0.1, 100.0), 0.054877, 1e-5, VERIFY_REL);
    fl_hull_free(&h);
    fl_poly_free(&p);

    box(&p, 3, 4, 1); /* GZ depends on the section only */
    check_result(fl_hull_make(&h, &p, 0.0, &err), "a box floats");
    const double heel[6] = {1, 2, 5, 10, 20, 45};
    const double arm[6] = {0.02544167, 0.05089983, 0.11783579, 0.15758834, 0.17548414, 0.14731391};
    for (int k = 0; k < 6; k++) {
        char what[60];
        snprintf(what, sizeof what, "righting arm of a 4 x 1 section at %g deg [m]", heel[k]);
        verify_row("V51", what, righting_arm(&h, heel[k] * DEGREE, ratio * h.volume), arm[k], 1e-7,
                   VERIFY_ABS);
    }
    /* Wall-sided: GZ = sin a (GM + 1/2 BM tan^2 a), exact until the deck goes under. */
    const double bm = 16.0 / 12 / ratio, gm = bm - 0.5 * (1 - ratio);
    verify_row("V51", "the same at 3 deg, wall-sided formula", righting_arm(&h, 3 * DEGREE, ratio * h.volume),
               sin(3 * DEGREE) * (gm + 0.5 * bm * tan(3 * DEGREE) * tan(3 * DEGREE)), 1e-12, VERIFY_ABS);
    fl_hull_free(&h);
    fl_poly_free(&p);
}

/* Heel between lo and hi at which the arm vanishes [deg]. */
static double resting_heel(const fl_hull *h, double s, double lo, double hi)
{
    const double first = righting_arm(h, lo * DEGREE, s * h->volume);
    for (int k = 0; k < 60; k++) {
        const double mid = 0.5 * (lo + hi), arm = righting_arm(h, mid * DEGREE, s * h->volume);
        if ((arm < 0) == (first < 0)) lo = mid;
        else hi = mid;
    }
    return 0.5 * (lo + hi);
}

static double upright_gm(const fl_hull *h, double s)
{
    fl_submerged w;
    fl_waterplane plane;
    const double level = float_level(h, v3(0, 0, 1), s * h->volume);
    fl_hull_submerged(h, v3(0, 0, 1), level, &w);
    fl_hull_waterplane(h, v3(0, 0, 1), level, &plane);
    return plane.second.m[1][1] / w.volume + w.centre.z;
}

static void square_prism(void)
{
    fl_poly p;
    fl_hull h;
    fl_err err = {0};
    box(&p, 2, 1, 1);
    check_result(fl_hull_make(&h, &p, 0.0, &err), "a prism floats");
    verify_row("V52", "square prism, s = 0.25: heel [deg]", resting_heel(&h, 0.25, 5, 44), atan(0.5) / DEGREE,
               1e-9, VERIFY_ABS);
    verify_row("V52", "s = 0.75", resting_heel(&h, 0.75, 5, 44), atan(0.5) / DEGREE, 1e-9, VERIFY_ABS);
    verify_row("V52", "s = 0.22", resting_heel(&h, 0.22, 2, 30), 13.675, 0.01, VERIFY_ABS);
    verify_row("V52", "s = 0.78", resting_heel(&h, 0.78, 2, 30), 13.675, 0.01, VERIFY_ABS);
    verify_row("V52", "s = 0.5", resting_heel(&h, 0.5, 20, 60), 45, 1e-9, VERIFY_ABS);
    for (int side = 0; side < 2; side++) {
        double lo = side ? 0.6 : 0.1, hi = side ? 0.9 : 0.4;
        for (int k = 0; k < 60; k++) {
            const double mid = 0.5 * (lo + hi);
            if ((upright_gm(&h, mid) > 0) == (side == 0)) lo = mid;
            else hi = mid;
        }
        verify_row("V52", "upright is unstable from / up to s =", lo, 0.5 + (side ? 1 : -1) / sqrt(12.0),
                   1e-9, VERIFY_ABS);
    }
    fl_hull_free(&h);
    fl_poly_free(&p);
}

/* The water level passes a face, an edge or a vertex of the cube in steps of 1e-10 m.  The volume follows
 * the water plane and jumps by no more than rounding. */
static void volume_continuity(void)
{
    const fl_vec3 up[3] = {{0, 0, 1},
                           {0, 0.7071067811865476, 0.7071067811865476},
                           {0.5773502691896258, 0.5773502691896258, 0.5773502691896258}};
    const char *what[3] = {"through a face: jump of V / V0", "through an edge", "through a vertex"};
    const double at[3] = {0.5, 0.0, 0.2886751345948129};
    fl_poly p;
    fl_hull h;
    fl_err err = {0};
    box(&p, 1, 1, 1);
    check_result(fl_hull_make(&h, &p, 0.0, &err), "a cube floats");
    for (int k = 0; k < 3; k++) {
        double worst = 0.0;
        for (int i = -10; i < 10; i++) {
            fl_submerged a, b;
            fl_hull_submerged(&h, up[k], at[k] + i * 1e-10, &a);
            fl_hull_submerged(&h, up[k], at[k] + (i + 1) * 1e-10, &b);
            /* the deck is at 0: the water plane is 1 m2 below it, and empty above it */
            const double slope = k ? 0.5 * (a.waterplane_area + b.waterplane_area) : i < 0 ? 1.0 : 0.0;
            worst = fmax(worst, fabs(b.volume - a.volume - slope * 1e-10));
        }
        verify_below(k ? "H24" : "H23", what[k], worst, 1e-12);
    }
    fl_hull_free(&h);
    fl_poly_free(&p);
}

int main(void)
{
    verify_begin("volumes, moments and floating bodies");
    cut_cube();
    right_tetrahedron();
    dilated_bodies();
    floating_box();
    square_prism();
    volume_continuity();
    return verify_end();
}
