/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>
#include "base/array.h"
#include "base/rng.h"
#include "base/stream.h"
#include "support/near.h"

enum { SIZE = 300000 }; /* several chunks of 64 KiB */
static unsigned char sample[SIZE];

static int make_sample(void **state)
{
    (void)state;
    for (int k = 0; k < SIZE; k += 8) { /* half random, half rows: gzip makes about half of it */
        fl_rng g = fl_rng_of(1, k, FL_RNG_TEST);
        const uint64_t word = k % 16 ? fl_rng_u64(&g) : UINT64_C(0x0a30303030303020);
        memcpy(sample + k, &word, 8);
    }
    return 0;
}

/* Read all of it in pieces of at most `piece`; returns the length, or -1. */
static int64_t slurp(const char *path, unsigned char *to, int64_t capacity, int64_t piece, fl_err *err)
{
    int64_t n = 0, k = 0;
    fl_in *in = fl_in_open(path, err);
    if (!in) return -1;
    while (n < capacity && (k = fl_in_read(in, to + n, piece < capacity - n ? piece : capacity - n, err)) > 0)
        n += k;
    fl_in_close(in);
    return k < 0 ? -1 : n;
}

static void expect_sample(const char *path, int64_t times)
{
    static unsigned char got[2 * SIZE + 1];
    static const int64_t piece[] = {1000, 65536, 1000000};
    for (int k = 0; k < 3; k++) {
        fl_err err = {0};
        assert_int_equal(slurp(path, got, sizeof got, piece[k], &err), times * SIZE);
        for (int64_t i = 0; i < times; i++) assert_memory_equal(got + i * SIZE, sample, SIZE);
        assert_int_equal(err.code, 0);
    }
}

static void expect_failure(const char *path, int code, const char *says)
{
    static unsigned char got[2 * SIZE];
    fl_err err = {0};
    assert_int_equal(slurp(path, got, sizeof got, 65536, &err), -1);
    assert_int_equal(err.code, code);
    if (!strstr(err.text, says)) fail_msg("\"%s\" does not say \"%s\"", err.text, says);
}

/* The sample as gzip, with the given mode of gzopen. */
static const char *gzip_sample(const char *name, const char *mode)
{
    const char *path = test_path(name);
    gzFile gz = gzopen(path, mode);
    assert_non_null(gz);
    assert_int_equal(gzwrite(gz, sample, SIZE), SIZE);
    assert_int_equal(gzclose(gz), Z_OK);
    return path;
}

static void plain_and_gzip(void **state)
{
    const char *path = test_file("plain", sample, SIZE);
    (void)state;
    expect_sample(path, 1);
    unlink(path);
    path = gzip_sample("gz", "wb9");
    expect_sample(path, 1);
    gzip_sample("gz", "ab1"); /* a second member behind the first */
    expect_sample(path, 2);
    unlink(path);
}

static void tiny_files(void **state)
{
    unsigned char got[8];
    (void)state;
    for (int64_t n = 0; n < 4; n++) {
        fl_err err = {0};
        const char *path = test_file("tiny",
                                     "\x1f"
                                     "bc",
                                     (size_t)n); /* starts like gzip and is not */
        assert_int_equal(slurp(path, got, sizeof got, 8, &err), n);
        assert_memory_equal(got,
                            "\x1f"
                            "bc",
                            (size_t)n);
        unlink(path);
    }
    const char *path = test_path("empty");
    gzFile gz = gzopen(path, "wb");
    gzclose(gz);
    fl_err err = {0};
    assert_int_equal(slurp(path, got, sizeof got, 8, &err), 0); /* gzip of nothing */
    assert_int_equal(err.code, 0);
    unlink(path);
}

