/* SPDX-License-Identifier: GPL-3.0-or-later */
/* panel.h -- the controls of the window: buttons and a bar of time; one call each draws it and returns its
 * state. */
#ifndef ICE_VIEW_PANEL_H
#define ICE_VIEW_PANEL_H
#include "view/picture_rgba.h"

struct panel {
    fl_picture *p;
    int x, y;            /* of the mouse */
    int pressed, held;   /* its left button: went down since the last picture; is down */
    int taken;           /* the button is the panel's until it comes up */
    float at_x, at_y, k; /* where the next button stands; scale */
};

/* Height of the panel at the lower edge of a picture. */
int panel_height(const fl_picture *p);

/* Begins the panel, `bottom` pixels above the lower edge. */
void panel_begin(struct panel *u, int bottom);

/* A button behind the last one; 1 when it is clicked. */
int panel_button(struct panel *u, const char *label, int lit);

/* The bar of time over the rest of the row; 1 while it is dragged, *part: share of its length. */
int panel_bar(struct panel *u, double *part, const char *label);

#endif
