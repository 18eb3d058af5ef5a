// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_MODEL_JSON_H
#define HN_SESSION_MODEL_MODEL_JSON_H
// The documents that describe a scene: the list of scenes, one scene for a page, its assembly.

#include "session/model/model.h"

/// Every shipped scene: {"scenes":[{"id","title","about","kind","dof","parameters":[...]}...]}; a
/// scene that does not load stands there with its "errors".
void hn_scenes_json(hn_strbuf *b, const hn_library *lib);
/// What a page needs to draw and set up: id, title, about, look_for, kind, parameters, coordinates,
/// rows, n, m, rank, dof, caption, assembly, drawing, points (at the start), envelope, methods,
/// duration, step.
void hn_model_json(hn_strbuf *b, const hn_model *model);
/// "ok": whether the loops of the start are closed; if not, "reason" and "hint". Into the object
/// that stands open.
void hn_model_closed_put(hn_strbuf *b, const hn_model *model);
/// assembly report as JSON, with user coordinates
void hn_model_assembly_json(hn_strbuf *b, const hn_model *model);
#endif
