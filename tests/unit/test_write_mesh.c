/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every writer: its output is read back as the same triangles, in the same parts where the format has
 * parts. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/rng.h"
#include "geom/facet.h"
#include "geom/weld.h"
#include "mesh/read_mesh.h"
#include "mesh/write_obj.h"
#include "mesh/write_off.h"
#include "mesh/write_ply.h"
#include "mesh/write_stl.h"
#include "mesh/write_vtp.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;
static char note[FL_MESH_NOTE];

/* Parts of random shape with the digits of a double or only of a float32. */
static void make_model(fl_surface *s, int parts, int floats)
{
    for (int i = 0; i < parts; i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        char name[20];
        fl_part *p;
        fl_weld w;
        snprintf(name, sizeof name, "part-%d", i);
        assert_int_equal(fl_surface_add(s, name, strlen(name), &err), i);
        p = &s->part[i];
        fl_facet_cone(p, &(fl_cone){v3(fl_rng_in(&g, -9, 9), 1e-3, -2), v3(0, 1, 3), fl_rng_in(&g, 1, 2), 1},
                      5 + 3 * i, &err);
        for (int32_t v = 0; floats && v < p->nv; v++) {
            volatile float x = (float)p->v[v].x, y = (float)p->v[v].y, z = (float)p->v[v].z;
            p->v[v] = v3((double)x, (double)y, (double)z);
        }
        assert_int_equal(fl_part_weld(p, 0.0, &w, &err), 0);
    }
}

/* All parts as one, as in a format without parts. */
static void merge(const fl_surface *s, fl_surface *out)
{
    fl_part *p;
    fl_weld w;
    assert_int_equal(fl_surface_add(out, "all", 3, &err), 0);
    p = &out->part[0];
    for (int32_t i = 0; i < s->n; i++) {
        const int32_t first = p->nv;
        for (int32_t v = 0; v < s->part[i].nv; v++) fl_surface_vertex(p, s->part[i].v[v], &err);
        for (int32_t t = 0; t < s->part[i].nt; t++) {
            const int32_t *v = s->part[i].t[t].v;
            fl_surface_triangle(p, first + v[0], first + v[1], first + v[2], &err);
        }
    }
    assert_int_equal(fl_part_weld(p, 0.0, &w, &err), 0);
}

typedef void write_fn(FILE *f, const fl_surface *s);
static void put_ply(FILE *f, const fl_surface *s) { assert_int_equal(fl_ply_write(f, s, &err), 0); }

static void round_trip(write_fn *put, const fl_surface *s, const fl_surface *expected)
{
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    fl_surface back = {0};
    fl_weld w;
    put(f, s);
    assert_int_equal(fclose(f), 0);
    if (fl_mesh_read(&back, test_file("all", text, n), NULL, note, &err)) fail_msg("%s", err.text);
    free(text);
    assert_int_equal(back.n, expected->n);
    for (int32_t i = 0; i < back.n; i++) {
        assert_int_equal(fl_part_weld(&back.part[i], 0.0, &w, &err), 0);
        if (expected->n == 1) { /* named by its file */
            free(back.part[i].name);
            back.part[i].name = strdup("all");
        }
    }
    assert_true(mesh_same(&back, expected));
    fl_surface_free(&back);
}

static void all_digits_and_all_parts_are_read_back(void **state)
{
    (void)state;
    for (int parts = 2; parts < 6; parts++) {
        fl_surface s = {0};
        make_model(&s, parts, 0);
        round_trip(fl_stl_write_ascii, &s, &s);
        round_trip(fl_obj_write, &s, &s);
        round_trip(put_ply, &s, &s);
        fl_surface_free(&s);
    }
}

static void formats_without_parts_keep_the_triangles(void **state)
{
    fl_surface s = {0}, one = {0}, all = {0};
    (void)state;
    make_model(&s, 3, 0);
    merge(&s, &all);
    round_trip(fl_off_write, &s, &all);
    fl_surface_free(&all);
    make_model(&one, 3, 1);
    merge(&one, &all);
    round_trip(fl_stl_write_binary, &one, &all);
    fl_surface_free(&all);
    fl_surface_free(&one);
    fl_surface_free(&s);
}

static uint64_t take_uint(const unsigned char **at, int n)
{
    uint64_t u = 0;
    for (int k = 0; k < n; k++) u |= (uint64_t) * (*at)++ << 8 * k;
    return u;
}

/* The appended blocks: part of each triangle, points, corners, ends, each with its size. */
static void a_vtp_file_holds_the_same(void **state)
{
    fl_surface s = {0};
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    const unsigned char *at;
    int32_t nv = 0, nt = 0, first = 0, k = 0;
    (void)state;
    make_model(&s, 3, 0);
    for (int32_t i = 0; i < s.n; i++) {
        nv += s.part[i].nv;
        nt += s.part[i].nt;
    }
    assert_int_equal(fl_vtp_write(f, &s, &err), 0);
    assert_int_equal(fclose(f), 0);
    assert_non_null(strstr(text, "NumberOfPolys"));
    at = (const unsigned char *)strstr(text, "encoding=\"raw\">\n_") + 17;
    assert_int_equal(take_uint(&at, 8), 4 * nt);
    for (int32_t i = 0; i < s.n; i++)
        for (int32_t t = 0; t < s.part[i].nt; t++) assert_int_equal(take_uint(&at, 4), s.part[i].id);
    assert_int_equal(take_uint(&at, 8), 24 * nv);
    for (int32_t i = 0; i < s.n; i++)
        for (int32_t v = 0; v < s.part[i].nv; v++) {
            const double expected[3] = {s.part[i].v[v].x, s.part[i].v[v].y, s.part[i].v[v].z};
            for (int c = 0; c < 3; c++) {
                const uint64_t bits = take_uint(&at, 8);
                double x;
                memcpy(&x, &bits, sizeof x);
                assert_true(x == expected[c]);
            }
        }
    assert_int_equal(take_uint(&at, 8), 12 * nt);
    for (int32_t i = 0; i < s.n; first += s.part[i++].nv)
        for (int32_t t = 0; t < s.part[i].nt; t++)
            for (int c = 0; c < 3; c++) assert_int_equal(take_uint(&at, 4), first + s.part[i].t[t].v[c]);
    assert_int_equal(take_uint(&at, 8), 4 * nt);
    while (k++ < nt) assert_int_equal(take_uint(&at, 4), 3 * k);
    assert_memory_equal(at, "\n</AppendedData>", 16);
    free(text);
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_digits_and_all_parts_are_read_back),
                                       cmocka_unit_test(formats_without_parts_keep_the_triangles),
                                       cmocka_unit_test(a_vtp_file_holds_the_same)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
