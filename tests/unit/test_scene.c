/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "law/contact_law.h"
#include "scene/scene_check.h"
#include "scene/scene_read.h"
#include "scene/scene_section.h"
#include "scene/scene_print.h"
#include "scene/scene_value.h"

#define ICE "[ice]\nfile = ice.dat\n"

/* Reads one text and checks it. */
static int load(fl_scene *s, const char *text, fl_err *err)
{
    *s = (fl_scene){0};
    *err = (fl_err){0};
    return fl_scene_read(s, test_file("case.scene", text, strlen(text)), err) || fl_scene_check(s, err) ? -1
                                                                                                        : 0;
}

static void load_good(fl_scene *s, const char *text)
{
    fl_err err;
    if (load(s, text, &err)) fail_msg("%s: %s", text, err.text);
}

static void expect_accepted(const char *text)
{
    fl_scene s;
    load_good(&s, text);
    fl_scene_free(&s);
}

/* Expects a refusal of the text; `tail` is the message after "case.scene". */
static void expect_refusal(const char *text, const char *tail)
{
    fl_scene s;
    fl_err err;
    const char *at;
    if (load(&s, text, &err) == 0) fail_msg("accepted, but %s is expected:\n%s", tail, text);
    at = strstr(err.text, "case.scene");
    if (!at || strcmp(at + strlen("case.scene"), tail) != 0)
        fail_msg("for\n%s\nit says   %s\nwanted    ...case.scene%s", text, err.text, tail);
    assert_int_equal(err.code, FL_INPUT);
    fl_scene_free(&s);
}

/* Expects exactly this message from --set with this assignment and the check after it. */
static void expect_set_refusal(const char *assignment, const char *says)
{
    fl_scene s;
    fl_err err = {0};
    load_good(&s, ICE);
    if (fl_scene_set(&s, assignment, &err) == 0) assert_int_equal(fl_scene_check(&s, &err), -1);
    assert_string_equal(err.text, says);
    assert_int_equal(err.code, FL_USAGE);
    fl_scene_free(&s);
}

static char *write_scene(const fl_scene *s)
{
    char *text = NULL;
    size_t n;
    FILE *f = open_memstream(&text, &n);
    fl_scene_write(f, s);
    fclose(f);
    return text;
}

static void every_default_reads_back(void **state)
{
    fl_scene_output scratch; /* the largest section */
    char why[400], text[FL_VALUE_TEXT], again[FL_VALUE_TEXT];
    (void)state;
    for (int k = 0; k < fl_key_count; k++) {
        const fl_key *key = &fl_key_table[k];
        assert_true(key->meaning && key->meaning[0]);
        assert_true(fl_section_table[key->section].size <= sizeof scratch);
        assert_int_equal(fl_key_find((int)key->section, key->key), k);
        assert_true(k - fl_key_first((int)key->section) < FL_SCENE_KEYS);
        assert_true(k == 0 || fl_key_table[k - 1].section <= key->section);
        assert_true(key->offset >= sizeof(fl_scene_head) &&
                    key->offset < fl_section_table[key->section].size);
        for (int steel = 0; steel < 2; steel++) {
            const char *word = steel && key->default_steel ? key->default_steel : key->default_text;
            memset(&scratch, 0, sizeof scratch);
            if (fl_value_read(key, word, "", &scratch, why, sizeof why)) fail_msg("%s", why);
            fl_value_text(key, &scratch, text);
            if (fl_value_read(key, text, "", &scratch, why, sizeof why)) fail_msg("%s", why);
            assert_string_equal(fl_value_text(key, &scratch, again), text);
        }
    }
    for (int w = 0; w < fl_manual_count; w++)
        assert_true(fl_key_find((int)fl_manual_table[w].section, fl_manual_table[w].key) >= 0);
}

static void the_smallest_scene_has_the_stated_defaults(void **state)
{
    fl_scene s;
    (void)state;
    load_good(&s, ICE);
    assert_near(s.run.duration, 60.0, 0);
    assert_near(s.run.dt, 0.0, 0);
    assert_near(s.run.gravity.z, -9.81, 0);
    assert_near(s.run.safety, 0.2, 0);
    assert_near(s.output.state_every, s.output.loads_every, 0);
    assert_near(s.output.until, s.run.duration, 0);
    assert_string_equal(s.output.frames, "");
    assert_true(s.ice.head.present);
    assert_false(s.structure.head.present || s.water.head.present || s.wind.head.present);
    assert_false(s.boundary.head.present || s.bond.head.present);
    assert_int_equal(s.n_material, 2);
    assert_near(s.material[fl_scene_find_material(&s, "ice")].density, 900.0, 0);
    assert_near(s.material[fl_scene_find_material(&s, "steel")].young, 210e9, 0);
    assert_near(s.material[fl_scene_find_material(&s, "steel")].friction, 0.15, 0);
    fl_scene_free(&s);
    fl_scene_free(&s); /* a freed scene is a zeroed one */
}

