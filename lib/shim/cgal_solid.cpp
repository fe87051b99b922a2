/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Repair of surfaces, and intersecting bodies.  One file, since both instantiate the filling of holes.  The
 * headers are plain C; no C++ name and no exception leaves this file. */
#define CGAL_PMP_REMOVE_SELF_INTERSECTION_NO_POLYHEDRAL_ENVELOPE_CHECK
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <unordered_map>
#include "shim/cgal_mesh.hpp"
#include <CGAL/boost/graph/copy_face_graph.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/shape_predicates.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
extern "C" {
#include "shim/cgal_crossing.h"
#include "shim/cgal_untangle.h"
}

namespace PMP = CGAL::Polygon_mesh_processing;

namespace
{
using namespace shim;

/* --- repair ---------------------------------------------------------------------------------------- */

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

/* --- intersecting bodies --------------------------------------------------------------------------- */

/* Result of work(); false if CGAL throws. */
template <class Work>
bool succeeds(Work work)
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        throw;
    } catch (const std::exception &) {
        return false;
    }
}

/* A closed patch without volume, as a two-sided plate, has no orientation, but CGAL requires one. */
bool is_outward(const Mesh &m)
{
    return succeeds([&] { return PMP::is_outward_oriented(m); });
}

/* Largest relative change of the area, and of the volume if both have one. */
double relative_change(const Mesh &from, const Mesh &to)
{
    const double area = PMP::area(from), most = std::fabs(PMP::area(to) - area) / area;
    if (!CGAL::is_closed(from) || !CGAL::is_closed(to)) return most;
    const double volume = PMP::volume(from);
    return std::max(most, std::fabs((PMP::volume(to) - volume) / volume));
}

/* Removes self-intersections and fills the holes; preserves the genus where possible. */
bool rebuild(Mesh &m, fl_untangle *did)
{
    for (const bool genus : {true, false}) {
        Mesh trial = m;
        if (!succeeds([&] {
                return PMP::experimental::remove_self_intersections(trial,
                                                                    CGAL::parameters::preserve_genus(genus));
            }))
            continue;
        did->changed = std::max(did->changed, relative_change(m, trial));
        m = trial;
        return true;
    }
    return false;
}

/* Where surfaces nearly touch, a union has triangles that rounding inverts.  Removes edges shorter than tol,
 * and corners closer than tol to an edge. */
void remove_short_edges(Mesh &m, double tol)
{
    constexpr double STRAIGHT = -1.0 + 1e-12,
                     NEEDLE = 1e6; /* cosine, and length over width, of a bad triangle */
    Mesh trial = m;
    const auto within = CGAL::parameters::flip_triangle_height_threshold(tol);
    if (succeeds([&] {
            PMP::experimental::remove_almost_degenerate_faces(trial, STRAIGHT, NEEDLE, tol, within);
            return CGAL::is_closed(trial) && !PMP::does_self_intersect(trial);
        }))
        m = trial;
}

/* Three corners of a face. */
std::array<Point, 3> corners_of(const Mesh &m, Mesh::Face_index f)
{
    const auto h = m.halfedge(f);
    return {m.point(m.source(h)), m.point(m.target(h)), m.point(m.target(m.next(h)))};
}

/* True if the height of each triangle is significant in double precision. */
bool has_areas(const Mesh &m)
{
    for (const auto f : m.faces()) {
        const auto [a, b, c] = corners_of(m, f);
        const double longest = std::max(
            {CGAL::squared_distance(a, b), CGAL::squared_distance(b, c), CGAL::squared_distance(c, a)});
        if (!(CGAL::squared_area(a, b, c) > 1e-24 * longest * longest)) return false;
    }
    return true;
}

/* Pseudo-random number from -1 to 1; the same in every run. */
double next_random(uint32_t &state)
{
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 8) / 8388608.0 - 1.0;
}

/* Enlarges a body by about eps about its centre and rotates it by less.  Corners that coincided with others,
 * or nearly, then do not, and bodies that lay side by side overlap. */
