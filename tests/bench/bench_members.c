/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_members.c -- what a contact of a chain costs in a step, and a path in all, beside the error of its
 * limit.  Times are of one thread of this machine now. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/pi.h"
#include "member/member_path.h"

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void fatal(const fl_err *err)
{
    fprintf(stderr, "bench_members: %s\n", err->text);
    exit(1);
}

static void put_name(FILE *f, int ring, int sector, int i)
{
    if (i == ring) i = 0, sector++;
    if (ring == 0) fputs("apex", f);
    else fprintf(f, "r%d.%d", ring, sector % 6 * ring + i);
}

static void put_member(FILE *f, int *n, int pieces, int ra, int sa, int ia, int rb, int sb, int ib)
{
    fprintf(f, "member %d ", ++*n);
    put_name(f, ra, sa, ia);
    putc(' ', f);
    put_name(f, rb, sb, ib);
    fprintf(f, " pipe %d\n", pieces);
}

/* Kiewitt dome of so many rings; span and rise as K6-4. */
static void dome(fl_member_model *m, fl_member_chain *c, int rings, int pieces)
{
    const double radius = (15.0 * 15.0 + 4.0) / 4.0, rim = asin(15.0 / radius);
    char *text = NULL;
    size_t size = 0;
    int n = 0;
    fl_text in = {0};
    fl_err err = {0};
    FILE *f = open_memstream(&text, &size);
    if (!f) exit(1);
    fputs("#members 1\nsection pipe pipe 0.18 0.005 210e6 85e6\nnode apex 0 0 2\n", f);
    for (int k = 1; k <= rings; k++)
        for (int s = 0; s < 6; s++)
            for (int i = 0; i < k; i++) {
                const double phi = rim * k / rings, t = (s + (double)i / k) * PI / 3.0;
                fputs("node ", f);
                put_name(f, k, s, i);
                fprintf(f, " %.15g %.15g %.15g\n", radius * sin(phi) * cos(t), radius * sin(phi) * sin(t),
                        radius * (cos(phi) - 1.0) + 2.0);
            }
    for (int k = 1; k <= rings; k++)
        for (int s = 0; s < 6; s++)
            for (int i = 0; i < k; i++) {
                put_member(f, &n, pieces, k, s, i, k - 1, s, i);
                if (i > 0) put_member(f, &n, pieces, k, s, i, k - 1, s, i - 1);
                put_member(f, &n, pieces, k, s, i, k, s, i + 1);
                if (k == rings) {
                    fputs("fix ", f);
                    put_name(f, k, s, i);
                    fputs(" pinned\n", f);
                }
            }
    fputs("load apex 0 0 -100\n", f);
    fclose(f);
    if (fl_text_open_bytes(&in, "dome", text, (int64_t)size, &err) ||
        fl_member_model_read_text(m, &in, &err) || fl_member_chain_make(c, m, 1.0, &err))
        fatal(&err);
    fl_text_close(&in);
    free(text);
}

/* Steps of adaptive damping under a load, as a path makes them. */
static double time_steps(fl_member_chain *c, int64_t steps)
{
    fl_relaxation damping = fl_relaxation_start(FL_RELAXATION_ADAPTIVE, 0.0);
    const double begun = now();
    for (int64_t k = 0; k < steps; k++) {
        fl_member_chain_forces(c);
        const fl_member_state s = fl_member_chain_state(c, 0.2);
        if (k > 0) fl_relaxation_adapt(&damping, s.work, s.inertia, 1.0);
        const double c2 = fl_relaxation_c2(&damping);
        fl_member_chain_free_step(c, fl_relaxation_c1(&damping), c2, NULL);
        fl_relaxation_peak(&damping, fl_member_chain_loaded_step(c, c2, 0.2));
    }
    return now() - begun;
}

static int time_path(enum fl_relaxation_kind kind, const char *name)
{
    fl_member_model m = {0};
    fl_member_chain c = {0};
    fl_path p = {0};
    fl_err err = {0};
    double limit = NAN;
    dome(&m, &c, 4, 6);
    fl_path_options o = fl_path_defaults();
    o.damping = kind;
    if (fl_path_start(&p, &c, &o, &err)) fatal(&err);
    const double begun = now();
    while (p.point.along < 0.72) {
        if (fl_path_next(&p, &err)) fatal(&err);
        if (p.point.hint & FL_PATH_HINT_MAXIMUM) limit = 100.0 * p.point.limit;
    }
    const double spent = now() - begun;
    printf("%-10s %7lld %9lld %8.1f %10.1f %10.2f %10.1e\n", name, (long long)p.point.number,
           (long long)p.total_steps, spent, 1e9 * spent / (double)p.total_steps / c.contacts, limit,
           limit / 381.43 - 1.0);
    fl_path_free(&p);
    fl_member_chain_free(&c);
    fl_member_model_free(&m);
    return fabs(limit / 381.43 - 1.0) < 1e-2;
}

/* So many steps of the dome K6-4 for instructions.sh; prints the number of contact-steps. */
static int count_steps(int64_t steps)
{
    fl_member_model m = {0};
    fl_member_chain c = {0};
    dome(&m, &c, 4, 6);
    time_steps(&c, steps);
    printf("%lld\n", (long long)steps * c.contacts);
    fl_member_chain_free(&c);
    fl_member_model_free(&m);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc > 2) return count_steps(atoll(argv[2]));
    static const int rings[] = {4, 8, 16, 46}, steps[] = {4000, 1000, 300, 60};
    int ok = 1;
    printf("a step of a dome of beams in 6 pieces, adaptive damping\n%8s %9s %14s\n", "balls", "contacts",
           "ns/contact");
    for (int k = 0; k < 4; k++) {
        fl_member_model m = {0};
        fl_member_chain c = {0};
        dome(&m, &c, rings[k], 6);
        time_steps(&c, 3);
        printf("%8d %9d %14.1f\n", (int)c.balls, (int)c.contacts,
               1e9 * time_steps(&c, steps[k]) / (double)steps[k] / c.contacts);
        fl_member_chain_free(&c);
        fl_member_model_free(&m);
    }
    printf(
        "\nthe dome K6-4 to 0.72 m, 936 contacts, limit beside 381.43 kN\n%-10s %7s %9s %8s %10s %10s %10s\n",
        "damping", "points", "steps", "s", "ns/contact", "limit[kN]", "off");
    ok &= time_path(FL_RELAXATION_KINETIC, "kinetic");
    ok &= time_path(FL_RELAXATION_ADAPTIVE, "adaptive");
    printf("%d passed, %d failed\n", ok, !ok);
    return !ok;
}
