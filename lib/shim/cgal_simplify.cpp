/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#include "shim/cgal_mesh.hpp"
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Polyhedral_envelope_filter.h>
extern "C" {
#include "shim/cgal_simplify.h"
}

namespace SMS = CGAL::Surface_mesh_simplification;

namespace
{
using namespace shim;

struct border_edges {
    using key_type = Mesh::Edge_index;
    using value_type = bool;
    using reference = bool;
    using category = boost::readable_property_map_tag;
    const Mesh *mesh;
    friend bool get(const border_edges &r, key_type e) { return r.mesh->is_border(e); }
};

int simplify(fl_soup *s, double distance, int32_t *removed, fl_err *err)
{
    Mesh mesh;
    const int32_t before = s->nt;
    if (to_mesh(s, mesh, err)) return -1;
    const border_edges fixed = {&mesh};
    const SMS::Constrained_placement<SMS::LindstromTurk_placement<Mesh>, border_edges> placement(fixed);
    const SMS::Polyhedral_envelope_filter<Kernel> filter(distance);
    SMS::edge_collapse(mesh, SMS::Count_stop_predicate<Mesh>(0),
                       CGAL::parameters::edge_is_constrained_map(fixed)
                           .get_cost(SMS::LindstromTurk_cost<Mesh>())
                           .get_placement(placement)
                           .filter(filter));
    if (write_back(s, mesh, err)) return -1;
    *removed = before - s->nt;
    return 0;
}
} // namespace

extern "C" int fl_cgal_simplify(fl_soup *s, double distance, int32_t *removed, fl_err *err)
{
    *removed = 0;
    return run_guarded("simplification", s->nt, err, [&] { return simplify(s, distance, removed, err); });
}
