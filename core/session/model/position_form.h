// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_POSITION_FORM_H
#define HN_SESSION_POSITION_FORM_H
// The configuration as a function of the independent coordinates, q = f(q_r), printed with the
// equations of a scene. The independent coordinates are those that the reduced method chooses at
// the start. The dependent ones have a closed form where the loops decompose into dyads.

#include "base/arena.h"
#include "base/strbuf.h"
#include "dynamics/analyse/dyads.h"
#include "formulations/chart/chart.h"
#include "session/model/model.h"

/// Plain data; release with hn_position_form_free() before the system that it was made for.
typedef struct hn_position_form {
    hn_arena *arena;
    hn_chart chart;       ///< chosen and located at the start
    int exists;           ///< 0: no set of independent coordinates; chart.why gives the reason
    const hn_system *sys; ///< of the dyads
    hn_dyads *dyads;      ///< NULL without loops or if exists is 0; signs as at the start
} hn_position_form;

/// Creates the position form. `symbolic`: the same scene compiled with its parameters as symbols;
/// NULL: numbers only. Numbers replace the symbols where the closed form depends on a parameter's
/// value (a direction along an axis). Adds nodes to the graph.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_position_form_create(const hn_model *model, const hn_system *symbolic,
                                                hn_position_form *out);
void hn_position_form_free(hn_position_form *f);
/// Returns the name of a system coordinate: of its entry in q, or, for a rate of a spherical joint,
/// of the scene's coordinate.
const char *hn_position_name(const hn_system *sys, int coordinate);
/// Writes how the dependent coordinates are found: "dyads: closed form (1 of them)", "Newton,
/// because ...", "none: ...".
void hn_position_answer(const hn_position_form *f, char *text, size_t size);

/// Writes the form as text, or as align* blocks. Both write nothing for a mechanism without loops.
void hn_position_form_text(hn_strbuf *b, const hn_position_form *f);
void hn_position_form_latex(hn_strbuf *b, const hn_position_form *f);
/// Puts "position" into the object open in `b`: {"independent", "answers", "steps": [{"kind",
/// "meets", "rows", "sign"?: {"name", "value"}, "parts": [line], "unknowns": [line]}]}, a line
/// being {"name", "text", "name_latex", "latex"}.
void hn_position_form_json(hn_strbuf *b, const hn_position_form *f);
#endif
