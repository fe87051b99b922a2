/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack_plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/gnuplot.h"
#include "base/number_text.h"
#include "base/pi.h"
#include "base/stream.h"

enum { WIDTH = 900, PATH_LEN = 4096, CLASSES = 24, CURVE = 200, RANKS = 2000, CIRCLE = 48, POINTS = 512 };

struct picture {
    const struct options *o;
    const struct result *r;
    FILE *data, *script;
};

static void write_row(FILE *f, double x, double y)
{
    char text[FL_NUMBER_LEN];
    fputs(fl_number_text(x, text), f);
    putc('\t', f);
    fputs(fl_number_text(y, text), f);
    putc('\n', f);
}

static void begin_script(const struct picture *p, const char *stem, int width, int height)
{
    FILE *f = p->script;
    fprintf(f, "# gnuplot %s.gp draws %s.%s from %s.tsv\n", stem, stem, p->o->format, stem);
    fprintf(f, "if (!exists(\"out\")) out = '%s.%s'\n", stem, p->o->format);
    if (strcmp(p->o->format, "png") == 0)
        fprintf(f, "set terminal pngcairo noenhanced size %d,%d font 'Sans,11' background '#ffffff'\n", width,
                height);
    else
        fprintf(f,
                "set terminal svg noenhanced size %d,%d dynamic font 'sans-serif,14' background '#ffffff'\n",
                width, height);
    fprintf(f,
            "set encoding utf8\nset output out\ndata = '%s.tsv'\nset border lc rgb '#444444' lw 1\n"
            "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n",
            stem);
}

/* --- grading ------------------------------------------------------------------------------------ */

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int write_grading(struct picture *p, fl_err *err)
{
    const fl_packing *q = &p->r->packing;
    const fl_grading *g = &p->r->grading;
    const double lo = 0.8 * p->r->certificate.least, hi = 1.25 * p->r->certificate.most;
    double *d = fl_alloc(q->n, sizeof *d, err), all = 0.0, sum = 0.0;
    if (!d) return -1;
    for (int32_t i = 0; i < q->n; i++) d[i] = q->s * q->size[i], all += pow(d[i], q->dim);
    qsort(d, (size_t)q->n, sizeof *d, by_size);
    const int32_t each = q->n / RANKS + 1;
    write_row(p->data, lo, 0.0);
    for (int32_t k = 0; k < q->n; k++) {
        if (k % each == 0 || k == q->n - 1) write_row(p->data, d[k], 100.0 * sum / all);
        sum += pow(d[k], q->dim);
        if (k % each == 0 || k == q->n - 1) write_row(p->data, d[k], 100.0 * sum / all);
    }
    write_row(p->data, hi, 100.0);
    free(d);
    begin_script(p, "grading", WIDTH, 560);
    fputs("set border 3\nset grid back lc rgb '#dddddd' lw 0.8\nset logscale x\nset xlabel 'Size  [m]'\n"
          "set ylabel 'Passing by mass  [%]'\nset yrange [0:102]\nset key top left Left reverse samplen 2\n",
          p->script);
    /* a decade has few marks of its own */
    fprintf(p->script, "set xrange [%.6g:%.6g]\n", lo, hi);
    if (hi / lo < 20.0) {
        fputs("set xtics (", p->script);
        for (int e = (int)floor(log10(lo)), n = 0; e <= (int)ceil(log10(hi)); e++)
            for (int k = 1; k < 10; k++) {
                const double x = k * pow(10.0, e);
                if (x < lo || x > hi || (hi / lo > 6.0 && k > 5 && k != 7)) continue;
                fprintf(p->script, "%s'%g' %g", n++ ? ", " : "", x, x);
            }
        fputs(")\n", p->script);
    }
    const int curve = options_graded(p->o) && g->pieces > 0;
    if (curve) {
        fputs("\n\n", p->data);
        for (int k = 0; k <= CURVE; k++) {
            const double x = lo * pow(hi / lo, (double)k / CURVE);
            write_row(p->data, x, 100.0 * fl_grading_mass(g, q->dim, x));
        }
    }
    fputs("plot data index 0 using 1:2 with lines lw 3 lc rgb '#6baed6' title 'got'", p->script);
    if (curve) fputs(", data index 1 using 1:2 with lines lw 1.5 lc rgb '#d94801' title 'asked'", p->script);
    fputs("\nset output\n", p->script);
    return 0;
}

