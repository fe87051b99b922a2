/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "structure/modal_motion.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/pi.h"
#include "base/table.h"

/* Displacement of the node, over the largest of the mode, below which the mode does not move it. */
#define AT_REST 1e-6

void fl_modes_set_step(fl_modal_dof *m, int32_t n, double dt)
{
    for (int32_t k = 0; k < n; k++) {
        const double c = 2.0 * m[k].ratio * sqrt(m[k].mass * m[k].omega * m[k].omega * m[k].mass);
        m[k].decay = exp(-c * (0.5 * dt) / m[k].mass);
    }
}

void fl_modes_damp(fl_modal_dof *m, int32_t n)
{
    for (int32_t k = 0; k < n; k++) {
        const double old = m[k].v, now = m[k].decay * old;
        m[k].damped += 0.5 * m[k].mass * (old * old - now * now);
        m[k].v = now;
    }
}

void fl_modes_kick(fl_modal_dof *m, int32_t n, double h)
{
    for (int32_t k = 0; k < n; k++) m[k].v += h / m[k].mass * m[k].force;
}

void fl_modes_drift(fl_modal_dof *m, int32_t n, double dt)
{
    for (int32_t k = 0; k < n; k++) m[k].q += dt * m[k].v;
}

void fl_modes_load(fl_modal_dof *m, int32_t n, fl_vec3 F)
{
    for (int32_t k = 0; k < n; k++) {
        const double pull = m[k].mass * m[k].omega * m[k].omega * m[k].q;
        m[k].load = v3_dot(m[k].e, F);
        m[k].force = m[k].load - pull;
        m[k].spring_energy = 0.5 * pull * m[k].q;
    }
}

fl_vec3 fl_modes_displacement(const fl_modal_dof *m, int32_t n)
{
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = 0; k < n; k++) sum = v3_madd(sum, m[k].q, m[k].e);
    return sum;
}

fl_vec3 fl_modes_velocity(const fl_modal_dof *m, int32_t n)
{
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = 0; k < n; k++) sum = v3_madd(sum, m[k].v, m[k].e);
    return sum;
}

fl_vec3 fl_modes_acceleration(const fl_modal_dof *m, int32_t n, int damped)
{
    fl_vec3 sum = v3(0, 0, 0);
    for (int32_t k = 0; k < n; k++) {
        const double drag = damped ? 2.0 * m[k].ratio * m[k].omega * m[k].mass * m[k].v : 0.0;
        sum = v3_madd(sum, (m[k].force - drag) / m[k].mass, m[k].e);
    }
    return sum;
}

double fl_mode_kinetic_energy(const fl_modal_dof *m) { return 0.5 * m->mass * m->v * m->v; }

double fl_mode_energy(const fl_modal_dof *m) { return fl_mode_kinetic_energy(m) + m->spring_energy; }

double fl_modes_compliance(const fl_modal_dof *m, int32_t n)
{
    double by_axis[3] = {0, 0, 0}, most = 0.0, sum = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double e[3] = {fabs(m[k].e.x), fabs(m[k].e.y), fabs(m[k].e.z)};
        sum += 1.0 / m[k].mass;
        for (int c = 0; c < 3; c++) /* Gershgorin: a row of sum e e^T/m */
            by_axis[c] += e[c] * (e[0] + e[1] + e[2]) / m[k].mass;
    }
    for (int c = 0; c < 3; c++) most = fmax(most, by_axis[c]);
    return fmin(most, sum);
}

double fl_modes_max_omega2(const fl_modal_dof *m, int32_t n)
{
    double most = 0.0;
    for (int32_t k = 0; k < n; k++) most = fmax(most, m[k].omega * m[k].omega);
    return most;
}

/* --- the table --------------------------------------------------------------------------------- */

/* Columns of a table of modes; -1: absent. */
typedef struct {
    int32_t name, f, mass, ratio, direction, shape, node[3];
} mode_columns;

