// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_EXTREME_TEXT_H
#define HN_CLI_EXTREME_TEXT_H
// The extreme matrix as text for a terminal: a line for each trial, predicted and observed.

#include "session/extreme/extreme.h"

/// The matrix for people.
void hn_extreme_text(hn_strbuf *b, const hn_extreme *x);
#endif
