/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_scale.c -- cost of a contact, a body and a search among 1 000, 10 000 and 100 000 floes at 80 %,
 * dry, which eddies have stirred for the same time, until there is a contact for five floes: law patch, one
 * thread.
 *     ns a contact   all contacts once, in the order of a step and after a step, with the
 *                    cache as the bodies have left it; pairs that do not touch sleep then and are skipped
 *     emptied        the same with the cache filled with other data
 *     ns a body      the rest of a step; it includes evaluations of pairs that came near
 *     ns a search    all of a search, per body: boxes, near pairs, their lists
 *     bytes          permanent memory of a floe with its pairs
 *     over           ns a contact over that of the first row
 * Further columns: energy residual over the throughput, largest overlap, hash of the state.  Rows take
 * turns.  Times are processor times and the least of all turns; that of a body is the median of
 * differences.  Fails if a contact costs more than 1.5 times as much in the last row as in the first, if a
 * body does, or if the energy residual exceeds 1e-4. */
#include <stdlib.h>
#include <time.h>
#include "sim/energy_balance.h"
#include "contact/active_pairs.h"
#include "sim/memory_use.h"
#include "sim/neighbour_list.h"
#include "support/stirring_flow.h"
#include "world/access.h"

#define STIRRED 2.0 /* [m/s] */
#define END 0.2     /* [s] */
#define MOST 1.5    /* largest allowed ratio of the last row to the first */
#define OFF 1e-4

enum {
    ROWS = 3,
    FEWEST = 1000, /* floes */
    PARTS = 100,   /* parts of the last row, of FEWEST each */
    TURNS = 6,
    STEPS = 5,
    CACHE = 64 << 20 /* more than there is [B] */
};

typedef struct {
    int32_t n;
    lab l;
    double contact[PARTS], emptied[PARTS], search; /* of one contact, of all bodies [s] */
    double rest[TURNS * STEPS];                    /* of a step without its contacts, for a body [s] */
    int steps, bad;
} field;

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void start_field(field *f, int32_t n)
{
    f->n = n;
    f->search = INFINITY;
    for (int p = 0; p < PARTS; p++) f->contact[p] = f->emptied[p] = INFINITY;
    stirring_flow_start(&f->l, n, STIRRED);
    lab_make(&f->l, 0.0);
    f->bad = lab_run(&f->l, (int64_t)(END / f->l.w.dt));
}

/* The first near pair of floe i or of a later one. */
static int32_t first_of(const fl_world *w, int32_t i)
{
    int32_t c = 0, end = w->n_pair;
    while (c < end) {
        const int32_t middle = c + (end - c) / 2;
        if (w->pair[middle].i < i) c = middle + 1;
        else end = middle;
    }
    return c;
}

static int32_t touching_in_part(const fl_world *w, int32_t part)
{
    int32_t n = 0;
    for (int32_t c = first_of(w, part * FEWEST), end = first_of(w, (part + 1) * FEWEST); c < end; c++)
        n += w->pair_touches[c];
    return n;
}

/* Evaluates all contacts at the present poses; returns the time.  No time step is made, but friction and
 * damping get speeds that a step would not give them, so the state is for timing only.  Each thousand floes
 * has its own least time of one contact: in every row it is the least over equal amounts of work. */
static double time_contacts(field *f, double *least)
{
    fl_world *const w = &f->l.w;
    double all = 0.0;
    for (int32_t p = 0; p < f->n / FEWEST; p++) {
        w->pair_share[0] =
            (fl_work_share){.next = first_of(w, p * FEWEST), .end = first_of(w, (p + 1) * FEWEST)};
        const double begun = processor_time();
        fl_evaluate_active_pairs(w, 0.0, 0);
        const double took = processor_time() - begun;
        least[p] = fmin(least[p], took / touching_in_part(w, p));
        all += took;
    }
    return all;
}

static double mean_contact_time(const field *f, const double *least)
{
    double sum = 0.0;
    for (int32_t p = 0; p < f->n / FEWEST; p++) sum += least[p] * touching_in_part(&f->l.w, p);
    return sum / f->l.w.n_touching;
}

static void empty_cache(void)
{
    static volatile char other[CACHE];
    for (size_t k = 0; k < 2 * (size_t)CACHE; k += 64) other[k % CACHE]++; /* one pass leaves some of it */
}

/* Renewing the lists earlier or later changes no bit. */
static double time_search(field *f)
{
    fl_err err = {0};
    f->l.w.last_search_step = -1;
    const double begun = processor_time();
    f->bad |= fl_neighbour_list_update(&f->l.w, &err) != 0;
    return processor_time() - begun;
}

/* The search comes first: other rows have used the cache. */
static void measure_turn(field *f)
{
    fl_world *const w = &f->l.w;
    f->search = fmin(f->search, time_search(f));
    for (int k = 0; k < STEPS && !f->bad; k++) {
        const int64_t searches = w->searches;
        const double begun = processor_time();
        f->bad |= lab_run(&f->l, 1) != 0;
        const double step = processor_time() - begun, contacts = time_contacts(f, f->contact);
        if (w->searches == searches) f->rest[f->steps++] = (step - contacts) / f->n;
    }
    empty_cache();
    time_contacts(f, f->emptied);
}

int main(void)
{
    static field row[ROWS];
    double contact[ROWS], body[ROWS], bytes[ROWS];
    int good = 0, bad = 0;
    setvbuf(stdout, NULL, _IOLBF, 0);
    for (int32_t k = 0, n = FEWEST; k < ROWS; k++, n *= 10) start_field(&row[k], n);
    for (int k = 0; k < TURNS * ROWS; k++) measure_turn(&row[k % ROWS]);
    printf("%7s %6s %9s %5s %13s %8s %10s %12s %6s %5s %9s %11s\n", "floes", "t[s]", "touching", "near",
           "ns a contact", "emptied", "ns a body", "ns a search", "bytes", "over", "residual", "overlap/2R");
    for (int k = 0; k < ROWS; k++) {
        field *const f = &row[k];
        fl_world *const w = &f->l.w;
        const fl_memory_use b = fl_memory_use_of(w);
        fl_energy_update(w);
        const double residual = fabs(w->ledger.residual) / w->ledger.throughput;
        contact[k] = mean_contact_time(f, f->contact);
        qsort(f->rest, (size_t)f->steps, sizeof *f->rest, by_size);
        body[k] = f->steps ? f->rest[f->steps / 2] : INFINITY;
        bytes[k] = fl_memory_use_sum(&b) / f->n;
        printf("%7d %6.3f %9.3f %5.2f %13.0f %8.0f %10.0f %12.0f %6.0f %5.2f %9.1e %11.2f %016llx\n", f->n,
               fl_world_time(w), (double)w->n_touching / f->n, (double)w->n_pair / f->n, 1e9 * contact[k],
               1e9 * mean_contact_time(f, f->emptied), 1e9 * body[k], 1e9 * f->search / f->n, bytes[k],
               contact[k] / contact[0], residual, w->max_overlap, (unsigned long long)fl_state_hash(w));
        if (!f->bad && residual < OFF) good++;
        else bad++;
    }
    const field *const last = &row[ROWS - 1];
    if (contact[ROWS - 1] <= MOST * contact[0]) good++;
    else bad++;
    if (body[ROWS - 1] <= MOST * body[0] && bytes[ROWS - 1] <= MOST * bytes[0] &&
        last->search / last->n <= MOST * row[0].search / row[0].n)
        good++;
    else bad++;
    for (int k = 0; k < ROWS; k++) lab_free(&row[k].l);
    printf("%d passed, %d failed\n", good, bad);
    return bad > 0;
}
