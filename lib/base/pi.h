/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pi.h -- pi and the conversion of degrees. */
#ifndef FL_BASE_PI_H
#define FL_BASE_PI_H

#define PI 3.14159265358979323846

static inline double fl_radians(double degrees) { return degrees * PI / 180.0; }

#endif
