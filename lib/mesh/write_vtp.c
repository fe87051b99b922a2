/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <stdint.h>
#include "mesh/byte_order.h"
#include "mesh/write_vtp.h"

/* Names as VTK stores them: the bytes of each and a zero, as decimal numbers. */
static void put_names(FILE *f, const fl_surface *s)
{
    fprintf(f, "<Array type=\"String\" Name=\"part_name\" NumberOfTuples=\"%d\" format=\"ascii\">\n", s->n);
    for (int32_t i = 0; i < s->n; i++) {
        for (const char *c = s->part[i].name; *c; c++) fprintf(f, "%d ", (unsigned char)*c);
        fputs("0\n", f);
    }
    fputs("</Array>\n", f);
    fprintf(f, "<DataArray type=\"Int32\" Name=\"part_id\" NumberOfTuples=\"%d\" format=\"ascii\">\n", s->n);
    for (int32_t i = 0; i < s->n; i++) fprintf(f, "%d\n", s->part[i].id);
    fputs("</DataArray>\n", f);
}

/* An array of the appended data; *offset becomes that of the next one. */
static void put_array(FILE *f, const char *head, int64_t *offset, int64_t bytes)
{
    fprintf(f, "<DataArray %s format=\"appended\" offset=\"%" PRId64 "\"/>\n", head, *offset);
    *offset += 8 + bytes;
}

static void put_head(FILE *f, const fl_surface *s, int64_t nv, int64_t nt)
{
    int64_t offset = 0;
    fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
          "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n",
          f);
    put_names(f, s);
    fprintf(f,
            "</FieldData>\n<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
            "NumberOfStrips=\"0\" NumberOfPolys=\"%" PRId64 "\">\n<CellData Scalars=\"part\">\n",
            nv, nt);
    put_array(f, "type=\"Int32\" Name=\"part\"", &offset, 4 * nt);
    fputs("</CellData>\n<Points>\n", f);
    put_array(f, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", &offset, 24 * nv);
    fputs("</Points>\n<Polys>\n", f);
    put_array(f, "type=\"Int32\" Name=\"connectivity\"", &offset, 12 * nt);
    put_array(f, "type=\"Int32\" Name=\"offsets\"", &offset, 4 * nt);
    fputs("</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_", f);
}

int fl_vtp_write(FILE *f, const fl_surface *s, fl_err *err)
{
    int64_t nv = 0, nt = 0;
    int32_t first = 0;
    for (int32_t i = 0; i < s->n; i++) {
        nv += s->part[i].nv;
        nt += s->part[i].nt;
    }
    if (nv > INT32_MAX || 3 * nt > INT32_MAX)
        return fl_fail(err, FL_INPUT, "%" PRId64 " triangles are more than 32 bits can number", nt);
    put_head(f, s, nv, nt);
    fl_put_uint_le(f, (uint64_t)(4 * nt), 8);
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t t = 0; t < s->part[i].nt; t++) fl_put_uint_le(f, (uint64_t)s->part[i].id, 4);
    fl_put_uint_le(f, (uint64_t)(24 * nv), 8);
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t v = 0; v < s->part[i].nv; v++) fl_put_vec3_le(f, s->part[i].v[v]);
    fl_put_uint_le(f, (uint64_t)(12 * nt), 8);
    for (int32_t i = 0; i < s->n; i++) {
        for (int32_t t = 0; t < s->part[i].nt; t++)
            for (int k = 0; k < 3; k++) fl_put_uint_le(f, (uint64_t)(first + s->part[i].t[t].v[k]), 4);
        first += s->part[i].nv;
    }
    fl_put_uint_le(f, (uint64_t)(4 * nt), 8);
    for (int64_t t = 1; t <= nt; t++) fl_put_uint_le(f, (uint64_t)(3 * t), 4);
    fputs("\n</AppendedData>\n</VTKFile>\n", f);
    return 0;
}
