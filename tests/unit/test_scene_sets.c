/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines "#set section.key = value" of a table make the scene of its run again. */
#include "support/near.h"
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/scene_check.h"
#include "scene/scene_print.h"
#include "scene/scene_read.h"

static char *print_scene(const fl_scene *s)
{
    char *text = NULL;
    size_t n;
    FILE *f = open_memstream(&text, &n);
    fl_scene_write(f, s);
    assert_int_equal(fclose(f), 0);
    return text;
}

/* A table with the lines of a scene. */
static char *print_table(const fl_scene *s)
{
    char *text = NULL;
    size_t n;
    fl_err err = {0};
    FILE *f = open_memstream(&text, &n);
    fprintf(f, "#loads 1\n#by dem-solve 0.1.0 a.scene\n");
    assert_int_equal(fl_scene_write_sets(f, s, "", &err), 0);
    fprintf(f, "t[s]\tpart\n0.02\tpost\n");
    assert_int_equal(fclose(f), 0);
    return text;
}

/* The scene of the lines of s, checked. */
static void read_again(fl_scene *t, const fl_scene *s)
{
    char *table = print_table(s), *history;
    fl_err err = {0};
    if (fl_scene_read_sets(t, test_file("loads.tsv", table, strlen(table)), &history, &err) ||
        fl_scene_check(t, &err))
        fail_msg("%s\n%s", err.text, table);
    assert_string_equal(history, "#by dem-solve 0.1.0 a.scene\n");
    free(history);
    free(table);
}

/* Every scene of the tree, but for files of tables and threads, which lines of a record do not have. */
static void expect_same_scene(const char *path)
{
    fl_scene s = {0}, t = {0};
    fl_err err = {0};
    if (fl_scene_read(&s, path, &err) || fl_scene_check(&s, &err)) { /* a case of bad input, or no ice */
        fl_scene_free(&s);
        return;
    }
    read_again(&t, &s);
    t.output = s.output;
    t.run.threads = s.run.threads;
    char *one = print_scene(&s), *other = print_scene(&t);
    const char *p = one, *q = other;
    while (*p && *p == *q) p++, q++;
    if (*p || *q) fail_msg("%s: the scene again differs from\n%.100s\nby\n%.100s", path, p, q);
    free(one);
    free(other);
    fl_scene_free(&s);
    fl_scene_free(&t);
}

static void every_scene_of_the_tree_comes_back(void **state)
{
    glob_t found = {0};
    (void)state;
    assert_int_equal(glob("share/examples/*/*.scene", 0, NULL, &found), 0);
    assert_int_equal(glob("tests/golden/*/*.scene", GLOB_APPEND, NULL, &found), 0);
    assert_true(found.gl_pathc > 40);
    for (size_t k = 0; k < found.gl_pathc; k++) expect_same_scene(found.gl_pathv[k]);
    globfree(&found);
}

static void lines_are_what_differs_from_defaults(void **state)
{
    static const char SCENE[] =
        "[run]\nduration = 2 s\nthreads = 3\ngravity = 9.81\n[output]\nfiles = 3\n"
        "loads_every = 10 ms\nstate = s.tsv\n[ice]\nfile = ice.dat\n[water]\n"
        "[material ice]\nfriction = 0.3\nyoung = 2 GPa\n[contact ice ice]\nlaw = core\n";
    fl_scene s = {0};
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_scene_read(&s, test_file("a.scene", SCENE, strlen(SCENE)), &err), 0);
    assert_int_equal(fl_scene_check(&s, &err), 0);
    char *table = print_table(&s);
    const char *from = strstr(table, "#set"), *ice = strstr(table, "#set ice.file");
    assert_non_null(ice);
    static const char FIRST[] = "#set run.duration = 2 s\n#set output.loads_every = 0.01 s\n"
                                "#set material.ice.young = 2000000000 Pa\n#set contact.ice.ice.law = core\n";
    assert_int_equal(ice - from, strlen(FIRST));
    assert_memory_equal(from, FIRST, strlen(FIRST));
    assert_non_null(strstr(ice, "\n#set water.")); /* a section of defaults is there all the same */
    free(table);
    fl_scene_free(&s);
}

static void expect_complaint(const char *table, const char *tail)
{
    fl_scene s = {0};
    fl_err err = {0};
    char *history;
    assert_int_equal(fl_scene_read_sets(&s, test_file("loads.tsv", table, strlen(table)), &history, &err),
                     -1);
    const char *at = strstr(err.text, "loads.tsv");
    if (!at || strcmp(at + strlen("loads.tsv"), tail) != 0) fail_msg("%s, wanted %s", err.text, tail);
    assert_int_equal(err.code, FL_INPUT);
    assert_null(history);
}

static void later_lines_replace_earlier_ones(void **state)
{
    static const char TABLE[] = "#loads 1\n#set run.duration = 2 s\nt[s]\n1\n#set run.duration = 3 s\n2\n";
    fl_scene s = {0};
    fl_err err = {0};
    char *history;
    (void)state;
    assert_int_equal(fl_scene_read_sets(&s, test_file("loads.tsv", TABLE, strlen(TABLE)), &history, &err), 0);
    assert_null(history);
    assert_true(s.run.duration == 3.0);
    fl_scene_free(&s);
}

static void complaints_name_file_and_line(void **state)
{
    (void)state;
    expect_complaint("#loads 1\nt[s]\n1\n",
                     ": no line \"#set section.key = value\": a table of dem-solve is expected");
    expect_complaint("#loads 1\n#set run.durations = 2 s\nt[s]\n",
                     ":2: unknown key \"durations\" in [run], nearest is \"duration\"");
    expect_complaint("#loads 1\n\n#set run.duration = 2 m\nt[s]\n",
                     ":3: run.duration has the unit \"m\", one of s ms us min h is expected");
    expect_complaint("#loads 1\n#set duration\nt[s]\n", ":2: \"duration\" is not section.key=value");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_of_the_tree_comes_back),
        cmocka_unit_test(lines_are_what_differs_from_defaults),
        cmocka_unit_test(later_lines_replace_earlier_ones),
        cmocka_unit_test(complaints_name_file_and_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
