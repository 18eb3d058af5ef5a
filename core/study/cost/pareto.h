// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_STUDY_PARETO_H
#define HN_STUDY_PARETO_H
// Finds the cheapest method for an accuracy: the cheapest finished point per band, and the
// accuracy of each method at equal cost. A method that converges to a different solution takes no
// part.
//
// Counts are exact; times are ranked only where a second measurement would say the same: the two
// halves of the samples of both methods agree, and the methods differ by more than 10 % and by more
// than the spread of either. Otherwise the sentence says why, and ranks by operations.
//
// If neighbouring motions part exponentially and the study ends beyond the horizon (chaos.h), no
// error along the motion is ranked: only gaps and energy, which every motion nearby keeps too,
// still say something of a method.

#include "study/cost/classing.h"

#include <stdbool.h>

typedef enum hn_cost_kind { HN_COST_TIME, HN_COST_OPS, HN_COST_EVALS, HN_COST_COUNT } hn_cost_kind;
const char *hn_cost_name(hn_cost_kind kind);                ///< "time", "operations", "evaluations"
double hn_wp_cost(const hn_wp_point *p, hn_cost_kind kind); ///< NaN where it was not measured

/// Medians within 10 %, or ranges (quartiles and halves' medians) that overlap, are not ranked.
#define HN_PARETO_CLOSE 1.10
/// Nor are times whose two halves have medians further apart than this, nor parts whose yardsticks
/// are.
#define HN_PARETO_STEADY 1.10
enum { HN_PARETO_BANDS = 14, HN_RACE_COSTS = 3 };

typedef struct hn_place {
    int method, level; ///< the point that reaches it; -1: none
    int from;          ///< the coarser point that the cost is read off between, -1: none
    double cost;       ///< of just reaching it
} hn_place;

#define HN_RANKING_LIST(X)                   \
    X(HN_RANKING_CLEAR, "ranked")            \
    X(HN_RANKING_CLOSE, "too close to rank") \
    X(HN_RANKING_UNSTEADY, "the halves of the timing disagree")
/// Reliability of the ranking of a band's times.
typedef enum hn_ranking {
#define HN_RANKING_ENUM(code, name) code,
    HN_RANKING_LIST(HN_RANKING_ENUM)
#undef HN_RANKING_ENUM
} hn_ranking;
const char *hn_ranking_name(hn_ranking ranking);

/// The method that reaches an accuracy for the least. The cost of just reaching it is interpolated
/// between the points around it, by a straight line in the logarithms, so that the grain of a
/// ladder decides nothing; the coarsest point of a method is never undercut.
typedef struct hn_band {
    double accuracy;
    hn_place best; ///< -1: no method reaches it
    hn_place next; ///< the cheapest of another method
    double ratio;  ///< its cost over the best one's
    hn_ranking ranking;
    int n_close; ///< other methods that do not differ significantly from the best
    hn_place close[HN_WP_METHODS];
    /// the point, of the best or of the next, whose halves are furthest apart; -1: they agree
    hn_place unsteady;
} hn_band;

typedef struct hn_pareto {
    hn_cost_kind cost;
    hn_error_kind error;
    bool few; ///< points were timed fewer than HN_WP_ENOUGH times, so that times are not ranked
    bool clocks_differ; ///< nor are those of parts whose yardsticks are apart, or unknown
    /// 1: the study ends where errors of this kind say nothing: there are no bands
    int beyond_horizon;
    int n_bands; ///< 1e-1, 1e-2, ... down to the best error reached
    hn_band band[HN_PARETO_BANDS];
    hn_band counted[HN_PARETO_BANDS]; ///< of times: the same bands by operations
} hn_pareto;

/// Returns the error that methods are ranked by: coordinates, or energy beyond the horizon.
hn_error_kind hn_wp_ranked_error(const hn_wp *wp);
/// Returns the error of a point, or the bound that the accuracy of the reference sets.
double hn_wp_claimed(const hn_wp *wp, const hn_wp_point *p, hn_error_kind error);
/// Returns where a method reaches an accuracy at the least cost; level -1: nowhere.
hn_place hn_wp_reach(const hn_wp *wp, const hn_class *classes, hn_error_kind error,
                     hn_cost_kind kind, int m, double accuracy);
/// Finds who reaches an accuracy for the least.
void hn_wp_band(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                double accuracy, hn_band *out);
/// `classes` one per method. Errors below the reference's own count as HN_WP_ABOVE_REFERENCE times
/// that.
void hn_wp_pareto(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                  hn_pareto *out);

/// The error of each method for the same number of operations: between two of its points by a
/// straight line in the logarithms, NaN before its first point. Beyond its dearest point the
/// smallest error so far is a bound.
typedef struct hn_race {
    int n;
    double cost[HN_RACE_COSTS]; ///< operations
    double error[HN_RACE_COSTS][HN_WP_METHODS];
    int is_bound[HN_RACE_COSTS][HN_WP_METHODS]; ///< 1: this or less
} hn_race;
void hn_wp_race(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_race *out);

struct hn_strbuf;
/// One sentence a run of bands with the same answer, a line each.
void hn_pareto_sentences(struct hn_strbuf *b, const hn_wp *wp, const hn_pareto *p);
#endif
