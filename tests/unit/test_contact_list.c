/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "base/rng.h"
#include "law/damping.h"
#include "law/normal.h"
#include "law/sphere_batch.h"
#include "sim/energy_balance.h"
#include "sphere/contact_force.h"
#include "sphere/sphere_pair.h"
#include "sphere/contact_list.h"
#include "contact/pair_force.h"
#include "sphere/wall_contact.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "sim/neighbour_list.h"
#include "support/bits.h"
#include "support/small_world.h"
#include "support/near.h"
#include "support/scenes.h"

#define TOL 1e-11 /* rounding of coordinates of a few metres, over an overlap of centimetres */

static void assert_near3(fl_vec3 a, fl_vec3 b, double size)
{
    assert_near_of(v3_norm(v3_sub(a, b)), 0.0, TOL, size);
}

/* Updates the sphere states without predicted changes of velocity: pairs outside the world have none. */
static void update_states(fl_world *w, int32_t n)
{
    fl_sphere_states_update(w, 0, n, 0.5 * w->dt);
    for (int32_t k = 0; k < n; k++) w->spheres.state[k].dv = w->spheres.state[k].rdw = v3(0, 0, 0);
}

/* Evaluates one sphere contact after another by the general pair kernel, through impact, sticking and
 * sliding. */
static void sphere_pairs_match_general_pairs(void **state)
{
    int64_t touched = 0, slid = 0;
    (void)state;
    for (int k = 0; k < test_times(40); k++) {
        lab l;
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double ra = fl_rng_in(&g, 0.1, 1.0), rb = fl_rng_in(&g, 0.1, 1.0);
        fl_vec3 n = v3_unit(v3(fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g)));
        const fl_vec3 across = v3_scale(fl_rng_in(&g, 0.0, 2.0), v3_normal_to(n));
        lab_start(&l);
        lab_set(&l, "material.ice.young=1 MPa");
        lab_setf(&l, "contact.friction=%g", fl_rng_in(&g, 0.0, 0.6));
        /* with damping, the contact list assumes that spheres come from their previous positions, and takes
         * the same share of lever arms */
        const double loosely = k % 2 ? 1e8 : 1.0;
        lab_setf(&l, "contact.restitution=%g", k % 2 ? fl_rng_in(&g, 0.05, 0.9) : 1.0);
        lab_sphere(&l, v3_scale(1.001 * ra, n), ra, v3_madd(across, -1.0, n),
                   v3_scale(fl_rng_in(&g, 0, 3), across));
        lab_sphere(&l, v3_scale(-rb, n), rb, v3_scale(0.5, n), v3(1, fl_rng_in(&g, -2, 2), 0));
        lab_make(&l, 0);
        l.w.dt *= 0.2;
        fl_pair other;
        fl_pair_init(&l.w, &other, 0, 1);
        for (int s = 0; s < 200; s++) {
            /* a step without its second half: contacts use the velocities at mid-step */
            fl_bodies *b = &l.w.b;
            for (int i = 0; i < 2; i++) fl_kick(b, i, 0.5 * l.w.dt), fl_drift(b, i, l.w.dt);
            update_states(&l.w, 2);
            fl_sphere_chunk_evaluate(&l.w, 0, l.w.dt, 1);
            fl_pair_evaluate(&l.w, &other, 0, l.w.dt, 1);
            const fl_pair p = lab_pair(&l, 0);
            const double F = loosely * v3_norm(other.force), T = F * (ra + rb);
            assert_int_equal(p.touching, other.touching);
            if (p.touching) {
                assert_near3(p.force, other.force, F), assert_near3(p.force_damping, other.force_damping, F),
                    assert_near3(p.force_friction, other.force_friction, F);
                assert_near3(p.torque_i, other.torque_i, T), assert_near3(p.torque_j, other.torque_j, T),
                    assert_near3(p.torque_i_friction, other.torque_i_friction, T);
                assert_near3(p.springs.force, other.springs.force, F);
                assert_near_of(p.springs.k, other.springs.k, TOL, other.springs.k + 1.0);
                assert_near(p.max_approach_speed, other.max_approach_speed, 1e-12);
                assert_near_of(p.energy, other.energy, TOL, F * ra);
                assert_near_of(p.spring_energy, other.spring_energy, TOL, F * ra);
                /* an upper bound: at most Frobenius' fourth root above the largest eigenvalue */
                assert_true(p.omega2_i <= other.omega2_i * (1 + TOL) && other.omega2_i <= 1.26 * p.omega2_i);
                assert_true(p.omega2_j <= other.omega2_j * (1 + TOL) && other.omega2_j <= 1.26 * p.omega2_j);
                slid += v3_norm(p.force_friction) >=
                        0.999 * p.law->friction *
                            v3_dot(v3_sub(p.force, p.force_friction), v3_unit(v3_sub(b->x[0], b->x[1])));
                touched++;
            }
            for (int i = 0; i < 2; i++) {
                b->f[i] = b->t[i] = v3(0, 0, 0);
                fl_sphere_sums_collect(&l.w, i, i + 1);
                fl_sphere_add_forces(&l.w, i, &b->f[i], &b->t[i]);
                fl_kick(b, i, 0.5 * l.w.dt);
            }
            assert_near3(b->f[0], other.force, F + 1e-300), assert_near3(b->t[1], other.torque_j, T + 1e-300);
        }
        fl_pair_free(&other);
        lab_free(&l);
    }
    assert_true(touched > 20 * test_times(40) && slid > 0 && slid < touched);
}

