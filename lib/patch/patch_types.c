/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/patch_types.h"
#include "base/array.h"

int fl_patch_points_reserve_core(fl_patch_points *w, const fl_poly *a)
{
    return fl_reserve(&w->va, &w->va_cap, a->nv, sizeof *w->va) ||
                   fl_reserve(&w->na, &w->na_cap, a->nf, sizeof *w->na)
               ? -1
               : 0;
}

int fl_patch_points_grow(fl_patch_points *w)
{
    return fl_reserve(&w->point, &w->point_cap, (int64_t)w->n + 1, sizeof *w->point);
}

int fl_patch_points_add_plain(fl_patch_points *w, fl_vec3 x, fl_vec3 n, double overlap, double ra)
{
    return fl_patch_points_add(
        w,
        (fl_patch_point){
            .overlap = overlap, .du = 1.0, .n = n, .unit_normal = n, .p = v3_madd(x, 0.5 * overlap - ra, n)});
}

void fl_feature_set_free(fl_feature_set *r)
{
    free(r->vertex), free(r->edge), free(r->face);
    *r = (fl_feature_set){0};
}
