/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/output_guard.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/stream.h"

enum { PATH_LONG = 4096 };

/* A regular file; one that is not there yet by its folder and its name in it. */
typedef struct {
    dev_t device;
    ino_t inode;
    char name[256];
} place;

static int place_of(const char *path, int stream, place *p)
{
    struct stat at;
    *p = (place){.name = ""};
    if (!path || !path[0]) return 0;
    if (strcmp(path, "-") == 0) {
        if (fstat(stream, &at) || !S_ISREG(at.st_mode)) return 0;
    } else if (stat(path, &at) == 0) {
        if (!S_ISREG(at.st_mode)) return 0;
    } else {
        char folder[PATH_LONG];
        const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
        const int n = slash ? (int)(slash - path) + 1 : 1;
        if (n >= PATH_LONG || strlen(name) >= sizeof p->name) return 0;
        snprintf(folder, sizeof folder, "%.*s", n, slash ? path : ".");
        if (stat(folder, &at)) return 0;
        strcpy(p->name, name);
    }
    p->device = at.st_dev, p->inode = at.st_ino;
    return 1;
}

static int same(const place *a, const place *b)
{
    return a->device == b->device && a->inode == b->inode && strcmp(a->name, b->name) == 0;
}

int fl_same_file(const char *a, const char *b)
{
    place p, q;
    return place_of(a, STDOUT_FILENO, &p) && place_of(b, STDOUT_FILENO, &q) && same(&p, &q);
}

/* What an output takes, itself and the name it has until it is whole; how many. */
static int places_of(const char *path, place p[2])
{
    if (!place_of(path, STDOUT_FILENO, &p[0])) return 0;
    char *part = strcmp(path, "-") == 0 ? NULL : fl_out_part_path(path);
    const int n = 1 + (part && place_of(part, STDOUT_FILENO, &p[1]));
    free(part);
    return n;
}

/* Whether they have a name in common that is not the own one of both. */
static int meet_unfinished(const place a[2], int na, const place b[2], int nb)
{
    return (na > 1 && same(&a[1], &b[0])) || (nb > 1 && same(&a[0], &b[1]));
}

int fl_output_guard_check(const fl_named_path *out, size_t outs, const fl_named_path *in, size_t ins,
                          fl_err *err)
{
    place p[2], q[2];
    for (size_t k = 0; k < outs; k++) {
        const int n = places_of(out[k].path, p);
        for (size_t i = 0; n && i < ins; i++) {
            if (!place_of(in[i].path, STDIN_FILENO, q)) continue;
            if (same(&p[0], &q[0]))
                return fl_fail(err, FL_USAGE, "%s is \"%.200s\", which is an input, %.200s", out[k].what,
                               out[k].path, in[i].path);
            if (meet_unfinished(p, n, q, 1))
                return fl_fail(err, FL_USAGE,
                               "%s is \"%.200s\", which until it is whole is %.200s, and that is an input",
                               out[k].what, out[k].path, in[i].path);
        }
        for (size_t i = 0; n && i < k; i++) {
            const int m = places_of(out[i].path, q);
            if (m && same(&p[0], &q[0]))
                return fl_fail(err, FL_USAGE, "%s is \"%.200s\", which is %s already", out[k].what,
                               out[k].path, out[i].what);
            if (m && meet_unfinished(p, n, q, m))
                return fl_fail(
                    err, FL_USAGE,
                    "%s is \"%.200s\" and %s \"%.200s\": with .part behind it, one of them is what "
                    "the other is called until it is whole",
                    out[k].what, out[k].path, out[i].what, out[i].path);
        }
    }
    return 0;
}
