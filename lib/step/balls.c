/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <assert.h>
#include <stdalign.h>
#include <stddef.h>
#include <string.h>
#include "base/mem.h"
#include "base/wide.h"
#include "law/normal.h"
#include "law/sphere.h"
#include "step/balls.h"
#include "step/leans.h"
#include "step/pairing.h"
#include "step/stiff.h"

/* Rounding of coordinates a million sizes away may hide so much of a distance. */
#define NEARLY 1e-9

enum {
    MOST_WAYS = 256,
    AHEAD = 64,   /* rows whose bodies j are on their way */
    ON_WAY = 24,  /* rows that are so themselves */
    PASSED_ON = 8 /* slots */
};

/* Two spheres. */
static int meet(const fl_world *w, int32_t i, int32_t j)
{
    if (j >= w->n || !w->b.ball[i] || !w->b.ball[j]) return 0;
    const int32_t law = fl_pairing_law(w, i, j)->kind;
    return law == FL_LAW_PATCH || law == FL_LAW_CORE;
}

int fl_balls_are(const fl_world *w, int32_t i, int32_t j) { return meet(w, i, j) || fl_leans_are(w, i, j); }

/* --- which there are --------------------------------------------------------------------------- */

void fl_balls_free(fl_balls *s)
{
    free(s->i), free(s->j), free(s->law), free(s->image), free(s->hit), free(s->row);
    free(s->first), free(s->seen), free(s->to), free(s->source), free(s->ended), free(s->way), free(s->by),
        free(s->cross), free(s->into), free(s->slots), free(s->slot);
    free(s->was), free(s->sum), free(s->tally), free(s->stiff), free(s->stiff_slot);
    free(s->lean), free(s->lean_first), free(s->load);
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
    s->n = s->i_cap = s->j_cap = s->law_cap = s->hit_cap = s->row_cap = (int32_t)n;
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
    s->sum = fl_alloc(w->n, sizeof *s->sum, err);
    s->was = fl_alloc(w->n, sizeof *s->was, err);
    if (!s->lean_first || !s->load || !s->first || !s->into || !s->seen || !s->source || !s->ended ||
        !s->cross || !s->tally || !s->stiff || !s->sum || !s->was)
        return -1;
    s->bodies = w->n;
    return 0;
}

/* Rows of body i, chunk by chunk of them. */
static int32_t last_body(const fl_balls *s, int32_t a)
{
    const int32_t end = (a + 1) * FL_BALLS_CHUNK;
    return end < s->bodies ? end : s->bodies;
}

static fl_vec3 way_of(const fl_cell *cell, const int32_t e[3])
{
    return fl_cell_way(cell, v3(e[0], e[1], e[2]));
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
            s->way[k].by = way_of(cell, e);
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
        const int32_t end = last_body(s, a);
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
        const int32_t end = last_body(s, a);
        for (int32_t c = s->first[a * FL_BALLS_CHUNK]; c < s->first[end]; c++)
            if (s->j[c] >= end) s->slots[s->into[s->j[c]]++] = slots++;
    }
    for (int32_t j = s->bodies; j > 0; j--) s->into[j] = s->into[j - 1];
    s->into[0] = 0;
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
            lean += fl_leans_are(w, i, j);
            if (!meet(w, i, j)) continue;
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
    free(s->i), free(s->j), free(s->law), free(s->image), free(s->hit), free(s->row);
    s->i = fresh.i, s->j = fresh.j, s->law = fresh.law, s->image = fresh.image;
    s->hit = fresh.hit, s->row = fresh.row, s->n = fresh.n;
    s->i_cap = fresh.i_cap, s->j_cap = fresh.j_cap, s->law_cap = fresh.law_cap;
    s->image_cap = fresh.image_cap, s->hit_cap = fresh.hit_cap, s->row_cap = fresh.row_cap;
    if (index_rows(w, err)) return -1;
    fl_balls_show(w, 0, w->n);
    return 0;
