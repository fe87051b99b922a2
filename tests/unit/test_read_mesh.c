/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "geom/facet.h"
#include "geom/mesh_patch.h"
#include "geom/weld.h"
#include "mesh/gstruct.h"
#include "mesh/read_mesh.h"
#include "mesh/write_stl.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;
static char note[FL_MESH_NOTE];

/* The float32 nearest to x, stored and loaded: gcc 12 drops a pair of conversions there and back when it
 * packs two of them into one register. */
static double to_float32(double x)
{
    volatile float y = (float)x;
    return (double)y;
}

/* The model: a frustum on the grid of float32, so that each format can hold it. */
static void make_model(fl_surface *s)
{
    const fl_cone c = {v3(0, 0, -2), v3(0, 0, 3), 2, 1};
    const int32_t i = fl_surface_add(s, "model", 5, &err);
    fl_part *p = &s->part[i];
    fl_weld w;
    fl_facet_cone(p, &c, 24, &err);
    for (int32_t v = 0; v < p->nv; v++)
        p->v[v] = v3(to_float32(p->v[v].x), to_float32(p->v[v].y), to_float32(p->v[v].z));
    fl_part_weld(p, 0.0, &w, &err);
}

static void put_obj(FILE *f, const fl_part *p)
{
    fprintf(f, "g model\n");
    for (int32_t v = 0; v < p->nv; v++) fprintf(f, "v %.17g %.17g %.17g\n", p->v[v].x, p->v[v].y, p->v[v].z);
    for (int32_t t = 0; t < p->nt; t++)
        fprintf(f, "f %d %d/7 %d//9\n", p->t[t].v[0] + 1, p->t[t].v[1] + 1, p->t[t].v[2] - p->nv);
}

static void put_off(FILE *f, const fl_part *p)
{
    fprintf(f, "OFF\n%d %d 0\n", p->nv, p->nt);
    for (int32_t v = 0; v < p->nv; v++) fprintf(f, "%.17g %.17g %.17g\n", p->v[v].x, p->v[v].y, p->v[v].z);
    for (int32_t t = 0; t < p->nt; t++) fprintf(f, "3 %d %d %d\n", p->t[t].v[0], p->t[t].v[1], p->t[t].v[2]);
}

static void put_ply_head(FILE *f, const fl_part *p, const char *kind, const char *real)
{
    fprintf(f, "ply\nformat %s 1.0\nelement vertex %d\nproperty %s x\nproperty %s y\nproperty %s z\n", kind,
            p->nv, real, real, real);
    fprintf(f, "element face %d\nproperty list uchar int vertex_indices\nend_header\n", p->nt);
}

static void put_ply(FILE *f, const fl_part *p)
{
    put_ply_head(f, p, "ascii", "double");
    for (int32_t v = 0; v < p->nv; v++) fprintf(f, "%.17g %.17g %.17g\n", p->v[v].x, p->v[v].y, p->v[v].z);
    for (int32_t t = 0; t < p->nt; t++) fprintf(f, "3 %d %d %d\n", p->t[t].v[0], p->t[t].v[1], p->t[t].v[2]);
}

/* The bytes of an unsigned number of n bytes, the lowest first or last. */
static void put_bits(FILE *f, uint64_t u, int n, int big)
{
    for (int k = 0; k < n; k++) fputc((int)(u >> 8 * (big ? n - 1 - k : k) & 0xff), f);
}

static void put_ply_binary(FILE *f, const fl_part *p, int big, int wide)
{
    put_ply_head(f, p, big ? "binary_big_endian" : "binary_little_endian", wide ? "double" : "float");
    for (int32_t v = 0; v < p->nv; v++) {
        const double x[3] = {p->v[v].x, p->v[v].y, p->v[v].z};
        for (int k = 0; k < 3; k++) {
            const float y = (float)x[k];
            uint64_t bits = 0;
            uint32_t half = 0;
            memcpy(&bits, &x[k], sizeof bits);
            memcpy(&half, &y, sizeof half);
            put_bits(f, wide ? bits : half, wide ? 8 : 4, big);
        }
    }
    for (int32_t t = 0; t < p->nt; t++) {
        fputc(3, f);
        for (int k = 0; k < 3; k++) put_bits(f, (uint64_t)p->t[t].v[k], 4, big);
    }
}

