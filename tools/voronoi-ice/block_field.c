/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block_field.h"

int block_field_add(const fl_blocks *b, const struct recipe *o, int64_t *id, fl_vec3 shift, fl_ice_field *out,
                    fl_err *err)
{
    for (int32_t i = 0; i < b->n; i++) {
        const fl_mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        fl_poly core = {0};
        if (b->core[i].nv == 0) continue;
        if (*id > INT32_MAX) return fl_fail(err, FL_INPUT, "more blocks than there are ids");
        if (fl_poly_copy(&core, &b->core[i], err)) return -1;
        if (v3_nonzero(shift)) fl_poly_to_frame(&core, v3_neg(shift), same);
        if (fl_ice_field_add(out, (int32_t)(*id)++, o->radius, &core, o->material, NULL,
                             v3(o->velocity.x, o->velocity.y, 0.0), v3(0, 0, 0), err)) {
            fl_poly_free(&core);
            return -1;
        }
    }
    return 0;
}
