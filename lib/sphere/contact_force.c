/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <math.h>
#include <stdalign.h>
#include <stddef.h>
#include <string.h>
#include "base/array.h"
#include "base/simd.h"
#include "body/integrate.h"
#include "contact/rolling_pair.h"
#include "contact/velocity_predictor.h"
#include "law/damping.h"
#include "law/sphere_batch.h"
#include "law/sphere_kernel.h"
#include "patch/stiffness_bound.h"
#include "sphere/contact_force.h"
#include "sphere/sphere_pair.h"
#include "sphere/wall_contact.h"
#include "world/access.h"

/* Distances of prefetching: contacts to the body j, to the contact record, and slots. */
enum { PREFETCH_BODY = 64, PREFETCH_CONTACT = 24, PREFETCH_SLOT = 8 };

/* Touching contacts are evaluated in blocks of this size. */
enum { BLOCK = 16 };
static_assert(BLOCK + FL_SIMD_WIDTH <= FL_SPHERE_BATCH, "four contacts fit behind an incomplete block");

typedef struct {
    fl_sphere_batch at;
    double d[FL_SPHERE_BATCH][FL_SIMD_WIDTH]; /* D, and a number that is not used */
    int32_t contact[FL_SPHERE_BATCH];         /* in the list; filled to the end of a register */
    int32_t law[FL_SPHERE_BATCH];             /* whose parameters are loaded */
    double slow_factor2[FL_SPHERE_BATCH];     /* c^2 of fl_damping_slow_factor() */
    int32_t m;
} batch;

/* Updates the contacts from c on whose bit is set in `changed`: they begin or cease to touch.  One that
 * ceases loses its memory. */
static void toggle_contacts(fl_sphere_contacts *s, int32_t c, uint32_t changed)
{
    for (; changed; changed >>= 1, c++) {
        if (!(changed & 1)) continue;
        if (s->touches[c]) s->contact[c] = (fl_sphere_contact){.k = s->contact[c].k};
        if (s->touches[c] && s->rolling) s->rolling[c] = (fl_rolling_spring){.k = 0.0};
        s->touches[c] ^= 1;
        fl_sphere_add_contact_count(s, s->i[c], s->touches[c] ? 1 : -1),
            fl_sphere_add_contact_count(s, s->j[c], s->touches[c] ? 1 : -1);
    }
}

/* Tests contact c alone: true if |D|^2 < (r_i + r_j)^2; writes D behind the batch. */
static int test_contact(const fl_world *w, batch *t, int32_t c)
{
    const fl_vec3 d = fl_sphere_separation(w, c);
    const double R = w->b.radius[w->spheres.i[c]] + w->b.radius[w->spheres.j[c]];
    t->contact[t->m] = c;
    t->d[t->m][0] = d.x, t->d[t->m][1] = d.y, t->d[t->m][2] = d.z;
    return v3_norm2(d) - R * R < 0.0;
}

/* Inverse mass of body k if it is the same in all directions, else NAN. */
static double isotropic_inverse_mass(const fl_bodies *b, int32_t k)
{
    if (fl_body_fixed_translations(b, k) || b->heave_mass) return NAN;
    return b->added_mass ? 1.0 / (b->m[k] + b->added_mass[k].x) : b->invm[k];
}

/* Predicted change of the velocities of body k in the second half of a step: that of the first. */
static fl_velocity_change predict_change(const fl_world *w, int32_t k, double h)
{
    const fl_bodies *b = &w->b;
    fl_vec3 a, turn;
    if (fl_body_is_free_isotropic(b, k))
        a = v3_scale(b->invm[k], b->f[k]), turn = v3_scale(b->invI[k].x, b->t[k]);
    else fl_body_accelerations(b, k, &a, &turn);
    const fl_velocity_change kick = {v3_scale(h, a), v3_scale(h, turn)};
    return w->drag_change ? (fl_velocity_change){v3_add(kick.v, w->drag_change[k].v),
                                                 v3_add(kick.w, w->drag_change[k].w)}
                          : kick;
}