/* --- the plan, or a section --------------------------------------------------------------------- */

/* Corners of the section of body i with the plane y = at, in x and z; in two dimensions its disc.  Returns
 * their number, 0 for none. */
static int section_of(const fl_packing *p, int32_t i, double at, fl_vec3 *corner, double out[POINTS][2])
{
    const double r = p->s * p->radius[i];
    int n = 0;
    if (!p->q) {
        const double off = p->dim == 2 ? 0.0 : p->x[i].y - at, rho2 = r * r - off * off;
        if (!(rho2 > 0.0)) return 0;
        for (int k = 0; k < CIRCLE; k++) {
            const double a = 2.0 * PI * k / CIRCLE, up = p->dim == 2 ? p->x[i].y : p->x[i].z;
            out[k][0] = p->x[i].x + sqrt(rho2) * cos(a);
            out[k][1] = up + sqrt(rho2) * sin(a);
        }
        return CIRCLE;
    }
    /* the hull of the section is that of its crossings with edges; here with all pairs of corners, each a
     * ball of the dilation radius */
    fl_packing_corners(p, i, corner);
    const int32_t nv = p->shapes->shape[p->shape[i]].core.nv;
    for (int32_t a = 0; a < nv; a++)
        for (int32_t b = a; b < nv; b++)
            for (int side = -1; side <= 1; side += 2) {
                const double ya = corner[a].y - at, yb = corner[b].y - at;
                if (a == b ? fabs(ya) >= r : ya * yb >= 0.0) continue;
                if (n + 8 >= POINTS) return n;
                const double t = a == b ? 0.0 : ya / (ya - yb), rho = a == b ? sqrt(r * r - ya * ya) : r;
                const double x = corner[a].x + t * (corner[b].x - corner[a].x),
                             z = corner[a].z + t * (corner[b].z - corner[a].z);
                if (side > 0) continue;
                for (int k = 0; k < 8; k++, n++)
                    out[n][0] = x + rho * cos(PI * k / 4), out[n][1] = z + rho * sin(PI * k / 4);
            }
    return n;
}

static int by_place(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return p[0] != q[0] ? (p[0] > q[0]) - (p[0] < q[0]) : (p[1] > q[1]) - (p[1] < q[1]);
}

/* Convex hull in place, by Andrew's chains.  Returns its corners. */
static int hull_of(double p[POINTS][2], int n)
{
    double h[2 * POINTS][2];
    int m = 0;
    if (n < 3) return n;
    qsort(p, (size_t)n, sizeof *p, by_place);
    for (int pass = 0; pass < 2; pass++) {
        const int from = m;
        for (int k = 0; k < n; k++) {
            const double *c = p[pass ? n - 1 - k : k];
            while (m - from >= 2 && (h[m - 1][0] - h[m - 2][0]) * (c[1] - h[m - 2][1]) -
                                            (h[m - 1][1] - h[m - 2][1]) * (c[0] - h[m - 2][0]) <=
                                        0.0)
                m--;
            h[m][0] = c[0], h[m][1] = c[1], m++;
        }
        m--;
    }
    memcpy(p, h, (size_t)m * sizeof *p);
    return m;
}

