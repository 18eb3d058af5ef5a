// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_CLASS_GRADING_H
#define HN_CLASS_CLASS_GRADING_H
// Grades a roster with several worker processes. A submission that takes too long, or ends its
// worker, costs its own line and nobody else's. Every line is kept in a journal as it is finished,
// so that a run that was killed goes on; the result does not depend on the order of finishing.

#include "class/blank_programs.h"
#include "class/filled_program.h"
#include "class/roster.h"
#include "grade/exercise.h"

#include <stdint.h>

/// Begins the reason of a line whose exercise, not its submission, is at fault; the cause follows.
#define HN_CLASS_EXERCISE_FAULT "the exercise is at fault: "

/// One part of a roster, for several machines: every n-th submission from the i-th on, i = 1 .. n.
typedef struct hn_class_shard {
    int i, n; ///< n = 0: the whole roster
} hn_class_shard;

typedef struct hn_class_opts {
    int jobs;
    const hn_filled_exam *programs;  ///< submissions are programs; NULL: answers in JSON
    const hn_blank_programs *blanks; ///< what everyone was given; NULL: programs are not compared
    hn_class_shard shard;
    double time_limit;   ///< [s] for one submission
    uint64_t seed;       ///< of all; 0: each student's own for an exercise that draws numbers
    const char *journal; ///< NULL: nothing is kept
    /// lines of a finished run, whose unchanged ones are taken too; NULL: none
    const char *finished;
    /// called with each line as it is finished; resumed lines are not told again
    void (*tell)(void *user, const char *line);
    int (*stop)(void *user); ///< returns 1 to stop; may be NULL
    void *user;
} hn_class_opts;

typedef struct hn_class_result {
    char **line; ///< n JSON objects, in the order of the roster; NULL: not graded
    int n, resumed, graded;
    int others; ///< of the roster, left to other shards
} hn_class_result;

/// Grades everybody. Fails: HN_ERR_IO (journal, processes), HN_ERR_MEMORY; HN_ERR_STOPPED when it
/// was
/// stopped, with what is done in *out. hn_class_result_reset() in any case.
HN_MUST_CHECK hn_status hn_class_grade(const hn_roster *roster, const hn_exercise *exercise,
                                       const hn_class_opts *opts, hn_class_result *out,
                                       hn_diag *diag);
void hn_class_result_reset(hn_class_result *r);

#endif
