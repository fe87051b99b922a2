/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bond/joint.h"
#include <math.h>
#include "bond/bond_kinematics.h"
#include "geom/polygon_clip.h"

/* Change of area, and motion over the smaller half side, after which points are laid anew; and after which
 * the area is clipped anew. */
static const double RELAY = 0.02, RECLIP = 1e-4;
/* Common part, over that of the start, below which the joint ends: a thousandth of the force. */
static const double LEAST_AREA = 1e-3;

/* The frame of the mid-plane.  0 if the sides have turned by 60 degrees. */
static int joint_kinematics(const fl_bond *c, const fl_bodies *b, fl_vec3 way, fl_bond_kinematics *q)
{
    const fl_vec3 off = v3_add(v3_sub(b->x[c->j], b->x[c->i]), way);
    const fl_bond_kinematics to =
        fl_bond_kinematics_of(c->pi, c->pj, c->ni, c->nj, c->ai, c->aj, c->bi, c->bj,
                              r3_of(fl_body_axes(b, c->i)), r3_of(fl_body_axes(b, c->j)), off);
    if (!(to.cosine > FL_BOND_TURN_COSINE)) return 0;
    *q = fl_bond_set_frame(to, fl_bond_frame_defined(to) ? v3_unit(to.tangent) : v3_normal_to(to.m));
    return 1;
}

/* --- the common part ---------------------------------------------------------------------------- */

/* Common part of the faces in the mid-plane: moments along ta and tb, from the centre of body i. */
static fl_polygon_moments common_part(const fl_bond *c, const fl_joint *j, fl_joint_pool pool,
                                      const fl_bodies *b, fl_vec3 way, const fl_bond_kinematics *q)
{
    fl_vec2 v[2 * FL_JOINT_CORNERS], w[FL_JOINT_CORNERS];
    const fl_rows3 Ri = r3_of(fl_body_axes(b, c->i)), Rj = r3_of(fl_body_axes(b, c->j));
    const fl_vec3 off = v3_add(v3_sub(b->x[c->j], b->x[c->i]), way), *corner = pool.corner + j->first;
    for (int32_t k = 0; k < j->ni; k++) {
        const fl_vec3 x = r3_mul(Ri, corner[k]);
        v[k] = (fl_vec2){v3_dot(q->ta, x), v3_dot(q->tb, x)};
    }
    for (int32_t k = 0; k < j->nj; k++) {
        const fl_vec3 x = v3_add(off, r3_mul(Rj, corner[j->ni + j->nj - 1 - k]));
        w[k] = (fl_vec2){v3_dot(q->ta, x), v3_dot(q->tb, x)};
    }
    const int32_t n = fl_polygon_common(j->ni, v, j->nj, w, v);
    return fl_polygon_moments_of(n, v);
}

/* Half sides u, v of the rectangle with the second moments of s, the shorter one first, as angle and lengths.
 * */
static void half_sides(const fl_polygon_moments *s, fl_vec2 *along, double half[2])
{
    const double mean = 0.5 * (s->xx + s->yy), diff = 0.5 * (s->xx - s->yy),
                 off = sqrt(diff * diff + s->xy * s->xy), small = mean - off > 0.0 ? mean - off : 0.0;
    fl_vec2 less = {s->xy, -diff - off};
    if (diff < 0.0) less = (fl_vec2){diff - off, s->xy};
    double size = sqrt(less.x * less.x + less.y * less.y);
    if (!(size > 1e-9 * mean)) less = (fl_vec2){1.0, 0.0}, size = 1.0;
    *along = (fl_vec2){less.x / size, less.y / size};
    half[0] = sqrt(3.0 * small / s->area), half[1] = sqrt(3.0 * (mean + off) / s->area);
}

/* The vector x of the mid-plane, moved along m into the plane through the origin with normal n. */
static fl_vec3 onto_plane(fl_vec3 x, fl_vec3 n, fl_vec3 m)
{
    return v3_madd(x, -v3_dot(n, x) / v3_dot(n, m), m);
}

