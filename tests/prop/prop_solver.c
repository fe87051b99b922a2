/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Invariants of the whole solver on heaps of random bodies: bits that depend neither on threads nor on the
 * neighbour search, conservation of momentum, and motion that does not depend on the order of bodies, the
 * origin or a reflection. */
#include <math.h>
#include <stdlib.h>
#include "sim/energy_balance.h"
#include "support/near.h"
#include "base/rng.h"
#include "support/small_world.h"
#include "support/shapes.h"

/* Parameters of a heap. */
typedef struct {
    int32_t side;     /* bodies along an edge of the heap */
    int32_t threads;  /* 0: 1                                               */
    int32_t every;    /* steps between searches; 0: when the skin is used up */
    double skin;      /* factor on it; 0: 1                                 */
    int reversed;     /* reverse order of bodies */
    int walled;       /* gravity, rigid walls, a structure                  */
    const char *law;  /* NULL: patch */
    double dissipate; /* friction, and 1 - restitution                      */
    double squeeze;   /* spacing of the bodies over their size */
    fl_vec3 shift;    /* offset of everything [m] */
} heap;

static void add_body(lab *l, const heap *h, uint64_t seed, int32_t k)
{
    fl_rng g = fl_rng_of(seed, k, FL_RNG_TEST);
    fl_err err = {0};
    fl_poly p = {0};
    const int32_t n = h->side;
    const double middle = 0.5 * (n - 1), r = k % 5 == 0 ? 0.45 : 0.05;
    const fl_vec3 cell = v3(k % n - middle, k / n % n - middle, k / (n * n) - middle);
    fl_vec3 v, w, turn;
    v.x = fl_rng_normal(&g), v.y = fl_rng_normal(&g), v.z = fl_rng_normal(&g);
    w.x = fl_rng_normal(&g), w.y = fl_rng_normal(&g), w.z = fl_rng_normal(&g);
    turn.x = fl_rng_normal(&g), turn.y = fl_rng_normal(&g), turn.z = fl_rng_normal(&g);
    switch (k % 5) {
    case 0: assert_int_equal(fl_poly_make(&p, 1, &(fl_vec3){0, 0, 0}, 0, NULL, NULL, &err), 0); break;
    case 1: {
        const fl_vec3 end[2] = {v3(-0.4, 0, 0), v3(0.4, 0, 0)};
        assert_int_equal(fl_poly_make(&p, 2, end, 0, NULL, NULL, &err), 0);
        break;
    }
    case 2: shape_regular(&p, 8, 0.5); break;
    default: {
        const double a = fl_rng_in(&g, 0.3, 0.4), b = fl_rng_in(&g, 0.3, 0.4);
        assert_int_equal(fl_poly_box(&p, v3(a, b, 0.4), &err), 0);
    }
    }
    shape_move(&p, q_of_vector(v3_scale(0.05, turn)), v3_add(h->shift, v3_scale(h->squeeze, cell)));
    /* inward, so that all of them collide soon */
    lab_poly(l, &p, r, v3_add(v3_scale(0.3, v), v3_scale(-0.3, cell)), v3_scale(0.3, w));
}

static void make_heap(lab *l, const heap *h, uint64_t seed)
{
    const int32_t n = h->side * h->side * h->side;
    const double half = 0.5 * h->side * h->squeeze + 0.05;
    lab_start(l);
    lab_set(l, "material.ice.young=1 MPa");
    lab_setf(l, "run.threads=%d", h->threads > 0 ? h->threads : 1);
    if (h->every > 0) lab_setf(l, "run.search_every=%d", h->every);
    if (h->law) lab_setf(l, "contact.law=%s", h->law);
    lab_setf(l, "contact.friction=%.17g", h->dissipate);
    lab_setf(l, "contact.restitution=%.17g", 1.0 - h->dissipate);
    if (h->walled) {
        lab_set(l, "run.gravity=9.81");
        lab_setf(l, "boundary.min=%.17g %.17g %.17g", h->shift.x - half, h->shift.y - half,
                 h->shift.z - half);
        lab_setf(l, "boundary.max=%.17g %.17g none", h->shift.x + half, h->shift.y + half);
        lab_wall(l, v3_add(h->shift, v3(-0.3, -0.3, half)), v3_add(h->shift, v3(0.3, 0.3, half + 1.0)), 2);
    }
    for (int32_t k = 0; k < n; k++) add_body(l, h, seed, h->reversed ? n - 1 - k : k);
    lab_make(l, 0);
    if (h->skin > 0.0) {
        l->w.skin *= h->skin;
        l->w.last_search_step = -1; /* the present list belongs to the old skin */
    }
}

