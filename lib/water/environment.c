/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include "base/array.h"
#include "base/pi.h"
#include "water/environment.h"

/* Most cells of the wave field of one body. */
#define MAX_CELLS 1000000

/* Points per column of cells for the fit of a plane to the wave. A column is no wider than 1.6 of the
 * shortest wavelength, and crests and troughs even out. */
enum { FIT_POINTS = 8 };

static const fl_wave_sample no_sample = {.q = {1, 0, 0, 0}, .when = INFINITY};

int fl_environment_alloc(fl_environment *s, int32_t n, int threads, fl_err *err)
{
    s->n = n;
    s->threads = threads;
    s->hull = fl_alloc(n, sizeof *s->hull, err);
    s->drag_radius = fl_alloc(n, sizeof *s->drag_radius, err);
    s->wetted_area = fl_alloc(n, sizeof *s->wetted_area, err);
    s->buoyancy = fl_alloc(n, sizeof *s->buoyancy, err);
    s->drag_loss = fl_alloc(n, sizeof *s->drag_loss, err);
    if (!s->hull || !s->drag_radius || !s->wetted_area || !s->buoyancy || !s->drag_loss) return -1;
    if (s->waves || s->current.kind != FL_PROFILE_UNIFORM) {
        s->flow_velocity = fl_alloc(n, sizeof *s->flow_velocity, err);
        if (!s->flow_velocity) return -1;
    }
    if (s->wind) {
        s->wind_work = fl_alloc(n, sizeof *s->wind_work, err);
        if (!s->wind_work) return -1;
    }
    if ((s->water && s->water_drag_law == FL_DRAG_FACET) || (s->wind && s->wind_drag_law == FL_DRAG_FACET)) {
        s->drag_surface = fl_alloc(n, sizeof *s->drag_surface, err);
        if (!s->drag_surface) return -1;
    }
    if (!s->waves) return 0; /* still water is evaluated in every step: it costs no more than its drag */
    if (s->sample_every > 1) {
        s->sample = fl_alloc(n, sizeof *s->sample, err);
        if (!s->sample) return -1;
        for (int32_t i = 0; i < n; i++) s->sample[i] = no_sample;
        s->sample_now = 1;
    }
    if (s->by_blocks) {
        s->nodes = fl_alloc(n, sizeof *s->nodes, err);
        s->block = fl_alloc(n, sizeof *s->block, err);
        if (!s->nodes || !s->block) return -1;
        for (int32_t i = 0; i < n; i++) s->block[i].level = FL_WAVE_NO_BLOCK;
    } else {
        s->panels = fl_alloc(n, sizeof *s->panels, err);
        if (!s->panels) return -1;
    }
    s->water_force = fl_alloc(n, sizeof *s->water_force, err);
    s->water_moment = fl_alloc(n, sizeof *s->water_moment, err);
    s->water_work = fl_alloc(n, sizeof *s->water_work, err);
    return s->water_force && s->water_moment && s->water_work ? 0 : -1;
}

static void free_surface(fl_drag_surface *skin)
{
    fl_facets_free(&skin->facets);
    fl_facet_cut_free(&skin->wet), fl_facet_cut_free(&skin->dry);
}

static int fit_surface(fl_environment *s, int32_t i, fl_err *err)
{
    const fl_hull *h = &s->hull[i];
    fl_drag_surface *skin = &s->drag_surface[i];
    free_surface(skin);
    if (h->shape->nf == 0) return 0;
    if (fl_facets_make(&skin->facets, h, err)) return -1;
    if (s->water && s->water_drag_law == FL_DRAG_FACET &&
        fl_facet_cut_make(&skin->wet, h, 0, s->flow_velocity != NULL, err))
        return -1;
    if (s->wind && s->wind_drag_law == FL_DRAG_FACET) {
        if (fl_facet_cut_make(&skin->dry, h, 1, 0, err)) return -1;
        /* without water all of it is dry */
        fl_facet_cut_update(&skin->dry, &skin->facets, h, v3(0, 0, 1), -INFINITY);
    }
    return 0;
}

/* Nodes of body i, and scratch for them. */
static int fit_nodes(fl_environment *s, int32_t i, fl_err *err)
{
    s->block[i].level = FL_WAVE_NO_BLOCK;
    s->block[i].short_blocks_left = 0;
    if (fl_wave_nodes_make(&s->nodes[i], &s->hull[i], &s->wave, s->grid.error, err)) return -1;
    if (s->nodes[i].n <= s->scratch_per_thread) return 0;
    fl_wave_node_sample *room = fl_alloc((int64_t)s->threads * s->nodes[i].n, sizeof *room, err);
    if (!room) return -1;
    free(s->node_scratch);
    s->node_scratch = room;
    s->scratch_per_thread = s->nodes[i].n;
    return 0;
}

