/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/pack_region.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/text.h"

/* --- boxes, cylinders, spheres ------------------------------------------------------------------ */

static void add_contact(fl_region_contact *out, int *n, double gap, fl_vec3 normal, int32_t wall,
                        double reach)
{
    if (gap < reach && *n < FL_REGION_CONTACTS) out[(*n)++] = (fl_region_contact){gap, normal, wall, -1};
}

static int box_contacts(const fl_pack_region *r, fl_vec3 x, double reach, fl_region_contact *out)
{
    const double at[3] = {x.x, x.y, x.z}, lo[3] = {r->lo.x, r->lo.y, r->lo.z},
                 hi[3] = {r->hi.x, r->hi.y, r->hi.z};
    int n = 0;
    for (int k = 0, wall = 0; k < r->dim; k++) {
        const fl_vec3 e = v3(k == 0, k == 1, k == 2);
        if (r->periodic[k]) continue;
        add_contact(out, &n, at[k] - lo[k], e, wall++, reach);
        add_contact(out, &n, hi[k] - at[k], v3_neg(e), wall++, reach);
    }
    return n;
}

static int cylinder_contacts(const fl_pack_region *r, fl_vec3 x, double reach, fl_region_contact *out)
{
    const fl_vec3 d = v3(x.x - r->centre.x, x.y - r->centre.y, 0.0);
    const double rho = v3_norm(d);
    int n = 0;
    add_contact(out, &n, r->radius - rho, rho > 0.0 ? v3_scale(-1.0 / rho, d) : v3(1, 0, 0), 0, reach);
    if (r->dim == 2) return n;
    add_contact(out, &n, x.z - r->lo.z, v3(0, 0, 1), 1, reach);
    add_contact(out, &n, r->hi.z - x.z, v3(0, 0, -1), 2, reach);
    return n;
}

static int sphere_contacts(const fl_pack_region *r, fl_vec3 x, double reach, fl_region_contact *out)
{
    const fl_vec3 d = v3_sub(x, r->centre);
    const double rho = v3_norm(d);
    int n = 0;
    add_contact(out, &n, r->radius - rho, rho > 0.0 ? v3_scale(-1.0 / rho, d) : v3(1, 0, 0), 0, reach);
    return n;
}

/* --- features ----------------------------------------------------------------------------------- */

/* Foot of x on a feature, if the distance has a local minimum there; d = x - foot. */
static int local_minimum(const fl_pack_region *r, const fl_region_feature *f, fl_vec3 x, fl_vec3 *d)
{
    const fl_vec3 *p = f->p, way = v3_sub(x, p[0]);
    if (f->corners == 3) { /* a triangle: the foot lies inside, by areas */
        const fl_vec3 a = v3_sub(p[1], p[0]), b = v3_sub(p[2], p[0]), n = v3_cross(a, b);
        const double all = v3_norm2(n), u = v3_dot(v3_cross(way, b), n), v = v3_dot(v3_cross(a, way), n);
        if (u < 0.0 || v < 0.0 || u + v > all) return 0;
        *d = v3_scale(v3_dot(way, f->n), f->n);
        return 1;
    }
    if (f->corners == 2) {
        const fl_vec3 a = v3_sub(p[1], p[0]);
        const double t = v3_dot(way, a) / v3_norm2(a);
        if (t < 0.0 || t > 1.0) return 0;
        *d = v3_madd(way, -t, a);
    } else {
        *d = way;
    }
    for (int32_t k = 0; k < f->outs; k++)
        if (v3_dot(*d, r->out[f->out + k]) > 0.0) return 0;
    return 1;
}

/* Signed distance of x from feature f in *gap, 0 where it has no local minimum. */
static int feature_gap(const fl_pack_region *r, int32_t k, fl_vec3 x, fl_region_contact *c)
{
    const fl_region_feature *f = &r->feature[k];
    fl_vec3 d;
    if (!local_minimum(r, f, x, &d)) return 0;
    const double length = v3_norm(d), side = v3_dot(d, f->n);
    const double sign = side >= 0.0 ? 1.0 : -1.0;
    *c = (fl_region_contact){sign * length, length > 0.0 ? v3_scale(sign / length, d) : v3_unit(f->n),
                             f->wall, k};
    return 1;
}

/* The nearest feature within reach. */
static int nearest_feature(const fl_pack_region *r, fl_vec3 x, double reach, fl_region_contact *nearest)
{
    fl_bvh_walk walk = fl_bvh_walk_from(&r->tree, r->box, x);
    int found = 0;
    for (int32_t k; (k = fl_bvh_walk_next(&walk, reach)) >= 0;) {
        fl_region_contact c;
        if (!feature_gap(r, k, x, &c)) continue;
        const double d = fabs(c.gap);
        if (d > reach || (found && d == fabs(nearest->gap) && k > nearest->feature)) continue;
        *nearest = c;
        reach = d;
        found = 1;
    }
    return found;
}