enum { STL_ASCII, STL_BINARY, OBJ, OFF, PLY, PLY_LITTLE, PLY_BIG, PLY_DOUBLE, G_STRUCT, KINDS };

static char *write_model(const fl_surface *s, int kind, size_t *n)
{
    char *text = NULL;
    FILE *f = open_memstream(&text, n);
    const fl_part *p = &s->part[0];
    fl_history_line by;
    fl_history_line_start(&by, "test");
    switch (kind) {
    case STL_ASCII: fl_stl_write_ascii(f, s); break;
    case STL_BINARY: fl_stl_write_binary(f, s); break;
    case OBJ: put_obj(f, p); break;
    case OFF: put_off(f, p); break;
    case PLY: put_ply(f, p); break;
    case PLY_LITTLE: put_ply_binary(f, p, 0, 0); break;
    case PLY_BIG: put_ply_binary(f, p, 1, 0); break;
    case PLY_DOUBLE: put_ply_binary(f, p, 1, 1); break;
    default: fl_gstruct_write(f, s, &by); break;
    }
    fclose(f);
    return text;
}

static void the_same_model_in_every_format(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        fl_surface s = {0}, got = {0};
        fl_weld w;
        size_t n = 0;
        char *text;
        make_model(&s);
        text = write_model(&s, kind, &n);
        assert_int_equal(fl_mesh_read(&got, test_file("model", text, n), NULL, note, &err), 0);
        assert_string_equal(note, "");
        assert_int_equal(got.n, 1);
        assert_int_equal(fl_part_weld(&got.part[0], 0.0, &w, &err), 0);
        free(got.part[0].name); /* files without a name give it the file's name */
        got.part[0].name = strdup("model");
        assert_int_equal(mesh_same(&s, &got), 1);
        free(text);
        fl_surface_free(&s);
        fl_surface_free(&got);
    }
    unlink(test_path("model"));
}

/* CRLF for LF, no last line end, and a byte order mark, in each text format. */
static void line_ends_do_not_matter(void **state)
{
    static const int kinds[] = {STL_ASCII, OBJ, OFF, PLY, G_STRUCT};
    (void)state;
    for (int k = 0; k < 5; k++) {
        fl_surface s = {0}, plain = {0}, other = {0};
        size_t n = 0, m = 3;
        char *text, *dos;
        make_model(&s);
        text = write_model(&s, kinds[k], &n);
        dos = malloc(2 * n + 3);
        assert_non_null(dos);
        memcpy(dos, "\xef\xbb\xbf", 3);
        for (size_t i = 0; i < n; i++) {
            if (text[i] == '\n') dos[m++] = '\r';
            dos[m++] = text[i];
        }
        assert_int_equal(fl_mesh_read(&plain, test_file("model", text, n), NULL, note, &err), 0);
        assert_int_equal(fl_mesh_read(&other, test_file("model", dos, m - 2), NULL, note, &err), 0);
        assert_int_equal(mesh_same(&plain, &other), 1);
        free(text);
        free(dos);
        fl_surface_free(&s);
        fl_surface_free(&plain);
        fl_surface_free(&other);
    }
    unlink(test_path("model"));
}

static fl_surface read_text(const char *text)
{
    fl_surface s = {0};
    if (fl_mesh_read(&s, test_file("in.v2.mesh", text, strlen(text)), NULL, note, &err))
        fail_msg("%s", err.text);
    assert_int_equal(mesh_sound(&s), 1);
    unlink(test_path("in.v2.mesh"));
    return s;
}

#define FACET "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"

static void solids_become_parts(void **state)
{
    fl_surface s = read_text("solid leg one\n" FACET "endsolid leg one\nSOLID\n" FACET FACET
                             "endsolid\nsolid none\nendsolid none\nsolid leg  one\n" FACET "endsolid");
    (void)state;
    assert_int_equal(s.n, 3);
    assert_string_equal(s.part[0].name, "leg_one");
    assert_non_null(strstr(s.part[1].name, "in.v2")); /* the file without folder and ending */
    assert_null(strstr(s.part[1].name, "mesh"));
    assert_string_equal(s.part[2].name, "leg__one");
    assert_int_equal(s.part[1].nt, 2);
    assert_string_equal(note, "part \"none\" has no triangles and was dropped\n");
    fl_surface_free(&s);
}

