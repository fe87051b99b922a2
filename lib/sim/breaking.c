/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/breaking.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/fast_math.h"
#include "base/pi.h"
#include "contact/pair_geometry.h"
#include "failure/area_vector.h"
#include "failure/bending.h"
#include "failure/splitting.h"
#include "geom/clip.h"
#include "sim/critical_step.h"
#include "sim/floe_cut.h"
#include "world/access.h"

enum { LOADS = 64, LINES = 8 };
/* A load is looked at again when it has grown by this. */
#define GROWN 1.02
/* A strip wider than this multiple of what bends is cut to a cusp. */
#define WIDE 1.5
/* Share by which the volume of a prism may differ from area times thickness. */
#define PRISM 0.02

/* Loads of a floe in plan axes. */
typedef struct {
    fl_plan plan;
    fl_mat3 to_plan; /* world to plan */
    fl_plan_load load[LOADS];
    const fl_pair *pair[LOADS];
    int32_t n, from_structure; /* loads of the structure come first */
} floe_loads;

static double young_of(const fl_world *w, int32_t i) { return w->scene->material[w->material[i]].young; }

/* Least area of a fragment of a floe of thickness h [m2]. */
static double least_area_of(const fl_world *w, int32_t i, double h)
{
    const double r = w->b.radius[i], given = w->breaking.least_area > 0.0 ? w->breaking.least_area
                                                                          : fmax(0.25 * h * h, 16.0 * r * r);
    return fmax(given, fl_least_fragment_area(w, i, h));
}

static fl_bending_law bending_law_of(const fl_world *w, int32_t i)
{
    const fl_scene_failure *s = &w->scene->failure;
    const double rho_w = w->sea.water ? w->scene->water.density : 0.0;
    return (fl_bending_law){.strength = s->flexural_strength,
                            .young = young_of(w, i),
                            .foundation = rho_w * v3_norm(w->gravity),
                            .density = rho_w > 0.0 ? w->scene->material[w->material[i]].density / rho_w : 0.0,
                            .wedges = s->wedges};
}

/* Plan of floe i: n = 0 for one that does not break. */
static int make_plan(const fl_world *w, int32_t i, fl_plan *q, fl_err *err)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 R0 = q_matrix(w->q0[i]);
    fl_poly outer = {0};
    fl_err why = {0};
    *q = (fl_plan){.n = 0};
    if (b->core[i].nf == 0) return 0;
    if (fl_poly_offset(&outer, &b->core[i], b->radius[i], &why)) {
        if (why.code != FL_SYSTEM) return 0;
        *err = why;
        return -1;
    }
    fl_plan_of(q, &outer, m3_tmul(R0, v3(1, 0, 0)), m3_tmul(R0, v3(0, 1, 0)), m3_tmul(R0, v3(0, 0, 1)));
    fl_poly_free(&outer);
    const double volume = b->m[i] / w->scene->material[w->material[i]].density;
    if (q->n && fabs(fl_plan_part(q, 1, 0, INFINITY).area * q->thickness / volume - 1.0) > PRISM) q->n = 0;
    return 0;
}

int fl_breaking_least_area(const fl_world *w, double *given, double *borne, fl_err *err)
{
    *given = *borne = 0.0;
    for (int32_t i = 0; i < w->n; i++) {
        fl_plan q;
        if (fl_body_absent(w, i)) continue;
        if (make_plan(w, i, &q, err)) return -1;
        if (q.n == 0) continue;
        *given = fmax(*given, least_area_of(w, i, q.thickness));
        *borne = fmax(*borne, fl_least_fragment_area(w, i, q.thickness));
    }
    return 0;
}

/* Least width of a plan and tangent of half of its sharpest corner. */
static void slender_of(const fl_plan *q, double *width, double *half_tan)
{
    *width = *half_tan = INFINITY;
    for (int32_t k = 0; k < q->n; k++) {
        const fl_vec2 a = q->p[k], b = q->p[(k + 1) % q->n], c = q->p[(k + 2) % q->n];
        double from, to;
        const double l = hypot(b.x - a.x, b.y - a.y), m = hypot(c.x - b.x, c.y - b.y);
        fl_plan_extent(q, (b.y - a.y) / l, -(b.x - a.x) / l, &from, &to);
        *width = fmin(*width, to - from);
        /* turning angle t: the corner is pi - t, tan((pi - t)/2) = cot(t/2) */
        const double s = ((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x)) / (l * m),
                     co = ((b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y)) / (l * m);
        *half_tan = fmin(*half_tan, (1.0 + co) / fmax(s, 1e-12));
    }
}

