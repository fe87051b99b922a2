/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/mesh_side.h"
#include "base/pi.h"
#include "narrow/closest_point.h"

/* Cosine between N and r below which the winding number decides. It costs a pass over all faces, and an
 * ordinary corner is above. */
#define SURE_COSINE 0.05

/* The angle between the x axis and (c, s), s >= 0, in [0, pi], to 1e-11: libm has no fixed bits. */
static double angle_of(double c, double s)
{
    const double norm = sqrt(c * c + s * s);
    if (!(norm > 0.0)) return 0.0;
    c /= norm, s /= norm;
    /* sin and cos of half the angle, then tangents of a quarter, an eighth ... */
    const double half_sin = 0.5 * sqrt((1.0 - c) * (1.0 - c) + s * s),
                 half_cos = 0.5 * sqrt((1.0 + c) * (1.0 + c) + s * s);
    double t = half_sin / (1.0 + half_cos);
    for (int k = 0; k < 3; k++) t /= 1.0 + sqrt(1.0 + t * t);
    const double u = t * t; /* t < 0.0985: the next term of the series is below 1e-12 */
    return 32.0 * t * (1.0 - u * (1.0 / 3.0 - u * (1.0 / 5.0 - u * (1.0 / 7.0 - u * (1.0 / 9.0)))));
}

static double angle_between(fl_vec3 a, fl_vec3 b) { return angle_of(v3_dot(a, b), v3_norm(v3_cross(a, b))); }

/* The angle of tile f at a point q of it: that of its corner, or pi on a side, or 2 pi. */
static double angle_at(const fl_poly *p, int32_t f, fl_vec3 q, double tol)
{
    const int32_t *loop = p->loop + p->first[f], n = p->first[f + 1] - p->first[f];
    int side = 0;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 a = p->v[loop[k]], b = p->v[loop[k + 1 < n ? k + 1 : 0]], along = v3_sub(b, a),
                      r = v3_sub(q, a);
        if (v3_norm(r) <= tol) return angle_between(along, v3_sub(p->v[loop[k > 0 ? k - 1 : n - 1]], a));
        const double t = v3_dot(r, along) / v3_norm2(along);
        if (t > 0.0 && t < 1.0 && v3_norm(v3_madd(r, -t, along)) <= tol) side = 1;
    }
    return side ? PI : 2.0 * PI;
}

double fl_mesh_winding_number(const fl_poly *p, fl_vec3 x)
{
    double sum = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t *loop = p->loop + p->first[f], n = p->first[f + 1] - p->first[f];
        const fl_vec3 a = v3_sub(p->v[loop[0]], x);
        fl_vec3 b = v3_sub(p->v[loop[1]], x);
        for (int32_t k = 2; k < n; k++) {
            const fl_vec3 c = v3_sub(p->v[loop[k]], x);
            const double A = v3_norm(a), B = v3_norm(b), C = v3_norm(c), high = v3_dot(a, v3_cross(b, c)),
                         half = angle_of(A * B * C + v3_dot(a, b) * C + v3_dot(b, c) * A + v3_dot(c, a) * B,
                                         fabs(high));
            sum += high < 0.0 ? -half : half;
            b = c;
        }
    }
    return sum / (2.0 * PI);
}

/* Distances from tol to this multiple of it are neither here nor elsewhere. */
#define UNCLEAR 8.0

/* The corner nearest to q of the tiles within `far` of it, or q if there is none within `far`. */
static fl_vec3 nearest_corner(const fl_poly *p, const fl_piece_mesh *mesh, fl_vec3 q, double far)
{
    fl_vec3 corner = q;
    double least = far;
    fl_bvh_walk at = fl_bvh_walk_from(&mesh->tree, mesh->box, q);
    for (int32_t f; (f = fl_bvh_walk_next(&at, far)) >= 0;)
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) {
            const double d = v3_norm(v3_sub(p->v[p->loop[k]], q));
            if (d < least) least = d, corner = p->v[p->loop[k]];
        }
    return corner;
}

/* True if some corner of the tile is near q and yet not in it. */
static int has_unclear_corner(const fl_poly *p, int32_t f, fl_vec3 q, double tol)
{
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) {
        const double d = v3_norm(v3_sub(p->v[p->loop[k]], q));
        if (d > tol && d < UNCLEAR * tol) return 1;
    }
    return 0;
}

double fl_mesh_side(const fl_poly *p, const fl_piece_mesh *mesh, fl_vec3 x, fl_vec3 q, double tol)
{
    const fl_vec3 o = nearest_corner(p, mesh, q, UNCLEAR * tol), r = v3_sub(x, o);
    fl_vec3 N = v3(0, 0, 0);
    int clear = v3_norm(v3_sub(o, q)) <= tol;
    fl_bvh_walk at = fl_bvh_walk_from(&mesh->tree, mesh->box, o);
    for (int32_t f; (f = fl_bvh_walk_next(&at, UNCLEAR * tol)) >= 0;) {
        const double d = fl_closest_on_face(p, f, o).d;
        if (d > UNCLEAR * tol) continue;
        if (d > tol || has_unclear_corner(p, f, o, tol)) clear = 0;
        if (d <= tol) N = v3_madd(N, angle_at(p, f, o, tol), p->n[f]);
    }
    const double side = v3_dot(N, r);
    if (!mesh->closed || (clear && fabs(side) > SURE_COSINE * v3_norm(N) * v3_norm(r))) return side;
    return mesh->outer_winding + 0.5 - fl_mesh_winding_number(p, x);
}
