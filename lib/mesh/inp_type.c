/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include "mesh/inp_type.h"

enum { SOLID, FACE, LINE, MID_LINE };

/* The longest matching family counts: "STRI" before "S".  Line types are listed in full.  Media that are not
 * structure have none: acoustic (AC), flow (FC, DCC), Eulerian (EC), as in the other decks. */
static const struct {
    const char *family;
    int kind;
} FAMILY[] = {
    {"C3D", SOLID},        {"DC3D", SOLID},      {"Q3D", SOLID},       {"SC", SOLID},     {"S", FACE},
    {"STRI", FACE},        {"R3D", FACE},        {"M3D", FACE},        {"SFM3D", FACE},   {"DS", FACE},
    {"CPS", FACE},         {"CPE", FACE},        {"CPEG", FACE},       {"DC2D", FACE},    {"T3D2", LINE},
    {"T3D3", MID_LINE},    {"T2D2", LINE},       {"T2D3", MID_LINE},   {"B21", LINE},     {"B22", MID_LINE},
    {"B23", LINE},         {"B31", LINE},        {"B32", MID_LINE},    {"B33", LINE},     {"PIPE21", LINE},
    {"PIPE31", LINE},      {"PIPE22", MID_LINE}, {"PIPE32", MID_LINE}, {"ELBOW31", LINE}, {"FRAME2D", LINE},
    {"ELBOW32", MID_LINE}, {"FRAME3D", LINE},    {"RB3D2", LINE}};

/* By kind and the digits behind the family; STRI65 counts its six nodes and five degrees of freedom. */
static const struct {
    int kind, digits;
    fl_inp_type type;
} COUNT[] = {{SOLID, 4, {FL_TET4, 4, 0, 0}},      {SOLID, 5, {FL_PYRAMID5, 5, 0, 0}},
             {SOLID, 6, {FL_WEDGE6, 6, 0, 0}},    {SOLID, 8, {FL_HEX8, 8, 0, 0}},
             {SOLID, 10, {FL_TET10, 10, 0, 0}},   {SOLID, 13, {FL_PYRAMID13, 13, 0, 0}},
             {SOLID, 15, {FL_WEDGE15, 15, 3, 0}}, {SOLID, 20, {FL_HEX20, 20, 0, 0}},
             {SOLID, 27, {FL_HEX20, 20, 7, 0}},   {FACE, 3, {FL_TRI3, 3, 0, 0}},
             {FACE, 4, {FL_QUAD4, 4, 0, 0}},      {FACE, 6, {FL_TRI6, 6, 0, 0}},
             {FACE, 65, {FL_TRI6, 6, 0, 0}},      {FACE, 8, {FL_QUAD8, 8, 0, 0}},
             {FACE, 9, {FL_QUAD9, 9, 0, 0}},      {LINE, 0, {FL_LINE2, 2, 1, 0}},
             {MID_LINE, 0, {FL_LINE3, 3, 1, 1}}};

int fl_inp_type_of(const char *name, fl_inp_type *type)
{
    char s[24];
    size_t n = strlen(name), best = 0;
    int kind = -1, digits = 0;
    if (n >= sizeof s) return 0;
    for (size_t k = 0; k <= n; k++) s[k] = (char)toupper((unsigned char)name[k]);
    for (size_t k = 0; k < sizeof FAMILY / sizeof *FAMILY; k++) {
        const size_t len = strlen(FAMILY[k].family);
        if (len > best && strncmp(s, FAMILY[k].family, len) == 0) {
            best = len;
            kind = FAMILY[k].kind;
        }
    }
    if (kind < 0) return 0;
    if (kind == SOLID || kind == FACE) {
        const char *p = s + best;
        if (strspn(p, "0123456789") > 2) return 0;
        digits = atoi(p);
        p += strspn(p, "0123456789");
        if (p[strspn(p, "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789")] != '\0') return 0;
        /* SC4 is not a continuum shell */
        if (strncmp(s, "SC", 2) == 0 && digits != 6 && digits != 8) return 0;
    } else if (isdigit((unsigned char)s[best])) {
        return 0; /* B310 is not B31 */
    }
    for (size_t k = 0; k < sizeof COUNT / sizeof *COUNT; k++)
        if (COUNT[k].kind == kind && COUNT[k].digits == digits) {
            *type = COUNT[k].type;
            if (digits == 15 && !strchr(s + best, 'V')) type->optional = 0; /* C3D15V has three more */
            return 1;
        }
    return 0;
}
