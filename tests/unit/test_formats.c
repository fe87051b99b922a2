/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same body by every format that knows finite elements: the same triangles in the same parts. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "mesh/read_mesh.h"
#include "support/mesh.h"
#include "support/model.h"
#include "support/near.h"

static const enum fl_shape SHAPES[] = {FL_HEX8,  FL_WEDGE6,  FL_TET4,  FL_PYRAMID5, FL_HEX20,
                                       FL_TET10, FL_WEDGE15, FL_QUAD4, FL_TRI3};

typedef void put_fn(FILE *f, const model *m, int variant);

/* --- ANSYS ---------------------------------------------------------------------------------------------- */

/* Solids that are no bricks are collapsed ones in this format: nodes of a brick (edges in the middle of a
 * collapsed one are its corner). */
static int ansys_nodes(const model_element *e, int64_t node[20])
{
    static const struct {
        enum fl_shape shape;
        int n;
        int8_t at[20];
    } collapsed[] = {{FL_WEDGE6, 8, {0, 1, 2, 2, 3, 4, 5, 5}},
                     {FL_TET4, 8, {0, 1, 2, 2, 3, 3, 3, 3}},
                     {FL_PYRAMID5, 8, {0, 1, 2, 3, 4, 4, 4, 4}},
                     {FL_TRI3, 4, {0, 1, 2, 2}},
                     {FL_WEDGE15, 20, {0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14}}};
    for (size_t k = 0; k < sizeof collapsed / sizeof collapsed[0]; k++)
        if (collapsed[k].shape == e->shape) {
            for (int i = 0; i < collapsed[k].n; i++) node[i] = e->node[collapsed[k].at[i]];
            return collapsed[k].n;
        }
    memcpy(node, e->node, sizeof e->node);
    return fl_shape_nodes(e->shape);
}

static int ansys_routine(enum fl_shape shape)
{
    if (shape == FL_QUAD4 || shape == FL_TRI3) return 181;
    if (shape == FL_TET10) return 187;
    return shape == FL_HEX20 || shape == FL_WEDGE15 ? 186 : 185;
}

static void put_cdb(FILE *f, const model *m, int bare)
{
    fprintf(f, "/COM,an archive\n/PREP7\nET,       1,%d\n", ansys_routine(m->e[0].shape));
    fprintf(f, "NBLOCK,6,SOLID,%10lld,%10d\n(3i9,6e21.13e3)\n", 9999LL, m->nodes);
    for (int32_t n = 0; n < m->nodes; n++)
        fprintf(f, "%9lld        0        0%21.13E%21.13E%21.13E\n", (long long)m->id[n], m->x[n].x,
                m->x[n].y, m->x[n].z);
    fprintf(f, "N,R5.3,LOC,       -1,\n");
    fprintf(f, bare ? "EBLOCK,10,,,%d\n(15i9)\n" : "EBLOCK,19,SOLID,9999,%d\n(19i9)\n", m->elements);
    for (int32_t i = 0; i < m->elements; i++) {
        int64_t node[20];
        const int n = ansys_nodes(&m->e[i], node), row = bare ? 10 : 8;
        if (bare) fprintf(f, "%9lld        1        1        1        0", (long long)m->e[i].id);
        else
            fprintf(
                f,
                "        1        1        1        1        0        0        0        0%9d        0%9lld",
                n, (long long)m->e[i].id);
        for (int k = 0; k < n; k++) fprintf(f, k == row ? "\n%9lld" : "%9lld", (long long)node[k]);
        fputc('\n', f);
    }
    fprintf(f, "%9d\n", -1);
    for (int32_t p = 0; p < MODEL_PARTS; p++) {
        int32_t n = 0;
        for (int32_t i = 0; i < m->elements; i++) n += m->e[i].part == p;
        fprintf(f, "CMBLOCK,%-8s,ELEM,%8d  ! a component\n(8i10)\n", m->part[p], n);
        n = 0;
        for (int32_t i = 0; i < m->elements; i++)
            if (m->e[i].part == p) fprintf(f, ++n % 8 ? "%10lld" : "%10lld\n", (long long)m->e[i].id);
        fputc('\n', f);
    }
    fprintf(f, "FINISH\n");
}

/* --- the test ------------------------------------------------------------------------------------------- */

static const char *written(put_fn *put, const model *m, int variant)
{
    const char *path = test_path("model");
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    put(f, m, variant);
    assert_int_equal(fclose(f), 0);
    return path;
}

static void check(put_fn *put, const char *format, int variant)
{
    static model m;
    for (size_t k = 0; k < sizeof SHAPES / sizeof SHAPES[0]; k++) {
        fl_surface truth = {0}, got = {0};
        fl_err err = {0};
        char note[FL_MESH_NOTE];
        model_make(&m, SHAPES[k]);
        model_surface(&m, &truth);
        if (fl_mesh_read(&got, written(put, &m, variant), note, &err))
            fail_msg("%s %d of %s: %s", format, variant, fl_shape_name(SHAPES[k]), err.text);
        if (!mesh_sound(&got) || !model_same(&got, &truth))
            fail_msg("%s %d of %s: other triangles\n%s", format, variant, fl_shape_name(SHAPES[k]), note);
        fl_surface_free(&truth);
        fl_surface_free(&got);
    }
}

static void ansys_gives_the_same(void **state)
{
    (void)state;
    check(put_cdb, "cdb", 0);
    check(put_cdb, "cdb", 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ansys_gives_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
