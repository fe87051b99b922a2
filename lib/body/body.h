/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body.h -- the state of all rigid bodies: what moves by itself first, what is held after it.
 *
 * The frame of a body has its centre of mass as origin and its principal axes as axes, I.x <= I.y <= I.z.
 * Bodies [0, n) are moved by forces; bodies [n, total) are pieces of the structure, whose velocity is given.
 * One piece of geometry serves contact (the core and its radius) and mass and water (the outer shape). */
#ifndef FL_BODY_BODY_H
#define FL_BODY_BODY_H
#include <stdint.h>
#include "base/err.h"
#include "geom/mat3.h"
#include "geom/poly.h"
#include "geom/quat.h"
#include "geom/vec3.h"

/* Directions that forces do not change; the order of FL_FIX_X, ... of a scene. */
enum { FL_DOF_X = 1, FL_DOF_Y = 2, FL_DOF_Z = 4, FL_DOF_RX = 8, FL_DOF_RY = 16, FL_DOF_RZ = 32 };

typedef struct {
    int32_t n, total;
    /* state, [total] each */
    fl_vec3 *x; /* centre of mass                          [m]       */
    fl_vec3 *v; /* its velocity                            [m/s]     */
    fl_vec3 *L; /* angular momentum, world axes            [kg m2/s] */
    fl_quat *q; /* body axes to world                                */
    /* derived from the state */
    fl_vec3 *w; /* angular velocity, world axes            [rad/s]; of fl_drift() the mean of its step */
    /* what acts, world axes, about the centre of mass */
    fl_vec3 *f, *t; /* [N], [N m] */
    /* what a body is */
    double *m, *invm;            /* [kg], [1/kg]; 0 and 0 for what is held      */
    fl_vec3 *I;                  /* principal moments, ascending but for those of water [kg m2] */
    fl_vec3 *invI;               /* 1 over each of them: fl_body_set_inertia() sets both */
    double *radius;              /* dilation radius                   [m]       */
    double *bounding_radius;     /* farthest core vertex from x       [m]       */
    fl_poly *core;               /* in the body frame                           */
    uint8_t *fixed_dof;          /* FL_DOF_X | ...                             */
    uint8_t *is_isotropic;       /* 1: alike in all directions, its axes are the world's whatever q is */
    double *work_of_constraints; /* work done by what holds the body so far [J] */
    double *odometer; /* path no point of the core exceeds: sum over steps of |v| dt + chord bound  [m] */
    /* of bodies that move water with them; all NULL where none does */
    fl_vec3 *added_mass;    /* mass of that water, per body axis            [kg]  */
    fl_vec3 *flow_velocity; /* velocity of the water around                 [m/s] */
    double *flow_work;      /* work that water which flows did through it by turning the body so far [J] */
} fl_bodies;

/* Arrays for `total` bodies, the first n of which move; all zero but q = 1.  -1 with FL_SYSTEM. */
int fl_bodies_alloc(fl_bodies *b, int32_t n, int32_t total, fl_err *err);
void fl_bodies_free(fl_bodies *b);

/* Room for added masses and what belongs to them, all zero.  -1 with FL_SYSTEM. */
int fl_bodies_alloc_added_mass(fl_bodies *b, fl_err *err);

/* Whether body i, as it is, is alike in all directions: one point at its centre, equal moments, and equal
 * added masses. */
int fl_body_is_isotropic(const fl_bodies *b, int32_t i);

/* By which its axes stand: those of a ball are the world's. */
static inline const fl_quat *fl_body_attitude(const fl_bodies *b, int32_t i)
{
    static const fl_quat level = {1, 0, 0, 0};
    return b->is_isotropic[i] ? &level : &b->q[i];
}

/* R of body i: its axes in the world.  Made from q whenever it is asked for,
 * in 40 instructions: to keep it would cost a body that touches nothing more than that. */
static inline fl_mat3 fl_body_axes(const fl_bodies *b, int32_t i)
{
    return q_matrix(b->is_isotropic[i] ? q_one() : b->q[i]);
}

/* Give body i these principal moments. */
void fl_body_set_inertia(fl_bodies *b, int32_t i, fl_vec3 I);

/* 1 over the least moment of body i. */
static inline double fl_body_max_inverse_inertia(const fl_bodies *b, int32_t i)
{
    const fl_vec3 e = b->invI[i];
    return fmax(e.x, fmax(e.y, e.z));
}

/* w of body i from q and L. */
void fl_body_update_spin(fl_bodies *b, int32_t i);

/* Set L so that body i turns with angular velocity w (world axes). */
void fl_body_set_spin(fl_bodies *b, int32_t i, fl_vec3 w);

/* I^-1 t in world axes. */
static inline fl_vec3 fl_body_apply_inverse_inertia(const fl_bodies *b, int32_t i, fl_vec3 t)
{
    const fl_vec3 ease = b->invI[i];
    if (b->is_isotropic[i]) return v3_scale(ease.x, t);
    const fl_mat3 R = q_matrix(b->q[i]);
    return m3_mul(R, v3_mul(ease, m3_tmul(R, t)));
}

/* R (m + M_a) R^T v: the linear momentum of body i and the water that moves with it [kg m/s], for a velocity
 * v. */
static inline fl_vec3 fl_body_momentum(const fl_bodies *b, int32_t i, fl_vec3 v)
{
    if (!b->added_mass) return v3_scale(b->m[i], v);
    const fl_mat3 R = fl_body_axes(b, i);
    return v3_madd(m3_mul(R, v3_mul(b->added_mass[i], m3_tmul(R, v))), b->m[i], v);
}

/* The velocity for which that is P: R (m + M_a)^-1 R^T P [m/s]. */
static inline fl_vec3 fl_body_velocity_of_momentum(const fl_bodies *b, int32_t i, fl_vec3 P)
{
    if (!b->added_mass) return v3_scale(b->invm[i], P);
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 p = m3_tmul(R, P), a = b->added_mass[i];
    const double m = b->m[i];
    return m3_mul(R, v3(p.x / (m + a.x), p.y / (m + a.y), p.z / (m + a.z)));
}

/* Kinetic energy, that of the water which moves with it included [J]. */
static inline double fl_body_kinetic_energy(const fl_bodies *b, int32_t i)
{
    const double turning = v3_dot(b->w[i], b->L[i]);
    if (b->added_mass) return 0.5 * (v3_dot(b->v[i], fl_body_momentum(b, i, b->v[i])) + turning);
    return 0.5 * (b->m[i] * v3_norm2(b->v[i]) + turning);
}

/* Directions in which nothing moves the centre of body i: FL_DOF_X | ... */
static inline unsigned fl_body_fixed_translations(const fl_bodies *b, int32_t i)
{
    return b->fixed_dof[i] & (FL_DOF_X | FL_DOF_Y | FL_DOF_Z);
}

/* The velocity of the centre of body i for an impulse there, in whatever direction it yields in [1/kg]. */
static inline double fl_body_inverse_mass(const fl_bodies *b, int32_t i)
{
    return fl_body_fixed_translations(b, i) == (FL_DOF_X | FL_DOF_Y | FL_DOF_Z) ? 0.0 : b->invm[i];
}

/* Velocity of the material point at world position offset a from the centre of mass. */
static inline fl_vec3 fl_body_point_velocity(const fl_bodies *b, int32_t i, fl_vec3 a)
{
    return v3_add(b->v[i], v3_cross(b->w[i], a));
}

#endif
