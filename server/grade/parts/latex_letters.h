// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_LATEX_LETTERS_H
#define HN_GRADE_LATEX_LETTERS_H
// The commands of LaTeX that are letters.

#include <stdbool.h>

/// True when the word of letters that begins at `at` is one of the words (NULL-terminated).
bool hn_latex_is_word(const char *at, const char *const *words);
/// True when a command that is a letter stands at `at`, behind its backslash: theta_1, varphi.
bool hn_latex_is_letter(const char *at);
/// True for varphi and its like, which are a letter behind their "var".
bool hn_latex_is_variant(const char *at);
#endif
