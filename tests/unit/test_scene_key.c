/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of keys: --explain shows each of them, and scene(5) has an entry for each. */
#include "support/near.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/field_words.h"
#include "scene/scene_print.h"
#include "scene/scene_section.h"
#include "scene/scene_value.h"

static char *explain_key(const char *key, fl_err *err, int *rc)
{
    char *text = NULL;
    size_t n;
    FILE *f = open_memstream(&text, &n);
    *err = (fl_err){0};
    *rc = fl_scene_explain(f, key, err);
    fclose(f);
    return text;
}

static void explain_shows_every_key(void **state)
{
    fl_err err;
    int rc;
    char *text = explain_key("water.density", &err, &rc);
    (void)state;
    assert_int_equal(rc, 0);
    assert_string_equal(
        text,
        "water.density: mass per volume of the water\n  value    a number in kg/m3 (units: kg/m3 kg/m^3 t/m3 "
        "t/m^3 g/cm3 g/cm^3), above 0\n  default  1025 kg/m3\n"
        "  source   fresh water 998, sea water 1005 to 1030\n");
    free(text);
    text = explain_key("material.friction", &err, &rc);
    assert_non_null(strstr(text, "  default  0.3 (steel: 0.15)\n  manual   mus\n"));
    free(text);
    text = explain_key("material ice.friction", &err, &rc);
    assert_int_equal(rc, 0);
    free(text);
    text = explain_key("bond.softening", &err, &rc);
    assert_non_null(strstr(text, "one of keep, stretch, weaken\n"));
    free(text);
    text = explain_key("contact.softening", &err, &rc); /* an old name */
    assert_int_equal(rc, 0);
    assert_true(strncmp(text, "contact.stiffness_factor: ", 26) == 0);
    assert_non_null(strstr(text, "\n  was      contact.softening, which is still read\n"));
    free(text);
    for (int s = 0; s < FL_SECTIONS; s++) {
        text = explain_key(fl_section_table[s].name, &err, &rc);
        assert_int_equal(rc, 0);
        for (int k = fl_key_first(s); k < fl_key_first(s + 1); k++)
            assert_non_null(strstr(text, fl_key_table[k].key));
        free(text);
    }
    free(explain_key("watr.density", &err, &rc));
    assert_int_equal(rc, -1);
    assert_string_equal(err.text, "unknown section [watr], nearest is [water]");
    free(explain_key("water.dansity", &err, &rc));
    assert_string_equal(err.text, "unknown key \"dansity\" in [water], nearest is \"density\"");
    assert_int_equal(err.code, FL_USAGE);
}

/* scene(5) is the specification: every section, key, choice, word of the manual and default stands in it. */
static void the_manual_page_lists_every_key(void **state)
{
    static char page[200000];
    FILE *f = fopen("share/man5/scene.5", "r");
    size_t n;
    (void)state;
    assert_non_null(f);
    n = fread(page, 1, sizeof page - 1, f);
    fclose(f);
    page[n] = '\0';
    for (int k = 0; k < fl_key_count; k++) {
        const fl_key *key = &fl_key_table[k];
        char heading[100], entry[100];
        const char *from, *to, *at;
        snprintf(heading, sizeof heading, ".Ss %s\n", fl_section_table[key->section].form);
        from = strstr(page, heading);
        if (!from) fail_msg("scene.5 lacks the line %s", heading);
        to = strstr(from + 1, "\n.Ss ");
        if (!to) to = strstr(from + 1, "\n.Sh ");
        snprintf(entry, sizeof entry, "\n.It Cm %s , No default %s\n", key->key, key->default_text);
        at = strstr(from, entry);
        if (!at || (to && at > to)) fail_msg("under %s scene.5 lacks the line %s", heading, entry + 1);
    }
    for (int w = 0; w < fl_manual_count; w++) {
        char entry[100];
        snprintf(entry, sizeof entry, "\n.It Cm %s\n", fl_manual_table[w].word);
        if (!strstr(page, entry)) fail_msg("scene.5 lacks the word %s", fl_manual_table[w].word);
    }
}

/* Every key that a word of the field leads to is there, and no word is shadowed. */
static void field_words_lead_to_keys(void **state)
{
    (void)state;
    fl_err err;
    int rc, keys = 0;
    const fl_field_word *f;
    for (int k = 0; (f = fl_field_word_at(k)) != NULL; k++) {
        char word[40], says[200];
        assert_ptr_equal(fl_field_word_find(f->word), f);
        snprintf(says, sizeof says, "%s", f->says);
        for (char *w = strtok(says, " ,;[]"); w; w = strtok(NULL, " ,;[]")) {
            const char *dot = strchr(w, '.');
            if (!dot) continue;
            snprintf(word, sizeof word, "%.*s", (int)(dot - w), w);
            assert_true(fl_key_find(fl_section_find(word), dot + 1) >= 0);
            keys++;
        }
    }
    assert_true(keys > 30);
    assert_ptr_equal(fl_field_word_find("Ship_speeds"), fl_field_word_find("ship speed"));
    assert_null(fl_field_word_find("ship spee"));
    char *text = explain_key("ship-speed", &err, &rc);
    assert_int_equal(rc, 0);
    assert_string_equal(text, "ship speed: structure.velocity\n");
    free(text);
    free(explain_key("water.speed", &err, &rc));
    assert_non_null(strstr(err.text, "; structure.velocity of a hull, water.current of drifting ice"));
    text = explain_key("drag", &err, &rc); /* the keys of that name, and others with it in theirs */
    assert_non_null(strstr(text, "water.drag: "));
    assert_non_null(strstr(text, "wind.drag: "));
    assert_non_null(strstr(text, "\nwater.drag_force_coef: "));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(explain_shows_every_key),
        cmocka_unit_test(the_manual_page_lists_every_key),
        cmocka_unit_test(field_words_lead_to_keys),
    };
    return cmocka_run_group_tests_name("scene_key", tests, NULL, NULL);
}
