/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/element_surface.h"
#include "mesh/shared_faces.h"

/* A list like "hex8 4, tri3 2"; what does not fit becomes dots. */
typedef struct {
    char text[300];
    size_t len;
} count_list;

static void add_count(count_list *l, const char *name, int32_t n)
{
    char item[80];
    const int k = snprintf(item, sizeof item, "%s%.40s %d", l->len ? ", " : "", name, n);
    if (l->len + (size_t)k + 6 < sizeof l->text) memcpy(l->text + l->len, item, (size_t)k + 1);
    else if (l->text[l->len] == '\0' && l->len + 6 < sizeof l->text) strcpy(l->text + l->len, ", ...");
    else return;
    l->len += strlen(l->text + l->len);
}

static void report_counts(const fl_elements *e, fl_bytes *b)
{
    int32_t count[FL_SHAPES] = {0}, nodes = -e->own_nodes;
    count_list in = {{0}, 0}, out = {{0}, 0};
    for (int32_t k = 0; k < e->node_id.n; k++) nodes += !isnan(e->x[k].x);
    for (int32_t k = 0; k < e->element_id.n; k++) count[e->element[k].shape] += e->element[k].part >= 0;
    for (int k = 0; k < FL_SHAPES; k++)
        if (count[k]) add_count(&in, fl_shape_name((enum fl_shape)k), count[k]);
    for (int32_t k = 0; k < e->skipped.n; k++) add_count(&out, e->skipped.name[k], e->skip_count[k]);
    fl_bytes_note(b, "%d nodes; elements: %s", nodes, in.len ? in.text : "none");
    if (e->moved) fl_bytes_note(b, "%d nodes were moved by a later line", e->moved);
    if (e->replaced)
        fl_bytes_note(b, "%d elements were replaced by later ones of the same number", e->replaced);
    if (out.len) fl_bytes_note(b, "elements of unknown types or without a surface, skipped: %s", out.text);
}

/* The part with the name of this set if that part is selected, else the target itself. */
static int32_t merged_target(const fl_elements *e, const char *is_selected, int32_t target)
{
    const int32_t parts = e->parts.n;
    const int32_t part = target < parts ? -1 : fl_string_table_find(&e->parts, e->sets.name[target - parts]);
    return part >= 0 && is_selected[part] ? part : target;
}

/* Set the target of each element: its part, or a set selected by name.  Sets are numbered behind the parts.
 */
static int choose_targets(fl_elements *e, fl_skin *k, fl_import_options *opt, fl_err *err)
{
    const int32_t parts = e->parts.n, all = parts + e->sets.n;
    int32_t *first = NULL, *order = NULL; /* picks grouped by set */
    char *is_selected = fl_alloc(all, 1, err);
    int selected, rc = -1;
    if (!is_selected || fl_group_by_target(e->picks, e->sets.n, e->picks ? &e->pick[0].set : NULL,
                                           (int)(sizeof *e->pick / sizeof(int32_t)), &first, &order, err))
        goto done;
    for (int32_t t = 0; t < all; t++) {
        selected = fl_import_selects(opt, t < parts ? e->parts.name[t] : e->sets.name[t - parts], err);
        if (selected < 0) goto done;
        is_selected[t] = (char)(selected && (t < parts || fl_import_by_name(opt)));
    }
    for (int32_t i = 0; i < e->element_id.n; i++)
        k->target[i] = e->element[i].part >= 0 && is_selected[e->element[i].part] ? e->element[i].part : -1;
    for (int32_t i = 0; i < e->picks; i++) {
        const fl_pick *p = &e->pick[i];
        const int32_t t = parts + p->set, solid = fl_shape_faces((enum fl_shape)e->element[p->element].shape);
        int32_t *target = &k->target[p->element];
        if (!is_selected[t] || (solid && p->face != FL_PICK_WHOLE)) continue;
        if (*target >= parts && *target <= t) continue;
        *target = t;
        k->reversed[p->element] = p->reversed;
    }
    for (int32_t i = 0; i < e->element_id.n; i++) k->target[i] = merged_target(e, is_selected, k->target[i]);
    for (int32_t i = 0; i < e->picks; i++) {
        const fl_pick *p = &e->pick[order[i]];
        if (is_selected[parts + p->set] && p->face != FL_PICK_WHOLE &&
            fl_skin_pick(k, p, merged_target(e, is_selected, parts + p->set), err))
            goto done;
    }
    rc = 0;
done:
    free(first);
    free(order);
    free(is_selected);
    return rc;
}

int fl_elements_surface(fl_elements *e, fl_surface *s, fl_bytes *b, fl_import_options *opt, fl_err *err)
{
    fl_skin k = {0};
    int rc = -1;
    report_counts(e, b);
    if (fl_skin_start(&k, e, opt, err) == 0 && choose_targets(e, &k, opt, err) == 0 &&
        fl_resolve_shared_faces(&k, err) == 0)
        rc = fl_skin_emit(&k, s, err);
    if (rc == 0) fl_skin_report(&k, b);
    fl_skin_free(&k);
    return rc;
}
