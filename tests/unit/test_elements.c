/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "geom/mesh_patch.h"
#include "geom/weld.h"
#include "mesh/element_surface.h"
#include "mesh/skin.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;
static fl_elements e;
static fl_surface s;
static fl_bytes b;

static int begin_elements(void **state)
{
    (void)state;
    fl_elements_free(&e);
    fl_surface_free(&s);
    err = (fl_err){0};
    b = (fl_bytes){0};
    return fl_elements_start(&e, "test.inp", &err);
}

static int end_elements(void **state)
{
    (void)state;
    fl_elements_free(&e);
    fl_surface_free(&s);
    return 0;
}

static int32_t add_part(const char *name) { return fl_string_table_add(&e.parts, name, &err); }

static void add_node(int64_t id, double x, double y, double z)
{
    assert_true(fl_elements_add_node(&e, 0, id, v3(x, y, z), &err) >= 0);
}

/* Adds an element of the nodes that follow, numbered in the order of the text. */
static int32_t add_element(int64_t id, enum fl_shape shape, int32_t p, const int64_t *n)
{
    const int32_t k = fl_elements_add(&e, 0, id, shape, p, n, &err);
    assert_true(k >= 0);
    return k;
}

static fl_mesh_quality build_surface(fl_import_options *w)
{
    fl_mesh_quality q = {0};
    if (fl_elements_surface(&e, &s, &b, w, &err)) fail_msg("%s", err.text);
    assert_true(mesh_sound(&s));
    assert_int_equal(fl_surface_measure(&s, &q, &err), 0);
    return q;
}

/* --- the solid shapes ----------------------------------------------------------------------------------- */

