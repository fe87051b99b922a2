/* SPDX-License-Identifier: GPL-3.0-or-later */
/* verify_decks.c -- a body of solid elements in input decks of Abaqus and Nastran.  Volume, centroid and
 * inertia of the surface that is read are compared with sums over the elements, its area with the sides of
 * the cells. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/rng.h"
#include "geom/moments.h"
#include "mesh/read_mesh.h"
#include "support/verify.h"

enum { N = 8, NODES = (N + 1) * (N + 1) * (N + 1) };

static fl_err err;
static fl_vec3 x[NODES];

static int node_number(int i, int j, int k) { return 1 + i + (N + 1) * (j + (N + 1) * k); }

/* A box with a hole through it from front to back, and a cavity in one corner. */
static int is_solid(int i, int j, int k)
{
    if (i < 0 || j < 0 || k < 0 || i >= N || j >= N || k >= N) return 0;
    return !(i >= 3 && i < 5 && k >= 3 && k < 6) && !(i == 1 && j == 1 && k == 1);
}

/* Sheared by a map with halves and quarters.  For tetrahedra each node is then moved by up to a fifth of a
 * cell. */
static void place_nodes(int tets)
{
    fl_rng g = fl_rng_of(7, 1, FL_RNG_TEST);
    for (int k = 0; k <= N; k++)
        for (int j = 0; j <= N; j++)
            for (int i = 0; i <= N; i++) {
                fl_vec3 p = v3(i + 0.25 * j, j + 0.5 * k, 1.5 * k + 0.25 * i);
                if (tets)
                    p = v3_add(p, v3(fl_rng_in(&g, -.2, .2), fl_rng_in(&g, -.2, .2), fl_rng_in(&g, -.2, .2)));
                x[node_number(i, j, k) - 1] = v3_add(p, v3(40, -60, -10));
            }
}

/* The six tetrahedra of a cell along its diagonal, one for each order of the three directions. */
static void tet_of(int way, int i, int j, int k, int n[4])
{
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    int c[3] = {i, j, k};
    n[0] = node_number(i, j, k);
    for (int s = 0; s < 3; s++) {
        c[order[way][s]]++;
        n[s + 1] = node_number(c[0], c[1], c[2]);
    }
}

static void hex_of(int i, int j, int k, int n[8])
{
    static const int d[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int c = 0; c < 8; c++) n[c] = node_number(i + d[c % 4][0], j + d[c % 4][1], k + c / 4);
}

static void write_deck(FILE *f, int tets, int nastran)
{
    int id = 0, n[8];
    fputs(nastran ? "BEGIN BULK\n" : "*NODE\n", f);
    for (int k = 0; k < NODES; k++) {
        if (nastran) fprintf(f, "GRID*,%d,,%.17g,%.17g\n*,%.17g\n", k + 1, x[k].x, x[k].y, x[k].z);
        else fprintf(f, "%d, %.17g, %.17g, %.17g\n", k + 1, x[k].x, x[k].y, x[k].z);
    }
    if (!nastran) fprintf(f, "*ELEMENT, TYPE=%s, ELSET=BODY\n", tets ? "C3D4" : "C3D8");
    for (int c = 0; c < N * N * N; c++) {
        const int i = c % N, j = c / N % N, k = c / N / N, corners = tets ? 4 : 8;
        for (int way = 0; is_solid(i, j, k) && way < (tets ? 6 : 1); way++) {
            if (tets) tet_of(way, i, j, k, n);
            else hex_of(i, j, k, n);
            if (nastran) fprintf(f, tets ? "CTETRA,%d,1" : "CHEXA,%d,1", ++id);
            else fprintf(f, "%d", ++id);
            for (int v = 0; v < corners; v++) fprintf(f, nastran && v == 6 ? ",\n,%d" : ",%d", n[v]);
            fputc('\n', f);
        }
    }
}

/* Sums over tetrahedra: V = D/6, int x dV = V (sum of corners)/4,
 * int x x^T dV = V/20 (sum of x x^T + (sum of x)(sum of x)^T), about the point o. */
