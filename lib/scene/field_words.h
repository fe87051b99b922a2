/* SPDX-License-Identifier: GPL-3.0-or-later */
/* field_words.h -- words of the field that are no names of keys, and where their values are given. */
#ifndef FL_SCENE_FIELD_WORDS_H
#define FL_SCENE_FIELD_WORDS_H

typedef struct {
    const char *word; /* in small letters, with blanks between words */
    const char *says; /* keys and options for it */
} fl_field_word;

/* All words, by number from 0; NULL beyond the last one. */
const fl_field_word *fl_field_word_at(int k);

/* The row of a word, where capitals, '_' and '-' for blanks, and an s at the end do not matter; NULL if there
 * is none.
 */
const fl_field_word *fl_field_word_find(const char *word);

#endif
