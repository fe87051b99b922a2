/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/array.h"
#include "geom/facet.h"
#include "geom/raster.h"
#include "views.h"

/* [pixels] of the picture; all panels have one scale and are aligned */
enum {
    MAX_WIDTH = 900,
    MAX_HEIGHT = 700,
    LEFT = 78,
    BETWEEN = 96,
    RIGHT = 24,
    TOP = 50,
    BOTTOM = 68,
    FINE = 2
};
enum { FACETS = 180, MAX_NAMES = 14, COLOURS = 8 };
static const double BEND =
    25.0; /* [degrees] edges that bend more are drawn; a polygon of 14 sides or fewer shows its edges */
static const double FLAT = 0.12; /* minimum extent of a flat structure, relative to the largest */
static const double EDGE = 0.05; /* margin relative to each extent */

static const unsigned char COLOUR[COLOURS][3] = {{86, 180, 233},  {230, 159, 0},  {0, 158, 115},
                                                 {204, 121, 167}, {240, 228, 66}, {0, 114, 178},
                                                 {213, 94, 0},    {153, 153, 153}};
static const unsigned char INK[3] = {34, 34, 34};

struct panel {
    fl_view_axes axes;
    const char *title;
    int x, y, w, h; /* [pixels] lower left corner and size */
    double lo[2], hi[2];
};

/* Copy a structure with its cones replaced by triangles. */
static int facet_surface(const fl_surface *s, fl_surface *out, fl_err *err)
{
    for (int32_t i = 0; i < s->n; i++) {
        const fl_part *p = &s->part[i];
        const int32_t k = fl_surface_add(out, p->name, strlen(p->name), err);
        fl_part *q;
        if (k < 0) return -1;
        q = &out->part[k];
        for (int32_t v = 0; v < p->nv; v++)
            if (fl_surface_vertex(q, p->v[v], err)) return -1;
        for (int32_t t = 0; t < p->nt; t++)
            if (fl_surface_triangle(q, p->t[t].v[0], p->t[t].v[1], p->t[t].v[2], err)) return -1;
        for (int32_t c = 0; c < p->nc; c++)
            if (fl_facet_cone(q, &p->cone[c], FACETS, err)) return -1;
    }
    return 0;
}

/* Place the panels: the front beside the side, the top above it.  Returns metres per pixel. */
static double place_panels(struct panel p[3], fl_aabb box, int *width, int *height)
{
    const double lo[3] = {box.lo.x, box.lo.y, box.lo.z}, hi[3] = {box.hi.x, box.hi.y, box.hi.z};
    double from[3], size[3], largest = 0.0, pixel;
    int n[3];
    for (int k = 0; k < 3; k++) largest = fmax(largest, hi[k] - lo[k]);
    for (int k = 0; k < 3; k++) {
        size[k] = fmax((1.0 + 2.0 * EDGE) * (hi[k] - lo[k]), FLAT * largest);
        from[k] = 0.5 * (lo[k] + hi[k] - size[k]);
    }
    pixel = fmax((size[0] + size[1]) / MAX_WIDTH, (size[1] + size[2]) / MAX_HEIGHT);
    for (int k = 0; k < 3; k++) n[k] = (int)ceil(size[k] / pixel);
    p[0] =
        (struct panel){{0, 1, 2, 1}, "top, from above", LEFT, BOTTOM + n[2] + BETWEEN, n[0], n[1], {0}, {0}};
    p[1] = (struct panel){{0, 2, 1, -1}, "side, from -y", LEFT, BOTTOM, n[0], n[2], {0}, {0}};
    p[2] = (struct panel){{1, 2, 0, -1},
                          "front, from -x: as the ice comes",
                          LEFT + n[0] + BETWEEN,
                          BOTTOM,
                          n[1],
                          n[2],
                          {0},
                          {0}};
    for (int k = 0; k < 3; k++) {
        const int u = p[k].axes.right, v = p[k].axes.up;
        p[k].lo[0] = from[u];
        p[k].lo[1] = from[v];
        p[k].hi[0] = from[u] + n[u] * pixel;
        p[k].hi[1] = from[v] + n[v] * pixel;
    }
    *width = LEFT + n[0] + BETWEEN + (n[1] > 260 ? n[1] : 260) + RIGHT;
    *height = BOTTOM + n[2] + BETWEEN + n[1] + TOP;
    return pixel;
}

