/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/gstruct.h"
#include "mesh/read_aqwa.h"
#include "mesh/read_bdf.h"
#include "mesh/read_cdb.h"
#include "mesh/read_gdf.h"
#include "mesh/read_genie.h"
#include "mesh/read_hams.h"
#include "mesh/read_hydrostar.h"
#include "mesh/read_inp.h"
#include "mesh/read_mesh.h"
#include "mesh/read_msh.h"
#include "mesh/read_nemoh.h"
#include "mesh/read_obj.h"
#include "mesh/read_off.h"
#include "mesh/read_openfast.h"
#include "mesh/read_ply.h"
#include "mesh/read_sacs.h"
#include "mesh/read_salome_dat.h"
#include "mesh/read_sesam.h"
#include "mesh/read_stl.h"
#include "mesh/read_tecplot.h"
#include "mesh/read_unv.h"
#include "mesh/read_usfos.h"
#include "mesh/read_vtk.h"
#include "mesh/read_vtk_xml.h"
#include "mesh/rejected_formats.h"
#include "mesh/single_precision.h"

enum { NAME_MAX = 128 };

/* "dir/tower.v2.stl" is called "tower.v2"; so is "tower.v2.stl.gz". */
static void base_name(const char *path, char name[NAME_MAX])
{
    const char *slash = strrchr(path, '/'), *start = slash ? slash + 1 : path;
    size_t len = strlen(start);
    if (strcmp(path, "-") == 0) {
        start = "stdin";
        len = 5;
    }
    if (len > 3 && strcasecmp(start + len - 3, ".gz") == 0) len -= 3;
    for (size_t k = len; k-- > 1;)
        if (start[k] == '.') {
            len = k;
            break;
        }
    if (len > NAME_MAX - 1) len = NAME_MAX - 1;
    memcpy(name, start, len);
    name[len] = '\0';
}

/* Order of trust: a format whose files cannot be mistaken for another comes first. Lines that begin with *
 * look like Abaqus and are comments in others, so it stands behind them. */