static int find_mode_columns(fl_table *t, const char *node, mode_columns *c, fl_err *err)
{
    char column[3][256];
    c->name = fl_table_column(t, "mode");
    c->direction = fl_table_column(t, "direction");
    c->shape = fl_table_column(t, "shape");
    if (fl_table_require(t, "f", &c->f, err) || fl_table_require(t, "mass", &c->mass, err) ||
        fl_table_require(t, "ratio", &c->ratio, err))
        return -1;
    for (int k = 0; k < 3; k++) {
        snprintf(column[k], sizeof column[k], "%.200s.%c", node, 'x' + k);
        c->node[k] = node[0] ? fl_table_column(t, column[k]) : -1;
    }
    if (node[0]) return fl_table_require(t, column[0], &c->node[0], err);
    if (c->direction >= 0) return 0;
    return fl_text_fail(
        &t->text, err,
        "the modes have no column direction: structure.modes_node, the node at the waterline, "
        "is expected");
}

/* The displacement of the reference where the mode is 1; in out of three numbers. */
static int read_shape(const fl_table *t, const mode_columns *c, double phi[3], fl_err *err)
{
    double shape = 1.0;
    if (c->node[0] >= 0) {
        for (int k = 0; k < 3; k++)
            if (c->node[k] >= 0 && fl_table_f64(t, c->node[k], &phi[k], err)) return -1;
        return 0;
    }
    const char *word = fl_table_word(t, c->direction);
    if (c->shape >= 0 && fl_table_f64(t, c->shape, &shape, err)) return -1;
    if ((word[0] != 'x' && word[0] != 'y') || word[1])
        return fl_text_fail(&t->text, err, "direction \"%.20s\", x or y is expected", word);
    phi[word[0] - 'x'] = shape;
    return 0;
}

/* 1, 0 where the reference does not move in that mode, or -1. */
static int read_mode(const fl_table *t, const mode_columns *c, int32_t row, fl_modal_dof *out, fl_err *err)
{
    double f, phi[3] = {0, 0, 0};
    const fl_text *text = &t->text;
    *out = (fl_modal_dof){0};
    if (fl_table_f64(t, c->f, &f, err) || fl_table_f64(t, c->mass, &out->mass, err) ||
        fl_table_f64(t, c->ratio, &out->ratio, err) || read_shape(t, c, phi, err))
        return -1;
    if (!(f > 0.0)) return fl_text_fail(text, err, "f is %g Hz, above 0 is expected", f);
    if (!(out->mass > 0.0)) return fl_text_fail(text, err, "mass is %g kg, above 0 is expected", out->mass);
    if (!(out->ratio >= 0.0 && out->ratio < 1.0))
        return fl_text_fail(text, err, "ratio is %g, from 0 to below 1 is expected", out->ratio);
    const fl_vec3 u = v3(phi[0], phi[1], phi[2]);
    const double size = v3_norm(u);
    if (c->name >= 0) snprintf(out->name, sizeof out->name, "%.60s", fl_table_word(t, c->name));
    else snprintf(out->name, sizeof out->name, "%d", (int)row);
    if (!(size > AT_REST)) return 0;
    out->omega = 2.0 * PI * f;
    out->mass /= size * size;
    out->e = v3_scale(1.0 / size, u);
    return 1;
}

int32_t fl_modes_read(fl_modal_dof *m, const char *path, const char *node, fl_err *err)
{
    fl_table t = {0};
    mode_columns c;
    int32_t n = 0, row = 0;
    int rc = fl_table_open(&t, path, "modes", 1, err);
    if (rc == 0) rc = find_mode_columns(&t, node, &c, err);
    while (rc == 0 && (rc = fl_table_row(&t, err)) > 0) {
        fl_modal_dof one;
        const int moves = read_mode(&t, &c, ++row, &one, err);
        rc = moves < 0 ? -1 : 0;
        for (int32_t k = 0; k < n && moves > 0; k++)
            if (strcmp(m[k].name, one.name) == 0)
                rc = fl_text_fail(&t.text, err, "mode %.60s is there twice", one.name);
        if (rc || moves == 0) continue;
        if (n == FL_MODES_MOST)
            rc = fl_text_fail(&t.text, err, "more than %d modes that move the waterline", FL_MODES_MOST);
        else m[n++] = one;
    }
    if (rc == 0 && n == 0) rc = fl_fail(err, FL_INPUT, "%s: no mode moves the waterline", path);
    fl_table_close(&t);
    return rc ? -1 : n;
}
