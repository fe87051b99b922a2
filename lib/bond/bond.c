/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "bond/bond.h"
#include "bond/bond_kinematics.h"
#include "bond/crack_friction.h"

static const double LOBATTO[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};

double fl_bond_quadrature_point(int k, double *along_a, double *along_b)
{
    *along_a = k % 3 - 1;
    *along_b = k / 3 - 1;
    return LOBATTO[k % 3] * LOBATTO[k / 3];
}

double fl_bond_max_length(double modulus, double energy, double strength)
{
    return 2.0 * modulus * energy / (strength * strength);
}

double fl_bond_fracture_energy(const fl_bond *c)
{
    const double peak = 0.5 * c->tensile_strength * c->tensile_strength / c->kn;
    return fmax(fmax(c->fracture_energy[0], peak), c->min_ductility * peak);
}

void fl_bond_set_face(fl_bond *c, const fl_bodies *b, fl_vec3 way, fl_vec3 x, fl_vec3 n, fl_vec3 a, fl_vec3 h)
{
    const fl_mat3 Ri = fl_body_axes(b, c->i), Rj = fl_body_axes(b, c->j);
    c->pi = m3_tmul(Ri, v3_sub(x, b->x[c->i]));
    c->pj = m3_tmul(Rj, v3_sub(v3_sub(x, way), b->x[c->j]));
    c->ni = m3_tmul(Ri, n), c->nj = m3_tmul(Rj, n);
    c->ai = m3_tmul(Ri, a), c->aj = m3_tmul(Rj, a);
    c->bi = m3_tmul(Ri, h), c->bj = m3_tmul(Rj, h);
}

/* Returns 0 if the sides have turned away from each other, so that there is no frame. */
static int find_kinematics(const fl_bond *c, const fl_bodies *b, fl_vec3 way, fl_bond_kinematics *q)
{
    const fl_vec3 off = v3_add(v3_sub(b->x[c->j], b->x[c->i]), way);
    const fl_bond_kinematics to =
        fl_bond_kinematics_of(c->pi, c->pj, c->ni, c->nj, c->ai, c->aj, c->bi, c->bj,
                              r3_of(fl_body_axes(b, c->i)), r3_of(fl_body_axes(b, c->j)), off);
    if (!(to.cosine > 0.0)) return 0;
    *q = fl_bond_set_frame(to, fl_bond_frame_defined(to) ? v3_unit(to.tangent) : v3_normal_to(to.m));
    return 1;
}

static void separation_at(const fl_bond_kinematics *q, double xi, double eta, double s[3])
{
    s[0] = q->s.x + xi * q->su.x + eta * q->sv.x;
    s[1] = q->s.y + xi * q->su.y + eta * q->sv.y;
    s[2] = q->s.z + xi * q->su.z + eta * q->sv.z;
}

/* --- fracture of a point ------------------------------------------------------------------------ */

/* Begins the damage of a point whose stress has reached the strength: sets lambda_c, on a path along which
 * all stresses grow in proportion, and lambda_f. */
static void begin_damage(const fl_bond *c, fl_bond_point *p, double lambda2, double shear2, double over)
{
    const double share = shear2 / lambda2;
    double mixed = 1.0;
    for (int32_t k = 0; k < c->mixed_mode_exponent; k++) mixed *= share;
    const double G = c->fracture_energy[0] + (c->fracture_energy[1] - c->fracture_energy[0]) * mixed;
    p->lambda_c = sqrt(lambda2 / over);
    p->lambda_f = fmax(2.0 * G / p->lambda_c, c->min_ductility * p->lambda_c);
    if (p->lambda_f <= p->lambda_c) p->lambda_f = p->lambda_c;
}

