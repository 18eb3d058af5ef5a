#ifndef HN_FORMULATIONS_CHART_H
#define HN_FORMULATIONS_CHART_H
// A chart of the closed mechanism: speeds split into dependent and independent ones, J = [J_d J_i]
// P, so that
//
//  q_d by Newton on phi = 0,    v = N u + s,   N = [I; -J_d^-1 J_i],   s = [0; -J_d^-1 phi_t]  (1)
//  a = N u' + c,                   c = [0; -J_d^-1 gamma]                                  (2)
//  (N' M N) u' = N' (f - M c)                                                              (3)
//
// where u are the independent speeds. The basis rate needs no differentiation: with this N, N' u
// plus the rate of s is exactly c. A chart ends where det J_d = 0 (a dead point of the chosen
// coordinates); the mechanism does not.
//
// A square J_d (no redundant rows) is factored sparse, in an order chosen where the chart was
// chosen, and M and J are taken entry by entry, so that an evaluation costs what they hold:
// linearly for a chain of loops. With redundant rows J_d holds rank J columns and is solved in the
// least-squares sense by dense QR, which for consistent rows is exact.
//
// Positions move along speeds (hn_system_move), so balls need no chart of their own; but the speed
// of a ball has no position of its own and cannot be integrated alone: minimal coordinates keep
// balls dependent (see minimal_state.h).
//
// Null-space, partitioning and reduced coordinates are built on this. Source: Wehage & Haug 1982;
// for which columns to take, Goreinov, Tyrtyshnikov & Zamarashkin 1997 (submatrices of locally
// maximal volume).

#include "dynamics/analyse/dyads.h"
#include "dynamics/evaluate/eval.h"
#include "linalg/qr.h"
#include "linalg/sparse_lu.h"
#include "formulations/ground/formulation.h"

enum { HN_CHART_TEXT = 240 };

/// Everything that belongs to one configuration on the chart.
typedef struct hn_chart_point {
    int valid;
    double t;
    double *q; ///< nq, closed when made by hn_chart_close
    /// the entries of J that are not identically zero, in the order of hn_chart.J_row, J_col
    double *J;
    double *N;        ///< nv x r row-major
    double *s;        ///< nv
    hn_sparse_lu *lu; ///< factor of J_d when it is square, its columns scaled
    double *jd_values;
    hn_qr jd;   ///< factor of J_d otherwise, nc x rank
    int sign;   ///< of det J_d when square, else 0
    double gap; ///< ||phi||
    double tol; ///< that q was closed to; infinite when it was only located
} hn_chart_point;

typedef struct hn_chart {
    const hn_system *sys;
    int nq, nv, nc, rank, r; ///< r = nv - rank
    int plain_only; ///< 1: only coordinates with a position of their own may be independent
    /// entries that are not identically zero, and where: borrowed from the evaluators
    int n_J, n_M;
    const int *J_row, *J_col, *M_row, *M_col;
    int *jd_entry, *jd_row, *jd_col; ///< entries of J that are in J_d, and their places there
    int n_jd;
    int *dep_at;          ///< nv: where a column is in dep, -1: independent
    int *at;              ///< nv: its entry of q, -1 for the speed of a ball
    hn_eval *loop, *full; ///< phi, phi_t, J; and M, f, gamma
    int *dep, *ind;       ///< rank and r column numbers, ascending
    double *scale;        ///< nv, what counts as one: makes columns of J comparable
    int with_rate;        ///< 1: gamma is evaluated, c of (2) enters (3); 0: c is taken as zero
    hn_chart_point here, probe; ///< where the right-hand side is, and one for looking elsewhere
    hn_chart_point base;        ///< the last accepted state: q, N, s, t and sign alone
    hn_qr all;                  ///< pivoted factor of all of J, for choosing
    double *c, *Mx, *A, *z, *dq, *delta; ///< scratch
    double *basis, *columns;             ///< scratch of the choice
    int *order, *new_dep;
    int *first_dep, has_first; ///< the first choice of all
    /// largest of the smallest pivots of the scaled J_d where charts were chosen
    double pivot_start;
    int is_measured;     ///< the next two belong to the present choice
    double volume_start; ///< logarithm of |det J_d| there
    double length;       ///< characteristic length [m]
    hn_dyads *dyads;     ///< borrowed: loops are closed by these formulas; NULL: by Newton's method
    hn_cost cost;
    char why[HN_CHART_TEXT];
} hn_chart;

#define HN_CHART_TOL 1e-13      ///< ||phi|| / length inside a step
#define HN_CHART_TOL_FINE 5e-16 ///< at the end of a step: as far as rounding allows
#define HN_CHART_TAU 0.2 ///< a volume of J_d below this fraction of the best calls for a new choice
/// The chart has ended where the smallest pivot of J_d is this fraction of the one it began with.
#define HN_CHART_FOLD 1e-4

HN_MUST_CHECK hn_status hn_chart_init(hn_chart *chart, const hn_system *sys, int with_rate,
                                      hn_arena *arena, hn_diag *diag);
void hn_chart_destroy(hn_chart *chart);

