/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stop and resume: a world restored from its snapshot makes the same steps as the one that never stopped. */
#define _GNU_SOURCE /* open_memstream */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "sim/energy_balance.h"
#include "support/near.h"
#include "base/rng.h"
#include "contact/bond_list.h"
#include "contact/joint_list.h"
#include "sphere/contact_list.h"
#include "sim/snapshot.h"
#include "sim/stage.h"
#include "sim/step.h"
#include "support/scenes.h"
#include "world/access.h"

static char *snapshot(fl_world *w, size_t *n)
{
    char *text = NULL;
    FILE *f = open_memstream(&text, n);
    assert_non_null(f);
    fl_snapshot_write(f, w);
    assert_int_equal(fclose(f), 0);
    return text;
}

static int restore(fl_world *w, const char *text, size_t n, fl_err *err)
{
    fl_text in = {0};
    assert_int_equal(fl_text_open_bytes(&in, "snapshot", text, (int64_t)n, err), 0);
    const int rc = fl_snapshot_read(w, &in, err);
    fl_text_close(&in);
    return rc;
}

/* Water forces, which enter the next half step, are the same in both. */
static void same_water_forces(const fl_world *a, const fl_world *b)
{
    for (int32_t i = 0; i < a->sea.n; i++) {
        if (fl_body_absent(a, i) || !a->sea.water) continue;
        const fl_vec3 all[2][2] = {{fl_environment_water_force(&a->sea, i), fl_environment_flow(&a->sea, i)},
                                   {fl_environment_water_force(&b->sea, i), fl_environment_flow(&b->sea, i)}};
        assert_memory_equal(all[0], all[1], sizeof all[0]);
        if (a->sea.waves)
            assert_memory_equal(&a->sea.water_moment[i], &b->sea.water_moment[i],
                                sizeof *a->sea.water_moment);
    }
}

/* All stored state, with ledger and history, is the same in both. */
static void same_state(fl_world *a, fl_world *b, const char *law, int64_t at)
{
    size_t na = 0, nb = 0;
    fl_energy_update(a);
    fl_energy_update(b);
    char *ta = snapshot(a, &na), *tb = snapshot(b, &nb);
    if (na != nb || memcmp(ta, tb, na) != 0)
        print_error("law %s, stopped after %lld steps\n", law, (long long)at);
    assert_int_equal(na, nb);
    assert_memory_equal(ta, tb, na);
    assert_true(fl_state_hash(a) == fl_state_hash(b));
    same_water_forces(a, b);
    free(ta);
    free(tb);
}

static void a_run_resumes_at_any_step(void **state)
{
    static const struct {
        void (*scene)(lab *l, int32_t side, const char *law);
        const char *law;
    } IT[] = {{scene_of_everything, "patch"},      {scene_of_everything, "core"},
              {scene_of_everything, "manual"},     {scene_of_everything, "manual-si"},
              {scene_of_everything, "quick"},      {scene_of_bonds, "quick"},
              {scene_of_periodic_cell, "patch"},   {scene_of_seas, "patch"},
              {scene_of_spheres, "patch"},         {scene_of_inflow, "patch"},
              {scene_of_bonds, "patch"},           {scene_of_sheet, "patch"},
              {scene_of_water_interval, "patch"},  {scene_of_sea_interval, "patch"},
              {scene_of_inflow_interval, "patch"}, {scene_of_surrogates, "patch"},
              {scene_of_surrogates, "quick"},      {scene_of_joined_parts, "patch"},
              {scene_of_endless_sheet, "patch"},   {scene_of_joints, "patch"},
              {scene_of_failing_floes, "patch"},   {scene_of_failing_floes, "quick"}};
    (void)state;
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++) {
        lab whole;
        int64_t pairs = 0;
        IT[k].scene(&whole, 3, IT[k].law);
        lab_make(&whole, 0);
        for (int64_t at = 0; at < 300; at += 1 + at / 8) {
            /* from here on in a second, new world and in the first one */
            lab l;
            fl_err err = {0};
            size_t n = 0;
            IT[k].scene(&l, 3, IT[k].law);
            lab_set(&l, "run.threads=2");
            lab_make(&l, 0);
            while (whole.w.step < at) assert_int_equal(lab_run(&whole, 1), 0);
            char *text = snapshot(&whole.w, &n);
            assert_int_equal(restore(&l.w, text, n, &err), 0);
            free(text);
            same_state(&whole.w, &l.w, IT[k].law, at);
            const int64_t further = 1 + at % 40;
            assert_int_equal(lab_run(&whole, further), 0);
            assert_int_equal(lab_run(&l, further), 0);
            same_state(&whole.w, &l.w, IT[k].law, at);
            pairs = whole.w.contact_steps;
            lab_free(&l);
        }
        if (IT[k].scene == scene_of_sheet ||
            IT[k].scene == scene_of_endless_sheet) { /* a sheet has contacts where bonds have ended alone */
            const fl_bond_counts n = fl_bond_list_counts(&whole.w);
            assert_true(n.state[FL_BOND_ENDED] > 20 && n.state[FL_BOND_DAMAGED] > 2);
        } else if (IT[k].scene == scene_of_joints) {
            const fl_joint_counts n = fl_joint_list_counts(&whole.w);
            assert_true(n.slip + n.open > 10);
        } else if (IT[k].scene == scene_of_failing_floes) {
            assert_true(whole.w.crushing.contact_steps > 20 && whole.w.breaking.bent > 1 &&
                        whole.w.breaking.bent + whole.w.breaking.split > 9);
        } else assert_true(pairs > 3000 && whole.w.searches >= 2);
        lab_free(&whole);
    }
}

