/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <string.h>
#include "quality_report.h"

static const double LARGEST = 1000.0, SMALLEST = 0.01; /* [m] sizes of a box that suggest a wrong unit */
static const double LARGE_CHANGE = 0.01; /* relative change of area or volume of a rebuilt patch */
static const double COARSE = 1e-5;    /* of the diagonal: rounding of coordinates that is worth a warning */
static const double ROUNDING = 1e-12; /* of the diagonal: thousands of roundings of 1e-16 */

/* A coordinate of the centroid; rounding errors of a symmetric body are set to 0. */
static double without_rounding(double x, const fl_aabb *b)
{
    return fabs(x) > ROUNDING * v3_norm(v3_sub(b->hi, b->lo)) ? x : 0.0;
}

/* Digits of coordinates: six of the size of the box, and those that its distance from the origin takes. */
static int digits_of(const fl_aabb *b)
{
    const fl_vec3 side = v3_sub(b->hi, b->lo);
    const double size = fmax(side.x, fmax(side.y, side.z));
    const double far = fmax(fmax(fmax(fabs(b->lo.x), fabs(b->hi.x)), fmax(fabs(b->lo.y), fabs(b->hi.y))),
                            fmax(fabs(b->lo.z), fabs(b->hi.z)));
    if (!(size > 0.0) || !(far > 100.0 * size)) return 6;
    return (int)fmin(15.0, 6.0 + ceil(log10(far / size)));
}

static void print_shape(const char *name, int width, const fl_mesh_quality *q)
{
    const int n = digits_of(&q->box);
    char volume[40] = "-";
    if (q->closed) snprintf(volume, sizeof volume, "%.9g", q->volume);
    fprintf(stderr, "%-*s %9d %5d %13s %13.9g   %.*g %.*g %.*g   %.*g %.*g %.*g .. %.*g %.*g %.*g\n", width,
            name, q->triangles, q->cones, volume, q->area, n, without_rounding(q->centroid.x, &q->box), n,
            without_rounding(q->centroid.y, &q->box), n, without_rounding(q->centroid.z, &q->box), n,
            q->box.lo.x, n, q->box.lo.y, n, q->box.lo.z, n, q->box.hi.x, n, q->box.hi.y, n, q->box.hi.z);
}

static void print_mesh(const char *name, int width, const struct cleanup *m)
{
    const fl_mesh_quality *q = &m->quality;
    fprintf(stderr, "%-*s %7d %10d %9d %7d %7d %7d %5d %12d %7d %7d %8d %8d\n", width, name, m->weld.merged,
            m->weld.collapsed + m->repair.degenerate, m->duplicates + m->repair.duplicates, m->orient.patches,
            m->orient.triangles, q->patches, q->open, q->branched, q->incoherent, q->degenerate,
            m->crossing.crossings, m->crossing.touching);
}

static void add_counts(struct cleanup *sum, const struct cleanup *m)
{
    sum->weld.merged += m->weld.merged;
    sum->weld.collapsed += m->weld.collapsed;
    sum->repair.degenerate += m->repair.degenerate;
    sum->duplicates += m->duplicates;
    sum->repair.duplicates += m->repair.duplicates;
    sum->crossing.crossings += m->crossing.crossings;
    sum->crossing.touching += m->crossing.touching;
    sum->orient.patches += m->orient.patches;
    sum->orient.triangles += m->orient.triangles;
}

/* Print the relative change of a magnitude; the sign is ignored, since a body may have been inside out. */
static void put_change(int width, double before, double after)
{
    if (before == 0.0) fprintf(stderr, " %*s", width, after == 0.0 ? "0" : "-");
    else fprintf(stderr, " %*.3g", width, (fabs(after) - fabs(before)) / fabs(before));
}

/* Largest change of an element of the inertia tensor, relative to its largest element. */
static double inertia_change(const fl_moments *before, const fl_moments *after)
{
    const double turn = before->volume * after->volume < 0.0 ? -1.0 : 1.0;
    double most = 0.0, size = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            most = fmax(most, fabs(turn * after->inertia.m[i][j] - before->inertia.m[i][j]));
            size = fmax(size, fabs(before->inertia.m[i][j]));
        }
    return size > 0.0 ? most / size : 0.0;
}