fail:
    fl_balls_free(&fresh);
    free(at), free(listed);
    return -1;
}

int fl_balls_push(fl_world *w, int32_t i, int32_t j, const int32_t image[3], int hit, const fl_ball_row *row,
                  fl_err *err)
{
    fl_balls *s = &w->balls;
    const int64_t n = (int64_t)s->n + 1;
    if (j >= w->n) return fl_leans_push(w, i, j, hit, row, err);
    if (fl_grow(&s->i, &s->i_cap, n, sizeof *s->i, err) || fl_grow(&s->j, &s->j_cap, n, sizeof *s->j, err) ||
        fl_grow(&s->law, &s->law_cap, n, sizeof *s->law, err) ||
        fl_grow(&s->hit, &s->hit_cap, n, sizeof *s->hit, err) ||
        fl_grow(&s->row, &s->row_cap, n, sizeof *s->row, err) ||
        (w->cell.wraps && fl_grow(&s->image, &s->image_cap, 3 * n, sizeof *s->image, err)))
        return -1;
    s->i[s->n] = i;
    s->j[s->n] = j;
    s->law[s->n] = (int32_t)(fl_pairing_law(w, i, j) - w->law);
    s->hit[s->n] = (uint8_t)hit;
    s->row[s->n] = *row;
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
        if (s->image) memmove(&s->image[3 * kept], &s->image[3 * c], 3 * sizeof *s->image);
        kept++;
    }
    if (!fl_leans_drop(w) && kept == s->n) return 0;
    s->n = kept;
    return fl_balls_index(w, err);
}

/* --- their forces ------------------------------------------------------------------------------ */

/* Touching rows are worked on when there are so many. */
enum { BLOCK = 32 };
static_assert(BLOCK + FL_LANES <= FL_SPHERES_MOST,
              "what four rows add has room behind what is not a block yet");

typedef struct {
    fl_spheres at;
    double d[FL_SPHERES_MOST][FL_LANES]; /* D and something, as they are found */
    int32_t row[FL_SPHERES_MOST];        /* filled to the end of a register */
    int32_t law[FL_SPHERES_MOST];        /* whose numbers stand there */
    double rest2[FL_SPHERES_MOST];
    int32_t m;
} batch;

/* D of the image that is meant, most often the one in the same cell. */
static inline fl_vec3 seen(const fl_cell *cell, const int32_t *image, int32_t c, fl_vec3 d)
{
    if (!image) return d;
    const int32_t *e = &image[3 * c];
    return e[0] | e[1] | e[2] ? v3_sub(d, way_of(cell, e)) : d;
}

static inline fl_vec3 between(const fl_world *w, int32_t c)
{
    const fl_balls *s = &w->balls;
    return seen(&w->cell, s->image, c, v3_sub(w->b.x[s->i[c]], w->b.x[s->j[c]]));
}

/* Those of the rows from c on that have begun to touch or ended it, bit by bit: one that ends forgets. */
static void turn_over(fl_balls *s, int32_t c, uint32_t turned)
{
    for (; turned; turned >>= 1, c++) {
        if (!(turned & 1)) continue;
        if (s->hit[c]) s->row[c] = (fl_ball_row){.k = s->row[c].k};
        s->hit[c] ^= 1;
    }
}

/* Row c by itself: whether |D|^2 < (r_i + r_j)^2, and D to the end of the batch. */
static int look_one(const fl_world *w, batch *t, int32_t c)
{
    const fl_vec3 d = between(w, c);
    const double R = w->b.radius[w->balls.i[c]] + w->b.radius[w->balls.j[c]];
    t->row[t->m] = c;
    t->d[t->m][0] = d.x, t->d[t->m][1] = d.y, t->d[t->m][2] = d.z;
    return v3_norm2(d) - R * R < 0.0;
}

void fl_balls_show(fl_world *w, int32_t from, int32_t to)
{
    const fl_bodies *b = &w->b;
    fl_ball_seen *const seen = w->balls.seen;
    for (int32_t k = from; k < to; k++)
        seen[k] = (fl_ball_seen){b->x[k], b->radius[k], b->v[k], b->invm[k], b->w[k], b->radius[k]};
}