static uint64_t hash_after(const heap *h, uint64_t seed, int64_t steps, int64_t *touching, int64_t *searches)
{
    lab l;
    make_heap(&l, h, seed);
    assert_int_equal(lab_run(&l, steps), 0);
    const uint64_t hash = fl_state_hash(&l.w);
    *touching = l.w.contact_steps;
    *searches = l.w.searches;
    if (h->threads > 1) assert_int_equal(l.w.threads, h->threads);
    lab_free(&l);
    return hash;
}

static void threads_give_the_same_bits(void **state)
{
    const int32_t threads[] = {1, 2, 3, 8};
    (void)state;
    for (long c = 0; c < test_times(1); c++) {
        uint64_t hash = 0;
        int64_t touching = 0, first = 0, searches = 0;
        for (int k = 0; k < 4; k++) {
            const heap h = {.side = 7, .threads = threads[k], .walled = 1, .dissipate = 0.4, .squeeze = 1.0};
            const uint64_t got = hash_after(&h, test_seed() + (uint64_t)c, 150, &touching, &searches);
            if (k == 0) hash = got, first = touching;
            if (got != hash)
                print_error("seed %llu case %ld threads %d\n", (unsigned long long)test_seed(), c,
                            threads[k]);
            assert_true(got == hash);
            assert_true(touching == first);
        }
        assert_true(first > 5000); /* touching pairs, summed over steps */
    }
}

static void the_search_does_not_matter(void **state)
{
    const struct {
        double skin;
        int32_t every;
    } way[] = {{1, 0}, {0.05, 0}, {4, 0}, {1, 1}, {1, 7}, {0.3, 13}};
    static const char *const LAW[] = {"patch", "core", "manual", "manual-si"};
    (void)state;
    for (long c = 0; c < test_times(4); c++) {
        uint64_t hash = 0;
        int64_t touching = 0, first = 0, searches = 0, fewest = INT64_MAX, most = 0;
        for (int k = 0; k < 6; k++) {
            const heap h = {.side = 4,
                            .law = LAW[c % 4],
                            .every = way[k].every,
                            .skin = way[k].skin,
                            .walled = 1,
                            .dissipate = 0.4,
                            .squeeze = 1.0};
            const uint64_t got = hash_after(&h, test_seed() + (uint64_t)c, 600, &touching, &searches);
            if (k == 0) hash = got, first = touching;
            if (got != hash)
                print_error("seed %llu case %ld skin %g every %d\n", (unsigned long long)test_seed(), c,
                            way[k].skin, way[k].every);
            assert_true(got == hash);
            assert_true(touching == first);
            fewest = searches < fewest ? searches : fewest;
            most = searches > most ? searches : most;
        }
        assert_true(fewest < 20 && most > 600);
        assert_true(first > 5000);
    }
}

/* A sphere moves down onto the highest line of a thick pole, which protrudes from its polygon. */
static uint64_t hash_on_pole(int64_t seed, int every)
{
    fl_rng g = fl_rng_of(test_seed(), seed, FL_RNG_TEST);
    const double thick = fl_rng_in(&g, 20, 150), turn = fl_rng_in(&g, 0, 6.3);
    const fl_vec3 a = v3(cos(turn), sin(turn), 0), up = v3(0, 0, 1);
    lab l;
    lab_start(&l);
    lab_set(&l, "material.ice.young=1e7");
    if (every) lab_setf(&l, "run.search_every=%d", every);
    lab_sphere(&l, v3_scale(thick + 0.05 + 0.063, up), 0.05, v3_scale(-1.0, up), v3(1, 2, 3));
    lab_cone(&l, (fl_cone){v3_scale(-200, a), v3_scale(200, a), thick, thick});
    lab_make(&l, 2e-4);
    lab_pose(&l.w, 1, l.w.b.x[1], q_mul(l.w.b.q[1], q_about_axis(2, fl_rng_in(&g, 0.0, 0.1))));
    l.w.last_search_step = -1;
    assert_int_equal(lab_run(&l, 500), 0);
    const uint64_t hash = fl_state_hash(&l.w);
    assert_true(l.w.contact_steps > 0 && l.w.deep_overlap_steps == 0);
    lab_free(&l);
    return hash;
}

