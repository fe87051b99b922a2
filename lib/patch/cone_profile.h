/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_profile.h -- the half-plane (rho, z) of a truncated cone: how far a point of it is, and where a line
 * enters the cone dilated by R. */
#ifndef FL_PATCH_CONE_PROFILE_H
#define FL_PATCH_CONE_PROFILE_H
#include <stdint.h>
#include "geom/vec3.h"

/* Between the disc of radius r0 about the origin and that of radius r1 about (0, 0, h); h > 0, r0, r1 >= 0.
 * [m] */
typedef struct {
    double r0, r1, h;
} fl_truncated_cone;

/* The frustum there, the radius R of what meets it, normal and length of the slant side. */
typedef struct {
    double r0, r1, h, R;
    double nr, nz, length;
} fl_cone_profile;

fl_cone_profile fl_cone_profile_of(const fl_truncated_cone *c, double R);

/* What of it is nearest. */
enum { FL_CONE_SIDE, FL_CONE_LOW_END, FL_CONE_HIGH_END, FL_CONE_LOW_RIM, FL_CONE_HIGH_RIM };

/* Distance from it, its gradient (mr, mz), and 1/d where a rim is nearest, else 0. */
typedef struct {
    double d, mr, mz, rim;
    int zone; /* what is nearest */
} fl_cone_profile_field;

fl_cone_profile_field fl_cone_profile_distance(const fl_cone_profile *c, double rho, double z);

/* Radius of the dilated frustum at height z; negative where there is none. */
double fl_cone_profile_radius(const fl_cone_profile *c, double z);

/* A line at z0 + t dz whose squared distance from the axis is a + 2 b t + g t^2. */
typedef struct {
    double z0, dz, a, b, g;
} fl_cone_profile_line;

static inline fl_cone_profile_line fl_cone_profile_line_of(fl_vec3 a, fl_vec3 u)
{
    return (fl_cone_profile_line){a.z, u.z, a.x * a.x + a.y * a.y, a.x * u.x + a.y * u.y,
                                  u.x * u.x + u.y * u.y};
}

/* Keep of [lo, hi] what is inside the dilated frustum; zero[] tells which ends are where that ends.  0 when
 * nothing is left. */
int fl_cone_profile_clip(const fl_cone_profile *c, const fl_cone_profile_line *l, double *lo, double *hi,
                         int zero[2]);

/* Where between lo and hi the formula of d changes, on the axis' side of the rim and beyond it: how many, at
 * most four. */
int32_t fl_cone_profile_breaks(const fl_cone_profile *c, const fl_cone_profile_line *l, double lo, double hi,
                               double *out);

/* Least squared distance of the line from the axis. */
static inline double fl_cone_line_min_radius2(const fl_cone_profile_line *l, double lo, double hi)
{
    double t = l->g > 0.0 ? -l->b / l->g : lo;
    t = t < lo ? lo : t > hi ? hi : t;
    return l->a + t * (2.0 * l->b + t * l->g);
}

/* Direction of x across the axis, which is rho away. */
static inline fl_vec3 fl_cone_radial_direction(fl_vec3 x, double rho)
{
    return rho > 0.0 ? v3(x.x / rho, x.y / rho, 0) : v3(1, 0, 0);
}

#endif
