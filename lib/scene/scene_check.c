/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "scene/scene_check.h"
#include "base/pi.h"
#include "law/contact_law.h"
#include "scene/scene_check_failure.h"
#include "scene/scene_check_motion.h"
#include "scene/scene_check_zones.h"
#include "scene/unused_keys.h"
#include "scene/scene_section.h"

/* Of the force of the waves, where none is given. */
#define DEFAULT_WAVE_ERROR 0.003

static int add_missing_material(fl_scene *s, const char *name, fl_err *err)
{
    if (fl_scene_find_material(s, name) >= 0) return 0;
    return fl_section_add(s, FL_SEC_MATERIAL, name, "", err) < 0 ? -1 : 0;
}

/* Set a value to that of another key until it is given itself.  A second call sets it again: the mark
 * decides. */
static void copy_unless_given(const fl_scene_output *o, const char *key, double *value, double other)
{
    const int slot = fl_key_find(FL_SEC_OUTPUT, key) - fl_key_first(FL_SEC_OUTPUT);
    if (o->head.key[slot].line == 0 || o->head.key[slot].is_auto) *value = other;
}

static void set_default_intervals(fl_scene *s)
{
    fl_scene_output *o = &s->output;
    copy_unless_given(o, "ice_every", &o->ice_every, o->frames_every);
    copy_unless_given(o, "until", &o->until, s->run.duration);
    copy_unless_given(o, "state_every", &o->state_every, o->loads_every);
    copy_unless_given(o, "energy_every", &o->energy_every, o->loads_every);
    copy_unless_given(o, "contacts_every", &o->contacts_every, o->loads_every);
    copy_unless_given(o, "hash_every", &o->hash_every, o->loads_every);
    copy_unless_given(o, "bonds_every", &o->bonds_every, o->loads_every);
    copy_unless_given(o, "members_every", &o->members_every, o->loads_every);
    copy_unless_given(o, "zones_every", &o->zones_every, o->loads_every);
}

/* Check that a material exists; place: "structure" and "boundary" are accepted too.  key is the whole
 * address, for the line of the message. */
static int check_material(const fl_scene *s, const char *key, const char *name, int place, fl_err *err)
{
    if (fl_scene_find_material(s, name) >= 0) return 0;
    if (place && (strcmp(name, "structure") == 0 || strcmp(name, "boundary") == 0)) return 0;
    return fl_scene_fail(s, key, err, "there is no [material %s]", name);
}

static int check_inputs(const fl_scene *s, fl_err *err)
{
    const int std_scene = s->n_file > 0 && strcmp(s->file[0], "<stdin>") == 0;
    const int std_ice = strcmp(s->ice.file, "-") == 0;
    const int std_structure = s->structure.head.present && strcmp(s->structure.file, "-") == 0;
    if (!s->ice.head.present || s->ice.file[0] == '\0')
        return fl_scene_fail(s, "ice.file", err,
                             "the scene has no ice: [ice] file = FILE, or --ice FILE, is expected");
    if (s->structure.head.present && !s->structure.file[0] && !s->structure.members[0])
        return fl_scene_fail(s, "structure.file", err,
                             "[structure] has no file: file = FILE, or --structure FILE, is expected");
    if (std_scene + std_ice + std_structure > 1)
        return fl_scene_fail(s, std_ice ? "ice.file" : "structure.file", err,
                             "standard input can be only one of scene, ice and structure");
    if (check_material(s, "ice.material", s->ice.material, 0, err)) return -1;
    if (s->structure.head.present && check_material(s, "structure.material", s->structure.material, 0, err))
        return -1;
    return 0;
}

