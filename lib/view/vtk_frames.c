/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "base/array.h"
#include "base/number_text.h"
#include "view/rounded_mesh.h"
#include "view/vtk_frames.h"

enum { BLOCK = 32768, ARRAYS_MAX = 16 };

/* Numbers of four bytes under collection; floats are kept by their bits. */
struct column {
    uint32_t *x;
    int32_t n, cap;
};

static int put_int(struct column *c, int32_t x, fl_err *err)
{
    if (c->n == c->cap && fl_grow(&c->x, &c->cap, (int64_t)c->n + 1, sizeof *c->x, err)) return -1;
    c->x[c->n++] = (uint32_t)x;
    return 0;
}

static int put_float(struct column *c, double x, fl_err *err)
{
    const float f = (float)x;
    int32_t bits;
    memcpy(&bits, &f, sizeof bits);
    return put_int(c, bits, err);
}

static int put_floats(struct column *c, fl_vec3 x, fl_err *err)
{
    return put_float(c, x.x, err) || put_float(c, x.y, err) || put_float(c, x.z, err);
}

/* The compressed arrays, and the text that refers to them. */
struct appended {
    unsigned char *b;
    int32_t n, cap;
};

static void put_word(unsigned char *to, uint32_t x)
{
    for (int k = 0; k < 4; k++) to[k] = (unsigned char)(x >> (8 * k));
}

/* Number of blocks, their size, size of the last (0: whole), compressed sizes; then the blocks. */
static int append_array(struct appended *a, const struct column *c, fl_err *err)
{
    const int64_t bytes = 4 * (int64_t)c->n, blocks = (bytes + BLOCK - 1) / BLOCK;
    unsigned char raw[BLOCK], packed[BLOCK + 1024];
    if (fl_grow(&a->b, &a->cap, a->n + 12 + 4 * blocks, 1, err)) return -1;
    put_word(a->b + a->n, (uint32_t)blocks);
    put_word(a->b + a->n + 4, BLOCK);
    put_word(a->b + a->n + 8, (uint32_t)(bytes % BLOCK));
    const int32_t sizes = a->n + 12;
    a->n = (int32_t)(sizes + 4 * blocks);
    for (int64_t k = 0; k < blocks; k++) {
        const int64_t first = k * BLOCK / 4, count = (k + 1 < blocks ? BLOCK : bytes - k * BLOCK) / 4;
        uLongf len = sizeof packed;
        for (int64_t i = 0; i < count; i++) put_word(raw + 4 * i, c->x[first + i]);
        if (compress2(packed, &len, raw, (uLong)(4 * count), 1) != Z_OK)
            return fl_fail(err, FL_SYSTEM, "out of memory for zlib");
        if (fl_grow(&a->b, &a->cap, (int64_t)a->n + (int64_t)len, 1, err)) return -1;
        memcpy(a->b + a->n, packed, len);
        put_word(a->b + sizes + 4 * k, (uint32_t)len);
        a->n += (int32_t)len;
    }
    return 0;
}

struct named {
    const char *name, *type;
    int components;
    struct column c;
};

static int write_array(FILE *f, struct appended *a, const struct named *v, fl_err *err)
{
    fprintf(
        f,
        "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%d\"/>\n",
        v->type, v->name, v->components, a->n);
    return append_array(a, &v->c, err);
}

