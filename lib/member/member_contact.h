/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_contact.h -- forces between two balls of a chain that stands for a bar or a beam, from their total
 * displacement and rotation; each is the gradient of an energy.
 *
 * Balls i and j lie L apart when unstrained.  E0 is the frame of the contact then, e1 from i to j; Q_i the
 * rotation of ball i since the start, A_i = Q_i E0.
 *
 *   beam    both balls transmit moments.  p = conj(A_i) A_j = (w, v) is their relative rotation by t about
 *           the unit vector u, th = t u = 2 g v with g = (t/2)/sin(t/2); E = A_i exp(th/2) the mean frame.
 *           The ends of the arms of length L/2 are d apart:
 *               E^T d = E^T (x_j - x_i) - L [w e1 + v v1/(1 + w)]
 *               energy = 1/2 d.E diag(EA/L, 12 EIz/L3, 12 EIy/L3) E^T d + 1/2 th.diag(GJ, EIy, EIz) th/L
 *               f = E diag(..) E^T d,   m = E [u u^T + g (1 - u u^T)] diag(GJ, EIy, EIz) th/L
 *               on i: +f, a_i x f + m + 1/2 d x f - h,    on j: -f, -a_j x f - m + 1/2 d x f + h
 *               h = 1/2 tan(t/4) E u x (d x f),  a_i = Q_i E0 (L/2) e1,  a_j = -Q_j E0 (L/2) e1
 *           The couples with d x f make the force the gradient of the energy; springs turn with the balls.
 *   hinged  ball h transmits no moment, ball b does: e = (x_b - x_h)/l, A = A_b, s_y = e.A e2, s_z = e.A e3.
 *               energy = EA/2L (l - L)2 + 3/2L (EIz s_y2 + EIy s_z2)
 *               N = EA/L (l - L),  g = 3/L (EIz s_y A e2 + EIy s_z A e3),  T = (g - (g.e) e)/l
 *               on h: N e + T,    on b: -(N e + T) and the moment e x g
 *   bar     neither does: N = EA/L (l - L)
 *   arms    an end may stand off its ball by an arm a that turns with it: x_i + Q_i a_i is in the place of
 *           x_i, and Q_i a_i x f adds to the moment on i (on j: -Q_j a_j x f)
 *
 * Pieces of a section that yields have the plastic stretch and curvatures of member_fibres.h subtracted;
 * energy is then what is stored.
 *
 * A straight chain of beam contacts is the Euler-Bernoulli element exactly, where displacements are small;
 * the error of large ones, and of buckling loads, is of second order in the length of a piece.
 * Source: Ye & Xu, Engineering Mechanics 41(3), 2024, in total form and with the couples that they leave out.
 * Limits: small strain; relative rotation t of a piece up to FL_MEMBER_ROTATION_MAX. */
#ifndef FL_MEMBER_MEMBER_CONTACT_H
#define FL_MEMBER_MEMBER_CONTACT_H
#include <math.h>
#include <stdint.h>
#include "geom/quat.h"
#include "member/member_fibres.h"

#define FL_MEMBER_ROTATION_MAX 1.0              /* rad */
#define FL_MEMBER_SINE2_MAX 0.70807341827357118 /* sin(1)^2, of a hinged piece */

enum fl_member_contact_kind {
    FL_MEMBER_BEAM,
    FL_MEMBER_HINGE_I, /* ball i is the hinge */
    FL_MEMBER_HINGE_J,
    FL_MEMBER_BAR
};

typedef struct {
    int32_t i, j;
    int32_t kind;
    int32_t member;           /* that it is a piece of */
    fl_quat e0;               /* E0 */
    double length;            /* L */
    double axial;             /* EA/L */
    double shear[2];          /* beam: 12 EIz/L3 along e2, 12 EIy/L3 along e3; hinged: 3 EIz/L, 3 EIy/L */
    double turn[3];           /* beam: GJ/L, EIy/L, EIz/L */
    int arms;                 /* some end stands off its ball */
    fl_vec3 arm[2];           /* from ball to end, at the start */
    fl_member_fibres *fibres; /* of a section that yields, borrowed; NULL: elastic */
} fl_member_contact;

/* Force on i, which is minus that on j, and the moments on both. */
typedef struct {
    fl_vec3 f, mi, mj;
} fl_member_force;

