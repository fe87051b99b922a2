/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of frames: text, gzip, packed, cut off, wrong. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>
#include "out/frame_copy.h"
#include "support/near.h"
#include "view/playback.h"

static char path[80];
static const char HEAD[] =
    "#animation 1\n#by test\nshape 3 0.5 1 0\nv 0 0 0\nshape 9 0.1 4 4\nv 1 1 1\nv 1 -1 -1\nv -1 1 -1\n"
    "v -1 -1 1\nf 3 0 2 1\nf 3 0 1 3\nf 3 0 3 2\nf 3 1 2 3\npart 1 leg\nv 0 0 0\nv 1 0 0\nv 0 1 0\nt 0 1 2\n"
    "cone 0 0 0 1 0 0 1 0.5\n";
static const char FRAMES[] =
    "frame 0\nbody 3 1 2 3 1 0 0 0\nbody 9 4 5 6 0.6 0.8 0 0\n"
    "frame 0.5\nstructure 0.1 0 0\n"
    "frame 1\nbody 9 5 5 6 0.6 -0.8 0 0\nmoved 1 1 0 0 0 0 0 1\n"
    "shape 4 0.2 1 0\nv 0 0 0\nframe 2\nbody 9 6 5 6 1 0 0 0\nbody 4 0 0 0 1 0 0 0\n";

static void write_file(const char *text, size_t n)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(text, 1, n, f), n);
    assert_int_equal(fclose(f), 0);
}

static void write_text(const char *a, const char *b)
{
    char text[4000];
    snprintf(text, sizeof text, "%s%s", a, b);
    write_file(text, strlen(text));
}

/* What the four frames hold, in any form. */
static const double T[4] = {0, 0.5, 1, 2}, X9[4] = {4, 4, 5, 6}, PART_X[4] = {0, 0.1, 1, 0};
static void check_frames(fl_frame_file *f, double bound)
{
    const fl_frame_data *d = fl_frame_file_data(f);
    fl_err err = {0};
    fl_frame a = {0};
    assert_int_equal(d->frames, 4);
    assert_int_equal(d->rows, 3);
    assert_int_equal(d->structure.n, 1);
    assert_int_equal(d->structure.part[0].nt, 1);
    assert_int_equal(d->structure.part[0].nc, 1);
    const int32_t three = fl_frame_data_row(d, 3), nine = fl_frame_data_row(d, 9),
                  four = fl_frame_data_row(d, 4);
    assert_int_equal(fl_frame_data_row(d, 5), -1);
    for (int back = 0; back < 2; back++) /* forward, then backward */
        for (int i = 0; i < 4; i++) {
            const int k = back ? 3 - i : i;
            assert_int_equal(fl_frame_file_read(f, k, &a, &err), 0);
            assert_near(a.t, T[k], 0);
            assert_int_equal(a.there[three], k < 2);
            assert_int_equal(a.there[four], k == 3);
            assert_near_of(a.x[nine].x, X9[k], bound, 1.0);
            assert_near_of(fabs(a.q[nine].x), k < 3 ? 0.8 : 0.0, bound, 1.0);
            assert_near(a.part_x[0].x, PART_X[k], 0);
            assert_near(fabs(a.part_q[0].z), k == 2, 0);
        }
    fl_frame_free(&a);
}

static void text_is_read_at_random(void **state)
{
    (void)state;
    fl_err err = {0};
    write_text(HEAD, FRAMES);
    fl_frame_file *f = fl_frame_file_open(path, NULL, &err);
    assert_non_null(f);
    assert_null(fl_frame_file_warning(f));
    assert_string_equal(fl_frame_file_history(f), "#by test\n");
    check_frames(f, 1e-15);
    fl_frame_file_close(f);
}

