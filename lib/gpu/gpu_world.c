/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu/gpu_world.h"
#include <string.h>
#include "base/array.h"
#include "body/integrate.h"
#include "contact/bond_list.h"
#include "contact/pair_law.h"
#include "gpu/gpu_lists.h"
#include "gpu/gpu_memory.h"
#include "gpu/gpu_pairs.h"
#include "sphere/contact_list.h"
#include "sphere/floating_batch.h"
#include "sphere/sphere_pair.h"
#include "world/access.h"

/* --- what runs there ----------------------------------------------------------------------------- */

static int has_isotropic_bodies(const fl_world *w)
{
    for (int32_t k = 0; k < w->n; k++)
        if (w->b.is_isotropic[k]) return 1;
    return 0;
}

const char *fl_gpu_world_refuses(const fl_world *w)
{
    if (!has_isotropic_bodies(w)) return "no spheres";
    if (w->scene->run.sleep > 0.0) return "run.sleep";
    if (w->scene->run.error > 0.0) return "run.error";
    if (w->b.added_mass) return "added mass by axes of bodies";
    if (w->breaking.on) return "floes that fail";
    if (w->push.of) return "ice that is pushed with a line load, or a wall that moves";
    return NULL;
}

int fl_gpu_world_has_other_water(const fl_world *w)
{
    const fl_environment *s = &w->sea;
    return s->n &&
           (s->waves || s->wind || s->flow_velocity || s->drag_surface || s->impulses || w->b.added_mass ||
            (w->b.heave_mass && !fl_floating_batch_applies(w)) || (s->water && !s->only_spheres));
}

/* Rows of a sphere in a dense pack with the skin, before they are listed. */
#define FEW_ROWS 5.0

double fl_gpu_world_bytes(const fl_world *w)
{
    const double body = sizeof(fl_sphere_state) + 2.0 * sizeof(fl_sphere_sum) + 6.0 * sizeof(fl_vec3) +
                        sizeof(fl_quat) + 24.0 * sizeof(double),
                 row = 2.0 * sizeof(fl_sphere_contact) + sizeof(fl_gpu_row_result) + 12.0 * sizeof(int32_t) +
                       (w->has_rolling ? 2.0 * sizeof(fl_rolling_spring) : 0.0) +
                       (w->cell.periodic ? 6.0 * sizeof(int32_t) : 0.0),
                 bond = sizeof(fl_disc_memory) + sizeof(fl_disc_wrench) + 6.0 * sizeof(double);
    const double rows = w->spheres.n ? w->spheres.n : (w->discs.n ? 1.0 : FEW_ROWS) * w->n;
    return w->n * body + rows * row + w->discs.n * bond;
}

/* --- memory ---------------------------------------------------------------------------------------- */

fl_gpu_world *fl_gpu_world_make(const fl_gpu_engine *e, fl_err *err)
{
    fl_gpu_world *const g = fl_alloc(1, sizeof *g, err);
    if (g) g->e = e;
    return g;
}

void fl_gpu_world_free(fl_gpu_world *g)
{
    if (!g) return;
    for (int k = 0; k < FL_GPU_BUFFERS; k++)
        if (g->memory[k].at) g->e->release(g->memory[k].at);
    g->e->close();
    fl_gpu_near_free(g);
    free(g->host), free(g->guest), free(g->guest_disc), free(g->guest_state), free(g->guest_sum),
        free(g->guest_wrench), free(g->moves), free(g->leaves);
    free(g);
}

const char *fl_gpu_world_device(const fl_gpu_world *g) { return g->e->device(); }

const int32_t *fl_gpu_world_guests(const fl_gpu_world *g, int32_t *n)
{
    *n = g->guests;
    return g->guest;
}

int fl_gpu_world_owns(const fl_gpu_world *g, int32_t k) { return g->uploaded && !g->host[k]; }

int fl_gpu_world_release(fl_gpu_world *g, const fl_world *w, int32_t k, fl_err *err)
{
    return fl_gpu_world_owns(g, k) ? fl_gpu_set_hold(g, w, k, err) : 0;
}

int fl_gpu_world_leaves(const fl_gpu_world *g) { return g->leaving; }

void fl_gpu_world_forget(fl_gpu_world *g) { g->uploaded = 0; }