/* A pixel is the mean colour of FINE x FINE points; rows from the bottom up. */
static void put_pixels(FILE *f, const fl_raster *r)
{
    for (int32_t v = 0; v < r->h; v += FINE)
        for (int32_t u = 0; u < r->w; u += FINE)
            for (int c = 0; c < 3; c++) {
                double sum = 0.0;
                for (int k = 0; k < FINE * FINE; k++) {
                    const int64_t at = (int64_t)(v + k / FINE) * r->w + u + k % FINE;
                    const int32_t part = r->part[at];
                    sum += part == FL_RASTER_NONE ? 255.0
                           : part == FL_RASTER_LINE
                               ? INK[c]
                               : COLOUR[part % COLOURS][c] * (0.45 + 0.55 * (double)r->light[at]);
                }
                putc((int)(sum / (FINE * FINE) + 0.5), f);
            }
}

static int put_panel(FILE *f, const fl_surface *s, const struct panel *p, double pixel, int width, int height,
                     fl_err *err)
{
    static const char *const axis[3] = {"x", "y", "z"};
    const int mirrored = p->axes.toward == 0; /* seen from -x, y increases to the left */
    fl_raster r;
    if (fl_raster_start(&r, p->axes, FINE * p->w, FINE * p->h, p->lo[0], p->lo[1], pixel / FINE, err))
        return -1;
    fl_raster_fill(&r, s);
    if (fl_raster_lines(&r, s, BEND, err)) {
        fl_raster_free(&r);
        return -1;
    }
    fprintf(f, "set lmargin at screen %.6f\nset rmargin at screen %.6f\n", (double)p->x / width,
            (double)(p->x + p->w) / width);
    fprintf(f, "set bmargin at screen %.6f\nset tmargin at screen %.6f\n", (double)p->y / height,
            (double)(p->y + p->h) / height);
    fprintf(f, "set title '%s' offset 0,-0.6\nset xlabel '%s  [m]'\nset ylabel '%s  [m]' offset 0.4,0\n",
            p->title, axis[p->axes.right], axis[p->axes.up]);
    fprintf(f, "set xrange [%.10g:%.10g]\nset yrange [%.10g:%.10g]\n", mirrored ? p->hi[0] : p->lo[0],
            mirrored ? p->lo[0] : p->hi[0], p->lo[1], p->hi[1]);
    fputs("unset arrow\n", f);
    if (p->axes.up == 2 && p->lo[1] < 0.0 && p->hi[1] > 0.0)
        fputs(
            "set arrow from graph 0, first 0 to graph 1, first 0 nohead front dt 2 lw 1.2 lc rgb '#1f6fb5'\n",
            f);
    fprintf(
        f,
        "plot '-' binary array=(%d,%d) dx=%.10g dy=%.10g origin=(%.10g,%.10g) format='%%uchar' with rgbimage "
        "notitle\n",
        p->w, p->h, pixel, pixel, p->lo[0] + 0.5 * pixel, p->lo[1] + 0.5 * pixel);
    put_pixels(f, &r);
    fl_raster_free(&r);
    return 0;
}

/* Write a text between single quotes for gnuplot. */
static void put_quoted(FILE *f, const char *text)
{
    putc('\'', f);
    for (; *text; text++) {
        if (*text == '\'') putc('\'', f);
        putc(*text, f);
    }
    putc('\'', f);
}

/* Draw a square and a name for each part, above the front view. */
static void put_names(FILE *f, const fl_surface *s, const struct panel *p, int width, int height)
{
    const int x = p->x, top = height - TOP;
    fputs("unset label\n", f);
    for (int32_t i = 0; i < s->n && i <= MAX_NAMES; i++) {
        const double v = (top - 10.0 - 20.0 * i) / height;
        const unsigned char *c = COLOUR[i % COLOURS];
        if (i == MAX_NAMES) {
            fprintf(f, "set label 'and %d more' at screen %.6f, screen %.6f\n", s->n - i, (double)x / width,
                    v);
            break;
        }
        fprintf(f,
                "set object %d rectangle center screen %.6f, screen %.6f size screen %.6f, screen %.6f front "
                "fillstyle solid border lc rgb '#222222' fillcolor rgb '#%02x%02x%02x'\n",
                i + 1, (x + 6.0) / width, v, 12.0 / width, 12.0 / height, c[0], c[1], c[2]);
        fputs("set label ", f);
        put_quoted(f, s->part[i].name);
        fprintf(f, " at screen %.6f, screen %.6f front\n", (x + 20.0) / width, v);
    }
}