static void gzip_and_packed_hold_the_same(void **state)
{
    (void)state;
    fl_err err = {0};
    char packed[120];
    snprintf(packed, sizeof packed, "%s.packed", path);
    gzFile z = gzopen(path, "wb");
    gzputs(z, HEAD);
    gzclose(z);
    z = gzopen(path, "ab"); /* a second member */
    gzputs(z, FRAMES);
    gzclose(z);
    fl_frame_file *f = fl_frame_file_open(path, NULL, &err);
    assert_non_null(f);
    check_frames(f, 1e-15);
    fl_packed_writer w = fl_packed_writer_make(1e-5, 1e-5, 2);
    const fl_frame_copy how = {-INFINITY, INFINITY, 1, &w};
    fl_history_line by;
    fl_history_line_start(&by, "test");
    FILE *out = fopen(packed, "wb");
    assert_int_equal(fl_frame_copy_write(out, f, &how, &by, &err), 0);
    const long size = ftell(out);
    fclose(out);
    fl_packed_writer_free(&w);
    fl_frame_file_close(f);
    f = fl_frame_file_open(packed, NULL, &err);
    assert_non_null(f);
    check_frames(f, 1e-5);
    fl_frame_file_close(f);
    /* cut in its last frame */
    assert_int_equal(truncate(packed, size - 5), 0);
    f = fl_frame_file_open(packed, NULL, &err);
    assert_non_null(f);
    assert_int_equal(fl_frame_file_data(f)->frames, 3);
    assert_non_null(strstr(fl_frame_file_warning(f), "cut off"));
    fl_frame_file_close(f);
    /* a bit of the last whole frame turned */
    out = fopen(packed, "r+b");
    fseek(out, size - 100, SEEK_SET);
    const int byte = fgetc(out);
    fseek(out, size - 100, SEEK_SET);
    fputc(byte ^ 64, out);
    fclose(out);
    fl_frame a = {0};
    f = fl_frame_file_open(packed, NULL, &err);
    for (int32_t k = 0; f && k < fl_frame_file_data(f)->frames && !err.code; k++)
        fl_frame_file_read(f, k, &a, &err);
    assert_int_equal(err.code, FL_INPUT);
    fl_frame_free(&a);
    fl_frame_file_close(f);
    unlink(packed);
}

/* The last line lacks its end: the frame before it is the last. */
static void a_cut_file_ends_at_its_last_whole_frame(void **state)
{
    (void)state;
    fl_err err = {0};
    write_text(HEAD, FRAMES);
    const size_t n = strlen(HEAD) + strlen(FRAMES);
    for (size_t cut = n - 30; cut < n; cut++) {
        const char before = FRAMES[cut - strlen(HEAD) - 1];
        if (before == '\n') continue; /* the end of a line cannot be told from the end of the file */
        assert_int_equal(truncate(path, (off_t)cut), 0);
        fl_frame_file *f = fl_frame_file_open(path, NULL, &err);
        assert_non_null(f);
        assert_int_equal(fl_frame_file_data(f)->frames, 3);
        assert_non_null(fl_frame_file_warning(f));
        fl_frame_file_close(f);
        write_text(HEAD, FRAMES);
    }
}

/* The file of a run under way: NAME.part grows, in pieces that end anywhere; what is whole is shown. */
static void a_run_under_way_is_followed(void **state)
{
    (void)state;
    fl_err err = {0};
    char part[120], name[80], all[4000], line[200];
    fl_frame a = {0};
    strcpy(name, path);
    unlink(name);
    snprintf(part, sizeof part, "%s.part", name);
    snprintf(path, sizeof path, "%.79s", part);
    snprintf(all, sizeof all, "%s", HEAD);
    for (int k = 0; k < 12; k++) {
        snprintf(line, sizeof line, "frame %d\nbody 3 %d 0 0 1 0 0 0\nbody 9 %d 0 1 1 0 0 0\n", k, k, 2 * k);
        strcat(all, line);
    }
    size_t n = strlen(HEAD) + 140;
    write_file(all, n);
    fl_frame_file *f = fl_frame_file_open(name, NULL, &err);
    assert_non_null(f);
    int32_t frames = fl_frame_file_data(f)->frames;
    assert_true(frames >= 1 && frames < 12);
    for (n += 17; n < strlen(all); n += 17) {
        write_file(all, n);
        const int32_t more = fl_frame_file_extend(f, &err);
        assert_true(more >= 0 && more <= 1);
        frames += more;
        assert_int_equal(fl_frame_file_data(f)->frames, frames);
        assert_int_equal(fl_frame_file_read(f, frames - 1, &a, &err), 0);
        assert_near(a.t, frames - 1, 0);
        assert_near(a.x[1].x, 2.0 * (frames - 1), 0);
    }
    assert_true(frames >= 10);
    fl_frame_free(&a);
    fl_frame_file_close(f);
    unlink(part);
    strcpy(path, name);
}

