// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REPORT_H
#define HN_SESSION_REPORT_H
// The full report: for several scenes a work-precision study of the same methods, the budget of
// errors and energy of a few of them, and, where the scene passes singular poses, how many step
// sizes each method survives. One time limit for all.
//
// Scenes are taken one after another, and nothing runs beside what is timed: a second process on
// the other core would share its caches and its clock, and times would be those of the pair. What a
// scene does not use of its share goes to those after it.
//
// Studies, finished ones too, are kept in the folder until the report is complete, so that the same
// request continues where it was interrupted. Accounts and survivals take seconds and are made
// anew.

#include "session/budgets/budgets.h"
#include "session/precision/study.h"
#include "study/cost/survival.h"

#include <stdbool.h>

enum { HN_REPORT_BUDGETS = 3, HN_REPORT_SIZES = 24 };

/// The scenes of a report that names none: plane and space, singular, stiff, one loop and several.
const char *const *hn_report_standard(int *n);

typedef struct hn_report hn_report;
/// Checks the request.
///
/// request  in  one model or several; methods: hn_study_standard() where it has none; time limit
///              of the whole: 240 s where it has none. Values: "levels" and "samples", as of a
///              study.
/// Returns owned in *out. The models and the texts of the request must outlive the report.
/// Fails:   HN_ERR_INPUT and HN_ERR_LIMIT (the request), HN_ERR_MEMORY. All reported in diags.
HN_MUST_CHECK hn_status hn_report_open(const hn_job_request *request, hn_report **out,
                                       hn_diags *diags);
/// Computes the report. A scene that cannot be studied is listed with its reason. Fails:
/// HN_ERR_MEMORY, reported in diags.
HN_MUST_CHECK hn_status hn_report_run(hn_report *report, hn_diags *diags);
void hn_report_free(hn_report *report); ///< NULL is legal

// what is in it
/// The runs of one method with a number of step sizes.
typedef struct hn_strip {
    int n; ///< sizes that were tried; 0: none, `reason` says why
    double size[HN_REPORT_SIZES];
    hn_survival run[HN_REPORT_SIZES];
    char reason[200];
} hn_strip;

typedef struct hn_report_scene {
    const hn_model *model;
    hn_study *study;              ///< NULL: `reason`
    char reason[HN_DIAG_MESSAGE]; ///< why there is no study
    hn_budget_row budgets[HN_REPORT_BUDGETS];
    int n_budgets;
    bool singular;      ///< it passes near singular poses
    double singular_at; ///< the first of them [s]
    hn_strip *strips;   ///< one a method of the study where it is singular, else NULL
} hn_report_scene;

/// Scenes of the report, and scene i.
int hn_report_n_scenes(const hn_report *report);
const hn_report_scene *hn_report_scene_at(const hn_report *report, int i);
bool hn_report_stopped(const hn_report *report); ///< on request
/// Sizes that a method survived, of strip->n.
int hn_strip_survived(const hn_strip *strip);

/// The cheapest method that reaches an accuracy: by time where times may be ranked, else by
/// operations.
typedef struct hn_report_answer {
    int method; ///< -1: no method reaches it
    double cost;
    hn_cost_kind by;
    int n_alike; ///< by operations alone: others as cheap
} hn_report_answer;
enum { HN_REPORT_BANDS = 3 };

typedef enum hn_verdict_kind {
    HN_VERDICT_GOOD,
    HN_VERDICT_PARTLY,    ///< some sizes fail
    HN_VERDICT_FAILS,     ///< all do
    HN_VERDICT_ELSEWHERE, ///< converges to another motion
    HN_VERDICT_REFUSED,   ///< the method does not serve the scene
    HN_VERDICT_NOT_RUN    ///< the time limit left it out
} hn_verdict_kind;
typedef struct hn_verdict {
    hn_verdict_kind kind;
    /// smallest error of the coordinates (beyond the horizon: of the energy) that may be claimed;
    /// NaN: none
    double best;
    int done, failed, skipped; ///< sizes
    bool untrusted;            ///< nothing that came out is right to one digit
    char text[64];             ///< "1e-12", "2e-9, 3 of 7 fail", "no digit", "elsewhere, by 0.3"
    const char *why; ///< the reason of the coarsest failure, or the class's words; borrowed
} hn_verdict;

// documents

typedef struct hn_report_plot {
    char name[160]; ///< for a file: "fb0-q-time"
    const hn_report *of;
    int scene, kind, error, cost;
} hn_report_plot;
#endif
