/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A device that runs the spheres of a world gives the bits of the CPU: hashes in each step, and at the end
 * all that a checkpoint holds.  The device is the serial launcher, forwards and backwards. */
#define _GNU_SOURCE /* open_memstream */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "gpu/gpu_world.h"
#include "sim/device_step.h"
#include "sim/energy_balance.h"
#include "sim/snapshot.h"
#include "support/scenes.h"

typedef void a_scene(lab *l, int32_t side, const char *law);

/* Spheres of three sizes that fall into a box and stay in motion. */
static void scene_of_pack(lab *l, int32_t side, const char *law)
{
    lab_start(l);
    lab_set(l, "material.ice.young=10 MPa");
    lab_set(l, "contact.friction=0.4");
    lab_set(l, "contact.restitution=0.6");
    lab_set(l, "run.gravity=1 0.5 -9.81");
    lab_setf(l, "boundary.max=%d %d none", side, side);
    lab_set(l, "boundary.min=0 0 0");
    if (law) lab_setf(l, "contact.rolling=%s", law);
    for (int32_t k = 0; k < side * side * side; k++) {
        const double x = k % side, y = k / side % side, z = k / (side * side);
        lab_sphere(l, v3(x + 0.5, y + 0.5, z + 0.48), 0.42 + 0.04 * (k % 3),
                   v3(0.4 * (k % 5) - 0.8, 0.3 * (k % 4) - 0.4, 0.0), v3(0, 0.2 * (k % 7), 0));
    }
}

/* Bonds that hold nearly nothing, so that most break, in water without added mass. */
static void scene_of_weak_sheet(lab *l, int32_t side, const char *law)
{
    scene_of_sheet(l, side, law);
    lab_set(l, "bond.normal_strength=4 kPa");
}

/* Spheres that fall onto a cone, a convex solid and a plate that turn, and roll off between walls. */
static void scene_of_pieces(lab *l, int32_t side, const char *law)
{
    static const fl_vec3 ROOF[] = {{0, 0, 0}, {1.3, 0, 0}, {1.3, 1.3, 0}, {0, 1.3, 0}};
    lab_start(l);
    lab_set(l, "material.ice.young=10 MPa");
    lab_set(l, "contact.friction=0.4");
    lab_set(l, "contact.restitution=0.5");
    lab_set(l, "run.gravity=0.5 0.3 -9.81");
    lab_setf(l, "boundary.max=%d %d none", side, side);
    lab_set(l, "boundary.min=0 0 0");
    if (law) lab_set(l, law);
    lab_cone(l, (fl_cone){.p0 = v3(2.5, 2.5, 0), .p1 = v3(2.6, 2.4, 0.9), .r0 = 0.8, .r1 = 0.2});
    lab_prism(l, 4, ROOF, 0.1, 0.7);
    lab_wall(l, v3(3.2, 0.2, 0.5), v3(4.2, 1.4, 0.5), 2);
    for (int32_t k = 0; k < side * side * 2; k++)
        lab_sphere(l, v3(k % side + 0.5, k / side % side + 0.5, 1.2 + 0.75 * (k / (side * side))),
                   0.3 + 0.04 * (k % 3), v3(0.3 * (k % 5) - 0.6, 0.2 * (k % 4) - 0.3, -1.0),
                   v3(0, 0.2 * (k % 7), 0));
}

/* The same on a mesh with an inner corner, and on two cones that are one piece. */
static void scene_of_meshes(lab *l, int32_t side, const char *law)
{
    static const fl_vec3 L[] = {{0.4, 3, 0}, {1.6, 3, 0}, {1.6, 3.6, 0},
                                {1, 3.6, 0}, {1, 4.6, 0}, {0.4, 4.6, 0}};
    scene_of_pieces(l, side, law);
    lab_prism(l, 6, L, 0.1, 0.8);
    lab_cone(l, (fl_cone){.p0 = v3(3.8, 3.8, 0), .p1 = v3(3.8, 3.8, 0.6), .r0 = 0.7, .r1 = 0.4});
    lab_cone(l, (fl_cone){.p0 = v3(3.8, 3.8, 0.6), .p1 = v3(3.8, 3.8, 1.4), .r0 = 0.4, .r1 = 0.4});
}

static char *text_of(fl_world *w)
{
    size_t n = 0;
    char *text = NULL;
    FILE *f = open_memstream(&text, &n);
    assert_non_null(f);
    fl_snapshot_write(f, w);
    assert_int_equal(fclose(f), 0);
    return text;
}

