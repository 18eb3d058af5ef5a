// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_INTERNAL_H
#define HN_SESSION_EXTREME_INTERNAL_H
// Types shared by the files of the extreme matrix: a point (scene, method, value), the state kept
// from trial to trial, and the record of one run.
//
//     extreme_read*.c    reads cases from files          extreme_walk.c      runs a point
//     extreme_model.c    scene and start of a point      extreme_quantity.c  table of quantities
//     extreme_store.c    journal of finished trials      extreme_measure.c   table of measures
//     extreme.c          trials and verdicts             extreme_solve.c, extreme_stable.c:
//                                                        measures that make several runs

#include "session/extreme/extreme.h"
#include "session/model/model.h"
#include "study/run/run.h"
#include "study/run/walk.h"

/// One point of a trial: a scene, a method, a value of the swept name.
typedef struct hn_extreme_point {
    const hn_extreme_trial *trial;
    const hn_extreme_scene *scene;
    const char *method; ///< as in the file
    double value;       ///< of the swept name
} hn_extreme_point;

/// State kept from trial to trial: the model last loaded, its exact end state, and the limits.
typedef struct hn_extreme_bench {
    const hn_library *lib;
    const hn_job_limits *limits;
    double deadline; ///< wall clock [s]; 0: none
    const char *id;  ///< of the present case
    double share;    ///< of all that is done
    hn_model *model;
    const hn_extreme_scene *scene; ///< of the model
    int n_set, is_open;            ///< open: loaded though its loops do not close
    hn_setting settings[HN_EXTREME_SETTINGS];
    hn_status load_status;
    hn_diags diags; ///< of the last load
    // the exact end of the model, as a trial's truth method gives it
    hn_arena *truth_arena;
    const hn_extreme_trial *truth_trial; ///< NULL: there is none yet
    double truth_time;
    double *truth_q, *truth_v, *truth_lambda;
} hn_extreme_bench;

/// Reports progress and returns 1 when the job must stop; serves as the `stop` of a walk.
int hn_extreme_is_stopped(void *bench);

/// A run that has ended, with what was measured on the way.
typedef struct hn_extreme_check {
    hn_extreme_bench *bench;
    const hn_extreme_point *point;
    const hn_model *model; ///< NULL: the scene was refused
    hn_arena *arena;
    const double *q, *v; ///< start, system coordinates
    hn_run *run;         ///< NULL: refused
    double time;         ///< asked for
    hn_status status;    ///< of load, creation or run
    char reason[200];
    double start_energy;
    hn_sample end; ///< when it finished
    hn_run_summary summary;
    double least_step;     ///< of the whole run, where each step was measured
    double first, last;    ///< largest |v| over the first and the last tenth, likewise
    const double *truth;   ///< n_user, what q should be; NULL: none
    const double *truth_v; ///< likewise, NULL: unknown
    const double *truth_lambda;
} hn_extreme_check;

enum {
    HN_EXTREME_EACH_STEP = 1,   ///< step by step: least_step, first, last
    HN_EXTREME_TRUTH = 2,       ///< the trial must give one
    HN_EXTREME_FAILED_TOO = 4,  ///< defined for a run that ended early
    HN_EXTREME_MODEL = 8,       ///< of the model alone: no run is made
    HN_EXTREME_RAW = 16,        ///< the scheme's own multipliers
    HN_EXTREME_COORDINATE = 32, ///< the trial must name a coordinate
    HN_EXTREME_INCIDENT = 64,   ///< the trial must name an incident
    HN_EXTREME_SOLVE = 128,     ///< of an answer of a solver
    HN_EXTREME_WATCHED = 256    ///< needs the run's watch
};

/// The errors of a solver's answer against the exact answer.
typedef struct hn_extreme_answer {
    hn_status status;
    int nv, nc;
    double error;       ///< max |a - exact| / max |exact|
    double force_error; ///< of J' lambda, likewise
    double lambda_norm;
    /// of the multipliers of the exact elimination (0 for rows that depend on others)
    double exact_lambda_norm;
    char reason[200];
} hn_extreme_answer;

typedef struct hn_extreme_quantity {
    const char *name, *unit, *about;
    unsigned needs;
    double (*of_run)(const hn_extreme_check *look);
    double (*of_answer)(const hn_extreme_answer *answer);
} hn_extreme_quantity;

typedef struct hn_extreme_measure {
    const char *name, *about;
    int takes_quantity, takes_sweep; ///< 1 must, 0 must not, -1 may
    int gives_word;
    /// Measures one number or outcome for a scene and a method.
    void (*see)(hn_extreme_bench *bench, const hn_extreme_trial *trial,
                const hn_extreme_scene *scene, const char *method, hn_extreme_seen *out);
} hn_extreme_measure;

#endif
