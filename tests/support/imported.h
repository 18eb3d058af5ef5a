// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_IMPORTED_H
#define HN_SUPPORT_IMPORTED_H
// Mechanisms of other programs as scenes, for tests. Failures stop the test with their message.

#include "import/import.h"

typedef struct hn_imported {
    hn_import *im;
    hn_scene *scene;
} hn_imported;

/// XML text, and the text of a loop file or NULL.
void imported_open(hn_imported *x, const char *xml, const char *loops);
/// Files under tests/import/; `loops` and `key` may be NULL.
void imported_open_file(hn_imported *x, const char *name, const char *loops, const char *key);
void imported_close(hn_imported *x);
/// The whole file as text (free()).
char *imported_text(const char *name);
/// Index by name; the test fails if there is none.
int imported_body(const hn_imported *x, const char *name);
int imported_joint(const hn_imported *x, const char *name);
/// A note whose place ends in `where`, or NULL.
const hn_import_note *imported_note(const hn_imported *x, const char *where);
/// The message of the first fault of a text that has one; static.
const char *imported_fault(const char *xml, const char *loops, hn_status *status);
#endif
