/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "geom/mesh_patch.h"
#include "geom/mirror_half.h"
#include "geom/raise_deck.h"
#include "geom/weld.h"
#include "member/member_import.h"
#include "mesh/gstruct.h"
#include "mesh/read_mesh.h"
#include "support/fuzz.h"
#include "support/mesh.h"

static int finite3(fl_vec3 x) { return isfinite(x.x) && isfinite(x.y) && isfinite(x.z); }

static int part_is_valid(const fl_part *p)
{
    if (!p->name || !*p->name || *p->name == '#' || p->id < 0 || (p->nt == 0 && p->nc == 0)) return 0;
    for (const char *c = p->name; *c; c++)
        if ((unsigned char)*c <= ' ') return 0;
    for (int32_t v = 0; v < p->nv; v++)
        if (!finite3(p->v[v])) return 0;
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++)
            if (p->t[t].v[k] < 0 || p->t[t].v[k] >= p->nv) return 0;
    for (int32_t c = 0; c < p->nc; c++) {
        const fl_cone *q = &p->cone[c];
        if (!finite3(q->p0) || !finite3(q->p1) || !(q->r0 >= 0.0 && q->r1 >= 0.0 && q->r0 + q->r1 > 0.0))
            return 0;
    }
    return 1;
}

int mesh_sound(const fl_surface *s)
{
    for (int32_t i = 0; i < s->n; i++)
        if (!part_is_valid(&s->part[i])) return 0;
    return s->n > 0;
}