#define PUT FL_GPU_PUT
#define ROOM FL_GPU_ROOM
#define GET FL_GPU_GET
#define GET_LATER FL_GPU_GET_LATER
#define LAUNCH FL_GPU_LAUNCH

/* --- up ---------------------------------------------------------------------------------------------- */

static fl_vec3 yields_of(const fl_world *w, int32_t k)
{
    const fl_sym3 e = fl_body_mobility(&w->b, k).linear;
    return v3(e.xx, e.yy, e.zz);
}

/* A guest that the device moves from now on: the CPU has done the first half of this step. */
static int release_guest(fl_gpu_world *g, const fl_world *w, int32_t k, fl_err *err)
{
    const fl_vec3 yields = yields_of(w, k);
    const double inverse = fl_body_inverse_mass(&w->b, k);
    return g->e->upload(&g->v.state[k], &w->spheres.state[k], sizeof *g->v.state) ||
                   g->e->upload(&g->v.yields[k], &yields, sizeof yields) ||
                   g->e->upload(&g->v.inverse[k], &inverse, sizeof inverse)
               ? fl_gpu_fail(g, err)
               : 0;
}

static int is_guest(const fl_gpu_world *g, int32_t k)
{
    return g->host[k] == FL_GPU_GUEST || g->host[k] == FL_GPU_NEW_GUEST;
}

static int choose_guests(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    const fl_disc_list *s = &w->discs;
    if (!g->host) {
        g->n = w->n;
        g->host = fl_alloc(w->n, sizeof *g->host, err);
        g->guest = fl_alloc(w->n, sizeof *g->guest, err);
        g->guest_state = fl_alloc(w->n, sizeof *g->guest_state, err);
        g->guest_sum = fl_alloc(w->n, sizeof *g->guest_sum, err);
        g->moves = fl_alloc(2 * ((int64_t)w->n / FL_BODY_BLOCK + 2), sizeof *g->moves, err);
        g->leaves = fl_alloc((int64_t)w->n / FL_BODY_BLOCK + 1, sizeof *g->leaves, err);
        if (!g->leaves || !g->host || !g->guest || !g->guest_state || !g->guest_sum || !g->moves) return -1;
    }
    g->guests = g->guest_discs = g->tiles = g->listed = 0;
    const int all = fl_gpu_world_has_other_water(w);
    for (int32_t k = 0; k < w->n; k++) {
        int kind = fl_gpu_body_kind(g, w, k, err);
        if (kind < 0) return -1;
        if (all && kind == FL_GPU_OWN) kind = FL_GPU_GUEST;
        if (kind == FL_GPU_OWN && g->host[k] && g->uploaded && release_guest(g, w, k, err)) return -1;
        if (kind == FL_GPU_GUEST) {
            g->guest[g->guests++] = k;
            if (g->uploaded && g->host[k] == FL_GPU_OWN) kind = FL_GPU_NEW_GUEST;
        }
        g->host[k] = (uint8_t)kind;
    }
    for (int32_t k = 0; k < s->n; k++) {
        if (!is_guest(g, s->at.i[k]) && !is_guest(g, s->at.j[k])) continue;
        if (fl_grow(&g->guest_disc, &g->guest_disc_cap, (int64_t)g->guest_discs + 1, sizeof *g->guest_disc,
                    err))
            return -1;
        g->guest_disc[g->guest_discs++] = k;
    }
    free(g->guest_wrench);
    g->guest_wrench = fl_alloc(g->guest_discs, sizeof *g->guest_wrench, err);
    return g->guest_wrench || !g->guest_discs ? 0 : -1;
}

static int put_guests(fl_gpu_world *g, fl_err *err)
{
    return PUT(host, g->host, g->n) || PUT(guest, g->guest, g->guests) || ROOM(guest_state, g->guests) ||
                   ROOM(guest_work, g->guests) || ROOM(guest_sum, g->guests) ||
                   PUT(guest_disc, g->guest_disc, g->guest_discs) || ROOM(guest_wrench, g->guest_discs)
               ? -1
               : 0;
}

