/* SPDX-License-Identifier: GPL-3.0-or-later */
/* few.h -- a few bodies side by side, one array a quantity, so that the formulae of integrate.h take several
 * at a time.  Each body gets the bits that it gets there: fl_kick() and fl_drift() of bodies that
 * nothing holds and that are no balls.  Each has a step of its own.
 *
 *     fl_few_take(), fl_few_axes(), fl_few_take_forces(), fl_few_take_pose();
 *     fl_few_kick() or fl_few_push(), fl_few_drift();
 *     fl_few_put_speeds(), fl_few_put_pose()
 *
 * Where they move water with them that is taken by fl_few_take_water(), given to what it bears on, and put
 * back by fl_few_put_water(); else it is NULL.
 *
 * What is taken and not put back stays as it was.  Bodies that follow one another and fill their registers
 * are a row, whose arrays are moved whole; others are picked out one by one, and lanes that are left in the
 * last register are filled with the last of them. */
#ifndef FL_BODY_FEW_H
#define FL_BODY_FEW_H
#include "base/wide.h"
#include "body/body.h"
#include "geom/rows3.h"

enum { FL_FEW = 16 };

typedef struct {
    int32_t n, lanes;              /* bodies, and lanes that are filled: n <= lanes <= FL_FEW */
    int32_t row;                   /* whether they are one */
    const int32_t *at;             /* [lanes] which */
    _Alignas(64) double h[FL_FEW]; /* half of the step [s] */
    double m[FL_FEW], invm[FL_FEW], invI[3][FL_FEW]; /* what they are, as in body.h */
    double v[3][FL_FEW], L[3][FL_FEW], w[3][FL_FEW];
    double q[4][FL_FEW], R[9][FL_FEW]; /* R row by row */
    double f[3][FL_FEW], t[3][FL_FEW];
    double x[3][FL_FEW], odometer[FL_FEW], bound[FL_FEW];
} fl_few;

/* Of bodies that move water with them, as in body.h. */
typedef struct {
    _Alignas(64) double added[3][FL_FEW], flow[3][FL_FEW], carried[FL_FEW];
} fl_few_water;

/* Of 1 to FL_FEW bodies at[]: m, invm, invI, q, v, L and w; half of their step is h.  at has room for FL_FEW,
 * and is kept. */
void fl_few_take(fl_few *s, const fl_bodies *b, int32_t *at, int32_t n, double h);

/* R of q. */
void fl_few_axes(fl_few *s);

/* Of the same: f and t; x, odometer and bound. */
void fl_few_take_forces(fl_few *s, const fl_bodies *b);
void fl_few_take_pose(fl_few *s, const fl_bodies *b);

void fl_few_take_water(fl_few_water *a, const fl_bodies *b, const fl_few *s);

/* f and t of the k-th of them. */
static inline void fl_few_take_force(fl_few *s, const fl_bodies *b, int32_t k)
{
    const fl_vec3 f = b->f[s->at[k]], t = b->t[s->at[k]];
    s->f[0][k] = f.x, s->f[1][k] = f.y, s->f[2][k] = f.z;
    s->t[0][k] = t.x, s->t[1][k] = t.y, s->t[2][k] = t.z;
}

/* Of an array that has a number a body, where theirs are to be written: where they lie, or in room. */
static inline double *fl_few_room(const fl_few *s, double *a, double room[FL_FEW])
{
    return s->row ? &a[s->at[0]] : room;
}

/* The same, and there they are. */
static inline double *fl_few_see(const fl_few *s, double *a, double room[FL_FEW])
{
    int32_t k = 0;
    if (s->row) return &a[s->at[0]];
    do room[k] = a[s->at[k]];
    while (++k < s->lanes);
    return room;
}

/* And back, what has become of them there. */
static inline void fl_few_keep(const fl_few *s, double *a, const double *seen)
{
    for (int32_t k = 0; k < s->n && !s->row; k++) a[s->at[k]] = seen[k];
}

/* Weight and nothing else: f = m g, t = 0. */
void fl_few_weigh(fl_few *s, fl_vec3 gravity);

/* As fl_kick(), by h; wants R. */
void fl_few_kick(fl_few *s, const fl_few_water *a);

/* The same of v and L alone, of bodies that move no water, where w is not asked for before fl_few_drift(),
 * which puts in another. */
void fl_few_push(fl_few *s);

/* What such a kick changes: g[0..2] of v, g[3..5] of w, which wants R. */
void fl_few_gains(const fl_few *s, const fl_few_water *a, double (*g)[FL_FEW]);

