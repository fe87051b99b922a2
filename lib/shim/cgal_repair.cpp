/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <iterator>
#include <new>
#include <utility>
#include <vector>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
extern "C" {
#include "base/mem.h"
#include "shim/cgal_repair.h"
}

namespace PMP = CGAL::Polygon_mesh_processing;

namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Triangle = std::array<std::size_t, 3>;

/* The first line of what a library has to say: CGAL's sentences come in several. */
int told(const fl_soup *s, const char *what, fl_err *err)
{
    return fl_fail(err, FL_NUMERIC, "repair of %d triangles: %.*s", s->nt,
                   static_cast<int>(std::strcspn(what, "\n")), what);
}

/* CGAL would print a failed assertion before it throws; the sentence belongs to the caller. */
void quiet(const char *, const char *, const char *, int, const char *) {}

void close_holes(Mesh &mesh, std::size_t most, fl_repair &did)
{
    std::vector<Mesh::Halfedge_index> rims;
    PMP::extract_boundary_cycles(mesh, std::back_inserter(rims));
    for (const auto rim : rims) {
        std::size_t edges = 0;
        std::vector<Mesh::Face_index> made;
        for (const auto h : CGAL::halfedges_around_face(rim, mesh)) {
            (void)h;
            edges++;
        }
        if (edges > most) continue;
        PMP::triangulate_hole(mesh, rim, std::back_inserter(made));
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

/* An edge is flipped or collapsed for each, so the number of faces may or may not change. */
void remove_degenerate(Mesh &mesh, fl_repair &did)
{
    const int32_t found = count_degenerate(mesh);
    if (found == 0) return;
    PMP::remove_degenerate_faces(mesh);
    did.stuck = count_degenerate(mesh);
    did.degenerate = found - did.stuck;
}

/* Do two triangles that meet do more than touch in corners or an edge that lie in the same place?  Where the
 * surface was cut along a branched edge, they are neighbours that CGAL no longer knows as such. */
bool crosses(const Mesh &mesh, Mesh::Face_index f, Mesh::Face_index g)
{
    std::vector<Point> a, b, common;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) a.push_back(mesh.point(v));
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(g), mesh)) b.push_back(mesh.point(v));
    const Kernel::Triangle_3 ta(a[0], a[1], a[2]), tb(b[0], b[1], b[2]);
    for (const Point &x : std::vector<Point>(a)) {
        const auto twin = std::find(b.begin(), b.end(), x);
        if (twin == b.end()) continue;
        common.push_back(x);
        b.erase(twin);
        a.erase(std::find(a.begin(), a.end(), x));
    }
    switch (common.size()) {
    case 1:
        return CGAL::do_intersect(Kernel::Segment_3(a[0], a[1]), tb) ||
               CGAL::do_intersect(Kernel::Segment_3(b[0], b[1]), ta);
    case 2:
        return CGAL::coplanar(common[0], common[1], a[0], b[0]) &&
               CGAL::coplanar_orientation(common[0], common[1], a[0], b[0]) == CGAL::POSITIVE;
    default: return true;
    }
}

void orient(Mesh &mesh, fl_repair &did)
{
    std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> meeting;
    if (did.stuck) return; /* a triangle without a plane has no exact answer */
    PMP::self_intersections(mesh, std::back_inserter(meeting));
    for (const auto &pair : meeting) did.crossings += crosses(mesh, pair.first, pair.second);
    if (!meeting.empty() || mesh.number_of_faces() == 0 || !CGAL::is_closed(mesh)) return;
    PMP::orient_to_bound_a_volume(mesh);
    did.bounding = 1;
}

int write_back(fl_soup *s, const Mesh &mesh, fl_err *err)
{
    const int64_t nv = static_cast<int64_t>(mesh.number_of_vertices());
    const int64_t nt = static_cast<int64_t>(mesh.number_of_faces());
    std::vector<int32_t> index(mesh.num_vertices(), -1);
    std::ptrdiff_t n = 0;
    if (nv > INT32_MAX || nt > INT32_MAX)
        return fl_fail(err, FL_SYSTEM, "more than 2^31 vertices after repair");
    auto x = static_cast<double *>(fl_alloc(3 * nv, sizeof(double), err));
    auto t = x ? static_cast<int32_t *>(fl_alloc(3 * nt, sizeof(int32_t), err)) : nullptr;
    if (!t) {
        free(x);
        return -1;
    }
    for (const auto v : mesh.vertices()) {
        const Point &p = mesh.point(v);
        index[static_cast<std::size_t>(v)] = static_cast<int32_t>(n);
        for (int k = 0; k < 3; k++) x[3 * n + k] = p[k];
        n++;
    }
    n = 0;
    for (const auto f : mesh.faces())
        for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
            t[n++] = index[static_cast<std::size_t>(v)];
    fl_soup_free(s);
    *s = fl_soup{static_cast<int32_t>(nv), static_cast<int32_t>(nt), x, t};
    return 0;
}

int repair(fl_soup *s, int32_t holes, fl_repair *did, fl_err *err)
{
    std::vector<Point> points;
    std::vector<Triangle> triangles;
    Mesh mesh;
    points.reserve(static_cast<std::size_t>(s->nv));
    triangles.reserve(static_cast<std::size_t>(s->nt));
    for (int32_t v = 0; v < s->nv; v++) {
        const double *x = s->x + 3 * static_cast<std::ptrdiff_t>(v);
        points.emplace_back(x[0], x[1], x[2]);
    }
    for (int32_t t = 0; t < s->nt; t++) {
        const int32_t *v = s->t + 3 * static_cast<std::ptrdiff_t>(t);
        triangles.push_back(
            {static_cast<std::size_t>(v[0]), static_cast<std::size_t>(v[1]), static_cast<std::size_t>(v[2])});
    }
    did->duplicates = static_cast<int32_t>(PMP::merge_duplicate_polygons_in_polygon_soup(points, triangles));
    PMP::orient_polygon_soup(points, triangles);
    if (!PMP::is_polygon_soup_a_polygon_mesh(triangles))
        return fl_fail(err, FL_NUMERIC, "the triangles could not be cut into manifold pieces");
    PMP::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    did->stitched = static_cast<int32_t>(PMP::stitch_borders(mesh));
    remove_degenerate(mesh, *did);
    if (holes > 0) close_holes(mesh, static_cast<std::size_t>(holes), *did);
    orient(mesh, *did);
    mesh.collect_garbage();
    return write_back(s, mesh, err);
}
} // namespace

extern "C" int fl_cgal_repair(fl_soup *s, int32_t holes, fl_repair *did, fl_err *err)
try {
    const auto on_error = CGAL::set_error_handler(quiet);
    const auto on_warning = CGAL::set_warning_handler(quiet);
    struct restore {
        CGAL::Failure_function error, warning;
        ~restore()
        {
            CGAL::set_error_handler(error);
            CGAL::set_warning_handler(warning);
        }
    } const at_end = {on_error, on_warning};
    *did = fl_repair{};
    return repair(s, holes, did, err);
} catch (const std::bad_alloc &) {
    return fl_fail(err, FL_SYSTEM, "out of memory while %d triangles were repaired", s->nt);
} catch (const std::exception &e) {
    return told(s, e.what(), err);
} catch (...) {
    return told(s, "an unknown failure", err);
}

extern "C" void fl_soup_free(fl_soup *s)
{
    free(s->x);
    free(s->t);
    *s = fl_soup{0, 0, nullptr, nullptr};
}
