/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "step/balls.h"
#include "step/footprint.h"
#include "step/sleep.h"

#define ARRAY(p, n) ((p) ? (double)(n) * (double)sizeof *(p) : 0.0)

static double tree(const fl_bvh *t) { return ARRAY(t->node, t->node_cap) + ARRAY(t->order, t->order_cap); }

static double hull(const fl_hull *h) { return h->p ? ARRAY(h->area, 4 * h->p->nf) : 0.0; }

static double scratch(const fl_places *s)
{
    return ARRAY(s->va, s->va_cap) + ARRAY(s->na, s->na_cap) + ARRAY(s->place, s->place_cap) +
           ARRAY(s->cut, s->cut_cap) + ARRAY(s->share, s->share_cap) +
           ARRAY(s->sheet[0].h, s->sheet[0].h_cap) + ARRAY(s->sheet[0].x, s->sheet[0].x_cap) +
           ARRAY(s->sheet[1].h, s->sheet[1].h_cap) + ARRAY(s->sheet[1].x, s->sheet[1].x_cap);
}

static double bodies(const fl_world *w)
{
    const fl_bodies *b = &w->b;
    const int32_t n = w->n, total = b->total;
    return ARRAY(b->x, total) + ARRAY(b->v, total) + ARRAY(b->L, total) + ARRAY(b->q, total) +
           ARRAY(b->w, total) + ARRAY(b->f, total) + ARRAY(b->t, total) + ARRAY(b->m, total) +
           ARRAY(b->invm, total) + ARRAY(b->I, total) + ARRAY(b->invI, total) + ARRAY(b->radius, total) +
           ARRAY(b->bound, total) + ARRAY(b->hold, total) + ARRAY(b->ball, total) + ARRAY(b->held, total) +
           ARRAY(b->odometer, total) + ARRAY(b->added, total) + ARRAY(b->flow, total) +
           ARRAY(b->carried, total) + ARRAY(w->id, n) + ARRAY(w->material, total) + ARRAY(w->face, total) +
           ARRAY(w->q0, n) + ARRAY(w->group, n / FL_BALLS_GROUP + 1) + ARRAY(w->sink.place, total) +
           ARRAY(w->was.place, total) + ARRAY(w->sink.at, w->sink.cap) + ARRAY(w->was.at, w->was.cap) +
           ARRAY(w->gain, w->gain_cap) + ARRAY(w->lead, w->gain_cap);
}

static double water(const fl_sea *s)
{
    double sum = ARRAY(s->hull, s->n) + ARRAY(s->reach, s->n) + ARRAY(s->wetted, s->n) +
                 ARRAY(s->lift, s->n) + ARRAY(s->flow, s->n) + ARRAY(s->drained, s->n) +
                 ARRAY(s->blown, s->n) + ARRAY(s->skin, s->n) + ARRAY(s->tiles, s->n) +
                 ARRAY(s->cells, (double)s->threads * s->cells_each) + ARRAY(s->push, s->n) +
                 ARRAY(s->turn, s->n) + ARRAY(s->waved, s->n) + ARRAY(s->held, s->n);
    for (int32_t i = 0; i < s->n; i++) {
        sum += hull(&s->hull[i]);
        const fl_poly *const outer = fl_sea_outer(s, i);
        if (outer) sum += (double)sizeof *outer + fl_poly_bytes(outer);
        if (s->skin)
            sum += fl_facets_bytes(&s->skin[i].facets, &s->hull[i]) + fl_patches_bytes(&s->skin[i].wet) +
                   fl_patches_bytes(&s->skin[i].dry);
        if (s->waves) sum += ARRAY(s->tiles[i].face, s->tiles[i].n) + ARRAY(s->tiles[i].v, 3 * s->tiles[i].n);
    }
    return sum;
}

static double search(const fl_world *w)
{
    const int32_t total = w->b.total;
    return ARRAY(w->odometer_found, total) + ARRAY(w->inc_first, w->inc_first_cap) +
           ARRAY(w->inc, w->inc_cap) + ARRAY(w->hit, w->hit_cap) + ARRAY(w->watch, w->watch_cap) +
           ARRAY(w->live, w->live_cap) + ARRAY(w->met, total);
}

