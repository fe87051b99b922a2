/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_key.h -- the tables of sections and keys of a scene, and of the bare words of the DilatedDEM manual.
 *
 * Reading, defaults, --set, --explain, printing, ranges and error messages use these tables.  A new key is
 * a member in scene_types.h and a row of fl_key_table. */
#ifndef FL_SCENE_SCENE_KEY_H
#define FL_SCENE_SCENE_KEY_H
#include <stddef.h>
#include "scene/scene_types.h"
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
    FL_SEC_FAILURE,
    FL_SEC_GROUP,
    FL_SEC_PART,
    FL_SEC_MODE,
    FL_SEC_JOINT,
    FL_SEC_STAGE,
    FL_SEC_ZONES,
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

/* Meaning of a single number given for a vector of three: not allowed, along x, along -z, all components. */
enum fl_single_number { FL_SINGLE_NOT, FL_SINGLE_X, FL_SINGLE_DOWN, FL_SINGLE_ALL };

typedef struct {
    enum fl_section_id section;
    const char *key;
    const char *old_name; /* former name of the key, still read; NULL: none */
    enum fl_value_type type;
    enum fl_unit_kind unit;
    size_t offset;             /* of the value in the struct of its section */
    const char *default_text;  /* as a user would write it */
    const char *default_steel; /* default in [material steel]; NULL: default_text */
    const char *special;       /* word that stands for special_value: auto, none; NULL: none */
    double special_value;
    const char *range;      /* interval of a number, "(0,1]"; NULL: any */
    const char *choices;    /* "patch|manual"; of a number its values */
    const char *one_number; /* why it is one number where users may give two; NULL */
    enum fl_single_number single;
    const char *needs[3];         /* keys of the section, one of which must be given too (unused_keys.h) */
    const char *meaning, *source; /* source: NULL for a free choice of the user */
} fl_key;

typedef struct {
    const char *name, *form; /* form: "[material NAME]" */
    int names;               /* number of names in the heading: 0, 1, or 2, which may be omitted */
    size_t offset;           /* of the section in fl_scene, or of the pointer to the array of them */
    size_t size;             /* of one section */
    const char *meaning;     /* and what the absence of the section means */
} fl_section;

extern const fl_key fl_key_table[];
extern const int fl_key_count;
extern const fl_section fl_section_table[FL_SECTIONS];

/* Bare words before any section, in files of the DilatedDEM manual. */
enum fl_word_map {
    FL_MAP_SAME, /* value as of the key */
    FL_MAP_X,    /* component of the vector */
    FL_MAP_Y,
    FL_MAP_Z,
    FL_MAP_BEAUFORT, /* U10 = 0.836 B^(3/2) m/s along x */
    FL_MAP_FRAMES, /* as FL_MAP_SAME; and frames are written, to ANIMATION_3D.DAT unless a key names a file */
    FL_MAP_BOUND   /* 1 rigid, 2 elastic, 3 periodic, 4 free */
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

/* Index of the first key of a section in the table; fl_key_first(FL_SECTIONS) is the end. */
int fl_key_first(int section);

/* Index of a section, and of a key by its name or its old name; -1 if there is none. */
int fl_section_find(const char *name);
int fl_key_find(int section, const char *key);

#endif
