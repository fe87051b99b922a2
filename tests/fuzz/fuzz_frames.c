/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "out/frame_file.h"
#include "support/fuzz.h"
#include "view/rounded_mesh.h"

/* Every frame of a file that opens is read or refused; a frame that was read has finite poses, and shapes
 * that can be drawn. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_frame a = {0};
    fl_frame_file *f = fl_frame_file_open(fuzz_file(data, n), NULL, &err);
    int rc = f ? 0 : -1;
    const fl_frame_data *d = f ? fl_frame_file_data(f) : NULL;
    for (int32_t k = 0; rc == 0 && k < d->frames && k < 50; k++) {
        rc = fl_frame_file_read(f, d->frames - 1 - k, &a, &err);
        for (int32_t r = 0; rc == 0 && r < a.rows; r++)
            if (a.there[r] && !(v3_finite(a.x[r]) && isfinite(a.q[r].w)))
                rc = fl_fail(&err, FL_NUMERIC, "a pose that is none");
    }
    for (int32_t s = 0; rc == 0 && s < d->shapes && s < 50; s++) {
        fl_rounded_mesh m = {0};
        rc = fl_rounded_mesh_shape(&m, d, &d->shape[s], 2, &err);
        fl_rounded_mesh_free(&m);
    }
    fl_frame_free(&a);
    fl_frame_file_close(f);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "frames", fuzz_one); }
