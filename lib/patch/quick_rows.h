/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_rows.h -- constants of the law `quick` (quick_law.h), and sums of its terms over one direction,
 * in the frame of the other core.
 *
 * Four terms are found side by side, one a lane; then they are added one by one.  So a term
 * of 0 changes no bit, and terms may be grouped in any way. */
#ifndef FL_PATCH_QUICK_ROWS_H
#define FL_PATCH_QUICK_ROWS_H
#include "base/simd.h"
#include "geom/sym3.h"
#include "patch/force_sum.h"
#include "patch/quick_list.h"

#define FL_QUICK_PARALLEL 0.01 /* sin^2 of the angle of edges from which on they cross */
#define FL_QUICK_TAPER                                                                                       \
    0.3 /* over R, across the other edge: from the end of an edge to where a crossing counts whole */
#define FL_QUICK_FLAT 0.004     /* sine of the angle of two faces up to which they bear their edges */
#define FL_QUICK_TILTED 0.025   /* from which on edges bear beside them */
#define FL_QUICK_NEARNESS 0.6   /* over R, of D: see v */
#define FL_QUICK_FACE_ONLY 0.85 /* cosine of 31.8 degrees */

/* Scratch of one thread.  Zeroed to start; grows as needed. */
typedef struct {
    void *polygon, *height, *support;
    int32_t polygon_cap, height_cap, support_cap;
} fl_quick_scratch;

void fl_quick_scratch_free(fl_quick_scratch *w);

/* Order of the numbers.  The gradient is minus that of U, on the own core; e, x, as in fl_quick_sums. */
enum {
    FL_QUICK_U,
    FL_QUICK_REACH,
    FL_QUICK_DDU,
    FL_QUICK_E,
    FL_QUICK_F,
    FL_QUICK_EX = FL_QUICK_F + 3, /* of e x, x component */
    FL_QUICK_M,
    FL_QUICK_EY = FL_QUICK_M + 3,
    FL_QUICK_DIRECTION,
    FL_QUICK_EZ = FL_QUICK_DIRECTION + 3,
    FL_QUICK_XX,
    FL_QUICK_XY,
    FL_QUICK_XZ,
    FL_QUICK_YY,
    FL_QUICK_YZ,
    FL_QUICK_ZZ,
    FL_QUICK_ROWS = FL_QUICK_ZZ + 3
};

typedef struct {
    double a[FL_QUICK_ROWS];
} fl_quick_total;

/* Lanes of terms: a number a row. */
typedef struct {
    fl_simd a[FL_QUICK_ROWS];
} fl_quick_lanes;

/* A term along the unit normal n at x, the middle of the overlap: u, du = dU/ds, ddu. */
#define FL_QUICK_SET_POINT(l, u_, du_, ddu_, n_, x_)                                                         \
    do {                                                                                                     \
        const fl_simd p_ = (du_), fx_ = p_ * (n_)[0], fy_ = p_ * (n_)[1], fz_ = p_ * (n_)[2];                \
        const fl_simd ex_ = p_ * (x_)[0], ey_ = p_ * (x_)[1], ez_ = p_ * (x_)[2];                            \
        (l)->a[FL_QUICK_U] = (u_), (l)->a[FL_QUICK_REACH] = (l)->a[FL_QUICK_E] = p_;                         \
        (l)->a[FL_QUICK_DDU] = (ddu_);                                                                       \
        (l)->a[FL_QUICK_F] = (l)->a[FL_QUICK_DIRECTION] = fx_,                                               \
        (l)->a[FL_QUICK_F + 1] = (l)->a[FL_QUICK_DIRECTION + 1] = fy_;                                       \
        (l)->a[FL_QUICK_F + 2] = (l)->a[FL_QUICK_DIRECTION + 2] = fz_;                                       \
        (l)->a[FL_QUICK_M] = (x_)[1] * fz_ - (x_)[2] * fy_;                                                  \
        (l)->a[FL_QUICK_M + 1] = (x_)[2] * fx_ - (x_)[0] * fz_;                                              \
        (l)->a[FL_QUICK_M + 2] = (x_)[0] * fy_ - (x_)[1] * fx_;                                              \
        (l)->a[FL_QUICK_EX] = ex_, (l)->a[FL_QUICK_EY] = ey_, (l)->a[FL_QUICK_EZ] = ez_;                     \
        (l)->a[FL_QUICK_XX] = ex_ * (x_)[0], (l)->a[FL_QUICK_XY] = ex_ * (x_)[1];                            \
        (l)->a[FL_QUICK_XZ] = ex_ * (x_)[2], (l)->a[FL_QUICK_YY] = ey_ * (x_)[1];                            \
        (l)->a[FL_QUICK_YZ] = ey_ * (x_)[2], (l)->a[FL_QUICK_ZZ] = ez_ * (x_)[2];                            \
        (l)->a[FL_QUICK_ZZ + 1] = (l)->a[FL_QUICK_ZZ + 2] = FL_SIMD_SPLAT(0.0);                              \
    } while (0)