/* The difference a - b of vectors, and the sum of the numbers behind them. */
FL_WIDE_PART void compare_two(fl_wide *d, const void *a, const void *b)
{
    *d = __builtin_shufflevector(FL_FOUR(a) - FL_FOUR(b), FL_FOUR(a) + FL_FOUR(b), 0, 1, 2, 7);
}

/* What the loop below reads and writes. */
typedef struct {
    fl_world *w;
    const int32_t *i, *j;
    const fl_ball_way *way;
    const uint8_t *by, *hit;
    const fl_ball_seen *seen;
    const fl_ball_row *row;
    int32_t n; /* rows there are */
} seeker;

/* Rows [c, to), four at a time, until the batch is a block or less than four are left: behind the last.
 * Whether a row touches is nothing that could be foreseen, so nothing here branches on it: it is written down
 * behind the last that does, and counts or does not.  That it begins to, or ends, is rare.  What comes is
 * sent for: with 100 000 spheres all that is not is waited for. */
FL_FOUR_VERSIONS static int32_t look(const seeker *restrict s, batch *restrict t, int32_t c, int32_t to)
{
    const int32_t *bi = s->i, *bj = s->j;
    const fl_ball_seen *seen = s->seen;
    const uint8_t *hit = s->hit, *by = s->by;
    const fl_ball_way *way = s->way;
    int32_t m = t->m;
    for (; c + FL_LANES <= to && m < BLOCK; c += FL_LANES) {
        fl_wide v[FL_LANES];
        uint32_t turned = 0;
        const int32_t *far = &bj[c + AHEAD + FL_LANES <= s->n ? c + AHEAD : c];
        fl_fetch(&s->row[c + ON_WAY + FL_LANES <= s->n ? c + ON_WAY : c], FL_LANES * sizeof *s->row);
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            const int32_t i = bi[c + l], j = bj[c + l];
            compare_two(&v[l], &seen[i].x, &seen[j].x);
            v[l] -= FL_FOUR(&way[by[c + l]]);
            fl_fetch(&seen[far[l]], sizeof *seen);
        }
        fl_wide d[] = {v[0], v[1], v[2], v[3]};
        fl_wide_transpose(d);
        const fl_wide gap = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - d[3] * d[3];
        const fl_wide_mask touches = gap < 0.0;
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            const uint32_t one = (uint32_t)touches[l] & 1;
            t->row[m] = c + l;
            FL_FOUR_INTO(t->d[m]) = v[l];
            m += (int32_t)one;
            turned |= (one ^ hit[c + l]) << l;
        }
        if (turned) turn_over(&s->w->balls, c, turned);
    }
    t->m = m;
    return c;
}

/* What the batch needs to be placed again, */
static void load_forces(const fl_world *w, batch *t)
{
    const fl_balls *s = &w->balls;
    fl_spheres *a = &t->at;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->row[m];
        const fl_ball_row *r = &s->row[c];
        for (int axis = 0; axis < 3; axis++) a->d[axis][m] = t->d[m][axis];
        a->ri[m] = w->b.radius[s->i[c]];
        a->rj[m] = w->b.radius[s->j[c]];
        a->k[m] = r->k;
        a->rub[0][m] = r->rub.x;
        a->rub[1][m] = r->rub.y;
        a->rub[2][m] = r->rub.z;
        a->normal[m] = r->normal;
    }
}

/* and to be evaluated. */
typedef struct {
    const int32_t *i, *j;
    const fl_ball_row *row;
    const fl_ball_seen *seen;
} source;