/* Velocity of the surface per impulse there by rotation, r^2/I; 0 if body k cannot rotate. */
static double surface_compliance(const fl_bodies *b, int32_t k)
{
    const int held = FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
    return (b->fixed_dof[k] & held) == held ? 0.0 : b->radius[k] * b->radius[k] * b->invI[k].x;
}

void fl_sphere_states_update(fl_world *w, int32_t from, int32_t to, double h)
{
    const fl_bodies *b = &w->b;
    fl_sphere_state *const state = w->spheres.state;
    for (int32_t k = from; k < to; k++) {
        const fl_velocity_change lead = predict_change(w, k, h);
        const int32_t rows = w->spheres.previous_contact_count[k] = w->spheres.contact_count[k];
        const double n = fl_sphere_contacts_in_line(rows + fl_sums_before(w, k)->contacts), r = b->radius[k],
                     crowd = n > 1.0 ? (n - 1.0) * fl_body_inverse_mass(b, k) : 0.0;
        state[k] = (fl_sphere_state){
            b->x[k], r,      b->v[k], isotropic_inverse_mass(b, k), b->w[k],
            r,       lead.v, crowd,   v3_scale(r, lead.w),          surface_compliance(b, k)};
    }
}

void fl_sphere_block_update(fl_world *w, int32_t from, int32_t to, double h)
{
    if (w->spheres.is_listed[from / FL_BODY_BLOCK]) fl_sphere_states_update(w, from, to, h);
    else
        memcpy(&w->spheres.previous_contact_count[from], &w->spheres.contact_count[from],
               (size_t)(to - from) * sizeof *w->spheres.contact_count);
}

/* The difference a - b of two vectors, and the sum of the numbers after them. */
FL_SIMD_INLINE void difference_and_sum(fl_simd *d, const void *a, const void *b)
{
    *d = __builtin_shufflevector(FL_SIMD_LOAD(a) - FL_SIMD_LOAD(b), FL_SIMD_LOAD(a) + FL_SIMD_LOAD(b), 0, 1,
                                 2, 7);
}

/* Arrays of the loop below. */
typedef struct {
    fl_world *w;
    const int32_t *i, *j;
    const fl_image_shift *shift;
    const uint8_t *by, *touches;
    const fl_sphere_state *state;
    const fl_sphere_contact *contact;
    int32_t n; /* contacts in the list */
} search_arrays;

/* Finds the touching contacts in [c, to), four at a time, until the batch has a block or less than four are
 * left.  Returns the next contact to test.
 *
 * Whether a contact touches cannot be predicted, so no branch depends on it: each is written behind the
 * last touching one, and the count advances or not.  Beginning and ceasing to touch is rare.  Later bodies
 * and contacts are prefetched, since with 100 000 spheres each access would else wait for memory. */
FL_SIMD4_VERSIONS static int32_t find_touching(const search_arrays *restrict s, batch *restrict t, int32_t c,
                                               int32_t to)
{
    const int32_t *bi = s->i, *bj = s->j;
    const fl_sphere_state *state = s->state;
    const uint8_t *touches = s->touches, *by = s->by;
    const fl_image_shift *shift = s->shift;
    int32_t m = t->m;
    for (; c + FL_SIMD_WIDTH <= to && m < BLOCK; c += FL_SIMD_WIDTH) {
        fl_simd v[FL_SIMD_WIDTH];
        uint32_t changed = 0;
        const int32_t *far = &bj[c + PREFETCH_BODY + FL_SIMD_WIDTH <= s->n ? c + PREFETCH_BODY : c];
        fl_prefetch(&s->contact[c + PREFETCH_CONTACT + FL_SIMD_WIDTH <= s->n ? c + PREFETCH_CONTACT : c],
                    FL_SIMD_WIDTH * sizeof *s->contact);
        FL_SIMD_UNROLL for (int32_t l = 0; l < FL_SIMD_WIDTH; l++)
        {
            const int32_t i = bi[c + l], j = bj[c + l];
            difference_and_sum(&v[l], &state[i].x, &state[j].x);
            v[l] -= FL_SIMD_LOAD(&shift[by[c + l]]);
            fl_prefetch(&state[far[l]], sizeof *state);
        }
        fl_simd d[] = {v[0], v[1], v[2], v[3]};
        fl_simd_transpose(d);
        const fl_simd gap = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - d[3] * d[3];
        const fl_simd_mask inside = gap < 0.0;
        FL_SIMD_UNROLL for (int32_t l = 0; l < FL_SIMD_WIDTH; l++)
        {
            const uint32_t one = (uint32_t)inside[l] & 1;
            t->contact[m] = c + l;
            FL_SIMD_STORE(t->d[m]) = v[l];
            m += (int32_t)one;
            changed |= (one ^ touches[c + l]) << l;
        }
        if (changed) toggle_contacts(&s->w->spheres, c, changed);
    }
    t->m = m;
    return c;
}

