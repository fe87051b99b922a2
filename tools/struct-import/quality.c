/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "quality.h"

static const double LARGEST = 1000.0, SMALLEST = 0.01; /* [m] sides of a box that are likely another unit */
static const double ROUNDING = 1e-12;                  /* of the diagonal: thousands of roundings of 1e-16 */

/* A coordinate of the centroid, without the rounding left where the parts of a symmetric body cancel. */
static double shown(double x, const fl_aabb *b)
{
    return fabs(x) > ROUNDING * v3_norm(v3_sub(b->hi, b->lo)) ? x : 0.0;
}

static void shape_row(const char *name, int width, const fl_quality *q)
{
    char volume[40] = "-";
    if (q->closed) snprintf(volume, sizeof volume, "%.9g", q->volume);
    fprintf(stderr, "%-*s %9d %5d %13s %13.9g   %.6g %.6g %.6g   %.6g %.6g %.6g .. %.6g %.6g %.6g\n", width,
            name, q->triangles, q->cones, volume, q->area, shown(q->centroid.x, &q->box),
            shown(q->centroid.y, &q->box), shown(q->centroid.z, &q->box), q->box.lo.x, q->box.lo.y,
            q->box.lo.z, q->box.hi.x, q->box.hi.y, q->box.hi.z);
}

static void mesh_row(const char *name, int width, const struct mended *m)
{
    const fl_quality *q = &m->left;
    fprintf(stderr, "%-*s %7d %10d %9d %7d %7d %7d %5d %12d %7d %10d %8d\n", width, name, m->weld.merged,
            m->weld.collapsed + m->repair.degenerate, m->repair.duplicates, m->orient.patches,
            m->orient.triangles, q->patches, q->open, q->branched, q->incoherent, q->degenerate,
            m->repair.crossings);
}

static void add(struct mended *sum, const struct mended *m)
{
    sum->weld.merged += m->weld.merged;
    sum->weld.collapsed += m->weld.collapsed;
    sum->repair.degenerate += m->repair.degenerate;
    sum->repair.duplicates += m->repair.duplicates;
    sum->repair.crossings += m->repair.crossings;
    sum->orient.patches += m->orient.patches;
    sum->orient.triangles += m->orient.triangles;
}

static void details(const fl_part *p, const struct mended *m)
{
    const char *name = p->name;
    if (p->nt == 0) return;
    fprintf(stderr, "%s: welded within %.3g m, vertices moved by up to %.3g m, %d unused\n", name,
            m->weld.tol, m->weld.moved, m->weld.unused);
    if (m->repair.stitched) fprintf(stderr, "%s: %d pairs of rim edges stitched\n", name, m->repair.stitched);
    if (m->repair.holes)
        fprintf(stderr, "%s: %d holes closed by %d triangles\n", name, m->repair.holes, m->repair.patched);
    if (m->repair.bounding && m->left.inverted)
        fprintf(stderr, "%s: %d patches bound cavities and look inward\n", name, m->left.inverted);
}

static void warn(const char *name, const struct mended *m)
{
    const int32_t twisted = m->orient.twisted, rimmed = m->orient.rimmed;
    if (rimmed && m->left.open)
        fprintf(stderr,
                "struct-import: warning: %s: open patches have no outside, they keep the side that most of "
                "their area had\n",
                name);
    if (twisted)
        fprintf(stderr, "struct-import: warning: %s: %d patches have one side only and cannot be oriented\n",
                name, twisted);
    if (m->left.degenerate)
        fprintf(stderr, "struct-import: warning: %s: %d triangles without area are left\n", name,
                m->left.degenerate);
}

static void warn_size(const struct options *o, fl_aabb box)
{
    const fl_vec3 side = v3_sub(box.hi, box.lo);
    const double largest = fmax(side.x, fmax(side.y, side.z));
    if (largest <= LARGEST && largest >= SMALLEST) return;
    fprintf(stderr, "struct-import: warning: the bounding box is %.6g x %.6g x %.6g m; %s\n", side.x, side.y,
            side.z,
            o->unit ? "is the unit right?" : "the unit is unknown and was taken as m, --unit sets it");
}

int report(const struct options *o, const fl_surface *s, const struct mended *m, fl_err *err)
{
    struct mended sum = {0};
    int width = 5; /* of "total" */
    if (fl_surface_measure(s, &sum.left, err)) return -1;
    if (o->quiet) return 0;
    for (int32_t i = 0; i < s->n; i++)
        if ((int)strlen(s->part[i].name) > width) width = (int)strlen(s->part[i].name);
    fprintf(stderr, "%-*s %9s %5s %13s %13s   %s   %s\n", width, "part", "triangles", "cones", "volume[m3]",
            "area[m2]", "centroid[m]", "box[m]");
    for (int32_t i = 0; i < s->n; i++) shape_row(s->part[i].name, width, &m[i].left);
    if (s->n > 1) shape_row("total", width, &sum.left);
    fprintf(stderr, "\n%-*s %7s %10s %9s %7s %7s %7s %5s %12s %7s %10s %8s\n", width, "part", "welded",
            "degenerate", "duplicate", "flipped", "turned", "patches", "open", "non-manifold", "twisted",
            "slivers", "crossing");
    for (int32_t i = 0; i < s->n; i++) {
        mesh_row(s->part[i].name, width, &m[i]);
        add(&sum, &m[i]);
    }
    if (s->n > 1) mesh_row("total", width, &sum);
    for (int32_t i = 0; i < s->n; i++) {
        if (o->verbose) details(&s->part[i], &m[i]);
        warn(s->part[i].name, &m[i]);
    }
    warn_size(o, sum.left.box);
    return 0;
}
