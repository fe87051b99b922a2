/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rainflow.h -- rainflow counting of load cycles, and fatigue damage by Miner's rule.
 *
 * The input is reduced to turning points.  Of a run of equal values one counts; the first and the last value
 * count as turning points.  Rules:
 *   FL_RAINFLOW_ASTM         ASTM E1049-85, 5.4.4: of the last three points, the range Y is counted when the
 *                            next range X is not smaller.  A range that contains the start counts as half a
 *                            cycle and its first point is dropped; any other counts as one cycle.  The
 *                            remaining ranges count as half cycles: the rule defines its own residue.
 *   FL_RAINFLOW_FOUR_POINT   ISO 12110-2: the inner range of four points is a cycle when neither neighbour is
 *                            smaller.  The residue is treated by one of
 *     FL_RESIDUE_HALF    each of its ranges is half a cycle
 *     FL_RESIDUE_REPEAT  the residue is appended to itself and closes cycles: the load repeats for ever
 *     FL_RESIDUE_NONE    ignored
 * Memory is that of the residue: a rising, then falling list of ranges. */
#ifndef FL_STAT_RAINFLOW_H
#define FL_STAT_RAINFLOW_H
#include <stdint.h>
#include "base/err.h"

enum fl_rainflow_rule { FL_RAINFLOW_ASTM, FL_RAINFLOW_FOUR_POINT, FL_RAINFLOW_RULES };
enum fl_residue { FL_RESIDUE_HALF, FL_RESIDUE_REPEAT, FL_RESIDUE_NONE, FL_RESIDUES };

/* "astm" "iso"; "half" "repeat" "none" */
const char *fl_rainflow_rule_name(int rule);
const char *fl_residue_name(int residue);

typedef struct {
    double range, mean; /* [unit of x], range > 0 */
    double count;       /* 0.5 or 1 */
} fl_cycle;

/* A counter that takes values one by one and stores cycles as they close. */
typedef struct {
    int rule;
    double *point; /* [n] open turning points, the last of them provisional */
    int32_t n, cap;
    fl_cycle *cycle;
    int32_t cycles, cycle_cap; /* closed since the caller last set cycles = 0 */
} fl_rainflow;

/* Add one value.  0, or -1 with FL_SYSTEM in err. */
int fl_rainflow_push(fl_rainflow *f, double x, fl_err *err);

/* End of the record: count the residue.  0, or -1 with FL_SYSTEM in err. */
int fl_rainflow_end(fl_rainflow *f, int residue, fl_err *err);

/* Count a whole record x[n]: the cycles are f->cycle[0 .. f->cycles), in the order in which they close. */
int fl_rainflow_count(fl_rainflow *f, int rule, int residue, int32_t n, const double *x, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_rainflow_free(fl_rainflow *f);

/* An S-N curve: cycles to failure N = a S^-m, and N = a S_k^-m (S / S_k)^-m2 below the knee S_k (0: no knee;
 * m2 = INFINITY: no damage below the knee).  Miner's sum is D = sum n_i / N(S_i).
 * Source: Miner 1945, J. Appl. Mech. 12:A159; the two slopes as in EN 1993-1-9 and DNV-RP-C203. */
typedef struct {
    double m, a, m2, knee;
} fl_sn_curve;

/* Damage of count cycles of range S >= 0. */
double fl_sn_damage(const fl_sn_curve *sn, double range, double count);

/* Equivalent range, the constant range with the same damage as n cycles: (sum n_i S_i^m / sum n_i)^(1/m).  0
 * without cycles. */
double fl_rainflow_equivalent(int32_t n, const fl_cycle *cycle, double m);

#endif
