/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "law/damping.h"
#include "sim/critical_step.h"
#include "contact/bond_list.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "sim/moving_structure.h"
#include "patch/stiffness_bound.h"

/* As many faces at rest on faces may a body have under it at once, as far as the step knows beforehand. */
#define FACES 2.0

/* So much as crowd() says of floes; of spheres it says more. */
#define FLOES_AMONG 2.7

/* Part of what a crowd of spheres leaves at which its damping, which is held back among one another, is right
 * to 1e-4 of what the floor under a pack bears, and to 4e-3 at any time: 0.12 of 2/omega (S28 of
 * verify_step). */
#define TRUE_AMONG_MANY 0.4

/* Largest compliance of a core's vertices along the normals of their faces, 1/m + (v x n).I^-1 (v x n)
 * [1/kg]; of a segment's ends across it, which turns it about y or z. */
static double softest(const fl_world *w, int32_t i)
{
    const fl_poly *p = &w->b.core[i];
    const fl_vec3 I = w->b.I[i];
    double most = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) {
            const fl_vec3 t = v3_cross(p->v[p->loop[k]], p->n[f]);
            most = fmax(most, t.x * t.x / I.x + t.y * t.y / I.y + t.z * t.z / I.z);
        }
    }
    if (p->nv == 2)
        most = w->b.bounding_radius[i] * w->b.bounding_radius[i] / I.y; /* ascending: it lies along x */
    return most + w->b.invm[i];
}

/* The same of a contact that lies on a face, as stiff as the root of its area: the largest over faces f and
 * shares s of their size, s times the largest eigenvalue of the mean of g g^T over the part of f that is s
 * times as large and shares its farthest vertex.  All of a square plate is as soft as its mass alone, a
 * corner of it a quarter more; the vertex itself, to which softest() gives the stiffness of all the face,
 * would be seven times as soft. */
static double softest_face(const fl_world *w, int32_t i)
{
    static const double SHARE[] = {1.0, 0.8, 0.6, 0.4, 0.25};
    const fl_poly *p = &w->b.core[i];
    const fl_mat3 R = fl_body_axes(&w->b, i);
    double most = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        const int32_t *loop = &p->loop[p->first[f]], nv = p->first[f + 1] - p->first[f];
        const double area = v3_norm(fl_poly_face_area_vector(p, f));
        fl_vec3 far = p->v[loop[0]];
        for (int32_t k = 1; k < nv; k++)
            if (v3_norm2(v3_cross(p->v[loop[k]], p->n[f])) > v3_norm2(v3_cross(far, p->n[f])))
                far = p->v[loop[k]];
        for (size_t l = 0; l < sizeof SHARE / sizeof *SHARE && area > 0.0; l++) {
            fl_stiffness K = {0};
            for (int32_t k = 1; k + 1 < nv;
                 k++) { /* triangles; midpoints of sides are exact for what is squared */
                const fl_vec3 c[3] = {p->v[loop[0]], p->v[loop[k]], p->v[loop[k + 1]]};
                const double part = 0.5 * v3_norm(v3_cross(v3_sub(c[1], c[0]), v3_sub(c[2], c[0]))) / area;
                for (int m = 0; m < 3; m++) {
                    const fl_vec3 mid = v3_scale(0.5, v3_add(c[m], c[(m + 1) % 3]));
                    const fl_vec3 r = v3_madd(far, SHARE[l], v3_sub(mid, far));
                    const fl_vec3 t = v3_cross(r, p->n[f]);
                    /* in the frame of the body */
                    fl_stiffness_add_force(&K, &w->b, i, part / 3.0, m3_mul(R, p->n[f]), m3_mul(R, t));
                }
            }
            most = fmax(most, SHARE[l] * fl_stiffness_bound(&K));
        }
    }
    return most;
}

/* What a body may meet: the largest speed and mass there are.  A pebble at rest is run into and crushed. */
typedef struct {
    double speed2, mass;
} worst;