/* Prints the first words that differ. */
static void same_text(const char *a, const char *b)
{
    size_t k = 0, word = 0;
    while (a[k] && a[k] == b[k]) {
        if (a[k] == ' ' || a[k] == '\n') word = k + 1;
        k++;
    }
    if (a[k] != b[k]) {
        size_t line = word;
        while (line && a[line - 1] != '\n') line--;
        print_error("%.40s...: %.16s and %.16s in column %zu\n", a + line, a + word, b + word, word - line);
    }
    assert_true(a[k] == b[k]);
}

static void take_device(fl_world *w, const fl_gpu_engine *e)
{
    fl_err err = {0};
    assert_null(fl_gpu_world_refuses(w));
    w->device.gpu = fl_gpu_world_make(e, &err);
    assert_non_null(w->device.gpu);
}

static void refresh(fl_world *w)
{
    fl_err err = {0};
    assert_int_equal(fl_device_refresh(w, &err), 0);
}

static void leave_device(fl_world *w)
{
    refresh(w);
    fl_device_free(w);
}

/* Steps of both; with `changes` the second goes from the CPU to the device and back. */
static void runs_alike(a_scene *make, int32_t side, const char *law, const fl_gpu_engine *e, int64_t steps,
                       int changes)
{
    lab a, b;
    make(&a, side, law);
    make(&b, side, law);
    lab_make(&a, 0.0);
    lab_make(&b, 0.0);
    if (!changes) take_device(&b.w, e);
    for (int64_t k = 0; k < steps; k++) {
        if (changes && k == steps / 3) take_device(&b.w, e);
        if (changes && k == 2 * steps / 3) leave_device(&b.w);
        assert_int_equal(lab_run(&a, 1), lab_run(&b, 1));
        if (k % 50) continue;
        refresh(&b.w);
        if (fl_state_hash(&a.w) != fl_state_hash(&b.w))
            print_error("the runs part before step %lld\n", (long long)k);
        assert_true(fl_state_hash(&a.w) == fl_state_hash(&b.w));
    }
    refresh(&b.w);
    fl_energy_update(&a.w);
    fl_energy_update(&b.w);
    assert_true(a.w.searches > 1);
    assert_true(a.w.contact_steps > 0);
    char *ta = text_of(&a.w), *tb = text_of(&b.w);
    same_text(ta, tb);
    free(ta), free(tb);
    lab_free(&a), lab_free(&b);
}

static void a_pack_has_the_bits_of_the_cpu(void **state)
{
    (void)state;
    runs_alike(scene_of_pack, 5, NULL, fl_gpu_serial(), 2000, 0);
}

static void rolling_has_the_bits_of_the_cpu(void **state)
{
    (void)state;
    runs_alike(scene_of_pack, 5, "0.2", fl_gpu_serial_backwards(), 2000, 0);
}

/* Every ninth body is a box, which the CPU moves. */
static void a_periodic_cell_with_boxes_has_the_bits_of_the_cpu(void **state)
{
    (void)state;
    runs_alike(scene_of_spheres, 5, NULL, fl_gpu_serial(), 1000, 0);
}

static void a_sheet_that_breaks_on_a_cone_has_the_bits_of_the_cpu(void **state)
{
    (void)state;
    runs_alike(scene_of_sheet, 4, NULL, fl_gpu_serial(), 2000, 0);
    runs_alike(scene_of_weak_sheet, 4, NULL, fl_gpu_serial_backwards(), 2000, 0);
}

/* Spheres on pieces at rest, and on ones that turn as prescribed: none is left to the CPU. */
static void spheres_on_pieces_have_the_bits_of_the_cpu(void **state)
{
    lab l;
    (void)state;
    runs_alike(scene_of_pieces, 5, NULL, fl_gpu_serial(), 1500, 0);
    runs_alike(scene_of_pieces, 5, "structure.velocity=0.3 0 0.1", fl_gpu_serial_backwards(), 1000, 0);
    runs_alike(scene_of_pieces, 5, "structure.spin=0 0 0.5", fl_gpu_serial(), 1000, 1);
    scene_of_pieces(&l, 5, NULL);
    lab_make(&l, 0.0);
    take_device(&l.w, fl_gpu_serial());
    lab_run(&l, 800);
    assert_true(l.w.n_touching > 0);
    assert_int_equal(fl_device_guests(&l.w), 0);
    lab_free(&l);
}

