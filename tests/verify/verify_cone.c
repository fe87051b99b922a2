/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cones and cylinders at any angle, a hull of many triangles that moves, and floes in a different order. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "sim/moving_structure.h"
#include "support/small_world.h"
#include "support/verify.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* A sphere of 0.1 m at x in the frame of the cone; the frame has any orientation. */
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
    const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
    verify_row(id, what, p.overlap, overlap, 1e-14, VERIFY_ABS);
    if (overlap > 0.0 && v3_norm(n) > 0.0)
        verify_row(id, "  direction", v3_norm(v3_sub(v3_unit(p.force), q_rotate(q, v3_unit(n)))), 0.0, 1e-13,
                   VERIFY_ABS);
    lab_free(&l);
}

static void any_angle(void)
{
    const double c = cos(atan2(0.6, 2.0)), s = sin(atan2(0.6, 2.0)); /* side of the cone 1 -> 0.4 over 2 m */
    verify_note("V30 with the axis anywhere: sphere of 0.1 m, cylinder of 0.5 m and 2 m [m]");
    sphere_at("V30", "side", 0.5, 0.5, 2, v3(0.55, 0, 1), 0.05, v3(1, 0, 0));
    sphere_at("V30", "end", 0.5, 0.5, 2, v3(0.2, 0, 2.05), 0.05, v3(0, 0, 1));
    sphere_at("V30", "rim", 0.5, 0.5, 2, v3(0.55, 0, 2.05), 0.1 - 0.05 * sqrt(2.0), v3(1, 0, 1));
    sphere_at("V30", "none", 0.5, 0.5, 2, v3(0.7, 0, 2.1), 0.0, ZERO);
    verify_note("a cone of 1 m that ends with 0.4 m after 2 m, and one with a point");
    sphere_at("H30", "slant side, 0.04 m off", 1, 0.4, 2, v3(0.7 + 0.04 * c, 0, 1 + 0.04 * s), 0.06,
              v3(c, 0, s));
    sphere_at("H30", "conical side, on the other side of the axis", 1, 0.4, 2,
              v3(0, -0.7 - 0.04 * c, 1 + 0.04 * s), 0.06, v3(0, -c, s));
    sphere_at("H30", "upper rim", 1, 0.4, 2, v3(0.4 + 0.03, 0, 2.04), 0.05, v3(3, 0, 4));
    sphere_at("H30", "lower rim", 1, 0.4, 2, v3(1.04, 0, -0.03), 0.05, v3(4, 0, -3));
    sphere_at("H30", "inside, nearest exit by the conical side", 1, 0.4, 2, v3(0.7 - 0.2 * c, 0, 1 - 0.2 * s),
              0.3, v3(c, 0, s));
    sphere_at("H30", "inside, nearest exit by the lower end", 1, 0.4, 2, v3(0.1, 0.1, 0.25), 0.35,
              v3(0, 0, -1));
    sphere_at("H30", "on the axis, nearest exit by the upper end", 1, 0.4, 2, v3(0, 0, 1.9), 0.2,
              v3(0, 0, 1));
    sphere_at("H30", "over a point", 1, 0, 2, v3(0, 0, 2.03), 0.07, v3(0, 0, 1));
    sphere_at("H30", "beside a point", 1, 0, 2, v3(0.03, 0, 2.04), 0.05, v3(3, 0, 4));
    sphere_at("H30", "in the point itself", 1, 0, 2, v3(0, 0, 2), 0.1, ZERO);
}

/* A floe of 1 m on a cone that is much longer than the floe. */
static void make_floe_on_cone(lab *l, double r0, double r1, double half)
{
    lab_start(l);
    lab_box(l, v3(50, 0, 0), v3(0.5, 0.4, 0.3), 0.05, q_one(), ZERO, ZERO);
    lab_cone(l, (fl_cone){v3(0, 0, -half), v3(0, 0, half), r0, r1});
    lab_make(l, 1e-9);
}

/* All round a cylinder the force is the same, along the radius, with the overlap of the circle. */
static void all_round_cylinder(void)
{
    const double R = 2.0;
    const int many = verify_quick() ? 25 : 241;
    const double reach[2] = {0.5 - 0.01, hypot(0.45, 0.35) + 0.05 - 0.01};
    const char *const ON[2] = {"face", "edge"};
    lab l;
    make_floe_on_cone(&l, R, R, 4.0);
    for (int edge = 0; edge < 2; edge++) {
        double off = 0.0, turn = 0.0, low = INFINITY, high = 0.0;
        char what[96];
        for (int k = 0; k < many; k++) {
            const double a = 2.0 * PI * k / many;
            const fl_vec3 out = v3(cos(a), sin(a), 0);
            lab_pose(&l.w, 0, v3_scale(R + reach[edge], out),
                     q_about_axis(2, a + (edge ? PI - atan2(0.35, 0.45) : 0.0)));
            const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
            off = fmax(off, fabs(p.overlap - 0.01));
            turn = fmax(turn, v3_norm(v3_cross(v3_unit(p.force), out)));
            low = fmin(low, v3_dot(p.force, out)), high = fmax(high, v3_dot(p.force, out));
        }
        snprintf(what, sizeof what, "%s of a floe all round a cylinder: change of the force", ON[edge]);
        verify_below("cone", what, (high - low) / high, 1e-9);
        verify_below("cone", "  largest sine of its angle with the radius", turn, edge ? 1e-2 : 1e-9);
        /* given at quadrature points, the deepest of which lies beside the point of deepest overlap */
        verify_below("cone", "  error of the overlap over 10 mm", off / 0.01, 1e-2);
    }
    lab_free(&l);
}

