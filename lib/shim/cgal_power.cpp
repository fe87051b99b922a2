/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <utility>
#include <vector>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
extern "C" {
#include "base/array.h"
}
#include "shim/cgal_planar.hpp"
#include "shim/cgal_power.h"

namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Base = CGAL::Regular_triangulation_vertex_base_2<Kernel>;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<int32_t, Kernel, Base>;
using Face = CGAL::Regular_triangulation_face_base_2<Kernel>;
using Regular = CGAL::Regular_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, Face>>;
using Weighted = Kernel::Weighted_point_2;

int neighbours(int32_t n, const fl_vec2 *site, const double *weight, const int32_t *name, char *empty,
               int32_t *first, int32_t **near, fl_err *err)
{
    std::vector<std::pair<Weighted, int32_t>> point;
    point.reserve(static_cast<size_t>(n));
    for (int32_t i = 0; i < n; i++)
        point.emplace_back(Weighted(Kernel::Point_2(site[i].x, site[i].y), weight[i]), i);
    const Regular rt(point.begin(), point.end());

    std::memset(empty, 1, static_cast<size_t>(n));
    for (auto v = rt.finite_vertices_begin(); v != rt.finite_vertices_end(); ++v) empty[v->info()] = 0;
    return shim::neighbours(rt, n, name, first, near, err);
}

} // namespace

extern "C" int fl_cgal_power_neighbours(int32_t n, const fl_vec2 *site, const double *weight,
                                        const int32_t *name, char *empty, int32_t *first, int32_t **near,
                                        fl_err *err)
try {
    return neighbours(n, site, weight, name, empty, first, near, err);
} catch (const std::bad_alloc &) {
    return fl_fail(err, FL_SYSTEM, "out of memory: the neighbours of %d sites", n);
} catch (const std::exception &e) {
    return fl_fail(err, FL_NUMERIC, "the neighbours of %d weighted sites: %s", n, e.what());
}
