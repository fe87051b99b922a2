/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/number_text.h"
#include "base/pi.h"
#include "stat/waterline.h"

/* Largest coordinate of a structure [m]; squares stay finite. */
static const double LARGEST = 1e9;

/* Parse the number that ends at the character end, or at the end of the text; *text advances behind it. */
static int parse_number(const char **text, char end, double *x)
{
    char word[40];
    const size_t len = strcspn(*text, ",:");
    if (len == 0 || len >= sizeof word || (*text)[len] != end) return -1;
    memcpy(word, *text, len);
    word[len] = '\0';
    *text += len + (end != '\0');
    return fl_number_f64(word, x) || fabs(*x) > LARGEST ? -1 : 0;
}

static int make_circle(fl_waterline *w, const char *text)
{
    w->circle = 1;
    if (parse_number(&text, ',', &w->x0) || parse_number(&text, ',', &w->y0) ||
        parse_number(&text, '\0', &w->r))
        return -1;
    w->length = 2.0 * PI * w->r;
    return w->r > 0.0 ? 0 : -1;
}

static int make_polyline(fl_waterline *w, const char *text)
{
    while (*text) {
        const int32_t k = w->n;
        if (k == FL_WATERLINE_MAX || parse_number(&text, ',', &w->x[k])) return -1;
        if (parse_number(&text, strchr(text, ':') ? ':' : '\0', &w->y[k])) return -1;
        if (k) {
            const double d = hypot(w->x[k] - w->x[k - 1], w->y[k] - w->y[k - 1]);
            if (!(d > 0.0)) return -1;
            w->length += d;
        }
        w->s[k] = w->length;
        w->n++;
    }
    return w->n > 1 ? 0 : -1;
}

int fl_waterline_make(fl_waterline *w, const char *text, fl_err *err)
{
    static const char word[] = "circle:";
    *w = (fl_waterline){0};
    const size_t len = strlen(text);
    const int colon = len && text[len - 1] == ':'; /* the last point is missing */
    const int bad = strncmp(text, word, sizeof word - 1) == 0 ? make_circle(w, text + sizeof word - 1)
                    : colon                                   ? -1
                                                              : make_polyline(w, text);
    if (!bad) return 0;
    return fl_fail(err, FL_USAGE, "\"%.80s\" is not a waterline, expected circle:X,Y,R or X,Y:X,Y:...", text);
}

double fl_waterline_nearest(const fl_waterline *w, double x, double y)
{
    if (w->circle) {
        const double angle = atan2(y - w->y0, x - w->x0);
        return fmin((angle < 0.0 ? angle + 2.0 * PI : angle) * w->r, w->length);
    }
    double least = INFINITY, at = 0.0;
    for (int32_t k = 0; k + 1 < w->n; k++) {
        const double ex = w->x[k + 1] - w->x[k], ey = w->y[k + 1] - w->y[k], len = w->s[k + 1] - w->s[k];
        const double u = ((x - w->x[k]) * ex + (y - w->y[k]) * ey) / (ex * ex + ey * ey);
        const double c = fmin(fmax(u, 0.0), 1.0);
        const double far = hypot(x - (w->x[k] + c * ex), y - (w->y[k] + c * ey));
        if (!(far < least)) continue;
        least = far;
        at = w->s[k] + c * len;
    }
    return at;
}

void fl_waterline_point(const fl_waterline *w, double s, double *x, double *y)
{
    if (w->circle) {
        *x = w->x0 + w->r * cos(s / w->r);
        *y = w->y0 + w->r * sin(s / w->r);
        return;
    }
    int32_t k = 0;
    while (k + 2 < w->n && s > w->s[k + 1]) k++;
    const double c = (s - w->s[k]) / (w->s[k + 1] - w->s[k]);
    *x = w->x[k] + c * (w->x[k + 1] - w->x[k]);
    *y = w->y[k] + c * (w->y[k + 1] - w->y[k]);
}
