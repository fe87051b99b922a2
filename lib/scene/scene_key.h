/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_key.h -- the table of the scene's sections and keys, from which reading, defaults, --set,
 * --explain, the echo, ranges and complaints are all made, and the words of the manual that map to them. */
#ifndef FL_SCENE_SCENE_KEY_H
#define FL_SCENE_SCENE_KEY_H
#include <stddef.h>
#include "scene/scene.h"
#include "scene/scene_unit.h"

/* In the order of fl_section_table. */
enum fl_section_id {
    FL_SEC_RUN,
    FL_SEC_OUTPUT,
    FL_SEC_MATERIAL,
    FL_SEC_CONTACT,
    FL_SEC_ICE,
    FL_SEC_STRUCTURE,
    FL_SEC_BOUNDARY,
    FL_SEC_WATER,
    FL_SEC_WIND,
    FL_SEC_BOND,
    FL_SEC_GROUP,
    FL_SEC_PART,
    FL_SECTIONS
};

enum fl_value_type {
    FL_VALUE_F64,   /* double */
    FL_VALUE_VEC3,  /* fl_vec3 */
    FL_VALUE_I32,   /* int32_t */
    FL_VALUE_WORD,  /* int32_t, index into the choices */
    FL_VALUE_WORDS, /* int32_t[3], one word for all of x, y, z or one for each */
    FL_VALUE_FIXED, /* uint32_t, FL_FIX_X | ... */
    FL_VALUE_NAME,  /* char[FL_SCENE_NAME] */
    FL_VALUE_PATH   /* char[FL_SCENE_PATH] */
};

/* What one number stands for in a vector of three. */
enum fl_single_number { FL_SINGLE_NOT, FL_SINGLE_X, FL_SINGLE_DOWN, FL_SINGLE_ALL };

typedef struct {
    enum fl_section_id section;
    const char *key;
    enum fl_value_type type;
    enum fl_unit_kind unit;
    size_t at;            /* offset of the value in the struct of its section */
    const char *fallback; /* the default, as one would write it */
    const char *steel;    /* the default in [material steel]; NULL: the same */
    const char *special;  /* a word that stands for `value`: auto, none; NULL: none */
    double value;
    const char *range;   /* interval, "(0,1]", of a number; NULL: any */
    const char *choices; /* "patch|manual", for a number its values */
    enum fl_single_number lone;
    const char *meaning, *source; /* source: NULL for a choice that is the user's */
} fl_key;

typedef struct {
    const char *name, *form; /* form: "[material NAME]" */
    int names;               /* how many names follow: 0, 1, or 2, which may be left out */
    size_t at;               /* the section in fl_scene, or the pointer to the array of them */
    size_t size;             /* of one section */
    const char *meaning;     /* and what it means when it is absent */
} fl_section;

extern const fl_key fl_key_table[];
extern const int fl_key_count;
extern const fl_section fl_section_table[FL_SECTIONS];

/* The words that stand bare, before any section, in files of the DilatedDEM manual. */
enum fl_word_map {
    FL_MAP_SAME, /* value as of the key */
    FL_MAP_X,    /* component of the vector */
    FL_MAP_Y,
    FL_MAP_Z,
    FL_MAP_BEAUFORT, /* U10 = 0.836 B^(3/2) m/s along x */
    FL_MAP_BOUND     /* 1 rigid, 2 elastic, 3 periodic, 4 free */
};
typedef struct {
    const char *word;
    enum fl_section_id section;
    const char *name; /* of the section; NULL */
    const char *key;
    enum fl_word_map map;
} fl_manual_word;
extern const fl_manual_word fl_manual_table[];
extern const int fl_manual_count;

/* First key of a section in the table; fl_key_first(FL_SECTIONS) is the end. */
int fl_key_first(int section);

/* Number of the section, and number of the key in the table; -1 when there is none. */
int fl_section_find(const char *name);
int fl_key_find(int section, const char *key);

#endif
