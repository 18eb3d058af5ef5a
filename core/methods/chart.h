#ifndef HN_METHODS_CHART_H
#define HN_METHODS_CHART_H
// A chart of the closed mechanism: speeds split into dependent and independent ones, J = [J_d J_i] P, so that
//
//     q_d by Newton on phi = 0,       v = N u + s,   N = [I; -J_d^-1 J_i],   s = [0; -J_d^-1 phi_t]           (1)
//     a = N u' + c,                   c = [0; -J_d^-1 gamma]                                                  (2)
//     (N' M N) u' = N' (f - M c)                                                                              (3)
//
// where u are the independent speeds. The basis rate needs no differentiation: with this N, N' u plus the rate of s is
// exactly c. A chart ends where det J_d = 0 (a dead point of the chosen coordinates); the mechanism does not.
//
// Redundant rows: J_d holds rank J columns and is solved in the least-squares sense by QR, which for consistent rows is
// exact. Null-space, partitioning and reduced coordinates are built on this. Source: Wehage & Haug 1982.

#include "dynamics/eval.h"
#include "linalg/qr.h"
#include "methods/method.h"

enum { HN_CHART_TEXT = 240 };

/// Everything that belongs to one configuration on the chart.
typedef struct hn_chart_point {
    int valid;
    double t;
    double *q;  ///< nv, closed when made by hn_chart_close
    double *J;  ///< nc x nv
    double *N;  ///< nv x r row-major
    double *s;  ///< nv
    hn_qr jd;   ///< factor of J_d, nc x rank
    int sign;   ///< of det J_d when square, else 0
    double gap; ///< ||phi||
    double tol; ///< that q was closed to; infinite when it was only located
} hn_chart_point;

typedef struct hn_chart {
    const hn_system *sys;
    int nv, nc, rank, r;  ///< r = nv - rank
    hn_eval *loop, *full; ///< phi, phi_t, J; and M, f, gamma
    int *dep, *ind;       ///< rank and r column numbers, ascending
    double *scale;        ///< nv, 1 / sqrt(M_jj) at the start: makes columns of J comparable
    int with_rate;        ///< 1: gamma is evaluated, c of (2) enters (3); 0: c is taken as zero
    hn_chart_point here, probe;  ///< where the right-hand side is, and one for looking elsewhere
    hn_chart_point base;         ///< the last accepted state: q, N, s, t and sign alone
    hn_qr all;                   ///< pivoted factor of all of J, for choosing
    double *c, *Mx, *A, *z, *dq; ///< scratch
    double *basis, *columns;     ///< scratch of the choice
    int *order, *new_dep;
    double
        pivot_start; ///< smallest pivot of the scaled J_d where the chart was chosen, 0: not known yet
    double volume_start; ///< logarithm of |det J_d| there
    double length;       ///< characteristic length [m]
    hn_cost cost;
    char why[HN_CHART_TEXT];
} hn_chart;

#define HN_CHART_TOL 1e-13      ///< ||phi|| / length inside a step
#define HN_CHART_TOL_FINE 5e-16 ///< at the end of a step: as far as rounding allows
#define HN_CHART_TAU 0.2 ///< a volume of J_d below this fraction of the best calls for a new choice
#define HN_CHART_FOLD \
    1e-4 ///< the chart has ended where the smallest pivot of J_d is this fraction of the one it began with

/// Refuses (HN_ERR_UNSUPPORTED, diag) systems whose speeds are not the rates of their coordinates.
HN_MUST_CHECK hn_status hn_chart_init(hn_chart *chart, const hn_system *sys, int with_rate,
                                      hn_arena *arena, hn_diag *diag);
void hn_chart_destroy(hn_chart *chart);

/// Which column has to be independent: the number of one, or
enum {
    HN_CHART_PREFERRED =
        -1, ///< the actuated coordinates and then the first ones, as long as |det J_d| is at least
            ///< HN_CHART_TAU times the best found by pivoting, otherwise the pivots decide
    HN_CHART_BEST = -2 ///< the pivots decide: when an earlier choice has become poor
};
/// Chooses dependent and independent columns at (t, q). Fails with HN_ERR_CHART when column `first` cannot be independent, or when
/// the rank differs from the one of an earlier choice.
HN_MUST_CHECK hn_status hn_chart_choose(hn_chart *chart, double t, const double *q, int first);
/// 1 when J_d at `here` has fallen below tau times the best choice and a better one exists (more than twice as good).
int hn_chart_is_poor(hn_chart *chart, double tau);

/// Closes the loops at `point` for given independent entries of q (nv; the dependent ones are a guess, overwritten).
/// The point then holds q, J, N, s and the factor. HN_ERR_CHART: no pose, or det J_d vanished on the way.
HN_MUST_CHECK hn_status hn_chart_close(hn_chart *chart, hn_chart_point *point, double t, double *q,
                                       double tol);
/// `here` becomes the accepted state. HN_ERR_CHART when det J_d changed its sign since the last one: the loop went over
/// to its other assembly mode.
HN_MUST_CHECK hn_status hn_chart_settle(hn_chart *chart);
/// The check of hn_chart_settle() alone.
HN_MUST_CHECK hn_status hn_chart_check_mode(hn_chart *chart);
/// 1 when `point` is at (t, q) already: q (nv).
int hn_chart_is_at(const hn_chart *chart, const hn_chart_point *point, double t, const double *q);
/// The point at q as it is, closed or not: J, N, s and the factor.
HN_MUST_CHECK hn_status hn_chart_locate(hn_chart *chart, hn_chart_point *point, double t,
                                        const double *q);
/// q (nv) from independent entries q_ind (r), the dependent ones predicted along the tangent at `base`.
void hn_chart_predict(const hn_chart *chart, double t, const double *q_ind, double *q);
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
