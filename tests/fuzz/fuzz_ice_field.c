/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/fuzz.h"
#include "scene/ice_field.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_ice_field field = {0};
    const int rc = fl_ice_field_read(&field, fuzz_file(data, n), &err);
    fl_ice_field_free(&field);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "ice_field", fuzz_one); }
