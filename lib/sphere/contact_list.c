/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "contact/disc_list.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/rolling_pair.h"
#include "law/normal.h"
#include "patch/stiffness_bound.h"
#include "sphere/contact_force.h"
#include "sphere/contact_list.h"
#include "sphere/sphere_pair.h"
#include "sphere/wall_contact.h"
#include "world/access.h"

/* Relative margin of a distance for rounding of coordinates, up to a million sizes from the origin. */
#define MARGIN 1e-9

enum { MAX_SHIFTS = 256 };

/* --- list -------------------------------------------------------------------------------------- */

void fl_contact_list_free(fl_sphere_contacts *s)
{
    free(s->i), free(s->j), free(s->law), free(s->image), free(s->touches), free(s->contact);
    free(s->rolling), free(s->first), free(s->state), free(s->target), free(s->first_source),
        free(s->finished), free(s->shift), free(s->shift_index), free(s->slot_first), free(s->incoming_first),
        free(s->incoming), free(s->slot);
    free(s->previous_sum), free(s->sum), free(s->totals), free(s->omega2), free(s->omega2_slot),
        free(s->contact_count), free(s->previous_contact_count), free(s->is_listed), free(s->cleared);
    free(s->wall), free(s->wall_rolling), free(s->wall_first), free(s->wall_load);
    *s = (fl_sphere_contacts){0};
}

/* Allocates n contacts. */
static int alloc_contacts(fl_sphere_contacts *s, const fl_world *w, int64_t n, fl_err *err)
{
    if (n > INT32_MAX) return fl_fail(err, FL_SYSTEM, "out of memory: %lld pairs of spheres", (long long)n);
    s->i = fl_alloc(n, sizeof *s->i, err);
    s->j = fl_alloc(n, sizeof *s->j, err);
    s->law = fl_alloc(n, sizeof *s->law, err);
    s->touches = fl_alloc(n, sizeof *s->touches, err);
    s->contact = fl_alloc(n, sizeof *s->contact, err);
    if (!s->i || !s->j || !s->law || !s->touches || !s->contact) return -1;
    if (w->cell.periodic && !(s->image = fl_alloc(3 * n, sizeof *s->image, err))) return -1;
    if (w->has_rolling && !(s->rolling = fl_alloc(n, sizeof *s->rolling, err))) return -1;
    s->n = s->i_cap = s->j_cap = s->law_cap = s->touches_cap = s->contact_cap = (int32_t)n;
    s->rolling_cap = s->rolling ? s->n : 0;
    s->image_cap = s->image ? 3 * s->n : 0;
    return 0;
}

/* Puts the arrays of contacts of `fresh` in the place of those of s. */
static void take_contacts(fl_sphere_contacts *s, const fl_sphere_contacts *fresh)
{
    free(s->i), free(s->j), free(s->law), free(s->image), free(s->touches), free(s->contact),
        free(s->rolling);
    s->rolling = fresh->rolling, s->rolling_cap = fresh->rolling_cap;
    s->i = fresh->i, s->j = fresh->j, s->law = fresh->law, s->image = fresh->image;
    s->touches = fresh->touches, s->contact = fresh->contact, s->n = fresh->n;
    s->i_cap = fresh->i_cap, s->j_cap = fresh->j_cap, s->law_cap = fresh->law_cap;
    s->image_cap = fresh->image_cap, s->touches_cap = fresh->touches_cap, s->contact_cap = fresh->contact_cap;
}

