/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "pack/grading.h"
#include "support/fuzz.h"

/* A grading that was read has a rising curve by mass from 0 to 1, and sizes above 0. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_grading g = {0};
    int rc = fl_grading_read(&g, fuzz_file(data, n), 0, &err);
    const double lo = rc ? 1.0 : fl_grading_least(&g), hi = rc ? 1.0 : fl_grading_most(&g);
    double before = 0.0;
    for (int k = 0; rc == 0 && k <= 10; k++) {
        const double p = fl_grading_mass(&g, 3, k == 10 ? hi : lo * pow(hi / lo, 0.1 * k));
        if (!(p >= before - 1e-9 && p <= 1.0 + 1e-9)) rc = fl_fail(&err, FL_NUMERIC, "a curve that is none");
        before = p;
    }
    if (rc == 0 && !(lo > 0.0 && hi >= lo && fabs(before - 1.0) < 1e-9))
        rc = fl_fail(&err, FL_NUMERIC, "a curve that does not end at 1");
    fl_grading_free(&g);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "grading", fuzz_one); }
