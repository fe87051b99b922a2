/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "view/kept_poses.h"

static double travel_bound(const fl_view_pose *a, const fl_view_pose *b, double reach)
{
    double way = 0.0, less = 0.0, more = 0.0;
    for (int i = 0; i < 3; i++) way += (double)(a->x[i] - b->x[i]) * (a->x[i] - b->x[i]);
    for (int i = 0; i < 4; i++) {
        less += (double)(a->q[i] - b->q[i]) * (a->q[i] - b->q[i]);
        more += (double)(a->q[i] + b->q[i]) * (a->q[i] + b->q[i]);
    }
    /* A body that comes or goes has the quaternion 0 on one side: less = more = 1, twice its reach. */
    return sqrt(way) + 2.0 * reach * sqrt(less < more ? less : more);
}

static int same_place(const fl_kept_poses *k, const fl_view_frame *v, const fl_eye *eye,
                      const fl_map_key *key)
{
    return k->data == v->data && k->rows == v->rows && k->parts == v->parts &&
           memcmp(&k->origin, &v->origin, sizeof k->origin) == 0 &&
           memcmp(k->eye.both.m, eye->both.m, sizeof eye->both.m) == 0 && k->key.ice == key->ice &&
           k->key.structure == key->structure && memcmp(k->key.cut, key->cut, sizeof key->cut) == 0;
}

int fl_kept_poses_hold(const fl_kept_poses *k, const fl_view_frame *v, const fl_eye *eye,
                       const fl_map_key *key, double pixels)
{
    if (!k->data || !same_place(k, v, eye, key)) return 0;
    for (int32_t r = 0; r < v->rows + v->parts; r++) {
        const double most = pixels * eye->pixel * fl_eye_distance(eye, v->pose[r].x, v->reach[r]);
        if (!(travel_bound(&k->pose[r], &v->pose[r], v->reach[r]) <= most)) return 0;
        /* what has been cut or worn has another shape */
        if (r < v->rows && k->frame != v->frame &&
            fl_frame_data_shape(v->data, r, k->frame) != fl_frame_data_shape(v->data, r, v->frame))
            return 0;
    }
    return 1;
}

int fl_kept_poses_take(fl_kept_poses *k, const fl_view_frame *v, const fl_eye *eye, const fl_map_key *key,
                       fl_err *err)
{
    const int64_t n = (int64_t)v->rows + v->parts;
    k->data = NULL;
    if (fl_grow(&k->pose, &k->cap, n, sizeof *k->pose, err)) return -1;
    if (n) memcpy(k->pose, v->pose, (size_t)n * sizeof *v->pose);
    k->data = v->data;
    k->origin = v->origin;
    k->eye = *eye;
    k->key = *key;
    k->frame = v->frame;
    k->rows = v->rows;
    k->parts = v->parts;
    return 0;
}

void fl_kept_poses_drop(fl_kept_poses *k) { k->data = NULL; }

void fl_kept_poses_free(fl_kept_poses *k)
{
    free(k->pose);
    *k = (fl_kept_poses){0};
}
