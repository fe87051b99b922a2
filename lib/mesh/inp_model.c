/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/mem.h"
#include "mesh/inp_model.h"

void fl_inp_model_free(fl_inp_model *r)
{
    fl_inp_end(&r->at);
    fl_elements_free(&r->e);
    fl_elements_free(&r->defs);
    fl_roster_free(&r->roster);
    free(r->part);
    free(r->section);
    *r = (fl_inp_model){0};
}

int fl_inp_here(fl_inp_model *r, fl_err *err)
{
    if (r->store == &r->e) return 0;
    while (r->defs.files.n <= r->e.file)
        if (fl_elements_file(&r->defs, r->e.files.name[r->defs.files.n], err)) return -1;
    r->defs.file = r->e.file;
    r->defs.line = r->e.line;
    return 0;
}

fl_vec3 fl_inp_apply(const fl_similar *m, fl_vec3 x) { return v3_add(m3_mul(m->q, x), m->t); }

void fl_inp_outside(fl_inp_model *r)
{
    r->store = &r->e;
    r->room = r->place = 0;
    r->moved = r->system = fl_similar_one();
}

int fl_inp_input(fl_inp_model *r, fl_err *err)
{
    const char *path = fl_inp_param(&r->at, "INPUT");
    return path ? fl_deck_include(&r->at.deck, path, err) : 0;
}

int fl_inp_pass_over(fl_inp_model *r, fl_err *err)
{
    int more;
    while ((more = fl_inp_next(&r->at, err)) == 2) {}
    if (more == 1) fl_deck_hold(&r->at.deck);
    return more < 0 ? -1 : 0;
}

int fl_inp_make(fl_inp_model *r, int64_t n, fl_err *err)
{
    if (n > FL_INP_MADE - r->made)
        return fl_deck_fail(&r->at.deck, err,
                            "more than %d nodes and elements are generated: export them all", FL_INP_MADE);
    r->made += (int32_t)n;
    return 0;
}
