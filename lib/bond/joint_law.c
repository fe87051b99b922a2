/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bond/joint_law.h"

const fl_joint_law_row fl_joint_laws[FL_JOINT_LAWS] = {
    [FL_JOINT_COULOMB] = {"coulomb", fl_joint_coulomb_step},
    [FL_JOINT_YIELDING] = {"yielding", fl_joint_yielding_step},
};

double fl_joint_most_kn(const fl_joint_material *m)
{
    return m->law == FL_JOINT_YIELDING && m->normal_exponent > 0.0 ? m->kn_most : m->kn;
}

double fl_joint_most_ks(const fl_joint_material *m)
{
    return m->law == FL_JOINT_YIELDING && m->shear_exponent > 0.0 ? m->ks_most : m->ks;
}

void fl_joint_point_start(const fl_joint_material *m, fl_joint_point *p, double sigma, const double tau[2])
{
    *p = (fl_joint_point){.sigma = sigma, .tau = {tau[0], tau[1]}, .angle = m->initial_angle};
    p->offset = m->law == FL_JOINT_YIELDING ? fl_joint_closure(m, sigma) : sigma / m->kn;
    p->open = !(sigma > 0.0) && m->law == FL_JOINT_YIELDING;
}