/// Which column has to be independent: the number of one, or
enum {
    HN_CHART_PREFERRED =
        -1, ///< the actuated coordinates and then the first ones, as long as |det J_d| is at least
            ///< HN_CHART_TAU times the best found by pivoting, otherwise the pivots decide
    HN_CHART_BEST =
        -2 ///< when an earlier choice has become poor: columns change places while |det J_d| grows
};
/// Chooses dependent and independent columns at (t, q). Fails with HN_ERR_CHART when column `first`
/// cannot be independent or the rank differs from the one of an earlier choice, HN_ERR_UNSUPPORTED
/// when the turning of a ball would have to be independent (plain_only).
HN_MUST_CHECK hn_status hn_chart_choose(hn_chart *chart, double t, const double *q, int first);
/// The end of the chart was passed: HN_ERR_CHART with `what`; where nothing but the turning of a
/// ball could have taken over since `base` (plain_only), HN_ERR_UNSUPPORTED and the ball's name,
/// because a shorter step changes nothing about that.
hn_status hn_chart_fail_end(hn_chart *chart, double t, const double *q, const char *what);
/// 1 when changing one dependent column for an independent one would make |det J_d| at `here`
/// larger by more than 1 / tau, and at least double it. With one freedom this compares with the
/// best choice there is.
int hn_chart_is_poor(hn_chart *chart, double tau);

/// Closes the loops at `point` for given independent entries of q (nq; the dependent ones are a
/// guess, overwritten). The point then holds q, J, N, s and the factor. HN_ERR_CHART: no pose, or
/// det J_d vanished on the way.
HN_MUST_CHECK hn_status hn_chart_close(hn_chart *chart, hn_chart_point *point, double t, double *q,
                                       double tol);
/// `here` becomes the accepted state. HN_ERR_CHART when det J_d changed its sign since the last
/// one: the loop went over to its other assembly mode.
HN_MUST_CHECK hn_status hn_chart_settle(hn_chart *chart);
/// The check of hn_chart_settle() alone.
HN_MUST_CHECK hn_status hn_chart_check_mode(hn_chart *chart);
/// 1 when `point` is at (t, q) already: q (nq).
int hn_chart_is_at(const hn_chart *chart, const hn_chart_point *point, double t, const double *q);
/// J_d at the point factored; 0 when it is singular, or has come too near to it for this chart. For
/// hn_chart_locate() and close().
int hn_chart_factor(hn_chart *chart, hn_chart_point *point);
/// x (rank, in the scaled columns) <- J_d^-1 b, b (nc) overwritten.
void hn_chart_solve_dependent(hn_chart *chart, const hn_chart_point *point, double *b, double *x);
/// N and s from the factor.
void hn_chart_make_basis(hn_chart *chart, hn_chart_point *point);
double hn_chart_smallest_pivot(const hn_chart *chart, const hn_chart_point *point);
double hn_chart_log_volume(const hn_chart *chart, const hn_chart_point *point);
/// Sets the entries of J_d for a choice in dep and ind.
void hn_chart_set_columns(hn_chart *chart);
/// How |det J_d| would change if dependent column k (of dep) and independent column j (of ind)
/// changed places [-].
double hn_chart_exchange(const hn_chart *chart, const hn_chart_point *point, int k, int j);
/// 1 when all of J has full row rank nearby; for telling a dead point of the chart from a singular
/// pose.
int hn_chart_has_full_rank(hn_chart *chart, double t, const double *q);

/// The point at q as it is, closed or not: J, N, s and the factor.
HN_MUST_CHECK hn_status hn_chart_locate(hn_chart *chart, hn_chart_point *point, double t,
                                        const double *q);
/// q (nq) from independent entries q_ind (r, plain coordinates), the others predicted along the
/// tangent at `base`.
void hn_chart_predict(hn_chart *chart, double t, const double *q_ind, double *q);
/// The same along the tangent at another point.
void hn_chart_predict_from(const hn_chart *chart, const hn_chart_point *from, double t,
                           const double *q_ind, double *q);
/// A step went through the pose where the two ways of assembling step `step` of chart.dyads meet;
/// `here` is no longer valid.
hn_status hn_chart_fail_dyad(hn_chart *chart, int step);
/// v = N u + s at the point.
void hn_chart_speeds(const hn_chart *chart, const hn_chart_point *point, const double *u,
                     double *v);
/// |det J_d| at `here`, relative to where the chart was chosen.
double hn_chart_volume(const hn_chart *chart);
/// u' of equation (3) at `here` with speeds v.
HN_MUST_CHECK hn_status hn_chart_accel(hn_chart *chart, const double *v, double *u_dot);
/// x <- A^-1 x with the r x r matrix of (3) left in chart->A (lower triangle, spoiled).
HN_MUST_CHECK hn_status hn_chart_solve_reduced(hn_chart *chart, double t, double *x);
/// A failure in words with the first independent coordinate's name and value.
hn_status hn_chart_fail(hn_chart *chart, hn_status status, double t, const double *q,
                        const char *what);
/// Adds counters and tape operations.
void hn_chart_add_cost(const hn_chart *chart, hn_cost *cost);

#endif
