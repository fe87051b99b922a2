/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/overlap_energy.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "law/normal.h"
#include "narrow/closest_point.h"

/* Bodies of a block of sums. */
enum { BLOCK = 128 };

/* Bodies with edges chatter about their rest: forces do not balance to the last digit.  They count as
 * balanced where the least energy has not fallen below STALLED of that STALL steps ago. */
enum { STALL = 1000 };
static const double STALLED = 0.95;

/* Thickness of the skin over the smallest body, and growth of the scale that a list allows for. */
static const double SKIN = 0.6, GROWTH = 1.03;

/* Radius of gyration over the bounding radius; way of a step over the radius; neighbours of a body of mass
 * 1. */
static const double ARM = 0.6, LONGEST = 0.2, CROWD = 16.0;

/* Step and damping of shapes that are no spheres. */
static const double SHAPE_STEP = 0.2, VISCOUS = 0.15;

/* Stiffness of a corner of a polyhedron over that of a sphere: a face has four or more. */
static const double CORNER = 0.25;

/* Largest step of FIRE for contacts of stiffness 1 and bodies of mass 1: below 2/omega of the stiffest mode,
 * of a body between 2 D contacts on either side.  Rotation of shapes stiffens it. */
static double fire_step(const fl_packing *p) { return p->q ? 0.25 : p->dim == 2 ? 0.5 : 0.4; }

static const fl_pack_shape *shape_of(const fl_packing *p, int32_t i)
{
    return &p->shapes->shape[p->shape ? p->shape[i] : 0];
}

/* --- memory ------------------------------------------------------------------------------------- */

static int make_shape_arrays(fl_overlaps *o, fl_err *err)
{
    const fl_packing *p = o->p;
    int64_t corners = 0, normals = 0;
    o->torque = fl_alloc(p->n, sizeof *o->torque, err);
    o->spin = fl_alloc(p->n, sizeof *o->spin, err);
    o->corner_first = fl_alloc((int64_t)p->n + 1, sizeof *o->corner_first, err);
    o->normal_first = fl_alloc((int64_t)p->n + 1, sizeof *o->normal_first, err);
    if (err->code) return -1;
    for (int32_t i = 0; i < p->n; i++) {
        o->corner_first[i] = (int32_t)corners, o->normal_first[i] = (int32_t)normals;
        corners += shape_of(p, i)->core.nv, normals += shape_of(p, i)->core.nf;
        if (corners > INT32_MAX || normals > INT32_MAX)
            return fl_fail(err, FL_SYSTEM, "out of memory: corners");
    }
    o->corner_first[p->n] = (int32_t)corners, o->normal_first[p->n] = (int32_t)normals;
    o->corner = fl_alloc(corners, sizeof *o->corner, err);
    o->normal = fl_alloc(normals, sizeof *o->normal, err);
    return err->code ? -1 : 0;
}

int fl_overlaps_make(fl_overlaps *o, fl_packing *p, const fl_pack_region *region, fl_err *err)
{
    *o = (fl_overlaps){.p = p, .region = region, .blocks = (p->n + BLOCK - 1) / BLOCK, .stale = 1};
    o->box = fl_alloc(p->n, sizeof *o->box, err);
    o->first = fl_alloc((int64_t)p->n + 2, sizeof *o->first, err);
    o->at_wall = fl_alloc(p->n, sizeof *o->at_wall, err);
    o->listed_at = fl_alloc(p->n, sizeof *o->listed_at, err);
    o->mass = fl_alloc(p->n, sizeof *o->mass, err);
    o->ball = fl_alloc(p->n, sizeof *o->ball, err);
    o->force = fl_alloc(p->n, sizeof *o->force, err);
    o->v = fl_alloc(p->n, sizeof *o->v, err);
    o->wall_force = fl_alloc(region->walls, sizeof *o->wall_force, err);
    o->block_wall = fl_alloc((int64_t)o->blocks * region->walls, sizeof *o->block_wall, err);
    o->block = fl_alloc(o->blocks, sizeof *o->block, err);
    if (err->code || (p->q && make_shape_arrays(o, err))) {
        fl_overlaps_free(o);
        return -1;
    }
    for (int k = 0; k < region->dim; k++) {
        const double length = v3_at(v3_sub(region->hi, region->lo), k);
        if (!region->periodic[k]) continue;
        if (k == 0) o->candidates.period.x = length;
        if (k == 1) o->candidates.period.y = length;
        if (k == 2) o->candidates.period.z = length;
    }
    const fl_vec3 t = o->candidates.period;
    o->period = t;
    o->half_period = v3(t.x > 0.0 ? 0.5 * t.x : INFINITY, t.y > 0.0 ? 0.5 * t.y : INFINITY,
                        t.z > 0.0 ? 0.5 * t.z : INFINITY);
    o->skin = SKIN * fl_packing_least(p);
    o->fire = fl_fire_start(fire_step(p));
    return 0;
}

