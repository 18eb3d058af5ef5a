// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_WANTED_H
#define HN_SESSION_PRECISION_WANTED_H
// The answer to "which method is the cheapest for an error of 1 mm?", from the points of a
// work-precision study.

#include "session/precision/study.h"

/// The size between two points is read off for this share of the error that is wanted: between two
/// points it was up to 1.6 times that of the line.
#define HN_WANTED_MARGIN 0.5

/// An accuracy as people type it.
typedef struct hn_wanted {
    double error;    ///< relative, as the study ranks it (study/truth/errors.h)
    char words[144]; ///< "an error of 1 mm at the end of a bar of 1.20 m (0.000833 of its length)"
} hn_wanted;

/// Reads "1 mm" (as a share of `length`, the characteristic one [m]), "0.1 %", "1 mrad", "2 deg" or
/// a plain number. Returns false where the text is none of these or not above 0.
bool hn_wanted_read(const char *text, double length, hn_wanted *out);

/// Writes one sentence: the method with the fewest operations that is accurate enough, with its
/// step or tolerance, the next one, and the methods that do not reach the error. The size is read
/// off between two points of the study by a straight line in the logarithms, for half the error.
///
/// spelling  out  the cheapest method with that size, rounded down to two digits; "": no method
///                reaches the error
void hn_wanted_text(hn_strbuf *b, const hn_study *study, const hn_wanted *wanted,
                    char spelling[HN_SPEC_MAX]);
#endif
