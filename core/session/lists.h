#ifndef HN_SESSION_LISTS_H
#define HN_SESSION_LISTS_H
// What the library holds besides scenes: lessons and problems, as documents.

#include "base/strbuf.h"
#include "session/library.h"

/// {"lessons":[{"id","title","scenes":[...],"problems":[...]}...]}, sorted by id. The title is the first heading of the lesson's text.md.
void hn_lessons_json(hn_strbuf *b, const hn_library *lib);
/// {"problems":[{"id","lesson","title","scene"}...]}; a file that cannot be read as JSON stands there with its "error".
void hn_problems_json(hn_strbuf *b, const hn_library *lib);
#endif
