/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bond/crack_friction.h"
#include "patch/patch_result.h"

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

static fl_vec3 slip_at(const fl_face_separation *before, const fl_face_separation *now, double x, double y)
{
    double d[3];
    for (int e = 0; e < 3; e++)
        d[e] = now->s[e] - before->s[e] + x * (now->su[e] - before->su[e]) + y * (now->sv[e] - before->sv[e]);
    return v3(0.0, d[1], d[2]);
}

fl_crack_wrench fl_crack_friction_step(fl_crack_springs *springs, const fl_crack_face *face,
                                       const fl_crack_pressure *p, const fl_face_separation *before,
                                       const fl_face_separation *now)
{
    const double a = face->half_a, b = face->half_b, whole = (a * a + b * b) / 3.0;
    if (!(p->sum > 0.0)) {
        *springs = (fl_crack_springs){0};
        return (fl_crack_wrench){0};
    }
    const double x = p->a / p->sum, y = p->b / p->sum, aa = a * a * p->aa / p->sum,
                 ab = a * b * p->ab / p->sum, bb = b * b * p->bb / p->sum;
    const fl_vec3 m = v3(1, 0, 0);
    const fl_pressure_shape shape = fl_pressure_shape_of(
        (fl_sym3){.yy = aa - a * a * x * x, .yz = ab - a * b * x * y, .zz = bb - b * b * y * y}, m);
    const double k = face->shear * (aa + bb > whole ? whole / (aa + bb) : 1.0);
    const double turn = turn_of(before, now, a, b);
    const fl_vec3 slip = slip_at(before, now, x, y);
    fl_friction_springs s = {.force = v3(0.0, springs->y, springs->z),
                             .k = springs->k,
                             .moment = springs->moment,
                             .k_turn = springs->k_turn,
                             .energy = springs->energy};
    if (s.k == 0.0) s.k = k, s.k_turn = k * shape.arm * shape.arm;
    /* Of i against j, in a step of duration 1. */
    const fl_friction_motion by = {
        .v = v3_neg(slip), .v_end = v3_neg(slip), .spin = -turn, .spin_end = -turn};
    const fl_friction_contact with = {.n = m,
                                      .k = k,
                                      .limit = face->friction * p->sum,
                                      .arm = shape.arm,
                                      .elongation = shape.elongation,
                                      .contact_count = 1.0};
    const fl_friction_result r = fl_tangent_step_of(s, with, by, 1.0, 1);
    *springs = (fl_crack_springs){r.springs.force.y, r.springs.force.z, r.springs.moment,
                                  r.springs.k,       r.springs.k_turn,  r.springs.energy};
    return (fl_crack_wrench){r.force, r.moment, x, y};
}
