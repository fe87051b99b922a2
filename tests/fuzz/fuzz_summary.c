/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "stat/summary_file.h"
#include "support/fuzz.h"

/* A summary that was read merges with itself, and its text reads back to the same. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_summary s = {0}, again = {0};
    char *text[2] = {NULL, NULL};
    size_t size[2] = {0, 0};
    int rc = fl_summary_read(&s, fuzz_file(data, n), &err), sound = 1;
    for (int k = 0; k < 2 && rc == 0; k++) {
        FILE *f = open_memstream(&text[k], &size[k]);
        if (!f) break;
        rc = fl_summary_write(f, k ? &again : &s, &err);
        fclose(f);
        if (k == 0 && rc == 0)
            rc = fl_summary_read(&again, fuzz_file((const unsigned char *)text[0], size[0]), &err);
    }
    if (rc == 0) {
        double moment[4];
        sound = text[1] && size[0] == size[1] && memcmp(text[0], text[1], size[0]) == 0;
        for (int32_t k = 0; k < s.n; k++) {
            fl_summary_moments(&s.entry[k], moment);
            sound &= isfinite(moment[0]) && (moment[1] >= 0.0 || isnan(moment[1]));
        }
        rc = fl_summary_merge(&s, &again, "again", &err);
    }
    free(text[0]);
    free(text[1]);
    fl_summary_free(&s);
    fl_summary_free(&again);
    return sound ? fuzz_verdict(rc, &err) : FUZZ_BROKEN;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "summary", fuzz_one); }
