// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_PROGRAM_PROGRAM_METHOD_H
#define HN_PROGRAM_PROGRAM_METHOD_H
// Students' programs as methods: program:./mine.py@rk4:h=1e-3 takes accelerations from the program,
// program:./mine.py@own:h=1e-3 lets it make its own steps. Everything that runs methods runs them.

#include <stdbool.h>

typedef struct hn_program_opts {
    bool trusted;  ///< without a sandbox
    double answer; ///< [s] for an answer but the first; NaN: as hn_program_limits_default() says
    const char *folder; ///< programs are names in this folder alone; NULL: any path
} hn_program_opts;

/// Allows programs from now on. Call it once, before other threads exist.
void hn_programs_allow(const hn_program_opts *opts);
/// Prints the resources that the programs of this process used, a line each, on standard error;
/// nothing where none ran.
void hn_programs_report(void);

#endif