void swell(Mesh &m, double eps, uint32_t &state)
{
    const CGAL::Bbox_3 box = PMP::bbox(m);
    double c[3], w[3];
    const double grown = 1.0 + eps * (1.5 + 0.5 * next_random(state));
    for (int k = 0; k < 3; k++) c[k] = 0.5 * (box.min(k) + box.max(k)), w[k] = 0.2 * eps * next_random(state);
    for (const auto v : m.vertices()) {
        const Point &p = m.point(v);
        const double x = p.x() - c[0], y = p.y() - c[1], z = p.z() - c[2];
        m.point(v) = Point(c[0] + grown * x + w[1] * z - w[2] * y, c[1] + grown * y + w[2] * x - w[0] * z,
                           c[2] + grown * z + w[0] * y - w[1] * x);
    }
}

/* True if the halfedges are linked as those of closed triangles.  No links are followed in loops, which need
 * not end: a non-manifold union may have inconsistent links. */
template <class Any>
bool has_valid_links(const Any &m)
{
    for (const auto h : m.halfedges()) {
        const auto n = m.next(h);
        if (m.is_border(h) || m.next(m.next(n)) != h || m.prev(n) != h || m.face(n) != m.face(h) ||
            m.target(m.opposite(n)) != m.target(h))
            return false;
    }
    for (const auto f : m.faces())
        if (m.face(m.halfedge(f)) != f) return false;
    for (const auto v : m.vertices())
        if (m.halfedge(v) == Any::null_halfedge() || m.target(m.halfedge(v)) != v) return false;
    return !m.is_empty();
}

/* The union of a and b, computed exactly, then rounded and cleaned.  False if the result is not valid. */
bool compute_union(const Mesh &a, const Mesh &b, double tol, Mesh &out)
{
    using Exact = CGAL::Surface_mesh<CGAL::Exact_predicates_exact_constructions_kernel::Point_3>;
    Exact left, right, both;
    CGAL::copy_face_graph(a, left);
    CGAL::copy_face_graph(b, right);
    if (!PMP::corefine_and_compute_union(left, right, both,
                                         CGAL::parameters::throw_on_self_intersection(true)))
        return false;
    if (!has_valid_links(both)) return false;
    CGAL::copy_face_graph(both, out);
    remove_short_edges(out, tol);
    return !PMP::does_self_intersect(out) && has_areas(out);
}

/* True if a corner of q lies in the plane of p. */
bool has_corner_in_plane(const std::array<Point, 3> &p, const std::array<Point, 3> &q)
{
    return std::any_of(q.begin(), q.end(), [&](const Point &x) {
        return CGAL::orientation(p[0], p[1], p[2], x) == CGAL::COPLANAR;
    });
}

/* True if a corner of one lies on the other or faces coincide: the union may be non-manifold, and its
 * computation may not end. */
bool has_coplanar_contact(const Mesh &a, const Mesh &b)
{
    using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Mesh::Face_index>;
    std::vector<Box> of[2];
    const Mesh *const mesh[2] = {&a, &b};
    bool found = false;
    for (int k = 0; k < 2; k++)
        for (const auto f : mesh[k]->faces()) {
            const auto c = corners_of(*mesh[k], f);
            of[k].emplace_back(c[0].bbox() + c[1].bbox() + c[2].bbox(), f);
        }
    CGAL::box_intersection_d(of[0].begin(), of[0].end(), of[1].begin(), of[1].end(),
                             [&](const Box &x, const Box &y) {
                                 const auto p = corners_of(a, x.info()), q = corners_of(b, y.info());
                                 if (found || !(has_corner_in_plane(p, q) || has_corner_in_plane(q, p)))
                                     return;
                                 found = CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]),
                                                            Kernel::Triangle_3(q[0], q[1], q[2]));
                             });
    return found;
}

