/* SPDX-License-Identifier: GPL-3.0-or-later */
/* closest_kernel.h -- the functions of closest_point.h by value, for the CPU and devices.  No call but
 * sqrt. */
#ifndef FL_NARROW_CLOSEST_KERNEL_H
#define FL_NARROW_CLOSEST_KERNEL_H
#include "geom/poly.h"

typedef struct {
    double d;  /* distance, negative inside                                             [m] */
    fl_vec3 p; /* closest point of the shape                                            [m] */
    fl_vec3 n; /* unit vector from p to x, or against it when d < 0: always outward */
} fl_closest_point;

/* Points x and p. */
static inline fl_closest_point fl_closest_of_point(fl_vec3 p, fl_vec3 x)
{
    const fl_vec3 r = v3_sub(x, p);
    const double d = v3_norm(r);
    return (fl_closest_point){d, p, d > 0.0 ? v3_scale(1.0 / d, r) : v3(0, 0, 1)};
}

/* Fraction of the size below which two points coincide and have no direction between them: coordinates have
 * rounding errors of about 2^-53 of it. */
#define FL_SAME_POINT_TOL 1e-15

/* n: from p to x; d: its square. */
static inline fl_closest_point fl_squared_on_segment(fl_vec3 a, fl_vec3 b, fl_vec3 x)
{
    const fl_vec3 e = v3_sub(b, a), r = v3_sub(x, a);
    const double ee = v3_norm2(e), re = v3_dot(r, e);
    const double t = re <= 0.0 ? 0.0 : re >= ee ? 1.0 : re / ee;
    const fl_vec3 p = t == 1.0 ? b : v3_madd(a, t, e), n = v3_sub(x, p);
    return (fl_closest_point){v3_norm2(n), p, n};
}

/* True if the foot of x on face f lies within the face: x is on the inner side of all its edges. */
static inline int fl_foot_is_inside(const fl_poly *p, int32_t f, fl_vec3 x)
{
    const int32_t *loop = p->loop + p->first[f], k = p->first[f + 1] - p->first[f];
    const fl_vec3 n = p->n[f];
    fl_vec3 a = p->v[loop[k - 1]];
    for (int32_t j = 0; j < k; j++) {
        const fl_vec3 b = p->v[loop[j]];
        if (v3_dot(v3_cross(n, v3_sub(b, a)), v3_sub(x, a)) < 0.0) return 0;
        a = b;
    }
    return 1;
}

static inline fl_closest_point fl_distance_on_border(const fl_poly *p, int32_t f, fl_vec3 x)
{
    const int32_t *loop = p->loop + p->first[f], k = p->first[f + 1] - p->first[f];
    fl_vec3 a = p->v[loop[k - 1]];
    fl_closest_point best;
    best.d = INFINITY, best.p = best.n = v3(0, 0, 0);
    for (int32_t j = 0; j < k; j++) {
        const fl_vec3 b = p->v[loop[j]];
        const fl_closest_point q = fl_squared_on_segment(a, b, x);
        if (q.d < best.d) best = q;
        a = b;
    }
    best.d = sqrt(best.d);
    return best;
}

static inline fl_closest_point fl_point_on_segment(fl_vec3 a, fl_vec3 b, fl_vec3 x)
{
    fl_closest_point q = fl_squared_on_segment(a, b, x);
    q.d = sqrt(q.d);
    q.n = q.d > 0.0 ? v3_scale(1.0 / q.d, q.n) : v3(0, 0, 1);
    return q;
}

static inline fl_closest_point fl_point_on_face_border(const fl_poly *p, int32_t f, fl_vec3 x)
{
    fl_closest_point q = fl_distance_on_border(p, f, x);
    q.n = q.d > FL_SAME_POINT_TOL * p->size ? v3_scale(1.0 / q.d, q.n) : p->n[f];
    return q;
}

static inline fl_closest_point fl_point_on_face(const fl_poly *p, int32_t f, fl_vec3 x)
{
    const double s = v3_dot(p->n[f], x) - p->c[f];
    if (!fl_foot_is_inside(p, f, x)) return fl_point_on_face_border(p, f, x);
    return (fl_closest_point){fabs(s), v3_madd(x, -s, p->n[f]), s < 0.0 ? v3_neg(p->n[f]) : p->n[f]};
}

