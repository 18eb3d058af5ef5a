// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_BUILD_H
#define HN_IMPORT_BUILD_H
// A mechanism on its way from a file to a scene: both readers fill it, write.c writes it as JSON.
// Everything lives in one arena and is freed at once. `world` is a pose at the file's zero
// configuration.

#include "base/arena.h"
#include "base/strbuf.h"
#include "import/frame.h"
#include "import/import.h"
#include "import/libxml.h"
#include "scene/scene.h"

#include <stdbool.h>

/// One of a model's files; a pointer to it stands in _private of the elements of those that are
/// included.
typedef struct hn_im_file {
    const char *name;
    int order, depth;            ///< in which it was met; 0: the model's own
    struct hn_im_file *includer; ///< NULL: none
} hn_im_file;

typedef struct hn_im_body {
    const char *source; ///< its name in the file, or NULL
    const char *name;   ///< in the scene
    const char *about;
    hn_im_mass mass;
    bool has_mass;
    const char *line; ///< "line 3", "leg.xml, line 3"
    bool is_carrier;  ///< between several joints of one body
    hn_im_frame world;
} hn_im_body;

typedef struct hn_im_joint {
    const char *source, *name, *about;
    hn_joint_type type;
    int parent, child; ///< HN_GROUND
    double parent_at[3], child_at[3], parent_axis[3], child_axis[3], parent_ref[3], child_ref[3];
    const char *line;
    int cut, actuated, limited;
    double min, max;
    int n; ///< coordinates
    const char *coordinate[6], *rate[6];
    double q0[6], v0[6];
    double zero; ///< of a joint with one coordinate: its value in the file's zero configuration
} hn_im_joint;

/// JSON texts that are copied into a list of the scene: loads, constraints, joints of the loop
/// file.
typedef struct hn_im_texts {
    int n, cap;
    const char **item;
} hn_im_texts;

typedef struct hn_im_param {
    const char *name, *unit, *about;
    double value, min, max; ///< -HUGE_VAL, HUGE_VAL: none
} hn_im_param;

typedef struct hn_build {
    hn_arena *arena;
    hn_diags *diags;
    hn_status status; ///< of the first fault
    const char *format, *name, *about;
    hn_im_file *files; ///< HN_IMPORT_MAX_FILES, the model's own first
    int n_files;
    hn_im_body *bodies;
    hn_im_joint *joints;
    hn_im_param *params;
    hn_import_note *notes;
    int n_bodies, cap_bodies, n_joints, cap_joints, n_params, cap_params, n_notes, cap_notes;
    hn_im_texts loads, constraints, closing;
    const char **used; ///< names in formulas that are taken
    int n_used, cap_used;
    double gravity[3], step;
    int n_own_constraints; ///< before those of the loop file
    int n_closing;         ///< joints and constraints that close loops
    int guess; ///< the start need not satisfy what closes the loops: it is where assembly begins
} hn_build;

// ---- files ----
/// The list of files, with the model's own in it; `name` may be NULL. 0 without memory.
bool hn_im_begin_files(hn_build *b, const char *name);
hn_im_file *hn_im_file_of(const hn_build *b, const xmlNode *node);
/// "line 12", or "leg.xml, line 12" in an included file; in the arena, never NULL.
const char *hn_im_line(hn_build *b, const hn_im_file *file, long line);
const char *hn_im_line_of(hn_build *b, const xmlNode *node);

// ---- faults and notes ----
/// "line 12: ..." at the node (and its attribute, which may be NULL). Always returns 0.
bool hn_im_fault(hn_build *b, const xmlNode *node, const char *attribute, const char *hint,
                 const char *format, ...) HN_PRINTF(5, 6);
bool hn_im_out_of_memory(hn_build *b); ///< notes it; returns 0
void hn_im_note(hn_build *b, hn_import_outcome outcome, const xmlNode *node, const char *attribute,
                const char *format, ...) HN_PRINTF(5, 6);

// ---- building; each gives -1 after a fault ----
int hn_im_add_body(hn_build *b, const xmlNode *node, const char *source, const hn_im_frame *world);
/// `joint` with its names still to be chosen from `wanted`; counts and names its coordinates.
int hn_im_add_joint(hn_build *b, const xmlNode *node, const hn_im_joint *joint, const char *wanted);
/// A parameter named after `wanted`.
int hn_im_add_param(hn_build *b, const xmlNode *node, const hn_im_param *param, const char *wanted);
/// Takes the buffer's text (and empties it).
bool hn_im_add_text(hn_build *b, hn_im_texts *list, hn_strbuf *text);

int hn_im_find_body(const hn_build *b, const char *source);  ///< -2 if there is none
int hn_im_find_joint(const hn_build *b, const char *source); ///< -1 if there is none
/// A name for people made from one of the file: no braces, at most 60 characters.
const char *hn_im_label(hn_build *b, const char *wanted);
const char *hn_im_text(hn_build *b, const char *format, ...) HN_PRINTF(2, 3); ///< in the arena
/// Room for one more item; the list, moved if need be, or NULL.
void *hn_im_grow(hn_build *b, void *list, int n, int *cap, size_t size);

/// Sets the frames of the joint in its parent and in its child: z is its axis, x its reference
/// direction.
void hn_im_set_sides(hn_im_joint *joint, const hn_im_frame *in_parent, const hn_im_frame *in_child);
/// The frame at a place with a given axis (length 1), x across it.
hn_im_frame hn_im_axis_frame(const double at[3], const double axis[3]);
/// "(1.25)": a number in a formula, that reads back to the same double; in the arena, never NULL.
const char *hn_im_number(hn_build *b, double x);

#endif