static void values_carry_units(void **state)
{
    static const struct {
        const char *key, *text;
        double si;
    } row[] = {
        {"material ice.young", "1.5 GPa", 1.5e9},
        {"material ice.young", "900MPa", 9e8},
        {"material ice.young", "1e9", 1e9},
        {"material ice.young", "2 N/mm2", 2e6},
        {"water.level", "50 mm", 0.05},
        {"water.level", "-3 cm", -0.03},
        {"run.duration", "10 min", 600.0},
        {"run.duration", "2 h", 7200.0},
        {"run.dt", "5e-5", 5e-5},
        {"run.dt", "50 us", 5e-5},
        {"contact ice ice.stiffness", "2 kN/m", 2000.0},
        {"contact ice ice.friction", "12 %", 0.12},
        {"material ice.density", "0.9 t/m3", 900.0},
        {"water.density", "1.025 g/cm3", 1025.0},
    };
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof row[0]; k++) {
        char assignment[200];
        double x;
        fl_address at;
        fl_scene s;
        fl_err err = {0};
        load_good(&s, ICE);
        snprintf(assignment, sizeof assignment, " %s = %s ", row[k].key, row[k].text);
        if (fl_scene_set(&s, assignment, &err)) fail_msg("%s", err.text);
        assert_int_equal(fl_address_read(row[k].key, &at, err.text, sizeof err.text), 0);
        memcpy(&x,
               (char *)fl_section_at(&s, at.section, fl_section_named(&s, at.section, at.a, at.b)) +
                   fl_key_table[at.key].offset,
               sizeof x);
        assert_near(x, row[k].si, 0); /* the same double as the decimal number in SI */
        fl_scene_free(&s);
    }
    double x = 5.0;
    assert_int_equal(fl_unit_convert(FL_UNIT_ANGLE, "deg", &x), 0);
    assert_near(x, 5.0, 0); /* angles are kept in degrees */
    assert_int_equal(fl_unit_convert(FL_UNIT_ANGLE, "rad", &x), 0);
    assert_near(x, 286.47889756541160, 1e-15);
    assert_int_equal(fl_unit_convert(FL_UNIT_ANGLE, "m", &x), -1);
}

static void vectors_take_one_number_or_three(void **state)
{
    fl_scene s;
    (void)state;
    load_good(&s, ICE "[run]\ngravity = 0\n");
    assert_false(signbit(s.run.gravity.z)); /* as when it is read again, written in full */
    load_good(&s, ICE "[run]\ngravity = -0 0 -0\n");
    assert_false(signbit(s.run.gravity.x) || signbit(s.run.gravity.z));
    load_good(&s, ICE "[run]\ngravity = 1 2 -3\n");
    assert_near(s.run.gravity.y, 2.0, 0);
    assert_near(s.run.gravity.z, -3.0, 0);
    fl_scene_free(&s);
    load_good(&s, ICE "[water]\ncurrent = 50 cm/s\n[boundary]\nmin = -50 mm none 1\nmax = 1 none 2 km\n");
    assert_near(s.water.current.x, 0.5, 0);
    assert_near(s.water.current.y, 0.0, 0);
    assert_near(s.boundary.min.x, -0.05, 0);
    assert_near(s.boundary.min.z, 1.0, 0);
    assert_near(s.boundary.max.x, 1000.0, 0); /* a unit holds for all numbers before it without one */
    assert_near(s.boundary.max.z, 2000.0, 0);
    assert_true(isinf(s.boundary.min.y) && s.boundary.min.y < 0 && isinf(s.boundary.max.y));
    fl_scene_free(&s);
}

static void the_grammar_is_that_of_scene_5(void **state)
{
    char text[4000], folder[600];
    fl_scene s;
    (void)state;
    /* byte order mark, CRLF, comments, a section opened twice, # inside a word, no newline at the end */
    load_good(&s, "\xEF\xBB\xBF#scene 1\r\n; c\r\n[ run ] # c\r\n  duration=5 s ; c\r\n\r\n[ice]\r\nfile = "
                  "a#b.dat\r\n[run]\r\ndt\t=\t1 ms");
    assert_near(s.run.duration, 5.0, 0);
    assert_near(s.run.dt, 1e-3, 0);
    assert_string_equal(strrchr(s.ice.file, '/'), "/a#b.dat");
    fl_scene_free(&s);
    /* values longer than the packaged parser's line */
    memset(folder, 'd', 500);
    folder[500] = '\0';
    snprintf(text, sizeof text, "[ice]\nfile = /%s/ice = cold.dat   # comment\n", folder);
    load_good(&s, text);
    assert_int_equal(strlen(s.ice.file), 500 + 16);
    assert_string_equal(s.ice.file + 501, "/ice = cold.dat");
    fl_scene_free(&s);
    /* paths start from the scene's folder */
    load_good(&s, "[ice]\nfile = sub/ice.dat\n[output]\nstate = /abs/state.dat\nframes=none\n");
    assert_string_equal(s.ice.file + strlen(s.ice.file) - 12, "/sub/ice.dat");
    assert_true(s.ice.file[0] == '/');
    assert_string_equal(s.output.state, "/abs/state.dat");
    assert_string_equal(s.output.frames, "");
    fl_scene_free(&s);
}

