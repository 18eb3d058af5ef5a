// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_MJCF_H
#define HN_IMPORT_MJCF_H
// MuJoCo's MJCF: what the parts of its reader share. Semantics after the XML reference of MuJoCo 3.

#include "import/xml.h"

#include <stdbool.h>

typedef enum hn_mj_from_geoms { HN_MJ_AUTO, HN_MJ_ALWAYS, HN_MJ_NEVER } hn_mj_from_geoms;

typedef struct hn_mj_site {
    const char *name;
    int body;
    hn_im_frame at; ///< in the body
} hn_mj_site;

/// A geom with bits that let it touch others.
typedef struct hn_mj_geom_bits {
    const xmlNode *node;
    int body; ///< HN_GROUND
    unsigned contype, conaffinity;
} hn_mj_geom_bits;

typedef struct hn_mj {
    hn_build *b;
    const xmlNode *root;
    // compiler
    double per_angle; ///< radians in one unit of angle
    char eulerseq[4];
    int autolimits;
    hn_mj_from_geoms from_geoms;
    double boundmass, settotalmass; ///< [kg]; 0, -1: none
    double groups[2];               ///< geoms of these groups have mass
    // option flags
    int no_equality, no_springs, no_dampers, no_actuation, no_contact, no_limits;
    int keep_parents; ///< a body and its parent can touch: flag filterparent="disable"
    // found on the way
    const xmlNode **classes; ///< every default class
    int n_classes, cap_classes;
    int *moving; ///< joints in the order of qpos
    int n_moving, cap_moving;
    hn_mj_site *sites;
    int n_sites, cap_sites;
    int *controls; ///< parameters in the order of ctrl, -1 where a drive was refused
    int n_controls, cap_controls;
    hn_mj_geom_bits *geoms; ///< those that can touch others at all
    int n_geoms, cap_geoms;
} hn_mj;

/// An element and the default class that gives the attributes it lacks.
typedef struct hn_mj_element {
    const xmlNode *node;
    const xmlNode *defaults; ///< its class, or NULL: the main one
} hn_mj_element;

// ---- attributes: its own, else those of its class and of the classes around it ----
bool hn_mj_collect_classes(hn_mj *m);
/// `childclass`: the class of the body around it, or NULL. The class is checked once, here; then
/// .node is NULL after a fault.
hn_mj_element hn_mj_look(hn_mj *m, const xmlNode *node, const xmlNode *childclass);
/// The class an attribute names, `otherwise` when absent; *ok = 0 after a fault.
const xmlNode *hn_mj_class(hn_mj *m, const xmlNode *node, const char *attribute,
                           const xmlNode *otherwise, bool *ok);
const char *hn_mj_attr(hn_mj *m, const hn_mj_element *e, const char *name);
/// Counts of numbers read (0: absent), -1 after a fault.
int hn_mj_numbers(hn_mj *m, const hn_mj_element *e, const char *name, int least, int most,
                  double *out);
/// One number; 0 after a fault.
bool hn_mj_number(hn_mj *m, const hn_mj_element *e, const char *name, double otherwise,
                  double *out);
bool hn_mj_flag(hn_mj *m, const hn_mj_element *e, const char *name, int otherwise);
/// true, false or auto, where auto asks whether `range` is given.
bool hn_mj_is_limited(hn_mj *m, const hn_mj_element *e, const char *limited, const char *range);
/// pos and one of quat, axisangle, xyaxes, zaxis, euler.
bool hn_mj_frame(hn_mj *m, const hn_mj_element *e, hn_im_frame *out);
/// Names what is not used of an element, by the rules for its name.
void hn_mj_check(hn_mj *m, const xmlNode *node);

// ---- reading it all ----
/// Puts the files that a model includes in their places; 0 after a fault.
bool hn_im_include(hn_build *b, xmlDoc *doc, const hn_import_source *source);
/// Reads the element <mujoco> into `b`; 0 after a fault.
bool hn_im_read_mjcf(hn_build *b, const xmlNode *root, const hn_import_source *source);

// ---- sections ----
void hn_mj_defaults(hn_mj *m, const xmlNode *section);
void hn_mj_world(hn_mj *m, const xmlNode *section);
void hn_mj_equality(hn_mj *m, const xmlNode *section);
void hn_mj_actuators(hn_mj *m, const xmlNode *section);

/// The joints of a body, in the order they act, between it and its parent.
void hn_mj_join(hn_mj *m, const xmlNode *body_node, const xmlNode *childclass, int parent, int body,
                const hn_im_frame *local);
/// One geom of a body (or HN_GROUND): its share of the mass, and what it can touch.
void hn_mj_geom(hn_mj *m, const xmlNode *node, const xmlNode *childclass, const hn_im_frame *at,
                int body, int needed, hn_im_mass *sum);
/// Keeps the bits that say what a geom can touch. 0 after a fault.
bool hn_mj_add_geom(hn_mj *m, const hn_mj_element *e, int body);
/// Notes, once all bodies are read, that geoms can touch in MuJoCo and cannot here.
void hn_mj_tell_contacts(hn_mj *m);
/// Mass of a body from its `inertial` element; 0 after a fault.
bool hn_mj_inertial(hn_mj *m, const xmlNode *node, hn_im_mass *out);
#endif
