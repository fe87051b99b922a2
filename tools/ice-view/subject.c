/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "subject.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "mesh/gstruct.h"
#include "scene/ice_field.h"
#include "scene/scene_read.h"
#include "view/sea_surface.h"

enum { CONTACT_I, CONTACT_J, CONTACT_X, CONTACT_FN = 5, CONTACT_FS = 6, CONTACT_N = 9, CONTACTS = 12 };
enum { BOND_I, BOND_J, BOND_STATE, BOND_DAMAGE, BOND_AREA, BOND_X, BONDS = 8 };
static const char *const CONTACT_COLUMN[CONTACTS] = {"i",   "j",   "px",  "py", "pz", "fn",
                                                     "fsx", "fsy", "fsz", "nx", "ny", "nz"};
static const char *const BOND_COLUMN[BONDS] = {"i", "j", "state", "damage", "area", "x", "y", "z"};
static const char *const PANEL_COLUMN[4] = {"area", "fx", "fy", "fz"};
static const char *const BOND_STATES[] = {"whole",   "damaged", "broken", "ended",
                                          "elastic", "slip",    "open",   NULL};
enum { WHOLE, DAMAGED, BROKEN, ENDED, ELASTIC, SLIP, OPENED };

/* A camera without a distance of its own sees all within this share of the picture. */
#define INNER 0.93
enum { FIT_TURNS = 12, FIT_BODIES = 5000, FIT_VERTICES = 16, FIT_FRAMES = 5, FIT_WAYS = 16, WALL_POSTS = 9 };

/* --- opening ------------------------------------------------------------------------------------ */

/* Bodies of an ice file as a still: shapes about their middle, at their place. */
static int read_ice(struct subject *s, const char *path, fl_frame *still, fl_err *err)
{
    fl_ice_field ice = {0};
    int rc = -1;
    if (fl_ice_field_read(&ice, path, err)) return -1;
    for (int32_t i = 0; i < ice.n; i++) {
        const fl_poly *p = &ice.core[i];
        fl_vec3 middle = v3(0, 0, 0);
        for (int32_t k = 0; k < p->nv; k++) middle = v3_madd(middle, 1.0 / p->nv, p->v[k]);
        if (fl_frame_data_add_shape(&s->own, ice.id[i], ice.radius[i], 0, err)) goto done;
        for (int32_t k = 0; k < p->nv; k++)
            if (fl_frame_data_add_vertex(&s->own, v3_sub(p->v[k], middle), err)) goto done;
        for (int32_t f = 0; f < p->nf; f++)
            if (fl_frame_data_add_face(&s->own, p->loop + p->first[f], p->first[f + 1] - p->first[f], err))
                goto done;
    }
    if (fl_frame_clear(still, &s->own, err)) goto done;
    for (int32_t i = 0; i < ice.n; i++) {
        const fl_poly *p = &ice.core[i];
        fl_vec3 middle = v3(0, 0, 0);
        for (int32_t k = 0; k < p->nv; k++) middle = v3_madd(middle, 1.0 / p->nv, p->v[k]);
        still->x[i] = middle;
        still->q[i] = q_one();
        still->v[i] = ice.velocity[i];
        still->w[i] = ice.spin[i];
        still->there[i] = 1;
    }
    still->has_velocity = 1;
    rc = 0;
done:
    fl_ice_field_free(&ice);
    return rc;
}

/* "#KIND" of a file. */
static void kind_of(const char *path, char kind[24])
{
    fl_text in = {0};
    fl_err lost = {0};
    kind[0] = '\0';
    if (fl_text_open(&in, path, &lost) == 0 && fl_text_magic(&in, NULL, 1000, &lost) == 0)
        snprintf(kind, 24, "%.23s", in.kind);
    fl_text_close(&in);
}

