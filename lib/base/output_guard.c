/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/output_guard.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/stream.h"

enum { PATH_LONG = 4096 };

/* Identity of a regular file.  A file that does not exist is identified by its folder and its name there. */
typedef struct {
    dev_t device;
    ino_t inode;
    char name[256];
} file_id;

static int identify_file(const char *path, int stream, file_id *p)
{
    struct stat at;
    *p = (file_id){.name = ""};
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

static int is_same_file(const file_id *a, const file_id *b)
{
    return a->device == b->device && a->inode == b->inode && strcmp(a->name, b->name) == 0;
}

int fl_same_file(const char *a, const char *b)
{
    file_id p, q;
    return identify_file(a, STDOUT_FILENO, &p) && identify_file(b, STDOUT_FILENO, &q) && is_same_file(&p, &q);
}

/* Fills p with the files that an output occupies: the file itself and its unfinished PATH.part.  Returns
 * their number. */
static int identify_output(const char *path, file_id p[2])
{
    if (!identify_file(path, STDOUT_FILENO, &p[0])) return 0;
    char *part = strcmp(path, "-") == 0 ? NULL : fl_out_part_path(path);
    const int n = 1 + (part && identify_file(part, STDOUT_FILENO, &p[1]));
    free(part);
    return n;
}

/* True if the unfinished name of one output is the final name of the other. */
static int share_part_name(const file_id a[2], int na, const file_id b[2], int nb)
{
    return (na > 1 && is_same_file(&a[1], &b[0])) || (nb > 1 && is_same_file(&a[0], &b[1]));
}

int fl_output_guard_check(const fl_named_path *out, size_t outs, const fl_named_path *in, size_t ins,
                          fl_err *err)
{
    file_id p[2], q[2];
    for (size_t k = 0; k < outs; k++) {
        const int n = identify_output(out[k].path, p);
        for (size_t i = 0; n && i < ins; i++) {
            if (!identify_file(in[i].path, STDIN_FILENO, q)) continue;
            if (is_same_file(&p[0], &q[0]))
                return fl_fail(err, FL_USAGE, "%s is \"%.200s\", which is an input, %.200s", out[k].what,
                               out[k].path, in[i].path);
            if (share_part_name(p, n, q, 1))
                return fl_fail(err, FL_USAGE, "%s is \"%.200s\", whose unfinished file %.200s is an input",
                               out[k].what, out[k].path, in[i].path);
        }
        for (size_t i = 0; n && i < k; i++) {
            const int m = identify_output(out[i].path, q);
            if (m && is_same_file(&p[0], &q[0]))
                return fl_fail(err, FL_USAGE, "%s is \"%.200s\", which is %s already", out[k].what,
                               out[k].path, out[i].what);
            if (m && share_part_name(p, n, q, m))
                return fl_fail(
                    err, FL_USAGE,
                    "%s is \"%.200s\" and %s \"%.200s\": one is the unfinished file (.part) of the other",
                    out[k].what, out[k].path, out[i].what, out[i].path);
        }
    }
    return 0;
}
