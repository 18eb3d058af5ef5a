// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_LESSON_LESSON_H
#define HN_LESSON_LESSON_H
// A lesson as a document: what the page, the terminal and the book show, and what the tests check.
//
// lessons/NN-name/text.md is Markdown (markdown.h). A fenced block whose first word is one of the
// following becomes a node of that kind in place of code (lessons/README.md shows each):
//
//   exhibit   {command, scene, methods, set, time, look} children: what to see
//   predict   {choices: [{children}], right} children: the question; "after": what was seen
//   slip      {number} children: what a printed lesson says, to be put right
//   exercise  {id} children: a word on it

#include "base/diag.h"
#include "base/strbuf.h"
#include "session/model/library.h"

#include <cjson/cJSON.h>

/// Reads a lesson by number ("3") or id ("03-projection"):
/// {"id","number","title","folder","blocks":[...]}. Returns owned (cJSON_Delete).
/// Fails: HN_ERR_INPUT with a near miss, HN_ERR_IO, HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_lesson_load(const hn_library *lib, const char *word, cJSON **out,
                                       hn_diags *diags);
/// The same from Markdown alone: the tree of blocks with the special kinds in place.
HN_MUST_CHECK hn_status hn_lesson_parse(const char *text, size_t n, cJSON **blocks,
                                        hn_diags *diags);
/// The document as JSON text.
void hn_lesson_json(hn_strbuf *b, const cJSON *lesson);
#endif
