/* SPDX-License-Identifier: GPL-3.0-or-later */
/* path_state.h -- a path that was stopped, so that it can go on to the same bytes: a text of kind
 * `path-state`.
 *
 * It holds all that a point starts from: the last two states, the history of four points, increment, damping
 * in use and the rows that were written; and a hash of the model and of the options that bear on the result.
 * */
#ifndef FL_MEMBER_PATH_STATE_H
#define FL_MEMBER_PATH_STATE_H
#include "member/path_table.h"

/* Hash of nodes, contacts, loads and options. */
uint64_t fl_path_hash(const fl_path *p);

/* Writes the state to a file.  -1 with FL_SYSTEM. */
int fl_path_state_write(const fl_path *p, const fl_path_table *t, const char *path, fl_err *err);

/* Reads it into a path and a table that were started with the same model and options.  -1 with FL_INPUT
 * where they are not those of the file, or the file is damaged. */
int fl_path_state_read(fl_path *p, fl_path_table *t, const char *path, fl_err *err);

#endif