void fl_overlaps_free(fl_overlaps *o)
{
    free(o->box), free(o->first), free(o->near), free(o->near_pair), free(o->at_wall), free(o->listed_at);
    free(o->mass), free(o->ball), free(o->force), free(o->torque), free(o->v), free(o->spin),
        free(o->wall_force);
    free(o->block_wall), free(o->block), free(o->pair), free(o->corner), free(o->normal);
    free(o->corner_first), free(o->normal_first);
    fl_pairs_free(&o->candidates);
    *o = (fl_overlaps){0};
}

/* --- neighbours --------------------------------------------------------------------------------- */

/* Pairs of the candidates that may touch before the list ends; a pair that is listed for two images counts
 * once.  pass 0 counts, pass 1 fills in. */
static void list_pairs(fl_overlaps *o, int pass)
{
    const fl_packing *p = o->p;
    int64_t *at = o->first;
    for (int32_t i = 0; i < p->n; i++) {
        int32_t last = -1;
        for (int64_t k = o->candidates.first[i]; k < o->candidates.first[i + 1]; k++) {
            const int32_t j = o->candidates.partner[k];
            const double both = o->reach * (p->bound[i] + p->bound[j]) + o->skin;
            if (j == last) continue;
            last = j;
            if (v3_norm2(fl_region_wrap(o->region, v3_sub(p->x[i], p->x[j]))) > both * both) continue;
            if (pass == 0) {
                at[i + 2]++, at[j + 2]++;
                continue;
            }
            if (p->q) {
                o->near_pair[at[i + 1]] = o->near_pair[at[j + 1]] = o->pairs;
                o->pair[o->pairs++] = (fl_overlap_pair){.i = i, .j = j};
            }
            o->near[at[i + 1]++] = j;
            o->near[at[j + 1]++] = i;
        }
    }
}

static int update_list(fl_overlaps *o, fl_err *err)
{
    fl_packing *p = o->p;
    const int64_t n = p->n;
    o->reach = p->s * GROWTH;
    if (fl_region_is_periodic(o->region))
        for (int32_t i = 0; i < p->n; i++) p->x[i] = fl_region_wrap_point(o->region, p->x[i]);
    for (int32_t i = 0; i < p->n; i++)
        o->box[i] = aabb_grow((fl_aabb){p->x[i], p->x[i]}, o->reach * p->bound[i] + 0.5 * o->skin);
    if (fl_pairs_find(&o->candidates, o->box, p->n, p->n, 0, err)) return -1;
    memset(o->first, 0, (size_t)(n + 2) * sizeof *o->first);
    list_pairs(o, 0);
    for (int64_t i = 0; i < n; i++) o->first[i + 2] += o->first[i + 1];
    const int64_t all = o->first[n + 1];
    if (fl_grow(&o->near, &o->near_cap, all, sizeof *o->near, err) ||
        (p->q && (fl_grow(&o->near_pair, &o->near_pair_cap, all, sizeof *o->near_pair, err) ||
                  fl_grow(&o->pair, &o->pair_cap, all / 2, sizeof *o->pair, err))))
        return -1;
    o->pairs = 0;
    list_pairs(o, 1);
    for (int32_t i = 0; i < p->n; i++) {
        o->listed_at[i] = p->x[i];
        o->mass[i] = fmax(1.0, (double)(o->first[i + 1] - o->first[i]) / CROWD);
    }
#pragma omp parallel for schedule(dynamic, BLOCK)
    for (int32_t i = 0; i < p->n; i++) {
        const double reach = o->reach * p->bound[i] + 0.5 * o->skin;
        o->at_wall[i] = fl_region_distance(o->region, p->x[i], reach) < reach;
    }
    o->lists++;
    return 0;
}

