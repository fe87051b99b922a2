/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/moving_structure.h"
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "sim/energy_ledger.h"
#include "sim/member_structure.h"

/* Motion m of [part PART], or of [structure], PART "": is there any? */
static int has_motion(const fl_scene *s, const fl_scene_motion *m, const char *part)
{
    int modes = part[0] == '\0' && s->structure.modes[0];
    for (int32_t k = 0; k < s->n_mode; k++) modes |= strcmp(s->mode[k].part, part) == 0;
    return v3_nonzero(m->velocity) || v3_nonzero(m->spin) || m->track[0] || m->free || modes;
}

/* Set the stiffness matrix from periods, stiffnesses and couplings of the scene. */
static void set_springs(fl_rigid_motion *out, const fl_scene_motion *m)
{
    const double T[] = {m->period.x, m->period.y, m->period.z},
                 k[] = {m->stiffness.x, m->stiffness.y, m->stiffness.z},
                 kt[] = {m->turn_stiffness.x, m->turn_stiffness.y, m->turn_stiffness.z};
    for (int i = 0; i < 3; i++) {
        const double w = T[i] > 0.0 ? 2.0 * PI / T[i] : 0.0;
        out->K[i][i] = k[i] + m->mass * w * w;
        out->K[3 + i][3 + i] = kt[i];
    }
    out->K[2][3] = out->K[3][2] = m->coupling.x;
    out->K[2][4] = out->K[4][2] = m->coupling.y;
    out->K[3][4] = out->K[4][3] = m->coupling.z;
}

/* Set the damping: c = 2 D sqrt(k m) along x y z, with k of all springs and of the water. */
static void set_dampers(fl_rigid_motion *out, const fl_scene_motion *m)
{
    const double D[] = {m->damping_ratio.x, m->damping_ratio.y, m->damping_ratio.z},
                 a[] = {m->added_mass.x, m->added_mass.y, m->added_mass.z};
    double c[3] = {m->damping.x, m->damping.y, m->damping.z};
    for (int i = 0; i < 3; i++)
        if (D[i] > 0.0) c[i] = 2.0 * D[i] * sqrt((out->K[i][i] + out->water_K[i][i]) * (m->mass + a[i]));
    out->c = v3(c[0], c[1], c[2]);
    out->ct = m->turn_damping;
}

/* Give the triangles of the parts of mover k to its hull, in waves. */
static int set_hull(fl_world *w, int32_t k, const fl_rigid_motion *m, const fl_surface *surface, fl_err *err)
{
    const fl_hydrostatics *f = &w->moving.hydrostatics[k];
    int64_t n = 0, all = 0;
    for (int32_t p = 0; p < surface->n; p++)
        if (w->moving.mover_of_part[p] == k) all += surface->part[p].nt;
    fl_vec3 *const v = fl_alloc(3 * all, sizeof *v, err);
    if (!v) return -1;
    for (int32_t p = 0; p < surface->n; p++) {
        const fl_part *part = &surface->part[p];
        for (int32_t t = 0; t < part->nt && w->moving.mover_of_part[p] == k; t++) {
            fl_vec3 x[3];
            for (int c = 0; c < 3; c++) x[c] = v3_sub(part->v[part->t[t].v[c]], m->reference);
            if (!(v3_norm2(v3_cross(v3_sub(x[1], x[0]), v3_sub(x[2], x[0]))) > 0.0)) continue;
            memcpy(v + 3 * n++, x, sizeof x);
        }
    }
    return fl_floating_hulls_set(&w->moving.movers.hulls, k, v, (int32_t)n, f->volume, f->buoyancy_centre,
                                 err);
}

/* Add the hydrostatic stiffness of the parts of mover k, to K or, in waves, to what its hull holds. */
static int add_hydrostatics(fl_world *w, int32_t k, fl_rigid_motion *out, const fl_surface *surface,
                            const char *section, int waves, fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_hydrostatics *f = &w->moving.hydrostatics[k];
    fl_err why = {0};
    char key[3 * FL_SCENE_NAME];
    int bad = 0;
    for (int32_t p = 0; p < surface->n && !bad; p++)
        if (w->moving.mover_of_part[p] == k)
            bad = fl_hydrostatics_add(f, &surface->part[p], s->water.level, out->reference, &why);
    if (bad || fl_hydrostatics_finish(f, s->water.level, out->reference, &why)) {
        if (why.code == FL_SYSTEM) {
            *err = why;
            return -1;
        }
        snprintf(key, sizeof key, "%s.%s", section, waves ? "waves" : "hydrostatic");
        return fl_scene_fail(s, key, err, "%s: %s", key, why.text);
    }
    fl_hydrostatics_stiffness(f, s->water.density * v3_norm(s->run.gravity), waves ? out->water_K : out->K);
    return waves ? set_hull(w, k, out, surface, err) : 0;
}

