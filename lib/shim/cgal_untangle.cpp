/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#define CGAL_PMP_REMOVE_SELF_INTERSECTION_NO_POLYHEDRAL_ENVELOPE_CHECK
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include "shim/cgal_mesh.hpp"
#include <CGAL/boost/graph/copy_face_graph.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
extern "C" {
#include "shim/cgal_untangle.h"
}

namespace PMP = CGAL::Polygon_mesh_processing;

namespace
{
using namespace shim;

/* What work() says; false where CGAL would not have it. */
template <class Work>
bool done(Work work)
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        throw;
    } catch (const std::exception &) {
        return false;
    }
}

/* A closed patch without a volume, as a plate of two sides, looks nowhere, and CGAL counts on some. */
bool outward(const Mesh &m)
{
    return done([&] { return PMP::is_outward_oriented(m); });
}

/* Of the area, and of the volume where both have one. */
double change(const Mesh &from, const Mesh &to)
{
    const double area = PMP::area(from), most = std::fabs(PMP::area(to) - area) / area;
    if (!CGAL::is_closed(from) || !CGAL::is_closed(to)) return most;
    const double volume = PMP::volume(from);
    return std::max(most, std::fabs((PMP::volume(to) - volume) / volume));
}

/* Cut out what passes through itself, and close it again: keeping the genus where that can be done. */
bool rebuild(Mesh &m, fl_untangle *did)
{
    for (const bool genus : {true, false}) {
        Mesh trial = m;
        if (!done([&] {
                return PMP::experimental::remove_self_intersections(trial,
                                                                    CGAL::parameters::preserve_genus(genus));
            }))
            continue;
        did->changed = std::max(did->changed, change(m, trial));
        m = trial;
        return true;
    }
    return false;
}

/* Where surfaces nearly touch, a union has triangles that rounding turns over: edges shorter than tol are
 * taken out, and corners nearer than that to an edge. */
void tidy(Mesh &m, double tol)
{
    constexpr double STRAIGHT = -1.0 + 1e-12,
                     NEEDLE = 1e6; /* cosine, and length over width, of what is bad */
    Mesh trial = m;
    const auto within = CGAL::parameters::flip_triangle_height_threshold(tol);
    if (done([&] {
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

/* The height of each triangle is a number that double precision still tells from nothing. */
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

/* A number from -1 to 1 without rhythm; the same in every run. */
double spread(uint32_t &state)
{
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 8) / 8388608.0 - 1.0;
}

/* Swell a body by about eps about its middle, and turn it by less.  Where its corners came to lie in one
 * place with others', or nearly, they then do not, and what lay side by side overlaps. */
void loosen(Mesh &m, double eps, uint32_t &state)
{
    const CGAL::Bbox_3 box = PMP::bbox(m);
    double c[3], w[3];
    const double grown = 1.0 + eps * (1.5 + 0.5 * spread(state));
    for (int k = 0; k < 3; k++) c[k] = 0.5 * (box.min(k) + box.max(k)), w[k] = 0.2 * eps * spread(state);
    for (const auto v : m.vertices()) {
        const Point &p = m.point(v);
        const double x = p.x() - c[0], y = p.y() - c[1], z = p.z() - c[2];
        m.point(v) = Point(c[0] + grown * x + w[1] * z - w[2] * y, c[1] + grown * y + w[2] * x - w[0] * z,
                           c[2] + grown * z + w[0] * y - w[1] * x);
    }
}

/* Its halfedges are linked as those of closed triangles are, told without following links, which need not
 * end: a union that is no manifold may come out torn. */
template <class Any>
bool linked(const Any &m)
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

/* The union of a and b, found exactly and then rounded and tidied; false where that is not sound. */
bool union_of(const Mesh &a, const Mesh &b, double tol, Mesh &out)
{
    using Exact = CGAL::Surface_mesh<CGAL::Exact_predicates_exact_constructions_kernel::Point_3>;
    Exact left, right, both;
    CGAL::copy_face_graph(a, left);
    CGAL::copy_face_graph(b, right);
    if (!PMP::corefine_and_compute_union(left, right, both,
                                         CGAL::parameters::throw_on_self_intersection(true)))
        return false;
    if (!linked(both)) return false;
    CGAL::copy_face_graph(both, out);
    tidy(out, tol);
    return !PMP::does_self_intersect(out) && has_areas(out);
}

/* A corner of q lies in the plane of p. */
bool one_in_plane(const std::array<Point, 3> &p, const std::array<Point, 3> &q)
{
    return std::any_of(q.begin(), q.end(), [&](const Point &x) {
        return CGAL::orientation(p[0], p[1], p[2], x) == CGAL::COPLANAR;
    });
}

/* A corner of one lies on the other, or faces lie on one another: then a union may be no manifold, and the
 * search for it without end. */
bool touch(const Mesh &a, const Mesh &b)
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
                                 if (found || !(one_in_plane(p, q) || one_in_plane(q, p))) return;
                                 found = CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]),
                                                            Kernel::Triangle_3(q[0], q[1], q[2]));
                             });
    return found;
}

