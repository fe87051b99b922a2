/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "water/wave_block.h"
#include <math.h>

/* Places of the numbers in a row. */
enum { AT_Z, AT_SLOPE, AT_FORCE = 3, AT_MOMENT = 6, AT_FLOW = 9, AT_ACCELERATION = 12, AT_WETTED = 15 };

/* Distance from the path, over 1/k95, beyond which a new block begins. */
#define MAX_DEVIATION 0.1
/* Largest rotation within a block [rad]: beyond it the path stops turning. */
#define MAX_TURN 1.0
/* Cosine of the tilt of columns below which pressure is not integrated by its ends, and G is 0. */
#define UPRIGHT 0.5
/* Distance along the waves, over that of the places, up to which the taps of a node serve its whole column:
 * what Taylor's formula leaves is (0.2 / 2)^3 k h of a wave. */
#define NEAR 0.2
/* A column whose ends are at the same distance from the wave is wholly wet or dry. */
#define LEVEL_COLUMN 1e-9

/* --- time ---------------------------------------------------------------------------------------- */

static int64_t floor_level(double x)
{
    const int64_t k = (int64_t)x;
    return (double)k > x ? k - 1 : k;
}

int64_t fl_wave_group(const fl_wave_grid *g, double t)
{
    return FL_WAVE_GROUP * floor_level(t / (FL_WAVE_GROUP * g->step));
}

int64_t fl_wave_block_level(const fl_wave_grid *g, double t, int span)
{
    const int64_t each = 3 * (int64_t)span;
    return each * floor_level(t / ((double)each * g->step));
}

double fl_wave_sample_time(const fl_wave_block *c, const fl_wave_grid *g, int k)
{
    return (double)(c->level + (int64_t)k * c->span) * g->step;
}

/* Weights of the cubic through the four samples; u = 0 .. 3 from the first to the last. Beyond the last the
 * cubic goes on along its tangent. */
static void cubic_weights(const fl_wave_block *c, const fl_wave_grid *g, double t, double w[FL_WAVE_SAMPLES],
                          double *u)
{
    const double x = (t / g->step - (double)c->level) / c->span, a = x - 1.0, b = x - 2.0, d = x - 3.0;
    *u = x;
    if (d > 0.0) {
        *u = 3.0;
        w[0] = -d / 3.0, w[1] = 1.5 * d, w[2] = -3.0 * d, w[3] = 1.0 + 11.0 / 6.0 * d;
        return;
    }
    w[0] = -a * b * d / 6.0, w[1] = 0.5 * x * b * d, w[2] = -0.5 * x * a * d, w[3] = x * a * b / 6.0;
}

/* --- the path ------------------------------------------------------------------------------------ */

static fl_vec3 combine(const double w[FL_WAVE_SAMPLES], const fl_vec3 x[FL_WAVE_SAMPLES])
{
    return v3_add(v3_madd(v3_scale(w[0], x[0]), w[1], x[1]), v3_madd(v3_scale(w[2], x[2]), w[3], x[3]));
}

fl_quat fl_wave_block_attitude(const fl_wave_block *c, fl_vec3 turn)
{
    const double size = v3_norm(turn);
    const fl_vec3 r = size > MAX_TURN ? v3_scale(MAX_TURN / size, turn) : turn;
    const fl_quat p = {sqrt(1.0 - 0.25 * v3_norm2(r)), 0.5 * r.x, 0.5 * r.y, 0.5 * r.z};
    return q_mul(p, c->q);
}

static fl_wave_deviation deviation(const fl_wave_block *c, const double w[FL_WAVE_SAMPLES], fl_vec3 x,
                                   fl_quat q)
{
    const fl_quat p = q_mul(q, q_conj(c->q));
    const double sign = p.w < 0.0 ? -2.0 : 2.0; /* q and -q are one rotation */
    return (fl_wave_deviation){v3_sub(x, combine(w, c->x)),
                               v3_sub(v3_scale(sign, v3(p.x, p.y, p.z)), combine(w, c->turn))};
}

fl_wave_deviation fl_wave_block_deviation(const fl_wave_block *c, const fl_wave_grid *g, double t, fl_vec3 x,
                                          fl_quat q)
{
    double w[FL_WAVE_SAMPLES], u;
    cubic_weights(c, g, t, w, &u);
    return deviation(c, w, x, q);
}

int fl_wave_block_due(const fl_wave_block *c, const fl_wave_water *sea, double reach, double t, fl_vec3 x,
                      fl_quat q)
{
    if (c->level == FL_WAVE_NO_BLOCK || c->level != fl_wave_block_level(sea->grid, t, c->span)) return 1;
    const fl_wave_deviation d = fl_wave_block_deviation(c, sea->grid, t, x, q);
    const double far = MAX_DEVIATION / sea->k95, turned = reach * reach * v3_norm2(d.turn);
    return !(v3_norm2(d.x) <= far * far && turned <= far * far); /* written so that a NaN begins one */
}

/* --- a sample -------------------------------------------------------------------------------------- */

