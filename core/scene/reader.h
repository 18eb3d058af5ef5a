// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SCENE_READER_H
#define HN_SCENE_READER_H
// Inside scene/ only: what all parts of the loader share. A reader walks the JSON tree, knows where
// it is (path), which repetition it is in ("for"), which names a formula may use, and gathers
// faults instead of stopping at the first.

#include "expr/graph.h"
#include "expr/parse.h"
#include "scene/scene.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

enum {
    HN_RD_MAX_REPEAT = 5000, ///< repetitions of one "for"
    HN_RD_MAX_POINTS = 10000,
    HN_RD_MAX_SHAPES = 10000,
    HN_RD_MAX_LOADS = 4000,
    HN_RD_MAX_TABLE = 10000,  ///< times of a table
    HN_RD_MAX_NAME = 60,      ///< characters of a name
    HN_RD_MAX_TEXT = 4 << 20, ///< characters of all formulas, repetitions counted
    HN_RD_MAX_FAULTS = 64,    ///< then reading stops
    HN_RD_MAX_KINDS = 16,     ///< of loads, of constraints
    HN_RD_MAX_DEPTH = 24      ///< levels of JSON
};

/// The names that a formula may use; each scope includes those before it.
typedef enum hn_rd_scope {
    HN_RD_CONST, ///< parameters (and the repetition's name)
    HN_RD_TIME,  ///< and t
    HN_RD_POSE,  ///< and coordinates
    HN_RD_STATE  ///< and rates
} hn_rd_scope;

/// The kinds of names in formulas.
typedef enum hn_rd_meaning {
    HN_RD_NOTHING,
    HN_RD_PARAM,
    HN_RD_COORDINATE,
    HN_RD_RATE
} hn_rd_meaning;

enum { HN_RD_SLOTS = 1 << 14 }; ///< about twice the names there can be

/// A parameter as written, and how far its evaluation is.
typedef struct hn_rd_param {
    const char *formula;
    double number;
    int state; ///< 0 not yet, 1 being evaluated, 2 done
} hn_rd_param;

typedef struct hn_reader {
    hn_scene *scene;
    hn_arena *arena; ///< the scene's
    hn_graph *graph;
    hn_diags *diags;
    hn_status status; ///< of the first fault
    int n_faults;
    size_t n_text; ///< characters of formulas so far
    bool oom;
    char path[512]; ///< JSON pointer of the place
    // the repetition that is being read
    const char *loop_name;
    long long loop_value;
    // parameters while they are being evaluated
    hn_rd_param *param_src;
    const hn_setting *settings;
    int n_settings;
    bool use_settings, mark_structural;
    int chain[HN_SCENE_MAX_PARAMS], n_chain;
    bool bodies_faulty; ///< some body could not be read: a name that is not found may be its
    int body_at;        ///< the body whose drawing is read
    int shape_kind;     ///< the kind whose list is read
    hn_rd_scope scope;  ///< of the formula that is being parsed
    int turn_refused;   ///< 1 + the entry of a rotation vector that a formula asked for in vain
    struct {
        unsigned char meaning;
        int index;
    } slot[HN_RD_SLOTS]; ///< names of parameters, coordinates, rates: open addressing by hash
} hn_reader;

// ---- where we are, what is wrong ----
size_t hn_rd_enter(hn_reader *r, const char *key); ///< returns what hn_rd_leave() wants
size_t hn_rd_enter_index(hn_reader *r, int index);
void hn_rd_leave(hn_reader *r, size_t mark);
/// Adds a fault at the present place (and names the repetition); returns 0, so that `return
/// hn_rd_fault(...)` reads well.
bool hn_rd_fault(hn_reader *r, const char *hint, const char *format, ...) HN_PRINTF(3, 4);
bool hn_rd_fault_at(hn_reader *r, const char *key, const char *hint, const char *format, ...)
    HN_PRINTF(4, 5);
/// the same with HN_ERR_LIMIT
bool hn_rd_limit(hn_reader *r, const char *format, ...) HN_PRINTF(2, 3);
bool hn_rd_stopped(const hn_reader *r); ///< out of memory, or HN_RD_MAX_FAULTS reached
/// Writes a hint: "did you mean 'x'?", or the list of allowed words.
void hn_rd_suggest(char *out, size_t size, const char *word, const char *const *names, int n);
const char *hn_rd_kind(const cJSON *node); ///< "a number", "a list", ...

// ---- memory: all from the scene's arena ----
/// Returns the list with room for one more item behind the n that it holds. Fails: NULL, and `oom`
/// or a fault about the limit.
void *hn_rd_grow(hn_reader *r, void *items, int n, size_t size, int limit, const char *what);
const char *hn_rd_keep(hn_reader *r, const char *text);
const char *hn_rd_pointer(hn_reader *r); ///< the present path, kept

// ---- the tree ----
/// Checks that `node` is an object and reports members that are not among `fields`. Returns false
/// only when it is no object.
bool hn_rd_object(hn_reader *r, const cJSON *node, const char *what, const char *const *fields,
                  int n_fields);
/// Checks an object of one of several kinds: one member among the n `kinds` names its kind, beside
/// "name" and "for". Returns the index of the kind, -1 after a fault. `what` is "load".
int hn_rd_one_kind(hn_reader *r, const cJSON *node, const char *what, const char *const *kinds,
                   int n);
typedef void (*hn_rd_item)(hn_reader *r, const cJSON *item, const char *key);
/// Calls `item` for each entry of a list, or each member of an object (key: its name), repeated
/// where it says "for".
void hn_rd_each(hn_reader *r, const cJSON *node, hn_rd_item item);
const cJSON *hn_rd_get(const cJSON *object, const char *key);          ///< member or NULL
bool hn_rd_is_list(hn_reader *r, const cJSON *node, const char *what); ///< absent counts as one
/// The member `key` through hn_rd_each(): a list, or an object if `object`.
void hn_rd_list(hn_reader *r, const cJSON *node, const char *key, int object, hn_rd_item item);