/* Damping of sphere contacts uses the speeds at the end of the step, including the change by the contact
 * itself. */
static void damping_uses_the_speed_at_the_end(void **state)
{
    int64_t without_force = 0, touched = 0;
    (void)state;
    for (int k = 0; k < test_times(20); k++) {
        lab l;
        double touch = 0.0, had = 0.0, damped = 0.0;
        fl_rng g = fl_rng_of(test_seed(), 300 + k, FL_RNG_TEST);
        lab_start(&l);
        lab_set(&l, "material.ice.young=1 MPa");
        lab_set(&l, "contact.friction=0");
        lab_setf(&l, "contact.restitution=%g", fl_rng_in(&g, 0.05, 0.9));
        lab_sphere(&l, v3(0.501, 0, 0), 0.5, v3(-1, 0.3, 0), v3(0, 0, 0));
        lab_sphere(&l, v3(-0.3, 0, 0), 0.3, v3(0.5, 0, 0), v3(0, 0, 0));
        lab_make(&l, 0);
        l.w.dt *= 0.5;
        fl_bodies *b = &l.w.b;
        for (int s = 0; s < 400; s++) {
            const double h = 0.5 * l.w.dt;
            for (int i = 0; i < 2; i++) fl_kick(b, i, h), fl_drift(b, i, l.w.dt);
            fl_sphere_states_update(&l.w, 0, 2, h);
            fl_sphere_chunk_evaluate(&l.w, 0, l.w.dt, 1);
            const fl_pair p = lab_pair(&l, 0);
            if (p.touching) {
                const fl_vec3 d = v3_sub(b->x[0], b->x[1]), n = v3_unit(d);
                const double over = 0.8 - v3_norm(d), elastic = p.k * fl_normal_power(over, 1.5);
                const fl_vec3 next[2] = {v3_madd(b->v[0], h * b->invm[0], b->f[0]),
                                         v3_madd(b->v[1], h * b->invm[1], b->f[1])};
                const double closing = -v3_dot(n, v3_sub(next[0], next[1])), now = fmax(closing, 0.0);
                touch = fmax(touch, now);
                const double chi = fl_damping_chi(p.law->impact_damping, p.law->slow_damping_factor, touch,
                                                  p.k * fl_normal_phi(over, 1.5), p.mass),
                             ends = fl_damping_end_speed(closing, chi * elastic, h / p.mass, 1.0,
                                                         elastic - had, damped, 0.0),
                             normal = fl_normal_damped_force(elastic, chi, ends);
                assert_true(fabs(v3_dot(p.force, n) - normal) < 1e-5 * elastic);
                assert_near3(p.force_damping, v3_madd(p.force, -elastic, n), elastic);
                had = elastic, damped = v3_dot(p.force_damping, n);
                without_force += normal == 0.0, touched++;
            }
            for (int i = 0; i < 2; i++) {
                b->f[i] = b->t[i] = v3(0, 0, 0);
                fl_sphere_sums_collect(&l.w, i, i + 1);
                fl_sphere_add_forces(&l.w, i, &b->f[i], &b->t[i]);
                fl_kick(b, i, h);
            }
        }
        lab_free(&l);
    }
    assert_true(touched > 20 * test_times(20) && without_force < touched);
}

