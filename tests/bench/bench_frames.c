/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_frames.c -- frames of 10 000 floes that drift and spin: bytes and time a body and frame, text and
 * packed, written and read, beside the largest error of places and rotations.  Seconds are those of the
 * processor.
 *
 *   bench_frames                               as make bench runs it
 *   bench_frames SPHERES BLOCKS FRAMES FILE    writes packed frames of a sheet of spheres four deep that
 *       drifts and waves, with noise of 0.1 mm, and of blocks adrift beside it; a frame at a time, for
 *       bench/view.sh */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>
#include "base/rng.h"
#include "out/frame_copy.h"
#include "out/frame_file.h"
#include "out/frames.h"

enum { BODIES = 10000, FRAMES = 64 };

static double processor_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Exact pose of a body: drift, and a rotation about an axis of its own. */
static void pose_of(int i, double t, fl_vec3 *x, fl_quat *q)
{
    fl_rng g = fl_rng_of(1, i, FL_RNG_TEST);
    const fl_vec3 at = v3(fl_rng_in(&g, -100, 100), fl_rng_in(&g, -100, 100), 0);
    const fl_vec3 v = v3(fl_rng_in(&g, 0.3, 0.7), fl_rng_in(&g, -0.1, 0.1), 0);
    const double roll = 0.02 * sin(1.3 * t + i), yaw = fl_rng_in(&g, -0.2, 0.2) * t;
    *x = v3_madd(at, t, v);
    x->z = 0.01 * sin(2.0 * t + 0.1 * i);
    *q = q_mul(q_of_vector(v3(0, 0, yaw)), q_of_vector(v3(roll, 0.5 * roll, 0)));
}

static void put_real(FILE *f, double x) { fprintf(f, " %.17g", x); }

/* The text of shapes and of all frames, as dem-solve would write it. */
static long write_text(const char *path)
{
    FILE *f = fopen(path, "w");
    if (!f) return -1;
    fputs("#animation 1\n", f);
    for (int i = 0; i < BODIES; i++) fprintf(f, "shape %d 0.5 1 0\nv 0 0 0\n", i);
    for (int k = 0; k < FRAMES; k++) {
        fprintf(f, "frame %g\n", 0.1 * k);
        for (int i = 0; i < BODIES; i++) {
            fl_vec3 x;
            fl_quat q;
            pose_of(i, 0.1 * k, &x, &q);
            fprintf(f, "body %d", i);
            put_real(f, x.x), put_real(f, x.y), put_real(f, x.z);
            put_real(f, q.w), put_real(f, q.x), put_real(f, q.y), put_real(f, q.z);
            putc('\n', f);
        }
    }
    const long n = ftell(f);
    return fclose(f) ? -1 : n;
}

/* Bytes of all packed frames; *ns: time a body and frame. */
static long write_packed(const char *path, double *ns)
{
    fl_packed_writer w = fl_packed_writer_make(FL_PACKED_BOUND_X, FL_PACKED_BOUND_Q, FL_PACKED_KEY_EVERY);
    FILE *f = fopen(path, "wb");
    fl_err err = {0};
    double spent = 0.0;
    if (!f) return -1;
    fputs("#animation 2\n", f);
    for (int i = 0; i < BODIES; i++) fprintf(f, "shape %d 0.5 1 0\nv 0 0 0\n", i);
    fl_packed_frames_begin(f, &w);
    const long head = ftell(f);
    for (int k = 0; k < FRAMES && !err.code; k++) {
        fl_packed_frame_clear(&w);
        for (int i = 0; i < BODIES; i++) {
            fl_vec3 x;
            fl_quat q;
            pose_of(i, 0.1 * k, &x, &q);
            fl_packed_frame_body(&w, i, x, q, &err);
        }
        const double start = processor_time();
        fl_packed_frame_write(f, &w, 0.1 * k, 1, NULL, &err);
        spent += processor_time() - start;
    }
    *ns = 1e9 * spent / BODIES / FRAMES;
    const long n = ftell(f) - head;
    fl_packed_writer_free(&w);
    return fclose(f) || err.code ? -1 : n;
}

/* Reads all frames; time of the index [s], of a body and frame [ns], largest errors [m], [rad]. */
static int read_all(const char *path, double *index, double *ns, double *dx, double *dq)
{
    fl_err err = {0};
    fl_frame a = {0};
    double start = processor_time();
    fl_frame_file *f = fl_frame_file_open(path, NULL, &err);
    *index = processor_time() - start;
    *ns = *dx = *dq = 0.0;
    for (int k = 0; f && k < FRAMES && !err.code; k++) {
        start = processor_time();
        fl_frame_file_read(f, k, &a, &err);
        *ns += 1e9 * (processor_time() - start) / BODIES / FRAMES;
        for (int i = 0; i < BODIES && !err.code; i++) {
            fl_vec3 x;
            fl_quat q;
            pose_of(i, 0.1 * k, &x, &q);
            const fl_vec3 d = v3_sub(a.x[i], x);
            const fl_quat r = q_mul(a.q[i], q_conj(q));
            *dx = fmax(*dx, fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z))));
            *dq = fmax(*dq, 2.0 * atan2(v3_norm(v3(r.x, r.y, r.z)), fabs(r.w)));
        }
    }
    if (err.code) fprintf(stderr, "bench_frames: %s\n", err.text);
    fl_frame_free(&a);
    fl_frame_file_close(f);
    return err.code ? -1 : 0;
}

