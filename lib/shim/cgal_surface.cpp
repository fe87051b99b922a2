/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Intersecting triangles, distance, sides, remeshing and simplification of surfaces.  One file, since most of
 * its compile time is that of CGAL's kernel and meshes.  The headers are plain C; no C++ name and no
 * exception leaves it. */
#include <algorithm>
#include <cmath>
#include <memory>
#include "shim/cgal_mesh.hpp"
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Constrained_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Polyhedral_envelope_filter.h>
extern "C" {
#include "shim/cgal_crossing.h"
#include "shim/cgal_distance.h"
#include "shim/cgal_remesh.h"
#include "shim/cgal_side.h"
#include "shim/cgal_simplify.h"
}

namespace PMP = CGAL::Polygon_mesh_processing;
namespace SMS = CGAL::Surface_mesh_simplification;

namespace
{
using namespace shim;

/* --- intersecting triangles ------------------------------------------------------------------------ */

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int32_t>;

enum relation { APART = FL_APART, TOUCH = FL_TOUCHES, CROSS = FL_CROSSES };

/* Three corners, those in common with the other triangle first. */
struct corners {
    Point p[3];
};

corners corners_of(const fl_soup *s, int32_t t)
{
    corners c;
    for (int k = 0; k < 3; k++) {
        const double *x =
            s->x + 3 * static_cast<std::ptrdiff_t>(s->t[3 * static_cast<std::ptrdiff_t>(t) + k]);
        c.p[k] = Point(x[0], x[1], x[2]);
    }
    return c;
}

/* Moves the common corners to the front of both.  Returns their number. */
int move_common_first(corners &a, corners &b)
{
    int n = 0;
    for (int i = 0; i < 3; i++)
        for (int j = n; j < 3; j++)
            if (a.p[i] == b.p[j]) {
                std::swap(a.p[i], a.p[n]);
                std::swap(b.p[j], b.p[n]);
                n++;
                break;
            }
    return n;
}

enum { ABOVE = 1, BELOW = 2, ON = 4 };

/* The sides of the plane of a on which the corners of b from k on lie. */
int plane_sides(const corners &a, const corners &b, int k)
{
    int seen = 0;
    for (; k < 3; k++) {
        const auto o = CGAL::orientation(a.p[0], a.p[1], a.p[2], b.p[k]);
        seen |= o == CGAL::POSITIVE ? ABOVE : o == CGAL::NEGATIVE ? BELOW : ON;
    }
    return seen;
}

bool straddles(int seen) { return (seen & ABOVE) && (seen & BELOW); }

Exact::Triangle_3 exact_triangle(const corners &c)
{
    Exact::Point_3 p[3];
    for (int k = 0; k < 3; k++) p[k] = Exact::Point_3(c.p[k].x(), c.p[k].y(), c.p[k].z());
    return Exact::Triangle_3(p[0], p[1], p[2]);
}

relation relation_of(corners a, corners b)
{
    const int shared = move_common_first(a, b);
    if (shared == 3) return CROSS; /* the triangles coincide */
    const int b_at = plane_sides(a, b, shared);
    if (b_at == ABOVE || b_at == BELOW) return APART; /* apart but for the common corners */
    if (shared == 2)                                  /* and b_at == ON */
        return CGAL::coplanar_orientation(a.p[0], a.p[1], a.p[2], b.p[2]) == CGAL::POSITIVE ? CROSS : APART;
    const int a_at = plane_sides(b, a, shared);
    if (a_at == ABOVE || a_at == BELOW) return APART;
    const Kernel::Triangle_3 ta(a.p[0], a.p[1], a.p[2]), tb(b.p[0], b.p[1], b.p[2]);
    if (shared == 1) {
        if (!CGAL::do_intersect(Kernel::Segment_3(a.p[1], a.p[2]), tb) &&
            !CGAL::do_intersect(Kernel::Segment_3(b.p[1], b.p[2]), ta))
            return APART;
    } else if (!CGAL::do_intersect(ta, tb)) {
        return APART;
    }
    const bool flat = b_at == ON;
    if (!flat && !(straddles(a_at) && straddles(b_at))) return TOUCH;
    const auto both = CGAL::intersection(exact_triangle(a), exact_triangle(b));
    if (!both || boost::get<Exact::Point_3>(&*both)) return TOUCH;
    if (boost::get<Exact::Segment_3>(&*both)) return flat ? TOUCH : CROSS;
    return CROSS;
}

corners corners_at(const double *x)
{
    return corners{{Point(x[0], x[1], x[2]), Point(x[3], x[4], x[5]), Point(x[6], x[7], x[8])}};
}

bool is_degenerate(const corners &c) { return CGAL::collinear(c.p[0], c.p[1], c.p[2]); }

int count_crossings(const fl_soup *s, fl_crossing *c)
{
    std::vector<Box> boxes;
    boxes.reserve(static_cast<std::size_t>(s->nt));
    for (int32_t t = 0; t < s->nt; t++) {
        const corners k = corners_of(s, t);
        if (is_degenerate(k)) continue;
        boxes.emplace_back(k.p[0].bbox() + k.p[1].bbox() + k.p[2].bbox(), t);
    }
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box &x, const Box &y) {
        const int32_t t = std::min(x.info(), y.info()), u = std::max(x.info(), y.info());
        const relation m = relation_of(corners_of(s, t), corners_of(s, u));
        c->crossings += m == CROSS;
        c->touching += m == TOUCH;
    });
    return 0;
}

