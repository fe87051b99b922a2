/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "mesh/inp_type.h"
#include "mesh/read_inp.h"
#include "support/decks.h"

/* Eight corners of a unit cube, numbered 1 to 8, behind *NODE. */
#define CUBE                                                                                                 \
    "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, "   \
    "1\n"
#define HEX "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"

/* --- lines ---------------------------------------------------------------------------------------------- */

static void lines_of_every_kind(void **state)
{
    (void)state;
    /* blanks, comments inside data, missing coordinates, letters of either case, a continued keyword, tabs,
     * line ends of three kinds, no end of the last line, blank fields, continued data with and without its
     * comma */
    static const char *const text[] = {
        CUBE HEX,
        "** first\r\n\r\n  * node , system = r\r\n1,\r\n2, 1.0\r\n** between\r\n3, 1., 1\r\n4, , "
        "+1.E0,\r\n5,0,0,1,,,\r\n"
        "6,1.0D0,,1\r\n7,1,1,1\r\n8,,1,1\r\n*Element,\r\n** inside\r\n type=c3d8r,\r\n elset=\"All of it, "
        "really\"\r\n"
        "1,1,2,3,\r\n4,5,6,7,\r\n8",
        "*NODE\r1,0,0,0\r2,1,0,0\r3,1,1,0\r4,0,1,0\r5,0,0,1\r6,1,0,1\r7,1,1,1\r8,0,1,1\r*ELEMENT,TYPE=C3D8\r"
        "1,1,2,3,4,5,6,7\r8\r",
        "*HEADING\n,,a \"heading\n*PREPRINT, ECHO=YES\n*NODE, "
        "NSET=ALL\n1,\t0,0,0\n\f2,1,0,0\n3,1,1,0\n4,0,1,0\n"
        "*NODE OUTPUT\nU,\n*NODE\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n*MATERIAL, NAME=A\n*ELASTIC\n1e9, "
        ".3\n" HEX};
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) {
        const fl_mesh_quality q = reads(text[k]);
        assert_true(q.closed && q.triangles == 12);
        assert_near(q.volume, 1.0, 0.0);
        says("8 nodes; elements: hex8 1");
    }
    reads(text[1]);
    assert_string_equal(s.part[0].name, "All_of_it,_really");
}

/* Quadratic elements take two lines; a comma after the last node of a complete element is ignored. */
static void elements_continue_over_lines(void **state)
{
    (void)state;
    fl_mesh_quality q =
        reads(CUBE "*ELEMENT, TYPE=S3, ELSET=A\n1, 1, 2, 3,\n2, 1, 3, 4,\n*ELEMENT, TYPE=S4R, ELSET=A\n"
                   "3, 5, 6,\n7, 8\n");
    assert_int_equal(q.triangles, 4);
    assert_int_equal(s.n, 1);
    assert_near(q.area, 2.0, 1e-15);
    refuses(CUBE "*ELEMENT, TYPE=S4\n1, 1, 2, 3\n2, 5, 6, 7, 8\n",
            "deck:11: element 1 has 3 nodes, 4 are expected");
    refuses(CUBE "*ELEMENT, TYPE=S4\n1, 1, 2, 3,\n5, 6, 7, 8\n", "deck:12: element 1 has more than 4 nodes");
    refuses(CUBE "*ELEMENT, TYPE=S4\n1, 1, 2, 3\n*STEP\n", "deck:11: element 1 has 3 nodes, 4 are expected");
    /* the type decides, whatever the count */
    refuses(CUBE "*ELEMENT, TYPE=C3D10\n1, 1, 2, 3, 4, 5, 6, 7, 8\n",
            "element 1 has 8 nodes, 10 are expected");
    refuses(CUBE "*ELEMENT, TYPE=C3D10\n1, 1, 2, 3, 4\n2, 5, 6, 7, 8\n*STEP\n",
            "deck:11: element 1 has 4 nodes, 10 are expected");
}

/* Other input that CalculiX reads: a mark before the first comment, stars alone, more nodes than the type
 * has, instance names in a flat deck. */
static void decks_are_read_as_by_calculix(void **state)
{
    (void)state;
    fl_mesh_quality q = reads(">** a beam\n*\n" CUBE "*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8, 1, 2,\n"
                              "*ELSET, ELSET=A, INSTANCE=Part-1-1\n1\n");
    assert_true(q.closed && q.triangles == 12);
    says("1 elements list more nodes than their type has; those behind were skipped");
    q = takes("some words\n" CUBE HEX "*ELSET, ELSET=A, INSTANCE=Part-1-1\n1\n", "A");
    assert_true(q.closed && q.triangles == 12);
    refuses("some words\n*G1, 2\n", "unknown format");
}