/* Share of damping in the force on a sphere at rest that a current presses against a wall. */
static double damping_share_at_rest(double safety)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "material.ice.young=1 MPa");
    lab_set(&l, "run.gravity=9.81");
    lab_setf(&l, "run.safety=%g", safety);
    lab_set(&l, "water.level=0");
    lab_set(&l, "water.current=3 0 0");
    lab_set(&l, "water.drag_force_coef=0.05");
    lab_set(&l, "contact.friction=0");
    lab_set(&l, "contact.restitution=0.3");
    lab_set(&l, "boundary.type=rigid free free");
    lab_set(&l, "boundary.max=0 none none");
    lab_sphere(&l, v3(-0.5, 0, -0.4), 0.5, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 0);
    assert_int_equal(lab_run(&l, (int64_t)(60.0 / l.w.dt)), 0);
    const fl_pair p = lab_pair(&l, 0);
    assert_true(p.touching && v3_norm(p.force) > 100.0);
    lab_free(&l);
    return v3_norm(p.force_damping) / v3_norm(p.force);
}

/* Drag is included in the predicted velocities: the share is zero but for quadratic drag between the halves
 * of a step, to order 2. */
static void predicted_velocities_include_drag(void **state)
{
    (void)state;
    const double long_steps = damping_share_at_rest(0.4), half = damping_share_at_rest(0.2);
    assert_true(long_steps < 2e-3 && half < 0.3 * long_steps);
}

/* One step of the only sphere and wall by wall_contact.h and by the general pair force. Returns whether they
 * touch. */
static int step_both_paths(fl_world *w, fl_pair *p, fl_pair *other)
{
    assert_int_equal(w->spheres.walls, 1);
    fl_wall_contact_to_pair(w, 0, other);
    fl_pair_evaluate(w, other, 0, w->dt, 1);
    update_states(w, 1);
    fl_sphere_chunk_evaluate(w, 0, w->dt, 1);
    fl_wall_contact_to_pair(w, 0, p);
    assert_int_equal(p->touching, other->touching);
    return p->touching;
}

static void assert_same_pair(const fl_pair *p, const fl_pair *other, double r, double far)
{
    const double F = v3_norm(other->force), T = F * far;
    assert_near3(p->force, other->force, F), assert_near3(p->force_damping, other->force_damping, F),
        assert_near3(p->force_friction, other->force_friction, F);
    assert_near3(p->torque_i, other->torque_i, T), assert_near3(p->torque_j, other->torque_j, T),
        assert_near3(p->torque_i_damping, other->torque_i_damping, T);
    assert_near3(p->torque_j_damping, other->torque_j_damping, T),
        assert_near3(p->torque_i_friction, other->torque_i_friction, T),
        assert_near3(p->torque_j_friction, other->torque_j_friction, T);
    assert_near3(p->springs.force, other->springs.force, F);
    assert_near_of(p->springs.k, other->springs.k, TOL, other->springs.k + 1.0);
    assert_near(p->max_approach_speed, other->max_approach_speed, 1e-12),
        assert_near(p->overlap, other->overlap, 1e-9);
    assert_near_of(p->energy, other->energy, TOL, F * r);
    assert_near_of(p->spring_energy, other->spring_energy, TOL, F * r);
    assert_true(p->omega2_i <= other->omega2_i * (1 + TOL) && other->omega2_i <= 1.26 * p->omega2_i);
    assert_true(p->omega2_j == 0.0 && other->omega2_j == 0.0);
}

