/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a floe is to a structure that is not convex: which side, how far, how deep, against CGAL (crossings
 * of a ray, exact distances of triangles) and against winding numbers and brute force. */
#include <stdio.h>
#include <stdlib.h>
#include "geom/mass.h"
#include "patch/patch_law.h"
#include "patch/patch_points.h"
#include "shim/cgal_side.h"
#include "structure/mesh_contact.h"
#include "support/hulls.h"
#include "support/near.h"
#include "support/shapes.h"

/* Poses of a floe and points for each structure; FLOE_TIMES=1000 makes a million of them.  Of 1 008 000 poses
 * (FLOE_TIMES=500, seeds 11 and 12) none was wrong: 247 753 clear, 153 116 near, 569 613 pierced, 37 518
 * enclosed. */
enum { POSES = 28, POINTS = 60 };

/* A structure of few triangles is tried at more points: places where planes mislead are rare. */
enum { TRIANGLE_POINTS = 80000 };
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
    int solid_outside; /* a tank */
    fl_cgal_oracle *oracle;
} structure;

static double *numbers_of(const fl_vec3 *v, int32_t n)
{
    double *x = malloc((3 * (size_t)n + 1) * sizeof *x);
    assert_non_null(x);
    for (int32_t k = 0; k < n; k++) x[3 * k] = v[k].x, x[3 * k + 1] = v[k].y, x[3 * k + 2] = v[k].z;
    return x;
}

static fl_soup soup_of_part(const fl_part *p)
{
    fl_soup s = {.nv = p->nv, .nt = p->nt, .x = numbers_of(p->v, p->nv)};
    s.t = malloc(3 * (size_t)p->nt * sizeof *s.t);
    assert_non_null(s.t);
    for (int32_t k = 0; k < 3 * p->nt; k++) s.t[k] = p->t[k / 3].v[k % 3];
    return s;
}

static fl_soup soup_of_core(const fl_poly *p)
{
    fl_soup s = {.nv = p->nv, .x = numbers_of(p->v, p->nv)};
    s.t = malloc(3 * (size_t)p->first[p->nf] * sizeof *s.t);
    assert_non_null(s.t);
    for (int32_t f = 0; f < p->nf; f++)
        for (int32_t k = p->first[f] + 2; k < p->first[f + 1]; k++) {
            int32_t *t = &s.t[3 * s.nt++];
            t[0] = p->loop[p->first[f]], t[1] = p->loop[k - 1], t[2] = p->loop[k];
        }
    return s;
}

/* True if x is in the solid, as CGAL finds. */
static int is_inside(const structure *s, fl_vec3 x)
{
    const double at[3] = {x.x, x.y, x.z};
    const int side = fl_cgal_oracle_side(s->oracle, at);
    return s->solid_outside ? side < 0 : side > 0;
}

/* Distance of a core as CGAL finds; 0 where the two meet. */
static double exact_distance(const structure *s, const fl_poly *core)
{
    fl_soup soup = soup_of_core(core);
    const double d = fl_cgal_oracle_distance(s->oracle, &soup);
    fl_soup_free(&soup);
    return d;
}

static void begin(structure *s, int k)
{
    fl_err err = {0};
    *s = (structure){0};
    s->closed = hull_make(&s->surface, k);
    s->part = &s->surface.part[0];
    if (fl_structure_build(&s->st, &s->surface, &err)) fail_msg("%s %d: %s", hull_name(k), k, err.text);
    s->piece = &s->st.piece[0];
    s->box = fl_part_aabb(s->part);
    s->solid_outside =
        s->closed && hull_winding(s->part, v3_add(s->box.hi, v3_sub(s->box.hi, s->box.lo))) > 0.5;
    fl_soup soup = soup_of_part(s->part);
    s->oracle = fl_cgal_oracle_make(&soup, &err);
    fl_soup_free(&soup);
    if (!s->oracle) fail_msg("%s %d: %s", hull_name(k), k, err.text);
    assert_int_equal(s->piece->kind, FL_PIECE_MESH);
    assert_int_equal(s->piece->mesh.closed, s->closed);
}

static void end(structure *s)
{
    fl_cgal_oracle_free(s->oracle);
    fl_structure_free(&s->st);
    fl_surface_free(&s->surface);
}

