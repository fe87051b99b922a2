/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body_batch.h -- up to 16 bodies side by side, one array per quantity: fl_kick() and fl_drift() on SIMD
 * lanes.
 *
 * Each body gets the same bits as from integrate.h. A body here has no fixed degree of freedom and is not
 * isotropic. Each has its own step. The order of calls:
 *
 *     fl_body_batch_load(), _update_axes(), _load_forces(), _load_pose();
 *     fl_body_batch_kick() or _kick_momentum(), fl_body_batch_drift();
 *     fl_body_batch_store_velocities(), _store_pose()
 *
 * With added mass, fl_body_batch_load_water() loads the added mass and the flow. They are passed on to kick,
 * drift and drag, and fl_body_batch_store_water() stores the result. Without added mass that argument is
 * NULL.
 *
 * Arrays that are loaded and not stored stay unchanged. A batch is contiguous if its bodies are consecutive
 * and fill whole registers: its arrays move as blocks. Other bodies are gathered one by one, and unused lanes
 * of the last register repeat the last body. */
#ifndef FL_BODY_BODY_BATCH_H
#define FL_BODY_BODY_BATCH_H
#include "base/simd.h"
#include "body/body.h"
#include "geom/rows3.h"

enum { FL_BODY_BATCH = 16 };

typedef struct {
    int32_t n, lanes;                     /* bodies, and filled lanes: n <= lanes <= FL_BODY_BATCH */
    int32_t contiguous;                   /* 1: consecutive bodies that fill all lanes */
    const int32_t *index;                 /* [lanes] body of each lane */
    _Alignas(64) double h[FL_BODY_BATCH]; /* half the step [s] */
    double m[FL_BODY_BATCH], invm[FL_BODY_BATCH], invI[3][FL_BODY_BATCH]; /* constants, as in body.h */
    double v[3][FL_BODY_BATCH], L[3][FL_BODY_BATCH], w[3][FL_BODY_BATCH];
    double q[4][FL_BODY_BATCH], R[9][FL_BODY_BATCH]; /* R row by row */
    double f[3][FL_BODY_BATCH], t[3][FL_BODY_BATCH];
    double x[3][FL_BODY_BATCH], odometer[FL_BODY_BATCH], bounding_radius[FL_BODY_BATCH];
} fl_body_batch;

/* Added mass of the bodies of a batch, as in body.h. */
typedef struct {
    _Alignas(64) double added_mass[3][FL_BODY_BATCH],
        flow_velocity[3][FL_BODY_BATCH], flow_work[FL_BODY_BATCH];
} fl_body_batch_water;

/* Loads m, invm, invI, q, v, L and w of bodies at[0 .. n), 1 <= n <= FL_BODY_BATCH. h is half their step. at
 * has FL_BODY_BATCH elements and is borrowed. */
void fl_body_batch_load(fl_body_batch *s, const fl_bodies *b, int32_t *at, int32_t n, double h);

/* Updates R from q. */
void fl_body_batch_update_axes(fl_body_batch *s);

/* Loads f and t; x, odometer and bounding_radius. */
void fl_body_batch_load_forces(fl_body_batch *s, const fl_bodies *b);
void fl_body_batch_load_pose(fl_body_batch *s, const fl_bodies *b);

void fl_body_batch_load_water(fl_body_batch_water *a, const fl_bodies *b, const fl_body_batch *s);

/* Loads f and t of lane k. */
static inline void fl_body_batch_load_force(fl_body_batch *s, const fl_bodies *b, int32_t k)
{
    const fl_vec3 f = b->f[s->index[k]], t = b->t[s->index[k]];
    s->f[0][k] = f.x, s->f[1][k] = f.y, s->f[2][k] = f.z;
    s->t[0][k] = t.x, s->t[1][k] = t.y, s->t[2][k] = t.z;
}

/* Where to write an array a with one number per body: in place if contiguous, else in room. */
static inline double *fl_body_batch_buffer(const fl_body_batch *s, double *a, double room[FL_BODY_BATCH])
{
    return s->contiguous ? &a[s->index[0]] : room;
}

/* The numbers of a batch in array a: in place if contiguous, else gathered into room. */
static inline double *fl_body_batch_gather(const fl_body_batch *s, double *a, double room[FL_BODY_BATCH])
{
    int32_t k = 0;
    if (s->contiguous) return &a[s->index[0]];
    do room[k] = a[s->index[k]];
    while (++k < s->lanes);
    return room;
}

/* Writes gathered numbers back to array a. Does nothing if contiguous. */
static inline void fl_body_batch_scatter(const fl_body_batch *s, double *a, const double *seen)
{
    for (int32_t k = 0; k < s->n && !s->contiguous; k++) a[s->index[k]] = seen[k];
}

/* Sets f = m g, t = 0. */
void fl_body_batch_set_weight(fl_body_batch *s, fl_vec3 gravity);

/* fl_kick() by h; needs R. */
void fl_body_batch_kick(fl_body_batch *s, const fl_body_batch_water *a);

/* fl_kick() of v and L alone, without added mass; for callers that do not read w before
 * fl_body_batch_drift(), which sets it anew. */
void fl_body_batch_kick_momentum(fl_body_batch *s);

