/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/stream.h"
#include "base/output_guard.h"
#include "geom/facet.h"
#include "geom/mesh_patch.h"
#include "geom/mirror_half.h"
#include "geom/raise_deck.h"
#include "geom/weld.h"
#include "mesh/gstruct.h"
#include "mesh/read_mesh.h"
#include "mesh/single_precision.h"
#include "mesh/write_obj.h"
#include "mesh/write_off.h"
#include "mesh/write_ply.h"
#include "mesh/write_stl.h"
#include "mesh/write_vtp.h"
#include "part_names.h"
#include "members_import.h"
#include "options.h"
#include "views.h"
#include "quality_report.h"
#include "joint_closure.h"

/* Facets of a round solid in a format without cones; 0.2 % of its volume is lost. */
enum { ROUND_FACETS = 64 };

/* Apply --name: the only part of a file gets the name, several parts get it as a prefix. */
static int rename_parts(fl_surface *s, int32_t first, const char *name, fl_err *err)
{
    const int32_t n = s->n - first;
    for (int32_t i = first; name && i < s->n; i++) {
        const char *own = s->part[i].name;
        const size_t len = strlen(name), more = n > 1 ? strlen(own) + 1 : 0;
        char *whole = fl_alloc((int64_t)(len + more + 1), 1, err);
        int32_t k;
        if (!whole) return -1;
        memcpy(whole, name, len);
        if (more) {
            whole[len] = '.';
            memcpy(whole + len + 1, own, more - 1);
        }
        s->part[i].name[0] = '\0';                     /* the new name may equal the old one */
        k = fl_surface_add(s, whole, len + more, err); /* makes the name valid and unique */
        free(whole);
        if (k < 0) return -1;
        free(s->part[i].name);
        s->part[i].name = s->part[k].name;
        s->n--;
    }
    return 0;
}

/* Apply --symmetry to the parts of a file. */
static int add_halves(const struct options *o, fl_surface *s, int32_t first, const char *path, fl_err *err)
{
    static const double IN_PLANE = 1e-6; /* of the diagonal of a part */
    for (int32_t i = first; i < s->n; i++)
        for (int axis = 0; axis < 2; axis++) {
            const fl_aabb box = fl_part_aabb(&s->part[i]);
            int32_t crosses = -1;
            if (!(o->symmetry >> axis & 1)) continue;
            if (fl_part_mirror_half(&s->part[i], axis, IN_PLANE * v3_norm(v3_sub(box.hi, box.lo)), &crosses,
                                    err))
                return -1;
            if (crosses >= 0)
                return fl_fail(
                    err, FL_INPUT,
                    "%s: part \"%.60s\" lies on both sides of %c = 0, across which --symmetry %c mirrors it",
                    path, s->part[i].name, 'x' + axis, 'x' + axis);
        }
    return 0;
}

/* Apply --deck: weld a part, orient it and raise its rims. */
static int raise_decks(const struct options *o, fl_surface *s, fl_err *err)
{
    int32_t raised = 0;
    for (int32_t i = 0; o->deck > 0.0 && i < s->n; i++) {
        fl_part *p = &s->part[i];
        fl_mesh_quality came;
        fl_orient_counts turned;
        fl_deck_counts did;
        fl_weld w;
        if (p->nt == 0) continue;
        if (fl_part_weld(p, o->weld, &w, err) || fl_part_orient(p, &came, &turned, err) ||
            fl_part_raise_deck(p, o->deck, &did, err))
            return -1;
        raised += did.rims;
        if (did.rims && !o->quiet)
            fprintf(
                stderr,
                "struct-import: %s: %d rims of %d edges at z = %.6g were raised by %g m and closed, %d of "
                "them are holes; %d triangles at the waterline were left out\n",
                p->name, did.rims, did.edges, did.top, o->deck, did.holes, did.lids);
    }
    if (o->deck > 0.0 && raised == 0)
        return fl_fail(err, FL_INPUT, "--deck %g: no part has an open rim that lies flat at its top",
                       o->deck);
    return 0;
}