/* --- types ---------------------------------------------------------------------------------------------- */

static void types_have_shapes(void **state)
{
    (void)state;
    static const struct {
        const char *names;
        int shape;
    } row[] = {
        {"S3 S3R S3RS S3RT STRI3 R3D3 M3D3 SFM3D3 DS3 CPS3 CPE3 s3 DC2D3", FL_TRI3},
        {"STRI65 M3D6 SFM3D6 DS6 CPS6 CPE6M S6", FL_TRI6},
        {"S4 S4R S4R5 S4RS S4RSW S4RT R3D4 M3D4 M3D4R SFM3D4R DS4 CPS4 CPS4R CPE4I CPEG4", FL_QUAD4},
        {"S8R S8R5 S8RT M3D8 M3D8R SFM3D8R DS8 CPS8R", FL_QUAD8},
        {"S9R5 M3D9R", FL_QUAD9},
        {"C3D4 C3D4H C3D4E C3D4T DC3D4 DC3D4E", FL_TET4},
        {"C3D5", FL_PYRAMID5},
        {"C3D6 C3D6H C3D6T SC6R SC6RT DC3D6", FL_WEDGE6},
        {"C3D8 C3D8R C3D8I C3D8IH C3D8RH C3D8T C3D8HT C3D8P C3D8S SC8R SC8RT DC3D8", FL_HEX8},
        {"C3D10 C3D10H C3D10M C3D10MH C3D10MHT C3D10HS DC3D10 C3D10I C3D10MP", FL_TET10},
        {"C3D15 C3D15H C3D15V C3D15VH DC3D15", FL_WEDGE15},
        {"C3D20 C3D20R C3D20RH C3D20RHT C3D20RP DC3D20 C3D27 C3D27RH", FL_HEX20},
        {"B31 B31H B31OS B33 B33H T3D2 T3D2T PIPE31 PIPE31H ELBOW31 FRAME3D B21 T2D2 PIPE21 RB3D2", FL_LINE2},
        {"B32 B32OS B32R T3D3 PIPE32 PIPE32H ELBOW32 B22 T2D3", FL_LINE3},
        {"SPRING1 SPRINGA MASS ROTARYI CONN3D2 GAPUNI DASHPOTA CAX4 CAX8R SAX1 ACAX4 CCL12 MAX1 U1 GK3D8 "
         "ITSCYL COH3D8 AC3D4 AC3D5 AC3D6 AC3D8R AC3D10 AC3D15 AC3D20 AC2D4 DCC3D8 FC3D8 EC3D8R "
         "SC4 C3D7 S5 B310 R2D2 F3D4 PC3D C3D C3D4* S3;DROP \xb5\xa5 VERYLONGTYPENAMEINDEED24BYTES S 8 "
         "C3D8888",
         -1}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        char names[400], *word;
        snprintf(names, sizeof names, "%s", row[k].names);
        for (word = strtok(names, " "); word; word = strtok(NULL, " ")) {
            fl_inp_type t = {0};
            const int known = fl_inp_type_of(word, &t);
            if (known != (row[k].shape >= 0) || (known && (int)t.shape != row[k].shape)) fail_msg("%s", word);
            if (known) assert_int_equal(t.nodes, fl_shape_nodes(t.shape));
        }
    }
}

static void other_types_are_counted(void **state)
{
    (void)state;
    reads(CUBE HEX
          "*ELEMENT, TYPE=SPRING1\n10, 1\n11, 2\n*ELEMENT, TYPE=CCL24\n12, 1, 2, 3,\n4, 5, 6\n13, 1, 2,\n"
          "3, 4\n*ELEMENT, TYPE=SPRING1\n14, 1\n");
    says("skipped: SPRING1 3, CCL24 2");
    assert_int_equal(read_some(CUBE "*ELEMENT, TYPE=MASS\n1, 2\n", NULL), -1);
    assert_non_null(strstr(err.text, "no triangles"));
}

