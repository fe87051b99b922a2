/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <string.h>
#include "scene/field_words.h"

static const fl_field_word table[] = {
    {"concentration", "voronoi-ice --concentration; the ice of a scene has that of its file"},
    {"ice concentration", "voronoi-ice --concentration; the ice of a scene has that of its file"},
    {"floe size", "voronoi-ice --mean-size or --sizes"},
    {"thickness", "voronoi-ice --thickness; ice.slab of a sheet of spheres"},
    {"ice thickness", "voronoi-ice --thickness; ice.slab of a sheet of spheres"},
    {"heading", "dem-solve --direction or structure.direction turns ice, current, wind and waves"},
    {"direction", "dem-solve --direction or structure.direction turns ice, current, wind and waves"},
    {"speed", "structure.velocity of a hull, water.current of drifting ice, wind.velocity, boundary.drive of "
              "driven ice"},
    {"ship speed", "structure.velocity"},
    {"towing speed", "structure.velocity"},
    {"drift", "water.current, and voronoi-ice --velocity for the speed of the floes at the start"},
    {"drift speed", "water.current, and voronoi-ice --velocity for the speed of the floes at the start"},
    {"wind speed", "wind.velocity"},
    {"ship", "structure.file; struct-import makes it from a mesh"},
    {"hull", "structure.file; struct-import makes it from a mesh"},
    {"leg", "structure.file; struct-import --cylinder makes it"},
    {"mesh", "structure.file; struct-import makes it from a mesh"},
    {"draft",
     "struct-import --translate 0,0,Z moves a mesh to its draft, as still water is z = 0; water.level"},
    {"draught",
     "struct-import --translate 0,0,Z moves a mesh to its draft, as still water is z = 0; water.level"},
    {"resistance", "loadstats -C resistance"},
    {"friction coefficient", "structure.friction of ice on the structure, material.friction of ice on ice"},
    {"modulus", "material.young; contact.stiffness_factor softens contacts"},
    {"elastic modulus", "material.young; contact.stiffness_factor softens contacts"},
    {"youngs modulus", "material.young; contact.stiffness_factor softens contacts"},
    {"time step", "run.dt; run.error chooses it for an error of the load"},
    {"timestep", "run.dt; run.error chooses it for an error of the load"},
    {"dt", "run.dt; run.error chooses it for an error of the load"},
    {"sampling", "output.loads_every"},
    {"output interval", "output.loads_every, output.frames_every"},
    {"animation", "output.frames and output.frames_every"},
    {"flexural strength", "failure.flexural_strength of floes; voronoi-ice --flexural of a bonded sheet"},
    {"bending strength", "failure.flexural_strength of floes; voronoi-ice --flexural of a bonded sheet"},
    {"compressive strength",
     "failure.pressure of ice that crushes; voronoi-ice --compressive of a bonded sheet"},
    {"crushing strength",
     "failure.pressure of ice that crushes; voronoi-ice --compressive of a bonded sheet"},
    {"ice pressure", "boundary.line_load of a driven pack; loadstats for pressures on panels"},
    {"pack pressure", "boundary.line_load, N/m"},
    {"confinement", "boundary.type and boundary.line_load, see ice-scenes(7)"},
    {"channel", "boundary.type = rigid with boundary.min and boundary.max"},
    {"tank", "boundary.type = rigid with boundary.min and boundary.max"},
    {"wave height", "water.height, with water.wave and water.period"},
    {"mooring", "structure.stiffness with structure.free"},
};

/* The same letters but for capitals, '_' and '-', and an s at the end of the asked word. */
static int is_same(const char *asked, const char *word)
{
    for (; *word; asked++, word++) {
        const int c = *asked == '_' || *asked == '-' ? ' ' : tolower((unsigned char)*asked);
        if (c != *word) return 0;
    }
    return !*asked || (asked[0] == 's' && !asked[1]);
}

const fl_field_word *fl_field_word_at(int k)
{
    return k >= 0 && (size_t)k < sizeof table / sizeof *table ? &table[k] : NULL;
}

const fl_field_word *fl_field_word_find(const char *word)
{
    for (size_t k = 0; k < sizeof table / sizeof *table; k++)
        if (is_same(word, table[k].word)) return &table[k];
    return NULL;
}