/* Change of v (g[0..2]) and w (g[3..5]) by such a kick; needs R. */
void fl_body_batch_velocity_change(const fl_body_batch *s, const fl_body_batch_water *a,
                                   double (*g)[FL_BODY_BATCH]);

/* fl_drift() by 2 h; with added mass it needs R and updates it. Returns 1, or 0 with nothing changed if a
 * body turns by more than about a radian in the step, beyond the range of the series. */
int fl_body_batch_drift(fl_body_batch *s, fl_body_batch_water *a);

void fl_body_batch_store_forces(const fl_body_batch *s, fl_bodies *b);     /* f, t */
void fl_body_batch_store_velocities(const fl_body_batch *s, fl_bodies *b); /* v, L, w */
void fl_body_batch_store_pose(const fl_body_batch *s, fl_bodies *b);       /* x, q, odometer */
void fl_body_batch_store_water(const fl_body_batch *s, const fl_body_batch_water *a,
                               fl_bodies *b); /* flow_work */

/* Vector of lane i, for loops over lanes. A macro, since a may be const or not. */
#define FL_BODY_BATCH_VEC(a, i) v3((a)[0][i], (a)[1][i], (a)[2][i])

FL_SIMD_INLINE void fl_body_batch_set_vec(double (*a)[FL_BODY_BATCH], int32_t i, fl_vec3 v)
{
    a[0][i] = v.x, a[1][i] = v.y, a[2][i] = v.z;
}

/* R of lane i by rows. */
FL_SIMD_INLINE fl_rows3 fl_body_batch_axes(const fl_body_batch *s, int32_t i)
{
    return (fl_rows3){FL_BODY_BATCH_VEC(s->R, i), FL_BODY_BATCH_VEC(s->R + 3, i),
                      FL_BODY_BATCH_VEC(s->R + 6, i)};
}

/* fl_body_momentum() and fl_body_velocity_of_momentum() with added mass. */
FL_SIMD_INLINE fl_vec3 fl_body_batch_momentum(fl_rows3 R, double m, fl_vec3 added, fl_vec3 v)
{
    return v3_madd(r3_mul(R, v3_mul(added, r3_tmul(R, v))), m, v);
}

FL_SIMD_INLINE fl_vec3 fl_body_batch_velocity(fl_rows3 R, double m, fl_vec3 added, fl_vec3 P)
{
    const fl_vec3 p = r3_tmul(R, P);
    return r3_mul(R, v3(p.x / (m + added.x), p.y / (m + added.y), p.z / (m + added.z)));
}

/* Four consecutive vectors from lane k on to component arrays, and back. */
FL_SIMD_INLINE void fl_body_batch_unpack_vec(double (*to)[FL_BODY_BATCH], const fl_vec3 *a, int32_t k)
{
    fl_simd v[3];
    fl_simd_from_triples(v, &a[k]);
    FL_SIMD_UNROLL for (int c = 0; c < 3; c++) FL_SIMD_STORE(&to[c][k]) = v[c];
}

FL_SIMD_INLINE void fl_body_batch_pack_vec(fl_vec3 *a, const double (*from)[FL_BODY_BATCH], int32_t k)
{
    const fl_simd v[3] = {FL_SIMD_LOAD(&from[0][k]), FL_SIMD_LOAD(&from[1][k]), FL_SIMD_LOAD(&from[2][k])};
    fl_simd_to_triples(&a[k], v);
}

/* The same for four numbers of each of consecutive structs of `bytes` bytes. */
FL_SIMD_INLINE void fl_body_batch_unpack4(double (*to)[FL_BODY_BATCH], const void *a, size_t bytes, int32_t k)
{
    const char *at = (const char *)a + (size_t)k * bytes;
    fl_simd r[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) r[l] = FL_SIMD_LOAD(at + (size_t)l * bytes);
    fl_simd_transpose(r);
    FL_SIMD_UNROLL for (int c = 0; c < FL_SIMD_WIDTH; c++) FL_SIMD_STORE(&to[c][k]) = r[c];
}

/* The same for structs gathered by index, from lane k on. */
FL_SIMD_INLINE void fl_body_batch_gather4(double (*to)[FL_BODY_BATCH], const void *a, size_t bytes,
                                          const int32_t *at, int32_t k)
{
    fl_simd r[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL
    for (int l = 0; l < FL_SIMD_WIDTH; l++) r[l] = FL_SIMD_LOAD((const char *)a + (size_t)at[k + l] * bytes);
    fl_simd_transpose(r);
    FL_SIMD_UNROLL for (int c = 0; c < FL_SIMD_WIDTH; c++) FL_SIMD_STORE(&to[c][k]) = r[c];
}

FL_SIMD_INLINE void fl_body_batch_pack4(void *a, size_t bytes, const double (*from)[FL_BODY_BATCH], int32_t k)
{
    char *at = (char *)a + (size_t)k * bytes;
    fl_simd r[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL for (int c = 0; c < FL_SIMD_WIDTH; c++) r[c] = FL_SIMD_LOAD(&from[c][k]);
    fl_simd_transpose(r);
    FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) FL_SIMD_STORE(at + (size_t)l * bytes) = r[l];
}

#endif
