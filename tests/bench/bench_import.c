/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_import.c -- struct-import on five million triangles (or the number in its first argument): a torus,
 * generated in each format (or in the one of the second argument).  Columns: processor time of the whole
 * import over all threads, with welding, orientation, the search for crossings and the writing of a
 * g_struct file; the time of `wc` on the same file in the same run, and for text that of strtod() on every
 * number; elapsed time, peak memory, and the error of the printed volume.  wc runs with LC_ALL=C, which
 * does not look for letters.  A second row of each format divides the time of the import into stages of the
 * library: reading (beside wc and strtod), moments (volume, area, centroid and inertia in 106 bits),
 * welding, orientation (edges, patches, measures), the search for crossings, writing.  The same for a cone
 * of 20 000 facets, whose slivers all lie in the bounding boxes of one another.  Compare ratios within one
 * run only. */
#define _DEFAULT_SOURCE /* wait4 */
#include <fcntl.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include "base/tool.h"
#include "geom/moments.h"
#include "geom/mesh_patch.h"
#include "geom/weld.h"
#include "mesh/crossing.h"
#include "mesh/gstruct.h"
#include "mesh/read_mesh.h"

enum { TRIANGLES = 5000000, CONE = 20000, PATH = 4096 };
static const double TWO_PI = 6.283185307179586477, FAR = 20.0, NEAR = 5.0;
static const double LIMIT = 4.0; /* GiB */

static double wall_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* n times m quadrilaterals, each cut in two, on the torus: corner (i, j), periodic in both, is vertex i m +
 * j + 1 at x, rounded to float. */
struct torus {
    int n, m;
};

static void corner(const struct torus *t, int i, int j, float x[3])
{
    const double u = TWO_PI * (i % t->n) / t->n, v = TWO_PI * (j % t->m) / t->m, r = FAR + NEAR * cos(v);
    x[0] = (float)(r * cos(u));
    x[1] = (float)(r * sin(u));
    x[2] = (float)(NEAR * sin(v));
}

static int vertices(const struct torus *t) { return t->n * t->m; }
static int triangles(const struct torus *t) { return 2 * vertices(t); }
static void vertex(const struct torus *t, int k, float x[3]) { corner(t, k / t->m, k % t->m, x); }

/* Grid positions of the corners of triangle k. */
static void corner_positions(const struct torus *t, int k, int at[3][2])
{
    const int i = k / 2 / t->m, j = k / 2 % t->m, half = k % 2;
    const int place[3][2] = {{i, j}, {i + 1, j + half}, {i + 1 - half, j + 1}};
    memcpy(at, place, sizeof place);
}

/* Their vertex numbers from 0. */
static void triangle(const struct torus *t, int k, int v[3])
{
    int at[3][2];
    corner_positions(t, k, at);
    for (int c = 0; c < 3; c++) v[c] = at[c][0] % t->n * t->m + at[c][1] % t->m;
}

/* Six times the volume, by Kahan's sum. */
static double six_volumes(const struct torus *t)
{
    double six = 0.0, carry = 0.0;
    for (int k = 0; k < triangles(t); k++) {
        float x[3][3];
        int at[3][2];
        double d, next;
        corner_positions(t, k, at);
        for (int c = 0; c < 3; c++) corner(t, at[c][0], at[c][1], x[c]);
        d = (double)x[0][0] * ((double)x[1][1] * (double)x[2][2] - (double)x[1][2] * (double)x[2][1]) +
            (double)x[0][1] * ((double)x[1][2] * (double)x[2][0] - (double)x[1][0] * (double)x[2][2]) +
            (double)x[0][2] * ((double)x[1][0] * (double)x[2][1] - (double)x[1][1] * (double)x[2][0]);
        d -= carry;
        next = six + d;
        carry = (next - six) - d;
        six = next;
    }
    return six;
}

/* --- the formats -------------------------------------------------------------------------------------- */

static void little_endian(unsigned char *to, uint64_t x, int bytes)
{
    for (int k = 0; k < bytes; k++) to[k] = (unsigned char)(x >> 8 * k);
}

static void put_stl(FILE *f, const struct torus *t)
{
    unsigned char head[84] = "binary STL", record[50] = {0};
    little_endian(head + 80, (uint64_t)triangles(t), 4);
    fwrite(head, sizeof head, 1, f);
    for (int k = 0; k < triangles(t); k++) {
        float x[3][3];
        int at[3][2];
        corner_positions(t, k, at);
        for (int c = 0; c < 3; c++) corner(t, at[c][0], at[c][1], x[c]);
        memcpy(record + 12, x, sizeof x);
        fwrite(record, sizeof record, 1, f);
    }
}

