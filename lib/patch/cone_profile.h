/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_profile.h -- a truncated cone in its half-plane (rho, z): signed distance of a point, and the part of
 * a line inside the cone dilated by R. */
#ifndef FL_PATCH_CONE_PROFILE_H
#define FL_PATCH_CONE_PROFILE_H
#include <stdint.h>
#include "geom/vec3.h"

/* Between the disc of radius r0 about the origin and the disc of radius r1 about (0, 0, h); h > 0, r0 >= 0,
 * r1 >= 0 [m]. */
typedef struct {
    double r0, r1, h;
} fl_truncated_cone;

/* The cone, the dilation radius R, normal (nr, nz) and length of the slant side. */
typedef struct {
    double r0, r1, h, R;
    double nr, nz, length;
} fl_cone_profile;

fl_cone_profile fl_cone_profile_of(const fl_truncated_cone *c, double R);

/* Zones: the part of the cone that is nearest. */
enum { FL_CONE_SIDE, FL_CONE_LOW_END, FL_CONE_HIGH_END, FL_CONE_LOW_RIM, FL_CONE_HIGH_RIM };

/* Signed distance d and its gradient (mr, mz); rim: 1/d where a rim is nearest, else 0. */
typedef struct {
    double d, mr, mz, rim;
    int zone;
} fl_cone_profile_field;

fl_cone_profile_field fl_cone_profile_distance(const fl_cone_profile *c, double rho, double z);

/* Radius of the dilated cone at height z; negative where it has none. */
double fl_cone_profile_radius(const fl_cone_profile *c, double z);

/* A line: height z0 + t dz, squared distance from the axis a + 2 b t + g t^2. */
typedef struct {
    double z0, dz, a, b, g;
} fl_cone_profile_line;

static inline fl_cone_profile_line fl_cone_profile_line_of(fl_vec3 a, fl_vec3 u)
{
    return (fl_cone_profile_line){a.z, u.z, a.x * a.x + a.y * a.y, a.x * u.x + a.y * u.y,
                                  u.x * u.x + u.y * u.y};
}

/* Clips [lo, hi] to the dilated cone; zero[] marks the ends that lie on its surface.  0 when nothing is left.
 */
int fl_cone_profile_clip(const fl_cone_profile *c, const fl_cone_profile_line *l, double *lo, double *hi,
                         int zero[2]);

/* Parameters between lo and hi where the formula of d changes, on either side of a rim.  Returns how many, at
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

/* Radial unit vector at x, at the distance rho from the axis. */
static inline fl_vec3 fl_cone_radial_direction(fl_vec3 x, double rho)
{
    return rho > 0.0 ? v3(x.x / rho, x.y / rho, 0) : v3(1, 0, 0);
}

#endif
