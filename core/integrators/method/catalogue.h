// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_INTEGRATORS_CATALOGUE_H
#define HN_INTEGRATORS_CATALOGUE_H
// The catalogue of methods as JSON: the cards that the page, the terminal and `list methods` show.

#include "base/strbuf.h"

/// The whole catalogue: {"formulations":[card...],"integrators":[card...]}; options with unit,
/// range, default.
void hn_methods_json(hn_strbuf *b);

#endif
