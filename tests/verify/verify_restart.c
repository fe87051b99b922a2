/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs of dem-solve that are killed and resumed: their files are those of an uninterrupted run, byte for
 * byte. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include "base/rng.h"
#include "support/near.h"
#include "support/verify.h"

static const char *const OUTPUT[] = {"loads.tsv", "state.tsv", "energy.tsv", "contacts.tsv", "frames.0",
                                     "frames.1",  "frames.2",  "run.ckpt",   "hash.tsv"};
enum { FILES = sizeof OUTPUT / sizeof *OUTPUT };

static const char SCENE[] = "[run]\nduration = 0.6 s\n"
                            "[output]\nloads_every = 10 ms\nstate = state.tsv\nstate_every = 50 ms\n"
                            "energy = energy.tsv\nenergy_every = 20 ms\ncontacts = contacts.tsv\n"
                            "contacts_every = 0.1 s\nframes = frames\nframes_every = 50 ms\nfiles = 3\n"
                            "hash = hash.tsv\ncheckpoint = run.ckpt\ncheckpoint_every = 20 ms\n"
                            "[material ice]\nyoung = 5 MPa\n"
                            "[contact]\nstiffness_factor = 0.2\n[ice]\nfile = ice.dat\n[structure]\nfile = "
                            "post.dat\nvelocity = 0.1 0 0\n"
                            "[boundary]\nmin = -6 -5 none\nmax = 6 5 none\n[water]\ncurrent = 0.5 0 0\n";

static char bin[600]; /* folder of the programs */

static void die(const char *what)
{
    printf("verify_restart: %s\n", what);
    exit(1);
}

/* Starts the program in a folder; arguments end with NULL. */
static pid_t start(const char *folder, const char *program, char *const *args)
{
    char path[700];
    char *argv[24];
    int n = 0;
    snprintf(path, sizeof path, "%s/%s", bin, program);
    argv[n++] = path;
    for (; *args && n < 23; args++) argv[n++] = *args;
    argv[n] = NULL;
    fflush(stdout);
    const pid_t child = fork();
    if (child < 0) die("cannot fork");
    if (child == 0) {
        if (chdir(folder) == 0) execv(path, argv);
        _exit(127);
    }
    return child;
}

static int exit_status(pid_t child)
{
    int status = 0;
    if (waitpid(child, &status, 0) != child) die("lost a child");
    return status;
}

static void run_program(const char *folder, const char *program, char *const *args)
{
    if (exit_status(start(folder, program, args)) != 0) die(program);
}

static void save_text(const char *folder, const char *name, const char *text)
{
    char path[700];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    if (!f || fputs(text, f) < 0 || fclose(f)) die(path);
}

static char *read_file(const char *folder, const char *name, size_t *n)
{
    char path[700];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "rb");
    *n = 0;
    if (!f) return NULL;
    char *data = malloc(1 << 22);
    if (!data) die("out of memory");
    *n = fread(data, 1, 1 << 22, f);
    fclose(f);
    return data;
}

static int file_exists(const char *folder, const char *name)
{
    char path[700];
    struct stat st;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &st) == 0;
}

/* Number of files that are the same in both folders. */
static int same_files(const char *a, const char *b)
{
    int same = 0;
    for (int k = 0; k < FILES; k++) {
        size_t na, nb;
        char *da = read_file(a, OUTPUT[k], &na), *db = read_file(b, OUTPUT[k], &nb);
        const int equal = da && db && na == nb && memcmp(da, db, na) == 0;
        if (!equal) printf("   %s: %zu and %zu bytes\n", OUTPUT[k], na, nb);
        same += equal;
        free(da);
        free(db);
    }
    return same;
}

static void clear_folder(const char *folder)
{
    for (int k = 0; k < FILES; k++) {
        char path[700];
        snprintf(path, sizeof path, "%s/%s", folder, OUTPUT[k]);
        unlink(path);
        snprintf(path, sizeof path, "%s/%s.part", folder, OUTPUT[k]);
        unlink(path);
    }
}

static double wall_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void wait_for(double seconds)
{
    const struct timespec t = {.tv_sec = (time_t)seconds,
                               .tv_nsec = (long)(1e9 * (seconds - (double)(time_t)seconds))};
    nanosleep(&t, NULL);
}

/* Starts the run of a folder, or resumes it if there is a checkpoint. */
static pid_t start_or_resume(const char *folder, const char *threads)
{
    char *const fresh[] = {(char *)"-q", (char *)"-j",        (char *)threads,
                           (char *)"-o", (char *)"loads.tsv", (char *)"a.scene",
                           NULL};
    char *const again[] = {(char *)"-q",       (char *)"-j",       (char *)threads,
                           (char *)"--resume", (char *)"run.ckpt", NULL};
    return start(folder, "dem-solve", file_exists(folder, "run.ckpt") ? again : fresh);
}

/* Runs in folder `b` are ended by `signal` after a random share of the total time and resumed, until one
 * completes; repeated until there were `kills` of them.  Returns how many runs were refused.  *ended counts
 * the completed runs, *same those whose files are all those of `a`. */
