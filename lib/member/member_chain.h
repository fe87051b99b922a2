/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_chain.h -- the balls and contacts of a structure of members, and one step of their relaxation.
 *
 * A ball stands for each node, and pieces - 1 for each member between its nodes; a contact joins neighbours
 * (member_contact.h).  d is the displacement of a ball since the start, q its rotation; both are totals, so
 * a state is described by d and q alone.
 *
 * Masses are fictitious.  Each contact gives both of its balls
 *     m += s dt2 max(EA/L, 12 EI/L3),    I += s dt2 [max(EI, GJ)/L + L2/4 (12 EI/L3 + c sin(t/2)2 EA/L)]
 * (hinged: EA/L, and 3 EI/L to the ball that transmits moments; to a ball with an arm a twice m, and 2 m a2
 * to I, since the end moves by v + w x a), which keeps omega2 below 3.5/(s dt2) by Rayleigh's theorem; s = 2,
 * since thick short pieces fail at s = 1 (Ye & Xu, Engineering Mechanics 41(3), 2024, and our own).  The last
 * term is the lever that the axial force of a bent piece has about its balls, t its relative rotation:
 * without it slender pieces fail at 0.2 rad.  It is renewed before each point.
 *
 * A step with load factor lambda, internal force F and damping c1, c2 (body/relaxation.h):
 *     v <- c1 v + c2 dt (lambda P - F)/m,   d <- d + dt v,   and the same for rotations, q <- exp(dt w) q
 *
 * Results have the same bits for any number of threads: contacts write their own record, a ball sums its
 * contacts in their order, and sums over balls go by groups of FL_MEMBER_GROUP in their order. */
#ifndef FL_MEMBER_MEMBER_CHAIN_H
#define FL_MEMBER_MEMBER_CHAIN_H
#include "member/member_contact.h"
#include "member/member_lanes.h"
#include "member/member_model.h"

enum { FL_MEMBER_GROUP = 128 };

/* Load of a ball at load factor 1; `turned` is the rotation in the path so far, for the work of the moment.
 * */
typedef struct {
    int32_t ball;
    fl_vec3 force, moment, turned;
} fl_member_load;

/* Imposed displacement at load factor 1. */
typedef struct {
    int32_t ball;
    int bits;
    fl_vec3 move, turn;
} fl_member_move;

typedef struct {
    int32_t balls, contacts, loads, moves, nodes;
    fl_member_ball *ball;       /* [balls], nodes first */
    fl_member_contact *contact; /* [contacts], member by member */
    fl_member_beams *beams;     /* [beam_sets] constants of the plain beam contacts, four by four */
    int32_t *other;             /* [others] the other contacts */
    int32_t beam_sets, others;
    fl_member_load *load; /* [loads] by ball */
    fl_member_move *move;
    fl_member_force *force;          /* [contacts] */
    fl_member_resist *resist, *last; /* [balls]; of the present and of the last evaluation */
    int32_t *first, *around;      /* contacts of ball b: around[first[b] .. first[b + 1]), 2 c + (b is j) */
    double *part;                 /* sums of groups */
    double dt, length, load_norm; /* mean length of a piece; |P0|, moments over length */
    double largest_rotation2;     /* of a piece at the last evaluation [rad2] */
    int threads;                  /* that share a step */
    int32_t yielding;             /* pieces of sections that yield */
    fl_member_fibres *fibres;     /* [yielding] */
    double *fibre_strains;        /* of all of them, plastic and trial */
    fl_member_fibre_section *fibre_section; /* [sections of the model] n = 0: elastic */
    int32_t sections;
} fl_member_chain;

/* Where an end of a contact is, and where it was at the start: at the ball, or at its arm. */
static inline fl_vec3 fl_member_contact_end(const fl_member_chain *c, const fl_member_contact *e, int end)
{
    const fl_member_ball *b = &c->ball[end ? e->j : e->i];
    const fl_vec3 x = v3_add(b->x0, b->d);
    return e->arms ? v3_add(x, q_rotate(b->q, e->arm[end])) : x;
}
static inline fl_vec3 fl_member_contact_start(const fl_member_chain *c, const fl_member_contact *e, int end)
{
    const fl_vec3 x = c->ball[end ? e->j : e->i].x0;
    return e->arms ? v3_add(x, e->arm[end]) : x;
}

/* -1 with FL_INPUT or FL_SYSTEM. */
int fl_member_chain_make(fl_member_chain *c, const fl_member_model *m, double dt, fl_err *err);
void fl_member_chain_free(fl_member_chain *c); /* accepts a zeroed struct, leaves one */

/* Masses for the present state.
 *   margin  c of the lever of the axial force */
void fl_member_chain_masses(fl_member_chain *c, double margin);

/* Whether a load moves a free translation, as lengths of arcs need. */
int fl_member_chain_has_force(const fl_member_chain *c);

/* Size of the forces at imposed displacements at the last evaluation, moments over the length of a piece. */
double fl_member_chain_reaction(const fl_member_chain *c);

/* Internal forces of the present state into resist, the former ones into last. */
void fl_member_chain_forces(fl_member_chain *c);

/* Elastic energy of the present state, and the square of the largest rotation of a piece. */
double fl_member_chain_energy(fl_member_chain *c);

/* Plastic strains become those of the last evaluation, and pieces beyond their limit of strain part: their
 * number. 0 at once where no section yields. */
int32_t fl_member_chain_commit(fl_member_chain *c);

/* Work of yielding and parting so far, of the present state. */
double fl_member_chain_plastic(const fl_member_chain *c);

/* Positions and rotations of balls with imposed displacements at that load factor. */
void fl_member_chain_impose(fl_member_chain *c, double lambda);

/* What a step has to know of the forces and velocities before it. */
typedef struct {
    double
        residual2;  /* |lambda P - F|2 of the free freedoms, moments divided by the mean length of a piece */
    double along;   /* (lambda P - F).P */
    double inertia; /* u.M u of the last displacement u */
    double work;    /* u.(F - F_last) */
} fl_member_state;
fl_member_state fl_member_chain_state(const fl_member_chain *c, double lambda);

/* First part of a step: velocities without the load, and displacements where there is no load.
 *   from   NULL, or [balls] displacements e from which lengths are counted
 *   aa, the sum of |d - e|2 as it will be without load */
typedef struct {
    double aa;             /* |d - e + dt v|2 over the free translations, without load */
    double ab;             /* (d - e + dt v).b,  b = c2 dt2 P/m */
    double bb;             /* b.b */
    double db;             /* (d - e).b before the step */
    double work_a, work_b; /* P.(d + dt v), P.b with the moments' parts */
    double kinetic;        /* of balls without load; those with load are added in the second part */
} fl_member_half;
fl_member_half fl_member_chain_free_step(fl_member_chain *c, double c1, double c2, const fl_vec3 *from);

/* Second part: the balls with loads.  Returns their kinetic energy. */
double fl_member_chain_loaded_step(fl_member_chain *c, double c2, double lambda);

/* All velocities become 0. */
void fl_member_chain_rest(fl_member_chain *c);

/* |d - e|2 of the free translations, e = 0 for NULL. */
double fl_member_chain_length2(const fl_member_chain *c, const fl_vec3 *from);

/* Work of the loads at load factor 1: P.d, moments by their rotation. */
double fl_member_chain_work(const fl_member_chain *c);

#endif