int fl_environment_fit_hull(fl_environment *s, int32_t i, fl_err *err)
{
    if (s->sample) s->sample[i] = no_sample;
    if (s->drag_surface && fit_surface(s, i, err)) return -1;
    if (!s->waves) return 0;
    if (s->by_blocks) return fit_nodes(s, i, err);
    const int32_t want = fl_wave_field_cells(&s->wave, s->drag_radius[i] + s->wave.four_sigma);
    if (want > MAX_CELLS)
        return fl_fail(err, FL_INPUT,
                       "water.height, water.period: waves down to %.3g m long that rise by up to %.3g m "
                       "would need, for a floe of radius %.3g m, more than %d cells",
                       2.0 * PI / s->wave.max_k, s->wave.four_sigma, s->drag_radius[i], MAX_CELLS);
    if (want > s->cells_per_thread) {
        fl_wave_expansion *cells = fl_alloc((int64_t)s->threads * want, sizeof *cells, err);
        if (!cells) return -1;
        free(s->cells);
        s->cells = cells;
        s->cells_per_thread = want;
    }
    return fl_hull_panels_make(&s->panels[i], &s->hull[i], &s->wave, err);
}

void fl_environment_clear_hull(fl_environment *s, int32_t i)
{
    fl_poly *const outer = fl_environment_outer(s, i);
    fl_hull_free(&s->hull[i]);
    if (outer) fl_poly_free(outer);
    free(outer);
}

int fl_environment_set_hull(fl_environment *s, int32_t i, fl_poly *outer, const fl_poly *core, double r,
                            fl_err *err)
{
    if (!outer) {
        s->drag_radius[i] = fl_drag_radius(core, r);
        return fl_hull_make(&s->hull[i], core, r, err);
    }
    s->drag_radius[i] = fl_drag_radius(outer, 0.0);
    if (fl_hull_make(&s->hull[i], outer, 0.0, err)) return -1;
    if (!s->waves && !s->drag_surface && fl_hull_borrow_core(&s->hull[i], core, r)) return 0;
    fl_poly *const own = fl_alloc(1, sizeof *own, err);
    if (!own) {
        fl_hull_free(&s->hull[i]);
        return -1;
    }
    *own = *outer;
    *outer = (fl_poly){0};
    s->hull[i].shape = own;
    return 0;
}

void fl_environment_free(fl_environment *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        if (s->hull) fl_environment_clear_hull(s, i);
        if (s->panels) fl_hull_panels_free(&s->panels[i]);
        if (s->nodes) fl_wave_nodes_free(&s->nodes[i]);
        if (s->drag_surface) free_surface(&s->drag_surface[i]);
    }
    free(s->hull), free(s->drag_radius), free(s->wetted_area), free(s->buoyancy);
    free(s->flow_velocity), free(s->drag_loss), free(s->wind_work);
    free(s->cells), free(s->water_force), free(s->water_moment), free(s->water_work);
    free(s->panels), free(s->drag_surface), free(s->sample);
    free(s->nodes), free(s->block), free(s->node_scratch);
    fl_wave_grid_free(&s->grid);
    fl_waves_free(&s->wave);
    fl_current_free(&s->current);
    *s = (fl_environment){0};
}

/* Orbital velocity of the waves at offset r from the origin of a body, and the acceleration; world axes. */
static fl_vec3 orbital_velocity(const fl_environment *s, const fl_hull_pose *at, const fl_wave_field *around,
                                fl_vec3 r, fl_vec3 *acceleration)
{
    const double x = at->s + v3_dot(at->along, r), z = at->z + v3_dot(at->up, r),
                 zeta = fl_wave_stretch(&s->wave, z, fl_wave_field_elevation(around, x, NULL));
    double u[2], a[2];
    fl_wave_kinematics(&s->wave, fl_wave_field_cell(around, x, zeta), x, zeta, u, a);
    *acceleration = v3_madd(v3(0, 0, a[1]), a[0], s->wave.direction);
    return v3_madd(v3(0, 0, u[1]), u[0], s->wave.direction);
}

