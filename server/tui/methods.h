// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_METHODS_H
#define HN_TUI_METHODS_H
// Changes of the methods that are compared: each records anew, and leaves everything as it was
// where a method is refused.

#include "tui/workbench.h"

/// The step that all methods of fixed step have [s]; NaN: they differ, or there are none.
double hn_methods_step(const hn_workbench *w);
/// Another step for every method of fixed step: "0.01", "0,01" or "20 ms". false: the text
/// or the step was refused, and the fault is said.
bool hn_methods_set_step(hn_workbench *w, const char *text);
/// Replaces method `at`, or adds one behind the last. false: it was refused, and the fault is said.
bool hn_methods_put(hn_workbench *w, int at, const char *spelling);
/// The place of a method with the same formulation, integrator and options, however it is spelled;
/// -1: it is not compared.
int hn_methods_find(const hn_workbench *w, const char *spelling);
/// Adds a method, or finds it where it is already compared, and selects it.
void hn_methods_add(hn_workbench *w, const char *spelling);
/// The same, and says its gap and energy beside those of the method that was selected.
void hn_methods_add_beside(hn_workbench *w, const char *spelling);
/// Sets an option of the selected method: "h". The earlier value is reported.
void hn_methods_set_one(hn_workbench *w, const char *key, double value);
/// The last one stays.
void hn_methods_remove(hn_workbench *w, int at);
/// Adds the numbers after a change to those before it, once they are recorded.
void hn_methods_update(hn_workbench *w);
/// Alpha and beta of the method with this spelling; it is added where it is not compared yet. Says
/// what the worst gap and energy change were before.
void hn_methods_set_baumgarte(hn_workbench *w, const char *spelling, double alpha, double beta);
#endif
