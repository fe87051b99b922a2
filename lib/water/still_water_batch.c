/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <stddef.h>
#include <string.h>
#include "water/still_water_batch.h"

/* Twice the kinetic energy of translation of lane i at velocity v. */
FL_SIMD_INLINE double twice_kinetic(const fl_body_batch *a, const fl_body_batch_water *water, int32_t i,
                                    fl_vec3 v)
{
    const double m = a->m[i];
    if (!water) return m * v3_norm2(v);
    return v3_dot(
        v, fl_body_batch_momentum(fl_body_batch_axes(a, i), m, FL_BODY_BATCH_VEC(water->added_mass, i), v));
}

/* Velocity u through the fluid of lane i after the decay by c |u| u. */
FL_SIMD_INLINE fl_vec3 slowed_velocity(const fl_body_batch *a, const fl_body_batch_water *water, int32_t i,
                                       double c, fl_vec3 u)
{
    const double h = a->h[i], m = a->m[i], speed = v3_norm(u);
    if (!water) return v3_scale(fl_drag_decay_factor(m, c, speed, h), u);
    const fl_rows3 R = fl_body_batch_axes(a, i);
    const fl_vec3 p = r3_tmul(R, u), added = FL_BODY_BATCH_VEC(water->added_mass, i);
    const double s = c * speed * h;
    return r3_mul(R, v3(p.x / (1.0 + s / (m + added.x)), p.y / (1.0 + s / (m + added.y)),
                        p.z / (1.0 + s / (m + added.z))));
}

/* decay_velocity() of environment.c for bodies without constraints: surface in contact with the fluid, r_eff,
 * velocity c of the fluid. Adds sign times the work to work[]. */
FL_SIMD_INLINE void decay_lanes(fl_body_batch *restrict a, const fl_body_batch_water *restrict water,
                                const fl_fluid *fluid, const double *restrict surface,
                                const double *restrict reach, double (*restrict c)[FL_BODY_BATCH],
                                const double *restrict held, double sign, double *restrict work)
{
#pragma omp simd
    for (int32_t i = 0; i < a->lanes; i++) {
        const double h = a->h[i], area = surface[i] > 0.0 ? surface[i] : 0.0, r = reach[i];
        const fl_vec3 v = FL_BODY_BATCH_VEC(a->v, i), w = FL_BODY_BATCH_VEC(a->w, i),
                      L = FL_BODY_BATCH_VEC(a->L, i), flow = FL_BODY_BATCH_VEC(c, i);
        const double turning = v3_dot(w, L), spin2 = v3_norm2(w);
        const double before = 0.5 * (twice_kinetic(a, water, i, v) + turning) - held[i];
        const fl_vec3 slow =
            slowed_velocity(a, water, i, fl_drag_force_constant(fluid, area), v3_sub(v, flow));
        /* 1 for a body that does not rotate, or has no contact with the fluid */
        const double about = turning > 0.0 ? turning : 1.0, by = turning > 0.0 ? spin2 : 0.0,
                     stays = fl_drag_decay_factor(about, fl_drag_moment_constant(fluid, area, r) * by,
                                                  sqrt(by), h);
        const int meets = area > 0.0;
        const double px = meets ? flow.x + slow.x : v.x, py = meets ? flow.y + slow.y : v.y,
                     pz = meets ? flow.z + slow.z : v.z;
        const fl_vec3 l = v3_scale(stays, L), s = v3_scale(stays, w);
        const double after = 0.5 * (twice_kinetic(a, water, i, v3(px, py, pz)) + v3_dot(s, l)) - held[i];
        fl_body_batch_set_vec(a->v, i, v3(px, py, pz));
        fl_body_batch_set_vec(a->L, i, l);
        fl_body_batch_set_vec(a->w, i, s);
        work[i] += sign * (after - before);
    }
}

FL_SIMD_VERSIONS static void decay_free_lanes(fl_body_batch *restrict a, const fl_fluid *fluid,
                                              const double *restrict surface, const double *restrict reach,
                                              double (*restrict c)[FL_BODY_BATCH],
                                              const double *restrict held, double sign, double *restrict work)
{
    decay_lanes(a, NULL, fluid, surface, reach, c, held, sign, work);
}

FL_SIMD_VERSIONS static void
decay_lanes_with_water(fl_body_batch *restrict a, const fl_body_batch_water *restrict water,
                       const fl_fluid *fluid, const double *restrict surface, const double *restrict reach,
                       double (*restrict c)[FL_BODY_BATCH], const double *restrict held, double sign,
                       double *restrict work)
{
    decay_lanes(a, water, fluid, surface, reach, c, held, sign, work);
}

