// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_PROGRAM_LIMITS_H
#define HN_PROGRAM_LIMITS_H
// Limits of a student's program: time, memory, files.

typedef struct hn_program_limits {
    double start, answer; ///< [s] of wall clock until the first answer, and until any other
    double cpu;           ///< [s] of computing time over its whole life
    long long memory;     ///< [bytes] of all its processes together
    int processes;        ///< at once, threads included
    long long files;      ///< [bytes] of each file that it writes, and of its /tmp
    long long line;       ///< [bytes] of one answer
    int stderr_kept;      ///< [bytes] of its standard error that are kept
} hn_program_limits;

/// The limits of the table in server/program/README.md.
hn_program_limits hn_program_limits_default(void);
/// Sets how long an answer may take [s]. The first may take six times as long, and at least 20 s.
void hn_program_limits_set_answer(hn_program_limits *limits, double seconds);

#endif
