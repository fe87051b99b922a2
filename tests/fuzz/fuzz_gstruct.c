/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include "mesh/gstruct.h"
#include "support/fuzz.h"
#include "support/mesh.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_surface s = {0}, again = {0};
    fl_history_line by;
    char *text = NULL;
    size_t len = 0;
    FILE *f;
    int rc = fl_gstruct_read(&s, fuzz_file(data, n), &err), verdict = fuzz_verdict(rc, &err);
    if (verdict != FUZZ_READ) return s.n ? FUZZ_BROKEN : verdict;
    if (!mesh_sound(&s)) verdict = FUZZ_BROKEN;
    f = verdict == FUZZ_READ ? open_memstream(&text, &len) : NULL;
    if (f) {
        fl_history_line_start(&by, "fuzz");
        fl_gstruct_write(f, &s, &by);
        fclose(f);
        rc = fl_gstruct_read(&again, fuzz_file((const unsigned char *)text, len), &err);
        verdict = fuzz_verdict(rc, &err);
        if (verdict == FUZZ_REFUSED || (verdict == FUZZ_READ && !mesh_same(&s, &again)))
            verdict = FUZZ_BROKEN;
    }
    free(text);
    fl_surface_free(&s);
    fl_surface_free(&again);
    return verdict;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "gstruct", fuzz_one); }