static int write_script(FILE *f, const fl_surface *s, const char *path, int svg, fl_err *err)
{
    struct panel p[3];
    int width, height;
    const double pixel = place_panels(p, fl_surface_aabb(s), &width, &height);
    fprintf(f, "set terminal %s noenhanced size %d,%d font '%s,%d' background '#ffffff'\n",
            svg ? "svg" : "pngcairo", width, height, svg ? "sans-serif" : "Sans", svg ? 13 : 10);
    fputs("set encoding utf8\nset output ", f);
    put_quoted(f, path);
    fputs("\nset multiplot\nunset key\nset tics out nomirror scale 0.6\nset border lc rgb '#666666'\n"
          "set style line 1 lc rgb '#222222'\n",
          f);
    put_names(f, s, &p[2], width, height);
    for (int k = 0; k < 3; k++) {
        if (put_panel(f, s, &p[k], pixel, width, height, err)) return -1;
        if (k == 0) fputs("unset label\nunset object\n", f);
    }
    fputs("unset multiplot\nset output\n", f);
    return 0;
}

static int ends_in(const char *path, const char *end)
{
    const size_t n = strlen(path), m = strlen(end);
    return n > m && strcmp(path + n - m, end) == 0;
}

/* The file to draw, and its temporary name. */
static int output_names(const char *where, char **path, char **tmp, fl_err *err)
{
    const int file = ends_in(where, ".png") || ends_in(where, ".svg");
    const size_t room = strlen(where) + 60;
    struct stat there;
    if (!file && mkdir(where, 0777) != 0 && (stat(where, &there) != 0 || !S_ISDIR(there.st_mode)))
        return fl_fail(err, FL_SYSTEM, "%s: %s: a folder, or a name in .png or .svg is expected for --plot",
                       where, strerror(errno));
    *path = fl_alloc((int64_t)room, 1, err);
    *tmp = *path ? fl_alloc((int64_t)room, 1, err) : NULL;
    if (!*tmp) return -1;
    snprintf(*path, room, "%s%s", where, file ? "" : "/structure.png");
    snprintf(*tmp, room, "%s.%ld.part", *path, (long)getpid());
    return 0;
}

/* gnuplot reads the script and the pixels in it from a pipe; its messages are discarded. */
static int run_gnuplot(const fl_surface *s, const char *tmp, int svg, fl_err *err)
{
    void (*const before)(int) = signal(SIGPIPE, SIG_IGN);
    FILE *f = popen("exec gnuplot -d >/dev/null 2>&1", "w");
    int rc, status;
    if (!f) return fl_fail(err, FL_SYSTEM, "gnuplot could not be started: %s", strerror(errno));
    rc = write_script(f, s, tmp, svg, err);
    status = pclose(f);
    signal(SIGPIPE, before);
    if (rc) return -1;
    if (status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == 127)
        return fl_fail(err, FL_SYSTEM, "gnuplot was not found: --plot needs it");
    return status == 0 ? 0 : fl_fail(err, FL_SYSTEM, "gnuplot failed on the picture");
}

int draw_views(const fl_surface *s, const char *where, fl_err *err)
{
    fl_surface all = {0};
    char *path = NULL, *tmp = NULL;
    int rc = -1;
    if (output_names(where, &path, &tmp, err) || facet_surface(s, &all, err)) goto done;
    if (run_gnuplot(&all, tmp, ends_in(path, ".svg"), err)) {
        remove(tmp);
        goto done;
    }
    rc = rename(tmp, path) == 0 ? 0 : fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
done:
    fl_surface_free(&all);
    free(path);
    free(tmp);
    return rc;
}
