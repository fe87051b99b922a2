/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_planar.hpp -- neighbour lists of planar triangulations.  C++, for the shims only. */
#ifndef FL_SHIM_CGAL_PLANAR_HPP
#define FL_SHIM_CGAL_PLANAR_HPP
#include <stdint.h>
#include <algorithm>
#include <cstring>
extern "C" {
#include "base/array.h"
}

namespace shim
{

/* Neighbours in a triangulation whose vertices carry the numbers 0 .. n - 1: those of i are (*near)[first[i]
 * .. first[i + 1]), sorted by name.  CGAL inserts in a random order; sorting makes the lists a function of
 * the sites.  -1 if memory runs out. */
template <class Triangulation>
int neighbours(const Triangulation &t, int32_t n, const int32_t *name, int32_t *first, int32_t **near,
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

} // namespace shim

#endif