static fl_moments moments_of_elements(void)
{
    const fl_vec3 o = v3(40, -60, -10);
    fl_moments m = {0};
    double second[3][3] = {{0}}, first[3] = {0};
    for (int c = 0; c < N * N * N; c++)
        for (int way = 0; is_solid(c % N, c / N % N, c / N / N) && way < 6; way++) {
            int n[4];
            double p[4][3], sum[3] = {0}, volume;
            tet_of(way, c % N, c / N % N, c / N / N, n);
            for (int v = 0; v < 4; v++) {
                const fl_vec3 at = v3_sub(x[n[v] - 1], o);
                const double one[3] = {at.x, at.y, at.z};
                memcpy(p[v], one, sizeof one);
                for (int a = 0; a < 3; a++) sum[a] += one[a];
            }
            const fl_vec3 a = v3_sub(x[n[1] - 1], x[n[0] - 1]), b = v3_sub(x[n[2] - 1], x[n[0] - 1]);
            volume = fabs(v3_dot(v3_cross(a, b), v3_sub(x[n[3] - 1], x[n[0] - 1]))) / 6.0;
            m.volume += volume;
            for (int r = 0; r < 3; r++) {
                first[r] += volume * sum[r] / 4.0;
                for (int s = 0; s < 3; s++) {
                    double t = sum[r] * sum[s];
                    for (int v = 0; v < 4; v++) t += p[v][r] * p[v][s];
                    second[r][s] += volume * t / 20.0;
                }
            }
        }
    for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++) second[r][s] -= first[r] * first[s] / m.volume;
    const double trace = second[0][0] + second[1][1] + second[2][2];
    for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++) m.inertia.m[r][s] = (r == s ? trace : 0.0) - second[r][s];
    m.centroid = v3_madd(o, 1.0 / m.volume, v3(first[0], first[1], first[2]));
    return m;
}

/* Area of the sides of sheared cells: parallelograms next to cells that are empty. */
static double area_of_cells(void)
{
    const fl_vec3 e[3] = {{1, 0, 0.25}, {0.25, 1, 0}, {0, 0.5, 1.5}};
    double area = 0.0;
    for (int c = 0; c < N * N * N; c++)
        for (int d = 0; d < 6; d++) {
            const int i = c % N, j = c / N % N, k = c / N / N, s = d < 3 ? 1 : -1, a = d % 3;
            if (is_solid(i, j, k) && !is_solid(i + s * (a == 0), j + s * (a == 1), k + s * (a == 2)))
                area += v3_norm(v3_cross(e[(a + 1) % 3], e[(a + 2) % 3]));
        }
    return area;
}

static void verify_deck(int tets, int nastran, const char *id)
{
    const char *dir = getenv("TMPDIR"), *what = nastran ? tets ? "Nastran, CTETRA" : "Nastran, CHEXA"
                                                : tets  ? "Abaqus, C3D4"
                                                        : "Abaqus, C3D8";
    char path[4096], note[FL_MESH_NOTE], text[80];
    fl_surface s = {0};
    fl_moments m, truth;
    double off = 0.0, size = 0.0;
    FILE *f;
    place_nodes(tets);
    truth = moments_of_elements();
    snprintf(path, sizeof path, "%s/floe-decks-%ld", dir ? dir : "/tmp", (long)getpid());
    f = fopen(path, "wb");
    if (!f) {
        perror(path);
        exit(1);
    }
    write_deck(f, tets, nastran);
    if (fclose(f) != 0 || fl_mesh_read(&s, path, NULL, note, &err)) {
        fprintf(stderr, "verify_decks: %s\n", err.text);
        exit(1);
    }
    remove(path);
    m = fl_moments_of(s.part, s.n);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            off = fmax(off, fabs(m.inertia.m[r][c] - truth.inertia.m[r][c]));
            size = fmax(size, fabs(truth.inertia.m[r][c]));
        }
    snprintf(text, sizeof text, "%s: volume [m3]", what);
    verify_row(id, text, m.volume, truth.volume, 1e-12, VERIFY_REL);
    snprintf(text, sizeof text, "%s: centroid error over the side", what);
    verify_row(id, text, v3_norm(v3_sub(m.centroid, truth.centroid)) / N, 0.0, 1e-12, VERIFY_ABS);
    snprintf(text, sizeof text, "%s: inertia error over its largest", what);
    verify_row(id, text, off / size, 0.0, 1e-12, VERIFY_ABS);
    if (!tets) {
        snprintf(text, sizeof text, "%s: area [m2]", what);
        verify_row(id, text, m.area, area_of_cells(), 1e-12, VERIFY_REL);
    }
    fl_surface_free(&s);
}

int main(void)
{
    verify_begin("solid elements in input decks");
    verify_deck(0, 0, "D01");
    verify_deck(1, 0, "D02");
    verify_deck(0, 1, "D03");
    verify_deck(1, 1, "D04");
    return verify_end();
}
