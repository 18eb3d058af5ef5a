// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_LIBRARY_H
#define HN_SESSION_LIBRARY_H
// Where the shipped things are: scenes, lessons, problems and the page. Found beside the program (a
// checkout), in the place where `make install` put them, or where HOLONOM_HOME points.

#include "base/arena.h"
#include "base/diag.h"
#include "base/strbuf.h"

typedef struct hn_library hn_library;

/// `home` may be NULL: then HOLONOM_HOME, the checkout around the running program, and the install
/// prefix are tried in this order. HN_ERR_IO with all places tried when none holds lessons/ and
/// web/.
HN_MUST_CHECK hn_status hn_library_open(const char *home, hn_library **out, hn_diag *diag);
void hn_library_free(hn_library *lib);
const char *hn_library_web(const hn_library *lib);     ///< folder of the page
const char *hn_library_lessons(const hn_library *lib); ///< folder of the lessons

/// Shipped scenes, sorted by name.
int hn_library_n_scenes(const hn_library *lib);
const char *hn_library_scene_id(const hn_library *lib, int i);
const char *hn_library_scene_path(const hn_library *lib, const char *id); ///< NULL when unknown
const char *const *hn_library_scene_ids(const hn_library *lib);
/// Problems, by id ("p3").
const char *hn_library_problem_path(const hn_library *lib, const char *id);
int hn_library_n_problems(const hn_library *lib);
const char *hn_library_problem_id(const hn_library *lib, int i);
#endif
