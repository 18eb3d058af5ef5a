// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_VERDICT_H
#define HN_SESSION_VERDICT_H
// The verdict on a method: one phrase from its loop gap, its distance from the reference solution
// and its energy. The worst of the three is named first.
//
// The page says the same words (web/state/verdict.js). tests/support/verdicts.json holds cases that
// the tests of both read.

#include <stdbool.h>

typedef enum hn_tone { HN_TONE_CALM, HN_TONE_WARN, HN_TONE_BAD } hn_tone;

enum { HN_MOTION_VERDICT_TEXT = 160, HN_MOTION_EARLIEST = 6 };

#define HN_STARTS_CLOSED "starts closed" // the verdict before frame HN_MOTION_EARLIEST

/// Frames 0 to `shown` of one method, equally spaced in time, and the scales of the comparison.
typedef struct hn_motion_history {
    const double *gap; ///< constraint violation [m]; NaN: the method had ended
    const double *off; ///< largest distance of a drawn point from the reference [m]; NaN: unknown
    const double *energy; ///< energy change, less the work of drives, dampers and loads [J]
    int shown;            ///< index of the frame shown
    double t;             ///< of the frame shown [s]
    double ended;         ///< time at which the method ended early [s]; NaN: it did not
    const char *cause;    ///< what ended it, in a few words; NULL: not known
    double length;        ///< characteristic length of the scene [m]
    double energy_scale;  ///< swing of the energies of the reference [J]; 0: no reference
    double digits;        ///< number of correct digits of the reference
    bool loops;           ///< the scene has closure equations
    bool asked;           ///< the reference is being fetched
} hn_motion_history;

typedef struct hn_motion_verdict {
    hn_tone tone;
    const char *arrow; ///< of the gap: grows, shrinks, is held, or the method has stopped
    char text[HN_MOTION_VERDICT_TEXT];
} hn_motion_verdict;

/// Returns the verdict at the frame shown. Before frame HN_MOTION_EARLIEST there is nothing to
/// judge: "starts closed".
hn_motion_verdict hn_motion_judge(const hn_motion_history *h);
#endif