/* A row for each vertex and each triangle; with numbers from 1 if `numbered`. */
static void put_rows(FILE *f, const struct torus *t, const char *vertex_row, const char *middle,
                     const char *triangle_row, int base, int numbered)
{
    for (int k = 0; k < vertices(t); k++) {
        float x[3];
        vertex(t, k, x);
        if (numbered) fprintf(f, vertex_row, k + 1, (double)x[0], (double)x[1], (double)x[2]);
        else fprintf(f, vertex_row, (double)x[0], (double)x[1], (double)x[2]);
    }
    fprintf(f, "%s", middle);
    for (int k = 0; k < triangles(t); k++) {
        int v[3];
        triangle(t, k, v);
        if (numbered) fprintf(f, triangle_row, k + 1, v[0] + base, v[1] + base, v[2] + base);
        else fprintf(f, triangle_row, v[0] + base, v[1] + base, v[2] + base);
    }
}

static void put_obj(FILE *f, const struct torus *t)
{
    put_rows(f, t, "v %.9g %.9g %.9g\n", "", "f %d %d %d\n", 1, 0);
}

static void put_cdb(FILE *f, const struct torus *t)
{
    fprintf(f, "/PREP7\nET,1,181\nNBLOCK,6,SOLID,%d,%d\n(3i9,6e21.13e3)\n", vertices(t), vertices(t));
    for (int k = 0; k < vertices(t); k++) {
        float x[3];
        vertex(t, k, x);
        fprintf(f, "%9d%9d%9d%21.13E%21.13E%21.13E\n", k + 1, 0, 0, (double)x[0], (double)x[1], (double)x[2]);
    }
    fprintf(f, "N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,%d,%d\n(19i9)\n", triangles(t), triangles(t));
    for (int k = 0; k < triangles(t); k++) {
        int v[3];
        triangle(t, k, v);
        fprintf(f, "%9d%9d%9d%9d%9d%9d%9d%9d%9d%9d%9d%9d%9d%9d%9d\n", 1, 1, 1, 1, 0, 0, 0, 0, 4, 0, k + 1,
                v[0] + 1, v[1] + 1, v[2] + 1, v[2] + 1);
    }
    fprintf(f, "%9d\nFINISH\n", -1);
}

static void put_inp(FILE *f, const struct torus *t)
{
    fprintf(f, "*NODE\n");
    put_rows(f, t, "%d, %.9g, %.9g, %.9g\n", "*ELEMENT, TYPE=S3, ELSET=HULL\n", "%d, %d, %d, %d\n", 1, 1);
}

static void put_bdf(FILE *f, const struct torus *t)
{
    fprintf(f, "BEGIN BULK\n");
    put_rows(f, t, "GRID,%d,,%.9g,%.9g,%.9g\n", "", "CTRIA3,%d,1,%d,%d,%d\n", 1, 1);
    fprintf(f, "ENDDATA\n");
}

