/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Blocks of rock: cuts, laws of joints, and blocks on joints at rest and in motion.
 *   B1 to B6  counts, volumes and areas found by other means: half-spaces intersected, strips multiplied
 *   J1 J2     closed forms;  CY-1 CY-3  integrated by a method of order 5 to 1e-11
 *   closure   d sigma = a sigma^e d u in closed form
 *   slide     a block on a bed;  start  stress at the start in the books
 *   wedge     Wyllie & Mah, Rock Slope Engineering (2004), ch. 7 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "bond/joint_law.h"
#include "contact/bond_list.h"
#include "contact/joint_list.h"
#include "sim/energy_balance.h"
#include "sim/memory_use.h"
#include "sim/relaxed_run.h"
#include "support/block_cuts.h"
#include "support/verify.h"
#include "world/access.h"

/* --- cuts --------------------------------------------------------------------------------------- */

/* What a table of cuts has for one case; areas of the sets a, b, c. */
typedef struct {
    fl_vec3 size;
    int32_t blocks;
    double least, least_tol, most, square_sum, area[3];
} cut_table;

static void cut_rows(const char *id, const char *const *set, const cut_table *e)
{
    static const char *const NAME[] = {"a", "b", "c"};
    rock_cut t;
    rock_cut_box(&t, v3(0, 0, 0), e->size, set, 1);
    const fl_block_certificate *c = &t.c;
    double worst = 0.0;
    verify_row(id, "blocks", c->blocks, e->blocks, 0, VERIFY_ABS);
    verify_row(id, "1 + planes + lines + points", (double)(c->pieces + c->planes + c->lines + c->points),
               e->blocks, 0, VERIFY_ABS);
    verify_row(id, "sum of volumes [m3]", c->volume, e->size.x * e->size.y * e->size.z, 1e-12, VERIFY_REL);
    verify_row(id, "smallest volume [m3]", c->least, e->least, e->least_tol, VERIFY_REL);
    verify_row(id, "largest volume [m3]", c->most, e->most, 1e-8, VERIFY_REL);
    verify_row(id, "sum of squared volumes [m6]", c->square_sum, e->square_sum, 1e-8, VERIFY_REL);
    for (int k = 0; k < 3 && e->area[k] > 0.0; k++) {
        char what[48];
        snprintf(what, sizeof what, "area of joint %s [m2]", NAME[k]);
        verify_row(id, what, rock_cut_area(&t, NAME[k]), e->area[k], 1e-8, VERIFY_REL);
        worst = fmax(worst, fabs(c->area[k] / c->section[k] - 1.0));
    }
    verify_below(id, "areas against the sections of the planes", worst, 1e-9);
    verify_true(id, "planes are in general position", !c->special);
    rock_cut_free(&t);
}

/* B1: a grid. */
static void grid(void)
{
    static const char *const SET[] = {"name=a dip=0 dd=0 spacing=2 origin=0,0,1",
                                      "name=b dip=90 dd=90 spacing=2.5 origin=1,0,0",
                                      "name=c dip=90 dd=0 spacing=2 origin=0,.5,0", NULL};
    rock_cut t;
    cut_rows("B1", SET, &(cut_table){{10, 10, 10}, 180, 0.5, 1e-12, 10.0, 7326.0, {500, 400, 500}});
    rock_cut_box(&t, v3(0, 0, 0), v3(10, 10, 10), SET, 1);
    verify_row("B1", "faces of a block, least", t.c.least_faces, 6, 0, VERIFY_ABS);
    verify_row("B1", "faces of a block, most", t.c.most_faces, 6, 0, VERIFY_ABS);
    verify_row("B1", "pairs of faces", t.pairs.n, 5 * 5 * 6 + 6 * 4 * 6 + 6 * 5 * 5, 0, VERIFY_ABS);
    rock_cut_free(&t);
}

/* B2, B4: three oblique sets, without and with a sliver of 6.5e-9 m3. */
static void oblique_sets(void)
{
    static const char *const B2[] = {"name=a dip=30 dd=180 spacing=2 origin=5.1,5.2,5.3",
                                     "name=b dip=60 dd=60 spacing=3 origin=5.1,5.2,5.3",
                                     "name=c dip=80 dd=300 spacing=2.5 origin=4,5.2,5.3", NULL};
    static const char *const B4[] = {"name=a dip=70 dd=20 spacing=1.3 origin=.3,.4,.5",
                                     "name=b dip=25 dd=200 spacing=1.7 origin=.1,.9,.2",
                                     "name=c dip=85 dd=110 spacing=1.9 origin=.7,.2,.6", NULL};
    rock_cut t;
    int32_t small = 0;
    cut_rows("B2", B2,
             &(cut_table){{10, 10, 10},
                          162,
                          1.48755088e-4,
                          1e-5,
                          16.3401078,
                          12400.0218,
                          {507.623957, 335.770150, 399.672750}});
    rock_cut_box(&t, v3(0, 0, 0), v3(10, 10, 10), B2, 1);
    for (int32_t k = 0; k < t.m.n; k++) small += fl_block_shape_volume(&t.m.block[k], NULL) < 0.01;
    verify_row("B2", "faces of a block, least", t.c.least_faces, 4, 0, VERIFY_ABS);
    verify_row("B2", "faces of a block, most", t.c.most_faces, 9, 0, VERIFY_ABS);
    verify_row("B2", "blocks below 0.01 m3", small, 9, 0, VERIFY_ABS);
    rock_cut_free(&t);
    cut_rows(
        "B4", B4,
        &(cut_table){
            {12, 8, 6}, 278, 6.5169e-9, 1e-5, 4.23114026, 1961.75105, {442.970918, 338.852935, 304.519937}});
}

