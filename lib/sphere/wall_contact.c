/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "body/integrate.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/rolling_pair.h"
#include "contact/velocity_predictor.h"
#include "law/damping.h"
#include "law/normal.h"
#include "law/sphere_batch.h"
#include "patch/stiffness_bound.h"
#include "sphere/sphere_pair.h"
#include "sphere/wall_contact.h"

/* --- list -------------------------------------------------------------------------------------- */

int fl_wall_list_append(fl_world *w, int32_t i, int32_t j, int touches, const fl_sphere_contact *contact,
                        const fl_rolling_spring *roll, fl_err *err)
{
    fl_sphere_contacts *s = &w->spheres;
    const int64_t n = (int64_t)s->walls + 1;
    if (fl_grow(&s->wall, &s->wall_cap, n, sizeof *s->wall, err)) return -1;
    if (w->has_rolling) {
        if (fl_grow(&s->wall_rolling, &s->wall_rolling_cap, n, sizeof *s->wall_rolling, err)) return -1;
        s->wall_rolling[s->walls] = *roll;
    }
    s->wall[s->walls++] = (fl_wall_contact){.i = i,
                                            .j = j,
                                            .law = (int32_t)(fl_pair_law_of(w, i, j) - w->law),
                                            .touches = touches,
                                            .contact = *contact};
    return 0;
}

static int comes_before(const fl_wall_contact *a, int32_t i, int32_t j)
{
    return a->i != i ? a->i < i : a->j < j;
}

int fl_wall_list_build(fl_world *w, int64_t n, fl_err *err)
{
    fl_sphere_contacts *s = &w->spheres;
    fl_wall_contact *const old = s->wall;
    fl_rolling_spring *const rolled = s->wall_rolling, none = {.k = 0.0};
    const int32_t n_old = s->walls;
    int32_t at = 0;
    if (n > INT32_MAX) return fl_fail(err, FL_SYSTEM, "out of memory: %lld spheres at walls", (long long)n);
    s->walls = s->wall_cap = s->wall_rolling_cap = 0;
    s->wall = fl_alloc(n, sizeof *s->wall, err);
    s->wall_rolling = w->has_rolling && s->wall ? fl_alloc(n, sizeof *s->wall_rolling, err) : NULL;
    if (!s->wall || (w->has_rolling && !s->wall_rolling)) {
        free(old), free(rolled);
        return -1;
    }
    s->wall_cap = (int32_t)n;
    s->wall_rolling_cap = w->has_rolling ? (int32_t)n : 0;
    for (int32_t i = 0; i < w->n; i++) {
        for (int64_t k = w->candidates.first[i]; k < w->candidates.first[i + 1]; k++) {
            const int32_t j = w->candidates.partner[k];
            if (fl_sphere_pair_kind(w, i, j) != FL_SPHERE_WALL) continue;
            while (at < n_old && comes_before(&old[at], i, j)) at++;
            if (at < n_old && old[at].i == i && old[at].j == j) {
                if (rolled) s->wall_rolling[s->walls] = rolled[at];
                s->wall[s->walls++] = old[at];
            } else {
                const fl_sphere_contact fresh = {.k = fl_pair_stiffness(w, i, j).k};
                fl_wall_list_append(w, i, j, 0, &fresh, &none, err);
            }
        }
    }
    free(old), free(rolled);
    return 0;
}

int fl_wall_list_remove_absent(fl_world *w)
{
    fl_sphere_contacts *s = &w->spheres;
    int32_t kept = 0;
    for (int32_t c = 0; c < s->walls; c++) {
        if (fl_body_absent(w, s->wall[c].i)) continue;
        if (s->wall_rolling) s->wall_rolling[kept] = s->wall_rolling[c];
        s->wall[kept++] = s->wall[c];
    }
    const int dropped = kept < s->walls;
    s->walls = kept;
    return dropped;
}

void fl_wall_list_index(fl_sphere_contacts *s)
{
    int32_t c = 0;
    for (int32_t a = 0; a < s->chunks; a++) {
        s->wall_first[a] = c;
        for (; c < s->walls && s->wall[c].i < (a + 1) * FL_SPHERE_CHUNK; c++)
            s->contact_count[s->wall[c].i] += s->wall[c].touches;
    }
    s->wall_first[s->chunks] = c;
}