static void damaged_gzip(void **state)
{
    static unsigned char raw[2 * SIZE];
    fl_err err = {0};
    const char *path = gzip_sample("whole", "wb6");
    FILE *f = fopen(path, "rb");
    (void)state;
    assert_non_null(f);
    const size_t n = fread(raw, 1, sizeof raw, f);
    fclose(f);
    unlink(path);
    assert_true(n > 1000 && n < SIZE);
    const size_t cut[] = {2, 3, 9, 10, 11, n / 2, n - 8, n - 1};
    for (size_t k = 0; k < sizeof cut / sizeof *cut; k++) {
        path = test_file("cut", raw, cut[k]);
        expect_failure(path, FL_INPUT, "gzip data end early");
        unlink(path);
    }
    raw[n - 5] ^= 1; /* the checksum */
    path = test_file("sum", raw, n);
    expect_failure(path, FL_INPUT, "damaged gzip data");
    unlink(path);
    raw[n - 5] ^= 1;
    memcpy(raw + n, "rubbish", 7);
    path = test_file("tail", raw, n + 7);
    expect_failure(path, FL_INPUT, "damaged gzip data");
    unlink(path);
    assert_int_equal(err.code, 0);
}

static void unreadable_files_are_reported(void **state)
{
    (void)state;
    expect_failure("/nonexistent/file", FL_INPUT, "/nonexistent/file: No such file or directory");
    expect_failure("/", FL_INPUT, "Is a directory");
    expect_failure("", FL_INPUT, "No such file");
    fl_in_close(NULL);
    const char *path = test_file("mem", "x", 1);
    fl_alloc_fail_after(0);
    expect_failure(path, FL_SYSTEM, "out of memory");
    fl_alloc_fail_after(-1);
    unlink(path);
}

/* Replaces standard input by the reading end of a pipe; a child writes data[n] into it, `piece` bytes at a
 * time. */
static pid_t feed_stdin(const void *data, size_t n, size_t piece)
{
    int end[2];
    assert_int_equal(pipe(end), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        close(end[0]);
        for (size_t k = 0; k < n; k += piece)
            if (write(end[1], (const char *)data + k, piece < n - k ? piece : n - k) < 0) _exit(1);
        _exit(0);
    }
    close(end[1]);
    dup2(end[0], STDIN_FILENO);
    close(end[0]);
    return child;
}

static void a_pipe_is_read(void **state)
{
    static unsigned char got[SIZE + 1], raw[2 * SIZE];
    const int was = dup(STDIN_FILENO);
    (void)state;
    const char *path = gzip_sample("pipe", "wb6");
    FILE *f = fopen(path, "rb");
    const size_t n = fread(raw, 1, sizeof raw, f);
    fclose(f);
    unlink(path);
    for (int gz = 0; gz < 2; gz++)
        for (size_t piece = 1; piece <= 100000; piece = piece == 1 ? 999 : 100 * piece) {
            fl_err err = {0};
            int status = -1;
            /* byte by byte is slow: the first few thousand bytes suffice */
            const size_t some = gz ? n : piece == 1 ? 5000 : SIZE;
            if (gz && piece == 1) continue;
            const pid_t child = feed_stdin(gz ? raw : sample, some, piece);
            assert_int_equal(slurp("-", got, sizeof got, 65536, &err), gz ? SIZE : (int64_t)some);
            assert_memory_equal(got, sample, gz ? SIZE : some);
            waitpid(child, &status, 0);
            assert_int_equal(status, 0);
        }
    /* a gzip with its first two bytes in separate pieces */
    fl_err err = {0};
    const pid_t child = feed_stdin(raw, 2, 1);
    fl_in *in = fl_in_open("-", &err);
    assert_non_null(in);
    assert_string_equal(fl_in_name(in), "<stdin>");
    assert_int_equal(fl_in_read(in, got, 10, &err), -1);
    assert_string_equal(err.text, "<stdin>: gzip data end early");
    fl_in_close(in);
    waitpid(child, NULL, 0);
    dup2(was, STDIN_FILENO);
    close(was);
}

/* --- out ------------------------------------------------------------------------------------------------ */

static int exists(const char *path) { return access(path, F_OK) == 0; }

static const char *part_of(const char *path)
{
    static char part[720];
    snprintf(part, sizeof part, "%s.part", path);
    return part;
}

