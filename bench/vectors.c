/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vectors.c -- replaces __cpu_model: a program linked with this file uses the functions of base/simd.h for the
 * vector instructions that WIDTH names, 0 none, 1 << 10 AVX2. */
struct processor {
    unsigned vendor, type, subtype, features[1];
};
extern struct processor __cpu_model;
struct processor __cpu_model = {1, 0, 0, {WIDTH}}; /* vendor 1: already initialised */
extern unsigned __cpu_features2[4];
unsigned __cpu_features2[4];
int __cpu_indicator_init(void);
int __cpu_indicator_init(void) { return 0; }
