/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh.h -- invariants of every surface that a reader returns. */
#ifndef FL_TESTS_MESH_H
#define FL_TESTS_MESH_H
#include <stddef.h>
#include "geom/surface.h"

/* Indices in range, coordinates finite, each part not empty and with a name of one word. */
int mesh_sound(const fl_surface *s);

/* Are the two the same in names, ids, vertices, triangles and cones, number for number (-0 is 0)? */
int mesh_same(const fl_surface *a, const fl_surface *b);

/* A fuzz_fn over fl_mesh_read(): a surface that is read must be valid, must pass welding, orientation and
 * measurement, and must come back the same from a g_struct file. */
int mesh_fuzz(const unsigned char *data, size_t n);

/* The same, then again with every part and every set selected and curved faces subdivided. */
int mesh_fuzz_all(const unsigned char *data, size_t n);

/* The same, then its halves are mirrored and a deck is raised: parts stay valid, and gain no open edge. */
int mesh_fuzz_hulls(const unsigned char *data, size_t n);

/* The same as mesh_fuzz_all(), then as a frame and the model of members that it becomes, which may be
 * refused. */
int mesh_fuzz_members(const unsigned char *data, size_t n);

#endif
