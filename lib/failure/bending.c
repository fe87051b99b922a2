/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "failure/bending.h"
#include <math.h>
#include "base/fast_math.h"
#include "base/pi.h"

enum { SAMPLES = 32, REFINEMENTS = 24, BAND = 4, UNKNOWNS = 2 * FL_BEAM_NODES, SATURATION_ROUNDS = 8 };
/* L/l_b from which a floe bends on its foundation. */
#define LONG 1.5
/* N over sqrt(k E I) b: the beam buckles at 2. */
#define MOST_PUSH 0.67
/* 2 tan(30 deg) */
#define WEDGE 1.1547005383792515

double fl_bending_length(const fl_bending_law *law, double h)
{
    if (!(law->foundation > 0.0)) return INFINITY;
    return sqrt(sqrt(law->young * h * h * h / (3.0 * law->foundation)));
}

/* --- statics ------------------------------------------------------------------------------------ */

/* The linear field that balances the loads, and the mean push along x and y per area. */
typedef struct {
    double a, gx, gy, fx, fy;
} balance;

static balance balance_of(const fl_plan *q, const fl_plan_load *load, int32_t n)
{
    const fl_plan_moments m = fl_plan_part(q, 1.0, 0.0, INFINITY);
    double P = 0.0, Px = 0.0, Py = 0.0, Fx = 0.0, Fy = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const fl_plan_load *l = &load[k];
        P += l->force.z;
        Px += l->force.z * l->x.x - l->force.x * l->x.z; /* moments, with those of horizontal forces */
        Py += l->force.z * l->x.y - l->force.y * l->x.z;
        Fx += l->force.x, Fy += l->force.y;
    }
    const double cx = m.x / m.area, cy = m.y / m.area, xx = m.xx - m.x * cx, xy = m.xy - m.x * cy,
                 yy = m.yy - m.y * cy, det = xx * yy - xy * xy, bx = -(Px - P * cx), by = -(Py - P * cy);
    balance r;
    r.gx = (bx * yy - by * xy) / det;
    r.gy = (by * xx - bx * xy) / det;
    r.a = -P / m.area - r.gx * cx - r.gy * cy;
    r.fx = Fx / m.area, r.fy = Fy / m.area;
    return r;
}

/* M and N of the section e.x = c: moment about it of what acts on the part e.x < c, and the force along e on
 * that part, which presses the section. */
static double section_moment(const fl_plan *q, const balance *s, const fl_plan_load *load, int32_t n,
                             double ex, double ey, double c, double *push)
{
    const fl_plan_moments m = fl_plan_part(q, ex, ey, c);
    const double area = s->a * m.area + s->gx * m.x + s->gy * m.y, first = s->a * (ex * m.x + ey * m.y) +
                                                                           s->gx * (ex * m.xx + ey * m.xy) +
                                                                           s->gy * (ex * m.xy + ey * m.yy);
    double M = c * area - first;
    *push = -(s->fx * ex + s->fy * ey) * m.area;
    for (int32_t k = 0; k < n; k++) {
        const fl_plan_load *l = &load[k];
        const double at = ex * l->x.x + ey * l->x.y, along = ex * l->force.x + ey * l->force.y;
        if (at > c) continue;
        M += l->force.z * (c - at) + along * l->x.z;
        *push += along;
    }
    return M;
}

/* --- the beam ----------------------------------------------------------------------------------- */

/* Solves the banded symmetric system in place by LDL^T; a[i][k] is the element (i, i + k). */
static int solve_band(double a[UNKNOWNS][BAND], double *x)
{
    for (int i = 0; i < UNKNOWNS; i++) {
        if (!(a[i][0] > 0.0)) return -1;
        for (int k = 1; k < BAND && i + k < UNKNOWNS; k++) {
            const double l = a[i][k] / a[i][0];
            for (int m = k; m < BAND && i + m < UNKNOWNS; m++) a[i + k][m - k] -= l * a[i][m];
            x[i + k] -= l * x[i];
        }
    }
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        x[i] /= a[i][0];
        for (int k = 1; k < BAND && i + k < UNKNOWNS; k++) x[i] -= a[i][k] / a[i][0] * x[i + k];
    }
    return 0;
}

/* Stiffness of a Hermite element of length l, and the consistent foundation over kb l/420; upper
 * triangles. */
static void element_of(double l, double EI, double kb, double B[4][4], double F[4][4])
{
    const double s = EI / (l * l * l), f = kb * l / 420.0, l2 = l * l;
    const double b[4][4] = {{12, 6 * l, -12, 6 * l},
                            {0, 4 * l2, -6 * l, 2 * l2},
                            {0, 0, 12, -6 * l},
                            {0, 0, 0, 4 * l2}},
                 c[4][4] = {{156, 22 * l, 54, -13 * l},
                            {0, 4 * l2, 13 * l, -3 * l2},
                            {0, 0, 156, -22 * l},
                            {0, 0, 0, 4 * l2}};
    for (int i = 0; i < 4; i++)
        for (int j = i; j < 4; j++) B[i][j] = s * b[i][j], F[i][j] = f * c[i][j];
}