FL_SIMD_VERSIONS static void fill_vec(double (*restrict c)[FL_BODY_BATCH], fl_vec3 u, int32_t n)
{
#pragma omp simd
    for (int32_t i = 0; i < n; i++) c[0][i] = u.x, c[1][i] = u.y, c[2][i] = u.z;
}

FL_SIMD_VERSIONS static int any_positive(const double *restrict area, int32_t n)
{
    double many = 0.0;
#pragma omp simd reduction(+ : many)
    for (int32_t i = 0; i < n; i++) many += area[i] > 0.0 ? 1.0 : 0.0;
    return many > 0.0;
}

/* The same for surface[] and c[] of the batch; work[] is an array over all bodies. */
static void decay_bodies(fl_body_batch *a, const fl_body_batch_water *water, const fl_environment *s,
                         const fl_bodies *b, const fl_fluid *fluid, const double *surface,
                         double (*c)[FL_BODY_BATCH], double sign, double *work)
{
    _Alignas(64) double of_reach[FL_BODY_BATCH], of_held[FL_BODY_BATCH], done[FL_BODY_BATCH];
    double *const sum = fl_body_batch_gather(a, work, done);
    const double *const reach = fl_body_batch_gather(a, s->drag_radius, of_reach),
                        *const held = fl_body_batch_gather(a, b->work_of_constraints, of_held);
    if (water) decay_lanes_with_water(a, water, fluid, surface, reach, c, held, sign, sum);
    else decay_free_lanes(a, fluid, surface, reach, c, held, sign, sum);
    fl_body_batch_scatter(a, work, sum);
}

/* State of decay_by_facets() of environment.c. */
typedef struct {
    fl_facet_drag_batch few;
    double I[3][FL_BODY_BATCH], before[FL_BODY_BATCH];
    double has[FL_BODY_BATCH]; /* 1 if the body has facets in contact with the fluid, else 0 */
} facet_state;

FL_SIMD_INLINE void begin_facets(const fl_body_batch *restrict a, const fl_body_batch_water *restrict water,
                                 double (*restrict c)[FL_BODY_BATCH], const double *restrict held,
                                 facet_state *restrict q)
{
#pragma omp simd
    for (int32_t i = 0; i < a->lanes; i++) {
        const fl_rows3 R = fl_body_batch_axes(a, i);
        const fl_vec3 v = FL_BODY_BATCH_VEC(a->v, i), w = FL_BODY_BATCH_VEC(a->w, i),
                      L = FL_BODY_BATCH_VEC(a->L, i);
        const double m = a->m[i];
        q->before[i] = 0.5 * (twice_kinetic(a, water, i, v) + v3_dot(w, L)) - held[i];
        fl_body_batch_set_vec(q->few.y, i, r3_tmul(R, v3_sub(v, FL_BODY_BATCH_VEC(c, i))));
        fl_body_batch_set_vec(q->few.y + 3, i, r3_tmul(R, w));
        for (int k = 0; k < 3; k++) {
            q->few.mass[k][i] = m + (water ? water->added_mass[k][i] : 0.0);
            q->few.mass[3 + k][i] = q->I[k][i];
        }
    }
}

FL_SIMD_INLINE void end_facets(fl_body_batch *restrict a, const fl_body_batch_water *restrict water,
                               double (*restrict c)[FL_BODY_BATCH], const double *restrict held,
                               const facet_state *restrict q, double sign, double *restrict work)
{
#pragma omp simd
    for (int32_t i = 0; i < a->lanes; i++) {
        const fl_rows3 R = fl_body_batch_axes(a, i);
        const fl_vec3 v0 = FL_BODY_BATCH_VEC(a->v, i), w0 = FL_BODY_BATCH_VEC(a->w, i),
                      L0 = FL_BODY_BATCH_VEC(a->L, i);
        const fl_vec3 turn = FL_BODY_BATCH_VEC(q->few.y + 3, i);
        const fl_vec3 v = v3_add(FL_BODY_BATCH_VEC(c, i), r3_mul(R, FL_BODY_BATCH_VEC(q->few.y, i))),
                      w = r3_mul(R, turn), L = r3_mul(R, v3_mul(FL_BODY_BATCH_VEC(q->I, i), turn));
        const double after = 0.5 * (twice_kinetic(a, water, i, v) + v3_dot(w, L)) - held[i];
        const int has = q->has[i] > 0.0;
        fl_body_batch_set_vec(a->v, i, v3(has ? v.x : v0.x, has ? v.y : v0.y, has ? v.z : v0.z));
        fl_body_batch_set_vec(a->w, i, v3(has ? w.x : w0.x, has ? w.y : w0.y, has ? w.z : w0.z));
        fl_body_batch_set_vec(a->L, i, v3(has ? L.x : L0.x, has ? L.y : L0.y, has ? L.z : L0.z));
        work[i] += has ? sign * (after - q->before[i]) : 0.0;
    }
}

