/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/snapshot_failure.h"
#include <stdlib.h>
#include "base/array.h"
#include "contact/crushing.h"
#include "sim/floe_cut.h"

enum { SHAPE_LIMIT = 65536 }; /* vertices, faces and corners of faces of a fragment */

void fl_snapshot_shape(fl_state_io *t, fl_world *w, int32_t i)
{
    fl_poly *const own = t->f ? w->breaking.shape[i] : NULL;
    int32_t nv = own ? own->nv : 0, nf = own ? own->nf : 0, loops = own ? own->first[own->nf] : 0;
    fl_vec3 *v = NULL;
    int32_t *first = NULL, *loop = NULL;
    double r = w->b.radius[i];
    fl_state_io_open(t, "shape");
    fl_state_io_int(t, 4, SHAPE_LIMIT, &nv);
    fl_state_io_int(t, 4, SHAPE_LIMIT, &nf);
    fl_state_io_int(t, 12, SHAPE_LIMIT, &loops);
    fl_state_io_real(t, &r);
    fl_state_io_int(t, 0, w->scene->n_material - 1, &w->material[i]);
    fl_state_io_byte(t, 63, &w->b.fixed_dof[i]);
    if (t->in && !t->err->code) {
        v = fl_alloc(nv, sizeof *v, t->err);
        first = fl_alloc((int64_t)nf + 1, sizeof *first, t->err);
        loop = fl_alloc(loops, sizeof *loop, t->err);
    }
    for (int32_t k = 0; k < nv && !t->err->code; k++) fl_state_io_vec3(t, own ? &own->v[k] : &v[k]);
    for (int32_t k = 0; k <= nf && !t->err->code; k++)
        fl_state_io_int(t, 0, loops, own ? &own->first[k] : &first[k]);
    for (int32_t k = 0; k < loops && !t->err->code; k++)
        fl_state_io_int(t, 0, nv - 1, own ? &own->loop[k] : &loop[k]);
    fl_state_io_close(t);
    if (t->in && !t->err->code) {
        fl_poly p = {0};
        fl_err why = {0};
        for (int32_t k = 0; k < nf; k++)
            if (first[0] || first[k + 1] < first[k] + 3 || first[nf] != loops)
                fl_text_fail(t->in, t->err, "the faces of a fragment are not valid");
        if (!t->err->code &&
            (fl_poly_make(&p, nv, v, nf, first, loop, &why) || fl_breaking_set_shape(w, i, &p, r, &why)))
            fl_text_fail(t->in, t->err, "the shape of a fragment is not valid: %s", why.text);
    }
    free(v), free(first), free(loop);
}

void fl_snapshot_crushing(fl_state_io *t, fl_world *w)
{
    fl_crushing_state *s = &w->crushing;
    fl_state_io_open(t, "crushed");
    fl_state_io_real(t, &s->volume);
    fl_state_io_real(t, &s->peak);
    fl_state_io_count(t, &s->contact_steps);
    fl_state_io_count(t, &s->dents_dropped);
    fl_state_io_close(t);
    for (int32_t i = 0; i < w->n && !t->err->code; i++) {
        int32_t n = s->dents[i] ? s->dents[i]->n : 0;
        fl_state_io_open(t, "dents");
        fl_state_io_int(t, 0, FL_DENTS, &n);
        if (t->in && n == 0) fl_crushing_forget(w, i);
        else if (t->in && !s->dents[i] && !(s->dents[i] = fl_alloc(1, sizeof **s->dents, t->err))) return;
        for (int32_t k = 0; k < n && !t->err->code; k++) {
            fl_dent *d = &s->dents[i]->dent[k];
            fl_state_io_vec3(t, &d->x);
            fl_state_io_vec3(t, &d->offset);
            fl_state_io_real(t, &d->half_width);
            fl_state_io_real(t, &d->stiffening);
        }
        if (s->dents[i]) s->dents[i]->n = n;
        fl_state_io_close(t);
    }
}

void fl_snapshot_breaking(fl_state_io *t, fl_world *w)
{
    fl_breaking_state *s = &w->breaking;
    fl_state_io_open(t, "broken");
    fl_state_io_count(t, &s->checks);
    fl_state_io_count(t, &s->bent);
    fl_state_io_count(t, &s->split);
    fl_state_io_count(t, &s->cusps);
    fl_state_io_count(t, &s->too_small);
    fl_state_io_count(t, &s->no_room);
    fl_state_io_count(t, &s->buckled);
    fl_state_io_real(t, &s->lost);
    fl_state_io_int(t, 0, INT32_MAX, &s->events);
    fl_state_io_close(t);
    for (int32_t i = 0; i < w->n && !t->err->code; i++) {
        fl_state_io_open(t, "load");
        fl_state_io_real(t, &s->last_load[i]);
        fl_state_io_close(t);
        if (t->in) s->bend_gate[i] = s->split_gate[i] = 0.0;
    }
    const int32_t events = s->events;
    if (t->in) s->events = 0;
    for (int32_t k = 0; k < events && !t->err->code; k++) { /* the number is a hint */
        if (t->in && fl_grow(&s->event, &s->event_cap, (int64_t)k + 1, sizeof *s->event, t->err)) return;
        fl_failure_event *e = &s->event[k];
        if (t->in) *e = (fl_failure_event){.mode = 0};
        fl_state_io_open(t, "failure");
        fl_state_io_real(t, &e->time);
        fl_state_io_int(t, FL_FAILURE_BEND, FL_FAILURE_CUSP, &e->mode);
        fl_state_io_int(t, 0, INT32_MAX, &e->parent);
        fl_state_io_int(t, 0, INT32_MAX, &e->child);
        fl_state_io_vec3(t, &e->x);
        fl_state_io_vec3(t, &e->n);
        fl_state_io_real(t, &e->length);
        fl_state_io_real(t, &e->load);
        fl_state_io_real(t, &e->ratio);
        fl_state_io_real(t, &e->mass);
        fl_state_io_real(t, &e->child_mass);
        fl_state_io_real(t, &e->energy);
        fl_state_io_close(t);
        s->events = k + 1;
    }
}