static int check_outputs(const fl_scene *s, fl_err *err)
{
    const char *const key[] = {"output.frames",    "output.state",  "output.energy",   "output.contacts",
                               "output.hash",      "output.panels", "output.events",   "output.bonds",
                               "output.members",   "output.zones",  "output.failures", "output.final_ice",
                               "output.checkpoint"};
    const char *const path[] = {
        s->output.frames,   s->output.state,     s->output.energy,    s->output.contacts, s->output.hash,
        s->output.panels,   s->output.events,    s->output.bonds,     s->output.members,  s->output.zones,
        s->output.failures, s->output.final_ice, s->output.checkpoint};
    for (int k = 0; k < (int)(sizeof key / sizeof *key); k++) {
        if (strcmp(path[k], "-") == 0)
            return fl_scene_fail(s, key[k], err,
                                 "%s is \"-\", and standard output carries the loads: a file is expected",
                                 key[k]);
        for (int j = 0; j < k && path[k][0]; j++)
            if (strcmp(path[j], path[k]) == 0)
                return fl_scene_fail(s, key[k], err, "%s is \"%s\", which is %s already", key[k], path[k],
                                     key[j]);
        if (path[k][0] &&
            (strcmp(path[k], s->ice.file) == 0 || strcmp(path[k], s->structure.file) == 0 ||
             strcmp(path[k], s->structure.members) == 0 || strcmp(path[k], s->structure.modes) == 0))
            return fl_scene_fail(s, key[k], err, "%s is \"%s\", which is an input", key[k], path[k]);
    }
    return 0;
}

/* The law of section i: its own, or that of [contact] without names. */
static int32_t law_of(const fl_scene *s, int32_t i, int32_t all)
{
    const int law = fl_key_find(FL_SEC_CONTACT, "law") - fl_key_first(FL_SEC_CONTACT);
    return s->contact[i].head.key[law].line || all < 0 ? s->contact[i].law : s->contact[all].law;
}

/* True if a contact that section i covers has a law that uses the key. */
static int law_uses_key(const fl_scene *s, int32_t i, int32_t all, const char *key)
{
    int uses = fl_contact_law_uses(&fl_contact_laws[law_of(s, i, all)], key);
    for (int32_t k = 0; k < s->n_contact && i == all; k++)
        uses |= fl_contact_law_uses(&fl_contact_laws[law_of(s, k, all)], key);
    return uses;
}

/* Refuses a key of section i, called `at`, that is given and that none of its laws uses. */
static int check_law_key(const fl_scene *s, int32_t i, int32_t all, const char *at, const char *key,
                         int given, fl_err *err)
{
    char full[4 * FL_SCENE_NAME], laws[160] = "";
    size_t n = 0;
    if (!given || law_uses_key(s, i, all, key)) return 0;
    for (int32_t k = 0; k < fl_contact_law_count; k++)
        if (fl_contact_law_uses(&fl_contact_laws[k], key) && n < sizeof laws)
            n += (size_t)snprintf(laws + n, sizeof laws - n, "%s%s", n ? " and " : "",
                                  fl_contact_laws[k].name);
    snprintf(full, sizeof full, "%s.%s", at, key);
    return fl_scene_fail(s, full, err, "%s applies to law = %s only", key, laws);
}

static int check_contacts(const fl_scene *s, fl_err *err)
{
    const int32_t all = fl_section_named(s, FL_SEC_CONTACT, "", "");
    for (int32_t i = 0; i < s->n_contact; i++) {
        const fl_scene_contact *c = &s->contact[i];
        char at[3 * FL_SCENE_NAME], key[4 * FL_SCENE_NAME];
        snprintf(at, sizeof at, "contact%s%s%s%s", c->a[0] ? " " : "", c->a, c->b[0] ? " " : "", c->b);
        if (check_law_key(s, i, all, at, "manual_eq2", c->manual_eq2, err) ||
            check_law_key(s, i, all, at, "manual_eq18", c->manual_eq18, err))
            return -1;
        snprintf(key, sizeof key, "%s.surrogate", at);
        if (s->run.error > 0.0 && c->surrogate > 0.0)
            return fl_scene_fail(s, key, err,
                                 "run.error compares steps of different sizes, which a surrogate would "
                                 "disturb: either run.error or surrogate in [%s] is expected",
                                 at);
        if (check_law_key(s, i, all, at, "surrogate", c->surrogate > 0.0, err) ||
            check_law_key(s, i, all, at, "rolling", c->rolling > 0.0, err) ||
            check_law_key(s, i, all, at, "exponent", c->exponent != 1.0, err))
            return -1;
        if (i == all) continue;
        if (check_material(s, at, c->a, 1, err) || check_material(s, at, c->b, 1, err)) return -1;
        if (fl_scene_find_material(s, c->a) < 0 && fl_scene_find_material(s, c->b) < 0)
            return fl_scene_fail(s, at, err, "[%s] names no material: structure and boundary never touch",
                                 at);
    }
    return 0;
}

