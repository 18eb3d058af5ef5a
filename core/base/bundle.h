// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_BUNDLE_H
#define HN_BASE_BUNDLE_H
// Files inside the program itself: the page, the lessons and what else is read, so that a program
// that was copied alone has them. Their paths begin with HN_BUNDLE: "bundle:/web/index.html".
// base/file.h reads and lists them like any others. A program that was linked without them (a test,
// a user of the library) has none.

#include <stdbool.h>
#include <stddef.h>

#define HN_BUNDLE "bundle:"

/// 1 when the path is one of these, whether there is such a file or not.
bool hn_bundle_is_path(const char *path);
/// The bytes of a file, of the program's own; NULL when there is none. ".." is understood.
const void *hn_bundle_find(const char *path, size_t *n);
/// Calls `see` for each file, in the order of their paths, without HN_BUNDLE: "/web/index.html".
/// Stops when it returns false.
void hn_bundle_each(bool (*see)(void *user, const char *path), void *user);

#endif