/* Unites b with a, enlarging b as little as necessary.  False, and a unchanged, if all attempts fail. */
bool unite(Mesh &a, const Mesh &b, double tol, uint32_t &state)
{
    const bool close = has_coplanar_contact(a, b);
    for (const double eps : {0.0, 1e-8, 1e-7, FL_UNTANGLE_SWELL}) {
        Mesh other = b, both;
        if (eps == 0.0 && close) continue;
        if (eps > 0.0) swell(other, eps, state);
        if (!succeeds([&] { return compute_union(a, other, tol, both); })) continue;
        a = both;
        return true;
    }
    return false;
}

/* A patch of the soup, the shell that it belongs to, and its group: the patches that intersect, directly or
 * through others. */
struct Patch {
    Mesh mesh;
    CGAL::Bbox_3 box;
    int32_t shell = 0;
    std::size_t group = 0;
    explicit Patch(const Mesh &m, int32_t of) : mesh(m), box(PMP::bbox(m)), shell(of) {}
};

bool bodies_intersect(const Patch &a, const Patch &b)
{
    return !a.mesh.is_empty() && !b.mesh.is_empty() && CGAL::do_overlap(a.box, b.box) &&
           PMP::do_intersect(a.mesh, b.mesh);
}

/* True if m is closed, oriented outward and free of self-intersections: a valid operand of a union. */
bool is_solid(const Mesh &m)
{
    return !m.is_empty() && CGAL::is_closed(m) && is_outward(m) && !PMP::does_self_intersect(m);
}

std::size_t root_of(const std::vector<Patch> &patch, std::size_t i)
{
    while (patch[i].group != i) i = patch[i].group;
    return i;
}

void join_groups(std::vector<Patch> &patch, std::size_t i, std::size_t j)
{
    const std::size_t a = root_of(patch, i), b = root_of(patch, j);
    patch[std::max(a, b)].group = std::min(a, b);
}

/* Finds the groups of the patches as given.  Patches of one shell are in one group. */
void find_groups(std::vector<Patch> &patch)
{
    for (std::size_t i = 0; i < patch.size(); i++) patch[i].group = i;
    for (std::size_t i = 0; i < patch.size(); i++)
        for (std::size_t j = i + 1; j < patch.size(); j++)
            if (patch[i].shell == patch[j].shell ||
                (root_of(patch, i) != root_of(patch, j) && bodies_intersect(patch[i], patch[j])))
                join_groups(patch, i, j);
    for (std::size_t i = 0; i < patch.size(); i++) patch[i].group = root_of(patch, i);
}

/* Winding number of a closed mesh about x, which is not on it, by solid angles: van Oosterom and Strackee,
 * IEEE Trans. Biomed. Eng. 30 (1983) 125. */
double winding_number(const Mesh &m, const Point &x)
{
    double sum = 0.0;
    for (const auto f : m.faces()) {
        const auto c = corners_of(m, f);
        const Kernel::Vector_3 u(x, c[0]), v(x, c[1]), w(x, c[2]);
        const double lu = std::sqrt(u * u), lv = std::sqrt(v * v), lw = std::sqrt(w * w);
        sum += std::atan2(u * CGAL::cross_product(v, w),
                          lu * lv * lw + (u * v) * lw + (v * w) * lu + (w * u) * lv);
    }
    return sum / 6.283185307179586;
}

/* Solids of a group intersected others of it, so they are not cavities: one that now lies inside the union of
 * others is dropped.  True if b was inside a. */
bool swallow(const Patch &a, Patch &b)
{
    if (!CGAL::do_overlap(a.box, b.box) ||
        std::fabs(winding_number(a.mesh, b.mesh.point(*b.mesh.vertices().begin()))) < 0.5)
        return false;
    b.mesh.clear();
    return true;
}

