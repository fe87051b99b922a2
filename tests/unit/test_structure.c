/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/pi.h"
#include "support/near.h"
#include <math.h>
#include <string.h>
#include "structure/structure.h"
#include "geom/facet.h"
#include "geom/mass.h"
#include "support/small_world.h"
#include "support/shapes.h"

static fl_structure build_structure(const fl_surface *s)
{
    fl_structure st = {0};
    fl_err err = {0};
    if (fl_structure_build(&st, s, &err)) fail_msg("%s", err.text);
    return st;
}

static fl_part *new_part(fl_surface *s)
{
    fl_err err = {0};
    const int32_t k = fl_surface_add(s, "part", 4, &err);
    assert_true(k >= 0);
    return &s->part[k];
}

static void add_vertex(fl_part *p, double x, double y, double z)
{
    fl_err err = {0};
    assert_int_equal(fl_surface_vertex(p, v3(x, y, z), &err), 0);
}

static void add_triangle(fl_part *p, int32_t a, int32_t b, int32_t c)
{
    fl_err err = {0};
    assert_int_equal(fl_surface_triangle(p, a, b, c, &err), 0);
}

static double volume(const fl_poly *p)
{
    fl_mass m;
    fl_err err = {0};
    assert_int_equal(fl_mass_of(&m, p, 0.0, &err), 0);
    return m.volume;
}

static void a_box_is_one_solid_for_any_mesh(void **state)
{
    (void)state;
    for (int n = 1; n <= 64; n *= 4) {
        lab l;
        lab_start(&l);
        lab_wall(&l, v3(-1, 2, 3), v3(2, 4, 8), n);
        fl_structure st = build_structure(&l.surface);
        assert_int_equal(l.surface.part[0].nt, 12 * n * n);
        assert_int_equal(st.n, 1);
        const fl_piece *q = &st.piece[0];
        assert_int_equal(q->kind, FL_PIECE_SOLID);
        assert_int_equal(q->part, 0);
        assert_int_equal(q->core.nf, 6);
        assert_int_equal(q->core.nv, 8);
        assert_near(volume(&q->core), 30.0, 1e-14);
        assert_near_of(v3_norm(v3_sub(q->x, v3(0.5, 3, 5.5))), 0.0, 1e-15, 5.0);
        fl_structure_free(&st);
        lab_free(&l);
    }
}

/* As read from a mesh file: rotated, translated, and with every coordinate rounded to 32 bits. */
static void through_floats(fl_surface *s, fl_quat q, fl_vec3 o)
{
    for (int32_t v = 0; v < s->part[0].nv; v++) {
        fl_vec3 *x = &s->part[0].v[v];
        const fl_vec3 y = v3_add(o, q_rotate(q, *x));
        *x = v3((double)(float)y.x, (double)(float)y.y, (double)(float)y.z);
    }
}

static void rounded_coordinates_give_the_same_solid(void **state)
{
    (void)state;
    for (int k = 0; k < test_times(40); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        lab l;
        lab_start(&l);
        int32_t faces = 6, vertices = 8;
        double whole = 24.0;
        if (k % 4 == 0) lab_wall(&l, v3(-1, -1.5, -2), v3(1, 1.5, 2), 1 + k % 7);
        else { /* a prism of 3, 5, ... sides */ const int n = 1 + 2 * (k % 4) + 4 * (k % 5);
            fl_vec3 xy[64];
            for (int c = 0; c < n; c++)
                xy[c] = v3(cos(6.283185307179586 * c / n), sin(6.283185307179586 * c / n), 0);
            lab_prism(&l, n, xy, -0.5, 0.5);
            faces = n + 2;
            vertices = 2 * n;
            whole = 0.5 * n * sin(6.283185307179586 / n);
        }
        through_floats(&l.surface, shape_rotation(&g), v3_scale(fl_rng_in(&g, 0, 3), shape_direction(&g)));
        fl_structure st = build_structure(&l.surface);
        assert_int_equal(st.piece[0].kind, FL_PIECE_SOLID);
        assert_int_equal(st.piece[0].core.nf, faces);
        assert_int_equal(st.piece[0].core.nv, vertices);
        assert_near(volume(&st.piece[0].core), whole, 1e-6);
        fl_structure_free(&st);
        lab_free(&l);
    }
}

/* The plane of one of 20 000 triangles with rounded corners departs from a wide wall by more than the
 * tolerance: the fitted plane must follow the wall. */
