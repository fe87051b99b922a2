/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "view/legend.h"

static const fl_rgb PAPER = {{20, 32, 40}}, INK = {{236, 242, 246}}, LINE = {{110, 200, 235}},
                    CURSOR = {{255, 180, 84}};
#define PAPER_OPACITY 0.72f
enum { TICKS = 4, NAMES_MAX = 12 };

/* Pixels of a picture of 720 rows; smaller pictures shrink less, so that letters stay legible. */
static float scale_of(const fl_picture *p)
{
    return fmaxf(0.72f, (float)p->h / 720.0f) * fminf(1.0f, (float)p->w / 480.0f);
}

/* Fewest digits that tell the ticks of a bar apart. */
static int digits_of(double from, double to)
{
    const double step = fabs(to - from) / TICKS, big = fmax(fabs(from), fabs(to));
    if (!(step > 0.0) || big >= 1e5 || big < 1e-3) return -1;
    for (int d = 0; d < 6; d++) {
        const double k = step * pow(10.0, d), r = from * pow(10.0, d);
        if (fabs(k - round(k)) < 0.02 * k && fabs(r - round(r)) < 0.02) return d;
    }
    const int d = (int)ceil(1.0 - log10(step));
    return d < 0 ? 0 : d > 6 ? 6 : d;
}

static void tick_text(double value, int digits, char text[40])
{
    if (digits < 0) snprintf(text, 40, "%.2g", value);
    else snprintf(text, 40, "%.*f", digits, value);
}

void fl_legend_bar(fl_picture *p, const char *title, int map, double from, double to, int bottom)
{
    const float k = scale_of(p), cap = 11.5f * k, small = 0.85f * cap;
    const int wide = (int)fmaxf(260 * k, fl_picture_text_width(title, cap)), high = (int)(14 * k),
              d = digits_of(from, to);
    const int x0 = p->w - wide - (int)(40 * k), y0 = p->h - bottom - (int)(62 * k);
    char text[40];
    tick_text(from, d, text);
    const float first = 0.5f * fl_picture_text_width(text, small) + 8 * k;
    fl_picture_plate(p, x0 - (int)fmaxf(22 * k, first), y0 - (int)(38 * k), x0 + wide + (int)(24 * k),
                     y0 + (int)(46 * k), PAPER, PAPER_OPACITY);
    for (int i = 0; i < wide; i++)
        fl_picture_plate(p, x0 + i, y0, x0 + i + 1, y0 + high, fl_colour_map_at(map, (double)i / (wide - 1)),
                         1.0f);
    for (int i = 0; i <= TICKS; i++) {
        const int x = x0 + i * (wide - 1) / TICKS;
        const double value = from + (to - from) * i / TICKS;
        fl_picture_plate(p, x, y0 + high, x + (k > 1.4f ? 2 : 1), y0 + high + (int)(5 * k), INK, 1.0f);
        tick_text(value, d, text);
        fl_picture_text(p, (float)x - 0.5f * fl_picture_text_width(text, small), (float)(y0 + high) + 20 * k,
                        small, text, INK);
    }
    fl_picture_text(p, (float)x0, (float)y0 - 12 * k, cap, title, INK);
}

void fl_legend_names(fl_picture *p, const char *const *name, int n, int bottom)
{
    const float k = scale_of(p), cap = 10.5f * k, row = 20 * k;
    const int shown = n < NAMES_MAX ? n : NAMES_MAX;
    float wide = 0.0f;
    for (int i = 0; i < shown; i++) wide = fmaxf(wide, fl_picture_text_width(name[i], cap));
    const int x0 = p->w - (int)(wide + 62 * k), y0 = p->h - bottom - (int)(row * (float)shown + 26 * k);
    fl_picture_plate(p, x0, y0, p->w - (int)(16 * k), p->h - bottom - (int)(16 * k), PAPER, PAPER_OPACITY);
    for (int i = 0; i < shown; i++) {
        const float y = (float)y0 + row * (float)(i + 1);
        fl_picture_plate(p, x0 + (int)(10 * k), (int)(y - 10 * k), x0 + (int)(24 * k), (int)(y + 1 * k),
                         fl_colour_of_number(i), 1.0f);
        fl_picture_text(p, (float)x0 + 32 * k, y, cap, name[i], INK);
    }
}

static void plate_of_text(fl_picture *p, const char *text, float x, float base)
{
    const float k = scale_of(p), cap = 11.5f * k;
    fl_picture_plate(p, (int)x, (int)(base - 21 * k), (int)(x + fl_picture_text_width(text, cap) + 22 * k),
                     (int)(base + 9 * k), PAPER, PAPER_OPACITY);
    fl_picture_text(p, x + 12 * k, base, cap, text, INK);
}

