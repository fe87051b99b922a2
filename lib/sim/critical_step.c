/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/critical_step.h"
#include <math.h>
#include "base/fast_math.h"
#include "base/pi.h"
#include "contact/bond_list.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "law/damping.h"
#include "patch/stiffness_bound.h"
#include "sim/moving_structure.h"
#include "sim/strip_setup.h"

/* Assumed number of faces that a body rests on at once. */
#define FACES_PER_BODY 2.0

/* contacts_per_motion() of floes; that of spheres is larger. */
#define FLOE_CONTACTS 2.7

/* Share of the stable step of a pack of spheres at which its implicit damping is accurate: to 1e-4 of the
 * load on the floor under the pack, and to 4e-3 at any time.  It is 0.12 of 2/omega (S28 of verify_step). */
#define ACCURATE_SHARE 0.4

/* Largest compliance of the vertices of core i along the normals of their faces, 1/m + (v x n).I^-1 (v x n)
 * [1/kg]; for a segment that of its ends, normal to it. */
static double max_vertex_compliance(const fl_world *w, int32_t i)
{
    const fl_poly *p = &w->b.core[i];
    const fl_vec3 I = w->b.I[i];
    double largest = 0.0;
    for (int32_t f = 0; f < p->nf; f++) {
        for (int32_t k = p->first[f]; k < p->first[f + 1]; k++) {
            const fl_vec3 t = v3_cross(p->v[p->loop[k]], p->n[f]);
            largest = fmax(largest, t.x * t.x / I.x + t.y * t.y / I.y + t.z * t.z / I.z);
        }
    }
    if (p->nv == 2)
        largest = w->b.bounding_radius[i] * w->b.bounding_radius[i] / I.y; /* ascending: it lies along x */
    return largest + w->b.invm[i];
}

/* The same for a contact on a face, whose stiffness goes with the root of its area.  It is the largest,
 * over faces f and shares s of their size, of s times the largest eigenvalue of the mean of g g^T over
 * the part of f that is s times as large and has its farthest vertex.  A whole square plate has the
 * compliance of its mass, a corner a quarter more.  The vertex alone, with the stiffness of the whole
 * face, would have seven times as much: that is max_vertex_compliance(). */
static double max_face_compliance(const fl_world *w, int32_t i)
{
    static const double SHARE[] = {1.0, 0.8, 0.6, 0.4, 0.25};
    const fl_poly *p = &w->b.core[i];
    const fl_mat3 R = fl_body_axes(&w->b, i);
    double largest = 0.0;
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
                 k++) { /* midpoints of sides integrate squares over a triangle exactly */
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
            largest = fmax(largest, SHARE[l] * fl_stiffness_bound(&K));
        }
    }
    return largest;
}

/* Largest squared speed and mass of all bodies: a small body at rest may be hit by them. */
typedef struct {
    double speed2, mass;
} extremes;

static extremes extremes_of(const fl_world *w)
{
    extremes a = {0};
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_body_absent(w, i)) continue;
        a.speed2 = fmax(a.speed2, v3_norm2(w->b.v[i]));
        a.mass = fmax(a.mass, w->b.m[i]);
    }
    return a;
}

/* Tangent stiffness of one contact point.  With exponent 3/2 it needs an overlap, that of an impact of the
 * heaviest body: (5 M v^2/4 k)^(2/5).  The speed v is the largest of bodies, current, waves and moving parts,
 * with that gained by gravity over a tenth of their size. */
static double tangent_stiffness(const fl_world *w, int32_t i, int32_t j, fl_pair_spring s, extremes hit)
{
    const double k = s.k;
    if (s.exponent == 1.0) return k;
    if (s.points == FL_POINTS_PATCH) { /* a face; or the line of a segment at the largest overlap intended */
        const double other = w->max_face_area[j], r = w->b.radius[i];
        if (w->max_face_area[i] > 0.0)
            return 2.0 * k * sqrt(other > 0.0 && other < w->max_face_area[i] ? other : w->max_face_area[i]);
        return 2.8 * k * sqrt(0.6 * sqrt(2.0 * r) * 2.0 * w->b.bounding_radius[i] * sqrt(0.3 * r));
    }
    const double size = w->b.bounding_radius[i] + w->b.radius[i], g = v3_norm(w->gravity);
    double current = w->sea.water ? fl_current_max_speed(&w->sea.current) : 0.0;
    if (w->sea.waves) current += w->sea.wave.four_sigma * w->sea.wave.train[w->sea.wave.n / 2].omega;
    const double v2 = fmax(hit.speed2, fmax(current * current, w->moving.max_speed * w->moving.max_speed)) +
                      2.0 * g * 0.1 * size;
    const double depth =
        fmin(pow(1.25 * hit.mass * v2 / k, 0.4), w->b.radius[i] > 0.0 ? 0.3 * w->b.radius[i] : size);
    return 1.5 * k * sqrt(depth);
}