static int open_still(struct subject *s, const struct options *o, fl_err *err)
{
    fl_frame still = {0};
    char kind[24];
    kind_of(o->in, kind);
    const int is_structure = strcmp(kind, "g_struct") == 0, is_ice = strcmp(kind, "g-polys") == 0;
    int rc = -1;
    if (!is_structure && !is_ice) {
        s->file = fl_frame_file_open(o->in, o->ice, err); /* which says what is wrong */
        if (s->file) fl_fail(err, FL_INPUT, "%s: this is no file that ice-view reads", o->in);
        return -1;
    }
    if (o->structure && fl_gstruct_read(&s->own.structure, o->structure, err)) goto done;
    if (is_structure && fl_gstruct_read(&s->own.structure, o->in, err)) goto done;
    if (is_ice && read_ice(s, o->in, &still, err)) goto done;
    if (fl_frame_clear(&still, &s->own, err)) goto done;
    if (is_ice) {
        memset(still.there, 1, (size_t)still.rows);
        still.has_velocity = 1;
    }
    still.k = 0;
    rc = fl_playback_open(&s->play, NULL, &s->own, &still, err);
done:
    fl_frame_free(&still);
    return rc;
}

static int open_frames(struct subject *s, const struct options *o, fl_err *err)
{
    s->file = fl_frame_file_open(o->in, o->ice, err);
    if (!s->file) return -1;
    const char *warning = fl_frame_file_warning(s->file);
    if (warning && !o->quiet) fprintf(stderr, "ice-view: %s\n", warning);
    if (o->structure && fl_frame_file_add_structure(s->file, o->structure, err)) return -1;
    return fl_playback_open(&s->play, s->file, NULL, NULL, err);
}

/* Groups of an ice file by row. */
static int read_groups(struct subject *s, const char *path, fl_err *err)
{
    const fl_frame_data *d = s->play.data;
    fl_ice_field ice = {0};
    if (fl_ice_field_read(&ice, path, err)) return -1;
    s->group = fl_alloc(d->rows, sizeof *s->group, err);
    s->group_rows = s->group ? d->rows : 0;
    for (int32_t r = 0; r < s->group_rows; r++) s->group[r] = -1;
    for (int32_t i = 0; s->group && i < ice.n; i++) {
        const int32_t r = fl_frame_data_row(d, ice.id[i]);
        if (r >= 0) s->group[r] = ice.group[i];
    }
    s->groups = ice.groups; /* taken over */
    ice.groups = (fl_string_table){0};
    fl_ice_field_free(&ice);
    return s->group ? 0 : -1;
}

static int read_scene(struct subject *s, const struct options *o, fl_look *l, fl_err *err)
{
    fl_scene scene;
    if (fl_scene_read(&scene, o->scene, err)) return -1;
    l->water.level = scene.water.level;
    s->walls = scene.boundary;
    s->has_walls = 1;
    const int rc = fl_sea_of_scene(&s->waves, &scene, &s->has_waves, err);
    fl_scene_free(&scene);
    return rc;
}

static int read_tables(struct subject *s, const struct options *o, fl_err *err)
{
    const char *column[2] = {"body", o->look.colour.column};
    if (o->contacts &&
        fl_time_rows_read(&s->contacts, o->contacts, "contacts", CONTACT_COLUMN, CONTACTS, -1, NULL, err))
        return -1;
    if (o->bonds &&
        fl_time_rows_read(&s->bonds, o->bonds, "bonds", BOND_COLUMN, BONDS, BOND_STATE, BOND_STATES, err))
        return -1;
    if (o->panels && fl_time_rows_read(&s->panels, o->panels, "panels", PANEL_COLUMN, 4, -1, NULL, err))
        return -1;
    if (o->table && fl_time_rows_read(&s->table, o->table, NULL, column, 2, -1, NULL, err)) return -1;
    if (o->loads && fl_load_curve_read(&s->curve, o->loads, o->component, o->part, err)) return -1;
    snprintf(s->curve_title, sizeof s->curve_title, "%s%s%.40s", o->component, o->part ? " " : "",
             o->part ? o->part : "");
    snprintf(s->column_title, sizeof s->column_title, "%.80s%s%.20s%s", o->look.colour.column,
             s->table.unit[1][0] ? " [" : "", s->table.unit[1], s->table.unit[1][0] ? "]" : "");
    for (int64_t k = 0; k < s->contacts.rows; k++) {
        const double *x = s->contacts.x + k * CONTACTS;
        const double f = sqrt(x[CONTACT_FN] * x[CONTACT_FN] + x[CONTACT_FS] * x[CONTACT_FS] +
                              x[CONTACT_FS + 1] * x[CONTACT_FS + 1] + x[CONTACT_FS + 2] * x[CONTACT_FS + 2]);
        if (f > s->most_force) s->most_force = f;
    }
    return 0;
}

