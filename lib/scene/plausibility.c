/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scene/plausibility.h"
#include <math.h>
#include <string.h>

/* A unit that may have been meant: the value times factor. */
struct meant_unit {
    const char *name;
    double factor;
};

enum { MEANT_MOST = 3 };

struct plausible_range {
    const char *unit;
    double lo, hi, usual_lo, usual_hi;
    struct meant_unit meant[MEANT_MOST]; /* tried in order; ends at a NULL name */
};

static const struct plausible_range ICE_DENSITY = {"kg/m3", 500.0, 950.0, 800.0, 930.0, {{"t/m3", 1e3}}},
                                    WATER_DENSITY = {"kg/m3", 990.0, 1050.0, 998.0, 1030.0, {{"t/m3", 1e3}}},
                                    YOUNG = {"Pa", 1e6, 12e9, 1e8, 1e10, {{"GPa", 1e9}, {"MPa", 1e6}}},
                                    POISSON = {"", 0.0, 0.45, 0.2, 0.4, {{"%", 1e-2}}},
                                    FRICTION = {"", 0.0, 2.0, 0.0, 0.6, {{"%", 1e-2}}},
                                    RESTITUTION = {"", 0.0, 1.0, 0.0, 0.6, {{"%", 1e-2}}},
                                    THICKNESS = {"m", 0.005, 60.0, 0.005, 5.0, {{"cm", 1e-2}, {"mm", 1e-3}}},
                                    LENGTH = {"m", 0.02, 5e4, 0.02, 5e3, {{"mm", 1e-3}, {"km", 1e3}}},
                                    CURRENT = {"m/s", 0.0, 5.0, 0.0, 2.0, {{"cm/s", 1e-2}, {"mm/s", 1e-3}}},
                                    SHIP = {"m/s", 0.0, 20.0, 0.0, 10.0, {{"kn", 0.5144}, {"cm/s", 1e-2}}},
                                    WIND = {"m/s", 0.0, 75.0, 0.0, 40.0, {{"kn", 0.5144}, {"cm/s", 1e-2}}},
                                    WATER_DRAG = {"", 0.0, 0.1, 0.0, 0.035, {{"1e-3", 1e-3}}},
                                    AIR_DRAG = {"", 0.0, 0.05, 0.0, 0.01, {{"1e-3", 1e-3}}},
                                    FORM_DRAG = {"", 0.0, 3.0, 0.0, 1.2, {{"%", 1e-2}}},
                                    STRENGTH = {"Pa", 1e4, 15e6, 1e5, 5e6, {{"MPa", 1e6}, {"kPa", 1e3}}};

/* Who looks at the values: a check that stops at the first, or warnings. */
struct plausible_look {
    const fl_scene *s;
    FILE *warnings; /* NULL: a check */
    const char *before;
    fl_err *err;
};

static int is_called_ice(const char *name) { return strncmp(name, "ice", 3) == 0; }

static const char *unit_meant(const struct plausible_range *r, double x)
{
    for (int k = 0; k < MEANT_MOST && r->meant[k].name; k++)
        if (x * r->meant[k].factor >= r->lo && x * r->meant[k].factor <= r->hi) return r->meant[k].name;
    return NULL;
}

static void say_range(char text[160], const struct plausible_range *r, double lo, double hi)
{
    const char *space = r->unit[0] ? " " : "";
    if (lo > 0.0) snprintf(text, 160, "%.6g to %.6g%s%s", lo, hi, space, r->unit);
    else snprintf(text, 160, "at most %.6g%s%s", hi, space, r->unit);
}

