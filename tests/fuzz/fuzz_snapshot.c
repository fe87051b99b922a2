/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state in a checkpoint, after its hash. */
#include "scene/scene_check.h"
#include "support/fuzz.h"
#include "support/scenes.h"
#include "support/state.h"

static lab world_of; /* every state is read into a fresh world of this scene */

static int fuzz_one(const unsigned char *data, size_t n) { return state_fuzz(&world_of, data, n); }

int main(int argc, char **argv)
{
    fl_err err = {0};
    scene_of_everything(&world_of, 2, NULL);
    /* a sphere that rests on another, and one next to it */
    lab_sphere(&world_of, v3(-0.5, -0.5, 0.35), 0.43, v3(0, 0, -0.2), v3(0, 0, 0));
    lab_sphere(&world_of, v3(-0.5, -1.3, 0.0), 0.43, v3(0, 0, -0.2), v3(0, 0, 0));
    lab_set(&world_of, "structure.file=lab");
    if (fl_scene_check(&world_of.scene, &err)) return 1;
    return fuzz_main(argc, argv, "snapshot", fuzz_one);
}
