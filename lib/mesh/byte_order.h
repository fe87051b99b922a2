/* SPDX-License-Identifier: GPL-3.0-or-later */
/* byte_order.h -- numbers written as little-endian bytes on any machine. */
#ifndef FL_MESH_BYTE_ORDER_H
#define FL_MESH_BYTE_ORDER_H
#include <stdint.h>
#include <stdio.h>
#include "geom/vec3.h"

/* Write the low n bytes of u, 1 <= n <= 8. */
void fl_put_uint_le(FILE *f, uint64_t u, int n);

/* Write a double, and the three of a vector. */
void fl_put_f64_le(FILE *f, double x);
void fl_put_vec3_le(FILE *f, fl_vec3 x);

#endif
