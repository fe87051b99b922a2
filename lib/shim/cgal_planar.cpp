/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Neighbours in Voronoi and power diagrams, and simple polygons.  One file, since most of its compile time is
 * that of CGAL's kernel.  The headers are plain C; no C++ name and no exception leaves this file. */
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <utility>
#include <vector>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
extern "C" {
#include "base/array.h"
}
#include "shim/cgal_power.h"
#include "shim/cgal_simple.h"
#include "shim/cgal_voronoi.h"

namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/* Neighbours in a triangulation whose vertices carry the numbers 0 .. n - 1: those of i are (*near)[first[i]
 * .. first[i + 1]), sorted by name.  CGAL inserts in a random order; sorting makes the lists a function of
 * the sites.  -1 if memory runs out. */
template <class Triangulation>
int list_neighbours(const Triangulation &t, int32_t n, const int32_t *name, int32_t *first, int32_t **near,
                    fl_err *err)
{
    const auto ends = [&t](auto e, int32_t &a, int32_t &b) {
        a = e->first->vertex(t.ccw(e->second))->info();
        b = e->first->vertex(t.cw(e->second))->info();
    };
    int32_t a, b;
    std::memset(first, 0, (static_cast<size_t>(n) + 1) * sizeof *first);
    for (auto e = t.finite_edges_begin(); e != t.finite_edges_end(); ++e) {
        ends(e, a, b);
        first[a]++;
        first[b]++;
    }
    for (int32_t i = 0, sum = 0; i <= n; i++) { /* counts become ends: each list is filled backwards */
        sum += first[i];
        first[i] = sum;
    }
    *near = static_cast<int32_t *>(fl_alloc(first[n], sizeof **near, err));
    if (!*near) return -1;
    for (auto e = t.finite_edges_begin(); e != t.finite_edges_end(); ++e) {
        ends(e, a, b);
        (*near)[--first[a]] = b;
        (*near)[--first[b]] = a;
    }
    for (int32_t i = 0; i < n; i++)
        std::sort(*near + first[i], *near + first[i + 1],
                  [name](int32_t p, int32_t q) { return name[p] < name[q]; });
    return 0;
}

/* --- Voronoi diagram --------------------------------------------------------------------------- */

using Delaunay_vertex = CGAL::Triangulation_vertex_base_with_info_2<int32_t, Kernel>;
using Delaunay =
    CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Delaunay_vertex>>;

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

int delaunay_neighbours(int32_t n, const fl_vec2 *site, const int32_t *name, int32_t *first, int32_t **near,
                        fl_err *err)
{
    std::vector<std::pair<Kernel::Point_2, int32_t>> point;
    point.reserve(static_cast<size_t>(n));
    for (int32_t i = 0; i < n; i++) point.emplace_back(Kernel::Point_2(site[i].x, site[i].y), i);
    Delaunay dt(point.begin(), point.end());
    if (dt.number_of_vertices() != static_cast<size_t>(n)) return coincident(dt, n, site, name, err);
    return list_neighbours(dt, n, name, first, near, err);
}

/* --- power diagram ----------------------------------------------------------------------------- */

using Base = CGAL::Regular_triangulation_vertex_base_2<Kernel>;
using Regular_vertex = CGAL::Triangulation_vertex_base_with_info_2<int32_t, Kernel, Base>;
using Regular_face = CGAL::Regular_triangulation_face_base_2<Kernel>;
using Regular =
    CGAL::Regular_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Regular_vertex, Regular_face>>;
using Weighted = Kernel::Weighted_point_2;

int power_neighbours(int32_t n, const fl_vec2 *site, const double *weight, const int32_t *name, char *empty,
                     int32_t *first, int32_t **near, fl_err *err)
{
    std::vector<std::pair<Weighted, int32_t>> point;
    point.reserve(static_cast<size_t>(n));
    for (int32_t i = 0; i < n; i++)
        point.emplace_back(Weighted(Kernel::Point_2(site[i].x, site[i].y), weight[i]), i);
    const Regular rt(point.begin(), point.end());

    std::memset(empty, 1, static_cast<size_t>(n));
    for (auto v = rt.finite_vertices_begin(); v != rt.finite_vertices_end(); ++v) empty[v->info()] = 0;
    return list_neighbours(rt, n, name, first, near, err);
}

} // namespace

extern "C" int fl_cgal_neighbours(int32_t n, const fl_vec2 *site, const int32_t *name, int32_t *first,
                                  int32_t **near, fl_err *err)
try {
    return delaunay_neighbours(n, site, name, first, near, err);
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

extern "C" int fl_cgal_power_neighbours(int32_t n, const fl_vec2 *site, const double *weight,
                                        const int32_t *name, char *empty, int32_t *first, int32_t **near,
                                        fl_err *err)
try {
    return power_neighbours(n, site, weight, name, empty, first, near, err);
} catch (const std::bad_alloc &) {
    return fl_fail(err, FL_SYSTEM, "out of memory: the neighbours of %d sites", n);
} catch (const std::exception &e) {
    return fl_fail(err, FL_NUMERIC, "the neighbours of %d weighted sites: %s", n, e.what());
}

extern "C" int fl_cgal_is_simple(int32_t n, const fl_vec2 *v, fl_err *err)
try {
    std::vector<Kernel::Point_2> p;
    p.reserve(static_cast<size_t>(n));
    for (int32_t k = 0; k < n; k++) p.emplace_back(v[k].x, v[k].y);
    return CGAL::is_simple_2(p.begin(), p.end(), Kernel()) ? 1 : 0;
} catch (const std::bad_alloc &) {
    return fl_fail(err, FL_SYSTEM, "out of memory: a polygon of %d corners", n);
} catch (const std::exception &e) {
    return fl_fail(err, FL_NUMERIC, "a polygon of %d corners: %s", n, e.what());
}
