/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/frame_bdf.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { X = 8 }; /* field behind the first row */

static int is_blank(const fl_bdf_entry *a, int k) { return fl_bdf_field(a, k)[0] == '\0'; }

static int name_of(char name[40], const char *kind, int64_t id)
{
    return snprintf(name, 40, "%s%lld", kind, (long long)id);
}

static int32_t property_of(fl_frame_model *f, int64_t pid, fl_err *err)
{
    char name[40];
    name_of(name, "p", pid);
    return fl_frame_section_of(f, name, err);
}

static int32_t material_of(fl_frame_model *f, const fl_bdf_entry *a, int k, fl_err *err)
{
    char name[40];
    int64_t mid;
    if (fl_bdf_id(a, k, &mid, err)) return -1;
    name_of(name, "m", mid);
    return fl_frame_material_of(f, name, err);
}

static int read_material(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    const int32_t k = material_of(f, a, 0, err);
    fl_frame_material m = {0};
    if (k < 0 || fl_bdf_real(a, 1, &m.e, err) || fl_bdf_real(a, 2, &m.g, err) ||
        fl_bdf_real(a, 3, &m.nu, err) || fl_bdf_real(a, 4, &m.rho, err))
        return -1;
    if (m.e == 0.0) m.e = 2.0 * m.g * (1.0 + m.nu);
    f->material[k] = m;
    return 0;
}

/* PBAR, PBEAM, PROD, PTUBE, and their lists of dimensions. */
static int read_property(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    const int listed = strcmp(a->name, "PBARL") == 0 || strcmp(a->name, "PBEAML") == 0;
    const char *kind = fl_bdf_field(a, 3);
    fl_frame_section s = {.form = FL_FRAME_GENERAL};
    double x[6] = {0};
    int64_t pid;
    int used = 0;
    if (fl_bdf_id(a, 0, &pid, err)) return -1;
    const int32_t k = property_of(f, pid, err), material = material_of(f, a, 1, err);
    if (k < 0 || material < 0) return -1;
    for (int d = 0; d < 6; d++)
        if (fl_bdf_real(a, listed ? X + d : 2 + d, &x[d], err)) {
            if (!listed || d == 0) return -1;
            *err = (fl_err){0}; /* SO of a further station */
            break;
        }
    if (listed) {
        if (strcasecmp(kind, "ROD") == 0) s = fl_frame_section_rod(x[0]), used = 1;
        else if (strcasecmp(kind, "TUBE") == 0)
            s.form = FL_FRAME_PIPE, s.size[0] = 2.0 * x[0], s.size[1] = x[0] - x[1], used = 2;
        else if (strcasecmp(kind, "TUBE2") == 0)
            s.form = FL_FRAME_PIPE, s.size[0] = 2.0 * x[0], s.size[1] = x[1], used = 2;
        else if (strcasecmp(kind, "BAR") == 0)
            s.form = FL_FRAME_RECTANGLE, s.size[0] = x[1], s.size[1] = x[0], used = 2;
        else if (strcasecmp(kind, "BOX") == 0) s = fl_frame_section_box(x[0], x[1], x[2], x[3]), used = 4;
        else if (strcasecmp(kind, "I") == 0)
            s = fl_frame_section_i(x[0], x[1], x[2], x[3], x[4], x[5]), used = 6;
        else {
            s.form = FL_FRAME_NONE;
            if (fl_frame_count_skipped(f, "%s of the type %s: its elements have no section", a->name, kind))
                return -1;
        }
        if (used && fl_bdf_real(a, X + used, &s.other_mass, err)) return -1;
    } else if (strcmp(a->name, "PTUBE") == 0) {
        s.form = FL_FRAME_PIPE;
        s.size[0] = x[0];
        s.size[1] = x[1] > 0.0 ? x[1] : 0.5 * x[0];
        s.other_mass = x[2];
    } else if (strcmp(a->name, "PROD") == 0) {
        s.a = x[0], s.j = x[1];
    } else if (strcmp(a->name, "PBAR") == 0) {
        s.a = x[0], s.iz = x[1], s.iy = x[2], s.j = x[3], s.other_mass = x[4];
    } else { /* PBEAM has I12 before J */
        s.a = x[0], s.iz = x[1], s.iy = x[2], s.j = x[4], s.other_mass = x[5];
        if (x[3] != 0.0 && fl_frame_count_skipped(f, "PBEAM: I12")) return -1;
        if (a->fields > 2 * X &&
            fl_frame_count_skipped(f, "PBEAM: stations, shear and warping; its end A is taken"))
            return -1;
    }
    s.material = material;
    f->section[k] = s;
    return 0;
}

/* Fields of pins: digits 4 5 6, about x y z. */
static int read_pins(fl_frame_model *f, const fl_bdf_entry *a, int k, unsigned *pins)
{
    *pins = 0;
    for (const char *p = fl_bdf_field(a, k); *p; p++) {
        if (*p >= '4' && *p <= '6') *pins |= 1u << (*p - '4');
        else if (*p >= '1' && *p <= '3' && fl_frame_count_skipped(f, "%s: pins of forces", a->name))
            return -1;
    }
    return 0;
}

