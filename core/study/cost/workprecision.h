// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_WORKPRECISION_H
#define HN_STUDY_WORKPRECISION_H
// Error against cost: each method over a ladder of steps (fixed) or tolerances (adaptive), every
// finished point with six errors against the reference solution, what it counted, and its CPU time.
// measure.h runs it.
//
// A study may be one part of several (shards.h): then only its own points are run, and one more run
// is timed in every round, the yardstick. It is the same in all parts, so that parts whose clocks
// ran differently are found out.

#include "study/run/ending.h"
#include "study/truth/errors.h"
#include "study/truth/refined.h"

#include <stdbool.h>

enum { HN_WP_METHODS = 24, HN_WP_LEVELS = 10, HN_WP_SAMPLES = 10, HN_WP_ENOUGH = 4 };
#define HN_WP_BUSY 1.05          ///< wall over CPU time beyond which the machine is busy
#define HN_WP_ABOVE_REFERENCE 10 ///< errors below this times the reference's own are bounds

typedef enum hn_wp_state {
    HN_WP_PENDING,
    HN_WP_DONE,
    HN_WP_FAILED,  ///< the run ended early, or the method cannot serve the scene: status and reason
    HN_WP_SKIPPED, ///< left out to keep the time limit: reason
    HN_WP_STATES
} hn_wp_state;
const char *hn_wp_state_name(hn_wp_state state); ///< "done"

typedef struct hn_wp_point {
    double size; ///< h [s] or rtol
    hn_wp_state state;
    hn_status status;
    char reason[HN_DIAG_MESSAGE];
    hn_ending ending;             ///< of a failed point, as data
    double t_reached;             ///< [s]
    double worst[HN_ERROR_COUNT]; ///< over the reference's times and those between (refined.h)
    int times;                    ///< how many these are
    bool too_long; ///< there are no more of them because finding the true motion takes too long
    double end[HN_ERROR_COUNT];
    /// how far the end's coordinates are from those of the next coarser point; NaN: there is none
    double own;
    double *end_q;   ///< n_user
    long long steps; ///< accepted
    long long rejected;
    hn_cost cost;
    double first_cpu; ///< of the warm-up run [s]
    int n_samples;
    double sample[HN_WP_SAMPLES]; ///< CPU seconds of one run, in the order they were taken
    int busy;                     ///< samples that were kept although the machine was busy
    double median, spread;        ///< [s]; (q75 - q25) / median
    double low, high;             ///< quartiles [s]
    double half[2];               ///< medians of the first and the second half [s]; NaN: too few
} hn_wp_point;

typedef struct hn_wp_method {
    hn_method_spec spec;
    char spelling[HN_SPEC_MAX]; ///< without step or tolerance
    bool adaptive;
    hn_wp_point point[HN_WP_LEVELS];
} hn_wp_method;

typedef struct hn_wp_opts {
    int n_levels;  ///< 2..HN_WP_LEVELS; 0: 7
    int n_samples; ///< of time; 0: HN_WP_SAMPLES; -1: none
    /// the coarsest fixed step is the next below this that divides the reference's intervals [s];
    /// 0: the scene's, times 4
    double step;
    double time_limit;   ///< wall time [s]; 0: none
    int shard, n_shards; ///< part 1..n_shards; 0, 0: the whole
} hn_wp_opts;

typedef struct hn_wp {
    hn_arena *arena; ///< owns everything below but the reference
    const hn_system *sys;
    const double *q, *v; ///< where runs start, system coordinates
    const hn_ref *ref;
    hn_refined *refined; ///< made when the first point is run; NULL before
    hn_errors *errors;
    hn_wp_opts opts;
    int n_methods, n_levels;
    hn_wp_method *methods;
    int *shard;            ///< n_methods x n_levels: the part that a point belongs to
    hn_run **runs;         ///< n_methods x n_levels, made when a point is first run
    hn_wp_point yardstick; ///< of a part: samples of a run that is the same in all parts
    int yardstick_method;
    hn_run *yardstick_run;
    /// put together from parts: the slowest yardstick over the fastest; NaN: not known; 1: one
    /// clock
    double clocks_apart;
    /// from then on errors say nothing of methods (chaos.h) [s]; 0: they do to the end
    double horizon;
    bool out_of_time; ///< the time limit left something out
    bool stopped;     ///< stopped on request
    hn_status status; ///< HN_ERR_MEMORY: the last hn_wp_run() could not go on; else HN_OK
    double elapsed;   ///< wall time of all hn_wp_run() [s]
} hn_wp;

/// A study of n methods to the end of the reference. Sizes in the specs are replaced by the ladder.
/// Nothing runs yet. The system, the state and the reference must outlive it. Fails: HN_ERR_INPUT
/// (numbers of methods and levels), HN_ERR_MEMORY, HN_ERR_LIMIT; told in diag.
HN_MUST_CHECK hn_status hn_wp_create(const hn_system *sys, const double *q, const double *v,
                                     const hn_ref *ref, const hn_method_spec *specs, int n,
                                     const hn_wp_opts *opts, hn_wp **out, hn_diag *diag);
void hn_wp_free(hn_wp *wp); ///< NULL is legal
/// Returns whether the point is run here: of the whole, or of this part.
bool hn_wp_is_mine(const hn_wp *wp, int m, int k);
/// Frees the run of a point, or all of them and the yardstick's: they are made anew when needed.
void hn_wp_drop_run(hn_wp *wp, int m, int k);
void hn_wp_drop_runs(hn_wp *wp);
/// Median, quartiles, spread and the halves' medians from the samples.
void hn_wp_point_statistics(hn_wp_point *p);
/// The larger of the halves' medians over the smaller; NaN while there are fewer than HN_WP_ENOUGH
/// samples.
double hn_wp_point_halves_apart(const hn_wp_point *p);
/// `own` of every point, from the ends: how far each is from the next coarser one that came to its
/// end.
void hn_wp_compare_ends(hn_wp *wp);
/// Method m with a step or tolerance of one's own.
hn_method_spec hn_wp_spec(const hn_wp *wp, int m, double size);
/// The spelling of one point, with its size.
void hn_wp_spelling(const hn_wp *wp, int m, int k, char out[HN_SPEC_MAX]);
/// Returns whether the study ends where errors along the motion say nothing.
bool hn_wp_is_beyond_horizon(const hn_wp *wp);
/// 1 if the error is one: finite, and above HN_WP_ABOVE_REFERENCE times the reference's own;
/// otherwise it is a bound.
bool hn_wp_is_resolved(const hn_wp *wp, hn_error_kind kind, double error);
#endif
