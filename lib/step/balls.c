/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "law/normal.h"
#include "sphere/contact_force.h"
#include "sphere/sphere_pair.h"
#include "step/balls.h"
#include "step/leans.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "step/rolls.h"
#include "step/stiff.h"
#include "world/access.h"

/* Rounding of coordinates a million sizes away may hide so much of a distance. */
#define NEARLY 1e-9

enum { MOST_WAYS = 256 };

/* --- which there are --------------------------------------------------------------------------- */

void fl_balls_free(fl_balls *s)
{
    free(s->i), free(s->j), free(s->law), free(s->image), free(s->hit), free(s->row);
    free(s->roll), free(s->first), free(s->seen), free(s->to), free(s->source), free(s->ended), free(s->way),
        free(s->by), free(s->cross), free(s->into), free(s->slots), free(s->slot);
    free(s->was), free(s->sum), free(s->tally), free(s->stiff), free(s->stiff_slot), free(s->touching),
        free(s->touched);
    free(s->lean), free(s->lean_roll), free(s->lean_first), free(s->load);
    *s = (fl_balls){0};
}

/* Room for n rows; the arrays of bodies stay until the world ends. */
static int rows_alloc(fl_balls *s, const fl_world *w, int64_t n, fl_err *err)
{
    if (n > INT32_MAX) return fl_fail(err, FL_SYSTEM, "out of memory: %lld pairs of spheres", (long long)n);
    s->i = fl_alloc(n, sizeof *s->i, err);
    s->j = fl_alloc(n, sizeof *s->j, err);
    s->law = fl_alloc(n, sizeof *s->law, err);
    s->hit = fl_alloc(n, sizeof *s->hit, err);
    s->row = fl_alloc(n, sizeof *s->row, err);
    if (!s->i || !s->j || !s->law || !s->hit || !s->row) return -1;
    if (w->cell.wraps && !(s->image = fl_alloc(3 * n, sizeof *s->image, err))) return -1;
    if (w->rolls && !(s->roll = fl_alloc(n, sizeof *s->roll, err))) return -1;
    s->n = s->i_cap = s->j_cap = s->law_cap = s->hit_cap = s->row_cap = (int32_t)n;
    s->roll_cap = s->roll ? s->n : 0;
    s->image_cap = s->image ? 3 * s->n : 0;
    return 0;
}

static int bodies_alloc(fl_balls *s, const fl_world *w, fl_err *err)
{
    if (s->bodies) return 0;
    s->chunks = (w->n + FL_BALLS_CHUNK - 1) / FL_BALLS_CHUNK;
    s->first = fl_alloc((int64_t)w->n + 1, sizeof *s->first, err);
    s->into = fl_alloc((int64_t)w->n + 1, sizeof *s->into, err);
    s->seen = fl_alloc(w->n, sizeof *s->seen, err);
    s->source = fl_alloc(s->chunks, sizeof *s->source, err);
    s->ended = fl_alloc(s->chunks, sizeof *s->ended, err);
    s->cross = fl_alloc((int64_t)s->chunks + 1, sizeof *s->cross, err);
    s->tally = fl_alloc(s->chunks, sizeof *s->tally, err);
    s->lean_first = fl_alloc((int64_t)s->chunks + 1, sizeof *s->lean_first, err);
    s->load = fl_alloc((int64_t)s->chunks * w->walls, sizeof *s->load, err);
    s->stiff = fl_alloc(w->n, sizeof *s->stiff, err);
    s->touching = fl_alloc(w->n, sizeof *s->touching, err);
    s->touched = fl_alloc(w->n, sizeof *s->touched, err);
    s->sum = fl_alloc(w->n, sizeof *s->sum, err);
    s->was = fl_alloc(w->n, sizeof *s->was, err);
    if (!s->lean_first || !s->load || !s->first || !s->into || !s->seen || !s->source || !s->ended ||
        !s->cross || !s->tally || !s->stiff || !s->touching || !s->touched || !s->sum || !s->was)
        return -1;
    s->bodies = w->n;
    return 0;
}