// ---- values ----
/// Returns a text unchanged (title, about); NULL if it is absent, or holds a control character that
/// is no line break and no tab: a terminal would obey it.
const char *hn_rd_text(hn_reader *r, const cJSON *object, const char *key, bool required);
/// Returns a name with its {formulas} filled in, checked for length. NULL when it is absent: a
/// fault only if `required`.
const char *hn_rd_name(hn_reader *r, const cJSON *object, const char *key, bool required);
/// Returns `raw` with every {formula} replaced by its whole-number value; NULL after a fault.
const char *hn_rd_fill(hn_reader *r, const char *raw);
bool hn_rd_flag(hn_reader *r, const cJSON *object, const char *key);
/// Reads a number or a formula. After a fault *out is 0 and the result false.
bool hn_rd_quantity(hn_reader *r, const cJSON *node, hn_quantity *out, hn_rd_scope scope);
/// Reads the member `key`; where it is absent, `fallback` (a fault when `required`).
bool hn_rd_member(hn_reader *r, const cJSON *object, const char *key, bool required,
                  double fallback, hn_quantity *out, hn_rd_scope scope);
/// Reads a vector of two (then z = 0) or three entries.
bool hn_rd_vector(hn_reader *r, const cJSON *node, hn_quantity out[3], hn_rd_scope scope);
/// Reads the member `key` as a direction: two or three numbers, not all zero, scaled to length 1.
bool hn_rd_direction(hn_reader *r, const cJSON *object, const char *key, double out[3]);
/// Checks that `ref` (written under `key`) is perpendicular to `axis`, and removes what rounding
/// left of the axis in it.
bool hn_rd_make_normal(hn_reader *r, const char *key, const double axis[3], double ref[3]);
/// Chooses a direction perpendicular to `axis` for a file that gives none: from the coordinate axis
/// least aligned with it, x before y before z.
void hn_rd_default_normal(const double axis[3], double ref[3]);
/// Evaluates a formula in parameters, as in braces and in "for".
bool hn_rd_formula(hn_reader *r, const char *text, hn_rd_scope scope, hn_quantity *out);

// Names in formulas are found in constant time: a scene may hold thousands and use them a million
// times.
/// Makes the name of a parameter or coordinate of the scene known to formulas.
void hn_rd_put_name(hn_reader *r, hn_rd_meaning meaning, int index);
hn_rd_meaning hn_rd_find_name(const hn_reader *r, const char *name, int *index);

// ---- parts of a scene ----
void hn_rd_params(hn_reader *r, const cJSON *root);
bool hn_rd_param_value(hn_reader *r, int k, double *value); ///< evaluates on demand
void hn_rd_bodies(hn_reader *r, const cJSON *root);
void hn_rd_joints(hn_reader *r, const cJSON *root);
void hn_rd_lagrangian(hn_reader *r, const cJSON *root);
/// Adds a constraint that a Lagrangian beside bodies gives as a formula; name NULL: one is made.
void hn_rd_formula_constraint(hn_reader *r, const char *name, const hn_quantity *value);
void hn_rd_points(hn_reader *r, const cJSON *root);
void hn_rd_loads(hn_reader *r, const cJSON *root);
void hn_rd_constraints(hn_reader *r, const cJSON *root);
void hn_rd_shapes(hn_reader *r, const cJSON *root);
void hn_rd_start(hn_reader *r, const cJSON *root);
void hn_rd_draw_default(hn_reader *r, const cJSON *root); ///< what the scene leaves undrawn

/// Adds a coordinate after a check of its names and returns its index, -1 after a fault. `rate`
/// NULL: made from the name.
int hn_rd_add_coordinate(hn_reader *r, const char *name, const char *rate, hn_unit_kind kind,
                         int joint, int actuated);
/// Adds the coordinates of the joint that is being read, with their drives and limits.
void hn_rd_joint_coordinates(hn_reader *r, const cJSON *node, hn_joint *j);
/// Returns the body that the member `key` names ("ground": HN_GROUND), -2 after a fault.
int hn_rd_body(hn_reader *r, const cJSON *object, const char *key);
/// Returns the index of a point, -1 after a fault. It is written as a name, as numbers in the frame
/// of `body`, or as {"body","at"}.
int hn_rd_point(hn_reader *r, const cJSON *node, int body);
/// Returns the index of the unnamed point at this place, made if there is none; -1 without memory.
int hn_rd_place(hn_reader *r, int body, const hn_quantity at[3]);
int hn_rd_add_point(hn_reader *r, const char *name, int body, const hn_quantity at[3]);
hn_shape *hn_rd_add_shape(hn_reader *r, hn_shape_kind kind, int p, int q, int body);

// ---- scene_check.c: facts about the whole scene ----
/// Reports names that one object uses twice.
void hn_rd_check_tree(hn_reader *r, const cJSON *node);
void hn_rd_check_inertia(hn_reader *r, const hn_body *body);
void hn_rd_check_connected(hn_reader *r);
/// Reports a name that is used already: `taken_by` says where, NULL: nowhere.
bool hn_rd_check_new_name(hn_reader *r, const char *name, const char *taken_by);
/// Reports the use of an entry of a rotation vector: its value has a meaning inside its joint only.
bool hn_rd_check_no_turn(hn_reader *r, int coordinate);
/// Reports a name that formulas cannot use, or that they use already.
bool hn_rd_check_identifier(hn_reader *r, const char *name);

#endif
