/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/memory_use.h"
#include "contact/disc_list.h"
#include "sim/sleep.h"
#include "sphere/contact_list.h"

#define ARRAY(p, n) ((p) ? (double)(n) * (double)sizeof *(p) : 0.0)

static double tree_bytes(const fl_bvh *t)
{
    return ARRAY(t->node, t->node_cap) + ARRAY(t->order, t->order_cap);
}

static double hull_bytes(const fl_hull *h) { return h->shape ? ARRAY(h->face_area, 4 * h->shape->nf) : 0.0; }

static double scratch_bytes(const fl_patch_points *s)
{
    return ARRAY(s->va, s->va_cap) + ARRAY(s->na, s->na_cap) + ARRAY(s->point, s->point_cap) +
           ARRAY(s->polygon, s->polygon_cap) + ARRAY(s->feature, s->feature_cap) +
           ARRAY(s->distances[0].h, s->distances[0].h_cap) + ARRAY(s->distances[0].x, s->distances[0].x_cap) +
           ARRAY(s->distances[1].h, s->distances[1].h_cap) + ARRAY(s->distances[1].x, s->distances[1].x_cap);
}

static double body_bytes(const fl_world *w)
{
    const fl_bodies *b = &w->b;
    const int32_t n = w->n, total = b->total;
    return ARRAY(b->x, total) + ARRAY(b->v, total) + ARRAY(b->L, total) + ARRAY(b->q, total) +
           ARRAY(b->w, total) + ARRAY(b->f, total) + ARRAY(b->t, total) + ARRAY(b->m, total) +
           ARRAY(b->invm, total) + ARRAY(b->I, total) + ARRAY(b->invI, total) + ARRAY(b->radius, total) +
           ARRAY(b->bounding_radius, total) + ARRAY(b->fixed_dof, total) + ARRAY(b->is_isotropic, total) +
           ARRAY(b->work_of_constraints, total) + ARRAY(b->odometer, total) + ARRAY(b->added_mass, total) +
           ARRAY(b->heave_mass, total) + ARRAY(b->heave_work, total) + ARRAY(b->flow_velocity, total) +
           ARRAY(b->flow_work, total) + ARRAY(w->id, n) + ARRAY(w->material, total) +
           ARRAY(w->max_face_area, total) + ARRAY(w->q0, n) + ARRAY(w->blocks, n / FL_BODY_BLOCK + 1) +
           ARRAY(w->contact_sums.slot, total) + ARRAY(w->previous_sums.slot, total) +
           ARRAY(w->contact_sums.sum, w->contact_sums.cap) +
           ARRAY(w->previous_sums.sum, w->previous_sums.cap) + ARRAY(w->kick_change, w->change_cap) +
           ARRAY(w->predicted_change, w->change_cap);
}

static double water_bytes(const fl_environment *s)
{
    double sum = ARRAY(s->hull, s->n) + ARRAY(s->drag_radius, s->n) + ARRAY(s->wetted_area, s->n) +
                 ARRAY(s->buoyancy, s->n) + ARRAY(s->flow_velocity, s->n) + ARRAY(s->drag_loss, s->n) +
                 ARRAY(s->wind_work, s->n) + ARRAY(s->drag_surface, s->n) + ARRAY(s->panels, s->n) +
                 ARRAY(s->cells, (double)s->threads * s->cells_per_thread) + ARRAY(s->water_force, s->n) +
                 ARRAY(s->water_moment, s->n) + ARRAY(s->water_work, s->n) + ARRAY(s->sample, s->n) +
                 ARRAY(s->nodes, s->n) + ARRAY(s->block, s->n) +
                 ARRAY(s->node_scratch, (double)s->threads * s->scratch_per_thread) +
                 fl_wave_grid_bytes(&s->grid);
    for (int32_t i = 0; i < s->n; i++) {
        sum += hull_bytes(&s->hull[i]);
        const fl_poly *const outer = fl_environment_outer(s, i);
        if (outer) sum += (double)sizeof *outer + fl_poly_bytes(outer);
        if (s->drag_surface)
            sum += fl_facets_bytes(&s->drag_surface[i].facets, &s->hull[i]) +
                   fl_facet_cut_bytes(&s->drag_surface[i].wet) + fl_facet_cut_bytes(&s->drag_surface[i].dry);
        if (s->panels)
            sum += ARRAY(s->panels[i].face, s->panels[i].n) + ARRAY(s->panels[i].v, 3 * s->panels[i].n);
        if (s->nodes)
            sum += ARRAY(s->nodes[i].x, s->nodes[i].n) + ARRAY(s->nodes[i].w, s->nodes[i].n) +
                   ARRAY(s->nodes[i].area, s->nodes[i].n);
    }
    return sum;
}

