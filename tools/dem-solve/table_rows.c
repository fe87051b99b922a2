/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "table_rows.h"
#include <stdlib.h>
#include "base/pi.h"
#include "contact/bond_list.h"
#include "contact/joint_list.h"
#include "contact/pair_geometry.h"
#include "contact/panel_load.h"
#include "out/frames.h"
#include "out/tables.h"
#include "sim/energy_balance.h"
#include "sim/member_structure.h"
#include "sim/moving_structure.h"
#include "sphere/contact_list.h"

fl_poses poses_of(const struct run *r)
{
    return (fl_poses){&r->w->b, r->w->id, r->w->q0, r->order, &r->w->cell, r->w->inflow.absent};
}

/* Number of contacts whose load part bears, alone or with others. */
static int32_t bodies_touching(const fl_world *w, int32_t part)
{
    int32_t touching = 0;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k;
        const fl_piece *piece = &w->structure.piece[k];
        if (!piece->several_parts && piece->part != part) continue;
        for (int64_t c = w->first_pair_of_body[j]; c < w->first_pair_of_body[j + 1]; c++) {
            const fl_neighbour_pair *p = &w->pair[w->pairs_of_body[c]];
            touching += p->touching > 0 && (!piece->several_parts || p->contact->load_part == part);
        }
    }
    for (int32_t k = 0; k < w->panel_load.shares; k++) touching += w->panel_load.share[k].part == part;
    return touching;
}

/* Number of body j of pair p in a table; x is a point of the contact. */
static int32_t id_of_partner(fl_world *w, const fl_pair *p, fl_vec3 x)
{
    const fl_piece *piece = p->j < w->n ? NULL : &w->structure.piece[p->j - w->n];
    return piece && piece->several_parts ? -1 - fl_load_part_at(w, p->j, x) : fl_world_id(w, p->j);
}

/* The columns of all modes, without values; NULL where there are no modes, or too many for a table. */
static const fl_more_columns *begin_mode_columns(const fl_world *w, struct mode_columns *c,
                                                 const char *prefix, const char *unit)
{
    const int32_t n = w->moving.movers.n ? fl_structure_modes(w) : 0;
    if (n == 0) return NULL;
    c->more = (fl_more_columns){n < MODE_COLUMNS ? n : MODE_COLUMNS, prefix, unit, c->name, c->value};
    for (int32_t k = 0; k < c->more.n; k++) c->name[k] = fl_structure_mode(w, k, NULL)->name;
    return &c->more;
}

const fl_more_columns *mode_displacements(const fl_world *w, int32_t part, struct mode_columns *c)
{
    const fl_more_columns *more = begin_mode_columns(w, c, "q_", "m");
    for (int32_t k = 0; more && k < more->n; k++) {
        int32_t mover;
        const fl_modal_dof *m = fl_structure_mode(w, k, &mover);
        c->value[k] = part >= 0 && w->moving.mover_of_part[part] == mover ? m->q : 0.0;
    }
    return more;
}

const fl_more_columns *mode_energies(const fl_world *w, struct mode_columns *c)
{
    const fl_more_columns *more = begin_mode_columns(w, c, "mode_", "J");
    for (int32_t k = 0; more && k < more->n; k++) c->value[k] = fl_mode_energy(fl_structure_mode(w, k, NULL));
    return more;
}

unsigned loads_options(const fl_world *w)
{
    return (unsigned)fl_motion_columns(w) | (w->strips.wall ? FL_LOADS_RATE : 0u) |
           (w->scene->structure.direction != 0.0 ? FL_LOADS_PLATFORM : 0u);
}

/* Fills the columns of crushing by speed, and begins the next interval. */
static void take_closing(fl_world *w, int32_t part, fl_loads_row *row)
{
    fl_strips *s = &w->strips;
    if (s->part_seconds[part] > 0.0) row->closing = s->part_closing[part] / s->part_seconds[part];
    row->breaks = (double)s->part_breaks[part];
    s->part_closing[part] = s->part_seconds[part] = 0.0;
    s->part_breaks[part] = 0;
}

