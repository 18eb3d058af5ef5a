// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_LIBRARY_H
#define HN_SESSION_LIBRARY_H
// Finds the shipped files: scenes, lessons, problems and the page. They lie where HOLONOM_HOME
// points, beside the program (in a checkout), where `make install` put them, or, for a program that
// was copied alone, inside it (base/bundle.h).

#include "base/arena.h"
#include "base/diag.h"
#include "base/strbuf.h"

typedef struct hn_library hn_library;

/// Opens the library in the folder `home`. NULL: tries HOLONOM_HOME, then the checkout around the
/// running program, then the install prefix, then the program itself.
/// Fails: HN_ERR_IO, with all places tried, when no folder holds lessons/ and web/; HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_library_open(const char *home, hn_library **out, hn_diag *diag);
void hn_library_free(hn_library *lib);
const char *hn_library_web(const hn_library *lib);     ///< folder of the page
const char *hn_library_lessons(const hn_library *lib); ///< folder of the lessons

/// Shipped scenes, sorted by id.
int hn_library_n_scenes(const hn_library *lib);
const char *hn_library_scene_id(const hn_library *lib, int i);
const char *hn_library_scene_path(const hn_library *lib, const char *id); ///< NULL when unknown
const char *const *hn_library_scene_ids(const hn_library *lib);
/// Reports at `pointer` that no shipped scene has this id, with a near miss. Fails: HN_ERR_INPUT.
hn_status hn_library_check_scene(const hn_library *lib, const char *id, const char *pointer,
                                 hn_diags *diags);
/// Shipped problems, by id ("p3").
const char *hn_library_problem_path(const hn_library *lib, const char *id);
int hn_library_n_problems(const hn_library *lib);
const char *hn_library_problem_id(const hn_library *lib, int i);
#endif
