/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "geom/moments.h"
#include "support/decks.h"

static fl_aabb bounding_box(void) { return fl_surface_aabb(&s); }

#define NODES                                                                                                \
    "NBLOCK,6,SOLID\n(3i8,6e20.13)\n"                                                                        \
    "       1       0       0 0.0000000000000E+00 0.0000000000000E+00 0.0000000000000E+00\n"                 \
    "       2       0       0 2.0000000000000E+00\n"                                                         \
    "       3       0       0 2.0000000000000E+00 1.0000000000000E+00\n"                                     \
    "       4       0       0 0.0000000000000E+00 1.0000000000000E+00\n"                                     \
    "       5       0       0 0.0000000000000E+00 0.0000000000000E+00 3.0000000000000E+00\n"                 \
    "       6       0       0 2.0000000000000E+00 0.0000000000000E+00 3.0000000000000E+00\n"                 \
    "       7       0       0 2.0000000000000E+00 1.0000000000000E+00 3.0000000000000E+00\n"                 \
    "       8       0       0 0.0000000000000E+00 1.0000000000000E+00 3.0000000000000E+00\n"                 \
    "N,R5.3,LOC,       -1,\n"
#define HEX                                                                                                  \
    "EBLOCK,19,SOLID\n(19i4)\n"                                                                              \
    "   1   1   1   1   0   0   0   0   8   0   9   1   2   3   4   5   6   7   8\n"                         \
    "  -1\n"

/* Rows are divided at their columns: numbers adjoin, have exponents of three digits, or are short. */
static void fields_follow_the_format_line(void **state)
{
    (void)state;
    reads("ET,1,SHELL181\n"
          "NBLOCK,6,SOLID,     4,     4\n(1i7,2i9,6e21.13e3)\n"
          "      1        0        0 0.0000000000000E+000-5.0000000000000E-001-1.2500000000000E+002\n"
          "      2        0        0-1.0000000000000E+000-5.0000000000000E-001-1.2500000000000E+002\n"
          "      3        0        0-1.0000000000000E+000             -6.01203-1.2500000000000D+002\n"
          "1234567        0        0                 1.+1\n"
          "       -1\n"
          "EBLOCK,19,SOLID,         2,         2\n(19i7)\n"
          "      1      1      1      1      0      0      0      0      4      0      1      1      2      "
          "31234567\n"
          "     -1\n");
    assert_int_equal(s.n, 1);
    assert_int_equal(s.part[0].nt, 2);
    assert_true(bounding_box().lo.y == -6.01203 && bounding_box().lo.z == -125.0 &&
                bounding_box().hi.x == 10.0 && bounding_box().hi.z == 0.0);
}

static void line_ends_may_be_of_any_kind(void **state)
{
    static const char text[] = "et,1,185\n" NODES HEX;
    char crlf[2 * sizeof text];
    size_t n = 0;
    (void)state;
    for (size_t k = 0; k < sizeof text; k++) {
        if (text[k] == '\n') crlf[n++] = '\r';
        crlf[n++] = text[k];
    }
    reads(crlf);
    assert_int_equal(s.part[0].nt, 12);
    assert_near(bounding_box().hi.z, 3.0, 0.0);
}

