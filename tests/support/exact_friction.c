/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "law/tangent.h"
#include "patch/patch_result.h"
#include "support/exact_friction.h"

/* Complete elliptic integrals K and E of the modulus k < 1, by the arithmetic-geometric mean. */
static void elliptic_integrals(double k, double *K, double *E)
{
    double a = 1.0, g = sqrt(1.0 - k * k), c = k, sum = 0.5 * k * k, power = 0.5;
    while (fabs(c) > 1e-9) { /* the next c is c^2/8a */
        const double next = 0.5 * (a + g);
        c = 0.5 * (a - g), g = sqrt(a * g), a = next, power *= 2.0;
        sum += power * c * c;
    }
    *K = 0.5 * PI / a;
    *E = *K * (1.0 - sum);
}

void exact_disc_friction(double e, double *F, double *M)
{
    double K, E;
    if (e == 0.0) {
        *F = 0.0, *M = 2.0 / 3.0;
    } else if (e == 1.0) {
        *F = 8.0 / (3.0 * PI), *M = 8.0 / (9.0 * PI);
    } else if (e < 1.0) {
        elliptic_integrals(e, &K, &E);
        *F = 4.0 / (3.0 * PI * e) * ((1.0 + e * e) * E - (1.0 - e * e) * K);
        *M = 4.0 / (9.0 * PI) * ((4.0 - 2.0 * e * e) * E - (1.0 - e * e) * K);
    } else {
        elliptic_integrals(1.0 / e, &K, &E);
        *F = 4.0 / (3.0 * PI) * ((1.0 + e * e) * E - (e * e - 1.0) * K);
        *M = 4.0 * e / (9.0 * PI) * ((4.0 - 2.0 * e * e) * E + (2.0 * e * e - 5.0 + 3.0 / (e * e)) * K);
    }
}

static double polygon_area(int n, const fl_vec3 *c)
{
    double sum = 0.0;
    for (int k = 0; k < n; k++) sum += v3_cross(c[k], c[(k + 1) % n]).z;
    return 0.5 * sum;
}

/* Sums over the edges, about a point: of h/6 [t2 r2 - t1 r1 + h^2 A] and of h/2 [h A n + (r2 - r1) t]. */
static double edge_sums(int n, const fl_vec3 *corner, fl_vec3 about, fl_vec3 *sum)
{
    double P = 0.0;
    *sum = v3(0, 0, 0);
    for (int k = 0; k < n; k++) {
        const fl_vec3 a = v3_sub(corner[k], about), b = v3_sub(corner[(k + 1) % n], about),
                      t = v3_unit(v3(b.x - a.x, b.y - a.y, 0.0)), out = v3(t.y, -t.x, 0.0);
        const double h = out.x * a.x + out.y * a.y, t1 = t.x * a.x + t.y * a.y, t2 = t.x * b.x + t.y * b.y,
                     r1 = hypot(a.x, a.y), r2 = hypot(b.x, b.y),
                     A = h != 0.0 ? asinh(t2 / fabs(h)) - asinh(t1 / fabs(h)) : 0.0;
        P += h / 6.0 * (t2 * r2 - t1 * r1 + h * h * A);
        *sum = v3_add(*sum, v3_scale(0.5 * h, v3_madd(v3_scale(h * A, out), r2 - r1, t)));
    }
    return P;
}

flat_wrench exact_polygon_friction(int n, const fl_vec3 *corner, fl_vec3 v, double w)
{
    const double each = 1.0 / polygon_area(n, corner), speed = hypot(v.x, v.y);
    fl_vec3 far = v3(0, 0, 0), sum;
    double size = 0.0;
    for (int k = 0; k < n; k++) {
        size = fmax(size, hypot(corner[k].x, corner[k].y));
        far = v3_add(far, v3_scale(1.0 / n, corner[k]));
    }
    if (!(fabs(w) * size > 1e-7 * speed)) { /* the point at rest is too far away: F along v, M of its centre */
        if (speed == 0.0) return (flat_wrench){0.0, 0.0, 0.0};
        fl_vec3 centre;
        polygon_second_moments(n, corner, &centre);
        const fl_vec3 u = v3_scale(1.0 / speed, v);
        return (flat_wrench){u.x, u.y, centre.x * u.y - centre.y * u.x};
    }
    const fl_vec3 rest = v3(-v.y / w, v.x / w, 0.0);
    const double P = each * fabs(w) * edge_sums(n, corner, rest, &sum), way = w > 0.0 ? each : -each;
    const flat_wrench f = {-way * sum.y, way * sum.x, 0.0};
    return (flat_wrench){f.x, f.y, (P - f.x * v.x - f.y * v.y) / w};
}