/* Adds the mode of the scene, along x (0) or y (1). */
static void add_mode(fl_rigid_motion *out, const fl_scene_mode *m, int axis)
{
    fl_modal_dof one = {.mass = m->mass / (m->shape * m->shape),
                        .omega = 2.0 * PI * m->frequency,
                        .ratio = m->damping_ratio,
                        .e = axis ? v3(0, 1, 0) : v3(1, 0, 0)};
    snprintf(one.name, sizeof one.name, "%s%s", m->name,
             m->direction != FL_MODE_XY ? ""
             : axis                     ? "_y"
                                        : "_x");
    out->mode[out->modes++] = one;
}

/* The modes of [part PART], or of [structure], PART "". */
static int set_modes(const fl_scene *s, const char *part, fl_rigid_motion *out, fl_err *err)
{
    int n = part[0] == '\0' && s->structure.modes[0];
    for (int32_t k = 0; k < s->n_mode; k++) n += strcmp(s->mode[k].part, part) == 0;
    if (n == 0) return 0;
    out->mode = fl_alloc(FL_MODES_MOST, sizeof *out->mode, err);
    if (!out->mode) return -1;
    if (s->structure.modes[0] && part[0] == '\0')
        out->modes = fl_modes_read(out->mode, s->structure.modes, s->structure.modes_node, err);
    if (out->modes < 0) {
        out->modes = 0;
        return -1;
    }
    for (int32_t k = 0; k < s->n_mode; k++) {
        if (strcmp(s->mode[k].part, part) != 0) continue;
        if (s->mode[k].direction != FL_MODE_Y) add_mode(out, &s->mode[k], 0);
        if (s->mode[k].direction != FL_MODE_X) add_mode(out, &s->mode[k], 1);
    }
    for (int32_t k = 0; k < out->modes; k++)
        out->free_dof |= (out->mode[k].e.x != 0.0 ? FL_DOF_X : 0u) |
                         (out->mode[k].e.y != 0.0 ? FL_DOF_Y : 0u) |
                         (out->mode[k].e.z != 0.0 ? FL_DOF_Z : 0u);
    out->mass = 1.0 / fl_modes_compliance(out->mode, out->modes);
    return 0;
}

/* Add the mover of scene motion m, of a section; mover_of_part is set already. */
static int add_mover(fl_world *w, const fl_scene_motion *m, const char *part, const char *section,
                     const fl_surface *surface, fl_err *err)
{
    fl_rigid_motion out = {.reference = m->reference,
                           .velocity = m->velocity,
                           .spin = m->spin,
                           .free_dof = m->free,
                           .mass = m->mass,
                           .inertia = m->inertia,
                           .added_mass = m->added_mass};
    set_springs(&out, m);
    char key[3 * FL_SCENE_NAME];
    if ((m->hydrostatic || m->waves) &&
        add_hydrostatics(w, w->moving.movers.n, &out, surface, section, m->waves, err))
        return -1;
    set_dampers(&out, m);
    if (set_modes(w->scene, part, &out, err) ||
        (m->track[0] &&
         fl_track_read(&out.track, m->track, m->interpolation == FL_INTERPOLATION_CUBIC, err)) ||
        fl_rigid_motions_add(&w->moving.movers, &out, err) < 0) {
        fl_track_free(&out.track);
        free(out.mode);
        return -1;
    }
    const fl_track *tr = &w->moving.movers.motion[w->moving.movers.n - 1].track;
    snprintf(key, sizeof key, "%s.track", section);
    for (int32_t i = 0; m->free && i < tr->n; i++)
        if (v3_nonzero(tr->value[i].r))
            return fl_scene_fail(
                w->scene, key, err,
                "%s: the track rotates at %g s; a structure with free directions cannot have a "
                "prescribed rotation",
                key, tr->t[i]);
    return 0;
}