FL_FOUR_VERSIONS static void load(const source *restrict s, batch *restrict t)
{
    static_assert(offsetof(fl_ball_row, stiff) == sizeof(fl_vec3), "a spring is a register of four");
    static_assert(offsetof(fl_ball_row, k) == offsetof(fl_ball_row, touch) + sizeof(double), "one of two");
    const int32_t *bi = s->i, *bj = s->j;
    const fl_ball_row *row = s->row;
    const fl_ball_seen *seen = s->seen;
    const int32_t n = t->m;
    fl_spheres *a = &t->at;
    for (int32_t k = n; k % FL_LANES; k++) t->row[k] = t->row[n - 1];
    for (int32_t m = 0; m < n; m += FL_LANES) {
        fl_wide d[] = {FL_FOUR(t->d[m]), FL_FOUR(t->d[m + 1]), FL_FOUR(t->d[m + 2]), FL_FOUR(t->d[m + 3])};
        fl_wide u[FL_LANES], p[FL_LANES], q[FL_LANES], h[FL_LANES];
        fl_two last[FL_LANES];
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            const int32_t c = t->row[m + l], i = bi[c], j = bj[c];
            const fl_ball_row *r = &row[c];
            compare_two(&u[l], &seen[i].v, &seen[j].v);
            p[l] = FL_FOUR(&seen[i].w);
            q[l] = FL_FOUR(&seen[j].w);
            h[l] = FL_FOUR(&r->slip);
            last[l] = *(const fl_two *)(const void *)&r->touch;
        }
        const fl_wide even = __builtin_shufflevector(last[0], last[2], 0, 1, 2, 3),
                      odd = __builtin_shufflevector(last[1], last[3], 0, 1, 2, 3);
        FL_FOUR_INTO(&a->touch[m]) = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
        FL_FOUR_INTO(&a->k[m]) = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
        fl_wide_transpose(d);
        fl_wide_transpose(u);
        fl_wide_transpose(p);
        fl_wide_transpose(q);
        fl_wide_transpose(h);
        FL_WIDE_UNROLL for (int axis = 0; axis < 3; axis++)
        {
            FL_FOUR_INTO(&a->d[axis][m]) = d[axis];
            FL_FOUR_INTO(&a->u[axis][m]) = u[axis];
            FL_FOUR_INTO(&a->wi[axis][m]) = p[axis];
            FL_FOUR_INTO(&a->wj[axis][m]) = q[axis];
            FL_FOUR_INTO(&a->slip[axis][m]) = h[axis];
        }
        FL_FOUR_INTO(&a->stiff[m]) = h[3];
        FL_FOUR_INTO(&a->invm[m]) = FL_FOUR(&t->rest2[m]) * u[3]; /* for nothing but the stored energy */
        FL_FOUR_INTO(&a->ri[m]) = p[3];
        FL_FOUR_INTO(&a->rj[m]) = q[3];
    }
}

static void load_law(const fl_world *w, batch *t, int32_t m, int32_t l)
{
    const fl_touching *law = &w->law[l];
    t->law[m] = l;
    t->at.friction[m] = law->friction;
    t->at.tangential[m] = law->tangential;
    t->at.chi[m] = law->chi;
    t->rest2[m] = law->rest * law->rest;
}

/* Where there is not one law for all, most often the numbers stand there from the contacts before. */
static void load_laws(const fl_world *w, batch *t)
{
    const int32_t *law = w->balls.law;
    for (int32_t m = 0; m < t->m; m++)
        if (law[t->row[m]] != t->law[m]) load_law(w, t, m, law[t->row[m]]);
}

FL_FOUR_VERSIONS static void save(fl_ball_row *restrict row, const batch *restrict t)
{
    static_assert(offsetof(fl_ball_row, normal) == offsetof(fl_ball_row, rub) + sizeof(fl_vec3),
                  "see ball.h");
    const fl_spheres *a = &t->at;
    const int32_t n = t->m;
    for (int32_t m = 0; m < n; m += FL_LANES) {
        fl_wide h[] = {FL_FOUR(&a->slip[0][m]), FL_FOUR(&a->slip[1][m]), FL_FOUR(&a->slip[2][m]),
                       FL_FOUR(&a->stiff[m])};
        fl_wide f[] = {FL_FOUR(&a->rub[0][m]), FL_FOUR(&a->rub[1][m]), FL_FOUR(&a->rub[2][m]),
                       FL_FOUR(&a->normal[m])};
        fl_wide_transpose(h);
        fl_wide_transpose(f);
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
        {
            if (m + l >= n) break;
            fl_ball_row *r = &row[t->row[m + l]];
            FL_FOUR_INTO(&r->slip) = h[l];
            FL_FOUR_INTO(&r->rub) = f[l];
            r->touch = a->touch[m + l];
        }
    }
}