/* The plane under a body: height over its centre, slopes; heights above still water. */
typedef struct {
    double z, x, y;
} water_plane;

typedef struct {
    const fl_wave_water *sea;
    const fl_wave_body *body;
    fl_wave_view view;
    fl_vec3 x; /* centre */
    double z;  /* of the centre, above still water */
    fl_mat3 R;
    water_plane plane;
    int changes; /* 1: G too */
    fl_vec3 force, moment;
    double (*change)[6];
} body_sample;

/* Gradient of p/(rho g) and its parts. */
typedef struct {
    fl_vec3 g; /* of p */
    double p;
    fl_wave_head head;
} point_pressure;

/* Pressure at a point z above still water, zeta and rate by fl_wave_grid_stretch(), under the elevation
 * `over` with the slopes of `at`; out->head is set. */
FL_SIMD_INLINE void set_pressure(const body_sample *b, double z, double over, double zeta, double rate,
                                 const fl_wave_surface *at, point_pressure *out)
{
    const double depth = b->sea->grid->water;
    const double moved = depth < INFINITY ? rate * (1.0 + zeta / (rate * (depth + over))) : 1.0,
                 down = out->head.zeta * moved;
    out->p = out->head.p - z;
    out->g = v3(out->head.x - at->x * down, out->head.y - at->y * down, out->head.zeta * rate - 1.0);
}

FL_SIMD_INLINE void pressure_at(const body_sample *b, double x, double y, double z, double over,
                                const fl_wave_surface *at, point_pressure *out)
{
    double rate;
    const double zeta = fl_wave_grid_stretch(b->sea->grid, z, over, &rate);
    fl_wave_head_at(&b->view, x, y, zeta, &out->head);
    set_pressure(b, z, over, zeta, rate, at, out);
}

/* The same at a distance s along the only line from a node. */
FL_SIMD_INLINE void pressure_near(const body_sample *b, double s, double z, double over,
                                  const fl_wave_taps *taps, const fl_wave_surface *at, point_pressure *out)
{
    double rate;
    const double zeta = fl_wave_grid_stretch(b->sea->grid, z, over, &rate);
    fl_wave_head_near(b->sea->grid, taps, s, zeta, &out->head);
    set_pressure(b, z, over, zeta, rate, at, out);
}

/* Adds the change of the load at offset r with a displacement of that point: dF_i = sum_j K_ij d_j. */
FL_SIMD_INLINE void add_change(body_sample *b, fl_vec3 r, const fl_mat3 *K)
{
    const fl_vec3 shift[FL_WAVE_CHANGES] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -r.z, r.y}, {r.z, 0, -r.x}};
    for (int k = 0; k < FL_WAVE_CHANGES; k++) {
        const fl_vec3 f = m3_mul(*K, shift[k]), m = v3_cross(r, f);
        b->change[k][0] += f.x, b->change[k][1] += f.y, b->change[k][2] += f.z;
        b->change[k][3] += m.x, b->change[k][4] += m.y, b->change[k][5] += m.z;
    }
}

/* Wet part [lo, hi] of a column of length H, whose middle is `above` the water and whose height above it
 * grows by `rate` along it. */
FL_SIMD_INLINE void wet_part(double H, double above, double rate, double *lo, double *hi)
{
    *lo = 0.0, *hi = H;
    if (fabs(rate) < LEVEL_COLUMN) {
        if (above > 0.0) *hi = 0.0;
        return;
    }
    const double cut = 0.5 * H - above / rate, in = cut < 0.0 ? 0.0 : cut > H ? H : cut;
    if (rate > 0.0) *hi = in;
    else *lo = in;
}

/* Mean of max(p, 0) over a part of the vertical half extent d, and of the wet share. */
FL_SIMD_INLINE double positive_part(double p, double d, double *share)
{
    *share = p >= d ? 1.0 : p > -d ? 0.5 * (p + d) / d : 0.0;
    return p >= d ? p : p > -d ? 0.25 * (p + d) * (p + d) / d : 0.0;
}

/* What the mean of max(depth, 0) over the part of the section of a column has more than the value at its
 * middle, where the water line of an end crosses that part. depth: of the middle of the column, growing by
 * `rate` along it; g: gradient of the depth; half: half the width of the part. Upper end counted negative. */
FL_SIMD_INLINE double cut_ends(double H, double depth, double rate, fl_vec3 g, double half)
{
    const double one = depth - 0.5 * H * rate, two = depth + 0.5 * H * rate,
                 least = fabs(one) < fabs(two) ? fabs(one) : fabs(two);
    const double across2 = v3_norm2(g) - rate * rate;
    if (least * least >= half * half * across2 || !(across2 > 0.0)) return 0.0;
    const double d = half * sqrt(across2);
    double share;
    return (positive_part(one, d, &share) - (one > 0.0 ? one : 0.0)) -
           (positive_part(two, d, &share) - (two > 0.0 ? two : 0.0));
}