/* Spheres that touch one wall of a mesh are the device's, those in inner corners the CPU's. */
static void spheres_on_meshes_have_the_bits_of_the_cpu(void **state)
{
    lab l;
    (void)state;
    runs_alike(scene_of_meshes, 5, NULL, fl_gpu_serial(), 1500, 0);
    runs_alike(scene_of_meshes, 5, "structure.velocity=0.2 0 0.1", fl_gpu_serial_backwards(), 1000, 1);
    scene_of_meshes(&l, 5, NULL);
    lab_make(&l, 0.0);
    take_device(&l.w, fl_gpu_serial());
    lab_run(&l, 800);
    assert_true(l.w.n_touching > 0);
    assert_true(fl_device_guests(&l.w) < l.w.n_touching);
    lab_free(&l);
}

/* A card cannot tell on which side of a mesh a sphere is that begins inside of it: the CPU does. */
static void scene_inside_of_a_mesh(lab *l, int32_t side, const char *law)
{
    scene_of_meshes(l, side, law);
    lab_sphere(l, v3(3.8, 3.45, 0.9), 0.2, v3(0, -0.1, 0), v3(0, 0, 0));
    lab_sphere(l, v3(1.3, 3.3, 0.75), 0.2, v3(0, 0, 0.1), v3(0, 0, 0));
}

static void spheres_inside_of_a_mesh_have_the_bits_of_the_cpu(void **state)
{
    (void)state;
    runs_alike(scene_inside_of_a_mesh, 5, NULL, fl_gpu_serial(), 400, 0);
}

static void a_run_may_change_its_device(void **state)
{
    (void)state;
    runs_alike(scene_of_pack, 4, "0.1", fl_gpu_serial(), 1500, 1);
    runs_alike(scene_of_sheet, 4, NULL, fl_gpu_serial(), 1500, 1);
}

/* Waves; spheres do not stand for a slab there. */
static void put_in_waves(lab *l)
{
    static const char *const KEYS[] = {"water.wave=jonswap", "water.height=0.3 m", "water.period=3 s",
                                       "water.components=8", "water.added_mass=0", "ice.slab=none"};
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
}

static void scene_of_sheet_in_waves(lab *l, int32_t side, const char *law)
{
    scene_of_sheet(l, side, law);
    put_in_waves(l);
}

/* Waves, wind, a current with a profile and drag by facets on spheres and boxes. */
static void scene_of_seas_without_added_mass(lab *l, int32_t side, const char *law)
{
    scene_of_seas(l, side, law);
    lab_set(l, "water.added_mass=0");
}

static void other_waters_have_the_bits_of_the_cpu(void **state)
{
    (void)state;
    runs_alike(scene_of_sheet_in_waves, 3, NULL, fl_gpu_serial(), 600, 0);
    runs_alike(scene_of_sheet_in_waves, 3, NULL, fl_gpu_serial_backwards(), 300, 1);
    runs_alike(scene_of_seas_without_added_mass, 2, NULL, fl_gpu_serial(), 300, 0);
}

static void scene_of_endless_sheet_in_waves(lab *l, int32_t side, const char *law)
{
    scene_of_endless_sheet(l, side, law);
    put_in_waves(l);
}

static void inflow_and_outflow_have_the_bits_of_the_cpu(void **state)
{
    (void)state;
    runs_alike(scene_of_endless_sheet, 3, NULL, fl_gpu_serial(), 1200, 0);
    runs_alike(scene_of_endless_sheet, 3, NULL, fl_gpu_serial_backwards(), 600, 1);
    runs_alike(scene_of_endless_sheet_in_waves, 3, NULL, fl_gpu_serial(), 600, 0);
    runs_alike(scene_of_inflow, 3, NULL, fl_gpu_serial(), 600, 0);
}

/* Spheres that leave one by one and touch others: of a stream that is pushed from behind; with `law`, the
 * strength of bonds, of a sheet that breaks. */
static void scene_of_outflow(lab *l, int32_t side, const char *law)
{
    if (law) {
        scene_of_sheet(l, side, NULL);
        lab_setf(l, "bond.normal_strength=%s", law), lab_setf(l, "bond.shear_strength=%s", law);
        lab_set(l, "water.current=-4 0 0");
        lab_set(l, "boundary.drive_width=none"), lab_set(l, "boundary.drive=0");
        lab_set(l, "boundary.min=-1.55 none none");
        for (int32_t k = 0; k < l->field.n; k++) l->field.velocity[k].x -= 5.0;
        return;
    }
    scene_of_pack(l, side, "0.1");
    lab_set(l, "material.ice.young=100 kPa"), lab_set(l, "run.gravity=0 0 0");
    lab_set(l, "boundary.type=free periodic free"), lab_set(l, "boundary.min=none 0 none");
    lab_setf(l, "boundary.max=%d %d none", side, side);
    for (int32_t k = 0; k < l->field.n; k++) l->field.velocity[k].x += 2.0 * (side - l->field.core[k].v[0].x);
}

