/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/inflow_bonds.h"
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "contact/bond_image.h"
#include "contact/disc_setup.h"
#include "world/access.h"

/* Two spheres a pitch apart touch if their distance is the sum of their radii to this fraction: coordinates
 * of files have 1e-9 and less. */
#define TOUCHING 1e-6

/* A partner is where the sheet has it to this fraction of the sum of the radii: another copy of it would be
 * more than one off. */
#define IN_PLACE 0.1

void fl_inflow_bonds_free(fl_inflow_join *t)
{
    free(t->first), free(t->partner), free(t->newest), free(t->birth);
    *t = (fl_inflow_join){0};
}

/* --- which floes of the endless sheet are bonded ------------------------------------------------ */

/* A partner of floe k. */
typedef struct {
    int32_t k;
    fl_inflow_partner to;
} partner_row;

typedef struct {
    partner_row *row;
    int32_t n, cap;
} partner_rows;

static int add_partners(partner_rows *a, int32_t k, int32_t l, fl_vec3 by, fl_err *err)
{
    if (fl_grow(&a->row, &a->cap, (int64_t)a->n + 2, sizeof *a->row, err)) return -1;
    a->row[a->n++] = (partner_row){k, {l, by}};
    a->row[a->n++] = (partner_row){l, {k, v3_neg(by)}};
    return 0;
}

/* The shortest vector, by whole periods. */
static fl_vec3 nearest_image(const fl_world *w, fl_vec3 d)
{
    const fl_vec3 L = w->cell.length;
    if (!w->cell.periodic) return d;
    return v3(d.x - L.x * fl_bond_nearest_cell(d.x, L.x), d.y - L.y * fl_bond_nearest_cell(d.y, L.y),
              d.z - L.z * fl_bond_nearest_cell(d.z, L.z));
}

static double along(const fl_inflow_state *t, fl_vec3 x) { return t->sign * (t->axis ? x.y : x.x); }

/* Floes of the field whose centre is within `reach` of its front or back. */
static int32_t list_edge(const fl_inflow_state *t, double reach, int front, int32_t *list)
{
    double end = front ? -INFINITY : INFINITY;
    int32_t n = 0;
    for (int32_t k = 0; k < t->feed->n; k++) {
        const double s = along(t, t->feed->core[k].v[0]);
        end = front ? fmax(end, s) : fmin(end, s);
    }
    for (int32_t k = 0; k < t->feed->n; k++)
        if (fabs(along(t, t->feed->core[k].v[0]) - end) <= reach) list[n++] = k;
    return n;
}

/* Partners across the seam: floe k of a copy and l of the copy before. */
static int add_seam(const fl_world *w, partner_rows *a, fl_err *err)
{
    const fl_inflow_state *t = &w->inflow;
    const fl_ice_field *f = t->feed;
    const fl_vec3 shift = v3(t->axis ? 0.0 : t->sign * t->pitch, t->axis ? t->sign * t->pitch : 0.0, 0.0);
    double radius = 0.0;
    for (int32_t k = 0; k < f->n; k++) radius = fmax(radius, f->radius[k]);
    int32_t *front = fl_alloc(2 * (int64_t)f->n, sizeof *front, err), *back = front ? front + f->n : NULL;
    if (!front) return -1;
    const int32_t n = list_edge(t, 4.0 * radius, 1, front), m = list_edge(t, 4.0 * radius, 0, back);
    int rc = 0;
    for (int32_t p = 0; p < n; p++)
        for (int32_t q = 0; q < m && rc == 0; q++) {
            const int32_t k = front[p], l = back[q];
            const fl_vec3 by = nearest_image(w, v3_add(v3_sub(f->core[l].v[0], f->core[k].v[0]), shift));
            const double R = f->radius[k] + f->radius[l];
            if (fabs(v3_norm(by) - R) <= TOUCHING * R) rc = add_partners(a, k, l, by, err);
        }
    free(front);
    return rc;
}

/* Sorts the rows by floe. */
static int index_partners(fl_inflow_state *t, const partner_rows *a, fl_err *err)
{
    fl_inflow_join *c = &t->join;
    const int32_t n = t->feed->n;
    c->first = fl_alloc((int64_t)n + 2, sizeof *c->first, err);
    c->partner = fl_alloc(a->n, sizeof *c->partner, err);
    c->newest = fl_alloc(n, sizeof *c->newest, err);
    if (!c->first || !c->partner || !c->newest) return -1;
    for (int32_t p = 0; p < a->n; p++) c->first[a->row[p].k + 2]++;
    for (int32_t k = 0; k <= n; k++) c->first[k + 1] += c->first[k];
    for (int32_t p = 0; p < a->n; p++) c->partner[c->first[a->row[p].k + 1]++] = a->row[p].to;
    return 0;
}

/* The ice of the start is copy -1: its front is a pitch ahead of the bound. */
static int check_start(const fl_world *w, fl_err *err)
{
    const fl_inflow_state *t = &w->inflow;
    double front = -INFINITY, radius = 0.0;
    for (int32_t k = 0; k < t->feed->n; k++) {
        front = fmax(front, along(t, t->feed->core[k].v[0]) + t->feed->radius[k]);
        radius = fmax(radius, t->feed->radius[k]);
    }
    const double wanted = front - t->pitch;
    if (fabs(wanted - t->entry) <= IN_PLACE * radius) return 0;
    return fl_scene_fail(
        w->scene, t->sign > 0.0 ? "boundary.min" : "boundary.max", err,
        "the bound of the inflow is at %c = %.9g m: the sheet ends there, and goes on with its "
        "copies, if it is at %.9g m, the front of %s less boundary.inflow_pitch",
        'x' + t->axis, t->sign * t->entry, t->sign * wanted, w->scene->ice.file);
}

