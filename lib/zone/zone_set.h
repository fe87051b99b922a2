/* SPDX-License-Identifier: GPL-3.0-or-later */
/* zone_set.h -- nodes and zones of deformable blocks: forces of the stress, masses, quiet sides, sums.
 *
 * A zone e is a tetrahedron with the volume V_e and the gradients g_a of its four shape functions.  Its
 * deformation gradient F_e = sum x_a g_a^T is constant.  One tetrahedron with that strain alone is too stiff
 * in bending, and in shape changes at constant volume.  The cure is a blend with strains averaged at the
 * nodes,
 *     F_n = sum over zones e of node n of V_e/4 F_e / V_n,   V_n = sum V_e/4,
 *     W = k sum V_e w(F_e) + (1 - k) sum V_n w(F_n),
 * with w of zone_law.h and the share k, 1: plain zones.  k > 0 keeps patterns that the averages do not see.
 * Forces are the exact gradient,
 *     f_a = - sum over zones V_e [k P(F_e) + (1 - k)/4 sum over nodes n of e P(F_n)] g_a.
 * share/doc/zones.md has the measured table from which k is chosen.  Source: Puso & Solberg, Int. J. Numer.
 * Methods Eng. 67 (2006) 841-867; Dohrmann et al., ibid. 47 (2000) 1549-1568.
 *
 * Masses are lumped, rho V/4 for each node of a zone.  An average has no more energy than what it averages,
 * so the stiffness is bounded by that of plain zones, and with it omega of any motion:
 *     omega^2 <= max over nodes of K_n/m_n,   K_n = sum over zones (lambda + 2 mu) V sum |g_a|^2 + 2 k_n A
 * of its joints.
 *
 * Quiet sides have dashpots: traction -rho (c_p v_n n + c_s v_t), c_p^2 = (lambda + 2 mu)/rho, c_s^2 =
 * mu/rho, which let waves out; with a stress that is put in, twice that stress acts on them.  Source: Lysmer
 * & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859-877.
 *
 * Passes over zones and nodes take ranges of chunks; chunks are independent, so threads do not change a
 * bit. */
#ifndef FL_ZONE_ZONE_SET_H
#define FL_ZONE_ZONE_SET_H
#include "body/body.h"
#include "zone/zone_law.h"
#include "zone/zone_mesh.h"

/* Zones, or nodes, of a block that a thread takes at a time. */
enum { FL_ZONE_CHUNK = 512 };
typedef struct {
    int32_t block, from, to;
} fl_zone_chunk;

typedef struct {
    int32_t body; /* number of its body */
    int32_t material;
    int32_t node, node_end, zone, zone_end, triangle, triangle_end, chunk, chunk_end; /* chunks of nodes */
    int32_t dashpot, dashpot_end;
    int32_t absent; /* 1: taken out */
    double mass;    /* [kg] */
} fl_zone_block;

/* A node of a quiet side. */
typedef struct {
    int32_t node, block;
    fl_vec3 normal; /* outward, of the side */
    double area;    /* [m2] */
} fl_zone_dashpot;

/* Sums over a chunk of nodes, about a point. */
typedef struct {
    fl_vec3 momentum, moment, first;             /* sum m v, m (x - o) x v, m (x - o) */
    fl_mat3 shape;                               /* sum m (x - o) X^T */
    double damping_work, input_work, drive_work; /* of a step [J] */
    double unbalanced; /* largest squared force on a node that is not balanced [N2] */
    /* of runs to rest, free directions alone: sum of inertia v^2, and of v dF with the change dF of forces
     * in a step */
    double motion, release;
} fl_zone_sum;

typedef struct {
    int32_t blocks, nodes, zones, triangles, node_chunks, zone_chunks, dashpots, materials;
    fl_zone_block *block;
    fl_zone_material *material;
    double share; /* k */
    /* nodes */
    fl_vec3 *x, *v, *f; /* place, velocity, force [m], [m/s], [N] */
    fl_vec3 *rest;      /* place at the start in the frame of the body [m] */
    double *m, *volume; /* [kg], V_n [m3] */
    double *inertia;    /* mass that resists acceleration; m but for states of rest [kg] */
    double *stiffness;  /* K_n [N/m] */
    uint8_t *fixed;     /* FL_DOF_X | FL_DOF_Y | FL_DOF_Z */
    fl_mat3 *node_stress;
    int64_t *first;  /* [nodes + 1] offsets into corner */
    int32_t *corner; /* [4 zones] 4 zone + a, of each node */
    /* zones */
    int32_t (*zone)[4];
    fl_vec3 (*gradient)[3]; /* g_0, g_1, g_2; the fourth is less their sum [1/m] */
    double *zone_volume;    /* [m3] */
    fl_vec3 (*work)[4];     /* columns of F, then forces on the four nodes */
    /* plastic strain and lost energy of zones and nodes; NULL without Mohr-Coulomb */
    fl_sym3 *plastic, *node_plastic;
    double *lost, *node_lost; /* [J/m3] */
    /* boundary */
    int32_t (*triangle)[3];
    int32_t *face;
    fl_zone_dashpot *dashpot;
    fl_zone_chunk *node_chunk, *zone_chunk;
    fl_zone_sum *sum;   /* [node_chunks] */
    int32_t inside_out; /* a zone that is turned inside out, or -1 */
    int32_t cap_block, cap_node, cap_zone, cap_triangle, cap_material;
} fl_zone_set;