/* A sum is three registers of four. */
enum { PARTS = 3 };
static_assert(sizeof(fl_ball_sum) == PARTS * sizeof(fl_wide), "a sum is twelve doubles");

/* Without the string instruction that a compiler makes of it, which takes longer than all else here. */
FL_FOUR_VERSIONS static void clear(fl_ball_sum *s, int32_t n)
{
    const fl_wide zero = {0.0, 0.0, 0.0, 0.0};
    for (int32_t k = 0; k < n; k++) {
        volatile fl_wide *sum = (volatile fl_wide *)&s[k];
        sum[0] = sum[1] = sum[2] = zero;
    }
}

/* What four contacts do, each a row: to i and j alike but for the sign, and to either. */
typedef struct {
    fl_wide one[FL_LANES], two[FL_LANES], on_i[FL_LANES], on_j[FL_LANES];
} wrenches;

FL_WIDE_PART void find_wrenches(wrenches *q, const fl_spheres *a, int32_t m)
{
    q->one[0] = FL_FOUR(&a->push[0][m]), q->one[1] = FL_FOUR(&a->push[1][m]);
    q->one[2] = FL_FOUR(&a->push[2][m]), q->one[3] = FL_FOUR(&a->damping[0][m]);
    q->two[0] = FL_FOUR(&a->damping[1][m]), q->two[1] = FL_FOUR(&a->damping[2][m]);
    q->two[2] = FL_FOUR(&a->rub[0][m]), q->two[3] = FL_FOUR(&a->rub[1][m]);
    q->on_i[0] = FL_FOUR(&a->rub[2][m]), q->on_i[1] = FL_FOUR(&a->ti[0][m]);
    q->on_i[2] = FL_FOUR(&a->ti[1][m]), q->on_i[3] = FL_FOUR(&a->ti[2][m]);
    q->on_j[0] = -q->on_i[0], q->on_j[1] = FL_FOUR(&a->tj[0][m]);
    q->on_j[2] = FL_FOUR(&a->tj[1][m]), q->on_j[3] = FL_FOUR(&a->tj[2][m]);
    fl_wide_transpose(q->one);
    fl_wide_transpose(q->two);
    fl_wide_transpose(q->on_i);
    fl_wide_transpose(q->on_j);
}

/* The l-th of them to the sum of i, and to that of j or to a slot.  Which of the two cannot be foreseen, so
 * nothing branches on it. */
FL_WIDE_PART void hand_one(fl_ball_sum *sums, fl_ball_sum *slots, int32_t i, int32_t to, const wrenches *q,
                           int32_t l)
{
    const int32_t beyond = to < 0 ? -1 : 0;
    const uintptr_t which = ((uintptr_t)sums ^ (uintptr_t)slots) & (uintptr_t)(intptr_t)beyond;
    fl_wide *on = (fl_wide *)&sums[i],
            *off = (fl_wide *)&((fl_ball_sum *)((uintptr_t)sums ^ which))[to ^ beyond];
    on[0] += q->one[l], on[1] += q->two[l], on[2] += q->on_i[l];
    off[0] -= q->one[l], off[1] -= q->two[l], off[2] += q->on_j[l];
}

