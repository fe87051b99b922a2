/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "water/current.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_current c = {0};
    const int rc = fl_current_read(&c, fuzz_file(data, n), &err);
    if (rc == 0) {
        const double most = fl_current_max_speed(&c);
        for (int k = -30; k < 5; k++)
            if (!(v3_norm(fl_current_at(&c, k)) <= most * (1.0 + 1e-12)))
                return fuzz_verdict(0, &(fl_err){.code = FL_NUMERIC});
    }
    fl_current_free(&c);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "current", fuzz_one); }
