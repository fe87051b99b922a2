/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_offshore.c -- reading decks of 100 000 members and files of a million panels, which are written here.
 * Columns: what was read, size of the file, processor time of reading alone on one core.  Status 1 if a count
 * is wrong or one takes more than 2 s. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "mesh/read_mesh.h"

enum { MEMBERS = 100000, SIDE = 1000, SECTIONS = 50 };
static const double LIMIT = 2.0; /* s */

static double processor(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A chain of members that turns at every joint: none continues another. */
static void joint(int k, double x[3])
{
    x[0] = 30.0 * cos((double)k);
    x[1] = 30.0 * sin(1.3 * k);
    x[2] = -50.0 + 1e-3 * k;
}

static void put_subdyn(FILE *f)
{
    fprintf(f, "SubDyn\n%d NJoints\nid x y z\n-\n", MEMBERS + 1);
    for (int k = 0; k <= MEMBERS; k++) {
        double x[3];
        joint(k, x);
        fprintf(f, "%d %.4f %.4f %.4f\n", k + 1, x[0], x[1], x[2]);
    }
    fprintf(f, "%d NMembers\nMemberID a b p q\n-\n", MEMBERS);
    for (int k = 1; k <= MEMBERS; k++)
        fprintf(f, "%d %d %d %d %d\n", k, k, k + 1, 1 + k % SECTIONS, 1 + k % SECTIONS);
    fprintf(f, "%d NPropSets\nid YoungE ShearG MatDens XsecD XsecT\n-\n", SECTIONS);
    for (int k = 1; k <= SECTIONS; k++) fprintf(f, "%d 2.1e11 8.1e10 7850 %.3f 0.03\n", k, 0.5 + 0.01 * k);
}

static void put_sesam(FILE *f)
{
    for (int k = 0; k <= MEMBERS; k++) {
        double x[3];
        joint(k, x);
        fprintf(f, "GCOORD  %16.8E%16.8E%16.8E%16.8E\n", k + 1.0, x[0], x[1], x[2]);
    }
    for (int k = 1; k <= MEMBERS; k++)
        fprintf(f,
                "GELMNT1 %16.8E%16.8E%16.8E%16.8E\n        %16.8E%16.8E\n"
                "GELREF1 %16.8E%16.8E%16.8E%16.8E\n        %16.8E%16.8E%16.8E%16.8E\n        %16.8E\n",
                (double)k, (double)k, 15.0, 0.0, (double)k, k + 1.0, (double)k, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                0.0, 1.0 + k % SECTIONS);
    for (int k = 1; k <= SECTIONS; k++)
        fprintf(f, "GPIPE   %16.8E%16.8E%16.8E%16.8E\n", (double)k, 0.0, 0.5 + 0.01 * k, 0.03);
}

static void put_usfos(FILE *f)
{
    for (int k = 0; k <= MEMBERS; k++) {
        double x[3];
        joint(k, x);
        fprintf(f, "NODE %d %.4f %.4f %.4f\n", k + 1, x[0], x[1], x[2]);
    }
    for (int k = 1; k <= MEMBERS; k++) fprintf(f, "BEAM %d %d %d 1 %d\n", k, k, k + 1, 1 + k % SECTIONS);
    for (int k = 1; k <= SECTIONS; k++) fprintf(f, "PIPE %d %.3f 0.03\n", k, 0.5 + 0.01 * k);
}

/* Four letters for a number below 36^4. */
static const char *four(int k, char name[5])
{
    static const char LETTER[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    for (int c = 4; c-- > 0; k /= 36) name[c] = LETTER[k % 36];
    name[4] = '\0';
    return name;
}

static void put_sacs(FILE *f)
{
    char a[5], b[5];
    fprintf(f, "OPTIONS      MN\n");
    for (int k = 0; k < SECTIONS; k++) fprintf(f, "GRUP G%02d         %6.2f %5.3f\n", k, 50.0 + k, 2.0);
    for (int k = 0; k < MEMBERS; k++)
        fprintf(f, "MEMBER %s%s G%02d\n", four(k, a), four(k + 1, b), k % SECTIONS);
    for (int k = 0; k <= MEMBERS; k++) {
        double x[3];
        joint(k, x);
        fprintf(f, "JOINT %s %7.2f%7.2f%7.2f%7.3f%7.3f%7.3f\n", four(k, a), x[0], x[1], x[2], 0.0, 0.0,
                0.1 * (k % 10));
    }
    fprintf(f, "END\n");
}

static void put_gdf(FILE *f)
{
    fprintf(f, "panels\n1 9.80665\n0 0\n%d\n", SIDE * SIDE);
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++)
            fprintf(f, "%.4f %.4f -3.0\n%.4f %.4f -3.0\n%.4f %.4f -3.0\n%.4f %.4f -3.0\n", 0.1 * i, 0.1 * j,
                    0.1 * i, 0.1 * (j + 1), 0.1 * (i + 1), 0.1 * (j + 1), 0.1 * (i + 1), 0.1 * j);
}

static void put_hams(FILE *f)
{
    const int n = SIDE + 1;
    fprintf(f, "# Number of Panels, Nodes\n%d %d 0 0\n#Start Definition of Node\n", SIDE * SIDE, n * n);
    for (int k = 0; k < n * n; k++) fprintf(f, "%d %.4f %.4f -3.0\n", k + 1, 0.1 * (k / n), 0.1 * (k % n));
    fprintf(f, "#End\n#Start\n");
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int a = k / SIDE * n + k % SIDE + 1;
        fprintf(f, "%d 4 %d %d %d %d\n", k + 1, a, a + 1, a + n + 1, a + n);
    }
    fprintf(f, "#End\n");
}

static const struct {
    const char *name;
    void (*put)(FILE *f);
    int cones, triangles;
} CASES[] = {{"SubDyn", put_subdyn, MEMBERS, 0},    {"SESAM", put_sesam, MEMBERS, 0},
             {"USFOS", put_usfos, MEMBERS, 0},      {"SACS", put_sacs, MEMBERS, 0},
             {"WAMIT", put_gdf, 0, 2 * SIDE *SIDE}, {"HAMS", put_hams, 0, 2 * SIDE *SIDE}};

int main(void)
{
    char path[100];
    int bad = 0;
    snprintf(path, sizeof path, "/tmp/floe-%d-offshore", (int)getpid());
    printf("format\tmembers\ttriangles\tMB\ts\n");
    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        static char note[FL_MESH_NOTE];
        fl_surface s = {0};
        fl_err err = {0};
        int32_t cones = 0, triangles = 0;
        FILE *f = fopen(path, "w");
        if (!f) return 4;
        CASES[k].put(f);
        const double size = (double)ftell(f) / 1e6;
        if (fclose(f)) return 4;
        const double start = processor();
        if (fl_mesh_read(&s, path, NULL, note, &err)) fprintf(stderr, "%s\n", err.text);
        const double took = processor() - start;
        for (int32_t i = 0; i < s.n; i++) cones += s.part[i].nc, triangles += s.part[i].nt;
        printf("%s\t%d\t%d\t%.1f\t%.3f\n", CASES[k].name, cones, triangles, size, took);
        bad |= cones != CASES[k].cones || triangles != CASES[k].triangles || took > LIMIT;
        fl_surface_free(&s);
    }
    remove(path);
    return bad;
}