/* Loads what fl_sphere_batch_restore() needs. */
static void load_forces(const fl_world *w, batch *t)
{
    const fl_sphere_contacts *s = &w->spheres;
    fl_sphere_batch *a = &t->at;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->contact[m];
        const fl_sphere_contact *r = &s->contact[c];
        for (int axis = 0; axis < 3; axis++) a->d[axis][m] = t->d[m][axis];
        a->ri[m] = w->b.radius[s->i[c]];
        a->rj[m] = w->b.radius[s->j[c]];
        a->k[m] = r->k;
        a->friction_force[0][m] = r->friction_force.x;
        a->friction_force[1][m] = r->friction_force.y;
        a->friction_force[2][m] = r->friction_force.z;
        a->normal_damping[m] = r->normal_damping;
    }
}

/* Arrays that fl_sphere_batch_evaluate() is loaded from. */
typedef struct {
    const int32_t *i, *j;
    const fl_sphere_contact *contact;
    const fl_sphere_state *state;
} load_arrays;

/* Loads the batch; false if an inverse mass depends on the direction. */
FL_SIMD4_VERSIONS static int load_contacts(const load_arrays *restrict s, batch *restrict t)
{
    static_assert(offsetof(fl_sphere_contact, spring_stiffness) == sizeof(fl_vec3),
                  "a spring fills a register");
    static_assert(offsetof(fl_sphere_contact, k) ==
                      offsetof(fl_sphere_contact, max_approach_speed) + sizeof(double),
                  "the two are consecutive");
    const int32_t *bi = s->i, *bj = s->j;
    const fl_sphere_contact *contact = s->contact;
    const fl_sphere_state *state = s->state;
    const int32_t n = t->m;
    fl_sphere_batch *a = &t->at;
    const fl_simd zero = {0.0, 0.0, 0.0, 0.0};
    fl_simd all = zero;
    for (int32_t k = n; k % FL_SIMD_WIDTH; k++) t->contact[k] = t->contact[n - 1];
    for (int32_t m = 0; m < n; m += FL_SIMD_WIDTH) {
        fl_simd d[] = {FL_SIMD_LOAD(t->d[m]), FL_SIMD_LOAD(t->d[m + 1]), FL_SIMD_LOAD(t->d[m + 2]),
                       FL_SIMD_LOAD(t->d[m + 3])};
        fl_simd u[FL_SIMD_WIDTH], p[FL_SIMD_WIDTH], q[FL_SIMD_WIDTH], h[FL_SIMD_WIDTH], f[FL_SIMD_WIDTH],
            du[FL_SIMD_WIDTH], dw[FL_SIMD_WIDTH];
        fl_simd2 last[FL_SIMD_WIDTH];
        FL_SIMD_UNROLL for (int32_t l = 0; l < FL_SIMD_WIDTH; l++)
        {
            const int32_t c = t->contact[m + l], i = bi[c], j = bj[c];
            const fl_sphere_contact *r = &contact[c];
            difference_and_sum(&u[l], &state[i].v, &state[j].v);
            p[l] = FL_SIMD_LOAD(&state[i].w);
            q[l] = FL_SIMD_LOAD(&state[j].w);
            h[l] = FL_SIMD_LOAD(&r->spring_force);
            f[l] = FL_SIMD_LOAD(&r->friction_force);
            difference_and_sum(&du[l], &state[i].dv, &state[j].dv);
            dw[l] = FL_SIMD_LOAD(&state[i].rdw) + FL_SIMD_LOAD(&state[j].rdw);
            last[l] = *(const fl_simd2 *)(const void *)&r->max_approach_speed;
        }
        const fl_simd even = __builtin_shufflevector(last[0], last[2], 0, 1, 2, 3),
                      odd = __builtin_shufflevector(last[1], last[3], 0, 1, 2, 3);
        FL_SIMD_STORE(&a->max_approach_speed[m]) = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
        FL_SIMD_STORE(&a->k[m]) = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
        fl_simd_transpose(d);
        fl_simd_transpose(u);
        fl_simd_transpose(p);
        fl_simd_transpose(q);
        fl_simd_transpose(h);
        fl_simd_transpose(f);
        fl_simd_transpose(du);
        fl_simd_transpose(dw);
        FL_SIMD_UNROLL for (int axis = 0; axis < 3; axis++)
        {
            FL_SIMD_STORE(&a->friction_force[axis][m]) = f[axis];
            FL_SIMD_STORE(&a->du[axis][m]) = du[axis];
            FL_SIMD_STORE(&a->rdw[axis][m]) = dw[axis];
            FL_SIMD_STORE(&a->d[axis][m]) = d[axis];
            FL_SIMD_STORE(&a->u[axis][m]) = u[axis];
            FL_SIMD_STORE(&a->wi[axis][m]) = p[axis];
            FL_SIMD_STORE(&a->wj[axis][m]) = q[axis];
            FL_SIMD_STORE(&a->spring_force[axis][m]) = h[axis];
        }
        FL_SIMD_STORE(&a->spring_stiffness[m]) = h[3];
        FL_SIMD_STORE(&a->normal_damping[m]) = f[3];
        FL_SIMD_STORE(&a->contact_count[m]) = FL_SIMD_SELECT(u[3] > 0.0, 1.0 + du[3] / u[3], 1.0 + zero);
        FL_SIMD_STORE(&a->inv_inertia[m]) = dw[3];
        FL_SIMD_STORE(&a->inv_mass[m]) = u[3];
        FL_SIMD_STORE(&a->inv_mass_tangent[m]) = u[3];
        FL_SIMD_STORE(&a->slow_inv_mass[m]) =
            FL_SIMD_LOAD(&t->slow_factor2[m]) * u[3]; /* for the stored energy only */
        FL_SIMD_STORE(&a->ri[m]) = p[3];
        FL_SIMD_STORE(&a->rj[m]) = q[3];
        all += u[3];
    }
    const double sum = fl_simd_sum(&all);
    return sum == sum;
}