/* Damage at the separation s. */
static double damage_of(const fl_bond *c, fl_bond_point *p, const double s[3])
{
    const double open = fl_bond_positive_part(s[0]), pressed = fl_bond_positive_part(-s[0]),
                 shear2 = s[1] * s[1] + s[2] * s[2];
    const double lambda2 = c->kn * open * open + c->ks * shear2;
    if (p->d == 1.0 || !(lambda2 > 0.0)) return p->d;
    if (p->lambda_c == 0.0) {
        const double sigma = c->kn * open / c->tensile_strength, tau2 = c->ks * c->ks * shear2,
                     limit = c->cohesion + c->internal_friction * c->kn * pressed;
        const double over = sigma * sigma + tau2 / (limit * limit);
        if (!(over >= 1.0)) return 0.0;
        begin_damage(c, p, lambda2, c->ks * shear2, over);
    }
    if (p->lambda_f == p->lambda_c) return 1.0;
    const double lambda = sqrt(lambda2);
    if (lambda <= p->lambda_c) return p->d;
    const double d = p->lambda_f * (lambda - p->lambda_c) / (lambda * (p->lambda_f - p->lambda_c));
    return d >= 1.0 ? 1.0 : d > p->d ? d : p->d;
}

/* Slips until friction carries the traction; e[2]: the stretch of the friction springs. */
static void slip_to_friction(const fl_bond *c, fl_bond_point *p, const double s[3], double kn, double e[2])
{
    const double limit = c->friction * kn * fl_bond_positive_part(-s[0]);
    double e0 = s[1] - p->slip[0], e1 = s[2] - p->slip[1];
    const double size = c->ks * sqrt(e0 * e0 + e1 * e1);
    if (size > limit) {
        const double back = limit / size;
        e0 *= back, e1 *= back;
        p->slip[0] = s[1] - e0, p->slip[1] = s[2] - e1;
    }
    e[0] = e0, e[1] = e1;
}

/* Share h of the sides that still overlap. */
static double overlap_share(const fl_bond *c, const fl_bond_kinematics *q)
{
    const double a = fl_bond_positive_part(1.0 - fabs(q->s.y) / (2.0 * v3_norm(c->ai))),
                 b = fl_bond_positive_part(1.0 - fabs(q->s.z) / (2.0 * v3_norm(c->bi)));
    return a * b * (q->cosine < FL_BOND_TURN_COSINE ? q->cosine / FL_BOND_TURN_COSINE : 1.0);
}

/* Wear c of the stiffness in compression. */
static double wear_of(const fl_bond *c, const fl_bond_kinematics *q)
{
    double now = 0.0;
    if (c->state == FL_BOND_BROKEN) now = c->h0 > 0.0 ? 1.0 - overlap_share(c, q) / c->h0 : 1.0;
    else if (q->cosine < FL_BOND_TURN_COSINE) now = 1.0 - q->cosine / FL_BOND_TURN_COSINE;
    return now > c->wear ? now : c->wear;
}

/* --- the face ---------------------------------------------------------------------------------- */

static void add_traction(fl_traction *t, double xi, double eta, double x, double y, double z)
{
    const fl_vec3 f = v3(x, y, z);
    t->f = v3_add(t->f, f);
    t->fu = v3_add(t->fu, v3_scale(xi, f));
    t->fv = v3_add(t->fv, v3_scale(eta, f));
}

static fl_vec3 half_moment(const double s[3], double x, double y, double z)
{
    return fl_traction_moment(v3(s[0], s[1], s[2]), v3(x, y, z));
}

static fl_bond_wrench damping_wrench(const fl_bond *c, const fl_bodies *b, const fl_bond_kinematics *q)
{
    const fl_traction rate = fl_bond_separation_rate(*q, b->v[c->i], b->w[c->i], b->v[c->j], b->w[c->j]);
    fl_traction t = {0};
    fl_vec3 half = v3(0, 0, 0);
    if (c->state == FL_BOND_INTACT)
        return fl_bond_damping_wrench(*q, c->damping, c->area, c->kn, c->ks, rate);
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        double xi, eta, s[3];
        const fl_bond_point *p = &c->point[k];
        const double scale = fl_bond_quadrature_point(k, &xi, &eta) * c->area * c->damping * (1.0 - p->d);
        const fl_vec3 r = v3_madd(v3_madd(rate.f, xi, rate.fu), eta, rate.fv),
                      x = v3_mul(v3(scale * c->kn, scale * c->ks, scale * c->ks), r);
        add_traction(&t, xi, eta, x.x, x.y, x.z);
        separation_at(q, xi, eta, s);
        half = v3_add(half, half_moment(s, x.x, x.y, x.z));
    }
    return fl_traction_at_middle(*q, t, half);
}