/* Gates of floe i; infinite for one that does not break. */
static int set_gates(fl_world *w, int32_t i, fl_err *err)
{
    fl_breaking_state *s = &w->breaking;
    const fl_scene_failure *f = &w->scene->failure;
    fl_plan q;
    s->bend_gate[i] = s->split_gate[i] = INFINITY;
    if (make_plan(w, i, &q, err)) return -1;
    if (q.n == 0 || w->inflow.guided[i] || (i < w->driven_floes.n && w->driven_floes.is_driven[i])) return 0;
    double width, half_tan;
    slender_of(&q, &width, &half_tan);
    const fl_bending_law law = bending_law_of(w, i);
    const double h = q.thickness, lb = fl_bending_length(&law, h),
                 L = sqrt(fl_plan_part(&q, 1, 0, INFINITY).area);
    if (f->flexural_strength < INFINITY)
        s->bend_gate[i] = f->flexural_strength * h * h *
                          fmin(0.1, fmin(0.35 * half_tan, lb < INFINITY ? 0.5 * width / lb : h / L));
    if (f->fracture_toughness < INFINITY && !(w->b.fixed_dof[i] & FL_DOF_RZ))
        s->split_gate[i] = 0.2 * f->fracture_toughness * h * sqrt(L);
    return 0;
}

/* Adds the load of pair p on floe i. */
static void add_load(const fl_world *w, floe_loads *q, int32_t i, const fl_pair *p)
{
    if (q->n == LOADS) return;
    const double sign = p->i == i ? 1.0 : -1.0;
    fl_vec3 x = p->load_point;
    if (p->i != i) x = v3_sub(x, fl_separation(w, p->i, p->j, p->image));
    const double area = p->nominal_area, h = q->plan.thickness;
    fl_plan_load *l = &q->load[q->n];
    l->x = m3_mul(q->to_plan, x);
    l->x.z -= q->plan.bottom + 0.5 * h;
    l->force = v3_scale(sign, m3_mul(q->to_plan, p->force));
    l->width = fmin(area / h, sqrt(fl_plan_part(&q->plan, 1, 0, INFINITY).area));
    q->pair[q->n++] = p;
}

/* Loads of floe i: those of the structure, then of floes. */
static int gather_loads(const fl_world *w, int32_t i, floe_loads *q, fl_err *err)
{
    if (make_plan(w, i, &q->plan, err)) return -1;
    const fl_mat3 R0 = q_matrix(w->q0[i]), R = fl_body_axes(&w->b, i);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            q->to_plan.m[a][b] = R0.m[a][0] * R.m[b][0] + R0.m[a][1] * R.m[b][1] + R0.m[a][2] * R.m[b][2];
    q->n = q->from_structure = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t c = w->first_pair_of_body[i]; c < w->first_pair_of_body[i + 1]; c++) {
            const int32_t k = w->pairs_of_body[c];
            if (!w->pair_touches[k] || (w->pair[k].j < w->n) != pass) continue;
            add_load(w, q, i, w->pair[k].contact);
        }
        if (pass == 0) q->from_structure = q->n;
    }
    return 0;
}

/* --- a break -------------------------------------------------------------------------------------- */

/* What breaks a floe most. */
typedef struct {
    double ratio;
    int mode;
    double ex, ey, c; /* cut at e.x = c in plan */
    double length, load, energy;
    double width, distance; /* of the beam that bends, at the cut [m] */
    int32_t of;             /* number of the load */
} floe_break;

