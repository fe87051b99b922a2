/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The columns of every table: header and rows agree, and the manual page lists the same columns in the
 * same order. */
#include "support/near.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/pi.h"
#include "out/tables.h"
#include "sim/energy_balance.h"

enum { COLUMNS = 64, NAME = 32 };

typedef struct {
    char name[COLUMNS][NAME];
    int n;
} names;

static void add(names *all, const char *name)
{
    assert_true(all->n < COLUMNS);
    snprintf(all->name[all->n++], NAME, "%s", name);
}

/* The items of the lists of a page, without lists inside an item. */
static names columns_of_page(const char *kind)
{
    names all = {.n = 0};
    char path[64], line[512];
    int depth = 0;
    snprintf(path, sizeof path, "share/man5/%s.5", kind);
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    while (fgets(line, sizeof line, f) && all.n < COLUMNS - 8) {
        depth += strncmp(line, ".Bl", 3) == 0;
        depth -= strncmp(line, ".El", 3) == 0;
        if (depth != 1 || strncmp(line, ".It Cm ", 7) != 0) continue;
        for (char *at, *word = strtok_r(line + 7, " \n", &at); word; word = strtok_r(NULL, " \n", &at))
            add(&all, word);
    }
    fclose(f);
    return all;
}

static names split(char *line)
{
    names all = {.n = 0};
    for (char *at, *word = strtok_r(line, "\t\n", &at); word; word = strtok_r(NULL, "\t\n", &at))
        add(&all, word);
    return all;
}

/* Header (row = NULL) or row of a table. */
static names line_of(const fl_table_format *table, unsigned options, const void *row)
{
    char *text = NULL;
    size_t n = 0;
    fl_history_line by;
    fl_history_line_start(&by, "test");
    FILE *f = open_memstream(&text, &n);
    assert_non_null(f);
    if (row) fl_table_write_row(f, table, options, 0.5, row);
    else fl_table_write_header(f, table, options, NULL, &by, NULL, 0.0);
    assert_int_equal(fclose(f), 0);
    char *last = text;
    for (char *p = text; (p = strchr(p, '\n')) && p[1];) last = ++p;
    const names all = split(last);
    free(text);
    return all;
}

static void check_page(const fl_table_format *table)
{
    const names head = line_of(table, ~0u, NULL), page = columns_of_page(table->kind);
    assert_true(page.n >= head.n); /* other tables may follow on the page */
    for (int k = 0; k < head.n; k++) assert_string_equal(head.name[k], page.name[k]);
}

static void pages_list_the_columns(void **state)
{
    (void)state;
    check_page(&fl_loads_table);
    check_page(&fl_state_table);
    check_page(&fl_contacts_table);
    check_page(&fl_bonds_table);
    check_page(&fl_panels_table);
    check_page(&fl_hash_table);
    check_page(&fl_energy_table);
}

/* A row has as many fields as its header has columns, whatever the options. */
static void rows_have_the_fields_of_the_header(void **state)
{
    const fl_loads_row loads = {.part = "leg"};
    const fl_ledger ledger = {.kinetic = 1.0};
    (void)state;
    for (unsigned options = 0; options < 8; options++) {
        assert_int_equal(line_of(&fl_energy_table, options, &ledger).n,
                         line_of(&fl_energy_table, options, NULL).n);
        assert_int_equal(line_of(&fl_loads_table, options & 3, &loads).n,
                         line_of(&fl_loads_table, options & 3, NULL).n);
    }
    const int fixed = line_of(&fl_loads_table, FL_LOADS_FIXED, NULL).n;
    assert_int_equal(line_of(&fl_loads_table, FL_LOADS_TRANSLATION, NULL).n, fixed + 9);
    assert_int_equal(line_of(&fl_loads_table, FL_LOADS_ROTATION, NULL).n, fixed + 18);
}

static void values_are_those_of_the_row(void **state)
{
    const fl_panels_row panel = {.panel = {"leg", 3}, .centroid = {1, 2, 3}, .area = 0.5, .force = {4, 5, 6}};
    const fl_loads_row loads = {.part = "leg", .peak = 7, .contacts = 2, .motion = {.r = {PI / 2, 0, 0}}};
    const fl_hash_row hash = {0xab};
    (void)state;
    const names a = line_of(&fl_panels_table, 0, &panel),
                b = line_of(&fl_loads_table, FL_LOADS_ROTATION, &loads),
                c = line_of(&fl_hash_table, 0, &hash);
    assert_string_equal(a.name[0], "0.5");
    assert_string_equal(a.name[1], "leg.3");
    assert_string_equal(a.name[4], "3");
    assert_string_equal(a.name[8], "6");
    assert_string_equal(b.name[9], "2");
    assert_string_equal(b.name[19], "90");
    assert_string_equal(c.name[1], "00000000000000ab");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pages_list_the_columns),
                                       cmocka_unit_test(rows_have_the_fields_of_the_header),
                                       cmocka_unit_test(values_are_those_of_the_row)};
    return cmocka_run_group_tests_name("tables", tests, NULL, NULL);
}