/* Lays the points on the common part s. */
static void lay_points(fl_bond *c, fl_joint *j, const fl_bodies *b, fl_vec3 way, const fl_bond_kinematics *q,
                       const fl_polygon_moments *s)
{
    const fl_mat3 Ri = fl_body_axes(b, c->i), Rj = fl_body_axes(b, c->j);
    const fl_vec3 off = v3_add(v3_sub(b->x[c->j], b->x[c->i]), way);
    fl_vec2 along;
    double half[2];
    half_sides(s, &along, half);
    const fl_vec3 e = v3_madd(v3_scale(along.x, q->ta), along.y, q->tb), f = v3_cross(q->m, e);
    const fl_vec3 flat = v3_madd(v3_scale(s->centre.x, q->ta), s->centre.y, q->tb);
    /* through the old points, which lie on the faces */
    const fl_vec3 xi = v3_add(q->ri, onto_plane(v3_sub(flat, q->ri), q->ni, q->m)), rj = v3_add(off, q->rj),
                  xj = v3_add(rj, onto_plane(v3_sub(flat, rj), q->nj, q->m));
    c->pi = m3_tmul(Ri, xi), c->pj = m3_tmul(Rj, v3_sub(xj, off));
    c->ai = m3_tmul(Ri, v3_scale(half[0], onto_plane(e, q->ni, q->m)));
    c->aj = m3_tmul(Rj, v3_scale(half[0], onto_plane(e, q->nj, q->m)));
    c->bi = m3_tmul(Ri, v3_scale(half[1], onto_plane(f, q->ni, q->m)));
    c->bj = m3_tmul(Rj, v3_scale(half[1], onto_plane(f, q->nj, q->m)));
    c->area = j->laid_area = s->area;
    j->clipped[0] = j->clipped[1] = 0.0;
}

/* A number of the points as a linear field over the half sides: value, slopes. */
typedef struct {
    double f, fu, fv;
} linear_field;

static linear_field fit_field(const double *x)
{
    linear_field s = {0};
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        double xi, eta;
        const double w = fl_bond_quadrature_point(k, &xi, &eta);
        s.f += w * x[k], s.fu += 3.0 * w * xi * x[k], s.fv += 3.0 * w * eta * x[k];
    }
    return s;
}

static double field_at(const linear_field *s, double xi, double eta)
{
    return s->f + xi * s->fu + eta * s->fv;
}

/* What the old points had, at the new ones.  old, now: kinematics before and after. */
static void carry_points(fl_joint *j, const fl_bond_kinematics *old, const fl_bond_kinematics *now)
{
    double x[5][FL_BOND_POINTS];
    linear_field field[5];
    fl_joint_point to[FL_BOND_POINTS];
    const double c = v3_dot(now->ta, old->ta), s = v3_dot(now->ta, old->tb);
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        const fl_joint_point *p = &j->point[k];
        x[0][k] = p->tau[0], x[1][k] = p->tau[1], x[2][k] = p->offset, x[3][k] = p->slip, x[4][k] = p->angle;
    }
    for (int e = 0; e < 5; e++) field[e] = fit_field(x[e]);
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        double xi, eta;
        fl_bond_quadrature_point(k, &xi, &eta);
        const fl_vec3 r = v3_sub(v3_madd(v3_madd(now->ri, xi, now->ui), eta, now->vi), old->ri);
        const double u = v3_dot(r, old->ui) / v3_norm2(old->ui), v = v3_dot(r, old->vi) / v3_norm2(old->vi);
        const int col = u < -0.5 ? 0 : u > 0.5 ? 2 : 1, row = v < -0.5 ? 0 : v > 0.5 ? 2 : 1;
        const fl_joint_point *near = &j->point[3 * row + col];
        const double ta = field_at(&field[0], u, v), tb = field_at(&field[1], u, v);
        to[k] = *near;
        to[k].tau[0] = c * ta + s * tb, to[k].tau[1] = c * tb - s * ta;
        to[k].way[0] = c * near->way[0] + s * near->way[1],
        to[k].way[1] = c * near->way[1] - s * near->way[0];
        to[k].offset = field_at(&field[2], u, v);
        to[k].slip = fmax(0.0, field_at(&field[3], u, v));
        to[k].angle = field_at(&field[4], u, v);
        if (near->open) to[k].tau[0] = to[k].tau[1] = 0.0;
    }
    for (int k = 0; k < FL_BOND_POINTS; k++) j->point[k] = to[k];
}

/* --- separation --------------------------------------------------------------------------------- */

static void save_separation(fl_bond *c, const fl_bond_kinematics *q)
{
    c->s[0] = q->s.x, c->s[1] = q->s.y, c->s[2] = q->s.z;
    c->su[0] = q->su.x, c->su[1] = q->su.y, c->su[2] = q->su.z;
    c->sv[0] = q->sv.x, c->sv[1] = q->sv.y, c->sv[2] = q->sv.z;
}

static fl_vec3 point_separation(const fl_bond_kinematics *q, double xi, double eta)
{
    return v3_madd(v3_madd(q->s, xi, q->su), eta, q->sv);
}