/* A driven edge of the sheet moves with it. */
static int check_drive(const fl_world *w, fl_err *err)
{
    const fl_inflow_state *t = &w->inflow;
    const fl_scene_boundary *s = &w->scene->boundary;
    const double drive = t->sign * (t->axis ? s->drive.y : s->drive.x);
    if (!w->driven_floes.n || !(s->drive_fixed & (t->axis ? FL_DOF_Y : FL_DOF_X)) || drive == t->speed)
        return 0;
    return fl_scene_fail(w->scene, "boundary.drive", err,
                         "the edge of the sheet is driven at %g m/s, but the sheet comes in at %g m/s: equal "
                         "ones are expected",
                         drive, t->speed);
}

int fl_inflow_bonds_make(fl_world *w, fl_err *err)
{
    fl_inflow_state *t = &w->inflow;
    partner_rows a = {0};
    if (!t->feed || !fl_world_bonds(w)) return 0;
    if (w->bonds.n || t->feed != t->ice)
        return fl_scene_fail(w->scene, "boundary.inflow", err,
                             "an endless sheet of bonded ice is of spheres alone, and repeats the field of "
                             "ice.file: boundary.inflow = ice, or bond.on = false, is expected");
    int rc = check_start(w, err) || check_drive(w, err) ? -1 : 0;
    for (int32_t b = 0; b < t->feed->bonds && rc == 0; b++) {
        const int32_t k = t->feed->bond[b].i, l = t->feed->bond[b].j;
        rc = add_partners(&a, k, l, nearest_image(w, v3_sub(t->feed->core[l].v[0], t->feed->core[k].v[0])),
                          err);
    }
    const int32_t inside = a.n;
    if (rc == 0) rc = add_seam(w, &a, err);
    if (rc == 0 && a.n == inside)
        rc = fl_scene_fail(w->scene, "boundary.inflow_pitch", err,
                           "copies of %s that are %.9g m apart do not touch, so no bond would join them: the "
                           "pitch of voronoi-ice --endless is expected",
                           w->scene->ice.file, t->pitch);
    if (rc == 0) rc = index_partners(t, &a, err);
    for (int32_t k = 0; k < t->feed->n && rc == 0; k++) t->join.newest[k] = k;
    free(a.row);
    return rc;
}

/* --- in a step ---------------------------------------------------------------------------------- */

/* Place of the partner, -1: it is not where the sheet has it. */
static int32_t place_of(const fl_world *w, int32_t i, const fl_inflow_partner *p)
{
    const fl_inflow_state *t = &w->inflow;
    const int32_t l = t->join.newest[p->floe];
    if (l < 0 || l == i || t->absent[l]) return -1;
    const fl_vec3 off = v3_sub(nearest_image(w, v3_sub(w->b.x[l], w->b.x[i])), p->by);
    return v3_norm(off) <= IN_PLACE * (w->b.radius[i] + w->b.radius[l]) ? l : -1;
}

int fl_inflow_bonds_joins(const fl_world *w, int32_t i, int32_t floe, int32_t k)
{
    const fl_inflow_join *c = &w->inflow.join;
    if (!c->first || k >= w->n) return 0;
    for (int64_t p = c->first[floe]; p < c->first[floe + 1]; p++)
        if (c->newest[c->partner[p].floe] == k && place_of(w, i, &c->partner[p]) == k) return 1;
    return 0;
}

static int32_t cells_apart(double d, double length) { return (int32_t)fl_bond_nearest_cell(d, length); }

int fl_inflow_bonds_admit(fl_world *w, int32_t i, fl_err *err)
{
    fl_inflow_join *c = &w->inflow.join;
    const int32_t floe = w->inflow.source_floe[i];
    if (!c->first) return 0;
    for (int64_t p = c->first[floe]; p < c->first[floe + 1]; p++) {
        const int32_t l = place_of(w, i, &c->partner[p]);
        if (l < 0) continue;
        if (fl_grow(&c->birth, &c->birth_cap, (int64_t)c->births + 1, sizeof *c->birth, err)) return -1;
        fl_disc_birth d = {.i = i < l ? i : l, .j = i < l ? l : i, .length = w->b.radius[i] + w->b.radius[l]};
        if (w->cell.periodic) { /* the cell that brings j beside i */
            const fl_vec3 off = v3_sub(w->b.x[d.i], w->b.x[d.j]), L = w->cell.length;
            d.image[0] = cells_apart(off.x, L.x), d.image[1] = cells_apart(off.y, L.y);
            d.image[2] = cells_apart(off.z, L.z);
        }
        c->birth[c->births++] = d;
    }
    c->newest[floe] = i;
    return 0;
}

int fl_inflow_bonds_renew(fl_world *w, fl_err *err)
{
    fl_inflow_join *c = &w->inflow.join;
    if (!c->first) return 0;
    const int rc = fl_disc_list_renew(w, c->birth, c->births, err);
    c->births = 0;
    return rc;
}

void fl_inflow_bonds_refresh(fl_world *w)
{
    const fl_inflow_state *t = &w->inflow;
    int32_t *newest = t->join.newest;
    if (!t->join.first) return;
    for (int32_t k = 0; k < t->feed->n; k++) newest[k] = -1;
    for (int32_t i = 0; i < w->n; i++) {
        const int32_t k = t->source_floe[i] < 0 ? i : t->source_floe[i];
        if (!t->absent[i] && (newest[k] < 0 || w->id[newest[k]] < w->id[i])) newest[k] = i;
    }
}
