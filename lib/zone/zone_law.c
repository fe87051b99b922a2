/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "zone/zone_law.h"
#include <string.h>
#include "base/pi.h"

/* Newton's iteration for the rotation ends below this change, at the latest after so many. */
static const double ROTATION_CHANGE = 1e-14;
enum { ROTATION_STEPS = 40, SWEEPS = 20, PLANES = 6 };
/* Stress beyond a plane over the scale of the stress that is rounding. */
static const double BEYOND = 1e-12;

fl_zone_material fl_zone_material_of(double density, double young, double poisson)
{
    const double mu = 0.5 * young / (1.0 + poisson);
    return (fl_zone_material){.density = density,
                              .lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson),
                              .mu = mu,
                              .cohesion = INFINITY,
                              .tension = INFINITY,
                              .cos_phi = 1.0};
}

void fl_zone_material_set_strength(fl_zone_material *m, double cohesion, double friction_angle,
                                   double tension, double dilation)
{
    m->law = FL_ZONE_MOHR_COULOMB;
    m->sin_phi = sin(friction_angle * PI / 180.0), m->cos_phi = cos(friction_angle * PI / 180.0);
    m->sin_psi = sin(dilation * PI / 180.0);
    m->cohesion = cohesion;
    m->tension = m->sin_phi > 0.0 ? fmin(tension, cohesion * m->cos_phi / m->sin_phi) : tension;
}

/* --- rotation ----------------------------------------------------------------------------------- */

static fl_mat3 cofactors(const fl_mat3 *a, double *det)
{
    const fl_vec3 x = m3_col(*a, 0), y = m3_col(*a, 1), z = m3_col(*a, 2), u = v3_cross(y, z),
                  v = v3_cross(z, x), w = v3_cross(x, y);
    *det = v3_dot(x, u);
    return (fl_mat3){{{u.x, v.x, w.x}, {u.y, v.y, w.y}, {u.z, v.z, w.z}}};
}

int fl_zone_rotation(const fl_mat3 *F, fl_mat3 *R)
{
    *R = *F;
    for (int step = 0; step < ROTATION_STEPS; step++) {
        double det, change = 0.0;
        const fl_mat3 C = cofactors(R, &det);
        if (!(det > 0.0)) return 0;
        const double s = 0.5 / det;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const double now = 0.5 * R->m[i][j] + s * C.m[i][j], d = fabs(now - R->m[i][j]);
                change = d > change ? d : change;
                R->m[i][j] = now;
            }
        /* the error after a step is the square of the change */
        if (change * change < ROTATION_CHANGE) break;
    }
    return 1;
}

fl_sym3 fl_zone_strain(const fl_mat3 *F, const fl_mat3 *R)
{
    const fl_vec3 f[3] = {m3_col(*F, 0), m3_col(*F, 1), m3_col(*F, 2)},
                  r[3] = {m3_col(*R, 0), m3_col(*R, 1), m3_col(*R, 2)};
    return (fl_sym3){.xx = v3_dot(r[0], f[0]) - 1.0,
                     .yy = v3_dot(r[1], f[1]) - 1.0,
                     .zz = v3_dot(r[2], f[2]) - 1.0,
                     .xy = 0.5 * (v3_dot(r[0], f[1]) + v3_dot(r[1], f[0])),
                     .xz = 0.5 * (v3_dot(r[0], f[2]) + v3_dot(r[2], f[0])),
                     .yz = 0.5 * (v3_dot(r[1], f[2]) + v3_dot(r[2], f[1]))};
}

/* --- principal stresses ------------------------------------------------------------------------- */

/* Turns the axes p and q so that a[p][q] becomes 0 (Jacobi). */
static void turn_axes(double a[3][3], fl_mat3 *V, int p, int q)
{
    if (a[p][q] == 0.0) return;
    const double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]),
                 t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0)),
                 c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        const double x = a[p][k], y = a[q][k];
        a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        const double x = V->m[k][p], y = V->m[k][q];
        V->m[k][p] = c * x - s * y, V->m[k][q] = s * x + c * y;
    }
    a[p][q] = a[q][p] = 0.0;
}

