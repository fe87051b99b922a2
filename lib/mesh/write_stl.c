/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdint.h>
#include <string.h>
#include "base/number_text.h"
#include "mesh/write_stl.h"

static fl_vec3 normal_of(const fl_part *p, int32_t t)
{
    const int32_t *v = p->t[t].v;
    return v3_unit(v3_cross(v3_sub(p->v[v[1]], p->v[v[0]]), v3_sub(p->v[v[2]], p->v[v[0]])));
}

static void put_vec3(FILE *f, const char *word, fl_vec3 x)
{
    char a[FL_NUMBER_LEN], b[FL_NUMBER_LEN], c[FL_NUMBER_LEN];
    fprintf(f, "%s %s %s %s\n", word, fl_number_text(x.x, a), fl_number_text(x.y, b), fl_number_text(x.z, c));
}

void fl_stl_write_ascii(FILE *f, const fl_surface *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        const fl_part *p = &s->part[i];
        fprintf(f, "solid %s\n", p->name);
        for (int32_t t = 0; t < p->nt; t++) {
            put_vec3(f, " facet normal", normal_of(p, t));
            fputs("  outer loop\n", f);
            for (int k = 0; k < 3; k++) put_vec3(f, "   vertex", p->v[p->t[t].v[k]]);
            fputs("  endloop\n endfacet\n", f);
        }
        fprintf(f, "endsolid %s\n", p->name);
    }
}

static void put_u32(unsigned char *to, uint32_t u)
{
    for (int k = 0; k < 4; k++) to[k] = (unsigned char)(u >> 8 * k & 0xff);
}

static void put_f32(unsigned char *to, fl_vec3 x)
{
    const float f[3] = {(float)x.x, (float)x.y, (float)x.z};
    for (int k = 0; k < 3; k++) {
        uint32_t bits;
        memcpy(&bits, &f[k], sizeof bits);
        put_u32(to + 4 * k, bits);
    }
}

void fl_stl_write_binary(FILE *f, const fl_surface *s)
{
    unsigned char head[84] = "binary STL"; /* never "solid": many readers take that word for ASCII */
    uint32_t n = 0;
    for (int32_t i = 0; i < s->n; i++) n += (uint32_t)s->part[i].nt;
    put_u32(head + 80, n);
    fwrite(head, sizeof head, 1, f);
    for (int32_t i = 0; i < s->n; i++)
        for (int32_t t = 0; t < s->part[i].nt; t++) {
            const fl_part *p = &s->part[i];
            unsigned char record[50] = {0};
            put_f32(record, normal_of(p, t));
            for (int k = 0; k < 3; k++) put_f32(record + 12 + 12 * k, p->v[p->t[t].v[k]]);
            fwrite(record, sizeof record, 1, f);
        }
}
