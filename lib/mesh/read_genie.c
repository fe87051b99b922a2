/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh/read_genie.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "mesh/beam_deck.h"

typedef struct {
    char form[FL_BEAM_NAME]; /* tag of the section */
    double size[2], wall[2];
} genie_section;

typedef struct {
    int32_t section, material, beam; /* section: in section_name, -1 none */
    fl_vec3 end[2];
    int ends;
    int32_t line;
} genie_segment;

typedef struct {
    fl_beam_deck k;
    const char *tag; /* the current one, behind its <; [n] */
    size_t n;
    fl_string_table section_name, material_name, beam_name, node_name;
    genie_section *section;
    fl_frame_material *material;
    genie_segment *segment;
    int32_t section_now, material_now, beam_now, segments, section_cap, material_cap, segment_cap;
    int32_t plates, offsets;
    double length; /* metres in a unit */
} genie_reader;

int fl_genie_is(const fl_bytes *b)
{
    const char *p = b->data + strspn(b->data, " \t\r\n");
    return *p == '<' && strstr(p, "<DNV_structure_concept_protocol") != NULL;
}

/* --- tags ----------------------------------------------------------------------------------------------- */

static int is_tag(const genie_reader *r, const char *name)
{
    const size_t n = strlen(name);
    return r->n >= n && strncmp(r->tag, name, n) == 0 && (r->n == n || strchr(" \t\r\n/", r->tag[n]) != NULL);
}

/* Attribute of the tag; "" if it is not there. */
static const char *tag_text(const genie_reader *r, const char *key, char value[FL_BEAM_NAME])
{
    const size_t n = strlen(key);
    const char *end = r->tag + r->n;
    value[0] = '\0';
    for (const char *p = r->tag; p + n + 2 < end; p++) {
        if (*p == '"') { /* over the value of another attribute */
            const char *q = memchr(p + 1, '"', (size_t)(end - p - 1));
            if (!q) break;
            p = q;
            continue;
        }
        if (!strchr(" \t\r\n", *p) || strncmp(p + 1, key, n) != 0 || p[n + 1] != '=' || p[n + 2] != '"')
            continue;
        const char *v = p + n + 3, *q = v < end ? memchr(v, '"', (size_t)(end - v)) : NULL;
        const size_t len = q ? (size_t)(q - v) : 0;
        snprintf(value, FL_BEAM_NAME, "%.*s", len < FL_BEAM_NAME ? (int)len : FL_BEAM_NAME - 1, v);
        break;
    }
    return value;
}

static int tag_real(const genie_reader *r, const char *key, double *x, fl_err *err)
{
    char value[FL_BEAM_NAME];
    if (fl_deck_real(tag_text(r, key, value), x) == 0) return 0;
    return fl_elements_fail(&r->k.e, 0, r->k.e.line, err, "%s of <%.30s> is \"%.40s\", a number is expected",
                            key, r->tag, value);
}

/* --- sections and materials ----------------------------------------------------------------------------- */

static int open_section(genie_reader *r, fl_err *err)
{
    char name[FL_BEAM_NAME];
    r->section_now = fl_string_table_add(&r->section_name, tag_text(r, "name", name), err);
    if (r->section_now < 0 ||
        fl_grow(&r->section, &r->section_cap, r->section_name.n, sizeof *r->section, err))
        return -1;
    r->section[r->section_now] = (genie_section){0};
    return 0;
}

/* The first tag within a section is its form. */
static int read_form(genie_reader *r, fl_err *err)
{
    genie_section *s = &r->section[r->section_now];
    size_t n = strcspn(r->tag, " \t\r\n/>");
    if (n >= FL_BEAM_NAME) n = FL_BEAM_NAME - 1;
    memcpy(s->form, r->tag, n);
    s->form[n] = '\0';
    r->section_now = -1;
    if (strcmp(s->form, "pipe_section") == 0) {
        if (tag_real(r, "od", &s->size[0], err) || tag_real(r, "th", &s->wall[0], err)) return -1;
    } else if (strcmp(s->form, "box_section") == 0 || strcmp(s->form, "bar_section") == 0) {
        double top, bottom;
        if (tag_real(r, "h", &s->size[1], err) || tag_real(r, "b", &s->size[0], err)) return -1;
        if (strcmp(s->form, "bar_section") == 0) return 0; /* solid */
        if (tag_real(r, "tw", &s->wall[0], err) || tag_real(r, "tftop", &top, err) ||
            tag_real(r, "tfbot", &bottom, err))
            return -1;
        s->wall[1] = 0.5 * (top + bottom);
        return 0;
    } else {
        return 0;
    }
    if (s->size[0] > 0.0) return 0;
    return fl_elements_fail(&r->k.e, 0, r->k.e.line, err, "the diameter is %g, a length above 0 is expected",
                            s->size[0]);
}

