/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/area_vector.h"
#include <math.h>
#include <string.h>
#include "base/fast_math.h"
#include "base/pi.h"

enum { CORNERS = 96, ARCS = 64, REFINEMENTS = 40, GAUSS = 8 };
/* A plane is along a generator below this sine. */
#define PARALLEL 1e-9
/* Ends of an arc are found to this angle, and to this margin. */
#define END 1e-13

/* Offset of face f: the largest over its vertices. */
static double offset_of_face(const fl_poly *p, int32_t f)
{
    if (p->c) return p->c[f];
    double c = -INFINITY;
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) c = fmax(c, v3_dot(p->n[f], p->v[p->loop[k]]));
    return c;
}

void fl_half_spaces_of(fl_half_spaces *q, const fl_poly *p, double r, const fl_mat3 *M, fl_vec3 o)
{
    q->n = p->nf < FL_HALF_SPACES ? p->nf : FL_HALF_SPACES;
    for (int k = 0; k < q->n; k++) {
        q->normal[k] = m3_mul(*M, p->n[k]);
        q->c[k] = offset_of_face(p, k) + r + v3_dot(q->normal[k], o);
    }
    fl_aabb box = aabb_empty();
    for (int32_t v = 0; v < p->nv; v++) box = aabb_add(box, v3_add(o, m3_mul(*M, p->v[v])));
    /* the outer shape stands out by more than r at its corners: 4 r covers those above 30 degrees */
    q->box = aabb_grow(box, 4.0 * r);
}

/* Clips a convex polygon by all half-spaces but number `but`; returns its number of corners. */
static int clip_polygon(const fl_half_spaces *a, int but, fl_vec3 *v, int n)
{
    fl_vec3 other[CORNERS], *from = v, *to = other;
    for (int k = 0; k < a->n && n > 0; k++) {
        int m = 0;
        if (k == but) continue;
        double last = v3_dot(a->normal[k], from[n - 1]) - a->c[k];
        for (int e = 0; e < n; e++) {
            const double now = v3_dot(a->normal[k], from[e]) - a->c[k];
            const fl_vec3 before = from[e ? e - 1 : n - 1];
            if ((now > 0.0) != (last > 0.0) && m < CORNERS)
                to[m++] = v3_lerp(before, from[e], last / (last - now));
            if (now <= 0.0 && m < CORNERS) to[m++] = from[e];
            last = now;
        }
        n = m;
        fl_vec3 *const swap = from;
        from = to, to = swap;
    }
    if (from != v && n > 0) memcpy(v, from, (size_t)n * sizeof *v);
    return n;
}

/* S and all that is closed are told apart at this share of the area. */
#define CLOSED 1e-6

/* Sums of the area vectors of polygons and of their moments. */
typedef struct {
    fl_vec3 S;
    double all;        /* of |S_x| + |S_y| + |S_z| of the polygons */
    fl_vec3 moment[3]; /* sum of S_k x for each component k */
    fl_vec3 facing;    /* what does not face this is left out; 0: nothing is */
} area_sum;

static void add_area(area_sum *q, fl_vec3 dS, fl_vec3 x)
{
    q->S = v3_add(q->S, dS);
    q->all += fabs(dS.x) + fabs(dS.y) + fabs(dS.z);
    q->moment[0] = v3_madd(q->moment[0], dS.x, x);
    q->moment[1] = v3_madd(q->moment[1], dS.y, x);
    q->moment[2] = v3_madd(q->moment[2], dS.z, x);
}

static void add_polygon(area_sum *q, const fl_vec3 *v, int n)
{
    for (int k = 1; k + 1 < n; k++) {
        const fl_vec3 dS = v3_scale(0.5, v3_cross(v3_sub(v[k], v[0]), v3_sub(v[k + 1], v[0])));
        if (v3_dot(dS, q->facing) < 0.0) continue;
        add_area(q, dS, v3_scale(1.0 / 3.0, v3_add(v[0], v3_add(v[k], v[k + 1]))));
    }
}

static fl_area_vector result_of(const area_sum *q)
{
    const double A2 = v3_norm2(q->S);
    fl_area_vector r = {q->S, {0, 0, 0}};
    if (!(A2 > 0.0)) return r;
    const fl_vec3 sum =
        v3_madd(v3_madd(v3_scale(q->S.x, q->moment[0]), q->S.y, q->moment[1]), q->S.z, q->moment[2]);
    r.centre = v3_scale(1.0 / A2, sum);
    return r;
}

/* Adds face f of p. */
static void add_face(area_sum *q, const fl_half_spaces *a, const fl_poly *p, int32_t f)
{
    fl_vec3 v[CORNERS];
    const int32_t n = p->first[f + 1] - p->first[f];
    if (n > CORNERS / 2) { /* a fan of triangles */
        for (int32_t k = 1; k + 1 < n; k++) {
            const int32_t *l = &p->loop[p->first[f]];
            v[0] = p->v[l[0]], v[1] = p->v[l[k]], v[2] = p->v[l[k + 1]];
            add_polygon(q, v, clip_polygon(a, -1, v, 3));
        }
        return;
    }
    for (int32_t k = 0; k < n; k++) v[k] = p->v[p->loop[p->first[f] + k]];
    add_polygon(q, v, clip_polygon(a, -1, v, n));
}

