/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bond_list.h -- the bonds of a world: faces (bond/bond.h) and, in disc_list.h, discs of spheres; their
 * set-up, forces in a step, and sums.
 *
 * While a bond stands its two bodies have no contact.  It ends when it bears no load; its bodies then are
 * an ordinary pair again.  Their radii are reduced at first so that they do not touch: the overlap at the
 * end of the bond is the zero of the new contact.  As the overlap falls, the radii grow back, never by more
 * than keeps the contact without force, so that neither force nor energy jumps.  Bodies without a radius
 * cannot be reduced: the energy with which their contact begins is taken from the dissipated energy of the
 * bond.
 *
 * A sphere bonded by a face is not treated as isotropic: its rotation counts, and its pairs are in w->pair.
 */
#ifndef FL_CONTACT_BOND_LIST_H
#define FL_CONTACT_BOND_LIST_H
#include "contact/disc_list.h"
#include "world/world.h"

/* Makes the bonds of the field if [bond] is on; body k of the field is body k, in its pose of the field.
 * The face of a bond is the common face of the sharp shapes at the record's centroid, with the record's
 * area.  Where there is none, as of a sphere and a box, it is a disc across the line of the centres.  The
 * length l is the distance of the centres along the normal.  -1 with FL_SYSTEM, or FL_INPUT for a field
 * without bonds or a bond without length. */
int fl_bond_list_make(fl_world *w, const fl_ice_field *field, fl_err *err);
void fl_bond_list_free(fl_bond_list *s);

/* The bond of i < j with that image of j, -1: none. */
int32_t fl_bond_list_find(const fl_world *w, int32_t i, int32_t j, const int32_t image[3]);

/* True if a bond stands between the two, which then have no contact. */
static inline int fl_bond_list_is_bonded(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    if (fl_disc_list_is_bonded(w, i, j, image)) return 1;
    if (!w->bonds.n) return 0;
    const int32_t k = fl_bond_list_find(w, i, j, image);
    return k >= 0 && w->bonds.bond[k].state != FL_BOND_ENDED;
}

/* Sets bond and radius_factor of a new pair, whose image is set, from a bond that has ended. */
void fl_bond_list_init_pair(const fl_world *w, fl_pair *p);

/* After the evaluation of such a pair: restores its radii (R: sum of the radii, distance: of the cores
 * [m]); or, at its first contact, takes the energy from the dissipated energy of the bond. */
void fl_bond_list_restore_radii(fl_world *w, fl_pair *p, double R, double distance);
void fl_bond_list_first_contact(fl_world *w, fl_pair *p);

/* Evaluates bonds [from, to) at the present poses and velocities.  Where one ends the next neighbour search
 * lists the pair.  FL_BOND_LIST_RUN: bonds that a thread takes at a time. */
enum { FL_BOND_LIST_RUN = 64 };
void fl_bond_list_evaluate(fl_world *w, int32_t from, int32_t to);

/* True if body k has bonded faces; if it has bonds of either kind. */
static inline int fl_body_has_faces(const fl_world *w, int32_t k)
{
    return w->bonds.n && k < w->n && w->bonds.first[k] < w->bonds.first[k + 1];
}
static inline int fl_body_has_bonds(const fl_world *w, int32_t k)
{
    return fl_body_has_faces(w, k) || fl_body_has_discs(w, k);
}

/* Adds the forces of the bonds of body k, in their order; or only to its sums of damping and friction. */
void fl_bond_list_add_forces(const fl_world *w, int32_t k, fl_vec3 *f, fl_vec3 *t, fl_contact_sum *sink);
void fl_bond_list_add_sums(const fl_world *w, int32_t k, fl_contact_sum *sink);

/* Bounds of omega^2 of body k by all of its bonds at the start, and by those that stand [1/s2]. */
double fl_bond_list_max_omega2(const fl_world *w, int32_t k);
double fl_bond_list_omega2(const fl_world *w, int32_t k);

/* Ends the bonds of bodies that have left the domain. */
void fl_bond_list_end_absent(fl_world *w);

/* The section load of bond k; the point is inside the periodic cell. */
fl_bond_load fl_bond_list_load(const fl_world *w, int32_t k);

/* Updates the separations at the present poses, after a checkpoint has been read. */
void fl_bond_list_refresh(fl_world *w);

/* Energies of all bonds [J]. */
typedef struct {
    double store;       /* elastic, with the friction springs */
    double spring;      /* of the friction springs */
    double dissipated;  /* by damage */
    double transferred; /* from damage to the friction springs */
    double damped,
        friction_loss; /* by dashpots and friction of discs; those of faces are in the contact sums */
} fl_bond_energies;
fl_bond_energies fl_bond_list_energies(const fl_world *w);

/* Counts and bounds of all bonds. */
typedef struct {
    int32_t state[FL_BOND_ENDED + 1]; /* bonds in each state */
    int32_t left;                     /* discs that have left with a sphere, and were not broken */
    int32_t coarse;                   /* bonds whose fracture energy is above G_I */
    double energy;                    /* mean fracture energy in mode I [J/m2] */
    double longest, limit;            /* largest l; smallest limit of l without snap-back [m] */
    double area;                      /* broken or ended [m2] */
} fl_bond_counts;
fl_bond_counts fl_bond_list_counts(const fl_world *w);

#endif
