// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_EXAM_CHANGES_H
#define HN_SESSION_EXPORT_EXAM_CHANGES_H
// Changes of an entry of an exam, and of its terms, where one symbol is mistaken for another:
// faults that depend on the state and are no constant factor.

#include "session/export/exam.h"

typedef enum hn_exam_change_kind {
    HN_CHANGE_NAME,       ///< symbol `to` stands where `from` belongs
    HN_CHANGE_ONE,        ///< one factor `to` stands where a factor `from` belongs
    HN_CHANGE_POWER,      ///< a factor `from` too few
    HN_CHANGE_SUM,        ///< angle `from` is counted from `to`: the sum of both
    HN_CHANGE_DIFFERENCE, ///< angle `from` includes `to`: their difference
    HN_CHANGE_QUARTER,    ///< `from` is a quarter turn further: sine and cosine are exchanged
    HN_CHANGE_WITHOUT,    ///< parameter `from` is 0: its terms are missing
    HN_CHANGE_DEGREES,    ///< all angles count in degrees
    HN_CHANGE_RADIANS     ///< all angles were converted to radians, which they are already
} hn_exam_change_kind;

typedef struct hn_exam_change {
    hn_exam_change_kind kind;
    int from, to; ///< symbols
    bool rates;   ///< of two angles: their rates are changed alike
} hn_exam_change;

/// Lists the changes that are possible in entry i of a part. Angles are taken for angles, lengths
/// for lengths; parameters that the mass matrix has are left in. Returns their number, at most
/// `most`.
int hn_exam_changes_list(const hn_export_exam *exam, hn_export_part part, int i,
                         hn_exam_change *out, int most);
/// Writes the changed value of the whole entry at each state, and of each of its terms, in the
/// order of exam->sum. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_exam_change_apply(const hn_export_exam *exam, hn_export_part part, int i,
                                             const hn_exam_change *change,
                                             double whole[HN_EXPORT_EXAM_STATES],
                                             hn_export_sum *terms);
/// Returns whether coordinates are numbers of their own; orientations have four entries of q for
/// three.
bool hn_exam_is_plain(const hn_export_exam *exam);
/// Returns whether coordinate i of a plain exam is an angle.
bool hn_exam_is_angle(const hn_export_exam *exam, int i);
/// Returns the name of a symbol as the exported programs spell it.
const char *hn_exam_symbol_name(const hn_export_exam *exam, int symbol);

#endif