/* Allocates the arrays of bodies once; they last as long as the world. */
static int alloc_bodies(fl_sphere_contacts *s, const fl_world *w, fl_err *err)
{
    if (s->bodies) return 0;
    s->chunks = (w->n + FL_SPHERE_CHUNK - 1) / FL_SPHERE_CHUNK;
    s->first = fl_alloc((int64_t)w->n + 1, sizeof *s->first, err);
    s->incoming_first = fl_alloc((int64_t)w->n + 1, sizeof *s->incoming_first, err);
    s->state = fl_alloc(w->n, sizeof *s->state, err);
    s->first_source = fl_alloc(s->chunks, sizeof *s->first_source, err);
    s->finished = fl_alloc(s->chunks, sizeof *s->finished, err);
    s->slot_first = fl_alloc((int64_t)s->chunks + 1, sizeof *s->slot_first, err);
    s->totals = fl_alloc(s->chunks, sizeof *s->totals, err);
    s->wall_first = fl_alloc((int64_t)s->chunks + 1, sizeof *s->wall_first, err);
    s->wall_load = fl_alloc((int64_t)s->chunks * w->walls, sizeof *s->wall_load, err);
    s->omega2 = fl_alloc(w->n, sizeof *s->omega2, err);
    s->contact_count = fl_alloc(w->n, sizeof *s->contact_count, err);
    s->previous_contact_count = fl_alloc(w->n, sizeof *s->previous_contact_count, err);
    s->is_listed = fl_alloc((int64_t)s->chunks * FL_SPHERE_CHUNK / FL_BODY_BLOCK, sizeof *s->is_listed, err);
    s->cleared = fl_alloc(2 * (int64_t)s->chunks, sizeof *s->cleared, err);
    s->sum = fl_alloc(w->n, sizeof *s->sum, err);
    s->previous_sum = fl_alloc(w->n, sizeof *s->previous_sum, err);
    if (!s->wall_first || !s->wall_load || !s->first || !s->incoming_first || !s->state || !s->first_source ||
        !s->finished || !s->slot_first || !s->totals || !s->omega2 || !s->contact_count ||
        !s->previous_contact_count || !s->is_listed || !s->cleared || !s->sum || !s->previous_sum)
        return -1;
    s->bodies = w->n;
    return 0;
}

/* Numbers the distinct image offsets of all contacts, which are few; 0 is no offset. */
static int index_shifts(fl_sphere_contacts *s, const fl_periodic_cell *cell, fl_err *err)
{
    int32_t from[MAX_SHIFTS] = {0}; /* first contact with the offset; none for 0 */
    free(s->shift), free(s->shift_index);
    s->shift = fl_alloc(MAX_SHIFTS, sizeof *s->shift, err);
    s->shift_index = fl_alloc(s->n, sizeof *s->shift_index, err);
    s->shifts = 1;
    if (!s->shift || !s->shift_index) return -1;
    for (int32_t c = 0, k = 0; s->image && c < s->n; c++) {
        const int32_t *e = &s->image[3 * c];
        if (!(e[0] | e[1] | e[2])) continue;
        if (k == 0 || memcmp(e, &s->image[3 * from[k]], 3 * sizeof *e) != 0)
            for (k = 1; k < s->shifts && memcmp(e, &s->image[3 * from[k]], 3 * sizeof *e) != 0;) k++;
        if (k == MAX_SHIFTS) {
            s->shifts = 0;
            return 0;
        }
        if (k == s->shifts) {
            from[s->shifts++] = c;
            s->shift[k].by = fl_periodic_cell_offset(cell, v3(e[0], e[1], e[2]));
        }
        s->shift_index[c] = (uint8_t)k;
    }
    return 0;
}

/* Marks the blocks whose bodies are in the list; all of them where pairs of other lists need states. */
static void mark_listed(const fl_world *w)
{
    const fl_sphere_contacts *s = &w->spheres;
    const int all = !w->discs.n || w->has_rolling || w->walls || w->device.gpu;
    memset(s->is_listed, all, (size_t)s->chunks * FL_SPHERE_CHUNK / FL_BODY_BLOCK);
    for (int32_t c = 0; c < s->n && !all; c++)
        s->is_listed[s->i[c] / FL_BODY_BLOCK] = s->is_listed[s->j[c] / FL_BODY_BLOCK] = 1;
}

