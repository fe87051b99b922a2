/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of an error budget, stored in a checkpoint after its hash. */
#include "scene/scene_check.h"
#include "sim/error_budget.h"
#include "support/fuzz.h"
#include "support/scenes.h"

static lab world_of;
static fl_error_budget into; /* made once: each read replaces the previous state */

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_text in = {0};
    const int rc =
        fl_text_open(&in, fuzz_file(data, n), &err) || fl_error_budget_read(&into, &in, &err) ? -1 : 0;
    fl_text_close(&in);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv)
{
    fl_err err = {0};
    scene_of_everything(&world_of, 2, NULL);
    lab_set(&world_of, "structure.file=lab");
    lab_set(&world_of, "run.error=0.01");
    if (fl_scene_check(&world_of.scene, &err) ||
        fl_error_budget_make(&into, &world_of.scene, &world_of.field, &world_of.field, &world_of.surface,
                             NULL, &err))
        return 1;
    const int rc = fuzz_main(argc, argv, "budget", fuzz_one);
    fl_error_budget_free(&into);
    lab_free(&world_of);
    return rc;
}
