/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a surrogate tells, against what a look finds. */
#include <math.h>
#include "base/rng.h"
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "patch/no_tension.h"
#include "support/small_world.h"
#include "support/near.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* Ways in which one box lies on another. */
enum { FACE, SHIFTED, EDGE, CORNER, CROSSED, KINDS };

#define DEPTH 2e-3 /* overlap [m] */

/* Two boxes of which the upper one, as it is turned, has been lowered until they overlap. */
static void two(lab *l, int kind)
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
    double lo = 0.0, hi = 3.0; /* of the height: too deep, and not enough */
    for (int k = 0; k < 60; k++) {
        l->w.b.x[1].z = 0.5 * (lo + hi);
        if (lab_evaluate_pair(&l->w, 0, 1).overlap > DEPTH) lo = l->w.b.x[1].z;
        else hi = l->w.b.x[1].z;
    }
}

/* Two boxes, their pair, which has been looked at, and where the upper one was laid. */
typedef struct {
    lab l;
    fl_pair p;
    fl_vec3 x;
    fl_quat q;
} laid;

/* A look, however near the last one was. */
static void look(laid *a)
{
    if (a->p.surrogate) a->p.surrogate->reach = 1e-9;
    fl_pair_evaluate(&a->l.w, &a->p, 0, 0.0, 0);
    assert_true(a->p.touching && a->p.surrogate && a->p.surrogate->valid);
}

static void lay(laid *a, int kind)
{
    two(&a->l, kind);
    a->x = a->l.w.b.x[1];
    a->q = a->l.w.b.q[1];
    fl_pair_init(&a->l.w, &a->p, 0, 1);
    look(a);
}

static void take_up(laid *a)
{
    fl_pair_free(&a->p);
    lab_free(&a->l);
}

/* A way to go: of the upper box, and its turn times the length of the surrogate. */
typedef struct {
    fl_vec3 u, w;
} way;

static way some(fl_rng *g)
{
    const way a = {v3(fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g)),
                   v3(fl_rng_normal(g), fl_rng_normal(g), fl_rng_normal(g))};
    const double each = 1.0 / sqrt(v3_norm2(a.u) + v3_norm2(a.w));
    return (way){v3_scale(each, a.u), v3_scale(each, a.w)};
}

/* The upper box gone by h along a from x and q, turned about the point of the surrogate, which is A's. */
static void go_from(laid *l, fl_vec3 x, fl_quat q, way a, double h)
{
    const fl_surrogate *s = l->p.surrogate;
    const fl_quat turn = q_of_vector(v3_scale(h / s->length, a.w));
    fl_bodies *b = &l->l.w.b;
    const fl_vec3 point = v3_add(b->x[0], m3_mul(fl_body_axes(b, 0), s->point_a));
    b->q[1] = q_mul(turn, q);
    b->x[1] = v3_madd(v3_add(point, q_rotate(turn, v3_sub(x, point))), h, a.u);
    fl_body_update_spin(b, 1);
}

/* The same from where it was laid. */
static void go(laid *l, way a, double h) { go_from(l, l->x, l->q, a, h); }

/* How the lower box, A, stands to the upper one, B. */
static fl_vec3 pose(const lab *l, fl_mat3 *M)
{
    const fl_bodies *b = &l->w.b;
    for (int k = 0; k < 3; k++) {
        const fl_vec3 c = m3_tmul(fl_body_axes(b, 1), m3_col(fl_body_axes(b, 0), k));
        M->m[0][k] = c.x, M->m[1][k] = c.y, M->m[2][k] = c.z;
    }
    return m3_tmul(fl_body_axes(b, 1), v3_sub(b->x[0], b->x[1]));
}

/* What it tells for that, in the k-th lane, the others being of some other pose. */
static fl_surrogate_value told_in(const laid *l, int lane)
{
    const fl_surrogate *all[FL_SURROGATE_BATCH];
    fl_surrogate_lanes b;
    fl_mat3 M;
    const fl_vec3 o = pose(&l->l, &M);
    for (int k = 0; k < FL_SURROGATE_BATCH; k++) {
        all[k] = l->p.surrogate;
        fl_lane3_set(b.o, k, v3_scale(k == lane ? 1.0 : 1.0 + 1e-3 * k, o));
        for (int r = 0; r < 3; r++) fl_lane3_set(b.M + 3 * r, k, v3(M.m[r][0], M.m[r][1], M.m[r][2]));
    }
    fl_surrogate_pack(&b, all, FL_SURROGATE_BATCH);
    fl_surrogate_evaluate(&b);
    return fl_surrogate_unpack(&b, lane);
}

static fl_surrogate_value told_of(const laid *l) { return told_in(l, 0); }

