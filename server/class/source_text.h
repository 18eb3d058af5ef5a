// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_SOURCE_TEXT_H
#define HN_CLASS_SOURCE_TEXT_H
// Functions common to the source texts of all languages that a class hands in.

#include <stdbool.h>
#include <stddef.h>

/// Style of comments and blocks of a language.
typedef enum hn_source_style {
    HN_SOURCE_C,      ///< C, C++, Java: // and /* */; a line that begins with # is a directive
    HN_SOURCE_PYTHON, ///< #; a line ends a statement
    HN_SOURCE_OCTAVE, ///< % and #, %{ and %} around lines
    HN_SOURCE_JULIA   ///< #, #= =#; a line ends a statement
} hn_source_style;

/// Returns the style of a file by the ending of its name; that of C for an unknown ending.
hn_source_style hn_source_style_of(const char *file);
/// Returns whether the end of a line ends a statement; else a semicolon alone does.
bool hn_source_is_by_lines(hn_source_style style);
/// Returns whether a name begins with this letter.
bool hn_source_begins_name(char c);
/// Returns whether a name goes on with this letter or digit.
bool hn_source_continues_name(char c);
/// Returns whether these n letters name a function of mathematics, which nobody renames.
bool hn_source_is_function(const char *name, size_t n);
/// Returns where a comment that begins at `at` ends; NULL: none begins there. A directive of C
/// counts as one.
const char *hn_source_skip_comment(hn_source_style style, const char *at);
/// Returns where a text in quotes ends, NULL: none begins at `at`. A single quote behind a name or
/// a bracket transposes in Octave. begin: of the source.
const char *hn_source_skip_quotes(const char *begin, const char *at);

#endif
