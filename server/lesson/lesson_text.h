// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LESSON_LESSON_TEXT_H
#define HN_LESSON_LESSON_TEXT_H
// A lesson for a terminal.

#include "base/strbuf.h"

#include <cjson/cJSON.h>

/// Appends the lesson in lines of at most `columns` characters (code keeps its own lines).
///
/// A table that is wider has its cells folded within their columns.
///
/// Predictions show question and choices; the answers follow at the end of the lesson. Pictures
/// are named by caption and file.
void hn_lesson_text(hn_strbuf *b, const cJSON *lesson, int columns);
/// Gives every formula of a lesson a spelling in ASCII, which hn_lesson_text() then prints: for
/// terminals without UTF-8.
void hn_lesson_spell_out(cJSON *lesson);
#endif