/* A beam of three nodes has its middle node second; one more node may orient its section. */
static void line_elements_have_radii(void **state)
{
    (void)state;
    static const char deck[] =
        "*NODE\n1\n2, 0, 0, 2\n3, 0, 0, 1\n4, 5\n*ELEMENT, TYPE=B32, ELSET=LEG\n1, 1, 3, 2,\n2, 1, 3, 2, 4\n"
        "*ELEMENT, TYPE=PIPE31, ELSET=BRACE\n3, 1, 4\n*ELEMENT, TYPE=T3D2, ELSET=ROD\n4, 2, 4\n"
        "*ELEMENT, TYPE=B31, ELSET=BOX\n5, 2, 3\n*ELSET, ELSET=TUBES\nLEG, brace\n"
        "*BEAM SECTION, ELSET=tubes, SECTION=PIPE, MATERIAL=A\n0.5, 0.01\n1, 0, 0\n"
        "*SOLID SECTION, ELSET=ROD, MATERIAL=A\n3.14159265358979323846\n"
        "*BEAM SECTION, ELSET=BOX, SECTION=BOX, MATERIAL=A\n1, 2, .1, .1, .1, .1\n";
    reads(deck);
    says("1 lines without a section radius");
    says("largest sagitta is 0 ");
    says("1 elements on the nodes of others"); /* both of LEG lie between 1 and 2 */
    assert_int_equal(s.n, 3);
    assert_string_equal(s.part[0].name, "LEG");
    assert_int_equal(s.part[0].nc, 1);
    assert_near(s.part[0].cone[0].p1.z, 2.0, 0.0);
    assert_near(s.part[0].cone[0].r0, 0.5, 0.0);
    assert_near(s.part[1].cone[0].r1, 0.5, 0.0);
    assert_near(s.part[2].cone[0].r1, 1.0, 1e-15);
    /* a leg in pieces, numbered in both directions, with a brace at the joint */
    reads("*NODE\n1, 0, 0, -9\n2, 0, 0, 0\n3, 0, 0, 4\n4, 5\n5, 0, 0, 6\n*ELEMENT, TYPE=B31, ELSET=A\n"
          "1, 1, 2\n2, 3, 2\n3, 2, 4\n4, 3, 5\n*BEAM SECTION, SECTION=CIRC, ELSET=A\n.5\n");
    says("3 lines that continue one another were merged into 1\n");
    assert_int_equal(s.part[0].nc, 2);
    assert_near(s.part[0].cone[0].p0.z, -9.0, 0.0);
    assert_near(s.part[0].cone[0].p1.z, 6.0, 0.0);
    refuses(
        "*NODE\n1\n2, 1\n*ELEMENT, TYPE=B31, ELSET=A\n1, 1, 2\n*BEAM SECTION, SECTION=CIRC, ELSET=A\n-1\n",
        "a radius of -1, 0 or more is expected");
}

/* --- sets and surfaces ---------------------------------------------------------------------------------- */

/* Four cubes in a row, elements 1 to 4. */
#define ROW                                                                                                  \
    CUBE                                                                                                     \
        "*NODE\n12, 2, 0, 0\n13, 2, 1, 0\n16, 2, 0, 1\n17, 2, 1, 1\n22, 3, 0, 0\n23, 3, 1, 0\n26, 3, 0, 1\n" \
        "27, 3, 1, 1\n32, 4, 0, 0\n33, 4, 1, 0\n36, 4, 0, 1\n37, 4, 1, 1\n*ELEMENT, TYPE=C3D8, "             \
        "ELSET=FIRST\n"                                                                                      \
        "1, 1, 2, 3, 4, 5, 6, 7, 8\n*ELEMENT, TYPE=C3D8, ELSET=REST\n2, 2, 12, 13, 3, 6, 16, 17, 7\n"        \
        "3, 12, 22, 23, 13, 16, 26, 27, 17\n4, 22, 32, 33, 23, 26, 36, 37, 27\n"

static void sets_may_contain_sets(void **state)
{
    (void)state;
    static const char deck[] = ROW
        "*ELSET, ELSET=ENDS\n1, 4\n*ELSET, ELSET=MIDDLE, GENERATE\n2, 3\n*ELSET, ELSET=Odd, GENERATE, "
        "INTERNAL\n1, 99, 2\n"
        "*ELSET, ELSET=BOTH\nends, Middle\n*ELSET, ELSET=MORE\n later,\n*ELSET, ELSET=LATER\n1, 2, FIRST\n"
        "*ELSET, ELSET=LATER\n3\n*ELSET, ELSET=HUGE, GENERATE\n2, 900000000000000002, 2\n";
    static const struct {
        const char *name;
        double volume;
    } row[] = {{"ends", 2},  {"middle", 2}, {"odd", 2},  {"both", 4}, {"more", 3},
               {"later", 3}, {"first", 1},  {"rest", 3}, {"huge", 2}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        const fl_mesh_quality q = takes(deck, row[k].name);
        assert_true(q.closed);
        assert_int_equal(s.n, 1);
        assert_near(q.volume, row[k].volume, 1e-15);
    }
    assert_int_equal(reads(deck).triangles, 36); /* sets that are not selected have no effect */
    assert_int_equal(s.n, 2);
    refuses(ROW "*ELSET, ELSET=A\n1, NONE\n", "\"A\" refers to \"NONE\", which is not defined");
    refuses(ROW "*ELSET, ELSET=A\nB\n*ELSET, ELSET=B\nC\n*ELSET, ELSET=C\nA\n", "\"A\" contains itself");
    refuses(ROW "*ELSET, ELSET=A, GENERATE\n5, 1\n", "deck:30: from 5 to 1 by 1: a rising range is expected");
    refuses(ROW "*ELSET, GENERATE\n1, 5\n", "*ELSET needs ELSET=");
}

