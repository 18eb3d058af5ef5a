// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_DAE_BASE_H
#define HN_INTEGRATORS_DAE_BASE_H
// Common part of the integrators of the differential-algebraic system: evaluators of its terms,
// consistent accelerations and multipliers to begin from, and the constraint rows that count.
//
// Redundant rows. A Newton matrix with dependent rows of J has no inverse. Newton's iterates are
// not closed, and there rows that depend on each other at closed configurations are independent. So
// each step begins by choosing independent rows at its closed first configuration, by
// column-pivoted QR of J', and goes on with those alone; the other rows follow, because every
// motion that keeps the chosen rows closed keeps them closed. The multipliers of rows left out are
// 0 inside a scheme.

#include "dynamics/evaluate/accel.h"
#include "dynamics/evaluate/eval.h"
#include "integrators/step/dae.h"
#include "linalg/newton_matrix.h"
#include "linalg/qr.h"
#include "linalg/row_check.h"

enum { HN_DAE_WHY_TEXT = 240 };

typedef struct hn_dae_base {
    const hn_system *sys;
    int nq, nv, nc;
    double length; ///< hn_system_length()
    hn_accel *accel;
    hn_eval *dyn;  ///< M, f
    hn_eval *loop; ///< phi, phi_t, J
    /// the terms last evaluated; NULL where there are no rows
    const double *M, *f, *phi, *phi_t, *J;
    int nr;        ///< rows that count, see hn_dae_choose_rows()
    int rank_seen; ///< largest rank met at a closed pose
    int *rows;     ///< their numbers
    int *place;    ///< nc: which of the chosen rows this is; -1: left out
    hn_qr qr;
    hn_row_check *check; ///< NULL: the pivoted QR always chooses
    int sparse;          ///< Newton matrices of these equations are to be sparse
    /// entries of M's lower triangle and of J that are not identically zero
    int n_M, n_J;
    const int *M_row, *M_col, *J_row, *J_col;
    double *column_unit; ///< nv: see hn_system_velocity_unit
    double *arm, *gap;   ///< nv, nc: scratch
    hn_cost cost;        ///< what the evaluators do not count themselves
    char why[HN_DAE_WHY_TEXT];
} hn_dae_base;

/// Fails: HN_ERR_MEMORY, HN_ERR_LIMIT, told in diag.
HN_MUST_CHECK hn_status hn_dae_base_init(hn_dae_base *b, const hn_system *sys, hn_arena *arena,
                                         hn_diag *diag);
void hn_dae_base_destroy(hn_dae_base *b);
void hn_dae_base_add_cost(const hn_dae_base *b, hn_cost *cost);
const char *hn_dae_base_why(const hn_dae_base *b);

/// M and f at (t, q, v); phi, phi_t and J at (t, q).
void hn_dae_dynamics(hn_dae_base *b, double t, const double *q, const double *v);
void hn_dae_loops(hn_dae_base *b, double t, const double *q);
/// Chooses the rows that count from J last evaluated.
void hn_dae_choose_rows(hn_dae_base *b);
/// A matrix of size n_max filled by `fillings` of M and `borders` of the chosen rows of J or their
/// transpose, and `more` puts.
HN_MUST_CHECK hn_newton_matrix *hn_dae_matrix_create(const hn_dae_base *b, hn_arena *arena,
                                                     int n_max, int fillings, int borders,
                                                     int more);
/// Puts s M, and s times the chosen rows of J (nc x nv) or their transpose, with the first entry at
/// (row, col).
void hn_dae_put_mass(const hn_dae_base *b, hn_newton_matrix *to, double s, int row, int col);
void hn_dae_put_rows(const hn_dae_base *b, hn_newton_matrix *to, const double *J, double s, int row,
                     int col);
void hn_dae_put_columns(const hn_dae_base *b, hn_newton_matrix *to, const double *J, double s,
                        int row, int col);