/* B3: three planes of each set about the middle, k = -1, 0, 1. */
static void counted_planes(void)
{
    static const char *const SET[] = {"name=a dip=45 dd=135 spacing=3 n=3 origin=3.5,6.5,2.878679656440357",
                                      "name=b dip=45 dd=315 spacing=3 n=3 origin=6.5,3.5,1.878679656440357",
                                      NULL};
    cut_rows("B3", SET,
             &(cut_table){
                 {10, 10, 10}, 16, 0.870453792, 1e-7, 112.596645, 81780.5453, {299.382684, 293.892352, 0}});
}

/* B6: one of four planes misses the box. */
static void plane_beside(void)
{
    static const char *const SET[] = {"name=a dip=40 dd=130 n=1 origin=6,6,6",
                                      "name=b dip=60 dd=220 n=1 origin=6,5,6",
                                      "name=c dip=90 dd=175 n=2 spacing=5 origin=3,3,3", NULL};
    rock_cut t;
    int32_t idle = 0;
    rock_cut_box(&t, v3(0, 0, 0), v3(12, 12, 12), SET, 1);
    for (int32_t p = 0; p < t.m.planes; p++) idle += t.m.cuts[p] == 0;
    verify_row("B6", "blocks", t.m.n, 8, 0, VERIFY_ABS);
    verify_row("B6", "planes that cut", (double)t.c.planes, 3, 0, VERIFY_ABS);
    verify_row("B6", "planes that cut nothing", idle, 1, 0, VERIFY_ABS);
    rock_cut_free(&t);
}

/* B5: B1 with persistence p: mean (1+5p)(1+4p)(1+5p), at p = 1/2 with deviation 13.922; 3 sigma. */
static void persistence(void)
{
    static const char *const SET[] = {"dip=0 dd=0 spacing=2 origin=0,0,1 persistence=.5",
                                      "dip=90 dd=90 spacing=2.5 origin=1,0,0 persistence=.5",
                                      "dip=90 dd=0 spacing=2 origin=0,.5,0 persistence=.5", NULL};
    enum { SEEDS = 2000 };
    double sum = 0.0, square = 0.0;
    for (int seed = 1; seed <= SEEDS; seed++) {
        const double n = rock_cut_count(v3(0, 0, 0), v3(10, 10, 10), SET, (uint64_t)seed);
        sum += n, square += n * n;
    }
    const double mean = sum / SEEDS;
    verify_row("B5", "mean number of blocks, 2000 seeds", mean, 36.75, 3.0 * 13.922 / sqrt(SEEDS),
               VERIFY_ABS);
    verify_row("B5", "its deviation", sqrt(square / SEEDS - mean * mean), 13.922, 0.07, VERIFY_REL);
}

/* --- laws --------------------------------------------------------------------------------------- */

static const double NONE[2] = {0, 0};

/* J1: 1 MPa on the joint, slid to 2 mm and back. */
static fl_joint_material rough_joint(void)
{
    const double t = tan(30.0 * PI / 180.0);
    return (fl_joint_material){.law = FL_JOINT_COULOMB,
                               .kn = 1e10,
                               .ks = 1e9,
                               .friction = t,
                               .residual_friction = t,
                               .cohesion = 0.2e6,
                               .tension = 0.1e6,
                               .dilation_slip = INFINITY};
}

typedef struct {
    double work, friction, stored; /* [J/m2] */
} energies;

/* Moves a point along x by `way` in n steps at the opening s_n; adds work and friction. */
static void slide(const fl_joint_material *m, fl_joint_point *p, double s_n, double way, int n, energies *e)
{
    const double ds[2] = {way / n, 0.0};
    for (int k = 0; k < n; k++) {
        const double before = p->tau[0];
        const fl_joint_point_result r = fl_joint_laws[m->law].step(m, p, s_n, ds);
        if (!e) continue;
        e->work += 0.5 * (before + p->tau[0]) * ds[0], e->friction += r.friction, e->stored = r.stored;
    }
}

