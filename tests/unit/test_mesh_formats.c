/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The same body through every finite element format: the same triangles in the same parts. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "mesh/read_mesh.h"
#include "mesh/write_ply.h"
#include "support/mesh.h"
#include "support/model.h"
#include "support/near.h"

static const enum fl_shape SHAPES[] = {FL_HEX8,  FL_WEDGE6,  FL_TET4,  FL_PYRAMID5, FL_HEX20,
                                       FL_TET10, FL_WEDGE15, FL_QUAD4, FL_TRI3};

typedef void put_fn(FILE *f, const model *m, int variant);

/* --- ANSYS ---------------------------------------------------------------------------------------------- */

/* Solids other than bricks are collapsed bricks in this format: nodes of a brick (edges in the middle of a
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

/* --- Gmsh ----------------------------------------------------------------------------------------------- */

static int gmsh_type(enum fl_shape shape)
{
    static const int type[FL_SHAPES] = {
        [FL_TRI3] = 2,     [FL_QUAD4] = 3,  [FL_TET4] = 4,   [FL_HEX8] = 5,     [FL_WEDGE6] = 6,
        [FL_PYRAMID5] = 7, [FL_TET10] = 11, [FL_HEX20] = 17, [FL_WEDGE15] = 18,
    };
    return type[shape];
}

/* Edges of which the middle nodes follow the corners, in Gmsh's order and in that of mesh/elements.h. */
static void gmsh_nodes(const model_element *e, int64_t node[20])
{
    static const char *const gmsh_edges[FL_SHAPES] = {
        [FL_TET10] = "011220032313",
        [FL_HEX20] = "010304121523263745475667",
        [FL_WEDGE15] = "010203121425343545",
    };
    static const char *const own_edges[FL_SHAPES] = {
        [FL_TET10] = "011220031323",
        [FL_HEX20] = "011223304556677404152637",
        [FL_WEDGE15] = "011220344553031425",
    };
    const int c = fl_shape_corners(e->shape);
    memcpy(node, e->node, sizeof e->node);
    for (int i = c; i < fl_shape_nodes(e->shape); i++) {
        const char *a = gmsh_edges[e->shape] + 2 * (i - c);
        for (int j = c; j < fl_shape_nodes(e->shape); j++) {
            const char *b = own_edges[e->shape] + 2 * (j - c);
            if ((a[0] == b[0] && a[1] == b[1]) || (a[0] == b[1] && a[1] == b[0])) node[i] = e->node[j];
        }
    }
}

/* A number as text or as bytes; in bytes the lowest comes first unless `big` is set. */
typedef struct {
    FILE *f;
    int binary, big;
} sink;

static void put_int(sink *k, int64_t x, int bytes)
{
    if (!k->binary) fprintf(k->f, "%lld ", (long long)x);
    for (int i = 0; k->binary && i < bytes; i++)
        fputc((int)((uint64_t)x >> 8 * (k->big ? bytes - 1 - i : i) & 0xff), k->f);
}

static void put_real(sink *k, double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    if (k->binary) put_int(k, bits, 8);
    else fprintf(k->f, "%.17g ", x);
}

static void put_line_end(sink *k)
{
    if (!k->binary) fputc('\n', k->f);
}

/* variant: 0 ASCII, 1 binary, 2 binary with the highest byte first. */
static sink put_msh_head(FILE *f, const model *m, const char *version, int variant)
{
    sink k = {f, variant > 0, variant > 1};
    const int dim = fl_shape_faces(m->e[0].shape) ? 3 : 2;
    fprintf(f, "$MeshFormat\n%s %d 8\n", version, k.binary);
    if (k.binary) {
        put_int(&k, 1, 4);
        fputc('\n', f);
    }
    fprintf(f, "$EndMeshFormat\n$PhysicalNames\n%d\n", MODEL_PARTS);
    for (int p = 0; p < MODEL_PARTS; p++) fprintf(f, "%d %d \"%s\"\n", dim, 40 + p, m->part[p]);
    fprintf(f, "$EndPhysicalNames\n");
    return k;
}

