/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block_run.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/array.h"
#include "base/option.h"
#include "base/output_guard.h"
#include "base/stream.h"
#include "block/closed_surface.h"
#include "block_export.h"
#include "block_plot.h"
#include "block_report.h"
#include "block_result.h"
#include "geom/facet.h"
#include "geom/weld.h"
#include "ice/domain_read.h"
#include "mesh/read_mesh.h"

/* Radius over the least spacing, and least thickness over the radius: a core of a tenth of the radius is
 * left. */
static const double RADIUS = 1e-3, THICKNESS = 2.2;

/* --- the model ---------------------------------------------------------------------------------- */

static int box_of(const char *text, fl_vec3 *lo, fl_vec3 *hi, fl_err *err)
{
    double x[6];
    int n;
    if (fl_option_numbers("in", text, ',', 6, 6, -1e9, 1e9, "box:X0,Y0,Z0,X1,Y1,Z1", x, &n, err)) return -1;
    *lo = v3(x[0], x[1], x[2]), *hi = v3(x[3], x[4], x[5]);
    if (lo->x < hi->x && lo->y < hi->y && lo->z < hi->z) return 0;
    return fl_fail(err, FL_USAGE, "box:%.60s: X0 < X1, Y0 < Y1 and Z0 < Z1 are expected", text);
}

static int add_outline(const struct options *o, fl_part *p, const char *path, fl_err *err)
{
    fl_domain d = {0};
    const int plan = !isnan(o->z[0]);
    double(*xy)[2] = NULL;
    int rc = -1;
    if (fl_domain_read(&d, path, err)) return -1;
    if (d.rings > 1) {
        fl_fail(err, FL_INPUT, "%s: the outline has holes, one ring is expected", path);
        goto done;
    }
    if (!(xy = fl_alloc(d.corners, sizeof *xy, err))) goto done;
    for (int32_t k = 0; k < d.corners; k++) xy[k][0] = d.v[k].x, xy[k][1] = d.v[k].y;
    const double *range = plan ? o->z : o->y;
    if (fl_closed_surface_prism(p, d.corners, (const double(*)[2])xy, plan ? range[0] : -range[1],
                                plan ? range[1] : -range[0], err))
        goto done;
    /* (x, z, -y) is a rotation: a profile keeps its orientation */
    for (int32_t k = 0; k < p->nv && !plan; k++) p->v[k] = v3(p->v[k].x, -p->v[k].z, p->v[k].y);
    rc = 0;
done:
    free(xy);
    fl_domain_free(&d);
    return rc;
}

static int add_mesh(fl_part *p, const char *path, fl_err *err)
{
    char note[FL_MESH_NOTE];
    fl_surface s = {0};
    fl_weld weld;
    int rc = fl_mesh_read(&s, path, NULL, note, err);
    for (int32_t k = 0; k < s.n && rc == 0; k++) {
        const fl_part *q = &s.part[k];
        const int32_t from = p->nv;
        if (q->nc)
            rc = fl_fail(err, FL_INPUT,
                         "%s: part %s has cones: struct-import --facets makes triangles of them", path,
                         q->name);
        for (int32_t v = 0; v < q->nv && rc == 0; v++) rc = fl_surface_vertex(p, q->v[v], err);
        for (int32_t t = 0; t < q->nt && rc == 0; t++)
            rc = fl_surface_triangle(p, from + q->t[t].v[0], from + q->t[t].v[1], from + q->t[t].v[2], err);
    }
    if (rc == 0) rc = fl_part_weld(p, 0.0, &weld, err);
    fl_surface_free(&s);
    return rc;
}

/* A region as a closed surface. */
static int surface_of(const struct options *o, const char *in, fl_part *p, fl_err *err)
{
    fl_vec3 lo, hi;
    if (strncmp(in, "box:", 4) == 0)
        return box_of(in + 4, &lo, &hi, err) || fl_facet_box(p, lo, hi, err) ? -1 : 0;
    if (!isnan(o->z[0]) || !isnan(o->y[0])) return add_outline(o, p, in, err);
    return add_mesh(p, in, err);
}