/* --- spheres ------------------------------------------------------------------------------------ */

typedef struct {
    fl_vec3 force, torque;
    fl_overlap_totals *sum;
    double *wall;
} body_sums;

/* A contact of body i with the boundary: delta > 0, n on it, its distance from the centre. */
static void add_contact(const fl_packing *p, body_sums *b, int32_t i, double delta, fl_vec3 n,
                        double distance, double weight)
{
    const double f = weight * fl_normal_power(delta, 1.0), size = p->s * p->bound[i];
    b->force = v3_madd(b->force, f, n);
    b->sum->energy += weight * fl_normal_phi(delta, 1.0);
    b->sum->overlap_sum += f;
    b->sum->pressure += f * distance;
    if (delta > b->sum->max_overlap * size) b->sum->max_overlap = delta / size;
}

/* Contacts of a ball of body i round x: its centre, or a corner, which one step can take outside by more
 * than the radius of the ball. */
static int wall_contacts(const fl_overlaps *o, int32_t i, fl_vec3 x, fl_region_contact c[FL_REGION_CONTACTS])
{
    const double s = o->p->s;
    const int n = fl_region_contacts(o->region, x, s * o->p->radius[i], c);
    return n ? n : fl_region_way_back(o->region, x, 2.0 * s * o->p->bound[i], c);
}

static void sphere_walls(const fl_overlaps *o, body_sums *b, int32_t i)
{
    fl_region_contact c[FL_REGION_CONTACTS];
    const double r = o->p->s * o->p->radius[i];
    const int n = wall_contacts(o, i, o->p->x[i], c);
    for (int k = 0; k < n; k++) {
        add_contact(o->p, b, i, r - c[k].gap, c[k].n, r, 1.0);
        b->wall[c[k].wall] += r - c[k].gap;
        b->sum->contacts += 2, b->sum->wall_contacts++;
    }
}

/* The shortest of a distance and of those to the next images; bodies have moved little since they were in the
 * cell. */
static inline double nearest_image(double d, double length, double half)
{
    return d > half ? d - length : d < -half ? d + length : d;
}

static inline fl_vec3 nearest_images(const fl_overlaps *o, fl_vec3 d)
{
    return v3(nearest_image(d.x, o->period.x, o->half_period.x),
              nearest_image(d.y, o->period.y, o->half_period.y),
              nearest_image(d.z, o->period.z, o->half_period.z));
}

