/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/prescribed_track.h"
#include "support/fuzz.h"

/* A track that was read has a finite pose at every time. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_track tr = {0};
    int rc = fl_track_read(&tr, fuzz_file(data, n), 1, &err);
    for (int k = -2; rc == 0 && k < 10; k++) {
        fl_pose6 x, rate, second;
        fl_track_evaluate(&tr, 0.5 * k, &x, &rate, &second);
        if (!isfinite(x.x.x + x.x.y + x.x.z + x.r.x + x.r.y + x.r.z))
            rc = fl_fail(&err, FL_NUMERIC, "a place that is none");
    }
    fl_track_free(&tr);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "track", fuzz_one); }
