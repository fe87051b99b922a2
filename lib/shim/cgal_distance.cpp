/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The header is plain C; no C++ name and no exception leaves this file. */
#include <algorithm>
#include <cmath>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include "shim/cgal_mesh.hpp"
extern "C" {
#include "shim/cgal_distance.h"
}

namespace
{
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
} // namespace

extern "C" int fl_cgal_distance(const fl_soup *a, const fl_soup *b, double tol, double *least, double *most,
                                fl_err *err)
{
    return shim::run_guarded("distance", a->nt, err, [&] { return distance(a, b, tol, least, most); });
}
