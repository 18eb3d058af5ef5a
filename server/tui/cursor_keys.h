// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_CURSOR_KEYS_H
#define HN_TUI_CURSOR_KEYS_H

/// Defines arrows, Home and End as terminals send them, whatever the description of this one says:
/// some send the form of the other mode. For terminals whose sequences are those of ANSI.
void hn_cursor_keys_define(void);

#endif
