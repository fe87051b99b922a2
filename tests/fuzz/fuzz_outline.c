/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "ice/domain_read.h"

/* An outline that was read also cuts cells of a few sites. */
static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_domain d = {0};
    int rc = fl_domain_read(&d, fuzz_file(data, n), &err);
    if (rc == 0) rc = fl_domain_build(&d, &err);
    if (rc == 0) {
        const fl_vec2 site[3] = {{d.lo.x, d.lo.y}, {d.hi.x, d.hi.y}, {d.lo.x, d.hi.y}};
        fl_power_cells cells = {0};
        fl_pieces p = {0};
        fl_err why = {0};
        /* sites may coincide where a box is flat to rounding: then nothing is cut */
        if (fl_power_cells_build(&cells, 3, site, (fl_vec2){d.lo.x - 1.0, d.lo.y - 1.0},
                                 (fl_vec2){d.hi.x + 1.0, d.hi.y + 1.0}, &why) == 0)
            rc = fl_domain_cut(&p, &cells, &d, 0.0, &err);
        else if (why.code == FL_SYSTEM) rc = fl_fail(&err, FL_SYSTEM, "%s", why.text);
        fl_pieces_free(&p);
        fl_power_cells_free(&cells);
    }
    fl_domain_free(&d);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "outline", fuzz_one); }