/* --- a big file -------------------------------------------------------------------------------- */

struct big {
    int spheres, blocks, side; /* side: spheres in a row of the sheet */
};

/* Noise of a body in a frame, within +-1/2: a hash of both. */
static double noise_of(unsigned i, unsigned k)
{
    unsigned h = i * 0x9E3779B1u ^ k * 0x85EBCA77u;
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 13;
    return (double)h / 4294967296.0 - 0.5;
}

static void big_pose(const struct big *b, int i, int k, fl_vec3 *x, fl_quat *q)
{
    const double t = 0.1 * k, drift = 0.2 * t;
    *q = q_one();
    if (i < b->spheres) {
        const int column = i / 4, row = column / b->side;
        const double px = 0.25 * (column % b->side);
        *x = v3(px + drift + 1e-4 * noise_of((unsigned)i, (unsigned)k), 0.2165 * row,
                0.2 * (i % 4) + 0.1 * sin(0.3 * px - 1.2 * t));
        return;
    }
    const int n = i - b->spheres, side = (int)sqrt((double)b->blocks) + 1;
    const double px = 1.3 * (n % side), py = -1.3 * (1 + n / side);
    *x = v3(px + 0.5 * t, py, 0.1 * sin(0.3 * px - 1.2 * t));
    *q = q_of_vector(v3(0, -0.03 * cos(0.3 * px - 1.2 * t), 0.01 * t * noise_of((unsigned)n, 0)));
}

static void big_shapes(FILE *f, const struct big *b)
{
    for (int i = 0; i < b->spheres; i++) fprintf(f, "shape %d 0.125 1 0\nv 0 0 0\n", i);
    for (int i = b->spheres; i < b->spheres + b->blocks; i++) {
        fprintf(f, "shape %d 0.05 8 6\n", i);
        for (int v = 0; v < 8; v++)
            fprintf(f, "v %g %g %g\n", v & 1 ? 0.5 : -0.5, v & 2 ? 0.5 : -0.5, v & 4 ? 0.2 : -0.2);
        fputs("f 4 0 2 3 1\nf 4 4 5 7 6\nf 4 0 1 5 4\nf 4 2 6 7 3\nf 4 0 4 6 2\nf 4 1 3 7 5\n", f);
    }
}

static int write_big(const struct big *b, int frames, const char *path)
{
    fl_packed_writer w = fl_packed_writer_make(FL_PACKED_BOUND_X, FL_PACKED_BOUND_Q, FL_PACKED_KEY_EVERY);
    FILE *f = fopen(path, "wb");
    fl_err err = {0};
    double spent = 0.0;
    if (!f) {
        perror(path);
        return 1;
    }
    fputs("#animation 2\n", f);
    big_shapes(f, b);
    fl_packed_frames_begin(f, &w);
    for (int k = 0; k < frames && !err.code && !ferror(f); k++) {
        fl_packed_frame_clear(&w);
        for (int i = 0; i < b->spheres + b->blocks; i++) {
            fl_vec3 x;
            fl_quat q;
            big_pose(b, i, k, &x, &q);
            fl_packed_frame_body(&w, i, x, q, &err);
        }
        const double start = processor_time();
        fl_packed_frame_write(f, &w, 0.1 * k, 1, NULL, &err);
        spent += processor_time() - start;
    }
    fl_packed_writer_free(&w);
    if (err.code) fprintf(stderr, "bench_frames: %s\n", err.text);
    else printf("%.0f\n", 1e9 * spent / (b->spheres + b->blocks) / frames); /* [ns] a body and frame */
    return fclose(f) || err.code;
}

int main(int argc, char **argv)
{
    if (argc == 5) {
        struct big b = {atoi(argv[1]), atoi(argv[2]), 0};
        b.side = (int)sqrt(b.spheres / 4.0) + 1;
        return b.spheres < 1 || b.blocks < 0 || atoi(argv[3]) < 1 ? 2 : write_big(&b, atoi(argv[3]), argv[4]);
    }
    char path[] = "/tmp/floe-frames.XXXXXX";
    double ns, index, read_ns, dx, dq;
    const int fd = mkstemp(path);
    int failed = fd < 0;
    if (fd >= 0) close(fd);
    printf("%d floes, %d frames 0.1 s apart\n", BODIES, FRAMES);
    printf("%-8s %8s %10s %10s %10s %10s %10s\n", "form", "bytes", "write[ns]", "index[s]", "read[ns]",
           "error[m]", "error[rad]");
    const long text = write_text(path);
    failed += text < 0 || read_all(path, &index, &read_ns, &dx, &dq);
    if (!failed)
        printf("%-8s %8.1f %10s %10.3f %10.0f %10.2g %10.2g\n", "text", (double)text / BODIES / FRAMES, "-",
               index, read_ns, dx, dq);
    const long packed = write_packed(path, &ns);
    failed += packed < 0 || read_all(path, &index, &read_ns, &dx, &dq);
    if (!failed)
        printf("%-8s %8.1f %10.0f %10.3f %10.0f %10.2g %10.2g\n", "packed", (double)packed / BODIES / FRAMES,
               ns, index, read_ns, dx, dq);
    if (!failed) printf("a packed frame of %d floes is written in %.2f ms\n", BODIES, 1e-6 * ns * BODIES);
    unlink(path);
    printf("%d passed, %d failed\n", !failed, failed != 0);
    return failed != 0;
}
