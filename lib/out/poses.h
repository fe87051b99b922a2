/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poses.h -- the positions and orientations of the bodies, as tables and frames write them. */
#ifndef FL_OUT_POSES_H
#define FL_OUT_POSES_H
#include "body/body.h"
#include "structure/periodic_cell.h"

/* All members are borrowed. */
typedef struct {
    const fl_bodies *b;
    const int32_t *id;
    const fl_quat *q0;            /* body axes at the start, the reference of the written orientations */
    const int32_t *order;         /* [b->n] order in which bodies are written; NULL: by index */
    const fl_periodic_cell *cell; /* positions are written inside it; NULL: as they are */
    const uint8_t *absent;        /* [b->n] empty places; NULL: none */
} fl_poses;

/* The k-th body to write; -1: its place is empty. */
static inline int32_t fl_poses_body(const fl_poses *p, int32_t k)
{
    const int32_t i = p->order ? p->order[k] : k;
    return p->absent && p->absent[i] ? -1 : i;
}

static inline fl_vec3 fl_poses_position(const fl_poses *p, int32_t i)
{
    return p->cell ? fl_periodic_cell_wrap(p->cell, p->b->x[i]) : p->b->x[i];
}

#endif