/* Sets that name each other twice, sixty deep; and a chain too long for recursion. */
static void nested_sets_are_fast(void **state)
{
    (void)state;
    char *deck = malloc(4000000);
    size_t n = (size_t)sprintf(deck, "%s", ROW);
    for (int k = 0; k < 60; k++)
        n += (size_t)sprintf(deck + n,
                             "*ELSET, ELSET=S%d\nS%d, S%d\n*SURFACE, NAME=F%d, COMBINE=UNION\nF%d\nF%d\n", k,
                             k + 1, k + 1, k, k + 1, k + 1);
    n += (size_t)sprintf(deck + n, "*ELSET, ELSET=S60\n2,3\n*SURFACE, NAME=F60\nS0, S3\nS0, S5\n");
    assert_near(takes(deck, "s0").volume, 2.0, 1e-15);
    assert_near(takes(deck, "f0").area, 4.0, 1e-15);
    n = (size_t)sprintf(deck, "%s", ROW);
    for (int k = 0; k < 50000; k++) n += (size_t)sprintf(deck + n, "*ELSET, ELSET=S%d\nS%d\n", k, k + 1);
    sprintf(deck + n, "*ELSET, ELSET=S50000\n2,3\n");
    const char *const list[] = {"S0"};
    fl_import_options w = {.pattern = list, .patterns = 1};
    assert_int_equal(read_some(deck, &w), -1);
    assert_non_null(strstr(err.text, "sets are named by sets more than 1000 deep"));
    free(deck);
}

/* The mean of the corners of the triangles, and the sum of their normals. */
static void face_mean(fl_vec3 *middle, fl_vec3 *normal)
{
    *middle = *normal = v3(0, 0, 0);
    for (int32_t i = 0; i < s.n; i++)
        for (int32_t t = 0; t < s.part[i].nt; t++) {
            const int32_t *v = s.part[i].t[t].v;
            const fl_vec3 a = s.part[i].v[v[0]], b = s.part[i].v[v[1]], c = s.part[i].v[v[2]];
            const fl_vec3 n = v3_scale(0.5, v3_cross(v3_sub(b, a), v3_sub(c, a)));
            *normal = v3_add(*normal, n);
            *middle = v3_madd(*middle, v3_norm(n) / 3.0, v3_add(a, v3_add(b, c)));
        }
}

/* S1 to S6 of each solid by the tables of the manual: the expected side, oriented outward. */
static void faces_follow_the_manual(void **state)
{
    (void)state;
    static const struct {
        const char *type, *nodes;
        int faces;
        fl_vec3 normal[6];
    } row[] = {
        {"C3D8",
         "1, 2, 3, 4, 5, 6, 7, 8",
         6,
         {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}},
        {"C3D6", "1, 2, 4, 5, 6, 8", 5, {{0, 0, -0.5}, {0, 0, 0.5}, {0, -1, 0}, {1, 1, 0}, {-1, 0, 0}}},
        {"C3D4", "1, 2, 4, 5", 4, {{0, 0, -0.5}, {0, -0.5, 0}, {0.5, 0.5, 0.5}, {-0.5, 0, 0}}},
        {"C3D4", "2, 1, 4, 5", 4, {{0, 0, -0.5}, {0, -0.5, 0}, {-0.5, 0, 0}, {0.5, 0.5, 0.5}}}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++)
        for (int f = 0; f < row[k].faces; f++) {
            char deck[1000];
            fl_vec3 middle, normal;
            snprintf(deck, sizeof deck,
                     CUBE "*ELEMENT, TYPE=%s, ELSET=E\n7, %s\n*SURFACE, NAME=F, TYPE=ELEMENT\n%s, S%d\n",
                     row[k].type, row[k].nodes, f % 2 ? "E" : "7", f + 1);
            takes(deck, "F");
            face_mean(&middle, &normal);
            assert_near_of(v3_norm(v3_sub(normal, row[k].normal[f])), 0.0, 1e-15, 1.0);
        }
}

