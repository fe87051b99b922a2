/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "mesh/read_mesh.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;
static char note[FL_MESH_NOTE];
static fl_surface s;

static int read_bytes(const char *data, size_t n, fl_import_options *w)
{
    fl_surface_free(&s);
    err = (fl_err){0};
    return fl_mesh_read(&s, test_file("deck.msh", data, n), w, note, &err);
}

static void expect_read(const char *text)
{
    if (read_bytes(text, strlen(text), NULL)) fail_msg("%s", err.text);
    assert_true(mesh_sound(&s));
}

static void expect_refusal(const char *text, const char *why)
{
    assert_int_equal(read_bytes(text, strlen(text), NULL), -1);
    assert_int_equal(err.code, FL_INPUT);
    if (!strstr(err.text, why)) fail_msg("\"%s\" says nothing of \"%s\"", err.text, why);
}

#define HEAD2 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define HEAD4 "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
#define NODES2 "$Nodes\n5\n1 0 0 0\n20 1 0 0\n300 1 2 0\n4000 0 2 0\n50000 0 0 3\n$EndNodes\n"

static void groups_become_parts(void **state)
{
    static const char text[] = HEAD2
        "$PhysicalNames\n2\n2 7 \"the \\deck\"\n3 7 \"another\"\n$EndPhysicalNames\n" NODES2
        "$Elements\n5\n1 15 2 0 1 1\n2 2 2 7 1 1 20 300\n3 2 2 9 1 300 4000 1\n"
        "4 2 0 1 20 50000\n5 3 3 9 1 4 1 20 300 4000\n$EndElements\n$NodeData\n1\n\"f\"\n$EndNodeData\n";
    (void)state;
    expect_read(text);
    assert_int_equal(s.n, 3);
    assert_non_null(strstr(s.part[0].name, "deck")); /* elements without a group are named by the file */
    assert_int_equal(s.part[0].nt, 1);
    assert_string_equal(s.part[1].name, "the_\\deck");
    assert_int_equal(s.part[1].nt, 1);
    assert_string_equal(s.part[2].name, "surface_9");
    assert_int_equal(s.part[2].nt, 3);
    assert_non_null(strstr(note, "point 1"));
}

/* Version 2 writes an element of two groups twice: it is one element, and both groups can be selected. */
static void an_element_of_two_groups_is_read_once(void **state)
{
    static const char text[] =
        HEAD2 NODES2 "$Elements\n5\n1 4 2 1 1 1 20 300 50000\n2 4 2 2 1 1 20 300 50000\n"
                     "3 4 2 2 1 1 300 4000 50000\n$EndElements\n";
    static const char fixed[] =
        HEAD2 NODES2 "$Elements\n3\n1 4 2 1 1 1 20 300 50000\n"
                     "2 4 2 2 1 1 20 300 50000\n3 4 2 2 1 1 300 4000 50000\n$EndElements\n";
    const char *pattern[] = {"volume_2"};
    fl_import_options w = {.pattern = pattern, .patterns = 1};
    (void)state;
    expect_refusal(text, "an element is \"$EndElements\"");
    expect_read(fixed);
    assert_int_equal(s.n, 2);
    assert_int_equal(s.part[0].nt + s.part[1].nt, 6);
    assert_int_equal(read_bytes(fixed, strlen(fixed), &w), 0);
    assert_int_equal(s.n, 1);
    assert_int_equal(s.part[0].nt, 6);
}

static void entities_name_groups(void **state)
{
    static const char text[] =
        "$Comments\nanything $EndComment\n$EndComments\n" HEAD4
        "$Entities\n1 0 2 0\n1 0 0 0 0\n5 0 0 0 1 2 0 2 7 -8 0\n6 0 0 0 1 2 0 0 3 1 2 -3\n$EndEntities\n"
        "$Nodes\n2 4 1 4\n2 5 1 2\n4\n3\n0 0 0 .1 .2\n1 0 0 .3 .4\n2 6 0 2\n2\n1\n1 1 0\n0 1 0\n$EndNodes\n"
        "$Elements\n2 2 1 2\n2 5 2 1\n1 4 3 2\n2 6 2 1\n9 2 1 4\n$EndElements\n";
    const char *pattern[] = {"surface_8"};
    fl_import_options w = {.pattern = pattern, .patterns = 1};
    (void)state;
    expect_read(text);
    assert_int_equal(s.n, 2);
    assert_non_null(strstr(s.part[0].name, "deck"));
    assert_string_equal(s.part[1].name, "surface_7");
    assert_int_equal(read_bytes(text, strlen(text), &w), 0);
    assert_int_equal(s.n, 1);
    assert_int_equal(s.part[0].nt, 1);
    assert_near(s.part[0].v[0].y, 1.0, 0.0);
}