static void a_wide_wall_of_small_rounded_triangles_is_flat(void **state)
{
    (void)state;
    for (int n = 50; n <= 100; n += 50) {
        lab l;
        lab_start(&l);
        lab_wall(&l, v3(-3, -3, -1), v3(3, 3, 1), n);
        through_floats(&l.surface, q_of_vector(v3(0.3, 0.5, -0.2)), v3(0, 0, 0));
        fl_structure st = build_structure(&l.surface);
        assert_int_equal(st.piece[0].kind, FL_PIECE_SOLID);
        assert_int_equal(st.piece[0].core.nf, 6);
        assert_int_equal(st.piece[0].core.nv, 8);
        assert_near(volume(&st.piece[0].core), 72.0, 1e-6);
        fl_structure_free(&st);
        lab_free(&l);
    }
}

/* A slightly curved surface is not one face: 8000 sides bend by less than a flat face may. */
static void a_fine_cylinder_stays_round(void **state)
{
    (void)state;
    enum { SIDES = 8000 };
    static fl_vec3 xy[SIDES];
    lab l;
    lab_start(&l);
    for (int c = 0; c < SIDES; c++)
        xy[c] = v3(cos(6.283185307179586 * c / SIDES), sin(6.283185307179586 * c / SIDES), 0);
    lab_prism(&l, SIDES, xy, -1, 1);
    fl_structure st = build_structure(&l.surface);
    assert_int_equal(st.piece[0].kind, FL_PIECE_SOLID);
    assert_true(st.piece[0].core.nf > 500);
    assert_near(volume(&st.piece[0].core), 2 * PI, 1e-5);
    fl_structure_free(&st);
    lab_free(&l);
}

/* Where five faces meet in a rounded vertex they no longer meet in one point. Small edges may appear there,
 * but no face, and no volume. */
static void a_rounded_icosahedron_keeps_its_faces(void **state)
{
    (void)state;
    for (int k = 0; k < 20; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_surface s = {0};
        fl_poly p = {0};
        fl_part *part = new_part(&s);
        shape_regular(&p, 20, 2.0);
        for (int32_t v = 0; v < p.nv; v++) add_vertex(part, p.v[v].x, p.v[v].y, p.v[v].z);
        for (int32_t f = 0; f < p.nf; f++)
            add_triangle(part, p.loop[3 * f], p.loop[3 * f + 1], p.loop[3 * f + 2]);
        through_floats(&s, shape_rotation(&g), v3(1, 2, 3));
        fl_structure st = build_structure(&s);
        assert_int_equal(st.piece[0].kind, FL_PIECE_SOLID);
        assert_int_equal(st.piece[0].core.nf, 20);
        assert_near(volume(&st.piece[0].core), volume(&p), 1e-6);
        fl_structure_free(&st);
        fl_surface_free(&s);
        fl_poly_free(&p);
    }
}

/* An open flat rectangle of n by n squares is a plate with four corners; one with a notch is a shell. */
static void flat_open_parts_are_plates(void **state)
{
    (void)state;
    for (int n = 1; n <= 16; n *= 4) {
        fl_surface s = {0};
        fl_part *p = new_part(&s);
        for (int i = 0; i <= n; i++)
            for (int j = 0; j <= n; j++) add_vertex(p, 3.0 * i / n, 0.1 * i / n, 2.0 * j / n);
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                const int32_t a = i * (n + 1) + j, b = a + n + 1;
                add_triangle(p, a, b, b + 1);
                add_triangle(p, a, b + 1, a + 1);
            }
        }
        fl_structure st = build_structure(&s);
        assert_int_equal(st.piece[0].kind, FL_PIECE_SOLID);
        assert_int_equal(st.piece[0].core.nf, 2);
        assert_int_equal(st.piece[0].core.nv, 4);
        assert_near(v3_norm(fl_poly_face_area_vector(&st.piece[0].core, 0)), 2.0 * sqrt(9.01), 1e-12);
        fl_structure_free(&st);
        fl_surface_free(&s);
    }
    fl_surface s = {0};
    fl_part *p = new_part(&s);
    const double xy[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    const int32_t loop[6] = {0, 1, 2, 3, 4, 5};
    fl_err err = {0};
    for (int k = 0; k < 6; k++) add_vertex(p, xy[k][0], xy[k][1], 0.0);
    assert_int_equal(fl_facet_polygon(p, 6, loop, &err), 0);
    fl_structure st = build_structure(&s);
    assert_int_equal(st.piece[0].kind, FL_PIECE_MESH);
    assert_int_equal(st.piece[0].core.ne, 6);
    assert_int_equal(st.piece[0].mesh.corners, 6);
    assert_true(st.piece[0].one_sided);
    fl_structure_free(&st);
    fl_surface_free(&s);
}

