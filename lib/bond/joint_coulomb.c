/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "bond/joint_law.h"

static fl_joint_point_result open_point(fl_joint_point *p)
{
    p->failed = p->open = 1;
    p->sigma = p->tau[0] = p->tau[1] = 0.0;
    return (fl_joint_point_result){0};
}

fl_joint_point_result fl_joint_coulomb_step(const fl_joint_material *m, fl_joint_point *p, double s_n,
                                            const double ds[2])
{
    const double before[2] = {p->tau[0], p->tau[1]};
    fl_joint_point_result out = {0};
    double sigma = m->kn * (p->offset - s_n);
    if (p->failed ? !(sigma > 0.0) : sigma < -m->tension) return open_point(p);
    p->open = 0;
    const double trial[2] = {p->tau[0] + m->ks * ds[0], p->tau[1] + m->ks * ds[1]},
                 size = sqrt(trial[0] * trial[0] + trial[1] * trial[1]),
                 limit = p->failed ? m->residual_cohesion + sigma * m->residual_friction
                                   : m->cohesion + sigma * m->friction;
    p->tau[0] = trial[0], p->tau[1] = trial[1];
    if (size > limit) {
        const int fails = !p->failed;
        p->failed = 1;
        if (!(sigma > 0.0)) return open_point(p);
        const double dilation = p->slip < m->dilation_slip ? m->dilation : 0.0,
                     over = size - (m->residual_cohesion + sigma * m->residual_friction);
        double slip = over / (m->ks + m->kn * dilation * m->residual_friction);
        if (slip < 0.0) slip = 0.0; /* residual strength above the peak */
        const double stay = size > 0.0 ? 1.0 - m->ks * slip / size : 0.0;
        p->tau[0] *= stay, p->tau[1] *= stay;
        p->slip += slip;
        p->offset += dilation * slip;
        const double lifted = m->kn * (p->offset - s_n);
        const double rest = size - m->ks * slip,
                     drop = fails && limit > rest ? limit * limit - rest * rest : 0.0;
        /* work of the mean traction on the plastic slip and on the dilation, less the drop of strength */
        out.friction = 0.5 *
                           ((before[0] + p->tau[0]) * (trial[0] - p->tau[0]) +
                            (before[1] + p->tau[1]) * (trial[1] - p->tau[1])) /
                           m->ks -
                       0.5 * (p->sigma + lifted) * dilation * slip - 0.5 * drop / m->ks;
        sigma = lifted;
        out.slips = 1;
    }
    p->sigma = sigma;
    out.stored = 0.5 * sigma * sigma / m->kn + 0.5 * (p->tau[0] * p->tau[0] + p->tau[1] * p->tau[1]) / m->ks;
    return out;
}
