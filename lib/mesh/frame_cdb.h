/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_cdb.h -- the commands of an ANSYS archive that make a frame.
 *
 *     elements   BEAM188 BEAM189 BEAM4 BEAM3, PIPE288 PIPE289 PIPE16, LINK180 LINK8 LINK1, MASS21, with the
 *                orientation node of beams; curved ones run straight from end to end
 *     sections   SECDATA of BEAM (RECT CTUBE CSOLID ASEC), PIPE, LINK; real constants of the older elements
 *     materials  EX, GXY, PRXY or NUXY, DENS of MP and MPDATA
 *     nodes      D, F
 * All other commands are counted. */
#ifndef FL_MESH_FRAME_CDB_H
#define FL_MESH_FRAME_CDB_H
#include "mesh/frame_model.h"

enum { FL_FRAME_CONSTANTS = 12 };

/* An element until all sections are known. */
typedef struct {
    int32_t element; /* of the frame; -1: a mass */
    int32_t node, routine;
    int64_t material, section, real, third; /* third: its orientation node, 0: none */
} fl_frame_cdb_line;

typedef struct {
    fl_frame_model *model; /* borrowed */
    fl_id_map real_id;
    double (*constant)[FL_FRAME_CONSTANTS]; /* [real_id.n] */
    fl_frame_cdb_line *line;
    int32_t lines, line_cap, constant_cap;
} fl_frame_cdb;

/* -1 with FL_SYSTEM. */
int fl_frame_cdb_element(fl_frame_cdb *f, int64_t id, int32_t routine, int64_t material, int64_t section,
                         int64_t real, int nodes, const int64_t *node, fl_err *err);
int fl_frame_cdb_constant(fl_frame_cdb *f, int64_t real, int k, double x, fl_err *err);
int fl_frame_cdb_section(fl_frame_cdb *f, int64_t id, const char *type, const char *subtype,
                         char *const *word, fl_err *err);

/* MP, MPDATA, D, F, RMORE; others are counted. */
int fl_frame_cdb_command(fl_frame_cdb *f, char *const *word, int64_t constants, fl_err *err);

/* Elements get their sections, materials and axes. */
int fl_frame_cdb_finish(fl_frame_cdb *f, fl_err *err);
void fl_frame_cdb_free(fl_frame_cdb *f);

#endif
