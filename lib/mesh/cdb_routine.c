/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
#include "mesh/cdb_routine.h"
#include "mesh/elements.h"

enum { NONE = FL_CDB_NONE, SOLID = FL_CDB_SOLID, BRICK = FL_CDB_BRICK, SHELL = FL_CDB_SHELL };
enum { LINE = FL_CDB_LINE, CURVE = FL_CDB_CURVE, MESH };

static const struct {
    int16_t routine;
    uint8_t is;
} ROUTINE[] = {
    {1, LINE},    {2, SHELL},   {3, LINE},    {4, LINE},    {5, SOLID},   {8, LINE},    {9, LINE},
    {10, LINE},   {13, SHELL},  {16, LINE},   {20, LINE},   {23, LINE},   {24, LINE},   {25, SHELL},
    {28, SHELL},  {35, SHELL},  {41, SHELL},  {42, SHELL},  {43, SHELL},  {44, LINE},   {45, SOLID},
    {46, SOLID},  {55, SHELL},  {57, SHELL},  {59, LINE},   {62, SOLID},  {63, SHELL},  {64, SOLID},
    {65, SOLID},  {69, SOLID},  {70, SOLID},  {72, SOLID},  {73, SOLID},  {75, SHELL},  {77, SHELL},
    {78, SHELL},  {82, SHELL},  {83, SHELL},  {87, SOLID},  {90, BRICK},  {91, SHELL},  {92, SOLID},
    {93, SHELL},  {95, BRICK},  {96, SOLID},  {97, SOLID},  {98, SOLID},  {99, SHELL},  {122, BRICK},
    {123, SOLID}, {127, SOLID}, {128, BRICK}, {131, SHELL}, {132, SHELL}, {143, SHELL}, {147, BRICK},
    {148, SOLID}, {150, SHELL}, {157, SHELL}, {164, SOLID}, {163, SHELL}, {168, SOLID}, {180, LINE},
    {181, SHELL}, {182, SHELL}, {183, SHELL}, {185, SOLID}, {186, BRICK}, {187, SOLID}, {188, LINE},
    {189, CURVE}, {190, SOLID}, {191, BRICK}, {200, MESH},  {223, SHELL}, {226, BRICK}, {227, SOLID},
    {231, BRICK}, {232, SOLID}, {236, BRICK}, {237, SOLID}, {239, BRICK}, {240, SOLID}, {278, SOLID},
    {279, BRICK}, {281, SHELL}, {285, SOLID}, {288, LINE},  {289, CURVE}, {290, CURVE}, {291, SOLID},
};

/* Family of MESH200 by its first key option. */
static const uint8_t MESH200[] = {LINE,  CURVE, LINE,  CURVE, SHELL, SHELL,
                                  SHELL, SHELL, SOLID, SOLID, SOLID, SOLID};

static int solid_shape(int n)
{
    if (n == 4) return FL_TET4;
    if (n == 5) return FL_PYRAMID5;
    if (n == 6) return FL_WEDGE6;
    if (n == 8) return FL_HEX8;
    if (n == 10) return FL_TET10;
    if (n == 13) return FL_PYRAMID13;
    if (n == 15) return FL_WEDGE15;
    return n > 8 ? FL_HEX20 : -1;
}

static int shell_shape(int n)
{
    if (n == 3) return FL_TRI3;
    if (n == 4) return FL_QUAD4;
    if (n == 6) return FL_TRI6;
    return n > 4 ? FL_QUAD8 : -1;
}

fl_cdb_family fl_cdb_family_of(int32_t routine, int32_t key)
{
    for (size_t k = 0; k < sizeof ROUTINE / sizeof ROUTINE[0]; k++)
        if (ROUTINE[k].routine == routine) {
            if (ROUTINE[k].is != MESH) return (fl_cdb_family)ROUTINE[k].is;
            return key >= 0 && key < (int32_t)sizeof MESH200 ? (fl_cdb_family)MESH200[key] : FL_CDB_NONE;
        }
    return FL_CDB_NONE;
}

int fl_cdb_shape_of(fl_cdb_family family, int n)
{
    switch (family) {
    case FL_CDB_SOLID:
    case FL_CDB_BRICK: return solid_shape(n);
    case FL_CDB_SHELL: return shell_shape(n);
    case FL_CDB_LINE: return n >= 2 ? FL_LINE2 : -1;
    case FL_CDB_CURVE: return n > 2 ? FL_LINE3 : n == 2 ? FL_LINE2 : -1;
    default: return -1;
    }
}
