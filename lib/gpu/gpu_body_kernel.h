/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gpu_body_kernel.h -- what the steps of all spheres of a device share: sums over contacts and bonds, masses,
 * buoyancy (gpu_step_kernel.h, gpu_near_kernel.h). */
#ifndef FL_GPU_GPU_BODY_KERNEL_H
#define FL_GPU_GPU_BODY_KERNEL_H
#include "base/pi.h"
#include "bond/disc_damage_kernel.h"
#include "geom/sym3.h"
#include "gpu/gpu_view.h"
#include "law/normal.h"
#include "law/sphere_kernel.h"

static inline fl_sphere_motion fl_gpu_motion(const fl_gpu_view *a, int32_t k)
{
    fl_sphere_motion q;
    q.v = a->state[k].v, q.L = a->L[k], q.w = a->state[k].w;
    return q;
}

static inline double fl_gpu_mass_up(const fl_gpu_view *a, int32_t k)
{
    return a->heave_mass ? a->m[k] + a->heave_mass[k] : a->m[k] + 0.0;
}

/* Adds a contact as side 0 (i) or 1 (j); r: radius of the body. */
static inline void fl_gpu_add(fl_sphere_sum *s, const fl_gpu_row_result *q, const fl_sphere_contact *c,
                              const fl_rolling_spring *roll, double r, int side)
{
    const fl_sphere_forces f =
        fl_sphere_forces_of(q->n, q->overlap, r, r, q->elastic, c->normal_damping, c->friction_force);
    fl_vec3 t = f.ti;
    if (!side) {
        s->elastic = v3_add(s->elastic, f.elastic), s->damping = v3_add(s->damping, f.damping);
        s->friction = v3_add(s->friction, c->friction_force);
        if (roll) t = v3_madd(t, roll->arm, roll->total);
    } else {
        s->elastic = v3_sub(s->elastic, f.elastic), s->damping = v3_sub(s->damping, f.damping);
        s->friction = v3_sub(s->friction, c->friction_force);
        if (roll) t = v3_sub(t, v3_scale(roll->arm, roll->total));
    }
    s->torque = v3_add(s->torque, t);
}

/* Sums of body k over its contacts; returns how many touch. */
static inline int32_t fl_gpu_sum(const fl_gpu_view *a, int32_t k, fl_sphere_sum *s)
{
    const double r = a->state[k].r;
    const int32_t begin = k / FL_SPHERE_CHUNK * FL_SPHERE_CHUNK;
    int32_t touching = 0, at = a->link_first[k];
    const int32_t end = a->link_first[k + 1];
    s->elastic = s->damping = s->friction = s->torque = v3(0, 0, 0);
    for (int part = 0; part < 2; part++) { /* of the chunk; then walls, and chunks before */
        for (; at < end; at++) {
            const int32_t c = a->link[at] >> 1;
            if (part == 0 && a->row_i[c] < begin) break;
            if (!a->touches[c]) continue;
            fl_gpu_add(s, &a->result[c], &a->contact[c], a->rolling ? &a->rolling[c] : NULL, r,
                       a->link[at] & 1);
            touching++;
        }
        for (int32_t c = a->wall_of_body[k]; part == 0 && c < a->wall_of_body[k + 1]; c++) {
            if (!a->wall[c].touches) continue;
            fl_gpu_add(s, &a->wall_result[c], &a->wall[c].contact,
                       a->wall_rolling ? &a->wall_rolling[c] : NULL, r, 0);
            touching++;
        }
    }
    return touching;
}

static inline int fl_gpu_has_discs(const fl_gpu_view *a, int32_t k)
{
    return a->discs &&
           (a->disc_first_i[k] < a->disc_first_i[k + 1] || a->disc_first_j[k] < a->disc_first_j[k + 1]);
}

static inline void fl_gpu_add_discs(const fl_gpu_view *a, int32_t k, fl_vec3 *f, fl_vec3 *t)
{
    if (!a->discs) return;
    for (int64_t at = a->disc_first_i[k]; at < a->disc_first_i[k + 1]; at++) {
        const fl_disc_wrench *q = &a->disc_out[at];
        *f = v3_add(*f, q->force), *t = v3_add(*t, q->couple_i);
    }
    for (int64_t at = a->disc_first_j[k]; at < a->disc_first_j[k + 1]; at++) {
        const fl_disc_wrench *q = &a->disc_out[a->disc_of[at]];
        *f = v3_sub(*f, q->force), *t = v3_add(*t, q->couple_j);
    }
}

static inline double fl_gpu_power(fl_vec3 f, fl_vec3 t, fl_vec3 v, fl_vec3 w)
{
    return v3_dot(f, v) + v3_dot(t, w);
}

/* Change of velocity by a kick, as the CPU books it. */
static inline fl_vec3 fl_gpu_change(const fl_gpu_view *a, fl_vec3 f, double h, double invm, double up)
{
    return a->heave_mass ? v3_scale(h, v3(invm * f.x, invm * f.y, f.z / up)) : v3_scale(h * invm, f);
}

static inline int fl_gpu_is_finite(fl_vec3 a)
{
    return a.x - a.x == 0.0 && a.y - a.y == 0.0 && a.z - a.z == 0.0;
}

/* Buoyancy of body k, with its wetted area; updates the added mass and its work, up: velocity upwards. */
static inline fl_vec3 fl_gpu_float(const fl_gpu_view *a, int32_t k, double up)
{
    const fl_sphere_float wet = fl_sphere_floats(a->state[k].x.z, a->drag_radius[k], a->fill[k], a->volume[k],
                                                 a->surface[k], a->level, a->specific_weight);
    a->wetted_area[k] = wet.area, a->buoyancy[k] = wet.buoyancy;
    if (a->heave_mass) {
        const double heave = a->heave_factor * (wet.buoyancy / a->gravity_size),
                     change = heave - a->heave_mass[k];
        a->heave_work[k] += 0.5 * change * up * up;
        a->heave_mass[k] = heave;
    }
    return v3(0, 0, wet.buoyancy);
}

static inline void fl_gpu_note_finite(const fl_gpu_view *a, int32_t k, fl_vec3 f, fl_vec3 t,
                                      fl_sphere_motion end)
{
    a->bad[k] = (uint8_t) !(fl_gpu_is_finite(f) && fl_gpu_is_finite(t) && fl_gpu_is_finite(a->state[k].x) &&
                            fl_gpu_is_finite(end.v) && fl_gpu_is_finite(end.w));
}

#endif
