// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_H
#define HN_SESSION_EXPORT_H
// A mechanism as a program: the equations of one scene in a programming language, with a solver,
// and a self-check against numbers that were computed here. Each language has a text with places to
// fill, core/export/NAME.txt:
//
//   @SCENE@ @TITLE@          its name, its title
//   @NQ@ @NV@ @NC@           numbers of coordinates, velocities, constraints
//   @PARAMETERS@             an assignment each, with unit and meaning
//   @NAMES@                  a comment for each coordinate: which entry of q or v it is
//   @UNPACK@                 t, q and v under the names of the scene
//   @TERMS@                  statements for mass, force, jacobian, bias, closure, closure_rate,
//                            energy
//   @PARAMETER_LOCALS@       a declaration of each parameter (Modelica)
//   @LOCALS@                 a declaration of each name that @UNPACK@ and @TERMS@ assign (Modelica)
//   @RATES@                  statements for rate: the time derivative of q
//   @START_Q@ @START_V@      the assembled start, numbers separated by commas
//   @START_A@ @ENERGY@       accelerations and energy there
//   @ALPHA@ @BETA@           of Baumgarte's stabilisation [1/s]
//   @FUNCTIONS@              the functions of mathematics that the terms call: cos, sin
//   @T1@ @Q1@ @V1@ @A1@      a later state of the motion, and its accelerations
//   @METHOD@ @METHOD_WHY@    the method that was asked for; why its steps are not taken
//   @METHOD_A@ @METHOD_B@ @METHOD_C@ @METHOD_STAGES@ @METHOD_H@ @METHOD_STEPS@ @METHOD_GAP@
//   @METHOD_ALLOWED@         its tableau, its step, how many of them are compared, the largest gap
//
//   @IF BLANKS@ @IF SKELETON@ @IF EIGEN@ @ELSE@ @END@ in lines of their own: lines for programs
//                            with blanks, for skeletons, for the solver of that name (language.h),
//                            or for the others; one may stand in another
//   @IF METHOD@ @IF OTHER_METHOD@
//                            likewise, where the steps of a method are taken, or not
//   @IF ORIENTATION@ @IF LOOPS@ @IF SIGN@ @IF STEP@ @IF FUNCTIONS@
//                            likewise, for scenes with a unit quaternion, with constraints, and
//                            for terms that call sign, step, or any function of @FUNCTIONS@
//
// A place alone in its line is filled with lines of the same indentation.

#include "session/model/library.h"
#include "session/model/model.h"
#include "study/run/walk.h"

#include <stdbool.h>

/// The request of an export. The last members are answers: the ending of a file's name, the marks
/// that begin and end a comment, and why the program does not take the steps of `method`.
typedef struct hn_export_request {
    const char *language; ///< a row of export/language.h
    /// index1@... or baumgarte:alpha=...,beta=...@...: how the program holds its loops, and the
    /// steps that it repeats where its language can (own_steps.h). Its own integrator is that of
    /// the language. NULL: Baumgarte's, alpha = beta = 10/s, and no other steps
    const char *method;
    const char *solver;    ///< one of the language's (export/language.h); NULL: its first
    bool blanks;           ///< leave the parts of exam.h out, and mark them
    bool skeleton;         ///< leave the self-check out; not together with blanks
    hn_walk_limits limits; ///< of the run to the later state; zero: none
    const char *suffix, *comment, *comment_end;
    char remark[168]; ///< "": it takes them, or none were asked for
} hn_export_request;

/// Writes the program for `model` to `b`.
/// Fails: HN_ERR_INPUT (unknown language or solver, with the nearest; another method; a skeleton in
/// a language that has none; blanks together with another solver than the first), HN_ERR_IO (the
/// text of the language is not there), HN_ERR_LIMIT (the code is too long), HN_ERR_STOPPED (the
/// limits), or as a run does when the later state cannot be reached.
HN_MUST_CHECK hn_status hn_model_export(hn_strbuf *b, const hn_model *model, const hn_library *lib,
                                        hn_export_request *request, hn_diags *diags);
/// {"languages":[{"name","suffix","about","solvers":[{"name","about"}]}]}
void hn_export_languages_json(hn_strbuf *b);

#endif
