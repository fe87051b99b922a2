/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/rainflow_matrix.h"
#include "plot_rainflow.h"

enum {
    CLASSES = 24,
    ALL_RANKS = 200,
    MANY = 20 /* cycles in a class from which the colours are logarithmic */
};

/* The cycles of both views of one signal; the matrix shows the raw one. */
typedef struct {
    fl_rainflow c[2];
    double largest, cycles; /* of all: the largest range, and the number of cycles */
} count;

static int compare_falling(const void *a, const void *b)
{
    const double x = ((const fl_cycle *)a)->range, y = ((const fl_cycle *)b)->range;
    return (x < y) - (x > y);
}

static void write_range_title(const picture *p, int32_t s, double x)
{
    const char *unit = p->r->series->unit[s];
    char text[120];
    snprintf(text, sizeof text, "Range%s%s%.60s%s", unit[0] ? "  [" : "", plot_scale_of_signal(p, s).prefix,
             unit, unit[0] ? "]" : "");
    plot_left_title(p, text, x);
}

static int make_count(count *n, const picture *p, int32_t s, fl_err *err)
{
    *n = (count){0};
    for (int w = 0; w < p->r->view_count; w++) {
        const fl_signal_view *v = find_view(p->r, p->part, s, w);
        double cycles = 0.0;
        if (fl_rainflow_count(&n->c[w], p->o->rule, p->o->residue, v->n, v->x, err)) return -1;
        for (int32_t k = 0; k < n->c[w].cycles; k++) {
            n->largest = fmax(n->largest, n->c[w].cycle[k].range);
            cycles += n->c[w].cycle[k].count;
        }
        n->cycles = fmax(n->cycles, cycles);
    }
    return 0;
}

static void free_count(count *n)
{
    fl_rainflow_free(&n->c[0]);
    fl_rainflow_free(&n->c[1]);
}

/* Left panel: each class is a box whose colour is its number of cycles. */
static int write_matrix_panel(picture *p, int k, int32_t s, const count *n, fl_err *err)
{
    const fl_descriptive_stats *d = &find_view(p->r, p->part, s, 0)->stats;
    const plot_scale c = plot_scale_of_signal(p, s);
    FILE *f = p->script;
    fl_rainflow_matrix m;
    char text[300], title[320];
    double most = 0.5;
    if (fl_rainflow_matrix_make(&m, CLASSES, n->largest, d->min, d->max, n->c[0].cycles, n->c[0].cycle, err))
        return -1;
    for (int32_t i = 0; i < m.cells; i++) most = fmax(most, m.cell[i].cycles);
    plot_set_margins(p, k, 0.1, 0.42);
    plot_signal_label(p, s, text, sizeof text);
    write_range_title(p, s, 0.018);
    fputs("set xlabel ", f);
    snprintf(title, sizeof title, "Mean of the cycle: %s", text);
    plot_quoted(f, title);
    fprintf(f, "\nunset logscale\nset xrange [%.6g:%.6g]\nset yrange [0:%.6g]\n", c.factor * d->min,
            c.factor * d->max, 1.02 * c.factor * n->largest);
    fprintf(f, "set xtics %.6g\nset ytics %.6g\n", plot_tics(c.factor * (d->max - d->min)),
            plot_tics(c.factor * n->largest));
    fprintf(f,
            "set palette maxcolors 32\nset palette defined (0 '#deebf7', 1 '#9ecae1', 2 '#4292c6', 3 "
            "'#084594')\n%sset cbrange [%g:%g]\n",
            most > MANY ? "set logscale cb\n" : "", most > MANY ? 0.5 : 0.0, fmax(1.0, most));
    if (most <= MANY) fprintf(f, "set cbtics %g\n", plot_tics(fmax(1.0, most)));
    else fputs("set cbtics autofreq\n", f);
    fputs("set label 4 'cycles' at graph 1.05, graph 1.09 center\n", f);
    fputs("set colorbox user origin graph 1.03, graph 0 size graph 0.035, graph 1\n", f);
    plot_curve(p);
    fprintf(f,
            "using ($4*%g):($5*%g):($6*%g):($7*%g):($8*%g):($9*%g):10 with boxxyerror fill solid 1.0 "
            "noborder lc palette notitle",
            c.factor, c.factor, c.factor, c.factor, c.factor, c.factor);
    plot_block(p);
    for (int32_t i = 0; i < m.cells; i++) {
        const double x0 = fl_rainflow_matrix_mean(&m, m.cell[i].mean),
                     x1 = fl_rainflow_matrix_mean(&m, m.cell[i].mean + 1);
        const double y0 = fl_rainflow_matrix_range(&m, m.cell[i].range),
                     y1 = fl_rainflow_matrix_range(&m, m.cell[i].range + 1);
        plot_label(p, s, 0);
        plot_columns(p, 7, (double[]){0.5 * (x0 + x1), 0.5 * (y0 + y1), x0, x1, y0, y1, m.cell[i].cycles});
    }
    fputs("\nunset label 4\nunset label 1\n", f); /* the key stands on the right panel */
    fl_rainflow_matrix_free(&m);
    return 0;
}