double polygon_mean_distance(int n, const fl_vec3 *corner)
{
    fl_vec3 sum;
    return edge_sums(n, corner, v3(0, 0, 0), &sum) / polygon_area(n, corner);
}

fl_sym3 polygon_second_moments(int n, const fl_vec3 *corner, fl_vec3 *centre)
{
    double A = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (int k = 0; k < n; k++) {
        const fl_vec3 a = corner[k], b = corner[(k + 1) % n];
        const double d = 0.5 * (a.x * b.y - a.y * b.x);
        A += d;
        x += d * (a.x + b.x) / 3.0, y += d * (a.y + b.y) / 3.0;
        xx += d * (a.x * a.x + a.x * b.x + b.x * b.x) / 6.0;
        yy += d * (a.y * a.y + a.y * b.y + b.y * b.y) / 6.0;
        xy += d * (2.0 * a.x * a.y + a.x * b.y + b.x * a.y + 2.0 * b.x * b.y) / 12.0;
    }
    *centre = v3(x / A, y / A, 0.0);
    return (fl_sym3){.xx = xx / A - centre->x * centre->x,
                     .xy = xy / A - centre->x * centre->y,
                     .yy = yy / A - centre->y * centre->y};
}

flat_wrench law_friction(fl_sym3 C, fl_vec3 v, double w)
{
    const fl_pressure_shape s = fl_pressure_shape_of(C, v3(0, 0, 1));
    const fl_friction_shape shape = fl_friction_shape_of(s.elongation);
    const fl_friction_wrench z = {v3(v.x, v.y, 0.0), s.arm * w};
    const fl_friction_potential p = fl_friction_potential_of(&shape, z);
    const fl_friction_wrench f = fl_friction_wrench_of(&shape, &p, z);
    const double each = p.p2 > 0.0 ? 1.0 / sqrt(p.p2) : 0.0;
    return (flat_wrench){each * f.f.x, each * f.f.y, each * s.arm * f.m};
}

/* x, y, angle, vx, vy, w */
enum { PLATE = 6 };

typedef struct {
    flat_wrench (*friction)(const void *context, fl_vec3 v, double w);
    const void *context;
    double mu_g, gyration2;
} plate_equation;

static void rate_of_plate(const plate_equation *q, const double y[PLATE], double rate[PLATE])
{
    const double c = cos(y[2]), s = sin(y[2]);
    const flat_wrench f = q->friction(q->context, v3(c * y[3] + s * y[4], -s * y[3] + c * y[4], 0.0), y[5]);
    for (int k = 0; k < 3; k++) rate[k] = y[3 + k];
    rate[3] = -q->mu_g * (c * f.x - s * f.y), rate[4] = -q->mu_g * (s * f.x + c * f.y);
    rate[5] = -q->mu_g * f.m / q->gyration2;
}

static void step_plate(const plate_equation *q, double y[PLATE], double dt)
{
    static const double at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1, 2, 2, 1};
    double k[4][PLATE], sum[PLATE] = {0};
    for (int s = 0; s < 4; s++) {
        double t[PLATE];
        for (int c = 0; c < PLATE; c++) t[c] = y[c] + (s ? at[s] * dt * k[s - 1][c] : 0.0);
        rate_of_plate(q, t, k[s]);
        for (int c = 0; c < PLATE; c++) sum[c] += weight[s] * k[s][c] / 6.0;
    }
    for (int c = 0; c < PLATE; c++) y[c] += dt * sum[c];
}

plate_stop stop_of_plate(flat_wrench (*friction)(const void *context, fl_vec3 v, double w), const void *context,
                         double mu_g, double gyration2, fl_vec3 v, double w, double look,
                         double slow)
{
    const plate_equation q = {friction, context, mu_g, gyration2};
    double y[PLATE] = {0, 0, 0, v.x, v.y, w}, t = 0.0;
    plate_stop r = {.time = 0.0};
    for (;;) {
        const double speed = sqrt(y[3] * y[3] + y[4] * y[4] + gyration2 * y[5] * y[5]);
        double dt = fmin(2e-4, 0.02 * speed / mu_g); /* steps shrink with the speed: the stop is a corner */
        if (speed < 1e-8) break;
        if (t < look && t + dt >= look) {
            step_plate(&q, y, look - t);
            t = look;
            r.v = v3(y[3], y[4], 0.0), r.w = y[5];
            continue;
        }
        step_plate(&q, y, dt);
        t += dt;
        if (speed > slow) r.ratio = fabs(y[5]) > 0.0 ? hypot(y[3], y[4]) / fabs(y[5]) : INFINITY;
    }
    r.time = t, r.x = v3(y[0], y[1], 0.0), r.angle = y[2];
    return r;
}