static worst worst_of(const fl_world *w)
{
    worst a = {0};
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_body_absent(w, i)) continue;
        a.speed2 = fmax(a.speed2, v3_norm2(w->b.v[i]));
        a.mass = fmax(a.mass, w->b.m[i]);
    }
    return a;
}

/* Tangent stiffness of one place of a law with exponent 3/2 needs an overlap: that of an impact of the
 * heaviest at the speed that bodies have or will take from gravity and current over their own size, (5 M
 * v^2/4 k)^(2/5). */
static double place_slope(const fl_world *w, int32_t i, int32_t j, fl_pair_spring s, worst met)
{
    const double k = s.k;
    if (s.exponent == 1.0) return k;
    if (s.points ==
        FL_POINTS_PATCH) { /* a face; or the line of a segment at the largest overlap there should be */
        const double other = w->max_face_area[j], r = w->b.radius[i];
        if (w->max_face_area[i] > 0.0)
            return 2.0 * k * sqrt(other > 0.0 && other < w->max_face_area[i] ? other : w->max_face_area[i]);
        return 2.8 * k * sqrt(0.6 * sqrt(2.0 * r) * 2.0 * w->b.bounding_radius[i] * sqrt(0.3 * r));
    }
    const double size = w->b.bounding_radius[i] + w->b.radius[i], g = v3_norm(w->gravity);
    double current = w->sea.water ? fl_current_max_speed(&w->sea.current) : 0.0;
    if (w->sea.waves) current += w->sea.wave.four_sigma * w->sea.wave.train[w->sea.wave.n / 2].omega;
    const double v2 = fmax(met.speed2, fmax(current * current, w->moving.max_speed * w->moving.max_speed)) +
                      2.0 * g * 0.1 * size;
    const double depth =
        fmin(pow(1.25 * met.mass * v2 / k, 0.4), w->b.radius[i] > 0.0 ? 0.3 * w->b.radius[i] : size);
    return 1.5 * k * sqrt(depth);
}

/* What an elastic wall puts under the largest face of body i [N/m]. */
static double bed_slope(const fl_world *w, int32_t i)
{
    const fl_poly *core = &w->b.core[i];
    const double r = w->b.radius[i];
    return w->elastic_walls.stiffness * (core->nv > 2 ? fl_poly_largest_face_area(&w->elastic_walls.outer[i])
                                                      : 4.0 * r * (r + w->b.bounding_radius[i]));
}

/* The largest 1 + m d^2/I of the edges of body i, at a distance d from its centre, I about the line through
 * it along the edge; of a segment of its ends, or of the line along it.  4 of any edge of a box without
 * radius. */
static double shakiest(const fl_world *w, int32_t i)
{
    const fl_bodies *b = &w->b;
    const fl_poly *p = &b->core[i];
    const fl_vec3 I = b->I[i]; /* ascending: a segment lies along x */
    const double r = b->radius[i], end = b->bounding_radius[i] + r;
    double most = p->nf > 0 ? 0.0 : fmax(r * r / I.x, end * end / I.z);
    for (int32_t e = 0; e < p->ne && p->nf > 0; e++) {
        const fl_vec3 a = p->v[p->edge[e].a], t = v3_unit(v3_sub(p->v[p->edge[e].b], a));
        const double d = v3_norm(v3_cross(t, a)) + r;
        most = fmax(most, d * d * (t.x * t.x / I.x + t.y * t.y / I.y + t.z * t.z / I.z));
    }
    return 1.0 + b->m[i] * most;
}

/* How much more way body i gives across a contact than along it, since it turns as well: 1 + m r^2/I of what
 * is round.  Others turn as much where they stand on a narrow end or an edge, or lean; the critical step of
 * the contacts there are knows of that, but what damping by the speed half a step ago leaves of it is down to
 * 0.55 of law->left.  A face at the height h has 1 + m h^2/I, which is less than its edges have; a corner has
 * up to 7, but does not touch alone.  Half of law->left, which automatic steps keep to with such damping, is
 * below all that: it is 0 but where edges are asked for. */
