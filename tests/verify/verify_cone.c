/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cones and cylinders at any angle, a hull of many triangles that moves, and floes in another order. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "step/ride.h"
#include "support/lab.h"
#include "support/verify.h"

#define PI 3.14159265358979323846

static const fl_vec3 ZERO = {0, 0, 0};

/* A sphere of 0.1 m at x in the frame of the cone; the frame lies anywhere. */
static void sphere_at(const char *id, const char *what, double r0, double r1, double h, fl_vec3 x,
                      double overlap, fl_vec3 n)
{
    const fl_quat q = q_of_vector(v3(0.7, -1.1, 0.4));
    const fl_vec3 o = v3(3, -2, 5);
    lab l;
    lab_start(&l);
    lab_sphere(&l, v3(50, 0, 0), 0.1, ZERO, ZERO);
    lab_cone(&l, (fl_cone){o, v3_add(o, q_rotate(q, v3(0, 0, h))), r0, r1});
    lab_make(&l, 1e-9);
    lab_pose(&l.w, 0, v3_add(o, q_rotate(q, x)), q_one());
    const fl_pair p = lab_look(&l.w, 0, 1);
    verify_row(id, what, p.overlap, overlap, 1e-14, VERIFY_ABS);
    if (overlap > 0.0 && v3_norm(n) > 0.0)
        verify_row(id, "  direction", v3_norm(v3_sub(v3_unit(p.f), q_rotate(q, v3_unit(n)))), 0.0, 1e-13,
                   VERIFY_ABS);
    lab_free(&l);
}

static void any_angle(void)
{
    const double c = cos(atan2(0.6, 2.0)), s = sin(atan2(0.6, 2.0)); /* slant of the cone 1 -> 0.4 over 2 m */
    verify_note("V30 with the axis anywhere: sphere of 0.1 m, cylinder of 0.5 m and 2 m [m]");
    sphere_at("V30", "side", 0.5, 0.5, 2, v3(0.55, 0, 1), 0.05, v3(1, 0, 0));
    sphere_at("V30", "end", 0.5, 0.5, 2, v3(0.2, 0, 2.05), 0.05, v3(0, 0, 1));
    sphere_at("V30", "rim", 0.5, 0.5, 2, v3(0.55, 0, 2.05), 0.1 - 0.05 * sqrt(2.0), v3(1, 0, 1));
    sphere_at("V30", "none", 0.5, 0.5, 2, v3(0.7, 0, 2.1), 0.0, ZERO);
    verify_note("a cone of 1 m that ends with 0.4 m after 2 m, and one with a point");
    sphere_at("H30", "slant side, 0.04 m off", 1, 0.4, 2, v3(0.7 + 0.04 * c, 0, 1 + 0.04 * s), 0.06,
              v3(c, 0, s));
    sphere_at("H30", "slant side, on the other side of the axis", 1, 0.4, 2,
              v3(0, -0.7 - 0.04 * c, 1 + 0.04 * s), 0.06, v3(0, -c, s));
    sphere_at("H30", "upper rim", 1, 0.4, 2, v3(0.4 + 0.03, 0, 2.04), 0.05, v3(3, 0, 4));
    sphere_at("H30", "lower rim", 1, 0.4, 2, v3(1.04, 0, -0.03), 0.05, v3(4, 0, -3));
    sphere_at("H30", "inside, out by the slant side", 1, 0.4, 2, v3(0.7 - 0.2 * c, 0, 1 - 0.2 * s), 0.3,
              v3(c, 0, s));
    sphere_at("H30", "inside, out by the lower end", 1, 0.4, 2, v3(0.1, 0.1, 0.25), 0.35, v3(0, 0, -1));
    sphere_at("H30", "on the axis, out by the upper end", 1, 0.4, 2, v3(0, 0, 1.9), 0.2, v3(0, 0, 1));
    sphere_at("H30", "over a point", 1, 0, 2, v3(0, 0, 2.03), 0.07, v3(0, 0, 1));
    sphere_at("H30", "beside a point", 1, 0, 2, v3(0.03, 0, 2.04), 0.05, v3(3, 0, 4));
    sphere_at("H30", "in the point itself", 1, 0, 2, v3(0, 0, 2), 0.1, ZERO);
}

/* For polyhedra a cone is a frustum of 96 sides with the cross-section of the circle: corners at f R, flats
 * at f R cos(pi/96), f^2 = (2 pi/96)/sin(2 pi/96).  A flat floe meets a corner, the corner of a floe a
 * flat. */