static void keys_of_the_manual_are_read(void **state)
{
    fl_scene s;
    (void)state;
    load_good(&s,
              "expperiment duration\t120\ngravity 9.8\nnproc = 4\nndtsrc 10\ndtoutInfo "
              "0.1\ndtoutAni=2\ndtoutAni_draw 4\ndtoutfile 100\noutput file number 3\nrestitution 0.4\nmus "
              "0.2\nmubed 0.1\nstructvelx 0.1\nstructvely=-0.2\nstructvelz 0\nbound_type 1\nwaterdepth "
              "20\nwatervel 0.5\nwindvel 6\nisbonding 0\nn_strength 6e5\nt_strength 5e5\n" ICE
              "[structure]\nfile=s\n[boundary]\nmin = 0 0 none\n");
    assert_near(s.run.duration, 120.0, 0);
    assert_near(s.run.gravity.z, -9.8, 0);
    assert_int_equal(s.run.threads, 4);
    assert_int_equal(s.run.search_every, 10);
    assert_near(s.output.loads_every, 0.1, 0);
    assert_near(s.output.frames_every, 2.0, 0);
    assert_near(s.output.ice_every, 4.0, 0);
    assert_near(s.output.until, 100.0, 0);
    assert_int_equal(s.output.files, 3);
    assert_near(s.material[fl_scene_find_material(&s, "ice")].restitution, 0.4, 0);
    assert_near(s.material[fl_scene_find_material(&s, "ice")].friction, 0.2, 0);
    assert_near(s.structure.friction, 0.1, 0);
    assert_near(s.structure.motion.velocity.x, 0.1, 0);
    assert_near(s.structure.motion.velocity.y, -0.2, 0);
    for (int c = 0; c < 3; c++) assert_int_equal(s.boundary.type[c], FL_BOUNDARY_RIGID);
    assert_near(s.water.depth, 20.0, 0);
    assert_near(s.water.current.x, 0.5, 0);
    assert_near(s.wind.velocity.x, 0.836 * 6 * sqrt(6), 1e-15); /* 12.3 m/s at Beaufort 6 */
    assert_int_equal(s.bond.on, 0);
    assert_near(s.bond.normal_strength, 6e5, 0);
    assert_near(s.bond.shear_strength, 5e5, 0);
    fl_scene_free(&s);
    expect_refusal("bound_type 5\n" ICE,
                   ":1: bound_type is \"5\", 1 (rigid), 2 (elastic), 3 (periodic) or 4 (free) is expected");
    expect_refusal("bound_type 3\n" ICE,
                   ":1: a periodic boundary has no bounds: boundary.min or boundary.max is expected");
    expect_refusal("windvel 18\n" ICE, ":1: windvel is \"18\", a Beaufort number from 0 to 17 is expected");
    load_good(&s, "isbonding 1\n" ICE);
    assert_int_equal(s.bond.on, 1);
    fl_scene_free(&s);
    expect_refusal(
        "\ngravitiy 9\n" ICE,
        ":2: \"gravitiy\" before the first section is not a word of the manual, nearest is \"gravity\"");
    expect_refusal("output file numbers = 9\n" ICE,
                   ":1: \"output file numbers\" before the first section is not a "
                   "word of the manual, nearest is \"output file number\"");
    expect_refusal("structvelx 1\nstructvely 1\nstructvelx 2\n" ICE,
                   ":3: structure.velocity was given on line 2 already");
    expect_refusal("gravity\n" ICE, ":1: run.gravity has no value");
}

/* Waves by error, directions and decay in ice. */
static void complaints_about_waves(void **state)
{
#define SEA "[run]\ngravity = 9.81\n[water]\nwave = jonswap\nheight = 1\nperiod = 6\n"
    fl_scene s;
    (void)state;
    load_good(&s, SEA ICE);
    assert_near(s.water.wave_error, 0.003, 0); /* the default of a sea */
    fl_scene_free(&s);
    load_good(&s, SEA "every = 4\n" ICE); /* without it */
    assert_near(s.water.wave_error, 0, 0);
    fl_scene_free(&s);
    load_good(&s,
              "[run]\nsleep = 1e-5\ngravity = 9.81\n[water]\nwave = jonswap\nheight = 1\nperiod = 6\n" ICE);
    assert_near(s.water.wave_error, 0, 0);
    fl_scene_free(&s);
    load_good(&s, "[run]\ngravity = 9.81\n[water]\nwave = airy\nheight = 1\nperiod = 6\n" ICE);
    assert_near(s.water.wave_error, 0, 0);
    fl_scene_free(&s);
    load_good(&s, SEA "components = auto\nspread = 2\n" ICE);
    assert_int_equal(s.water.components, 0);
    fl_scene_free(&s);
    expect_refusal(SEA "wave_error = 1e-5\n" ICE,
                   ":7: water.wave_error is 1e-5, a value at least 0.0001 and at most 0.05 is expected");
    expect_refusal(SEA "wave_error = 0.01\nevery = 2\n" ICE,
                   ":8: water.wave_error chooses when the waves are evaluated: either water.every or "
                   "water.wave_error is expected");
    expect_refusal(
        SEA "wave_error = 0.01\n[run]\nsleep = 1e-5\n" ICE,
        ":9: sleeping floes evaluate the waves when they wake: water.wave_error = none is expected");
    expect_refusal("[run]\ngravity = 9.81\n[water]\nwave = airy\nheight = 1\nperiod = 6\nspread = 2\n" ICE,
                   ":7: a regular wave has one direction: water.wave = jonswap is expected");
    expect_refusal(SEA "spread = 2\nwave_error = none\n" ICE,
                   ":8: with water.spread the waves are evaluated by error only: a number is expected");
    expect_refusal(SEA "ice_decay = rogers\n" ICE,
                   ":7: the decay needs the edge of the ice: water.ice_edge is expected");
    expect_refusal(SEA "ice_decay = rogers\nice_edge = 10 m\n" ICE,
                   ":7: the decay needs the thickness of the ice: water.ice_thickness is expected");
    expect_refusal(SEA "ice_decay = own\nice_edge = 10 m\n" ICE,
                   ":7: the decay has no law: water.ice_decay_law with C above 0 is expected");
    expect_refusal(
        SEA "ice_decay = meylan\nice_edge = 10 m\nice_thickness = 1 m\nspread = 2\n" ICE,
        ":7: the decay is along one direction: either water.ice_decay or water.spread is expected");
    expect_refusal(SEA
                   "spread = 2\n[boundary]\ntype = rigid periodic free\nmin = 0 0 none\nmax = 9 9 none\n" ICE,
                   ":7: waves of all directions do not repeat with a periodic boundary: another boundary or "
                   "water.spread = none is expected");
#undef SEA
}