/* One column: its lower end at offset r, of the unit direction e, weight w. */
FL_SIMD_INLINE void add_column(body_sample *b, fl_vec3 r, fl_vec3 e, double w, double half,
                               const fl_wave_node_sample *node)
{
    const fl_wave_surface *at = &node->at;
    const double H = b->body->nodes->length;
    const fl_vec3 mid = v3_madd(r, 0.5 * H, e);
    const double z = b->z + mid.z, rise = at->x * e.x + at->y * e.y;
    const water_plane *q = &b->plane;
    double lo, hi, low, high;
    wet_part(H, z - at->eta, e.z - rise, &lo, &hi);
    wet_part(H, z - (q->z + q->x * mid.x + q->y * mid.y), e.z - (q->x * e.x + q->y * e.y), &low, &high);
    const fl_wave_grid *g0 = b->sea->grid;
    const double along = g0->line[0].x * e.x + g0->line[0].y * e.y;
    const int near = g0->lines == 1 && 0.5 * H * fabs(along) < NEAR * g0->h;
    const fl_wave_taps *taps = &node->taps;
    fl_wave_taps own = {0};
    if (near && taps->outside) {
        fl_wave_taps_at(&b->view, 0, b->x.x + mid.x, b->x.y + mid.y, &own);
        taps = &own;
    }
    const int wet = hi > lo, still = high > low, upright = fabs(e.z) > UPRIGHT;
    point_pressure end[3];
    fl_vec3 force = v3(0, 0, 0), first = force; /* integrals of -grad p, and of h times it */
    if (wet) {
        const double len = hi - lo;
        for (int k = 0; k < 3; k++) {
            const double h = lo + 0.5 * k * len, off = h - 0.5 * H, part = (k == 1 ? 4.0 : 1.0) * len / 6.0;
            if (near) pressure_near(b, off * along, z + off * e.z, at->eta + off * rise, taps, at, &end[k]);
            else
                pressure_at(b, b->x.x + mid.x + off * e.x, b->x.y + mid.y + off * e.y, z + off * e.z,
                            at->eta + off * rise, at, &end[k]);
            force = v3_madd(force, -part, end[k].g);
            first = v3_madd(first, -part * h, end[k].g);
        }
        if (upright) /* dp/dh = e . grad p */
            force.z = -(end[2].p - end[0].p + e.x * force.x + e.y * force.y) / e.z;
    }
    if (still) {
        const fl_vec3 g = v3(-q->x, -q->y, 1.0);
        force = v3_madd(force, low - high, g);
        first = v3_madd(first, 0.5 * (low * low - high * high), g);
    }
    const fl_vec3 wave = v3(at->x, at->y, -1.0), flat = v3(q->x, q->y, -1.0);
    const double cut = cut_ends(H, at->eta - z, v3_dot(wave, e), wave, half) -
                       cut_ends(H, q->z + q->x * mid.x + q->y * mid.y - z, v3_dot(flat, e), flat, half);
    force = v3_madd(force, cut, e);
    force = v3_scale(w, force), first = v3_scale(w, first);
    b->force = v3_add(b->force, force);
    b->moment = v3_add(b->moment, v3_add(v3_cross(r, force), v3_cross(e, first)));
    if (!b->changes || !upright || !(wet || still)) return;
    const int up = e.z > 0.0, bottom = up ? 0 : 2;
    const int reaches = up ? hi < H : lo > 0.0, still_reaches = up ? high < H : low > 0.0;
    fl_vec3 g = v3(0, 0, 0);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    if (wet) {
        const point_pressure *deep = &end[bottom], *top = &end[2 - bottom];
        g = reaches ? deep->g : v3_sub(deep->g, top->g);
        xx = top->head.xx - deep->head.xx, xy = top->head.xy - deep->head.xy,
        yy = top->head.yy - deep->head.yy;
        if (reaches) xx -= at->x * top->g.x, xy -= at->x * top->g.y, yy -= at->y * top->g.y;
    }
    if (still && still_reaches) {
        g = v3_sub(g, v3(q->x, q->y, -1.0));
        xx += q->x * q->x, xy += q->x * q->y, yy += q->y * q->y;
    }
    const double W = w / fabs(e.z);
    const fl_mat3 K = {{{W * xx, W * xy, W * g.x}, {W * xy, W * yy, W * g.y}, {W * g.x, W * g.y, W * g.z}}};
    add_change(b, v3_madd(r, wet ? (up ? lo : hi) : (up ? low : high), e), &K);
}

FL_SIMD4_VERSIONS static void add_columns(body_sample *b)
{
    const fl_wave_nodes *a = b->body->nodes;
    const fl_vec3 e = m3_mul(b->R, a->along);
    for (int32_t k = 0; k < a->n; k++)
        add_column(b, m3_mul(b->R, a->x[k]), e, a->w[k], a->half[k], &b->body->scratch[k]);
}