static void sphere_pairs(const fl_overlaps *o, body_sums *b, int32_t i)
{
    const int periodic = fl_region_is_periodic(o->region);
    const fl_overlap_ball me = o->ball[i];
    const int32_t *const near = o->near;
    const int64_t end = o->first[i + 1];
    fl_vec3 force = v3(0, 0, 0);
    double energy = 0.0, overlaps = 0.0, pressure = 0.0, deepest = b->sum->max_overlap;
    int64_t contacts = 0;
    for (int64_t k = o->first[i]; k < end; k++) {
        const int32_t j = near[k];
        const fl_overlap_ball other = o->ball[j];
        const double R = me.r + other.r;
        fl_vec3 d = v3_sub(me.x, other.x);
        if (periodic) d = nearest_images(o, d);
        const double d2 = v3_norm2(d);
        if (d2 >= R * R) continue;
        const double distance = sqrt(d2), delta = R - distance, least = me.r < other.r ? me.r : other.r;
        /* coincident centres part along x, the lower number to the left */
        const fl_vec3 n = distance > 0.0 ? v3_scale(1.0 / distance, d) : v3(i < j ? -1 : 1, 0, 0);
        force = v3_madd(force, fl_normal_power(delta, 1.0), n);
        energy += fl_normal_phi(delta, 1.0);
        overlaps += delta;
        pressure += delta * distance;
        contacts++;
        if (delta > deepest * least) deepest = delta / least;
    }
    b->force = v3_add(b->force, force);
    b->sum->energy += 0.5 * energy;
    b->sum->overlap_sum += 0.5 * overlaps;
    b->sum->pressure += 0.5 * pressure;
    b->sum->contacts += contacts;
    b->sum->max_overlap = deepest;
}

/* --- other shapes ------------------------------------------------------------------------------- */

static void place_shapes(fl_overlaps *o)
{
    const fl_packing *p = o->p;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < p->n; i++) {
        const fl_poly *core = &shape_of(p, i)->core;
        const fl_mat3 axes = q_matrix(p->q[i]);
        fl_packing_corners(p, i, &o->corner[o->corner_first[i]]);
        for (int32_t f = 0; f < core->nf; f++) o->normal[o->normal_first[i] + f] = m3_mul(axes, core->n[f]);
    }
}

/* Adds a point of contact: overlap, direction on i, place. */
static void add_point(fl_overlap_pair *c, double delta, double weight, fl_vec3 n, fl_vec3 at, fl_vec3 xi,
                      fl_vec3 xj)
{
    const fl_vec3 f = v3_scale(weight * fl_normal_power(delta, 1.0), n);
    c->force = v3_add(c->force, f);
    c->torque_i = v3_add(c->torque_i, v3_cross(v3_sub(at, xi), f));
    c->torque_j = v3_sub(c->torque_j, v3_cross(v3_sub(at, xj), f));
    c->energy += weight * fl_normal_phi(delta, 1.0);
    c->deepest = fmax(c->deepest, delta);
}

/* Corners v[nv] of one body against the core of body k, which is at xk: sign = 1 where the corners are those
 * of i. */
static void corner_points(const fl_overlaps *o, fl_overlap_pair *c, const fl_vec3 *v, int32_t nv, int32_t k,
                          fl_vec3 xk, double R, double sign, fl_vec3 xi, fl_vec3 xj)
{
    const fl_packing *p = o->p;
    const double scale = p->s * p->size[k], reach = p->s * (p->bound[k] - p->radius[k]) + R;
    const fl_mat3 axes = q_matrix(p->q[k]);
    for (int32_t a = 0; a < nv; a++) {
        const fl_vec3 d = v3_sub(v[a], xk);
        if (v3_norm2(d) >= reach * reach) continue;
        const fl_closest_point near =
            fl_closest_on_poly(&shape_of(p, k)->core, v3_scale(1.0 / scale, m3_tmul(axes, d)));
        const double delta = R - scale * near.d;
        if (!(delta > 0.0)) continue;
        const fl_vec3 n = m3_mul(axes, near.n);
        add_point(c, delta, CORNER, v3_scale(sign, n), v3_madd(v[a], -0.5 * scale * near.d, n), xi, xj);
    }
}

