/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_lanes.h -- the parts of a step of a chain that take most of its time, for four contacts or four
 * balls in SIMD lanes.  The bits are those of the functions for one: fl_member_beam() of member_contact.h,
 * and sums and step of a ball in member_chain.c. */
#ifndef FL_MEMBER_MEMBER_LANES_H
#define FL_MEMBER_MEMBER_LANES_H
#include "base/simd.h"
#include "member/member_ball.h"
#include "member/member_contact.h"

/* Constants of four elastic beam contacts without arms, as in fl_member_contact, a row for each. */
typedef struct {
    double e0[4][FL_SIMD_WIDTH], length[FL_SIMD_WIDTH], axial[FL_SIMD_WIDTH];
    double shear[2][FL_SIMD_WIDTH], turn[3][FL_SIMD_WIDTH];
    int32_t i[FL_SIMD_WIDTH], j[FL_SIMD_WIDTH], contact[FL_SIMD_WIDTH];
} fl_member_beams;

/* Whether lanes may stand in for fl_member_beam(). */
static inline int fl_member_is_plain_beam(const fl_member_contact *c)
{
    return c->kind == FL_MEMBER_BEAM && !c->arms && !c->fibres;
}

/* Writes contact e, number k, to one lane. */
void fl_member_beams_set(fl_member_beams *b, int lane, const fl_member_contact *e, int32_t k);

/* Forces of n sets of contacts into force[contact]; returns the largest square of a relative rotation. */
double fl_member_beams_force(const fl_member_beams *b, int32_t n, const fl_member_ball *ball,
                             fl_member_force *force);

/* Internal forces of balls begin .. end - 1 from those of their contacts (member_chain.h: first, around).
 * A number after the last force is read. */
void fl_member_balls_resist(int32_t begin, int32_t end, const int32_t *first, const int32_t *around,
                            const fl_member_force *force, fl_member_resist *resist);

/* Adds the shares of four consecutive balls to residual2, inertia over dt2 and work over dt of a state.
 * 0, and nothing added, if one of them has a support, a load or no freedom to move or turn. */
int fl_member_balls_state(const fl_member_ball *ball, const fl_member_resist *resist,
                          const fl_member_resist *last, double over_l2, double sum[3]);

/* A step of four consecutive balls; adds their shares to aa and to twice the kinetic energy.  0, and nothing
 * done, if one of them is as above, or turns by more than 0.04 rad.
 *   from  NULL, or what d is counted from */
int fl_member_balls_step(fl_member_ball *ball, const fl_member_resist *resist, const fl_vec3 *from, double c1,
                         double c2, double dt, double sum[2]);

#endif
