/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#include "shim/cgal_mesh.hpp"
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
extern "C" {
#include "shim/cgal_remesh.h"
}

namespace PMP = CGAL::Polygon_mesh_processing;

namespace
{
using namespace shim;

enum { ROUNDS = 5 };
constexpr double BEND = 30.0; // degrees

/* True if the angles of the surface at v miss a full turn by BEND or more. */
bool is_apex(const Mesh &mesh, Mesh::Vertex_index v)
{
    double sum = 0.0;
    for (const auto h : CGAL::halfedges_around_target(v, mesh)) {
        if (mesh.is_border(h)) return false;
        sum += CGAL::approximate_angle(mesh.point(mesh.source(h)), mesh.point(v),
                                       mesh.point(mesh.target(mesh.next(h))));
    }
    return std::fabs(360.0 - sum) >= BEND;
}

int remesh(fl_soup *s, double length, fl_err *err)
{
    Mesh mesh;
    if (to_mesh(s, mesh, err)) return -1;
    auto kept = mesh.add_property_map<Mesh::Edge_index, bool>("e:kept", false).first;
    std::vector<Mesh::Edge_index> edges;
    PMP::detect_sharp_edges(mesh, BEND, kept);
    for (const auto e : mesh.edges()) {
        if (mesh.is_border(e)) kept[e] = true;
        if (kept[e]) edges.push_back(e);
    }
    PMP::split_long_edges(edges, length, mesh, CGAL::parameters::edge_is_constrained_map(kept));
    auto held = mesh.add_property_map<Mesh::Vertex_index, bool>("v:held", false).first;
    for (const auto v : mesh.vertices()) held[v] = is_apex(mesh, v);
    PMP::isotropic_remeshing(
        mesh.faces(), length, mesh,
        CGAL::parameters::number_of_iterations(ROUNDS).protect_constraints(true).edge_is_constrained_map(
            kept));
    return write_back(s, mesh, err);
}
} // namespace

extern "C" int fl_cgal_remesh(fl_soup *s, double length, fl_err *err)
{
    return run_guarded("remeshing", s->nt, err, [&] { return remesh(s, length, err); });
}
