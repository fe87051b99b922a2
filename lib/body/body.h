/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body.h -- state arrays of all rigid bodies: floes first, then pieces of the structure.
 *
 * The frame of a body has the centre of mass as origin and the principal axes as axes, I.x <= I.y <= I.z.
 * Forces move the bodies [0, n). Bodies [n, total) are pieces of the structure, whose velocity is prescribed.
 * One geometry serves contact (the core and its dilation radius) and mass and water (the outer shape). */
#ifndef FL_BODY_BODY_H
#define FL_BODY_BODY_H
#include <stdint.h>
#include "base/err.h"
#include "body/fixed_dof.h"
#include "geom/mat3.h"
#include "geom/poly.h"
#include "geom/quat.h"
#include "geom/vec3.h"

typedef struct {
    int32_t n, total;
    /* state, [total] each */
    fl_vec3 *x; /* centre of mass [m] */
    fl_vec3 *v; /* velocity of that centre [m/s] */
    fl_vec3 *L; /* angular momentum, world axes [kg m2/s] */
    fl_quat *q; /* rotation from body axes to world axes */
    /* derived from the state */
    fl_vec3 *w; /* angular velocity, world axes [rad/s]; fl_drift() leaves its mean over the step */
    /* loads, world axes, about the centre of mass */
    fl_vec3 *f, *t; /* [N], [N m] */
    /* constants of a body */
    double *m, *invm;            /* [kg], [1/kg]; 0 and 0 for a piece of the structure */
    fl_vec3 *I;                  /* principal moments, ascending before added inertia [kg m2] */
    fl_vec3 *invI;               /* 1 / I by component; fl_body_set_inertia() sets both */
    double *radius;              /* dilation radius [m] */
    double *bounding_radius;     /* distance from x to the farthest vertex of the core [m] */
    fl_poly *core;               /* core polyhedron, body frame */
    uint8_t *fixed_dof;          /* FL_DOF_X | ... */
    uint8_t *is_isotropic;       /* 1: isotropic; its axes are the world's whatever q is */
    double *work_of_constraints; /* work done by the constraints so far [J] */
    /* bound of the path of any point of the core: sum over steps of |v| dt + chord bound [m] */
    double *odometer;
    /* of bodies with added mass; all NULL without */
    fl_vec3 *added_mass;    /* added mass per body axis [kg] */
    fl_vec3 *flow_velocity; /* velocity of the surrounding water [m/s] */
    double *flow_work;      /* work that flowing water has done by turning the added mass so far [J] */
    /* of spheres that stand for a sheet, which have no added_mass; NULL without */
    double *heave_mass; /* added mass along the vertical of the world, changes with the immersion [kg] */
    double *heave_work; /* work that these changes have done so far [J] */
} fl_bodies;

/* Allocates arrays for `total` bodies, of which the first n move. All are zero but q = 1 and I = 1. Returns
 * -1 with FL_SYSTEM. */
int fl_bodies_alloc(fl_bodies *b, int32_t n, int32_t total, fl_err *err);
void fl_bodies_free(fl_bodies *b);

/* Allocates added_mass, flow_velocity and flow_work, all zero. Returns -1 with FL_SYSTEM. */
int fl_bodies_alloc_added_mass(fl_bodies *b, fl_err *err);

/* Allocates heave_mass and heave_work, all zero. Returns -1 with FL_SYSTEM. */
int fl_bodies_alloc_heave(fl_bodies *b, fl_err *err);

/* True if body i is isotropic: its core is one point at the centre, its moments are equal, and so are its
 * added masses. */
int fl_body_is_isotropic(const fl_bodies *b, int32_t i);

/* Distance from x to the farthest point of the dilated body [m]. */
static inline double fl_body_extent(const fl_bodies *b, int32_t i)
{
    return b->bounding_radius[i] + b->radius[i];
}

/* Orientation of the axes of body i; an isotropic body has those of the world. */
static inline const fl_quat *fl_body_attitude(const fl_bodies *b, int32_t i)
{
    static const fl_quat level = {1, 0, 0, 0};
    return b->is_isotropic[i] ? &level : &b->q[i];
}