/* Updates the flow at all wet pieces. */
static void update_flow(fl_environment *s, const fl_bodies *b, int32_t i, const fl_hull_pose *at,
                        const fl_wave_field *around)
{
    const fl_mat3 R = fl_body_axes(b, i);
    fl_facet_cut *wet = &s->drag_surface[i].wet;
    int32_t k = 0;
    for (const fl_facet_group *f = wet->group; f < wet->group + wet->groups; f++)
        for (const int32_t end = k + f->pieces; k < end; k++)
            for (int l = 0; l < FL_SIMD_WIDTH; l++) {
                const fl_vec3 r = fl_facet_piece_position(f, &wet->piece[k], l);
                fl_vec3 u = v3(0, 0, 0), none;
                if (wet->piece[k].area[l] > 0.0) {
                    u = fl_current_at(&s->current, at->z + v3_dot(at->up, r));
                    if (around) u = v3_add(u, orbital_velocity(s, at, around, r, &none));
                    u = fl_facet_group_to_local(f, l, m3_tmul(R, v3_sub(u, fl_environment_flow(s, i))));
                }
                wet->flow[k].u[0][l] = u.x, wet->flow[k].u[1][l] = u.y, wet->flow[k].u[2][l] = u.z;
            }
}

/* Updates the wet and dry surface of body i, and the flow there; around: NULL without waves. */
static void update_surface(fl_environment *s, const fl_bodies *b, int32_t i, fl_vec3 up, double level,
                           const fl_hull_pose *at, const fl_wave_field *around)
{
    const fl_hull *h = &s->hull[i];
    fl_drag_surface *skin = &s->drag_surface[i];
    if (skin->dry.group) fl_facet_cut_update(&skin->dry, &skin->facets, h, up, level);
    if (!skin->wet.group) return;
    fl_facet_cut_update(&skin->wet, &skin->facets, h, up, level);
    if (skin->wet.flow) update_flow(s, b, i, at, around);
}

void fl_environment_update_surface(fl_environment *s, const fl_bodies *b, int32_t i, fl_vec3 up, double level)
{
    const fl_hull_pose at = {.up = up, .z = -level};
    update_surface(s, b, i, up, level, &at, NULL);
}

/* e_z in body axes. */
static fl_vec3 vertical_of(fl_mat3 R) { return v3(R.m[2][0], R.m[2][1], R.m[2][2]); }

/* The part below still water; up is transpose(R) e_z. Bodies wholly dry or wet by their drag radius are not
 * cut. */
static fl_submerged submerged_of(const fl_environment *s, int32_t i, fl_vec3 up, double level)
{
    const fl_hull *h = &s->hull[i];
    fl_submerged wet = {0};
    if (level >= s->drag_radius[i])
        wet = (fl_submerged){.volume = h->volume, .centre = h->centre, .wetted_area = h->surface_area};
    else if (level > -s->drag_radius[i]) fl_hull_submerged(h, up, level, &wet);
    return wet;
}

double fl_environment_energy(const fl_environment *s, const fl_bodies *b, int32_t i)
{
    const fl_vec3 up = vertical_of(fl_body_axes(b, i));
    const double level = s->level - b->x[i].z;
    const fl_submerged wet = submerged_of(s, i, up, level);
    fl_vec3 f, turn;
    return fl_buoyancy_force(&wet, up, level, s->specific_weight, &f, &turn);
}

/* The added mass of a sphere in a sheet follows its immersion; v is constant meanwhile. */
static void update_heave_mass(const fl_environment *s, fl_bodies *b, int32_t i)
{
    const double now = s->heave_factor * (s->buoyancy[i] / s->gravity), change = now - b->heave_mass[i];
    b->heave_work[i] += 0.5 * change * b->v[i].z * b->v[i].z;
    b->heave_mass[i] = now;
}

/* Evaluates still water at body i: force and moment about its centre, world axes. */
static void evaluate_still(fl_environment *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 up = vertical_of(R);
    const double level = s->level - b->x[i].z;
    const fl_submerged wet = submerged_of(s, i, up, level);
    fl_vec3 turn;
    s->wetted_area[i] = wet.wetted_area;
    fl_buoyancy_force(&wet, up, level, s->specific_weight, f, &turn);
    s->buoyancy[i] = s->specific_weight * wet.volume;
    if (s->flow_velocity) s->flow_velocity[i] = fl_current_at(&s->current, v3_dot(up, wet.centre) - level);
    if (b->added_mass) b->flow_velocity[i] = fl_environment_flow(s, i);
    if (b->heave_mass) update_heave_mass(s, b, i);
    if (s->drag_surface) fl_environment_update_surface(s, b, i, up, level);
    *f = v3(0, 0, s->buoyancy[i]); /* R up is e_z */
    *t = m3_mul(R, turn);
}