/* A square with a vertex on the diagonal, with a duplicate triangle, with its back, with a triangle without
 * area, with one corner as two vertices; and one with a hole. */
static void a_sheet_is_defined_by_its_area(void **state)
{
    (void)state;
    for (int what = 0; what < 7; what++) {
        fl_surface s = {0};
        fl_part *p = new_part(&s);
        add_vertex(p, 0, 0, 1), add_vertex(p, 2, 0, 1), add_vertex(p, 2, 2, 1), add_vertex(p, 0, 2, 1),
            add_vertex(p, 1, 1, 1);
        if (what == 5) add_vertex(p, 2, 2, 1);
        add_triangle(p, 0, 1, 2);
        if (what == 0) add_triangle(p, 0, 4, 3), add_triangle(p, 4, 2, 3);
        else if (what == 5) add_triangle(p, 0, 5, 3);
        else if (what < 6) add_triangle(p, 0, 2, 3);
        else add_triangle(p, 4, 2, 3);
        if (what == 1) add_triangle(p, 2, 3, 0);
        if (what == 2) add_triangle(p, 1, 0, 2), add_triangle(p, 2, 0, 3);
        if (what == 3) add_triangle(p, 0, 4, 2);
        if (what == 4) add_triangle(p, 1, 0, 2);
        fl_structure st = build_structure(&s);
        /* a back of one triangle is half a back, and a square without a quarter is not a plate */
        const int plate = what != 4 && what != 6;
        assert_int_equal(st.piece[0].kind, plate ? FL_PIECE_SOLID : FL_PIECE_MESH);
        assert_int_equal(st.piece[0].one_sided, !plate);
        if (plate) assert_int_equal(st.piece[0].core.nv, 4);
        if (plate) assert_near(v3_norm(fl_poly_face_area_vector(&st.piece[0].core, 0)), 4.0, 1e-14);
        fl_structure_free(&st);
        fl_surface_free(&s);
    }
}

static void a_non_convex_body_is_a_shell_without_seams(void **state)
{
    (void)state;
    lab l;
    const fl_vec3 xy[6] = {v3(0, 0, 0), v3(2, 0, 0), v3(2, 1, 0), v3(1, 1, 0), v3(1, 2, 0), v3(0, 2, 0)};
    lab_start(&l);
    lab_prism(&l, 6, xy, 0, 1);
    fl_structure st = build_structure(&l.surface);
    const fl_piece *q = &st.piece[0];
    assert_int_equal(q->kind, FL_PIECE_MESH);
    assert_int_equal(q->core.nf, 6 + 2 * 2); /* the L in two */
    assert_int_equal(q->core.ne, 18);        /* of the solid: 6 + 6 + 6, none inside a face */
    assert_int_equal(q->mesh.corners, 12);
    fl_structure_free(&st);
    lab_free(&l);
}

/* A box without its lid, an inverted one, and two boxes in one part. */
static void open_or_several_bodies_are_a_shell(void **state)
{
    (void)state;
    for (int what = 0; what < 3; what++) {
        fl_surface s = {0};
        fl_err err = {0};
        fl_part *p = new_part(&s);
        assert_int_equal(fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err), 0);
        int32_t edges = 12, corners = 8, faces = 6;
        if (what == 0) p->nt -= 2, faces = 5;
        if (what == 1) {
            for (int32_t t = 0; t < p->nt; t++) {
                const int32_t a = p->t[t].v[0];
                p->t[t].v[0] = p->t[t].v[1];
                p->t[t].v[1] = a;
            }
        }
        if (what == 2) {
            assert_int_equal(fl_facet_box(p, v3(3, 0, 0), v3(4, 1, 1), &err), 0);
            edges = 24, corners = 16, faces = 12;
        }
        fl_structure st = build_structure(&s);
        assert_int_equal(st.n, 1);
        assert_int_equal(st.piece[0].kind, FL_PIECE_MESH);
        assert_int_equal(st.piece[0].core.nf, faces);
        assert_int_equal(st.piece[0].core.ne, edges);
        assert_int_equal(st.piece[0].mesh.corners, corners);
        fl_structure_free(&st);
        fl_surface_free(&s);
    }
}

