/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "generator_table.h"
#include <string.h>
#include "floe_field.h"
#include "rubble.h"
#include "sphere_sheet.h"

const struct generator generator_table[] = {
    {.name = "lattice",
     .argument = "KIND",
     .help = "spheres in close packing in place of floes: hcp, hex or square",
     .keys = "size origin thickness material ice-density water-density velocity bonded layers diameter rows "
             "edges endless flexural compressive young scene certificate id format",
     .check = sphere_sheet_check,
     .history = sphere_sheet_history,
     .make = sphere_sheet_make},
    {.name = "rubble",
     .help = "blocks that fill the field from bottom to top, C is their fraction of its volume",
     .keys =
         "size origin floes concentration thickness radius seed smooth material ice-density water-density "
         "velocity certificate id format",
     .history = rubble_history,
     .make = rubble_make},
    {.keys =
         "size origin floes sizes concentration thickness radius seed smooth material ice-density "
         "water-density velocity keep-out margin outline lead grade periodic pancakes ridge block porosity "
         "bonded layers certificate id plot format",
     .history = floe_field_history,
     .make = floe_field_make},
};
const int generator_count = sizeof generator_table / sizeof generator_table[0];

int generator_reads(const struct generator *g, const char *option)
{
    const size_t len = strlen(option);
    for (const char *key = g->keys; *key;) {
        const size_t n = strcspn(key, " ");
        if (n == len && memcmp(key, option, n) == 0) return 1;
        key += n + (key[n] == ' ');
    }
    return 0;
}
