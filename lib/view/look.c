/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#include "base/number_text.h"
#include "base/text.h"
#include "view/look.h"

const char *const fl_colour_by_name[FL_BYS + 1] = {"ice",       "one",    "speed",  "spin",  "diameter",
                                                   "thickness", "height", "number", "group", "force",
                                                   "damage",    "column", NULL};

static const char *const PROJECTION[] = {"perspective", "parallel", NULL};
static const char *const NO_YES[] = {"no", "yes", NULL};
static const char *const BACKGROUND[] = {"sky", "plain", NULL};
static const char *const AXIS[] = {"none", "x", "y", "z", NULL};
static const char *const SIDE[] = {"above", "below", NULL};

enum kind { NUMBER, WHOLE, CHOICE, COLOUR, WORD };

struct row {
    const char *key;
    enum kind kind;
    size_t at;
    int or_auto; /* a number that may be auto */
    double lo, hi;
    const char *const *choice;
    const char *meaning;
};

#define AT(member) offsetof(fl_look, member)
#define FAR 1e9

static const struct row ROW[] = {
    {"view.projection", CHOICE, AT(view.parallel), 0, 0, 0, PROJECTION,
     "perspective, or parallel without foreshortening"},
    {"view.azimuth", NUMBER, AT(view.azimuth), 0, -3600, 3600, NULL,
     "side on which the camera stands, from x towards y [deg]"},
    {"view.elevation", NUMBER, AT(view.elevation), 0, -90, 90, NULL,
     "height of the camera over the horizon [deg]"},
    {"view.distance", NUMBER, AT(view.distance), 1, 1e-6, FAR, NULL,
     "from the point looked at; auto: all is in view [m]"},
    {"view.at_x", NUMBER, AT(view.at_x), 1, -FAR, FAR, NULL,
     "the point looked at; auto: the middle of all [m]"},
    {"view.at_y", NUMBER, AT(view.at_y), 1, -FAR, FAR, NULL, "the same"},
    {"view.at_z", NUMBER, AT(view.at_z), 1, -FAR, FAR, NULL, "the same"},
    {"view.field", NUMBER, AT(view.field), 0, 1, 150, NULL, "vertical angle of view [deg]"},
    {"view.spin", NUMBER, AT(view.spin), 0, -3600, 3600, NULL,
     "turn of the camera about the vertical [deg/s]"},
    {"colour.by", CHOICE, AT(colour.by), 0, 0, 0, fl_colour_by_name,
     "ice, one, speed, spin, diameter, thickness, height, number, group, force, damage, column"},
    {"colour.map", CHOICE, AT(colour.map), 0, 0, 0, fl_colour_map_name,
     "viridis, cividis, magma, manual (blue to red), grey"},
    {"colour.from", NUMBER, AT(colour.from), 1, -1e300, 1e300, NULL, "value at the lower end of the bar"},
    {"colour.to", NUMBER, AT(colour.to), 1, -1e300, 1e300, NULL, "value at the upper end"},
    {"colour.column", WORD, AT(colour.column), 0, 0, 0, NULL, "column of --table, of colour.by = column"},
    {"ice.colour", COLOUR, AT(ice.colour), 0, 0, 0, NULL, "of colour.by = one"},
    {"ice.opacity", NUMBER, AT(ice.opacity), 0, 0, 1, NULL, "0 hides the ice"},
    {"structure.colour", COLOUR, AT(structure.colour), 0, 0, 0, NULL, "of the structure"},
    {"structure.opacity", NUMBER, AT(structure.opacity), 0, 0, 1, NULL, "0 hides the structure"},
    {"water.shown", CHOICE, AT(water.shown), 0, 0, 0, NO_YES, "yes or no"},
    {"water.level", NUMBER, AT(water.level), 0, -FAR, FAR, NULL, "still water [m]"},
    {"water.opacity", NUMBER, AT(water.opacity), 0, 0, 1, NULL, "how fast the water hides what is below it"},
    {"water.colour", COLOUR, AT(water.colour), 0, 0, 0, NULL, "of deep water"},
    {"background.kind", CHOICE, AT(background.kind), 0, 0, 0, BACKGROUND, "sky, or plain"},
    {"background.colour", COLOUR, AT(background.colour), 0, 0, 0, NULL, "of a plain background"},
    {"light.azimuth", NUMBER, AT(light.azimuth), 0, -3600, 3600, NULL, "side of the sun [deg]"},
    {"light.elevation", NUMBER, AT(light.elevation), 0, 5, 90, NULL, "height of the sun [deg]"},
    {"light.shadow", WHOLE, AT(light.shadow), 1, 0, 8192, NULL,
     "side of the shadow map [pixels], 0: no shadows"},
    {"light.occlusion", WHOLE, AT(light.occlusion), 1, 0, 32, NULL, "taps of ambient occlusion, 0: none"},
    {"cut.axis", CHOICE, AT(cut.axis), 0, 0, 0, AXIS, "normal of a cutting plane: none, x, y, z"},
    {"cut.at", NUMBER, AT(cut.at), 0, -FAR, FAR, NULL, "its place on that axis [m]"},
    {"cut.side", CHOICE, AT(cut.side), 0, 0, 0, SIDE, "what is taken away: above or below that place"},
    {"picture.width", WHOLE, AT(picture.width), 0, 16, 8192, NULL, "[pixels]"},
    {"picture.height", WHOLE, AT(picture.height), 0, 16, 8192, NULL, "[pixels]"},
    {"picture.samples", WHOLE, AT(picture.samples), 1, 1, 3, NULL,
     "along each side of a pixel; auto: 2, of films 1"},
    {"picture.smooth", CHOICE, AT(picture.smooth), 0, 0, 0, NO_YES,
     "smooth edges of a picture of one sample"},
    {"picture.legend", CHOICE, AT(picture.legend), 0, 0, 0, NO_YES, "the colour bar"},
    {"picture.time", CHOICE, AT(picture.time), 0, 0, 0, NO_YES, "the time"},
    {"picture.curve", CHOICE, AT(picture.curve), 0, 0, 0, NO_YES, "the load curve of --loads"},
    {"contacts.shown", CHOICE, AT(contacts.shown), 0, 0, 0, NO_YES,
     "the tubes of --contacts and the marks of --bonds"},
    {"contacts.thickness", NUMBER, AT(contacts.thickness), 1, 1e-9, FAR, NULL,
     "radius of a tube at the largest force [m]"},
    {"contacts.most", NUMBER, AT(contacts.most), 1, 1e-9, 1e300, NULL, "force of that radius [N]"},
};
enum { ROWS = (int)(sizeof ROW / sizeof ROW[0]) };