static void reverse_triangle(fl_part *p, int32_t t)
{
    const int32_t a = p->t[t].v[0];
    p->t[t].v[0] = p->t[t].v[1], p->t[t].v[1] = a;
}

/* A box with and without its lid, and a square, each with one reversed triangle; a duplicate at a border is
 * not reversed. */
static void inconsistent_orientation_is_refused(void **state)
{
    (void)state;
    for (int what = 0; what < 4; what++) {
        fl_surface s = {0};
        fl_structure st = {0};
        fl_err err = {0};
        fl_part *p = new_part(&s);
        if (what == 2) {
            add_vertex(p, 0, 0, 0), add_vertex(p, 1, 0, 0), add_vertex(p, 1, 1, 0), add_vertex(p, 0, 1, 0);
            add_triangle(p, 0, 1, 2), add_triangle(p, 0, 3, 2);
        } else {
            assert_int_equal(fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err), 0);
            if (what) p->nt -= 2;
            if (what == 3) add_triangle(p, p->t[9].v[0], p->t[9].v[1], p->t[9].v[2]);
            else reverse_triangle(p, 5);
        }
        if (what == 1) p->line = 11, p->last_line = 20; /* one row behind the other */
        const int refused = what < 3;
        assert_int_equal(fl_structure_build(&st, &s, &err), -refused);
        assert_int_equal(err.code, refused ? FL_INPUT : 0);
        if (what == 2) assert_non_null(strstr(err.text, "part part: its triangles 0 and 1 share"));
        if (what == 1) assert_non_null(strstr(err.text, "part part: its triangles of lines 1"));
        if (refused) assert_non_null(strstr(err.text, "share an edge and face different ways"));
        fl_structure_free(&st);
        fl_surface_free(&s);
    }
}

/* The enclosed volume of a closed part shows its orientation, at any position. */
static void an_inverted_closed_part_is_reported(void **state)
{
    (void)state;
    for (int inward = 0; inward < 2; inward++) {
        lab l;
        const fl_vec3 xy[6] = {v3(2, 1e3, 0),  v3(4, 1e3, 0),  v3(4, 1001, 0),
                               v3(3, 1001, 0), v3(3, 1002, 0), v3(2, 1002, 0)};
        lab_start(&l);
        lab_prism(&l, 6, xy, 0, 1);
        for (int32_t t = 0; inward && t < l.surface.part[0].nt; t++) reverse_triangle(&l.surface.part[0], t);
        fl_structure st = build_structure(&l.surface);
        assert_int_equal(st.piece[0].kind, FL_PIECE_MESH);
        assert_int_equal(st.piece[0].inward_triangle, inward);
        fl_structure_free(&st);
        lab_free(&l);
    }
}

/* So does that of one of several bodies of a part, whatever the others enclose. */
static void an_inverted_body_among_others_is_reported(void **state)
{
    (void)state;
    for (int inward = 0; inward < 2; inward++) {
        fl_surface s = {0};
        fl_part *p = new_part(&s);
        for (int32_t k = 0; k < 2; k++) {
            const double x = 10.0 * k, size = k ? 1.0 : 2.0;
            const int32_t o = 4 * k, b = k && inward ? 3 : 2, c = 5 - b;
            add_vertex(p, x, 0, 0), add_vertex(p, x + size, 0, 0), add_vertex(p, x, size, 0),
                add_vertex(p, x, 0, size);
            add_triangle(p, o, o + b, o + 1), add_triangle(p, o, o + 1, o + c);
            add_triangle(p, o, o + c, o + b), add_triangle(p, o + 1, o + b, o + c);
        }
        fl_structure st = build_structure(&s);
        assert_int_equal(st.piece[0].kind, FL_PIECE_MESH);
        assert_int_equal(st.piece[0].inward_triangle, inward ? 5 : 0); /* from its fifth triangle on */
        fl_structure_free(&st);
        fl_surface_free(&s);
    }
}