static double turning(const fl_world *w, int32_t i, int edges)
{
    const fl_bodies *b = &w->b;
    const double r = b->radius[i];
    if (b->core[i].nv < 2) return 1.0 + b->m[i] * r * r / b->I[i].x;
    return edges ? shakiest(w, i) : 0.0;
}

/* What keeps the largest sphere from rolling on what is none turns that too, by the radius of the sphere. */
typedef struct {
    int32_t sphere; /* -1: nothing does */
    double part;    /* fl_rolling_stiffness_ratio(), the most of all laws */
} rolled_on;

static rolled_on rolled_on_of(const fl_world *w)
{
    rolled_on a = {.sphere = -1};
    for (int32_t i = 0; i < w->n && w->has_rolling; i++) {
        if (w->b.core[i].nv != 1 || fl_body_absent(w, i)) continue;
        if (a.sphere < 0 || w->b.radius[i] > w->b.radius[a.sphere]) a.sphere = i;
    }
    for (int32_t k = 0; k < w->materials * (w->materials + 2); k++)
        a.part = fmax(a.part, fl_rolling_stiffness_ratio(w->law[k].rolling));
    return a;
}

/* omega^2 of body i by that [1/s2]. */
static double rolled(const fl_world *w, int32_t i, rolled_on by, worst met)
{
    if (by.sphere < 0 || w->b.core[i].nv == 1) return 0.0;
    const double R = w->b.radius[by.sphere];
    return by.part * R * R * place_slope(w, by.sphere, i, fl_pair_stiffness(w, i, by.sphere), met) /
           w->b.I[i].x;
}

/* How many times as stiff, and as damped, a contact is that is shaken across in place of along; what keeps a
 * sphere from rolling turns it as friction does, with an arm of its radius at the most. */
static double shaken(const fl_pair_law *law, int round, double turns)
{
    const double rubs = law->friction > 0.0 ? law->tangential_ratio * turns : 0.0,
                 rolls = round ? fl_rolling_stiffness_ratio(law->rolling) * (turns - 1.0) : 0.0;
    return fmax(1.0, rubs + rolls);
}

/* So many contacts that act on one motion are N times as stiff as the bound of one contact, and N times as
 * damped: of 2/omega of that bound those that are late leave left(z sqrt(N))/sqrt(N), near 1/N of what one
 * leaves, and those of `patch` FL_DAMPED_SHARE_MIN/sqrt(N).  N of a motion in which all neighbours go against each
 * other: 5.5 of rough spheres that touch twelve others and all spin one way, where 5.1 was measured, 4 of
 * smooth ones that touch twelve, 2.7 of cubes held at all six faces, for the bound of a face holds at its
 * corner.  Two bodies have no more than what automatic steps keep to of one contact: 0.8 of what an impact
 * leaves, half of what late ones do. */
static double crowd(const fl_world *w, int round, double times)
{
    if (w->n <= 2) return 1.0;
    return fmin(round ? times > 1.0 ? 5.5 : 4.0 : FLOES_AMONG, w->n);
}

/* The most that was asked for of some laws: what is left falls with it, and logarithms are in it. */
typedef struct {
    const fl_pair_law *law;
    double times, many;
} asked;

enum { ASKED = 8 };

/* The least that damping leaves: of the critical step of a contact, and of that when there are many; and what
 * is kept to of it by itself, and where the error is measured and the contacts there are are known; the same
 * two of bonds, which know of all that stand on a body. */
typedef struct {
    double one, many, alone, measured, frozen, frozen_measured;
    asked before[ASKED];
} remains;

