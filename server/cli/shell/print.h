// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_PRINT_H
#define HN_CLI_PRINT_H
// Standard output.

#include "base/strbuf.h"
#include "cli/shell/command.h"

/// Prints and frees the buffer's text with a newline at its end; HN_EXIT_PROGRAM when memory or the
/// output failed.
hn_exit hn_cli_print(hn_strbuf *text);
/// The same for text that people read: folded to the terminal's width, in ASCII where the
/// locale has no UTF-8, and through $PAGER (less when left out) where a terminal has fewer lines.
hn_exit hn_cli_print_text(hn_strbuf *text);
/// The same for paragraphs, which are folded in a pipe too (hn_terminal_prose()); lines there that
/// are set in stay whole.
hn_exit hn_cli_print_prose(hn_strbuf *text);
#endif
