/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/beam_deck.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/element_surface.h"

int fl_beam_deck_start(fl_beam_deck *k, fl_bytes *b, fl_import_options *opt, fl_err *err)
{
    *k = (fl_beam_deck){.b = b, .opt = opt, .frame = opt ? opt->frame : NULL};
    if (fl_elements_start(&k->e, fl_in_name(b->in), err)) return -1;
    fl_deck_start(&k->d, &k->e, b);
    return 0;
}

int32_t fl_beam_deck_section(fl_beam_deck *k, const fl_beam_section *s, fl_err *err)
{
    if (fl_grow(&k->section, &k->section_cap, (int64_t)k->sections + 1, sizeof *k->section, err)) return -1;
    k->section[k->sections] = *s;
    return k->sections++;
}

int32_t fl_beam_deck_add(fl_beam_deck *k, const fl_beam *b, fl_err *err)
{
    if (fl_grow(&k->beam, &k->beam_cap, (int64_t)k->beams + 1, sizeof *k->beam, err)) return -1;
    k->beam[k->beams] = *b;
    k->beam[k->beams].file = k->e.file;
    k->beam[k->beams].line = k->e.line;
    return k->beams++;
}

int64_t fl_beam_deck_node(fl_beam_deck *k, fl_vec3 x, fl_err *err)
{
    if (fl_elements_add_node(&k->e, 1, k->made_nodes + 1, x, err) < 0) return -1;
    k->e.own_nodes++;
    return ++k->made_nodes;
}

int32_t fl_beam_deck_set(fl_beam_deck *k, const char *name, int is_part, fl_err *err)
{
    const int32_t had = k->set_name.n, at = fl_string_table_add(&k->set_name, name, err);
    if (at < 0 || fl_grow(&k->set_is_part, &k->set_cap, k->set_name.n, 1, err)) return -1;
    if (at >= had) k->set_is_part[at] = 0;
    k->set_is_part[at] |= (int8_t)is_part;
    return at;
}

int fl_beam_deck_set_add(fl_beam_deck *k, int32_t set, int64_t element, fl_err *err)
{
    if (fl_grow(&k->entry, &k->entry_cap, (int64_t)k->entries + 1, sizeof *k->entry, err)) return -1;
    k->entry[k->entries++] = (struct fl_beam_set_entry){set, element};
    return 0;
}

int fl_beam_deck_hold(fl_beam_deck *k, int64_t node, int fixed, fl_err *err)
{
    if (!k->frame || !fixed) return 0;
    const int32_t at = fl_frame_node_of(k->frame, 0, node, err);
    if (at < 0) return -1;
    k->frame->node[at].fixed |= fixed;
    return 0;
}

int fl_beam_deck_mass(fl_beam_deck *k, int64_t node, double mass, fl_err *err)
{
    if (!k->frame || !(mass > 0.0)) return 0;
    const int32_t at = fl_frame_node_of(k->frame, 0, node, err);
    if (at < 0) return -1;
    k->frame->node[at].mass += mass;
    return 0;
}

int fl_beam_deck_link(fl_beam_deck *k, int64_t a, int64_t b, fl_err *err)
{
    if (!k->frame) return fl_beam_deck_skip(k, "rigid link", err);
    if (fl_grow(&k->link, &k->link_cap, (int64_t)k->links + 1, sizeof *k->link, err)) return -1;
    k->link[k->links][0] = a;
    k->link[k->links++][1] = b;
    return 0;
}

int fl_beam_deck_skip(fl_beam_deck *k, const char *kind, fl_err *err)
{
    if (k->frame) return fl_frame_count_skipped(k->frame, "%s", kind);
    return fl_elements_skip(&k->e, kind, err);
}

/* --- checks --------------------------------------------------------------------------------------------- */

static int fail_beam(const fl_beam_deck *k, const fl_beam *b, fl_err *err, const char *what, long long of)
{
    char text[200];
    snprintf(text, sizeof text, what, (long long)b->id, of);
    return fl_elements_fail(&k->e, b->file, b->line, err, "%s", text);
}

