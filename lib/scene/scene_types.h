/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_types.h -- the values of one case: a struct for each section of a scene file, scene(5).
 *
 * Values are SI (angles in degrees).  Each member is the value of one row of the key table, scene_key.h,
 * which has its unit, default, range and source. */
#ifndef FL_SCENE_SCENE_TYPES_H
#define FL_SCENE_SCENE_TYPES_H
#include <stdint.h>
#include "geom/vec3.h"

enum { FL_SCENE_NAME = 48, FL_SCENE_PATH = 1024, FL_SCENE_KEYS = 32 };

/* Where a value was given.  line is 0 for a default; file is an index into scene.file, or
 * FL_SCENE_ARGUMENT for --set. */
enum { FL_SCENE_ARGUMENT = -1 };
typedef struct {
    int32_t file, line;
    uint32_t components; /* bit c: component c of a vector; all bits for a whole value */
    int32_t is_auto;     /* the word given was the special one ("auto"): another key decides */
} fl_scene_mark;

/* First member of every section. */
typedef struct {
    int present;                      /* the file has the section, or one of its keys was set */
    fl_scene_mark heading;            /* line of its heading */
    fl_scene_mark key[FL_SCENE_KEYS]; /* one per key, in the order of the table */
} fl_scene_head;

enum fl_shape { FL_SHAPE_SHARP, FL_SHAPE_ROUND };
enum fl_boundary_type {
    FL_BOUNDARY_RIGID,
    FL_BOUNDARY_ELASTIC,
    FL_BOUNDARY_PERIODIC,
    FL_BOUNDARY_FREE
}; /* manual's word - 1 */
enum fl_error_of {
    FL_ERROR_OF_IMPULSE,
    FL_ERROR_OF_PEAK,
    FL_ERROR_OF_FX,
    FL_ERROR_OF_FY,
    FL_ERROR_OF_FZ,
    FL_ERROR_OF_MX,
    FL_ERROR_OF_MY,
    FL_ERROR_OF_MZ
};
enum fl_device { FL_DEVICE_AUTO, FL_DEVICE_CPU, FL_DEVICE_GPU, FL_DEVICE_SERIAL };
enum fl_relax { FL_RELAX_NONE, FL_RELAX_LOCAL, FL_RELAX_KINETIC, FL_RELAX_ADAPTIVE };
enum fl_drive_of { FL_DRIVE_OF_ROW, FL_DRIVE_OF_WALL };
enum fl_inflow { FL_INFLOW_NONE, FL_INFLOW_ICE, FL_INFLOW_FILE };
enum fl_frames_form { FL_FRAMES_TEXT, FL_FRAMES_PACKED };
enum fl_wave_kind { FL_WAVE_NONE, FL_WAVE_AIRY, FL_WAVE_JONSWAP };
enum fl_ice_decay { FL_ICE_DECAY_NONE, FL_ICE_DECAY_ROGERS, FL_ICE_DECAY_MEYLAN, FL_ICE_DECAY_OWN };
enum { FL_FIX_X = 1, FL_FIX_Y = 2, FL_FIX_Z = 4, FL_FIX_RX = 8, FL_FIX_RY = 16, FL_FIX_RZ = 32 };

typedef struct {
    fl_scene_head head;
    double duration;      /* [s] */
    double dt;            /* [s]; 0: auto */
    double safety;        /* fraction of the critical step, for dt = auto */
    double error;         /* budget that chooses the step in place of safety; 0: none */
    int32_t error_of;     /* enum fl_error_of */
    fl_vec3 gravity;      /* [m/s2] as a vector; the file's one number g is (0, 0, -g) */
    int32_t threads;      /* 0: auto, as many as OpenMP offers */
    int32_t device;       /* enum fl_device: who runs the spheres */
    double sleep;         /* allowed position error of a skip over the radius; 0: no floe sleeps */
    int32_t search_every; /* steps between neighbour searches; 0: auto, when the skin is used up */
    int32_t relax;        /* enum fl_relax */
    double relax_until;   /* force ratio at which a run or stage is settled */
} fl_scene_run;

