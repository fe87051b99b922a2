/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/ice_push.h"
#include <math.h>
#include "base/pi.h"
#include "sim/drive_track.h"
#include "world/access.h"

double fl_iso_line_load(double coefficient, double thickness, double pack_width)
{
    return 1e6 * coefficient * pow(thickness, 1.25) * pow(pack_width, -0.54);
}

/* --- set-up ------------------------------------------------------------------------------------ */

/* Extent of the floes of a field across the way of the push; of those that are driven, if `driven`. */
static double width_of_field(const fl_world *w, const fl_ice_field *field, int driven)
{
    const fl_inflow_state across = {.axis = 1 - w->push.axis, .sign = 1.0};
    double lo = INFINITY, hi = -INFINITY;
    for (int32_t k = 0; k < field->n; k++) {
        if (driven && !w->driven_floes.is_driven[k]) continue;
        for (int32_t v = 0; v < field->core[k].nv; v++) {
            const double x = across.axis ? field->core[k].v[v].y : field->core[k].v[v].x;
            lo = fmin(lo, x - field->radius[k]);
            hi = fmax(hi, x + field->radius[k]);
        }
    }
    return hi > lo ? hi - lo : 0.0;
}

static double width_between_bounds(const fl_world *w)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    const int across = 1 - w->push.axis;
    if (s->type[across] == FL_BOUNDARY_FREE) return INFINITY;
    return across ? s->max.y - s->min.y : s->max.x - s->min.x;
}

/* Area of floe i in the plane of the water: its mass over density and thickness, here by its shape. */
static double plan_area(const fl_world *w, int32_t i)
{
    const double r = w->b.radius[i];
    return w->b.core[i].nv == 1 ? PI * r * r : w->max_face_area[i];
}

/* Mean thickness of the ice [m], and mass of a row of mean floes across the width [kg]. */
static double measure_ice(const fl_world *w, double *row)
{
    double area = 0.0, mass = 0.0, volume = 0.0;
    int32_t n = 0;
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_body_absent(w, i)) continue;
        const double a = plan_area(w, i);
        area += a, mass += w->b.m[i], n++;
        volume += w->b.m[i] / w->scene->material[w->material[i]].density;
    }
    *row = n ? mass / area * sqrt(area / n) * w->push.width : 0.0;
    return area > 0.0 ? volume / area : 0.0;
}

static int32_t wall_at(const fl_world *w, int axis, double sign)
{
    for (int32_t k = w->n + w->pieces; k < w->b.total; k++) {
        const fl_vec3 n = m3_col(fl_body_axes(&w->b, k), 2);
        if (sign * (axis ? n.y : n.x) > 0.5) return k;
    }
    return -1;
}

static int set_wall(fl_world *w, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_push *p = &w->push;
    const int axis = s->drive_edge ? (s->drive_edge - 1) / 2 : fabs(s->drive.x) < fabs(s->drive.y);
    const double v = axis ? s->drive.y : s->drive.x;
    p->of = FL_PUSH_WALL;
    p->axis = axis;
    p->sign = s->drive_edge ? (s->drive_edge % 2 ? 1.0 : -1.0) : v > 0.0 ? 1.0 : -1.0;
    p->speed = p->sign * v;
    p->wall = wall_at(w, p->axis, p->sign);
    if (w->spheres.bodies)
        return fl_scene_fail(w->scene, "boundary.drive_of", err,
                             "spheres meet walls that stand: a driven row, drive_width, is expected");
    if (!s->drive_track[0]) return 0;
    if (fl_drive_track_read(w, err)) return -1;
    const fl_track *tr = &w->driven_floes.track;
    for (int32_t k = 0; k < tr->n; k++) {
        const fl_vec3 x = tr->value[k].x;
        if ((axis ? x.x : x.y) != 0.0 || x.z != 0.0)
            return fl_fail(err, FL_INPUT, "%s: it leaves %c at %g s, and the wall moves along %c alone",
                           s->drive_track, 'x' + axis, tr->t[k], 'x' + axis);
    }
    const fl_vec3 first = fl_drive_track_velocity(w, 0.0);
    p->speed = p->sign * (axis ? first.y : first.x);
    return 0;
}

static int has_limit(const fl_scene_boundary *s) { return s->line_load > 0.0 || s->iso_pack_width > 0.0; }

static void set_row(fl_world *w)
{
    const fl_vec3 v = w->scene->boundary.drive;
    fl_push *p = &w->push;
    p->of = FL_PUSH_ROW;
    p->axis = v.x == 0.0;
    p->sign = v.x + v.y > 0.0 ? 1.0 : -1.0;
    p->speed = fabs(v.x + v.y);
}

static int set_inflow(fl_world *w, fl_err *err)
{
    fl_push *p = &w->push;
    if (w->inflow.join.first)
        return fl_scene_fail(w->scene, "boundary.inflow", err,
                             "a bonded sheet comes in at one speed: no line load is expected");
    p->of = FL_PUSH_INFLOW;
    p->axis = w->inflow.axis;
    p->sign = w->inflow.sign;
    p->speed = w->inflow.speed;
    return 0;
}