static double left_of(const fl_pair_law *law, double times)
{
    return fl_contact_law_scaled_share(law->law, law->impact_damping, law->stable_share, times);
}

/* The part of 2/omega that a trial may be, of what an impact leaves: beyond 0.12 of 2/omega and a quarter of
 * that windows of a few impacts did not show what all of a run was off by (a corner in a hook,
 * verify_budget); more where little is damped. */
static double shows(double left)
{
    return fmax(fmax(0.25 * left, 0.8 * left * left * left), fmin(0.8 * left, 0.12));
}

/* That of law among them, across so many times as stiff and damped as along, of so many contacts: of few,
 * which are one or two, and of a crowd.  Contacts of `patch` go by the speed of the end of the step, where
 * only an impact asks for shorter ones; those that are late, by the one half a step ago, as other laws do and
 * a ball in a groove, or with what moves by itself, of which they do not know how it yields. */
static void leave(const fl_world *w, remains *r, const fl_pair_law *law, int late, double across, double few,
                  double many)
{
    const int closed = law->law->damping == FL_DAMPING_IMPACT, spheres = many > FLOES_AMONG;
    if (law->law->end_speed && !late) {
        const double struck = fl_damping_impact_share(law->impact_damping);
        r->one = fmin(r->one, struck);
        r->alone = fmin(r->alone, 0.8 * struck); /* S25 of verify_step */
        r->measured = fmin(r->measured, shows(struck));
        if (spheres) r->measured = fmin(r->measured, FL_DAMPED_SHARE_MIN / sqrt(many));
        r->many = fmin(r->many, (spheres ? TRUE_AMONG_MANY : 1.0) * FL_DAMPED_SHARE_MIN / sqrt(many));
        return;
    }
    const double times = few * (closed ? across : 1.0); /* others are damped along alone */
    asked *const a = &r->before[(law - w->law) % ASKED];
    if (a->law == law && times <= a->times && many <= a->many) return;
    *a = (asked){law, times, many};
    const double one = left_of(law, times);
    r->one = fmin(r->one, one), r->alone = fmin(r->alone, 0.5 * one);
    r->measured = fmin(r->measured, 0.8 * one);
    r->many = fmin(r->many, left_of(law, times / few * many) / sqrt(many));
}

/* omega^2 of the stiffest contact that anything can make, what makes it, and what damping leaves of its
 * critical step: of what stands on edges, and is round between two others, as well or not.  bonds: how many
 * times theirs counts beside that of a contact. */