/* The wall that drive_of = wall moves: x y of the drive along its normal, and a rigid wall there. */
static int check_driven_wall(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    const int axis = b->drive_edge ? (b->drive_edge - 1) / 2 : fabs(b->drive.x) < fabs(b->drive.y);
    const double along = axis ? b->drive.y : b->drive.x, across = axis ? b->drive.x : b->drive.y;
    const int upper = b->drive_edge ? (b->drive_edge - 1) % 2 : along < 0.0;
    const double bound = axis ? (upper ? b->max.y : b->min.y) : (upper ? b->max.x : b->min.x);
    if (b->drive_width > 0.0 || b->drive_group[0])
        return fl_scene_fail(s, "boundary.drive_of", err,
                             "a wall is driven, and a row of floes as well: drive_of = row, or neither "
                             "drive_width nor drive_group, is expected");
    if (b->drive_track[0] ? b->drive_edge == 0 : !(fabs(along) > 0.0))
        return fl_scene_fail(s, "boundary.drive_of", err,
                             b->drive_track[0]
                                 ? "which wall follows the track: drive_edge is expected"
                                 : "no wall moves: boundary.drive along its normal is expected");
    if (across != 0.0 || b->drive.z != 0.0)
        return fl_scene_fail(s, "boundary.drive", err,
                             "a wall moves along its normal, %c: no other velocity is expected", 'x' + axis);
    if (b->type[axis] != FL_BOUNDARY_RIGID || !isfinite(bound))
        return fl_scene_fail(s, "boundary.drive_of", err,
                             "there is no rigid wall at the %s bound of %c: boundary.type = rigid and "
                             "boundary.%s of it are expected",
                             upper ? "upper" : "lower", 'x' + axis, upper ? "max" : "min");
    if (s->run.sleep > 0.0)
        return fl_scene_fail(s, "boundary.drive_of", err,
                             "floes that sleep would not meet a wall that moves: run.sleep = 0 is expected");
    return 0;
}

/* What pushes with a line load, and along which way. */
static int check_line_load(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    const char *const key = b->line_load > 0.0 ? "boundary.line_load" : "boundary.iso_pack_width";
    const int row = b->drive_width > 0.0 || b->drive_group[0], wall = b->drive_of == FL_DRIVE_OF_WALL,
              inflow = b->inflow != FL_INFLOW_NONE;
    if (b->line_load == 0.0 && b->iso_pack_width == 0.0) return 0;
    if (b->line_load > 0.0 && b->iso_pack_width > 0.0)
        return fl_scene_fail(s, "boundary.iso_pack_width", err,
                             "line_load and iso_pack_width both say how hard the ice is pushed: one is "
                             "expected");
    if (row + wall + inflow != 1)
        return fl_scene_fail(s, key, err,
                             row + wall + inflow ? "%s: a drive and an inflow both push: one of the two is "
                                                   "expected"
                                                 : "%s: nothing pushes: boundary.drive or boundary.inflow is "
                                                   "expected",
                             key);
    if (row && !b->drive_track[0] && ((b->drive.x != 0.0) == (b->drive.y != 0.0) || b->drive.z != 0.0))
        return fl_scene_fail(s, "boundary.drive", err,
                             "%s: a row that is pushed moves along x or along y: a drive along one of them "
                             "is expected",
                             key);
    if (row && b->drive_track[0])
        return fl_scene_fail(s, "boundary.drive_track", err,
                             "%s: a row that is pushed has a speed, not a track: boundary.drive is expected",
                             key);
    if (row && !(b->drive_fixed & (b->drive.x != 0.0 ? FL_FIX_X : FL_FIX_Y)))
        return fl_scene_fail(s, "boundary.drive_fixed", err, "%s: the row does not follow the drive", key);
    if (s->run.sleep > 0.0)
        return fl_scene_fail(s, key, err,
                             "%s changes the speed of what pushes, and floes that sleep would miss it: "
                             "run.sleep = 0 is expected",
                             key);
    return 0;
}

