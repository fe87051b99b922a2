/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_curve.h -- a model of members written line by line, and its path as arrays. */
#ifndef FL_TESTS_MEMBER_CURVE_H
#define FL_TESTS_MEMBER_CURVE_H
#include "member/member_path.h"

enum { POINTS = 2000, WATCH = 3 };

typedef struct {
    int n, limits;
    double s[POINTS], lambda[POINTS], along[POINTS], watch[WATCH][POINTS], balance[POINTS];
    double limit[20], limit_s[20]; /* maxima and minima in their order, and the arc there */
    int64_t steps;
    double largest; /* of |balance| */
} curve;

/* A freedom to watch: node, and 0 .. 2. */
typedef struct {
    const char *node;
    int axis;
} watched;

/* A new model; records are added to it as printf does. */
void model_begin(void);
void model_line(const char *fmt, ...) __attribute__((format(printf, 1, 2)));

/* The model and its chain, in steps of dt. */
void curve_chain(fl_member_model *m, fl_member_chain *c, double dt);

int32_t curve_node(const fl_member_model *m, const char *name);
fl_path_options curve_options(enum fl_relaxation_kind damping, double first, double resolution);

/* Ends the program with the sentence. */
void curve_fatal(const fl_err *err) __attribute__((noreturn));

/* Follows the path of the model until the displacement along the load is `until`, or watch[0] beyond `until0`
 * where that is not 0. */
void curve_follow(curve *out, const fl_path_options *o, double until, double until0, const watched *watch);

/* y where x first passes `at` after the arc s0, by cubics; NAN where it does not. */
double curve_value(const curve *c, const double *y, const double *x, double at, double s0);

/* y at the arc s. */
double curve_at_arc(const curve *c, const double *y, double s);

#endif
