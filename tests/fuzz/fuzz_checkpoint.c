/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "out/restart.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_restart r = {0};
    const int rc = fl_restart_read(&r, fuzz_file(data, n), &err);
    fl_restart_free(&r);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "checkpoint", fuzz_one); }