static int check_drive(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    const double v[] = {b->drive.x, b->drive.y, b->drive.z};
    const int row = b->drive_width > 0.0, group = b->drive_group[0] != '\0';
    if (b->drive_of == FL_DRIVE_OF_WALL && check_driven_wall(s, err)) return -1;
    if (check_line_load(s, err)) return -1;
    if (b->drive_of == FL_DRIVE_OF_ROW && !row && !group && (v3_nonzero(b->drive) || b->drive_track[0]))
        return fl_scene_fail(s, b->drive_track[0] ? "boundary.drive_track" : "boundary.drive", err,
                             "nothing is driven: drive_width, drive_group or drive_of = wall is expected");
    if (row && group)
        return fl_scene_fail(s, "boundary.drive_group", err,
                             "drive_width and drive_group both say which floes are driven: one is expected");
    if (row && b->drive_edge == 0 && !b->drive_track[0] && !(fabs(v[0]) > 0.0 || fabs(v[1]) > 0.0))
        return fl_scene_fail(s, "boundary.drive_width", err,
                             "boundary.drive has no direction along x or y: drive_edge is expected");
    for (int c = 0; c < 3 && (row || group); c++)
        if (v[c] != 0.0 && !(b->drive_fixed >> c & 1u))
            return fl_scene_fail(s, "boundary.drive", err,
                                 "boundary.drive along %c is %g m/s, and %c is not among drive_fixed",
                                 'x' + c, v[c], 'x' + c);
    return 0;
}

static int check_inflow(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    const int axis = b->inflow_from / 2;
    const double lo = axis ? b->min.y : b->min.x, hi = axis ? b->max.y : b->max.x;
    const double current = axis ? s->water.current.y : s->water.current.x;
    if (b->inflow == FL_INFLOW_FILE && b->inflow_file[0] == '\0')
        return fl_scene_fail(s, "boundary.inflow", err,
                             "boundary.inflow is file: inflow_file = FILE is expected");
    if (b->type[axis] != FL_BOUNDARY_FREE || !isfinite(lo) || !isfinite(hi))
        return fl_scene_fail(
            s, "boundary.inflow", err,
            "inflow along %c needs boundary.type = free in %c, and boundary.min and boundary.max of it",
            'x' + axis, 'x' + axis);
    if (b->inflow_speed <= 0.0 && !((b->inflow_from % 2 ? -current : current) > 0.0))
        return fl_scene_fail(s, "boundary.inflow", err,
                             "water.current does not point into the domain there: boundary.inflow_speed, or "
                             "another inflow_from, is expected");
    return 0;
}

static int check_boundary(const fl_scene *s, fl_err *err)
{
    const double lo[] = {s->boundary.min.x, s->boundary.min.y, s->boundary.min.z};
    const double hi[] = {s->boundary.max.x, s->boundary.max.y, s->boundary.max.z};
    static const char *const NAME[] = {"rigid", "elastic", "periodic"};
    int walls = 0, open = 1;
    if (!s->boundary.head.present) return 0;
    for (int c = 0; c < 3; c++) {
        walls += isfinite(lo[c]) + isfinite(hi[c]);
        open = open && s->boundary.type[c] == FL_BOUNDARY_FREE;
        if (!(lo[c] < hi[c]))
            return fl_scene_fail(s, "boundary.max", err,
                                 "boundary.max of %c is %g m, more than its min, %g m, is expected", 'x' + c,
                                 hi[c], lo[c]);
    }
    for (int c = 0; c < 3 && walls == 0 && !open; c++)
        if (s->boundary.type[c] != FL_BOUNDARY_FREE)
            return fl_scene_fail(s, "boundary.type", err,
                                 "%s %s boundary has no bounds: boundary.min or boundary.max is expected",
                                 s->boundary.type[c] == FL_BOUNDARY_ELASTIC ? "an" : "a",
                                 NAME[s->boundary.type[c]]);
    for (int c = 0; c < 3; c++)
        if (s->boundary.type[c] == FL_BOUNDARY_PERIODIC && isfinite(lo[c]) != isfinite(hi[c]))
            return fl_scene_fail(s, "boundary.type", err,
                                 "%c is periodic and has one bound: boundary.min and boundary.max of %c, or "
                                 "none of the two, are expected",
                                 'x' + c, 'x' + c);
    if (s->boundary.type[2] == FL_BOUNDARY_PERIODIC && isfinite(lo[2]) && s->water.head.present)
        return fl_scene_fail(s, "boundary.type", err,
                             "z is periodic, but [water] has one surface: only one of the two is expected");
    if (check_drive(s, err)) return -1;
    return s->boundary.inflow == FL_INFLOW_NONE ? 0 : check_inflow(s, err);
}