/* Adds the lanes, lane 0 first. */
FL_SIMD_INLINE void fl_quick_add_lanes(fl_quick_total *to, const fl_quick_lanes *l)
{
    FL_SIMD_UNROLL
    for (int c = 0; c < FL_QUICK_ROWS; c += FL_SIMD_WIDTH) {
        fl_simd r[FL_SIMD_WIDTH] = {l->a[c], l->a[c + 1], l->a[c + 2], l->a[c + 3]};
        fl_simd_transpose(r);
        fl_simd sum = FL_SIMD_LOAD(to->a + c);
        FL_SIMD_UNROLL
        for (int k = 0; k < FL_SIMD_WIDTH; k++) sum += r[k];
        FL_SIMD_STORE(to->a + c) = sum;
    }
}

/* to += s t */
FL_SIMD_INLINE void fl_quick_add_total(fl_quick_total *to, double s, const fl_quick_total *t)
{
    for (int c = 0; c < FL_QUICK_ROWS; c++) to->a[c] += s * t->a[c];
}

static inline void fl_quick_add_wrench(fl_quick_total *to, double s, fl_wrench g)
{
    double *const a = to->a;
    a[FL_QUICK_F] += s * g.f.x, a[FL_QUICK_F + 1] += s * g.f.y, a[FL_QUICK_F + 2] += s * g.f.z;
    a[FL_QUICK_M] += s * g.m.x, a[FL_QUICK_M + 1] += s * g.m.y, a[FL_QUICK_M + 2] += s * g.m.z;
}

/* h(x) = x^3 (10 - 15x + 6x^2), for x between 0 and 1, and its derivative. */
#define FL_QUICK_STEP(x) ((x) * (x) * (x) * (10.0 + (x) * (6.0 * (x)-15.0)))
#define FL_QUICK_SLOPE(x) (30.0 * ((x) * (1.0 - (x))) * ((x) * (1.0 - (x))))

static inline double fl_quick_step(double x, double *slope)
{
    const double t = x > 0.0 ? x < 1.0 ? x : 1.0 : 0.0;
    *slope = FL_QUICK_SLOPE(t);
    return FL_QUICK_STEP(t);
}

/* Support of edges by a pair of faces, v of quick_law.h. */
typedef struct {
    double share;   /* 1 - v of this pair */
    double reach;   /* d share/dR */
    fl_wrench rise; /* its gradient */
    int32_t face;   /* own face */
} fl_quick_support;

/* Input of one direction. */
typedef struct {
    const fl_quick_shape *own, *other;
    fl_mat3 M; /* from the frame of own to that of other */
    fl_vec3 o;
    double r, rho; /* dilation radius of own, and of its features */
    double R;      /* sum of the radii, without the penetration: to it lengths are relative */
    double reach;  /* with it */
    const fl_quick_list *l;
    int section; /* the first of the list */
} fl_quick_direction;

#endif
