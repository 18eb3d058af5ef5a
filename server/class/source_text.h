// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_SOURCE_TEXT_H
#define HN_CLASS_SOURCE_TEXT_H
// What is common to the source texts of all languages that a class hands in.

#include <stdbool.h>
#include <stddef.h>

/// Whether a name begins with this letter.
bool hn_source_begins_name(char c);
/// Whether a name goes on with this letter or digit.
bool hn_source_continues_name(char c);
/// Whether these n letters name a function of mathematics, which nobody renames.
bool hn_source_is_function(const char *name, size_t n);
/// Returns where a comment that begins at `at` ends; NULL: none begins there. What is behind a '%'
/// counts as one in every language, behind a '#' too: in C it is an operator and a directive.
const char *hn_source_skip_comment(const char *at);
/// Returns where a text in quotes ends, NULL: none begins at `at`. A single quote behind a name or
/// a bracket transposes in Octave. begin: of the source.
const char *hn_source_skip_quotes(const char *begin, const char *at);

#endif
