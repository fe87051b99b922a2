/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/plausibility.h"
#include "scene/scene_check.h"
#include "scene/scene_read.h"

/* A box of ice, 2r included in its sides. */
static void add_box(fl_ice_field *a, int32_t id, double length, double thickness, const char *material)
{
    const double r = 0.001 * fmin(length, thickness), x = 0.5 * length - r, z = 0.5 * thickness - r;
    fl_poly core = {0};
    fl_err err = {0};
    assert_int_equal(fl_poly_box(&core, v3(x, x, z), &err), 0);
    assert_int_equal(fl_ice_field_add(a, id, r, &core, material, NULL, v3(0, 0, 0), v3(0, 0, 0), &err), 0);
}

/* What is said of a scene of ordinary ice with one key set; NULL: nothing. */
static const char *refusal(const char *set, const fl_floe_extent *floes, const char *water)
{
    static fl_err err;
    fl_scene s = {0};
    char text[400];
    snprintf(text, sizeof text,
             "[ice]\nfile = ice.dat\n[material ice]\ndensity = 900\n[structure]\nfile = a\n"
             "[boundary]\nmin = none -9 none\n[contact]\nstiffness_factor = 0.5\n%s",
             water);
    err = (fl_err){0};
    assert_int_equal(fl_scene_read(&s, test_file("a.scene", text, strlen(text)), &err), 0);
    if (set && fl_scene_set(&s, set, &err)) fail_msg("%s", err.text);
    if (fl_scene_check(&s, &err)) fail_msg("%s", err.text);
    const int rc = fl_scene_check_plausible(&s, floes, &err);
    fl_scene_free(&s);
    return rc ? err.text : NULL;
}

static const char WATER[] = "[water]\ncurrent = 0.5\n";

static void expect_refused(const char *set, const char *words)
{
    const fl_floe_extent none = {0};
    const char *said = refusal(set, &none, WATER);
    if (!said || !strstr(said, words)) fail_msg("%s: %s, not \"%s\"", set, said ? said : "accepted", words);
    if (!strstr(said, "--force")) fail_msg("%s: no way out", said);
}

static void a_unit_is_guessed(void **state)
{
    (void)state;
    expect_refused("material.ice.density=0.9",
                   "0.9 kg/m3 is outside what exists on earth, 500 to 950 kg/m3: t/m3?");
    expect_refused("material.ice.young=5", "GPa?");
    expect_refused("material.ice.young=5000", "MPa?");
    expect_refused("water.density=1.025", "t/m3?");
    expect_refused("water.current=50", "cm/s?");
    expect_refused("structure.velocity=25 0 0", "kn?");
    expect_refused("structure.friction=15", "%?");
    expect_refused("material.ice.density=1100", "500 to 950 kg/m3;"); /* no unit helps */
    expect_refused("material.ice.young=1e11", "to 1.2e+10 Pa;");
    expect_refused("water.drag_force_coef=5", "1e-3?");
}

/* Each wide range ends where its page says. */
static void ranges_end_where_they_say(void **state)
{
    static const struct {
        const char *good, *bad;
    } PAIR[] = {{"material.ice.density=500", "material.ice.density=499"},
                {"material.ice.density=950", "material.ice.density=951"},
                {"water.density=990", "water.density=989"},
                {"water.density=1050", "water.density=1051"},
                {"material.ice.young=1e6", "material.ice.young=0.99e6"},
                {"material.ice.young=12e9", "material.ice.young=12.1e9"},
                {"material.ice.poisson=0.45", "material.ice.poisson=0.46"},
                {"material.ice.friction=2", "material.ice.friction=2.1"},
                {"contact.friction=2", "contact.friction=2.1"},
                {"water.current=3 4 0", "water.current=3 4.1 0"},
                {"structure.velocity=0 20 0", "structure.velocity=0 20.1 0"},
                {"water.drag_force_coef=0.1", "water.drag_force_coef=0.11"}};
    const fl_floe_extent none = {0};
    (void)state;
    for (size_t k = 0; k < sizeof PAIR / sizeof *PAIR; k++) {
        const char *said = refusal(PAIR[k].good, &none, WATER);
        if (said) fail_msg("%s: %s", PAIR[k].good, said);
        if (!refusal(PAIR[k].bad, &none, WATER)) fail_msg("%s is accepted", PAIR[k].bad);
    }
}

