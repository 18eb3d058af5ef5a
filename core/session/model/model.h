// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_H
#define HN_SESSION_MODEL_H
// A model: a scene, loaded, compiled and assembled; and the documents (JSON, text) that both the
// command line and the HTTP interface return. The server uses this layer only, and nothing below
// it.

#include "base/diag.h"
#include "base/strbuf.h"
#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/drawing.h"
#include "dynamics/compile/system.h"
#include "session/model/library.h"

#include <stdbool.h>

typedef struct hn_model hn_model;

/// The scene to load: exactly one of name, path and text is set. `name` is a shipped scene; an
/// unknown name is reported with the nearest known one.
typedef struct hn_model_source {
    const char *name, *path;
    const char *text; ///< scene JSON
    size_t n_text;
    const char
        *id; ///< of a text: what the scene is called when it does not say itself; may be NULL
    const hn_setting *settings;
    int n_settings;
    /// 1: a scene that cannot be assembled still gives a model, for `inspect`, which reports why
    bool allow_open;
    /// 1: the reason of an open loop does not name the parameters that differ from the scene's
    bool hides_changes;
    const int *pulls; ///< drawn points that a hand may pull while it runs (hn_scene_add_pull)
    int n_pulls;
    /// ends the work early, now or when the model is used later: HN_ERR_STOPPED
    hn_interrupt interrupt;
} hn_model_source;

/// Reads and compiles the scene of `source`. Returns owned in *out. Fails: HN_ERR_INPUT,
/// HN_ERR_LIMIT, HN_ERR_MEMORY and others, reported in diags.
HN_MUST_CHECK hn_status hn_model_load(const hn_library *lib, const hn_model_source *source,
                                      hn_model **out, hn_diags *diags);
void hn_model_free(hn_model *model);
/// Borrowed: what was read.
const hn_scene *hn_model_scene(const hn_model *model);
/// Returns the path at which the reference solution of the shipped scene of this id is stored
/// (references.h); NULL when no shipped scene has this id.
const char *hn_model_reference_path(const hn_model *model);
const hn_system *hn_model_system(const hn_model *model);
/// Returns the methods that a comparison uses by default: those that the scene names; otherwise one
/// that drifts, one that stabilises and one that projects, or for a tree two integrators.
const char *const *hn_model_methods(const hn_model *model, int *n);
/// Returns the method that a run uses by default: the first of hn_model_methods() that projects or
/// stabilises the constraints; if there is none, the first.
const char *hn_model_method(const hn_model *model);
const hn_assembly *hn_model_assembly(const hn_model *model);
/// Returns the reason why the loops cannot be closed at the start, as assembly reports it; NULL
/// when they are closed. Without allow_open they always are.
const hn_diag *hn_model_why_open(const hn_model *model);
const double *hn_model_q(const hn_model *model); ///< assembled start, system coordinates
const double *hn_model_v(const hn_model *model);

/// One entry of a state in user coordinates. Coordinates without an entry keep the assembled start.
typedef struct hn_state_entry {
    const char *name; ///< coordinate (position) or rate name
    double value;
} hn_state_entry;

// documents ----
typedef enum hn_equation_form {
    HN_EQUATIONS_TEXT,
    HN_EQUATIONS_LATEX,
    HN_EQUATIONS_JSON
} hn_equation_form;

#endif
