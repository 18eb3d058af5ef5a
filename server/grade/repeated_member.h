// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_GRADE_REPEATED_MEMBER_H
#define HN_GRADE_REPEATED_MEMBER_H
// Members of one name in one object. JSON allows them and does not say which one counts; parsers
// take the first or the last.

#include <cjson/cJSON.h>
#include <stdbool.h>

/// Members of an object that are compared; the time that it takes grows with their square.
enum { HN_REPEATED_MEMBER_MOST = 128 };

/// The most members that one object at or below `node` has.
int hn_repeated_member_count(const cJSON *node);
/// Removes members that repeat another one's name and value, at every level. Returns how many. Call
/// it for objects of up to HN_REPEATED_MEMBER_MOST members.
int hn_repeated_member_drop(cJSON *node);
/// Returns whether `object` itself has two members of this name.
bool hn_repeated_member_is(const cJSON *object, const char *name);
/// The first name that an object at or below `node` has twice, borrowed; NULL: none has.
const char *hn_repeated_member_find(const cJSON *node);
#endif