static int fail_in(const char *in, const fl_err *why, fl_err *err)
{
    return fl_fail(err, why->code, "%s%s%s", why->code == FL_INPUT ? in : "",
                   why->code == FL_INPUT ? ": " : "", why->text);
}

static int make_model(const struct options *o, struct result *r, fl_err *err)
{
    fl_vec3 lo, hi;
    fl_part p = {0};
    fl_err why = {0};
    if (strncmp(o->in, "box:", 4) == 0)
        return box_of(o->in + 4, &lo, &hi, err) || fl_block_model_box(&r->model, lo, hi, err) ? -1 : 0;
    int rc = surface_of(o, o->in, &p, err);
    if (rc == 0 && fl_block_model_surface(&r->model, &p, &why)) rc = fail_in(o->in, &why, err);
    fl_part_free(&p);
    return rc;
}

static int apply_region(const struct options *o, struct result *r, const struct named_region *g, fl_err *err)
{
    fl_part p = {0};
    fl_err why = {0};
    int rc = surface_of(o, g->in, &p, err);
    if (rc == 0 && g->cut) {
        if (fl_block_model_region(&r->model, &p, g->name, &why)) rc = fail_in(g->in, &why, err);
    } else if (rc == 0) {
        const int32_t id = fl_string_table_add(&r->model.groups, g->name, err);
        for (int32_t k = 0; k < r->model.n && id >= 0; k++) {
            fl_vec3 x;
            fl_block_shape_volume(&r->model.block[k], &x);
            if (fl_closed_surface_contains(&p, x)) r->model.block[k].group = id;
        }
        rc = id < 0 ? -1 : 0;
    }
    fl_part_free(&p);
    return rc;
}

static int apply_regions(const struct options *o, struct result *r, int cut, fl_err *err)
{
    for (int32_t k = 0; k < o->regions; k++)
        if (o->region[k].cut == cut && apply_region(o, r, &o->region[k], err)) return -1;
    return 0;
}

/* --- settings ----------------------------------------------------------------------------------- */

static int choose_sizes(const struct options *o, struct result *r, fl_err *err)
{
    double least = INFINITY;
    const fl_joint_set *at = NULL;
    for (int32_t k = 0; k < r->sets.n; k++)
        if (r->sets.set[k].spacing > 0.0 && r->sets.set[k].spacing < least)
            at = &r->sets.set[k], least = at->spacing;
    r->radius = !isnan(o->radius) ? o->radius : RADIUS * (at ? least : r->model.size);
    if (at && least < 2.0 * r->radius)
        return fl_fail(err, FL_INPUT,
                       "joint %s has spacing %g m, less than twice the dilation radius of %g m", at->name,
                       least, r->radius);
    r->min_thickness = !isnan(o->min_thickness) ? o->min_thickness : THICKNESS * r->radius;
    if (r->radius > 0.0 && r->min_thickness < 2.0 * r->radius)
        return fl_fail(err, FL_USAGE,
                       "--min-thickness is %g m, a block needs more than twice the radius of %g m",
                       r->min_thickness, r->radius);
    return 0;
}

static int copy_sets(const struct options *o, struct result *r, fl_err *err)
{
    if (o->joints.n == 0) return 0;
    if (!(r->sets.set = fl_alloc(o->joints.n, sizeof *r->sets.set, err))) return -1;
    memcpy(r->sets.set, o->joints.set, (size_t)o->joints.n * sizeof *r->sets.set);
    r->sets.n = r->sets.cap = o->joints.n;
    fl_joint_sets_sort(&r->sets);
    return 0;
}

