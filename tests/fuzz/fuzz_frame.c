/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decks of Abaqus, ANSYS and Nastran read as frames, and the members that they become. */
#include "member/member_import.h"
#include "mesh/read_mesh.h"
#include "support/fuzz.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_surface s = {0};
    fl_frame_model f = {0};
    fl_member_model m = {0};
    fl_import_options opt = {.frame = &f};
    char note[FL_MESH_NOTE];
    const int rc = fl_mesh_read(&s, fuzz_file(data, n), &opt, note, &err) ||
                           fl_member_import(&m, &f, 3, 1.0, (fl_vec3){0, 0, 0}, "deck", &err)
                       ? -1
                       : 0;
    int verdict = fuzz_verdict(rc, &err);
    if (verdict == FUZZ_READ && m.member_name.n == 0) verdict = FUZZ_BROKEN;
    if (verdict != FUZZ_READ && m.member_name.n) verdict = FUZZ_BROKEN;
    fl_surface_free(&s);
    fl_frame_model_free(&f);
    fl_member_model_free(&m);
    return verdict;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "frame", fuzz_one); }