static int open_material(genie_reader *r, fl_err *err)
{
    char name[FL_BEAM_NAME];
    r->material_now = fl_string_table_add(&r->material_name, tag_text(r, "name", name), err);
    if (r->material_now < 0 ||
        fl_grow(&r->material, &r->material_cap, r->material_name.n, sizeof *r->material, err))
        return -1;
    r->material[r->material_now] = (fl_frame_material){0};
    return 0;
}

static int read_moduli(genie_reader *r, fl_err *err)
{
    fl_frame_material *m = &r->material[r->material_now];
    r->material_now = -1;
    return tag_real(r, "youngs_modulus", &m->e, err) || tag_real(r, "poissons_ratio", &m->nu, err) ||
                   tag_real(r, "density", &m->rho, err)
               ? -1
               : 0;
}

static int read_length(genie_reader *r, fl_err *err)
{
    static const struct {
        const char *name;
        double metres;
    } UNIT[] = {{"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"ft", 0.3048}, {"in", 0.0254}, {"inch", 0.0254}};
    char unit[FL_BEAM_NAME];
    tag_text(r, "length", unit);
    for (size_t k = 0; k < sizeof UNIT / sizeof *UNIT; k++)
        if (strcmp(UNIT[k].name, unit) == 0) {
            r->length = UNIT[k].metres;
            if (k) fl_bytes_note(r->k.b, "lengths in %s were converted to metres; moduli are left out", unit);
            return 0;
        }
    return fl_elements_fail(&r->k.e, 0, r->k.e.line, err,
                            "the length of model_units is \"%.20s\", one of m mm cm ft in is expected", unit);
}

/* --- beams ---------------------------------------------------------------------------------------------- */

static int open_segment(genie_reader *r, fl_err *err)
{
    char name[FL_BEAM_NAME];
    genie_segment g = {.section = -1, .material = -1, .beam = r->beam_now, .line = r->k.e.line};
    if (r->beam_now < 0) return 0;
    if (*tag_text(r, "section_ref", name)) {
        g.section = fl_string_table_find(&r->section_name, name);
        if (g.section < 0)
            return fl_elements_fail(&r->k.e, 0, r->k.e.line, err,
                                    "beam \"%.40s\" has section \"%.40s\", which is not defined",
                                    r->beam_name.name[r->beam_now], name);
    }
    if (*tag_text(r, "material_ref", name)) g.material = fl_string_table_find(&r->material_name, name);
    if (fl_grow(&r->segment, &r->segment_cap, (int64_t)r->segments + 1, sizeof *r->segment, err)) return -1;
    r->segment[r->segments++] = g;
    return 0;
}

static int read_position(genie_reader *r, fl_err *err)
{
    genie_segment *g = r->segments ? &r->segment[r->segments - 1] : NULL;
    char end[FL_BEAM_NAME];
    double x[3];
    if (!g || r->beam_now < 0 || !*tag_text(r, "end", end)) return 0;
    if (tag_real(r, "x", &x[0], err) || tag_real(r, "y", &x[1], err) || tag_real(r, "z", &x[2], err))
        return -1;
    const int k = end[0] == '2';
    g->end[k] = v3(r->length * x[0], r->length * x[1], r->length * x[2]);
    g->ends |= 1 << k;
    return 0;
}

/* --- the model ------------------------------------------------------------------------------------------ */

static int process_genie_tag(genie_reader *r, fl_err *err)
{
    char name[FL_BEAM_NAME];
    if (is_tag(r, "model_units")) return read_length(r, err);
    if (is_tag(r, "section")) return open_section(r, err);
    if (is_tag(r, "material")) return open_material(r, err);
    if (is_tag(r, "isotropic_linear_material") && r->material_now >= 0) return read_moduli(r, err);
    if (is_tag(r, "straight_beam")) {
        r->beam_now = fl_string_table_add(&r->beam_name, tag_text(r, "name", name), err);
        return r->beam_now < 0 ? -1 : 0;
    }
    if (is_tag(r, "/straight_beam")) r->beam_now = -1;
    if (is_tag(r, "straight_segment")) return open_segment(r, err);
    if (is_tag(r, "position")) return read_position(r, err);
    if (is_tag(r, "curved_beam")) return fl_beam_deck_skip(&r->k, "curved_beam", err);
    if (is_tag(r, "flat_plate") || is_tag(r, "curved_shell")) {
        r->plates++;
        return fl_beam_deck_skip(&r->k, is_tag(r, "flat_plate") ? "flat_plate" : "curved_shell", err);
    }
    r->offsets += is_tag(r, "curve_offset");
    if (r->section_now >= 0 && *r->tag != '/' && *r->tag != '!') return read_form(r, err);
    return 0;
}

static int read_model(genie_reader *r, fl_err *err)
{
    const char *p = r->k.b->data, *line = p;
    r->k.e.line = 1;
    while ((p = strchr(p, '<')) != NULL) {
        const char *end = strchr(++p, '>');
        if (!end) break;
        for (; line < p; line++) r->k.e.line += *line == '\n';
        r->tag = p;
        r->n = (size_t)(end - p);
        if (process_genie_tag(r, err)) return -1;
        p = end;
    }
    return 0;
}

/* Number of the node at x: ends at the same place are one. */
static int64_t node_at(genie_reader *r, fl_vec3 x, fl_err *err)
{
    char key[100];
    const int32_t had = r->node_name.n;
    snprintf(key, sizeof key, "%.17g %.17g %.17g", x.x + 0.0, x.y + 0.0, x.z + 0.0);
    const int32_t at = fl_string_table_add(&r->node_name, key, err);
    if (at < 0 || (at == had && fl_elements_add_node(&r->k.e, 0, at + 1, x, err) < 0)) return -1;
    return at + (int64_t)1;
}

static int is_cone(const genie_reader *r, const genie_segment *g)
{
    return g->section >= 0 && strcmp(r->section[g->section].form, "cone_section") == 0;
}

static int is_pipe(const genie_reader *r, const genie_segment *g)
{
    return g->section >= 0 && strcmp(r->section[g->section].form, "pipe_section") == 0;
}

/* Section of one end of segment i, which is that of segment `of`. */
static int32_t section_at(genie_reader *r, int32_t i, int32_t of, fl_err *err)
{
    const genie_segment *g = &r->segment[of];
    const genie_section *f = g->section >= 0 ? &r->section[g->section] : NULL;
    fl_beam_section s = {.form = FL_FRAME_NONE};
    snprintf(s.kind, sizeof s.kind, "%s", f ? f->form : "segment without a section");
    if (f && is_pipe(r, g)) s.form = FL_FRAME_PIPE;
    else if (f && (strcmp(f->form, "box_section") == 0 || strcmp(f->form, "bar_section") == 0))
        s.form = FL_FRAME_RECTANGLE;
    else if (f && is_cone(r, g)) snprintf(s.kind, sizeof s.kind, "cone between sections that are no pipes");
    for (int c = 0; f && c < 2; c++) s.size[c] = r->length * f->size[c], s.wall[c] = r->length * f->wall[c];
    const int32_t m = r->segment[i].material;
    if (m >= 0 && r->length == 1.0) s.material = r->material[m];
    snprintf(s.name, sizeof s.name, "s%d%s", (int)i + 1, of > i ? "_end" : of < i ? "_start" : "");
    return fl_beam_deck_section(&r->k, &s, err);
}

static int add_segment(genie_reader *r, int32_t i, fl_err *err)
{
    const genie_segment *g = &r->segment[i];
    fl_beam b = {.id = i + 1};
    int32_t from = i, to = i;
    r->k.e.line = g->line;
    if (g->ends != 3)
        return fl_elements_fail(&r->k.e, 0, g->line, err, "a segment of beam \"%.40s\" lacks an end",
                                r->beam_name.name[g->beam]);
    if (is_cone(r, g)) {
        if (i > 0 && r->segment[i - 1].beam == g->beam && is_pipe(r, g - 1)) from = i - 1;
        if (i + 1 < r->segments && r->segment[i + 1].beam == g->beam && is_pipe(r, g + 1)) to = i + 1;
        if (from == i) from = to;
        if (to == i) to = from;
    }
    if ((b.part = fl_string_table_add(&r->k.e.parts, r->beam_name.name[g->beam], err)) < 0) return -1;
    for (int s = 0; s < 2; s++)
        if ((b.node[s] = node_at(r, g->end[s], err)) < 1) return -1;
    if ((b.section[0] = section_at(r, i, from, err)) < 0) return -1;
    b.section[1] = from == to ? b.section[0] : section_at(r, i, to, err);
    return b.section[1] < 0 || fl_beam_deck_add(&r->k, &b, err) < 0 ? -1 : 0;
}

int fl_genie_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    genie_reader r = {.section_now = -1, .material_now = -1, .beam_now = -1, .length = 1.0};
    int rc = -1;
    (void)name; /* a beam is a part */
    if (fl_beam_deck_start(&r.k, b, opt, err)) return -1;
    if (read_model(&r, err)) goto done;
    for (int32_t i = 0; i < r.segments; i++)
        if (add_segment(&r, i, err)) goto done;
    if (r.plates)
        fl_bytes_note(b, "%d plates lie in ACIS geometry: export the FEM file from GeniE", r.plates);
    if (r.offsets) fl_bytes_note(b, "%d offsets of curves were ignored", r.offsets);
    rc = fl_beam_deck_finish(&r.k, s, err);
done:
    fl_beam_deck_free(&r.k);
    fl_string_table_free(&r.section_name);
    fl_string_table_free(&r.material_name);
    fl_string_table_free(&r.beam_name);
    fl_string_table_free(&r.node_name);
    free(r.section), free(r.material), free(r.segment);
    return rc;
}
