/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Predictions of a surrogate against exact evaluations. */
#include <math.h>
#include "base/rng.h"
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/pair_surrogate.h"
#include "contact/quick_force.h"
#include "patch/no_tension.h"
#include "support/small_world.h"
#include "support/near.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* Configurations of one box on another. */
enum { FACE, SHIFTED, EDGE, CORNER, CROSSED, KINDS };

#define DEPTH 2e-3 /* overlap [m] */

/* Two boxes; the upper one, rotated, has been lowered until they overlap. */
static void make_two_boxes(lab *l, int kind)
{
    static const struct {
        double x, y;
        fl_vec3 turn;
    } HOW[KINDS] = {{0.05, 0.03, {0, 0, 0}},
                    {0.6, 0.3, {1e-3, -2e-3, 0.4}},
                    {0.2, 0.1, {0.02, 0.6, 0}},
                    {0.1, 0.05, {0.6, -0.4, 0.1}},
                    {0.9, 0.1, {0.3, 0.785, 0.2}}};
    lab_start(l);
    lab_set(l, "contact.surrogate=0.01");
    lab_set(l, "contact.friction=0.3");
    lab_set(l, "contact.restitution=0.1");
    lab_box(l, ZERO, v3(0.5, 0.5, 0.5), 0.05, q_one(), ZERO, ZERO);
    lab_box(l, v3(HOW[kind].x, HOW[kind].y, 3), v3(0.5, 0.5, 0.5), 0.05, q_of_vector(HOW[kind].turn), ZERO,
            ZERO);
    lab_make(l, 1e-9);
    double lo = 0.0, hi = 3.0; /* of the height: too deep, and not deep enough */
    for (int k = 0; k < 60; k++) {
        l->w.b.x[1].z = 0.5 * (lo + hi);
        if (lab_evaluate_pair(&l->w, 0, 1).overlap > DEPTH) lo = l->w.b.x[1].z;
        else hi = l->w.b.x[1].z;
    }
}

/* Two boxes, their pair, which has been evaluated, and the initial pose of the upper one. */
typedef struct {
    lab l;
    fl_pair p;
    fl_vec3 x;
    fl_quat q;
} placed_pair;

/* An exact evaluation, however recent the last one is. */
static void evaluate(placed_pair *a)
{
    if (a->p.surrogate) a->p.surrogate->reach = 1e-9;
    fl_pair_evaluate(&a->l.w, &a->p, 0, 0.0, 0);
    assert_true(a->p.touching && a->p.surrogate && a->p.surrogate->valid);
}

static void place_boxes(placed_pair *a, int kind)
{
    make_two_boxes(&a->l, kind);
    a->x = a->l.w.b.x[1];
    a->q = a->l.w.b.q[1];
    fl_pair_init(&a->l.w, &a->p, 0, 1);
    evaluate(a);
}

static void free_boxes(placed_pair *a)
{
    fl_pair_free(&a->p);
    lab_free(&a->l);
}

/* A direction of motion: of the upper box, and of its rotation times the length of the surrogate. */
typedef struct {
    fl_vec3 u, w;
} direction;

static direction random_path(fl_rng *g)
{
    const direction a = {v3(fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)),
                         v3(fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g))};
    const double each = 1.0 / sqrt(v3_norm2(a.u) + v3_norm2(a.w));
    return (direction){v3_scale(each, a.u), v3_scale(each, a.w)};
}

/* Moves the upper box by h along a from x and q, rotated about the reference point of the surrogate, which is
 * A's. */
static void move_from(placed_pair *l, fl_vec3 x, fl_quat q, direction a, double h)
{
    const fl_surrogate *s = l->p.surrogate;
    const fl_quat turn = q_of_vector(v3_scale(h / s->length, a.w));
    fl_bodies *b = &l->l.w.b;
    const fl_vec3 point = v3_add(b->x[0], m3_mul(fl_body_axes(b, 0), s->point_a));
    b->q[1] = q_mul(turn, q);
    b->x[1] = v3_madd(v3_add(point, q_rotate(turn, v3_sub(x, point))), h, a.u);
    fl_body_update_spin(b, 1);
}

/* The same from the initial pose. */
static void move_along(placed_pair *l, direction a, double h) { move_from(l, l->x, l->q, a, h); }

