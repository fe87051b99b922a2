/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/bond_stiffness.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"

/* Sets the two numbers of bond k, and adds its springs to the stiffness of its bodies. */
static void add_shares(const fl_world *w, int32_t k, fl_bond_springs *springs, double omega2[2],
                       fl_stiffness *all)
{
    double own[2];
    int32_t body[2];
    for (int e = 0; e < 2; e++) {
        fl_stiffness K = {0};
        body[e] = springs(w, k, e, 1.0, &K);
        own[e] = fl_stiffness_bound(&K);
    }
    for (int e = 0; e < 2; e++) {
        omega2[e] = own[e] + sqrt(own[0] * own[1]);
        if (own[e] > 0.0) springs(w, k, e, omega2[e] / own[e], &all[body[e]]);
    }
}

int fl_bond_stiffness_bound(const fl_world *w, int32_t n, fl_bond_springs *springs, double **omega2,
                            double **max_omega2, fl_err *err)
{
    fl_stiffness *all = fl_alloc(w->n, sizeof *all, err);
    *omega2 = fl_alloc(2 * (int64_t)n, sizeof **omega2, err);
    *max_omega2 = fl_alloc(w->n, sizeof **max_omega2, err);
    const int ok = all && *omega2 && *max_omega2;
    for (int32_t k = 0; k < n && ok; k++) add_shares(w, k, springs, *omega2 + 2 * (int64_t)k, all);
    for (int32_t i = 0; i < w->n && ok; i++) (*max_omega2)[i] = fl_stiffness_bound(&all[i]);
    free(all);
    return ok ? 0 : -1;
}
