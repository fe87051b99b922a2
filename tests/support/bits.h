/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bits.h -- one hash of all bits of a world: state, ledger and loads. */
#ifndef FL_TESTS_BITS_H
#define FL_TESTS_BITS_H
#include "world/world.h"

uint64_t bits_of(fl_world *w);

/* Hashes of some scenes of all kinds after some steps, as hexadecimal numbers, one a line, into text. */
enum { BITS_TEXT = 200 };
void bits_of_scenes(char text[BITS_TEXT]);

#endif