/* Loads the inverse masses that depend on the direction. */
static void load_masses(const fl_world *w, batch *t)
{
    const fl_bodies *b = &w->b;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t i = w->spheres.i[t->contact[m]], j = w->spheres.j[t->contact[m]];
        if (t->at.slow_inv_mass[m] == t->at.slow_inv_mass[m]) continue;
        const fl_vec3 n = v3_unit(v3(t->d[m][0], t->d[m][1], t->d[m][2]));
        t->at.inv_mass[m] = fl_body_mobility_along(b, i, n) + fl_body_mobility_along(b, j, n);
        t->at.inv_mass_tangent[m] = fl_body_inverse_mass(b, i) + fl_body_inverse_mass(b, j);
        t->at.contact_count[m] =
            fl_effective_contact_count(w->spheres.state[i].contact_inv_mass,
                                       w->spheres.state[j].contact_inv_mass, t->at.inv_mass_tangent[m]);
        t->at.slow_inv_mass[m] = t->slow_factor2[m] * t->at.inv_mass[m];
    }
}

/* Loads the parameters of law l for contact m. */
static void load_law(const fl_world *w, batch *t, int32_t m, int32_t l)
{
    const fl_pair_law *law = &w->law[l];
    t->law[m] = l;
    t->at.friction[m] = law->friction;
    t->at.tangential[m] = law->tangential_ratio;
    t->at.impact_damping[m] = law->impact_damping;
    t->slow_factor2[m] = law->slow_damping_factor * law->slow_damping_factor;
}

