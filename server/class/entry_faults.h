// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_ENTRY_FAULTS_H
#define HN_CLASS_ENTRY_FAULTS_H
// Common faults in one entry of a part that a student filled in: the values at all states are
// compared with those of the right entry with one of its terms, or two of them, changed.

#include "base/strbuf.h"
#include "session/export/exam.h"

#include <stdbool.h>

/// An entry that is wrong.
typedef struct hn_entry_values {
    const hn_export_sum *sum; ///< its terms
    double right[HN_EXPORT_EXAM_STATES], given[HN_EXPORT_EXAM_STATES];
    double allowed; ///< difference that rounding explains
    bool is_mass;   ///< of the mass matrix: moments of inertia are confused
    const hn_scene *scene;
} hn_entry_values;

/// What may be wrong with it. All explanations that fit are kept: where terms are alike there are
/// several.
typedef struct hn_entry_faults {
    int terms;        ///< of the entry
    uint64_t one;     ///< a bit for each fault of the entry, or of one of its terms
    uint64_t two;     ///< a bit for each two faults of two of its terms; 0 where one explains it
    double factor;    ///< of one term, none of the common ones; 0: none, or one that was found
    char instead[96]; ///< "l4 in place of l1" where that is the factor, else ""
} hn_entry_faults;

/// Finds the faults that explain an entry at every state.
hn_entry_faults hn_entry_faults_find(const hn_entry_values *entry);
/// Returns the least share of the entry's points that one of the explanations leaves, 0: there is
/// none.
double hn_entry_faults_share(const hn_entry_faults *faults);
/// Returns the mistake that the entry is marked as, "" where there is none.
const char *hn_entry_faults_id(const hn_entry_faults *faults);
/// Adds what may be wrong, "one of its 3 terms is missing, or ...".
void hn_entry_faults_put(hn_strbuf *b, const hn_entry_faults *faults);

#endif
