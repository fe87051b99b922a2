/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Invariants of volume, moments, cuts and buoyancy of convex bodies. */
#include <stdio.h>
#include "geom/clip.h"
#include "geom/dilate.h"
#include "geom/mass.h"
#include "support/near.h"
#include "support/shapes.h"
#include "water/buoyancy.h"

static long current_case; /* the current case */

static int print_case(void **state)
{
    (void)state;
    print_message("seed %llu case %ld\n", (unsigned long long)test_seed(), current_case);
    return 0;
}

/* Next case, with its own generator. */
static fl_rng next_case(long k, int64_t law)
{
    current_case = k;
    return fl_rng_of(test_seed(), 1000 * k + law, FL_RNG_TEST);
}

static fl_mass mass_of(const fl_poly *p, double r)
{
    fl_err err = {0};
    fl_mass m = {0};
    if (fl_mass_of(&m, p, r, &err)) fail_msg("%s", err.text);
    return m;
}

static void extent(const fl_poly *p, fl_vec3 n, double *lo, double *hi)
{
    *lo = INFINITY;
    *hi = -INFINITY;
    for (int32_t v = 0; v < p->nv; v++) {
        *lo = fmin(*lo, v3_dot(n, p->v[v]));
        *hi = fmax(*hi, v3_dot(n, p->v[v]));
    }
}

/* A plane of one of several kinds: anywhere, through a vertex, an edge, three vertices, or along a face,
 * exactly or with an offset of 1e-16 to 1e-4. */
static void pick_plane(const fl_poly *p, fl_rng *g, fl_vec3 *n, double *c)
{
    const double kind = fl_rng_unit(g);
    const int32_t v = (int32_t)fl_rng_in(g, 0, p->nv), f = (int32_t)fl_rng_in(g, 0, p->nf),
                  e = (int32_t)fl_rng_in(g, 0, p->ne);
    const double off =
        fl_rng_unit(g) < 0.5 ? 0.0 : (fl_rng_unit(g) < 0.5 ? -1 : 1) * pow(10.0, fl_rng_in(g, -16, -4));
    double lo, hi;
    *n = shape_direction(g);
    if (kind < 0.4) {
        extent(p, *n, &lo, &hi);
        *c = fl_rng_in(g, lo, hi);
        return;
    }
    if (kind < 0.55) {
        *c = v3_dot(*n, p->v[v]);
    } else if (kind < 0.7) {
        *n = v3_unit(v3_cross(*n, v3_sub(p->v[p->edge[e].b], p->v[p->edge[e].a])));
        *c = v3_dot(*n, p->v[p->edge[e].a]);
    } else if (kind < 0.85) {
        const fl_vec3 m = v3_cross(v3_sub(p->v[p->edge[e].b], p->v[v]), v3_sub(p->v[p->edge[e].a], p->v[v]));
        if (v3_norm(m) > 1e-6 * p->size * p->size) *n = v3_unit(m);
        *c = v3_dot(*n, p->v[v]);
    } else {
        *n = v3_unit(v3_madd(p->n[f], off, *n));
        *c = v3_dot(*n, p->v[p->loop[p->first[f]]]);
    }
    *c += off * p->size;
}

static double area_of(const fl_poly *p)
{
    double a = 0.0;
    for (int32_t f = 0; f < p->nf; f++) a += v3_norm(fl_poly_face_area_vector(p, f));
    return a;
}

/* True if a vertex is near the plane but not on it: a cut may treat it as on the plane, up to 5e-10 of the
 * size. */
static int vertex_beside_plane(const fl_poly *p, fl_vec3 n, double c)
{
    for (int32_t v = 0; v < p->nv; v++) {
        const double s = fabs(v3_dot(n, p->v[v]) - c) / p->size;
        if (s > 1e-15 && s < 1e-7) return 1;
    }
    return 0;
}

/* Error bound of a cut over the volume: rounding, or the vertices that it moves onto the plane, on either
 * side. */
static double cut_tolerance(const fl_poly *p, fl_vec3 n, double c, double volume)
{
    return (vertex_beside_plane(p, n, c) ? 1e-9 : 1e-14) * p->size * area_of(p) / volume;
}