/* Lines of the boundary. */
static void write_region(const struct picture *p)
{
    const fl_pack_region *r = &p->r->region;
    const double mid = 0.5 * (r->lo.y + r->hi.y);
    if (r->kind == FL_REGION_FEATURES) {
        for (int32_t k = 0; k < r->features; k++) {
            const fl_region_feature *f = &r->feature[k];
            if (r->dim == 2 && f->corners == 2) {
                write_row(p->data, f->p[0].x, f->p[0].y);
                write_row(p->data, f->p[1].x, f->p[1].y);
                putc('\n', p->data);
            }
            if (r->dim == 2 || f->corners != 3) continue;
            double x[3][2];
            int n = 0;
            for (int a = 0; a < 3; a++) {
                const fl_vec3 u = f->p[a], v = f->p[(a + 1) % 3];
                if ((u.y - mid) * (v.y - mid) >= 0.0) continue;
                const double t = (mid - u.y) / (v.y - u.y);
                x[n][0] = u.x + t * (v.x - u.x), x[n][1] = u.z + t * (v.z - u.z), n++;
            }
            if (n < 2) continue;
            write_row(p->data, x[0][0], x[0][1]);
            write_row(p->data, x[1][0], x[1][1]);
            putc('\n', p->data);
        }
        return;
    }
    const int round = r->kind == FL_REGION_SPHERE || (r->kind == FL_REGION_CYLINDER && r->dim == 2);
    const double lo = r->dim == 2 ? r->lo.y : r->lo.z, hi = r->dim == 2 ? r->hi.y : r->hi.z;
    for (int k = 0; round && k <= 120; k++)
        write_row(p->data, r->centre.x + r->radius * cos(2.0 * PI * k / 120),
                  0.5 * (lo + hi) + r->radius * sin(2.0 * PI * k / 120));
    if (round) return;
    const double x[5] = {r->lo.x, r->hi.x, r->hi.x, r->lo.x, r->lo.x}, y[5] = {lo, lo, hi, hi, lo};
    for (int k = 0; k < 5; k++) write_row(p->data, x[k], y[k]);
}

static int write_section(struct picture *p, fl_err *err)
{
    const fl_packing *q = &p->r->packing;
    const fl_pack_region *r = &p->r->region;
    const double at = 0.5 * (r->lo.y + r->hi.y), least = p->r->certificate.least,
                 most = p->r->certificate.most;
    const double lo = q->dim == 2 ? r->lo.y : r->lo.z, hi = q->dim == 2 ? r->hi.y : r->hi.z;
    int32_t corners = 1, blocks = 0;
    for (int32_t k = 0; k < q->shapes->n; k++)
        if (q->shapes->shape[k].core.nv > corners) corners = q->shapes->shape[k].core.nv;
    fl_vec3 *corner = fl_alloc(corners, sizeof *corner, err);
    double(*point)[2] = fl_alloc(POINTS, sizeof *point, err);
    if (!corner || !point) {
        free(corner), free(point);
        return -1;
    }
    const double height = WIDTH * 0.8 * (hi - lo) / (r->hi.x - r->lo.x) + 130.0;
    begin_script(p, "section", WIDTH, height < 300.0 ? 300 : height > 2400.0 ? 2400 : (int)height);
    fprintf(p->script,
            "set palette defined (0 '#440154', 1 '#443983', 2 '#31688e', 3 '#21918c', 4 '#35b779', 5 "
            "'#90d743', 6 "
            "'#fde725')\nset size ratio -1\nset xlabel 'x  [m]'\nset ylabel '%s  [m]'\nunset key\n",
            q->dim == 2 ? "y" : "z");
    const double edge = 0.02 * fmax(hi - lo, r->hi.x - r->lo.x);
    fprintf(p->script, "set xrange [%.10g:%.10g]\nset yrange [%.10g:%.10g]\n", r->lo.x - edge, r->hi.x + edge,
            lo - edge, hi + edge);
    fprintf(p->script, "set cbrange [%.6g:%.6g]\nset cblabel 'Size  [m]' offset 1.5\n",
            least * (most > 1.01 * least ? 1.0 - 1e-3 : 0.9),
            most * (most > 1.01 * least ? 1.0 + 1e-3 : 1.1));
    if (q->dim == 3) fprintf(p->script, "set title 'section at y = %.6g m'\n", at);
    write_region(p);
    fputs("\n\n", p->data);
    fputs("plot data index 0 using 1:2 with lines lc rgb '#222222' lw 1.5", p->script);
    for (int k = 0; k < CLASSES; k++) {
        int some = 0;
        for (int32_t i = 0; i < q->n; i++) {
            const double d = q->s * q->size[i];
            const int class = most > least ? (int)((d - least) / (most - least) * CLASSES) : 0;
            if ((class >= CLASSES ? CLASSES - 1 : class) != k) continue;
            int n = section_of(q, i, at, corner, point);
            if (q->q) n = hull_of(point, n);
            if (n < 3) continue;
            if (some) putc('\n', p->data);
            some = 1;
            for (int c = 0; c <= n; c++) write_row(p->data, point[c % n][0], point[c % n][1]);
        }
        if (!some) continue;
        fputs("\n\n", p->data);
        fprintf(p->script,
                ", \\\n     data index %d using 1:2 with filledcurves closed fs solid border lc rgb "
                "'#222222' fc palette "
                "cb %.6g",
                ++blocks, least + (k + 0.5) / CLASSES * (most - least));
    }
    fputs(", \\\n     data index 0 using 1:2 with lines lc rgb '#222222' lw 1.5\nset output\n", p->script);
    free(corner), free(point);
    return 0;
}

