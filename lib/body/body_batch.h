/* SPDX-License-Identifier: GPL-3.0-or-later */
/* body_batch.h -- a few bodies side by side, one array a quantity, so that the formulae of integrate.h take several
 * at a time.  Each body gets the bits that it gets there: fl_kick() and fl_drift() of bodies that
 * nothing holds and that are no balls.  Each has a step of its own.
 *
 *     fl_body_batch_load(), fl_body_batch_update_axes(), fl_body_batch_load_forces(), fl_body_batch_load_pose();
 *     fl_body_batch_kick() or fl_body_batch_kick_momentum(), fl_body_batch_drift();
 *     fl_body_batch_store_velocities(), fl_body_batch_store_pose()
 *
 * Where they move water with them that is taken by fl_body_batch_load_water(), given to what it bears on, and put
 * back by fl_body_batch_store_water(); else it is NULL.
 *
 * What is taken and not put back stays as it was.  Bodies that follow one another and fill their registers
 * are a row, whose arrays are moved whole; others are picked out one by one, and lanes that are left in the
 * last register are filled with the last of them. */
#ifndef FL_BODY_BODY_BATCH_H
#define FL_BODY_BODY_BATCH_H
#include "base/simd.h"
#include "body/body.h"
#include "geom/rows3.h"

enum { FL_BODY_BATCH = 16 };

typedef struct {
    int32_t n, lanes;                     /* bodies, and lanes that are filled: n <= lanes <= FL_BODY_BATCH */
    int32_t contiguous;                   /* whether they are one */
    const int32_t *index;                 /* [lanes] which */
    _Alignas(64) double h[FL_BODY_BATCH]; /* half of the step [s] */
    double m[FL_BODY_BATCH], invm[FL_BODY_BATCH], invI[3][FL_BODY_BATCH]; /* what they are, as in body.h */
    double v[3][FL_BODY_BATCH], L[3][FL_BODY_BATCH], w[3][FL_BODY_BATCH];
    double q[4][FL_BODY_BATCH], R[9][FL_BODY_BATCH]; /* R row by row */
    double f[3][FL_BODY_BATCH], t[3][FL_BODY_BATCH];
    double x[3][FL_BODY_BATCH], odometer[FL_BODY_BATCH], bounding_radius[FL_BODY_BATCH];
} fl_body_batch;

/* Of bodies that move water with them, as in body.h. */
typedef struct {
    _Alignas(64) double added_mass[3][FL_BODY_BATCH],
        flow_velocity[3][FL_BODY_BATCH], flow_work[FL_BODY_BATCH];
} fl_body_batch_water;

/* Of 1 to FL_BODY_BATCH bodies at[]: m, invm, invI, q, v, L and w; half of their step is h.  at has room for FL_BODY_BATCH,
 * and is kept. */
void fl_body_batch_load(fl_body_batch *s, const fl_bodies *b, int32_t *at, int32_t n, double h);

/* R of q. */
void fl_body_batch_update_axes(fl_body_batch *s);

/* Of the same: f and t; x, odometer and bound. */
void fl_body_batch_load_forces(fl_body_batch *s, const fl_bodies *b);
void fl_body_batch_load_pose(fl_body_batch *s, const fl_bodies *b);

void fl_body_batch_load_water(fl_body_batch_water *a, const fl_bodies *b, const fl_body_batch *s);

/* f and t of the k-th of them. */
static inline void fl_body_batch_load_force(fl_body_batch *s, const fl_bodies *b, int32_t k)
{
    const fl_vec3 f = b->f[s->index[k]], t = b->t[s->index[k]];
    s->f[0][k] = f.x, s->f[1][k] = f.y, s->f[2][k] = f.z;
    s->t[0][k] = t.x, s->t[1][k] = t.y, s->t[2][k] = t.z;
}

/* Of an array that has a number a body, where theirs are to be written: where they lie, or in room. */
static inline double *fl_body_batch_buffer(const fl_body_batch *s, double *a, double room[FL_BODY_BATCH])
{
    return s->contiguous ? &a[s->index[0]] : room;
}

/* The same, and there they are. */
static inline double *fl_body_batch_gather(const fl_body_batch *s, double *a, double room[FL_BODY_BATCH])
{
    int32_t k = 0;
    if (s->contiguous) return &a[s->index[0]];
    do room[k] = a[s->index[k]];
    while (++k < s->lanes);
    return room;
}

