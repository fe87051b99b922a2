/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "ice/sizes_read.h"
#include "support/fuzz.h"

/* Sizes that were read are a law: they ascend, sums are finite, all values lie between the smallest and the
 * largest, and a thousand floes drawn from the law have the given mean. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_sizes s = {0};
    static double area[1000];
    double sum = 0.0;
    int sound = 1, rc = fl_sizes_read(&s, fuzz_file(data, n), &err);
    if (rc == 0) {
        const double mean = fl_sizes_mean(&s);
        sound = s.n > 0 && s.cumulative_area[0] == 0.0 && s.cumulative_count[0] == 0.0 && isfinite(mean);
        for (int32_t k = 0; k < s.n; k++)
            sound &= s.area[k] > 0.0 && s.cumulative_count[k + 1] >= s.cumulative_count[k] &&
                     s.cumulative_area[k + 1] >= s.cumulative_area[k] &&
                     (k == 0 || s.area[k] >= s.area[k - 1]);
        sound &= mean >= s.area[0] * (1.0 - 1e-9) && mean <= s.area[s.n - 1] * (1.0 + 1e-9);
        fl_sizes_areas(&s, 1000, 2.0, area);
        for (int k = 0; k < 1000; k++) sum += area[k];
        sound &= fabs(sum - 2000.0) <= 1e-6;
        sound &= fl_sizes_cdf(&s, mean, 1.001 * s.area[s.n - 1]) == 1.0;
    }
    fl_sizes_free(&s);
    return sound ? fuzz_verdict(rc, &err) : FUZZ_BROKEN;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "sizes", fuzz_one); }
