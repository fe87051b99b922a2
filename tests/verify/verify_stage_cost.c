/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Options that a scene does not use cost nothing.  Counts the instructions of the time step of the
 * dem-solve built beside this program, by callgrind.  Without valgrind there is one row and no count. */
#define _GNU_SOURCE
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "support/near.h"
#include "support/verify.h"

enum { STEPS = 40 };

typedef struct {
    double total; /* instructions per step */
    int water;    /* source files of lib/water that a step executed */
} cost;

/* Path of the solver: this program is BUILD/tests/verify/verify_stage_cost. */
static char *solver_path(void)
{
    static char path[4096];
    const ssize_t n = readlink("/proc/self/exe", path, sizeof path - 40);
    char *at;
    if (n <= 0) return NULL;
    path[n] = '\0';
    for (int k = 0; k < 3; k++) {
        at = strrchr(path, '/');
        if (!at) return NULL;
        *at = '\0';
    }
    strcat(path, "/bin/dem-solve");
    return access(path, X_OK) == 0 ? path : NULL;
}

static int count_instructions(const char *program, const char *scene, const char *ice, const char *set,
                              cost *c)
{
    const char *out = test_path("callgrind.out");
    char command[8192], line[4096];
    *c = (cost){0};
    snprintf(command, sizeof command,
             "OMP_WAIT_POLICY=passive valgrind --tool=callgrind --toggle-collect=fl_step "
             "--compress-strings=no --compress-pos=no "
             "--callgrind-out-file='%s' '%s' -q -j 1 -i '%s' %s -o /dev/null '%s' >/dev/null 2>&1",
             out, program, ice, set, scene);
    if (system(command) != 0) return -1;
    FILE *f = fopen(out, "r");
    if (!f) return -1;
    while (fgets(line, sizeof line, f)) {
        double total;
        if (sscanf(line, "totals: %lf", &total) == 1 || sscanf(line, "summary: %lf", &total) == 1)
            c->total = total / STEPS;
        if ((!strncmp(line, "fl=", 3) || !strncmp(line, "fi=", 3) || !strncmp(line, "fe=", 3)) &&
            strstr(line, "lib/water/"))
            c->water++;
    }
    fclose(f);
    remove(out);
    return c->total > 0.0 ? 0 : -1;
}

int main(void)
{
    static const char SCENE[] = "[run]\nduration = 0.04\ndt = 0.001\n[ice]\nmaterial = ice\n[contact]\n"
                                "stiffness_factor = 0.01\n";
    static const struct {
        const char *name, *set;
    } AT[5] = {{"dry", ""},
               {"calm", "--set water.level=0"},
               {"calm, drag by facets, added mass", "--set water.drag=facet --set water.added_mass=auto"},
               {"an Airy wave", "--set water.wave=airy --set water.height=1 --set water.period=8"},
               {"a sea of 100 trains", "--set water.wave=jonswap --set water.height=1 --set water.period=8"}};
    /* Nine floes apart, at their draft; the tenth far above, the eleventh far below. */
    char ice[4096] = "#g-polys 1\n", path_ice[256], path_scene[256];
    cost c[5] = {{0}}, far;
    verify_begin("stages: unused options cost nothing");
    char *program = solver_path();
    if (!program || system("valgrind --version >/dev/null 2>&1") != 0) {
        verify_note("no valgrind, or no dem-solve beside the tests: nothing was counted");
        verify_true("-", "nothing to count with", 1);
        return verify_end();
    }
    for (int k = 0; k < 9; k++) {
        const double x = 4.0 * (k % 3), y = 4.0 * (k / 3);
        int n = (int)strlen(ice);
        n += snprintf(ice + n, sizeof ice - (size_t)n, "poly %d 0.05 8 6\n", k + 1);
        for (int v = 0; v < 8; v++)
            n += snprintf(ice + n, sizeof ice - (size_t)n, "v %g %g %g\n", x + (v & 1 ? 1.2 : -1.2),
                          y + (v & 2 ? 1.1 : -1.1), v & 4 ? 0.07 : -0.83);
        snprintf(ice + n, sizeof ice - (size_t)n,
                 "f 4 0 2 3 1\nf 4 4 5 7 6\nf 4 0 1 5 4\nf 4 2 6 7 3\nf 4 0 4 6 2\nf 4 1 3 7 5\n");
    }
    snprintf(path_ice, sizeof path_ice, "%s", test_file("ice.dat", ice, strlen(ice)));
    snprintf(path_scene, sizeof path_scene, "%s", test_file("stages.scene", SCENE, strlen(SCENE)));
    for (int k = 0; k < 5; k++) {
        char what[120];
        if (verify_quick() && (k == 2 || k == 4)) continue; /* each run takes a second or two */
        const int bad = count_instructions(program, path_scene, path_ice, AT[k].set, &c[k]);
        verify_true("-", AT[k].name, !bad);
        if (bad) return verify_end();
        snprintf(what, sizeof what, "  instructions per step, 9 floes");
        verify_below("-", what, c[k].total, k < 1 ? 2e4 : k < 2 ? 1e5 : 1.5e6);
    }
    verify_row("-", "files of lib/water that a dry step executes", c[0].water, 0, 0, VERIFY_ABS);
    verify_true("-", "a calm one runs in some", c[1].water > 0);
    verify_true("-", "each stage costs: dry < calm < facets, wave < sea",
                c[0].total < c[1].total && c[1].total < c[3].total &&
                    (verify_quick() || (c[1].total < c[2].total && c[3].total < c[4].total)));
    for (int k = 0; k < (verify_quick() ? 1 : 2); k++) {
        const int bad = count_instructions(program, path_scene, path_ice,
                                           k ? "--set water.level=50" : "--set water.level=-50", &far);
        verify_below("-",
                     k ? "deep body over dry: share of the cost of calm water"
                       : "body in the air over dry: share of the cost of calm water",
                     bad ? INFINITY : (far.total - c[0].total) / (c[1].total - c[0].total), k ? 0.8 : 0.5);
    }
    remove(path_ice);
    remove(path_scene);
    return verify_end();
}
