/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#define CGAL_PMP_REMOVE_SELF_INTERSECTION_NO_POLYHEDRAL_ENVELOPE_CHECK
#include "shim/cgal_mesh.hpp"
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
extern "C" {
#include "shim/cgal_untangle.h"
}

namespace PMP = CGAL::Polygon_mesh_processing;

namespace
{
using namespace shim;

bool solid(const Mesh &m) { return CGAL::is_closed(m) && PMP::is_outward_oriented(m); }

/* Cut out what passes through itself, and close it again: keeping the genus where that can be done. */
bool rebuild(Mesh &m)
{
    Mesh trial = m;
    if (!PMP::experimental::remove_self_intersections(trial)) {
        trial = m;
        if (!PMP::experimental::remove_self_intersections(trial, CGAL::parameters::preserve_genus(false)))
            return false;
    }
    m = trial;
    return true;
}

/* b becomes part of a. */
bool unite(Mesh &a, const Mesh &b)
{
    Mesh left = a, right = b, both;
    if (!PMP::corefine_and_compute_union(left, right, both)) return false;
    both.collect_garbage();
    a = both;
    return true;
}

int untangle(fl_soup *s, fl_untangle *did, fl_err *err)
{
    Mesh whole, result;
    std::vector<Mesh> patch;
    if (to_mesh(s, whole, err)) return -1;
    PMP::split_connected_components(whole, patch);
    for (Mesh &m : patch) {
        if (!PMP::does_self_intersect(m)) continue;
        if (rebuild(m)) did->rebuilt++;
        else did->failed++;
    }
    for (std::size_t i = 0; i < patch.size(); i++)
        for (std::size_t j = 0; j < patch.size(); j++) {
            /* a union reaches farther than what it was: look at all again */
            if (i == j || patch[i].is_empty() || patch[j].is_empty()) continue;
            if (!CGAL::do_overlap(PMP::bbox(patch[i]), PMP::bbox(patch[j])) ||
                !PMP::do_intersect(patch[i], patch[j]))
                continue;
            if (!solid(patch[i]) || !solid(patch[j]) || !unite(patch[i], patch[j])) {
                did->failed += i < j;
                continue;
            }
            patch[j].clear();
            did->joined++;
            j = static_cast<std::size_t>(-1);
        }
    if (did->joined + did->rebuilt == 0) return 0;
    for (const Mesh &m : patch) result.join(m);
    return write_back(s, result, err);
}
} // namespace

extern "C" int fl_cgal_untangle(fl_soup *s, fl_untangle *did, fl_err *err)
{
    *did = fl_untangle{0, 0, 0};
    return guarded("repair of crossings", s->nt, err, [&] { return untangle(s, did, err); });
}