/* points, normals (none: n = 0), vertices of polygons or of points, data of cells. */
static int write_piece(FILE *f, struct named *point, struct named *normal, struct named *corner, int points,
                       struct named *data, int arrays, double t, fl_err *err)
{
    struct appended a = {0};
    struct named end = {"offsets", "Int32", 1, {0}};
    char text[FL_NUMBER_LEN];
    int rc = -1;
    const int32_t each = points ? 1 : 3, cells = corner->c.n / each;
    for (int32_t k = 1; k <= cells; k++)
        if (put_int(&end.c, each * k, err)) goto done;
    fprintf(f,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt32\" "
            "compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" "
            "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">%s</DataArray>\n</FieldData>\n<Piece "
            "NumberOfPoints=\"%d\" "
            "NumberOfVerts=\"%d\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"%d\">\n",
            fl_number_text(t, text), point->c.n / 3, points ? cells : 0, points ? 0 : cells);
    fprintf(f, "<PointData%s>\n", normal->c.n ? " Normals=\"normal\"" : "");
    if (normal->c.n && write_array(f, &a, normal, err)) goto done;
    fprintf(f, "</PointData>\n<CellData>\n");
    for (int k = 0; k < arrays; k++)
        if (write_array(f, &a, &data[k], err)) goto done;
    fprintf(f, "</CellData>\n<Points>\n");
    if (write_array(f, &a, point, err)) goto done;
    fprintf(f, "</Points>\n<%s>\n", points ? "Verts" : "Polys");
    if (write_array(f, &a, corner, err) || write_array(f, &a, &end, err)) goto done;
    fprintf(f, "</%s>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
            points ? "Verts" : "Polys");
    fwrite(a.b, 1, (size_t)a.n, f);
    fputs("\n</AppendedData>\n</VTKFile>\n", f);
    rc = 0;
done:
    free(a.b);
    free(end.c.x);
    return rc;
}

/* The triangles of a mesh, posed; the same cell data for each. */
static int add_mesh(const fl_rounded_mesh *m, fl_vec3 x, fl_quat q, struct named *point, struct named *normal,
                    struct named *corner, fl_err *err)
{
    const int32_t first = point->c.n / 3;
    const fl_mat3 R = q_matrix(q);
    for (int32_t k = 0; k < m->nv; k++) {
        const float *a = m->v[k].x, *n = m->v[k].n;
        if (put_floats(&point->c, v3_add(x, m3_mul(R, v3(a[0], a[1], a[2]))), err) ||
            put_floats(&normal->c, m3_mul(R, v3(n[0], n[1], n[2])), err))
            return -1;
    }
    for (int32_t k = 0; k < 3 * m->nt; k++)
        if (put_int(&corner->c, first + (int32_t)m->t[k], err)) return -1;
    return 0;
}

enum { BODY, GROUP, SPEED, SPIN, THICKNESS, DIAMETER, ROTATION, VELOCITY, BODY_ARRAYS };

static int add_body_data(struct named *data, const fl_playback *p, const fl_frame_shape *s, int32_t row,
                         int32_t group, int32_t cells, int points, fl_err *err)
{
    const fl_quat q = p->now.q[row];
    const double thick = fl_shape_thickness(p->data, s), wide = fl_shape_diameter(p->data, s);
    for (int32_t k = 0; k < cells; k++) {
        if (put_int(&data[BODY].c, s->id, err) || put_int(&data[GROUP].c, group, err) ||
            put_float(&data[SPEED].c, v3_norm(p->now.v[row]), err) ||
            put_float(&data[SPIN].c, v3_norm(p->now.w[row]), err) ||
            put_float(&data[THICKNESS].c, thick, err) || put_float(&data[DIAMETER].c, wide, err))
            return -1;
        if (points && (put_float(&data[ROTATION].c, q.w, err) ||
                       put_floats(&data[ROTATION].c, v3(q.x, q.y, q.z), err) ||
                       put_floats(&data[VELOCITY].c, p->now.v[row], err)))
            return -1;
    }
    return 0;
}

int fl_vtk_write_bodies(FILE *f, const fl_playback *p, const int32_t *group, int points, fl_err *err)
{
    struct named data[BODY_ARRAYS] = {{"body", "Int32", 1, {0}},        {"group", "Int32", 1, {0}},
                                      {"speed", "Float32", 1, {0}},     {"spin", "Float32", 1, {0}},
                                      {"thickness", "Float32", 1, {0}}, {"diameter", "Float32", 1, {0}},
                                      {"rotation", "Float32", 4, {0}},  {"velocity", "Float32", 3, {0}}};
    struct named point = {"Points", "Float32", 3, {0}}, normal = {"normal", "Float32", 3, {0}},
                 corner = {"connectivity", "Int32", 1, {0}};
    int rc = -1;
    for (int32_t r = 0; r < p->now.rows; r++) {
        if (!p->now.there[r]) continue;
        const fl_frame_shape *s = fl_frame_data_shape(p->data, r, p->now.k < 0 ? 0 : p->now.k);
        fl_rounded_mesh m = {0};
        int bad;
        if (points) bad = put_int(&corner.c, point.c.n / 3, err) || put_floats(&point.c, p->now.x[r], err);
        else
            bad = fl_rounded_mesh_shape(&m, p->data, s, s->nv < 3 ? 2 : 1, err) ||
                  add_mesh(&m, p->now.x[r], p->now.q[r], &point, &normal, &corner, err);
        bad = bad || add_body_data(data, p, s, r, group ? group[r] : -1, points ? 1 : m.nt, points, err);
        fl_rounded_mesh_free(&m);
        if (bad) goto done;
    }
    rc = write_piece(f, &point, &normal, &corner, points, data, points ? BODY_ARRAYS : ROTATION, p->now.t,
                     err);
done:
    for (int k = 0; k < BODY_ARRAYS; k++) free(data[k].c.x);
    free(point.c.x);
    free(normal.c.x);
    free(corner.c.x);
    return rc;
}