/* --- fabric ------------------------------------------------------------------------------------- */

static int write_fabric(struct picture *p, fl_err *err)
{
    double share[FL_ROSE_BINS], most = 0.0;
    (void)err;
    fl_packing_rose(&p->r->overlaps, share);
    for (int k = 0; k < FL_ROSE_BINS; k++) most = fmax(most, share[k]);
    for (int k = 0; k < 2 * FL_ROSE_BINS; k++) {
        const double s = share[k % FL_ROSE_BINS] * FL_ROSE_BINS;
        for (int c = 0; c < 5; c++) {
            const double a = PI *
                             (k + (c == 2   ? 1.0
                                   : c == 3 ? 1.0
                                            : 0.0)) /
                             FL_ROSE_BINS,
                         rho = c == 0 || c > 2 ? 0.0 : s;
            write_row(p->data, rho * cos(a), rho * sin(a));
        }
        putc('\n', p->data);
    }
    fputs("\n\n", p->data);
    for (int k = 0; k <= 120; k++) write_row(p->data, cos(2.0 * PI * k / 120), sin(2.0 * PI * k / 120));
    begin_script(p, "fabric", 600, 620);
    const double wide = 1.15 * fmax(1.0, most * FL_ROSE_BINS);
    fprintf(
        p->script,
        "set size ratio -1\nset xrange [%.4g:%.4g]\nset yrange [%.4g:%.4g]\nset xlabel 'x'\nset ylabel '%s'\n"
        "set title 'directions of contacts over their mean, %lld contacts'\nset key off\n",
        -wide, wide, -wide, wide, p->r->packing.dim == 2 ? "y" : "z",
        (long long)(p->r->certificate.contacts - p->r->certificate.wall_contacts));
    fputs("plot data index 0 using 1:2 with filledcurves closed fs solid border lc rgb '#1c4966' fc rgb "
          "'#6baed6', "
          "data index 1 using 1:2 with lines lc rgb '#d94801' lw 1.5\nset output\n",
          p->script);
    return 0;
}

/* --- files -------------------------------------------------------------------------------------- */

static int draw_picture(struct picture *p, const char *stem, int (*write)(struct picture *, fl_err *),
                        const fl_history_line *by, fl_err *err)
{
    char path[PATH_LEN];
    fl_out data = {0}, script = {0};
    int rc = -1;
    if (strlen(p->o->plot) > PATH_LEN - 40)
        return fl_fail(err, FL_SYSTEM, "the name of a picture in %.100s is too long", p->o->plot);
    snprintf(path, sizeof path, "%s/%s.tsv", p->o->plot, stem);
    if (fl_out_open(&data, path, 0, err)) goto done;
    snprintf(path, sizeof path, "%s/%s.gp", p->o->plot, stem);
    if (fl_out_open(&script, path, 0, err)) goto done;
    p->data = data.f;
    p->script = script.f;
    fl_write_file_header(data.f, stem, 1, NULL, by);
    if (write(p, err) || fl_out_close(&data, err) || fl_out_close(&script, err)) goto done;
    rc = fl_gnuplot_draw(p->o->plot, stem, p->o->format, err);
done:
    fl_out_abort(&data);
    fl_out_abort(&script);
    return rc;
}

int pack_plot(const struct options *o, const struct result *r, const fl_history_line *by, fl_err *err)
{
    struct picture p = {.o = o, .r = r};
    if (draw_picture(&p, "grading", write_grading, by, err) ||
        draw_picture(&p, "section", write_section, by, err))
        return -1;
    if (r->certificate.contacts == r->certificate.wall_contacts) return 0; /* no contacts: no rose */
    return draw_picture(&p, "fabric", write_fabric, by, err);
}