FL_SIMD_VERSIONS static void begin_free_facets(const fl_body_batch *restrict a,
                                               double (*restrict c)[FL_BODY_BATCH],
                                               const double *restrict held, facet_state *restrict q)
{
    begin_facets(a, NULL, c, held, q);
}

FL_SIMD_VERSIONS static void begin_facets_with_water(const fl_body_batch *restrict a,
                                                     const fl_body_batch_water *restrict water,
                                                     double (*restrict c)[FL_BODY_BATCH],
                                                     const double *restrict held, facet_state *restrict q)
{
    begin_facets(a, water, c, held, q);
}

FL_SIMD_VERSIONS static void end_free_facets(fl_body_batch *restrict a, double (*restrict c)[FL_BODY_BATCH],
                                             const double *restrict held, const facet_state *restrict q,
                                             double sign, double *restrict work)
{
    end_facets(a, NULL, c, held, q, sign, work);
}

FL_SIMD_VERSIONS static void end_facets_with_water(fl_body_batch *restrict a,
                                                   const fl_body_batch_water *restrict water,
                                                   double (*restrict c)[FL_BODY_BATCH],
                                                   const double *restrict held, const facet_state *restrict q,
                                                   double sign, double *restrict work)
{
    end_facets(a, water, c, held, q, sign, work);
}

/* Drag by facets on the bodies with has[] set; air: 1 for the wind. */
static void decay_facets(fl_body_batch *a, const fl_body_batch_water *water, const fl_environment *s,
                         const fl_bodies *b, int air, const double *has, double (*c)[FL_BODY_BATCH],
                         double sign, double *work)
{
    _Alignas(64) double of_held[FL_BODY_BATCH], done[FL_BODY_BATCH];
    const fl_facet_drag_law law = air ? fl_environment_wind_law(s) : fl_environment_water_law(s);
    double *const sum = fl_body_batch_gather(a, work, done);
    const double *const held = fl_body_batch_gather(a, b->work_of_constraints, of_held);
    facet_state q;
    memcpy(q.has, has, sizeof q.has);
    for (int32_t k = 0; k < a->lanes; k++) fl_body_batch_set_vec(q.I, k, b->I[a->index[k]]);
    if (water) begin_facets_with_water(a, water, c, held, &q);
    else begin_free_facets(a, c, held, &q);
    for (int32_t k = 0; k < a->lanes; k++) {
        const fl_drag_surface *skin = &s->drag_surface[a->index[k]];
        if (k < a->n && has[k] > 0.0)
            fl_facet_drag_sum(&q.few, k, air ? &skin->dry : &skin->wet, law, a->h[k]);
        else
            for (int row = 0; row < FL_DRAG_SUMS; row++) q.few.sum[row][k] = 0.0;
    }
    fl_facet_drag_step(&q.few, a->lanes);
    if (water) end_facets_with_water(a, water, c, held, &q, sign, sum);
    else end_free_facets(a, c, held, &q, sign, sum);
    fl_body_batch_scatter(a, work, sum);
}

/* Drag by facets on bodies that have such, and on the whole surface of the others. */
static void decay_mixed(fl_body_batch *a, const fl_body_batch_water *water, const fl_environment *s,
                        const fl_bodies *b, int air, const double *area, double (*c)[FL_BODY_BATCH])
{
    _Alignas(64) double has[FL_BODY_BATCH], rest[FL_BODY_BATCH];
    const fl_fluid *fluid = air ? &s->air : &s->seawater;
    const double sign = air ? 1.0 : -1.0;
    double *const work = air ? s->wind_work : s->drag_loss;
    double many = 0.0, others = 0.0;
    for (int32_t k = 0; k < a->lanes && s->drag_surface; k++) {
        const fl_drag_surface *skin = &s->drag_surface[a->index[k]];
        const int of_skin = (air ? skin->dry.group : skin->wet.group) != NULL;
        has[k] = of_skin && area[k] > 0.0 ? 1.0 : 0.0;
        rest[k] = of_skin ? 0.0 : area[k];
        many += has[k], others += of_skin ? 0.0 : 1.0;
    }
    if (!s->drag_surface || others > 0.0)
        decay_bodies(a, water, s, b, fluid, s->drag_surface ? rest : area, c, sign, work);
    if (many > 0.0) decay_facets(a, water, s, b, air, has, c, sign, work);
}

