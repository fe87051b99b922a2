/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/rng.h"
#include "geom/facet.h"
#include "law/contact_law.h"
#include "scene/scene_check.h"
#include "scene/scene_read.h"
#include "sim/energy_balance.h"
#include "sim/setup.h"
#include "sim/sudden_contact.h"
#include "sphere/contact_list.h"
#include "sim/critical_step.h"
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "support/small_world.h"

static void check_result(int rc, const fl_err *err)
{
    if (rc == 0) return;
    printf("lab: %s\n", err->text);
    exit(1);
}

double lab_surrogate_tolerance(void)
{
    const char *with_surrogate = getenv("FLOE_SURROGATE");
    return with_surrogate ? atof(with_surrogate) : 0.0;
}

void lab_start(lab *l)
{
    /* half of the default step, with which the bounds of the tests were set */
    static const char *const KEYS[] = {"ice.file=-",           "run.gravity=0",  "run.duration=1",
                                       "run.threads=1",        "run.safety=0.1", "contact.friction=0",
                                       "contact.restitution=1"};
    memset(l, 0, sizeof *l);
    fl_scene_init(&l->scene);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
    if (getenv("FLOE_LAW")) lab_set(l, "contact.law=patch");
}

/* FLOE_LAW of the environment stands in for the law patch: what patch is held to runs for another law. */
void lab_set(lab *l, const char *assignment)
{
    static const char SURROGATE[] = "contact.surrogate=";
    const char *law = getenv("FLOE_LAW");
    char other[64];
    fl_err err = {0};
    if (!lab_has_surrogates() && strncmp(assignment, SURROGATE, strlen(SURROGATE)) == 0) return;
    if (law && strcmp(assignment, "contact.law=patch") == 0) {
        snprintf(other, sizeof other, "contact.law=%s", law);
        assignment = other;
    }
    check_result(fl_scene_set(&l->scene, assignment, &err), &err);
}

int lab_has_surrogates(void)
{
    const char *law = getenv("FLOE_LAW");
    return !law || strcmp(law, "patch") == 0 || strcmp(law, "quick") == 0;
}

void lab_setf(lab *l, const char *fmt, ...)
{
    char line[256];
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(line, sizeof line, fmt, ap);
    va_end(ap);
    lab_set(l, line);
}

void lab_poly(lab *l, fl_poly *core, double radius, fl_vec3 v, fl_vec3 spin)
{
    fl_err err = {0};
    check_result(fl_ice_field_add(&l->field, l->field.n + 1, radius, core, NULL, NULL, v, spin, &err), &err);
}

void lab_box(lab *l, fl_vec3 centre, fl_vec3 half, double radius, fl_quat q, fl_vec3 v, fl_vec3 spin)
{
    fl_err err = {0};
    fl_poly p = {0};
    check_result(fl_poly_box(&p, v3(half.x - radius, half.y - radius, half.z - radius), &err), &err);
    fl_poly_to_frame(&p, v3(0, 0, 0), q_matrix(q_conj(q)));
    fl_poly_to_frame(&p, v3_neg(centre), q_matrix(q_one()));
    lab_poly(l, &p, radius, v, spin);
}

void lab_sphere(lab *l, fl_vec3 centre, double radius, fl_vec3 v, fl_vec3 spin)
{
    fl_err err = {0};
    fl_poly p = {0};
    check_result(fl_poly_make(&p, 1, &centre, 0, NULL, NULL, &err), &err);
    lab_poly(l, &p, radius, v, spin);
}

void lab_capsule(lab *l, fl_vec3 centre, fl_vec3 half, double radius)
{
    fl_err err = {0};
    fl_poly p = {0};
    const fl_vec3 end[2] = {v3_sub(centre, half), v3_add(centre, half)};
    check_result(fl_poly_make(&p, 2, end, 0, NULL, NULL, &err), &err);
    lab_poly(l, &p, radius, v3(0, 0, 0), v3(0, 0, 0));
}