/* Pose of the lower box, A, relative to the upper one, B. */
static fl_vec3 relative_pose(const lab *l, fl_mat3 *M)
{
    const fl_bodies *b = &l->w.b;
    for (int k = 0; k < 3; k++) {
        const fl_vec3 c = m3_tmul(fl_body_axes(b, 1), m3_col(fl_body_axes(b, 0), k));
        M->m[0][k] = c.x, M->m[1][k] = c.y, M->m[2][k] = c.z;
    }
    return m3_tmul(fl_body_axes(b, 1), v3_sub(b->x[0], b->x[1]));
}

/* The surrogate's prediction for that pose in lane k, with other poses in the other lanes. */
static fl_surrogate_value predict_in_lane(const placed_pair *l, int lane)
{
    const fl_surrogate *all[FL_SURROGATE_BATCH];
    fl_surrogate_lanes b;
    fl_mat3 M;
    const fl_vec3 o = relative_pose(&l->l, &M);
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        all[k] = l->p.surrogate;
        fl_lane3_set(b.o, k, v3_scale(k == lane ? 1.0 : 1.0 + 1e-3 * k, o));
        for (int r = 0; r < 3; r++) fl_lane3_set(b.M + 3 * r, k, v3(M.m[r][0], M.m[r][1], M.m[r][2]));
    }
    fl_surrogate_pack(&b, all, FL_SURROGATE_BATCH);
    fl_surrogate_evaluate(&b);
    return fl_surrogate_unpack(&b, lane);
}

static fl_surrogate_value predict(const placed_pair *l) { return predict_in_lane(l, 0); }

/* Error of the predicted force and moment, relative to the force. */
static double prediction_error(placed_pair *l)
{
    fl_world *w = &l->l.w;
    const fl_surrogate_value t = predict(l);
    const fl_pair p = lab_evaluate_pair(w, 0, 1);
    const fl_mat3 R = fl_body_axes(&w->b, 1);
    const fl_vec3 f = m3_mul(R, t.gradient.f);
    const fl_vec3 at = v3_add(w->b.x[1], m3_mul(R, t.point)), arm = v3_sub(at, w->b.x[0]);
    const fl_vec3 m = v3_sub(p.torque_i, v3_cross(arm, p.force)); /* about the point */
    const double df = v3_norm(v3_sub(f, p.force)),
                 dm = v3_norm(v3_sub(m3_mul(R, t.gradient.m), m)) / l->p.surrogate->length;
    return fmax(df, dm) / v3_norm(p.force);
}

static void a_prediction_has_a_potential(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 3);
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        placed_pair l;
        place_boxes(&l, kind);
        const fl_bodies *b = &l.l.w.b;
        for (int k = 0; k < 2; k++) { /* exact evaluations, which add samples */
            move_along(&l, random_path(&g), 0.05 * DEPTH);
            evaluate(&l);
        }
        for (int k = 0; k < 12; k++) {
            const direction to = random_path(&g), along = random_path(&g);
            const double h = 1e-4 * DEPTH;
            fl_surrogate_value t[3];
            for (int e = 0; e < 3; e++) { /* by h along a second direction, both ways */
                move_along(&l, to, 0.2 * DEPTH);
                move_from(&l, b->x[1], b->q[1], along, e == 0 ? 0.0 : e == 1 ? -h : h);
                t[e] = predict(&l);
            }
            move_along(&l, to, 0.2 * DEPTH);
            const fl_mat3 R = fl_body_axes(b, 1);
            const double arm = l.p.surrogate->length;
            const fl_vec3 f = m3_mul(R, t[0].gradient.f), m = m3_mul(R, t[0].gradient.m);
            /* A moves opposite to B */
            const double work = -h * (v3_dot(f, along.u) + v3_dot(m, along.w) / arm);
            assert_near_of(t[2].energy - t[1].energy, -2.0 * work, 1e-7,
                           h * (v3_norm(t[0].gradient.f) + v3_norm(t[0].gradient.m) / arm));
        }
        free_boxes(&l);
    }
}