static void coulomb_slip(void)
{
    const fl_joint_material m = rough_joint();
    const double rest = 0.5773503e6, closed = 0.5e12 / 1e10, step = 5e-10;
    double u = 0.7773e-3, peak = 0.0;
    energies e = {0};
    fl_joint_point p;
    fl_joint_point_start(&m, &p, 1e6, NONE);
    slide(&m, &p, 0.0, u, 7773, &e);
    verify_row("J1", "tau at 0.7773 mm [Pa]", p.tau[0], 0.7773e6, 1e-9, VERIFY_REL);
    for (; !p.failed && u < 0.78e-3; u += step) {
        peak = p.tau[0];
        slide(&m, &p, 0.0, step, 1, &e);
    }
    verify_row("J1", "peak [Pa]", peak, 0.7773503e6, 1e-6, VERIFY_REL);
    verify_row("J1", "slip at the peak [m]", u, 0.7773503e-3, 1e-6, VERIFY_REL);
    verify_row("J1", "tau after it [Pa]", p.tau[0], rest, 1e-6, VERIFY_REL);
    slide(&m, &p, 0.0, 2e-3 - u, 12225, &e);
    verify_row("J1", "tau at 2 mm [Pa]", p.tau[0], rest, 1e-6, VERIFY_REL);
    verify_row("J1", "work [J/m2]", e.work, 1008.034, 2e-6, VERIFY_REL);
    verify_row("J1", "lost by slip [J/m2]", e.friction, 705.897, 2e-6, VERIFY_REL);
    verify_row("J1", "stored by shear [J/m2]", e.stored - closed, 166.667, 3e-6, VERIFY_REL);
    verify_row("J1", "lost by the drop [J/m2]", e.work - e.friction - (e.stored - closed), 135.470, 1e-5,
               VERIFY_REL);
    slide(&m, &p, 0.0, 0.8453e-3 - 2e-3, 11547, NULL);
    verify_row("J1", "tau, back at 0.8453 mm [Pa]", p.tau[0], rest - 1e9 * (2e-3 - 0.8453e-3), 1e-6,
               VERIFY_REL);
    slide(&m, &p, 0.0, -0.3e-3, 300, NULL);
    verify_row("J1", "tau, back at 0.5453 mm [Pa]", p.tau[0], -rest, 1e-6, VERIFY_REL);
}

static void coulomb_tension(void)
{
    const fl_joint_material m = rough_joint();
    fl_joint_point p;
    fl_joint_point_start(&m, &p, 0.0, NONE);
    fl_joint_coulomb_step(&m, &p, 0.0099e-3, NONE);
    verify_row("J1", "sigma at an opening of 0.0099 mm [Pa]", p.sigma, -0.099e6, 1e-9, VERIFY_REL);
    fl_joint_coulomb_step(&m, &p, 0.0101e-3, NONE);
    verify_row("J1", "sigma at 0.0101 mm [Pa]", p.sigma, 0, 0, VERIFY_ABS);
    verify_true("J1", "it is open", p.open);
    fl_joint_coulomb_step(&m, &p, 0.005e-3, (const double[]){1e-3, 0});
    verify_true("J1", "no stress as it closes", p.sigma == 0.0 && p.tau[0] == 0.0);
    fl_joint_coulomb_step(&m, &p, -1e-4, (const double[]){2e-3, 0});
    verify_row("J1", "pressed again: sigma [Pa]", p.sigma, 1e6, 1e-9, VERIFY_REL);
    verify_row("J1", "tau, by friction alone [Pa]", p.tau[0], 0.5773503e6, 1e-6, VERIFY_REL);
}

/* J2: held at its opening, a joint with dilation gains pressure. */
static void coulomb_dilation(void)
{
    fl_joint_material m = rough_joint();
    fl_joint_point p;
    m.cohesion = m.tension = 0.0;
    m.dilation = tan(5.0 * PI / 180.0);
    fl_joint_point_start(&m, &p, 1e6, NONE);
    slide(&m, &p, 0.0, 2e-3, 20000, NULL);
    verify_row("J2", "slip at 2 mm [m]", p.slip, 0.945209e-3, 1e-6, VERIFY_REL);
    verify_row("J2", "sigma [Pa]", p.sigma, 1.826951e6, 1e-6, VERIFY_REL);
    verify_row("J2", "tau [Pa]", p.tau[0], 1.054791e6, 1e-6, VERIFY_REL);
    m.dilation_slip = 0.5e-3;
    fl_joint_point_start(&m, &p, 1e6, NONE);
    slide(&m, &p, 0.0, 4e-3, 40000, NULL);
    verify_row("J2", "sigma, dilation to a slip of 0.5 mm [Pa]", p.sigma, 1e6 + 1e10 * m.dilation * 0.5e-3,
               1e-3, VERIFY_REL);
}

static fl_joint_material yielding_joint(double stress_factor, double first, double last, double roughness)
{
    return (fl_joint_material){.law = FL_JOINT_YIELDING,
                               .kn = 1e10,
                               .ks = stress_factor,
                               .shear_exponent = 1.0,
                               .kn_most = INFINITY,
                               .ks_most = INFINITY,
                               .angle = last * PI / 180.0,
                               .initial_angle = first * PI / 180.0,
                               .roughness = roughness};
}

