// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_READ_AS_H
#define HN_GRADE_READ_AS_H
// Says how a formula was read where its spelling is not the parser's own.

#include <stdbool.h>
#include <stddef.h>

/// The exercise's name that `name` stands for, borrowed; NULL: none.
typedef const char *hn_name_reader(void *user, const char *name);

/// Writes the formula as it was read, cut to `size`: `plain` (hn_spelling_normalise()) with each
/// name replaced by the one it stands for. Returns false, and writes "", where `given` differs from
/// that by blanks and ** for ^ alone.
bool hn_read_as(const char *given, const char *plain, hn_name_reader *reader, void *user, char *out,
                size_t size);
#endif