static void apply_water_drag(fl_environment *s, const fl_bodies *b, fl_body_batch *a,
                             const fl_body_batch_water *water)
{
    _Alignas(64) double c[3][FL_BODY_BATCH], room[FL_BODY_BATCH];
    const double *const wetted = fl_body_batch_gather(a, s->wetted_area, room);
    if (!(wetted[0] > 0.0) && !any_positive(wetted, a->lanes)) return;
    if (!s->flow_velocity) fill_vec(c, s->current.velocity, a->lanes);
    for (int32_t k = 0; k < a->lanes && s->flow_velocity; k++) {
        const fl_vec3 u = s->flow_velocity[a->index[k]];
        c[0][k] = u.x, c[1][k] = u.y, c[2][k] = u.z;
    }
    decay_mixed(a, water, s, b, 0, wetted, c);
}

static void apply_wind_drag(fl_environment *s, const fl_bodies *b, fl_body_batch *a,
                            const fl_body_batch_water *water)
{
    _Alignas(64) double c[3][FL_BODY_BATCH], dry[FL_BODY_BATCH];
    fill_vec(c, s->wind_velocity, a->lanes);
    for (int32_t k = 0; k < a->lanes; k++)
        dry[k] = s->hull[a->index[k]].surface_area - (s->water ? s->wetted_area[a->index[k]] : 0.0);
    decay_mixed(a, water, s, b, 1, dry, c);
}

/* Forces with an `impulse` work on the arrays of the bodies, one by one. */
static void apply_impulses(fl_environment *s, fl_bodies *b, fl_body_batch *a, int back)
{
    fl_body_batch_store_velocities(a, b);
    for (int32_t k = 0; k < a->n; k++) fl_environment_apply_impulses(s, b, a->index[k], a->h[k], back);
    for (int32_t k = 0; k < a->lanes; k++) {
        const int32_t i = a->index[k];
        fl_body_batch_set_vec(a->v, k, b->v[i]);
        fl_body_batch_set_vec(a->L, k, b->L[i]);
        fl_body_batch_set_vec(a->w, k, b->w[i]);
    }
}

void fl_still_water_batch_drag(fl_environment *s, fl_bodies *b, fl_body_batch *a,
                               const fl_body_batch_water *water, int back)
{
    if (back && s->impulses) apply_impulses(s, b, a, back);
    if (back && s->wind) apply_wind_drag(s, b, a, water);
    if (s->water) apply_water_drag(s, b, a, water);
    if (!back && s->wind) apply_wind_drag(s, b, a, water);
    if (!back && s->impulses) apply_impulses(s, b, a, back);
}

void fl_still_water_batch_add_work(fl_environment *s, const fl_body_batch *a, double (*v)[FL_BODY_BATCH],
                                   double (*w)[FL_BODY_BATCH])
{
    for (int32_t k = 0; k < a->n; k++) {
        const int32_t i = a->index[k];
        s->water_work[i] +=
            0.5 * a->h[k] *
            (v3_dot(s->water_force[i], v3_add(FL_BODY_BATCH_VEC(v, k), FL_BODY_BATCH_VEC(a->v, k))) +
             v3_dot(s->water_moment[i], v3_add(FL_BODY_BATCH_VEC(w, k), FL_BODY_BATCH_VEC(a->w, k))));
    }
}

/* Numbers of fl_prism in its order, one array per number. */
enum { AREA, O, A = O + 3, E = A + 3, Z0 = E + 3, Z1, JAA, JAB, JBB, PERIMETER, GA, GB, FAR2, NUMBERS };
static_assert(offsetof(fl_prism, o) == O * sizeof(double) && offsetof(fl_prism, e) == E * sizeof(double) &&
                  offsetof(fl_prism, jaa) == JAA * sizeof(double) &&
                  offsetof(fl_prism, far2) == FAR2 * sizeof(double),
              "as fl_prism has them");

