/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/frame_model.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"

int32_t fl_frame_node_of(fl_frame_model *f, int32_t scope, int64_t id, fl_err *err)
{
    const int32_t had = f->node_id.n, k = fl_id_map_add(&f->node_id, scope, id, err);
    if (k < 0 || fl_grow(&f->node, &f->node_cap, (int64_t)f->node_id.n, sizeof *f->node, err)) return -1;
    if (f->node_id.n > had) f->node[k] = (fl_frame_node){0};
    return k;
}

int32_t fl_frame_element_of(fl_frame_model *f, int32_t scope, int64_t id, fl_err *err)
{
    const int32_t had = f->element_id.n, k = fl_id_map_add(&f->element_id, scope, id, err);
    if (k < 0 || fl_grow(&f->element, &f->element_cap, (int64_t)f->element_id.n, sizeof *f->element, err))
        return -1;
    if (f->element_id.n > had) f->element[k] = (fl_frame_element){.node = {-1, -1}, .section = -1, .id = id};
    return k;
}

int32_t fl_frame_material_of(fl_frame_model *f, const char *name, fl_err *err)
{
    const int32_t had = f->material_name.n, k = fl_string_table_add(&f->material_name, name, err);
    if (k < 0 || fl_grow(&f->material, &f->material_cap, (int64_t)k + 1, sizeof *f->material, err)) return -1;
    if (f->material_name.n > had) f->material[k] = (fl_frame_material){0};
    return k;
}

int32_t fl_frame_section_of(fl_frame_model *f, const char *name, fl_err *err)
{
    const int32_t had = f->section_name.n, k = fl_string_table_add(&f->section_name, name, err);
    if (k < 0 || fl_grow(&f->section, &f->section_cap, (int64_t)k + 1, sizeof *f->section, err)) return -1;
    if (f->section_name.n > had) f->section[k] = (fl_frame_section){.material = -1};
    return k;
}

int32_t fl_frame_part_of(fl_frame_model *f, const char *name, fl_err *err)
{
    return fl_string_table_add(&f->part_name, name, err);
}

int fl_frame_count_skipped(fl_frame_model *f, const char *fmt, ...)
{
    char text[160];
    fl_err err = {0};
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    const int32_t had = f->skipped_name.n, k = fl_string_table_add(&f->skipped_name, text, &err);
    if (k < 0 || fl_grow(&f->skipped, &f->skipped_cap, (int64_t)k + 1, sizeof *f->skipped, &err)) {
        f->failed = 1;
        return 0;
    }
    if (f->skipped_name.n > had) f->skipped[k] = 0;
    f->skipped[k]++;
    return 0;
}

fl_frame_section fl_frame_section_box(double b, double h, double tf, double tw)
{
    const double bi = b - 2.0 * tw, hi = h - 2.0 * tf;
    return (fl_frame_section){.form = FL_FRAME_GENERAL,
                              .material = -1,
                              .a = b * h - bi * hi,
                              .iz = (b * h * h * h - bi * hi * hi * hi) / 12.0,
                              .iy = (h * b * b * b - hi * bi * bi * bi) / 12.0,
                              .j = 2.0 * tf * tw * (b - tw) * (b - tw) * (h - tf) * (h - tf) /
                                   (b * tw + h * tf - tw * tw - tf * tf)};
}

fl_frame_section fl_frame_section_i(double h, double b1, double b2, double tw, double t1, double t2)
{
    const double web = h - t1 - t2, a1 = b1 * t1, a2 = b2 * t2, aw = web * tw, a = a1 + a2 + aw;
    const double y1 = 0.5 * t1, y2 = h - 0.5 * t2, yw = t1 + 0.5 * web, y = (a1 * y1 + a2 * y2 + aw * yw) / a;
    return (fl_frame_section){.form = FL_FRAME_GENERAL,
                              .material = -1,
                              .a = a,
                              .iz = (b1 * t1 * t1 * t1 + b2 * t2 * t2 * t2 + tw * web * web * web) / 12.0 +
                                    a1 * (y1 - y) * (y1 - y) + a2 * (y2 - y) * (y2 - y) +
                                    aw * (yw - y) * (yw - y),
                              .iy = (t1 * b1 * b1 * b1 + t2 * b2 * b2 * b2 + web * tw * tw * tw) / 12.0,
                              .j = (b1 * t1 * t1 * t1 + b2 * t2 * t2 * t2 + web * tw * tw * tw) / 3.0};
}

fl_frame_section fl_frame_section_rod(double radius)
{
    return (fl_frame_section){.form = FL_FRAME_PIPE, .material = -1, .size = {2.0 * radius, radius}};
}

void fl_frame_model_free(fl_frame_model *f)
{
    fl_id_map_free(&f->node_id);
    fl_id_map_free(&f->element_id);
    fl_string_table_free(&f->material_name);
    fl_string_table_free(&f->section_name);
    fl_string_table_free(&f->part_name);
    fl_string_table_free(&f->skipped_name);
    free(f->node), free(f->element), free(f->material), free(f->section), free(f->skipped);
    *f = (fl_frame_model){0};
}