/* An element belongs to the smallest component that holds it; ranges end with a negative number. */
static void components_are_parts(void **state)
{
    static const char text[] = "ET,1,63\n" NODES "EBLOCK,19,SOLID\n(19i4)\n"
                               "   1   1   1   1   0   0   0   0   4   0  10   1   2   3   4\n"
                               "   1   1   1   1   0   0   0   0   4   0  11   5   6   7   8\n"
                               "   1   1   1   1   0   0   0   0   4   0  12   1   2   6   5\n"
                               "   1   1   1   1   0   0   0   0   4   0  14   3   4   8   7\n"
                               "   1   1   1   1   0   0   0   0   4   0  20   1   4   8   5\n"
                               "  -1\n"
                               "CMBLOCK,ALL_OF_IT,ELEM,       2\n(8i10)\n        10       -14\n"
                               "CMBLOCK,\xb5\xd7_1   ,ELEMENT,       3  ! in another alphabet\n(8i10)\n"
                               "        10        11       -12\n"
                               "CMBLOCK,SOME_NODES,NODE,       1\n(8i10)\n         1\n";
    const char *pattern[] = {"all*"};
    char matches[1] = {0};
    fl_import_options w = {.pattern = pattern, .patterns = 1, .matched = matches};
    (void)state;
    reads(text);
    assert_int_equal(s.n, 3);
    assert_non_null(strstr(s.part[0].name, "-deck")); /* the name of the file */
    assert_int_equal(s.part[0].nt, 2);
    assert_string_equal(s.part[1].name, "\xb5\xd7_1");
    assert_int_equal(s.part[1].nt, 6);
    assert_string_equal(s.part[2].name, "ALL_OF_IT");
    assert_int_equal(s.part[2].nt, 2);
    assert_non_null(strstr(note, "1 components of nodes"));
    assert_int_equal(read_some(text, &w), 0);
    assert_int_equal(s.n, 1);
    assert_int_equal(s.part[0].nt, 8);
    assert_int_equal(matches[0], 1);
}

static void types_may_come_as_a_block(void **state)
{
    (void)state;
    reads(
        "ETBLOCK,2,2\n(2i9,19a9)\n        1      185        0        0\n        2      174\n       -1\n" NODES
        "EBLOCK,19,SOLID,9,2\n(19i4)\n"
        "   1   1   1   1   0   0   0   0   8   0   9   1   2   3   4   5   6   7   8\n"
        "   1   2   1   1   0   0   0   0   4   0   8   5   6   7   8\n"
        "  -1\n");
    assert_int_equal(s.part[0].nt, 12);
    assert_non_null(strstr(note, "routine 174 1"));
}

static void counts_are_only_hints(void **state)
{
    (void)state;
    reads("ET,1,185\n" NODES "EBLOCK,19,SOLID,9,2000000000\n(19i4)\n"
          "   1   1   1   1   0   0   0   0   8   0   9   1   2   3   4   5   6   7   8\n"
          "  -1\n");
    assert_non_null(strstr(note, "EBLOCK announces 2000000000 entries and has 1"));
}

/* A tube by its section, a pipe by its section and by its real constants, a rod; a truss has no radius. */
static void lines_have_the_radius_of_their_section(void **state)
{
    (void)state;
    reads(
        "ET,1,188\nET,2,PIPE288\nET,3,16\nET,4,180\n"
        "RLBLOCK,1,7,8,7\n(2i8,6g16.9)\n(7g16.9)\n"
        "       7       8  1.0             0.05           0.0            0.0             0.0            0.0\n"
        "  0.0            0.0\n" NODES "EBLOCK,19,SOLID\n(19i4)\n"
        "   1   1   1   1   0   0   0   0   3   0   1   1   5   2\n"
        "   1   2   1   2   0   0   0   0   2   0   2   2   6\n"
        "   1   3   7   1   0   0   0   0   2   0   3   3   7\n"
        "   1   1   1   3   0   0   0   0   2   0   4   4   8\n"
        "   1   4   7   1   0   0   0   0   2   0   5   1   2\n"
        "  -1\n"
        "SECTYPE,1,BEAM,CTUBE,LEG\nSECDATA,0.4,0.5,8\nSECTYPE,2,PIPE,,RISER\nSECDATA,0.6,0.02\n"
        "SECTYPE,3,BEAM,CSOLID\nSECDATA,0.125\n");
    assert_int_equal(s.part[0].nc, 4);
    assert_near(s.part[0].cone[0].r0, 0.5, 0.0);
    assert_near(s.part[0].cone[1].r1, 0.3, 1e-15);
    assert_near(s.part[0].cone[2].r0, 0.5, 0.0);
    assert_near(s.part[0].cone[3].r1, 0.125, 0.0);
    assert_near(s.part[0].cone[0].p1.z, 3.0, 0.0);
    assert_non_null(strstr(note, "1 lines"));
}

