/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include <string.h>
#include "base/array.h"
#include "base/simd.h"
#include "patch/force_sum.h"

/* What later sums need of four points. */
typedef struct {
    fl_simd approach, e, du, curve, across[3], arm[3];
} point_four;

/* Four consecutive numbers of each of four points, transposed in registers: a vector load would wait for
 * scalar stores. */
#define COLUMNS(p, member, a, b, c, d)                                                                       \
    do {                                                                                                     \
        const fl_simd r0 = *(const fl_simd *)&(p)[0].member, r1 = *(const fl_simd *)&(p)[1].member;          \
        const fl_simd r2 = *(const fl_simd *)&(p)[2].member, r3 = *(const fl_simd *)&(p)[3].member;          \
        const fl_simd lo = __builtin_shufflevector(r0, r1, 0, 4, 2, 6);                                      \
        const fl_simd hi = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);                                      \
        const fl_simd lo2 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6);                                     \
        const fl_simd hi2 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);                                     \
        a = __builtin_shufflevector(lo, lo2, 0, 1, 4, 5);                                                    \
        b = __builtin_shufflevector(hi, hi2, 0, 1, 4, 5);                                                    \
        c = __builtin_shufflevector(lo, lo2, 2, 3, 6, 7);                                                    \
        d = __builtin_shufflevector(hi, hi2, 2, 3, 6, 7);                                                    \
    } while (0)

_Static_assert(offsetof(fl_patch_point, ddu) == offsetof(fl_patch_point, overlap) + 24 &&
                   offsetof(fl_patch_point, unit_normal) == offsetof(fl_patch_point, n) + 24 &&
                   offsetof(fl_patch_point, p) == offsetof(fl_patch_point, unit_normal) + 24,
               "COLUMNS reads four numbers in a row");

#define CROSS(out, a, b)                                                                                     \
    do {                                                                                                     \
        out[0] = a[1] * b[2] - a[2] * b[1];                                                                  \
        out[1] = a[2] * b[0] - a[0] * b[2];                                                                  \
        out[2] = a[0] * b[1] - a[1] * b[0];                                                                  \
    } while (0)

/* Speed, or distance, by which points of A move into B. */
FL_SIMD_INLINE void approach_speed_of(fl_simd *out, const fl_simd across[3], const fl_simd arm[3], fl_vec3 v,
                                      fl_vec3 spin)
{
    const fl_simd vx = v.x + (spin.y * arm[2] - spin.z * arm[1]);
    const fl_simd vy = v.y + (spin.z * arm[0] - spin.x * arm[2]);
    const fl_simd vz = v.z + (spin.x * arm[1] - spin.y * arm[0]);
    *out = -(across[0] * vx + across[1] * vy + across[2] * vz);
}

static fl_vec3 sum_vector(const fl_simd a[3])
{
    return v3(fl_simd_sum(&a[0]), fl_simd_sum(&a[1]), fl_simd_sum(&a[2]));
}

static fl_sym3 sum_matrix(const fl_simd a[6])
{
    return (fl_sym3){fl_simd_sum(&a[0]), fl_simd_sum(&a[1]), fl_simd_sum(&a[2]),
                     fl_simd_sum(&a[3]), fl_simd_sum(&a[4]), fl_simd_sum(&a[5])};
}

/* Adds weight arm and weight arm arm^T. */
FL_SIMD_INLINE void add_moments(fl_simd sum[3], fl_simd all[6], const fl_simd *weight, const fl_simd arm[3])
{
    const fl_simd x = *weight * arm[0], y = *weight * arm[1], z = *weight * arm[2];
    sum[0] += x, sum[1] += y, sum[2] += z;
    all[0] += x * arm[0], all[1] += x * arm[1], all[2] += x * arm[2];
    all[3] += y * arm[1], all[4] += y * arm[2], all[5] += z * arm[2];
}

static double largest_lane(const fl_simd *a)
{
    double most = 0.0;
    for (int l = 0; l < FL_SIMD_WIDTH; l++) most = (*a)[l] > most ? (*a)[l] : most;
    return most;
}

