/* SPDX-License-Identifier: GPL-3.0-or-later */
/* element_sets.h -- named sets of elements and surfaces, made of numbers, ranges and other sets.  Names are
 * resolved at the end of the deck, so the order of definitions does not matter.
 *
 * Names belong to a scope: the deck itself, a part, or an instance of a part.  Case does not matter. */
#ifndef FL_MESH_ELEMENT_SETS_H
#define FL_MESH_ELEMENT_SETS_H
#include "mesh/elements.h"

enum { FL_SET_NAME_MAX = 256 }; /* significant bytes of a name, with the closing nul */
enum fl_set_kind { FL_SET_ELEMENTS = 'E', FL_SET_SURFACE = 'S' };

/* An instance of a part, in which numbers and names are looked up.  Instance 0 is the deck itself, in scope
 * 0. */
typedef struct {
    int32_t name;       /* index in words; -1 for the deck */
    int32_t scope;      /* scope of its own names, nodes and elements */
    int32_t part_scope; /* scope of its part, -1 for none */
    int32_t part_first,
        mesh_first; /* first element of the part in the part store, and of the instance in the mesh */
} fl_instance;

typedef struct {
    int64_t first, last, step; /* element numbers; with step 0, indices in the store */
    int32_t set;               /* index in words: all of that set; -1 for numbers */
    int32_t instance;          /* index of an instance; -1 for the one in which the set is evaluated */
    int32_t file, line, next;  /* position in the deck; next entry of the set, -1 at the end */
    int8_t kind;               /* of the named set */
    int8_t face, reversed;     /* as in fl_pick */
    int8_t implied;            /* added by the line that defines the element, not by a line about sets */
} fl_set_entry;

typedef struct {
    int64_t stamp;          /* of its last visit */
    int32_t stamp_instance; /* instance of that visit */
    int32_t name, scope, head, tail;
    int8_t kind, visiting;
    int8_t is_explicit; /* it has an entry that is not implied */
} fl_element_set;

typedef struct {
    fl_string_table key, words;
    fl_element_set *set;   /* [key.n] */
    fl_set_entry *entry;   /* [entries] */
    fl_instance *instance; /* [instances] */
    int32_t entries, instances;
    int64_t stamp, surface_stamp; /* of the current entry of a surface, and of the whole visit */
    int32_t set_cap, entry_cap, instance_cap;
} fl_element_sets;

/* The set of that name in a scope, which is added if new; -1 with FL_SYSTEM. */
int32_t fl_element_sets_get(fl_element_sets *r, enum fl_set_kind kind, int32_t room, const char *name,
                            fl_err *err);

/* Add an entry to a set; a range of indices that continues the last one is merged with it.  -1 with
 * FL_SYSTEM. */
int fl_element_sets_add_entry(fl_element_sets *r, int32_t set, fl_set_entry entry, fl_err *err);

/* Add an instance.  Returns its index, or -1 with FL_SYSTEM. */
int32_t fl_element_sets_add_instance(fl_element_sets *r, fl_instance place, fl_err *err);

/* Index of the instance of that name, -1 if there is none. */
int32_t fl_element_sets_find_instance(const fl_element_sets *r, const char *name);

/* Call each() for the elements of a set, evaluated in an instance.  Numbers of a range without an element are
 * skipped; an element may be visited several times.  0, or -1 with FL_INPUT (a set that is undefined or
 * contains itself, or sets nested 1000 deep), or the -1 of each(). */
typedef int fl_element_visitor(void *context, fl_pick pick, fl_err *err);
int fl_element_sets_visit(fl_element_sets *r, const fl_elements *e, int32_t set, int32_t place,
                          fl_element_visitor *each, void *context, fl_err *err);

/* Resolve the name of a set in an instance: a set of the instance, of its part, or "instance.set" from the
 * deck.  Returns its index and sets *place to the instance in which to evaluate it; -1 with *place unchanged
 * if there is none. */
int32_t fl_element_sets_find(const fl_element_sets *r, enum fl_set_kind kind, int32_t *place,
                             const char *name);

/* Add all sets to e, evaluated in all instances; a set of an instance is called "instance.set".  Elements are
 * added only to sets that the options select by name.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_element_sets_export(fl_element_sets *r, fl_elements *e, fl_import_options *opt, fl_err *err);

void fl_element_sets_free(fl_element_sets *r); /* accepts a zeroed struct, leaves one */

#endif