static double stiffest_contact(const fl_world *w, int edges, double bonds, int32_t *body, remains *left)
{
    const worst met = worst_of(w);
    const rolled_on by = rolled_on_of(w);
    double most = 0.0, ridden = 0.0;
    *left = (remains){
        .one = 1.0, .many = 1.0, .alone = 0.5, .measured = 0.5, .frozen = 0.5, .frozen_measured = 0.5};
    *body = -1;
    for (int32_t i = 0; i < w->n; i++) {
        const int round = w->b.core[i].nv < 2;
        const double places = round ? 1.0 : FACES, turns = turning(w, i, edges);
        double stiffest = place_slope(w, i, i, fl_pair_stiffness(w, i, i), met); /* one like itself */
        const fl_pair_law *law = fl_pair_law_of(w, i, i);
        double times = shaken(law, round, turns);
        const double few = edges && round ? 2.0 : 1.0;
        stiffest *= round ? times : 1.0;
        leave(w, left, law, 0, times, few, crowd(w, round, times));
        for (int32_t j = w->n; j < w->b.total; j++) {
            times = shaken(law = fl_pair_law_of(w, i, j), round, turns);
            const double stiffer = round ? times : 1.0;
            if (w->structure.piece[j - w->n].elastic) {
                stiffest = fmax(stiffest, stiffer * bed_slope(w, i));
                continue;
            }
            const double slope = place_slope(w, i, j, fl_pair_stiffness(w, i, j), met);
            stiffest = fmax(stiffest, stiffer * slope);
            if (w->moving.movers.n && w->moving.mover_of_piece[j - w->n] >= 0)
                ridden = fmax(ridden, places * slope);
            const int grooves = round && w->structure.piece[j - w->n].kind == FL_PIECE_MESH;
            leave(w, left, law, grooves || fl_piece_is_free(w, j), times, few, crowd(w, round, times));
        }
        /* Two equal bodies on one spring: twice the compliance.  Where the error is measured the step may be
         * half of the largest that is stable, by the closer bound; else it is to be a small share of it, and
         * that of the more careful one. */
        const int faces = w->scene->run.error > 0.0 && w->max_face_area[i] > 0.0;
        const double soft = faces ? softest_face(w, i) : softest(w, i);
        double drawn;
        const double omega2 = 2.0 * places * stiffest * soft + rolled(w, i, by, met) +
                              fl_driven_floe_spring(w, i, &drawn) * w->b.invm[i] +
                              bonds * fl_bond_list_max_omega2(w, i);
        if (omega2 > most) {
            most = omega2;
            *body = i;
        }
    }
    for (int32_t m = 0; m < w->moving.movers.n; m++) {
        const double omega2 = fl_mover_omega2(w, m, ridden);
        if (omega2 > most) {
            most = omega2;
            *body = w->b.total + m;
        }
    }
    for (int32_t k = 0; k < w->bonds.n; k++) {
        const double one = fl_damping_stable_share(0.5 * w->bonds.bond[k].damping * sqrt(most));
        left->one = fmin(left->one, one), left->frozen = fmin(left->frozen, 0.5 * one);
        left->frozen_measured = fmin(left->frozen_measured, 0.8 * one);
    }
    return most;
}

/* The part of the critical step that is taken: what the scene asks for, bounded by what damping leaves; of
 * contacts, and of bonds. */
static double share_of(const fl_world *w, const remains *left)
{
    const fl_scene_run *run = &w->scene->run;
    if (run->error > 0.0) return left->measured;
    return fmin(run->safety, fmin(left->alone, left->many));
}

static double share_of_bonds(const fl_world *w, const remains *left)
{
    const fl_scene_run *run = &w->scene->run;
    return run->error > 0.0 ? left->frozen_measured : fmin(run->safety, left->frozen);
}

double fl_critical_step(const fl_world *w)
{
    int32_t body;
    remains left;
    const double most = stiffest_contact(w, 0, 1.0, &body, &left);
    return most > 0.0 ? 2.0 / sqrt(most) : INFINITY;
}

/* (omega dt/2)^2 of what acts on one body adds up, also where each is to be a part of 1 of its own: with the
 * shares c and b of contacts and bonds 1/dt^2 = (C/c^2 + B/b^2)/4.  So a body keeps to c when all its bonds
 * have ended, to b while nothing touches it, and is stable with any part of both. */
double fl_automatic_step(const fl_world *w, int32_t *body)
{
    remains left, same;
    double most = stiffest_contact(w, 0, 1.0, body, &left);
    if (most == 0.0) return INFINITY;
    const double touching = share_of(w, &left), less = touching / share_of_bonds(w, &left);
    if (w->bonds.n && less != 1.0) most = stiffest_contact(w, 0, less * less, body, &same);
    return touching * 2.0 / sqrt(most);
}

fl_predicted_limit fl_predict_step_limit(const fl_world *w)
{
    int32_t body;
    remains left;
    const double most = stiffest_contact(w, 0, 1.0, &body, &left);
    if (most == 0.0) return (fl_predicted_limit){.critical = INFINITY, .contact_share = 1.0};
    fl_predicted_limit f = {.critical = 2.0 / sqrt(most), .contact_share = share_of(w, &left)};
    const double same = f.contact_share * f.critical, dt = fl_automatic_step(w, &body);
    if (w->bonds.n) f.bond_relief = 1.0 / (same * same) - 1.0 / (dt * dt);
    return f;
}