typedef struct {
    _Alignas(64) double p[NUMBERS][FL_BODY_BATCH];
    double level[FL_BODY_BATCH];  /* of the water above the origin */
    double floats[FL_BODY_BATCH]; /* out: 1 if it floats as a prism, else 0 */
} prism_lanes;

FL_SIMD4_VERSIONS static void load_contiguous(prism_lanes *q, const fl_hull *h, int32_t lanes)
{
    const double *first = &h->prism.area;
    for (int32_t k = 0; k < lanes; k += FL_SIMD_WIDTH) {
        for (int c = 0; c + 4 <= NUMBERS; c += 4) fl_body_batch_unpack4(q->p + c, first + c, sizeof *h, k);
        /* the last four overlap the ones before, so as not to read beyond the struct */
        fl_body_batch_unpack4(q->p + NUMBERS - 4, first + NUMBERS - 4, sizeof *h, k);
    }
}

FL_SIMD4_VERSIONS static void load_gathered(prism_lanes *q, const fl_hull *h, const int32_t *at,
                                            int32_t lanes)
{
    const double *first = &h->prism.area;
    for (int32_t k = 0; k < lanes; k += FL_SIMD_WIDTH) {
        for (int c = 0; c + 4 <= NUMBERS; c += 4)
            fl_body_batch_gather4(q->p + c, first + c, sizeof *h, at, k);
        fl_body_batch_gather4(q->p + NUMBERS - 4, first + NUMBERS - 4, sizeof *h, at, k);
    }
}

static void load_prisms(prism_lanes *q, const fl_environment *s, const fl_body_batch *a)
{
    if (a->contiguous) load_contiguous(q, &s->hull[a->index[0]], a->lanes);
    else load_gathered(q, s->hull, a->index, a->lanes);
}

/* Submerged part of a prism by fl_prism_submerged(), and whether that applies. */
typedef struct {
    double volume, wetted, floats; /* 1 or 0 */
    fl_vec3 centre;
} prism_submerged;

FL_SIMD_INLINE prism_submerged submerge_lane(const prism_lanes *q, int32_t i, fl_vec3 up, double level,
                                             double reach)
{
    const double ux = up.x, uy = up.y, uz = up.z;
    const double ax = q->p[A][i], ay = q->p[A + 1][i], az = q->p[A + 2][i], ex = q->p[E][i],
                 ey = q->p[E + 1][i], ez = q->p[E + 2][i], ox = q->p[O][i], oy = q->p[O + 1][i],
                 oz = q->p[O + 2][i];
    const double bx = ey * az - ez * ay, by = ez * ax - ex * az, bz = ex * ay - ey * ax;
    const double area = q->p[AREA][i], jab = q->p[JAB][i];
    const double along = ux * ex + uy * ey + uz * ez;
    const int over = along < 0.0; /* upside down: seen along -e */
    const double ue = over ? -along : along, sign = over ? -1.0 : 1.0, z0 = over ? -q->p[Z1][i] : q->p[Z0][i],
                 z1 = over ? -q->p[Z0][i] : q->p[Z1][i];
    const double per_ue = 1.0 / (ue > FL_PRISM_MIN_UPRIGHT ? ue : 1.0);
    const double sa = -per_ue * (ux * ax + uy * ay + uz * az), sb = -per_ue * (ux * bx + uy * by + uz * bz);
    const double zw = per_ue * (level - (ux * ox + uy * oy + uz * oz)), wet0 = zw - z0, dry0 = z1 - zw;
    const double least = wet0 < dry0 ? wet0 : dry0;
    const int floats = area > 0.0 && ue > FL_PRISM_MIN_UPRIGHT && level < reach && level > -reach &&
                       least > 0.0 && least * least > (sa * sa + sb * sb) * q->p[FAR2][i];
    const double ja = q->p[JAA][i] * sa + jab * sb, jb = jab * sa + q->p[JBB][i] * sb;
    const double volume = area * wet0, per = 1.0 / (floats ? volume : 1.0);
    const double mz = 0.5 * (area * wet0 * (zw + z0) + sa * ja + sb * jb);
    const double pa = per * ja, pb = per * jb, pe = sign * per * mz;
    const double cx = ox + pa * ax + pb * bx + pe * ex, cy = oy + pa * ay + pb * by + pe * ey,
                 cz = oz + pa * az + pb * bz + pe * ez;
    return (prism_submerged){.volume = volume,
                             .wetted =
                                 area + q->p[PERIMETER][i] * (wet0 + sa * q->p[GA][i] + sb * q->p[GB][i]),
                             .floats = floats ? 1.0 : 0.0,
                             .centre = v3(cx, cy, cz)};
}

