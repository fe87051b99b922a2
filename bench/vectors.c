/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vectors.c -- what __cpu_model tells of the machine, defined anew: a program linked with this takes the
 * functions of base/simd.h for the vectors that WIDTH names, 0 none, 1 << 10 those of AVX2. */
struct processor {
    unsigned vendor, type, subtype, features[1];
};
extern struct processor __cpu_model;
struct processor __cpu_model = {1, 0, 0, {WIDTH}}; /* known, so that nobody asks the machine */
extern unsigned __cpu_features2[4];
unsigned __cpu_features2[4];
int __cpu_indicator_init(void);
int __cpu_indicator_init(void) { return 0; }