/* Images of rows are few: from any of them to where j is. */
static int find_ways(fl_balls *s, const fl_cell *cell, fl_err *err)
{
    int32_t from[MOST_WAYS] = {0}; /* the first row with it; of the 0 none */
    free(s->way), free(s->by);
    s->way = fl_alloc(MOST_WAYS, sizeof *s->way, err);
    s->by = fl_alloc(s->n, sizeof *s->by, err);
    s->ways = 1;
    if (!s->way || !s->by) return -1;
    for (int32_t c = 0, k = 0; s->image && c < s->n; c++) {
        const int32_t *e = &s->image[3 * c];
        if (!(e[0] | e[1] | e[2])) continue;
        if (k == 0 || memcmp(e, &s->image[3 * from[k]], 3 * sizeof *e) != 0)
            for (k = 1; k < s->ways && memcmp(e, &s->image[3 * from[k]], 3 * sizeof *e) != 0;) k++;
        if (k == MOST_WAYS) {
            s->ways = 0;
            return 0;
        }
        if (k == s->ways) {
            from[s->ways++] = c;
            s->way[k].by = fl_cell_way(cell, v3(e[0], e[1], e[2]));
        }
        s->by[c] = (uint8_t)k;
    }
    return 0;
}

/* Offsets and slots. */
static int index_rows(fl_world *w, fl_err *err)
{
    fl_balls *s = &w->balls;
    if (bodies_alloc(s, w, err)) return -1;
    for (int32_t i = 0; i <= s->bodies; i++) s->first[i] = s->into[i] = 0;
    for (int32_t c = 0; c < s->n; c++) s->first[s->i[c] + 1]++;
    for (int32_t i = 0; i < s->bodies; i++) s->first[i + 1] += s->first[i];
    int32_t slots = 0;
    free(s->to);
    if (!(s->to = fl_alloc(s->n, sizeof *s->to, err))) return -1;
    for (int32_t a = 0; a < s->chunks; a++) s->source[a] = INT32_MAX;
    for (int32_t a = 0; a < s->chunks; a++) {
        const int32_t end = fl_balls_last(s, a);
        s->cross[a] = slots;
        if (s->source[a] > a) s->source[a] = a;
        for (int32_t c = s->first[a * FL_BALLS_CHUNK]; c < s->first[end]; c++) {
            s->to[c] = s->j[c] < end ? s->j[c] : ~slots++;
            if (s->to[c] >= 0) continue;
            int32_t *source = &s->source[s->j[c] / FL_BALLS_CHUNK];
            if (a < *source) *source = a;
            s->into[s->j[c] + 1]++;
        }
    }
    s->cross[s->chunks] = slots;
    free(s->slots), free(s->slot), free(s->stiff_slot);
    s->slots = fl_alloc(slots, sizeof *s->slots, err);
    s->slot = fl_alloc(slots, sizeof *s->slot, err);
    s->stiff_slot = fl_alloc(slots, sizeof *s->stiff_slot, err);
    if (!s->slots || !s->slot || !s->stiff_slot || find_ways(s, &w->cell, err)) return -1;
    s->one_law = s->n > 0 ? s->law[0] : -1;
    for (int32_t c = 0; c < s->n; c++)
        if (s->law[c] != s->one_law) s->one_law = -1;
    for (int32_t j = 0; j < s->bodies; j++) s->into[j + 1] += s->into[j];
    slots = 0;
    for (int32_t a = 0; a < s->chunks; a++) { /* fills: into[j] goes from the start of j to that of j + 1 */
        const int32_t end = fl_balls_last(s, a);
        for (int32_t c = s->first[a * FL_BALLS_CHUNK]; c < s->first[end]; c++)
            if (s->j[c] >= end) s->slots[s->into[s->j[c]]++] = slots++;
    }
    for (int32_t j = s->bodies; j > 0; j--) s->into[j] = s->into[j - 1];
    s->into[0] = 0;
    memset(s->touching, 0, (size_t)s->bodies * sizeof *s->touching);
    for (int32_t c = 0; c < s->n; c++) s->touching[s->i[c]] += s->hit[c], s->touching[s->j[c]] += s->hit[c];
    fl_leans_index(s);
    return 0;
}

static int compare(const fl_balls *s, int32_t c, int32_t j, const int32_t image[3])
{
    if (s->j[c] != j) return s->j[c] < j ? -1 : 1;
    for (int axis = 0; s->image && axis < 3; axis++)
        if (s->image[3 * c + axis] != image[axis]) return s->image[3 * c + axis] < image[axis] ? -1 : 1;
    return 0;
}

