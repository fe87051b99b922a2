/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of bonded bodies, intact or broken. */
#include "scene/scene_check.h"
#include "support/fuzz.h"
#include "support/scenes.h"
#include "support/state.h"

static lab world_of; /* every state is read into a fresh world of this scene */

static int fuzz_one(const unsigned char *data, size_t n) { return state_fuzz(&world_of, data, n); }

int main(int argc, char **argv)
{
    fl_err err = {0};
    scene_of_bonds(&world_of, 2, NULL);
    lab_set(&world_of,
            "boundary.type=rigid rigid rigid"); /* a periodic cell would be too narrow for so few bodies */
    if (fl_scene_check(&world_of.scene, &err)) return 1;
    return fuzz_main(argc, argv, "bonds", fuzz_one);
}
