/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bench_contact.c -- cost of one contact in a step, by the kinds of bodies, with the deviation of its force
 * from the gradient of its energy; and libccd's penetration of the same dilated shapes in the same run.
 *
 *     bench_contact               the table
 *     bench_contact CASE N [TOL [LAW]]
 *                                 N evaluations of one case, for instruction counts; with TOL above 0 one
 *                                 of eight contacts by surrogates of that tolerance; without LAW `patch`
 *     bench_contact curves DIR    DIR/tilt.tsv and DIR/slide.tsv: the torque of a face that tilts on another,
 *                                 and the forces of one that slides off it, by law; DIR/friction.tsv: force
 *                                 and moment of a disc, a square, along and across a line that slide and spin
 *
 * Floes: octagonal prisms of 3 m, 0.4 m thick, radius 50 mm, overlapping by 4 mm.  They move by 0.01 mm
 * between evaluations, as in a step of 0.1 ms at 0.1 m/s, so the cost of finding new features is included.
 * Columns `surr`, `exact`, `F off`: with contact.surrogate, one of eight such contacts evaluated in a
 * batch, exact evaluations included; the share of exact evaluations; the largest relative error of the
 * force.  Times are thread time of this machine; compare rows of one run only. */
#include <ccd/ccd.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/pi.h"
#include "contact/active_pairs.h"
#include "contact/pair_force.h"
#include "support/exact_friction.h"
#include "support/small_world.h"

#define RADIUS 0.05
#define OVERLAP 0.004
#define STEP 1e-5      /* [m] */
#define TOLERANCE 1e-3 /* of contacts by surrogates */
#define PITCH 50.0     /* vertical distance of the contacts [m] */

enum { CORNERS = 8, EIGHT = 8, TIMES = 20000, CCD_TIMES = 4000 };

static double thread_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* An upright octagon of half width 1.386 m between opposite sides, rotated and displaced. */
static void octagon(lab *l, fl_vec3 at, double yaw, double tilt)
{
    fl_vec3 xy[CORNERS];
    fl_poly p = {0};
    fl_err err = {0};
    const fl_quat q = q_mul(q_of_vector(v3(0, 0, yaw)), q_of_vector(v3(tilt, 0.7 * tilt, 0)));
    for (int k = 0; k < CORNERS; k++) {
        const double a = 2.0 * PI * (k + 0.5) / CORNERS;
        xy[k] = v3(1.5 * cos(a), 1.5 * sin(a), 0);
    }
    if (fl_poly_prism(&p, CORNERS, xy, -0.2, 0.2, &err)) {
        fprintf(stderr, "%s\n", err.text);
        exit(1);
    }
    fl_poly_to_frame(&p, v3_neg(q_rotate(q_conj(q), at)), q_matrix(q_conj(q)));
    lab_poly(l, &p, RADIUS, v3(0, 0, 0), v3(0, 0, 0));
}

typedef enum {
    SPHERE_ON_FLOE = 1, /* spheres on spheres have their own contact list: bench_spheres */
    SIDE_ON_SIDE,
    SIDE_TURNED,
    SIDE_TILTED,
    EDGE_ON_SIDE,
    FLAT_ON_FLAT,
    FLAT_TURNED,
    FLOE_ON_PLANE,
    FLOE_ON_CYLINDER,
    FLOE_ON_MESH,
    CASES
} which;

static const char *const NAME[CASES] = {NULL,
                                        "sphere on floe",
                                        "side on side",
                                        "side on side, 3 deg",
                                        "side, tilted 1 deg",
                                        "edge on side",
                                        "flat on flat",
                                        "flat, 30 deg, off",
                                        "side on plane",
                                        "side on cylinder",
                                        "side on 2 triangles"};