static void clear_joint(fl_bond *c)
{
    c->force = c->torque_i = c->torque_j = c->force_damping = c->torque_i_damping = c->torque_j_damping =
        c->force_friction = c->torque_i_friction = c->torque_j_friction = v3(0, 0, 0);
    c->elastic_energy = c->friction_spring_energy = 0.0;
}

/* Clips the common part where the sides have moved, and lays the points anew where they have moved far.
 * Returns 0 if nothing is left of it. */
static int follow_area(fl_bond *c, fl_joint *j, fl_joint_pool pool, const fl_bodies *b, fl_vec3 way,
                       fl_bond_kinematics *q)
{
    const double side = v3_norm(c->ai), dy = q->s.y - j->clipped[0], dz = q->s.z - j->clipped[1];
    if (dy * dy + dz * dz < RECLIP * RECLIP * side * side) return 1;
    const fl_polygon_moments s = common_part(c, j, pool, b, way, q);
    if (!(s.area > LEAST_AREA * c->h0)) return 0;
    c->area = s.area;
    j->clipped[0] = q->s.y, j->clipped[1] = q->s.z;
    const double moved2 = q->s.y * q->s.y + q->s.z * q->s.z;
    if (fabs(s.area - j->laid_area) < RELAY * j->laid_area && moved2 < RELAY * RELAY * side * side) return 1;
    const fl_bond_kinematics old = *q;
    fl_bond before = *c;
    fl_joint kept = *j;
    lay_points(c, j, b, way, q, &s);
    if (!joint_kinematics(c, b, way, q)) return 0;
    /* a common part without width has no second moment: the old points stay */
    if (!(v3_norm(c->ai) > 1e-9 * v3_norm(c->bi)) || !v3_finite(c->ai)) {
        before.area = s.area;
        *c = before, *j = kept, *q = old;
        return 1;
    }
    carry_points(j, &old, q);
    save_separation(c, q); /* the step that ends here has been made: the next one starts at the new points */
    return 1;
}

/* What a point stores before any of its strength is lost [J/m2]. */
static double stored_at_start(const fl_joint_material *m, fl_joint_point p, double s_n)
{
    static const double NO_SLIP[2] = {0.0, 0.0};
    fl_joint_material strong = *m;
    strong.cohesion = strong.tension = INFINITY;
    return fl_joint_laws[m->law].step(&strong, &p, s_n, NO_SLIP).stored;
}

int fl_joint_start(fl_bond *c, fl_joint *j, fl_joint_pool pool, const fl_bodies *b, fl_vec3 way,
                   const double S[6])
{
    const fl_joint_material *m = &pool.material[j->material];
    const fl_vec3 *corner = pool.corner + j->first;
    fl_bond_kinematics q;
    /* any points of the faces, for the frame */
    c->pi = corner[0], c->pj = corner[j->ni];
    c->ai = v3_sub(corner[1], corner[0]);
    c->bi = v3_cross(c->ni, c->ai);
    const fl_mat3 Ri = fl_body_axes(b, c->i), Rj = fl_body_axes(b, c->j);
    c->aj = m3_tmul(Rj, m3_mul(Ri, c->ai)), c->bj = m3_tmul(Rj, m3_mul(Ri, c->bi));
    if (!joint_kinematics(c, b, way, &q)) return 0;
    const fl_polygon_moments s = common_part(c, j, pool, b, way, &q);
    if (!(s.area > 0.0)) return 0;
    lay_points(c, j, b, way, &q, &s);
    if (!(v3_norm(c->ai) > 1e-9 * v3_norm(c->bi)) || !joint_kinematics(c, b, way, &q)) return 0;
    c->h0 = c->area;
    save_separation(c, &q);
    const fl_vec3 n = q.m, t = v3(S[0] * n.x + S[3] * n.y + S[5] * n.z, S[3] * n.x + S[1] * n.y + S[4] * n.z,
                                  S[5] * n.x + S[4] * n.y + S[2] * n.z);
    /* the traction on i is -t; that of the law pulls i along the slip of j */
    const double sigma = v3_dot(n, t), tau[2] = {-v3_dot(q.ta, t), -v3_dot(q.tb, t)};
    c->elastic_energy = 0.0;
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        double xi, eta;
        fl_joint_point_start(m, &j->point[k], sigma, tau);
        j->point[k].offset += q.s.x; /* rounding of the file, a part of the radius */
        j->sigma[k] = sigma + m->water_pressure;
        c->elastic_energy += fl_bond_quadrature_point(k, &xi, &eta) * c->area *
                             (stored_at_start(m, j->point[k], q.s.x) - m->water_pressure * q.s.x);
    }
    return 1;
}

/* --- force -------------------------------------------------------------------------------------- */

