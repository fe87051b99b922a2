/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "water/drag.h"
#include "water/facet_cut.h"

static int32_t corners_of(const fl_poly *p, int32_t f) { return p->first[f + 1] - p->first[f]; }

#define AXIS_TOL 1e-12 /* of a radian, as PRISM_TOL: the rounding of a normal */

/* The body axis that is +-e, or -1. */
static int32_t body_axis_of(fl_vec3 e)
{
    const double a[3] = {fabs(e.x), fabs(e.y), fabs(e.z)};
    for (int32_t k = 0; k < 3; k++)
        if (fmax(a[(k + 1) % 3], a[(k + 2) % 3]) <= AXIS_TOL) return k;
    return -1;
}

/* Unit vector of body axis k, modulo 3. */
static fl_vec3 unit_axis(int32_t k) { return v3(k % 3 == 0, k % 3 == 1, k % 3 == 2); }

/* If the faces of p are the sides and caps of a prism, gives them the axes of facet_cut.h. */
static void set_prism_axes(fl_facets *k, const fl_poly *p, const fl_prism *q)
{
    const int32_t axis = q->area > 0.0 ? body_axis_of(q->e) : -1;
    const fl_vec3 g = unit_axis(axis + 3);
    int32_t caps[2] = {-1, -1};
    if (axis < 0) return;
    for (int32_t f = 0; f < p->nf; f++) {
        const double up = v3_dot(g, p->n[f]);
        if (fabs(up) < 0.5) {
            if (corners_of(p, f) != 4) return;
        } else {
            if (caps[up > 0.0] >= 0) return; /* the cap has two faces */
            caps[up > 0.0] = f;
        }
    }
    k->cap_axis = axis;
    k->bottom = caps[0], k->top = caps[1];
    k->y0 = -p->c[k->bottom], k->y1 = p->c[k->top];
    for (int32_t f = 0; f < p->nf; f++) {
        const int cap = f == k->bottom || f == k->top;
        k->axis[2 * f] = cap ? unit_axis(axis + 1) : v3_unit(v3_cross(g, p->n[f]));
        k->axis[2 * f + 1] = !cap ? g : f == k->top ? unit_axis(axis + 2) : v3_neg(unit_axis(axis + 2));
    }
}

int fl_facets_make(fl_facets *k, const fl_hull *h, fl_err *err)
{
    const fl_poly *p = h->shape;
    *k = (fl_facets){.max_radius = fl_drag_radius(p, 0.0), .top = -1, .bottom = -1, .cap_axis = -1};
    k->axis = fl_alloc(2 * (int64_t)p->nf, sizeof *k->axis, err);
    if (!k->axis) return -1;
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t *at = p->loop + p->first[f];
        k->axis[2 * f] = v3_unit(v3_sub(p->v[at[1]], p->v[at[0]]));
        k->axis[2 * f + 1] = v3_cross(p->n[f], k->axis[2 * f]);
        if (corners_of(p, f) > corners_of(p, k->most_corners)) k->most_corners = f;
    }
    set_prism_axes(k, p, &h->prism);
    return 0;
}

void fl_facets_free(fl_facets *k)
{
    free(k->axis);
    *k = (fl_facets){0};
}

/* A cut leaves at most m + 1 of m corners, or m + m/2 where rounding submerges every other corner of a level
 * face; each corner has two pieces. The groups, at most all sides of a prism and a cap, need no more pieces
 * than as many of the faces with the most corners. Of numbers m_f the G largest add up to
 *     sum_{k > 0} min(G, number of m_f >= k). */
static int32_t max_pieces_of(const fl_poly *p, int32_t fours)
{
    int32_t sum = 0, many = 1;
    for (int32_t k = 1; many; k++) {
        many = 0;
        for (int32_t f = 0; f < p->nf && many < fours; f++) many += corners_of(p, f) >= k;
        sum += many;
    }
    return 3 * sum;
}