/* Positions of the ends; of a member with an unknown node or without a length the line is told. */
static int find_ends(const fl_beam_deck *k, const fl_beam *b, fl_vec3 x[2], fl_err *err)
{
    for (int s = 0; s < 2; s++) {
        const int32_t at = fl_id_map_find(&k->e.node_id, b->scope[s], b->node[s]);
        if (at < 0 || isnan(k->e.x[at].x))
            return fail_beam(k, b, err, "member %lld ends at node %lld, which is not defined",
                             (long long)b->node[s]);
        x[s] = v3_add(k->e.x[at], b->offset[s]);
    }
    if (!(v3_norm(v3_sub(x[1], x[0])) > 0.0)) return fail_beam(k, b, err, "member %lld has no length", 0);
    return 0;
}

static int check_sizes(const fl_beam_deck *k, const fl_beam *b, fl_err *err)
{
    for (int s = 0; s < 2; s++) {
        const fl_beam_section *p = &k->section[b->section[s]];
        if (p->form == FL_FRAME_PIPE && !(p->size[0] > 0.0))
            return fail_beam(k, b, err, "member %lld has a section without a diameter above 0", 0);
        if (p->form == FL_FRAME_RECTANGLE && (!(p->size[0] > 0.0) || !(p->size[1] > 0.0)))
            return fail_beam(k, b, err, "member %lld has a rectangular section without sides above 0", 0);
    }
    return 0;
}

static int is_taper(const fl_beam_section *p, const fl_beam_section *q)
{
    return p->size[0] != q->size[0] || (p->form == FL_FRAME_RECTANGLE && p->size[1] != q->size[1]);
}

/* Axes of a member: y and z across.  Without a vector z is upward, of an upright member along global x. */
static void beam_axes(const fl_beam *b, const fl_vec3 x[2], fl_vec3 *y, fl_vec3 *z)
{
    const fl_vec3 along = v3_unit(v3_sub(x[1], x[0]));
    fl_vec3 ref = b->across;
    if (!(v3_norm(v3_cross(along, ref)) > 1e-9 * v3_norm(ref)))
        ref = v3_norm(v3_cross(along, v3(0, 0, 1))) > 1e-6 ? v3(0, 0, 1) : v3(1, 0, 0);
    *y = v3_unit(v3_cross(ref, along));
    *z = v3_cross(along, *y);
}

/* --- surface -------------------------------------------------------------------------------------------- */

/* A line between nodes of two scopes: elements know one scope only, so both ends get nodes of scope 1. */
static int32_t add_round(fl_beam_deck *k, const fl_beam *b, const fl_vec3 x[2], int32_t part, fl_err *err)
{
    const int own = b->scope[0] || b->scope[1] || v3_nonzero(b->offset[0]) || v3_nonzero(b->offset[1]);
    int64_t node[3] = {b->node[0], b->node[1], b->node[2]};
    const enum fl_shape shape = node[2] > 0 && !own ? FL_LINE3 : FL_LINE2;
    for (int s = 0; s < 2 && own; s++) {
        node[s] = fl_beam_deck_node(k, x[s], err);
        if (node[s] < 0) return -1;
    }
    k->e.file = b->file;
    k->e.line = b->line;
    const int32_t at = fl_elements_add(&k->e, own ? 1 : 0, own ? -1 : b->id, shape, part, node, err);
    if (at < 0) return -1;
    return fl_elements_set_radius(&k->e, at, 0.5 * k->section[b->section[0]].size[0],
                                  0.5 * k->section[b->section[1]].size[0], err)
               ? -1
               : at;
}