static void put_msh2(FILE *f, const model *m, int variant)
{
    sink k = put_msh_head(f, m, "2.2", variant);
    fprintf(f, "$Nodes\n%d\n", m->nodes);
    for (int32_t n = 0; n < m->nodes; n++) {
        put_int(&k, m->id[n], 4);
        put_real(&k, m->x[n].x);
        put_real(&k, m->x[n].y);
        put_real(&k, m->x[n].z);
        put_line_end(&k);
    }
    fprintf(f, "%s$EndNodes\n$Elements\n%d\n", k.binary ? "\n" : "", m->elements);
    for (int32_t i = 0; i < m->elements; i++) {
        const model_element *e = &m->e[i];
        int64_t node[20];
        gmsh_nodes(e, node);
        if (!k.binary) put_int(&k, e->id, 4);
        put_int(&k, gmsh_type(e->shape), 4);
        if (k.binary) put_int(&k, 1, 4);
        put_int(&k, 2, 4);
        if (k.binary) put_int(&k, e->id, 4);
        put_int(&k, 40 + e->part, 4);
        put_int(&k, 3, 4);
        for (int c = 0; c < fl_shape_nodes(e->shape); c++) put_int(&k, node[c], 4);
        put_line_end(&k);
    }
    fprintf(f, "%s$EndElements\n", k.binary ? "\n" : "");
}

static void put_msh4(FILE *f, const model *m, int variant)
{
    sink k = put_msh_head(f, m, "4.1", variant);
    const char *end = k.binary ? "\n" : "";
    const int dim = fl_shape_faces(m->e[0].shape) ? 3 : 2;
    fprintf(f, "$Entities\n");
    for (int d = 0; d < 4; d++) put_int(&k, d == dim ? MODEL_PARTS : d == 0, 8);
    put_line_end(&k);
    put_int(&k, 1, 4); /* a point */
    for (int c = 0; c < 3; c++) put_real(&k, 0.0);
    put_int(&k, 0, 8);
    put_line_end(&k);
    for (int p = 0; p < MODEL_PARTS; p++) {
        put_int(&k, 5 + p, 4);
        for (int c = 0; c < 6; c++) put_real(&k, 0.0);
        put_int(&k, 1, 8);
        put_int(&k, 40 + p, 4);
        put_int(&k, 2, 8);
        put_int(&k, 1, 4);
        put_int(&k, -2, 4);
        put_line_end(&k);
    }
    fprintf(f, "%s$EndEntities\n$Nodes\n", end);
    for (int c = 0; c < 4; c++) put_int(&k, c == 0 ? 2 : m->nodes, 8);
    put_line_end(&k);
    /* the first three nodes lie on an entity with parameters */
    for (int block = 0; block < 2; block++) {
        const int32_t from = block ? 3 : 0, to = block ? m->nodes : 3;
        put_int(&k, 2, 4);
        put_int(&k, 1, 4);
        put_int(&k, !block, 4);
        put_int(&k, to - from, 8);
        put_line_end(&k);
        for (int32_t n = from; n < to; n++) put_int(&k, m->id[n], 8);
        put_line_end(&k);
        for (int32_t n = from; n < to; n++) {
            put_real(&k, m->x[n].x);
            put_real(&k, m->x[n].y);
            put_real(&k, m->x[n].z);
            for (int c = 0; c < 2 && !block; c++) put_real(&k, 0.5);
            put_line_end(&k);
        }
    }
    fprintf(f, "%s$EndNodes\n$Periodic\n0 $\n$EndPeriodic\n$Elements\n", end);
    for (int c = 0; c < 4; c++) put_int(&k, c == 0 ? MODEL_PARTS : m->elements, 8);
    put_line_end(&k);
    for (int p = 0; p < MODEL_PARTS; p++) {
        int32_t count = 0;
        for (int32_t i = 0; i < m->elements; i++) count += m->e[i].part == p;
        put_int(&k, dim, 4);
        put_int(&k, 5 + p, 4);
        put_int(&k, gmsh_type(m->e[0].shape), 4);
        put_int(&k, count, 8);
        put_line_end(&k);
        for (int32_t i = 0; i < m->elements; i++) {
            int64_t node[20];
            if (m->e[i].part != p) continue;
            gmsh_nodes(&m->e[i], node);
            put_int(&k, m->e[i].id, 8);
            for (int c = 0; c < fl_shape_nodes(m->e[i].shape); c++) put_int(&k, node[c], 8);
            put_line_end(&k);
        }
    }
    fprintf(f, "%s$EndElements\n", end);
}