static void put_msh(FILE *f, const struct torus *t)
{
    char middle[100];
    fprintf(f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", vertices(t));
    snprintf(middle, sizeof middle, "$EndNodes\n$Elements\n%d\n", triangles(t));
    put_rows(f, t, "%d %.9g %.9g %.9g\n", middle, "%d 2 2 1 1 %d %d %d\n", 1, 1);
    fprintf(f, "$EndElements\n");
}

static void put_vtk(FILE *f, const struct torus *t)
{
    char middle[100];
    fprintf(f, "# vtk DataFile Version 3.0\ntorus\nASCII\nDATASET POLYDATA\nPOINTS %d float\n", vertices(t));
    snprintf(middle, sizeof middle, "POLYGONS %d %d\n", triangles(t), 4 * triangles(t));
    put_rows(f, t, "%.9g %.9g %.9g\n", middle, "3 %d %d %d\n", 0, 0);
}

static void put_vtp(FILE *f, const struct torus *t)
{
    static const char ARRAY[] =
        "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"ascii\">\n",
                      END[] = "</DataArray>\n";
    char middle[400];
    int n = 0;
    fprintf(f,
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<PolyData>\n"
            "<Piece NumberOfPoints=\"%d\" NumberOfPolys=\"%d\">\n<Points>\n",
            vertices(t), triangles(t));
    fprintf(f, ARRAY, "Float32", "Points", 3);
    n = snprintf(middle, sizeof middle, "%s</Points>\n<Polys>\n", END);
    snprintf(middle + n, sizeof middle - (size_t)n, ARRAY, "Int32", "connectivity", 1);
    put_rows(f, t, "%.9g %.9g %.9g\n", middle, "%d %d %d\n", 0, 0);
    fputs(END, f);
    fprintf(f, ARRAY, "Int32", "offsets", 1);
    for (int k = 1; k <= triangles(t); k++) fprintf(f, "%d\n", 3 * k);
    fprintf(f, "%s</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n", END);
}

/* Gmsh 4.1 in binary: one block of nodes, one of elements. */
static void put_msh_binary(FILE *f, const struct torus *t)
{
    const uint64_t nv = (uint64_t)vertices(t), nt = (uint64_t)triangles(t);
    unsigned char word[32];
    fprintf(f, "$MeshFormat\n4.1 1 8\n");
    little_endian(word, 1, 4);
    fwrite(word, 4, 1, f);
    fprintf(f, "\n$EndMeshFormat\n$Nodes\n");
    for (int k = 0; k < 4; k++) {
        little_endian(word, k == 1 || k == 3 ? nv : 1, 8);
        fwrite(word, 8, 1, f);
    }
    little_endian(word, 2, 4);
    little_endian(word + 4, 1, 4);
    little_endian(word + 8, 0, 4);
    little_endian(word + 12, nv, 8);
    fwrite(word, 20, 1, f);
    for (uint64_t k = 1; k <= nv; k++) {
        little_endian(word, k, 8);
        fwrite(word, 8, 1, f);
    }
    for (int k = 0; k < vertices(t); k++) {
        float x[3];
        double d[3];
        vertex(t, k, x);
        for (int c = 0; c < 3; c++) d[c] = (double)x[c];
        fwrite(d, sizeof d, 1, f);
    }
    fprintf(f, "\n$EndNodes\n$Elements\n");
    for (int k = 0; k < 4; k++) {
        little_endian(word, k == 1 || k == 3 ? nt : 1, 8);
        fwrite(word, 8, 1, f);
    }
    little_endian(word, 2, 4);
    little_endian(word + 4, 1, 4);
    little_endian(word + 8, 2, 4);
    little_endian(word + 12, nt, 8);
    fwrite(word, 20, 1, f);
    for (int k = 0; k < triangles(t); k++) {
        int v[3];
        triangle(t, k, v);
        little_endian(word, (uint64_t)k + 1, 8);
        for (int c = 0; c < 3; c++) little_endian(word + 8 + 8 * c, (uint64_t)v[c] + 1, 8);
        fwrite(word, 32, 1, f);
    }
    fprintf(f, "\n$EndElements\n");
}

static const struct format {
    const char *name;
    void (*put)(FILE *f, const struct torus *t);
    int text;
} FORMAT[] = {{"stl-binary", put_stl, 0}, {"msh-binary", put_msh_binary, 0},
              {"obj", put_obj, 1},        {"vtk", put_vtk, 1},
              {"vtp", put_vtp, 1},        {"msh", put_msh, 1},
              {"inp", put_inp, 1},        {"bdf", put_bdf, 1},
              {"cdb", put_cdb, 1}};
enum { FORMATS = sizeof FORMAT / sizeof *FORMAT };

static double seconds(struct timeval t) { return (double)t.tv_sec + 1e-6 * (double)t.tv_usec; }

static double children_time(void)
{
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    return seconds(use.ru_utime) + seconds(use.ru_stime);
}

/* Processor seconds to read a file in blocks and to convert each number in it; nan if it cannot be read. */
static double read_numbers(const char *path)
{
    static char piece[(1 << 20) + 1];
    const double start = children_time();
    double sum = 0.0;
    size_t have = 0, got;
    FILE *f = fopen(path, "r");
    if (!f) return NAN;
    while ((got = fread(piece + have, 1, sizeof piece - 1 - have, f)) > 0) {
        char *p = piece, *end = piece + have + got, *last = end;
        *end = '\0';
        while (last > piece && last[-1] != '\n') last--; /* whole lines */
        while (p < last) {
            if ((*p >= '0' && *p <= '9') || *p == '-' || *p == '.') sum += strtod(p, &p);
            else p++;
        }
        have = (size_t)(end - last);
        memmove(piece, last, have);
    }
    fclose(f);
    return sum != 0.0 ? children_time() - start : (double)NAN;
}

/* Runs a program with stdout and stderr into files.  Returns elapsed seconds, or nan; *cpu is the processor
 * time of all its threads. */
static double run_program(char *const argv[], const char *out, const char *log, double *gib, double *cpu)
{
    const double start = wall_time();
    struct rusage use;
    int status;
    const pid_t pid = fork();
    if (pid == 0) {
        const int o = open(out, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int e = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (o >= 0 && e >= 0 && dup2(o, 1) >= 0 && dup2(e, 2) >= 0) execvp(argv[0], argv);
        _exit(127);
    }
    if (pid < 0 || wait4(pid, &status, 0, &use) != pid || status != 0) return NAN;
    *gib = (double)use.ru_maxrss / 1048576.0;
    *cpu = seconds(use.ru_utime) + seconds(use.ru_stime);
    return wall_time() - start;
}

/* Third number of the row under the first head of a table: the volume. */
static double printed_volume(const char *log)
{
    char row[1000];
    double volume = NAN;
    FILE *f = fopen(log, "r");
    while (f && fgets(row, sizeof row, f))
        if (strncmp(row, "part ", 5) == 0) {
            if (!fgets(row, sizeof row, f) || sscanf(row, "%*s %*s %*s %lf", &volume) != 1) volume = NAN;
            break;
        }
    if (f) fclose(f);
    return volume;
}

/* --- stages ------------------------------------------------------------------------------------------- */

enum stage { READ, MOMENTS, WELD, ORIENT, SEARCH, WRITE, STAGES };

/* Processor seconds of each stage of an import, as struct-import does it for a valid mesh of one part.
 * Returns the number of crossings, -1 when something failed. */
static int time_stages(const char *mesh, const char *out, double took[STAGES])
{
    fl_surface s = {0};
    fl_err err = {0};
    fl_weld w;
    fl_mesh_quality q;
    fl_orient_counts o;
    fl_crossing c = {-1, -1};
    fl_history_line by;
    char note[FL_MESH_NOTE];
    double at[STAGES + 1];
    FILE *f = fopen(out, "w");
    int bad = !f;
    fl_history_line_start(&by, "bench_import");
    at[READ] = children_time();
    bad = bad || fl_mesh_read(&s, mesh, NULL, note, &err) || s.n != 1;
    at[MOMENTS] = children_time();
    bad = bad || !(fl_moments_of(s.part, 1).area > 0.0);
    at[WELD] = children_time();
    bad = bad || fl_part_weld(&s.part[0], -1.0, &w, &err);
    at[ORIENT] = children_time();
    bad = bad || fl_part_orient(&s.part[0], &q, &o, &err);
    at[SEARCH] = children_time();
    bad = bad || fl_part_crossings(&s.part[0], &c, &err);
    at[WRITE] = children_time();
    if (!bad) fl_gstruct_write(f, &s, &by);
    at[STAGES] = children_time();
    for (int k = 0; k < STAGES; k++) took[k] = at[k + 1] - at[k];
    if (err.code) fprintf(stderr, "%s\n", err.text);
    if (f && fclose(f) != 0) bad = 1;
    fl_surface_free(&s);
    return bad ? -1 : c.crossings + c.touching;
}

static double megabytes(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 ? 1e-6 * (double)st.st_size : (double)NAN;
}

/* Row of a file in the second table. */
struct parts {
    const char *name;
    double took[STAGES], wc, numbers; /* [s] */
    int crossings;
};

static void print_parts(const struct parts *k)
{
    double sum = 0.0;
    char ratio[40] = "-";
    printf("%-10s", k->name);
    for (int i = 0; i < STAGES; i++) {
        printf("\t%.2f", k->took[i]);
        sum += k->took[i];
    }
    if (k->numbers > 0.0) snprintf(ratio, sizeof ratio, "%.2f", k->took[READ] / k->numbers);
    printf("\t%.2f\t%.2f\t%s\t%d\n", sum, k->took[READ] / k->wc, ratio, k->crossings);
}

/* One format: a row of the table.  True if it was read within the memory limit. */
static int measure_format(const struct format *k, const struct torus *t, double volume, char *tool,
                          const char *stem, struct parts *parts)
{
    char mesh[PATH + 20], out[PATH + 20], log[PATH + 20], number[40] = "-", ratio[40] = "-";
    double count = NAN, numbers = 0.0, elapsed, import = NAN, error, size, gib = 0.0, none;
    FILE *f;
    snprintf(mesh, sizeof mesh, "%s.%s", stem, k->name);
    snprintf(out, sizeof out, "%s.dat", stem);
    snprintf(log, sizeof log, "%s.said", stem);
    f = fopen(mesh, "wb");
    if (!f) return 0;
    k->put(f, t);
    if (fclose(f) != 0) return 0;
    size = megabytes(mesh);
    run_program((char *[]){"wc", mesh, NULL}, out, log, &none, &count);
    if (k->text) numbers = read_numbers(mesh);
    elapsed = run_program((char *[]){tool, mesh, NULL}, out, log, &gib, &import);
    if (k->text) {
        snprintf(number, sizeof number, "%.2f", numbers);
        snprintf(ratio, sizeof ratio, "%.1f", import / numbers);
    }
    error = fabs(printed_volume(log) - volume) / volume;
    printf("%-10s\t%d\t%.0f\t%.2f\t%s\t%.2f\t%.2f\t%.1f\t%s\t%.2f\t%.2g\n", k->name, triangles(t), size,
           count, number, import, elapsed, import / count, ratio, gib, error);
    fflush(stdout);
    *parts = (struct parts){.name = k->name, .wc = count, .numbers = numbers};
    parts->crossings = time_stages(mesh, out, parts->took);
    remove(mesh);
    remove(out);
    remove(log);
    return gib < LIMIT && error < 1e-8 /* the table prints nine digits */ && parts->crossings == 0;
}

/* A cone with a tip and a base: each sliver of its side lies in the bounding boxes of thousands. */
static int measure_cone(int n, const char *stem, struct parts *parts)
{
    char mesh[PATH + 20], out[PATH + 20], log[PATH + 20];
    double none;
    FILE *f;
    snprintf(mesh, sizeof mesh, "%s.cone", stem);
    snprintf(out, sizeof out, "%s.dat", stem);
    snprintf(log, sizeof log, "%s.said", stem);
    *parts = (struct parts){.name = "cone"};
    f = fopen(mesh, "w");
    if (!f) return 0;
    for (int k = 0; k < n; k++) fprintf(f, "v %.17g %.17g 0\n", cos(TWO_PI * k / n), sin(TWO_PI * k / n));
    fprintf(f, "v 0 0 2\nv 0 0 0\n");
    for (int k = 1; k <= n; k++)
        fprintf(f, "f %d %d %d\nf %d %d %d\n", k, k % n + 1, n + 1, k % n + 1, k, n + 2);
    if (fclose(f) != 0) return 0;
    run_program((char *[]){"wc", mesh, NULL}, out, log, &none, &parts->wc);
    parts->numbers = read_numbers(mesh);
    parts->crossings = time_stages(mesh, out, parts->took);
    remove(mesh);
    remove(out);
    remove(log);
    return parts->crossings == 0;
}

int main(int argc, char **argv)
{
    const int want = argc > 1 ? atoi(argv[1]) : TRIANGLES;
    const int m = (int)fmax(3.0, sqrt(want / 4.0));
    const struct torus t = {(int)fmax(3.0, want / (2.0 * m)), m};
    const char *dir = getenv("TMPDIR"), *slash = strrchr(argv[0], '/');
    const double volume = six_volumes(&t) / 6.0;
    char stem[PATH], tool[PATH];
    struct parts parts[FORMATS + 1];
    int rows = 0, passed = 0, failed = 0;
    setenv("LC_ALL", "C", 1);
    snprintf(tool, sizeof tool, "%.*s/../../bin/struct-import", slash ? (int)(slash - argv[0]) : 1,
             slash ? argv[0] : ".");
    snprintf(stem, sizeof stem, "%s/floe-bench-%ld", dir ? dir : "/tmp", (long)getpid());
    printf("format\ttriangles\tfile[MB]\twc[s]\tstrtod[s]\timport[s]\telapsed[s]\timport/wc\timport/"
           "strtod\tpeak[GiB]\t"
           "error of volume\n");
    for (int k = 0; k < FORMATS; k++) {
        if (argc > 2 && strcmp(argv[2], FORMAT[k].name) != 0) continue;
        if (measure_format(&FORMAT[k], &t, volume, tool, stem, &parts[rows++])) passed++;
        else failed++;
    }
    if (measure_cone(CONE, stem, &parts[rows++])) passed++;
    else failed++;
    printf("\nformat\tread[s]\tmoments[s]\tweld[s]\torient[s]\tsearch[s]\twrite[s]\tsum[s]\tread/wc\t"
           "read/strtod\tcrossings\n");
    for (int k = 0; k < rows; k++) print_parts(&parts[k]);
    printf("%d passed, %d failed\n", passed, failed);
    return failed > 0 || passed == 0;
}
