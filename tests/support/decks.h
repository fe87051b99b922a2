/* SPDX-License-Identifier: GPL-3.0-or-later */
/* decks.h -- finite-element input decks written in a test, and their import.  For one source file each: all
 * of it is static. */
#ifndef FL_TESTS_DECKS_H
#define FL_TESTS_DECKS_H
#include <string.h>
#include "geom/mesh_patch.h"
#include "mesh/read_mesh.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;
static fl_surface s; /* surface of the last import */
static char note[FL_MESH_NOTE];

static inline int setup(void **state)
{
    (void)state;
    err = (fl_err){0};
    s = (fl_surface){0};
    return 0;
}

static inline int clear(void **state)
{
    (void)state;
    fl_surface_free(&s);
    err = (fl_err){0};
    return 0;
}

/* Reads the text as a file called "deck". */
static inline int read_some(const char *text, fl_import_options *w)
{
    clear(NULL);
    return fl_mesh_read(&s, test_file("deck", text, strlen(text)), w, note, &err);
}

/* Expects success; returns the quality of the mesh. */
static inline fl_mesh_quality reads(const char *text)
{
    fl_mesh_quality q;
    if (read_some(text, NULL)) fail_msg("%s", err.text);
    assert_true(mesh_sound(&s));
    assert_int_equal(fl_surface_measure(&s, &q, &err), 0);
    return q;
}

/* Expects success and a remark that matches the pattern. */
static inline fl_mesh_quality takes(const char *text, const char *pattern)
{
    const char *const list[] = {pattern};
    char hit[1] = {0};
    fl_import_options w = {.pattern = list, .patterns = 1, .matched = hit};
    fl_mesh_quality q;
    if (read_some(text, &w)) fail_msg("%s: %s", pattern, err.text);
    if (!hit[0]) fail_msg("nothing is like %s", pattern);
    assert_int_equal(fl_surface_measure(&s, &q, &err), 0);
    return q;
}

/* Expects an error with this text, as the deck is, or else when every part and set is selected. */
static inline void refuses(const char *text, const char *why)
{
    const char *const list[] = {"*"};
    fl_import_options w = {.pattern = list, .patterns = 1};
    if (read_some(text, NULL) == 0 && read_some(text, &w) == 0) fail_msg("read, but \"%s\" is expected", why);
    assert_int_equal(err.code, FL_INPUT);
    if (!strstr(err.text, why)) fail_msg("\"%s\" is not in \"%s\"", why, err.text);
}

/* Expects a remark with this text. */
static inline void says(const char *what)
{
    if (!strstr(note, what)) fail_msg("\"%s\" is not in \"%s\"", what, note);
}

#endif
