/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words of the manual, and what a word alone may mean. */
#include "support/near.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/scene_check.h"
#include "scene/scene_print.h"
#include "scene/scene_read.h"

static void read_text(fl_scene *s, const char *text)
{
    fl_err err = {0};
    *s = (fl_scene){0};
    if (fl_scene_read(s, test_file("case.scene", text, strlen(text)), &err) || fl_scene_check(s, &err))
        fail_msg("%s", err.text);
}

static void expect_frames(const char *text, const char *end)
{
    fl_scene s;
    read_text(&s, text);
    const size_t n = strlen(s.output.frames), len = strlen(end);
    assert_true(n >= len && strcmp(s.output.frames + n - len, end) == 0);
    assert_true(len > 0 || n == 0);
    fl_scene_free(&s);
}

static void frames_are_written_where_the_manual_asks_for_them(void **state)
{
    (void)state;
    expect_frames("dtoutAni 2\n[ice]\nfile = i\n", "/ANIMATION_3D.DAT");
    expect_frames("dtoutAni 2\n[ice]\nfile = i\n[output]\nframes = own.dat\n", "/own.dat");
    expect_frames("dtoutAni 2\n[ice]\nfile = i\n[output]\nframes = none\n", "");
    expect_frames("dtoutAni_draw 2\n[ice]\nfile = i\n", "");
    expect_frames("[ice]\nfile = i\n[output]\nframes_every = 2 s\n", "");
}

static void the_right_spelling_is_read(void **state)
{
    fl_scene s;
    (void)state;
    read_text(&s, "experiment duration 30\n[ice]\nfile = i\n");
    assert_true(s.run.duration == 30.0);
    fl_scene_free(&s);
    read_text(&s, "expperiment duration = 31\n[ice]\nfile = i\n");
    assert_true(s.run.duration == 31.0);
    fl_scene_free(&s);
}

/* Counts the lines of an explanation that begin with a word. */
static int lines_of(const char *word, const char *begin)
{
    char *text = NULL;
    size_t n;
    int count = 0;
    fl_err err = {0};
    FILE *f = open_memstream(&text, &n);
    const int rc = fl_scene_explain(f, word, &err);
    fclose(f);
    for (const char *p = text; rc == 0 && *p; p = strchr(p, '\n') + 1)
        count += strncmp(p, begin, strlen(begin)) == 0;
    free(text);
    return rc ? -1 : count;
}

static void a_word_explains_all_that_it_may_mean(void **state)
{
    (void)state;
    assert_int_equal(lines_of("softening", "contact.stiffness_factor: "), 1);
    assert_int_equal(lines_of("softening", "bond.softening: "), 1);
    assert_int_equal(lines_of("friction", "contact.friction: "), 1);
    assert_int_equal(lines_of("friction", "structure.friction: "), 1);
    assert_int_equal(lines_of("mus", "material.friction: "), 1);
    assert_int_equal(lines_of("strength", "bond.") + lines_of("strength", "failure."),
                     lines_of("strength", ""));
    assert_true(lines_of("strength", "bond.") > 1);
    assert_true(lines_of("water", "water.density: ") == 1); /* a section is all of its keys */
    assert_int_equal(lines_of("friktion", ""), -1);
    assert_int_equal(lines_of("zz", ""), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_are_written_where_the_manual_asks_for_them),
        cmocka_unit_test(the_right_spelling_is_read),
        cmocka_unit_test(a_word_explains_all_that_it_may_mean),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
