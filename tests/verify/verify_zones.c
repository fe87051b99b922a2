/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Deformable blocks: zones of constant strain, averaged at the nodes, against closed forms.
 *   D1  column under its weight        D2  two cubes on joints        D3  wave speeds
 *   D4  axial period                   D5  quiet base                 D6  triaxial Mohr-Coulomb
 *   D7  patch test and turns           D8  two blocks pressed         D9  wave across a joint
 *   lock  tip of a 10:1:1 cantilever over that of Timoshenko
 *   slide a deformable block on a rigid bed;  books  energy of a cube that falls and slides */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/pi.h"
#include "body/relaxation.h"
#include "contact/bond_list.h"
#include "sim/energy_balance.h"
#include "sim/relaxed_run.h"
#include "support/block_cuts.h"
#include "support/verify.h"
#include "world/access.h"
#include "zone/zone_set.h"

static const double SHARE = 0.35; /* k of a scene by default */

static void must(int rc, const fl_err *err)
{
    if (rc == 0) return;
    printf("%s\n", err->text);
    exit(1);
}

/* --- sets of zones without a world -------------------------------------------------------------- */

/* A box of n cells along each axis. */
static fl_zone_set box_of_zones(fl_vec3 size, const int32_t n[3], const fl_zone_material *m, double share)
{
    fl_err err = {0};
    fl_zone_mesh mesh;
    fl_zone_set s = {0};
    fl_vec3 corner[8];
    for (int k = 0; k < 8; k++) corner[k] = v3(k & 1 ? size.x : 0, k & 2 ? size.y : 0, k & 4 ? size.z : 0);
    must(fl_zone_grid(&mesh, corner, n, FL_ZONE_SPLIT_FIVE, &err), &err);
    must(fl_zone_set_add_material(&s, m, &err), &err);
    must(fl_zone_set_add(&s, &mesh, 0, 0, &err), &err);
    must(fl_zone_set_finish(&s, share, &err), &err);
    fl_zone_mesh_free(&mesh);
    return s;
}

static void set_forces(fl_zone_set *s)
{
    fl_zone_deform(s, 0, s->zone_chunks), fl_zone_average(s, 0, s->node_chunks);
    fl_zone_corner_forces(s, 0, s->zone_chunks);
    for (int32_t n = 0; n < s->nodes; n++) s->f[n] = fl_zone_node_force(s, n);
}

/* Rest under the loads, with masses that give every node the same frequency. */
static void bring_to_rest(fl_zone_set *s, const fl_vec3 *load, double ratio)
{
    fl_relaxation r = fl_relaxation_start(FL_RELAXATION_ADAPTIVE, 0.0);
    fl_err err = {0};
    fl_vec3 *was = fl_alloc(s->nodes, sizeof *was, &err);
    double total = 0.0;
    for (int32_t n = 0; n < s->nodes; n++) total = fmax(total, v3_norm(load[n]));
    for (int step = 0; step < 200000; step++) {
        double work = 0.0, inertia = 0.0, most = 0.0;
        set_forces(s);
        for (int32_t n = 0; n < s->nodes; n++) {
            const fl_vec3 f = fl_zone_free_part(s->fixed[n], v3_add(s->f[n], load[n]));
            work -= v3_dot(s->v[n], v3_sub(f, was[n]));
            inertia += 0.26 * s->stiffness[n] * v3_norm2(s->v[n]);
            was[n] = f, most = fmax(most, v3_norm(f));
        }
        if (most < ratio * total) break;
        if (step) fl_relaxation_adapt(&r, work, inertia, 1.0);
        for (int32_t n = 0; n < s->nodes; n++) {
            s->v[n] = v3_madd(v3_scale(fl_relaxation_c1(&r), s->v[n]),
                              fl_relaxation_c2(&r) / (0.26 * s->stiffness[n]), was[n]);
            s->x[n] = v3_add(s->x[n], s->v[n]);
        }
        r.rests = r.fresh = 0;
    }
    free(was);
}

/* Mean displacement along an axis of the nodes of a face, weighted by area. */
static double mean_of_face(const fl_zone_set *s, int32_t face, int axis)
{
    double sum = 0.0, area = 0.0;
    for (int32_t k = 0; k < s->triangles; k++) {
        const int32_t *t = s->triangle[k];
        if (s->face[k] != face) continue;
        const double A =
            v3_norm(v3_cross(v3_sub(s->rest[t[1]], s->rest[t[0]]), v3_sub(s->rest[t[2]], s->rest[t[0]])));
        for (int e = 0; e < 3; e++) sum += A / 3.0 * v3_at(v3_sub(s->x[t[e]], s->rest[t[e]]), axis);
        area += A;
    }
    return sum / area;
}