/* Spheres that roll, slide and bounce on a floor. */
static void wall_contacts_match_general_pairs(void **state)
{
    int64_t touched = 0, slid = 0;
    (void)state;
    for (int k = 0; k < test_times(20); k++) {
        lab l;
        fl_rng g = fl_rng_of(test_seed(), 100 + k, FL_RNG_TEST);
        const double r = fl_rng_in(&g, 0.1, 1.0);
        lab_start(&l);
        lab_set(&l, "material.ice.young=1 MPa");
        lab_set(&l, "run.gravity=9.81");
        lab_setf(&l, "contact.friction=%g", k % 5 ? fl_rng_in(&g, 0.0, 0.6) : 0.0);
        lab_set(&l, "contact.restitution=1");
        lab_set(&l, "boundary.type=free free rigid");
        lab_set(&l, "boundary.min=none none -3");
        lab_sphere(&l, v3(7, -5, r - 3.0), r, v3(fl_rng_in(&g, 0, 2), 0.3, -1.0),
                   v3(1, fl_rng_in(&g, -3, 3), 2));
        lab_make(&l, 0);
        fl_world *w = &l.w;
        for (int s = 0; s < 200; s++) {
            fl_pair p, other;
            assert_int_equal(lab_run(&l, 1), 0);
            if (w->spheres.walls == 0) continue;
            if (step_both_paths(w, &p, &other)) {
                const double F = v3_norm(other.force);
                fl_vec3 f = v3(0, 0, 0), t = v3(0, 0, 0);
                assert_same_pair(&p, &other, r, 10.0);
                fl_wall_add_forces(w, 1, &f, &t);
                assert_near3(f, v3_neg(other.force), F), assert_near3(t, other.torque_j, 10.0 * F);
                f = t = v3(0, 0, 0);
                fl_sphere_add_forces(w, 0, &f, &t);
                assert_near3(f, other.force, F), assert_near3(t, other.torque_i, F);
                slid += p.law->friction > 0.0 &&
                        v3_norm(p.force_friction) >= 0.999 * p.law->friction * fabs(p.force.z);
                touched++;
            }
            fl_pair_free(&other);
        }
        lab_free(&l);
    }
    assert_true(touched > 20 * test_times(20) && slid > 0 && slid < touched);
}

/* A centre on the wall or behind it is pushed out like one in front of it. A contact that ends loses its
 * history. */
static void deep_and_grazing_wall_contacts_match(void **state)
{
    lab l;
    fl_pair p, other;
    (void)state;
    lab_start(&l);
    lab_set(&l, "material.ice.young=1 MPa");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=1"); /* spheres come from their previous positions */
    lab_set(&l, "boundary.type=free free rigid");
    lab_set(&l, "boundary.min=none none 0");
    lab_sphere(&l, v3(0, 0, 0.99), 1.0, v3(0.1, 0, -0.1), v3(0, 0, 0));
    lab_make(&l, 1e-4);
    assert_true(l.w.n_pair == 0 && l.w.spheres.walls == 1);
    static const double HEIGHT[] = {0.99, 0.5, 1e-9, 0.0, -1e-9, -0.5, -1.0, -3.0};
    for (size_t k = 0; k < sizeof HEIGHT / sizeof *HEIGHT; k++) {
        l.w.b.x[0].z = HEIGHT[k];
        assert_true(step_both_paths(&l.w, &p, &other));
        assert_same_pair(&p, &other, 1.0, 10.0);
        assert_near_of(p.overlap, 1.0 - HEIGHT[k], TOL, 1.0);
        fl_pair_free(&other);
    }
    assert_true(l.w.spheres.wall[0].contact.spring_stiffness > 0.0);
    l.w.b.x[0].z = 1.01;
    assert_false(step_both_paths(&l.w, &p, &other));
    assert_true(l.w.spheres.wall[0].contact.spring_stiffness == 0.0 &&
                l.w.spheres.wall[0].contact.max_approach_speed == 0.0);
    fl_pair_free(&other);
    lab_free(&l);
}

