/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/pi.h"
#include "base/rng.h"
#include "geom/clip.h"
#include "geom/edges.h"
#include "geom/weld.h"
#include "ice/domain_read.h"
#include "mesh/gstruct.h"
#include "mesh/read_mesh.h"
#include "pack/pack_region.h"

/* Edges flatter than this are no edges to a body [rad]. */
static const double FLAT = 1e-6;

static int32_t add_wall(fl_pack_region *r, const char *name, fl_err *err)
{
    if (fl_grow(&r->wall, &r->wall_cap, (int64_t)r->walls + 1, sizeof *r->wall, err)) return -1;
    r->wall[r->walls] = (fl_region_wall){.helper = 0};
    snprintf(r->wall[r->walls].name, sizeof r->wall[r->walls].name, "%s", name);
    return r->walls++;
}

static fl_region_feature *add_feature(fl_pack_region *r, fl_region_feature f, fl_err *err)
{
    if (fl_grow(&r->feature, &r->feature_cap, (int64_t)r->features + 1, sizeof *r->feature, err)) return NULL;
    f.out = r->outs;
    r->feature[r->features] = f;
    return &r->feature[r->features++];
}

/* Adds a direction to the last feature. */
static int add_direction(fl_pack_region *r, fl_vec3 d, fl_err *err)
{
    if (fl_grow(&r->out, &r->out_cap, (int64_t)r->outs + 1, sizeof *r->out, err)) return -1;
    r->out[r->outs++] = v3_unit(d);
    r->feature[r->features - 1].outs++;
    return 0;
}

static int build_tree(fl_pack_region *r, fl_err *err)
{
    r->box = fl_alloc(r->features, sizeof *r->box, err);
    if (!r->box) return -1;
    fl_aabb all = aabb_empty();
    for (int32_t k = 0; k < r->features; k++) {
        r->box[k] = aabb_empty();
        for (int32_t c = 0; c < r->feature[k].corners; c++)
            r->box[k] = aabb_add(r->box[k], r->feature[k].p[c]);
        all = aabb_join(all, r->box[k]);
    }
    r->lo = all.lo;
    r->hi = all.hi;
    return fl_bvh_build(&r->tree, r->box, r->features, err);
}

/* --- the largest body inside ------------------------------------------------------------------- */

enum { PROBES = 2000, CLIMBS = 40, STEPS = 60 };

/* Largest distance from the complement: the best of random points, moved towards larger ones by a pattern
 * search. */
static void find_inradius(fl_pack_region *r)
{
    struct {
        fl_vec3 x;
        double g;
    } best[CLIMBS];
    fl_rng g = fl_rng_of(1, 0, FL_RNG_SCATTER);
    int n = 0;
    for (int k = 0; k < PROBES; k++) {
        const fl_vec3 x = v3(fl_rng_in(&g, r->lo.x, r->hi.x), fl_rng_in(&g, r->lo.y, r->hi.y),
                             r->dim == 2 ? 0.0 : fl_rng_in(&g, r->lo.z, r->hi.z));
        const double d = fl_region_distance(r, x, INFINITY);
        int at = n < CLIMBS ? n++ : CLIMBS - 1;
        if (at == CLIMBS - 1 && n == CLIMBS && k >= CLIMBS && d <= best[at].g) continue;
        for (; at > 0 && best[at - 1].g < d; at--) best[at] = best[at - 1];
        best[at].x = x;
        best[at].g = d;
    }
    for (int k = 0; k < n; k++) {
        double step = 0.2 * v3_norm(v3_sub(r->hi, r->lo));
        for (int s = 0; s < STEPS; s++) {
            int moved = 0;
            for (int c = 0; c < 2 * r->dim; c++) {
                const double d = c % 2 ? step : -step;
                const fl_vec3 x =
                    v3_add(best[k].x, v3(c / 2 == 0 ? d : 0, c / 2 == 1 ? d : 0, c / 2 == 2 ? d : 0));
                const double at = fl_region_distance(r, x, INFINITY);
                if (at > best[k].g) best[k].g = at, best[k].x = x, moved = 1;
            }
            if (!moved) step *= 0.6;
        }
        r->inradius = fmax(r->inradius, best[k].g);
    }
}