/* Computes offsets, targets and slots of all contacts. */
static int index_contacts(fl_world *w, fl_err *err)
{
    fl_sphere_contacts *s = &w->spheres;
    if (alloc_bodies(s, w, err)) return -1;
    for (int32_t i = 0; i <= s->bodies; i++) s->first[i] = s->incoming_first[i] = 0;
    for (int32_t c = 0; c < s->n; c++) s->first[s->i[c] + 1]++;
    for (int32_t i = 0; i < s->bodies; i++) s->first[i + 1] += s->first[i];
    int32_t slots = 0;
    free(s->target);
    if (!(s->target = fl_alloc(s->n, sizeof *s->target, err))) return -1;
    for (int32_t a = 0; a < s->chunks; a++) s->first_source[a] = INT32_MAX;
    for (int32_t a = 0; a < s->chunks; a++) {
        const int32_t end = fl_chunk_end(s, a);
        s->slot_first[a] = slots;
        if (s->first_source[a] > a) s->first_source[a] = a;
        for (int32_t c = s->first[a * FL_SPHERE_CHUNK]; c < s->first[end]; c++) {
            s->target[c] = s->j[c] < end ? s->j[c] : ~slots++;
            if (s->target[c] >= 0) continue;
            int32_t *source = &s->first_source[s->j[c] / FL_SPHERE_CHUNK];
            if (a < *source) *source = a;
            s->incoming_first[s->j[c] + 1]++;
        }
    }
    s->slot_first[s->chunks] = slots;
    free(s->incoming), free(s->slot), free(s->omega2_slot);
    s->incoming = fl_alloc(slots, sizeof *s->incoming, err);
    s->slot = fl_alloc(slots, sizeof *s->slot, err);
    s->omega2_slot = fl_alloc(slots, sizeof *s->omega2_slot, err);
    if (!s->incoming || !s->slot || !s->omega2_slot || index_shifts(s, &w->cell, err)) return -1;
    s->one_law = s->n > 0 ? s->law[0] : -1;
    for (int32_t c = 0; c < s->n; c++)
        if (s->law[c] != s->one_law) s->one_law = -1;
    for (int32_t j = 0; j < s->bodies; j++) s->incoming_first[j + 1] += s->incoming_first[j];
    slots = 0;
    for (int32_t a = 0; a < s->chunks; a++) { /* filling moves incoming_first[j] to the start of j + 1 */
        const int32_t end = fl_chunk_end(s, a);
        for (int32_t c = s->first[a * FL_SPHERE_CHUNK]; c < s->first[end]; c++)
            if (s->j[c] >= end) s->incoming[s->incoming_first[s->j[c]]++] = slots++;
    }
    for (int32_t j = s->bodies; j > 0; j--) s->incoming_first[j] = s->incoming_first[j - 1];
    s->incoming_first[0] = 0;
    memset(s->contact_count, 0, (size_t)s->bodies * sizeof *s->contact_count);
    for (int32_t c = 0; c < s->n; c++)
        s->contact_count[s->i[c]] += s->touches[c], s->contact_count[s->j[c]] += s->touches[c];
    fl_wall_list_index(s);
    mark_listed(w);
    return 0;
}

/* Order of contact c and (j, image). */
static int compare_contact(const fl_sphere_contacts *s, int32_t c, int32_t j, const int32_t image[3])
{
    if (s->j[c] != j) return s->j[c] < j ? -1 : 1;
    for (int axis = 0; s->image && axis < 3; axis++)
        if (s->image[3 * c + axis] != image[axis]) return s->image[3 * c + axis] < image[axis] ? -1 : 1;
    return 0;
}

/* True if two spheres may touch before the next search.  Boxes overlap at their corners already, where
 * spheres are still apart. */
static int may_touch(const fl_world *w, int32_t i, int32_t j, const int32_t image[3])
{
    const double R = (w->b.radius[i] + w->b.radius[j] + w->skin) * (1.0 + MARGIN);
    const fl_vec3 way = fl_periodic_cell_offset(&w->cell, v3(image[0], image[1], image[2]));
    return v3_norm2(v3_sub(v3_sub(w->b.x[i], w->b.x[j]), way)) < R * R;
}