static int same3(fl_vec3 a, fl_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static int part_same(const fl_part *p, const fl_part *q)
{
    if (p->nv != q->nv || p->nt != q->nt || p->nc != q->nc || p->id != q->id || strcmp(p->name, q->name) != 0)
        return 0;
    for (int32_t v = 0; v < p->nv; v++)
        if (!same3(p->v[v], q->v[v])) return 0;
    for (int32_t t = 0; t < p->nt; t++)
        if (memcmp(&p->t[t], &q->t[t], sizeof p->t[t]) != 0) return 0;
    for (int32_t c = 0; c < p->nc; c++) {
        const fl_cone *a = &p->cone[c], *b = &q->cone[c];
        if (!same3(a->p0, b->p0) || !same3(a->p1, b->p1) || a->r0 != b->r0 || a->r1 != b->r1) return 0;
    }
    return 1;
}

int mesh_same(const fl_surface *a, const fl_surface *b)
{
    if (a->n != b->n) return 0;
    for (int32_t i = 0; i < a->n; i++)
        if (!part_same(&a->part[i], &b->part[i])) return 0;
    return 1;
}

/* Writes s as text and reads it again: FUZZ_READ when the same surface came back. */
static int round_trip(const fl_surface *s, fl_err *err)
{
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    fl_surface again = {0};
    fl_history_line by;
    int rc;
    if (!f) return FUZZ_SYSTEM;
    fl_history_line_start(&by, "mesh-fuzz");
    fl_gstruct_write(f, s, &by);
    if (fclose(f) != 0) return FUZZ_SYSTEM;
    rc = fl_gstruct_read(&again, fuzz_file((const unsigned char *)text, n), err);
    free(text);
    if (rc) return fuzz_verdict(rc, err) == FUZZ_SYSTEM ? FUZZ_SYSTEM : FUZZ_BROKEN;
    rc = mesh_same(s, &again) ? FUZZ_READ : FUZZ_BROKEN;
    fl_surface_free(&again);
    return rc;
}

/* Welding may refuse a part that is too large to measure; no other step may fail. */
static int weld_and_orient(fl_part *p, fl_err *err)
{
    fl_mesh_quality q;
    fl_orient_counts o;
    fl_weld w;
    if (fl_part_weld(p, -1.0, &w, err) || fl_part_orient(p, &q, &o, err) || fl_part_measure(p, &q, err))
        return -1;
    return q.inverted == 0 && q.incoherent <= 3 * o.one_sided * (int64_t)p->nt ? 0 : 1;
}

/* The same bytes with a small read window: the format may then not be recognised, but a surface that is
 * read is valid. */
static int read_with_small_window(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_surface s = {0};
    char note[FL_MESH_NOTE];
    int verdict;
    fl_bytes_set_window(64 + (int32_t)(n % 512));
    verdict = fuzz_verdict(fl_mesh_read(&s, fuzz_file(data, n), NULL, note, &err), &err);
    fl_bytes_set_window(0);
    if (verdict == FUZZ_READ && !mesh_sound(&s)) verdict = FUZZ_BROKEN;
    fl_surface_free(&s);
    return verdict == FUZZ_REFUSED ? FUZZ_READ : verdict;
}

int mesh_fuzz(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_surface s = {0};
    char note[FL_MESH_NOTE];
    int verdict, rc = fl_mesh_read(&s, fuzz_file(data, n), NULL, note, &err);
    verdict = fuzz_verdict(rc, &err);
    if (verdict == FUZZ_READ && !mesh_sound(&s)) verdict = FUZZ_BROKEN;
    if (verdict != FUZZ_READ && s.n) verdict = FUZZ_BROKEN;
    if (verdict == FUZZ_READ) verdict = read_with_small_window(data, n);
    for (int32_t i = 0; i < s.n && verdict == FUZZ_READ; i++) {
        rc = weld_and_orient(&s.part[i], &err);
        verdict = rc > 0 ? FUZZ_BROKEN : fuzz_verdict(rc, &err);
        if (verdict == FUZZ_READ && s.part[i].nt == 0 && s.part[i].nc == 0)
            goto done; /* all triangles degenerate */
    }
    if (verdict == FUZZ_READ) verdict = round_trip(&s, &err);
done:
    fl_surface_free(&s);
    return verdict;
}

int mesh_fuzz_all(const unsigned char *data, size_t n)
{
    const char *const pattern[] = {"*"};
    fl_string_table seen = {0};
    fl_import_options w = {.pattern = pattern, .patterns = 1, .available = &seen, .subdivide = 1};
    fl_err err = {0};
    fl_surface s = {0};
    char note[FL_MESH_NOTE];
    int verdict = mesh_fuzz(data, n);
    if (verdict != FUZZ_READ) return verdict;
    verdict = fuzz_verdict(fl_mesh_read(&s, fuzz_file(data, n), &w, note, &err), &err);
    if (verdict == FUZZ_READ && s.n && !mesh_sound(&s)) verdict = FUZZ_BROKEN;
    if (verdict != FUZZ_READ && s.n) verdict = FUZZ_BROKEN;
    fl_surface_free(&s);
    fl_string_table_free(&seen);
    return verdict;
}

/* 0, 1 if the part is broken, -1. */
static int mirror_and_raise(fl_part *p, fl_err *err)
{
    fl_mesh_quality before, after;
    fl_orient_counts o;
    fl_deck_counts did;
    fl_weld w;
    int32_t crosses;
    if (p->nt == 0 || p->nt > 100000) return 0;
    if (fl_part_mirror_half(p, 0, 0.0, &crosses, err) || fl_part_weld(p, -1.0, &w, err)) return -1;
    if (fl_part_orient(p, &before, &o, err) || fl_part_measure(p, &before, err)) return -1;
    if (fl_part_raise_deck(p, 1.0, &did, err) || fl_part_measure(p, &after, err)) return -1;
    if (p->nt && !part_is_valid(p)) return 1;
    return did.rims && did.lids == 0 && before.branched == 0 && after.open > before.open;
}

int mesh_fuzz_hulls(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_surface s = {0};
    char note[FL_MESH_NOTE];
    int verdict = mesh_fuzz_all(data, n);
    if (verdict != FUZZ_READ) return verdict;
    verdict = fuzz_verdict(fl_mesh_read(&s, fuzz_file(data, n), NULL, note, &err), &err);
    for (int32_t i = 0; i < s.n && verdict == FUZZ_READ; i++) {
        const int rc = mirror_and_raise(&s.part[i], &err);
        verdict = rc > 0 ? FUZZ_BROKEN : fuzz_verdict(rc, &err);
        if (verdict == FUZZ_REFUSED) { /* too large to weld */
            err = (fl_err){0};
            verdict = FUZZ_READ;
        }
    }
    fl_surface_free(&s);
    return verdict;
}

int mesh_fuzz_members(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_surface s = {0};
    fl_frame_model f = {0};
    fl_member_model m = {0};
    fl_import_options opt = {.frame = &f};
    char note[FL_MESH_NOTE];
    const int verdict = mesh_fuzz_all(data, n);
    if (verdict == FUZZ_BROKEN || verdict == FUZZ_SYSTEM) return verdict;
    const int rc = fl_mesh_read(&s, fuzz_file(data, n), &opt, note, &err) ||
                           fl_member_import(&m, &f, 3, 1.0, (fl_vec3){0, 0, 0}, "deck", &err)
                       ? -1
                       : 0;
    int framed = fuzz_verdict(rc, &err);
    if ((framed == FUZZ_READ) != (m.member_name.n > 0)) framed = FUZZ_BROKEN;
    fl_surface_free(&s);
    fl_frame_model_free(&f);
    fl_member_model_free(&m);
    return framed == FUZZ_BROKEN || framed == FUZZ_SYSTEM ? framed : verdict;
}
