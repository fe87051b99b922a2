/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/decks.h"

/* Corners 1 to 8 of a unit cube in free field. */
#define CUBE                                                                                                 \
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,0.,0.,1.\n"             \
    "GRID,6,,1.,0.,1.\nGRID,7,,1.,1.,1.\nGRID,8,,0.,1.,1.\n"
#define HEX "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\n"

/* --- fields --------------------------------------------------------------------------------------------- */

static void fields_of_every_kind(void **state)
{
    (void)state;
    static const char *const text[] = {
        CUBE HEX,
        /* small field: adjoining numbers, E left out, three-digit exponents, tabs, comments, continuation
         * marks; in a deck with its control sections, letters of either case, CRLF */
        "$ a deck\r\nSOL 101\r\nCEND\r\nTITLE = A CHEXA, 1\r\n  SPC = 2\r\nBEGIN BULK\r\n$ nodes\r\n"
        "grid           1         0.0E+00-0.0E-010.0E+000\r\nGRID           2        1.-0    0.0      0.\r\n"
        "GRID    3               1.+0    10.-1   0.0-3   $ a remark\r\nGRID\t4\t\t\t1.\r\n"
        "GRID    5                               1.0E+000\r\nGRID    6               1.              1.\r\n"
        "GRID    7               .1+1    1.D0    +1.\r\nGRID    8                       1.      1.      0\r\n"
        "CHEXA   1       1       1       2       3       4       5       6       +A\r\n$ between\r\n\r\n"
        "+A      7       8\r\nENDDATA\r\nGRID,9,,x\r\n",
        /* large field, over two lines, with stars; free field with stars; all of them mixed in one entry */
        "GRID*                  1                              0.              0.\n*                     0.\n"
        "GRID*   2                               1.0000000000    0.0\n*       0.\n"
        "GRID*,3,,1.,1.\n*,0.\nGRID*,4,,0.,1.,*G4\n*G4,0.\nGRID,5,,,,1.\nGRID,6,,1.,0.,1.\nGRID    7         "
        "      1.      1.      1."
        "\nGRID,8,,,1.,1.\n"
        "CHEXA*                 1               1               1               2\n"
        "*                      3               4               5               6\n+       7       8\n",
        /* the same with blank fields left blank, continued by blanks and by a comma */
        CUBE "CHEXA   1       1       1       2       3       4       5       6\n        7       8\n",
        CUBE "CHEXA,1,1,1,2,3,4,5,6\n,7,8\n", "BEGIN,BULK\n" CUBE "CHEXA,1,,1,2,3,4,5,6,,\n,7,8\n"};
    for (size_t k = 0; k < sizeof text / sizeof *text; k++) {
        const fl_mesh_quality q = reads(text[k]);
        if (!q.closed || q.triangles != 12 || q.volume != 1.0) fail_msg("deck %d: %g", (int)k, q.volume);
        assert_string_equal(s.part[0].name, "property_1");
        says("8 nodes; elements: hex8 1");
    }
    refuses("GRID,1,,0.,0.,0.,,,,,7\n", "deck:1: 10 fields behind the name");
    refuses("GRID,x\n", "deck:1: field 2 of GRID is \"x\", a whole number is expected");
    refuses("GRID\n", "field 2 of GRID is \"\", a number of 1 or more is expected");
    refuses("\n$ c\nGRID,1,,1.e999\n" HEX, "deck:3: field 4 of GRID is \"1.e999\", a number is expected");
    refuses("GRID,1,-2\n", "field 3 of GRID is \"-2\", 0 or more is expected");
    refuses(CUBE "CHEXA,1,1,1,2,3,4,5,6\n", "deck:9: field 10 of CHEXA is \"\"");
    refuses(CUBE "CTRIA3,1,-1,1,2,3\n", "field 3 of CTRIA3 is \"-1\", a property is expected");
    refuses(CUBE "CTRIA3,1,1,1,2,9\n", "deck:9: the element refers to node 9, which is not defined");
    refuses(CUBE, "no triangles");
}

