/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings of a picture; colours; pictures as files; the camera. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>
#include "base/pi.h"
#include "support/near.h"
#include "view/camera.h"
#include "view/edge_smoothing.h"
#include "view/look.h"
#include "view/picture_file.h"

static fl_err err;
static char path[64];

static void a_look_reads_back(void **state)
{
    (void)state;
    fl_look a = fl_look_defaults(), b = fl_look_defaults();
    char *one = NULL, *two = NULL;
    size_t n = 0, m = 0;
    assert_int_equal(fl_look_set(&a, "view.azimuth", "12.25", "test", FL_USAGE, &err), 0);
    assert_int_equal(fl_look_set(&a, "view.distance", "0.1", "test", FL_USAGE, &err), 0);
    assert_int_equal(fl_look_set(&a, "colour.map", "cividis", "test", FL_USAGE, &err), 0);
    assert_int_equal(fl_look_set(&a, "water.colour", "0.5,0,1", "test", FL_USAGE, &err), 0);
    assert_int_equal(fl_look_set(&a, "colour.column", "energy", "test", FL_USAGE, &err), 0);
    FILE *f = fopen(path, "w");
    fl_look_write(f, &a);
    fclose(f);
    assert_int_equal(fl_look_read(&b, path, &err), 0);
    f = open_memstream(&one, &n);
    fl_look_write(f, &a);
    fclose(f);
    f = open_memstream(&two, &m);
    fl_look_write(f, &b);
    fclose(f);
    assert_int_equal(n, m);
    assert_memory_equal(one, two, n);
    free(one);
    free(two);
}

static void refused(const char *text, const char *sentence)
{
    fl_look l = fl_look_defaults();
    fl_err e = {0};
    FILE *f = fopen(path, "w");
    fputs(text, f);
    fclose(f);
    assert_int_equal(fl_look_read(&l, path, &e), -1);
    if (!strstr(e.text, sentence)) fail_msg("\"%s\" lacks \"%s\"", e.text, sentence);
}

static void what_is_wrong_has_file_and_line(void **state)
{
    (void)state;
    refused("", "empty");
    refused("#look 2\n", "newer");
    refused("#look 1\n[view]\nazimut = 3\n",
            ":3: there is no setting \"view.azimut\", the nearest is view.azimuth");
    refused("#look 1\n[view]\nazimuth = 1e9\n",
            ":3: view.azimuth is \"1e9\", expected a number from -3600 to 3600");
    refused("#look 1\n[view]\nprojection = flat\n", "expected perspective or parallel");
    refused("#look 1\n[ice]\ncolour = snow\n", "expected a colour as 3a7fb0");
    refused("#look 1\nazimuth\n", ":2: \"azimuth\" is neither [section] nor key = value");
}

/* Lightness of the maps for the colour-blind rises all the way: weights of BT.709. */
static void maps_rise_in_lightness(void **state)
{
    (void)state;
    const int even[3] = {FL_MAP_VIRIDIS, FL_MAP_CIVIDIS, FL_MAP_MAGMA};
    for (int k = 0; k < 3; k++) {
        double last = -1.0;
        for (int i = 0; i <= 100; i++) {
            const fl_rgb c = fl_colour_map_at(even[k], 0.01 * i);
            const double y = 0.2126 * c.c[0] + 0.7152 * c.c[1] + 0.0722 * c.c[2];
            assert_true(y > last - 1.0); /* whole numbers: one step of rounding */
            last = y;
        }
    }
    const fl_rgb lo = fl_colour_map_at(FL_MAP_VIRIDIS, -3), hi = fl_colour_map_at(FL_MAP_VIRIDIS, 7);
    assert_int_equal(lo.c[0], 68);
    assert_int_equal(hi.c[0], 253);
    assert_int_equal(fl_colour_map_at(FL_MAP_VIRIDIS, NAN).c[1], 150);
}