static double energy_at(lab *l, fl_vec3 x, fl_quat q)
{
    lab_pose(&l->w, 0, x, q);
    return lab_evaluate_pair(&l->w, 0, 1).energy;
}

/* Force and torque against differences of the energy, on cylinders and cones, with and without the
 * influence of their ends. */
static void energy_gradient(void)
{
    const double shape[4][3] = {{2.0, 2.0, 4.0}, {2.0, 2.0, 0.75}, {3.0, 1.5, 5.0}, {0.4, 0.4, 4.0}};
    const char *const NAME[4] = {"a cylinder", "a short cylinder, partly its polygon", "a cone", "a pole"};
    for (int c = 0; c < 4; c++) {
        double worst = 0.0;
        char what[96];
        lab l;
        make_floe_on_cone(&l, shape[c][0], shape[c][1], shape[c][2]);
        for (int k = 0; k < (verify_quick() ? 6 : 60); k++) {
            fl_rng g = fl_rng_of(5, 100 * c + k, FL_RNG_TEST);
            const double z = fl_rng_in(&g, -0.2, 0.2), a = fl_rng_in(&g, 0, 6.28);
            const double r = 0.5 * (shape[c][0] + shape[c][1]),
                         slope = (shape[c][1] - shape[c][0]) / shape[c][2];
            const fl_quat q =
                q_mul(q_about_axis(2, a),
                      q_of_vector(v3(fl_rng_in(&g, -0.05, 0.05), -0.5 * slope + fl_rng_in(&g, -0.05, 0.05),
                                     fl_rng_in(&g, -0.6, 0.6))));
            double far = r + 1.0;
            for (double e = 0.0; far > r && !(e > 0.0); far -= 0.01) /* approach until the overlap is clear */
                e = energy_at(&l, v3((far - 0.01) * cos(a), (far - 0.01) * sin(a), z), q);
            const fl_vec3 x = v3(far * cos(a), far * sin(a), z);
            lab_pose(&l.w, 0, x, q);
            const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
            if (!(p.overlap > 0.002)) continue;
            const double h = 1e-7;
            fl_vec3 f, t;
            double *at[6] = {&f.x, &f.y, &f.z, &t.x, &t.y, &t.z};
            for (int m = 0; m < 6; m++) {
                const fl_vec3 d = v3(m % 3 == 0 ? h : 0, m % 3 == 1 ? h : 0, m % 3 == 2 ? h : 0);
                const fl_vec3 none = ZERO;
                const double up =
                    energy_at(&l, v3_add(x, m < 3 ? d : none), q_mul(q_of_vector(m < 3 ? none : d), q));
                const double down = energy_at(&l, v3_sub(x, m < 3 ? d : none),
                                              q_mul(q_of_vector(v3_neg(m < 3 ? none : d)), q));
                *at[m] = (down - up) / (2.0 * h);
            }
            worst = fmax(worst, fmax(v3_norm(v3_sub(f, p.force)), v3_norm(v3_sub(t, p.torque_i))) /
                                    v3_norm(p.force));
        }
        lab_free(&l);
        snprintf(what, sizeof what, "floes on %s: |force + grad W|, |torque + ...|, over the force", NAME[c]);
        verify_below("cone", what, worst, 2e-6);
    }
}

/* A cylinder of 1000 km radius is a plane wall. */
static void cylinder_as_wall(void)
{
    double f[2];
    const fl_quat q = q_of_vector(v3(0.002, -0.003, 0.01));
    for (int k = 0; k < 2; k++) {
        lab l;
        if (k) {
            lab_start(&l);
            lab_box(&l, v3(50, 0, 0), v3(0.5, 0.4, 0.3), 0.05, q_one(), ZERO, ZERO);
            lab_set(&l, "boundary.min=0 none none");
            lab_make(&l, 1e-9);
        } else {
            make_floe_on_cone(&l, 1e6, 1e6, 4.0);
        }
        lab_pose(&l.w, 0, v3(k ? 0.495 : 1e6 + 0.495, 0.01, 0.02), q);
        const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
        f[k] = v3_norm(p.force) / p.k; /* a wall has another stiffness than a structure */
        lab_free(&l);
    }
    verify_row("cone", "force of a floe on a cylinder of 1000 km over that on a wall, at one stiffness",
               f[0] / f[1], 1.0, 1e-4, VERIFY_ABS);
}