FL_SIMD4_VERSIONS static void add_faces(body_sample *b)
{
    const fl_wave_nodes *a = b->body->nodes;
    const water_plane *q = &b->plane;
    const int one = b->sea->grid->lines == 1;
    for (int32_t k = 0; k < a->n; k++) {
        const fl_wave_surface *at = &b->body->scratch[k].at;
        const fl_vec3 r = m3_mul(b->R, a->x[k]), A = m3_mul(b->R, a->area[k]);
        const double z = b->z + r.z, size = v3_norm(A), level2 = A.x * A.x + A.y * A.y,
                     half = size > 0.0 ? 0.5 * sqrt(level2 / size) : 0.0;
        point_pressure here = {.p = at->eta - z, .g = v3(at->x, at->y, -1.0)};
        double wet, still;
        if (here.p > 0.0 && one && !b->body->scratch[k].taps.outside)
            pressure_near(b, 0.0, z, at->eta, &b->body->scratch[k].taps, at, &here);
        else if (here.p > 0.0) pressure_at(b, b->x.x + r.x, b->x.y + r.y, z, at->eta, at, &here);
        const double p = positive_part(here.p, half, &wet) -
                         positive_part(q->z + q->x * r.x + q->y * r.y - z, half, &still);
        const fl_vec3 f = v3_scale(-p, A);
        b->force = v3_add(b->force, f);
        b->moment = v3_add(b->moment, v3_cross(r, f));
        if (!b->changes) continue;
        const fl_vec3 g = v3_madd(v3_scale(wet, here.g), -still, v3(q->x, q->y, -1.0));
        const fl_mat3 K = {{{-A.x * g.x, -A.x * g.y, -A.x * g.z},
                            {-A.y * g.x, -A.y * g.y, -A.y * g.z},
                            {-A.z * g.x, -A.z * g.y, -A.z * g.z}}};
        add_change(b, r, &K);
    }
}

/* Twice what the mean of P over a part of the spread S has more than its middle: each line of propagation
 * adds (S_ss - S_zz) P_ss + 2 S_sz P_sz, as P is harmonic. On taps of one line or anew. */
FL_SIMD_INLINE double spread_head(const body_sample *b, const fl_wave_node_sample *node, fl_vec3 r,
                                  const fl_mat3 *S, double zeta)
{
    const fl_wave_grid *g = b->sea->grid;
    fl_wave_depth deep;
    double sum = 0.0;
    fl_wave_depth_at(g, zeta, &deep);
    for (int32_t c = 0; c < g->lines; c++) {
        const fl_wave_line *d = &g->line[c];
        const double D = d->x * d->x * S->m[0][0] + 2.0 * d->x * d->y * S->m[0][1] +
                         d->y * d->y * S->m[1][1] - S->m[2][2],
                     slant = d->x * S->m[0][2] + d->y * S->m[1][2];
        fl_wave_taps own = {0};
        const fl_wave_taps *p = &node->taps;
        fl_simd value, dz;
        if (g->lines > 1 || p->outside) {
            fl_wave_taps_at(&b->view, c, b->x.x + r.x, b->x.y + r.y, &own);
            p = &own;
        }
        fl_wave_between(p, &deep, 0, &value, &dz);
        sum += D * fl_wave_dot(&value, &p->ddw) + 2.0 * slant * fl_wave_dot(&dz, &p->dw);
    }
    return sum;
}

