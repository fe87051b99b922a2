/* SPDX-License-Identifier: GPL-3.0-or-later */
/* water_force.h -- one force of water or wind: what set-up, plan and energy balance need to know of it.
 *
 * The table of all of them is force_table.h.  The forces of still water, waves, current, added mass, drag and
 * wind are evaluated together and for several bodies at a time (environment.h, still_water_batch.h): the step
 * calls them directly, and their rows have no `impulse`.  Any other force is one file with an `impulse`, and
 * its row. */
#ifndef FL_WATER_WATER_FORCE_H
#define FL_WATER_WATER_FORCE_H
#include <stddef.h>
#include "body/body.h"
#include "scene/scene.h"

typedef struct fl_environment fl_environment;

/* Columns of the energy balance that forces of water and wind add to. */
enum fl_force_ledger {
    FL_FORCE_NO_LEDGER,
    FL_FORCE_HYDROSTATIC,
    FL_FORCE_DRAG,
    FL_FORCE_WIND,
    FL_FORCE_WAVES
};
enum { FL_FORCE_LEDGERS = FL_FORCE_WAVES + 1, FL_FORCE_TEXT = 160 };

typedef struct {
    const char *name; /* in the plan */

    /* Reads its parameters from the scene into s, and allocates arrays that do not depend on the hulls.
     * s->water and s->wind are set before.  Returns 0, or -1 with FL_INPUT or FL_SYSTEM.  NULL: no
     * parameters. */
    int (*set_up)(fl_environment *s, fl_bodies *b, const fl_scene *scene, fl_err *err);

    /* True if the force acts in this run, after set_up(). */
    int (*present)(const fl_environment *s, const fl_bodies *b);

    /* Describes the force for the plan, with the bodies at their start.  Called if present; NULL: no text. */
    void (*describe)(const fl_environment *s, char text[FL_FORCE_TEXT]);

    /* Energy of body i in column `ledger` [J]: stored now (hydrostatic), or exchanged since the start (the
     * other columns).  Called if present; stores of bodies outside the domain do not count.  NULL: none. */
    enum fl_force_ledger ledger;
    double (*energy)(const fl_environment *s, const fl_bodies *b, int32_t i);

    /* Changes v, L and w of body i by the force over h seconds at constant position, for example v += h F/m.
     * Called if present, with the drag, in both halves of a step.  The caller applies the constraints of the
     * body and adds the work to drag_loss.  NULL: the step calls the force directly. */
    void (*impulse)(const fl_environment *s, fl_bodies *b, int32_t i, double h);
} fl_water_force;

#endif
