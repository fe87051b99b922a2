/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "scene/scene_key.h"

const fl_section fl_section_table[FL_SECTIONS] = {
    {"run", "[run]", 0, offsetof(fl_scene, run), sizeof(fl_scene_run), "how long and in what steps"},
    {"output", "[output]", 0, offsetof(fl_scene, output), sizeof(fl_scene_output),
     "what is written besides the loads, and how often"},
    {"material", "[material NAME]", 1, offsetof(fl_scene, material), sizeof(fl_scene_material),
     "what bodies and structure are made of; ice and steel are known without one"},
    {"contact", "[contact A B]", 2, offsetof(fl_scene, contact), sizeof(fl_scene_contact),
     "how two materials touch; A or B may be \"structure\" or \"boundary\"; without names, all pairs"},
    {"ice", "[ice]", 0, offsetof(fl_scene, ice), sizeof(fl_scene_ice), "the bodies; a scene needs them"},
    {"structure", "[structure]", 0, offsetof(fl_scene, structure), sizeof(fl_scene_structure),
     "what the ice loads; absent, there is none and the load table stays empty"},
    {"boundary", "[boundary]", 0, offsetof(fl_scene, boundary), sizeof(fl_scene_boundary),
     "the walls of the domain; absent, the ice is free to leave"},
    {"water", "[water]", 0, offsetof(fl_scene, water), sizeof(fl_scene_water),
     "buoyancy and drag of the sea; absent, the bodies are dry"},
    {"wind", "[wind]", 0, offsetof(fl_scene, wind), sizeof(fl_scene_wind),
     "drag of the air; absent, it is calm"},
    {"bond", "[bond]", 0, offsetof(fl_scene, bond), sizeof(fl_scene_bond),
     "frozen faces between neighbours; absent, nothing is frozen together"},
    {"group", "[group NAME]", 1, offsetof(fl_scene, group), sizeof(fl_scene_group),
     "bodies of the ice file with that group, held or driven"},
    {"part", "[part NAME]", 1, offsetof(fl_scene, part), sizeof(fl_scene_part),
     "a part of the structure that moves by its own; the others move as [structure] says"},
};

#define AT(section, member) offsetof(fl_scene_##section, member)

/* What [structure] and [part NAME] have in common: how a thing moves. */
#define MOTION_KEYS(SECTION, OWNER)                                                                          \
    {.section = SECTION,                                                                                     \
     .key = "reference",                                                                                     \
     .type = FL_VALUE_VEC3,                                                                                  \
     .unit = FL_UNIT_LENGTH,                                                                                 \
     .at = AT(OWNER, motion.reference),                                                                      \
     .fallback = "0 0 0 m",                                                                                  \
     .meaning =                                                                                              \
         "point that turns and moments are about, the centre of mass of what is free; it moves along"},      \
        {.section = SECTION,                                                                                 \
         .key = "velocity",                                                                                  \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_SPEED,                                                                              \
         .at = AT(OWNER, motion.velocity),                                                                   \
         .fallback = "0 0 0 m/s",                                                                            \
         .meaning = "constant velocity of the reference point"},                                             \
        {.section = SECTION,                                                                                 \
         .key = "spin",                                                                                      \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_SPIN,                                                                               \
         .at = AT(OWNER, motion.spin),                                                                       \
         .fallback = "0 0 0 rad/s",                                                                          \
         .meaning = "constant angular velocity about the reference point"},                                  \
        {.section = SECTION,                                                                                 \
         .key = "track",                                                                                     \
         .type = FL_VALUE_PATH,                                                                              \
         .at = AT(OWNER, motion.track),                                                                      \
         .fallback = "none",                                                                                 \
         .special = "none",                                                                                  \
         .meaning = "file of the displacement and turn of the reference point against time, in place of "    \
                    "velocity and spin",                                                                     \
         .source = "track(5)"},                                                                              \
        {.section = SECTION,                                                                                 \
         .key = "interpolation",                                                                             \
         .type = FL_VALUE_WORD,                                                                              \
         .at = AT(OWNER, motion.between),                                                                    \
         .fallback = "cubic",                                                                                \
         .choices = "cubic|linear",                                                                          \
         .meaning =                                                                                          \
             "between the rows of the track: cubic, with continuous velocity and acceleration, or linear",   \
         .source = "cubic spline, de Boor (1978), ch. 4"},                                                   \
        {.section = SECTION,                                                                                 \
         .key = "free",                                                                                      \
         .type = FL_VALUE_FIXED,                                                                             \
         .at = AT(OWNER, motion.free),                                                                       \
         .fallback = "none",                                                                                 \
         .special = "none",                                                                                  \
         .meaning = "directions x y z and turns rx ry rz, world axes, in which forces move it; weight and "  \
                    "buoyancy at rest are in balance"},                                                      \
        {.section = SECTION,                                                                                 \
         .key = "mass",                                                                                      \
         .type = FL_VALUE_F64,                                                                               \
         .unit = FL_UNIT_MASS,                                                                               \
         .at = AT(OWNER, motion.mass),                                                                       \
         .fallback = "none",                                                                                 \
         .special = "none",                                                                                  \
         .range = "(0,inf)",                                                                                 \
         .meaning = "mass, for free directions"},                                                            \
        {.section = SECTION,                                                                                 \
         .key = "inertia",                                                                                   \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_INERTIA,                                                                            \
         .at = AT(OWNER, motion.inertia),                                                                    \
         .fallback = "0 0 0 kg.m2",                                                                          \
         .meaning = "moments of inertia about axes through the reference point, for free turns"},            \
        {.section = SECTION,                                                                                 \
         .key = "stiffness",                                                                                 \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_MOORING,                                                                            \
         .at = AT(OWNER, motion.stiffness),                                                                  \
         .fallback = "0 0 0 N/m",                                                                            \
         .meaning = "springs that hold the free directions x y z to the given motion"},                      \
        {.section = SECTION,                                                                                 \
         .key = "turn_stiffness",                                                                            \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_TWIST,                                                                              \
         .at = AT(OWNER, motion.turn_stiffness),                                                             \
         .fallback = "0 0 0 N.m/rad",                                                                        \
         .meaning = "springs that hold the free turns rx ry rz"},                                            \
        {.section = SECTION,                                                                                 \
         .key = "coupling",                                                                                  \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_ONE,                                                                                \
         .at = AT(OWNER, motion.coupling),                                                                   \
         .fallback = "0 0 0",                                                                                \
         .meaning = "of the stiffness matrix C34 and C35 [N] between heave and roll, pitch, and C45 [N.m] "  \
                    "between those"},                                                                        \
        {.section = SECTION,                                                                                 \
         .key = "period",                                                                                    \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_TIME,                                                                               \
         .at = AT(OWNER, motion.period),                                                                     \
         .fallback = "0 0 0 s",                                                                              \
         .meaning = "natural periods without ice, in place of stiffness, k = m (2 pi/T)^2; 0 is no spring"}, \
        {.section = SECTION,                                                                                 \
         .key = "damping",                                                                                   \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_DAMPER,                                                                             \
         .at = AT(OWNER, motion.damping),                                                                    \
         .fallback = "0 0 0 N.s/m",                                                                          \
         .meaning = "dashpots along the free directions x y z, against the given motion"},                   \
        {.section = SECTION,                                                                                 \
         .key = "turn_damping",                                                                              \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_SWIRL,                                                                              \
         .at = AT(OWNER, motion.turn_damping),                                                               \
         .fallback = "0 0 0 N.m.s",                                                                          \
         .meaning = "dashpots of the free turns, about axes that turn with the structure"},                  \
        {.section = SECTION,                                                                                 \
         .key = "damping_ratio",                                                                             \
         .type = FL_VALUE_VEC3,                                                                              \
         .unit = FL_UNIT_ONE,                                                                                \
         .at = AT(OWNER, motion.damping_ratio),                                                              \
         .fallback = "0 0 0",                                                                                \
         .meaning = "of the critical damping, in place of damping, c = 2 D sqrt(k m)"},                      \
    {                                                                                                        \
        .section = SECTION, .key = "hydrostatic", .type = FL_VALUE_WORD,                                     \
        .at = AT(OWNER, motion.hydrostatic), .fallback = "none", .choices = "none|mesh",                     \
        .meaning = "mesh adds the stiffness in z, rx, ry that the sea gives to the closed mesh at rest",     \
        .source = "Faltinsen, Sea Loads (1990), ch. 3"                                                       \
    }

