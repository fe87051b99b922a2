/* SPDX-License-Identifier: GPL-3.0-or-later */
/* contact_law.h -- the table of contact laws that `contact.law` of a scene can name.
 *
 * A row states what the rest of the program has to know of a law.  The row is read by the scene reader
 * (choices and keys), the pair law, the pair geometry and force, the sphere lists, the critical step and
 * the plan.  A new law is one row, with its formulae in a header of this folder where none of the existing
 * ones serves.
 *
 *   patch             W = c sqrt(U), U an integral over faces, edges and vertices; patch/patch_law.h
 *   quick             the same W for two floes from fewer and cheaper terms; patch/quick_law.h
 *   core              F = k s^n at the closest point of the two cores, n of the scene; normal.h
 *   manual, manual-si the contact of two features by the formulae of the DilatedDEM manual; manual.h
 *
 * A core that is round to a law has Hertz' F = k s^(3/2) in all of them.  Where the law of features does not
 * apply, on meshes and planes of the structure, `patch` stands in; so it does for `core` on meshes. */
#ifndef FL_LAW_CONTACT_LAW_H
#define FL_LAW_CONTACT_LAW_H
#include <stdint.h>

/* What is evaluated for a pair of bodies. */
enum fl_contact_points {
    FL_POINTS_PATCH,   /* the integral over the contact patch */
    FL_POINTS_NEAREST, /* springs at the closest points of the cores */
    FL_POINTS_FEATURES /* one contact of two features: vertices, edges, faces */
};

/* How a contact is damped. */
enum fl_contact_damping {
    FL_DAMPING_IMPACT, /* Hunt and Crossley, F (1 + chi u), by the number D = chi v_impact; damping.h */
    FL_DAMPING_RATIO   /* zeta of a linear spring, alpha of Tsuji for an exponent 3/2; manual.h */
};

enum { FL_CONTACT_LAW_KEYS = 4 };

typedef struct {
    const char *name; /* the word of contact.law */
    const char
        *keys[FL_CONTACT_LAW_KEYS]; /* keys of [contact] that this law uses and not all laws do; NULL ends */
    enum fl_contact_points points;
    int32_t round_vertices; /* cores of at most so many vertices are round: 1 points, 2 segments as well */
    double face_ratio;      /* stiffness of a whole face over that of one point */
    enum fl_contact_damping damping;
    int end_speed; /* damping uses the approach speed predicted for the end of the step, damping.h */
    int quick;     /* pairs of polyhedra go by patch/quick_law.h where it applies, by `patch` where not */
    int spheres;   /* contacts of spheres are evaluated in batches, sphere_batch.h */
    int si;        /* formulae of the manual with consistent units */
} fl_contact_law;

extern const fl_contact_law fl_contact_laws[];
extern const int32_t fl_contact_law_count;

/* For the key contact.law: the names in the order of the table, separated by "|", and what they mean. */
extern const char fl_contact_law_choices[], fl_contact_law_meaning[];

/* True if the law uses that key of [contact], one of those that not all laws use. */
int fl_contact_law_uses(const fl_contact_law *law, const char *key);

/* Share of the largest stable step 2/omega that damping by the speed half a step ago leaves.
 *   D            number of an impact (FL_DAMPING_IMPACT)
 *   zeta, alpha  ratios              (FL_DAMPING_RATIO) */
double fl_contact_law_stable_share(const fl_contact_law *law, double D, double zeta, double alpha);

/* The same of a contact that is `times` as stiff and as damped.  share: the result of the function above. */
double fl_contact_law_scaled_share(const fl_contact_law *law, double D, double share, double times);

#endif