static void evaluate_pair(const fl_overlaps *o, fl_overlap_pair *c)
{
    enum { CORNERS = 256 };
    const fl_packing *p = o->p;
    const int32_t i = c->i, j = c->j;
    const fl_vec3 d = v3_sub(p->x[i], p->x[j]), w = fl_region_wrap(o->region, d);
    const double R = p->s * (p->radius[i] + p->radius[j]), both = p->s * (p->bound[i] + p->bound[j]);
    *c = (fl_overlap_pair){.i = i, .j = j, .cache = c->cache};
    if (v3_norm2(w) >= both * both) return;
    /* j at its image beside i */
    const fl_vec3 shift = v3_sub(d, w), xi = p->x[i], xj = v3_add(p->x[j], shift);
    fl_vec3 moved[CORNERS];
    const int32_t ni = o->corner_first[i + 1] - o->corner_first[i],
                  nj = o->corner_first[j + 1] - o->corner_first[j];
    const fl_vec3 *vi = &o->corner[o->corner_first[i]], *vj = &o->corner[o->corner_first[j]];
    if (v3_nonzero(shift) && nj <= CORNERS) {
        for (int32_t k = 0; k < nj; k++) moved[k] = v3_add(vj[k], shift);
        vj = moved;
    }
    fl_gap gap;
    fl_gjk((fl_core){vi, ni, NULL}, (fl_core){vj, nj, NULL}, &c->cache, &gap);
    if (!gap.overlap && gap.d >= R) return;
    c->distance = v3_norm(w);
    if (gap.overlap) {
        const fl_solid a = {&shape_of(p, i)->core, vi, &o->normal[o->normal_first[i]], R},
                       b = {&shape_of(p, j)->core, vj, &o->normal[o->normal_first[j]], R};
        fl_penetration deep;
        fl_penetration_find(&a, &b, NULL, &deep);
        add_point(c, R + deep.depth, 1.0, deep.n, v3_lerp(deep.pa, deep.pb, 0.5), xi, xj);
    } else {
        add_point(c, R - gap.d, 1.0, gap.n, v3_lerp(gap.pa, gap.pb, 0.5), xi, xj);
    }
    if (ni > 2 && nj > 1) corner_points(o, c, vi, ni, j, xj, R, 1.0, xi, xj);
    if (nj > 2 && ni > 1) corner_points(o, c, vj, nj, i, xi, R, -1.0, xi, xj);
    c->strength = v3_norm(c->force);
}

/* A contact of body i with the boundary, at the arm from its centre. */
static void add_shape_contact(const fl_packing *p, body_sums *b, int32_t i, double delta, fl_vec3 n,
                              fl_vec3 arm, double distance, double weight)
{
    add_contact(p, b, i, delta, n, distance, weight);
    b->torque = v3_madd(b->torque, weight * delta, v3_cross(arm, n));
}

/* Edges and corners that point into the region, against the core of body i. */
static void shape_features(const fl_overlaps *o, body_sums *b, int32_t i)
{
    enum { ROOM = 64 };
    const fl_packing *p = o->p;
    const fl_pack_region *r = o->region;
    const double radius = p->s * p->radius[i];
    int32_t found[ROOM];
    const fl_aabb box = aabb_grow((fl_aabb){p->x[i], p->x[i]}, p->s * p->bound[i]);
    const int32_t all = fl_bvh_query(&r->tree, r->box, box, found, ROOM), n = all < ROOM ? all : ROOM;
    const int32_t nv = o->corner_first[i + 1] - o->corner_first[i];
    for (int32_t a = 1; a < n; a++) /* by number */
        for (int32_t c = a; c > 0 && found[c - 1] > found[c]; c--) {
            const int32_t t = found[c];
            found[c] = found[c - 1], found[c - 1] = t;
        }
    for (int32_t k = 0; k < n; k++) {
        const fl_region_feature *f = &r->feature[found[k]];
        fl_gap gap;
        if (f->corners == r->dim || f->convex) continue;
        fl_gjk((fl_core){&o->corner[o->corner_first[i]], nv, NULL}, (fl_core){f->p, f->corners, NULL}, NULL,
               &gap);
        if (gap.d >= radius) continue;
        const fl_vec3 normal = gap.overlap ? v3_unit(f->n) : gap.n;
        int outside = 0;
        for (int32_t d = 0; d < f->outs; d++) outside |= v3_dot(normal, r->out[f->out + d]) > 1e-9;
        if (outside && !gap.overlap) continue; /* a face is nearer */
        add_shape_contact(p, b, i, radius - gap.d, normal, v3_sub(gap.pa, p->x[i]), radius, 1.0);
        b->wall[f->wall] += radius - gap.d;
        b->sum->contacts += 2, b->sum->wall_contacts++;
    }
}