/* Fills in the contacts of body i from c on, with the memory of those that were listed before. */
static void fill_contacts(const fl_world *w, fl_sphere_contacts *s, const uint8_t *listed, int32_t i,
                          int32_t c, fl_pair_image *image)
{
    const fl_sphere_contacts *old = &w->spheres;
    int32_t at = old->bodies ? old->first[i] : 0;
    const int32_t end = old->bodies ? old->first[i + 1] : 0;
    for (int64_t k = w->candidates.first[i]; k < w->candidates.first[i + 1]; k++) {
        const int32_t j = w->candidates.partner[k];
        int32_t cells[3] = {0};
        if (!listed[k]) continue;
        image(w, k, i, j, cells);
        while (at < end && compare_contact(old, at, j, cells) < 0) at++;
        s->i[c] = i;
        s->j[c] = j;
        s->law[c] = (int32_t)(fl_pair_law_of(w, i, j) - w->law);
        if (s->image) memcpy(&s->image[3 * c], cells, sizeof cells);
        if (at < end && compare_contact(old, at, j, cells) == 0) {
            if (s->rolling) s->rolling[c] = old->rolling[at];
            s->touches[c] = old->touches[at];
            s->contact[c] = old->contact[at++];
        } else {
            s->contact[c].k = fl_pair_stiffness(w, i, j).k;
            if (w->discs.n) fl_disc_list_init_contact(w, i, j, cells, &s->contact[c]);
        }
        c++;
    }
}

/* Replaces the contacts by those of `fresh`, and computes what follows from them. */
static int replace_contacts(fl_world *w, const fl_sphere_contacts *fresh, fl_err *err)
{
    take_contacts(&w->spheres, fresh);
    if (index_contacts(w, err)) return -1;
    for (int32_t k = 0; k < w->n; k += FL_BODY_BLOCK)
        fl_sphere_block_update(w, k, k + FL_BODY_BLOCK < w->n ? k + FL_BODY_BLOCK : w->n, 0.5 * w->dt);
    return 0;
}

int fl_contact_list_build(fl_world *w, fl_pair_image *image, int64_t *others, fl_err *err)
{
    fl_sphere_contacts fresh = {0}, *s = &w->spheres;
    int64_t near = 0, walls = 0;
    int32_t *at = fl_alloc((int64_t)w->n + 1, sizeof *at, err);
    uint8_t *listed = fl_alloc(w->candidates.first[w->n], sizeof *listed, err);
    if (!at || !listed) goto fail;
#pragma omp parallel for schedule(static) reduction(+ : near, walls)
    for (int32_t i = 0; i < w->n; i++) {
        for (int64_t k = w->candidates.first[i]; k < w->candidates.first[i + 1]; k++) {
            const int32_t j = w->candidates.partner[k];
            int32_t cells[3] = {0};
            walls += fl_sphere_pair_kind(w, i, j) == FL_SPHERE_WALL;
            if (fl_sphere_pair_kind(w, i, j) != FL_SPHERE_SPHERE) continue;
            image(w, k, i, j, cells);
            listed[k] = (uint8_t)(may_touch(w, i, j, cells) && !fl_disc_list_is_bonded(w, i, j, cells));
            at[i + 1] += listed[k];
            near++;
        }
    }
    *others = w->candidates.first[w->n] - near - walls;
    int64_t n = 0;
    for (int32_t i = 0; i < w->n; i++) n += at[i + 1], at[i + 1] = (int32_t)n;
    if (n + walls == 0 && !s->bodies) {
        free(at), free(listed);
        return 0;
    }
    if (alloc_contacts(&fresh, w, n, err) || fl_wall_list_build(w, walls, err)) goto fail;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < w->n; i++)
        if (at[i + 1] > at[i]) fill_contacts(w, &fresh, listed, i, at[i], image);
    free(at), free(listed);
    return replace_contacts(w, &fresh, err);
fail:
    fl_contact_list_free(&fresh);
    free(at), free(listed);
    return -1;
}

/* Copies contact `from` of `old` to c. */
static void copy_contact(fl_sphere_contacts *s, int32_t c, const fl_sphere_contacts *old, int32_t from)
{
    s->i[c] = old->i[from], s->j[c] = old->j[from];
    s->law[c] = old->law[from];
    s->touches[c] = old->touches[from];
    s->contact[c] = old->contact[from];
    if (s->rolling) s->rolling[c] = old->rolling[from];
    if (s->image) memcpy(&s->image[3 * c], &old->image[3 * from], 3 * sizeof *s->image);
}

