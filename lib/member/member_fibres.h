/* SPDX-License-Identifier: GPL-3.0-or-later */
/* member_fibres.h -- elastic-plastic pieces: the cross-section as fibres that yield.
 *
 * A fibre at (y, z) of the section has the strain
 *     eps = e0 + z ky - y kz,    e0 = stretch/L,  ky = th_y/L,  kz = th_z/L
 * of its piece, and the stress s = E (eps - p) with the plastic strain p. It yields where |s - C p| exceeds
 * sigma (kinematic hardening, C = E H/(E - H) with the tangent modulus H; 0: perfectly plastic):
 *     dp = (|s - C p| - sigma)/(E + C), signed as s - C p                       (return mapping)
 * All plastic strains together act as a stretch and curvatures of the unloaded piece,
 *     e0p = sum a p/A,   kyp = sum a p z/Iy,   kzp = -sum a p y/Iz,
 * so that the forces of member_contact.h follow with these subtracted. Shear and torsion stay elastic.
 *
 * p depends on the history: each evaluation starts from the strains of the last commit, so that the
 * iterations of a relaxation leave no trace.  A point of a path, or a substep of a motion, is committed.
 * A piece ruptures at the commit after the strain of a fibre was above the limit.
 * Fibres have area and both second moments of the section exactly. A pipe has 40 about its circumference,
 * in one layer where its wall is thin; a rectangle 16 x 16. Fully plastic moments are within 0.5 %.
 * Limits: small strain; one section a piece, at its middle, so that a plastic hinge is as long as a piece,
 * and the collapse load of a frame is too high by up to half a piece over the distance of its hinges.
 * Pieces with a hinge at one end stay elastic.
 * Source: Simo & Hughes, Computational Inelasticity (1998), ch. 1. */
#ifndef FL_MEMBER_MEMBER_FIBRES_H
#define FL_MEMBER_MEMBER_FIBRES_H
#include <stdint.h>
#include "base/err.h"
#include "member/member_section.h"

typedef struct {
    int n;
    double *y, *z, *a; /* [n] */
    double area, iy, iz;
    double e, yield, back; /* E, sigma, C */
    double limit;          /* strain at which a piece ruptures, INFINITY: never */
    double reach;          /* distance of the farthest fibre */
} fl_member_fibre_section;

typedef struct fl_member_fibres {
    const fl_member_fibre_section *section; /* borrowed */
    int32_t contact;
    double *plastic, *trial; /* [n] p at the last commit; at the last evaluation */
    double deform[3];        /* e0p, kyp, kzp at the last evaluation */
    double stored;           /* elastic energy of the fibres then, and of hardening */
    double flow;             /* work of yielding since the commit */
    double dissipated;       /* the same until the commit, with the energy released by rupture */
    double strain;           /* largest |eps| then */
    int32_t yielded;         /* p is not 0 everywhere */
    int changed;             /* trial differs from plastic */
    int32_t ruptured;
    int frozen; /* no fibre yields in this evaluation, as after reading a state */
} fl_member_fibres;

/* Fibres of a pipe, rectangle or bar; -1 with FL_SYSTEM. */
int fl_member_fibre_section_make(fl_member_fibre_section *f, const fl_member_section *s, fl_err *err);
void fl_member_fibre_section_free(fl_member_fibre_section *f);

/* Evaluates a piece of length L: trial, deform, stored, flow, strain.
 *   stretch           of the piece [length]
 *   turn_y, turn_z    relative rotation about y and z [rad] */
void fl_member_fibres_update(fl_member_fibres *f, double length, double stretch, double turn_y,
                             double turn_z);

/* Plastic strains become those of the last evaluation. Returns 1 if the piece ruptures: its `energy` is
 * dissipated then.  Else 0. */
int fl_member_fibres_commit(fl_member_fibres *f, double energy);

#endif