typedef struct {
    fl_scene_head head;
    /* Intervals [s].  An interval that copies another one is 0 until fl_scene_check() sets it. */
    double loads_every;
    double frames_every, ice_every, until; /* ANIMATION_3D.DAT: frames, the ice in them, and their end */
    int32_t files;                         /* number of files the frames are split over */
    int32_t frames_form;                   /* text, packed: enum fl_frames_form */
    double state_every, energy_every, contacts_every, hash_every, bonds_every, members_every, zones_every;
    double checkpoint_every;
    char frames[FL_SCENE_PATH], state[FL_SCENE_PATH], energy[FL_SCENE_PATH], contacts[FL_SCENE_PATH],
        hash[FL_SCENE_PATH], panels[FL_SCENE_PATH], events[FL_SCENE_PATH], bonds[FL_SCENE_PATH],
        members[FL_SCENE_PATH], zones[FL_SCENE_PATH], failures[FL_SCENE_PATH], final_ice[FL_SCENE_PATH],
        checkpoint[FL_SCENE_PATH]; /* "": none */
} fl_scene_output;

typedef struct {
    fl_scene_head head;
    char name[FL_SCENE_NAME];
    double density; /* [kg/m3] */
    double young;   /* [Pa] */
    double poisson;
    double restitution; /* of the material against itself */
    double friction;
    double cohesion, friction_angle; /* of Mohr-Coulomb [Pa], [deg]; negative: not given */
    double tension, dilation;        /* [Pa], INFINITY: none but that of the cone; [deg] */
} fl_scene_material;

/* Law of a point of a round core. */
enum fl_round_law { FL_ROUND_HERTZ, FL_ROUND_LINEAR };

/* Contact parameters of a pair.  In scene.contact a member counts only where its key was given;
 * fl_scene_pair() returns a struct with every member set. */
typedef struct {
    fl_scene_head head;
    char a[FL_SCENE_NAME], b[FL_SCENE_NAME]; /* both empty: the defaults of all pairs */
    int32_t law;                             /* row of fl_contact_laws, law/contact_law.h */
    double exponent;                         /* n of F = kappa delta^n: 1 or 1.5 */
    int32_t round_law;                       /* enum fl_round_law */
    double stiffness;                        /* kappa [N/m^n]; 0: auto, from the moduli, notation(7) */
    double stiffness_factor;                 /* s_k, 0 < s_k <= 1, multiplies the automatic kappa */
    double tangential_ratio;                 /* kt / kn */
    double rolling;                          /* mu_r of spheres; 0: they roll freely */
    double friction, restitution;            /* negative in scene.contact: auto, from the materials */
    double surrogate; /* relative force error of the surrogate; 0: exact evaluation in every step */
    double damping;   /* replaces the damping that restitution gives: chi v_impact of `patch` and `core`,
                         zeta of `manual`; negative: auto */
    int32_t manual_eq2, manual_eq18; /* 1: equation (2), (18) of the manual as printed */
} fl_scene_contact;

typedef struct {
    fl_scene_head head;
    char file[FL_SCENE_PATH];     /* g-polys; "-" is standard input, "" not given */
    char material[FL_SCENE_NAME]; /* of bodies whose record names none */
    int32_t shape;                /* enum fl_shape */
    double slab;                  /* thickness that spheres stand for [m]; 0: none */
} fl_scene_ice;

/* Motion of the structure, or of one part.  Free directions follow forces; the others follow the
 * prescribed motion. World axes; rotations are about the reference point. */
enum fl_interpolation { FL_INTERPOLATION_CUBIC, FL_INTERPOLATION_LINEAR };
typedef struct {
    fl_vec3 reference;         /* centre of rotations and moments; centre of mass of a free body [m] */
    fl_vec3 velocity;          /* [m/s] */
    fl_vec3 spin;              /* [rad/s] */
    char track[FL_SCENE_PATH]; /* "": none */
    int32_t interpolation;     /* enum fl_interpolation, between rows of the track */
    uint32_t free;             /* FL_FIX_X | ...: free directions */
    double mass;               /* [kg]; 0: not given */
    fl_vec3 inertia;           /* [kg m2] */
    fl_vec3 stiffness;         /* [N/m] */
    fl_vec3 turn_stiffness;    /* [N m/rad] */
    fl_vec3 coupling;          /* C34, C35 [N], C45 [N m] */
    fl_vec3 period;            /* in place of stiffness [s]; 0: no spring */
    fl_vec3 damping;           /* [N s/m] */
    fl_vec3 turn_damping;      /* [N m s] */
    fl_vec3 damping_ratio;     /* in place of damping, fraction of critical */
    int32_t hydrostatic;       /* 1: add the hydrostatic stiffness of the mesh */
    int32_t waves;             /* 1: the pressure of the waves acts on the mesh */
    fl_vec3 added_mass;        /* with waves, along the axes of the file [kg] */
} fl_scene_motion;

