/* SPDX-License-Identifier: GPL-3.0-or-later */
/* environment.h -- water and wind on all bodies: buoyancy and waves as forces, drag as a decay of velocity.
 *
 * The forces, and what set-up, plan and energy balance need to know of each, are the rows of water_force.h.
 */
#ifndef FL_WATER_ENVIRONMENT_H
#define FL_WATER_ENVIRONMENT_H
#include <stddef.h>
#include "body/integrate.h"
#include "water/buoyancy.h"
#include "water/current.h"
#include "water/drag.h"
#include "water/facet_drag.h"
#include "water/froude_krylov.h"
#include "water/wave_path.h"
#include "water/water_force.h"

/* In the order of the choices of water.drag and wind.drag. */
enum fl_drag_law { FL_DRAG_MANUAL, FL_DRAG_FACET };

/* Surface of a body below and above the water; a flow is relative to flow_velocity[i]. A cut is empty if the
 * drag law of its fluid is not `facet`, or the body is a sphere or capsule. */
typedef struct {
    fl_facets facets;
    fl_facet_cut wet, dry;
} fl_drag_surface;

/* Last sample of the waves at a body, and its rates of change since the sample before. With water.every above
 * 1 the waves are evaluated (sampled) in some steps only, and in between
 *     F(t) = B(z + s dz, slope + s dslope, x(t), q(t)) + D + s dD,   s = t - when.
 * B is the buoyancy of the body at its present pose, on a plane fitted to the wave along the body, and D = F
 * - B at the sample; dz = (z - z') / (when - when') and so on, and the same for the moment and the flow
 * velocity. The error is at most s^2 d2D/dt2 and the buoyancy of s^2 d2z/dt2. Wetted surface and facets stay
 * those of the sample. A body without an earlier sample has zero rates.
 *
 * So the restoring force responds in each step. If instead a part e of a spring k were extrapolated from
 * samples T apart, the mean of the extrapolated force would be
 *     F - 5/12 T^2 d2F/dt2 + 1/3 T^3 d3F/dt3,
 * whose last term drives the motion: an oscillation of omega^2 = k/m grows at the rate e omega (omega T)^3/6
 * per second. e is the part of the wave's stiffness that the plane leaves out. fl_check_wave_sampling()
 * bounds omega T. */
typedef struct {
    fl_vec3 f, t, flow;    /* D, its moment about the centre; velocity of the water; world axes */
    fl_vec3 df, dt, dflow; /* rates [1/s] */
    double z, slope;       /* plane: height above still water at x [m]; slope along the waves */
    double dz, dslope;     /* rates [1/s] */
    fl_vec3 x;             /* centre of the body at the sample [m] */
    fl_quat q;
    double when; /* time of the sample [s]; INFINITY: none yet */
} fl_wave_sample;

/* A body of others that uses the tables of the waves: floating_hull.h. */
typedef struct {
    const fl_vec3 *x; /* centre [m] */
    double reach;     /* [m] */
    const fl_wave_block *block;
} fl_wave_guest;

enum { FL_WATER_FORCES_MAX = 16 };