static void warn_of_planes(const struct result *r)
{
    for (int32_t p = r->model.first_joint; p < r->model.planes; p++) {
        const fl_joint_plane *q = &r->model.plane[p];
        const fl_joint_set *s = &r->sets.set[q->set];
        if (r->model.cuts[p] == 0 && s->number > 0)
            fprintf(stderr, "block-cut: plane %d of joint %s meets no block\n", q->number, s->name);
    }
    for (int32_t s = 0; s < r->sets.n; s++) {
        int some = 0;
        for (int32_t p = r->model.first_joint; p < r->model.planes; p++)
            some |= r->model.plane[p].set == s && r->model.cuts[p];
        if (!some && r->sets.set[s].number == 0)
            fprintf(stderr, "block-cut: no plane of joint %s cuts a block\n", r->sets.set[s].name);
    }
}

static int remove_regions(const struct options *o, struct result *r, fl_err *err)
{
    for (int32_t k = 0; k < o->removes; k++) {
        const int32_t g = fl_string_table_find(&r->model.groups, o->remove[k]);
        for (int32_t b = 0; b < r->model.n; b++)
            if (r->model.block[b].group == g)
                r->deleted_volume += fl_block_shape_volume(&r->model.block[b], NULL);
        const int32_t gone = fl_block_model_delete(&r->model, o->remove[k], err);
        if (gone < 0) return -1;
        r->deleted += gone;
    }
    if (r->model.n == 0) return fl_fail(err, FL_INPUT, "no block is left");
    return 0;
}

static int check_files(const struct options *o, fl_err *err)
{
    const fl_named_path out[] = {{"--output", o->out}, {"--certificate", o->certificate}};
    const fl_named_path in[] = {{.path = strncmp(o->in, "box:", 4) ? o->in : NULL}, {.path = o->joint_file}};
    return fl_output_guard_check(out, 2, in, 2, err);
}

static int run_all(const struct options *o, struct result *r, fl_err *err)
{
    fl_history_line by;
    fl_sliver_rule rule = {0};
    if (check_files(o, err) || copy_sets(o, r, err) || make_model(o, r, err) || choose_sizes(o, r, err))
        return -1;
    if (o->plot && mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    if (apply_regions(o, r, 1, err) || fl_block_model_cut(&r->model, &r->sets, o->seed, err) ||
        fl_block_model_sort(&r->model, err) || apply_regions(o, r, 0, err) ||
        fl_face_pairs_find(&r->pairs, &r->model, &r->sets, o->seed, err) ||
        fl_block_certify(&r->certificate, &r->model, &r->pairs, &r->sets, err))
        return -1;
    warn_of_planes(r);
    if (remove_regions(o, r, err)) return -1;
    if (r->deleted) {
        fl_face_pairs_free(&r->pairs);
        if (fl_face_pairs_find(&r->pairs, &r->model, &r->sets, o->seed, err)) return -1;
    }
    rule.min_width = r->min_thickness, rule.min_volume = o->min_volume, rule.keep = o->keep_slivers;
    rule.radius = r->radius;
    if (fl_slivers_remove(&r->slivers, &r->model, &r->pairs, &r->sets, o->seed, &rule, err)) return -1;
    if (r->model.n == 0)
        return fl_fail(err, FL_INPUT, "no block is left that is thicker than %g m", r->min_thickness);
    options_by(o, &by);
    if (block_export(o, r, &by, err) || (o->certificate && block_report_write(o, r, &by, err))) return -1;
    if (!o->quiet) block_report_print(o, r);
    if (o->plot && block_plot(o, r, &by, err)) return -1;
    return block_report_answer(r, err);
}

int block_run(const struct options *o, fl_err *err)
{
    struct result r = {0};
    const int rc = run_all(o, &r, err);
    fl_slivers_free(&r.slivers);
    fl_block_certificate_free(&r.certificate);
    fl_face_pairs_free(&r.pairs);
    fl_block_model_free(&r.model);
    fl_joint_sets_free(&r.sets);
    return rc;
}