static void elements_of_every_kind(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        const char *counts;
        double area;
    } row[] = {{"CTRIA3,1,1,1,2,3", "tri3 1", 0.5},
               {"CTRIAR,1,1,1,2,3", "tri3 1", 0.5},
               {"CTRIA6,1,1,1,2,3,11,12,13", "tri6 1", 0.5},
               {"CTRIA6,1,1,1,2,3", "tri3 1", 0.5},
               {"CPLSTN3,1,1,1,2,3", "tri3 1", 0.5},
               {"CQUAD4,1,1,1,2,3,4", "quad4 1", 1.0},
               {"CQUADR,1,1,1,2,3,4", "quad4 1", 1.0},
               {"CSHEAR,1,1,1,2,3,4", "quad4 1", 1.0},
               {"CQUAD8,1,1,1,2,3,4,11,12\n,14,15", "quad8 1", 1.0},
               {"CQUAD8,1,1,1,2,3,4", "quad4 1", 1.0},
               {"CQUAD,1,1,1,2,3,4,11,12\n,14,15,13", "quad9 1", 1.0},
               {"CPYRAM,1,1,1,2,3,4,13", "pyramid5 1", 1.0},
               {"CPYRA,1,1,1,2,3,4,5", "pyramid5 1", 2.0 + 1.41421356237309505},
               {"CTETRA,1,1,1,2,4,5", "tet4 1", 1.5 + 0.866025403784438647}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        char deck[1000];
        snprintf(deck, sizeof deck,
                 CUBE "GRID,11,,.5\nGRID,12,,1.,.5\nGRID,13,,.5,.5\nGRID,14,,.5,1.\nGRID,15,,0.,.5\n%s\n",
                 row[k].text);
        const fl_mesh_quality q = reads(deck);
        says(row[k].counts);
        if (k != 11) assert_near(q.area, row[k].area, 1e-15);
    }
    reads(
        CUBE HEX
        "CELAS2,5,1.,1,1\nCONM2,6,1\nCBUSH,7,1,1\nCELAS2,8\nRBE2,9,1,123456,2,3,4\nPLOTEL,1,2,3\nCTRIAX6,10\n"
        "CSET1,3\nCMETHOD,1\n");
    says("skipped: CELAS2 2, CONM2 1, CBUSH 1, RBE2 1, PLOTEL 1, CTRIAX6 1");
    refuses(CUBE HEX "=,*1,=,*1.,==\n", "deck:11: replication (=) is not read");
    static const char *const model[] = {
        "BEGIN SUPER=1",         "begin bulk super = 12", "BEGIN BULK SUPER 1", "BEGIN AUXMODEL=1",
        "BEGIN BULK,AUXMODEL=1", "BEGIN BULK ARBMODEL=2", "BEGIN BULK MODULE=1"};
    for (size_t k = 0; k < sizeof model / sizeof *model; k++) {
        char deck[1000];
        snprintf(deck, sizeof deck, "BEGIN BULK\n" CUBE HEX "%s\n" CUBE HEX, model[k]);
        refuses(deck, "is not read: export one model");
    }
    assert_near(reads("BEGIN BULK SUPER=0\n" CUBE HEX).volume, 1.0, 0.0); /* the residual structure */
    assert_near(reads("BEGIN BULK\n" CUBE HEX "PSOLID,1,1\n").volume, 1.0, 0.0);
    /* acoustic fluids are not structure, wherever their property stands */
    assert_near(reads("PSOLID,2,1,,,,,PFLUID\n" CUBE HEX "CHEXA,2,2,1,2,3,4,5,6,+\n+,7,8\n").volume, 1.0,
                0.0);
    says("elements: hex8 1");
    says("skipped: solids of PFLUID 1");
    refuses(CUBE HEX "PSOLID,1,1,,,,,FFLUID\n", "no triangles");
}

static void line_elements_have_radii(void **state)
{
    (void)state;
    reads("GRID,1\nGRID,2,,4.\nCBAR,1,1,1,2,0.,0.,1.\nCBEAM,2,2,1,2\nCROD,3,3,1,2\nCTUBE,4,4,1,2\nCONROD,5,1,"
          "2,1,12.5663706143592\n"
          "CBAR,6,5,1,2\nCBAR,7,6,1,2\nPBARL,1,1,,TUBE\n,.5,.4\nPBEAML,2,1,,ROD,,,,\n,.25\nPROD,3,1,3."
          "14159265358979\n"
          "PTUBE,4,1,2.,.1,,1.\nPBARL,5,1,,BOX\n,.5,.4,.1,.1\nPBARL,6,1,,TUBE2\n,.75,.1\n");
    static const struct {
        const char *name;
        double r0, r1;
    } row[] = {{"property_1", .5, .5}, {"property_2", .25, .25}, {"property_3", 1, 1},
               {"property_4", 1, .5},  {"conrod", 2, 2},         {"property_6", .75, .75}};
    assert_int_equal(s.n, 6);
    says("1 lines without a section radius");
    for (int k = 0; k < 6; k++) {
        assert_string_equal(s.part[k].name, row[k].name);
        assert_near(s.part[k].cone[0].r0, row[k].r0, 1e-14);
        assert_near(s.part[k].cone[0].r1, row[k].r1, 1e-14);
    }
    refuses("GRID,1\nGRID,2,,4.\nCROD,1,1,1,2\nPTUBE,1,1,-2.\n", "PTUBE 1 is -2 wide, 0 or more is expected");
    refuses("GRID,1\nGRID,2,,4.\nCONROD,1,1,2,1,-1.\n", "CONROD 1 has the area -1");
}

