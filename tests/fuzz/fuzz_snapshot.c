/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state inside a checkpoint, behind its hash. */
#include "scene/scene_check.h"
#include "step/snapshot.h"
#include "support/fuzz.h"
#include "support/scenes.h"

static lab world_of; /* what every state is read into a fresh world of */

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_text in = {0};
    fl_world w = {0};
    int rc = -1;
    if (fl_world_make(&w, &world_of.scene, &world_of.field, &world_of.surface, &err) == 0) {
        if (fl_text_open(&in, fuzz_file(data, n), &err) == 0) rc = fl_snapshot_read(&w, &in, &err);
        fl_text_close(&in);
    }
    fl_world_free(&w);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv)
{
    fl_err err = {0};
    scene_of_everything(&world_of, 2, NULL);
    /* a sphere that stands on another, and one beside */
    lab_sphere(&world_of, v3(-0.5, -0.5, 0.35), 0.43, v3(0, 0, -0.2), v3(0, 0, 0));
    lab_sphere(&world_of, v3(-0.5, -1.3, 0.0), 0.43, v3(0, 0, -0.2), v3(0, 0, 0));
    lab_set(&world_of, "structure.file=lab");
    if (fl_scene_check(&world_of.scene, &err)) return 1;
    return fuzz_main(argc, argv, "snapshot", fuzz_one);
}
