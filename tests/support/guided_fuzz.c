/* SPDX-License-Identifier: GPL-3.0-or-later */
/* guided_fuzz.c -- what libFuzzer calls: the reader of a program of tests/fuzz whose main() was compiled as
 * fuzz_program().  tests/guided_fuzz.sh builds and runs it. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include "support/fuzz.h"

int fuzz_program(int argc, char **argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n);

/* A reader that breaks its contract is a crash here; running out of memory is not. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t n)
{
    if (!fuzz_target) fuzz_program(0, NULL);
    if (fuzz_target(data, n) != FUZZ_BROKEN) return 0;
    fputs("the reader broke its contract\n", stderr);
    abort();
}
