/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/number_text.h"
#include "base/rng.h"
#include "scene/scene_read.h"
#include "scene/scene_section.h"
#include "scene/scene_print.h"
#include "scene/scene_value.h"

/* A random index below n. */
static int random_index(fl_rng *g, int n) { return (int)(fl_rng_u64(g) % (uint64_t)n); }

/* A number in the range of a key, of any magnitude, or its special word. */
static void random_number(fl_rng *g, const fl_key *key, char *text, size_t size)
{
    double lo = -INFINITY, hi = INFINITY, x;
    char buf[FL_NUMBER_LEN];
    if (key->special && random_index(g, 4) == 0) {
        snprintf(text, size, "%s", key->special);
        return;
    }
    if (key->range) {
        char *end;
        lo = strtod(key->range + 1, &end);
        hi = strtod(end + 1, NULL);
    }
    x = isfinite(lo) && isfinite(hi) ? fl_rng_in(g, lo, hi) : pow(10.0, fl_rng_in(g, -12.0, 12.0));
    if (isfinite(lo) && isinf(hi)) x += lo;
    if (isinf(lo) && random_index(g, 2)) x = -x;
    snprintf(text, size, "%s", fl_number_text(x, buf));
}

static void random_value(fl_rng *g, const fl_key *key, char *text, size_t size)
{
    char part[3][40], units[100], unit[40] = "", *save = NULL, *word;
    int count, k;
    fl_unit_list(key->unit, units, sizeof units);
    /* another unit than the first could move the number out of a bounded range */
    const int bounded = key->range && key->type == FL_VALUE_F64 && !strstr(key->range, "inf");
    for (word = strtok_r(units, " ", &save), k = 1; word; word = strtok_r(NULL, " ", &save), k++)
        if (k == 1 || (!bounded && random_index(g, k) == 0))
            snprintf(unit, sizeof unit, "%s%s", random_index(g, 2) ? " " : "", word);
    switch (key->type) {
    case FL_VALUE_F64:
        if (key->choices) snprintf(text, size, "%s", random_index(g, 2) ? "1" : "1.5");
        else {
            random_number(g, key, part[0], sizeof part[0]);
            snprintf(text, size, "%s%s", part[0],
                     (key->special && strcmp(part[0], key->special) == 0) || key->unit == FL_UNIT_ONE ? ""
                                                                                                      : unit);
        }
        break;
    case FL_VALUE_VEC3:
        for (k = 0; k < 3; k++) random_number(g, key, part[k], sizeof part[k]);
        count = 0;
        for (k = 0; k < 3; k++) count += key->special && strcmp(part[k], key->special) == 0;
        snprintf(text, size, "%s %s %s %s", part[0], part[1], part[2], count == 3 ? "" : unit);
        break;
    case FL_VALUE_I32: { /* "[lo,hi]" */
        char *end;
        const long lo = key->range ? strtol(key->range + 1, &end, 10) : 1,
                   hi = key->range ? strtol(end + 1, NULL, 10) : 1000, most = hi - lo < 999 ? hi - lo : 999;
        snprintf(text, size, "%ld", lo + random_index(g, (int)most + 1));
        break;
    }
    case FL_VALUE_WORDS:
    case FL_VALUE_WORD: { /* one of the choices */
        char copy[300];
        snprintf(copy, sizeof copy, "%s", key->choices);
        for (word = strtok_r(copy, "|", &save), k = 1; word; word = strtok_r(NULL, "|", &save))
            if (random_index(g, k++) == 0) snprintf(text, size, "%s", word);
        break;
    }
    case FL_VALUE_FIXED:
        text[0] = '\0';
        for (k = 0; k < 6; k++)
            if (random_index(g, 2)) {
                static const char *const dir[] = {"x ", "y ", "z ", "rx ", "ry ", "rz "};
                strcat(text, dir[k]);
            }
        if (!text[0]) snprintf(text, size, "none");
        break;
    case FL_VALUE_NAME: snprintf(text, size, "m-%d", random_index(g, 5)); break;
    case FL_VALUE_PATH:
        snprintf(text, size, "/dir %d/a=b#%d.dat", random_index(g, 100), random_index(g, 100));
        break;
    }
}