static void print_changes(const char *name, int width, const struct cleanup *m)
{
    const int solid = m->was_closed && m->quality.closed && m->before.volume != 0.0;
    fprintf(stderr, "%-*s %9d %9d %6d %6d %7d", width, name, m->triangles_before, m->quality.triangles,
            m->repair.holes, m->untangle.joined, m->untangle.rebuilt);
    if (solid) {
        put_change(10, m->before.volume, m->after.volume);
        put_change(10, m->before.area, m->after.area);
        fprintf(stderr, " %10.3g %11.3g", v3_norm(v3_sub(m->after.centroid, m->before.centroid)),
                inertia_change(&m->before, &m->after));
    } else {
        fprintf(stderr, " %10s", "-");
        put_change(10, m->before.area, m->after.area);
        fprintf(stderr, " %10s %11s", "-", "-");
    }
    fprintf(stderr, " %9.3g %9.3g\n", m->deviation, m->source_deviation);
}

static void print_details(const fl_part *p, const struct cleanup *m)
{
    const char *name = p->name;
    if (p->nt == 0) return;
    fprintf(stderr, "%s: welded within %.3g m, vertices moved by up to %.3g m, %d unused\n", name,
            m->weld.tol, m->weld.moved, m->weld.unused);
    if (m->repair.stitched) fprintf(stderr, "%s: %d pairs of rim edges stitched\n", name, m->repair.stitched);
    if (m->repair.holes)
        fprintf(stderr, "%s: %d holes closed by %d triangles\n", name, m->repair.holes, m->repair.patched);
    if (m->walls) fprintf(stderr, "%s: %d triangles of inner walls dropped\n", name, m->walls);
    if (m->simplified) fprintf(stderr, "%s: %d triangles fewer\n", name, m->simplified);
    if (m->repair.bounding && m->quality.inverted)
        fprintf(stderr, "%s: %d patches bound cavities and face inward\n", name, m->quality.inverted);
}

static void print_warnings(const char *name, const struct cleanup *m)
{
    const int32_t twisted = m->orient.one_sided, rimmed = m->orient.kept_side;
    if (rimmed && m->quality.open && !m->closes_jointly)
        fprintf(stderr,
                "struct-import: warning: %s: open patches have no outside: except for flat convex ones, ice "
                "meets them on one side only, the side of most of their area\n",
                name);
    if (m->rim.rims && !m->closes_jointly &&
        fabs(m->rim.top) <= FL_DECK_FLAT * v3_norm(v3_sub(m->quality.box.hi, m->quality.box.lo)))
        fprintf(
            stderr,
            "struct-import: warning: %s: open at z = 0 along %d edges: ice goes in over the rim; --deck H "
            "closes it\n",
            name, m->rim.edges);
    if (m->fins)
        fprintf(stderr,
                "struct-import: warning: %s: %d triangles of two-sided plates that stand on others were "
                "skipped: ice meets such a plate only as a part of its own\n",
                name, m->fins);
    if (m->contact_walls)
        fprintf(
            stderr,
            "struct-import: %s: %d triangles between bodies that stand against each other were dropped: the "
            "bodies count as one\n",
            name, m->contact_walls);
    if (m->sheets)
        fprintf(
            stderr,
            "struct-import: warning: %s: %d triangles of two-sided plates beside closed bodies were skipped: "
            "ice meets such a plate only as a part of its own\n",
            name, m->sheets);
    if (m->lost)
        fprintf(stderr,
                "struct-import: warning: %s: the repaired surface encloses %.6g m3, the bodies that it came "
                "from %.6g m3 (overlaps counted once); %d bodies differ\n",
                name, m->volume.result, m->volume.source, m->volume.bodies);
    if (m->rounding > COARSE * v3_norm(v3_sub(m->quality.box.hi, m->quality.box.lo)))
        fprintf(
            stderr,
            "struct-import: warning: %s: coordinates are rounded to single precision, which moves them by up "
            "to %.3g m\n",
            name, m->rounding);
    if (m->untangle.failed)
        fprintf(stderr, "struct-import: warning: %s: %d patches or pairs of them still cross\n", name,
                m->untangle.failed);
    if (m->untangle.changed > LARGE_CHANGE)
        fprintf(stderr,
                "struct-import: warning: %s: a patch that passed through itself was rebuilt with %.3g of its "
                "area or volume more or less: check it\n",
                name, m->untangle.changed);
    if (twisted)
        fprintf(stderr, "struct-import: warning: %s: %d patches have one side only and cannot be oriented\n",
                name, twisted);
    if (m->quality.degenerate)
        fprintf(stderr, "struct-import: warning: %s: %d triangles without area are left\n", name,
                m->quality.degenerate);
}

