/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include "view/colour_map.h"

enum { POINTS = 11, NUMBERS = 10 };

const char *const fl_colour_map_name[FL_MAPS + 1] = {"viridis", "cividis", "magma", "manual", "grey", NULL};

static const unsigned char MAP[FL_MAPS][POINTS][3] = {[FL_MAP_VIRIDIS] = {{68, 1, 84},
                                                                          {72, 36, 117},
                                                                          {65, 68, 135},
                                                                          {53, 95, 141},
                                                                          {42, 120, 142},
                                                                          {33, 145, 140},
                                                                          {34, 168, 132},
                                                                          {68, 191, 112},
                                                                          {122, 209, 81},
                                                                          {189, 223, 38},
                                                                          {253, 231, 37}},
                                                      [FL_MAP_CIVIDIS] = {{0, 34, 78},
                                                                          {8, 51, 112},
                                                                          {53, 69, 108},
                                                                          {79, 87, 108},
                                                                          {102, 105, 112},
                                                                          {125, 124, 120},
                                                                          {148, 142, 119},
                                                                          {174, 163, 113},
                                                                          {200, 184, 102},
                                                                          {229, 207, 82},
                                                                          {254, 232, 56}},
                                                      [FL_MAP_MAGMA] = {{0, 0, 4},
                                                                        {20, 14, 54},
                                                                        {59, 15, 112},
                                                                        {100, 26, 128},
                                                                        {140, 41, 129},
                                                                        {183, 55, 121},
                                                                        {222, 73, 104},
                                                                        {247, 112, 92},
                                                                        {254, 159, 109},
                                                                        {254, 207, 146},
                                                                        {252, 253, 191}},
                                                      [FL_MAP_MANUAL] = {{0, 0, 255},
                                                                         {0, 102, 255},
                                                                         {0, 204, 255},
                                                                         {0, 255, 204},
                                                                         {0, 255, 102},
                                                                         {0, 255, 0},
                                                                         {102, 255, 0},
                                                                         {204, 255, 0},
                                                                         {255, 204, 0},
                                                                         {255, 102, 0},
                                                                         {255, 0, 0}},
                                                      [FL_MAP_GREY] = {{40, 40, 40},
                                                                       {60, 60, 60},
                                                                       {80, 80, 80},
                                                                       {100, 100, 100},
                                                                       {120, 120, 120},
                                                                       {140, 140, 140},
                                                                       {160, 160, 160},
                                                                       {180, 180, 180},
                                                                       {200, 200, 200},
                                                                       {220, 220, 220},
                                                                       {240, 240, 240}}};

/* Okabe & Ito, Color Universal Design (2008), and two more. */
static const unsigned char NUMBER[NUMBERS][3] = {
    {86, 180, 233}, {230, 159, 0}, {0, 158, 115},   {240, 228, 66}, {204, 121, 167},
    {0, 114, 178},  {213, 94, 0},  {170, 170, 170}, {120, 94, 240}, {160, 200, 120}};

fl_rgb fl_colour_map_at(int map, double x)
{
    fl_rgb out = {{150, 150, 150}};
    if (isnan(x)) return out;
    x = (x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x) * (POINTS - 1);
    const int i = x >= POINTS - 1 ? POINTS - 2 : (int)x;
    for (int k = 0; k < 3; k++)
        out.c[k] = (unsigned char)lrint(MAP[map][i][k] + (x - i) * (MAP[map][i + 1][k] - MAP[map][i][k]));
    return out;
}

fl_rgb fl_colour_of_number(int32_t k)
{
    fl_rgb out;
    memcpy(out.c, NUMBER[((k % NUMBERS) + NUMBERS) % NUMBERS], 3);
    return out;
}

int fl_colour_read(const char *text, fl_rgb *c)
{
    unsigned u[3];
    double d[3];
    int end = 0;
    const char *hex = text + (*text == '#');
    if (strlen(hex) == 6 && strspn(hex, "0123456789abcdefABCDEF") == 6 &&
        sscanf(hex, "%2x%2x%2x", &u[0], &u[1], &u[2]) == 3) {
        for (int k = 0; k < 3; k++) c->c[k] = (unsigned char)u[k];
        return 0;
    }
    if (sscanf(text, "%lf , %lf , %lf %n", &d[0], &d[1], &d[2], &end) < 3 || text[end]) return -1;
    for (int k = 0; k < 3; k++) {
        if (!(d[k] >= 0.0 && d[k] <= 1.0)) return -1;
        c->c[k] = (unsigned char)lrint(255.0 * d[k]);
    }
    return 0;
}
