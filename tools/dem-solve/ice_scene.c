/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice_scene.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "contact/bond_list.h"
#include "ice/drift_bounds.h"
#include "scene/scene.h"
#include "sim/ice_push.h"
#include "world/access.h"

/* Cosine from which a drift is along an axis. */
#define ALONG_AXIS 0.99

/* Share of the speed of the inflow below which the ice behind its bound stands, and floe sizes within which
 * it is looked at. */
#define STANDS 0.5
#define SIZES_BEHIND 3.0

/* Concentration from which drifting floes mostly touch, and lean on those that are held up (WMO). */
#define FLOES_TOUCH 0.6

/* Brash: pieces below 2 m (WMO) that fill their channel; they pass below a hull and do not jam beside it. */
#define BRASH_SIZE 2.0
#define BRASH_CONCENTRATION 0.7
#define LEAST_CM 0.45 /* of the ice class rules */

/* Share of the floes that come in of those that had to wait, from which the inflow is met. */
#define WAITED 0.05

double body_thickness(const fl_poly *p, double radius)
{
    double smallest = p->nf ? INFINITY : 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        double lo = INFINITY, hi = -INFINITY;
        for (int32_t v = 0; v < p->nv; v++) {
            const double h = v3_dot(p->n[f], p->v[v]);
            lo = fmin(lo, h), hi = fmax(hi, h);
        }
        smallest = fmin(smallest, hi - lo);
    }
    return smallest + 2.0 * radius;
}

/* Area of body i in the plane of the water [m2]. */
static double area_of_floe(const fl_world *w, int32_t i)
{
    const double r = w->b.radius[i], density = w->scene->material[w->material[i]].density;
    if (!w->b.core[i].nf) return PI * r * r;
    return w->b.m[i] / (density * body_thickness(&w->b.core[i], r));
}

struct ice_sums {
    double area, mass, volume;
    fl_vec3 momentum;
    fl_aabb box;
    int32_t n;
};

static struct ice_sums sum_ice(const fl_world *w)
{
    struct ice_sums s = {.box = aabb_empty()};
    for (int32_t i = 0; i < w->n; i++) {
        const fl_poly *p = &w->b.core[i];
        const double r = w->b.radius[i];
        if (fl_body_absent(w, i)) continue;
        s.n++;
        s.area += area_of_floe(w, i);
        s.mass += w->b.m[i];
        s.volume += w->b.m[i] / w->scene->material[w->material[i]].density;
        s.momentum = v3_add(s.momentum, v3_scale(w->b.m[i], w->b.v[i]));
        for (int32_t v = 0; v < p->nv; v++) {
            const fl_vec3 x = v3_add(w->b.x[i], q_rotate(*fl_body_attitude(&w->b, i), p->v[v]));
            s.box = aabb_add(s.box, v3_sub(x, v3(r, r, r)));
            s.box = aabb_add(s.box, v3_add(x, v3(r, r, r)));
        }
    }
    return s;
}

static double side_of(double lo, double hi, double ice_lo, double ice_hi)
{
    return (isfinite(hi) ? hi : ice_hi) - (isfinite(lo) ? lo : ice_lo);
}

/* --- the structure at the water line ---------------------------------------------------------- */

/* Grow an interval by the point between a and b at z = level, where there is one; across: unit vector. */
static void add_crossing(fl_obstacle *to, fl_vec3 a, fl_vec3 b, double level, fl_vec3 across)
{
    if ((a.z - level) * (b.z - level) > 0.0 || a.z == b.z) return;
    const double t = (level - a.z) / (b.z - a.z);
    const double y = (1.0 - t) * v3_dot(a, across) + t * v3_dot(b, across);
    to->lo = fmin(to->lo, y);
    to->hi = fmax(to->hi, y);
}

static fl_obstacle interval_of_triangle(const fl_part *p, const fl_tri *t, double level, fl_vec3 across)
{
    fl_obstacle to = {INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) add_crossing(&to, p->v[t->v[k]], p->v[t->v[(k + 1) % 3]], level, across);
    return to;
}

static fl_obstacle interval_of_cone(const fl_cone *c, double level, fl_vec3 across)
{
    fl_obstacle to = {INFINITY, -INFINITY};
    add_crossing(&to, c->p0, c->p1, level, across);
    if (!(to.lo <= to.hi)) return to;
    const double t = (level - c->p0.z) / (c->p1.z - c->p0.z), r = c->r0 + t * (c->r1 - c->r0);
    return (fl_obstacle){to.lo - r, to.hi + r};
}

