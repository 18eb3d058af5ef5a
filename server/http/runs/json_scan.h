// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_JSON_SCAN_H
#define HN_HTTP_JSON_SCAN_H
// Walks over JSON that this program wrote itself, without building a tree: a run of millions of
// numbers is cut into rows as text, so that every digit stays.

#include <stddef.h>

/// Returns the place behind the value that begins at `at`.
const char *hn_json_skip(const char *at);
/// Returns the value of a member of the object that begins at `object`, or NULL.
const char *hn_json_member(const char *object, const char *name);
/// Steps to the next member of an object: `*at` is its '{' or the place behind the member before.
/// Returns the value, leaves `*at` behind it, and sets `*key` to the `*n` bytes of its name as
/// written; NULL at the end.
const char *hn_json_next_member(const char **at, const char **key, size_t *n);
/// Steps to the next item of an array: `*at` is its '[' or the place behind the item before.
/// Returns the item and leaves `*at` behind it; NULL at the end.
const char *hn_json_next(const char **at);
#endif