FL_SIMD_VERSIONS static void sum_elastic(const fl_patch_point *point, int32_t n, point_four *t,
                                         fl_force_sum *q)
{
    const fl_vec3 at = point[0].p;
    const fl_simd zero = {0};
    fl_simd u = zero, ddu = zero, most = zero, pressed = zero, elastic = zero;
    fl_simd f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero}, mid[3] = {zero, zero, zero},
            second[6] = {zero, zero, zero, zero, zero, zero};
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH, t++) {
        const fl_patch_point *p = point + k;
        fl_patch_point last[FL_SIMD_WIDTH];
        if (n - k < FL_SIMD_WIDTH) { /* pad with points without force */
            for (int l = 0; l < FL_SIMD_WIDTH; l++) last[l] = k + l < n ? p[l] : (fl_patch_point){0};
            p = last;
        }
        fl_simd overlap, ux, all, curve, nx, ny, nz, *arm = t->arm, *across = t->across;
        COLUMNS(p, overlap, overlap, ux, all, curve);
        COLUMNS(p, n, nx, ny, nz, across[0]);
        COLUMNS(p, unit_normal.y, across[1], across[2], arm[0], arm[1]);
        arm[0] -= at.x, arm[1] -= at.y;
        arm[2] = (fl_simd){p[0].p.z, p[1].p.z, p[2].p.z, p[3].p.z} - at.z;
        const fl_simd pull[3] = {all * nx, all * ny, all * nz};
        const fl_simd_mask not_rim = ux != 0.0;
        const fl_simd du = FL_SIMD_MASKED(not_rim, all), bent = FL_SIMD_MASKED(not_rim, curve);
        fl_simd moment[3];
        CROSS(moment, arm, pull);
        for (int c = 0; c < 3; c++) f[c] += pull[c], m[c] += moment[c];
        const fl_simd e = du * (nx * across[0] + ny * across[1] + nz * across[2]);
        t->e = e, t->du = du, t->curve = bent;
        add_moments(mid, second, &e, arm);
        u += ux;
        ddu += bent;
        pressed += du;
        elastic += e;
        most = FL_SIMD_SELECT(overlap > most, overlap, most);
    }
    q->u = fl_simd_sum(&u), q->ddu = fl_simd_sum(&ddu);
    q->du = fl_simd_sum(&pressed), q->pressure = fl_simd_sum(&elastic);
    q->gradient = (fl_wrench){sum_vector(f), sum_vector(m)};
    q->pressure_moment = sum_vector(mid), q->second = sum_matrix(second);
    q->overlap = largest_lane(&most);
}

FL_SIMD_VERSIONS static void sum_motion(point_four *t, int32_t lanes, fl_vec3 v, fl_vec3 spin,
                                        fl_force_sum *q)
{
    fl_simd approach = {0}, rate = {0};
    for (int32_t k = 0; k < lanes; k++, t++) {
        fl_simd c;
        approach_speed_of(&c, t->across, t->arm, v, spin);
        t->approach = c;
        approach += t->du * FL_SIMD_MASKED(c > 0.0, c);
        rate += t->e * c;
    }
    q->du_approach = fl_simd_sum(&approach), q->pressure_rate = fl_simd_sum(&rate);
}

FL_SIMD_VERSIONS static void sum_sliding(const point_four *t, int32_t lanes, fl_vec3 v, double sum[2])
{
    fl_simd with = {0}, square = {0};
    for (int32_t k = 0; k < lanes; k++, t++) {
        const fl_simd s = -(t->across[0] * v.x + t->across[1] * v.y + t->across[2] * v.z), es = t->e * s;
        with += es * t->approach;
        square += es * s;
    }
    sum[0] = fl_simd_sum(&with), sum[1] = fl_simd_sum(&square);
}