/* g - 1 = k s2 for g = asin(s)/s, s = sin(t/2). */
static inline double fl_member_arcsine(double s2)
{
    /* Coefficients of the series of asin(s)/s; the first term left out is below 1e-17 up to s2 = 0.0125. */
    static const double c[] = {1.0 / 6,     3.0 / 40,      5.0 / 112,     35.0 / 1152,
                               63.0 / 2816, 231.0 / 13312, 143.0 / 10240, 6435.0 / 557056};
    if (!(s2 > 0.0125)) /* a number that is none ends here too */
        return c[0] +
               s2 * (c[1] + s2 * (c[2] + s2 * (c[3] + s2 * (c[4] + s2 * (c[5] + s2 * (c[6] + s2 * c[7]))))));
    /* Half the angle: sin(t/4)2 = s2/(2(1 + w)), t/2 = 2 asin(sin(t/4)); down to where the series holds. */
    double factor = 1.0, q2 = s2, s = sqrt(s2);
    const double s0 = s;
    while (q2 > 0.0125) {
        q2 = q2 / (2.0 * (1.0 + sqrt(1.0 - q2)));
        factor *= 2.0;
    }
    s = sqrt(q2);
    const double k = fl_member_arcsine(q2), angle = factor * s * (1.0 + k * q2);
    return (angle / s0 - 1.0) / s2;
}

/* Columns of the matrix of a unit quaternion. */
static inline void fl_member_axes(fl_quat q, fl_vec3 e[3])
{
    const fl_mat3 a = q_matrix(q);
    for (int k = 0; k < 3; k++) e[k] = m3_col(a, k);
}

static inline fl_member_force fl_member_beam(const fl_member_contact *c, fl_vec3 dx, fl_quat qi, fl_quat qj,
                                             double *energy, double *rotation2)
{
    const fl_quat ai = q_mul(qi, c->e0);
    fl_quat aj = q_mul(qj, c->e0);
    fl_quat p = q_mul(q_conj(ai), aj);
    if (p.w < 0.0) { /* the same rotation; a quaternion and its negative are one */
        aj = (fl_quat){-aj.w, -aj.x, -aj.y, -aj.z};
        p = (fl_quat){-p.w, -p.x, -p.y, -p.z};
    }
    const fl_quat h = q_unit((fl_quat){ai.w + aj.w, ai.x + aj.x, ai.y + aj.y, ai.z + aj.z});
    const fl_mat3 e = q_matrix(h);
    const fl_vec3 v = v3(p.x, p.y, p.z);
    const double s2 = v3_norm2(v), w = p.w, over = 1.0 / (1.0 + w), half = 0.5 * c->length;
    const double k = fl_member_arcsine(s2), g = 1.0 + k * s2;
    const fl_vec3 mid = v3(w + v.x * v.x * over, v.y * v.x * over, v.z * v.x * over);
    const fl_vec3 d = v3_madd(m3_tmul(e, dx), -c->length, mid);
    fl_vec3 f = v3(c->axial * d.x, c->shear[0] * d.y, c->shear[1] * d.z);
    fl_vec3 big = v3(2.0 * g * c->turn[0] * v.x, 2.0 * g * c->turn[1] * v.y, 2.0 * g * c->turn[2] * v.z);
    if (energy) *energy = 0.5 * v3_dot(f, d) + g * v3_dot(big, v);
    if (c->fibres) {
        fl_member_fibres *const yields = c->fibres;
        fl_member_fibres_update(yields, c->length, d.x, 2.0 * g * v.y, 2.0 * g * v.z);
        if (energy) /* of shear and torsion, and of the fibres */
            *energy = 0.5 * (f.y * d.y + f.z * d.z) + g * big.x * v.x + yields->stored;
        f.x -= c->axial * c->length * yields->deform[0];
        big.y -= c->turn[1] * c->length * yields->deform[1];
        big.z -= c->turn[2] * c->length * yields->deform[2];
    }
    const fl_vec3 m = v3_madd(v3_scale(g, big), -k * v3_dot(v, big), v);
    const fl_vec3 bend = v3(0.0, v.z, -v.y); /* v x e1 */
    const fl_vec3 couple = v3_scale(0.5, v3_cross(d, f)), twist = v3_scale(over, v3_cross(v, couple));
    const fl_vec3 mi =
        v3_sub(v3_add(v3_add(v3_scale(half, v3_cross(v3_sub(mid, bend), f)), m), couple), twist);
    const fl_vec3 mj =
        v3_add(v3_add(v3_sub(v3_scale(half, v3_cross(v3_add(mid, bend), f)), m), couple), twist);
    *rotation2 = 4.0 * g * g * s2;
    return (fl_member_force){m3_mul(e, f), m3_mul(e, mi), m3_mul(e, mj)};
}

