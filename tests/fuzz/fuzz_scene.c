/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/scene_check.h"
#include "scene/scene_read.h"
#include "scene/scene_print.h"
#include "support/fuzz.h"

static char *write_scene(const fl_scene *s, size_t *n)
{
    char *text = NULL;
    FILE *f = open_memstream(&text, n);
    if (!f) return NULL;
    fl_scene_write(f, s);
    if (fclose(f) == 0) return text;
    free(text);
    return NULL;
}

/* A scene that was read and checked is written, read again, and is the same. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_scene first = {0}, second = {0};
    char *text = NULL, *again = NULL;
    size_t size = 0, size_again = 0;
    int rc, same = 1;
    rc = fl_scene_read(&first, fuzz_file(data, n), &err);
    if (rc == 0) rc = fl_scene_set(&first, "material.fuzz.density=1 t/m3", &err);
    if (rc == 0) rc = fl_scene_check(&first, &err);
    if (rc == 0) {
        (void)fl_scene_pair(&first, 0, FL_SCENE_STRUCTURE);
        (void)fl_scene_pair(&first, 0, FL_SCENE_BOUNDARY);
        text = write_scene(&first, &size);
        if (text) rc = fl_scene_read(&second, fuzz_file((const unsigned char *)text, size), &err);
        if (text && rc == 0) rc = fl_scene_check(&second, &err);
        if (text && rc == 0) again = write_scene(&second, &size_again);
        if (again)
            same = strcmp(text, again) == 0; /* the scratch file's folder is absolute, and so are paths */
        if (text && rc != 0 && err.code != FL_SYSTEM) same = 0;
    }
    free(text);
    free(again);
    fl_scene_free(&first);
    fl_scene_free(&second);
    return same ? fuzz_verdict(rc, &err) : FUZZ_BROKEN;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "scene", fuzz_one); }