/* A step of a run with stages; returns 1 if it has settled behind the last one. */
static int stage_step(lab *l)
{
    fl_err err = {0};
    const int settled = fl_stage_update(&l->w, l->field.group, (const char *const *)l->field.groups.name,
                                        l->field.groups.n, &err);
    assert_true(settled >= 0);
    assert_int_equal(lab_run(l, 1), 0);
    return settled;
}

static void stage_scene(lab *l, const char *relax, const char *zones, int threads)
{
    scene_of_stages(l, 2, "patch");
    lab_setf(l, "run.threads=%d", threads);
    lab_setf(l, "run.relax=%s", relax);
    l->scene.run.relax_until = 100.0; /* settled at each look */
    if (strcmp(relax, "none") == 0) lab_set(l, "stage.a.start=0.01"), lab_set(l, "stage.c.start=0.03");
    if (zones) {
        lab_set(l, "zones.size=0.5"), lab_setf(l, "zones.law=%s", zones);
        lab_setf(l, "zones.group=%s", strcmp(zones, "elastic") ? "none" : "soft");
        lab_set(l, "zones.max_side=free free quiet");
        lab_set(l, "material.ice.cohesion=5e3"), lab_set(l, "material.ice.friction_angle=30");
    }
    lab_make(l, 0);
}

/* With stages that go on after the stop, and with each damping. */
static void stages_resume_at_any_step(void **state)
{
    static const char *const RELAX[] = {"none", "local", "kinetic", "adaptive"}, *const ZONES[] = {
                                                                                     NULL, "elastic",
                                                                                     "mohr-coulomb"};
    (void)state;
    for (int k = 0; k < 12; k++) {
        lab whole;
        int settled = 0;
        stage_scene(&whole, RELAX[k / 3], ZONES[k % 3], 1);
        for (int64_t at = 0; at < 260; at += 5) {
            lab l;
            fl_err err = {0};
            size_t n = 0;
            while (whole.w.step < at) settled |= stage_step(&whole);
            stage_scene(&l, RELAX[k / 3], ZONES[k % 3], 2);
            char *text = snapshot(&whole.w, &n);
            assert_int_equal(restore(&l.w, text, n, &err), 0);
            free(text);
            same_state(&whole.w, &l.w, RELAX[k / 3], at);
            for (int64_t e = 0; e < 1 + at % 4; e++) {
                const int now = stage_step(&whole);
                assert_int_equal(now, stage_step(&l));
                settled |= now;
            }
            same_state(&whole.w, &l.w, RELAX[k / 3], at);
            lab_free(&l);
        }
        while (whole.w.step < 300) settled |= stage_step(&whole);
        assert_int_equal(whole.w.next_stage, 3);
        assert_int_equal(whole.w.inflow.n_left, 2);
        assert_int_equal(settled, k >= 3);
        lab_free(&whole);
    }
}

