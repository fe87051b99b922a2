/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "view/picture_rgba.h"

int fl_picture_make(fl_picture *p, int w, int h, fl_err *err)
{
    unsigned char *px = fl_alloc((int64_t)w * h, 4, err);
    if (!px) return -1;
    *p = (fl_picture){px, w, h};
    return 0;
}

void fl_picture_free(fl_picture *p)
{
    free(p->px);
    *p = (fl_picture){0};
}

/* fminf and fmaxf are calls, which cost more than the rest of a pixel of a letter. */
static inline float low_of(float a, float b) { return a < b ? a : b; }
static inline float high_of(float a, float b) { return a > b ? a : b; }

static void blend(unsigned char *d, fl_rgb c, float a)
{
    for (int k = 0; k < 3; k++) d[k] = (unsigned char)lrintf((1.0f - a) * (float)d[k] + a * (float)c.c[k]);
    d[3] = (unsigned char)lrintf(255.0f * a + (1.0f - a) * (float)d[3]);
}

void fl_picture_plate(fl_picture *p, int x0, int y0, int x1, int y1, fl_rgb c, float a)
{
    for (int y = y0 < 0 ? 0 : y0; y < y1 && y < p->h; y++)
        for (int x = x0 < 0 ? 0 : x0; x < x1 && x < p->w; x++)
            blend(p->px + 4 * ((size_t)y * (size_t)p->w + (size_t)x), c, a);
}

/* Squared distance of a point from a segment. */
static float distance2(float px, float py, float ax, float ay, float bx, float by)
{
    const float dx = bx - ax, dy = by - ay, qx = px - ax, qy = py - ay, l = dx * dx + dy * dy;
    const float k = l > 0.0f ? high_of(0.0f, low_of(1.0f, (qx * dx + qy * dy) / l)) : 0.0f;
    const float ex = qx - k * dx, ey = qy - k * dy;
    return ex * ex + ey * ey;
}

void fl_picture_line(fl_picture *p, float x0, float y0, float x1, float y1, float width, fl_rgb c, float a)
{
    const float r = 0.5f * width;
    const int i0 = (int)high_of(0, low_of(x0, x1) - r - 1),
              i1 = (int)low_of((float)p->w - 1, high_of(x0, x1) + r + 1);
    const int j0 = (int)high_of(0, low_of(y0, y1) - r - 1),
              j1 = (int)low_of((float)p->h - 1, high_of(y0, y1) + r + 1);
    for (int j = j0; j <= j1; j++)
        for (int i = i0; i <= i1; i++) {
            const float d = sqrtf(distance2((float)i + 0.5f, (float)j + 0.5f, x0, y0, x1, y1));
            const float cover = high_of(0.0f, low_of(1.0f, r + 0.5f - d));
            if (cover > 0.0f) blend(p->px + 4 * ((size_t)j * (size_t)p->w + (size_t)i), c, a * cover);
        }
}

/* A glyph is polylines on a grid 4 wide: pairs of digits x y, a blank lifts the pen.  Baseline y = 2,
 * small letters up to 6, capitals up to 8, descenders down to 0. */
