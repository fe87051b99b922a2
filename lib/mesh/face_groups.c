/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/face_groups.h"

enum { WHOLE_ELEMENT = 7 }; /* face index that stands for a shell or a line; solids have six faces at most */

static int compare_corners(const fl_face_ref *a, const fl_face_ref *b)
{
    for (int i = 0; i < 3; i++)
        if (a->key[i] != b->key[i]) return a->key[i] < b->key[i] ? -1 : 1;
    return 0;
}

static int compare_refs(const void *va, const void *vb)
{
    const fl_face_ref *a = va, *b = vb;
    const int order = compare_corners(a, b);
    if (order) return order;
    if (a->rank != b->rank) return a->rank < b->rank ? -1 : 1;
    if (a->element != b->element) return a->element < b->element ? -1 : 1;
    return (a->face > b->face) - (a->face < b->face);
}

/* Insert v into the n different numbers c, which are in ascending order.  Returns their new count. */
static int insert_node(int32_t *c, int n, int32_t v)
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
    for (int i = 0; i < m; i++) n = insert_node(c, n, e->connectivity[el->first + place[i]]);
    for (int i = n; i < 4; i++) c[i] = -1;
    return n;
}

int fl_same_corners(const fl_elements *e, int32_t a, int32_t b)
{
    int32_t c[2][8];
    int n[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        const fl_element *el = &e->element[k ? b : a];
        for (int i = 0; i < fl_shape_corners((enum fl_shape)el->shape); i++)
            n[k] = insert_node(c[k], n[k], e->connectivity[el->first + i]);
    }
    return n[0] == n[1] && memcmp(c[0], c[1], (size_t)n[0] * sizeof c[0][0]) == 0;
}

int fl_distinct_solids(const fl_elements *e, const fl_face_ref *s, int32_t n, int32_t *first)
{
    int count = 0;
    *first = 0;
    for (int32_t i = 0; i < n; i++) {
        int32_t j = 0;
        if ((i > 0 && s[i - 1].element == s[i].element) || (i + 1 < n && s[i + 1].element == s[i].element))
            continue;
        while (j < i && !fl_same_corners(e, s[j].element, s[i].element)) j++;
        if (j < i) continue;
        if (count == 0) *first = i;
        count++;
    }
    return count;
}

static int face_count(const fl_elements *e, int32_t element, int rank)
{
    return rank >= FL_FACE_SHELL ? 1 : fl_shape_faces((enum fl_shape)e->element[element].shape);
}

/* Faces are sorted into buckets by their lowest corner node; buckets are small and are processed one by one.
 */
int fl_visit_face_groups(const fl_elements *e, fl_face_rank *rank_of, fl_face_visitor *visit, void *context,
                         fl_err *err)
{
    int64_t *first = fl_alloc((int64_t)e->node_id.n + 1, sizeof *first, err);
    int64_t *at = NULL; /* element * 8 + face */
    fl_face_ref *s = NULL;
    int32_t cap = 0, c[4], n;
    int rc = -1;
    if (!first) goto done;
    for (int pass = 0; pass < 2; pass++) {
        for (int32_t i = 0; i < e->element_id.n; i++) {
            const int rank = rank_of(context, i);
            if (rank < 0) continue;
            for (int f = 0; f < face_count(e, i, rank); f++) {
                if (fl_face_corner_nodes(e, i, rank >= FL_FACE_SHELL ? -1 : f, c) <
                    (rank == FL_FACE_LINE ? 2 : 3))
                    continue;
                if (pass == 0) first[c[0]]++;
                else at[--first[c[0]]] = 8 * (int64_t)i + (rank >= FL_FACE_SHELL ? WHOLE_ELEMENT : f);
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
            fl_face_ref *one = &s[n++];
            one->element = (int32_t)(at[j] / 8);
            one->face = (int8_t)(at[j] % 8);
            one->rank = (int8_t)rank_of(context, one->element);
            fl_face_corner_nodes(e, one->element, one->face == WHOLE_ELEMENT ? -1 : one->face, c);
            memcpy(one->key, c + 1, sizeof one->key);
        }
        if (n > 1) qsort(s, (size_t)n, sizeof *s, compare_refs);
        for (int32_t i = 0, j; i < n; i = j) {
            for (j = i + 1; j < n && compare_corners(&s[i], &s[j]) == 0; j++) {}
            if (visit(context, s + i, j - i, err)) goto done;
        }
    }
    rc = 0;
done:
    free(first);
    free(at);
    free(s);
    return rc;
}

/* --- free faces ----------------------------------------------------------------------------------------- */

typedef struct {
    const fl_elements *e;
    uint8_t *bit;
} free_context;

static int rank_solids(const void *context, int32_t element)
{
    const free_context *k = context;
    return fl_shape_faces((enum fl_shape)k->e->element[element].shape) ? FL_FACE_WANTED : -1;
}

static int mark_if_free(void *context, const fl_face_ref *s, int32_t n, fl_err *err)
{
    const free_context *k = context;
    int32_t first;
    (void)err;
    if (fl_distinct_solids(k->e, s, n, &first) != 1) return 0;
    for (int32_t i = 0; i < n; i++) k->bit[s[i].element] = (uint8_t)(k->bit[s[i].element] | 1 << s[i].face);
    return 0;
}

int fl_mark_free_faces(const fl_elements *e, uint8_t *free, fl_err *err)
{
    free_context k = {e, free};
    return fl_visit_face_groups(e, rank_solids, mark_if_free, &k, err);
}
