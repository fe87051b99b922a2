/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "path_plot.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/gnuplot.h"
#include "base/stream.h"
#include "base/text.h"
#include "geom/aabb.h"
#include "member/imperfection.h"

enum { PATH_LEN = 4096 };

int path_plot_begin(const struct options *o, fl_err *err)
{
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    return 0;
}

static int open_in(fl_out *out, const struct options *o, const char *stem, const char *extension, fl_err *err)
{
    char path[PATH_LEN];
    if (snprintf(path, sizeof path, "%s/%s.%s", o->plot, stem, extension) >= (int)sizeof path)
        return fl_fail(err, FL_SYSTEM, "%.60s...: the name is too long", o->plot);
    return fl_out_open(out, path, 0, err);
}

static void write_terminal(FILE *f, const struct options *o, int width, int height)
{
    if (strcmp(o->format, "png") == 0)
        fprintf(f, "set terminal pngcairo noenhanced size %d,%d font 'Sans,11' background '#ffffff'\n", width,
                height);
    else
        fprintf(f,
                "set terminal svg noenhanced size %d,%d dynamic font 'sans-serif,14' background '#ffffff'\n",
                width, height);
    fputs("set encoding utf8\nset output out\nset border lc rgb '#444444' lw 1\n"
          "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n",
          f);
}

/* Lines of the members before and after. Two blank lines end each: after one, splot takes members of equal
 * length for the rows of a surface. */
static void write_members(FILE *f, const fl_member_chain *c)
{
    int32_t member = -1;
    for (int32_t k = 0; k < c->contacts; k++) {
        const fl_member_contact *e = &c->contact[k];
        if (e->member != member && member >= 0) fputs("\n\n", f);
        for (int s = e->member == member; s < 2; s++) {
            const fl_vec3 x = fl_member_contact_end(c, e, s), x0 = fl_member_contact_start(c, e, s);
            fprintf(f, "%.9g %.9g %.9g %.9g %.9g %.9g\n", x.x, x.y, x.z, x0.x, x0.y, x0.z);
        }
        member = e->member;
    }
}

static int is_planar(const fl_member_chain *c)
{
    for (int32_t b = 0; b < c->balls; b++)
        if (c->ball[b].x0.y != c->ball[0].x0.y) return 0;
    return 1;
}

/* Factor by which z is drawn, so that a flat dome is not a line. */
static int height_factor(const fl_member_chain *c)
{
    static const int FACTOR[] = {1, 2, 5, 10, 20};
    fl_aabb box = aabb_empty();
    int k = 4;
    for (int32_t b = 0; b < c->balls; b++) {
        const fl_vec3 x0 = c->ball[b].x0, x = v3_add(x0, c->ball[b].d);
        box = aabb_join(box, aabb_join((fl_aabb){x0, x0}, (fl_aabb){x, x}));
    }
    const fl_vec3 size = v3_sub(box.hi, box.lo);
    while (k > 0 && FACTOR[k] * size.z > 0.45 * fmax(size.x, size.y)) k--;
    return FACTOR[k];
}

