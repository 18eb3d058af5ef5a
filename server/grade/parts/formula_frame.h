// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_FORMULA_FRAME_H
#define HN_GRADE_FORMULA_FRAME_H
// Text that students write around a formula: the name of the result before it, its unit behind it.

#include "base/strbuf.h"

#include <stdbool.h>
#include <stddef.h>

/// The formula behind "y =", "T_1 =" or "f(x) ="; the text itself where no name and one equals sign
/// stand before it.
const char *hn_formula_behind_name(const char *text);

/// Finds a unit behind a blank at the end of the text: "L*sin(th) m". The next shorter one on each
/// call; *at is its place, 0 for the first call. False: there is none, or none more.
bool hn_formula_find_unit(const char *text, size_t *at);

/// Writes names for a message: "known here: l1, l2, ..."; as many as fit well in a sentence.
void hn_formula_put_known(hn_strbuf *b, const char *const *names, int n);
#endif