#define FOUR "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"

static void objects_groups_and_materials_become_parts(void **state)
{
    static const struct {
        const char *text, *names[3];
        int32_t triangles[3];
    } c[] = {
        {FOUR "usemtl steel\nf 1 2 3\nusemtl ice\nf 1 2 4\nusemtl steel\nf 2 3 4\n",
         {"steel", "ice"},
         {2, 1}},
        {FOUR "g a b\nusemtl steel\nf 1 2 3\ng c\nf 1 2 4\n", {"a_b", "c"}, {1, 1}},
        {FOUR "o all\ng a\nf 1 2 3\ng c\nf 1 2 4\ng a\nf 1 3 4\n", {"a", "c"}, {2, 1}},
        {FOUR "o one\ng a\nf 1 2 3\no two\ng c\nf 1 2 4\nf 1 2 3 4\n", {"one", "two"}, {1, 3}},
        {FOUR "o one\nusemtl x\nf 1 2 3\nusemtl y\nf 1 2 4\n", {"one"}, {2}},
    };
    (void)state;
    for (size_t k = 0; k < sizeof c / sizeof c[0]; k++) {
        fl_surface s = read_text(c[k].text);
        int32_t n = 0;
        for (; n < 3 && c[k].names[n]; n++) {
            assert_true(n < s.n);
            assert_string_equal(s.part[n].name, c[k].names[n]);
            assert_int_equal(s.part[n].nt, c[k].triangles[n]);
        }
        assert_int_equal(s.n, n);
        fl_surface_free(&s);
    }
}

static void remarks_are_reported(void **state)
{
    fl_surface s = read_text(FOUR "curv2 1 2\nsurf 0 1\nf 1 2 3\nl 1 2\ns off\n");
    (void)state;
    assert_string_equal(note, "2 rows of unknown words were skipped\n");
    fl_surface_free(&s);
}

/* A second file adds its parts under its own names and numbers, and its history. */
static void files_add_up(void **state)
{
    static const char own[] = "#g_struct 1\n#by a\npart 7 leg\ncone 0 0 0 1 0 0 1 1\n";
    static const char other[] =
        "#g_struct 1\n#by b\npart 7 leg\ncone 0 0 0 1 0 0 2 1\npart 3 arm\ncone 0 0 0 1 0 0 2 1\n";
    fl_surface s = {0};
    (void)state;
    assert_int_equal(fl_mesh_read(&s, test_file("a", own, strlen(own)), NULL, note, &err), 0);
    assert_int_equal(fl_mesh_read(&s, test_file("a", other, strlen(other)), NULL, note, &err), 0);
    assert_int_equal(s.n, 3);
    assert_int_equal(s.part[0].id, 7);
    assert_int_equal(s.part[1].id, 8);
    assert_int_equal(s.part[2].id, 9);
    assert_string_equal(s.part[1].name, "leg_2");
    assert_string_equal(s.part[2].name, "arm");
    assert_string_equal(s.history, "#by a\n#by b\n");
    fl_surface_free(&s);
    unlink(test_path("a"));
}

