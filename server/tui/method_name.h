// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_TUI_METHOD_NAME_H
#define HN_TUI_METHOD_NAME_H
// The short name of a method of the workbench, in which methods of one formulation differ.

#include "tui/workbench.h"

enum { HN_METHOD_NAME = 64 }; ///< bytes of a name with its end

/// Writes "Baumgarte 20/20 20 ms": the name of method m with its own options, and with its step
/// where another one has the same name and another step, in at most `most` columns.
void hn_method_name(const hn_workbench *w, int m, int most, char out[HN_METHOD_NAME]);

#endif