static fl_vec3 *loads_on_face(const fl_zone_set *s, int32_t face, fl_vec3 total)
{
    fl_err err = {0};
    fl_vec3 *load = fl_alloc(s->nodes, sizeof *load, &err);
    double area = 0.0;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t k = 0; k < s->triangles; k++) {
            const int32_t *t = s->triangle[k];
            if (s->face[k] != face) continue;
            const double A =
                v3_norm(v3_cross(v3_sub(s->x[t[1]], s->x[t[0]]), v3_sub(s->x[t[2]], s->x[t[0]])));
            if (pass == 0) area += A;
            for (int e = 0; e < 3 && pass; e++) load[t[e]] = v3_madd(load[t[e]], A / area / 3.0, total);
        }
    return load;
}

/* --- lock --------------------------------------------------------------------------------------- */

static double cantilever(double nu, int n, double share)
{
    const double E = 1e9, P = 1e4, L = 10.0, G = 0.5 * E / (1.0 + nu), I = 1.0 / 12.0,
                 shear = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    const fl_zone_material m = fl_zone_material_of(1000.0, E, nu);
    fl_zone_set s = box_of_zones(v3(L, 1, 1), (const int32_t[]){10 * n, n, n}, &m, share);
    for (int32_t k = 0; k < s.nodes; k++)
        if (s.x[k].x < 1e-9) s.fixed[k] = FL_DOF_X | FL_DOF_Y | FL_DOF_Z;
    fl_vec3 *load = loads_on_face(&s, 1, v3(0, 0, -P));
    bring_to_rest(&s, load, 1e-6);
    const double tip = -mean_of_face(&s, 1, 2);
    free(load);
    fl_zone_set_free(&s);
    return tip / (P * L * L * L / (3.0 * E * I) + P * L / (shear * G));
}

/* The first rows repeat a table of plain zones by another program; the others are ours, as measured. */
static void locking(void)
{
    verify_row("lock", "plain, one cell across, nu = 0", cantilever(0.0, 1, 1.0), 0.324, 1e-3, VERIFY_ABS);
    verify_row("lock", "plain, one cell across, nu = 0.49", cantilever(0.49, 1, 1.0), 0.308, 1e-3,
               VERIFY_ABS);
    verify_row("lock", "plain, two cells across, nu = 0.3", cantilever(0.3, 2, 1.0), 0.672, 3e-3, VERIFY_ABS);
    verify_row("lock", "averaged, two cells across, nu = 0", cantilever(0.0, 2, SHARE), 1.0, 0.02,
               VERIFY_ABS);
    verify_row("lock", "averaged, two cells across, nu = 0.3", cantilever(0.3, 2, SHARE), 1.0, 0.02,
               VERIFY_ABS);
    if (verify_quick()) return;
    verify_row("lock", "averaged, two cells across, nu = 0.45", cantilever(0.45, 2, SHARE), 1.0, 0.05,
               VERIFY_ABS);
    verify_row("lock", "averaged, two cells across, nu = 0.49", cantilever(0.49, 2, SHARE), 1.0, 0.10,
               VERIFY_ABS);
    verify_row("lock", "averaged, four cells across, nu = 0.3", cantilever(0.3, 4, SHARE), 1.0, 0.02,
               VERIFY_ABS);
}

/* --- D1 ----------------------------------------------------------------------------------------- */