static void check_size(const struct options *o, fl_aabb box)
{
    const fl_vec3 side = v3_sub(box.hi, box.lo);
    const double largest = fmax(side.x, fmax(side.y, side.z));
    if (largest <= LARGEST && largest >= SMALLEST) return;
    fprintf(stderr, "struct-import: warning: the bounding box is %.6g x %.6g x %.6g m; %s\n", side.x, side.y,
            side.z,
            o->unit ? "is the unit right?" : "the unit is unknown and was taken as m, --unit sets it");
}

/* Measure the joint volume of open parts that are closed together. */
static int32_t measure_jointly(const fl_surface *s, const struct cleanup *m, fl_mesh_quality *sum)
{
    int32_t joint = 0, open = 0;
    for (int32_t i = 0; i < s->n; i++) {
        joint += m[i].closes_jointly;
        open += !m[i].quality.closed;
    }
    if (joint && joint == open) {
        const fl_moments all = fl_moments_of(s->part, s->n);
        sum->closed = 1;
        sum->volume = all.volume;
        sum->centroid = all.centroid;
    }
    return joint;
}

/* 1 if a part came clean: nothing was mended, nothing is left to mend, and it did not move. */
static int is_clean(const struct cleanup *m)
{
    const fl_mesh_quality *q = &m->quality;
    const int mended = m->weld.merged || m->weld.collapsed || m->repair.degenerate || m->duplicates ||
                       m->repair.duplicates || m->repair.holes || m->repair.stitched || m->orient.patches ||
                       m->orient.triangles || m->untangle.joined || m->untangle.rebuilt || m->walls ||
                       m->simplified || m->triangles_before != q->triangles,
              left = q->open || q->branched || q->incoherent || q->degenerate || m->crossing.crossings ||
                     m->crossing.touching;
    return !mended && !left && m->deviation == 0.0 && m->source_deviation == 0.0;
}

static int all_clean(const fl_surface *s, const struct cleanup *m)
{
    for (int32_t i = 0; i < s->n; i++)
        if (!is_clean(&m[i])) return 0;
    return 1;
}

/* What was mended, and what that changed. */
static void print_mending(const fl_surface *s, const struct cleanup *m, struct cleanup *sum, int width)
{
    fprintf(stderr, "\n%-*s %7s %10s %9s %7s %7s %7s %5s %12s %7s %7s %8s %8s\n", width, "part", "welded",
            "degenerate", "duplicate", "flipped", "turned", "patches", "open", "non-manifold", "twisted",
            "slivers", "crossing", "touching");
    for (int32_t i = 0; i < s->n; i++) {
        print_mesh(s->part[i].name, width, &m[i]);
        add_counts(sum, &m[i]);
    }
    if (s->n > 1) print_mesh("total", width, sum);
    fprintf(stderr, "\n%-*s %9s %9s %6s %6s %7s %10s %10s %10s %11s %9s %9s\n", width, "part", "came", "went",
            "filled", "joined", "rebuilt", "volume[1]", "area[1]", "centre[m]", "inertia[1]", "strays[m]",
            "misses[m]");
    for (int32_t i = 0; i < s->n; i++) print_changes(s->part[i].name, width, &m[i]);
}

int print_report(const struct options *o, const fl_surface *s, const struct cleanup *m, fl_err *err)
{
    struct cleanup sum = {0};
    int width = 5; /* of "total" */
    if (s->n == 1) sum.quality = m[0].quality;
    else if (fl_surface_measure(s, &sum.quality, err)) return -1;
    if (o->quiet) return 0;
    const int32_t joint = measure_jointly(s, m, &sum.quality);
    for (int32_t i = 0; i < s->n; i++)
        if ((int)strlen(s->part[i].name) > width) width = (int)strlen(s->part[i].name);
    fprintf(stderr, "%-*s %9s %5s %13s %13s   %s   %s\n", width, "part", "triangles", "cones", "volume[m3]",
            "area[m2]", "centroid[m]", "box[m]");
    for (int32_t i = 0; i < s->n; i++) print_shape(s->part[i].name, width, &m[i].quality);
    if (s->n > 1) print_shape("total", width, &sum.quality);
    if (all_clean(s, m) && !o->verbose)
        fprintf(stderr, "\nnothing was mended: every surface came closed, without faults\n");
    else print_mending(s, m, &sum, width);
    for (int32_t i = 0; i < s->n; i++) {
        if (o->verbose) print_details(&s->part[i], &m[i]);
        print_warnings(s->part[i].name, &m[i]);
    }
    if (joint) fprintf(stderr, "struct-import: %d open parts form a closed surface together\n", joint);
    check_size(o, sum.quality.box);
    return 0;
}