static inline fl_member_force fl_member_bar(const fl_member_contact *c, fl_vec3 dx, double *energy)
{
    const double l = v3_norm(dx);
    double n = c->axial * (l - c->length);
    if (energy) *energy = 0.5 * n * (l - c->length);
    if (c->fibres) {
        fl_member_fibres_update(c->fibres, c->length, l - c->length, 0.0, 0.0);
        if (energy) *energy = c->fibres->stored;
        n -= c->axial * c->length * c->fibres->deform[0];
    }
    return (fl_member_force){v3_scale(n / l, dx), v3(0, 0, 0), v3(0, 0, 0)};
}

static inline fl_member_force fl_member_hinged(const fl_member_contact *c, fl_vec3 dx, fl_quat qb,
                                               int hinge_i, double *energy, double *rotation2)
{
    fl_vec3 a[3];
    fl_member_axes(q_mul(qb, c->e0), a);
    const double l = v3_norm(dx), over = 1.0 / l, n = c->axial * (l - c->length);
    const fl_vec3 e =
        v3_scale(over, dx); /* from i to j: a change of sign of e leaves energy and forces as they are */
    const double sy = v3_dot(e, a[1]), sz = v3_dot(e, a[2]);
    const fl_vec3 g = v3_madd(v3_scale(c->shear[0] * sy, a[1]), c->shear[1] * sz, a[2]);
    const fl_vec3 t = v3_scale(over, v3_madd(g, -v3_dot(g, e), e)), m = v3_cross(e, g);
    const fl_vec3 f = v3_madd(t, n, e), none = v3(0, 0, 0);
    if (energy) *energy = 0.5 * n * (l - c->length) + 0.5 * (c->shear[0] * sy * sy + c->shear[1] * sz * sz);
    *rotation2 = (sy * sy + sz * sz) * (1.0 / FL_MEMBER_SINE2_MAX);
    return (fl_member_force){f, hinge_i ? none : m, hinge_i ? m : none};
}

/* Force of a contact whose ends are dx apart, and the moments about the ends; as the next otherwise. */
static inline fl_member_force fl_member_end_force(const fl_member_contact *c, fl_vec3 dx, fl_quat qi,
                                                  fl_quat qj, double *energy, double *rotation2)
{
    *rotation2 = 0.0;
    if (c->fibres && c->fibres->ruptured) {
        if (energy) *energy = 0.0;
        return (fl_member_force){v3(0, 0, 0), v3(0, 0, 0), v3(0, 0, 0)};
    }
    if (c->kind == FL_MEMBER_BEAM) return fl_member_beam(c, dx, qi, qj, energy, rotation2);
    if (c->kind == FL_MEMBER_BAR) return fl_member_bar(c, dx, energy);
    return fl_member_hinged(c, dx, c->kind == FL_MEMBER_HINGE_I ? qj : qi, c->kind == FL_MEMBER_HINGE_I,
                            energy, rotation2);
}

/* Force of a contact whose balls are dx = x_j - x_i apart.
 *   energy     NULL, or the energy of the contact
 *   rotation2  square of the relative rotation [rad2]; of a hinged contact, the square of
 *              the sine between ball and line of centres over that of 1 rad */
static inline fl_member_force fl_member_contact_force(const fl_member_contact *c, fl_vec3 dx, fl_quat qi,
                                                      fl_quat qj, double *energy, double *rotation2)
{
    if (!c->arms) return fl_member_end_force(c, dx, qi, qj, energy, rotation2);
    const fl_vec3 ai = q_rotate(qi, c->arm[0]), aj = q_rotate(qj, c->arm[1]);
    fl_member_force r = fl_member_end_force(c, v3_add(dx, v3_sub(aj, ai)), qi, qj, energy, rotation2);
    r.mi = v3_add(r.mi, v3_cross(ai, r.f));
    r.mj = v3_sub(r.mj, v3_cross(aj, r.f));
    return r;
}

#endif