static floe_break bend_of(fl_world *w, int32_t i, const floe_loads *q)
{
    fl_bending_law law = bending_law_of(w, i);
    floe_break best = {.ratio = 0.0, .mode = FL_FAILURE_BEND};
    law.least_area = least_area_of(w, i, q->plan.thickness);
    for (int32_t k = 0; k < q->from_structure; k++) {
        if (fabs(q->load[k].force.z) <= w->breaking.bend_gate[i]) continue;
        const fl_bending r = fl_bending_of(&q->plan, &law, q->load, q->n, k);
        w->breaking.buckled += r.buckles;
        w->breaking.too_small += r.small && !(r.ratio > 1.0);
        if (!(r.ratio > best.ratio)) continue;
        const double h = q->plan.thickness;
        best = (floe_break){.ratio = r.ratio,
                            .mode = FL_FAILURE_BEND,
                            .ex = r.ex,
                            .ey = r.ey,
                            .c = r.c,
                            .length = r.whole,
                            .width = r.width,
                            .distance = r.distance,
                            .load = v3_norm(q->load[k].force),
                            .of = k,
                            /* of a beam whose moment falls off over the distance x on both sides */
                            .energy =
                                r.moment * r.moment * r.distance / (law.young * h * h * h * r.width / 4.0)};
    }
    return best;
}

/* Area vectors of the structure inside floe i on both sides of the line e.x = c, in plan axes. */
static void split_area(const fl_world *w, const floe_loads *q, const fl_pair *p, double ex, double ey,
                       double c, fl_vec3 side[2])
{
    const fl_bodies *b = &w->b;
    const fl_relative_pose r = fl_relative_pose_of(w, p);
    fl_half_spaces a;
    fl_half_spaces_of(&a, &b->core[p->i], b->radius[p->i], &r.M, r.o);
    /* the normal of the line in the frame of B: plan to world to B */
    const fl_vec3 n = m3_tmul(r.R, m3_tmul(q->to_plan, v3(ex, ey, 0.0)));
    if (a.n == FL_HALF_SPACES) a.n--;
    const int last = a.n++;
    /* what faces the force on the floe */
    const fl_vec3 facing = m3_tmul(r.R, p->force);
    for (int s = 0; s < 2; s++) {
        a.normal[last] = s ? v3_neg(n) : n;
        a.c[last] = (s ? -1.0 : 1.0) * (c + v3_dot(n, r.o));
        side[s] =
            m3_mul(q->to_plan, m3_mul(r.R, fl_area_vector_of_piece(&a, fl_world_piece(w, p->j), facing)));
    }
}

/* Half the plan along the line through load k in direction u, with the other loads on it. */
static fl_split_line line_of(const fl_world *w, const floe_loads *q, int32_t k, fl_vec2 u, double *c)
{
    const fl_plan *plan = &q->plan;
    const fl_plan_load *l = &q->load[k];
    const double nx = -u.y, ny = u.x, mu = q->pair[k]->law->friction, at = nx * l->x.x + ny * l->x.y;
    const fl_plan_moments all = fl_plan_part(plan, 1, 0, INFINITY), part = fl_plan_part(plan, nx, ny, at);
    fl_vec2 middle = {0, 0};
    fl_split_line s = {.thickness = plan->thickness, .width = l->width};
    s.length = fl_plan_width(plan, nx, ny, at, &middle);
    if (!(s.length > 0.0)) return s;
    s.breadth = all.area / s.length;
    fl_vec3 S[2];
    split_area(w, q, q->pair[k], nx, ny, at, S);
    double open[2], push[2], P = 0.0;
    for (int a = 0; a < 2; a++) {
        /* pressure acts on the floe along S; a = 0 is the side of n.x < c, which opens towards -n */
        const double along = fmax(S[a].x * u.x + S[a].y * u.y, 0.0),
                     aside = (a ? 1.0 : -1.0) * (S[a].x * nx + S[a].y * ny);
        open[a] = aside - mu * along, push[a] = along + mu * fabs(aside);
        P += push[a];
    }
    const double axial = l->force.x * u.x + l->force.y * u.y;
    if (!(P > 0.0 && axial > 0.0)) return (fl_split_line){.length = 0.0};
    s.Q = axial / P * 0.5 * (open[0] + open[1]);
    s.F = axial;
    /* the other loads, with the inertia that balances them, on the side n.x < c */
    double N = 0.0, Fx = 0.0, Fy = 0.0, M = 0.0;
    for (int32_t a = 0; a < q->n; a++) Fx += q->load[a].force.x, Fy += q->load[a].force.y;
    for (int32_t a = 0; a < q->n; a++) {
        const fl_plan_load *o = &q->load[a];
        const double lateral = -(nx * o->force.x + ny * o->force.y),
                     arm = (middle.x - o->x.x) * u.x + (middle.y - o->x.y) * u.y;
        if (a == k || nx * o->x.x + ny * o->x.y >= at) continue;
        N += lateral, M += lateral * arm;
    }
    const fl_plan_load *own = &q->load[k];
    const double inertia = (nx * (Fx - own->force.x) + ny * (Fy - own->force.y)) * part.area / all.area;
    s.tension = N + inertia;
    s.moment = M;
    *c = at;
    return s;
}