/* --- forces ------------------------------------------------------------------------------------- */

/* Normal of wall j, into the domain, and height of i over the wall. */
static fl_vec3 normal_of(const fl_world *w, int32_t j) { return m3_col(fl_body_axes(&w->b, j), 2); }
static double height_over(const fl_world *w, int32_t i, int32_t j, fl_vec3 n)
{
    return v3_dot(n, v3_sub(w->b.x[i], w->b.x[j]));
}

static double overlap_of(const fl_world *w, const fl_wall_contact *c, fl_vec3 n)
{
    return w->b.radius[c->i] - height_over(w, c->i, c->j, n);
}

/* Loads contact m of a batch.  For a centre behind the wall, whose foot would lie on the wrong side, the
 * wall is replaced by a sphere so far below that the overlap is the same. */
static void load_contact(const fl_world *w, fl_sphere_batch *a, int32_t m, const fl_wall_contact *c,
                         fl_vec3 n, double z)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = &w->law[c->law];
    const fl_sphere_contact *r = &c->contact;
    const double radius = b->radius[c->i], below = z > 0.0 ? 0.0 : radius - 2.0 * z;
    const fl_vec3 d = v3_scale(z + below, n), u = b->v[c->i], spin = b->w[c->i];
    const fl_sphere_state *const state = &w->spheres.state[c->i];
    a->d[0][m] = d.x, a->d[1][m] = d.y, a->d[2][m] = d.z;
    a->u[0][m] = u.x, a->u[1][m] = u.y, a->u[2][m] = u.z;
    a->wi[0][m] = spin.x, a->wi[1][m] = spin.y, a->wi[2][m] = spin.z;
    a->wj[0][m] = a->wj[1][m] = a->wj[2][m] = 0.0;
    /* the law takes the same fraction of both arms; the sphere's arm is r - s/2 */
    const double s = radius - z, both = radius + below - s, own = (radius - 0.5 * s) / radius,
                 arm = both > 0.0 ? own * (radius + below) / both : 1.0;
    const fl_vec3 rdw = v3_scale(arm, state->rdw);
    a->du[0][m] = state->dv.x, a->du[1][m] = state->dv.y, a->du[2][m] = state->dv.z;
    a->rdw[0][m] = rdw.x, a->rdw[1][m] = rdw.y, a->rdw[2][m] = rdw.z;
    a->ri[m] = radius;
    a->rj[m] = below;
    a->inv_mass[m] = fl_body_is_free(b, c->i) ? b->invm[c->i] : fl_body_mobility_along(b, c->i, n);
    a->slow_inv_mass[m] = law->slow_damping_factor * law->slow_damping_factor * a->inv_mass[m];
    a->inv_inertia[m] = arm * arm * state->inv_inertia;
    a->inv_mass_tangent[m] = b->invm[c->i];
    a->contact_count[m] = fl_effective_contact_count(state->contact_inv_mass, 0.0, b->invm[c->i]);
    a->k[m] = r->k;
    a->friction[m] = law->friction;
    a->tangential[m] = law->tangential_ratio;
    a->impact_damping[m] = law->impact_damping;
    a->max_approach_speed[m] = r->max_approach_speed;
    a->spring_force[0][m] = r->spring_force.x, a->spring_force[1][m] = r->spring_force.y,
    a->spring_force[2][m] = r->spring_force.z;
    a->spring_stiffness[m] = r->spring_stiffness;
    a->friction_force[0][m] = r->friction_force.x, a->friction_force[1][m] = r->friction_force.y,
    a->friction_force[2][m] = r->friction_force.z;
    a->normal_damping[m] = r->normal_damping;
}

static fl_vec3 vector_of(const double a[3][FL_SPHERE_BATCH], int32_t m)
{
    return v3(a[0][m], a[1][m], a[2][m]);
}

