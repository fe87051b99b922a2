/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a floe is to a structure that is not convex: which side, how far, how deep, against brute force. */
#include <stdio.h>
#include <stdlib.h>
#include "geom/mass.h"
#include "patch/patch_law.h"
#include "patch/patch_points.h"
#include "structure/mesh_contact.h"
#include "support/hulls.h"
#include "support/near.h"
#include "support/shapes.h"

/* Poses of a floe and points for each structure; FLOE_TIMES=1000 makes a million of them. */
enum { POSES = 28, POINTS = 60 };
enum { MM = 50 };
static const double RADIUS = 1e-3 * MM;
/* A mesh is known to the tolerance of its planes, 1e-6 of the size. */
static const double PLANE_TOL = 1e-6;
/* A face acts in its rim too, beyond its edge, where its plane may be deeper by the width of the rim. */
static const double RIM = FL_PATCH_RIM_WIDTH * 1e-3 * MM;

typedef struct {
    fl_surface surface;
    fl_structure st;
    const fl_part *part;
    const fl_piece *piece;
    fl_aabb box;
    int closed;
} structure;

static void begin(structure *s, int k)
{
    fl_err err = {0};
    *s = (structure){0};
    s->closed = hull_make(&s->surface, k);
    s->part = &s->surface.part[0];
    if (fl_structure_build(&s->st, &s->surface, &err)) fail_msg("%s %d: %s", hull_name(k), k, err.text);
    s->piece = &s->st.piece[0];
    s->box = fl_part_aabb(s->part);
    assert_int_equal(s->piece->kind, FL_PIECE_MESH);
    assert_int_equal(s->piece->mesh.closed, s->closed);
}

static void end(structure *s)
{
    fl_structure_free(&s->st);
    fl_surface_free(&s->surface);
}

/* A point of the structure, on a corner, an edge or a face as often each, and how far from there to look. */
static fl_vec3 point_on(const structure *s, fl_rng *g, double *far)
{
    const fl_part *p = s->part;
    const fl_tri t = p->t[(int)fl_rng_in(g, 0, p->nt)];
    const double kind = fl_rng_unit(g);
    double a = fl_rng_unit(g), b = fl_rng_unit(g);
    *far = RADIUS * pow(10.0, fl_rng_in(g, -2, 2));
    if (kind < 0.33) a = b = 0.0;
    else if (kind < 0.66) b = 0.0;
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    const fl_vec3 o = p->v[t.v[0]];
    return v3_madd(v3_madd(o, a, v3_sub(p->v[t.v[1]], o)), b, v3_sub(p->v[t.v[2]], o));
}

static fl_vec3 point_near(const structure *s, fl_rng *g)
{
    double far;
    const fl_vec3 x = point_on(s, g, &far);
    return v3_madd(x, far, shape_direction(g));
}

/* The structures are what they claim to be: no point is inside twice. */
static void every_point_is_inside_once_or_not_at_all(void **state)
{
    (void)state;
    for (int k = 0; k < HULLS; k++) {
        structure s;
        begin(&s, k);
        for (long c = 0; c < 100 && s.closed; c++) {
            fl_rng g = fl_rng_of(test_seed(), 10000 * k + c, FL_RNG_TEST);
            const double w = hull_winding(s.part, point_near(&s, &g));
            if (fabs(w) > 1e-6 && fabs(w - 1.0) > 1e-6)
                fail_msg("%s %d: winding number %g", hull_name(k), k, w);
        }
        end(&s);
    }
}

static void a_point_is_inside_where_the_winding_number_says_so(void **state)
{
    (void)state;
    long wrong = 0, inside = 0;
    for (int k = 0; k < HULLS; k++) {
        structure s;
        begin(&s, k);
        for (long c = 0; c < test_times(POINTS) && s.closed; c++) {
            fl_rng g = fl_rng_of(test_seed(), 10000 * k + c, FL_RNG_TEST);
            const fl_vec3 x = point_near(&s, &g);
            const int in = hull_winding(s.part, x) > 0.5;
            inside += in;
            if (fl_mesh_contact_contains(s.piece, v3_sub(x, s.piece->x)) == in) continue;
            if (hull_point_distance(s.part, x) < 1e-6 * s.piece->core.size) continue;
            if (!wrong++)
                print_error("seed %llu: %s %d, point %ld: %.17g %.17g %.17g is %s\n",
                            (unsigned long long)test_seed(), hull_name(k), k, c, x.x, x.y, x.z,
                            in ? "in" : "out");
        }
        end(&s);
    }
    assert_int_equal(wrong, 0);
    assert_true(inside > HULLS * test_times(POINTS) / 8);
}

/* Half the floes upright, as ice is; from cubes to sheets much larger than the structure is thick. Most lie
 * beyond a plane across a random direction, which the structure meets in one point or more. */