static void surfaces_select_faces(void **state)
{
    (void)state;
    fl_vec3 middle, normal;
    /* no face: all outer faces; a set with its own faces; edges and nodes are ignored */
    static const char deck[] =
        ROW "*SURFACE, NAME=SKIN\nREST,\n*SURFACE, TYPE=ELEMENT, NAME=TOP\nFIRST, S2\n3, s2\n"
            "*SURFACE, NAME=ALL, COMBINE=UNION\ntop\nskin\n*SURFACE, NAME=N, TYPE=NODE\n1, 2\n"
            "*ELEMENT, TYPE=S4, ELSET=PLATE\n9, 1, 4, 8, 5\n*SURFACE, NAME=UNDER\nPLATE, SNEG\n"
            "*SURFACE, NAME=OVER\nPLATE, SPOS\n*SURFACE, NAME=RIM\nPLATE, E1\n3, S1\n"
            "*SURFACE, NAME=CUT, COMBINE=INTERSECTION\nTOP, SKIN\n";
    assert_near(takes(deck, "skin").area, 13.0, 1e-15);
    assert_near(takes(deck, "top").area, 2.0, 1e-15);
    assert_near(takes(deck, "all").area, 14.0, 1e-15);
    takes(deck, "under");
    face_mean(&middle, &normal);
    assert_near(normal.x, -1.0, 1e-15);
    takes(deck, "over");
    face_mean(&middle, &normal);
    assert_near(normal.x, 1.0, 1e-15);
    assert_near(takes(deck, "rim").area, 1.0, 1e-15);
    says("1 lines of surfaces name edges");
    says("\"CUT\" is a difference or an intersection");
}

/* --- parts and instances -------------------------------------------------------------------------------- */

#define PART(name, text) "*PART, NAME=" name "\n" text "*END PART\n"

static void instances_are_translated_then_rotated(void **state)
{
    (void)state;
    static const char deck[] = PART("Cube", CUBE HEX) PART(
        "Slab", CUBE
        "*ELEMENT, TYPE=C3D6, ELSET=half\n1, 1,2,4, 5,6,8\n") "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=One, "
                                                              "PART=cube\n*END INSTANCE\n*INSTANCE, "
                                                              "NAME=Two, PART=CUBE\n10, 0, 0\n"
                                                              "10, 0, 0, 10, 0, 5, 90\n*END "
                                                              "INSTANCE\n*INSTANCE, NAME=Three, "
                                                              "PART=Slab\n,,5\n*END INSTANCE\n*NODE\n1, 99, "
                                                              "99, 99\n"
                                                              "*ELSET, ELSET=Pair, INSTANCE=One\n1\n*ELSET, "
                                                              "ELSET=Pair, INSTANCE=Three\nhalf\n*ELSET, "
                                                              "ELSET=Dots\nTwo.1, Three.half\n"
                                                              "*END ASSEMBLY\n";
    fl_mesh_quality q = reads(deck);
    assert_int_equal(s.n, 3);
    assert_string_equal(s.part[0].name, "One");
    assert_string_equal(s.part[2].name, "Three.half");
    assert_near(q.volume, 2.5, 1e-15);
    const fl_aabb two = fl_part_aabb(&s.part[1]);
    assert_near(two.lo.x, 9.0, 0.0); /* about (10, 0): x to y, y to -x */
    assert_near(two.hi.x, 10.0, 0.0);
    assert_near(two.lo.y, 0.0, 0.0);
    assert_near(two.hi.y, 1.0, 0.0);
    assert_near(fl_part_aabb(&s.part[2]).lo.z, 5.0, 0.0);
    assert_near(takes(deck, "pair").volume, 1.5, 1e-15);
    assert_near(takes(deck, "dots").volume, 1.5, 1e-15);
    assert_near(takes(deck, "two").volume, 1.0, 1e-15);
}