static void save_contact(fl_sphere_contact *r, const fl_sphere_batch *a, int32_t m)
{
    r->spring_force = vector_of(a->spring_force, m);
    r->spring_stiffness = a->spring_stiffness[m];
    r->friction_force = vector_of(a->friction_force, m);
    r->normal_damping = a->normal_damping[m];
    r->max_approach_speed = a->max_approach_speed[m];
}

static void add_to_sum(fl_sphere_sum *sum, const fl_sphere_batch *a, int32_t m)
{
    sum->elastic = v3_add(sum->elastic, vector_of(a->elastic_force, m));
    sum->damping = v3_add(sum->damping, vector_of(a->damping_force, m));
    sum->friction = v3_add(sum->friction, vector_of(a->friction_force, m));
    sum->torque = v3_add(sum->torque, vector_of(a->ti, m));
}

static void add_to_totals(fl_chunk_totals *t, const fl_sphere_batch *a, int32_t m, const fl_wall_contact *c)
{
    const double deep = a->overlap[m] / a->ri[m];
    t->force_sum += a->magnitude[m];
    t->touching++;
    if (deep > t->max_overlap) t->max_overlap = deep, t->max_overlap_i = c->i, t->max_overlap_j = c->j;
}

/* Middle of the overlap, from the reference point of the wall. */
static fl_vec3 middle_of(const fl_world *w, const fl_wall_contact *c, fl_vec3 n, double over)
{
    return v3_madd(v3_sub(w->b.x[c->i], w->b.x[c->j]), 0.5 * over - w->b.radius[c->i], n);
}

/* Adds contact m to the load on the wall; roll: its rolling spring, or NULL. */
static void add_to_load(const fl_world *w, fl_wall_load *load, const fl_wall_contact *c,
                        const fl_rolling_spring *roll, fl_vec3 n, const fl_sphere_batch *a, int32_t m)
{
    const fl_vec3 F = v3_madd(vector_of(a->friction_force, m), a->elastic[m] + a->normal_damping[m], n);
    load->f = v3_sub(load->f, F);
    load->t = v3_sub(load->t, v3_cross(middle_of(w, c, n, a->overlap[m]), F));
    load->t = v3_sub(load->t, fl_rolling_moment(roll));
}

/* Load of chunk a on wall j. */
static fl_wall_load *load_of(const fl_world *w, int32_t a, int32_t j)
{
    return &w->spheres.wall_load[a * w->walls + (j - w->n - w->pieces)];
}

/* Contacts of a chunk being evaluated. */
typedef struct {
    fl_sphere_batch at;
    int32_t contact[FL_SPHERE_BATCH]; /* in the list */
    fl_vec3 n[FL_SPHERE_BATCH];
    int32_t m;
} batch;

/* Adds the rolling resistance. */
static void add_rolling(const fl_world *w, batch *q, double dt)
{
    const fl_sphere_contacts *s = &w->spheres;
    fl_rolling_contact rolling[FL_SPHERE_BATCH];
    for (int32_t m = 0; m < q->m; m++) {
        const fl_wall_contact *const c = &s->wall[q->contact[m]];
        rolling[m] = (fl_rolling_contact){&w->law[c->law], &s->wall_rolling[q->contact[m]], c->i, -1};
    }
    fl_rolling_evaluate(w, &q->at, rolling, q->m, dt);
}

/* Rolling spring of contact c, or NULL. */
static const fl_rolling_spring *roll_of(const fl_sphere_contacts *s, int32_t c)
{
    return s->wall_rolling ? &s->wall_rolling[c] : NULL;
}