static void each_complaint_names_file_and_line(void **state)
{
    (void)state;
    expect_refusal("[run]\nduration = abc\n" ICE,
                   ":2: run.duration is \"abc\", a number in s is expected (units: s ms us min h)");
    expect_refusal("[run]\nduration = 5 m\n" ICE,
                   ":2: run.duration has the unit \"m\", one of s ms us min h is expected");
    expect_refusal("[run]\nduration = -1 s\n" ICE, ":2: run.duration is -1 s, a value above 0 s is expected");
    expect_refusal("[run]\nduration = nan\n" ICE,
                   ":2: run.duration is \"nan\", a number in s is expected (units: s ms us min h)");
    expect_refusal("[run]\nduration = 1e999\n" ICE,
                   ":2: run.duration is \"1e999\", a number in s is expected (units: s ms us min h)");
    expect_refusal("[run]\nduration = 1 2\n" ICE,
                   ":2: run.duration is \"1 2\", a number in s is expected (units: s ms us min h)");
    expect_refusal("[run]\nduration = 1 s s\n" ICE,
                   ":2: run.duration is \"1 s s\", a number in s is expected (units: s ms us min h)");
    expect_refusal("[run]\nduration = 2,5\n" ICE,
                   ":2: run.duration is \"2,5\", a decimal point and blanks are expected, not a comma");
    expect_refusal("[run]\nduration =\n" ICE, ":2: run.duration has no value");
    expect_refusal("[run]\nduration 5\n" ICE, ":2: \"duration 5\" is no section and no key = value");
    expect_refusal("[run]\n= 5\n" ICE, ":2: no key stands before =");
    expect_refusal("[run\nduration = 5\n" ICE, ":1: \"[run\" lacks the ] of a section");
    expect_refusal("[run] duration = 5\n" ICE, ":1: \" duration = 5\" after a section is not expected");
    expect_refusal("[run]\ndurration = 5\n" ICE,
                   ":2: unknown key \"durration\" in [run], nearest is \"duration\"");
    expect_refusal("[watter]\n" ICE, ":1: unknown section [watter], nearest is [water]");
    expect_refusal("[]\n" ICE, ":1: unknown section [], nearest is [run]");
    expect_refusal("[water deep]\n" ICE, ":1: [water deep] has 1 name, [water] is expected");
    expect_refusal("[material]\n" ICE, ":1: [material] has 0 names, [material NAME] is expected");
    expect_refusal("[contact ice]\n" ICE, ":1: [contact ice] has 1 name, [contact A B] is expected");
    expect_refusal("[group a/b]\n" ICE,
                   ":1: \"a/b\" cannot be a name: letters, digits, _ + -, at most 47 characters");
    expect_refusal("[material structure]\n" ICE,
                   ":1: a material cannot be called \"structure\": that word names a place in [contact A B]");
    expect_refusal("[run]\ndt = 1\n\n[run]\ndt = 2\n" ICE, ":5: run.dt was given on line 2 already");
    expect_refusal("[contact ice ice]\nfriction = 0.1\nfriction = 0.2\n" ICE,
                   ":3: contact ice ice.friction was given on line 2 already");
    expect_refusal("gravity 9\n[run]\ngravity = 9\n" ICE, ":3: run.gravity was given on line 1 already");
    expect_refusal("#scene 2\n" ICE, ":1: scene version 2 is newer than this program, which reads up to 1");
    expect_refusal("[run]\ndt = 1 ms\nerror = 0.1\n" ICE,
                   ":3: run.error chooses the step and run.dt sets it: only one of them is expected");
    expect_refusal(
        "[run]\nsleep = 1e-5\nerror = 0.1\n" ICE,
        ":2: run.error repeats windows with other steps, in which no floe can sleep: either run.error or "
        "run.sleep is expected");
    expect_refusal(
        "[run]\nsleep = 1e-5\n[water]\nevery = 2\n" ICE,
        ":4: sleeping floes (run.sleep) evaluate the water when they wake: water.every = 1 is expected");
    expect_refusal("[run]\nerror = 0.1\n[contact]\nsurrogate = 0.001\n" ICE,
                   ":4: run.error compares steps of different sizes, which a surrogate would disturb: either "
                   "run.error or surrogate in [contact] is expected");
    expect_refusal("[run]\nerror = 0.1\n[contact ice boundary]\nsurrogate = 0.001\n" ICE,
                   ":4: run.error compares steps of different sizes, which a surrogate would disturb: either "
                   "run.error or surrogate in [contact ice boundary] is expected");
    expect_refusal("[contact]\nlaw = core\nsurrogate = 0.001\n" ICE,
                   ":3: surrogate applies to law = patch and quick only");
    expect_refusal("[contact]\nlaw = manual\n[contact ice boundary]\nsurrogate = 0.001\n" ICE,
                   ":4: surrogate applies to law = patch and quick only");
    expect_refusal("[contact]\nsurrogate = 0.5\n" ICE,
                   ":2: contact.surrogate is 0.5, a value at least 0 and at most 0.1 is expected");
    expect_refusal("[water]\nevery = 0\n" ICE,
                   ":2: water.every is \"0\", a whole number from 1 to 1000 is expected");
    expect_refusal("[run]\nerror = 100%\n" ICE,
                   ":2: run.error is 100%, a value above 0 and below 1 is expected");
    expect_refusal("[run]\nthreads = 2.5\n" ICE,
                   ":2: run.threads is \"2.5\", a whole number from 1 to 1024 is expected");
    expect_refusal("[run]\ngravity = -9.81\n" ICE,
                   ":2: run.gravity is -9.81: one number is the size of a downward "
                   "vector and cannot be negative, three give another direction");
    expect_refusal(
        "[run]\ngravity = 1 2\n" ICE,
        ":2: run.gravity is \"1 2\", one number or three in m/s2 are expected (units: m/s2 m/s^2)");
    expect_refusal("[material ice]\npoisson = 0.5\n" ICE,
                   ":2: material.poisson is 0.5, a value at least 0 and below 0.5 is expected");
    expect_refusal("[contact]\nlaw = pach\n" ICE,
                   ":2: contact.law is \"pach\", one of patch manual manual-si core quick "
                   "is expected, nearest is patch");
    expect_refusal("[contact]\nexponent = 2\n" ICE,
                   ":2: contact.exponent is \"2\", one of 1 1.5 is expected, nearest is 1");
    expect_refusal("[group a]\nfixed = x x\n" ICE,
                   ":2: group.fixed is \"x x\", none or some of x y z rx ry rz, each once, is expected");
    expect_refusal("[ice]\nmaterial = a b\n",
                   ":2: ice.material is \"a b\", a name of letters, digits, _ + - and at "
                   "most 47 characters is expected");
    expect_refusal("include =\n" ICE, ":1: include needs the name of a file");
    expect_refusal("include = -\n" ICE, ":1: include needs the name of a file");
}