static void column(void)
{
    const double g = 9.81, rho = 2500.0;
    for (int held = 0; held < 2; held++) {
        const fl_zone_material m = fl_zone_material_of(rho, 1e9, held ? 0.25 : 0.0);
        fl_zone_set s = box_of_zones(v3(1, 1, 10), (const int32_t[]){1, 1, 10}, &m, SHARE);
        fl_err err = {0};
        fl_vec3 *load = fl_alloc(s.nodes, sizeof *load, &err);
        for (int32_t k = 0; k < s.nodes; k++) {
            load[k] = v3(0, 0, -g * s.m[k]);
            if (held) s.fixed[k] |= FL_DOF_X | FL_DOF_Y;
            if (s.x[k].z < 1e-9) s.fixed[k] |= FL_DOF_Z;
            if (s.x[k].z < 1e-9 && s.x[k].x + s.x[k].y < 1e-9) s.fixed[k] |= FL_DOF_X | FL_DOF_Y;
            if (s.x[k].z < 1e-9 && s.x[k].y < 1e-9) s.fixed[k] |= FL_DOF_Y;
        }
        bring_to_rest(&s, load, 1e-7);
        verify_row("D1", held ? "top sinks, sides on rollers [m]" : "top sinks, sides free [m]",
                   -mean_of_face(&s, 5, 2), held ? 1.021875e-3 : 1.226250e-3, 0.005, VERIFY_REL);
        free(load);
        fl_zone_set_free(&s);
    }
}

/* --- D3, D4 ------------------------------------------------------------------------------------- */

/* Period of the first mode of a column fixed at z = 0 and free at its end, moving along an axis with the
 * directions in hold fixed everywhere. */
static double first_period(fl_zone_set *s, double L, int axis, unsigned hold)
{
    int32_t node;
    const double dt = 0.5 * 2.0 / sqrt(fl_zone_omega2(s, &node));
    double before = 0.0, first = -1.0, last = -1.0;
    int crossings = 0;
    for (int32_t k = 0; k < s->nodes; k++) {
        const double u = 1e-4 * sin(0.5 * PI * s->x[k].z / L);
        s->fixed[k] |= (uint8_t)hold;
        if (s->x[k].z < 1e-9) s->fixed[k] |= (uint8_t)(FL_DOF_X << axis);
        if (axis == 0) s->x[k].x += u;
        else s->x[k].z += u;
        s->v[k] = v3(0, 0, 0);
    }
    for (int step = 0; crossings < 5; step++) {
        set_forces(s);
        for (int32_t k = 0; k < s->nodes; k++) {
            s->v[k] =
                v3_madd(s->v[k], (step ? 1.0 : 0.5) * dt / s->m[k], fl_zone_free_part(s->fixed[k], s->f[k]));
            s->x[k] = v3_madd(s->x[k], dt, s->v[k]);
        }
        const double now = mean_of_face(s, 5, axis);
        if (step && before * now < 0.0) {
            last = dt * (step + before / (before - now));
            if (crossings++ == 0) first = last;
        }
        before = now;
    }
    return (last - first) / 2.0;
}

/* Phase speed on a grid over the true one, n cells a wave: that of plain zones, less what averaging takes. */
static double grid_speed(double n)
{
    const double half = PI / n, sine = sin(half);
    return sine / half * sqrt(1.0 - (1.0 - SHARE) * sine * sine);
}

static void wave_speeds(void)
{
    const double E = 1e9, rho = 2500.0;
    const fl_zone_material m = fl_zone_material_of(rho, E, 0.25);
    static const struct {
        int32_t cells; /* of a quarter of a wave */
        double share;
        const char *p, *s;
    } CASE[] = {
        {5, 0.35, "P waves, 20 cells a wave, of this grid [m/s]",
         "S waves, 20 cells a wave, of this grid [m/s]"},
        {6, 0.35, "speed of P waves, 24 cells a wave [m/s]", "speed of S waves, 24 cells a wave [m/s]"},
        {5, 0.6, "P waves, 20 cells a wave, averaging 0.4 [m/s]",
         "S waves, 20 cells a wave, averaging 0.4 [m/s]"}};
    for (int k = 0; k < 3; k++) {
        const int32_t n[3] = {1, 1, CASE[k].cells};
        const double L = CASE[k].cells, tol = k ? 0.01 : 0.002, slow = k ? 1.0 : grid_speed(20.0);
        fl_zone_set s = box_of_zones(v3(1, 1, L), n, &m, CASE[k].share);
        verify_row("D3", CASE[k].p, 4.0 * L / first_period(&s, L, 2, FL_DOF_X | FL_DOF_Y), 692.820 * slow,
                   tol, VERIFY_REL);
        fl_zone_set_free(&s);
        s = box_of_zones(v3(1, 1, L), n, &m, CASE[k].share);
        verify_row("D3", CASE[k].s, 4.0 * L / first_period(&s, L, 0, FL_DOF_Y | FL_DOF_Z), 400.0 * slow, tol,
                   VERIFY_REL);
        fl_zone_set_free(&s);
    }
    static const int32_t FINER[3] = {3, 6, 12};
    double h[3], error[3];
    for (int k = 0; k < 3; k++) {
        const double L = FINER[k];
        fl_zone_set c = box_of_zones(v3(1, 1, L), (const int32_t[]){1, 1, FINER[k]}, &m, SHARE);
        h[k] = 1.0 / L;
        error[k] = fabs(4.0 * L / first_period(&c, L, 2, FL_DOF_X | FL_DOF_Y) / 692.820323 - 1.0);
        fl_zone_set_free(&c);
    }
    verify_order("D3", "speed of P waves with the size of zones", h, error, 3, 2.0, 0.15);
    fl_zone_set s = box_of_zones(v3(1, 1, 10), (const int32_t[]){1, 1, 10}, &m, SHARE);
    const double T = first_period(&s, 10.0, 2, 0);
    verify_row("D3", "speed of waves in a bar [m/s]", 40.0 / T, 632.456, 0.01, VERIFY_REL);
    verify_row("D4", "first axial period [s]", T, 0.0632456, 0.01, VERIFY_REL);
    fl_zone_set_free(&s);
}