/* --- outlines ----------------------------------------------------------------------------------- */

static fl_vec3 flat_point(fl_vec2 p) { return v3(p.x, p.y, 0.0); }

static int add_ring(fl_pack_region *r, int32_t ring, fl_err *err)
{
    const fl_domain *d = &r->domain;
    const int32_t first = d->first[ring], n = d->first[ring + 1] - first, wall = r->walls;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 a = flat_point(d->v[first + k]), b = flat_point(d->v[first + (k + 1) % n]);
        const fl_vec3 t = v3_unit(v3_sub(b, a));
        char name[32];
        snprintf(name, sizeof name, "side-%d", first + k + 1);
        if (add_wall(r, name, err) < 0 ||
            !add_feature(
                r, (fl_region_feature){.corners = 2, .wall = wall + k, .p = {a, b}, .n = v3(-t.y, t.x, 0)},
                err))
            return -1;
    }
    for (int32_t k = 0; k < n; k++) {
        const fl_vec3 x = flat_point(d->v[first + k]), before = flat_point(d->v[first + (k + n - 1) % n]),
                      after = flat_point(d->v[first + (k + 1) % n]);
        const fl_vec3 in = v3_unit(v3_sub(x, before)), go = v3_unit(v3_sub(after, x));
        const fl_vec3 normal = v3_add(v3(-in.y, in.x, 0), v3(-go.y, go.x, 0));
        if (!add_feature(r,
                         (fl_region_feature){.corners = 1,
                                             .wall = wall + k,
                                             .p = {x},
                                             .n = normal,
                                             .convex = in.x * go.y - in.y * go.x > 0.0},
                         err) ||
            add_direction(r, go, err) || add_direction(r, v3_neg(in), err))
            return -1;
    }
    r->volume += fl_polygon_area(n, d->v + first);
    return 0;
}

static int make_outline(fl_pack_region *r, const char *path, fl_err *err)
{
    if (fl_domain_read(&r->domain, path, err) || fl_domain_build(&r->domain, err)) return -1;
    for (int32_t k = 0; k < r->domain.rings; k++)
        if (add_ring(r, k, err)) return -1;
    if (!(r->volume > 0.0)) return fl_fail(err, FL_INPUT, "%s: the holes leave no area", path);
    return build_tree(r, err);
}

/* --- surfaces ----------------------------------------------------------------------------------- */

/* All triangles in one part; wall[t] is the part that triangle t comes from. */
static int join_parts(fl_pack_region *r, fl_part *all, int32_t **wall, fl_err *err)
{
    int64_t triangles = 0;
    for (int32_t p = 0; p < r->surface.n; p++) triangles += r->surface.part[p].nt;
    if (!(*wall = fl_alloc(triangles, sizeof **wall, err))) return -1;
    for (int32_t p = 0; p < r->surface.n; p++) {
        const fl_part *part = &r->surface.part[p];
        const int32_t from = all->nv, w = add_wall(r, part->name, err);
        if (w < 0) return -1;
        if (part->nc)
            return fl_fail(
                err, FL_INPUT,
                "part %s has cones, a surface of triangles is expected: struct-import --facets makes one",
                part->name);
        for (int32_t k = 0; k < part->nv; k++)
            if (fl_surface_vertex(all, part->v[k], err)) return -1;
        for (int32_t t = 0; t < part->nt; t++) {
            const int32_t *v = part->t[t].v;
            (*wall)[all->nt] = w;
            if (fl_surface_triangle(all, from + v[0], from + v[1], from + v[2], err)) return -1;
        }
    }
    return 0;
}

