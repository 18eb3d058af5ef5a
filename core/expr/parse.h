// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_PARSE_H
#define HN_EXPR_PARSE_H
// Formulas as people type them: l1*cos(th1) - d, -x^2 (= -(x^2)), 2^-3^2 (right associative), 1e-3,
// pi, 3 l1? (no implicit product: the error says so and shows where), functions of the operator
// table. ** is ^.

#include "base/diag.h"
#include "expr/graph.h"

/// Finds what a name stands for: writes *out and returns 1, or returns 0 when unknown.
typedef int (*hn_name_lookup)(void *user, const char *name, hn_ex *out);

typedef struct hn_parse_opts {
    hn_name_lookup lookup; ///< names of this context; pi, e are built in unless lookup knows them
    void *user;
    const char *const *known; ///< names to suggest for a near miss
    int n_known;
    int max_depth; ///< nesting allowed, 0: 200
    int max_chars; ///< 0: 20000
    /// advice where a formula is too long or too deep; NULL: "split it with parameters"
    const char *shorten;
} hn_parse_opts;

/// The expression of `text`. Fails with HN_ERR_INPUT and a diag that has the column, what was found
/// and, for an unknown name or function, the nearest known one. 1/0 and log(-1) written with
/// numbers are errors too.
HN_MUST_CHECK hn_status hn_parse(hn_graph *g, const char *text, const hn_parse_opts *opts,
                                 hn_ex *out, hn_diag *diag);

#endif