/* Three boxes drift along a wall that is not convex, and sleep where nothing is near. */
static void beside_a_hook(lab *l, int64_t seed)
{
    const fl_vec3 hook[6] = {v3(-3, -0.5, 0), v3(3, -0.5, 0), v3(3, 2, 0),
                             v3(2.5, 2, 0),   v3(2.5, 0, 0),  v3(-3, 0, 0)};
    fl_rng g = fl_rng_of(test_seed(), seed, FL_RNG_TEST);
    const double fast = pow(10.0, fl_rng_in(&g, -2.0, -0.5));
    lab_start(l);
    lab_set(l, "run.sleep=1e-3");
    lab_set(l, "material.ice.young=1e6");
    lab_set(l, "contact.restitution=0.5");
    lab_prism(l, 6, hook, -1, 1);
    for (int k = 0; k < 3; k++) {
        const fl_vec3 x = v3(-2.0 + 1.5 * k, fl_rng_in(&g, 0.52, 0.6), 0);
        const fl_quat q = q_about_axis(2, fl_rng_in(&g, -0.03, 0.03));
        const fl_vec3 v = v3(fl_rng_in(&g, -0.3, 0.3), fl_rng_in(&g, -0.3, 1.0), fl_rng_in(&g, -0.2, 0.2));
        lab_box(l, x, v3(0.5, 0.5, 0.3), 0.05, q, v3_scale(fast, v),
                v3(0, 0, fast * fl_rng_in(&g, -0.1, 0.1)));
    }
    lab_make(l, 0);
}

/* An old neighbour list and a new one give the same results. */
static void results_do_not_depend_on_the_age_of_lists(void **state)
{
    (void)state;
    for (int64_t seed = 0; seed < 6; seed++) {
        lab whole;
        beside_a_hook(&whole, seed);
        for (int k = 0; k < 8; k++) {
            lab l;
            fl_err err = {0};
            size_t n = 0;
            assert_int_equal(lab_run(&whole, 13), 0);
            beside_a_hook(&l, seed);
            char *text = snapshot(&whole.w, &n);
            assert_int_equal(restore(&l.w, text, n, &err), 0);
            free(text);
            assert_int_equal(lab_run(&whole, 400), 0);
            assert_int_equal(lab_run(&l, 400), 0);
            same_state(&whole.w, &l.w, "patch", whole.w.step - 400);
            lab_free(&l);
        }
        lab_free(&whole);
    }
}

static void make_guided_with_surrogates(lab *l)
{
    scene_of_inflow(l, 3, "patch");
    lab_set(l, "contact.surrogate=0.01");
    lab_make(l, 0);
}

/* True if the last step released a floe that has a contact by surrogate; was: floes that were guided
 * before. */
static int was_released(const fl_world *w, const uint8_t *was)
{
    for (int64_t c = 0; c < w->n_pair; c++) {
        const fl_neighbour_pair *q = &w->pair[c];
        if (!q->touching || !q->contact->surrogate || !q->contact->surrogate->valid) continue;
        for (int side = 0; side < 2; side++) {
            const int32_t i = side ? q->j : q->i;
            if (i < w->n && was[i] && !w->inflow.guided[i] && !w->inflow.absent[i]) return 1;
        }
    }
    return 0;
}

/* The surrogate of a contact does not depend on the constraint of the floe when it was evaluated. */
static void released_floes_keep_their_surrogates(void **state)
{
    int found = 0;
    char *before = NULL;
    size_t n_before = 0;
    lab whole;
    (void)state;
    make_guided_with_surrogates(&whole);
    uint8_t *const was = malloc((size_t)whole.w.n);
    assert_non_null(was);
    for (int k = 0; k < 1300; k++) {
        memcpy(was, whole.w.inflow.guided, (size_t)whole.w.n);
        free(before);
        before = snapshot(&whole.w, &n_before);
        assert_int_equal(lab_run(&whole, 1), 0);
        if (!was_released(&whole.w, was)) continue;
        lab l;
        fl_err err = {0};
        size_t n = 0;
        make_guided_with_surrogates(&l);
        char *text = snapshot(&whole.w, &n);
        if (found % 2)
            assert_int_equal(restore(&l.w, before, n_before, &err), 0); /* as in trials of the step search */
        assert_int_equal(restore(&l.w, text, n, &err), 0);
        free(text);
        assert_int_equal(lab_run(&whole, 3), 0);
        assert_int_equal(lab_run(&l, 3), 0);
        same_state(&whole.w, &l.w, "patch", whole.w.step - 3);
        lab_free(&l);
        found++;
    }
    assert_true(found >= 3);
    free(was), free(before);
    lab_free(&whole);
}