static fl_vec3 tri_area(const fl_part *p, int32_t t)
{
    const int32_t *v = p->t[t].v;
    return v3_scale(0.5, v3_cross(v3_sub(p->v[v[1]], p->v[v[0]]), v3_sub(p->v[v[2]], p->v[v[0]])));
}

static double signed_volume(const fl_part *p)
{
    double sum = 0.0;
    const fl_vec3 o = p->v[0];
    for (int32_t t = 0; t < p->nt; t++)
        sum += v3_dot(v3_sub(p->v[p->t[t].v[0]], o), tri_area(p, t)) * (2.0 / 6.0);
    return sum;
}

static int check_closed(const fl_part *p, const fl_edges *e, fl_err *err)
{
    int64_t open = 0;
    fl_vec3 a = v3(0, 0, 0), b = a;
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t k = e->first[v], to; k < e->first[v + 1]; k = to) {
            int ups = 0;
            to = fl_edge_end(e, v, k);
            for (int64_t s = k; s < to; s++) ups += e->side[s].up ? 1 : -1;
            if (to - k == 2 && ups == 0) continue;
            if (!open++) a = p->v[v], b = p->v[e->side[k].hi];
        }
    if (!open) return 0;
    return fl_fail(
        err, FL_INPUT,
        "the surface is not closed: %lld edges have not two triangles, the first from (%.6g, %.6g, %.6g) to "
        "(%.6g, %.6g, %.6g): struct-import mends it",
        (long long)open, a.x, a.y, a.z, b.x, b.y, b.z);
}

/* Direction in the plane of triangle t away from its side a b. */
static fl_vec3 from_side(const fl_part *p, int32_t t, int32_t a, int32_t b)
{
    const int32_t *v = p->t[t].v;
    const int32_t c = v[0] != a && v[0] != b ? v[0] : v[1] != a && v[1] != b ? v[1] : v[2];
    const fl_vec3 along = v3_unit(v3_sub(p->v[b], p->v[a])), to = v3_sub(p->v[c], p->v[a]);
    return v3_madd(to, -v3_dot(to, along), along);
}

static int add_edges(fl_pack_region *r, const fl_part *p, const fl_edges *e, const int32_t *wall,
                     const fl_vec3 *inward, uint8_t *sharp, fl_err *err)
{
    for (int32_t v = 0; v < p->nv; v++)
        for (int64_t k = e->first[v]; k < e->first[v + 1]; k += 2) {
            const int32_t h = e->side[k].hi, s = e->side[k].t, t = e->side[k + 1].t;
            const fl_vec3 cross = v3_cross(inward[s], inward[t]);
            const fl_vec3 fs = from_side(p, s, v, h), ft = from_side(p, t, v, h);
            if (v3_norm(cross) < FLAT && v3_dot(inward[s], inward[t]) > 0.0) continue;
            sharp[v] = sharp[h] = 1;
            if (!add_feature(r,
                             (fl_region_feature){.corners = 2,
                                                 .wall = wall[s],
                                                 .p = {p->v[v], p->v[h]},
                                                 .n = v3_add(inward[s], inward[t]),
                                                 .convex = v3_dot(inward[s], ft) > 0.0},
                             err) ||
                add_direction(r, fs, err) || add_direction(r, ft, err))
                return -1;
        }
    return 0;
}