/* A prediction has the same bits in every lane. */
static void lanes_have_the_same_bits(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        placed_pair l;
        place_boxes(&l, kind);
        move_along(&l, (direction){v3(0.3, 0.5, 0.2), v3(0.4, -0.5, 0.4)}, 0.1 * DEPTH);
        const fl_surrogate_value one = predict(&l);
        for (int k = 1; k < FL_SURROGATE_BATCH; k++) {
            const fl_surrogate_value other = predict_in_lane(&l, k);
            assert_memory_equal(&one, &other, sizeof one);
        }
        free_boxes(&l);
    }
}

/* The stiffness used by friction follows the contact: a twentieth of the overlap away its error is much
 * smaller than its change. */
static void the_stiffness_is_predicted(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 5);
    double mean = 0.0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        double deviation = 0.0, changed = 0.0; /* sums */
        placed_pair l;
        place_boxes(&l, kind);
        const double first = l.p.springs.k;
        assert_true(first > 0.0);
        for (int k = 0; k < 50; k++) {
            move_along(&l, random_path(&g), 0.05 * DEPTH);
            const fl_surrogate_value t = predict(&l);
            const double now = lab_evaluate_pair(&l.l.w, 0, 1).springs.k;
            deviation += fabs(t.slope / l.p.surrogate->slope * first - now);
            changed += fabs(now - first);
        }
        mean += deviation / changed / KINDS;
        free_boxes(&l);
    }
    assert_true(mean < 0.5);
}

/* At an evaluated pose the prediction equals the evaluation. Further along a sampled direction the error
 * falls with the square of the remaining distance. */
static void an_evaluation_adds_a_sample(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 4);
    double log_ratio = 0.0, better = 0.0;
    int many = 0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 20; k++) {
            placed_pair l;
            const direction a = random_path(&g);
            double e[3], before_sampling;
            place_boxes(&l, kind);
            assert_true(prediction_error(&l) < 1e-9);
            move_along(&l, a, 0.04 * DEPTH);
            before_sampling = prediction_error(&l);
            move_along(&l, a, -0.02 * DEPTH);
            evaluate(&l);
            assert_true(prediction_error(&l) < 1e-9);
            for (int c = 0; c < 3; c++) {
                move_along(&l, a, (0.04 * (1 << c) - 0.02) * DEPTH);
                e[c] = prediction_error(&l);
            }
            move_along(&l, a, 0.0);
            better += log2(before_sampling / fmax(prediction_error(&l), 1e-12)) / (20.0 * KINDS);
            if (e[0] > 1e-7) log_ratio += log2(e[1] / e[0]), many++;
            free_boxes(&l);
        }
    assert_true(many > 40);
    assert_true(log_ratio / many > 1.6 && better > 3.0);
}

/* Error at distance h beyond n evaluations along a, spaced by h; the first is at the initial pose. */
static double error_after(int kind, direction a, int n, double h)
{
    placed_pair l;
    place_boxes(&l, kind);
    for (int c = 1; c < n; c++) {
        move_along(&l, a, c * h);
        evaluate(&l);
        assert_true(prediction_error(&l) < 1e-9);
    }
    move_along(&l, a, n * h);
    const double e = prediction_error(&l);
    free_boxes(&l);
    return e;
}

/* The prediction from three evaluations on a line has an error of the third power of the distance, that from
 * two of the second. */
static void evaluations_on_a_line_raise_the_order(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 6);
    double order[2] = {0}, better = 0.0;
    int many = 0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 20; k++) {
            const direction a = random_path(&g);
            const double h = 0.04 * DEPTH, two = error_after(kind, a, 2, h),
                         three = error_after(kind, a, 3, h);
            better += log2(two / fmax(three, 1e-12)) / (20.0 * KINDS);
            if (!(three > 1e-6)) continue;
            order[0] += log2(two / error_after(kind, a, 2, 0.5 * h));
            order[1] += log2(three / error_after(kind, a, 3, 0.5 * h));
            many++;
        }
    assert_true(many > 20);
    assert_true(fabs(order[0] / many - 2.0) < 0.3 && fabs(order[1] / many - 3.0) < 0.4 && better > 3.0);
}