/* With the laws of the manual and on elastic walls, spheres are general pairs. */
static void only_hertz_on_rigid_walls_is_fast(void **state)
{
    static const char *const KEYS[] = {"contact.law=core", "contact.law=manual",
                                       "boundary.type=free free elastic"};
    (void)state;
    for (int k = 0; k < 3; k++) {
        lab l;
        lab_start(&l);
        lab_set(&l, "material.ice.young=1 MPa");
        lab_set(&l, "boundary.type=free free rigid");
        lab_set(&l, "boundary.min=none none 0");
        if (k == 2) lab_set(&l, "boundary.stiffness=1e6");
        lab_set(&l, KEYS[k]);
        lab_sphere(&l, v3(0, 0, 0.99), 1.0, v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, 1e-4);
        assert_int_equal(l.w.spheres.walls, k == 0);
        assert_int_equal(l.w.n_pair, k != 0);
        lab_free(&l);
    }
}

/* Power dissipated by damping and friction of the sums, at the current velocities [W]. */
static void powers_of(const fl_world *w, double *damping, double *friction)
{
    for (int32_t k = 0; k < w->n; k++) {
        const fl_sphere_sum *q = &w->spheres.sum[k];
        *damping -= v3_dot(q->damping, w->b.v[k]);
        *friction -= v3_dot(q->friction, w->b.v[k]) + v3_dot(q->torque, w->b.w[k]);
    }
}