static void refused(const char *frames, const char *sentence)
{
    fl_err err = {0};
    fl_frame a = {0};
    write_text(HEAD, frames);
    fl_frame_file *f = fl_frame_file_open(path, NULL, &err);
    for (int32_t k = 0; f && k < fl_frame_file_data(f)->frames && !err.code; k++)
        fl_frame_file_read(f, k, &a, &err);
    assert_int_equal(err.code, FL_INPUT);
    if (!strstr(err.text, sentence)) fail_msg("\"%s\" lacks \"%s\"", err.text, sentence);
    fl_frame_free(&a);
    fl_frame_file_close(f);
}

static void what_is_wrong_has_file_and_line(void **state)
{
    (void)state;
    refused("", "the file has no frame");
    refused("frame 0\nbody 8 0 0 0 1 0 0 0\n", ":21: body 8 has no shape before this frame");
    refused("frame 0\nbody 3 0 0 nan 1 0 0 0\n", ":21: a coordinate is missing, no number, or beyond 1e+09");
    refused("frame 0\nbody 3 0 0 0 1 0.1 0 0\n", ":21: body 3 has no rotation of length 1");
    refused("frame 0\nbody 3 0 0 0 1 0 0 0\nbody 3 0 0 0 1 0 0 0\n", ":22: body 3 stands twice in the frame");
    refused("frame 0\nbody 3 0 0 0 1 0 0 0 7\n", ":21: more fields than the record has");
    refused("frame 1\nframe 0.5\n", ":21: time 0.5 s does not follow 1 s");
    refused("frame inf\n", ":20: the time is missing");
    refused("frame 0\nmoved 4 0 0 0 1 0 0 0\n", ":21: part 4 is not in the file");
    refused("body 3 0 0 0 1 0 0 0\n", ":20: a pose before the first frame");
    refused("sheep 3\n", ":20: \"sheep\" is no record of an animation");
    refused("shape 7 1 4 4\nv 0 0 0\nframe 0\n", ":20: shape 7 lacks 3 vertices and 4 faces");
    refused("shape 7 1 3 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 3 0 1 3\n",
            ":24: a corner is missing, or no whole number from 0 to 2");
    refused("shape 7 -1 1 0\n", ":20: the radius is below 0");
    refused("packed 1e-5 1e-5 0\n", ":20: the number of frames between keys");
}

/* 0.5 m/s along x and 0.2 rad/s about z: places between frames are exact, speed and spin to rounding. */
static void motion_between_frames_is_linear(void **state)
{
    (void)state;
    fl_err err = {0};
    fl_playback p = {0};
    char text[400];
    const double a = 0.5 * 0.2 * 2.0; /* half of the angle after 2 s */
    snprintf(text, sizeof text, "frame 0\nbody 3 0 0 0 1 0 0 0\nframe 2\nbody 3 1 0 0 %.17g 0 0 %.17g\n",
             cos(a), sin(a));
    write_text(HEAD, text);
    fl_frame_file *f = fl_frame_file_open(path, NULL, &err);
    assert_non_null(f);
    assert_int_equal(fl_playback_open(&p, f, NULL, NULL, &err), 0);
    for (int k = -1; k <= 9; k++) {
        const double t = 0.25 * k, at = fmin(2.0, fmax(0.0, t));
        assert_int_equal(fl_playback_at(&p, t, &err), 0);
        assert_near_of(p.now.t, at, 1e-15, 1.0);
        assert_near_of(p.now.x[0].x, 0.5 * at, 1e-15, 1.0);
        assert_near(v3_norm(p.now.v[0]), 0.5, 1e-15);
        assert_near(p.now.w[0].z, 0.2, 1e-14);
        assert_int_equal(p.now.there[1], 0);
    }
    fl_playback_close(&p);
    fl_frame_file_close(f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_read_at_random),
        cmocka_unit_test(gzip_and_packed_hold_the_same),
        cmocka_unit_test(a_cut_file_ends_at_its_last_whole_frame),
        cmocka_unit_test(a_run_under_way_is_followed),
        cmocka_unit_test(what_is_wrong_has_file_and_line),
        cmocka_unit_test(motion_between_frames_is_linear),
    };
    strcpy(path, "/tmp/floe-frames.XXXXXX");
    close(mkstemp(path));
    const int rc = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    return rc;
}
