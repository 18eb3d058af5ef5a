// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_PROGRAM_CONVERSATION_H
#define HN_PROGRAM_CONVERSATION_H
// The protocol between the workbench and a student's program: JSON, one object a line, on the
// program's standard input and output.
//
//   > {"holonom":1,"scene":...,"coordinates":[...],"rows":[...],"parameters":{...},"limits":{...}}
//   < {"holonom":1,"provides":"accelerations","wants":["M","f","J","gamma","phi","phi_t"]}
//   > {"id":1,"t":0,"q":[...],"v":[...],"M":[[...]],...}
//   < {"id":1,"a":[...],"lambda":[...]}
//
// A program that provides "step" gets {"id","t","h","q","v"} and answers {"id","q","v"}; one that
// provides "solve" gets {"id","t","times":[...],"q","v"} and answers {"id","q":[[...]],"v":[...]},
// both a row for each time. Coordinates and rates are those of the scene. After the last
// question its
// input ends, and so should the program.

#include "base/arena.h"
#include "dynamics/compile/system.h"
#include "dynamics/evaluate/eval.h"
#include "program/guest_process.h"
#include "program/repeated_question.h"

#include <stdbool.h>

typedef enum hn_program_service {
    HN_PROGRAM_ACCELERATIONS,
    HN_PROGRAM_STEP,
    HN_PROGRAM_SOLVE,
    HN_PROGRAM_SERVICES
} hn_program_service;

enum { HN_CONVERSATION_AHEAD = 64 }; ///< times of one question to a program that solves

typedef struct hn_conversation {
    const hn_system *sys;
    hn_guest_process process;
    hn_program_service service;
    unsigned wants; ///< hn_term bits that it asked for
    hn_eval *eval;  ///< NULL: it wants none
    int nu, nv, nq, nc;
    long long id; ///< of the last question
    bool failed;
    hn_diag why;                                    ///< what went wrong; stays
    double *uq, *uv, *ua, *P, *scratch, *M, *J, *f; ///< in the scene's coordinates
    // what a program that solves has said ahead: rows for start + k h
    double *ahead_q, *ahead_v; ///< HN_CONVERSATION_AHEAD x nu
    double ahead_t, ahead_h;
    int n_ahead, next_ahead;
    double cpu;       ///< computing time of the program for the answers that were used [s]
    double ahead_cpu; ///< of each row that was computed ahead [s]
    // of a program that gives accelerations
    hn_repeated_question repeated;
    double *answer; ///< (nu) to the question asked last, while another one is asked again
    hn_strbuf text, line;
} hn_conversation;

/// Starts the program (hn_guest_process_start()) and exchanges greetings. Memory from `arena`.
/// Fails: HN_ERR_MEMORY. A program that does not start or does not greet is no failure here: the
/// first question to it fails, with the reason in c->why. hn_conversation_end() afterwards in any
/// case.
HN_MUST_CHECK hn_status hn_conversation_begin(hn_conversation *c, const hn_system *sys,
                                              char *const *argv, const char *file,
                                              const hn_program_limits *limits, hn_arena *arena);
/// Returns whether the program provides what is asked of it: its own steps (`own`), or
/// accelerations for an integrator. Fails: HN_ERR_INPUT, with the other spelling in diag. A program
/// that did not greet passes.
HN_MUST_CHECK hn_status hn_conversation_check(const hn_conversation *c, bool own, hn_diag *diag);
/// Asks for the accelerations a (nv, system coordinates) at (t, q, v). Now and then an earlier
/// question is asked again; a program whose answer differs by more than rounding has failed. After
/// a failure the conversation is over: later calls fail in the same way.
HN_MUST_CHECK hn_status hn_conversation_accelerations(hn_conversation *c, double t, const double *q,
                                                      const double *v, double *a);
/// Asks for the state at t + h; of a program that solves, for the next steps too. q_new (nq), v_new
/// (nv) in system coordinates.
HN_MUST_CHECK hn_status hn_conversation_step(hn_conversation *c, double t, double h,
                                             const double *q, const double *v, double *q_new,
                                             double *v_new);
void hn_conversation_end(hn_conversation *c);

#endif
