/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fixed_dof.h -- bits of the degrees of freedom that are fixed, in the order of FL_FIX_X, ... of a scene. */
#ifndef FL_BODY_FIXED_DOF_H
#define FL_BODY_FIXED_DOF_H

enum { FL_DOF_X = 1, FL_DOF_Y = 2, FL_DOF_Z = 4, FL_DOF_RX = 8, FL_DOF_RY = 16, FL_DOF_RZ = 32 };

#endif