/* Files of other formats are named, with the export to use instead. */
static void unsupported_formats_are_named(void **state)
{
    static const struct {
        const char *text;
        size_t n; /* 0 for all of it */
        const char *says;
    } row[] = {
        {"\r\nISO-10303-21;\nHEADER;\n", 0,
         ": a STEP file, which is geometry without a mesh: gmsh FILE -2 -setstring "},
        {"DBRep_DrawableShape\n", 0, ": a BREP file, which is geometry without a mesh: gmsh FILE"},
        {"*DIODORE\n*NODES\n", 0, ": a DIODORE file: export the panels as WAMIT GDF or STL"},
        {"$ x\n&DIMEN -DIMEN METERS M-TONS\n", 0, ": commands of MOSES: export the panels as WAMIT GDF"},
        {"%YAML 1.1\n# Type: Model\n", 0, ": a YAML file, as OrcaFlex and OrcaWave write: export the panels"},
        {"#VRML V2.0 utf8\n", 0, ": a VRML scene: export the panels"},
        {"title\n1 ILOWHICSF\n1 1\n", 0, ": a control surface of WAMIT, and no hull"},
        {"**ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefg\n**PARASOLID !\"#\n", 0, ": a Parasolid file"},
        {"                                                                        S      1\n", 0,
         ": an IGES file, which is geometry without a mesh: gmsh FILE"},
        {"  0\r\nSECTION\r\n  2\r\nHEADER\r\n", 0, ": a DXF drawing: export the surface as STL"},
        {"\377\376v\0 \0000\0\n\0", 10, ": text in UTF-16: save it as UTF-8"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", 0, ": a pointer of Git LFS"},
        {"glTF\2\0\0\0", 8, ": a glTF scene"},
        {"{\"asset\": {\"version\": \"2.0\"}}", 0, ": a glTF scene"},
        {"Kaydara FBX Binary  \0\x1a", 22, ": an FBX scene"},
        {"PK\003\004\0\0", 6, ": a ZIP archive, as 3MF is"},
        {"\211HDF\r\n\032\n", 0, ": an HDF5 file, as MED and CGNS are: in Salome export the mesh as STL"},
        {"CDF\001\0\0\0\0", 8, ": a NetCDF file"},
        {"    -1\n  2420\n", 0, ": a universal file of I-DEAS"},
        {"MeshVersionFormatted 2\n", 0, ": a MEDIT mesh"},
        {"(0 \"fluent\")\n(2 3)\n", 0, ": a mesh of Fluent"},
        {"$# comment\n*KEYWORD\n*NODE\n", 0, ": a deck of LS-DYNA: export it as"},
        {"! a tower\n/prep7\nn,1,0,0,0\n", 0, ": commands of ANSYS without NBLOCK or EBLOCK"},
        {"%PDF-1.4\n", 0, ": a PDF document"}};
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        fl_surface s = {0};
        fl_err e = {0};
        const size_t n = row[k].n ? row[k].n : strlen(row[k].text);
        assert_int_equal(fl_mesh_read(&s, test_file("a", row[k].text, n), NULL, note, &e), -1);
        assert_int_equal(e.code, FL_INPUT);
        if (!strstr(e.text, row[k].says)) fail_msg("\"%s\" is not in \"%s\"", row[k].says, e.text);
    }
    unlink(test_path("a"));
}

