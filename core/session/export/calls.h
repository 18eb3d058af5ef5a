// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_EXPORT_CALLS_H
#define HN_SESSION_EXPORT_CALLS_H
// Functions that the equations of a scene call: a program defines and imports no others.

#include "session/export/places.h"

/// Finds the operators of all terms: bit op of the result for each. Returns every bit where memory
/// is out.
unsigned hn_export_calls(const hn_exporter *e);
/// Returns whether there are any that hn_export_put_functions() writes.
bool hn_export_has_functions(unsigned calls);
/// Writes the names of the functions among them that languages take from a library of mathematics,
/// "cos, sin"; nothing where there are none.
void hn_export_put_functions(hn_strbuf *b, unsigned calls);

#endif