int fl_ice_push_make(fl_world *w, const fl_ice_field *field, const fl_ice_field *feed, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_push *p = &w->push;
    double row = 0.0;
    *p = (fl_push){.wall = -1, .limit = INFINITY};
    if (!s->head.present) return 0;
    if (s->drive_of == FL_DRIVE_OF_WALL) {
        if (set_wall(w, err)) return -1;
    } else if (!has_limit(s)) return 0;
    else if (w->driven_floes.n) set_row(w);
    else if (set_inflow(w, err)) return -1;
    p->velocity = p->speed;
    p->width = width_between_bounds(w);
    if (!isfinite(p->width))
        p->width = width_of_field(w, p->of == FL_PUSH_INFLOW ? feed : field, p->of == FL_PUSH_ROW);
    const double thickness = measure_ice(w, &row);
    if (s->line_load > 0.0) p->limit = s->line_load * p->width;
    if (s->iso_pack_width > 0.0)
        p->limit = p->width * fl_iso_line_load(s->iso_pack_coefficient, thickness, s->iso_pack_width);
    p->mass = p->of == FL_PUSH_ROW ? 0.0 : row;
    for (int32_t i = 0; i < w->n && p->of == FL_PUSH_ROW; i++)
        if (fl_floe_is_driven(w, i)) p->mass += w->b.m[i];
    if (p->wall >= 0) {
        const double v = p->sign * p->velocity;
        w->b.v[p->wall] = p->axis ? v3(0, v, 0) : v3(v, 0, 0);
    }
    w->moving.max_speed = fmax(w->moving.max_speed, fabs(p->speed));
    return 0;
}

/* --- a step ------------------------------------------------------------------------------------ */

/* 1 if floe i is moved by what pushes. */
static int is_pushed(const fl_world *w, int32_t i)
{
    if (fl_body_absent(w, i)) return 0;
    return w->push.of == FL_PUSH_ROW ? fl_floe_is_driven(w, i) : w->inflow.guided[i];
}

static double along(const fl_push *p, fl_vec3 x) { return p->sign * (p->axis ? x.y : x.x); }

/* Force of the ice on what pushes, in the order of the bodies. */
static double force_back(const fl_world *w)
{
    const fl_push *p = &w->push;
    double sum = 0.0;
    if (p->of == FL_PUSH_WALL) return along(p, w->b.f[p->wall]);
    for (int32_t i = 0; i < w->n; i++)
        if (is_pushed(w, i)) sum += along(p, w->b.f[i]);
    return sum;
}

static void set_velocities(fl_world *w)
{
    const fl_push *p = &w->push;
    fl_bodies *b = &w->b;
    const double v = p->sign * p->velocity;
    if (p->of == FL_PUSH_WALL) {
        b->v[p->wall] = p->axis ? v3(0, v, 0) : v3(v, 0, 0);
        return;
    }
    for (int32_t i = 0; i < w->n; i++) {
        if (!is_pushed(w, i)) continue;
        const double before = fl_body_kinetic_energy(b, i);
        if (p->axis) b->v[i].y = v;
        else b->v[i].x = v;
        b->work_of_constraints[i] += fl_body_kinetic_energy(b, i) - before;
    }
}

/* Half a kick towards the speed wanted. */
static void kick_pusher(fl_world *w, double h)
{
    fl_push *p = &w->push;
    const double before = p->velocity, back = force_back(w), want = p->mass * (p->speed - before) / h - back;
    const int reached = !isfinite(p->limit) || (want >= 0.0 && want <= p->limit);
    p->back = back;
    p->force = reached ? want : want < 0.0 ? 0.0 : p->limit;
    p->velocity = reached ? p->speed : before + h * (p->force + back) / p->mass;
    p->impulse += h * p->force;
    p->limited += !reached && p->force > 0.0 ? h : 0.0;
    p->work += h * p->force * 0.5 * (before + p->velocity);
    set_velocities(w);
}

void fl_ice_push_first_half(fl_world *w, double t)
{
    fl_push *p = &w->push;
    const fl_track *tr = &w->driven_floes.track;
    if (tr->n) {
        fl_pose6 from, to, rate, second;
        fl_track_evaluate(tr, t, &from, &rate, &second);
        fl_track_evaluate(tr, t + w->dt, &to, &rate, &second);
        p->speed = along(p, v3_scale(1.0 / w->dt, v3_sub(to.x, from.x)));
    }
    const fl_vec3 before = p->wall < 0 ? v3(0, 0, 0) : w->b.v[p->wall];
    kick_pusher(w, 0.5 * w->dt);
    p->way += w->dt * p->velocity;
    if (p->wall >= 0) fl_set_predicted_change(w, p->wall, v3_sub(w->b.v[p->wall], before), v3(0, 0, 0));
}

/* The works of the contacts of the pushed floes were booked at their velocity before the last half kick:
 * book the rest. */
static void correct_works(fl_world *w, double change)
{
    const fl_push *p = &w->push;
    for (int32_t i = 0; i < w->n; i++) {
        if (!is_pushed(w, i)) continue;
        const fl_contact_sum *s = fl_sums_now(w, i);
        if (s->contacts) {
            w->ledger.damping -= w->dt * change * along(p, s->damping);
            w->ledger.friction -= w->dt * change * along(p, s->friction);
        }
        if (!w->spheres.bodies) continue;
        w->ledger.damping -= w->dt * change * along(p, w->spheres.sum[i].damping);
        w->ledger.friction -= w->dt * change * along(p, w->spheres.sum[i].friction);
    }
}

void fl_ice_push_second_half(fl_world *w)
{
    const double before = w->push.velocity;
    kick_pusher(w, 0.5 * w->dt);
    if (w->push.of != FL_PUSH_WALL && w->push.velocity != before) correct_works(w, w->push.velocity - before);
}

double fl_ice_push_acceleration(const fl_world *w)
{
    const fl_push *p = &w->push;
    return isfinite(p->limit) && p->velocity != p->speed ? (p->force + p->back) / p->mass : 0.0;
}
