/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_mesh.hpp -- common parts of the mesh shims: conversion between a soup and a CGAL mesh, and the
 * boundary that no exception and no printed message crosses.  C++, for the shims only. */
#ifndef FL_SHIM_CGAL_MESH_HPP
#define FL_SHIM_CGAL_MESH_HPP
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <array>
#include <cstring>
#include <exception>
#include <new>
#include <vector>
#include <CGAL/assertions.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
extern "C" {
#include "base/array.h"
#include "shim/cgal_repair.h"
}

namespace shim
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Corners = std::array<std::size_t, 3>;

inline void ignore_message(const char *, const char *, const char *, int, const char *) {}

/* CGAL would print a failed assertion before it throws; the caller reports it instead. */
struct silenced_handlers {
    CGAL::Failure_function error = CGAL::set_error_handler(ignore_message);
    CGAL::Failure_function warning = CGAL::set_warning_handler(ignore_message);
    silenced_handlers() = default;
    silenced_handlers(const silenced_handlers &) = delete;
    silenced_handlers &operator=(const silenced_handlers &) = delete;
    ~silenced_handlers()
    {
        CGAL::set_error_handler(error);
        CGAL::set_warning_handler(warning);
    }
};

/* Runs work() -> int.  An exception becomes the message "WHAT of N triangles: ..." and -1. */
template <class Work>
int catch_errors(const char *what, int32_t n, fl_err *err, Work work)
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return fl_fail(err, FL_SYSTEM, "out of memory in the %s of %d triangles", what, n);
    } catch (const CGAL::Failure_exception &e) { /* its message names lines of CGAL */
        return fl_fail(err, FL_NUMERIC, "%s of %d triangles: they violate an assumption of CGAL, \"%.80s\"",
                       what, n, e.expression().c_str());
    } catch (const std::exception &e) { /* its first line only */
        return fl_fail(err, FL_NUMERIC, "%s of %d triangles: %.*s", what, n,
                       static_cast<int>(std::strcspn(e.what(), "\n")), e.what());
    } catch (...) {
        return fl_fail(err, FL_NUMERIC, "%s of %d triangles: an unknown failure", what, n);
    }
}

/* Same with CGAL's messages silenced.  The handlers are global: not for functions called from several
 * threads. */
template <class Work>
int run_guarded(const char *what, int32_t n, fl_err *err, Work work)
{
    const silenced_handlers at_end;
    return catch_errors(what, n, err, work);
}

inline void to_vectors(const fl_soup *s, std::vector<Point> &points, std::vector<Corners> &triangles)
{
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
}

/* Converts a soup to a mesh; the surface is cut along edges of more than two triangles.  0, or -1 with
 * FL_NUMERIC. */
inline int to_mesh(std::vector<Point> &points, std::vector<Corners> &triangles, Mesh &mesh, fl_err *err)
{
    namespace PMP = CGAL::Polygon_mesh_processing;
    PMP::orient_polygon_soup(points, triangles);
    if (!PMP::is_polygon_soup_a_polygon_mesh(triangles))
        return fl_fail(err, FL_NUMERIC, "the triangles could not be cut into manifold pieces");
    PMP::polygon_soup_to_polygon_mesh(points, triangles, mesh);
    return 0;
}

inline int to_mesh(const fl_soup *s, Mesh &mesh, fl_err *err)
{
    std::vector<Point> points;
    std::vector<Corners> triangles;
    to_vectors(s, points, triangles);
    return to_mesh(points, triangles, mesh, err);
}

/* Replaces s by the mesh.  -1 with FL_SYSTEM or FL_NUMERIC, and s unchanged. */
inline int write_back(fl_soup *s, Mesh &mesh, fl_err *err)
{
    mesh.collect_garbage();
    const int64_t nv = static_cast<int64_t>(mesh.number_of_vertices());
    const int64_t nt = static_cast<int64_t>(mesh.number_of_faces());
    std::vector<int32_t> index(mesh.num_vertices(), -1);
    std::ptrdiff_t n = 0;
    if (nv > INT32_MAX || nt > INT32_MAX)
        return fl_fail(err, FL_SYSTEM, "more than 2^31 vertices after repair");
    if (!CGAL::is_triangle_mesh(mesh))
        return fl_fail(err, FL_NUMERIC, "a face that is not a triangle resulted from %d triangles", s->nt);
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
} // namespace shim

#endif
