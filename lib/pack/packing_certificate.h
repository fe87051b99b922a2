/* SPDX-License-Identifier: GPL-3.0-or-later */
/* packing_certificate.h -- measures of a packing: grading, density, overlaps, balance, contacts, fabric.
 *
 * Contacts are pairs that overlap by more than 2e-6 of the radius, and such overlaps with the boundary.  Z
 * is their mean number per body; rattlers are bodies with fewer than D + 1 contacts (spheres and discs; D =
 * 2, 3), found again until none is left, and Z* is the mean number of the others among themselves and with
 * the boundary.  A packing without force has no contacts.
 *
 * Fabric: the tensor F = <n n> of the directions n of contacts between bodies, and its principal values; of
 * an isotropic packing they are 1/D.  Order: Q6^2 = <P6(n_i . n_j)> over pairs of contacts, 0 for a liquid,
 * 0.575 for a face-centred crystal (P6 Legendre's polynomial; of more than CONTACTS contacts every k-th).
 * Source: Steinhardt, Nelson & Ronchetti, Phys. Rev. B 28 (1983) 784.
 *
 * Grading: largest distance of the curve by mass, and of that by number (Kolmogorov and Smirnov), from the
 * curves asked with sizes times s. */
#ifndef FL_PACK_PACKING_CERTIFICATE_H
#define FL_PACK_PACKING_CERTIFICATE_H
#include <stdio.h>
#include "pack/grading.h"
#include "pack/overlap_energy.h"
#include "pack/pack_layers.h"

typedef struct {
    double solid, rounded;      /* phi by outer shapes, and by Steiner's formula */
    double least, most;         /* sizes [m] */
    double mass_gap, count_gap; /* grading */
    double largest_share;       /* of the solid volume in the largest body */
    double max_overlap;         /* over the smaller bounding radius */
    double mean_overlap;        /* of contacts [m] */
    double unbalanced;          /* largest force on a body over the mean force of contacts; 0 without */
    int64_t contacts, wall_contacts;
    double coordination, without_rattlers;
    int32_t rattlers;
    double fabric[3]; /* principal values, descending */
    double q6;        /* three dimensions */
    double room;      /* smallest distance from the complement over the radius */
    int32_t outside;  /* bodies further outside than 1e-3 of the radius */
} fl_packing_certificate;

/* o: of the packing, evaluated.  g: NULL for none.  -1 with FL_SYSTEM. */
int fl_packing_certify(fl_packing_certificate *c, fl_overlaps *o, const fl_grading *g, fl_err *err);

/* What has its centre in a layer. */
typedef struct {
    int32_t bodies;
    double volume;      /* solid [m3]; in two dimensions the area [m2] */
    double least, most; /* sizes [m] */
    double mass_gap;    /* largest distance of the curve by mass from that of the layer */
} fl_packing_layer;

/* Layer k of l, l->n for the rest.  -1 with FL_SYSTEM. */
int fl_packing_layer_measure(fl_packing_layer *out, const fl_packing *p, const fl_pack_layers *l, int32_t k,
                             fl_err *err);

/* Directions of the contacts between bodies, with the smaller angle to x, in bins over half a turn in the
 * plane of x and y, in three dimensions of x and z. */
enum { FL_ROSE_BINS = 36 };
void fl_packing_rose(const fl_overlaps *o, double share[FL_ROSE_BINS]);

#endif