/* A direction to which a corner is the nearest point, if some tries find one. */
static fl_vec3 away_from_corner(const fl_part *p, int32_t corner, fl_rng *g)
{
    enum { MOST = 64, TRIES = 30 };
    fl_vec3 edge[MOST], way = v3(0, 0, 1);
    int n = 0, nearest = 0;
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3 && n < MOST; k++)
            if (p->t[t].v[k] == corner) edge[n++] = v3_sub(p->v[p->t[t].v[(k + 1) % 3]], p->v[corner]);
    for (int c = 0; c < TRIES && !nearest; c++) {
        way = shape_direction(g);
        nearest = 1;
        for (int k = 0; k < n && nearest; k++) nearest = v3_dot(edge[k], way) <= 0.0;
    }
    return way;
}

/* A point of the structure, on a corner, an edge or a face as often each (mostly corners if there are few),
 * and where and how far from there to look. */
static fl_vec3 point_on(const structure *s, fl_rng *g, fl_vec3 *way, double *far)
{
    const fl_part *p = s->part;
    const fl_tri t = p->t[(int)fl_rng_in(g, 0, p->nt)];
    const int first = (int)fl_rng_in(g, 0, 3);
    const int32_t v[3] = {t.v[first], t.v[(first + 1) % 3], t.v[(first + 2) % 3]};
    const double kind = (p->nt < 50 ? 0.4 : 1.0) * fl_rng_unit(g);
    double a = fl_rng_unit(g), b = fl_rng_unit(g);
    *far = RADIUS * pow(10.0, fl_rng_in(g, -2, 2));
    *way = kind < 0.33 ? away_from_corner(p, v[0], g) : shape_direction(g);
    if (kind < 0.33) a = b = 0.0;
    else if (kind < 0.66) b = 0.0;
    if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
    const fl_vec3 o = p->v[v[0]];
    return v3_madd(v3_madd(o, a, v3_sub(p->v[v[1]], o)), b, v3_sub(p->v[v[2]], o));
}

