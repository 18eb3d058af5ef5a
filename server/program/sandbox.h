// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_PROGRAM_SANDBOX_H
#define HN_PROGRAM_SANDBOX_H
// The command line under which a student's program runs.
//
// Inside bubblewrap: no network, no other processes in sight, /usr read-only, the program's own
// file at /program, a /tmp of its own in memory, no capabilities, no user namespaces of its own.
// prlimit
// sets the limits in there. Without bubblewrap only trusted programs run, with the limits alone.

#include "base/diag.h"
#include "program/limits.h"

#include <stdbool.h>

enum { HN_SANDBOX_WORDS = 128, HN_SANDBOX_TEXT = 4096 };

typedef struct hn_sandbox_command {
    int n;
    char *argv[HN_SANDBOX_WORDS]; ///< ends with NULL; into `text` or static
    char text[HN_SANDBOX_TEXT];
    int used;
    char file[1024]; ///< that the process is given as HN_GUEST_FILE; "": none
} hn_sandbox_command;

/// Says whether bubblewrap works here: it starts `true` in it, once in the life of the process.
/// Fails: HN_ERR_UNSUPPORTED with the reason and what to do.
HN_MUST_CHECK hn_status hn_sandbox_check(hn_diag *diag);
/// Builds the command line for a program file with one argument (borrowed; NULL: none). The
/// interpreter is chosen by the file's ending (.py, .js, .m, .java, .jl; in the sandbox .c and .cpp
/// too, which are compiled there); any other file must be executable.
/// Fails: HN_ERR_INPUT for a file that is none, or cannot be started.
HN_MUST_CHECK hn_status hn_sandbox_build(hn_sandbox_command *c, const char *file,
                                         const char *argument, bool trusted,
                                         const hn_program_limits *limits, hn_diag *diag);

/// Returns whether a file can be started: it is one, and has an interpreter or may be executed.
bool hn_sandbox_can_start(const char *file, bool trusted);

#endif
