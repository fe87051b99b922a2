/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#include <algorithm>
#include <iterator>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include "shim/cgal_mesh.hpp"
extern "C" {
#include "shim/cgal_crossing.h"
}

namespace PMP = CGAL::Polygon_mesh_processing;

namespace
{
using namespace shim;

/* Diagonal of the box of a boundary cycle, and its number of edges. */
double cycle_size(const Mesh &mesh, Mesh::Halfedge_index cycle, std::size_t &edges)
{
    CGAL::Bbox_3 box;
    edges = 0;
    for (const auto h : CGAL::halfedges_around_face(cycle, mesh)) {
        box += mesh.point(mesh.target(h)).bbox();
        edges++;
    }
    return std::sqrt(CGAL::squared_distance(Point(box.xmin(), box.ymin(), box.zmin()),
                                            Point(box.xmax(), box.ymax(), box.zmax())));
}

void close_holes(Mesh &mesh, std::size_t most, double size, fl_repair &did)
{
    std::vector<Mesh::Halfedge_index> cycles;
    PMP::extract_boundary_cycles(mesh, std::back_inserter(cycles));
    for (const auto cycle : cycles) {
        std::size_t edges;
        std::vector<Mesh::Face_index> made;
        if (!(cycle_size(mesh, cycle, edges) <= size) && edges > most) continue;
        PMP::triangulate_hole(mesh, cycle, std::back_inserter(made));
        did.holes += !made.empty();
        did.patched += static_cast<int32_t>(made.size());
    }
}

int32_t count_degenerate(const Mesh &mesh)
{
    int32_t n = 0;
    for (const auto f : mesh.faces()) n += PMP::is_degenerate_triangle_face(f, mesh);
    return n;
}

/* Each face is removed by a flip or a collapse, so the number of faces does not tell how many. */
void remove_degenerate(Mesh &mesh, fl_repair &did)
{
    const int32_t found = count_degenerate(mesh);
    if (found == 0) return;
    PMP::remove_degenerate_faces(mesh);
    did.stuck = count_degenerate(mesh);
    did.degenerate = found - did.stuck;
}

/* Where the surface was cut along a branched edge, two of its vertices coincide, and no reliable test tells
 * which piece lies inside the other. */
bool has_branched_cut(const Mesh &mesh)
{
    std::vector<Point> place;
    place.reserve(mesh.number_of_vertices());
    for (const auto v : mesh.vertices()) place.push_back(mesh.point(v));
    std::sort(place.begin(), place.end());
    return std::adjacent_find(place.begin(), place.end()) != place.end();
}

int repair(fl_soup *s, int32_t holes, double size, fl_repair *did, fl_err *err)
{
    std::vector<Point> points;
    std::vector<Corners> triangles;
    Mesh mesh;
    fl_crossing crossing = {0, 0};
    to_vectors(s, points, triangles);
    did->duplicates = static_cast<int32_t>(PMP::merge_duplicate_polygons_in_polygon_soup(points, triangles));
    if (to_mesh(points, triangles, mesh, err)) return -1;
    did->stitched = static_cast<int32_t>(PMP::stitch_borders(mesh));
    remove_degenerate(mesh, *did);
    if (holes > 0 || size > 0.0) close_holes(mesh, static_cast<std::size_t>(holes), size, *did);
    const bool closed = mesh.number_of_faces() > 0 && CGAL::is_closed(mesh);
    if (write_back(s, mesh, err)) return -1;
    if (did->stuck || !closed) return 0; /* without a plane there is no exact answer */
    if (fl_cgal_crossings(s, &crossing, err)) return -1;
    if (crossing.crossings || crossing.touching || has_branched_cut(mesh)) return 0;
    PMP::orient_to_bound_a_volume(mesh);
    did->bounding = 1;
    return write_back(s, mesh, err);
}
} // namespace

extern "C" int fl_cgal_repair(fl_soup *s, int32_t holes, double size, fl_repair *did, fl_err *err)
{
    *did = fl_repair{};
    return run_guarded("repair", s->nt, err, [&] { return repair(s, holes, size, did, err); });
}

extern "C" void fl_soup_free(fl_soup *s)
{
    free(s->x);
    free(s->t);
    *s = fl_soup{0, 0, nullptr, nullptr};
}