/* CY-1: to 12 mm. */
static void yielding_once(void)
{
    static const double CURVE[][3] = {{1, 6.69024, 48.4117},  {2, 9.05411, 45.2120}, {3, 9.28019, 41.9143},
                                      {4, 8.70777, 39.1470},  {5, 8.02073, 37.0024}, {6, 7.45118, 35.3764},
                                      {7, 7.02641, 34.1429},  {8, 6.71675, 33.2016}, {9, 6.48957, 32.4793},
                                      {10, 6.32072, 31.9227}, {12, 6.09735, 31.1597}};
    const fl_joint_material m = yielding_joint(1e3, 50.0, 30.0, 4e-3);
    fl_joint_point p;
    double at = 0.0, peak = 0.0;
    fl_joint_point_start(&m, &p, 10e6, NONE);
    for (size_t k = 0; k < sizeof CURVE / sizeof *CURVE; k++) {
        char what[48];
        for (int e = 0; e < 1000; e++) {
            slide(&m, &p, 0.0, (CURVE[k][0] - at) * 1e-6, 1, NULL);
            peak = fmax(peak, p.tau[0]);
        }
        at = CURVE[k][0];
        snprintf(what, sizeof what, "tau at %g mm [MPa]", at);
        verify_row("CY-1", what, p.tau[0] * 1e-6, CURVE[k][1], 1e-4, VERIFY_REL);
        snprintf(what, sizeof what, "phi_m at %g mm [deg]", at);
        verify_row("CY-1", what, p.angle * 180.0 / PI, CURVE[k][2], 1e-4, VERIFY_REL);
    }
    verify_row("CY-1", "peak [MPa]", peak * 1e-6, 9.345613, 1e-4, VERIFY_REL);
    fl_joint_point_start(&m, &p, 10e6, NONE);
    slide(&m, &p, 0.0, 2e-3, 1, NULL);
    verify_row("CY-1", "tau at 2 mm in one step [MPa]", p.tau[0] * 1e-6, 9.05411, 2e-4, VERIFY_REL);
}

/* CY-2: CY-1 at a fifth of the stress, where tau is a fifth at the same slip; then under a stress that rises
 * with slip, sigma = 5 MPa + 1 GPa/m u, with k_s = 1e10 sqrt(sigma/10 MPa).  Its numbers are those of the two
 * equations by Runge and Kutta in 40 000 steps (14 digits). */
static void yielding_pressed(void)
{
    static const double CURVE[][3] = {{1, 4.431959, 48.10892}, {2, 6.120113, 44.86643},
                                      {4, 7.142908, 39.28273}, {6, 7.686966, 35.70743},
                                      {8, 8.337873, 33.51350}, {10, 9.114147, 32.16628}};
    enum { EACH = 4000 }; /* steps a mm */
    fl_joint_material m = yielding_joint(1e3, 50.0, 30.0, 4e-3);
    fl_joint_point p;
    fl_joint_point_start(&m, &p, 2e6, NONE);
    slide(&m, &p, 0.0, 2e-3, 2000, NULL);
    verify_row("CY-2", "tau at 2 MPa and 2 mm [MPa]", p.tau[0] * 1e-6, 0.2 * 9.05411, 1e-4, VERIFY_REL);
    m.ks = 1e10 / sqrt(10e6), m.shear_exponent = 0.5;
    fl_joint_point_start(&m, &p, 5e6, NONE);
    for (int k = 0, row = 0; row < (int)(sizeof CURVE / sizeof *CURVE); k++) {
        char what[64];
        const double u = 1e-3 * (k + 0.5) / EACH; /* in the middle of the step */
        slide(&m, &p, p.offset - (5e6 + 1e9 * u) / m.kn, 1e-3 / EACH, 1, NULL);
        if (k + 1 < (int)CURVE[row][0] * EACH) continue;
        snprintf(what, sizeof what, "tau at %g mm, sigma rises [MPa]", CURVE[row][0]);
        verify_row("CY-2", what, p.tau[0] * 1e-6, CURVE[row][1], 1e-4, VERIFY_REL);
        snprintf(what, sizeof what, "phi_m at %g mm [deg]", CURVE[row][0]);
        verify_row("CY-2", what, p.angle * 180.0 / PI, CURVE[row][2], 1e-4, VERIFY_REL);
        row++;
    }
}

/* CY-3: to 3 mm, back to 2.7, on to 5, back to 0.  Errors of tau over sigma. */
static void yielding_cyclic(void)
{
    static const struct {
        double u, tau, angle;
    } CURVE[] = {{0.6, .450164, 0},      {1.2, .688670, 0},  {1.8, .802352, 0},        {2.4, .843705, 0},
                 {3, .845699, 39.74925}, {2.88, .729886, 0}, {2.7, .570932, 39.70017}, {3.16, .780565, 0},
                 {3.62, .798467, 0},     {4.08, .782546, 0}, {5, .744361, 36.33969},   {4, .017019, 0},
                 {3, -.349560, 0},       {2, -.526173, 0},   {0, -.632685, 33.07172}};
    const fl_joint_material m = yielding_joint(1e3, 45.0, 30.0, 5e-3);
    fl_joint_point p;
    double at = 0.0;
    fl_joint_point_start(&m, &p, 1e6, NONE);
    for (size_t k = 0; k < sizeof CURVE / sizeof *CURVE; k++) {
        char what[48];
        slide(&m, &p, 0.0, (CURVE[k].u - at) * 1e-3, 2000, NULL);
        snprintf(what, sizeof what, "tau at %g mm, from %g [MPa]", CURVE[k].u, at);
        verify_row("CY-3", what, p.tau[0] * 1e-6, CURVE[k].tau, 1e-4, VERIFY_ABS);
        at = CURVE[k].u;
        snprintf(what, sizeof what, "phi_m at %g mm [deg]", at);
        if (CURVE[k].angle > 0.0)
            verify_row("CY-3", what, p.angle * 180.0 / PI, CURVE[k].angle, 1e-4, VERIFY_REL);
    }
}