double fl_environment_omega2(const fl_environment *s, const fl_bodies *b, int32_t i, int *turns)
{
    const fl_hull *h = &s->hull[i];
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 up = vertical_of(R), none = v3(0, 0, 0);
    const fl_mobility yields = fl_body_mobility(b, i);
    fl_submerged wet;
    fl_hull_submerged(h, up, 0.0, &wet);
    double most = s->specific_weight * wet.waterplane_area * fl_mobility_along(&yields, v3(0, 0, 1), none);
    *turns = 0;
    if (h->shape->nf == 0) return most; /* a sphere or capsule has hardly any restoring moment */
    fl_waterplane plane;
    fl_hull_waterplane(h, up, 0.0, &plane);
    const fl_vec3 e = m3_tmul(R, v3(1, 0, 0)), g = m3_tmul(R, v3(0, 1, 0)), Te = m3_mul(plane.second, e);
    const double xx = v3_dot(e, Te), xy = v3_dot(g, Te), yy = v3_dot(g, m3_mul(plane.second, g)),
                 angle = 0.5 * atan2(2.0 * xy, xx - yy); /* of the principal axes */
    for (int k = 0; k < 2; k++) {
        const double a = angle + 0.5 * k * PI, c = cos(a), d = sin(a),
                     J = c * c * xx + 2.0 * c * d * xy + d * d * yy;
        const double omega2 = s->specific_weight * J * fl_mobility_along(&yields, none, v3(-d, c, 0));
        if (omega2 > most) most = omega2, *turns = 1;
    }
    return most;
}

/* Extent of body i along a direction of its own axes. */
static void extent_along(const fl_environment *s, int32_t i, fl_vec3 d, double *lo, double *hi)
{
    const fl_poly *p = s->hull[i].shape;
    const double r = s->hull[i].radius;
    double least = INFINITY, most = -INFINITY;
    for (int32_t v = 0; v < p->nv; v++) {
        const double x = v3_dot(d, p->v[v]);
        least = x < least ? x : least;
        most = x > most ? x : most;
    }
    *lo = least - r;
    *hi = most + r;
}

/* Least-squares plane of the wave along a body whose origin is at s. */
static void fit_plane(const fl_wave_field *a, double s, double *z, double *slope)
{
    const int n = FIT_POINTS * a->columns;
    const double all = n, step = a->width / FIT_POINTS, spread = all * (all * all - 1.0) / 12.0 * step * step,
                 middle = a->s0 + 0.5 * all * step; /* spread: the sum of off^2 */
    double sum = 0.0, tilt = 0.0;
    for (int k = 0; k < n; k++) {
        const double off = (k + 0.5 - 0.5 * all) * step, eta = fl_wave_field_elevation(a, middle + off, NULL);
        sum += eta;
        tilt += off * eta;
    }
    *slope = tilt / spread;
    *z = sum / all + (s - middle) * *slope;
}

/* Buoyancy of body i if the water surface is a plane, z above still water at the body's origin; world axes.
 */
static void buoyancy_on_plane(const fl_environment *s, const fl_bodies *b, int32_t i, double z, double slope,
                              fl_vec3 *f, fl_vec3 *t)
{
    const fl_mat3 R = fl_body_axes(b, i);
    const double c = 1.0 / sqrt(1.0 + slope * slope), level = c * (z + s->level - b->x[i].z);
    const fl_vec3 up = v3_scale(c, v3_madd(vertical_of(R), -slope, m3_tmul(R, s->wave.direction)));
    const fl_submerged wet = submerged_of(s, i, up, level);
    fl_vec3 force, turn;
    fl_buoyancy_force(&wet, up, level, s->specific_weight / c, &force,
                      &turn); /* the pressure grows downwards */
    *f = m3_mul(R, force);
    *t = m3_mul(R, turn);
}

/* Updates the plane at body i, which is at s, and its rates since the last sample. */
static void update_plane(fl_environment *s, int32_t i, const fl_wave_field *around, double at)
{
    fl_wave_sample *h = &s->sample[i];
    const double past = s->time - h->when, z = h->z, slope = h->slope;
    fit_plane(around, at, &h->z, &h->slope);
    if (!(past > 0.0)) return;
    h->dz = (h->z - z) / past;
    h->dslope = (h->slope - slope) / past;
}