static void parts_are_named_by_comments(void **state)
{
    (void)state;
    reads(CUBE "CTRIA3,1,1,1,2,3\nCTRIA3,2,2,1,2,4\nCTRIA3,3,3,1,2,5\nCTRIA3,4,4,1,2,6\nCTRIA3,5,5,1,2,7\n"
               "$HMNAME PROP                   1\"left leg\" 4\n$ANSA_NAME_COMMENT;2;PSHELL;\xb5\xbc;;NO;\n"
               "$ Femap Property 3 : deck \n$ Femap with NX Nastran Property 4 : "
               "deck\n$ANSA_NAME_COMMENT;5;MAT1;x;\n"
               "$HMNAME PROP x\n$ Femap Property 9\n$\n$HMNAME PROP 77777777777777777777\"a\"\n");
    static const char *const name[] = {"left_leg", "\xb5\xbc", "deck", "deck_4", "property_5"};
    assert_int_equal(s.n, 5);
    for (int k = 0; k < 5; k++) assert_string_equal(s.part[k].name, name[k]);
}

/* --- coordinate systems --------------------------------------------------------------------------------- */

/* Expects the corner of the triangle of grids 1, 91, 92 at (x, y, z). */
static void expect_grid_at(const char *text, double x, double y, double z)
{
    char deck[2000];
    snprintf(deck, sizeof deck, "%sGRID,91,0,50.\nGRID,92,0,0.,50.\nCTRIA3,1,1,1,91,92\n", text);
    reads(deck);
    const fl_vec3 v = s.part[0].v[s.part[0].t[0].v[0]];
    assert_near_of(v.x, x, 1e-14, 10.0);
    assert_near_of(v.y, y, 1e-14, 10.0);
    assert_near_of(v.z, z, 1e-14, 10.0);
}

static void grids_stand_in_systems(void **state)
{
    (void)state;
    static const char moved[] = "CORD2R,5,,10.,0.,0.,10.,0.,1.\n,10.,1.,0.\n"; /* x along y, at (10, 0, 0) */
    char deck[1000];
    snprintf(deck, sizeof deck, "GRID,1,5,1.,2.,3.\n%s", moved); /* given before its system */
    expect_grid_at(deck, 8, 1, 3);
    snprintf(deck, sizeof deck, "%sGRID,1,,1.,2.,3.\nGRDSET,,5\n", moved); /* by default, given last */
    expect_grid_at(deck, 8, 1, 3);
    snprintf(deck, sizeof deck, "%sGRID,1,0,1.,2.,3.\nGRDSET,,5\n", moved);
    expect_grid_at(deck, 1, 2, 3);
    /* a cylinder and a sphere in the moved one: quarter turns are exact */
    snprintf(deck, sizeof deck, "CORD2C,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,6,2.,90.,3.\n%s", moved);
    expect_grid_at(deck, 8, 0, 3);
    snprintf(deck, sizeof deck, "CORD2S,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,6,2.,90.,90.\n%s", moved);
    expect_grid_at(deck, 8, 0, 0);
    expect_grid_at("CORD2S,6,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,6,2.,60.,0.\n", 1.7320508075688772, 0, 1);
    /* by grids, which are given in systems themselves; two systems on one line */
    snprintf(
        deck, sizeof deck,
        "%sCORD1C,8,11,12,13,9,11,13,12\nGRID,11,5,1.\nGRID,12,5,2.\nGRID,13,5,1.,1.\nGRID,1,8,2.,0.,4.\n",
        moved);
    expect_grid_at(deck, 8, 5, 0);
    snprintf(
        deck, sizeof deck,
        "%sCORD1R,8,11,12,13,9,11,13,12\nGRID,11,5,1.\nGRID,12,5,2.\nGRID,13,5,1.,1.\nGRID,1,9,2.,0.,4.\n",
        moved);
    expect_grid_at(deck, 6, 3, 0);
    expect_grid_at("CORD2R*,5,,10.,0.\n*,0.,10.,0.,1.\n*,10.,1.,0.\nGRID,1,5,1.,2.,3.\n", 8, 1, 3);
}

