// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_MECHANISM_PICTURE_H
#define HN_TUI_MECHANISM_PICTURE_H
// The mechanism as a picture of pixels, for terminals that show them (pictures.h): what a snapshot
// draws, without its words, in the area that the drawing of characters leaves free.
//
// A picture is made when what it shows has changed, and so seldom that painting takes at most a
// twelfth of a processor.

#include "tui/workbench.h"

/// The picture that the terminal shows now.
typedef struct hn_mechanism_picture {
    hn_pixels form; ///< HN_PIXELS_OFF: none
    hn_area area;
    int id;         ///< of kitty: 1 and 2 by turns, so that the older one goes after the newer
    uint64_t shows; ///< hash of what is drawn
    double due;     ///< [s] the next one is not painted before
    int bytes;      ///< of the last sequence
} hn_mechanism_picture;

/// Appends what the terminal needs to show the area as it is now; nothing where it does already.
/// Keeps in w->place where the mechanism is, for the mouse.
void hn_mechanism_picture_show(hn_mechanism_picture *p, hn_strbuf *b, hn_workbench *w,
                               hn_area area);
/// Takes the picture away, where one is: appends what kitty needs to that end. Sixels go when their
/// cells are written again, which is for the caller.
void hn_mechanism_picture_remove(hn_mechanism_picture *p, hn_strbuf *b);
#endif