/* --- D6 ----------------------------------------------------------------------------------------- */

/* Axial stress, compression positive, at a lateral pressure; and d eps_v/d eps_1 there. */
static double triaxial(double c, double phi, double psi, double pressure, double *ratio)
{
    fl_zone_material m = fl_zone_material_of(2500.0, 1e10, 0.25);
    fl_zone_material_set_strength(&m, c, phi, INFINITY, psi);
    fl_sym3 plastic = {0}, s = {0};
    double lateral = 0.0, lost = 0.0, volume = 0.0, axial = 0.0;
    const double M = 2.0 * (m.lambda + m.mu);
    for (int step = 1; step <= 400; step++) {
        const fl_sym3 at = plastic;
        const double before = -axial + 2.0 * lateral;
        axial = 2e-5 * step;
        for (int k = 0; k < 200; k++) {
            plastic = at;
            s = fl_zone_stress(&m, (fl_sym3){.xx = lateral, .yy = lateral, .zz = -axial}, &plastic, &lost);
            const double miss = 0.5 * (s.xx + s.yy) + pressure;
            if (fabs(miss) < 1e-6 * (pressure + c)) break;
            lateral -= miss / M;
        }
        volume = -axial + 2.0 * lateral - before;
    }
    *ratio = -volume / 2e-5; /* contraction over shortening */
    return -s.zz;
}

static void triaxial_rows(void)
{
    static const double CASE[][5] = {
        {1e6, 30, 0, 0, 3.46410e6}, {1e6, 30, 10, 5e6, 18.4641e6}, {2e6, 40, 10, 3e6, 22.3748e6}};
    for (int k = 0; k < 3; k++) {
        double ratio;
        const double s = triaxial(CASE[k][0], CASE[k][1], CASE[k][2], CASE[k][3], &ratio),
                     sin_psi = sin(CASE[k][2] * PI / 180.0);
        verify_row("D6", "axial stress at failure [Pa]", s, CASE[k][4], 1e-3, VERIFY_REL);
        verify_row("D6", "d eps_v/d eps_1", ratio, -2.0 * sin_psi / (1.0 - sin_psi), 1e-3, VERIFY_ABS);
    }
    /* tension cut-off, and the apex of the cone without one */
    fl_zone_material m = fl_zone_material_of(2500.0, 1e10, 0.25);
    fl_zone_material_set_strength(&m, 1e6, 30.0, 2e5, 0.0);
    fl_sym3 plastic = {0};
    double lost = 0.0;
    verify_row("D6", "tension cut-off [Pa]", fl_zone_stress(&m, (fl_sym3){.xx = 1e-3}, &plastic, &lost).xx,
               2e5, 1e-9, VERIFY_REL);
    fl_zone_material_set_strength(&m, 1e6, 30.0, INFINITY, 30.0);
    plastic = (fl_sym3){0};
    const fl_sym3 apex =
        fl_zone_stress(&m, (fl_sym3){.xx = 1e-3, .yy = 1.1e-3, .zz = 0.9e-3}, &plastic, &lost);
    verify_row("D6", "apex, c/tan phi [Pa]", apex.yy, 1e6 / tan(PI / 6.0), 1e-9, VERIFY_REL);
}

