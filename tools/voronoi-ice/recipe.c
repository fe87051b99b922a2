/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "recipe.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include "base/number_text.h"

int recipe_check_file(const char *option, const char *text, const char *expected, fl_err *err)
{
    if (strcmp(text, "-") == 0 || access(text, F_OK) == 0) return 0;
    return fl_fail(err, FL_INPUT, "--%s is \"%.60s\", %s or a file that is there is expected", option, text,
                   expected);
}

void recipe_history_numbers(fl_history_line *by, const char *option, char divide, int n, const double *x)
{
    char text[9][FL_NUMBER_LEN], all[9 * (FL_NUMBER_LEN + 1) + 1] = "";
    for (int k = 0; k < n; k++) {
        const size_t at = strlen(all);
        snprintf(all + at, sizeof all - at, "%s%.1s", fl_number_text(x[k], text[k]),
                 k + 1 < n ? &divide : "");
    }
    fl_history_line_add(by, "%s%s", option, all);
}

static void add_pair(fl_history_line *by, const char *option, char divide, fl_vec2 p)
{
    recipe_history_numbers(by, option, divide, 2, (const double[]){p.x, p.y});
}

void recipe_set_id(struct recipe *o, const fl_ice_field *field)
{
    if (!o->id || strcmp(o->id, "auto") != 0) return;
    snprintf(o->id_made, sizeof o->id_made, "%016llx", (unsigned long long)fl_ice_field_hash(field));
    o->id = o->id_made;
}

static void add_grade(fl_history_line *by, const struct recipe *o)
{
    char text[FL_NUMBER_LEN], option[FL_NUMBER_LEN + 16];
    snprintf(option, sizeof option, "--grade %s:", fl_number_text(o->grade_angle, text));
    if (o->grade_file) fl_history_line_word(by, option, o->grade_file);
    else recipe_history_numbers(by, option, ',', 2, o->grade);
}

void recipe_history_floes(const struct recipe *o, fl_history_line *by)
{
    fl_history_line_add(by, "--floes %d", o->floes);
    if (o->sizes) fl_history_line_word(by, "--sizes ", o->sizes);
    if (o->graded) add_grade(by, o);
    else if (!o->bonded) recipe_history_numbers(by, "--concentration ", ',', 1, &o->concentration);
    fl_history_line_word(by, "--thickness ", o->thickness_law);
    recipe_history_numbers(by, "--radius ", ',', 1, &o->radius);
    fl_history_line_add(by, "--seed %llu", (unsigned long long)o->seed);
    fl_history_line_add(by, "--smooth %d", o->smooth);
    if (o->gaps == GAPS_RANDOM) fl_history_line_add(by, "--gaps random");
    if (o->says_even) fl_history_line_add(by, "--gaps even");
}

void recipe_history(const struct recipe *o, fl_history_line *by)
{
    fl_history_line_start(by, "voronoi-ice");
    if (o->id) fl_history_line_add(by, "--id %s", o->id);
    if (o->outline) fl_history_line_word(by, "--outline ", o->outline);
    else if (o->disc[0] > 0.0) recipe_history_numbers(by, "--outline disc:", ',', 3, o->disc);
    else {
        add_pair(by, "--size ", 'x', o->size);
        add_pair(by, "--origin ", ',', o->origin);
    }
    o->generator->history(o, by);
    for (int k = 0; k < o->ridges; k++) recipe_history_numbers(by, "--ridge ", ',', 9, o->ridge[k]);
    if (o->ridges && o->block > 0.0) recipe_history_numbers(by, "--block ", ',', 1, &o->block);
    if (o->ridges) recipe_history_numbers(by, "--porosity ", ',', 1, &o->porosity);
    if (o->pancakes) fl_history_line_add(by, "--pancakes %d", o->pancakes);
    if (o->bonded) fl_history_line_add(by, "--bonded");
    if (o->periodic[0] || o->periodic[1])
        fl_history_line_add(by, "--periodic %s%s", o->periodic[0] ? "x" : "", o->periodic[1] ? "y" : "");
    fl_history_line_add(by, "--material %s", o->material);
    recipe_history_numbers(by, "--ice-density ", ',', 1, &o->ice_density);
    recipe_history_numbers(by, "--water-density ", ',', 1, &o->water_density);
    add_pair(by, "--velocity ", ',', o->velocity);
    for (int k = 0; k < o->keep_outs; k++) {
        const struct keep_out *s = &o->keep_out[k];
        if (s->circle)
            recipe_history_numbers(by, "--keep-out circle:", ',', 3,
                                   (const double[]){s->lo.x, s->lo.y, s->r});
        else
            recipe_history_numbers(by, "--keep-out box:", ',', 4,
                                   (const double[]){s->lo.x, s->lo.y, s->hi.x, s->hi.y});
    }
    for (int k = 0; k < o->leads; k++) recipe_history_numbers(by, "--lead ", ',', 5, o->lead[k]);
    for (int k = 0; k < o->structures; k++) fl_history_line_word(by, "--keep-out ", o->structure[k]);
    if (o->structures) recipe_history_numbers(by, "--margin ", ',', 1, &o->margin);
}
