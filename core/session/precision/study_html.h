// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_PRECISION_STUDY_HTML_H
#define HN_SESSION_PRECISION_STUDY_HTML_H
// The study as one HTML file: no network, no script. Which plot shows is chosen by radio buttons
// that style sheets read, so that it works wherever a page can be opened; on paper the chosen one
// is printed.

#include "session/precision/study.h"
#include "session/precision/study_page.h"

/// One file without network: plots, tables, sentences; light and dark, for the screen and for
/// paper.
void hn_study_html(hn_strbuf *b, const hn_study *study);
/// From <!doctype> to <main>: colours of both themes, styles of what follows and `style` behind
/// them.
void hn_page_head(hn_strbuf *b, const char *title, const char *style);
/// "--paper:#FCFCFA;...": the variables that plots use.
void hn_page_theme(hn_strbuf *b, hn_theme theme);
/// How CPU time was taken, and when it is ranked: the same for every study.
void hn_page_timing(hn_strbuf *b);
int hn_study_is_timed(const hn_study *s);
void hn_study_put_chaos(hn_strbuf *b, const hn_study *s); ///< one line
void hn_study_put_plots(hn_strbuf *b, const hn_study *s); ///< every error against every cost
void hn_study_put_race(hn_strbuf *b, const hn_study *s, int level);
void hn_study_put_answers(hn_strbuf *b, const hn_study *s); ///< who is cheapest, band by band
void hn_study_put_method(hn_strbuf *b, const hn_study *s,
                         int m); ///< the head of a row: key and spelling
/// Each line of `text` as an item of a list.
void hn_page_lines(hn_strbuf *b, const char *text);
/// <div><table>: it scrolls sideways where it is wider than the page, with the keyboard too; `name`
/// is what it is called there. Close both.
void hn_page_table(hn_strbuf *b, const char *name);
void hn_study_put_points(hn_strbuf *b, const hn_study *s);
void hn_study_put_methods(hn_strbuf *b, const hn_study *s, int level);
/// Radio buttons for the error and the cost; class "plots" on elements that follow them shows the
/// plot that is chosen.
void hn_page_choices(hn_strbuf *b, hn_cost_kind first);
/// <div> that does so around anything else, plots for one. Close it.
void hn_page_scroll(hn_strbuf *b, const char *name);
void hn_study_put_failures(hn_strbuf *b, const hn_study *s, int level);
void hn_study_put_measures(hn_strbuf *b, const hn_study *s,
                           int level); ///< the reference, and what errors are over
#endif
