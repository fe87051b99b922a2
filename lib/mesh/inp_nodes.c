/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "mesh/inp_nodes.h"

int fl_inp_node(fl_inp_model *r, fl_err *err)
{
    const int round = fl_inp_param_is(&r->line, "SYSTEM", "C");
    int more;
    if (!round && fl_inp_param(&r->line, "SYSTEM") && !fl_inp_param_is(&r->line, "SYSTEM", "R"))
        return fl_inp_fail(&r->line, err,
                           "*NODE with SYSTEM= other than R and C is not read: export the nodes in "
                           "rectangular coordinates",
                           "");
    if (fl_inp_follow_input(r, err)) return -1;
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        int64_t id;
        fl_vec3 x;
        if (fl_inp_id(&r->line, 0, &id, err) || fl_inp_point(&r->line, 1, &x, err) ||
            fl_inp_set_location(r, err))
            return -1;
        if (round) {
            const fl_mat3 q = fl_affine_rotation(v3(0, 0, 1), x.y);
            x = v3_add(m3_mul(q, v3(x.x, 0, 0)), v3(0, 0, x.z));
        }
        if (fl_elements_add_node(r->store, r->scope, id,
                                 fl_inp_transform(&r->transform, fl_inp_transform(&r->system, x)), err) < 0)
            return -1;
    }
    return more;
}

int fl_inp_system(fl_inp_model *r, fl_err *err)
{
    fl_vec3 a, b, c, x, z = v3(0, 0, 1);
    int more = fl_inp_next_data(&r->line, err), given;
    r->system = fl_affine_identity();
    if (more <= 0) return more;
    if (fl_inp_point(&r->line, 0, &a, err) || fl_inp_point(&r->line, 3, &b, err)) return -1;
    given = r->line.fields > 3;
    r->system.t = a;
    more = fl_inp_next_data(&r->line, err);
    if (more < 0 || !given) return more < 0 ? -1 : 0;
    x = v3_sub(b, a);
    if (more) {
        if (fl_inp_point(&r->line, 0, &c, err)) return -1;
        z = v3_cross(x, v3_sub(c, a));
    } else {
        x.z = 0.0; /* the third axis stays, the first is projected */
    }
    x = v3_unit(x);
    z = v3_unit(z);
    if (!(v3_norm(x) > 0.5) || !(v3_norm(z) > 0.5))
        return fl_inp_fail(&r->line, err, "the points of *SYSTEM lie on one line", "");
    const fl_vec3 y = v3_cross(z, x);
    r->system.q = (fl_mat3){{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
    return 0;
}

static int position_of(fl_inp_model *r, int64_t id, fl_vec3 *x, fl_err *err)
{
    const int32_t k = fl_id_map_find(&r->store->node_id, r->scope, id);
    if (k < 0 || isnan(r->store->x[k].x))
        return fl_deck_fail(&r->line.deck, err, "*NGEN refers to node %lld, which is not defined yet",
                            (long long)id);
    *x = r->store->x[k];
    return 0;
}

int fl_inp_ngen(fl_inp_model *r, fl_err *err)
{
    int more;
    if (fl_inp_param(&r->line, "LINE") ||
        (fl_inp_param(&r->line, "SYSTEM") && !fl_inp_param_is(&r->line, "SYSTEM", "RC")))
        return fl_inp_fail(&r->line, err,
                           "*NGEN on arcs and parabolas is not read: export the deck with all nodes written "
                           "out",
                           "");
    while ((more = fl_inp_next_data(&r->line, err)) > 0) {
        int64_t first, last, step, n;
        fl_vec3 a, b;
        if (fl_inp_id(&r->line, 0, &first, err) || fl_inp_id(&r->line, 1, &last, err) ||
            fl_inp_integer(&r->line, 2, 1, &step, err))
            return -1;
        if (step == 0) step = 1;
        if (step < 0 || last < first || (last - first) % step)
            return fl_deck_fail(&r->line.deck, err,
                                "nodes %lld to %lld by %lld: steps that end there are expected",
                                (long long)first, (long long)last, (long long)step);
        n = (last - first) / step;
        if (fl_inp_set_location(r, err) || position_of(r, first, &a, err) || position_of(r, last, &b, err) ||
            fl_inp_count_generated(r, n, err))
            return -1;
        for (int64_t k = 1; k < n; k++)
            if (fl_elements_add_node(r->store, r->scope, first + k * step,
                                     v3_madd(a, (double)k / (double)n, v3_sub(b, a)), err) < 0)
                return -1;
    }
    return more;
}