/* The parts of a cut add up to the whole: volume, first and second moments, surface less twice the cut. */
static void parts_add_up_to_the_whole(void **state)
{
    (void)state;
    long thin = 0, n = test_times(20000);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 0);
        fl_err err = {0};
        fl_poly p, half[2];
        fl_vec3 normal, sum = {0};
        double c, v = 0.0, xx = 0.0, surface = 0.0;
        int rc = 0;
        shape_random(&p, &g);
        pick_plane(&p, &g, &normal, &c);
        const fl_mass whole = mass_of(&p, 0.0);
        for (int s = 0; s < 2; s++) assert_int_equal(fl_poly_copy(&half[s], &p, &err), 0);
        for (int s = 0; s < 2; s++)
            rc |= fl_poly_cut(&half[s], v3_scale(s ? -1 : 1, normal), s ? -c : c, &err);
        if (rc) {
            if (err.code != FL_NUMERIC) fail_msg("%s", err.text);
            thin++;
        }
        double cut[2] = {0};
        for (int s = 0; s < 2 && !rc; s++) {
            if (!half[s].nv) continue;
            fl_mass m;
            if (fl_mass_of(&m, &half[s], 0.0, &err)) { /* a needle: practically no volume */
                rc = -1;
                thin++;
                break;
            }
            const fl_vec3 d = v3_sub(m.centre, whole.centre);
            v += m.volume;
            sum = v3_madd(sum, m.volume, d);
            xx += m.second.m[0][0] + m.second.m[1][1] + m.second.m[2][2] + m.volume * v3_norm2(d);
            surface += area_of(&half[s]);
            cut[s] = half[s].nf ? v3_norm(fl_poly_face_area_vector(&half[s], half[s].nf - 1)) : 0.0;
            assert_int_equal(half[s].nv - half[s].ne + half[s].nf, 2);
        }
        const double tol = cut_tolerance(&p, normal, c, whole.volume);
        if (!rc) {
            assert_near(v, whole.volume, tol);
            assert_near_of(v3_norm(sum), 0.0, tol, whole.volume * p.size);
            assert_near(xx, whole.second.m[0][0] + whole.second.m[1][1] + whole.second.m[2][2], 10 * tol);
            /* near a face the outline of the cut, unlike the volume, has an error of 5e-10 / tilt */
            if (half[0].nv && half[1].nv && !vertex_beside_plane(&p, normal, c)) {
                assert_near_of(cut[0], cut[1], 1e-12, area_of(&p));
                assert_near_of(surface, area_of(&p) + cut[0] + cut[1], 1e-12, area_of(&p));
            }
        }
        fl_poly_free(&p);
        for (int s = 0; s < 2; s++) fl_poly_free(&half[s]);
    }
    print_message("%ld of %ld cuts left too thin a slice\n", thin, n);
    assert_true(thin * 500 < n);
}

/* Moments rotate with the body, scale with the fifth power, and do not depend on its position. */
static void moments_rotate_with_the_body(void **state)
{
    (void)state;
    const long n = test_times(5000);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 1);
        fl_poly p, q;
        shape_random(&p, &g);
        const double s = pow(10.0, fl_rng_in(&g, -3, 3)),
                     r = fl_rng_unit(&g) < 0.5 ? 0.0 : fl_rng_in(&g, 0.0, 0.5);
        const fl_quat turn = shape_rotation(&g);
        const fl_vec3 d = v3_scale(s * fl_rng_in(&g, 0, 3), shape_direction(&g));
        shape_copy_moved(&q, &p, s, turn, d);
        const fl_mass a = mass_of(&p, r), b = mass_of(&q, s * r);
        const double s3 = s * s * s, s5 = s3 * s * s, trace = a.inertia.x + a.inertia.y + a.inertia.z;
        const double tol =
            1e-13 * (a.volume + p.size * area_of(&p)) / a.volume; /* the surface terms cancel */
        assert_near(b.volume, s3 * a.volume, tol);
        assert_near_of(b.inertia.x / s5, a.inertia.x, tol, trace);
        assert_near_of(b.inertia.y / s5, a.inertia.y, tol, trace);
        assert_near_of(b.inertia.z / s5, a.inertia.z, tol, trace);
        assert_true(b.inertia.x <= b.inertia.y && b.inertia.y <= b.inertia.z);
        assert_true(b.inertia.x + b.inertia.y >= b.inertia.z * (1 - 1e-12));
        const fl_vec3 c = v3_madd(d, s, q_rotate(turn, a.centre));
        assert_near_of(v3_norm(v3_sub(b.centre, c)), 0.0, 10 * tol, s * p.size + v3_norm(d));
        const fl_mat3 m = q_matrix(turn);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                double want = 0.0;
                for (int u = 0; u < 3; u++)
                    for (int w = 0; w < 3; w++) want += m.m[i][u] * a.second.m[u][w] * m.m[j][w];
                assert_near_of(b.second.m[i][j] / s5, want, tol, trace);
            }
        fl_poly_free(&p);
        fl_poly_free(&q);
    }
}