/* Evaluates the batch, adds its results and empties it. */
static void evaluate_batch(fl_world *w, int32_t chunk, batch *q, double dt, int survey)
{
    fl_sphere_contacts *s = &w->spheres;
    fl_sphere_batch *a = &q->at;
    if (dt < 0.0) fl_sphere_batch_restore(a, q->m);
    else fl_sphere_batch_evaluate(a, q->m, dt, fl_predictor_step_of(w, dt).half_step);
    if (s->wall_rolling) add_rolling(w, q, dt);
    for (int32_t m = 0; m < q->m; m++) {
        fl_wall_contact *const c = &s->wall[q->contact[m]];
        const fl_rolling_spring *const rolls = roll_of(s, q->contact[m]);
        if (dt >= 0.0) save_contact(&c->contact, a, m);
        add_to_sum(&s->sum[c->i], a, m);
        add_to_load(w, load_of(w, chunk, c->j), c, rolls, q->n[m], a, m);
        add_to_totals(&s->totals[chunk], a, m, c);
        if (survey)
            s->omega2[c->i] += fl_stiffness_of_point(&w->b, c->i, a->slope[m], a->spring_stiffness[m],
                                                     a->ri[m] - 0.5 * a->overlap[m],
                                                     rolls ? fl_rolling_turn_stiffness(rolls) : 0.0);
    }
    q->m = 0;
}

void fl_wall_chunk_evaluate(fl_world *w, int32_t a, double dt, int survey)
{
    fl_sphere_contacts *s = &w->spheres;
    batch q; /* large: not cleared */
    fl_vec3 up = v3(0, 0, 0);
    q.m = 0;
    q.at.exponent = fl_round_exponent(w);
    for (int32_t k = 0; k < w->walls; k++) s->wall_load[a * w->walls + k] = (fl_wall_load){0};
    for (int32_t c = s->wall_first[a], wall = -1; c < s->wall_first[a + 1]; c++) {
        fl_wall_contact *const l = &s->wall[c];
        if (l->j != wall) up = normal_of(w, wall = l->j);
        const double z = height_over(w, l->i, l->j, up);
        const int touches = z < w->b.radius[l->i];
        if (dt >= 0.0 && touches != l->touches) {
            if (l->touches) l->contact = (fl_sphere_contact){.k = l->contact.k};
            if (l->touches && s->wall_rolling) s->wall_rolling[c] = (fl_rolling_spring){.k = 0.0};
            l->touches = touches;
            fl_sphere_add_contact_count(s, l->i, touches ? 1 : -1);
        }
        if (!l->touches) continue;
        load_contact(w, &q.at, q.m, l, up, z);
        q.n[q.m] = up;
        q.contact[q.m++] = c;
        if (q.m == FL_SPHERE_BATCH) evaluate_batch(w, a, &q, dt, survey);
    }
    if (q.m) evaluate_batch(w, a, &q, dt, survey);
}

void fl_wall_add_forces(const fl_world *w, int32_t j, fl_vec3 *f, fl_vec3 *t)
{
    for (int32_t a = 0; a < w->spheres.chunks; a++) {
        const fl_wall_load *const load = load_of(w, a, j);
        *f = v3_add(*f, load->f);
        *t = v3_add(*t, load->t);
    }
}

void fl_wall_chunk_energy(const fl_world *w, int32_t a, double *all, double *springs)
{
    const fl_sphere_contacts *s = &w->spheres;
    for (int32_t c = s->wall_first[a]; c < s->wall_first[a + 1]; c++) {
        const fl_wall_contact *const l = &s->wall[c];
        if (!l->touches) continue;
        const double held = fl_sphere_spring_energy(&l->contact, roll_of(s, c));
        *all +=
            l->contact.k * fl_normal_phi(overlap_of(w, l, normal_of(w, l->j)), fl_round_exponent(w)) + held;
        *springs += held;
    }
}

void fl_wall_contact_to_pair(const fl_world *w, int32_t c, fl_pair *p)
{
    const fl_wall_contact *const l = &w->spheres.wall[c];
    const fl_vec3 n = normal_of(w, l->j);
    const double over = overlap_of(w, l, n);
    const fl_vec3 at = middle_of(w, l, n, over);
    fl_sphere_contact_to_pair(w, l->i, l->j, &l->contact, roll_of(&w->spheres, c), l->touches, n, over, p);
    if (!p->touching) return;
    const fl_vec3 moment = v3_neg(fl_rolling_moment(roll_of(&w->spheres, c)));
    p->torque_j = v3_sub(moment, v3_cross(at, p->force));
    p->torque_j_damping = v3_neg(v3_cross(at, p->force_damping));
    p->torque_j_friction = v3_sub(moment, v3_cross(at, p->force_friction));
}