static void sections_are_checked_against_each_other(void **state)
{
    (void)state;
    expect_refusal("[run]\nduration = 5\n",
                   ": the scene has no ice: [ice] file = FILE, or --ice FILE, is expected");
    expect_refusal("", ": the scene has no ice: [ice] file = FILE, or --ice FILE, is expected");
    expect_refusal("\n[ice]\nshape = round\n",
                   ":2: the scene has no ice: [ice] file = FILE, or --ice FILE, is expected");
    expect_refusal(ICE "[structure]\n",
                   ":3: [structure] has no file: file = FILE, or --structure FILE, is expected");
    expect_refusal("[ice]\nfile = -\n[structure]\nfile = -\n",
                   ":2: standard input can be only one of scene, ice and structure");
    expect_refusal(ICE "material = cheese\n", ":3: there is no [material cheese]");
    expect_refusal(ICE "[structure]\nfile = s\nmaterial = cheese\n", ":5: there is no [material cheese]");
    expect_refusal(ICE "[contact ice cheese]\n", ":3: there is no [material cheese]");
    expect_refusal(ICE "[contact structure boundary]\n",
                   ":3: [contact structure boundary] names no material: structure and boundary never touch");
    expect_refusal(ICE "[contact]\nmanual_eq18 = true\n",
                   ":4: manual_eq18 applies to law = manual and manual-si only");
    expect_refusal(ICE "[run]\nduration = 1\ndt = 2\n",
                   ":5: run.dt is 2 s, at most the duration, 1 s, is expected");
    expect_refusal(ICE "[output]\nstate = -\n",
                   ":4: output.state is \"-\", and standard output carries the loads: a file is expected");
    expect_refusal(ICE "[output]\nstate = /a\nenergy = /a\n",
                   ":5: output.energy is \"/a\", which is output.state already");
    expect_refusal("[ice]\nfile = /a\n[output]\nstate = /a\n",
                   ":4: output.state is \"/a\", which is an input");
    expect_refusal(ICE "[boundary]\nmin = 0 0 0\nmax = 1 0 1\n",
                   ":5: boundary.max of y is 0 m, more than its min, 0 m, is expected");
    expect_refusal(ICE "[boundary]\ntype = free elastic free\n",
                   ":4: an elastic boundary has no bounds: boundary.min or boundary.max is expected");
    expect_refusal(ICE "[boundary]\ntype = free rigid\n",
                   ":4: boundary.type is \"free rigid\", one word or three, for x, y and z, are expected");
    expect_refusal(
        ICE "[boundary]\ntype = free rigid free free\n",
        ":4: boundary.type is \"free rigid free free\", one word or three, for x, y and z, are expected");
    expect_refusal(
        ICE "[boundary]\ntype = periodic\nmin = 0 0 none\nmax = 1 none none\n",
        ":4: y is periodic and has one bound: boundary.min and boundary.max of y, or none of the two, "
        "are expected");
    expect_refusal(ICE "[boundary]\ntype = periodic\nmin = 0 0 0\nmax = 1 1 1\n[water]\n",
                   ":4: z is periodic, but [water] has one surface: only one of the two is expected");
    expect_refusal(
        ICE "[boundary]\ntype = free\ndrive = 1\n",
        ":5: boundary.drive has no effect without boundary.drive_width or drive_group or drive_of");
    expect_refusal(ICE "[boundary]\ntype = free\ndrive = 1\ndrive_of = row\n",
                   ":5: nothing is driven: drive_width, drive_group or drive_of = wall is expected");
    expect_refusal(ICE "[boundary]\ntype = free\ninflow_speed = 1\n",
                   ":5: boundary.inflow_speed has no effect without boundary.inflow");
    expect_accepted(ICE "[boundary]\ntype = free\ninflow = none\ninflow_speed = 1\n");
    expect_refusal(ICE "[run]\nerror_of = fx\n", ":4: run.error_of has no effect without run.error");
    expect_refusal(ICE "[bond]\nshear_strength = 1 MPa\n",
                   ":4: bond.shear_strength has no effect without bond.on");
    expect_accepted(ICE "[bond]\non = false\nshear_strength = 1 MPa\n");
    expect_refusal(ICE "[contact]\nexponent = 1.5\n", ":4: exponent applies to law = core only");
    expect_refusal(ICE "[contact]\nlaw = manual\nrolling = 0.1\n",
                   ":5: rolling applies to law = patch and core and quick only");
    expect_accepted(ICE "[contact]\nlaw = core\nexponent = 1.5\n");
    expect_refusal(ICE "[boundary]\ntype = free\ndrive = 1\ndrive_of = wall\n",
                   ":6: there is no rigid wall at the lower bound of x: boundary.type = rigid and "
                   "boundary.min of it are expected");
    expect_refusal(ICE "[boundary]\nmin = 0 0 none\nmax = 9 9 none\ndrive = 1 1 0\ndrive_of = wall\n",
                   ":6: a wall moves along its normal, x: no other velocity is expected");
    expect_refusal(
        ICE "[boundary]\nmin = 0 0 none\nmax = 9 9 none\ndrive = 1\ndrive_of = wall\ndrive_width = 1\n",
        ":7: a wall is driven, and a row of floes as well: drive_of = row, or neither drive_width nor "
        "drive_group, is expected");
    expect_refusal(ICE "[boundary]\ntype = free\nline_load = 1 kN/m\n",
                   ":5: boundary.line_load: nothing pushes: boundary.drive or boundary.inflow is expected");
    expect_refusal(
        ICE "[boundary]\ntype = free\ndrive = 1\ndrive_width = 1\nline_load = 1\niso_pack_width = 1 km\n",
        ":8: line_load and iso_pack_width both say how hard the ice is pushed: one is expected");
    expect_refusal(ICE "[boundary]\ntype = free\ndrive = 1 1 0\ndrive_width = 1\nline_load = 1\n",
                   ":5: boundary.line_load: a row that is pushed moves along x or along y: a drive along one "
                   "of them is expected");
    expect_refusal(ICE "[boundary]\ntype = free\niso_pack_coefficient = 3\n",
                   ":5: boundary.iso_pack_coefficient has no effect without boundary.iso_pack_width");
    expect_refusal(
        ICE "[run]\nsleep = 1e-3\n[boundary]\ntype = free\ndrive = 1\ndrive_width = 1\nline_load = 1\n",
        ":9: boundary.line_load changes the speed of what pushes, and floes that sleep would miss it: "
        "run.sleep = 0 is expected");
    expect_refusal(ICE "[boundary]\ntype = free\ndrive_width = 1\n",
                   ":5: boundary.drive has no direction along x or y: drive_edge is expected");
    expect_refusal(ICE "[boundary]\ntype = free\ndrive = 1\ndrive_width = 1\ndrive_group = a\n",
                   ":7: drive_width and drive_group both say which floes are driven: one is expected");
    expect_refusal(ICE "[boundary]\ntype = free\ndrive = 1 0 1\ndrive_width = 1\n",
                   ":5: boundary.drive along z is 1 m/s, and z is not among drive_fixed");
    expect_refusal(
        ICE "[boundary]\ninflow = ice\nmin = 0 0 0\n",
        ":4: inflow along x needs boundary.type = free in x, and boundary.min and boundary.max of it");
    expect_refusal(
        ICE "[boundary]\ntype = free\ninflow = ice\nmin = 0 0 0\nmax = 1 1 1\n",
        ":5: water.current does not point into the domain there: boundary.inflow_speed, or another "
        "inflow_from, is expected");
    expect_refusal(ICE "[boundary]\ntype = free\ninflow = file\nmin = 0 0 0\nmax = 1 1 1\n",
                   ":5: boundary.inflow is file: inflow_file = FILE is expected");
    expect_refusal(ICE "[boundary]\n",
                   ":3: a rigid boundary has no bounds: boundary.min or boundary.max is expected");
    expect_refusal(ICE "[group a]\nfixed = x\nvelocity = 0 1 0\n",
                   ":5: group.velocity along y is 1 m/s, and y is not among the fixed directions");
}