/* Stiffness of an elastic wall under the largest face of body i [N/m]. */
static double elastic_wall_stiffness(const fl_world *w, int32_t i)
{
    const fl_poly *core = &w->b.core[i];
    const double r = w->b.radius[i];
    return w->elastic_walls.stiffness * (core->nv > 2 ? fl_poly_largest_face_area(&w->elastic_walls.outer[i])
                                                      : 4.0 * r * (r + w->b.bounding_radius[i]));
}

/* Largest 1 + m d^2/I over the edges of body i, with d the distance of the edge from the centre and I
 * about the parallel to the edge through the centre; for a segment over its ends and its line.  4 for any
 * edge of a box without radius. */
static double max_edge_ratio(const fl_world *w, int32_t i)
{
    const fl_bodies *b = &w->b;
    const fl_poly *p = &b->core[i];
    const fl_vec3 I = b->I[i]; /* ascending: a segment lies along x */
    const double r = b->radius[i], end = b->bounding_radius[i] + r;
    double largest = p->nf > 0 ? 0.0 : fmax(r * r / I.x, end * end / I.z);
    for (int32_t e = 0; e < p->ne && p->nf > 0; e++) {
        const fl_vec3 a = p->v[p->edge[e].a], t = v3_unit(v3_sub(p->v[p->edge[e].b], a));
        const double d = v3_norm(v3_cross(t, a)) + r;
        largest = fmax(largest, d * d * (t.x * t.x / I.x + t.y * t.y / I.y + t.z * t.z / I.z));
    }
    return 1.0 + b->m[i] * largest;
}

/* Tangential over normal compliance of body i in a contact, as it rotates: 1 + m r^2/I for a round body.
 * Other bodies have as much where they stand on a narrow end or an edge.  The critical step of the
 * present contacts includes that, but late damping leaves down to 0.55 of law->stable_share of it.  A
 * face at the height h has 1 + m h^2/I, less than its edges; a corner has up to 7, but does not touch
 * alone.  Automatic steps use half of law->stable_share with such damping, which is below all of these: 0
 * is returned unless `edges`. */
static double tangential_ratio_of(const fl_world *w, int32_t i, int edges)
{
    const fl_bodies *b = &w->b;
    const double r = b->radius[i];
    if (b->core[i].nv < 2) return 1.0 + b->m[i] * r * r / b->I[i].x;
    return edges ? max_edge_ratio(w, i) : 0.0;
}

/* Rolling resistance of the largest sphere also rotates a body that is no sphere, with the radius as arm. */
typedef struct {
    int32_t sphere; /* -1: none */
    double part;    /* largest fl_rolling_stiffness_ratio() of all laws */
} rolling_load;

static rolling_load rolling_load_of(const fl_world *w)
{
    rolling_load a = {.sphere = -1};
    for (int32_t i = 0; i < w->n && w->has_rolling; i++) {
        if (w->b.core[i].nv != 1 || fl_body_absent(w, i)) continue;
        if (a.sphere < 0 || w->b.radius[i] > w->b.radius[a.sphere]) a.sphere = i;
    }
    for (int32_t k = 0; k < w->materials * (w->materials + 2); k++)
        a.part = fmax(a.part, fl_rolling_stiffness_ratio(w->law[k].rolling));
    return a;
}

/* omega^2 of body i by that resistance [1/s2]. */
static double rolling_omega2(const fl_world *w, int32_t i, rolling_load load, extremes hit)
{
    if (load.sphere < 0 || w->b.core[i].nv == 1) return 0.0;
    const double R = w->b.radius[load.sphere];
    return load.part * R * R *
           tangent_stiffness(w, load.sphere, i, fl_pair_stiffness(w, i, load.sphere), hit) / w->b.I[i].x;
}

/* Tangential over normal stiffness, and damping, of a contact.  Rolling resistance rotates a sphere as
 * friction does, with an arm of its radius at most. */
