/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/shared_faces.h"

/* Who comes first among those on one face. */
enum rank { WANTED, OTHER, SHELL, LINE };

enum { WHOLE = 7 }; /* stands for the face of a shell or a line; solids have six at most */

/* A face, by its second to last different corners in ascending order; -1 stands for those that are not there.
 * The first, the lowest, says in which bucket it lies. */
typedef struct {
    int32_t key[3], element;
    int8_t face, rank;
} side;

static int by_corners(const side *a, const side *b)
{
    for (int i = 0; i < 3; i++)
        if (a->key[i] != b->key[i]) return a->key[i] < b->key[i] ? -1 : 1;
    return 0;
}

static int by_key(const void *va, const void *vb)
{
    const side *a = va, *b = vb;
    const int order = by_corners(a, b);
    if (order) return order;
    if (a->rank != b->rank) return a->rank < b->rank ? -1 : 1;
    if (a->element != b->element) return a->element < b->element ? -1 : 1;
    return (a->face > b->face) - (a->face < b->face);
}

/* Put v into the n different numbers that are in ascending order in c; how many there are then. */
static int put_in(int32_t *c, int n, int32_t v)
{
    int at = n;
    for (int i = 0; i < n; i++)
        if (c[i] == v) return n;
    for (; at > 0 && c[at - 1] > v; at--) c[at] = c[at - 1];
    c[at] = v;
    return n + 1;
}

int fl_face_corner_nodes(const fl_elements *e, int32_t element, int face, int32_t c[4])
{
    const fl_element *el = &e->element[element];
    int place[4] = {0, 1, 2, 3}, n = 0;
    const int m = face < 0 ? fl_shape_corners((enum fl_shape)el->shape)
                           : fl_shape_face((enum fl_shape)el->shape, face, place);
    for (int i = 0; i < m; i++) n = put_in(c, n, e->connectivity[el->first + place[i]]);
    for (int i = n; i < 4; i++) c[i] = -1;
    return n;
}

/* Do two solids have the same corners? */
static int twins(const fl_elements *e, int32_t a, int32_t b)
{
    int32_t c[2][8];
    int n[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        const fl_element *el = &e->element[k ? b : a];
        for (int i = 0; i < fl_shape_corners((enum fl_shape)el->shape); i++)
            n[k] = put_in(c[k], n[k], e->connectivity[el->first + i]);
    }
    return n[0] == n[1] && memcmp(c[0], c[1], (size_t)n[0] * sizeof c[0][0]) == 0;
}

/* Of the solids s[0 .. n) on one face, twins counted once, how many there are; *first is the first of them.
 * One that has the face twice is flat there, and has no side of it. */
static int different(const fl_elements *e, const side *s, int32_t n, int32_t *first)
{
    int count = 0;
    *first = 0;
    for (int32_t i = 0; i < n; i++) {
        int32_t j = 0;
        if ((i > 0 && s[i - 1].element == s[i].element) || (i + 1 < n && s[i + 1].element == s[i].element))
            continue;
        while (j < i && !twins(e, s[j].element, s[i].element)) j++;
        if (j < i) continue;
        if (count == 0) *first = i;
        count++;
    }
    return count;
}

/* Call face() for those that lie on one face, in order; one at a time.  Sides are dealt out by their lowest
 * corner: the buckets are small, and are looked through one after the other. */
typedef int each_face(void *context, const side *s, int32_t n, fl_err *err);
typedef int rank_fn(const void *context, int32_t element); /* < 0: not looked at */

static int faces_of(const fl_elements *e, int32_t element, int rank)
{
    return rank >= SHELL ? 1 : fl_shape_faces((enum fl_shape)e->element[element].shape);
}