static void set_overrides_the_file(void **state)
{
    fl_scene s;
    fl_err err = {0};
    (void)state;
    load_good(&s, ICE "[run]\nduration = 5\n");
    assert_int_equal(fl_scene_set(&s, "run.duration=1 min", &err), 0);
    assert_int_equal(fl_scene_set(&s, "run.duration = 2 min", &err), 0);
    assert_int_equal(fl_scene_set(&s, "contact.ice.ice.friction=0.5", &err), 0);
    assert_int_equal(fl_scene_set(&s, "material snow.density=300", &err), 0);
    assert_int_equal(fl_scene_set(&s, "water.density=1000", &err), 0);
    assert_int_equal(fl_scene_set(&s, "output.state=here.dat", &err), 0);
    assert_int_equal(fl_scene_set(&s, "output.loads_every=0.5", &err), 0);
    assert_int_equal(fl_scene_set(&s, "output.energy_every=auto", &err), 0);
    assert_int_equal(fl_scene_check(&s, &err), 0);
    assert_near(s.run.duration, 120.0, 0);
    assert_near(s.output.until, 120.0, 0);
    assert_near(s.output.state_every, 0.5, 0);
    assert_near(s.output.energy_every, 0.5, 0);
    assert_near(fl_scene_pair(&s, 0, 0).friction, s.material[0].name[0] == 'i' ? 0.5 : 0.3, 0);
    assert_true(fl_scene_find_material(&s, "snow") >= 0);
    assert_true(s.water.head.present);
    assert_string_equal(s.output.state, "here.dat"); /* from the working folder */
    fl_scene_free(&s);
    expect_set_refusal("run.duration", "--set: \"run.duration\" is not section.key=value");
    expect_set_refusal(
        "ice.file=#x",
        "--set: ice.file is \"#x\", a path without control characters and comments is expected");
    expect_set_refusal("run=5", "--set: \"run\" is a section, section.key=value is expected");
    expect_set_refusal("runn.dt=5", "--set: unknown section [runn], nearest is [run]");
    expect_set_refusal("run.dtt=5", "--set: unknown key \"dtt\" in [run], nearest is \"dt\"");
    expect_set_refusal("run.dt=", "--set: run.dt has no value");
    expect_set_refusal("run.dt=1 h", "--set: run.dt is 3600 s, at most the duration, 60 s, is expected");
    expect_set_refusal("material.young=5", "--set: [material] has 0 names, [material NAME] is expected");
    expect_set_refusal("group.a.velocity=1 0 0",
                       "--set: group.velocity along x is 1 m/s, and x is not among the fixed directions");
}