/* Force and moment in platform axes, in which the scene's are turned by the direction. */
static void turn_to_platform(const fl_world *w, fl_loads_row *row)
{
    const fl_quat q = q_of_vector(v3(0, 0, PI / 180.0 * w->scene->structure.direction));
    const fl_vec3 f = q_rotate(q, row->force), m = q_rotate(q, row->moment);
    row->platform[0] = f.x, row->platform[1] = f.y;
    row->platform[2] = m.x, row->platform[3] = m.y;
}

void write_loads(struct run *r, FILE *f, double t, double interval)
{
    fl_world *w = r->w;
    const enum fl_loads_motion_kind moving = fl_motion_columns(w);
    for (int32_t p = 0; p < w->parts; p++) {
        fl_loads_row row = {.part = r->surface->part[p].name,
                            .force = v3_scale(1.0 / interval, w->part_impulse[p]),
                            .moment = v3_scale(1.0 / interval, w->part_moment[p]),
                            .peak = w->part_peak[p],
                            .contacts = bodies_touching(w, p)};
        if (moving) fl_part_motion(w, p, t, &row.motion);
        struct mode_columns modes;
        if (w->strips.wall) take_closing(w, p, &row);
        if (w->scene->structure.direction != 0.0) turn_to_platform(w, &row);
        fl_table_write_row_more(f, &fl_loads_table, loads_options(w), t, &row,
                                mode_displacements(w, p, &modes));
        w->part_impulse[p] = w->part_moment[p] = v3(0, 0, 0);
        w->part_peak[p] = 0.0;
    }
}

/* Middle of the cylinder of panel k: all panels are cylinders, in the order of the pieces. */
static fl_vec3 middle_of_piece(const fl_world *w, int32_t k)
{
    const int32_t j = w->n + k;
    return v3_add(w->b.x[j], q_rotate(w->b.q[j], v3(0, 0, 0.5 * w->structure.piece[k].h)));
}

/* Panels are numbered within their part; their centroids move with it. */
void write_panels(struct run *r, FILE *f, double t, double interval)
{
    fl_world *w = r->w;
    const fl_panel_loads *s = &w->panel_load;
    for (int32_t k = 0; k < s->panels; k++) {
        const fl_load_panel *p = &s->panel[k];
        if (!(p->area > 0.0)) continue; /* a triangle without area has no pressure */
        fl_panels_row row = {.panel = {r->surface->part[p->part].name, k - s->first[p->part] + 1},
                             .centroid = p->centroid,
                             .area = p->area,
                             .force = v3_scale(1.0 / interval, s->impulse[k])};
        if (fl_structure_has_members(w)) row.centroid = middle_of_piece(w, k);
        else if (w->moving.movers.n && w->moving.mover_of_part[p->part] >= 0)
            row.centroid = fl_part_point(w, p->part, p->centroid);
        fl_table_write_row(f, &fl_panels_table, 0, t, &row);
    }
    fl_panels_end_interval(w);
}

/* A row of contacts: `force` acts on body i. */
static void write_contact(FILE *f, double t, int32_t i, int32_t j, const fl_contact *c, fl_vec3 force)
{
    const double normal = v3_dot(force, c->n);
    const fl_contacts_row row = {.i = i,
                                 .j = j,
                                 .mode = fl_mode_name(c->mode),
                                 .gap = c->gap,
                                 .n = c->n,
                                 .p = c->p,
                                 .length = c->length,
                                 .area = c->area,
                                 .normal = normal,
                                 .tangential = v3_madd(force, -normal, c->n)};
    fl_table_write_row(f, &fl_contacts_table, 0, t, &row);
}