/* --- distance -------------------------------------------------------------------------------------- */

using Plain = CGAL::Simple_cartesian<double>;
using Triangle = Plain::Triangle_3;
using Primitive = CGAL::AABB_triangle_primitive<Plain, std::vector<Triangle>::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Plain, Primitive>>;

const double RELATIVE_TOL = 0.01; /* relative tolerance of the distance */
const double GAIN = 0.9;     /* a cut that leaves a bound above this fraction of its parent's was useless */
const int MAX_VAIN_CUTS = 4; /* after this many useless cuts in a row the piece is halved */

using Vec = Plain::Vector_3;

struct piece {
    Vec x[3];
    double bound; /* upper bound of the distance of its points */
    int vain;     /* useless cuts in a row */
};

Vec vec(const Plain::Point_3 &p) { return p - CGAL::ORIGIN; }
Plain::Point_3 point(const Vec &x) { return CGAL::ORIGIN + x; }
double length(const Vec &x) { return std::sqrt(x.squared_length()); }

std::vector<Triangle> triangles_of(const fl_soup *s)
{
    std::vector<Triangle> list;
    list.reserve(static_cast<std::size_t>(s->nt));
    for (std::ptrdiff_t t = 0; t < s->nt; t++) {
        Plain::Point_3 p[3];
        for (int k = 0; k < 3; k++) {
            const double *x = s->x + 3 * static_cast<std::ptrdiff_t>(s->t[3 * t + k]);
            p[k] = Plain::Point_3(x[0], x[1], x[2]);
        }
        list.emplace_back(p[0], p[1], p[2]);
    }
    return list;
}

double distance_to(const Vec &x, const Triangle &t) { return std::sqrt(CGAL::squared_distance(point(x), t)); }

double max_corner_distance(const piece &p, const Triangle &t)
{
    return std::max({distance_to(p.x[0], t), distance_to(p.x[1], t), distance_to(p.x[2], t)});
}

/* Cuts a convex polygon by the plane through o with outward normal n: `in` gets the part behind it, `out` the
 * rest. */
void cut_polygon(const std::vector<Vec> &whole, const Vec &o, const Vec &n, std::vector<Vec> &in,
                 std::vector<Vec> &out)
{
    const std::size_t count = whole.size();
    bool before = false, behind = false; /* strictly */
    in.clear();
    out.clear();
    for (std::size_t k = 0; k < count; k++) {
        const Vec a = whole[k], b = whole[(k + 1) % count];
        const double da = n * (a - o), db = n * (b - o);
        before = before || da > 0.0;
        behind = behind || da < 0.0;
        if (da <= 0.0) in.push_back(a);
        if (da >= 0.0) out.push_back(a);
        if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) {
            const Vec x = a + da / (da - db) * (b - a);
            in.push_back(x);
            out.push_back(x);
        }
    }
    if (!before) out.clear(); /* a polygon in the plane is behind it */
    else if (!behind) in.clear();
}

/* Branch and bound: the piece with the largest bound is split next, so that the largest bound left always
 * bounds all pieces. */
class search
{
  public:
    search(const std::vector<Triangle> &to, double tolerance, std::size_t limit)
        : tree(to.begin(), to.end()), tol(tolerance), room(limit)
    {
        tree.accelerate_distance_queries();
    }

    void run(const std::vector<Triangle> &from)
    {
        for (const Triangle &t : from)
            for (int k = 0; k < 3; k++) nearest(vec(t[k]));
        for (const Triangle &t : from) push({{vec(t[0]), vec(t[1]), vec(t[2])}, INFINITY, 0});
        room += open.size();
        while (!open.empty() && !settled(open.front().bound) && open.size() < room && made < room) {
            std::pop_heap(open.begin(), open.end(), lower);
            const piece p = open.back();
            open.pop_back();
            split(p);
        }
        if (!open.empty()) most = std::max(most, open.front().bound);
    }

    double least = 0.0, most = 0.0;

  private:
    Tree tree;
    double tol;
    std::size_t room, made = 0;
    std::vector<piece> open; /* a heap */

