/* SPDX-License-Identifier: GPL-3.0-or-later */
/* put.h -- numbers as bytes, the lowest first, whatever the machine. */
#ifndef FL_MESH_PUT_H
#define FL_MESH_PUT_H
#include <stdint.h>
#include <stdio.h>
#include "geom/vec3.h"

/* The low n bytes of u, 1 <= n <= 8. */
void fl_put_uint(FILE *f, uint64_t u, int n);

/* A double, and three of them. */
void fl_put_f64(FILE *f, double x);
void fl_put_vec3(FILE *f, fl_vec3 x);

#endif