/* Rock and dry blocks have other bounds. */
static void only_ice_in_water_is_looked_at(void **state)
{
    const fl_floe_extent none = {0};
    (void)state;
    assert_null(refusal("material.ice.density=2600", &none, ""));
    assert_null(refusal("material.ice.friction=1e6", &none, ""));
    assert_null(refusal("material.ice.density=2600", &none,
                        "[material rock]\ndensity = 2600\n[water]\n[ice]\nmaterial = rock\n"));
}

static void floes_have_sizes(void **state)
{
    fl_ice_field a = {0};
    (void)state;
    add_box(&a, 7, 6.0, 0.4, "ice");
    add_box(&a, 9, 8.0, 0.6, NULL);
    fl_floe_extent e = fl_floe_extent_of(&a);
    assert_int_equal(e.n, 2);
    assert_near(e.thinnest, 0.4, 1e-12);
    assert_near(e.longest, 8.0, 1e-12);
    assert_true(e.longest_id == 9 && e.shortest_id == 7 && e.blocks == 0);
    assert_null(refusal(NULL, &e, WATER));
    add_box(&a, 11, 1.0, 400.0, "concrete");
    e = fl_floe_extent_of(&a);
    assert_int_equal(e.n, 2);
    add_box(&a, 12, 500.0, 400.0, "ice");
    e = fl_floe_extent_of(&a);
    const char *said = refusal(NULL, &e, WATER);
    assert_non_null(said);
    if (!strstr(said, "ice.dat: floe 12: a thickness of 400 m") || !strstr(said, "cm?")) fail_msg("%s", said);
    fl_ice_field_free(&a);
}

/* What is unusual and exists runs, with one line for each. */
static void unusual_values_are_warned_of(void **state)
{
    static const char TEXT[] =
        "[ice]\nfile = a\n[material ice]\nfriction = 0.9\nyoung = 20 MPa\n[water]\ncurrent = 3\n";
    char *said = NULL;
    size_t n;
    fl_scene s = {0};
    fl_err err = {0};
    const fl_floe_extent none = {0}, blocks = {3, 1.0, 6.0, 1.0, 4.0, 1, 2, 3, 4, 2};
    (void)state;
    assert_int_equal(fl_scene_read(&s, test_file("a.scene", TEXT, sizeof TEXT - 1), &err), 0);
    assert_int_equal(fl_scene_check(&s, &err), 0);
    assert_int_equal(fl_scene_check_plausible(&s, &none, &err), 0);
    FILE *f = open_memstream(&said, &n);
    fl_scene_warn_implausible(&s, &none, "> ", f);
    fclose(f);
    assert_string_equal(said, "> water.current of 3 m/s is unusual, at most 2 m/s is expected\n"
                              "> material.ice.young of 2e+07 Pa is unusual, 1e+08 to 1e+10 Pa is expected\n"
                              "> material.ice.friction of 0.9 is unusual, at most 0.6 is expected\n");
    free(said);
    f = open_memstream(&said, &n);
    fl_scene_warn_implausible(&s, &blocks, "> ", f);
    fclose(f);
    if (!strstr(said, "floe 2: a thickness of 6 m is unusual") || !strstr(said, "2 of 3 floes are blocks"))
        fail_msg("%s", said);
    free(said);
    fl_scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_unit_is_guessed),
        cmocka_unit_test(ranges_end_where_they_say),
        cmocka_unit_test(only_ice_in_water_is_looked_at),
        cmocka_unit_test(floes_have_sizes),
        cmocka_unit_test(unusual_values_are_warned_of),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