static void single_commands_mix_with_blocks(void **state)
{
    (void)state;
    reads("*SET,tid,4\ncid = 3\net,tid,185\net,cid,200\nkeyopt,3,1,6\n" NODES
          "type,tid\nen,1,1,2,3,4,5,6,7,8\nn,9,0,0,5\nn,10,2,0,5\nn,11,2,1,5.0\nn,_pilot,1,2,3\n"
          "type,3\ne,9,10,11,11\nen,_p,1\n");
    assert_int_equal(s.part[0].nt, 13);
    assert_near(bounding_box().hi.z, 5.0, 0.0);
    assert_non_null(strstr(note, "2 commands"));
    reads("ET,1,95\n" NODES "E,1,2,3,4,5,6,7,8\nEMORE\nFINISH\n");
    assert_int_equal(s.part[0].nt, 12);
}

/* As CDWRITE and Workbench write them. */
static void commands_may_be_abbreviated(void **state)
{
    (void)state;
    reads("ET,        1,200\nKEYOP,        1, 1,       10\n" NODES "EBLOCK,19,SOLID,9,1\n(19i4)\n"
          "   1   1   1   1   0   0   0   0   8   0   9   1   2   3   4   5   6   7   8\n  -1\n");
    assert_int_equal(s.part[0].nt, 12);
    reads("et,1,200\nkeyo,1,1,6\n" NODES "en,1,1,2,3,4\n");
    assert_int_equal(s.part[0].nt, 2);
    reads("et,1,95\n" NODES "e,1,2,3,4,5,6,7,8\nemor\n");
    assert_int_equal(s.part[0].nt, 12);
    reads("et,1,188\nsect,1,beam,csolid\nsecd,0.5\nsecn,1\n" NODES "e,1,2\n");
    assert_near(s.part[0].cone[0].r0, 0.5, 0.0);
}

static void what_is_no_mesh_is_passed_over(void **state)
{
    static const char *const kind[] = {"KP", "LINE", "AREA", "VOLU", "SOMETHING"};
    char deck[2000];
    (void)state;
    for (int k = 0; k < 5; k++) {
        snprintf(deck, sizeof deck, "ET,1,185\n" NODES "CMBLOCK,A,%s,2\n(8i10)\n         1       -12\n" HEX,
                 kind[k]);
        reads(deck);
        assert_int_equal(s.part[0].nt, 12);
    }
    reads("ET,1,185\n" NODES "EBLOCK,19,SOLID\n(19i4)\n"
          "   1   1   1   1   0   0   0   0   8   0   9   1   2   3   4   5   6   7   8\n"
          "EN,R5.5,ATTR,       -1,\nFINISH\n");
    assert_int_equal(s.part[0].nt, 12);
}

/* Read an element of n nodes of a right tetrahedron of legs 2 with its mid-side nodes. */
static void read_element(int routine, int key, int n, const char *nodes)
{
    char deck[2000];
    snprintf(deck, sizeof deck,
             "ET,1,%d\nKEYOPT,1,1,%d\nNBLOCK,3\n(1i4,3e5.0)\n   1   0.   0.   0.\n   2   2.   0.   0.\n"
             "   3   0.   2.   0.\n   4   0.   0.   2.\n   5   1.   0.   0.\n   6   1.   1.   0.\n"
             "   7   0.   1.   0.\n   8   0.   0.   1.\n   9   1.   0.   1.\n  10   0.   1.   1.\n"
             "  11   2.   2.   0.\n  12   2.   0.   2.\n  13   0.   2.   2.\n  14   2.   2.   2.\n  -1\n"
             "EBLOCK,19,SOLID\n(19i4)\n   1   1   1   1   0   0   0   0%4d   0   9%s\n  -1\n",
             routine, key, n, nodes);
    reads(deck);
    assert_int_equal(s.n, 1);
}