static void the_final_name_comes_last(void **state)
{
    (void)state;
    for (int gz = 0; gz < 2; gz++) {
        fl_err err = {0};
        fl_out out;
        const char *path = test_path("out");
        assert_int_equal(fl_out_open(&out, path, gz, &err), 0);
        assert_int_equal(fwrite(sample, 1, SIZE, out.f), SIZE);
        assert_false(exists(path));
        assert_true(exists(part_of(path)));
        assert_int_equal(fl_out_close(&out, &err), 0);
        assert_null(out.f);
        assert_false(exists(part_of(path)));
        expect_sample(path, 1);
        /* an older file stays until the newer one is complete, and when that is dropped */
        assert_int_equal(fl_out_open(&out, path, gz, &err), 0);
        fputs("half", out.f);
        expect_sample(path, 1);
        fl_out_abort(&out);
        expect_sample(path, 1);
        assert_false(exists(part_of(path)));
        assert_int_equal(fl_out_close(&out, &err), 0); /* closed already */
        fl_out_abort(&out);
        assert_int_equal(fl_out_open(&out, path, gz, &err), 0);
        fputs("newer", out.f);
        assert_int_equal(fl_out_close(&out, &err), 0);
        unsigned char got[16];
        assert_int_equal(slurp(path, got, sizeof got, 16, &err), 5);
        assert_memory_equal(got, "newer", 5);
        unlink(path);
    }
}

static void unwritable_paths_are_reported(void **state)
{
    fl_err err = {0};
    fl_out out;
    (void)state;
    assert_int_equal(fl_out_open(&out, "/nonexistent/file", 0, &err), -1);
    assert_int_equal(err.code, FL_SYSTEM);
    assert_string_equal(err.text, "/nonexistent/file: there is no folder /nonexistent");
    const char *folder = test_path("folder");
    assert_int_equal(mkdir(folder, 0777), 0);
    err = (fl_err){0};
    assert_int_equal(fl_out_open(&out, folder, 0, &err), -1); /* now, and not at the end of a long run */
    assert_non_null(strstr(err.text, "Is a directory"));
    assert_false(exists(part_of(folder)));
    rmdir(folder);
}

/* The folder goes while the file is being written. */
static void a_folder_that_vanishes_is_reported(void **state)
{
    fl_err err = {0};
    fl_out out;
    char path[700];
    (void)state;
    const char *folder = test_path("gone");
    assert_int_equal(mkdir(folder, 0777), 0);
    snprintf(path, sizeof path, "%s/out", folder);
    assert_int_equal(fl_out_open(&out, path, 0, &err), 0);
    fputs("text", out.f);
    unlink(part_of(path));
    rmdir(folder);
    assert_int_equal(fl_out_close(&out, &err), -1);
    assert_int_equal(err.code, FL_SYSTEM);
    assert_non_null(strstr(err.text, "No such file or directory"));
    assert_false(exists(path));
}

static void a_full_disk_is_reported(void **state)
{
    (void)state;
    for (int gz = 0; gz < 2; gz++)
        for (int64_t n = 4; n <= SIZE; n += SIZE - 4) { /* seen at the flush, and during the writing */
            fl_err err = {0};
            fl_out out;
            assert_int_equal(fl_out_open(&out, "/dev/full", gz, &err), 0);
            fwrite(sample, 1, (size_t)n, out.f);
            assert_int_equal(fl_out_close(&out, &err), -1);
            assert_int_equal(err.code, FL_SYSTEM);
            assert_non_null(strstr(err.text, "/dev/full: "));
        }
}

