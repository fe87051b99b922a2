/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "members_import.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/stream.h"
#include "member/member_import.h"
#include "mesh/read_mesh.h"

/* Prints the entries that were not carried over, card by card. */
static void report_skipped(const char *path, const fl_frame_model *f)
{
    for (int32_t k = 0; k < f->skipped_name.n; k++)
        fprintf(stderr, "struct-import: %s: not carried over: %s (%d)\n", path, f->skipped_name.name[k],
                (int)f->skipped[k]);
}

static void report_model(const fl_member_model *m)
{
    int32_t bars = 0, held = 0;
    double mass = 0.0;
    for (int32_t k = 0; k < m->member_name.n; k++) {
        const fl_member *b = &m->member[k];
        bars += m->section[b->section].bar;
        mass += m->section[b->section].mass * v3_norm(v3_sub(m->node[b->end[1]].x, m->node[b->end[0]].x));
    }
    for (int32_t k = 0; k < m->node_name.n; k++) {
        held += m->node[k].fixed != 0;
        mass += m->node[k].mass;
    }
    fprintf(stderr, "%d nodes, %d held; %d beams, %d bars of %d sections; %.6g kg\n", (int)m->node_name.n,
            (int)held, (int)(m->member_name.n - bars), (int)bars, (int)m->section_name.n, mass);
}

/* Reads the text once more: what arc-path would refuse is refused here, with the line of the file written. */
static int check_model(const fl_member_model *m, const fl_history_line *by, const char *name, fl_err *err)
{
    char *text = NULL;
    size_t n = 0;
    fl_text in = {0};
    fl_member_model again = {0};
    FILE *f = open_memstream(&text, &n);
    if (!f) return fl_fail(err, FL_SYSTEM, "out of memory");
    fl_member_model_write(f, m, by);
    int rc = fclose(f) ? fl_fail(err, FL_SYSTEM, "out of memory") : 0;
    if (rc == 0 &&
        (fl_text_open_bytes(&in, name, text, (int64_t)n, err) || fl_member_model_read_text(&again, &in, err)))
        rc = -1;
    fl_text_close(&in);
    fl_member_model_free(&again);
    free(text);
    return rc;
}

int import_members(const struct options *o, fl_err *err)
{
    const char *path = o->item[0].path;
    char note[FL_MESH_NOTE];
    fl_surface none = {0};
    fl_frame_model frame = {0};
    fl_member_model m = {0};
    fl_import_options opt = {.frame = &frame, .has_unit = o->unit != NULL};
    fl_history_line by;
    fl_out out = {0};
    int rc = fl_mesh_read(&none, path, &opt, note, err);
    if (rc == 0) rc = fl_member_import(&m, &frame, o->pieces, o->map.s, o->map.t, path, err);
    for (char *p = note, *end; !o->quiet && (end = strchr(p, '\n')) != NULL; p = end + 1)
        fprintf(stderr, "struct-import: %s: %.*s\n", path, (int)(end - p), p);
    if (!o->quiet) report_skipped(path, &frame);
    options_by(o, &by);
    if (rc == 0) rc = check_model(&m, &by, o->out, err);
    if (rc == 0) rc = fl_out_open(&out, o->out, o->gzip, err);
    if (rc == 0) {
        fl_member_model_write(out.f, &m, &by);
        rc = fl_out_close(&out, err);
    }
    fl_out_abort(&out);
    if (rc == 0 && !o->quiet) report_model(&m);
    if (rc == 0 && o->strict && frame.skipped_name.n)
        rc = fl_fail(err, FL_NO, "%d kinds of entries were not carried over", (int)frame.skipped_name.n);
    fl_surface_free(&none);
    fl_frame_model_free(&frame);
    fl_member_model_free(&m);
    return rc;
}
