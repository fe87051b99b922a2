/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "member/member_import.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"

enum { NAME = 100 };

typedef struct {
    fl_member_model *m;
    fl_frame_model *f;
    double l; /* length of the deck in metres */
    fl_vec3 shift;
    int32_t *node;    /* [nodes of f] number in m, -1 */
    int32_t *section; /* [2 sections of f] of beams, of trusses; -1 not made, -2 has none */
} importer;

static void valid_name(char to[NAME], const char *from)
{
    size_t n = 0;
    for (; from[n] && n + 1 < NAME; n++)
        to[n] = isgraph((unsigned char)from[n]) && from[n] != '#' ? from[n] : '_';
    if (n == 0) to[n++] = 's';
    to[n] = '\0';
}

static int32_t import_node(importer *u, int32_t k, fl_err *err)
{
    const fl_frame_node *n = &u->f->node[k];
    const int32_t scope = u->f->node_id.scope ? u->f->node_id.scope[k] : 0;
    const long long id = u->f->node_id.id[k];
    char name[NAME];
    if (u->node[k] >= 0) return u->node[k];
    if (!n->defined)
        return fl_fail(err, FL_INPUT, "%s: node %lld is used by an element and not defined", u->m->file, id);
    if (scope > 0) snprintf(name, sizeof name, "n%d.%lld", (int)scope, id);
    else snprintf(name, sizeof name, "n%lld", id);
    const int32_t at = fl_string_table_add(&u->m->node_name, name, err);
    if (at < 0 || fl_grow(&u->m->node, &u->m->node_cap, (int64_t)at + 1, sizeof *u->m->node, err)) return -1;
    u->m->node[at] = (fl_member_node){.x = v3_add(v3_scale(u->l, n->x), u->shift),
                                      .fixed = n->fixed,
                                      .mass = n->mass / u->l,
                                      .force = n->force,
                                      .moment = v3_scale(u->l, n->moment)};
    return u->node[k] = at;
}

/* Constants of a section in metres; 0 where the deck has none. */
static int make_section(importer *u, const fl_frame_section *s, int truss, const char *name,
                        fl_member_section *out)
{
    const double l = u->l, l2 = l * l;
    const fl_frame_material none = {0}, *m = s->material >= 0 ? &u->f->material[s->material] : &none;
    const double e = m->e / l2, g = (m->g > 0.0 ? m->g : 0.5 * m->e / (1.0 + m->nu)) / l2,
                 rho = m->rho / (l2 * l2), more = s->other_mass / l2;
    if (s->form == FL_FRAME_NONE || !(e > 0.0)) return 0;
    const double x = l * s->size[0], y = l * s->size[1];
    if (s->form == FL_FRAME_PIPE && (!(x > 0.0) || !(y > 0.0) || !(y <= 0.5 * x))) return 0;
    if (s->form == FL_FRAME_RECTANGLE && (!(x > 0.0) || !(y > 0.0))) return 0;
    if (s->form == FL_FRAME_PIPE) *out = fl_member_section_pipe(x, y, e, g, rho);
    if (s->form == FL_FRAME_RECTANGLE) *out = fl_member_section_rectangle(x, y, e, g, rho);
    if (s->form == FL_FRAME_GENERAL) {
        const double a = s->a * l2, l4 = l2 * l2;
        if (!(a > 0.0)) return 0;
        double iy = s->iy, iz = s->iz, j = s->j;
        if (truss) {
            *out = fl_member_section_bar(a, e, rho + more / a);
            return 1;
        }
        if (!(iy > 0.0) || !(iz > 0.0)) {
            fl_frame_count_skipped(u->f, "section %s has no second moment of area: its elements are left out",
                                   name);
            return 0;
        }
        if (!(j > 0.0)) {
            fl_frame_count_skipped(u->f, "section %s has no torsion constant: Iy + Iz is taken", name);
            j = iy + iz;
        }
        *out = (fl_member_section){.ea = e * a,
                                   .eiy = e * iy * l4,
                                   .eiz = e * iz * l4,
                                   .gj = g * j * l4,
                                   .mass = rho * a + more,
                                   .radius = l * s->radius};
        return 1;
    }
    if (truss) {
        *out = fl_member_section_bar(out->ea / e, e, rho + more * e / out->ea);
    } else if (more > 0.0) { /* a form has no further mass: its constants */
        out->mass += more;
        out->form = FL_MEMBER_GENERAL;
    }
    return 1;
}

static int32_t import_section(importer *u, int32_t k, int truss, fl_err *err)
{
    char name[NAME], whole[NAME + 8];
    if (u->section[2 * k + truss] != -1) return u->section[2 * k + truss];
    valid_name(name, u->f->section_name.name[k]);
    fl_member_section s = {0};
    if (!make_section(u, &u->f->section[k], truss, name, &s)) return u->section[2 * k + truss] = -2;
    snprintf(whole, sizeof whole, "%s%s", name, truss ? ".bar" : "");
    const int32_t had = u->m->section_name.n;
    int32_t at = fl_string_table_add(&u->m->section_name, whole, err);
    for (int again = 2; at >= 0 && u->m->section_name.n == had; again++) { /* names that differ in blanks */
        snprintf(whole, sizeof whole, "%.90s_%d", name, again);
        at = fl_string_table_add(&u->m->section_name, whole, err);
    }
    if (at < 0 || fl_grow(&u->m->section, &u->m->section_cap, (int64_t)at + 1, sizeof *u->m->section, err))
        return -3;
    u->m->section[at] = s;
    return u->section[2 * k + truss] = at;
}

