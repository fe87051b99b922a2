/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/text.h"
#include "geom/polygon.h"
#include "ice/sizes_read.h"
#include "shim/cgal_simple.h"

/* Bounds of sizes and counts [m, m2, 1], and of coordinates [m]: squares and sums are finite, and the area
 * of a polygon far from the origin is accurate. */
#define SMALLEST 1e-12
#define LARGEST 1e12
#define FAR 1e9

enum holds { AREAS, DIAMETERS, CORNERS };

struct size {
    double area, count;
};

struct reading {
    fl_text in;
    enum holds holds;
    int counted;
    int32_t n, cap, corners, room;
    struct size *size;
    fl_vec2 *v;    /* corners of the current polygon */
    int64_t begun; /* line of its first corner */
};

static int add_size(struct reading *r, double area, double count, fl_err *err)
{
    if (fl_grow(&r->size, &r->cap, (int64_t)r->n + 1, sizeof *r->size, err)) return -1;
    r->size[r->n++] = (struct size){area, count};
    return 0;
}

static int read_positive(struct reading *r, const char *what, double *x, fl_err *err)
{
    if (fl_text_f64(&r->in, what, x, err)) return -1;
    if (*x >= SMALLEST && *x <= LARGEST) return 0;
    return fl_text_fail(&r->in, err, "%s %g found, one from %g to %g is expected", what, *x, SMALLEST,
                        LARGEST);
}

static int read_size(struct reading *r, fl_err *err)
{
    double x = 0.0, count = 1.0;
    if (read_positive(r, "size", &x, err)) return -1;
    if (r->counted && read_positive(r, "count", &count, err)) return -1;
    if (fl_text_no_more(&r->in, err)) return -1;
    return add_size(r, r->holds == DIAMETERS ? 0.25 * PI * x * x : x, count, err);
}

/* --- polygons ------------------------------------------------------------------------------------------- */

static int read_corner(struct reading *r, fl_err *err)
{
    fl_vec2 p = {0.0, 0.0};
    if (fl_text_f64(&r->in, "x", &p.x, err) || fl_text_f64(&r->in, "y", &p.y, err) ||
        fl_text_no_more(&r->in, err))
        return -1;
    if (!(fabs(p.x) <= FAR && fabs(p.y) <= FAR))
        return fl_text_fail(&r->in, err, "corner (%g, %g) found, coordinates up to %g are expected", p.x, p.y,
                            FAR);
    if (fl_grow(&r->v, &r->room, (int64_t)r->corners + 1, sizeof *r->v, err)) return -1;
    if (r->corners == 0) r->begun = r->in.line_number;
    r->v[r->corners++] = p;
    return 0;
}

static int close_polygon(struct reading *r, fl_err *err)
{
    int32_t n = r->corners;
    const fl_vec2 *v = r->v;
    const int64_t now = r->in.line_number;
    int simple, rc;
    double area;
    if (n == 0) return 0;
    r->corners = 0;
    if (n > 1 && v[n - 1].x == v[0].x && v[n - 1].y == v[0].y) n--;
    r->in.line_number = r->begun; /* the message is about the polygon, not about the line after it */
    if (n < 3)
        return fl_text_fail(&r->in, err, "a polygon of %d different corners found, three are expected", n);
    simple = fl_cgal_is_simple(n, v, err);
    if (simple < 0) return -1;
    if (!simple)
        return fl_text_fail(&r->in, err,
                            "the polygon of %d corners crosses or touches itself, one that does not is "
                            "expected",
                            n);
    area = fabs(fl_polygon_area(n, v));
    if (!(area >= SMALLEST && area <= LARGEST))
        return fl_text_fail(&r->in, err, "a polygon of %g m2 found, one from %g to %g is expected", area,
                            SMALLEST, LARGEST);
    rc = add_size(r, area, 1.0, err);
    r->in.line_number = now;
    return rc;
}

/* --- the file ------------------------------------------------------------------------------------------- */

/* 1 if the row names the columns. */
static int read_header(struct reading *r)
{
    char **f = r->in.field;
    const int32_t n = r->in.n;
    if (n == 2 && strcmp(f[0], "x[m]") == 0 && strcmp(f[1], "y[m]") == 0) {
        r->holds = CORNERS;
        return 1;
    }
    if (n > 2 || (strcmp(f[0], "d[m]") != 0 && strcmp(f[0], "area[m2]") != 0) ||
        (n == 2 && strcmp(f[1], "count") != 0))
        return 0;
    r->holds = f[0][0] == 'd' ? DIAMETERS : AREAS;
    r->counted = n == 2;
    return 1;
}

static int is_blank(const char *line) { return line[strspn(line, " \t\f\v")] == '\0'; }

static int read_rows(struct reading *r, fl_err *err)
{
    int more, rows = 0;
    while ((more = fl_text_line(&r->in, err)) > 0) {
        const int empty = is_blank(r->in.line), cut = fl_text_split(&r->in, err);
        if (cut < 0) return -1;
        if (cut && rows++ == 0 && read_header(r)) continue;
        if (r->holds == CORNERS && (empty || (cut && strcmp(r->in.field[0], ">") == 0))) {
            if (close_polygon(r, err)) return -1;
        } else if (cut && (r->holds == CORNERS ? read_corner(r, err) : read_size(r, err))) {
            return -1;
        }
    }
    if (more < 0 || close_polygon(r, err)) return -1;
    if (r->n == 0)
        return fl_text_fail(&r->in, err, "the file ends without a size, %s is expected",
                            r->holds == CORNERS ? "a polygon" : "one a row");
    return 0;
}

static int by_area(const void *a, const void *b)
{
    const struct size *x = a, *y = b;
    if (x->area != y->area) return (x->area > y->area) - (x->area < y->area);
    return (x->count > y->count) - (x->count < y->count);
}

/* Cumulative sums in ascending order: least rounding, independent of the order of the file. */
static int make_sizes(struct reading *r, fl_sizes *s, fl_err *err)
{
    *s = (fl_sizes){.kind = FL_SIZES_LIST, .n = r->n};
    qsort(r->size, (size_t)r->n, sizeof *r->size, by_area);
    if (!(s->area = fl_alloc(r->n, sizeof *s->area, err)) ||
        !(s->cumulative_count = fl_alloc((int64_t)r->n + 1, sizeof *s->cumulative_count, err)) ||
        !(s->cumulative_area = fl_alloc((int64_t)r->n + 1, sizeof *s->cumulative_area, err)))
        return -1;
    for (int32_t k = 0; k < r->n; k++) {
        s->area[k] = r->size[k].area;
        s->cumulative_count[k + 1] = s->cumulative_count[k] + r->size[k].count;
        s->cumulative_area[k + 1] = s->cumulative_area[k] + r->size[k].area * r->size[k].count;
    }
    return 0;
}

int fl_sizes_read(fl_sizes *out, const char *path, fl_err *err)
{
    struct reading r = {0};
    fl_sizes s = {0};
    int rc = -1;
    if (fl_text_open(&r.in, path, err) || read_rows(&r, err) || make_sizes(&r, &s, err)) goto done;
    *out = s;
    s = (fl_sizes){0};
    rc = 0;
done:
    free(r.size);
    free(r.v);
    fl_sizes_free(&s);
    fl_text_close(&r.in);
    return rc;
}