/* A state that is read and written again is the same, also with pairs that have just separated; and one
 * step later. */
static void a_state_reads_back_unchanged(void **state)
{
    void (*const SCENE[])(lab * l, int32_t side, const char *law) = {
        scene_of_everything, scene_of_periodic_cell, scene_of_surrogates, scene_of_seas};
    (void)state;
    for (size_t k = 0; k < sizeof SCENE / sizeof *SCENE; k++) {
        lab whole;
        int64_t loose = 0;
        SCENE[k](&whole, 3, "patch");
        lab_make(&whole, 0);
        assert_int_equal(lab_run(&whole, 60), 0);
        for (int step = 0; step < 60; step++) {
            lab l;
            fl_err err = {0};
            size_t n = 0;
            int now = 0;
            assert_int_equal(lab_run(&whole, 1), 0);
            for (int32_t c = 0; c < whole.w.n_pair; c++)
                now += whole.w.pair[c].contact && !whole.w.pair[c].touching;
            if (now == 0) continue;
            loose += now;
            SCENE[k](&l, 3, "patch");
            lab_make(&l, 0);
            char *text = snapshot(&whole.w, &n);
            assert_int_equal(restore(&l.w, text, n, &err), 0);
            free(text);
            same_state(&whole.w, &l.w, "patch", whole.w.step);
            assert_int_equal(lab_run(&whole, 1), 0);
            assert_int_equal(lab_run(&l, 1), 0);
            same_state(&whole.w, &l.w, "patch", whole.w.step);
            lab_free(&l);
        }
        assert_true(loose > 10);
        lab_free(&whole);
    }
}

/* The step search of the error budget starts a step exactly at the time of its row, which differs by
 * rounding from the sum of the steps before; water was evaluated at the latter. */
static void a_repeated_step_has_the_same_water(void **state)
{
    void (*const SCENE[])(lab * l, int32_t side, const char *law) = {scene_of_seas, scene_of_sea_interval};
    (void)state;
    for (size_t k = 0; k < sizeof SCENE / sizeof *SCENE; k++)
        for (int64_t at = 1; at < 10; at++) {
            lab whole, l;
            fl_err err = {0};
            size_t n = 0;
            SCENE[k](&whole, 2, "patch");
            lab_make(&whole, 0);
            assert_int_equal(lab_run(&whole, at), 0);
            fl_step_set_size(&whole.w, whole.w.dt, fl_world_time(&whole.w) * (1.0 + 1e-14));
            char *text = snapshot(&whole.w, &n);
            SCENE[k](&l, 2, "patch");
            lab_make(&l, 0);
            assert_int_equal(restore(&l.w, text, n, &err), 0);
            free(text);
            same_state(&whole.w, &l.w, "patch", at);
            assert_int_equal(lab_run(&whole, 9), 0);
            assert_int_equal(lab_run(&l, 9), 0);
            same_state(&whole.w, &l.w, "patch", at);
            lab_free(&whole);
            lab_free(&l);
        }
}