/* Loads the parameters of several laws; mostly those of the contacts before are the same. */
static void load_laws(const fl_world *w, batch *t)
{
    const int32_t *law = w->spheres.law;
    for (int32_t m = 0; m < t->m; m++)
        if (law[t->contact[m]] != t->law[m]) load_law(w, t, m, law[t->contact[m]]);
}

FL_SIMD4_VERSIONS static void save_contacts(fl_sphere_contact *restrict contact, const batch *restrict t)
{
    static_assert(offsetof(fl_sphere_contact, normal_damping) ==
                      offsetof(fl_sphere_contact, friction_force) + sizeof(fl_vec3),
                  "see sphere_contacts.h");
    const fl_sphere_batch *a = &t->at;
    const int32_t n = t->m;
    for (int32_t m = 0; m < n; m += FL_SIMD_WIDTH) {
        fl_simd h[] = {FL_SIMD_LOAD(&a->spring_force[0][m]), FL_SIMD_LOAD(&a->spring_force[1][m]),
                       FL_SIMD_LOAD(&a->spring_force[2][m]), FL_SIMD_LOAD(&a->spring_stiffness[m])};
        fl_simd f[] = {FL_SIMD_LOAD(&a->friction_force[0][m]), FL_SIMD_LOAD(&a->friction_force[1][m]),
                       FL_SIMD_LOAD(&a->friction_force[2][m]), FL_SIMD_LOAD(&a->normal_damping[m])};
        fl_simd_transpose(h);
        fl_simd_transpose(f);
        FL_SIMD_UNROLL for (int32_t l = 0; l < FL_SIMD_WIDTH; l++)
        {
            if (m + l >= n) break;
            fl_sphere_contact *r = &contact[t->contact[m + l]];
            FL_SIMD_STORE(&r->spring_force) = h[l];
            FL_SIMD_STORE(&r->friction_force) = f[l];
            r->max_approach_speed = a->max_approach_speed[m + l];
        }
    }
}

/* A sum fills three registers. */
enum { SUM_REGISTERS = 3 };
static_assert(sizeof(fl_sphere_sum) == SUM_REGISTERS * sizeof(fl_simd), "a sum is twelve doubles");

/* Clears n sums.  volatile keeps the compiler from using a string instruction, which is much slower here. */
FL_SIMD4_VERSIONS static void clear_sums(fl_sphere_sum *s, int32_t n)
{
    const fl_simd zero = {0.0, 0.0, 0.0, 0.0};
    for (int32_t k = 0; k < n; k++) {
        volatile fl_simd *sum = (volatile fl_simd *)&s[k];
        sum[0] = sum[1] = sum[2] = zero;
    }
}

/* Wrenches of four contacts, one contact each: parts that are opposite on i and j, and parts of either. */
typedef struct {
    fl_simd one[FL_SIMD_WIDTH], two[FL_SIMD_WIDTH], on_i[FL_SIMD_WIDTH], on_j[FL_SIMD_WIDTH];
} wrenches;

FL_SIMD_INLINE void find_wrenches(wrenches *q, const fl_sphere_batch *a, int32_t m)
{
    q->one[0] = FL_SIMD_LOAD(&a->elastic_force[0][m]), q->one[1] = FL_SIMD_LOAD(&a->elastic_force[1][m]);
    q->one[2] = FL_SIMD_LOAD(&a->elastic_force[2][m]), q->one[3] = FL_SIMD_LOAD(&a->damping_force[0][m]);
    q->two[0] = FL_SIMD_LOAD(&a->damping_force[1][m]), q->two[1] = FL_SIMD_LOAD(&a->damping_force[2][m]);
    q->two[2] = FL_SIMD_LOAD(&a->friction_force[0][m]), q->two[3] = FL_SIMD_LOAD(&a->friction_force[1][m]);
    q->on_i[0] = FL_SIMD_LOAD(&a->friction_force[2][m]), q->on_i[1] = FL_SIMD_LOAD(&a->ti[0][m]);
    q->on_i[2] = FL_SIMD_LOAD(&a->ti[1][m]), q->on_i[3] = FL_SIMD_LOAD(&a->ti[2][m]);
    q->on_j[0] = -q->on_i[0], q->on_j[1] = FL_SIMD_LOAD(&a->tj[0][m]);
    q->on_j[2] = FL_SIMD_LOAD(&a->tj[1][m]), q->on_j[3] = FL_SIMD_LOAD(&a->tj[2][m]);
    fl_simd_transpose(q->one);
    fl_simd_transpose(q->two);
    fl_simd_transpose(q->on_i);
    fl_simd_transpose(q->on_j);
}