static double tangential_factor(const fl_pair_law *law, int round, double rotates)
{
    const double friction_part = law->friction > 0.0 ? law->tangential_ratio * rotates : 0.0,
                 rolling_part = round ? fl_rolling_stiffness_ratio(law->rolling) * (rotates - 1.0) : 0.0;
    return fmax(1.0, friction_part + rolling_part);
}

/* N: the contacts that act on one motion are together N times as stiff and as damped as the bound of one.  Of
 * 2/omega of that bound late contacts leave share(z sqrt(N))/sqrt(N), near 1/N of what one leaves, and those
 * of `patch` FL_DAMPED_SHARE_MIN/sqrt(N).  The worst motion has all neighbours move against each other.  N is
 *     5.5   rough spheres that touch twelve others and all spin one way (5.1 measured),
 *     4     smooth spheres that touch twelve,
 *     2.7   cubes held at all six faces, as the bound of a face holds at its corner,
 *     1     two bodies, whose share automatic steps keep to anyway: 0.8 of an impact, half of a late one. */
static double contacts_per_motion(const fl_world *w, int round, double times)
{
    if (w->n <= 2) return 1.0;
    return fmin(round ? times > 1.0 ? 5.5 : 4.0 : FLOE_CONTACTS, w->n);
}

/* Cache of the last arguments per law: the shares fall with them, and their logarithms are costly. */
typedef struct {
    const fl_pair_law *law;
    double times, many;
} cached_shares;

enum { CACHED = 8 };

/* Smallest shares of 2/omega that damping leaves, over all contacts:
 *     one, many    stable for one contact, for many
 *     alone        used by automatic steps
 *     measured     used with run.error, where the present contacts are known
 *     bonds, bonds_measured   the same two for bonds, which include all bonds of a body */
typedef struct {
    double one, many, alone, measured, bonds_alone, bonds_measured;
    cached_shares before[CACHED];
} damping_shares;

static double stable_share_of(const fl_pair_law *law, double times)
{
    return fl_contact_law_scaled_share(law->law, law->impact_damping, law->stable_share, times);
}

/* Largest share of 2/omega for a trial with run.error, from the share that an impact leaves.  Above 0.12 of
 * 2/omega and a quarter of that share, windows of a few impacts did not show the error of the whole run (a
 * corner in a hook, verify_budget).  Weak damping permits more. */
static double trial_share(double left)
{
    return fmax(fmax(0.25 * left, 0.8 * left * left * left), fmin(0.8 * left, 0.12));
}

/* Lower the shares *r by a law.
 *   across  tangential over normal stiffness
 *   few     number of contacts of a motion, 1 or 2;  many: in a pack
 * Contacts of `patch` use the velocity of the end of the step, so that only an impact lowers them.  Late ones
 * use that of half a step ago. */
static void lower_shares(const fl_world *w, damping_shares *r, const fl_pair_law *law, int late,
                         double across, double few, double many)
{
    const int closed = law->law->damping == FL_DAMPING_IMPACT, spheres = many > FLOE_CONTACTS;
    if (law->law->end_speed && !late) {
        const double impact = fl_damping_impact_share(law->impact_damping);
        r->one = fmin(r->one, impact);
        r->alone = fmin(r->alone, 0.8 * impact); /* S25 of verify_step */
        r->measured = fmin(r->measured, trial_share(impact));
        if (spheres) r->measured = fmin(r->measured, FL_DAMPED_SHARE_MIN / sqrt(many));
        r->many = fmin(r->many, (spheres ? ACCURATE_SHARE : 1.0) * FL_DAMPED_SHARE_MIN / sqrt(many));
        return;
    }
    const double times = few * (closed ? across : 1.0); /* other laws damp the normal direction alone */
    cached_shares *const a = &r->before[(law - w->law) % CACHED];
    if (a->law == law && times <= a->times && many <= a->many) return;
    *a = (cached_shares){law, times, many};
    const double one = stable_share_of(law, times);
    r->one = fmin(r->one, one), r->alone = fmin(r->alone, 0.5 * one);
    r->measured = fmin(r->measured, 0.8 * one);
    r->many = fmin(r->many, stable_share_of(law, times / few * many) / sqrt(many));
}

static int has_strip(const fl_world *w, int32_t j)
{
    return w->strips.wall && w->strips.wall[j - w->n].n > 0;
}