/* --- Abaqus --------------------------------------------------------------------------------------------- */

static const char *abaqus_type(enum fl_shape shape)
{
    switch (shape) {
    case FL_HEX8: return "C3D8R";
    case FL_WEDGE6: return "C3D6";
    case FL_TET4: return "C3D4H";
    case FL_PYRAMID5: return "C3D5";
    case FL_HEX20: return "C3D20RH";
    case FL_TET10: return "C3D10MT";
    case FL_WEDGE15: return "C3D15";
    case FL_QUAD4: return "S4R";
    default: return "S3";
    }
}

/* Flat, with a block of elements for each part; or as an assembly of one part, placed and rotated by a full
 * turn, with the sets behind the elements. */
static void put_inp(FILE *f, const model *m, int assembly)
{
    const char *type = abaqus_type(m->e[0].shape);
    fprintf(f, "*Heading\n a body\n");
    if (assembly) fprintf(f, "*Part, name=body\n");
    fprintf(f, "*Node\n");
    for (int32_t n = 0; n < m->nodes; n++)
        fprintf(f, "%lld, %.17g, %.17g, %.17g\n", (long long)m->id[n], m->x[n].x, m->x[n].y,
                m->x[n].z + (assembly ? 4 : 0));
    for (int32_t p = 0; p < MODEL_PARTS; p++) {
        fprintf(f, "*Element, type=%s, elset=%s\n", type, m->part[p]);
        for (int32_t i = 0; i < m->elements; i++) {
            const int n = fl_shape_nodes(m->e[i].shape);
            if (m->e[i].part != p) continue;
            fprintf(f, "%lld", (long long)m->e[i].id);
            for (int k = 0; k < n; k++)
                fprintf(f, k % 15 == 14 ? ",\n%lld" : ", %lld", (long long)m->e[i].node[k]);
            fputc('\n', f);
        }
    }
    if (assembly)
        fprintf(f, "*End Part\n*Assembly, name=all\n*Instance, name=one, part=body\n0, 0, -4\n"
                   "1, 2, 3, 1, 2, 7, 360\n*End Instance\n*End Assembly\n");
}

/* --- Nastran -------------------------------------------------------------------------------------------- */

static const char *nastran_name(enum fl_shape shape)
{
    switch (shape) {
    case FL_HEX8:
    case FL_HEX20: return "CHEXA";
    case FL_WEDGE6:
    case FL_WEDGE15: return "CPENTA";
    case FL_TET4:
    case FL_TET10: return "CTETRA";
    case FL_PYRAMID5: return "CPYRAM";
    case FL_QUAD4: return "CQUAD4";
    default: return "CTRIA3";
    }
}

/* An entry in small (0), large (1) or free (2) field. */
static void put_entry(FILE *f, int kind, const char *name, int n, char field[][20])
{
    const int row = kind == 1 ? 4 : 8, width = kind == 1 ? 16 : 8;
    fprintf(f, kind == 1 ? "%s*" : "%s", name);
    if (kind < 2) fprintf(f, "%*s", 8 - (int)strlen(name) - kind, "");
    for (int k = 0; k < n; k++) {
        if (k && k % row == 0) fputs(kind == 2 ? ",+\n+" : kind == 1 ? "\n*       " : "\n        ", f);
        if (kind == 2) fprintf(f, ",%s", field[k]);
        else fprintf(f, "%*s", width, field[k]);
    }
    fputc('\n', f);
}

