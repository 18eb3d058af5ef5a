// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_TUI_H
#define HN_TUI_TUI_H
// The terminal workbench: the loop between screen and workbench.

#include "tui/workbench.h"

static const double HN_TUI_FRAME = 1.0 / 20; ///< [s] between two pictures; a slow line shows fewer

typedef struct hn_tui_opts {
    bool ascii, blocks; ///< dots in ASCII or quadrants; neither: braille
    bool colours;
    int theme;         ///< hn_theme of the terminal's background; -1: as the terminal says
    int columns, rows; ///< of hn_tui_frame(); 0: 80 x 24
    double t;          ///< [s] of hn_tui_frame()
    const char
        *keys; ///< of hn_tui_frame(): typed before it, as hn_tui_key_read() reads; NULL: none
    hn_pixels pictures; ///< of hn_tui_run()
    int frames;         ///< hn_tui_run(): ends after so many frames; 0: when the user does
} hn_tui_opts;

/// Works on the terminal until the user quits. false: standard output is no terminal that can be
/// driven.
bool hn_tui_run(hn_workbench *w, const hn_tui_opts *opts);
/// One frame as text, at time t, after the keys: everything that it shows is computed first.
void hn_tui_frame(hn_strbuf *b, hn_workbench *w, const hn_tui_opts *opts);
#endif
