/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "mesh/inp_model.h"

void fl_inp_model_free(fl_inp_model *r)
{
    fl_inp_line_free(&r->line);
    fl_elements_free(&r->e);
    fl_elements_free(&r->part_defs);
    fl_element_sets_free(&r->sets);
    free(r->part);
    free(r->section);
    *r = (fl_inp_model){0};
}

int fl_inp_set_location(fl_inp_model *r, fl_err *err)
{
    if (r->store == &r->e) return 0;
    while (r->part_defs.files.n <= r->e.file)
        if (fl_elements_set_file(&r->part_defs, r->e.files.name[r->part_defs.files.n], err)) return -1;
    r->part_defs.file = r->e.file;
    r->part_defs.line = r->e.line;
    return 0;
}

fl_vec3 fl_inp_transform(const fl_affine *m, fl_vec3 x) { return v3_add(m3_mul(m->q, x), m->t); }

void fl_inp_leave_part(fl_inp_model *r)
{
    r->store = &r->e;
    r->scope = r->instance = 0;
    r->transform = r->system = fl_affine_identity();
}

int fl_inp_follow_input(fl_inp_model *r, fl_err *err)
{
    const char *path = fl_inp_param(&r->line, "INPUT");
    return path ? fl_deck_include(&r->line.deck, path, err) : 0;
}

int fl_inp_skip_data(fl_inp_model *r, fl_err *err)
{
    int more;
    while ((more = fl_inp_next(&r->line, err)) == 2) {}
    if (more == 1) fl_deck_unread(&r->line.deck);
    return more < 0 ? -1 : 0;
}

int fl_inp_count_generated(fl_inp_model *r, int64_t n, fl_err *err)
{
    if (n > FL_INP_GENERATED_MAX - r->generated)
        return fl_deck_fail(&r->line.deck, err,
                            "more than %d nodes and elements are generated: export them all",
                            FL_INP_GENERATED_MAX);
    r->generated += (int32_t)n;
    return 0;
}