/* Evaluates the waves at body i. */
static void evaluate_waves(fl_environment *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    const fl_waves *w = &s->wave;
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_hull_pose at = {.up = vertical_of(R),
                             .along = m3_tmul(R, w->direction),
                             .s = v3_dot(w->direction, b->x[i]),
                             .z = b->x[i].z - s->level};
    const fl_hull *h = &s->hull[i];
    fl_water_load p = {0};
    fl_wave_field around;
    const int meets = at.z - s->drag_radius[i] < w->max_crest;
    *f = *t = v3(0, 0, 0);
    if (meets || s->sample) {
        double s_lo, s_hi, z_lo, z_hi;
        extent_along(s, i, at.along, &s_lo, &s_hi);
        extent_along(s, i, at.up, &z_lo, &z_hi);
        fl_wave_field_fill(w, at.s + s_lo, at.s + s_hi, at.z + z_lo - w->four_sigma,
                           at.z + z_hi + w->four_sigma, s->time,
                           s->cells + (int64_t)omp_get_thread_num() * s->cells_per_thread, &around);
        if (s->sample) update_plane(s, i, &around, at.s);
        if (meets && h->shape->nf)
            fl_froude_krylov_solid(&s->panels[i], h, w, &around, &at, s->specific_weight, &p);
        else if (meets) fl_froude_krylov_round(h, w, &around, &at, s->specific_weight, &p);
    }
    s->wetted_area[i] = p.wetted;
    s->buoyancy[i] = s->specific_weight * p.volume;
    s->flow_velocity[i] = fl_current_at(&s->current, at.z + v3_dot(at.up, p.centre));
    if (p.volume > 0.0) {
        fl_vec3 a, up;
        double level;
        s->flow_velocity[i] = v3_add(s->flow_velocity[i], orbital_velocity(s, &at, &around, p.centre, &a));
        *f = m3_mul(R, p.force);
        *t = m3_mul(R, p.moment);
        if (b->added_mass) *f = v3_add(*f, m3_mul(R, v3_mul(b->added_mass[i], m3_tmul(R, a))));
        if (s->drag_surface) {
            fl_wave_field_plane(&around, &at, &up, &level);
            update_surface(s, b, i, up, level, &at, &around);
        }
    } else if (s->drag_surface) {
        update_surface(s, b, i, at.up, -INFINITY, &at, NULL);
    }
    if (b->added_mass) b->flow_velocity[i] = s->flow_velocity[i];
    s->water_force[i] = *f;
    s->water_moment[i] = *t;
}

/* Rate of change over `past` seconds. */
static fl_vec3 rate_of_change(fl_vec3 now, fl_vec3 then, double past)
{
    return v3_scale(1.0 / past, v3_sub(now, then));
}

/* Stores the part of the load that the plane leaves out, and its rates. */
static void store_sample(fl_environment *s, const fl_bodies *b, int32_t i, fl_vec3 f, fl_vec3 t)
{
    fl_wave_sample *h = &s->sample[i];
    const double past = s->time - h->when;
    fl_vec3 force, turn;
    buoyancy_on_plane(s, b, i, h->z, h->slope, &force, &turn);
    f = v3_sub(f, force), t = v3_sub(t, turn);
    if (past > 0.0) {
        h->df = rate_of_change(f, h->f, past);
        h->dt = rate_of_change(t, h->t, past);
        h->dflow = rate_of_change(s->flow_velocity[i], h->flow, past);
    }
    h->f = f, h->t = t, h->flow = s->flow_velocity[i];
    h->x = b->x[i], h->q = b->q[i], h->when = s->time;
}

/* --- waves in blocks of time ---------------------------------------------------------------------- */

static void extend_tables(const fl_wave_grid *g, fl_vec3 x, double r, fl_wave_extent *at)
{
    for (int32_t c = 0; c < g->lines; c++) {
        const double s = g->line[c].x * x.x + g->line[c].y * x.y;
        at->lo[c] = fmin(at->lo[c], s - r);
        at->hi[c] = fmax(at->hi[c], s + r);
    }
}