static void set_parameters(fl_gpu_world *g, const fl_world *w)
{
    const fl_environment *s = &w->sea;
    fl_gpu_view *v = &g->v;
    if (!g->uploaded || !g->makes_lists) v->rows = w->spheres.n;
    v->n = w->n, v->walls = w->spheres.walls, v->discs = w->discs.n;
    v->guests = g->guests, v->guest_discs = g->guest_discs;
    v->chunks = w->spheres.chunks, v->blocks = fl_block_count(w), v->wall_planes = w->walls;
    v->plane_first = w->n + w->pieces;
    v->floats = !s->water ? 0 : fl_floating_batch_applies(w) ? 2 : 1;
    v->linear = fl_round_exponent(w) == 1.0;
    v->has_rolling = w->has_rolling, v->damped_discs = w->discs.at.damped != NULL;
    v->gravity = w->gravity;
    v->cell_lo = w->cell.lo, v->cell_length = w->cell.length;
    v->domain_lo = w->inflow.lo, v->domain_hi = w->inflow.hi;
    v->law_columns = w->materials + 2;
    v->drag = (fl_sphere_drag){0.5 * s->seawater.force_coefficient * s->seawater.density,
                               0.5 * s->seawater.moment_coefficient * s->seawater.density, 0.0,
                               s->current.velocity, s->seawater.moment_coefficient > 0.0 ? 1.0 : 0.0};
    v->level = s->level, v->specific_weight = s->specific_weight;
    v->heave_factor = w->b.heave_mass ? s->heave_factor : 0.0, v->gravity_size = s->gravity;
    v->disc_law = w->discs.law;
}

static int put_yields(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    fl_vec3 *const y = fl_alloc(w->n, sizeof *y, err);
    for (int32_t k = 0; y && k < w->n; k++) y[k] = yields_of(w, k);
    const int bad = !y || PUT(yields, y, w->n);
    free(y);
    return bad ? -1 : 0;
}

/* Constants of bodies, laws, walls and the sea, once. */
static int put_constants(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    const int32_t n = w->n, laws = w->materials * (w->materials + 2);
    const fl_bodies *b = &w->b;
    double *const one = fl_alloc(4 * (int64_t)n, sizeof *one, err);
    fl_gpu_law *const law = fl_alloc(laws, sizeof *law, err);
    fl_gpu_wall *const wall = fl_alloc(w->walls, sizeof *wall, err);
    int bad = !one || !law || (w->walls && !wall);
    for (int32_t k = 0; k < n && !bad; k++)
        one[k] = b->invI[k].x, one[n + k] = b->I[k].x, one[2 * n + k] = fl_body_inverse_mass(b, k);
    for (int32_t k = 0; k < laws && !bad; k++) {
        const fl_pair_law *p = &w->law[k];
        law[k] = (fl_gpu_law){p->friction,         p->tangential_ratio,
                              p->impact_damping,   p->slow_damping_factor * p->slow_damping_factor,
                              p->rolling,          p->stiffness,
                              p->stiffness_factor, p->modulus,
                              p->round_young};
    }
    for (int32_t k = 0; k < w->walls && !bad; k++) {
        const int32_t j = w->n + w->pieces + k;
        wall[k] = (fl_gpu_wall){m3_col(fl_body_axes(b, j), 2), b->x[j]};
    }
    bad = bad || PUT(turn, one, n) || PUT(inertia, one + n, n) || PUT(inverse, one + 2 * n, n) ||
          PUT(m, b->m, n) || PUT(invm, b->invm, n) || PUT(law, law, laws) || PUT(plane, wall, w->walls) ||
          PUT(material, w->material, n) || ROOM(control, 1);
    if (!bad && w->sea.water) {
        bad = PUT(drag_radius, w->sea.drag_radius, n);
        for (int32_t k = 0; k < n; k++)
            one[k] = w->sea.hull[k].volume, one[n + k] = w->sea.hull[k].surface_area,
            one[2 * n + k] = w->sea.hull[k].fill;
        bad = bad || PUT(volume, one, n) || PUT(surface, one + n, n) || PUT(fill, one + 2 * n, n);
    }
    if (!bad && w->inflow.leaves) {
        for (int32_t k = 0; k < n; k++) one[k] = fl_body_extent(b, k);
        bad = PUT(extent, one, n) || ROOM(leaves, fl_block_count(w));
    }
    free(one), free(law), free(wall);
    return bad || put_yields(g, w, err) ? -1 : 0;
}

/* States of all bodies between two steps. */
static int put_states(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    fl_sphere_state *const s = fl_alloc(w->n, sizeof *s, err);
    if (!s) return -1;
    for (int32_t k = 0; k < w->n; k++)
        s[k] = (fl_sphere_state){
            .x = w->b.x[k], .r = w->b.radius[k], .v = w->b.v[k], .w = w->b.w[k], .r_copy = w->b.radius[k]};
    const int bad = PUT(state, s, w->n);
    free(s);
    return bad ? -1 : 0;
}

