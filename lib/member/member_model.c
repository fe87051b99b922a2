/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_model.h"
#include <stdlib.h>
#include "base/array.h"

/* Sine of the smallest angle between ref and member. */
static const double PARALLEL = 1e-6;

int fl_member_frame(const fl_member_model *m, int32_t k, fl_vec3 e[3], double *length, fl_err *err)
{
    const fl_member *b = &m->member[k];
    const fl_vec3 d = v3_sub(fl_member_end(m, k, 1), fl_member_end(m, k, 0));
    *length = v3_norm(d);
    if (!(*length > 0.0))
        return fl_fail(err, FL_INPUT,
                       "%s:%lld: member %s has no length: its ends at nodes %s and %s are at one place",
                       m->file, (long long)b->line, m->member_name.name[k], m->node_name.name[b->end[0]],
                       m->node_name.name[b->end[1]]);
    e[0] = v3_scale(1.0 / *length, d);
    fl_vec3 ref = b->has_ref ? b->ref : v3(0, 0, 1);
    fl_vec3 side = v3_cross(ref, e[0]);
    if (!b->has_ref && v3_norm(side) < PARALLEL) side = v3_cross(v3(1, 0, 0), e[0]);
    if (!(v3_norm(side) >= PARALLEL * v3_norm(ref)) || !v3_nonzero(side))
        return fl_fail(err, FL_INPUT,
                       "%s:%lld: ref of member %s is along the member, expected a vector across it", m->file,
                       (long long)b->line, m->member_name.name[k]);
    e[1] = v3_unit(side);
    e[2] = v3_cross(e[0], e[1]);
    return 0;
}

void fl_member_model_free(fl_member_model *m)
{
    fl_string_table_free(&m->node_name);
    fl_string_table_free(&m->section_name);
    fl_string_table_free(&m->member_name);
    fl_string_table_free(&m->part_name);
    free(m->node);
    free(m->section);
    free(m->member);
    free(m->file);
    free(m->history);
    *m = (fl_member_model){0};
}