static floe_break split_of(fl_world *w, int32_t i, const floe_loads *q)
{
    const double tough = w->scene->failure.fracture_toughness, E = young_of(w, i);
    floe_break best = {.ratio = 0.0, .mode = FL_FAILURE_SPLIT};
    double shortest = INFINITY;
    for (int32_t k = 0; k < q->from_structure; k++) {
        const fl_plan_load *l = &q->load[k];
        const fl_plan_moments all = fl_plan_part(&q->plan, 1, 0, INFINITY);
        if (v3_norm(l->force) <= w->breaking.split_gate[i]) continue;
        const double inward = fl_atan2(l->force.y, l->force.x);
        for (int m = 0; m < LINES; m++) {
            fl_vec2 u;
            double c = 0.0;
            if (m < LINES - 1) {
                fl_cos_sin(inward + (m % 2 ? -(m + 1) / 2 : m / 2) * PI / 12.0, &u.x, &u.y);
            } else {
                const fl_vec2 to = {all.x / all.area - l->x.x, all.y / all.area - l->x.y};
                const double size = sqrt(to.x * to.x + to.y * to.y);
                if (!(size > 0.0)) continue;
                u = (fl_vec2){to.x / size, to.y / size};
            }
            const fl_split_line s = line_of(w, q, k, u, &c);
            if (!(s.length > 0.0)) continue;
            const double ratio = fl_split_intensity(&s) / tough,
                         energy = tough * tough / E * q->plan.thickness * s.length;
            if (!(ratio > best.ratio * (1.0 + 1e-9)) &&
                !(ratio > 1.0 && best.ratio > 1.0 && s.length < shortest))
                continue;
            shortest = s.length;
            best = (floe_break){.ratio = ratio,
                                .mode = FL_FAILURE_SPLIT,
                                .ex = -u.y,
                                .ey = u.x,
                                .c = c,
                                .length = s.length,
                                .load = v3_norm(l->force),
                                .energy = energy,
                                .of = k};
        }
    }
    /* the crack takes its energy from motion and contacts */
    const fl_vec3 v = w->b.v[i];
    if (best.ratio > 1.0) {
        double at_hand = 0.5 * w->b.m[i] * v3_norm2(v);
        for (int32_t k = 0; k < q->n; k++) at_hand += q->pair[k]->energy;
        if (at_hand < best.energy) best.ratio = 0.0;
    }
    return best;
}

static int record_failure(fl_world *w, const fl_failure_event *e, fl_err *err)
{
    fl_breaking_state *s = &w->breaking;
    if (!w->scene->output.failures[0]) return 0;
    if (fl_grow(&s->event, &s->event_cap, (int64_t)s->events + 1, sizeof *s->event, err)) return -1;
    s->event[s->events++] = *e;
    return 0;
}

/* Cuts the strip that a bend has broken off, in place k, along a line from an end of the contact to an end of
 * the width that bent; side: 1 or -1.  x: centre of the whole floe.  *cusp: the place of the part between. */