/* Corners of the unit cube, and of the wedge, the pyramid and the tetrahedron in it. */
static const double HEX[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const double WEDGE[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
static const double PYRAMID[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
static const double TET[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const int TET_MID[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
static const int PYRAMID_MID[8][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};
static const int WEDGE_MID[9][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
static const int HEX_MID[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                   {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

static const struct solid {
    enum fl_shape linear, quadratic;
    const double (*x)[3];
    const int (*mid)[2];
    double volume;
    int triangles, pieces; /* area of the surface; with --subdivide */
} SOLID[] = {{FL_TET4, FL_TET10, TET, TET_MID, 1.0 / 6.0, 4, 16},
             {FL_PYRAMID5, FL_PYRAMID13, PYRAMID, PYRAMID_MID, 1.0 / 3.0, 6, 22},
             {FL_WEDGE6, FL_WEDGE15, WEDGE, WEDGE_MID, 0.5, 8, 26},
             {FL_HEX8, FL_HEX20, HEX, HEX_MID, 1.0, 12, 36}};
enum { SOLIDS = sizeof SOLID / sizeof *SOLID };

/* Nodes 10, 20, ... of a solid, mirrored in x if mirror is -1; straight edges. */
static void put_solid(const struct solid *k, enum fl_shape shape, double mirror)
{
    const int corners = fl_shape_corners(shape), n = fl_shape_nodes(shape);
    int64_t id[20];
    for (int i = 0; i < n; i++) id[i] = 10 * (i + 1);
    for (int i = 0; i < corners; i++) add_node(id[i], mirror * k->x[i][0], k->x[i][1], k->x[i][2]);
    for (int i = corners; i < n; i++) {
        const double *p = k->x[k->mid[i - corners][0]], *q = k->x[k->mid[i - corners][1]];
        add_node(id[i], mirror * (p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2);
    }
    add_element(1, shape, add_part("solid"), id);
}

/* Each solid, of either handedness, with straight edges, subdivided at its mid-side nodes or not: closed,
 * outward, and its volume to rounding. */
static void solids_are_closed_and_oriented_outward(void **state)
{
    for (int k = 0; k < SOLIDS; k++)
        for (int way = 0; way < 8; way++) {
            const enum fl_shape shape = way & 1 ? SOLID[k].quadratic : SOLID[k].linear;
            const int pieces = (way & 5) == 5;
            fl_import_options w = {.subdivide = way & 4};
            fl_mesh_quality q;
            assert_int_equal(begin_elements(state), 0);
            put_solid(&SOLID[k], shape, way & 2 ? -1.0 : 1.0);
            q = build_surface(&w);
            assert_int_equal(q.triangles, pieces ? SOLID[k].pieces : SOLID[k].triangles);
            assert_true(q.closed && q.open == 0 && q.incoherent == 0 && q.branched == 0);
            assert_near(q.volume, SOLID[k].volume, 1e-15);
            assert_int_equal(strstr(b.note, "left-handed") != NULL, (way & 2) != 0);
            assert_int_equal(strstr(b.note, "mid-side") != NULL, (way & 5) == 1);
            end_elements(state);
        }
    begin_elements(state);
}

/* Each face of each solid has the corners between which its mid-side nodes lie, and each edge has a mid-side
 * node. */
static void faces_list_the_edges(void **state)
{
    (void)state;
    for (int k = 0; k < SOLIDS; k++) {
        int used[20] = {0}, c[4];
        const int corners = fl_shape_corners(SOLID[k].linear);
        const int edges = fl_shape_nodes(SOLID[k].quadratic) - corners;
        for (int f = 0; f < fl_shape_faces(SOLID[k].linear); f++) {
            const int n = fl_shape_face(SOLID[k].quadratic, f, c);
            for (int i = 0; i < n; i++)
                for (int m = 0; m < edges; m++) {
                    const int *p = SOLID[k].mid[m], a = c[i], z = c[(i + 1) % n];
                    used[m] += (p[0] == a && p[1] == z) || (p[0] == z && p[1] == a);
                }
        }
        for (int m = 0; m < edges; m++) assert_int_equal(used[m], 2);
    }
}

/* A hexahedron with repeated nodes is the wedge, pyramid or tetrahedron that remains. */
static void collapsed_solids_are_what_is_left(void **state)
{
    static const struct {
        int64_t n[8];
        double volume;
        int triangles;
    } row[] = {
        {{1, 2, 3, 3, 5, 6, 7, 7}, 0.5, 8},       /* wedge */
        {{1, 2, 3, 4, 5, 5, 5, 5}, 1.0 / 3.0, 6}, /* pyramid */
        {{1, 2, 3, 3, 5, 5, 5, 5}, 1.0 / 6.0, 4}, /* tetrahedron */
        {{1, 2, 2, 1, 5, 6, 7, 8}, 0.5, 8},       /* wedge of a collapsed side */
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        fl_mesh_quality q;
        assert_int_equal(begin_elements(state), 0);
        for (int i = 0; i < 8; i++) add_node(i + 1, HEX[i][0], HEX[i][1], HEX[i][2]);
        add_element(1, FL_HEX8, add_part("p"), row[k].n);
        q = build_surface(NULL);
        assert_int_equal(q.triangles, row[k].triangles);
        assert_true(q.closed);
        assert_near(q.volume, row[k].volume, 1e-15);
        end_elements(state);
    }
    begin_elements(state);
}

/* --- many elements -------------------------------------------------------------------------------------- */

/* A block of nx by ny by nz cubes in parts a (the lower half in x) and b. */
static void add_block(int nx, int ny, int nz)
{
    int64_t id = 0;
    for (int k = 0; k <= nz; k++)
        for (int j = 0; j <= ny; j++)
            for (int i = 0; i <= nx; i++) add_node(1 + i + (nx + 1) * (j + (ny + 1) * k), i, j, k);
    for (int k = 0; k < nz; k++)
        for (int j = 0; j < ny; j++)
            for (int i = 0; i < nx; i++) {
                const int64_t o = 1 + i + (nx + 1) * (j + (ny + 1) * k), up = (nx + 1) * (ny + 1);
                const int64_t n[8] = {o,      o + 1,      o + nx + 2,      o + nx + 1,
                                      o + up, o + up + 1, o + up + nx + 2, o + up + nx + 1};
                add_element(++id, FL_HEX8, add_part(2 * i < nx ? "a" : "b"), n);
            }
}

static void faces_between_solids_are_interior(void **state)
{
    (void)state;
    fl_mesh_quality q, one;
    add_block(4, 3, 5);
    q = build_surface(NULL);
    assert_int_equal(q.triangles, 4 * (4 * 3 + 3 * 5 + 4 * 5));
    assert_int_equal(s.n, 2);
    assert_int_equal(fl_part_measure(&s.part[0], &one, &err), 0);
    assert_int_equal(one.triangles, 2 * (3 * 5 + 2 * 2 * 3 + 2 * 2 * 5));
    assert_false(one.closed);
    /* one body is closed when its parts are taken together */
    for (int32_t t = 0; t < s.part[1].nt; t++) {
        fl_tri *x = &s.part[1].t[t];
        assert_int_equal(fl_surface_triangle(&s.part[0], x->v[0] + s.part[0].nv, x->v[1] + s.part[0].nv,
                                             x->v[2] + s.part[0].nv, &err),
                         0);
    }
    for (int32_t v = 0; v < s.part[1].nv; v++) fl_surface_vertex(&s.part[0], s.part[1].v[v], &err);
    fl_weld w;
    assert_int_equal(fl_part_weld(&s.part[0], 0.0, &w, &err), 0);
    assert_int_equal(fl_part_measure(&s.part[0], &one, &err), 0);
    assert_true(one.closed);
    assert_near(one.volume, 60.0, 1e-14);
}

/* A part taken alone also has the faces that the other part would cover. */
static void a_part_taken_alone_is_closed(void **state)
{
    (void)state;
    const char *const pattern[] = {"B"};
    char matches[1] = {0};
    fl_import_options w = {.pattern = pattern, .patterns = 1, .matched = matches};
    fl_mesh_quality q;
    add_block(4, 3, 5);
    q = build_surface(&w);
    assert_int_equal(s.n, 1);
    assert_string_equal(s.part[0].name, "b");
    assert_true(q.closed && matches[0]);
    assert_near(q.volume, 30.0, 1e-14);
}

/* A set takes its elements out of their parts: whole elements, single faces, free faces. */
static void only_selected_sets_become_parts(void **state)
{
    const char *const all[] = {"*"}, *const face[] = {"side"}, *const skin[] = {"skin", "a"};
    fl_import_options w = {.pattern = all, .patterns = 1};
    fl_mesh_quality q;
    for (int way = 0; way < 4; way++) {
        int32_t side, shell, top;
        assert_int_equal(begin_elements(state), 0);
        add_block(2, 2, 2);
        side = fl_string_table_add(&e.sets, "side", &err);
        shell = fl_string_table_add(&e.sets, "skin", &err);
        top = fl_string_table_add(&e.sets, "top", &err);
        for (int32_t k = 0; k < 8; k++) {
            assert_int_equal(fl_elements_pick(&e, (fl_pick){k, shell, FL_PICK_FREE, 0}, &err), 0);
            if (k >= 4) fl_elements_pick(&e, (fl_pick){k, top, FL_PICK_WHOLE, 0}, &err);
            if (k % 2 == 0) fl_elements_pick(&e, (fl_pick){k, side, 5, 0}, &err); /* x = 0 */
        }
        assert_int_equal(fl_elements_pick(&e, (fl_pick){0, side, 6, 0}, &err), 0); /* no such face */
        w.pattern = way == 2 ? face : way == 3 ? skin : all;
        w.patterns = way == 3 ? 2 : 1;
        q = build_surface(way ? &w : NULL);
        if (way == 0) { /* not selected: parts only */
            assert_int_equal(s.n, 2);
            assert_int_equal(q.triangles, 48);
        } else if (way ==
                   1) { /* each face once: side first, then the rest of the skin; nothing is left for top */
            assert_int_equal(q.triangles, 48);
            assert_int_equal(s.n, 2);
            assert_string_equal(s.part[0].name, "side");
            assert_int_equal(s.part[0].nt, 8);
            assert_string_equal(s.part[1].name, "skin");
            assert_int_equal(s.part[1].nt, 40);
        } else if (way == 2) {
            assert_int_equal(q.triangles, 8);
            assert_near(q.area, 4.0, 1e-15);
            for (int32_t t = 0; t < 8; t++) { /* oriented out of the solid */
                const fl_vec3 *x = s.part[0].v;
                const int32_t *v = s.part[0].t[t].v;
                assert_true(v3_cross(v3_sub(x[v[1]], x[v[0]]), v3_sub(x[v[2]], x[v[0]])).x < 0.0);
            }
        } else { /* a alone has a face at x = 1 that no set took and that is no free face of the whole */
            assert_int_equal(q.triangles, 48 + 8);
        }
        end_elements(state);
    }
    begin_elements(state);
}

/* Duplicate elements of a file count once, in the part of the first: solids of either handedness, shells and
 * lines. A set of the second one's faces takes those of the first. */
static void duplicate_elements_count_once(void **state)
{
    const char *const all[] = {"*"}, *const second[] = {"b"};
    const int64_t hex[8] = {1, 2, 3, 4, 5, 6, 7, 8}, turned[8] = {5, 6, 7, 8, 1, 2, 3, 4};
    for (int way = 0; way < 3; way++) {
        fl_import_options w = {.pattern = way == 1 ? all : second, .patterns = 1};
        fl_mesh_quality q;
        int32_t set;
        assert_int_equal(begin_elements(state), 0);
        for (int i = 0; i < 8; i++) add_node(i + 1, HEX[i][0], HEX[i][1], HEX[i][2]);
        add_node(9, 3, 0, 0);
        add_node(10, 3, 1, 0);
        add_node(11, 3, 0, 1);
        add_element(1, FL_HEX8, add_part("a"), hex);
        add_element(2, FL_HEX8, add_part("b"), turned);
        add_element(3, FL_TRI3, add_part("a"), (const int64_t[]){9, 10, 11});
        add_element(4, FL_TRI3, add_part("b"), (const int64_t[]){11, 9, 10});
        for (int k = 0; k < 3; k++) { /* two of one radius, and one of another */
            const int32_t l =
                add_element(5 + k, FL_LINE2, add_part("b"), (const int64_t[]){1 + k % 2, 2 - k % 2});
            fl_elements_set_radius(&e, l, k < 2 ? 0.5 : 0.6, 0.5, &err);
        }
        set = fl_string_table_add(&e.sets, "top", &err);
        for (int k = 0; k < 2; k++)
            assert_int_equal(fl_elements_pick(&e, (fl_pick){k, set, k == 0, 0}, &err), 0); /* z = 1 */
        q = build_surface(way ? &w : NULL);
        assert_int_equal(q.cones, 2);
        assert_int_equal(q.triangles, 13);
        assert_int_equal(s.n, way == 0 ? 2 : way == 1 ? 3 : 1);
        assert_non_null(strstr(b.note, way < 2 ? "3 elements on the nodes of others" : "1 elements"));
        if (way == 0) {
            assert_int_equal(s.part[0].duplicates, 2);
            assert_int_equal(s.part[1].duplicates, 1);
            assert_int_equal(s.part[0].nt, 13);
        }
        if (way == 1) assert_int_equal(s.part[2].nt, 2);
        end_elements(state);
    }
    begin_elements(state);
}

/* Shells on the faces of a solid are left out; when parts are chosen by name the face goes to the shell's
 * part. The face is oriented out of the solid, whatever the shell's own side. */
static void shells_on_solids_add_no_second_face(void **state)
{
    const char *const all[] = {"*"}, *const skin[] = {"skin"};
    for (int way = 0; way < 3; way++) {
        fl_import_options w = {.pattern = way == 1 ? all : skin, .patterns = 1};
        fl_mesh_quality q;
        assert_int_equal(begin_elements(state), 0);
        add_block(2, 1, 1);
        add_element(101, FL_QUAD4, add_part("skin"),
                    (const int64_t[]){1, 4, 10, 7}); /* x = 0, wound inward */
        add_element(102, FL_QUAD4, add_part("skin"), (const int64_t[]){1, 7, 10, 4}); /* again, outward */
        add_element(103, FL_QUAD4, add_part("skin"),
                    (const int64_t[]){2, 5, 11, 8});                            /* between the two cubes */
        add_element(104, FL_TRI3, add_part("fin"), (const int64_t[]){3, 6, 7}); /* on no face */
        q = build_surface(way ? &w : NULL);
        if (way == 0) {
            assert_int_equal(q.triangles, 21);
            assert_int_equal(s.n, 3);
            assert_non_null(strstr(b.note, "2 shells lie on faces of solids, which are there already"));
            assert_non_null(strstr(b.note, "--part gives such faces"));
            assert_non_null(strstr(b.note, "1 shells lie between two solids"));
            assert_int_equal(s.part[0].duplicates, 2);
        } else {
            const fl_part *p = &s.part[way == 1 ? 2 : 0];
            assert_string_equal(p->name, "skin");
            assert_int_equal(p->nt, way == 1 ? 2 : 4);
            assert_int_equal(q.triangles, way == 1 ? 21 : 4);
            for (int32_t t = 0; t < p->nt; t++) {
                const fl_vec3 *x = p->v;
                const int32_t *v = p->t[t].v;
                if (x[v[0]].x == 0.0)
                    assert_true(v3_cross(v3_sub(x[v[1]], x[v[0]]), v3_sub(x[v[2]], x[v[0]])).x < 0.0);
            }
        }
        end_elements(state);
    }
    begin_elements(state);
}

/* --- shells and lines ----------------------------------------------------------------------------------- */

static void shells_keep_their_side(void **state)
{
    const char *const pattern[] = {"under"};
    for (int behind = 0; behind < 2; behind++) {
        fl_import_options w = {.pattern = pattern, .patterns = 1};
        int32_t k, v[3];
        assert_int_equal(begin_elements(state), 0);
        add_node(5, 0, 0, 0);
        add_node(6, 2, 0, 0);
        add_node(7, 2, 1, 0);
        add_node(8, 0, 1, 0);
        k = add_element(1, FL_QUAD4, add_part("plate"), (const int64_t[]){5, 6, 7, 8});
        fl_elements_pick(&e, (fl_pick){k, fl_string_table_add(&e.sets, "under", &err), 0, 1}, &err);
        assert_int_equal(build_surface(behind ? &w : NULL).triangles, 2);
        assert_string_equal(s.part[0].name, behind ? "under" : "plate");
        for (int t = 0; t < 2; t++) {
            const fl_vec3 *x = s.part[0].v;
            memcpy(v, s.part[0].t[t].v, sizeof v);
            assert_near(v3_cross(v3_sub(x[v[1]], x[v[0]]), v3_sub(x[v[2]], x[v[0]])).z, behind ? -2.0 : 2.0,
                        0.0);
        }
        end_elements(state);
    }
    begin_elements(state);
}

/* The diagonal does not depend on where an element's list starts or on its direction: with equal diagonals it
 * passes through the lowest number. */
static void quadrilaterals_are_split_by_node_numbers(void **state)
{
    for (int way = 0; way < 8; way++) {
        static const int64_t id[4] = {40, 10, 30, 20};
        static const double x[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        int64_t n[4];
        assert_int_equal(begin_elements(state), 0);
        for (int i = 0; i < 4; i++) add_node(id[i], x[i][0], x[i][1], 0);
        for (int i = 0; i < 4; i++) n[i] = id[(way & 4 ? way + 4 - i : way + i) & 3];
        add_element(1, FL_QUAD4, add_part("p"), n);
        build_surface(NULL);
        for (int t = 0; t < 2; t++) { /* both triangles have (1, 0), node 10, and (0, 1), node 20 */
            int seen = 0;
            for (int i = 0; i < 3; i++) {
                const fl_vec3 v = s.part[0].v[s.part[0].t[t].v[i]];
                seen |= v.x > v.y ? 1 : v.y > v.x ? 2 : 0;
            }
            assert_int_equal(seen, 3);
        }
        end_elements(state);
    }
    begin_elements(state);
}

/* Second-order shells: 4, 6 and 8 triangles; one mid-side node missing; the sagitta in the remark. */
static void curved_shells_are_subdivided(void **state)
{
    static const int64_t full[9] = {1, 2, 3, 4, 5, 6, 7, 8, 9}, some[9] = {1, 2, 3, 4, 5, 0, 7, 8, 9};
    const struct {
        enum fl_shape shape;
        const int64_t *n;
        int triangles;
    } row[] = {{FL_TRI6, (const int64_t[]){1, 2, 3, 5, 6, 10}, 4},
               {FL_QUAD8, full, 6},
               {FL_QUAD9, full, 8},
               {FL_QUAD8, some, 5},
               {FL_QUAD9, some, 5},
               {FL_QUAD8, (const int64_t[]){1, 2, 3, 3, 5, 6, 0, 10}, 4}}; /* collapsed to a triangle */
    for (int k = 0; k < 6; k++)
        for (int fine = 0; fine < 2; fine++) {
            fl_import_options w = {.subdivide = fine};
            fl_mesh_quality q;
            assert_int_equal(begin_elements(state), 0);
            for (int i = 0; i < 4; i++) add_node(1 + i, HEX[i][0], HEX[i][1], 0);
            add_node(5, 0.5, 0, 0.125);
            add_node(6, 1, 0.5, 0);
            add_node(7, 0.5, 1, 0.125);
            add_node(8, 0, 0.5, 0);
            add_node(9, 0.5, 0.5, 0.125);
            add_node(10, 0.5, 0.5, 0);
            add_element(1, row[k].shape, add_part("p"), row[k].n);
            q = build_surface(&w);
            assert_int_equal(q.triangles, fine ? row[k].triangles : k == 0 || k == 5 ? 1 : 2);
            if (fine) assert_true(q.area > 0.5 && q.patches == 1 && q.incoherent == 0);
            else
                assert_non_null(
                    strstr(b.note, "1 faces and lines were left out, the largest sagitta is 0.125"));
            end_elements(state);
        }
    begin_elements(state);
}

static void lines_become_cones(void **state)
{
    (void)state;
    const int64_t n[3] = {1, 2, 3};
    fl_import_options w = {.subdivide = 1};
    const int32_t p = add_part("legs");
    add_node(1, 0, 0, 0);
    add_node(2, 0, 0, 4);
    add_node(3, 1, 0, 2);
    assert_int_equal(fl_elements_set_radius(&e, add_element(1, FL_LINE2, p, n), 0.5, 0.5, &err), 0);
    assert_int_equal(fl_elements_set_radius(&e, add_element(2, FL_LINE3, p, n), 0.5, 0.25, &err), 0);
    add_element(3, FL_LINE2, p, n); /* without a section */
    assert_int_equal(
        fl_elements_set_radius(&e, add_element(4, FL_LINE2, p, (const int64_t[]){1, 1}), 1, 1, &err), 0);
    build_surface(&w);
    assert_int_equal(s.part[0].nc, 3);
    assert_near(s.part[0].cone[1].r1, 0.375, 0.0);
    assert_near(s.part[0].cone[2].p0.x, 1.0, 0.0);
    assert_near(s.part[0].cone[2].r1, 0.25, 0.0);
    assert_non_null(strstr(b.note, "2 lines without a section radius or a length"));
}

/* --- numbers, scopes, complaints ------------------------------------------------------------------------ */

static void scopes_separate_equal_numbers(void **state)
{
    (void)state;
    const int64_t n[3] = {1, 2, 3};
    for (int scope = 0; scope < 2; scope++) {
        for (int i = 0; i < 3; i++)
            assert_true(fl_elements_add_node(&e, scope, i + 1, v3(TET[i][0], TET[i][1], scope), &err) >= 0);
        assert_int_equal(fl_elements_add(&e, scope, 1, FL_TRI3, add_part("p"), n, &err), scope);
    }
    assert_int_equal(fl_elements_add(&e, 0, -1, FL_TRI3, add_part("p"), n, &err), 2); /* without a number */
    assert_int_equal(fl_elements_add(&e, 0, -1, FL_TRI3, add_part("p"), n, &err), 3);
    assert_int_equal(build_surface(NULL).triangles, 4);
    assert_non_null(strstr(b.note, "6 nodes; elements: tri3 4"));
}

/* A node may come after its element. A repeated node counts once and is reported. */
static void later_lines_win_and_are_reported(void **state)
{
    (void)state;
    const int64_t n[3] = {1, 2, 3}, m[3] = {3, 2, 1};
    add_element(7, FL_TRI3, add_part("p"), n);
    for (int i = 0; i < 3; i++) add_node(i + 1, TET[i][0], TET[i][1], 0);
    add_node(1, 0, 0, 0);  /* identical repetition is ignored */
    add_node(1, -1, 0, 0); /* moved */
    add_element(7, FL_TRI3, add_part("p"), m);
    assert_near(build_surface(NULL).area, 1.0, 1e-15);
    assert_non_null(strstr(b.note, "1 nodes were moved"));
    assert_non_null(strstr(b.note, "1 elements were replaced"));
}

static void complaints_name_file_and_line(void **state)
{
    (void)state;
    const int64_t n[3] = {1, 2, 99}, zero[3] = {1, 0, 2};
    e.line = 4;
    add_node(1, 0, 0, 0);
    assert_int_equal(fl_elements_add_node(&e, 0, 2, v3(0, NAN, 0), &err), -1);
    assert_string_equal(err.text, "test.inp:4: node 2 is at 0 nan 0, finite coordinates are expected");
    err = (fl_err){0};
    e.line = 5;
    assert_int_equal(fl_elements_add(&e, 0, 1, FL_TRI3, add_part("p"), zero, &err), -1);
    assert_string_equal(err.text,
                        "test.inp:5: corner 2 of the element is node 0, a number of 1 or more is expected");
    err = (fl_err){0};
    add_node(2, 1, 0, 0);
    assert_int_equal(fl_elements_set_file(&e, "more.inp", &err), 0);
    e.line = 12;
    add_element(1, FL_TRI3, add_part("p"), n);
    e.line = 20;
    assert_int_equal(fl_elements_surface(&e, &s, &b, NULL, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text, "more.inp:12: the element refers to node 99, which is not defined");
}

static void skipped_elements_are_reported(void **state)
{
    (void)state;
    const int64_t flat[8] = {1, 2, 3, 4, 1, 2, 3, 4}, hex[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    for (int i = 0; i < 8; i++) add_node(i + 1, HEX[i][0], HEX[i][1], HEX[i][2]);
    for (int k = 0; k < 3; k++) assert_int_equal(fl_elements_skip(&e, "SPRING1", &err), 0);
    assert_int_equal(fl_elements_skip(&e, "MASS", &err), 0);
    for (int k = 0; k < 3; k++) { /* wedges on one face, with other nodes elsewhere */
        const int64_t wedge[6] = {1, 2, 3, 11 + 3 * k, 12 + 3 * k, 13 + 3 * k};
        for (int i = 0; i < 3; i++) add_node(wedge[3 + i], HEX[i][0], HEX[i][1], k ? k : -1);
        add_element(k + 1, FL_WEDGE6, add_part("p"), wedge);
    }
    add_element(9, FL_HEX8, add_part("p"), flat);
    add_element(10, FL_TRI3, add_part("p"), hex + 3);
    assert_int_equal(build_surface(NULL).triangles, 3 * 7 + 1);
    assert_non_null(strstr(b.note, "without a surface, skipped: SPRING1 3, MASS 1"));
    assert_non_null(strstr(b.note, "1 solids have no volume"));
    assert_non_null(strstr(b.note, "1 faces belong to three or more solids"));
}

/* Each failing allocation is reported, and nothing is lost or freed twice. */
static void allocation_failure_is_reported(void **state)
{
    const char *const pattern[] = {"*"};
    int rc = -1;
    end_elements(state);
    for (long fail = 0; rc; fail++) {
        fl_import_options w = {.pattern = pattern, .patterns = 1, .subdivide = 1};
        err = (fl_err){0};
        fl_alloc_fail_after(fail);
        rc = begin_elements(state);
        for (int i = 0; rc == 0 && i < 8; i++)
            rc = fl_elements_add_node(&e, 0, i + 1, v3(HEX[i][0], HEX[i][1], HEX[i][2]), &err) < 0;
        if (rc == 0) {
            const int64_t n[8] = {1, 2, 3, 4, 5, 6, 7, 8};
            const int32_t p = fl_string_table_add(&e.parts, "p", &err),
                          set = fl_string_table_add(&e.sets, "t", &err);
            const int32_t k = p < 0 || set < 0 ? -1 : fl_elements_add(&e, 0, 1, FL_HEX8, p, n, &err);
            const int32_t l = k < 0 ? -1 : fl_elements_add(&e, 0, 2, FL_LINE2, p, n, &err);
            rc = l < 0 || fl_elements_set_radius(&e, l, 1, 1, &err) || fl_elements_skip(&e, "X", &err) ||
                 fl_elements_pick(&e, (fl_pick){k, set, FL_PICK_FREE, 0}, &err) ||
                 fl_elements_surface(&e, &s, &b, &w, &err);
        }
        fl_alloc_fail_after(-1);
        assert_int_equal(rc ? FL_SYSTEM : 0, err.code);
        if (rc) end_elements(state);
        assert_true(fail < 500);
    }
    assert_int_equal(s.n, 2);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, begin_elements, end_elements)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(solids_are_closed_and_oriented_outward),
        TEST(faces_list_the_edges),
        TEST(collapsed_solids_are_what_is_left),
        TEST(faces_between_solids_are_interior),
        TEST(a_part_taken_alone_is_closed),
        TEST(only_selected_sets_become_parts),
        TEST(duplicate_elements_count_once),
        TEST(shells_on_solids_add_no_second_face),
        TEST(shells_keep_their_side),
        TEST(quadrilaterals_are_split_by_node_numbers),
        TEST(curved_shells_are_subdivided),
        TEST(lines_become_cones),
        TEST(scopes_separate_equal_numbers),
        TEST(later_lines_win_and_are_reported),
        TEST(complaints_name_file_and_line),
        TEST(skipped_elements_are_reported),
        TEST(allocation_failure_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
