/* SPDX-License-Identifier: GPL-3.0-or-later */
/* roster.h -- sets of elements and surfaces by name, made of numbers, of ranges, and of other sets; looked up
 * when all is read, so that it does not matter what came first.
 *
 * Names belong to a room: the deck itself, a part, an instance of one.  Letters of either case are equal. */
#ifndef FL_MESH_ROSTER_H
#define FL_MESH_ROSTER_H
#include "mesh/elements.h"

enum { FL_ROSTER_NAME = 256 }; /* bytes of a name that count, with the closing nul */
enum fl_roster_kind { FL_ROSTER_SET = 'E', FL_ROSTER_SURFACE = 'S' };

/* Where numbers and names are looked for.  Place 0 is the deck itself, in room 0. */
typedef struct {
    int32_t name;     /* of words; -1 for the deck */
    int32_t room;     /* its own room, and the scope of its nodes and elements */
    int32_t part;     /* room of the part that it is an instance of, -1 for none */
    int32_t from, to; /* elements of that part as places in its store: a run is moved by to - from */
} fl_place;

typedef struct {
    int64_t first, last, step; /* numbers of elements, or with step 0 their places in the store */
    int32_t set;               /* of words: all of that set; -1 for the numbers */
    int32_t place;             /* of places; -1 for where the set itself is looked at */
    int32_t file, line, next;  /* where it stood; next entry of the set, -1 at the end */
    int8_t kind;               /* of the set that it names */
    int8_t face, behind;       /* as in fl_pick */
    int8_t implied;            /* by the line that defines the elements, not by one about sets */
} fl_entry;

typedef struct {
    int64_t stamp;       /* of its last walk */
    int32_t stamp_place; /* and where that was */
    int32_t shown, room, head, tail;
    int8_t kind, open;
    int8_t own; /* it has something beyond what is implied */
} fl_roster_set;

typedef struct {
    fl_names key, words;
    fl_roster_set *set; /* [key.n] */
    fl_entry *entry;    /* [entries] */
    fl_place *place;    /* [places] */
    int32_t entries, places;
    int64_t stamp, walk; /* what asks for a face, and what asked for the whole */
    int32_t set_cap, entry_cap, place_cap;
} fl_roster;

/* The set of that name in a room, which is added when new; -1 with FL_SYSTEM. */
int32_t fl_roster_set_of(fl_roster *r, enum fl_roster_kind kind, int32_t room, const char *name, fl_err *err);

/* Add an entry to a set; one run that goes on where the last one ended is joined to it.  -1 with FL_SYSTEM.
 */
int fl_roster_add(fl_roster *r, int32_t set, fl_entry entry, fl_err *err);

/* Add a place.  Its index, or -1 with FL_SYSTEM. */
int32_t fl_roster_place(fl_roster *r, fl_place place, fl_err *err);

/* The place called so, -1 when there is none. */
int32_t fl_roster_find_place(const fl_roster *r, const char *name);

/* Call each() for the elements of a set as seen from a place: of ranges those that are there.  An element may
 * come several times.  0, or -1 with FL_INPUT (a set that is named and nowhere defined, or that contains
 * itself, or sets named by sets 1000 deep), or what each() said. */
typedef int fl_roster_each(void *context, fl_pick pick, fl_err *err);
int fl_roster_walk(fl_roster *r, const fl_elements *e, int32_t set, int32_t place, fl_roster_each *each,
                   void *context, fl_err *err);

/* The set that a name means at a place: the place's own, that of its part, or as "place.set" from the deck.
 * -1 when there is none; then *place is as it was, else the place where the set is to be looked at. */
int32_t fl_roster_find(const fl_roster *r, enum fl_roster_kind kind, int32_t *place, const char *name);

/* Add all sets to e, as seen from all places: "place.set" for those of instances; their elements only where
 * the wish chooses them.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_roster_tell(fl_roster *r, fl_elements *e, fl_wish *w, fl_err *err);

void fl_roster_free(fl_roster *r); /* accepts a zeroed struct, leaves one */

#endif
