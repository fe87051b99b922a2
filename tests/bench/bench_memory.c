/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_memory.c -- what a floe takes of memory with its pairs, by kind, while a field of floes at 80 % is
 * stirred until they touch everywhere: dry, and in water.  "allocated" is what the allocator says that all of
 * it takes, so that nothing is left out; what was read is not in it.  Beside it stand the pairs and the
 * contacts of a floe, the largest overlap, and a number that tells the final states apart.
 * A search takes more while it lasts, which is `search+`.  Fails where a floe takes more than 2 048 bytes
 * with its pairs.
 *     bench_memory [FLOES]     2000 if not said */
#include <malloc.h>
#include <stdlib.h>
#include "ice/cells.h"
#include "ice/floes.h"
#include "scene/field_order.h"
#include "step/footprint.h"
#include "support/lab.h"

#define CONCENTRATION 0.8
#define RADIUS 0.05
#define AREA 12.5   /* of the field, for a floe [m2] */
#define EDDY 6.0    /* [m] */
#define STIRRED 1.0 /* [m/s] */
#define END 1.0     /* [s] */
#define PI 3.14159265358979323846
#define MOST 2048.0 /* bytes of a floe with its pairs, at any time: what is wanted */

enum { SMOOTH = 2, LOOKS = 4 };

static void must(int rc, const fl_err *err)
{
    if (rc == 0) return;
    printf("bench_memory: %s\n", err->text);
    exit(1);
}

static double memory(void)
{
    const struct mallinfo2 m = mallinfo2();
    return (double)m.uordblks + (double)m.hblkhd;
}

/* Cores of floes as voronoi-ice makes them: prisms over cells of n sites, smoothed twice. */
static void voronoi(fl_poly *out, int32_t n)
{
    const double half = 0.5 * sqrt(AREA * n);
    const fl_vec2 lo = {-half, -half}, hi = {half, half};
    fl_vec2 *site = malloc((size_t)n * sizeof *site);
    fl_cells c = {0};
    fl_floes a = {0};
    fl_err err = {0};
    if (!site) exit(1);
    fl_cells_sites(n, 1, lo, hi, site);
    must(fl_cells_build(&c, n, site, lo, hi, &err), &err);
    for (int k = 0; k < SMOOTH; k++) {
        fl_cells_centroids(&c, site);
        fl_cells_free(&c);
        must(fl_cells_build(&c, n, site, lo, hi, &err), &err);
    }
    must(fl_floes_make(&a, &c, CONCENTRATION, RADIUS, (fl_vec2){0, 0}, &err), &err);
    for (int32_t i = 0; i < n; i++) {
        const int32_t corners = a.first[i + 1] - a.first[i];
        fl_vec3 *xy = malloc((size_t)corners * sizeof *xy);
        if (!xy) exit(1);
        for (int32_t k = 0; k < corners; k++) {
            const fl_vec2 v = a.core[a.first[i] + k];
            xy[k] = v3(v.x, v.y, 0);
        }
        must(fl_poly_prism(&out[i], corners, xy, -0.4, 0.0, &err), &err);
        free(xy);
    }
    free(site);
    fl_floes_free(&a), fl_cells_free(&c);
}

/* In eddies. */
static void field(lab *l, int32_t n)
{
    fl_poly *core = calloc((size_t)n, sizeof *core);
    if (!core) exit(1);
    voronoi(core, n);
    for (int32_t i = 0; i < n; i++) {
        const double x = PI / EDDY * core[i].v[0].x, y = PI / EDDY * core[i].v[0].y;
        lab_poly(l, &core[i], RADIUS, v3(STIRRED * sin(x) * cos(y), -STIRRED * cos(x) * sin(y), 0),
                 v3(0, 0, 0));
    }
    free(core);
}

static int row(int32_t n, int water)
{
    lab l;
    lab_start(&l);
    lab_set(&l, "contact.softening=0.025");
    lab_set(&l, "contact.friction=0.3");
    lab_set(&l, "contact.restitution=0.1");
    if (water) lab_set(&l, "run.gravity=9.81"), lab_set(&l, "water.current=0.5 0 0");
    field(&l, n);
    fl_err err = {0};
    int32_t *at = malloc((size_t)n * sizeof *at);
    if (!at) exit(1);
    must(fl_field_order(&l.field, at, &err), &err); /* as dem-solve does */
    free(at);
    const double before = memory();
    lab_make(&l, 0.0);
    int bad = 0;
    for (int k = 0; k <= LOOKS && !bad; k++) {
        const int64_t to = (int64_t)(END * k / LOOKS / l.w.dt), touched = l.w.touching_steps;
        const int64_t steps = to - l.w.step;
        bad = lab_run(&l, steps);
        const fl_footprint b = fl_footprint_of(&l.w);
        const double all = memory() - before, sum = fl_footprint_sum(&b);
        printf("%-6s %6d %6.2f %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f %7.0f %10.0f %7.0f %6.2f %8.2f %9.1e "
               "%016llx\n",
               water ? "water" : "dry", n, fl_world_time(&l.w), b.bodies / n, b.shapes / n, b.water / n,
               b.search / n, b.pairs / n, b.lists / n, sum / n, all / n, b.passing / n,
               (double)l.w.n_pair / n,
               steps ? (double)(l.w.touching_steps - touched) / (double)steps / n : 0.0, l.w.worst_overlap,
               (unsigned long long)fl_step_hash(&l.w));
        bad |= sum > MOST * n;
        bad |= !(all > 0.98 * sum && all < 1.25 * sum); /* small blocks at hand were counted before */
    }
    lab_free(&l);
    return bad;
}

int main(int argc, char **argv)
{
    const int32_t n = argc > 1 ? atoi(argv[1]) : 2000;
    int good = 0, bad = 0;
    if (n < 100) return 1;
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf(
        "bytes for a floe: arrays of bodies, cores, water, search, near pairs, matches of their features\n");
    printf("%-6s %6s %6s %7s %7s %7s %7s %7s %7s %7s %10s %7s %6s %8s %9s\n", "", "floes", "t[s]", "bodies",
           "shapes", "water", "search", "pairs", "lists", "all", "allocated", "search+", "near", "touching",
           "overlap/2R");
    for (int water = 0; water < 2; water++) {
        if (row(n, water)) bad++;
        else good++;
    }
    printf("%d passed, %d failed\n", good, bad);
    return bad > 0;
}