const fl_mesh_format FL_MESH_FORMATS[] = {
    {"Gmsh", "Gmsh", fl_msh_is, fl_msh_read, 0, 1, "MSH 2 and 4.1: shells, solids", "points, lines",
     "versions 1 and 4.0"},
    {"GeniE", "GeniE", fl_genie_is, fl_genie_read, 1, 1, "straight beams of pipes, cones and boxes",
     "other sections, plates, curved beams", "lengths of unknown units"},
    /* arrays of an XML file lie anywhere behind the tags, and several may share the same bytes */
    {"VTK", "VTK", fl_vtk_xml_is, fl_vtk_xml_read, 1, 1, "POLYDATA, UNSTRUCTURED_GRID; vtp, vtu",
     "points, lines", "structured grids"},
    {"VTK", "VTK", fl_vtk_is, fl_vtk_read, 0, 1, "POLYDATA, UNSTRUCTURED_GRID; vtp, vtu", "points, lines",
     "structured grids"},
    {"SESAM", "SESAM", fl_sesam_is, fl_sesam_read, 0, 1,
     "pipes and boxes with tapers and offsets, shells, solids, sets", "profiles, springs, masses",
     "files of GELMNT2 alone; SIN, SIU"},
    {"OpenFAST", "OpenFAST", fl_openfast_is, fl_openfast_read, 0, 1,
     "SubDyn, HydroDyn: round and rectangular members with tapers",
     "cables, rigid links, springs, arbitrary sections", "other modules"},
    {"USFOS", "USFOS", fl_usfos_is, fl_usfos_read, 0, 1, "pipes and boxes with offsets, plates, groups",
     "IHPROFIL, GENBEAM, loads", "nothing"},
    {"SACS", "SACS", fl_sacs_is, fl_sacs_read, 0, 1, "tubulars and cones by segments, plates, groups",
     "other sections, members of missing joints, springs", "files without units"},
    {"UNV", "UNV", fl_unv_is, fl_unv_read, 0, 1, "shells and solids of datasets 2411, 2412, groups of 2467",
     "beams, other datasets", "nothing"},
    {"HAMS", "HAMS", fl_hams_is, fl_hams_read, 0, 0, "panels with symmetry", "nothing",
     "panels across a plane of symmetry"},
    {"HydroStar", "HydroStar", fl_hydrostar_is, fl_hydrostar_read, 0, 0, "panels of bodies with symmetry",
     "all other blocks", "PANEL of other types"},
    {"AQWA", "AQWA", fl_aqwa_is, fl_aqwa_read, 0, 0, "QPPL and TPPL of bodies with symmetry",
     "tubes, discs, masses", "one SYMX or SYMY that fits no rim, or two"},
    {"Tecplot", "Tecplot", fl_tecplot_is, fl_tecplot_read, 0, 0,
     "zones of triangles and quadrilaterals, grids", "further variables", "data in blocks, zones of solids"},
    {"ANSYS", "ANSYS archive", fl_cdb_is, fl_cdb_read, 0, 1,
     "shells, solids, round beams and pipes, components", "fluids, contact, other sections",
     "the unblocked format"},
    {"Abaqus", "Abaqus, CalculiX", fl_inp_is, fl_inp_read, 0, 1,
     "shells, solids, round beams and pipes, sets, assemblies", "fluids, other sections",
     "*NCOPY, *NFILL, *PARAMETER, arcs"},
    {"STL", "STL", fl_stl_is, fl_stl_read, 0, 0, "triangles, ASCII and binary", "colours", "nothing"},
    {"PLY", "PLY", fl_ply_is, fl_ply_read, 0, 0, "faces, ASCII and binary", "other properties", "nothing"},
    {"g_struct", "g_struct", fl_gstruct_is, fl_gstruct_read_bytes, 0, 0, "parts of triangles and cones",
     "nothing", "versions to come"},
    {"OFF", "OFF", fl_off_is, fl_off_read, 0, 0, "faces", "colours", "nothing"},
    {"OBJ", "OBJ", fl_obj_is, fl_obj_read, 0, 0, "polygons, groups", "free-form surfaces, textures",
     "nothing"},
    /* numbers alone: the first lines decide */
    {"NEMOH", "NEMOH", fl_nemoh_is, fl_nemoh_read, 0, 0, "panels with symmetry", "nothing",
     "meshes of the free surface"},
    {"Salome", "Salome", fl_salome_dat_is, fl_salome_dat_read, 0, 0, "triangles and quadrilaterals",
     "lines, solids", "nothing"},
    {"WAMIT", "WAMIT", fl_gdf_is, fl_gdf_read, 0, 0, "flat panels with symmetry", "dipole panels",
     "IGDEF other than 0, lists of bodies, control surfaces"},
    /* a Nastran deck has no first word of its own */
    {"Nastran", "Nastran", fl_bdf_is, fl_bdf_read, 0, 1, "shells, solids, round bars and tubes, properties",
     "other sections, fluids", "replication, super-elements"},
    {0},
};

/* Remove the parts that the options do not select. */
static int select_parts(fl_surface *s, fl_import_options *opt, fl_err *err)
{
    int32_t kept = 0;
    int failed = 0;
    for (int32_t i = 0; i < s->n; i++) {
        const int selected = failed ? 0 : fl_import_selects(opt, s->part[i].name, err);
        failed |= selected < 0;
        if (selected > 0) s->part[kept++] = s->part[i];
        else fl_part_free(&s->part[i]);
    }
    s->n = kept;
    return failed ? -1 : 0;
}

/* True if an earlier row of the table has the name of row k. */
static int is_listed(int k)
{
    for (int j = 0; j < k; j++)
        if (strcmp(FL_MESH_FORMATS[j].name, FL_MESH_FORMATS[k].name) == 0) return 1;
    return 0;
}

/* Fail with the reason why no reader accepts the file. */
static int refuse_file(const fl_bytes *b, fl_err *err)
{
    char list[400] = "";
    size_t n = 0;
    if (b->n == 0) return fl_bytes_fail(b, err, "empty, a mesh is expected");
    if (fl_rejected_format(b)) return fl_bytes_fail(b, err, "%s", fl_rejected_format(b));
    if (!fl_bytes_is_text(b))
        return fl_bytes_fail(
            b, err,
            "%d bytes of binary data%s: not a whole binary STL (84 + 50 n bytes), and no other known format",
            b->n, b->ended ? "" : " and more");
    for (int k = 0; FL_MESH_FORMATS[k].name; k++)
        if (!is_listed(k) && n < sizeof list)
            n += (size_t)snprintf(list + n, sizeof list - n, "%s%s", n ? ", " : "", FL_MESH_FORMATS[k].name);
    return fl_bytes_fail(b, err, "unknown format, expected a mesh in one of %s", list);
}

