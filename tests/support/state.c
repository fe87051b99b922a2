/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/setup.h"
#include "sim/snapshot.h"
#include "support/fuzz.h"
#include "support/state.h"

int state_fuzz(const lab *of, const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_text in = {0};
    fl_world w = {0};
    int rc = -1;
    if (fl_world_make(&w, &of->scene, &of->field, of->surface.n ? &of->surface : NULL, &err) == 0) {
        if (fl_text_open(&in, fuzz_file(data, n), &err) == 0) rc = fl_snapshot_read(&w, &in, &err);
        fl_text_close(&in);
    }
    fl_world_free(&w);
    return fuzz_verdict(rc, &err);
}