typedef struct {
    fl_scene_head head;
    char file[FL_SCENE_PATH];       /* g_struct; "" not given */
    char members[FL_SCENE_PATH];    /* members; "" not given */
    double member_damping;          /* ratio of the lowest modes */
    char modes[FL_SCENE_PATH];      /* table of modes; "" not given */
    char modes_node[FL_SCENE_NAME]; /* its node at the waterline; "": it has directions */
    char material[FL_SCENE_NAME];
    double friction; /* against everything; negative: auto */
    fl_scene_motion motion;
    double direction; /* of the x axis of the scene in platform axes, about z [deg] */
} fl_scene_structure;

/* A part with a motion of its own. */
typedef struct {
    fl_scene_head head;
    char name[FL_SCENE_NAME];
    fl_scene_motion motion;
} fl_scene_part;

/* A mode of a part of the structure, structure/modal_motion.h. */
enum fl_mode_direction { FL_MODE_X, FL_MODE_Y, FL_MODE_XY };
typedef struct {
    fl_scene_head head;
    char name[FL_SCENE_NAME];
    char part[FL_SCENE_NAME]; /* "": all parts without a motion of their own */
    int32_t direction;        /* enum fl_mode_direction */
    double frequency;         /* [1/s]; 0: not given */
    double mass;              /* of the shape [kg]; 0: not given */
    double shape;             /* at the reference */
    double damping_ratio;
} fl_scene_mode;

typedef struct {
    fl_scene_head head;
    int32_t type[3];  /* enum fl_boundary_type of x, y, z; an absent section is FL_BOUNDARY_FREE */
    fl_vec3 min, max; /* [m]; -INFINITY, +INFINITY where a side is open */
    double stiffness; /* of the springs against the boundary [N/m^n]; 0: auto */
    int32_t inflow;   /* enum fl_inflow */
    char inflow_file[FL_SCENE_PATH]; /* g-polys; "" not given */
    int32_t inflow_from;             /* 0 -x, 1 x, 2 -y, 3 y: the bound */
    double inflow_speed;             /* [m/s]; 0: auto, that of the current */
    double inflow_pitch;             /* [m]; 0: auto, the length of the field */
    int32_t room;                    /* most floes at a time besides the initial ones; 0: auto */
    char drive_track[FL_SCENE_PATH]; /* track(5) of the driven floes in place of `drive`; "": none */
    fl_vec3 drive;                   /* velocity of the driven edge row of floes [m/s] */
    char drive_group[FL_SCENE_NAME]; /* group of the driven floes; "": by drive_width */
    double drive_width;              /* [m]; 0: none */
    int32_t drive_edge;              /* 0: auto, else 1 + code of inflow_from */
    uint32_t drive_fixed;            /* FL_FIX_X | ... */
    double drive_spring;             /* [N/m] */
    double drive_foundation;         /* [N/m3] */
    int32_t drive_of;                /* enum fl_drive_of */
    double line_load;                /* largest push of what is driven, or of the inflow [N/m]; 0: no limit */
    double iso_pack_width;           /* of the pack that pushes, for ISO's p_D as line_load [m]; 0: none */
    double iso_pack_coefficient;     /* R of p_D */
    double foundation, damping;      /* of an elastic wall, per area [N/m3], [N s/m3] */
} fl_scene_boundary;