static void clear_output(fl_bond *c)
{
    c->force = c->torque_i = c->torque_j = c->force_damping = c->torque_i_damping = c->torque_j_damping =
        c->force_friction = c->torque_i_friction = c->torque_j_friction = v3(0, 0, 0);
    c->elastic_energy = c->friction_spring_energy = 0.0;
}

void fl_bond_end(fl_bond *c)
{
    c->dissipated += c->elastic_energy;
    clear_output(c);
    c->state = FL_BOND_ENDED;
}

/* Stores the separation. */
static void store_separation(fl_bond *c, const fl_bond_kinematics *q)
{
    c->s[0] = q->s.x, c->s[1] = q->s.y, c->s[2] = q->s.z;
    c->su[0] = q->su.x, c->su[1] = q->su.y, c->su[2] = q->su.z;
    c->sv[0] = q->sv.x, c->sv[1] = q->sv.y, c->sv[2] = q->sv.z;
}

void fl_bond_update_separation(fl_bond *c, const fl_bodies *b, fl_vec3 way)
{
    fl_bond_kinematics q;
    if (c->state != FL_BOND_ENDED && find_kinematics(c, b, way, &q)) store_separation(c, &q);
}

/* Sums over the points. */
typedef struct {
    fl_traction elastic, friction;
    double turn[2]; /* for the rotation of m */
    fl_vec3 half;   /* moment of friction */
    double couple;  /* of friction about m, of a crack */
    fl_crack_pressure pressure;
    int damaged, failed, open; /* numbers of points */
} point_sums;

static void add_pressure(fl_crack_pressure *p, double xi, double eta, double f)
{
    p->sum += f, p->a += f * xi, p->b += f * eta;
    p->aa += f * xi * xi, p->ab += f * xi * eta, p->bb += f * eta * eta;
}

/* Evaluates point k and adds its tractions. more: wear since the last evaluation. */
static void evaluate_point(fl_bond *c, const fl_bond_kinematics *q, int k, double more, point_sums *out)
{
    fl_bond_point *p = &c->point[k];
    double xi, eta, s[3], before[3];
    const double wa = fl_bond_quadrature_point(k, &xi, &eta) * c->area, pressing = c->kn * (1.0 - c->wear);
    separation_at(q, xi, eta, s);
    for (int e = 0; e < 3; e++) before[e] = c->s[e] + xi * c->su[e] + eta * c->sv[e];
    const double d = damage_of(c, p, s), grown = d - p->d, shear2 = s[1] * before[1] + s[2] * before[2];
    if (grown > 0.0)
        c->dissipated +=
            0.5 * wa * grown *
            (c->kn * fl_bond_positive_part(s[0]) * fl_bond_positive_part(before[0]) + c->ks * shear2);
    if (more > 0.0)
        c->dissipated +=
            0.5 * wa * more * c->kn * fl_bond_positive_part(-s[0]) * fl_bond_positive_part(-before[0]);
    p->d = d;
    const double kn = s[0] > 0.0 ? (1.0 - d) * c->kn : pressing, ks = (1.0 - d) * c->ks;
    add_traction(&out->elastic, xi, eta, wa * kn * s[0], wa * ks * s[1], wa * ks * s[2]);
    c->elastic_energy += 0.5 * wa * (kn * s[0] * s[0] + ks * (s[1] * s[1] + s[2] * s[2]));
    out->turn[0] += wa * (kn - ks) * s[0] * s[1];
    out->turn[1] += wa * (kn - ks) * s[0] * s[2];
    out->damaged += d > 0.0;
    out->failed += d == 1.0;
    out->open += s[0] >= 0.0;
    add_pressure(&out->pressure, xi, eta, wa * pressing * fl_bond_positive_part(-s[0]));
    if (d == 0.0 || c->state == FL_BOND_BROKEN) return; /* a crack: crack_friction() */
    double e[2];
    slip_to_friction(c, p, s, pressing, e);
    const double k_rub = wa * d * c->ks, held = 0.5 * wa * c->ks * (e[0] * e[0] + e[1] * e[1]);
    add_traction(&out->friction, xi, eta, 0.0, k_rub * e[0], k_rub * e[1]);
    out->half = v3_add(out->half, half_moment(s, 0.0, k_rub * e[0], k_rub * e[1]));
    c->friction_spring_energy += d * held;
    c->given_to_friction += grown * held;
    c->dissipated -= grown * held;
}