static double search_bytes_of(const fl_world *w)
{
    const int32_t total = w->b.total;
    return ARRAY(w->odometer_at_search, total) + ARRAY(w->first_pair_of_body, w->first_pair_of_body_cap) +
           ARRAY(w->pairs_of_body, w->pairs_of_body_cap) + ARRAY(w->pair_touches, w->pair_touches_cap) +
           ARRAY(w->next_check, w->next_check_cap) + ARRAY(w->touching_pairs, w->touching_pairs_cap) +
           ARRAY(w->body_touches, total);
}

static double other_bytes(const fl_world *w)
{
    const fl_inflow_state *t = &w->inflow;
    const fl_bond_list *z = &w->bonds;
    const fl_panel_loads *q = &w->panel_load;
    const int32_t n = w->n, fixed = w->b.total - n;
    double sum = ARRAY(t->absent, n) + ARRAY(t->entry_step, n) + ARRAY(t->source_floe, n) +
                 ARRAY(t->guided, n) + ARRAY(t->own_fixed_dof, n);
    if (w->crushing.dents) sum += ARRAY(w->crushing.dents, n);
    for (int32_t i = 0; i < n && w->crushing.dents; i++)
        if (w->crushing.dents[i]) sum += ARRAY(w->crushing.dents[i], 1);
    if (w->breaking.on)
        sum += ARRAY(w->breaking.shape, n) + ARRAY(w->breaking.last_load, n) +
               ARRAY(w->breaking.bend_gate, n) + ARRAY(w->breaking.split_gate, n) +
               ARRAY(w->breaking.event, w->breaking.event_cap);
    for (int32_t i = 0; i < n && w->breaking.on; i++)
        if (w->breaking.shape[i]) sum += fl_poly_bytes(w->breaking.shape[i]);
    if (t->feed) sum += ARRAY(t->lag, t->feed->n) + ARRAY(t->next_copy, t->feed->n);
    if (t->join.first)
        sum += ARRAY(t->join.first, t->feed->n) + ARRAY(t->join.newest, t->feed->n) +
               ARRAY(t->join.partner, t->join.first[t->feed->n]) + ARRAY(t->join.birth, t->join.birth_cap);
    sum += ARRAY(w->driven_floes.is_driven, w->driven_floes.n) +
           (w->driven_floes.n ? ARRAY(w->driven_floes.k, n) + ARRAY(w->driven_floes.rest_height, n) : 0.0);
    sum += fl_sleep_bytes(w) + fl_disc_list_bytes(w);
    sum += ARRAY(z->bond, z->n) + ARRAY(z->image, 3 * (double)z->n) + ARRAY(z->radius_factor, z->n) +
           ARRAY(z->omega2, 2 * (double)z->n) + ARRAY(z->of, 2 * (double)z->n) +
           ARRAY(z->max_omega2, w->b.total) + ARRAY(z->first, w->b.total + 1);
    if (z->joint)
        sum += ARRAY(z->joint, z->n - z->faces) + ARRAY(z->corner, z->corners) +
               ARRAY(z->joint_material, w->scene->n_joint + (w->zones.set.blocks > 0));
    if (w->zones.set.blocks) {
        const fl_zone_joint_list *l = &w->zones.joints;
        sum += fl_zone_set_bytes(&w->zones.set) + ARRAY(l->joint, l->n) + ARRAY(l->point, l->points) +
               ARRAY(l->triangle, l->triangles) + ARRAY(w->zones.block_of, n) +
               ARRAY(w->zones.joint_of, z->n - z->faces);
        sum += (w->zones.drag ? ARRAY(w->zones.drag, w->zones.set.nodes) : 0.0) +
               (w->zones.push ? ARRAY(w->zones.push, w->zones.set.nodes) : 0.0);
    }
    const int32_t triangles = q->first_triangle ? q->first_triangle[q->pieces] : 0;
    sum += ARRAY(q->panel, q->all) + ARRAY(q->triangle, triangles) + ARRAY(q->box, triangles) +
           ARRAY(q->impulse, q->panels) + ARRAY(q->point, q->point_cap) + ARRAY(q->share, q->share_cap);
    for (int32_t k = 0; k < q->pieces && q->tree; k++) sum += tree_bytes(&q->tree[k]);
    sum += ARRAY(w->elastic_walls.outer, n) + ARRAY(w->elastic_walls.hull, n);
    for (int32_t i = 0; i < n && w->elastic_walls.hull; i++)
        sum += fl_poly_bytes(&w->elastic_walls.outer[i]) + hull_bytes(&w->elastic_walls.hull[i]);
    const fl_member_dynamics *d = &w->moving.members.dynamics;
    const double balls = d->chain.balls;
    sum += ARRAY(d->chain.ball, balls) + ARRAY(d->chain.contact, d->chain.contacts) +
           ARRAY(d->chain.beams, d->chain.beam_sets) + ARRAY(d->chain.force, d->chain.contacts) +
           2.0 * ARRAY(d->chain.resist, balls) + 2.0 * ARRAY(d->mass, balls) + 3.0 * ARRAY(d->force, balls) +
           ARRAY(d->modes.shape, 6.0 * balls * d->modes.n);
    sum += ARRAY(w->structure.piece, w->structure.cap);
    for (int32_t k = 0; k < fixed; k++) {
        const fl_piece_mesh *h = &w->structure.piece[k].mesh;
        const fl_poly *p = &w->structure.piece[k].core;
        sum += ARRAY(h->seams.seam, h->seams.cap) + ARRAY(h->seams.begin, p->nf + 1) +
               ARRAY(h->seams.rim, p->nf ? p->first[p->nf] : 0);
        sum += fl_poly_bytes(p) + tree_bytes(&h->tree) + tree_bytes(&h->edge_tree) +
               ARRAY(h->corner, h->corners) + ARRAY(h->box, p->nf) + ARRAY(h->edge_box, p->ne);
    }
    for (int32_t k = 0; k < w->threads; k++) sum += scratch_bytes(&w->scratch[k]);
    return sum;
}