/* Steiner's sum equals fl_mass_of(); its derivative is the area. */
static void steiner_formula_holds(void **state)
{
    (void)state;
    const long n = test_times(5000);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 2);
        fl_poly p;
        shape_random(&p, &g);
        const double r = p.size * fl_rng_in(&g, 0.0, 1.0), h = 1e-5 * p.size;
        assert_near(mass_of(&p, r).volume, fl_dilate_volume(&p, r),
                    1e-13 * (1 + p.size * area_of(&p) / fl_dilate_volume(&p, r)));
        const double slope = (fl_dilate_volume(&p, r + h) - fl_dilate_volume(&p, r + 0.0)) / h;
        const double mid = fl_dilate_area(&p, r + 0.5 * h);
        assert_near(slope, mid,
                    1e-9 * (1 + p.size * p.size / mid + fl_dilate_volume(&p, r) / (mid * p.size)));
        fl_poly_free(&p);
    }
}

/* Faces that are moved out and in again return to their place; each face lies at c + r; the outer shape
 * contains P + B(r). */
static void faces_move_by_the_offset(void **state)
{
    (void)state;
    long back = 0, n = test_times(5000);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 3);
        fl_err err = {0};
        fl_poly p, q, b;
        shape_random(&p, &g);
        const double r = p.size * pow(10.0, fl_rng_in(&g, -4, -0.5));
        if (fl_poly_offset(&q, &p, r, &err)) {
            /* only a corner sharper than 1e-4 moves so far */
            if (err.code != FL_INPUT) fail_msg("%s", err.text);
            fl_poly_free(&p);
            continue;
        }
        assert_true(mass_of(&q, 0.0).volume >= fl_dilate_volume(&p, r) * (1 - 1e-9));
        for (int32_t f = 0; f < q.nf; f++) {
            double best = INFINITY;
            for (int32_t e = 0; e < p.nf; e++)
                best = fmin(best, v3_norm(v3_sub(p.n[e], q.n[f])) + fabs(p.c[e] + r - q.c[f]) / q.size);
            assert_near_of(best, 0.0, 1e-6, 1.0); /* normals of narrow faces have this error */
        }
        for (int32_t f = 0; f < p.nf; f++) /* no plane is violated */
            for (int32_t v = 0; v < q.nv; v++)
                assert_true(v3_dot(p.n[f], q.v[v]) <= p.c[f] + r + 1e-9 * q.size);
        if (q.nf == p.nf) {
            if (fl_poly_offset(&b, &q, -r, &err)) fail_msg("%s", err.text);
            assert_near(mass_of(&b, 0.0).volume, mass_of(&p, 0.0).volume,
                        1e-8 * q.size * area_of(&q) / mass_of(&p, 0.0).volume);
            back += b.nv == p.nv;
            fl_poly_free(&b);
        }
        fl_poly_free(&p);
        fl_poly_free(&q);
    }
    assert_true(back * 2 > n);
}

/* Faces move inward until nothing is left: the remainder stays inside, and the volume falls. */
static void bodies_shrink_to_nothing(void **state)
{
    (void)state;
    const long n = test_times(1000);
    long inside = 0, gone = 0;
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 4);
        fl_poly p, q;
        shape_random(&p, &g);
        double last = mass_of(&p, 0.0).volume, step = 0.04 * last / area_of(&p);
        for (int i = 1; i < 200; i++) {
            fl_err err = {0};
            if (fl_poly_offset(&q, &p, -i * step, &err)) {
                if (err.code != FL_INPUT && err.code != FL_NUMERIC) fail_msg("%s", err.text);
                gone += err.code == FL_INPUT;
                break;
            }
            const double v = mass_of(&q, 0.0).volume;
            assert_true(v < last);
            for (int32_t f = 0; f < p.nf; f++)
                for (int32_t j = 0; j < q.nv; j++)
                    assert_true(v3_dot(p.n[f], q.v[j]) <= p.c[f] - i * step + 1e-9 * p.size);
            last = v;
            inside++;
            fl_poly_free(&q);
        }
        fl_poly_free(&p);
    }
    print_message("%ld bodies vanished after %ld steps\n", gone, inside);
    assert_true(gone * 10 > 9 * n);
}