static int read_file(const struct options *o, const struct item *it, fl_import_options *w, fl_surface *s,
                     fl_err *err)
{
    const int32_t first = s->n;
    char note[FL_MESH_NOTE];
    const int rc = fl_mesh_read(s, it->path, w, note, err);
    for (char *p = note, *end; !o->quiet && (end = strchr(p, '\n')) != NULL; p = end + 1)
        fprintf(stderr, "struct-import: %s: %.*s\n", it->path, (int)(end - p), p);
    if (rc || rename_parts(s, first, it->name, err) || add_halves(o, s, first, it->path, err)) return -1;
    for (int32_t i = first; i < s->n; i++) fl_part_map(&s->part[i], &o->map);
    return 0;
}

static int add_solid(const struct item *it, fl_surface *s, fl_err *err)
{
    static const char *const kind[] = {"", "cylinder", "cone", "box"};
    const char *name = it->name ? it->name : kind[it->kind];
    const int32_t i = fl_surface_add(s, name, strlen(name), err);
    if (i < 0) return -1;
    if (it->kind == ITEM_BOX) return fl_facet_box(&s->part[i], it->box.lo, it->box.hi, err);
    return fl_surface_cone(&s->part[i], it->cone, err);
}

/* Replace the cones of a part by triangles. */
static int facet_cones(fl_part *p, int32_t n, fl_err *err)
{
    for (int32_t c = 0; c < p->nc; c++)
        if (fl_facet_cone(p, &p->cone[c], n, err)) return -1;
    p->nc = 0;
    return 0;
}

/* Names that a reader of g_struct(5) rejects are rejected here. */
static int check_names(const fl_surface *s, fl_err *err)
{
    for (int32_t i = 0; i < s->n; i++)
        if (strcmp(s->part[i].name, FL_GSTRUCT_TOTAL) == 0)
            return fl_fail(
                err, FL_INPUT,
                "a part is called " FL_GSTRUCT_TOTAL
                ", as loads call the sum over the parts: another --name, or --rename, is expected");
    return 0;
}

static int collect_parts(const struct options *o, fl_surface *s, fl_err *err)
{
    const int32_t facets = o->facets ? o->facets : o->to == TO_G_STRUCT ? 0 : ROUND_FACETS;
    struct selection c = {0};
    int bad = selection_start(&c, o, err);
    for (int32_t k = 0; !bad && k < o->items; k++) {
        const struct item *it = &o->item[k];
        bad = it->kind == ITEM_FILE ? read_file(o, it, &c.opt, s, err) : add_solid(it, s, err);
    }
    if (!bad) bad = selection_check(&c, err);
    selection_free(&c);
    if (bad || rename_all(o, s, err) || raise_decks(o, s, err) ||
        (o->to == TO_G_STRUCT && check_names(s, err)))
        return -1;
    for (int32_t i = 0; facets && i < s->n; i++)
        if (facet_cones(&s->part[i], facets, err)) return -1;
    return 0;
}

static int write_format(enum format to, FILE *f, const fl_surface *s, const fl_history_line *by, fl_err *err)
{
    switch (to) {
    case TO_STL: fl_stl_write_ascii(f, s); return 0;
    case TO_STL_BINARY: fl_stl_write_binary(f, s); return 0;
    case TO_OBJ: fl_obj_write(f, s); return 0;
    case TO_OFF: fl_off_write(f, s); return 0;
    case TO_PLY: return fl_ply_write(f, s, err);
    case TO_VTP: return fl_vtp_write(f, s, err);
    default: fl_gstruct_write(f, s, by); return 0;
    }
}

static int write_out(const struct options *o, const fl_surface *s, fl_err *err)
{
    fl_out out = {0};
    fl_history_line by;
    int rc = -1;
    options_by(o, &by);
    if (fl_out_open(&out, o->out, o->gzip, err)) goto done;
    if (write_format((enum format)o->to, out.f, s, &by, err)) goto done;
    rc = fl_out_close(&out, err);
done:
    fl_out_abort(&out);
    return rc;
}