double fl_longest_step(const fl_predicted_limit *f, double seen)
{
    const double same = f->contact_share * seen;
    return seen < f->critical ? same / sqrt(1.0 - f->bond_relief * same * same) : INFINITY;
}

double fl_damped_share(const fl_world *w)
{
    int32_t body;
    remains left;
    return stiffest_contact(w, 0, 1.0, &body, &left) > 0.0 ? left.one : 1.0;
}

double fl_lateral_share(const fl_world *w)
{
    int32_t body;
    remains along, left;
    if (stiffest_contact(w, 0, 1.0, &body, &along) == 0.0) return 1.0;
    stiffest_contact(w, 1, 1.0, &body, &left);
    return left.one / along.one;
}

/* Looks at the waves in a period, at least. */
#define LOOKS 20.0

int fl_check_wave_sampling(const fl_world *w, fl_err *err)
{
    const fl_waves *waves = &w->sea.wave;
    if (!w->sea.sample) return 0;
    double omega = waves->train[(int32_t)(0.95 * (waves->n - 1))].omega;
    char who[64] = "the waves have";
    for (int32_t i = 0; i < w->n; i++) {
        int turns;
        const double own = sqrt(fl_environment_omega2(&w->sea, &w->b, i, &turns));
        if (!(own > omega)) continue;
        omega = own;
        snprintf(who, sizeof who, "body %d %s with", w->id[i], turns ? "rolls" : "heaves");
    }
    const double period = 2.0 * PI / omega, most = period / LOOKS / w->dt;
    if (w->sea.sample_every <= most * (1.0 + 1e-9)) return 0;
    return fl_fail(err, FL_INPUT,
                   "water.every: %d steps of %.4g s, and %s a period of %.4g s: %d looks in it, at most %d "
                   "steps are expected, or a smaller run.dt",
                   w->sea.sample_every, w->dt, who, period, (int)(period / (w->sea.sample_every * w->dt)),
                   (int)fmax(1.0, most));
}

/* D of the most damped contacts; those that go by the speeds of the middle of a step, and not by
 * fl_damping_end_speed(), are `core` and the manual's laws, and balls in the grooves of a surface. */
static double most_damped(const fl_world *w, int late)
{
    int all = !late;
    for (int32_t k = 0; k < w->pieces && w->has_points; k++)
        all |= w->structure.piece[k].kind == FL_PIECE_MESH;
    double D = 0.0;
    for (int32_t k = 0; k < w->materials * (w->materials + 2); k++) {
        const fl_pair_law *law = &w->law[k];
        const double impact = all || !law->law->end_speed ? law->impact_damping : 0.0;
        D = fmax(D, law->law->damping == FL_DAMPING_RATIO ? 2.0 * law->zeta : impact);
    }
    return D;
}

static double over(double dt, double critical) { return isfinite(critical) ? dt / critical : 0.0; }

/* D of what goes by the speeds of the middle, bonds with it; r of critical_step.h. */
static double late_damped(const fl_world *w, double r)
{
    const double all = over(w->dt, w->dt_critical), D = most_damped(w, 1);
    return w->bonds.n && all > 0.0 ? fmax(D, 2.0 * w->scene->bond.damping * r / all) : D;
}

double fl_peak_error(const fl_world *w)
{
    const double r = over(w->dt, w->dt_critical_contacts), D = late_damped(w, r), all = most_damped(w, 0);
    return 0.35 * D * r / (1.0 + 0.5 * D) + fmin(0.15 + 0.2 * all * all, 0.95) * r * r;
}

double fl_impulse_error(const fl_world *w)
{
    const double r = over(w->dt, w->dt_critical_contacts), first = 0.3 * r;
    return late_damped(w, r) > 0.0 ? first : fmin(first, 1.5 * r * r);
}
