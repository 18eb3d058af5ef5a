// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_HTML_H
#define HN_SESSION_PRECISION_STUDY_HTML_H
// The study as one HTML file, without network and without scripts. Radio buttons and style sheet
// rules choose the plot, so the page works in any browser; in print the chosen plot appears.

#include "session/precision/study.h"
#include "session/precision/study_page.h"

#include <stdbool.h>

/// Writes the page: plots, tables and sentences; light and dark; for screen and paper.
void hn_study_html(hn_strbuf *b, const hn_study *study);
/// Writes <!doctype> to <main>: the colours of both themes, the common styles, and then `style`.
void hn_page_head(hn_strbuf *b, const char *title, const char *style);
/// Writes the colour variables of plots: "--paper:#FCFCFA;...".
void hn_page_theme(hn_strbuf *b, hn_theme theme);
/// Writes how CPU time was measured and when it is ranked. The text is the same for every study.
void hn_page_timing(hn_strbuf *b);
bool hn_study_is_timed(const hn_study *s);
void hn_study_put_chaos(hn_strbuf *b, const hn_study *s); ///< one line
void hn_study_put_plots(hn_strbuf *b, const hn_study *s); ///< every error against every cost
void hn_study_put_race(hn_strbuf *b, const hn_study *s, int level);
void hn_study_put_answers(hn_strbuf *b,
                          const hn_study *s); ///< the cheapest method for each accuracy
void hn_study_put_method(hn_strbuf *b, const hn_study *s,
                         int m); ///< the head of a row: key and spelling
/// Writes each line of `text` as an item of a list.
void hn_page_lines(hn_strbuf *b, const char *text);
/// Opens <div><table>, which scrolls sideways where it is wider than the page, also by keyboard.
/// `name` is its accessible name. The caller closes both.
void hn_page_table(hn_strbuf *b, const char *name);
void hn_study_put_points(hn_strbuf *b, const hn_study *s);
void hn_study_put_methods(hn_strbuf *b, const hn_study *s, int level);
/// Writes radio buttons for the error and the cost. A following element of class "plots" shows the
/// chosen plot.
void hn_page_choices(hn_strbuf *b, hn_cost_kind first);
/// Opens a scrolling <div>, as hn_page_table() does, around other content. The caller closes it.
void hn_page_scroll(hn_strbuf *b, const char *name);
void hn_study_put_failures(hn_strbuf *b, const hn_study *s, int level);
void hn_study_put_measures(hn_strbuf *b, const hn_study *s,
                           int level); ///< the reference, and the scales of the errors
#endif