/* e = 1: sigma = sigma_0 exp(a u);  e = 1/2: sigma = (sqrt(sigma_0) + a u/2)^2. */
static void closures(void)
{
    fl_joint_material m = {.law = FL_JOINT_YIELDING, .kn = 1e4, .normal_exponent = 1.0, .kn_most = INFINITY};
    double stored, u = fl_joint_closure(&m, 0.1e6);
    verify_row("close", "sigma, there and back [Pa]", fl_joint_closing_stress(&m, u, &stored), 0.1e6, 1e-12,
               VERIFY_REL);
    verify_row("close", "e = 1, closed by 0.1 mm [MPa]",
               fl_joint_closing_stress(&m, u + 1e-4, &stored) * 1e-6, 0.1 * exp(1.0), 1e-9, VERIFY_REL);
    verify_row("close", "e = 1, by 0.2 mm [MPa]", fl_joint_closing_stress(&m, u + 2e-4, &stored) * 1e-6,
               0.1 * exp(2.0), 1e-9, VERIFY_REL);
    m.kn = 1e8, m.normal_exponent = 0.5;
    u = fl_joint_closure(&m, 0.1e6);
    const double root = sqrt(0.1e6) + 0.5e8 * 1e-4;
    verify_row("close", "e = 1/2, by 0.1 mm [MPa]", fl_joint_closing_stress(&m, u + 1e-4, &stored) * 1e-6,
               root * root * 1e-6, 1e-9, VERIFY_REL);
}

/* --- blocks on joints --------------------------------------------------------------------------- */

/* A body that moves by this part of its size has failed. */
static const double MOVED = 0.02;
enum { EVERY = 50, STEPS_AT_MOST = 40000 };

/* Steps until the forces balance: 1; 0 if the body moves too far, or for too long. */
static int comes_to_rest(lab *l, int32_t body, double ratio)
{
    const fl_vec3 x = l->w.b.x[body];
    for (int k = 0; k < STEPS_AT_MOST; k += EVERY) {
        if (lab_run(l, EVERY)) exit(1);
        if (fl_relaxed_run_ratio(&l->w) < ratio) return 1;
        if (v3_norm(v3_sub(l->w.b.x[body], x)) > MOVED * l->w.b.bounding_radius[body]) return 0;
    }
    return 0;
}

/* A scene with a loose block; returns its index.  relax: none or local. */
typedef int32_t slope_maker(lab *l, const double *degrees, const char *relax);

/* The factor of friction: at rest on joints that cannot fail, tan phi/F then holds or not. */
static double friction_factor(slope_maker *make, const double *degrees, double lo, double hi)
{
    while (hi > lo * 1.0002) {
        const double F = sqrt(lo * hi);
        lab l;
        const int32_t body = make(&l, degrees, "local");
        fl_joint_material *m = l.w.bonds.joint_material;
        for (int32_t k = 0; k < l.scene.n_joint; k++) m[k].cohesion = m[k].tension = INFINITY;
        if (!comes_to_rest(&l, body, 1e-4)) {
            printf("no rest on joints that cannot fail\n");
            exit(1);
        }
        for (int32_t k = 0; k < l.scene.n_joint; k++) {
            m[k].cohesion = m[k].tension = 0.0;
            m[k].friction /= F, m[k].residual_friction /= F;
        }
        if (comes_to_rest(&l, body, 1e-4)) lo = F;
        else hi = F;
        lab_free(&l);
    }
    return sqrt(lo * hi);
}

static void set_joint(lab *l, const char *name, double stiffness, double degrees)
{
    lab_setf(l, "joint.%s.normal_stiffness=%g", name, stiffness);
    lab_setf(l, "joint.%s.shear_stiffness=%g", name, stiffness);
    lab_setf(l, "joint.%s.friction_angle=%.17g", name, degrees);
}

static void add_block(lab *l, int32_t id, fl_vec3 lo, fl_vec3 hi, const char *group)
{
    const double R = 0.01;
    fl_poly p = {0};
    fl_err err = {0};
    const fl_vec3 half = v3_scale(0.5, v3_sub(hi, lo));
    if (fl_poly_box(&p, v3(half.x - R, half.y - R, half.z - R), &err)) exit(1);
    fl_poly_to_frame(&p, v3_neg(v3_lerp(lo, hi, 0.5)), q_matrix(q_one()));
    if (fl_ice_field_add(&l->field, id, R, &p, NULL, group, v3(0, 0, 0), v3(0, 0, 0), &err)) exit(1);
}