/* By how much the force and the moment that are told are off, over the force. */
static double off(laid *l)
{
    fl_world *w = &l->l.w;
    const fl_surrogate_value t = told_of(l);
    const fl_pair p = lab_evaluate_pair(w, 0, 1);
    const fl_mat3 R = fl_body_axes(&w->b, 1);
    const fl_vec3 f = m3_mul(R, t.gradient.f);
    const fl_vec3 at = v3_add(w->b.x[1], m3_mul(R, t.point)), arm = v3_sub(at, w->b.x[0]);
    const fl_vec3 m = v3_sub(p.torque_i, v3_cross(arm, p.force)); /* about the point */
    const double df = v3_norm(v3_sub(f, p.force)),
                 dm = v3_norm(v3_sub(m3_mul(R, t.gradient.m), m)) / l->p.surrogate->length;
    return fmax(df, dm) / v3_norm(p.force);
}

static void what_is_told_is_a_potential(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 3);
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        laid l;
        lay(&l, kind);
        const fl_bodies *b = &l.l.w.b;
        for (int k = 0; k < 2; k++) { /* looks, which teach */
            go(&l, some(&g), 0.05 * DEPTH);
            look(&l);
        }
        for (int k = 0; k < 12; k++) {
            const way to = some(&g), along = some(&g);
            const double h = 1e-4 * DEPTH;
            fl_surrogate_value t[3];
            for (int e = 0; e < 3; e++) { /* by h along a second way, both ways */
                go(&l, to, 0.2 * DEPTH);
                go_from(&l, b->x[1], b->q[1], along, e == 0 ? 0.0 : e == 1 ? -h : h);
                t[e] = told_of(&l);
            }
            go(&l, to, 0.2 * DEPTH);
            const fl_mat3 R = fl_body_axes(b, 1);
            const double arm = l.p.surrogate->length;
            const fl_vec3 f = m3_mul(R, t[0].gradient.f), m = m3_mul(R, t[0].gradient.m);
            /* what B goes, A goes the other way */
            const double work = -h * (v3_dot(f, along.u) + v3_dot(m, along.w) / arm);
            assert_near_of(t[2].energy - t[1].energy, -2.0 * work, 1e-7,
                           h * (v3_norm(t[0].gradient.f) + v3_norm(t[0].gradient.m) / arm));
        }
        take_up(&l);
    }
}

/* What is told has the same bits in every lane. */
static void lanes_are_alike(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        laid l;
        lay(&l, kind);
        go(&l, (way){v3(0.3, 0.5, 0.2), v3(0.4, -0.5, 0.4)}, 0.1 * DEPTH);
        const fl_surrogate_value one = told_of(&l);
        for (int k = 1; k < FL_SURROGATE_BATCH; k++) {
            const fl_surrogate_value other = told_in(&l, k);
            assert_memory_equal(&one, &other, sizeof one);
        }
        take_up(&l);
    }
}

/* The slope that friction goes by follows the contact: a twentieth of the overlap away it is off by much less
 * than it has changed. */
static void the_slope_is_told(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 5);
    double mean = 0.0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        double off = 0.0, changed = 0.0; /* sums */
        laid l;
        lay(&l, kind);
        const double first = l.p.springs.k;
        assert_true(first > 0.0);
        for (int k = 0; k < 50; k++) {
            go(&l, some(&g), 0.05 * DEPTH);
            const fl_surrogate_value t = told_of(&l);
            const double now = lab_evaluate_pair(&l.l.w, 0, 1).springs.k;
            off += fabs(t.slope / l.p.surrogate->slope * first - now);
            changed += fabs(now - first);
        }
        mean += off / changed / KINDS;
        take_up(&l);
    }
    assert_true(mean < 0.5);
}

/* At the look it tells what was found; further along a way that it has been taught the error falls with the
 * square of what is left of the way. */
static void a_look_teaches(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 4);
    double log_ratio = 0.0, better = 0.0;
    int many = 0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 20; k++) {
            laid l;
            const way a = some(&g);
            double e[3], untaught;
            lay(&l, kind);
            assert_true(off(&l) < 1e-9);
            go(&l, a, 0.04 * DEPTH);
            untaught = off(&l);
            go(&l, a, -0.02 * DEPTH);
            look(&l);
            assert_true(off(&l) < 1e-9);
            for (int c = 0; c < 3; c++) {
                go(&l, a, (0.04 * (1 << c) - 0.02) * DEPTH);
                e[c] = off(&l);
            }
            go(&l, a, 0.0);
            better += log2(untaught / fmax(off(&l), 1e-12)) / (20.0 * KINDS);
            if (e[0] > 1e-7) log_ratio += log2(e[1] / e[0]), many++;
            take_up(&l);
        }
    assert_true(many > 40);
    assert_true(log_ratio / many > 1.6 && better > 3.0);
}

/* How far off it is h after n looks along a, h from one another; the first is where they were laid. */
static double off_after(int kind, way a, int n, double h)
{
    laid l;
    lay(&l, kind);
    for (int c = 1; c < n; c++) {
        go(&l, a, c * h);
        look(&l);
        assert_true(off(&l) < 1e-9);
    }
    go(&l, a, n * h);
    const double e = off(&l);
    take_up(&l);
    return e;
}

/* What three looks on a line foretell is off as the third power of the way, what two of them do as the
 * second. */