double fl_beam_node(double L, int n)
{
    const double t = (double)n / (FL_BEAM_NODES - 1);
    return L * t * t;
}

/* The state of the foundation under an element, 1: out of the water, -1: flooded, and its reaction there. */
typedef struct {
    int state;
    double reaction; /* per length [N/m] */
} beam_end;

/* M at the nodes by equilibrium of what is to the left of them. */
static void sum_moments(double P, double C, double L, const double k[], const beam_end *end, const double *u,
                        double M[FL_BEAM_NODES])
{
    double V = P, at = C;
    M[0] = C;
    for (int e = 0; e < FL_BEAM_NODES - 1; e++) {
        const double l = fl_beam_node(L, e + 1) - fl_beam_node(L, e);
        double B[4][4], F[4][4], q[4];
        element_of(l, 0.0, k[e], B, F);
        for (int i = 0; i < 4; i++) {
            q[i] = 0.0;
            for (int j = 0; j < 4; j++) q[i] += (i <= j ? F[i][j] : F[j][i]) * u[2 * e + j];
        }
        const double r = end[e].reaction * l;
        q[0] += 0.5 * r, q[1] += r * l / 12.0, q[2] += 0.5 * r, q[3] -= r * l / 12.0;
        V -= q[0];
        at += V * l + q[1] + q[3];
        V -= q[2];
        M[e + 1] = at;
    }
}

void fl_bending_beam(const fl_bending_law *law, double h, double L, const double width[FL_BEAM_NODES],
                     double P, double C, double M[FL_BEAM_NODES], double *deflection)
{
    const double rho = law->density, up = rho > 0.0 ? rho * h : INFINITY,
                 down = rho > 0.0 ? (1.0 - rho) * h : INFINITY; /* [m] */
    beam_end end[FL_BEAM_NODES - 1] = {{0}};
    double u[UNKNOWNS] = {0}, k[FL_BEAM_NODES - 1];
    for (int round = 0; round < SATURATION_ROUNDS; round++) {
        double a[UNKNOWNS][BAND] = {{0}}, f[UNKNOWNS] = {0};
        int changed = 0;
        f[0] = P, f[1] = -C;
        for (int e = 0; e < FL_BEAM_NODES - 1; e++) {
            const double l = fl_beam_node(L, e + 1) - fl_beam_node(L, e), b = 0.5 * (width[e] + width[e + 1]),
                         EI = law->young * h * h * h * b / 12.0, kb = law->foundation * b;
            double B[4][4], F[4][4];
            k[e] = end[e].state ? 1e-6 * kb : kb;
            end[e].reaction = end[e].state > 0 ? kb * up : end[e].state < 0 ? -kb * down : 0.0;
            element_of(l, EI, k[e], B, F);
            for (int i = 0; i < 4; i++)
                for (int j = i; j < 4; j++) a[2 * e + i][j - i] += B[i][j] + F[i][j];
            const double r = end[e].reaction * l;
            f[2 * e] -= 0.5 * r, f[2 * e + 1] -= r * l / 12.0;
            f[2 * e + 2] -= 0.5 * r, f[2 * e + 3] += r * l / 12.0;
        }
        if (solve_band(a, f)) break;
        for (int i = 0; i < UNKNOWNS; i++) u[i] = f[i];
        sum_moments(P, C, L, k, end, u, M);
        for (int e = 0; e < FL_BEAM_NODES - 1; e++) {
            const double w = 0.5 * (u[2 * e] + u[2 * e + 2]);
            const int now = w > up ? 1 : w < -down ? -1 : 0;
            changed |= now != end[e].state;
            end[e].state = now;
        }
        if (!changed) break;
    }
    *deflection = u[0];
}

/* --- the break ---------------------------------------------------------------------------------- */

/* One direction under a load. */
typedef struct {
    const fl_plan *q;
    const fl_bending_law *law;
    const fl_plan_load *load;
    int32_t n, k;
    balance balance;
    double ex, ey, at;           /* e, and e.x of the load */
    double length, behind, area; /* area: of the plan */
    int is_beam, small;
    double M[FL_BEAM_NODES];
} direction;

/* Width that bends at distance x.  Of a direction askew to the rim the plan goes on behind the load: its mean
 * width there bends as well. */
static double width_at(const direction *d, double x, double *whole)
{
    fl_vec2 middle;
    *whole = fl_plan_width(d->q, d->ex, d->ey, d->at + x, &middle);
    return fmin(*whole, d->load[d->k].width + d->behind + WEDGE * d->law->wedges * x);
}

/* M of the beam at x: the parabola through three nodes. */
static double beam_moment(const direction *d, double x)
{
    const double s = sqrt(x / d->length) * (FL_BEAM_NODES - 1);
    int n = (int)(s + 0.5);
    n = n < 1 ? 1 : n > FL_BEAM_NODES - 2 ? FL_BEAM_NODES - 2 : n;
    const double a = fl_beam_node(d->length, n - 1), b = fl_beam_node(d->length, n),
                 c = fl_beam_node(d->length, n + 1);
    return d->M[n - 1] * (x - b) * (x - c) / ((a - b) * (a - c)) +
           d->M[n] * (x - a) * (x - c) / ((b - a) * (b - c)) +
           d->M[n + 1] * (x - a) * (x - b) / ((c - a) * (c - b));
}