static int32_t add_prism(fl_beam_deck *k, const fl_beam *b, const fl_vec3 x[2], int32_t part, fl_err *err)
{
    static const double Y[4] = {-0.5, 0.5, 0.5, -0.5}, Z[4] = {-0.5, -0.5, 0.5, 0.5};
    int64_t node[8];
    fl_vec3 y, z;
    beam_axes(b, x, &y, &z);
    for (int s = 0; s < 2; s++)
        for (int c = 0; c < 4; c++) {
            const double *size = k->section[b->section[s]].size;
            node[4 * s + c] =
                fl_beam_deck_node(k, v3_madd(v3_madd(x[s], Y[c] * size[0], y), Z[c] * size[1], z), err);
            if (node[4 * s + c] < 0) return -1;
        }
    k->e.file = b->file;
    k->e.line = b->line;
    k->prisms++;
    return fl_elements_add(&k->e, 1, -1, FL_HEX8, part, node, err);
}

/* Entries by element, then set. */
static int compare_entries(const void *pa, const void *pb)
{
    const struct fl_beam_set_entry *a = pa, *b = pb;
    if (a->element != b->element) return a->element < b->element ? -1 : 1;
    return a->set < b->set ? -1 : a->set > b->set;
}

/* Sorts the entries of sets and counts the elements of each. */
static int sort_sets(fl_beam_deck *k, fl_err *err)
{
    free(k->set_size);
    k->set_size = fl_alloc(k->set_name.n, sizeof *k->set_size, err);
    if (!k->set_size) return -1;
    if (k->entries) qsort(k->entry, (size_t)k->entries, sizeof *k->entry, compare_entries);
    for (int32_t i = 0; i < k->entries; i++) k->set_size[k->entry[i].set]++;
    return 0;
}

static int32_t first_entry(const fl_beam_deck *k, int64_t element)
{
    int32_t lo = 0, hi = k->entries;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (k->entry[mid].element < element) lo = mid + 1;
        else hi = mid;
    }
    return lo;
}

/* The smallest set that may be a part and holds the element; -1: none. */
static int32_t smallest_set(const fl_beam_deck *k, int64_t element)
{
    int32_t best = -1;
    for (int32_t i = first_entry(k, element); i < k->entries && k->entry[i].element == element; i++) {
        const int32_t set = k->entry[i].set;
        if (k->set_is_part[set] && (best < 0 || k->set_size[set] < k->set_size[best])) best = set;
    }
    return best;
}

/* The part of a member: the smallest set, what its reader or its section says, or its size. */
static int32_t beam_part(fl_beam_deck *k, const fl_beam *b, fl_err *err)
{
    const fl_beam_section *p = &k->section[b->section[0]], *q = &k->section[b->section[1]];
    const int32_t set = smallest_set(k, b->id);
    char name[FL_BEAM_NAME];
    if (set >= 0) return fl_string_table_add(&k->e.parts, k->set_name.name[set], err);
    if (b->part >= 0) return b->part;
    if (p->part[0]) return fl_string_table_add(&k->e.parts, p->part, err);
    if (p->form == FL_FRAME_RECTANGLE) snprintf(name, sizeof name, "%.6gx%.6g", p->size[0], p->size[1]);
    else if (is_taper(p, q)) snprintf(name, sizeof name, "cones");
    else snprintf(name, sizeof name, "D_%.6g", p->size[0]);
    return fl_string_table_add(&k->e.parts, name, err);
}

/* Enters an element of the surface in the sets that hold element `id` of the deck. */
static int pick_sets(fl_beam_deck *k, int32_t element, int64_t id, fl_err *err)
{
    for (int32_t i = first_entry(k, id); i < k->entries && k->entry[i].element == id; i++) {
        const fl_pick pick = {.element = element, .set = k->entry[i].set, .face = FL_PICK_WHOLE};
        if (fl_elements_pick(&k->e, pick, err)) return -1;
    }
    return 0;
}

