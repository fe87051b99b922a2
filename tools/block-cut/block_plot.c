/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block_plot.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/gnuplot.h"
#include "base/number_text.h"
#include "base/stream.h"
#include "geom/polygon.h"

enum { WIDTH = 900, PATH_LEN = 4096, FACES_MAX = 40000, TONES = 4 };

/* Colours of joint sets, and of what is no joint, from dark to light by the direction of the face. */
static const char *const COLOUR[] = {"#4e79a7", "#e15759", "#59a14f", "#b07aa1", "#edc948", "#76b7b2"};
enum { COLOURS = sizeof COLOUR / sizeof *COLOUR };
static const int SURFACE[3] = {205, 196, 180};

struct drawing {
    const struct options *o;
    const struct result *r;
    FILE *data, *script;
    fl_aabb box;
};

static void write_pair(FILE *f, double x, double y)
{
    char text[FL_NUMBER_LEN];
    fputs(fl_number_text(x, text), f);
    putc('\t', f);
    fputs(fl_number_text(y, text), f);
    putc('\n', f);
}

static void start_script(const struct drawing *p, const char *stem, double wide, double high)
{
    FILE *f = p->script;
    const double height = WIDTH * fmin(fmax(high / wide, 0.3), 3.0) * 0.88 + 90.0;
    fprintf(f, "# gnuplot %s.gp draws %s.%s from %s.tsv\n", stem, stem, p->o->format, stem);
    fprintf(f, "if (!exists(\"out\")) out = '%s.%s'\n", stem, p->o->format);
    if (strcmp(p->o->format, "png") == 0)
        fprintf(f, "set terminal pngcairo noenhanced size %d,%.0f font 'Sans,11' background '#ffffff'\n",
                WIDTH, height);
    else
        fprintf(
            f, "set terminal svg noenhanced size %d,%.0f dynamic font 'sans-serif,14' background '#ffffff'\n",
            WIDTH, height);
    fprintf(f,
            "set encoding utf8\nset output out\ndata = '%s.tsv'\nset border lc rgb '#444444' lw 1\n"
            "set tics nomirror out scale 0.6 textcolor rgb '#222222'\nset size ratio -1\n",
            stem);
}

/* --- sections ----------------------------------------------------------------------------------- */

static double axis_of(fl_vec3 x, int k) { return k == 0 ? x.x : k == 1 ? x.y : x.z; }

/* Ends of the cut of face f with the plane where the coordinate `across` is at, from one end to the other. */
static int cut_of_face(const fl_block_shape *s, int32_t f, int across, double at, fl_vec3 end[2])
{
    int n = 0;
    for (int32_t k = s->first[f]; k < s->first[f + 1] && n < 2; k++) {
        const fl_vec3 a = s->v[s->loop[k]], b = s->v[s->loop[k + 1 < s->first[f + 1] ? k + 1 : s->first[f]]];
        const double da = axis_of(a, across) - at, db = axis_of(b, across) - at;
        if ((da > 0.0) != (db > 0.0)) end[n++] = v3_lerp(a, b, da / (da - db));
    }
    return n == 2;
}

/* The section of a block as a closed outline; 0 if the plane misses it. */
static int write_outline(struct drawing *p, const fl_block_shape *s, int across, double at)
{
    enum { ROOM = 256 };
    fl_vec3 v[ROOM], mid = {0};
    double turn[ROOM];
    const int up = across == 2 ? 1 : 2;
    int n = 0;
    for (int32_t f = 0; f < s->nf && n + 1 < ROOM; f++)
        if (cut_of_face(s, f, across, at, v + n)) n += 2;
    if (n < 6) return 0;
    for (int k = 0; k < n; k++) mid = v3_madd(mid, 1.0 / n, v[k]);
    for (int k = 0; k < n; k++) turn[k] = atan2(axis_of(v[k], up) - axis_of(mid, up), v[k].x - mid.x);
    for (int a = 1; a < n; a++) /* by direction: the section is convex */
        for (int b = a; b > 0 && turn[b] < turn[b - 1]; b--) {
            const double t = turn[b];
            const fl_vec3 x = v[b];
            turn[b] = turn[b - 1], v[b] = v[b - 1];
            turn[b - 1] = t, v[b - 1] = x;
        }
    for (int k = 0; k <= n; k++) write_pair(p->data, v[k % n].x, axis_of(v[k % n], up));
    putc('\n', p->data);
    return 1;
}