/* Whether two spheres may touch before the next search: boxes meet across their corners too, where spheres
 * are far apart. */
static int within(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const double R = (w->b.radius[i] + w->b.radius[j] + w->skin) * (1.0 + NEARLY);
    const fl_vec3 way = fl_cell_way(&w->cell, v3(image[0], image[1], image[2]));
    return v3_norm2(v3_sub(v3_sub(w->b.x[i], w->b.x[j]), way)) < R * R;
}

/* The rows of body i from c on, with what those of before remember. */
static void fill(const fl_world *w, fl_balls *s, const uint8_t *listed, int32_t i, int32_t c,
                 fl_ball_image *image)
{
    const fl_balls *old = &w->balls;
    int32_t at = old->bodies ? old->first[i] : 0;
    const int32_t end = old->bodies ? old->first[i + 1] : 0;
    for (int64_t k = w->near.first[i]; k < w->near.first[i + 1]; k++) {
        const int32_t j = w->near.partner[k];
        int32_t cells[3] = {0};
        double n;
        if (!listed[k]) continue;
        image(w, k, i, j, cells);
        while (at < end && compare(old, at, j, cells) < 0) at++;
        s->i[c] = i;
        s->j[c] = j;
        s->law[c] = (int32_t)(fl_pairing_law(w, i, j) - w->law);
        if (s->image) memcpy(&s->image[3 * c], cells, sizeof cells);
        if (at < end && compare(old, at, j, cells) == 0) {
            if (s->roll) s->roll[c] = old->roll[at];
            s->hit[c] = old->hit[at];
            s->row[c] = old->row[at++];
        } else {
            s->row[c].k = fl_pairing_stiffness(w, i, j, &n);
        }
        c++;
    }
}

int fl_balls_list(fl_world *w, fl_ball_image *image, int64_t *others, fl_err *err)
{
    fl_balls fresh = {0}, *s = &w->balls;
    int64_t near = 0, lean = 0;
    int32_t *at = fl_alloc((int64_t)w->n + 1, sizeof *at, err);
    uint8_t *listed = fl_alloc(w->near.first[w->n], sizeof *listed, err);
    if (!at || !listed) goto fail;
#pragma omp parallel for schedule(static) reduction(+ : near, lean)
    for (int32_t i = 0; i < w->n; i++) {
        for (int64_t k = w->near.first[i]; k < w->near.first[i + 1]; k++) {
            const int32_t j = w->near.partner[k];
            int32_t cells[3] = {0};
            lean += fl_sphere_pair_kind(w, i, j) == FL_SPHERE_WALL;
            if (!fl_sphere_pair_kind(w, i, j) == FL_SPHERE_SPHERE) continue;
            image(w, k, i, j, cells);
            listed[k] = (uint8_t)within(w, i, j, cells);
            at[i + 1] += listed[k];
            near++;
        }
    }
    *others = w->near.first[w->n] - near - lean;
    int64_t n = 0;
    for (int32_t i = 0; i < w->n; i++) n += at[i + 1], at[i + 1] = (int32_t)n;
    if (n + lean == 0 && !s->bodies) {
        free(at), free(listed);
        return 0;
    }
    if (rows_alloc(&fresh, w, n, err) || fl_leans_list(w, lean, err)) goto fail;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < w->n; i++)
        if (at[i + 1] > at[i]) fill(w, &fresh, listed, i, at[i], image);
    free(at), free(listed);
    free(s->i), free(s->j), free(s->law), free(s->image), free(s->hit), free(s->row), free(s->roll);
    s->roll = fresh.roll, s->roll_cap = fresh.roll_cap;
    s->i = fresh.i, s->j = fresh.j, s->law = fresh.law, s->image = fresh.image;
    s->hit = fresh.hit, s->row = fresh.row, s->n = fresh.n;
    s->i_cap = fresh.i_cap, s->j_cap = fresh.j_cap, s->law_cap = fresh.law_cap;
    s->image_cap = fresh.image_cap, s->hit_cap = fresh.hit_cap, s->row_cap = fresh.row_cap;
    if (index_rows(w, err)) return -1;
    fl_balls_show(w, 0, w->n, 0.5 * w->dt);
    return 0;
fail:
    fl_balls_free(&fresh);
    free(at), free(listed);
    return -1;
}