/* Width of what stands in the way, with gaps below `gap` closed. */
static int measure_structure(struct ice_scene *s, const fl_surface *surface, double level, fl_vec3 across,
                             double gap, fl_err *err)
{
    int32_t n = 0, room = 0;
    for (int32_t k = 0; k < surface->n; k++) room += surface->part[k].nt + surface->part[k].nc;
    fl_obstacle *a = fl_alloc(room + 1, sizeof *a, err);
    if (!a) return -1;
    for (int32_t k = 0; k < surface->n; k++) {
        const fl_part *p = &surface->part[k];
        for (int32_t j = 0; j < p->nt + p->nc; j++) {
            a[n] = j < p->nt ? interval_of_triangle(p, &p->t[j], level, across)
                             : interval_of_cone(&p->cone[j - p->nt], level, across);
            n += a[n].lo <= a[n].hi;
        }
    }
    s->obstacles = fl_join_intervals(n, a, gap, &s->structure_width);
    free(a);
    return 0;
}

/* --- which scene ------------------------------------------------------------------------------- */

static enum ice_scene_kind kind_of(const fl_world *w, int32_t floes)
{
    const fl_scene *s = w->scene;
    const fl_scene_motion *m = &s->structure.motion;
    int driven = s->boundary.drive_group[0] || s->boundary.drive_width > 0.0 || w->push.of == FL_PUSH_WALL;
    for (int32_t k = 0; k < s->n_group; k++) driven = driven || v3_norm(s->group[k].velocity) > 0.0;
    if (fl_world_bonds(w)) return SCENE_SHEET;
    if (driven) return SCENE_DRIVEN;
    if (w->inflow.feed) return SCENE_DRIFT;
    if (v3_norm(m->velocity) > 0.0 || m->track[0]) return SCENE_TOWED;
    return floes == 1 ? SCENE_ONE_FLOE : SCENE_FIELD_ONCE;
}

/* Velocity of the ice against the structure, horizontal. */
static fl_vec3 approach(const fl_world *w, const struct ice_sums *ice)
{
    fl_vec3 v = w->scene->water.current;
    if (w->inflow.feed)
        v = w->inflow.axis ? v3(0.0, w->inflow.sign * w->inflow.speed, 0.0)
                           : v3(w->inflow.sign * w->inflow.speed, 0.0, 0.0);
    else if (w->push.of)
        v = w->push.axis ? v3(0.0, w->push.sign * w->push.speed, 0.0)
                         : v3(w->push.sign * w->push.speed, 0.0, 0.0);
    else if (v3_norm(v) == 0.0) v = v3_scale(1.0 / ice->mass, ice->momentum);
    v = v3_sub(v, w->scene->structure.motion.velocity);
    v.z = 0.0;
    return v;
}

/* Width of the field across axis-aligned drift; infinite where a side is free. */
static double width_across(const fl_world *w, fl_vec3 along)
{
    const fl_scene_boundary *b = &w->scene->boundary;
    const int axis = fabs(along.x) > ALONG_AXIS ? 1 : fabs(along.y) > ALONG_AXIS ? 0 : -1;
    if (axis < 0 || b->type[axis] == FL_BOUNDARY_FREE) return INFINITY;
    return axis ? b->max.y - b->min.y : b->max.x - b->min.x;
}

/* A channel has walls at both sides of the structure. */
static int is_channel(const fl_world *w, const struct ice_scene *s, fl_vec3 along)
{
    const int across = fabs(along.x) > ALONG_AXIS;
    return isfinite(s->field_width) && w->scene->boundary.type[across] != FL_BOUNDARY_PERIODIC;
}