/* --- D7 ----------------------------------------------------------------------------------------- */

static double number_of(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)*state / 4294967296.0 - 0.5;
}

static double size_of_tensor(fl_sym3 s)
{
    return fmax(fmax(fabs(s.xx), fabs(s.yy)),
                fmax(fmax(fabs(s.zz), fabs(s.xy)), fmax(fabs(s.xz), fabs(s.yz))));
}

static void patch_test(void)
{
    const int32_t n[3] = {4, 3, 3};
    const double E = 1e9;
    const fl_zone_material m = fl_zone_material_of(2500.0, E, 0.3);
    fl_err err = {0};
    fl_zone_mesh mesh;
    fl_zone_set s = {0};
    fl_vec3 corner[8];
    uint32_t seed = 7;
    for (int k = 0; k < 8; k++) corner[k] = v3(k & 1 ? 4 : 0, k & 2 ? 3 : 0, k & 4 ? 3 : 0);
    must(fl_zone_grid(&mesh, corner, n, FL_ZONE_SPLIT_FIVE, &err), &err);
    for (int32_t k = 0; k < mesh.nodes; k++) {
        const fl_vec3 x = mesh.x[k];
        if (x.x < 0.5 || x.x > 3.5 || x.y < 0.5 || x.y > 2.5 || x.z < 0.5 || x.z > 2.5) continue;
        mesh.x[k] = v3_add(x, v3(0.5 * number_of(&seed), 0.5 * number_of(&seed), 0.5 * number_of(&seed)));
    }
    must(fl_zone_set_add_material(&s, &m, &err), &err);
    must(fl_zone_set_add(&s, &mesh, 0, 0, &err), &err);
    must(fl_zone_set_finish(&s, SHARE, &err), &err);
    const fl_sym3 H = {.xx = 1e-3, .yy = -2e-3, .zz = 0.5e-3, .xy = 0.7e-3, .xz = -0.4e-3, .yz = 0.9e-3},
                  exact = s3_add(s3_isotropic(m.lambda * (H.xx + H.yy + H.zz)), s3_times(2.0 * m.mu, H));
    for (int32_t k = 0; k < s.nodes; k++) s.x[k] = v3_add(s.rest[k], s3_mul(H, s.rest[k]));
    set_forces(&s);
    double stress = 0.0, force = 0.0, turned = 0.0;
    for (int32_t k = 0; k < s.zones; k++)
        stress = fmax(stress, size_of_tensor(s3_add(fl_zone_cauchy(&s, k), s3_times(-1.0, exact))));
    for (int32_t k = 0; k < s.nodes; k++) {
        const fl_vec3 x = s.rest[k];
        if (x.x > 0.1 && x.x < 3.9 && x.y > 0.1 && x.y < 2.9 && x.z > 0.1 && x.z < 2.9)
            force = fmax(force, v3_norm(s.f[k]));
    }
    verify_below("D7", "error of the stress, linear displacement, over E eps", stress / (E * 1e-3), 1e-11);
    verify_below("D7", "force on inner nodes, over E eps h2", force / (E * 1e-3), 1e-11);
    const fl_quat q = q_of_vector(v3_scale(1.0, v3_unit(v3(1, 2, 3))));
    for (int32_t k = 0; k < s.nodes; k++) s.x[k] = q_rotate(q, s.rest[k]);
    for (int32_t k = 0; k < s.zones; k++) turned = fmax(turned, size_of_tensor(fl_zone_cauchy(&s, k)));
    verify_below("D7", "stress after a turn by 1 rad, over E", turned / E, 1e-12);
    fl_zone_set_free(&s), fl_zone_mesh_free(&mesh);
}

/* --- worlds ------------------------------------------------------------------------------------- */

static int32_t face_along(const fl_poly *p, double sign)
{
    for (int32_t f = 0; f < p->nf; f++)
        if (sign * p->n[f].z > 0.999) return f;
    return -1;
}

static void add_box(lab *l, int32_t id, fl_vec3 lo, fl_vec3 hi, const char *group)
{
    const double R = 1e-3;
    fl_poly p = {0};
    fl_err err = {0};
    const fl_vec3 half = v3_scale(0.5, v3_sub(hi, lo));
    must(fl_poly_box(&p, v3(half.x - R, half.y - R, half.z - R), &err), &err);
    fl_poly_to_frame(&p, v3_neg(v3_lerp(lo, hi, 0.5)), q_matrix(q_one()));
    must(fl_ice_field_add(&l->field, id, R, &p, NULL, group, v3(0, 0, 0), v3(0, 0, 0), &err), &err);
}