static fl_part *part(lab *l)
{
    fl_err err = {0};
    const int32_t k = fl_surface_add(&l->surface, "part", 4, &err);
    check_result(k < 0, &err);
    return &l->surface.part[k];
}

void lab_cone(lab *l, fl_cone c)
{
    fl_err err = {0};
    check_result(fl_surface_cone(part(l), c, &err), &err);
}

/* The corners of an n by n grid on each of the six faces; faces share the vertices on their edges. */
void lab_wall(lab *l, fl_vec3 lo, fl_vec3 hi, int n)
{
    fl_err err = {0};
    fl_part *p = part(l);
    const fl_vec3 s = v3_sub(hi, lo);
    int32_t *index = calloc((size_t)(n + 1) * (size_t)(n + 1) * (size_t)(n + 1), sizeof *index);
    if (!index) exit(1);
    for (int axis = 0; axis < 3; axis++) {
        for (int end = 0; end < 2; end++) {
            for (int i = 0; i < n; i++) {
                for (int j = 0; j < n; j++) {
                    int32_t v[4];
                    for (int c = 0; c < 4; c++) {
                        int at[3];
                        at[axis] = end * n;
                        at[(axis + 1) % 3] = i + (c == 1 || c == 2);
                        at[(axis + 2) % 3] = j + (c >= 2);
                        int32_t *k = &index[(at[0] * (n + 1) + at[1]) * (n + 1) + at[2]];
                        if (!*k) {
                            check_result(fl_surface_vertex(p,
                                                           v3(lo.x + s.x * at[0] / n, lo.y + s.y * at[1] / n,
                                                              lo.z + s.z * at[2] / n),
                                                           &err),
                                         &err);
                            *k = p->nv;
                        }
                        v[c] = *k - 1;
                    }
                    check_result(fl_surface_triangle(p, v[0], end ? v[1] : v[2], end ? v[2] : v[1], &err),
                                 &err);
                    check_result(fl_surface_triangle(p, v[0], end ? v[2] : v[3], end ? v[3] : v[2], &err),
                                 &err);
                }
            }
        }
    }
    free(index);
}

void lab_prism(lab *l, int n, const fl_vec3 *xy, double z0, double z1)
{
    fl_err err = {0};
    fl_part *p = part(l);
    int32_t *down = calloc((size_t)n, sizeof *down), *up = calloc((size_t)n, sizeof *up);
    if (!down || !up) exit(1);
    for (int k = 0; k < 2 * n; k++)
        check_result(fl_surface_vertex(p, v3(xy[k % n].x, xy[k % n].y, k < n ? z0 : z1), &err), &err);
    for (int k = 0; k < n; k++) {
        const int32_t wall[4] = {k, (k + 1) % n, n + (k + 1) % n, n + k};
        down[k] = n - 1 - k;
        up[k] = n + k;
        check_result(fl_facet_polygon(p, 4, wall, &err), &err);
    }
    check_result(fl_facet_polygon(p, n, down, &err), &err);
    check_result(fl_facet_polygon(p, n, up, &err), &err);
    free(down), free(up);
}

void lab_make(lab *l, double dt)
{
    fl_err err = {0};
    int32_t body;
    if (l->surface.n) lab_set(l, "structure.file=lab");
    const fl_scene_contact *const all = &l->scene.contact[0]; /* [contact], which lab_start() began */
    const int with_surrogate = lab_surrogate_tolerance() > 0.0 &&
                               fl_contact_law_uses(&fl_contact_laws[all->law], "surrogate") &&
                               !(all->surrogate > 0.0);
    if (with_surrogate) lab_setf(l, "contact.surrogate=%.17g", lab_surrogate_tolerance());
    check_result(fl_scene_check(&l->scene, &err), &err);
    check_result(fl_world_make(&l->w, &l->scene, &l->field, l->surface.n ? &l->surface : NULL, &err), &err);
    if (with_surrogate && !l->w.surrogate_counts) {
        printf("lab: no contact has a surrogate\n");
        exit(1);
    }
    l->w.dt = dt > 0.0 ? dt : fl_automatic_step(&l->w, &body);
    check_result(fl_step_start(&l->w, &err), &err);
    l->made = 1;
}