static void each_fault_has_its_message(void **state)
{
    static const struct {
        const char *text, *says; /* after the name of the file */
    } fault[] = {
        {"", ": empty, a mesh is expected"},
        {"solid a\nendsolid a\n", ": no triangles"},
        {"solid a\n" FACET, ":8: the file ends inside solid \"a\""},
        {"solid a\n" FACET "oops\n", ":9: \"oops\" was found, \"facet\" or \"endsolid\" is expected"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 nan 0\n",
         ":4: y is \"nan\", a finite number is expected"},
        {"solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
         ":6: a loop of 2 corners, at least 3 are expected"},
        {FOUR "f 1 2 5\n", ":5: the face refers to vertex 5, but there are 4 so far"},
        {FOUR "f 1 2 -5\n", ":5: the face refers to vertex -5, but there are 4 so far"},
        {FOUR "f 1 2 0\n", ":5: vertex index \"0\" was found, a whole number other than 0 is expected"},
        {FOUR "f 1 2\n", ":5: a face of 2 corners, at least 3 are expected"},
        {FOUR "v 1 inf 2\n", ":5: y is \"inf\", a finite number is expected"},
        {FOUR "v 1 2\n", ":5: z is missing after 3 words"},
        {FOUR, ": no triangles"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n", ":4: the file ends after 2 of 3 vertices"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
         ":6: vertex index \"3\" was found, 0 to 2 is expected"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", ":6: the file ends after 0 of 1 faces"},
        {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n", ":7: a row follows the last of 1 faces"},
        {"OFF\n3 many 0\n", ":2: the number of faces is \"many\", a whole number >= 0 is expected"},
        {"OFF BINARY\n", ":1: a binary OFF file, an ASCII one is expected"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nend_header\n",
         ":4: one element \"vertex\" with properties x, y and z is expected"},
        {"ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n",
         ":4: \"half\" is not a type of PLY 1.0"},
        {"ply\nelement vertex 1\n", ":2: the file ends inside the header"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof fault / sizeof fault[0]; k++) {
        fl_surface s = {0};
        fl_err e = {0};
        const char *path = test_file("bad", fault[k].text, strlen(fault[k].text));
        assert_int_equal(fl_mesh_read(&s, path, NULL, note, &e), -1);
        assert_int_equal(e.code, FL_INPUT);
        assert_int_equal(strncmp(e.text, path, strlen(path)), 0);
        assert_string_equal(e.text + strlen(path), fault[k].says);
        assert_null(s.part);
    }
    unlink(test_path("bad"));
}

/* 84 + 50 n decides, whatever the first word is; a count that was never filled in is taken from the size. */
static void size_decides_on_binary(void **state)
{
    fl_surface s = {0}, got = {0};
    fl_err e = {0};
    size_t n = 0;
    char *text;
    (void)state;
    make_model(&s);
    text = write_model(&s, STL_BINARY, &n);
    assert_int_equal(n, 84 + 50 * (size_t)s.part[0].nt);
    memcpy(text, "solid liar", 10);
    assert_int_equal(fl_mesh_read(&got, test_file("b", text, n), NULL, note, &err), 0);
    assert_int_equal(got.part[0].nt, s.part[0].nt);
    fl_surface_free(&got);
    assert_int_equal(fl_mesh_read(&got, test_file("b", text, n - 50), NULL, note, &e), -1);
    assert_non_null(strstr(e.text, "bytes of binary data: not a whole binary STL"));
    memset(text + 80, 0, 4);
    assert_int_equal(fl_mesh_read(&got, test_file("b", text, n), NULL, note, &err), 0);
    assert_int_equal(got.part[0].nt, s.part[0].nt);
    assert_non_null(strstr(note, "the header says 0 triangles"));
    fl_surface_free(&got);
    memset(text + 84 + 50 * 3 + 12, 0xff, 4); /* a nan */
    e = (fl_err){0};
    assert_int_equal(fl_mesh_read(&got, test_file("b", text, n), NULL, note, &e), -1);
    assert_non_null(strstr(e.text, ": triangle 3 has "));
    free(text);
    fl_surface_free(&s);
    unlink(test_path("b"));
}

/* The text of a file, of which up to 200 kB count. */
static const char *file_text(const char *path)
{
    static char text[200000];
    FILE *f = fopen(path, "r");
    size_t n;
    if (!f) fail_msg("%s cannot be read", path);
    n = fread(text, 1, sizeof text - 1, f);
    fclose(f);
    text[n] = '\0';
    return text;
}

/* True if the table has a format of that name. */
static int is_format(const char *name, size_t n)
{
    for (const fl_mesh_format *f = FL_MESH_FORMATS; f->name; f++)
        if (strlen(f->name) == n && strncmp(f->name, name, n) == 0) return 1;
    return 0;
}

/* The refusal of an unknown file names each format once, in the order of the table. */
static void the_refusal_lists_every_format(void **state)
{
    fl_surface s = {0};
    fl_err e = {0};
    const char *path = test_file("bad", "hello world\n", 12), *at;
    (void)state;
    assert_int_equal(fl_mesh_read(&s, path, NULL, note, &e), -1);
    assert_int_equal(e.code, FL_INPUT);
    at = strstr(e.text, ": unknown format, expected a mesh in one of ");
    assert_non_null(at);
    at = strstr(at, " of ") + 4;
    for (const fl_mesh_format *f = FL_MESH_FORMATS; f->name; f++) {
        int again = 0;
        for (const fl_mesh_format *g = FL_MESH_FORMATS; g < f; g++) again |= strcmp(f->name, g->name) == 0;
        if (again) continue;
        if (strncmp(at, f->name, strlen(f->name)) != 0) fail_msg("%s is not next in \"%s\"", f->name, at);
        at += strlen(f->name) + strspn(at + strlen(f->name), ", ");
    }
    assert_string_equal(at, "");
    unlink(test_path("bad"));
}

/* FORMATS of struct-import(1) has an entry for each format of the table, and no other. */
static void the_manual_page_lists_every_format(void **state)
{
    const char *from = strstr(file_text("tools/struct-import/struct-import.1"), "\n.Sh FORMATS\n");
    const char *to = from ? strstr(from, "\n.El\n") : NULL;
    int entries = 0, formats = 0;
    (void)state;
    assert_non_null(from);
    assert_non_null(to);
    for (const char *p = from; (p = strstr(p, "\n.It ")) != NULL && p < to; p++) entries++;
    for (const fl_mesh_format *f = FL_MESH_FORMATS; f->name; f++) {
        char entry[500];
        const char *at;
        int again = 0;
        for (const fl_mesh_format *g = FL_MESH_FORMATS; g < f; g++)
            again |= strcmp(f->heading, g->heading) == 0;
        formats += !again;
        snprintf(entry, sizeof entry, "\n.It %s\nRead: %s.\nPassed over: %s.\nRefused: %s.\n", f->heading,
                 f->reads, f->passes, f->refuses);
        at = strstr(from, entry);
        if (!at || at > to) fail_msg("FORMATS of struct-import.1 lacks the entry %s", f->heading);
    }
    if (entries != formats)
        fail_msg("FORMATS of struct-import.1 has %d entries for %d formats", entries, formats);
}

/* A file lists in parentheses, the first of which is behind `start`, the formats of the table, but for
 * g_struct, which this program writes. */
static void lists_every_format(const char *file, const char *start)
{
    const char *from = strstr(file_text(file), start), *to;
    int names = 0, formats = 0;
    from = from ? strchr(from, '(') : NULL;
    to = from ? strchr(from, ')') : NULL;
    if (!to) fail_msg("%s has no list of formats in parentheses", file);
    for (const char *p = from + 1; p < to; p += strspn(p, ", \n\"\\")) {
        const size_t n = strncmp(p, "n\"", 2) == 0 ? 1 : strcspn(p, ", \n)\"\\");
        if (!(n == 1 && *p == 'n') && strncmp(p, "g_struct", n) != 0) {
            if (!is_format(p, n)) fail_msg("%s lists %.*s, which is no format", file, (int)n, p);
            names++;
        }
        p += n;
    }
    for (const fl_mesh_format *f = FL_MESH_FORMATS; f->name; f++) {
        int again = strcmp(f->name, "g_struct") == 0;
        const char *at = strstr(from, f->name);
        for (const fl_mesh_format *g = FL_MESH_FORMATS; g < f; g++) again |= strcmp(f->name, g->name) == 0;
        if (again) continue;
        if (!at || at > to) fail_msg("%s does not list %s", file, f->name);
        formats++;
    }
    assert_int_equal(names, formats);
}

static void pages_and_help_list_every_format(void **state)
{
    (void)state;
    lists_every_format("README.md", "struct-import   a structure");
    lists_every_format("share/man7/floe.7", "reads many formats");
    lists_every_format("tools/struct-import/options.c", "FILE is one of");
}

/* So does --help of struct-import, whose text is in options.c. */
static void help_lists_every_format(void **state)
{
    const char *text = file_text("tools/struct-import/options.c");
    (void)state;
    for (const fl_mesh_format *f = FL_MESH_FORMATS; f->name; f++)
        if (!strstr(text, f->name)) fail_msg("--help of struct-import does not list %s", f->name);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_same_model_in_every_format),
                                       cmocka_unit_test(line_ends_do_not_matter),
                                       cmocka_unit_test(solids_become_parts),
                                       cmocka_unit_test(objects_groups_and_materials_become_parts),
                                       cmocka_unit_test(remarks_are_reported),
                                       cmocka_unit_test(files_add_up),
                                       cmocka_unit_test(unsupported_formats_are_named),
                                       cmocka_unit_test(each_fault_has_its_message),
                                       cmocka_unit_test(size_decides_on_binary),
                                       cmocka_unit_test(the_refusal_lists_every_format),
                                       cmocka_unit_test(the_manual_page_lists_every_format),
                                       cmocka_unit_test(pages_and_help_list_every_format),
                                       cmocka_unit_test(help_lists_every_format)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