/* Two bodies, or one and a structure or wall, at a given height. */
static void add_contact(lab *l, which c, double z)
{
    const double half = 1.5 * cos(PI / 8.0), near = 2.0 * RADIUS - OVERLAP, wall = RADIUS - OVERLAP;
    if (c == SPHERE_ON_FLOE) lab_sphere(l, v3(0, 0, z), RADIUS, v3(0, 0, 0), v3(0, 0, 0));
    else octagon(l, v3(0, 0, z), 0.0, 0.0);
    switch (c) {
    case SPHERE_ON_FLOE: octagon(l, v3(half + near, 0.1, z + 0.02), 0.0, 0.0); break;
    case SIDE_ON_SIDE: octagon(l, v3(2.0 * half + near, 0.1, z + 0.02), 0.0, 0.0); break;
    case SIDE_TURNED: octagon(l, v3(2.0 * half + near + 0.02, 0.1, z + 0.02), 3.0 * PI / 180.0, 0.0); break;
    case SIDE_TILTED: octagon(l, v3(2.0 * half + near, 0.1, z + 0.02), 0.0, PI / 180.0); break;
    case EDGE_ON_SIDE: octagon(l, v3(half + 1.5 + near, 0.1, z + 0.02), PI / 8.0, 0.0); break;
    case FLAT_ON_FLAT: octagon(l, v3(0.3, 0.2, z + 0.4 + near), 0.2, 0.0); break;
    case FLAT_TURNED: octagon(l, v3(1.3, 0.2, z + 0.4 + near), 0.5, 0.003); break;
    case FLOE_ON_PLANE: lab_setf(l, "boundary.min=%.17g none none", -half - wall); break;
    case FLOE_ON_CYLINDER:
        lab_cone(l,
                 (fl_cone){v3(half + wall + 1.5, 0.03, z - 6), v3(half + wall + 1.5, 0.03, z + 6), 1.5, 1.5});
        break;
    default: {
        const double x = half + wall; /* an L of walls: not convex, a shell */
        const fl_vec3 xy[6] = {v3(x, -9, 0),    v3(x + 9, -9, 0), v3(x + 9, 9, 0),
                               v3(x - 5, 9, 0), v3(x - 5, 8, 0),  v3(x, 8, 0)};
        lab_prism(l, 6, xy, z - 5, z + 5);
    }
    }
}

/* A number of such contacts above one another. */
static void make_contacts(lab *l, which c, const char *law, double surrogate, int copies)
{
    lab_start(l);
    lab_setf(l, "contact.law=%s", law);
    lab_setf(l, "contact.surrogate=%g", surrogate);
    lab_set(l, "contact.friction=0.3");
    for (int k = 0; k < copies; k++) add_contact(l, c, PITCH * k);
    lab_make(l, 1e-9);
}

static fl_pair *touching_pair(lab *l)
{
    for (int32_t c = 0; c < l->w.n_pair; c++)
        if (l->w.pair[c].touching) return l->w.pair[c].contact;
    return NULL;
}

/* To and fro: sliding, and by a fifth of that in depth; every step has a new pose. */
static void move_body(lab *l, int32_t i, int k)
{
    fl_bodies *b = &l->w.b;
    b->x[i].y += k / 100 % 2 ? -STEP : STEP;
    b->x[i].x += k / 70 % 2 ? -0.2 * STEP : 0.2 * STEP;
    b->odometer[i] += 1.2 * STEP;
}

static void evaluate(lab *l, fl_pair *p, int times)
{
    for (int k = 0; k < times; k++) {
        move_body(l, p->i, k);
        fl_pair_evaluate(&l->w, p, 0, 1e-9, 0);
    }
}

/* All contacts, as in a step. */
static void evaluate_all(lab *l, int times)
{
    fl_world *w = &l->w;
    for (int k = 0; k < times; k++) {
        for (int32_t c = 0; c < w->n_pair; c++)
            if (w->pair[c].touching) move_body(l, w->pair[c].i, k);
        fl_share_active_pairs(w);
        fl_evaluate_active_pairs(w, 1e-9, 0);
    }
}

static double energy_at(lab *l, const fl_pair *p, fl_vec3 d)
{
    fl_bodies *b = &l->w.b;
    const fl_vec3 x = b->x[0];
    b->x[0] = v3_add(x, d);
    const double e = lab_evaluate_pair(&l->w, p->i, p->j).energy;
    b->x[0] = x;
    return e;
}

