/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "ice/concentration_gradient.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_concentration_gradient g = {0};
    const int rc = fl_concentration_read(&g, 0.5, fuzz_file(data, n), &err);
    if (rc == 0) {
        const double c = fl_concentration_at(&g, (fl_vec2){g.s[g.n / 2], 1.0});
        if (!(c > 0.0 && c < 1.0)) return fuzz_verdict(0, &(fl_err){.code = FL_NUMERIC});
    }
    fl_concentration_free(&g);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "concentration_gradient", fuzz_one); }