int fl_facet_cut_make(fl_facet_cut *s, const fl_hull *h, int dry, int flows, fl_err *err)
{
    *s = (fl_facet_cut){.dry = dry, .cap_axis = -1, .max_groups = (h->shape->nf + 1) / FL_SIMD_WIDTH + 1};
    s->max_pieces = max_pieces_of(h->shape, s->max_groups);
    s->group = fl_alloc(s->max_groups, sizeof *s->group, err);
    s->piece = fl_alloc(s->max_pieces, sizeof *s->piece, err);
    if (!s->group || !s->piece) return -1;
    if (flows) s->flow = fl_alloc(s->max_pieces, sizeof *s->flow, err);
    return flows && !s->flow ? -1 : 0;
}

void fl_facet_cut_free(fl_facet_cut *s)
{
    free(s->group), free(s->piece), free(s->flow);
    *s = (fl_facet_cut){0};
}

double fl_facets_bytes(const fl_facets *k, const fl_hull *h)
{
    return k->axis ? 2.0 * h->shape->nf * (double)sizeof *k->axis : 0.0;
}

double fl_facet_cut_bytes(const fl_facet_cut *s)
{
    const double rows = s->max_pieces;
    return s->max_groups * (double)sizeof *s->group + rows * (double)sizeof *s->piece +
           (s->flow ? rows * (double)sizeof *s->flow : 0.0);
}

/* --- facet by facet ---------------------------------------------------------------------------- */

/* Points below (sign 1) or above (-1) the plane up.x = level. */
typedef struct {
    fl_vec3 up;
    double level, sign;
} half_space;

/* A cut under construction: the open group, its pieces, the lanes in use and the pieces of each. */
typedef struct {
    fl_facet_cut *s;
    fl_facet_group *four;
    fl_facet_piece *row;
    int32_t lanes, pieces[FL_SIMD_WIDTH];
} cut_builder;

static void set_frame(fl_facet_group *to, int32_t l, fl_vec3 n, fl_vec3 e, fl_vec3 g, double c)
{
    to->n[0][l] = n.x, to->n[1][l] = n.y, to->n[2][l] = n.z;
    to->e[0][l] = e.x, to->e[1][l] = e.y, to->e[2][l] = e.z;
    to->g[0][l] = g.x, to->g[1][l] = g.y, to->g[2][l] = g.z;
    to->c[l] = c;
    to->x0[l] = to->x1[l] = 0.0;
}

/* Zeroes unused lanes and pieces, and closes the group. */
static void close_group(cut_builder *to)
{
    const fl_vec3 no = v3(0, 0, 0);
    int32_t rows = 0;
    if (to->lanes == 0) return;
    for (int32_t l = to->lanes; l < FL_SIMD_WIDTH; l++)
        set_frame(to->four, l, no, no, no, 0.0), to->pieces[l] = 0;
    for (int32_t l = 0; l < FL_SIMD_WIDTH; l++) rows = to->pieces[l] > rows ? to->pieces[l] : rows;
    for (int32_t l = 0; l < FL_SIMD_WIDTH; l++)
        for (int32_t k = to->pieces[l]; k < rows; k++)
            to->row[k].area[l] = to->row[k].x[l] = to->row[k].y[l] = 0.0;
    to->four->pieces = rows;
    to->four++;
    to->row += rows;
    to->lanes = 0;
    to->s->groups++;
}