/* Fills in contact c of the spheres of bond k, which has ended. */
static void init_after_disc(const fl_world *w, fl_sphere_contacts *s, int32_t c, int32_t k)
{
    const int32_t none[3] = {0}, i = w->discs.at.i[k], j = w->discs.at.j[k],
                  *image = w->discs.image ? &w->discs.image[3 * k] : none;
    s->i[c] = i, s->j[c] = j;
    s->law[c] = (int32_t)(fl_pair_law_of(w, i, j) - w->law);
    if (s->image) memcpy(&s->image[3 * c], image, 3 * sizeof *image);
    s->contact[c].k = fl_pair_stiffness(w, i, j).k;
    fl_disc_list_init_contact(w, i, j, image, &s->contact[c]);
}

/* True if contact c comes before the pair of bond k. */
static int is_before_disc(const fl_world *w, const fl_sphere_contacts *s, int32_t c, int32_t k)
{
    const int32_t none[3] = {0}, *image = w->discs.image ? &w->discs.image[3 * k] : none;
    if (s->i[c] != w->discs.at.i[k]) return s->i[c] < w->discs.at.i[k];
    return compare_contact(s, c, w->discs.at.j[k], image) < 0;
}

int fl_contact_list_add_ended(fl_world *w, fl_err *err)
{
    fl_sphere_contacts fresh = {0}, *s = &w->spheres;
    const fl_disc_list *d = &w->discs;
    int32_t at = 0, c = 0, found = 0;
    if (alloc_contacts(&fresh, w, (int64_t)s->n + d->ended, err)) {
        fl_contact_list_free(&fresh);
        return -1;
    }
    for (int32_t k = 0; k < d->n && found < d->ended; k++) { /* bonds have the order of contacts */
        if (d->has_ended[k] != FL_DISC_JUST_ENDED) continue;
        while (at < s->n && is_before_disc(w, s, at, k)) copy_contact(&fresh, c++, s, at++);
        init_after_disc(w, &fresh, c++, k);
        found++;
    }
    while (at < s->n) copy_contact(&fresh, c++, s, at++);
    return replace_contacts(w, &fresh, err);
}

int fl_contact_list_append(fl_world *w, int32_t i, int32_t j, const int32_t image[3], int touches,
                           const fl_sphere_contact *contact, const fl_rolling_spring *roll, fl_err *err)
{
    fl_sphere_contacts *s = &w->spheres;
    const int64_t n = (int64_t)s->n + 1;
    if (j >= w->n) return fl_wall_list_append(w, i, j, touches, contact, roll, err);
    if (fl_grow(&s->i, &s->i_cap, n, sizeof *s->i, err) || fl_grow(&s->j, &s->j_cap, n, sizeof *s->j, err) ||
        fl_grow(&s->law, &s->law_cap, n, sizeof *s->law, err) ||
        fl_grow(&s->touches, &s->touches_cap, n, sizeof *s->touches, err) ||
        fl_grow(&s->contact, &s->contact_cap, n, sizeof *s->contact, err) ||
        (w->has_rolling && fl_grow(&s->rolling, &s->rolling_cap, n, sizeof *s->rolling, err)) ||
        (w->cell.periodic && fl_grow(&s->image, &s->image_cap, 3 * n, sizeof *s->image, err)))
        return -1;
    s->i[s->n] = i;
    s->j[s->n] = j;
    s->law[s->n] = (int32_t)(fl_pair_law_of(w, i, j) - w->law);
    s->touches[s->n] = (uint8_t)touches;
    s->contact[s->n] = *contact;
    if (s->rolling) s->rolling[s->n] = *roll;
    if (s->image) memcpy(&s->image[3 * s->n], image, 3 * sizeof *image);
    s->n++;
    return 0;
}

int fl_contact_list_drop_absent(fl_world *w)
{
    fl_sphere_contacts *s = &w->spheres;
    int32_t kept = 0;
    for (int32_t c = 0; c < s->n; c++) {
        if (fl_body_absent(w, s->i[c]) || fl_body_absent(w, s->j[c])) continue;
        s->i[kept] = s->i[c];
        s->j[kept] = s->j[c];
        s->law[kept] = s->law[c];
        s->touches[kept] = s->touches[c];
        s->contact[kept] = s->contact[c];
        if (s->rolling) s->rolling[kept] = s->rolling[c];
        if (s->image) memmove(&s->image[3 * kept], &s->image[3 * c], 3 * sizeof *s->image);
        kept++;
    }
    const int dropped = kept < s->n;
    s->n = kept;
    return dropped;
}

