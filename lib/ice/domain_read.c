/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/text.h"
#include "ice/domain_read.h"

/* Largest coordinate [m]. */
#define FAR 1e9

struct ring {
    int32_t n, cap;
    fl_vec2 *v;
    int64_t begun; /* line of its first corner */
};

static int read_corner(struct ring *r, fl_text *in, fl_err *err)
{
    fl_vec2 p = {0.0, 0.0};
    if (fl_text_f64(in, "x", &p.x, err) || fl_text_f64(in, "y", &p.y, err) || fl_text_no_more(in, err))
        return -1;
    if (!(fabs(p.x) <= FAR && fabs(p.y) <= FAR))
        return fl_text_fail(in, err, "corner (%g, %g) found, coordinates up to %g are expected", p.x, p.y,
                            FAR);
    if (fl_grow(&r->v, &r->cap, (int64_t)r->n + 1, sizeof *r->v, err)) return -1;
    if (r->n == 0) r->begun = in->line_number;
    r->v[r->n++] = p;
    return 0;
}

static int close_ring(fl_domain *d, struct ring *r, fl_text *in, fl_err *err)
{
    const int64_t now = in->line_number;
    fl_err why = {0};
    int32_t n = r->n;
    r->n = 0;
    if (n == 0) return 0;
    if (n > 1 && r->v[n - 1].x == r->v[0].x && r->v[n - 1].y == r->v[0].y) n--;
    if (fl_domain_add(d, n, r->v, &why) == 0) return 0;
    if (why.code != FL_INPUT) return fl_fail(err, why.code, "%s", why.text);
    in->line_number = r->begun; /* the message is about the ring, not about the line after it */
    fl_text_fail(in, err, "%s", why.text);
    in->line_number = now;
    return -1;
}

static int is_blank(const char *line) { return line[strspn(line, " \t\f\v")] == '\0'; }

static int read_rings(fl_domain *d, struct ring *r, fl_text *in, fl_err *err)
{
    int more, rows = 0;
    while ((more = fl_text_line(in, err)) > 0) {
        const int empty = is_blank(in->line), cut = fl_text_split(in, err);
        if (cut < 0) return -1;
        if (cut && rows++ == 0 && in->n == 2 && strcmp(in->field[0], "x[m]") == 0 &&
            strcmp(in->field[1], "y[m]") == 0)
            continue;
        if (empty || (cut && strcmp(in->field[0], ">") == 0)) {
            if (close_ring(d, r, in, err)) return -1;
        } else if (cut && read_corner(r, in, err)) {
            return -1;
        }
    }
    if (more < 0 || close_ring(d, r, in, err)) return -1;
    return d->rings ? 0 : fl_text_fail(in, err, "the file ends without a ring of corners, one is expected");
}

int fl_domain_read(fl_domain *d, const char *path, fl_err *err)
{
    struct ring r = {0};
    fl_text in = {0};
    int rc = -1;
    if (fl_text_open(&in, path, err) == 0) rc = read_rings(d, &r, &in, err);
    if (rc) fl_domain_free(d);
    free(r.v);
    fl_text_close(&in);
    return rc;
}