static int read_orientation(fl_frame_model *f, const fl_bdf_entry *a, fl_frame_element *e, fl_err *err)
{
    const char *first = fl_bdf_field(a, 4);
    int64_t grid;
    if (*first && is_blank(a, 5) && is_blank(a, 6) && fl_deck_integer(first, &grid) == 0 && grid > 0) {
        const int32_t k = fl_frame_node_of(f, 0, grid, err);
        if (k < 0) return -1;
        e->has_y = 2; /* the vector to a grid, made when grids are placed */
        e->across = v3(k, 0, 0);
        return 0;
    }
    if (fl_bdf_point(a, 4, &e->across, err)) return -1;
    e->has_y = v3_nonzero(e->across);
    return 0;
}

/* Offsets from grids to ends, three fields each; OFFT (field 8), GGG unless given, says in which axes. */
static int read_ends_off(fl_frame_model *f, const fl_bdf_entry *a, int first, fl_frame_element *e,
                         fl_err *err)
{
    const char *offt = fl_bdf_field(a, 7);
    for (int s = 0; s < 2; s++) {
        fl_vec3 w;
        if (fl_bdf_point(a, first + 3 * s, &w, err)) return -1;
        if (!v3_nonzero(w)) continue;
        if (strlen(offt) == 3 && offt[1 + s] != 'G' && offt[1 + s] != 'g') {
            if (fl_frame_count_skipped(f, "%s: offsets in axes of the element (OFFT)", a->name)) return -1;
            continue;
        }
        e->offset[s] = w;
    }
    return 0;
}

static int read_element(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    const int rod = strcmp(a->name, "CONROD") == 0, beam = a->name[1] == 'B', first = rod ? 1 : 2;
    int64_t id, pid, node[2];
    char part[40];
    if (fl_bdf_id(a, 0, &id, err) || fl_bdf_id(a, first, &node[0], err) ||
        fl_bdf_id(a, first + 1, &node[1], err) || fl_bdf_integer(a, 1, id, &pid, err))
        return -1;
    const int32_t k = fl_frame_element_of(f, 0, id, err);
    if (k < 0) return -1;
    fl_frame_element e = {.id = id, .truss = !beam};
    for (int s = 0; s < 2; s++)
        if ((e.node[s] = fl_frame_node_of(f, 0, node[s], err)) < 0) return -1;
    if (rod) {
        char name[40];
        fl_frame_section s = {.form = FL_FRAME_GENERAL};
        name_of(name, "conrod", id);
        if ((s.material = material_of(f, a, 3, err)) < 0 || fl_bdf_real(a, 4, &s.a, err) ||
            fl_bdf_real(a, 7, &s.other_mass, err) || (e.section = fl_frame_section_of(f, name, err)) < 0)
            return -1;
        f->section[e.section] = s;
        snprintf(part, sizeof part, "conrod");
    } else {
        if ((e.section = property_of(f, pid, err)) < 0) return -1;
        name_of(part, "property_", pid);
    }
    if (beam) {
        if (read_orientation(f, a, &e, err) || read_pins(f, a, X, &e.pins[0]) ||
            read_pins(f, a, X + 1, &e.pins[1]))
            return -1;
        if (read_ends_off(f, a, X + 2, &e, err)) return -1;
    }
    if ((e.part = fl_frame_part_of(f, part, err)) < 0) return -1;
    f->element[k] = e;
    return 0;
}

static int freedoms_of(const char *digits)
{
    int bits = 0;
    for (const char *p = digits; *p; p++)
        if (*p >= '1' && *p <= '6') bits |= 1 << (*p - '1');
    return bits;
}

static int hold_grid(fl_frame_model *f, int64_t grid, int bits, fl_err *err)
{
    const int32_t k = grid > 0 ? fl_frame_node_of(f, 0, grid, err) : -1;
    if (k < 0) return grid > 0 ? -1 : 0;
    f->node[k].fixed |= bits;
    return 0;
}

/* 1 if the set is that of the first such entry. */
static int of_first_set(int64_t sid, int64_t *first, int32_t *others)
{
    if (*first == 0) *first = sid;
    if (*first == sid) return 1;
    ++*others;
    return 0;
}