static void hull_of(fl_hull *h, const fl_poly *p, double r)
{
    fl_err err = {0};
    if (fl_hull_make(h, p, r, &err)) fail_msg("%s", err.text);
}

/* Moves the centroid to the origin, as the solver does. */
static void centre_at_origin(fl_poly *p, fl_rng *g)
{
    shape_random(p, g);
    shape_move(p, shape_rotation(g), v3(0, 0, 0));
    shape_move(p, q_one(), v3_neg(mass_of(p, 0.0).centre));
}

/* Buoyancy by cones equals that of the submerged part, obtained by cutting the body. */
static void buoyancy_is_the_wet_part(void **state)
{
    (void)state;
    const long n = test_times(10000);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 5);
        fl_err err = {0};
        fl_poly p, q;
        fl_hull h;
        fl_submerged wet;
        fl_waterplane w;
        double lo, hi;
        centre_at_origin(&p, &g);
        hull_of(&h, &p, 0.0);
        const fl_vec3 up = shape_direction(&g);
        extent(&p, up, &lo, &hi);
        const double level = fl_rng_in(&g, lo, hi);
        fl_hull_submerged(&h, up, level, &wet);
        fl_hull_waterplane(&h, up, level, &w);
        assert_int_equal(fl_poly_copy(&q, &p, &err), 0);
        if (fl_poly_cut(&q, up, level, &err) == 0 && q.nv) {
            const fl_mass m = mass_of(&q, 0.0);
            const fl_vec3 cap = fl_poly_face_area_vector(&q, q.nf - 1);
            const double tol = cut_tolerance(&p, up, level, h.volume);
            assert_near_of(wet.volume, m.volume, tol, h.volume);
            assert_near_of(v3_norm(v3_sub(v3_scale(wet.volume, wet.centre), v3_scale(m.volume, m.centre))),
                           0.0, tol, h.volume * p.size);
            if (!vertex_beside_plane(&p, up, level)) {
                assert_near_of(wet.waterplane_area, v3_norm(cap), 1e-12, h.surface_area);
                assert_near_of(w.area, v3_norm(cap), 1e-12, h.surface_area);
                assert_near_of(wet.wetted_area, area_of(&q) - v3_norm(cap), 1e-12, h.surface_area);
            }
            double polar = 0.0; /* int |x - c|^2 dA of the cut, triangle by triangle */
            const int32_t *cut = q.loop + q.first[q.nf - 1], m3 = q.first[q.nf] - q.first[q.nf - 1];
            for (int32_t i = 2; i < m3; i++) {
                const fl_vec3 x = v3_sub(q.v[cut[0]], w.centre), y = v3_sub(q.v[cut[i - 1]], w.centre),
                              z = v3_sub(q.v[cut[i]], w.centre), s = v3_add(x, v3_add(y, z));
                const double tri = 0.5 * v3_dot(up, v3_cross(v3_sub(y, x), v3_sub(z, x)));
                polar += tri / 12 * (v3_norm2(x) + v3_norm2(y) + v3_norm2(z) + v3_norm2(s));
            }
            if (!vertex_beside_plane(&p, up, level))
                assert_near_of(w.second.m[0][0] + w.second.m[1][1] + w.second.m[2][2], polar, 1e-12,
                               p.size * p.size * h.surface_area);
            assert_near_of(v3_dot(up, w.centre), level, 1e-12, p.size);
            assert_near_of(v3_norm(m3_mul(w.second, up)), 0.0, 1e-12, p.size * p.size * h.surface_area);
        }
        fl_poly_free(&q);
        /* the two sides add up to zero */
        fl_submerged dry;
        fl_hull_submerged(&h, v3_neg(up), -level, &dry);
        assert_near(wet.volume + dry.volume, h.volume, 1e-14 * p.size * h.surface_area / h.volume);
        assert_near(wet.wetted_area + dry.wetted_area, h.surface_area, 1e-13);
        assert_near_of(v3_norm(v3_add(v3_scale(wet.volume, wet.centre), v3_scale(dry.volume, dry.centre))),
                       0.0, 1e-14 * p.size * h.surface_area / h.volume, h.volume * p.size);
        fl_hull_free(&h);
        fl_poly_free(&p);
    }
}

