// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_VERDICT_FORMS_H
#define HN_GRADE_VERDICT_FORMS_H
// The forms in which a verdict can be written: one table.

#include "grade/verdict.h"

/// Data that a form may need besides the verdict.
typedef struct hn_verdict_extra {
    double seconds;         ///< [s] that grading took
    bool first;             ///< of several verdicts on one output
    const char *submission; ///< of several on one output: which it is; NULL: there is one
    const hn_strbuf *png;   ///< the picture of a state where a wrong entry shows; NULL: none
} hn_verdict_extra;

typedef struct hn_verdict_form {
    const char *name, *ending; ///< of the form, and of its files
    bool results;              ///< the platform reads one file of the name "results"
    bool pictures;             ///< holds the picture itself
    const char *head, *tail;   ///< around all verdicts of one output
    void (*write)(hn_strbuf *b, const hn_verdict *v, const hn_verdict_extra *x);
} hn_verdict_form;

/// The form of a name. Fails: HN_ERR_INPUT, with a suggestion.
HN_MUST_CHECK hn_status hn_verdict_form_find(const char *name, const hn_verdict_form **out,
                                             hn_diag *diag);
/// The first form whose files end as `path` does; NULL: none.
const hn_verdict_form *hn_verdict_form_of_file(const char *path);
#endif