static double others(const fl_world *w)
{
    const fl_traffic *t = &w->traffic;
    const fl_frozen *z = &w->frozen;
    const fl_press *q = &w->press;
    const int32_t n = w->n, held = w->b.total - n;
    double sum =
        ARRAY(t->away, n) + ARRAY(t->born, n) + ARRAY(t->floe, n) + ARRAY(t->guided, n) + ARRAY(t->hold, n);
    if (t->feed) sum += ARRAY(t->lag, t->feed->n) + ARRAY(t->tile, t->feed->n);
    sum += ARRAY(w->row.in, w->row.n) + ARRAY(w->row.k, w->row.n) + ARRAY(w->row.rest, w->row.n);
    sum += fl_sleep_bytes(w);
    sum += ARRAY(z->bond, z->n) + ARRAY(z->image, 3 * (double)z->n) + ARRAY(z->keep, z->n) +
           ARRAY(z->stiff, 2 * (double)z->n) + ARRAY(z->of, 2 * (double)z->n) + ARRAY(z->most, w->b.total) +
           ARRAY(z->first, w->b.total + 1);
    sum += ARRAY(q->panel, q->panels) + ARRAY(q->box, q->panels) + ARRAY(q->impulse, q->panels) +
           ARRAY(q->now, q->now_cap);
    for (int32_t k = 0; k < q->trees && q->tree; k++) sum += tree(&q->tree[k]);
    sum += ARRAY(w->bed.outer, n) + ARRAY(w->bed.hull, n);
    for (int32_t i = 0; i < n && w->bed.hull; i++)
        sum += fl_poly_bytes(&w->bed.outer[i]) + hull(&w->bed.hull[i]);
    sum += ARRAY(w->structure.piece, w->structure.cap);
    for (int32_t k = 0; k < held; k++) {
        const fl_shell *h = &w->structure.piece[k].shell;
        const fl_poly *p = &w->structure.piece[k].core;
        sum += ARRAY(h->passes.pass, h->passes.cap) + ARRAY(h->passes.begin, p->nf + 1) +
               ARRAY(h->passes.rim, p->nf ? p->first[p->nf] : 0);
        sum += fl_poly_bytes(p) + tree(&h->tree) + tree(&h->edges) + ARRAY(h->corner, h->corners) +
               ARRAY(h->box, p->nf) + ARRAY(h->edge_box, p->ne);
    }
    for (int32_t k = 0; k < w->threads; k++) sum += scratch(&w->scratch[k]);
    return sum;
}

fl_footprint fl_footprint_of(const fl_world *w)
{
    fl_footprint b = {.bodies = bodies(w),
                      .water = w->sea.n ? water(&w->sea) : 0.0,
                      .search = search(w),
                      .balls = fl_balls_bytes(w),
                      .others = others(w),
                      .passing = w->passing};
    b.shapes = ARRAY(w->b.core, w->b.total) + fl_topologies_bytes(&w->alike);
    for (int32_t k = 0; k < w->b.total; k++) b.shapes += fl_poly_bytes(&w->b.core[k]);
    b.pairs = ARRAY(w->pair, w->n_pair) + ARRAY(w->contacts.block, w->contacts.cap) +
              (double)w->contacts.blocks * FL_PAIR_BLOCK * (double)sizeof(fl_pair_slot);
    for (int32_t c = 0; c < w->n_pair; c++) {
        const fl_pair *p = w->pair[c].full;
        if (p && p->matches) b.lists += fl_matches_bytes(p->matches);
        if (p && p->surrogate) b.pairs += sizeof *p->surrogate;
        if (p && p->roll) b.pairs += sizeof *p->roll;
    }
    return b;
}

double fl_footprint_sum(const fl_footprint *b)
{
    return b->bodies + b->shapes + b->water + b->search + b->pairs + b->lists + b->balls + b->others;
}