/// to (nc x nv) = J last evaluated; entries that are identically zero are not touched.
void hn_dae_copy_rows(const hn_dae_base *b, double *to);
/// out (nv) = M x at M last evaluated.
void hn_dae_mass_times(const hn_dae_base *b, const double *x, double *out);
/// out (nr) = J v + phi_t of the chosen rows, at the terms last evaluated.
void hn_dae_speed_gap(hn_dae_base *b, const double *v, double *out);
/// out (nv) += s J' x for x (nr) on the chosen rows of J.
void hn_dae_add_rows(const hn_dae_base *b, const double *J, double s, const double *x, double *out);
/// out (nc) = x (nr) on the chosen rows, 0 elsewhere.
void hn_dae_spread_rows(const hn_dae_base *b, const double *x, double *out);

/// Consistent a (nv) and lambda (nc, may be NULL) at a state; a failure is told in `why`.
HN_MUST_CHECK hn_status hn_dae_accelerate(hn_dae_base *b, double t, const double *q,
                                          const double *v, double *a, double *lambda);
/// Returns the relative size of a displacement `delta` (nv), for the stopping test of Newton [-].
///
/// The size is taken in the mass norm, with the mass matrix last evaluated. It is divided by the
/// largest of three displacements: that of the whole step, `moved` (nv); the coordinates
/// themselves; and the one that opens a loop by the mechanism's length. The result is therefore the
/// same in any units, and rounding of the coordinates cannot keep it above a tolerance.
double hn_dae_newton_size(hn_dae_base *b, const double *delta, const double *moved,
                          const double *q);
/// Records that `what` failed at time t, for the reason of the run, and returns `status`.
hn_status hn_dae_fail(hn_dae_base *b, hn_status status, double t, const char *what);

/// Why a step of the ggl form has no answer where the mass matrix has no inverse: names the first
/// coordinate without mass. M_jj is mass[j * apart], as in hn_unit_scales().
void hn_dae_tell_massless(const hn_system *sys, const double *mass, int apart, double t, char *why,
                          size_t size);

/// After how many steps integrators of the index-2 form project the position onto the constraints:
/// a number of steps, or one of these.
enum { HN_CLOSE_NEVER = -1, HN_CLOSE_DEPENDENT = 0 };
/// The setting "close" of index 2; of the other forms HN_CLOSE_NEVER.
int hn_dae_close_option(hn_dae_form form, const double *form_options);
/// Returns 1 where the options of the index-3 form ask for velocities that are projected at the end
/// of each step.
int hn_dae_projects_speeds(hn_dae_form form, const double *form_options);
/// The refusal of an integrator that does not do that; HN_OK where it is not asked for.
HN_MUST_CHECK hn_status hn_dae_refuse_projecting(hn_dae_form form, const double *form_options,
                                                 const char *integrator, hn_diag *diag);
/// Begins `create` of an integrator with a scheme of its own: refuses index 3 with projected
/// velocities as above and takes `size` bytes for the instance.
HN_MUST_CHECK hn_status hn_dae_instance(hn_dae_form form, const double *form_options,
                                        const char *integrator, size_t size, hn_arena *arena,
                                        void **self, hn_diag *diag);
/// 1 when the position is to be closed at the end of step `n` (1, 2, ...), of which `dependent`
/// says that rows were left out.
int hn_dae_closes(int close, long long n, int dependent);

/// A Newton iteration watched: it has converged when the correction, or what the contraction seen
/// so far leaves of it, is below tol times the size of the unknowns, or when it has shrunk to
/// rounding and stays there.
typedef struct hn_newton {
    int iterations;
    double last;        ///< size of the last correction, relative
    double contraction; ///< of the last two corrections
} hn_newton;
typedef enum hn_newton_verdict {
    HN_NEWTON_GO_ON,
    HN_NEWTON_DONE,
    HN_NEWTON_DIVERGES
} hn_newton_verdict;
#define HN_NEWTON_TOL 1e-15      ///< of what is left after the correction just made
#define HN_NEWTON_ROUNDING 1e-11 ///< a correction below this that no longer shrinks meets rounding
enum { HN_NEWTON_MAX = 25 };
/// `size`: relative size of the correction just made, see hn_dae_newton_size().
hn_newton_verdict hn_newton_look(hn_newton *n, double size);
#endif
