/* SPDX-License-Identifier: GPL-3.0-or-later */
/* export_loads.h -- --export: a load record in the input form of another program.
 *
 * openfast: the time series of a prescribed force of structural control (StC_DOF_MODE = 4) of ServoDyn: rows
 * of time, FX FY FZ [N], MX MY MZ [N m], in global axes (PrescribedForcesCoord = 1), with comments that begin
 * with #.  It is the only input of OpenFAST that takes a force and a moment at a point of the structure at
 * given times, without another module; values in between are interpolated.  A row of a load table is the mean
 * over its interval, so it stands at the middle of it; the first and the last mean stand at the ends too.
 *
 * orcaflex: a time history file: names in the first row, then columns separated by tabs, kN and kN m. It has
 * no comments, so the history of the record is not in it.
 * ansys: six tables of APDL, ICE_fx(row, 0) time, ICE_fx(row) load in N and N m, to be given to F by their
 * names in per cent signs.
 * Rows of all forms are those of openfast.
 * Source: OpenFAST documentation, ServoDyn, structural control, prescribed time series. */
#ifndef LOADSTATS_EXPORT_LOADS_H
#define LOADSTATS_EXPORT_LOADS_H
#include "settings.h"

/* Name of form k, NULL after the last. */
const char *export_form_name(int k);

/* The load of --part, else the total, to --output.  0, or -1 with FL_INPUT, FL_USAGE or FL_SYSTEM. */
int export_loads(const struct options *o, fl_err *err);

#endif
