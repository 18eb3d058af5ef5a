// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXTREME_EXTREME_CASE_H
#define HN_SESSION_EXTREME_EXTREME_CASE_H
// A case of the extreme matrix as data: its scenes and trials, what is predicted of each, what was
// seen, and the verdict.

#include <stdbool.h>

enum {
    HN_EXTREME_TRIALS = 32, ///< of a case
    HN_EXTREME_RUNS = 24,   ///< methods (or solvers) times scenes of a trial
    HN_EXTREME_SWEEP = 24,
    HN_EXTREME_SETTINGS = 16
};

#define HN_VERDICT_LIST(X)             \
    X(HN_EXTREME_PASS, "pass")         \
    X(HN_EXTREME_WARN, "warn")         \
    X(HN_EXTREME_FAIL, "fail")         \
    X(HN_EXTREME_LONG, "needs --long") \
    X(HN_EXTREME_NOT_RUN, "not run")
typedef enum hn_extreme_verdict {
#define HN_VERDICT_ENUM(code, name) code,
    HN_VERDICT_LIST(HN_VERDICT_ENUM)
#undef HN_VERDICT_ENUM
        HN_EXTREME_VERDICTS
} hn_extreme_verdict;

/// A prediction: a band for a number, or a word for an outcome.
typedef struct hn_extreme_expect {
    const char *word; ///< NULL: a number
    const char *says; ///< text that the reason of the outcome must contain, or NULL
    double low, high; ///< band; one side may be infinite
    double warn_low, warn_high;
    /// the number is the ratio to the limit that the spectrum of the scene gives
    int from_spectrum;
    char text[96]; ///< as people read it
    const char *reason, *source;
    const char *was, *was_why,
        *was_source; ///< an earlier prediction that was not observed, and why not; NULL: none
} hn_extreme_expect;

/// One number or outcome of a trial.
typedef struct hn_extreme_seen {
    const char *scene,
        *method;      ///< method: a spelling as in the file, or a solver's name; "" for neither
    double value;     ///< NaN: there is none
    char word[32];    ///< outcome; "" for a number
    char reason[200]; ///< why there is no number, or what the outcome said
} hn_extreme_seen;

struct hn_extreme_measure;
struct hn_extreme_quantity;

typedef struct hn_extreme_number {
    double value;
    const char *formula; ///< in the swept name; NULL: value
} hn_extreme_number;
typedef struct hn_extreme_assign {
    const char *name;
    hn_extreme_number number;
} hn_extreme_assign;
typedef struct hn_extreme_scene {
    const char *name;
    const char *shipped; ///< name of a shipped scene, or NULL
    const char *text;    ///< JSON of an own one
} hn_extreme_scene;

typedef struct hn_extreme_trial {
    const char *what;
    const struct hn_extreme_measure *measure;
    const struct hn_extreme_quantity *of; ///< NULL where the measure takes none
    int n_scenes, n_methods, n_set, n_state, n_truth, n_sweep;
    const hn_extreme_scene *scenes[HN_EXTREME_RUNS];
    const char *methods[HN_EXTREME_RUNS]; ///< {formula} in the swept name is filled in
    bool solvers;                         ///< methods are solvers of the saddle system
    int refine;                           ///< corrections allowed to them
    hn_extreme_assign set[HN_EXTREME_SETTINGS], state[HN_EXTREME_SETTINGS],
        truth[HN_EXTREME_SETTINGS];
    const char *truth_method; ///< a run that counts as exact, or NULL
    bool is_open; ///< the start is moved off row `row` of the constraints: by gap, and speed
    int row;
    double gap, speed;
    const char *sweep; ///< NULL: none
    double values[HN_EXTREME_SWEEP];
    hn_extreme_number time;
    const char *coordinate, *incident;
    double scale; ///< numbers are divided by it; default 1
    double
        limit[2]; ///< of a search for the largest stable step [s]; {0, 0}: about the predicted one
    double max_steps; ///< 0: no bound of its own
    double steps;     ///< number of steps for which a step size is tried
    bool is_long;     ///< run only when asked for
    hn_extreme_expect expect;
    // what was seen
    hn_extreme_verdict verdict;
    int n_seen;
    hn_extreme_seen seen[HN_EXTREME_RUNS];
    char observed[320];
} hn_extreme_trial;

typedef struct hn_extreme_case {
    const char *id, *title, *why, *about; ///< about: what a teacher may add, or NULL
    int n_scenes, n_trials;
    hn_extreme_scene *scenes;
    hn_extreme_trial *trials;
    hn_extreme_verdict verdict; ///< the worst of its trials
} hn_extreme_case;
#endif