int ice_scene_make(struct ice_scene *s, const struct run *r, fl_err *err)
{
    const fl_world *w = r->w;
    const fl_scene_boundary *b = &w->scene->boundary;
    *s = (struct ice_scene){.field_width = INFINITY};
    if (!w->sea.water || !r->surface || !w->n) return 0;
    const struct ice_sums ice = sum_ice(w);
    if (!(ice.area > 0.0 && ice.mass > 0.0)) return 0;
    const double x = side_of(b->min.x, b->max.x, ice.box.lo.x, ice.box.hi.x),
                 y = side_of(b->min.y, b->max.y, ice.box.lo.y, ice.box.hi.y);
    const fl_vec3 v = approach(w, &ice);
    s->speed = v3_norm(v);
    s->kind = kind_of(w, ice.n);
    s->ice_area = ice.area;
    s->concentration = fmin(1.0, ice.area / (x * y));
    s->mass_per_area = ice.mass / (x * y);
    s->thickness = ice.volume / ice.area;
    s->layer = ice.box.hi.z - ice.box.lo.z;
    s->floe_size = sqrt(ice.area / ice.n);
    if (!(s->speed > 0.0)) {
        s->kind = SCENE_OTHER;
        return 0;
    }
    const fl_vec3 along = v3_scale(1.0 / s->speed, v), across = v3(-along.y, along.x, 0.0);
    s->field_width = width_across(w, along);
    if (s->kind == SCENE_TOWED && s->floe_size < BRASH_SIZE && s->concentration > BRASH_CONCENTRATION &&
        is_channel(w, s, along))
        s->kind = SCENE_BRASH;
    return measure_structure(s, r->surface, w->scene->water.level, across, FL_ARCH_SIZES * s->floe_size, err);
}

/* --- what is said ------------------------------------------------------------------------------- */

static double restitution_of(const fl_world *w)
{
    const int32_t ice = fl_scene_find_material(w->scene, w->scene->ice.material);
    return fl_scene_pair(w->scene, ice < 0 ? 0 : ice, FL_SCENE_STRUCTURE).restitution;
}

/* Momentum of what meets each obstacle [kN]. */
static double momentum_of(const struct ice_scene *s, const fl_world *w)
{
    return 1e-3 * fl_momentum_load(restitution_of(w), s->mass_per_area, s->speed,
                                   s->structure_width + s->obstacles * s->floe_size);
}

static double drag_of(const struct ice_scene *s, const fl_world *w)
{
    const fl_scene_water *a = &w->scene->water;
    return 1e-3 * fl_drag_of_held_ice(a->density, a->drag_force_coef, s->speed, s->ice_area);
}

/* Width of a pack for which the driving force of nature is told [m], and the range of ISO's coefficient. */
#define PACK_WIDTH 1e3
#define PACK_LOW 2.0
#define PACK_HIGH 10.0

/* What bounds ice that is pushed: the push of the run, or that of nature. */
static void report_push_bound(const struct ice_scene *s, const fl_world *w, FILE *f)
{
    const fl_push *p = &w->push;
    if (p->of && isfinite(p->limit)) {
        fprintf(f, "bound by a push of %.3g kN/m over %.3g m, %.3g kN", 1e-3 * p->limit / p->width, p->width,
                1e-3 * p->limit);
        return;
    }
    fprintf(
        f,
        "bound by nothing in the run, in nature by what pushes: %.3g to %.3g kN for a pack of 1 km, p_D of "
        "ISO 19906",
        1e-3 * s->structure_width * fl_iso_line_load(PACK_LOW, s->thickness, PACK_WIDTH),
        1e-3 * s->structure_width * fl_iso_line_load(PACK_HIGH, s->thickness, PACK_WIDTH));
}

static void report_width(const struct ice_scene *s, FILE *f)
{
    fprintf(f, "; C %.2g of %.3g m floes", s->concentration, s->floe_size);
    if (isfinite(s->field_width))
        fprintf(f, ", %.2g beside a structure of %.3g m in a width of %.3g m (jams at %g)",
                fl_concentration_beside(s->concentration, s->field_width, s->structure_width),
                s->structure_width, s->field_width, FL_JAM_CONCENTRATION);
    fputc('\n', f);
}

