/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bits.h -- one number for every bit of a world: state, books and loads. */
#ifndef FL_TESTS_BITS_H
#define FL_TESTS_BITS_H
#include "world/world.h"

uint64_t bits_of(fl_world *w);

/* Of some scenes with something of everything after some steps: as hexadecimal numbers, one a
 * line, into text. */
enum { BITS_TEXT = 200 };
void bits_of_scenes(char text[BITS_TEXT]);

#endif
