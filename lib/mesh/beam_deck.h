/* SPDX-License-Identifier: GPL-3.0-or-later */
/* beam_deck.h -- decks of members (SESAM, SACS, USFOS, OpenFAST): nodes, members with a section at either
 * end, plates and solids, and sets of them.  Readers of such decks fill it; it becomes a surface or a frame.
 *
 *   surface   a round member is the solid cone of the outer radii of its ends, a rectangular one a prism of
 *             the two outlines; other sections have no outline and are counted
 *   frame     members with their walls and materials (frame_model.h).  A taper becomes FL_BEAM_STEPS
 *             cylinders of the diameters and walls at their middles, an error of second order in their
 *             length. Members shorter than FL_BEAM_SHORT of their diameter make their nodes one. Nodes on
 *             rigid links are one too, the first that has a mass, else a support, else the first; members at
 *             the others have an offset from it
 * A member or plate belongs to the smallest of the sets that hold it; else to the part its reader gives; else
 * to one of its size: "D_1.2", "10x5", "cones" for a taper, "plates", "solids". */
#ifndef FL_MESH_BEAM_DECK_H
#define FL_MESH_BEAM_DECK_H
#include "mesh/deck_lines.h"
#include "mesh/elements.h"
#include "mesh/frame_model.h"
#include "mesh/import_options.h"

enum { FL_BEAM_STEPS = 4, FL_BEAM_NAME = 64 };
#define FL_BEAM_SHORT 0.01 /* of the diameter: a member of a frame shorter than that joins its nodes */

/* A cross-section; lengths and moduli in the unit of the deck. */
typedef struct {
    int form;                   /* enum fl_frame_form; of FL_FRAME_GENERAL and NONE no outline is known */
    double size[2];             /* pipe: outer diameter; rectangle: along y, along z */
    double wall[2];             /* pipe: thickness; rectangle: of the sides across y, across z; 0: solid */
    double a, iy, iz, j;        /* FL_FRAME_GENERAL */
    fl_frame_material material; /* zeros: not given */
    char name[FL_BEAM_NAME];    /* of the section of a frame; unique in the deck */
    char kind[FL_BEAM_NAME];    /* under which members without an outline are counted */
    char part[FL_BEAM_NAME];    /* that members belong to; "": none */
} fl_beam_section;

typedef struct {
    int64_t id;
    int64_t node[3];    /* ends and, for a curved one, the middle; 0: none.  Numbers in scope 0 */
    int32_t scope[2];   /* of the ends: 0, or 1 for nodes that the reader makes */
    int32_t section[2]; /* at the ends: index in section */
    int32_t part;       /* index in e.parts, -1 for that of its section, set or size */
    fl_vec3 offset[2];  /* from node to end */
    fl_vec3 across;     /* in the plane of x and z of the member, 0 0 0: not given */
    unsigned pins[2];   /* as in fl_frame_element */
    int truss;
    int32_t piece; /* 0, or 1 and up: part of a member of several pieces, for its name */
    int32_t file, line;
} fl_beam;

typedef struct {
    fl_elements e; /* nodes, plates and solids; its file and line follow the current line */
    fl_deck d;
    fl_bytes *b;           /* borrowed */
    fl_frame_model *frame; /* borrowed; NULL: a surface is made */
    fl_import_options *opt;
    fl_beam *beam;
    fl_beam_section *section;
    fl_string_table set_name;
    struct fl_beam_set_entry {
        int32_t set;
        int64_t element;
    } * entry;
    int8_t *set_is_part; /* [set_name.n] 0: a set to ask for only */
    int32_t *same;       /* [e.node_id.n] of a frame: the node that stands for this one */
    int32_t *hub;        /* [e.node_id.n] of a frame: the node that a rigid link carries this one with */
    int64_t (*link)[2];  /* nodes of rigid links, numbers in scope 0 */
    int32_t *set_size;   /* [set_name.n] its elements, once they are sorted */
    int32_t beams, beam_cap, sections, section_cap, entries, entry_cap, set_cap, links, link_cap;
    int32_t tapers, prisms, made_nodes, offsets;
} fl_beam_deck;

/* Starts a deck on the bytes of a file.  -1 with FL_SYSTEM. */
int fl_beam_deck_start(fl_beam_deck *k, fl_bytes *b, fl_import_options *opt, fl_err *err);

/* Adds a section, a member at the current line, a node of the reader's own (scope 1).  Return the index (of
 * the node: its number), or -1 with FL_INPUT or FL_SYSTEM. */
int32_t fl_beam_deck_section(fl_beam_deck *k, const fl_beam_section *s, fl_err *err);
int32_t fl_beam_deck_add(fl_beam_deck *k, const fl_beam *b, fl_err *err);
int64_t fl_beam_deck_node(fl_beam_deck *k, fl_vec3 x, fl_err *err);

/* The set of that name, added if new; is_part: members may belong to it without being asked for.  -1 with
 * FL_SYSTEM. */
int32_t fl_beam_deck_set(fl_beam_deck *k, const char *name, int is_part, fl_err *err);
int fl_beam_deck_set_add(fl_beam_deck *k, int32_t set, int64_t element, fl_err *err);

/* Support, mass: kept for a frame only.  -1 with FL_SYSTEM. */
int fl_beam_deck_hold(fl_beam_deck *k, int64_t node, int fixed, fl_err *err);
int fl_beam_deck_mass(fl_beam_deck *k, int64_t node, double mass, fl_err *err);

/* A massless rigid link: of a frame its nodes move as one; of a surface it is counted.  -1 with FL_SYSTEM. */
int fl_beam_deck_link(fl_beam_deck *k, int64_t a, int64_t b, fl_err *err);

/* Counts what is not carried over, by kind.  -1 with FL_SYSTEM. */
int fl_beam_deck_skip(fl_beam_deck *k, const char *kind, fl_err *err);

/* Makes the surface, or fills the frame.  -1 with FL_INPUT (a member with an unknown node, without a length
 * or with a diameter that is not above 0: the line of the member) or FL_SYSTEM. */
int fl_beam_deck_finish(fl_beam_deck *k, fl_surface *s, fl_err *err);
void fl_beam_deck_free(fl_beam_deck *k); /* accepts a zeroed struct, leaves one */

#endif