void fl_legend_time(fl_picture *p, double t, int bottom)
{
    const float k = scale_of(p);
    char text[48];
    snprintf(text, sizeof text, fabs(t) < 1e5 ? "t = %.*f s" : "t = %.*e s", fabs(t) < 10.0 ? 2 : 1, t);
    plate_of_text(p, text, 18 * k, (float)(p->h - bottom) - 25 * k);
}

void fl_legend_note(fl_picture *p, const char *text)
{
    const float k = scale_of(p);
    plate_of_text(p, text, 18 * k, 39 * k);
}

int fl_legend_curve_height(const fl_picture *p) { return (int)(96 * scale_of(p)); }

/* A number with k or M before its unit: "123 k". */
static void short_number(double x, char text[32])
{
    const double a = fabs(x);
    if (a >= 1e6) snprintf(text, 32, "%.3g M", x / 1e6);
    else if (a >= 1e3) snprintf(text, 32, "%.3g k", x / 1e3);
    else snprintf(text, 32, "%.3g ", x);
}

void fl_legend_curve(fl_picture *p, const fl_curve *c, int high, double t)
{
    const float k = scale_of(p), cap = 9.5f * k;
    const int top = p->h - high, left = (int)(96 * k), right = p->w - (int)(18 * k);
    double lo = 0.0, hi = 0.0;
    char text[64], number[32];
    if (right - left < 16) return;
    for (int64_t i = 0; i < c->n; i++) {
        if (c->t[i] < c->t0 || c->t[i] > c->t1) continue;
        lo = fmin(lo, c->y[i]);
        hi = fmax(hi, c->y[i]);
    }
    if (lo > -1e-3 * hi) lo = 0.0;
    if (hi < -1e-3 * lo) hi = 0.0;
    if (!(hi > lo)) hi = lo + 1.0;
    fl_picture_plate(p, 0, top, p->w, p->h, PAPER, 1.0f);
    const float y0 = (float)p->h - 20 * k, y1 = (float)top + 10 * k;
    const double fy = (y0 - y1) / (hi - lo), fx = c->t1 > c->t0 ? (right - left) / (c->t1 - c->t0) : 0.0;
    const float zero = y0 - (float)((0.0 - lo) * fy);
    fl_picture_line(p, (float)left, zero, (float)right, zero, 1.0f, INK, 0.35f);
    int64_t i = 0, n = 0;
    while (i < c->n && c->t[i] < c->t0) i++;
    while (i + n < c->n && c->t[i + n] <= c->t1) n++;
    if (n < right - left) { /* few points: joined by lines */
        for (int64_t e = i + 1; e < i + n; e++)
            fl_picture_line(p, (float)left + (float)((c->t[e - 1] - c->t0) * fx),
                            y0 - (float)((c->y[e - 1] - lo) * fy),
                            (float)left + (float)((c->t[e] - c->t0) * fx), y0 - (float)((c->y[e] - lo) * fy),
                            fmaxf(1.0f, 1.2f * k), LINE, 0.9f);
        i = c->n;
    }
    /* Many: for each column the least and the largest value in it, joined to the column before. */
    float last = NAN;
    for (int x = left; x < right && i < c->n; x++) {
        const double until = c->t0 + (x + 1 - left) / fx;
        double a = INFINITY, b = -INFINITY;
        for (; i < c->n && c->t[i] <= until; i++) {
            a = fmin(a, c->y[i]);
            b = fmax(b, c->y[i]);
        }
        if (!(a <= b)) continue;
        float ya = y0 - (float)((a - lo) * fy), yb = y0 - (float)((b - lo) * fy);
        if (!isnan(last)) {
            ya = fmaxf(ya, last);
            yb = fminf(yb, last);
        }
        fl_picture_line(p, (float)x + 0.5f, ya, (float)x + 0.5f, yb, fmaxf(1.0f, 1.2f * k), LINE, 0.9f);
        last = 0.5f * (ya + yb);
    }
    for (int m = 0; m < 2; m++) {
        short_number(m ? hi : lo, number);
        snprintf(text, sizeof text, "%sN", number);
        fl_picture_text(p, (float)left - fl_picture_text_width(text, cap) - 8 * k, m ? y1 + cap : y0, cap,
                        text, INK);
    }
    fl_picture_text(p, 12 * k, 0.5f * (y0 + y1) + 0.5f * cap, cap, c->title, INK);
    for (int m = 0; m <= TICKS; m++) {
        snprintf(text, sizeof text, m < TICKS ? "%g" : "%g s", c->t0 + (c->t1 - c->t0) * m / TICKS);
        const float x = (float)left + (float)(right - left) * (float)m / TICKS,
                    w = fl_picture_text_width(text, cap);
        fl_picture_text(p, fminf(x - 0.5f * w, (float)p->w - w - 4 * k), (float)p->h - 6 * k, cap, text, INK);
    }
    const float x = (float)left + (float)((fmax(c->t0, fmin(c->t1, t)) - c->t0) * fx);
    fl_picture_line(p, x, (float)top + 4 * k, x, y0, 1.6f * k, CURSOR, 1.0f);
}
