// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_EXTREME_TEXT_H
#define HN_CLI_EXTREME_TEXT_H
// The extreme matrix for people at a terminal: a line a trial, predicted beside observed.

#include "session/extreme/extreme.h"

void hn_extreme_text(hn_strbuf *b, const hn_extreme *x);
#endif
