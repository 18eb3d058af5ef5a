// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_LIKENESS_H
#define HN_CLASS_LIKENESS_H
// Hashes by which two submissions are told to be one, or one a copy of the other under new names.

#include "class/source_text.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

/// Hashes the answers of a submission: their texts without blanks and capitals, and their numbers.
uint64_t hn_likeness_texts(const cJSON *submission);
/// Hashes the same with every name replaced by its number in order of appearance; the names of
/// functions stay. Two submissions that differ in their names alone are equal.
uint64_t hn_likeness_shape(const cJSON *submission);
/// Hashes the text of a program without blanks, capitals and comments.
uint64_t hn_likeness_program_texts(const char *text, hn_source_style style);
/// Hashes the statements of a program in any order, without comments and texts in quotes; a name
/// counts by what the program last gave it, and one that was given nothing by its number in order
/// of first use. Programs that differ in their names, their comments and the order of their
/// statements are equal; programs that use another variable at one place are not.
uint64_t hn_likeness_program_shape(const char *text, hn_source_style style);

#endif