static int by_feature(const void *a, const void *b)
{
    const fl_region_contact *p = a, *q = b;
    return (p->feature > q->feature) - (p->feature < q->feature);
}

static int feature_contacts(const fl_pack_region *r, fl_vec3 x, double reach, fl_region_contact *out)
{
    fl_bvh_walk walk = fl_bvh_walk_from(&r->tree, r->box, x);
    fl_region_contact nearest = {.gap = INFINITY};
    int n = 0;
    for (int32_t k; (k = fl_bvh_walk_next(&walk, reach)) >= 0;) {
        fl_region_contact c;
        if (!feature_gap(r, k, x, &c) || fabs(c.gap) >= reach) continue;
        const double d = fabs(c.gap), least = fabs(nearest.gap);
        if (d < least || (d == least && k < nearest.feature)) nearest = c;
        if (c.gap >= 0.0 && n < FL_REGION_CONTACTS) out[n++] = c;
    }
    if (nearest.gap < 0.0) { /* outside: only the way back counts */
        out[0] = nearest;
        return 1;
    }
    qsort(out, (size_t)n, sizeof *out, by_feature);
    return n;
}

int fl_region_contacts(const fl_pack_region *r, fl_vec3 x, double reach,
                       fl_region_contact out[FL_REGION_CONTACTS])
{
    switch (r->kind) {
    case FL_REGION_BOX: return box_contacts(r, x, reach, out);
    case FL_REGION_CYLINDER: return cylinder_contacts(r, x, reach, out);
    case FL_REGION_SPHERE: return sphere_contacts(r, x, reach, out);
    default: return feature_contacts(r, x, reach, out);
    }
}

int fl_region_way_back(const fl_pack_region *r, fl_vec3 x, double depth, fl_region_contact *out)
{
    return r->kind == FL_REGION_FEATURES && nearest_feature(r, x, depth, out) && out->gap < 0.0;
}

double fl_region_distance(const fl_pack_region *r, fl_vec3 x, double reach)
{
    fl_region_contact c[FL_REGION_CONTACTS];
    double gap = INFINITY;
    if (r->kind == FL_REGION_FEATURES) return nearest_feature(r, x, reach, c) ? c->gap : INFINITY;
    const int n = fl_region_contacts(r, x, INFINITY, c);
    for (int k = 0; k < n; k++) gap = fmin(gap, c[k].gap);
    return gap;
}

int fl_region_is_periodic(const fl_pack_region *r)
{
    return r->periodic[0] | r->periodic[1] | r->periodic[2];
}

static double wrap_one(double x, double length) { return x - length * floor(x / length + 0.5); }

fl_vec3 fl_region_wrap(const fl_pack_region *r, fl_vec3 d)
{
    if (r->periodic[0]) d.x = wrap_one(d.x, r->hi.x - r->lo.x);
    if (r->periodic[1]) d.y = wrap_one(d.y, r->hi.y - r->lo.y);
    if (r->periodic[2]) d.z = wrap_one(d.z, r->hi.z - r->lo.z);
    return d;
}

static double into_cell(double x, double lo, double hi)
{
    x -= (hi - lo) * floor((x - lo) / (hi - lo));
    return x < hi ? x : lo;
}

fl_vec3 fl_region_wrap_point(const fl_pack_region *r, fl_vec3 x)
{
    if (r->periodic[0]) x.x = into_cell(x.x, r->lo.x, r->hi.x);
    if (r->periodic[1]) x.y = into_cell(x.y, r->lo.y, r->hi.y);
    if (r->periodic[2]) x.z = into_cell(x.z, r->lo.z, r->hi.z);
    return x;
}

int fl_region_set_helpers(fl_pack_region *r, const char *names, fl_err *err)
{
    while (*names) {
        const size_t len = strcspn(names, ",");
        const int all = len == 3 && strncmp(names, "all", 3) == 0;
        int found = 0;
        for (int32_t k = 0; k < r->walls; k++)
            if (all || (strlen(r->wall[k].name) == len && strncmp(r->wall[k].name, names, len) == 0))
                r->wall[k].helper = found = 1;
        if (!found) {
            char word[64];
            const char *list[512];
            const int n = r->walls < 512 ? r->walls : 512;
            for (int k = 0; k < n; k++) list[k] = r->wall[k].name;
            snprintf(word, sizeof word, "%.*s", (int)(len < 60 ? len : 60), names);
            const char *near = fl_text_nearest(word, list, n);
            return fl_fail(err, FL_USAGE,
                           "--helper names the wall \"%s\", which is not there; the nearest is \"%s\"", word,
                           near ? near : "");
        }
        names += len;
        if (*names == ',') names++;
    }
    return 0;
}

void fl_region_free(fl_pack_region *r)
{
    free(r->wall), free(r->feature), free(r->out), free(r->box);
    fl_bvh_free(&r->tree);
    fl_surface_free(&r->surface);
    fl_domain_free(&r->domain);
    *r = (fl_pack_region){0};
}
