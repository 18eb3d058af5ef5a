// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_DRAW_H
#define HN_GRADE_DRAW_H
// Numbers drawn from a seed: the parameters of one variant of an exercise, and the random states at
// which formulas are compared. The same seed gives the same numbers on every machine.
//
// Names are an object {"l1": {"range": [0.4, 0.9], "digits": 2, "unit": "m"}, "g": {"value": 9.81},
// "n": {"choose": [2, 3, 5]}, "d": {"formula": "l1 + 0.2"}}. A formula may use the names before it.
// "hidden": true keeps a number out of the documents for students.
// Conditions are formulas that must be positive; numbers are drawn until all are.

#include "base/diag.h"
#include "base/strbuf.h"
#include "expr/graph.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

enum { HN_DRAW_NAMES = 64, HN_DRAW_STATES = 16, HN_DRAW_CONDITIONS = 24 };

/// The origin of the number of a name.
typedef enum hn_draw_origin {
    HN_DRAW_FIXED,  ///< the same in every variant
    HN_DRAW_DRAWN,  ///< from a range or a list
    HN_DRAW_DERIVED ///< from other names
} hn_draw_origin;

typedef struct hn_draw {
    hn_graph *graph; ///< owned; its symbols are the names in their order
    int n_names, n_states;
    int n_outer; ///< the first names, which are given; the others are the part's own
    const char *name[HN_DRAW_NAMES], *unit[HN_DRAW_NAMES]; ///< borrowed from the JSON
    hn_draw_origin origin[HN_DRAW_NAMES];
    int refused[HN_DRAW_CONDITIONS]; ///< draws for which this condition was the first not to hold
    int digits[HN_DRAW_NAMES];       ///< decimals of a drawn number; -1: as many as it has
    double value[HN_DRAW_STATES][HN_DRAW_NAMES];
} hn_draw;

/// Draws n_states states. The names of `outer` (may be NULL; its first state) come first and are
/// the same in every state. `names` and `conditions` may be NULL.
/// Fails: HN_ERR_INPUT (the exercise is at fault), HN_ERR_MEMORY. hn_draw_reset() in any case.
HN_MUST_CHECK hn_status hn_draw_init(hn_draw *d, const cJSON *names, const cJSON *conditions,
                                     const hn_draw *outer, int n_states, uint64_t seed,
                                     hn_diag *diag);
void hn_draw_reset(hn_draw *d);
/// One formula in these names; theta_1 and theta1 stand for th1 where th1 is a name.
HN_MUST_CHECK hn_status hn_draw_parse(hn_draw *d, const char *text, hn_ex *out, hn_diag *diag);
/// One formula of an answer. Other spellings (thetadot1, omega1) are looked for among the part's
/// own names before those that are given, and a given angle or rate is read as the part's own of
/// that index: t1 as th1, w1 as u1. Fails: HN_ERR_INPUT (also for a spelling of two names; `diag`
/// names both), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_draw_parse_answer(hn_draw *d, const char *text, hn_ex *out,
                                             hn_diag *diag);
/// Returns whether a name has the unit of an angle or of an angular velocity.
bool hn_draw_turns(const hn_draw *d, int i);
/// The name that a name of an answer stands for, borrowed; NULL: none, or more than one.
const char *hn_draw_answer_name(hn_draw *d, const char *name);
double hn_draw_eval(hn_draw *d, hn_ex e, int state);
/// The values at all states.
void hn_draw_eval_all(hn_draw *d, hn_ex e, double out[HN_DRAW_STATES]);
/// The value of a formula in the first state.
HN_MUST_CHECK hn_status hn_draw_value(hn_draw *d, const char *text, double *out, hn_diag *diag);
/// Copies text with {name} replaced by the drawn number and {=formula} by its value with four
/// digits; a brace that is neither stays.
void hn_draw_text(hn_strbuf *b, hn_draw *d, const char *text);
/// Finds the first {name} or {=formula} of a text that hn_draw_text() leaves as it stands, though
/// it looks like one: letters, digits and _ between the braces, or = at first. Writes it without
/// braces; false: there is none.
bool hn_draw_find_unknown(hn_draw *d, const char *text, char *word, size_t size);
/// The k-th random number in [0, 1) of a seed.
double hn_draw_random(uint64_t seed, uint64_t k);
/// 1 when the name is an angle: its unit is rad or deg.
int hn_draw_is_angle(const hn_draw *d, int name);
#endif
