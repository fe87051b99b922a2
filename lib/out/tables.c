/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include "base/number_text.h"
#include "base/pi.h"
#include "out/tables.h"

static void put(FILE *f, double x)
{
    char text[FL_NUMBER_LEN];
    putc('\t', f);
    fputs(fl_number_text(x, text), f);
}

static void put3(FILE *f, fl_vec3 a)
{
    put(f, a.x);
    put(f, a.y);
    put(f, a.z);
}

void fl_values_header(FILE *f, const char *kind, const char *history, const fl_history_line *by,
                      const char *columns)
{
    fl_write_file_header(f, kind, 1, history, by);
    fprintf(f, "%s\n", columns);
}

void fl_values_row(FILE *f, int n, const double *x)
{
    char text[FL_NUMBER_LEN];
    fputs(fl_number_text(x[0], text), f);
    for (int k = 1; k < n; k++) put(f, x[k]);
    putc('\n', f);
}

void fl_loads_header(FILE *f, const char *history, const fl_history_line *by, double start,
                     enum fl_loads_motion_kind moving)
{
    char text[FL_NUMBER_LEN];
    fl_write_file_header(f, "loads", 1, history, by);
    if (start > 0.0) fprintf(f, "#start %s\n", fl_number_text(start, text));
    fputs("t[s]\tpart\tfx[N]\tfy[N]\tfz[N]\tmx[N.m]\tmy[N.m]\tmz[N.m]\tfpeak[N]\tcontacts", f);
    if (moving) fputs("\tux[m]\tuy[m]\tuz[m]\tvx[m/s]\tvy[m/s]\tvz[m/s]\tax[m/s2]\tay[m/s2]\taz[m/s2]", f);
    if (moving == FL_LOADS_ROTATION)
        fputs("\trx[deg]\try[deg]\trz[deg]\twx[rad/s]\twy[rad/s]\twz[rad/s]\tex[rad/s2]\tey[rad/s2]\tez[rad/"
              "s2]",
              f);
    putc('\n', f);
}

void fl_hash_header(FILE *f, const char *history, const fl_history_line *by)
{
    fl_values_header(f, "hash", history, by, "t[s]\thash");
}

void fl_hash_row(FILE *f, double t, uint64_t hash)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s\t%016" PRIx64 "\n", fl_number_text(t, text), hash);
}

void fl_loads_row(FILE *f, double t, const char *part, fl_vec3 force, fl_vec3 moment, double peak,
                  int32_t contacts, enum fl_loads_motion_kind moving, const fl_loads_motion *motion)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s\t%s", fl_number_text(t, text), part);
    put3(f, force);
    put3(f, moment);
    put(f, peak);
    fprintf(f, "\t%d", contacts);
    if (moving) put3(f, motion->u), put3(f, motion->v), put3(f, motion->a);
    if (moving == FL_LOADS_ROTATION)
        put3(f, v3_scale(180.0 / PI, motion->r)), put3(f, motion->w), put3(f, motion->e);
    putc('\n', f);
}

void fl_state_header(FILE *f, const char *history, const fl_history_line *by)
{
    fl_values_header(
        f, "state", history, by,
        "t[s]\tbody\tx[m]\ty[m]\tz[m]\tqw\tqx\tqy\tqz\tvx[m/s]\tvy[m/s]\tvz[m/s]\twx[rad/s]\twy[rad/s]\t"
        "wz[rad/s]");
}

void fl_state_rows(FILE *f, double t, const fl_poses *p)
{
    char text[FL_NUMBER_LEN];
    fl_number_text(t, text);
    for (int32_t k = 0; k < p->b->n; k++) {
        const int32_t i = fl_poses_body(p, k);
        if (i < 0) continue;
        const fl_quat q = q_mul(p->b->q[i], q_conj(p->q0[i]));
        fprintf(f, "%s\t%d", text, p->id[i]);
        put3(f, fl_poses_position(p, i));
        put(f, q.w);
        put3(f, v3(q.x, q.y, q.z));
        put3(f, p->b->v[i]);
        put3(f, p->b->w[i]);
        putc('\n', f);
    }
}

void fl_contacts_header(FILE *f, const char *history, const fl_history_line *by)
{
    fl_values_header(
        f, "contacts", history, by,
        "t[s]\ti\tj\tmode\tgap[m]\tnx\tny\tnz\tpx[m]\tpy[m]\tpz[m]\tlength[m]\tarea[m2]\tfn[N]\tfsx[N]\t"
        "fsy[N]\tfsz[N]");
}

void fl_contacts_row(FILE *f, double t, int32_t i, int32_t j, const fl_contact *c, double normal,
                     fl_vec3 slide)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s\t%d\t%d\t%s", fl_number_text(t, text), i, j, fl_mode_name(c->mode));
    put(f, c->gap);
    put3(f, c->n);
    put3(f, c->p);
    put(f, c->length);
    put(f, c->area);
    put(f, normal);
    put3(f, slide);
    putc('\n', f);
}

void fl_bonds_header(FILE *f, const char *history, const fl_history_line *by)
{
    fl_values_header(f, "bonds", history, by,
                     "t[s]\ti\tj\tstate\tdamage\tfn[N]\tfs[N]\tm[N.m]\tarea[m2]\tx[m]\ty[m]\tz[m]");
}

void fl_bonds_row(FILE *f, double t, const fl_bonds_record *b)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s\t%d\t%d\t%s", fl_number_text(t, text), b->i, b->j, b->state);
    put(f, b->damage);
    put(f, b->tension);
    put(f, b->shear);
    put(f, b->moment);
    put(f, b->area);
    put3(f, b->x);
    putc('\n', f);
}

void fl_panels_header(FILE *f, const char *history, const fl_history_line *by, double start)
{
    char text[FL_NUMBER_LEN];
    fl_write_file_header(f, "panels", 1, history, by);
    if (start > 0.0) fprintf(f, "#start %s\n", fl_number_text(start, text));
    fputs("t[s]\tpanel\tx[m]\ty[m]\tz[m]\tarea[m2]\tfx[N]\tfy[N]\tfz[N]\n", f);
}

void fl_panels_row(FILE *f, double t, const char *part, const char *name, fl_vec3 middle, double area,
                   fl_vec3 force)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s\t%s%s", fl_number_text(t, text), part, name);
    put3(f, middle);
    put(f, area);
    put3(f, force);
    putc('\n', f);
}
