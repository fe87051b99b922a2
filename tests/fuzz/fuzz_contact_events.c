/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/contact_events.h"
#include "stat/pressure.h"
#include "support/fuzz.h"

/* A window has no larger load than the total, and no contact a larger one than its window. */
static int check_windows(const fl_contact_events *h, fl_window_work *w, fl_err *err)
{
    const double area[] = {1e-6, 1.0, 1e6};
    for (int32_t i = 0; i < h->n; i++) {
        double all = 0.0;
        for (int32_t j = 0; j < h->n; j++)
            if (h->event[j].part == h->event[i].part) all += fmax(h->event[j].normal_force, 0.0);
        for (int a = 0; a < 3; a++) {
            fl_window b;
            if (fl_largest_load_window(h->n, h->event, h->event[i].part, area[a], &b, w, err)) return -1;
            if (!(b.force >= 0.0 && b.force <= all * (1.0 + 1e-9)) || b.contacts > h->n) return FUZZ_BROKEN;
        }
    }
    return 0;
}

static int fuzz_one(const unsigned char *data, size_t n)
{
    const fl_contact_selection ask = {.from = -INFINITY, .to = INFINITY};
    fl_err err = {0};
    fl_contact_events h = {0};
    fl_window_work w = {0};
    int64_t times;
    double step;
    int more = 1, rc = fl_contact_events_open(&h, fuzz_file(data, n), &ask, &err);
    while (rc == 0 && (more = fl_contact_events_next(&h, &err)) > 0)
        if (h.n <= 50) rc = check_windows(&h, &w, &err);
    if (rc == 0 && more < 0) rc = -1;
    if (rc == 0) rc = fl_contact_events_span(&h, &times, &step, &err);
    if (rc == 0 && (times < 1 || !(step >= 0.0))) rc = FUZZ_BROKEN;
    fl_contact_events_close(&h);
    fl_window_work_free(&w);
    return rc == FUZZ_BROKEN ? FUZZ_BROKEN : fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "contact_events", fuzz_one); }