static int cut_cusp(fl_world *w, int32_t k, const floe_loads *q, const floe_break *by, fl_vec3 x, double side,
                    int32_t *cusp, fl_err *err)
{
    const fl_plan_load *l = &q->load[by->of];
    const double tx = -by->ey, ty = by->ex, wide = 0.5 * (by->width - l->width), far = by->distance,
                 size = sqrt(far * far + wide * wide), nx = (far * side * tx - wide * by->ex) / size,
                 ny = (far * side * ty - wide * by->ey) / size;
    const fl_vec3 at = v3(l->x.x + 0.5 * side * l->width * tx, l->x.y + 0.5 * side * l->width * ty, 0.0),
                  own = m3_mul(q->to_plan, v3_sub(w->b.x[k], x));
    const double c = nx * (at.x - own.x) + ny * (at.y - own.y);
    fl_plan plan;
    int32_t child;
    *cusp = k;
    if (make_plan(w, k, &plan, err)) return -1;
    if (plan.n == 0) return 0;
    const double all = fl_plan_part(&plan, 1, 0, INFINITY).area, part = fl_plan_part(&plan, nx, ny, c).area;
    if (fmin(part, all - part) < least_area_of(w, k, plan.thickness)) return 0;
    const fl_vec3 n = m3_tmul(q->to_plan, v3(nx, ny, 0.0));
    fl_vec2 middle = {0, 0};
    fl_failure_event e = {.time = fl_world_time(w),
                          .mode = FL_FAILURE_CUSP,
                          .parent = w->id[k],
                          .n = n,
                          .load = by->load,
                          .ratio = by->ratio};
    e.length = fl_plan_width(&plan, nx, ny, c, &middle);
    e.x = v3_add(w->b.x[k], m3_tmul(q->to_plan, v3(middle.x, middle.y, plan.bottom + 0.5 * plan.thickness)));
    const int cut = fl_floe_cut(w, k, m3_tmul(q_matrix(w->q0[k]), v3(nx, ny, 0.0)), c, &child, err);
    if (cut <= 0) return cut;
    if (v3_dot(v3_sub(w->b.x[child], e.x), n) < 0.0) *cusp = child;
    else e.n = v3_neg(n);
    e.child = w->id[child];
    e.mass = w->b.m[k], e.child_mass = w->b.m[child];
    w->breaking.cusps++;
    return record_failure(w, &e, err);
}

/* A strip much wider than what bent: only the cusp ahead of the contact comes off, and two side pieces. */
static int cut_sides(fl_world *w, int32_t i, int32_t child, const floe_loads *q, const floe_break *by,
                     fl_vec3 x, fl_err *err)
{
    const fl_vec3 e = m3_tmul(q->to_plan, v3(by->ex, by->ey, 0.0));
    int32_t k = v3_dot(e, v3_sub(w->b.x[child], w->b.x[i])) < 0.0 ? child : i; /* the one with the contact */
    for (int side = -1; side <= 1; side += 2)
        if (cut_cusp(w, k, q, by, x, side, &k, err) < 0) return -1;
    return 0;
}

/* Cuts floe i; counts and records it. */
static int cut_floe(fl_world *w, int32_t i, const floe_loads *q, const floe_break *by, fl_err *err)
{
    fl_breaking_state *s = &w->breaking;
    const fl_plan_moments all = fl_plan_part(&q->plan, 1, 0, INFINITY),
                          part = fl_plan_part(&q->plan, by->ex, by->ey, by->c);
    const double h = q->plan.thickness;
    if (fmin(part.area, all.area - part.area) < least_area_of(w, i, h)) {
        s->too_small++;
        return 0;
    }
    /* plan to body: R0^T; the plan has the origin at the centre of mass */
    const fl_vec3 n = m3_tmul(q_matrix(w->q0[i]), v3(by->ex, by->ey, 0.0));
    fl_vec2 middle = {0, 0};
    fl_plan_width(&q->plan, by->ex, by->ey, by->c, &middle);
    const fl_vec3 x = m3_tmul(q->to_plan, v3(middle.x, middle.y, q->plan.bottom + 0.5 * h)),
                  normal = m3_tmul(q->to_plan, v3(by->ex, by->ey, 0.0));
    fl_failure_event e = {.time = fl_world_time(w),
                          .mode = by->mode,
                          .parent = w->id[i],
                          .x = v3_add(w->b.x[i], x),
                          .n = normal,
                          .length = by->length,
                          .load = by->load,
                          .ratio = by->ratio,
                          .energy = by->energy};
    int32_t child;
    const fl_vec3 centre = w->b.x[i];
    const int cut = fl_floe_cut(w, i, n, by->c, &child, err);
    if (cut <= 0) return cut;
    if (v3_dot(v3_sub(w->b.x[child], e.x), normal) > 0.0) e.n = v3_neg(e.n);
    e.child = w->id[child];
    e.mass = w->b.m[i], e.child_mass = w->b.m[child];
    if (by->mode == FL_FAILURE_BEND) s->bent++;
    else s->split++;
    if (record_failure(w, &e, err)) return -1;
    return by->mode == FL_FAILURE_BEND && by->length > WIDE * by->width
               ? cut_sides(w, i, child, q, by, centre, err)
               : 0;
}