/* And back, what has become of them there. */
static inline void fl_body_batch_scatter(const fl_body_batch *s, double *a, const double *seen)
{
    for (int32_t k = 0; k < s->n && !s->contiguous; k++) a[s->index[k]] = seen[k];
}

/* Weight and nothing else: f = m g, t = 0. */
void fl_body_batch_set_weight(fl_body_batch *s, fl_vec3 gravity);

/* As fl_kick(), by h; wants R. */
void fl_body_batch_kick(fl_body_batch *s, const fl_body_batch_water *a);

/* The same of v and L alone, of bodies that move no water, where w is not asked for before fl_body_batch_drift(),
 * which puts in another. */
void fl_body_batch_kick_momentum(fl_body_batch *s);

/* What such a kick changes: g[0..2] of v, g[3..5] of w, which wants R. */
void fl_body_batch_velocity_change(const fl_body_batch *s, const fl_body_batch_water *a,
                                   double (*g)[FL_BODY_BATCH]);

/* As fl_drift(), by 2 h; with water it wants R, which it renews.  Returns 1; or 0 and nothing is changed when
 * one of them turns by more than a radian or so in that, for which the series here is not made. */
int fl_body_batch_drift(fl_body_batch *s, fl_body_batch_water *a);

void fl_body_batch_store_forces(const fl_body_batch *s, fl_bodies *b);     /* f, t */
void fl_body_batch_store_velocities(const fl_body_batch *s, fl_bodies *b); /* v, L, w */
void fl_body_batch_store_pose(const fl_body_batch *s, fl_bodies *b);       /* x, q, odometer */
void fl_body_batch_store_water(const fl_body_batch *s, const fl_body_batch_water *a,
                               fl_bodies *b); /* carried */

/* For loops over lanes: a vector of the i-th of them; a is const or not, which a function would not take. */
#define FL_BODY_BATCH_VEC(a, i) v3((a)[0][i], (a)[1][i], (a)[2][i])

FL_SIMD_INLINE void fl_body_batch_set_vec(double (*a)[FL_BODY_BATCH], int32_t i, fl_vec3 v)
{
    a[0][i] = v.x, a[1][i] = v.y, a[2][i] = v.z;
}

/* Its axes. */
FL_SIMD_INLINE fl_rows3 fl_body_batch_axes(const fl_body_batch *s, int32_t i)
{
    return (fl_rows3){FL_BODY_BATCH_VEC(s->R, i), FL_BODY_BATCH_VEC(s->R + 3, i),
                      FL_BODY_BATCH_VEC(s->R + 6, i)};
}

/* fl_body_momentum() and fl_body_velocity_of_momentum() with added masses. */
FL_SIMD_INLINE fl_vec3 fl_body_batch_momentum(fl_rows3 R, double m, fl_vec3 added, fl_vec3 v)
{
    return v3_madd(r3_mul(R, v3_mul(added, r3_tmul(R, v))), m, v);
}

FL_SIMD_INLINE fl_vec3 fl_body_batch_velocity(fl_rows3 R, double m, fl_vec3 added, fl_vec3 P)
{
    const fl_vec3 p = r3_tmul(R, P);
    return r3_mul(R, v3(p.x / (m + added.x), p.y / (m + added.y), p.z / (m + added.z)));
}

/* Of vectors that follow each other the four from the k-th on to arrays of their components, and back. */
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

/* The same of four numbers of each of structs of so many bytes. */
FL_SIMD_INLINE void fl_body_batch_unpack4(double (*to)[FL_BODY_BATCH], const void *a, size_t bytes, int32_t k)
{
    const char *at = (const char *)a + (size_t)k * bytes;
    fl_simd r[FL_SIMD_WIDTH];
    FL_SIMD_UNROLL for (int l = 0; l < FL_SIMD_WIDTH; l++) r[l] = FL_SIMD_LOAD(at + (size_t)l * bytes);
    fl_simd_transpose(r);
    FL_SIMD_UNROLL for (int c = 0; c < FL_SIMD_WIDTH; c++) FL_SIMD_STORE(&to[c][k]) = r[c];
}

/* The same of those that are picked out, from k on. */
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
