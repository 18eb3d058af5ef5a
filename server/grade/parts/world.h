// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_WORLD_H
#define HN_GRADE_WORLD_H
// Random matrices under the names of an exercise, with the properties that the names stand for.
//
//     "sizes": {"n": 5, "m": 2},
//     "matrices": {"M": ["spd", "n"], "J": ["any", "m", "n"], "N": ["null", "J"],
//                  "h": ["any", "n", 1], "gamma": ["is", "J * h"]}
//
// spd: symmetric positive definite; any: entries between -1 and 1; null: a basis of the null space
// of a matrix named before, with columns that are not orthogonal; is: a formula (matrix_text.h).

#include "grade/parts/matrix_text.h"
#include "grade/parts/part.h"

enum { HN_WORLD_NAMES = 24 };

typedef struct hn_world {
    hn_arena *arena;
    int n;
    const char *name[HN_WORLD_NAMES]; ///< borrowed from the JSON
    hn_matrix matrix[HN_WORLD_NAMES];
} hn_world;

/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY. hn_world_reset() in any case.
HN_MUST_CHECK hn_status hn_world_init(hn_world *w, const hn_part *p, uint64_t seed, hn_diag *diag);
void hn_world_reset(hn_world *w);
/// A formula in the names of this world.
HN_MUST_CHECK hn_status hn_world_eval(hn_world *w, const char *text, hn_matrix *out, hn_diag *diag);
/// Writes a formula as it is read.
HN_MUST_CHECK hn_status hn_world_read(hn_world *w, const char *text, hn_strbuf *read,
                                      hn_diag *diag);
/// Largest difference relative to the largest entry of b; HUGE_VAL when the shapes differ.
double hn_world_distance(const hn_matrix *a, const hn_matrix *b, double factor);
/// Adds a matrix of numbers, given as JSON rows (or a list for a column); 0 when it is none or too
/// large. `why` receives the reason.
int hn_world_add(hn_world *w, const char *name, const cJSON *rows, char why[HN_PART_TEXT]);
#endif