/* |F + grad W| / |F|, by central differences. */
static double off_gradient(lab *l, const fl_pair *p)
{
    const double h = 1e-7;
    const fl_vec3 f = lab_evaluate_pair(&l->w, p->i, p->j).force;
    const fl_vec3 g = v3(energy_at(l, p, v3(h, 0, 0)) - energy_at(l, p, v3(-h, 0, 0)),
                         energy_at(l, p, v3(0, h, 0)) - energy_at(l, p, v3(0, -h, 0)),
                         energy_at(l, p, v3(0, 0, h)) - energy_at(l, p, v3(0, 0, -h)));
    return v3_norm(v3_madd(f, 0.5 / h, g)) / v3_norm(f);
}

/* --- libccd on the same two dilated shapes ------------------------------------------------------------ */

typedef struct {
    const fl_bodies *b;
    int32_t i;
} shape;

static void support(const void *obj, const ccd_vec3_t *dir, ccd_vec3_t *out)
{
    const shape *s = obj;
    const fl_poly *p = &s->b->core[s->i];
    const fl_vec3 d = v3(dir->v[0], dir->v[1], dir->v[2]), in = m3_tmul(fl_body_axes(s->b, s->i), d);
    int32_t at = 0;
    for (int32_t v = 1; v < p->nv; v++)
        if (v3_dot(in, p->v[v]) > v3_dot(in, p->v[at])) at = v;
    const fl_vec3 x = v3_madd(v3_add(s->b->x[s->i], m3_mul(fl_body_axes(s->b, s->i), p->v[at])),
                              s->b->radius[s->i] / v3_norm(d), d);
    ccdVec3Set(out, x.x, x.y, x.z);
}

static void centre(const void *obj, ccd_vec3_t *out)
{
    const shape *s = obj;
    ccdVec3Set(out, s->b->x[s->i].x, s->b->x[s->i].y, s->b->x[s->i].z);
}

/* Time of a query [s] and relative error of its depth against that of the kernel; < 0 if it finds none. */
static double ask_ccd(lab *l, const fl_pair *p, int mpr, double *error)
{
    const shape a = {&l->w.b, p->i}, b = {&l->w.b, p->j};
    ccd_t ccd;
    ccd_real_t depth = 0;
    ccd_vec3_t dir, at;
    int found = 0;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support;
    ccd.center1 = ccd.center2 = centre;
    ccd.max_iterations = 100;
    ccd.epa_tolerance = ccd.mpr_tolerance = (ccd_real_t)1e-6;
    const double begun = thread_time();
    for (int k = 0; k < CCD_TIMES; k++)
        found = (mpr ? ccdMPRPenetration(&a, &b, &ccd, &depth, &dir, &at)
                     : ccdGJKPenetration(&a, &b, &ccd, &depth, &dir, &at)) == 0;
    const double spent = (thread_time() - begun) / CCD_TIMES;
    *error = found ? fabs((double)depth / lab_evaluate_pair(&l->w, p->i, p->j).overlap - 1.0) : -1.0;
    return spent;
}

/* --- the table ---------------------------------------------------------------------------------------- */

/* With surrogates: time per contact and step [s], share of exact evaluations, largest relative error of the
 * force. */
static double time_with_surrogates(which c, const char *law, double tolerance, double *exact_share,
                                   double *off)
{
    lab l;
    make_contacts(&l, c, law, tolerance, EIGHT);
    fl_pair *p = touching_pair(&l);
    *exact_share = 1.0, *off = INFINITY;
    if (!p) return INFINITY;
    evaluate_all(&l, 200);
    const int64_t before = l.w.surrogate_counts[0].hits;
    const double begun = thread_time();
    evaluate_all(&l, TIMES);
    const double spent = (thread_time() - begun) / TIMES / EIGHT;
    *exact_share = 1.0 - (double)(l.w.surrogate_counts[0].hits - before) / TIMES / EIGHT;
    *off = 0.0;
    for (int k = 0; k < 400; k++) {
        evaluate_all(&l, 1);
        const fl_vec3 f = lab_evaluate_pair(&l.w, p->i, p->j).force;
        *off = fmax(*off, v3_norm(v3_sub(v3_sub(p->force, v3_add(p->force_friction, p->force_damping)), f)) /
                              v3_norm(f));
    }
    lab_free(&l);
    return spent;
}

