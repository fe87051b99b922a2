/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "final_ice.h"
#include "base/array.h"
#include "out/tables.h"
#include "table_rows.h"

/* Appends floe i to the field. */
static int add_floe(fl_ice_field *field, const fl_world *w, int32_t i, fl_err *err)
{
    fl_poly core = {0};
    const fl_bodies *b = &w->b;
    const fl_quat back = q_conj(*fl_body_attitude(b, i));
    if (fl_poly_copy(&core, &b->core[i], err)) return -1;
    const fl_vec3 at = fl_periodic_cell_wrap(&w->cell, b->x[i]);
    fl_poly_to_frame(&core, v3_neg(q_rotate(back, at)), q_matrix(back));
    if (fl_ice_field_add(field, w->id[i], b->radius[i], &core, w->scene->material[w->material[i]].name, NULL,
                         b->v[i], b->w[i], err)) {
        fl_poly_free(&core);
        return -1;
    }
    return 0;
}

int write_final_ice(const struct run *r, fl_err *err)
{
    const char *path = r->scene->output.final_ice;
    const fl_poses now = poses_of(r);
    fl_ice_field field = {0};
    fl_out file = {0};
    int rc = 0;
    if (!path[0]) return 0;
    for (int32_t c = 0; c < r->w->n && !rc; c++) {
        const int32_t i = fl_poses_body(&now, c);
        if (i >= 0) rc = add_floe(&field, r->w, i, err);
    }
    if (!rc && r->history && !(field.history = fl_alloc_text(r->history, err))) rc = -1;
    if (!rc) rc = fl_out_open(&file, path, 0, err);
    if (!rc) {
        fl_ice_field_write(file.f, &field, r->by);
        rc = fl_out_close(&file, err);
    }
    fl_ice_field_free(&field);
    return rc;
}