static int32_t face_along_z(const fl_poly *p, double sign)
{
    for (int32_t f = 0; f < p->nf; f++)
        if (sign * p->n[f].z > 0.999) return f;
    return -1;
}

/* A block of 2 t on a bed under 30 degrees, gravity turned.  degrees[0] friction, degrees[1] p A over W cos
 * a, degrees[2] damping. */
static void begin_block_on_bed(lab *l, const double *degrees, const char *relax)
{
    fl_err err = {0};
    lab_start(l);
    lab_setf(l, "run.relax=%s", relax);
    lab_set(l, "run.safety=0.2");
    lab_setf(l, "run.gravity=%.17g 0 %.17g", 10.0 * sin(PI / 6.0), -10.0 * cos(PI / 6.0));
    lab_set(l, "material.ice.density=1000");
    lab_set(l, "material.ice.young=1 GPa");
    lab_set(l, "group.bed.fixed=x y z rx ry rz");
    set_joint(l, "bed", 1e8, degrees[0]);
    lab_setf(l, "joint.bed.water_pressure=%.17g", degrees[1] * 20000.0 * cos(PI / 6.0) / 4.0);
    lab_setf(l, "joint.bed.damping=%g", degrees[2]);
    add_block(l, 0, v3(-2, -2, -1), v3(3, 2, 0), "bed");
    add_block(l, 1, v3(-1, -1, 0), v3(1, 1, 0.5), NULL);
    if (fl_ice_field_add_joint(&l->field, 0, 1, face_along_z(&l->field.core[0], 1.0),
                               face_along_z(&l->field.core[1], -1.0), "bed", &err))
        exit(1);
}

static int32_t block_on_bed(lab *l, const double *degrees, const char *relax)
{
    begin_block_on_bed(l, degrees, relax);
    lab_make(l, 0.0);
    return 1;
}

/* The memory that --plan prints has the joint and its eight corners. */
static void joint_memory(void)
{
    lab l;
    block_on_bed(&l, (const double[]){40, 0, 0}, "none");
    const double all = fl_memory_use_of(&l.w).others;
    fl_bond_list *s = &l.w.bonds;
    fl_joint *const joint = s->joint;
    s->joint = NULL;
    verify_row("slide", "memory of a joint [bytes]", all - fl_memory_use_of(&l.w).others,
               (double)(sizeof(fl_joint) + sizeof(fl_joint_material) + 8 * sizeof(fl_vec3)), 0, VERIFY_ABS);
    s->joint = joint;
    lab_free(&l);
}

/* On its springs: W cos a/(kn A), W sin a/(ks A), and the turn by the moment W sin a h/2 over kn I. */
static void block_at_rest(void)
{
    const double W = 20000.0, a = PI / 6.0, k = 1e8, A = 4.0, I = 4.0 / 3.0;
    lab l;
    const int32_t i = block_on_bed(&l, (const double[]){40, 0, 0}, "local");
    l.w.bonds.joint_material[0].cohesion = l.w.bonds.joint_material[0].tension = INFINITY;
    verify_true("slide", "the block comes to rest", comes_to_rest(&l, i, 1e-8));
    const fl_vec3 x = l.w.b.x[i];
    const double turned = 2.0 * l.w.b.q[i].y;
    verify_row("slide", "sunk [m]", 0.25 - x.z, W * cos(a) / (k * A), 1e-4, VERIFY_REL);
    verify_row("slide", "turned [rad]", turned, W * sin(a) * 0.25 / (k * I), 1e-4, VERIFY_REL);
    verify_row("slide", "shifted at the bed [m]", x.x - 0.25 * turned, W * sin(a) / (k * A), 1e-4,
               VERIFY_REL);
    lab_free(&l);
}

/* Stress at the start is stored, and what is beyond the strength is lost before the first step: nothing
 * moves, so that all of it was stored. */
static void stress_at_start(void)
{
    static const double SHEAR[2] = {2e3, 1e4};
    const double sigma = 1e4, k = 1e8, A = 4.0, limit = sigma * tan(20.0 * PI / 180.0);
    for (int e = 0; e < 2; e++) {
        lab l;
        char stress[96];
        snprintf(stress, sizeof stress, "joint.bed.initial_shear=0 0 %g Pa", SHEAR[e]);
        begin_block_on_bed(&l, (const double[]){20, 0, 0}, "none");
        lab_setf(&l, "joint.bed.initial_stress=0 0 %g Pa", sigma);
        lab_set(&l, stress);
        lab_make(&l, 0.0);
        const double tau = fmin(SHEAR[e], limit), lost = A * (SHEAR[e] * SHEAR[e] - tau * tau) / (2.0 * k);
        fl_energy_update(&l.w);
        verify_row("start", e ? "stored, slipped at once [J]" : "stored [J]", l.w.ledger.bond,
                   A * (sigma * sigma + tau * tau) / (2.0 * k), 1e-9, VERIFY_REL);
        verify_row("start", "lost by slip [J]", fl_joint_list_friction_loss(&l.w), lost, 1e-9 * A,
                   VERIFY_ABS);
        verify_row("start", "residual of the energy [J]", l.w.ledger.residual, 0.0, 1e-9, VERIFY_ABS);
        lab_free(&l);
    }
}

