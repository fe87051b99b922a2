/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/sheet_strength.h"

typedef struct {
    enum fl_packing_kind kind;
    int32_t layers; /* and more, up to the next row */
    int across;
    fl_sheet_strength ratio;
} table_row;

/* flexural, compressive (0: not measured), young, spread.  One layer of hex is one of hcp. */
static const table_row TABLE[] = {
    {FL_PACKING_HCP, 1, 0, {0.87, 4.24, 0.76, 0.10}}, {FL_PACKING_HCP, 1, 1, {0.92, 3.13, 0.81, 0.14}},
    {FL_PACKING_HCP, 2, 0, {1.36, 4.24, 1.24, 0.03}}, {FL_PACKING_HCP, 2, 1, {1.29, 3.13, 1.18, 0.07}},
    {FL_PACKING_HCP, 3, 0, {1.36, 4.24, 1.16, 0.12}}, {FL_PACKING_HCP, 3, 1, {1.44, 3.13, 1.13, 0.04}},
    {FL_PACKING_HEX, 1, 0, {0.87, 0.00, 0.76, 0.10}}, {FL_PACKING_HEX, 1, 1, {0.92, 0.00, 0.81, 0.14}},
    {FL_PACKING_HEX, 2, 0, {0.92, 0.00, 0.72, 0.01}}, {FL_PACKING_HEX, 2, 1, {1.03, 0.00, 0.81, 0.05}},
    {FL_PACKING_HEX, 3, 0, {0.91, 0.00, 0.70, 0.02}}, {FL_PACKING_HEX, 3, 1, {1.03, 0.00, 0.69, 0.07}},
};
enum { ROWS = sizeof TABLE / sizeof *TABLE };

int fl_sheet_strength_of(enum fl_packing_kind kind, int32_t layers, int across, fl_sheet_strength *out,
                         fl_err *err)
{
    int found = -1;
    for (int k = 0; k < ROWS; k++)
        if (TABLE[k].kind == kind && TABLE[k].across == across && TABLE[k].layers <= layers) found = k;
    if (found < 0)
        return fl_fail(
            err, FL_USAGE,
            "--flexural, --compressive and --young are calibrated for --lattice hcp and hex alone");
    *out = TABLE[found].ratio;
    return 0;
}
