/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/sesam_element.h"

#define STRAIGHT                                                                                             \
    {                                                                                                        \
        0, 1, 2, 3, 4, 5, 6, 7                                                                               \
    }

static const fl_sesam_type TYPE[] = {
    {2, FL_LINE2, 0, STRAIGHT},                                                                /* BEPS */
    {10, FL_LINE2, 1, STRAIGHT},                                                               /* TESS */
    {15, FL_LINE2, 0, STRAIGHT},                                                               /* BEAS */
    {22, FL_LINE3, 0, {0, 2, 1}},                                                              /* SECB */
    {23, FL_LINE3, 0, {0, 2, 1}},                                                              /* BTSS */
    {3, FL_TRI3, 0, STRAIGHT},                                                                 /* CSTA */
    {25, FL_TRI3, 0, STRAIGHT},                                                                /* FTRS */
    {9, FL_QUAD4, 0, STRAIGHT},                                                                /* LQUA */
    {24, FL_QUAD4, 0, STRAIGHT},                                                               /* FQUS */
    {6, FL_TRI6, 0, {0, 2, 4, 1, 3, 5}},                                                       /* ILST */
    {26, FL_TRI6, 0, STRAIGHT},                                                                /* SCTS */
    {8, FL_QUAD8, 0, {0, 2, 4, 6, 1, 3, 5, 7}},                                                /* IQQE */
    {28, FL_QUAD8, 0, {0, 2, 4, 6, 1, 3, 5, 7}},                                               /* SCQS */
    {21, FL_HEX8, 0, STRAIGHT},                                                                /* LHEX */
    {32, FL_WEDGE6, 0, STRAIGHT},                                                              /* TPRI */
    {33, FL_TET4, 0, STRAIGHT},                                                                /* TETR */
    {20, FL_HEX20, 0, {0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11}}, /* IHEX */
    {30, FL_WEDGE15, 0, {0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8}},                   /* IPRI */
    {31, FL_TET10, 0, {0, 2, 4, 9, 1, 3, 5, 6, 7, 8}},                                         /* ITET */
};

const fl_sesam_type *fl_sesam_type_of(int type)
{
    for (size_t k = 0; k < sizeof TYPE / sizeof *TYPE; k++)
        if (TYPE[k].type == type) return &TYPE[k];
    return NULL;
}
