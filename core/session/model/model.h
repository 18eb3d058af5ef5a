// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_H
#define HN_SESSION_MODEL_H
// A model: a scene loaded, compiled and assembled; and the documents (JSON, text) that the command line and the HTTP
// interface both hand out. One door for server/: nothing there looks below this layer.

#include "base/diag.h"
#include "base/strbuf.h"
#include "dynamics/assembly/assemble.h"
#include "dynamics/compile/drawing.h"
#include "dynamics/compile/system.h"
#include "session/model/library.h"

typedef struct hn_model hn_model;

/// Exactly one of name, path, text is set. `name` is a shipped scene (near-miss suggestion when unknown).
typedef struct hn_model_source {
    const char *name, *path;
    const char *text; ///< scene JSON
    size_t n_text;
    const char
        *id; ///< of a text: what the scene is called when it does not say itself; may be NULL
    const hn_setting *settings;
    int n_settings;
    int allow_open; ///< 1: a scene that cannot be assembled is still a model (for inspect); its report says why
} hn_model_source;

HN_MUST_CHECK hn_status hn_model_load(const hn_library *lib, const hn_model_source *source,
                                      hn_model **out, hn_diags *diags);
void hn_model_free(hn_model *model);
const hn_scene *hn_model_scene(const hn_model *model);
/// Where the reference solution of the shipped scene of this id would stand (references.h); NULL: no shipped scene has its id.
const char *hn_model_reference_path(const hn_model *model);
const hn_system *hn_model_system(const hn_model *model);
const hn_assembly *hn_model_assembly(const hn_model *model);
/// What keeps the loops of the start from closing, told as assembly tells it; NULL: they are closed (always unless allow_open).
const hn_diag *hn_model_why_open(const hn_model *model);
const double *hn_model_q(const hn_model *model); ///< assembled start, system coordinates
const double *hn_model_v(const hn_model *model);

/// A state in user coordinates that differs from the assembled start where entries are given (by coordinate name).
typedef struct hn_state_entry {
    const char *name; ///< coordinate (position) or rate name
    double value;
} hn_state_entry;

/// q (nq), v (nv) in system coordinates: the start with the entries put in their places; nothing else moves, so
/// the loops may open. Unknown names are told with the nearest one (pointer "/state/NAME").
HN_MUST_CHECK hn_status hn_model_state(const hn_model *model, const hn_state_entry *entries,
                                       int n_entries, double *q, double *v, hn_diags *diags);

// documents ---------------------------------------------------------------------------------------------------
/// Every shipped scene: {"scenes":[{"id","title","about","kind","dof","parameters":[...]}...]}; a scene that does not load stands there with its "errors".
void hn_scenes_json(hn_strbuf *b, const hn_library *lib);
/// What a page needs to draw and set up: id, title, about, look_for, kind, parameters, coordinates, rows, n, m, rank, dof, caption,
/// assembly, drawing, points (at the start), envelope, methods, duration, step.
void hn_model_json(hn_strbuf *b, const hn_model *model);
/// sizes, tree, loops, rank, operations kept and left out
HN_MUST_CHECK hn_status hn_model_inspect_json(hn_strbuf *b, const hn_model *model, hn_diags *diags);
/// "ok": whether the loops of the start are closed; if not, "reason" and "hint". Into the object that stands open.
void hn_model_closed_put(hn_strbuf *b, const hn_model *model);
/// assembly report as JSON, with user coordinates
void hn_model_assembly_json(hn_strbuf *b, const hn_model *model);
/// M, h, f, J, gamma, phi, K, acceleration, lambda, energies at one state, in user coordinates, with ranks and sigma; "rows" and "columns" named.
/// "lambda_mark" says in words what the multipliers are worth, and the reactions that rest on them (hn_multiplier_mark).
HN_MUST_CHECK hn_status hn_model_terms_json(hn_strbuf *b, const hn_model *model, double t,
                                            const hn_state_entry *entries, int n_entries,
                                            hn_diags *diags);
/// The same with "reactions" too: what every joint and constraint carries (reactions_json.h).
HN_MUST_CHECK hn_status hn_model_terms_json_with_reactions(hn_strbuf *b, const hn_model *model,
                                                           double t, const hn_state_entry *entries,
                                                           int n_entries, hn_diags *diags);
typedef enum hn_equation_form {
    HN_EQUATIONS_TEXT,
    HN_EQUATIONS_LATEX,
    HN_EQUATIONS_JSON
} hn_equation_form;
/// The equations of motion with parameters as symbols.
HN_MUST_CHECK hn_status hn_model_equations(hn_strbuf *b, const hn_model *model,
                                           hn_equation_form form, hn_diags *diags);

#endif
