/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/array.h"
#include "contact/pair_surrogate.h"
#include "world/access.h"

/* Free path of a pair of the law `quick` over the radii, a third of the width over which crossings begin:
 * beyond that terms come that the expansion does not know.  Eight cubes between walls (verify_energy, 1e-3,
 * 12 runs of 10 s) change their energy by 1.8e-4 (rms) without a limit, 5.4e-5 with 0.2, 1.2e-5 with 0.1,
 * 7e-6 with 0.05, by 0.57, 0.57, 0.54 and 0.42 of the contact-steps without an evaluation; `patch` by
 * 1.6e-5. */
#define QUICK_FREE_PATH (FL_QUICK_TAPER / 3.0)

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
                                .first = s->point[0].p,
                                .sums = q,
                                .scale = scale,
                                .energy = energy,
                                .slope = fl_patch_slope(scale, q->u, q->pressure, q->ddu, q->overlap)};
    find_compliance(&w->b, p, q, s->point[0].p, exact);
}

fl_spring_sums fl_quick_springs(const fl_quick_sums *q, const fl_sym3 *second, double k)
{
    const fl_vec3 t = v3_unit(q->direction);
    const fl_vec3 row[3] = {v3(0.0, t.z, -t.y), v3(-t.z, 0.0, t.x), v3(t.y, -t.x, 0.0)}; /* x cross t */
    const double dir[3] = {t.x, t.y, t.z}, mean = v3_norm(q->direction) / q->pressure,
                 part = mean < 1.0 ? 1.0 - mean * mean : 0.0,
                 turning = part * (second->xx + second->yy + second->zz);
    fl_spring_sums at = {{{0}}, {{0}}, {{0}}};
    for (int r = 0; r < 3; r++) {
        const fl_vec3 turned = s3_mul(*second, row[r]);
        for (int c = 0; c < 3; c++) {
            at.linear[r][c] = k * ((r == c ? part : 0.0) + (1.0 - part) * dir[r] * dir[c]);
            at.angular[r][c] = k * ((r == c ? turning : 0.0) + v3_dot(turned, row[c]));
        }
    }
    return at;
}

void fl_exact_contact_of_quick(const fl_world *w, const fl_pair *p, const fl_relative_pose *r,
                               const fl_quick_sums *q, fl_quick_exact *rest, fl_exact_contact *exact)
{
    const double energy = p->k * sqrt(q->u), scale = 0.5 * energy / q->u, e = q->pressure;
    const fl_vec3 centre = v3_scale(1.0 / e, q->moment);
    const fl_sym3 second = fl_quick_second_moments(q);
    const double spread = second.xx + second.yy + second.zz;
    rest->sums = (fl_force_sum){
        .u = q->u,
        .ddu = q->ddu,
        .overlap = q->overlap,
        .pressure = e,
        .second = {e * second.xx, e * second.xy, e * second.xz, e * second.yy, e * second.yz, e * second.zz},
        .gradient = {q->gradient.f, v3_sub(q->gradient.m, v3_cross(centre, q->gradient.f))}};
    rest->springs = fl_quick_springs(q, &second, q->ddu);
    rest->pressing = (fl_pressure_moments){
        .pressure = e, .direction = q->direction, .radius = spread > 0.0 ? sqrt(spread) : 0.0};
    const fl_spring_sums even = fl_quick_springs(q, &second, e);
    for (int i = 0; i < 3; i++)
        for (int c = i; c < 3; c++)
            rest->pressing.damping[FL_UPPER[i][c]] = even.linear[i][c],
            rest->pressing.damping[FL_UPPER[3 + i][3 + c]] = even.angular[i][c];
    *exact = (fl_exact_contact){.M = &r->M,
                                .o = r->o,
                                .first = centre,
                                .pressing = &rest->pressing,
                                .sums = &rest->sums,
                                .springs = &rest->springs,
                                .scale = scale,
                                .energy = energy,
                                .slope = fl_patch_slope(scale, q->u, e, q->ddu, q->overlap)};
    find_compliance(&w->b, p, &rest->sums, centre, exact);
}

int fl_exact_contact_free_path(fl_world *w, const fl_pair *p, int32_t thread, fl_exact_contact *exact)
{
    const fl_piece *piece = fl_world_piece(w, p->j);
    const double ra = w->b.radius[p->i];
    exact->radius_a = w->b.bounding_radius[p->i];
    exact->radii = ra + w->b.radius[p->j];
    exact->free_path = fl_pair_is_quick(w, p) ? QUICK_FREE_PATH * exact->radii : INFINITY;
    exact->b_is_plane = piece && piece->kind == FL_PIECE_PLANE;
    if (piece && piece->kind == FL_PIECE_MESH)
        exact->free_path = fl_mesh_contact_free_travel(&w->mesh_near[thread], w->scratch[thread].va,
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

static int rebuild_quick(fl_world *w, fl_pair *p, const fl_relative_pose *r)
{
    double distance = 0.0;
    fl_quick_sums q;
    fl_quick_exact rest;
    fl_exact_contact exact;
    if (fl_pair_find_quick(w, p, 0, r, &distance, &q)) return -1;
    if (!(q.u > 0.0)) return 0;
    fl_exact_contact_of_quick(w, p, r, &q, &rest, &exact);
    if (fl_exact_contact_free_path(w, p, 0, &exact)) return -1;
    fl_surrogate_set(p->surrogate, &exact);
    return 0;
}

int fl_pair_rebuild_surrogate(fl_world *w, fl_pair *p, const fl_mat3 *M, fl_vec3 o)
{
    const fl_relative_pose r = {.M = *M, .o = o};
    fl_patch_points *s = &w->scratch[0];
    double distance = 0.0;
    fl_force_sum q;
    if (fl_pair_is_quick(w, p)) return rebuild_quick(w, p, &r);
    if (fl_pair_find_points(w, p, 0, &r, &distance)) return -1;
    if (s->n == 0) return 0;
    if (fl_force_sum_elastic(s, &q)) return -1;
    if (!(q.u > 0.0)) return 0;
    fl_exact_contact exact;
    fl_exact_contact_find(w, p, s, &r, &q, &exact);
    fl_spring_sums springs;
    fl_pressure_moments pressing;
    fl_force_sum_springs(s, &springs);
    fl_force_sum_pressure(s, &pressing);
    exact.springs = &springs, exact.pressing = &pressing;
    if (fl_exact_contact_free_path(w, p, 0, &exact)) return -1;
    fl_surrogate_set(p->surrogate, &exact);
    return 0;
}