/* Sums, work and counts over chunks against those over pairs. */
static void chunk_sums_match_pair_sums(void **state)
{
    lab l;
    (void)state;
    scene_of_spheres(&l, 9, "patch"); /* 729 bodies: three chunks */
    lab_make(&l, 0);
    assert_int_equal(lab_run(&l, 60), 0);
    fl_world *w = &l.w;
    assert_true(w->spheres.chunks == 3 && w->spheres.slot_first[3] > 100);
    fl_vec3 *f = calloc((size_t)w->b.total, sizeof *f), *t = calloc((size_t)w->b.total, sizeof *t);
    assert_true(f && t);
    fl_pair_iterator at = {.w = w};
    double damping = 0.0, friction = 0.0, elastic = 0.0, spring = 0.0, size = 0.0, worst = 0.0, largest = 0.0;
    int64_t touching = 0;
    int32_t i = -1, j = -1;
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        assert_true(p->i > i || (p->i == i && p->j >= j)); /* in order, with boxes between them */
        i = p->i, j = p->j;
        if (!fl_sphere_pair_kind(w, p->i, p->j) || !p->touching) continue;
        const fl_vec3 dv = v3_sub(w->b.v[i], w->b.v[j]);
        f[i] = v3_add(f[i], p->force), f[j] = v3_sub(f[j], p->force);
        t[i] = v3_add(t[i], p->torque_i), t[j] = v3_add(t[j], p->torque_j);
        damping -= v3_dot(p->force_damping, dv);
        friction -= v3_dot(p->force_friction, dv) + v3_dot(p->torque_i_friction, w->b.w[i]) +
                    v3_dot(p->torque_j_friction, w->b.w[j]);
        elastic += p->energy, spring += p->spring_energy;
        size += v3_norm(p->force), largest = fmax(largest, v3_norm(p->force));
        worst = fmax(worst, p->overlap / (w->b.radius[i] + w->b.radius[j]));
        touching++;
    }
    assert_true(touching > 500);
    for (int32_t k = 0; k < w->n; k++) {
        fl_vec3 fk = v3(0, 0, 0), tk = v3(0, 0, 0);
        fl_sphere_add_forces(w, k, &fk, &tk);
        assert_near3(fk, f[k], largest), assert_near3(tk, t[k], largest);
    }
    double d = 0.0, r = 0.0, e = 0.0, s = 0.0;
    powers_of(w, &d, &r), fl_contact_list_energy(w, &e, &s);
    const fl_sphere_totals all = fl_contact_list_totals(w);
    assert_near_of(d, damping, TOL, largest), assert_near_of(r, friction, TOL, largest);
    assert_near(e, elastic, 1e-11), assert_near(s, spring, 1e-11);
    assert_near(all.force_sum, size, 1e-11), assert_near(all.max_overlap, worst, 1e-11);
    assert_int_equal(all.touching, touching);
    /* rebuilt from the contact records: the same bits */
    fl_err err = {0};
    double d2 = 0.0, r2 = 0.0;
    assert_int_equal(fl_contact_list_index(w, &err), 0);
    powers_of(w, &d2, &r2);
    assert_true(d == d2 && r == r2);
    /* and with other records, which do not touch */
    w->skin *= 3.0, w->last_search_step = -1;
    const int32_t rows = w->spheres.n;
    assert_int_equal(fl_neighbour_list_update(w, &err), 0);
    assert_true(w->spheres.n > rows);
    assert_int_equal(fl_contact_list_index(w, &err), 0);
    d2 = r2 = 0.0;
    powers_of(w, &d2, &r2);
    assert_true(d == d2 && r == r2);
    free(f), free(t);
    lab_free(&l);
}

/* Spheres that cannot be advanced in batches, because of fixed directions, added mass or waves: their energy
 * ledger closes as that of other bodies does, to the order of the step. */
static void single_spheres_balance_energy(void **state)
{
    static const char *const KEYS[][2] = {{"group.some.fixed=rx", NULL},
                                          {"group.some.fixed=z", NULL},
                                          {"water.level=0", "water.added_mass=auto"},
                                          {"water.level=0", "water.wave=airy"}};
    (void)state;
    for (int k = 0; k < 4; k++) {
        lab l;
        fl_err err = {0};
        lab_start(&l);
        lab_set(&l, "material.ice.young=1 MPa");
        lab_set(&l, "contact.friction=0.3");
        lab_set(&l, "contact.restitution=0.4");
        lab_set(&l, "run.gravity=9.81");
        lab_set(&l, "run.safety=0.2");
        lab_set(&l, "boundary.type=rigid rigid rigid");
        lab_set(&l, "boundary.min=-2.05 -2.05 -2.05");
        lab_set(&l, "boundary.max=2.05 2.05 none");
        for (int e = 0; e < 2 && KEYS[k][e]; e++) lab_set(&l, KEYS[k][e]);
        if (k == 3) lab_set(&l, "water.height=0.2"), lab_set(&l, "water.period=2");
        for (int32_t i = 0; i < 64; i++) {
            fl_rng g = fl_rng_of(6, i, FL_RNG_TEST);
            const fl_vec3 at = v3(i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1.5), spin = v3(2.0, -1.0, i % 3);
            const fl_vec3 v = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1));
            fl_poly p = {0};
            assert_int_equal(fl_poly_make(&p, 1, &at, 0, NULL, NULL, &err), 0);
            assert_int_equal(fl_ice_field_add(&l.field, i + 1, i % 2 ? 0.5 : 0.47, &p, NULL,
                                              k < 2 && i % 3 == 0 ? "some" : NULL, v, spin, &err),
                             0);
        }
        if (k < 2) lab_set(&l, "group.some.velocity=0 0 0");
        lab_make(&l, 0.0);
        assert_int_equal(lab_run(&l, 200), 0);
        assert_true(l.w.contact_steps > 200 * 20);
        fl_energy_update(&l.w);
        const fl_ledger *g = &l.w.ledger;
        assert_true(fabs(g->residual) < 1e-4 * g->throughput);
        lab_free(&l);
    }
}

