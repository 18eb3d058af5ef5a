// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPORT_SPELLING_H
#define HN_EXPORT_SPELLING_H
// Numbers, names, words and forms as a language spells them.

#include "base/strbuf.h"
#include "export/language.h"

/// Writes a number so that it reads back to the same double.
void hn_code_number(hn_strbuf *b, const hn_language *language, double value);
/// Writes a given number: with 6 digits in a language to read, else as hn_code_number.
void hn_code_given(hn_strbuf *b, const hn_language *language, double value);
/// Writes a symbol's name; a reserved word gets a '_' behind it.
void hn_code_name(hn_strbuf *b, const hn_language *language, const char *name);
/// Writes words of the scene (its title, what a parameter means) so that they stay inside a comment
/// or a text: control characters become spaces, quotes single, and a backslash a slash.
void hn_code_words(hn_strbuf *b, const hn_language *language, const char *words);
/// Writes a form with #1, #2, ... replaced by the texts.
void hn_code_fill(hn_strbuf *b, const char *form, const char *const *texts);

#endif
