// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_VERDICT_H
#define HN_TUI_VERDICT_H
// The verdict on a method: one phrase from its loop gap, its error against the reference and its
// energy, by the same rules and in the same words as the page (web/state/verdict.js).

#include "tui/recording.h"

typedef enum hn_tone { HN_TONE_CALM, HN_TONE_WARN, HN_TONE_BAD } hn_tone;

enum { HN_VERDICT_TEXT = 160 };

typedef struct hn_verdict {
    hn_tone tone;
    const char *arrow; ///< of the gap: growing, shrinking, held, stopped
    char text[HN_VERDICT_TEXT];
} hn_verdict;

/// length: the scene's characteristic length [m]; loops: whether it has closure equations.
hn_verdict hn_verdict_at(const hn_recording *r, int track, int frame, double length, bool loops);
#endif
