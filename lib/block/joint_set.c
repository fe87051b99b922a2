/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "block/joint_set.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/number_text.h"
#include "base/pi.h"
#include "base/rng.h"
#include "base/text.h"

/* Most planes on one side of the origin of a set. */
enum { PLANES_MAX = 1000000 };

/* --- reading ------------------------------------------------------------------------------------ */

static int fail_value(const char *where, const char *key, const char *value, const char *expected,
                      fl_err *err)
{
    return fl_fail(err, FL_INPUT, "%s: %s is \"%.60s\", expected %s", where, key, value, expected);
}

static int read_number(const char *value, double lo, double hi, double *x)
{
    return fl_number_f64(value, x) || !(*x >= lo && *x <= hi) ? -1 : 0;
}

static int read_origin(const char *value, fl_vec3 *x)
{
    char part[64];
    double at[3];
    for (int k = 0; k < 3; k++) {
        const size_t len = strcspn(value, ",");
        if (len == 0 || len >= sizeof part || (value[len] == ',') != (k < 2)) return -1;
        memcpy(part, value, len);
        part[len] = '\0';
        if (read_number(part, -1e9, 1e9, &at[k])) return -1;
        value += len + (k < 2);
    }
    *x = v3(at[0], at[1], at[2]);
    return 0;
}

/* The keys that are numbers. */
static const struct {
    const char *key;
    size_t at;
    double lo, hi;
    const char *expected;
} NUMBER[] = {
    {"dip", offsetof(fl_joint_set, dip), 0.0, 90.0, "an angle from 0 to 90 degrees"},
    {"dd", offsetof(fl_joint_set, direction), -360.0, 360.0, "an angle from -360 to 360 degrees"},
    {"spacing", offsetof(fl_joint_set, spacing), 1e-9, 1e9, "a length above 0"},
    {"persistence", offsetof(fl_joint_set, persistence), 0.0, 1.0, "a number from 0 to 1"},
    {"radius", offsetof(fl_joint_set, radius), 1e-9, 1e9, "a length above 0"},
    {"fisher", offsetof(fl_joint_set, fisher), 1.0, 1e12, "a concentration of at least 1"},
    {"deviation", offsetof(fl_joint_set, deviation), 0.0, 2.0, "a part of the mean from 0 to 2"},
};
enum { NUMBERS = sizeof NUMBER / sizeof *NUMBER };
static const char *const KEYS[] = {"dip",       "dd",     "spacing", "persistence", "radius", "fisher",
                                   "deviation", "origin", "n",       "meaning",     "law",    "name"};
enum { KEY_COUNT = sizeof KEYS / sizeof *KEYS };