/* All of the largest, then steps of a hundredth of the rank: the resolution of a picture. */
static int32_t next_rank(int32_t k) { return k < ALL_RANKS ? k + 1 : k + k / (ALL_RANKS / 2); }

/* Right panel: the number of cycles of at least a range. */
static void write_range_panel(picture *p, int k, int32_t s, count *n)
{
    const plot_scale c = plot_scale_of_signal(p, s);
    FILE *f = p->script;
    plot_set_margins(p, k, 0.6, 0.97);
    write_range_title(p, s, 0.535);
    fprintf(f, "set xlabel 'Cycles of this range or more'\nset logscale x\nset xrange [0.5:%g]\n",
            fmax(10.0, n->cycles));
    fputs("set xtics autofreq\nset format x '%g'\n", f);
    for (int w = 0; w < p->r->view_count; w++) {
        fl_rainflow *a = &n->c[w];
        double sum = 0.0;
        if (!a->cycles) continue;
        qsort(a->cycle, (size_t)a->cycles, sizeof *a->cycle, compare_falling);
        plot_curve(p);
        fprintf(f, "using 4:($5*%g) with lines ls %d title '%s'", c.factor, p->r->view_count > 1 ? w + 1 : 3,
                view_name(w));
        plot_block(p);
        for (int32_t i = 0, next = 0; i < a->cycles; i++) {
            const double before = sum;
            sum += a->cycle[i].count;
            if (i < next) continue;
            next = next_rank(i);
            if (i == 0) {
                plot_label(p, s, w);
                plot_columns(p, 2, (double[]){0.5 * sum, a->cycle[i].range});
            } else if (i <= ALL_RANKS) { /* a step */
                plot_label(p, s, w);
                plot_columns(p, 2, (double[]){before, a->cycle[i].range});
            }
            plot_label(p, s, w);
            plot_columns(p, 2, (double[]){sum, a->cycle[i].range});
        }
    }
    plot_end_panel(p);
}

static int fill_rainflow(picture *p, fl_err *err)
{
    int rc = 0, k = 0;
    char heading[80];
    count n;
    p->gap = PLOT_FOOT + 10;
    for (int32_t s = 0; s < p->r->series->signals && rc == 0; s++) {
        if (!find_view(p->r, p->part, s, 0)) continue;
        rc = make_count(&n, p, s, err);
        p->panels += n.c[0].cycles > 0;
        free_count(&n);
    }
    if (rc || !p->panels) return rc;
    fputs("signal\tunit\tview\tmean_or_cycles\trange\tmean_from\tmean_to\trange_from\trange_to\tcycles\n",
          p->data);
    snprintf(heading, sizeof heading, "Load cycles (%s, %s)", fl_rainflow_rule_name(p->o->rule),
             fl_residue_name(p->o->rule == FL_RAINFLOW_ASTM ? FL_RESIDUE_HALF : p->o->residue));
    plot_start(p, heading);
    for (int32_t s = 0; s < p->r->series->signals && rc == 0; s++) {
        if (!find_view(p->r, p->part, s, 0)) continue;
        rc = make_count(&n, p, s, err);
        if (rc == 0 && n.c[0].cycles) {
            rc = write_matrix_panel(p, k, s, &n, err);
            if (rc == 0) write_range_panel(p, k++, s, &n);
        }
        free_count(&n);
    }
    return rc;
}

const struct picture_kind rainflow_picture = {
    .name = "rainflow", .drawable = plot_part_varies, .fill = fill_rainflow};
