/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/quick_rows.h"
#include <stdlib.h>

void fl_quick_scratch_free(fl_quick_scratch *w)
{
    free(w->polygon), free(w->height), free(w->support);
    *w = (fl_quick_scratch){0};
}