/* Clips face f: writes its corners x, y to every other piece and returns their number. */
static int32_t clip_outline(const fl_poly *p, int32_t f, fl_vec3 e, fl_vec3 g, const half_space *part,
                            fl_facet_piece *row, int32_t l)
{
    const int32_t *at = p->loop + p->first[f], m = corners_of(p, f);
    fl_vec3 v = p->v[at[m - 1]];
    double s0 = part->sign * (v3_dot(part->up, v) - part->level), x0 = v3_dot(e, v), y0 = v3_dot(g, v);
    int32_t n = 0;
    for (int32_t k = 0; k < m; k++) {
        v = p->v[at[k]];
        const double s1 = part->sign * (v3_dot(part->up, v) - part->level), x1 = v3_dot(e, v),
                     y1 = v3_dot(g, v);
        if ((s0 <= 0.0) != (s1 <= 0.0)) {
            const double t = s0 / (s0 - s1);
            row[2 * n].x[l] = x0 + t * (x1 - x0), row[2 * n].y[l] = y0 + t * (y1 - y0);
            n++;
        }
        if (s1 <= 0.0) {
            row[2 * n].x[l] = x1, row[2 * n].y[l] = y1;
            n++;
        }
        s0 = s1, x0 = x1, y0 = y1;
    }
    return n;
}

/* Turns n corners into the pieces of the fan about their centroid; returns the number of pieces. */
static int32_t fan_pieces(fl_facet_piece *row, int32_t l, int32_t n)
{
    const double ox = row[0].x[l], oy = row[0].y[l];
    double twice = 0.0, mx = 0.0, my = 0.0;
    for (int32_t k = 1; k + 1 < n; k++) {
        const double ax = row[2 * k].x[l] - ox, ay = row[2 * k].y[l] - oy, bx = row[2 * k + 2].x[l] - ox,
                     by = row[2 * k + 2].y[l] - oy, w = ax * by - bx * ay;
        twice += w;
        mx += w * (ax + bx);
        my += w * (ay + by);
    }
    if (!(twice > 0.0)) return 0;
    const double hx = ox + mx / (3.0 * twice), hy = oy + my / (3.0 * twice);
    const double first_x = ox - hx, first_y = oy - hy;
    double ax = first_x, ay = first_y, last = 0.0;
    for (int32_t k = 0; k < n; k++) {
        fl_facet_piece *spoke = &row[2 * k], *rim = spoke + 1;
        const int closing = k + 1 == n;
        const double bx = closing ? first_x : rim[1].x[l] - hx, by = closing ? first_y : rim[1].y[l] - hy;
        const double w = ax * by - bx * ay, third = w > 0.0 ? w / 6.0 : 0.0;
        spoke->area[l] = last + third, spoke->x[l] = hx + 0.5 * ax, spoke->y[l] = hy + 0.5 * ay;
        rim->area[l] = third, rim->x[l] = hx + 0.5 * (ax + bx), rim->y[l] = hy + 0.5 * (ay + by);
        ax = bx, ay = by, last = third;
    }
    row[0].area[l] += last;
    return 2 * n;
}

/* Adds the clipped face f in the next lane. */
static void add_face(cut_builder *to, const fl_facets *k, const fl_poly *p, int32_t f, const half_space *part)
{
    const fl_vec3 e = k->axis[2 * f], g = k->axis[2 * f + 1];
    if (to->lanes == FL_SIMD_WIDTH) close_group(to);
    const int32_t l = to->lanes, corners = clip_outline(p, f, e, g, part, to->row, l);
    to->pieces[l] = corners > 2 ? fan_pieces(to->row, l, corners) : 0;
    if (to->pieces[l] == 0) return;
    set_frame(to->four, l, p->n[f], e, g, p->c[f]);
    to->lanes++;
}

/* Adds the clipped face f over all lanes that are left. */
static void spread_face(cut_builder *to, const fl_facets *k, const fl_poly *p, int32_t f,
                        const half_space *part)
{
    const int32_t l = to->lanes % FL_SIMD_WIDTH, parts = FL_SIMD_WIDTH - l;
    add_face(to, k, p, f, part);
    if (to->lanes <= l) return;
    const int32_t all = to->pieces[l], each = (all + parts - 1) / parts;
    for (int32_t j = each; j < all; j++) {
        const int32_t lane = l + j / each;
        fl_facet_piece *row = &to->row[j % each];
        row->area[lane] = to->row[j].area[l];
        row->x[lane] = to->row[j].x[l], row->y[lane] = to->row[j].y[l];
    }
    for (int32_t j = 0; j < parts; j++) {
        const int32_t left = all - j * each;
        to->pieces[l + j] = left < 0 ? 0 : left < each ? left : each;
        set_frame(to->four, l + j, p->n[f], k->axis[2 * f], k->axis[2 * f + 1], p->c[f]);
    }
    to->lanes = FL_SIMD_WIDTH;
}

