// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_COMPARISON_DOC_H
#define HN_SESSION_COMPARISON_DOC_H
// The documents of a comparison: what its methods are, one frame, and the table at the end.

#include "session/compare/comparison.h"

/// Writes the present frame: {"frame","t","finished","methods":[{"state","t","points":[...],"gap",
/// "velocity_gap","energy","work","energy_change","steps","evals","ops","cpu","step_cpu":{"median",
/// "low","high","frames"},"worst_gap",...}]}; step_cpu as hn_step_cost
void hn_comparison_frame_json(hn_strbuf *b, const hn_comparison *c);
/// Optional members of a frame: an array each, with an entry for each method.
typedef enum hn_frame_extra {
    HN_FRAME_SIGMA_MIN, ///< hn_run_sigma_min() after the last step
    HN_FRAME_LAMBDA,    ///< multipliers of the sample, an array
    HN_FRAME_CONDITION, ///< hn_run_condition() after the last step
    HN_FRAME_EXTRAS
} hn_frame_extra;
const char *hn_frame_extra_name(hn_frame_extra extra); ///< "sigma_min"
void hn_comparison_extra_json(hn_strbuf *b, const hn_comparison *c, hn_frame_extra extra);
/// Writes the properties of the methods (spelling, short name, colour slot, rule, order), frame_dt
/// and duration.
void hn_comparison_json(hn_strbuf *b, const hn_comparison *c);
/// Writes the final table: status, reason, time reached, largest violations, largest change of
/// energy, steps, rejected steps, evaluations, operations and CPU time per method; then the
/// incidents.
void hn_comparison_summary_json(hn_strbuf *b, const hn_comparison *c);

#endif
