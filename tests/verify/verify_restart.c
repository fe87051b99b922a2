/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs of the program itself that are killed and gone on with: what they leave in the end is what an unbroken
 * run leaves, byte for byte. */
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

static const char *const LEFT[] = {"loads.tsv", "state.tsv", "energy.tsv", "contacts.tsv", "frames.0",
                                   "frames.1",  "frames.2",  "run.ckpt",   "hash.tsv"};
enum { FILES = sizeof LEFT / sizeof *LEFT };

static const char SCENE[] =
    "[run]\nduration = 0.6 s\n"
    "[output]\nloads_every = 10 ms\nstate = state.tsv\nstate_every = 50 ms\n"
    "energy = energy.tsv\nenergy_every = 20 ms\ncontacts = contacts.tsv\n"
    "contacts_every = 0.1 s\nframes = frames\nframes_every = 50 ms\nfiles = 3\n"
    "hash = hash.tsv\ncheckpoint = run.ckpt\ncheckpoint_every = 20 ms\n"
    "[material ice]\nyoung = 5 MPa\n"
    "[contact]\nstiffness_factor = 0.2\n[ice]\nfile = ice.dat\n[structure]\nfile = post.dat\nvelocity = 0.1 0 0\n"
    "[boundary]\nmin = -6 -5 none\nmax = 6 5 none\n[water]\ncurrent = 0.5 0 0\n";

static char bin[600]; /* folder of the programs */

static void die(const char *what)
{
    printf("verify_restart: %s\n", what);
    exit(1);
}

/* Start the program in a folder; argument after argument, ended by NULL. */
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

static int end_of(pid_t child)
{
    int status = 0;
    if (waitpid(child, &status, 0) != child) die("lost a child");
    return status;
}

static void must(const char *folder, const char *program, char *const *args)
{
    if (end_of(start(folder, program, args)) != 0) die(program);
}

static void save_text(const char *folder, const char *name, const char *text)
{
    char path[700];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    if (!f || fputs(text, f) < 0 || fclose(f)) die(path);
}

static char *load(const char *folder, const char *name, size_t *n)
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

static int there(const char *folder, const char *name)
{
    char path[700];
    struct stat st;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return stat(path, &st) == 0;
}

/* How many of the files are the same in both folders. */
static int same_files(const char *a, const char *b)
{
    int same = 0;
    for (int k = 0; k < FILES; k++) {
        size_t na, nb;
        char *da = load(a, LEFT[k], &na), *db = load(b, LEFT[k], &nb);
        const int equal = da && db && na == nb && memcmp(da, db, na) == 0;
        if (!equal) printf("   %s: %zu and %zu bytes\n", LEFT[k], na, nb);
        same += equal;
        free(da);
        free(db);
    }
    return same;
}

static void clear(const char *folder)
{
    for (int k = 0; k < FILES; k++) {
        char path[700];
        snprintf(path, sizeof path, "%s/%s", folder, LEFT[k]);
        unlink(path);
        snprintf(path, sizeof path, "%s/%s.part", folder, LEFT[k]);
        unlink(path);
    }
}

static double now(void)
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

/* Start, or go on with, the run of a folder: with the checkpoint where there is one. */
static pid_t go_on(const char *folder, const char *threads)
{
    char *const fresh[] = {(char *)"-q", (char *)"-j",        (char *)threads,
                           (char *)"-o", (char *)"loads.tsv", (char *)"a.scene",
                           NULL};
    char *const again[] = {(char *)"-q",       (char *)"-j",       (char *)threads,
                           (char *)"--resume", (char *)"run.ckpt", NULL};
    return start(folder, "dem-solve", there(folder, "run.ckpt") ? again : fresh);
}

/* Runs in `b` are ended by `signal` after a random share of the time the whole takes, and gone on with, until
 * one comes to its end; over and over, until there were `kills`.  Returns how many runs were refused; *ended
 * counts the endings, *same those whose files are all those of `a`. */
static int broken_runs(const char *a, const char *b, int signal, int kills, double whole, int *ended,
                       int *same)
{
    int refused = 0, killed = 0;
    *ended = *same = 0;
    while (killed < kills) {
        clear(b);
        for (int done = 0; !done;) {
            fl_rng g = fl_rng_of(test_seed(), killed, FL_RNG_TEST);
            const pid_t child = go_on(b, killed % 2 ? "2" : "1");
            if (killed < kills) {
                wait_for(fl_rng_in(&g, 0.0, 0.6 * whole));
                kill(child, signal);
                killed++;
            }
            const int status = end_of(child);
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

static void killed(const char *a, const char *b, double whole)
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
        const int refused = broken_runs(a, b, way[k].signal, way[k].kills, whole, &ended, &same);
        verify_note("%s: %d times at random moments, in %d runs that came to their end", way[k].name,
                    way[k].kills, ended);
        snprintf(what, sizeof what, "%s: resumes that were refused", way[k].name);
        verify_row(way[k].id, what, refused, 0, 0, VERIFY_ABS);
        snprintf(what, sizeof what, "%s: runs with other bytes than an unbroken one", way[k].name);
        verify_row(way[k].id, what, ended - same, 0, 0, VERIFY_ABS);
    }
}

/* Asked for checkpoints beside its own, a run goes on as if nothing had been. */
static void asked(const char *a, const char *b)
{
    int asks = 0, sent = 0;
    clear(b);
    const pid_t child = go_on(b, "1");
    for (; asks < 2000 && !there(b, "run.ckpt"); asks++)
        wait_for(0.005); /* until then it may not listen yet */
    for (int k = 0; k < 3; k++) {
        fl_rng g = fl_rng_of(test_seed(), 1000 + k, FL_RNG_TEST);
        sent += kill(child, SIGUSR1) == 0;
        wait_for(fl_rng_in(&g, 0.0, 0.05));
    }
    const int status = end_of(child);
    verify_note("SIGUSR1: sent %d times", sent);
    verify_row("R03", "SIGUSR1: status of the run", status, 0, 0, VERIFY_ABS);
    verify_row("R03", "SIGUSR1: files with other bytes", FILES - same_files(a, b), 0, 0, VERIFY_ABS);
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
        must(folder[f], "voronoi-ice", field);
    }
    verify_begin("runs that are killed and gone on with");
    const double begun = now();
    if (end_of(go_on(a, "1")) != 0) die("dem-solve");
    killed(a, b, now() - begun);
    asked(a, b);
    char line[500];
    snprintf(line, sizeof line, "rm -rf '%s'", root);
    if (system(line) != 0) printf("%s stays\n", root);
    return verify_end();
}