/* Centres separated by one overlap along z: contacts have the same bits at every position in a batch. */
static void contacts_do_not_depend_on_their_batch(void **state)
{
    static fl_sphere_batch a, b;
    (void)state;
    for (int c = 0; c < FL_SPHERE_BATCH; c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        double *const in[] = {&a.d[0][c],
                              &a.d[1][c],
                              &a.d[2][c],
                              &a.u[0][c],
                              &a.u[1][c],
                              &a.u[2][c],
                              &a.wi[0][c],
                              &a.wi[1][c],
                              &a.wi[2][c],
                              &a.wj[0][c],
                              &a.wj[1][c],
                              &a.wj[2][c],
                              &a.spring_force[0][c],
                              &a.spring_force[1][c],
                              &a.spring_force[2][c]};
        for (size_t k = 0; k < sizeof in / sizeof *in; k++)
            *in[k] = c == 5 && k < 3 ? 0.0 : fl_rng_in(&g, -1, 1);
        a.ri[c] = a.rj[c] = fl_rng_in(&g, 1, 2);
        a.k[c] = a.slow_inv_mass[c] = a.friction[c] = a.tangential[c] = a.impact_damping[c] =
            fl_rng_in(&g, 0.2, 1);
        a.max_approach_speed[c] = c % 2 ? 0.3 : 0.0;
        a.spring_stiffness[c] = c % 3 ? 5.0 : 0.0;
    }
    for (int c = 0; c < FL_SPHERE_BATCH; c++) {
        const int to = (7 * c + 3) % FL_SPHERE_BATCH;
        const double *from = &a.d[0][c];
        double *at = &b.d[0][to];
        for (size_t k = 0; k < sizeof a / sizeof a.ri; k++)
            at[k * FL_SPHERE_BATCH] = from[k * FL_SPHERE_BATCH];
    }
    fl_sphere_batch_evaluate(&a, FL_SPHERE_BATCH, 0.01, 0.005);
    fl_sphere_batch_evaluate(&b, FL_SPHERE_BATCH, 0.01, 0.005);
    for (int c = 0; c < FL_SPHERE_BATCH; c++) {
        const int to = (7 * c + 3) % FL_SPHERE_BATCH;
        assert_true(a.normal_damping[c] == b.normal_damping[to] &&
                    a.friction_force[1][c] == b.friction_force[1][to] && a.ti[2][c] == b.ti[2][to]);
        assert_true(isfinite(a.normal_damping[c]) && isfinite(a.friction_force[0][c]) &&
                    isfinite(a.magnitude[c]));
    }
    assert_true(a.n[0][5] == 0.0 && a.n[1][5] == 0.0 && a.n[2][5] == 1.0);
}

/* Chunks that end their step at once, and chunks that wait for contacts of other chunks, by thread. */
static void results_do_not_depend_on_the_shares(void **state)
{
    uint64_t first = 0;
    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        lab l;
        scene_of_spheres(&l, 10, "patch"); /* 1000 bodies: four chunks */
        lab_setf(&l, "run.threads=%d", threads);
        lab_make(&l, 0);
        assert_int_equal(lab_run(&l, 15), 0);
        const fl_sphere_contacts *s = &l.w.spheres;
        assert_int_equal(s->chunks, 4);
        int32_t waited = 0, to = 0;
        for (int t = 0; t < threads; t++) {
            assert_int_equal(fl_sphere_chunk_share(&l.w, t, threads), to);
            to = fl_sphere_chunk_share(&l.w, t + 1, threads);
        }
        assert_int_equal(to, s->chunks);
        for (int32_t a = 0; a < s->chunks; a++) {
            assert_in_range(s->first_source[a], 0, a);
            waited += !s->finished[a];
        }
        if (threads == 1) assert_int_equal(waited, 0);
        else assert_true(waited >= threads - 1);
        const uint64_t bits = bits_of(&l.w);
        if (threads == 1) first = bits;
        assert_true(bits == first);
        lab_free(&l);
    }
}