static int put_bodies(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    const fl_bodies *b = &w->b;
    const fl_environment *s = &w->sea;
    const int32_t n = w->n;
    if (PUT(L, b->L, n) || PUT(f, b->f, n) || PUT(t, b->t, n) || PUT(q, b->q, n) ||
        PUT(odometer, b->odometer, n) || PUT(odometer_at_search, w->odometer_at_search, n) ||
        (!(g->uploaded && g->makes_lists) && PUT(contact_count, w->spheres.contact_count, n)) ||
        PUT(sum, w->spheres.sum, n) || PUT(previous_sum, w->spheres.previous_sum, n) ||
        ROOM(contact_force, n) || ROOM(damping_work, n) || ROOM(friction_work, n) || ROOM(bad, n) ||
        ROOM(block, g->v.blocks) || ROOM(totals, g->v.chunks) || ROOM(moves, 2 * (int64_t)g->v.blocks) ||
        ROOM(omega2, n) || ROOM(wall_load, (int64_t)g->v.chunks * w->walls))
        return -1;
    if (s->water && (PUT(wetted_area, s->wetted_area, n) || PUT(buoyancy, s->buoyancy, n) ||
                     PUT(drag_loss, s->drag_loss, n)))
        return -1;
    return b->heave_mass && (PUT(heave_mass, b->heave_mass, n) || PUT(heave_work, b->heave_work, n)) ? -1 : 0;
}

/* Rows of each body in the order of its sums: those of its chunk whose j it is, its own, those of chunks
 * before.  In each part they ascend. */
static int put_links(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    const fl_sphere_contacts *s = &w->spheres;
    int32_t *const first = fl_alloc((int64_t)w->n + 1, sizeof *first, err),
                   *const at = fl_alloc((int64_t)w->n + 1, sizeof *at, err),
                   *const link = fl_alloc(2 * (int64_t)s->n, sizeof *link, err);
    int bad = !first || !at || (s->n && !link);
    for (int32_t c = 0; c < s->n && !bad; c++) first[s->i[c] + 1]++, first[s->j[c] + 1]++;
    for (int32_t k = 0; k < w->n && !bad; k++) first[k + 1] += first[k], at[k] = first[k];
    for (int32_t c = 0; c < s->n && !bad; c++)
        if (s->i[c] / FL_SPHERE_CHUNK == s->j[c] / FL_SPHERE_CHUNK) link[at[s->j[c]]++] = 2 * c + 1;
    for (int32_t c = 0; c < s->n && !bad; c++) link[at[s->i[c]]++] = 2 * c;
    for (int32_t c = 0; c < s->n && !bad; c++)
        if (s->i[c] / FL_SPHERE_CHUNK != s->j[c] / FL_SPHERE_CHUNK) link[at[s->j[c]]++] = 2 * c + 1;
    bad = bad || PUT(link_first, first, (int64_t)w->n + 1) || PUT(link, link, 2 * (int64_t)s->n);
    free(first), free(at), free(link);
    return bad ? -1 : 0;
}

static int put_walls(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    const fl_sphere_contacts *s = &w->spheres;
    int32_t *const first = fl_alloc((int64_t)w->n + 1, sizeof *first, err);
    int bad = !first;
    for (int32_t c = 0; c < s->walls && !bad; c++) first[s->wall[c].i + 1]++;
    for (int32_t k = 0; k < w->n && !bad; k++) first[k + 1] += first[k];
    bad = bad || PUT(wall_of_body, first, (int64_t)w->n + 1) || PUT(wall, s->wall, s->walls) ||
          PUT(wall_of_chunk, s->wall_first, (int64_t)s->chunks + 1) || ROOM(wall_result, s->walls) ||
          (s->wall_rolling && PUT(wall_rolling, s->wall_rolling, s->walls));
    free(first);
    return bad ? -1 : 0;
}

static int put_rows(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    const fl_sphere_contacts *s = &w->spheres;
    return PUT(row_i, s->i, s->n) || PUT(row_j, s->j, s->n) || PUT(row_law, s->law, s->n) ||
                   PUT(touches, s->touches, s->n) || PUT(contact, s->contact, s->n) || ROOM(result, s->n) ||
                   PUT(first, s->first, (int64_t)w->n + 1) ||
                   (s->image && PUT(row_image, s->image, 3 * (int64_t)s->n)) ||
                   (s->rolling && PUT(rolling, s->rolling, s->n))
               ? -1
               : 0;
}