/* Largest stiffness of ice that crushes by its speed, without damping; *moving: on a piece that moves. */
static double strip_slope(const fl_world *w, double *moving)
{
    double largest = 0.0;
    for (int32_t j = w->n; j < w->b.total && w->strips.wall; j++) {
        if (!has_strip(w, j)) continue;
        const double slope = fl_strips_stiffness(w, j - w->n);
        largest = fmax(largest, slope);
        if (fl_piece_moves(w, j)) *moving = fmax(*moving, slope);
    }
    return largest;
}

/* Largest omega^2 of any body, which *body has it, and the shares of its critical step that damping leaves.
 *   edges  include bodies that stand on edges, and round ones between two others
 *   bonds  weight of the omega^2 of bonds beside that of contacts */
static double find_stiffest(const fl_world *w, int edges, double bonds, int32_t *body, damping_shares *shares)
{
    const extremes hit = extremes_of(w);
    const rolling_load load = rolling_load_of(w);
    double largest = 0.0, mover_slope = 0.0;
    const double crushed = strip_slope(w, &mover_slope);
    *shares = (damping_shares){
        .one = 1.0, .many = 1.0, .alone = 0.5, .measured = 0.5, .bonds_alone = 0.5, .bonds_measured = 0.5};
    *body = -1;
    for (int32_t i = 0; i < w->n; i++) {
        const int round = w->b.core[i].nv < 2;
        const double places = round ? 1.0 : FACES_PER_BODY, rotates = tangential_ratio_of(w, i, edges);
        double stiffest =
            tangent_stiffness(w, i, i, fl_pair_stiffness(w, i, i), hit); /* against a body like itself */
        const fl_pair_law *law = fl_pair_law_of(w, i, i);
        double times = tangential_factor(law, round, rotates);
        const double few = edges && round ? 2.0 : 1.0;
        stiffest *= round ? times : 1.0;
        if (w->strips.wall && w->n == 1 && !w->cell.periodic) stiffest = 0.0; /* there is none */
        else lower_shares(w, shares, law, 0, times, few, contacts_per_motion(w, round, times));
        stiffest = fmax(stiffest, crushed);
        for (int32_t j = w->n; j < w->b.total; j++) {
            times = tangential_factor(law = fl_pair_law_of(w, i, j), round, rotates);
            const double stiffer = round ? times : 1.0;
            if (w->structure.piece[j - w->n].elastic) {
                stiffest = fmax(stiffest, stiffer * elastic_wall_stiffness(w, i));
                continue;
            }
            if (has_strip(w, j)) continue;
            const double slope = tangent_stiffness(w, i, j, fl_pair_stiffness(w, i, j), hit);
            stiffest = fmax(stiffest, stiffer * slope);
            if (fl_piece_moves(w, j)) mover_slope = fmax(mover_slope, places * slope);
            const int in_concave_edge = round && w->structure.piece[j - w->n].kind == FL_PIECE_MESH;
            lower_shares(w, shares, law, in_concave_edge || fl_piece_is_free(w, j), times, few,
                         contacts_per_motion(w, round, times));
        }
        /* Two equal bodies on one spring have twice the compliance.  With run.error the step may be half of
         * the largest stable one, by the closer bound; else it is a small share of the more careful one. */
        const int faces = w->scene->run.error > 0.0 && w->max_face_area[i] > 0.0;
        const double compliance = faces ? max_face_compliance(w, i) : max_vertex_compliance(w, i);
        double extension;
        const double omega2 = 2.0 * places * stiffest * compliance + rolling_omega2(w, i, load, hit) +
                              fl_driven_floe_spring(w, i, &extension) * w->b.invm[i] +
                              bonds * fl_bond_list_max_omega2(w, i);
        if (omega2 > largest) {
            largest = omega2;
            *body = i;
        }
    }
    const int32_t movers = fl_structure_has_members(w) ? 1 : w->moving.movers.n;
    for (int32_t m = 0; m < movers; m++) {
        const double omega2 = fl_mover_omega2(w, m, mover_slope);
        if (omega2 > largest) {
            largest = omega2;
            *body = w->b.total + m;
        }
    }
    for (int32_t k = 0; k < w->bonds.n; k++) {
        const double one = fl_damping_stable_share(0.5 * w->bonds.bond[k].damping * sqrt(largest));
        shares->one = fmin(shares->one, one), shares->bonds_alone = fmin(shares->bonds_alone, 0.5 * one);
        shares->bonds_measured = fmin(shares->bonds_measured, 0.8 * one);
    }
    for (int32_t k = 0; k < w->discs.n_class; k++) {
        const double one = fl_damping_stable_share(0.5 * w->discs.classes[k].damping * sqrt(largest));
        shares->one = fmin(shares->one, one), shares->bonds_alone = fmin(shares->bonds_alone, 0.5 * one);
        shares->bonds_measured = fmin(shares->bonds_measured, 0.8 * one);
    }
    return largest;
}

