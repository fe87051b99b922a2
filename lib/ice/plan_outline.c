/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/plan_outline.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"

/* --- sections --------------------------------------------------------------------------------------------
 * */

/* An edge of the mesh that a level crosses, by its vertices in ascending order. */
struct edge {
    int32_t a, b;
};

/* The section of one triangle: from one edge to another, with the inside of the body on its left. */
struct segment {
    struct edge from, to;
};

static int compare_edges(struct edge a, struct edge b)
{
    const int first = (a.a > b.a) - (a.a < b.a);
    return first ? first : (a.b > b.b) - (a.b < b.b);
}

static int compare_segments(const void *a, const void *b)
{
    return compare_edges(((const struct segment *)a)->from, ((const struct segment *)b)->from);
}

static struct edge edge_between(int32_t a, int32_t b)
{
    return a < b ? (struct edge){a, b} : (struct edge){b, a};
}

/* The section of a triangle; 0 if the level does not cross it.  Vertices at the level count as above it. */
static int cross_triangle(const fl_part *p, int32_t t, double z, struct segment *s)
{
    const int32_t *const v = p->t[t].v;
    const int up[3] = {p->v[v[0]].z >= z, p->v[v[1]].z >= z, p->v[v[2]].z >= z};
    const int above = up[0] + up[1] + up[2];
    if (above == 0 || above == 3) return 0;
    int alone = 0; /* the corner on a side of its own */
    while (up[alone] != (above == 1)) alone++;
    const int32_t a = v[alone], b = v[(alone + 1) % 3], c = v[(alone + 2) % 3];
    *s = above == 1 ? (struct segment){edge_between(a, b), edge_between(c, a)}
                    : (struct segment){edge_between(c, a), edge_between(a, b)};
    return 1;
}

static fl_vec2 crossing(const fl_part *p, struct edge e, double z)
{
    const fl_vec3 a = p->v[e.a], b = p->v[e.b], at = v3_lerp(a, b, (z - a.z) / (b.z - a.z));
    return (fl_vec2){at.x, at.y};
}

/* The segment that begins where another ends; -1: none. */
static int32_t follow(int32_t n, const struct segment *s, struct edge at)
{
    int32_t lo = 0, hi = n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (compare_edges(s[mid].from, at) < 0) lo = mid + 1;
        else hi = mid;
    }
    return lo < n && compare_edges(s[lo].from, at) == 0 ? lo : -1;
}

/* The one outer loop of the section at z, at most m corners; 0 if it is open, absent or not alone. */
static int32_t find_loop(const fl_part *p, int32_t m, const int32_t *tri, double z, struct segment *s,
                         char *used, fl_vec2 *loop, fl_vec2 *v)
{
    int32_t n = 0, count = 0;
    for (int32_t k = 0; k < m; k++)
        if (cross_triangle(p, tri[k], z, &s[n])) n++;
    qsort(s, (size_t)n, sizeof *s, compare_segments);
    for (int32_t k = 0; k < n; k++) used[k] = 0;
    for (int32_t k = 0; k < n; k++) {
        int32_t corners = 0, at = k;
        if (used[k]) continue;
        for (; at >= 0 && !used[at]; at = follow(n, s, s[at].to)) {
            used[at] = 1;
            v[corners++] = crossing(p, s[at].from, z);
        }
        if (at != k) return 0;
        if (corners < 3 || !(fl_polygon_area(corners, v) > 0.0)) continue;
        if (count) return 0;
        for (count = 0; count < corners; count++) loop[count] = v[count];
    }
    return count;
}

/* --- fewer sides -----------------------------------------------------------------------------------------
 * */

