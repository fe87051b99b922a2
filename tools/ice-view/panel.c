/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "panel.h"
#include <math.h>

static const fl_rgb PAPER = {{20, 32, 40}}, INK = {{236, 242, 246}}, EDGE = {{70, 92, 106}},
                    LIT = {{38, 98, 128}}, TRACK = {{110, 200, 235}};

static float scale_of(const fl_picture *p) { return fmaxf(0.8f, fminf(1.6f, (float)p->h / 720.0f)); }

int panel_height(const fl_picture *p) { return (int)(34 * scale_of(p)); }

void panel_begin(struct panel *u, int bottom)
{
    u->k = scale_of(u->p);
    u->at_x = 8 * u->k;
    u->at_y = (float)(u->p->h - bottom - panel_height(u->p));
    if (!u->held) u->taken = 0;
    fl_picture_plate(u->p, 0, (int)u->at_y, u->p->w, u->p->h - bottom, PAPER, 0.92f);
}

static int is_over(const struct panel *u, float x0, float x1)
{
    return (float)u->x >= x0 && (float)u->x < x1 && (float)u->y >= u->at_y &&
           (float)u->y < u->at_y + 34 * u->k;
}

int panel_button(struct panel *u, const char *label, int lit)
{
    const float cap = 9.5f * u->k, w = fl_picture_text_width(label, cap) + 16 * u->k, x0 = u->at_x,
                x1 = x0 + w;
    const float y0 = u->at_y + 5 * u->k, y1 = y0 + 24 * u->k;
    const int over = is_over(u, x0, x1), clicked = over && u->pressed;
    if (x1 > (float)u->p->w) return 0;
    fl_picture_plate(u->p, (int)x0, (int)y0, (int)x1, (int)y1, lit ? LIT : EDGE, over ? 0.95f : 0.6f);
    fl_picture_text(u->p, x0 + 8 * u->k, y1 - 8 * u->k, cap, label, INK);
    u->at_x = x1 + 6 * u->k;
    if (clicked) u->taken = 1;
    return clicked;
}

int panel_bar(struct panel *u, double *part, const char *label)
{
    const float cap = 9.5f * u->k, wide = fl_picture_text_width("t = 00000.00 s", cap);
    const float x0 = u->at_x + 8 * u->k, x1 = (float)u->p->w - wide - 18 * u->k, y = u->at_y + 17 * u->k;
    int dragged = 0;
    if (x1 - x0 < 20) return 0;
    if (u->pressed && is_over(u, x0 - 6 * u->k, x1 + 6 * u->k)) u->taken = 2;
    if (u->taken == 2 && u->held) {
        *part = fmax(0.0, fmin(1.0, ((double)u->x - x0) / (x1 - x0)));
        dragged = 1;
    }
    const float at = x0 + (float)*part * (x1 - x0);
    fl_picture_line(u->p, x0, y, x1, y, 3 * u->k, EDGE, 1.0f);
    fl_picture_line(u->p, x0, y, at, y, 3 * u->k, TRACK, 1.0f);
    fl_picture_line(u->p, at, y - 7 * u->k, at, y + 7 * u->k, 5 * u->k, INK, 1.0f);
    fl_picture_text(u->p, x1 + 12 * u->k, y + 4 * u->k, cap, label, INK);
    return dragged;
}
