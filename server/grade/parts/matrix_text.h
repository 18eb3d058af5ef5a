// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_MATRIX_TEXT_H
#define HN_GRADE_MATRIX_TEXT_H
// Formulas of matrices as people type them, evaluated with numbers:
//
//     N' M N     N^T*M*N     N.T @ M @ N     N^{\top} M N     transpose(N)*M*N     inv(M)*J'
//
// Products stand side by side or with * or @; ' and ^T transpose; inv() and ^-1 invert; + - and
// brackets; numbers multiply and divide. \dot{N}, N_dot and dN are the name Ndot.
// A.B is the product too, A.*B and A.^2 go entry by entry, M\x is inv(M)*x. What can be read in two
// ways, or not at all, is refused with its column.

#include "base/strbuf.h"
#include "grade/parts/matrix.h"

/// Finds the matrix of a name; NULL when there is none.
typedef const hn_matrix *(*hn_matrix_lookup)(void *user, const char *name);

typedef struct hn_matrix_names {
    hn_matrix_lookup lookup;
    void *user;
    const char *const *known; ///< for suggestions
    int n_known;
} hn_matrix_names;

/// Evaluates a text of at most 1,000 characters, nested at most 40 deep.
/// Fails: HN_ERR_INPUT (cannot be read, with the column; or the name is unknown),
/// HN_ERR_UNSUPPORTED (shapes do not fit, with both), HN_ERR_SINGULAR (an inverse that is not
/// there), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_matrix_eval(const char *text, const hn_matrix_names *names,
                                       hn_arena *arena, hn_matrix *out, hn_diag *diag);
/// The same, and writes the text as it was read: "N'*M*N" of N^{\top} M N.
HN_MUST_CHECK hn_status hn_matrix_read(const char *text, const hn_matrix_names *names,
                                       hn_arena *arena, hn_matrix *out, hn_strbuf *read,
                                       hn_diag *diag);

#endif