/* In small, large or free field, or (3) each in turn. */
static void put_bdf(FILE *f, const model *m, int variant)
{
    char field[24][20];
    fputs(variant == 1 ? "$ a punched mesh\n" : "SOL 101\nCEND\nBEGIN BULK\n", f);
    for (int p = 0; p < MODEL_PARTS; p++) fprintf(f, "$HMNAME PROP %20d\"%s\" 4\n", 7 + p, m->part[p]);
    for (int32_t n = 0; n < m->nodes; n++) {
        const double x[3] = {m->x[n].x, m->x[n].y, m->x[n].z};
        snprintf(field[0], 20, "%lld", (long long)m->id[n]);
        field[1][0] = '\0';
        for (int k = 0; k < 3; k++) /* multiples of 1/16 below 100: all their digits */
            snprintf(field[2 + k], 20, "%.4f", x[k]);
        put_entry(f, variant == 3 ? n % 3 : variant, "GRID", 5, field);
    }
    for (int32_t i = 0; i < m->elements; i++) {
        const model_element *e = &m->e[i];
        const int n = fl_shape_nodes(e->shape), c = fl_shape_corners(e->shape);
        const int ring = e->shape == FL_HEX20 ? 4 : 3,
                  turned = e->shape == FL_HEX20 || e->shape == FL_WEDGE15;
        snprintf(field[0], 20, "%lld", (long long)e->id);
        snprintf(field[1], 20, "%d", 7 + e->part);
        for (int k = 0; k < n; k++) { /* the mid-side nodes of the top come last */
            const int from = turned && k >= c + 2 * ring ? k - ring : turned && k >= c + ring ? k + ring : k;
            snprintf(field[2 + k], 20, "%lld", (long long)e->node[from]);
        }
        put_entry(f, variant == 3 ? i % 3 : variant, nastran_name(e->shape), 2 + n, field);
    }
    fprintf(f, "ENDDATA\n");
}

/* --- VTK ------------------------------------------------------------------------------------------------ */

static int64_t index_of(const model *m, int64_t id)
{
    for (int32_t n = 0; n < m->nodes; n++)
        if (m->id[n] == id) return n;
    abort();
}

static int vtk_type(enum fl_shape shape)
{
    static const int type[FL_SHAPES] = {
        [FL_TRI3] = 5,      [FL_QUAD4] = 9,  [FL_TET4] = 10,  [FL_HEX8] = 12,    [FL_WEDGE6] = 13,
        [FL_PYRAMID5] = 14, [FL_TET10] = 24, [FL_HEX20] = 25, [FL_WEDGE15] = 26,
    };
    return type[shape];
}

static void put_vtk_cells(sink *k, const model *m, const char *word, int counted)
{
    const int nodes = fl_shape_nodes(m->e[0].shape);
    if (counted) {
        fprintf(k->f, "%s %d %d\n", word, m->elements, m->elements * (1 + nodes));
    } else {
        fprintf(k->f, "%s %d %d\nOFFSETS vtktypeint64\n", word, m->elements + 1, m->elements * nodes);
        for (int32_t i = 0; i <= m->elements; i++) put_int(k, (int64_t)i * nodes, 8);
        fprintf(k->f, "\nCONNECTIVITY vtktypeint64\n");
    }
    for (int32_t i = 0; i < m->elements; i++) {
        if (counted) put_int(k, nodes, 4);
        for (int c = 0; c < nodes; c++) put_int(k, index_of(m, m->e[i].node[c]), counted ? 4 : 8);
        put_line_end(k);
    }
    fputc('\n', k->f);
}