fl_look fl_look_defaults(void)
{
    return (fl_look){
        .view = {0, -125, 32, NAN, NAN, NAN, NAN, 32, 0},
        .colour = {FL_BY_ICE, FL_MAP_VIRIDIS, NAN, NAN, ""},
        .ice = {{{232, 240, 245}}, 1},
        .structure = {{{168, 163, 153}}, 1},
        .water = {1, 0, 1, {{8, 29, 42}}},
        .background = {0, {{255, 255, 255}}},
        .light = {143, 53, -1, -1},
        .cut = {0, 0, 0},
        .picture = {1280, 720, -1, 1, 1, 1, 1},
        .contacts = {NAN, NAN, 1},
    };
}

static void *member(fl_look *l, const struct row *r) { return (char *)l + r->at; }

static int set_value(fl_look *l, const struct row *r, const char *value)
{
    double x;
    const int is_auto = r->or_auto && strcmp(value, "auto") == 0;
    switch (r->kind) {
    case NUMBER:
        if (is_auto) x = NAN;
        else if (fl_number_f64(value, &x) || x < r->lo || x > r->hi) return -1;
        *(double *)member(l, r) = x;
        return 0;
    case WHOLE:
        if (is_auto) *(int32_t *)member(l, r) = -1;
        else return fl_number_i32(value, (int32_t)r->lo, (int32_t)r->hi, member(l, r));
        return 0;
    case CHOICE:
        for (int k = 0; r->choice[k]; k++)
            if (strcmp(value, r->choice[k]) == 0) {
                *(int *)member(l, r) = k;
                return 0;
            }
        return -1;
    case COLOUR: return fl_colour_read(value, member(l, r));
    case WORD:
        if (strlen(value) >= FL_LOOK_TEXT) return -1;
        memcpy(member(l, r), value, strlen(value) + 1);
        return 0;
    }
    return -1;
}

static void print_value(FILE *f, const fl_look *l, const struct row *r)
{
    const void *at = (const char *)l + r->at;
    char text[FL_NUMBER_LEN];
    double x;
    int k;
    int32_t n;
    switch (r->kind) {
    case NUMBER:
        memcpy(&x, at, sizeof x);
        fputs(isnan(x) ? "auto" : fl_number_text(x, text), f);
        break;
    case WHOLE:
        memcpy(&n, at, sizeof n);
        if (n < 0) fputs("auto", f);
        else fprintf(f, "%" PRId32, n);
        break;
    case CHOICE:
        memcpy(&k, at, sizeof k);
        fputs(r->choice[k], f);
        break;
    case COLOUR:
        fprintf(f, "%02x%02x%02x", ((const fl_rgb *)at)->c[0], ((const fl_rgb *)at)->c[1],
                ((const fl_rgb *)at)->c[2]);
        break;
    case WORD: fputs(at, f); break;
    }
}