/* Adds wrench l to the sum of i, and to that of j or to a slot.  Which of the two cannot be predicted, so
 * no branch depends on it. */
FL_SIMD_INLINE void add_wrench(fl_sphere_sum *sums, fl_sphere_sum *slots, int32_t i, int32_t to,
                               const wrenches *q, int32_t l)
{
    const int32_t beyond = to < 0 ? -1 : 0;
    const uintptr_t which = ((uintptr_t)sums ^ (uintptr_t)slots) & (uintptr_t)(intptr_t)beyond;
    fl_simd *on = (fl_simd *)&sums[i],
            *off = (fl_simd *)&((fl_sphere_sum *)((uintptr_t)sums ^ which))[to ^ beyond];
    on[0] += q->one[l], on[1] += q->two[l], on[2] += q->on_i[l];
    off[0] -= q->one[l], off[1] -= q->two[l], off[2] += q->on_j[l];
}

/* Adds the wrenches of the batch to the sums. */
FL_SIMD4_VERSIONS static void add_wrenches(const fl_sphere_contacts *restrict s, const batch *restrict t)
{
    const int32_t *bi = s->i, *bto = s->target, *contact = t->contact, n = t->m;
    fl_sphere_sum *sums = s->sum, *slots = s->slot;
    int32_t m = 0;
    for (; m + FL_SIMD_WIDTH <= n; m += FL_SIMD_WIDTH) {
        wrenches q;
        find_wrenches(&q, &t->at, m);
        FL_SIMD_UNROLL for (int32_t l = 0; l < FL_SIMD_WIDTH; l++)
            add_wrench(sums, slots, bi[contact[m + l]], bto[contact[m + l]], &q, l);
    }
    if (m < n) {
        wrenches q;
        find_wrenches(&q, &t->at, m);
        for (int32_t l = 0; m + l < n; l++)
            add_wrench(sums, slots, bi[contact[m + l]], bto[contact[m + l]], &q, l);
    }
}

/* Adds to each body the slots that refer to it, in their order. */
FL_SIMD4_VERSIONS static void collect_slots(fl_sphere_sum *restrict sums, const fl_sphere_sum *restrict slot,
                                            const int32_t *restrict slots, const int32_t *restrict into,
                                            int32_t from, int32_t to)
{
    for (int32_t k = from; k < to; k++) {
        fl_simd *sum = (fl_simd *)&sums[k], a = sum[0], b = sum[1], c = sum[2];
        if (into[k] == into[k + 1]) continue;
        for (int32_t at = into[k]; at < into[k + 1]; at++) {
            fl_prefetch(&slot[slots[at + PREFETCH_SLOT < into[to] ? at + PREFETCH_SLOT : at]], sizeof *slot);
            const fl_simd *in = (const fl_simd *)&slot[slots[at]];
            a += in[0], b += in[1], c += in[2];
        }
        sum[0] = a, sum[1] = b, sum[2] = c;
    }
}

/* True if one of the first m, or of the padding after them, overlaps by more than that fraction of the sum
 * of the radii. */
FL_SIMD_VERSIONS static int any_deeper(const fl_sphere_batch *a, int32_t m, double most)
{
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int32_t k = 0; k < m; k++) any |= a->overlap[k] > most * (a->ri[k] + a->rj[k]);
    return any;
}