void fl_mover_of_parts(const fl_scene *s, const fl_surface *surface, int32_t *mover)
{
    int32_t next = has_motion(s, &s->structure.motion, "") ? 1 : 0;
    for (int32_t p = 0; p < surface->n; p++) mover[p] = next - 1;
    for (int32_t i = 0; i < s->n_part; i++) {
        const char *name = s->part[i].name;
        const int32_t p = fl_surface_find(surface, name, strlen(name)),
                      own = has_motion(s, &s->part[i].motion, s->part[i].name) ? next++ : -1;
        if (p >= 0) mover[p] = own;
    }
}

/* True if waves act on a mover. */
static int has_hulls(const fl_scene *s)
{
    int any = s->structure.motion.waves;
    for (int32_t i = 0; i < s->n_part; i++) any |= s->part[i].motion.waves;
    return any;
}

/* Movers of [structure] and of each [part NAME], and the mover of each part. */
static int make_movers(fl_world *w, const fl_surface *surface, fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_mover_of_parts(s, surface, w->moving.mover_of_part);
    for (int32_t i = 0; i < s->n_part; i++) {
        const char *name = s->part[i].name;
        const int32_t p = fl_surface_find(surface, name, strlen(name));
        char section[FL_SCENE_NAME + 8];
        snprintf(section, sizeof section, "part %s", name);
        for (int32_t k = 0; p < 0 && k < s->n_mode; k++) /* the section may be there for a mode alone */
            if (strcmp(s->mode[k].part, name) == 0 && s->part[i].head.heading.line == 0)
                snprintf(section, sizeof section, "mode %s", s->mode[k].name);
        if (p < 0)
            return fl_scene_fail(s, section, err, "there is no part %s in %s", name, s->structure.file);
        w->part_reference[p] = s->part[i].motion.reference;
    }
    if (has_motion(s, &s->structure.motion, "") &&
        add_mover(w, &s->structure.motion, "", "structure", surface, err))
        return -1;
    for (int32_t i = 0; i < s->n_part; i++) {
        char section[FL_SCENE_NAME + 8];
        snprintf(section, sizeof section, "part %s", s->part[i].name);
        if (has_motion(s, &s->part[i].motion, s->part[i].name) &&
            add_mover(w, &s->part[i].motion, s->part[i].name, section, surface, err))
            return -1;
    }
    return 0;
}

/* Bound of the speed of a prescribed motion at distance arm, by the rows of its track [m/s]. */
static double max_speed_of(const fl_rigid_motion *m, double arm)
{
    double largest = v3_norm(m->velocity) + arm * v3_norm(m->spin);
    for (int32_t i = 0; i < m->track.n; i++) {
        fl_pose6 x, rate, second;
        fl_track_evaluate(&m->track, m->track.t[i], &x, &rate, &second);
        largest = fmax(largest, v3_norm(rate.x) + arm * v3_norm(rate.r));
    }
    return largest;
}

/* Move piece k with its mover; its velocity is the mean of the last dt. */
static void place_piece(fl_world *w, int32_t k, double dt)
{
    fl_moving_structure *r = &w->moving;
    const int32_t m = r->mover_of_piece[k], j = w->n + k;
    const fl_bodies *mb = &r->movers.b;
    fl_bodies *b = &w->b;
    const fl_vec3 arm = m3_mul(fl_body_axes(mb, m), r->arm[k]);
    b->x[j] = v3_add(mb->x[m], arm);
    b->q[j] = q_mul(mb->q[m], r->rotation[k]);
    b->v[j] = v3_add(mb->v[m], v3_cross(mb->w[m], v3_madd(arm, -0.5 * dt, v3_cross(mb->w[m], arm))));
    b->w[j] = mb->w[m];
}

static void set_piece_velocity(fl_world *w, int32_t k)
{
    const fl_bodies *mb = &w->moving.movers.b;
    const int32_t m = w->moving.mover_of_piece[k], j = w->n + k;
    w->b.v[j] = v3_add(mb->v[m], v3_cross(mb->w[m], v3_sub(w->b.x[j], mb->x[m])));
    w->b.w[j] = mb->w[m];
}

