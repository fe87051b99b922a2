/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fuzz.h -- a reader on its corpus, on thousands of damaged copies of it, and with failing allocations.  A
 * target is
 *
 *     static int fuzz_one(const unsigned char *data, size_t n)
 *     {
 *         fl_err err = {0};
 *         fl_thing thing = {0};
 *         const int rc = fl_thing_read(&thing, fuzz_file(data, n), &err);
 *         fl_thing_free(&thing);
 *         return fuzz_verdict(rc, &err);
 *     }
 *     int main(int argc, char **argv) { return fuzz_main(argc, argv, "thing", fuzz_one); }
 *
 * and its corpus is tests/fuzz/thing/.  A corpus file whose name starts with "good" must be read, one whose
 * name starts with "bad" must be refused; any other may be either. */
#ifndef FL_TESTS_FUZZ_H
#define FL_TESTS_FUZZ_H
#include <stddef.h>
#include "base/err.h"

enum fuzz_result { FUZZ_READ, FUZZ_REFUSED, FUZZ_BROKEN, FUZZ_SYSTEM };

/* Runs the reader on these bytes.  Returns FUZZ_BROKEN if it violates its contract, else the result of
 * fuzz_verdict(). */
typedef int fuzz_fn(const unsigned char *data, size_t n);

/* Classifies a call that returned rc and err: FUZZ_READ (rc = 0, err empty), FUZZ_REFUSED (rc = -1 and one
 * sentence on one line), FUZZ_SYSTEM (the same with FL_SYSTEM), FUZZ_BROKEN for anything else. */
int fuzz_verdict(int rc, const fl_err *err);

/* Path of a file that holds these bytes; the next call overwrites it. */
const char *fuzz_file(const unsigned char *data, size_t n);

/* For each file of the corpus, in the order of their names:
 *  - the unchanged file;
 *  - damaged copies: bits flipped, ends cut, lines lost, repeated or swapped, numbers replaced by -1,
 * 1e309, nan, 2147483648 and the like, parts of other corpus files spliced in.  Copy m of a file is the
 * same in every run.  Their number is 400 when FLOE_QUICK is set, 4000 otherwise, or FLOE_FUZZ; fewer for
 * files so long that this would take minutes;
 *  - the unchanged file with allocation 0, 1, 2, ... and all later ones failing, until none fails any more.
 * A reader is broken when it crashes, takes more than 30 s of processor time, leaves rc and err in
 * disagreement, reads what it must refuse or the reverse, uses more than 2 GiB of memory, or continues
 * after a failed allocation.
 *
 *     program [FOLDER]           the corpus, tests/fuzz/<name> unless named
 *     program --print FILE M     write damaged copy M of FILE to standard output, to examine a failure
 * Prints "N passed, N failed", a file being one, and returns the exit status.  With argc 0 it only stores
 * the reader in fuzz_target, for inputs that libFuzzer makes (tests/guided_fuzz.sh). */
int fuzz_main(int argc, char **argv, const char *name, fuzz_fn *one);
extern fuzz_fn *fuzz_target;

#endif