void write_events(struct run *r, FILE *f, double t, double interval)
{
    fl_world *w = r->w;
    for (int32_t k = 0; k < w->panel_load.events; k++) {
        const fl_load_event *e = &w->panel_load.event[k];
        const fl_vec3 force = v3_scale(-1.0 / interval, e->impulse); /* on the floe */
        fl_contact c = {.gap = -e->max_overlap, .n = v3_unit(e->normal_impulse)};
        if (e->impulse_sum > 0.0) {
            c.p = v3_scale(1.0 / e->impulse_sum, e->impulse_point);
            c.area = e->impulse_area / e->impulse_sum;
        }
        if (!(v3_norm2(c.n) > 0.5)) c.n = v3_unit(force);
        if (!(v3_norm2(c.n) > 0.5)) continue; /* no force at all */
        write_contact(f, t, e->id, -1 - e->part, &c, force);
    }
    fl_events_end_interval(w);
}

void write_state(struct run *r, FILE *f, double t, double interval)
{
    const fl_poses now = poses_of(r);
    (void)interval;
    fl_state_write_rows(f, t, &now);
}

void write_energy(struct run *r, FILE *f, double t, double interval)
{
    (void)interval;
    fl_energy_update(r->w);
    struct mode_columns modes;
    fl_table_write_row_more(f, &fl_energy_table, fl_energy_table_options(r->w), t, &r->w->ledger,
                            mode_energies(r->w, &modes));
}

void write_contacts(struct run *r, FILE *f, double t, double interval)
{
    fl_world *w = r->w;
    fl_pair_iterator at = {.w = w};
    (void)interval;
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        fl_contact k;
        if (p->touching == 0 || !fl_pair_probe(w, p, 0.0, &k)) continue;
        write_contact(f, t, w->id[p->i], id_of_partner(w, p, k.p), &k, p->force);
    }
}

void write_near_pairs(struct run *r, FILE *f, double within)
{
    fl_world *w = r->w;
    fl_pair_iterator at = {.w = w};
    for (const fl_pair *p; (p = fl_pair_next(&at)) != NULL;) {
        fl_contact k;
        if (!fl_pair_probe(w, p, within, &k)) continue;
        fl_contacts_row row = {.i = w->id[p->i],
                               .j = id_of_partner(w, p, k.p),
                               .mode = fl_mode_name(k.mode),
                               .gap = k.gap,
                               .n = k.n,
                               .p = k.p,
                               .length = k.length,
                               .area = k.area};
        fl_table_write_row(f, &fl_contacts_table, 0, 0.0, &row);
    }
}

void write_hash(struct run *r, FILE *f, double t, double interval)
{
    const fl_hash_row row = {fl_state_hash(r->w)};
    (void)interval;
    fl_table_write_row(f, &fl_hash_table, 0, t, &row);
}

static const char *const BOND_STATE[] = {"whole", "damaged", "broken", "ended"};

void write_failures(struct run *r, FILE *f, double t, double interval)
{
    static const char *const MODE[] = {"bend", "split", "cusp"};
    fl_breaking_state *s = &r->w->breaking;
    (void)t, (void)interval; /* rows have the times of the failures */
    for (int32_t k = 0; k < s->events; k++) {
        const fl_failure_event *e = &s->event[k];
        const fl_failures_row row = {.mode = MODE[e->mode],
                                     .parent = e->parent,
                                     .child = e->child,
                                     .x = e->x,
                                     .n = e->n,
                                     .length = e->length,
                                     .load = e->load,
                                     .ratio = e->ratio,
                                     .mass = e->mass,
                                     .child_mass = e->child_mass,
                                     .energy = e->energy};
        fl_table_write_row(f, &fl_failures_table, 0, e->time, &row);
    }
    s->events = 0;
}