static int print_row(which c, const char *law)
{
    lab l;
    make_contacts(&l, c, law, 0.0, 1);
    fl_pair *p = touching_pair(&l);
    if (!p) return 1;
    const double off = off_gradient(&l, p);
    evaluate(&l, p, 200);
    const double begun = thread_time();
    evaluate(&l, p, TIMES);
    const double ns = 1e9 * (thread_time() - begun) / TIMES;
    const int features = p->feature_pairs ? p->feature_pairs->n : p->quick_list ? p->quick_list->n : 0;
    printf("%-20s %-10s %8d %8d %10.0f %12.1e", NAME[c], law, features, l.w.scratch[0].n, ns, off);
    if (p->j < l.w.n && strcmp(law, "patch") == 0) {
        double error[2], t[2];
        for (int k = 0; k < 2; k++) t[k] = ask_ccd(&l, p, k, &error[k]);
        printf(" %10.0f %10.1e %10.0f %10.1e", 1e9 * t[1], error[1], 1e9 * t[0], error[0]);
    } else if (strcmp(law, "patch") == 0) {
        printf(" %10s %10s %10s %10s", "-", "-", "-", "-");
    }
    if (strcmp(law, "quick") == 0) printf(" %10s %10s %10s %10s", "-", "-", "-", "-");
    if (p->points == FL_POINTS_PATCH) {
        double exact_share, most;
        const double t = time_with_surrogates(c, law, TOLERANCE, &exact_share, &most);
        printf(" %8.0f %8.3f %9.1e", 1e9 * t, exact_share, most);
    }
    printf("\n");
    const int gradient = strcmp(law, "patch") == 0 || strcmp(law, "quick") == 0,
              bad = p->touching == 0 || (gradient && !(off < 1e-5));
    lab_free(&l);
    return bad;
}

/* --- curves ------------------------------------------------------------------------------------------- */

enum { LAWS = 5 };
static const char *const LAW[LAWS] = {"patch", "core", "manual-si", "manual", "quick"};

/* A box of 2 by 2 by 0.5 m on one of 4 by 4 by 0.5 m, 1 mm deep, tilted or moved along x. */
static fl_pair tilted_boxes(const char *law, double tilt, double slide)
{
    lab l;
    lab_start(&l);
    lab_setf(&l, "contact.law=%s", law);
    const fl_quat flat = q_of_vector(v3(0, 0, 0));
    lab_box(&l, v3(slide, 0.0, 0.499), v3(1, 1, 0.25), RADIUS, q_of_vector(v3(0, tilt, 0)), v3(0, 0, 0),
            v3(0, 0, 0));
    lab_box(&l, v3(0, 0, 0), v3(2, 2, 0.25), RADIUS, flat, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-9);
    const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
    lab_free(&l);
    return p;
}

/* F/(mu N) and M/(mu N rho) of faces under an even pressure, v along `angle`: exact, law, and the ellipse of
 * M0 = mu N rho. */
static void write_friction_rows(FILE *f, int n, const fl_vec3 *corner, double angle)
{
    fl_vec3 centre;
    const fl_sym3 C = polygon_second_moments(n, corner, &centre);
    const double rho = sqrt(C.xx + C.yy);
    for (int k = 0; k <= 200; k++) {
        const double a = 0.5 * PI * k / 200, v = sin(a) * rho, w = cos(a);
        const fl_vec3 way = v3(v * cos(angle), v * sin(angle), 0.0);
        const flat_wrench e = exact_polygon_friction(n, corner, way, w), q = law_friction(C, way, w);
        fprintf(f, "%g\t%g\t%g\t%g\t%g\t%g\n", hypot(e.x, e.y), e.m / rho, hypot(q.x, q.y), q.m / rho, sin(a),
                cos(a));
    }
    fprintf(f, "\n\n");
}