static const char *const GLYPH[128] = {['0'] = "120307183847433212",
                                       ['1'] = "062822 1232",
                                       ['2'] = "07183847460242",
                                       ['3'] = "07183847463515 354443321203",
                                       ['4'] = "32380444",
                                       ['5'] = "480805354443321203",
                                       ['6'] = "473818070312324344351504",
                                       ['7'] = "084812",
                                       ['8'] = "15060718384746351504031232434435",
                                       ['9'] = "031232434738180706153546",
                                       ['.'] = "2222",
                                       ['-'] = "0545",
                                       ['+'] = "0545 2327",
                                       ['/'] = "0248",
                                       ['['] = "38181232",
                                       [']'] = "18383212",
                                       ['('] = "38272332",
                                       [')'] = "18272312",
                                       [':'] = "2323 2626",
                                       [','] = "2211",
                                       ['='] = "0444 0646",
                                       ['_'] = "0141",
                                       ['*'] = "1545 1733 1337",
                                       ['<'] = "471543",
                                       ['>'] = "073503",
                                       ['|'] = "2802",
                                       ['\''] = "2826",
                                       ['?'] = "07183847462524 2222",
                                       ['%'] = "0248 0707 4343",
                                       ['A'] = "022842 1434",
                                       ['B'] = "02083847463505 3544433202",
                                       ['C'] = "4738180703123243",
                                       ['D'] = "02083847433202",
                                       ['E'] = "48080242 0535",
                                       ['F'] = "480802 0535",
                                       ['G'] = "47381807031232434525",
                                       ['H'] = "0208 4248 0545",
                                       ['I'] = "1838 2822 1232",
                                       ['J'] = "4843321203",
                                       ['K'] = "0802 480542",
                                       ['L'] = "080242",
                                       ['M'] = "0208254842",
                                       ['N'] = "02084248",
                                       ['O'] = "120307183847433212",
                                       ['P'] = "02083847463505",
                                       ['Q'] = "120307183847433212 2442",
                                       ['R'] = "02083847463505 2542",
                                       ['S'] = "473818070615354443321203",
                                       ['T'] = "0848 2822",
                                       ['U'] = "080312324348",
                                       ['V'] = "082248",
                                       ['W'] = "0812253248",
                                       ['X'] = "0248 0842",
                                       ['Y'] = "082548 2522",
                                       ['Z'] = "08480242",
                                       ['a'] = "4642 4536160503123243",
                                       ['b'] = "0802 0516364543321203",
                                       ['c'] = "4536160503123243",
                                       ['d'] = "4842 4536160503123243",
                                       ['e'] = "04444536160503123243",
                                       ['f'] = "38281712 0636",
                                       ['g'] = "4641301001 4536160503123243",
                                       ['h'] = "0802 0516364542",
                                       ['i'] = "2622 2828",
                                       ['j'] = "262110 2828",
                                       ['k'] = "0802 460442",
                                       ['l'] = "2822",
                                       ['m'] = "0602 05162522 25364542",
                                       ['n'] = "0602 0516364542",
                                       ['o'] = "120305163645433212",
                                       ['p'] = "0600 0516364543321203",
                                       ['q'] = "4640 4536160503123243",
                                       ['r'] = "0602 05163645",
                                       ['s'] = "45361605143443321203",
                                       ['t'] = "18132232 0636",
                                       ['u'] = "0603123243 4642",
                                       ['v'] = "062246",
                                       ['w'] = "0612243246",
                                       ['x'] = "0246 0642",
                                       ['y'] = "0622 4610",
                                       ['z'] = "06460242"};

static int is_narrow(char c) { return c != '\0' && strchr(".,:lij()[]|'", c) != NULL; }

static float advance_of(char c)
{
    if (c == ' ') return 3.2f;
    if (is_narrow(c)) return strchr("lij()[]", c) ? 3.4f : 3.2f;
    return strchr("tfr", c) ? 4.6f : 5.6f;
}

float fl_picture_text_width(const char *text, float h)
{
    float w = 0.0f;
    for (; *text; text++) w += advance_of(*text);
    return w * h / 6.0f;
}

/* Squared distance of a pixel from the strokes of a glyph whose origin is at x, y. */
static float glyph_distance2(const char *g, float x, float y, float unit, float px, float py)
{
    float best = 1e9f;
    while (*g) {
        const float ax = x + (float)(g[0] - '0') * unit, ay = y - (float)(g[1] - '2') * unit;
        g += 2;
        if (*g == '\0') break;
        if (*g == ' ') {
            g++;
            continue;
        }
        const float bx = x + (float)(g[0] - '0') * unit, by = y - (float)(g[1] - '2') * unit;
        best = low_of(best, distance2(px, py, ax, ay, bx, by));
    }
    return best;
}

void fl_picture_text(fl_picture *p, float x, float y, float h, const char *text, fl_rgb c)
{
    const float u = h / 6.0f, r = high_of(0.50f, 0.075f * h);
    for (; *text; x += advance_of(*text++) * u) {
        const char *g = (unsigned char)*text < 128 ? GLYPH[(unsigned char)*text] : NULL;
        const float left = x - (is_narrow(*text) ? u : 0.0f);
        if (!g) continue;
        for (int j = (int)high_of(0, y - 7 * u); j <= (int)(y + 3 * u) && j < p->h; j++)
            for (int i = (int)high_of(0, x - 2); i <= (int)(x + 5 * u + 2) && i < p->w; i++) {
                const float d = sqrtf(glyph_distance2(g, left, y, u, (float)i + 0.5f, (float)j + 0.5f));
                const float a = high_of(0.0f, low_of(1.0f, r + 0.5f - d));
                if (a > 0.0f) blend(p->px + 4 * ((size_t)j * (size_t)p->w + (size_t)i), c, a);
            }
    }
}

void fl_picture_flip(fl_picture *p)
{
    const size_t row = 4 * (size_t)p->w;
    for (int y = 0; y < p->h / 2; y++) {
        unsigned char *a = p->px + row * (size_t)y, *b = p->px + row * (size_t)(p->h - 1 - y);
        for (size_t k = 0; k < row; k++) {
            const unsigned char keep = a[k];
            a[k] = b[k];
            b[k] = keep;
        }
    }
}