/* Moves the upper box along a so fast that the damping force is about the elastic force, or larger. */
static void set_velocity(placed_pair *l, direction a, double times)
{
    fl_bodies *b = &l->l.w.b;
    const double speed = times * sqrt(2.0 * l->p.energy / b->m[1]);
    b->v[1] = v3_scale(speed, a.u);
    b->w[1] = v3_scale(speed / l->p.surrogate->length, a.w);
}

/* Damping force, predicted and evaluated, relative to the undamped force. */
static void damping_force(placed_pair *l, fl_vec3 *predicted, fl_vec3 *evaluated)
{
    l->p.surrogate->reach = FL_SURROGATE_MAX_REACH;
    fl_pair_evaluate(&l->l.w, &l->p, 0, 0.0, 0);
    assert_true(l->p.surrogate->used);
    const fl_pair p = lab_evaluate_pair(&l->l.w, 0, 1);
    const double each = 1.0 / v3_norm(v3_sub(v3_sub(p.force, p.force_damping), p.force_friction));
    *predicted = v3_scale(each, l->p.force_damping), *evaluated = v3_scale(each, p.force_damping);
}

/* Predicted damping equals the evaluated one at the evaluated pose, also where part of the pressure would
 * become tensile. Farther on it has rotated with the force. */
static void damping_is_predicted(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 8);
    double deviation[2][2] = {{0}}, changed[2] = {0}; /* [part of it limited][at the pose, farther on] */
    int many[2] = {0};
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 60; k++) {
            placed_pair l;
            fl_vec3 predicted[2], evaluated[2];
            const direction a = random_path(&g);
            place_boxes(&l, kind);
            l.l.w.dt = 0.0; /* of no length: nothing is limited */
            set_velocity(&l, a, k % 2 ? 0.02 : 0.3);
            fl_pair_evaluate_exact(&l.l.w, &l.p, 0, NULL, 0.0, 0);
            damping_force(&l, &predicted[0], &evaluated[0]);
            const fl_surrogate *s = l.p.surrogate;
            const int limited = s->half_width != FL_UNIFORM_HALF_WIDTH;
            move_along(&l, a, 0.01 * DEPTH);
            damping_force(&l, &predicted[1], &evaluated[1]);
            if (!limited) assert_true(v3_norm(v3_sub(predicted[0], evaluated[0])) < 1e-9);
            for (int c = 0; c < 2; c++) deviation[limited][c] += v3_norm(v3_sub(predicted[c], evaluated[c]));
            changed[limited] += v3_norm(v3_sub(evaluated[1], evaluated[0]));
            many[limited]++;
            free_boxes(&l);
        }
    assert_true(many[0] > 100 && many[1] > 20);
    assert_true(deviation[1][0] < 1e-3 * changed[1]); /* their mean and one moment are right */
    for (int limited = 0; limited < 2; limited++)
        assert_true(deviation[limited][1] < 2e-3 * changed[limited]);
}

/* A contact predicted by the surrogate is nearly over, beyond the surrogate's range: its error estimate stays
 * a finite number. */
static void the_error_estimate_stays_finite(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 7);
    int past = 0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 150; k++) {
            const direction a = random_path(&g);
            for (int c = 8; c <= 14; c++) {
                placed_pair l;
                place_boxes(&l, kind);
                move_along(&l, a, 0.1 * c * DEPTH);
                const int over = predict(&l).z <= 0.0;
                l.p.surrogate->used = 1;
                fl_pair_evaluate(&l.l.w, &l.p, 0, 0.0, 0);
                const int touches = l.p.touching;
                if (touches)
                    assert_true(isfinite(l.p.surrogate->energy_defect) &&
                                isfinite(l.p.surrogate->defect_return));
                past += touches && over;
                free_boxes(&l);
            }
        }
    assert_true(past > 0);
}

/* A box falls on the floor edge first and rocks there, sliding or not. Its position along the floor changes
 * neither predictions nor the times of evaluations. */