FL_SIMD_VERSIONS static void sum_damped(const point_four *t, int32_t lanes, double chi, double still,
                                        fl_force_sum *q)
{
    const fl_simd zero = {0};
    fl_simd normal = zero, way[3] = {zero, zero, zero}, at[3] = {zero, zero, zero};
    fl_simd f[3] = {zero, zero, zero}, m[3] = {zero, zero, zero};
    for (int32_t k = 0; k < lanes; k++, t++) {
        const fl_simd e = t->e, to = e * (still + chi * t->approach), p = FL_SIMD_MASKED(to > 0.0, to);
        const fl_simd more = p - e, *arm = t->arm, *across = t->across;
        const fl_simd pull[3] = {more * across[0], more * across[1], more * across[2]};
        fl_simd moment[3];
        CROSS(moment, arm, pull);
        normal += p;
        for (int c = 0; c < 3; c++) {
            way[c] += p * across[c];
            at[c] += p * arm[c];
            f[c] += pull[c];
            m[c] += moment[c];
        }
    }
    q->damped_pressure = fl_simd_sum(&normal);
    q->direction = sum_vector(way), q->damped_moment = sum_vector(at);
    q->damping = (fl_wrench){sum_vector(f), sum_vector(m)};
}

/* Adds the upper triangle of weight g g^T, g = (unit normal, arm x unit normal). */
FL_SIMD_INLINE void add_outer_product(fl_simd all[FL_PRESSURE_MATRIX], const fl_simd *weight,
                                      const fl_simd g[6])
{
    int m = 0;
    FL_SIMD_UNROLL
    for (int r = 0; r < 6; r++) {
        const fl_simd by = *weight * g[r];
        FL_SIMD_UNROLL
        for (int c = r; c < 6; c++, m++) all[m] += by * g[c];
    }
}

FL_SIMD_VERSIONS static void sum_springs(const point_four *t, int32_t n, double sum[FL_PRESSURE_MATRIX])
{
    fl_simd all[FL_PRESSURE_MATRIX];
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) all[m] = (fl_simd){0};
    for (int32_t k = 0; k < n; k += FL_SIMD_WIDTH, t++) {
        fl_simd g[6] = {t->across[0], t->across[1], t->across[2]};
        CROSS((g + 3), t->arm, t->across);
        add_outer_product(all, &t->curve, g);
    }
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) sum[m] = fl_simd_sum(&all[m]);
}

