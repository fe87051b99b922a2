/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Granular behaviour of many contacts: a block on a slope stands, slides or topples; heaps of spheres have
 * an angle of repose that friction alone does not decide. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "base/rng.h"
#include "law/material.h"
#include "support/small_world.h"
#include "support/verify.h"

#define DEGREES (PI / 180.0)

static void run_for(lab *l, double seconds)
{
    if (lab_run(l, (int64_t)(seconds / l->w.dt))) exit(1);
}

/* --- V26: a block on a slope -------------------------------------------------------------------------- */

#define BASE 10.0 /* wide [m] */
#define ROUND 0.05
#define PULL 10.0 /* gravity [m/s2] */

/* Acceleration of the block down the slope over gravity, and its rotation. */
typedef struct {
    double faster, tilt;
} block_motion;

/* A block of height `high` [m] on the plane z = 0.  The plane is tilted from level to 40 degrees within
 * four seconds and held there for four more.  friction: as an angle. */
static block_motion tilt_block(double high, double friction)
{
    const double mean_angle = 40.0 * DEGREES, flat = BASE - 2.0 * ROUND,
                 weight = BASE * BASE * high * 2000.0 * PULL,
                 modulus = fl_material_modulus((fl_elastic_constants){1e10, 0.3},
                                               (fl_elastic_constants){INFINITY, 0.0}),
                 overlap = weight / fl_material_punch(modulus, flat * flat);
    lab l;
    lab_start(&l);
    lab_set(&l, "boundary.min=none none 0");
    lab_set(&l, "material.ice.young=10 GPa"), lab_set(&l, "material.ice.density=2000");
    lab_setf(&l, "run.gravity=%g", PULL);
    lab_setf(&l, "contact.friction=%.17g", tan(friction)), lab_set(&l, "contact.restitution=0.3");
    lab_box(&l, v3(0, 0, 0.5 * high - overlap), v3(0.5 * BASE, 0.5 * BASE, 0.5 * high), ROUND, q_one(),
            v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0);
    const fl_mat3 level = fl_body_axes(&l.w.b, 0);
    const int64_t tilting = (int64_t)(4.0 / l.w.dt);
    for (int64_t k = 1; k <= tilting; k++) {
        const double a = mean_angle * (double)k / (double)tilting;
        l.w.gravity = v3(PULL * sin(a), 0, -PULL * cos(a));
        if (lab_run(&l, 1)) exit(1);
    }
    run_for(&l, 3.0);
    const double was = l.w.b.v[0].x;
    run_for(&l, 1.0);
    const fl_mat3 now = fl_body_axes(&l.w.b, 0);
    double trace = 0.0;
    for (int c = 0; c < 3; c++) trace += v3_dot(m3_col(now, c), m3_col(level, c));
    const block_motion f = {(l.w.b.v[0].x - was) / PULL, acos(fmax(-1.0, fmin(1.0, 0.5 * (trace - 1.0))))};
    lab_free(&l);
    return f;
}

static void verify_fate(const char *what, double high, double friction)
{
    const block_motion f = tilt_block(high, friction * DEGREES);
    verify_true("V26", what, fabs(f.faster) < 1e-3 && f.tilt < 0.1 * DEGREES);
}

/* The flat of its base is 9.9 m wide: a rigid block topples from 11.8 m on.  Near toppling only a strip of
 * length l touches, with its force at l/5 from the edge, by W ~ s^(5/2)/sqrt(turn): from 11.6 m on, with
 * this modulus. */
static void blocks_on_slope(void)
{
    const double by = sin(40.0 * DEGREES) - cos(40.0 * DEGREES) * tan(20.0 * DEGREES);
    verify_fate("10 m high, friction 40.1 degrees: it stands", 10.0, 40.1);
    const block_motion least = tilt_block(10.0, 39.9 * DEGREES), slides = tilt_block(5.0, 20.0 * DEGREES);
    verify_true("V26", "10 m high, 39.9 degrees: it slides",
                least.faster > 2e-3 && least.tilt < 0.1 * DEGREES);
    verify_row("V26", "5 m high, 20 degrees: it slides, a/g", slides.faster, by, 1e-3, VERIFY_REL);
    verify_below("V26", "the same: rotation of the block [degrees]", slides.tilt / DEGREES, 0.1);
    verify_true("V26", "25 m high, 40.1 degrees: it topples",
                tilt_block(25.0, 40.1 * DEGREES).tilt > 45.0 * DEGREES);
    verify_fate("11.2 m high, 45 degrees: it stands", 11.2, 45.0);
    verify_true("V26", "11.9 m high, 45 degrees: it topples",
                tilt_block(11.9, 45.0 * DEGREES).tilt > 10.0 * DEGREES);
}

