/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/rainflow_matrix.h"
#include "table_rainflow.h"

/* Exponents of the equivalent range without an S-N curve: those of welds below and above the knee. */
static const fl_sn_curve DEFAULT_CURVES[] = {{.m = 3.0, .a = NAN}, {.m = 5.0, .a = NAN}};

void rainflow_write_rule(FILE *f, int rule, int residue)
{
    fprintf(f, "\t%s\t%s", fl_rainflow_rule_name(rule),
            fl_residue_name(rule == FL_RAINFLOW_ASTM ? FL_RESIDUE_HALF : residue));
}

static void damage_row(FILE *f, const damage_case *c, const struct options *o, const fl_sn_curve *sn)
{
    double cycles = 0.0, largest = 0.0, damage = 0.0;
    for (int32_t k = 0; k < c->n; k++) {
        cycles += c->cycle[k].count;
        largest = fmax(largest, c->cycle[k].range);
        damage += fl_sn_damage(sn, o->stress * c->cycle[k].range, c->cycle[k].count);
    }
    fprintf(f, "%s\t%s\t%s\t%s", c->part, c->signal, c->unit[0] ? c->unit : "-", c->view);
    rainflow_write_rule(f, c->rule, c->residue);
    write_cell(f, cycles);
    write_cell(f, c->n ? largest : NAN);
    write_cell(f, sn->m);
    write_cell(f, sn->a);
    if (sn->knee > 0.0 && isinf(sn->m2)) fputs("\tinf", f);
    else write_cell(f, sn->knee > 0.0 ? sn->m2 : NAN);
    write_cell(f, sn->knee > 0.0 ? sn->knee : NAN);
    write_cell(f, c->n ? fl_rainflow_equivalent(c->n, c->cycle, sn->m) : NAN);
    write_cell(f, isnan(sn->a) ? NAN : damage);
    write_cell(f, isnan(sn->a) ? NAN : c->span / damage);
    putc('\n', f);
}

void damage_write(FILE *f, const damage_case *c, const struct options *o)
{
    const int use_default = o->sn_curves == 0,
              n = use_default ? (int)(sizeof DEFAULT_CURVES / sizeof *DEFAULT_CURVES) : (int)o->sn_curves;
    for (int k = 0; k < n; k++) damage_row(f, c, o, use_default ? &DEFAULT_CURVES[k] : &o->sn[k]);
}

/* Cycles of every view of a signal. */
static int count_cycles(fl_rainflow c[2], const struct record_views *r, const struct options *o, int32_t p,
                        int32_t s, fl_err *err)
{
    for (int w = 0; w < r->view_count; w++) {
        const fl_signal_view *v = find_view(r, p, s, w);
        if (fl_rainflow_count(&c[w], o->rule, o->residue, v->n, v->x, err)) return -1;
    }
    return 0;
}

static int matrix_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t p, int32_t s,
                       const fl_rainflow c[2], fl_err *err)
{
    double largest = 0.0, lo = INFINITY, hi = -INFINITY;
    for (int w = 0; w < r->view_count; w++) {
        const fl_descriptive_stats *d = &find_view(r, p, s, w)->stats;
        lo = fmin(lo, d->min);
        hi = fmax(hi, d->max);
        for (int32_t k = 0; k < c[w].cycles; k++) largest = fmax(largest, c[w].cycle[k].range);
    }
    for (int w = 0; w < r->view_count; w++) {
        fl_rainflow_matrix m;
        if (fl_rainflow_matrix_make(&m, o->bins, largest, lo, hi, c[w].cycles, c[w].cycle, err)) return -1;
        for (int32_t k = 0; k < m.cells; k++) {
            write_labels(f, r, p, s, w);
            rainflow_write_rule(f, o->rule, o->residue);
            write_cell(f, fl_rainflow_matrix_range(&m, m.cell[k].range));
            write_cell(f, fl_rainflow_matrix_range(&m, m.cell[k].range + 1));
            write_cell(f, fl_rainflow_matrix_mean(&m, m.cell[k].mean));
            write_cell(f, fl_rainflow_matrix_mean(&m, m.cell[k].mean + 1));
            write_cell(f, m.cell[k].cycles);
            putc('\n', f);
        }
        fl_rainflow_matrix_free(&m);
    }
    return 0;
}

int rainflow_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, fl_err *err)
{
    fl_rainflow c[2] = {{0}, {0}};
    int rc = count_cycles(c, r, o, part, signal, err);
    if (rc == 0) rc = matrix_rows(f, r, o, part, signal, c, err);
    fl_rainflow_free(&c[0]);
    fl_rainflow_free(&c[1]);
    return rc;
}

int damage_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                fl_err *err)
{
    fl_rainflow c[2] = {{0}, {0}};
    const int rc = count_cycles(c, r, o, part, signal, err);
    for (int w = 0; rc == 0 && w < r->view_count; w++) {
        const fl_signal_view *v = find_view(r, part, signal, w);
        const damage_case load = {.part = r->series->part[part],
                                  .signal = r->series->signal[signal],
                                  .unit = r->series->unit[signal],
                                  .view = view_name(w),
                                  .rule = o->rule,
                                  .residue = o->residue,
                                  .n = c[w].cycles,
                                  .cycle = c[w].cycle,
                                  .span = v->edge[v->n] - v->edge[0]};
        damage_write(f, &load, o);
    }
    fl_rainflow_free(&c[0]);
    fl_rainflow_free(&c[1]);
    return rc;
}