static cut_builder begin_cut(fl_facet_cut *s, enum fl_facet_cut_state state)
{
    s->state = state;
    s->cap_axis = -1;
    s->groups = 0;
    return (cut_builder){.s = s, .four = s->group, .row = s->piece};
}

static void cut_faces(fl_facet_cut *s, const fl_facets *k, const fl_poly *p, enum fl_facet_cut_state state,
                      half_space part)
{
    cut_builder to = begin_cut(s, state);
    for (int32_t f = 0; f < p->nf; f++)
        if (f != k->most_corners) add_face(&to, k, p, f, &part);
    spread_face(&to, k, p, k->most_corners, &part);
    close_group(&to);
}

/* --- prisms ------------------------------------------------------------------------------------ */

enum { SIDE = 8 }; /* pieces of a side, which has four corners */

FL_SIMD_INLINE void store_piece(fl_facet_piece *row, const fl_simd *area, const fl_simd *x, const fl_simd *y)
{
    FL_SIMD_STORE(row->area) = *area;
    FL_SIMD_STORE(row->x) = *x;
    FL_SIMD_STORE(row->y) = *y;
}

/* Four sides: their trapezoids from the cap at y0 on, in the direction of sign. Returns 0 if a long edge
 * (`length`) does not cross the water plane. Zero lanes lie at the origin and have neither width nor area. */
FL_SIMD_INLINE int cut_sides(const fl_facet_group *f, fl_facet_piece *row, fl_vec3 up, double level,
                             double per, double y0, double sign, double length)
{
    const fl_simd un = up.x * FL_SIMD_LOAD(f->n[0]) + up.y * FL_SIMD_LOAD(f->n[1]) +
                       up.z * FL_SIMD_LOAD(f->n[2]),
                  ue = up.x * FL_SIMD_LOAD(f->e[0]) + up.y * FL_SIMD_LOAD(f->e[1]) +
                       up.z * FL_SIMD_LOAD(f->e[2]);
    const fl_simd x0 = FL_SIMD_LOAD(f->x0), x1 = FL_SIMD_LOAD(f->x1), L = x1 - x0, slope = per * ue;
    const fl_simd l = per * (level - FL_SIMD_LOAD(f->c) * un) - y0, a = l - slope * x0, b = l - slope * x1;
    const fl_simd la = sign * a, lb = sign * b;
    const fl_simd_mask in = (la > 0.0) & (la < length) & (lb > 0.0) & (lb < length), off = ~in;
    if (fl_simd_any(&off)) return 0;
    const fl_simd ab = a + b, third = 1.0 / (3.0 * ab);
    const fl_simd x = L * (ab + b) * third, y = (a * ab + b * b) * third, rest = L - x;
    /* the centroid, and the water line relative to it */
    const fl_simd hx = x0 + x, hy = y0 + y, da = a - y, db = b - y;
    const double sixth = sign / 6.0;
    const fl_simd low = sixth * (L * y), right = sixth * (b * rest), left = sixth * (a * x),
                  high = sixth * (rest * da + x * db);
    const fl_simd w0 = left + low, w1 = low + right, w2 = right + high, w3 = high + left;
    const fl_simd xl = x0 + 0.5 * x, xr = hx + 0.5 * rest, xm = 0.5 * (x0 + x1);
    const fl_simd yl = y0 + 0.5 * y, ya = hy + 0.5 * da, yb = hy + 0.5 * db, yz = {y0, y0, y0, y0};
    const fl_simd ra = y0 + 0.5 * a, rb = y0 + 0.5 * b, rm = y0 + 0.5 * ab;
    store_piece(&row[0], &w0, &xl, &yl), store_piece(&row[1], &low, &xm, &yz);
    store_piece(&row[2], &w1, &xr, &yl), store_piece(&row[3], &right, &x1, &rb);
    store_piece(&row[4], &w2, &xr, &yb), store_piece(&row[5], &high, &xm, &rm);
    store_piece(&row[6], &w3, &xl, &ya), store_piece(&row[7], &left, &x0, &ra);
    return 1;
}