struct fl_environment {
    int water, wind;        /* 1 if there is water, wind; with neither nothing below is allocated or used */
    int only_spheres;       /* 1: all bodies are spheres; set before fl_environment_set_up() */
    double gravity;         /* |g| [m/s2] */
    double heave_factor;    /* added mass along the vertical over displaced mass, of b->heave_mass */
    double level;           /* z of the still water [m] */
    double specific_weight; /* rho g [N/m3] */
    fl_fluid seawater, air;
    int water_drag_law, wind_drag_law; /* enum fl_drag_law */
    /* C_f of the law `facet`; its C_s is water_skin, air.force_coefficient */
    double water_form, wind_form;
    double water_skin;
    fl_current current;
    fl_vec3 wind_velocity; /* [m/s] */
    int32_t n;
    fl_hull *hull;          /* [n] */
    double *drag_radius;    /* [n] r_eff of the drag moment [m] */
    double *wetted_area;    /* [n] at the last fl_environment_force() [m2] */
    double *buoyancy;       /* [n] buoyancy at the last fl_environment_force() [N] */
    fl_vec3 *flow_velocity; /* [n] of the water at the submerged centre [m/s]; NULL: a uniform current */
    double *drag_loss;      /* [n] energy that drag of the water has removed so far [J] */
    double *wind_work;      /* [n] work of the wind so far [J]; NULL without wind */
    fl_drag_surface *drag_surface; /* [n] if either fluid has the law `facet`, else NULL */
    double time;                   /* time of the next fl_environment_force(), set by the step [s] */
    /* with waves only */
    int waves;
    fl_waves wave;
    fl_hull_panels *panels;   /* [n] of the outer shapes */
    fl_wave_expansion *cells; /* [threads][cells_per_thread] scratch */
    int32_t cells_per_thread, threads;
    fl_vec3 *water_force;   /* [n] force of the water, world axes, at the last one [N] */
    fl_vec3 *water_moment;  /* [n] its moment about the centre [N m] */
    double *water_work;     /* [n] work of that force and moment so far [J] */
    int sample_every;       /* steps between two samples; above 1: */
    int sample_now;         /* 1: the next fl_environment_force() samples the waves; set by the step */
    fl_wave_sample *sample; /* [n], or NULL */
    /* with water.wave_error: waves from tables, in blocks of time (wave_block.h); panels and cells are
     * unused */
    int by_blocks;
    fl_wave_grid grid;
    fl_wave_water sea;                 /* what all bodies have in common */
    fl_wave_nodes *nodes;              /* [n] */
    fl_wave_block *block;              /* [n] */
    fl_wave_node_sample *node_scratch; /* [threads][scratch_per_thread] */
    int32_t scratch_per_thread;
    const fl_wave_guest *guest; /* [guests] borrowed */
    int32_t guests;
    /* rows of the table of forces that are present and have an `impulse` */
    const fl_water_force *impulse[FL_WATER_FORCES_MAX];
    int32_t impulses;
    const fl_scene *scene; /* borrowed, for rows of the table that read their keys */
};

/* Sharp outer shape of body i, body frame, owned by the environment; NULL if the core floats or the core
 * gives the shape. */
static inline fl_poly *fl_environment_outer(const fl_environment *s, int32_t i)
{
    return s->hull[i].face_area ? (fl_poly *)s->hull[i].shape : NULL;
}

/* Allocates arrays for n bodies as water, wind, the drag laws and waves require. The caller then sets and
 * fits the hull of each body.
 *   threads   how many may call fl_environment_force() at once
 * Returns -1 with FL_SYSTEM. */
int fl_environment_alloc(fl_environment *s, int32_t n, int threads, fl_err *err);
void fl_environment_free(fl_environment *s);

/* Sets the hull of body i and its drag radius.
 *   outer  its sharp outer shape, taken over and left empty unless the core gives the shape
 *          (fl_hull_borrow_core()); NULL for a sphere or capsule, and for these alone
 *   core   of the body, borrowed as long as the hull exists; r: its dilation radius [m]
 * Returns -1 with FL_INPUT or FL_SYSTEM, as fl_hull_make(). */
int fl_environment_set_hull(fl_environment *s, int32_t i, fl_poly *outer, const fl_poly *core, double r,
                            fl_err *err);

/* Frees the hull of body i; accepts a body without. */
void fl_environment_clear_hull(fl_environment *s, int32_t i);

/* Prepares drag by facets and waves for body i, after its hull has been set; grows the scratch. Returns -1
 * with FL_INPUT or FL_SYSTEM. */
int fl_environment_fit_hull(fl_environment *s, int32_t i, fl_err *err);

/* Force of the water on body i at the last fl_environment_force(), without drag [N]. */
static inline fl_vec3 fl_environment_water_force(const fl_environment *s, int32_t i)
{
    return s->waves ? s->water_force[i] : v3(0, 0, s->buoyancy[i]);
}