int fl_environment_prepare(fl_environment *s, const fl_bodies *b, const uint8_t *absent, double t,
                           int threads, fl_err *err)
{
    fl_wave_extent at;
    int shorter = 0;
    if (!s->by_blocks) return 0;
    const int64_t first = fl_wave_group(&s->grid, t);
    if (fl_wave_grid_view(&s->grid, first).slot >= 0 &&
        fl_wave_grid_view(&s->grid, first + FL_WAVE_GROUP).slot >= 0)
        return 0;
    for (int32_t c = 0; c < s->grid.lines; c++) at.lo[c] = INFINITY, at.hi[c] = -INFINITY;
    for (int32_t i = 0; i < s->n; i++) {
        if ((absent && absent[i]) || !v3_finite(b->x[i])) continue;
        shorter |= s->block[i].short_blocks_left > 0;
        extend_tables(&s->grid, b->x[i], s->drag_radius[i], &at);
    }
    for (int32_t k = 0; k < s->guests; k++) {
        if (!v3_finite(*s->guest[k].x)) continue;
        shorter |= s->guest[k].block->short_blocks_left > 0;
        extend_tables(&s->grid, *s->guest[k].x, s->guest[k].reach, &at);
    }
    for (int32_t c = 0; c < s->grid.lines; c++) {
        if (at.lo[c] > at.hi[c]) return 0; /* no body */
        if (at.hi[c] - at.lo[c] > FL_WAVE_GRID_MAX)
            return fl_fail(err, FL_INPUT,
                           "water.wave_error: bodies are %.4g km apart along the waves, at most %g km are "
                           "expected",
                           1e-3 * (at.hi[c] - at.lo[c]), 1e-3 * FL_WAVE_GRID_MAX);
    }
    return fl_wave_grid_fill(&s->grid, &at, first, shorter ? 1 : 2, shorter ? 7 : 4, threads, err);
}

static fl_wave_body wave_body(const fl_environment *s, int32_t i)
{
    return (fl_wave_body){.hull = &s->hull[i],
                          .nodes = &s->nodes[i],
                          .reach = s->drag_radius[i],
                          .scratch = s->node_scratch + (int64_t)omp_get_thread_num() * s->scratch_per_thread};
}

/* Velocity of the water at all wet pieces of body i, under the plane. */
static void update_block_flow(fl_environment *s, const fl_bodies *b, int32_t i, const fl_wave_values *v)
{
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 x = v3(b->x[i].x, b->x[i].y, b->x[i].z - s->level);
    fl_facet_cut *wet = &s->drag_surface[i].wet;
    fl_wave_flow flow;
    int32_t k = 0;
    fl_wave_block_flow(&s->block[i], &s->grid, s->time, &flow);
    for (const fl_facet_group *f = wet->group; f < wet->group + wet->groups; f++)
        for (const int32_t end = k + f->pieces; k < end; k++)
            for (int l = 0; l < FL_SIMD_WIDTH; l++) {
                fl_vec3 u = v3(0, 0, 0);
                if (wet->piece[k].area[l] > 0.0) {
                    const fl_vec3 r = m3_mul(R, fl_facet_piece_position(f, &wet->piece[k], l));
                    const double eta = v->z + v->slope[0] * r.x + v->slope[1] * r.y;
                    u = v3_add(fl_current_at(&s->current, x.z + r.z),
                               fl_wave_flow_velocity(&flow, x.x + r.x, x.y + r.y, x.z + r.z, eta));
                    u = fl_facet_group_to_local(f, l, m3_tmul(R, v3_sub(u, fl_environment_flow(s, i))));
                }
                wet->flow[k].u[0][l] = u.x, wet->flow[k].u[1][l] = u.y, wet->flow[k].u[2][l] = u.z;
            }
}

/* Evaluates the waves at body i from its block, which is begun anew when due. */
static void evaluate_block(fl_environment *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    fl_wave_values v;
    fl_submerged wet;
    const fl_wave_body body = wave_body(s, i);
    fl_wave_block *const c = &s->block[i];
    const fl_quat q = *fl_body_attitude(b, i);
    if (fl_wave_block_due(c, &s->sea, body.reach, s->time, b->x[i], q))
        fl_wave_block_begin(c, &s->sea, &body, b, i, s->time);
    fl_wave_block_load(c, &s->sea, &body, s->time, b->x[i], q, &v, &wet, f, t);
    s->wetted_area[i] = wet.wetted_area;
    s->buoyancy[i] = s->specific_weight * wet.volume;
    s->flow_velocity[i] = v.flow;
    if (b->added_mass) {
        const fl_mat3 R = fl_body_axes(b, i);
        if (wet.volume > 0.0)
            *f = v3_add(*f, m3_mul(R, v3_mul(b->added_mass[i], m3_tmul(R, v.acceleration))));
        b->flow_velocity[i] = v.flow;
    }
    if (s->drag_surface) {
        const fl_mat3 R = fl_body_axes(b, i);
        const double n = 1.0 / sqrt(1.0 + v.slope[0] * v.slope[0] + v.slope[1] * v.slope[1]);
        fl_drag_surface *skin = &s->drag_surface[i];
        const fl_vec3 up = m3_tmul(R, v3(-n * v.slope[0], -n * v.slope[1], n));
        const double level = wet.volume > 0.0 ? n * (v.z + s->level - b->x[i].z) : -INFINITY;
        if (skin->dry.group) fl_facet_cut_update(&skin->dry, &skin->facets, &s->hull[i], up, level);
        if (skin->wet.group) fl_facet_cut_update(&skin->wet, &skin->facets, &s->hull[i], up, level);
        if (skin->wet.group && skin->wet.flow) update_block_flow(s, b, i, &v);
    }
    s->water_force[i] = *f;
    s->water_moment[i] = *t;
}