static void shape_walls(const fl_overlaps *o, body_sums *b, int32_t i)
{
    const fl_packing *p = o->p;
    const fl_pack_region *r = o->region;
    const double radius = p->s * p->radius[i];
    for (int32_t v = o->corner_first[i]; v < o->corner_first[i + 1]; v++) {
        fl_region_contact c[FL_REGION_CONTACTS];
        const int n = wall_contacts(o, i, o->corner[v], c);
        for (int k = 0; k < n; k++) {
            if (c[k].feature >= 0 && c[k].gap > 0.0 && r->feature[c[k].feature].corners < r->dim) continue;
            const fl_vec3 arm = v3_madd(v3_sub(o->corner[v], p->x[i]), -radius, c[k].n);
            add_shape_contact(p, b, i, radius - c[k].gap, c[k].n, arm, radius, CORNER);
            b->wall[c[k].wall] += radius - c[k].gap;
            b->sum->contacts += 2, b->sum->wall_contacts++;
        }
    }
    if (r->kind == FL_REGION_FEATURES) shape_features(o, b, i);
}

static void shape_pairs(const fl_overlaps *o, body_sums *b, int32_t i)
{
    const fl_packing *p = o->p;
    for (int64_t k = o->first[i]; k < o->first[i + 1]; k++) {
        const fl_overlap_pair *c = &o->pair[o->near_pair[k]];
        if (!(c->energy > 0.0)) continue;
        const double sign = c->i == i ? 1.0 : -1.0, size = p->s * fmin(p->bound[c->i], p->bound[c->j]);
        b->force = v3_madd(b->force, sign, c->force);
        b->torque = v3_add(b->torque, c->i == i ? c->torque_i : c->torque_j);
        b->sum->energy += 0.5 * c->energy;
        b->sum->overlap_sum += 0.5 * c->strength;
        b->sum->pressure += 0.5 * c->strength * c->distance;
        b->sum->contacts++;
        b->sum->max_overlap = fmax(b->sum->max_overlap, c->deepest / size);
    }
}

/* --- evaluation --------------------------------------------------------------------------------- */

static void evaluate_block(fl_overlaps *o, int32_t k)
{
    const fl_packing *p = o->p;
    fl_overlap_totals *sum = &o->block[k];
    double *wall = &o->block_wall[(int64_t)k * o->region->walls];
    const int32_t end = (k + 1) * BLOCK < p->n ? (k + 1) * BLOCK : p->n;
    *sum = (fl_overlap_totals){0};
    memset(wall, 0, (size_t)o->region->walls * sizeof *wall);
    for (int32_t i = k * BLOCK; i < end; i++) {
        body_sums b = {.sum = sum, .wall = wall};
        if (p->q) {
            shape_pairs(o, &b, i);
            if (o->at_wall[i]) shape_walls(o, &b, i);
        } else {
            sphere_pairs(o, &b, i);
            if (o->at_wall[i]) sphere_walls(o, &b, i);
        }
        o->force[i] = b.force;
        double f2 = v3_norm2(b.force), power = v3_dot(b.force, o->v[i]), v2 = v3_norm2(o->v[i]);
        if (p->q) {
            o->torque[i] = v3_scale(1.0 / (ARM * p->s * p->bound[i]), b.torque);
            f2 += v3_norm2(o->torque[i]);
            power += v3_dot(o->torque[i], o->spin[i]);
            v2 += v3_norm2(o->spin[i]);
        }
        sum->power += power;
        sum->force2 += f2 / o->mass[i];
        sum->speed2 += v2 * o->mass[i];
        sum->max_force = fmax(sum->max_force, f2);
    }
}