/* Boxes move about an open sheet of two walls; some of them intersect it at the start. */
static uint64_t hash_about_sheet(int64_t seed, int every)
{
    static const int32_t TRIANGLE[4][3] = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    static const fl_vec3 V[6] = {{-1.5, 0, -1.5}, {0, 0, -1.5},    {0, 0, 1.5},
                                 {-1.5, 0, 1.5},  {0, -1.5, -1.5}, {0, -1.5, 1.5}};
    fl_rng g = fl_rng_of(test_seed(), seed, FL_RNG_TEST);
    fl_err err = {0};
    lab l;
    lab_start(&l);
    lab_set(&l, "material.ice.young=1e6");
    if (every) lab_setf(&l, "run.search_every=%d", every);
    for (int k = 0; k < 6; k++) {
        const fl_vec3 x = v3(fl_rng_in(&g, -1.2, 0.3), fl_rng_in(&g, -1.2, 0.4), 1.0 * k - 2.5),
                      v = v3(fl_rng_in(&g, -5, 5), fl_rng_in(&g, -5, 5), 0),
                      spin = v3(fl_rng_in(&g, -9, 9), fl_rng_in(&g, -9, 9), fl_rng_in(&g, -9, 9));
        lab_box(&l, x, v3(0.3, 0.25, 0.2), 0.05, q_of_vector(v3_scale(0.3, spin)), v, spin);
    }
    assert_true(fl_surface_add(&l.surface, "sheet", 5, &err) == 0);
    for (int k = 0; k < 6; k++) assert_int_equal(fl_surface_vertex(&l.surface.part[0], V[k], &err), 0);
    for (int k = 0; k < 4; k++)
        assert_int_equal(
            fl_surface_triangle(&l.surface.part[0], TRIANGLE[k][0], TRIANGLE[k][1], TRIANGLE[k][2], &err), 0);
    lab_make(&l, 5e-5);
    const int rc = lab_run(&l, 2000);
    const uint64_t hash = fl_state_hash(&l.w) + (uint64_t)rc;
    lab_free(&l);
    return hash;
}

static void the_search_does_not_matter_near_structures(void **state)
{
    (void)state;
    for (int64_t seed = 0; seed < 60; seed++) {
        const uint64_t pole = hash_on_pole(seed, 0), sheet = hash_about_sheet(seed, 0);
        for (int every = 1; every < 8; every += 6) {
            assert_true(hash_on_pole(seed, every) == pole);
            assert_true(hash_about_sheet(seed, every) == sheet);
        }
    }
}

static void momenta_are_conserved(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(3); c++) {
        const heap h = {.side = 4, .dissipate = c % 2 ? 0.5 : 0.0, .squeeze = 1.0};
        lab l;
        make_heap(&l, &h, test_seed() + (uint64_t)c);
        fl_vec3 p[2], J[2];
        double ps = 0.0, Js = 0.0;
        for (int t = 0; t < 2; t++) {
            const fl_bodies *b = &l.w.b;
            p[t] = J[t] = v3(0, 0, 0);
            for (int32_t i = 0; i < b->n; i++) {
                const fl_vec3 mv = v3_scale(b->m[i], b->v[i]), orbit = v3_cross(b->x[i], mv);
                p[t] = v3_add(p[t], mv);
                J[t] = v3_add(J[t], v3_add(orbit, b->L[i]));
                ps += v3_norm(mv);
                Js += v3_norm(orbit) + v3_norm(b->L[i]);
            }
            if (t == 0) assert_int_equal(lab_run(&l, 1000), 0);
        }
        assert_true(l.w.contact_steps > 5000);
        assert_near_of(v3_norm(v3_sub(p[1], p[0])), 0.0, 1e-12, ps);
        assert_near_of(v3_norm(v3_sub(J[1], J[0])), 0.0, 1e-12, Js);
        assert_near_of(v3_norm(l.w.imbalance), 0.0, 1e-13, l.w.impulse_sum);
        lab_free(&l);
    }
}

/* Other orders of sums, other roles in each pair: the same motion up to the growth of rounding. */
static void the_order_of_bodies_does_not_matter(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(3); c++) {
        lab l[2];
        for (int k = 0; k < 2; k++) {
            const heap h = {.side = 4, .reversed = k, .walled = 1, .dissipate = 0.4, .squeeze = 1.0};
            make_heap(&l[k], &h, test_seed() + (uint64_t)c);
            assert_int_equal(lab_run(&l[k], 500), 0);
        }
        const int32_t n = l[0].w.n;
        double x = 0.0, v = 0.0;
        for (int32_t i = 0; i < n; i++) {
            const fl_bodies *a = &l[0].w.b, *b = &l[1].w.b;
            x = fmax(x, v3_norm(v3_sub(a->x[i], b->x[n - 1 - i])));
            v = fmax(v, v3_norm(v3_sub(a->v[i], b->v[n - 1 - i])));
        }
        assert_true(l[0].w.contact_steps > 1000);
        assert_near_of(x, 0.0, 1e-9, 1.0); /* bodies of 1 m at 1 m/s */
        assert_near_of(v, 0.0, 1e-9, 1.0);
        lab_free(&l[0]);
        lab_free(&l[1]);
    }
}

