/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/parallel.h"
#include "base/stream.h"
#include "out/restart.h"
#include "support/near.h"

static const char HISTORY[] = "#by voronoi-ice 1 --seed 7\n#by dem-solve 1 a.scene\n";
static const fl_restart_part PART[3] = {
    {"scene", "#scene 1\npart end 3\n", 20}, {"empty", "", 0}, {"state", "a b\nc\n", 6}};

static char *read_contents(const char *path, int64_t *n)
{
    fl_err err = {0};
    char *text = calloc(1, 5000);
    fl_in *in = fl_in_open(path, &err);
    int64_t k;
    assert_non_null(in);
    *n = 0;
    while ((k = fl_in_read(in, text + *n, 4999 - *n, &err)) > 0) *n += k;
    fl_in_close(in);
    return text;
}

static void a_written_checkpoint_reads_back(void **state)
{
    const char *path = test_path("a.ckpt");
    fl_err err = {0};
    fl_restart r = {0};
    fl_text t = {0};
    (void)state;
    assert_int_equal(fl_restart_write(path, HISTORY, PART, 3, &err), 0);
    assert_int_equal(fl_restart_read(&r, path, &err), 0);
    assert_string_equal(r.history, HISTORY);
    assert_int_equal(r.parts, 3);
    for (int k = 0; k < 3; k++) {
        const fl_restart_part *p = fl_restart_find(&r, PART[k].name);
        assert_non_null(p);
        assert_int_equal(p->n, PART[k].n);
        assert_memory_equal(p->text, PART[k].text, (size_t)p->n);
    }
    assert_null(fl_restart_find(&r, "stat"));
    assert_int_equal(fl_restart_open(&r, "state", &t, &err), 0);
    assert_int_equal(fl_text_row(&t, &err), 1);
    assert_string_equal(t.field[1], "b");
    fl_text_close(&t);
    assert_int_equal(fl_restart_open(&r, "ice", &t, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_restart_free(&r);
    unlink(path);
}

/* Any change of any byte, and any truncation. */
static void damage_is_found(void **state)
{
    const char *path = test_path("a.ckpt");
    fl_err err = {0};
    int64_t n;
    (void)state;
    assert_int_equal(fl_restart_write(path, HISTORY, PART, 3, &err), 0);
    char *good = read_contents(path, &n);
    unlink(path);
    for (int64_t k = 0; k < 2 * n; k++) {
        fl_restart r = {0};
        fl_err why = {0};
        char *bad = malloc((size_t)n);
        memcpy(bad, good, (size_t)n);
        if (k < n) bad[k] ^= (char)(1 << k % 7);
        const char *file = test_file("bad.ckpt", bad, (size_t)(k < n ? n : k - n));
        assert_int_equal(fl_restart_read(&r, file, &why), -1);
        assert_int_equal(why.code, FL_INPUT);
        assert_non_null(strstr(why.text, "bad.ckpt"));
        assert_null(r.data);
        unlink(file);
        free(bad);
    }
    free(good);
}

static void other_files_are_refused(void **state)
{
    static const struct {
        const char *text, *says;
    } file[] = {{"#loads 1\nt\n", "this is a loads file"},
                {"#checkpoint 99\n#by x\nend 0000000000000000\n", "newer than this program"},
                {"#checkpoint 1\n", "cut short"},
                {"#checkpoint 1", "cut short"},
                {"#checkpoint 1\n#by x\nend 0000000000000000\n", "damaged"},
                {"", "empty"}};
    (void)state;
    for (size_t k = 0; k < sizeof file / sizeof *file; k++) {
        fl_restart r = {0};
        fl_err err = {0};
        const char *path = test_file("other", file[k].text, strlen(file[k].text));
        assert_int_equal(fl_restart_read(&r, path, &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        if (!strstr(err.text, file[k].says)) print_error("%s\n", err.text);
        assert_non_null(strstr(err.text, file[k].says));
        unlink(path);
    }
}

/* An older version is intact as a file, but a run does not resume from it. */
static void an_older_version_is_named(void **state)
{
    (void)state;
    for (int old = 1; old >= 0; old--) {
        fl_restart r = {0};
        fl_err err = {0};
        char text[80], number[40];
        int n = snprintf(text, sizeof text, "#checkpoint %d\n#by x\npart state 4\nall\n",
                         FL_RESTART_VERSION - old);
        const uint64_t hash = fl_hash(FL_HASH_START, text, n);
        n += snprintf(text + n, sizeof text - (size_t)n, "end %016" PRIx64 "\n", hash);
        const char *path = test_file("old", text, (size_t)n);
        assert_int_equal(fl_restart_read(&r, path, &err), 0);
        assert_int_equal(r.version, FL_RESTART_VERSION - old);
        assert_int_equal(fl_restart_current(&r, &err), -old);
        snprintf(number, sizeof number, "version %d is older", FL_RESTART_VERSION - old);
        if (old) assert_int_equal(err.code, FL_INPUT);
        if (old) assert_non_null(strstr(err.text, number));
        fl_restart_free(&r);
        unlink(path);
    }
}

/* The last good checkpoint stays when the next one cannot be written. */
static void the_last_checkpoint_stays(void **state)
{
    const char *path = test_path("a.ckpt");
    char folder[300], inside[320];
    fl_err err = {0}, why = {0};
    int64_t n, m;
    (void)state;
    assert_int_equal(fl_restart_write(path, HISTORY, PART, 3, &err), 0);
    char *before = read_contents(path, &n);
    snprintf(folder, sizeof folder, "%s.part", path); /* the temporary name is taken by a folder */
    snprintf(inside, sizeof inside, "%s/no/such", folder);
    assert_int_equal(fl_restart_write(inside, HISTORY, PART, 3, &why), -1);
    assert_int_equal(why.code, FL_SYSTEM);
    why = (fl_err){0};
    assert_int_equal(fl_restart_write("/dev/full", HISTORY, PART, 3, &why), -1);
    assert_int_equal(why.code, FL_SYSTEM);
    char *after = read_contents(path, &m);
    assert_int_equal(n, m);
    assert_memory_equal(before, after, (size_t)n);
    free(before);
    free(after);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_written_checkpoint_reads_back), cmocka_unit_test(damage_is_found),
        cmocka_unit_test(other_files_are_refused), cmocka_unit_test(an_older_version_is_named),
        cmocka_unit_test(the_last_checkpoint_stays)};
    return cmocka_run_group_tests_name("restart file", tests, NULL, NULL);
}