/* True if no point can have reached its strength. */
static int is_below_strength(const fl_bond *c, const fl_bond_kinematics *q)
{
    return fl_bond_strength_used(*q, c->kn, c->ks, c->tensile_strength, c->cohesion) < FL_BOND_INTACT_LIMIT;
}

/* Sets the elastic force and torques. */
static void set_elastic(fl_bond *c, fl_bond_wrench p)
{
    c->force = p.f, c->torque_i = p.ti, c->torque_j = p.tj;
}

static fl_face_separation separation_of(const double s[3], const double su[3], const double sv[3])
{
    return (fl_face_separation){{s[0], s[1], s[2]}, {su[0], su[1], su[2]}, {sv[0], sv[1], sv[2]}};
}

/* The springs of a crack are in the slips of its points, which a face that has failed needs no more. */
enum { SPRING_NUMBERS = 6 };

static fl_crack_springs crack_springs_of(const fl_bond *c)
{
    double x[SPRING_NUMBERS];
    for (int k = 0; k < SPRING_NUMBERS; k++) x[k] = c->point[k / 2].slip[k % 2];
    return (fl_crack_springs){x[0], x[1], x[2], x[3], x[4], x[5]};
}

static void keep_crack_springs(fl_bond *c, const fl_crack_springs *s)
{
    const double x[SPRING_NUMBERS] = {s->y, s->z, s->moment, s->k, s->k_turn, s->energy};
    for (int k = 0; k < 2 * FL_BOND_POINTS; k++)
        c->point[k / 2].slip[k % 2] = k < SPRING_NUMBERS ? x[k] : 0.0;
    c->friction_spring_energy = s->energy;
}

/* Friction of a crack, from the separation of the step before. */
static void crack_friction(fl_bond *c, const fl_face_separation *before, point_sums *r)
{
    const fl_face_separation now = separation_of(c->s, c->su, c->sv);
    const fl_crack_face face = {v3_norm(c->ai), v3_norm(c->bi), c->ks * c->area, c->friction};
    fl_crack_springs springs = crack_springs_of(c);
    const fl_crack_wrench w = fl_crack_friction_step(&springs, &face, &r->pressure, before, &now);
    double s[3];
    keep_crack_springs(c, &springs);
    for (int e = 0; e < 3; e++) s[e] = now.s[e] + w.along_a * now.su[e] + w.along_b * now.sv[e];
    add_traction(&r->friction, w.along_a, w.along_b, 0.0, w.force.y, w.force.z);
    r->half = half_moment(s, 0.0, w.force.y, w.force.z);
    r->couple = w.couple;
}

/* Friction of the points of a face that has just failed, as springs of the face. */
static void begin_crack(fl_bond *c, const point_sums *r)
{
    const double a = v3_norm(c->ai), b = v3_norm(c->bi);
    keep_crack_springs(c, &(fl_crack_springs){.y = r->friction.f.y,
                                              .z = r->friction.f.z,
                                              .moment = a * r->friction.fu.z - b * r->friction.fv.y,
                                              .energy = c->friction_spring_energy});
}