/* Adds the faces of a mesh whose boxes overlap that of a. */
static void add_mesh(area_sum *q, const fl_half_spaces *a, const fl_piece *piece)
{
    const fl_bvh *t = &piece->mesh.tree;
    int32_t stack[2 * FL_BVH_STACK], top = 0;
    if (t->nodes) stack[top++] = 0;
    while (top > 0) {
        const fl_bvh_node *node = &t->node[stack[--top]];
        if (!aabb_overlap(node->box, a->box)) continue;
        if (node->count == 0) {
            stack[top++] = node->first + 1;
            stack[top++] = node->first;
            continue;
        }
        for (int32_t k = node->first; k < node->first + node->count; k++)
            if (aabb_overlap(piece->mesh.box[t->order[k]], a->box)) add_face(q, a, &piece->core, t->order[k]);
    }
}

/* The part inside a of the generator of the cone at an angle with cosine c and sine s: from and to as shares
 * of its length.  Returns a margin, positive inside: of the length of that part, or of the distance to planes
 * along the generator, over the size of the cone. */
static double clip_generator(const fl_half_spaces *a, const fl_piece *cone, double c, double s, double *from,
                             double *to)
{
    const fl_vec3 x = v3(cone->r0 * c, cone->r0 * s, 0.0),
                  d = v3((cone->r1 - cone->r0) * c, (cone->r1 - cone->r0) * s, cone->h);
    double beside = INFINITY;
    *from = 0.0, *to = 1.0;
    for (int k = 0; k < a->n; k++) {
        const double h = a->c[k] - v3_dot(a->normal[k], x), g = v3_dot(a->normal[k], d);
        if (g > PARALLEL * cone->h) *to = fmin(*to, h / g);
        else if (g < -PARALLEL * cone->h) *from = fmax(*from, h / g);
        else beside = fmin(beside, h);
    }
    return fmin(beside / cone->h, *to - *from);
}

static double margin_at(const fl_half_spaces *a, const fl_piece *cone, double phi)
{
    double c, s, from, to;
    fl_cos_sin(phi, &c, &s);
    return clip_generator(a, cone, c, s, &from, &to);
}

/* Angle where the margin vanishes between `in` and `out`: false position, with the weight of the end that
 * stays halved (Illinois). */
static double end_of_arc(const fl_half_spaces *a, const fl_piece *cone, double in, double at_in, double out,
                         double at_out)
{
    for (int k = 0; k < REFINEMENTS && fabs(out - in) > END; k++) {
        const double mid = (in * at_out - out * at_in) / (at_out - at_in), at = margin_at(a, cone, mid);
        if (at > 0.0) {
            in = mid, at_in = at, at_out *= 0.5;
            if (at < END) break;
        } else {
            out = mid, at_out = at, at_in *= 0.5;
        }
    }
    return in;
}

/* End of the arc from `in`, which is inside, in the direction of `step`: the step doubles until it is
 * outside. in + 2 pi if it never is. */
static double search_end(const fl_half_spaces *a, const fl_piece *cone, double in, double at_in, double step)
{
    const double start = in;
    for (double way = step; fabs(in + way - start) < 2.0 * PI; way *= 2.0) {
        const double out = in + way, at = margin_at(a, cone, out);
        if (!(at > 0.0)) return end_of_arc(a, cone, in, at_in, out, at);
        in = out, at_in = at;
        if (fabs(way) > 0.25 * PI) way *= 0.5;
    }
    return start + (step > 0.0 ? 2.0 : -2.0) * PI;
}

/* Adds the arc between two angles: Gauss points of phi, exact along each generator, where n dA is
 * (cos, sin, -r') R(t) dphi dt h and R the radius there. */
static void add_arc(area_sum *q, const fl_half_spaces *a, const fl_piece *cone, double from, double to)
{
    static const double X[GAUSS / 2] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                        0.9602898564975363},
                                  W[GAUSS / 2] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                                  0.1012285362903763};
    const double half = 0.5 * (to - from), mid = 0.5 * (to + from), slope = (cone->r1 - cone->r0) / cone->h;
    for (int k = 0; k < GAUSS; k++) {
        double c, s, t0, t1;
        fl_cos_sin(mid + (k % 2 ? half : -half) * X[k / 2], &c, &s);
        if (!(clip_generator(a, cone, c, s, &t0, &t1) > 0.0)) continue;
        const double r0 = cone->r0 + t0 * (cone->r1 - cone->r0), r1 = cone->r0 + t1 * (cone->r1 - cone->r0),
                     length = (t1 - t0) * cone->h, weight = half * W[k / 2] * 0.5 * (r0 + r1) * length,
                     r = 0.5 * (r0 + r1), z = 0.5 * (t0 + t1) * cone->h;
        add_area(q, v3(weight * c, weight * s, -weight * slope), v3(r * c, r * s, z));
    }
}

