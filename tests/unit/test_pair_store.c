/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A near pair has storage of its own while it touches, and is released soon after. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "law/material.h"
#include "sim/memory_use.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "support/small_world.h"
#include "support/near.h"

/* Two floes that collide and rebound; the first one is at rest. */
static void make_two_floes(lab *l, const char *more)
{
    lab_start(l);
    lab_set(l, "contact.stiffness_factor=0.05");
    if (more) lab_set(l, more);
    lab_box(l, v3(0, 0, 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_box(l, v3(1.02, 0.3, 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(-1, 0, 0), v3(0, 0, 0));
    lab_make(l, 2e-4);
}

static void storage_is_kept_only_while_pairs_touch(void **state)
{
    (void)state;
    lab l;
    make_two_floes(&l, NULL);
    int had = 0, freed = 0;
    for (int k = 0; k < 600; k++) {
        assert_int_equal(lab_run(&l, 1), 0);
        if (l.w.n_pair == 0) break; /* they have separated for good */
        const fl_neighbour_pair *q = &l.w.pair[0];
        if (q->touching) {
            assert_non_null(q->contact);
            assert_int_equal(q->contact->touching, 1);
            assert_int_equal(q->contact->index, 0);
            assert_true(q->contact->energy > 0.0);
            assert_non_null(q->contact->feature_pairs);
            had++;
        } else {
            freed += had && !q->contact;
        }
    }
    assert_true(had > 10);
    assert_true(freed > 0);
    assert_int_equal(l.w.pair_store.blocks, 1);
    int32_t spare = 0;
    for (const fl_pair_slot *s = l.w.pair_store.free; s; s = s->next) spare++;
    assert_int_equal(spare, FL_PAIR_BLOCK);
    lab_free(&l);
}

/* A pair with and without storage of its own gives the same results. */
static void touching_pairs_keep_their_history(void **state)
{
    (void)state;
    lab l;
    fl_pair p, q;
    make_two_floes(&l, NULL);
    lab_run(&l, 3); /* not yet in contact, but evaluated */
    fl_neighbour_pair *near = &l.w.pair[0];
    assert_null(near->contact);
    assert_true(near->has_axis);
    fl_neighbour_pair_expand(&l.w, near, &p);
    assert_int_equal(fl_neighbour_pair_store(&l.w, near, &p), 0);
    assert_null(near->contact);
    fl_neighbour_pair_expand(&l.w, near, &q);
    assert_memory_equal(&p.axis, &q.axis, sizeof p.axis);
    assert_memory_equal(&p.cache, &q.cache, sizeof p.cache);
    assert_true(p.free_travel == q.free_travel && p.k == q.k && p.mass == q.mass && p.law == q.law);
    assert_int_equal(p.has_axis, q.has_axis);
    p.touching = 1, p.overlap = 0.25;
    assert_int_equal(fl_neighbour_pair_store(&l.w, near, &p), 0);
    assert_non_null(near->contact);
    assert_true(near->contact->overlap == 0.25);
    fl_neighbour_pair_free(&l.w, near);
    near->touching = 0;
    lab_free(&l);
}

/* The rolling springs of a sphere on a floe are freed with the storage; they were once leaked with each
 * contact that ended. */
static void rolling_state_is_freed_with_the_contact(void **state)
{
    (void)state;
    lab l;
    lab_start(&l);
    lab_set(&l, "contact.rolling=0.1");
    lab_box(&l, v3(0, 0, 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_sphere(&l, v3(0.799, 0, 0), 0.3, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-5);
    assert_int_equal(lab_run(&l, 1), 0);
    assert_int_equal(l.w.n_pair, 1);
    fl_neighbour_pair *q = &l.w.pair[0];
    fl_pair *p = q->contact;
    assert_non_null(p);
    assert_non_null(p->rolling);
    fl_rolling_spring *roll = p->rolling;
    fl_pair gone = *p;
    gone.touching = 0;
    p->rolling = NULL;
    assert_int_equal(fl_neighbour_pair_store(&l.w, q, &gone), 0);
    if (gone.rolling) free(roll);
    assert_null(q->contact);
    assert_null(gone.rolling);
    lab_free(&l);
}

/* Boxes, capsules and a sphere over a wall, in every order of two. */
static void make_all_kinds(lab *l, double stiffness)
{
    lab_start(l);
    lab_set(l, "boundary.min=none none 0");
    if (stiffness > 0.0) lab_setf(l, "contact.stiffness=%.17g", stiffness);
    lab_box(l, v3(0, 0, 1), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_capsule(l, v3(2, 0, 1), v3(0.3, 0, 0), 0.1);
    lab_sphere(l, v3(4, 0, 1), 0.2, v3(0, 0, 0), v3(0, 0, 0));
    lab_capsule(l, v3(6, 0, 1), v3(0.3, 0, 0), 0.15);
    lab_box(l, v3(8, 0, 1), v3(0.4, 0.3, 0.2), 0.07, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(l, 1e-6);
}

/* The automatic stiffness, given explicitly, gives the same: that of a face, or Hertz' for rounded bodies. */
static void a_given_stiffness_acts_on_all_kinds(void **state)
{
    (void)state;
    lab l, explicit_world;
    make_all_kinds(&l, 0.0);
    const fl_bodies *b = &l.w.b;
    for (int32_t i = 0; i < l.w.n; i++) {
        for (int32_t j = i + 1; j < b->total; j++) {
            const int face = b->core[i].nv > 2 && (j == l.w.n || b->core[j].nv > 2);
            const fl_pair_spring s = fl_pair_stiffness(&l.w, i, j);
            const double k = s.k, E = fl_pair_law_of(&l.w, i, j)->modulus;
            const double area =
                j == l.w.n ? l.w.max_face_area[i] : fmin(l.w.max_face_area[i], l.w.max_face_area[j]);
            const double R = fl_material_radius(b->radius[i], b->radius[j]);
            make_all_kinds(&explicit_world, face ? fl_material_punch(E, area) : fl_material_hertz(E, R));
            const fl_pair_spring given = fl_pair_stiffness(&explicit_world.w, i, j);
            assert_true(fabs(given.k / k - 1.0) < 1e-14);
            assert_true(given.exponent == s.exponent && given.points == s.points);
            lab_free(&explicit_world);
        }
    }
    lab_free(&l);
}

/* kappa s^(3/2), as for a sphere. */
static void a_capsule_on_its_end_is_a_sphere(void **state)
{
    (void)state;
    lab l;
    lab_start(&l);
    lab_set(&l, "boundary.min=none none 0");
    lab_set(&l, "contact.stiffness=1e6");
    lab_capsule(&l, v3(0, 0, 0.399), v3(0, 0, 0.3), 0.1);
    lab_sphere(&l, v3(2, 0, 0.099), 0.1, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-6);
    const double force = 1e6 * pow(1e-3, 1.5);
    assert_true(fabs(l.w.b.f[0].z - force) < 1e-2 * force);
    assert_true(fabs(l.w.b.f[1].z - force) < 1e-9 * force);
    lab_free(&l);
}

static void allocation_failure_ends_the_step(void **state)
{
    (void)state;
    lab l;
    fl_err err = {0};
    make_two_floes(&l, NULL);
    int rc = 0;
    for (int k = 0; k < 600 && rc == 0; k++) {
        const int fail_allocation = l.w.n_pair && !l.w.pair[0].contact;
        if (fail_allocation) fl_alloc_fail_after(0);
        rc = fl_step(&l.w, &err);
        fl_alloc_fail_after(-1);
    }
    assert_int_equal(rc, -1);
    assert_int_equal(err.code, FL_SYSTEM);
    lab_free(&l);
}

/* Allocation failure at any point of an impact, part of which a surrogate evaluates. */
static void allocation_failure_with_a_surrogate_is_reported(void **state)
{
    (void)state;
    int rc = -1;
    long after = 0;
    for (; rc; after++) {
        lab l;
        fl_err err = {0};
        make_two_floes(&l, "contact.surrogate=0.01");
        lab_run(&l, 3);
        assert_null(l.w.pair[0].contact);
        rc = 0;
        fl_alloc_fail_after(after);
        for (int k = 0; k < 600 && rc == 0; k++) rc = fl_step(&l.w, &err);
        assert_int_equal(fl_alloc_refused() > 0, rc == -1);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : FL_DONE);
        if (rc == 0) assert_true(fl_surrogate_count_sum(l.w.surrogate_counts, 1).hits > 10);
        lab_free(&l);
    }
    assert_true(after > 3);
}

/* Twice as many bodies take as much memory again, within bounds given by a core and its arrays. */
static void memory_use_follows_the_bodies(void **state)
{
    (void)state;
    double all[2];
    for (int c = 0; c < 2; c++) {
        lab l;
        lab_start(&l);
        for (int k = 0; k < 64 + 64 * c; k++)
            lab_box(&l, v3(5.0 * k, 0, 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, 2e-4);
        const fl_memory_use b = fl_memory_use_of(&l.w);
        all[c] = fl_memory_use_sum(&b);
        assert_true(b.pairs + b.feature_pairs == 0.0);
        assert_true(b.bodies / l.w.n > 300.0 && b.shapes / l.w.n > 350.0);
        lab_free(&l);
    }
    assert_true(all[1] - all[0] > 64 * 700.0 && all[1] - all[0] < 64 * 1400.0);
}

/* `core` finds no closest pair there: the tip of an arrow meets the side of a box, none of the corners of
 * which is close. */
static void non_convex_parts_use_law_patch(void **state)
{
    static const char *const law[] = {"contact.law=patch", "contact.law=core", "contact.law=manual-si"};
    const fl_vec3 arrow[] = {{0, 0, 0}, {3, -1, 0}, {2, 0, 0}, {3, 1, 0}};
    fl_vec3 f[3];
    (void)state;
    for (int k = 0; k < 3; k++) {
        lab l;
        lab_start(&l);
        lab_set(&l, law[k]);
        lab_prism(&l, 4, arrow, -2.0, 2.0);
        lab_box(&l, v3(-0.49, 0, 0), v3(0.5, 0.8, 0.3), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, 1e-6);
        const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
        assert_int_equal(p.touching, 1);
        assert_true(p.points == FL_POINTS_PATCH && p.force.x < 0.0);
        f[k] = p.force;
        lab_free(&l);
    }
    assert_true(v3_norm(v3_sub(f[1], f[0])) == 0.0 && v3_norm(v3_sub(f[2], f[0])) == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(non_convex_parts_use_law_patch),
                                       cmocka_unit_test(storage_is_kept_only_while_pairs_touch),
                                       cmocka_unit_test(touching_pairs_keep_their_history),
                                       cmocka_unit_test(rolling_state_is_freed_with_the_contact),
                                       cmocka_unit_test(a_given_stiffness_acts_on_all_kinds),
                                       cmocka_unit_test(a_capsule_on_its_end_is_a_sphere),
                                       cmocka_unit_test(allocation_failure_with_a_surrogate_is_reported),
                                       cmocka_unit_test(allocation_failure_ends_the_step),
                                       cmocka_unit_test(memory_use_follows_the_bodies)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