static int interrupted_runs(const char *a, const char *b, int signal, int kills, double whole, int *ended,
                            int *same)
{
    int refused = 0, kill_runs = 0;
    *ended = *same = 0;
    while (kill_runs < kills) {
        clear_folder(b);
        for (int done = 0; !done;) {
            fl_rng g = fl_rng_of(test_seed(), kill_runs, FL_RNG_TEST);
            const pid_t child = start_or_resume(b, kill_runs % 2 ? "2" : "1");
            if (kill_runs < kills) {
                wait_for(fl_rng_in(&g, 0.0, 0.6 * whole));
                kill(child, signal);
                kill_runs++;
            }
            const int status = exit_status(child);
            done = WIFEXITED(status);
            if (done && WEXITSTATUS(status) != 0) {
                refused++;
                break;
            }
        }
        (*ended)++;
        *same += same_files(a, b) == FILES;
    }
    return refused;
}

static void kill_runs(const char *a, const char *b, double whole)
{
    const struct {
        int signal;
        const char *id, *name;
        int kills;
    } way[] = {{SIGKILL, "R01", "SIGKILL", verify_quick() ? 5 : 100},
               {SIGTERM, "R02", "SIGTERM", verify_quick() ? 3 : 20}};
    for (int k = 0; k < 2; k++) {
        int ended, same;
        char what[100];
        const int refused = interrupted_runs(a, b, way[k].signal, way[k].kills, whole, &ended, &same);
        verify_note("%s: %d times at random moments, in %d runs that completed", way[k].name, way[k].kills,
                    ended);
        snprintf(what, sizeof what, "%s: resumes that were refused", way[k].name);
        verify_row(way[k].id, what, refused, 0, 0, VERIFY_ABS);
        snprintf(what, sizeof what, "%s: runs whose files differ from the uninterrupted run", way[k].name);
        verify_row(way[k].id, what, ended - same, 0, 0, VERIFY_ABS);
    }
}

/* Checkpoints on request (SIGUSR1) do not change the run. */
static void signal_checkpoint(const char *a, const char *b)
{
    int asks = 0, sent = 0;
    clear_folder(b);
    const pid_t child = start_or_resume(b, "1");
    for (; asks < 2000 && !file_exists(b, "run.ckpt"); asks++)
        wait_for(0.005); /* before that it may not handle the signal yet */
    for (int k = 0; k < 3; k++) {
        fl_rng g = fl_rng_of(test_seed(), 1000 + k, FL_RNG_TEST);
        sent += kill(child, SIGUSR1) == 0;
        wait_for(fl_rng_in(&g, 0.0, 0.05));
    }
    const int status = exit_status(child);
    verify_note("SIGUSR1: sent %d times", sent);
    verify_row("R03", "SIGUSR1: status of the run", status, 0, 0, VERIFY_ABS);
    verify_row("R03", "SIGUSR1: files that differ", FILES - same_files(a, b), 0, 0, VERIFY_ABS);
}

int main(void)
{
    char self[500];
    const char *tmp = getenv("TMPDIR");
    char root[400], a[410], b[410];
    const ssize_t k = readlink("/proc/self/exe", self, sizeof self - 1);
    if (k < 0) die("/proc/self/exe");
    self[k] = '\0';
    for (int up = 0; up < 3; up++) *strrchr(self, '/') = '\0'; /* tests/verify/verify_restart */
    snprintf(bin, sizeof bin, "%s/bin", self);
    snprintf(root, sizeof root, "%s/floe-restart-XXXXXX", tmp ? tmp : "/tmp");
    if (!mkdtemp(root)) die(root);
    snprintf(a, sizeof a, "%s/a", root);
    snprintf(b, sizeof b, "%s/b", root);
    char *const field[] = {(char *)"-q",      (char *)"--size",     (char *)"12x10",
                           (char *)"--floes", (char *)"30",         (char *)"--velocity",
                           (char *)"1,0",     (char *)"--keep-out", (char *)"circle:0,0,1.6",
                           (char *)"-o",      (char *)"ice.dat",    NULL};
    const char *const folder[2] = {a, b};
    for (int f = 0; f < 2; f++) {
        if (mkdir(folder[f], 0777)) die(folder[f]);
        save_text(folder[f], "a.scene", SCENE);
        save_text(folder[f], "post.dat", "#g_struct 1\npart 0 post\ncone 0 0 -2 1.2 0 0 2 1.2\n");
        run_program(folder[f], "voronoi-ice", field);
    }
    verify_begin("runs that are killed and resumed");
    const double begun = wall_time();
    if (exit_status(start_or_resume(a, "1")) != 0) die("dem-solve");
    kill_runs(a, b, wall_time() - begun);
    signal_checkpoint(a, b);
    char line[500];
    snprintf(line, sizeof line, "rm -rf '%s'", root);
    if (system(line) != 0) printf("%s stays\n", root);
    return verify_end();
}