/* variant & 1: binary; & 2: version 5.1; & 4: shells as an unstructured grid too. */
static void put_vtk(FILE *f, const model *m, int variant)
{
    const int solid = fl_shape_faces(m->e[0].shape) > 0, grid = solid || variant & 4, old = !(variant & 2);
    sink k = {f, variant & 1, 1};
    fprintf(f, "# vtk DataFile Version %s\na body in the shape of an L\n%s\nDATASET %s\n",
            old ? "3.0" : "5.1", k.binary ? "BINARY" : "ASCII", grid ? "UNSTRUCTURED_GRID" : "POLYDATA");
    fprintf(f, "FIELD FieldData 1\nTIME 1 1 double\n");
    put_real(&k, 0.5);
    fprintf(f, "\nPOINTS %d double\n", m->nodes);
    for (int32_t n = 0; n < m->nodes; n++) {
        put_real(&k, m->x[n].x);
        put_real(&k, m->x[n].y);
        put_real(&k, m->x[n].z);
        put_line_end(&k);
    }
    fprintf(f, "\nMETADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n");
    put_vtk_cells(&k, m, grid ? "CELLS" : "POLYGONS", old);
    if (grid) fprintf(f, "CELL_TYPES %d\n", m->elements);
    for (int32_t i = 0; grid && i < m->elements; i++) {
        put_int(&k, vtk_type(m->e[i].shape), 4);
        put_line_end(&k);
    }
    fprintf(f, "\nPOINT_DATA %d\nVECTORS motion double\n", m->nodes);
    for (int32_t n = 0; n < 3 * m->nodes; n++) put_real(&k, 0.25);
    fprintf(f, "\nCELL_DATA %d\nSCALARS part int 1\nLOOKUP_TABLE default\n", m->elements);
    for (int32_t i = 0; i < m->elements; i++) put_int(&k, m->e[i].part, 4);
    fputc('\n', f);
}

static void put_base64(FILE *f, const unsigned char *p, size_t n)
{
    static const char letter[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t k = 0; k < n; k += 3) {
        const unsigned a = p[k], b = k + 1 < n ? p[k + 1] : 0, c = k + 2 < n ? p[k + 2] : 0;
        fputc(letter[a >> 2], f);
        fputc(letter[(a & 3) << 4 | b >> 4], f);
        fputc(k + 1 < n ? letter[(b & 15) << 2 | c >> 6] : '=', f);
        fputc(k + 2 < n ? letter[c & 63] : '=', f);
    }
}

/* variant: 0 ascii, 1 base64 with the highest byte first, 2 appended, 3 appended in base64 and compressed. */
typedef struct {
    FILE *f, *data; /* the file, and its appended data */
    int variant;
} xml;

/* Two compressed blocks behind a header that is encoded separately. */
static void put_compressed(FILE *f, const unsigned char *p, size_t n)
{
    const size_t half = (n + 1) / 2;
    static unsigned char out[80000], head[40];
    uLongf size[2] = {sizeof out / 2, sizeof out / 2};
    assert_int_equal(compress(out, &size[0], p, half), Z_OK);
    assert_int_equal(compress(out + size[0], &size[1], p + half, n - half), Z_OK);
    const uint64_t word[5] = {2, half, n - half == half ? 0 : n - half, size[0], size[1]};
    for (int k = 0; k < 40; k++) head[k] = (unsigned char)(word[k / 8] >> 8 * (k % 8) & 0xff);
    put_base64(f, head, sizeof head);
    put_base64(f, out, size[0] + size[1]);
}

