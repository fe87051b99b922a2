/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "mesh/face_groups.h"
#include "mesh/shared_faces.h"

static int has_bit(const uint8_t *bits, const fl_face_ref *s) { return bits[s->element] >> s->face & 1; }
static void set_bit(uint8_t *bits, const fl_face_ref *s)
{
    bits[s->element] = (uint8_t)(bits[s->element] | 1 << s->face);
}

static int rank_of_element(const void *context, int32_t element)
{
    const fl_skin *k = context;
    const enum fl_shape shape = (enum fl_shape)k->e->element[element].shape;
    if (fl_shape_faces(shape)) return k->target[element] >= 0 ? FL_FACE_WANTED : FL_FACE_OTHER;
    if (k->target[element] < 0) return -1;
    if (fl_shape_corners(shape) == 2) return FL_FACE_LINE;
    return k->mixed ? FL_FACE_SHELL : -1;
}

/* Drop an element that lies on another one, which belongs to the target keeper. */
static void drop_element(fl_skin *k, int32_t element, int32_t keeper)
{
    k->dropped[element] = 1;
    if (keeper >= 0) k->dropped_of[keeper]++;
}

/* Drop selected solids on the corner nodes of another one, once for all of their faces. */
static void drop_duplicate_solids(fl_skin *k, const fl_face_ref *s, int32_t n)
{
    for (int32_t i = 1; i < n; i++)
        for (int32_t j = 0; j < i && !k->dropped[s[i].element]; j++)
            if (s[j].element != s[i].element && fl_same_corners(k->e, s[j].element, s[i].element)) {
                drop_element(k, s[i].element, k->target[s[j].element]);
                k->duplicates++;
            }
}

/* True if a set picked the face of a selected solid, or of any solid if none is selected, or of a duplicate
 * of such a solid.  Of duplicates that were both picked the first counts. */
static int is_picked_face(fl_skin *k, const fl_face_ref *s, int32_t n, const fl_face_ref *wanted)
{
    int32_t by = -1;
    for (int32_t i = 0; i < n; i++) {
        if (!has_bit(k->picked_faces, &s[i])) continue;
        if (by >= 0 && s[i].element != s[by].element && fl_same_corners(k->e, s[i].element, s[by].element))
            set_bit(k->duplicate_faces, &s[i]);
        else if (by < 0 && (!wanted || s[i].rank == FL_FACE_WANTED ||
                            fl_same_corners(k->e, s[i].element, wanted->element)))
            by = i;
    }
    return by >= 0;
}

static int has_positions(const fl_elements *e, int32_t element)
{
    const fl_element *el = &e->element[element];
    for (int i = 0; i < fl_shape_nodes((enum fl_shape)el->shape); i++) {
        const int32_t v = e->connectivity[el->first + i];
        if (v >= 0 && isnan(e->x[v].x)) return 0;
    }
    return 1;
}

/* Assign the face of the solid to the part of the shell on it. */
static int take_shell_face(fl_skin *k, const fl_face_ref *solid, const fl_face_ref *shell, fl_err *err)
{
    if (fl_grow(&k->pick, &k->pick_cap, (int64_t)k->picks + 1, sizeof *k->pick, err)) return -1;
    k->pick[k->picks++] = (fl_skin_face){k->target[shell->element], solid->element, solid->face};
    k->dropped[shell->element] = 1;
    return 0;
}

/* Resolve the shells on a face of n[FL_FACE_WANTED] and n[FL_FACE_OTHER] solids; `alone` is the first of
 * these.  The first shell may get the face; all others are dropped. */
