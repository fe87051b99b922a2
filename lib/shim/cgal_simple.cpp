/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <exception>
#include <new>
#include <vector>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
extern "C" {
#include "base/err.h"
}
#include "shim/cgal_simple.h"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

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
