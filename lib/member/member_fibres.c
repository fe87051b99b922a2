/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_fibres.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"

enum { ROUND = 40, LAYERS = 6, ACROSS = 16 };
/* Wall over diameter up to which one layer of fibres stands for a pipe. */
static const double THIN = 0.1;

static int allocate(fl_member_fibre_section *f, int n, fl_err *err)
{
    f->n = n;
    f->y = fl_alloc(n, sizeof *f->y, err);
    f->z = fl_alloc(n, sizeof *f->z, err);
    f->a = fl_alloc(n, sizeof *f->a, err);
    return err->code ? -1 : 0;
}

/* Layers of equal area, each at the radius of its own second moment: I = A rho2/2. */
static void make_pipe(fl_member_fibre_section *f, double d, double wall)
{
    const int layers = f->n / ROUND;
    const double out = 0.5 * d, in = out - wall, each = (out * out - in * in) / layers;
    for (int l = 0; l < layers; l++) {
        const double r0 = in * in + l * each, rho = sqrt(0.5 * (r0 + r0 + each)); /* mean of squares */
        for (int k = 0; k < ROUND; k++) {
            const double angle = 2.0 * PI * (k + 0.5) / ROUND;
            f->y[l * ROUND + k] = rho * cos(angle);
            f->z[l * ROUND + k] = rho * sin(angle);
            f->a[l * ROUND + k] = PI * each / ROUND;
        }
    }
}

/* Midpoints of n strips have 1 - 1/n2 of the second moment: moved outward by the root of that. */
static void make_rectangle(fl_member_fibre_section *f, double b, double h)
{
    const double out = 1.0 / sqrt(1.0 - 1.0 / (ACROSS * ACROSS));
    for (int r = 0; r < ACROSS; r++)
        for (int c = 0; c < ACROSS; c++) {
            f->y[r * ACROSS + c] = out * b * ((r + 0.5) / ACROSS - 0.5);
            f->z[r * ACROSS + c] = out * h * ((c + 0.5) / ACROSS - 0.5);
            f->a[r * ACROSS + c] = b * h / (ACROSS * ACROSS);
        }
}

int fl_member_fibre_section_make(fl_member_fibre_section *f, const fl_member_section *s, fl_err *err)
{
    const double *x = s->given;
    *f = (fl_member_fibre_section){.yield = s->yield, .limit = s->limit > 0.0 ? s->limit : INFINITY};
    if (s->form == FL_MEMBER_PIPE) {
        f->e = x[2];
        if (allocate(f, x[1] <= THIN * x[0] ? ROUND : ROUND * LAYERS, err)) return -1;
        make_pipe(f, x[0], x[1]);
    } else if (s->form == FL_MEMBER_RECTANGLE) {
        f->e = x[2];
        if (allocate(f, ACROSS * ACROSS, err)) return -1;
        make_rectangle(f, x[0], x[1]);
    } else {
        f->e = x[1];
        if (allocate(f, 1, err)) return -1;
        f->a[0] = x[0];
    }
    f->back = s->hardening > 0.0 ? f->e * s->hardening / (f->e - s->hardening) : 0.0;
    for (int k = 0; k < f->n; k++) {
        f->area += f->a[k];
        f->iy += f->a[k] * f->z[k] * f->z[k];
        f->iz += f->a[k] * f->y[k] * f->y[k];
        f->reach = fmax(f->reach, sqrt(f->y[k] * f->y[k] + f->z[k] * f->z[k]));
    }
    return 0;
}

void fl_member_fibre_section_free(fl_member_fibre_section *f)
{
    free(f->y), free(f->z), free(f->a);
    *f = (fl_member_fibre_section){0};
}

void fl_member_fibres_update(fl_member_fibres *f, double length, double stretch, double turn_y, double turn_z)
{
    const fl_member_fibre_section *s = f->section;
    const double over = 1.0 / length, e0 = over * stretch, ky = over * turn_y, kz = over * turn_z;
    const double bound = fabs(e0) + s->reach * sqrt(ky * ky + kz * kz);
    if (!f->yielded && bound * s->e < s->yield) { /* elastic throughout */
        f->stored = 0.5 * length * s->e * (s->area * e0 * e0 + s->iy * ky * ky + s->iz * kz * kz);
        f->flow = 0.0;
        f->strain = bound;
        f->changed = 0;
        f->deform[0] = f->deform[1] = f->deform[2] = 0.0;
        return;
    }
    double p0 = 0.0, py = 0.0, pz = 0.0, stored = 0.0, flow = 0.0, most = 0.0;
    for (int k = 0; k < s->n; k++) {
        const double eps = e0 + s->z[k] * ky - s->y[k] * kz;
        double p = f->plastic[k];
        const double over_back = s->e * (eps - p) - s->back * p, excess = fabs(over_back) - s->yield;
        if (excess > 0.0 && !f->frozen) {
            const double dp = excess / (s->e + s->back);
            p += over_back > 0.0 ? dp : -dp;
            flow += s->a[k] * s->yield * dp;
        }
        f->trial[k] = p;
        const double elastic = eps - p, part = s->a[k] * p;
        p0 += part;
        py += part * s->z[k];
        pz -= part * s->y[k];
        stored += s->a[k] * (s->e * elastic * elastic + s->back * p * p);
        if (fabs(eps) > most) most = fabs(eps);
    }
    f->changed = 1;
    f->stored = 0.5 * length * stored;
    f->flow = length * flow;
    f->strain = most;
    f->deform[0] = p0 / s->area;
    f->deform[1] = s->iy > 0.0 ? py / s->iy : 0.0;
    f->deform[2] = s->iz > 0.0 ? pz / s->iz : 0.0;
}

int fl_member_fibres_commit(fl_member_fibres *f, double energy)
{
    if (f->ruptured) return 0;
    if (f->changed) {
        f->dissipated += f->flow;
        f->flow = 0.0;
        memcpy(f->plastic, f->trial, (size_t)f->section->n * sizeof *f->plastic);
        for (int k = 0; k < f->section->n && !f->yielded; k++) f->yielded = f->plastic[k] != 0.0;
        f->changed = 0;
    }
    if (!(f->strain > f->section->limit)) return 0;
    f->ruptured = 1;
    f->dissipated += energy;
    f->stored = 0.0;
    return 1;
}
