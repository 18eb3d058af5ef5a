// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_INSPECT_WORDS_H
#define HN_CLI_INSPECT_WORDS_H
// The words for the members of the document of `inspect`.

#include "cli/shell/document.h"

/// One entry for each member whose name alone does not say what it is; ends with a NULL path.
extern const hn_outline_word hn_inspect_words[];

#endif