/* The wrenches of the batch. */
FL_FOUR_VERSIONS static void hand_out(const fl_balls *restrict s, const batch *restrict t)
{
    const int32_t *bi = s->i, *bto = s->to, *row = t->row, n = t->m;
    fl_ball_sum *sums = s->sum, *slots = s->slot;
    int32_t m = 0;
    for (; m + FL_LANES <= n; m += FL_LANES) {
        wrenches q;
        find_wrenches(&q, &t->at, m);
        FL_WIDE_UNROLL for (int32_t l = 0; l < FL_LANES; l++)
            hand_one(sums, slots, bi[row[m + l]], bto[row[m + l]], &q, l);
    }
    if (m < n) {
        wrenches q;
        find_wrenches(&q, &t->at, m);
        for (int32_t l = 0; m + l < n; l++) hand_one(sums, slots, bi[row[m + l]], bto[row[m + l]], &q, l);
    }
}

FL_FOUR_VERSIONS static void collect(fl_ball_sum *restrict sums, const fl_ball_sum *restrict slot,
                                     const int32_t *restrict slots, const int32_t *restrict into,
                                     int32_t from, int32_t to)
{
    for (int32_t k = from; k < to; k++) {
        fl_wide *sum = (fl_wide *)&sums[k], a = sum[0], b = sum[1], c = sum[2];
        if (into[k] == into[k + 1]) continue;
        for (int32_t at = into[k]; at < into[k + 1]; at++) {
            fl_fetch(&slot[slots[at + PASSED_ON < into[to] ? at + PASSED_ON : at]], sizeof *slot);
            const fl_wide *in = (const fl_wide *)&slot[slots[at]];
            a += in[0], b += in[1], c += in[2];
        }
        sum[0] = a, sum[1] = b, sum[2] = c;
    }
}

/* Whether one of the first m, or of those that fill the register behind them, is deeper than so much of the
 * sum of the radii. */
FL_WIDE_VERSIONS static int deeper(const fl_spheres *a, int32_t m, double most)
{
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int32_t k = 0; k < m; k++) any |= a->overlap[k] > most * (a->ri[k] + a->rj[k]);
    return any;
}

/* Of the first m, lane by lane. */
FL_FOUR_VERSIONS static double all_sizes(const fl_spheres *a, int32_t m)
{
    fl_wide sum = {0.0, 0.0, 0.0, 0.0};
    double rest = 0.0;
    int32_t k = 0;
    for (; k + FL_LANES <= m; k += FL_LANES) sum += FL_FOUR(&a->size[k]);
    for (; k < m; k++) rest += a->size[k];
    return fl_wide_sum(&sum) + rest;
}

static void count(const batch *t, fl_ball_tally *tally)
{
    const fl_spheres *a = &t->at;
    tally->force += all_sizes(a, t->m);
    tally->touching += t->m;
    if (!deeper(a, t->m, tally->worst)) return;
    for (int32_t m = 0; m < t->m; m++) {
        const double both = a->ri[m] + a->rj[m];
        if (!(a->overlap[m] > tally->worst * both)) continue;
        tally->worst = a->overlap[m] / both;
        tally->worst_row = t->row[m];
    }
}

/* As share_of() of step.c says. */
static void survey_batch(fl_world *w, const batch *t)
{
    fl_balls *s = &w->balls;
    const fl_spheres *a = &t->at;
    for (int32_t m = 0; m < t->m; m++) {
        const int32_t c = t->row[m], i = s->i[c], j = s->j[c], to = s->to[c];
        const double half = 0.5 * a->overlap[m];
        const double ki = fl_stiff_point(&w->b, i, a->slope[m], a->stiff[m], a->ri[m] - half),
                     kj = fl_stiff_point(&w->b, j, a->slope[m], a->stiff[m], a->rj[m] - half),
                     both = sqrt(ki * kj);
        s->stiff[i] += ki + both;
        if (to >= 0) s->stiff[j] += kj + both;
        else s->stiff_slot[~to] = kj + both;
    }
}

/* What is done with the batch, which then is empty; dt < 0: nothing moves and nothing is evaluated, the sums
 * are made again from what the rows hold. */
