/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ice_scene.h -- which scene of ice-scenes(7) a run is: what bounds its load, and whether it jams.
 *
 * Everything here is a function of the scene, the inputs and the state at the time of the call, so a run that
 * was stopped and resumed has the same lines. */
#ifndef DEM_SOLVE_ICE_SCENE_H
#define DEM_SOLVE_ICE_SCENE_H
#include "run_context.h"

enum ice_scene_kind {
    SCENE_OTHER, /* no water, no structure, or at rest */
    SCENE_ONE_FLOE,
    SCENE_FIELD_ONCE,
    SCENE_DRIFT,  /* with inflow */
    SCENE_DRIVEN, /* floes that are moved */
    SCENE_SHEET,  /* bonded */
    SCENE_TOWED,  /* a structure that moves through ice */
    SCENE_BRASH   /* ... through a channel of brash between walls */
};

struct ice_scene {
    enum ice_scene_kind kind;
    double speed;           /* of the ice against the structure [m/s] */
    double concentration;   /* of the field */
    double ice_area;        /* [m2] */
    double mass_per_area;   /* of ice, over the area of the sea [kg/m2] */
    double thickness;       /* mean of the floes [m] */
    double layer;           /* from the lowest to the highest point of the ice [m] */
    double floe_size;       /* root of the mean area [m] */
    double field_width;     /* across the drift [m]; infinite where the sides are free */
    double structure_width; /* across the drift at the water line, narrow gaps closed [m] */
    int32_t obstacles;      /* what is left of its parts, seen along the drift */
};

/* Thickness of a dilated body: smallest extent along the normals of its faces; 2 radius without faces [m]. */
double body_thickness(const fl_poly *p, double radius);

/* At the start of a run.  -1 with FL_SYSTEM in err. */
int ice_scene_make(struct ice_scene *s, const struct run *r, fl_err *err);

/* The line of the loads that says which scene it is; nothing for SCENE_OTHER. */
void ice_scene_report(const struct ice_scene *s, const struct run *r, FILE *f);

/* Warnings before the run, where the field is too narrow, and after it, where a jam has met the inflow. */
void ice_scene_warn_width(const struct ice_scene *s, FILE *f);
void ice_scene_warn_inflow(const struct run *r, FILE *f);

#endif