static int put_discs(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    const fl_disc_list *s = &w->discs;
    if (!s->n) return 0;
    fl_disc_memory *const m = fl_alloc(s->n, sizeof *m, err);
    double *const k = fl_alloc(s->n, sizeof *k, err);
    int bad = !m || !k;
    for (int32_t c = 0; c < s->n && !bad; c++)
        m[c] = fl_disc_list_memory(s, c), k[c] = fl_pair_stiffness(w, s->at.i[c], s->at.j[c]).k;
    bad = bad || PUT(disc, m, s->n) || PUT(disc_k, k, s->n) || PUT(disc_class, s->classes, s->n_class) ||
          PUT(disc_which, s->at.which, s->n) || PUT(disc_i, s->at.i, s->n) || PUT(disc_j, s->at.j, s->n) ||
          (s->at.scatter && PUT(disc_scatter, s->at.scatter, s->n)) ||
          (s->shift && (PUT(disc_shift, s->shift, s->n) || PUT(disc_image, s->image, 3 * (int64_t)s->n))) ||
          PUT(disc_out, s->at.out, s->n) || PUT(disc_whole, s->at.is_whole, s->n) ||
          PUT(disc_ended, s->has_ended, s->n) || ROOM(disc_done, s->n) || ROOM(disc_size, s->n) ||
          PUT(disc_pending, s->pending, s->n) || PUT(disc_first_i, s->first_i, (int64_t)w->n + 1) ||
          PUT(disc_first_j, s->first_j, (int64_t)w->n + 1) || PUT(disc_of, s->of, s->n) ||
          ROOM(disc_force_sum, s->n / FL_DISC_RUN + 1);
    free(m), free(k);
    return bad ? -1 : 0;
}

/* The states of guests after their first half. */
static int give_guests(fl_gpu_world *g, const fl_world *w, fl_err *err)
{
    for (int32_t k = 0; k < g->guests; k++) {
        const int32_t i = g->guest[k];
        g->guest_state[k] =
            (fl_gpu_guest_state){w->spheres.state[i], yields_of(w, i), fl_body_inverse_mass(&w->b, i)};
        if (g->host[i] != FL_GPU_NEW_GUEST) continue;
        g->guest_state[k].state.r = 0.0;
        g->host[i] = FL_GPU_GUEST;
    }
    return PUT(guest_state, g->guest_state, g->guests) || LAUNCH(TAKE_GUESTS, g->guests) ? -1 : 0;
}

int fl_gpu_world_upload(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    if (!g->uploaded) g->has_listed |= w->spheres.bodies && g->n == 0;
    if (!w->spheres.bodies && fl_contact_list_index(w, err)) return -1;
    g->has_listed |= w->spheres.walls || (w->spheres.n && !(g->uploaded && g->makes_lists));
    if (choose_guests(g, w, err)) return -1;
    set_parameters(g, w);
    if (!g->uploaded && (put_constants(g, w, err) || put_states(g, w, err))) return -1;
    if (put_guests(g, err) || put_bodies(g, w, err) || put_walls(g, w, err) || fl_gpu_put_near(g, w, err))
        return -1;
    g->pairs_known = g->uploaded;
    if (g->uploaded && g->makes_lists) return give_guests(g, w, err) || fl_gpu_lists_make(g, w, err) ? -1 : 0;
    if (put_rows(g, w, err) || put_links(g, w, err) || put_discs(g, w, err)) return -1;
    g->makes_lists = fl_gpu_lists_apply(w);
    g->rows_newer = g->rows_dead = 0;
    g->uploaded = 1;
    return 0;
}

/* --- down -------------------------------------------------------------------------------------------- */

/* Copies those of the device's own bodies; the guests are the CPU's. */
static int get_states(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    fl_bodies *b = &w->b;
    fl_sphere_state *const all = fl_alloc(w->n, sizeof *all, err);
    const int bad = !all || GET(state, all, w->n);
    for (int32_t k = 0; k < w->n && !bad; k++) {
        if (g->host[k]) continue;
        w->spheres.state[k] = all[k];
        b->x[k] = all[k].x, b->v[k] = all[k].v, b->w[k] = all[k].w;
    }
    free(all);
    return bad ? -1 : 0;
}

