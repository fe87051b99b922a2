/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/table.h"
#include "support/fuzz.h"

/* Every field of every row is read as a word and as a number. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_table t = {0};
    int32_t col = -1;
    int sound = 1, rc = fl_table_open(&t, fuzz_file(data, n), NULL, 1, &err), more;
    if (rc == 0 &&
        (fl_table_require(&t, t.name[t.n - 1], &col, &err) || col != t.n - 1 || !isfinite(t.start)))
        sound = 0;
    while (rc == 0 && sound && (more = fl_table_row(&t, &err)) != 0) {
        rc = more < 0 ? -1 : 0;
        for (int32_t k = 0; rc == 0 && k < t.n; k++) {
            double x = NAN;
            sound &= fl_table_word(&t, k)[0] != '\0';
            rc = fl_table_f64(&t, k, &x, &err);
            sound &= rc || isfinite(x);
        }
    }
    fl_table_close(&t);
    return sound ? fuzz_verdict(rc, &err) : FUZZ_BROKEN;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "table", fuzz_one); }
