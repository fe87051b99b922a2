/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ice/sheet_strength.h"

typedef struct {
    enum fl_packing_kind kind;
    int32_t layers; /* and more, up to the next row */
    int across;
    fl_sheet_strength ratio;
} table_row;

/* flexural, compressive, young, their spreads.  One layer of hex is one of hcp, but for a block of many. */
static const table_row TABLE[] = {
    {FL_PACKING_HCP, 1, 0, {0.87, 4.24, 0.76, 0.10, 0.01}},
    {FL_PACKING_HCP, 1, 1, {0.92, 3.13, 0.81, 0.14, 0.01}},
    {FL_PACKING_HCP, 2, 0, {1.36, 4.24, 1.24, 0.03, 0.01}},
    {FL_PACKING_HCP, 2, 1, {1.29, 3.13, 1.18, 0.07, 0.01}},
    {FL_PACKING_HCP, 3, 0, {1.36, 4.24, 1.16, 0.12, 0.01}},
    {FL_PACKING_HCP, 3, 1, {1.44, 3.13, 1.13, 0.04, 0.01}},
    {FL_PACKING_HEX, 1, 0, {0.87, 2.27, 0.76, 0.10, 0.05}},
    {FL_PACKING_HEX, 1, 1, {0.92, 2.62, 0.81, 0.14, 0.04}},
    {FL_PACKING_HEX, 2, 0, {0.93, 2.27, 0.72, 0.01, 0.05}},
    {FL_PACKING_HEX, 2, 1, {1.01, 2.62, 0.80, 0.04, 0.04}},
    {FL_PACKING_HEX, 3, 0, {0.92, 2.27, 0.71, 0.04, 0.05}},
    {FL_PACKING_HEX, 3, 1, {1.03, 2.62, 0.70, 0.05, 0.04}},
    {FL_PACKING_SQUARE, 1, 0, {0.65, 0.00, 0.53, 0.14, 0.00}},
    {FL_PACKING_SQUARE, 2, 0, {0.56, 0.00, 0.26, 0.06, 0.00}},
    {FL_PACKING_SQUARE, 3, 0, {0.62, 0.00, 0.34, 0.07, 0.00}},
};
enum { ROWS = sizeof TABLE / sizeof *TABLE };

fl_sheet_strength fl_sheet_strength_of(enum fl_packing_kind kind, int32_t layers, int across)
{
    int found = 0;
    for (int k = 0; k < ROWS; k++)
        if (TABLE[k].kind == kind && (kind == FL_PACKING_SQUARE || TABLE[k].across == across) &&
            TABLE[k].layers <= layers)
            found = k;
    return TABLE[found].ratio;
}