/* As fl_drift(), by 2 h; with water it wants R, which it renews.  Returns 1; or 0 and nothing is changed when
 * one of them turns by more than a radian or so in that, for which the series here is not made. */
int fl_few_drift(fl_few *s, fl_few_water *a);

void fl_few_put_forces(const fl_few *s, fl_bodies *b);                       /* f, t */
void fl_few_put_speeds(const fl_few *s, fl_bodies *b);                       /* v, L, w */
void fl_few_put_pose(const fl_few *s, fl_bodies *b);                         /* x, q, odometer */
void fl_few_put_water(const fl_few *s, const fl_few_water *a, fl_bodies *b); /* carried */

/* For loops over lanes: a vector of the i-th of them; a is const or not, which a function would not take. */
#define FL_FEW_OF(a, i) v3((a)[0][i], (a)[1][i], (a)[2][i])

FL_WIDE_PART void fl_few_set(double (*a)[FL_FEW], int32_t i, fl_vec3 v)
{
    a[0][i] = v.x, a[1][i] = v.y, a[2][i] = v.z;
}

/* Its axes. */
FL_WIDE_PART fl_rows3 fl_few_rows(const fl_few *s, int32_t i)
{
    return (fl_rows3){FL_FEW_OF(s->R, i), FL_FEW_OF(s->R + 3, i), FL_FEW_OF(s->R + 6, i)};
}

/* fl_body_momentum() and fl_body_speed() with added masses. */
FL_WIDE_PART fl_vec3 fl_few_momentum(fl_rows3 R, double m, fl_vec3 added, fl_vec3 v)
{
    return v3_madd(r3_mul(R, v3_mul(added, r3_tmul(R, v))), m, v);
}

FL_WIDE_PART fl_vec3 fl_few_speed(fl_rows3 R, double m, fl_vec3 added, fl_vec3 P)
{
    const fl_vec3 p = r3_tmul(R, P);
    return r3_mul(R, v3(p.x / (m + added.x), p.y / (m + added.y), p.z / (m + added.z)));
}

/* Of vectors that follow each other the four from the k-th on to arrays of their components, and back. */
FL_WIDE_PART void fl_few_split(double (*to)[FL_FEW], const fl_vec3 *a, int32_t k)
{
    fl_wide v[3];
    fl_wide_from_triples(v, &a[k]);
    FL_WIDE_UNROLL for (int c = 0; c < 3; c++) FL_FOUR_INTO(&to[c][k]) = v[c];
}

FL_WIDE_PART void fl_few_join(fl_vec3 *a, const double (*from)[FL_FEW], int32_t k)
{
    const fl_wide v[3] = {FL_FOUR(&from[0][k]), FL_FOUR(&from[1][k]), FL_FOUR(&from[2][k])};
    fl_wide_to_triples(&a[k], v);
}

/* The same of four numbers of each of structs of so many bytes. */
FL_WIDE_PART void fl_few_split4(double (*to)[FL_FEW], const void *a, size_t bytes, int32_t k)
{
    const char *at = (const char *)a + (size_t)k * bytes;
    fl_wide r[FL_LANES];
    FL_WIDE_UNROLL for (int l = 0; l < FL_LANES; l++) r[l] = FL_FOUR(at + (size_t)l * bytes);
    fl_wide_transpose(r);
    FL_WIDE_UNROLL for (int c = 0; c < FL_LANES; c++) FL_FOUR_INTO(&to[c][k]) = r[c];
}

/* The same of those that are picked out, from k on. */
FL_WIDE_PART void fl_few_pick4(double (*to)[FL_FEW], const void *a, size_t bytes, const int32_t *at,
                               int32_t k)
{
    fl_wide r[FL_LANES];
    FL_WIDE_UNROLL
    for (int l = 0; l < FL_LANES; l++) r[l] = FL_FOUR((const char *)a + (size_t)at[k + l] * bytes);
    fl_wide_transpose(r);
    FL_WIDE_UNROLL for (int c = 0; c < FL_LANES; c++) FL_FOUR_INTO(&to[c][k]) = r[c];
}

FL_WIDE_PART void fl_few_join4(void *a, size_t bytes, const double (*from)[FL_FEW], int32_t k)
{
    char *at = (char *)a + (size_t)k * bytes;
    fl_wide r[FL_LANES];
    FL_WIDE_UNROLL for (int c = 0; c < FL_LANES; c++) r[c] = FL_FOUR(&from[c][k]);
    fl_wide_transpose(r);
    FL_WIDE_UNROLL for (int l = 0; l < FL_LANES; l++) FL_FOUR_INTO(at + (size_t)l * bytes) = r[l];
}

#endif
