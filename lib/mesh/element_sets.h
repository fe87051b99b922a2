/* SPDX-License-Identifier: GPL-3.0-or-later */
/* element_sets.h -- sets of elements and surfaces by name, made of numbers, of ranges, and of other sets; looked up
 * when all is read, so that it does not matter what came first.
 *
 * Names belong to a room: the deck itself, a part, an instance of one.  Letters of either case are equal. */
#ifndef FL_MESH_ELEMENT_SETS_H
#define FL_MESH_ELEMENT_SETS_H
#include "mesh/elements.h"

enum { FL_SET_NAME_MAX = 256 }; /* bytes of a name that count, with the closing nul */
enum fl_set_kind { FL_SET_ELEMENTS = 'E', FL_SET_SURFACE = 'S' };

/* Where numbers and names are looked for.  Place 0 is the deck itself, in room 0. */
typedef struct {
    int32_t name;       /* of words; -1 for the deck */
    int32_t scope;      /* its own room, and the scope of its nodes and elements */
    int32_t part_scope; /* room of the part that it is an instance of, -1 for none */
    int32_t part_first,
        mesh_first; /* elements of that part as places in its store: a run is moved by to - from */
} fl_instance;

typedef struct {
    int64_t first, last, step; /* numbers of elements, or with step 0 their places in the store */
    int32_t set;               /* of words: all of that set; -1 for the numbers */
    int32_t instance;          /* of places; -1 for where the set itself is looked at */
    int32_t file, line, next;  /* where it stood; next entry of the set, -1 at the end */
    int8_t kind;               /* of the set that it names */
    int8_t face, reversed;     /* as in fl_pick */
    int8_t implied;            /* by the line that defines the elements, not by one about sets */
} fl_set_entry;

typedef struct {
    int64_t stamp;          /* of its last walk */
    int32_t stamp_instance; /* and where that was */
    int32_t name, scope, head, tail;
    int8_t kind, visiting;
    int8_t is_explicit; /* it has something beyond what is implied */
} fl_element_set;

typedef struct {
    fl_string_table key, words;
    fl_element_set *set;   /* [key.n] */
    fl_set_entry *entry;   /* [entries] */
    fl_instance *instance; /* [places] */
    int32_t entries, instances;
    int64_t stamp, surface_stamp; /* what asks for a face, and what asked for the whole */
    int32_t set_cap, entry_cap, instance_cap;
} fl_element_sets;

/* The set of that name in a room, which is added when new; -1 with FL_SYSTEM. */
int32_t fl_element_sets_get(fl_element_sets *r, enum fl_set_kind kind, int32_t room, const char *name,
                            fl_err *err);

/* Add an entry to a set; one run that goes on where the last one ended is joined to it.  -1 with FL_SYSTEM.
 */
int fl_element_sets_add_entry(fl_element_sets *r, int32_t set, fl_set_entry entry, fl_err *err);

/* Add a place.  Its index, or -1 with FL_SYSTEM. */
int32_t fl_element_sets_add_instance(fl_element_sets *r, fl_instance place, fl_err *err);

/* The place called so, -1 when there is none. */
int32_t fl_element_sets_find_instance(const fl_element_sets *r, const char *name);

/* Call each() for the elements of a set as seen from a place: of ranges those that are there.  An element may
 * come several times.  0, or -1 with FL_INPUT (a set that is named and nowhere defined, or that contains
 * itself, or sets named by sets 1000 deep), or what each() said. */
typedef int fl_element_visitor(void *context, fl_pick pick, fl_err *err);
int fl_element_sets_visit(fl_element_sets *r, const fl_elements *e, int32_t set, int32_t place,
                          fl_element_visitor *each, void *context, fl_err *err);

/* The set that a name means at a place: the place's own, that of its part, or as "place.set" from the deck.
 * -1 when there is none; then *place is as it was, else the place where the set is to be looked at. */
int32_t fl_element_sets_find(const fl_element_sets *r, enum fl_set_kind kind, int32_t *place,
                             const char *name);

/* Add all sets to e, as seen from all places: "place.set" for those of instances; their elements only where
 * the wish chooses them.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_element_sets_export(fl_element_sets *r, fl_elements *e, fl_import_options *opt, fl_err *err);

void fl_element_sets_free(fl_element_sets *r); /* accepts a zeroed struct, leaves one */

#endif