/* Energy of one body under a displaced and rotated water plane: U(dz, dphi). */
static double energy_at(const fl_hull *h, fl_vec3 up, double level, double dz, fl_vec3 turn, double *plane)
{
    /* Raising the body lowers the water level over it; rotating the body by `turn` (body axes) rotates `up`
     * back. */
    const fl_vec3 u = m3_tmul(q_matrix(q_of_vector(turn)), up);
    fl_vec3 f, m;
    fl_submerged w;
    fl_hull_submerged(h, u, level - dz, &w);
    if (plane) *plane = w.waterplane_area;
    return fl_buoyancy_force(&w, u, level - dz, 1.0, &f, &m);
}

/* Force and moment are the gradient of the energy.  Central differences have an error of h^2 times the
 * third derivative, which jumps where the plane passes a vertex, and of rounding over h. */
static void force_is_the_gradient(void **state)
{
    (void)state;
    const long n = test_times(10000);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 6);
        fl_err err = {0};
        fl_poly p;
        fl_hull h;
        fl_submerged wet;
        fl_vec3 f, m;
        double lo, hi, round = 0.0;
        const double kind = fl_rng_unit(&g);
        if (kind < 0.8) {
            centre_at_origin(&p, &g);
        } else {
            const fl_vec3 e = v3_scale(fl_rng_in(&g, 0.01, 2.0), shape_direction(&g)), v[2] = {e, v3_neg(e)};
            round = fl_rng_in(&g, 0.1, 1.0);
            assert_int_equal(fl_poly_make(&p, kind < 0.9 ? 1 : 2, v, 0, NULL, NULL, &err), 0);
        }
        hull_of(&h, &p, round);
        const fl_vec3 up = shape_direction(&g);
        extent(&p, up, &lo, &hi);
        const double size = p.size + round, level = fl_rng_in(&g, lo - round, hi + round);
        fl_hull_submerged(&h, up, level, &wet);
        fl_buoyancy_force(&wet, up, level, 1.0, &f, &m);
        const double d = 1e-5 * (hi - lo + 2 * round), tol = 2e-6 * h.volume;
        const double dz = (energy_at(&h, up, level, d, v3(0, 0, 0), NULL) -
                           energy_at(&h, up, level, -d, v3(0, 0, 0), NULL)) /
                          (2 * d);
        assert_near_of(-dz, v3_dot(f, up), 1.0, tol);
        for (int axis = 0; axis < 3; axis++) {
            const double a = d / size;
            const fl_vec3 t = v3(axis == 0, axis == 1, axis == 2);
            const double du = (energy_at(&h, up, level, 0, v3_scale(a, t), NULL) -
                               energy_at(&h, up, level, 0, v3_scale(-a, t), NULL)) /
                              (2 * a);
            assert_near_of(-du, v3_dot(m, t), 1.0, tol * size);
        }
        /* and the slope of the volume is the water plane: dV/dlevel */
        fl_submerged a, b;
        fl_hull_submerged(&h, up, level + d, &a);
        fl_hull_submerged(&h, up, level - d, &b);
        double least = fmin(a.waterplane_area, fmin(b.waterplane_area, wet.waterplane_area)),
               most = fmax(a.waterplane_area, fmax(b.waterplane_area, wet.waterplane_area));
        const double slope = (a.volume - b.volume) / (2 * d), room = (most - least) + 1e-8 * h.surface_area;
        assert_true(slope >= least - room && slope <= most + room);
        fl_hull_free(&h);
        fl_poly_free(&p);
    }
}

/* The level moves by 1e-9 of the size: the volume changes by no more than that times the surface, also
 * through vertices, edges and faces. */
static void volume_is_continuous(void **state)
{
    (void)state;
    const long n = test_times(10000);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 7);
        fl_poly p;
        fl_hull h;
        fl_submerged w[3];
        fl_vec3 up;
        double level;
        centre_at_origin(&p, &g);
        hull_of(&h, &p, 0.0);
        pick_plane(&p, &g, &up, &level);
        const double d = 1e-9 * p.size;
        for (int i = 0; i < 3; i++) fl_hull_submerged(&h, up, level + (i - 1) * d, &w[i]);
        const double plane = h.surface_area, eps = 1e-14 * p.size * h.surface_area;
        for (int i = 0; i < 2; i++) {
            const double dv = w[i + 1].volume - w[i].volume;
            assert_true(dv >= -eps && dv <= plane * d + eps);
            const fl_vec3 dm =
                v3_sub(v3_scale(w[i + 1].volume, w[i + 1].centre), v3_scale(w[i].volume, w[i].centre));
            assert_true(v3_norm(dm) <= p.size * (plane * d + eps) * 2);
        }
        fl_hull_free(&h);
        fl_poly_free(&p);
    }
}