/* Two spheres that collide and separate, or start apart, and a floe, all in water. */
static void spheres_that_separate(lab *l, double x)
{
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.level=-0.3"); /* nearly neutral buoyancy, so that f - m g - buoyancy is rounded */
    lab_set(l, "water.current=0.3 0.1 0");
    lab_set(l, "material.ice.young=1e6");
    lab_sphere(l, v3(-x, 0, 0), 0.5, v3(2, 0, 0.3), v3(0, 0, 0));
    lab_sphere(l, v3(x, 0, 0.1), 0.5, v3(-2, 0.1, 0), v3(0, 0, 0));
    lab_box(l, v3(0, 4, 0), v3(0.6, 0.7, 0.4), 0.05, q_about_axis(0, 0.1), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(l, 0);
}

/* The force on a body does not depend on whether sphere lists have existed since the world was made. */
static void earlier_sphere_lists_have_no_effect(void **state)
{
    lab whole, l;
    fl_err err = {0};
    size_t n = 0;
    (void)state;
    spheres_that_separate(&whole, 0.53);
    while (fl_contact_list_size(&whole.w) || whole.w.step < 10) assert_int_equal(lab_run(&whole, 10), 0);
    assert_true(whole.w.spheres.bodies > 0 && whole.w.contact_steps > 10);
    spheres_that_separate(&l, 5.0);
    assert_int_equal(l.w.spheres.bodies, 0);
    char *text = snapshot(&whole.w, &n);
    assert_int_equal(restore(&l.w, text, n, &err), 0);
    free(text);
    assert_int_equal(lab_run(&whole, 50), 0);
    assert_int_equal(lab_run(&l, 50), 0);
    same_state(&whole.w, &l.w, "patch", whole.w.step - 50);
    lab_free(&whole);
    lab_free(&l);
}

/* Two bonded boxes whose rounded edges overlap. */
static void bonded_with_overlap(lab *l)
{
    fl_err err = {0};
    lab_start(l);
    lab_set(l, "bond.on=true");
    lab_set(l, "material.ice.young=1e7");
    for (int k = 0; k < 2; k++)
        lab_box(l, v3(0.99 * k, 0, 0.1 * k), v3(0.5, 0.4, 0.3), 0.02, q_about_axis(0, 0.02 * k), v3(0, 0, 0),
                v3(0, 0, 0));
    assert_int_equal(fl_ice_field_add_bond(&l->field, 0, 1, 0.4, 1.0, v3(0.495, 0, 0), &err), 0);
    lab_make(l, 1e-4);
}

/* Their bond breaks. They separate, meet, separate farther and meet again, so that their radii are restored
 * in between, before the neighbour list is renewed: a list made for smaller radii must have no effect. */
static void earlier_radii_have_no_effect(void **state)
{
    static const struct {
        double v; /* [m/s] */
        int64_t steps;
        int touch;
    } WAY[] = {{0.02, 5, 0}, {-0.02, 10, 1}, {0.02, 20, 0}, {-0.02, 25, 1}};
    lab whole, l;
    fl_err err = {0};
    size_t n = 0;
    double keep = 0.0;
    (void)state;
    bonded_with_overlap(&whole);
    bonded_with_overlap(&l);
    fl_bond_end(&whole.w.bonds.bond[0]);
    whole.w.bonds.ended = 1;
    for (size_t k = 0; k < sizeof WAY / sizeof *WAY; k++) {
        whole.w.b.v[1] = v3(WAY[k].v, 0, 0);
        fl_body_update_spin(&whole.w.b, 1);
        assert_int_equal(lab_run(&whole, WAY[k].steps), 0);
        assert_int_equal(whole.w.n_pair, 1);
        assert_int_equal(whole.w.pair[0].touching, WAY[k].touch);
        if (k == 1) keep = whole.w.pair[0].contact->radius_factor;
    }
    assert_true(keep > 0.0 && whole.w.pair[0].contact->radius_factor > keep &&
                whole.w.pair[0].contact->radius_factor < 1.0);
    char *text = snapshot(&whole.w, &n);
    assert_int_equal(restore(&l.w, text, n, &err), 0);
    free(text);
    assert_int_equal(lab_run(&whole, 5), 0);
    assert_int_equal(lab_run(&l, 5), 0);
    same_state(&whole.w, &l.w, "patch", whole.w.step - 5);
    lab_free(&whole);
    lab_free(&l);
}

static void invalid_states_are_refused(void **state)
{
    static const struct {
        const char *of, *from, *to;
    } wrong[] = {{"cut short", NULL, NULL},
                 {"another size", "world 5", "world x"},
                 {"a row is missing", "books ", "book "},
                 {"not hexadecimal", "body ", "body g"},
                 {"a double of 17 digits", "body ", "body 3333333333333333"},
                 {"not a number", "body ", "body 7ff8000000000000 "},
                 {"pairs that fall", "pair 2 ", "pair 0 "},
                 {"an index too large", "pair 2 ", "pair 99 "}};
    lab l;
    size_t n = 0;
    (void)state;
    scene_of_everything(&l, 2, NULL);
    lab_make(&l, 0);
    assert_int_equal(lab_run(&l, 5), 0);
    char *good = snapshot(&l.w, &n);
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char *bad = calloc(n + 64, 1);
        fl_err err = {0};
        assert_non_null(bad);
        memcpy(bad, good, n);
        if (wrong[k].from) {
            char *p = strstr(bad, wrong[k].from);
            if (!p) print_error("%s\n", wrong[k].of);
            assert_non_null(p);
            const size_t a = strlen(wrong[k].from), b = strlen(wrong[k].to);
            memmove(p + b, p + a, n + 63 - (size_t)(p - bad) - (a > b ? a : b));
            memcpy(p, wrong[k].to, b);
        } else {
            bad[n / 2] = '\0';
        }
        lab into;
        scene_of_everything(&into, 2, NULL);
        lab_make(&into, 0);
        assert_int_equal(restore(&into.w, bad, strlen(bad), &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        assert_non_null(strstr(err.text, "snapshot:"));
        lab_free(&into);
        free(bad);
    }
    lab other; /* a world of another size */
    fl_err err = {0};
    scene_of_everything(&other, 3, NULL);
    lab_make(&other, 0);
    assert_int_equal(restore(&other.w, good, n, &err), -1);
    lab_free(&other);
    free(good);
    lab_free(&l);
}

/* Ice that crushes on a pile of two modes, with friction, in a drift that turns. */
static void make_strip(lab *l)
{
    lab_start(l);
    lab_set(l, "contact.friction=0.1");
    lab_set(l, "failure.crushing=structure");
    lab_set(l, "failure.crushing_law=rate");
    lab_set(l, "failure.pressure=100 kPa");
    lab_set(l, "failure.scatter=0.3");
    lab_set(l, "mode a.frequency=1");
    lab_set(l, "mode a.mass=40e3");
    lab_set(l, "mode a.direction=xy");
    lab_set(l, "mode b.frequency=4");
    lab_set(l, "mode b.mass=3e3");
    lab_cone(l, (fl_cone){v3(0, 0, -2), v3(0, 0, 2), 1, 1});
    lab_box(l, v3(-8.9, 0.4, 0), v3(8, 7, 0.25), 0.05, q_one(), v3(0.4, 0, 0), v3(0, 0, 0.05));
    lab_make(l, 5e-4);
}

/* Steps in which the floe is pulled back and pushed again, so that it keeps a dent. */
static int run_strip(lab *l, int64_t steps)
{
    for (int64_t k = 0; k < steps; k++) {
        if (l->w.step == 1500) l->w.b.v[0].x = -0.6;
        if (l->w.step == 2900) l->w.b.v[0].x = 0.5;
        const int rc = lab_run(l, 1);
        if (rc) return rc;
    }
    return 0;
}

static void a_strip_resumes(void **state)
{
    lab whole;
    (void)state;
    make_strip(&whole);
    for (int64_t at = 0; at < 4000; at += 137) {
        lab l;
        fl_err err = {0};
        size_t n = 0;
        make_strip(&l);
        while (whole.w.step < at) assert_int_equal(run_strip(&whole, 1), 0);
        char *text = snapshot(&whole.w, &n);
        assert_int_equal(restore(&l.w, text, n, &err), 0);
        free(text);
        same_state(&whole.w, &l.w, "rate", at);
        assert_int_equal(run_strip(&whole, 100), 0);
        assert_int_equal(run_strip(&l, 100), 0);
        same_state(&whole.w, &l.w, "rate", at);
        lab_free(&l);
    }
    assert_true(whole.w.strips.part_breaks[0] > 50);
    assert_true(whole.w.crushing.dents[0] && whole.w.crushing.dents[0]->n > 0);
    lab_free(&whole);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_run_resumes_at_any_step),
                                       cmocka_unit_test(stages_resume_at_any_step),
                                       cmocka_unit_test(a_strip_resumes),
                                       cmocka_unit_test(results_do_not_depend_on_the_age_of_lists),
                                       cmocka_unit_test(released_floes_keep_their_surrogates),
                                       cmocka_unit_test(a_state_reads_back_unchanged),
                                       cmocka_unit_test(a_repeated_step_has_the_same_water),
                                       cmocka_unit_test(earlier_sphere_lists_have_no_effect),
                                       cmocka_unit_test(earlier_radii_have_no_effect),
                                       cmocka_unit_test(invalid_states_are_refused)};
    return cmocka_run_group_tests_name("restart", tests, NULL, NULL);
}