/* An array: 4-byte integers, or doubles. */
static void put_array(xml *x, const char *name, const double *v, int n, int is_real)
{
    static const char *const format[] = {"ascii", "binary", "appended", "appended"};
    char *text = NULL;
    size_t len = 0;
    FILE *raw = open_memstream(&text, &len);
    sink k = {raw, x->variant > 0, x->variant == 1};
    fprintf(x->f, "<DataArray type=\"%s\" Name=\"%s\" format=\"%s\"", is_real ? "Float64" : "Int32", name,
            format[x->variant]);
    if (x->variant > 1) fprintf(x->f, " offset=\"%ld\"/>\n", ftell(x->data));
    else fprintf(x->f, ">\n");
    if (x->variant == 1 || x->variant == 2)
        put_int(&k, (int64_t)n * (is_real ? 8 : 4), x->variant == 1 ? 4 : 8);
    for (int i = 0; i < n; i++) {
        if (is_real) put_real(&k, v[i]);
        else put_int(&k, (int64_t)v[i], 4);
    }
    fclose(raw);
    if (x->variant == 0) fwrite(text, 1, len, x->f);
    if (x->variant == 1) put_base64(x->f, (unsigned char *)text, len);
    if (x->variant < 2) fprintf(x->f, "\n</DataArray>\n");
    if (x->variant == 2) fwrite(text, 1, len, x->data);
    if (x->variant == 3) put_compressed(x->data, (unsigned char *)text, len);
    free(text);
}

static void put_vtk_xml(FILE *f, const model *m, int variant)
{
    static double v[MODEL_ELEMENTS * 20 + 3 * MODEL_NODES];
    const int solid = fl_shape_faces(m->e[0].shape) > 0, nodes = fl_shape_nodes(m->e[0].shape);
    const char *type = solid ? "UnstructuredGrid" : "PolyData", *cells = solid ? "Cells" : "Polys";
    char *text = NULL;
    size_t len = 0;
    xml x = {f, open_memstream(&text, &len), variant};
    int n = 0;
    fprintf(f,
            "<?xml version=\"1.0\"?>\n<!-- a > body <b> -->\n<VTKFile type=\"%s\" byte_order='%s' "
            "header_type=\"UInt%d\"%s>\n<%s>\n<FieldData>\n",
            type, variant == 1 ? "BigEndian" : "LittleEndian", variant == 1 ? 32 : 64,
            variant == 3 ? " compressor=\"vtkZLibDataCompressor\"" : "", type);
    fprintf(f, "<Array type=\"String\" Name=\"part_name\" format=\"ascii\">");
    for (int p = 0; p < MODEL_PARTS; p++) {
        for (const char *c = m->part[p]; *c; c++) fprintf(f, "%d ", *c);
        fprintf(f, "0 ");
    }
    fprintf(f, "</Array>\n<DataArray type=\"Int32\" Name=\"part_id\" format=\"ascii\">7 "
               "8</DataArray></FieldData>\n");
    fprintf(f, "<Piece NumberOfPoints=\"%d\" NumberOf%s=\"%d\">\n<CellData>\n", m->nodes, cells, m->elements);
    for (int32_t i = 0; i < m->elements; i++) v[i] = 7 + m->e[i].part;
    put_array(&x, "part", v, m->elements, 0);
    fprintf(f, "</CellData>\n<Points>\n");
    for (int32_t i = 0; i < m->nodes; i++) {
        v[3 * i] = m->x[i].x;
        v[3 * i + 1] = m->x[i].y;
        v[3 * i + 2] = m->x[i].z;
    }
    put_array(&x, "Points", v, 3 * m->nodes, 1);
    fprintf(f, "</Points>\n<%s>\n", cells);
    for (int32_t i = 0; i < m->elements; i++)
        for (int c = 0; c < nodes; c++) v[n++] = (double)index_of(m, m->e[i].node[c]);
    put_array(&x, "connectivity", v, n, 0);
    for (int32_t i = 0; i < m->elements; i++) v[i] = (i + 1) * nodes;
    put_array(&x, "offsets", v, m->elements, 0);
    for (int32_t i = 0; i < m->elements; i++) v[i] = vtk_type(m->e[i].shape);
    if (solid) put_array(&x, "types", v, m->elements, 0);
    fprintf(f, "</%s>\n</Piece>\n</%s>\n", cells, type);
    fclose(x.data);
    if (variant > 1) {
        fprintf(f, "<AppendedData encoding=\"%s\">\n_", variant == 2 ? "raw" : "base64");
        fwrite(text, 1, len, f);
        fprintf(f, "\n</AppendedData>\n");
    }
    fprintf(f, "</VTKFile>\n");
    free(text);
}
/* --- tests ---------------------------------------------------------------------------------------------- */