static void block_slides(void)
{
    const double g = 10.0, a = PI / 6.0, phi = 20.0 * PI / 180.0;
    lab l;
    const int32_t i = block_on_bed(&l, (const double[]){20, 0, 0.2}, "none");
    while (fl_world_time(&l.w) < 0.2) lab_run(&l, 1);
    const double t0 = fl_world_time(&l.w), v0 = l.w.b.v[i].x;
    while (fl_world_time(&l.w) < 0.6) lab_run(&l, 1);
    verify_row("slide", "acceleration at 20 degrees [m/s2]", (l.w.b.v[i].x - v0) / (fl_world_time(&l.w) - t0),
               g * (sin(a) - cos(a) * tan(phi)), 1e-3, VERIFY_REL);
    lab_free(&l);
}

/* Thrown along and off its bed by half its height, the block lands elsewhere: its joint closes again. */
static void block_lands(void)
{
    const double g = 10.0, up = 2.2, W = 20000.0;
    double highest = 0.0;
    lab l;
    begin_block_on_bed(&l, (const double[]){40, 0, 0.3}, "none");
    lab_setf(&l, "run.gravity=0 0 %g", -g);
    lab_make(&l, 0.0);
    const double z = l.w.b.x[1].z;
    l.w.b.v[1] = v3(0.5, 0, up);
    while (fl_world_time(&l.w) < 2.0) {
        if (lab_run(&l, 1)) exit(1);
        highest = fmax(highest, l.w.b.x[1].z - z);
    }
    const fl_joint_counts n = fl_joint_list_counts(&l.w);
    verify_row("again", "joint opens by [m]", highest, up * up / (2.0 * g), 1e-3, VERIFY_REL);
    verify_true("again", "it is the same joint, and closed", n.elastic == 1 && n.open + n.ended == 0);
    verify_row("again", "force on it over W, after the landing", -fl_bond_list_load(&l.w, 0).tension / W, 1.0,
               1e-3, VERIFY_REL);
    verify_row("again", "sunk [m]", z - l.w.b.x[1].z, W / (1e8 * 4.0), 1e-3, VERIFY_REL);
    lab_free(&l);
}

static void block_factors(void)
{
    const double dry = tan(40.0 * PI / 180.0) / tan(PI / 6.0);
    verify_row("slide", "factor at 40 degrees, dry",
               friction_factor(block_on_bed, (const double[]){40, 0, 0}, 1.3, 1.6), dry, 1e-3, VERIFY_REL);
    verify_row("slide", "with water, p A = 0.2 W cos a",
               friction_factor(block_on_bed, (const double[]){40, 0.2, 0}, 1.0, 1.3), 0.8 * dry, 1e-3,
               VERIFY_REL);
}

/* 1 if a block of 10 m by 25 m, 1 m deep, stands on a bed of stiffness kn under a slope. */
static int tall_block_stands(double kn, double slope)
{
    const double cosine = 1.0 / sqrt(1.0 + slope * slope);
    fl_err err = {0};
    lab l;
    lab_start(&l);
    lab_set(&l, "run.relax=local");
    lab_set(&l, "run.safety=0.8");
    lab_setf(&l, "run.gravity=%.17g 0 %.17g", 10.0 * slope * cosine, -10.0 * cosine);
    lab_set(&l, "material.ice.density=2000");
    lab_set(&l, "material.ice.young=1 GPa");
    lab_set(&l, "group.bed.fixed=x y z rx ry rz");
    lab_set(&l, "group.tall.fixed=y rx rz");
    set_joint(&l, "bed", kn, 60.0);
    add_block(&l, 0, v3(-8, -1, -1), v3(8, 2, 0), "bed");
    add_block(&l, 1, v3(-5, 0, 0), v3(5, 1, 25), "tall");
    if (fl_ice_field_add_joint(&l.field, 0, 1, face_along_z(&l.field.core[0], 1.0),
                               face_along_z(&l.field.core[1], -1.0), "bed", &err))
        exit(1);
    lab_make(&l, 0.0);
    fl_joint_material *m = l.w.bonds.joint_material;
    m->cohesion = m->tension = INFINITY;
    int stands = 0, rests = 0;
    for (int k = 0, held = 1; k < 8 * STEPS_AT_MOST && l.w.b.x[1].x < 0.3 * 12.5; k += EVERY) {
        if (lab_run(&l, EVERY)) exit(1);
        rests = fl_relaxed_run_ratio(&l.w) < 1e-5 ? rests + 1 : 0;
        if (rests < 3) continue; /* a turn has moments of balance */
        stands = !held;
        if (stands) break;
        held = rests = 0;
        m->cohesion = m->tension = 0.0;
    }
    lab_free(&l);
    return stands;
}