static int resolve_shells(fl_skin *k, const fl_face_ref *shell, int32_t shells, const int n[2],
                          const fl_face_ref *alone, int is_picked, fl_err *err)
{
    const int free = !is_picked && (n[FL_FACE_WANTED] == 0 || (n[FL_FACE_WANTED] == 1 && k->by_name));
    const int32_t keeper = free                     ? k->target[shell->element]
                           : n[FL_FACE_WANTED] == 1 ? k->target[alone->element]
                                                    : -1;
    const int has_side = k->target[shell->element] >= k->e->parts.n; /* a surface set gives the side */
    if (free && n[n[FL_FACE_WANTED] ? FL_FACE_WANTED : FL_FACE_OTHER] == 1 &&
        !(has_side && !n[FL_FACE_WANTED]) && has_positions(k->e, alone->element)) {
        if (take_shell_face(k, alone, shell, err)) return -1;
        if (n[FL_FACE_WANTED]) set_bit(k->picked_faces, alone);
        k->shell_faces++;
    }
    for (int32_t i = free; i < shells; i++) {
        if (n[FL_FACE_WANTED] > 1) k->interior_shells++;
        else if (free) k->duplicates++;
        else k->covered_shells++;
        drop_element(k, shell[i].element, keeper);
    }
    return 0;
}

static int same_radii(const fl_elements *e, int32_t a, int32_t b)
{
    const int32_t p = e->element[a].section, q = e->element[b].section;
    return p >= 0 && q >= 0 && memcmp(e->section[p], e->section[q], sizeof e->section[p]) == 0;
}

static void drop_duplicate_lines(fl_skin *k, const fl_face_ref *s, int32_t n)
{
    for (int32_t i = 1; i < n; i++)
        for (int32_t j = 0; j < i && !k->dropped[s[i].element]; j++)
            if (!k->dropped[s[j].element] && same_radii(k->e, s[i].element, s[j].element)) {
                drop_element(k, s[i].element, k->target[s[j].element]);
                k->duplicates++;
            }
}

static int resolve_group(void *context, const fl_face_ref *s, int32_t n, fl_err *err)
{
    fl_skin *k = context;
    int32_t from[FL_FACE_LINE + 2] = {0}; /* first face of each rank */
    int32_t first[2];
    int count[2], is_picked;
    for (int32_t i = 0; i < n; i++) from[s[i].rank + 1]++;
    for (int r = FL_FACE_WANTED; r <= FL_FACE_LINE; r++) from[r + 1] += from[r];
    drop_duplicate_solids(k, s, from[FL_FACE_OTHER]);
    count[FL_FACE_WANTED] = fl_distinct_solids(k->e, s, from[FL_FACE_OTHER], &first[FL_FACE_WANTED]);
    count[FL_FACE_OTHER] = fl_distinct_solids(
        k->e, s + from[FL_FACE_OTHER], from[FL_FACE_SHELL] - from[FL_FACE_OTHER], &first[FL_FACE_OTHER]);
    const fl_face_ref *alone =
        count[FL_FACE_WANTED] ? s + first[FL_FACE_WANTED] : s + from[FL_FACE_OTHER] + first[FL_FACE_OTHER];
    is_picked = is_picked_face(k, s, from[FL_FACE_SHELL], count[FL_FACE_WANTED] ? alone : NULL);
    k->nonmanifold += count[FL_FACE_WANTED] > 2;
    if (count[FL_FACE_WANTED] == 1) set_bit(is_picked ? k->picked_faces : k->outer_faces, alone);
    if (from[FL_FACE_LINE] > from[FL_FACE_SHELL] &&
        resolve_shells(k, s + from[FL_FACE_SHELL], from[FL_FACE_LINE] - from[FL_FACE_SHELL], count, alone,
                       is_picked, err))
        return -1;
    drop_duplicate_lines(k, s + from[FL_FACE_LINE], n - from[FL_FACE_LINE]);
    return 0;
}

/* Shells alone, of one part, need no comparison with others: the later cleanup finds duplicates. */
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
    if (fl_visit_face_groups(k->e, rank_of_element, resolve_group, k, err)) return -1;
    for (int32_t i = 0; i < n; i++)
        if (k->dropped[i]) k->target[i] = -1;
    return 0;
}
