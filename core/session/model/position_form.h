// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_POSITION_FORM_H
#define HN_SESSION_POSITION_FORM_H
// The pose as a function of the independent coordinates, q = f(q_r), as a part of the equations
// that a scene runs: the coordinates that the reduced method chooses at the start, and the closed
// form of the others where the loops fall apart into dyads.

#include "base/arena.h"
#include "base/strbuf.h"
#include "dynamics/analyse/dyads.h"
#include "formulations/chart/chart.h"
#include "session/model/model.h"

/// Plain data; release with hn_position_form_free() before the system that it was made for.
typedef struct hn_position_form {
    hn_arena *arena;
    hn_chart chart;       ///< chosen and located at the start
    int exists;           ///< 0: no coordinates to choose, chart.why says why
    const hn_system *sys; ///< of the dyads
    hn_dyads *dyads; ///< NULL without loops, or where exists is 0; with the branches of the start
} hn_position_form;

/// `symbolic`: the same scene with its parameters kept as symbols; NULL for numbers. Where
/// parameters hide the form that their numbers show (a direction along an axis), it is written with
/// numbers. Adds nodes to the graph. Fails: HN_ERR_MEMORY, HN_ERR_LIMIT.
HN_MUST_CHECK hn_status hn_position_form_create(const hn_model *model, const hn_system *symbolic,
                                                hn_position_form *out);
void hn_position_form_free(hn_position_form *f);
/// The name of a system coordinate: its entry of q, or for a ball's speed that of the scene's
/// coordinate.
const char *hn_position_name(const hn_system *sys, int coordinate);
/// "dyads: closed form (1 of them)", "Newton, because ...", "none: ...".
void hn_position_answer(const hn_position_form *f, char *text, size_t size);

/// Lines for people, and the same as align* blocks; nothing for a mechanism without loops.
void hn_position_form_text(hn_strbuf *b, const hn_position_form *f);
void hn_position_form_latex(hn_strbuf *b, const hn_position_form *f);
/// Puts "position" into the object open in `b`: {"independent", "answers", "steps": [{"kind",
/// "meets", "rows", "sign"?: {"name", "value"}, "parts": [line], "unknowns": [line]}]}, a line
/// being {"name", "text", "name_latex", "latex"}.
void hn_position_form_json(hn_strbuf *b, const hn_position_form *f);
#endif
