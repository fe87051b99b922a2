/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "scene/scene.h"
#include "scene/scene_section.h"
#include "scene/scene_value.h"

void fl_scene_init(fl_scene *scene)
{
    memset(scene, 0, sizeof *scene);
    for (int s = 0; s < FL_SECTIONS; s++)
        if (!fl_section_table[s].names) fl_section_defaults(s, "", fl_section_at(scene, s, 0));
}

void fl_scene_free(fl_scene *scene)
{
    for (int32_t k = 0; k < scene->n_file; k++) free(scene->file[k]);
    free(scene->file);
    free(scene->material);
    free(scene->contact);
    free(scene->group);
    free(scene->part);
    free(scene->mode);
    free(scene->joint);
    free(scene->stage);
    memset(scene, 0, sizeof *scene);
}

int32_t fl_scene_find_material(const fl_scene *scene, const char *name)
{
    return fl_section_named(scene, FL_SEC_MATERIAL, name, "");
}

int32_t fl_scene_find_group(const fl_scene *scene, const char *name)
{
    return fl_section_named(scene, FL_SEC_GROUP, name, "");
}

/* Copy the keys that [contact A B] gives, but those given as "auto", to out. */
static void apply_contact_section(fl_scene_contact *out, const fl_scene *scene, const char *a, const char *b)
{
    const int32_t i = fl_section_named(scene, FL_SEC_CONTACT, a, b);
    const int first = fl_key_first(FL_SEC_CONTACT);
    if (i < 0) return;
    for (int k = first; k < fl_key_first(FL_SEC_CONTACT + 1); k++)
        if (scene->contact[i].head.key[k - first].line && !scene->contact[i].head.key[k - first].is_auto)
            fl_value_copy(&fl_key_table[k], out, &scene->contact[i]);
}

fl_scene_contact fl_scene_pair(const fl_scene *scene, int32_t a, int32_t b)
{
    const fl_scene_material *p = &scene->material[a], *q = b >= 0 ? &scene->material[b] : NULL;
    fl_scene_contact out;
    fl_section_defaults(FL_SEC_CONTACT, "", &out);
    apply_contact_section(&out, scene, "", "");
    if (b == FL_SCENE_STRUCTURE) {
        const int32_t m = fl_scene_find_material(scene, scene->structure.material);
        if (m >= 0) q = &scene->material[m];
        if (scene->structure.friction >= 0.0) out.friction = scene->structure.friction;
        apply_contact_section(&out, scene, p->name, scene->structure.material);
        apply_contact_section(&out, scene, p->name, "structure");
    } else if (b == FL_SCENE_BOUNDARY) {
        if (scene->boundary.stiffness > 0.0) out.stiffness = scene->boundary.stiffness;
        apply_contact_section(&out, scene, p->name, "boundary");
    } else {
        apply_contact_section(&out, scene, p->name, q->name);
    }
    if (!q) q = p;
    if (out.friction < 0.0) out.friction = fmin(p->friction, q->friction);
    if (out.restitution < 0.0) out.restitution = fmin(p->restitution, q->restitution);
    memcpy(out.a, p->name, sizeof out.a);
    memcpy(out.b,
           b == FL_SCENE_STRUCTURE  ? "structure"
           : b == FL_SCENE_BOUNDARY ? "boundary"
                                    : q->name,
           b == FL_SCENE_STRUCTURE  ? sizeof "structure"
           : b == FL_SCENE_BOUNDARY ? sizeof "boundary"
                                    : sizeof out.b);
    return out;
}

int fl_scene_fail(const fl_scene *scene, const char *key, fl_err *err, const char *fmt, ...)
{
    char what[400], why[200];
    fl_scene_mark mark = {0};
    fl_address at;
    va_list ap;
    va_start(ap, fmt);
    vsnprintf(what, sizeof what, fmt, ap);
    va_end(ap);
    if (fl_address_read(key, &at, why, sizeof why) == 0) {
        const int32_t i = fl_section_named(scene, at.section, at.a, at.b);
        const fl_scene_head *head = fl_section_at(scene, at.section, i);
        if (head && at.key >= 0) mark = head->key[at.key - fl_key_first(at.section)];
        if (head && mark.line == 0) mark = head->heading;
    }
    if (mark.line && mark.file == FL_SCENE_ARGUMENT) return fl_fail(err, FL_USAGE, "--set: %s", what);
    if (scene->n_file == 0) return fl_fail(err, FL_INPUT, "%s", what);
    if (mark.line == 0) return fl_fail(err, FL_INPUT, "%s: %s", scene->file[0], what);
    return fl_fail(err, FL_INPUT, "%s:%d: %s", scene->file[mark.file], mark.line, what);
}