static int check_current(const fl_scene *s, fl_err *err)
{
    const fl_scene_water *w = &s->water;
    const int sheared = w->profile == 1 || w->profile == 2, table = w->profile == 3;
    if (!w->head.present) return 0;
    if (sheared && w->profile_depth == 0.0 && !isfinite(w->depth))
        return fl_scene_fail(
            s, "water.profile", err,
            "a current profile needs a depth: water.profile_depth or water.depth is expected");
    if (table && w->profile_file[0] == '\0')
        return fl_scene_fail(s, "water.profile", err,
                             "water.profile = table has no rows: water.profile_file is expected");
    if (!table && w->profile_file[0])
        return fl_scene_fail(s, "water.profile_file", err,
                             "water.profile_file applies to water.profile = table only");
    if (table && v3_norm(w->current) > 0.0)
        return fl_scene_fail(s, "water.current", err,
                             "the current is given twice: by water.current and by water.profile_file");
    return 0;
}

static int check_weight(const fl_scene *s, fl_err *err)
{
    const fl_vec3 g = s->run.gravity;
    if (s->water.head.present && (g.x != 0.0 || g.y != 0.0 || g.z > 0.0))
        return fl_scene_fail(s, "run.gravity", err,
                             "the water surface is level: a run.gravity along -z is expected");
    return 0;
}

/* Checks common to all kinds of waves; the program checks whether a wave would break. */
static int check_waves(const fl_scene *s, fl_err *err)
{
    const fl_scene_water *w = &s->water;
    const fl_vec3 g = s->run.gravity;
    if (!w->head.present || w->wave == FL_WAVE_NONE) return 0;
    if (s->ice.slab > 0.0)
        return fl_scene_fail(s, "ice.slab", err,
                             "spheres that stand for a slab float in still water: either ice.slab or "
                             "water.wave is expected");
    if (w->height == 0.0)
        return fl_scene_fail(s, "water.wave", err, "the waves have no height: water.height is expected");
    if (w->period == 0.0)
        return fl_scene_fail(s, "water.wave", err, "the waves have no period: water.period is expected");
    if (!(g.z < 0.0))
        return fl_scene_fail(s, "run.gravity", err, "waves need gravity: a run.gravity along -z is expected");
    if (!(0.5 * w->height < w->depth))
        return fl_scene_fail(s, "water.height", err,
                             "waves of %g m on water of %g m: less than twice the depth is expected",
                             w->height, w->depth);
    const double turn = fl_radians(w->direction), along[2] = {cos(turn), sin(turn)};
    for (int c = 0; c < 2; c++)
        if (s->boundary.head.present && s->boundary.type[c] == FL_BOUNDARY_PERIODIC && fabs(along[c]) > 1e-9)
            return fl_scene_fail(s, "water.wave", err,
                                 "waves that run along %c do not repeat with a periodic boundary: another "
                                 "boundary or water.direction is expected",
                                 'x' + c);
    return 0;
}

static int water_key_given(const fl_scene_water *w, const char *key)
{
    return w->head.key[fl_key_find(FL_SEC_WATER, key) - fl_key_first(FL_SEC_WATER)].line != 0;
}

/* The default: a number for several trains, none with what evaluates the waves otherwise. */
static void set_default_wave_error(fl_scene *s)
{
    fl_scene_water *w = &s->water;
    const int trains = w->wave == FL_WAVE_JONSWAP && w->components != 1,
              needed = w->spread > 0.0 || w->ice_decay != FL_ICE_DECAY_NONE;
    if (water_key_given(w, "wave_error")) return;
    w->wave_error = needed || (trains && w->every == 1 && s->run.sleep == 0.0) ? DEFAULT_WAVE_ERROR : 0.0;
}