static void other_assemblies_are_read(void **state)
{
    (void)state;
    /* an instance with a mesh of its own, moved as a whole; radii and sets of a part in each instance */
    fl_mesh_quality q = reads("*PART, NAME=P\n*END PART\n*INSTANCE, NAME=I, PART=P\n0, 0, 3\n" CUBE HEX
                              "*ELSET, ELSET=E\n1\n*SURFACE, NAME=F\nE, S2\n*END INSTANCE\n");
    assert_near(q.volume, 1.0, 0.0);
    assert_near(q.box.lo.z, 3.0, 0.0);
    reads(PART("P", "*NODE\n1\n2, 1\n*ELEMENT, TYPE=B31, ELSET=L\n1, 1, 2\n*BEAM SECTION, SECTION=CIRC, "
                    "ELSET=L\n.25\n") "*INSTANCE, NAME=A, PART=P\n*END INSTANCE\n*INSTANCE, NAME=B, "
                                      "PART=P\n0, 1\n*END INSTANCE\n");
    assert_int_equal(s.n, 2);
    assert_near(s.part[1].cone[0].r0, 0.25, 0.0);
    assert_near(s.part[1].cone[0].p1.y, 1.0, 0.0);
    q = takes(PART("P", CUBE HEX
                   "*ELSET, ELSET=E\n1\n*SURFACE, NAME=F\nE, S2\n") "*INSTANCE, NAME=A, PART=P\n*END "
                                                                    "INSTANCE\n*INSTANCE, NAME=B, PART=P\n0, "
                                                                    "0, 7\n*END INSTANCE\n",
              "*.F");
    assert_int_equal(s.n, 2);
    assert_near(q.area, 2.0, 0.0);
    assert_near(q.box.lo.z, 1.0, 0.0);
    assert_near(q.box.hi.z, 8.0, 0.0);
    /* parts alone, and unused parts */
    q = reads(PART("A", CUBE HEX) PART("B", CUBE HEX));
    assert_int_equal(s.n, 2);
    says("no *INSTANCE: 2 parts were taken where they are defined");
    reads(PART("A", CUBE HEX) PART("B", CUBE HEX) "*INSTANCE, NAME=I, PART=B\n*END INSTANCE\n");
    assert_int_equal(s.n, 1);
    says("1 parts have no *INSTANCE");
}

static void invalid_assemblies_are_refused(void **state)
{
    (void)state;
    refuses(PART("P", CUBE HEX) "*INSTANCE, NAME=I, PART=Q\n", "there is no part Q");
    refuses(PART("P", CUBE HEX) PART("p", CUBE HEX), "there is another part p");
    refuses("*INSTANCE, NAME=I\n*END INSTANCE\n*INSTANCE, NAME=i\n", "there is another instance i");
    refuses("*INSTANCE, NAME=I\n0\n1, 1, 1, 1, 1, 1, 90\n", "the axis of the instance has no length");
    refuses("*INSTANCE, NAME=I\n0\n1, 1, 1, 1, 1, 2, 90\n0\n", "two lines of data at most");
    refuses("*INSTANCE, NAME=I\n*PART, NAME=P\n", "*PART stands inside");
    refuses("*PART, NAME=P\n*PART, NAME=Q\n", "*PART stands inside");
    refuses("*PART, NAME=P\n*INSTANCE, NAME=Q\n", "*INSTANCE stands inside");
    refuses("*PART, NAME=P\n*ASSEMBLY, NAME=Q\n", "*ASSEMBLY stands inside");
    refuses("*PART, NAME=P\n" CUBE HEX, "the deck ends inside a part");
    refuses("*END PART\n", "*END PART without *PART");
    refuses("*END INSTANCE\n", "*END INSTANCE without *INSTANCE");
    refuses("*PART\n", "*PART needs NAME=");
    refuses("*INSTANCE, NAME=I, LIBRARY=old\n", "from an earlier analysis is not read");
    refuses("*PART, NAME=P\n" CUBE HEX "*END PART\n*INSTANCE, NAME=J, PART=P\n*END INSTANCE\n"
            "*ELSET, ELSET=A, INSTANCE=I\n1\n",
            "there is no instance I");
    refuses("*PART, NAME=P\n*NODE\n1, x\n", "deck:3: field 2 is \"x\", a number is expected");
    refuses(PART("P", "*NODE\n1\n2, 1\n*ELEMENT, TYPE=S3\n1, 1, 2, 7\n") "*INSTANCE, NAME=I, PART=P\n",
            "deck:6: the element refers to node 7, which is not defined");
}

/* --- coordinates and generation ------------------------------------------------------------------------- */