/* An array of the world, where guests keep their numbers; size: of an element. */
static int get_own(fl_gpu_world *g, void *to, const void *from, size_t size, fl_err *err)
{
    char *const all = fl_alloc(g->n, size, err);
    if (!all) return -1;
    const int bad = fl_gpu_get_bytes(g, all, from, (size_t)g->n * size, err);
    for (int32_t k = 0; k < g->n && !bad; k++)
        if (!g->host[k]) memcpy((char *)to + (size_t)k * size, all + (size_t)k * size, size);
    free(all);
    return bad ? -1 : 0;
}
#define GET_OWN(member, to) get_own(g, to, g->v.member, sizeof *g->v.member, err)

static int get_discs(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    fl_disc_list *s = &w->discs;
    if (!s->n) return 0;
    fl_disc_memory *const m = fl_alloc(s->n, sizeof *m, err);
    const int bad = !m || GET(disc, m, s->n) || GET(disc_ended, s->has_ended, s->n) ||
                    GET(disc_pending, s->pending, s->n) || GET(disc_out, s->at.out, s->n);
    for (int32_t c = 0; c < s->n && !bad; c++) fl_disc_list_set_memory(s, c, &m[c]);
    free(m);
    return bad ? -1 : 0;
}

/* The rows of a list that the device has made. */
static int get_new_rows(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    fl_sphere_contacts *s = &w->spheres;
    const int32_t n = g->v.rows;
    return fl_contact_list_resize(w, n, err) || GET(row_i, s->i, n) || GET(row_j, s->j, n) ||
                   GET(row_law, s->law, n) || (s->image && GET(row_image, s->image, 3 * (int64_t)n))
               ? -1
               : 0;
}

static int get_rows(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    fl_sphere_contacts *s = &w->spheres;
    if (g->rows_newer && get_new_rows(g, w, err)) return -1;
    if (GET(touches, s->touches, s->n) || GET(contact, s->contact, s->n) ||
        (s->rolling && GET(rolling, s->rolling, s->n)))
        return -1;
    if (g->rows_newer && fl_contact_list_offsets(w, err)) return -1;
    if (g->rows_dead && fl_contact_list_drop_absent(w) && fl_contact_list_offsets(w, err)) return -1;
    g->rows_newer = g->rows_dead;
    return 0;
}

int fl_gpu_world_download_bodies(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    fl_bodies *b = &w->b;
    fl_sphere_contacts *s = &w->spheres;
    fl_environment *sea = &w->sea;
    if (get_states(g, w, err) || GET_OWN(L, b->L) || GET_OWN(q, b->q) || GET_OWN(f, b->f) ||
        GET_OWN(t, b->t) || GET_OWN(odometer, b->odometer) || GET(sum, s->sum, w->n) ||
        GET(previous_sum, s->previous_sum, w->n) || GET(wall, s->wall, s->walls) ||
        (s->wall_rolling && GET(wall_rolling, s->wall_rolling, s->walls)))
        return -1;
    if (GET(contact_count, s->contact_count, w->n) || fl_gpu_get_near(g, w, err)) return -1;
    for (int32_t k = 0; k < w->n; k++) /* works of a body that comes to the CPU need them */
        if (!g->host[k]) s->previous_contact_count[k] = s->contact_count[k];
    if (sea->water && (GET_OWN(wetted_area, sea->wetted_area) || GET_OWN(buoyancy, sea->buoyancy) ||
                       GET_OWN(drag_loss, sea->drag_loss)))
        return -1;
    return b->heave_mass && (GET_OWN(heave_mass, b->heave_mass) || GET_OWN(heave_work, b->heave_work)) ? -1
                                                                                                       : 0;
}

int fl_gpu_world_download(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    return fl_gpu_world_download_bodies(g, w, err) || get_rows(g, w, err) || get_discs(g, w, err) ||
                   GET(contact_count, w->spheres.contact_count, w->n)
               ? -1
               : 0;
}

int fl_gpu_world_has_listed_none(const fl_gpu_world *g) { return !g->has_listed; }

int fl_gpu_world_makes_lists(const fl_gpu_world *g) { return g->uploaded && g->makes_lists; }

/* --- a step ------------------------------------------------------------------------------------------ */