static void triangles_without_area_do_no_harm(void **state)
{
    (void)state;
    fl_surface s = {0};
    fl_err err = {0};
    fl_part *p = new_part(&s);
    /* a tetrahedron with a vertex in the middle of an edge, connected by a triangle without area */
    add_vertex(p, 0, 0, 0), add_vertex(p, 1, 0, 0), add_vertex(p, 0, 1, 0), add_vertex(p, 0, 0, 1),
        add_vertex(p, 0.5, 0, 0);
    add_triangle(p, 0, 2, 1);
    add_triangle(p, 0, 4, 3);
    add_triangle(p, 4, 1, 3);
    add_triangle(p, 0, 1, 4);
    add_triangle(p, 1, 2, 3);
    add_triangle(p, 0, 3, 2);
    fl_structure st = build_structure(&s);
    assert_int_equal(st.piece[0].kind, FL_PIECE_SOLID);
    assert_int_equal(st.piece[0].core.nf, 4);
    assert_int_equal(st.piece[0].core.nv, 4);
    assert_near(volume(&st.piece[0].core), 1.0 / 6.0, 1e-14);
    fl_structure_free(&st);
    fl_surface_free(&s);

    p = new_part(&s);
    add_vertex(p, 0, 0, 0), add_vertex(p, 1, 0, 0), add_vertex(p, 2, 0, 0);
    add_triangle(p, 0, 1, 2);
    add_triangle(p, 0, 0, 1);
    assert_int_equal(fl_structure_build(&st, &s, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, "part part: its triangles have no area");
    fl_structure_free(&st);
    fl_surface_free(&s);
}

static void cones_have_the_section_of_the_circle(void **state)
{
    (void)state;
    const fl_cone c[3] = {{v3(1, 2, -3), v3(1, 2, 4), 1.5, 1.5},
                          {v3(0, 0, 0), v3(1, 1, 1), 2.0, 0.5},
                          {v3(0, 0, 0), v3(0, 3, 0), 0.0, 1.0}};
    for (int k = 0; k < 3; k++) {
        fl_surface s = {0};
        fl_err err = {0};
        assert_int_equal(fl_surface_cone(new_part(&s), c[k], &err), 0);
        fl_structure st = build_structure(&s);
        const fl_piece *q = &st.piece[0];
        const double h = v3_norm(v3_sub(c[k].p1, c[k].p0)), r0 = c[k].r0, r1 = c[k].r1;
        assert_int_equal(st.n, 1);
        assert_int_equal(q->kind, FL_PIECE_CONE);
        assert_int_equal(q->core.nf, FL_CONE_SIDES + (r0 > 0) + (r1 > 0));
        assert_near(volume(&q->core), PI / 3 * h * (r0 * r0 + r0 * r1 + r1 * r1), 1e-13);
        assert_near(q->h, h, 1e-15);
        const fl_vec3 top = v3_add(q->x, q_rotate(q->q, v3(0, 0, h)));
        assert_near_of(v3_norm(v3_sub(top, c[k].p1)), 0.0, 1e-15, 10.0);
        fl_structure_free(&st);
        fl_surface_free(&s);
    }
}

static void a_part_may_mix_triangles_and_cones_or_be_empty(void **state)
{
    (void)state;
    fl_surface s = {0};
    fl_err err = {0};
    new_part(&s);
    fl_part *p = new_part(&s);
    assert_int_equal(fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err), 0);
    for (int k = 0; k < 2; k++)
        assert_int_equal(fl_surface_cone(p, (fl_cone){v3(2, 0, 0), v3(2, 0, 1), 0.1, 0.1}, &err), 0);
    fl_structure st = build_structure(&s);
    assert_int_equal(st.n, 3);
    for (int k = 0; k < 3; k++) assert_int_equal(st.piece[k].part, 1);
    assert_int_equal(st.piece[0].kind, FL_PIECE_SOLID);
    assert_int_equal(st.piece[2].kind, FL_PIECE_CONE);
    fl_structure_free(&st);
    assert_int_equal(st.n, 0);
    fl_structure_free(&st);
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_one_solid_for_any_mesh),
        cmocka_unit_test(rounded_coordinates_give_the_same_solid),
        cmocka_unit_test(a_wide_wall_of_small_rounded_triangles_is_flat),
        cmocka_unit_test(a_fine_cylinder_stays_round),
        cmocka_unit_test(a_rounded_icosahedron_keeps_its_faces),
        cmocka_unit_test(flat_open_parts_are_plates),
        cmocka_unit_test(a_sheet_is_defined_by_its_area),
        cmocka_unit_test(a_non_convex_body_is_a_shell_without_seams),
        cmocka_unit_test(open_or_several_bodies_are_a_shell),
        cmocka_unit_test(inconsistent_orientation_is_refused),
        cmocka_unit_test(an_inverted_closed_part_is_reported),
        cmocka_unit_test(an_inverted_body_among_others_is_reported),
        cmocka_unit_test(triangles_without_area_do_no_harm),
        cmocka_unit_test(cones_have_the_section_of_the_circle),
        cmocka_unit_test(a_part_may_mix_triangles_and_cones_or_be_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
