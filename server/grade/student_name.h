// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_STUDENT_NAME_H
#define HN_GRADE_STUDENT_NAME_H
// Names of students as they are compared and seeded. Unicode writes a letter with a mark in two
// ways, as one character or as a letter and a mark behind it, and the files of some systems have
// the second. Marks are joined to their letters (Latin, Greek and Cyrillic letters, kana and
// Hangul, as in the form NFC). Blanks around a name are dropped, and blanks inside it count as one.
// Capital letters stay as they are.

#include <stddef.h>
#include <stdint.h>

/// Continues a hash with a name, equal for all its spellings.
uint64_t hn_student_name_hash(uint64_t hash, const char *name);
/// Writes the one spelling of a name, cut behind a whole character where `size` bytes do not hold
/// it. `out` may be `name` itself: the spelling is never longer.
void hn_student_name_normalise(const char *name, char *out, size_t size);
#endif