/* b becomes part of a, loosened as little as it takes; false, and a as it was, where that will not do. */
bool unite(Mesh &a, const Mesh &b, double tol, uint32_t &state)
{
    const bool close = touch(a, b);
    for (const double eps : {0.0, 1e-8, 1e-7, FL_UNTANGLE_SWELL}) {
        Mesh other = b, both;
        if (eps == 0.0 && close) continue;
        if (eps > 0.0) loosen(other, eps, state);
        if (!done([&] { return union_of(a, other, tol, both); })) continue;
        a = both;
        return true;
    }
    return false;
}

/* A patch of the soup: the shell it is of, and the group of patches that meet, directly or through others. */
struct Patch {
    Mesh mesh;
    CGAL::Bbox_3 box;
    int32_t shell = 0;
    std::size_t group = 0;
    explicit Patch(const Mesh &m, int32_t of) : mesh(m), box(PMP::bbox(m)), shell(of) {}
};

bool meet(const Patch &a, const Patch &b)
{
    return !a.mesh.is_empty() && !b.mesh.is_empty() && CGAL::do_overlap(a.box, b.box) &&
           PMP::do_intersect(a.mesh, b.mesh);
}

/* Closed, looking outward, and not through itself: what a union can be made of. */
bool solid(const Mesh &m)
{
    return !m.is_empty() && CGAL::is_closed(m) && outward(m) && !PMP::does_self_intersect(m);
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

/* Which patches meet, as they come; those of one shell belong together. */
void find_groups(std::vector<Patch> &patch)
{
    for (std::size_t i = 0; i < patch.size(); i++) patch[i].group = i;
    for (std::size_t i = 0; i < patch.size(); i++)
        for (std::size_t j = i + 1; j < patch.size(); j++)
            if (patch[i].shell == patch[j].shell ||
                (root_of(patch, i) != root_of(patch, j) && meet(patch[i], patch[j])))
                join_groups(patch, i, j);
    for (std::size_t i = 0; i < patch.size(); i++) patch[i].group = root_of(patch, i);
}

/* Solids of a group have passed through others of it, so that they are no cavities: what now lies inside the
 * union of others is part of it. */
bool swallow(Patch &a, Patch &b)
{
    if (!CGAL::do_overlap(a.box, b.box)) return false;
    const CGAL::Side_of_triangle_mesh<Mesh, Kernel> side(a.mesh);
    const bool inside = side(b.mesh.point(*b.mesh.vertices().begin())) == CGAL::ON_BOUNDED_SIDE;
    if (inside) b.mesh.clear();
    return inside;
}

/* The solids become as many as there are when no two of them that can be united meet. */
void unite_all(std::vector<Patch> &patch, double tol, fl_untangle *did)
{
    uint32_t state = 1;
    std::vector<bool> can;
    for (const Patch &p : patch) can.push_back(solid(p.mesh));
    for (std::size_t i = 0; i < patch.size(); i++) {
        std::vector<bool> tried(patch.size(), false); /* as it is now */
        for (std::size_t j = i + 1; j < patch.size() && can[i]; j++) {
            if (!can[j] || tried[j] || patch[i].group != patch[j].group || !meet(patch[i], patch[j]))
                continue;
            tried[j] = true;
            if (!unite(patch[i].mesh, patch[j].mesh, tol, state)) continue;
            patch[i].box = PMP::bbox(patch[i].mesh);
            patch[j].mesh.clear();
            did->joined++;
            tried.assign(patch.size(), false); /* a union reaches farther than what it was */
            j = i;
        }
    }
    for (std::size_t i = 0; i < patch.size(); i++)
        for (std::size_t j = 0; j < patch.size(); j++) {
            if (i == j || patch[i].group != patch[j].group || patch[i].mesh.is_empty() ||
                patch[j].mesh.is_empty())
                continue;
            if (meet(patch[i], patch[j])) did->failed += i < j;
            else if (can[i] && can[j]) did->joined += swallow(patch[i], patch[j]);
        }
}

/* Each shell by itself, so that none is cut where others share its edges; what is closed looks outward. */
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
            if (CGAL::is_closed(p) && !outward(p)) PMP::reverse_face_orientations(p);
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

extern "C" int fl_cgal_untangle(fl_soup *s, const int32_t *shell, int32_t *group, fl_untangle *did,
                                fl_err *err)
{
    *did = fl_untangle{0, 0, 0, 0.0};
    return guarded("repair of crossings", s->nt, err, [&] { return untangle(s, shell, group, did, err); });
}