int fl_moving_structure_make(fl_world *w, const fl_surface *surface, const fl_member_model *members,
                             fl_err *err)
{
    fl_moving_structure *r = &w->moving;
    const int32_t pieces = w->structure.n; /* walls have an entry, too */
    for (int32_t p = 0; p < w->parts; p++) w->part_reference[p] = w->scene->structure.motion.reference;
    if (members) return fl_member_structure_make(w, members, err);
    if (!surface || (!has_motion(w->scene, &w->scene->structure.motion, "") && w->scene->n_part == 0))
        return 0;
    r->mover_of_part = fl_alloc(w->parts, sizeof *r->mover_of_part, err);
    r->mover_of_piece = fl_alloc(pieces, sizeof *r->mover_of_piece, err);
    r->arm = fl_alloc(pieces, sizeof *r->arm, err);
    r->rotation = fl_alloc(pieces, sizeof *r->rotation, err);
    r->contact_omega2 = fl_alloc(w->scene->n_part + 1, sizeof *r->contact_omega2, err);
    r->hydrostatics = fl_alloc(w->scene->n_part + 1, sizeof *r->hydrostatics, err);
    if (!err->code && has_hulls(w->scene) &&
        fl_floating_hulls_alloc(&r->movers.hulls, w->scene->n_part + 1, &w->sea, err))
        return -1;
    if (err->code || make_movers(w, surface, err) || fl_rigid_motions_start(&r->movers, 0.0, err)) return -1;
    for (int32_t k = 0; k < pieces; k++) {
        const int32_t p = w->structure.piece[k].part, m = p < 0 ? -1 : r->mover_of_part[p], j = w->n + k;
        r->mover_of_piece[k] = m;
        if (m < 0) continue;
        const fl_rigid_motion *motion = &r->movers.motion[m];
        r->arm[k] = v3_sub(w->b.x[j], motion->reference);
        r->rotation[k] = w->b.q[j];
        if (motion->free_dof) { /* mobility without rotations; fl_moving_structure_limit() adds these */
            w->b.m[j] = motion->free_dof & 7u ? r->movers.b.m[m] : 0.0;
            w->b.invm[j] = r->movers.b.invm[m];
            fl_body_set_inertia(&w->b, j, v3(INFINITY, INFINITY, INFINITY));
        }
        r->max_speed = fmax(r->max_speed, max_speed_of(motion, v3_norm(r->arm[k]) + w->b.bounding_radius[j]));
        place_piece(w, k, 0.0);
    }
    if (r->movers.hulls.n) fl_floating_hulls_attach(&r->movers.hulls, &r->movers.b);
    return 0;
}

void fl_moving_structure_free(fl_moving_structure *r)
{
    fl_member_motion_free(&r->members);
    fl_rigid_motions_free(&r->movers);
    free(r->mover_of_piece), free(r->mover_of_part), free(r->arm), free(r->rotation), free(r->contact_omega2),
        free(r->hydrostatics);
    *r = (fl_moving_structure){0};
}

static void move_reference_points(fl_world *w)
{
    const fl_moving_structure *r = &w->moving;
    for (int32_t p = 0; p < w->parts; p++)
        if (r->mover_of_part[p] >= 0) w->part_reference[p] = r->movers.b.x[r->mover_of_part[p]];
}

void fl_moving_structure_set_step(fl_world *w)
{
    if (fl_structure_has_members(w)) {
        fl_member_dynamics_set_step(&w->moving.members.dynamics, w->dt);
        return;
    }
    fl_rigid_motions_set_step(&w->moving.movers, w->dt);
    move_reference_points(w);
}

void fl_moving_structure_first_half(fl_world *w, double t)
{
    fl_moving_structure *r = &w->moving;
    if (fl_structure_has_members(w)) {
        fl_member_structure_first_half(w);
        return;
    }
    for (int32_t m = 0; m < r->movers.n; m++) fl_rigid_motion_first_half(&r->movers, m, t, w->dt);
    for (int32_t k = 0; k < w->structure.n; k++) {
        if (r->mover_of_piece[k] < 0) continue;
        const int32_t j = w->n + k;
        const fl_vec3 x = w->b.x[j];
        const fl_quat q = w->b.q[j];
        const fl_velocity_change before = {w->b.v[j], w->b.w[j]};
        place_piece(w, k, w->dt);
        fl_set_predicted_change(w, j, v3_sub(w->b.v[j], before.v), v3_sub(w->b.w[j], before.w));
        const fl_quat d = q_mul(w->b.q[j], q_conj(q)); /* chord of the rotation, as in integrate.c */
        w->b.odometer[j] += v3_norm(v3_sub(w->b.x[j], x)) +
                            2.0 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z) * w->b.bounding_radius[j];
    }
    move_reference_points(w);
}