static void partitioned_elements_keep_their_groups(void **state)
{
    (void)state;
    expect_read(
        HEAD4
        "$PartitionedEntities\n2\n1 5 1\n0 0 1 0\n7 2 5 1 1 0 0 0 1 2 0 1 3 0\n$EndPartitionedEntities\n"
        "$Nodes\n1 3 1 3\n2 5 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
        "$Elements\n1 1 1 1\n2 7 2 1\n1 1 2 3\n$EndElements\n");
    assert_string_equal(s.part[0].name, "surface_3");
}

/* A row without all nodes of its type is not filled from the next one. */
static void elements_have_their_nodes_on_their_line(void **state)
{
    (void)state;
    expect_refusal(HEAD2 NODES2 "$Elements\n2\n1 3 2 0 1 1 20 300\n2 3 2 0 1 20 300 4000 1\n$EndElements\n",
                   "deck.msh:14: this element has fewer nodes on its line than its type");
    expect_refusal(HEAD2 NODES2 "$Elements\n1\n1 11 2 0 1 1 20 300 50000\n$EndElements\n",
                   "deck.msh:14: element 1 of type 11 has fewer than 10 nodes on its line");
    expect_refusal(HEAD2 NODES2 "$Elements\n1\n1 2 2 0 1 1 x 300\n$EndElements\n", "a node is \"x\"");
    expect_read(HEAD2 NODES2 "$Elements\n2\n1 3 2 0 1 1 20\n300 4000\n2 2 2 0 1 1 20 50000\n$EndElements\n");
}

/* Nodes with parameters: none at a point and in a volume, one on a curve, two on a surface. */
static void nodes_may_have_parameters(void **state)
{
    static const char text[] =
        HEAD2 "$ParametricNodes\n4\n1 0 0 0 0 1\n2 1 0 0 1 7 0.5\n3 0 1 0 2 9 0.25 0.75\n4 0 0 1 3 1\n"
              "$EndParametricNodes\n$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n";
    static const int32_t dim[4] = {0, 1, 2, 3};
    unsigned char data[600];
    size_t n = 0;
    (void)state;
    expect_read(text);
    assert_int_equal(s.part[0].nt, 4);
    expect_refusal(HEAD2 "$ParametricNodes\n1\n1 0 0 0 4 1\n$EndParametricNodes\n",
                   "on an entity of dimension 4");
    expect_refusal(HEAD4 "$ParametricNodes\n1\n1 0 0 0 1 1\n$EndParametricNodes\n", "belongs to version 2");
    /* binary, and no line ends behind the data */
    n += (size_t)sprintf((char *)data + n, "$MeshFormat\n2.2 1 8\n");
    memcpy(data + n, &(int32_t){1}, 4), n += 4;
    n += (size_t)sprintf((char *)data + n, "\n$EndMeshFormat\n$ParametricNodes\n4\n");
    for (int k = 0; k < 4; k++) {
        const int32_t tag = k + 1;
        const double x[3] = {k == 1, k == 2, k == 3}, u[2] = {0.5, 0.25};
        memcpy(data + n, &tag, 4), n += 4;
        memcpy(data + n, x, sizeof x), n += sizeof x;
        memcpy(data + n, &dim[k], 4), n += 4;
        memcpy(data + n, &tag, 4), n += 4;
        if (dim[k] % 3) memcpy(data + n, u, 8 * (size_t)dim[k]), n += 8 * (size_t)dim[k];
    }
    n += (size_t)sprintf((char *)data + n, "$EndParametricNodes\n$NodeData\n1\n\"f\"\n0\n3\n0\n1\n1\n");
    memcpy(data + n, &(int32_t){1}, 4), n += 4;
    memcpy(data + n, &(double){0.5}, 8), n += 8;
    n += (size_t)sprintf((char *)data + n, "$EndNodeData\n$Elements\n1\n");
    {
        const int32_t head[3] = {4, 1, 0}, element[5] = {1, 1, 2, 3, 4};
        memcpy(data + n, head, sizeof head), n += sizeof head;
        memcpy(data + n, element, sizeof element), n += sizeof element;
    }
    n += (size_t)sprintf((char *)data + n, "$EndElements\n");
    if (read_bytes((const char *)data, n, NULL)) fail_msg("%s", err.text);
    assert_int_equal(s.part[0].nt, 4);
}

