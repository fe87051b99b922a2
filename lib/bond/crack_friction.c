/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bond/crack_friction.h"
#include "patch/patch_result.h"

/* The numbers of the springs, in the slips of the points, which a face that has failed needs no more. */
enum { FORCE_Y, FORCE_Z, MOMENT, STIFFNESS, TURN_STIFFNESS, ENERGY };

static double *number_of(fl_bond *c, int which) { return &c->point[which / 2].slip[which % 2]; }

static fl_friction_springs springs_of(fl_bond *c)
{
    return (fl_friction_springs){.force = v3(0.0, *number_of(c, FORCE_Y), *number_of(c, FORCE_Z)),
                                 .k = *number_of(c, STIFFNESS),
                                 .moment = *number_of(c, MOMENT),
                                 .k_turn = *number_of(c, TURN_STIFFNESS),
                                 .energy = *number_of(c, ENERGY)};
}

static void keep_springs(fl_bond *c, const fl_friction_springs *s)
{
    *number_of(c, FORCE_Y) = s->force.y;
    *number_of(c, FORCE_Z) = s->force.z;
    *number_of(c, MOMENT) = s->moment;
    *number_of(c, STIFFNESS) = s->k;
    *number_of(c, TURN_STIFFNESS) = s->k_turn;
    *number_of(c, ENERGY) = s->energy;
    c->friction_spring_energy = s->energy;
}

void fl_crack_friction_begin(fl_bond *c, fl_vec3 force, double couple, double energy)
{
    for (int k = 0; k < FL_BOND_POINTS; k++) c->point[k].slip[0] = c->point[k].slip[1] = 0.0;
    /* k 0: nothing has fallen or risen before the first step */
    keep_springs(
        c, &(fl_friction_springs){.force = v3(0.0, force.y, force.z), .moment = couple, .energy = energy});
}

/* Twice the sine of half the angle between the half sides of i and j about m, by both pairs of them. */
static double sine_of(const fl_face_separation *q, double a, double b)
{
    return (a * q->su[2] - b * q->sv[1]) / (a * a + b * b);
}

/* Change of the angle between two steps; near a half turn the sine says little, and the change is bounded. */
static double turn_of(const fl_face_separation *before, const fl_face_separation *now, double a, double b)
{
    const double from = sine_of(before, a, b), to = sine_of(now, a, b), mean = 0.25 * (from + to),
                 left = 1.0 - mean * mean;
    return (to - from) / sqrt(left > 0.01 ? left : 0.01);
}

fl_crack_wrench fl_crack_friction_step(fl_bond *c, const double *p, const fl_face_separation *before,
                                       const fl_face_separation *now)
{
    const double a = v3_norm(c->ai), b = v3_norm(c->bi), whole = (a * a + b * b) / 3.0;
    double sum = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, xi, eta;
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        fl_bond_quadrature_point(k, &xi, &eta);
        sum += p[k], x += p[k] * xi, y += p[k] * eta;
        xx += p[k] * xi * xi, xy += p[k] * xi * eta, yy += p[k] * eta * eta;
    }
    if (!(sum > 0.0)) {
        fl_crack_friction_begin(c, v3(0, 0, 0), 0.0, 0.0);
        return (fl_crack_wrench){0};
    }
    x /= sum, y /= sum, xx /= sum, xy /= sum, yy /= sum;
    const double wide = a * a * xx + b * b * yy,
                 k = 0.5 * c->ks * c->area * (wide > whole ? whole / wide : 1.0);
    const fl_vec3 m = v3(1, 0, 0);
    const fl_pressure_shape shape = fl_pressure_shape_of(
        (fl_sym3){.yy = a * a * (xx - x * x), .yz = a * b * (xy - x * y), .zz = b * b * (yy - y * y)}, m);
    fl_friction_springs s = springs_of(c);
    if (s.k == 0.0) s.k = k, s.k_turn = k * shape.arm * shape.arm;
    fl_vec3 slip = v3(0, 0, 0);
    slip.y = now->s[1] - before->s[1] + x * (now->su[1] - before->su[1]) + y * (now->sv[1] - before->sv[1]);
    slip.z = now->s[2] - before->s[2] + x * (now->su[2] - before->su[2]) + y * (now->sv[2] - before->sv[2]);
    const double turn = turn_of(before, now, a, b);
    /* Of i against j, in a step of duration 1. */
    const fl_friction_motion by = {
        .v = v3_neg(slip), .v_end = v3_neg(slip), .spin = -turn, .spin_end = -turn};
    const fl_friction_contact with = {.n = m,
                                      .k = k,
                                      .limit = c->friction * sum,
                                      .arm = shape.arm,
                                      .elongation = shape.elongation,
                                      .contact_count = 1.0};
    const fl_friction_result r = fl_tangent_step_of(s, with, by, 1.0, 1);
    keep_springs(c, &r.springs);
    return (fl_crack_wrench){r.force, r.moment, x, y};
}