/* Plates and solids go to their smallest set; all sets can be asked for. */
static int assign_sets(fl_beam_deck *k, const int32_t *of_beam, fl_err *err)
{
    const int named = fl_import_by_name(k->opt);
    for (int32_t i = 0; i < k->set_name.n; i++)
        if (fl_string_table_add(&k->e.sets, k->set_name.name[i], err) < 0) return -1;
    for (int32_t i = 0; i < k->e.element_id.n; i++) {
        if (k->e.element_id.scope[i] != 0 || fl_shape_corners((enum fl_shape)k->e.element[i].shape) < 3)
            continue;
        const int64_t id = k->e.element_id.id[i];
        const int32_t set = smallest_set(k, id);
        const int32_t part = set < 0 ? 0 : fl_string_table_add(&k->e.parts, k->set_name.name[set], err);
        if (part < 0 || (named && pick_sets(k, i, id, err))) return -1;
        if (set >= 0) k->e.element[i].part = part;
    }
    for (int32_t i = 0; named && i < k->beams; i++)
        if (of_beam[i] >= 0 && pick_sets(k, of_beam[i], k->beam[i].id, err)) return -1;
    return 0;
}

/* Lengths of steel structures: a modulus of 2.1e11 Pa says m, one of 2.1e5 MPa mm. */
static void hint_units(const fl_beam_deck *k)
{
    for (int32_t i = 0; i < k->sections; i++) {
        const double e = k->section[i].material.e;
        if (k->opt && k->opt->has_unit) return;
        if (e > 1.5e5 && e < 3e5) {
            fl_bytes_note(k->b, "a modulus of %.3g speaks of N and mm: --unit mm", e);
            return;
        }
    }
}

static int make_surface(fl_beam_deck *k, fl_surface *s, fl_err *err)
{
    int32_t *of_beam = fl_alloc(k->beams, sizeof *of_beam, err);
    int rc = -1;
    double lowest = INFINITY;
    if (!of_beam || sort_sets(k, err)) goto done;
    for (int32_t i = 0; i < k->beams; i++) {
        const fl_beam *b = &k->beam[i];
        const fl_beam_section *p = &k->section[b->section[0]];
        fl_vec3 x[2];
        of_beam[i] = -1;
        if (find_ends(k, b, x, err) || check_sizes(k, b, err)) goto done;
        if (p->form != FL_FRAME_PIPE && p->form != FL_FRAME_RECTANGLE) {
            if (fl_elements_skip(&k->e, p->kind, err)) goto done;
            continue;
        }
        const int32_t part = beam_part(k, b, err);
        if (part < 0) goto done;
        k->tapers += is_taper(p, &k->section[b->section[1]]);
        of_beam[i] = p->form == FL_FRAME_PIPE ? add_round(k, b, x, part, err) : add_prism(k, b, x, part, err);
        if (of_beam[i] < 0) goto done;
    }
    if (assign_sets(k, of_beam, err)) goto done;
    if (k->prisms) fl_bytes_note(k->b, "%d members of rectangular section are prisms", k->prisms);
    if (k->tapers) fl_bytes_note(k->b, "%d members are tapered", k->tapers);
    for (int32_t i = 0; i < k->e.node_id.n; i++) lowest = fmin(lowest, k->e.x[i].z);
    if (lowest >= 0.0 && lowest < INFINITY)
        fl_bytes_note(k->b, "nothing lies below z = 0, where the water is: --translate moves it");
    hint_units(k);
    rc = fl_elements_surface(&k->e, s, k->b, k->opt, err);
done:
    free(of_beam);
    return rc;
}

/* --- frame ---------------------------------------------------------------------------------------------- */

/* The node that stands for node v of the deck, where short members made several one. */
static int32_t common_node(const fl_beam_deck *k, int32_t v)
{
    while (k->same[v] != v) v = k->same[v];
    return v;
}

/* Makes the ends of very short members one node: of a chain of stiff stubs the equations of the frame would
 * be ill conditioned.  Nodes that become one lie within the same bound of the first of them. */