static void finish(fl_world *w, int32_t a, batch *t, double dt, int survey)
{
    fl_balls *s = &w->balls;
    if (dt < 0.0) {
        load_forces(w, t);
        fl_spheres_place(&t->at, t->m);
    } else {
        const source from = {s->i, s->j, s->row, s->seen};
        if (s->one_law < 0) load_laws(w, t);
        load(&from, t);
        fl_spheres_meet(&t->at, t->m, dt);
        save(s->row, t);
    }
    hand_out(s, t);
    count(t, &s->tally[a]);
    if (survey) survey_batch(w, t);
    t->m = 0;
}

/* And of the first BLOCK of it; the others move up. */
static void finish_block(fl_world *w, int32_t a, batch *t, double dt, int survey)
{
    const int32_t more = t->m - BLOCK;
    if (more < 0) return;
    t->m = BLOCK;
    finish(w, a, t, dt, survey);
    memcpy(t->d, t->d[BLOCK], (size_t)more * sizeof *t->d);
    memcpy(t->row, &t->row[BLOCK], (size_t)more * sizeof *t->row);
    t->m = more;
}

static void take(fl_world *w, int32_t a, double dt, int survey)
{
    fl_balls *s = &w->balls;
    const int32_t begin = a * FL_BALLS_CHUNK, end = last_body(s, a), to = s->first[end], cross = s->cross[a];
    const seeker by = {w, s->i, s->j, s->way, s->by, s->hit, s->seen, s->row, s->n};
    const int wide = dt >= 0.0 && s->ways;
    batch t;
    memset(t.law, -1, sizeof t.law);
    for (int32_t m = 0; s->one_law >= 0 && m < FL_SPHERES_MOST; m++) load_law(w, &t, m, s->one_law);
    t.m = 0;
    s->tally[a] = (fl_ball_tally){.worst_row = -1};
    clear(&s->sum[begin], end - begin);
    clear(&s->slot[cross], s->cross[a + 1] - cross);
    if (survey) {
        memset(&s->stiff[begin], 0, (size_t)(end - begin) * sizeof *s->stiff);
        memset(&s->stiff_slot[cross], 0, (size_t)(s->cross[a + 1] - cross) * sizeof *s->stiff_slot);
    }
    for (int32_t c = s->first[begin]; c < to;) {
        if (wide) c = look(&by, &t, c, to);
        for (; c < to && t.m < BLOCK && (!wide || to - c < FL_LANES); c++) {
            const uint8_t touches = (uint8_t)look_one(w, &t, c);
            if (dt >= 0.0 && touches != s->hit[c]) turn_over(s, c, 1);
            t.m += s->hit[c];
        }
        finish_block(w, a, &t, dt, survey);
    }
    if (t.m) finish(w, a, &t, dt, survey);
    if (s->leans) fl_leans_touch(w, a, dt, survey);
}

void fl_balls_touch(fl_world *w, int32_t a, double dt, int survey) { take(w, a, dt, survey); }

void fl_balls_collect(fl_world *w, int32_t from, int32_t to)
{
    collect(w->balls.sum, w->balls.slot, w->balls.slots, w->balls.into, from, to);
}

int32_t fl_balls_share(const fl_world *w, int t, int parts)
{
    const fl_balls *s = &w->balls;
    const int64_t all = (int64_t)s->n + s->bodies;
    int32_t lo = 0, hi = s->chunks; /* the first with as many rows and bodies before it as belong to others */
    while (lo < hi) {
        const int32_t a = (lo + hi) / 2, k = a * FL_BALLS_CHUNK;
        if (((int64_t)s->first[k] + k) * parts < all * t) lo = a + 1;
        else hi = a;
    }
    return lo;
}

double fl_balls_stiff(const fl_world *w, int32_t k)
{
    const fl_balls *s = &w->balls;
    double sum = s->stiff[k];
    for (int32_t c = s->into[k]; c < s->into[k + 1]; c++) sum += s->stiff_slot[s->slots[c]];
    return sum;
}