void fl_moving_structure_second_half(fl_world *w, double t, double h)
{
    fl_moving_structure *r = &w->moving;
    fl_bodies *mb = &r->movers.b;
    if (fl_structure_has_members(w)) {
        fl_member_structure_second_half(w, h);
        return;
    }
    for (int32_t m = 0; m < r->movers.n; m++) mb->f[m] = mb->t[m] = v3(0, 0, 0);
    for (int32_t k = 0; k < w->structure.n; k++) {
        const int32_t m = r->mover_of_piece[k], j = w->n + k;
        if (m < 0) continue;
        mb->f[m] = v3_add(mb->f[m], w->b.f[j]);
        mb->t[m] = v3_add(mb->t[m], v3_add(w->b.t[j], v3_cross(v3_sub(w->b.x[j], mb->x[m]), w->b.f[j])));
    }
    for (int32_t m = 0; m < r->movers.n; m++) {
        fl_rigid_motion_add_springs(&r->movers, m);
        if (h > 0.0) {
            fl_rigid_motion_second_kick(&r->movers, m, t, h);
            fl_rigid_motion_damp(&r->movers, m, h);
        }
    }
    for (int32_t k = 0; k < w->structure.n; k++)
        if (r->mover_of_piece[k] >= 0) set_piece_velocity(w, k);
}

/* Largest distance of a point of piece k from the reference point of its mover. */
static double max_arm_of(const fl_world *w, int32_t k)
{
    return v3_norm(w->moving.arm[k]) + w->b.bounding_radius[w->n + k];
}

static void lower_critical(fl_world *w, double limit, int32_t mover)
{
    w->dt_critical_contacts = fmin(w->dt_critical_contacts, limit);
    if (limit < w->dt_critical) {
        w->dt_critical = limit;
        w->critical_body = w->b.total + mover;
    }
}

void fl_moving_structure_limit(fl_world *w)
{
    fl_moving_structure *r = &w->moving;
    if (fl_structure_has_members(w)) {
        lower_critical(w, fl_member_structure_critical_step(w), 0);
        return;
    }
    for (int32_t m = 0; m < r->movers.n; m++) r->contact_omega2[m] = 0.0;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t m = r->mover_of_piece[k], j = w->n + k;
        if (m < 0 || !r->movers.motion[m].free_dof) continue;
        double sum = 0.0; /* of stiffness times invm */
        for (int64_t c = w->first_pair_of_body[j]; c < w->first_pair_of_body[j + 1]; c++) {
            const fl_neighbour_pair *p = &w->pair[w->pairs_of_body[c]];
            if (p->touching) sum += p->contact->omega2_j;
        }
        r->contact_omega2[m] +=
            sum / w->b.invm[j] * fl_rigid_motion_compliance(&r->movers.motion[m], max_arm_of(w, k));
    }
    for (int32_t m = 0; m < r->movers.n; m++) {
        const double sum = 2.0 * r->contact_omega2[m] + fl_rigid_motion_max_omega2(&r->movers.motion[m]);
        if (sum > 0.0) lower_critical(w, 2.0 / sqrt(sum), m);
    }
}

double fl_mover_omega2(const fl_world *w, int32_t k, double stiffest)
{
    if (fl_structure_has_members(w)) return fl_member_structure_omega2(w, stiffest);
    const fl_rigid_motion *m = &w->moving.movers.motion[k];
    double arm = 0.0;
    if (!m->free_dof) return 0.0;
    for (int32_t c = 0; c < w->pieces; c++)
        if (w->moving.mover_of_piece[c] == k) arm = fmax(arm, max_arm_of(w, c));
    return 2.0 * stiffest * fl_rigid_motion_compliance(m, arm) + fl_rigid_motion_max_omega2(m);
}

