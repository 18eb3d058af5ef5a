// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_H
#define HN_SESSION_MODEL_H
// A model: a scene loaded, compiled and assembled; and the documents (JSON, text) that the command
// line and the HTTP interface both hand out. One door for server/: nothing there looks below this
// layer.

#include "base/diag.h"
#include "base/strbuf.h"
#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/drawing.h"
#include "dynamics/compile/system.h"
#include "session/model/library.h"

typedef struct hn_model hn_model;

/// Exactly one of name, path, text is set. `name` is a shipped scene (near-miss suggestion when
/// unknown).
typedef struct hn_model_source {
    const char *name, *path;
    const char *text; ///< scene JSON
    size_t n_text;
    const char
        *id; ///< of a text: what the scene is called when it does not say itself; may be NULL
    const hn_setting *settings;
    int n_settings;
    /// 1: a scene that cannot be assembled is still a model (for inspect); its report says why
    int allow_open;
} hn_model_source;

HN_MUST_CHECK hn_status hn_model_load(const hn_library *lib, const hn_model_source *source,
                                      hn_model **out, hn_diags *diags);
void hn_model_free(hn_model *model);
const hn_scene *hn_model_scene(const hn_model *model);
/// Where the reference solution of the shipped scene of this id would stand (references.h); NULL:
/// no shipped scene has its id.
const char *hn_model_reference_path(const hn_model *model);
const hn_system *hn_model_system(const hn_model *model);
/// Returns the methods to compare where none is asked for: the scene's own, or where it names none
/// a method that drifts, one that is pulled back and one that is projected (of a tree: two
/// integrators).
const char *const *hn_model_methods(const hn_model *model, int *n);
/// Returns the method to run where none is asked for: the first of hn_model_methods() that keeps
/// the loops closed or pulls them back, else the first.
const char *hn_model_method(const hn_model *model);
const hn_assembly *hn_model_assembly(const hn_model *model);
/// What keeps the loops of the start from closing, told as assembly tells it; NULL: they are closed
/// (always unless allow_open).
const hn_diag *hn_model_why_open(const hn_model *model);
const double *hn_model_q(const hn_model *model); ///< assembled start, system coordinates
const double *hn_model_v(const hn_model *model);

/// A state in user coordinates that differs from the assembled start where entries are given (by
/// coordinate name).
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
