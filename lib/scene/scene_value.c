/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/number_text.h"
#include "base/text.h"
#include "scene/scene_value.h"

static const char *const fix_word[] = {"x", "y", "z", "rx", "ry", "rz"};
enum { N_FIX = 6, LINE_COPY = 256 };

/* Where an error message about a key is written; the key stands before the sentence. */
typedef struct {
    const fl_key *key;
    char *why;
    size_t size;
} message;

static int fail_key(const message *c, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
static int fail_key(const message *c, const char *fmt, ...)
{
    const char *section = fl_section_table[c->key->section].name;
    const int k = snprintf(c->why, c->size, "%s.%s ", section, c->key->key);
    va_list ap;
    va_start(ap, fmt);
    if (k > 0 && (size_t)k < c->size) vsnprintf(c->why + k, c->size - (size_t)k, fmt, ap);
    va_end(ap);
    return -1;
}

/* Parse an interval "(0,1]": its ends, and whether they belong to it. */
static void parse_interval(const char *range, double *lo, double *hi, int *lo_in, int *hi_in)
{
    char *end;
    *lo_in = range[0] == '[';
    *lo = strtod(range + 1, &end);
    *hi = strtod(end + 1, &end);
    *hi_in = *end == ']';
}

char *fl_value_range(const fl_key *key, char *buf, size_t size)
{
    char low[FL_NUMBER_LEN], high[FL_NUMBER_LEN];
    double lo, hi;
    int lo_in, hi_in;
    buf[0] = '\0';
    if (!key->range) return buf;
    parse_interval(key->range, &lo, &hi, &lo_in, &hi_in);
    fl_number_text(lo, low);
    fl_number_text(hi, high);
    if (isinf(hi)) snprintf(buf, size, "%s %s", lo_in ? "at least" : "above", low);
    else
        snprintf(buf, size, "%s %s and %s %s", lo_in ? "at least" : "above", low, hi_in ? "at most" : "below",
                 high);
    return buf;
}

static int is_in_range(const fl_key *key, double x)
{
    double lo, hi;
    int lo_in, hi_in;
    if (!key->range) return 1;
    parse_interval(key->range, &lo, &hi, &lo_in, &hi_in);
    return (lo_in ? x >= lo : x > lo) && (hi_in ? x <= hi : x < hi);
}

static int fail_range(const message *c, const char *text)
{
    char range[100];
    const char *si = fl_unit_si(c->key->unit);
    return fail_key(c, "is %.60s, a value %s%s%s is expected", text,
                    fl_value_range(c->key, range, sizeof range), si[0] ? " " : "", si);
}

/* Word k of "a|b|c" and its length; NULL if there are fewer. */
static const char *choice_at(const char *choices, int k, size_t *len)
{
    for (; k > 0; k--) {
        choices += strcspn(choices, "|");
        if (*choices++ == '\0') return NULL;
    }
    *len = strcspn(choices, "|");
    return choices;
}

/* Index of a word among the choices, -1 if it is none. */
static int find_choice(const char *choices, const char *text)
{
    const char *word;
    size_t len;
    for (int k = 0; (word = choice_at(choices, k, &len)) != NULL; k++)
        if (strlen(text) == len && strncmp(word, text, len) == 0) return k;
    return -1;
}

/* Names all choices, and the nearest if there is memory to find it. */
static int fail_choice(const message *c, const char *text)
{
    const char *choices = c->key->choices;
    const size_t size = strlen(choices) + 1;
    char *const all = malloc(size), *const cut = malloc(size);
    int n = 1, rc;
    for (const char *p = choices; *p; p++) n += *p == '|';
    const char **const list = malloc((size_t)n * sizeof *list);
    if (all && cut && list) {
        for (size_t k = 0; k < size; k++) {
            all[k] = choices[k] == '|' ? ' ' : choices[k];
            cut[k] = choices[k] == '|' ? '\0' : choices[k];
        }
        for (int k = 0; k < n; k++) list[k] = k ? list[k - 1] + strlen(list[k - 1]) + 1 : cut;
        rc = fail_key(c, "is \"%.60s\", one of %s is expected, nearest is %s", text, all,
                      fl_text_nearest(text, list, n));
    } else rc = fail_key(c, "is \"%.60s\", one of %s is expected", text, choices);
    free(all), free(cut), free(list);
    return rc;
}

static int read_word(const message *c, const char *text, int32_t *out)
{
    const char *choices = c->key->choices;
    if (strncmp(choices, "false|", 6) == 0) { /* a switch; the manual writes 0 and 1 */
        if (!strcmp(text, "0") || !strcmp(text, "no") || !strcmp(text, "off")) text = "false";
        if (!strcmp(text, "1") || !strcmp(text, "yes") || !strcmp(text, "on")) text = "true";
    }
    const int k = find_choice(choices, text);
    if (k < 0) return fail_choice(c, text);
    *out = k;
    return 0;
}

/* One word for x, y and z, or three words. */
static int read_words(const message *c, const char *text, int32_t out[3])
{
    char copy[LINE_COPY], *save = NULL;
    int32_t got[3] = {0};
    int n = 0;
    snprintf(copy, sizeof copy, "%s", text);
    for (char *t = strtok_r(copy, " \t", &save); t; t = strtok_r(NULL, " \t", &save)) {
        if (n == 3) n = 4;
        if (n == 4) break;
        if (read_word(c, t, &got[n++])) return -1;
    }
    if (n != 1 && n != 3)
        return fail_key(c, "is \"%.60s\", one word or three, for x, y and z, are expected", text);
    for (int k = 0; k < 3; k++) out[k] = got[n == 1 ? 0 : k];
    return 0;
}

/* Length of the number at the start of s, 0 if there is none. */
static size_t number_length(const char *s)
{
    size_t k = s[0] == '+' || s[0] == '-', digits, tail;
    digits = strspn(s + k, "0123456789");
    k += digits;
    if (s[k] == '.') {
        tail = strspn(s + k + 1, "0123456789");
        digits += tail;
        k += 1 + tail;
    }
    if (digits == 0) return 0;
    if (s[k] == 'e' || s[k] == 'E') { /* an exponent has digits; "5 eV" has none */
        const size_t sign = s[k + 1] == '+' || s[k + 1] == '-';
        tail = strspn(s + k + 1 + sign, "0123456789");
        if (tail) k += 1 + sign + tail;
    }
    return k;
}

static int fail_number(const message *c, const char *text)
{
    const size_t first = number_length(text), blank = strspn(text + first, " \t/,");
    if (c->key->one_number && first && blank && number_length(text + first + blank))
        return fail_key(c, "is \"%.60s\", one number is expected: %s", text, c->key->one_number);
    const fl_key *key = c->key;
    const char *count = key->type == FL_VALUE_F64 ? "a number"
                        : key->single             ? "one number or three"
                                                  : "three numbers";
    const char *are = key->type == FL_VALUE_F64 ? "is" : "are";
    char list[100];
    if (strchr(text, ','))
        return fail_key(c, "is \"%.60s\", a decimal point and blanks are expected, not a comma", text);
    if (key->unit == FL_UNIT_ONE) return fail_key(c, "is \"%.60s\", %s %s expected", text, count, are);
    return fail_key(c, "is \"%.60s\", %s in %s %s expected (units: %s)", text, count, fl_unit_si(key->unit),
                    are, fl_unit_list(key->unit, list, sizeof list));
}

/* Convert the numbers x[from .. n) from the unit to SI. */
static int apply_unit(const message *c, const char *unit, double *x, const int *special, int from, int n)
{
    const enum fl_unit_kind kind = c->key->unit;
    char list[100];
    for (int k = from; k < n; k++)
        if (!special[k] && fl_unit_convert(kind, unit, &x[k]))
            return fail_key(c, "has the unit \"%.20s\", %s%s is expected", unit,
                            kind == FL_UNIT_ONE ? "none or " : "one of ",
                            fl_unit_list(kind, list, sizeof list));
    return 0;
}

/* Parse numbers with units.  A unit applies to the preceding numbers without a unit: "1 2 3 mm", "-5m 0 2
 * km". Returns the count of numbers, or -1. */
static int read_numbers(const message *c, const char *text, double *x)
{
    const fl_key *key = c->key;
    const int want = key->type == FL_VALUE_F64 ? 1 : 3;
    char copy[LINE_COPY], *save = NULL;
    int n = 0, bare = 0, special[3] = {0}; /* bare: first number without a unit */
    if (strlen(text) >= sizeof copy || strchr(text, ',')) return fail_number(c, text);
    memcpy(copy, text, strlen(text) + 1);
    for (char *t = strtok_r(copy, " \t", &save); t; t = strtok_r(NULL, " \t", &save)) {
        const size_t len = number_length(t);
        char unit[LINE_COPY], *end;
        if (len == 0 && key->special && strcmp(t, key->special) == 0) {
            if (n == want) return fail_number(c, text);
            special[n] = 1;
            x[n++] = key->special_value;
            continue;
        }
        snprintf(unit, sizeof unit, "%s", t + len);
        if (len) {
            if (n == want) return fail_number(c, text);
            x[n] = strtod(t, &end) + 0.0; /* -0 becomes 0, as it prints */
            if (end < t + len || !isfinite(x[n])) return fail_number(c, text);
            n++;
        } else if (bare == n) { /* there is no number for this unit */
            return fail_number(c, text);
        }
        if (unit[0]) {
            if (apply_unit(c, unit, x, special, bare, n)) return -1;
            bare = n;
        }
    }
    if (n != want && !(n == 1 && key->single)) return fail_number(c, text);
    for (int k = 0; k < n; k++) {
        if (special[k]) continue;
        if (!isfinite(x[k])) return fail_number(c, text);
        if (want == 1 && !is_in_range(key, x[k])) return fail_range(c, text);
    }
    return n;
}

static int read_f64(const message *c, const char *text, double *out)
{
    double x[3];
    if (read_numbers(c, text, x) < 0) return -1;
    if (c->key->choices) {
        const char *word;
        size_t len;
        int found = 0;
        for (int k = 0; (word = choice_at(c->key->choices, k, &len)) != NULL; k++)
            found |= strtod(word, NULL) == x[0];
        if (!found) return fail_choice(c, text);
    }
    *out = x[0];
    return 0;
}

static int read_vec3(const message *c, const char *text, fl_vec3 *out)
{
    double x[3];
    const int n = read_numbers(c, text, x);
    if (n < 0) return -1;
    if (n == 3) *out = v3(x[0], x[1], x[2]);
    else if (c->key->single == FL_SINGLE_X) *out = v3(x[0], 0, 0);
    else if (c->key->single == FL_SINGLE_ALL) *out = v3(x[0], x[0], x[0]);
    else if (x[0] >= 0.0) *out = v3(0, 0, 0.0 - x[0]); /* 0 of 0 */
    else
        return fail_key(c,
                        "is %.60s: one number is the size of a downward vector and cannot be negative, three "
                        "give another direction",
                        text);
    return 0;
}

static int read_i32(const message *c, const char *text, int32_t *out)
{
    double lo, hi;
    int lo_in, hi_in;
    parse_interval(c->key->range, &lo, &hi, &lo_in, &hi_in);
    if (c->key->special && strcmp(text, c->key->special) == 0) *out = (int32_t)c->key->special_value;
    else if (fl_number_i32(text, (int32_t)lo, (int32_t)hi, out))
        return fail_key(c, "is \"%.60s\", a whole number from %d to %d is expected", text, (int)lo, (int)hi);
    return 0;
}

static int read_fixed(const message *c, const char *text, uint32_t *out)
{
    char copy[LINE_COPY], *save = NULL;
    uint32_t bits = 0;
    int bad = strlen(text) >= sizeof copy;
    if (strcmp(text, c->key->special) == 0) {
        *out = 0;
        return 0;
    }
    snprintf(copy, sizeof copy, "%s", text);
    for (char *t = strtok_r(copy, " \t", &save); t && !bad; t = strtok_r(NULL, " \t", &save)) {
        int k = 0;
        while (k < N_FIX && strcmp(t, fix_word[k]) != 0) k++;
        bad = k == N_FIX || (bits >> k & 1u);
        if (!bad) bits |= 1u << k;
    }
    if (bad) return fail_key(c, "is \"%.60s\", none or some of x y z rx ry rz, each once, is expected", text);
    *out = bits;
    return 0;
}

static int read_name(const message *c, const char *text, char *out)
{
    if (c->key->special && strcmp(text, c->key->special) == 0) {
        out[0] = '\0';
        return 0;
    }
    if (!fl_value_is_name(text))
        return fail_key(
            c, "is \"%.60s\", a name of letters, digits, _ + - and at most %d characters is expected", text,
            FL_SCENE_NAME - 1);
    memcpy(out, text, strlen(text) + 1);
    return 0;
}

static int read_path(const message *c, const char *text, const char *folder, char *out)
{
    const char *joint = "";
    if (strcmp(text, c->key->special) == 0) {
        out[0] = '\0';
        return 0;
    }
    for (const char *p = text; *p; p++)
        if (iscntrl((unsigned char)*p) || ((*p == '#' || *p == ';') && (p == text || p[-1] == ' ')))
            return fail_key(c, "is \"%.60s\", a path without control characters and comments is expected",
                            text);
    if (text[0] == '/' || strcmp(text, "-") == 0) folder = "";
    else if (folder[0] && folder[strlen(folder) - 1] != '/') joint = "/";
    char path[FL_SCENE_PATH];
    const int n = snprintf(path, sizeof path, "%s%s%s", folder, joint, text);
    if (n >= FL_SCENE_PATH)
        return fail_key(c, "is a path of %d characters, at most %d are expected", n, FL_SCENE_PATH - 1);
    memcpy(out, path, (size_t)n + 1);
    return 0;
}

int fl_value_is_name(const char *s)
{
    static const char ok[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_+-";
    const size_t len = strlen(s);
    return len > 0 && len < FL_SCENE_NAME && strspn(s, ok) == len;
}

int fl_value_read(const fl_key *key, const char *text, const char *folder, void *section, char *why,
                  size_t why_size)
{
    const message c = {key, why, why_size};
    void *at = (char *)section + key->offset;
    if (text[0] == '\0') return fail_key(&c, "has no value");
    switch (key->type) {
    case FL_VALUE_F64: return read_f64(&c, text, at);
    case FL_VALUE_VEC3: return read_vec3(&c, text, at);
    case FL_VALUE_I32: return read_i32(&c, text, at);
    case FL_VALUE_WORD: return read_word(&c, text, at);
    case FL_VALUE_WORDS: return read_words(&c, text, at);
    case FL_VALUE_FIXED: return read_fixed(&c, text, at);
    case FL_VALUE_NAME: return read_name(&c, text, at);
    case FL_VALUE_PATH: break;
    }
    return read_path(&c, text, folder, at);
}

static int number_text(const fl_key *key, double x, char *buf, size_t size)
{
    char num[FL_NUMBER_LEN];
    if (key->special && x == key->special_value) return snprintf(buf, size, "%s", key->special);
    return snprintf(buf, size, "%s", fl_number_text(x, num));
}

char *fl_value_text(const fl_key *key, const void *section, char buf[FL_VALUE_TEXT])
{
    const void *at = (const char *)section + key->offset;
    const char *si = fl_unit_si(key->unit);
    const char *word;
    size_t size;
    int len = 0, all_special = 0;
    double x[3] = {0};
    int32_t i, three[3];
    uint32_t bits;
    buf[0] = '\0';
    switch (key->type) {
    case FL_VALUE_F64:
    case FL_VALUE_VEC3:
        memcpy(x, at, key->type == FL_VALUE_F64 ? sizeof(double) : sizeof(fl_vec3));
        all_special = key->special != NULL;
        for (int k = 0; k < (key->type == FL_VALUE_F64 ? 1 : 3); k++) {
            if (k) buf[len++] = ' ';
            len += number_text(key, x[k], buf + len, FL_VALUE_TEXT - (size_t)len);
            all_special = all_special && x[k] == key->special_value;
        }
        if (si[0] && !all_special) snprintf(buf + len, FL_VALUE_TEXT - (size_t)len, " %s", si);
        break;
    case FL_VALUE_I32:
        memcpy(&i, at, sizeof i);
        if (key->special && i == (int32_t)key->special_value)
            snprintf(buf, FL_VALUE_TEXT, "%s", key->special);
        else snprintf(buf, FL_VALUE_TEXT, "%d", i);
        break;
    case FL_VALUE_WORD:
        memcpy(&i, at, sizeof i);
        word = i >= 0 ? choice_at(key->choices, i, &size) : NULL;
        if (word) snprintf(buf, FL_VALUE_TEXT, "%.*s", (int)size, word);
        break;
    case FL_VALUE_WORDS:
        memcpy(three, at, sizeof three);
        for (int k = 0; k < (three[0] == three[1] && three[1] == three[2] ? 1 : 3); k++)
            if ((word = choice_at(key->choices, three[k], &size)) != NULL)
                len +=
                    snprintf(buf + len, FL_VALUE_TEXT - (size_t)len, "%s%.*s", k ? " " : "", (int)size, word);
        break;
    case FL_VALUE_FIXED:
        memcpy(&bits, at, sizeof bits);
        for (int k = 0; k < N_FIX; k++)
            if (bits & 1u << k)
                len += snprintf(buf + len, FL_VALUE_TEXT - (size_t)len, "%s%s", len ? " " : "", fix_word[k]);
        if (!bits) snprintf(buf, FL_VALUE_TEXT, "%s", key->special);
        break;
    case FL_VALUE_NAME:
    case FL_VALUE_PATH: {
        const char *text = at;
        snprintf(buf, FL_VALUE_TEXT, "%s", text[0] || !key->special ? text : key->special);
        break;
    }
    }
    return buf;
}

void fl_value_copy(const fl_key *key, void *to, const void *from)
{
    static const size_t size[] = {[FL_VALUE_F64] = sizeof(double),        [FL_VALUE_VEC3] = sizeof(fl_vec3),
                                  [FL_VALUE_I32] = sizeof(int32_t),       [FL_VALUE_WORD] = sizeof(int32_t),
                                  [FL_VALUE_WORDS] = 3 * sizeof(int32_t), [FL_VALUE_FIXED] = sizeof(uint32_t),
                                  [FL_VALUE_NAME] = FL_SCENE_NAME,        [FL_VALUE_PATH] = FL_SCENE_PATH};
    memmove((char *)to + key->offset, (const char *)from + key->offset, size[key->type]);
}

int fl_value_is_special(const fl_key *key, const void *section)
{
    double x;
    if (key->type != FL_VALUE_F64 || !key->special) return 0;
    memcpy(&x, (const char *)section + key->offset, sizeof x);
    return x == key->special_value;
}