/* Checks floe i, whose loads have passed a gate; 1 if it was cut. */
static int check_floe(fl_world *w, int32_t i, fl_err *err)
{
    floe_loads q;
    w->breaking.checks++;
    if (gather_loads(w, i, &q, err)) return -1;
    if (q.plan.n == 0) return 0;
    floe_break by = bend_of(w, i, &q);
    if (!(by.ratio > 1.0)) by = split_of(w, i, &q);
    return by.ratio > 1.0 ? cut_floe(w, i, &q, &by, err) : 0;
}

/* --- the step ------------------------------------------------------------------------------------- */

typedef struct {
    int32_t id, i;
} due_floe;

static int compare_ids(const void *a, const void *b)
{
    const due_floe *p = a, *q = b;
    return p->id < q->id ? -1 : p->id > q->id;
}

/* Largest load of floe i on the structure; *vertical: its largest part along the thickness. */
static double load_of(const fl_world *w, int32_t i, double *vertical)
{
    const fl_vec3 up = q_rotate(w->b.q[i], m3_tmul(q_matrix(w->q0[i]), v3(0, 0, 1)));
    double most = 0.0;
    *vertical = 0.0;
    for (int64_t c = w->first_pair_of_body[i]; c < w->first_pair_of_body[i + 1]; c++) {
        const int32_t k = w->pairs_of_body[c];
        if (!w->pair_touches[k] || w->pair[k].j < w->n || w->pair[k].j >= w->n + w->pieces) continue;
        const fl_vec3 F = w->pair[k].contact->force;
        most = fmax(most, v3_norm(F));
        *vertical = fmax(*vertical, fabs(v3_dot(F, up)));
    }
    return most;
}

/* Appends floe i if it is due for a check. */
static int add_due(fl_world *w, int32_t i, due_floe **due, int32_t *n, int32_t *cap, fl_err *err)
{
    fl_breaking_state *s = &w->breaking;
    double vertical;
    if (s->bend_gate[i] == 0.0 && set_gates(w, i, err)) return -1;
    const double load = load_of(w, i, &vertical);
    if (load < 0.5 * s->last_load[i]) s->last_load[i] = load;
    if (!(vertical > s->bend_gate[i] || load > s->split_gate[i]) || !(load > GROWN * s->last_load[i]))
        return 0;
    s->last_load[i] = load;
    if (fl_grow(due, cap, (int64_t)*n + 1, sizeof **due, err)) return -1;
    (*due)[(*n)++] = (due_floe){w->id[i], i};
    return 0;
}

int fl_breaking_step(fl_world *w, fl_err *err)
{
    due_floe *due = NULL;
    int32_t n = 0, cap = 0;
    int rc = 0;
    for (int32_t j = w->n; j < w->n + w->pieces && !rc; j++)
        for (int64_t c = w->first_pair_of_body[j]; c < w->first_pair_of_body[j + 1] && !rc; c++) {
            const int32_t k = w->pairs_of_body[c];
            if (w->pair_touches[k]) rc = add_due(w, w->pair[k].i, &due, &n, &cap, err);
        }
    qsort(due, (size_t)n, sizeof *due, compare_ids);
    for (int32_t k = 0; k < n && rc >= 0; k++)
        if (k == 0 || due[k].i != due[k - 1].i) rc = check_floe(w, due[k].i, err);
    free(due);
    return rc < 0 ? -1 : 0;
}