/* Pairs above one another, the second of the k-th pair k cells away: evaluated as if it were in this cell.
 * The numbers of distinct image shifts are one that fits a byte, and one that does not. */
static void every_periodic_image_matches(void **state)
{
    enum { PAIRS = 300 };
    static fl_vec3 f[2 * PAIRS];
    double largest = 0.0;
    (void)state;
    for (int cells = 0; cells <= PAIRS; cells += PAIRS / 2) {
        lab l;
        lab_start(&l);
        lab_set(&l, "material.ice.young=1 MPa");
        lab_set(&l, "boundary.type=periodic free free");
        lab_set(&l, "boundary.min=0 none none");
        lab_set(&l, "boundary.max=16 none none"); /* cells that add without rounding */
        for (int k = 0; k < PAIRS; k++) {
            const double far = cells ? 16.0 * (k % cells) : 0.0;
            lab_sphere(&l, v3(1, 0, 3.0 * k), 0.5, v3(0.125, 0, 0), v3(0, 0, 0));
            lab_sphere(&l, v3(1.984375 + far, 0, 3.0 * k), 0.5, v3(-0.125, 0, 0), v3(0, 0, 0));
        }
        lab_make(&l, 1e-4);
        assert_int_equal(lab_run(&l, 5), 0);
        const fl_sphere_contacts *s = &l.w.spheres;
        assert_int_equal(s->n, PAIRS);
        assert_int_equal(s->shifts, cells == 0 ? 1 : cells < PAIRS ? cells : 0);
        for (int32_t i = 0; i < l.w.n; i++) {
            fl_vec3 F = v3(0, 0, 0), T = v3(0, 0, 0);
            fl_sphere_add_forces(&l.w, i, &F, &T);
            if (cells == 0) f[i] = F, largest = fmax(largest, v3_norm(F));
            assert_near_of(v3_norm(v3_sub(F, f[i])), 0.0, 1e-9, largest); /* 5000 m of an overlap of 16 mm */
        }
        assert_true(largest > 0.0);
        lab_free(&l);
    }
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    for (long n = 0; n < 1000; n++) {
        lab l;
        fl_err err = {0};
        scene_of_spheres(&l, 4, "patch");
        lab_make(&l, 0);
        l.w.skin *= 2.0, l.w.last_search_step = -1;
        fl_alloc_fail_after(n);
        const int rc = fl_neighbour_list_update(&l.w, &err);
        fl_alloc_fail_after(-1);
        assert_true(rc == 0 || err.code == FL_SYSTEM);
        lab_free(&l);
        if (rc == 0) return;
    }
    fail();
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sphere_pairs_match_general_pairs),
                                       cmocka_unit_test(damping_uses_the_speed_at_the_end),
                                       cmocka_unit_test(predicted_velocities_include_drag),
                                       cmocka_unit_test(wall_contacts_match_general_pairs),
                                       cmocka_unit_test(deep_and_grazing_wall_contacts_match),
                                       cmocka_unit_test(only_hertz_on_rigid_walls_is_fast),
                                       cmocka_unit_test(single_spheres_balance_energy),
                                       cmocka_unit_test(chunk_sums_match_pair_sums),
                                       cmocka_unit_test(contacts_do_not_depend_on_their_batch),
                                       cmocka_unit_test(results_do_not_depend_on_the_shares),
                                       cmocka_unit_test(every_periodic_image_matches),
                                       cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests_name("contact_list", tests, NULL, NULL);
}