static int look_through(const fl_elements *e, rank_fn *rank_of, each_face *face, void *context, fl_err *err)
{
    int64_t *first = fl_alloc((int64_t)e->node_id.n + 1, sizeof *first, err);
    int64_t *at = NULL; /* element * 8 + face */
    side *s = NULL;
    int32_t cap = 0, c[4], n;
    int rc = -1;
    if (!first) goto done;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t i = 0; i < e->element_id.n; i++) {
            const int rank = rank_of(context, i);
            if (rank < 0) continue;
            for (int f = 0; f < faces_of(e, i, rank); f++) {
                if (fl_face_corner_nodes(e, i, rank >= SHELL ? -1 : f, c) < (rank == LINE ? 2 : 3)) continue;
                if (pass == 0) first[c[0]]++;
                else at[--first[c[0]]] = 8 * (int64_t)i + (rank >= SHELL ? WHOLE : f);
            }
        }
        if (pass) break;
        for (int32_t v = 1; v <= e->node_id.n; v++) first[v] += first[v - 1];
        at = fl_alloc(first[e->node_id.n], sizeof *at, err);
        if (!at) goto done;
    }
    for (int32_t v = 0; v < e->node_id.n; v++) {
        n = 0;
        if (fl_grow(&s, &cap, first[v + 1] - first[v], sizeof *s, err)) goto done;
        for (int64_t j = first[v]; j < first[v + 1]; j++) {
            side *one = &s[n++];
            one->element = (int32_t)(at[j] / 8);
            one->face = (int8_t)(at[j] % 8);
            one->rank = (int8_t)rank_of(context, one->element);
            fl_face_corner_nodes(e, one->element, one->face == WHOLE ? -1 : one->face, c);
            memcpy(one->key, c + 1, sizeof one->key);
        }
        if (n > 1) qsort(s, (size_t)n, sizeof *s, by_key);
        for (int32_t i = 0, j; i < n; i = j) {
            for (j = i + 1; j < n && by_corners(&s[i], &s[j]) == 0; j++) {}
            if (face(context, s + i, j - i, err)) goto done;
        }
    }
    rc = 0;
done:
    free(first);
    free(at);
    free(s);
    return rc;
}

/* --- faces that no other solid has ---------------------------------------------------------------------- */

typedef struct {
    const fl_elements *e;
    uint8_t *bit;
} free_faces;

static int solids_only(const void *context, int32_t element)
{
    const free_faces *k = context;
    return fl_shape_faces((enum fl_shape)k->e->element[element].shape) ? WANTED : -1;
}

static int mark_free(void *context, const side *s, int32_t n, fl_err *err)
{
    const free_faces *k = context;
    int32_t first;
    (void)err;
    if (different(k->e, s, n, &first) != 1) return 0;
    for (int32_t i = 0; i < n; i++) k->bit[s[i].element] = (uint8_t)(k->bit[s[i].element] | 1 << s[i].face);
    return 0;
}

int fl_mark_free_faces(const fl_elements *e, uint8_t *free, fl_err *err)
{
    free_faces k = {e, free};
    return look_through(e, solids_only, mark_free, &k, err);
}

/* --- who brings a face ---------------------------------------------------------------------------------- */

static int has_bit(const uint8_t *bits, const side *s) { return bits[s->element] >> s->face & 1; }
static void set_bit(uint8_t *bits, const side *s)
{
    bits[s->element] = (uint8_t)(bits[s->element] | 1 << s->face);
}

static int rank_of(const void *context, int32_t element)
{
    const fl_skin *k = context;
    const enum fl_shape shape = (enum fl_shape)k->e->element[element].shape;
    if (fl_shape_faces(shape)) return k->target[element] >= 0 ? WANTED : OTHER;
    if (k->target[element] < 0) return -1;
    if (fl_shape_corners(shape) == 2) return LINE;
    return k->mixed ? SHELL : -1;
}

/* This element stands on another, which is of the part that keeps what both are. */
static void stand_back(fl_skin *k, int32_t element, int32_t keeper)
{
    k->dropped[element] = 1;
    if (keeper >= 0) k->dropped_of[keeper]++;
}

/* Twins among the wanted solids stand back, once for all of their faces. */
static void part_twins(fl_skin *k, const side *s, int32_t n)
{
    for (int32_t i = 1; i < n; i++)
        for (int32_t j = 0; j < i && !k->dropped[s[i].element]; j++)
            if (s[j].element != s[i].element && twins(k->e, s[j].element, s[i].element)) {
                stand_back(k, s[i].element, k->target[s[j].element]);
                k->duplicates++;
            }
}

/* Was the face picked by a set, of a wanted solid where there is one, or of a twin?  Of twins
 * that were both asked for the first counts. */
static int picked(fl_skin *k, const side *s, int32_t n, const side *wanted)
{
    int32_t by = -1;
    for (int32_t i = 0; i < n; i++) {
        if (!has_bit(k->picked_faces, &s[i])) continue;
        if (by >= 0 && s[i].element != s[by].element && twins(k->e, s[i].element, s[by].element))
            set_bit(k->duplicate_faces, &s[i]);
        else if (by < 0 && (!wanted || s[i].rank == WANTED || twins(k->e, s[i].element, wanted->element)))
            by = i;
    }
    return by >= 0;
}

static int has_places(const fl_elements *e, int32_t element)
{
    const fl_element *el = &e->element[element];
    for (int i = 0; i < fl_shape_nodes((enum fl_shape)el->shape); i++) {
        const int32_t v = e->connectivity[el->first + i];
        if (v >= 0 && isnan(e->x[v].x)) return 0;
    }
    return 1;
}