/* Waves by error, directions, decay. */
static int check_wave_error(const fl_scene *s, fl_err *err)
{
    const fl_scene_water *w = &s->water;
    if (!w->head.present || w->wave == FL_WAVE_NONE) return 0;
    if (w->spread > 0.0 && w->wave == FL_WAVE_AIRY)
        return fl_scene_fail(s, "water.spread", err,
                             "a regular wave has one direction: water.wave = jonswap is expected");
    if (w->ice_decay != FL_ICE_DECAY_NONE && !isfinite(w->ice_edge))
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay needs the edge of the ice: water.ice_edge is expected");
    if (w->ice_decay != FL_ICE_DECAY_NONE && w->spread > 0.0)
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay is along one direction: either water.ice_decay or water.spread is "
                             "expected");
    if ((w->ice_decay == FL_ICE_DECAY_ROGERS || w->ice_decay == FL_ICE_DECAY_MEYLAN) &&
        w->ice_thickness == 0.0)
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay needs the thickness of the ice: water.ice_thickness is expected");
    if (w->ice_decay == FL_ICE_DECAY_OWN && !(w->ice_decay_law.x > 0.0))
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay has no law: water.ice_decay_law with C above 0 is expected");
    if (w->ice_decay == FL_ICE_DECAY_OWN && w->ice_decay_law.y != 0.0 && w->ice_thickness == 0.0)
        return fl_scene_fail(s, "water.ice_decay", err,
                             "the decay needs the thickness of the ice: water.ice_thickness is expected");
    if (w->wave_error == 0.0 && (w->spread > 0.0 || w->ice_decay != FL_ICE_DECAY_NONE))
        return fl_scene_fail(s, "water.wave_error", err,
                             "with %s the waves are evaluated by error only: a number is expected",
                             w->spread > 0.0 ? "water.spread" : "water.ice_decay");
    if (w->wave_error > 0.0 && w->every > 1)
        return fl_scene_fail(s, "water.every", err,
                             "water.wave_error chooses when the waves are evaluated: either water.every or "
                             "water.wave_error is expected");
    if (w->wave_error > 0.0 && s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "sleeping floes evaluate the waves when they wake: water.wave_error = none is "
                             "expected");
    for (int c = 0; c < 2; c++)
        if (w->spread > 0.0 && s->boundary.head.present && s->boundary.type[c] == FL_BOUNDARY_PERIODIC)
            return fl_scene_fail(s, "water.spread", err,
                                 "waves of all directions do not repeat with a periodic boundary: another "
                                 "boundary or water.spread = none is expected");
    return 0;
}

static int check_wind(const fl_scene *s, fl_err *err)
{
    if (s->wind.head.present && s->wind.beaufort >= 0.0 && v3_norm(s->wind.velocity) > 0.0)
        return fl_scene_fail(s, "wind.beaufort", err,
                             "the wind is given twice: by wind.velocity and by wind.beaufort");
    return 0;
}

/* Ratios to a property of the body: none is negative, except -1 for auto. */
static int check_ratios(const fl_scene *s, const char *key, fl_vec3 x, fl_err *err)
{
    const double all[] = {x.x, x.y, x.z};
    for (int c = 0; c < 3; c++)
        if (all[c] < 0.0 && all[c] != -1.0)
            return fl_scene_fail(s, key, err, "%s of axis %d is %g, at least 0 or auto is expected", key,
                                 c + 1, all[c]);
    return 0;
}

