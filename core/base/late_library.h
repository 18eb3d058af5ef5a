// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_LATE_LIBRARY_H
#define HN_BASE_LATE_LIBRARY_H
// A shared library that is loaded when it is needed and kept. Linked in the usual way it is loaded
// at every start of the program, also for commands that never use it.

#include "base/diag.h"

#include <stdbool.h>

typedef struct hn_late_library {
    const char *name;         ///< for people: "OSMesa"
    const char *package;      ///< that has it: "libosmesa6"
    const char *const *files; ///< names of its file, newest first, ends with NULL
    void *handle;             ///< NULL: not loaded yet
    char missing[200];        ///< what stood in the way, "" when all is there
} hn_late_library;

/// Loads the library; false and `missing` when no file of it can be loaded. Call it once.
bool hn_late_library_open(hn_late_library *lib);

/// Puts the address of a function or a variable into *out; false and `missing` when the library has
/// none of that name.
bool hn_late_library_find(hn_late_library *lib, const char *name, void *out);

/// Returns HN_OK, or HN_ERR_UNSUPPORTED with what is missing, what cannot be done without it
/// ("no picture can be made") and the package to install.
hn_status hn_late_library_check(const hn_late_library *lib, const char *consequence, hn_diag *diag);
#endif
