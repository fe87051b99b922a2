/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
#include "mesh/cdb_routine.h"
#include "mesh/elements.h"

enum { SOLID = FL_CDB_SOLID, BRICK = FL_CDB_BRICK, TET = FL_CDB_TET, SHELL = FL_CDB_SHELL, TRI = FL_CDB_TRI };
enum { LINE = FL_CDB_LINE, CURVE = FL_CDB_CURVE, MESH };

static const struct {
    int16_t routine;
    uint8_t is;
} ROUTINE[] = {
    {1, LINE},    {2, TRI},     {3, LINE},    {4, LINE},    {5, SOLID},   {8, LINE},    {9, LINE},
    {10, LINE},   {13, SHELL},  {16, LINE},   {20, LINE},   {23, LINE},   {24, LINE},   {25, SHELL},
    {28, SHELL},  {35, TRI},    {41, SHELL},  {42, SHELL},  {43, SHELL},  {44, LINE},   {45, SOLID},
    {46, SOLID},  {55, SHELL},  {57, SHELL},  {59, LINE},   {62, SOLID},  {63, SHELL},  {64, SOLID},
    {65, SOLID},  {69, SOLID},  {70, SOLID},  {72, TET},    {73, SOLID},  {75, SHELL},  {77, SHELL},
    {78, SHELL},  {82, SHELL},  {83, SHELL},  {87, TET},    {90, BRICK},  {91, SHELL},  {92, TET},
    {93, SHELL},  {95, BRICK},  {96, SOLID},  {97, SOLID},  {98, TET},    {99, SHELL},  {122, BRICK},
    {123, TET},   {127, TET},   {128, BRICK}, {131, SHELL}, {132, SHELL}, {143, SHELL}, {147, BRICK},
    {148, TET},   {150, SHELL}, {157, SHELL}, {163, SHELL}, {164, SOLID}, {168, TET},   {180, LINE},
    {181, SHELL}, {182, SHELL}, {183, SHELL}, {185, SOLID}, {186, BRICK}, {187, TET},   {188, LINE},
    {189, CURVE}, {190, SOLID}, {191, BRICK}, {200, MESH},  {212, SHELL}, {213, SHELL}, {215, SOLID},
    {216, BRICK}, {217, TET},   {223, SHELL}, {226, BRICK}, {227, TET},   {230, SHELL}, {231, BRICK},
    {232, TET},   {233, SHELL}, {236, BRICK}, {237, TET},   {238, SHELL}, {239, BRICK}, {240, TET},
    {278, SOLID}, {279, BRICK}, {281, SHELL}, {285, TET},   {288, LINE},  {289, CURVE}, {290, CURVE},
    {291, TET},   {292, SHELL}, {293, SHELL},
};

/* Family of MESH200 by its first key option. */
static const uint8_t MESH200[] = {LINE, CURVE, LINE, CURVE, TRI, TRI, SHELL, SHELL, TET, TET, SOLID, BRICK};

/* Of a brick with 4, 5 or 6 nodes these are its corners; from 8 on all corners are there, and what is missing
 * are mid-side nodes. */
static int brick_shape(int n)
{
    if (n == 4) return FL_TET4;
    if (n == 5) return FL_PYRAMID5;
    if (n == 6) return FL_WEDGE6;
    return n > 8 ? FL_HEX20 : n == 8 ? FL_HEX8 : -1;
}

static int quad_shape(int n)
{
    if (n == 3) return FL_TRI3;
    return n > 4 ? FL_QUAD8 : n == 4 ? FL_QUAD4 : -1;
}

/* Tetrahedra in the form of a brick, I J K K M M M M, as some programs write them. */
static int is_folded_brick(int n, const int64_t *node)
{
    return n >= 8 && node[2] == node[3] && node[4] >= 1 && node[4] == node[5] && node[6] == node[4] &&
           node[7] == node[4];
}

fl_cdb_family fl_cdb_family_of(int32_t routine, int32_t key)
{
    for (size_t k = 0; k < sizeof ROUTINE / sizeof ROUTINE[0]; k++)
        if (ROUTINE[k].routine == routine) {
            if (routine == 183 && key == 1) return FL_CDB_TRI;
            if (ROUTINE[k].is != MESH) return (fl_cdb_family)ROUTINE[k].is;
            return key >= 0 && key < (int32_t)sizeof MESH200 ? (fl_cdb_family)MESH200[key] : FL_CDB_NONE;
        }
    return FL_CDB_NONE;
}

int fl_cdb_shape_of(fl_cdb_family family, int n, const int64_t *node)
{
    switch (family) {
    case FL_CDB_SOLID:
    case FL_CDB_BRICK: return brick_shape(n);
    case FL_CDB_TET:
        if (is_folded_brick(n, node)) return brick_shape(n);
        return n > 4 ? FL_TET10 : n == 4 ? FL_TET4 : -1;
    case FL_CDB_SHELL: return quad_shape(n);
    case FL_CDB_TRI: return n > 3 ? FL_TRI6 : n == 3 ? FL_TRI3 : -1;
    case FL_CDB_LINE: return n >= 2 ? FL_LINE2 : -1;
    case FL_CDB_CURVE: return n > 2 ? FL_LINE3 : n == 2 ? FL_LINE2 : -1;
    default: return -1;
    }
}