FL_SIMD4_VERSIONS static int cut_all_sides(fl_facet_cut *s, fl_vec3 up, double level, double per, double y0,
                                           double sign, double length)
{
    for (int32_t k = 0; k + 1 < s->groups; k++)
        if (!cut_sides(&s->group[k], &s->piece[SIDE * k], up, level, per, y0, sign, length)) return 0;
    return 1;
}

/* Lays out the sides one after another, then the cap; cut_all_sides() computes the pieces of the sides. */
static void lay_out_prism(fl_facet_cut *s, const fl_facets *k, const fl_poly *p,
                          enum fl_facet_cut_state state, int32_t cap)
{
    const half_space all = {.up = p->n[cap], .level = INFINITY, .sign = 1.0};
    cut_builder to = begin_cut(s, state);
    for (int32_t f = 0; f < p->nf; f++) {
        const fl_vec3 e = k->axis[2 * f];
        if (f == k->top || f == k->bottom) continue;
        add_face(&to, k, p, f, &all);
        double lo = INFINITY, hi = -INFINITY;
        for (int32_t c = p->first[f]; c < p->first[f + 1]; c++) {
            lo = fmin(lo, v3_dot(e, p->v[p->loop[c]]));
            hi = fmax(hi, v3_dot(e, p->v[p->loop[c]]));
        }
        to.four->x0[to.lanes - 1] = lo, to.four->x1[to.lanes - 1] = hi;
    }
    close_group(&to);
    spread_face(&to, k, p, cap, &all);
    close_group(&to);
    s->cap_axis = k->cap_axis;
}

/* Returns 0 if a long edge does not cross the water plane. */
static int cut_prism(fl_facet_cut *s, const fl_facets *k, const fl_poly *p, fl_vec3 up, double level)
{
    const double ue = k->cap_axis == 0 ? up.x : k->cap_axis == 1 ? up.y : up.z;
    if (k->cap_axis < 0 || !(fabs(ue) > FL_PRISM_MIN_UPRIGHT)) return 0;
    const int top = (ue > 0.0) == s->dry;
    const enum fl_facet_cut_state state = top ? FL_FACET_CUT_TOP : FL_FACET_CUT_BOTTOM;
    if (s->state != state) lay_out_prism(s, k, p, state, top ? k->top : k->bottom);
    return cut_all_sides(s, up, level, 1.0 / ue, top ? k->y1 : k->y0, top ? -1.0 : 1.0, k->y1 - k->y0);
}

void fl_facet_cut_update(fl_facet_cut *s, const fl_facets *k, const fl_hull *h, fl_vec3 up, double level)
{
    const double sign = s->dry ? -1.0 : 1.0;
    if (!(fabs(level) < k->max_radius)) {
        const enum fl_facet_cut_state state = sign * level > 0.0 ? FL_FACET_CUT_WHOLE : FL_FACET_CUT_NONE;
        if (s->state == state) return;
        if (state == FL_FACET_CUT_NONE) begin_cut(s, state);
        else cut_faces(s, k, h->shape, state, (half_space){up, sign * INFINITY, sign});
    } else if (!cut_prism(s, k, h->shape, up, level)) {
        cut_faces(s, k, h->shape, FL_FACET_CUT_GENERAL, (half_space){up, level, sign});
    }
}