/* A floe is thrown at a cylinder and at a cone: the energy ratio, and the momentum balance. */
static void throw_at_cone(void)
{
    for (int c = 0; c < 3; c++) {
        char what[96];
        lab l;
        const double half = c == 1 ? 0.8 : 4.0;
        lab_start(&l);
        lab_box(&l, v3(2.7, 0.1, 0.05), v3(0.5, 0.4, 0.3), 0.05, q_of_vector(v3(0.3, -0.2, 0.4)),
                v3(-1, 0.1, 0.2), v3(0.2, 0.1, -0.3));
        lab_cone(&l, (fl_cone){v3(0, 0, -half), v3(0, 0, half), c == 2 ? 2.0 : 1.5, c == 2 ? 1.0 : 1.5});
        lab_make(&l, 0.0);
        l.w.dt *= verify_quick() ? 0.25 : 0.1;
        const double before = lab_energy(&l), m = l.w.b.m[0];
        const fl_vec3 v0 = l.w.b.v[0];
        lab_run(&l, (int64_t)(0.8 / l.w.dt));
        const double hit = v3_norm(v3_sub(l.w.b.v[0], v0));
        snprintf(what, sizeof what, "floe thrown at %s: |energy ratio - 1|",
                 c == 0   ? "a cylinder"
                 : c == 1 ? "a short one"
                          : "a cone");
        verify_below("cone", what, hit > 0.5 ? fabs(lab_energy(&l) / before - 1.0) : NAN, 1e-6);
        const fl_vec3 dp = v3_scale(m, v3_sub(l.w.b.v[0], v0));
        verify_below("cone", "  impulse of the part and momentum of the floe",
                     v3_norm(v3_add(dp, l.w.part_impulse[0])) / v3_norm(dp), 1e-11);
        lab_free(&l);
    }
}

/* 49 151 triangles that do not close, and so form a shell, with a floe at the side.  Moved and turned
 * together with the floe, they give the same force, and the search tree is not rebuilt. */
static void moving_hull(void)
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
    const fl_piece_mesh *shell = &l.w.structure.piece[0].mesh;
    const fl_bvh_node *node = shell->tree.node;
    const fl_aabb box = node[0].box;
    const fl_vec3 x = v3(2.49, 0.3, 0.1);
    lab_pose(&l.w, 0, x, l.w.q0[0]);
    const fl_pair before = lab_evaluate_pair(&l.w, 0, 1);
    lab_pose(&l.w, 0, v3(60, 0, 0), q_one());
    lab_run(&l, 1000);
    const fl_bodies *m = &l.w.moving.movers.b;
    const fl_vec3 from = v3_sub(x, v3(0.2, 0.1, 0));
    lab_pose(&l.w, 0, v3_add(m->x[0], m3_mul(fl_body_axes(m, 0), from)), q_mul(m->q[0], l.w.q0[0]));
    const fl_pair after = lab_evaluate_pair(&l.w, 0, 1);
    char what[96];
    snprintf(what, sizeof what, "a hull of %d triangles, moved and turned for 1 s: force", shell->tree.n);
    verify_row("hull", what,
               v3_norm(v3_sub(m3_tmul(fl_body_axes(m, 0), after.force), before.force)) /
                   v3_norm(before.force),
               0.0, 1e-9, VERIFY_ABS);
    verify_true("hull", "  its search tree is the one that was built",
                node == shell->tree.node && memcmp(&box, &node[0].box, sizeof box) == 0 &&
                    l.w.structure.piece[0].x.x == 0.0);
    lab_free(&l);
}

/* Two floes, one behind the other, run into a vertical cylinder; then the same with their numbers swapped. */
static double impulse_with_order(double lift)
{
    lab l[2];
    for (int s = 0; s < 2; s++) {
        lab_start(&l[s]);
        lab_set(&l[s], "contact.stiffness_factor=0.02");
        lab_set(&l[s], "contact.restitution=0.3");
        for (int q = 0; q < 2; q++) {
            const int k = s ? 1 - q : q;
            lab_box(&l[s], v3(k ? -2.3 : -4.6, k ? 0.2 : -0.1, k * lift), v3(1, 0.9, 0.3), 0.05,
                    q_about_axis(2, k ? 0.3 : -0.2), v3(k ? 0.5 : 0.9, 0, 0), ZERO);
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

static void order_of_floes(void)
{
    verify_note(
        "two floes against a vertical cylinder, their numbers swapped: change of the impulse on it, 4 s");
    verify_below("order", "one lies 0.1 mm higher than the other", impulse_with_order(1e-4), 1e-12);
    verify_below("order", "both exactly level, where rounding decides which lies above",
                 impulse_with_order(0.0), 1e-5);
}

int main(void)
{
    verify_begin("cones at any angle, hulls that move");
    any_angle();
    all_round_cylinder();
    energy_gradient();
    cylinder_as_wall();
    throw_at_cone();
    moving_hull();
    order_of_floes();
    return verify_end();
}
