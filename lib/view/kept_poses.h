/* SPDX-License-Identifier: GPL-3.0-or-later */
/* kept_poses.h -- the poses a shadow map or an occlusion map was drawn with, and whether that map still
 * holds.
 *
 * A map is drawn again when a point of a body has moved by more than a share of its texels. A point of a body
 * at place x with rotation q and reach r has moved by at most
 *
 *     |x - x'| + 2 r min(|q - q'|, |q + q'|)
 *
 * since two rotations whose quaternions differ by c turn into each other by an angle theta, 4 sin(theta/4) =
 * 2 c, and the chord 2 sin(theta/2) of it is not longer. Seen from the eye of the map that is a number of
 * pixels, of the point of the body that is nearest to the eye. Limits: single precision of poses, a
 * thousandth of a pixel. */
#ifndef FL_VIEW_KEPT_POSES_H
#define FL_VIEW_KEPT_POSES_H
#include "view/camera.h"
#include "view/view_frame.h"

/* What else a map depends on. */
typedef struct {
    int ice, structure; /* are drawn */
    float cut[4];       /* cutting plane */
} fl_map_key;

typedef struct {
    const fl_frame_data *data; /* NULL: nothing is kept; borrowed */
    fl_vec3 origin;
    fl_eye eye;
    fl_map_key key;
    int32_t frame, rows, parts, cap;
    fl_view_pose *pose;
} fl_kept_poses;

/* True if a map drawn with what is kept is right for v, seen from `eye`, within `pixels` of that eye. */
int fl_kept_poses_hold(const fl_kept_poses *k, const fl_view_frame *v, const fl_eye *eye,
                       const fl_map_key *key, double pixels);

/* Keeps what a map is drawn with. -1 with FL_SYSTEM. */
int fl_kept_poses_take(fl_kept_poses *k, const fl_view_frame *v, const fl_eye *eye, const fl_map_key *key,
                       fl_err *err);

void fl_kept_poses_drop(fl_kept_poses *k); /* the map is lost */
void fl_kept_poses_free(fl_kept_poses *k); /* accepts a zeroed struct, leaves one */

#endif