static void evaluate_water(fl_environment *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    if (s->by_blocks) evaluate_block(s, b, i, f, t);
    else if (s->waves) evaluate_waves(s, b, i, f, t);
    else evaluate_still(s, b, i, f, t);
    if (s->sample) store_sample(s, b, i, *f, *t);
}

/* Extrapolates the load from the last sample. */
static void extrapolate_sample(fl_environment *s, fl_bodies *b, int32_t i, fl_vec3 *f, fl_vec3 *t)
{
    const fl_wave_sample *h = &s->sample[i];
    const double past = s->time - h->when;
    buoyancy_on_plane(s, b, i, h->z + past * h->dz, h->slope + past * h->dslope, f, t);
    *f = v3_add(*f, v3_madd(h->f, past, h->df));
    *t = v3_add(*t, v3_madd(h->t, past, h->dt));
    s->flow_velocity[i] = v3_madd(h->flow, past, h->dflow);
    if (b->added_mass) b->flow_velocity[i] = s->flow_velocity[i];
    s->water_force[i] = *f, s->water_moment[i] = *t;
}

void fl_environment_force(fl_environment *s, fl_bodies *b, int32_t i)
{
    fl_vec3 f, t;
    if (s->sample && !s->sample_now) extrapolate_sample(s, b, i, &f, &t);
    else evaluate_water(s, b, i, &f, &t);
    b->f[i] = v3_add(b->f[i], f);
    b->t[i] = v3_add(b->t[i], t);
}

void fl_environment_refresh(fl_environment *s, fl_bodies *b, int32_t i)
{
    fl_vec3 f, t;
    if (!s->water) return;
    if (!s->sample) {
        const double work = b->heave_mass ? b->heave_work[i] : 0.0;
        if (s->block && s->block[i].level != FL_WAVE_NO_BLOCK) {
            const fl_wave_body body = wave_body(s, i);
            fl_wave_block_fill(&s->block[i], &s->sea, &body);
        }
        evaluate_water(s, b, i, &f, &t);
        if (b->heave_mass) b->heave_work[i] = work;
        return;
    }
    const fl_vec3 x = b->x[i];
    const fl_quat q = b->q[i];
    const double now = s->time;
    b->x[i] = s->sample[i].x, b->q[i] = s->sample[i].q, s->time = s->sample[i].when;
    evaluate_water(s, b, i, &f, &t);
    b->x[i] = x, b->q[i] = q, s->time = now;
    if (now > s->sample[i].when)
        extrapolate_sample(s, b, i, &f, &t); /* at the time of the sample itself there is nothing to add */
}

void fl_environment_add_work(fl_environment *s, const fl_bodies *b, int32_t i, double h, fl_vec3 v0,
                             fl_vec3 w0)
{
    s->water_work[i] +=
        0.5 * h *
        (v3_dot(s->water_force[i], v3_add(v0, b->v[i])) + v3_dot(s->water_moment[i], v3_add(w0, b->w[i])));
}

double fl_environment_decay_velocity(fl_bodies *b, int32_t i, const fl_fluid *fluid, double area,
                                     double reach, fl_vec3 c, double h)
{
    const double before = fl_body_kinetic_energy(b, i) - b->work_of_constraints[i];
    const fl_vec3 u = v3_sub(b->v[i], c), v0 = b->v[i], w0 = b->w[i];
    const double speed = v3_norm(u), spin2 = v3_norm2(b->w[i]);
    const double c_force = fl_drag_force_constant(fluid, area), m = b->m[i];
    if (b->added_mass) {
        /* each axis with its own mass: implicit in u, with |u| of the start, which is the exact decay along
         * an axis and slows the others for any step */
        const fl_mat3 R = fl_body_axes(b, i);
        const fl_vec3 a = b->added_mass[i], p = m3_tmul(R, u);
        const double s = c_force * speed * h;
        b->v[i] = v3_add(c, m3_mul(R, v3(p.x / (1.0 + s / (m + a.x)), p.y / (1.0 + s / (m + a.y)),
                                         p.z / (1.0 + s / (m + a.z)))));
    } else {
        b->v[i] = v3_madd(c, fl_drag_decay_factor(m, c_force, speed, h), u);
        if (b->heave_mass)
            b->v[i].z = c.z + u.z * fl_drag_decay_factor(m + b->heave_mass[i], c_force, speed, h);
    }
    const double turning = v3_dot(b->w[i], b->L[i]);
    if (turning > 0.0 && fluid->moment_coefficient > 0.0) {
        /* about the axis of rotation, whose moment of inertia is w.L/w^2: exact for a principal axis; both
         * sides of the factor times w^2 */
        const double turn = fl_drag_decay_factor(turning, fl_drag_moment_constant(fluid, area, reach) * spin2,
                                                 sqrt(spin2), h);
        b->L[i] = v3_scale(turn, b->L[i]);
        b->w[i] = v3_scale(turn, b->w[i]);
    }
    if (b->fixed_dof[i]) fl_body_apply_fixed_dof(b, i, v0, w0);
    return fl_body_kinetic_energy(b, i) - b->work_of_constraints[i] - before;
}