/* One value; key: of the scene, or NULL: what says what it is.  -1 where the check stops. */
static int look_at(const struct plausible_look *l, const char *key, const char *what, double x,
                   const struct plausible_range *r)
{
    const int is_check = l->warnings == NULL;
    const double lo = is_check ? r->lo : r->usual_lo, hi = is_check ? r->hi : r->usual_hi;
    const char *space = r->unit[0] ? " " : "", *meant = unit_meant(r, x);
    char range[160], sentence[400];
    if (isnan(x) || (x >= lo && x <= hi)) return 0;
    say_range(range, r, lo, hi);
    if (!is_check) {
        fprintf(l->warnings, "%s%s%s%.6g%s%s is unusual, %s is expected\n", l->before, what,
                what[0] ? " " : "", x, space, r->unit, range);
        return 0;
    }
    snprintf(sentence, sizeof sentence,
             "%s%s%.6g%s%s is outside what exists on earth, %s%s%s%s; --force runs it", what,
             what[0] ? " " : "", x, space, r->unit, range, meant ? ": " : "", meant ? meant : "",
             meant ? "?" : "");
    if (key) return fl_scene_fail(l->s, key, l->err, "%s", sentence);
    return fl_fail(l->err, FL_INPUT, "%s: %s", l->s->ice.file, sentence);
}

static int look_at_material(const struct plausible_look *l, const fl_scene_material *m)
{
    char key[FL_SCENE_NAME + 40], what[FL_SCENE_NAME + 40];
    const struct {
        const char *name;
        double x;
        const struct plausible_range *range;
    } row[] = {{"density", m->density, &ICE_DENSITY},
               {"young", m->young, &YOUNG},
               {"poisson", m->poisson, &POISSON},
               {"restitution", m->restitution, &RESTITUTION},
               {"friction", m->friction, &FRICTION}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        snprintf(key, sizeof key, "material %s.%s", m->name, row[k].name);
        snprintf(what, sizeof what, "material.%s.%s of", m->name, row[k].name);
        if (look_at(l, key, what, row[k].x, row[k].range)) return -1;
    }
    if (l->warnings || m->density < l->s->water.density) return 0;
    snprintf(key, sizeof key, "material %s.density", m->name);
    return fl_scene_fail(l->s, key, l->err, "ice of %.6g kg/m3 sinks in water of %.6g kg/m3; --force runs it",
                         m->density, l->s->water.density);
}

static int look_at_contacts(const struct plausible_look *l)
{
    char key[2 * FL_SCENE_NAME + 40];
    if (l->s->structure.head.present && look_at(l, "structure.friction", "structure.friction of",
                                                fmax(0.0, l->s->structure.friction), &FRICTION))
        return -1;
    for (int32_t k = 0; k < l->s->n_contact; k++) {
        const fl_scene_contact *c = &l->s->contact[k];
        if (c->a[0]) snprintf(key, sizeof key, "contact %s %s.friction", c->a, c->b);
        else snprintf(key, sizeof key, "contact.friction");
        if (c->friction > 0.0 && look_at(l, key, "contact friction of", c->friction, &FRICTION)) return -1;
    }
    return 0;
}

static int look_at_water(const struct plausible_look *l)
{
    const fl_scene_water *w = &l->s->water;
    const fl_scene_wind *a = &l->s->wind;
    const fl_scene_boundary *b = &l->s->boundary;
    if (look_at(l, "water.density", "water.density of", w->density, &WATER_DENSITY) ||
        look_at(l, "water.current", "water.current of", v3_norm(w->current), &CURRENT) ||
        look_at(l, "water.drag_force_coef", "water.drag_force_coef of", w->drag_force_coef, &WATER_DRAG) ||
        look_at(l, "water.form_coef", "water.form_coef of", w->form_coef, &FORM_DRAG) ||
        look_at(l, "boundary.inflow_speed", "boundary.inflow_speed of", b->inflow_speed, &CURRENT) ||
        look_at(l, "structure.velocity", "structure.velocity of", v3_norm(l->s->structure.motion.velocity),
                &SHIP))
        return -1;
    if (!a->head.present) return 0;
    return look_at(l, "wind.velocity", "wind.velocity of", v3_norm(a->velocity), &WIND) ||
                   look_at(l, "wind.drag_coef", "wind.drag_coef of", a->drag_coef, &AIR_DRAG)
               ? -1
               : 0;
}

