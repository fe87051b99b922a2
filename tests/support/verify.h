/* SPDX-License-Identifier: GPL-3.0-or-later */
/* verify.h -- a verification program is a table: one row per claim, with value, expectation, error,
 * tolerance.
 *
 *     int main(void)
 *     {
 *         verify_begin("contact laws");
 *         verify_row("V01", "F_max of two glass balls [kN]", f, 6.6543, 1e-4, VERIFY_REL);
 *         verify_order("V55", "sliding with drag", h, err, 5, 2.0, 0.1);
 *         return verify_end();
 *     }
 *
 * `make check` runs the quick version (verify_quick()), `make verify` the full one.  The full one may take
 * more steps, finer ones, more samples, but checks the same claims. */
#ifndef FL_TESTS_VERIFY_H
#define FL_TESTS_VERIFY_H

enum verify_kind {
    VERIFY_ABS, /* error = |value - expected|, tol in the unit of value */
    VERIFY_REL  /* error = |value - expected| / |expected|; expected = 0 requires 0 itself */
};

/* Prints the title of the table. */
void verify_begin(const char *topic);

/* 1 for the quick version (the environment variable FLOE_QUICK is set and not "0"). */
int verify_quick(void);

/* One row: ok when error <= tol; a value that is not finite fails.
 *   id    number of the claim, "V01"
 *   what  the quantity and its unit, "draft [m]" */
void verify_row(const char *id, const char *what, double value, double expected, double tol,
                enum verify_kind kind);

/* One row for value <= bound; a value that is not finite fails. */
void verify_below(const char *id, const char *what, double value, double bound);

/* Prints err[n] against the step h[n], n >= 2, with the order between neighbours, and fits one order p to
 * all of them: log err = p log h + c by least squares.  ok when |p - expected| <= tol; an error that is not
 * a positive number fails. */
void verify_order(const char *id, const char *what, const double *h, const double *err, int n,
                  double expected, double tol);

/* A claim without a number. */
void verify_true(const char *id, const char *what, int ok);

/* A line of explanation in the table. */
void verify_note(const char *fmt, ...) __attribute__((format(printf, 1, 2)));

/* Prints "N passed, N failed"; returns the exit status of the program: 0, or 1 when a row failed or there
 * was none. */
int verify_end(void);

#endif