static void add_arcs(area_sum *q, const fl_half_spaces *a, const fl_piece *cone, double from, double to)
{
    const int parts = (int)ceil((to - from) / (0.5 * PI + 1e-9));
    for (int k = 0; k < parts; k++)
        add_arc(q, a, cone, from + (to - from) * k / parts, from + (to - from) * (k + 1) / parts);
}

/* The part of an arc where (cos, sin, -r').facing > 0; the angles of arcs are within two turns. */
static void add_facing_arcs(area_sum *q, const fl_half_spaces *a, const fl_piece *cone, double from,
                            double to)
{
    const double across = sqrt(q->facing.x * q->facing.x + q->facing.y * q->facing.y),
                 least = (cone->r1 - cone->r0) / cone->h * q->facing.z;
    if (!(least < across)) return;
    const double middle = fl_atan2(q->facing.y, q->facing.x),
                 half =
                     least > -across ? 0.5 * PI - fl_atan2(least, sqrt(across * across - least * least)) : PI;
    for (int turn = -2; turn <= 2; turn++) {
        const double lo = fmax(from, middle + 2.0 * PI * turn - half),
                     hi = fmin(to, middle + 2.0 * PI * turn + half);
        if (hi > lo) add_arcs(q, a, cone, lo, hi);
    }
}

/* Arc of the cone inside a about the contact, in quarters of a turn at most.  If the contact is not inside,
 * the first arc of a scan. */
static void add_cone(area_sum *q, const fl_half_spaces *a, const fl_piece *cone, fl_vec3 about)
{
    const double step = 2.0 * PI / ARCS, start = fl_atan2(about.y, about.x);
    double in = start, at = margin_at(a, cone, in);
    for (int k = 1; k <= ARCS / 2 && !(at > 0.0); k++)
        for (int side = -1; side <= 1 && !(at > 0.0); side += 2)
            in = start + side * k * step, at = margin_at(a, cone, in);
    if (!(at > 0.0)) return;
    const double to = search_end(a, cone, in, at, step),
                 from = to < in + 2.0 * PI ? search_end(a, cone, in, at, -step) : in;
    if (v3_norm2(q->facing) > 0.0) add_facing_arcs(q, a, cone, from, to);
    else add_arcs(q, a, cone, from, to);
}

/* True if the box of face f overlaps that of a. */
static int face_is_near(const fl_half_spaces *a, const fl_poly *p, int32_t f)
{
    fl_aabb box = aabb_empty();
    for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) box = aabb_add(box, p->v[p->loop[k]]);
    return aabb_overlap(box, a->box);
}

static area_sum sum_of_piece(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 about, fl_vec3 facing)
{
    area_sum q = {.facing = facing};
    if (piece->kind == FL_PIECE_CONE) add_cone(&q, a, piece, about);
    else if (piece->kind == FL_PIECE_MESH) add_mesh(&q, a, piece);
    else if (piece->kind == FL_PIECE_SOLID)
        for (int32_t f = 0; f < piece->core.nf; f++)
            if (face_is_near(a, &piece->core, f)) add_face(&q, a, &piece->core, f);
    return q;
}

fl_area_vector fl_area_vector_of_piece(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 about)
{
    const area_sum q = sum_of_piece(a, piece, about, v3(0, 0, 0));
    return result_of(&q);
}

double fl_area_facing(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 about, fl_vec3 n)
{
    const area_sum q = sum_of_piece(a, piece, about, n);
    return v3_dot(n, q.S);
}

int fl_area_is_closed(const fl_half_spaces *a, const fl_piece *piece, fl_vec3 across)
{
    const area_sum q = sum_of_piece(a, piece, v3(1, 0, 0), v3(0, 0, 0));
    return q.all > 0.0 && v3_norm(v3_madd(q.S, -v3_dot(q.S, across), across)) <= CLOSED * q.all;
}

fl_area_vector fl_area_vector_of_body(const fl_half_spaces *a, const fl_half_spaces *b)
{
    const double size = v3_norm(v3_sub(b->box.hi, b->box.lo));
    const fl_vec3 middle = v3_scale(0.5, v3_add(b->box.lo, b->box.hi));
    area_sum q = {.S = {0, 0, 0}};
    for (int f = 0; f < b->n; f++) {
        /* a square in the plane of the face, clipped by the other planes of B: a face of the sharp shape */
        const fl_vec3 n = b->normal[f], x = v3_unit(fabs(n.x) < 0.7 ? v3(0, n.z, -n.y) : v3(-n.z, 0, n.x)),
                      y = v3_cross(n, x), m = v3_madd(middle, b->c[f] - v3_dot(n, middle), n);
        fl_vec3 v[CORNERS] = {v3_madd(v3_madd(m, size, x), size, y), v3_madd(v3_madd(m, -size, x), size, y),
                              v3_madd(v3_madd(m, -size, x), -size, y),
                              v3_madd(v3_madd(m, size, x), -size, y)};
        const int corners = clip_polygon(b, f, v, 4);
        if (corners > 2) add_polygon(&q, v, clip_polygon(a, -1, v, corners));
    }
    return result_of(&q);
}