/* Share of the critical step that is used: that of the scene, bounded by damping; for contacts and for
 * bonds. */
static double share_of(const fl_world *w, const damping_shares *shares)
{
    const fl_scene_run *run = &w->scene->run;
    if (run->error > 0.0) return shares->measured;
    return fmin(run->safety, fmin(shares->alone, shares->many));
}

static double share_of_bonds(const fl_world *w, const damping_shares *shares)
{
    const fl_scene_run *run = &w->scene->run;
    return run->error > 0.0 ? shares->bonds_measured : fmin(run->safety, shares->bonds_alone);
}

double fl_critical_step(const fl_world *w)
{
    int32_t body;
    damping_shares shares;
    const double largest = find_stiffest(w, 0, 1.0, &body, &shares),
                 bodies = largest > 0.0 ? 2.0 / sqrt(largest) : INFINITY;
    return w->zones.set.blocks ? fmin(bodies, w->zones.dt_critical) : bodies;
}

static int32_t body_of_node(const fl_zone_set *s, int32_t n)
{
    int32_t k = 0;
    while (k + 1 < s->blocks && n >= s->block[k].node_end) k++;
    return s->block[k].body;
}

/* (omega dt/2)^2 of all that acts on one body adds up.  With the shares c and b of contacts and bonds
 * 1/dt^2 = (C/c^2 + B/b^2)/4: a body keeps to c when all its bonds have ended, to b while it has no contact,
 * and is stable with any mixture. */
static double step_of_bodies(const fl_world *w, int32_t *body)
{
    damping_shares shares, same;
    double largest = find_stiffest(w, 0, 1.0, body, &shares);
    if (largest == 0.0) return INFINITY;
    const double contacts = share_of(w, &shares), ratio = contacts / share_of_bonds(w, &shares);
    if (fl_world_bonds(w) && ratio != 1.0) largest = find_stiffest(w, 0, ratio * ratio, body, &same);
    return contacts * 2.0 / sqrt(largest);
}

double fl_automatic_step(const fl_world *w, int32_t *body)
{
    const double bodies = step_of_bodies(w, body),
                 zones = w->zones.set.blocks ? w->scene->run.safety * w->zones.dt_critical : INFINITY;
    if (zones < bodies) *body = body_of_node(&w->zones.set, w->zones.stiffest);
    return fmin(bodies, zones);
}

fl_predicted_limit fl_predict_step_limit(const fl_world *w)
{
    int32_t body;
    damping_shares shares;
    const double largest = find_stiffest(w, 0, 1.0, &body, &shares);
    if (largest == 0.0)
        return (fl_predicted_limit){.critical = INFINITY, .contact_share = share_of(w, &shares)};
    fl_predicted_limit f = {.critical = 2.0 / sqrt(largest), .contact_share = share_of(w, &shares)};
    const double same = f.contact_share * f.critical, dt = fl_automatic_step(w, &body);
    if (fl_world_bonds(w)) f.bond_relief = 1.0 / (same * same) - 1.0 / (dt * dt);
    return f;
}

double fl_longest_step(const fl_predicted_limit *f, double seen)
{
    const double same = f->contact_share * seen;
    return seen < f->critical ? same / sqrt(1.0 - f->bond_relief * same * same) : INFINITY;
}

int fl_shorten_step_at_start(fl_world *w)
{
    if (!isfinite(w->dt_critical)) return 0;
    if (w->zones.set.blocks && w->dt_critical == w->zones.dt_critical)
        return 0; /* it has been chosen by that */
    const fl_predicted_limit limit = fl_predict_step_limit(w);
    const double longest = fl_longest_step(&limit, w->dt_critical), every = w->scene->output.loads_every;
    if (w->dt <= longest) return 0;
    w->dt_safe = fmin(w->dt_safe, longest);
    w->dt = every / ceil(every / longest * (1.0 - 1e-12));
    return 1;
}