static int check_statics(const fl_scene *s, fl_err *err)
{
    for (int32_t k = 0; k < s->n_stage; k++)
        if (s->stage[k].start < 0.0 && !s->run.relax)
            return fl_fail(err, FL_INPUT, "[stage %s] begins when the run has settled, and run.relax is none",
                           s->stage[k].name);
    if (s->n_stage && s->boundary.head.present && s->boundary.inflow != FL_INFLOW_NONE)
        return fl_scene_fail(s, "boundary.inflow", err,
                             "stages change a model without inflow: either is expected");
    if (s->n_stage && s->run.error > 0.0)
        return fl_scene_fail(
            s, "run.error", err,
            "run.error is for a model that stays the same: either it or stages are expected");
    if (!s->run.relax) return 0;
    if (s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "run.relax brings bodies to rest: either it or run.sleep is expected");
    if (s->run.error > 0.0)
        return fl_scene_fail(s, "run.error", err,
                             "run.error is for motion in time: either it or run.relax is expected");
    return 0;
}

static int check_groups(const fl_scene *s, fl_err *err)
{
    for (int32_t i = 0; i < s->n_group; i++) {
        const fl_scene_group *g = &s->group[i];
        const double v[] = {g->velocity.x, g->velocity.y, g->velocity.z};
        char key[2 * FL_SCENE_NAME];
        snprintf(key, sizeof key, "group %s.velocity", g->name);
        for (int c = 0; c < 3; c++)
            if (v[c] != 0.0 && !(g->fixed >> c & 1u))
                return fl_scene_fail(
                    s, key, err,
                    "group.velocity along %c is %g m/s, and %c is not among the fixed directions", 'x' + c,
                    v[c], 'x' + c);
    }
    return 0;
}

/* What a track of the drive excludes. */
static int check_drive_track(const fl_scene *s, fl_err *err)
{
    const fl_scene_boundary *b = &s->boundary;
    if (!b->head.present || !b->drive_track[0]) return 0;
    if (v3_nonzero(b->drive))
        return fl_scene_fail(s, "boundary.drive_track", err,
                             "boundary.drive is given as well: one of the two is expected");
    if (b->drive_width > 0.0 && b->drive_edge == 0)
        return fl_scene_fail(s, "boundary.drive_track", err,
                             "a track has no rear: boundary.drive_edge is expected");
    if (s->run.sleep > 0.0)
        return fl_scene_fail(
            s, "boundary.drive_track", err,
            "floes that follow a track do not sleep: either drive_track or run.sleep is expected");
    return 0;
}

int fl_scene_check(fl_scene *s, fl_err *err)
{
    if (add_missing_material(s, "ice", err) || add_missing_material(s, "steel", err)) return -1;
    set_default_intervals(s);
    if (s->run.dt > s->run.duration)
        return fl_scene_fail(s, "run.dt", err, "run.dt is %g s, at most the duration, %g s, is expected",
                             s->run.dt, s->run.duration);
    if (s->run.error > 0.0 && s->run.sleep > 0.0)
        return fl_scene_fail(s, "run.sleep", err,
                             "run.error repeats windows with other steps, in which no floe can sleep: either "
                             "run.error or run.sleep is expected");
    if (s->water.head.present && s->water.every > 1 && s->run.sleep > 0.0)
        return fl_scene_fail(
            s, "water.every", err,
            "sleeping floes (run.sleep) evaluate the water when they wake: water.every = 1 is expected");
    if (s->run.error > 0.0 && s->run.dt > 0.0)
        return fl_scene_fail(s, "run.error", err,
                             "run.error chooses the step and run.dt sets it: only one of them is expected");
    if (fl_scene_check_unused(s, err) || check_inputs(s, err) || check_outputs(s, err) ||
        check_contacts(s, err))
        return -1;
    set_default_wave_error(s);
    return check_boundary(s, err) || check_current(s, err) || check_weight(s, err) || check_waves(s, err) ||
                   check_wave_error(s, err) || check_wind(s, err) || fl_scene_check_bonds(s, err) ||
                   fl_scene_check_failure(s, err) || fl_scene_check_members(s, err) ||
                   fl_scene_check_modes(s, err) || fl_scene_check_crushing_rate(s, err) ||
                   check_drive_track(s, err) ||
                   check_ratios(s, "water.added_mass", s->water.added_mass, err) ||
                   check_ratios(s, "water.added_inertia", s->water.added_inertia, err) ||
                   check_groups(s, err) || fl_scene_check_motions(s, err) || check_statics(s, err) ||
                   fl_scene_check_zones(s, err)
               ? -1
               : 0;
}