static void frustum(void)
{
    const double R = 2.0, f = sqrt(2 * PI / FL_CONE_SIDES / sin(2 * PI / FL_CONE_SIDES)),
                 bound = R * (1 - cos(PI / FL_CONE_SIDES));
    double flat = 0.0, corner = 0.0, turn = 0.0, mean = 0.0;
    const int many = verify_quick() ? 97 : 961;
    lab l;
    lab_start(&l);
    lab_box(&l, v3(50, 0, 0), v3(0.5, 0.4, 0.3), 0.05, q_one(), ZERO, ZERO);
    lab_cone(&l, (fl_cone){v3(0, 0, -1), v3(0, 0, 1), R, R});
    lab_make(&l, 1e-9);
    for (int k = 0; k < many; k++) {
        const double a = 2 * PI / FL_CONE_SIDES * 3.0 * k / (many - 1);
        const fl_vec3 out = v3(cos(a), sin(a), 0);
        lab_pose(&l.w, 0, v3_scale(R + 0.49, out), q_mul(q_about(2, a), q_one()));
        fl_pair p = lab_look(&l.w, 0, 1);
        flat = fmax(flat, fabs(p.overlap - 0.01));
        mean += (p.overlap - 0.01) / many;
        /* the floe turned, so that an edge of it comes first: its core's corner is at 0.45, 0.35 */
        const double reach = hypot(0.45, 0.35) + 0.05 - 0.01;
        lab_pose(&l.w, 0, v3_scale(R + reach, out), q_about(2, a + PI - atan2(0.35, 0.45)));
        p = lab_look(&l.w, 0, 1);
        corner = fmax(corner, fabs(p.overlap - 0.01));
        turn = fmax(turn, v3_norm(v3_cross(v3_unit(p.f), out)));
        if (!(p.n && v3_dot(p.f, out) > 0.0)) turn = NAN;
    }
    lab_free(&l);
    verify_note(
        "a floe round a cylinder of R = 2 m; the frustum of 96 sides has its corners at R + %.2g m and its "
        "flats at R - %.2g m",
        R * (f - 1), R * (1 - f * cos(PI / FL_CONE_SIDES)));
    verify_below("cone", "face of a floe: largest error of the overlap over R (1 - cos(pi/96))", flat / bound,
                 1.0);
    verify_row("cone", "  that of the corners, R (f - 1) [m]", flat, R * (f - 1), 2e-2, VERIFY_REL);
    verify_below("cone", "edge of a floe: largest error of the overlap over R (1 - cos(pi/96))",
                 corner / bound, 1.0);
    verify_below("cone", "  largest sine of the angle of the force with the radius, over sin(pi/96)",
                 turn / sin(PI / FL_CONE_SIDES), 2.0);
    verify_below("cone", "face: mean error of the overlap over R (1 - cos(pi/96))", fabs(mean) / bound, 1.0);
}

/* 49 151 triangles that do not close, so that they are a shell, with a floe at the side.  Moved and turned
 * with the floe, they give the same force; the tree is the one that was built. */
static void hull(void)
{
    const int n = verify_quick() ? 16 : 64;
    lab l;
    lab_start(&l);
    lab_box(&l, v3(60, 0.3, 0.1), v3(0.5, 0.4, 0.3), 0.05, q_one(), ZERO, ZERO);
    lab_wall(&l, v3(-2, -2, -2), v3(2, 2, 2), n);
    l.surface.part[0].nt--;
    lab_set(&l, "structure.velocity=1 0.5 -0.2");
    lab_set(&l, "structure.spin=0.3 -0.2 0.5");
    lab_set(&l, "structure.reference=0.2 0.1 0");
    lab_make(&l, 1e-3);
    const fl_shell *shell = &l.w.structure.piece[0].shell;
    const fl_bvh_node *node = shell->tree.node;
    const fl_aabb box = node[0].box;
    const fl_vec3 x = v3(2.49, 0.3, 0.1);
    lab_pose(&l.w, 0, x, l.w.q0[0]);
    const fl_pair before = lab_look(&l.w, 0, 1);
    lab_pose(&l.w, 0, v3(60, 0, 0), q_one());
    lab_run(&l, 1000);
    const fl_bodies *m = &l.w.ride.m.b;
    const fl_vec3 from = v3_sub(x, v3(0.2, 0.1, 0));
    lab_pose(&l.w, 0, v3_add(m->x[0], m3_mul(m->R[0], from)), q_mul(m->q[0], l.w.q0[0]));
    const fl_pair after = lab_look(&l.w, 0, 1);
    char what[96];
    snprintf(what, sizeof what, "a hull of %d triangles, after 1 s of way and turn: force", shell->tree.n);
    verify_row("hull", what, v3_norm(v3_sub(m3_tmul(m->R[0], after.f), before.f)) / v3_norm(before.f), 0.0,
               1e-9, VERIFY_ABS);
    verify_true("hull", "  its tree is the one that was built",
                node == shell->tree.node && memcmp(&box, &node[0].box, sizeof box) == 0 &&
                    l.w.structure.piece[0].x.x == 0.0);
    lab_free(&l);
}

/* Two floes, one behind the other, run into a vertical cylinder; and the same with their numbers swapped. */
static double swapped(double lift)
{
    lab l[2];
    for (int s = 0; s < 2; s++) {
        lab_start(&l[s]);
        lab_set(&l[s], "contact.softening=0.02");
        lab_set(&l[s], "contact.restitution=0.3");
        for (int q = 0; q < 2; q++) {
            const int k = s ? 1 - q : q;
            lab_box(&l[s], v3(k ? -2.3 : -4.6, k ? 0.2 : -0.1, k * lift), v3(1, 0.9, 0.3), 0.05,
                    q_about(2, k ? 0.3 : -0.2), v3(k ? 0.5 : 0.9, 0, 0), ZERO);
        }
        lab_cone(&l[s], (fl_cone){v3(0, 0, -3), v3(0, 0, 3), 1, 1});
        lab_make(&l[s], 1e-4);
        if (lab_run(&l[s], 40000)) return NAN;
    }
    const double off = v3_norm(v3_sub(l[0].w.part_impulse[0], l[1].w.part_impulse[0])),
                 all = v3_norm(l[0].w.part_impulse[0]);
    lab_free(&l[0]);
    lab_free(&l[1]);
    return off / all;
}

static void order(void)
{
    verify_note(
        "two floes against a vertical cylinder, their numbers swapped: change of the impulse on it, 4 s");
    verify_below("order", "one lies 0.1 mm higher than the other", swapped(1e-4), 1e-12);
    verify_note(
        "both exactly level: %.1g.  Their rims are one over the other then, where the force along a face "
        "jumps, places.h, and rounding decides",
        swapped(0.0));
}

int main(void)
{
    verify_begin("cones at any angle, hulls that move");
    any_angle();
    frustum();
    hull();
    order();
    return verify_end();
}