/* Compliance near the corner of a plate over that of its mass. */
#define PLATE_COMPLIANCE 1.25

double fl_least_fragment_area(const fl_world *w, int32_t i, double h)
{
    double c = fl_pair_stiffness(w, i, i).k, share = FL_DAMPED_SHARE_MIN;
    for (int32_t j = w->n - 1; j < w->n + w->pieces; j++) {
        const int32_t other = j < w->n ? i : j;
        const fl_pair_law *law = fl_pair_law_of(w, i, other);
        if (other != i) c = fmax(c, fl_pair_stiffness(w, i, other).k);
        if (law->law->end_speed) share = fmin(share, 0.8 * fl_damping_impact_share(law->impact_damping));
    }
    const double rho = w->scene->material[w->material[i]].density,
                 part = 2.0 * FACES_PER_BODY * PLATE_COMPLIANCE * 2.0 * c * w->dt * w->dt /
                        (4.0 * share * share * rho * h); /* omega^2 A/K of 2 c, over that of dt */
    return part > h ? part * part : fl_pow(part * sqrt(h), 4.0 / 3.0);
}

double fl_damped_share(const fl_world *w)
{
    int32_t body;
    damping_shares shares;
    return find_stiffest(w, 0, 1.0, &body, &shares) > 0.0 ? shares.one : 1.0;
}

double fl_lateral_share(const fl_world *w)
{
    int32_t body;
    damping_shares along, shares;
    if (find_stiffest(w, 0, 1.0, &body, &along) == 0.0) return 1.0;
    find_stiffest(w, 1, 1.0, &body, &shares);
    return shares.one / along.one;
}

/* Smallest number of samples of the waves in a period. */
#define SAMPLES 20.0

int fl_check_wave_sampling(const fl_world *w, fl_err *err)
{
    const fl_waves *waves = &w->sea.wave;
    if (!w->sea.sample) return 0;
    double omega = waves->train[(int32_t)(0.95 * (waves->n - 1))].omega;
    char name[64] = "the waves have";
    for (int32_t i = 0; i < w->n; i++) {
        int rotates;
        const double own = sqrt(fl_environment_omega2(&w->sea, &w->b, i, &rotates));
        if (!(own > omega)) continue;
        omega = own;
        snprintf(name, sizeof name, "body %d %s with", w->id[i], rotates ? "rolls" : "heaves");
    }
    const double period = 2.0 * PI / omega, largest = period / SAMPLES / w->dt;
    if (w->sea.sample_every <= largest * (1.0 + 1e-9)) return 0;
    return fl_fail(err, FL_INPUT,
                   "water.every: %d steps of %.4g s, and %s a period of %.4g s: %d samples in it; at most %d "
                   "steps expected, or a smaller run.dt",
                   w->sea.sample_every, w->dt, name, period, (int)(period / (w->sea.sample_every * w->dt)),
                   (int)fmax(1.0, largest));
}

/* D of the most damped contacts; late: of those that do not use fl_damping_end_speed() alone, the laws
 * `core`, `manual` and `manual-si`, and spheres in concave edges of a mesh. */
static double max_damping(const fl_world *w, int late)
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

static double ratio_of(double dt, double critical) { return isfinite(critical) ? dt / critical : 0.0; }

/* D of late contacts and of bonds; r as in critical_step.h. */
static double max_late_damping(const fl_world *w, double r)
{
    const double all = ratio_of(w->dt, w->dt_critical), D = max_damping(w, 1);
    return fl_world_bonds(w) && all > 0.0 ? fmax(D, 2.0 * w->scene->bond.damping * r / all) : D;
}

double fl_peak_error(const fl_world *w)
{
    const double r = ratio_of(w->dt, w->dt_critical_contacts), D = max_late_damping(w, r),
                 all = max_damping(w, 0);
    return 0.35 * D * r / (1.0 + 0.5 * D) +
           fmin(0.15 + 0.2 * all * all, fmax(0.95, 0.15 + 0.05 * all)) * r * r;
}

double fl_impulse_error(const fl_world *w)
{
    const double r = ratio_of(w->dt, w->dt_critical_contacts), first = 0.3 * r;
    return max_late_damping(w, r) > 0.0 ? first : fmin(first, 1.5 * r * r);
}