/* The routine decides the shape.  Mid-side nodes may be missing at the end, be 0, or repeat a corner. */
static void routine_decides_the_shape(void **state)
{
    static const int tet[] = {72, 87, 92, 98, 123, 127, 168, 187, 217, 227, 232, 237, 240, 285, 291};
    static const int brick[] = {45, 90, 95, 185, 186, 226, 279};
    static const char *const mids[] = {"",
                                       "   5",
                                       "   5   6",
                                       "   5   6   7",
                                       "   5   6   7   8",
                                       "   5   6   7   8   9",
                                       "   5   6   7   8   9  10",
                                       "   0   6   0   8   9  10",
                                       "   1   2   3   4   4   3"};
    static const int count[] = {4, 5, 6, 7, 8, 9, 10, 10, 10};
    char nodes[200];
    (void)state;
    for (int k = 0; k < 9; k++) {
        snprintf(nodes, sizeof nodes, "   1   2   3   4%s", mids[k]);
        if (strlen(nodes) > 32) memmove(nodes + 33, nodes + 32, strlen(nodes) - 31), nodes[32] = '\n';
        for (size_t i = 0; i < sizeof tet / sizeof *tet; i++) {
            read_element(tet[i], 0, count[k], nodes);
            assert_int_equal(s.part[0].nt, 4);
            assert_near(fl_moments_of(s.part, 1).volume, 4.0 / 3.0, 1e-12);
        }
    }
    /* a brick of 8 corners and 2, or 5, of its mids; one that is folded to a tetrahedron; a wedge */
    for (size_t i = 0; i < sizeof brick / sizeof *brick; i++) {
        read_element(brick[i], 0, 10, "   1   2  11   3   4  12  14  13\n   5   0");
        assert_near(fl_moments_of(s.part, 1).volume, 8.0, 1e-12);
        read_element(brick[i], 0, 13, "   1   2  11   3   4  12  14  13\n   5   0   0   7   0");
        assert_near(fl_moments_of(s.part, 1).volume, 8.0, 1e-12);
        read_element(brick[i], 0, 9, "   1   2   3   3   4   4   4   4\n   5");
        assert_near(fl_moments_of(s.part, 1).volume, 4.0 / 3.0, 1e-12);
        read_element(brick[i], 0, 11, "   1   2   3   3   4  12  13  13\n   5   6   3");
        assert_near(fl_moments_of(s.part, 1).volume, 4.0, 1e-12);
        assert_int_equal(s.part[0].nt, 8);
    }
    read_element(187, 0, 8, "   1   2   3   3   4   4   4   4");
    assert_near(fl_moments_of(s.part, 1).volume, 4.0 / 3.0, 1e-12);
    /* quadrilaterals of 6 and 8 nodes, and triangles of as many */
    read_element(281, 0, 6, "   1   2  11   3   5   0");
    assert_near(fl_moments_of(s.part, 1).area, 4.0, 1e-12);
    read_element(93, 0, 8, "   1   2   3   3   5   6   3   7");
    assert_near(fl_moments_of(s.part, 1).area, 2.0, 1e-12);
    read_element(183, 0, 6, "   1   2  11   3   5   0");
    assert_near(fl_moments_of(s.part, 1).area, 4.0, 1e-12);
    read_element(183, 1, 6, "   1   2   3   5   6   7");
    assert_near(fl_moments_of(s.part, 1).area, 2.0, 1e-12);
    read_element(200, 5, 4, "   1   2   3   5");
    assert_near(fl_moments_of(s.part, 1).area, 2.0, 1e-12);
    read_element(200, 9, 8, "   1   2   3   4   5   6   7   8");
    assert_near(fl_moments_of(s.part, 1).volume, 4.0 / 3.0, 1e-12);
}

/* Split through its mid-side nodes, an edge that one of its elements leaves straight is split as well. */
static void edges_are_divided_on_both_sides(void **state)
{
    fl_import_options opt = {.subdivide = 1};
    fl_mesh_quality q;
    (void)state;
    assert_int_equal(
        read_some("ET,1,187\nNBLOCK,3\n(1i4,3e5.0)\n   1   0.   0.   0.\n   2   2.   0.   0.\n"
                  "   3   0.   2.   0.\n   4   0.   0.   2.\n   5   1.   0.   0.\n   6   1.   1.   0.\n"
                  "   7   0.   1.   0.\n   8   0.   0.   1.\n   9   1.   0. 1.25\n  10   0.   1.   1.\n"
                  "  11   2.   2.   2.\n  -1\nEBLOCK,19,SOLID\n(19i4)\n"
                  "   1   1   1   1   0   0   0   0  10   0   1   1   2   3   4   5   6   7   8\n   9  10\n"
                  "   1   1   1   1   0   0   0   0   7   0   2   2  11   3   4   0   0   6\n  -1\n",
                  &opt),
        0);
    assert_int_equal(fl_surface_measure(&s, &q, &err), 0);
    assert_int_equal(q.open, 0);
    assert_true(q.closed);
}