int fl_contact_list_remove_absent(fl_world *w, fl_err *err)
{
    const int walls = fl_wall_list_remove_absent(w), rows = fl_contact_list_drop_absent(w);
    return walls || rows ? fl_contact_list_index(w, err) : 0;
}

int fl_contact_list_resize(fl_world *w, int32_t n, fl_err *err)
{
    fl_sphere_contacts *s = &w->spheres, fresh = {0};
    if (n == s->n) return 0;
    if (alloc_contacts(&fresh, w, n, err)) {
        fl_contact_list_free(&fresh);
        return -1;
    }
    take_contacts(s, &fresh);
    return 0;
}

int fl_contact_list_offsets(fl_world *w, fl_err *err) { return index_contacts(w, err); }

int fl_contact_list_build_walls(fl_world *w, fl_err *err)
{
    int64_t walls = 0;
    for (int32_t i = 0; i < w->n; i++)
        for (int64_t k = w->candidates.first[i]; k < w->candidates.first[i + 1]; k++)
            walls += fl_sphere_pair_kind(w, i, w->candidates.partner[k]) == FL_SPHERE_WALL;
    if (fl_wall_list_build(w, walls, err)) return -1;
    fl_wall_list_index(&w->spheres);
    return 0;
}

int fl_contact_list_index(fl_world *w, fl_err *err)
{
    if (index_contacts(w, err)) return -1;
    for (int32_t a = 0; a < w->spheres.chunks; a++) fl_sphere_chunk_evaluate(w, a, -1.0, 0);
    fl_sphere_sums_collect(w, 0, w->spheres.bodies);
    return 0;
}

/* --- sums -------------------------------------------------------------------------------------- */

static double overlap_of(const fl_world *w, int32_t c)
{
    const fl_sphere_contacts *s = &w->spheres;
    return w->b.radius[s->i[c]] + w->b.radius[s->j[c]] - v3_norm(fl_sphere_separation(w, c));
}

void fl_contact_list_energy(const fl_world *w, double *elastic, double *spring)
{
    const fl_sphere_contacts *s = &w->spheres;
#pragma omp parallel for schedule(static)
    for (int32_t a = 0; a < s->chunks; a++) {
        double all = 0.0, springs = 0.0;
        for (int32_t c = s->first[a * FL_SPHERE_CHUNK]; c < s->first[fl_chunk_end(s, a)]; c++) {
            if (!s->touches[c]) continue;
            const double held = fl_sphere_spring_energy(&s->contact[c], s->rolling ? &s->rolling[c] : NULL);
            all += s->contact[c].k * fl_normal_phi(overlap_of(w, c), fl_round_exponent(w)) + held;
            springs += held;
        }
        fl_wall_chunk_energy(w, a, &all, &springs);
        s->totals[a].elastic = all;
        s->totals[a].spring = springs;
    }
    for (int32_t a = 0; a < s->chunks; a++) {
        *elastic += s->totals[a].elastic;
        *spring += s->totals[a].spring;
    }
}

fl_sphere_totals fl_contact_list_totals(const fl_world *w)
{
    const fl_sphere_contacts *s = &w->spheres;
    fl_sphere_totals all = {.i = -1, .j = -1};
    for (int32_t a = 0; a < s->chunks; a++) {
        const fl_chunk_totals *t = &s->totals[a];
        all.force_sum += t->force_sum;
        all.touching += t->touching;
        if (!(t->max_overlap > all.max_overlap)) continue;
        all.max_overlap = t->max_overlap;
        all.i = t->max_overlap_i;
        all.j = t->max_overlap_j;
    }
    return all;
}

double fl_sphere_omega2(const fl_world *w, int32_t k)
{
    const fl_sphere_contacts *s = &w->spheres;
    double sum = s->omega2[k];
    for (int32_t c = s->incoming_first[k]; c < s->incoming_first[k + 1]; c++)
        sum += s->omega2_slot[s->incoming[c]];
    return sum;
}

