// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TERMINAL_SPELL_OUT_H
#define HN_TERMINAL_SPELL_OUT_H
// Letters and signs of formulas in ASCII, for a terminal without UTF-8: "theta_1", "<=", "m^2".

#include "base/strbuf.h"

#include <stdbool.h>

/// Appends text with letters and signs of formulas spelled out; other characters stay. Names that
/// would run together are kept apart by a blank. joins: a digit behind a name belongs to it, so
/// that "ξ1" is "xi1".
void hn_spell_out(hn_strbuf *b, const char *utf8, bool joins);
#endif