static const char *expected(const struct row *r, char text[200])
{
    size_t n = 0;
    switch (r->kind) {
    case NUMBER:
    case WHOLE:
        snprintf(text, 200, "a %snumber from %g to %g%s", r->kind == WHOLE ? "whole " : "", r->lo, r->hi,
                 r->or_auto ? ", or auto" : "");
        break;
    case CHOICE:
        for (int k = 0; r->choice[k] && n < 180; k++)
            n += (size_t)snprintf(text + n, 200 - n, "%s%s",
                                  k == 0             ? ""
                                  : r->choice[k + 1] ? ", "
                                                     : " or ",
                                  r->choice[k]);
        break;
    case COLOUR: return "a colour as 3a7fb0, or 0.2,0.5,0.7";
    case WORD: return "a shorter word";
    }
    return text;
}

int fl_look_set(fl_look *l, const char *key, const char *value, const char *where, int code, fl_err *err)
{
    char text[200];
    const char *name[ROWS];
    for (int k = 0; k < ROWS; k++) {
        name[k] = ROW[k].key;
        if (strcmp(key, ROW[k].key) != 0) continue;
        if (set_value(l, &ROW[k], value) == 0) return 0;
        return fl_fail(err, code, "%s: %s is \"%.60s\", expected %s", where, key, value,
                       expected(&ROW[k], text));
    }
    return fl_fail(err, code, "%s: there is no setting \"%.60s\", the nearest is %s", where, key,
                   fl_text_nearest(key, name, ROWS));
}

static char *trim_blanks(char *s)
{
    while (*s == ' ' || *s == '\t') s++;
    size_t n = strlen(s);
    while (n && (s[n - 1] == ' ' || s[n - 1] == '\t' || s[n - 1] == '\r')) s[--n] = '\0';
    return s;
}

int fl_look_read(fl_look *l, const char *path, fl_err *err)
{
    fl_text in = {0};
    char section[64] = "", key[160], where[300];
    int rc = -1, more;
    if (fl_text_open(&in, path, err) || fl_text_magic(&in, "look", 1, err)) goto done;
    while ((more = fl_text_line(&in, err)) > 0) {
        char *hash = strchr(in.line, '#');
        if (hash) *hash = '\0';
        char *line = trim_blanks(in.line);
        if (!*line) continue;
        char *equals = strchr(line, '=');
        if (*line == '[' && line[strlen(line) - 1] == ']' && strlen(line) < sizeof section) {
            line[strlen(line) - 1] = '\0';
            memcpy(section, trim_blanks(line + 1), strlen(trim_blanks(line + 1)) + 1);
            continue;
        }
        if (!equals) {
            fl_text_fail(&in, err, "\"%.40s\" is neither [section] nor key = value", line);
            goto done;
        }
        *equals = '\0';
        snprintf(key, sizeof key, "%s%s%.60s", section, section[0] ? "." : "", trim_blanks(line));
        snprintf(where, sizeof where, "%.200s:%" PRId64, fl_in_name(in.in), in.line_number);
        if (fl_look_set(l, key, trim_blanks(equals + 1), where, FL_INPUT, err)) goto done;
    }
    rc = more < 0 ? -1 : 0;
done:
    fl_text_close(&in);
    return rc;
}

void fl_look_write(FILE *f, const fl_look *l)
{
    char last[32] = "";
    fputs("#look 1\n", f);
    for (int k = 0; k < ROWS; k++) {
        const char *dot = strchr(ROW[k].key, '.');
        const size_t n = (size_t)(dot - ROW[k].key);
        if (strncmp(last, ROW[k].key, n) != 0 || last[n]) {
            memcpy(last, ROW[k].key, n);
            last[n] = '\0';
            fprintf(f, "\n[%s]\n", last);
        }
        fprintf(f, "%s = ", dot + 1);
        print_value(f, l, &ROW[k]);
        putc('\n', f);
    }
}

void fl_look_explain(FILE *f)
{
    const fl_look l = fl_look_defaults();
    for (int k = 0; k < ROWS; k++) {
        fprintf(f, "%s = ", ROW[k].key);
        print_value(f, &l, &ROW[k]);
        fprintf(f, "\n    %s\n", ROW[k].meaning);
    }
}
