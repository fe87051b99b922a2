/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_import.c -- struct-import on five million triangles (or as many as its argument says): a torus as a
 * binary STL, made on the fly.  Time of the whole import, with welding, orientation, the search for crossings
 * and the writing of a g_struct file, beside that of `wc` on the same file in the same run, the peak of
 * memory, and the error of the volume that is told.  Compare ratios, and those within one run only. */
#include <fcntl.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { TRIANGLES = 5000000, PATH = 4096 };
static const double TWO_PI = 6.283185307179586477, FAR = 20.0, NEAR = 5.0;
static const double LIMIT = 4.0; /* GiB */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void corner(int i, int n, int j, int m, float x[3])
{
    const double u = TWO_PI * (i % n) / n, v = TWO_PI * (j % m) / m, r = FAR + NEAR * cos(v);
    x[0] = (float)(r * cos(u));
    x[1] = (float)(r * sin(u));
    x[2] = (float)(NEAR * sin(v));
}

/* n times m quadrilaterals as triangles; returns six times their volume, or nan. */
static double make_torus(const char *path, int n, int m)
{
    FILE *f = fopen(path, "wb");
    const uint32_t count = 2 * (uint32_t)n * (uint32_t)m;
    unsigned char head[84] = "binary STL", record[50] = {0};
    double six = 0.0, carry = 0.0;
    if (!f) return NAN;
    for (int k = 0; k < 4; k++) head[80 + k] = (unsigned char)(count >> 8 * k);
    fwrite(head, sizeof head, 1, f);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < m; j++)
            for (int half = 0; half < 2; half++) {
                float x[3][3];
                double d, next;
                corner(i, n, j, m, x[0]);
                corner(i + 1, n, j + half, m, x[1]);
                corner(i + 1 - half, n, j + 1, m, x[2]);
                memcpy(record + 12, x, sizeof x);
                fwrite(record, sizeof record, 1, f);
                d = (double)x[0][0] *
                        ((double)x[1][1] * (double)x[2][2] - (double)x[1][2] * (double)x[2][1]) +
                    (double)x[0][1] *
                        ((double)x[1][2] * (double)x[2][0] - (double)x[1][0] * (double)x[2][2]) +
                    (double)x[0][2] * ((double)x[1][0] * (double)x[2][1] - (double)x[1][1] * (double)x[2][0]);
                d -= carry; /* Kahan */
                next = six + d;
                carry = (next - six) - d;
                six = next;
            }
    return fclose(f) == 0 ? six : (double)NAN;
}

/* Run a program with stdout and stderr into files; seconds, or nan. */
static double run(char *const argv[], const char *out, const char *said, double *gib)
{
    const double start = now();
    struct rusage use;
    int status;
    const pid_t pid = fork();
    if (pid == 0) {
        const int o = open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int e = open(said, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (o >= 0 && e >= 0 && dup2(o, 1) >= 0 && dup2(e, 2) >= 0) execvp(argv[0], argv);
        _exit(127);
    }
    if (pid < 0 || waitpid(pid, &status, 0) != pid || status != 0) return NAN;
    getrusage(RUSAGE_CHILDREN, &use);
    *gib = (double)use.ru_maxrss / 1048576.0;
    return now() - start;
}

/* Third number of the second row of the table: the volume. */
static double told_volume(const char *said)
{
    char row[1000];
    double volume = NAN;
    FILE *f = fopen(said, "r");
    if (f && fgets(row, sizeof row, f) && fgets(row, sizeof row, f) &&
        sscanf(row, "%*s %*s %*s %lf", &volume) != 1)
        volume = NAN;
    if (f) fclose(f);
    return volume;
}

int main(int argc, char **argv)
{
    const int want = argc > 1 ? atoi(argv[1]) : TRIANGLES;
    const int m = (int)fmax(3.0, sqrt(want / 4.0)), n = (int)fmax(3.0, want / (2.0 * m));
    const char *dir = getenv("TMPDIR"), *slash = strrchr(argv[0], '/');
    char stl[PATH], out[PATH], said[PATH], tool[PATH];
    double six, count, import, error, gib = 0.0, none;
    int ok;
    snprintf(tool, sizeof tool, "%.*s/../../bin/struct-import", slash ? (int)(slash - argv[0]) : 1,
             slash ? argv[0] : ".");
    snprintf(stl, sizeof stl, "%s/floe-bench-%ld.stl", dir ? dir : "/tmp", (long)getpid());
    snprintf(out, sizeof out, "%s/floe-bench-%ld.dat", dir ? dir : "/tmp", (long)getpid());
    snprintf(said, sizeof said, "%s/floe-bench-%ld.said", dir ? dir : "/tmp", (long)getpid());
    six = make_torus(stl, n, m);
    count = run((char *[]){"wc", stl, NULL}, out, said, &none);
    import = run((char *[]){tool, stl, NULL}, out, said, &gib);
    error = fabs(told_volume(said) - six / 6.0) / (six / 6.0);
    printf("triangles\tfile[MB]\twc[s]\timport[s]\timport/wc\tpeak[GiB]\terror of volume\n");
    printf("%d\t%.0f\t%.2f\t%.2f\t%.1f\t%.2f\t%.2g\n", 2 * n * m, 1e-6 * (84.0 + 100.0 * n * m), count,
           import, import / count, gib, error);
    remove(stl);
    remove(out);
    remove(said);
    ok = gib < LIMIT && error < 1e-8; /* the table tells nine digits */
    printf("%d passed, %d failed\n", ok, !ok);
    return !ok;
}
