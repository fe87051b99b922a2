/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "body/body.h"

int fl_bodies_alloc(fl_bodies *b, int32_t n, int32_t total, fl_err *err)
{
    *b = (fl_bodies){.n = n, .total = total};
    const struct {
        void *array;
        size_t size;
    } arrays[] = {{&b->x, sizeof *b->x},
                  {&b->v, sizeof *b->v},
                  {&b->L, sizeof *b->L},
                  {&b->q, sizeof *b->q},
                  {&b->w, sizeof *b->w},
                  {&b->f, sizeof *b->f},
                  {&b->t, sizeof *b->t},
                  {&b->m, sizeof *b->m},
                  {&b->invm, sizeof *b->invm},
                  {&b->I, sizeof *b->I},
                  {&b->invI, sizeof *b->invI},
                  {&b->radius, sizeof *b->radius},
                  {&b->bounding_radius, sizeof *b->bounding_radius},
                  {&b->core, sizeof *b->core},
                  {&b->fixed_dof, sizeof *b->fixed_dof},
                  {&b->is_isotropic, sizeof *b->is_isotropic},
                  {&b->work_of_constraints, sizeof *b->work_of_constraints},
                  {&b->odometer, sizeof *b->odometer}};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        void *p =
            /* +1: SIMD loads of the last x read four numbers */
            fl_alloc((int64_t)total + 1, arrays[k].size, err);
        if (!p) {
            fl_bodies_free(b);
            return -1;
        }
        *(void **)arrays[k].array = p;
    }
    for (int32_t i = 0; i < total; i++) {
        b->q[i] = q_one();
        fl_body_set_inertia(b, i, v3(1, 1, 1));
    }
    return 0;
}

int fl_bodies_alloc_added_mass(fl_bodies *b, fl_err *err)
{
    b->added_mass = fl_alloc(b->total, sizeof *b->added_mass, err);
    b->flow_velocity = fl_alloc(b->total, sizeof *b->flow_velocity, err);
    b->flow_work = fl_alloc(b->total, sizeof *b->flow_work, err);
    return b->added_mass && b->flow_velocity && b->flow_work ? 0 : -1;
}

int fl_bodies_alloc_heave(fl_bodies *b, fl_err *err)
{
    b->heave_mass = fl_alloc(b->total, sizeof *b->heave_mass, err);
    b->heave_work = fl_alloc(b->total, sizeof *b->heave_work, err);
    return b->heave_mass && b->heave_work ? 0 : -1;
}

void fl_bodies_free(fl_bodies *b)
{
    for (int32_t i = 0; b->core && i < b->total; i++) fl_poly_free(&b->core[i]);
    free(b->x), free(b->v), free(b->L), free(b->q), free(b->w), free(b->f), free(b->t);
    free(b->m), free(b->invm), free(b->I), free(b->invI), free(b->radius), free(b->bounding_radius),
        free(b->core), free(b->fixed_dof);
    free(b->is_isotropic), free(b->odometer), free(b->work_of_constraints), free(b->added_mass),
        free(b->flow_velocity);
    free(b->flow_work), free(b->heave_mass), free(b->heave_work);
    *b = (fl_bodies){0};
}

int fl_body_is_isotropic(const fl_bodies *b, int32_t i)
{
    const fl_vec3 I = b->I[i], a = b->added_mass ? b->added_mass[i] : v3(0, 0, 0);
    return b->core[i].nv == 1 && v3_norm2(b->core[i].v[0]) == 0.0 && I.x == I.y && I.y == I.z && a.x == a.y &&
           a.y == a.z;
}

void fl_body_set_inertia(fl_bodies *b, int32_t i, fl_vec3 I)
{
    b->I[i] = I;
    b->invI[i] = v3(1.0 / I.x, 1.0 / I.y, 1.0 / I.z);
}

void fl_body_update_spin(fl_bodies *b, int32_t i) { b->w[i] = fl_body_apply_inverse_inertia(b, i, b->L[i]); }

void fl_body_set_spin(fl_bodies *b, int32_t i, fl_vec3 w)
{
    const fl_mat3 R = fl_body_axes(b, i);
    const fl_vec3 s = m3_tmul(R, w), I = b->I[i];
    b->w[i] = w;
    b->L[i] = m3_mul(R, v3(I.x * s.x, I.y * s.y, I.z * s.z));
}