fl_moving_energy fl_moving_structure_energy(const fl_world *w)
{
    const fl_rigid_motions *v = &w->moving.movers;
    fl_moving_energy all = {0};
    if (fl_structure_has_members(w)) {
        const fl_member_dynamics *d = &w->moving.members.dynamics;
        all.kinetic = fl_member_dynamics_kinetic(d);
        all.spring = fl_member_dynamics_energy(d);
        all.damper_work = d->damped;
        all.plastic_work = fl_member_chain_plastic(&d->chain) - d->plastic_at_start;
        return all;
    }
    for (int32_t m = 0; m < v->n; m++) {
        all.kinetic += fl_rigid_motion_kinetic_energy(v, m);
        all.spring += fl_rigid_motion_spring_energy(v, m);
        all.damper_work += fl_rigid_motion_damper_loss(v, m);
        all.drive_work += v->prescribed_work[m] + v->b.work_of_constraints[m];
        if (v->b.added_mass) all.drag -= v->b.flow_work[m];
        if (!fl_floating_hulls_has(&v->hulls, m)) continue;
        all.waves += v->hulls.hull[m].work;
        all.drag += v->hulls.hull[m].drag_loss;
    }
    return all;
}

enum fl_loads_motion_kind fl_motion_columns(const fl_world *w)
{
    enum fl_loads_motion_kind kind = fl_structure_moves(w) ? FL_LOADS_TRANSLATION : FL_LOADS_FIXED;
    for (int32_t m = 0; m < w->moving.movers.n; m++) {
        const fl_rigid_motion *motion = &w->moving.movers.motion[m];
        if (motion->free_dof >> 3 || v3_nonzero(motion->spin)) kind = FL_LOADS_ROTATION;
        for (int32_t i = 0; i < motion->track.n; i++)
            if (v3_nonzero(motion->track.value[i].r)) kind = FL_LOADS_ROTATION;
    }
    return kind;
}

fl_vec3 fl_part_point(const fl_world *w, int32_t part, fl_vec3 x)
{
    const fl_rigid_motions *v = &w->moving.movers;
    const int32_t m = w->moving.mover_of_part[part];
    return v3_add(v->b.x[m], m3_mul(fl_body_axes(&v->b, m), v3_sub(x, v->motion[m].reference)));
}

int32_t fl_structure_modes(const fl_world *w)
{
    int32_t n = 0;
    for (int32_t m = 0; m < w->moving.movers.n; m++) n += w->moving.movers.motion[m].modes;
    return n;
}

const fl_modal_dof *fl_structure_mode(const fl_world *w, int32_t k, int32_t *mover)
{
    int32_t m = 0;
    while (k >= w->moving.movers.motion[m].modes) k -= w->moving.movers.motion[m++].modes;
    if (mover) *mover = m;
    return &w->moving.movers.motion[m].mode[k];
}

int fl_structure_moves_freely(const fl_world *w)
{
    if (fl_structure_has_members(w)) return 1;
    for (int32_t m = 0; m < w->moving.movers.n; m++)
        if (w->moving.movers.motion[m].free_dof) return 1;
    return 0;
}

/* Rotation vector of q, of length at most pi. */
static fl_vec3 rotation_vector(fl_quat q)
{
    const double s = sqrt(q.x * q.x + q.y * q.y + q.z * q.z), sign = q.w < 0.0 ? -1.0 : 1.0;
    if (s == 0.0) return v3(0, 0, 0);
    return v3_scale(2.0 * sign * atan2(s, sign * q.w) / s, v3(q.x, q.y, q.z));
}

void fl_part_motion(const fl_world *w, int32_t part, double t, fl_loads_motion *out)
{
    const fl_rigid_motions *v = &w->moving.movers;
    *out = (fl_loads_motion){0};
    if (fl_structure_has_members(w)) {
        fl_member_structure_part_motion(w, part, out);
        return;
    }
    const int32_t m = w->moving.mover_of_part[part];
    if (m < 0) return;
    out->u = v3_sub(v->b.x[m], v->motion[m].reference);
    out->v = v->b.v[m];
    out->r = rotation_vector(v->b.q[m]);
    out->w = v->b.w[m];
    fl_rigid_motion_acceleration(v, m, t, &out->a, &out->e);
}

const char *fl_mover_name(const fl_world *w, int32_t k)
{
    const fl_scene *s = w->scene;
    if (fl_structure_has_members(w)) return "structure";
    int32_t next = has_motion(s, &s->structure.motion, "") ? 1 : 0;
    if (k < next) return "structure";
    for (int32_t i = 0; i < s->n_part; i++)
        if (has_motion(s, &s->part[i].motion, s->part[i].name) && next++ == k) return s->part[i].name;
    return "structure";
}