static void join_boxes(lab *l, int32_t i, int32_t j, const char *name)
{
    fl_err err = {0};
    must(fl_ice_field_add_joint(&l->field, i, j, face_along(&l->field.core[i], 1.0),
                                face_along(&l->field.core[j], -1.0), name, &err),
         &err);
}

static void start_rock(lab *l, double nu, double size)
{
    lab_start(l);
    lab_set(l, "run.safety=0.8");
    lab_set(l, "material.ice.density=2500");
    lab_set(l, "material.ice.young=1 GPa");
    lab_setf(l, "material.ice.poisson=%g", nu);
    lab_setf(l, "zones.size=%g", size);
}

static void law_of(lab *l, const char *name, double stiffness, double degrees)
{
    lab_setf(l, "joint.%s.normal_stiffness=%g", name, stiffness);
    lab_setf(l, "joint.%s.shear_stiffness=%g", name, stiffness);
    lab_setf(l, "joint.%s.friction_angle=%.17g", name, degrees);
}

/* Steps until the force ratio; 0 if it takes too long. */
static int settles(lab *l, double ratio)
{
    for (int k = 0; k < 400; k++) {
        if (lab_run(l, 100)) exit(1);
        if (fl_relaxed_run_ratio(&l->w) < ratio) return 1;
    }
    return 0;
}

/* Mean height of the upper nodes of a block, which are above z. */
static double top_of(const lab *l, int32_t body, double z)
{
    const fl_zone_set *s = &l->w.zones.set;
    const fl_zone_block *q = &s->block[l->w.zones.block_of[body]];
    double sum = 0.0, n = 0.0;
    for (int32_t k = q->node; k < q->node_end; k++)
        if (s->x[k].z > z) sum += s->x[k].z, n += 1.0;
    return sum / n;
}

/* D2: two cubes, joints between and below. */
static void two_cubes(void)
{
    lab l;
    start_rock(&l, 0.0, 0.25);
    lab_set(&l, "run.relax=local");
    lab_set(&l, "run.gravity=0 0 -9.81");
    lab_set(&l, "group.bed.fixed=x y z rx ry rz");
    law_of(&l, "bed", 1e9, 30.0);
    add_box(&l, 0, v3(0, 0, -1), v3(1, 1, 0), "bed");
    add_box(&l, 1, v3(0, 0, 0), v3(1, 1, 1), NULL);
    add_box(&l, 2, v3(0, 0, 1), v3(1, 1, 2), NULL);
    join_boxes(&l, 0, 1, "bed"), join_boxes(&l, 1, 2, "bed");
    lab_make(&l, 0.0);
    verify_true("D2", "two cubes come to rest", settles(&l, 1e-6));
    verify_row("D2", "top sinks [m]", 2.0 - top_of(&l, 2, 1.9), 1.226250e-4, 0.005, VERIFY_REL);
    verify_row("D2", "force in the bed over the weight",
               -fl_bond_list_load(&l.w, 0).tension / (2.0 * 2500.0 * 9.81), 1.0, 1e-4, VERIFY_REL);
    lab_free(&l);
}

/* D8: pressed by a given displacement of the top; meshes that match, and that do not. */
static void pressed_blocks(void)
{
    const double EA = 1e9, kn = 4e9, given = 1e-4;
    for (int other = 0; other < 2; other++) {
        lab l;
        double force = 0.0;
        start_rock(&l, 0.0, 0.25);
        lab_set(&l, "run.relax=local");
        lab_set(&l, "run.gravity=0 0 0");
        lab_set(&l, "zones.min_side=free free fixed");
        lab_set(&l, "zones.max_side=free free fixed");
        law_of(&l, "mid", kn, 0.0);
        add_box(&l, 0, v3(0, 0, 0), v3(1, 1, 1), NULL);
        add_box(&l, 1, v3(0, 0, 1), other ? v3(1.15, 1.15, 2) : v3(1, 1, 2), NULL);
        join_boxes(&l, 0, 1, "mid");
        lab_make(&l, 0.0);
        fl_zone_set *s = &l.w.zones.set;
        for (int32_t n = 0; n < s->nodes; n++)
            if (s->fixed[n] && s->x[n].z > 1.5) s->x[n].z -= given;
        verify_true("D8", "pressed blocks come to rest", settles(&l, 1e-6));
        force = -fl_bond_list_load(&l.w, 0).tension;
        if (!other)
            verify_row("D8", "stiffness of two blocks and a joint [N/m]", force / given,
                       1.0 / (2.0 / EA + 1.0 / kn), 0.005, VERIFY_REL);
        else
            verify_row("D8", "area of a joint whose meshes do not match [m2]", l.w.bonds.bond[0].area, 1.0,
                       1e-9, VERIFY_REL);
        lab_free(&l);
    }
}

