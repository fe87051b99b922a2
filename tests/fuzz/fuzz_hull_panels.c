/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "support/mesh.h"

int main(int argc, char **argv) { return fuzz_main(argc, argv, "hull_panels", mesh_fuzz_hulls); }
