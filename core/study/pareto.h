#ifndef HN_STUDY_PARETO_H
#define HN_STUDY_PARETO_H
// Which method for which accuracy: the cheapest finished point per band, the front over all points, and what each method
// reaches for the same cost. A method that converges to something else takes no part.

#include "study/classing.h"

typedef enum hn_cost_kind { HN_COST_TIME, HN_COST_OPS, HN_COST_EVALS, HN_COST_COUNT } hn_cost_kind;
const char *hn_cost_name(hn_cost_kind kind);                ///< "time", "operations", "evaluations"
double hn_wp_cost(const hn_wp_point *p, hn_cost_kind kind); ///< NaN where it was not measured

/// Medians within 10 %, or quartiles that overlap, are not ranked.
#define HN_PARETO_CLOSE 1.10
enum { HN_PARETO_BANDS = 14, HN_RACE_COSTS = 3 };

typedef struct hn_place {
    int method, level; ///< the point that reaches it; -1: none
    double cost;       ///< of just reaching it
} hn_place;

/// Who reaches an accuracy for the least. What just reaching it costs is read off between the points around it, by a straight line in the
/// logarithms, so that the grain of a ladder decides nothing; the coarsest point of a method is never undercut.
typedef struct hn_band {
    double accuracy;
    hn_place best; ///< -1: nobody reaches it
    hn_place next; ///< the cheapest of another method
    double ratio;  ///< its cost over the best one's
    int n_close;   ///< other methods that cannot be told from the best
    int close[HN_WP_METHODS];
} hn_band;

typedef struct hn_pareto {
    hn_cost_kind cost;
    hn_error_kind error;
    int few; ///< 1: points were timed fewer than HN_WP_ENOUGH times, so that times are not ranked
    int n_bands; ///< 1e-1, 1e-2, ... down to the best error reached
    hn_band band[HN_PARETO_BANDS];
} hn_pareto;

/// `classes` one per method. Errors below the reference's own count as HN_WP_ABOVE_REFERENCE times that.
void hn_wp_pareto(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                  hn_pareto *out);
/// 1 if no point is both cheaper and more accurate.
int hn_wp_on_front(const hn_wp *wp, const hn_class *classes, hn_error_kind error, hn_cost_kind cost,
                   int m, int k);

/// What each method reaches for the same number of operations: between two of its points by a straight line in the logarithms,
/// never before them (NaN). Behind the dearest point the smallest error so far is a bound.
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