/* Row of the bond k of two spheres. */
static void write_disc(const fl_world *w, FILE *f, double t, int32_t k)
{
    const fl_disc_list *s = &w->discs;
    const fl_disc_class *c = &s->classes[s->at.which[k]];
    const fl_disc_load q = fl_disc_list_load(w, k);
    const int32_t i = s->at.i[k], j = s->at.j[k];
    if (fl_body_absent(w, i) || fl_body_absent(w, j)) return;
    const fl_bonds_row row = {.i = w->id[i],
                              .j = w->id[j],
                              .state = BOND_STATE[s->has_ended[k]     ? FL_BOND_ENDED
                                                  : s->at.is_whole[k] ? FL_BOND_INTACT
                                                                      : FL_BOND_DAMAGED],
                              .damage = 1.0 - fl_disc_integrity(c, s->at.lambda[k]),
                              .tension = q.tension,
                              .shear = q.shear,
                              .moment = q.moment,
                              .area = PI * c->radius * c->radius,
                              .x = q.x,
                              .joint = "-"};
    fl_table_write_row(f, &fl_bonds_table, fl_world_joints(w) ? FL_BONDS_JOINTS : 0, t, &row);
}

static const char *bond_state(const fl_world *w, int32_t k)
{
    const fl_joint *j = fl_joint_of_bond(&w->bonds, k);
    const fl_bond *c = &w->bonds.bond[k];
    if (!j || c->state == FL_BOND_ENDED) return BOND_STATE[c->state];
    return j->opens == FL_BOND_POINTS ? "open" : j->slips || j->opens ? "slip" : "elastic";
}

void write_bonds(struct run *r, FILE *f, double t, double interval)
{
    const fl_world *w = r->w;
    (void)interval;
    for (int32_t k = 0; k < w->bonds.n; k++) {
        const fl_bond *c = &w->bonds.bond[k];
        const fl_joint *j = fl_joint_of_bond(&w->bonds, k);
        const fl_bond_load q = fl_bond_list_load(w, k);
        if (fl_body_absent(w, c->i) || fl_body_absent(w, c->j)) continue;
        const fl_bonds_row row = {.i = w->id[c->i],
                                  .j = w->id[c->j],
                                  .state = bond_state(w, k),
                                  .damage = fl_bond_mean_damage(c),
                                  .tension = q.tension,
                                  .shear = q.shear,
                                  .moment = q.moment,
                                  .area = c->area,
                                  .x = q.x,
                                  .joint = j                    ? w->scene->joint[j->material].name
                                           : k < w->bonds.faces ? "-"
                                                                : "intact"};
        fl_table_write_row(f, &fl_bonds_table, fl_world_joints(w) ? FL_BONDS_JOINTS : 0, t, &row);
    }
    for (int32_t k = 0; k < w->discs.n; k++) write_disc(w, f, t, k);
}

void write_members(struct run *r, FILE *f, double t, double interval)
{
    const fl_world *w = r->w;
    (void)interval;
    for (int32_t k = 0; k < w->moving.members.dynamics.chain.contacts; k++) {
        const fl_member_forces_row row = fl_member_structure_row(w, k);
        fl_table_write_row(f, &fl_member_forces_table, 0, t, &row);
    }
}

void write_zones(struct run *r, FILE *f, double t, double interval)
{
    const fl_world *w = r->w;
    const fl_zone_set *s = &w->zones.set;
    (void)interval;
    for (int32_t b = 0; b < s->blocks; b++) {
        const fl_zone_block *q = &s->block[b];
        for (int32_t k = q->zone; k < q->zone_end && !q->absent; k++) {
            const int32_t *n = s->zone[k];
            fl_mat3 axes;
            const fl_sym3 c = s3_times(-1.0, fl_zone_cauchy(s, k));
            const fl_zones_row row = {
                .body = w->id[q->body],
                .zone = k - q->zone,
                .x = v3_scale(0.25, v3_add(v3_add(s->x[n[0]], s->x[n[1]]), v3_add(s->x[n[2]], s->x[n[3]]))),
                .volume = s->zone_volume[k],
                .s = {c.xx, c.yy, c.zz, c.xy, c.yz, c.xz},
                .principal = fl_zone_principal(c, &axes),
                .yielded = fl_zone_lost(s, k)};
            fl_table_write_row(f, &fl_zones_table, 0, t, &row);
        }
    }
}