/* A column on rollers between quiet ends; a joint in the middle if kn > 0. */
static void start_column(lab *l, double length, double kn, double sigma, double duration, const char *top)
{
    start_rock(l, 0.25, 0.5);
    lab_set(l, "run.gravity=0 0 0");
    lab_set(l, "run.safety=0.6");
    lab_setf(l, "zones.max_side=roller roller %s", top);
    lab_set(l, "zones.min_side=roller roller quiet");
    lab_setf(l, "zones.wave_stress=0 0 %g", sigma);
    lab_setf(l, "zones.wave_duration=%.17g", duration);
    if (!(kn > 0.0)) {
        add_box(l, 0, v3(0, 0, 0), v3(1, 1, length), NULL);
        lab_make(l, 0.0);
        return;
    }
    law_of(l, "mid", kn, 0.0);
    lab_set(l, "joint.mid.tension=1e12");
    lab_set(l, "joint.mid.cohesion=1e12");
    add_box(l, 0, v3(0, 0, 0), v3(1, 1, 0.5 * length), NULL);
    add_box(l, 1, v3(0, 0, 0.5 * length), v3(1, 1, length), NULL);
    join_boxes(l, 0, 1, "mid");
    lab_make(l, 0.0);
}

/* Before the first step. */
static int32_t node_near(const fl_zone_set *s, double z)
{
    int32_t best = 0;
    for (int32_t n = 0; n < s->nodes; n++)
        if (fabs(s->x[n].z - z) < fabs(s->x[best].z - z)) best = n;
    return best;
}

/* D5: a pulse comes in, doubles at the free top, and leaves. */
static void quiet_base(void)
{
    const double L = 20.0, c = 692.820323, T = 20.0 * 0.5 / c, sigma = 1e6, v = sigma / (2500.0 * c);
    lab l;
    double inside = 0.0, top = 0.0, kept = 0.0;
    start_column(&l, L, 0.0, sigma, T, "free");
    const fl_zone_set *s = &l.w.zones.set;
    const int32_t middle = node_near(s, 0.5 * L), end = node_near(s, L);
    while (fl_world_time(&l.w) < 4.2 * L / c + 2.0 * T) {
        if (lab_run(&l, 1)) exit(1);
        const double t = fl_world_time(&l.w);
        if (t < 0.5 * L / c + 1.2 * T) inside = fmax(inside, s->v[middle].z);
        top = fmax(top, s->v[end].z);
        if (t > 2.0 * L / c + 1.2 * T) kept = fmax(kept, fabs(s->v[middle].z));
    }
    verify_row("D5", "velocity in a wave of 1 MPa [m/s]", inside, v, 0.02, VERIFY_REL);
    verify_row("D5", "velocity at the free top [m/s]", top, 2.0 * v, 0.02, VERIFY_REL);
    verify_below("D5", "what the quiet base sends back, over the wave", kept / v, 0.02);
    fl_energy_update(&l.w);
    verify_below("D5", "residual of the energy over what came in",
                 fabs(l.w.ledger.residual) / fabs(l.w.ledger.throughput), 1e-3);
    lab_free(&l);
}