/* evaluate_still() of environment.c for prisms; returns how many float as prisms. */
FL_SIMD_VERSIONS static double add_prism_buoyancy(prism_lanes *restrict q, fl_body_batch *restrict a,
                                                  double weight, const double *restrict reach,
                                                  double *restrict wetted, double *restrict lift,
                                                  double *restrict centre)
{
    double afloat = 0.0;
#pragma omp simd reduction(+ : afloat)
    for (int32_t i = 0; i < a->lanes; i++) {
        const double ux = a->R[6][i], uy = a->R[7][i], uz = a->R[8][i], level = q->level[i];
        const prism_submerged w = submerge_lane(q, i, v3(ux, uy, uz), level, reach[i]);
        const double cx = w.centre.x, cy = w.centre.y, cz = w.centre.z, one = w.floats;
        const double over_water = ux * cx + uy * cy + uz * cz - level, push = weight * w.volume;
        const double fx = push * ux, fy = push * uy, fz = push * uz;
        const double tx = cy * fz - cz * fy, ty = cz * fx - cx * fz, tz = cx * fy - cy * fx;
        q->floats[i] = one;
        afloat += one;
        wetted[i] = w.wetted;
        lift[i] = push;
        centre[i] = over_water;
        a->f[0][i] += 0.0;
        a->f[1][i] += 0.0;
        a->f[2][i] += push;
        a->t[0][i] += a->R[0][i] * tx + a->R[1][i] * ty + a->R[2][i] * tz;
        a->t[1][i] += a->R[3][i] * tx + a->R[4][i] * ty + a->R[5][i] * tz;
        a->t[2][i] += a->R[6][i] * tx + a->R[7][i] * ty + a->R[8][i] * tz;
    }
    return afloat;
}

/* -1 if all bodies are wholly out of the water by their drag radius, 1 if all are wholly in, else 0. */
FL_SIMD_VERSIONS static int all_dry_or_wet(const double *restrict level, const double *restrict reach,
                                           int32_t n)
{
    double out = 0.0, in = 0.0;
#pragma omp simd reduction(+ : out, in)
    for (int32_t i = 0; i < n; i++) {
        out += level[i] <= -reach[i] ? 1.0 : 0.0;
        in += level[i] >= reach[i] ? 1.0 : 0.0;
    }
    return out == n ? -1 : in == n;
}

/* add_prism_buoyancy() for bodies wholly out of the water, without the zeros that it adds. */
FL_SIMD_VERSIONS static void set_dry(const double *restrict level, int32_t n, double *restrict wetted,
                                     double *restrict lift, double *restrict centre)
{
#pragma omp simd
    for (int32_t i = 0; i < n; i++) {
        wetted[i] = 0.0;
        lift[i] = 0.0;
        centre[i] = -level[i];
    }
}

/* Volumes and centres for bodies wholly in the water. */
typedef struct {
    _Alignas(64) double volume[FL_BODY_BATCH];
    double c[3][FL_BODY_BATCH];
} whole_hulls;

FL_SIMD_VERSIONS static void add_whole_buoyancy(const whole_hulls *restrict q, const double *restrict level,
                                                fl_body_batch *restrict a, double weight,
                                                double *restrict lift, double *restrict centre)
{
#pragma omp simd
    for (int32_t i = 0; i < a->lanes; i++) {
        const double ux = a->R[6][i], uy = a->R[7][i], uz = a->R[8][i];
        const double cx = q->c[0][i], cy = q->c[1][i], cz = q->c[2][i];
        const double over_water = ux * cx + uy * cy + uz * cz - level[i], push = weight * q->volume[i];
        const double fx = push * ux, fy = push * uy, fz = push * uz;
        const double tx = cy * fz - cz * fy, ty = cz * fx - cx * fz, tz = cx * fy - cy * fx;
        lift[i] = push;
        centre[i] = over_water;
        a->f[2][i] += push;
        a->t[0][i] += a->R[0][i] * tx + a->R[1][i] * ty + a->R[2][i] * tz;
        a->t[1][i] += a->R[3][i] * tx + a->R[4][i] * ty + a->R[5][i] * tz;
        a->t[2][i] += a->R[6][i] * tx + a->R[7][i] * ty + a->R[8][i] * tz;
    }
}

/* Buffers for a batch that is not contiguous. */
typedef struct {
    double wetted[FL_BODY_BATCH], lift[FL_BODY_BATCH], reach[FL_BODY_BATCH];
} lane_buffers;