/* Sum of |F| of the first m, lane by lane. */
FL_SIMD4_VERSIONS static double sum_magnitudes(const fl_sphere_batch *a, int32_t m)
{
    fl_simd sum = {0.0, 0.0, 0.0, 0.0};
    double rest = 0.0;
    int32_t k = 0;
    for (; k + FL_SIMD_WIDTH <= m; k += FL_SIMD_WIDTH) sum += FL_SIMD_LOAD(&a->magnitude[k]);
    for (; k < m; k++) rest += a->magnitude[k];
    return fl_simd_sum(&sum) + rest;
}

static void add_to_totals(const fl_sphere_contacts *s, const batch *t, fl_chunk_totals *totals)
{
    const fl_sphere_batch *a = &t->at;
    totals->force_sum += sum_magnitudes(a, t->m);
    totals->touching += t->m;
    if (!any_deeper(a, t->m, totals->max_overlap)) return;
    for (int32_t m = 0; m < t->m; m++) {
        const double both = a->ri[m] + a->rj[m];
        if (!(a->overlap[m] > totals->max_overlap * both)) continue;
        totals->max_overlap = a->overlap[m] / both;
        totals->max_overlap_i = s->i[t->contact[m]], totals->max_overlap_j = s->j[t->contact[m]];
    }
}

/* Adds the bounds of omega^2: K + sqrt(K K') of the two bodies' own. */
static void add_stiffness(fl_world *w, const batch *t)
{
    fl_sphere_contacts *s = &w->spheres;
    const fl_sphere_batch *a = &t->at;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->contact[m], i = s->i[c], j = s->j[c], to = s->target[c];
        const double half = 0.5 * a->overlap[m];
        const double rolls = s->rolling ? fl_rolling_turn_stiffness(&s->rolling[c]) : 0.0,
                     ki = fl_stiffness_of_point(&w->b, i, a->slope[m], a->spring_stiffness[m],
                                                a->ri[m] - half, rolls),
                     kj = fl_stiffness_of_point(&w->b, j, a->slope[m], a->spring_stiffness[m],
                                                a->rj[m] - half, rolls),
                     both = sqrt(ki * kj);
        s->omega2[i] += ki + both;
        if (to >= 0) s->omega2[j] += kj + both;
        else s->omega2_slot[~to] = kj + both;
    }
}

/* Adds the rolling resistance of the batch. */
static void add_rolling(const fl_world *w, batch *t, double dt)
{
    const fl_sphere_contacts *s = &w->spheres;
    fl_rolling_contact contact[FL_SPHERE_BATCH];
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->contact[m];
        contact[m] = (fl_rolling_contact){&w->law[s->law[c]], &s->rolling[c], s->i[c], s->j[c]};
    }
    fl_rolling_evaluate(w, &t->at, contact, t->m, dt);
}

/* Evaluates the batch, adds its results and empties it. */
static void evaluate_batch(fl_world *w, int32_t a, batch *t, double dt, int survey)
{
    fl_sphere_contacts *s = &w->spheres;
    if (dt < 0.0) {
        load_forces(w, t);
        fl_sphere_batch_restore(&t->at, t->m);
    } else {
        const load_arrays from = {s->i, s->j, s->contact, s->state};
        if (s->one_law < 0) load_laws(w, t);
        if (!load_contacts(&from, t)) load_masses(w, t);
        fl_sphere_batch_evaluate(&t->at, t->m, dt, fl_predictor_step_of(w, dt).half_step);
        save_contacts(s->contact, t);
    }
    if (s->rolling) add_rolling(w, t, dt);
    add_wrenches(s, t);
    add_to_totals(s, t, &s->totals[a]);
    if (survey) add_stiffness(w, t);
    t->m = 0;
}

/* The same for the first BLOCK contacts; the others move up. */
static void evaluate_block(fl_world *w, int32_t a, batch *t, double dt, int survey)
{
    const int32_t more = t->m - BLOCK;
    if (more < 0) return;
    t->m = BLOCK;
    evaluate_batch(w, a, t, dt, survey);
    memcpy(t->d, t->d[BLOCK], (size_t)more * sizeof *t->d);
    memcpy(t->contact, &t->contact[BLOCK], (size_t)more * sizeof *t->contact);
    t->m = more;
}

