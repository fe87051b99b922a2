/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "block/joint_set.h"
#include "support/fuzz.h"

/* Sets that were read have unit normals, and planes over a finite range. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_joint_sets s = {0};
    const fl_aabb box = {{0, 0, 0}, {1, 1, 1}};
    int rc = fl_joint_sets_read(&s, fuzz_file(data, n), &err);
    fl_joint_sets_sort(&s);
    for (int32_t k = 0; rc == 0 && k < s.n; k++) {
        int32_t first = 0, last = 0;
        if (!(fabs(v3_norm(fl_joint_set_normal(&s.set[k])) - 1.0) < 1e-12))
            rc = fl_fail(&err, FL_NUMERIC, "a normal without length 1");
        if (s.set[k].spacing > 0.0 && s.set[k].spacing < 1e-3) continue; /* a million planes */
        if (v3_norm(s.set[k].origin) > 10.0 || s.set[k].deviation > 0.0) continue;
        fl_joint_set_range(&s.set[k], k, box, 1, &first, &last);
        for (int32_t p = first; rc == 0 && p <= last && p < first + 100; p++)
            if (!isfinite(fl_joint_set_plane(&s.set[k], k, p, 1).c))
                rc = fl_fail(&err, FL_NUMERIC, "a plane that is nowhere");
    }
    fl_joint_sets_free(&s);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "joints", fuzz_one); }
