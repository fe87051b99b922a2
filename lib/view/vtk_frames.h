/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtk_frames.h -- frames for ParaView: a .vtp of polygons for each, compressed, and a .pvd with their
 * times.
 *
 * Arrays are appended raw in blocks of 32 KiB, each a zlib stream (vtkZLibDataCompressor), lengths of 32
 * bits, little-endian.  Floes are the triangles of their rounded shapes with arcs cut once, with normals
 * at points; cell data body, group, speed, spin, thickness, diameter.  As points: a vertex for each body
 * with its rotation. Source: VTK File Formats, in The VTK User's Guide, Kitware (2010), section 19.3. */
#ifndef FL_VIEW_VTK_FRAMES_H
#define FL_VIEW_VTK_FRAMES_H
#include <stdio.h>
#include "view/playback.h"

/* The bodies at the time of the playback; group: [rows] or NULL.  -1 with FL_INPUT (more than 32 bits can
 * number) or FL_SYSTEM; write errors stay in f, for fl_out_close(). */
int fl_vtk_write_bodies(FILE *f, const fl_playback *p, const int32_t *group, int points, fl_err *err);

/* The parts of the structure where they are now, with cell data part; and, where panel is not NULL, force
 * on its panel over its area as traction [Pa].  panel: for each triangle and then each cone of each part,
 * panels(5), area [m2] and force [N]. */
int fl_vtk_write_structure(FILE *f, const fl_playback *p, const double (*panel)[4], fl_err *err);

/* Number of panels of a structure. */
int64_t fl_vtk_panels(const fl_surface *s);

/* A collection: begin, a file at a time, end. */
void fl_vtk_begin_collection(FILE *f);
void fl_vtk_add_file(FILE *f, double t, const char *name);
void fl_vtk_end_collection(FILE *f);

#endif