/* Kept output stays under the other name up to its last complete line, and the message names that line. */
static void unfinished_output_is_kept(void **state)
{
    (void)state;
    for (int keep = 0; keep < 2; keep++) {
        fl_err err = {0};
        fl_out out;
        struct rlimit was, small;
        char expected[1500];
        const char *path = test_path("rows"), *part = part_of(path);
        int bad = 0;
        assert_int_equal(getrlimit(RLIMIT_FSIZE, &was), 0);
        assert_int_equal(fl_out_open(&out, path, 0, &err), 0);
        out.keep_part = keep;
        small = (struct rlimit){5000, was.rlim_max};
        void (*const old)(int) = signal(SIGXFSZ, SIG_IGN);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
        for (int k = 0; k < 1000 && !bad; k++) {
            fprintf(out.f, "row %03d\n", k);
            bad = fl_out_flush(&out, &err);
        }
        assert_int_equal(bad, -1);
        assert_int_equal(fl_out_close(&out, &err), -1);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &was), 0);
        signal(SIGXFSZ, old);
        snprintf(expected, sizeof expected,
                 keep ? "%s: %s; what was written until then is kept in %s" : "%s: %s", path,
                 "File too large", part);
        assert_string_equal(err.text, expected);
        assert_false(exists(path));
        assert_int_equal(exists(part), keep);
        if (!keep) continue;
        struct stat st;
        assert_int_equal(stat(part, &st), 0);
        assert_int_equal(st.st_size, 5000 / 8 * 8);
        unlink(part);
    }
}

/* A device stays a device, a link a link: they are written through, not replaced. */
static void devices_and_links_stay(void **state)
{
    fl_err err = {0};
    fl_out out;
    struct stat st;
    unsigned char got[16];
    (void)state;
    assert_int_equal(fl_out_open(&out, "/dev/null", 0, &err), 0);
    fputs("text", out.f);
    assert_int_equal(fl_out_close(&out, &err), 0);
    assert_int_equal(stat("/dev/null", &st), 0);
    assert_true(S_ISCHR(st.st_mode));

    const char *target = test_file("target", "old", 3), *link = test_path("link");
    assert_int_equal(symlink(target, link), 0);
    assert_int_equal(fl_out_open(&out, link, 0, &err), 0);
    fputs("through", out.f);
    assert_int_equal(fl_out_close(&out, &err), 0);
    assert_int_equal(lstat(link, &st), 0);
    assert_true(S_ISLNK(st.st_mode));
    assert_int_equal(slurp(target, got, sizeof got, 16, &err), 7);
    unlink(link);
    unlink(target);
}

/* A pipe with a waiting reader: a fifo is written directly. */
static void a_fifo_is_written_directly(void **state)
{
    fl_err err = {0};
    fl_out out;
    int status = -1;
    (void)state;
    const char *fifo = test_path("fifo");
    assert_int_equal(mkfifo(fifo, 0600), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        char buf[16] = "";
        const int fd = open(fifo, O_RDONLY);
        ssize_t n = 0, k;
        while ((k = read(fd, buf + n, sizeof buf - (size_t)n)) > 0) n += k;
        _exit(n == 4 && memcmp(buf, "text", 4) == 0 ? 0 : 1);
    }
    assert_int_equal(fl_out_open(&out, fifo, 0, &err), 0);
    fputs("text", out.f);
    assert_int_equal(fl_out_close(&out, &err), 0);
    waitpid(child, &status, 0);
    assert_int_equal(status, 0);
    unlink(fifo);
}

/* Standard output, plain and gzip, to a file and to a full disk; in a child, whose stdout it is. */
static void standard_output_is_written(void **state)
{
    (void)state;
    for (int mode = 0; mode < 4; mode++) {
        const int gz = mode & 1, full = mode >> 1;
        const char *path = full ? "/dev/full" : test_path("stdout");
        int status = -1;
        fflush(NULL);
        const pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            fl_err err = {0};
            fl_out out;
            const int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
            dup2(fd, STDOUT_FILENO);
            close(fd);
            if (fl_out_open(&out, "-", gz, &err)) _exit(1);
            fwrite(sample, 1, SIZE, out.f);
            if (fl_out_close(&out, &err) == 0) _exit(full ? 2 : 0);
            _exit(full && err.code == FL_SYSTEM && strncmp(err.text, "<stdout>: ", 10) == 0 ? 0 : 3);
        }
        waitpid(child, &status, 0);
        assert_int_equal(status, 0);
        if (full) continue;
        expect_sample(path, 1);
        unlink(path);
    }
}