/* Corners with the directions of their edges, and normals weighted with the angles of the triangles. */
static int add_corners(fl_pack_region *r, const fl_part *p, const int32_t *wall, const fl_vec3 *inward,
                       const uint8_t *sharp, fl_err *err)
{
    int32_t *first = fl_alloc((int64_t)p->nv + 2, sizeof *first, err),
            *of = fl_alloc(3 * (int64_t)p->nt, sizeof *of, err);
    int rc = -1;
    if (!first || !of) goto done;
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++) first[p->t[t].v[k] + 2]++;
    for (int32_t v = 0; v < p->nv; v++) first[v + 2] += first[v + 1];
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++) of[first[p->t[t].v[k] + 1]++] = 3 * t + k;
    for (int32_t v = 0; v < p->nv; v++) {
        if (!sharp[v] || first[v] == first[v + 1]) continue;
        fl_region_feature *f = add_feature(
            r, (fl_region_feature){.corners = 1, .wall = wall[of[first[v]] / 3], .p = {p->v[v]}}, err);
        if (!f) goto done;
        fl_vec3 normal = v3(0, 0, 0);
        for (int32_t k = first[v]; k < first[v + 1]; k++) {
            const int32_t t = of[k] / 3, c = of[k] % 3;
            const fl_vec3 a = v3_unit(v3_sub(p->v[p->t[t].v[(c + 1) % 3]], p->v[v])),
                          b = v3_unit(v3_sub(p->v[p->t[t].v[(c + 2) % 3]], p->v[v]));
            normal = v3_madd(normal, atan2(v3_norm(v3_cross(a, b)), v3_dot(a, b)), inward[t]);
            if (add_direction(r, a, err)) goto done;
        }
        r->feature[r->features - 1].n = normal;
    }
    rc = 0;
done:
    free(first), free(of);
    return rc;
}

static int make_surface(fl_pack_region *r, fl_err *err)
{
    fl_part all = {0};
    fl_weld weld;
    fl_edges e = {0};
    int32_t *wall = NULL;
    fl_vec3 *inward = NULL;
    uint8_t *sharp = NULL;
    int rc = -1;
    if (join_parts(r, &all, &wall, err)) goto done;
    const int32_t before = all.nt;
    if (fl_part_weld(&all, 0.0, &weld, err)) goto done;
    if (all.nt != before) {
        fl_fail(err, FL_INPUT, "%d triangles have no area: struct-import mends the surface", before - all.nt);
        goto done;
    }
    if (all.nt == 0) {
        fl_fail(err, FL_INPUT, "the surface has no triangles, a closed one is expected");
        goto done;
    }
    if (fl_edges_make(&e, &all, err) || check_closed(&all, &e, err)) goto done;
    r->volume = signed_volume(&all);
    inward = fl_alloc(all.nt, sizeof *inward, err);
    sharp = fl_alloc(all.nv, sizeof *sharp, err);
    if (!inward || !sharp) goto done;
    const double turn = r->volume < 0.0 ? 1.0 : -1.0;
    for (int32_t t = 0; t < all.nt; t++) {
        const int32_t *v = all.t[t].v;
        inward[t] = v3_scale(turn, v3_unit(tri_area(&all, t)));
        if (!v3_nonzero(inward[t])) {
            fl_fail(err, FL_INPUT,
                    "a triangle at (%.6g, %.6g, %.6g) has no area: struct-import mends the surface",
                    all.v[v[0]].x, all.v[v[0]].y, all.v[v[0]].z);
            goto done;
        }
        if (!add_feature(r,
                         (fl_region_feature){.corners = 3,
                                             .wall = wall[t],
                                             .p = {all.v[v[0]], all.v[v[1]], all.v[v[2]]},
                                             .n = inward[t]},
                         err))
            goto done;
    }
    r->volume = fabs(r->volume);
    if (!(r->volume > 0.0)) {
        fl_fail(err, FL_INPUT, "the surface encloses no volume");
        goto done;
    }
    rc = add_edges(r, &all, &e, wall, inward, sharp, err) || add_corners(r, &all, wall, inward, sharp, err) ||
                 build_tree(r, err)
             ? -1
             : 0;
done:
    fl_edges_free(&e);
    fl_part_free(&all);
    free(wall), free(inward), free(sharp);
    return rc;
}

