/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/array.h"
#include "mesh/bytes.h"
#include "mesh/rejected_formats.h"
#include "mesh/gstruct.h"
#include "mesh/read_bdf.h"
#include "mesh/read_cdb.h"
#include "mesh/read_inp.h"
#include "mesh/read_mesh.h"
#include "mesh/read_msh.h"
#include "mesh/read_obj.h"
#include "mesh/read_off.h"
#include "mesh/read_ply.h"
#include "mesh/read_stl.h"
#include "mesh/read_vtk.h"
#include "mesh/read_vtk_xml.h"

enum { NAME = 128 };

/* "dir/tower.v2.stl" is called "tower.v2"; so is "tower.v2.stl.gz". */
static void base_name(const char *path, char name[NAME])
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
    if (len > NAME - 1) len = NAME - 1;
    memcpy(name, start, len);
    name[len] = '\0';
}

/* Hand the bytes on as the text they are: what is read so far, and the stream behind it. */
static int read_own(fl_surface *s, fl_bytes *b, fl_err *err)
{
    fl_text text = {.in = b->in, .chunk = b->data, .chunk_len = b->n};
    b->in = NULL;
    b->data = NULL;
    return fl_gstruct_read_text(s, &text, err);
}

static int starts_with(const fl_bytes *b, const char *word)
{
    const char *p = b->data + strspn(b->data, " \t\r\n");
    return strncasecmp(p, word, strlen(word)) == 0;
}

/* Drop the parts that nobody wishes for. */
static int choose(fl_surface *s, fl_import_options *w, fl_err *err)
{
    int32_t kept = 0;
    int failed = 0;
    for (int32_t i = 0; i < s->n; i++) {
        const int takes = failed ? 0 : fl_import_selects(w, s->part[i].name, err);
        failed |= takes < 0;
        if (takes > 0) s->part[kept++] = s->part[i];
        else fl_part_free(&s->part[i]);
    }
    s->n = kept;
    return failed ? -1 : 0;
}

/* A mesh of triangles and polygons: chosen from once it is read. */
static int read_faces(fl_surface *s, fl_bytes *b, const char *name, fl_err *err)
{
    const int zero = memchr(b->data, '\0', (size_t)b->n) != NULL;
    if (b->n == 0) return fl_bytes_fail(b, err, "empty, a mesh is expected");
    if (fl_stl_is_binary(b)) return fl_stl_read_binary(s, b, name, err);
    if (fl_ply_is(b)) return fl_ply_read(s, b, name, err);
    if (starts_with(b, "#g_struct")) return read_own(s, b, err);
    if (!starts_with(b, "solid") && fl_rejected_format(b))
        return fl_bytes_fail(b, err, "%s", fl_rejected_format(b));
    if (zero)
        return fl_bytes_fail(
            b, err,
            "%d bytes of binary data%s: not a whole binary STL (84 + 50 n bytes), and no other "
            "kind that is known",
            b->n, b->ended ? "" : " and more");
    if (starts_with(b, "solid")) return fl_stl_read_ascii(s, b, name, err);
    if (fl_off_is(b)) return fl_off_read(s, b, name, err);
    if (fl_obj_is(b)) return fl_obj_read(s, b, name, err);
    return fl_bytes_fail(
        b, err, "neither STL, OBJ, OFF, PLY, VTK, g_struct, nor a mesh of Abaqus, ANSYS, Gmsh or Nastran");
}

/* Is it a mesh of those above?  Decks of Nastran have no first word of their own and are looked for last. */
static int is_faces(const fl_bytes *b)
{
    return memchr(b->data, '\0', (size_t)b->n) || fl_stl_is_binary(b) || starts_with(b, "#g_struct") ||
           starts_with(b, "solid") || fl_off_is(b) || fl_obj_is(b);
}

static int read_any(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *w, fl_err *err)
{
    if (fl_msh_is(b)) return fl_msh_read(s, b, name, w, err);
    /* arrays of an XML file may lie anywhere behind the tags, and several times in the same place */
    if (fl_vtk_xml_is(b)) return fl_bytes_read_all(b, err) ? -1 : fl_vtk_xml_read(s, b, name, w, err);
    if (fl_vtk_is(b)) return fl_vtk_read(s, b, name, w, err);
    if (fl_cdb_is(b)) return fl_cdb_read(s, b, name, w, err);
    if (fl_inp_is(b)) return fl_inp_read(s, b, name, w, err);
    if (!is_faces(b) && fl_bdf_is(b)) return fl_bdf_read(s, b, w, err);
    return read_faces(s, b, name, err) || choose(s, w, err) ? -1 : 0;
}

static void drop_empty(fl_surface *s, fl_bytes *b)
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
static int append(fl_surface *to, fl_surface *from, fl_err *err)
{
    const int32_t had = to->n;
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
            if (had == 0) to->part[k].id = from->part[i].id; /* the first file keeps its numbers */
            continue;
        }
        while (to->n > had) fl_part_free(&to->part[--to->n]);
        free(history);
        return -1;
    }
    for (int32_t i = 0; i < from->n; i++) {
        fl_part *p = &to->part[had + i], *q = &from->part[i];
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

int fl_mesh_read(fl_surface *s, const char *path, fl_import_options *w, char *note, fl_err *err)
{
    fl_bytes b = {0};
    fl_surface got = {0};
    char name[NAME];
    int rc = -1;
    note[0] = '\0';
    base_name(path, name);
    if (fl_bytes_open(&b, path, err) || read_any(&got, &b, name, w, err)) goto done;
    drop_empty(&got, &b);
    memcpy(note, b.note, FL_MESH_NOTE);
    if (got.n == 0 && !fl_import_by_name(w)) {
        fl_fail(err, FL_INPUT, "%s: no triangles", strcmp(path, "-") == 0 ? "<stdin>" : path);
        goto done;
    }
    if (append(s, &got, err)) goto done;
    rc = 0;
done:
    fl_surface_free(&got);
    fl_bytes_free(&b);
    return rc;
}