static void the_position_on_a_floor_does_not_matter(void **state)
{
    enum { STEPS = 3000 };
    lab l[2];
    (void)state;
    for (int slides = 0; slides < 2; slides++) {
        lab_start(&l[slides]);
        lab_set(&l[slides], "contact.surrogate=1e-3");
        lab_set(&l[slides], "contact.friction=0");
        lab_set(&l[slides], "run.gravity=9.81");
        lab_set(&l[slides], "boundary.type=free free rigid");
        lab_set(&l[slides], "boundary.min=none none 0");
        lab_box(&l[slides], v3(0, 0, 0.516), v3(0.5, 0.5, 0.5), 0.05, q_of_vector(v3(0.02, 0.013, 0.3)),
                slides ? v3(4, -3, -0.3) : v3(0, 0, -0.3), ZERO);
        lab_make(&l[slides], 1e-5);
        assert_int_equal(lab_run(&l[slides], STEPS), 0);
    }
    const fl_bodies *a = &l[0].w.b, *b = &l[1].w.b;
    const fl_surrogate_count *still = l[0].w.surrogate_counts, *moves = l[1].w.surrogate_counts;
    assert_true(fabs(b->x[0].x) > 0.1);
    assert_true(moves->hits > STEPS / 4 && moves->checks > 10);
    assert_true(moves->hits == still->hits && moves->checks == still->checks);
    assert_true(fabs(a->x[0].z - b->x[0].z) < 1e-13 && fabs(a->v[0].z - b->v[0].z) < 1e-12);
    assert_true(v3_norm(v3_sub(a->w[0], b->w[0])) < 1e-12);
    for (int slides = 0; slides < 2; slides++) lab_free(&l[slides]);
}

/* Sums of two boxes that overlap, with the second derivative that rounding may leave where they barely
 * touch. */
static void rounding_leaves_no_negative_stiffness(void **state)
{
    fl_force_sum of_patch;
    fl_quick_sums of_quick;
    fl_quick_exact rest;
    fl_exact_contact exact;
    double distance;
    lab l;
    fl_pair p;
    (void)state;
    lab_start(&l);
    lab_set(&l, "contact.law=quick");
    lab_set(&l, "contact.friction=0.3");
    lab_box(&l, ZERO, v3(0.5, 0.5, 0.5), 0.05, q_one(), ZERO, ZERO);
    lab_box(&l, v3(0.1, 0.2, 0.999), v3(0.5, 0.5, 0.5), 0.05, q_one(), ZERO, ZERO);
    lab_make(&l, 1e-9);
    fl_world *w = &l.w;
    fl_pair_init(w, &p, 0, 1);
    const fl_relative_pose r = fl_relative_pose_of(w, &p);
    const fl_pair_prediction a = fl_pair_prediction_of(w, &p, &r, w->dt);
    assert_int_equal(fl_pair_find_points(w, &p, 0, &r, &distance), 0);
    assert_int_equal(fl_force_sum_elastic(&w->scratch[0], &of_patch), 0);
    of_patch.ddu = 0.4 * of_patch.pressure * of_patch.pressure / of_patch.u;
    fl_exact_contact_find(w, &p, &w->scratch[0], &r, &of_patch, &exact);
    assert_near(exact.slope, exact.scale * of_patch.pressure / of_patch.overlap, 1e-15);
    assert_int_equal(fl_pair_find_quick(w, &p, 0, &r, &distance, &of_quick), 0);
    of_quick.ddu = 0.4 * of_quick.pressure * of_quick.pressure / of_quick.u;
    fl_exact_contact_of_quick(w, &p, &r, &of_quick, &rest, &exact);
    assert_near(exact.slope, exact.scale * of_quick.pressure / of_quick.overlap, 1e-15);
    assert_int_equal(fl_pair_evaluate_quick(w, &p, 0, &of_quick, NULL, &r, &a, 0), 1);
    assert_near(p.springs.k, p.law->tangential_ratio * exact.slope, 1e-15);
    fl_pair_free(&p);
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_prediction_has_a_potential),
                                       cmocka_unit_test(lanes_have_the_same_bits),
                                       cmocka_unit_test(the_stiffness_is_predicted),
                                       cmocka_unit_test(an_evaluation_adds_a_sample),
                                       cmocka_unit_test(evaluations_on_a_line_raise_the_order),
                                       cmocka_unit_test(the_error_estimate_stays_finite),
                                       cmocka_unit_test(the_position_on_a_floor_does_not_matter),
                                       cmocka_unit_test(damping_is_predicted),
                                       cmocka_unit_test(rounding_leaves_no_negative_stiffness)};
    return cmocka_run_group_tests_name("surrogate", tests, NULL, NULL);
}