int lab_run(lab *l, int64_t steps)
{
    fl_err err = {0};
    int64_t sudden = l->w.sudden.n;
    for (int64_t k = 0; k < steps; k++) {
        if (fl_step(&l->w, &err)) {
            printf("lab: %s\n", err.text);
            return err.code;
        }
        if (k == 0) sudden = l->w.sudden.n; /* bodies may have been put elsewhere before */
        if (l->through || l->w.sudden.n == sudden) continue;
        char text[FL_SUDDEN_TEXT];
        printf("lab: %s\n", fl_sudden_contact_text(&l->w, text));
        exit(1);
    }
    return 0;
}

double lab_energy(lab *l)
{
    fl_energy_update(&l->w);
    const fl_ledger *g = &l->w.ledger;
    return g->kinetic + g->gravity + g->elastic + g->hydrostatic;
}

void lab_pose(fl_world *w, int32_t i, fl_vec3 x, fl_quat q)
{
    w->b.x[i] = x;
    w->b.q[i] = q;
    w->b.v[i] = w->b.L[i] = v3(0, 0, 0);
    fl_body_update_spin(&w->b, i);
}

fl_pair lab_evaluate_pair(fl_world *w, int32_t i, int32_t j)
{
    fl_pair p;
    fl_pair_init(w, &p, i, j);
    fl_pair_evaluate(w, &p, 0, 0.0, 0);
    fl_pair_free(&p);
    return p;
}

fl_pair lab_pair(const lab *l, int32_t c)
{
    fl_pair_iterator at = {.w = &l->w};
    const fl_pair *p = fl_pair_next(&at);
    for (int32_t k = 0; k < c && p; k++) p = fl_pair_next(&at);
    return p ? *p : (fl_pair){0};
}

void lab_free(lab *l)
{
    if (l->made) fl_world_free(&l->w);
    fl_ice_field_free(&l->field);
    fl_surface_free(&l->surface);
    fl_scene_free(&l->scene);
}

static void fill_gas(lab *l, double safety)
{
    enum { SIDE = 14 };
    lab_setf(l, "run.safety=%g", safety);
    lab_set(l, "contact.stiffness_factor=0.02");
    lab_set(l, "boundary.type=rigid");
    lab_set(l, "boundary.min=-26.6 -26.6 none");
    lab_set(l, "boundary.max=26.6 26.6 none");
    for (int k = 0; k < SIDE * SIDE; k++) {
        fl_rng g = fl_rng_of(1, k, FL_RNG_TEST);
        const fl_vec3 at = v3(3.8 * (k % SIDE - 0.5 * (SIDE - 1)), 3.8 * (k / SIDE - 0.5 * (SIDE - 1)), 0);
        const double a = fl_rng_in(&g, 0.0, 1.5), half = fl_rng_in(&g, 0.8, 1.25);
        const fl_vec3 v = v3(fl_rng_in(&g, -0.5, 0.5), fl_rng_in(&g, -0.5, 0.5), 0);
        lab_box(l, at, v3(half, half, 0.25), 0.05, q_about_axis(2, a), v, v3(0, 0, fl_rng_in(&g, -0.2, 0.2)));
    }
    lab_make(l, 0.0);
}

void lab_gas(lab *l, const char *law, double safety) { lab_gas_on(l, law, safety, 1); }

void lab_gas_on(lab *l, const char *law, double safety, int threads)
{
    lab_start(l);
    lab_setf(l, "contact.law=%s", law);
    lab_setf(l, "run.threads=%d", threads);
    fill_gas(l, safety);
}

void lab_gas_surrogate(lab *l, double safety, double surrogate)
{
    lab_start(l);
    lab_setf(l, "contact.surrogate=%g", surrogate);
    lab_set(l, "run.threads=1");
    fill_gas(l, safety);
}