static int join_short_members(fl_beam_deck *k, fl_err *err)
{
    k->same = fl_alloc(k->e.node_id.n, sizeof *k->same, err);
    if (!k->same) return -1;
    for (int32_t v = 0; v < k->e.node_id.n; v++) k->same[v] = v;
    for (int32_t i = 0; i < k->beams; i++) {
        const fl_beam *b = &k->beam[i];
        const fl_beam_section *p = &k->section[b->section[0]];
        int32_t v[2];
        for (int s = 0; s < 2; s++) {
            v[s] = fl_id_map_find(&k->e.node_id, b->scope[s], b->node[s]);
            v[s] = v[s] < 0 || isnan(k->e.x[v[s]].x) ? -1 : common_node(k, v[s]);
        }
        if (p->form != FL_FRAME_PIPE || v[0] < 0 || v[1] < 0 || v[0] == v[1]) continue;
        if (v3_norm(v3_sub(k->e.x[v[1]], k->e.x[v[0]])) < FL_BEAM_SHORT * p->size[0])
            k->same[v[0] > v[1] ? v[0] : v[1]] = v[0] > v[1] ? v[1] : v[0];
    }
    return 0;
}

/* Which of two nodes on rigid links stands for both: one with a mass, else one held, else the first. */
static int is_better_hub(const fl_beam_deck *k, int32_t a, int32_t b)
{
    int rank[2];
    for (int s = 0; s < 2; s++) {
        const int32_t v = s ? b : a,
                      at = fl_id_map_find(&k->frame->node_id, k->e.node_id.scope[v], k->e.node_id.id[v]);
        rank[s] = at < 0 ? 0 : k->frame->node[at].mass > 0.0 ? 2 : k->frame->node[at].fixed != 0;
    }
    return rank[0] != rank[1] ? rank[0] > rank[1] : a < b;
}

static int32_t hub_of(const fl_beam_deck *k, int32_t v)
{
    while (k->hub[v] != v) v = k->hub[v];
    return v;
}

static int join_rigid_links(fl_beam_deck *k, fl_err *err)
{
    k->hub = fl_alloc(k->e.node_id.n, sizeof *k->hub, err);
    if (!k->hub) return -1;
    for (int32_t v = 0; v < k->e.node_id.n; v++) k->hub[v] = v;
    for (int32_t i = 0; i < k->links; i++) {
        int32_t v[2];
        for (int s = 0; s < 2; s++) {
            v[s] = fl_id_map_find(&k->e.node_id, 0, k->link[i][s]);
            v[s] = v[s] < 0 || isnan(k->e.x[v[s]].x) ? -1 : hub_of(k, common_node(k, v[s]));
        }
        if (v[0] < 0 || v[1] < 0) {
            if (fl_frame_count_skipped(k->frame, "rigid links of nodes that are not defined")) return -1;
        } else if (v[0] != v[1]) {
            const int first = is_better_hub(k, v[0], v[1]);
            k->hub[v[first]] = v[!first];
        }
    }
    return 0;
}

/* Supports and masses of nodes that became another one. */
static int move_supports(fl_beam_deck *k, fl_err *err)
{
    for (int32_t i = 0; i < k->frame->node_id.n; i++) {
        const fl_frame_node n = k->frame->node[i];
        const int32_t scope = k->frame->node_id.scope[i];
        const int32_t v = scope > 1 ? -1 : fl_id_map_find(&k->e.node_id, scope, k->frame->node_id.id[i]);
        const int32_t to = v < 0 ? v : hub_of(k, common_node(k, v));
        if (to == v || (n.fixed == 0 && n.mass == 0.0)) continue;
        const int moved = v3_norm(v3_sub(k->e.x[to], k->e.x[v])) > 0.0 && hub_of(k, v) != v;
        if (moved && (n.mass > 0.0 || n.fixed != 63) &&
            fl_frame_count_skipped(k->frame, "lever of masses and partial supports on rigid links"))
            return -1;
        const int32_t at = fl_frame_node_of(k->frame, k->e.node_id.scope[to], k->e.node_id.id[to], err);
        if (at < 0) return -1;
        k->frame->node[at].fixed |= n.fixed;
        k->frame->node[at].mass += n.mass;
        k->frame->node[i].fixed = 0;
        k->frame->node[i].mass = 0.0;
    }
    return 0;
}