/* Appends a material, a block at the places of the mesh.  -1 with FL_SYSTEM. */
int fl_zone_set_add_material(fl_zone_set *s, const fl_zone_material *m, fl_err *err);
int fl_zone_set_add(fl_zone_set *s, const fl_zone_mesh *m, int32_t material, int32_t body, fl_err *err);

/* Masses, gradients and lists, once all blocks are there; at rest without strain. */
int fl_zone_set_finish(fl_zone_set *s, double share, fl_err *err);
void fl_zone_set_free(fl_zone_set *s);

/* For states of rest, where masses have no effect: nodes with a higher omega than the median of all get
 * so much inertia that they have that one.  Flat zones then no longer set the step. */
int fl_zone_set_scale_inertia(fl_zone_set *s, fl_err *err);

/* Dashpots on the boundary triangles whose flag is set, with outward normal n.  -1 with FL_SYSTEM. */
int fl_zone_set_add_quiet(fl_zone_set *s, const uint8_t *is_quiet, fl_vec3 n, fl_err *err);

/* The forces of the stress in three passes, each over all chunks: zones, nodes, zones.  The second one has
 * nothing to do with share = 1. */
void fl_zone_deform(fl_zone_set *s, int32_t from, int32_t to);
void fl_zone_average(fl_zone_set *s, int32_t from, int32_t to);
void fl_zone_corner_forces(fl_zone_set *s, int32_t from, int32_t to);

/* Then the force on a node: sum over its corners. */
static inline fl_vec3 fl_zone_node_force(const fl_zone_set *s, int32_t n)
{
    fl_vec3 f = v3(0, 0, 0);
    for (int64_t c = s->first[n]; c < s->first[n + 1]; c++)
        f = v3_add(f, s->work[s->corner[c] >> 2][s->corner[c] & 3]);
    return f;
}

/* Force of dashpot d on its node, with the stress `in` that comes in as a traction (normal and shear in world
 * axes); *own: without it. */
fl_vec3 fl_zone_dashpot_force(const fl_zone_set *s, int32_t d, fl_vec3 in, fl_vec3 *own);

/* Velocity v with its fixed components 0. */
static inline fl_vec3 fl_zone_free_part(unsigned fixed, fl_vec3 v)
{
    return v3(fixed & FL_DOF_X ? 0.0 : v.x, fixed & FL_DOF_Y ? 0.0 : v.y, fixed & FL_DOF_Z ? 0.0 : v.z);
}

/* Largest omega^2 of all nodes, and the node [1/s2]. */
double fl_zone_omega2(const fl_zone_set *s, int32_t *node);

/* The part of K_n of a node that its zones give; the rest is of joints [N/m]. */
double fl_zone_own_stiffness(const fl_zone_set *s, int32_t node);

/* Cauchy stress of a zone, tension positive: k of its own, 1 - k of its nodes [Pa]. */
fl_sym3 fl_zone_cauchy(const fl_zone_set *s, int32_t zone);

/* Plastic work of a zone and its part of its nodes, per volume [J/m3]. */
double fl_zone_lost(const fl_zone_set *s, int32_t zone);

typedef struct {
    double kinetic, stored, plastic; /* [J] */
} fl_zone_energies;
fl_zone_energies fl_zone_set_energies(const fl_zone_set *s);

/* Mean pose and velocity of block k into its body: x, v, q, L, w. */
void fl_zone_chunk_sums(fl_zone_set *s, const fl_bodies *b, int32_t chunk);
void fl_zone_set_pose(const fl_zone_set *s, int32_t k, fl_bodies *b);

/* Memory [B]. */
double fl_zone_set_bytes(const fl_zone_set *s);

#endif