static inline fl_closest_point fl_point_on_poly(const fl_poly *p, fl_vec3 x)
{
    double top = -INFINITY;
    int32_t face = -1;
    for (int32_t f = 0; f < p->nf; f++) {
        const double s = v3_dot(p->n[f], x) - p->c[f];
        if (s > top) {
            top = s;
            face = f;
        }
    }
    if (face < 0) return fl_point_on_segment(p->v[0], p->v[p->nv - 1], x); /* a point or a segment */
    /* A flat polygon has no inside: a point in its plane may lie beside it. */
    if (p->nf == 2) return fl_point_on_face(p, face, x);
    /* Inside, or the foot on the farthest plane is within its face: no other point of a convex body is
     * closer. */
    if (top <= 0.0 || fl_foot_is_inside(p, face, x))
        return (fl_closest_point){top, v3_madd(x, -top, p->n[face]), p->n[face]};
    /* The closest point lies on a face that x can see, and no nearer than the plane of that face. */
    fl_closest_point best;
    best.d = INFINITY, best.p = best.n = v3(0, 0, 0);
    for (int32_t f = 0; f < p->nf; f++) {
        const double s = v3_dot(p->n[f], x) - p->c[f];
        if (s <= 0.0 || s >= best.d) continue;
        if (fl_foot_is_inside(p, f, x)) return (fl_closest_point){s, v3_madd(x, -s, p->n[f]), p->n[f]};
        const fl_closest_point q = fl_distance_on_border(p, f, x);
        if (q.d < best.d) best = q;
    }
    best.n = best.d > FL_SAME_POINT_TOL * p->size ? v3_scale(1.0 / best.d, best.n) : p->n[face];
    return best;
}

static inline fl_closest_point fl_point_on_cone(double r0, double r1, double h, fl_vec3 x)
{
    /* In the half-plane of x the cone is the quadrilateral (0,0) (r0,0) (r1,h) (0,h); its outer sides are the
     * two ends and the slant side.  Points are (rho, z). */
    const double rho = sqrt(x.x * x.x + x.y * x.y), z = x.z;
    const double cx = rho > 0.0 ? x.x / rho : 1.0, cy = rho > 0.0 ? x.y / rho : 0.0;
    const double side = sqrt(h * h + (r1 - r0) * (r1 - r0)), nr = h / side, nz = (r0 - r1) / side;
    const double below = -z, above = z - h, out = nr * (rho - r0) + nz * z;
    double pr, pz, d, mr, mz;
    if (below <= 0.0 && above <= 0.0 && out <= 0.0) { /* inside: leave by the nearest side */
        d = below;
        mr = 0.0, mz = -1.0;
        if (above > d) d = above, mz = 1.0;
        if (out > d) d = out, mr = nr, mz = nz;
        pr = rho - d * mr, pz = z - d * mz;
    } else {
        double best = INFINITY;
        const double seg[3][4] = {{0.0, 0.0, r0, 0.0}, {0.0, h, r1, h}, {r0, 0.0, r1, h}};
        pr = pz = 0.0;
        for (int k = 0; k < 3; k++) {
            const double er = seg[k][2] - seg[k][0], ez = seg[k][3] - seg[k][1], ee = er * er + ez * ez;
            double t = (rho - seg[k][0]) * er + (z - seg[k][1]) * ez;
            t = t <= 0.0 || ee == 0.0 ? 0.0 : t >= ee ? 1.0 : t / ee;
            const double qr = seg[k][0] + t * er, qz = seg[k][1] + t * ez;
            const double dd = (rho - qr) * (rho - qr) + (z - qz) * (z - qz);
            if (dd < best) best = dd, pr = qr, pz = qz;
        }
        d = sqrt(best);
        mr = d > 0.0 ? (rho - pr) / d : nr;
        mz = d > 0.0 ? (z - pz) / d : nz;
    }
    return (fl_closest_point){d, v3(pr * cx, pr * cy, pz), v3(mr * cx, mr * cy, mz)};
}

#endif
