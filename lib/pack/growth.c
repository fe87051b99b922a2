/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/growth.h"
#include <math.h>

/* Rise of the scale in the last relaxation; overlap over the smaller radius that is none, during growth and
 * at its end. */
static const double MARGIN = 2e-4, LOOSE = 2e-2, NONE = 1e-7;

/* Residual force over the mean overlap that counts as balance: at the end, during growth, on the secant. */
static const double BALANCE = 1e-5, BALANCE_GROW = 1e-4, BALANCE_SECANT = 1e-3;

/* Mean overlap over the mean distance from which on balanced forces count as a jam. */
static const double JAM_STRAIN = 1e-6;

/* Rise of the scale over the one before, and at most over fl_growth_options.rise, of bodies that part at
 * once. */
static const double FASTER = 1.25, FASTEST = 8.0;

/* Steps of a relaxation: during growth, in full, and for the balance of every body. */
enum { QUICK = 40, LONG = 20000, POLISH = 20000 };
enum { SECANTS = 40, TRIMS = 2000 };

static const double TRIM = 2e-4;

const char *const fl_growth_phase_name[FL_GROWTH_PHASES] = {"growth",  "settling", "densest packing",
                                                            "balance", "trimming", "done"};

fl_growth_options fl_growth_defaults(void)
{
    return (fl_growth_options){
        .rise = 0.01, .overlap = 5e-5, .trim = FL_TRIM_ALL, .layers = 2.0, .share = 1e-2};
}

fl_growth fl_growth_start(const fl_growth_options *opt)
{
    return (fl_growth){.phase = FL_GROWTH_RISE, .rise = opt->rise, .strain = 1.0, .trimmed = 1.0};
}

/* Mean overlap over the mean distance, about (s - s_J)/s. */
static double strain_of(const fl_overlaps *o)
{
    const fl_overlap_totals *t = &o->now;
    return t->contacts && t->pressure > 0.0
               ? t->overlap_sum * t->overlap_sum / ((double)t->contacts * t->pressure)
               : 0.0;
}

static void enter(fl_growth *g, enum fl_growth_phase phase)
{
    g->phase = (int32_t)phase;
    g->stage = 0;
}

/* Bodies with edges do not balance exactly, and more steps do not help. */
static int64_t full_steps(const fl_overlaps *o) { return o->p->q ? LONG / 4 : LONG; }

/* 1 where bodies jam at the present scale, 0 where they can part, -1 with FL_SYSTEM. */
static int is_jammed(fl_overlaps *o, double free, double balance, fl_err *err)
{
    const int state = fl_overlaps_relax(o, free, balance, full_steps(o), err);
    if (state < 0) return -1;
    if (state == FL_RELAXED_FREE) return 0;
    /* after so many steps a packing that could part would have done so, but for the last of its overlap */
    return strain_of(o) > JAM_STRAIN;
}

static int freedoms_are_held(const fl_overlaps *o)
{
    const int freedoms = o->p->q ? 6 : o->p->dim;
    return (double)o->now.contacts > 0.8 * freedoms * o->p->n;
}

/* The phase after a jam. */
static void end_growth(fl_growth *g, const fl_overlaps *o, const fl_growth_options *opt)
{
    g->jammed = 1;
    g->reached = o->p->s;
    enter(g, opt->trim == FL_TRIM_ALL    ? FL_GROWTH_DENSEST
             : opt->trim == FL_TRIM_NEAR ? FL_GROWTH_TRIM
                                         : FL_GROWTH_DONE);
}

/* --- phases ------------------------------------------------------------------------------------- */

/* The next rise is larger where bodies parted at once, until they begin to resist. */
static void adapt_rise(fl_growth *g, const fl_growth_options *opt, int at_once)
{
    if (!at_once) g->rise = fmin(g->rise, opt->rise);
    else if (g->rise >= opt->rise) g->rise = fmin(FASTER * g->rise, FASTEST * opt->rise);
}

static int raise_scale(fl_growth *g, fl_overlaps *o, const fl_growth_options *opt, fl_err *err)
{
    fl_packing *p = o->p;
    const double next = p->s * (1.0 + g->rise);
    if (next > 1.0 - 1e-12) {
        p->s = 1.0;
        enter(g, FL_GROWTH_SETTLE);
        return 0;
    }
    p->s = next;
    /* bodies with edges part slowly: whether they jam is decided at the end */
    const int64_t before = o->steps;
    const int state = fl_overlaps_relax(o, LOOSE, BALANCE, p->q ? 3 * QUICK : QUICK, err);
    if (state < 0) return -1;
    adapt_rise(g, opt, !p->q && state == FL_RELAXED_FREE && o->steps - before < QUICK / 2);
    if (opt->trim != FL_TRIM_ALL || p->q || state == FL_RELAXED_FREE || !freedoms_are_held(o)) return 0;
    const int jammed = is_jammed(o, LOOSE, BALANCE_GROW, err);
    if (jammed < 0) return -1;
    if (jammed) end_growth(g, o, opt);
    else g->rise = fmax(0.5 * g->rise, 0.1 * opt->rise);
    return 0;
}

/* Smallest inner radius over the bounding radius of the shapes: 1 for spheres. */
static double slimness(const fl_packing *p)
{
    double least = 1.0;
    for (int32_t k = 0; k < p->shapes->n; k++) {
        const fl_pack_shape *t = &p->shapes->shape[k];
        least = fmin(least, fmin(t->half.x, fmin(t->half.y, t->half.z)) / t->bound);
    }
    return least;
}

