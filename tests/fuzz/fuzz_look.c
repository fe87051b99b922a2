/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "view/look.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_look l = fl_look_defaults();
    const int rc = fl_look_read(&l, fuzz_file(data, n), &err);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "look", fuzz_one); }
