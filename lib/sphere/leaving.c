/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sphere/leaving.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "contact/disc_list.h"
#include "contact/pair_law.h"
#include "law/normal.h"
#include "sphere/sphere_pair.h"
#include "water/force_table.h"
#include "world/access.h"

void fl_leaving_free(fl_leaving *l)
{
    free(l->body), free(l->touched), free(l->disc), free(l->row);
    *l = (fl_leaving){0};
}

static int append_number(int32_t **list, int32_t *cap, int32_t *n, int32_t k, fl_err *err)
{
    if (fl_grow(list, cap, (int64_t)*n + 1, sizeof **list, err)) return -1;
    (*list)[(*n)++] = k;
    return 0;
}

static int touch(fl_leaving *l, int32_t k, fl_err *err)
{
    return append_number(&l->touched, &l->touched_cap, &l->n_touched, k, err);
}

int fl_leaving_add_body(fl_leaving *l, int32_t k, fl_err *err)
{
    return append_number(&l->body, &l->body_cap, &l->bodies, k, err) || touch(l, k, err) ? -1 : 0;
}

int fl_leaving_add_row(fl_leaving *l, const fl_leaving_row *row, fl_err *err)
{
    if (fl_grow(&l->row, &l->row_cap, (int64_t)l->rows + 1, sizeof *l->row, err)) return -1;
    l->row[l->rows++] = *row;
    return touch(l, row->i, err) || touch(l, row->j, err) ? -1 : 0;
}

int fl_leaving_add_disc(fl_leaving *l, const fl_world *w, int32_t k, fl_err *err)
{
    return append_number(&l->disc, &l->disc_cap, &l->discs, k, err) || touch(l, w->discs.at.i[k], err) ||
                   touch(l, w->discs.at.j[k], err)
               ? -1
               : 0;
}

static int by_number(const void *a, const void *b)
{
    int32_t x, y;
    memcpy(&x, a, sizeof x), memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

static int32_t sort_numbers(int32_t *list, int32_t n)
{
    int32_t kept = 0;
    if (n) qsort(list, (size_t)n, sizeof *list, by_number);
    for (int32_t k = 0; k < n; k++)
        if (!kept || list[k] != list[kept - 1]) list[kept++] = list[k];
    return kept;
}

static int by_place(const void *a, const void *b)
{
    const fl_leaving_row *x = a, *y = b;
    return (x->c > y->c) - (x->c < y->c);
}

void fl_leaving_sort(fl_leaving *l)
{
    int32_t kept = 0;
    l->bodies = sort_numbers(l->body, l->bodies);
    l->n_touched = sort_numbers(l->touched, l->n_touched);
    l->discs = sort_numbers(l->disc, l->discs);
    if (l->rows) qsort(l->row, (size_t)l->rows, sizeof *l->row, by_place);
    for (int32_t k = 0; k < l->rows; k++)
        if (!kept || l->row[k].c != l->row[kept - 1].c) l->row[kept++] = l->row[k];
    l->rows = kept;
}

int fl_leaving_has_books(const fl_world *w)
{
    return !w->sleep.state && !w->breaking.on && !w->bonds.n && !w->relax.kind && !w->zones.set.blocks &&
           !w->push.of && w->crushing.of == FL_CRUSHING_NONE && !w->panel_load.all;
}

static int touches_others(const fl_world *w, int32_t k)
{
    for (int64_t at = w->first_pair_of_body[k]; at < w->first_pair_of_body[k + 1]; at++)
        if (w->pair_touches[w->pairs_of_body[at]]) return 1;
    return 0;
}

static int collect(fl_leaving *l, const fl_world *w, const uint8_t *gone, fl_err *err)
{
    const fl_sphere_contacts *s = &w->spheres;
    const fl_disc_list *d = &w->discs;
    for (int32_t c = 0; c < s->walls; c++)
        if (s->wall[c].touches && gone[s->wall[c].i]) return 0;
    for (int32_t c = 0; c < s->n; c++) {
        fl_leaving_row row = {.c = c, .i = s->i[c], .j = s->j[c], .k = s->contact[c].k};
        if (!s->touches[c] || !(gone[row.i] || gone[row.j])) continue;
        if (s->image) memcpy(row.image, &s->image[3 * (int64_t)c], sizeof row.image);
        if (fl_leaving_add_row(l, &row, err)) return -1;
    }
    for (int32_t k = 0; k < d->n; k++) {
        if (d->has_ended[k] == FL_DISC_ENDED || !(gone[d->at.i[k]] || gone[d->at.j[k]])) continue;
        if (d->has_ended[k] == FL_DISC_JUST_ENDED) return 0; /* its contact is not listed yet */
        if (fl_leaving_add_disc(l, w, k, err)) return -1;
    }
    fl_leaving_sort(l);
    return 1;
}

int fl_leaving_collect(fl_leaving *l, const fl_world *w, fl_err *err)
{
    if (!fl_leaving_has_books(w)) return 0;
    uint8_t *const gone = fl_alloc(w->n, sizeof *gone, err);
    int rc = gone ? 1 : -1;
    for (int32_t k = 0; k < l->bodies && rc == 1; k++) {
        gone[l->body[k]] = 1;
        if (!w->b.is_isotropic[l->body[k]] || touches_others(w, l->body[k])) rc = 0;
    }
    if (rc == 1) rc = collect(l, w, gone, err);
    free(gone);
    return rc;
}

static double energy_of_body(const fl_world *w, int32_t k)
{
    double water[FL_FORCE_LEDGERS] = {0.0}, extension = 0.0;
    const double spring = w->driven_floes.n ? fl_driven_floe_spring(w, k, &extension) : 0.0;
    if (w->sea.n) fl_environment_add_energy(&w->sea, &w->b, k, 1, water);
    return fl_body_kinetic_energy(&w->b, k) - w->b.m[k] * v3_dot(w->gravity, w->b.x[k]) +
           0.5 * spring * extension * extension + water[FL_FORCE_HYDROSTATIC];
}

static double energy_of_row(const fl_world *w, const fl_leaving_row *q)
{
    const fl_vec3 shift = fl_periodic_cell_offset(&w->cell, v3(q->image[0], q->image[1], q->image[2])),
                  d = v3_sub(v3_sub(w->b.x[q->i], w->b.x[q->j]), shift);
    return q->k * fl_normal_phi(w->b.radius[q->i] + w->b.radius[q->j] - v3_norm(d), fl_round_exponent(w));
}

double fl_leaving_energy(const fl_leaving *l, const fl_world *w)
{
    double sum = 0.0;
    for (int32_t k = 0; k < l->bodies; k++) sum += energy_of_body(w, l->body[k]);
    for (int32_t k = 0; k < l->rows; k++) sum += energy_of_row(w, &l->row[k]);
    for (int32_t k = 0; k < l->discs; k++) {
        const fl_disc_memory m = fl_disc_list_memory(&w->discs, l->disc[k]);
        sum += fl_disc_energy(&w->discs.classes[w->discs.at.which[l->disc[k]]], &m,
                              fl_disc_list_separation(w, l->disc[k]));
    }
    return sum;
}

void fl_leaving_end_discs(const fl_leaving *l, fl_world *w)
{
    for (int32_t k = 0; k < l->discs; k++) fl_disc_list_end_leaving(w, l->disc[k]);
}