double fl_contact_list_bytes(const fl_world *w)
{
    const fl_sphere_contacts *s = &w->spheres;
    const double contact =
                     4 * sizeof(int32_t) + sizeof *s->touches + sizeof *s->shift_index + sizeof *s->contact,
                 image = s->image ? 3 * sizeof(int32_t) : 0, roll = s->rolling ? sizeof *s->rolling : 0,
                 slot = sizeof *s->slot + sizeof *s->incoming + sizeof *s->omega2_slot,
                 body = 2 * sizeof *s->sum + sizeof *s->state + 4 * sizeof(int32_t) + sizeof *s->omega2;
    if (!s->bodies) return 0.0;
    return s->n * (contact + image + roll) + s->walls * ((double)sizeof *s->wall + roll) +
           s->slot_first[s->chunks] * slot + s->bodies * body;
}

/* --- conversion to fl_pair --------------------------------------------------------------------- */

/* Converts contact c to an fl_pair, with the forces of its last evaluation. */
static void convert_contact(const fl_world *w, int32_t c, fl_pair *p)
{
    const fl_sphere_contacts *s = &w->spheres;
    const fl_bodies *b = &w->b;
    const fl_sphere_contact *r = &s->contact[c];
    const int32_t i = s->i[c], j = s->j[c];
    const fl_vec3 d = fl_sphere_separation(w, c);
    const double apart = v3_norm(d), over = b->radius[i] + b->radius[j] - apart,
                 arm = b->radius[j] - 0.5 * over;
    const fl_vec3 n = apart > 0.0 ? v3_scale(1.0 / apart, d) : v3(0, 0, 1);
    const fl_rolling_spring *roll = s->rolling ? &s->rolling[c] : NULL;
    fl_sphere_contact_to_pair(w, i, j, r, roll, s->touches[c], n, over, p);
    if (s->image) memcpy(p->image, &s->image[3 * c], sizeof p->image);
    if (!p->touching) return;
    p->torque_j_friction = p->torque_j =
        v3_madd(v3_neg(fl_rolling_moment(roll)), -arm, v3_cross(n, r->friction_force));
    p->omega2_j =
        fl_stiffness_of_point(b, j, r->k * fl_normal_slope(over, fl_round_exponent(w)), r->spring_stiffness,
                              arm, roll ? fl_rolling_turn_stiffness(roll) : 0.0);
}

/* Walls come after all other contacts of a sphere. */
int32_t fl_contact_list_next(const fl_world *w, fl_contact_iterator *at)
{
    const fl_sphere_contacts *s = &w->spheres;
    if (at->wall >= s->walls || (at->sphere < s->n && s->i[at->sphere] <= s->wall[at->wall].i))
        return at->sphere++;
    return ~at->wall++;
}

/* True if contact c, as fl_contact_list_next() returns it, comes before pair p. */
static int comes_first(const fl_sphere_contacts *s, int32_t c, const fl_neighbour_pair *p)
{
    const int32_t i = c < 0 ? s->wall[~c].i : s->i[c], j = c < 0 ? s->wall[~c].j : s->j[c];
    return i != p->i ? i < p->i : j < p->j; /* no pair is in both lists */
}

const fl_pair *fl_pair_next(fl_pair_iterator *at)
{
    const fl_world *w = at->w;
    fl_contact_iterator next = at->spheres;
    if (next.sphere + next.wall < fl_contact_list_size(w)) {
        const int32_t c = fl_contact_list_next(w, &next);
        if (at->pair >= w->n_pair || comes_first(&w->spheres, c, &w->pair[at->pair])) {
            at->spheres = next;
            if (c < 0) fl_wall_contact_to_pair(w, ~c, &at->converted);
            else convert_contact(w, c, &at->converted);
            return &at->converted;
        }
    }
    if (at->pair >= w->n_pair) return NULL;
    const fl_neighbour_pair *q = &w->pair[at->pair++];
    if (!q->contact) fl_neighbour_pair_expand(w, q, &at->converted);
    return q->contact ? q->contact : &at->converted;
}
