// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_PLACES_H
#define HN_SESSION_EXPORT_PLACES_H
// Fills the places of a program's text: @NQ@, @TERMS@ ... The list of them is in export.h.

#include "base/arena.h"
#include "base/strbuf.h"
#include "dynamics/compile/system.h"
#include "export/language.h"
#include "integrators/method/method_spec.h"
#include "session/model/model.h"
#include "study/run/walk.h"

#include <stdbool.h>

/// A state with its accelerations, in system coordinates.
typedef struct hn_export_state {
    double t, *q, *v, *a;
} hn_export_state;

/// The steps of the method that was asked for, as own_steps.h finds them.
typedef struct hn_export_steps {
    bool asked;                       ///< a method was named
    char method[HN_SPEC_MAX];         ///< its spelling
    char why[160];                    ///< why the program cannot take its steps; "": it can
    const struct hn_tableau *tableau; ///< of the steps
    int n;                            ///< steps that are compared
    double h, t;                      ///< [s] a step; n of them
    double gap, allowed;              ///< largest gap at the end of a step; how far another may be
} hn_export_steps;

typedef struct hn_exporter {
    hn_arena *arena;
    const hn_model *model;
    hn_system *sys; ///< with parameters as symbols, where that can be compiled
    hn_system_info info;
    hn_system_exprs x;
    const hn_ex *M, *J; ///< dense
    const hn_language *language;
    const hn_language_solver *solver; ///< NULL: the language has one way only
    double alpha, beta;               ///< Baumgarte's [1/s]
    hn_export_steps steps;
    bool blanks;    ///< the student's parts are left out
    bool skeleton;  ///< without what checks the program and shows the motion
    unsigned calls; ///< operators of the terms, bit hn_op each (calls.h)
    hn_walk_limits limits;
    double started; ///< hn_clock_thread()
    hn_export_state start, later;
    double energy;
} hn_exporter;

/// Adds the text to `b`, line by line, with its places filled.
/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT (the code is too long).
HN_MUST_CHECK hn_status hn_export_fill(hn_strbuf *b, const hn_exporter *e, const char *text);

#endif
