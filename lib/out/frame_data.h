/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_data.h -- what a file of frames holds: shapes, parts of the structure, an index of frames; and the
 * poses of one frame.  Formats: animation(5), state(5).
 *
 * A body is a number (id) of the file; its row is counted from 0 in the order of first appearance.  A
 * shape that comes again under a known number replaces the old one from the next frame on. */
#ifndef FL_OUT_FRAME_DATA_H
#define FL_OUT_FRAME_DATA_H
#include <stdint.h>
#include "base/err.h"
#include "geom/quat.h"
#include "geom/surface.h"

/* A core and its dilation radius.  Vertices are about the centre of mass, in the axes of the start. */
typedef struct {
    int32_t id;
    int32_t from;  /* first frame that it is valid for */
    int32_t next;  /* the shape that replaces it, -1: none */
    int32_t v, nv; /* its vertices are vertex[v .. v + nv) */
    int32_t f, nf; /* its faces are f .. f + nf */
    int32_t line;  /* of its record, for messages */
    double radius; /* [m] */
} fl_frame_shape;

/* An entry of the index. */
typedef struct {
    double t;         /* [s] */
    int64_t at, size; /* bytes of the file */
    int64_t line;     /* text: line of its first record */
    int32_t bodies;   /* records of bodies in it; -1: none, those of an earlier frame are valid */
    int32_t ice;      /* the frame whose bodies are valid, -1: none yet */
    int32_t key;      /* packed: the frame from which decoding starts */
    int32_t piece;    /* number of the file, of a run that is split over several */
} fl_frame_entry;

typedef struct {
    fl_frame_shape *shape;
    int32_t shapes, shape_cap;
    fl_vec3 *vertex; /* of all shapes [m] */
    int32_t vertices, vertex_cap;
    int32_t *face; /* [faces + 1] offsets into loop */
    int32_t faces, face_cap;
    int32_t *loop; /* vertices of the faces, from 0 within the shape */
    int32_t loops, loop_cap;
    int32_t *row_shape; /* [rows] first shape of a body */
    int32_t rows, row_cap;
    int32_t *slot; /* [slots] row of a number by hashing, -1: free */
    int32_t slots;
    fl_surface structure;
    fl_frame_entry *frame;
    int32_t frames, frame_cap;
} fl_frame_data;

/* The poses of a frame.  Arrays by row of body, and by part of the structure. */
typedef struct {
    double t;
    int32_t k; /* number of the frame, -1: nothing was read */
    int32_t rows, parts, cap, part_cap;
    fl_vec3 *x;       /* [rows] centre of mass [m] */
    fl_quat *q;       /* [rows] rotation since the start */
    uint8_t *there;   /* [rows] */
    int has_velocity; /* v and w are from the file */
    fl_vec3 *v, *w;   /* [rows] velocity [m/s], angular velocity [rad/s] */
    fl_vec3 *part_x;  /* [parts] a vertex v of the part is at x + R(q) v */
    fl_quat *part_q;
} fl_frame;

/* Row of a number; -1: unknown. */
int32_t fl_frame_data_row(const fl_frame_data *d, int32_t id);

/* The shape of a row at frame k. */
const fl_frame_shape *fl_frame_data_shape(const fl_frame_data *d, int32_t row, int32_t k);

/* Begins a shape, valid from the next frame on; its vertices and faces follow.  Returns -1 with FL_SYSTEM. */
int fl_frame_data_add_shape(fl_frame_data *d, int32_t id, double radius, int32_t line, fl_err *err);
int fl_frame_data_add_vertex(fl_frame_data *d, fl_vec3 x, fl_err *err);
int fl_frame_data_add_face(fl_frame_data *d, const int32_t *v, int32_t n, fl_err *err);

/* Appends an entry; `ice` follows from `bodies` and the entries before it. */
int fl_frame_data_add_frame(fl_frame_data *d, fl_frame_entry e, fl_err *err);

/* The last frame at or before t, and the first one where t is before it; -1 without frames. */
int32_t fl_frame_data_at(const fl_frame_data *d, double t);

/* Largest distance of a point of the shape from its centre of mass [m]. */
double fl_frame_data_reach(const fl_frame_data *d, const fl_frame_shape *s);

/* Makes room for the frame's arrays and sets them to "no body, structure at rest". */
int fl_frame_clear(fl_frame *f, const fl_frame_data *d, fl_err *err);

/* Both accept a zeroed struct and leave one. */
void fl_frame_free(fl_frame *f);
void fl_frame_data_free(fl_frame_data *d);

#endif
