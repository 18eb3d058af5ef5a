// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_REMEDY_WORDS_H
#define HN_TUI_REMEDY_WORDS_H
// What is said of a remedy of the selected method, and in which order remedies are offered.

#include "tui/workbench.h"

enum { HN_MOST_INCIDENTS = 512 };

/// The incidents of a recording: n of them, each with the method whose it is.
typedef struct hn_incident_list {
    int n;
    hn_incident at[HN_MOST_INCIDENTS];
    int whose[HN_MOST_INCIDENTS];
} hn_incident_list;

/// Place of a remedy among the others, the best first.
typedef enum hn_remedy_rank {
    HN_REMEDY_CURES,   ///< a trial removed the incident
    HN_REMEDY_DELAYS,  ///< a trial removed it, but nothing closes the loop: it comes later
    HN_REMEDY_UNTRIED, ///< no trial, or none yet
    HN_REMEDY_RUNS,    ///< a method that runs already
    HN_REMEDY_RANKS
} hn_remedy_rank;

/// Fills the list; borrowed until the next call.
const hn_incident_list *hn_incident_list_get(const hn_workbench *w);
/// What a trial of the remedy gave the selected method: of several the one that went farthest; ""
/// where none was made.
const char *hn_remedy_tried(const hn_workbench *w, const hn_incident_list *list,
                            const char *remedy);
hn_remedy_rank hn_remedy_rank_of(const hn_workbench *w, const hn_incident_list *list,
                                 const char *remedy);
/// Why a shorter step is no cure: "only puts it off, as nothing closes the loop"; static.
extern const char HN_REMEDY_PUTS_OFF[];
/// Writes lengths and energies of a text as the table has them: "0.00066 m" as "660 µm".
void hn_short_units(const char *text, char *out, size_t size);
#endif