static int settle(fl_growth *g, fl_overlaps *o, const fl_growth_options *opt, fl_err *err)
{
    fl_packing *p = o->p;
    p->s = 1.0 + MARGIN;
    /* Overlaps up to MARGIN of the smaller body at the larger scale are none at 1: of two bodies the overlap
     * falls by MARGIN times the sum of the inner radii at least, at the boundary by MARGIN times that. */
    const int state = fl_overlaps_relax(o, 0.95 * MARGIN * slimness(p), BALANCE, full_steps(o), err);
    p->s = 1.0;
    if (state < 0) return -1;
    if (state == FL_RELAXED_FREE) {
        enter(g, FL_GROWTH_DONE);
        return fl_overlaps_evaluate(o, err);
    }
    const int jammed = is_jammed(o, NONE, BALANCE, err);
    if (jammed < 0) return -1;
    enter(g, FL_GROWTH_DONE);
    if (jammed) end_growth(g, o, opt);
    return 0;
}

static int follow_pressure(fl_growth *g, fl_overlaps *o, const fl_growth_options *opt, fl_err *err)
{
    fl_packing *p = o->p;
    /* far from s_J the pressure need not be known well */
    const double balance = g->strain > 300.0 * opt->overlap ? 5.0 * BALANCE_SECANT : BALANCE_SECANT;
    const int state = fl_overlaps_relax(o, p->q ? 0.0 : NONE, balance, full_steps(o), err);
    if (state < 0) return -1;
    if (state == FL_RELAXED_FREE && g->s_before > p->s && g->stage < SECANTS) { /* below s_J */
        p->s += 0.5 * (g->s_before - p->s);
        return 0;
    }
    const double now = o->now.pressure, s = p->s;
    g->strain = strain_of(o);
    /* first s (1 - strain); then the secant, kept between a tenth and three times that */
    double way = s * g->strain;
    if (g->p_before > now && g->s_before > s)
        way = fmax(fmin(now * (g->s_before - s) / (g->p_before - now), 3.0 * way), 0.1 * way);
    g->jam_scale = s - way;
    if (g->strain < opt->overlap || g->stage == SECANTS) {
        enter(g, FL_GROWTH_BALANCE);
        return 0;
    }
    g->s_before = s;
    g->p_before = now;
    p->s = s - 0.94 * way;
    return 0;
}

/* Bodies that hardly touch come to rest last. */
static int balance_all(fl_growth *g, fl_overlaps *o, fl_err *err)
{
    o->strict = 1;
    const int state = fl_overlaps_relax(o, 0.0, 0.5 * BALANCE_SECANT, o->p->q ? full_steps(o) : POLISH, err);
    o->strict = 0;
    enter(g, FL_GROWTH_DONE);
    return state < 0 ? -1 : 0;
}

/* --- trimming near walls ------------------------------------------------------------------------ */

static double largest_helper_force(const fl_overlaps *o)
{
    double most = 0.0;
    for (int32_t k = 0; k < o->region->walls; k++)
        if (o->region->wall[k].helper) most = fmax(most, o->wall_force[k]);
    return most;
}

/* Distance of x from the nearest helper wall, or any number above reach. */
static double helper_distance(const fl_pack_region *r, fl_vec3 x, double reach)
{
    fl_region_contact c[FL_REGION_CONTACTS];
    const int n = fl_region_contacts(r, x, reach, c);
    double d = INFINITY;
    for (int k = 0; k < n; k++)
        if (r->wall[c[k].wall].helper) d = fmin(d, c[k].gap);
    return d;
}

static int trim_near(fl_growth *g, fl_overlaps *o, const fl_growth_options *opt, fl_err *err)
{
    fl_packing *p = o->p;
    double reach = 0.0;
    if (fl_overlaps_relax(o, NONE, BALANCE_SECANT, LONG, err) < 0) return -1;
    const double each = o->now.contacts ? o->now.overlap_sum / (double)o->now.contacts : 0.0;
    if (largest_helper_force(o) <= opt->share * each || each == 0.0) {
        enter(g, FL_GROWTH_BALANCE);
        return 0;
    }
    if (g->stage == TRIMS)
        return fl_fail(err, FL_NUMERIC,
                       "helper walls still carry force after %.3g of the radii near them is gone",
                       1.0 - g->trimmed);
    for (int32_t i = 0; i < p->n; i++) reach += opt->layers * 2.0 * p->bound[i] / p->n;
    for (int32_t i = 0; i < p->n; i++) {
        if (helper_distance(o->region, p->x[i], reach) >= reach) continue;
        p->radius[i] *= 1.0 - TRIM, p->size[i] *= 1.0 - TRIM, p->bound[i] *= 1.0 - TRIM;
    }
    g->trimmed *= 1.0 - TRIM;
    return 0;
}

int fl_growth_stage(fl_growth *g, fl_overlaps *o, const fl_growth_options *opt, fl_err *err)
{
    g->stage++;
    switch (g->phase) {
    case FL_GROWTH_RISE: return raise_scale(g, o, opt, err);
    case FL_GROWTH_SETTLE: return settle(g, o, opt, err);
    case FL_GROWTH_DENSEST: return follow_pressure(g, o, opt, err);
    case FL_GROWTH_BALANCE: return balance_all(g, o, err);
    case FL_GROWTH_TRIM: return trim_near(g, o, opt, err);
    default: return 0;
    }
}