static int import_element(importer *u, const fl_frame_element *e, int32_t scope, int32_t pieces, fl_err *err)
{
    fl_member b = {.pieces = e->truss ? 1 : pieces};
    char name[NAME];
    if (e->section < 0) return fl_frame_count_skipped(u->f, "elements without a section");
    b.section = import_section(u, e->section, e->truss, err);
    if (b.section == -3) return -1;
    if (b.section == -2)
        return fl_frame_count_skipped(u->f, "elements of section %s, which has no area or material",
                                      u->f->section_name.name[e->section]);
    const fl_vec3 chord = v3_sub(v3_add(u->f->node[e->node[1]].x, e->offset[1]),
                                 v3_add(u->f->node[e->node[0]].x, e->offset[0]));
    if (v3_norm(chord) == 0.0) return fl_frame_count_skipped(u->f, "elements without length");
    for (int s = 0; s < 2; s++) {
        if ((b.end[s] = import_node(u, e->node[s], err)) < 0) return -1;
        b.arm[s] = v3_scale(u->l, e->offset[s]);
        const unsigned bends = e->pins[s] & 6u;
        b.released[s] = e->truss || bends == 6u;
        if (bends != 0u && bends != 6u && fl_frame_count_skipped(u->f, "releases of one bending moment"))
            return -1;
        if (bends == 6u && !(e->pins[s] & 1u) &&
            fl_frame_count_skipped(u->f, "torsion at a hinge, which its member does not transmit here"))
            return -1;
        if (bends == 0u && e->pins[s] && fl_frame_count_skipped(u->f, "releases of torsion alone")) return -1;
    }
    if (!e->truss && (e->has_y || e->has_z)) {
        const fl_vec3 along = v3_unit(chord);
        const fl_vec3 z = e->has_z ? e->across : v3_cross(along, e->across);
        const double size = v3_norm(z);
        if (v3_norm(v3_cross(along, z)) > 1e-6 * v3_norm(e->across)) {
            b.has_ref = 1;
            b.ref = v3_scale(1.0 / size, z);
        } else if (fl_frame_count_skipped(u->f,
                                          "orientations along their element; the standard one is taken")) {
            return -1;
        }
    }
    if (scope > 0) snprintf(name, sizeof name, "e%d.%lld", (int)scope, (long long)e->id);
    else snprintf(name, sizeof name, "e%lld", (long long)e->id);
    const int32_t k = fl_string_table_add(&u->m->member_name, name, err);
    char part[NAME];
    valid_name(part, u->f->part_name.name[e->part]); /* a part is there once it has a member */
    if ((b.part = fl_string_table_add(&u->m->part_name, part, err)) < 0) return -1;
    if (k < 0 || fl_grow(&u->m->member, &u->m->member_cap, (int64_t)k + 1, sizeof *u->m->member, err))
        return -1;
    u->m->member[k] = b;
    return 0;
}

static int import_all(importer *u, int32_t pieces, fl_err *err)
{
    fl_frame_model *f = u->f;
    for (int32_t p = 0; p < f->part_name.n; p++) {
        for (int32_t k = 0; k < f->element_id.n; k++) {
            const fl_frame_element *e = &f->element[k];
            if (e->part != p || e->node[0] < 0 || e->node[1] < 0) continue;
            if (import_element(u, e, f->element_id.scope ? f->element_id.scope[k] : 0, pieces, err))
                return -1;
        }
    }
    for (int32_t k = 0; k < f->node_id.n; k++) {
        const fl_frame_node *n = &f->node[k];
        if (u->node[k] < 0 && (n->mass > 0.0 || v3_nonzero(n->force) || v3_nonzero(n->moment)) &&
            fl_frame_count_skipped(f, "masses and loads of nodes that no member ends at"))
            return -1;
    }
    return 0;
}

int fl_member_import(fl_member_model *m, fl_frame_model *f, int32_t pieces, double length, fl_vec3 shift,
                     const char *file, fl_err *err)
{
    importer u = {.m = m, .f = f, .l = length, .shift = shift};
    *m = (fl_member_model){0};
    m->file = fl_alloc_text(file, err);
    u.node = fl_alloc(f->node_id.n, sizeof *u.node, err);
    u.section = fl_alloc(2 * (int64_t)f->section_name.n, sizeof *u.section, err);
    for (int32_t k = 0; k < f->node_id.n && u.node; k++) u.node[k] = -1;
    for (int32_t k = 0; k < 2 * f->section_name.n && u.section; k++) u.section[k] = -1;
    int rc = err->code ? -1 : import_all(&u, pieces, err);
    if (rc == 0 && f->extra_supports && fl_frame_count_skipped(f, "supports of sets besides the first"))
        rc = -1;
    if (rc == 0 && f->extra_loads && fl_frame_count_skipped(f, "loads of sets besides the first")) rc = -1;
    if (rc == 0 && f->failed) rc = fl_fail(err, FL_SYSTEM, "%s: out of memory", file);
    if (rc == 0 && m->member_name.n == 0)
        rc = fl_fail(
            err, FL_INPUT,
            "%s: no beam or truss with a section and a modulus of elasticity: a deck that states them is "
            "expected",
            file);
    free(u.node), free(u.section);
    if (rc) fl_member_model_free(m);
    return rc;
}