fl_vec3 fl_zone_principal(fl_sym3 s, fl_mat3 *axes)
{
    double a[3][3] = {{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}};
    fl_mat3 V = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const double size = fabs(s.xx) + fabs(s.yy) + fabs(s.zz) + fabs(s.xy) + fabs(s.xz) + fabs(s.yz);
    for (int k = 0; k < SWEEPS; k++) {
        if (fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]) <= 1e-17 * size) break;
        turn_axes(a, &V, 0, 1), turn_axes(a, &V, 0, 2), turn_axes(a, &V, 1, 2);
    }
    int at[3] = {0, 1, 2};
    for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2 - k; l++)
            if (a[at[l]][at[l]] < a[at[l + 1]][at[l + 1]]) {
                const int swap = at[l];
                at[l] = at[l + 1], at[l + 1] = swap;
            }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) axes->m[r][c] = V.m[r][at[c]];
    return v3(a[at[0]][at[0]], a[at[1]][at[1]], a[at[2]][at[2]]);
}

/* --- Mohr-Coulomb ------------------------------------------------------------------------------- */

/* The planes in principal stresses: a.s <= limit, flow along r. */
typedef struct {
    double a[PLANES][3], r[PLANES][3], limit[PLANES];
    int n;
} yield_planes;

static yield_planes planes_of(const fl_zone_material *m)
{
    static const int HIGH[3] = {0, 1, 0}, LOW[3] = {2, 2, 1};
    yield_planes y = {.n = isfinite(m->tension) ? PLANES : 3};
    for (int k = 0; k < 3; k++) {
        y.a[k][HIGH[k]] = 1.0 + m->sin_phi, y.a[k][LOW[k]] = -(1.0 - m->sin_phi);
        y.r[k][HIGH[k]] = 1.0 + m->sin_psi, y.r[k][LOW[k]] = -(1.0 - m->sin_psi);
        y.limit[k] = 2.0 * m->cohesion * m->cos_phi;
        y.a[3 + k][k] = y.r[3 + k][k] = 1.0;
        y.limit[3 + k] = m->tension;
    }
    return y;
}