/* Bodies leave, each in a step of its own, and the others stay on the device. */
static void leaves_one_by_one(const char *law, int32_t side, int64_t steps, const fl_gpu_engine *e)
{
    lab l;
    runs_alike(scene_of_outflow, side, law, e, steps, 0);
    scene_of_outflow(&l, side, law);
    lab_make(&l, 0.0);
    take_device(&l.w, e);
    lab_run(&l, steps);
    print_message("%lld left, %lld lists, %lld hand-overs\n", (long long)l.w.inflow.n_left,
                  (long long)l.w.searches, (long long)fl_device_hand_overs(&l.w));
    assert_true(l.w.inflow.n_left > 10);
    assert_int_equal(fl_device_hand_overs(&l.w), 0); /* and so no more than lists */
    lab_free(&l);
}

static void bodies_leave_one_by_one(void **state)
{
    (void)state;
    leaves_one_by_one(NULL, 4, 400, fl_gpu_serial());
    leaves_one_by_one("45 kPa", 4, 1800, fl_gpu_serial_backwards());
}

/* Names what does not run there. */
static void what_is_not_there_is_refused(void **state)
{
    lab l;
    (void)state;
    scene_of_seas(&l, 2, NULL);
    lab_make(&l, 0.0);
    assert_non_null(strstr(fl_gpu_world_refuses(&l.w), "added mass"));
    lab_free(&l);
    scene_of_pushed_ice(&l, 2, NULL);
    lab_make(&l, 0.0);
    assert_non_null(strstr(fl_gpu_world_refuses(&l.w), "line load"));
    lab_free(&l);
}

static int lost_after; /* downloads until the card is lost */

static int download_until_lost(void *to, const void *from, size_t bytes)
{
    if (lost_after-- > 0) return fl_gpu_serial()->download(to, from, bytes);
    return -1;
}

static const char *why_lost(void) { return "a kernel: unspecified launch failure"; }

/* One sentence, and exit 4. */
static void a_lost_card_ends_the_run(void **state)
{
    fl_gpu_engine e = *fl_gpu_serial();
    lab l;
    fl_err err = {0};
    (void)state;
    e.download = download_until_lost, e.why = why_lost;
    lost_after = 40;
    scene_of_pack(&l, 3, NULL);
    lab_make(&l, 0.0);
    take_device(&l.w, &e);
    int rc = 0;
    for (int k = 0; k < 100 && !rc; k++) rc = fl_step(&l.w, &err);
    assert_int_equal(err.code, FL_SYSTEM);
    assert_non_null(strstr(err.text, "the last checkpoint stands"));
    assert_int_equal(fl_device_refresh(&l.w, &err), -1);
    lab_free(&l);
}

static int no_memory(void **to, size_t bytes)
{
    *to = NULL;
    return bytes > 4096 ? -1 : fl_gpu_serial()->alloc(to, bytes);
}

static double a_mebibyte(void) { return 1048576.0; }

static void too_little_memory_is_said(void **state)
{
    fl_gpu_engine e = *fl_gpu_serial();
    lab l;
    fl_err err = {0};
    (void)state;
    e.alloc = no_memory, e.free_bytes = a_mebibyte;
    scene_of_pack(&l, 5, NULL);
    lab_make(&l, 0.0);
    take_device(&l.w, &e);
    assert_int_equal(fl_step(&l.w, &err), -1);
    assert_int_equal(err.code, FL_SYSTEM);
    assert_non_null(strstr(err.text, "bodies would fit"));
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pack_has_the_bits_of_the_cpu),
        cmocka_unit_test(rolling_has_the_bits_of_the_cpu),
        cmocka_unit_test(a_periodic_cell_with_boxes_has_the_bits_of_the_cpu),
        cmocka_unit_test(a_sheet_that_breaks_on_a_cone_has_the_bits_of_the_cpu),
        cmocka_unit_test(spheres_on_pieces_have_the_bits_of_the_cpu),
        cmocka_unit_test(spheres_on_meshes_have_the_bits_of_the_cpu),
        cmocka_unit_test(spheres_inside_of_a_mesh_have_the_bits_of_the_cpu),
        cmocka_unit_test(a_run_may_change_its_device),
        cmocka_unit_test(other_waters_have_the_bits_of_the_cpu),
        cmocka_unit_test(inflow_and_outflow_have_the_bits_of_the_cpu),
        cmocka_unit_test(bodies_leave_one_by_one),
        cmocka_unit_test(what_is_not_there_is_refused),
        cmocka_unit_test(a_lost_card_ends_the_run),
        cmocka_unit_test(too_little_memory_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