/* True if no contact refers to chunk a.  Its sums are 0 then; they are written only where they may not be. */
static int chunk_rests(const fl_world *w, int32_t a, int survey)
{
    enum { BLOCKS = FL_SPHERE_CHUNK / FL_BODY_BLOCK };
    static const uint8_t none[BLOCKS] = {0};
    const fl_sphere_contacts *s = &w->spheres;
    const fl_sphere_sum **const cleared = &s->cleared[2 * a];
    const int32_t begin = a * FL_SPHERE_CHUNK, n = fl_chunk_end(s, a) - begin;
    if (memcmp(&s->is_listed[BLOCKS * a], none, sizeof none) != 0) {
        cleared[0] = cleared[1] = NULL;
        return 0;
    }
    s->totals[a] = (fl_chunk_totals){.max_overlap_i = -1, .max_overlap_j = -1};
    if (survey) memset(&s->omega2[begin], 0, (size_t)n * sizeof *s->omega2);
    if (cleared[0] == s->sum || cleared[1] == s->sum) return 1;
    clear_sums(&s->sum[begin], n);
    cleared[1] = cleared[0], cleared[0] = s->sum;
    return 1;
}

void fl_sphere_chunk_evaluate(fl_world *w, int32_t a, double dt, int survey)
{
    if (chunk_rests(w, a, survey)) return;
    fl_sphere_contacts *s = &w->spheres;
    const int32_t begin = a * FL_SPHERE_CHUNK, end = fl_chunk_end(s, a), to = s->first[end],
                  slot_begin = s->slot_first[a];
    const search_arrays by = {w,          s->i,     s->j,       s->shift, s->shift_index,
                              s->touches, s->state, s->contact, s->n};
    const int wide = dt >= 0.0 && s->shifts;
    batch t;
    memset(t.law, -1, sizeof t.law);
    for (int32_t m = 0; s->one_law >= 0 && m < FL_SPHERE_BATCH; m++) load_law(w, &t, m, s->one_law);
    t.m = 0;
    t.at.exponent = fl_round_exponent(w);
    s->totals[a] = (fl_chunk_totals){.max_overlap_i = -1, .max_overlap_j = -1};
    clear_sums(&s->sum[begin], end - begin);
    clear_sums(&s->slot[slot_begin], s->slot_first[a + 1] - slot_begin);
    if (survey) {
        memset(&s->omega2[begin], 0, (size_t)(end - begin) * sizeof *s->omega2);
        memset(&s->omega2_slot[slot_begin], 0,
               (size_t)(s->slot_first[a + 1] - slot_begin) * sizeof *s->omega2_slot);
    }
    for (int32_t c = s->first[begin]; c < to;) {
        if (wide) c = find_touching(&by, &t, c, to);
        for (; c < to && t.m < BLOCK && (!wide || to - c < FL_SIMD_WIDTH); c++) {
            const uint8_t touches = (uint8_t)test_contact(w, &t, c);
            if (dt >= 0.0 && touches != s->touches[c]) toggle_contacts(s, c, 1);
            t.m += s->touches[c];
        }
        evaluate_block(w, a, &t, dt, survey);
    }
    if (t.m) evaluate_batch(w, a, &t, dt, survey);
    if (s->walls) fl_wall_chunk_evaluate(w, a, dt, survey);
}

void fl_sphere_sums_collect(fl_world *w, int32_t from, int32_t to)
{
    collect_slots(w->spheres.sum, w->spheres.slot, w->spheres.incoming, w->spheres.incoming_first, from, to);
}

int32_t fl_sphere_chunk_share(const fl_world *w, int t, int parts)
{
    const fl_sphere_contacts *s = &w->spheres;
    const int64_t all = (int64_t)s->n + s->bodies;
    int32_t lo = 0, hi = s->chunks; /* the result: the first chunk after the work of the shares before */
    while (lo < hi) {
        const int32_t a = (lo + hi) / 2, k = a * FL_SPHERE_CHUNK;
        if (((int64_t)s->first[k] + k) * parts < all * t) lo = a + 1;
        else hi = a;
    }
    return lo;
}
