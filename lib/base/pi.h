/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pi.h -- the number. */
#ifndef FL_BASE_PI_H
#define FL_BASE_PI_H

#define PI 3.14159265358979323846

#endif