static void add_dry_or_wet(fl_environment *s, const double *level, fl_body_batch *a, int in, double *wetted,
                           double *lift, double *centre)
{
    if (!in) {
        set_dry(level, a->lanes, wetted, lift, centre);
        return;
    }
    whole_hulls q;
    for (int32_t k = 0; k < a->lanes; k++) {
        const fl_hull *h = &s->hull[a->index[k]];
        wetted[k] = h->surface_area;
        q.volume[k] = h->volume;
        q.c[0][k] = h->centre.x, q.c[1][k] = h->centre.y, q.c[2][k] = h->centre.z;
    }
    add_whole_buoyancy(&q, level, a, s->specific_weight, lift, centre);
}

static void update_flow(fl_environment *s, const fl_bodies *b, const fl_body_batch *a, const double *centre)
{
    for (int32_t k = 0; k < a->n && s->flow_velocity; k++)
        s->flow_velocity[a->index[k]] = fl_current_at(&s->current, centre[k]);
    for (int32_t k = 0; k < a->n && b->added_mass; k++)
        b->flow_velocity[a->index[k]] = fl_environment_flow(s, a->index[k]);
}

/* Numbers of fl_wave_sample in its order, one array per number. */
enum {
    SAMPLE_F,
    SAMPLE_T = 3,
    SAMPLE_FLOW = 6,
    SAMPLE_DF = 9,
    SAMPLE_DT = 12,
    SAMPLE_DFLOW = 15,
    SAMPLE_Z = 18,
    SAMPLE_SLOPE,
    SAMPLE_DZ,
    SAMPLE_DSLOPE,
    SAMPLE_NUMBERS = 24
};
static_assert(offsetof(fl_wave_sample, t) == SAMPLE_T * sizeof(double) &&
                  offsetof(fl_wave_sample, df) == SAMPLE_DF * sizeof(double) &&
                  offsetof(fl_wave_sample, dflow) == SAMPLE_DFLOW * sizeof(double) &&
                  offsetof(fl_wave_sample, dslope) == SAMPLE_DSLOPE * sizeof(double) &&
                  sizeof(fl_wave_sample) >= SAMPLE_NUMBERS * sizeof(double),
              "as fl_wave_sample has them");

typedef struct {
    _Alignas(64) double h[SAMPLE_NUMBERS][FL_BODY_BATCH];
    double past[FL_BODY_BATCH], over[FL_BODY_BATCH],
        reach[FL_BODY_BATCH]; /* over: height of still water above the origin */
    double push[3][FL_BODY_BATCH], turn[3][FL_BODY_BATCH], flow[3][FL_BODY_BATCH]; /* out */
} sampled_lanes;

FL_SIMD4_VERSIONS static void load_samples(sampled_lanes *r, const fl_wave_sample *h, const int32_t *at,
                                           int32_t lanes)
{
    for (int32_t k = 0; k < lanes; k += FL_SIMD_WIDTH)
        for (int c = 0; c < SAMPLE_NUMBERS; c += FL_SIMD_WIDTH)
            fl_body_batch_gather4(r->h + c, (const double *)(const void *)h + c, sizeof *h, at, k);
}

/* extrapolate_sample() of environment.c; returns how many float as prisms. */
FL_SIMD_VERSIONS static double add_sampled_buoyancy(prism_lanes *restrict q, sampled_lanes *restrict r,
                                                    fl_body_batch *restrict a, fl_vec3 along, double weight)
{
    double afloat = 0.0;
#pragma omp simd reduction(+ : afloat)
    for (int32_t i = 0; i < a->lanes; i++) {
        const fl_rows3 R = fl_body_batch_axes(a, i);
        const double past = r->past[i], z = r->h[SAMPLE_Z][i] + past * r->h[SAMPLE_DZ][i],
                     slope = r->h[SAMPLE_SLOPE][i] + past * r->h[SAMPLE_DSLOPE][i];
        const double c = 1.0 / sqrt(1.0 + slope * slope), level = c * (z + r->over[i]);
        const fl_vec3 up = v3_scale(c, v3_madd(R.z, -slope, r3_tmul(R, along)));
        const prism_submerged w = submerge_lane(q, i, up, level, r->reach[i]);
        const fl_vec3 force = v3_scale(weight / c * w.volume, up), moment = v3_cross(w.centre, force);
        const fl_vec3 f = v3_add(r3_mul(R, force), v3_madd(FL_BODY_BATCH_VEC(r->h + SAMPLE_F, i), past,
                                                           FL_BODY_BATCH_VEC(r->h + SAMPLE_DF, i))),
                      t = v3_add(r3_mul(R, moment), v3_madd(FL_BODY_BATCH_VEC(r->h + SAMPLE_T, i), past,
                                                            FL_BODY_BATCH_VEC(r->h + SAMPLE_DT, i)));
        q->floats[i] = w.floats;
        afloat += w.floats;
        fl_body_batch_set_vec(r->push, i, f);
        fl_body_batch_set_vec(r->turn, i, t);
        fl_body_batch_set_vec(r->flow, i,
                              v3_madd(FL_BODY_BATCH_VEC(r->h + SAMPLE_FLOW, i), past,
                                      FL_BODY_BATCH_VEC(r->h + SAMPLE_DFLOW, i)));
        fl_body_batch_set_vec(a->f, i, v3_add(FL_BODY_BATCH_VEC(a->f, i), f));
        fl_body_batch_set_vec(a->t, i, v3_add(FL_BODY_BATCH_VEC(a->t, i), t));
    }
    return afloat;
}