/* H20: all of it a thousand kilometres away. */
static void the_origin_does_not_matter(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(5); c++) {
        lab l[2];
        for (int k = 0; k < 2; k++) {
            const heap h = {.side = 4,
                            .walled = 1,
                            .dissipate = 0.4,
                            .squeeze = 0.95,
                            .shift = k ? v3(1e6, -1e6, 1e6) : v3(0, 0, 0)};
            make_heap(&l[k], &h, test_seed() + (uint64_t)c);
        }
        assert_int_equal(l[0].w.b.total, l[1].w.b.total);
        double largest = 0.0, worst = 0.0;
        for (int32_t i = 0; i < l[0].w.b.total; i++) {
            const fl_bodies *a = &l[0].w.b, *b = &l[1].w.b;
            largest = fmax(largest, v3_norm(a->f[i]));
            worst = fmax(worst, v3_norm(v3_sub(a->f[i], b->f[i])));
            if (i < l[0].w.n) worst = fmax(worst, v3_norm(v3_sub(a->t[i], b->t[i]))); /* arms are 1 m */
        }
        assert_true(largest > 1000.0);
        assert_near_of(worst, 0.0, 1e-7, largest);
        lab_free(&l[0]);
        lab_free(&l[1]);
    }
}

/* Two boxes collide face to face with rotation, and the same scene reflected, x for -x, where other corners
 * come first and other points represent the faces. */
static void a_reflection_changes_nothing(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(30); c++) {
        fl_vec3 v[2][2], w[2][2];
        int64_t touching = 0;
        for (int k = 0; k < 2; k++) {
            fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
            const double m = k ? -1.0 : 1.0;
            lab l;
            lab_start(&l);
            lab_set(&l, "contact.friction=0.3");
            lab_set(&l, "contact.restitution=0.3");
            for (int i = 0; i < 2; i++) {
                const fl_vec3 half = v3(fl_rng_in(&g, 0.5, 1.5), fl_rng_in(&g, 0.5, 1.5), 0.5);
                const fl_vec3 at = v3(fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 0.3), i ? 1.0005 : 0.0);
                const fl_vec3 turn =
                    v3(0.002 * fl_rng_normal(&g), 0.002 * fl_rng_normal(&g), fl_rng_normal(&g));
                const fl_vec3 go = v3(0.1 * fl_rng_normal(&g), 0.1 * fl_rng_normal(&g), i ? -0.3 : 0.3);
                const fl_vec3 spin = v3(0.5 * fl_rng_normal(&g), 0.5 * fl_rng_normal(&g), fl_rng_normal(&g));
                lab_box(&l, v3(m * at.x, at.y, at.z), half, 0.05,
                        q_of_vector(v3(turn.x, m * turn.y, m * turn.z)), v3(m * go.x, go.y, go.z),
                        v3(spin.x, m * spin.y, m * spin.z));
            }
            lab_make(&l, 1e-5);
            assert_int_equal(lab_run(&l, 1500), 0);
            for (int i = 0; i < 2; i++) {
                v[k][i] = l.w.b.v[i], w[k][i] = l.w.b.w[i];
                v[k][i].x *= m, w[k][i].y *= m, w[k][i].z *= m;
            }
            touching += l.w.contact_steps;
            lab_free(&l);
        }
        assert_true(touching > 100);
        for (int i = 0; i < 2; i++) {
            if (v3_norm(v3_sub(v[0][i], v[1][i])) > 1e-7)
                print_error("seed %llu case %ld\n", (unsigned long long)test_seed(), c);
            assert_near_of(v3_norm(v3_sub(v[0][i], v[1][i])), 0.0, 1e-7, 1.0);
            assert_near_of(v3_norm(v3_sub(w[0][i], w[1][i])), 0.0, 1e-7, 1.0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_give_the_same_bits),
        cmocka_unit_test(the_search_does_not_matter),
        cmocka_unit_test(the_search_does_not_matter_near_structures),
        cmocka_unit_test(momenta_are_conserved),
        cmocka_unit_test(the_order_of_bodies_does_not_matter),
        cmocka_unit_test(the_origin_does_not_matter),
        cmocka_unit_test(a_reflection_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