static const char *write_model(put_fn *put, const model *m, int variant)
{
    const char *path = test_path("model");
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    put(f, m, variant);
    assert_int_equal(fclose(f), 0);
    return path;
}

static void check_format(put_fn *put, const char *format, int variant)
{
    static model m;
    for (size_t k = 0; k < sizeof SHAPES / sizeof SHAPES[0]; k++) {
        fl_surface truth = {0}, got = {0};
        fl_err err = {0};
        char note[FL_MESH_NOTE];
        model_make(&m, SHAPES[k]);
        model_surface(&m, &truth);
        if (fl_mesh_read(&got, write_model(put, &m, variant), NULL, note, &err))
            fail_msg("%s %d of shape %d: %s", format, variant, (int)SHAPES[k], err.text);
        for (int32_t i = 0; i < got.n;
             i++) /* an assembly puts the name of the instance before that of the part */
            if (strncmp(got.part[i].name, "one.", 4) == 0)
                memmove(got.part[i].name, got.part[i].name + 4, strlen(got.part[i].name) - 3);
        for (int32_t i = 0; i < got.n; i++)
            if (strncmp(got.part[i].name, "part_", 5) == 0)
                strcpy(got.part[i].name, got.part[i].name[5] == '0' ? "leg" : "deck"); /* both rules apply */
        if (!mesh_sound(&got) || !model_same(&got, &truth))
            fail_msg("%s %d of shape %d: other triangles\n%s", format, variant, (int)SHAPES[k], note);
        fl_surface_free(&truth);
        fl_surface_free(&got);
    }
}

static void ansys_gives_the_same_surface(void **state)
{
    (void)state;
    check_format(put_cdb, "cdb", 0);
    check_format(put_cdb, "cdb", 1);
}

static void gmsh_gives_the_same_surface(void **state)
{
    (void)state;
    for (int variant = 0; variant < 3; variant++) {
        check_format(put_msh2, "msh 2.2", variant);
        check_format(put_msh4, "msh 4.1", variant);
    }
}

static void abaqus_gives_the_same_surface(void **state)
{
    (void)state;
    check_format(put_inp, "inp", 0);
    check_format(put_inp, "inp", 1);
}

/* Part numbers have no names: they become part_0 and part_1. */
static void vtk_gives_the_same_surface(void **state)
{
    (void)state;
    for (int variant = 0; variant < 8; variant++) check_format(put_vtk, "vtk", variant);
    for (int variant = 0; variant < 4; variant++) check_format(put_vtk_xml, "vtx", variant);
}

static void nastran_gives_the_same_surface(void **state)
{
    (void)state;
    for (int variant = 0; variant < 4; variant++) check_format(put_bdf, "bdf", variant);
}

static void put_surface_as_ply(FILE *f, const model *m, int variant)
{
    fl_surface body = {0};
    fl_err err = {0};
    model_surface(m, &body);
    body.part[0].id = 12 - variant; /* the order of the numbers may differ from that of the parts */
    body.part[1].id = 11;
    assert_int_equal(fl_ply_write(f, &body, &err), 0);
    fl_surface_free(&body);
}

/* The file that --to ply writes is read back with its parts. */
static void ply_keeps_parts(void **state)
{
    (void)state;
    check_format(put_surface_as_ply, "ply", 0);
    check_format(put_surface_as_ply, "ply", 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ply_keeps_parts),
        cmocka_unit_test(ansys_gives_the_same_surface),
        cmocka_unit_test(gmsh_gives_the_same_surface),
        cmocka_unit_test(vtk_gives_the_same_surface),
        cmocka_unit_test(abaqus_gives_the_same_surface),
        cmocka_unit_test(nastran_gives_the_same_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