int64_t fl_vtk_panels(const fl_surface *s)
{
    int64_t n = 0;
    for (int32_t k = 0; k < s->n; k++) n += s->part[k].nt + s->part[k].nc;
    return n;
}

/* Panels of one kind of a part: its triangles, each a panel, or one of its cones, all of it a panel. */
static int add_panels(const fl_playback *p, int32_t k, const fl_part *piece, double chord,
                      const double (*panel)[4], struct named *data, struct named *point, struct named *normal,
                      struct named *corner, fl_err *err)
{
    fl_rounded_mesh m = {0};
    int bad = fl_rounded_mesh_part(&m, piece, chord, err) ||
              add_mesh(&m, p->now.part_x[k], p->now.part_q[k], point, normal, corner, err);
    for (int32_t t = 0; !bad && t < m.nt; t++) {
        bad = put_int(&data[0].c, piece->id, err);
        if (bad || !panel) continue;
        const double *a = panel[piece->nt ? t : 0];
        bad = put_floats(&data[1].c, a[0] > 0.0 ? v3_scale(1.0 / a[0], v3(a[1], a[2], a[3])) : v3(0, 0, 0),
                         err);
    }
    fl_rounded_mesh_free(&m);
    return bad ? -1 : 0;
}

int fl_vtk_write_structure(FILE *f, const fl_playback *p, const double (*panel)[4], fl_err *err)
{
    struct named data[2] = {{"part", "Int32", 1, {0}}, {"traction", "Float32", 3, {0}}};
    struct named point = {"Points", "Float32", 3, {0}}, normal = {"normal", "Float32", 3, {0}},
                 corner = {"connectivity", "Int32", 1, {0}};
    int rc = -1;
    for (int32_t k = 0; k < p->now.parts; k++) {
        const fl_part *part = &p->data->structure.part[k];
        const fl_aabb box = fl_part_aabb(part);
        const double chord = 1e-3 * v3_norm(v3_sub(box.hi, box.lo));
        for (int32_t c = -1; c < part->nc; c++) {
            fl_part piece = *part; /* borrows its arrays */
            piece.nc = c >= 0;
            piece.nt = c >= 0 ? 0 : part->nt;
            if (c >= 0) piece.cone = part->cone + c;
            if (add_panels(p, k, &piece, chord, panel, data, &point, &normal, &corner, err)) goto done;
            if (panel) panel += c >= 0 ? 1 : part->nt;
        }
    }
    rc = write_piece(f, &point, &normal, &corner, 0, data, panel ? 2 : 1, p->now.t, err);
done:
    for (int k = 0; k < 2; k++) free(data[k].c.x);
    free(point.c.x);
    free(normal.c.x);
    free(corner.c.x);
    return rc;
}

void fl_vtk_begin_collection(FILE *f)
{
    fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
          "byte_order=\"LittleEndian\">\n<Collection>\n",
          f);
}

void fl_vtk_add_file(FILE *f, double t, const char *name)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "<DataSet timestep=\"%s\" part=\"0\" file=\"%s\"/>\n", fl_number_text(t, text), name);
}

void fl_vtk_end_collection(FILE *f) { fputs("</Collection>\n</VTKFile>\n", f); }