/* Unites solids until no two that can be united intersect. */
void unite_all(std::vector<Patch> &patch, double tol, fl_untangle *did)
{
    uint32_t state = 1;
    std::vector<bool> can;
    for (const Patch &p : patch) can.push_back(is_solid(p.mesh));
    for (std::size_t i = 0; i < patch.size(); i++) {
        std::vector<bool> tried(patch.size(), false); /* for the present patch[i] */
        for (std::size_t j = i + 1; j < patch.size() && can[i]; j++) {
            if (!can[j] || tried[j] || patch[i].group != patch[j].group ||
                !bodies_intersect(patch[i], patch[j]))
                continue;
            tried[j] = true;
            if (!unite(patch[i].mesh, patch[j].mesh, tol, state)) continue;
            patch[i].box = PMP::bbox(patch[i].mesh);
            patch[j].mesh.clear();
            did->joined++;
            tried.assign(patch.size(), false); /* a union extends farther than its operands */
            j = i;
        }
    }
    for (std::size_t i = 0; i < patch.size(); i++)
        for (std::size_t j = 0; j < patch.size(); j++) {
            if (i == j || patch[i].group != patch[j].group || patch[i].mesh.is_empty() ||
                patch[j].mesh.is_empty())
                continue;
            if (bodies_intersect(patch[i], patch[j])) did->failed += i < j;
            else if (can[i] && can[j]) did->joined += swallow(patch[i], patch[j]);
        }
}

/* Converts each shell separately, so that none is cut where others share its edges.  Closed patches are
 * oriented outward. */
int to_patches(const fl_soup *s, const int32_t *shell, std::vector<Patch> &patch, double &diagonal,
               fl_err *err)
{
    std::vector<Point> points;
    std::vector<Corners> triangles;
    to_vectors(s, points, triangles);
    const CGAL::Bbox_3 box = CGAL::bbox_3(points.begin(), points.end());
    diagonal = std::hypot(box.x_span(), box.y_span(), box.z_span());
    std::map<int32_t, std::vector<Corners>> of;
    for (std::size_t t = 0; t < triangles.size(); t++) of[shell[t]].push_back(triangles[t]);
    for (auto &one : of) {
        std::unordered_map<std::size_t, std::size_t> place;
        std::vector<Point> corners;
        std::vector<Mesh> pieces;
        Mesh m;
        for (Corners &c : one.second)
            for (std::size_t &v : c) {
                if (place.emplace(v, corners.size()).second) corners.push_back(points[v]);
                v = place[v];
            }
        if (to_mesh(corners, one.second, m, err)) return -1;
        PMP::split_connected_components(m, pieces);
        for (Mesh &p : pieces) {
            if (CGAL::is_closed(p) && !is_outward(p)) PMP::reverse_face_orientations(p);
            patch.emplace_back(p, one.first);
        }
    }
    return 0;
}

int untangle(fl_soup *s, const int32_t *shell, int32_t *group, fl_untangle *did, fl_err *err)
{
    Mesh result;
    std::vector<Patch> patch;
    std::map<int32_t, int32_t> group_of;
    double diagonal;
    if (to_patches(s, shell, patch, diagonal, err)) return -1;
    find_groups(patch);
    for (const Patch &p : patch) group_of[p.shell] = patch[p.group].shell;
    for (int32_t t = 0; t < s->nt; t++) group[t] = group_of.count(shell[t]) ? group_of[shell[t]] : shell[t];
    for (Patch &p : patch) {
        if (!PMP::does_self_intersect(p.mesh)) continue;
        if (rebuild(p.mesh, did)) did->rebuilt++;
        else did->failed++;
    }
    unite_all(patch, FL_UNTANGLE_SHORT_EDGE * diagonal, did);
    if (did->joined + did->rebuilt == 0) return 0;
    for (const Patch &p : patch) result.join(p.mesh);
    return write_back(s, result, err);
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

extern "C" int fl_cgal_untangle(fl_soup *s, const int32_t *shell, int32_t *group, fl_untangle *did,
                                fl_err *err)
{
    *did = fl_untangle{0, 0, 0, 0.0};
    return run_guarded("repair of crossings", s->nt, err,
                       [&] { return untangle(s, shell, group, did, err); });
}