/* D9: spectrum of the wave behind a joint over that of the wave that came in. */
static void wave_across_joint(void)
{
    const double L = 20.0, rho = 2500.0, c = 692.820323, Z = rho * c, sigma = 1e6, T = 40.0 * 0.5 / c,
                 omega = 2.0 * PI / T, kn = 0.5 * omega * Z;
    double re[2] = {0, 0}, im[2] = {0, 0};
    for (int with = 0; with < 2; with++) {
        lab l;
        start_column(&l, L, with ? kn : 0.0, sigma, T, "quiet");
        const fl_zone_set *s = &l.w.zones.set;
        const int32_t end = node_near(s, L);
        /* what comes in at the base leaves at the top, so that both pulses are whole */
        while (fl_world_time(&l.w) < L / c + 4.0 * T) {
            if (lab_run(&l, 1)) exit(1);
            const double t = fl_world_time(&l.w);
            re[with] += s->v[end].z * cos(omega * t) * l.w.dt,
                im[with] += s->v[end].z * sin(omega * t) * l.w.dt;
        }
        lab_free(&l);
    }
    verify_row("D9", "transmission at omega = 2 kn/Z",
               sqrt(re[1] * re[1] + im[1] * im[1]) / sqrt(re[0] * re[0] + im[0] * im[0]), 0.70711, 0.02,
               VERIFY_REL);
}

/* A deformable block slides on a rigid bed; its mean acceleration. */
static void block_slides_deformed(void)
{
    const double g = 10.0, a = PI / 6.0, phi = 20.0 * PI / 180.0;
    lab l;
    start_rock(&l, 0.25, 0.25);
    lab_setf(&l, "run.gravity=%.17g 0 %.17g", g * sin(a), -g * cos(a));
    lab_set(&l, "group.bed.fixed=x y z rx ry rz");
    law_of(&l, "bed", 1e8, 20.0);
    lab_set(&l, "joint.bed.damping=0.2");
    add_box(&l, 0, v3(-2, -2, -1), v3(3, 2, 0), "bed");
    add_box(&l, 1, v3(-1, -1, 0), v3(1, 1, 0.5), NULL);
    join_boxes(&l, 0, 1, "bed");
    lab_make(&l, 0.0);
    while (fl_world_time(&l.w) < 0.2) lab_run(&l, 1);
    const double t0 = fl_world_time(&l.w), v0 = l.w.b.v[1].x;
    while (fl_world_time(&l.w) < 0.4) lab_run(&l, 1);
    verify_row("slide", "acceleration of a deformable block [m/s2]",
               (l.w.b.v[1].x - v0) / (fl_world_time(&l.w) - t0), g * (sin(a) - cos(a) * tan(phi)), 5e-3,
               VERIFY_REL);
    fl_energy_update(&l.w);
    verify_below("books", "residual of the energy over the throughput",
                 fabs(l.w.ledger.residual) / l.w.ledger.throughput, 1e-3);
    verify_row("slide", "area of the bed [m2]", l.w.bonds.bond[0].area, 4.0, 1e-6, VERIFY_REL);
    lab_free(&l);
}

/* A free block turns at a constant rate; its body follows, whatever the order of its axes. */
static void free_turn(void)
{
    lab l;
    fl_err err = {0};
    start_rock(&l, 0.25, 0.35);
    lab_set(&l, "run.gravity=0 0 0");
    add_box(&l, 0, v3(0, 0, 0), v3(0.7, 1, 0.9), NULL);
    l.field.spin[0] = v3(0, 0, 5);
    l.field.velocity[0] = v3(1, 0, 0);
    lab_make(&l, 0.0);
    const fl_vec3 x0 = l.w.b.x[0];
    const fl_quat q0 = l.w.b.q[0];
    must(lab_run(&l, 1), &err);
    const fl_vec3 L0 = l.w.b.L[0]; /* of the nodes: lumped masses have more than the block */
    while (fl_world_time(&l.w) < 0.1) must(lab_run(&l, 1), &err);
    const double t = fl_world_time(&l.w);
    const fl_quat turn = q_mul(l.w.b.q[0], q_conj(q0));
    verify_row("free", "turn of a spinning block over omega t", 2.0 * asin(fabs(turn.z)) / (5.0 * t), 1.0,
               1e-3, VERIFY_REL);
    verify_row("free", "way of its centre [m]", l.w.b.x[0].x - x0.x, t, 1e-9, VERIFY_REL);
    verify_row("free", "angular momentum over that at the start", l.w.b.L[0].z / L0.z, 1.0, 1e-9, VERIFY_REL);
    lab_free(&l);
}

int main(void)
{
    verify_begin("deformable blocks");
    free_turn();
    locking();
    column();
    two_cubes();
    wave_speeds();
    quiet_base();
    triaxial_rows();
    patch_test();
    pressed_blocks();
    wave_across_joint();
    block_slides_deformed();
    return verify_end();
}
