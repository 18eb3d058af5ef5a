// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_WORD_LIST_H
#define HN_BASE_WORD_LIST_H
// Lists of words: in a sentence, as "a", "a and b", "a, b and c", and in data, as "a b c".

#include "base/strbuf.h"

#include <stdbool.h>
#include <stddef.h>

/// Returns the text that stands before item i of n (0-based): "" before the first, `last` before
/// the last, ", " before any other. `last` is " and " or " or ". For lists whose items are written
/// by code; hn_word_list() serves those that are plain words.
const char *hn_word_joint(int i, int n, const char *last);

/// Adds the n words to `b`, joined as above. n = 0 adds nothing.
void hn_word_list(hn_strbuf *b, const char *const *words, int n, const char *last);

/// Copies the first word of a list whose words are separated by blanks to `out`, cut at `size`, and
/// moves *list behind it. Returns false, and copies nothing, at the end of the list.
bool hn_word_next(const char **list, char *out, size_t size);
#endif
