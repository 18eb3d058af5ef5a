// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_SUBMISSION_TEXT_H
#define HN_GRADE_SUBMISSION_TEXT_H
// The bytes of a submission as JSON: the encodings that editors write, and the two slips of JSON
// that students make most often.

#include "base/status.h"
#include "base/strbuf.h"

#include <stdbool.h>

/// Appends the text in UTF-8, without its byte-order mark. UTF-16 is recognised by its mark, or by
/// a zero byte beside the first character.
/// Fails: HN_ERR_INPUT (UTF-16 with half a character), HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_submission_decode(hn_strbuf *out, const char *bytes, size_t n,
                                             bool *utf16);
/// Appends the text without commas before a closing bracket, and with the backslashes of LaTeX
/// doubled where one alone stands for something else in JSON: "\theta" begins with a tabulator.
/// Counts both.
void hn_submission_mend(hn_strbuf *out, const char *text, size_t n, int *commas, int *backslashes);
#endif
