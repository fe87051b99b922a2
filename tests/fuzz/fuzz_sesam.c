/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "support/mesh.h"

int main(int argc, char **argv) { return fuzz_main(argc, argv, "sesam", mesh_fuzz_members); }
