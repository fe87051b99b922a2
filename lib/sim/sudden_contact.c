/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/sudden_contact.h"
#include <stdio.h>
#include "world/access.h"

static const char *cause_of(const fl_piece *piece)
{
    if (!piece || piece->kind != FL_PIECE_MESH)
        return "one of the two was not near the other before: look at their motion with output.frames";
    if (!piece->mesh.closed)
        return "the surface of the part is open, and the body may have come from its back or round its rim: "
               "close it, "
               "or give it a thickness";
    return "the surface of the part may cross itself or have normals that face different ways: struct-import "
           "reports both";
}

const char *fl_sudden_contact_text(const fl_world *w, char text[FL_SUDDEN_TEXT])
{
    const fl_sudden_contacts *s = &w->sudden;
    snprintf(text, FL_SUDDEN_TEXT,
             "body %d and %d touch at t = %g s with an overlap of %.3g m, and moved by no more than %.3g m "
             "in that step; "
             "%s",
             fl_world_id(w, s->i), fl_world_id(w, s->j), s->time, s->overlap, s->moved,
             cause_of(fl_world_piece(w, s->j)));
    return text;
}
