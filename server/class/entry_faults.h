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
    const hn_export_exam *exam;
    hn_export_part part;
    int i;
    const hn_export_sum *sum; ///< its terms
    double right[HN_EXPORT_EXAM_STATES], given[HN_EXPORT_EXAM_STATES];
    double allowed; ///< difference that rounding explains
    const hn_scene *scene;
    bool thorough; ///< also those of a wrong symbol, hundreds of evaluations of the entry
} hn_entry_values;

enum { HN_ENTRY_FAULTS = 6, HN_ENTRY_FAULT_TEXT = 216 };

/// Possible faults of an entry. All explanations that fit are counted: where terms are
/// alike there are several.
typedef struct hn_entry_faults {
    int terms;    ///< of the entry
    int n, found; ///< explanations that are kept, and all of them
    double share; ///< of the entry's points, the least that one of them leaves
    struct hn_entry_fault {
        const char *id;
        double share;
        uint64_t key;                   ///< the same for the same fault of another entry
        int entries;                    ///< that it explains; known after hn_entry_faults_rank()
        char says[HN_ENTRY_FAULT_TEXT]; ///< "one of its 3 terms is missing"
    } fault[HN_ENTRY_FAULTS];
} hn_entry_faults;

/// Finds the faults that explain an entry at every state.
hn_entry_faults hn_entry_faults_find(const hn_entry_values *entry);
/// Puts those explanations of n entries first that explain most of them. One that explains two or
/// more, and more than any other, is the only one that stays.
void hn_entry_faults_rank(hn_entry_faults *all, int n);
/// Returns the mistake that the entry is marked as, "" where there is none.
const char *hn_entry_faults_id(const hn_entry_faults *faults);
/// Adds what may be wrong, "one of its 3 terms is missing, or ...": whole explanations, as many as
/// have room in so many bytes, and at least one.
void hn_entry_faults_put(hn_strbuf *b, const hn_entry_faults *faults, int room);

#endif