/* Evaluates all points of a face with damage, or with `more` wear. Returns 1 if the face ends. */
static int evaluate_points(fl_bond *c, const fl_bond_kinematics *q, double more, point_sums *r)
{
    const fl_face_separation before = separation_of(c->s, c->su, c->sv);
    for (int k = 0; k < FL_BOND_POINTS; k++) evaluate_point(c, q, k, more, r);
    store_separation(c, q);
    if (c->state == FL_BOND_BROKEN) crack_friction(c, &before, r);
    else if (r->failed == FL_BOND_POINTS) {
        c->h0 = overlap_share(c, q);
        begin_crack(c, r);
    }
    if (c->state != FL_BOND_BROKEN)
        c->state = r->failed == FL_BOND_POINTS ? FL_BOND_BROKEN
                   : r->damaged                ? FL_BOND_DAMAGED
                                               : FL_BOND_INTACT;
    if (c->state == FL_BOND_BROKEN && (r->open == FL_BOND_POINTS || c->wear >= 1.0)) return 1;
    set_elastic(c, fl_traction_with_rotation(*q, r->elastic, r->turn[0], r->turn[1]));
    return 0;
}

int fl_bond_force(fl_bond *c, const fl_bodies *b, fl_vec3 way)
{
    fl_bond_kinematics q;
    point_sums r = {0};
    if (c->state == FL_BOND_ENDED) return 0;
    if (!find_kinematics(c, b, way, &q)) {
        fl_bond_end(c);
        return 1;
    }
    const double worn_now = wear_of(c, &q), more = worn_now - c->wear;
    c->wear = worn_now;
    clear_output(c);
    if (c->state == FL_BOND_INTACT && worn_now == 0.0 && is_below_strength(c, &q)) {
        store_separation(c, &q);
        set_elastic(c, fl_bond_elastic_wrench(q, c->area, c->kn, c->ks));
        c->elastic_energy = fl_bond_elastic_energy(q, c->area, c->kn, c->ks);
    } else if (evaluate_points(c, &q, more, &r)) {
        fl_bond_end(c);
        return 1;
    }
    if (r.damaged) {
        const fl_bond_wrench p = fl_traction_at_middle(q, r.friction, r.half);
        const fl_vec3 couple = v3_scale(r.couple, q.m);
        c->force_friction = p.f;
        c->torque_i_friction = v3_add(p.ti, couple);
        c->torque_j_friction = v3_sub(p.tj, couple);
    }
    if (c->damping > 0.0) {
        const fl_bond_wrench p = damping_wrench(c, b, &q);
        c->force_damping = p.f, c->torque_i_damping = p.ti, c->torque_j_damping = p.tj;
    }
    if (!r.damaged && !(c->damping > 0.0)) return 0;
    c->force = v3_add(c->force, v3_add(c->force_friction, c->force_damping));
    c->torque_i = v3_add(c->torque_i, v3_add(c->torque_i_friction, c->torque_i_damping));
    c->torque_j = v3_add(c->torque_j, v3_add(c->torque_j_friction, c->torque_j_damping));
    return 0;
}

fl_bond_load fl_bond_section_load(const fl_bond *c, const fl_bodies *b, fl_vec3 way)
{
    const fl_mat3 Ri = fl_body_axes(b, c->i), Rj = fl_body_axes(b, c->j);
    const fl_vec3 ri = m3_mul(Ri, c->pi), rj = m3_mul(Rj, c->pj),
                  n = v3_add(m3_mul(Ri, c->ni), m3_mul(Rj, c->nj));
    const fl_vec3 off = v3_sub(v3_add(v3_add(b->x[c->j], way), rj), v3_add(b->x[c->i], ri)),
                  arm = v3_madd(ri, 0.5, off);
    fl_bond_load out = {.x = v3_add(b->x[c->i], arm)};
    if (c->state == FL_BOND_ENDED || !(v3_norm2(n) > 0.0)) return out;
    const fl_vec3 m = v3_unit(n);
    out.tension = v3_dot(c->force, m);
    out.shear = v3_norm(v3_madd(c->force, -out.tension, m));
    out.moment = v3_norm(v3_sub(c->torque_i, v3_cross(arm, c->force)));
    return out;
}

double fl_bond_mean_damage(const fl_bond *c)
{
    double sum = 0.0, xi, eta;
    for (int k = 0; k < FL_BOND_POINTS; k++) sum += fl_bond_quadrature_point(k, &xi, &eta) * c->point[k].d;
    return sum;
}