/* V26's block on a bed of 1 GPa/m.  Points stand at the edges and in the middle, with 1/6, 4/6 and 1/6 of
 * kn b: it topples as the middle one opens, turned by 12 N/(kn b^2).  On many springs it would topple at
 * (2/h)(b/2 - 1.5 (2 h N/(9 kn))^(1/3)) = 0.3644, earlier by 9 %. */
static void tall_block(void)
{
    const double b = 10.0, h = 25.0, W = b * h * 2e4, kn = 1e9;
    double lo = 0.3, hi = 0.45, slope = b / h;
    for (int e = 0; e < 50; e++) slope = b / h - 12.0 * W / sqrt(1.0 + slope * slope) / (kn * b * b);
    while (hi - lo > 1e-3) {
        const double middle = 0.5 * (lo + hi);
        if (tall_block_stands(kn, middle)) lo = middle;
        else hi = middle;
    }
    verify_row("tall", "slope at which it topples", 0.5 * (lo + hi), slope, 2e-3, VERIFY_ABS);
}

/* A wedge on A 45/105 and B 70/235; degrees[0], [1] friction, [2]: damping. */
static int32_t wedge_on_joints(lab *l, const double *degrees, const char *relax)
{
    static const char *const SET[] = {"name=A dip=45 dd=105 n=1", "name=B dip=70 dd=235 n=1", NULL};
    rock_cut t;
    int32_t wedge = -1;
    rock_cut_box(&t, v3(-10, -10, -10), v3(10, 10, 6), SET, 1);
    for (int32_t k = 0; k < t.m.n; k++) {
        fl_vec3 x;
        fl_block_shape_volume(&t.m.block[k], &x);
        if (x.x > -5.0 && x.x < 10.0 && x.y > -10.0 && x.y < 0.0 && x.z > 0.0) wedge = k;
    }
    lab_start(l);
    lab_setf(l, "run.relax=%s", relax);
    lab_set(l, "run.safety=0.5");
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "material.ice.density=2600");
    lab_set(l, "material.ice.young=10 GPa");
    lab_set(l, "group.rock.fixed=x y z rx ry rz");
    set_joint(l, "A", 1e9, degrees[0]);
    set_joint(l, "B", 1e9, degrees[1]);
    lab_setf(l, "joint.A.damping=%g", degrees[2]);
    lab_setf(l, "joint.B.damping=%g", degrees[2]);
    rock_cut_fill(&t, l, 0.002, wedge);
    rock_cut_free(&t);
    lab_make(l, 0.0);
    return wedge;
}

static void wedge_factors(void)
{
    const double even = friction_factor(wedge_on_joints, (const double[]){30, 30, 0}, 1.3, 1.6);
    verify_row("wedge", "factor at 30 degrees", even, 1.43530, 1e-3, VERIFY_REL);
    verify_row("wedge", "friction at which it slides [deg]", atan(tan(PI / 6.0) / even) * 180.0 / PI,
               21.91253, 0.05, VERIFY_ABS);
    verify_row("wedge", "factor at 20 on A and 30 on B",
               friction_factor(wedge_on_joints, (const double[]){20, 30, 0}, 1.0, 1.25), 1.10662, 1e-3,
               VERIFY_REL);
}

/* In the slide the shear is along the line, so that both normal forces are determined. */
static void wedge_slides(void)
{
    lab l;
    const int32_t i = wedge_on_joints(&l, (const double[]){20, 20, 0.3}, "none");
    const double W = 9.81 * l.w.b.m[i];
    while (fl_world_time(&l.w) < 0.3) lab_run(&l, 1);
    const double t0 = fl_world_time(&l.w), v0 = v3_norm(l.w.b.v[i]);
    while (fl_world_time(&l.w) < 0.6) lab_run(&l, 1);
    verify_row("wedge", "acceleration at 20 degrees over g",
               (v3_norm(l.w.b.v[i]) - v0) / (fl_world_time(&l.w) - t0) / 9.81, 0.049294, 0.01, VERIFY_REL);
    for (int32_t k = 0; k < l.w.bonds.n; k++) {
        const fl_bond *c = &l.w.bonds.bond[k];
        if (c->i != i && c->j != i) continue;
        const int on_a = l.scene.joint[l.w.bonds.joint[k].material].name[0] == 'A';
        verify_row("wedge", on_a ? "normal force on A over W" : "normal force on B over W",
                   -fl_bond_list_load(&l.w, k).tension / W, on_a ? 0.797855 : 0.489834, 0.01, VERIFY_REL);
    }
    lab_free(&l);
}

int main(void)
{
    verify_begin("blocks of rock");
    grid();
    oblique_sets();
    counted_planes();
    persistence();
    plane_beside();
    coulomb_slip();
    coulomb_tension();
    coulomb_dilation();
    yielding_once();
    yielding_pressed();
    yielding_cyclic();
    closures();
    block_at_rest();
    joint_memory();
    stress_at_start();
    block_slides();
    block_lands();
    block_factors();
    if (!verify_quick()) tall_block();
    wedge_factors();
    wedge_slides();
    return verify_end();
}