static void bad_decks_are_reported_with_their_line(void **state)
{
    (void)state;
    refuses("ET,1,185\nNBLOCK,6,SOLID\n(3i8,6e20.13)\n       1       0       0 0.0\n", "ends inside NBLOCK");
    refuses("ET,1,185\nNBLOCK,6,SOLID\n       1       0       0 0.0\n", ":3: \"       1");
    refuses("ET,1,185\nNBLOCK,6,SOLID\n", "where a format line is expected");
    refuses("ET,1,185\nNBLOCK,6,SOLID\n(6e20.13)\n", "whole numbers and then reals");
    refuses("ET,1,185\nNBLOCK,6,SOLID\n(3i8,900e20.13)\n", "a format like");
    refuses("ET,1,185\nNBLOCK,6,SOLID\n(3i8,6e20.13)\n       1       0       0 nan\n  -1\n",
            ":4: column 4 is \"nan\", a finite number is expected");
    refuses("ET,1,185\nNBLOCK,6,SOLID\n(3i8,6e20.13)\n     1.5       0       0 1.0\n  -1\n", "whole number");
    refuses("ET,1,185\nNBLOCK,6,SOLID\n(3i8,6e20.13)\n       0       0       0 1.0\n  -1\n", "node 0");
    refuses(NODES HEX, "of type 1, which no ET");
    refuses("ET,1,185\n" NODES "EBLOCK,19,SOLID\n(19i4)\n"
            "   1   1   1   1   0   0   0   0   8   0   9   1   2   3   4   5   6   7  88\n  -1\n",
            ":15: the element refers to node 88, which is not defined");
    refuses("ET,1,185\n" NODES "EBLOCK,19,SOLID\n(19i4)\n"
            "   1   1   1   1   0   0   0   0   7   0   9   1   2   3   4   5   6   7\n  -1\n",
            "has 7 nodes");
    refuses("ET,1,185\n" NODES "EBLOCK,19,SOLID\n(19i4)\n"
            "   1   1   1   1   0   0   0   0  99   0   9   1   2   3   4   5   6   7\n  -1\n",
            "of 99 nodes");
    refuses("ET,1,186\n" NODES "EBLOCK,19,SOLID\n(19i4)\n"
            "   1   1   1   1   0   0   0   0  20   0   9   1   2   3   4   5   6   7   8\n",
            "ends after 8 of its 20 nodes");
    refuses("ET,1,185\n" NODES HEX "CMBLOCK,A,ELEM,1\n(8i10)\n        -9\n", "-9 was found after 0");
    refuses("ET,1,185\nNBLOCK,3\n(i8,3e20.13)\n  -1\nEN,R5.5,ATTR,8,1\n", "CDWRITE");
    refuses("ET,1,185\n" NODES "/INPUT,none,such\n", "none.such");
    refuses("ET,1,185\n" NODES "/INPUT\n", "/INPUT names no file");
    refuses("ET,1,185\n" NODES "CSYS,12\nN,12,1,2,3\n", "coordinate system 12");
    refuses("ET,1,185\n" NODES, "no triangles");
}

static void free_all(void **state)
{
    (void)state;
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_follow_the_format_line),
        cmocka_unit_test(line_ends_may_be_of_any_kind),
        cmocka_unit_test(components_are_parts),
        cmocka_unit_test(types_may_come_as_a_block),
        cmocka_unit_test(counts_are_only_hints),
        cmocka_unit_test(routine_decides_the_shape),
        cmocka_unit_test(edges_are_divided_on_both_sides),
        cmocka_unit_test(what_is_no_mesh_is_passed_over),
        cmocka_unit_test(lines_have_the_radius_of_their_section),
        cmocka_unit_test(single_commands_mix_with_blocks),
        cmocka_unit_test(commands_may_be_abbreviated),
        cmocka_unit_test(bad_decks_are_reported_with_their_line),
        cmocka_unit_test(free_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
