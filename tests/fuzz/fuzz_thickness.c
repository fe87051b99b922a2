/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "ice/thickness.h"

/* A thickness law that was read also gives numbers. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_thickness t = {0};
    int32_t again;
    int rc = fl_thickness_read(&t, fuzz_file(data, n), &err);
    if (rc == 0 && !(fl_thickness_draw(&t, 1, 2, 0.0, &again) > 0.0))
        rc = fl_fail(&err, FL_NUMERIC, "a thickness that is none");
    fl_thickness_free(&t);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "thickness", fuzz_one); }
