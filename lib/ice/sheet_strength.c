/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/sheet_strength.h"

typedef struct {
    enum fl_packing_kind kind;
    int32_t layers; /* and more, up to the next row */
    int across;
    fl_sheet_strength ratio;
} table_row;

/* flexural, compressive, young, spread */
static const table_row TABLE[] = {
    {FL_PACKING_HCP, 1, 0, {1.02, 11.6, 0.91, 0.05}}, {FL_PACKING_HCP, 1, 1, {1.18, 4.7, 0.87, 0.05}},
    {FL_PACKING_HCP, 2, 0, {1.29, 11.6, 1.45, 0.05}}, {FL_PACKING_HCP, 2, 1, {1.43, 4.7, 1.36, 0.05}},
    {FL_PACKING_HCP, 3, 0, {1.29, 11.6, 1.43, 0.05}}, {FL_PACKING_HCP, 3, 1, {1.43, 4.7, 1.35, 0.05}},
};
enum { ROWS = sizeof TABLE / sizeof *TABLE };

int fl_sheet_strength_of(enum fl_packing_kind kind, int32_t layers, int across, fl_sheet_strength *out,
                         fl_err *err)
{
    int found = -1;
    for (int k = 0; k < ROWS; k++)
        if (TABLE[k].kind == kind && TABLE[k].across == across && TABLE[k].layers <= layers) found = k;
    if (found < 0)
        return fl_fail(err, FL_USAGE,
                       "--flexural, --compressive and --young are calibrated for --lattice hcp alone");
    *out = TABLE[found].ratio;
    return 0;
}
