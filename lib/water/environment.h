/* SPDX-License-Identifier: GPL-3.0-or-later */
/* environment.h -- water and wind on all bodies: buoyancy as a force, drag as a decay of velocity. */
#ifndef FL_WATER_ENVIRONMENT_H
#define FL_WATER_ENVIRONMENT_H
#include <stddef.h>
#include "body/integrate.h"
#include "water/buoyancy.h"
#include "water/current.h"
#include "water/drag.h"
#include "water/facet_drag.h"
#include "water/froude_krylov.h"

/* In the order of the choices of water.drag and wind.drag. */
enum fl_drag_law { FL_DRAG_MANUAL, FL_DRAG_FACET };

/* The surface of a body below and above the water, with flows against flow[i]; no room where the law of that
 * fluid is another or the body is round. */
typedef struct {
    fl_facets facets;
    fl_facet_cut wet, dry;
} fl_drag_surface;

/* The last look at the waves about a body, and how they went on from the one before: where not every step
 * is a look,
 *     F(t) = B(z + s dz, slope + s dslope, x(t), q(t)) + D + s dD,   s = t - when,
 * B being the buoyancy of the body where it is in each step, on a plane that was fitted to the wave along
 * it, and D = F - B at the look; dz = (z - z') / (when - when') and the others so; moment and velocity too.
 * It is off by s^2 d2D/dt2 and the buoyancy of s^2 d2z/dt2 at most.  Wetted surface and facets stay as they
 * were seen.  A body that was not seen before has no changes.
 *
 * So what rights a body answers at once.  Of a spring k whose part e is carried on from looks T apart
 * instead, the mean of the force carried on is
 *     F - 5/12 T^2 d2F/dt2 + 1/3 T^3 d3F/dt3,
 * the last term of which pushes with the speed: an oscillation of omega^2 = k/m grows by
 * e omega (omega T)^3/6 a second.  e is what the plane does not know of the springs of the wave;
 * fl_check_wave_sampling() bounds omega T. */
typedef struct {
    fl_vec3 f, t, flow;    /* D, its moment about the centre; velocity of the water; world axes */
    fl_vec3 df, dt, dflow; /* over a second */
    double z, slope;       /* the plane: over still water at x [m]; along the waves */
    double dz, dslope;     /* over a second */
    fl_vec3 x;             /* where the body was [m] */
    fl_quat q;
    double when; /* [s]; INFINITY: not seen yet */
} fl_wave_sample;

typedef struct {
    int water, wind;        /* which of the two there is; neither: nothing below is allocated or run */
    double level;           /* z of the still water           [m]   */
    double specific_weight; /* rho g                        [N/m3]  */
    fl_fluid seawater, air;
    int water_drag_law, wind_drag_law; /* enum fl_drag_law */
    double water_form, wind_form;      /* C_f of facet; its C_s is sea_skin, air.force */
    double water_skin;
    fl_current current;
    fl_vec3 wind_velocity; /* velocity of the wind [m/s] */
    int32_t n;
    fl_hull *hull;       /* [n] */
    double *drag_radius; /* [n] r_eff of equation (9)     [m]    */
    double *wetted_area; /* [n] at the last fl_environment_force() [m2]  */
    double *buoyancy;    /* [n] buoyancy, at the last fl_environment_force() [N] */
    fl_vec3
        *flow_velocity; /* [n] velocity of the water at the submerged centre [m/s]; NULL where it is that of a
                      * uniform current */
    double *drag_loss;  /* [n] work that drag of the water has taken out [J] */
    double *wind_work;  /* [n] work that the wind has put in [J]; NULL without wind */
    fl_drag_surface *drag_surface; /* [n] with the law facet alone, of either fluid */
    double time;                   /* of the next fl_environment_force(): set by the step [s] */
    /* with waves alone */
    int waves;
    fl_waves wave;
    fl_hull_panels *panels;   /* [n] of the outer shapes */
    fl_wave_expansion *cells; /* [threads][cells_each] scratch */
    int32_t cells_per_thread, threads;
    fl_vec3 *water_force,
        *water_moment;      /* [n] force and moment of the water, world axes, at the last one [N], [N m] */
    double *water_work;     /* [n] work of those so far [J] */
    int sample_every;       /* steps between two looks; above 1: */
    int sample_now;         /* whether the next fl_environment_force() is one: set by the step */
    fl_wave_sample *sample; /* [n], or NULL */
} fl_environment;