static double stress_at(direction *d, double x, fl_bending *out)
{
    double whole, push, M;
    const double b = width_at(d, x, &whole), h = d->q->thickness;
    if (!(b > 0.0)) return 0.0;
    if (d->is_beam) {
        M = beam_moment(d, x);
        const fl_plan_load *l = &d->load[d->k];
        push = d->ex * l->force.x + d->ey * l->force.y;
    } else {
        M = section_moment(d->q, &d->balance, d->load, d->n, d->ex, d->ey, d->at + x, &push);
    }
    *out = (fl_bending){.ratio = (6.0 * fabs(M) / (b * h * h) - push / (b * h)) / d->law->strength,
                        .ex = d->ex,
                        .ey = d->ey,
                        .c = d->at + x,
                        .moment = fabs(M),
                        .width = b,
                        .distance = x,
                        .whole = whole};
    const double stiff = sqrt(d->law->foundation * d->law->young * h * h * h / 12.0) * b;
    if (out->ratio > 1.0 && d->law->least_area > 0.0) {
        const double area = fl_plan_part(d->q, d->ex, d->ey, d->at + x).area;
        out->small = fmin(area, d->area - area) < d->law->least_area;
    }
    out->buckles = d->law->foundation > 0.0 && push > MOST_PUSH * stiff;
    if (out->small) d->small = 1, out->ratio = 0.0;
    return out->ratio;
}

/* The largest stress along a direction. */
static fl_bending search_direction(direction *d)
{
    fl_bending best = {0}, now;
    double from, to, whole;
    fl_plan_extent(d->q, d->ex, d->ey, &from, &to);
    d->length = to - d->at;
    if (!(d->length > 0.02 * (to - from))) return best;
    const double back = d->at - from;
    d->behind = back > 1e-3 * (to - from) ? 2.0 * fl_plan_part(d->q, d->ex, d->ey, d->at).area / back : 0.0;
    d->is_beam = d->length >= LONG * fl_bending_length(d->law, d->q->thickness);
    if (d->is_beam) {
        const fl_plan_load *l = &d->load[d->k];
        double width[FL_BEAM_NODES], deflection;
        for (int n = 0; n < FL_BEAM_NODES; n++) {
            const double x = fmin(fmax(fl_beam_node(d->length, n), 1e-4 * d->length), 0.9999 * d->length);
            width[n] = fmax(width_at(d, x, &whole), 1e-3 * d->length);
        }
        fl_bending_beam(d->law, d->q->thickness, d->length, width, l->force.z,
                        (d->ex * l->force.x + d->ey * l->force.y) * l->x.z, d->M, &deflection);
    }
    double at = 0.0;
    for (int s = 1; s < SAMPLES; s++) {
        const double x = d->length * s / SAMPLES;
        if (stress_at(d, x, &now) > best.ratio) best = now, at = x;
    }
    /* golden section between the neighbours of the best sample */
    const double gold = 0.6180339887498949;
    double a = fmax(at - d->length / SAMPLES, 1e-3 * d->length),
           b = fmin(at + d->length / SAMPLES, d->length);
    for (int s = 0; s < REFINEMENTS && best.ratio > 0.0; s++) {
        const double x1 = b - gold * (b - a), x2 = a + gold * (b - a);
        fl_bending one, two;
        if (stress_at(d, x1, &one) >= stress_at(d, x2, &two)) b = x2;
        else a = x1;
        if (one.ratio > best.ratio) best = one;
        if (two.ratio > best.ratio) best = two;
    }
    return best;
}

fl_bending fl_bending_of(const fl_plan *q, const fl_bending_law *law, const fl_plan_load *load, int32_t n,
                         int32_t k)
{
    const fl_plan_moments all = fl_plan_part(q, 1.0, 0.0, INFINITY);
    direction d = {.q = q,
                   .law = law,
                   .load = load,
                   .n = n,
                   .k = k,
                   .area = all.area,
                   .balance = balance_of(q, load, n)};
    fl_bending best = {0};
    const double inward = fl_atan2(all.y / all.area - load[k].x.y, all.x / all.area - load[k].x.x),
                 step = PI / (FL_BENDING_DIRECTIONS + 1);
    int buckles = 0;
    for (int m = 0; m < FL_BENDING_DIRECTIONS; m++) {
        /* 0, -1, 1, -2, ...: the middle one first, which counts among equals */
        const int side = m % 2 ? -(m + 1) / 2 : m / 2;
        fl_cos_sin(inward + side * step, &d.ex, &d.ey);
        d.at = d.ex * load[k].x.x + d.ey * load[k].x.y;
        const fl_bending one = search_direction(&d);
        buckles |= one.ratio > 1.0 && one.buckles;
        if (!one.buckles && one.ratio > best.ratio * (1.0 + 1e-12)) best = one;
    }
    best.buckles = buckles, best.small = d.small;
    return best;
}