/* --- heaps of spheres --------------------------------------------------------------------------------- */

/* Across [m]; a slice of five. */
#define D 0.1
#define DEEP (5.0 * D)

typedef struct {
    fl_vec3 x;
    double r;
} grain;

typedef struct {
    double friction, rolling;
    double wide;      /* of the box that they are poured into [m]    */
    grain *floor, *g; /* [floors], which are held; [n]               */
    int32_t floors, n;
} heap;

/* A rough floor from 0 to `wide`, no sphere of it above z = 0, and n grains over it in a loose lattice that
 * fills the box.  Radii differ by up to a twentieth. */
static heap make_heap(double friction, double rolling, double wide, int32_t n, uint64_t seed)
{
    heap p = {.friction = friction, .rolling = rolling, .wide = wide};
    fl_rng g = fl_rng_of(seed, 0, FL_RNG_TEST);
    const int32_t across = (int32_t)(wide / D + 0.5), along = (int32_t)(DEEP / D + 0.5);
    const int32_t columns = (int32_t)(wide / (1.35 * D)), rows = 3;
    p.floor = malloc((size_t)(across * along) * sizeof *p.floor), p.g = malloc((size_t)n * sizeof *p.g);
    if (!p.floor || !p.g) exit(1);
    for (; p.floors < across * along; p.floors++)
        p.floor[p.floors] =
            (grain){v3((p.floors / along + 0.5 + fl_rng_in(&g, -0.1, 0.1)) * D,
                       (p.floors % along + 0.5 + fl_rng_in(&g, -0.1, 0.1)) * D, -fl_rng_in(&g, 0.5, 0.9) * D),
                    0.5 * D};
    for (; p.n < n; p.n++) {
        const fl_vec3 at =
            v3((p.n % columns + 0.5) * wide / columns, (p.n / columns % rows + 0.5) * DEEP / rows,
               (0.7 + 1.15 * (p.n / columns / rows)) * D);
        const fl_vec3 by = v3(fl_rng_in(&g, -0.13, 0.13) * D, fl_rng_in(&g, -0.25, 0.25) * D, 0.0);
        p.g[p.n] = (grain){v3_add(at, by), 0.5 * D * fl_rng_in(&g, 0.95, 1.05)};
    }
    return p;
}

static void heap_free(heap *p) { free(p->floor), free(p->g); }

/* From rest, for `seconds`, between walls at lo and hi, above a bottom. */
static void settle(heap *p, const char *lo, const char *hi, double bottom, double seconds)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "run.gravity=9.81");
    lab_setf(&l, "material.ice.young=%g MPa", verify_quick() ? 5.0 : 20.0);
    lab_setf(&l, "contact.friction=%g", p->friction), lab_setf(&l, "contact.rolling=%g", p->rolling);
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "boundary.type=rigid periodic rigid");
    lab_setf(&l, "boundary.min=%s 0 %.17g", lo, bottom);
    lab_setf(&l, "boundary.max=%s %.17g none", hi, DEEP);
    for (int32_t k = 0; k < p->floors; k++)
        lab_sphere(&l, p->floor[k].x, p->floor[k].r, v3(0, 0, 0), v3(0, 0, 0));
    for (int32_t k = 0; k < p->n; k++) lab_sphere(&l, p->g[k].x, p->g[k].r, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0.0);
    for (int32_t k = 0; k < p->floors; k++) l.w.b.fixed_dof[k] = 63;
    run_for(&l, seconds);
    for (int32_t k = 0; k < p->n; k++) p->g[k].x = fl_periodic_cell_wrap(&l.w.cell, l.w.b.x[p->floors + k]);
    lab_free(&l);
}