static int32_t frame_node(fl_beam_deck *k, int32_t scope, int64_t id, fl_vec3 x, fl_err *err)
{
    const int32_t at = fl_frame_node_of(k->frame, scope, id, err);
    if (at < 0) return -1;
    k->frame->node[at].x = x;
    k->frame->node[at].defined = 1;
    return at;
}

/* A material of those numbers. */
static int32_t frame_material(fl_frame_model *f, const fl_frame_material *m, fl_err *err)
{
    char name[160];
    if (!(m->e > 0.0)) return 0;
    snprintf(name, sizeof name, "E %.17g G %.17g nu %.17g rho %.17g", m->e, m->g, m->nu, m->rho);
    const int32_t at = fl_frame_material_of(f, name, err);
    if (at >= 0) f->material[at] = *m;
    return at;
}

/* The section between two at a share w of the way. */
static fl_frame_section mixed_section(const fl_beam_section *p, const fl_beam_section *q, double w)
{
    fl_frame_section s = {.form = p->form, .material = -1, .a = p->a, .iy = p->iy, .iz = p->iz, .j = p->j};
    const double d = p->size[0] + w * (q->size[0] - p->size[0]),
                 h = p->size[1] + w * (q->size[1] - p->size[1]),
                 t = p->wall[0] + w * (q->wall[0] - p->wall[0]),
                 u = p->wall[1] + w * (q->wall[1] - p->wall[1]);
    s.size[0] = d;
    s.size[1] = p->form == FL_FRAME_PIPE ? (t > 0.0 && t <= 0.5 * d ? t : 0.5 * d) : h;
    if (p->form == FL_FRAME_RECTANGLE && t > 0.0 && u > 0.0 && 2.0 * t < d && 2.0 * u < h)
        s = fl_frame_section_box(h, d, t, u);
    if (s.form == FL_FRAME_GENERAL && p->form == FL_FRAME_RECTANGLE) s.radius = 0.5 * sqrt(d * d + h * h);
    return s;
}

static int32_t frame_section(fl_beam_deck *k, const fl_beam *b, int step, int steps, fl_err *err)
{
    const fl_beam_section *p = &k->section[b->section[0]], *q = &k->section[b->section[1]];
    char name[3 * FL_BEAM_NAME];
    if (steps == 1) snprintf(name, sizeof name, "%s", p->name);
    else snprintf(name, sizeof name, "%s-%s.%d", p->name, q->name, step + 1);
    const int32_t at = fl_frame_section_of(k->frame, name, err);
    const int32_t material = at < 0 ? -1 : frame_material(k->frame, &p->material, err);
    if (material < 0) return -1;
    k->frame->section[at] = mixed_section(p, q, (step + 0.5) / steps);
    k->frame->section[at].material = p->material.e > 0.0 ? material : -1;
    return at;
}

/* Name of the part of a member in a frame: its reader's, its section's, or "members". */
static int32_t frame_part(fl_beam_deck *k, const fl_beam *b, fl_err *err)
{
    const fl_beam_section *p = &k->section[b->section[0]];
    const int32_t set = smallest_set(k, b->id);
    if (set >= 0) return fl_frame_part_of(k->frame, k->set_name.name[set], err);
    return fl_frame_part_of(k->frame,
                            b->part >= 0 ? k->e.parts.name[b->part]
                            : p->part[0] ? p->part
                                         : "members",
                            err);
}