/* The same by facets. */
static double decay_by_facets(fl_bodies *b, int32_t i, const fl_facet_cut *of, fl_facet_drag_law law,
                              fl_vec3 c, double h)
{
    const double before = fl_body_kinetic_energy(b, i) - b->work_of_constraints[i], m = b->m[i];
    const fl_vec3 v0 = b->v[i], w0 = b->w[i], I = b->I[i], a = b->added_mass ? b->added_mass[i] : v3(0, 0, 0);
    const fl_mat3 R = fl_body_axes(b, i);
    fl_vec3 v = m3_tmul(R, v3_sub(v0, c)), w = m3_tmul(R, w0);
    fl_facet_drag(of, law, v3(m + a.x, m + a.y, m + a.z), I, h, &v, &w);
    b->v[i] = v3_add(c, m3_mul(R, v));
    b->w[i] = m3_mul(R, w);
    b->L[i] = m3_mul(R, v3_mul(I, w));
    if (b->fixed_dof[i]) fl_body_apply_fixed_dof(b, i, v0, w0);
    return fl_body_kinetic_energy(b, i) - b->work_of_constraints[i] - before;
}

static void apply_water_drag(fl_environment *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->water || s->wetted_area[i] <= 0.0) return;
    if (s->drag_surface && s->drag_surface[i].wet.group)
        s->drag_loss[i] -= decay_by_facets(b, i, &s->drag_surface[i].wet, fl_environment_water_law(s),
                                           fl_environment_flow(s, i), h);
    else
        s->drag_loss[i] -= fl_environment_decay_velocity(b, i, &s->seawater, s->wetted_area[i],
                                                         s->drag_radius[i], fl_environment_flow(s, i), h);
}

static void apply_wind_drag(fl_environment *s, fl_bodies *b, int32_t i, double h)
{
    if (!s->wind) return;
    const double dry = s->hull[i].surface_area - (s->water ? s->wetted_area[i] : 0.0);
    if (!(dry > 0.0)) return;
    if (s->drag_surface && s->drag_surface[i].dry.group)
        s->wind_work[i] +=
            decay_by_facets(b, i, &s->drag_surface[i].dry, fl_environment_wind_law(s), s->wind_velocity, h);
    else
        s->wind_work[i] +=
            fl_environment_decay_velocity(b, i, &s->air, dry, s->drag_radius[i], s->wind_velocity, h);
}

void fl_environment_apply_impulses(fl_environment *s, fl_bodies *b, int32_t i, double h, int back)
{
    for (int32_t k = 0; k < s->impulses; k++) {
        const double before = fl_body_kinetic_energy(b, i) - b->work_of_constraints[i];
        const fl_vec3 v0 = b->v[i], w0 = b->w[i];
        s->impulse[back ? s->impulses - 1 - k : k]->impulse(s, b, i, h);
        if (b->fixed_dof[i]) fl_body_apply_fixed_dof(b, i, v0, w0);
        s->drag_loss[i] -= fl_body_kinetic_energy(b, i) - b->work_of_constraints[i] - before;
    }
}

void fl_environment_drag(fl_environment *s, fl_bodies *b, int32_t i, double h, int back)
{
    if (back && s->impulses) fl_environment_apply_impulses(s, b, i, h, back);
    if (back) apply_wind_drag(s, b, i, h);
    apply_water_drag(s, b, i, h);
    if (!back) apply_wind_drag(s, b, i, h);
    if (!back && s->impulses) fl_environment_apply_impulses(s, b, i, h, back);
}