static fl_vec3 point_near(const structure *s, fl_rng *g)
{
    double far;
    fl_vec3 way;
    const fl_vec3 x = point_on(s, g, &way, &far);
    return v3_madd(x, far, way);
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

static void a_point_is_inside_where_cgal_and_the_winding_number_say_so(void **state)
{
    (void)state;
    long wrong = 0, inside = 0;
    for (int k = 0; k < HULLS; k++) {
        structure s;
        begin(&s, k);
        const long points = test_times(POINTS + TRIANGLE_POINTS / s.part->nt);
        for (long c = 0; c < points && s.closed; c++) {
            fl_rng g = fl_rng_of(test_seed(), 1000000000LL * k + c, FL_RNG_TEST);
            const fl_vec3 x = point_near(&s, &g);
            const int in = is_inside(&s, x);
            inside += in;
            if (fl_mesh_contact_contains(s.piece, v3_sub(x, s.piece->x)) == in &&
                (hull_winding(s.part, x) > 0.5) == in)
                continue;
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
    fl_vec3 way;
    const fl_vec3 x = point_on(s, g, &way, &far), back = q_rotate(q_conj(q), v3_neg(way));
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

/* One floe in so many is also measured by brute force. */
enum { BRUTE_EVERY = 4 };

/* Returns 0, or 1 and says what is wrong. */
static int check_floe(const structure *s, const fl_poly *core, long core_number, fl_patch_points *w,
                      fl_mesh_contact_work *near, seen *n, char *why)
{
    const double d = exact_distance(s, core), size = s->piece->core.size + core->size;
    fl_feature_pairs l = {0};
    double distance, most = -INFINITY, deepest = 0.0;
    fl_gap gap;
    int wrong = 0;
    assert_int_equal(fl_patch_points_transform(w, core, q_matrix(q_one()), v3_neg(s->piece->x)), 0);
    assert_int_equal(fl_mesh_contact_points(w, near, core, s->piece, RADIUS, 2.0 * RADIUS, &l, &distance), 0);
    for (int32_t k = 0; k < w->n; k++) most = fmax(most, w->point[k].overlap);
    const int in = s->closed && d > 0.0 && is_inside(s, core->v[0]);
    for (int32_t v = 0; v < core->nv; v++)
        if (s->closed && is_inside(s, core->v[v]))
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
        if (!wrong && core_number % BRUTE_EVERY == 0 &&
            fabs(hull_distance(s->part, core) - d) > PLANE_TOL * size)
            wrong = sprintf(why, "a distance of %g by brute force, of %g by CGAL",
                            hull_distance(s->part, core), d);
    } else if (d > 0.0) {
        n->enclosed++;
        if (d < 1.9 * RADIUS && (!found || fabs(gap.d + d) > PLANE_TOL * size))
            wrong = sprintf(why, "a gap of %g instead of %g inside", gap.d, -d);
    } else {
        n->pierced++;
        if (s->closed && w->n == 0) wrong = sprintf(why, "no contact where they meet");
        else if (s->closed && most > 2.0 * RADIUS + deepest + PLANE_TOL * size)
            wrong = sprintf(why, "%g deep, and no corner is deeper than %g", most, deepest);
    }
    if (wrong == 0 && distance > fmax(RADIUS, d + PLANE_TOL * size))
        wrong = sprintf(why, "bound %g of %g", distance, d);
    fl_mesh_under_face_free_pairs(&l);
    return wrong != 0;
}

static void a_floe_is_as_far_from_a_structure_as_cgal_finds(void **state)
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
            if (check_floe(&s, &core, c, &w, &near, &n, why) && here++ < 3)
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

/* Spheres have a law of their own. On a closed mesh one touches if its centre is within the radius of the
 * surface or inside by less, with the overlap of the signed distance. */
static void a_sphere_overlaps_by_its_signed_distance(void **state)
{
    (void)state;
    fl_patch_points w = {0};
    fl_mesh_contact_work near = {0};
    fl_poly point = {0};
    fl_err err = {0};
    long wrong = 0, touching = 0;
    const int32_t none[1] = {0};
    assert_int_equal(fl_poly_make(&point, 1, (fl_vec3[]){{0, 0, 0}}, 0, none, none, &err), 0);
    for (int k = 0; k < HULLS; k++) {
        structure s;
        begin(&s, k);
        assert_int_equal(fl_structure_prepare_spheres(&s.st, &err), 0);
        for (long c = 0; c < test_times(POINTS) && s.closed; c++) {
            fl_rng g = fl_rng_of(test_seed(), 30000 * k + c, FL_RNG_TEST);
            const fl_vec3 x = point_near(&s, &g);
            const double away = hull_point_distance(s.part, x), same = PLANE_TOL * s.piece->core.size,
                         d = hull_winding(s.part, x) > 0.5 ? -away : away;
            fl_feature_pairs l = {0};
            double distance, most = -INFINITY;
            assert_int_equal(fl_patch_points_transform(&w, &point, q_matrix(q_one()), v3_sub(x, s.piece->x)),
                             0);
            assert_int_equal(fl_mesh_contact_sphere(&w, &near, s.piece, RADIUS, &l, &distance), 0);
            for (int32_t i = 0; i < w.n; i++) most = fmax(most, w.point[i].overlap);
            fl_mesh_under_face_free_pairs(&l);
            touching += w.n > 0;
            if (fabs(away - RADIUS) < same || away < same) continue;
            const int touches = away < RADIUS;
            if (touches == (w.n > 0) && (!touches || fabs(most - (RADIUS - d)) <= same)) continue;
            if (!wrong++)
                print_error("seed %llu: %s %d, sphere %ld: overlap %g at a distance of %g\n",
                            (unsigned long long)test_seed(), hull_name(k), k, c, most, d);
        }
        end(&s);
    }
    fl_poly_free(&point);
    fl_patch_points_free(&w);
    fl_mesh_contact_work_free(&near);
    assert_int_equal(wrong, 0);
    assert_true(touching > HULLS * test_times(POINTS) / 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_is_inside_once_or_not_at_all),
        cmocka_unit_test(a_point_is_inside_where_cgal_and_the_winding_number_say_so),
        cmocka_unit_test(a_sphere_overlaps_by_its_signed_distance),
        cmocka_unit_test(a_floe_is_as_far_from_a_structure_as_cgal_finds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