/* Output of two runs; the first one continued after its mark and then failed, ended or was killed. */
/* The mark of a program that was killed a little later. */
static fl_file_mark write_and_kill(const char *path, int gz)
{
    fl_file_mark mark = {0};
    int way[2];
    assert_int_equal(pipe(way), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        fl_out out = {0};
        fl_err err = {0};
        if (fl_out_open(&out, path, gz, &err)) _exit(1);
        fwrite(sample, 1, 100000, out.f);
        if (fl_out_mark(&out, &mark, &err) || write(way[1], &mark, sizeof mark) != sizeof mark) _exit(1);
        fwrite("lost", 1, 4, out.f);
        fflush(out.f);
        raise(SIGKILL);
    }
    assert_int_equal(read(way[0], &mark, sizeof mark), sizeof mark);
    assert_int_equal(waitpid(child, NULL, 0), child);
    close(way[0]), close(way[1]);
    return mark;
}

static void output_resumes_at_a_mark(void **state)
{
    (void)state;
    for (int gz = 0; gz < 2; gz++) {
        for (int end = 0; end < 3; end++) {
            const char *path = test_path("marked");
            char part[300];
            fl_err err = {0};
            fl_out out = {0}, again = {0};
            fl_file_mark mark;
            int fresh = 1;
            snprintf(part, sizeof part, "%s.part", path);
            if (end == 2) mark = write_and_kill(path, gz);
            else {
                assert_int_equal(fl_out_open(&out, path, gz, &err), 0);
                fwrite(sample, 1, 100000, out.f);
                assert_int_equal(fl_out_mark(&out, &mark, &err), 0);
                fwrite("lost", 1, 4, out.f);
            }
            assert_true(gz ? mark.offset > 0 : mark.offset == 100000);
            if (end == 0) fl_out_abort(&out); /* keeps PATH.part, to which a mark refers */
            if (end == 1) assert_int_equal(fl_out_close(&out, &err), 0);
            assert_int_equal(access(end == 1 ? path : part, F_OK), 0);
            assert_int_equal(fl_out_check_mark(path, &mark, &err), 0);
            assert_int_equal(fl_out_resume(&again, path, gz, &mark, &fresh, &err), 0);
            assert_int_equal(fresh, 0);
            assert_int_equal(access(part, F_OK), 0);
            fwrite(sample + 100000, 1, SIZE - 100000, again.f);
            assert_int_equal(fl_out_close(&again, &err), 0);
            expect_sample(path, 1);
            assert_int_equal(access(part, F_OK), -1);
            unlink(path);
        }
    }
}

static void output_does_not_resume_in_another_file(void **state)
{
    const char *path = test_path("marked");
    fl_err err = {0};
    fl_out out = {0};
    fl_file_mark mark, longer, other, none = {-1, 0};
    int fresh;
    (void)state;
    assert_int_equal(fl_out_open(&out, path, 0, &err), 0);
    fwrite(sample, 1, 5000, out.f);
    assert_int_equal(fl_out_mark(&out, &mark, &err), 0);
    assert_int_equal(fl_out_close(&out, &err), 0);
    longer = other = mark;
    longer.offset++;
    other.tail_hash++;
    assert_int_equal(fl_out_check_mark(path, &mark, &err), 0);
    assert_int_equal(fl_out_check_mark(path, &none, &err), 0);
    const fl_file_mark *const bad[2] = {&longer, &other};
    for (int k = 0; k < 2; k++) {
        fl_err why = {0};
        assert_int_equal(fl_out_check_mark(path, bad[k], &why), -1);
        assert_int_equal(why.code, FL_INPUT);
        why = (fl_err){0};
        assert_int_equal(fl_out_resume(&out, path, 0, bad[k], &fresh, &why), -1);
        assert_int_equal(why.code, FL_INPUT);
        assert_null(out.f);
    }
    /* a device has no positions: output restarts */
    assert_int_equal(fl_out_open(&out, "/dev/null", 0, &err), 0);
    assert_int_equal(fl_out_mark(&out, &mark, &err), 0);
    assert_int_equal(mark.offset, -1);
    assert_int_equal(fl_out_close(&out, &err), 0);
    assert_int_equal(fl_out_resume(&out, "/dev/null", 0, &mark, &fresh, &err), 0);
    assert_int_equal(fresh, 1);
    assert_int_equal(fl_out_close(&out, &err), 0);
    unlink(path);
}