/* The outer shapes of the bodies of a field as a surface, a part each. */
static int surface_of_bodies(fl_pack_region *r, const fl_ice_field *field, fl_err *err)
{
    for (int32_t k = 0; k < field->n; k++) {
        fl_poly outer = {0};
        char name[32];
        snprintf(name, sizeof name, "body-%d", field->id[k]);
        if (field->core[k].nf == 0)
            return fl_fail(err, FL_INPUT, "body %d has no faces, a polyhedron is expected", field->id[k]);
        if (field->radius[k] > 0.0 ? fl_poly_offset(&outer, &field->core[k], field->radius[k], err)
                                   : fl_poly_copy(&outer, &field->core[k], err))
            return -1;
        const int32_t p = fl_surface_add(&r->surface, name, strlen(name), err);
        int bad = p < 0;
        for (int32_t v = 0; !bad && v < outer.nv; v++)
            bad = fl_surface_vertex(&r->surface.part[p], outer.v[v], err);
        for (int32_t f = 0; !bad && f < outer.nf; f++)
            for (int32_t c = outer.first[f] + 2; !bad && c < outer.first[f + 1]; c++)
                bad = fl_surface_triangle(&r->surface.part[p], outer.loop[outer.first[f]], outer.loop[c - 1],
                                          outer.loop[c], err);
        fl_poly_free(&outer);
        if (bad) return -1;
    }
    return 0;
}

/* --- the argument ------------------------------------------------------------------------------- */

static int numbers_of(const char *text, double *x, int n)
{
    for (int k = 0; k < n; k++) {
        char field[64];
        const size_t len = strcspn(text, ",");
        if (len == 0 || len >= sizeof field || (text[len] == ',') != (k + 1 < n)) return -1;
        memcpy(field, text, len);
        field[len] = '\0';
        if (fl_number_f64(field, &x[k]) || fabs(x[k]) > FL_ICE_FIELD_MAX_COORD) return -1;
        text += len + (text[len] == ',');
    }
    return 0;
}

static int set_periodic(fl_pack_region *r, const char *letters, fl_err *err)
{
    for (; *letters; letters++) {
        const char *at = strchr("xyz", *letters);
        if (*letters == ',') continue;
        if (!at || at - "xyz" >= r->dim)
            return fl_fail(err, FL_USAGE, "--periodic names \"%c\", expected letters of %s", *letters,
                           r->dim == 2 ? "xy" : "xyz");
        r->periodic[at - "xyz"] = 1;
    }
    return 0;
}

