/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "geom/clip.h"
#include "support/block_cuts.h"

static void end_unless_well(int rc, const fl_err *err)
{
    if (rc == 0) return;
    printf("cut: %s\n", err->text);
    exit(1);
}

static void cut_blocks(rock_cut *t, fl_vec3 lo, fl_vec3 hi, const char *const *set, uint64_t seed)
{
    fl_err err = {0};
    *t = (rock_cut){0};
    for (; *set; set++) end_unless_well(fl_joint_sets_add(&t->sets, *set, "test", &err), &err);
    fl_joint_sets_sort(&t->sets);
    end_unless_well(fl_block_model_box(&t->m, lo, hi, &err), &err);
    end_unless_well(fl_block_model_cut(&t->m, &t->sets, seed, &err), &err);
}

void rock_cut_box(rock_cut *t, fl_vec3 lo, fl_vec3 hi, const char *const *set, uint64_t seed)
{
    fl_err err = {0};
    cut_blocks(t, lo, hi, set, seed);
    end_unless_well(fl_block_model_sort(&t->m, &err), &err);
    end_unless_well(fl_face_pairs_find(&t->pairs, &t->m, &t->sets, seed, &err), &err);
    end_unless_well(fl_block_certify(&t->c, &t->m, &t->pairs, &t->sets, &err), &err);
}

int32_t rock_cut_count(fl_vec3 lo, fl_vec3 hi, const char *const *set, uint64_t seed)
{
    rock_cut t;
    cut_blocks(&t, lo, hi, set, seed);
    const int32_t n = t.m.n;
    fl_block_model_free(&t.m);
    fl_joint_sets_free(&t.sets);
    return n;
}

double rock_cut_area(const rock_cut *t, const char *name)
{
    for (int32_t k = 0; k < t->sets.n; k++)
        if (strcmp(t->sets.set[k].name, name) == 0) return t->c.area[k];
    return NAN;
}

/* Offset cores keep their faces here: blocks of these cuts are no slivers. */
void rock_cut_fill(const rock_cut *t, lab *l, double radius, int32_t loose)
{
    fl_err err = {0};
    for (int32_t k = 0; k < t->m.n; k++) {
        fl_poly sharp = {0}, core = {0};
        if (fl_block_shape_poly(&t->m.block[k], &sharp, NULL, &err) != 1) end_unless_well(-1, &err);
        end_unless_well(fl_poly_offset(&core, &sharp, -radius, &err), &err);
        if (core.nf != t->m.block[k].nf) {
            printf("cut: a core has lost faces\n");
            exit(1);
        }
        end_unless_well(fl_ice_field_add(&l->field, k, radius, &core, NULL, k == loose ? NULL : "rock",
                                         v3(0, 0, 0), v3(0, 0, 0), &err),
                        &err);
        fl_poly_free(&sharp);
    }
    for (int32_t k = 0; k < t->pairs.n; k++) {
        const fl_face_pair *p = &t->pairs.pair[k];
        const char *name = p->intact ? "intact" : t->sets.set[t->m.plane[p->plane].set].name;
        end_unless_well(fl_ice_field_add_joint(&l->field, p->i, p->j, p->fi, p->fj, name, &err), &err);
    }
}

void rock_cut_free(rock_cut *t)
{
    fl_block_certificate_free(&t->c);
    fl_face_pairs_free(&t->pairs);
    fl_block_model_free(&t->m);
    fl_joint_sets_free(&t->sets);
}
