/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "out/tables.h"
#include <inttypes.h>
#include <string.h>
#include "base/number_text.h"
#include "base/pi.h"

enum {
    TRANSLATES = 1,
    ROTATES = 2,
    RATE = FL_LOADS_RATE,
    PLATFORM = FL_LOADS_PLATFORM
}; /* bits of enum fl_loads_motion_kind */

static const fl_column LOADS[] = {
    {"part", "", FL_COLUMN_TEXT, 0, offsetof(fl_loads_row, part)},
    {"f", "N", FL_COLUMN_VEC3, 0, offsetof(fl_loads_row, force)},
    {"m", "N.m", FL_COLUMN_VEC3, 0, offsetof(fl_loads_row, moment)},
    {"fpeak", "N", FL_COLUMN_REAL, 0, offsetof(fl_loads_row, peak)},
    {"contacts", "", FL_COLUMN_INT, 0, offsetof(fl_loads_row, contacts)},
    {"u", "m", FL_COLUMN_VEC3, TRANSLATES, offsetof(fl_loads_row, motion.u)},
    {"v", "m/s", FL_COLUMN_VEC3, TRANSLATES, offsetof(fl_loads_row, motion.v)},
    {"a", "m/s2", FL_COLUMN_VEC3, TRANSLATES, offsetof(fl_loads_row, motion.a)},
    {"r", "deg", FL_COLUMN_VEC3_DEGREES, ROTATES, offsetof(fl_loads_row, motion.r)},
    {"w", "rad/s", FL_COLUMN_VEC3, ROTATES, offsetof(fl_loads_row, motion.w)},
    {"e", "rad/s2", FL_COLUMN_VEC3, ROTATES, offsetof(fl_loads_row, motion.e)},
    {"closing", "m/s", FL_COLUMN_REAL, RATE, offsetof(fl_loads_row, closing)},
    {"breaks", "", FL_COLUMN_REAL, RATE, offsetof(fl_loads_row, breaks)},
    {"fx_platform", "N", FL_COLUMN_REAL, PLATFORM, offsetof(fl_loads_row, platform[0])},
    {"fy_platform", "N", FL_COLUMN_REAL, PLATFORM, offsetof(fl_loads_row, platform[1])},
    {"mx_platform", "N.m", FL_COLUMN_REAL, PLATFORM, offsetof(fl_loads_row, platform[2])},
    {"my_platform", "N.m", FL_COLUMN_REAL, PLATFORM, offsetof(fl_loads_row, platform[3])},
};
const fl_table_format fl_loads_table = {"loads", FL_TABLE_COLUMNS(LOADS)};

static const fl_column STATE[] = {
    {"body", "", FL_COLUMN_INT, 0, offsetof(fl_state_row, body)},
    {"", "m", FL_COLUMN_VEC3, 0, offsetof(fl_state_row, x)},
    {"q", "", FL_COLUMN_QUAT, 0, offsetof(fl_state_row, q)},
    {"v", "m/s", FL_COLUMN_VEC3, 0, offsetof(fl_state_row, v)},
    {"w", "rad/s", FL_COLUMN_VEC3, 0, offsetof(fl_state_row, w)},
};
const fl_table_format fl_state_table = {"state", FL_TABLE_COLUMNS(STATE)};

static const fl_column CONTACTS[] = {
    {"i", "", FL_COLUMN_INT, 0, offsetof(fl_contacts_row, i)},
    {"j", "", FL_COLUMN_INT, 0, offsetof(fl_contacts_row, j)},
    {"mode", "", FL_COLUMN_TEXT, 0, offsetof(fl_contacts_row, mode)},
    {"gap", "m", FL_COLUMN_REAL, 0, offsetof(fl_contacts_row, gap)},
    {"n", "", FL_COLUMN_VEC3, 0, offsetof(fl_contacts_row, n)},
    {"p", "m", FL_COLUMN_VEC3, 0, offsetof(fl_contacts_row, p)},
    {"length", "m", FL_COLUMN_REAL, 0, offsetof(fl_contacts_row, length)},
    {"area", "m2", FL_COLUMN_REAL, 0, offsetof(fl_contacts_row, area)},
    {"fn", "N", FL_COLUMN_REAL, 0, offsetof(fl_contacts_row, normal)},
    {"fs", "N", FL_COLUMN_VEC3, 0, offsetof(fl_contacts_row, tangential)},
};
const fl_table_format fl_contacts_table = {"contacts", FL_TABLE_COLUMNS(CONTACTS)};

