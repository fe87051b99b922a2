/* SPDX-License-Identifier: GPL-3.0-or-later */
/* leaving.h -- spheres that leave the domain between two steps, with their contacts and bonds, so that the
 * ledger can book what goes with them without the energies of all bodies. */
#ifndef FL_SPHERE_LEAVING_H
#define FL_SPHERE_LEAVING_H
#include "world/world.h"

/* A touching contact of two spheres, one of which leaves. */
typedef struct {
    int32_t c, i, j, image[3]; /* c: its place in the list */
    double k;                  /* kappa of the contact */
} fl_leaving_row;

typedef struct {
    int32_t *body, *touched, *disc; /* those that leave; they and those that they touch or are bonded to;
                                     * the bonds that end; each ascending */
    fl_leaving_row *row;            /* by c */
    int32_t bodies, n_touched, discs, rows;
    int32_t body_cap, touched_cap, disc_cap, row_cap;
} fl_leaving;

void fl_leaving_free(fl_leaving *l);

/* -1 with FL_SYSTEM. */
int fl_leaving_add_body(fl_leaving *l, int32_t k, fl_err *err);
int fl_leaving_add_row(fl_leaving *l, const fl_leaving_row *row, fl_err *err);
int fl_leaving_add_disc(fl_leaving *l, const fl_world *w, int32_t k, fl_err *err);
/* After the last has been added: sorts, and drops what is there twice. */
void fl_leaving_sort(fl_leaving *l);

/* 1 if the ledger of the scene can book bodies one by one. */
int fl_leaving_has_books(const fl_world *w);

/* Adds the contacts and bonds of its bodies.  1; 0 if a body is no sphere or touches other things than
 * spheres, or the ledger cannot book bodies one by one; -1 with FL_SYSTEM. */
int fl_leaving_collect(fl_leaving *l, const fl_world *w, fl_err *err);

/* Energy that goes with them [J]: kinetic, potential, of their contacts along the normal (friction keeps what
 * the springs hold), of their bonds. */
double fl_leaving_energy(const fl_leaving *l, const fl_world *w);

/* Ends their bonds, as fl_disc_list_end_absent(). */
void fl_leaving_end_discs(const fl_leaving *l, fl_world *w);

#endif
