/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_tecplot.h"
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/panel_mesh.h"

enum { HEADER = 2000 };

typedef struct {
    fl_panel_mesh m;
    fl_bytes *b;
    int columns;         /* of VARIABLES */
    int more;            /* state of the line that waits: 1, or 0 at the end */
    char header[HEADER]; /* of a zone, blanks for commas */
} tecplot_reader;

static int has_keyword(const char *p, const char *word)
{
    const size_t n = strlen(word);
    p += strspn(p, " \t");
    return strncasecmp(p, word, n) == 0 && strchr(" \t=\r\n", p[n]) != NULL;
}

int fl_tecplot_is(const fl_bytes *b)
{
    int variables = 0, zone = 0;
    for (const char *p = b->data; *p && !(variables && zone); p = fl_panel_next_line(p)) {
        variables |= has_keyword(p, "VARIABLES");
        zone |= has_keyword(p, "ZONE");
    }
    return variables && zone;
}

/* Value of KEY= in a header, upper and lower case alike; "" if it is not there. */
static const char *header_value(const char *header, const char *key, char value[FL_PANEL_WORD])
{
    const size_t n = strlen(key);
    int quoted = 0;
    value[0] = '\0';
    for (const char *p = header; *p; p++) {
        if (*p == '"') quoted = !quoted;
        if (quoted || strncasecmp(p, key, n) != 0 || (p > header && !strchr(" \t", p[-1]))) continue;
        const char *v = p + n + strspn(p + n, " \t");
        if (*v != '=') continue;
        v += 1 + strspn(v + 1, " \t");
        size_t len = strcspn(v, " \t");
        if (len >= FL_PANEL_WORD) len = FL_PANEL_WORD - 1;
        memcpy(value, v, len);
        value[len] = '\0';
        return value;
    }
    return value;
}

/* Joins the words of rows up to one that begins with a number. */
static int join_header(tecplot_reader *r, fl_err *err)
{
    fl_bytes *b = r->b;
    size_t used = strlen(r->header);
    double x;
    for (;;) {
        for (int32_t k = 0; k < b->words; k++) {
            const size_t n = strlen(b->field[k]);
            if (used + n + 2 > HEADER) return fl_bytes_fail(b, err, "a header of more than %d bytes", HEADER);
            memcpy(r->header + used, b->field[k], n);
            used += n;
            r->header[used++] = ' ';
            r->header[used] = '\0';
        }
        r->more = fl_bytes_row(b, err);
        if (r->more <= 0) break;
        if (fl_panel_is_real(b->field[0], &x) || has_keyword(b->field[0], "ZONE") ||
            has_keyword(b->field[0], "VARIABLES"))
            break;
    }
    for (char *p = r->header; *p; p++)
        if (*p == ',') *p = ' ';
    return r->more < 0 ? -1 : 0;
}

/* Names in VARIABLES = "X" "Y" "Z". */
static int count_variables(tecplot_reader *r, fl_err *err)
{
    int n = 0, quoted = 0;
    r->header[0] = '\0';
    if (join_header(r, err)) return -1;
    const char *p = strchr(r->header, '=');
    for (p = p ? p + 1 : ""; *p; p++) {
        if (*p == '"') quoted = !quoted;
        n += *p == '"' ? quoted : !quoted && *p != ' ' && p[-1] != '"' && strchr(" =", p[-1]) != NULL;
    }
    r->columns = n;
    return n >= 3 ? 0 : fl_bytes_fail(r->b, err, "VARIABLES names %d columns, x y z are expected", n);
}

/* The next number, from the row that waits on. */
static int next_real(tecplot_reader *r, int32_t *word, double *x, fl_err *err)
{
    while (r->more > 0 && *word >= r->b->words) {
        r->more = fl_bytes_row(r->b, err);
        *word = 0;
    }
    if (r->more < 0) return -1;
    if (r->more == 0) return fl_bytes_fail(r->b, err, "the file ends within a zone");
    return fl_panel_real(r->b, (*word)++, "a value of the zone", x, err);
}

static int zone_points(tecplot_reader *r, int64_t n, int32_t *word, fl_err *err)
{
    for (int64_t i = 0; i < n; i++) {
        double x[3] = {0}, other;
        for (int c = 0; c < r->columns; c++)
            if (next_real(r, word, c < 3 ? &x[c] : &other, err)) return -1;
        if (fl_panel_mesh_vertex(&r->m, v3(x[0], x[1], x[2]), err) < 0) return -1;
    }
    return 0;
}