static int write_friction(const char *dir)
{
    enum { DISC = 96 };
    const double thin = 1e-3;
    fl_vec3 disc[DISC];
    const fl_vec3 square[4] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}},
                  line[4] = {{-0.5, -thin, 0}, {0.5, -thin, 0}, {0.5, thin, 0}, {-0.5, thin, 0}};
    char name[512];
    snprintf(name, sizeof name, "%s/friction.tsv", dir);
    FILE *f = fopen(name, "w");
    if (!f) return 1;
    for (int k = 0; k < DISC; k++) disc[k] = v3(cos(2.0 * PI * k / DISC), sin(2.0 * PI * k / DISC), 0.0);
    write_friction_rows(f, DISC, disc, 0.0);
    write_friction_rows(f, 4, square, 0.0);
    write_friction_rows(f, 4, line, 0.0);
    write_friction_rows(f, 4, line, 0.5 * PI);
    return fclose(f) != 0;
}

static int write_curves(const char *dir)
{
    char name[512];
    snprintf(name, sizeof name, "%s/tilt.tsv", dir);
    FILE *f = fopen(name, "w");
    if (!f) return 1;
    for (int k = -200; k <= 200; k++) {
        const double tilt = 1e-5 * k;
        fprintf(f, "%g", tilt);
        for (int c = 0; c < LAWS; c++) fprintf(f, "\t%g", tilted_boxes(LAW[c], tilt, 0.0).torque_i.y);
        fprintf(f, "\n");
    }
    int bad = fclose(f);
    snprintf(name, sizeof name, "%s/slide.tsv", dir);
    f = fopen(name, "w");
    if (!f) return 1;
    for (int k = 0; k <= 440; k++) {
        const double slide = 0.8 + 0.005 * k;
        fprintf(f, "%g", slide);
        for (int c = 0; c < LAWS; c++) fprintf(f, "\t%g", tilted_boxes(LAW[c], 0.0, slide).force.z);
        fprintf(f, "\n");
    }
    bad |= fclose(f);
    return bad != 0 || write_friction(dir);
}

int main(int argc, char **argv)
{
    int bad = 0, rows = 0;
    if (argc == 3 && strcmp(argv[1], "curves") == 0) return write_curves(argv[2]);
    if (argc >= 3 && argc <= 5) {
        lab l;
        const double tolerance = argc > 3 ? atof(argv[3]) : 0.0;
        make_contacts(&l, (which)atoi(argv[1]), argc > 4 ? argv[4] : "patch", tolerance,
                      tolerance > 0.0 ? EIGHT : 1);
        fl_pair *p = touching_pair(&l);
        if (p && tolerance > 0.0) evaluate_all(&l, atoi(argv[2]) / EIGHT);
        else if (p) evaluate(&l, p, atoi(argv[2]));
        lab_free(&l);
        return p == NULL;
    }
    printf("one contact, all of its forces with friction and damping; moved 0.01 mm between evaluations\n");
    printf("%-20s %-10s %8s %8s %10s %12s %10s %10s %10s %10s %8s %8s %9s\n", "contact", "law", "features",
           "points", "ns", "F + grad W", "MPR[ns]", "depth off", "EPA[ns]", "depth off", "surr[ns]", "exact",
           "F off");
    for (int c = SPHERE_ON_FLOE; c < CASES; c++, rows++) bad += print_row((which)c, "patch");
    for (int c = SIDE_ON_SIDE; c <= FLAT_TURNED; c++, rows++) bad += print_row((which)c, "quick");
    for (int k = 1; k < 3; k++) {
        bad += print_row(SIDE_TURNED, LAW[k]) + print_row(FLAT_TURNED, LAW[k]);
        rows += 2;
    }
    printf("%d passed, %d failed\n", rows - bad, bad);
    return bad > 0;
}