static void systems_place_nodes(void **state)
{
    (void)state;
    /* a cylinder's quarter turns are exact; a moved and rotated system; one with a projected axis; and
     * none */
    fl_mesh_quality q =
        reads("*NODE, SYSTEM=C\n1, 2, 0, 0\n2, 2, 90., 0\n3, 2, 180, 0\n4, 2, 270, 0\n*ELEMENT, TYPE=S4\n"
              "1, 1, 2, 3, 4\n");
    assert_near(q.area, 8.0, 1e-15);
    assert_near(q.box.lo.x, -2.0, 0.0);
    assert_near(q.box.hi.y, 2.0, 0.0);
    q = reads("*SYSTEM\n10, 0, 0, 10, 1, 0\n9, 5, 0\n*NODE\n1\n2, 1\n3, 1, 2\n4, 0, "
              "2\n*SYSTEM\n*NODE\n5\n*ELEMENT, TYPE=S4\n"
              "1, 1, 2, 3, 4\n*ELEMENT, TYPE=S3\n2, 1, 2, 5\n");
    assert_near(q.box.lo.x, 0.0, 0.0);
    assert_near(fl_part_aabb(&s.part[0]).hi.y, 1.0, 0.0);
    assert_near(s.part[0].v[2].x, 8.0, 0.0);
    q = reads("*SYSTEM\n0, 0, 1, 0, 3, 9\n*NODE\n1\n2, 1\n3, 1, 1\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n");
    assert_near(q.box.lo.x, -1.0, 0.0);
    assert_near(q.box.hi.y, 1.0, 0.0);
    assert_near(q.box.lo.z, 1.0, 0.0);
    q = reads("*SYSTEM\n0, 0, 1\n*NODE\n1\n2, 1\n3, 1, 1\n*ELEMENT, TYPE=S3\n1, 1, 2, 3\n");
    assert_near(q.box.hi.z, 1.0, 0.0);
    refuses("*SYSTEM\n0, 0, 0, 1, 0, 0\n2, 0, 0\n", "the points of *SYSTEM lie on one line");
    refuses("*SYSTEM\n0, 0, 0, 0, 0, 1\n*NODE\n", "the points of *SYSTEM lie on one line");
    refuses("*NODE, SYSTEM=S\n1\n", "SYSTEM= other than R and C is not read");
}

static void meshes_are_generated(void **state)
{
    (void)state;
    static const char deck[] =
        "*NODE\n1\n5, 4, 0, 0\n201, 0, 0, 2\n205, 4, 0, 2\n21, 0, 2, 0\n25, 4, 2\n221, 0, 2, 2\n225, 4, 2, "
        "2\n*NGEN\n1, 5\n"
        "21, 25, 1\n201, 205\n221, 225\n1, 21, 10\n5, 25, 10\n201, 221, 10\n205, 225, 10\n11, 15\n211, 215\n"
        "1, 201, 100\n5, 205, 100\n11, 211, 100\n15, 215, 100\n21, 221, 100\n25, 225, 100\n101, 105\n111, "
        "115\n121, 125\n"
        "*ELEMENT, TYPE=C3D8, ELSET=BODY\n1, 1, 2, 12, 11, 101, 102, 112, 111\n*ELGEN, ELSET=EALL\n"
        "1, 4, 1, 1, 2, 10, 10, 2, 100, 100\n";
    fl_mesh_quality q = reads(deck);
    assert_int_equal(q.triangles, 2 * 2 * (8 + 8 + 4));
    assert_true(q.closed);
    assert_near(q.volume, 16.0, 1e-15);
    assert_string_equal(s.part[0].name, "BODY");
    assert_near(takes(deck, "EALL").volume, 16.0, 1e-15);
    reads(CUBE HEX "*ELEMENT, TYPE=MASS\n5, 1\n*ELGEN\n5, 3\n"); /* of the skipped input */
    refuses("*NODE\n1\n2, 1\n*NGEN\n1, 4\n", "*NGEN refers to node 4, which is not defined yet");
    refuses("*NODE\n1\n4, 1\n*NGEN\n1, 4, 2\n", "nodes 1 to 4 by 2: steps that end there are expected");
    refuses("*NODE\n1\n4, 1\n*NGEN, LINE=C\n1, 4, 1, 9\n", "*NGEN on arcs and parabolas is not read");
    refuses("*NODE\n1\n900000000, 1\n*NGEN\n1, 900000000\n",
            "more than 2000000 nodes and elements are generated");
    refuses(CUBE HEX "*ELGEN\n7, 2\n", "*ELGEN refers to element 7");
    refuses(CUBE HEX "*ELGEN\n1, 2000, 1, 1, 2000, 1, 1, 2000\n", "more than 2000000");
    refuses(CUBE HEX "*ELGEN\n1, -2\n", "counts of 1 or more");
    refuses(CUBE HEX "*ELGEN\n1, 2, 0, -1\n", "this makes element 0");
}

