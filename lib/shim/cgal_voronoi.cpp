/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <utility>
#include <vector>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
extern "C" {
#include "base/array.h"
}
#include "shim/cgal_planar.hpp"
#include "shim/cgal_voronoi.h"

namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<int32_t, Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex>>;

/* A site equal to another one has no vertex of its own.  The one of least name is reported. */
int coincident(const Delaunay &dt, int32_t n, const fl_vec2 *site, const int32_t *name, fl_err *err)
{
    std::vector<char> has(static_cast<size_t>(n), 0);
    int32_t lost = -1;
    for (auto v = dt.finite_vertices_begin(); v != dt.finite_vertices_end(); ++v)
        has[static_cast<size_t>(v->info())] = 1;
    for (int32_t i = 0; i < n; i++)
        if (!has[static_cast<size_t>(i)] && (lost < 0 || name[i] < name[lost])) lost = i;
    const int32_t a = name[lost];
    const int32_t b = name[dt.nearest_vertex(Kernel::Point_2(site[lost].x, site[lost].y))->info()];
    return fl_fail(err, FL_INPUT, "sites %d and %d are the same point (%g, %g)", std::min(a, b),
                   std::max(a, b), site[lost].x, site[lost].y);
}

int neighbours(int32_t n, const fl_vec2 *site, const int32_t *name, int32_t *first, int32_t **near,
               fl_err *err)
{
    std::vector<std::pair<Kernel::Point_2, int32_t>> point;
    point.reserve(static_cast<size_t>(n));
    for (int32_t i = 0; i < n; i++) point.emplace_back(Kernel::Point_2(site[i].x, site[i].y), i);
    Delaunay dt(point.begin(), point.end());
    if (dt.number_of_vertices() != static_cast<size_t>(n)) return coincident(dt, n, site, name, err);
    return shim::neighbours(dt, n, name, first, near, err);
}

} // namespace

extern "C" int fl_cgal_neighbours(int32_t n, const fl_vec2 *site, const int32_t *name, int32_t *first,
                                  int32_t **near, fl_err *err)
try {
    return neighbours(n, site, name, first, near, err);
} catch (const std::bad_alloc &) {
    return fl_fail(err, FL_SYSTEM, "out of memory: the neighbours of %d sites", n);
} catch (const std::exception &e) {
    return fl_fail(err, FL_NUMERIC, "the neighbours of %d sites: %s", n, e.what());
}

extern "C" int fl_cgal_orientation(fl_vec2 a, fl_vec2 b, fl_vec2 c)
try {
    return CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(c.x, c.y));
} catch (...) {
    return 0; /* no memory for exact arithmetic: 0 is the conservative answer */
}
