/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bond/disc.h"
#include "bond/disc_damage_kernel.h"

double fl_disc_integrity(const fl_disc_class *c, double lambda) { return fl_disc_integrity_of(*c, lambda); }

fl_disc_wrench fl_disc_force(const fl_disc_law *law, const fl_disc_class *c, double scatter,
                             const fl_disc_pose *at, double dt, fl_disc_memory *m)
{
    const fl_disc_result now = fl_disc_step(*law, *c, scatter, *at, dt, *m);
    *m = now.memory;
    return now.force;
}

double fl_disc_energy(const fl_disc_class *c, const fl_disc_memory *m, fl_vec3 d)
{
    return fl_disc_stored(*c, *m, d);
}

fl_disc_load fl_disc_section_load(const fl_disc_law *law, const fl_disc_class *c, const fl_disc_memory *m,
                                  fl_vec3 d)
{
    const double N = c->kn * (v3_norm(d) - c->length), g = fl_disc_integrity(c, m->lambda);
    return (fl_disc_load){.tension = N > 0.0 ? g * N : N,
                          .shear = fl_disc_shear_share(*law, g, N, m->S) * v3_norm(m->S),
                          .moment = g * v3_norm(m->M),
                          .x = v3_scale(c->share, d)};
}
