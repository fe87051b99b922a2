/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of bodies that are, or were, frozen together. */
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
    if (fl_world_make(&w, &world_of.scene, &world_of.field, NULL, &err) == 0) {
        if (fl_text_open(&in, fuzz_file(data, n), &err) == 0) rc = fl_snapshot_read(&w, &in, &err);
        fl_text_close(&in);
    }
    fl_world_free(&w);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv)
{
    fl_err err = {0};
    scene_of_bonds(&world_of, 2, NULL);
    lab_set(&world_of, "boundary.type=rigid rigid rigid"); /* a cell would be too narrow for so few */
    if (fl_scene_check(&world_of.scene, &err)) return 1;
    return fuzz_main(argc, argv, "bonds", fuzz_one);
}