typedef struct {
    fl_scene_head head;
    double level;                     /* z of the still water [m] */
    double depth;                     /* [m]; INFINITY: deep; used by waves and sheared currents */
    double density;                   /* [kg/m3] */
    fl_vec3 current;                  /* at the surface [m/s] */
    int32_t profile;                  /* uniform, power, linear, table: enum fl_profile of water/current.h */
    double profile_exponent;          /* of power */
    double profile_depth;             /* [m]; 0: auto, the depth */
    char profile_file[FL_SCENE_PATH]; /* of table; "": none */
    int32_t wave;                     /* enum fl_wave_kind */
    double height, period, direction, gamma; /* [m], [s], [deg]; height and period 0: not given */
    int32_t seed, components;                /* components 0: auto */
    double drag_force_coef;                  /* C of equation (8) */
    fl_vec3 added_mass;                      /* over the displaced mass, per body axis; -1: auto */
    fl_vec3 added_inertia;                   /* over the moments of inertia of the body; -1: auto */
    int32_t drag;                            /* manual, facet: enum fl_drag_law of water/environment.h */
    double skin_coef, form_coef;             /* C_s and C_f of facet */
    double drag_moment_coef;                 /* C of equation (9) */
    int32_t every;                           /* steps between two evaluations of the wave load */
    double wave_error;     /* asked for, over rho g A Hs/4; 0: none, waves evaluated in each step */
    double spread;         /* n of cos^n; 0: one direction */
    int32_t ice_decay;     /* enum fl_ice_decay */
    fl_vec3 ice_decay_law; /* C, m, n of own */
    double ice_edge;       /* of the ice along the waves [m]; INFINITY: not given */
    double ice_thickness;  /* for the decay [m]; 0: not given */
} fl_scene_water;

typedef struct {
    fl_scene_head head;
    fl_vec3 velocity; /* 10 m above the water [m/s] */
    double beaufort;  /* -1: none, velocity is used */
    double direction; /* the wind blows to, from x towards y [deg]; used with beaufort */
    double density;   /* of the air [kg/m3] */
    int32_t drag;     /* as of water */
    double drag_coef, form_coef;
} fl_scene_wind;

/* Treatment of a bond that stores more than its fracture energy at the peak, bond/bond.h. */
enum fl_softening { FL_SOFTENING_KEEP, FL_SOFTENING_STRETCH, FL_SOFTENING_WEAKEN };

typedef struct {
    fl_scene_head head;
    int32_t on;
    double young;                           /* [Pa]; 0: auto, of the materials */
    double poisson;                         /* negative: auto, of the materials */
    double normal_strength, shear_strength; /* [Pa]; INFINITY: never */
    double friction;
    double energy, shear_energy; /* [J/m2]; 0: brittle; shear_energy negative: auto, as energy */
    int32_t mixing;
    int32_t softening;        /* enum fl_softening */
    double stretch;           /* least ratio of final to peak separation, of stretch */
    double damping;           /* fraction of critical of the two bodies on their bond */
    double internal_friction; /* mu_i of the shear strength; negative: auto */
    double moment_factor;     /* beta of discs */
    double radius_factor;     /* of discs over the smaller sphere */
    double scatter;           /* standard deviation over mean of their strengths */
    int32_t seed;
} fl_scene_bond;

/* Contacts in which ice crushes, and laws of its pressure; polar classes 1 to 7 follow each other. */
enum fl_crushing_of { FL_CRUSHING_NONE, FL_CRUSHING_STRUCTURE, FL_CRUSHING_ALL };
enum fl_crushing_law { FL_CRUSHING_PLAIN, FL_CRUSHING_RATE };
enum fl_pressure_law {
    FL_PRESSURE_USER,
    FL_PRESSURE_POLAR_1,
    FL_PRESSURE_ISO_LOCAL = FL_PRESSURE_POLAR_1 + 7,
    FL_PRESSURE_API
};

typedef struct {
    fl_scene_head head;
    int32_t crushing;         /* enum fl_crushing_of */
    int32_t crushing_law;     /* enum fl_crushing_law */
    int32_t pressure_law;     /* enum fl_pressure_law */
    double pressure;          /* p0 [Pa] */
    double pressure_area;     /* A0 [m2] */
    double pressure_exponent; /* e */
    double pressure_max;      /* [Pa] */
    double peak_ratio;        /* R, and so on: of the law `rate`, failure/strip.h */
    double break_deflection;  /* [m] */
    double transition_speed;  /* [m/s] */
    int32_t creep_exponent;   /* 1, 3 */
    double delayed_stiffness; /* 0: none */
    double delayed_time;      /* [s] */
    double element_width;     /* [m]; 0: auto */
    double scatter;           /* standard deviation over mean */
    double scatter_length;    /* [m] */
    int32_t seed;
    int32_t wear;              /* 1: floes keep where they were crushed */
    double flexural_strength;  /* [Pa]; INFINITY: none */
    int32_t wedges;            /* that bend ahead of a contact */
    double fracture_toughness; /* [Pa m^0.5]; INFINITY: none */
    double fragment_min;       /* [m2]; 0: auto */
    int32_t fragments_max;     /* 0: auto */
} fl_scene_failure;