/* Twice the area of the triangle, positive where the way a, b, c turns left. */
static double cross_at(fl_vec2 a, fl_vec2 b, fl_vec2 c)
{
    return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

/* Distance of q from the line through a and b. */
static double off_line(fl_vec2 a, fl_vec2 b, fl_vec2 q)
{
    const double l = hypot(b.x - a.x, b.y - a.y);
    return l > 0.0 ? fabs(cross_at(a, b, q)) / l : hypot(q.x - a.x, q.y - a.y);
}

/* Where a side can be dropped: the lines a b and d c meet beyond b c. */
static int meet_beyond(fl_vec2 a, fl_vec2 b, fl_vec2 c, fl_vec2 d, fl_vec2 *at)
{
    const double ux = b.x - a.x, uy = b.y - a.y, wx = c.x - d.x, wy = c.y - d.y, s = ux * wy - uy * wx;
    if (!(fabs(s) > 1e-9 * hypot(ux, uy) * hypot(wx, wy))) return 0;
    const double t = ((c.x - b.x) * wy - (c.y - b.y) * wx) / s, r = ((c.x - b.x) * uy - (c.y - b.y) * ux) / s;
    *at = (fl_vec2){b.x + t * ux, b.y + t * uy};
    return t >= 0.0 && r >= 0.0;
}

/* The ring v[n] with fewer sides, none moved inward; its number of corners. */
static int32_t reduce_ring(int32_t n, fl_vec2 *v, double coarse)
{
    while (n > 4) {
        double least = coarse;
        int32_t at = -1;
        int is_side = 0;
        fl_vec2 corner = {0};
        for (int32_t k = 0; k < n; k++) {
            const fl_vec2 a = v[k], b = v[(k + 1) % n], c = v[(k + 2) % n], d = v[(k + 3) % n];
            fl_vec2 meet;
            if (!(cross_at(a, b, c) > 0.0)) { /* turns inward, or not at all */
                const double depth = off_line(a, c, b);
                if (depth < least) least = depth, at = (k + 1) % n, is_side = 0;
            } else if (cross_at(b, c, d) > 0.0 && meet_beyond(a, b, c, d, &meet)) {
                const double depth = off_line(b, c, meet);
                if (depth < least) least = depth, at = (k + 1) % n, is_side = 1, corner = meet;
            }
        }
        if (at < 0) break;
        if (is_side) { /* the corner takes the place of both ends */
            v[at] = corner;
            at = (at + 1) % n;
        }
        n--;
        for (int32_t k = at; k < n; k++) v[k] = v[k + 1];
    }
    return n;
}

/* Every side moved outward by r; 0 if neighbours do not meet, or only far away. */
static int move_outward(int32_t n, const fl_vec2 *v, double r, fl_vec2 *out)
{
    for (int32_t k = 0; k < n; k++) out[k] = v[k];
    for (int32_t k = 0; k < n && r > 0.0; k++) {
        const fl_vec2 a = v[(k + n - 1) % n], b = v[k], c = v[(k + 1) % n];
        const double l = hypot(b.x - a.x, b.y - a.y), m = hypot(c.x - b.x, c.y - b.y);
        const double px = (b.y - a.y) / l, py = (a.x - b.x) / l, qx = (c.y - b.y) / m, qy = (b.x - c.x) / m;
        const double share = r / (1.0 + px * qx + py * qy);
        if (!(l > 0.0 && m > 0.0 && share < 20.0 * r)) return 0;
        out[k] = (fl_vec2){b.x + share * (px + qx), b.y + share * (py + qy)};
    }
    return 1;
}

/* --- what leans out of the section -----------------------------------------------------------------------
 * */

/* Distance of q from the filled ring, 0 inside. */
static double outside_by(int32_t n, const fl_vec2 *v, fl_vec2 q)
{
    double least = INFINITY;
    int inside = 0;
    for (int32_t k = 0; k < n; k++) {
        const fl_vec2 a = v[k], b = v[(k + 1) % n];
        const double dx = b.x - a.x, dy = b.y - a.y, l2 = dx * dx + dy * dy;
        const double t = l2 > 0.0 ? fmin(1.0, fmax(0.0, ((q.x - a.x) * dx + (q.y - a.y) * dy) / l2)) : 0.0;
        least = fmin(least, hypot(q.x - a.x - t * dx, q.y - a.y - t * dy));
        if ((a.y <= q.y) != (b.y <= q.y) && (q.x < a.x + (q.y - a.y) / dy * dx)) inside = !inside;
    }
    return inside ? 0.0 : least;
}

/* The farthest of all points of edges between the levels from the ring. */
static double find_lean(const fl_part *p, int32_t m, const int32_t *tri, double z0, double z1, int32_t n,
                        const fl_vec2 *ring)
{
    double far = 0.0;
    for (int32_t k = 0; k < m; k++)
        for (int e = 0; e < 3; e++) {
            fl_vec3 a = p->v[p->t[tri[k]].v[e]], b = p->v[p->t[tri[k]].v[(e + 1) % 3]];
            const double level[2] = {z0, z1};
            if (a.z >= z0 && a.z <= z1) far = fmax(far, outside_by(n, ring, (fl_vec2){a.x, a.y}));
            for (int i = 0; i < 2; i++)
                if ((a.z < level[i]) != (b.z < level[i])) {
                    const fl_vec3 at = v3_lerp(a, b, (level[i] - a.z) / (b.z - a.z));
                    far = fmax(far, outside_by(n, ring, (fl_vec2){at.x, at.y}));
                }
        }
    return far;
}

int fl_plan_outline_add(fl_domain *d, const fl_part *p, int32_t n, const int32_t *tri, double z0, double z1,
                        double margin, double coarse, int *made, fl_err *err)
{
    struct segment *s = fl_alloc(n, sizeof *s, err);
    char *used = fl_alloc(n, 1, err);
    fl_vec2 *v = fl_alloc(n, sizeof *v, err), *loop = fl_alloc(n, sizeof *loop, err),
            *best = fl_alloc(n, sizeof *best, err);
    double area = 0.0;
    int32_t m = 0;
    int rc = -1;
    *made = 0;
    if (!s || !used || !v || !loop || !best) goto done;
    rc = 0;
    for (int k = 0; k < FL_PLAN_LEVELS; k++) {
        const double z = z0 + (z1 - z0) * (k + 0.01) / (FL_PLAN_LEVELS - 0.98);
        const int32_t count = find_loop(p, n, tri, z, s, used, loop, v);
        const double size = count ? fl_polygon_area(count, loop) : 0.0;
        if (!(size > area)) continue;
        area = size, m = count;
        for (int32_t i = 0; i < count; i++) best[i] = loop[i];
    }
    m = reduce_ring(m, best, coarse);
    if (m < 3) goto done;
    const double lean = find_lean(p, n, tri, z0, z1, m, best);
    if (lean > coarse || !move_outward(m, best, margin + lean, loop)) goto done;
    fl_err why = {0};
    if (fl_domain_add(d, m, loop, &why) == 0) *made = 1;
    else if (why.code != FL_INPUT) rc = fl_fail(err, why.code, "%s", why.text);
done:
    free(s);
    free(used);
    free(v);
    free(loop);
    free(best);
    return rc;
}
