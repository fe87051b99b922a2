/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decks of members and panels of hulls: files made by hand, each with its answer in closed form. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "geom/weld.h"
#include "mesh/beam_deck.h"
#include "support/decks.h"

static const double ANSWER = 1e-8; /* of its size: digits of the answers that came with the files */

static void near_answer(const char *what, double x, double is)
{
    if (fabs(x - is) > ANSWER * fmax(fabs(is), 1.0)) fail_msg("%s is %.12g, %.12g is expected", what, x, is);
}

/* Reads a file of a corpus. */
static fl_mesh_quality read_corpus(const char *path)
{
    char whole[200];
    fl_mesh_quality q;
    clear(NULL);
    snprintf(whole, sizeof whole, "tests/fuzz/%s", path);
    if (fl_mesh_read(&s, whole, NULL, note, &err)) fail_msg("%s: %s", path, err.text);
    assert_int_equal(fl_surface_measure(&s, &q, &err), 0);
    return q;
}

static void corpus_refuses(const char *path, const char *why)
{
    char whole[200];
    clear(NULL);
    snprintf(whole, sizeof whole, "tests/fuzz/%s", path);
    assert_int_equal(fl_mesh_read(&s, whole, NULL, note, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    if (!strstr(err.text, why)) fail_msg("\"%s\" is not in \"%s\"", why, err.text);
}

static const fl_part *part_named(const char *name)
{
    for (int32_t i = 0; i < s.n; i++)
        if (strcmp(s.part[i].name, name) == 0) return &s.part[i];
    fail_msg("no part is called %s", name);
    return NULL;
}

static double cone_length(void)
{
    double sum = 0.0;
    for (int32_t i = 0; i < s.n; i++)
        for (int32_t c = 0; c < s.part[i].nc; c++)
            sum += v3_norm(v3_sub(s.part[i].cone[c].p1, s.part[i].cone[c].p0));
    return sum;
}

static double cone_volume(void)
{
    double sum = 0.0;
    for (int32_t i = 0; i < s.n; i++)
        for (int32_t c = 0; c < s.part[i].nc; c++) {
            const fl_cone *k = &s.part[i].cone[c];
            sum += acos(-1.0) / 3.0 * v3_norm(v3_sub(k->p1, k->p0)) *
                   (k->r0 * k->r0 + k->r0 * k->r1 + k->r1 * k->r1);
        }
    return sum;
}

static double triangle_area(const fl_part *p)
{
    double sum = 0.0;
    for (int32_t t = 0; t < p->nt; t++) {
        const fl_vec3 a = p->v[p->t[t].v[0]];
        sum += 0.5 * v3_norm(v3_cross(v3_sub(p->v[p->t[t].v[1]], a), v3_sub(p->v[p->t[t].v[2]], a)));
    }
    return sum;
}

/* Integral of z n_z over the triangles. */
static double hull_volume(const fl_part *p)
{
    double sum = 0.0;
    for (int32_t t = 0; t < p->nt; t++) {
        const fl_vec3 a = p->v[p->t[t].v[0]], b = p->v[p->t[t].v[1]], c = p->v[p->t[t].v[2]];
        sum += v3_cross(v3_sub(b, a), v3_sub(c, a)).z * (a.z + b.z + c.z) / 6.0;
    }
    return sum;
}

static void check_members(const char *path, int cones, double length, double volume)
{
    const fl_mesh_quality q = read_corpus(path);
    assert_int_equal(q.cones, cones);
    near_answer("length", cone_length(), length);
    near_answer("volume", cone_volume(), volume);
}

static void check_part(const char *name, int cones, int triangles)
{
    const fl_part *p = part_named(name);
    if (p->nc != cones || p->nt != triangles)
        fail_msg("%s has %d cones and %d triangles, %d and %d are expected", name, p->nc, p->nt, cones,
                 triangles);
}

/* --- members -------------------------------------------------------------------------------------------- */

static void openfast_has_its_members(void **state)
{
    (void)state;
    check_members("openfast/good_subdyn_old", 4, 40.0001, 1022.06764);
    check_part("D_6", 2, 0);
    check_part("cones", 2, 0);
    says("5 nodes");
    check_members("openfast/good_subdyn", 3, 106.0, 3559.42448);
    check_part("Main_column", 1, 0);
    check_part("cones", 1, 0);
    check_part("tower", 1, 0);
    check_part("10x5", 0, 12);
    const fl_aabb box = fl_part_aabb(part_named("10x5"));
    assert_true(box.lo.x == 0.0 && box.hi.x == 30.0 && box.lo.y == -5.0 && box.hi.y == 5.0);
    assert_true(box.lo.z == -22.5 && box.hi.z == -17.5);
    says("rigid link 1, cable 1");
    check_members("openfast/good_hydrodyn", 2, 23.5, 915.854107);
    const fl_aabb foot = fl_part_aabb(part_named("8x8"));
    near_answer("width of the turned square", foot.hi.x - foot.lo.x, 8.0 * sqrt(2.0));
    near_answer("lowest", fl_surface_aabb(&s).lo.z, -61.5);
    near_answer("highest", fl_surface_aabb(&s).hi.z, 10.0);
    check_part("Upper_column", 1, 0);
    check_part("cones", 1, 0);
    says("moved by -1.5");
    says("marine growth is not added");
}

static void sesam_has_its_members_and_plates(void **state)
{
    (void)state;
    check_members("sesam/good_leg", 4, 43.5, 165.06975);
    check_part("LEG_A", 2, 0);
    check_part("ALL", 2, 6);
    near_answer("area", triangle_area(part_named("ALL")), 12.0);
    says("24 nodes");
    says("type 11 1, GIORH 1");
    const fl_mesh_quality q = read_corpus("sesam/good_solids");
    near_answer("volume", q.volume, 18.0);
    near_answer("area", q.area, 43.6568542);
    assert_true(q.closed);
    corpus_refuses("sesam/bad_assembly",
                   ":4: an assembly of superelements (GELMNT2): read its first-level files");
}

static void usfos_and_sacs_have_their_members(void **state)
{
    (void)state;
    check_members("usfos/good_frame", 3, 53.5, 122.019459);
    check_part("LEG_1", 2, 0);
    check_part("FRAME", 1, 0);
    near_answer("area", triangle_area(part_named("plates")), 144.0);
    says("IHPROFIL 1, GENBEAM 1");
    check_members("sacs/good_frame", 7, 88.0, 72.3639688);
    check_part("LG1", 1, 0);
    check_part("SEG", 3, 0);
    near_answer("area", triangle_area(part_named("plates")), 30.0);
    says("9 nodes");
    says("member of a joint that is not there 1, member with a WF section 1");
}

static void genie_has_its_beams(void **state)
{
    (void)state;
    check_members("genie/good_leg", 3, 30.0, 26.3056025);
    check_part("Leg_1", 3, 0);
    says("i_section 1");
    says("1 plates lie in ACIS geometry: export the FEM file from GeniE");
}

/* A cube of second order on a plate, in two groups; nodes go round each face. */
static void unv_has_its_shells_and_solids(void **state)
{
    (void)state;
    read_corpus("unv/good_cube");
    assert_int_equal(s.n, 2);
    near_answer("volume", hull_volume(part_named("CUBE")), 8.0);
    near_answer("plate", triangle_area(part_named("PLATE")), 4.0);
    check_part("CUBE", 0, 12);
    says("hex20 1");
    says("beam type 21 1");
    says("largest sagitta is 0 in");
    refuses("    -1\n  2411\n 1 1 1 11\n 0 0 x\n    -1\n", "deck:4: a coordinate of node 1 is \"x\"");
    refuses("    -1\n  2412\n 1 91 1 1 7 3\n    -1\n", "deck:4: the dataset ends within a record");
    refuses("    -1\n  2412\n 1 91 1 1 7 99\n    -1\n", "deck:3: element 1 has 99 nodes");
}

/* A millimetre between two metres: of a frame its nodes are one, and what holds them goes along. */
static void short_members_join_their_nodes(void **state)
{
    (void)state;
    static const char deck[] = "SubDyn\n4 NJoints\nid x y z\n-\n1 0 0 -9\n2 0 0 -8\n3 0 0 -7.999\n4 0 0 1\n3 "
                               "NMembers\nMemberID a b p q\n-\n"
                               "1 1 2 1 1\n2 2 3 1 1\n3 3 4 1 1\n1 NPropSets\nid YoungE ShearG MatDens XsecD "
                               "XsecT\n-\n1 2e11 8e10 7850 2 .1\n"
                               "1 NReact\nid\n-\n1 1 1 1 1 1 1\n1 NCmass\nid\n-\n3 500\n";
    fl_frame_model f = {0};
    fl_import_options w = {.frame = &f};
    if (read_some(deck, &w)) fail_msg("%s", err.text);
    assert_int_equal(f.element_id.n, 2);
    assert_int_equal(f.element[0].node[1], f.element[1].node[0]);
    near_answer("mass", f.node[f.element[0].node[1]].mass, 500.0);
    assert_int_equal(f.node[f.element[0].node[0]].fixed, 63);
    assert_string_equal(f.skipped_name.name[0],
                        "members shorter than 0.01 of their diameter, whose ends are one node");
    fl_frame_model_free(&f);
}

/* Reads the deck as a frame; freed by the caller. */
static fl_frame_model frame_of(const char *deck)
{
    fl_frame_model f = {0};
    fl_import_options w = {.frame = &f};
    if (read_some(deck, &w)) fail_msg("%s", err.text);
    return f;
}

static void counts_skipped(const fl_frame_model *f, const char *what, int times)
{
    const int32_t at = fl_string_table_find(&f->skipped_name, what);
    if (at < 0 || f->skipped[at] != times) fail_msg("\"%s\" is not counted %d times", what, times);
}

/* Joint 3 is spherical, joint 2 revolute: no end there is clamped, or all are and it is told. */
static void joints_of_subdyn_release_their_members(void **state)
{
    (void)state;
    static const char deck[] =
        "SubDyn\n4 NJoints\nid x y z JointType\n-\n1 0 0 -9 1\n2 0 0 -5 3\n3 0 0 -1 4\n4 3 0 -1 1\n3 "
        "NMembers\n"
        "MemberID a b p q\n-\n1 1 2 1 1\n2 2 3 1 1\n3 3 4 1 1\n1 NPropSets\nid YoungE ShearG MatDens XsecD "
        "XsecT\n-\n1 2e11 8e10 7850 2 .1\n";
    fl_frame_model f = frame_of(deck);
    assert_int_equal(f.element_id.n, 3);
    assert_true(f.element[0].pins[0] == 0 && f.element[0].pins[1] == 0);
    assert_true(f.element[1].pins[0] == 0 && f.element[1].pins[1] == 7);
    assert_true(f.element[2].pins[0] == 7 && f.element[2].pins[1] == 0);
    counts_skipped(&f, "revolute joints (JointType 3), whose members are clamped here", 1);
    fl_frame_model_free(&f);
    refuses("SubDyn\n1 NJoints\nid x y z JointType\n-\n1 0 0 -9 5\n", "deck:5: JointType is 5, 1 to 4 are");
}

/* A beam whose end hangs on two rigid links from a mass: it has an offset from the node of the mass. */
static void rigid_links_of_subdyn_carry_members(void **state)
{
    (void)state;
    static const char deck[] =
        "SubDyn\n4 NJoints\nid x y z\n-\n1 0 0 0\n2 8 0 0\n3 9 0 1\n4 10 0 5\n3 NMembers\n"
        "MemberID a b p q MType\n-\n1 1 2 1 1 1c\n2 2 3 1 1 3\n3 3 4 1 1 3\n1 NPropSets\n"
        "id YoungE ShearG MatDens XsecD XsecT\n-\n1 2e11 8e10 7850 2 .1\n"
        "1 NReact\nid\n-\n1 1 1 1 1 1 1\n1 NCmass\nid\n-\n4 500\n";
    fl_frame_model f = frame_of(deck);
    assert_int_equal(f.element_id.n, 1);
    const fl_frame_element *e = &f.element[0];
    near_answer("z of the node", f.node[e->node[1]].x.z, 5.0);
    near_answer("mass", f.node[e->node[1]].mass, 500.0);
    near_answer("x of the offset", e->offset[1].x, -2.0);
    near_answer("z of the offset", e->offset[1].z, -5.0);
    assert_int_equal(f.node[e->node[0]].fixed, 63);
    assert_true(f.skipped_name.n == 0 && e->offset[0].x == 0.0);
    fl_frame_model_free(&f);
}

/* Columns 23 to 34 of MEMBER: forces and moments that either end releases. */
static void members_of_sacs_are_released(void **state)
{
    (void)state;
    static const char deck[] = "OPTIONS      MN\nGRUP SEG         100.00 2.000 20.008.00034.50"
                               "                                2.0\n"
                               "GRUP SEG          90.00 2.000 20.008.00034.50\n"
                               "MEMBER 00010002 SEG   000011001111\n"
                               "JOINT 0001      0.     0.   -30.\nJOINT 0002      0.     0.     0.\nEND\n";
    fl_frame_model f = frame_of(deck);
    assert_int_equal(f.element_id.n, 2);
    assert_true(f.element[0].pins[0] == 6 && f.element[0].pins[1] == 0);
    assert_true(f.element[1].pins[0] == 0 && f.element[1].pins[1] == 7);
    says("released forces of 1 members are not carried over");
    fl_frame_model_free(&f);
}

/* Ends of members stand off their nodes, and a taper does so at its ends only. */
static void offsets_are_those_of_the_ends(void **state)
{
    (void)state;
    fl_frame_model f = {0};
    fl_import_options w = {.frame = &f};
    assert_int_equal(fl_mesh_read(&s, "tests/fuzz/sacs/good_frame", &w, note, &err), 0);
    for (int32_t k = 0; k < f.element_id.n; k++) {
        const fl_frame_element *e = &f.element[k];
        const int brace = strcmp(f.part_name.name[e->part], "BRC") == 0;
        near_answer("offset of end A", e->offset[0].x, brace ? 0.6 : 0.0);
        near_answer("offset of end B", e->offset[1].x, brace ? -0.4 : 0.0);
    }
    fl_frame_model_free(&f);
    f = frame_of(
        "NODE 1 0 0 -5\nNODE 2 0 0 5\nBEAM 1 1 2 1 1 0 1 2\nPIPE 1 2 .1 0 0 1\nMISOIEP 1 2e11 .3 3e8 7850\n"
        "ECCENT 1 0 1 0\nECCENT 2 0 0 -1\n");
    assert_int_equal(f.element_id.n, FL_BEAM_STEPS);
    for (int k = 0; k < FL_BEAM_STEPS; k++) {
        near_answer("y of the first end", f.element[k].offset[0].y, k == 0);
        near_answer("z of the last end", f.element[k].offset[1].z, k == FL_BEAM_STEPS - 1 ? -1.0 : 0.0);
    }
    const fl_frame_node *n = &f.node[f.element[0].node[1]];
    near_answer("y of a node between the ends", n->x.y, 0.75);
    near_answer("z", n->x.z, -2.75);
    fl_frame_model_free(&f);
}

/* --- panels --------------------------------------------------------------------------------------------- */

static void check_hull(const char *path, const char *name, int panels, int triangles, double hull,
                       double area, int open)
{
    char text[80];
    fl_mesh_quality q;
    fl_weld w;
    read_corpus(path);
    snprintf(text, sizeof text, "%d panels", panels);
    says(text);
    check_part(name, 0, triangles);
    near_answer("hull", hull_volume(&s.part[0]), hull);
    near_answer("area", triangle_area(&s.part[0]), area);
    assert_int_equal(fl_part_weld(&s.part[0], -1.0, &w, &err), 0);
    assert_int_equal(fl_part_measure(&s.part[0], &q, &err), 0);
    assert_int_equal(q.open, open);
    assert_int_equal(q.incoherent, 0);
}

static void hulls_have_their_panels(void **state)
{
    (void)state;
    check_hull("hull_panels/good_gdf", "hull", 24, 40, 480.0, 328.0, 12);
    check_hull("hull_panels/good_nemoh", "hull", 24, 40, 480.0, 328.0, 12);
    check_hull("hull_panels/good_hams", "hull", 24, 40, 72.0, 96.0, 12);
    check_hull("hull_panels/good_hydrostar", "hull", 24, 40, 192.0, 184.0, 12);
    check_hull("hull_panels/good_aqwa", "Barge", 24, 40, 40.0, 68.0, 12);
    says("PMAS (1)");
    check_hull("hull_panels/good_tecplot", "hull", 6, 10, 8.0, 14.0, 8);
    check_hull("hull_panels/good_tecplot_grid", "hull", 2, 4, 0.0, 2.0, 6);
    read_corpus("hull_panels/good_wall");
    near_answer("area", triangle_area(&s.part[0]), 6.0);
    says("4 panels, mirrored in y = 0");
    says("a wall in x = 0, which mirrors nothing");
    says("GRAV 32.174 speaks of feet");
    corpus_refuses("hull_panels/bad_spline", ":4: higher-order geometry (IGDEF 1): save it as flat panels");
}

/* Two structures with nodes of the same numbers. */
static void aqwa_knows_its_structures(void **state)
{
    (void)state;
    static const char deck[] =
        "JOB AQWA  LINE\n          COOR\n      STRC        1\n"
        "     1    1                  0         0        -1\n     1    2                  1         0        "
        "-1\n"
        "     1    3                  0         1        -1\n      STRC        2\n"
        "     2    1                  5         0        -1\n     2    2                  7         0        "
        "-1\n"
        "     2    3                  5         1        -1\n END\n          ELM1      One\n"
        "     1TPPL DIFF   15(1)(    1)(    2)(    3)\n END\n          ELM2      Two\n"
        "     2TPPL        15(1)(    1)(    2)(    3)\n END\n";
    reads(deck);
    assert_int_equal(s.n, 2);
    near_answer("One", triangle_area(part_named("One")), 0.5);
    near_answer("Two", triangle_area(part_named("Two")), 1.0);
    says("1 panels are above the water");
}

/* AQWA says one plane of symmetry of two: that which holds an open rim. */
static void aqwa_finds_its_plane(void **state)
{
    (void)state;
    static const char nodes[] =
        "JOB AQWA  LINE\n          COOR\n     1    1                  0         0        -1\n"
        "     1    2                  2         1        -1\n     1    3                  0         2        "
        "-1\n"
        "     1    4                  1         0        -1\n END\n          ELM1      One\n      SYMX\n";
    char deck[1500];
    snprintf(deck, sizeof deck, "%s     1TPPL DIFF   15(1)(    1)(    2)(    3)\n END\n", nodes);
    reads(deck);
    says("2 panels, mirrored in x = 0");
    snprintf(deck, sizeof deck,
             "%s     1TPPL DIFF   15(1)(    1)(    2)(    3)\n     1TPPL DIFF   15(1)(    1)(    4)(    2)\n "
             "END\n",
             nodes);
    refuses(deck,
            "body One has SYMX, and is open in x = 0 and in y = 0: which plane is meant is not certain");
}

/* A box of four sides, and of triangles and quadrilaterals with lines, which are counted. */
static void salome_has_its_shells(void **state)
{
    (void)state;
    read_corpus("hull_panels/good_salome");
    assert_int_equal(s.part[0].nt, 8);
    near_answer("area", triangle_area(&s.part[0]), 4.0 + 4.0 + 2.0 + 2.0 + 2.0);
    says("elements of type 102 (1)");
}

/* --- bad input ------------------------------------------------------------------------------------------ */

#define SUBDYN(members, sections)                                                                            \
    "SubDyn\n3 NJoints\nid x y z\n- - - -\n1 0 0 -9\n2 0 0 1\n3 0 0 1\n1 NMembers\n"                         \
    "MemberID MJointID1 MJointID2 MPropSetID1 MPropSetID2\n- - - - -\n" members "\n1 NPropSets\n"            \
    "PropSetID YoungE ShearG MatDens XsecD XsecT\n- - - - - -\n" sections "\n"
#define PIPE "1 2e11 8e10 7850 2 0.1"

static void bad_members_are_refused_with_their_line(void **state)
{
    (void)state;
    assert_int_equal(reads(SUBDYN("1 1 2 1 1", PIPE)).cones, 1);
    /* a line of dashes before the title, PropSetID in the line of units */
    const fl_mesh_quality q = reads(
        "-----\n--- SubDyn ---\n2 NJoints\nid x y z\n-\n1 0 0 -9\n2 0 0 1\n1 NMembers\nMemberID a b p q "
        "COSMID\n-\n1 1 2 1 1\n1 NPropSets\n YoungE ShearG MatDens XsecD XsecT\nPropSetID - - - - -\n" PIPE
        "\n");
    near_answer("width", q.box.hi.x, 1.0);
    /* comments that look like keywords of Abaqus do not make a deck of it */
    assert_int_equal(
        reads("*NODE\n*ELEMENT\nCOORDINATES\n1 0 0 0\n2 1 0 0\n3 0 1 0\nENDCOORDINATES\nPANEL TYPE 0\n"
              "1 2 3\nENDPANEL\n")
            .triangles,
        1);
    refuses("HydroDyn\n0 NJoints\nid x y z\n-\n0 NMembers\na\n-\n",
            "no members: a body of potential flow has panels");
    refuses(SUBDYN("1 1 9 1 1", PIPE), "deck:11: member 1 ends at node 9, which is not defined");
    refuses(SUBDYN("1 1 2 1 4", PIPE), "deck:11: member 1 has circular section 4, which is not defined");
    refuses(SUBDYN("1 2 3 1 1", PIPE), "deck:11: member 1 has no length");
    refuses(SUBDYN("1 1 2 1 1", "1 2e11 8e10 7850 -2 0.1"), "deck:15: the diameter is -2, a length above 0");
    refuses(SUBDYN("1 1 2 1 1", "1 2e11 8e10 7850"), "deck:15: the diameter is \"\", a number is expected");
    refuses(SUBDYN("1 1 2 1 1", ""), "deck:15: NPropSets promises 1 rows, and row 1 is empty");
    refuses("NODE 1 0 0 -5\nNODE 2 0 0 5\nBEAM 1 1 2 1 7\nPIPE 1 1 .1\n",
            "deck:3: member 1 has geometry 7, which is not defined");
    refuses("NODE 1 0 0 -5\nNODE 2 0 0 5\nBEAM 1 1 3 1 1\nPIPE 1 1 .1\n", "deck:3: member 1 ends at node 3");
    refuses("NODE 1 0 0 -5\nNODE 2 0 0 -5\nBEAM 1 1 2 1 1\nPIPE 1 1 .1\n", "deck:3: member 1 has no length");
    refuses("NODE 1 0 0 -5\nNODE 2 0 0 5\nBEAM 1 1 2 1 1\nPIPE 1 -1 .1\n",
            "deck:4: PIPE 1 has the diameter -1");
}

#define GNODES                                                                                               \
    "GCOORD    1.00000000E+00  0.00000000E+00  0.00000000E+00 -2.00000000E+01\n"                             \
    "GCOORD    2.00000000E+00  0.00000000E+00  0.00000000E+00 -5.00000000E+00\n"
#define GBEAM(second)                                                                                        \
    "GELMNT1   1.00000000E+00  1.00000000E+00  1.50000000E+01  0.00000000E+00\n"                             \
    "          1.00000000E+00  " second "\n"
#define GREF                                                                                                 \
    "GELREF1   1.00000000E+00  1.00000000E+00  0.00000000E+00  0.00000000E+00\n"                             \
    "          0.00000000E+00  0.00000000E+00  0.00000000E+00  0.00000000E+00\n"                             \
    "          1.00000000E+00  0.00000000E+00  0.00000000E+00  0.00000000E+00\n"
#define GPIPE(outer) "GPIPE     1.00000000E+00  0.00000000E+00  " outer "  5.00000000E-02\n"

static void bad_sesam_is_refused_with_its_line(void **state)
{
    (void)state;
    assert_int_equal(reads(GNODES GBEAM("2.00000000E+00") GREF GPIPE("2.00000000E+00")).cones, 1);
    refuses(GNODES GBEAM("2.00000000E+00") GPIPE("2.00000000E+00"), "deck:3: element 1 has no GELREF1");
    refuses(GNODES GBEAM("2.00000000E+00") GREF, "deck:3: element 1 has section 1, which is not defined");
    refuses(GNODES GBEAM("3.00000000E+00") GREF GPIPE("2.00000000E+00"),
            "deck:3: member 1 ends at node 3, which is not defined");
    refuses(GNODES GBEAM("1.00000000E+00") GREF GPIPE("2.00000000E+00"), "deck:3: member 1 has no length");
    refuses(GNODES GBEAM("2.00000000E+00") GREF GPIPE("-2.0000000E+00"),
            "deck:8: GPIPE 1 has the diameter -2");
    refuses(GNODES GBEAM("2.00x00000E+00") GREF, "deck:4: columns 25 to 40 of GELMNT1 are no number");
}

#define SACS(unit, joints, members)                                                                          \
    "OPTIONS      " unit "\nGRUP LG1         100.00 2.000 20.008.00034.50\n" members joints "END\n"
#define JOINTS "JOINT 0001      0.     0.   -30.\nJOINT 0002      0.     0.     0.\n"

static void sacs_says_its_units(void **state)
{
    (void)state;
    fl_mesh_quality q = reads(SACS("MN", JOINTS, "MEMBER 00010002 LG1\n"));
    near_answer("lowest", q.box.lo.z, -30.0);
    near_answer("width", q.box.hi.x, 0.5);
    q = reads(SACS("EN", JOINTS, "MEMBER 00010002 LG1\n"));
    near_answer("lowest in feet", q.box.lo.z, -30.0 * 0.3048);
    near_answer("width in inches", q.box.hi.x, 50.0 * 0.0254);
    says("were converted to metres");
    refuses(SACS("XX", JOINTS, "MEMBER 00010002 LG1\n"), "deck:1: columns 14 and 15 of OPTIONS are \"XX\"");
    refuses(JOINTS "MEMBER 00010002 LG1\n", "deck:1: no OPTIONS line before it says the units");
    refuses(SACS("MN", JOINTS, "MEMBER 00010002 LG2\n"), "deck:3: member 0001-0002 has group \"LG2\"");
    refuses(SACS("MN", JOINTS, "MEMBER 00010001 LG1\n"), "deck:3: member 0001-0001 has no length");
    refuses("OPTIONS      MN\nGRUP LG1                  \nMEMBER 00010002 LG1\n" JOINTS,
            "deck:2: group LG1 has the diameter 0");
    refuses(SACS("MN", "JOINT 0001      0.     0.   -3x.\n" JOINTS, "MEMBER 00010002 LG1\n"),
            "deck:4: columns 26 to 32 are \"-3x.\"");
}

static void bad_panels_are_refused_with_their_line(void **state)
{
    (void)state;
    refuses("t\n1 9.8\n1 0\n1\n-1 0 0\n-1 0 -1\n1 0 -1\n1 0 0\n",
            "deck:8: the panel reaches from x = -1 to 1, through the plane of symmetry");
    refuses("t\n1 9.8\n0 1\n2\n0 1 0\n0 1 -1\n1 1 -1\n1 1 0\n0 -1 0\n0 -1 -1\n1 -1 -1\n1 -1 0\n",
            "deck:12: the panel lies on the other side of the plane of symmetry y = 0");
    refuses("t\n1 9.8\n0 0\n2\n0 0 0 0 0 -1 1 0 -1 1 0 0\n",
            "NPAN promises 2 panels, the file ends in panel 2");
    refuses("t\n-1 9.8\n2\na.gdf\n", "deck:2: ULEN -1: a list of bodies");
    refuses("2 0\n1 0 0 0\n2 1 0 0\n0 0 0 0\n1 2 3 3\n0 0 0 0\n",
            "deck:5: the panel has node 3, which is not");
    refuses("2 0 9 9\n1 0 0 0\n0 0 0 0\n", "deck:1: a mesh of the free surface");
    refuses("3 0 9 9\n", "unknown format");
    refuses("VARIABLES = \"X\" \"Y\"\nZONE I=2 J=2\n0 0\n", "deck:2: VARIABLES names 2 columns");
    refuses("VARIABLES = X Y Z\nZONE N=3 E=1 ET=TRIANGLE\n0 0 0\n1 0 0\n0 1 0\n1 2 4\n",
            "deck:6: the element has node 4 of 3");
    refuses("COORDINATES\n1 0 0 0\nENDCOORDINATES\nPANEL TYPE 0\n1 2 3\nENDPANEL\n",
            "deck:5: the panel has node 2, which is not defined");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(openfast_has_its_members, setup, clear),
        cmocka_unit_test_setup_teardown(sesam_has_its_members_and_plates, setup, clear),
        cmocka_unit_test_setup_teardown(usfos_and_sacs_have_their_members, setup, clear),
        cmocka_unit_test_setup_teardown(genie_has_its_beams, setup, clear),
        cmocka_unit_test_setup_teardown(unv_has_its_shells_and_solids, setup, clear),
        cmocka_unit_test_setup_teardown(short_members_join_their_nodes, setup, clear),
        cmocka_unit_test_setup_teardown(joints_of_subdyn_release_their_members, setup, clear),
        cmocka_unit_test_setup_teardown(rigid_links_of_subdyn_carry_members, setup, clear),
        cmocka_unit_test_setup_teardown(members_of_sacs_are_released, setup, clear),
        cmocka_unit_test_setup_teardown(offsets_are_those_of_the_ends, setup, clear),
        cmocka_unit_test_setup_teardown(hulls_have_their_panels, setup, clear),
        cmocka_unit_test_setup_teardown(aqwa_knows_its_structures, setup, clear),
        cmocka_unit_test_setup_teardown(aqwa_finds_its_plane, setup, clear),
        cmocka_unit_test_setup_teardown(salome_has_its_shells, setup, clear),
        cmocka_unit_test_setup_teardown(bad_members_are_refused_with_their_line, setup, clear),
        cmocka_unit_test_setup_teardown(bad_sesam_is_refused_with_its_line, setup, clear),
        cmocka_unit_test_setup_teardown(sacs_says_its_units, setup, clear),
        cmocka_unit_test_setup_teardown(bad_panels_are_refused_with_their_line, setup, clear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