/* A capsule against polyhedra that converge to it from outside and inside. */
static void capsule_lies_between_polyhedra(void **state)
{
    (void)state;
    enum { N = 48, M = 16 }; /* corners round, rings per cap */
    const double pi = 3.141592653589793;
    const long n = test_times(60);
    for (long k = 0; k < n; k++) {
        fl_rng g = next_case(k, 8);
        fl_err err = {0};
        const double len = fl_rng_in(&g, 0.05, 4.0), r = fl_rng_in(&g, 0.2, 1.0);
        static fl_vec3 v[2 * M * N];
        static int32_t loop[8 * M * N], first[2 * M * N + 3];
        fl_poly axis, p;
        fl_hull h, hp;
        fl_submerged a, b;
        int32_t nf = 0, nl = 0;
        for (int i = 0; i < 2 * M; i++) {
            const double t = i < M ? -0.5 * pi * (1 - (i + 0.5) / M) : 0.5 * pi * (i - M + 0.5) / M;
            for (int j = 0; j < N; j++)
                v[i * N + j] = v3(r * cos(t) * cos(2 * pi * j / N), r * cos(t) * sin(2 * pi * j / N),
                                  r * sin(t) + (i < M ? -0.5 : 0.5) * len);
        }
        for (int j = 0; j < N; j++) loop[nl++] = N - 1 - j;
        first[++nf] = nl;
        for (int i = 0; i + 1 < 2 * M; i++)
            for (int j = 0; j < N; j++) {
                const int32_t s = i * N + j, t = i * N + (j + 1) % N;
                loop[nl++] = s;
                loop[nl++] = t;
                loop[nl++] = t + N;
                loop[nl++] = s + N;
                first[++nf] = nl;
            }
        for (int j = 0; j < N; j++) loop[nl++] = (2 * M - 1) * N + j;
        first[++nf] = nl;
        if (fl_poly_make(&p, 2 * M * N, v, nf, first, loop, &err)) fail_msg("%s", err.text);
        const fl_vec3 ends[2] = {{0, 0, -0.5 * len}, {0, 0, 0.5 * len}};
        assert_int_equal(fl_poly_make(&axis, 2, ends, 0, NULL, NULL, &err), 0);
        hull_of(&h, &axis, r);
        hull_of(&hp, &p, 0.0);
        const fl_vec3 up = shape_direction(&g);
        const double level = fl_rng_in(&g, -1, 1) * (0.5 * len * fabs(up.z) + r);
        fl_hull_submerged(&h, up, level, &a);
        fl_hull_submerged(&hp, up, level, &b);
        assert_near_of(b.volume, a.volume, 0.012, h.volume);
        assert_near_of(v3_norm(v3_sub(v3_scale(b.volume, b.centre), v3_scale(a.volume, a.centre))), 0.0,
                       0.012, h.volume * (len + r));
        assert_near_of(b.wetted_area, a.wetted_area, 0.012, h.surface_area);
        assert_near_of(b.waterplane_area, a.waterplane_area, 0.012, h.surface_area);
        fl_submerged dry;
        fl_hull_submerged(&h, v3_neg(up), -level, &dry);
        assert_near(a.volume + dry.volume, h.volume, 1e-12);
        assert_near(a.wetted_area + dry.wetted_area, h.surface_area, 1e-12);
        fl_hull_free(&h);
        fl_hull_free(&hp);
        fl_poly_free(&p);
        fl_poly_free(&axis);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(parts_add_up_to_the_whole, print_case),
        cmocka_unit_test_teardown(moments_rotate_with_the_body, print_case),
        cmocka_unit_test_teardown(steiner_formula_holds, print_case),
        cmocka_unit_test_teardown(faces_move_by_the_offset, print_case),
        cmocka_unit_test_teardown(bodies_shrink_to_nothing, print_case),
        cmocka_unit_test_teardown(buoyancy_is_the_wet_part, print_case),
        cmocka_unit_test_teardown(force_is_the_gradient, print_case),
        cmocka_unit_test_teardown(volume_is_continuous, print_case),
        cmocka_unit_test_teardown(capsule_lies_between_polyhedra, print_case),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