/* With --strict, fail if a part does not bound a body by itself or together with others. */
static int check_strict(const fl_surface *s, const struct cleanup *m, fl_err *err)
{
    for (int32_t i = 0; i < s->n; i++) {
        const fl_mesh_quality *q = &m[i].quality;
        if ((q->open && !m[i].closes_jointly) || q->branched || q->incoherent)
            return fl_fail(err, FL_NO,
                           "part \"%.60s\" still has %d open, %d non-manifold and %d twisted edges",
                           s->part[i].name, q->open, q->branched, q->incoherent);
        if (q->degenerate || m[i].crossing.crossings)
            return fl_fail(err, FL_NO,
                           "part \"%.60s\" still has %d triangles without area and %d pairs that cross",
                           s->part[i].name, q->degenerate, m[i].crossing.crossings);
    }
    return 0;
}

/* A repair that changes what bodies enclose is told by the status. */
static int check_repair(const fl_surface *s, const struct cleanup *m, fl_err *err)
{
    for (int32_t i = 0; i < s->n; i++)
        if (m[i].lost)
            return fl_fail(err, FL_NO, "part \"%.60s\": repair made %.6g m3 of bodies of %.6g m3",
                           s->part[i].name, m[i].volume.result, m[i].volume.source);
    return 0;
}

static int check_output(const struct options *o, fl_err *err)
{
    const fl_named_path out = {"--output", o->out};
    for (int32_t k = 0; k < o->items; k++)
        if (fl_output_guard_check(&out, 1, &(fl_named_path){.path = o->item[k].path}, 1, err)) return -1;
    return 0;
}

/* Coordinates far from the origin do not fit in single precision: up to ROUGH of the size of a part they are
 * rounded with a warning (quality_report.c), beyond it the output is refused. */
static int round_coordinates(const struct options *o, const fl_surface *s, struct cleanup *m, fl_err *err)
{
    static const double ROUGH = 1e-3;
    for (int32_t i = 0; o->to == TO_STL_BINARY && i < s->n; i++) {
        const fl_aabb box = fl_part_aabb(&s->part[i]);
        const double size = v3_norm(v3_sub(box.hi, box.lo));
        m[i].rounding = fl_single_rounding(&s->part[i]);
        m[i].deviation += m[i].rounding;
        m[i].source_deviation += m[i].rounding;
        if (m[i].rounding > ROUGH * size)
            return fl_fail(
                err, FL_INPUT,
                "part \"%.60s\" is %.4g m across, and the single precision of stl-binary moves its "
                "vertices by up to %.3g m so far from the origin: another --to, or --translate, is "
                "expected",
                s->part[i].name, size, m[i].rounding);
    }
    return 0;
}

static int run(const struct options *o, fl_err *err)
{
    fl_surface s = {0};
    struct cleanup *m = NULL;
    int rc = -1;
    if (check_output(o, err)) return -1;
    if (o->members) return import_members(o, err);
    if (o->threads) omp_set_num_threads(o->threads);
    if (collect_parts(o, &s, err)) goto done;
    m = fl_alloc(s.n, sizeof *m, err);
    if (!m) goto done;
    for (int32_t i = 0; i < s.n; i++)
        if (clean_part(&s.part[i], o, &m[i], err)) goto done;
    if (!o->raw && close_jointly(&s, m, err)) goto done;
    if (round_coordinates(o, &s, m, err)) goto done;
    if (print_report(o, &s, m, err) || write_out(o, &s, err)) goto done;
    if (o->plot && draw_views(&s, o->plot, err)) goto done;
    rc = check_repair(&s, m, err) || (o->strict && check_strict(&s, m, err)) ? -1 : 0;
done:
    free(m);
    fl_surface_free(&s);
    return rc;
}

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_tool_begin();
    fl_parallel_limit_spin(argv);
    int rc = options_parse(&o, argc, argv, &err); /* answers --help and --version itself */
    if (rc == 0 && !o.ended) rc = run(&o, &err);
    options_free(&o);
    return fl_tool_end("struct-import", rc, &err);
}