static int is_name(const char *value)
{
    const size_t n = strlen(value);
    for (size_t k = 0; k < n; k++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.", value[k])) return 0;
    return n > 0 && n < FL_JOINT_NAME;
}

static int read_key(fl_joint_set *s, const char *key, const char *value, const char *where, fl_err *err)
{
    double x;
    for (int k = 0; k < NUMBERS; k++) {
        if (strcmp(key, NUMBER[k].key) != 0) continue;
        double *to = (double *)(void *)((char *)s + NUMBER[k].at);
        return read_number(value, NUMBER[k].lo, NUMBER[k].hi, to)
                   ? fail_value(where, key, value, NUMBER[k].expected, err)
                   : 0;
    }
    if (strcmp(key, "origin") == 0)
        return read_origin(value, &s->origin) ? fail_value(where, key, value, "X,Y,Z in metres", err) : 0;
    if (strcmp(key, "n") == 0) {
        if (read_number(value, 1.0, PLANES_MAX, &x) || x != floor(x))
            return fail_value(where, key, value, "a whole number above 0", err);
        s->number = (int32_t)x;
        return 0;
    }
    if (strcmp(key, "meaning") == 0) {
        s->meaning = strcmp(value, "glue") == 0 ? FL_PERSISTENCE_GLUE : FL_PERSISTENCE_SKIP;
        return strcmp(value, "glue") && strcmp(value, "skip")
                   ? fail_value(where, key, value, "skip or glue", err)
                   : 0;
    }
    if (strcmp(key, "law") == 0) {
        s->log_normal = strcmp(value, "log-normal") == 0;
        return strcmp(value, "normal") && !s->log_normal
                   ? fail_value(where, key, value, "normal or log-normal", err)
                   : 0;
    }
    if (strcmp(key, "name") == 0) {
        if (!is_name(value) || strcmp(value, "intact") == 0)
            return fail_value(where, key, value, "a word of letters, digits, _ - and . other than intact",
                              err);
        strcpy(s->name, value);
        return 0;
    }
    return fl_fail(err, FL_INPUT, "%s: unknown key \"%.40s\", the nearest is \"%s\"", where, key,
                   fl_text_nearest(key, KEYS, KEY_COUNT));
}

static int check_set(const fl_joint_sets *sets, const fl_joint_set *s, const char *where, fl_err *err)
{
    if (isnan(s->dip) || isnan(s->direction))
        return fl_fail(err, FL_INPUT, "%s: joint %s has no %s", where, s->name, isnan(s->dip) ? "dip" : "dd");
    if (s->spacing == 0.0 && s->number != 1)
        return fl_fail(err, FL_INPUT, "%s: joint %s has no spacing, and n=1 is not given", where, s->name);
    for (int32_t k = 0; k < sets->n; k++)
        if (strcmp(sets->set[k].name, s->name) == 0)
            return fl_fail(err, FL_INPUT, "%s: two joint sets have the name %s", where, s->name);
    return 0;
}

int fl_joint_sets_add(fl_joint_sets *sets, const char *text, const char *where, fl_err *err)
{
    fl_joint_set s = {.dip = NAN, .direction = NAN, .persistence = 1.0, .place = sets->n};
    char word[200];
    snprintf(s.name, sizeof s.name, "joint-%d", sets->n + 1);
    while (*(text += strspn(text, " \t"))) {
        const size_t len = strcspn(text, " \t");
        char *value;
        if (len >= sizeof word)
            return fl_fail(err, FL_INPUT, "%s: a word of %d bytes, key=value is expected", where, (int)len);
        memcpy(word, text, len);
        word[len] = '\0';
        text += len;
        value = strchr(word, '=');
        if (!value) return fl_fail(err, FL_INPUT, "%s: \"%.60s\" found, key=value is expected", where, word);
        *value++ = '\0';
        if (read_key(&s, word, value, where, err)) return -1;
    }
    if (check_set(sets, &s, where, err)) return -1;
    if (fl_grow(&sets->set, &sets->cap, (int64_t)sets->n + 1, sizeof *sets->set, err)) return -1;
    sets->set[sets->n++] = s;
    return 0;
}

int fl_joint_sets_read(fl_joint_sets *s, const char *path, fl_err *err)
{
    fl_text in = {0};
    int rc = -1, more;
    if (fl_text_open(&in, path, err)) return -1;
    if (fl_text_magic(&in, "joints", 1, err)) goto done;
    while ((more = fl_text_row(&in, err)) > 0) {
        char row[2000] = "", where[400];
        size_t n = 0;
        snprintf(where, sizeof where, "%.300s:%lld", path, (long long)in.line_number);
        for (int32_t k = 0; k < in.n; k++)
            n += (size_t)snprintf(row + n, n < sizeof row ? sizeof row - n : 0, "%s ", in.field[k]);
        if (n >= sizeof row) {
            fl_text_fail(&in, err, "a row of %d bytes, a joint set is expected", (int)n);
            goto done;
        }
        if (fl_joint_sets_add(s, row, where, err)) goto done;
    }
    rc = more < 0 ? -1 : 0;
done:
    fl_text_close(&in);
    return rc;
}

void fl_joint_sets_free(fl_joint_sets *s)
{
    free(s->set);
    *s = (fl_joint_sets){0};
}

static int in_order(double a, double b) { return (a > b) - (a < b); }

static int by_geometry(const void *a, const void *b)
{
    const fl_joint_set *s = a, *t = b;
    const double of[2][9] = {{s->dip, s->direction, s->spacing, s->origin.x, s->origin.y, s->origin.z,
                              s->number, s->persistence, s->radius},
                             {t->dip, t->direction, t->spacing, t->origin.x, t->origin.y, t->origin.z,
                              t->number, t->persistence, t->radius}};
    for (int k = 0; k < 9; k++)
        if (in_order(of[0][k], of[1][k])) return in_order(of[0][k], of[1][k]);
    return strcmp(s->name, t->name);
}

void fl_joint_sets_sort(fl_joint_sets *s)
{
    if (s->n > 1) qsort(s->set, (size_t)s->n, sizeof *s->set, by_geometry);
}

/* --- planes ------------------------------------------------------------------------------------- */

/* Sine of an angle in degrees, exact at multiples of 90. */
static double sin_degrees(double a)
{
    const double quarter = a / 90.0, whole = floor(quarter);
    if (quarter != whole) return sin(a * PI / 180.0);
    const int q = (int)(whole - 4.0 * floor(whole / 4.0));
    return q == 1 ? 1.0 : q == 3 ? -1.0 : 0.0;
}

fl_vec3 fl_joint_set_normal(const fl_joint_set *s)
{
    const double sd = sin_degrees(s->dip);
    return v3(sd * sin_degrees(s->direction), sd * sin_degrees(s->direction + 90.0),
              sin_degrees(s->dip + 90.0));
}

static fl_rng random_of(const fl_joint_set *s, int32_t set, int32_t k, uint64_t seed)
{
    (void)s;
    return fl_rng_of(seed, fl_rng_entity(set, k), FL_RNG_JOINT_PLANE);
}

/* The spacing between planes k - 1 and k, and the number of that gap for planes before the origin. */
static double gap_of(const fl_joint_set *s, int32_t set, int32_t k, uint64_t seed)
{
    fl_rng g = random_of(s, set, k, seed);
    if (!(s->deviation > 0.0)) return s->spacing;
    const double x = fl_rng_normal(&g);
    if (!s->log_normal) return s->spacing * fmax(1.0 + s->deviation * x, 0.05);
    const double var = log(1.0 + s->deviation * s->deviation);
    return s->spacing * exp(sqrt(var) * x - 0.5 * var);
}

static double offset_of(const fl_joint_set *s, int32_t set, int32_t k, uint64_t seed)
{
    double sum = 0.0;
    if (!(s->deviation > 0.0)) return k * s->spacing;
    for (int32_t i = 1; i <= k; i++) sum += gap_of(s, set, i, seed);
    for (int32_t i = 0; i > k; i--) sum -= gap_of(s, set, i, seed);
    return sum;
}

/* A direction of Fisher's law about n: 1 - cos t = -log(1 - u (1 - exp(-2 K)))/K. */
static fl_vec3 scatter_normal(const fl_joint_set *s, int32_t set, int32_t k, uint64_t seed, fl_vec3 n)
{
    fl_rng g = random_of(s, set, k, seed);
    (void)fl_rng_normal(&g); /* that of the spacing */
    const double u = fl_rng_unit(&g), angle = 2.0 * PI * fl_rng_unit(&g);
    const double fall = -log(1.0 - u * (1.0 - exp(-2.0 * s->fisher))) / s->fisher, cosine = 1.0 - fall,
                 sine = sqrt(fmax(0.0, fall * (2.0 - fall)));
    const fl_vec3 a = v3_normal_to(n), b = v3_cross(n, a);
    return v3_unit(v3_madd(v3_madd(v3_scale(cosine, n), sine * cos(angle), a), sine * sin(angle), b));
}

fl_joint_plane fl_joint_set_plane(const fl_joint_set *s, int32_t set, int32_t k, uint64_t seed)
{
    const fl_vec3 n = fl_joint_set_normal(s);
    const double offset = offset_of(s, set, k, seed);
    if (!(s->fisher > 0.0)) return (fl_joint_plane){n, v3_dot(n, s->origin) + offset, set, k};
    const fl_vec3 m = scatter_normal(s, set, k, seed, n);
    return (fl_joint_plane){m, v3_dot(m, v3_madd(s->origin, offset, n)), set, k};
}

void fl_joint_set_range(const fl_joint_set *s, int32_t set, fl_aabb box, uint64_t seed, int32_t *first,
                        int32_t *last)
{
    const fl_vec3 n = fl_joint_set_normal(s), mid = v3_scale(0.5, v3_add(box.lo, box.hi)),
                  half = v3_sub(box.hi, mid);
    const double at = v3_dot(n, v3_sub(mid, s->origin)), extent = v3_norm(half),
                 reach = s->fisher > 0.0 ? 3.0 * extent
                                         : fabs(n.x) * half.x + fabs(n.y) * half.y + fabs(n.z) * half.z;
    *first = 0;
    *last = s->number - 1;
    if (s->number) return;
    if (!(s->deviation > 0.0)) {
        *first = (int32_t)fmax(ceil((at - reach) / s->spacing - 1e-6), -PLANES_MAX);
        *last = (int32_t)fmin(floor((at + reach) / s->spacing + 1e-6), PLANES_MAX);
        return;
    }
    double sum = 0.0;
    int32_t k = 0;
    while (sum < at + reach && k < PLANES_MAX) sum += gap_of(s, set, ++k, seed);
    *last = k;
    for (sum = 0.0, k = 0; sum > at - reach && k > -PLANES_MAX; k--) sum -= gap_of(s, set, k, seed);
    *first = k;
}
