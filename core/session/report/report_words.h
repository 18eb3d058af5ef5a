// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_REPORT_REPORT_WORDS_H
#define HN_SESSION_REPORT_REPORT_WORDS_H
// The summary of a report: the cheapest methods, what each method reaches, and both as sentences.

#include "session/report/report.h"

extern const double hn_report_accuracy[HN_REPORT_BANDS]; ///< 1e-3, 1e-6, 1e-9
/// The cheapest method of a scene at this relative error: by time where times rank clearly, else by
/// operations. Method -1: none reaches it.
hn_report_answer hn_report_find_answer(const hn_report_scene *scene, double accuracy);
/// Returns the verdict on method m of a scene.
hn_verdict hn_report_find_verdict(const hn_report_scene *scene, int m);
/// Writes the report in a few lines, one sentence each: how often each method is cheapest, which
/// methods are dependable, what fails where, what is ranked by time.
void hn_report_sentences(hn_strbuf *b, const hn_report *report);
const char *hn_report_scene_id(const hn_report_scene *scene); ///< "scene" where it has none
/// Returns one of its studies, as methods are the same in all. NULL: there is none.
const hn_study *hn_report_any_study(const hn_report *report);
#endif