static void invalid_systems_are_refused(void **state)
{
    (void)state;
#define TRI "CTRIA3,1,1,1,2,3\n"
    refuses("GRID,1,7\nGRID,2\nGRID,3\n" TRI,
            "deck:1: grid 1 refers to coordinate system 7, which is not defined");
    refuses("CORD2R,5,6,10.,0.,0.,10.,0.,1.\n,10.,1.,0.\nGRID,1,5\nGRID,2\nGRID,3\n" TRI,
            "deck:1: coordinate system 6 is not defined");
    refuses("CORD2R,5,6,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,6,5,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,"
            "5\nGRID,2\nGRID,3\n" TRI,
            "is defined by itself");
    refuses("CORD1R,5,1,2,3\nGRID,1,5\nGRID,2,,1.\nGRID,3,,0.,1.\n" TRI,
            "deck:2: grid 1 stands in a coordinate system that it defines");
    refuses("CORD1R,5,2,3,4\nGRID,1,5\nGRID,2,,1.\nGRID,3,,0.,1.\n" TRI, "deck:1: grid 4 is not defined");
    refuses("CORD1R,5,2,3,2\nGRID,1,5\nGRID,2,,1.\nGRID,3,,0.,1.\n" TRI,
            "the points of coordinate system 5 lie on one line");
    refuses("CORD1R,5,2\nGRID,1,5\nGRID,2,,1.\nGRID,3,,0.,1.\n" TRI, "field 4 of CORD1R is \"\"");
    refuses("GRDSET,,-3\n" CUBE HEX, "GRDSET names coordinate system -3");
}

/* A circular chain of systems is refused, and a long legal one is read. */
static void chains_of_systems(void **state)
{
    (void)state;
    char *deck = malloc(8000000);
    for (int n = 900; n <= 60000; n *= 60) {
        size_t len = (size_t)sprintf(deck, CUBE HEX "GRID,99,%d,1.,1.,1.\nCTRIA3,9,1,1,2,99\n", n);
        for (int k = 1; k <= n; k++)
            len += (size_t)sprintf(deck + len, "CORD2R,%d,%d,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n", k, k - 1);
        if (n < 1000) assert_near(reads(deck).box.hi.z, 1.0, 0.0);
        else refuses(deck, "are defined in one another more than 1000 deep");
    }
    free(deck);
}

/* --- files ---------------------------------------------------------------------------------------------- */

static void included_files_are_read(void **state)
{
    (void)state;
    char deck[2000], name[200];
    snprintf(name, sizeof name, "%s", strrchr(test_file("cube.bdf", CUBE, strlen(CUBE)), '/') + 1);
    snprintf(deck, sizeof deck, "SOL 101\nCEND\nBEGIN BULK\nINCLUDE '%s'\n" HEX "ENDDATA\n", name);
    assert_near(reads(deck).volume, 1.0, 0.0);
    snprintf(deck, sizeof deck, "include \"%.5s\n%s\" $ over two lines\n" HEX, name, name + 5);
    assert_near(reads(deck).volume, 1.0, 0.0);
    snprintf(deck, sizeof deck, HEX "  INCLUDE %s\n", name);
    refuses(
        deck,
        "unknown format"); /* without quotes it could be anything, so it does not identify the format ... */
    snprintf(deck, sizeof deck, "BEGIN BULK\n" HEX "  INCLUDE %s\n", name);
    assert_near(reads(deck).volume, 1.0, 0.0); /* ... but it is read */
    refuses("INCLUDE 'none.bdf'\n", "deck:1: the file included here cannot be read: ");
    /* before BEGIN BULK it holds commands */
    assert_near(reads("SOL 101\nINCLUDE 'none.inc'\nCEND\nBEGIN BULK\n" CUBE HEX).volume, 1.0, 0.0);
    says("1 INCLUDE before BEGIN BULK could not be read");
    refuses("BEGIN BULK\n" CUBE HEX "INCLUDE 'none.inc'\n", "deck:12: the file included here cannot be read");
    refuses(CUBE HEX "INCLUDE 'none.inc'\nENDDATA\n", "deck:11: the file included here cannot be read");
    refuses("INCLUDE 'none.bdf\n", "deck:1: the name of the file to include has no closing quote");
    refuses("BEGIN BULK\nINCLUDE '\n'\n", "a file to include is expected");
}

/* Text that only resembles a deck, and decks that resemble another format. */
static void other_decks_are_recognised(void **state)
{
    (void)state;
    refuses("GRIDDLE CAKES\n", "unknown format");
    refuses("a letter\nto nobody\n", "unknown format");
    assert_int_equal(reads("$ v 1 2 3\n" CUBE HEX).triangles, 12);
    assert_int_equal(reads("FACILITY A\nBEGIN BULK\n" CUBE HEX).triangles, 12);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, setup, clear)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(fields_of_every_kind),        TEST(elements_of_every_kind),  TEST(line_elements_have_radii),
        TEST(parts_are_named_by_comments), TEST(grids_stand_in_systems),  TEST(invalid_systems_are_refused),
        TEST(chains_of_systems),           TEST(included_files_are_read), TEST(other_decks_are_recognised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