static const fl_column BONDS[] = {
    {"i", "", FL_COLUMN_INT, 0, offsetof(fl_bonds_row, i)},
    {"j", "", FL_COLUMN_INT, 0, offsetof(fl_bonds_row, j)},
    {"state", "", FL_COLUMN_TEXT, 0, offsetof(fl_bonds_row, state)},
    {"damage", "", FL_COLUMN_REAL, 0, offsetof(fl_bonds_row, damage)},
    {"fn", "N", FL_COLUMN_REAL, 0, offsetof(fl_bonds_row, tension)},
    {"fs", "N", FL_COLUMN_REAL, 0, offsetof(fl_bonds_row, shear)},
    {"m", "N.m", FL_COLUMN_REAL, 0, offsetof(fl_bonds_row, moment)},
    {"area", "m2", FL_COLUMN_REAL, 0, offsetof(fl_bonds_row, area)},
    {"", "m", FL_COLUMN_VEC3, 0, offsetof(fl_bonds_row, x)},
    {"joint", "", FL_COLUMN_TEXT, FL_BONDS_JOINTS, offsetof(fl_bonds_row, joint)},
};
static const fl_column FAILURES[] = {
    {"mode", "", FL_COLUMN_TEXT, 0, offsetof(fl_failures_row, mode)},
    {"parent", "", FL_COLUMN_INT, 0, offsetof(fl_failures_row, parent)},
    {"child", "", FL_COLUMN_INT, 0, offsetof(fl_failures_row, child)},
    {"", "m", FL_COLUMN_VEC3, 0, offsetof(fl_failures_row, x)},
    {"n", "", FL_COLUMN_VEC3, 0, offsetof(fl_failures_row, n)},
    {"length", "m", FL_COLUMN_REAL, 0, offsetof(fl_failures_row, length)},
    {"load", "N", FL_COLUMN_REAL, 0, offsetof(fl_failures_row, load)},
    {"ratio", "", FL_COLUMN_REAL, 0, offsetof(fl_failures_row, ratio)},
    {"mass1", "kg", FL_COLUMN_REAL, 0, offsetof(fl_failures_row, mass)},
    {"mass2", "kg", FL_COLUMN_REAL, 0, offsetof(fl_failures_row, child_mass)},
    {"energy", "J", FL_COLUMN_REAL, 0, offsetof(fl_failures_row, energy)},
};
const fl_table_format fl_failures_table = {"failures", FL_TABLE_COLUMNS(FAILURES)};

const fl_table_format fl_bonds_table = {"bonds", FL_TABLE_COLUMNS(BONDS)};

static const fl_column PANELS[] = {
    {"panel", "", FL_COLUMN_NAME, 0, offsetof(fl_panels_row, panel)},
    {"", "m", FL_COLUMN_VEC3, 0, offsetof(fl_panels_row, centroid)},
    {"area", "m2", FL_COLUMN_REAL, 0, offsetof(fl_panels_row, area)},
    {"f", "N", FL_COLUMN_VEC3, 0, offsetof(fl_panels_row, force)},
};
const fl_table_format fl_panels_table = {"panels", FL_TABLE_COLUMNS(PANELS)};

static const fl_column MEMBER_FORCES[] = {
    {"member", "", FL_COLUMN_TEXT, 0, offsetof(fl_member_forces_row, member)},
    {"piece", "", FL_COLUMN_INT, 0, offsetof(fl_member_forces_row, piece)},
    {"s", "m", FL_COLUMN_REAL, 0, offsetof(fl_member_forces_row, at)},
    {"f", "N", FL_COLUMN_VEC3, 0, offsetof(fl_member_forces_row, force)},
    {"m", "N.m", FL_COLUMN_VEC3, 0, offsetof(fl_member_forces_row, moment)},
    {"u", "m", FL_COLUMN_VEC3, 0, offsetof(fl_member_forces_row, u)},
};
const fl_table_format fl_member_forces_table = {"member_forces", FL_TABLE_COLUMNS(MEMBER_FORCES)};

static const fl_column ZONES[] = {
    {"body", "", FL_COLUMN_INT, 0, offsetof(fl_zones_row, body)},
    {"zone", "", FL_COLUMN_INT, 0, offsetof(fl_zones_row, zone)},
    {"", "m", FL_COLUMN_VEC3, 0, offsetof(fl_zones_row, x)},
    {"volume", "m3", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, volume)},
    {"sxx", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, s[0])},
    {"syy", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, s[1])},
    {"szz", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, s[2])},
    {"sxy", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, s[3])},
    {"syz", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, s[4])},
    {"szx", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, s[5])},
    {"s1", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, principal.x)},
    {"s3", "Pa", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, principal.z)},
    {"plastic", "J/m3", FL_COLUMN_REAL, 0, offsetof(fl_zones_row, yielded)},
};
const fl_table_format fl_zones_table = {"zones", FL_TABLE_COLUMNS(ZONES)};

static const fl_column HASH[] = {{"hash", "", FL_COLUMN_HASH, 0, offsetof(fl_hash_row, hash)}};
const fl_table_format fl_hash_table = {"hash", FL_TABLE_COLUMNS(HASH)};

static int is_present(const fl_column *c, unsigned options) { return c->when == 0 || c->when & options; }