/* R S R^T of a symmetric tensor. */
FL_SIMD_INLINE fl_mat3 turned(fl_mat3 R, const fl_mat3 *S)
{
    fl_mat3 A, B;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            A.m[i][j] = R.m[i][0] * S->m[0][j] + R.m[i][1] * S->m[1][j] + R.m[i][2] * S->m[2][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            B.m[i][j] = A.m[i][0] * R.m[j][0] + A.m[i][1] * R.m[j][1] + A.m[i][2] * R.m[j][2];
    return B;
}

/* The wet share of a part of a mesh, the way from the middle of the part to that of the share, and its
 * spread. The depth p + g.x is spread evenly over the part. */
typedef struct {
    double share;
    fl_vec3 way;
    fl_mat3 spread;
} wet_share;

FL_SIMD_INLINE wet_share share_under(double p, fl_vec3 g, const fl_mat3 *S)
{
    const fl_vec3 Sg = m3_mul(*S, g);
    const double gSg = v3_dot(g, Sg), d = gSg > 0.0 ? sqrt(3.0 * gSg) : 0.0;
    wet_share w = {.share = 1.0, .way = {0.0, 0.0, 0.0}, .spread = *S};
    if (p >= d) return w;
    w.share = p > -d ? 0.5 * (p + d) / d : 0.0;
    if (!(w.share > 0.0)) return w;
    w.way = v3_scale(0.5 * (d - p) / gSg, Sg);
    const double less = (1.0 - w.share * w.share) / gSg, v[3] = {Sg.x, Sg.y, Sg.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) w.spread.m[i][j] -= less * v[i] * v[j];
    return w;
}

/* What the waves add to the plane on part k of a mesh. */
FL_SIMD_INLINE void add_mesh_part(body_sample *b, int32_t k)
{
    const fl_wave_nodes *a = b->body->nodes;
    const fl_wave_node_sample *node = &b->body->scratch[k];
    const fl_wave_surface *at = &node->at;
    const water_plane *q = &b->plane;
    const fl_vec3 r = m3_mul(b->R, a->x[k]), A = m3_mul(b->R, a->area[k]);
    const fl_mat3 S = turned(b->R, &a->spread[k]);
    const double z = b->z + r.z, flat = q->z + q->x * r.x + q->y * r.y - z;
    const fl_vec3 wave_g = v3(at->x, at->y, -1.0), flat_g = v3(q->x, q->y, -1.0);
    const wet_share wet = share_under(at->eta - z, wave_g, &S), still = share_under(flat, flat_g, &S);
    fl_vec3 arm = v3(0, 0, 0), g = arm; /* int (x - r) p dA / dA, and the change of p */
    double p = 0.0;
    if (wet.share > 0.0) {
        const fl_wave_grid *grid = b->sea->grid;
        const fl_vec3 x = v3_add(r, wet.way);
        const double over = at->eta + at->x * wet.way.x + at->y * wet.way.y,
                     along = grid->line[0].x * wet.way.x + grid->line[0].y * wet.way.y;
        point_pressure here = {0};
        double rate;
        if (grid->lines == 1 && !node->taps.outside && fabs(along) < NEAR * grid->h)
            pressure_near(b, along, z + wet.way.z, over, &node->taps, at, &here);
        else pressure_at(b, b->x.x + x.x, b->x.y + x.y, z + wet.way.z, over, at, &here);
        const double zeta = fl_wave_grid_stretch(grid, z + wet.way.z, over, &rate);
        p = wet.share * (here.p + 0.5 * spread_head(b, node, r, &wet.spread, zeta));
        g = v3_scale(wet.share, here.g);
        arm = v3_madd(v3_scale(p, wet.way), wet.share, m3_mul(wet.spread, here.g));
    }
    if (still.share > 0.0) {
        const double rest = still.share * (flat + v3_dot(flat_g, still.way));
        p -= rest;
        g = v3_madd(g, -still.share, flat_g);
        arm = v3_sub(arm, v3_madd(v3_scale(rest, still.way), still.share, m3_mul(still.spread, flat_g)));
    }
    if (wet.share == 0.0 && still.share == 0.0) return;
    const fl_vec3 f = v3_scale(-p, A);
    b->force = v3_add(b->force, f);
    b->moment = v3_add(b->moment, v3_sub(v3_cross(r, f), v3_cross(arm, A)));
    if (!b->changes) return;
    const fl_mat3 K = {{{-A.x * g.x, -A.x * g.y, -A.x * g.z},
                        {-A.y * g.x, -A.y * g.y, -A.y * g.z},
                        {-A.z * g.x, -A.z * g.y, -A.z * g.z}}};
    add_change(b, r, &K);
}

FL_SIMD4_VERSIONS static void add_mesh_parts(body_sample *b)
{
    for (int32_t k = 0; k < b->body->nodes->n; k++) add_mesh_part(b, k);
}

/* The surface over all nodes. */
FL_SIMD4_VERSIONS static void survey_surface(const body_sample *b)
{
    const fl_wave_nodes *a = b->body->nodes;
    const fl_vec3 up = v3_scale(0.5 * a->length, m3_mul(b->R, a->along));
    for (int32_t k = 0; k < a->n; k++) {
        const fl_vec3 r = v3_add(m3_mul(b->R, a->x[k]), up);
        fl_wave_node_sample *const to = &b->body->scratch[k];
        if (b->sea->grid->lines == 1) {
            to->at = (fl_wave_surface){0};
            fl_wave_taps_at(&b->view, 0, b->x.x + r.x, b->x.y + r.y, &to->taps);
            fl_wave_surface_add(&b->sea->grid->line[0], &to->taps, &to->at);
        } else fl_wave_surface_at(&b->view, b->x.x + r.x, b->x.y + r.y, &to->at);
    }
}

/* Least variance of positions, over the square of the size, for a fitted slope. */
#define LEAST_SPREAD 1e-4

/* Weighted least squares: z + a s along one line of propagation, or z + x r.x + y r.y with several. Where the
 * nodes have no extent the slope is the mean one. */
static void fit_plane(body_sample *b)
{
    const fl_wave_nodes *a = b->body->nodes;
    const fl_wave_line *line = &b->sea->grid->line[0];
    const int one = b->sea->grid->lines == 1;
    const fl_vec3 up = v3_scale(0.5 * a->length, m3_mul(b->R, a->along));
    double all = 0.0, mean[2] = {0}, eta = 0.0, slope[2] = {0}, xx = 0.0, xy = 0.0, yy = 0.0, xe = 0.0,
           ye = 0.0;
    for (int32_t k = 0; k < a->n; k++) {
        const fl_wave_surface *at = &b->body->scratch[k].at;
        const fl_vec3 r = v3_add(m3_mul(b->R, a->x[k]), up);
        const double w = a->w ? a->w[k]
                              : fabs(v3_dot(a->area[k], v3(b->R.m[2][0], b->R.m[2][1], b->R.m[2][2]))),
                     x = one ? line->x * r.x + line->y * r.y : r.x, y = one ? 0.0 : r.y;
        all += w, eta += w * at->eta, slope[0] += w * at->x, slope[1] += w * at->y;
        mean[0] += w * x, mean[1] += w * y;
        xx += w * x * x, xy += w * x * y, yy += w * y * y;
        xe += w * x * at->eta, ye += w * y * at->eta;
    }
    if (!(all > 0.0)) {
        b->plane = (water_plane){0};
        return;
    }
    const double per = 1.0 / all, small = LEAST_SPREAD * b->body->reach * b->body->reach;
    mean[0] *= per, mean[1] *= per, eta *= per;
    xx = per * xx - mean[0] * mean[0], xy = per * xy - mean[0] * mean[1], yy = per * yy - mean[1] * mean[1];
    xe = per * xe - mean[0] * eta, ye = per * ye - mean[1] * eta;
    double x = per * slope[0], y = per * slope[1];
    if (one) {
        const double s = xx > small ? xe / xx : line->x * x + line->y * y;
        x = s * line->x, y = s * line->y;
        b->plane = (water_plane){eta - s * mean[0], x, y};
        return;
    }
    const double det = xx * yy - xy * xy;
    if (det > small * small) {
        x = (yy * xe - xy * ye) / det;
        y = (xx * ye - xy * xe) / det;
    }
    b->plane = (water_plane){eta - x * mean[0] - y * mean[1], x, y};
}

void fl_wave_body_submerged(const fl_wave_body *body, fl_vec3 up, double level, fl_submerged *wet)
{
    const fl_hull *h = body->hull;
    *wet = (fl_submerged){0};
    if (level >= body->reach)
        *wet = (fl_submerged){.volume = h->volume, .centre = h->centre, .wetted_area = h->surface_area};
    else if (level > -body->reach) fl_hull_submerged(h, up, level, wet);
}

/* The wet part of the hull under the plane, body axes. */
static fl_submerged submerge(const body_sample *b)
{
    const double c = 1.0 / sqrt(1.0 + b->plane.x * b->plane.x + b->plane.y * b->plane.y);
    fl_submerged wet;
    fl_wave_body_submerged(b->body, m3_tmul(b->R, v3(-c * b->plane.x, -c * b->plane.y, c)),
                           c * (b->plane.z - b->z), &wet);
    return wet;
}

/* Tangent plane over the centre of a sphere or capsule. */
static void set_tangent(body_sample *b)
{
    fl_wave_surface at;
    fl_wave_surface_at(&b->view, b->x.x, b->x.y, &at);
    b->plane = (water_plane){at.eta, at.x, at.y};
}

/* Load of a sphere or capsule, at the centre r of its wet part: rho V times the acceleration, less the slope
 * of the plane. */
static void add_round(body_sample *b, fl_vec3 r, double volume, double zeta)
{
    fl_wave_depth deep;
    double x = 0.0, y = 0.0, z = 0.0, xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0;
    fl_wave_depth_at(b->sea->grid, zeta, &deep);
    for (int32_t c = 0; c < b->sea->grid->lines; c++) {
        const fl_wave_line *d = &b->sea->grid->line[c];
        fl_wave_taps p = {0};
        fl_simd value, dz;
        fl_wave_taps_at(&b->view, c, b->x.x + r.x, b->x.y + r.y, &p);
        fl_wave_between(&p, &deep, 0, &value, &dz);
        const double s = fl_wave_dot(&value, &p.dw), ss = fl_wave_dot(&value, &p.ddw),
                     sz = fl_wave_dot(&dz, &p.dw);
        x += d->x * s, y += d->y * s, z += fl_wave_dot(&dz, &p.w);
        xx += d->x * d->x * ss, xy += d->x * d->y * ss, yy += d->y * d->y * ss;
        xz += d->x * sz, yz += d->y * sz;
    }
    const double V = volume;
    b->force = v3(V * (b->plane.x - x), V * (b->plane.y - y), -V * z);
    b->moment = v3_cross(r, b->force);
    if (!b->changes) return;
    /* P is harmonic: its second derivative along z is -(xx + yy) */
    const fl_mat3 K = {
        {{-V * xx, -V * xy, -V * xz}, {-V * xy, -V * yy, -V * yz}, {-V * xz, -V * yz, V * (xx + yy)}}};
    add_change(b, r, &K);
}

/* Velocity and acceleration of the water at the centre of the wet part, and the current there. */
static void survey_flow(const body_sample *b, fl_vec3 r, double zeta, double *row)
{
    const fl_vec3 u = v3_add(fl_wave_velocity(&b->view, b->x.x + r.x, b->x.y + r.y, zeta),
                             fl_current_at(b->sea->current, b->z + r.z));
    fl_wave_head head;
    fl_wave_head_at(&b->view, b->x.x + r.x, b->x.y + r.y, zeta, &head);
    const double g = b->sea->grid->gravity;
    row[AT_FLOW] = u.x, row[AT_FLOW + 1] = u.y, row[AT_FLOW + 2] = u.z;
    row[AT_ACCELERATION] = -g * head.x, row[AT_ACCELERATION + 1] = -g * head.y,
    row[AT_ACCELERATION + 2] = -g * head.zeta;
}

/* Adds the buoyancy of a mesh on the plane, and the change of the whole load with the pose: the nodes have
 * left out that area vectors turn with the body. Returns the wetted area. */
static double add_mesh(body_sample *b)
{
    const fl_mat3 R = b->R;
    const fl_vec3 G = m3_tmul(R, v3(-b->plane.x, -b->plane.y, 1.0));
    const double c = b->plane.z - b->z;
    fl_wet_sums wet;
    fl_vec3 f, t;
    fl_wet_mesh_sums(b->body->mesh, G, c, &wet);
    fl_wet_sums_load(&wet, G, c, &f, &t);
    b->force = v3_add(b->force, m3_mul(R, f));
    b->moment = v3_add(b->moment, m3_mul(R, t));
    for (int k = 0; k < FL_WAVE_CHANGES && b->changes; k++) {
        const fl_vec3 e = v3(k % 3 == 0, k % 3 == 1, k % 3 == 2), own = m3_tmul(R, e);
        if (k < 3) { /* the head at a point of the body falls by G.e */
            fl_wet_sums_load(&wet, v3(0, 0, 0), -v3_dot(G, own), &f, &t);
        } else { /* and by G.(e x x) = (G x e).x */
            fl_wet_sums_load(&wet, v3_cross(G, own), 0.0, &f, &t);
        }
        f = m3_mul(R, f), t = m3_mul(R, t);
        if (k >= 3) f = v3_add(f, v3_cross(e, b->force)), t = v3_add(t, v3_cross(e, b->moment));
        b->change[k][0] += f.x, b->change[k][1] += f.y, b->change[k][2] += f.z;
        b->change[k][3] += t.x, b->change[k][4] += t.y, b->change[k][5] += t.z;
    }
    return wet.wetted;
}

/* Stretched height of the point of the body in which the flow is taken, at offset r. */
static double stretched_height(const body_sample *b, fl_vec3 r)
{
    fl_wave_surface at;
    double rate;
    fl_wave_surface_at(&b->view, b->x.x + r.x, b->x.y + r.y, &at);
    return fl_wave_grid_stretch(b->sea->grid, b->z + r.z, at.eta, &rate);
}

static void store_load(const body_sample *b, double *row)
{
    const double weight = b->sea->weight;
    row[AT_FORCE] = weight * b->force.x, row[AT_FORCE + 1] = weight * b->force.y;
    row[AT_FORCE + 2] = weight * b->force.z;
    row[AT_MOMENT] = weight * b->moment.x, row[AT_MOMENT + 1] = weight * b->moment.y;
    row[AT_MOMENT + 2] = weight * b->moment.z;
}

/* A row of a mesh. */
static void evaluate_mesh_sample(body_sample *b, double *row)
{
    const fl_vec3 r = m3_mul(b->R, b->body->wet_centre);
    survey_surface(b);
    fit_plane(b);
    add_mesh_parts(b);
    row[AT_Z] = b->plane.z, row[AT_SLOPE] = b->plane.x, row[AT_SLOPE + 1] = b->plane.y;
    row[AT_WETTED] = add_mesh(b);
    survey_flow(b, r, stretched_height(b, r), row);
    store_load(b, row);
}

/* Fills a row of samples. */
static void evaluate_sample(body_sample *b, double *row)
{
    const fl_wave_nodes *a = b->body->nodes;
    for (int k = 0; k < FL_WAVE_ROW; k++) row[k] = 0.0;
    if (b->z - b->body->reach >= b->sea->max_crest) { /* out of the water */
        const fl_vec3 u = fl_current_at(b->sea->current, b->z);
        row[AT_FLOW] = u.x, row[AT_FLOW + 1] = u.y, row[AT_FLOW + 2] = u.z;
        return;
    }
    b->force = b->moment = v3(0, 0, 0);
    if (a->kind == FL_WAVE_MESH) {
        evaluate_mesh_sample(b, row);
        return;
    }
    if (a->kind == FL_WAVE_ROUND) {
        set_tangent(b);
    } else {
        survey_surface(b);
        fit_plane(b);
    }
    row[AT_Z] = b->plane.z, row[AT_SLOPE] = b->plane.x, row[AT_SLOPE + 1] = b->plane.y;
    const fl_submerged wet = submerge(b);
    const fl_vec3 r = m3_mul(b->R, wet.centre);
    const double zeta = stretched_height(b, r);
    survey_flow(b, r, zeta, row);
    if (a->kind == FL_WAVE_ROUND) add_round(b, r, wet.volume, zeta);
    else if (a->kind == FL_WAVE_COLUMNS) add_columns(b);
    else add_faces(b);
    store_load(b, row);
}

void fl_wave_block_fill(fl_wave_block *c, const fl_wave_water *sea, const fl_wave_body *body)
{
    for (int e = 0; e < 2; e++)
        for (int k = 0; k < FL_WAVE_CHANGES; k++)
            for (int i = 0; i < 6; i++) c->change[e][k][i] = 0.0;
    for (int k = 0; k < FL_WAVE_SAMPLES; k++) {
        const int64_t level = c->level + (int64_t)k * c->span;
        body_sample b = {.sea = sea,
                         .body = body,
                         .view = fl_wave_grid_view(sea->grid, level),
                         .x = c->x[k],
                         .R = q_matrix(fl_wave_block_attitude(c, c->turn[k])),
                         .changes = k == 0 || k == FL_WAVE_SAMPLES - 1,
                         .change = c->change[k > 0]};
        b.z = b.x.z - sea->level;
        evaluate_sample(&b, c->sample[k]);
    }
    for (int e = 0; e < 2; e++)
        for (int k = 0; k < FL_WAVE_CHANGES; k++)
            for (int i = 0; i < 6; i++) c->change[e][k][i] *= sea->weight;
}

/* --- between the samples --------------------------------------------------------------------------- */

void fl_wave_block_values(const fl_wave_block *c, const fl_wave_grid *g, double t, fl_vec3 x, fl_quat q,
                          fl_wave_values *out)
{
    double w[FL_WAVE_SAMPLES], u, row[FL_WAVE_ROW], load[6];
    cubic_weights(c, g, t, w, &u);
    for (int k = 0; k < FL_WAVE_ROW; k++)
        row[k] = (w[0] * c->sample[0][k] + w[1] * c->sample[1][k]) +
                 (w[2] * c->sample[2][k] + w[3] * c->sample[3][k]);
    const fl_wave_deviation d = deviation(c, w, x, q);
    const double off[FL_WAVE_CHANGES] = {d.x.x, d.x.y, d.x.z, d.turn.x, d.turn.y}, late = u / 3.0;
    for (int i = 0; i < 6; i++) load[i] = row[AT_FORCE + i];
    for (int k = 0; k < FL_WAVE_CHANGES; k++)
        for (int i = 0; i < 6; i++)
            load[i] += off[k] * (c->change[0][k][i] + late * (c->change[1][k][i] - c->change[0][k][i]));
    out->slope[0] = row[AT_SLOPE], out->slope[1] = row[AT_SLOPE + 1];
    out->z = row[AT_Z] + out->slope[0] * d.x.x + out->slope[1] * d.x.y;
    out->f = v3(load[0], load[1], load[2]), out->t = v3(load[3], load[4], load[5]);
    out->flow = v3(row[AT_FLOW], row[AT_FLOW + 1], row[AT_FLOW + 2]);
    out->acceleration = v3(row[AT_ACCELERATION], row[AT_ACCELERATION + 1], row[AT_ACCELERATION + 2]);
    out->wetted = row[AT_WETTED] > 0.0 ? row[AT_WETTED] : 0.0;
}

void fl_wave_block_flow(const fl_wave_block *c, const fl_wave_grid *g, double t, fl_wave_flow *out)
{
    double u;
    cubic_weights(c, g, t, out->weight, &u);
    for (int k = 0; k < FL_WAVE_SAMPLES; k++)
        out->view[k] = fl_wave_grid_view(g, c->level + (int64_t)k * c->span);
}

/* The four levels are combined before the sums over the places, which they share. */
FL_SIMD4_VERSIONS fl_vec3 fl_wave_flow_velocity(const fl_wave_flow *f, double x, double y, double z,
                                                double eta)
{
    const fl_wave_grid *g = f->view[0].grid;
    fl_vec3 u = v3(0, 0, 0);
    fl_wave_depth deep;
    double rate;
    fl_wave_depth_at(g, fl_wave_grid_stretch(g, z, eta, &rate), &deep);
    for (int32_t c = 0; c < g->lines; c++) {
        const fl_wave_line *d = &g->line[c];
        fl_simd value = {0.0, 0.0, 0.0, 0.0}, dz = value, one, slope;
        fl_wave_taps p = {0};
        for (int k = 0; k < FL_WAVE_SAMPLES; k++) {
            const double *first = p.at;
            if (k > 0 && f->view[k].slot >= 0 && !p.outside)
                p.at = d->table[f->view[k].slot] + (first - d->table[f->view[k - 1].slot]);
            else fl_wave_taps_at(&f->view[k], c, x, y, &p);
            fl_wave_between(&p, &deep, 2, &one, &slope);
            value += f->weight[k] * one, dz += f->weight[k] * slope;
        }
        const double along = fl_wave_dot(&value, &p.dw);
        u = v3_add(u, v3(d->x * along, d->y * along, fl_wave_dot(&dz, &p.w)));
    }
    return u;
}