static char *scene_text(const fl_scene *s)
{
    char *text = NULL;
    size_t n;
    FILE *f = open_memstream(&text, &n);
    fl_scene_write(f, s);
    fclose(f);
    return text;
}

/* Every value is written so that it reads back to the same bytes; likewise the pairs. */
static void values_read_back_to_the_same_bytes(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(300); c++) {
        fl_rng g = fl_rng_of(test_seed(), c, FL_RNG_TEST);
        fl_scene s, t;
        fl_err err = {0};
        char *first, *second, assignment[2000];
        const int sets = random_index(&g, 60);
        fl_scene_init(&s);
        fl_scene_set(&s, "material.m-0.density=1000", &err);
        for (int k = 0; k < sets; k++) {
            const fl_key *key = &fl_key_table[random_index(&g, fl_key_count)];
            const int names = fl_section_table[key->section].names;
            char value[1500];
            random_value(&g, key, value, sizeof value);
            if (names == 1)
                snprintf(assignment, sizeof assignment, "%s.m-%d.%s=%s", fl_section_table[key->section].name,
                         random_index(&g, 3), key->key, value);
            else if (names == 2 && random_index(&g, 3))
                snprintf(assignment, sizeof assignment, "contact m-%d %s.%s = %s", random_index(&g, 3),
                         random_index(&g, 2) ? "structure" : "m-1", key->key, value);
            else
                snprintf(assignment, sizeof assignment, "%s.%s=%s", fl_section_table[key->section].name,
                         key->key, value);
            if (fl_scene_set(&s, assignment, &err))
                fail_msg("seed %llu case %ld: %s: %s", (unsigned long long)test_seed(), c, assignment,
                         err.text);
        }
        first = scene_text(&s);
        t = (fl_scene){0};
        if (fl_scene_read(&t, test_file("prop.scene", first, strlen(first)), &err))
            fail_msg("seed %llu case %ld: %s\n%s", (unsigned long long)test_seed(), c, err.text, first);
        second = scene_text(&t);
        if (strcmp(first, second) != 0)
            fail_msg("seed %llu case %ld:\n%s\n%s", (unsigned long long)test_seed(), c, first, second);
        assert_int_equal(s.n_material, t.n_material);
        for (int32_t a = 0; a < s.n_material; a++)
            for (int32_t b = FL_SCENE_BOUNDARY; b < s.n_material; b++) {
                fl_scene_contact p = fl_scene_pair(&s, a, b), q = fl_scene_pair(&t, a, b);
                char x[FL_VALUE_TEXT], y[FL_VALUE_TEXT];
                for (int k = fl_key_first(FL_SEC_CONTACT); k < fl_key_first(FL_SEC_CONTACT + 1); k++)
                    assert_string_equal(fl_value_text(&fl_key_table[k], &p, x),
                                        fl_value_text(&fl_key_table[k], &q, y));
            }
        free(first);
        free(second);
        fl_scene_free(&s);
        fl_scene_free(&t);
    }
}

/* A pair is the same in both orders. */
static void pairs_are_symmetric(void **state)
{
    (void)state;
    for (long c = 0; c < test_times(100); c++) {
        fl_rng g = fl_rng_of(test_seed(), 1000000 + c, FL_RNG_TEST);
        fl_scene s;
        fl_err err = {0};
        fl_scene_init(&s);
        for (int k = 0; k < 12; k++) {
            char assignment[200];
            snprintf(assignment, sizeof assignment,
                     random_index(&g, 2) ? "contact.m-%d.m-%d.friction=%d" : "material.m-%d.friction=0.%d%d",
                     random_index(&g, 3), random_index(&g, 3), random_index(&g, 9));
            assert_int_equal(fl_scene_set(&s, assignment, &err), 0);
        }
        for (int32_t a = 0; a < s.n_material; a++)
            for (int32_t b = 0; b < s.n_material; b++)
                assert_near(fl_scene_pair(&s, a, b).friction, fl_scene_pair(&s, b, a).friction, 0);
        fl_scene_free(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_read_back_to_the_same_bytes),
        cmocka_unit_test(pairs_are_symmetric),
    };
    return cmocka_run_group_tests_name("scene, properties", tests, NULL, NULL);
}