/* The suffixes of the columns of a type. */
static const char *suffixes_of(enum fl_column_type type)
{
    if (type == FL_COLUMN_VEC3 || type == FL_COLUMN_VEC3_DEGREES) return "xyz";
    return type == FL_COLUMN_QUAT ? "wxyz" : "";
}

static void write_name(FILE *f, const fl_column *c)
{
    const char *suffix = suffixes_of(c->type);
    do {
        fprintf(f, "\t%s", c->name);
        if (*suffix) putc(*suffix++, f);
        if (c->unit[0]) fprintf(f, "[%s]", c->unit);
    } while (*suffix);
}

void fl_table_write_header(FILE *f, const fl_table_format *table, unsigned options, const char *history,
                           const fl_history_line *by, const char *sets, double start)
{
    fl_table_write_header_more(f, table, options, history, by, sets, start, NULL);
}

void fl_table_write_header_more(FILE *f, const fl_table_format *table, unsigned options, const char *history,
                                const fl_history_line *by, const char *sets, double start,
                                const fl_more_columns *more)
{
    char text[FL_NUMBER_LEN];
    fl_write_file_header(f, table->kind, 1, history, by);
    if (sets) fputs(sets, f);
    if (start > 0.0) fprintf(f, "#start %s\n", fl_number_text(start, text));
    fputs("t[s]", f);
    for (int k = 0; k < table->columns; k++)
        if (is_present(&table->column[k], options)) write_name(f, &table->column[k]);
    for (int32_t k = 0; more && k < more->n; k++)
        fprintf(f, "\t%s%s[%s]", more->prefix, more->name[k], more->unit);
    putc('\n', f);
}

void fl_table_write_report(FILE *f, const char *text, const char *program)
{
    const size_t skip = strlen(program);
    while (*text) {
        const size_t len = strcspn(text, "\n");
        const char *from = strncmp(text, program, skip) == 0 ? text + skip : text;
        fprintf(f, "#report %.*s\n", (int)(text + len - from), from);
        text += len + (text[len] == '\n');
    }
}

void fl_table_write_stopped(FILE *f, int status, double t, const char *why)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "#stopped %d at t = %s s: %s\n", status, fl_number_text(t, text), why);
}

static void put_real(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    putc('\t', f);
    fputs(fl_number_text(x, text), f);
}

static void put_vec3(FILE *f, fl_vec3 a)
{
    put_real(f, a.x);
    put_real(f, a.y);
    put_real(f, a.z);
}

static void write_value(FILE *f, enum fl_column_type type, const void *value)
{
    const fl_numbered_name *name = value;
    const fl_quat *q = value;
    switch (type) {
    case FL_COLUMN_REAL: put_real(f, *(const double *)value); break;
    case FL_COLUMN_VEC3: put_vec3(f, *(const fl_vec3 *)value); break;
    case FL_COLUMN_VEC3_DEGREES: put_vec3(f, v3_scale(180.0 / PI, *(const fl_vec3 *)value)); break;
    case FL_COLUMN_QUAT:
        put_real(f, q->w);
        put_vec3(f, v3(q->x, q->y, q->z));
        break;
    case FL_COLUMN_INT: fprintf(f, "\t%" PRId32, *(const int32_t *)value); break;
    case FL_COLUMN_TEXT: fprintf(f, "\t%s", *(const char *const *)value); break;
    case FL_COLUMN_NAME: fprintf(f, "\t%s.%" PRId32, name->name, name->number); break;
    case FL_COLUMN_HASH: fprintf(f, "\t%016" PRIx64, *(const uint64_t *)value); break;
    }
}

void fl_table_write_row(FILE *f, const fl_table_format *table, unsigned options, double t, const void *row)
{
    fl_table_write_row_more(f, table, options, t, row, NULL);
}

void fl_table_write_row_more(FILE *f, const fl_table_format *table, unsigned options, double t,
                             const void *row, const fl_more_columns *more)
{
    char text[FL_NUMBER_LEN];
    fputs(fl_number_text(t, text), f);
    for (int k = 0; k < table->columns; k++) {
        const fl_column *c = &table->column[k];
        if (is_present(c, options)) write_value(f, c->type, (const char *)row + c->offset);
    }
    for (int32_t k = 0; more && k < more->n; k++) put_real(f, more->value[k]);
    putc('\n', f);
}

void fl_state_write_rows(FILE *f, double t, const fl_poses *p)
{
    for (int32_t k = 0; k < p->b->n; k++) {
        const int32_t i = fl_poses_body(p, k);
        if (i < 0) continue;
        const fl_state_row row = {.body = p->id[i],
                                  .x = fl_poses_position(p, i),
                                  .q = q_mul(p->b->q[i], q_conj(p->q0[i])),
                                  .v = p->b->v[i],
                                  .w = p->b->w[i]};
        fl_table_write_row(f, &fl_state_table, 0, t, &row);
    }
}