static int look_at_bonds(const struct plausible_look *l)
{
    const fl_scene_bond *b = &l->s->bond;
    if (!b->head.present || !b->on) return 0;
    if (isfinite(b->normal_strength) &&
        look_at(l, "bond.normal_strength", "bond.normal_strength of", b->normal_strength, &STRENGTH))
        return -1;
    if (isfinite(b->shear_strength) &&
        look_at(l, "bond.shear_strength", "bond.shear_strength of", b->shear_strength, &STRENGTH))
        return -1;
    return 0;
}

static int look_at_floes(const struct plausible_look *l, const fl_floe_extent *e)
{
    char what[80];
    const struct {
        const char *name;
        int32_t id;
        double x;
        const struct plausible_range *range;
    } row[] = {{"thickness", e->thickest_id, e->thickest, &THICKNESS},
               {"thickness", e->thinnest_id, e->thinnest, &THICKNESS},
               {"length", e->longest_id, e->longest, &LENGTH},
               {"length", e->shortest_id, e->shortest, &LENGTH}};
    for (size_t k = 0; e->n && k < sizeof row / sizeof *row; k++) {
        snprintf(what, sizeof what, "floe %d: a %s of", row[k].id, row[k].name);
        if (look_at(l, NULL, what, row[k].x, row[k].range)) return -1;
    }
    if (l->warnings && e->n && 2 * (int64_t)e->blocks > e->n)
        fprintf(l->warnings,
                "%s%d of %d floes are blocks, thicker than long: they turn over, and the loads are those of "
                "rubble\n",
                l->before, e->blocks, e->n);
    return 0;
}

static int look_at_all(const struct plausible_look *l, const fl_floe_extent *floes)
{
    const int32_t m = fl_scene_find_material(l->s, l->s->ice.material);
    const int is_lattice = l->warnings && l->s->ice.slab > 0.0; /* its values are those that make the sheet */
    if (!l->s->water.head.present || !is_called_ice(l->s->ice.material)) return 0;
    if (look_at_water(l)) return -1;
    if (!is_lattice && ((m >= 0 && look_at_material(l, &l->s->material[m])) || look_at_bonds(l))) return -1;
    return look_at_contacts(l) || look_at_floes(l, floes) ? -1 : 0;
}

int fl_scene_check_plausible(const fl_scene *s, const fl_floe_extent *floes, fl_err *err)
{
    return look_at_all(&(struct plausible_look){s, NULL, NULL, err}, floes);
}

void fl_scene_warn_implausible(const fl_scene *s, const fl_floe_extent *floes, const char *before, FILE *f)
{
    look_at_all(&(struct plausible_look){s, f, before, NULL}, floes);
}

static void note_floe(fl_floe_extent *e, int32_t id, double thickness, double length)
{
    if (!e->n || thickness > e->thickest) e->thickest = thickness, e->thickest_id = id;
    if (!e->n || thickness < e->thinnest) e->thinnest = thickness, e->thinnest_id = id;
    if (!e->n || length > e->longest) e->longest = length, e->longest_id = id;
    if (!e->n || length < e->shortest) e->shortest = length, e->shortest_id = id;
    e->blocks += length < thickness;
    e->n++;
}

fl_floe_extent fl_floe_extent_of(const fl_ice_field *field)
{
    fl_floe_extent e = {0};
    for (int32_t k = 0; k < field->n; k++) {
        const fl_poly *p = &field->core[k];
        fl_vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3(-INFINITY, -INFINITY, -INFINITY);
        const double r = 2.0 * field->radius[k];
        const int32_t m = field->material[k];
        if (p->nf < 4 || (m >= 0 && !is_called_ice(field->materials.name[m]))) continue;
        for (int32_t v = 0; v < p->nv; v++) {
            lo = v3(fmin(lo.x, p->v[v].x), fmin(lo.y, p->v[v].y), fmin(lo.z, p->v[v].z));
            hi = v3(fmax(hi.x, p->v[v].x), fmax(hi.y, p->v[v].y), fmax(hi.z, p->v[v].z));
        }
        note_floe(&e, field->id[k], hi.z - lo.z + r, fmax(hi.x - lo.x, hi.y - lo.y) + r);
    }
    return e;
}