/* A field that is left out is 0: any range, no choices, no special word; .later marks what is not built. */
const fl_key fl_key_table[] = {
    {.section = FL_SEC_RUN,
     .key = "duration",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(run, duration),
     .fallback = "60 s",
     .range = "(0,inf)",
     .meaning = "simulated time",
     .source = "a demonstration's length: choose it for the case"},
    {.section = FL_SEC_RUN,
     .key = "dt",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(run, dt),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "time step; auto takes safety times the critical step of the stiffest contact, 2/omega_max",
     .source = "Gershgorin bound of the central difference scheme"},
    {.section = FL_SEC_RUN,
     .key = "safety",
     .type = FL_VALUE_F64,
     .at = AT(run, safety),
     .fallback = "0.1",
     .range = "(0,1]",
     .meaning = "automatic step over the critical one; 0.1 is a sixteenth of the shortest contact",
     .source = "energy error of 200 elastic box impacts against the step"},
    {.section = FL_SEC_RUN,
     .key = "error",
     .type = FL_VALUE_F64,
     .at = AT(run, error),
     .fallback = "none",
     .special = "none",
     .range = "(0,1)",
     .meaning =
         "error that the load on the structure may have by the time step, over its size: the step is the "
         "largest that keeps it, found by repeating short windows of the run with finer steps",
     .source = "Richardson, Phil. Trans. A 226 (1927) 299"},
    {.section = FL_SEC_RUN,
     .key = "error_of",
     .type = FL_VALUE_WORD,
     .at = AT(run, error_of),
     .fallback = "impulse",
     .choices = "impulse|peak|fx|fy|fz|mx|my|mz",
     .meaning =
         "what run.error is of: the impulse of all the run, the largest force of a step, or the impulse of "
         "one column of the loads; parts count by their sizes"},
    {.section = FL_SEC_RUN,
     .key = "gravity",
     .type = FL_VALUE_VEC3,
     .unit = FL_UNIT_ACCEL,
     .at = AT(run, gravity),
     .fallback = "9.81 m/s2",
     .lone = FL_LONE_DOWN,
     .meaning = "acceleration of gravity; one number acts along -z, three are a vector",
     .source = "the value of the verification cases"},
    {.section = FL_SEC_RUN,
     .key = "threads",
     .type = FL_VALUE_I32,
     .at = AT(run, threads),
     .fallback = "auto",
     .special = "auto",
     .range = "[1,1024]",
     .meaning = "number of threads; auto takes as many as OpenMP offers; the results are the same bytes for "
                "any number"},
    {.section = FL_SEC_RUN,
     .key = "sleep",
     .type = FL_VALUE_F64,
     .at = AT(run, sleep),
     .fallback = "none",
     .special = "none",
     .range = "(0,0.01]",
     .meaning =
         "floes to which nothing happens take many steps at once: those that touch nothing, with an "
         "error of each of at most this fraction of their radius, and those that lie still against each "
         "other; none sleeps by default",
     .source = "local error of the step"},
    {.section = FL_SEC_RUN,
     .key = "search_every",
     .type = FL_VALUE_I32,
     .at = AT(run, search_every),
     .fallback = "auto",
     .special = "auto",
     .range = "[1,1000000]",
     .meaning = "steps between two searches for neighbours; auto searches when the fastest body may have "
                "used up the skin"},
    {.section = FL_SEC_OUTPUT,
     .key = "loads_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, loads_every),
     .fallback = "0.02 s",
     .range = "(0,inf)",
     .meaning = "interval of the load table; each row is the impulse of its interval over its length",
     .source = "resolves structures up to 25 Hz"},
    {.section = FL_SEC_OUTPUT,
     .key = "frames_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, frames_every),
     .fallback = "1 s",
     .range = "(0,inf)",
     .meaning = "interval of the frames"},
    {.section = FL_SEC_OUTPUT,
     .key = "ice_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, ice_every),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "interval of the ice in the frames; auto is that of the frames"},
    {.section = FL_SEC_OUTPUT,
     .key = "until",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, until),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "time of the last frame; auto is the end of the run"},
    {.section = FL_SEC_OUTPUT,
     .key = "files",
     .type = FL_VALUE_I32,
     .at = AT(output, files),
     .fallback = "1",
     .range = "[1,1000000]",
     .meaning = "number of files over which the frames are split"},
    {.section = FL_SEC_OUTPUT,
     .key = "frames",
     .type = FL_VALUE_PATH,
     .at = AT(output, frames),
     .fallback = "none",
     .special = "none",
     .meaning = "file of the frames, in the format of ANIMATION_3D.DAT"},
    {.section = FL_SEC_OUTPUT,
     .key = "state",
     .type = FL_VALUE_PATH,
     .at = AT(output, state),
     .fallback = "none",
     .special = "none",
     .meaning = "file of positions, attitudes and velocities of all bodies"},
    {.section = FL_SEC_OUTPUT,
     .key = "energy",
     .type = FL_VALUE_PATH,
     .at = AT(output, energy),
     .fallback = "none",
     .special = "none",
     .meaning = "file of the energy balance, a column per store and sink, and its residual"},
    {.section = FL_SEC_OUTPUT,
     .key = "contacts",
     .type = FL_VALUE_PATH,
     .at = AT(output, contacts),
     .fallback = "none",
     .special = "none",
     .meaning = "file of the contacts, a row per contact with its mode, gap, point and force"},
    {.section = FL_SEC_OUTPUT,
     .key = "state_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, state_every),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "interval of the state table; auto is loads_every"},
    {.section = FL_SEC_OUTPUT,
     .key = "energy_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, energy_every),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "interval of the energy table; auto is loads_every"},
    {.section = FL_SEC_OUTPUT,
     .key = "contacts_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, contacts_every),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "interval of the contacts table; auto is loads_every"},
    {.section = FL_SEC_OUTPUT,
     .key = "panels",
     .type = FL_VALUE_PATH,
     .at = AT(output, panels),
     .fallback = "none",
     .special = "none",
     .meaning = "file of the load on each triangle of the structure, with the intervals of the load table",
     .source = "panels(5)"},
    {.section = FL_SEC_OUTPUT,
     .key = "events",
     .type = FL_VALUE_PATH,
     .at = AT(output, events),
     .fallback = "none",
     .special = "none",
     .meaning =
         "file of the floes that touch the structure, each with its mean over the interval of the load "
         "table: time, place, area, force",
     .source = "contacts(5)"},
    {.section = FL_SEC_OUTPUT,
     .key = "hash",
     .type = FL_VALUE_PATH,
     .at = AT(output, hash),
     .fallback = "none",
     .special = "none",
     .meaning = "file of the hash of the state: equal where two runs are equal to the last bit"},
    {.section = FL_SEC_OUTPUT,
     .key = "hash_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, hash_every),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "interval of the hash table; auto is loads_every"},
    {.section = FL_SEC_OUTPUT,
     .key = "checkpoint",
     .type = FL_VALUE_PATH,
     .at = AT(output, checkpoint),
     .fallback = "none",
     .special = "none",
     .meaning = "file from which dem-solve --resume goes on with the run"},
    {.section = FL_SEC_OUTPUT,
     .key = "checkpoint_every",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(output, checkpoint_every),
     .fallback = "10 s",
     .range = "(0,inf)",
     .meaning =
         "simulated time between two checkpoints; one more is written at the end, and when a signal asks"},
    {.section = FL_SEC_MATERIAL,
     .key = "density",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_DENSITY,
     .at = AT(material, density),
     .fallback = "900 kg/m3",
     .steel = "7850 kg/m3",
     .range = "(0,inf)",
     .meaning = "mass per volume",
     .source = "sea ice 850 to 920; steel: EN 1991-1-1, annex A"},
    {.section = FL_SEC_MATERIAL,
     .key = "young",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_STRESS,
     .at = AT(material, young),
     .fallback = "1 GPa",
     .steel = "210 GPa",
     .range = "(0,inf)",
     .meaning = "modulus of elasticity",
     .source = "effective modulus of Bohai ice, 0.5 to 5 GPa; steel: EN 1993-1-1, 3.2.6"},
    {.section = FL_SEC_MATERIAL,
     .key = "poisson",
     .type = FL_VALUE_F64,
     .at = AT(material, poisson),
     .fallback = "0.3",
     .steel = "0.3",
     .range = "[0,0.5)",
     .meaning = "Poisson's ratio",
     .source = "sea ice 0.28 to 0.35; steel: EN 1993-1-1, 3.2.6"},
    {.section = FL_SEC_MATERIAL,
     .key = "restitution",
     .type = FL_VALUE_F64,
     .at = AT(material, restitution),
     .fallback = "0.3",
     .steel = "0.3",
     .range = "[0,1]",
     .meaning = "rebound speed over impact speed; a pair takes the smaller of its two",
     .source = "ice on ice 0.2 to 0.5; the pair with steel is taken alike"},
    {.section = FL_SEC_MATERIAL,
     .key = "friction",
     .type = FL_VALUE_F64,
     .at = AT(material, friction),
     .fallback = "0.3",
     .steel = "0.15",
     .range = "[0,1e6]",
     .meaning = "coefficient of friction; a pair takes the smaller of its two",
     .source = "ice on ice 0.1 to 0.5; ice on steel 0.05 to 0.3"},
    {.section = FL_SEC_CONTACT,
     .key = "friction",
     .type = FL_VALUE_F64,
     .at = AT(contact, friction),
     .fallback = "auto",
     .special = "auto",
     .value = -1,
     .range = "[0,1e6]",
     .meaning = "coefficient of friction of the pair; auto is the smaller of the two materials'"},
    {.section = FL_SEC_CONTACT,
     .key = "restitution",
     .type = FL_VALUE_F64,
     .at = AT(contact, restitution),
     .fallback = "auto",
     .special = "auto",
     .value = -1,
     .range = "[0,1]",
     .meaning = "rebound speed over impact speed of the pair; auto is the smaller of the two materials'"},
    {.section = FL_SEC_CONTACT,
     .key = "law",
     .type = FL_VALUE_WORD,
     .at = AT(contact, law),
     .fallback = "patch",
     .choices = "patch|manual|manual-si|core",
     .meaning = "patch: a root of the sum over the faces, edges and vertices that touch, with one potential; "
                "core: the nearest pair of features alone; manual: the "
                "DilatedDEM manual's table of modes with its lengths as numbers; manual-si: the same with "
                "consistent units",
     .source = "DilatedDEM manual (2016), equations (1) to (25), corrected"},
    {.section = FL_SEC_CONTACT,
     .key = "exponent",
     .type = FL_VALUE_F64,
     .at = AT(contact, exponent),
     .fallback = "1",
     .choices = "1|1.5",
     .meaning = "the n of F = kappa delta^n in the law core; what is round has 1.5 always, patch and "
                "the laws of the manual their own",
     .source = "1 linear; 1.5 Hertz"},
    {.section = FL_SEC_CONTACT,
     .key = "stiffness",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_SPRING,
     .at = AT(contact, stiffness),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "the kappa of a whole face in the law patch, of the one place in the law core; auto takes it "
                "from the moduli",
     .source = "flat punch 2 E* beta sqrt(A/pi), a sixth of it in core; (4/3) E* sqrt(R*) for what is round"},
    {.section = FL_SEC_CONTACT,
     .key = "softening",
     .type = FL_VALUE_F64,
     .at = AT(contact, softening),
     .fallback = "1",
     .range = "(0,1]",
     .meaning =
         "the factor s_k of the automatic stiffness, so that steps may be longer; the report tells the "
         "overlap it costs",
     .source = "allowed while the overlap stays below 0.3 of the dilation radius"},
    {.section = FL_SEC_CONTACT,
     .key = "tangential",
     .type = FL_VALUE_F64,
     .at = AT(contact, tangential),
     .fallback = "0.824",
     .range = "(0,2]",
     .meaning = "stiffness along the face over stiffness across it, kt/kn",
     .source = "Mindlin, 2(1-nu)/(2-nu) at nu = 0.3"},
    {.section = FL_SEC_CONTACT,
     .key = "damping",
     .type = FL_VALUE_F64,
     .at = AT(contact, damping),
     .fallback = "auto",
     .special = "auto",
     .value = -1,
     .range = "[0,1000]",
     .meaning = "damping in place of what restitution asks for: D = chi v_impact of patch and core; zeta of "
                "the linear and alpha of the 3/2 modes of the manual's laws",
     .source = "Hunt & Crossley 1975; DilatedDEM manual (2016), equation (2)"},
    {.section = FL_SEC_CONTACT,
     .key = "literal2",
     .type = FL_VALUE_WORD,
     .at = AT(contact, literal2),
     .fallback = "false",
     .choices = "false|true",
     .meaning = "true takes m1 + m2 for the effective mass in the manual's laws, as equation (2) is printed",
     .source = "DilatedDEM manual (2016), equation (2)"},
    {.section = FL_SEC_CONTACT,
     .key = "literal18",
     .type = FL_VALUE_WORD,
     .at = AT(contact, literal18),
     .fallback = "false",
     .choices = "false|true",
     .meaning =
         "true takes R' = 1/lambda for crossed edges in the manual's laws, as equation (18) is printed",
     .source = "DilatedDEM manual (2016), equation (18)"},
    {.section = FL_SEC_ICE,
     .key = "file",
     .type = FL_VALUE_PATH,
     .at = AT(ice, file),
     .fallback = "none",
     .special = "none",
     .meaning = "the ice, a g-polys file; \"-\" is standard input; it must be given, here or by --ice",
     .source = "g-polys(5)"},
    {.section = FL_SEC_ICE,
     .key = "material",
     .type = FL_VALUE_NAME,
     .at = AT(ice, material),
     .fallback = "ice",
     .meaning = "material of the bodies whose record names none"},
    {.section = FL_SEC_ICE,
     .key = "shape",
     .type = FL_VALUE_WORD,
     .at = AT(ice, shape),
     .fallback = "sharp",
     .choices = "sharp|round",
     .meaning = "the shape that mass, inertia and buoyancy see: the faces moved outward by the radius and "
                "meeting in sharp edges, "
                "or the Minkowski sum itself",
     .source = "Steiner's formula, Schneider, Convex Bodies (2014), ch. 4"},
    {.section = FL_SEC_STRUCTURE,
     .key = "file",
     .type = FL_VALUE_PATH,
     .at = AT(structure, file),
     .fallback = "none",
     .special = "none",
     .meaning =
         "the structure, a g_struct file; \"-\" is standard input; it must be given, here or by --structure",
     .source = "g_struct(5)"},
    {.section = FL_SEC_STRUCTURE,
     .key = "material",
     .type = FL_VALUE_NAME,
     .at = AT(structure, material),
     .fallback = "steel",
     .meaning = "material of the structure"},
    {.section = FL_SEC_STRUCTURE,
     .key = "friction",
     .type = FL_VALUE_F64,
     .at = AT(structure, friction),
     .fallback = "auto",
     .special = "auto",
     .value = -1,
     .range = "[0,1e6]",
     .meaning = "coefficient of friction against everything that touches the structure; auto is that of the "
                "contact"},
    MOTION_KEYS(FL_SEC_STRUCTURE, structure),
    {.section = FL_SEC_BOUNDARY,
     .key = "type",
     .type = FL_VALUE_WORDS,
     .at = AT(boundary, type),
     .fallback = "rigid",
     .choices = "rigid|elastic|periodic|free",
     .meaning =
         "what stands at the bounds, one word for all directions or one for each of x, y and z; rigid: "
         "walls; elastic: walls on springs and dashpots; periodic: what leaves at one bound comes in at the "
         "other; free: nothing, floes that are wholly beyond a bound are taken out",
     .source = "DilatedDEM manual (2016), bound_type"},
    {.section = FL_SEC_BOUNDARY,
     .key = "min",
     .type = FL_VALUE_VEC3,
     .unit = FL_UNIT_LENGTH,
     .at = AT(boundary, min),
     .fallback = "none none none",
     .special = "none",
     .value = -INFINITY,
     .meaning = "lower bounds of x, y and z; none leaves a side open"},
    {.section = FL_SEC_BOUNDARY,
     .key = "max",
     .type = FL_VALUE_VEC3,
     .unit = FL_UNIT_LENGTH,
     .at = AT(boundary, max),
     .fallback = "none none none",
     .special = "none",
     .value = INFINITY,
     .meaning = "upper bounds of x, y and z; none leaves a side open"},
    {.section = FL_SEC_BOUNDARY,
     .key = "stiffness",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_SPRING,
     .at = AT(boundary, stiffness),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning =
         "the kappa of the springs against the walls, in place of contact.stiffness; auto is that of the "
         "contact"},
    {.section = FL_SEC_BOUNDARY,
     .key = "foundation",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_BED,
     .at = AT(boundary, foundation),
     .fallback = "10 MN/m3",
     .range = "(0,inf)",
     .meaning = "stiffness of an elastic wall per area that presses into it; the force is this times the "
                "volume behind the wall, of the shape that mass sees",
     .source = "a sheet of 1 GPa that goes on for 100 m behind the wall, E/L"},
    {.section = FL_SEC_BOUNDARY,
     .key = "damping",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_DASHPOT,
     .at = AT(boundary, damping),
     .fallback = "0 N.s/m3",
     .range = "[0,inf)",
     .meaning = "dashpots of an elastic wall per area that presses into it; sqrt(density young) of the ice "
                "takes a wave up without reflection",
     .source = "Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859"},
    {.section = FL_SEC_BOUNDARY,
     .key = "inflow",
     .type = FL_VALUE_WORD,
     .at = AT(boundary, inflow),
     .fallback = "none",
     .choices = "none|ice|file",
     .meaning =
         "whether new floes come in, and which; ice: copies of the field of ice.file, again and again; "
         "file: of that of inflow_file"},
    {.section = FL_SEC_BOUNDARY,
     .key = "inflow_file",
     .type = FL_VALUE_PATH,
     .at = AT(boundary, inflow_file),
     .fallback = "none",
     .special = "none",
     .meaning = "the field of what comes in, a g-polys file, for inflow = file",
     .source = "g-polys(5)"},
    {.section = FL_SEC_BOUNDARY,
     .key = "inflow_from",
     .type = FL_VALUE_WORD,
     .at = AT(boundary, inflow_from),
     .fallback = "-x",
     .choices = "-x|x|-y|y",
     .meaning = "the bound the new floes come in through: the lower or the upper one of x or y; floes leave "
                "through both"},
    {.section = FL_SEC_BOUNDARY,
     .key = "inflow_speed",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_SPEED,
     .at = AT(boundary, inflow_speed),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "speed of the ice that comes in, straight from its bound, whatever is in its way; auto is "
                "that of water.current"},
    {.section = FL_SEC_BOUNDARY,
     .key = "inflow_pitch",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_LENGTH,
     .at = AT(boundary, inflow_pitch),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "distance of one copy of the field from the next, along the drift; auto is the length that "
                "the floes take up; the length of the domain they were made for keeps their concentration"},
    {.section = FL_SEC_BOUNDARY,
     .key = "room",
     .type = FL_VALUE_I32,
     .at = AT(boundary, room),
     .fallback = "auto",
     .special = "auto",
     .range = "[1,100000000]",
     .meaning =
         "how many floes there may be at a time besides those of the start; a floe for which there is "
         "no room waits; auto is one and a quarter of what comes in over the length of the domain, and "
         "a field besides"},
    {.section = FL_SEC_BOUNDARY,
     .key = "drive",
     .type = FL_VALUE_VEC3,
     .unit = FL_UNIT_SPEED,
     .at = AT(boundary, drive),
     .fallback = "0 m/s",
     .lone = FL_LONE_X,
     .meaning =
         "velocity at which an edge row of the ice is moved, whatever it takes; one number is along x; "
         "drive_width or drive_group says which floes"},
    {.section = FL_SEC_BOUNDARY,
     .key = "drive_width",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_LENGTH,
     .at = AT(boundary, drive_width),
     .fallback = "none",
     .special = "none",
     .range = "(0,inf)",
     .meaning =
         "floes whose middle is within this distance of the edge of the field at the start are driven"},
    {.section = FL_SEC_BOUNDARY,
     .key = "drive_edge",
     .type = FL_VALUE_WORD,
     .at = AT(boundary, drive_edge),
     .fallback = "auto",
     .choices = "auto|-x|x|-y|y",
     .meaning =
         "the edge of the field that drive_width counts from: least or greatest x or y; auto is the one "
         "behind the drive"},
    {.section = FL_SEC_BOUNDARY,
     .key = "drive_group",
     .type = FL_VALUE_NAME,
     .at = AT(boundary, drive_group),
     .fallback = "none",
     .special = "none",
     .meaning = "the floes of the ice file with this group are driven"},
    {.section = FL_SEC_BOUNDARY,
     .key = "drive_fixed",
     .type = FL_VALUE_FIXED,
     .at = AT(boundary, drive_fixed),
     .fallback = "x y rz",
     .special = "none",
     .meaning = "directions of driven floes that follow the drive, and turns that are held; without z they "
                "heave, without rx and ry they roll and pitch"},
    {.section = FL_SEC_BOUNDARY,
     .key = "drive_spring",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_SPRING,
     .at = AT(boundary, drive_spring),
     .fallback = "0 N/m",
     .range = "[0,inf)",
     .meaning = "spring that pulls each driven floe back to the height it had at the start"},
    {.section = FL_SEC_BOUNDARY,
     .key = "drive_foundation",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_BED,
     .at = AT(boundary, drive_foundation),
     .fallback = "0 N/m3",
     .range = "[0,inf)",
     .meaning = "the same per area of the floe's largest face, besides; rho g of the water is 10 kN/m3"},
    {.section = FL_SEC_WATER,
     .key = "level",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_LENGTH,
     .at = AT(water, level),
     .fallback = "0 m",
     .meaning = "height z of the still water"},
    {.section = FL_SEC_WATER,
     .key = "depth",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_LENGTH,
     .at = AT(water, depth),
     .fallback = "none",
     .special = "none",
     .value = INFINITY,
     .range = "(0,inf)",
     .meaning = "depth of the water; it bears on waves and sheared currents alone; none is deep water"},
    {.section = FL_SEC_WATER,
     .key = "density",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_DENSITY,
     .at = AT(water, density),
     .fallback = "1025 kg/m3",
     .range = "(0,inf)",
     .meaning = "mass per volume of the water",
     .source = "sea water 1005 to 1035"},
    {.section = FL_SEC_WATER,
     .key = "current",
     .type = FL_VALUE_VEC3,
     .unit = FL_UNIT_SPEED,
     .at = AT(water, current),
     .fallback = "0 m/s",
     .lone = FL_LONE_X,
     .meaning = "velocity of the water, at the surface; one number is along x"},
    {.section = FL_SEC_WATER,
     .key = "profile",
     .type = FL_VALUE_WORD,
     .at = AT(water, profile),
     .fallback = "uniform",
     .choices = "uniform|power|linear|table",
     .meaning = "how the current U changes with the height z over still water: not at all, as "
                "U0 (1 + z/d)^a, as U0 (1 + z/d), or by the rows of a file; above still water it is that of "
                "the surface",
     .source = "DNV-RP-C205 (2010), 4.1.4"},
    {.section = FL_SEC_WATER,
     .key = "profile_exponent",
     .type = FL_VALUE_F64,
     .at = AT(water, profile_exponent),
     .fallback = "0.14285714285714285",
     .range = "(0,10]",
     .meaning = "the a of the profile power",
     .source = "1/7, turbulent flow over a bottom of sand"},
    {.section = FL_SEC_WATER,
     .key = "profile_depth",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_LENGTH,
     .at = AT(water, profile_depth),
     .fallback = "auto",
     .special = "auto",
     .range = "(0,inf)",
     .meaning = "the d of the profiles power and linear, below which there is no current; auto is the depth "
                "of the water",
     .source = "currents of the wind reach 20 to 50 m down"},
    {.section = FL_SEC_WATER,
     .key = "profile_file",
     .type = FL_VALUE_PATH,
     .at = AT(water, profile_file),
     .fallback = "none",
     .special = "none",
     .meaning = "file of the profile table, heights and velocities, see current(5); it takes the place of "
                "current",
     .source = "measurements of the site"},
    {.section = FL_SEC_WATER,
     .key = "drag_force_coef",
     .type = FL_VALUE_F64,
     .at = AT(water, drag_force_coef),
     .fallback = "0.005",
     .range = "[0,inf)",
     .meaning = "the C of the drag force, on the wetted area",
     .source = "DilatedDEM manual (2016), equation (8); skin friction of ice, 0.001 to 0.035"},
    {.section = FL_SEC_WATER,
     .key = "drag_moment_coef",
     .type = FL_VALUE_F64,
     .at = AT(water, drag_moment_coef),
     .fallback = "0.002",
     .range = "[0,inf)",
     .meaning = "the C of the drag moment, on the wetted area",
     .source = "DilatedDEM manual (2016), equation (9); 2/5 of the skin coefficient for a disc"},
    {.section = FL_SEC_WATER,
     .key = "drag",
     .type = FL_VALUE_WORD,
     .at = AT(water, drag),
     .fallback = "manual",
     .choices = "manual|facet",
     .meaning =
         "manual takes force and moment of the manual's equations, on the whole wetted area; facet adds "
         "up skin and form drag over the wetted part of each face; what is round has manual always",
     .source = "DilatedDEM manual (2016), equations (8) and (9); Hoerner, Fluid-Dynamic Drag (1965)"},
    {.section = FL_SEC_WATER,
     .key = "skin_coef",
     .type = FL_VALUE_F64,
     .at = AT(water, skin_coef),
     .fallback = "0.005",
     .range = "[0,inf)",
     .meaning = "C of the drag along each wetted face, of drag = facet",
     .source = "0.001 to 0.035 under ice (Steiner 2001)"},
    {.section = FL_SEC_WATER,
     .key = "form_coef",
     .type = FL_VALUE_F64,
     .at = AT(water, form_coef),
     .fallback = "0.5",
     .range = "[0,inf)",
     .meaning = "C of the drag on each wetted face that goes ahead, of drag = facet",
     .source = "edges of floes 0.3 to 1"},
    {.section = FL_SEC_WATER,
     .key = "added_mass",
     .type = FL_VALUE_VEC3,
     .at = AT(water, added_mass),
     .fallback = "0 0 0",
     .special = "auto",
     .value = -1.0,
     .lone = FL_LONE_ALL,
     .meaning =
         "mass of water that moves with a body, over the displaced, along its axes: two in the plane "
         "of a floe, the third across it; auto is 0.1 in the plane and 4/3 rho a^3, a disc of its area "
         "with one side wet, across; 1/2 of what is round",
     .source = "Lamb, Hydrodynamics (1932), art. 92, 102; surge 0.1 to 0.15"},
    {.section = FL_SEC_WATER,
     .key = "added_inertia",
     .type = FL_VALUE_VEC3,
     .at = AT(water, added_inertia),
     .fallback = "0 0 0",
     .special = "auto",
     .value = -1.0,
     .lone = FL_LONE_ALL,
     .meaning = "moment of inertia of water that turns with a body, over its own, about its axes; auto is "
                "8/45 rho a^5, a disc with one side wet, about those in the plane of a floe, and 0 else",
     .source = "Lamb, Hydrodynamics (1932), art. 102"},
    {.section = FL_SEC_WATER,
     .key = "wave",
     .type = FL_VALUE_WORD,
     .at = AT(water, wave),
     .fallback = "none",
     .choices = "none|airy|jonswap",
     .meaning = "waves, all running one way: none; airy, one regular train with its crest at the origin at "
                "the start; jonswap, a sea by chance",
     .source = "Airy 1845; Hasselmann et al. 1973; DNV-RP-C205 (2010), 3.3 and 3.5"},
    {.section = FL_SEC_WATER,
     .key = "height",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_LENGTH,
     .at = AT(water, height),
     .fallback = "none",
     .special = "none",
     .range = "(0,inf)",
     .meaning = "height of the wave from trough to crest; of a sea the significant one, four standard "
                "deviations of the elevation"},
    {.section = FL_SEC_WATER,
     .key = "period",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_TIME,
     .at = AT(water, period),
     .fallback = "none",
     .special = "none",
     .range = "(0,inf)",
     .meaning = "period of the wave; of a sea that of the peak of its spectrum"},
    {.section = FL_SEC_WATER,
     .key = "direction",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_ANGLE,
     .at = AT(water, direction),
     .fallback = "0 deg",
     .meaning = "direction the waves run to, from x towards y"},
    {.section = FL_SEC_WATER,
     .key = "gamma",
     .type = FL_VALUE_F64,
     .at = AT(water, gamma),
     .fallback = "3.3",
     .range = "[1,20]",
     .meaning = "how much the peak of the spectrum of a sea is raised; 1 is a fully developed one",
     .source = "mean of the North Sea, Hasselmann et al. 1973; 1 to 7"},
    {.section = FL_SEC_WATER,
     .key = "components",
     .type = FL_VALUE_I32,
     .at = AT(water, components),
     .fallback = "100",
     .range = "[1,10000]",
     .meaning = "number of trains that a sea is made of, all of the same energy"},
    {.section = FL_SEC_WATER,
     .key = "seed",
     .type = FL_VALUE_I32,
     .at = AT(water, seed),
     .fallback = "1",
     .range = "[0,2147483647]",
     .meaning = "seed of the phases and frequencies of a sea"},
    {.section = FL_SEC_WIND,
     .key = "velocity",
     .type = FL_VALUE_VEC3,
     .unit = FL_UNIT_SPEED,
     .at = AT(wind, velocity),
     .fallback = "0 m/s",
     .lone = FL_LONE_X,
     .meaning = "velocity of the wind 10 m above the water; one number is along x"},
    {.section = FL_SEC_WIND,
     .key = "beaufort",
     .type = FL_VALUE_F64,
     .at = AT(wind, beaufort),
     .fallback = "none",
     .special = "none",
     .value = -1.0,
     .range = "[0,17]",
     .meaning = "force of the wind on Beaufort's scale, in place of velocity: 0.836 B^(3/2) m/s",
     .source = "WMO, Manual on Codes, No. 306; DilatedDEM manual (2016), windvel"},
    {.section = FL_SEC_WIND,
     .key = "direction",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_ANGLE,
     .at = AT(wind, direction),
     .fallback = "0 deg",
     .meaning = "direction that the wind of beaufort blows to, from x towards y"},
    {.section = FL_SEC_WIND,
     .key = "density",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_DENSITY,
     .at = AT(wind, density),
     .fallback = "1.293 kg/m3",
     .range = "(0,inf)",
     .meaning = "mass per volume of the air",
     .source = "dry air at 0 degrees Celsius"},
    {.section = FL_SEC_WIND,
     .key = "drag",
     .type = FL_VALUE_WORD,
     .at = AT(wind, drag),
     .fallback = "manual",
     .choices = "manual|facet",
     .meaning = "manual takes one force on the whole dry area; facet adds up skin and form drag over the dry "
                "part of each face; what is round has manual always",
     .source = "as water.drag"},
    {.section = FL_SEC_WIND,
     .key = "drag_coef",
     .type = FL_VALUE_F64,
     .at = AT(wind, drag_coef),
     .fallback = "0.0015",
     .range = "[0,inf)",
     .meaning = "drag coefficient, on the dry area; of drag = facet, that along each dry face",
     .source = "ice in air 0.001 to 0.009 (Steiner 2001)"},
    {.section = FL_SEC_WIND,
     .key = "form_coef",
     .type = FL_VALUE_F64,
     .at = AT(wind, form_coef),
     .fallback = "0.5",
     .range = "[0,inf)",
     .meaning = "C of the drag on each dry face that faces the wind, of drag = facet",
     .source = "as water.form_coef"},
    {.section = FL_SEC_BOND,
     .key = "on",
     .type = FL_VALUE_WORD,
     .at = AT(bond, on),
     .fallback = "false",
     .choices = "false|!true",
     .meaning = "whether neighbours start frozen together",
     .source = "DilatedDEM manual (2016), isbonding"},
    {.section = FL_SEC_BOND,
     .key = "normal_strength",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_STRESS,
     .at = AT(bond, normal_strength),
     .fallback = "0.7 MPa",
     .range = "(0,inf)",
     .meaning = "tensile strength of a frozen face; of no effect while bonds are off",
     .source = "0.69 to 0.95 MPa in bonded-sphere models (2014)"},
    {.section = FL_SEC_BOND,
     .key = "shear_strength",
     .type = FL_VALUE_F64,
     .unit = FL_UNIT_STRESS,
     .at = AT(bond, shear_strength),
     .fallback = "0.7 MPa",
     .range = "(0,inf)",
     .meaning = "shear strength of a frozen face; of no effect while bonds are off",
     .source = "taken alike"},
    {.section = FL_SEC_BOND,
     .key = "softening",
     .type = FL_VALUE_F64,
     .later = 1,
     .meaning = "how a bond yields between its strength and its failure"},
    {.section = FL_SEC_GROUP,
     .key = "fixed",
     .type = FL_VALUE_FIXED,
     .at = AT(group, fixed),
     .fallback = "none",
     .special = "none",
     .meaning = "directions x y z and turns rx ry rz, world axes, in which forces do not move the bodies of "
                "the group"},
    {.section = FL_SEC_GROUP,
     .key = "velocity",
     .type = FL_VALUE_VEC3,
     .unit = FL_UNIT_SPEED,
     .at = AT(group, velocity),
     .fallback = "0 0 0 m/s",
     .meaning = "velocity in the fixed directions"},
    MOTION_KEYS(FL_SEC_PART, part),
};
const int fl_key_count = sizeof fl_key_table / sizeof fl_key_table[0];

const fl_manual_word fl_manual_table[] = {
    {"expperiment duration", FL_SEC_RUN, NULL, "duration", FL_MAP_SAME},
    {"gravity", FL_SEC_RUN, NULL, "gravity", FL_MAP_SAME},
    {"nproc", FL_SEC_RUN, NULL, "threads", FL_MAP_SAME},
    {"ndtsrc", FL_SEC_RUN, NULL, "search_every", FL_MAP_SAME},
    {"dtoutInfo", FL_SEC_OUTPUT, NULL, "loads_every", FL_MAP_SAME},
    {"dtoutAni", FL_SEC_OUTPUT, NULL, "frames_every", FL_MAP_SAME},
    {"dtoutAni_draw", FL_SEC_OUTPUT, NULL, "ice_every", FL_MAP_SAME},
    {"dtoutfile", FL_SEC_OUTPUT, NULL, "until", FL_MAP_SAME},
    {"output file number", FL_SEC_OUTPUT, NULL, "files", FL_MAP_SAME},
    {"restitution", FL_SEC_MATERIAL, "ice", "restitution", FL_MAP_SAME},
    {"mus", FL_SEC_MATERIAL, "ice", "friction", FL_MAP_SAME},
    {"mubed", FL_SEC_STRUCTURE, NULL, "friction", FL_MAP_SAME},
    {"structvelx", FL_SEC_STRUCTURE, NULL, "velocity", FL_MAP_X},
    {"structvely", FL_SEC_STRUCTURE, NULL, "velocity", FL_MAP_Y},
    {"structvelz", FL_SEC_STRUCTURE, NULL, "velocity", FL_MAP_Z},
    {"bound_type", FL_SEC_BOUNDARY, NULL, "type", FL_MAP_BOUND},
    {"waterdepth", FL_SEC_WATER, NULL, "depth", FL_MAP_SAME},
    {"watervel", FL_SEC_WATER, NULL, "current", FL_MAP_SAME},
    {"windvel", FL_SEC_WIND, NULL, "velocity", FL_MAP_BEAUFORT},
    {"isbonding", FL_SEC_BOND, NULL, "on", FL_MAP_SAME},
    {"n_strength", FL_SEC_BOND, NULL, "normal_strength", FL_MAP_SAME},
    {"t_strength", FL_SEC_BOND, NULL, "shear_strength", FL_MAP_SAME},
};
const int fl_manual_count = sizeof fl_manual_table / sizeof fl_manual_table[0];

int fl_key_first(int section)
{
    int k = 0;
    while (k < fl_key_count && (int)fl_key_table[k].section < section) k++;
    return k;
}

int fl_section_find(const char *name)
{
    for (int s = 0; s < FL_SECTIONS; s++)
        if (strcmp(fl_section_table[s].name, name) == 0) return s;
    return -1;
}

int fl_key_find(int section, const char *key)
{
    for (int k = fl_key_first(section); k < fl_key_first(section + 1); k++)
        if (strcmp(fl_key_table[k].key, key) == 0) return k;
    return -1;
}
