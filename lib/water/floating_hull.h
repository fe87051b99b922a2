/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floating_hull.h -- waves on a floating structure: the pressure of the water on the closed mesh of a rigid
 * body of structure/rigid_motion.h.
 *
 *     F = -int p n dA - F_0 + M_a a,   T = -int p x x n dA - T_0,   p = rho g (P - z)
 * over the wet part of the mesh at its present pose (Froude and Krylov), with F_0 and T_0 the buoyancy at
 * rest and its moment, which balance the weight. a is the acceleration of the water at the centre of buoyancy
 * at rest, M_a the added mass. In still water this is the restoring force, for any pose. Without wave_error
 * the integral is that of froude_krylov.h in each step, else the body has blocks of time (wave_block.h).
 *
 * Drag is that of floes, drag.h: 1/2 C rho times the wetted area, along the velocity relative to the water at
 * the same centre. With water.drag = facet there is none.
 *
 * Limits: the body does not change the waves: no diffraction but by M_a a, no radiation but M_a and dampers.
 * So it should be short against the waves; slow drift forces are those of the wetted surface alone. */
#ifndef FL_WATER_FLOATING_HULL_H
#define FL_WATER_FLOATING_HULL_H
#include "water/environment.h"

typedef struct {
    fl_wet_mesh mesh;                /* n = 0: the water does not act on this body */
    double size;                     /* largest side of the mesh [m] */
    fl_vec3 centre;                  /* of buoyancy at rest, axes of the body [m] */
    fl_vec3 rest_force, rest_moment; /* F_0, T_0 */
    /* each step */
    fl_poly shape; /* the triangles as faces; v is that of the mesh */
    fl_hull hull;
    fl_hull_panels panels;
    /* in blocks */
    fl_wave_nodes nodes;
    fl_wave_block block;
    /* at the last evaluation, world axes, about the reference of the body */
    fl_vec3 force, moment;  /* [N], [N m] */
    fl_vec3 flow;           /* velocity of the water [m/s] */
    double wetted;          /* [m2] */
    double work, drag_loss; /* so far [J] */
} fl_floating_hull;

typedef struct {
    int32_t n;
    fl_floating_hull *hull;   /* [n] */
    fl_environment *sea;      /* borrowed; its scratch is not used */
    fl_wave_expansion *cells; /* [cell_count] scratch */
    int32_t cell_count;
    fl_wave_node_sample *scratch; /* [scratch_count] */
    int32_t scratch_count;
    fl_wave_guest *guest; /* [n] for the tables of sea */
} fl_floating_hulls;

/* Allocates n bodies without a hull. Returns -1 with FL_SYSTEM. */
int fl_floating_hulls_alloc(fl_floating_hulls *s, int32_t n, fl_environment *sea, fl_err *err);
void fl_floating_hulls_free(fl_floating_hulls *s); /* accepts a zeroed struct, leaves one */

/* Gives body k its mesh: triangles v[3 n], taken over, axes of the body with its reference as origin.
 *   volume, centre   displaced at rest, and its centre [m3], [m]
 * Returns -1 with FL_SYSTEM, or FL_INPUT if the waves are too short. */
int fl_floating_hulls_set(fl_floating_hulls *s, int32_t k, fl_vec3 *v, int32_t n, double volume,
                          fl_vec3 centre, fl_err *err);

/* Lets the tables of the sea reach all bodies with a mesh; once x and the hulls stay where they are. */
void fl_floating_hulls_attach(fl_floating_hulls *s, const fl_bodies *b);

/* True if the water acts on body k. */
static inline int fl_floating_hulls_has(const fl_floating_hulls *s, int32_t k)
{
    return k < s->n && s->hull[k].mesh.n > 0;
}

/* Adds the load at time sea->time to b->f[k], b->t[k], which hold all other forces. */
void fl_floating_hull_force(fl_floating_hulls *s, fl_bodies *b, int32_t k);

/* Evaluates the load again after the block, the pose and the forces of body k have been read. */
void fl_floating_hull_refresh(fl_floating_hulls *s, fl_bodies *b, int32_t k);

/* Adds the work of the load in a kick of h seconds from v0, w0 to the present velocities. */
void fl_floating_hull_add_work(fl_floating_hulls *s, const fl_bodies *b, int32_t k, double h, fl_vec3 v0,
                               fl_vec3 w0);

/* Drag over h seconds. */
void fl_floating_hull_drag(fl_floating_hulls *s, fl_bodies *b, int32_t k, double h);

#endif