/* Expects the first n bytes of the sample, and no more. */
static void expect_contents(const char *path, int64_t n)
{
    static unsigned char got[SIZE];
    fl_err err = {0};
    assert_int_equal(slurp(path, got, sizeof got, 65536, &err), n);
    assert_memory_equal(got, sample, (size_t)n);
}

/* The second writer of a file is refused, and the first is unaffected; the next one succeeds. */
static void one_writer_at_a_time(void **state)
{
    (void)state;
    for (int gz = 0; gz < 2; gz++) {
        const char *path = test_path("shared");
        fl_out first = {0}, second = {0}, third = {0};
        fl_err err = {0}, none = {0};
        fl_file_mark mark;
        int fresh;
        assert_int_equal(fl_out_open(&first, path, gz, &none), 0);
        fwrite(sample, 1, 5000, first.f);
        assert_int_equal(fl_out_mark(&first, &mark, &none), 0);
        assert_int_equal(fl_out_open(&second, path, gz, &err), -1);
        assert_int_equal(err.code, FL_SYSTEM);
        assert_non_null(strstr(err.text, "it is already being written"));
        err = (fl_err){0};
        assert_int_equal(fl_out_resume(&second, path, gz, &mark, &fresh, &err), -1);
        assert_int_equal(err.code, FL_SYSTEM);
        assert_non_null(strstr(err.text, "it is already being written"));
        fwrite(sample + 5000, 1, 5000, first.f);
        assert_int_equal(fl_out_close(&first, &none), 0);
        expect_contents(path, 10000);
        /* the finished file is resumed by one writer, and then by no other */
        assert_int_equal(fl_out_resume(&second, path, gz, &mark, &fresh, &none), 0);
        err = (fl_err){0};
        assert_int_equal(fl_out_open(&third, path, gz, &err), -1);
        assert_non_null(strstr(err.text, "it is already being written"));
        fwrite(sample + 5000, 1, 50, second.f);
        assert_int_equal(fl_out_close(&second, &none), 0);
        expect_contents(path, 5050);
        /* dropped output leaves no lock */
        assert_int_equal(fl_out_open(&first, path, gz, &none), 0);
        fl_out_abort(&first);
        assert_int_equal(fl_out_open(&second, path, gz, &none), 0);
        fwrite(sample, 1, 10, second.f);
        assert_int_equal(fl_out_close(&second, &none), 0);
        expect_contents(path, 10);
        unlink(path);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(plain_and_gzip),
                                       cmocka_unit_test(tiny_files),
                                       cmocka_unit_test(damaged_gzip),
                                       cmocka_unit_test(unreadable_files_are_reported),
                                       cmocka_unit_test(a_pipe_is_read),
                                       cmocka_unit_test(the_final_name_comes_last),
                                       cmocka_unit_test(unwritable_paths_are_reported),
                                       cmocka_unit_test(a_folder_that_vanishes_is_reported),
                                       cmocka_unit_test(a_full_disk_is_reported),
                                       cmocka_unit_test(unfinished_output_is_kept),
                                       cmocka_unit_test(devices_and_links_stay),
                                       cmocka_unit_test(a_fifo_is_written_directly),
                                       cmocka_unit_test(one_writer_at_a_time),
                                       cmocka_unit_test(output_resumes_at_a_mark),
                                       cmocka_unit_test(output_does_not_resume_in_another_file),
                                       cmocka_unit_test(standard_output_is_written)};
    return cmocka_run_group_tests_name("stream", tests, make_sample, NULL);
}