static int make_box(fl_pack_region *r, const char *text, const char *periodic, fl_err *err)
{
    static const char *const NAMES[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
    double x[6];
    if (numbers_of(text, x, 6) || !(x[0] < x[3] && x[1] < x[4] && (r->dim == 2 || x[2] < x[5])))
        return fl_fail(
            err, FL_USAGE,
            "--in is \"box:%.60s\", expected box:X0,Y0,Z0,X1,Y1,Z1 with X0 < X1, Y0 < Y1 and Z0 < Z1", text);
    r->kind = FL_REGION_BOX;
    r->lo = v3(x[0], x[1], r->dim == 2 ? 0.0 : x[2]);
    r->hi = v3(x[3], x[4], r->dim == 2 ? 0.0 : x[5]);
    r->volume = (x[3] - x[0]) * (x[4] - x[1]) * (r->dim == 2 ? 1.0 : x[5] - x[2]);
    if (set_periodic(r, periodic, err)) return -1;
    r->inradius = INFINITY;
    for (int k = 0; k < r->dim; k++) {
        if (!r->periodic[k] && (add_wall(r, NAMES[2 * k], err) < 0 || add_wall(r, NAMES[2 * k + 1], err) < 0))
            return -1;
        /* a body across half a period would touch its own image's neighbour twice */
        r->inradius = fmin(r->inradius, (x[k + 3] - x[k]) * (r->periodic[k] ? 0.25 : 0.5));
    }
    return 0;
}

static int make_cylinder(fl_pack_region *r, const char *text, fl_err *err)
{
    double x[5];
    if (numbers_of(text, x, 5) || !(x[0] > 0.0 && x[1] < x[2]))
        return fl_fail(err, FL_USAGE,
                       "--in is \"cylinder:%.60s\", expected cylinder:R,Z0,Z1,X,Y with R > 0 and Z0 < Z1",
                       text);
    r->kind = FL_REGION_CYLINDER;
    r->radius = x[0];
    r->centre = v3(x[3], x[4], 0.0);
    r->lo = v3(x[3] - x[0], x[4] - x[0], r->dim == 2 ? 0.0 : x[1]);
    r->hi = v3(x[3] + x[0], x[4] + x[0], r->dim == 2 ? 0.0 : x[2]);
    r->volume = PI * x[0] * x[0] * (r->dim == 2 ? 1.0 : x[2] - x[1]);
    r->inradius = r->dim == 2 ? x[0] : fmin(x[0], 0.5 * (x[2] - x[1]));
    if (add_wall(r, "side", err) < 0) return -1;
    return r->dim == 3 && (add_wall(r, "bottom", err) < 0 || add_wall(r, "top", err) < 0) ? -1 : 0;
}

static int make_sphere(fl_pack_region *r, const char *text, fl_err *err)
{
    double x[4];
    if (numbers_of(text, x, 4) || !(x[0] > 0.0))
        return fl_fail(err, FL_USAGE, "--in is \"sphere:%.60s\", expected sphere:R,X,Y,Z with R > 0", text);
    r->kind = FL_REGION_SPHERE;
    r->radius = r->inradius = x[0];
    r->centre = v3(x[1], x[2], r->dim == 2 ? 0.0 : x[3]);
    const fl_vec3 half = v3(x[0], x[0], r->dim == 2 ? 0.0 : x[0]);
    r->lo = v3_sub(r->centre, half);
    r->hi = v3_add(r->centre, half);
    r->volume = r->dim == 2 ? PI * x[0] * x[0] : 4.0 / 3.0 * PI * x[0] * x[0] * x[0];
    return add_wall(r, "side", err) < 0 ? -1 : 0;
}

/* True if the first line of a file names the kind g-polys. */
static int is_g_polys(const char *path)
{
    char head[16] = "";
    fl_err none = {0};
    fl_in *in = fl_in_open(path, &none);
    if (!in) return 0;
    const int64_t n = fl_in_read(in, head, sizeof head - 1, &none);
    fl_in_close(in);
    return n > 8 && strncmp(head, "#g-polys", 8) == 0;
}

static int make_from_file(fl_pack_region *r, const char *path, fl_err *err)
{
    char note[FL_MESH_NOTE];
    fl_err why = {0};
    r->kind = FL_REGION_FEATURES;
    if (strcmp(path, "-") == 0) return fl_fail(err, FL_USAGE, "--in is -, the name of a file is expected");
    if (r->dim == 2) {
        if (make_outline(r, path, err)) return -1;
    } else if (is_g_polys(path)) {
        fl_ice_field field = {0};
        if (fl_ice_field_read(&field, path, err)) return -1;
        const int bad = surface_of_bodies(r, &field, &why) || make_surface(r, &why);
        fl_ice_field_free(&field);
        if (bad) return fl_fail(err, why.code, "%s: %s", path, why.text);
    } else {
        if (fl_mesh_read(&r->surface, path, NULL, note, err)) return -1;
        if (make_surface(r, &why)) return fl_fail(err, why.code, "%s: %s", path, why.text);
    }
    find_inradius(r);
    return 0;
}

int fl_region_make(fl_pack_region *r, const char *in, int dim, const char *periodic, fl_err *err)
{
    int rc;
    *r = (fl_pack_region){.dim = dim};
    const int is_box = strncmp(in, "box:", 4) == 0;
    if (*periodic && !is_box) rc = fl_fail(err, FL_USAGE, "--periodic needs --in box:...");
    else if (is_box) rc = make_box(r, in + 4, periodic, err);
    else if (strncmp(in, "cylinder:", 9) == 0) rc = make_cylinder(r, in + 9, err);
    else if (strncmp(in, "sphere:", 7) == 0) rc = make_sphere(r, in + 7, err);
    else rc = make_from_file(r, in, err);
    if (rc) fl_region_free(r);
    return rc;
}