static int frame_beam(fl_beam_deck *k, const fl_beam *b, fl_err *err)
{
    fl_frame_model *f = k->frame;
    const fl_beam_section *p = &k->section[b->section[0]], *q = &k->section[b->section[1]];
    const int steps = is_taper(p, q) ? FL_BEAM_STEPS : 1;
    const fl_vec3 none = v3(0, 0, 0);
    fl_vec3 x[2], y, z;
    if (find_ends(k, b, x, err) || check_sizes(k, b, err)) return -1;
    if (p->form == FL_FRAME_NONE) return fl_frame_count_skipped(f, "%s", p->kind);
    if (steps > 1) fl_frame_count_skipped(f, "tapers; %d steps each are taken", FL_BEAM_STEPS);
    if (b->node[2] > 0) fl_frame_count_skipped(f, "middles of curved members, which run straight");
    beam_axes(b, x, &y, &z);
    int32_t end[2], own_first = -1;
    fl_vec3 at_node[2], offset[2];
    for (int s = 0; s < 2; s++) {
        const int32_t v = common_node(k, fl_id_map_find(&k->e.node_id, b->scope[s], b->node[s]));
        end[s] = hub_of(k, v);
        at_node[s] = k->e.x[end[s]];
        offset[s] = v3_add(b->offset[s], v3_sub(k->e.x[v], at_node[s]));
        x[s] = v3_add(at_node[s], offset[s]);
        if (s == 0) own_first = v;
        else if (end[0] == end[1] && v != own_first)
            return fl_frame_count_skipped(f, "members between nodes of one rigid link");
    }
    if (end[0] == end[1])
        return fl_frame_count_skipped(f, "members shorter than %g of their diameter, whose ends are one node",
                                      FL_BEAM_SHORT);
    int32_t from = frame_node(k, k->e.node_id.scope[end[0]], k->e.node_id.id[end[0]], at_node[0], err);
    const int32_t part = frame_part(k, b, err);
    for (int step = 0; step < steps; step++) {
        const int last = step == steps - 1;
        const fl_vec3 at = v3_madd(x[0], (step + 1.0) / steps, v3_sub(x[1], x[0]));
        const int32_t scope = steps > 1 ? b->piece * FL_BEAM_STEPS + step + 1 : b->piece;
        const int32_t to =
            last ? frame_node(k, k->e.node_id.scope[end[1]], k->e.node_id.id[end[1]], at_node[1], err)
                 : frame_node(k, scope + 1, b->id, at, err);
        const int32_t section = frame_section(k, b, step, steps, err);
        const int32_t i = fl_frame_element_of(f, scope, b->id, err);
        if (from < 0 || to < 0 || part < 0 || section < 0 || i < 0) return -1;
        f->element[i] = (fl_frame_element){.node = {from, to},
                                           .section = section,
                                           .part = part,
                                           .truss = b->truss,
                                           .has_z = p->form != FL_FRAME_PIPE,
                                           .across = z,
                                           .offset = {step ? none : offset[0], last ? offset[1] : none},
                                           .pins = {step ? 0u : b->pins[0], last ? b->pins[1] : 0u},
                                           .id = b->id};
        from = to;
    }
    return 0;
}

static int make_frame(fl_beam_deck *k, fl_err *err)
{
    if (sort_sets(k, err) || join_short_members(k, err) || join_rigid_links(k, err)) return -1;
    for (int32_t i = 0; i < k->beams; i++)
        if (frame_beam(k, &k->beam[i], err)) return -1;
    for (int32_t i = 0; i < k->e.element_id.n; i++)
        fl_frame_count_skipped(k->frame, "%s", fl_shape_name((enum fl_shape)k->e.element[i].shape));
    for (int32_t i = 0; i < k->frame->node_id.n; i++) {
        const int32_t at = fl_id_map_find(&k->e.node_id, 0, k->frame->node_id.id[i]);
        if (k->frame->node[i].defined || at < 0 || isnan(k->e.x[at].x)) continue;
        k->frame->node[i].x = k->e.x[at];
        k->frame->node[i].defined = 1;
    }
    return move_supports(k, err);
}

int fl_beam_deck_finish(fl_beam_deck *k, fl_surface *s, fl_err *err)
{
    return k->frame ? make_frame(k, err) : make_surface(k, s, err);
}

void fl_beam_deck_free(fl_beam_deck *k)
{
    fl_deck_free(&k->d);
    fl_elements_free(&k->e);
    fl_string_table_free(&k->set_name);
    free(k->beam);
    free(k->section);
    free(k->entry);
    free(k->set_is_part);
    free(k->set_size);
    free(k->same);
    free(k->hub);
    free(k->link);
    *k = (fl_beam_deck){0};
}