static void a_failed_set_changes_nothing(void **state)
{
    fl_scene s;
    fl_err err = {0};
    char *before, *after;
    (void)state;
    load_good(&s, ICE);
    before = write_scene(&s);
    assert_int_equal(fl_scene_set(&s, "material.snow.density=-1", &err), -1);
    assert_int_equal(fl_scene_set(&s, "water.density=heavy", &err), -1);
    after = write_scene(&s);
    assert_string_equal(before, after);
    free(before);
    free(after);
    fl_scene_free(&s);
}

static void pairs_use_the_most_specific_section(void **state)
{
    fl_scene s;
    fl_scene_contact c;
    int32_t ice, snow;
    (void)state;
    load_good(&s, ICE
              "[structure]\nfile = s\n[boundary]\nmin = 0 0 0\nstiffness = 3e6\n[material snow]\nfriction "
              "= 0.6\nrestitution = 0.1\n");
    ice = fl_scene_find_material(&s, "ice");
    snow = fl_scene_find_material(&s, "snow");
    assert_near(fl_scene_pair(&s, ice, ice).friction, 0.3, 0);
    assert_near(fl_scene_pair(&s, ice, snow).restitution, 0.1, 0);
    assert_near(fl_scene_pair(&s, snow, FL_SCENE_STRUCTURE).friction, 0.15, 0);
    assert_near(fl_scene_pair(&s, snow, FL_SCENE_BOUNDARY).friction, 0.6, 0);
    assert_near(fl_scene_pair(&s, snow, FL_SCENE_BOUNDARY).stiffness, 3e6, 0);
    assert_string_equal(fl_contact_laws[fl_scene_pair(&s, ice, ice).law].name, "patch");
    assert_near(fl_scene_pair(&s, ice, ice).tangential_ratio, 0.824, 0);
    assert_true(fl_scene_pair(&s, ice, ice).damping < 0);
    fl_scene_free(&s);

    load_good(&s,
              ICE "[structure]\nfile = s\nfriction = 0.4\n[contact]\nlaw = core\nfriction = 0.9\nrestitution "
                  "= 0.7\n[contact steel ice]\nlaw = manual\nstiffness = 5 kN/m\n[contact ice "
                  "structure]\nstiffness = auto\ndamping = 2\n[contact boundary ice]\nrestitution = 0\n");
    ice = fl_scene_find_material(&s, "ice");
    c = fl_scene_pair(&s, ice, FL_SCENE_STRUCTURE);
    assert_near(c.friction, 0.4, 0);                            /* [structure] over [contact] */
    assert_near(c.restitution, 0.7, 0);                         /* [contact] over the materials */
    assert_string_equal(fl_contact_laws[c.law].name, "manual"); /* the structure's material */
    assert_near(c.stiffness, 5000.0, 0);                        /* auto passes the choice on */
    assert_near(c.damping, 2.0, 0);
    assert_string_equal(c.b, "structure");
    assert_string_equal(fl_contact_laws[fl_scene_pair(&s, ice, ice).law].name, "core");
    assert_near(fl_scene_pair(&s, ice, FL_SCENE_BOUNDARY).restitution, 0.0, 0);
    assert_near(fl_scene_pair(&s, ice, FL_SCENE_BOUNDARY).friction, 0.9, 0);
    fl_scene_free(&s);
}

static void the_scene_overrides_included_files(void **state)
{
    static const char materials[] =
        "[material snow]\ndensity = 400\nyoung = 10 MPa\n[ice]\nmaterial = snow\n";
    char text[1000];
    fl_scene s;
    fl_err err = {0};
    const char *name;
    (void)state;
    name = strrchr(test_file("mat.scene", materials, strlen(materials)), '/') + 1;
    snprintf(text, sizeof text, "include = %s\n" ICE "[material snow]\ndensity = 350\n", name);
    load_good(&s, text);
    assert_near(s.material[fl_scene_find_material(&s, "snow")].density, 350.0, 0);
    assert_near(s.material[fl_scene_find_material(&s, "snow")].young, 1e7, 0);
    assert_string_equal(s.ice.material, "snow");
    assert_int_equal(s.n_file, 2);
    fl_scene_free(&s);
    /* a loop is an include in an included file */
    snprintf(text, sizeof text, "include %s\n" ICE, name);
    test_file("mat.scene", text, strlen(text));
    assert_int_equal(load(&s, text, &err), -1);
    assert_non_null(strstr(err.text, "mat.scene:1: include in an included file, one level is expected"));
    /* the same key from two included files */
    test_file("mat.scene", materials, strlen(materials));
    snprintf(text, sizeof text, "include %s\ninclude %s\n" ICE, name, name);
    assert_int_equal(load(&s, text, &err), -1);
    assert_non_null(strstr(err.text, "mat.scene:2: material snow.density was given on line 2 of"));
    /* a missing file */
    assert_int_equal(load(&s, "include nowhere.scene\n" ICE, &err), -1);
    assert_non_null(strstr(err.text, "nowhere.scene: No such file"));
    assert_int_equal(err.code, FL_INPUT);
}

