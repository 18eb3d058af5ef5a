// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_PROGRAM_REPEATED_QUESTION_H
#define HN_PROGRAM_REPEATED_QUESTION_H
// A question that a program is asked twice within a run. Its accelerations may depend on t, q and v
// alone: the samples between two steps are questions of the same process, so what a program
// remembered of them would change the motion.

#include "base/arena.h"
#include "base/diag.h"

#include <stdbool.h>

typedef struct hn_repeated_question {
    long long id; ///< of the question that is kept; 0: none
    int nq, nv, nu;
    double t, *q, *v; ///< its state, in system coordinates
    double *a;        ///< its answer, in the scene's coordinates
} hn_repeated_question;

/// Takes room for a question of nq positions and nv velocities, answered by nu numbers. Fails:
/// HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_repeated_question_init(hn_repeated_question *r, int nq, int nv, int nu,
                                                  hn_arena *arena);
/// Returns whether the kept question is to be asked again behind question `id`: after few questions
/// often, later behind every 64th, which costs less than 2 % of the questions.
bool hn_repeated_question_is_due(long long id);
/// Keeps a question and its answer in place of the one before.
void hn_repeated_question_keep(hn_repeated_question *r, long long id, double t, const double *q,
                               const double *v, const double *a);
/// Returns the entry in which the answers differ most, by more than rounding; -1: they agree.
int hn_repeated_question_compare(const hn_repeated_question *r, const double *a);

#endif