/* Force on the planes fitted to the waves. */
static double force_from_samples(fl_environment *s, const fl_bodies *b, fl_body_batch *a, prism_lanes *q)
{
    sampled_lanes r;
    for (int32_t k = 0; k < a->lanes; k++) {
        const int32_t i = a->index[k];
        r.past[k] = s->time - s->sample[i].when;
        r.over[k] = s->level - b->x[i].z;
        r.reach[k] = s->drag_radius[i];
    }
    load_samples(&r, s->sample, a->index, a->lanes);
    load_prisms(q, s, a);
    const double afloat = add_sampled_buoyancy(q, &r, a, s->wave.direction, s->specific_weight);
    for (int32_t k = 0; k < a->n; k++) {
        const int32_t i = a->index[k];
        s->water_force[i] = FL_BODY_BATCH_VEC(r.push, k), s->water_moment[i] = FL_BODY_BATCH_VEC(r.turn, k),
        s->flow_velocity[i] = FL_BODY_BATCH_VEC(r.flow, k);
        if (b->added_mass) b->flow_velocity[i] = s->flow_velocity[i];
    }
    return afloat;
}

/* Force in still water. */
static double force_on_still_water(fl_environment *s, const fl_bodies *b, fl_body_batch *a, prism_lanes *q)
{
    lane_buffers room;
    _Alignas(64) double centre[FL_BODY_BATCH]; /* height of the submerged centres above still water [m] */
    double *const wetted = fl_body_batch_buffer(a, s->wetted_area, room.wetted);
    double *const lift = fl_body_batch_buffer(a, s->buoyancy, room.lift);
    const double *const reach = fl_body_batch_gather(a, s->drag_radius, room.reach);
    int32_t lane = 0;
    double afloat = a->lanes;
    do q->level[lane] = s->level - b->x[a->index[lane]].z;
    while (++lane < a->lanes);
    const int away = fabs(q->level[0]) < reach[0] ? 0 : all_dry_or_wet(q->level, reach, a->lanes);
    if (away) {
        add_dry_or_wet(s, q->level, a, away > 0, wetted, lift, centre);
    } else {
        load_prisms(q, s, a);
        afloat = add_prism_buoyancy(q, a, s->specific_weight, reach, wetted, lift, centre);
    }
    fl_body_batch_scatter(a, s->wetted_area, wetted), fl_body_batch_scatter(a, s->buoyancy, lift);
    update_flow(s, b, a, centre);
    return afloat;
}

int32_t fl_still_water_batch_force(fl_environment *s, const fl_bodies *b, fl_body_batch *a,
                                   int32_t left[FL_BODY_BATCH])
{
    prism_lanes q;
    const double afloat = s->waves ? force_from_samples(s, b, a, &q) : force_on_still_water(s, b, a, &q);
    int32_t others = 0;
    for (int32_t k = 0; k < a->n && s->drag_surface && !s->waves; k++) {
        if (afloat < a->lanes && !(q.floats[k] > 0.0)) continue; /* the scalar path updates it */
        fl_environment_update_surface(s, b, a->index[k], FL_BODY_BATCH_VEC(a->R + 6, k), q.level[k]);
    }
    for (int32_t k = 0; k < a->n && afloat < a->lanes; k++)
        if (!(q.floats[k] > 0.0)) left[others++] = k;
    return others;
}