int fl_balls_push(fl_world *w, int32_t i, int32_t j, const int32_t image[3], int hit, const fl_ball_row *row,
                  const fl_roll *roll, fl_err *err)
{
    fl_balls *s = &w->balls;
    const int64_t n = (int64_t)s->n + 1;
    if (j >= w->n) return fl_leans_push(w, i, j, hit, row, roll, err);
    if (fl_grow(&s->i, &s->i_cap, n, sizeof *s->i, err) || fl_grow(&s->j, &s->j_cap, n, sizeof *s->j, err) ||
        fl_grow(&s->law, &s->law_cap, n, sizeof *s->law, err) ||
        fl_grow(&s->hit, &s->hit_cap, n, sizeof *s->hit, err) ||
        fl_grow(&s->row, &s->row_cap, n, sizeof *s->row, err) ||
        (w->rolls && fl_grow(&s->roll, &s->roll_cap, n, sizeof *s->roll, err)) ||
        (w->cell.wraps && fl_grow(&s->image, &s->image_cap, 3 * n, sizeof *s->image, err)))
        return -1;
    s->i[s->n] = i;
    s->j[s->n] = j;
    s->law[s->n] = (int32_t)(fl_pairing_law(w, i, j) - w->law);
    s->hit[s->n] = (uint8_t)hit;
    s->row[s->n] = *row;
    if (s->roll) s->roll[s->n] = *roll;
    if (s->image) memcpy(&s->image[3 * s->n], image, 3 * sizeof *image);
    s->n++;
    return 0;
}

int fl_balls_drop(fl_world *w, fl_err *err)
{
    fl_balls *s = &w->balls;
    int32_t kept = 0;
    for (int32_t c = 0; c < s->n; c++) {
        if (fl_world_away(w, s->i[c]) || fl_world_away(w, s->j[c])) continue;
        s->i[kept] = s->i[c];
        s->j[kept] = s->j[c];
        s->law[kept] = s->law[c];
        s->hit[kept] = s->hit[c];
        s->row[kept] = s->row[c];
        if (s->roll) s->roll[kept] = s->roll[c];
        if (s->image) memmove(&s->image[3 * kept], &s->image[3 * c], 3 * sizeof *s->image);
        kept++;
    }
    if (!fl_leans_drop(w) && kept == s->n) return 0;
    s->n = kept;
    return fl_balls_index(w, err);
}

int fl_balls_index(fl_world *w, fl_err *err)
{
    if (index_rows(w, err)) return -1;
    for (int32_t a = 0; a < w->balls.chunks; a++) fl_balls_touch(w, a, -1.0, 0);
    fl_balls_collect(w, 0, w->balls.bodies);
    return 0;
}

/* --- their books ------------------------------------------------------------------------------- */

static double overlap_of(const fl_world *w, int32_t c)
{
    const fl_balls *s = &w->balls;
    return w->b.radius[s->i[c]] + w->b.radius[s->j[c]] - v3_norm(fl_balls_between(w, c));
}

void fl_balls_energy(const fl_world *w, double *elastic, double *spring)
{
    const fl_balls *s = &w->balls;
#pragma omp parallel for schedule(static)
    for (int32_t a = 0; a < s->chunks; a++) {
        double all = 0.0, springs = 0.0;
        for (int32_t c = s->first[a * FL_BALLS_CHUNK]; c < s->first[fl_balls_last(s, a)]; c++) {
            if (!s->hit[c]) continue;
            const double held = fl_ball_spring(&s->row[c], s->roll ? &s->roll[c] : NULL);
            all += s->row[c].k * fl_normal_phi(overlap_of(w, c), 1.5) + held;
            springs += held;
        }
        fl_leans_energy(w, a, &all, &springs);
        s->tally[a].elastic = all;
        s->tally[a].spring = springs;
    }
    for (int32_t a = 0; a < s->chunks; a++) {
        *elastic += s->tally[a].elastic;
        *spring += s->tally[a].spring;
    }
}