static int zone_elements(tecplot_reader *r, int32_t first, int64_t nodes, int64_t elements, int corners,
                         int32_t *word, fl_err *err)
{
    for (int64_t i = 0; i < elements; i++) {
        int32_t v[4] = {-1, -1, -1, -1};
        for (int k = 0; k < corners; k++) {
            double x;
            if (next_real(r, word, &x, err)) return -1;
            if (!(x >= 1.0) || x > (double)nodes)
                return fl_bytes_fail(r->b, err, "the element has node %g of %lld", x, (long long)nodes);
            v[k] = first + (int32_t)x - 1;
        }
        if (fl_panel_mesh_add(&r->m, 0, v, err)) return -1;
    }
    return 0;
}

static int zone_grid(tecplot_reader *r, int32_t first, int32_t ni, int32_t nj, fl_err *err)
{
    for (int32_t j = 0; j + 1 < nj; j++)
        for (int32_t i = 0; i + 1 < ni; i++) {
            const int32_t a = first + j * ni + i, v[4] = {a, a + 1, a + 1 + ni, a + ni};
            if (fl_panel_mesh_add(&r->m, 0, v, err)) return -1;
        }
    return 0;
}

/* A count of the header under one of two names: its value, 0 where it is not there, -1 with FL_INPUT. */
static int64_t header_count(tecplot_reader *r, const char *a, const char *b, fl_err *err)
{
    char value[FL_PANEL_WORD];
    int64_t n;
    const char *key = *header_value(r->header, a, value) ? a : b;
    if (!*header_value(r->header, key, value)) return 0;
    if (fl_panel_is_integer(value, &n) && n >= 0 && n < 100000000) return n;
    return fl_bytes_fail(r->b, err, "%s=%s of ZONE, a count is expected", key, value);
}

static int read_zone(tecplot_reader *r, fl_err *err)
{
    char type[FL_PANEL_WORD], packing[FL_PANEL_WORD];
    const int32_t first = r->m.vertices, line = r->b->line;
    int32_t word = 0;
    r->header[0] = '\0';
    if (join_header(r, err)) return -1;
    const int64_t n = header_count(r, "N", "NODES", err), e = header_count(r, "E", "ELEMENTS", err),
                  i = header_count(r, "I", "I", err), j = header_count(r, "J", "J", err);
    if (n < 0 || e < 0 || i < 0 || j < 0) return -1;
    if (!*header_value(r->header, "ET", type)) header_value(r->header, "ZONETYPE", type);
    if (!*header_value(r->header, "F", packing)) header_value(r->header, "DATAPACKING", packing);
    if (strcasecmp(packing, "FEBLOCK") == 0 || strcasecmp(packing, "BLOCK") == 0)
        return fl_bytes_fail(r->b, err, "a zone with its data in blocks: write it by points");
    if (n == 0 && i > 0 && i * (j > 0 ? j : 1) < INT32_MAX) {
        if (zone_points(r, i * (j > 0 ? j : 1), &word, err)) return -1;
        if (zone_grid(r, first, (int32_t)i, (int32_t)j, err)) return -1;
    } else if (n > 0) {
        const int corners =
            strcasecmp(type, "TRIANGLE") == 0 || strcasecmp(type, "FETRIANGLE") == 0             ? 3
            : strcasecmp(type, "QUADRILATERAL") == 0 || strcasecmp(type, "FEQUADRILATERAL") == 0 ? 4
                                                                                                 : 0;
        if (corners == 0)
            return fl_bytes_fail(r->b, err, "a zone of type \"%s\", QUADRILATERAL or TRIANGLE is expected",
                                 type);
        if (zone_points(r, n, &word, err) || zone_elements(r, first, n, e, corners, &word, err)) return -1;
    } else {
        r->b->line = line;
        return fl_bytes_fail(r->b, err, "ZONE has neither N and E nor I and J");
    }
    r->more = fl_bytes_row(r->b, err);
    return r->more < 0 ? -1 : 0;
}

int fl_tecplot_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    tecplot_reader r = {.m = {.b = b}, .b = b, .columns = 3};
    int rc = -1;
    (void)name, (void)opt;
    b->comment = '#';
    if (fl_panel_mesh_body(&r.m, "hull", err) < 0) goto done;
    r.more = fl_bytes_row(b, err);
    while (r.more > 0) {
        if (has_keyword(b->field[0], "VARIABLES")) {
            if (count_variables(&r, err)) goto done;
        } else if (has_keyword(b->field[0], "ZONE")) {
            if (read_zone(&r, err)) goto done;
        } else {
            r.more = fl_bytes_row(b, err);
        }
    }
    rc = r.more < 0 ? -1 : fl_panel_mesh_finish(&r.m, s, err);
done:
    fl_panel_mesh_free(&r.m);
    return rc;
}
