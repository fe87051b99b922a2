/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/cdb_section.h"

void fl_cdb_section_free(fl_cdb_sections *s)
{
    fl_id_map_free(&s->id);
    free(s->radius);
    free(s->line);
    *s = (fl_cdb_sections){0};
}

static int set_radius(fl_cdb_sections *s, int32_t scope, int64_t id, double r, fl_err *err)
{
    const int32_t k = fl_id_map_add(&s->id, scope, id, err);
    if (k < 0 || fl_grow(&s->radius, &s->radius_cap, s->id.n, sizeof *s->radius, err)) return -1;
    s->radius[k] = r > 0.0 ? r : 0.0;
    return 0;
}

void fl_cdb_section_open(fl_cdb_sections *s, int64_t id, const char *type, const char *subtype)
{
    s->current = id;
    snprintf(s->type, sizeof s->type, "%.*s", FL_CDB_SECTION_WORD - 1, type);
    snprintf(s->subtype, sizeof s->subtype, "%.*s", FL_CDB_SECTION_WORD - 1, subtype);
}

int fl_cdb_section_data(fl_cdb_sections *s, const double x[2], fl_err *err)
{
    if (s->current < 1) return 0;
    if (strncasecmp(s->type, "PIPE", 4) == 0) return set_radius(s, 0, s->current, 0.5 * x[0], err);
    if (strncasecmp(s->type, "BEAM", 4) != 0) return 0;
    if (strncasecmp(s->subtype, "CTUB", 4) == 0) return set_radius(s, 0, s->current, x[1], err);
    if (strncasecmp(s->subtype, "CSOL", 4) == 0) return set_radius(s, 0, s->current, x[0], err);
    return 0;
}

int fl_cdb_section_real(fl_cdb_sections *s, int64_t id, double diameter, fl_err *err)
{
    return set_radius(s, 1, id, 0.5 * diameter, err);
}

int fl_cdb_section_line(fl_cdb_sections *s, fl_cdb_line line, fl_err *err)
{
    if (fl_grow(&s->line, &s->line_cap, (int64_t)s->lines + 1, sizeof *s->line, err)) return -1;
    s->line[s->lines++] = line;
    return 0;
}

int fl_cdb_section_apply(const fl_cdb_sections *s, fl_elements *e, fl_err *err)
{
    for (int32_t i = 0; i < s->lines; i++) {
        const fl_cdb_line *l = &s->line[i];
        const int by_real = l->routine == 16 || l->routine == 20 || l->routine == 59;
        const int32_t k = fl_id_map_find(&s->id, by_real, by_real ? l->real : l->section);
        const int sectioned =
            l->routine == 188 || l->routine == 189 || (l->routine >= 288 && l->routine <= 290);
        if (k < 0 || !(by_real || sectioned) || !(s->radius[k] > 0.0)) continue;
        if (fl_elements_set_radius(e, l->element, s->radius[k], s->radius[k], err)) return -1;
    }
    return 0;
}