/* Velocity of the water at body i, at the last fl_environment_force() [m/s]. */
static inline fl_vec3 fl_environment_flow(const fl_environment *s, int32_t i)
{
    return s->flow_velocity ? s->flow_velocity[i] : s->current.velocity;
}

/* Coefficients of drag by facets. */
static inline fl_facet_drag_law fl_environment_water_law(const fl_environment *s)
{
    return (fl_facet_drag_law){0.5 * s->seawater.density * s->water_skin,
                               0.5 * s->seawater.density * s->water_form};
}
static inline fl_facet_drag_law fl_environment_wind_law(const fl_environment *s)
{
    return (fl_facet_drag_law){0.5 * s->air.density * s->air.force_coefficient,
                               0.5 * s->air.density * s->wind_form};
}

/* Adds the work of water_force and water_moment in a kick of h seconds that took body i from v0, w0 to its
 * present velocities: h (F.(v0 + v) + T.(w0 + w)) / 2, which is exact. */
void fl_environment_add_work(fl_environment *s, const fl_bodies *b, int32_t i, double h, fl_vec3 v0,
                             fl_vec3 w0);

/* Fills the tables of the waves that the step to time t needs. Called before the step, by one thread; without
 * it each body computes its own part, to the same bits.
 *   absent   [n] 1: the body is not there; or NULL
 *   threads  how many fill them
 * Returns -1 with FL_SYSTEM, or FL_NUMERIC if the bodies are too far apart. */
int fl_environment_prepare(fl_environment *s, const fl_bodies *b, const uint8_t *absent, double t,
                           int threads, fl_err *err);

/* Adds buoyancy, or in waves the Froude-Krylov force and the inertia force on the added mass, to b->f[i],
 * b->t[i]. Updates wetted_area[i], buoyancy[i] and flow_velocity[i]; between samples flow_velocity[i] alone.
 */
void fl_environment_force(fl_environment *s, fl_bodies *b, int32_t i);

/* Updates drag_surface[i] for still water whose plane is up.x = level in the axes of body i. */
void fl_environment_update_surface(fl_environment *s, const fl_bodies *b, int32_t i, fl_vec3 up,
                                   double level);

/* Updates what fl_environment_force() stores for the drag, without the force, of a body that has been moved.
 * With sample[i], restores the state of the last sample, `time` being that of the last
 * fl_environment_force(). */
void fl_environment_refresh(fl_environment *s, fl_bodies *b, int32_t i);

/* omega^2 of the stiffest of heave, roll and pitch of body i at its orientation, with the water up to its
 * centre: rho g A/m and rho g J/I, A and J the area and second moment of the water plane. Added mass and
 * constraints count; the moment of the weight is left out. turns: out, 1 if that is no heave. Cannot fail.
 * [1/s2] */
double fl_environment_omega2(const fl_environment *s, const fl_bodies *b, int32_t i, int *turns);

/* Hydrostatic energy of body i in still water at its present pose; changes nothing [J]. In waves the work of
 * the water is summed instead. */
double fl_environment_energy(const fl_environment *s, const fl_bodies *b, int32_t i);

/* Applies the drag of water and wind to body i for h seconds at constant position: the exact decay of its
 * velocities by the laws of drag.h, or the step of facet_drag.h, for one fluid after the other. Adds the work
 * to drag_loss[i], wind_work[i].
 *   back  0: water first, 1: wind first; the two halves of a step mirror each other, so the splitting has
 *         order 2
 */
void fl_environment_drag(fl_environment *s, fl_bodies *b, int32_t i, double h, int back);

/* Decay of the velocities of body i over h seconds in a fluid of velocity c, by drag.h with this area and
 * r_eff. Returns the work done on the body. */
double fl_environment_decay_velocity(fl_bodies *b, int32_t i, const fl_fluid *fluid, double area,
                                     double reach, fl_vec3 c, double h);

/* The part of that which is the forces with an `impulse`, in the order of the table, or with back against it.
 */
void fl_environment_apply_impulses(fl_environment *s, fl_bodies *b, int32_t i, double h, int back);

#endif
