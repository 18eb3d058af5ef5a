// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_MODEL_MODEL_JSON_H
#define HN_SESSION_MODEL_MODEL_JSON_H
// Documents that describe a scene: the list of scenes, one scene for the page, its assembly.

#include "session/model/model.h"

/// Writes all shipped scenes:
/// {"scenes":[{"id","title","about","kind","dof","parameters":[...]}...]}. A scene that does not
/// load is listed with its "errors".
void hn_scenes_json(hn_strbuf *b, const hn_library *lib);
/// Writes the data from which the page draws and sets up a scene: id, title, about, look_for, kind,
/// parameters, coordinates, rows, bodies, joints, n, m, rank, dof, caption, assembly, drawing,
/// points (at the start), envelope, methods, duration, step.
void hn_model_json(hn_strbuf *b, const hn_model *model);
/// Writes into the open object "ok": whether the loops are closed at the start; if they are not,
/// also "reason" and "hint".
void hn_model_closed_put(hn_strbuf *b, const hn_model *model);
/// Writes the assembly report, with the start in user coordinates.
void hn_model_assembly_json(hn_strbuf *b, const hn_model *model);
#endif
