/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "base/tool.h"
#include "support/near.h"

/* The end of a program, in a child with standard output to `out`: its status, and its text on stderr. */
static int run_end(const char *out, const char *text, int rc, fl_err err, char *text_out, size_t capacity)
{
    const char *path = test_path("said");
    int status = -1;
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const int fd = open(out, O_WRONLY), to = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
        dup2(fd, STDOUT_FILENO);
        dup2(to, STDERR_FILENO);
        fputs(text, stdout);
        _exit(fl_tool_end("loadstats", rc, &err));
    }
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status));
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    text_out[fread(text_out, 1, capacity - 1, f)] = '\0';
    fclose(f);
    unlink(path);
    return WEXITSTATUS(status);
}

static void status_is_the_code(void **state)
{
    char text_out[800];
    (void)state;
    assert_int_equal(run_end("/dev/null", "text", 0, (fl_err){0}, text_out, sizeof text_out), FL_DONE);
    assert_string_equal(text_out, "");
    for (int code = FL_NO; code <= FL_NUMERIC; code++) {
        fl_err err = {0};
        fl_fail(&err, code, "a.loads:%d: what was found", code);
        char expected[80];
        snprintf(expected, sizeof expected, "loadstats: a.loads:%d: what was found\n", code);
        assert_int_equal(run_end("/dev/null", "", -1, err, text_out, sizeof text_out), code);
        assert_string_equal(text_out, expected);
    }
    /* an answer "no" that needs no sentence */
    assert_int_equal(run_end("/dev/null", "", -1, (fl_err){.code = FL_NO}, text_out, sizeof text_out), FL_NO);
    assert_string_equal(text_out, "");
    /* failed without a message */
    assert_int_equal(run_end("/dev/null", "", -1, (fl_err){0}, text_out, sizeof text_out), FL_SYSTEM);
}

static void lost_output_is_an_error(void **state)
{
    char text_out[800];
    (void)state;
    assert_int_equal(run_end("/dev/full", "text", 0, (fl_err){0}, text_out, sizeof text_out), FL_SYSTEM);
    assert_string_equal(text_out, "loadstats: <stdout>: No space left on device\n");
    /* nothing written, nothing lost */
    assert_int_equal(run_end("/dev/full", "", 0, (fl_err){0}, text_out, sizeof text_out), FL_DONE);
    /* the first failure is the one reported */
    fl_err err = {0};
    fl_fail(&err, FL_INPUT, "first");
    assert_int_equal(run_end("/dev/full", "text", -1, err, text_out, sizeof text_out), FL_INPUT);
    assert_string_equal(text_out, "loadstats: first\n");
}

/* In a child without some of its first three files: the descriptor of a newly opened file, and the answers of
 * the three. */
static int start_without(int closed)
{
    int status = -1;
    char byte = 'x';
    fflush(NULL);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        for (int fd = 0; fd < 3; fd++)
            if (closed & 1 << fd) close(fd);
        fl_tool_begin();
        int bad = open("/dev/null", O_RDWR) < 3;
        if (closed & 1) bad |= read(0, &byte, 1) != -1 || errno != EBADF;
        if (closed & 2) bad |= write(1, &byte, 1) != -1 || errno != EBADF;
        if (closed & 4) bad |= write(2, &byte, 1) != -1 || errno != EBADF;
        _exit(bad);
    }
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void no_file_replaces_a_closed_stream(void **state)
{
    (void)state;
    for (int closed = 0; closed < 8; closed++) assert_int_equal(start_without(closed), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(status_is_the_code),
                                       cmocka_unit_test(lost_output_is_an_error),
                                       cmocka_unit_test(no_file_replaces_a_closed_stream)};
    return cmocka_run_group_tests_name("tool", tests, NULL, NULL);
}
