// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_RUBRIC_H
#define HN_GRADE_RUBRIC_H
// A rubric: a teacher's own points, tolerances, shares for mistakes and costs of hints for an
// exercise, in a file beside it.
//
//     {"rubric": 1, "exercise": "fourbar", "total": 10,
//      "points": {"a": 1, "b": 3}, "tolerance": {"a": {"relative": 0.01}},
//      "shares": {"sign": 0.5, "degrees": 0}, "hints": [0.5, 1],
//      "visibility": {"b": "after_due_date"}}
//
// In a file whose name ends with .toml the same stands as TOML: rubric = 1, [points], a = 1.
// All but the first two fields may be left out; the exercise's own values then hold. A part has the
// name of the exercise's file; an exercise with one matrix has one part, of the matrix's name.
// "visibility" says when Gradescope shows the verdict on a part, in Gradescope's words; other forms
// of a verdict show all parts.

#include "base/diag.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct hn_rubric hn_rubric;

/// Reads a rubric. Faults say their line, and a nearest name. Returns owned; also one whose fields
/// are at fault, so that all faults can be reported at once (*out is NULL where it names no
/// exercise).
/// Fails: HN_ERR_IO, HN_ERR_INPUT, HN_ERR_LIMIT, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_rubric_load_file(const char *path, hn_rubric **out, hn_diags *diags);
/// Returns whether a file's name says that it holds TOML.
bool hn_rubric_is_toml(const char *path);
void hn_rubric_free(hn_rubric *rubric);             ///< NULL is legal
const char *hn_rubric_exercise(const hn_rubric *r); ///< id of the exercise that it is for
const char *hn_rubric_file(const hn_rubric *r);     ///< name without folders; "" for NULL
uint64_t hn_rubric_hash(const hn_rubric *r);        ///< of the file's text; 0 for NULL
/// The share of the points that a mistake earns; `otherwise` where the rubric, which may be NULL,
/// says nothing.
double hn_rubric_share(const hn_rubric *r, const char *mistake, double otherwise);
/// When the verdict on a part is shown: "visible" where the rubric, which may be NULL, says
/// nothing. `entry` is the part's name, or begins with it: "b.2", "J11".
const char *hn_rubric_visibility(const hn_rubric *r, const char *entry);
/// The points that the first n hints cost.
double hn_rubric_hints_cost(const hn_rubric *r, int n);

// ---- for rubric_apply.c ----

/// A field of the file; NULL when it is not there.
const cJSON *hn_rubric_section(const hn_rubric *r, const char *name);
/// Reports a fault at the line of `key` (may be NULL) within a field. Returns HN_ERR_INPUT.
hn_status hn_rubric_fault(const hn_rubric *r, hn_diags *diags, const char *section, const char *key,
                          const char *hint, const char *format, ...) HN_PRINTF(6, 7);
/// Puts the faults of a rubric into the order of the lines that they name.
void hn_rubric_sort_faults(hn_diags *diags);
#endif