    static bool lower(const piece &p, const piece &q) { return p.bound < q.bound; }

    /* The triangle nearest to x.  The distance of x is a lower bound and updates `least`. */
    const Triangle &nearest(const Vec &x)
    {
        const auto found = tree.closest_point_and_primitive(point(x));
        least = std::max(least, length(vec(found.first) - x));
        return *found.second;
    }

    bool settled(double bound) const { return bound <= least + tol + RELATIVE_TOL * least; }

    void push(piece p)
    {
        const Vec middle = (p.x[0] + p.x[1] + p.x[2]) / 3.0;
        const Triangle &s = nearest(middle);
        const double before = p.bound;
        double corner = 0.0, size = 0.0;
        made++;
        p.bound = std::min(p.bound, max_corner_distance(p, s));
        for (int k = 0; k < 3 && !settled(p.bound); k++) {
            const Triangle &c = nearest(p.x[k]);
            p.bound = std::min(p.bound, max_corner_distance(p, c));
            corner = std::max(corner, distance_to(p.x[k], c));
            size = std::max(size, length(p.x[k] - middle));
            /* no point is farther from all corners than the middle is from one, and the distance function has
             * Lipschitz constant 1 */
            if (k == 2) p.bound = std::min(p.bound, corner + size);
        }
        if (settled(p.bound)) {
            most = std::max(most, p.bound);
        } else {
            if (p.bound < GAIN * before) p.vain = 0;
            open.push_back(p);
            std::push_heap(open.begin(), open.end(), lower);
        }
    }

    void fan(const std::vector<Vec> &polygon, double bound, int vain)
    {
        for (std::size_t k = 2; k < polygon.size(); k++)
            push({{polygon[0], polygon[k - 1], polygon[k]}, bound, vain});
    }

    void halve(const piece &p)
    {
        int longest = 0;
        double most_so_far = -1.0;
        for (int k = 0; k < 3; k++) {
            const double l = (p.x[(k + 1) % 3] - p.x[k]).squared_length();
            if (l > most_so_far) {
                most_so_far = l;
                longest = k;
            }
        }
        const Vec a = p.x[longest], b = p.x[(longest + 1) % 3], c = p.x[(longest + 2) % 3];
        const Vec m = 0.5 * (a + b);
        push({{a, m, c}, p.bound, 0});
        push({{m, b, c}, p.bound, 0});
    }

    /* Cuts along the prism over the triangle nearest to the middle.  Halves the piece where this does not cut
     * it, or where such cuts only trim it, as slivers and small triangles do with distant pieces. */
    void split(const piece &p)
    {
        if (p.vain >= MAX_VAIN_CUTS) {
            halve(p);
            return;
        }
        const Triangle &s = nearest((p.x[0] + p.x[1] + p.x[2]) / 3.0);
        const Vec a[3] = {vec(s[0]), vec(s[1]), vec(s[2])};
        const Vec n = CGAL::cross_product(a[1] - a[0], a[2] - a[0]);
        std::vector<Vec> rest(p.x, p.x + 3), in, out;
        std::vector<std::vector<Vec>> outside;
        double bound = 0.0;
        for (int k = 0; k < 3; k++) {
            cut_polygon(rest, a[k], CGAL::cross_product(a[(k + 1) % 3] - a[k], n), in, out);
            if (in.size() < 3) { /* no part of it is over the triangle */
                halve(p);
                return;
            }
            if (out.size() >= 3) outside.push_back(out);
            rest = in;
        }
        if (outside.empty()) {
            halve(p);
            return;
        }
        for (const Vec &x : rest) bound = std::max(bound, distance_to(x, s));
        fan(rest, std::min(bound, p.bound), p.vain + 1);
        for (const auto &polygon : outside) fan(polygon, p.bound, p.vain + 1);
    }
};

int distance(const fl_soup *a, const fl_soup *b, double tol, double *least, double *most)
{
    const std::vector<Triangle> from = triangles_of(a), to = triangles_of(b);
    search h(to, tol, 100 * (from.size() + to.size()));
    h.run(from);
    *least = h.least;
    *most = std::max(h.least, h.most);
    return 0;
}

/* --- remeshing ------------------------------------------------------------------------------------- */

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

/* --- simplification -------------------------------------------------------------------------------- */

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

/* --- sides ----------------------------------------------------------------------------------------- */

using Facet = Kernel::Triangle_3;

std::vector<Facet> facets_of(const fl_soup *s)
{
    std::vector<Facet> all;
    for (int32_t t = 0; t < s->nt; t++) {
        const corners c = corners_of(s, t);
        all.emplace_back(c.p[0], c.p[1], c.p[2]);
    }
    return all;
}

