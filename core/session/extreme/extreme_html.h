// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_HTML_H
#define HN_SESSION_EXTREME_EXTREME_HTML_H
// The extreme matrix as one HTML file: no network, no script; for the screen, light and dark, and
// for paper.

#include "session/extreme/extreme.h"

/// One file without network.
void hn_extreme_html(hn_strbuf *b, const hn_extreme *x);
#endif
