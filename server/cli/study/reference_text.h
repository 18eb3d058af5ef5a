// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_REFERENCE_TEXT_H
#define HN_CLI_REFERENCE_TEXT_H
// The reference solution for people at a terminal: its two means, and the digits they share over
// time.

#include "session/kinds/kind_reference.h"

/// Writes a reference solution for people: its result, and how far it can be trusted.
void hn_reference_text(hn_strbuf *b, const hn_reference_work *work);
#endif