static int32_t count_lanes(const fl_patch_points *s) { return (s->n + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH; }

/* --- areas ------------------------------------------------------------------------------------- */

enum { AREA_POINTS = 3 }; /* points of an area */

/* Approach of an area: speed `mean` at its middle, off[] more at its points, `amplitude` faster and slower at
 * two of the points of four_point_area(). */
typedef struct {
    uint32_t k; /* its first point */
    double mean, amplitude, off[AREA_POINTS];
} area_motion;

static double approach_speed_at(const point_four *t, uint32_t k)
{
    return t[k / FL_SIMD_WIDTH].approach[k % FL_SIMD_WIDTH];
}

static area_motion motion_of_area(const point_four *t, uint32_t k)
{
    area_motion a = {.k = k};
    double sum2 = 0.0;
    for (uint32_t c = 0; c < AREA_POINTS; c++) a.mean += (a.off[c] = approach_speed_at(t, k + c));
    a.mean *= 1.0 / AREA_POINTS;
    for (int c = 0; c < AREA_POINTS; c++) a.off[c] -= a.mean, sum2 += a.off[c] * a.off[c];
    a.amplitude = sqrt(2.0 / AREA_POINTS * sum2);
    return a;
}

/* Lists the areas in s->area_motion. */
static int find_areas(fl_patch_points *s)
{
    const fl_patch_point *p = s->point, *const end = p + s->n;
    s->areas = 0;
    while (p < end) {
        if (p->group_size == AREA_POINTS && p->u != 0.0) {
            if (fl_reserve(&s->area_motion, &s->area_cap, (int64_t)s->areas + 1, sizeof(area_motion)))
                return -1;
            area_motion *all = s->area_motion;
            all[s->areas++] = motion_of_area(s->point_lanes, (uint32_t)(p - s->point));
        }
        p += p->group_size > 1 ? p->group_size : 1;
    }
    return 0;
}

static double positive_part(double c) { return c > 0.0 ? c : 0.0; }

/* du_approach of areas that approach in part: four points instead of three. */
static double approach_correction(const fl_patch_points *s)
{
    double all = 0.0;
    const area_motion *a = s->area_motion;
    for (int32_t k = 0; k < s->areas; k++, a++) {
        if (fabs(a->mean) >= a->amplitude) continue;
        double approach =
            0.25 * (positive_part(a->mean + a->amplitude) + positive_part(a->mean - a->amplitude)) +
            0.5 * positive_part(a->mean);
        for (int c = 0; c < AREA_POINTS; c++) approach -= positive_part(a->mean + a->off[c]) / AREA_POINTS;
        all += AREA_POINTS * s->point[a->k].du * approach;
    }
    return all;
}

static fl_vec3 arm_of(const point_four *t, uint32_t k)
{
    const fl_simd *arm = t[k / FL_SIMD_WIDTH].arm;
    return v3(arm[0][k % FL_SIMD_WIDTH], arm[1][k % FL_SIMD_WIDTH], arm[2][k % FL_SIMD_WIDTH]);
}

/* Four points with the sum, mean and second moments of the three: from the middle forwards and backwards
 * along the direction in which the approach speed rises, and along one in which it is that of the middle.
 * They depend on the area only, whichever three points represent it. */
static point_four four_point_area(const point_four *t, const area_motion *a)
{
    const fl_vec3 p0 = arm_of(t, a->k), p1 = v3_sub(arm_of(t, a->k + 1), p0),
                  p2 = v3_sub(arm_of(t, a->k + 2), p0);
    const fl_vec3 mid = v3_madd(p0, 1.0 / AREA_POINTS, v3_add(p1, p2));
    const double along = 2.0 / AREA_POINTS / a->amplitude, aside = along / sqrt(3.0), *off = a->off;
    const fl_vec3 w = v3_madd(v3_scale(along * off[1], p1), along * off[2], p2);
    const fl_vec3 x = v3_madd(v3_scale(aside * (off[2] - off[0]), p1), aside * (off[0] - off[1]), p2);
    const point_four *own = &t[a->k / FL_SIMD_WIDTH];
    const uint32_t l = a->k % FL_SIMD_WIDTH;
    const fl_simd none = {0};
    point_four four = {.approach = {a->mean + a->amplitude, a->mean - a->amplitude, a->mean, a->mean}};
    four.e = none + AREA_POINTS * 0.25 * own->e[l];
    for (int c = 0; c < 3; c++) four.across[c] = none + own->across[c][l];
    four.arm[0] = (fl_simd){mid.x + w.x, mid.x - w.x, mid.x + x.x, mid.x - x.x};
    four.arm[1] = (fl_simd){mid.y + w.y, mid.y - w.y, mid.y + x.y, mid.y - x.y};
    four.arm[2] = (fl_simd){mid.z + w.z, mid.z - w.z, mid.z + x.z, mid.z - x.z};
    return four;
}

/* Points in which no area pulls in part: s->point_lanes, or a copy behind it in which areas with part of
 * still + chi c < 0 have their four points.
 *     lanes   out: number of fours */
static const point_four *points_without_tension(const fl_patch_points *s, double chi, double still,
                                                int32_t *lanes)
{
    point_four *const own = s->point_lanes, *copy = NULL;
    const int32_t n = *lanes = count_lanes(s);
    const area_motion *a = s->area_motion;
    for (int32_t k = 0; k < s->areas; k++, a++) {
        const uint32_t at = a->k;
        if (still + chi * (a->mean - a->amplitude) < 0.0 && still + chi * (a->mean + a->amplitude) > 0.0) {
            if (!copy) copy = memcpy(own + n, own, (size_t)n * sizeof *own);
            for (uint32_t c = at; c < at + AREA_POINTS; c++)
                copy[c / FL_SIMD_WIDTH].e[c % FL_SIMD_WIDTH] = 0.0;
            copy[(*lanes)++] = four_point_area(own, a);
        }
    }
    return copy ? copy : own;
}

/* --- sums ----------------------------------------------------------------------------------------------- */

int fl_force_sum_elastic(fl_patch_points *s, fl_force_sum *q)
{
    *q = (fl_force_sum){0};
    if (s->n == 0) return 0;
    if (fl_reserve(&s->point_lanes, &s->point_lane_cap, 2 * count_lanes(s) + s->n / AREA_POINTS,
                   sizeof(point_four)))
        return -1;
    sum_elastic(s->point, s->n, s->point_lanes, q);
    return 0;
}

int fl_force_sum_motion(fl_patch_points *s, fl_vec3 v, fl_vec3 spin, fl_force_sum *q)
{
    if (s->n == 0) return 0;
    sum_motion(s->point_lanes, count_lanes(s), v, spin, q);
    if (find_areas(s)) return -1;
    q->du_approach += approach_correction(s);
    return 0;
}

void fl_force_sum_sliding(const fl_patch_points *s, fl_vec3 v, double *with_approach, double *square)
{
    double sum[2];
    sum_sliding(s->point_lanes, count_lanes(s), v, sum);
    *with_approach = sum[0], *square = sum[1];
}

void fl_force_sum_damping(const fl_patch_points *s, double chi, double speed_offset, fl_force_sum *q)
{
    if (s->n == 0) return;
    int32_t lanes;
    const double still = 1.0 + chi * speed_offset;
    const point_four *t = points_without_tension(s, chi, still, &lanes);
    sum_damped(t, lanes, chi, still, q);
}

void fl_force_sum_springs(const fl_patch_points *s, fl_spring_sums *q)
{
    double sum[FL_PRESSURE_MATRIX];
    *q = (fl_spring_sums){0};
    sum_springs(s->point_lanes, s->n, sum);
    for (int r = 0, m = 0; r < 6; r++)
        for (int c = r; c < 6; c++, m++) {
            if (c < 3) q->linear[r][c] = q->linear[c][r] = sum[m];
            else if (r < 3) q->coupling[c - 3][r] = sum[m];
            else q->angular[r - 3][c - 3] = q->angular[c - 3][r - 3] = sum[m];
        }
}

/* --- pressure ------------------------------------------------------------------------------------------- */

FL_SIMD_VERSIONS static void sum_pressure(const point_four *t, int32_t lanes, fl_pressure_moments *q)
{
    const fl_simd zero = {0};
    fl_simd all[FL_PRESSURE_MATRIX], e = zero, wide = zero, way[3] = {zero, zero, zero},
                                     turns[3] = {zero, zero, zero}, at[3] = {zero, zero, zero};
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) all[m] = zero;
    for (int32_t k = 0; k < lanes; k++) {
        fl_simd g[6] = {t[k].across[0], t[k].across[1], t[k].across[2]};
        CROSS((g + 3), t[k].arm, t[k].across);
        const fl_simd *arm = t[k].arm;
        e += t[k].e;
        wide += t[k].e * (arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]);
        for (int c = 0; c < 3; c++) {
            way[c] += t[k].e * g[c];
            turns[c] += t[k].e * g[3 + c];
            at[c] += t[k].e * arm[c];
        }
        add_outer_product(all, &t[k].e, g);
    }
    for (int m = 0; m < FL_PRESSURE_MATRIX; m++) q->damping[m] = fl_simd_sum(&all[m]);
    q->pressure = fl_simd_sum(&e), q->radius = fl_simd_sum(&wide);
    q->direction = sum_vector(way), q->torque = sum_vector(turns), q->centre = sum_vector(at);
}

void fl_force_sum_pressure(const fl_patch_points *s, fl_pressure_moments *q)
{
    *q = (fl_pressure_moments){0};
    sum_pressure(s->point_lanes, count_lanes(s), q);
    if (!(q->pressure > 0.0)) return;
    const double each = 1.0 / q->pressure;
    q->centre = v3_scale(each, q->centre);
    const double wide2 = each * q->radius - v3_norm2(q->centre);
    q->radius = wide2 > 0.0 ? sqrt(wide2) : 0.0;
}

double fl_force_sum_approach_speed(const fl_patch_points *s, int32_t k)
{
    return approach_speed_at(s->point_lanes, (uint32_t)k);
}
