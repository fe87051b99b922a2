/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/snapshot_zone.h"
#include "sim/zone_step.h"

static void exchange_node(fl_state_io *t, fl_world *w, int32_t n)
{
    fl_zone_state *z = &w->zones;
    fl_state_io_open(t, "node");
    fl_state_io_vec3(t, &z->set.x[n]), fl_state_io_vec3(t, &z->set.v[n]), fl_state_io_vec3(t, &z->set.f[n]);
    if (z->drag) fl_state_io_vec3(t, &z->drag[n]);
    if (z->push) fl_state_io_vec3(t, &z->push[n]);
    if (w->relax.node_force) fl_state_io_vec3(t, &w->relax.node_force[n]);
    fl_state_io_close(t);
}

static void exchange_flow(fl_state_io *t, fl_sym3 *e, double *lost)
{
    fl_state_io_open(t, "flow");
    double *const all[] = {&e->xx, &e->yy, &e->zz, &e->xy, &e->xz, &e->yz, lost};
    for (int k = 0; k < 7; k++) fl_state_io_real(t, all[k]);
    fl_state_io_close(t);
}

/* A point of a joint: where it is on the other side, and its memory. */
static void exchange_contact_point(fl_state_io *t, const fl_zone_set *s, fl_zone_point *p)
{
    fl_joint_point *q = &p->law;
    double *const number[] = {&p->other[0], &p->other[1], &p->other[2], &p->opening, &p->sigma,
                              &q->sigma,    &q->tau[0],   &q->tau[1],   &q->offset,  &q->slip,
                              &q->angle,    &q->ratio,    &q->way[0],   &q->way[1]};
    fl_state_io_open(t, "pin");
    fl_state_io_int(t, -1, s->triangles - 1, &p->triangle);
    for (int k = 0; k < 14; k++) fl_state_io_real(t, number[k]);
    fl_state_io_vec3(t, &p->apart), fl_state_io_vec3(t, &p->force);
    fl_state_io_int(t, 0, 1, &p->off);
    fl_state_io_int(t, 0, 1, &q->failed);
    fl_state_io_int(t, 0, 1, &q->open);
    fl_state_io_close(t);
}

void fl_snapshot_zones(fl_state_io *t, fl_world *w)
{
    fl_zone_state *z = &w->zones;
    fl_zone_set *s = &z->set;
    int32_t nodes = s->nodes, zones = s->zones, points = z->joints.points;
    fl_state_io_open(t, "zones");
    fl_state_io_int(t, nodes, nodes, &nodes);
    fl_state_io_int(t, zones, zones, &zones);
    fl_state_io_int(t, points, points, &points);
    fl_state_io_real(t, &z->damping), fl_state_io_real(t, &z->drive);
    fl_state_io_close(t);
    for (int32_t n = 0; n < s->nodes && !t->err->code; n++) exchange_node(t, w, n);
    for (int32_t k = 0; k < s->zones && s->plastic && !t->err->code; k++)
        exchange_flow(t, &s->plastic[k], &s->lost[k]);
    for (int32_t n = 0; n < s->nodes && s->plastic && !t->err->code; n++)
        exchange_flow(t, &s->node_plastic[n], &s->node_lost[n]);
    for (int32_t k = 0; k < z->joints.n && !t->err->code; k++) {
        fl_state_io_open(t, "seam");
        fl_state_io_real(t, &z->joints.joint[k].damped);
        fl_state_io_close(t);
    }
    for (int32_t k = 0; k < z->joints.points && !t->err->code; k++)
        exchange_contact_point(t, s, &z->joints.point[k]);
    if (t->in) fl_zones_drop_absent(w);
}