static void random_floe(fl_poly *core, const structure *s, fl_rng *g)
{
    fl_err err = {0};
    const double large = fl_rng_in(g, -1.3, 1.0);
    const fl_vec3 half = v3(pow(10.0, fl_rng_in(g, -1.3, large)), pow(10.0, large), fl_rng_in(g, 0.05, 0.6));
    assert_int_equal(fl_poly_box(core, half, &err), 0);
    const fl_quat q = fl_rng_unit(g) < 0.5 ? q_of_vector(v3(0, 0, fl_rng_in(g, -3, 3))) : shape_rotation(g);
    double far;
    const fl_vec3 x = point_on(s, g, &far), way = shape_direction(g), back = q_rotate(q_conj(q), v3_neg(way));
    /* the point of the floe that is nearest to the structure: a corner, or with it on an edge or a face */
    fl_vec3 at = v3(copysign(half.x, back.x), copysign(half.y, back.y), copysign(half.z, back.z));
    if (fl_rng_unit(g) < 0.2) at = v3_scale(0.5, at);
    if (fl_rng_unit(g) < 0.3) at.x *= fl_rng_in(g, -1, 1);
    if (fl_rng_unit(g) < 0.3) at.y *= fl_rng_in(g, -1, 1);
    if (fl_rng_unit(g) < 0.3) at.z *= fl_rng_in(g, -1, 1);
    shape_move(core, q, v3_sub(v3_madd(x, far, way), q_rotate(q, at)));
}

typedef struct {
    long clear, near, pierced, enclosed;
} seen;

/* Returns 0, or 1 and says what is wrong. */
static int check_floe(const structure *s, const fl_poly *core, fl_patch_points *w, fl_mesh_contact_work *near,
                      seen *n, char *why)
{
    const double d = hull_distance(s->part, core), size = s->piece->core.size + core->size;
    fl_feature_pairs l = {0};
    double distance, most = -INFINITY, deepest = 0.0;
    fl_gap gap;
    int wrong = 0;
    assert_int_equal(fl_patch_points_transform(w, core, q_matrix(q_one()), v3_neg(s->piece->x)), 0);
    assert_int_equal(fl_mesh_contact_points(w, near, core, s->piece, RADIUS, 2.0 * RADIUS, &l, &distance), 0);
    for (int32_t k = 0; k < w->n; k++) most = fmax(most, w->point[k].overlap);
    const int in = s->closed && d > 0.0 && hull_winding(s->part, core->v[0]) > 0.5;
    for (int32_t v = 0; v < core->nv; v++)
        if (s->closed && hull_winding(s->part, core->v[v]) > 0.5)
            deepest = fmax(deepest, hull_point_distance(s->part, core->v[v]));
    const int found = fl_mesh_contact_gap(near, w->va, core, s->piece, 2.0 * RADIUS, &gap);
    assert_true(found >= 0);
    if (d > 0.0 && !in) {
        n->clear += d >= RADIUS, n->near += d < RADIUS;
        if (most > RADIUS - d + RIM + PLANE_TOL * size)
            wrong = sprintf(why, "%g deep, and clear by %g", most, d);
        else if (s->closed && w->n == 0 && d < RADIUS - PLANE_TOL * size)
            wrong = sprintf(why, "no contact at a distance of %g", d);
        else if (d < 1.9 * RADIUS && (!found || fabs(gap.d - d) > PLANE_TOL * size))
            wrong = sprintf(why, "a gap of %g instead of %g", gap.d, d);
    } else if (d > 0.0) {
        n->enclosed++;
        if (d < 1.9 * RADIUS && (!found || fabs(gap.d + d) > PLANE_TOL * size))
            wrong = sprintf(why, "a gap of %g instead of %g inside", gap.d, -d);
    } else {
        n->pierced++;
        if (w->n == 0) wrong = sprintf(why, "no contact where they meet");
        else if (s->closed && most > 2.0 * RADIUS + deepest + PLANE_TOL * size)
            wrong = sprintf(why, "%g deep, and no corner is deeper than %g", most, deepest);
    }
    if (wrong == 0 && distance > fmax(RADIUS, d + PLANE_TOL * size))
        wrong = sprintf(why, "bound %g of %g", distance, d);
    fl_mesh_under_face_free_pairs(&l);
    return wrong != 0;
}

static void a_floe_is_as_far_from_a_structure_as_brute_force_finds(void **state)
{
    (void)state;
    fl_patch_points w = {0};
    fl_mesh_contact_work near = {0};
    seen n = {0};
    long wrong = 0;
    for (int k = 0; k < HULLS; k++) {
        structure s;
        long here = 0;
        begin(&s, k);
        for (long c = 0; c < test_times(POSES); c++) {
            fl_rng g = fl_rng_of(test_seed(), 1000000 * (k + 1) + c, FL_RNG_TEST);
            fl_poly core = {0};
            char why[200];
            random_floe(&core, &s, &g);
            if (check_floe(&s, &core, &w, &near, &n, why) && here++ < 3)
                print_error("seed %llu: %s %d, pose %ld: %s\n", (unsigned long long)test_seed(), hull_name(k),
                            k, c, why);
            fl_poly_free(&core);
        }
        wrong += here;
        if (here) print_error("%s %d: %ld wrong\n", hull_name(k), k, here);
        end(&s);
    }
    fl_patch_points_free(&w);
    fl_mesh_contact_work_free(&near);
    print_message("%ld clear, %ld near, %ld pierced, %ld enclosed; %ld wrong\n", n.clear, n.near, n.pierced,
                  n.enclosed, wrong);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_is_inside_once_or_not_at_all),
        cmocka_unit_test(a_point_is_inside_where_the_winding_number_says_so),
        cmocka_unit_test(a_floe_is_as_far_from_a_structure_as_brute_force_finds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