fl_ball_count fl_balls_count(const fl_world *w)
{
    const fl_balls *s = &w->balls;
    fl_ball_count all = {.i = -1, .j = -1};
    int32_t row = -1;
    for (int32_t a = 0; a < s->chunks; a++) {
        const fl_ball_tally *t = &s->tally[a];
        all.force += t->force;
        all.touching += t->touching;
        if (t->worst > all.worst) {
            all.worst = t->worst;
            row = t->worst_row;
        }
    }
    if (all.worst > 0.0) {
        all.i = row < 0 ? s->lean[~row].i : s->i[row];
        all.j = row < 0 ? s->lean[~row].j : s->j[row];
    }
    return all;
}

double fl_balls_stiff(const fl_world *w, int32_t k)
{
    const fl_balls *s = &w->balls;
    double sum = s->stiff[k];
    for (int32_t c = s->into[k]; c < s->into[k + 1]; c++) sum += s->stiff_slot[s->slots[c]];
    return sum;
}

double fl_balls_bytes(const fl_world *w)
{
    const fl_balls *s = &w->balls;
    const double row = 4 * sizeof(int32_t) + sizeof *s->hit + sizeof *s->by + sizeof *s->row,
                 image = s->image ? 3 * sizeof(int32_t) : 0, roll = s->roll ? sizeof *s->roll : 0,
                 slot = sizeof *s->slot + sizeof *s->slots + sizeof *s->stiff_slot,
                 body = 2 * sizeof *s->sum + sizeof *s->seen + 4 * sizeof(int32_t) + sizeof *s->stiff;
    if (!s->bodies) return 0.0;
    return s->n * (row + image + roll) + s->leans * ((double)sizeof *s->lean + roll) +
           s->cross[s->chunks] * slot + s->bodies * body;
}

/* --- as pairs like all others ------------------------------------------------------------------ */

/* Row c with its forces of the last touch. */
static void pair_of(const fl_world *w, int32_t c, fl_pair *p)
{
    const fl_balls *s = &w->balls;
    const fl_bodies *b = &w->b;
    const fl_ball_row *r = &s->row[c];
    const int32_t i = s->i[c], j = s->j[c];
    const fl_vec3 d = fl_balls_between(w, c);
    const double apart = v3_norm(d), over = b->radius[i] + b->radius[j] - apart,
                 arm = b->radius[j] - 0.5 * over;
    const fl_vec3 n = apart > 0.0 ? v3_scale(1.0 / apart, d) : v3(0, 0, 1);
    const fl_roll *roll = s->roll ? &s->roll[c] : NULL;
    fl_ball_pair(w, i, j, r, roll, s->hit[c], n, over, p);
    if (s->image) memcpy(p->image, &s->image[3 * c], sizeof p->image);
    if (!p->n) return;
    p->sj = p->tj = v3_madd(v3_neg(fl_rolls_moment(roll)), -arm, v3_cross(n, r->rub));
    p->stiff_j = fl_stiff_point(b, j, r->k * fl_normal_slope(over, 1.5), r->stiff, arm,
                                roll ? fl_rolls_stiff(roll) : 0.0);
}

/* Walls come after all spheres. */
int32_t fl_ball_next(const fl_world *w, fl_ball_walk *at)
{
    const fl_balls *s = &w->balls;
    if (at->lean >= s->leans || (at->row < s->n && s->i[at->row] <= s->lean[at->lean].i)) return at->row++;
    return ~at->lean++;
}

/* Whether row c, as fl_ball_next() tells it, comes before pair p. */
static int comes_first(const fl_balls *s, int32_t c, const fl_near *p)
{
    const int32_t i = c < 0 ? s->lean[~c].i : s->i[c], j = c < 0 ? s->lean[~c].j : s->j[c];
    return i != p->i ? i < p->i : j < p->j; /* no pair is of both kinds */
}

const fl_pair *fl_pair_next(fl_pair_walk *at)
{
    const fl_world *w = at->w;
    fl_ball_walk next = at->rows;
    if (next.row + next.lean < fl_balls_rows(w)) {
        const int32_t c = fl_ball_next(w, &next);
        if (at->pair >= w->n_pair || comes_first(&w->balls, c, &w->pair[at->pair])) {
            at->rows = next;
            if (c < 0) fl_leans_pair(w, ~c, &at->made);
            else pair_of(w, c, &at->made);
            return &at->made;
        }
    }
    if (at->pair >= w->n_pair) return NULL;
    const fl_near *q = &w->pair[at->pair++];
    if (!q->full) fl_near_pair(w, q, &at->made);
    return q->full ? q->full : &at->made;
}