static void merge_blocks(fl_overlaps *o)
{
    fl_overlap_totals all = {0};
    for (int32_t w = 0; w < o->region->walls; w++) o->wall_force[w] = 0.0;
    for (int32_t k = 0; k < o->blocks; k++) {
        const fl_overlap_totals *b = &o->block[k];
        all.energy += b->energy;
        all.power += b->power, all.force2 += b->force2, all.speed2 += b->speed2;
        all.max_force = fmax(all.max_force, b->max_force);
        all.max_overlap = fmax(all.max_overlap, b->max_overlap);
        all.overlap_sum += b->overlap_sum, all.pressure += b->pressure;
        all.contacts += b->contacts, all.wall_contacts += b->wall_contacts;
        for (int32_t w = 0; w < o->region->walls; w++)
            o->wall_force[w] += o->block_wall[(int64_t)k * o->region->walls + w];
    }
    all.contacts /= 2;
    all.max_force = sqrt(all.max_force);
    all.max_move2 = o->now.max_move2;
    o->now = all;
}

static int list_is_old(const fl_overlaps *o)
{
    return o->stale || o->p->s > o->reach || o->now.max_move2 > 0.25 * o->skin * o->skin;
}

int fl_overlaps_evaluate(fl_overlaps *o, fl_err *err)
{
    if (list_is_old(o)) {
        o->stale = 0;
        if (update_list(o, err)) return -1;
        o->now.max_move2 = 0.0;
    }
    if (o->p->q) {
        place_shapes(o);
#pragma omp parallel for schedule(dynamic, 64)
        for (int32_t c = 0; c < o->pairs; c++) evaluate_pair(o, &o->pair[c]);
    } else {
#pragma omp parallel for schedule(static)
        for (int32_t i = 0; i < o->p->n; i++)
            o->ball[i] = (fl_overlap_ball){o->p->x[i], o->p->s * o->p->radius[i]};
    }
#pragma omp parallel for schedule(dynamic, 2)
    for (int32_t k = 0; k < o->blocks; k++) evaluate_block(o, k);
    merge_blocks(o);
    return 0;
}

/* --- relaxation --------------------------------------------------------------------------------- */

static void move_block(fl_overlaps *o, int32_t k, const fl_fire_step *f)
{
    fl_packing *p = o->p;
    const int32_t end = (k + 1) * BLOCK < p->n ? (k + 1) * BLOCK : p->n;
    double most = 0.0;
    for (int32_t i = k * BLOCK; i < end; i++) {
        const double push = f->push * f->dt / o->mass[i], longest = LONGEST * p->s * p->bound[i];
        fl_vec3 way = v3(0, 0, 0), turn = way;
        if (f->back > 0.0) {
            way = v3_scale(-f->back, o->v[i]);
            if (p->q) turn = v3_scale(-f->back, o->spin[i]);
        }
        o->v[i] = v3_madd(v3_scale(f->keep, o->v[i]), push, o->force[i]);
        const double v = v3_norm(o->v[i]);
        if (f->dt * v > longest) o->v[i] = v3_scale(longest / (f->dt * v), o->v[i]);
        p->x[i] = v3_add(p->x[i], v3_madd(way, f->dt, o->v[i]));
        if (p->q) {
            o->spin[i] = v3_madd(v3_scale(f->keep, o->spin[i]), push, o->torque[i]);
            const double w = v3_norm(o->spin[i]);
            if (f->dt * w > longest) o->spin[i] = v3_scale(longest / (f->dt * w), o->spin[i]);
            turn = v3_scale(1.0 / (ARM * p->s * p->bound[i]), v3_madd(turn, f->dt, o->spin[i]));
            p->q[i] = q_unit(q_mul(q_of_vector(turn), p->q[i]));
        }
        most = fmax(most, v3_norm2(v3_sub(p->x[i], o->listed_at[i])));
    }
    o->block[k].max_move2 = most;
}