/* --- files and refusals --------------------------------------------------------------------------------- */

static void included_files_are_read(void **state)
{
    (void)state;
    char deck[1200], nodes[200], mesh[200];
    snprintf(nodes, sizeof nodes, "%s", strrchr(test_file("nodes.txt", &CUBE[6], strlen(CUBE) - 6), '/') + 1);
    snprintf(mesh, sizeof mesh, "%s", strrchr(test_file("mesh.inp", CUBE HEX, strlen(CUBE HEX)), '/') + 1);
    snprintf(deck, sizeof deck, "*HEADING\n*Include, input=%s\n*STEP\n", mesh);
    assert_near(reads(deck).volume, 1.0, 0.0);
    snprintf(deck, sizeof deck, "*NODE, INPUT=%s\n" HEX, nodes);
    assert_near(reads(deck).volume, 1.0, 0.0);
    snprintf(deck, sizeof deck, "*NODE\n*INCLUDE, INPUT=\"%s\"\n9, 5, 5, 5\n" HEX, nodes);
    assert_near(reads(deck).volume, 1.0, 0.0);
    says("9 nodes");
    refuses("*INCLUDE, INPUT=none.inp\n", "deck:1: the file included here cannot be read: ");
    refuses("*INCLUDE\n", "*INCLUDE needs INPUT=");
    snprintf(deck, sizeof deck, "*INCLUDE, INPUT=%s\n", strrchr(test_path("deck"), '/') + 1);
    refuses(deck, "is included in itself");
}

static void unsupported_input_is_named(void **state)
{
    (void)state;
    static const char *const word[] = {"NCOPY, OLD SET=A",           "ELCOPY", "NFILL", "NMAP", "PARAMETER",
                                       "SYMMETRIC MODEL GENERATION", "IMPORT"};
    for (size_t k = 0; k < sizeof word / sizeof *word; k++) {
        char deck[1000];
        snprintf(deck, sizeof deck, CUBE HEX "*%s\n1\n", word[k]);
        refuses(deck, "is not read: export the deck with all nodes and elements written out");
        assert_non_null(strstr(err.text, "deck:12: *"));
    }
    refuses("*KEYWORD\n*NODE\n       1  0.0\n", "a deck of LS-DYNA is not read");
    refuses("*NODE\n1, 0, 1e999\n", "deck:2: field 3 is \"1e999\", a number is expected");
    refuses("*NODE\n0, 0, 1\n", "field 1 is \"0\", a number of 1 or more is expected");
    refuses("*NODE\n       1         0.0\n", "field 1 is ");
    refuses("*ELEMENT\n1, 1, 2, 3\n", "*ELEMENT needs TYPE=");
    refuses("*ELEMENT, TYPE=S3\n1, 1, 2.5, 3\n", "field 3 is \"2.5\", a whole number is expected");
    refuses("*ELEMENT, TYPE=S3\n1, 1, 0, 3\n", "corner 2 of the element is node 0");
}

/* Names are bytes: GBK (two lines end in bytes that look like commas and stars), Latin-1, quotes. */
static void names_are_bytes(void **state)
{
    (void)state;
    reads("*NODE\n1\n2, 1\n3, 0, 1\n4, 5\n*ELEMENT, TYPE=S3, ELSET=\xb5\xbc\xb9\xdc\xbc\xdc\n1, 1, 2, "
          "3\n*ELEMENT, "
          "TYPE=S3, ELSET=Tr\xe4ger\n"
          "2, 4, 3, 2\n");
    assert_int_equal(s.n, 2);
    assert_string_equal(s.part[0].name, "\xb5\xbc\xb9\xdc\xbc\xdc");
    assert_string_equal(s.part[1].name, "Tr\xe4ger");
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, setup, clear)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(lines_of_every_kind),
        TEST(elements_continue_over_lines),
        TEST(decks_are_read_as_by_calculix),
        TEST(types_have_shapes),
        TEST(other_types_are_counted),
        TEST(line_elements_have_radii),
        TEST(sets_may_contain_sets),
        TEST(nested_sets_are_fast),
        TEST(faces_follow_the_manual),
        TEST(surfaces_select_faces),
        TEST(instances_are_translated_then_rotated),
        TEST(other_assemblies_are_read),
        TEST(invalid_assemblies_are_refused),
        TEST(systems_place_nodes),
        TEST(meshes_are_generated),
        TEST(included_files_are_read),
        TEST(unsupported_input_is_named),
        TEST(names_are_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