/* R of body i: body axes to world axes. It is computed from q in 40 instructions; a stored copy would cost a
 * body without contacts more. */
static inline fl_mat3 fl_body_axes(const fl_bodies *b, int32_t i)
{
    return q_matrix(b->is_isotropic[i] ? q_one() : b->q[i]);
}

/* Sets the principal moments of body i and their inverses. */
void fl_body_set_inertia(fl_bodies *b, int32_t i, fl_vec3 I);

/* 1 over the least principal moment of body i [1/(kg m2)]. */
static inline double fl_body_max_inverse_inertia(const fl_bodies *b, int32_t i)
{
    const fl_vec3 e = b->invI[i];
    return fmax(e.x, fmax(e.y, e.z));
}

/* Updates w of body i from q and L. */
void fl_body_update_spin(fl_bodies *b, int32_t i);

/* Sets w, and L to match, of body i (world axes). */
void fl_body_set_spin(fl_bodies *b, int32_t i, fl_vec3 w);

/* I^-1 t in world axes. */
static inline fl_vec3 fl_body_apply_inverse_inertia(const fl_bodies *b, int32_t i, fl_vec3 t)
{
    const fl_vec3 ease = b->invI[i];
    if (b->is_isotropic[i]) return v3_scale(ease.x, t);
    const fl_mat3 R = q_matrix(b->q[i]);
    return m3_mul(R, v3_mul(ease, m3_tmul(R, t)));
}

/* R (m + M_a) R^T v: linear momentum of body i with its added mass at velocity v [kg m/s]. */
static inline fl_vec3 fl_body_momentum(const fl_bodies *b, int32_t i, fl_vec3 v)
{
    if (b->heave_mass) return v3(b->m[i] * v.x, b->m[i] * v.y, (b->m[i] + b->heave_mass[i]) * v.z);
    if (!b->added_mass) return v3_scale(b->m[i], v);
    const fl_mat3 R = fl_body_axes(b, i);
    return v3_madd(m3_mul(R, v3_mul(b->added_mass[i], m3_tmul(R, v))), b->m[i], v);
}

/* Velocity of body i at linear momentum P: R (m + M_a)^-1 R^T P [m/s]. */
static inline fl_vec3 fl_body_velocity_of_momentum(const fl_bodies *b, int32_t i, fl_vec3 P)
{
    if (b->heave_mass) return v3(b->invm[i] * P.x, b->invm[i] * P.y, P.z / (b->m[i] + b->heave_mass[i]));
    if (!b->added_mass) return v3_scale(b->invm[i], P);
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 p = m3_tmul(R, P), a = b->added_mass[i];
    const double m = b->m[i];
    return m3_mul(R, v3(p.x / (m + a.x), p.y / (m + a.y), p.z / (m + a.z)));
}

/* Kinetic energy of body i, that of its added mass included [J]. */
static inline double fl_body_kinetic_energy(const fl_bodies *b, int32_t i)
{
    const double turning = v3_dot(b->w[i], b->L[i]);
    if (b->added_mass || b->heave_mass)
        return 0.5 * (v3_dot(b->v[i], fl_body_momentum(b, i, b->v[i])) + turning);
    return 0.5 * (b->m[i] * v3_norm2(b->v[i]) + turning);
}

/* Fixed translations of the centre of body i: FL_DOF_X | ... */
static inline unsigned fl_body_fixed_translations(const fl_bodies *b, int32_t i)
{
    return b->fixed_dof[i] & (FL_DOF_X | FL_DOF_Y | FL_DOF_Z);
}

/* Velocity change of the centre of body i per unit impulse at the centre, along a free direction [1/kg]. */
static inline double fl_body_inverse_mass(const fl_bodies *b, int32_t i)
{
    return fl_body_fixed_translations(b, i) == (FL_DOF_X | FL_DOF_Y | FL_DOF_Z) ? 0.0 : b->invm[i];
}

/* Velocity of the material point at offset a from the centre of mass, world axes. */
static inline fl_vec3 fl_body_point_velocity(const fl_bodies *b, int32_t i, fl_vec3 a)
{
    return v3_add(b->v[i], v3_cross(b->w[i], a));
}

#endif
