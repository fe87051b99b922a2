/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "contact/pair_surrogate.h"
#include "world/access.h"

/* K plus the compliance by rotation: x, y, z torques of unit forces, in a frame with the inverse moments
 * invI. */
static fl_sym3 add_rotation(fl_sym3 K, fl_vec3 invI, fl_vec3 x, fl_vec3 y, fl_vec3 z)
{
    return s3_add(K, s3_products(x, y, z, v3_mul(invI, x), v3_mul(invI, y), v3_mul(invI, z)));
}

/* Inverse mass and compliances of two free bodies from their relative pose alone; q is about `at`.  The
 * force is taken as at least half of the sum of the pressures. */
static void find_compliance(const fl_bodies *b, const fl_pair *p, const fl_force_sum *q, fl_vec3 at,
                            fl_exact_contact *exact)
{
    const fl_mat3 *M = exact->M;
    const fl_vec3 f = q->gradient.f, m = q->gradient.m, n = v3_unit(f), none = v3(0, 0, 0),
                  aj = v3_madd(at, 1.0 / q->pressure, q->pressure_moment), ai = v3_sub(aj, exact->o),
                  ei = b->invI[p->i], ej = p->j < b->n ? b->invI[p->j] : none;
    const fl_vec3 mi = m3_tmul(*M, v3_add(v3_cross(v3_sub(at, exact->o), f), m)),
                  mj = v3_add(v3_cross(at, f), m), ni = m3_tmul(*M, n);
    const double each = 1.0 / p->mass, f2 = fmax(v3_norm2(f), 0.25 * q->pressure * q->pressure),
                 turns = v3_dot(v3_mul(ei, mi), mi) + v3_dot(v3_mul(ej, mj), mj);
    exact->inv_mass = each + turns / f2;
    exact->turn_compliance = v3_dot(v3_mul(ei, ni), ni) + v3_dot(v3_mul(ej, n), n);
    const fl_vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    const fl_sym3 alone = s3_isotropic(each),
                  turned = add_rotation(alone, ei, m3_tmul(*M, v3_cross(ai, x)), m3_tmul(*M, v3_cross(ai, y)),
                                        m3_tmul(*M, v3_cross(ai, z)));
    exact->compliance = add_rotation(turned, ej, v3_cross(aj, x), v3_cross(aj, y), v3_cross(aj, z));
}

void fl_exact_contact_find(const fl_world *w, const fl_pair *p, const fl_patch_points *s,
                           const fl_relative_pose *r, fl_force_sum *q, fl_exact_contact *exact)
{
    const double energy = p->k * sqrt(q->u), scale = 0.5 * energy / q->u;
    q->gradient.m = v3_add(q->gradient.m, s->couple);
    *exact = (fl_exact_contact){.M = &r->M,
                                .o = r->o,
                                .points = s,
                                .sums = q,
                                .scale = scale,
                                .energy = energy,
                                .slope = scale * (q->ddu - 0.5 * q->pressure * q->pressure / q->u)};
    find_compliance(&w->b, p, q, s->point[0].p, exact);
}

int fl_exact_contact_free_path(fl_world *w, const fl_pair *p, int32_t thread, fl_exact_contact *exact)
{
    const fl_piece *piece = fl_world_piece(w, p->j);
    const double ra = w->b.radius[p->i];
    exact->radius_a = w->b.bounding_radius[p->i];
    exact->radii = ra + w->b.radius[p->j];
    exact->free_path = INFINITY;
    exact->b_is_plane = piece && piece->kind == FL_PIECE_PLANE;
    if (piece && piece->kind == FL_PIECE_MESH)
        exact->free_path = fl_mesh_contact_free_travel(&w->mesh_near[thread], exact->points->va,
                                                       &w->b.core[p->i], piece, ra, exact->sums->overlap,
                                                       fl_surrogate_max_change(p->law->surrogate_tolerance));
    return exact->free_path < 0.0 ? -1 : 0;
}

int fl_pair_update_surrogate(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t,
                             const fl_exact_contact *exact)
{
    fl_surrogate_count *count = &w->surrogate_counts[thread];
    const int near = t && fl_surrogate_in_double_range(p->surrogate, t);
    fl_err lost = {0};
    if (!p->surrogate && !(p->surrogate = fl_alloc(1, sizeof *p->surrogate, &lost))) return -1;
    if (p->cores_overlap || p->radius_factor != 1.0) {
        p->surrogate->valid = 0;
        return 0;
    }
    const double off = fl_surrogate_update(p->surrogate, t, exact, p->law->surrogate_tolerance);
    if (!near) return 0;
    count->checks++;
    count->misses += off > p->law->surrogate_tolerance;
    count->worst_error = off > count->worst_error ? off : count->worst_error;
    return 0;
}

int fl_pair_rebuild_surrogate(fl_world *w, fl_pair *p, const fl_mat3 *M, fl_vec3 o)
{
    const fl_relative_pose r = {.M = *M, .o = o};
    fl_patch_points *s = &w->scratch[0];
    double distance = 0.0;
    fl_force_sum q;
    if (fl_pair_find_points(w, p, 0, &r, &distance)) return -1;
    if (s->n == 0) return 0;
    if (fl_force_sum_elastic(s, &q)) return -1;
    if (!(q.u > 0.0)) return 0;
    fl_exact_contact exact;
    fl_exact_contact_find(w, p, s, &r, &q, &exact);
    fl_spring_sums springs;
    fl_force_sum_springs(s, &springs);
    exact.springs = &springs;
    if (fl_exact_contact_free_path(w, p, 0, &exact)) return -1;
    fl_surrogate_set(p->surrogate, &exact);
    return 0;
}