static int read_any(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    const fl_mesh_format *f = FL_MESH_FORMATS;
    while (f->name && !f->is(b)) f++;
    if (!f->name) return refuse_file(b, err);
    if ((f->needs_all && fl_bytes_read_all(b, err)) || f->read(s, b, name, opt, err)) return -1;
    return f->selects ? 0 : select_parts(s, opt, err);
}

static void drop_empty_parts(fl_surface *s, fl_bytes *b)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < s->n; i++) {
        if (s->part[i].nt || s->part[i].nc) {
            s->part[kept++] = s->part[i];
        } else {
            fl_bytes_note(b, "part \"%.60s\" has no triangles and was dropped", s->part[i].name);
            fl_part_free(&s->part[i]);
        }
    }
    s->n = kept;
}

/* Move the parts of one surface to the end of another. */
static int append_surface(fl_surface *to, fl_surface *from, fl_err *err)
{
    const int32_t first = to->n;
    const size_t old = to->history ? strlen(to->history) : 0,
                 more = from->history ? strlen(from->history) : 0;
    char *history = NULL;
    if (more) {
        history = fl_alloc((int64_t)(old + more + 1), 1, err);
        if (!history) return -1;
    }
    for (int32_t i = 0; i < from->n; i++) {
        const int32_t k = fl_surface_add(to, from->part[i].name, strlen(from->part[i].name), err);
        if (k >= 0) {
            if (first == 0) to->part[k].id = from->part[i].id; /* the first file keeps the ids of its parts */
            continue;
        }
        while (to->n > first) fl_part_free(&to->part[--to->n]);
        free(history);
        return -1;
    }
    for (int32_t i = 0; i < from->n; i++) {
        fl_part *p = &to->part[first + i], *q = &from->part[i];
        char *name = p->name;
        const int32_t id = p->id;
        free(q->name);
        *p = *q;
        p->name = name;
        p->id = id;
        *q = (fl_part){0};
    }
    if (more) {
        if (old) memcpy(history, to->history, old);
        memcpy(history + old, from->history, more);
        free(to->history);
        to->history = history;
    }
    return 0;
}

/* Add a remark if the coordinates are of single precision, which is coarse beside the size of the box. */
static void check_precision(const fl_surface *s, fl_bytes *b)
{
    static const double COARSE = 1e-5; /* of the diagonal */
    const fl_aabb box = fl_surface_aabb(s);
    const double size = s->n ? v3_norm(v3_sub(box.hi, box.lo)) : 0.0, spacing = fl_single_spacing(box);
    if (!(spacing > COARSE * size) || !fl_single_is_all(s)) return;
    fl_bytes_note(
        b,
        "coordinates are of single precision, which are %.3g apart so far from the origin, and the box "
        "is %.4g across, in the unit of the file: write it with more digits, or nearer to the origin",
        spacing, size);
}

int fl_mesh_read(fl_surface *s, const char *path, fl_import_options *opt, char *note, fl_err *err)
{
    fl_bytes b = {0};
    fl_surface got = {0};
    char name[NAME_MAX];
    int rc = -1;
    note[0] = '\0';
    base_name(path, name);
    if (fl_bytes_open(&b, path, err) || read_any(&got, &b, name, opt, err)) goto done;
    drop_empty_parts(&got, &b);
    check_precision(&got, &b);
    memcpy(note, b.note, FL_MESH_NOTE);
    if (got.n == 0 && !fl_import_by_name(opt) && !(opt && opt->frame)) {
        fl_fail(err, FL_INPUT, "%s: no triangles", strcmp(path, "-") == 0 ? "<stdin>" : path);
        goto done;
    }
    if (append_surface(s, &got, err)) goto done;
    rc = 0;
done:
    fl_surface_free(&got);
    fl_bytes_free(&b);
    return rc;
}
