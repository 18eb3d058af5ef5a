// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_LISTS_H
#define HN_SESSION_LISTS_H
// The list of lessons, as a document.

#include "base/strbuf.h"
#include "session/model/library.h"

/// {"lessons":[{"id","title","scenes":[...],"problems":[...]}...]}, sorted by id. The title is the
/// first heading of the lesson's text.md.
void hn_lessons_json(hn_strbuf *b, const hn_library *lib);
#endif