void ice_scene_report(const struct ice_scene *s, const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    switch (s->kind) {
    case SCENE_OTHER: return;
    case SCENE_ONE_FLOE:
        fprintf(
            f,
            "dem-solve: scene: one floe of %.4g t at %.3g m/s, bound by its momentum: an impulse of at most "
            "%.4g kN s, of a hit in line with its centre\n",
            1e-3 * w->b.m[0], s->speed,
            1e-3 * fl_floe_impulse(restitution_of(w), w->b.m[0], s->speed, 0.0, 1.0));
        return;
    case SCENE_FIELD_ONCE:
        fprintf(f,
                "dem-solve: scene: a field once at %.3g m/s, bound by momentum, mean about %.3g kN while it "
                "passes, and by the drag on ice that is held up, at most %.3g kN",
                s->speed, momentum_of(s, w), drag_of(s, w));
        break;
    case SCENE_DRIFT:
        fprintf(f,
                "dem-solve: scene: drift without end at %.3g m/s, mean about %.3g kN while floes pass%s; "
                "once they "
                "jam, ",
                s->speed, momentum_of(s, w),
                s->concentration > FLOES_TOUCH ? ", several times as much above C 0.6, where they touch"
                                               : "");
        report_push_bound(s, w, f);
        break;
    case SCENE_DRIVEN:
        fputs("dem-solve: scene: driven ice, ", f);
        report_push_bound(s, w, f);
        break;
    case SCENE_SHEET:
        fputs("dem-solve: scene: a bonded sheet, bound by its strength in bending and crushing\n", f);
        return;
    case SCENE_TOWED:
        fprintf(f,
                "dem-solve: scene: a structure under way in ice at %.3g m/s, momentum of what it meets about "
                "%.3g kN",
                s->speed, momentum_of(s, w));
        break;
    case SCENE_BRASH:
        fprintf(
            f,
            "dem-solve: scene: a structure under way at %.3g m/s in a channel of brash, %.3g m of pieces of "
            "%.3g m, bound by weight and rubbing of the layer: at 5 knots above %.3g kN by the ice class "
            "rules, with their least for a breadth of %.3g m in %.3g m\n",
            s->speed, s->layer, s->floe_size,
            1e-3 * fl_brash_load(s->layer, s->structure_width, LEAST_CM, 0.0, 0.0, 0.0, 0.0),
            s->structure_width, s->field_width);
        return;
    }
    report_width(s, f);
}

void ice_scene_warn_width(const struct ice_scene *s, FILE *f)
{
    const double beside = fl_concentration_beside(s->concentration, s->field_width, s->structure_width),
                 needed = fl_width_needed(s->concentration, s->structure_width);
    if (s->kind == SCENE_OTHER || s->kind == SCENE_ONE_FLOE || s->kind == SCENE_SHEET ||
        s->kind == SCENE_BRASH || !isfinite(s->field_width) || !(s->structure_width > 0.0) ||
        beside < FL_JAM_CONCENTRATION)
        return;
    fprintf(
        f,
        "dem-solve: warning: the field is too narrow: ice of C %.2g in a width of %.4g m is C %.3g beside "
        "the structure, %.3g m with its narrow gaps, and jams from %g on: the load is that of the sides "
        "and of what pushes, and is not stationary; ",
        s->concentration, s->field_width, fmin(beside, 99.0), s->structure_width, FL_JAM_CONCENTRATION);
    if (isfinite(needed))
        fprintf(f, "a width above %.3g m, better twice that, or less ice is expected\n", needed);
    else fputs("no width helps: the confinement is part of the answer, see ice-scenes(7)\n", f);
}

void ice_scene_warn_inflow(const struct run *r, FILE *f)
{
    const fl_world *w = r->w;
    const fl_inflow_state *t = &w->inflow;
    double area = 0.0, speed = 0.0;
    int32_t n = 0, behind = 0;
    if (!t->feed || !w->sea.water || fl_world_bonds(w)) return; /* a sheet pushes back as a whole */
    for (int32_t i = 0; i < w->n; i++)
        if (!fl_body_absent(w, i)) area += area_of_floe(w, i), n++;
    const double reach = n ? SIZES_BEHIND * sqrt(area / n) : 0.0;
    for (int32_t i = 0; i < w->n; i++) {
        const double x = t->axis ? w->b.x[i].y : w->b.x[i].x, v = t->axis ? w->b.v[i].y : w->b.v[i].x;
        if (fl_body_absent(w, i) || t->guided[i] || t->sign * x - t->entry > reach) continue;
        speed += t->sign * v;
        behind++;
    }
    const int stands = behind > 2 && speed < STANDS * t->speed * behind;
    const int waited = (double)t->n_blocked > WAITED * (double)t->n_entered;
    if (!stands && !waited) return;
    fputs("dem-solve: warning: a jam has met the inflow: ", f);
    if (stands)
        fprintf(f, "the ice behind its bound moves at %.2g of its speed", speed / (behind * t->speed));
    if (stands && waited) fputs(", and ", f);
    if (waited)
        fprintf(f, "%.2g of the floes that came in had to wait", (double)t->n_blocked / (double)t->n_entered);
    if (w->push.of == FL_PUSH_INFLOW) {
        fprintf(f,
                "; from then on its push of at most %.3g kN bounds the loads, and its speed falls, see "
                "ice-scenes(7)\n",
                1e-3 * w->push.limit);
        return;
    }
    fputs("; from then on the inflow pushes with any force, and the loads are its own: a bound farther "
          "upstream, a shorter run, less ice, or boundary.line_load is expected, see ice-scenes(7)\n",
          f);
}