int fl_gpu_world_first_half(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    if (!g->uploaded) { /* the sums of the world are swapped already */
        if (fl_gpu_world_upload(g, w, err)) return -1;
    } else {
        FL_GPU_EXCHANGE(sum, previous_sum); /* as fl_ledger_begin_step() */
    }
    g->v.dt = w->dt;
    fl_gpu_drift_guided(g, w);
    return LAUNCH(FIRST_HALF, w->n) || LAUNCH(BLOCK_MOVES, g->v.blocks) ? -1 : 0;
}

int fl_gpu_world_moves(fl_gpu_world *g, double largest[2], fl_err *err)
{
    largest[0] = largest[1] = 0.0;
    if (GET(moves, g->moves, 2 * (int64_t)g->v.blocks)) return -1;
    for (int32_t k = 0; k < 2 * g->v.blocks; k++) fl_update_two_largest(largest, g->moves[k]);
    return 0;
}

int fl_gpu_world_contacts(fl_gpu_world *g, fl_world *w, fl_err *err)
{
    const fl_gpu_control none = {0};
    g->v.step = (double)w->step;
    return give_guests(g, w, err) || PUT(control, &none, 1) || fl_gpu_begin_pairs(g, w, err) ||
                   LAUNCH(ROWS, g->v.rows) || LAUNCH(WALLS, g->v.walls) || LAUNCH(DISCS, g->v.discs) ||
                   LAUNCH(TELL_GUESTS, g->guests) || LAUNCH(TELL_DISCS, g->guest_discs)
               ? -1
               : 0;
}

int fl_gpu_world_sums(fl_gpu_world *g, fl_world *w, int stiffness, fl_err *err)
{
    fl_gpu_control c;
    if (GET_LATER(guest_sum, g->guest_sum, g->guests) ||
        GET_LATER(guest_wrench, g->guest_wrench, g->guest_discs) || GET(control, &c, 1) ||
        fl_gpu_take_pairs(g, w, c.touching, stiffness, err))
        return -1;
    for (int32_t k = 0; k < g->guests; k++) {
        w->spheres.sum[g->guest[k]] = g->guest_sum[k].sum;
        w->spheres.contact_count[g->guest[k]] = (int32_t)g->guest_sum[k].contacts;
    }
    for (int32_t k = 0; k < g->guest_discs; k++) w->discs.at.out[g->guest_disc[k]] = g->guest_wrench[k];
    g->pairs_known = 0;
    w->discs.ended += c.ended;
    return c.ended ? GET(disc_ended, w->discs.has_ended, w->discs.n) : 0;
}

int fl_gpu_world_second_half(fl_gpu_world *g, fl_world *w, int stiffness, fl_err *err)
{
    return (stiffness && LAUNCH(STIFFNESS, w->n)) || LAUNCH(SECOND_HALF, w->n) ||
                   LAUNCH(CHUNKS, g->v.chunks) ||
                   (w->discs.n &&
                    LAUNCH(DISC_RUNS, w->discs.n / FL_DISC_RUN + (w->discs.n % FL_DISC_RUN != 0)))
               ? -1
               : 0;
}

int fl_gpu_world_finish(fl_gpu_world *g, fl_world *w, const fl_gpu_guest_work *work, int stiffness,
                        fl_err *err)
{
    const int32_t runs = w->discs.n / FL_DISC_RUN + (w->discs.n % FL_DISC_RUN != 0);
    g->leaving = 0;
    if (PUT(guest_work, work, g->guests) || LAUNCH(TAKE_WORKS, g->guests) || LAUNCH(BLOCKS, g->v.blocks) ||
        (w->inflow.leaves && GET_LATER(leaves, g->leaves, g->v.blocks)) ||
        GET_LATER(totals, w->spheres.totals, g->v.chunks) ||
        GET_LATER(wall_load, w->spheres.wall_load, (int64_t)g->v.chunks * w->walls) ||
        GET_LATER(block, w->blocks, g->v.blocks) ||
        (runs && GET_LATER(disc_force_sum, w->discs.force_sum, runs)) ||
        (stiffness && GET_LATER(omega2, w->spheres.omega2, w->n)) || fl_gpu_wait(g, err))
        return -1;
    for (int32_t k = 0; k < g->v.blocks && w->inflow.leaves; k++) g->leaving |= g->leaves[k];
    return 0;
}
