// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_EXAM_H
#define HN_SESSION_EXPORT_EXAM_H
// Expected values of the parts of an exported program that a student fills in (export --blanks):
// mass, force, jacobian and bias at states of the motion.

#include "session/export/places.h"

enum { HN_EXPORT_EXAM_STATES = 5, HN_EXPORT_EXAM_TERMS = 12 };

/// The parts that --blanks leaves out, in the order in which a program answers them.
typedef enum hn_export_part {
    HN_EXPORT_MASS,     ///< nv x nv row-major
    HN_EXPORT_FORCE,    ///< nv
    HN_EXPORT_JACOBIAN, ///< nc x nv row-major
    HN_EXPORT_BIAS,     ///< nc
    HN_EXPORT_PARTS
} hn_export_part;
/// "mass", "force", "jacobian", "bias"
const char *hn_export_part_name(hn_export_part part);

/// One state: what is asked, and the right answers. In the coordinates of the exported program.
typedef struct hn_export_question {
    double t;
    const double *q, *v; ///< nq, nv
    const double *answer[HN_EXPORT_PARTS];
    const double *still; ///< the force at rest there: v = 0
} hn_export_question;

/// The terms whose sum an entry is: t[i][k] is the value of term i at state k. n = 0: not known.
typedef struct hn_export_sum {
    int n;
    hn_ex term[HN_EXPORT_EXAM_TERMS];
    double t[HN_EXPORT_EXAM_TERMS][HN_EXPORT_EXAM_STATES];
} hn_export_sum;

typedef struct hn_export_exam {
    hn_arena *arena; ///< owned
    int nq, nv, nc;
    int size[HN_EXPORT_PARTS], columns[HN_EXPORT_PARTS]; ///< of a part; columns 0: a vector
    hn_export_question question[HN_EXPORT_EXAM_STATES];
    hn_export_sum *sum[HN_EXPORT_PARTS]; ///< size of each part
    hn_exporter e;                       ///< whose expressions exam_changes.h evaluates; owned
} hn_export_exam;

/// Works out the exam of a model. hn_export_exam_reset() in any case.
/// Fails: as hn_model_export() does.
HN_MUST_CHECK hn_status hn_export_exam_init(hn_export_exam *exam, const hn_model *model,
                                            const hn_walk_limits *limits, hn_diags *diags);
void hn_export_exam_reset(hn_export_exam *exam);
/// Returns the expressions of a part, entry by entry.
const hn_ex *hn_export_exam_entry(const hn_export_exam *exam, hn_export_part part);
/// Writes the values of all symbols of the graph at state k to x: parameters, coordinates,
/// velocities, time.
void hn_export_exam_symbols(const hn_export_exam *exam, int k, double *x);

#endif