/* Pours the grains into the box. */
static void pour_into_box(heap *p, double seconds)
{
    char wide[32];
    snprintf(wide, sizeof wide, "%.17g", p->wide);
    settle(p, "0", wide, -2.0 * D, seconds);
}

/* Number of grains for a volume fraction of 0.58. */
static int32_t grain_count(double wide, double high)
{
    return (int32_t)(0.58 * wide * DEEP * high / (PI / 6.0 * D * D * D));
}

/* Height of the heap over [x, x + D], twice that of the middle of it; 0 if empty. */
static double surface_height(const heap *p, double x)
{
    double z = 0.0, n = 0.0;
    for (int32_t k = 0; k < p->n; k++)
        if (p->g[k].x.z > 0.0 && p->g[k].x.x >= x && p->g[k].x.x < x + D) z += 2.0 * p->g[k].x.z, n += 1.0;
    return n > 0.0 ? z / n : 0.0;
}

/* Angle of the surface over [from, to] by least squares [degrees]. */
static double surface_angle(const heap *p, double from, double to)
{
    const int32_t n = (int32_t)((to - from) / D + 0.5);
    double sxz = 0.0, sxx = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double x = (k - 0.5 * (n - 1)) * D;
        sxz += x * surface_height(p, from + k * D), sxx += x * x;
    }
    return atan(sxz / sxx) / DEGREES;
}

/* Both sides of a floor are removed; the grains that have not fallen off form a heap.  Returns the mean of
 * its two slopes without their ends [degrees]. */
static double angle_of_repose(double friction, double rolling, double wide, uint64_t seed)
{
    heap p = make_heap(friction, rolling, wide, grain_count(wide, 0.3 * wide), seed);
    pour_into_box(&p, 1.2);
    settle(&p, "none", "none", -0.6, 2.5);
    const double left = surface_angle(&p, 0.1 * wide, 0.42 * wide),
                 right = -surface_angle(&p, 0.58 * wide, 0.9 * wide);
    heap_free(&p);
    return 0.5 * (left + right);
}

/* Mean over some heaps, and its standard error. */
typedef struct {
    double mean, error;
} mean_angle;

static mean_angle mean_angle_of_repose(double friction, double rolling, int heaps)
{
    double sum = 0.0, sum2 = 0.0;
    for (int k = 0; k < heaps; k++) {
        const double a =
            angle_of_repose(friction, rolling, verify_quick() ? 18.0 * D : 24.0 * D, 21 + (uint64_t)k);
        sum += a, sum2 += a * a;
    }
    const double mean = sum / heaps;
    const mean_angle s = {mean, sqrt(fmax(0.0, sum2 / heaps - mean * mean) / fmax(1, heaps - 1))};
    verify_note("friction %g, rolling %g: %.1f +- %.1f degrees, %d heaps", friction, rolling, s.mean, s.error,
                heaps);
    return s;
}

/* The bands are wide because published values scatter as much: by how heaps are made, and by what the
 * rolling coefficient multiplies, the radius or half of it (here R*, law/rolling.h). */
static void repose_of_spheres(void)
{
    const int heaps = verify_quick() ? 1 : 5;
    const mean_angle slick = mean_angle_of_repose(0.25, 0.0, heaps),
                     held = mean_angle_of_repose(0.25, 0.2, heaps);
    verify_true("V46", "friction 0.25: steeper with rolling resistance",
                held.mean - slick.mean > 3.0 * (held.error + slick.error) && held.mean > slick.mean + 2.0);
    if (verify_quick()) return;
    const mean_angle free = mean_angle_of_repose(0.5, 0.0, heaps),
                     kept = mean_angle_of_repose(0.5, 0.15, heaps);
    verify_row("V46", "angle of repose, friction 0.5 [degrees]", free.mean, 22.5, 2.5 + 5.0, VERIFY_ABS);
    verify_row("V46", "the same, rolling 0.15 [degrees]", kept.mean, 32.5, 2.5 + 5.0, VERIFY_ABS);
    verify_true("V46", "friction 0.5: steeper with rolling resistance", kept.mean > free.mean + free.error);
}

int main(void)
{
    verify_begin("granular");
    blocks_on_slope();
    repose_of_spheres();
    return verify_end();
}
