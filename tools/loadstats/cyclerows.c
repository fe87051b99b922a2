/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/rangemean.h"
#include "cyclerows.h"

/* Exponents of the equivalent range where no S-N line is given: those of welds below and above the knee. */
static const fl_sn USUAL[] = {{.m = 3.0, .a = NAN}, {.m = 5.0, .a = NAN}};

void cyclerows_header(FILE *f, const struct options *o)
{
    if (o->table == TABLE_RAINFLOW)
        fputs("\trule\tresidue\trange_from\trange_to\tmean_from\tmean_to\tcycles\n", f);
    else fputs("\trule\tresidue\tcycles\trange_max\tm\ta\tm2\tknee\tequivalent\tdamage\tlife[s]\n", f);
}

void cyclerows_rule(FILE *f, int rule, int residue)
{
    fprintf(f, "\t%s\t%s", fl_rainflow_rule_name(rule),
            fl_residue_name(rule == FL_RAINFLOW_ASTM ? FL_RESIDUE_HALF : residue));
}

static void damage_row(FILE *f, const cyclerows_load *c, const struct options *o, const fl_sn *sn)
{
    double cycles = 0.0, largest = 0.0, damage = 0.0;
    for (int32_t k = 0; k < c->n; k++) {
        cycles += c->cycle[k].count;
        largest = fmax(largest, c->cycle[k].range);
        damage += fl_sn_damage(sn, o->stress * c->cycle[k].range, c->cycle[k].count);
    }
    fprintf(f, "%s\t%s\t%s\t%s", c->part, c->signal, c->unit[0] ? c->unit : "-", c->view);
    cyclerows_rule(f, c->rule, c->residue);
    put_field(f, cycles);
    put_field(f, c->n ? largest : NAN);
    put_field(f, sn->m);
    put_field(f, sn->a);
    if (sn->knee > 0.0 && isinf(sn->m2)) fputs("\tinf", f);
    else put_field(f, sn->knee > 0.0 ? sn->m2 : NAN);
    put_field(f, sn->knee > 0.0 ? sn->knee : NAN);
    put_field(f, c->n ? fl_rainflow_equivalent(c->n, c->cycle, sn->m) : NAN);
    put_field(f, isnan(sn->a) ? NAN : damage);
    put_field(f, isnan(sn->a) ? NAN : c->span / damage);
    putc('\n', f);
}

void cyclerows_damage(FILE *f, const cyclerows_load *c, const struct options *o)
{
    const int usual = o->sns == 0, n = usual ? (int)(sizeof USUAL / sizeof *USUAL) : (int)o->sns;
    for (int k = 0; k < n; k++) damage_row(f, c, o, usual ? &USUAL[k] : &o->sn[k]);
}

/* Cycles of every view of a signal. */
static int count(fl_rainflow c[2], const struct result *r, const struct options *o, int32_t p, int32_t s,
                 fl_err *err)
{
    for (int w = 0; w < r->each; w++) {
        const fl_view *v = view_of(r, p, s, w);
        if (fl_rainflow_count(&c[w], o->rule, o->residue, v->n, v->x, err)) return -1;
    }
    return 0;
}

static int matrix_rows(FILE *f, const struct result *r, const struct options *o, int32_t p, int32_t s,
                       const fl_rainflow c[2], fl_err *err)
{
    double largest = 0.0, lo = INFINITY, hi = -INFINITY;
    for (int w = 0; w < r->each; w++) {
        const fl_describe *d = &view_of(r, p, s, w)->d;
        lo = fmin(lo, d->min);
        hi = fmax(hi, d->max);
        for (int32_t k = 0; k < c[w].cycles; k++) largest = fmax(largest, c[w].cycle[k].range);
    }
    for (int w = 0; w < r->each; w++) {
        fl_rangemean m;
        if (fl_rangemean_make(&m, o->bins, largest, lo, hi, c[w].cycles, c[w].cycle, err)) return -1;
        for (int32_t k = 0; k < m.cells; k++) {
            put_label(f, r, p, s, w);
            cyclerows_rule(f, o->rule, o->residue);
            put_field(f, fl_rangemean_range(&m, m.cell[k].range));
            put_field(f, fl_rangemean_range(&m, m.cell[k].range + 1));
            put_field(f, fl_rangemean_mean(&m, m.cell[k].mean));
            put_field(f, fl_rangemean_mean(&m, m.cell[k].mean + 1));
            put_field(f, m.cell[k].cycles);
            putc('\n', f);
        }
        fl_rangemean_free(&m);
    }
    return 0;
}

int cyclerows_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                    fl_err *err)
{
    fl_rainflow c[2] = {{0}, {0}};
    int rc = count(c, r, o, part, signal, err);
    if (rc == 0 && o->table == TABLE_RAINFLOW) rc = matrix_rows(f, r, o, part, signal, c, err);
    for (int w = 0; rc == 0 && o->table == TABLE_DAMAGE && w < r->each; w++) {
        const fl_view *v = view_of(r, part, signal, w);
        const cyclerows_load load = {.part = r->s->part[part],
                                     .signal = r->s->signal[signal],
                                     .unit = r->s->unit[signal],
                                     .view = view_name(w),
                                     .rule = o->rule,
                                     .residue = o->residue,
                                     .n = c[w].cycles,
                                     .cycle = c[w].cycle,
                                     .span = v->edge[v->n] - v->edge[0]};
        cyclerows_damage(f, &load, o);
    }
    fl_rainflow_free(&c[0]);
    fl_rainflow_free(&c[1]);
    return rc;
}
