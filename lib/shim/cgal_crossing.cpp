/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#include <CGAL/box_intersection_d.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include "shim/cgal_mesh.hpp"
extern "C" {
#include "shim/cgal_crossing.h"
}

namespace
{
using namespace shim;
using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int32_t>;

enum relation { APART = FL_APART, TOUCH = FL_TOUCHES, CROSS = FL_CROSSES };

/* Three corners, those in common with the other triangle first. */
struct corners {
    Point p[3];
};

corners corners_of(const fl_soup *s, int32_t t)
{
    corners c;
    for (int k = 0; k < 3; k++) {
        const double *x =
            s->x + 3 * static_cast<std::ptrdiff_t>(s->t[3 * static_cast<std::ptrdiff_t>(t) + k]);
        c.p[k] = Point(x[0], x[1], x[2]);
    }
    return c;
}

/* Moves the common corners to the front of both.  Returns their number. */
int move_common_first(corners &a, corners &b)
{
    int n = 0;
    for (int i = 0; i < 3; i++)
        for (int j = n; j < 3; j++)
            if (a.p[i] == b.p[j]) {
                std::swap(a.p[i], a.p[n]);
                std::swap(b.p[j], b.p[n]);
                n++;
                break;
            }
    return n;
}

enum { ABOVE = 1, BELOW = 2, ON = 4 };

/* The sides of the plane of a on which the corners of b from k on lie. */
int plane_sides(const corners &a, const corners &b, int k)
{
    int seen = 0;
    for (; k < 3; k++) {
        const auto o = CGAL::orientation(a.p[0], a.p[1], a.p[2], b.p[k]);
        seen |= o == CGAL::POSITIVE ? ABOVE : o == CGAL::NEGATIVE ? BELOW : ON;
    }
    return seen;
}

bool straddles(int seen) { return (seen & ABOVE) && (seen & BELOW); }

Exact::Triangle_3 exact_triangle(const corners &c)
{
    Exact::Point_3 p[3];
    for (int k = 0; k < 3; k++) p[k] = Exact::Point_3(c.p[k].x(), c.p[k].y(), c.p[k].z());
    return Exact::Triangle_3(p[0], p[1], p[2]);
}

relation relation_of(corners a, corners b)
{
    const int shared = move_common_first(a, b);
    if (shared == 3) return CROSS; /* the triangles coincide */
    const int b_at = plane_sides(a, b, shared);
    if (b_at == ABOVE || b_at == BELOW) return APART; /* apart but for the common corners */
    if (shared == 2)                                  /* and b_at == ON */
        return CGAL::coplanar_orientation(a.p[0], a.p[1], a.p[2], b.p[2]) == CGAL::POSITIVE ? CROSS : APART;
    const int a_at = plane_sides(b, a, shared);
    if (a_at == ABOVE || a_at == BELOW) return APART;
    const Kernel::Triangle_3 ta(a.p[0], a.p[1], a.p[2]), tb(b.p[0], b.p[1], b.p[2]);
    if (shared == 1) {
        if (!CGAL::do_intersect(Kernel::Segment_3(a.p[1], a.p[2]), tb) &&
            !CGAL::do_intersect(Kernel::Segment_3(b.p[1], b.p[2]), ta))
            return APART;
    } else if (!CGAL::do_intersect(ta, tb)) {
        return APART;
    }
    const bool flat = b_at == ON;
    if (!flat && !(straddles(a_at) && straddles(b_at))) return TOUCH;
    const auto both = CGAL::intersection(exact_triangle(a), exact_triangle(b));
    if (!both || boost::get<Exact::Point_3>(&*both)) return TOUCH;
    if (boost::get<Exact::Segment_3>(&*both)) return flat ? TOUCH : CROSS;
    return CROSS;
}

corners corners_at(const double *x)
{
    return corners{{Point(x[0], x[1], x[2]), Point(x[3], x[4], x[5]), Point(x[6], x[7], x[8])}};
}

bool is_degenerate(const corners &c) { return CGAL::collinear(c.p[0], c.p[1], c.p[2]); }

int count_crossings(const fl_soup *s, fl_crossing *c)
{
    std::vector<Box> boxes;
    boxes.reserve(static_cast<std::size_t>(s->nt));
    for (int32_t t = 0; t < s->nt; t++) {
        const corners k = corners_of(s, t);
        if (is_degenerate(k)) continue;
        boxes.emplace_back(k.p[0].bbox() + k.p[1].bbox() + k.p[2].bbox(), t);
    }
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box &x, const Box &y) {
        const int32_t t = std::min(x.info(), y.info()), u = std::max(x.info(), y.info());
        const relation m = relation_of(corners_of(s, t), corners_of(s, u));
        c->crossings += m == CROSS;
        c->touching += m == TOUCH;
    });
    return 0;
}
} // namespace

extern "C" int fl_cgal_crossings(const fl_soup *s, fl_crossing *c, fl_err *err)
{
    *c = fl_crossing{0, 0};
    return run_guarded("search for crossings", s->nt, err, [&] { return count_crossings(s, c); });
}

extern "C" int fl_cgal_classify_triangles(const double *a, const double *b, fl_err *err)
{
    return catch_errors("meeting", 2, err, [&]() -> int {
        const corners p = corners_at(a), q = corners_at(b);
        return is_degenerate(p) || is_degenerate(q) ? APART : relation_of(p, q);
    });
}