int subject_open(struct subject *s, struct options *o, fl_err *err)
{
    *s = (struct subject){0};
    if (fl_frame_file_is(o->in) ? open_frames(s, o, err) : open_still(s, o, err)) return -1;
    if (read_tables(s, o, err) || (o->ice && read_groups(s, o->ice, err))) return -1;
    if (o->scene && read_scene(s, o, &o->look, err)) return -1;
    return fl_view_frame_make(&s->shown, s->play.data, s->play.box, err);
}

/* --- colours ------------------------------------------------------------------------------------ */

static double force_of(const double *x)
{
    const double *f = x + CONTACT_FS;
    return sqrt(x[CONTACT_FN] * x[CONTACT_FN] + f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
}

static void raise_value(double *value, int32_t row, double x)
{
    if (row >= 0 && !(value[row] >= x)) value[row] = x;
}

static int32_t row_of(const struct subject *s, double id)
{
    return id >= 0.0 && id <= INT32_MAX ? fl_frame_data_row(s->play.data, (int32_t)id) : -1;
}

/* Values that tables give. */
static void values_of_tables(struct subject *s, int by, double t)
{
    const fl_time_rows *r = by == FL_BY_FORCE ? &s->contacts : by == FL_BY_DAMAGE ? &s->bonds : &s->table;
    int64_t a, b;
    for (int32_t k = 0; k < s->play.now.rows; k++) s->play.value[k] = by == FL_BY_COLUMN ? NAN : 0.0;
    fl_time_rows_at(r, t, &a, &b);
    for (; a < b; a++) {
        const double *x = r->x + a * r->columns;
        if (by == FL_BY_COLUMN) {
            const int32_t row = row_of(s, x[0]);
            if (row >= 0) s->play.value[row] = x[1];
            continue;
        }
        const double v = by == FL_BY_FORCE ? force_of(x) : x[BOND_DAMAGE];
        raise_value(s->play.value, row_of(s, x[0]), v);
        raise_value(s->play.value, row_of(s, x[1]), v);
    }
}

static int is_of_table(int by) { return by == FL_BY_FORCE || by == FL_BY_DAMAGE || by == FL_BY_COLUMN; }

int subject_range(struct subject *s, const fl_look *l, fl_err *err)
{
    const int by = l->colour.by;
    s->bar = by >= FL_BY_SPEED && by != FL_BY_GROUP;
    s->from = 0.0;
    s->to = 1.0;
    if (!s->bar) return 0;
    if (by == FL_BY_FORCE) s->to = s->most_force > 0.0 ? fl_round_up(s->most_force) : 1.0;
    else if (by == FL_BY_COLUMN) {
        double lo = INFINITY, hi = -INFINITY;
        for (int64_t k = 0; k < s->table.rows; k++) {
            lo = fmin(lo, s->table.x[2 * k + 1]);
            hi = fmax(hi, s->table.x[2 * k + 1]);
        }
        s->from = isfinite(lo) ? lo : 0.0;
        s->to = hi > s->from ? hi : s->from + 1.0;
    } else if (by != FL_BY_DAMAGE && (isnan(l->colour.from) || isnan(l->colour.to)) &&
               fl_playback_range(&s->play, by, &s->from, &s->to, err))
        return -1;
    if (!isnan(l->colour.from)) s->from = l->colour.from;
    if (!isnan(l->colour.to)) s->to = l->colour.to;
    return 0;
}

static void set_colour(fl_view_pose *p, fl_rgb c, float kind)
{
    for (int k = 0; k < 3; k++) p->colour[k] = (float)c.c[k] / 255.0f;
    p->kind = kind;
}

static void paint_bodies(struct subject *s, const fl_look *l)
{
    const double scale = s->to != s->from ? 1.0 / (s->to - s->from) : 0.0;
    for (int32_t r = 0; r < s->shown.rows; r++) {
        fl_view_pose *p = &s->shown.pose[r];
        if (l->colour.by == FL_BY_ICE) set_colour(p, (fl_rgb){{226, 236, 242}}, FL_PAINT_ICE);
        else if (l->colour.by == FL_BY_ONE) set_colour(p, l->ice.colour, FL_PAINT_VALUE);
        else if (l->colour.by == FL_BY_GROUP)
            set_colour(p,
                       r < s->group_rows && s->group[r] >= 0 ? fl_colour_of_number(s->group[r])
                                                             : (fl_rgb){{200, 205, 210}},
                       FL_PAINT_VALUE);
        else
            set_colour(p, fl_colour_map_at(l->colour.map, (s->play.value[r] - s->from) * scale),
                       FL_PAINT_VALUE);
    }
    for (int32_t p = 0; p < s->shown.parts; p++)
        set_colour(&s->shown.pose[s->shown.rows + p], l->structure.colour, FL_PAINT_PLAIN);
}

/* --- tubes -------------------------------------------------------------------------------------- */

/* From the centre of each body to the point of the contact; radius by the force. */
static int add_contacts(struct subject *s, const fl_look *l, double t, fl_err *err)
{
    const double most = !isnan(l->contacts.most) ? l->contacts.most : fmax(s->most_force, 1e-300);
    const double thick = !isnan(l->contacts.thickness) ? l->contacts.thickness : 0.012 * s->shown.radius;
    int64_t a, b;
    fl_time_rows_at(&s->contacts, t, &a, &b);
    for (; a < b; a++) {
        const double *x = s->contacts.x + a * CONTACTS, f = fmin(1.0, force_of(x) / most), root = sqrt(f);
        const fl_vec3 p = v3(x[CONTACT_X], x[CONTACT_X + 1], x[CONTACT_X + 2]);
        if (f < 1e-4) continue;
        for (int k = 0; k < 2; k++) {
            const int32_t row = row_of(s, x[k]);
            fl_vec3 end = v3(0, 0, 0);
            if (row >= 0 && s->play.now.there[row]) end = s->play.now.x[row];
            else if (x[k] < 0.0)
                end =
                    v3_madd(p, -0.04 * s->shown.radius, v3(x[CONTACT_N], x[CONTACT_N + 1], x[CONTACT_N + 2]));
            else continue;
            if (fl_view_frame_add_tube(&s->shown, p, end, thick * fmax(0.12, root),
                                       fl_colour_map_at(FL_MAP_MAGMA, 0.35 + 0.6 * root), err))
                return -1;
        }
    }
    return 0;
}

/* A bar along each face that is damaged, broken or has ended: across the line of the two bodies, as long
 * as the face. */
static int add_bonds(struct subject *s, double t, fl_err *err)
{
    static const fl_rgb colour[] = {[DAMAGED] = {{255, 190, 60}},
                                    [BROKEN] = {{230, 60, 30}},
                                    [ENDED] = {{120, 10, 30}},
                                    [SLIP] = {{255, 190, 60}},
                                    [OPENED] = {{230, 60, 30}}};
    const fl_frame_data *d = s->play.data;
    int64_t a, b;
    fl_time_rows_at(&s->bonds, t, &a, &b);
    for (; a < b; a++) {
        const double *x = s->bonds.x + a * BONDS;
        const int state = (int)x[BOND_STATE];
        const int32_t i = row_of(s, x[BOND_I]), j = row_of(s, x[BOND_J]);
        if (state == WHOLE || state == ELASTIC || i < 0 || j < 0 || !s->play.now.there[i] ||
            !s->play.now.there[j])
            continue;
        const fl_vec3 way = v3_sub(s->play.now.x[j], s->play.now.x[i]),
                      across = v3_unit(v3(-way.y, way.x, 0));
        const double thick = fl_shape_thickness(d, fl_frame_data_shape(d, i, s->play.now.k));
        const double half = 0.5 * x[BOND_AREA] / fmax(thick, 1e-9);
        fl_vec3 p = v3(x[BOND_X], x[BOND_X + 1], x[BOND_X + 2]);
        p.z += 0.5 * thick;
        if (fl_view_frame_add_tube(&s->shown, v3_madd(p, -half, across), v3_madd(p, half, across),
                                   fmin(0.08 * thick, 0.25 * half), colour[state], err))
            return -1;
    }
    return 0;
}

/* A side of the boundary as a frame that stands on the water: a rail along its top and its bottom, and posts.
 * */
static int add_wall(struct subject *s, const fl_look *l, int axis, double at, fl_err *err)
{
    const fl_scene_boundary *b = &s->walls;
    const double lo[2] = {b->min.x, b->min.y}, hi[2] = {b->max.x, b->max.y}, size = s->shown.radius;
    const double box_lo[2] = {s->play.box.lo.x, s->play.box.lo.y},
                 box_hi[2] = {s->play.box.hi.x, s->play.box.hi.y};
    const int other = 1 - axis;
    const double a = isfinite(lo[other]) ? lo[other] : box_lo[other],
                 e = isfinite(hi[other]) ? hi[other] : box_hi[other];
    const double z[2] = {l->water.level, l->water.level + 0.04 * size}, thick = 0.0025 * size;
    for (int k = 0; k < 2 + WALL_POSTS; k++) {
        const double post = a + (e - a) * (k - 2) / (WALL_POSTS - 1);
        fl_vec3 p, q;
        if (k < 2) {
            p = axis ? v3(a, at, z[k]) : v3(at, a, z[k]);
            q = axis ? v3(e, at, z[k]) : v3(at, e, z[k]);
        } else {
            p = axis ? v3(post, at, z[0]) : v3(at, post, z[0]);
            q = axis ? v3(post, at, z[1]) : v3(at, post, z[1]);
        }
        if (fl_view_frame_add_tube(&s->shown, p, q, thick, l->boundary.colour, err)) return -1;
    }
    return 0;
}

static int add_walls(struct subject *s, const fl_look *l, fl_err *err)
{
    const fl_scene_boundary *b = &s->walls;
    const double side[2][2] = {{b->min.x, b->max.x}, {b->min.y, b->max.y}};
    for (int axis = 0; axis < 2; axis++)
        for (int k = 0; k < 2; k++)
            if (b->type[axis] != FL_BOUNDARY_FREE && isfinite(side[axis][k]) &&
                add_wall(s, l, axis, side[axis][k], err))
                return -1;
    return 0;
}

/* --- a time ------------------------------------------------------------------------------------- */

static void place_bodies(struct subject *s)
{
    const fl_frame *f = &s->play.now;
    fl_view_frame *v = &s->shown;
    v->t = f->t;
    v->frame = f->k < 0 ? 0 : f->k;
    for (int32_t r = 0; r < v->rows + v->parts; r++) {
        fl_view_pose *p = &v->pose[r];
        const int is_part = r >= v->rows, there = is_part || f->there[r];
        const fl_vec3 at = is_part ? f->part_x[r - v->rows] : there ? f->x[r] : v->origin;
        const fl_quat q = is_part ? f->part_q[r - v->rows] : there ? f->q[r] : (fl_quat){0, 0, 0, 0};
        const fl_vec3 x = v3_sub(at, v->origin);
        p->x[0] = (float)x.x;
        p->x[1] = (float)x.y;
        p->x[2] = (float)x.z;
        p->q[0] = (float)q.x;
        p->q[1] = (float)q.y;
        p->q[2] = (float)q.z;
        p->q[3] = (float)q.w;
    }
}

int subject_at(struct subject *s, const fl_look *l, double t, fl_err *err)
{
    if (fl_playback_at(&s->play, t, err)) return -1;
    if (s->shown.rows != s->play.data->rows && fl_view_frame_make(&s->shown, s->play.data, s->play.box, err))
        return -1;
    if (fl_playback_values(&s->play, l->colour.by, err)) return -1;
    const double now = s->play.file ? s->play.now.t : t;
    if (is_of_table(l->colour.by)) values_of_tables(s, l->colour.by, now);
    place_bodies(s);
    paint_bodies(s, l);
    s->shown.tubes = 0;
    if (s->has_walls && l->boundary.shown && add_walls(s, l, err)) return -1;
    if (l->contacts.shown && (add_contacts(s, l, now, err) || add_bonds(s, now, err))) return -1;
    if (s->has_waves && !s->sea_height) {
        s->sea_height = fl_alloc(FL_SEA_SIDE * FL_SEA_SIDE, sizeof *s->sea_height, err);
        if (!s->sea_height) return -1;
        const float side = (float)(3.0 * s->shown.radius);
        s->sea = (fl_sea_surface){s->sea_height, (float)s->shown.origin.x - 0.5f * side,
                                  (float)s->shown.origin.y - 0.5f * side, side};
    }
    if (s->has_waves) fl_sea_heights(&s->waves, now, &s->sea, s->sea_height);
    return 0;
}

/* The distance from which all points of s->fit are in the picture; with `move`, the point looked at is
 * shifted to the middle of what they take up. */
static double fit_distance(const struct subject *s, fl_camera *c, double aspect, int move)
{
    const double e = c->elevation, a = c->azimuth, half_up = tan(0.5 * c->field), up = half_up * INNER,
                 across = up * aspect;
    const fl_vec3 back = v3(cos(e) * cos(a), cos(e) * sin(a), sin(e)), right = v3(-sin(a), cos(a), 0),
                  top = v3_cross(back, right);
    double d = 0.0;
    for (int turn = 0; turn < FIT_TURNS; turn++) {
        fl_aabb seen = aabb_empty();
        d = 0.0;
        for (int32_t k = 0; k < s->fits; k++) {
            const fl_vec3 p = v3_sub(s->fit[k], c->at);
            const double nearer = c->parallel ? 0.0 : v3_dot(p, back);
            d = fmax(d, nearer + fmax(fabs(v3_dot(p, right)) / across, fabs(v3_dot(p, top)) / up));
        }
        for (int32_t k = 0; k < s->fits && move; k++) {
            const fl_vec3 p = v3_sub(s->fit[k], c->at);
            const double away = d - (c->parallel ? 0.0 : v3_dot(p, back));
            if (away > 0.0) seen = aabb_add(seen, v3(v3_dot(p, right) / away, v3_dot(p, top) / away, 0));
        }
        if (!(seen.lo.x <= seen.hi.x)) break;
        c->at = v3_madd(c->at, 0.5 * d * (seen.lo.x + seen.hi.x), right);
        c->at = v3_madd(c->at, 0.5 * d * (seen.lo.y + seen.hi.y), top);
    }
    return d > 0.0 ? d : 1.0;
}

static int add_fit(struct subject *s, fl_vec3 x, fl_err *err)
{
    if (fl_grow(&s->fit, &s->fit_cap, (int64_t)s->fits + 1, sizeof *s->fit, err)) return -1;
    s->fit[s->fits++] = x;
    return 0;
}

/* The vertices of a body, of many some. */
static int add_body_fit(struct subject *s, int32_t r, fl_err *err)
{
    const fl_frame *f = &s->play.now;
    const fl_frame_data *d = s->play.data;
    const fl_frame_shape *shape = fl_frame_data_shape(d, r, f->k < 0 ? 0 : f->k);
    const fl_mat3 R = q_matrix(f->q[r]);
    for (int32_t k = 0; k < shape->nv; k += shape->nv / FIT_VERTICES + 1)
        if (add_fit(s, v3_add(f->x[r], m3_mul(R, d->vertex[shape->v + k])), err)) return -1;
    return 0;
}

/* The bodies that lie furthest out in FIT_WAYS directions around, upward and downward. */
static int add_outer_fits(struct subject *s, fl_err *err)
{
    const fl_frame *f = &s->play.now;
    for (int k = 0; k < 2 * FIT_WAYS; k++) {
        const double a = 2.0 * PI * k / FIT_WAYS;
        const fl_vec3 way = v3(cos(a), sin(a), k < FIT_WAYS ? 0.5 : -0.5);
        int32_t last = -1;
        double most = -INFINITY;
        for (int32_t r = 0; r < f->rows; r++) {
            const double along = f->there[r] ? v3_dot(way, f->x[r]) : -INFINITY;
            if (along > most) most = along, last = r;
        }
        if (last >= 0 && add_body_fit(s, last, err)) return -1;
    }
    return 0;
}

/* Points that the picture has to hold: vertices of bodies, corners of parts.  Of many bodies some, and those
 * at the outside. */
static int add_fits(struct subject *s, fl_err *err)
{
    const fl_frame *f = &s->play.now;
    const fl_frame_data *d = s->play.data;
    for (int32_t r = 0; r < f->rows; r += f->rows / FIT_BODIES + 1) {
        if (f->there[r] && add_body_fit(s, r, err)) return -1;
    }
    if (f->rows > FIT_BODIES && add_outer_fits(s, err)) return -1;
    for (int32_t p = 0; p < f->parts; p++) {
        const fl_aabb b = fl_part_aabb(&d->structure.part[p]);
        const fl_mat3 R = q_matrix(f->part_q[p]);
        for (int k = 0; k < 8 && b.lo.x <= b.hi.x; k++) {
            const fl_vec3 c = v3(k & 1 ? b.hi.x : b.lo.x, k & 2 ? b.hi.y : b.lo.y, k & 4 ? b.hi.z : b.lo.z);
            if (add_fit(s, v3_add(f->part_x[p], m3_mul(R, c)), err)) return -1;
        }
    }
    return 0;
}

int subject_fit_now(struct subject *s, fl_err *err)
{
    s->fits = 0;
    return add_fits(s, err);
}

int subject_fit_all(struct subject *s, double from, double to, fl_err *err)
{
    s->fits = 0;
    for (int k = 0; k < FIT_FRAMES; k++)
        if (fl_playback_at(&s->play, from + (to - from) * k / (FIT_FRAMES - 1), err) || add_fits(s, err))
            return -1;
    return 0;
}

fl_camera subject_camera(const struct subject *s, const fl_look *l, double aspect, double spin_seconds)
{
    const fl_vec3 o = s->shown.origin;
    fl_camera c = {.field = fl_radians(l->view.field), .parallel = l->view.parallel};
    c.azimuth = fl_radians(l->view.azimuth + l->view.spin * spin_seconds);
    c.elevation = fl_radians(l->view.elevation);
    c.at = v3(isnan(l->view.at_x) ? o.x : l->view.at_x, isnan(l->view.at_y) ? o.y : l->view.at_y,
              isnan(l->view.at_z) ? o.z : l->view.at_z);
    c.distance = l->view.distance;
    if (isnan(c.distance))
        c.distance =
            fit_distance(s, &c, aspect, isnan(l->view.at_x) && isnan(l->view.at_y) && isnan(l->view.at_z));
    return c;
}

int subject_strip(const struct subject *s, const fl_look *l, int w, int h)
{
    const fl_picture p = {NULL, w, h};
    return l->picture.curve && s->curve.n > 0 ? fl_legend_curve_height(&p) / 2 * 2 : 0;
}

double subject_time(const struct subject *s) { return s->play.file ? s->play.now.t : 0.0; }

void subject_legend(const struct subject *s, const fl_look *l, double t, fl_picture *p)
{
    const int bottom = subject_strip(s, l, p->w, p->h), curve = bottom > 0;
    if (curve) {
        fl_curve c = {s->curve.t, s->curve.y, s->curve.n, 0, 0, s->curve_title};
        c.t0 = s->play.file ? fmin(s->curve.t[0], fl_playback_start(&s->play)) : s->curve.t[0];
        c.t1 = s->play.file ? fmax(fl_playback_end(&s->play), c.t0) : s->curve.t[s->curve.n - 1];
        fl_legend_curve(p, &c, bottom, t);
    }
    if (l->picture.time && s->play.file) fl_legend_time(p, t, bottom);
    const int by = l->colour.by;
    if (l->picture.legend && by == FL_BY_GROUP && s->groups.n)
        fl_legend_names(p, (const char *const *)s->groups.name, s->groups.n, bottom);
    if (!l->picture.legend || !s->bar) return;
    fl_legend_bar(p,
                  by == FL_BY_COLUMN   ? s->column_title
                  : by == FL_BY_FORCE  ? "largest contact force [N]"
                  : by == FL_BY_DAMAGE ? "largest damage of a bond"
                                       : fl_playback_legend(&s->play, by),
                  l->colour.map, s->from, s->to, bottom);
}

void subject_tell(const struct subject *s, int32_t row, char text[200])
{
    const fl_frame *f = &s->play.now;
    const fl_frame_data *d = s->play.data;
    const fl_frame_shape *shape = fl_frame_data_shape(d, row, s->shown.frame);
    int64_t a, b;
    int n = snprintf(text, 200, "body %d, diameter %.3g m, thickness %.3g m", shape->id,
                     fl_shape_diameter(d, shape), fl_shape_thickness(d, shape));
    if (!isnan(f->v[row].x))
        n += snprintf(text + n, (size_t)(200 - n), ", speed %.3g m/s", v3_norm(f->v[row]));
    if (!s->contacts.rows || n >= 200) return;
    int contacts = 0;
    double force = 0.0;
    fl_time_rows_at(&s->contacts, f->t, &a, &b);
    for (; a < b; a++) {
        const double *x = s->contacts.x + a * CONTACTS;
        if (x[0] != shape->id && x[1] != shape->id) continue;
        contacts++;
        force = fmax(force, force_of(x));
    }
    snprintf(text + n, (size_t)(200 - n), ", %d contacts, largest %.3g N", contacts, force);
}

void subject_close(struct subject *s)
{
    fl_playback_close(&s->play);
    fl_frame_file_close(s->file);
    fl_frame_data_free(&s->own);
    fl_view_frame_free(&s->shown);
    free(s->group);
    fl_string_table_free(&s->groups);
    fl_time_rows_free(&s->contacts);
    fl_time_rows_free(&s->bonds);
    fl_time_rows_free(&s->table);
    fl_time_rows_free(&s->panels);
    fl_load_curve_free(&s->curve);
    fl_waves_free(&s->waves);
    free(s->sea_height);
    free(s->fit);
    *s = (struct subject){0};
}