static int write_section(struct drawing *p, const char *stem, int across)
{
    static const char *const SHADE[TONES] = {"#d9d0c1", "#c7bca8", "#b8c4c9", "#cfd6cf"};
    const fl_vec3 lo = p->box.lo, hi = p->box.hi;
    /* off the middle, where a plane of joints may lie */
    const double at = axis_of(lo, across) + 0.5013 * (axis_of(hi, across) - axis_of(lo, across));
    const int up = across == 2 ? 1 : 2;
    start_script(p, stem, hi.x - lo.x, axis_of(hi, up) - axis_of(lo, up));
    fprintf(p->script, "set xlabel 'x  [m]'\nset ylabel '%c  [m]'\nset title '%c = %.5g m'\nunset key\nplot ",
            "xyz"[up], "xyz"[across], at);
    for (int c = 0, sets = 0; c < TONES; c++) {
        int some = 0;
        if (c) fputs("\n\n", p->data);
        for (int32_t k = 0; k < p->r->model.n; k++)
            if ((int)(fl_block_mix((uint64_t)k + 1) % TONES) == c)
                some |= write_outline(p, &p->r->model.block[k], across, at);
        if (!some) {
            fputs("# none\n", p->data);
            write_pair(p->data, lo.x, axis_of(lo, up));
        }
        fprintf(
            p->script,
            "%sdata index %d using 1:2 with filledcurves closed fs solid border lc rgb '#3b3630' fc rgb '%s'",
            sets++ ? ", \\\n     " : "", c, SHADE[c]);
    }
    fputs("\nset output\n", p->script);
    return 0;
}

/* --- exploded view ------------------------------------------------------------------------------ */

struct shown_face {
    int32_t block, face;
    double depth;
};

static int by_depth(const void *a, const void *b)
{
    const struct shown_face *s = a, *t = b;
    if (s->depth < t->depth || s->depth > t->depth) return s->depth < t->depth ? -1 : 1;
    return s->block != t->block ? (s->block > t->block) - (s->block < t->block)
                                : (s->face > t->face) - (s->face < t->face);
}

/* View from the south-east, above: right, up and towards the eye. */
static const fl_vec3 RIGHT = {0.8660254037844386, 0.5, 0.0},
                     UP = {-0.25, 0.4330127018922193, 0.8660254037844386},
                     EYE = {0.4330127018922193, -0.75, 0.5};

static void face_colour(const struct drawing *p, const fl_block_shape *s, int32_t f, fl_vec3 n, char text[8])
{
    const int32_t set = s->tag[f] < 0 ? -1 : p->r->model.plane[s->tag[f] / 2].set;
    const double light = 0.62 + 0.38 * fmax(0.0, v3_dot(n, v3_unit(v3(0.35, -0.45, 0.85))));
    unsigned c[3] = {(unsigned)SURFACE[0], (unsigned)SURFACE[1], (unsigned)SURFACE[2]};
    if (set >= 0) sscanf(COLOUR[set % COLOURS], "#%2x%2x%2x", &c[0], &c[1], &c[2]);
    for (int k = 0; k < 3; k++) c[k] = (unsigned)(light * c[k]);
    snprintf(text, 8, "#%02x%02x%02x", c[0] & 255u, c[1] & 255u, c[2] & 255u);
}