int fl_balls_index(fl_world *w, fl_err *err)
{
    if (index_rows(w, err)) return -1;
    for (int32_t a = 0; a < w->balls.chunks; a++) take(w, a, -1.0, 0);
    fl_balls_collect(w, 0, w->balls.bodies);
    return 0;
}

/* --- their books ------------------------------------------------------------------------------- */

static double overlap_of(const fl_world *w, int32_t c)
{
    const fl_balls *s = &w->balls;
    return w->b.radius[s->i[c]] + w->b.radius[s->j[c]] - v3_norm(between(w, c));
}

void fl_balls_energy(const fl_world *w, double *elastic, double *spring)
{
    const fl_balls *s = &w->balls;
#pragma omp parallel for schedule(static)
    for (int32_t a = 0; a < s->chunks; a++) {
        double all = 0.0, springs = 0.0;
        for (int32_t c = s->first[a * FL_BALLS_CHUNK]; c < s->first[last_body(s, a)]; c++) {
            if (!s->hit[c]) continue;
            const double held = fl_ball_spring(&s->row[c]);
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

double fl_balls_bytes(const fl_world *w)
{
    const fl_balls *s = &w->balls;
    const double row = 4 * sizeof(int32_t) + sizeof *s->hit + sizeof *s->by + sizeof *s->row,
                 image = s->image ? 3 * sizeof(int32_t) : 0,
                 slot = sizeof *s->slot + sizeof *s->slots + sizeof *s->stiff_slot,
                 body = 2 * sizeof *s->sum + sizeof *s->seen + 2 * sizeof(int32_t) + sizeof *s->stiff;
    if (!s->bodies) return 0.0;
    return s->n * (row + image) + s->leans * (double)sizeof *s->lean + s->cross[s->chunks] * slot +
           s->bodies * body;
}

/* --- as pairs like all others ------------------------------------------------------------------ */

void fl_ball_pair(const fl_world *w, int32_t i, int32_t j, const fl_ball_row *r, int hit, fl_vec3 n,
                  double over, fl_pair *p)
{
    const fl_bodies *b = &w->b;
    const double arm = b->radius[i] - 0.5 * over;
    fl_pair_start(w, p, i, j);
    p->asleep = b->odometer[i] + b->odometer[j] + (over < 0.0 ? -over : 0.0);
    p->n = hit;
    if (!hit) return;
    p->slip.force = r->slip;
    p->slip.k = r->stiff;
    p->touch = r->touch;
    p->overlap = over;
    p->fd = v3_scale(r->normal - r->k * fl_normal_power(over, 1.5), n);
    p->fs = r->rub;
    p->f = v3_madd(r->rub, r->normal, n);
    p->si = p->ti = v3_scale(-arm, v3_cross(n, r->rub));
    p->spring = fl_ball_spring(r);
    p->energy = r->k * fl_normal_phi(over, 1.5) + p->spring;
    p->stiff_i = fl_stiff_point(b, i, r->k * fl_normal_slope(over, 1.5), r->stiff, arm);
}

/* Row c with its forces of the last touch. */
static void pair_of(const fl_world *w, int32_t c, fl_pair *p)
{
    const fl_balls *s = &w->balls;
    const fl_bodies *b = &w->b;
    const fl_ball_row *r = &s->row[c];
    const int32_t i = s->i[c], j = s->j[c];
    const fl_vec3 d = between(w, c);
    const double apart = v3_norm(d), over = b->radius[i] + b->radius[j] - apart,
                 arm = b->radius[j] - 0.5 * over;
    const fl_vec3 n = apart > 0.0 ? v3_scale(1.0 / apart, d) : v3(0, 0, 1);
    fl_ball_pair(w, i, j, r, s->hit[c], n, over, p);
    if (s->image) memcpy(p->image, &s->image[3 * c], sizeof p->image);
    if (!p->n) return;
    p->sj = p->tj = v3_scale(-arm, v3_cross(n, r->rub));
    p->stiff_j = fl_stiff_point(b, j, r->k * fl_normal_slope(over, 1.5), r->stiff, arm);
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