static void move_bodies(fl_overlaps *o, const fl_fire_step *f)
{
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < o->blocks; k++) move_block(o, k, f);
    o->now.max_move2 = 0.0;
    for (int32_t k = 0; k < o->blocks; k++) o->now.max_move2 = fmax(o->now.max_move2, o->block[k].max_move2);
}

/* Where the closest points of two polyhedra jump, forces are no gradient that FIRE could follow: their steps
 * are damped by a constant. */
static fl_fire_step damped_step(void)
{
    const fl_relaxation viscous = fl_relaxation_start(FL_RELAXATION_VISCOUS, VISCOUS);
    return (fl_fire_step){
        .dt = SHAPE_STEP, .keep = fl_relaxation_c1(&viscous), .push = 1.0 / (1.0 + 0.5 * VISCOUS)};
}

int fl_overlaps_relax(fl_overlaps *o, double free, double balance, int64_t steps, fl_err *err)
{
    memset(o->v, 0, (size_t)o->p->n * sizeof *o->v);
    if (o->p->q) memset(o->spin, 0, (size_t)o->p->n * sizeof *o->spin);
    o->fire = fl_fire_start(fire_step(o->p));
    o->stale = 1; /* so that the result depends on the packing alone */
    double energy = INFINITY, least = INFINITY;
    for (int64_t k = 0;; k++) {
        if (fl_overlaps_evaluate(o, err)) return -1;
        const fl_overlap_totals *t = &o->now;
        least = fmin(least, t->energy);
        if (t->max_overlap <= free) return FL_RELAXED_FREE;
        const double residual = o->strict ? t->max_force : sqrt(t->force2 / o->p->n);
        if (t->contacts && residual <= balance * t->overlap_sum / (double)t->contacts)
            return FL_RELAXED_JAMMED;
        if (k == steps) return FL_RELAXED_SLOW;
        if (o->p->q && k % STALL == STALL - 1) {
            if (least > STALLED * energy) return FL_RELAXED_JAMMED;
            energy = least;
        }
        const fl_fire_step f =
            o->p->q ? damped_step() : fl_fire_next(&o->fire, t->power, t->force2, t->speed2);
        move_bodies(o, &f);
        o->steps++;
    }
}

void fl_overlaps_each(const fl_overlaps *o, fl_overlap_call *call, void *with)
{
    const fl_packing *p = o->p;
    const double s = p->s;
    for (int32_t i = 0; i < p->n; i++) {
        fl_region_contact c[FL_REGION_CONTACTS];
        for (int64_t k = o->first[i]; k < o->first[i + 1]; k++) {
            const int32_t j = o->near[k];
            if (j < i) continue;
            if (p->q) {
                const fl_overlap_pair *e = &o->pair[o->near_pair[k]];
                if (e->energy > 0.0)
                    call(with, i, j, v3_unit(e->i == i ? e->force : v3_neg(e->force)), e->deepest);
                continue;
            }
            const fl_vec3 d = fl_region_wrap(o->region, v3_sub(p->x[i], p->x[j]));
            const double distance = v3_norm(d), delta = s * (p->radius[i] + p->radius[j]) - distance;
            if (delta > 0.0) call(with, i, j, v3_unit(d), delta);
        }
        if (!o->at_wall[i]) continue;
        const int32_t from = p->q ? o->corner_first[i] : i, to = p->q ? o->corner_first[i + 1] : i + 1;
        for (int32_t v = from; v < to; v++) {
            const double r = s * p->radius[i];
            const int n = wall_contacts(o, i, p->q ? o->corner[v] : p->x[i], c);
            for (int k = 0; k < n; k++) call(with, i, -1 - c[k].wall, c[k].n, r - c[k].gap);
        }
    }
}