static int read_supports(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    int64_t sid, g, last = 0;
    if (fl_bdf_id(a, 0, &sid, err)) return -1;
    if (!of_first_set(sid, &f->support_set, &f->extra_supports)) return 0;
    if (strcmp(a->name, "SPC") == 0) {
        for (int k = 1; k < 7 && !is_blank(a, k); k += 3) {
            double moved = 0.0;
            if (fl_bdf_integer(a, k, 0, &g, err) || fl_bdf_real(a, k + 2, &moved, err) ||
                hold_grid(f, g, freedoms_of(fl_bdf_field(a, k + 1)), err))
                return -1;
            if (moved != 0.0 && fl_frame_count_skipped(f, "SPC: enforced displacements; the freedom is held"))
                return -1;
        }
        return 0;
    }
    const int bits = freedoms_of(fl_bdf_field(a, 1));
    for (int k = 2; k < a->fields && k < FL_BDF_FIELDS; k++) {
        if (is_blank(a, k)) continue;
        if (strcasecmp(fl_bdf_field(a, k), "THRU") == 0) {
            if (fl_bdf_id(a, k + 1, &g, err)) return -1;
            if (g - last > 1000000) return fl_bdf_fail(a, err, "SPC1 holds more than a million grids");
            for (int64_t i = last + 1; i <= g; i++) /* only grids that are there */
                if (fl_id_map_find(&f->node_id, 0, i) >= 0 && hold_grid(f, i, bits, err)) return -1;
            k++;
            last = g;
            continue;
        }
        if (fl_bdf_id(a, k, &last, err) || hold_grid(f, last, bits, err)) return -1;
    }
    return 0;
}

static int read_load(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    int64_t sid, grid, system;
    double size;
    fl_vec3 n;
    if (fl_bdf_id(a, 0, &sid, err) || fl_bdf_id(a, 1, &grid, err) || fl_bdf_integer(a, 2, 0, &system, err) ||
        fl_bdf_real(a, 3, &size, err) || fl_bdf_point(a, 4, &n, err))
        return -1;
    if (!of_first_set(sid, &f->load_set, &f->extra_loads)) return 0;
    if (system) return fl_frame_count_skipped(f, "%s in a coordinate system of its own", a->name);
    const int32_t k = fl_frame_node_of(f, 0, grid, err);
    if (k < 0) return -1;
    fl_vec3 *to = a->name[0] == 'F' ? &f->node[k].force : &f->node[k].moment;
    *to = v3_madd(*to, size, n);
    return 0;
}

static int read_mass(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    int64_t grid;
    double mass, inertia = 0.0;
    fl_vec3 arm;
    if (fl_bdf_id(a, 1, &grid, err) || fl_bdf_real(a, 3, &mass, err) || fl_bdf_point(a, 4, &arm, err) ||
        fl_bdf_real(a, X, &inertia, err))
        return -1;
    const int32_t k = fl_frame_node_of(f, 0, grid, err);
    if (k < 0) return -1;
    f->node[k].mass += mass;
    return (v3_nonzero(arm) || inertia != 0.0) &&
                   fl_frame_count_skipped(f, "CONM2: offset and moments of inertia; its mass is at the grid")
               ? -1
               : 0;
}

static int read_grid(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    int64_t id, cd;
    if (fl_bdf_id(a, 0, &id, err) || fl_bdf_integer(a, 5, 0, &cd, err)) return -1;
    if (cd > 0 &&
        fl_frame_count_skipped(f, "GRID: displacement system CD; supports and orientations are taken in the "
                                  "basic one"))
        return -1;
    const int32_t k = fl_frame_node_of(f, 0, id, err);
    if (k < 0) return -1;
    f->node[k].fixed |= freedoms_of(fl_bdf_field(a, 6));
    return 0;
}

static const struct {
    const char *name;
    int (*read)(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err);
} ENTRY[] = {{"GRID", read_grid},      {"MAT1", read_material},  {"PBAR", read_property},
             {"PBARL", read_property}, {"PBEAM", read_property}, {"PBEAML", read_property},
             {"PROD", read_property},  {"PTUBE", read_property}, {"CBAR", read_element},
             {"CBEAM", read_element},  {"CROD", read_element},   {"CTUBE", read_element},
             {"CONROD", read_element}, {"SPC", read_supports},   {"SPC1", read_supports},
             {"FORCE", read_load},     {"MOMENT", read_load},    {"CONM2", read_mass}};

/* Entries that say nothing about the structure, or that the reader of the deck has used. */
static int says_nothing(const char *name)
{
    static const char *const no[] = {"CORD1R", "CORD1C", "CORD1S", "CORD2R",   "CORD2C",  "CORD2S",
                                     "GRDSET", "PARAM",  "EIGRL",  "EIGR",     "ENDDATA", "BEGIN",
                                     "CEND",   "SOL",    "TITLE",  "SUBTITLE", "ECHO",    "ID"};
    for (size_t k = 0; k < sizeof no / sizeof *no; k++)
        if (strcmp(name, no[k]) == 0) return 1;
    return 0;
}

int fl_frame_bdf_entry(fl_frame_model *f, const fl_bdf_entry *a, fl_err *err)
{
    for (size_t k = 0; k < sizeof ENTRY / sizeof *ENTRY; k++)
        if (strcmp(a->name, ENTRY[k].name) == 0) return ENTRY[k].read(f, a, err);
    if (!a->bulk || says_nothing(a->name)) return 0;
    return fl_frame_count_skipped(f, "%s", a->name);
}
