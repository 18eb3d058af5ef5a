// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_FORMULATIONS_CHART_STATE_H
#define HN_FORMULATIONS_CHART_STATE_H
// The data of a chart (chart.h) and the report of its failures.

#include "dynamics/analyse/dyads.h"
#include "dynamics/evaluate/eval.h"
#include "formulations/ground/formulation.h"
#include "linalg/column_choice.h"
#include "linalg/qr.h"
#include "linalg/row_check.h"
#include "linalg/sparse_lu.h"

#include <stdbool.h>

enum { HN_CHART_TEXT = 288 };
/// From so many speeds on columns are chosen sparsely.
enum { HN_CHART_LARGE = 100 };

/// Everything that belongs to one configuration on the chart.
typedef struct hn_chart_point {
    bool valid;
    double t;
    double *q; ///< nq, closed when made by hn_chart_close
    /// the entries of J that are not identically zero, in the order of hn_chart.J_row, J_col
    double *J;
    double *N;        ///< nv x r row-major
    double *s;        ///< nv
    hn_sparse_lu *lu; ///< factor of J_d when it is square, its columns scaled
    double *jd_values;
    hn_qr jd;      ///< factor of J_d otherwise, nc x rank
    int sign;      ///< of det J_d when square, else 0
    bool is_bare;  ///< made by a tape: J and the factor are those of another configuration
    double volume; ///< of a bare point: |det J_d|, columns scaled
    double gap;    ///< ||phi||
    double tol;    ///< that q was closed to; infinite when it was only located
} hn_chart_point;

typedef struct hn_chart {
    const hn_system *sys;
    int nq, nv, nc, rank, r; ///< r = nv - rank
    bool advises;            ///< failures name the coordinate that would pass
    bool plain_only;         ///< only coordinates with a position of their own may be independent
    /// entries that are not identically zero, and where: borrowed from the evaluators
    int n_J, n_M;
    const int *J_row, *J_col, *M_row, *M_col;
    int *jd_entry, *jd_row, *jd_col; ///< entries of J that are in J_d, and their places there
    int n_jd;
    int *dep_at;                ///< nv: where a column is in dep, -1: independent
    int *at;                    ///< nv: its entry of q, -1 for the speed of a ball
    hn_eval *loop, *full;       ///< phi, phi_t, J; and M, f, gamma
    int *dep, *ind;             ///< rank and r column numbers, ascending
    double *scale;              ///< nv, what counts as one: makes columns of J comparable
    bool with_rate;             ///< gamma is evaluated, c of (2) enters (3); else c is 0
    hn_chart_point here, probe; ///< where the right-hand side is, and one for looking elsewhere
    hn_chart_point base;        ///< the last accepted state: q, N, s, t and sign alone
    hn_qr all;                  ///< pivoted factor of all of J, for choosing
    /// of a large mechanism: the same sparsely; NULL: not large, or its rows meet too often
    hn_column_choice *choice;
    hn_row_check *check;
    double *entry;                       ///< n_J: entries of J, columns scaled
    double *c, *Mx, *A, *z, *dq, *delta; ///< scratch
    double *follow_q, *follow_ind;       ///< nq, nv: scratch of chart_follow.h
    double *basis, *columns;             ///< scratch of the choice
    int *order, *new_dep;
    int *first_dep, has_first; ///< the first choice of all
    /// largest of the smallest pivots of the scaled J_d where charts were chosen
    double pivot_start;
    bool is_measured;    ///< the next three belong to the present choice
    double volume_start; ///< logarithm of |det J_d| there
    double volume_unit;  ///< 1 / |det J_d| there
    /// |det J_d| against that at the last accepted state, and its rate where has_rate is set
    double volume, volume_rate;
    bool has_rate;
    double length;   ///< characteristic length [m]
    hn_dyads *dyads; ///< borrowed: loops are closed by these formulas; NULL: by Newton's method
    hn_cost cost;
    char why[HN_CHART_TEXT];
} hn_chart;

#define HN_CHART_TOL 1e-13      ///< ||phi|| / length inside a step
#define HN_CHART_TOL_FINE 5e-16 ///< at the end of a step: as far as rounding allows
#define HN_CHART_TAU 0.2 ///< a volume of J_d below this fraction of the best calls for a new choice
/// The chart has ended where the smallest pivot of J_d is this fraction of the one it began with.
#define HN_CHART_FOLD 1e-4

/// A failure in words with the first independent coordinate's name and value.
hn_status hn_chart_fail(hn_chart *chart, hn_status status, double t, const double *q,
                        const char *what);

#endif
