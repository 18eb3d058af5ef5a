// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_PROGRAM_CRASH_WORDS_H
#define HN_PROGRAM_CRASH_WORDS_H
// Last words of a program that ended, from its standard error: the message, and the line of its own
// file where that is told.

#include "program/limits.h"

#include <stdbool.h>

/// Writes "ValueError: wrong sign (mine.py, line 12)", and what is allowed where the message is
/// about memory, processes or disk: "MemoryError (mine.py, line 3); 768 MB are allowed". "" where
/// nothing was said. `confined`: it ran in the sandbox, which is named where a module or a file is
/// missing. `file`: the path or name of the program, NULL: not known. Python, JavaScript,
/// Java, Octave, Julia and compilers are known; of others the last line is taken.
void hn_crash_words(const char *errors, const char *file, bool confined,
                    const hn_program_limits *limits, char out[320]);

#endif