fl_memory_use fl_memory_use_of(const fl_world *w)
{
    fl_memory_use b = {.bodies = body_bytes(w),
                       .water = w->sea.n ? water_bytes(&w->sea) : 0.0,
                       .search = search_bytes_of(w),
                       .sphere_contacts = fl_contact_list_bytes(w),
                       .others = other_bytes(w),
                       .search_peak = w->search_bytes};
    b.shapes = ARRAY(w->b.core, w->b.total) + fl_topologies_bytes(&w->topologies);
    for (int32_t k = 0; k < w->b.total; k++) {
        b.shapes += fl_poly_bytes(&w->b.core[k]);
        if (w->quick_shape) b.shapes += fl_quick_shape_bytes(&w->quick_shape[k]);
    }
    b.pairs = ARRAY(w->pair, w->n_pair) + ARRAY(w->pair_store.block, w->pair_store.cap) +
              (double)w->pair_store.blocks * FL_PAIR_SLOTS * (double)sizeof(fl_pair_slot);
    for (int32_t c = 0; c < w->n_pair; c++) {
        const fl_pair *p = w->pair[c].contact;
        if (p && p->feature_pairs) b.feature_pairs += fl_feature_pairs_bytes(p->feature_pairs);
        if (p && p->quick_list) b.feature_pairs += fl_quick_list_bytes(p->quick_list);
        if (p && p->surrogate) b.pairs += sizeof *p->surrogate;
        if (p && p->rolling) b.pairs += sizeof *p->rolling;
    }
    return b;
}

double fl_memory_use_sum(const fl_memory_use *b)
{
    return b->bodies + b->shapes + b->water + b->search + b->pairs + b->feature_pairs + b->sphere_contacts +
           b->others;
}
