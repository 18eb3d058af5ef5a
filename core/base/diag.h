// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_DIAG_H
#define HN_BASE_DIAG_H
// The report of a fault, for the person who mends it: where (a JSON pointer or a column), what was
// found, what is allowed, what to try. Plain data; a list holds the first few.

#include "base/status.h"

enum { HN_DIAG_POINTER = 192, HN_DIAG_MESSAGE = 512, HN_DIAG_HINT = 192, HN_DIAG_MAX = 16 };

typedef struct hn_diag {
    hn_status status;
    char pointer[HN_DIAG_POINTER]; ///< JSON pointer of the field at fault ("/joints/2/axis"), or ""
    char message[HN_DIAG_MESSAGE]; ///< one sentence: what was found, what is allowed
    char hint[HN_DIAG_HINT];       ///< what to try ("did you mean 'revolute'?"), or ""
    int column;                    ///< 1-based column in a formula, 0 when it does not apply
} hn_diag;

/// The first HN_DIAG_MAX faults; `found` counts all of them. Start from {0}.
typedef struct hn_diags {
    int n, found;
    hn_diag item[HN_DIAG_MAX];
} hn_diags;

/// Adds one fault and returns `status`, so that `return hn_diags_add(...)` reads well. `d` may be
/// NULL. `pointer` and `hint` may be NULL. Text too long is cut at a character boundary and ends in
/// "...".
hn_status hn_diags_add(hn_diags *d, hn_status status, const char *pointer, const char *hint,
                       const char *format, ...) HN_PRINTF(5, 6);

/// Fills one diag (message by format); hint and pointer may be NULL; `d` may be NULL. Returns
/// `status`.
hn_status hn_diag_set(hn_diag *d, hn_status status, const char *pointer, const char *hint,
                      const char *format, ...) HN_PRINTF(5, 6);

/// Puts the name of a file before each message from the one of index `from` on, unless the message
/// has it: "wheel.json: ...". `d` may be NULL.
void hn_diags_name_file(hn_diags *d, int from, const char *file);

/// The candidate nearest to `word` by edit distance (transpositions count 1, case ignored), within
/// max(1, strlen(word) / 3); failing that the first that has the word, of four letters or more, in
/// it; else NULL. `names` holds n strings.
const char *hn_nearest_name(const char *word, const char *const *names, int n);

#endif