static uint32_t big(const unsigned char *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

/* A picture of random pixels as PNG: chunks with their sums, and the pixels by undoing filter Up. */
static void a_png_holds_the_pixels(void **state)
{
    (void)state;
    enum { W = 7, H = 5 };
    fl_picture p = {0};
    unsigned char raw[H * (3 * W + 1)], above[3 * W] = {0};
    char *file = NULL;
    size_t n = 0;
    uLongf len = sizeof raw;
    assert_int_equal(fl_picture_make(&p, W, H, &err), 0);
    for (int k = 0; k < 4 * W * H; k++) p.px[k] = (unsigned char)(k * 73 + k * k);
    FILE *f = open_memstream(&file, &n);
    assert_int_equal(fl_png_write(f, &p, 6, &err), 0);
    fclose(f);
    const unsigned char *at = (unsigned char *)file + 8;
    assert_memory_equal(file, "\x89PNG\r\n\x1a\n", 8);
    for (int chunk = 0; chunk < 3; chunk++) {
        const uint32_t size = big(at);
        assert_int_equal(big(at + 8 + size), crc32(0, at + 4, size + 4));
        if (chunk == 0) assert_int_equal(big(at + 8), W);
        if (chunk == 1) assert_int_equal(uncompress(raw, &len, at + 8, size), Z_OK);
        at += size + 12;
    }
    assert_int_equal(at - (unsigned char *)file, n);
    assert_int_equal(len, sizeof raw);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < 3 * W; x++) {
            above[x] = (unsigned char)(above[x] + raw[y * (3 * W + 1) + 1 + x]);
            assert_int_equal(above[x], p.px[4 * (y * W + x / 3) + x % 3]);
        }
    free(file);
    fl_picture_free(&p);
}

/* An even picture stays as it is; grey has neutral colour; black and white have the limits of BT.709. */
static void even_pictures_stay(void **state)
{
    (void)state;
    enum { W = 8, H = 6 };
    unsigned char from[4 * W * H], to[4 * W * H], y[W * H], yuv[W * H * 3 / 2];
    for (int level = 0; level < 256; level += 51) {
        memset(from, level, sizeof from);
        fl_smooth_edges(from, W, H, y, to);
        assert_memory_equal(from, to, sizeof from);
        fl_picture_to_yuv(from, W, H, yuv);
        assert_true(abs(yuv[0] - (16 + level * 219 / 255)) <= 1);
        assert_int_equal(yuv[W * H], 128);
        assert_int_equal(yuv[W * H * 5 / 4], 128);
    }
}

/* What a ray meets is drawn where the ray came from. */
static void rays_and_matrices_agree(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++) {
        const fl_camera c = {v3(3, -4, 1), 0.7, 0.4, 30, 0.6, parallel};
        const fl_eye eye = fl_camera_eye(&c, 640, 400, v3(0, 0, 0), 20);
        for (int k = 0; k < 20; k++) {
            fl_vec3 from, along;
            const double px = 31 * k, py = (17 * k) % 400;
            fl_camera_ray(&c, 640, 400, px, py, &from, &along);
            const fl_vec3 x = v3_madd(from, 20.0 + k, along);
            const float *m = eye.both.m, p[3] = {(float)x.x, (float)x.y, (float)x.z};
            double clip[4];
            for (int i = 0; i < 4; i++) clip[i] = m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i];
            /* single precision: some 1e-6 of half of 640 pixels */
            assert_near_of(0.5 * (clip[0] / clip[3] + 1) * 640 - 0.5, px, 1e-2, 1.0);
            assert_near_of(0.5 * (1 - clip[1] / clip[3]) * 400 - 0.5, py, 1e-2, 1.0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_look_reads_back),      cmocka_unit_test(what_is_wrong_has_file_and_line),
        cmocka_unit_test(maps_rise_in_lightness), cmocka_unit_test(a_png_holds_the_pixels),
        cmocka_unit_test(even_pictures_stay),     cmocka_unit_test(rays_and_matrices_agree),
    };
    strcpy(path, "/tmp/floe-look.XXXXXX");
    close(mkstemp(path));
    const int rc = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    return rc;
}