/* Squared distance of two boxes: no triangles in them are nearer. */
double box_distance2(const CGAL::Bbox_3 &a, const CGAL::Bbox_3 &b)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const double apart = std::max({a.min(k) - b.max(k), b.min(k) - a.max(k), 0.0});
        sum += apart * apart;
    }
    return sum;
}

Exact::Triangle_3 exactly(const Facet &t)
{
    const auto point = [](const Point &p) { return Exact::Point_3(p.x(), p.y(), p.z()); };
    return {point(t[0]), point(t[1]), point(t[2])};
}
} // namespace

extern "C" int fl_cgal_crossings(const fl_soup *s, fl_crossing *c, fl_err *err)
{
    *c = fl_crossing{0, 0};
    return run_guarded("search for crossings", s->nt, err, [&] { return count_crossings(s, c); });
}

extern "C" int fl_cgal_classify_triangles(const double *a, const double *b, fl_err *err)
{
    return catch_errors("meeting", 2, err, [&]() -> int {
        const corners p = corners_at(a), q = corners_at(b);
        return is_degenerate(p) || is_degenerate(q) ? APART : relation_of(p, q);
    });
}

extern "C" int fl_cgal_distance(const fl_soup *a, const fl_soup *b, double tol, double *least, double *most,
                                fl_err *err)
{
    return run_guarded("distance", a->nt, err, [&] { return distance(a, b, tol, least, most); });
}

extern "C" int fl_cgal_remesh(fl_soup *s, double length, fl_err *err)
{
    return run_guarded("remeshing", s->nt, err, [&] { return remesh(s, length, err); });
}

extern "C" int fl_cgal_simplify(fl_soup *s, double distance, int32_t *removed, fl_err *err)
{
    *removed = 0;
    return run_guarded("simplification", s->nt, err, [&] { return simplify(s, distance, removed, err); });
}

struct fl_cgal_oracle {
    Mesh mesh;
    std::vector<Facet> triangle;
    std::vector<CGAL::Bbox_3> box;
    std::unique_ptr<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side;
};

extern "C" fl_cgal_oracle *fl_cgal_oracle_make(const fl_soup *s, fl_err *err)
{
    auto o = std::make_unique<fl_cgal_oracle>();
    const int rc = run_guarded("oracle", s->nt, err, [&] {
        std::vector<Point> points;
        std::vector<Corners> corners;
        to_vectors(s, points, corners);
        if (to_mesh(points, corners, o->mesh, err)) return -1;
        o->triangle = facets_of(s);
        for (const Facet &t : o->triangle) o->box.push_back(t.bbox());
        if (CGAL::is_closed(o->mesh))
            o->side = std::make_unique<CGAL::Side_of_triangle_mesh<Mesh, Kernel>>(o->mesh);
        return 0;
    });
    return rc ? nullptr : o.release();
}

extern "C" int fl_cgal_oracle_side(const fl_cgal_oracle *o, const double x[3])
{
    if (!o->side) return 0;
    const CGAL::Bounded_side side = (*o->side)(Point(x[0], x[1], x[2]));
    return side == CGAL::ON_BOUNDED_SIDE ? 1 : side == CGAL::ON_UNBOUNDED_SIDE ? -1 : 0;
}

extern "C" double fl_cgal_oracle_distance(const fl_cgal_oracle *o, const fl_soup *other)
{
    double best = HUGE_VAL;
    const Facet *nearest[2] = {nullptr, nullptr};
    const std::vector<Facet> all = facets_of(other);
    for (const Facet &u : all) {
        const CGAL::Bbox_3 box = u.bbox();
        for (std::size_t k = 0; k < o->triangle.size(); k++) {
            if (box_distance2(box, o->box[k]) >= best) continue;
            const double d2 = CGAL::squared_distance(o->triangle[k], u);
            if (d2 < best) best = d2, nearest[0] = &o->triangle[k], nearest[1] = &u;
        }
    }
    if (!nearest[0] || CGAL::do_intersect(*nearest[0], *nearest[1])) return nearest[0] ? 0.0 : best;
    return std::sqrt(CGAL::to_double(CGAL::squared_distance(exactly(*nearest[0]), exactly(*nearest[1]))));
}

extern "C" double fl_cgal_oracle_point_distance(const fl_cgal_oracle *o, const double x[3])
{
    const Point at(x[0], x[1], x[2]);
    double best = HUGE_VAL;
    for (std::size_t k = 0; k < o->triangle.size(); k++)
        if (box_distance2(at.bbox(), o->box[k]) < best)
            best = std::min(best, CGAL::to_double(CGAL::squared_distance(o->triangle[k], at)));
    return std::sqrt(best);
}

extern "C" void fl_cgal_oracle_free(fl_cgal_oracle *o) { delete o; }