/* The sharp outer shape of body i, in its frame, which the sea has taken over; NULL where the core floats, or
 * tells it. */
static inline fl_poly *fl_environment_outer(const fl_environment *s, int32_t i)
{
    return s->hull[i].face_area ? (fl_poly *)s->hull[i].shape : NULL;
}

/* Arrays for n bodies, for what water, wind, sea_law, air_law and waves ask; the caller makes the hulls, and
 * fits them one by one.
 *   threads   how many may call fl_environment_force() at once
 * -1 with FL_SYSTEM. */
int fl_environment_alloc(fl_environment *s, int32_t n, int threads, fl_err *err);
void fl_environment_free(fl_environment *s);

/* The hull of body i and its reach.
 *   outer  its sharp outer shape, taken over and left empty where the core does not tell it; NULL of a sphere
 *          or capsule, and of these alone: a hull with areas has a shape of its own
 *          (fl_hull_borrow_core()); NULL where the core floats, a sphere or a capsule
 *   core   of the body, which has to stay where it is as long as the hull; r: its dilation radius [m]
 * -1 with FL_INPUT or FL_SYSTEM, as fl_hull_make(). */
int fl_environment_set_hull(fl_environment *s, int32_t i, fl_poly *outer, const fl_poly *core, double r,
                            fl_err *err);

/* Take that away again; accepts a body without. */
void fl_environment_clear_hull(fl_environment *s, int32_t i);

/* What the law facet and waves need for body i, whose hull has been made or made anew; grows the scratch.  -1
 * with FL_SYSTEM. */
int fl_environment_fit_hull(fl_environment *s, int32_t i, fl_err *err);

/* Force of the water on body i at the last fl_environment_force(), but for drag [N]. */
static inline fl_vec3 fl_environment_water_force(const fl_environment *s, int32_t i)
{
    return s->waves ? s->water_force[i] : v3(0, 0, s->buoyancy[i]);
}

/* Velocity of the water that body i meets, at the last fl_environment_force() [m/s]. */
static inline fl_vec3 fl_environment_flow(const fl_environment *s, int32_t i)
{
    return s->flow_velocity ? s->flow_velocity[i] : s->current.velocity;
}

/* What drags on the facets of a body. */
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

/* Book the work of push and turn in a kick of h seconds that took body i from v0, w0 to its speeds of now:
 * h (F.(v0 + v) + T.(w0 + w)) / 2, which is exact. */
void fl_environment_add_work(fl_environment *s, const fl_bodies *b, int32_t i, double h, fl_vec3 v0,
                             fl_vec3 w0);

/* Add buoyancy, in waves the pressure of the wave and what it does to the water that moves along, to b->f[i],
 * b->t[i]; renews wetted[i], lift[i] and flow[i], where it is a look. */
void fl_environment_force(fl_environment *s, fl_bodies *b, int32_t i);

/* The part of that which is for drag by facets, skin[i], in still water whose plane is up.x = level in the
 * axes of body i. */
void fl_environment_update_surface(fl_environment *s, const fl_bodies *b, int32_t i, fl_vec3 up,
                                   double level);

/* What fl_environment_force() keeps for the drag, without the force: of a body that has been put somewhere; with
 * held[i], as it was left there by the last look, `time` being that of the last fl_environment_force(). */
void fl_environment_refresh(fl_environment *s, fl_bodies *b, int32_t i);

/* omega^2 of the stiffest of heave, roll and pitch of body i as it stands, were the water to reach up to its
 * centre: rho g A/m and rho g J/I, A and J the area and second moment of the water plane, with the water that
 * moves along, and of what is free alone; the weight between the centres is left out.  turns: out, whether it
 * is no heave.  Cannot fail.  [1/s2] */
double fl_environment_omega2(const fl_environment *s, const fl_bodies *b, int32_t i, int *turns);

/* Hydrostatic energy of body i in still water where it is now; touches nothing [J].  In waves their work is
 * booked instead. */
double fl_environment_energy(const fl_environment *s, const fl_bodies *b, int32_t i);

/* Let the drag of water and wind act on body i for h seconds, position held: the decay of its
 * velocities by equations (8), (9) alone, exact, or by facet_drag.h, first of the one fluid, then of the
 * other.  Adds the work to drained[i], blown[i].
 *   back  0: water first, 1: wind first, so that two halves of a step are each other's mirror image and the
 *         splitting has order 2 */
void fl_environment_drag(fl_environment *s, fl_bodies *b, int32_t i, double h, int back);

#endif