/* 1 if the structure as a whole translates: frames then have its displacement, else the pose of each part. */
static int only_translates(const fl_world *w)
{
    return w->moving.movers.n == 1 && w->scene->n_part == 0 && fl_motion_columns(w) == FL_LOADS_TRANSLATION;
}

static fl_vec3 displacement_of(const fl_world *w)
{
    if (!only_translates(w)) return v3(0, 0, 0);
    return v3_sub(w->moving.movers.b.x[0], w->moving.movers.motion[0].reference);
}

/* packed NULL: as text. */
static int write_part_pose(FILE *f, fl_packed_writer *packed, int32_t id, fl_vec3 x, fl_quat q, fl_err *err)
{
    if (packed) return fl_packed_frame_part(packed, id, x, q, err);
    fl_frames_part_pose(f, id, x, q);
    return 0;
}

/* Each part with a motion of its own. */
static int write_part_poses(const struct run *r, FILE *f, fl_packed_writer *packed, fl_err *err)
{
    const fl_rigid_motions *v = &r->w->moving.movers;
    const fl_member_motion *members = &r->w->moving.members;
    for (int32_t k = 0; k < members->dynamics.chain.contacts; k++) {
        fl_vec3 x;
        fl_quat q;
        if (r->frames_surface->part[k].nc == 0) continue;
        fl_member_motion_piece_pose(members, k, &x, &q);
        if (write_part_pose(f, packed, r->frames_surface->part[k].id, x, q, err)) return -1;
    }
    if (v->n == 0 || only_translates(r->w)) return 0;
    for (int32_t p = 0; p < r->w->parts; p++) {
        const int32_t m = r->w->moving.mover_of_part[p];
        if (m < 0) continue;
        const fl_vec3 x = v3_sub(v->b.x[m], m3_mul(fl_body_axes(&v->b, m), v->motion[m].reference));
        if (write_part_pose(f, packed, r->surface->part[p].id, x, v->b.q[m], err)) return -1;
    }
    return 0;
}

/* Shapes of floes that came in from step `since` on. */
static void write_new_shapes(const struct run *r, FILE *f, const fl_poses *now, int64_t since)
{
    const fl_inflow_state *in = &r->w->inflow;
    for (int32_t i = 0; i < r->w->n && since >= 0; i++)
        if (!in->absent[i] && in->entry_step[i] > 0 && in->entry_step[i] >= since) fl_frames_shape(f, now, i);
}

static int write_packed_shapes(const struct run *r, FILE *f, fl_packed_writer *packed, const fl_poses *now,
                               int64_t since, fl_err *err)
{
    char *text = NULL;
    size_t n = 0;
    FILE *records = since >= 0 ? open_memstream(&text, &n) : NULL;
    if (since < 0) return 0;
    if (!records) return fl_fail(err, FL_SYSTEM, "out of memory for frames");
    write_new_shapes(r, records, now, since);
    const int lost = fclose(records) != 0;
    const int rc = lost ? fl_fail(err, FL_SYSTEM, "out of memory for frames")
                        : fl_packed_frames_text(f, packed, text, (int64_t)n, err);
    free(text);
    return rc;
}

int write_frame(const struct run *r, FILE *f, fl_packed_writer *packed, double t, int ice, int64_t since,
                fl_err *err)
{
    const fl_poses now = poses_of(r);
    const fl_vec3 displacement = displacement_of(r->w);
    if (!packed) {
        write_new_shapes(r, f, &now, since);
        fl_frames_frame(f, t, &now, displacement, ice);
        return write_part_poses(r, f, NULL, err);
    }
    fl_packed_frame_clear(packed);
    return write_packed_shapes(r, f, packed, &now, since, err) ||
                   (ice && fl_frames_packed_bodies(packed, &now, err)) ||
                   write_part_poses(r, f, packed, err) ||
                   fl_packed_frame_write(f, packed, t, ice, v3_nonzero(displacement) ? &displacement : NULL,
                                         err)
               ? -1
               : 0;
}