typedef struct {
    fl_traction t, damping;
    double turn[2];
    fl_vec3 half;
    double stored, work;
    int failed;
} joint_sums;

static void add_point_traction(fl_traction *t, double xi, double eta, fl_vec3 f)
{
    t->f = v3_add(t->f, f);
    t->fu = v3_madd(t->fu, xi, f);
    t->fv = v3_madd(t->fv, eta, f);
}

/* One point over a step: its law, its traction, work and energy. */
static void step_point(fl_bond *c, fl_joint *j, const fl_joint_material *m, const fl_bond_kinematics *q,
                       int k, const fl_traction *rate, joint_sums *out)
{
    fl_joint_point *p = &j->point[k];
    double xi, eta;
    const double wa = fl_bond_quadrature_point(k, &xi, &eta) * c->area, water = m->water_pressure;
    const fl_vec3 s = point_separation(q, xi, eta);
    const double before[3] = {c->s[0] + xi * c->su[0] + eta * c->sv[0],
                              c->s[1] + xi * c->su[1] + eta * c->sv[1],
                              c->s[2] + xi * c->su[2] + eta * c->sv[2]};
    const double ds[2] = {s.y - before[1], s.z - before[2]}, tau[2] = {p->tau[0], p->tau[1]};
    const fl_joint_point_result r = fl_joint_laws[m->law].step(m, p, s.x, ds);
    const double pressed = p->sigma + water;
    const fl_vec3 t = v3(-wa * pressed, wa * p->tau[0], wa * p->tau[1]);
    add_point_traction(&out->t, xi, eta, t);
    out->turn[0] += t.x * s.y - s.x * t.y;
    out->turn[1] += t.x * s.z - s.x * t.z;
    out->work += wa * (-0.5 * (j->sigma[k] + pressed) * (s.x - before[0]) +
                       0.5 * (tau[0] + p->tau[0]) * ds[0] + 0.5 * (tau[1] + p->tau[1]) * ds[1]);
    out->stored += wa * (r.stored - water * s.x);
    j->friction_loss += wa * r.friction;
    c->dissipated -= wa * r.friction;
    j->sigma[k] = pressed;
    j->slips += r.slips, j->opens += p->open;
    out->failed += p->failed;
    if (!(c->damping > 0.0) || p->open) return;
    const double scale = wa * c->damping, shear = r.slips ? 0.0 : scale * c->ks;
    const fl_vec3 v = v3_madd(v3_madd(rate->f, xi, rate->fu), eta, rate->fv),
                  x = v3_mul(v3(scale * c->kn, shear, shear), v);
    add_point_traction(&out->damping, xi, eta, x);
    out->half = v3_add(out->half, fl_traction_moment(s, x));
}

int fl_joint_force(fl_bond *c, fl_joint *j, fl_joint_pool pool, const fl_bodies *b, fl_vec3 way)
{
    const fl_joint_material *m = &pool.material[j->material];
    fl_bond_kinematics q;
    joint_sums r = {0};
    fl_traction rate = {0};
    if (c->state == FL_BOND_ENDED) return 0;
    if (!joint_kinematics(c, b, way, &q)) {
        fl_bond_end(c);
        return 1;
    }
    const double had = c->elastic_energy;
    clear_joint(c);
    j->slips = j->opens = 0;
    if (c->damping > 0.0) rate = fl_bond_separation_rate(q, b->v[c->i], b->w[c->i], b->v[c->j], b->w[c->j]);
    for (int k = 0; k < FL_BOND_POINTS; k++) step_point(c, j, m, &q, k, &rate, &r);
    save_separation(c, &q);
    c->elastic_energy = r.stored;
    c->dissipated += r.work + had - r.stored;
    c->state = r.failed == FL_BOND_POINTS ? FL_BOND_BROKEN : r.failed ? FL_BOND_DAMAGED : FL_BOND_INTACT;
    const fl_bond_wrench p = fl_traction_with_rotation(q, r.t, r.turn[0], r.turn[1]);
    c->force = p.f, c->torque_i = p.ti, c->torque_j = p.tj;
    if (c->damping > 0.0) {
        const fl_bond_wrench d = fl_traction_at_middle(q, r.damping, r.half);
        c->force_damping = d.f, c->torque_i_damping = d.ti, c->torque_j_damping = d.tj;
        c->force = v3_add(c->force, d.f);
        c->torque_i = v3_add(c->torque_i, d.ti), c->torque_j = v3_add(c->torque_j, d.tj);
    }
    /* for the next step; the energy of points laid anew differs a little, which that step books */
    if (follow_area(c, j, pool, b, way, &q)) return 0;
    fl_bond_end(c);
    return 1;
}