static void write_faces(struct drawing *p, const struct shown_face *q, int32_t n, const fl_vec3 *shift)
{
    const fl_block_model *m = &p->r->model;
    fl_vec2 lo = {INFINITY, INFINITY}, hi = {-INFINITY, -INFINITY};
    for (int32_t k = 0; k < n; k++)
        for (int32_t v = 0; v < m->block[q[k].block].nv; v++) {
            const fl_vec3 x = v3_add(m->block[q[k].block].v[v], shift[q[k].block]);
            lo = (fl_vec2){fmin(lo.x, v3_dot(RIGHT, x)), fmin(lo.y, v3_dot(UP, x))};
            hi = (fl_vec2){fmax(hi.x, v3_dot(RIGHT, x)), fmax(hi.y, v3_dot(UP, x))};
        }
    start_script(p, "exploded", hi.x - lo.x, hi.y - lo.y);
    const double gap = 0.03 * fmax(hi.x - lo.x, hi.y - lo.y);
    fprintf(
        p->script,
        "unset border\nunset tics\nset margins 1, 1, 1, %d\nset xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n",
        p->r->sets.n ? 3 : 1, lo.x - gap, hi.x + gap, lo.y - gap, hi.y + gap);
    for (int32_t k = 0; k < n; k++) {
        const fl_block_shape *s = &m->block[q[k].block];
        const int32_t f = q[k].face;
        char colour[8];
        double c;
        face_colour(p, s, f, fl_block_face_normal(s, f, &c), colour);
        fprintf(p->script, "set object %d polygon from ", k + 1);
        for (int32_t e = s->first[f]; e <= s->first[f + 1]; e++) {
            const fl_vec3 x = v3_add(s->v[s->loop[e < s->first[f + 1] ? e : s->first[f]]], shift[q[k].block]);
            fprintf(p->script, "%s%.7g,%.7g", e > s->first[f] ? " to " : "", v3_dot(RIGHT, x), v3_dot(UP, x));
        }
        fprintf(p->script, " fc rgb '%s' fs solid border lc rgb '#33302b' lw 0.6\n", colour);
    }
    fputs("set key at screen 0.5, screen 0.01 center bottom horizontal nobox samplen 1.5\nplot ", p->script);
    for (int32_t s = 0; s < p->r->sets.n; s++)
        fprintf(p->script, "NaN with points pt 5 ps 2 lc rgb '%s' title '%s', ", COLOUR[s % COLOURS],
                p->r->sets.set[s].name);
    fputs("NaN with points pt 5 ps 2 lc rgb '#cdc4b4' title 'surface'\nset output\n", p->script);
}

static int write_exploded(struct drawing *p, fl_err *err)
{
    const fl_block_model *m = &p->r->model;
    const fl_vec3 mid = v3_scale(0.5, v3_add(p->box.lo, p->box.hi));
    int64_t faces = 0;
    int32_t n = 0;
    for (int32_t k = 0; k < m->n; k++) faces += m->block[k].nf;
    struct shown_face *q = fl_alloc(faces, sizeof *q, err);
    fl_vec3 *shift = fl_alloc(m->n, sizeof *shift, err);
    if (!q || !shift) {
        free(q), free(shift);
        return -1;
    }
    for (int32_t k = 0; k < m->n; k++) {
        fl_vec3 x;
        double c;
        fl_block_shape_volume(&m->block[k], &x);
        shift[k] = v3_scale(0.33, v3_sub(x, mid));
        for (int32_t f = 0; f < m->block[k].nf; f++) {
            if (!(v3_dot(fl_block_face_normal(&m->block[k], f, &c), EYE) > 1e-9)) continue;
            /* blocks lie apart, so that the depth of their centres orders them */
            q[n++] = (struct shown_face){k, f, v3_dot(EYE, v3_add(x, shift[k]))};
        }
    }
    qsort(q, (size_t)n, sizeof *q, by_depth);
    for (int32_t k = 0; k < n; k++) write_pair(p->data, q[k].block, q[k].face);
    write_faces(p, n > FACES_MAX ? q + (n - FACES_MAX) : q, n > FACES_MAX ? FACES_MAX : n, shift);
    free(q), free(shift);
    return 0;
}

/* --- files -------------------------------------------------------------------------------------- */

static int draw_one(struct drawing *p, const char *stem, int across, const fl_history_line *by, fl_err *err)
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
    p->data = data.f, p->script = script.f;
    fl_write_file_header(data.f, stem, 1, NULL, by);
    if (across >= 0 ? write_section(p, stem, across) : write_exploded(p, err)) goto done;
    if (fl_out_close(&data, err) || fl_out_close(&script, err)) goto done;
    rc = fl_gnuplot_draw(p->o->plot, stem, p->o->format, err);
done:
    fl_out_abort(&data);
    fl_out_abort(&script);
    return rc;
}

int block_plot(const struct options *o, const struct result *r, const fl_history_line *by, fl_err *err)
{
    struct drawing p = {.o = o, .r = r, .box = aabb_empty()};
    for (int32_t k = 0; k < r->model.n; k++) p.box = aabb_join(p.box, r->model.block[k].box);
    return draw_one(&p, "plan", 2, by, err) || draw_one(&p, "section", 1, by, err) ||
                   draw_one(&p, "exploded", -1, by, err)
               ? -1
               : 0;
}
