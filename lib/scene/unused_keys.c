/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include "scene/unused_keys.h"
#include "scene/scene_section.h"

/* key bears on nothing where neither of needs is given. */
static const struct {
    int section;
    const char *key, *needs[2];
} NEEDS[] = {
    {FL_SEC_RUN, "error_of", {"error"}},
    {FL_SEC_WATER, "profile_exponent", {"profile"}},
    {FL_SEC_WATER, "profile_depth", {"profile"}},
    {FL_SEC_WATER, "skin_coef", {"drag"}},
    {FL_SEC_WATER, "form_coef", {"drag"}},
    {FL_SEC_WATER, "height", {"wave"}},
    {FL_SEC_WATER, "period", {"wave"}},
    {FL_SEC_WATER, "direction", {"wave"}},
    {FL_SEC_WATER, "gamma", {"wave"}},
    {FL_SEC_WATER, "components", {"wave"}},
    {FL_SEC_WATER, "seed", {"wave"}},
    {FL_SEC_WIND, "direction", {"beaufort"}},
    {FL_SEC_WIND, "form_coef", {"drag"}},
    {FL_SEC_BOUNDARY, "foundation", {"type"}},
    {FL_SEC_BOUNDARY, "damping", {"type"}},
    {FL_SEC_BOUNDARY, "inflow_file", {"inflow"}},
    {FL_SEC_BOUNDARY, "inflow_from", {"inflow"}},
    {FL_SEC_BOUNDARY, "inflow_speed", {"inflow"}},
    {FL_SEC_BOUNDARY, "inflow_pitch", {"inflow"}},
    {FL_SEC_BOUNDARY, "room", {"inflow"}},
    {FL_SEC_BOUNDARY, "drive", {"drive_width", "drive_group"}},
    {FL_SEC_BOUNDARY, "drive_edge", {"drive_width"}},
    {FL_SEC_BOUNDARY, "drive_fixed", {"drive_width", "drive_group"}},
    {FL_SEC_BOUNDARY, "drive_spring", {"drive_width", "drive_group"}},
    {FL_SEC_BOUNDARY, "drive_foundation", {"drive_width", "drive_group"}},
    {FL_SEC_STRUCTURE, "interpolation", {"track"}},
    {FL_SEC_BOND, "normal_strength", {"on"}},
    {FL_SEC_BOND, "shear_strength", {"on"}},
    {FL_SEC_BOND, "friction", {"on"}},
    {FL_SEC_BOND, "young", {"on"}},
    {FL_SEC_BOND, "poisson", {"on"}},
    {FL_SEC_BOND, "energy", {"on"}},
    {FL_SEC_BOND, "shear_energy", {"energy"}},
    {FL_SEC_BOND, "mixing", {"energy"}},
    {FL_SEC_BOND, "softening", {"on"}},
    {FL_SEC_BOND, "stretch", {"softening"}},
    {FL_SEC_BOND, "damping", {"on"}},
};

/* Sections without a name, of which a scene has one each, begin with their head. */
static int given(const fl_scene *s, int section, const char *key)
{
    const fl_scene_head *head = (const void *)((const char *)s + fl_section_table[section].at);
    return key && head->key[fl_key_find(section, key) - fl_key_first(section)].line != 0;
}

int fl_scene_check_unused(const fl_scene *s, fl_err *err)
{
    for (size_t k = 0; k < sizeof NEEDS / sizeof *NEEDS; k++) {
        const int section = NEEDS[k].section;
        const char *of = fl_section_table[section].name, *const *needs = NEEDS[k].needs;
        char at[2 * FL_SCENE_NAME];
        if (!given(s, section, NEEDS[k].key) || given(s, section, needs[0]) || given(s, section, needs[1]))
            continue;
        snprintf(at, sizeof at, "%s.%s", of, NEEDS[k].key);
        return fl_scene_fail(s, at, err, "%s bears on nothing: %s.%s%s%s is expected", at, of, needs[0],
                             needs[1] ? " or " : "", needs[1] ? needs[1] : "");
    }
    return 0;
}