static double product3(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Solves k <= 3 equations by elimination with pivots; 0 if they have no one solution. */
static int solve_few(int k, double a[3][4])
{
    for (int c = 0; c < k; c++) {
        int best = c;
        for (int r = c + 1; r < k; r++)
            if (fabs(a[r][c]) > fabs(a[best][c])) best = r;
        double row[4];
        memcpy(row, a[c], sizeof row), memcpy(a[c], a[best], sizeof row), memcpy(a[best], row, sizeof row);
        if (!(fabs(a[c][c]) > 1e-12)) return 0;
        for (int r = 0; r < k; r++) {
            if (r == c) continue;
            const double f = a[r][c] / a[c][c];
            for (int e = c; e < 4; e++) a[r][e] -= f * a[c][e];
        }
    }
    return 1;
}

/* The stress on the planes of the set (bits), if it is where trial returns to. */
static int return_to(const yield_planes *y, const fl_zone_material *m, unsigned set, const double trial[3],
                     double scale, double out[3])
{
    const double unit = 2.0 * m->mu;
    int at[3], k = 0;
    double A[3][4] = {{0}}, Dr[3][3];
    for (int p = 0; p < y->n; p++)
        if (set >> p & 1) at[k++] = p;
    for (int i = 0; i < k; i++) {
        const double *r = y->r[at[i]], trace = m->lambda * (r[0] + r[1] + r[2]);
        for (int e = 0; e < 3; e++) Dr[i][e] = (trace + 2.0 * m->mu * r[e]) / unit;
    }
    for (int i = 0; i < k; i++) {
        for (int j = 0; j < k; j++) A[i][j] = product3(y->a[at[i]], Dr[j]);
        A[i][3] = (product3(y->a[at[i]], trial) - y->limit[at[i]]) / scale;
    }
    if (!solve_few(k, A)) return 0;
    for (int e = 0; e < 3; e++) out[e] = trial[e];
    for (int i = 0; i < k; i++) {
        const double l = A[i][3] / A[i][i];
        if (l < 0.0) return 0;
        for (int e = 0; e < 3; e++) out[e] -= scale * l * Dr[i][e];
    }
    for (int p = 0; p < y->n; p++)
        if (product3(y->a[p], out) - y->limit[p] > BEYOND * scale) return 0;
    return 1;
}

/* The stress that the trial stress t returns to. */
static void return_stress(const fl_zone_material *m, const double t[3], double out[3])
{
    const yield_planes y = planes_of(m);
    const double scale = fabs(t[0]) + fabs(t[1]) + fabs(t[2]) + y.limit[0];
    for (int size = 1; size <= 3; size++)
        for (unsigned set = 1; set < 1u << y.n; set++)
            if (__builtin_popcount(set) == size && return_to(&y, m, set, t, scale, out)) return;
    /* flow too far from the normal to reach any corner: the apex */
    const double apex = fmin(m->tension, m->sin_phi > 0.0 ? m->cohesion * m->cos_phi / m->sin_phi : INFINITY);
    for (int e = 0; e < 3; e++) out[e] = fmin(t[e], apex);
}

/* False where a bound by invariants shows that the stress is elastic. */
static int may_yield(const fl_zone_material *m, fl_sym3 s)
{
    const double p = (s.xx + s.yy + s.zz) / 3.0, x = s.xx - p, y = s.yy - p, z = s.zz - p,
                 J = 0.5 * (x * x + y * y + z * z) + s.xy * s.xy + s.xz * s.xz + s.yz * s.yz, root = sqrt(J);
    /* s1 - s3 <= 2 sqrt(J), |s2 - p| <= sqrt(J/3), s1 - p <= 2 sqrt(J/3) */
    return 2.0 * root + (2.0 * p + 0.5774 * root) * m->sin_phi > 2.0 * m->cohesion * m->cos_phi ||
           p + 1.1548 * root > m->tension;
}

static fl_sym3 elastic_stress(const fl_zone_material *m, fl_sym3 e)
{
    return s3_add(m->initial_stress,
                  s3_add(s3_isotropic(m->lambda * (e.xx + e.yy + e.zz)), s3_times(2.0 * m->mu, e)));
}

static double double_product(fl_sym3 a, fl_sym3 b)
{
    return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
}

fl_sym3 fl_zone_stress(const fl_zone_material *m, fl_sym3 strain, fl_sym3 *plastic, double *lost)
{
    if (!plastic) return elastic_stress(m, strain);
    const fl_sym3 trial = elastic_stress(m, s3_add(strain, s3_times(-1.0, *plastic)));
    if (!may_yield(m, trial)) return trial;
    fl_mat3 axes;
    const fl_vec3 t = fl_zone_principal(trial, &axes);
    const double limit = 2.0 * m->cohesion * m->cos_phi;
    if (!(t.x * (1.0 + m->sin_phi) - t.z * (1.0 - m->sin_phi) > limit) && !(t.x > m->tension)) return trial;
    double s[3];
    return_stress(m, (double[3]){t.x, t.y, t.z}, s);
    /* e_p grows by D^-1 (trial - s) */
    const double dp = (t.x - s[0] + t.y - s[1] + t.z - s[2]) / (3.0 * m->lambda + 2.0 * m->mu),
                 half = 0.5 / m->mu;
    const fl_vec3 d = v3(half * (t.x - s[0] - m->lambda * dp), half * (t.y - s[1] - m->lambda * dp),
                         half * (t.z - s[2] - m->lambda * dp));
    const fl_sym3 flow = s3_from_principal(&axes, d), stress = s3_from_principal(&axes, v3(s[0], s[1], s[2]));
    *plastic = s3_add(*plastic, flow);
    *lost += double_product(stress, flow);
    return stress;
}

double fl_zone_energy(const fl_zone_material *m, fl_sym3 strain, const fl_sym3 *plastic)
{
    const fl_sym3 e = plastic ? s3_add(strain, s3_times(-1.0, *plastic)) : strain;
    const double trace = e.xx + e.yy + e.zz;
    return 0.5 * m->lambda * trace * trace + m->mu * double_product(e, e) +
           double_product(m->initial_stress, e);
}