/* A renamed key is read by its old name, printed by its new one, and refused when both are given. */
static void old_names_are_still_read(void **state)
{
    static const char *const row[][3] = {{"softening", "stiffness_factor", "0.25"},
                                         {"tangential", "tangential_ratio", "0.5"},
                                         {"literal2", "manual_eq2", "true"},
                                         {"literal18", "manual_eq18", "true"}};
    char text[400], line[100];
    fl_scene s;
    fl_err err = {0};
    (void)state;
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        const char *old = row[k][0], *new = row[k][1], *value = row[k][2];
        snprintf(text, sizeof text, ICE "[contact]\nlaw = manual\n%s = %s\n", old, value);
        load_good(&s, text);
        char *print = write_scene(&s);
        snprintf(line, sizeof line, "\n%s = %s\n", new, value);
        if (!strstr(print, line)) fail_msg("%s is not among\n%s", line, print);
        snprintf(line, sizeof line, "\n%s = ", old);
        assert_null(strstr(print, line));
        free(print);
        snprintf(line, sizeof line, "contact.%s=%s", old, value);
        assert_int_equal(fl_scene_set(&s, line, &err), 0);
        fl_scene_free(&s);
        for (int first = 0; first < 2; first++) { /* both in one file, in either order */
            snprintf(text, sizeof text, ICE "[contact]\nlaw = manual\n%s = %s\n%s = %s\n", first ? old : new,
                     value, first ? new : old, value);
            snprintf(line, sizeof line, ":6: contact.%s (old name %s) was given on line 5 already", new, old);
            expect_refusal(text, line);
        }
    }
    load_good(&s, ICE "[contact]\nsoftening = 0.25\ntangential = 0.5\n");
    assert_near(fl_scene_pair(&s, 0, 0).stiffness_factor, 0.25, 0);
    assert_near(fl_scene_pair(&s, 0, 0).tangential_ratio, 0.5, 0);
    fl_scene_free(&s);
    expect_refusal(ICE "[contact]\nsoftening = 2\n",
                   ":4: contact.stiffness_factor is 2, a value above 0 and at most 1 is expected");
}

/* Keys that bonds allow, and keys that they exclude. */
static void bonds_are_checked(void **state)
{
    fl_scene s;
    (void)state;
    load_good(&s, ICE "[bond]\non = true\nnormal_strength = none\nenergy = 12 J/m2\n");
    assert_true(isinf(s.bond.normal_strength) && s.bond.young == 0.0 && s.bond.poisson < 0.0);
    assert_near(s.bond.energy, 12.0, 0);
    assert_true(s.bond.shear_energy < 0.0 && s.bond.mixing == 2);
    fl_scene_free(&s);
    expect_refusal(ICE "[bond]\non = true\n[run]\nsleep = 0.01\n",
                   ":6: bonded floes do not sleep: either run.sleep or bond.on is expected");
    expect_refusal(
        ICE "[bond]\non = true\n[boundary]\ntype = free\nmin = 0 none none\nmax = 9 none none\ninflow = "
            "file\ninflow_file = feed.dat\ninflow_speed = 1\n",
        ":9: ice of another file would come in without bonds: boundary.inflow = ice, or bond.on = false, is "
        "expected");
    expect_refusal(ICE "[bond]\non = true\nsoftening = weaken\n",
                   ":5: softening = weaken needs a fracture energy: bond.energy is expected");
    expect_refusal(ICE "[bond]\non = true\nenergy = 10\nnormal_strength = none\nsoftening = weaken\n",
                   ":7: softening = weaken lowers both strengths, but one is none: a number is expected");
}

static void a_written_scene_reads_back(void **state)
{
    fl_scene s, t;
    fl_err err = {0};
    char *first, *second;
    (void)state;
    load_good(
        &s, ICE
        "[structure]\nfile = s\n[contact ice structure]\nfriction = 0.1\n[group tug]\nfixed = x rz\nvelocity "
        "= 0.3 0 0\n[water]\n[wind]\n[bond]\n[boundary]\ntype = free\nmax = 1 none 3\n[material snow]\n");
    first = write_scene(&s);
    t = (fl_scene){0};
    if (fl_scene_read(&t, test_file("echo.scene", first, strlen(first)), &err)) fail_msg("%s", err.text);
    assert_int_equal(fl_scene_check(&t, &err), 0);
    second = write_scene(&t);
    assert_string_equal(first, second);
    free(first);
    free(second);
    fl_scene_free(&s);
    fl_scene_free(&t);
}

/* Friction has one coefficient, from 0 to 1e6, wherever it is given. */
static void friction_is_one_number(void **state)
{
    static const char *const OF[4] = {"contact", "material.ice", "structure", "bond"},
                             *const KEY[4] = {"contact", "material", "structure", "bond"},
                             *const IS[4][2] = {
                                 {"0.4 0.3",
                                  "is \"0.4 0.3\", one number is expected: it holds at rest and in motion"},
                                 {"nan", "is \"nan\", a number is expected"},
                                 {"-0.1", "is -0.1, a value at least 0 and at most 1000000 is expected"},
                                 {"1.1e6", "is 1.1e6, a value at least 0 and at most 1000000 is expected"}};
    (void)state;
    for (int k = 0; k < 4; k++)
        for (int m = 0; m < 4; m++) {
            char set[80], says[160];
            snprintf(set, sizeof set, "%s.friction=%s", OF[k], IS[m][0]);
            snprintf(says, sizeof says, "--set: %s.friction %s", KEY[k], IS[m][1]);
            expect_set_refusal(set, says);
        }
    expect_set_refusal(
        "contact.static_friction=0.4",
        "--set: unknown key \"static_friction\" in [contact], nearest is \"friction\"; it holds at rest and "
        "in motion");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(friction_is_one_number),
        cmocka_unit_test(every_default_reads_back),
        cmocka_unit_test(the_smallest_scene_has_the_stated_defaults),
        cmocka_unit_test(values_carry_units),
        cmocka_unit_test(vectors_take_one_number_or_three),
        cmocka_unit_test(the_grammar_is_that_of_scene_5),
        cmocka_unit_test(keys_of_the_manual_are_read),
        cmocka_unit_test(complaints_about_waves),
        cmocka_unit_test(each_complaint_names_file_and_line),
        cmocka_unit_test(sections_are_checked_against_each_other),
        cmocka_unit_test(set_overrides_the_file),
        cmocka_unit_test(a_failed_set_changes_nothing),
        cmocka_unit_test(pairs_use_the_most_specific_section),
        cmocka_unit_test(the_scene_overrides_included_files),
        cmocka_unit_test(old_names_are_still_read),
        cmocka_unit_test(bonds_are_checked),
        cmocka_unit_test(a_written_scene_reads_back),
    };
    return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
