/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/panels.h"
#include "support/fuzz.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_panels p = {0};
    int more = 1, rc = fl_panels_open(&p, fuzz_file(data, n), &err);
    while (rc == 0 && (more = fl_panels_next(&p, &err)) > 0)
        for (int32_t k = 0; k < p.n; k++)
            if (!(p.panel[k].area > 0.0) || !isfinite(v3_norm(p.panel[k].force)) || !(p.edge[1] > p.edge[0]))
                rc = FUZZ_BROKEN;
    if (rc == 0 && more < 0) rc = -1;
    fl_panels_close(&p);
    return rc == FUZZ_BROKEN ? FUZZ_BROKEN : fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "panels", fuzz_one); }