/* The face of the solid comes to the part of the shell on it. */
static int take(fl_skin *k, const side *solid, const side *shell, fl_err *err)
{
    if (fl_grow(&k->pick, &k->pick_cap, (int64_t)k->picks + 1, sizeof *k->pick, err)) return -1;
    k->pick[k->picks++] = (fl_skin_face){k->target[shell->element], solid->element, solid->face};
    k->dropped[shell->element] = 1;
    return 0;
}

/* The shells on a face of so many solids, n[WANTED] and n[OTHER]; `alone` is the first of these.  The first
 * shell may bring the face, the others do not. */
static int settle_shells(fl_skin *k, const side *shell, int32_t shells, const int n[2], const side *alone,
                         int is_picked, fl_err *err)
{
    const int free = !is_picked && (n[WANTED] == 0 || (n[WANTED] == 1 && k->by_name));
    const int32_t keeper = free ? k->target[shell->element] : n[WANTED] == 1 ? k->target[alone->element] : -1;
    const int told = k->target[shell->element] >= k->e->parts.n; /* a surface tells its side */
    if (free && n[n[WANTED] ? WANTED : OTHER] == 1 && !(told && !n[WANTED]) &&
        has_places(k->e, alone->element)) {
        if (take(k, alone, shell, err)) return -1;
        if (n[WANTED]) set_bit(k->picked_faces, alone);
        k->shell_faces++;
    }
    for (int32_t i = free; i < shells; i++) {
        if (n[WANTED] > 1) k->interior_shells++;
        else if (free) k->duplicates++;
        else k->covered_shells++;
        stand_back(k, shell[i].element, keeper);
    }
    return 0;
}

static int same_radii(const fl_elements *e, int32_t a, int32_t b)
{
    const int32_t p = e->element[a].section, q = e->element[b].section;
    return p >= 0 && q >= 0 && memcmp(e->section[p], e->section[q], sizeof e->section[p]) == 0;
}

static void settle_lines(fl_skin *k, const side *s, int32_t n)
{
    for (int32_t i = 1; i < n; i++)
        for (int32_t j = 0; j < i && !k->dropped[s[i].element]; j++)
            if (!k->dropped[s[j].element] && same_radii(k->e, s[i].element, s[j].element)) {
                stand_back(k, s[i].element, k->target[s[j].element]);
                k->duplicates++;
            }
}

static int settle(void *context, const side *s, int32_t n, fl_err *err)
{
    fl_skin *k = context;
    int32_t from[LINE + 2] = {0}; /* of each rank */
    int32_t first[2];
    int count[2], is_picked;
    for (int32_t i = 0; i < n; i++) from[s[i].rank + 1]++;
    for (int r = WANTED; r <= LINE; r++) from[r + 1] += from[r];
    part_twins(k, s, from[OTHER]);
    count[WANTED] = different(k->e, s, from[OTHER], &first[WANTED]);
    count[OTHER] = different(k->e, s + from[OTHER], from[SHELL] - from[OTHER], &first[OTHER]);
    const side *alone = count[WANTED] ? s + first[WANTED] : s + from[OTHER] + first[OTHER];
    is_picked = picked(k, s, from[SHELL], count[WANTED] ? alone : NULL);
    k->nonmanifold += count[WANTED] > 2;
    if (count[WANTED] == 1) set_bit(is_picked ? k->picked_faces : k->outer_faces, alone);
    if (from[LINE] > from[SHELL] &&
        settle_shells(k, s + from[SHELL], from[LINE] - from[SHELL], count, alone, is_picked, err))
        return -1;
    settle_lines(k, s + from[LINE], n - from[LINE]);
    return 0;
}

/* Shells alone, of one part, need no look at the faces of others: the mending finds what is there twice. */
static int is_mixed(const fl_skin *k)
{
    int32_t target = -1;
    for (int32_t i = 0; i < k->e->element_id.n; i++) {
        const enum fl_shape shape = (enum fl_shape)k->e->element[i].shape;
        if (fl_shape_faces(shape)) return 1;
        if (k->target[i] < 0 || fl_shape_corners(shape) == 2) continue;
        if (target >= 0 && target != k->target[i]) return 1;
        target = k->target[i];
    }
    return 0;
}

int fl_resolve_shared_faces(fl_skin *k, fl_err *err)
{
    const int32_t n = k->e->element_id.n;
    k->mixed = is_mixed(k);
    if (look_through(k->e, rank_of, settle, k, err)) return -1;
    for (int32_t i = 0; i < n; i++)
        if (k->dropped[i]) k->target[i] = -1;
    return 0;
}