static void looks_on_a_line_teach_more(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 6);
    double order[2] = {0}, better = 0.0;
    int many = 0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 20; k++) {
            const way a = some(&g);
            const double h = 0.04 * DEPTH, two = off_after(kind, a, 2, h), three = off_after(kind, a, 3, h);
            better += log2(two / fmax(three, 1e-12)) / (20.0 * KINDS);
            if (!(three > 1e-6)) continue;
            order[0] += log2(two / off_after(kind, a, 2, 0.5 * h));
            order[1] += log2(three / off_after(kind, a, 3, 0.5 * h));
            many++;
        }
    assert_true(many > 20);
    assert_true(fabs(order[0] / many - 2.0) < 0.3 && fabs(order[1] / many - 3.0) < 0.4 && better > 3.0);
}

/* The upper box moves along a, so fast that damping asks for about as much as presses, or for more. */
static void move(laid *l, way a, double times)
{
    fl_bodies *b = &l->l.w.b;
    const double speed = times * sqrt(2.0 * l->p.energy / b->m[1]);
    b->v[1] = v3_scale(speed, a.u);
    b->w[1] = v3_scale(speed / l->p.surrogate->length, a.w);
}

/* What damping does as it is told and as a look finds it, over the force without it. */
static void damped(laid *l, fl_vec3 *told, fl_vec3 *looked)
{
    l->p.surrogate->reach = FL_SURROGATE_MAX_REACH;
    fl_pair_evaluate(&l->l.w, &l->p, 0, 0.0, 0);
    assert_true(l->p.surrogate->used);
    const fl_pair p = lab_evaluate_pair(&l->l.w, 0, 1);
    const double each = 1.0 / v3_norm(v3_sub(v3_sub(p.force, p.force_damping), p.force_friction));
    *told = v3_scale(each, l->p.force_damping), *looked = v3_scale(each, p.force_damping);
}

/* Damping is told as it was found at the look, also where it would pull at a part of what presses; and
 * farther on it has turned with the force. */
static void damping_is_told(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 8);
    double off[2][2] = {{0}}, changed[2] = {0}; /* [some of it held back][on the spot, farther on] */
    int many[2] = {0};
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 60; k++) {
            laid l;
            fl_vec3 told[2], looked[2];
            const way a = some(&g);
            lay(&l, kind);
            l.l.w.dt = 0.0; /* of no length: nothing is held back */
            move(&l, a, k % 2 ? 0.02 : 0.3);
            fl_pair_evaluate_exact(&l.l.w, &l.p, 0, NULL, 0.0, 0);
            damped(&l, &told[0], &looked[0]);
            const fl_surrogate *s = l.p.surrogate;
            const int held = s->half_width != FL_UNIFORM_HALF_WIDTH;
            go(&l, a, 0.01 * DEPTH);
            damped(&l, &told[1], &looked[1]);
            if (!held) assert_true(v3_norm(v3_sub(told[0], looked[0])) < 1e-9);
            for (int c = 0; c < 2; c++) off[held][c] += v3_norm(v3_sub(told[c], looked[c]));
            changed[held] += v3_norm(v3_sub(looked[1], looked[0]));
            many[held]++;
            take_up(&l);
        }
    assert_true(many[0] > 100 && many[1] > 20);
    assert_true(off[1][0] < 1e-3 * changed[1]); /* their mean and one moment are right */
    for (int held = 0; held < 2; held++) assert_true(off[held][1] < 2e-3 * changed[held]);
}

/* A contact that was told and is nearly over, further than what is told of it goes: what it owes is a
 * number. */
static void what_is_owed_is_a_number(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 0, 7);
    int past = 0;
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int k = 0; k < 150; k++) {
            const way a = some(&g);
            for (int c = 8; c <= 14; c++) {
                laid l;
                lay(&l, kind);
                go(&l, a, 0.1 * c * DEPTH);
                const int over = told_of(&l).z <= 0.0;
                l.p.surrogate->used = 1;
                fl_pair_evaluate(&l.l.w, &l.p, 0, 0.0, 0);
                const int touches = l.p.touching;
                if (touches)
                    assert_true(isfinite(l.p.surrogate->energy_defect) &&
                                isfinite(l.p.surrogate->defect_return));
                past += touches && over;
                take_up(&l);
            }
        }
    assert_true(past > 0);
}

/* A box comes down on the floor with an edge first and rocks there, sliding or not: where along the floor it
 * is changes nothing, neither what is told nor when there has to be a look. */
static void a_floor_is_the_same_everywhere(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_told_is_a_potential),
                                       cmocka_unit_test(lanes_are_alike),
                                       cmocka_unit_test(the_slope_is_told),
                                       cmocka_unit_test(a_look_teaches),
                                       cmocka_unit_test(looks_on_a_line_teach_more),
                                       cmocka_unit_test(what_is_owed_is_a_number),
                                       cmocka_unit_test(a_floor_is_the_same_everywhere),
                                       cmocka_unit_test(damping_is_told)};
    return cmocka_run_group_tests_name("surrogate", tests, NULL, NULL);
}