static void high_orders_are_read_by_their_corners(void **state)
{
    (void)state;
    expect_read(HEAD2
                "$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .3 0 0\n5 .6 0 0\n6 .6 .3 0\n7 .3 .6 0\n8 0 .6 0\n"
                "9 0 .3 0\n10 .3 .3 0\n$EndNodes\n$Elements\n1\n1 21 0 1 2 3 4 5 6 7 8 9 10\n$EndElements\n");
    assert_int_equal(s.part[0].nt, 1);
    assert_non_null(strstr(note, "1 elements of order 3 or more"));
}

static void bad_files_are_reported_with_their_line(void **state)
{
    static const char binary[] = "$MeshFormat\n4.1 1 8\n\1\0\0\0\n$EndMeshFormat\n$Nodes\n\1\0\0\0\0\0\0\0";
    static const char order[] = "$MeshFormat\n4.1 1 8\n\1\2\3\4\n$EndMeshFormat\n";
    (void)state;
    expect_refusal("$MeshFormat\n4 0 8\n$EndMeshFormat\n",
                   ":2: version 4 of the format is not read: save as 2.2 or 4.1");
    expect_refusal("$NOD\n3\n", "version 1 of the format");
    expect_refusal("$MeshFormat\n2.2 2 8\n$EndMeshFormat\n", "file type \"2\"");
    expect_refusal("$MeshFormat\n2.2 0 16\n$EndMeshFormat\n", "data size \"16\"");
    expect_refusal("$MeshFormat\n2.2 0 8\n$Nodes\n", "\"$Nodes\" was found, $EndMeshFormat is expected");
    expect_refusal("$PhysicalNames\n1\n2 x \"a\"\n", "DIMENSION TAG \"NAME\" is expected");
    expect_refusal(HEAD2 "$Nodes\n2000000000\n1 0 0 0\n", "the file ends where the number of a node");
    expect_refusal(HEAD2 "$Nodes\n1\n1 0 inf 0\n$EndNodes\n", ":6: y is \"inf\"");
    expect_refusal(HEAD2 "$Nodes\n1\n0 0 0 0\n$EndNodes\n", "node 0 was found");
    expect_refusal(HEAD2 NODES2 "$Elements\n1\n1 2 2 7 1 1 20 30\n$EndElements\n",
                   ":14: the element refers to node 30, which is not defined");
    expect_refusal(HEAD2 NODES2 "$Elements\n1\n1 140 2 7 1 1 20 30\n$EndElements\n",
                   "element type 140 is not known");
    expect_refusal(HEAD2 NODES2 "$Elements\n0\n$EndElements\n", "no elements: put the parts to import");
    expect_refusal(HEAD4 "$Elements\n1 1 1 1\n3 1 2 1\n",
                   "elements of type 2 are in an entity of dimension 3");
    expect_refusal(HEAD2 "$Parametrizations\n1\n", "the file ends inside $Parametrizations");
    assert_int_equal(read_bytes(binary, sizeof binary - 1, NULL), -1);
    assert_non_null(strstr(err.text, "byte 55: the file ends inside the data"));
    assert_int_equal(read_bytes(order, sizeof order - 1, NULL), -1);
    assert_non_null(strstr(err.text, "in either byte order"));
}

static void free_all(void **state)
{
    (void)state;
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(groups_become_parts),
        cmocka_unit_test(an_element_of_two_groups_is_read_once),
        cmocka_unit_test(entities_name_groups),
        cmocka_unit_test(partitioned_elements_keep_their_groups),
        cmocka_unit_test(elements_have_their_nodes_on_their_line),
        cmocka_unit_test(nodes_may_have_parameters),
        cmocka_unit_test(high_orders_are_read_by_their_corners),
        cmocka_unit_test(bad_files_are_reported_with_their_line),
        cmocka_unit_test(free_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