int path_plot_shape(const struct options *o, const fl_member_model *m, const fl_member_chain *c,
                    int64_t point, fl_err *err)
{
    char stem[FL_GNUPLOT_STEM];
    fl_out out = {0};
    snprintf(stem, sizeof stem, "shape-%lld", (long long)point);
    if (open_in(&out, o, stem, "tsv", err)) return -1;
    fl_member_write_shape(out.f, m, c);
    if (fl_out_close(&out, err) || open_in(&out, o, stem, "dat", err)) return -1;
    write_members(out.f, c);
    if (fl_out_close(&out, err) || open_in(&out, o, stem, "gp", err)) return -1;
    const int flat = is_planar(c), factor = flat ? 1 : height_factor(c);
    write_terminal(out.f, o, 900, 640);
    if (flat) {
        fputs("set size ratio -1\nset grid back lc rgb '#dddddd' lw 0.8\nset border 3\nset xlabel 'x'\nset "
              "ylabel "
              "'z'\nset key outside top center horizontal\nset offsets graph 0.05, graph 0.05, graph 0.05, "
              "graph 0.05\n",
              out.f);
        fprintf(out.f,
                "plot '%s.dat' using 4:6 with lines lw 1.5 lc rgb '#999999' title 'start', '' using 1:3 with "
                "linespoints lw 2 pt 7 ps 0.4 lc rgb '#08519c' title 'point %lld'\nset output\n",
                stem, (long long)point);
    } else {
        fputs("set view equal xyz\nset view 62,28,1.3\nset xyplane relative 0\nunset border\nunset tics\nset "
              "key at "
              "screen 0.5,0.95 center horizontal\n",
              out.f);
        if (factor > 1)
            fprintf(out.f, "set label 'z drawn %d times as large' at screen 0.5,0.05 center\n", factor);
        fprintf(out.f,
                "splot '%s.dat' using 4:5:(%d*$6) with lines lw 1.2 lc rgb '#888888' title 'start', '' using "
                "1:2:(%d*$3) with lines lw 2 lc rgb '#08519c' title 'point %lld'\nset output\n",
                stem, factor, factor, (long long)point);
    }
    if (fl_out_close(&out, err)) return -1;
    return fl_gnuplot_draw(o->plot, stem, o->format, err);
}

/* Columns along and lambda of the rows that were written. */
static int write_curve(FILE *f, const fl_path_table *t, fl_err *err)
{
    fl_text in = {0};
    int more = 0, rc = fl_text_open_bytes(&in, "path", t->text ? t->text : "", t->len, err);
    while (rc == 0 && (more = fl_text_row(&in, err)) > 0) fprintf(f, "%s %s\n", in.field[4], in.field[1]);
    fl_text_close(&in);
    return rc || more < 0 ? -1 : 0;
}

/* The reference, as numbers, so that the folder stands alone. */
static int copy_reference(FILE *f, const char *path, fl_err *err)
{
    fl_text in = {0};
    int more = 0, rc = fl_text_open(&in, path, err);
    while (rc == 0 && (more = fl_text_row(&in, err)) > 0) {
        double x, y;
        rc = fl_text_f64(&in, "displacement", &x, err) || fl_text_f64(&in, "load factor", &y, err) ? -1 : 0;
        if (rc == 0) fprintf(f, "%.17g %.17g\n", x, y);
    }
    fl_text_close(&in);
    return rc || more < 0 ? -1 : 0;
}

int path_plot_curve(const struct options *o, const fl_path_table *t, fl_err *err)
{
    fl_out out = {0};
    if (open_in(&out, o, "path", "dat", err)) return -1;
    if (write_curve(out.f, t, err)) {
        fl_out_abort(&out);
        return -1;
    }
    if (fl_out_close(&out, err)) return -1;
    if (o->reference) {
        if (open_in(&out, o, "reference", "dat", err)) return -1;
        if (copy_reference(out.f, o->reference, err)) {
            fl_out_abort(&out);
            return -1;
        }
        if (fl_out_close(&out, err)) return -1;
    }
    if (open_in(&out, o, "path", "gp", err)) return -1;
    write_terminal(out.f, o, 800, 560);
    fprintf(
        out.f,
        "set border 3\nset xlabel 'displacement along the load'\nset ylabel 'load factor'\nset grid back lc "
        "rgb "
        "'#dddddd' lw 0.8\nset key left top Left reverse\n"
        "plot 'path.dat' with linespoints pt 7 ps 0.3 lw 2 lc rgb '#08519c' title 'arc-path'%s\nset output\n",
        o->reference ? ", 'reference.dat' with points pt 6 ps 1.2 lw 1.5 lc rgb '#d94801' title 'reference'"
                     : "");
    if (fl_out_close(&out, err)) return -1;
    return fl_gnuplot_draw(o->plot, "path", o->format, err);
}