typedef struct {
    fl_scene_head head;
    char name[FL_SCENE_NAME];
    uint32_t fixed;   /* FL_FIX_X | ...: fixed directions and rotations, world axes */
    fl_vec3 velocity; /* [m/s] of the fixed directions */
} fl_scene_group;

/* The law of the joints of that name, bond/joint_law.h. */
typedef struct {
    fl_scene_head head;
    char name[FL_SCENE_NAME];
    int32_t law;                              /* enum fl_joint_law_kind of bond/joint_law.h */
    double normal_stiffness, shear_stiffness; /* [Pa/m]; 0: not given */
    double friction, friction_angle;          /* tan phi; phi [deg], negative: not given */
    double cohesion, tension;                 /* [Pa] */
    double dilation, dilation_slip;           /* psi [deg]; [m], INFINITY: no end */
    double residual_friction;                 /* negative: auto, as friction */
    double residual_cohesion;                 /* [Pa] */
    double water_pressure;                    /* [Pa] */
    double damping;                           /* fraction of critical of the two bodies on the joint */
    double roughness;                         /* R [m]; 0: not given */
    double initial_angle;                     /* phi_m at first [deg]; 0: not given */
    double normal_exponent, shear_exponent;
    double largest_normal_stiffness, largest_shear_stiffness; /* [Pa/m]; INFINITY: none */
    fl_vec3 initial_stress, initial_shear; /* xx yy zz and xy yz zx, compression positive [Pa] */
} fl_scene_joint;

/* A change of the model on the way to a state of rest. */
typedef struct {
    fl_scene_head head;
    char name[FL_SCENE_NAME];
    double start;               /* [s]; negative: when the stage before has settled */
    char remove[FL_SCENE_NAME]; /* group whose bodies are taken out; "": none */
} fl_scene_stage;

/* What holds a side of deformable blocks. */
enum fl_zone_side { FL_ZONE_SIDE_FREE, FL_ZONE_SIDE_ROLLER, FL_ZONE_SIDE_FIXED, FL_ZONE_SIDE_QUIET };

/* Deformable blocks. */
typedef struct {
    fl_scene_head head;
    double size;                           /* longest side of a cell of zones [m]; 0: not given */
    int32_t law;                           /* enum fl_zone_law_kind of zone/zone_law.h */
    char group[FL_SCENE_NAME];             /* "": all that is not fixed */
    double averaging;                      /* 1 - k of zone/zone_set.h */
    int32_t min_side[3], max_side[3];      /* enum fl_zone_side, of x, y, z */
    fl_vec3 initial_stress, initial_shear; /* xx yy zz and xy yz zx, compression positive [Pa] */
    fl_vec3 wave_stress;                   /* traction of a wave that comes in through quiet sides [Pa] */
    double wave_duration;                  /* of its pulse [s]; 0: it stays */
    int32_t wave_side;                     /* 2 axis + (1: largest) of the side where it comes in */
} fl_scene_zones;

typedef struct {
    fl_scene_run run;
    fl_scene_output output;
    fl_scene_ice ice;
    fl_scene_structure structure;
    fl_scene_boundary boundary;
    fl_scene_water water;
    fl_scene_wind wind;
    fl_scene_bond bond;
    fl_scene_failure failure;
    fl_scene_zones zones;
    fl_scene_material *material; /* "ice" and "steel" are always there after fl_scene_check() */
    fl_scene_contact *contact;
    fl_scene_group *group;
    fl_scene_part *part;
    fl_scene_mode *mode;
    fl_scene_joint *joint;
    fl_scene_stage *stage; /* in the order of the file */
    int32_t n_material, n_contact, n_group, n_part, n_mode, n_joint, n_stage;
    int32_t cap_material, cap_contact, cap_group, cap_part, cap_mode, cap_joint, cap_stage;
    char **file; /* names of the files read: the scene, then included files */
    int32_t n_file, cap_file;
} fl_scene;

#endif
