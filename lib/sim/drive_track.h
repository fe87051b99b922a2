/* SPDX-License-Identifier: GPL-3.0-or-later */
/* drive_track.h -- driven floes that follow a track, boundary.drive_track.
 *
 * In a step from t to t + dt the driven directions have the velocity (d(t + dt) - d(t))/dt, d the
 * displacement of the track(5), so that positions follow it to rounding. The work of the change of velocity
 * is m (v1 - v0) (v1 + v0)/2, and belongs to the drive, as that of the forces does. */
#ifndef FL_SIM_DRIVE_TRACK_H
#define FL_SIM_DRIVE_TRACK_H
#include "world/access.h"

/* Reads the track, with cubic interpolation.  -1 with FL_INPUT (a row rotates, or moves along a direction
 * that drive_fixed does not have; the file) or FL_SYSTEM. */
int fl_drive_track_read(fl_world *w, fl_err *err);

/* Velocity of the track at time t. */
fl_vec3 fl_drive_track_velocity(const fl_world *w, double t);

/* Before the step from time t: sets the velocities of all driven floes. Only where there is a track. */
void fl_drive_track_begin_step(fl_world *w, double t);

#endif
